//! A triangle laid over the surface below it, for an upper bound of its distance.
//!
//! Seen along the triangle's normal, the surface's triangles cut it into pieces. Over each piece the distance from the one below it
//! is convex, so it is largest in a corner of the piece, and the distance from the whole surface is nowhere larger.
//!
//! **That the pieces cover the triangle** follows from how they are found: from one piece on across edges, always to the
//! neighbour, as long as it has a piece. Were a part left uncovered, its border would be an edge of a piece beyond which the
//! neighbour lies; and the neighbour is seen from the same side (else there is no answer), so it lies beyond.

use biplane_geometry::{Point3, Vector3};

use crate::Surface;
use crate::closest::closest_of_triangle;

/// Buffers that are used again.
pub(crate) struct Overlay {
    /// The round in which each triangle of the surface was met last.
    met: Vec<u32>,
    round: u32,
    waiting: Vec<u32>,
}

/// A part of a triangle: a triangle cut by three lines has at most six corners.
#[derive(Clone, Copy)]
struct Piece {
    corners: [Point3; 9],
    count: usize,
}

impl Overlay {
    pub fn new(surface: &Surface) -> Self {
        Self { met: vec![0; surface.triangles()], round: 0, waiting: Vec::new() }
    }

    /// No point of the triangle is farther from the surface than this. None if the surface below it ends, or turns away; `start` is a triangle of the surface's mesh below it.
    pub fn upper_bound(&mut self, surface: &Surface, triangle: &[Point3; 3], start: u32) -> Option<f64> {
        let normal = normal_of(triangle).try_normalize(0.0)?;
        let walls = [0, 1, 2].map(|k| {
            let inward = normal.cross(&(triangle[(k + 1) % 3] - triangle[k]));
            (triangle[k], inward.try_normalize(0.0).unwrap_or(inward))
        });
        let size = (0..3).map(|k| (triangle[(k + 1) % 3] - triangle[k]).norm()).fold(0.0, f64::max);
        let small = 1e-12 * size;
        self.round = self.round.wrapping_add(1);
        self.waiting.clear();
        let start = surface.place(start);
        self.met[start as usize] = self.round;
        self.waiting.push(start);
        let (mut most, mut pieces) = (0.0_f64, 0);
        while let Some(below) = self.waiting.pop() {
            let corners = &surface.corners[below as usize];
            let piece = Piece::of(corners).cut_by(&walls);
            if piece.area(&normal).abs() <= small * size {
                continue;
            }
            if normal_of(corners).dot(&normal) <= 0.0 {
                return None;
            }
            pieces += 1;
            for y in &piece.corners[..piece.count] {
                let x = y - normal * (y - triangle[0]).dot(&normal);
                let upright = (x - y).norm();
                if upright > most {
                    most = most.max((x - closest_of_triangle(&x, corners)).norm());
                }
            }
            let vertices = surface.vertices[below as usize];
            for k in 0..3 {
                match surface.across(below, [vertices[k], vertices[(k + 1) % 3]]) {
                    Some(next) if self.met[next as usize] == self.round => {}
                    Some(next) => {
                        self.met[next as usize] = self.round;
                        self.waiting.push(next);
                    }
                    None => {
                        let edge = Piece::of(&[corners[k], corners[(k + 1) % 3], corners[k]]).cut_by(&walls);
                        let first = edge.corners[0];
                        if edge.corners[..edge.count].iter().any(|p| (p - first).norm() > 1e-9 * size) {
                            return None;
                        }
                    }
                }
            }
        }
        (pieces > 0).then_some(most)
    }
}

fn normal_of([a, b, c]: &[Point3; 3]) -> Vector3 {
    (b - a).cross(&(c - a))
}

impl Piece {
    fn of(&[a, b, c]: &[Point3; 3]) -> Self {
        Self { corners: [a, b, c, a, a, a, a, a, a], count: 3 }
    }

    /// What lies on the inner side of all walls (Sutherland and Hodgman 1974).
    fn cut_by(mut self, walls: &[(Point3, Vector3); 3]) -> Self {
        for (on, inward) in walls {
            let height = self.corners.map(|p| inward.dot(&(p - on)));
            if height[..self.count].iter().all(|h| *h >= 0.0) {
                continue;
            }
            let whole = self;
            self.count = 0;
            for k in 0..whole.count {
                let next = if k + 1 == whole.count { 0 } else { k + 1 };
                if height[k] >= 0.0 {
                    self.push(whole.corners[k]);
                }
                if (height[k] >= 0.0) != (height[next] >= 0.0) {
                    let share = height[k] / (height[k] - height[next]);
                    self.push(whole.corners[k] + (whole.corners[next] - whole.corners[k]) * share);
                }
            }
            if self.count == 0 {
                return self;
            }
        }
        self
    }

    fn push(&mut self, corner: Point3) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    /// Area as seen along a direction, mm^2.
    fn area(&self, along: &Vector3) -> f64 {
        let first = self.corners[0];
        let corners = &self.corners[..self.count];
        corners.windows(2).map(|w| (w[0] - first).cross(&(w[1] - first)).dot(along)).sum::<f64>() / 2.0
    }
}
