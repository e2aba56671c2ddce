//! `report.html` and the folder `report/` beside it: what people look at, opened from disk without a network.
//!
//! The page holds the tables and every pose as numbers; `report/report.js` draws them (its sources are in `web/`), `report/models.js` has the bodies,
//! `report/frames/TRIAL/FRAME.js` pictures and outlines of one frame, loaded when it is looked at. So a page of 2,000 frames stays small.
//! Without scripts the page still says every verdict that is not good.
//!
//! **Guaranteed:** the same results give the same bytes: no clock and no absolute path is in it, nor anything of a picture's file but its pixels.

pub mod frame;
pub mod item;
pub mod models;
pub mod single;

mod data;
mod joints;
mod methods;

use std::path::PathBuf;

use biplane_artifact::{AxesSource, PlateFit, PoseRecord, Side, Verdict};
use serde::Serialize;

use crate::calibrate::Calibrated;
use crate::models::MODELS;
use crate::outcome::{BodyOutcome, ModelOutcome, Outcome, SlicesOutcome};
use crate::overlay::COLOURS;
use crate::study::Study;

use self::models::Bodies;

/// The folder of results that is the report's.
pub const REPORT: &str = "report";
/// The script of the page, as `web/` is built.
const SCRIPT: &str = include_str!("../../assets/report.js");
/// Licences of what is in the script.
const LICENCES: &str = include_str!("../../assets/LICENCES.txt");

/// What the page says beside the results.
#[derive(Debug, Clone, Serialize)]
pub struct Provenance {
    /// Name of a step and its parameters as text.
    pub parameters: Vec<(String, String)>,
    /// An input file (with the picture's number, where it has several) and its content hash.
    pub inputs: Vec<(String, String)>,
}

/// A joint over a trial.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Joint {
    /// Index of the trial in the study.
    pub trial: usize,
    /// Its name.
    pub name: String,
    /// What is plotted.
    pub quantities: Vec<Quantity>,
}

/// One curve of a joint: a value a frame of the trial, none where it is not known.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Quantity {
    /// What it is, as in "flexion".
    pub label: String,
    /// Its unit, as in "degrees".
    pub unit: String,
    /// From the poses as they were found.
    pub values: Vec<Option<f64>>,
    /// Half-widths of the 95 % intervals.
    pub half_width_95: Vec<Option<f64>>,
    /// From smoothed poses, where such were made.
    pub smoothed: Option<Vec<Option<f64>>>,
}

/// How a search came to a pose.
#[derive(Debug, Clone, Serialize)]
pub struct SearchPath {
    /// Index of the trial in the study.
    pub trial: usize,
    /// The frame's number in its trial.
    pub frame: usize,
    /// The body's place among the trial's bodies.
    pub place: usize,
    /// Objective and pose of each step, from the start on.
    pub steps: Vec<(f64, PoseRecord)>,
}

/// What the page is made from beside the outcome.
#[derive(Debug, Clone, Copy)]
pub struct Contents<'a> {
    /// Parameters and inputs.
    pub provenance: &'a Provenance,
    /// What is shown in 3D.
    pub bodies: &'a Bodies,
    /// Searches that were recorded.
    pub searches: &'a [SearchPath],
}

/// A page could not be made from the template.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The template fails.
    #[error("the report could not be written: {0}")]
    Template(#[from] minijinja::Error),
    /// The numbers cannot be written.
    #[error("the numbers of the report could not be written: {0}")]
    Numbers(#[from] serde_json::Error),
}

/// A pose that is not good, for who looks without scripts.
#[derive(Serialize)]
struct Row {
    trial: String,
    frame: String,
    body: String,
    verdict: &'static str,
    reason: String,
}

/// What the calibration pictures gave.
#[derive(Serialize)]
struct CalibrationPart {
    verdict: &'static str,
    views: Vec<CalibratedView>,
    angle: Option<String>,
    triangulation: Option<String>,
    drawings: Vec<ShownDrawing>,
}

#[derive(Serialize)]
struct ShownDrawing {
    title: String,
    src: String,
}

#[derive(Serialize)]
struct CalibratedView {
    view: String,
    holes: String,
    before: String,
    held_out: String,
    model: String,
    beads: String,
    reprojection: String,
    distance: String,
    pixel: String,
    source: String,
}

/// A bone in the slices of a volume.
#[derive(Serialize)]
struct SlicesPart<'a> {
    bone: &'a str,
    volume: String,
    slices: usize,
    with_bone: usize,
    contours: usize,
    holes: usize,
    edited: usize,
    flagged: usize,
    why: String,
    sheet: Option<String>,
    table: Option<String>,
}

/// The model of a body.
#[derive(Serialize)]
struct ModelPart<'a> {
    body: &'a str,
    from: &'a str,
    points: usize,
    triangles: usize,
    volume: String,
    smoothed: String,
    faults: String,
    axes: String,
    proposed: bool,
    sheet: Option<String>,
    files: Option<String>,
}

#[derive(Serialize)]
struct Page<'a> {
    name: &'a str,
    version: &'a str,
    good: usize,
    doubtful: usize,
    ambiguous: usize,
    failed: usize,
    frames: usize,
    trials: usize,
    flagged: usize,
    edits: usize,
    views: Vec<&'a str>,
    warnings: &'a [String],
    calibration: Option<CalibrationPart>,
    calibration_known: bool,
    failures: Vec<(&'a str, &'a str)>,
    slices: Vec<SlicesPart<'a>>,
    slices_flagged: usize,
    models: Vec<ModelPart<'a>>,
    rows: Vec<Row>,
    methods: String,
    provenance: &'a Provenance,
    /// JSON, safe within a script.
    data: String,
}

/// The page.
///
/// # Errors
/// The template fails, which is a fault of this program.
pub fn page(study: &Study, outcome: &Outcome, contents: &Contents<'_>) -> Result<String, ReportError> {
    let mut environment = minijinja::Environment::new();
    environment.add_template("report.html", include_str!("report.html"))?;
    environment.add_template("report.css", include_str!("report.css"))?;
    let [good, doubtful, ambiguous, failed] = outcome.verdicts();
    let joints = joints::joints(study, outcome);
    let data = serde_json::to_string(&data::data(study, outcome, contents, &joints))?;
    let wanted = outcome.rows().filter(|(_, body)| body.verdict() != Verdict::Good);
    let rows = wanted.map(|(frame, body)| Row {
        trial: study.trials[frame.trial].name.clone(),
        frame: frame.label.clone(),
        body: study.bodies[body.body].name.clone(),
        verdict: body.verdict().word(),
        reason: body.reason(),
    });
    let page = Page {
        name: &study.name,
        version: env!("CARGO_PKG_VERSION"),
        good,
        doubtful,
        ambiguous,
        failed,
        frames: outcome.frames.len(),
        trials: study.trials.len(),
        flagged: outcome.flagged().count(),
        edits: outcome.edits[0],
        views: study.views.iter().map(|v| v.name.as_str()).collect(),
        warnings: &outcome.warnings,
        calibration: calibration_part(&outcome.calibration),
        calibration_known: outcome.calibration.uncertainties.iter().all(Option::is_some),
        failures: outcome.failures.iter().map(|f| (f.item.as_str(), f.message.as_str())).collect(),
        slices: outcome.slices.iter().map(|found| slices_part(study, found)).collect(),
        slices_flagged: outcome.slices.iter().map(|found| found.flagged.len()).sum(),
        models: outcome.models.iter().map(|found| model_part(study, found)).collect(),
        rows: rows.collect(),
        methods: methods::methods(study, outcome),
        provenance: contents.provenance,
        // A name with `</script>` in it must not end the script.
        data: data.replace('<', "\\u003c"),
    };
    Ok(environment.get_template("report.html")?.render(minijinja::value::Serde(page))?)
}

/// The files in `report/` that are not of one frame, relative to the folder of results.
pub fn scripts(bodies: &Bodies) -> [(PathBuf, Vec<u8>); 3] {
    let place = |name: &str| PathBuf::from(REPORT).join(name);
    [
        (place("report.js"), SCRIPT.as_bytes().to_vec()),
        (place("models.js"), models::script(bodies).into_bytes()),
        (place("LICENCES.txt"), LICENCES.as_bytes().to_vec()),
    ]
}

fn model_part<'a>(study: &'a Study, found: &'a ModelOutcome) -> ModelPart<'a> {
    let body = &study.bodies[found.body].name;
    let report = found.surface.as_ref();
    let smoothed =
        report.filter(|r| r.unsmoothed_volume_mm3 > 0.0 && r.volume_mm3 != r.unsmoothed_volume_mm3);
    let smoothed = smoothed.map(|r| 100.0 * (r.volume_mm3 / r.unsmoothed_volume_mm3 - 1.0));
    let side = |side| match side {
        Side::Left => "left, ",
        Side::Right => "right, ",
    };
    let source = |source| match source {
        AxesSource::Points => "given by points",
        AxesSource::Landmarks => "from landmarks",
        AxesSource::Shape => "proposed from the shape",
    };
    ModelPart {
        body,
        from: &found.from,
        points: found.points,
        triangles: found.triangles,
        volume: report.map_or(String::new(), |r| format!("{:.2}", r.volume_mm3 / 1000.0)),
        smoothed: smoothed.map_or(String::new(), |percent| format!("{percent:+.2} %")),
        faults: report.map_or(String::new(), |r| r.faults.len().to_string()),
        axes: found.axes.map_or(String::new(), |(by, of)| format!("{}{}", side(of), source(by))),
        proposed: found.axes.is_some_and(|(by, _)| by == AxesSource::Shape),
        sheet: found.sheet.as_deref().map(|path| url(&crate::diagnostics::slashes(path))),
        files: found.made.then(|| url(&format!("{MODELS}/{body}.stl"))),
    }
}

fn slices_part<'a>(study: &'a Study, found: &SlicesOutcome) -> SlicesPart<'a> {
    let bone = &study.slices[found.bone];
    let link = |place: &Option<std::path::PathBuf>| {
        place.as_deref().map(|path| url(&crate::diagnostics::slashes(path)))
    };
    SlicesPart {
        bone: &bone.name,
        volume: study.relative(&bone.volume),
        slices: found.slices,
        with_bone: found.with_bone,
        contours: found.contours,
        holes: found.holes,
        edited: found.edited.len(),
        flagged: found.flagged.len(),
        why: found.to_look_at().unwrap_or_default(),
        sheet: link(&found.sheet),
        table: link(&found.table),
    }
}

fn calibration_part(calibrated: &Calibrated) -> Option<CalibrationPart> {
    let environment = calibrated.environment.as_ref()?;
    let sigma = |view: usize, axis: usize| {
        environment.covariance.get(9 * view + axis).and_then(|row| row.get(9 * view + axis)).map(|v| v.sqrt())
    };
    let views = environment.views.iter().zip(&calibrated.plates).enumerate();
    let views = views.map(|(number, (found, plate))| {
        let of_plate = |text: fn(&PlateFit) -> String| plate.as_ref().map_or(String::new(), |fit| text(fit));
        let source = found.source.iter().enumerate().map(|(axis, v)| match sigma(number, axis) {
            Some(sigma) => format!("{v:.2} ± {sigma:.2}"),
            None => format!("{v:.2}"),
        });
        CalibratedView {
            view: found.view.clone(),
            holes: of_plate(|f| f.matched.iter().filter(|m| m.used).count().to_string()),
            before: of_plate(|f| format!("{:.2}", f.before_rms_px)),
            held_out: of_plate(|f| {
                let score = f.models.iter().find(|m| m.name == f.model);
                score.map_or(String::new(), |m| format!("{:.3}", m.held_out_rms_px))
            }),
            model: of_plate(|f| f.model.clone()),
            beads: found.beads.iter().filter(|b| b.used).count().to_string(),
            reprojection: format!("{:.3}", found.reprojection_rms_px),
            distance: format!("{:.2}", found.source_to_detector_mm),
            pixel: format!("{:.5}", found.pixel_mm),
            source: source.collect::<Vec<_>>().join(", "),
        }
    });
    let drawings = calibrated.drawings.iter().map(|drawn| ShownDrawing {
        title: drawn.title.clone(),
        src: url(&crate::diagnostics::slashes(&drawn.place)),
    });
    Some(CalibrationPart {
        verdict: calibrated.verdict().word(),
        views: views.collect(),
        angle: environment.angle_deg.map(|a| format!("{a:.2}")),
        triangulation: environment.triangulation_rms_mm.map(|mm| format!("{mm:.3}")),
        drawings: drawings.collect(),
    })
}

/// Which views' outlines a person should look at, and which ones a person drew.
fn look(body: &BodyOutcome, views: &[String]) -> String {
    let view = |slot: usize| views.get(slot).map_or("", String::as_str);
    let edited = body.contours.iter().enumerate().filter(|(_, c)| c.edited);
    let edited = edited.map(|(slot, _)| format!("{}: edited by hand", view(slot)));
    let flagged = body.flagged().map(|(slot, flags)| format!("{}: {}", view(slot), flags.join(", ")));
    edited.chain(flagged).collect::<Vec<_>>().join("; ")
}

/// The colour of a trial's body in the overlays.
fn colour(place: usize) -> String {
    let [r, g, b] = COLOURS[place % COLOURS.len()];
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A relative path as the address of a link.
fn url(path: &str) -> String {
    let mut out = String::with_capacity(path.len());
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_./~".contains(&byte) {
            out.push(char::from(byte));
        } else {
            out.push_str(&format!("%{byte:02X}"));
        }
    }
    out
}

#[cfg(test)]
mod tests;
