//! The method `diagonal`: the thesis's `assembleMesh` (Bingham 2006, listing A.1.2), mended.
//!
//! Two neighbouring contours are joined by a strip of triangles. It starts at their closest pair of points, both are gone round in the same
//! direction, and at each step the shorter of the two diagonals decides which contour goes on. Differences from the listing: the start is
//! the closest pair of all points, where the listing draws one point by chance and takes the closest to it (of pairs at the same
//! distance: the first in order of the lower contour, then of the upper); the sense in which closed contours run decides the direction, and
//! of open ones their course at the closest pair, where the listing compares first and last steps, be they the seam's; `gap` is compared with the diagonal, where the listing compares it
//! with its square; ends get lids, flat, where the listing leaves them open.
//!
//! Every slice should have one contour. Of several, those are joined one to one whose middles are nearest for their size; whatever has no
//! partner is closed with a lid or, alone, left out, and the report says so. **Not guaranteed:** that strips of very unlike contours do
//! not cross; the checks find it. Holes and branchings need the method `distance`.

use biplane_artifact::SurfaceReport;
use biplane_geometry::Mesh;

use crate::lid::lid;
use crate::stack::{Contour, Stack};
use crate::stage::Made;
use crate::{LoftError, LoftParams};

/// Contours farther apart than this many mean widths are no partners.
const PARTNERS: f64 = 2.0;

/// A contour's place: slice, and number in the slice's list.
type Place = (usize, usize);

/// The surface of a stack.
///
/// # Errors
/// No two slices beside each other have contours.
pub(crate) fn surface(stack: &Stack, params: &LoftParams) -> Result<Made, LoftError> {
    let mut warnings = Vec::new();
    let number = |(s, c): Place| (stack.slices[s].number, stack.slices[s].contours[c].number);
    let mut first_vertex: Vec<Vec<usize>> = Vec::with_capacity(stack.slices.len());
    let mut vertices = Vec::new();
    let mut places = Vec::new();
    for slice in &stack.slices {
        first_vertex.push(Vec::with_capacity(slice.contours.len()));
        for contour in &slice.contours {
            if let Some(of) = first_vertex.last_mut() {
                of.push(vertices.len());
            }
            places.extend(contour.points.iter().map(|p| [p[0], p[1], slice.height]));
            vertices.extend(contour.points.iter().map(|p| stack.scanner([p[0], p[1], slice.height])));
        }
    }
    let mut partner_above: Vec<Vec<bool>> =
        stack.slices.iter().map(|s| vec![false; s.contours.len()]).collect();
    let mut partner_below = partner_above.clone();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut joined = 0;
    // Slices in which the bone is missing though it goes through are passed over.
    let present: Vec<usize> = (0..stack.slices.len()).filter(|s| !stack.slices[*s].lost).collect();
    for pair in present.windows(2) {
        let [low, high] = [pair[0], pair[1]];
        let contours = [low, high].map(|s| &stack.slices[s].contours[..]);
        for (a, b) in partners(contours[0], contours[1]) {
            let (below, above) = (&contours[0][a], &contours[1][b]);
            let range = |s: usize, c: usize| {
                let first = first_vertex[s][c];
                first..first + stack.slices[s].contours[c].points.len()
            };
            let (p, q) = (range(low, a), range(high, b));
            let reversed = (below.area < 0.0) != (above.area < 0.0);
            let strip = Strip { below: &places[p.clone()], above: &places[q.clone()] };
            let gap = (!params.closed).then_some(params.gap_mm);
            for corners in strip.triangles(reversed, gap) {
                let mut triangle = corners.map(|corner| match corner {
                    Corner::Below(k) => (p.start + k) as u32,
                    Corner::Above(k) => (q.start + k) as u32,
                });
                if below.area < 0.0 {
                    triangle.swap(1, 2);
                }
                triangles.push(triangle);
            }
            partner_above[low][a] = true;
            partner_below[high][b] = true;
            joined += 1;
        }
    }
    let mut used = 0;
    for (s, slice) in stack.slices.iter().enumerate() {
        for (c, contour) in slice.contours.iter().enumerate() {
            let (above, below) = (partner_above[s][c], partner_below[s][c]);
            let (slice, number) = number((s, c));
            if !above && !below {
                warnings.push(format!(
                    "slice {slice}: contour {number} has no partner in a slice beside it and is left out"
                ));
                continue;
            }
            used += 1;
            if above && below {
                continue;
            }
            let at_end = stack.slices[if above { 0..s } else { s + 1..stack.slices.len() }]
                .iter()
                .all(|s| s.contours.is_empty());
            if !at_end {
                let side = if above { "before" } else { "behind" };
                warnings.push(format!("slice {slice}: contour {number} has no partner in the slice {side} it and is closed there"));
            }
            if params.closed {
                let first = first_vertex[s][c] as u32;
                // Counter-clockwise about the normal, which is outward above.
                for t in lid(&contour.points, contour.area < 0.0) {
                    let mut t = t.map(|k| first + k);
                    if above {
                        t.swap(1, 2);
                    }
                    triangles.push(t);
                }
            }
        }
    }
    if joined == 0 {
        let slice = stack.slices.iter().find(|s| !s.contours.is_empty()).map_or(0, |s| s.number);
        return Err(LoftError::NoNeighbours { slice });
    }
    let report =
        SurfaceReport { method: "diagonal".to_owned(), contours: used, warnings, ..SurfaceReport::default() };
    let slice = stack.slices[present[0]].number;
    let mut mesh = Mesh::new(vertices, triangles).map_err(|_| LoftError::NoNeighbours { slice })?;
    if params.closed && mesh.signed_volume() < 0.0 {
        mesh = mesh.inverted();
    }
    Ok(Made { mesh, unmoved: None, unsmoothed_volume_mm3: None, report })
}

/// Contours joined one to one, nearest first.
fn partners(below: &[Contour], above: &[Contour]) -> Vec<(usize, usize)> {
    let width = |c: &Contour| c.perimeter / std::f64::consts::PI;
    let mut candidates: Vec<(f64, usize, usize)> = Vec::new();
    for (a, p) in below.iter().enumerate() {
        for (b, q) in above.iter().enumerate() {
            let apart = (p.centroid[0] - q.centroid[0]).hypot(p.centroid[1] - q.centroid[1]);
            // Unlike sizes count like a distance.
            let unlike = (width(p) - width(q)).abs() / 2.0;
            let far = (apart + unlike) / ((width(p) + width(q)) / 2.0);
            if far <= PARTNERS {
                candidates.push((far, a, b));
            }
        }
    }
    candidates.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let (mut taken_below, mut taken_above) = (vec![false; below.len()], vec![false; above.len()]);
    let mut found = Vec::new();
    for (_, a, b) in candidates {
        if !taken_below[a] && !taken_above[b] {
            (taken_below[a], taken_above[b]) = (true, true);
            found.push((a, b));
        }
    }
    found.sort_unstable();
    found
}

/// A point of the lower or the upper contour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Corner {
    Below(usize),
    Above(usize),
}

/// Two contours to be joined, mm.
struct Strip<'a> {
    below: &'a [[f64; 3]],
    above: &'a [[f64; 3]],
}

impl Strip<'_> {
    /// The triangles in the order they are made, wound outward where the lower contour runs counter-clockwise seen from above.
    /// `reversed`: closed contours run in opposite senses. With a `gap` contours are open and no diagonal is longer.
    fn triangles(&self, reversed: bool, gap: Option<f64>) -> Vec<[Corner; 3]> {
        let (below, above) = (self.below.len(), self.above.len());
        let (start_below, start_above) = self.closest_pair();
        let lower = |step: usize| (start_below + step) % below;
        let forth = |step: usize| (start_above + step) % above;
        let back = |step: usize| (start_above + 2 * above - step) % above;
        let reversed = match gap {
            None => reversed,
            // Against each other where they are closest.
            Some(_) => {
                let course = |line: &[[f64; 3]], k: usize| {
                    let (p, q) = (line[k.saturating_sub(1)], line[(k + 1).min(line.len() - 1)]);
                    [q[0] - p[0], q[1] - p[1]]
                };
                let (b, a) = (course(self.below, start_below), course(self.above, start_above));
                a[0] * b[0] + a[1] * b[1] < 0.0
            }
        };
        let upper = |step: usize| if reversed { back(step) } else { forth(step) };
        let seam = |p: usize, q: usize, count: usize| p.abs_diff(q) == count - 1;
        let mut triangles = Vec::with_capacity(below + above);
        let (mut b, mut a) = (0, 0);
        while b < below || a < above {
            // Lengths of the diagonals from where we are to the next point of either contour.
            let on_above = square(self.above[upper(a + 1)], self.below[lower(b)]);
            let on_below = square(self.above[upper(a)], self.below[lower(b + 1)]);
            let go_above = b == below || (a < above && on_above < on_below);
            let (from, to, count, length) = if go_above {
                (upper(a), upper(a + 1), above, on_above)
            } else {
                (lower(b), lower(b + 1), below, on_below)
            };
            if gap.is_none_or(|gap| !seam(from, to, count) && length.sqrt() <= gap) {
                let next = if go_above { Corner::Above(to) } else { Corner::Below(to) };
                triangles.push([Corner::Above(upper(a)), Corner::Below(lower(b)), next]);
            }
            if go_above {
                a += 1;
            } else {
                b += 1;
            }
        }
        triangles
    }

    /// The closest points of both contours. From one point of a contour to the next the distance to a place changes by no more than the
    /// longest side: so many points are passed over as cannot be closer.
    fn closest_pair(&self) -> (usize, usize) {
        let sides = self.above.windows(2).map(|w| square(w[0], w[1]));
        let longest = sides.fold(f64::MIN_POSITIVE, f64::max).sqrt();
        let mut best = (f64::INFINITY, (0, 0));
        for (b, p) in self.below.iter().enumerate() {
            let mut a = 0;
            while let Some(q) = self.above.get(a) {
                let apart = square(*p, *q);
                if apart < best.0 {
                    best = (apart, (b, a));
                }
                a += (((apart.sqrt() - f64::sqrt(best.0)) / longest) as usize).max(1);
            }
        }
        best.1
    }
}

fn square(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2) + (p[2] - q[2]).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Corner::{Above, Below};

    /// Points at a height.
    fn at(height: f64, points: &[[f64; 2]]) -> Vec<[f64; 3]> {
        points.iter().map(|p| [p[0], p[1], height]).collect()
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];

    fn strip(below: &[[f64; 2]], above: &[[f64; 2]], reversed: bool, gap: Option<f64>) -> Vec<[Corner; 3]> {
        let (below, above) = (at(0.0, below), at(1.0, above));
        Strip { below: &below, above: &above }.triangles(reversed, gap)
    }

    /// The upper square is the lower one turned on by two corners in the list and made smaller by a tenth towards (0, 0): corner 2 of it lies
    /// right above corner 0, all other pairs are farther. From there both diagonals of each quadrilateral compare: across, from the
    /// lower corner to the next upper one, `4^2 0.9^2 + 1`, or less, than from the upper corner to the next lower one, `4^2 + 1`.
    #[test]
    fn square_on_square_by_hand() {
        let above = [[3.6, 3.6], [0.0, 3.6], [0.0, 0.0], [3.6, 0.0]];
        let wanted = [
            // (0,0)-(0,0): to upper (3.6,0): 12.96 + 1; to lower (4,0): 16 + 1. The upper one.
            [Above(2), Below(0), Above(3)],
            // Upper (3.6,0), lower (0,0): to upper (3.6,3.6) from (0,0): 25.92 + 1; to lower (4,0) from (3.6,0): 0.16 + 1.
            [Above(3), Below(0), Below(1)],
            // Upper (3.6,0), lower (4,0): to upper (3.6,3.6): 0.16 + 12.96 + 1; to lower (4,4): 0.16 + 16 + 1.
            [Above(3), Below(1), Above(0)],
            // Upper (3.6,3.6), lower (4,0): to upper (0,3.6): 16 + 12.96 + 1; to lower (4,4): 0.16 + 0.16 + 1.
            [Above(0), Below(1), Below(2)],
            // Upper (3.6,3.6), lower (4,4): to upper (0,3.6): 16 + 0.16 + 1; to lower (0,4): 12.96 + 0.16 + 1. The lower one.
            [Above(0), Below(2), Below(3)],
            // Upper (3.6,3.6), lower (0,4): to upper (0,3.6): 0.16 + 1; to lower (0,0): 25.92 + 1.
            [Above(0), Below(3), Above(1)],
            // Upper (0,3.6), lower (0,4): to upper (0,0): 16 + 1; to lower (0,0): 12.96 + 1.
            [Above(1), Below(3), Below(0)],
            // The lower one is gone round: what is left of the upper one.
            [Above(1), Below(0), Above(2)],
        ];
        assert_eq!(strip(&SQUARE, &above, false, None), wanted);
    }

    /// The triangle's first corner lies right above the square's first.
    #[test]
    fn triangle_on_square_by_hand() {
        let above = [[0.0, 0.0], [4.0, 1.0], [1.0, 4.0]];
        let wanted = [
            // To upper (4,1) from (0,0): 17 + 1; to lower (4,0) from (0,0): 16 + 1.
            [Above(0), Below(0), Below(1)],
            // Lower (4,0): to upper (4,1): 1 + 1; to lower (4,4) from (0,0): 32 + 1.
            [Above(0), Below(1), Above(1)],
            // Upper (4,1), lower (4,0): to upper (1,4): 9 + 16 + 1; to lower (4,4): 9 + 1.
            [Above(1), Below(1), Below(2)],
            // Upper (4,1), lower (4,4): to upper (1,4): 9 + 1; to lower (0,4): 16 + 9 + 1.
            [Above(1), Below(2), Above(2)],
            // Upper (1,4), lower (4,4): to upper (0,0): 32 + 1; to lower (0,4): 1 + 1.
            [Above(2), Below(2), Below(3)],
            // Upper (1,4), lower (0,4): to upper (0,0): 16 + 1; to lower (0,0): 1 + 16 + 1.
            [Above(2), Below(3), Above(0)],
            [Above(0), Below(3), Below(0)],
        ];
        assert_eq!(strip(&SQUARE, &above, false, None), wanted);
    }

    #[test]
    fn opposite_sense_is_turned() {
        // The square of the first test listed the other way round: corner 2 is where it was, 1 and 3 have changed places.
        let above = [[3.6, 3.6], [3.6, 0.0], [0.0, 0.0], [0.0, 3.6]];
        let straight = strip(&SQUARE, &[[3.6, 3.6], [0.0, 3.6], [0.0, 0.0], [3.6, 0.0]], false, None);
        let swapped: Vec<[Corner; 3]> = straight
            .iter()
            .map(|t| {
                t.map(|c| match c {
                    Above(k) => Above([0, 3, 2, 1][k]),
                    below => below,
                })
            })
            .collect();
        assert_eq!(strip(&SQUARE, &above, true, None), swapped);
    }

    /// Two open lines of three points, one above the other: no triangle from the last point to the first, and none longer than the gap,
    /// which is compared with the length of 1.414 and not with its square.
    #[test]
    fn open_with_a_gap() {
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
        let wanted = [
            // Both diagonals are as long: the lower one goes on.
            [Above(0), Below(0), Below(1)],
            [Above(0), Below(1), Above(1)],
            [Above(1), Below(1), Below(2)],
            [Above(1), Below(2), Above(2)],
        ];
        assert_eq!(strip(&line, &line, false, Some(1.5)), wanted);
        assert_eq!(
            strip(&line, &line, false, Some(1.2)).len(),
            2,
            "the sides of length 1, not the diagonals"
        );
        assert!(strip(&line, &line, false, Some(0.9)).is_empty());
        // The other line read backwards is turned.
        let back = [[2.0, 0.0], [1.0, 0.0], [0.0, 0.0]];
        let turned: Vec<[Corner; 3]> = wanted
            .iter()
            .map(|t| {
                t.map(|c| match c {
                    Above(k) => Above(2 - k),
                    below => below,
                })
            })
            .collect();
        assert_eq!(strip(&line, &back, false, Some(1.5)), turned);
    }

    #[test]
    fn the_closest_pair_is_that_of_trying_all() {
        let wave = |n: u32, height: f64, turn: f64| -> Vec<[f64; 3]> {
            (0..n)
                .map(|k| {
                    let a = (f64::from(k) / f64::from(n)).powi(2) * std::f64::consts::TAU;
                    let r = 8.0 + (3.0 * a + turn).sin() + 0.3 * (11.0 * a).cos();
                    [r * a.cos(), r * a.sin(), height]
                })
                .collect()
        };
        for n in 3..60 {
            let (below, above) = (wave(n, 0.0, 0.3), wave(97 - n, 0.2, 1.9));
            let mut best = (f64::INFINITY, (0, 0));
            for (b, p) in below.iter().enumerate() {
                for (a, q) in above.iter().enumerate() {
                    if square(*p, *q) < best.0 {
                        best = (square(*p, *q), (b, a));
                    }
                }
            }
            assert_eq!(Strip { below: &below, above: &above }.closest_pair(), best.1);
        }
    }
}
