//! A mesh that can be changed: half-edges in threes, each with its twin on the other side of the edge.
//!
//! Half-edge `h` is side `h % 3` of triangle `h / 3`. An edge that does not have just two triangles, wound alike, has no twins:
//! the surface ends there, as at a rim. A vertex in which several fans of triangles touch is taken apart into one for each. What
//! is faulty in this way is held where it is and put together again at the end, so it stays as it was.
//!
//! **Guaranteed:** no change here makes a closed surface open, joins what was apart, or makes an edge with three triangles.

use biplane_geometry::{Mesh, MeshError, Point3, Vector3};
use biplane_surface::Edges;

/// No half-edge, no vertex.
pub(crate) const NONE: u32 = u32::MAX;

/// What may become of a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hold {
    /// It may go anywhere on the surface.
    Free,
    /// It may go along the two sharp edges, or rims, that meet in it.
    Line,
    /// A corner of lines: it stays, unless another corner of the same line is too near.
    Corner,
    /// A fault of the mesh: it stays, whatever comes.
    Fixed,
}

pub(crate) struct HalfEdges {
    pub at: Vec<Point3>,
    /// Where each half-edge begins; [`NONE`] for a triangle that is gone.
    pub from: Vec<u32>,
    pub twin: Vec<u32>,
    /// Of each half-edge the line that it is part of, a sharp edge or a rim, which is never turned; [`NONE`] for the others.
    pub line: Vec<u32>,
    pub hold: Vec<Hold>,
    /// A half-edge that begins in each vertex; [`NONE`] for a vertex that is gone.
    out: Vec<u32>,
    /// Vertices of the mesh for those that were taken apart.
    origin: Vec<u32>,
    vertices: usize,
    mark: Vec<u32>,
    marked: u32,
}

pub(crate) fn next(half: u32) -> u32 {
    if half % 3 == 2 { half - 2 } else { half + 1 }
}

pub(crate) fn prev(half: u32) -> u32 {
    if half.is_multiple_of(3) { half + 2 } else { half - 1 }
}

impl HalfEdges {
    /// Rims are lines and faults are fixed; all else is free.
    pub fn of(mesh: &Mesh) -> Self {
        let mut from = mesh.triangles().as_flattened().to_vec();
        let mut twin = vec![NONE; from.len()];
        let mut faulty = Vec::new();
        for (_, halves) in Edges::of(mesh).iter() {
            match *halves {
                [_] => {}
                [a, b] if from[a as usize] != from[b as usize] => {
                    twin[a as usize] = b;
                    twin[b as usize] = a;
                }
                _ => faulty.extend_from_slice(halves),
            }
        }
        let count = mesh.vertices().len();
        let mut this = Self {
            at: mesh.vertices().to_vec(),
            line: twin.iter().map(|t| if *t == NONE { 0 } else { NONE }).collect(),
            hold: vec![Hold::Free; count],
            out: vec![NONE; count],
            origin: (0..count as u32).collect(),
            vertices: 0,
            mark: vec![0; count],
            marked: 0,
            from: Vec::new(),
            twin,
        };
        // Every fan of a vertex after its first one gets a vertex of its own.
        let mut seen = vec![false; from.len()];
        for half in 0..from.len() as u32 {
            if seen[half as usize] {
                continue;
            }
            let vertex = from[half as usize];
            let own = if this.out[vertex as usize] == NONE {
                this.out[vertex as usize] = half;
                vertex
            } else {
                this.hold[vertex as usize] = Hold::Fixed;
                this.add(this.at[vertex as usize], Hold::Fixed, half, vertex)
            };
            this.fan_of(half, |h| {
                seen[h as usize] = true;
                from[h as usize] = own;
            });
        }
        this.vertices = this.out.iter().filter(|h| **h != NONE).count();
        this.from = from;
        for half in (0..this.from.len() as u32).filter(|h| this.twin[*h as usize] == NONE) {
            for v in [this.from[half as usize], this.to(half)] {
                if this.hold[v as usize] == Hold::Free {
                    this.hold[v as usize] = Hold::Line;
                }
            }
        }
        for half in faulty {
            for v in [this.from[half as usize], this.to(half)] {
                this.hold[v as usize] = Hold::Fixed;
            }
        }
        this
    }

    fn add(&mut self, at: Point3, hold: Hold, out: u32, origin: u32) -> u32 {
        self.at.push(at);
        self.hold.push(hold);
        self.out.push(out);
        self.origin.push(origin);
        self.mark.push(0);
        self.vertices += 1;
        self.at.len() as u32 - 1
    }

    /// Vertices that are left; those in which several fans touch count once for each.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Numbers of the vertices that are left.
    pub fn live(&self) -> impl Iterator<Item = u32> + use<> {
        let live: Vec<u32> = (0..self.out.len() as u32).filter(|v| self.out[*v as usize] != NONE).collect();
        live.into_iter()
    }

    pub fn live_vertex(&self, vertex: u32) -> bool {
        self.out[vertex as usize] != NONE
    }

    pub fn is_live(&self, half: u32) -> bool {
        self.from[half as usize] != NONE
    }

    /// Whether this half-edge stands for its edge: of two twins the first.
    pub fn stands_for_edge(&self, half: u32) -> bool {
        self.is_live(half) && (self.twin[half as usize] == NONE || half < self.twin[half as usize])
    }

    pub fn is_sharp(&self, half: u32) -> bool {
        self.line[half as usize] != NONE
    }

    /// The line that a vertex lies on, of several any.
    pub fn line_at(&self, vertex: u32) -> u32 {
        let mut line = NONE;
        self.fan(vertex, |h| line = line.min(self.line[h as usize]).min(self.line[prev(h) as usize]));
        line
    }

    pub fn to(&self, half: u32) -> u32 {
        self.from[next(half) as usize]
    }

    pub fn length(&self, half: u32) -> f64 {
        (self.at[self.to(half) as usize] - self.at[self.from[half as usize] as usize]).norm()
    }

    /// Corners of the triangle of a half-edge, beginning with where it begins.
    pub fn corners(&self, half: u32) -> [Point3; 3] {
        [half, next(half), prev(half)].map(|h| self.at[self.from[h as usize] as usize])
    }

    /// Twice the area of the triangle of a half-edge, times its normal.
    pub fn normal(&self, half: u32) -> Vector3 {
        let [a, b, c] = self.corners(half);
        (b - a).cross(&(c - a))
    }

    /// All half-edges that begin where this one does.
    fn fan_of(&self, half: u32, mut each: impl FnMut(u32)) {
        let mut h = half;
        loop {
            each(h);
            let over = self.twin[prev(h) as usize];
            if over == half {
                return;
            }
            if over == NONE {
                break;
            }
            h = over;
        }
        h = half;
        while self.twin[h as usize] != NONE {
            h = next(self.twin[h as usize]);
            each(h);
        }
    }

    /// All half-edges that begin in a vertex.
    pub fn fan(&self, vertex: u32, each: impl FnMut(u32)) {
        let half = self.out[vertex as usize];
        if half != NONE {
            self.fan_of(half, each);
        }
    }

    /// All vertices beside a vertex.
    pub fn ring(&self, vertex: u32, mut each: impl FnMut(u32)) {
        self.fan(vertex, |h| {
            each(self.to(h));
            if self.twin[prev(h) as usize] == NONE {
                each(self.from[prev(h) as usize]);
            }
        });
    }

    pub fn valence(&self, vertex: u32) -> usize {
        let mut count = 0;
        self.ring(vertex, |_| count += 1);
        count
    }

    /// Whether the surface ends in a vertex.
    pub fn is_on_rim(&self, vertex: u32) -> bool {
        let mut on = false;
        self.fan(vertex, |h| on |= self.twin[h as usize] == NONE || self.twin[prev(h) as usize] == NONE);
        on
    }

    /// Sum of twice the areas times the normals around a vertex.
    pub fn vertex_normal(&self, vertex: u32) -> Vector3 {
        let mut sum = Vector3::zeros();
        self.fan(vertex, |h| sum += self.normal(h));
        sum
    }

    fn begin_marks(&mut self) {
        if self.marked == u32::MAX {
            self.mark.fill(0);
            self.marked = 0;
        }
        self.marked += 1;
    }

    /// Whether the surface stays the surface that it is when the half-edge's begin is drawn into its end ("link condition").
    pub fn may_collapse(&mut self, half: u32) -> bool {
        let (a, b) = (self.from[half as usize], self.to(half));
        let twin = self.twin[half as usize];
        if twin != NONE && self.is_on_rim(a) && self.is_on_rim(b) {
            return false;
        }
        let beside = if twin == NONE { [half, NONE] } else { [half, twin] };
        for h in beside.into_iter().filter(|h| *h != NONE) {
            let (n, p) = (next(h), prev(h));
            if self.twin[n as usize] == NONE && self.twin[p as usize] == NONE {
                return false;
            }
            let apex = self.from[p as usize];
            // A vertex keeps at least three neighbours, on a rim two.
            if self.valence(apex) <= if self.is_on_rim(apex) { 2 } else { 3 } {
                return false;
            }
        }
        self.begin_marks();
        let mut ring = Vec::with_capacity(12);
        self.ring(a, |v| ring.push(v));
        for v in ring.drain(..) {
            self.mark[v as usize] = self.marked;
        }
        let mut common = 0;
        self.ring(b, |v| common += usize::from(self.mark[v as usize] == self.marked));
        common == 1 + usize::from(twin != NONE)
    }

    /// Draws the begin of a half-edge into its end, which stays where it is. Only if [`Self::may_collapse`].
    pub fn collapse(&mut self, half: u32) {
        let (a, b) = (self.from[half as usize], self.to(half));
        let mut fan = Vec::with_capacity(12);
        self.fan(a, |h| fan.push(h));
        for h in fan {
            self.from[h as usize] = b;
        }
        let twin = self.twin[half as usize];
        for h in [half, twin].into_iter().filter(|h| *h != NONE) {
            let (n, p) = (next(h), prev(h));
            let apex = self.from[p as usize];
            let (x, y) = (self.twin[n as usize], self.twin[p as usize]);
            let line = self.line[n as usize].min(self.line[p as usize]);
            for (one, other) in [(x, y), (y, x)] {
                if one != NONE {
                    self.twin[one as usize] = other;
                    self.line[one as usize] = line;
                }
            }
            // Of the edge that is left, one half begins in the apex, the other in b.
            for (vertex, one) in [(apex, x), (b, y), (apex, y), (b, x)] {
                if one != NONE {
                    self.out[vertex as usize] =
                        if self.from[one as usize] == vertex { one } else { next(one) };
                }
            }
            for gone in [h, n, p] {
                self.from[gone as usize] = NONE;
                self.twin[gone as usize] = NONE;
            }
        }
        self.out[a as usize] = NONE;
        self.vertices -= 1;
    }

    /// Turns an edge within its two triangles, if it is not sharp and its new ends are not neighbours.
    pub fn flip(&mut self, half: u32) -> bool {
        let twin = self.twin[half as usize];
        if twin == NONE || self.is_sharp(half) {
            return false;
        }
        let (hn, hp, gn, gp) = (next(half), prev(half), next(twin), prev(twin));
        let (a, b) = (self.from[half as usize], self.from[twin as usize]);
        let (c, d) = (self.from[hp as usize], self.from[gp as usize]);
        let mut joined = c == d;
        self.ring(c, |v| joined |= v == d);
        if joined || self.valence(a) <= 3 || self.valence(b) <= 3 {
            return false;
        }
        // a b c and b a d become d c a and c d b, so that half runs from d to c: each outer side goes to its new place.
        let outer = [hn, hp, gn, gp].map(|h| (self.twin[h as usize], self.line[h as usize]));
        let places = [(half, d), (hn, c), (hp, a), (twin, c), (gn, d), (gp, b)];
        for (place, vertex) in places {
            self.from[place as usize] = vertex;
        }
        let mut join = |place: u32, (other, line): (u32, u32)| {
            self.twin[place as usize] = other;
            self.line[place as usize] = line;
            if other != NONE {
                self.twin[other as usize] = place;
            }
        };
        // c to a, a to d, d to b, b to c.
        join(hn, outer[1]);
        join(hp, outer[2]);
        join(gn, outer[3]);
        join(gp, outer[0]);
        for (vertex, out) in [(a, hp), (b, gp), (c, hn), (d, gn)] {
            self.out[vertex as usize] = out;
        }
        true
    }

    /// Puts a vertex onto an edge; its number.
    pub fn split(&mut self, half: u32, at: Point3) -> u32 {
        let twin = self.twin[half as usize];
        let line = self.line[half as usize];
        let ends = [self.from[half as usize], self.to(half)];
        let origin = self.at.len() as u32;
        let hold = if line != NONE { Hold::Line } else { Hold::Free };
        let middle = self.add(at, hold, NONE, origin);
        // Beside each half: a to b and the apex c becomes a to the middle, and a new triangle from the middle to b.
        let new_of = |this: &mut Self, h: u32| {
            let (b, c) = (this.to(h), this.from[prev(h) as usize]);
            let n = next(h);
            let new = this.from.len() as u32;
            this.from.extend([middle, b, c]);
            this.twin.extend([NONE, this.twin[n as usize], n]);
            this.line.extend([line, this.line[n as usize], NONE]);
            let beyond = this.twin[n as usize];
            if beyond != NONE {
                this.twin[beyond as usize] = new + 1;
            }
            this.from[n as usize] = middle;
            this.twin[n as usize] = new + 2;
            this.line[n as usize] = NONE;
            this.out[b as usize] = new + 1;
            this.out[c as usize] = new + 2;
            new
        };
        let new = new_of(self, half);
        self.out[middle as usize] = new;
        self.out[ends[0] as usize] = half;
        if twin != NONE {
            let other = new_of(self, twin);
            // half: a to the middle; new: the middle to b; twin: b to the middle; other: the middle to a.
            for (one, two) in [(half, other), (new, twin)] {
                self.twin[one as usize] = two;
                self.twin[two as usize] = one;
            }
            self.out[ends[1] as usize] = twin;
        }
        middle
    }

    /// The mesh as it is now, put together where it was taken apart; vertices and triangles in the order in which they came.
    ///
    /// # Errors
    /// If no triangle is left that has an area.
    pub fn mesh(&self) -> Result<Mesh, MeshError> {
        let mut number = vec![NONE; self.at.len()];
        let mut vertices = Vec::with_capacity(self.vertices);
        let mut triangles = Vec::with_capacity(self.vertices * 2);
        for corners in self.from.as_chunks::<3>().0.iter().filter(|t| t[0] != NONE) {
            triangles.push(corners.map(|v| {
                let origin = self.origin[v as usize];
                let slot = &mut number[origin as usize];
                if *slot == NONE {
                    *slot = vertices.len() as u32;
                    vertices.push(self.at[v as usize]);
                }
                *slot
            }));
        }
        Mesh::new(vertices, triangles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_phantom::ball_mesh;
    use biplane_surface::MeshCheck;
    use rand::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// Every link leads back.
    fn check(this: &HalfEdges) {
        let mut live = 0;
        for half in (0..this.from.len() as u32).filter(|h| this.is_live(*h)) {
            let twin = this.twin[half as usize];
            if twin != NONE {
                assert_eq!(this.twin[twin as usize], half);
                assert_eq!(
                    (this.from[twin as usize], this.to(twin)),
                    (this.to(half), this.from[half as usize])
                );
                assert_eq!(this.line[twin as usize], this.line[half as usize]);
            }
            let mut found = false;
            this.fan(this.from[half as usize], |h| found |= h == half);
            assert!(found);
            live += 1;
        }
        let mut in_fans = 0;
        for v in this.live() {
            this.fan(v, |h| {
                assert_eq!(this.from[h as usize], v);
                in_fans += 1;
            });
        }
        assert_eq!(live, in_fans);
        assert_eq!(this.vertices(), this.live().count());
    }

    #[test]
    fn whatever_is_done_a_surface_stays_a_surface() {
        let ball = ball_mesh(10.0, 250).unwrap();
        let open = Mesh::new(ball.vertices().to_vec(), ball.triangles()[30..].to_vec()).unwrap();
        for (mesh, rims) in [(ball, 0), (open, 1)] {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
            let mut this = HalfEdges::of(&mesh);
            assert_eq!(this.mesh().unwrap().triangles().len(), mesh.triangles().len());
            let euler = |m: &Mesh| {
                let check = MeshCheck::of(m);
                assert!(check.is_manifold());
                assert_eq!(check.open_edges.is_empty(), rims == 0);
                let edges = (m.triangles().len() * 3 + check.open_edges.len()) / 2;
                m.vertices().len() as i64 + m.triangles().len() as i64 - edges as i64
            };
            let before = euler(&this.mesh().unwrap());
            for round in 0..6000 {
                let half = random.random_range(0..this.from.len() as u32);
                if !this.is_live(half) {
                    continue;
                }
                // More and more splits, then more and more collapses, to the least surface there is.
                match random.random_range(0..if round < 2000 { 3 } else { 9 }) {
                    0 => {
                        let [a, b, _] = this.corners(half);
                        this.split(half, nalgebra::center(&a, &b));
                    }
                    1 => {
                        this.flip(half);
                    }
                    _ => {
                        if this.may_collapse(half) {
                            this.collapse(half);
                        }
                    }
                }
                if round % 100 == 0 {
                    check(&this);
                }
            }
            check(&this);
            // Flat triangles are dropped from a mesh: all vertices somewhere else.
            for p in &mut this.at {
                *p = Point3::from(Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)));
            }
            let after = this.mesh().unwrap();
            assert_eq!(after.vertices().len(), this.vertices());
            assert_eq!(euler(&after), before);
            assert!(this.vertices() < 150);
        }
    }

    /// Two balls that share a vertex, and one with a wing on an edge: as they were.
    #[test]
    fn faults_are_held_and_come_back() {
        let ball = ball_mesh(10.0, 50).unwrap();
        let count = ball.vertices().len() as u32;
        let mut vertices = ball.vertices().to_vec();
        vertices.extend(ball.vertices().iter().map(|v| v + Vector3::new(30.0, 0.0, 0.0)));
        vertices.push(Point3::new(0.0, 0.0, 40.0));
        let mut triangles = ball.triangles().to_vec();
        triangles.extend(ball.triangles().iter().map(|t| t.map(|v| if v == 3 { 3 } else { v + count })));
        let [a, b, _] = ball.triangles()[20];
        triangles.push([a, b, 2 * count]);
        let mesh = Mesh::new(vertices, triangles).unwrap();
        let before = MeshCheck::of(&mesh);
        let this = HalfEdges::of(&mesh);
        assert!([3, a, b].iter().all(|v| this.hold[*v as usize] == Hold::Fixed));
        let after = MeshCheck::of(&this.mesh().unwrap());
        assert_eq!(before.pinched_vertices.len(), after.pinched_vertices.len());
        assert_eq!(before.crowded_edges.len(), after.crowded_edges.len());
        assert_eq!(before.open_edges.len(), after.open_edges.len());
        assert_eq!(before.signed_volume_mm3, after.signed_volume_mm3);
    }
}
