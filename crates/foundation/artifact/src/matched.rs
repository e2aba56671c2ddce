//! The answer of a match: a pose, how well it fits, how sure it is, and whether it can be trusted.

use biplane_geometry::{Pose, Vector3};
use serde::{Deserialize, Serialize};

use crate::content::{decode_json, encode_json, hash_encoded};
use crate::{Artifact, Content, ContentHash, DecodeError};

/// Whether a pose can be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Fits in every view; use it.
    Good,
    /// Fits, but something speaks against it; look at its overlay.
    Doubtful,
    /// Another pose fits as well, and the pictures cannot tell which is right; a start near the right one can.
    Ambiguous,
    /// Does not fit; the pose is only where the search ended.
    Failed,
}

impl Verdict {
    /// The word in files and tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Doubtful => "doubtful",
            Self::Ambiguous => "ambiguous",
            Self::Failed => "failed",
        }
    }
}

/// A pose as numbers: `world_from_model`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PoseRecord {
    /// Translation, mm.
    pub translation_mm: [f64; 3],
    /// Unit quaternion, scalar first.
    pub quaternion_wxyz: [f64; 4],
}

impl From<Pose> for PoseRecord {
    fn from(pose: Pose) -> Self {
        let (t, q) = (pose.translation(), pose.rotation());
        // The one of the two quaternions of a rotation whose scalar part is not negative.
        let s = if q.w < 0.0 { -1.0 } else { 1.0 };
        Self { translation_mm: [t.x, t.y, t.z], quaternion_wxyz: [s * q.w, s * q.i, s * q.j, s * q.k] }
    }
}

impl From<PoseRecord> for Pose {
    fn from(record: PoseRecord) -> Self {
        let [w, x, y, z] = record.quaternion_wxyz;
        let rotation = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        Pose::new(rotation, Vector3::from(record.translation_mm))
    }
}

/// How one view's outline fits its edges.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ViewFit {
    /// Root mean square distance of the matched outline points from their edges, px.
    pub rms_px: f64,
    /// The same at the body's depth, mm.
    pub rms_mm: f64,
    /// Share of the visible outline's length, within the image, that found its edge, 0 to 1.
    pub matched_share: f64,
    /// Share of the outline's length that lies within the image, 0 to 1.
    pub in_image_share: f64,
    /// Length of the outline, px.
    pub outline_px: f64,
    /// How far the view's edges lie inside the outline as a whole, px; taken out of the residuals.
    pub inset_px: f64,
}

/// What the starts of a search led to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StartsTried {
    /// Starts from which the search was run.
    pub tried: u32,
    /// Those from which it came to rest.
    pub converged: u32,
    /// Sample standard deviation of the poses that these came to rest at, in the order of [`Match::covariance`] (mm, rad); none
    /// for fewer than two.
    pub spread: Option<[f64; 6]>,
}

/// A pose beside the one that was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Alternative {
    /// `world_from_model`.
    pub pose: PoseRecord,
    /// As [`Match::objective`].
    pub objective: f64,
}

/// One body in one frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Match {
    /// `world_from_model`.
    pub pose: PoseRecord,
    /// Whether to trust it.
    pub verdict: Verdict,
    /// Why the verdict is not good; empty if it is.
    pub reason: String,
    /// One a view, in the order of the views.
    pub views: Vec<ViewFit>,
    /// By what poses were compared at the end; of several the least is the answer. With `method = "rim"` it is 1 less the share of the
    /// outline on the picture that fits its edges well, mean over the views, no unit; with `"bingham2006"` the thesis's Eq. 3.6: the
    /// distance of outline from contour, mean in each view, sum over the views, mm.
    pub objective: f64,
    /// Covariance of the pose, rows: translation x, y, z (mm), then rotation x, y, z (rad), in laboratory axes, at the
    /// mesh's area centroid. From the residuals of the outline, and [`Self::calibration_covariance`] where that is known; a wrong
    /// mesh is not in it. Numbers are immense where the edges do not hold every motion.
    pub covariance: [[f64; 6]; 6],
    /// The part of [`Self::covariance`] that the calibration's uncertainty brings, the same for all frames of a study in
    /// which the body stands alike; none where nothing is known of it.
    pub calibration_covariance: Option<[[f64; 6]; 6]>,
    /// Half-widths of the intervals that hold each of the six with a probability of 95 %, mm and rad, in the order of the covariance.
    pub interval_95: [f64; 6],
    /// What the starts led to.
    pub starts: StartsTried,
    /// Another pose that fits as well, where there is one.
    pub alternative: Option<Alternative>,
    /// Steps of the optimiser, all starts together.
    pub iterations: u32,
}

impl Match {
    /// Standard deviation of the centroid's position, mm: root of the sum over the three axes.
    pub fn translation_sigma_mm(&self) -> f64 {
        sigmas(&self.covariance)[0]
    }

    /// Standard deviation of the rotation, rad: root of the sum over the three axes.
    pub fn rotation_sigma_rad(&self) -> f64 {
        sigmas(&self.covariance)[1]
    }

    /// What of the two the calibration brings, mm and rad, where that is known.
    pub fn calibration_sigmas(&self) -> Option<[f64; 2]> {
        self.calibration_covariance.as_ref().map(sigmas)
    }
}

/// Roots of the sums of the variances of position (mm) and of rotation (rad).
fn sigmas(covariance: &[[f64; 6]; 6]) -> [f64; 2] {
    [0, 3].map(|from| (from..from + 3).map(|i| covariance[i][i]).sum::<f64>().sqrt())
}

impl Content for Match {
    const KIND: &'static str = "match";
    const SCHEMA: u32 = 2;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for Match {
    const EXTENSION: &'static str = "json";

    fn encode(&self) -> Vec<u8> {
        encode_json(self)
    }

    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        decode_json(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_go_from_good_to_failed() {
        let order = [Verdict::Good, Verdict::Doubtful, Verdict::Ambiguous, Verdict::Failed];
        assert!(order.is_sorted());
        assert_eq!(order.map(Verdict::word), ["good", "doubtful", "ambiguous", "failed"]);
        let stored = order.map(|v| serde_json::to_string(&v).unwrap());
        assert_eq!(stored, order.map(|v| format!("\"{}\"", v.word())), "files have the same words");
    }

    #[test]
    fn round_trip_keeps_every_bit() {
        let pose = Pose::new(
            nalgebra::UnitQuaternion::from_euler_angles(0.1, 0.2, 3.1),
            Vector3::new(1.0 / 3.0, -2e-7, 1e5 / 7.0),
        );
        let value = Match {
            pose: pose.into(),
            verdict: Verdict::Doubtful,
            reason: "view B: 41 % of the outline found".to_owned(),
            views: vec![],
            objective: 0.1 + 0.2,
            covariance: [[f64::MAX; 6]; 6],
            calibration_covariance: Some([[1.0 / 7.0; 6]; 6]),
            interval_95: [1.0 / 11.0; 6],
            starts: StartsTried { tried: 13, converged: 2, spread: Some([1e-9 / 3.0; 6]) },
            alternative: Some(Alternative { pose: PoseRecord::from(pose), objective: 0.3 }),
            iterations: 12,
        };
        assert_eq!(Match::decode(&value.encode()), Ok(value.clone()));
        assert!(Pose::from(value.pose).rotation().angle_to(&pose.rotation()) < 1e-9);
        assert!(Match::decode(b"{}").is_err());
        let single = Match { covariance: [[3.0; 6]; 6], ..value };
        assert_eq!((single.translation_sigma_mm(), single.rotation_sigma_rad()), (3.0, 3.0));
        assert_eq!(single.calibration_sigmas(), Some([(3.0f64 / 7.0).sqrt(); 2]));
    }
}
