//! The short table at the end of a run and in `status`.

use std::path::Path;

use biplane_artifact::Verdict;

use crate::outcome::Outcome;
use crate::study::Study;
use crate::tables::TableError;

/// More rows than this are summed up, and only those that are not good are listed.
const FEW: usize = 40;

/// One line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct SummaryRow {
    /// Trial.
    pub trial: String,
    /// Frame label.
    pub frame: String,
    /// Body.
    pub body: String,
    /// Root mean square over the views, mm and px.
    pub fit: Option<[f64; 2]>,
    /// `good`, `doubtful`, `ambiguous` or `failed`.
    pub verdict: String,
    /// Why it is not good.
    pub reason: String,
}

/// The rows of a run.
pub fn of_outcome(study: &Study, outcome: &Outcome) -> Vec<SummaryRow> {
    outcome
        .rows()
        .map(|(frame, body)| SummaryRow {
            trial: study.trials[frame.trial].name.clone(),
            frame: frame.label.clone(),
            body: study.bodies[body.body].name.clone(),
            fit: body.fit(),
            verdict: body.verdict().word().to_owned(),
            reason: body.reason(),
        })
        .collect()
}

/// The rows of a `poses.csv` that a run wrote.
///
/// # Errors
/// It cannot be read or is not such a table.
pub fn of_file(path: &Path) -> Result<Vec<SummaryRow>, TableError> {
    let name = crate::diagnostics::slashes(path);
    let bytes =
        std::fs::read(path).map_err(|source| TableError::Unreadable { path: name.clone(), source })?;
    let malformed = |e: csv::Error| TableError::Malformed {
        path: name.clone(),
        line: String::new(),
        what: e.to_string(),
    };
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let header = reader.headers().map_err(malformed)?.clone();
    let at = |wanted: &'static str| {
        header.iter().position(|h| h == wanted).ok_or_else(|| TableError::NoColumn {
            path: name.clone(),
            column: wanted,
            hint: String::new(),
        })
    };
    let [trial, frame, body, verdict, reason] =
        [at("trial")?, at("frame")?, at("body")?, at("verdict")?, at("reason")?];
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(malformed)?;
        let text = |i: usize| record.get(i).unwrap_or_default().to_owned();
        let mean = |ending: &str| {
            let cells = header.iter().zip(record.iter()).filter(|(h, _)| h.ends_with(ending));
            let values: Vec<f64> = cells.filter_map(|(_, cell)| cell.parse().ok()).collect();
            let squares = values.iter().map(|v| v * v).sum::<f64>();
            (!values.is_empty()).then(|| (squares / values.len() as f64).sqrt())
        };
        let fit = mean("_rms_mm").zip(mean("_rms_px")).map(|(mm, px)| [mm, px]);
        let (verdict, reason) = (text(verdict), text(reason));
        rows.push(SummaryRow {
            trial: text(trial),
            frame: text(frame),
            body: text(body),
            fit,
            verdict,
            reason,
        });
    }
    Ok(rows)
}

/// All verdicts, as they are counted.
pub const VERDICTS: [Verdict; 4] = [Verdict::Good, Verdict::Doubtful, Verdict::Ambiguous, Verdict::Failed];

/// How many there are of each verdict; ambiguous ones only where there are any.
pub fn counts(of: [usize; 4]) -> String {
    let shown = VERDICTS.iter().zip(of).filter(|(verdict, n)| **verdict != Verdict::Ambiguous || *n > 0);
    shown.map(|(verdict, n)| format!("{n} {}", verdict.word())).collect::<Vec<_>>().join(", ")
}

/// The table as text: every row if they are few, else counts and the rows that are not good.
pub fn table(rows: &[SummaryRow]) -> String {
    let mut out = String::new();
    let mut shown: Vec<&SummaryRow> = rows.iter().collect();
    if rows.len() > FEW {
        let mut groups: Vec<(&str, &str)> =
            rows.iter().map(|r| (r.trial.as_str(), r.body.as_str())).collect();
        groups.sort_unstable();
        groups.dedup();
        let counts = groups.iter().map(|(trial, body)| {
            let of = |v: &str| {
                let same = rows.iter().filter(|r| r.trial == *trial && r.body == *body && r.verdict == v);
                same.count().to_string()
            };
            let mut fits: Vec<f64> = rows
                .iter()
                .filter(|r| r.trial == *trial && r.body == *body)
                .filter_map(|r| r.fit.map(|f| f[0]))
                .collect();
            fits.sort_by(f64::total_cmp);
            let median = fits.get(fits.len() / 2).map_or(String::new(), |f| format!("{f:.3}"));
            vec![
                (*trial).to_owned(),
                (*body).to_owned(),
                of("good"),
                of("doubtful"),
                of("ambiguous"),
                of("failed"),
                median,
            ]
        });
        out += &aligned(
            &["trial", "body", "good", "doubtful", "ambiguous", "failed", "median fit mm"],
            counts,
            &[2, 3, 4, 5, 6],
        );
        shown.retain(|r| r.verdict != "good");
        if shown.is_empty() {
            return out;
        }
        out += "\nNot good:\n";
    }
    let more = shown.len().saturating_sub(FEW);
    let lines = shown.iter().take(FEW).map(|r| {
        let number = |i: usize, digits: usize| r.fit.map_or("-".to_owned(), |f| format!("{:.digits$}", f[i]));
        vec![
            r.trial.clone(),
            r.frame.clone(),
            r.body.clone(),
            number(0, 3),
            number(1, 2),
            r.verdict.clone(),
            r.reason.clone(),
        ]
    });
    out += &aligned(&["trial", "frame", "body", "fit mm", "fit px", "verdict", ""], lines, &[3, 4]);
    if more > 0 {
        out += &format!("... and {more} more in poses.csv\n");
    }
    out
}

/// Columns of equal width, two spaces apart; those in `right` are flush right.
pub fn aligned(header: &[&str], rows: impl Iterator<Item = Vec<String>>, right: &[usize]) -> String {
    let mut lines: Vec<Vec<String>> = vec![header.iter().map(|h| (*h).to_owned()).collect()];
    lines.extend(rows);
    let width = |column: usize| {
        lines.iter().filter_map(|l| l.get(column)).map(|c| c.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let mut out = String::new();
    for line in &lines {
        let cells: Vec<String> = line
            .iter()
            .zip(&widths)
            .enumerate()
            .map(
                |(i, (cell, width))| {
                    if right.contains(&i) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
                },
            )
            .collect();
        out += cells.join("  ").trim_end();
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(frame: usize, verdict: &str) -> SummaryRow {
        SummaryRow {
            trial: "lunge".into(),
            frame: frame.to_string(),
            body: "femur".into(),
            fit: Some([0.1, 0.25]),
            verdict: verdict.into(),
            reason: if verdict == "good" { String::new() } else { "why".into() },
        }
    }

    #[test]
    fn few_rows_are_all_there() {
        let text = table(&[row(7, "good"), row(8, "failed")]);
        let expected = "trial  frame  body   fit mm  fit px  verdict\n\
                        lunge  7      femur   0.100    0.25  good\n\
                        lunge  8      femur   0.100    0.25  failed   why\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn ambiguous_ones_are_counted_where_there_are_any() {
        assert_eq!(counts([3, 1, 0, 2]), "3 good, 1 doubtful, 2 failed");
        assert_eq!(counts([3, 1, 4, 2]), "3 good, 1 doubtful, 4 ambiguous, 2 failed");
    }

    #[test]
    fn many_rows_are_counted_and_the_good_ones_left_out() {
        let rows: Vec<_> = (0..50).map(|i| row(i, if i == 31 { "doubtful" } else { "good" })).collect();
        let text = table(&rows);
        assert!(text.contains("lunge  femur    49         1          0       0          0.100"), "{text}");
        assert!(text.contains("31") && !text.contains("32"), "{text}");
    }
}
