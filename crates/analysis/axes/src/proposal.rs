//! Proposals of axes from the shape alone.

use biplane_artifact::{AxesFeature, BodyKind};
use biplane_geometry::Vector3;

use crate::frame::Frame;
use crate::landmarks::{self, Given, Marks};
use crate::shape::Shape;
use crate::{femoral_component, femur, figures, patella, tibia, tray};

/// Triangles below which nothing is proposed: the fits need surfaces, not corners.
const LEAST_TRIANGLES: usize = 300;

/// Axes that a shape suggests, in the shape's own frame.
pub(crate) struct Proposal {
    pub frame: Frame,
    /// The landmarks that they are made from.
    pub marks: Marks,
    pub features: Vec<AxesFeature>,
    pub warnings: Vec<String>,
}

/// Why a shape suggests no axes, and what of it was found nevertheless.
pub(crate) struct Refusal {
    pub why: String,
    pub marks: Marks,
    pub features: Vec<AxesFeature>,
}

impl From<String> for Refusal {
    fn from(why: String) -> Self {
        Self { why, marks: Vec::new(), features: Vec::new() }
    }
}

impl From<&str> for Refusal {
    fn from(why: &str) -> Self {
        why.to_owned().into()
    }
}

impl Proposal {
    /// The frame that proposed landmarks give, by the same rules as a person's.
    pub fn of_marks(
        body: BodyKind,
        marks: Marks,
        features: Vec<AxesFeature>,
        warnings: Vec<String>,
    ) -> Result<Self, String> {
        match landmarks::solve(body, &Given::default(), &marks) {
            Ok(Some(solved)) => Ok(Self { frame: solved.frame, marks, features, warnings }),
            Ok(None) | Err(_) => Err("the lines found in it are nearly parallel".to_owned()),
        }
    }
}

/// What the shape suggests.
///
/// # Errors
/// Why it suggests nothing, for a person to read, and what was found nevertheless.
pub(crate) fn of(body: BodyKind, shape: &Shape) -> Result<Proposal, Refusal> {
    let triangles = shape.triangles.len();
    if body != BodyKind::Other && triangles < LEAST_TRIANGLES {
        return Err(format!(
            "{triangles} triangles are too few to tell its surfaces by, at least {LEAST_TRIANGLES} are needed"
        )
        .into());
    }
    let mut proposal = match body {
        BodyKind::Femur => femur::propose(shape)?,
        BodyKind::Tibia => tibia::propose(shape)?,
        BodyKind::Patella => patella::propose(shape)?,
        BodyKind::FemoralComponent => femoral_component::propose(shape)?,
        BodyKind::TibialTray => tray::propose(shape)?,
        BodyKind::Other => other(shape),
    };
    if shape.open_edges > 0 && body != BodyKind::Other {
        proposal.warnings.push(format!(
            "the mesh is open ({} edges with one triangle): look at the axes where a part is missing",
            shape.open_edges
        ));
    }
    proposal.warnings.extend(shape.hint.and_then(|hint| {
        let [x, y, _] = proposal.frame.axes;
        let off = [y.dot(&hint.superior), x.dot(&hint.anterior)].map(|c| c.clamp(-1.0, 1.0).acos().to_degrees());
        let implant = matches!(body, BodyKind::FemoralComponent | BodyKind::TibialTray | BodyKind::Other);
        (!implant && off.iter().any(|o| *o > 45.0)).then(|| {
            format!(
                "y stands {:.0} degrees off the scanner's up and x {:.0} degrees off its front: look at the axes, or drop \
                 frame = \"lps\" if the mesh is in another frame",
                off[0], off[1]
            )
        })
    }));
    Ok(proposal)
}

/// Principal axes of the surface: y along the longest, z along the middle one.
fn other(shape: &Shape) -> Proposal {
    let mut warnings = Vec::new();
    let [a, b, c] = shape.spread;
    if b > 0.98 * a || c > 0.98 * b {
        warnings.push(format!(
            "two of its principal axes are alike (spreads of {a:.2}, {b:.2} and {c:.2} mm): their direction is not certain; give \
             origin, x, y, z"
        ));
    }
    // y and z point to the longer tail; where there is none, the sense is chance.
    let unsure: Vec<&str> = [("y", shape.skew[0]), ("z", shape.skew[1])]
        .into_iter()
        .filter(|(_, skew)| skew.abs() < 0.01)
        .map(|(name, _)| name)
        .collect();
    if !unsure.is_empty() {
        warnings.push(format!(
            "its two ends along {} look alike, so the sense of {0} is not told by the shape; give origin, x, y, z",
            unsure.join(" and ")
        ));
    }
    let frame = Frame { origin: Vector3::zeros(), axes: [Vector3::z(), Vector3::x(), Vector3::y()] };
    let names = ["longest spread", "middle spread", "shortest spread"];
    let features = [Vector3::x(), Vector3::y(), Vector3::z()]
        .iter()
        .zip(names)
        .zip(shape.spread)
        .map(|((axis, name), s)| figures::line(name, &(axis * -s), &(axis * s)))
        .collect();
    Proposal { frame, marks: Vec::new(), features, warnings }
}
