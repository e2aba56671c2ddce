//! The stage `axes`: a body's mesh and what a person said of it in, its local coordinate system out.

use biplane_artifact::{AxesFeature, AxesSource, BodyAxes, BodyKind, Landmark, Landmarks, ModelMesh, Side};
use biplane_geometry::{Mesh, Vector3};
use biplane_stage::{Context, Stage, inputs};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use crate::figures;
use crate::frame::Frame;
use crate::landmarks::{self, Given};
use crate::points;
use crate::proposal::{self, Proposal, Refusal};
use crate::shape::Shape;

inputs! {
    /// A mesh, and the landmarks that a person gave: none or one list.
    pub struct AxesInputs {
        model: ModelMesh,
        landmarks: [Landmarks],
    }
}

/// In which frame the mesh's coordinates are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelFrame {
    /// `lps` for a body from slices, `unknown` for one from a mesh file.
    #[default]
    Auto,
    /// It is not known: up, down, front and back are told by the shape alone.
    Unknown,
    /// Left-posterior-superior, as of an MRI or CT of a subject who lies straight: what is up and in front is then known, within some
    /// 40 degrees.
    Lps,
}

/// What a body is, and what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct AxesParams {
    /// What the body is; decides how its axes are found.
    #[schemars(schema_with = "bodies")]
    pub body: BodyKind,
    /// Side of the subject; has to be said for all bodies but `other`, which is taken for one of the right side where it is not.
    #[schemars(schema_with = "sides")]
    pub side: Option<Side>,
    /// In which frame the mesh's coordinates are.
    pub frame: ModelFrame,
}

fn bodies(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "type": "string",
        "enum": ["femur", "tibia", "patella", "femoral_component", "tibial_tray", "other"]
    })
}

fn sides(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": ["left", "right"] })
}

impl Default for AxesParams {
    fn default() -> Self {
        Self { body: BodyKind::Other, side: None, frame: ModelFrame::Auto }
    }
}

/// Why a body has no axes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AxesError {
    /// The side was not said.
    #[error(
        "the side of a {body} has to be said: set side = \"left\" or side = \"right\" in its [[body]] (the subject's side)"
    )]
    NoSide {
        /// What the body is.
        body: &'static str,
    },
    /// An origin and axis points that are not all there.
    #[error(
        "of the axes' points origin, x, y, z the landmarks have {found}; {missing} is missing: give origin and at least two of \
         x, y, z, or none of x, y, z"
    )]
    PointsMissing {
        /// Those there are.
        found: String,
        /// Those there should be.
        missing: String,
    },
    /// Axis points that give no axes.
    #[error(
        "the landmarks origin, x, y, z give no axes: {what}; give points well apart, on axes that are square to each other"
    )]
    PointsDegenerate {
        /// What is wrong with them.
        what: String,
    },
    /// Axis points of a mirror image.
    #[error(
        "the landmarks origin, x, y, z give left-handed axes; x is anterior, y proximal, z to the subject's right, for left and \
         right bodies alike: one of the points is on the wrong side of the origin, or two are swapped"
    )]
    PointsLeftHanded,
    /// A landmark under two words.
    #[error("the landmark {name} is given twice, the second time as {word:?}; keep one of them")]
    LandmarkTwice {
        /// Its name.
        name: &'static str,
        /// The word of the second one.
        word: String,
    },
    /// Landmarks that lie so that they give no axes.
    #[error("the landmarks' lines {what} are nearly parallel or have no length; check their coordinates")]
    LandmarksDegenerate {
        /// Which lines.
        what: String,
    },
    /// Landmarks that do not suffice, and which the shape cannot complete.
    #[error("the landmarks of this {body} are not enough: {found}{why}. It needs {sets}")]
    LandmarksMissing {
        /// What the body is.
        body: &'static str,
        /// What there is, misspellings among it.
        found: String,
        /// Why the shape does not fill in.
        why: String,
        /// What would do.
        sets: String,
    },
    /// A landmark's coordinate is not a number.
    #[error("the landmark {name:?} has a coordinate that is not a finite number")]
    LandmarkNotFinite {
        /// Its name.
        name: String,
    },
    /// The shape does not say where the axes are.
    #[error("the axes of this {body} cannot be proposed from its shape: {why}. Give landmarks: {sets}")]
    Shape {
        /// What the body is.
        body: &'static str,
        /// What was found.
        why: String,
        /// What would do instead.
        sets: String,
    },
    /// The run was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// A kind of body in plain words.
pub(crate) fn body_name(body: BodyKind) -> &'static str {
    match body {
        BodyKind::Femur => "femur",
        BodyKind::Tibia => "tibia",
        BodyKind::Patella => "patella",
        BodyKind::FemoralComponent => "femoral component",
        BodyKind::TibialTray => "tibial tray",
        BodyKind::Other => "body",
    }
}

impl AxesParams {
    /// # Errors
    /// The side is missing where the body needs one.
    pub fn check(&self) -> Result<(), AxesError> {
        if self.body != BodyKind::Other && self.side.is_none() {
            return Err(AxesError::NoSide { body: body_name(self.body) });
        }
        Ok(())
    }
}

/// The stage `axes`.
#[derive(Debug, Clone, Copy)]
pub struct Axes;

impl Stage for Axes {
    const NAME: &'static str = "axes";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = AxesInputs;
    type Params = AxesParams;
    type Output = BodyAxes;
    type Error = AxesError;

    fn run(inputs: &AxesInputs, params: &AxesParams, context: &Context) -> Result<BodyAxes, AxesError> {
        let given: Vec<Landmark> = inputs.landmarks.iter().flat_map(|l| l.0.iter().cloned()).collect();
        body_axes(&inputs.model.0, &given, params, context)
    }
}

/// The local coordinate system of a body: by a person's points, else by landmarks, else proposed from the shape.
///
/// # Errors
/// A side that is missing, landmarks that give no axes, a shape that does not say where they are, or that the context was cancelled.
pub fn body_axes(
    mesh: &Mesh,
    landmarks: &[Landmark],
    params: &AxesParams,
    context: &Context,
) -> Result<BodyAxes, AxesError> {
    params.check()?;
    if let Some(bad) = landmarks.iter().find(|l| !l.at_mm.iter().all(|c| c.is_finite())) {
        return Err(AxesError::LandmarkNotFinite { name: bad.name.clone() });
    }
    let side = params.side.unwrap_or(Side::Right);
    let shape = Shape::of(mesh, side, params.frame);
    if let Some((frame, warnings)) = points::frame(landmarks)? {
        let place = |v: &Vector3| [v.x, v.y, v.z];
        return Ok(BodyAxes {
            origin_mm: place(&frame.origin),
            axes: [0, 1, 2].map(|i| place(&frame.axes[i])),
            body: params.body,
            side,
            source: AxesSource::Points,
            features: landmarks.iter().map(|l| figures::point(&l.name, &Vector3::from(l.at_mm))).collect(),
            warnings,
        });
    }
    let in_shape: Vec<Landmark> = landmarks
        .iter()
        .map(|l| Landmark { name: l.name.clone(), at_mm: shape.own(&Vector3::from(l.at_mm)).into() })
        .collect();
    let given = landmarks::named(params.body, &in_shape)?;
    let proposed = if context.cancelled() {
        return Err(AxesError::Cancelled);
    } else {
        proposal::of(params.body, &shape)
    };
    let found = settle(params.body, &given, proposed, !landmarks.is_empty(), &shape)?;
    Ok(shape.placed(found, params.body, side))
}

/// A frame in the shape's own frame, with all that is to be said of it.
pub(crate) struct Found {
    pub frame: Frame,
    pub source: AxesSource,
    pub features: Vec<AxesFeature>,
    pub warnings: Vec<String>,
}

/// Puts what was given before what was proposed.
fn settle(
    body: BodyKind,
    given: &Given,
    proposed: Result<Proposal, Refusal>,
    any_given: bool,
    shape: &Shape,
) -> Result<Found, AxesError> {
    let name = body_name(body);
    if !any_given {
        let sets = || landmarks::sets(body);
        let proposal = proposed.map_err(|r| AxesError::Shape { body: name, why: r.why, sets: sets() })?;
        return Ok(Found {
            frame: proposal.frame,
            source: AxesSource::Shape,
            features: proposal.features,
            warnings: proposal.warnings,
        });
    }
    let mut warnings: Vec<String> = given
        .unknown
        .iter()
        .map(|(word, nearest)| match nearest {
            Some(n) => format!("{word:?} is no landmark of a {name} and was not used (did you mean {n}?)"),
            None => format!("{word:?} is no landmark of a {name} and was not used"),
        })
        .collect();
    warnings.extend(far_away(given, shape));
    let alone = landmarks::solve(body, given, &Vec::new())?;
    let lacking = |why: &str| {
        let mut found: Vec<String> = given.marks.iter().map(|(n, _)| (*n).to_owned()).collect();
        found.extend(given.origin.map(|_| "origin".to_owned()));
        let unknown = given.unknown.iter().map(|(word, nearest)| match nearest {
            Some(n) => format!("{word:?} (unknown; did you mean {n}?)"),
            None => format!("{word:?} (unknown)"),
        });
        found.extend(unknown);
        AxesError::LandmarksMissing {
            body: name,
            found: format!("there is {}", found.join(", ")),
            why: why.to_owned(),
            sets: landmarks::sets(body),
        }
    };
    let mut features: Vec<AxesFeature> = Vec::new();
    let solved = if let Some(solved) = alone {
        if let Ok(p) = &proposed {
            warnings.extend(against(&solved.frame, p));
        }
        solved
    } else {
        // A word that is nearly a landmark is one misspelt: to go on without it would be to overrule the person.
        if given.unknown.iter().any(|(_, nearest)| nearest.is_some()) {
            return Err(lacking(""));
        }
        let marks = match &proposed {
            Ok(proposal) => &proposal.marks,
            Err(refusal) => &refusal.marks,
        };
        let Some(solved) = landmarks::solve(body, given, marks)? else {
            return Err(lacking(&match proposed {
                Ok(_) => ", and the shape does not fill them in".to_owned(),
                Err(refusal) => format!(", and the shape does not fill in: {}", refusal.why),
            }));
        };
        let idle: Vec<&str> =
            given.marks.iter().map(|(n, _)| *n).filter(|n| !solved.taken.contains(n)).collect();
        if !idle.is_empty() {
            return Err(lacking(&format!("; {} alone fixes nothing", idle.join(", "))));
        }
        let from_person =
            if solved.taken.is_empty() { "the origin".to_owned() } else { solved.taken.join(", ") };
        warnings.push(format!(
            "from the landmarks: {from_person}; proposed from the shape: {}",
            solved.proposed.join(", ")
        ));
        match proposed {
            Ok(proposal) => {
                warnings.extend(against(&solved.frame, &proposal));
                warnings.extend(proposal.warnings);
                features.extend(proposal.features);
            }
            Err(refusal) => {
                warnings.push(format!("the shape alone gives no axes: {}", refusal.why));
                features.extend(refusal.features);
            }
        }
        solved
    };
    features.extend(given.marks.iter().map(|(n, at)| figures::point(n, at)));
    features.extend(given.origin.iter().map(|at| figures::point("origin", at)));
    features.extend(solved.lines.iter().map(|(axis, a, b)| figures::line(axis.name(), a, b)));
    Ok(Found { frame: solved.frame, source: AxesSource::Landmarks, features, warnings })
}

/// Says where a person's axes are far from what the shape says.
fn against(frame: &Frame, proposal: &Proposal) -> Option<String> {
    const FAR_DEG: f64 = 20.0;
    let off = frame.angle_to(&proposal.frame);
    if off > 120.0 {
        return Some(format!(
            "the landmarks' axes are turned by {off:.0} degrees against those that the shape suggests: are medial and lateral, or \
             proximal and distal, swapped, or is the side wrong?"
        ));
    }
    (off > FAR_DEG).then(|| {
        format!("the landmarks' axes are turned by {off:.0} degrees against those that the shape suggests")
    })
}

/// Says which landmarks lie far from the mesh.
fn far_away(given: &Given, shape: &Shape) -> Vec<String> {
    let (low, high) = shape.bounds();
    let size = (high - low).norm();
    given
        .marks
        .iter()
        .filter(|(name, _)| {
            !["hip_centre", "ankle_centre", "medial_malleolus", "lateral_malleolus"].contains(name)
        })
        .filter_map(|(name, at)| {
            let outside = (low - at).sup(&(at - high)).sup(&Vector3::zeros()).norm();
            (outside > 0.25 * size).then(|| {
                format!(
                    "the landmark {name} lies {outside:.0} mm outside of the mesh's box: is it in the mesh's frame and in mm?"
                )
            })
        })
        .collect()
}
