//! The spots of a picture, each with those around it.

use biplane_artifact::Spots;
use biplane_geometry::Point2;

use crate::nearby::Nearby;

/// How many spots around each are looked at: those within about three spacings.
const AROUND: usize = 28;

/// The spots of a picture as recognition sees them.
#[derive(Debug, Clone)]
pub(crate) struct Seen {
    /// Recorded px.
    pub(crate) at: Vec<Point2>,
    /// Whether a spot is whole, so that its centre is that of a hole.
    pub(crate) whole: Vec<bool>,
    /// Radius of a spot, px.
    pub(crate) radius_px: Vec<f64>,
    /// The spots around each with their distances, px; nearest first, without itself.
    pub(crate) around: Vec<Vec<(usize, f64)>>,
    /// Middle of the picture, px.
    pub(crate) middle: Point2,
}

impl Seen {
    /// Sorts the spots of a picture, all of whose numbers are finite.
    pub(crate) fn new(spots: &Spots) -> Self {
        let at: Vec<Point2> = spots.spots.iter().map(|s| Point2::from(s.at_px)).collect();
        let nearby = Nearby::new(at.clone());
        let around = at.iter().enumerate().map(|(i, p)| {
            let mut found = nearby.closest(p, AROUND + 1);
            found.retain(|(other, _)| *other != i);
            found
        });
        Self {
            around: around.collect(),
            whole: spots.spots.iter().map(|s| !s.cut).collect(),
            radius_px: spots.spots.iter().map(|s| s.radius_px).collect(),
            middle: Point2::from(spots.size.map(|n| (n as f64 - 1.0) / 2.0)),
            at,
        }
    }

    /// Number of spots.
    pub(crate) fn len(&self) -> usize {
        self.at.len()
    }

    /// Number of whole spots.
    pub(crate) fn whole_count(&self) -> usize {
        self.whole.iter().filter(|whole| **whole).count()
    }

    /// Spots to begin with: whole ones, first the one in the middle of all spots, then others spread over the inner part.
    pub(crate) fn anchors(&self, most: usize) -> Vec<usize> {
        let mut whole: Vec<usize> = (0..self.len()).filter(|i| self.whole[*i]).collect();
        let median = |axis: usize| {
            let mut values: Vec<f64> = whole.iter().map(|i| self.at[*i][axis]).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied().unwrap_or_default()
        };
        let middle = Point2::new(median(0), median(1));
        let distance = |i: &usize| (self.at[*i] - middle).norm();
        whole.sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
        let inner = whole.len().div_ceil(2);
        let step = (inner / most.max(1)).max(1);
        whole.into_iter().take(inner).step_by(step).take(most).collect()
    }
}
