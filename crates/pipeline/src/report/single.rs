//! The report as one file with chosen frames, to be sent to somebody: `biplane report --single-file`.
//!
//! It is made from `report.html` and the folder beside it as the last run wrote them: scripts, chosen frames and drawings go into the page.

use std::path::Path;

use super::REPORT;
use crate::diagnostics::slashes;
use crate::drawings::base64;

/// Why there is no such file.
#[derive(Debug, thiserror::Error)]
pub enum SingleFileError {
    /// Something of the report is not there.
    #[error(
        "cannot read {path}: {source}. Run `biplane run` first: it writes the report that this takes its frames from"
    )]
    Missing {
        /// Which file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// A frame that the report does not have.
    #[error(
        "the report has no frame `{wanted}`. Give the label or the number of a frame, with its trial where there are several: {example}"
    )]
    NoFrame {
        /// As asked for.
        wanted: String,
        /// What could be.
        example: String,
    },
    /// It is not a page of this version.
    #[error("{path} was written by another version of biplane (it has no {what}). Run `biplane run` again")]
    Other {
        /// Which file.
        path: String,
        /// What was not found.
        what: &'static str,
    },
}

/// The script that the page loads.
const TAG: &str = "<script src=\"report/report.js\" defer></script>";

/// The page with everything in it. `frames` are labels, or numbers that stand in them, each with `TRIAL/` before it or not; none stands
/// for all frames.
///
/// # Errors
/// See [`SingleFileError`].
pub fn single_file(results: &Path, frames: &[String]) -> Result<String, SingleFileError> {
    let text = |path: &Path| {
        let bytes = std::fs::read_to_string(path);
        bytes.map_err(|source| SingleFileError::Missing { path: slashes(path), source })
    };
    let path = results.join("report.html");
    let mut page = text(&path)?;
    let all = frames_of(&results.join(REPORT).join("frames"));
    let mut chosen: Vec<&(String, String)> = Vec::new();
    for wanted in frames {
        let found: Vec<_> = all.iter().filter(|(trial, label)| is(wanted, trial, label)).collect();
        if found.is_empty() {
            let example =
                all.first().map_or("there is none".to_owned(), |(trial, label)| format!("{trial}/{label}"));
            return Err(SingleFileError::NoFrame { wanted: wanted.clone(), example });
        }
        chosen.extend(found);
    }
    if frames.is_empty() {
        chosen = all.iter().collect();
    }
    chosen.sort();
    chosen.dedup();
    let mut scripts = String::new();
    for (trial, label) in chosen {
        let place = Path::new(REPORT).join("frames").join(trial).join(format!("{label}.js"));
        // The page asks for a frame by its address; the script is kept as text until then.
        scripts += &inert(&super::url(&slashes(&place)), &text(&results.join(&place))?);
    }
    let models = Path::new(REPORT).join("models.js");
    scripts += &inert(&slashes(&models), &text(&results.join(&models))?);
    if !page.contains(TAG) {
        return Err(SingleFileError::Other { path: slashes(&path), what: "script of the report" });
    }
    // `</script` occurs in no script that is put in: JSON and base64 have none, and a test looks at the bundle.
    page = page.replace(TAG, &format!("{scripts}<script>{}</script>", super::SCRIPT));
    Ok(drawings_inside(results, &page))
}

/// A script that does not run by itself.
fn inert(address: &str, script: &str) -> String {
    format!("<script type=\"text/plain\" data-src=\"{address}\">{script}</script>\n")
}

/// Trials and labels of the frames that there are, in order.
fn frames_of(folder: &Path) -> Vec<(String, String)> {
    let names = |folder: &Path| -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.filter_map(|entry| entry.file_name().into_string().ok()).collect()
    };
    let mut all = Vec::new();
    for trial in names(folder) {
        let frames = names(&folder.join(&trial));
        all.extend(frames.iter().filter_map(|f| Some((trial.clone(), f.strip_suffix(".js")?.to_owned()))));
    }
    all.sort();
    all
}

/// Whether a frame is meant: by its label, or by a number that the label ends with.
fn is(wanted: &str, trial: &str, label: &str) -> bool {
    let frame = match wanted.rsplit_once('/') {
        Some((of, _)) if of != trial => return false,
        Some((_, frame)) => frame,
        None => wanted,
    };
    let number = label.rfind(|c: char| !c.is_ascii_digit()).map_or(label, |at| {
        let width = label[at..].chars().next().map_or(1, char::len_utf8);
        &label[at + width..]
    });
    frame == label || matches!((frame.parse::<u64>(), number.parse::<u64>()), (Ok(a), Ok(b)) if a == b)
}

/// Drawings that the page shows are put into it; links to other files of the results stay as they are.
fn drawings_inside(results: &Path, page: &str) -> String {
    let mut out = String::with_capacity(page.len());
    let mut rest = page;
    let mark = "<img loading=\"lazy\" src=\"";
    while let Some(at) = rest.find(mark) {
        let (before, after) = rest.split_at(at + mark.len());
        out += before;
        let end = after.find('"').unwrap_or(0);
        let address = &after[..end];
        match std::fs::read(results.join(address)) {
            Ok(bytes) if address.ends_with(".svg") => {
                out += "data:image/svg+xml;base64,";
                out += &base64::encode(&bytes);
            }
            _ => out += address,
        }
        rest = &after[end..];
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_named_by_its_label_or_its_number() {
        for (wanted, yes) in [
            ("0003", true),
            ("3", true),
            ("squat/3", true),
            ("lunge/3", false),
            ("13", false),
            ("x", false),
            ("", false),
        ] {
            assert_eq!(is(wanted, "squat", "0003"), yes, "{wanted}");
        }
        assert!(is("17", "t", "é17") && is("17", "t", "cam1_0017") && !is("1", "t", "cam1_0017"));
    }

    #[test]
    fn the_bundle_can_stand_within_a_page() {
        assert!(!super::super::SCRIPT.to_lowercase().contains("</script"));
    }

    #[test]
    fn frames_and_drawings_go_into_the_page_and_others_stay_out() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        put("report/frames/t/0003.js", "biplaneFrame(3);\n");
        put("report/frames/t/0004.js", "biplaneFrame(4);\n");
        put("report/models.js", "biplaneModels([]);\n");
        put("models/femur.svg", "<svg/>");
        assert!(matches!(single_file(folder.path(), &[]), Err(SingleFileError::Missing { .. })));
        put("report.html", "old");
        assert!(matches!(single_file(folder.path(), &[]), Err(SingleFileError::Other { .. })));
        put("report.html", &format!("<img loading=\"lazy\" src=\"models/femur.svg\" alt=\"\">{TAG}"));
        let page = single_file(folder.path(), &["3".to_owned()]).unwrap();
        assert!(page.contains("data-src=\"report/frames/t/0003.js\">biplaneFrame(3)"), "{}", &page[..300]);
        assert!(!page.contains("biplaneFrame(4)") && !page.contains(TAG));
        assert!(page.starts_with("<img loading=\"lazy\" src=\"data:image/svg+xml;base64,PHN2Zy8+\""));
        assert!(single_file(folder.path(), &[]).unwrap().contains("biplaneFrame(4)"));
        let error = single_file(folder.path(), &["t/9".to_owned()]).unwrap_err().to_string();
        assert!(error.contains("`t/9`") && error.contains("t/0003"), "{error}");
    }
}
