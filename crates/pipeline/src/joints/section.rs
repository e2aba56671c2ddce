//! `[[joint]]` of a pipeline file.

use biplane_artifact::Side;
use biplane_kinematics::Convention;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{HelicalFrom, StudyJoint};
use crate::config::Located;
use crate::diagnostics::{Problem, meant};
use crate::study::Body;

/// `[[joint]]`: two bodies whose motion against each other is wanted. Written to `results/kinematics.csv`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointSection {
    /// Name of the joint, as results call it.
    #[schemars(with = "String")]
    pub name: Located,
    /// The body that stands still, such as the femur of a knee.
    #[schemars(with = "String")]
    pub proximal: Located,
    /// The body that moves against it, such as the tibia.
    #[schemars(with = "String")]
    pub distal: Located,
    /// Side of the subject: what is outwards and inwards. Not given, that of the bodies' `axes`.
    pub side: Option<JointSide>,
    /// `"grood_suntay"`: flexion, adduction, internal rotation, and translations along their axes, of bodies with `axes`. Or three turns in the order
    /// of their axes, such as `"zxy"`.
    #[serde(default)]
    pub convention: Convention,
    /// Whether the least distance of the two surfaces, and how deep they are in each other, are found in every frame.
    #[serde(default = "yes")]
    pub distance: bool,
    /// Surfaces that are deeper in each other than this, beyond what is uncertain, are warned of, mm.
    #[serde(default = "half")]
    #[schemars(range(min = 0.0))]
    pub most_penetration_mm: f64,
    /// Helical axes of the motion from the `"first"` frame of the trial, or from the `"previous"` one.
    #[serde(default)]
    pub helical_from: HelicalSince,
    /// Turns smaller than this have no helical axis, degrees.
    #[serde(default = "five")]
    #[schemars(range(min = 0.01, max = 180.0))]
    pub helical_least_deg: f64,
    /// Values at even steps of the first angle (flexion), degrees, go to `results/kinematics_by_angle.csv`; not given, there is none.
    #[schemars(with = "Option<f64>", range(min = 0.1, max = 90.0))]
    pub resample_deg: Option<toml::Spanned<f64>>,
}

fn yes() -> bool {
    true
}

fn half() -> f64 {
    0.5
}

fn five() -> f64 {
    5.0
}

/// Side of the subject.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum JointSide {
    /// The subject's left.
    Left,
    /// The subject's right.
    Right,
}

/// What helical axes are measured from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum HelicalSince {
    /// The first frame of the trial in which both bodies have a pose.
    #[default]
    First,
    /// The frame before.
    Previous,
}

/// The joint that a table describes; what is wrong with it goes to `problems`.
pub(crate) fn joint(
    section: JointSection,
    bodies: &[Body],
    problems: &mut Vec<Problem>,
) -> Option<StudyJoint> {
    let names: Vec<&str> = bodies.iter().map(|b| b.name.as_str()).collect();
    let mut body = |name: &Located| {
        let found = names.iter().position(|n| *n == name.get_ref());
        if found.is_none() {
            let problem = Problem::at(name.span(), format!("there is no body `{}`", name.get_ref()));
            let meant = meant(name.get_ref(), names.iter().copied());
            problems.push(problem.label(meant).help("a joint is between two [[body]] tables"));
        }
        found
    };
    let (proximal, distal) = (body(&section.proximal), body(&section.distal));
    let (proximal, distal) = (proximal?, distal?);
    if proximal == distal {
        let text = format!("joint `{}` is between a body and itself", section.name.get_ref());
        problems.push(
            Problem::at(section.distal.span(), text)
                .help("name the body that moves against the proximal one"),
        );
        return None;
    }
    let side_of = |body: usize| bodies[body].axes.as_ref().and_then(|a| a.side);
    let without = [proximal, distal].into_iter().find(|body| bodies[*body].axes.is_none());
    let of_axes = [side_of(proximal), side_of(distal)];
    let side = match section.side {
        Some(JointSide::Left) => Some(Side::Left),
        Some(JointSide::Right) => Some(Side::Right),
        None => None,
    };
    if let [Some(a), Some(b)] = of_axes
        && (a != b || side.is_some_and(|s| s != a))
    {
        let text = format!("joint `{}` has bodies or a side that do not go together", section.name.get_ref());
        problems.push(
            Problem::at(section.name.span(), text)
                .help("its `side` and those of its bodies' `axes` must be the same"),
        );
        return None;
    }
    let clinical = section.convention == Convention::GroodSuntay;
    if let (true, Some(without)) = (clinical, without) {
        let text = format!(
            "joint `{}`: body `{}` has no axes, which Grood and Suntay's values need",
            section.name.get_ref(),
            names[without]
        );
        let help = "add axes = { body = \"femur\", side = \"left\" } to its [[body]], or take a sequence of turns about its model's own axes: \
                    convention = \"zxy\"";
        problems.push(Problem::at(section.name.span(), text).help(help));
        return None;
    }
    let mut range = |name: &str, value: f64, low: f64, high: f64| {
        let well = (low..=high).contains(&value);
        if !well {
            let text =
                format!("joint `{}`: {name} = {value}, expected {low} to {high}", section.name.get_ref());
            problems.push(Problem::at(section.name.span(), text));
        }
        well
    };
    let resample = section.resample_deg.as_ref().map(|r| *r.get_ref());
    let well = range("most_penetration_mm", section.most_penetration_mm, 0.0, 1e6)
        & range("helical_least_deg", section.helical_least_deg, 0.01, 180.0)
        & range("resample_deg", resample.unwrap_or(5.0), 0.1, 90.0);
    well.then(|| StudyJoint {
        name: section.name.into_inner(),
        proximal,
        distal,
        side: side.or(of_axes[0]).or(of_axes[1]).unwrap_or(Side::Right),
        convention: section.convention,
        distance: section.distance,
        most_penetration_mm: section.most_penetration_mm,
        helical_from: match section.helical_from {
            HelicalSince::First => HelicalFrom::First,
            HelicalSince::Previous => HelicalFrom::Previous,
        },
        helical_least_deg: section.helical_least_deg,
        resample_deg: resample,
    })
}
