//! From edge curves and a start pose to the pose of a body, how well it fits, and how sure it is.
//!
//! **Objective.** Far from the pose, some samples of the visible outline and some points of the edges look for each other, in place
//! and direction; near it, each sample's residual is where its normal crosses the nearest curve of its direction and contrast. Weighed
//! robustly (Geman and McClure), so that a part of the outline that the image does not show, or an edge of something else, does not pull
//! the pose away. (The thesis's Eqs. 3.4 to 3.6 run from model to image alone, without direction.)
//!
//! **Optimiser.** Levenberg-Marquardt on the rotation group: the pose moves by a twist about the body's centroid, and a
//! rim point held fixed to the body has the same normal speed as the contour, so each residual's derivative is one exact
//! row of six.
//!
//! **Uncertainty.** From the residuals and their correlation along the contour, which is measured, and from the calibration's.
//!
//! **Starts.** The start given; where its match does not come out good, further ones around it, drawn from a seed. Where none of them
//! leads to a good pose, or none is given, those of a library of the body's silhouettes, each; of two poses that fit alike neither is
//! called good.
//!
//! That is `method = "rim"`; `method = "bingham2006"` is the thesis's own, to compare with: grid outline, mean distance and
//! bounded BFGS ([`descend`]); `method = "search"` is any objective by any optimiser ([`SearchParams`]).
//!
//! **Guaranteed:** a result depends on inputs and parameters alone. **Not guaranteed:** that the best basin was found; the
//! verdict says what speaks against a pose, from the fit alone.

mod answer;
mod bias;
mod bingham;
mod claimed;
mod consistency;
mod judge;
mod noise;
mod refine;
mod search;
mod stage;
mod starts;
mod track;

pub use answer::with_calibration;
pub use bias::{BiasParams, take_out};
pub use bingham::{
    BinghamParams, BinghamView, Contour, Descent, best, descend, match_bingham, own_contour, spread,
};
pub use biplane_edge_field::EdgeField;
pub use consistency::{Disagreement, disagreement, pose_covariance_of_calibration};
pub use judge::{Limits, judge};
pub use refine::{Evidence, RefineParams, Refined, View, assess, refine};
pub use search::{Ended, SearchParams, Single, lowest};
pub use stage::{
    Contrast, EdgeBias, MatchBody, MatchError, MatchInputs, MatchParams, Method, match_anywhere, match_body,
    prepared_rim,
};
pub use track::{TrackFrame, TrackFrameParams, TrackInputs, TrackParams};
