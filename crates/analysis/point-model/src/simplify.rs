//! A surface with few triangles: quadric errors (Garland and Heckbert, "Surface simplification using quadric error metrics", 1997).
//!
//! Every vertex has the sum of squared distances from the planes of the triangles that have gone into it, weighted by area. The edge
//! whose ends can be drawn together at the least sum goes first, to the place where the sum is least. Along rims and sharp edges
//! there are planes upright on the surface too, so that they keep their course, and a small weight towards the vertices themselves
//! keeps triangles in flat parts from becoming needles.
//!
//! **Guaranteed:** a closed surface stays closed; no triangle is turned over by a step; faults of the mesh stay. **Not
//! guaranteed** here: how far the result is from the original; [`crate::Deviation`] bounds that.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use biplane_geometry::{Point3, Vector3};
use nalgebra::Matrix3;

use crate::half_edges::{HalfEdges, Hold, NONE, next, prev};

/// Weight of planes along rims and sharp edges, in areas of a square on the edge.
const ALONG_LINES: f64 = 10.0;
/// Weight towards the vertices themselves, as a share of their areas.
const TOWARDS_POINTS: f64 = 1e-3;
/// Smallest cosine between a triangle's normals before and after a step.
const TURN: f64 = 0.2;
/// Smallest height of a new triangle as a share of its longest side, unless it was smaller before.
const FLAT: f64 = 0.05;

/// `x' A x - 2 b' x + c`: a weighted sum of squared distances.
#[derive(Clone, Copy)]
struct Quadric {
    a: Matrix3<f64>,
    b: Vector3,
    c: f64,
}

impl Quadric {
    const ZERO: Self = Self {
        a: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        b: Vector3::new(0.0, 0.0, 0.0),
        c: 0.0,
    };

    /// The plane through a point with a unit normal.
    fn plane(normal: &Vector3, through: &Vector3, weight: f64) -> Self {
        let offset = normal.dot(through);
        Self {
            a: normal * normal.transpose() * weight,
            b: normal * (offset * weight),
            c: offset * offset * weight,
        }
    }

    fn point(at: &Vector3, weight: f64) -> Self {
        Self { a: Matrix3::identity() * weight, b: at * weight, c: at.norm_squared() * weight }
    }

    fn plus(&self, other: &Self) -> Self {
        Self { a: self.a + other.a, b: self.b + other.b, c: self.c + other.c }
    }

    fn at(&self, x: &Vector3) -> f64 {
        (self.a * x - self.b * 2.0).dot(x) + self.c
    }
}

/// An edge that may be collapsed: what it costs, and the state of its ends for which that was found.
struct Offer {
    cost: f64,
    half: u32,
    state: [u32; 2],
}

impl Ord for Offer {
    /// The least cost is the greatest offer.
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then(other.half.cmp(&self.half)).then(other.state.cmp(&self.state))
    }
}

impl PartialOrd for Offer {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Offer {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Offer {}

pub(crate) struct Simplifier {
    pub mesh: HalfEdges,
    quadrics: Vec<Quadric>,
    /// Counts the changes of each vertex.
    state: Vec<u32>,
    offers: BinaryHeap<Offer>,
    /// Middle of the mesh: quadrics are taken about it.
    middle: Vector3,
}

impl Simplifier {
    /// Of a mesh whose lines are marked.
    pub fn new(mesh: HalfEdges) -> Self {
        let count = mesh.at.len();
        let middle = mesh.at.iter().map(|p| p.coords).sum::<Vector3>() / count.max(1) as f64;
        let mut this = Self {
            quadrics: vec![Quadric::ZERO; count],
            state: vec![0; count],
            offers: BinaryHeap::new(),
            middle,
            mesh,
        };
        for half in 0..this.mesh.from.len() as u32 {
            if !this.mesh.is_live(half) {
                continue;
            }
            let normal = this.mesh.normal(half);
            let (area, Some(unit)) = (normal.norm() / 2.0, normal.try_normalize(0.0)) else { continue };
            let (v, end) = (this.mesh.from[half as usize], this.mesh.to(half));
            let here = this.mesh.at[v as usize].coords - middle;
            let own = Quadric::plane(&unit, &here, area).plus(&Quadric::point(&here, TOWARDS_POINTS * area));
            this.add(v, &own);
            if this.mesh.is_sharp(half) {
                let along = this.mesh.at[end as usize].coords - middle - here;
                if let Some(upright) = unit.cross(&along).try_normalize(0.0) {
                    let line = Quadric::plane(&upright, &here, ALONG_LINES * along.norm_squared());
                    this.add(v, &line);
                    this.add(end, &line);
                }
            }
        }
        for half in 0..this.mesh.from.len() as u32 {
            this.offer(half);
        }
        this
    }

    fn add(&mut self, vertex: u32, quadric: &Quadric) {
        let sum = self.quadrics[vertex as usize].plus(quadric);
        self.quadrics[vertex as usize] = sum;
    }

    /// Collapses edges until `points` vertices are left, or none can be collapsed any more.
    pub fn run(&mut self, points: usize) {
        while self.mesh.vertices() > points {
            let Some(offer) = self.offers.pop() else { return };
            let half = offer.half;
            if !self.mesh.is_live(half) {
                continue;
            }
            let ends = [self.mesh.from[half as usize], self.mesh.to(half)];
            if ends.map(|v| self.state[v as usize]) != offer.state {
                continue;
            }
            self.collapse(half);
        }
    }

    /// Which end of an edge is drawn into which, as a half-edge, where to, and at what cost.
    fn place(&self, half: u32) -> Option<(u32, Point3, f64)> {
        let twin = self.mesh.twin[half as usize];
        let (a, b) = (self.mesh.from[half as usize], self.mesh.to(half));
        let rank = |v: u32| match self.mesh.hold[v as usize] {
            Hold::Free => 0,
            Hold::Line | Hold::Corner => 1 + u8::from(self.mesh.is_on_rim(v)),
            Hold::Fixed => 3,
        };
        let (of_a, of_b) = (rank(a), rank(b));
        let quadric = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        let at = |v: u32| self.mesh.at[v as usize];
        // What must not leave its rim, or its place, takes the other in.
        let drawn = if of_a > of_b && twin != NONE { twin } else { half };
        if of_a.min(of_b) >= 3 || (twin == NONE && of_a > of_b) {
            return None;
        }
        let stays = self.mesh.to(drawn);
        let to = if of_a.max(of_b) >= 3 || (of_a.max(of_b) == 2 && !self.mesh.is_sharp(half)) {
            at(stays)
        } else {
            let least = quadric.a.try_inverse().map(|inverse| inverse * quadric.b);
            let near = |x: &Vector3| {
                let middle = (at(a).coords + at(b).coords) / 2.0 - self.middle;
                (x - middle).norm() <= 2.0 * (at(a) - at(b)).norm()
            };
            let ends = [at(a).coords - self.middle, at(b).coords - self.middle];
            let choice = least.filter(near).unwrap_or_else(|| {
                if quadric.at(&ends[0]) < quadric.at(&ends[1]) { ends[0] } else { ends[1] }
            });
            Point3::from(choice + self.middle)
        };
        Some((drawn, to, quadric.at(&(to.coords - self.middle)).max(0.0)))
    }

    fn offer(&mut self, half: u32) {
        if self.mesh.stands_for_edge(half)
            && let Some((_, _, cost)) = self.place(half)
        {
            let state = [self.mesh.from[half as usize], self.mesh.to(half)].map(|v| self.state[v as usize]);
            self.offers.push(Offer { cost, half, state });
        }
    }

    fn collapse(&mut self, half: u32) {
        let Some((drawn, to, _)) = self.place(half) else { return };
        let (a, b) = (self.mesh.from[drawn as usize], self.mesh.to(drawn));
        if !(self.keeps_sides(a, b, &to) && self.keeps_sides(b, a, &to) && self.mesh.may_collapse(drawn)) {
            return;
        }
        let sum = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        let hold = self.mesh.hold[a as usize];
        self.mesh.collapse(drawn);
        self.mesh.at[b as usize] = to;
        self.quadrics[b as usize] = sum;
        if self.mesh.hold[b as usize] == Hold::Free {
            self.mesh.hold[b as usize] = hold;
        }
        self.state[b as usize] += 1;
        let mut edges = Vec::with_capacity(12);
        self.mesh.fan(b, |h| {
            for h in [h, prev(h)] {
                let twin = self.mesh.twin[h as usize];
                edges.push(if twin == NONE { h } else { h.min(twin) });
            }
        });
        edges.sort_unstable();
        edges.dedup();
        for h in edges {
            self.offer(h);
        }
    }

    /// Whether the triangles around a vertex, but for those that have `without`, keep their side when it moves.
    fn keeps_sides(&self, vertex: u32, without: u32, to: &Point3) -> bool {
        let mut keeps = true;
        self.mesh.fan(vertex, |h| {
            if [next(h), prev(h)].iter().any(|h| self.mesh.from[*h as usize] == without) {
                return;
            }
            let [here, p, q] = self.mesh.corners(h);
            let flat = |from: &Point3, normal: &Vector3| {
                let longest =
                    (p - from).norm_squared().max((q - from).norm_squared()).max((p - q).norm_squared());
                normal.norm() / longest
            };
            let (before, after) = ((p - here).cross(&(q - here)), (p - to).cross(&(q - to)));
            keeps &= before.dot(&after) > TURN * before.norm() * after.norm()
                && (flat(to, &after) > FLAT || flat(to, &after) > flat(&here, &before));
        });
        keeps
    }
}
