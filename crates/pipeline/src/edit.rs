//! `biplane edit`: outlines written into `edits/` for a person to put right, as drawings for Inkscape or as tables.
//!
//! What is written is what the program finds by itself: for each body the stretches of automatic curves that are its outline, going on
//! a little beyond what is trusted, so that a person can take in more by dragging a mark. The picture is linked where a drawing
//! program shows it as it is; otherwise a grey copy with stretched levels lies beside the drawing. **No file that is there is ever
//! overwritten.**

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use biplane_acquisition::edits::{Sketch, SketchBody, SketchPiece, write_drawing, write_table};
use biplane_artifact::{Content, ContourPiece, Curves, Frame, Match, Picture, Verdict};
use biplane_contour::ContourOf;
use biplane_geometry::Curve;
use biplane_stage::{Context, Hashed, Stage, Store, StoreError};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::calibrate::{CalibrateError, calibrate};
use crate::diagnostics::{meant, slashes};
use crate::models;
use crate::overlay::COLOURS;
use crate::prepare::{InputErrors, Job, Prepared};
use crate::steps::{Standing, Steps, read_stored};
use crate::study::Study;
use crate::tables::same_frame;
use crate::walk::Way;

/// Points of an edge that are shown beyond either end of what is trusted.
const BEYOND: usize = 15;
/// Bits of the grey levels that drawing programs show as they are.
const SHOWN_BITS: u32 = 8;

/// Which pictures, and how.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wish<'a> {
    /// This trial alone.
    pub trial: Option<&'a str>,
    /// This frame alone; without it, those that a person should look at.
    pub frame: Option<&'a str>,
    /// This view alone.
    pub view: Option<&'a str>,
    /// As tables, not as drawings.
    pub csv: bool,
    /// Beside the edits that are there, as `.new`.
    pub again: bool,
}

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
pub enum EditCommandError {
    /// Inputs that everything hangs on are wrong.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The store cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// There are no fluoroscopes.
    #[error("The calibration itself failed.\n{0}")]
    Calibration(#[from] CalibrateError),
    /// A name that is none of the study's.
    #[error("there is no {what} `{wanted}`: {meant}")]
    NoSuch {
        /// What kind of name.
        what: &'static str,
        /// The name.
        wanted: String,
        /// What may be meant.
        meant: String,
    },
    /// The last run is not of these inputs.
    #[error("{0}: its match is not up to date, so its outlines are not known; `biplane run` first")]
    NotRun(String),
    /// An edit is there.
    #[error(
        "{0} is there already and is not overwritten. Edit that one; or `--again` writes what the program finds now beside it, as \
         `.new`; or move it away"
    )]
    Exists(String),
    /// The outlines cannot be found.
    #[error("{0}")]
    Item(String),
    /// A file cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// Which.
        path: String,
        /// Why.
        source: std::io::Error,
    },
}

/// Writes what is wished and says what was written, and what to do with it.
///
/// # Errors
/// See [`EditCommandError`]; what was written before it stays.
pub fn edit(study: Study, wish: &Wish<'_>) -> Result<String, EditCommandError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    let context = Context::new();
    let calibrated = calibrate(&prepared, &store, &context, Way::Look(Vec::new())).0?.unwrap_or_default();
    let (study, calibrated) = (&prepared.study, &calibrated);
    let models = &models::look::look(&prepared, &store, &context, &mut Vec::new()).0;
    let steps = Steps { prepared: &prepared, calibrated, models, store: &store, context: &context };
    known("trial", wish.trial, study.trials.iter().map(|t| t.name.as_str()), |a, b| a == b)?;
    let of_trial = |job: &&Job| wish.trial.is_none_or(|name| study.trials[job.trial].name == name);
    let jobs: Vec<&Job> = prepared.jobs.iter().filter(of_trial).collect();
    known("frame", wish.frame, jobs.iter().map(|j| j.label.as_str()), same_frame)?;
    known("view", wish.view, study.views.iter().map(|v| v.name.as_str()), |a, b| a == b)?;
    let (mut written, mut there, mut not_run) = (Vec::new(), 0, 0);
    for job in jobs.into_iter().filter(|j| wish.frame.is_none_or(|frame| same_frame(&j.label, frame))) {
        let wanted = |slot: &usize| wish.view.is_none_or(|name| steps.view(job, *slot).1 == name);
        let slots: Vec<usize> = (0..job.pictures.len()).filter(wanted).collect();
        let old = |slot: usize| job.edits.get(slot)?.first().filter(|_| !wish.again);
        if let (Some(_), Some(path)) = (wish.frame, slots.iter().find_map(|slot| old(*slot))) {
            return Err(EditCommandError::Exists(study.relative(path)));
        }
        let Some(made) = Made::of(&steps, job) else {
            if wish.frame.is_some() {
                return Err(not_made(&steps, job));
            }
            not_run += 1;
            continue;
        };
        for slot in slots {
            if wish.frame.is_none() && !made.is_to_look_at(&steps, job, slot) {
                continue;
            }
            if old(slot).is_some() {
                there += 1;
                continue;
            }
            written.push(study.relative(&write(&steps, job, slot, &made, wish)?));
        }
    }
    Ok(told(&written, there, not_run, wish))
}

/// Why a frame's outlines are not known: an edit that cannot be read, or a run that was not done.
fn not_made(steps: &Steps<'_>, job: &Job) -> EditCommandError {
    let fault = (0..job.pictures.len()).find_map(|slot| steps.drawn(job, slot).err());
    let trial = &steps.prepared.study.trials[job.trial].name;
    let not_run = || EditCommandError::NotRun(format!("{trial} {}", job.label));
    fault.map_or_else(not_run, |error| EditCommandError::Item(error.to_string()))
}

/// A name that is given has to be one of the study's.
pub(crate) fn known<'a>(
    what: &'static str,
    wanted: Option<&str>,
    names: impl Iterator<Item = &'a str> + Clone,
    same: impl Fn(&str, &str) -> bool,
) -> Result<(), EditCommandError> {
    match wanted {
        Some(wanted) if !names.clone().any(|name| same(name, wanted)) => {
            let (wanted, meant) = (wanted.to_owned(), meant(wanted, names.take(20)));
            Err(EditCommandError::NoSuch { what, wanted, meant })
        }
        _ => Ok(()),
    }
}

fn told(written: &[String], there: usize, not_run: usize, wish: &Wish<'_>) -> String {
    let mut text: String = written.iter().map(|path| format!("wrote {path}\n")).collect();
    if there > 0 {
        text += &format!(
            "{there} picture(s) have an edit already; it was left alone (`biplane edits` lists them)\n"
        );
    }
    if not_run > 0 {
        text += &format!("{not_run} frame(s) are not up to date and were left out; `biplane run` first\n");
    }
    if written.is_empty() {
        return text
            + "nothing was written: no outline asks to be looked at. Name a frame: `biplane edit TRIAL FRAME VIEW`\n";
    }
    let how = match (wish.again, wish.csv) {
        (true, _) => {
            "Files named `.new` are not used: take what you need from them. Renamed in place of the old ones\nand left unchanged, they give the outlines back to the program.\n"
        }
        (false, false) => {
            "Open them in Inkscape: drag nodes, delete a path, draw one in the layer of its body; the two circles of a path bound what is \
             trusted. Save where they are, then `biplane run`.\n"
        }
        (false, true) => "Edit them where they are, then `biplane run`.\n",
    };
    text + how
}

/// A frame with all its matches.
struct Made {
    standing: Standing,
    /// One a body of the job.
    matches: Vec<Hashed<Match>>,
}

impl Made {
    fn of(steps: &Steps<'_>, job: &Job) -> Option<Self> {
        if steps.calibrated.calibrations.is_empty() {
            return None;
        }
        let standing = steps.standing(job)?;
        let of_body = |place| {
            let curves = steps.explain_curves(job, place, &standing.automatic, &standing.drawn).ok()??;
            read_stored(steps.store, &steps.explain_match(job, place, &curves).ok()?.1?).ok()
        };
        let matches = (0..job.bodies.len()).map(of_body).collect::<Option<_>>()?;
        Some(Self { standing, matches })
    }

    /// Whether a match of the frame is not good, or an outline in this picture is flagged and nobody drew it.
    fn is_to_look_at(&self, steps: &Steps<'_>, job: &Job, slot: usize) -> bool {
        let edited = |place| {
            self.standing.drawn.get(slot).and_then(Option::as_ref).is_some_and(|d| d.of(place).is_some())
        };
        self.matches.iter().enumerate().any(|(place, matched)| {
            let flagged = || {
                let curves = self.standing.automatic.get(slot)?;
                let found = steps.explain_contour(job, slot, place, curves, matched.promise()).ok()?.1?;
                Some(!read_stored(steps.store, &found).ok()?.flags.is_empty())
            };
            !edited(place) && (matched.verdict != Verdict::Good || flagged() == Some(true))
        })
    }
}

/// Writes one picture's outlines; returns the file.
fn write(
    steps: &Steps<'_>,
    job: &Job,
    slot: usize,
    made: &Made,
    wish: &Wish<'_>,
) -> Result<PathBuf, EditCommandError> {
    let study = &steps.prepared.study;
    let item = EditCommandError::Item;
    let facts = steps.picture(job, slot).map_err(|e| item(e.to_string()))?;
    let automatic =
        made.standing.automatic.get(slot).ok_or_else(|| item("the picture has no curves".to_owned()))?;
    let mut bodies = Vec::new();
    for (place, matched) in made.matches.iter().enumerate() {
        let inputs = steps.contour_inputs(job, slot, place, automatic, matched).map_err(item)?;
        let found = ContourOf::run(&inputs, &study.contour_of(job.bodies[place].0), steps.context)
            .map_err(|e| item(e.to_string()))?;
        let mut flags = found.flags;
        if matched.verdict != Verdict::Good {
            flags.push(format!("the match is {}: {}", matched.verdict.word(), matched.reason));
        }
        bodies.push(SketchBody {
            name: study.bodies[job.bodies[place].0].name.clone(),
            colour: COLOURS[place % COLOURS.len()],
            pieces: found.pieces.iter().filter_map(|piece| sketched(&inputs.curves, piece)).collect(),
            flags,
        });
    }
    let (trial, view) = (&study.trials[job.trial].name, steps.view(job, slot).1);
    let sketch = Sketch {
        trial: trial.clone(),
        frame: job.label.clone(),
        view: view.to_owned(),
        picture: facts.hash(),
        size: facts.size,
        bodies,
    };
    let folder = study.edits().join(trial);
    let stem = format!("{}_{view}", job.label);
    let new = if wish.again { ".new" } else { "" };
    let (ending, text) = if wish.csv {
        ("csv", write_table(&sketch))
    } else {
        ("svg", write_drawing(&sketch, &backdrop(steps, job, slot, &folder, &stem)?))
    };
    let path = folder.join(format!("{stem}{new}.{ending}"));
    create(&path, text.as_bytes()).map_err(|source| match source.kind() {
        std::io::ErrorKind::AlreadyExists => EditCommandError::Exists(study.relative(&path)),
        _ => EditCommandError::Write { path: slashes(&path), source },
    })?;
    Ok(path)
}

/// A stretch of a curve and a little beyond.
fn sketched(curves: &Curves, piece: &ContourPiece) -> Option<SketchPiece> {
    let Curve { points, closed } = curves.0.get(piece.curve)?;
    let count = points.len();
    if piece.first >= count || piece.last >= count {
        return None;
    }
    let through_seam = piece.last < piece.first;
    let length = if through_seam { piece.last + count - piece.first } else { piece.last - piece.first } + 1;
    let whole = *closed && length >= count;
    let [before, after] = match (whole, closed) {
        (true, _) => [0; 2],
        (false, true) => [BEYOND.min((count - length) / 2); 2],
        (false, false) => [BEYOND.min(piece.first), BEYOND.min(count - 1 - piece.last)],
    };
    let own: Vec<_> = (0..before + length + after)
        .filter_map(|i| points.get((piece.first + count - before + i) % count))
        .collect();
    Some(SketchPiece {
        points: own.iter().map(|p| [p.position.x, p.position.y]).collect(),
        sigmas: own.iter().map(|p| p.sigma_px).collect(),
        closed: whole,
        trusted: [before, before + length - 1],
    })
}

/// Where a drawing in `folder` finds the picture; a copy is written there if its own file cannot be shown.
fn backdrop(
    steps: &Steps<'_>,
    job: &Job,
    slot: usize,
    folder: &Path,
    stem: &str,
) -> Result<String, EditCommandError> {
    let study = &steps.prepared.study;
    let source = &job.pictures[slot];
    let frame =
        steps.prepared.read(source).map_err(|e| EditCommandError::Item(study.shorten(&e.to_string())))?;
    let ending = source.path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let shown = matches!(ending.as_str(), "png" | "jpg" | "jpeg") && frame.bits <= SHOWN_BITS;
    // From `edits/<trial>/`; a picture elsewhere may not be there on another day.
    if let (true, Ok(inside)) = (shown, source.path.strip_prefix(&study.root)) {
        return Ok(format!("../../{}", slashes(inside)));
    }
    let bytes = shown_copy(&frame).map_err(|e| EditCommandError::Item(e.to_string()))?;
    own_backdrop(folder, stem, bytes)
}

/// Writes a picture beside the drawing that it belongs to, if it is not there, and gives its name. No other picture is overwritten.
pub(crate) fn own_backdrop(folder: &Path, stem: &str, bytes: Vec<u8>) -> Result<String, EditCommandError> {
    let own = |name: &str| std::fs::read(folder.join(name)).is_ok_and(|old| old == bytes);
    // One that was changed since, or is of the picture as it was, stays.
    let hash = Picture(bytes.clone()).content_hash().to_hex();
    let named = format!("{stem}.{}.png", hash.get(..8).unwrap_or_default());
    let name = [format!("{stem}.png"), named.clone()]
        .into_iter()
        .find(|n| own(n) || !folder.join(n).exists())
        .unwrap_or(named);
    if !own(&name) {
        let path = folder.join(&name);
        create(&path, &bytes).map_err(|source| EditCommandError::Write { path: slashes(&path), source })?;
    }
    Ok(name)
}

/// A grey PNG of 8 bits whose darkest level is black and whose brightest is white.
pub(crate) fn shown_copy(frame: &Frame) -> Result<Vec<u8>, image::ImageError> {
    let (low, high) = frame.samples.iter().fold((u16::MAX, 0), |(low, high), s| (low.min(*s), high.max(*s)));
    let range = f64::from(high.saturating_sub(low).max(1));
    let bytes: Vec<u8> =
        frame.samples.iter().map(|s| (f64::from(s - low) / range * 255.0).round() as u8).collect();
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Default, FilterType::Adaptive).write_image(
        &bytes,
        frame.width as u32,
        frame.height as u32,
        ExtendedColorType::L8,
    )?;
    Ok(png)
}

/// A new file; one that is there is an error.
pub(crate) fn create(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let mut file = File::create_new(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{EdgePoint, Point2, Vector2};

    fn curves(count: usize, closed: bool) -> Curves {
        let point = |i| EdgePoint {
            position: Point2::new(i as f64, 0.0),
            direction: Vector2::y(),
            strength: 1.0,
            sigma_px: 0.1,
        };
        Curves(vec![Curve { points: (0..count).map(point).collect(), closed }])
    }

    fn ends(closed: bool, first: usize, last: usize) -> (f64, f64, f64, f64, bool) {
        let piece = sketched(&curves(100, closed), &ContourPiece { curve: 0, first, last }).unwrap();
        let x = |i: usize| piece.points[i][0];
        let [from, to] = piece.trusted;
        (x(0), x(from), x(to), x(piece.points.len() - 1), piece.closed)
    }

    #[test]
    fn a_piece_goes_on_a_little_beyond_what_is_trusted() {
        assert_eq!(ends(false, 30, 60), (15.0, 30.0, 60.0, 75.0, false));
        assert_eq!(ends(false, 4, 98), (0.0, 4.0, 98.0, 99.0, false));
        assert_eq!(ends(true, 90, 20), (75.0, 90.0, 20.0, 35.0, false), "through the seam");
        assert_eq!(ends(true, 10, 89), (0.0, 10.0, 89.0, 99.0, false), "no point twice");
        assert_eq!(ends(true, 0, 99), (0.0, 0.0, 99.0, 99.0, true));
        assert_eq!(ends(true, 50, 49), (50.0, 50.0, 49.0, 49.0, true));
        assert!(sketched(&curves(10, true), &ContourPiece { curve: 0, first: 0, last: 10 }).is_none());
    }
}
