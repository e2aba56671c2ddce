//! `report.html`: one static page, without network or scripts, its pictures linked relatively and loaded as one scrolls.
//!
//! The same results give the same bytes: no clock and no absolute path is in it.

use biplane_artifact::{AxesSource, Match, PlateFit, Side, Verdict, ViewFit};
use serde::Serialize;

use crate::calibrate::Calibrated;
use crate::models::MODELS;
use crate::outcome::{BodyOutcome, FrameOutcome, ModelOutcome, Outcome, SlicesOutcome};
use crate::overlay::COLOURS;
use crate::results::UNKNOWN;
use crate::study::Study;

/// What the page says beside the results.
#[derive(Debug, Clone, Serialize)]
pub struct Provenance {
    /// Name of a step and its parameters as text.
    pub parameters: Vec<(String, String)>,
    /// An input file (with the picture's number, where it has several) and its content hash.
    pub inputs: Vec<(String, String)>,
}

/// A page could not be made from the template.
#[derive(Debug, thiserror::Error)]
#[error("the report could not be written: {0}")]
pub struct ReportError(#[from] minijinja::Error);

#[derive(Serialize)]
struct Row {
    anchor: usize,
    frame: String,
    time: String,
    body: String,
    verdict: &'static str,
    reason: String,
    fit_mm: String,
    fit_px: String,
    share: String,
    sigma: Option<[String; 2]>,
    /// Half-widths of 95 % intervals: of the place, of the rotation.
    interval: Option<[String; 2]>,
    start: &'static str,
    look: String,
}

#[derive(Serialize)]
struct Card {
    anchor: usize,
    frame: String,
    worst: &'static str,
    bodies: Vec<(String, &'static str, String, String)>,
    pictures: Vec<Shown>,
}

/// One overlay, and what each body's fit in it is.
#[derive(Serialize)]
struct Shown {
    view: String,
    src: String,
    fits: Vec<String>,
}

/// One body over all frames of a trial.
#[derive(Serialize)]
struct Line {
    body: String,
    colour: String,
    counts: [usize; 4],
    /// Place of the frame's card, its label, the verdict.
    frames: Vec<(usize, String, &'static str)>,
    fit_mm: String,
    sigma_mm: String,
    sigma_deg: String,
}

#[derive(Serialize)]
struct TrialPart {
    name: String,
    views: Vec<String>,
    timed: bool,
    /// Whether the calibration's uncertainty is in what is stated.
    calibration_known: bool,
    explained: bool,
    outlined: bool,
    lines: Vec<Line>,
    rows: Vec<Row>,
    cards: Vec<Card>,
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
    flagged: usize,
    views: Vec<&'a str>,
    warnings: &'a [String],
    calibration: Option<CalibrationPart>,
    failures: Vec<(&'a str, &'a str)>,
    slices: Vec<SlicesPart<'a>>,
    slices_flagged: usize,
    models: Vec<ModelPart<'a>>,
    trials: Vec<TrialPart>,
    provenance: &'a Provenance,
}

/// The page.
///
/// # Errors
/// The template fails, which is a fault of this program.
pub fn report_html(study: &Study, outcome: &Outcome, provenance: &Provenance) -> Result<String, ReportError> {
    let mut environment = minijinja::Environment::new();
    environment.add_template("report.html", include_str!("report.html"))?;
    let [good, doubtful, ambiguous, failed] = outcome.verdicts();
    let page = Page {
        name: &study.name,
        version: env!("CARGO_PKG_VERSION"),
        good,
        doubtful,
        ambiguous,
        failed,
        frames: outcome.frames.len(),
        flagged: outcome.flagged().count(),
        views: study.views.iter().map(|v| v.name.as_str()).collect(),
        warnings: &outcome.warnings,
        calibration: calibration_part(&outcome.calibration),
        failures: outcome.failures.iter().map(|f| (f.item.as_str(), f.message.as_str())).collect(),
        slices: outcome.slices.iter().map(|found| slices_part(study, found)).collect(),
        slices_flagged: outcome.slices.iter().map(|found| found.flagged.len()).sum(),
        models: outcome.models.iter().map(|found| model_part(study, found)).collect(),
        trials: (0..study.trials.len()).map(|trial| part(study, outcome, trial)).collect(),
        provenance,
    };
    Ok(environment.get_template("report.html")?.render(minijinja::value::Serde(page))?)
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

fn part(study: &Study, outcome: &Outcome, trial: usize) -> TrialPart {
    let mut rows = Vec::new();
    let mut cards = Vec::new();
    let recording = &study.trials[trial];
    let views: Vec<String> = recording.frames.iter().map(|(v, _)| study.views[*v].name.clone()).collect();
    let lines = (0..recording.bodies.len()).map(|place| line(study, outcome, trial, place)).collect();
    for (anchor, frame) in outcome.frames.iter().enumerate().filter(|(_, f)| f.trial == trial) {
        let mut worst = Verdict::Good;
        let mut bodies = Vec::new();
        for body in &frame.bodies {
            let name = study.bodies[body.body].name.clone();
            let verdict = body.verdict();
            worst = worst.max(verdict);
            bodies.push((name.clone(), verdict.word(), body.reason(), colour(bodies.len())));
            let found = body.result.as_ref().ok();
            rows.push(Row {
                anchor,
                frame: frame.label.clone(),
                time: frame.time_s.map_or(String::new(), |t| format!("{t:.3}")),
                body: name,
                verdict: verdict.word(),
                reason: body.reason(),
                fit_mm: body.fit().map_or(String::new(), |[mm, _]| format!("{mm:.3}")),
                fit_px: a_view(found, |v| format!("{:.2}", v.rms_px)),
                share: a_view(found, |v| format!("{:.0}", 100.0 * v.matched_share)),
                sigma: found
                    .map(|m| [m.translation_sigma_mm(), m.rotation_sigma_rad().to_degrees()])
                    .filter(|sigma| sigma.iter().all(|s| *s < UNKNOWN))
                    .map(|sigma| sigma.map(|s| format!("{s:.3}"))),
                interval: found.and_then(interval),
                start: body.start.word(),
                look: look(body, &views),
            });
        }
        let pictures = frame.overlays.iter().map(|(view, path)| Shown {
            view: study.views[*view].name.clone(),
            src: url(&crate::diagnostics::slashes(path)),
            fits: fits(study, frame, recording.frames.iter().position(|(v, _)| v == view)),
        });
        let pictures = pictures.collect();
        cards.push(Card { anchor, frame: frame.label.clone(), worst: worst.word(), bodies, pictures });
    }
    TrialPart {
        name: recording.name.clone(),
        views,
        calibration_known: outcome.calibration.uncertainties.get(trial).is_some_and(Option::is_some),
        timed: rows.iter().any(|r: &Row| !r.time.is_empty()),
        explained: rows.iter().any(|r| !r.reason.is_empty()),
        outlined: rows.iter().any(|r| !r.look.is_empty()),
        lines,
        rows,
        cards,
    }
}

/// Half-widths of the 95 % intervals along x, y, z, of the place (mm) and of the rotation (degrees).
fn interval(found: &Match) -> Option<[String; 2]> {
    let known = found.interval_95.iter().all(|w| *w < UNKNOWN);
    let three = |from: usize, scale: f64| {
        let of = found.interval_95[from..from + 3].iter().map(|w| format!("{:.2}", scale * w));
        of.collect::<Vec<_>>().join(" / ")
    };
    known.then(|| [three(0, 1.0), three(3, 1.0_f64.to_degrees())])
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

/// A number of each view, in their order.
fn a_view(found: Option<&Match>, number: impl Fn(&ViewFit) -> String) -> String {
    found.map_or(String::new(), |m| m.views.iter().map(number).collect::<Vec<_>>().join(" / "))
}

/// What is said under an overlay: each body's fit in this view.
fn fits(study: &Study, frame: &FrameOutcome, slot: Option<usize>) -> Vec<String> {
    let of = |body: &BodyOutcome| {
        let fit = body.result.as_ref().ok()?.views.get(slot?)?;
        let name = &study.bodies[body.body].name;
        Some(format!("{name}: {:.2} px, {:.0} % found", fit.rms_px, 100.0 * fit.matched_share))
    };
    frame.bodies.iter().filter_map(of).collect()
}

/// One body over a trial: its verdicts, and the medians of what is stated of its poses.
fn line(study: &Study, outcome: &Outcome, trial: usize, place: usize) -> Line {
    let frames = outcome.frames.iter().enumerate().filter(|(_, f)| f.trial == trial);
    let own: Vec<_> = frames.filter_map(|(i, f)| Some((i, f, f.bodies.get(place)?))).collect();
    let median = |values: &dyn Fn(&BodyOutcome) -> Option<f64>| {
        let mut values: Vec<f64> =
            own.iter().filter_map(|(.., b)| values(b)).filter(|v| *v < UNKNOWN).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).map_or("-".to_owned(), |v| format!("{v:.3}"))
    };
    let mut counts = [0; 4];
    for (.., body) in &own {
        counts[body.verdict() as usize] += 1;
    }
    Line {
        body: study.bodies[study.trials[trial].bodies[place]].name.clone(),
        colour: colour(place),
        counts,
        fit_mm: median(&|b| b.fit().map(|f| f[0])),
        sigma_mm: median(&|b| b.result.as_ref().ok().map(Match::translation_sigma_mm)),
        sigma_deg: median(&|b| b.result.as_ref().ok().map(|m| m.rotation_sigma_rad().to_degrees())),
        frames: own.into_iter().map(|(i, f, b)| (i, f.label.clone(), b.verdict().word())).collect(),
    }
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
mod tests {
    use super::*;
    use crate::outcome::StartKind;
    use crate::study::{Body, MeshSource, SurfaceSource, Trial, View};

    fn study() -> Study {
        let view = |name: &str| View {
            name: name.into(),
            mask: None,
            source: crate::study::ViewSource::File {
                calibration: "c".into(),
                pixel_origin: crate::config::Origin::Centre,
                distortion: None,
                uncertainty: None,
            },
        };
        Study {
            root: "/study".into(),
            name: "<script> & co".into(),
            views: vec![view("A"), view("B")],
            bodies: vec![Body {
                name: "femur".into(),
                surface: SurfaceSource::File(MeshSource { path: "m".into(), units: None }),
                model: None,
                ignore_cut_ends: false,
                axes: None,
                landmarks: None,
                reference: None,
            }],
            slices: vec![],
            joints: vec![],
            trials: vec![Trial {
                name: "lunge".into(),
                frames: vec![(0, "a".into()), (1, "b".into())],
                pair_by: crate::config::PairBy::Number,
                offset: 0,
                frame_rate_hz: None,
                starts: None,
                bodies: vec![0],
            }],
            plate: None,
            beads: None,
            spots: Default::default(),
            distortion: Default::default(),
            environment: Default::default(),
            doctor: Default::default(),
            segment: Default::default(),
            edit: Default::default(),
            matching: Default::default(),
            tracking: Default::default(),
            smoothing: Default::default(),
            contour: Default::default(),
            output: "/study/results".into(),
            export: Default::default(),
        }
    }

    #[test]
    fn two_thousand_frames_are_one_page_of_escaped_text_and_lazy_pictures() {
        let frame = |i: usize| FrameOutcome {
            trial: 0,
            label: format!("{i:04}"),
            time_s: Some(i as f64 / 100.0),
            bodies: vec![BodyOutcome {
                body: 0,
                start: StartKind::File,
                start_pose: Some(biplane_geometry::Pose::identity()),
                result: Err("a < b".into()),
                bridged: None,
                contours: vec![],
            }],
            overlays: vec![(0, format!("overlays/lunge/{i:04}_A.png").into())],
        };
        let outcome = Outcome { frames: (0..2000).map(frame).collect(), ..Outcome::default() };
        let provenance = Provenance { parameters: vec![], inputs: vec![("x.png".into(), "00".into())] };
        let page = report_html(&study(), &outcome, &provenance).unwrap();
        assert!(page.contains("&lt;script&gt; &amp; co") && !page.contains("<script>"), "escaped");
        assert!(page.contains("not matched: a &lt; b"));
        assert_eq!(page.matches("loading=\"lazy\" src=\"overlays").count(), 2000);
        assert_eq!(page.matches("<tr class=\"failed-row\">").count(), 2000);
        // Faults: nothing said which colour is which body, and verdicts had to be looked for row by row.
        assert_eq!(page.matches("<a class=\"failed\" href=\"#f").count(), 2000, "one mark a frame and body");
        assert!(page.contains("background:#56c8ff") && page.contains("broken line"), "a legend");
        assert!(!page.contains("/study") && !page.contains("http"), "no absolute path, no network");
        assert!(page.len() < 4_000_000, "{} bytes", page.len());
    }

    #[test]
    fn odd_names_still_make_a_link() {
        assert_eq!(url("overlays/a b/x#1_é.png"), "overlays/a%20b/x%231_%C3%A9.png");
    }
}
