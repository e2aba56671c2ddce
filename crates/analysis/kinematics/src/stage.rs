//! The stage `joint`: the matches of two bodies of a frame, their axes and models in; the joint's values out.

use std::sync::Arc;

use biplane_artifact::{BodyAxes, JointPose, Match, ModelMesh, Side};
use biplane_geometry::Pose;
use biplane_stage::{Context, Hashed, Stage, inputs};
use biplane_surface::{MeshCheck, Surface};
use serde::{Deserialize, Serialize};

use crate::{Convention, Frame, joint_values};

inputs! {
    /// Two bodies of one frame.
    pub struct JointInputs {
        /// Where the proximal body is.
        proximal: Match,
        /// Where the distal one is.
        distal: Match,
        /// The proximal body.
        proximal_model: ModelMesh,
        /// The distal one.
        distal_model: ModelMesh,
        /// Axes of the proximal body; none where those of its model are taken.
        proximal_axes: [BodyAxes],
        /// Axes of the distal one.
        distal_axes: [BodyAxes],
    }
}

/// How a joint is described.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointParams {
    /// By which values.
    pub convention: Convention,
    /// Of which side of the subject it is.
    pub side: Side,
    /// Whether the distance of the surfaces is found.
    pub distance: bool,
}

/// There is none: any two poses have values.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum JointError {}

/// A mesh in space, prepared once.
struct Prepared {
    surface: Surface,
    closed: bool,
}

/// The stage `joint`.
#[derive(Debug, Clone, Copy)]
pub struct Joint;

impl Stage for Joint {
    const NAME: &'static str = "joint";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = JointInputs;
    type Params = JointParams;
    type Output = JointPose;
    type Error = JointError;

    fn run(inputs: &JointInputs, params: &JointParams, context: &Context) -> Result<JointPose, JointError> {
        let frame = |axes: &[Hashed<BodyAxes>], model: &Hashed<ModelMesh>| {
            Frame::new(axes.first().map(|a| &**a), model.0.area_centroid())
        };
        let found = joint_values(
            (&inputs.proximal, &frame(&inputs.proximal_axes, &inputs.proximal_model)),
            (&inputs.distal, &frame(&inputs.distal_axes, &inputs.distal_model)),
            params.convention,
            params.side,
        );
        let [a, b, c, x, y, z] = found.values;
        let mut joint = JointPose {
            proximal_from_distal: found.proximal_from_distal,
            angles_rad: [a, b, c],
            translations_mm: [x, y, z],
            covariance: found.covariance.map(|m| std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))),
            distance_mm: None,
            penetration_mm: None,
        };
        if params.distance {
            (joint.distance_mm, joint.penetration_mm) = apart(inputs, context);
        }
        Ok(joint)
    }
}

/// How far the two surfaces are apart, and how deep in each other.
fn apart(inputs: &JointInputs, context: &Context) -> (Option<f64>, Option<f64>) {
    let prepared = |model: &Hashed<ModelMesh>| -> Arc<Prepared> {
        context.prepared(model.hash(), || Prepared {
            surface: Surface::new(&model.0),
            closed: MeshCheck::of(&model.0).is_closed_manifold(),
        })
    };
    let (first, second) = (prepared(&inputs.proximal_model), prepared(&inputs.distal_model));
    let place = Pose::from(inputs.proximal.pose).inverse() * Pose::from(inputs.distal.pose);
    let found = first.surface.apart(&second.surface, &place);
    let vertices = |model: &Hashed<ModelMesh>| model.0.vertices().to_vec();
    // Apart, one may still be inside the other.
    let inside = || {
        let back = place.inverse();
        let one =
            inputs.distal_model.0.vertices().first().map(|v| first.surface.contains(&place.transform(v)));
        let other =
            inputs.proximal_model.0.vertices().first().map(|v| second.surface.contains(&back.transform(v)));
        one == Some(true) || other == Some(true)
    };
    let depth = match (first.closed && second.closed, found.cross) {
        (false, _) => None,
        (true, false) if !inside() => Some(0.0),
        (true, _) => {
            let back = place.inverse();
            let distal = vertices(&inputs.distal_model).into_iter().map(|v| place.transform(&v));
            let proximal = vertices(&inputs.proximal_model).into_iter().map(|v| back.transform(&v));
            Some(first.surface.depth(distal).max(second.surface.depth(proximal)))
        }
    };
    (Some(found.distance_mm), depth)
}
