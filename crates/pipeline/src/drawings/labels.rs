//! Names beside marks, put where they cover each other and other marks least.

use super::svg::text_width;

/// Rectangles that are taken: left, top, right, bottom.
#[derive(Debug)]
pub(super) struct Labels {
    bounds: [f64; 4],
    taken: Vec<[f64; 4]>,
}

impl Labels {
    /// For a picture that reaches from `first` over `extent`, with marks of a radius at places.
    pub(super) fn new(
        first: [f64; 2],
        extent: [f64; 2],
        marks: impl Iterator<Item = ([f64; 2], f64)>,
    ) -> Self {
        let [left, top] = first;
        let bounds = [left, top, left + extent[0], top + extent[1]];
        Self { bounds, taken: marks.map(|([x, y], r)| [x - r, y - r, x + r, y + r]).collect() }
    }

    /// Where the base line of a name begins that belongs to the mark of a radius at `at`.
    ///
    /// Eight places around the mark are tried, the upper right one first; the one that covers least is taken.
    pub(super) fn place(&mut self, at: [f64; 2], radius: f64, name: &str, size: f64) -> [f64; 2] {
        let (width, height) = (text_width(name, size), size);
        let (near, far) = (radius + 0.15 * size, 0.7 * radius);
        let [x, y] = at;
        let corners = [
            [x + far, y - far - height],
            [x + near, y - height / 2.0],
            [x + far, y + far],
            [x - far - width, y - far - height],
            [x - near - width, y - height / 2.0],
            [x - far - width, y + far],
            [x - width / 2.0, y - near - height],
            [x - width / 2.0, y + near],
        ];
        let boxes = corners.map(|[left, top]| [left, top, left + width, top + height]);
        let cost = |b: &[f64; 4]| -> f64 {
            let covered: f64 = self.taken.iter().map(|t| overlap(b, t)).sum();
            covered + 4.0 * (width * height - overlap(b, &self.bounds))
        };
        let mut best = (f64::INFINITY, boxes[0]);
        for candidate in boxes {
            let cost = cost(&candidate);
            if cost < best.0 {
                best = (cost, candidate);
            }
        }
        self.taken.push(best.1);
        [best.1[0], best.1[1] + 0.8 * height]
    }
}

/// Area that two rectangles have in common.
fn overlap(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let side = |low: usize, high: usize| (a[high].min(b[high]) - a[low].max(b[low])).max(0.0);
    side(0, 2) * side(1, 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_avoids_its_neighbour_and_the_edge() {
        let marks = [([50.0, 50.0], 5.0), ([62.0, 42.0], 5.0), ([98.0, 3.0], 5.0)];
        let mut labels = Labels::new([0.0, 0.0], [100.0, 100.0], marks.into_iter());
        let [x, y] = labels.place([50.0, 50.0], 5.0, "12", 10.0);
        assert!(y > 50.0 || x < 50.0, "the upper right is taken: {x}, {y}");
        let [x, y] = labels.place([98.0, 3.0], 5.0, "7", 10.0);
        assert!(x < 95.0 && y > 3.0, "outside the picture: {x}, {y}");
    }
}
