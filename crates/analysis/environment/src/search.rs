//! Which spot is which bead, without a person: views guessed from three beads each, judged by how many others they explain.
//!
//! Three beads taken as three spots decide a view but for a mirror image in depth, once a distance from source to detector is
//! assumed: a scaled orthographic view in closed form, made perspective by a few rounds of putting the depths in
//! (DeMenthon and Davis 1995). A distance that is wrong by a fifth moves other beads by a few pixels only, so a few distances
//! do, and the refinement that follows finds the true one. Lengths need no unit: the view's scale is free.
//!
//! **Guaranteed:** the same guesses in the same order, and no more than [`GUESSES`]. **Not guaranteed:** that a frame is
//! recognised of which fewer than half of the beads are seen.

use biplane_geometry::{Point2, Point3, Vector2, Vector3};
use nalgebra::{Matrix2, Matrix3, Rotation3};

use crate::view::View;

/// Distances from source to detector that are assumed, mm.
const DISTANCES_MM: [f64; 3] = [800.0, 1100.0, 1550.0];
/// Guesses made for one picture, at most.
const GUESSES: usize = 3_000_000;
/// Rounds of putting depths in.
const ROUNDS: usize = 5;
/// Best guesses kept of one triple of beads.
const KEPT: usize = 40;

/// A guessed view, and how many beads it explains.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Guess {
    pub view: View,
    pub explained: usize,
}

/// Beads and spots of one picture.
pub(crate) struct Scene<'a> {
    pub beads: &'a [Point3],
    /// Ideal px.
    pub spots: &'a [Point2],
    /// Whether a spot may be a bead, by size and by what a person said: row by row, a row a bead.
    pub may_be: &'a [bool],
    /// px a mm of the frame, if the spots' sizes say: guesses with less than half or more than twice of it are not looked at.
    pub scale: Option<f64>,
    pub pixel_mm: f64,
    pub middle: Point2,
    /// How near a bead must come to a spot, px.
    pub tolerance_px: f64,
}

/// For every place of the picture the spot that is nearest, if one is near.
struct NearestSpot {
    first: Point2,
    cell_px: f64,
    count: [usize; 2],
    /// Number of the spot plus one; 0 for none.
    cells: Vec<u32>,
}

impl NearestSpot {
    fn new(spots: &[Point2], reach: f64) -> Option<Self> {
        let fold = |f: fn(f64, f64) -> f64, start: f64| {
            spots.iter().fold(Point2::new(start, start), |a, p| Point2::new(f(a.x, p.x), f(a.y, p.y)))
        };
        let low = fold(f64::min, f64::INFINITY) - Vector2::repeat(reach);
        let high = fold(f64::max, f64::NEG_INFINITY) + Vector2::repeat(reach);
        let extent = high - low;
        if !extent.iter().all(|v| v.is_finite()) {
            return None;
        }
        // At most 512 cells a side, whatever a distortion makes of the picture.
        let cell_px = (reach / 5.0).max(extent.max() / 512.0);
        let count = [extent.x, extent.y].map(|e| (e / cell_px).ceil() as usize + 1);
        let mut cells = vec![0; count[0] * count[1]];
        let mut distance = vec![reach; cells.len()];
        for (number, spot) in (1..).zip(spots) {
            let range = |axis: usize| {
                let at = |v: f64| ((v - low[axis]) / cell_px).floor().max(0.0) as usize;
                at(spot[axis] - reach)..(at(spot[axis] + reach) + 1).min(count[axis])
            };
            for j in range(1) {
                for i in range(0) {
                    let middle = low + Vector2::new(i as f64 + 0.5, j as f64 + 0.5) * cell_px;
                    let d = (middle - spot).norm();
                    if d < distance[j * count[0] + i] {
                        distance[j * count[0] + i] = d;
                        cells[j * count[0] + i] = number;
                    }
                }
            }
        }
        Some(Self { first: low, cell_px, count, cells })
    }

    fn at(&self, p: &Point2) -> Option<usize> {
        let g = (p - self.first) / self.cell_px;
        if !(g.x >= 0.0 && g.y >= 0.0) {
            return None;
        }
        let (i, j) = (g.x as usize, g.y as usize);
        if i >= self.count[0] || j >= self.count[1] {
            return None;
        }
        self.cells[j * self.count[0] + i].checked_sub(1).map(|s| s as usize)
    }
}

/// Three beads in their own plane.
struct Triangle {
    first: Point3,
    /// Columns: two directions in the plane, and its normal.
    axes: Matrix3<f64>,
    /// Places of the second and the third, columns.
    sides: Matrix2<f64>,
    inverse: Matrix2<f64>,
}

impl Triangle {
    fn new(p: [&Point3; 3]) -> Option<Self> {
        let (a, b) = (p[1] - p[0], p[2] - p[0]);
        let e1 = a.try_normalize(0.0)?;
        let e2 = (b - e1 * b.dot(&e1)).try_normalize(1e-6 * b.norm())?;
        let sides = Matrix2::new(a.norm(), b.dot(&e1), 0.0, b.dot(&e2));
        let axes = Matrix3::from_columns(&[e1, e2, e1.cross(&e2)]);
        Some(Self { first: *p[0], axes, sides, inverse: sides.try_inverse()? })
    }

    /// Camera from frame as rotation and place of the first bead, for spots relative to the middle and a focal length, px; `flip`
    /// takes the other of the two views.
    fn view(&self, spots: [Vector2; 3], focal: f64, flip: bool) -> Option<(Matrix3<f64>, Vector3, f64)> {
        let mut nearer = [1.0, 1.0];
        let mut tilt = Vector2::zeros();
        let mut answer = None;
        for round in 0..ROUNDS {
            let (u, v) = (spots[1] * nearer[0] - spots[0], spots[2] * nearer[1] - spots[0]);
            // Affine map of the plane; with s the scale it is s times the upper part of two columns of a rotation.
            let affine = Matrix2::from_columns(&[u, v]) * self.inverse;
            let gram = affine.transpose() * affine;
            let half = gram.trace() / 2.0;
            let s2 = half + (half * half - gram.determinant()).max(0.0).sqrt();
            let scale = s2.sqrt();
            let (x2, y2) = ((1.0 - gram[(0, 0)] / s2).max(0.0), (1.0 - gram[(1, 1)] / s2).max(0.0));
            let mixed = -gram[(0, 1)] / s2;
            let mut next = if x2 > y2 {
                Vector2::new(x2.sqrt(), mixed / x2.sqrt())
            } else if y2 > 0.0 {
                Vector2::new(mixed / y2.sqrt(), y2.sqrt())
            } else {
                Vector2::zeros()
            };
            let turned_round = if round == 0 { flip } else { next.dot(&tilt) < 0.0 };
            if turned_round {
                next = -next;
            }
            tilt = next;
            let depth = focal / scale;
            nearer = [0, 1].map(|k| 1.0 + tilt.dot(&self.sides.column(k)) / depth);
            if !(depth.is_finite() && nearer.iter().all(|n| *n > 0.2)) {
                return None;
            }
            answer = Some((affine / scale, tilt, depth, scale));
        }
        let (plane, tilt, depth, scale) = answer?;
        let c1 = Vector3::new(plane[(0, 0)], plane[(1, 0)], tilt.x).try_normalize(0.0)?;
        let c2 = Vector3::new(plane[(0, 1)], plane[(1, 1)], tilt.y);
        let c2 = (c2 - c1 * c1.dot(&c2)).try_normalize(0.0)?;
        let rotation = Matrix3::from_columns(&[c1, c2, c1.cross(&c2)]) * self.axes.transpose();
        let place = Vector3::new(spots[0].x * depth / focal, spots[0].y * depth / focal, depth);
        Some((rotation, place, scale))
    }
}

impl Scene<'_> {
    fn may_be(&self, bead: usize, spot: usize) -> bool {
        self.may_be.get(bead * self.spots.len() + spot).copied().unwrap_or(false)
    }

    fn candidates(&self, bead: usize) -> Vec<usize> {
        (0..self.spots.len()).filter(|&s| self.may_be(bead, s)).collect()
    }

    /// Hands the best guesses from each triple of beads to `accept`, until it says that this will do, or there are no more.
    pub fn guesses(
        &self,
        triples: impl Iterator<Item = [usize; 3]>,
        mut accept: impl FnMut(&[Guess]) -> bool,
    ) {
        let Some(nearest) = NearestSpot::new(self.spots, self.tolerance_px) else { return };
        let relative: Vec<Vector2> = self.spots.iter().map(|p| p - self.middle).collect();
        let mut budget = GUESSES;
        // Each spot counts once a guess: the number of the guess that counted it last.
        let mut counted = vec![0_usize; self.spots.len()];
        let enough = (self.beads.len().min(self.spots.len()) / 3).max(4);
        for triple in triples {
            let Some(triangle) = Triangle::new(triple.map(|b| &self.beads[b])) else { continue };
            let candidates = triple.map(|b| self.candidates(b));
            let order: Vec<usize> = spread_order(self.beads.len()).filter(|b| !triple.contains(b)).collect();
            let mut best: Vec<Guess> = Vec::new();
            for &i in &candidates[0] {
                for &j in candidates[1].iter().filter(|&&j| j != i) {
                    for &k in candidates[2].iter().filter(|&&k| k != i && k != j) {
                        let spots = [relative[i], relative[j], relative[k]];
                        for distance in DISTANCES_MM {
                            for flip in [false, true] {
                                if budget == 0 {
                                    accept(&best);
                                    return;
                                }
                                budget -= 1;
                                let focal = distance / self.pixel_mm;
                                let Some((rotation, place, scale)) = triangle.view(spots, focal, flip) else {
                                    continue;
                                };
                                if self.scale.is_some_and(|s| scale < s / 2.0 || scale > s * 2.0) {
                                    continue;
                                }
                                let stamp = budget + 1;
                                for s in [i, j, k] {
                                    counted[s] = stamp;
                                }
                                let mut explained = 3;
                                for (seen, &bead) in order.iter().enumerate() {
                                    // A right guess explains most of the first eight.
                                    if seen == 8 && explained < 6 {
                                        break;
                                    }
                                    let p = rotation * (self.beads[bead] - triangle.first) + place;
                                    if p.z <= 0.0 {
                                        continue;
                                    }
                                    let pixel = self.middle + p.xy() * (focal / p.z);
                                    if let Some(spot) = nearest.at(&pixel)
                                        && counted[spot] != stamp
                                        && self.may_be(bead, spot)
                                    {
                                        counted[spot] = stamp;
                                        explained += 1;
                                    }
                                }
                                if explained >= enough
                                    && (best.len() < KEPT
                                        || best.last().is_some_and(|b| b.explained < explained))
                                {
                                    let view = self.placed(&rotation, &place, &triangle.first, distance);
                                    let at = best.partition_point(|b| b.explained >= explained);
                                    best.insert(at, Guess { view, explained });
                                    best.truncate(KEPT);
                                }
                            }
                        }
                    }
                }
            }
            if accept(&best) {
                return;
            }
        }
    }

    /// The view of a camera that has the frame's point `first` at `place`.
    fn placed(&self, rotation: &Matrix3<f64>, place: &Vector3, first: &Point3, distance: f64) -> View {
        let back = Rotation3::from_matrix_unchecked(rotation.transpose());
        let source = first - back * place;
        let centre = source + back * Vector3::new(0.0, 0.0, distance);
        View { source, centre, rotation: back, pixel_mm: self.pixel_mm, middle: self.middle }
    }
}

/// Numbers below `count`, early ones spread over all.
fn spread_order(count: usize) -> impl Iterator<Item = usize> {
    // A step near the golden section that shares no factor with the count goes through every number once.
    let greatest_common = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let near = (count as f64 * 0.618) as usize;
    let step = (near.max(1)..=count.max(1)).find(|&s| greatest_common(s, count) == 1).unwrap_or(1);
    (0..count).map(move |i| i * step % count.max(1))
}

/// Triples of beads to begin with, made as they are asked for. Large triangles first, those with two of `anchors` (beads that few
/// spots can be) before those with one, and those with none last; no bead in more than a few of a kind, since it may not be seen.
pub(crate) fn triples<'a>(beads: &'a [Point3], anchors: &[usize]) -> impl Iterator<Item = [usize; 3]> + 'a {
    // Of a long list, a few are enough to choose from.
    let few: Vec<usize> = spread_order(beads.len()).filter(|b| !anchors.contains(b)).take(30).collect();
    let anchors: Vec<usize> = anchors.iter().copied().take(12).collect();
    let kinds: [(usize, usize); 4] = [(3, 20), (2, 12), (1, 8), (0, 16)];
    kinds.into_iter().flat_map(move |(of_anchors, most)| {
        let (rest, mut all) = (3 - of_anchors, Vec::new());
        for a in subsets(&anchors, of_anchors) {
            all.extend(
                subsets(&few, rest)
                    .into_iter()
                    .filter_map(|f| <[usize; 3]>::try_from([a.as_slice(), f.as_slice()].concat()).ok()),
            );
        }
        largest(beads, all, &anchors, most)
    })
}

/// All subsets of `count` numbers, 0 to 3.
fn subsets(of: &[usize], count: usize) -> Vec<Vec<usize>> {
    if count == 0 {
        return vec![Vec::new()];
    }
    let with = |(i, last): (usize, &usize)| {
        let rest = subsets(&of[..i], count - 1);
        rest.into_iter()
            .map(|mut r| {
                r.push(*last);
                r
            })
            .collect::<Vec<_>>()
    };
    of.iter().enumerate().flat_map(with).collect()
}

/// The triangles of most height, with no bead but anchors in more than two.
fn largest(beads: &[Point3], all: Vec<[usize; 3]>, anchors: &[usize], most: usize) -> Vec<[usize; 3]> {
    // Slim triangles decide little.
    let height = |t: &[usize; 3]| {
        let (a, b) = (beads[t[1]] - beads[t[0]], beads[t[2]] - beads[t[0]]);
        let longest = a.norm().max(b.norm()).max((a - b).norm());
        a.cross(&b).norm() / longest.max(f64::MIN_POSITIVE)
    };
    let mut ranked: Vec<(f64, [usize; 3])> = all.into_iter().map(|t| (height(&t), t)).collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut uses = vec![0; beads.len()];
    let mut out = Vec::new();
    for (_, t) in ranked {
        if out.len() < most && t.iter().all(|&b| uses[b] < 2 || anchors.contains(&b)) {
            t.iter().for_each(|&b| uses[b] += 1);
            out.push(t);
        }
    }
    out
}
