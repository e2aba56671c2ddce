//! How many closed surfaces each closed surface lies in: one within another bounds a cavity and faces inward.
//!
//! By the parity of a ray's crossings (the even-odd rule), for three places of the inner surface, the majority of which counts. The ray's
//! direction is that of no plane or axis a body would be drawn along, and a ray through an edge crosses exactly one of its triangles,
//! because both of them ask the same question of that edge. Only surfaces whose boxes lie in each other are compared. Not guaranteed:
//! anything of surfaces that cross each other.

use biplane_geometry::{Point3, Vector3};

/// Rays against triangles, at most, so that a file of a great many pieces does not take minutes.
const MOST_TESTS: usize = 1 << 30;

/// A closed surface.
pub(super) struct Closed<'a> {
    /// Its triangles.
    pub(super) triangles: &'a [u32],
    /// The box around it.
    pub(super) low: Point3,
    pub(super) high: Point3,
}

/// For each closed surface in how many others it lies; `None` where there are too many to compare.
pub(super) fn depths(places: &[Point3], corners: &[[u32; 3]], surfaces: &[Closed<'_>]) -> Option<Vec<usize>> {
    let inside = |a: &Closed<'_>, b: &Closed<'_>| {
        (0..3).all(|i| b.low[i] <= a.low[i] && a.high[i] <= b.high[i]) && (a.low, a.high) != (b.low, b.high)
    };
    if surfaces.len() > 10_000 {
        return None;
    }
    let mut pairs = Vec::new();
    for (i, a) in surfaces.iter().enumerate() {
        pairs.extend(surfaces.iter().enumerate().filter(|(_, b)| inside(a, b)).map(|(j, _)| (i, j)));
    }
    let tests = pairs.iter().map(|(_, j)| surfaces[*j].triangles.len()).fold(0, usize::saturating_add);
    if tests > MOST_TESTS {
        return None;
    }
    let mut depths = vec![0; surfaces.len()];
    if pairs.is_empty() {
        return Some(depths);
    }
    let turned: Vec<Point3> = places.iter().map(turned).collect();
    for (i, j) in pairs {
        let own = surfaces[i].triangles;
        let places =
            [0, own.len() / 3, 2 * own.len() / 3].map(|k| middle(&turned, &corners[own[k] as usize]));
        let mut within = [false; 3];
        for t in surfaces[j].triangles {
            for (within, place) in within.iter_mut().zip(&places) {
                *within ^= is_crossed(&turned, corners[*t as usize], place);
            }
        }
        depths[i] += usize::from(within.iter().filter(|w| **w).count() >= 2);
    }
    Some(depths)
}

/// Places seen along the ray, which becomes z.
fn turned(p: &Point3) -> Point3 {
    // Columns of unit length at right angles to each other.
    let z = Vector3::new(0.402_718_2, 0.251_413_7, 0.880_121_4);
    let x = Vector3::new(z.y, -z.x, 0.0);
    let y = z.cross(&x);
    Point3::new(p.coords.dot(&x), p.coords.dot(&y), p.coords.dot(&z))
}

fn middle(places: &[Point3], corners: &[u32; 3]) -> Point3 {
    let [a, b, c] = corners.map(|i| places[i as usize].coords);
    // Not the centroid, which meshes of CAD like to put above an edge.
    Point3::from(a * 0.37 + b * 0.34 + c * 0.29)
}

/// Whether the ray upwards from a place crosses a triangle.
fn is_crossed(places: &[Point3], corners: [u32; 3], from: &Point3) -> bool {
    let [a, b, c] = corners.map(|i| &places[i as usize]);
    if a.z.max(b.z).max(c.z) < from.z
        || a.x.max(b.x).max(c.x) < from.x
        || a.x.min(b.x).min(c.x) > from.x
        || a.y.max(b.y).max(c.y) < from.y
        || a.y.min(b.y).min(c.y) > from.y
    {
        return false;
    }
    // Twice the area of an edge and the place; the same number, but for its sign, for both triangles of the edge.
    let side = |i: u32, j: u32| {
        let (p, q) = (&places[i.min(j) as usize], &places[i.max(j) as usize]);
        let area = (q.x - p.x) * (from.y - p.y) - (q.y - p.y) * (from.x - p.x);
        (area, (area >= 0.0) == (i < j))
    };
    let [i, j, k] = corners;
    let ((of_k, left_k), (of_i, left_i), (of_j, left_j)) = (side(i, j), side(j, k), side(k, i));
    if left_i != left_j || left_j != left_k {
        return false;
    }
    let signed = |area: f64, forward: bool| if forward { area } else { -area };
    let (w_i, w_j, w_k) = (signed(of_i, j < k), signed(of_j, k < i), signed(of_k, i < j));
    let sum = w_i + w_j + w_k;
    sum != 0.0 && (w_i * a.z + w_j * b.z + w_k * c.z) / sum > from.z
}
