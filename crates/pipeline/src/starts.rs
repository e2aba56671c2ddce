//! Which pose each body starts from in each frame.
//!
//! A person's `edits/poses.csv` wins over the trial's table. A frame that neither names takes the pose between the
//! nearest given ones before and after it (by place in the trial's list of frames), or the nearest one at the ends; so a
//! laboratory can give a few frames of many. Where none is given at all, a body is looked for anywhere, unless the pipeline file says not to.

use biplane_geometry::{Point3, Pose};

use crate::diagnostics::slashes;
use crate::outcome::StartKind;
use crate::tables::{EXAMPLE_HEADER, PoseTable, same_frame};

/// Frames named in a message.
const NAMED: usize = 5;

/// No start for a body in a trial.
#[derive(Debug, thiserror::Error)]
#[error(
    "no start pose for body `{body}` in trial `{trial}`: {searched}. Give at least one frame a row with the columns \
     {EXAMPLE_HEADER} (world_from_model, mm, unit quaternion with its scalar first) in {place}"
)]
pub struct NoStart {
    trial: String,
    body: String,
    searched: String,
    place: String,
}

/// One start a frame for `body` in `trial`, whose frames are `labels`; `centroid` is the mesh's area centroid, mm.
///
/// # Errors
/// There is no start for any frame.
pub fn starts_of(
    trial: &str,
    body: &str,
    labels: &[&str],
    edits: Option<&PoseTable>,
    table: Option<&PoseTable>,
    centroid: Point3,
) -> Result<Vec<(StartKind, Option<Pose>)>, NoStart> {
    let mut given: Vec<Option<(StartKind, Pose)>> = vec![None; labels.len()];
    for (kind, source) in [(StartKind::File, table), (StartKind::Edit, edits)] {
        for row in source.into_iter().flat_map(|t| t.of(trial, body)) {
            for place in (0..labels.len()).filter(|i| same_frame(labels[*i], &row.frame)) {
                given[place] = Some((kind.clone(), row.pose));
            }
        }
    }
    let anchors: Vec<(usize, Pose)> =
        given.iter().enumerate().filter_map(|(i, g)| g.as_ref().map(|(_, pose)| (i, *pose))).collect();
    if anchors.is_empty() && !labels.is_empty() {
        let searched: Vec<String> = [table, edits]
            .into_iter()
            .flatten()
            .map(|t| {
                format!(
                    "{} has {} row(s) for it, none for a frame of the trial",
                    slashes(&t.path),
                    t.of(trial, body).count()
                )
            })
            .collect();
        return Err(NoStart {
            trial: trial.to_owned(),
            body: body.to_owned(),
            searched: if searched.is_empty() {
                "the trial names no table `starts`, and there is no edits/poses.csv".to_owned()
            } else {
                searched.join("; ")
            },
            place: match table {
                Some(t) => slashes(&t.path),
                None => "edits/poses.csv, or in a table named by `starts = \"starts.csv\"` of the trial"
                    .to_owned(),
            },
        });
    }
    let between = |i: usize| {
        let after = anchors.partition_point(|(at, _)| *at < i);
        match (after.checked_sub(1).and_then(|b| anchors.get(b)), anchors.get(after)) {
            (Some((a, from)), Some((b, to))) => {
                Some(from.between(to, (i - a) as f64 / (b - a) as f64, &centroid))
            }
            (Some((_, nearest)), None) | (None, Some((_, nearest))) => Some(*nearest),
            (None, None) => None,
        }
    };
    Ok(given
        .into_iter()
        .enumerate()
        .filter_map(|(i, start)| start.or_else(|| between(i).map(|pose| (StartKind::Interpolated, pose))))
        .map(|(kind, pose)| (kind, Some(pose)))
        .collect())
}

/// Edits for frames that a trial does not have: a person's work that would be lost without a word.
pub fn unused_edits(edits: &PoseTable, trial: &str, labels: &[&str], only_trial: bool) -> Vec<String> {
    edits
        .rows
        .iter()
        .filter(|r| r.trial.as_deref().map_or(only_trial, |t| t == trial))
        .filter(|r| !labels.iter().any(|l| same_frame(l, &r.frame)))
        .map(|r| {
            format!(
                "{}:{}: trial {trial} has no frame `{}`, the row is not used",
                slashes(&edits.path),
                r.line,
                r.frame
            )
        })
        .collect()
}

/// Rows of a table of starts for frames that a trial does not have, in one line; they may be meant for another study.
pub fn unused_starts(table: &PoseTable, trial: &str, labels: &[&str], only_trial: bool) -> Option<String> {
    let rows = table.rows.iter().filter(|r| r.trial.as_deref().map_or(only_trial, |t| t == trial));
    let mut frames: Vec<&str> = rows.map(|r| r.frame.as_str()).collect();
    frames.retain(|f| !labels.iter().any(|l| same_frame(l, f)));
    let rows = frames.len();
    frames.dedup();
    let more = if frames.len() > NAMED { ", ..." } else { "" };
    frames.truncate(NAMED);
    (rows > 0).then(|| {
        format!(
            "{}: {rows} row(s) are for frames that trial {trial} does not have, and are not used: {}{more}",
            slashes(&table.path),
            frames.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const HEADER: &str = "trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz\n";

    fn table(rows: &str) -> PoseTable {
        PoseTable::parse(Path::new("starts.csv"), format!("{HEADER}{rows}").as_bytes()).unwrap()
    }

    fn x(starts: &[(StartKind, Option<Pose>)]) -> Vec<(&str, f64)> {
        starts.iter().map(|(k, p)| (k.word(), p.unwrap().translation().x)).collect()
    }

    #[test]
    fn an_edit_wins_and_gaps_are_filled_evenly() {
        let file =
            table("t,1,f,10,0,0,1,0,0,0\nt,4,f,40,0,0,1,0,0,0\nt,9,f,9,0,0,1,0,0,0\nu,0,f,7,0,0,1,0,0,0\n");
        let edits = table("t,0004,f,70,0,0,1,0,0,0\n");
        let labels = ["0000", "0001", "0002", "0003", "0004", "0005"];
        let starts = starts_of("t", "f", &labels, Some(&edits), Some(&file), Point3::origin()).unwrap();
        let expected = [
            ("interpolated", 10.0),
            ("file", 10.0),
            ("interpolated", 30.0),
            ("interpolated", 50.0),
            ("edit", 70.0),
            ("interpolated", 70.0),
        ];
        for (found, wanted) in x(&starts).iter().zip(expected) {
            assert_eq!(found.0, wanted.0);
            assert!((found.1 - wanted.1).abs() < 1e-12, "{found:?} {wanted:?}");
        }
        assert_eq!(starts.len(), 6);
    }

    #[test]
    fn no_start_says_where_to_write_one() {
        let file = table("t,99,f,10,0,0,1,0,0,0\n");
        let error = starts_of("t", "f", &["1"], None, Some(&file), Point3::origin()).unwrap_err().to_string();
        assert!(
            error.contains("no start pose for body `f` in trial `t`: starts.csv has 1 row(s)"),
            "{error}"
        );
        assert!(error.contains("trial,frame,body,tx_mm") && error.ends_with("in starts.csv"), "{error}");
        let error = starts_of("t", "f", &["1"], None, None, Point3::origin()).unwrap_err().to_string();
        assert!(error.contains("edits/poses.csv, or in a table"), "{error}");
    }

    /// Fault: rows of starts for frames that are not there were passed over without a word.
    #[test]
    fn starts_for_frames_that_are_not_there_are_told_in_one_line() {
        let table = table("t,1,f,1,0,0,1,0,0,0\nt,8,f,1,0,0,1,0,0,0\nt,9,f,1,0,0,1,0,0,0\n");
        let note = unused_starts(&table, "t", &["0001"], false);
        let expected =
            "starts.csv: 2 row(s) are for frames that trial t does not have, and are not used: 8, 9";
        assert_eq!(note.as_deref(), Some(expected));
        assert_eq!(unused_starts(&table, "u", &["0001"], false), None);
    }

    #[test]
    fn an_edit_for_a_frame_that_is_not_there_is_told() {
        let notes = unused_edits(&table("t,8,f,1,0,0,1,0,0,0\nt,1,f,1,0,0,1,0,0,0\n"), "t", &["0001"], false);
        assert_eq!(notes, ["starts.csv:2: trial t has no frame `8`, the row is not used"]);
    }
}
