//! `poses.csv` and the note beside it.
//!
//! Units are in the column names and the first line is the header, so that any program reads the table; the frames and
//! conventions are in `poses.README.txt`. A file is written beside and renamed into place, and left alone if its bytes
//! would not change.

use std::io::Write;
use std::path::Path;

use biplane_artifact::{DistortionTable, PoseRecord};
use biplane_geometry::Pose;

use crate::outcome::{BodyOutcome, FrameOutcome, Outcome};
use crate::study::Study;

/// The six coordinates of a small motion, in the order of a covariance's rows, and their units.
const TWIST: [(&str, &str); 6] =
    [("tx", "mm"), ("ty", "mm"), ("tz", "mm"), ("rx", "rad"), ("ry", "rad"), ("rz", "rad")];

/// Standard deviations and covariances from here on say that nothing is known.
pub const UNKNOWN: f64 = 1e100;

/// What `poses.README.txt` says.
pub const README: &str = include_str!("poses_readme.txt");

/// Writes a file beside and renames it into place; `false` if it had these bytes already and was left alone.
///
/// # Errors
/// The operating system refuses.
pub fn write_if_changed(path: &Path, bytes: &[u8]) -> std::io::Result<bool> {
    if std::fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(false);
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    let mut file = tempfile::Builder::new().prefix(".writing-").tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    #[cfg(unix)]
    {
        // Temporary files are private; results are for everyone who may read the folder.
        use std::os::unix::fs::PermissionsExt;
        file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))?;
    }
    file.persist(path).map_err(|e| e.error)?;
    Ok(true)
}

/// Copies a file beside and renames it into place, unless the copy there has its size and time of change already: a run
/// in which nothing is to do reads no picture, not even these.
///
/// # Errors
/// The operating system refuses.
pub fn copy_if_other(from: &Path, to: &Path) -> std::io::Result<()> {
    let about = std::fs::metadata(from)?;
    let modified = about.modified()?;
    if std::fs::metadata(to)
        .is_ok_and(|old| old.len() == about.len() && old.modified().is_ok_and(|m| m == modified))
    {
        return Ok(());
    }
    write_if_changed(to, &std::fs::read(from)?)?;
    std::fs::File::options().write(true).open(to)?.set_modified(modified)
}

/// A distortion table as `distortion` of a fluoroscope reads it.
pub fn distortion_csv(table: &DistortionTable) -> String {
    let mut text = String::from("distorted_x_px,distorted_y_px,ideal_x_px,ideal_y_px\n");
    for (k, [x, y]) in table.ideal_px.iter().enumerate() {
        let at = [k % table.count[0], k / table.count[0]];
        let [u, v]: [f64; 2] = std::array::from_fn(|i| table.first_px[i] + at[i] as f64 * table.step_px[i]);
        text += &format!("{u},{v},{x:.6},{y:.6}\n");
    }
    text
}

/// Columns of a pose.
pub(crate) const POSE: [&str; 7] = ["tx_mm", "ty_mm", "tz_mm", "qw", "qx", "qy", "qz"];
/// Columns of the thesis's six numbers, about the model's origin.
const THESIS: [&str; 6] = [
    "thesis_alpha_deg",
    "thesis_beta_deg",
    "thesis_gamma_deg",
    "thesis_tx_mm",
    "thesis_ty_mm",
    "thesis_tz_mm",
];
/// Columns of standard deviations: of the pose, and what of them the calibration brings.
const SIGMAS: [&str; 4] = ["sigma_t_mm", "sigma_r_deg", "calibration_sigma_t_mm", "calibration_sigma_r_deg"];
/// Columns of half-widths of intervals.
pub(crate) const INTERVALS: [&str; 6] = ["tx_mm", "ty_mm", "tz_mm", "rx_deg", "ry_deg", "rz_deg"];

/// Numbers of the upper triangle of the covariance.
const COVARIANCES: usize = 21;
/// Columns of what the search did.
const SEARCHED: [&str; 4] = ["iterations", "objective", "starts_tried", "starts_converged"];

/// The header of `poses.csv`.
fn header(views: &[&str]) -> Vec<String> {
    let mut names: Vec<String> = ["trial", "frame", "body", "verdict"].map(str::to_owned).to_vec();
    names.extend(POSE.iter().chain(&["time_s", "start", "reason"]).map(|name| (*name).to_owned()));
    for view in views {
        names.extend(["rms_px", "rms_mm", "matched_share", "inset_px"].map(|what| format!("{view}_{what}")));
    }
    names.extend(SIGMAS.map(str::to_owned));
    names.extend(INTERVALS.map(|what| format!("interval95_{what}")));
    for (i, (a, unit_a)) in TWIST.iter().enumerate() {
        for (b, unit_b) in &TWIST[i..] {
            let unit = if unit_a == unit_b { format!("{unit_a}2") } else { format!("{unit_a}_{unit_b}") };
            names.push(format!("cov_{a}_{b}_{unit}"));
        }
    }
    names.extend(SEARCHED.map(str::to_owned));
    names.extend(POSE.map(|what| format!("alternative_{what}")));
    names.extend((0..16).map(|k| format!("m{}{}", k / 4, k % 4)));
    names.extend(THESIS.map(str::to_owned));
    names
}

/// A decimal number without the sign that a rounded -0 would keep.
pub(crate) fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    if text.starts_with('-') && text.bytes().all(|c| b"-0.".contains(&c)) {
        text[1..].to_owned()
    } else {
        text
    }
}

fn empty(cells: usize) -> impl Iterator<Item = String> {
    std::iter::repeat_n(String::new(), cells)
}

pub(crate) fn pose_cells(pose: PoseRecord) -> impl Iterator<Item = String> {
    let PoseRecord { translation_mm, quaternion_wxyz } = pose;
    translation_mm.map(|v| fixed(v, 6)).into_iter().chain(quaternion_wxyz.map(|v| fixed(v, 9)))
}

fn row(study: &Study, frame: &FrameOutcome, body: &BodyOutcome) -> Vec<String> {
    let trial = &study.trials[frame.trial];
    let mut cells = vec![
        trial.name.clone(),
        frame.label.clone(),
        study.bodies[body.body].name.clone(),
        body.verdict().word().to_owned(),
    ];
    // Where no match could be made, the search ended where it would have started.
    let pose = body.result.as_ref().ok().map(|m| m.pose).or(body.start_pose.map(PoseRecord::from));
    let pose = body.bridged.as_ref().map(|bridge| bridge.pose).or(pose);
    match pose {
        Some(pose) => cells.extend(pose_cells(pose)),
        None => cells.extend(empty(POSE.len())),
    }
    cells.push(frame.time_s.map_or(String::new(), |t| fixed(t, 6)));
    cells.push(body.start.word().to_owned());
    cells.push(body.reason());
    // What is stated of a match is not stated of a bridge.
    let found = body.result.as_ref().ok().filter(|_| body.bridged.is_none());
    for view in 0..study.views.len() {
        let fit = trial.frames.iter().position(|(v, _)| *v == view).and_then(|i| found?.views.get(i));
        match fit {
            Some(f) => cells.extend([
                fixed(f.rms_px, 4),
                fixed(f.rms_mm, 5),
                fixed(f.matched_share, 4),
                fixed(f.inset_px, 4),
            ]),
            None => cells.extend(empty(4)),
        }
    }
    match found {
        Some(m) => {
            // A match whose edges do not determine the pose has no covariance; its numbers are immense then.
            let known = |value: f64, text: String| if value.abs() < UNKNOWN { text } else { String::new() };
            let number = |value: f64| known(value, fixed(value, 6));
            cells.extend([number(m.translation_sigma_mm()), number(m.rotation_sigma_rad().to_degrees())]);
            match m.calibration_sigmas() {
                Some([t, r]) => cells.extend([number(t), number(r.to_degrees())]),
                None => cells.extend(empty(2)),
            }
            let half = m.interval_95.iter().enumerate();
            cells.extend(half.map(|(i, w)| number(if i < 3 { *w } else { w.to_degrees() })));
            let upper = (0..6).flat_map(|i| (i..6).map(move |j| m.covariance[i][j]));
            cells.extend(upper.map(|c| known(c, format!("{c:.6e}"))));
            cells.extend([m.iterations.to_string(), fixed(m.objective, 6)]);
            cells.extend([m.starts.tried, m.starts.converged].map(|n| n.to_string()));
            match &m.alternative {
                Some(other) => cells.extend(pose_cells(other.pose)),
                None => cells.extend(empty(POSE.len())),
            }
        }
        None => {
            cells.extend(empty(SIGMAS.len() + INTERVALS.len() + COVARIANCES + SEARCHED.len() + POSE.len()));
        }
    }
    match pose.map(Pose::from) {
        Some(pose) => {
            cells.extend(pose.matrix().transpose().iter().map(|v| fixed(*v, 9)));
            let (angles, translation) = pose.to_thesis(biplane_geometry::Vector3::zeros());
            cells.extend(angles.map(|a| fixed(a.to_degrees(), 7)));
            cells.extend(translation.iter().map(|v| fixed(*v, 6)));
        }
        None => cells.extend(empty(16 + THESIS.len())),
    }
    cells
}

/// The bytes of `poses.csv`.
///
/// # Errors
/// Never for a table in memory; the signature is that of the CSV writer.
pub fn poses_csv(study: &Study, outcome: &Outcome) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let views: Vec<&str> = study.views.iter().map(|v| v.name.as_str()).collect();
    writer.write_record(header(&views))?;
    for (frame, body) in outcome.rows() {
        writer.write_record(row(study, frame, body))?;
    }
    writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))
}

/// The line a person copies into `edits/poses.csv` to start a body in a frame from `pose`.
pub fn pose_line(trial: &str, frame: &str, body: &str, pose: Pose) -> String {
    let cells: Vec<String> = pose_cells(pose.into()).collect();
    format!("{trial},{frame},{body},{}", cells.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_starts_with_what_other_programs_need_and_has_21_covariances() {
        let names = header(&["A", "B"]);
        assert_eq!(names[..11].join(","), "trial,frame,body,verdict,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz");
        let covariances: Vec<&String> = names.iter().filter(|n| n.starts_with("cov_")).collect();
        assert_eq!(covariances.len(), 21);
        assert_eq!((covariances[0].as_str(), covariances[3].as_str()), ("cov_tx_tx_mm2", "cov_tx_rx_mm_rad"));
        assert_eq!(covariances[20], "cov_rz_rz_rad2");
        assert_eq!(names[14..18], ["A_rms_px", "A_rms_mm", "A_matched_share", "A_inset_px"]);
    }

    #[test]
    fn intervals_have_the_order_of_the_covariance_and_every_name_is_there_once() {
        let names = header(&["A", "B"]);
        let from = names.iter().position(|n| n == "interval95_tx_mm").unwrap();
        assert_eq!(names[from..from + 6].join(","), INTERVALS.map(|i| format!("interval95_{i}")).join(","));
        let once: std::collections::BTreeSet<&String> = names.iter().collect();
        assert_eq!(once.len(), names.len());
    }

    #[test]
    fn numbers_have_no_negative_zero() {
        assert_eq!(fixed(-1e-12, 6), "0.000000");
        assert_eq!(fixed(-0.5, 1), "-0.5");
    }

    #[test]
    fn unchanged_bytes_leave_a_file_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/poses.csv");
        assert!(write_if_changed(&path, b"a").unwrap());
        let before = std::fs::metadata(&path).unwrap().modified().unwrap();
        assert!(!write_if_changed(&path, b"a").unwrap());
        assert_eq!(std::fs::metadata(&path).unwrap().modified().unwrap(), before);
        assert!(write_if_changed(&path, b"b").unwrap());
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1, "no temporary file stays");
    }
}
