//! The stage `segment`: one frame in, its curves out.

use biplane_artifact::{Curves, Frame};
use biplane_geometry::Curve;
use biplane_grey::Grey;
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::crest::Field;
use crate::edges::{EdgeMap, find};
use crate::link;

inputs! {
    /// One frame.
    pub struct SegmentInputs {
        frame: Frame,
        /// At most one: a picture of the same size, 0 where edges do not count.
        mask: [Frame],
    }
}

/// How edges are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Crests of the gradient, by a difference that sees all directions alike.
    Canny,
    /// Crests of Sobel's gradient.
    Sobel,
    /// Crests of Prewitt's gradient.
    Prewitt,
    /// Crests of Roberts's cross.
    Roberts,
    /// Zeros of the Laplacian of Gaussian.
    Log,
    /// Where the picture crosses `level`.
    Threshold,
    /// The border of what is like `seeds_px` and hangs together with them.
    Region,
}

/// How edges are found. Grey levels are those of the frame scaled to 0..255, whatever its bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SegmentParams {
    /// What makes an edge: `"canny"`; `"sobel"`, `"prewitt"`, `"roberts"`, `"log"` (Laplacian of Gaussian), `"threshold"` and `"region"` are
    /// there to compare with, as the thesis did.
    pub method: Method,
    /// Standard deviation of the Gaussian that smooths the frame first, px. Larger finds fewer false edges and rounds
    /// corners off. 0 to 20.
    #[schemars(range(min = 0.0, max = 20.0))]
    pub smoothing_px: f64,
    /// An edge begins where the smoothed gradient reaches this, grey levels per px.
    #[schemars(range(min = 0.0))]
    pub high_threshold: f64,
    /// and goes on while it stays above this, grey levels per px.
    #[schemars(range(min = 0.0))]
    pub low_threshold: f64,
    /// In place of `high_threshold`: the share of all pixels, 0 to 1, whose gradient is above it.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub high_share: Option<f64>,
    /// In place of `low_threshold`: the share of all pixels, 0 to 1, whose gradient is above it.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub low_share: Option<f64>,
    /// Curves with fewer points (about one a pixel) are left out.
    #[schemars(range(min = 1))]
    pub min_points: usize,
    /// Gaps up to this are bridged where the edge goes on straight, px; 0 for none.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub bridge_px: f64,
    /// Whether points of curved edges are moved to where the edge was before it was blurred.
    pub correct_curved: bool,
    /// Only edges in this part of the picture: left, top, right, bottom, px.
    pub region_px: Option<[f64; 4]>,
    /// With `method = "threshold"`: the grey level, 0 to 255; without it the one that parts the picture best (Otsu).
    #[schemars(range(min = 0.0, max = 255.0))]
    pub level: Option<f64>,
    /// With `method = "region"`: where to grow from, px.
    pub seeds_px: Vec<[f64; 2]>,
    /// With `method = "region"`: how far a pixel's level may be from that of the seed, grey levels.
    #[schemars(range(min = 0.0))]
    pub tolerance: f64,
}

impl Default for SegmentParams {
    fn default() -> Self {
        Self {
            method: Method::Canny,
            smoothing_px: 1.0,
            high_threshold: 2.5,
            low_threshold: 1.0,
            high_share: None,
            low_share: None,
            min_points: 10,
            bridge_px: 4.0,
            correct_curved: true,
            region_px: None,
            level: None,
            seeds_px: Vec::new(),
            tolerance: 20.0,
        }
    }
}

/// Why a frame has no curves.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SegmentError {
    /// A parameter out of range.
    #[error("[segment] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// Growing a region needs a place to begin.
    #[error(
        "[segment] method = \"region\" without seeds_px: say where the region begins, e.g. seeds_px = [[512.0, 300.0]]"
    )]
    NoSeed,
    /// The part to look at is empty.
    #[error(
        "[segment] region_px = {region:?}: expected left, top, right, bottom in px, left below right and top below bottom"
    )]
    Region {
        /// As it was given.
        region: [f64; 4],
    },
    /// The mask does not fit.
    #[error(
        "the mask has {} x {} pixels, the frame {} x {}: they must be the same",
        mask[0], mask[1], frame[0], frame[1]
    )]
    Mask {
        /// Columns and rows.
        mask: [usize; 2],
        /// Columns and rows.
        frame: [usize; 2],
    },
    /// No edge passes the thresholds.
    #[error(
        "no edge in a frame of {width} x {height} pixels: its steepest places stay below high_threshold = {high} grey \
         levels per px; lower it in [segment], or look whether the picture is blank"
    )]
    NoEdge {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// The threshold.
        high: f64,
    },
}

/// Of so many pixels one counts for the share of pixels above a threshold.
const SHARE_STEP: usize = 7;

impl SegmentParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), SegmentError> {
        let Self { method, smoothing_px, high_threshold, low_threshold, high_share, low_share, .. } = *self;
        let bad = |name, value, expected| Err(SegmentError::Parameter { name, value, expected });
        if !(0.0..=20.0).contains(&smoothing_px) {
            return bad("smoothing_px", smoothing_px, "0 to 20 px");
        }
        if !(low_threshold >= 0.0 && low_threshold.is_finite()) {
            return bad("low_threshold", low_threshold, "a number of 0 or more");
        }
        if !(high_threshold >= low_threshold && high_threshold.is_finite()) {
            return bad("high_threshold", high_threshold, "at least low_threshold");
        }
        for (name, share) in [("high_share", high_share), ("low_share", low_share)] {
            if let Some(share) = share.filter(|s| !(0.0..=1.0).contains(s)) {
                return bad(name, share, "0 to 1");
            }
        }
        if let (Some(high), Some(low)) = (high_share, low_share)
            && low < high
        {
            return bad("low_share", low, "at least high_share: a lower threshold has more pixels above it");
        }
        if !(0.0..=50.0).contains(&self.bridge_px) {
            return bad("bridge_px", self.bridge_px, "0 to 50 px");
        }
        if let Some(level) = self.level.filter(|l| !(0.0..=255.0).contains(l)) {
            return bad("level", level, "a grey level of 0 to 255");
        }
        if !(self.tolerance >= 0.0 && self.tolerance.is_finite()) {
            return bad("tolerance", self.tolerance, "a number of 0 or more");
        }
        if let Some(region @ [left, top, right, bottom]) = self.region_px
            && !(left < right && top < bottom)
        {
            return Err(SegmentError::Region { region });
        }
        if method == Method::Region && self.seeds_px.is_empty() {
            return Err(SegmentError::NoSeed);
        }
        Ok(())
    }

    /// The low and the high threshold for a picture.
    pub(crate) fn thresholds(&self, field: &Field<'_>) -> [f64; 2] {
        let (w, h) = (field.smooth.width, field.smooth.height);
        let mut some: Vec<f32> = match (self.low_share, self.high_share) {
            (None, None) => Vec::new(),
            _ => (w + 1..w * (h - 1) - 1).step_by(SHARE_STEP).map(|k| field.size_at(k)).collect(),
        };
        let mut above = |share: Option<f64>| {
            let share = share.filter(|_| !some.is_empty())?;
            let place = ((1.0 - share) * some.len() as f64) as usize;
            let place = place.min(some.len() - 1);
            Some(f64::from(*some.select_nth_unstable_by(place, f32::total_cmp).1).sqrt())
        };
        let high = above(self.high_share).unwrap_or(self.high_threshold);
        let low = above(self.low_share).unwrap_or(self.low_threshold);
        [low.min(high), high]
    }
}

/// The stage `segment`.
#[derive(Debug, Clone, Copy)]
pub struct Segment;

impl Stage for Segment {
    const NAME: &'static str = "segment";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = SegmentInputs;
    type Params = SegmentParams;
    type Output = Curves;
    type Error = SegmentError;

    fn run(inputs: &SegmentInputs, params: &SegmentParams, _: &Context) -> Result<Curves, SegmentError> {
        curves(&inputs.frame, inputs.mask.first().map(|m| &**m), params)
    }
}

/// The edge curves of a frame, where `mask` (if any) is not 0.
///
/// # Errors
/// A parameter out of range, a mask of another size, or a frame without edges.
pub fn curves(frame: &Frame, mask: Option<&Frame>, params: &SegmentParams) -> Result<Curves, SegmentError> {
    params.check()?;
    let frame_size = [frame.width, frame.height];
    if let Some(mask) = mask.filter(|m| [m.width, m.height] != frame_size) {
        return Err(SegmentError::Mask { mask: [mask.width, mask.height], frame: frame_size });
    }
    let found = link(&edges_of(frame, mask, params), params);
    if found.is_empty() {
        let [width, height] = frame_size;
        return Err(SegmentError::NoEdge { width, height, high: params.high_threshold });
    }
    Ok(Curves::rounded(found))
}

/// The edge points of a frame, where `mask` (if any, of the same size) is not 0.
pub fn edges_of(frame: &Frame, mask: Option<&Frame>, params: &SegmentParams) -> EdgeMap {
    let smooth = Grey::of_smoothed(frame, params.smoothing_px);
    find(&smooth, mask.map(|m| m.samples.as_slice()), params)
}

/// The edge curves of a grey picture, where `mask` (if any) is not 0.
pub fn curves_of(grey: &Grey, mask: Option<&[u16]>, params: &SegmentParams) -> Vec<Curve> {
    link(&find(&grey.smoothed(params.smoothing_px), mask, params), params)
}
