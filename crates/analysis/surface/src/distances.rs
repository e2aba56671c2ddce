//! Distances of one surface from another, at points spread evenly over it.

use biplane_geometry::{Mesh, Point3};

use crate::Surface;

/// What a set of distances comes to, mm (or whatever the values are).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spread {
    /// Half of the values are at most this.
    pub median: f64,
    /// 95 % of the values are at most this.
    pub p95: f64,
    /// The largest.
    pub worst: f64,
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
}

impl Spread {
    /// Of values that are all numbers; zeros if there are none.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        // The smallest value that a share of all is not above.
        let at = |share: f64| {
            let rank = (share * sorted.len() as f64).ceil() as usize;
            sorted.get(rank.max(1) - 1).copied().unwrap_or(0.0)
        };
        let count = values.len().max(1) as f64;
        Self {
            median: at(0.5),
            p95: at(0.95),
            worst: at(1.0),
            mean: sorted.iter().sum::<f64>() / count,
            rms: (sorted.iter().map(|v| v * v).sum::<f64>() / count).sqrt(),
        }
    }
}

/// Points spread over a mesh, each standing for the same area.
///
/// The triangles' areas are laid end to end and cut into `samples` equal parts, one point in the middle of each; where in its
/// triangle it lies follows the sequence of the plastic number (Roberts 2018), which fills the square evenly.
pub fn spread_points(mesh: &Mesh, samples: usize) -> Vec<Point3> {
    let areas: Vec<f64> = (0..mesh.triangles().len()).map(|t| mesh.area_vector(t).norm()).collect();
    let step = areas.iter().sum::<f64>() / samples as f64;
    let mut points = Vec::with_capacity(samples);
    let mut passed = 0.0;
    for (t, area) in areas.iter().enumerate() {
        passed += area;
        let last = t + 1 == areas.len();
        while points.len() < samples && (last || (points.len() as f64 + 0.5) * step < passed) {
            let n = points.len() as f64;
            let (u, v) = ((n * 0.754_877_666_246_692_7).fract(), (n * 0.569_840_290_998_053_3).fract());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let [a, b, c] = mesh.corners(t);
            points.push(a + (b - a) * u + (c - a) * v);
        }
    }
    points
}

/// Distances of `samples` points of [`spread_points`] from another surface, mm.
pub fn distances(from: &Mesh, to: &Surface, samples: usize) -> Vec<f64> {
    let mut near = 0;
    let distance = |place: &Point3| {
        let closest = to.closest_near(place, near);
        near = closest.triangle;
        closest.distance_mm
    };
    spread_points(from, samples).iter().map(distance).collect()
}
