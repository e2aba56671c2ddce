//! Edge points of a picture, to a fraction of a pixel, by the method that the parameters name.
//!
//! All methods go the same way: a picture is smoothed, pixels that an edge runs through are found, hysteresis keeps those above
//! the low threshold that hang together with one above the high one, and only what is kept is placed to a fraction of a pixel.
//! What differs is what makes an edge: a **crest** of the gradient's size (Canny, Sobel, Prewitt, Roberts: [`crate::crest`]) or a
//! **crossing** of zero by some field (Laplacian of Gaussian, thresholding, region growing: [`crate::crossing`]).

use biplane_geometry::{EdgePoint, Point2, Vector2};
use biplane_grey::{Grey, Noise};

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
    /// The pixel of each point, `y * width + x`; ascending.
    pub(crate) pixels: Vec<u32>,
    /// Square of the edge's width at each point as [`crate::curved`] takes it, px^2.
    pub(crate) blurs: Vec<f64>,
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
    find(&grey.smoothed(params.smoothing_px), || grey.noise(), None, params)
}

/// Finds the edge points of a smoothed picture, where `mask` (of the same size, if any) is not 0, given the noise that it had
/// before it was smoothed.
pub(crate) fn find(
    smooth: &Grey,
    noise: impl FnOnce() -> Noise,
    mask: Option<&[u16]>,
    params: &SegmentParams,
) -> EdgeMap {
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
            let (points, blurs) = field.points(&pixels, &noise(), params.smoothing_px);
            EdgeMap { width, height, points, pixels, blurs }
        }
        None => crossing::find(smooth, noise, params, wanted),
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
