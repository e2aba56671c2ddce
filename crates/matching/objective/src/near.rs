//! The nearest part of an outline, by place and direction. Sorted anew for each pose, into cells; no memory is taken once buffers have grown.

use biplane_geometry::{Point2, Vector2};
use biplane_outline::OutlinePoint;

/// Side of a cell, px.
const CELL_PX: f64 = 16.0;
/// Cells along a side at most: an outline larger than any picture has larger ones.
const MOST: f64 = 256.0;

/// The outline's samples in cells, each the little segment that it stands for.
#[derive(Debug, Clone, Default)]
pub(crate) struct Near {
    first: Point2,
    per_px: f64,
    cells: [usize; 2],
    start: Vec<u32>,
    order: Vec<u32>,
    /// Half the length of the longest segment, px.
    half: f64,
}

/// The nearest point of an outline.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Foot {
    /// Which sample it belongs to.
    pub sample: usize,
    pub pixel: Point2,
    /// Whether it lies within the segment, so that the way to it is along the normal.
    pub inside: bool,
    pub distance: f64,
}

impl Near {
    pub fn fill(&mut self, outline: &[OutlinePoint]) {
        let (mut low, mut high) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        self.half = 0.0;
        for p in outline {
            (low, high) = (low.inf(&p.pixel.coords), high.sup(&p.pixel.coords));
            self.half = self.half.max(p.length_px / 2.0);
        }
        self.start.clear();
        self.order.clear();
        self.cells = [0; 2];
        let span = (high - low).amax();
        if !span.is_finite() {
            return;
        }
        let side = CELL_PX.max(span / MOST);
        (self.first, self.per_px) = (Point2::from(low), 1.0 / side);
        self.cells = [0, 1].map(|axis| ((high[axis] - low[axis]) / side) as usize + 1);
        self.start.resize(self.cells[0] * self.cells[1] + 1, 0);
        for p in outline {
            let cell = self.cell_of(&p.pixel);
            self.start[cell + 1] += 1;
        }
        for k in 1..self.start.len() {
            self.start[k] += self.start[k - 1];
        }
        self.order.resize(outline.len(), 0);
        // Filled from the back of each cell, whose start then is that of the cell after it.
        for (number, p) in outline.iter().enumerate().rev() {
            let cell = self.cell_of(&p.pixel);
            self.start[cell + 1] -= 1;
            self.order[self.start[cell + 1] as usize] = number as u32;
        }
        let total = outline.len() as u32;
        self.start.remove(0);
        self.start.push(total);
    }

    fn cell(&self, p: &Point2, axis: usize) -> isize {
        ((p[axis] - self.first[axis]) * self.per_px).floor() as isize
    }

    fn cell_of(&self, p: &Point2) -> usize {
        let [x, y] = [0, 1].map(|axis| (self.cell(p, axis).max(0) as usize).min(self.cells[axis] - 1));
        y * self.cells[0] + x
    }

    /// The nearest point within `reach` px whose normal has at least `min_cosine` with `normal`.
    pub fn nearest(
        &self,
        outline: &[OutlinePoint],
        at: &Point2,
        normal: &Vector2,
        reach: f64,
        min_cosine: f64,
    ) -> Option<Foot> {
        let side = 1.0 / self.per_px;
        let [columns, rows] = self.cells.map(|c| c as isize);
        let (cx, cy) = (self.cell(at, 0), self.cell(at, 1));
        let rings = ((reach + self.half) / side).ceil() as isize + 1;
        let mut best: Option<Foot> = None;
        let mut least = reach;
        // A ring farther out holds nothing nearer; the first ones may lie beside the cells altogether.
        for ring in 0..=rings {
            if (ring - 1) as f64 * side - self.half > least {
                break;
            }
            for y in (cy - ring).max(0)..=(cy + ring).min(rows - 1) {
                let whole = (y - cy).abs() == ring;
                let mut x = cx - ring;
                while x <= cx + ring {
                    if (0..columns).contains(&x) {
                        let cell = (y * columns + x) as usize;
                        for &sample in &self.order[self.start[cell] as usize..self.start[cell + 1] as usize] {
                            let p = &outline[sample as usize];
                            if p.normal.dot(normal) < min_cosine {
                                continue;
                            }
                            let foot = foot(p, sample as usize, at);
                            if foot.distance < least {
                                least = foot.distance;
                                best = Some(foot);
                            }
                        }
                    }
                    x += if whole || ring == 0 { 1 } else { 2 * ring };
                }
            }
        }
        best
    }
}

/// The nearest point of the segment that a sample stands for.
fn foot(p: &OutlinePoint, sample: usize, at: &Point2) -> Foot {
    let tangent = Vector2::new(-p.normal.y, p.normal.x);
    let (along, half) = ((at - p.pixel).dot(&tangent), p.length_px / 2.0);
    let pixel = p.pixel + tangent * along.clamp(-half, half);
    Foot { sample, pixel, inside: along.abs() <= half, distance: (at - pixel).norm() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    #[test]
    fn finds_what_a_search_through_all_finds() {
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(4);
        let (any, mut near) = (any(), Near::default());
        let mut found = 0;
        for _ in 0..20 {
            let outline: Vec<OutlinePoint> = (0..random.random_range(0..400))
                .map(|_| {
                    let a: f64 = random.random_range(0.0..std::f64::consts::TAU);
                    let pixel =
                        Point2::new(random.random_range(-90.0..500.0), random.random_range(20.0..300.0));
                    let (normal, length_px) = (Vector2::new(a.cos(), a.sin()), random.random_range(0.1..2.0));
                    OutlinePoint { pixel, normal, length_px, ..any }
                })
                .collect();
            near.fill(&outline);
            for _ in 0..100 {
                let at = Point2::new(random.random_range(-250.0..650.0), random.random_range(-90.0..400.0));
                let (normal, reach) = (Vector2::new(0.6, -0.8), random.random_range(0.5..200.0));
                let all = outline.iter().enumerate().filter(|(_, p)| p.normal.dot(&normal) >= 0.3);
                let feet = all.map(|(k, p)| foot(p, k, &at).distance).filter(|d| *d < reach);
                let least = feet.fold(f64::INFINITY, f64::min);
                let own = near.nearest(&outline, &at, &normal, reach, 0.3);
                assert_eq!(own.map_or(f64::INFINITY, |f| f.distance), least);
                found += usize::from(own.is_some());
            }
        }
        assert!(found > 500, "{found}");
    }

    /// A point of an outline, with whatever it has besides.
    fn any() -> OutlinePoint {
        let mut outline = biplane_outline::Outline::new();
        let rim = biplane_outline::RimMesh::new(&crate::tests::body());
        let view = crate::tests::fluoroscopes().remove(0);
        outline.trace(&rim, &crate::tests::truth(), &view, biplane_outline::Sampling { step_px: 50.0 });
        outline.points()[0]
    }
}
