//! Accuracy against what makes it worse: noise, blur, missing outline, the angle between the views, wrong calibration.

use biplane_optimisation::MatchParams;
use biplane_phantom::{Body, Exposure, TrueFluoroscope, biplane};

use super::SectionError;
use crate::faults::{cut, miscalibrated, noisy, random};
use crate::knee::Posture;
use crate::lab::{Frames, calibrations, thesis_params};
use crate::outcome::{Method, Outcome, outcomes};
use crate::pictures::{Equipment, Knee};
use crate::plot::{Panel, Series, lines};
use crate::scene::{Claim, Made, Origin};
use crate::summary::{distribution_columns, distribution_row};
use crate::{Distribution, Lab, STARTS, Scene, Section, StartOffset, Table};

const BODY: Body = Body::FemoralComponent;
const POINTS: usize = 15_000;
/// Noise of outlines where something else is varied: standard deviation and correlation length, px.
const NOISE_PX: (f64, f64) = (0.5, 3.0);

/// What is varied: its name in tables, its axis, its file, values.
struct Sweep<'a> {
    name: &'a str,
    axis: &'a str,
    file: &'a str,
    values: &'a [f64],
}

fn matched(lab: &Lab, scene: &Scene) -> Vec<Outcome> {
    let starts = StartOffset { count: 1, seed: lab.seed, ..STARTS };
    let draw = |truth: &_, centroid: &_, frame| starts.draw(truth, centroid, frame);
    outcomes(scene, Method::Default, &thesis_params(), &draw)
}

fn from_outlines(lab: &Lab, views: &[TrueFluoroscope], frames: Frames) -> Result<Scene, SectionError> {
    let made = Made { origin: Origin::Solid, claim: Claim::Accuracy, params: MatchParams::default() };
    let mesh = lab.workshop.surface(BODY, POINTS)?;
    Ok(Scene::made(made, &mesh, &calibrations(views), frames)?)
}

/// Noise on every outline, and what else `also` does to those of view B.
fn disturbed(
    lab: &Lab,
    frames: &Frames,
    purpose: u64,
    also: impl Fn(&biplane_artifact::Curves, usize) -> biplane_artifact::Curves,
) -> Frames {
    frames
        .iter()
        .enumerate()
        .map(|(number, (label, pose, curves))| {
            let mut chance = random(lab.seed, purpose, number);
            let curves = curves
                .iter()
                .enumerate()
                .map(|(view, c)| {
                    let c = noisy(c, NOISE_PX.0, NOISE_PX.1, &mut chance);
                    if view == 1 { also(&c, number) } else { c }
                })
                .collect();
            (label.clone(), *pose, curves)
        })
        .collect()
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let views = biplane(90.0);
    let postures: Vec<_> =
        (0..lab.count(24, 4)).map(|k| (k.to_string(), Posture::random(lab.seed + 2, k))).collect();
    let mut table = Table {
        id: "sweeps".to_owned(),
        heading: "femoral component, 15,000 points".to_owned(),
        columns: distribution_columns(),
        rows: Vec::new(),
    };
    let mut plots = Vec::new();
    let mut sweep = |sweep: &Sweep, measure: &dyn Fn(f64) -> Result<Vec<Outcome>, SectionError>| {
        let mut series: [Vec<(f64, f64)>; 4] = Default::default();
        for &value in sweep.values {
            // A quick run measures the middle value alone.
            if !lab.full() && value != sweep.values[sweep.values.len() / 2] {
                continue;
            }
            let all = measure(value)?;
            table.rows.push(distribution_row(&format!("{} {value}", sweep.name), &all));
            let of =
                |f: fn(&Outcome) -> f64| Distribution::of(all.iter().filter(|o| o.counts).map(f).collect());
            let mm = of(|o| o.error.translation_mm);
            let deg = of(|o| o.error.rotation_rad.to_degrees());
            for (points, y) in series.iter_mut().zip([mm.median, mm.p95, deg.median, deg.p95]) {
                points.push((value, y));
            }
        }
        let [a, b, c, d] = series;
        let panel = |y: &str, median, p95| Panel {
            x: sweep.axis.to_owned(),
            y: y.to_owned(),
            series: vec![
                Series { name: "median".to_owned(), points: median },
                Series { name: "95 %".to_owned(), points: p95 },
            ],
            limit: None,
        };
        let panels = [panel("position, mm", a, b), panel("rotation, degrees", c, d)];
        let caption = format!("Error against {}", sweep.axis);
        plots.push(lines(sweep.file, &caption, &panels)?);
        Ok::<(), SectionError>(())
    };
    let usual = Exposure::fluoroscopy();
    let pictured = |exposure: Exposure| {
        let equipment = Equipment::new(&views, &exposure);
        let recorded = lab.record(Knee::Implants, &postures, &equipment)?;
        let params = MatchParams::default();
        let scene = lab.recorded_scene(BODY, POINTS, &recorded, &equipment.calibrations(), params)?;
        Ok(matched(lab, &scene))
    };
    sweep(
        &Sweep {
            name: "noise, relative to the usual",
            axis: "noise of the picture, times the usual",
            file: "sweep-noise.svg",
            values: &[0.5, 1.0, 2.0, 3.0, 4.0],
        },
        &|factor| {
            pictured(Exposure {
                photons_per_px: usual.photons_per_px / (factor * factor),
                electronic_noise: usual.electronic_noise * factor,
                ..usual.clone()
            })
        },
    )?;
    sweep(
        &Sweep {
            name: "blur, px",
            axis: "detector blur, px (standard deviation)",
            file: "sweep-blur.svg",
            values: &[0.5, 1.0, 1.5, 2.0, 3.0],
        },
        &|px| pictured(Exposure { detector_blur_px: px, ..usual.clone() }),
    )?;
    let ideal = lab.outlines(BODY, &postures, &views);
    sweep(
        &Sweep {
            name: "missing share of view B's outline",
            axis: "missing share of one view's outline",
            file: "sweep-missing.svg",
            values: &[0.0, 0.2, 0.4, 0.6, 0.8],
        },
        &|share| {
            let missing = |c: &_, number| cut(c, share, &mut random(lab.seed, 31, number));
            let mut scene = from_outlines(lab, &views, disturbed(lab, &ideal, 30, missing))?;
            // Who cuts an outline short expects no more of it.
            scene.params.good_share = (0.75 * (1.0 - share)).min(0.75);
            scene.params.failed_share = scene.params.good_share / 2.0;
            Ok(matched(lab, &scene))
        },
    )?;
    sweep(
        &Sweep {
            name: "angle between the views, degrees",
            axis: "angle between the views, degrees",
            file: "sweep-angle.svg",
            values: &[90.0, 70.0, 50.0, 30.0, 15.0],
        },
        &|angle| {
            let views = biplane(angle);
            let ideal = lab.outlines(BODY, &postures, &views);
            let scene = from_outlines(lab, &views, disturbed(lab, &ideal, 32, |c, _| c.clone()))?;
            Ok(matched(lab, &scene))
        },
    )?;
    sweep(
        &Sweep {
            name: "calibration wrong by, mm",
            axis: "source and detector displaced, mm along each axis (standard deviation)",
            file: "sweep-calibration.svg",
            values: &[0.0, 0.1, 0.2, 0.5, 1.0],
        },
        &|mm| {
            let mut all = Vec::new();
            let frames = disturbed(lab, &ideal, 33, |c, _| c.clone());
            for (number, frame) in frames.into_iter().enumerate() {
                let mut chance = random(lab.seed, 34, number);
                let seen: Vec<_> = views.iter().map(|v| miscalibrated(v, mm, mm, &mut chance)).collect();
                all.extend(matched(lab, &from_outlines(lab, &seen, vec![frame])?));
            }
            Ok(all)
        },
    )?;
    Ok(Some(Section {
        title: "What makes it worse".to_owned(),
        text: vec![format!(
            "The femoral component in random poses, the default method, one start 6 mm and 6 degrees off, one thing varied. Noise \
             and blur: X-ray pictures. Missing outline (in one piece, of one view), angle and calibration: ideal outlines with \
             noise of {} px (correlation {} px). Where a part is missing, the limits of the verdict on the share found are lowered \
             by as much. Errors are those of matches called good.",
            NOISE_PX.0, NOISE_PX.1
        )],
        tables: vec![table],
        plots,
    }))
}
