//! Edge points of an image, linked into curves.

use crate::{Point2, Vector2};

/// One point of an edge, to a fraction of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// Where, px.
    pub position: Point2,
    /// Unit vector across the edge, from dark to bright.
    pub direction: Vector2,
    /// Size of the smoothed gradient across the edge, grey levels per px of the frame scaled to 0..255.
    pub strength: f64,
    /// Standard deviation of the position across the edge, px.
    pub sigma_px: f64,
}

/// Edge points in order along an edge.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// In order; neighbours are about one pixel apart.
    pub points: Vec<EdgePoint>,
    /// Whether the last point is followed by the first.
    pub closed: bool,
}
