//! Edge points of a picture, to a fraction of a pixel, by the method that the parameters name.
//!
//! All methods go the same way: a picture is smoothed, pixels that an edge runs through are found, hysteresis keeps those above
//! the low threshold that hang together with one above the high one, and only what is kept is placed to a fraction of a pixel.
//! What differs is what makes an edge: a **crest** of the gradient's size (Canny, Sobel, Prewitt, Roberts: [`crate::crest`]) or a
//! **crossing** of zero by some field (Laplacian of Gaussian, thresholding, region growing: [`crate::crossing`]).

use biplane_geometry::{EdgePoint, Point2, Vector2};
use biplane_grey::Grey;

use crate::{Method, SegmentParams, crest, crossing};

/// Pixels at the picture's edge without edge points: the gradient of its neighbours is needed around each.
pub(crate) const BORDER: usize = 2;

/// Edge points, and which pixel each came from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EdgeMap {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The points, in the order of their pixels, row by row.
    pub points: Vec<EdgePoint>,
    /// The pixel that each point was found at, `y * width + x`; ascending.
    pub pixels: Vec<u32>,
    /// Square of the edge's width at each point as [`crate::curved`] takes it, px^2.
    pub(crate) blurs: Vec<f64>,
    /// What times its curvature the fit places a point too far inside a curved edge, px^2.
    pub(crate) fit: f64,
}

/// What the search for edges leaves for hysteresis, a byte for each pixel: 0, or
pub(crate) const CANDIDATE: u8 = 1;
/// above the high threshold too, or
pub(crate) const STRONG: u8 = 2;
/// kept.
const KEPT: u8 = 4;

/// Finds the edge points of a picture given as grey levels of 0..255, row by row.
///
/// `samples` must have `width * height` elements; otherwise, as for a picture under 8 px a side, there are no edges.
pub fn find_edges(width: usize, height: usize, samples: Vec<f32>, params: &SegmentParams) -> EdgeMap {
    if width.checked_mul(height) != Some(samples.len()) {
        return EdgeMap::default();
    }
    let grey = Grey { width, height, samples };
    find(&grey.smoothed(params.smoothing_px), None, params)
}

/// Finds the edge points of a picture that was smoothed as the parameters say, where `mask` (of the same size, if any) is not 0.
pub(crate) fn find(smooth: &Grey, mask: Option<&[u16]>, params: &SegmentParams) -> EdgeMap {
    let (width, height) = (smooth.width, smooth.height);
    if width < 8 || height < 8 {
        return EdgeMap { width, height, ..EdgeMap::default() };
    }
    let wanted = |pixel: u32| {
        let pixel = pixel as usize;
        let inside = params.region_px.is_none_or(|[left, top, right, bottom]| {
            let (x, y) = ((pixel % width) as f64, (pixel / width) as f64);
            (left..=right).contains(&x) && (top..=bottom).contains(&y)
        });
        inside && mask.is_none_or(|m| m.get(pixel).is_none_or(|v| *v != 0))
    };
    match params.method.gradient() {
        Some(operator) => {
            let field = crest::Field { smooth, operator };
            let [low, high] = params.thresholds(&field);
            let pixels = keep_connected(width, field.crests(low, high), wanted);
            let (points, blurs) = field.points(
                &pixels,
                &smooth.noise_before_smoothing(params.smoothing_px),
                params.smoothing_px,
            );
            EdgeMap { width, height, points, pixels, blurs, fit: crest::FIT_VARIANCE / 2.0 }
        }
        None => crossing::find(smooth, params, wanted),
    }
}

/// Hysteresis: the wanted candidates that are connected to a strong one through the 8 neighbours of each pixel, ascending. No
/// candidate lies at the picture's edge.
pub(crate) fn keep_connected(width: usize, mut marks: Vec<u8>, wanted: impl Fn(u32) -> bool) -> Vec<u32> {
    let around = [1, width - 1, width, width + 1];
    let mut kept = Vec::new();
    let mut todo = Vec::new();
    for block in 0..marks.len() / 8 {
        let eight = &marks[8 * block..8 * block + 8];
        // Most of a picture is no edge: eight pixels are passed over at once.
        if eight.iter().fold(0, |all, m| all | m) & STRONG == 0 {
            continue;
        }
        for k in 8 * block..8 * block + 8 {
            if marks[k] & (STRONG | KEPT) != STRONG || !wanted(k as u32) {
                continue;
            }
            marks[k] = KEPT;
            todo.push(k);
            while let Some(k) = todo.pop() {
                kept.push(k as u32);
                for n in around.iter().flat_map(|a| [k - a, k + a]) {
                    if marks[n] & (CANDIDATE | STRONG) != 0 && wanted(n as u32) {
                        marks[n] = KEPT;
                        todo.push(n);
                    }
                }
            }
        }
    }
    kept.sort_unstable();
    kept
}

/// The point at `offset` px along `direction` (unit, dark to bright) from a pixel's centre.
pub(crate) fn point_at(
    [x, y]: [f64; 2],
    offset: f64,
    direction: Vector2,
    strength: f64,
    sigma_px: f64,
) -> EdgePoint {
    EdgePoint {
        position: Point2::new(x, y) + offset * direction,
        direction,
        strength,
        sigma_px: sigma_px.clamp(0.01, 1.0),
    }
}

impl Method {
    /// What makes its crests; `None` for a method that looks for crossings.
    fn gradient(self) -> Option<crest::Operator> {
        match self {
            Self::Canny => Some(crest::Operator::Isotropic),
            Self::Sobel => Some(crest::Operator::Sobel),
            Self::Prewitt => Some(crest::Operator::Prewitt),
            Self::Roberts => Some(crest::Operator::Roberts),
            Self::Log | Self::Threshold | Self::Region => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn params() -> SegmentParams {
        SegmentParams::default()
    }

    /// A bright half plane whose edge is at distance `c` from the origin along `angle`, blurred by a Gaussian of 1 px:
    /// the value at a pixel is the normal distribution function of its distance.
    fn half_plane(angle: f64, c: f64) -> EdgeMap {
        let (w, h) = (64, 64);
        let (s, n) = angle.sin_cos();
        let samples = (0..w * h)
            .map(|k| {
                let d = (k % w) as f64 * n + (k / w) as f64 * s - c;
                (40.0 + 100.0 * normal_distribution(d)) as f32
            })
            .collect();
        let mut map = find_edges(w, h, samples, &params());
        // Nearer to the border the mirrored picture bends the edge.
        map.points.retain(|p| p.position.iter().all(|v| (9.0..=54.0).contains(v)));
        map
    }

    /// By Simpson's rule: no error function in the standard library.
    fn normal_distribution(x: f64) -> f64 {
        let x = x.clamp(-8.0, 8.0);
        let n = 400;
        let h = (x + 8.0) / f64::from(n);
        let f = |t: f64| (-t * t / 2.0).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let sum: f64 = (0..=n)
            .map(|i| {
                let weight = if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                weight * f(-8.0 + h * f64::from(i))
            })
            .sum();
        sum * h / 3.0
    }

    #[test]
    fn straight_edges_are_placed_to_0_015_px_at_any_angle() {
        let mut worst: f64 = 0.0;
        for k in 0..36 {
            let angle = f64::from(k) * 10.0_f64.to_radians();
            let (s, n) = angle.sin_cos();
            let c = 32.0 * (n + s) + 0.13 * f64::from(k % 8);
            let map = half_plane(angle, c);
            assert!(map.points.len() > 40, "angle {k}0: {} points", map.points.len());
            for p in &map.points {
                let off = p.position.x * n + p.position.y * s - c;
                worst = worst.max(off.abs());
                assert!(p.direction.dot(&Vector2::new(n, s)) > 0.999, "dark to bright");
            }
        }
        assert!(worst < 0.015, "worst {worst} px");
    }

    #[test]
    fn an_edge_is_one_pixel_wide_and_without_gaps() {
        for k in 0..18 {
            let angle = f64::from(k) * 10.0_f64.to_radians();
            let (s, n) = angle.sin_cos();
            let map = half_plane(angle, 32.0 * (n + s));
            // Along the axis that the edge crosses more steeply there is one point a line.
            let along = |p: &EdgePoint| if n.abs() > s.abs() { p.position.y } else { p.position.x };
            let mut lines: Vec<i64> = map.points.iter().map(|p| along(p).round() as i64).collect();
            lines.sort_unstable();
            assert!(lines.windows(2).all(|p| p[1] - p[0] <= 1), "angle {k}0 has a gap");
            // Near 45 degrees an edge passes between pixels of both axes: up to two a line, never thicker.
            assert!(lines.len() <= 100, "angle {k}0: {} points over 46 lines", lines.len());
        }
    }

    #[test]
    fn no_edges_where_there_are_none() {
        assert!(find_edges(64, 64, vec![7.0; 64 * 64], &params()).points.is_empty());
        assert!(find_edges(3, 3, vec![7.0; 9], &params()).points.is_empty());
        assert!(find_edges(30, 3, vec![7.0; 9], &params()).points.is_empty());
    }
}
