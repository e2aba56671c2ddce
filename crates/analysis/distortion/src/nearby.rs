//! Points of a plane sorted into square cells, to find the nearest ones fast.
//!
//! **Guaranteed:** answers are those of comparing all points, ties by the lower number; the memory is that of the points, wherever
//! they lie. **Not guaranteed:** speed where a few points lie far from all others.

use biplane_geometry::Point2;

/// Points in cells.
#[derive(Debug, Clone)]
pub(crate) struct Nearby {
    points: Vec<Point2>,
    first: Point2,
    /// Side of a cell.
    cell: f64,
    count: [usize; 2],
    /// Where each cell's points begin in `order`; one more than cells.
    start: Vec<usize>,
    /// Numbers of points, cell by cell.
    order: Vec<usize>,
}

impl Nearby {
    /// Sorts points, which are finite.
    pub(crate) fn new(points: Vec<Point2>) -> Self {
        let (mut first, mut last) = (Point2::new(f64::MAX, f64::MAX), Point2::new(f64::MIN, f64::MIN));
        for p in &points {
            (first, last) = (first.inf(p), last.sup(p));
        }
        let extent = if points.is_empty() { Point2::origin().coords } else { last - first };
        let number = points.len().max(1) as f64;
        // Two points a cell where they are spread evenly; at most twice as many cells as points where they are not.
        let cell = (extent.x * extent.y * 2.0 / number).sqrt().max(extent.max() / number);
        let cell = if cell > 0.0 && cell.is_finite() { cell } else { 1.0 };
        let most = points.len().max(1);
        let count = [0, 1].map(|a| ((extent[a] / cell) as usize + 1).min(most));
        let mut nearby =
            Self { points, first, cell, count, start: vec![0; count[0] * count[1] + 1], order: Vec::new() };
        let cells: Vec<usize> = nearby.points.iter().map(|p| nearby.cell_of(p)).collect();
        for &c in &cells {
            nearby.start[c + 1] += 1;
        }
        for c in 1..nearby.start.len() {
            nearby.start[c] += nearby.start[c - 1];
        }
        let mut next = nearby.start.clone();
        nearby.order = vec![0; cells.len()];
        for (i, &c) in cells.iter().enumerate() {
            nearby.order[next[c]] = i;
            next[c] += 1;
        }
        nearby
    }

    /// The points, as they were given.
    pub(crate) fn points(&self) -> &[Point2] {
        &self.points
    }

    /// Column and row of the cell, clamped to those that there are.
    fn place(&self, p: &Point2) -> [usize; 2] {
        // A negative or infinite number becomes the nearest one that there is.
        [0, 1].map(|a| (((p[a] - self.first[a]) / self.cell) as usize).min(self.count[a] - 1))
    }

    fn cell_of(&self, p: &Point2) -> usize {
        let [i, j] = self.place(p);
        j * self.count[0] + i
    }

    /// Numbers and distances of the points within `reach` of a place, nearest first.
    pub(crate) fn within(&self, place: &Point2, reach: f64) -> Vec<(usize, f64)> {
        let mut found = Vec::new();
        if self.points.is_empty() || reach.is_nan() || reach < 0.0 {
            return found;
        }
        let low = self.place(&place.map(|v| v - reach));
        let high = self.place(&place.map(|v| v + reach));
        for j in low[1]..=high[1] {
            let row = j * self.count[0];
            for &i in &self.order[self.start[row + low[0]]..self.start[row + high[0] + 1]] {
                let distance = (self.points[i] - place).norm();
                if distance <= reach {
                    found.push((i, distance));
                }
            }
        }
        found.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        found
    }

    /// Numbers and distances of the `most` nearest points, nearest first.
    pub(crate) fn closest(&self, place: &Point2, most: usize) -> Vec<(usize, f64)> {
        let most = most.min(self.points.len());
        let mut reach = self.cell * (most as f64).sqrt();
        loop {
            let mut found = self.within(place, reach);
            if found.len() >= most || !reach.is_finite() {
                found.truncate(most);
                return found;
            }
            reach *= 2.0;
        }
    }

    /// The nearest point and its distance.
    pub(crate) fn nearest(&self, place: &Point2) -> Option<(usize, f64)> {
        self.closest(place, 1).first().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scattered(count: u32) -> Vec<Point2> {
        (0..count)
            .map(|k| Point2::new(f64::from(k * 7919 % 1009), f64::from(k * 104_729 % 733) * 0.37))
            .collect()
    }

    #[test]
    fn nearest_are_those_of_comparing_all() {
        let points = scattered(300);
        let nearby = Nearby::new(points.clone());
        for place in [Point2::new(500.0, 100.0), Point2::new(-4000.0, 9.0), Point2::new(3.0, 260.0)] {
            let mut all: Vec<(usize, f64)> = points.iter().map(|p| (p - place).norm()).enumerate().collect();
            all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            assert_eq!(nearby.closest(&place, 17), all[..17]);
            assert_eq!(nearby.nearest(&place), Some(all[0]));
            let inside = all.iter().filter(|(_, d)| *d <= 130.0).count();
            assert_eq!(nearby.within(&place, 130.0), all[..inside]);
        }
        assert_eq!(nearby.closest(&Point2::origin(), 1000).len(), 300);
    }

    #[test]
    fn degenerate_sets_are_no_harm() {
        assert_eq!(Nearby::new(Vec::new()).nearest(&Point2::origin()), None);
        let same = Nearby::new(vec![Point2::new(3.0, 3.0); 4]);
        assert_eq!(same.nearest(&Point2::origin()).unwrap().0, 0);
        let far = Nearby::new(vec![Point2::origin(), Point2::new(1e300, 1.0), Point2::new(2.0, 0.0)]);
        assert_eq!(far.closest(&Point2::new(1.9, 0.0), 2).iter().map(|f| f.0).collect::<Vec<_>>(), [2, 0]);
        let line = Nearby::new((0..100).map(|k| Point2::new(f64::from(k), 5.0)).collect());
        assert_eq!(line.nearest(&Point2::new(41.2, 0.0)).unwrap().0, 41);
    }
}
