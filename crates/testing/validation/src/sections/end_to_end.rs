//! From raw pictures to poses, and the error budget of a pose.

use biplane_artifact::{Calibration, Curves};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::Vector2;
use biplane_optimisation::MatchParams;
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_phantom::{Body, Exposure, IntensifierDistortion, biplane};
use rayon::prelude::*;

use super::SectionError;
use crate::calibrated::of_equipment;
use crate::faults::random;
use crate::knee::Posture;
use crate::lab::{Frames, calibrations, thesis_params};
use crate::outcome::{Method, Outcome, outcomes, outline_curves};
use crate::pictures::{Equipment, Knee};
use crate::plot::{Dots, distributions, dots, strip};
use crate::scene::{Claim, Made, Origin};
use crate::setups::{bent, displaced};
use crate::summary::{cumulative_errors, distribution_columns, distribution_row};
use crate::{Distribution, Lab, STARTS, Scene, SceneError, Section, StartOffset, Table};

/// Points of the models, and of models whose own error shall not count.
const POINTS: usize = 15_000;
const FINE_POINTS: usize = 120_000;

/// Fluoroscopes as laboratories set them up, displaced and bent, a number of them drawn.
pub(super) fn equipment(lab: &Lab, number: usize) -> Equipment {
    let mut chance = random(lab.seed, 50, number);
    let views = displaced(&mut chance);
    let exposure = |distortion| Exposure { distortion: Some(distortion), ..Exposure::fluoroscopy() };
    Equipment { views: views.map(|view| (view.clone(), exposure(bent(view.size, &mut chance)))).into() }
}

/// Curves in ideal pixels as they are recorded.
fn recorded(curves: &Curves, distortion: &IntensifierDistortion) -> Curves {
    let mut curves = curves.clone();
    for point in curves.0.iter_mut().flat_map(|c| &mut c.points) {
        let tangent = Vector2::new(-point.direction.y, point.direction.x) * 0.01;
        let along = distortion.recorded(&(point.position + tangent))
            - distortion.recorded(&(point.position - tangent));
        point.direction = Vector2::new(along.y, -along.x).normalize();
        point.position = distortion.recorded(&point.position);
    }
    curves
}

fn matched(lab: &Lab, scene: &Scene, starts: usize) -> Vec<Outcome> {
    let starts = StartOffset { count: starts, seed: lab.seed, ..STARTS };
    let draw = |truth: &_, centroid: &_, frame| starts.draw(truth, centroid, frame);
    outcomes(scene, Method::Default, &thesis_params(), &draw)
}

fn table(id: &str, heading: &str) -> Table {
    Table {
        id: id.to_owned(),
        heading: heading.to_owned(),
        columns: distribution_columns(),
        rows: Vec::new(),
    }
}

/// Measures raw pictures to poses.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let mut table = table("end-to-end", "from raw pictures, 15,000 points");
    let mut panels = [Vec::new(), Vec::new()];
    let (mut counts, mut shown) = (Vec::new(), Vec::new());
    let knees = [
        (Knee::Implants, lab.count(10, 2), lab.count(20, 3)),
        (Knee::Natural, lab.count(5, 1), lab.count(12, 3)),
    ];
    for (knee, setups, frames) in knees {
        counts.push(setups * frames);
        let mut found: [Vec<Outcome>; 2] = Default::default();
        for setup in 0..setups {
            let equipment = equipment(lab, setup);
            let calibrations = of_equipment(lab, &equipment, 100 * knee as usize + setup)?;
            let postures: Vec<_> = (0..frames)
                .map(|k| (format!("{setup}/{k}"), Posture::random(lab.seed + 3, setup * frames + k)))
                .collect();
            let recorded = lab.record(knee, &postures, &equipment)?;
            if setup == 0 {
                shown.extend(recorded[0].frames.iter().cloned());
            }
            for (all, body) in found.iter_mut().zip(knee.bodies()) {
                let params = MatchParams::default();
                let scene = lab.recorded_scene(body, POINTS, &recorded, &calibrations, params)?;
                all.extend(matched(lab, &scene, 1));
            }
        }
        for (all, body) in found.iter().zip(knee.bodies()) {
            let name = body.name().replace('-', " ");
            table.rows.push(distribution_row(&name, all));
            for (panel, series) in panels.iter_mut().zip(cumulative_errors(&name, all)) {
                panel.push(series);
            }
        }
    }
    Ok(Some(Section {
        title: "End to end, as far as stages reach".to_owned(),
        text: vec![
            format!(
                "Raw X-ray pictures of the phantom: distorted (pincushion 6 to 12 px, S up to 12 px at the rim), blurred, scattered, \
                 noisy, 8 bit, with a round border; {} frame pairs with implants and {} of a natural knee, in random poses, each \
                 setup of fluoroscopes drawn anew. One start a body, 6 mm and 6 degrees off. Errors are those of matches called \
                 good.",
                counts[0], counts[1]
            ),
            "Each setup is calibrated from its own raw pictures, a plate before each intensifier and a frame of 30 beads in 100 mm, \
             by the stages with their defaults; the lists of holes and beads are exact, as no laboratory's are. **Not from MRI:** models are meshes of the analytic surfaces; \
             gVirtualXray's natural knee has them from MRI. The goal for the whole way: femoral component 0.05 mm and 0.08 degrees in the median, 0.12 mm and 0.2 degrees \
             at 95 %; tray 0.08 mm and 0.15 degrees, bones from MRI 0.2 mm and 0.3 degrees in the median."
                .to_owned(),
        ],
        tables: vec![table],
        plots: vec![
            strip(
                "phantom.png",
                "Raw pictures of the phantom: implants in views A and B, a natural knee in views A and B (square root of the grey level)",
                &shown.iter().collect::<Vec<_>>(),
            )?,
            distributions(
            "end-to-end.svg",
            "Raw pictures: share of matches below an error",
            panels,
        )?,
        ],
    }))
}

/// Measures the error budget: each source alone, the others switched off.
pub fn budget(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let mut table = table("error-budget", "source of error, alone");
    let (mut plotted_mm, mut plotted_deg): (Vec<Dots>, Vec<Dots>) = (Vec::new(), Vec::new());
    let views = biplane(90.0);
    let count = lab.count(30, 4);
    let postures: Vec<_> = (0..count).map(|k| (k.to_string(), Posture::random(lab.seed + 4, k))).collect();
    let mut chance = random(lab.seed, 60, 0);
    let distortions = views.each_ref().map(|v| bent(v.size, &mut chance));
    let noiseless = Exposure {
        photons_per_px: f64::INFINITY,
        electronic_noise: 0.0,
        bits: 16,
        ..Exposure::fluoroscopy()
    };
    let bodies = [(Body::FemoralComponent, "femoral component"), (Body::TibialTray, "tray")];
    let pictures = [
        ("edges of pictures without noise", Equipment::new(&views, &noiseless)),
        ("edges of pictures with noise", Equipment::new(&views, &Exposure::fluoroscopy())),
    ];
    let mut seen = Vec::new();
    for (name, equipment) in &pictures {
        seen.push((*name, lab.record(Knee::Implants, &postures, equipment)?));
    }
    let together = Equipment {
        views: views
            .iter()
            .zip(distortions)
            .map(|(v, d)| (v.clone(), Exposure { distortion: Some(d), ..Exposure::fluoroscopy() }))
            .collect(),
    };
    let all_seen = lab.record(Knee::Implants, &postures, &together)?;
    // Each pose with a calibration of its own, from other pictures of plates and beads.
    let straight = Equipment::new(&views, &Exposure::fluoroscopy());
    let found = |equipment: &Equipment, first: usize| -> Result<Vec<_>, SceneError> {
        (0..count).into_par_iter().map(|number| of_equipment(lab, equipment, first + number)).collect()
    };
    let (by_beads, by_both) = (found(&straight, 1_000)?, found(&together, 2_000)?);
    for (body, body_name) in bodies {
        let mut rows: Vec<(String, Vec<Outcome>)> = Vec::new();
        let fine = lab.workshop.surface(body, FINE_POINTS)?;
        let coarse = lab.workshop.surface(body, POINTS)?;
        let ideal = lab.outlines(body, &postures, &views);
        let exact = calibrations(&views);
        let claims = |claim, origin| Made { origin, claim, params: MatchParams::default() };
        let accuracy = || claims(Claim::Accuracy, Origin::Solid);

        // The search: outlines that the product draws of the very mesh it matches.
        let (rim, mut outline) = (RimMesh::new(&coarse), Outline::new());
        let own: Frames = postures
            .iter()
            .map(|(label, posture)| {
                let pose = posture.pose(body);
                let mut drawn = |c: &Calibration| {
                    outline.trace(&rim, &pose, &Fluoroscope::from(c), Sampling { step_px: 0.25 });
                    outline_curves(&outline)
                };
                (label.clone(), pose, exact.iter().map(&mut drawn).collect())
            })
            .collect();
        let made = claims(Claim::SearchAlone, Origin::mesh(&coarse));
        let scene = Scene::made(made, &coarse, &exact, own)?;
        rows.push(("optimisation".to_owned(), matched(lab, &scene, 1)));

        let scene = Scene::made(accuracy(), &coarse, &exact, ideal.clone())?;
        rows.push((format!("mesh of {POINTS} points"), matched(lab, &scene, 1)));

        let mut from_beads = Vec::new();
        for (frame, found) in ideal.iter().zip(&by_beads) {
            let scene = Scene::made(accuracy(), &fine, found, vec![frame.clone()])?;
            from_beads.extend(matched(lab, &scene, 1));
        }
        rows.push(("calibration".to_owned(), from_beads));

        let mut from_both = Vec::new();
        for ((label, pose, curves), found) in ideal.iter().zip(&by_both) {
            let curves = curves.iter().zip(&distortions).map(|(c, d)| recorded(c, d)).collect();
            let scene = Scene::made(accuracy(), &fine, found, vec![(label.clone(), *pose, curves)])?;
            from_both.extend(matched(lab, &scene, 1));
        }
        rows.push(("calibration and distortion".to_owned(), from_both));

        for (name, recorded) in &seen {
            let scene = lab.recorded_scene(body, FINE_POINTS, recorded, &exact, MatchParams::default())?;
            rows.push(((*name).to_owned(), matched(lab, &scene, 1)));
        }

        let mut all = Vec::new();
        for (one, found) in all_seen.iter().zip(&by_both) {
            let params = MatchParams::default();
            let scene = lab.recorded_scene(body, POINTS, std::slice::from_ref(one), found, params)?;
            all.extend(matched(lab, &scene, 1));
        }
        rows.push(("all together".to_owned(), all));

        for (index, (source, all)) in rows.into_iter().enumerate() {
            table.rows.push(distribution_row(&format!("{body_name}: {source}"), &all));
            let median = |f: fn(&Outcome) -> f64| {
                Distribution::of(all.iter().filter(|o| o.counts).map(f).collect()).median
            };
            let values = [median(|o| o.error.translation_mm), median(|o| o.error.rotation_rad.to_degrees())];
            for (plotted, value) in [&mut plotted_mm, &mut plotted_deg].into_iter().zip(values) {
                match plotted.get_mut(index) {
                    Some(dots) => dots.values.push(Some(value)),
                    None => plotted.push(Dots { label: source.clone(), values: vec![Some(value)] }),
                }
            }
        }
    }
    let series = ["femoral component", "tray"];
    Ok(Some(Section {
        title: "Error budget of a pose".to_owned(),
        text: vec![format!(
            "Each source alone, in the same {count} random poses with implants, the others switched off: *optimisation*, \
                 outlines of the very mesh that is matched (which claims no accuracy); *mesh*, ideal outlines of the analytic \
                 surface; *calibration* and *calibration and distortion*, ideal outlines, the second bent, and a mesh of \
                 {FINE_POINTS} points, so fine that its error does not count; *edges*, pictures and that mesh. Calibrations are the \
                 stages' own, for each pose from other pictures of a frame of 30 beads in 100 mm and, where pictures are bent, of a \
                 plate before each intensifier. Errors are those of matches called good."
        )],
        tables: vec![table],
        plots: vec![
            dots("budget-position.svg", "Error budget, median of the position", "mm", &series, &plotted_mm)?,
            dots(
                "budget-rotation.svg",
                "Error budget, median of the rotation",
                "degrees",
                &series,
                &plotted_deg,
            )?,
        ],
    }))
}
