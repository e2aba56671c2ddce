//! From raw pictures to poses, and the error budget of a pose.

use biplane_artifact::{Calibration, Curves};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::Vector2;
use biplane_optimisation::MatchParams;
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_phantom::{Body, Exposure, IntensifierDistortion, TrueFluoroscope, biplane};
use rand::Rng;

use super::SectionError;
use crate::faults::{miscalibrated, normal, normal_vector, random};
use crate::knee::Posture;
use crate::lab::{Frames, calibrations, thesis_params};
use crate::outcome::{Method, Outcome, outcomes, outline_curves};
use crate::pictures::{Equipment, Knee};
use crate::plot::{Dots, distributions, dots, strip};
use crate::scene::{Claim, Made, Origin};
use crate::summary::{cumulative_errors, distribution_columns, distribution_row};
use crate::{Distribution, Lab, STARTS, Scene, Section, StartOffset, Table};

/// Points of the models, and of models whose own error shall not count.
const POINTS: usize = 15_000;
const FINE_POINTS: usize = 120_000;
/// What calibration and distortion correction are taken to leave, until stages do them: mm of source and detector along
/// each axis, px root mean square over the picture.
const LEFT_MM: (f64, f64) = (0.2, 0.05);
const LEFT_PX: f64 = 0.05;

/// Fluoroscopes as laboratories set them up: an angle of 75 to 105 degrees, displaced and bent, a number of them drawn.
fn equipment(lab: &Lab, number: usize) -> Equipment {
    let mut chance = random(lab.seed, 50, number);
    let views = biplane(chance.random_range(75.0..105.0));
    let drawn = views.map(|view| {
        let moved = TrueFluoroscope {
            source: view.source + normal_vector(15.0, &mut chance),
            centre: view.centre + normal_vector(8.0, &mut chance),
            ..view
        };
        (bent(&moved, &mut chance), moved)
    });
    let exposure = |distortion| Exposure { distortion: Some(distortion), ..Exposure::fluoroscopy() };
    Equipment { views: drawn.into_iter().map(|(d, view)| (view, exposure(d))).collect() }
}

/// Pincushion of 6 to 12 px and an S of up to 10 px at the rim.
fn bent(view: &TrueFluoroscope, chance: &mut impl Rng) -> IntensifierDistortion {
    IntensifierDistortion {
        pincushion_px: chance.random_range(6.0..12.0),
        s_shape_px: chance.random_range(-10.0..10.0),
        shift_px: Vector2::new(chance.random_range(-2.0..2.0), chance.random_range(-2.0..2.0)),
        ..IntensifierDistortion::none(view.size)
    }
}

/// A calibration with its correction of distortion off by a smooth field of [`LEFT_PX`]: a polynomial of third degree.
fn corrected_wrongly(
    mut calibration: Calibration,
    chance: &mut rand_xoshiro::Xoshiro256PlusPlus,
) -> Calibration {
    let size = calibration.size;
    let terms: Vec<[f64; 2]> = (0..10).map(|_| [normal(chance), normal(chance)]).collect();
    if let Some(table) = &mut calibration.distortion {
        let field: Vec<[f64; 2]> = (0..table.ideal_px.len())
            .map(|k| {
                let at = [k % table.count[0], k / table.count[0]];
                let [x, y]: [f64; 2] = std::array::from_fn(|i| {
                    (table.first_px[i] + at[i] as f64 * table.step_px[i]) / (size[i] as f64 / 2.0) - 1.0
                });
                let powers = [1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y];
                std::array::from_fn(|i| powers.iter().zip(&terms).map(|(p, t)| p * t[i]).sum())
            })
            .collect();
        let squares: f64 = field.iter().flatten().map(|v| v * v).sum();
        let scale = LEFT_PX / (squares / field.len() as f64).sqrt();
        for (ideal, off) in table.ideal_px.iter_mut().zip(field) {
            *ideal = [ideal[0] + scale * off[0], ideal[1] + scale * off[1]];
        }
    }
    calibration
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
            let postures: Vec<_> = (0..frames)
                .map(|k| (format!("{setup}/{k}"), Posture::random(lab.seed + 3, setup * frames + k)))
                .collect();
            let recorded = lab.record(knee, &postures, &equipment)?;
            if setup == 0 {
                shown.extend(recorded[0].frames.iter().cloned());
            }
            for (all, body) in found.iter_mut().zip(knee.bodies()) {
                let params = MatchParams::default();
                let scene = lab.recorded_scene(body, POINTS, &recorded, &equipment.calibrations(), params)?;
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
                "Raw X-ray pictures of the phantom: distorted (pincushion 6 to 12 px, S up to 10 px at the rim), blurred, scattered, \
                 noisy, 8 bit, with a round border; {} frame pairs with implants and {} of a natural knee, in random poses, each \
                 setup of fluoroscopes drawn anew. One start a body, 6 mm and 6 degrees off. Errors are those of matches called \
                 good.",
                counts[0], counts[1]
            ),
            "**Not yet end to end:** no stage finds calibration and distortion from pictures, so both are the phantom's own, and \
             models are meshes of the analytic surfaces and not from MRI. The goal for the whole way: femoral component 0.05 mm \
             and 0.08 degrees in the median, 0.12 mm and 0.2 degrees at 95 %; tray 0.08 mm and 0.15 degrees, bones from MRI \
             0.2 mm and 0.3 degrees in the median."
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
    let distortions = views.each_ref().map(|v| bent(v, &mut chance));
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

        let mut wrong = Vec::new();
        for (number, frame) in ideal.iter().enumerate() {
            let mut chance = random(lab.seed, 61, number);
            let seen: Vec<_> =
                views.iter().map(|v| miscalibrated(v, LEFT_MM.0, LEFT_MM.1, &mut chance)).collect();
            let scene = Scene::made(accuracy(), &fine, &calibrations(&seen), vec![frame.clone()])?;
            wrong.extend(matched(lab, &scene, 1));
        }
        rows.push(("calibration (taken to be)".to_owned(), wrong));

        let mut wrong = Vec::new();
        for (number, (label, pose, curves)) in ideal.iter().enumerate() {
            let mut chance = random(lab.seed, 62, number);
            let curves = curves.iter().zip(&distortions).map(|(c, d)| recorded(c, d)).collect();
            let calibrations: Vec<_> =
                together.calibrations().into_iter().map(|c| corrected_wrongly(c, &mut chance)).collect();
            let frame = vec![(label.clone(), *pose, curves)];
            let scene = Scene::made(accuracy(), &fine, &calibrations, frame)?;
            wrong.extend(matched(lab, &scene, 1));
        }
        rows.push(("distortion (taken to be)".to_owned(), wrong));

        for (name, recorded) in &seen {
            let scene = lab.recorded_scene(body, FINE_POINTS, recorded, &exact, MatchParams::default())?;
            rows.push(((*name).to_owned(), matched(lab, &scene, 1)));
        }

        let mut wrong = Vec::new();
        for (number, one) in all_seen.iter().enumerate() {
            let mut chance = random(lab.seed, 61, number);
            let calibrations: Vec<_> = together
                .views
                .iter()
                .zip(together.calibrations())
                .map(|((view, _), calibration)| {
                    let off =
                        miscalibrated(view, LEFT_MM.0, LEFT_MM.1, &mut chance).calibration(&calibration.view);
                    Calibration { distortion: calibration.distortion, ..off }
                })
                .collect();
            let mut chance = random(lab.seed, 62, number);
            let calibrations: Vec<_> =
                calibrations.into_iter().map(|c| corrected_wrongly(c, &mut chance)).collect();
            let params = MatchParams::default();
            let scene = lab.recorded_scene(body, POINTS, std::slice::from_ref(one), &calibrations, params)?;
            wrong.extend(matched(lab, &scene, 1));
        }
        rows.push(("all together".to_owned(), wrong));

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
                 surface; *calibration* and *distortion*, ideal outlines and a mesh of {FINE_POINTS} points, so fine that its error \
                 does not count; *edges*, pictures and that mesh. No stage calibrates yet, so what calibration leaves is taken to \
                 be {} mm of the source and {} mm of the detector along each axis, and what correction of distortion leaves {} px \
                 root mean square, a smooth field. Errors are those of matches called good.",
            LEFT_MM.0, LEFT_MM.1, LEFT_PX
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
