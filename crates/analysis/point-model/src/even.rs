//! A surface sampled evenly: isotropic remeshing (Botsch and Kobbelt, "A remeshing approach to multiresolution modeling", 2004).
//!
//! Edges longer than 4/3 of the wanted length are split and those shorter than 4/5 collapsed, edges are turned so that six meet
//! in a vertex, and vertices move along the surface towards the middle of their neighbours, weighted by the areas around them;
//! then they go to the closest point of the original. The wanted length follows the number of points from round to round, and at
//! the end the longest edges are split, or the shortest collapsed, until the number is met. Vertices on lines (`lines.rs`) move
//! along them, corners stay.
//!
//! **Guaranteed:** the number of points, unless corners and faults alone are more; every vertex lies on the original; a closed
//! surface stays closed. No triangle is turned over by a step, and crossings that arise where the points are too few for a thin
//! part are mended by more points there, and fewer elsewhere, or told.

use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_surface::Surface;

use crate::ModelError;
use crate::half_edges::{HalfEdges, Hold, NONE, next, prev};
use crate::lines;

/// Rounds in which the length follows the number of points.
const ROUNDS: usize = 6;
/// Rounds of splitting: an edge of 100 mm is shorter than 0.03 mm after twelve.
const SPLITTING: usize = 12;
/// Rounds in which the number is met exactly.
const EXACT_ROUNDS: usize = 30;
/// Rounds of moving alone, after the number is met.
const SETTLING: usize = 4;
/// Rounds in which crossings are mended by taking lines away.
const RELEASES: usize = 6;
/// Rounds after that in which they are mended by more points.
const REFINEMENTS: usize = 3;
/// Steps of each vertex to undo a fold.
const UNFOLDING: usize = 4;
/// Smallest cosine between a triangle's normals before and after a step.
const TURN: f64 = 0.3;

/// A triangle is a needle where its height is below this share of its longest side.
const NEEDLE: f64 = 0.02;

/// A mesh on its way to an even one.
pub(crate) struct Even<'a> {
    pub mesh: HalfEdges,
    surface: &'a Surface,
    /// The lines of the original, by number.
    lines: Vec<Surface>,
    /// Of each vertex, the triangle of the original that it lies on.
    near: Vec<u32>,
    /// The wanted length of edges, mm.
    length: f64,
}

/// Samples the surface of `original` (with its tree) by `points` vertices.
///
/// # Errors
/// If the number cannot be met.
pub(crate) fn even(
    original: &Mesh,
    surface: &Surface,
    points: usize,
    keep_edges_deg: f64,
) -> Result<Mesh, ModelError> {
    let length = (original.area() * 2.0 / (3.0_f64.sqrt() * points as f64)).sqrt();
    let mut mesh = HalfEdges::of(original);
    lines::mark(&mut mesh, keep_edges_deg, 3.0 * length);
    let lines = lines::numbered(&mut mesh);
    let mut near = vec![0; mesh.at.len()];
    for half in 0..mesh.from.len() as u32 {
        near[mesh.from[half as usize] as usize] = half / 3;
    }
    let mut this = Even { mesh, surface, lines, near, length };
    for _ in 0..ROUNDS {
        this.split_long();
        this.collapse_short();

        this.flip_to_six();
        this.relax();
        let ratio = this.mesh.vertices() as f64 / points as f64;
        this.length *= ratio.sqrt().clamp(0.7, 1.4);
    }
    this.meet(points)?;
    this.settle();
    let mut mesh = this.mesh.mesh().map_err(|_| ModelError::Vanished)?;
    let mut crossings = Surface::new(&mesh).self_crossings(points);
    if crossings.is_empty() || !surface.self_crossings(1).is_empty() {
        return Ok(mesh);
    }
    let mut fewest = crossings.len();
    for round in 0..RELEASES + REFINEMENTS {
        let touched = this.of_triangles(&crossings);
        if round < RELEASES {
            this.release(&touched)
        } else {
            this.refine(&touched)
        }
        if this.meet(points).is_err() {
            break;
        }
        this.settle();
        let mended = this.mesh.mesh().map_err(|_| ModelError::Vanished)?;
        // It may go on elsewhere along the same lines before it ends.
        crossings = Surface::new(&mended).self_crossings(points);
        if crossings.len() < fewest {
            (mesh, fewest) = (mended, crossings.len());
        }
        if crossings.is_empty() {
            break;
        }
    }
    Ok(mesh)
}

/// Height of a triangle over its longest side, as a share of that; `normal` is twice its area.
fn flatness(normal: &Vector3, [a, b, c]: [Point3; 3]) -> f64 {
    normal.norm() / (a - b).norm_squared().max((b - c).norm_squared()).max((c - a).norm_squared())
}

impl Even<'_> {
    fn edges(&self) -> Vec<u32> {
        (0..self.mesh.from.len() as u32).filter(|h| self.mesh.stands_for_edge(*h)).collect()
    }

    /// Splits every long edge in the middle, the longest first, until none is left: so no triangle gets thinner than it was.
    fn split_long(&mut self) {
        for _ in 0..SPLITTING {
            let long = |h: &u32| self.mesh.length(*h) > self.length * 4.0 / 3.0;
            let edges = self.by_length(long);
            if edges.is_empty() {
                break;
            }
            for half in edges.into_iter().rev() {
                self.split(half);
            }
            self.flip_to_delaunay();
        }
    }

    /// Edges for which something holds, the shortest first.
    fn by_length(&self, of: impl Fn(&u32) -> bool) -> Vec<u32> {
        let edges = self.edges().into_iter().filter(of);
        let mut edges: Vec<(f64, u32)> = edges.map(|h| (self.mesh.length(h), h)).collect();
        edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        edges.into_iter().map(|(_, half)| half).collect()
    }

    fn split(&mut self, half: u32) {
        let [a, b, _] = self.mesh.corners(half);
        let near = self.near[self.mesh.from[half as usize] as usize];
        let middle = nalgebra::center(&a, &b);
        let v = self.mesh.split(half, middle);
        self.near.push(near);
        // On the surface, unless that is far off or turns a triangle over: both halves are shorter than the whole.
        let to = self.on_surface(v, &middle);
        if (to.0 - middle).norm() < 0.4 * (a - middle).norm() {
            self.move_to(v, to);
        }
    }

    fn collapse_short(&mut self) {
        let (short, long) = (self.length * 0.8, self.length * 4.0 / 3.0);
        for half in 0..self.mesh.from.len() as u32 {
            if self.mesh.stands_for_edge(half) && self.mesh.length(half) < short {
                self.collapse(half, long);
            }
        }
    }

    /// Draws one end of an edge into the other, if no edge becomes longer than `long`, the lines stay and nothing turns over.
    fn collapse(&mut self, half: u32, long: f64) -> bool {
        let twin = self.mesh.twin[half as usize];
        let on_rim = twin == NONE;
        // A rim's half-edge has no twin: only its own begin can be drawn in.
        let choices = if on_rim { [half, NONE] } else { [half, twin] };
        for h in choices.into_iter().filter(|h| *h != NONE) {
            let (a, b) = (self.mesh.from[h as usize], self.mesh.to(h));
            let free = match self.mesh.hold[a as usize] {
                Hold::Free => true,
                Hold::Line => self.mesh.is_sharp(h),
                Hold::Corner => {
                    let other = self.mesh.hold[b as usize];
                    self.mesh.is_sharp(h) && matches!(other, Hold::Corner | Hold::Fixed)
                }
                Hold::Fixed => false,
            };
            if free && self.keeps_shape(a, b, long) && self.mesh.may_collapse(h) {
                self.mesh.collapse(h);
                return true;
            }
        }
        false
    }

    /// Whether all triangles around a vertex keep their side, and edges their length, when it is drawn into a neighbour.
    fn keeps_shape(&self, a: u32, b: u32, long: f64) -> bool {
        let to = self.mesh.at[b as usize];
        let mut keeps = true;
        self.mesh.ring(a, |v| keeps &= (self.mesh.at[v as usize] - to).norm() <= long);
        keeps && self.keeps_sides(a, to, b)
    }

    /// Whether the triangles around a vertex keep their side when it moves; those with the vertex `without` are left out.
    fn keeps_sides(&self, vertex: u32, to: Point3, without: u32) -> bool {
        let whole = self.mesh.vertex_normal(vertex);
        let mut keeps = true;
        self.mesh.fan(vertex, |h| {
            let ends = [next(h), prev(h)].map(|h| self.mesh.from[h as usize]);
            if ends.contains(&without) {
                return;
            }
            let [here, p, q] = self.mesh.corners(h);
            let (before, after) = ((p - here).cross(&(q - here)), (p - to).cross(&(q - to)));
            let longest =
                (p - here).norm_squared().max((q - here).norm_squared()).max((p - q).norm_squared());
            // A needle's normal says nothing.
            keeps &= if before.norm() < NEEDLE * longest {
                after.dot(&whole) >= -0.1 * after.norm() * whole.norm()
            } else {
                before.dot(&after) > TURN * before.norm() * after.norm()
            };
        });
        keeps
    }

    fn move_to(&mut self, vertex: u32, (to, near): (Point3, u32)) -> bool {
        let moves = self.keeps_sides(vertex, to, NONE);
        if moves {
            self.mesh.at[vertex as usize] = to;
            if near != NONE {
                self.near[vertex as usize] = near;
            }
        }
        moves
    }

    /// The place on the surface, or on the lines, for a vertex that would be at `at`.
    fn on_surface(&self, vertex: u32, at: &Point3) -> (Point3, u32) {
        let line = match self.mesh.hold[vertex as usize] {
            Hold::Line => self.lines.get(self.mesh.line_at(vertex) as usize),
            _ => None,
        };
        match line {
            Some(line) => (line.closest(at).at, NONE),
            _ => {
                let found = self.surface.closest_near(at, self.near[vertex as usize]);
                (found.at, found.triangle)
            }
        }
    }

    /// Whether both triangles of an edge, if it were turned, would lie as they lie now, and not become needles.
    fn may_flip(&self, half: u32) -> bool {
        let twin = self.mesh.twin[half as usize];
        let ([a, b, c], [_, _, d]) = (self.mesh.corners(half), self.mesh.corners(twin));
        let (first, second) = (self.mesh.normal(half), self.mesh.normal(twin));
        let side = first / first.norm() + second / second.norm();
        let turned = [(d - a).cross(&(c - a)), (c - b).cross(&(d - b))];
        let size = side.norm();
        let now = flatness(&first, [a, b, c]).min(flatness(&second, [a, b, d]));
        let then = flatness(&turned[0], [a, c, d]).min(flatness(&turned[1], [b, c, d]));
        turned.iter().all(|n| n.dot(&side) > 0.7 * n.norm() * size) && (then > NEEDLE || then > now)
    }

    fn flip_to_six(&mut self) {
        let mut valence: Vec<i32> =
            (0..self.mesh.at.len() as u32).map(|v| self.mesh.valence(v) as i32).collect();
        let wanted: Vec<i32> = (0..self.mesh.at.len() as u32)
            .map(|v| if valence[v as usize] > 0 && self.mesh.is_on_rim(v) { 4 } else { 6 })
            .collect();
        for half in self.edges() {
            let twin = self.mesh.twin[half as usize];
            if twin == NONE || self.mesh.is_sharp(half) {
                continue;
            }
            let [a, b, c, d] =
                [half, twin, prev(half), prev(twin)].map(|h| self.mesh.from[h as usize] as usize);
            let off = |change: i32| {
                let of = |v: usize, by: i32| (valence[v] + by - wanted[v]).pow(2);
                of(a, -change) + of(b, -change) + of(c, change) + of(d, change)
            };
            if off(1) < off(0) && self.may_flip(half) && self.mesh.flip(half) {
                valence[a] -= 1;
                valence[b] -= 1;
                valence[c] += 1;
                valence[d] += 1;
            }
        }
    }

    /// Turns edges whose opposite angles come to more than half a turn.
    fn flip_to_delaunay(&mut self) {
        for _ in 0..3 {
            let mut flips = 0;
            for half in self.edges() {
                let twin = self.mesh.twin[half as usize];
                if twin == NONE || self.mesh.is_sharp(half) {
                    continue;
                }
                let cotangent = |h: u32| {
                    let [a, b, c] = self.mesh.corners(h);
                    let (u, v) = (a - c, b - c);
                    u.dot(&v) / u.cross(&v).norm().max(1e-300)
                };
                if cotangent(half) + cotangent(twin) < -1e-9 && self.may_flip(half) && self.mesh.flip(half) {
                    flips += 1;
                }
            }
            if flips == 0 {
                break;
            }
        }
    }

    /// Moves every vertex along the surface towards the middle of its neighbours, weighted by the areas around them.
    fn relax(&mut self) {
        let mut area = vec![0.0; self.mesh.at.len()];
        for half in (0..self.mesh.from.len() as u32).step_by(3).filter(|h| self.mesh.is_live(*h)) {
            let size = self.mesh.normal(half).norm();
            for h in half..half + 3 {
                area[self.mesh.from[h as usize] as usize] += size;
            }
        }
        for v in self.mesh.live() {
            let here = self.mesh.at[v as usize];
            let wish = match self.mesh.hold[v as usize] {
                Hold::Corner | Hold::Fixed => continue,
                Hold::Line => match lines::middle_along(&self.mesh, v) {
                    Some(middle) => middle,
                    None => continue,
                },
                Hold::Free => {
                    let (mut sum, mut weight) = (Vector3::zeros(), 0.0);
                    self.mesh.ring(v, |n| {
                        sum += self.mesh.at[n as usize].coords * area[n as usize];
                        weight += area[n as usize];
                    });
                    let Some(normal) = self.mesh.vertex_normal(v).try_normalize(0.0) else { continue };
                    let shift = sum / weight - here.coords;
                    here + (shift - normal * shift.dot(&normal))
                }
            };
            let half_way = nalgebra::center(&here, &wish);
            let moved = self.try_place(v, &wish) || self.try_place(v, &half_way);
            debug_assert!(moved || self.mesh.at[v as usize] == here);
        }
    }

    /// Puts a vertex to the place of the surface that is closest to a wish, if that is near, on the same side of the body, and
    /// turns nothing over.
    fn try_place(&mut self, vertex: u32, wish: &Point3) -> bool {
        let (to, near) = self.on_surface(vertex, wish);
        if (to - wish).norm() > self.length {
            return false;
        }
        if near != NONE {
            let [a, b, c] = self.surface.corners(near);
            if (b - a).cross(&(c - a)).dot(&self.mesh.vertex_normal(vertex)) < 0.0 {
                return false;
            }
        }
        self.move_to(vertex, (to, near))
    }

    fn settle(&mut self) {
        for _ in 0..SETTLING {
            self.flip_to_delaunay();
            self.relax();
        }
        self.flip_to_delaunay();
    }

    /// The half-edges of triangles that are given as numbers of the mesh.
    fn of_triangles(&self, pairs: &[[u32; 2]]) -> Vec<u32> {
        // As a mesh leaves them out.
        let with_area = |h: &u32| self.mesh.is_live(*h) && self.mesh.normal(*h).norm() > 0.0;
        let live: Vec<u32> = (0..self.mesh.from.len() as u32).step_by(3).filter(with_area).collect();
        let mut numbers: Vec<u32> = pairs.as_flattened().to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        let firsts = numbers.iter().filter_map(|n| live.get(*n as usize));
        firsts.flat_map(|first| *first..*first + 3).collect()
    }

    /// Takes the lines around some half-edges away: lines that are nearer to each other than points cross when they bend.
    fn release(&mut self, halves: &[u32]) {
        for &half in halves {
            let mut around = Vec::with_capacity(12);
            self.mesh.fan(self.mesh.from[half as usize], |h| around.extend([h, next(h), prev(h)]));
            for h in around {
                let twin = self.mesh.twin[h as usize];
                let v = self.mesh.from[h as usize];
                if twin != NONE {
                    self.mesh.line[h as usize] = NONE;
                    self.mesh.line[twin as usize] = NONE;
                }
                if self.mesh.hold[v as usize] != Hold::Fixed && !self.mesh.is_on_rim(v) {
                    let at = self.mesh.at[v as usize];
                    self.mesh.hold[v as usize] = Hold::Free;
                    self.near[v as usize] = self.surface.closest(&at).triangle;
                }
            }
        }
        // A fold is not undone by steps that turn nothing over: to the middles of their neighbours, whatever turns.
        for _ in 0..UNFOLDING {
            for &half in
                halves.iter().filter(|h| self.mesh.hold[self.mesh.from[**h as usize] as usize] == Hold::Free)
            {
                let v = self.mesh.from[half as usize];
                let (mut sum, mut count) = (Vector3::zeros(), 0.0);
                self.mesh.ring(v, |n| {
                    sum += self.mesh.at[n as usize].coords;
                    count += 1.0;
                });
                let found = self.surface.closest_near(&Point3::from(sum / count), self.near[v as usize]);
                self.mesh.at[v as usize] = found.at;
                self.near[v as usize] = found.triangle;
            }
        }
        self.collapse_short();
    }

    /// Puts more points where triangles cross, and holds them there: the sides of a thin part then lie where they should.
    fn refine(&mut self, halves: &[u32]) {
        for &half in halves {
            let twin = self.mesh.twin[half as usize];
            if twin != NONE && twin < half && halves.contains(&twin) {
                continue;
            }
            self.split(half);
            for v in [self.mesh.from[half as usize], self.mesh.to(half)] {
                self.mesh.hold[v as usize] = Hold::Fixed;
            }
        }
    }

    /// Splits the longest edges or collapses the shortest until the number of points is met.
    fn meet(&mut self, points: usize) -> Result<(), ModelError> {
        for _ in 0..EXACT_ROUNDS {
            let now = self.mesh.vertices();
            if now == points {
                return Ok(());
            }
            let more = now < points;
            // A few at a time, so that not all are in the same place.
            let most = now.abs_diff(points).min(now / 20 + 1);
            let mut edges = self.by_length(|_| true);
            if more {
                edges.reverse();
            }
            let mut touched = vec![false; self.mesh.at.len()];
            let mut done = 0;
            for half in edges {
                if done == most {
                    break;
                }
                if !self.mesh.stands_for_edge(half) {
                    continue;
                }
                let ends = [self.mesh.from[half as usize], self.mesh.to(half)];
                if ends.iter().any(|v| touched.get(*v as usize) != Some(&false)) {
                    continue;
                }
                if more {
                    self.split(half);
                } else if !self.collapse(half, f64::INFINITY) {
                    continue;
                }
                for v in ends {
                    if self.mesh.live_vertex(v) {
                        self.mesh.ring(v, |n| {
                            if let Some(t) = touched.get_mut(n as usize) {
                                *t = true;
                            }
                        });
                    }
                    touched[v as usize] = true;
                }
                done += 1;
            }
            self.flip_to_delaunay();
            self.relax();
            if done == 0 {
                break;
            }
        }
        let now = self.mesh.vertices();
        if now == points { Ok(()) } else { Err(ModelError::Points { points, found: now }) }
    }
}
