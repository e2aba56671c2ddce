//! `kinematics.csv` and `kinematics_by_angle.csv`.

use biplane_kinematics::Crossing;

use super::series::{Series, series};
use super::{JointOutcome, StudyJoint};
use crate::outcome::Outcome;
use crate::results::fixed;
use crate::study::Study;

/// What `kinematics.README.txt` says.
pub const README: &str = include_str!("readme.txt");

/// Columns of a helical axis.
const HELICAL: [&str; 8] = [
    "helical_x",
    "helical_y",
    "helical_z",
    "helical_point_x_mm",
    "helical_point_y_mm",
    "helical_point_z_mm",
    "helical_angle_deg",
    "helical_slide_mm",
];

/// Columns of the values of all joints' conventions, each once, with their units.
fn columns(study: &Study) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for joint in &study.joints {
        for name in of_joint(joint) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}

fn of_joint(joint: &StudyJoint) -> [String; 6] {
    let names = joint.convention.names();
    std::array::from_fn(|k| format!("{}_{}", names[k], if k < 3 { "deg" } else { "mm" }))
}

/// Six numbers in the columns of their joint.
fn spread(columns: &[String], joint: &StudyJoint, values: Option<[f64; 6]>) -> Vec<String> {
    let own = of_joint(joint);
    let cell = |column: &String| {
        let place = own.iter().position(|name| name == column)?;
        Some(fixed(values?[place], 4))
    };
    columns.iter().map(|column| cell(column).unwrap_or_default()).collect()
}

fn finished(writer: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, csv::Error> {
    writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))
}

/// The bytes of `kinematics.csv`.
///
/// # Errors
/// Never for a table in memory; the signature is that of the CSV writer.
pub fn kinematics_csv(study: &Study, outcome: &Outcome) -> Result<Vec<u8>, csv::Error> {
    let columns = columns(study);
    let mut header: Vec<String> =
        ["trial", "frame", "joint", "time_s", "verdict"].map(str::to_owned).to_vec();
    header.extend(columns.iter().cloned());
    header.extend(columns.iter().map(|c| format!("interval95_{c}")));
    header.extend(["distance_mm", "penetration_mm"].map(str::to_owned));
    header.extend(HELICAL.map(str::to_owned));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header)?;
    for (joint, of) in with_joints(study, outcome) {
        for Series { trial, frames } in series(outcome, of, joint) {
            for frame in frames {
                let about = &outcome.frames[frame.frame];
                let mut cells = vec![
                    study.trials[trial].name.clone(),
                    about.label.clone(),
                    joint.name.clone(),
                    about.time_s.map_or(String::new(), |t| fixed(t, 6)),
                    frame.joint.verdict.word().to_owned(),
                ];
                cells.extend(spread(&columns, joint, frame.values));
                cells.extend(spread(&columns, joint, frame.half_widths));
                let pose = frame.joint.pose.as_ref();
                for value in [pose.and_then(|p| p.distance_mm), pose.and_then(|p| p.penetration_mm)] {
                    cells.push(value.map_or(String::new(), |v| fixed(v, 4)));
                }
                match frame.helical {
                    Some(axis) => {
                        cells.extend(axis.direction.map(|v| fixed(v, 6)));
                        cells.extend(axis.point_mm.map(|v| fixed(v, 3)));
                        cells.extend([fixed(axis.angle_rad.to_degrees(), 4), fixed(axis.slide_mm, 4)]);
                    }
                    None => cells.extend(std::iter::repeat_n(String::new(), HELICAL.len())),
                }
                writer.write_record(&cells)?;
            }
        }
    }
    finished(writer)
}

/// The bytes of `kinematics_by_angle.csv`; none where no joint asks for it.
///
/// # Errors
/// Never for a table in memory; the signature is that of the CSV writer.
pub fn by_angle_csv(study: &Study, outcome: &Outcome) -> Result<Option<Vec<u8>>, csv::Error> {
    if study.joints.iter().all(|joint| joint.resample_deg.is_none()) {
        return Ok(None);
    }
    let columns = columns(study);
    let mut header: Vec<String> =
        ["trial", "joint", "stroke", "direction", "at_deg", "time_s", "frame_before", "frame_after"]
            .map(str::to_owned)
            .to_vec();
    header.extend(columns.iter().cloned());
    header.extend(columns.iter().map(|c| format!("interval95_{c}")));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header)?;
    for (joint, of) in with_joints(study, outcome) {
        let Some(step) = joint.resample_deg else { continue };
        for series in series(outcome, of, joint) {
            for crossing in series.crossings(step) {
                let [before, after] = [crossing.before, crossing.after].map(|f| &series.frames[f]);
                let about = [before, after].map(|f| &outcome.frames[f.frame]);
                let time = about[0].time_s.zip(about[1].time_s).map(|(a, b)| crossing.value(a, b));
                let between =
                    |of: fn(&Crossing, f64, f64) -> f64, a: Option<[f64; 6]>, b: Option<[f64; 6]>| {
                        let (a, b) = (a?, b?);
                        Some(std::array::from_fn(|k| of(&crossing, a[k], b[k])))
                    };
                let mut cells = vec![
                    study.trials[series.trial].name.clone(),
                    joint.name.clone(),
                    (crossing.stroke + 1).to_string(),
                    if crossing.rising { "up" } else { "down" }.to_owned(),
                    fixed(crossing.level, 4),
                    time.map_or(String::new(), |t| fixed(t, 6)),
                    about[0].label.clone(),
                    about[1].label.clone(),
                ];
                let values = between(|c, a, b| c.value(a, b), before.values, after.values);
                cells.extend(spread(&columns, joint, values));
                let half = between(|c, a, b| c.sigma(a, b), before.half_widths, after.half_widths);
                cells.extend(spread(&columns, joint, half));
                writer.write_record(&cells)?;
            }
        }
    }
    finished(writer).map(Some)
}

fn with_joints<'a>(
    study: &'a Study,
    outcome: &'a Outcome,
) -> impl Iterator<Item = (&'a StudyJoint, &'a JointOutcome)> {
    outcome.joints.iter().filter_map(|of| Some((study.joints.get(of.joint)?, of)))
}
