//! Axes from landmarks by name: which there are for each kind of body, what two of them say, and what is missing.
//!
//! For each body there is a list of *ways*: lines between (means of) landmarks that give an axis. The first way whose landmarks
//! are there gives the axis that is kept, the next one of another axis is made square to it. Ways that a person's landmarks give
//! alone come before those that lean on the shape.

use biplane_artifact::{BodyKind, Landmark};
use biplane_geometry::Vector3;

use crate::AxesError;
use crate::frame::{Axis, Frame};

/// A landmark: its name and other words for it.
pub(crate) struct Known {
    pub name: &'static str,
    aliases: &'static [&'static str],
}

/// A line that gives an axis, from the mean of some landmarks to the mean of others.
pub(crate) struct Way {
    axis: Axis,
    from: &'static [&'static str],
    to: &'static [&'static str],
}

/// What is known of a kind of body.
pub(crate) struct Plan {
    marks: &'static [Known],
    /// Best first.
    ways: &'static [Way],
    /// The origin is the mean of these; best first.
    origins: &'static [&'static [&'static str]],
}

const fn known(name: &'static str, aliases: &'static [&'static str]) -> Known {
    Known { name, aliases }
}

const fn way(axis: Axis, from: &'static [&'static str], to: &'static [&'static str]) -> Way {
    Way { axis, from, to }
}

const SHAFT_PROXIMAL: Known = known("shaft_proximal", &["proximal_shaft", "shaft_upper", "shaft_top"]);
const SHAFT_DISTAL: Known = known("shaft_distal", &["distal_shaft", "shaft_lower", "shaft_bottom"]);

const EPICONDYLES: &[&str] = &["medial_epicondyle", "lateral_epicondyle"];
const CONDYLES: &[&str] = &["medial_condyle", "lateral_condyle"];
const PLATEAUS: &[&str] = &["medial_plateau", "lateral_plateau"];
const MALLEOLI: &[&str] = &["medial_malleolus", "lateral_malleolus"];

static FEMUR: Plan = Plan {
    marks: &[
        known(
            "hip_centre",
            &["hip_center", "femoral_head", "femoral_head_centre", "head_centre", "hjc", "fhc"],
        ),
        SHAFT_PROXIMAL,
        SHAFT_DISTAL,
        known(
            "medial_epicondyle",
            &["epicondyle_medial", "med_epicondyle", "femoral_medial_epicondyle", "fme"],
        ),
        known(
            "lateral_epicondyle",
            &["epicondyle_lateral", "lat_epicondyle", "femoral_lateral_epicondyle", "fle"],
        ),
        known(
            "medial_condyle",
            &["condyle_medial", "medial_condyle_centre", "medial_condyle_center", "fmcc"],
        ),
        known(
            "lateral_condyle",
            &["condyle_lateral", "lateral_condyle_centre", "lateral_condyle_center", "flcc"],
        ),
    ],
    ways: &[
        way(Axis::Y, EPICONDYLES, &["hip_centre"]),
        way(Axis::Y, CONDYLES, &["hip_centre"]),
        way(Axis::Z, &["medial_epicondyle"], &["lateral_epicondyle"]),
        way(Axis::Z, &["medial_condyle"], &["lateral_condyle"]),
        way(Axis::Y, &["shaft_distal"], &["shaft_proximal"]),
    ],
    origins: &[EPICONDYLES, CONDYLES],
};

static TIBIA: Plan = Plan {
    marks: &[
        known("medial_plateau", &["plateau_medial", "medial_plateau_centre", "medial_plateau_center"]),
        known("lateral_plateau", &["plateau_lateral", "lateral_plateau_centre", "lateral_plateau_center"]),
        known(
            "plateau_centre",
            &[
                "plateau_center",
                "intercondylar",
                "intercondylar_eminence",
                "eminence",
                "knee_centre",
                "knee_center",
            ],
        ),
        SHAFT_PROXIMAL,
        SHAFT_DISTAL,
        known("ankle_centre", &["ankle_center", "ankle", "ajc"]),
        known("medial_malleolus", &["malleolus_medial", "mm"]),
        known("lateral_malleolus", &["malleolus_lateral", "lm"]),
    ],
    ways: &[
        way(Axis::Y, &["ankle_centre"], &["plateau_centre"]),
        way(Axis::Y, &["ankle_centre"], PLATEAUS),
        way(Axis::Y, MALLEOLI, &["plateau_centre"]),
        way(Axis::Y, MALLEOLI, PLATEAUS),
        way(Axis::Y, &["shaft_distal"], &["shaft_proximal"]),
        way(Axis::Y, &["shaft_distal"], &["plateau_centre"]),
        way(Axis::Z, &["medial_plateau"], &["lateral_plateau"]),
    ],
    origins: &[&["plateau_centre"], PLATEAUS],
};

static PATELLA: Plan = Plan {
    marks: &[
        known("superior", &["superior_pole", "proximal", "base", "sup"]),
        known("inferior", &["inferior_pole", "apex", "distal", "inf"]),
        known("medial", &["medial_pole", "medial_edge", "med"]),
        known("lateral", &["lateral_pole", "lateral_edge", "lat"]),
    ],
    ways: &[way(Axis::Y, &["inferior"], &["superior"]), way(Axis::Z, &["medial"], &["lateral"])],
    origins: &[
        &["superior", "inferior", "medial", "lateral"],
        &["superior", "inferior"],
        &["medial", "lateral"],
    ],
};

static FEMORAL_COMPONENT: Plan = Plan {
    marks: &[
        known("medial", &["medial_condyle", "condyle_medial", "med"]),
        known("lateral", &["lateral_condyle", "condyle_lateral", "lat"]),
        known("peg_base", &["peg_bottom", "peg_distal"]),
        known("peg_tip", &["peg_top", "peg_proximal"]),
        known("distal", &["inferior"]),
        known("proximal", &["superior"]),
        known("anterior", &["ant", "flange"]),
        known("posterior", &["post"]),
    ],
    ways: &[
        way(Axis::Z, &["medial"], &["lateral"]),
        way(Axis::Y, &["peg_base"], &["peg_tip"]),
        way(Axis::Y, &["distal"], &["proximal"]),
        way(Axis::X, &["posterior"], &["anterior"]),
    ],
    origins: &[&["medial", "lateral"]],
};

static TIBIAL_TRAY: Plan = Plan {
    marks: &[
        known("medial", &["plate_medial", "med"]),
        known("lateral", &["plate_lateral", "lat"]),
        known("anterior", &["plate_anterior", "ant"]),
        known("posterior", &["plate_posterior", "post"]),
        known(
            "plate_centre",
            &["plate_center", "centre", "center", "stem_base", "keel_base", "proximal", "superior"],
        ),
        known("keel_tip", &["stem_tip", "keel", "stem", "peg_tip", "distal", "inferior"]),
    ],
    ways: &[
        way(Axis::Z, &["medial"], &["lateral"]),
        way(Axis::X, &["posterior"], &["anterior"]),
        way(Axis::Y, &["keel_tip"], &["plate_centre"]),
    ],
    origins: &[&["plate_centre"], &["medial", "lateral"]],
};

static OTHER: Plan = Plan { marks: &[], ways: &[], origins: &[] };

fn plan(body: BodyKind) -> &'static Plan {
    match body {
        BodyKind::Femur => &FEMUR,
        BodyKind::Tibia => &TIBIA,
        BodyKind::Patella => &PATELLA,
        BodyKind::FemoralComponent => &FEMORAL_COMPONENT,
        BodyKind::TibialTray => &TIBIAL_TRAY,
        BodyKind::Other => &OTHER,
    }
}

/// The landmarks that count for a kind of body, each with other words for it, case and separators ignored. `origin` counts for each
/// besides, and `origin, x, y, z` stand for all of them.
pub fn landmark_names(body: BodyKind) -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    plan(body).marks.iter().map(|k| (k.name, k.aliases))
}

/// Points by their name in the plan.
pub(crate) type Marks = Vec<(&'static str, Vector3)>;

/// What a person's landmarks are.
#[derive(Debug, Default)]
pub(crate) struct Given {
    pub marks: Marks,
    pub origin: Option<Vector3>,
    /// Names of no meaning, with the nearest one that has one.
    pub unknown: Vec<(String, Option<&'static str>)>,
}

fn plain(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// The landmarks of a body by their names in the plan.
///
/// # Errors
/// Two words for one landmark, with two places.
pub(crate) fn named(body: BodyKind, landmarks: &[Landmark]) -> Result<Given, AxesError> {
    let plan = plan(body);
    let mut given = Given::default();
    for landmark in landmarks {
        let word = plain(&landmark.name);
        let at = Vector3::from(landmark.at_mm);
        if word == "origin" {
            given.origin = Some(at);
            continue;
        }
        let same = |k: &&Known| plain(k.name) == word || k.aliases.iter().any(|a| plain(a) == word);
        match plan.marks.iter().find(same) {
            Some(k) if given.marks.iter().any(|(name, _)| *name == k.name) => {
                return Err(AxesError::LandmarkTwice { name: k.name, word: landmark.name.clone() });
            }
            Some(k) => given.marks.push((k.name, at)),
            None => {
                let words =
                    |k: &'static Known| std::iter::once(&k.name).chain(k.aliases).map(move |w| (k, *w));
                let nearest = plan
                    .marks
                    .iter()
                    .flat_map(words)
                    .map(|(k, w)| (strsim::damerau_levenshtein(&plain(w), &word), k.name))
                    .min_by_key(|(far, _)| *far)
                    .filter(|(far, _)| far * 3 <= word.len());
                given.unknown.push((landmark.name.clone(), nearest.map(|(_, name)| name)));
            }
        }
    }
    Ok(given)
}

/// A frame, and where it is from.
#[derive(Debug)]
pub(crate) struct Solved {
    pub frame: Frame,
    /// The lines that gave it, as pairs of places: the one that was kept first.
    pub lines: Vec<(Axis, Vector3, Vector3)>,
    /// Landmarks that were taken from the person.
    pub taken: Vec<&'static str>,
    /// Landmarks that were proposed from the shape.
    pub proposed: Vec<&'static str>,
}

/// The frame that a person's landmarks give, what they leave open being taken from the proposed ones. None where both together do not
/// suffice.
pub(crate) fn solve(body: BodyKind, given: &Given, proposed: &Marks) -> Result<Option<Solved>, AxesError> {
    let plan = plan(body);
    let find = |list: &Marks, name: &str| list.iter().find(|(n, _)| *n == name).map(|(_, at)| *at);
    let place = |name: &'static str| find(&given.marks, name).or_else(|| find(proposed, name));
    let is_given = |name: &&&str| find(&given.marks, name).is_some();
    let middle = |names: &[&'static str]| {
        let sum = names.iter().map(|n| place(n)).sum::<Option<Vector3>>()?;
        Some(sum / names.len().max(1) as f64)
    };
    // How much of it the person said: all, some, nothing.
    let rank = |names: &mut dyn Iterator<Item = &&'static str>| {
        let names: Vec<_> = names.collect();
        let said = names.iter().filter(|n| is_given(n)).count();
        if said == names.len() {
            0
        } else if said > 0 {
            1
        } else {
            2
        }
    };
    let mut ways: Vec<(i32, &Way, Vector3, Vector3)> = plan
        .ways
        .iter()
        .filter_map(|w| Some((rank(&mut w.from.iter().chain(w.to)), w, middle(w.from)?, middle(w.to)?)))
        .collect();
    ways.sort_by_key(|(rank, ..)| *rank);
    let Some(&(_, kept, a, b)) = ways.first() else { return Ok(None) };
    let Some(&(_, second, c, d)) = ways.iter().find(|(_, w, ..)| w.axis != kept.axis) else {
        return Ok(None);
    };
    let mut origins: Vec<(i32, &[&'static str], Vector3)> = plan
        .origins
        .iter()
        .filter_map(|names| Some((rank(&mut names.iter()), *names, middle(names)?)))
        .collect();
    origins.sort_by_key(|(rank, ..)| *rank);
    let (origin_names, origin): (&[&'static str], Vector3) = match (given.origin, origins.first()) {
        (Some(origin), _) => (&[], origin),
        (None, Some(&(_, names, origin))) => (names, origin),
        (None, None) => return Ok(None),
    };
    let Some(frame) = Frame::of(origin, (kept.axis, b - a), (second.axis, d - c)) else {
        return Err(AxesError::LandmarksDegenerate {
            what: format!("{} and {}", line_text(kept), line_text(second)),
        });
    };
    let mut used: Vec<&'static str> = [kept.from, kept.to, second.from, second.to, origin_names].concat();
    let mut seen: Vec<&'static str> = Vec::new();
    used.retain(|n| {
        let new = !seen.contains(n);
        seen.push(n);
        new
    });
    let (taken, from_shape) = used.into_iter().partition(|n| is_given(&n));
    Ok(Some(Solved {
        frame,
        lines: vec![(kept.axis, a, b), (second.axis, c, d)],
        taken,
        proposed: from_shape,
    }))
}

fn line_text(w: &Way) -> String {
    format!("{} to {}", w.from.join("/"), w.to.join("/"))
}

/// Which sets of landmarks would do, for a person to read.
pub(crate) fn sets(body: BodyKind) -> String {
    let plan = plan(body);
    if plan.ways.is_empty() {
        return "origin and two of x, y, z".to_owned();
    }
    let of = |axis: Axis| {
        let lines: Vec<String> = plan
            .ways
            .iter()
            .filter(|w| w.axis == axis)
            .map(|w| [w.from, w.to].concat().join(" + "))
            .collect();
        (!lines.is_empty()).then(|| format!("for {}: {}", axis.name(), lines.join(", or ")))
    };
    let axes: Vec<String> = [Axis::Y, Axis::Z, Axis::X].into_iter().filter_map(of).collect();
    let origins: Vec<String> = plan.origins.iter().map(|names| names.join(" + ")).collect();
    format!(
        "two of the axes ({}) and the origin (origin, or {}); or origin and two of x, y, z",
        axes.join("; "),
        origins.join(", or ")
    )
}
