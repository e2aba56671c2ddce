//! The edge points of one view: to find the nearest one that runs in a wanted direction, and where a line crosses their curve.
//!
//! Two ways, by distance. **Near** (up to some ten px): points are sorted into cells of the picture. **Far**: every few pixels of curve one
//! point is kept, and all of them are compared with, four or more at once; a turn counts as a distance.

use biplane_artifact::Curves;
use biplane_fluoroscope::Distortion;
use biplane_geometry::{EdgePoint, Point2, Vector2};

mod sparse;

pub use sparse::{Sparse, SparseEdges};

/// Side of a cell, px.
const CELL_PX: f64 = 8.0;
/// Cells along x or y at most: edge points far outside any picture fall into the last cell.
const MAX_CELLS: f64 = 2048.0;
/// Points of a curve that are farther apart than this have a gap between them, px.
const GAP_PX: f64 = 3.0;
/// Spacing of the points that are kept for a far search, px: the smallest, the largest, and about how many there are between.
const SPARSE_PX: (f64, f64, f64) = (4.0, 12.0, 200.0);

/// Where an edge point is among the curves of its frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EdgePlace {
    /// Number of the curve.
    pub curve: u32,
    /// Number of the point in it.
    pub point: u32,
}

/// Edge points of one view in ideal pixels.
#[derive(Debug, Clone)]
pub struct EdgeField {
    /// In the order of their cells.
    points: Vec<EdgePoint>,
    /// Where each point is among the curves.
    places: Vec<EdgePlace>,
    /// The points before and after each on its curve; itself where there is a gap or an end.
    neighbours: Vec<[u32; 2]>,
    cell_start: Vec<u32>,
    first: Point2,
    cells: [usize; 2],
    sparse: SparseEdges,
    length_px: f64,
}

impl EdgeField {
    /// From the curves of a frame, corrected for distortion if there is any.
    pub fn new(curves: &Curves, distortion: Option<&Distortion>) -> Self {
        let count = curves.point_count();
        let (mut points, mut places) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut chain: Vec<[u32; 2]> = Vec::with_capacity(count);
        let mut length_px = 0.0;
        for (number, curve) in curves.0.iter().enumerate() {
            let corrected = distortion.map(|d| d.correct(curve));
            let start = points.len() as u32;
            for (point, p) in corrected.as_ref().unwrap_or(curve).points.iter().enumerate() {
                if p.position.coords.iter().chain(p.direction.iter()).all(|v| v.is_finite()) {
                    points.push(*p);
                    places.push(EdgePlace { curve: number as u32, point: point as u32 });
                }
            }
            let end = points.len() as u32;
            for k in start..end {
                let before = if k > start {
                    k - 1
                } else if curve.closed {
                    end - 1
                } else {
                    k
                };
                let after = if k + 1 < end {
                    k + 1
                } else if curve.closed {
                    start
                } else {
                    k
                };
                let near = |j: u32| {
                    let apart = (points[j as usize].position - points[k as usize].position).norm();
                    if apart <= GAP_PX { j } else { k }
                };
                chain.push([near(before), near(after)]);
                let step = (points[after as usize].position - points[k as usize].position).norm();
                length_px += step.min(GAP_PX);
            }
        }
        let sparse = SparseEdges::of(&points, (length_px / SPARSE_PX.2).clamp(SPARSE_PX.0, SPARSE_PX.1));
        let (mut low, mut high) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        for p in &points {
            low = low.inf(&p.position.coords);
            high = high.sup(&p.position.coords);
        }
        if points.is_empty() {
            (low, high) = (Vector2::zeros(), Vector2::zeros());
        }
        let count = |span: f64| (span / CELL_PX + 1.0).clamp(1.0, MAX_CELLS) as usize;
        let mut field = Self {
            points: Vec::new(),
            places: Vec::new(),
            neighbours: Vec::new(),
            cell_start: Vec::new(),
            first: Point2::from(low),
            cells: [count(high.x - low.x), count(high.y - low.y)],
            sparse,
            length_px,
        };
        let total = field.cells[0] * field.cells[1];
        let index: Vec<usize> = points.iter().map(|p| field.cell_index(&p.position)).collect();
        field.cell_start = vec![0; total + 1];
        for &i in &index {
            field.cell_start[i + 1] += 1;
        }
        for i in 0..total {
            field.cell_start[i + 1] += field.cell_start[i];
        }
        let mut place = field.cell_start.clone();
        let mut order = vec![0_u32; points.len()];
        let mut moved = vec![0_u32; points.len()];
        for (k, &cell) in index.iter().enumerate() {
            order[place[cell] as usize] = k as u32;
            moved[k] = place[cell];
            place[cell] += 1;
        }
        let at = |k: &u32| *k as usize;
        field.points = order.iter().map(|k| points[at(k)]).collect();
        field.places = order.iter().map(|k| places[at(k)]).collect();
        field.neighbours = order.iter().map(|k| chain[at(k)].map(|j| moved[j as usize])).collect();
        field
    }

    /// Some points of the curves, for a far search.
    pub fn sparse(&self) -> &SparseEdges {
        &self.sparse
    }

    /// Length of all curves, px.
    pub fn length_px(&self) -> f64 {
        self.length_px
    }

    fn cell(&self, p: &Point2, axis: usize) -> usize {
        (((p[axis] - self.first[axis]) / CELL_PX).max(0.0) as usize).min(self.cells[axis] - 1)
    }

    fn cell_index(&self, p: &Point2) -> usize {
        self.cell(p, 1) * self.cells[0] + self.cell(p, 0)
    }

    /// The nearest edge point within `radius` px whose direction has at least `min_cosine` with `direction` (unit, dark
    /// to bright).
    pub fn nearest(
        &self,
        at: &Point2,
        direction: &Vector2,
        radius: f64,
        min_cosine: f64,
    ) -> Option<&EdgePoint> {
        self.nearest_number(at, direction, radius, min_cosine).map(|k| &self.points[k])
    }

    fn nearest_number(
        &self,
        at: &Point2,
        direction: &Vector2,
        radius: f64,
        min_cosine: f64,
    ) -> Option<usize> {
        let mut best = None;
        let mut best_squared = radius * radius;
        let mut look = |span: std::ops::Range<usize>, best_squared: &mut f64| {
            for (k, p) in self.points[span.clone()].iter().enumerate() {
                let d = (p.position - at).norm_squared();
                if d < *best_squared && p.direction.dot(direction) >= min_cosine {
                    *best_squared = d;
                    best = Some(span.start + k);
                }
            }
        };
        let cells = |y: usize, x: [usize; 2]| {
            let row = y * self.cells[0];
            self.cell_start[row + x[0]] as usize..self.cell_start[row + x[1] + 1] as usize
        };
        if radius <= CELL_PX {
            let corner = |sign: f64| at + Vector2::repeat(sign * radius);
            let [low, high] = [corner(-1.0), corner(1.0)].map(|p| [self.cell(&p, 0), self.cell(&p, 1)]);
            for y in low[1]..=high[1] {
                look(cells(y, [low[0], high[0]]), &mut best_squared);
            }
            return best;
        }
        let (cx, cy) = (self.cell(at, 0) as isize, self.cell(at, 1) as isize);
        let rings = (radius / CELL_PX).ceil() as isize;
        // Rings of cells around the one of `at`; a ring `k` away holds nothing nearer than `k - 1` cells.
        for ring in 0..=rings {
            let nearest_possible = (ring - 1).max(0) as f64 * CELL_PX;
            if nearest_possible * nearest_possible > best_squared {
                break;
            }
            for y in (cy - ring).max(0)..=(cy + ring).min(self.cells[1] as isize - 1) {
                let whole_row = (y - cy).abs() == ring;
                let step = if whole_row || ring == 0 { 1 } else { 2 * ring };
                let mut x = cx - ring;
                while x <= cx + ring {
                    if x >= 0 && x < self.cells[0] as isize {
                        look(cells(y as usize, [x as usize; 2]), &mut best_squared);
                    }
                    x += step;
                }
            }
        }
        best
    }

    /// How far along `normal` (unit) from `at` the nearest curve is crossed, px. `direction` (unit, dark to bright), `radius` and
    /// `min_cosine` choose the curve as in [`Self::nearest`]; beyond its end, its last point's tangent is crossed, up to `radius / 2`.
    pub fn crossing(
        &self,
        at: &Point2,
        normal: &Vector2,
        direction: &Vector2,
        radius: f64,
        min_cosine: f64,
    ) -> Option<f64> {
        let number = self.nearest_number(at, direction, radius, min_cosine)?;
        let point = &self.points[number];
        let place = |p: &EdgePoint| {
            let apart = p.position - at;
            (normal.perp(&apart), normal.dot(&apart))
        };
        let (along, across) = place(point);
        let mut crossed = None;
        for neighbour in self.neighbours[number] {
            let (other_along, other_across) = place(&self.points[neighbour as usize]);
            if along * other_along <= 0.0 && along != other_along {
                let crossing = across + (other_across - across) * along / (along - other_along);
                crossed = Some(
                    crossed.map_or(crossing, |c: f64| if c.abs() < crossing.abs() { c } else { crossing }),
                );
            }
        }
        let residual = match crossed {
            Some(r) => r,
            None if along.abs() <= radius / 2.0 => {
                let edge = &point.direction;
                edge.dot(&(point.position - at)) / edge.dot(normal)
            }
            None => return None,
        };
        (residual.abs() <= radius).then_some(residual)
    }

    /// All edge points within `radius` px whose direction has at least `min_cosine` with `direction`, with their places.
    pub fn within(
        &self,
        at: &Point2,
        direction: &Vector2,
        radius: f64,
        min_cosine: f64,
        mut found: impl FnMut(EdgePlace, &EdgePoint),
    ) {
        let corner = |sign: f64| at + Vector2::repeat(sign * radius);
        let [first, last] = [corner(-1.0), corner(1.0)].map(|p| [self.cell(&p, 0), self.cell(&p, 1)]);
        for y in first[1]..=last[1] {
            let row = y * self.cells[0];
            let span = self.cell_start[row + first[0]]..self.cell_start[row + last[0] + 1];
            for k in span.start as usize..span.end as usize {
                let p = &self.points[k];
                if (p.position - at).norm_squared() < radius * radius
                    && p.direction.dot(direction) >= min_cosine
                {
                    found(self.places[k], p);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::Curve;
    use rand::{Rng, SeedableRng};

    #[test]
    fn finds_what_a_search_through_all_points_finds() {
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(3);
        let points: Vec<EdgePoint> = (0..800)
            .map(|_| {
                let a: f64 = random.random_range(0.0..std::f64::consts::TAU);
                EdgePoint {
                    position: Point2::new(
                        random.random_range(100.0..400.0),
                        random.random_range(-50.0..300.0),
                    ),
                    direction: Vector2::new(a.cos(), a.sin()),
                    strength: 1.0,
                    sigma_px: 0.1,
                }
            })
            .collect();
        let field = EdgeField::new(&Curves(vec![Curve { points: points.clone(), closed: false }]), None);
        let mut found = 0;
        for _ in 0..2000 {
            let at = Point2::new(random.random_range(60.0..440.0), random.random_range(-90.0..340.0));
            let direction = Vector2::new(0.6, -0.8);
            let radius = random.random_range(1.0..60.0);
            let expected = points
                .iter()
                .filter(|p| p.direction.dot(&direction) >= 0.8 && (p.position - at).norm() < radius)
                .min_by(|a, b| (a.position - at).norm().total_cmp(&(b.position - at).norm()));
            assert_eq!(field.nearest(&at, &direction, radius, 0.8), expected);
            let mut all = 0;
            field.within(&at, &direction, radius, 0.8, |place, p| {
                assert_eq!(points[place.point as usize], *p);
                all += 1;
            });
            let near =
                |p: &&EdgePoint| p.direction.dot(&direction) >= 0.8 && (p.position - at).norm() < radius;
            assert_eq!(all, points.iter().filter(near).count());
            found += usize::from(expected.is_some());
        }
        assert!(found > 500);
        let empty = EdgeField::new(&Curves::default(), None);
        assert!(empty.nearest(&Point2::origin(), &Vector2::x(), 50.0, 0.0).is_none());
    }
}
