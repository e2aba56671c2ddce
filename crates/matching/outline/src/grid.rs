//! The thesis's outline of a cloud of points (Bingham 2006, 3.1.3 and listing A.2.2, `bound.m`).
//!
//! The points are projected and sorted into square cells, `grid` of them along the shorter side of their bounding box. A
//! left-looking contour follower runs round the filled cells, beginning at the cell of the left-most point; in each cell
//! that it visits, the point farthest to the outside is a point of the outline.
//!
//! **As the listing:** size and place of the cells, where the follower begins, one point a visit, so that a cell that is
//! passed on both of its sides gives a point for each. The functions `contour` and `farthest` are called by the listing
//! but not printed. Here the follower goes to the first filled one of a cell's eight neighbours, searched from its left
//! to its right, and "outside" is the mean direction of the run of empty neighbours that it passes over in that search.
//!
//! **Beyond it:** the listing gives nothing (and the objective then counts 100) for a cloud of one row or column, and
//! fails where rounding puts its first cell beside the cloud. Here a cloud without width has `grid` cells along its
//! length, and so has one so thin that square cells would be more than [`MOST_ALONG`]. Of several islands of cells the one
//! of the left-most point is outlined.
//!
//! **Guaranteed:** the follower ends, whatever the points are; nothing is allocated once the buffers have grown. **Not
//! guaranteed:** that the outline is smooth in the pose: points change cells, so it jumps by up to their distance.

use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point2, Point3, Pose, Vector2};

/// Cells along the longer side at most.
const MOST_ALONG: f64 = 4096.0;
/// Cells along the shorter side at most: above, `grid` is taken as this.
const MOST_ACROSS: usize = 1024;
/// The eight neighbours in the order in which they are searched: clockwise where x is to the right and y is down.
const NEIGHBOURS: [(isize, isize); 8] =
    [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];
/// The neighbour to the left, in [`NEIGHBOURS`].
const WEST: usize = 4;
/// No visit.
const NONE: u32 = u32::MAX;

/// The grid outline of a cloud, with buffers that are used again.
#[derive(Debug, Clone, Default)]
pub struct GridOutline {
    pixels: Vec<Point2>,
    /// The cell of each point.
    cell_of: Vec<u32>,
    /// For each cell whether it is filled and, once the follower has run, its last visit.
    cells: Vec<Cell>,
    columns: usize,
    visits: Vec<Visit>,
    points: Vec<Point2>,
}

#[derive(Debug, Clone, Copy)]
struct Cell {
    filled: bool,
    visit: u32,
}

/// The follower in a cell.
#[derive(Debug, Clone, Copy)]
struct Visit {
    /// Not normalised; zero where the cell has no filled neighbour.
    outside: Vector2,
    /// How far outside the outermost point so far is.
    farthest: f64,
    /// The visit of the same cell before this one.
    earlier: u32,
}

impl GridOutline {
    /// An outline with empty buffers.
    pub fn new() -> Self {
        Self::default()
    }

    /// The outline found last, ideal px, in the order of the follower.
    pub fn points(&self) -> &[Point2] {
        &self.points
    }

    /// The outline of `points` (model, mm) at `pose` in `view`, ideal px. Empty if there are none, if one of them lies at or
    /// behind the source, or if all appear at one pixel.
    pub fn trace(&mut self, points: &[Point3], pose: &Pose, view: &Fluoroscope, grid: usize) -> &[Point2] {
        // w (x, y, 1) = M (R m + t - source): one matrix and one vector for all points.
        let turned = view.matrix() * pose.rotation().to_rotation_matrix().matrix();
        let shift = view.matrix() * (pose.translation() - view.source().coords);
        let mut pixels = std::mem::take(&mut self.pixels);
        pixels.clear();
        let mut in_front = true;
        pixels.extend(points.iter().map(|m| {
            let h = turned * m.coords + shift;
            in_front &= h.z > 0.0;
            Point2::new(h.x / h.z, h.y / h.z)
        }));
        if in_front {
            self.bound(&pixels, grid);
        } else {
            self.points.clear();
        }
        self.pixels = pixels;
        &self.points
    }

    /// The outline of points in the plane, as `bound.m` has them. Empty if there are none, if all are the same, or if one
    /// is not a finite number.
    pub fn bound(&mut self, pixels: &[Point2], grid: usize) -> &[Point2] {
        self.points.clear();
        if let Some(start) = self.fill(pixels, grid.clamp(1, MOST_ACROSS) as f64) {
            self.follow(start);
            self.choose(pixels);
        }
        &self.points
    }

    /// Sorts the points into cells; the cell of the left-most one.
    fn fill(&mut self, pixels: &[Point2], grid: f64) -> Option<usize> {
        let first = pixels.first()?;
        let (mut low, mut high, mut left, mut finite) = (*first, *first, 0, true);
        for (index, p) in pixels.iter().enumerate() {
            finite &= (p.x + p.y).is_finite();
            // Branches, not `min` and `max`: they are hardly ever taken.
            if p.x < low.x {
                (low.x, left) = (p.x, index);
            }
            if p.x > high.x {
                high.x = p.x;
            }
            if p.y < low.y {
                low.y = p.y;
            }
            if p.y > high.y {
                high.y = p.y;
            }
        }
        if !finite {
            return None;
        }
        let size = high - low;
        let (shorter, longer) = (size.min(), size.max());
        let square = shorter / grid;
        let side = if longer <= square * MOST_ALONG { square } else { longer / grid };
        if !side.is_finite() || side <= 0.0 {
            return None;
        }
        // The shorter side has `grid` cells whatever rounding makes of the quotient.
        let count = |length: f64| (length / side - 1e-9).ceil().max(1.0) as usize;
        let (columns, rows) = (count(size.x), count(size.y));
        self.columns = columns;
        self.cells.clear();
        self.cells.resize(columns * rows, Cell { filled: false, visit: NONE });
        self.cell_of.clear();
        let per = 1.0 / side;
        let (last_column, last_row) = (columns as u32 - 1, rows as u32 - 1);
        self.cell_of.extend(pixels.iter().map(|p| {
            let column = (((p.x - low.x) * per) as u32).min(last_column);
            let row = (((p.y - low.y) * per) as u32).min(last_row);
            row * (last_column + 1) + column
        }));
        for cell in &self.cell_of {
            self.cells[*cell as usize].filled = true;
        }
        Some(self.cell_of[left] as usize)
    }

    /// The neighbour of a cell, if it is filled.
    fn filled(&self, cell: usize, neighbour: usize) -> Option<usize> {
        let (dx, dy) = NEIGHBOURS[neighbour];
        let column = (cell % self.columns).checked_add_signed(dx).filter(|c| *c < self.columns)?;
        let row = (cell / self.columns).checked_add_signed(dy)?;
        let other = row * self.columns + column;
        self.cells.get(other).is_some_and(|c| c.filled).then_some(other)
    }

    /// What a cell has for outside where its neighbour `empty` is empty: the sum of the directions to that one and to the
    /// empty ones beside it; and the first filled one to the right of them, with the cell that is there.
    fn outside(&self, cell: usize, empty: usize) -> (Vector2, Option<(usize, usize)>) {
        let mut first = empty;
        for _ in 0..7 {
            let before = (first + 7) % 8;
            if self.filled(cell, before).is_some() {
                break;
            }
            first = before;
        }
        let mut sum = Vector2::zeros();
        for turn in 0..8 {
            let neighbour = (first + turn) % 8;
            if let Some(next) = self.filled(cell, neighbour) {
                return (sum, Some((neighbour, next)));
            }
            let (dx, dy) = NEIGHBOURS[neighbour];
            sum += Vector2::new(dx as f64, dy as f64).normalize();
        }
        (sum, None)
    }

    /// Runs round the filled cells from one of the first column.
    fn follow(&mut self, start: usize) {
        self.visits.clear();
        let (mut cell, mut empty) = (start, WEST);
        let mut first_way = None;
        // A visit is told by its cell and its way on, and leads to one other visit: there are eight a cell at most before
        // the first one comes again.
        for _ in 0..8 * self.cells.len() {
            let (outside, way) = self.outside(cell, empty);
            if way.is_some() && cell == start && way == first_way {
                return;
            }
            first_way = first_way.or(way);
            let earlier = std::mem::replace(&mut self.cells[cell].visit, self.visits.len() as u32);
            self.visits.push(Visit { outside, farthest: f64::NEG_INFINITY, earlier });
            let Some((neighbour, next)) = way else { return };
            // The last empty one before the way, as the next cell sees it: after a straight step it is two places to the
            // left of the way, after an oblique one three.
            empty = (neighbour + if neighbour % 2 == 0 { 6 } else { 5 }) % 8;
            cell = next;
        }
    }

    /// The outermost point of each visit.
    fn choose(&mut self, pixels: &[Point2]) {
        self.points.resize(self.visits.len(), Point2::origin());
        for (p, cell) in pixels.iter().zip(&self.cell_of) {
            let mut visit = self.cells[*cell as usize].visit;
            while let Some(v) = self.visits.get_mut(visit as usize) {
                let far = v.outside.dot(&p.coords);
                if far > v.farthest {
                    v.farthest = far;
                    self.points[visit as usize] = *p;
                }
                visit = v.earlier;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(points: &[(f64, f64)]) -> Vec<Point2> {
        points.iter().map(|p| Point2::new(p.0, p.1)).collect()
    }
    fn outline(points: &[(f64, f64)], grid: usize) -> Vec<(f64, f64)> {
        GridOutline::new().bound(&cloud(points), grid).iter().map(|p| (p.x, p.y)).collect()
    }

    /// Worked by hand: a box of 3 x 3, cells of 1. Begins at the cell of the left-most point, (0, 1), and goes round
    /// clockwise in the picture (y down): up, right, down, left.
    #[test]
    fn a_square_of_nine_cells_gives_its_eight_border_cells_in_order() {
        let mut points = Vec::new();
        for row in 0..3 {
            for column in 0..3 {
                // Two points a cell; the second lies nearer to the middle of the whole in every cell.
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                points.push((x + 0.4 * (column as f64 - 1.0), y + 0.4 * (row as f64 - 1.0)));
                points.push((x + 0.1 * (column as f64 - 1.0), y + 0.1 * (row as f64 - 1.0)));
            }
        }
        // So that the box is 0 to 3 and the left-most point is that of the middle row.
        points.push((0.0, 1.5));
        points.push((1.5, 0.0));
        points.push((3.0, 1.5));
        points.push((1.5, 3.0));
        let expected =
            [(0.0, 1.5), (0.1, 0.1), (1.5, 0.0), (2.9, 0.1), (3.0, 1.5), (2.9, 2.9), (1.5, 3.0), (0.1, 2.9)];
        let found = outline(&points, 3);
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (f, e) in found.iter().zip(&expected) {
            assert!((f.0 - e.0).abs() < 1e-12 && (f.1 - e.1).abs() < 1e-12, "{found:?}");
        }
    }

    /// A bar of one row of cells with a point near its top and one near its bottom in each: there along the top and back
    /// along the bottom, the ends once.
    #[test]
    fn a_bar_one_cell_thick_is_passed_on_both_sides() {
        let points: Vec<_> = (0..4).flat_map(|c| [(c as f64 + 0.5, 0.0), (c as f64 + 0.5, 1.0)]).collect();
        // The box is 3 x 1, so `grid` 1 makes three cells: 0.5 to 1.5 and so on; the last takes the points at 3.5.
        let found = outline(&points, 1);
        assert_eq!(found.len(), 4, "{found:?}");
        let above: Vec<_> = found.iter().filter(|p| p.1 == 0.0).collect();
        let below: Vec<_> = found.iter().filter(|p| p.1 == 1.0).collect();
        assert!(above.iter().any(|p| p.0 == 1.5) && below.iter().any(|p| p.0 == 1.5), "{found:?}");
    }

    #[test]
    fn clouds_without_width_have_an_outline_and_single_points_have_none() {
        let column: Vec<_> = (0..=40).map(|k| (7.0, 0.25 * k as f64)).collect();
        let found = outline(&column, 5);
        // Five cells: there and back, the ends once.
        assert_eq!(found.len(), 8, "{found:?}");
        assert!(found.contains(&(7.0, 0.0)) && found.contains(&(7.0, 10.0)));
        let row: Vec<_> = column.iter().map(|p| (p.1, p.0)).collect();
        assert_eq!(outline(&row, 5).len(), 8);
        // Nearly without width: cells of its width would be ten millions.
        let thin: Vec<_> = column.iter().map(|p| (p.0 + 1e-7 * (p.1 * 13.0).sin(), p.1)).collect();
        assert_eq!(outline(&thin, 5).len(), 8);
        assert!(outline(&[], 5).is_empty());
        assert!(outline(&[(3.0, 4.0); 9], 5).is_empty());
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(outline(&[(3.0, 4.0), (4.0, 5.0), (bad, 1.0), (5.0, 0.0)], 5).is_empty());
        }
    }

    #[test]
    fn of_two_islands_the_one_with_the_left_most_point_is_outlined() {
        let block = |x: f64| {
            (0..100)
                .map(move |k| (x + f64::from(k % 10) / 10.0, f64::from(k / 10) / 10.0))
                .collect::<Vec<_>>()
        };
        // Cells of 0.225: the left block, 0 to 0.9 each way, fills five columns of four.
        let points = [block(0.0), block(5.0)].concat();
        let found = outline(&points, 4);
        assert!(found.len() == 14 && found.iter().all(|p| p.0 < 1.0), "{found:?}");
    }

    /// A disc of points: every outline point is near the circle, and the outline goes round once.
    #[test]
    fn a_disc_is_outlined_near_its_circle_once_round() {
        let n = 20_000;
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let points: Vec<_> = (0..n)
            .map(|k| {
                let (r, a) = (50.0 * ((k as f64 + 0.5) / n as f64).sqrt(), golden * k as f64);
                (r * a.cos(), r * a.sin())
            })
            .collect();
        let found = outline(&points, 30);
        let mut turned = 0.0;
        for (k, p) in found.iter().enumerate() {
            let q = found[(k + 1) % found.len()];
            let radius = p.0.hypot(p.1);
            assert!(radius > 49.0 && radius <= 50.0, "{radius}");
            turned += (p.0 * q.1 - p.1 * q.0).atan2(p.0 * q.0 + p.1 * q.1);
        }
        assert!((turned.abs() - std::f64::consts::TAU).abs() < 1e-9, "{turned}");
    }

    /// Property: on clouds of any shape the follower ends, gives points of the cloud alone, and every buffer is used again
    /// without a trace of the cloud before.
    #[test]
    fn the_follower_ends_on_random_clouds() {
        use rand::{Rng, SeedableRng};
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(11);
        let mut used = GridOutline::new();
        for _ in 0..3000 {
            let count = random.random_range(0..200);
            let (wide, high) =
                (10f64.powi(random.random_range(-9..4)), 10f64.powi(random.random_range(-9..4)));
            let steps: f64 = random.random_range(1.0..30.0);
            let points: Vec<(f64, f64)> = (0..count)
                .map(|_| {
                    // Rounded, so that points meet the borders of cells.
                    let mut along = || (random.random::<f64>() * steps).round() / steps;
                    (along() * wide, along() * high)
                })
                .collect();
            let grid = random.random_range(0..60);
            let fresh = outline(&points, grid);
            let again: Vec<_> = used.bound(&cloud(&points), grid).iter().map(|p| (p.x, p.y)).collect();
            assert_eq!(fresh, again);
            assert!(fresh.iter().all(|p| points.contains(p)), "{points:?} {grid}");
            // Once round and no more: a cell is passed at most once for each of its runs of empty neighbours.
            let filled = used.cells.iter().filter(|c| c.filled).count();
            assert!(fresh.len() <= 4 * filled, "{} visits of {filled} cells", fresh.len());
        }
    }
}
