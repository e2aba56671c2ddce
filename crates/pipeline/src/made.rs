//! The list of pictures that runs made in the folder of results (overlays, and what shows the calibration and the slices), so that those of
//! frames, trials or views that are no longer in the study can be taken away, and nothing else is.
//!
//! `overlays/.made.json` names each one and the content hash it was written with. What the list does not name, or
//! what holds other bytes by now, is a person's: it stays.

use std::collections::BTreeMap;
use std::path::{Component, Path};

use biplane_artifact::{Artifact, Content, Picture, ReportFrame};
use serde::{Deserialize, Serialize};

use crate::results::write_if_changed;

/// The list's place in the folder of results.
const LIST: &str = "overlays/.made.json";

/// Overlays relative to the folder of results (with forward slashes), and the hash of each one's bytes.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Made {
    overlays: BTreeMap<String, String>,
}

impl Made {
    /// Of overlays and their hashes.
    pub fn of(overlays: impl Iterator<Item = (String, String)>) -> Self {
        Self { overlays: overlays.collect() }
    }

    /// The list in a folder of results. A damaged one, or none, is empty: files stay that could have gone.
    fn read(results: &Path) -> Self {
        let bytes = std::fs::read(results.join(LIST)).unwrap_or_default();
        serde_json::from_slice(&bytes).unwrap_or_default()
    }

    /// Writes the list. After a `whole` run, overlays that earlier runs made and this one did not are taken away;
    /// otherwise they stay in the list. Returns how many were taken away.
    ///
    /// # Errors
    /// The list cannot be written. A file that cannot be taken away stays, and stays in the list.
    pub fn save(mut self, results: &Path, whole: bool) -> std::io::Result<usize> {
        let mut gone = 0;
        for (name, hash) in Self::read(results).overlays {
            if self.overlays.contains_key(&name) {
                continue;
            }
            if !whole {
                self.overlays.insert(name, hash);
                continue;
            }
            match take_away(results, &name, &hash) {
                Ok(taken) => gone += usize::from(taken),
                Err(error) => {
                    tracing::warn!(
                        "{}: an overlay of an earlier run could not be removed: {error}",
                        results.join(&name).display()
                    );
                    self.overlays.insert(name, hash);
                }
            }
        }
        if !self.overlays.is_empty() || results.join(LIST).exists() {
            let mut bytes = serde_json::to_vec_pretty(&self)?;
            bytes.push(b'\n');
            write_if_changed(&results.join(LIST), &bytes)?;
        }
        Ok(gone)
    }
}

/// Removes an overlay that is still what a run wrote, and its folder if nothing else is in it.
fn take_away(results: &Path, name: &str, hash: &str) -> std::io::Result<bool> {
    // The list is a file that anyone can edit: it must not reach out of the folder of overlays.
    let inside = Path::new(name).components().all(|c| matches!(c, Component::Normal(_)));
    if !inside
        || !["overlays/", "calibration/", "slices/", "kinematics/", "exports/", "report/"]
            .iter()
            .any(|folder| name.starts_with(folder))
    {
        return Ok(false);
    }
    let path = results.join(name);
    let bytes = match std::fs::read(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(false),
        bytes => bytes?,
    };
    let of_script = ReportFrame::decode(&bytes).ok().map(|script| script.content_hash().to_hex());
    if of_script.as_deref() != Some(hash) && Picture(bytes).content_hash().to_hex() != hash {
        return Ok(false);
    }
    std::fs::remove_file(&path)?;
    if let Some(folder) = path.parent() {
        // Refused, as it should be, while anything is in it.
        let _ = std::fs::remove_dir(folder);
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_the_list_names_and_nobody_changed_is_taken_away() {
        let folder = tempfile::tempdir().unwrap();
        let results = folder.path();
        let put = |name: &str, text: &str| {
            let path = results.join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
            (name.to_owned(), Picture(text.as_bytes().to_vec()).content_hash().to_hex())
        };
        put("overlays/t/mine.png", "mine");
        let outside = put("poses.csv", "poses");
        let climbing = ("overlays/../poses.csv".to_owned(), outside.1.clone());
        let old = put("overlays/t/1_A.png", "1");
        let drawn_on = put("overlays/t/2_A.png", "2");
        let alone = put("overlays/u/1_A.png", "u");
        let kept = put("overlays/t/3_A.png", "3");
        let all = [old, drawn_on, alone, kept.clone(), outside, climbing];
        assert_eq!(Made::of(all.into_iter()).save(results, true).unwrap(), 0);
        std::fs::write(results.join("overlays/t/2_A.png"), "2 with arrows").unwrap();

        assert_eq!(Made::of([kept.clone()].into_iter()).save(results, false).unwrap(), 0, "a stopped run");
        assert_eq!(Made::of([kept].into_iter()).save(results, true).unwrap(), 2);
        let there = |name: &str| results.join(name).exists();
        assert!(!there("overlays/t/1_A.png") && !there("overlays/u"));
        for name in ["overlays/t/mine.png", "overlays/t/2_A.png", "overlays/t/3_A.png", "poses.csv"] {
            assert!(there(name), "{name}");
        }
    }
}
