//! Stacks of contours made for the tests.

use biplane_artifact::{BoneSurface, ContourSlice, SliceContour, SliceContours, SlicePoint};
use biplane_geometry::{Point3, Vector3};
use biplane_phantom::Solid;

pub type Ring = Vec<[f64; 2]>;

/// A slice of contours at a place, mm.
pub fn slice(origin_mm: [f64; 3], rings: Vec<Ring>) -> ContourSlice {
    let point = |[i, j]: [f64; 2]| SlicePoint { i, j, sigma_mm: 0.1 };
    let contours =
        rings.into_iter().map(|r| SliceContour { points: r.into_iter().map(point).collect() }).collect();
    ContourSlice { origin_mm, contours, flags: Vec::new(), edited: false }
}

/// Pixels of 1 mm along x and y.
pub fn stack(slices: Vec<ContourSlice>) -> SliceContours {
    SliceContours {
        columns: 200,
        rows: 200,
        column_step_mm: [1.0, 0.0, 0.0],
        row_step_mm: [0.0, 1.0, 0.0],
        slices,
        warnings: Vec::new(),
    }
}

/// Slices at heights along z.
pub fn at_heights(heights: impl IntoIterator<Item = f64>, rings: impl Fn(f64) -> Vec<Ring>) -> SliceContours {
    stack(heights.into_iter().map(|z| slice([0.0, 0.0, z], rings(z))).collect())
}

/// `count` heights from `from`, `step` apart.
pub fn even(from: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| from + step * k as f64).collect()
}

/// A counter-clockwise ellipse of `count` points.
pub fn ellipse(centre: [f64; 2], radii: [f64; 2], count: usize) -> Ring {
    (0..count)
        .map(|k| {
            let (sin, cos) = (k as f64 / count as f64 * std::f64::consts::TAU).sin_cos();
            [centre[0] + radii[0] * cos, centre[1] + radii[1] * sin]
        })
        .collect()
}

pub fn disc(centre: [f64; 2], radius: f64) -> Ring {
    ellipse(centre, [radius; 2], 60)
}

/// The other way round: a hole.
pub fn hole(ring: Ring) -> Ring {
    ring.into_iter().rev().collect()
}

/// The contours of a solid in a plane across z, followed on a grid of squares, each point set on the surface itself.
pub fn cut(solid: &dyn Solid, z: f64, step: f64) -> Vec<Ring> {
    let (low, high) = solid.bounds();
    let place = |i: usize, j: usize| [low.x - 1.137 + step * i as f64, low.y - 1.271 + step * j as f64];
    let count = [(high.x - low.x + 3.0) / step, (high.y - low.y + 3.0) / step].map(|n| n as usize + 2);
    let value = |p: [f64; 2]| solid.value(&Point3::new(p[0], p[1], z));
    let values: Vec<f64> =
        (0..count[0] * count[1]).map(|n| value(place(n % count[0], n / count[0]))).collect();
    let inside = |i: usize, j: usize| values[j * count[0] + i] < 0.0;
    // The point on the side from one corner to the next.
    let on = |a: (usize, usize), b: (usize, usize)| {
        let (p, q) = (place(a.0, a.1), place(b.0, b.1));
        let (mut from, mut to) = (0.0, 1.0);
        let at = |t: f64| [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])];
        for _ in 0..40 {
            let middle = (from + to) / 2.0;
            if (value(at(middle)) < 0.0) == inside(a.0, a.1) { from = middle } else { to = middle }
        }
        at((from + to) / 2.0)
    };
    // From side to side, bone on the left.
    let mut next = std::collections::BTreeMap::new();
    for j in 0..count[1] - 1 {
        for i in 0..count[0] - 1 {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            for k in 0..4 {
                let c = |n: usize| corners[(k + n) % 4];
                let is = |n: usize| inside(c(n).0, c(n).1);
                // A run of inside corners from c(1) on is entered over side 0.
                if !is(0) && is(1) {
                    let last = (1..4).rev().find(|n| (1..=*n).all(is)).unwrap_or(1);
                    let side = |a: (usize, usize), b: (usize, usize)| (a.min(b), a.max(b));
                    next.insert(side(c(last), c(last + 1)), side(c(0), c(1)));
                }
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((&first, _)) = next.iter().next() {
        let mut ring = Vec::new();
        let mut at = first;
        while let Some(to) = next.remove(&at) {
            ring.push(on(at.0, at.1));
            at = to;
        }
        rings.push(ring);
    }
    rings
}

/// Without faults, of positive volume, named by `what`.
pub fn assert_good(what: &str, surface: &BoneSurface) {
    assert!(surface.report.faults.is_empty(), "{what}: {:#?}", surface.report);
    assert!(surface.report.volume_mm3 > 0.0, "{what}: {:?}", surface.report);
}

/// Smallest angles of the triangles, degrees, ascending.
pub fn least_angles(surface: &BoneSurface) -> Vec<f64> {
    let angle = |a: Vector3, b: Vector3| a.angle(&b).to_degrees();
    let mut all: Vec<f64> = (0..surface.mesh.triangles().len())
        .map(|t| {
            let [a, b, c] = surface.mesh.corners(t);
            angle(b - a, c - a).min(angle(a - b, c - b)).min(angle(a - c, b - c))
        })
        .collect();
    all.sort_by(f64::total_cmp);
    all
}
