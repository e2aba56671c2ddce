//! A paragraph for a paper: what was done with which parameters, how well the calibration came out, and what is not known.
//!
//! It is made from the study and its results alone, so it says nothing that a run did not do.

use biplane_artifact::{Environment, Match, PlateFit};
use biplane_optimisation::Method;

use crate::outcome::Outcome;
use crate::results::UNKNOWN;
use crate::study::{Study, SurfaceSource, ViewSource};

/// The paragraph, in sentences of plain text.
pub(super) fn methods(study: &Study, outcome: &Outcome) -> String {
    let mut text = vec![frames(study, outcome)];
    text.push(calibration(study, outcome));
    text.extend(models(study, outcome));
    text.push(matching(study, !outcome.smoothed.is_empty()));
    text.push(verdicts(study, outcome));
    text.extend(how_sure(study, outcome));
    text.push(
        "These are intervals of the fit and, where stated, of the calibration; errors of the surface models are not in them, and no pose was \
         compared with an independent measurement."
            .to_owned(),
    );
    text.join(" ")
}

fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.retain(|v| *v < UNKNOWN);
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

fn frames(study: &Study, outcome: &Outcome) -> String {
    let trials: Vec<String> = study
        .trials
        .iter()
        .enumerate()
        .map(|(number, trial)| {
            let count = outcome.frames.iter().filter(|f| f.trial == number).count();
            let rate = trial.frame_rate_hz.map_or(String::new(), |hz| format!(" at {hz} Hz"));
            format!("{} ({count} frames{rate})", trial.name)
        })
        .collect();
    let views = match study.views.len() {
        1 => "a single-plane fluoroscope".to_owned(),
        2 => "a biplane fluoroscope".to_owned(),
        n => format!("{n} fluoroscopes"),
    };
    format!(
        "Poses were measured by matching surface models to the pictures of {views} with biplane {} in the {} {}.",
        env!("CARGO_PKG_VERSION"),
        if trials.len() == 1 { "trial" } else { "trials" },
        list(&trials)
    )
}

fn calibration(study: &Study, outcome: &Outcome) -> String {
    let Some(environment) = &outcome.calibration.environment else {
        let files = study.views.iter().filter(|v| matches!(v.source, ViewSource::File { .. })).count();
        return format!(
            "The calibration of {} was taken from files of other programs.",
            if files == 1 { "the view" } else { "the views" }
        );
    };
    let Environment { views, angle_deg, triangulation_rms_mm, .. } = &**environment;
    let mut text = Vec::new();
    let plates: Vec<&PlateFit> = outcome.calibration.plates.iter().flatten().map(|p| &**p).collect();
    if !plates.is_empty() {
        let left: Vec<String> = plates
            .iter()
            .filter_map(|fit| fit.models.iter().find(|m| m.name == fit.model))
            .map(|score| format!("{:.3}", score.held_out_rms_px))
            .collect();
        let before: Vec<String> = plates.iter().map(|fit| format!("{:.2}", fit.before_rms_px)).collect();
        text.push(format!(
            "Distortion was found from pictures of a plate; of {} px rms, {} px were left at holes that the fit had not seen.",
            list(&before),
            list(&left)
        ));
    }
    let beads: Vec<String> =
        views.iter().map(|v| v.beads.iter().filter(|b| b.used).count().to_string()).collect();
    let left: Vec<String> = views.iter().map(|v| format!("{:.3}", v.reprojection_rms_px)).collect();
    let apart = angle_deg.map_or(String::new(), |a| format!(", the views {a:.1} degrees apart"));
    let again = triangulation_rms_mm.map_or(String::new(), |mm| {
        format!("; beads left out of the calibration were found again to {mm:.3} mm rms")
    });
    text.push(format!(
        "Sources and detectors were found from {} beads a view with {} px rms of reprojection{apart}{again}.",
        list(&beads),
        list(&left)
    ));
    text.join(" ")
}

fn models(study: &Study, outcome: &Outcome) -> Option<String> {
    let used = super::models::shown(study);
    let of = |found: &crate::outcome::ModelOutcome| {
        let body = &study.bodies[found.body];
        let from = match &body.surface {
            SurfaceSource::File(_) => "a mesh",
            SurfaceSource::Contours(..) => "contours of slices",
            SurfaceSource::Labels(..) => "a label map",
        };
        format!("{} ({from}, {} triangles)", body.name.replace('_', " "), found.triangles)
    };
    let all: Vec<String> =
        outcome.models.iter().filter(|m| used.contains(&m.body) && m.triangles > 0).map(of).collect();
    (!all.is_empty()).then(|| format!("The models were those of {}.", list(&all)))
}

fn matching(study: &Study, smoothed: bool) -> String {
    let segment = &study.segment;
    let edges = toml::to_string(segment).ok().and_then(|text| {
        let smoothing = text.lines().find(|line| line.starts_with("smoothing_px"))?;
        Some(format!(" (smoothing {} px)", smoothing.split('=').nth(1)?.trim()))
    });
    let how = match study.matching.method {
        Method::Rim => {
            "the exact rim of each model was projected into all views at once and its distance from edges of its direction minimised by \
             Levenberg and Marquardt's method with bounded influence of far edges; how far X-ray edges lie inside the outline was estimated \
             beside the pose"
        }
        Method::Bingham2006 => {
            "the outline of each model on a grid was matched to the contours by a bounded quasi-Newton method from several starts (Bingham, 2006)"
        }
        Method::Search => "the objective and optimiser named in the parameters below were used",
    };
    let tracked = if study.tracks() {
        " Frames that did not match well by themselves were tried again from the poses of their neighbours."
    } else {
        " Every frame was matched by itself."
    };
    let smoothed = if smoothed {
        " The raw poses are reported; smoothed ones were made beside them."
    } else {
        " No pose was smoothed."
    };
    format!(
        "Edges were found in each picture to a fraction of a pixel{}, and {how}.{tracked}{smoothed}",
        edges.unwrap_or_default()
    )
}

fn verdicts(study: &Study, outcome: &Outcome) -> String {
    let [good, doubtful, ambiguous, failed] = outcome.verdicts();
    let limits = &study.matching;
    let edited = outcome.rows().filter(|(_, b)| b.start == crate::outcome::StartKind::Edit).count();
    let drawn = outcome.rows().flat_map(|(_, b)| &b.contours).filter(|c| c.edited).count();
    let by_hand = match (edited, drawn) {
        (0, 0) => "No pose was started and no outline drawn by hand.".to_owned(),
        (e, d) => format!("By hand {e} poses were started and {d} outlines drawn."),
    };
    format!(
        "A pose counts as good if at least {:.0} % of its outline found an edge in every view with at most {} px rms, and its standard \
         deviations are at most {} mm and {} degrees: {good} of {} poses were good, {doubtful} doubtful, {ambiguous} ambiguous, {failed} \
         failed. {by_hand}",
        100.0 * limits.good_share,
        limits.good_rms_px,
        limits.good_sigma_mm,
        limits.good_sigma_deg,
        good + doubtful + ambiguous + failed
    )
}

fn how_sure(study: &Study, outcome: &Outcome) -> Option<String> {
    let used = super::models::shown(study);
    let of = |body: usize| {
        let found: Vec<&Match> = outcome
            .rows()
            .filter(|(_, b)| b.body == body)
            .filter_map(|(_, b)| b.result.as_ref().ok())
            .collect();
        let t = median(found.iter().map(|m| m.translation_sigma_mm()).collect())?;
        let r = median(found.iter().map(|m| m.rotation_sigma_rad().to_degrees()).collect())?;
        Some(format!("{t:.3} mm and {r:.3} degrees ({})", study.bodies[body].name.replace('_', " ")))
    };
    let all: Vec<String> = used.into_iter().filter_map(of).collect();
    let known = outcome.calibration.uncertainties.iter().all(Option::is_some);
    let from = if known {
        "from the residuals and from how sure the calibration is"
    } else {
        "from the residuals alone, the calibration's uncertainty being unknown"
    };
    (!all.is_empty()).then(|| format!("Median standard deviations of a pose were {}, {from}.", list(&all)))
}
