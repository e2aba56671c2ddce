//! What a file holds before anything is mended: points and triangles. Polygons become triangles here.
//!
//! A quad is cut along the shorter one of the diagonals that lie inside it; a larger polygon by clipping ears (Meisters 1975), the best shape first, in the plane
//! of its Newell normal (the sum of the cross products of neighbouring corners), so it need not be convex. Where no ear is left because it
//! crosses itself, the next corner is clipped all the same, and the polygon is counted. Guaranteed: `n` corners, no two neighbours the same, give `n - 2` triangles,
//! wound as the polygon. Not guaranteed: that triangles of a polygon far from flat do not cross each other.

use biplane_geometry::{Point2, Point3, Vector3};

use super::MeshFormat;

/// Twice the area of a triangle, as a share of the square of the polygon's size, that is none: the rounding of its plane.
const SMALL: f64 = 1e-12;
/// Triangles that are kept at most.
pub(super) const MOST_TRIANGLES: usize = 1 << 25;
/// Corners of a polygon: cutting takes time with their square.
pub(super) const MOST_CORNERS: usize = 2000;

/// Points and triangles as a file has them, in its own unit.
pub(super) struct Soup {
    pub(super) format: MeshFormat,
    pub(super) points: Vec<Point3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Polygons of more than three corners, which were cut.
    pub(super) cut: usize,
    /// Of these, the ones that cross themselves so that no ear was left.
    pub(super) crossed: usize,
    /// Things of other kinds, and how many.
    pub(super) left_out: Vec<(usize, &'static str)>,
    pub(super) trailing_bytes: u64,
    /// Whether there were more triangles than are kept.
    pub(super) too_many: bool,
    corners: Vec<u32>,
}

impl Soup {
    pub(super) fn new(format: MeshFormat) -> Self {
        Self {
            format,
            points: Vec::new(),
            triangles: Vec::new(),
            cut: 0,
            crossed: 0,
            left_out: Vec::new(),
            trailing_bytes: 0,
            too_many: false,
            corners: Vec::new(),
        }
    }

    /// Notes that `count` things were passed over.
    pub(super) fn leave_out(&mut self, count: usize, what: &'static str) {
        match self.left_out.iter_mut().find(|(_, known)| *known == what) {
            Some((sum, _)) => *sum += count,
            None if count > 0 => self.left_out.push((count, what)),
            None => {}
        }
    }

    /// Adds a triangle of points that are there.
    pub(super) fn triangle(&mut self, corners: [u32; 3]) {
        if self.triangles.len() < MOST_TRIANGLES {
            self.triangles.push(corners);
        } else {
            self.too_many = true;
        }
    }

    /// Adds a strip of triangles: each corner makes one with the two before it, every second one wound the other way.
    pub(super) fn strip(&mut self, corners: &[u32]) {
        for (i, w) in corners.windows(3).enumerate() {
            self.triangle(if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] });
        }
    }

    /// Adds a polygon of points that are there, of at most [`MOST_CORNERS`].
    pub(super) fn polygon(&mut self, given: &[u32]) {
        if let [a, b, c] = *given {
            return self.triangle([a, b, c]);
        }
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        corners.extend_from_slice(given);
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            self.leave_out(1, "faces of fewer than three corners");
        } else {
            self.cut += usize::from(corners.len() > 3);
            self.clip(&mut corners);
        }
        self.corners = corners;
    }

    /// Cuts a polygon into triangles; leaves nothing of the list.
    fn clip(&mut self, corners: &mut Vec<u32>) {
        let places: Vec<Point3> = corners.iter().map(|&c| self.point(c)).collect();
        let mut flat = flattened(&places);
        let small = SMALL * flat.iter().map(|p| p.coords.norm_squared()).fold(0.0, f64::max);
        if let [a, b, c, d] = corners[..] {
            let inside = |p: usize, q: usize, r: usize, s: usize| {
                turn(&flat[p], &flat[q], &flat[r]) > small && turn(&flat[p], &flat[r], &flat[s]) > small
            };
            let (first, second) = (inside(0, 1, 2, 3), inside(1, 2, 3, 0));
            let shorter = (places[2] - places[0]).norm_squared() <= (places[3] - places[1]).norm_squared();
            let split = if first || second { first && (shorter || !second) } else { shorter };
            self.crossed += usize::from(!first && !second);
            let [t, u] = if split { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            self.triangle(t);
            self.triangle(u);
            return;
        }
        let mut shapes: Vec<f64> = (0..flat.len()).map(|at| ear(&flat, at, small)).collect();
        let mut crossed = false;
        while corners.len() > 3 {
            let n = corners.len();
            // The best shape of all ears, the first of several.
            let at = (1..n).fold(0, |best, i| if shapes[i] > shapes[best] { i } else { best });
            crossed |= shapes[at] <= 0.0;
            let (before, after) = ((at + n - 1) % n, (at + 1) % n);
            self.triangle([corners[before], corners[at], corners[after]]);
            corners.remove(at);
            flat.remove(at);
            shapes.remove(at);
            // Only the neighbours' triangles are others now; a corner that was clipped lay in no other ear.
            for i in [before, after].map(|i| if i > at { i - 1 } else { i }) {
                shapes[i] = ear(&flat, i, small);
            }
        }
        if let [a, b, c] = corners[..] {
            self.triangle([a, b, c]);
        }
        self.crossed += usize::from(crossed);
    }

    fn point(&self, corner: u32) -> Point3 {
        self.points.get(corner as usize).copied().unwrap_or_default()
    }
}

/// Corners in the plane of the polygon's Newell normal, counter-clockwise; their size does not matter.
fn flattened(places: &[Point3]) -> Vec<Point2> {
    let from = places.first().copied().unwrap_or_default();
    let steps = || places.iter().map(|p| p - from);
    let normal: Vector3 = steps().zip(steps().skip(1)).map(|(a, b)| a.cross(&b)).sum();
    let longest =
        steps().fold(Vector3::zeros(), |a, b| if b.norm_squared() > a.norm_squared() { b } else { a });
    let x = longest.try_normalize(0.0).unwrap_or_else(Vector3::x);
    let y = normal.cross(&x).try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    steps().map(|s| Point2::new(s.dot(&x), s.dot(&y))).collect()
}

/// Twice the area of a triangle, positive where it turns to the left.
fn turn(a: &Point2, b: &Point2, c: &Point2) -> f64 {
    (b - a).perp(&(c - a))
}

/// The shape of the triangle at a corner, from 0 (thin) to 1 (equilateral), if it is an ear: it turns to the left and holds no other
/// corner, not even on its sides; else -1.
fn ear(flat: &[Point2], at: usize, small: f64) -> f64 {
    let n = flat.len();
    let [a, b, c] = [(at + n - 1) % n, at, (at + 1) % n].map(|i| flat[i]);
    let area = turn(&a, &b, &c);
    if area <= small {
        return -1.0;
    }
    // Corners at the very place of one of these, as of a hole joined by a double edge, are no hindrance.
    let holds = |p: &Point2| {
        *p != a
            && *p != b
            && *p != c
            && turn(&a, &b, p) >= -small
            && turn(&b, &c, p) >= -small
            && turn(&c, &a, p) >= -small
    };
    if flat.iter().any(holds) {
        return -1.0;
    }
    2.0 * 3.0_f64.sqrt() * area / ((b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(corners: &[[f64; 3]]) -> (Soup, f64) {
        let mut soup = Soup::new(MeshFormat::Obj);
        soup.points = corners.iter().map(|c| Point3::from(*c)).collect();
        let all: Vec<u32> = (0..corners.len() as u32).collect();
        soup.polygon(&all);
        let area = soup.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| soup.points[i as usize]);
            (b - a).cross(&(c - a)).z / 2.0
        });
        assert!(area.clone().all(|a| a > 0.0), "each one wound as the polygon: {:?}", soup.triangles);
        let sum = area.sum();
        (soup, sum)
    }

    #[test]
    fn polygons_that_are_not_convex_are_filled_without_overlap() {
        // An arrow's head: only the diagonal from its notch lies inside.
        let (soup, area) = cut(&[[0.0, 0.0, 1.0], [2.0, 4.0, 1.0], [0.0, 3.0, 1.0], [-2.0, 4.0, 1.0]]);
        assert_eq!(soup.triangles.len(), 2);
        assert!((area - 6.0).abs() < 1e-12, "{area}");
        // A comb of four teeth.
        let mut comb = vec![[0.0, -1.0, 0.0], [8.0, -1.0, 0.0]];
        for k in (0..4).rev() {
            let x = 2.0 * f64::from(k);
            comb.extend([[x + 1.5, 0.0, 0.0], [x + 1.0, 5.0, 0.0], [x + 0.5, 0.0, 0.0]]);
        }
        let (soup, area) = cut(&comb);
        assert_eq!(soup.triangles.len(), comb.len() - 2);
        // The body, to the slanted ends of it, by the shoelace formula; each tooth is a triangle of 1 x 5.
        let shoelace: f64 = (0..comb.len())
            .map(|i| (comb[i], comb[(i + 1) % comb.len()]))
            .map(|(a, b)| a[0] * b[1] - b[0] * a[1])
            .sum();
        assert!((area - shoelace / 2.0).abs() < 1e-12, "{area}");
        assert_eq!((soup.crossed, soup.cut), (0, 1));
    }

    #[test]
    fn a_quad_is_cut_along_its_shorter_diagonal() {
        let (soup, _) = cut(&[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [5.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
        assert_eq!(soup.triangles, [[0, 1, 3], [1, 2, 3]]);
    }

    #[test]
    fn a_ring_joined_by_a_double_edge_is_filled() {
        let square = |r: f64| [[-r, -r, 0.0], [r, -r, 0.0], [r, r, 0.0], [-r, r, 0.0]];
        let (outer, inner) = (square(3.0), square(1.0));
        let ring = [
            outer[0], outer[1], outer[2], outer[3], outer[0], inner[0], inner[3], inner[2], inner[1],
            inner[0],
        ];
        let (soup, area) = cut(&ring);
        assert_eq!(soup.crossed, 0);
        assert!((area - 32.0).abs() < 1e-12, "{area}");
    }

    #[test]
    fn one_that_crosses_itself_ends_and_is_counted() {
        let star: Vec<[f64; 3]> = (0..5)
            .map(|k| f64::from(k) * 4.0 * std::f64::consts::PI / 5.0)
            .map(|a| [a.cos(), a.sin(), 0.0])
            .collect();
        let mut soup = Soup::new(MeshFormat::Obj);
        soup.points = star.iter().chain(&[[0.0; 3]]).map(|c| Point3::from(*c)).collect();
        soup.polygon(&[0, 1, 2, 3, 4]);
        assert_eq!(soup.triangles.len(), 3);
        soup.polygon(&[0, 0, 1, 1, 0]);
        assert_eq!(soup.left_out, [(1, "faces of fewer than three corners")]);
        // In a line.
        soup.polygon(&[5, 0, 5, 0, 5, 0]);
        assert_eq!(soup.triangles.len(), 7);
    }
}
