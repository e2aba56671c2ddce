//! Plane sections of a surface: area, centroid and second moments by Green's theorem over the segments, which need not be linked.

use biplane_geometry::Vector3;
use nalgebra::{Matrix2, SymmetricEigen, Vector2};

use crate::frame::square_to;
use crate::shape::Shape;

/// What a plane cuts out of a body.
#[derive(Debug, Clone)]
pub(crate) struct Section {
    /// mm^2.
    pub area: f64,
    /// Length of its outline, mm.
    pub perimeter: f64,
    /// Of the area, in space.
    pub centroid: Vector3,
    /// Second moments of the area about its centroid over the area, mm^2, along `across`.
    second: Matrix2<f64>,
    across: [Vector3; 2],
    /// The outline's segments, in space.
    pub segments: Vec<[Vector3; 2]>,
}

/// The section at right angles to the unit vector `normal` at the height `height` along it; none where nothing is cut.
pub(crate) fn section(shape: &Shape, normal: &Vector3, height: f64) -> Option<Section> {
    sections(shape, normal, &[height]).pop().flatten()
}

/// The sections at ascending heights, in one pass over the triangles.
pub(crate) fn sections(shape: &Shape, normal: &Vector3, levels: &[f64]) -> Vec<Option<Section>> {
    let heights: Vec<f64> = shape.vertices.iter().map(|v| v.dot(normal)).collect();
    let mut outlines: Vec<Vec<[Vector3; 2]>> = vec![Vec::new(); levels.len()];
    for t in &shape.triangles {
        let h = t.map(|i| heights[i as usize]);
        let (low, high) = (h[0].min(h[1]).min(h[2]), h[0].max(h[1]).max(h[2]));
        let first = levels.partition_point(|l| *l <= low);
        for (level, outline) in levels.iter().zip(&mut outlines).skip(first) {
            if *level > high {
                break;
            }
            let corners = t.map(|i| shape.vertices[i as usize]);
            outline.extend(segment(&corners, h.map(|h| h - level)));
        }
    }
    outlines.into_iter().map(|segments| Section::of(segments, normal)).collect()
}

/// Where a plane cuts a triangle whose corners lie at `heights` over it.
fn segment(corners: &[Vector3; 3], heights: [f64; 3]) -> Option<[Vector3; 2]> {
    let above = heights.map(|h| h >= 0.0);
    let (mut from, mut to) = (None, None);
    for k in 0..3 {
        let l = (k + 1) % 3;
        if above[k] != above[l] {
            let s = heights[k] / (heights[k] - heights[l]);
            let at = corners[k] + (corners[l] - corners[k]) * s;
            // One sense around the body for all triangles of it.
            if above[k] { from = Some(at) } else { to = Some(at) }
        }
    }
    Some([from?, to?])
}

impl Section {
    fn of(segments: Vec<[Vector3; 2]>, normal: &Vector3) -> Option<Self> {
        let count = segments.len();
        if count < 3 {
            return None;
        }
        let u = square_to(normal);
        let v = normal.cross(&u);
        let middle = segments.iter().map(|[p, q]| (p + q) / 2.0).sum::<Vector3>() / count as f64;
        let (mut twice, mut first, mut second, mut perimeter) =
            (0.0, Vector2::zeros(), Matrix2::zeros(), 0.0);
        for [p, q] in &segments {
            perimeter += (q - p).norm();
            let [p, q] = [p - middle, q - middle].map(|d| Vector2::new(d.dot(&u), d.dot(&v)));
            let cross = p.x * q.y - p.y * q.x;
            twice += cross;
            first += (p + q) * (cross / 6.0);
            let s = p + q;
            second += (p * p.transpose() + q * q.transpose() + s * s.transpose()) * (cross / 24.0);
        }
        let area: f64 = twice / 2.0;
        if area.abs() < 1e-6 * perimeter * perimeter {
            return None;
        }
        let mean = first / area;
        Some(Self {
            area: area.abs(),
            perimeter,
            centroid: middle + u * mean.x + v * mean.y,
            second: second / area - mean * mean.transpose(),
            across: [u, v],
            segments,
        })
    }

    /// From its rearmost to its foremost place along a direction, mm.
    pub fn width(&self, direction: &Vector3) -> f64 {
        let (back, front) = self.reach(direction);
        front - back
    }

    /// Its longest direction (unit), and the standard deviations of its area along it and across it, mm.
    pub fn principal(&self) -> (Vector3, [f64; 2]) {
        let eigen = SymmetricEigen::new(self.second);
        let long = usize::from(eigen.eigenvalues[1] > eigen.eigenvalues[0]);
        let d = eigen.eigenvectors.column(long);
        let direction = self.across[0] * d[0] + self.across[1] * d[1];
        let spread = [eigen.eigenvalues[long], eigen.eigenvalues[1 - long]].map(|e: f64| e.max(0.0).sqrt());
        (direction, spread)
    }

    /// How far it reaches from its centroid along a direction: to the back, to the front.
    pub fn reach(&self, direction: &Vector3) -> (f64, f64) {
        self.segments.iter().flatten().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            let h = (p - self.centroid).dot(direction);
            (low.min(h), high.max(h))
        })
    }

    /// Area over that of a circle of the same outline: 1 for a circle, small for what has many parts or notches.
    pub fn roundness(&self) -> f64 {
        4.0 * std::f64::consts::PI * self.area / (self.perimeter * self.perimeter)
    }
}
