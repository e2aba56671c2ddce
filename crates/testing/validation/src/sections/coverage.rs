//! Coverage: how often the truth lies where the stated uncertainty says.

use biplane_optimisation::MatchParams;
use biplane_phantom::{Body, biplane};

use super::SectionError;
use crate::faults::{miscalibrated, noisy, random};
use crate::knee::Posture;
use crate::lab::{calibrations, thesis_params};
use crate::outcome::{Method, Outcome, outcomes};
use crate::plot::{Panel, Series, lines};
use crate::scene::{Claim, Made, Origin};
use crate::{Cell, Column, Lab, Row, Scene, Section, StartOffset, Table};

/// Noise of outlines: standard deviation and correlation length, px.
const NOISE_PX: (f64, f64) = (0.3, 20.0);
/// Errors of calibrations: source, detector, mm.
const WRONG_MM: (f64, f64) = (0.3, 0.1);
/// Standard deviations that hold 95 % of a normal number.
const NINETY_FIVE: f64 = 1.959_964;
/// Levels of the plot, and standard deviations that hold them.
const LEVELS: [(f64, f64); 6] =
    [(0.5, 0.67449), (0.6827, 1.0), (0.8, 1.28155), (0.9, 1.64485), (0.95, NINETY_FIVE), (0.99, 2.57583)];

/// Errors of the six, each over its stated standard deviation.
fn normalised(outcome: &Outcome) -> Option<[f64; 6]> {
    let covariance = &outcome.stated.as_ref()?.covariance;
    let (m, t) = (outcome.moved, outcome.turned);
    let error = [m.x, m.y, m.z, t.x, t.y, t.z];
    Some(std::array::from_fn(|i| error[i] / covariance[(i, i)].sqrt()))
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let views = biplane(90.0);
    let axes = ["x", "y", "z", "about x", "about y", "about z"];
    let mut columns: Vec<Column> =
        axes.iter().map(|a| Column::within(&format!("{a}, inside 95 %"), 3)).collect();
    columns.push(Column::within("squared error over covariance, mean (6 is right)", 2));
    columns.push(Column::at_least("good", 0));
    columns.push(Column::at_most("good, yet wrong", 0));
    let mut table = Table {
        id: "coverage".to_owned(),
        heading: "coverage, 15,000 points".to_owned(),
        columns,
        rows: Vec::new(),
    };
    let mut series = vec![Series {
        name: "right".to_owned(),
        points: LEVELS.iter().map(|l| (100.0 * l.0, 100.0 * l.0)).collect(),
    }];
    let postures: Vec<_> =
        (0..lab.count(50, 10)).map(|k| (k.to_string(), Posture::random(lab.seed + 1, k))).collect();
    for (body, name) in [(Body::FemoralComponent, "femoral component"), (Body::TibialTray, "tray")] {
        let ideal = lab.outlines(body, &postures, &views);
        for (wrong, what) in [(false, "noise"), (true, "noise and calibration")] {
            // A few calibrations say nothing of coverage.
            if wrong && !lab.full() {
                continue;
            }
            let mut all = Vec::new();
            for draw in 0..lab.count(6, 2) {
                let mut chance = random(lab.seed, u64::from(wrong) + 10, draw);
                let frames = ideal
                    .iter()
                    .map(|(label, pose, curves)| {
                        let curves =
                            curves.iter().map(|c| noisy(c, NOISE_PX.0, NOISE_PX.1, &mut chance)).collect();
                        (label.clone(), *pose, curves)
                    })
                    .collect();
                let (source, detector) = if wrong { WRONG_MM } else { (0.0, 0.0) };
                let seen: Vec<_> =
                    views.iter().map(|v| miscalibrated(v, source, detector, &mut chance)).collect();
                let made =
                    Made { origin: Origin::Solid, claim: Claim::Accuracy, params: MatchParams::default() };
                let mesh = lab.workshop.surface(body, 15_000)?;
                let scene = Scene::made(made, &mesh, &calibrations(&seen), frames)?;
                let near = StartOffset {
                    translation_mm: 3.0,
                    rotation_deg: 3.0,
                    count: 1,
                    seed: lab.seed + draw as u64,
                };
                let draw = |truth: &_, centroid: &_, frame| near.draw(truth, centroid, frame);
                all.extend(outcomes(&scene, Method::Default, &thesis_params(), &draw));
            }
            let scores: Vec<[f64; 6]> = all.iter().filter_map(normalised).collect();
            let inside = |i: usize, sigmas: f64| {
                scores.iter().filter(|s| s[i].abs() <= sigmas).count() as f64 / scores.len() as f64
            };
            let squared: Vec<f64> = all.iter().filter_map(Outcome::normalised_squared).collect();
            let good: Vec<&Outcome> = all.iter().filter(|o| o.counts).collect();
            let mut cells: Vec<Cell> = (0..6).map(|i| Cell::Number(inside(i, NINETY_FIVE))).collect();
            cells.push(Cell::Number(squared.iter().sum::<f64>() / squared.len() as f64));
            cells.push(Cell::Share(good.len(), all.len()));
            cells.push(Cell::Number(good.iter().filter(|o| !o.right()).count() as f64));
            let label = format!("{name}, {what}");
            series.push(Series {
                name: label.clone(),
                points: LEVELS
                    .iter()
                    .map(|l| (100.0 * l.0, 100.0 / 6.0 * (0..6).map(|i| inside(i, l.1)).sum::<f64>()))
                    .collect(),
            });
            table.rows.push(Row::ours(label, cells));
        }
    }
    let panel = Panel { x: "stated, %".to_owned(), y: "observed, %".to_owned(), series, limit: None };
    Ok(Some(Section {
        title: "Coverage of the stated uncertainty".to_owned(),
        text: vec![format!(
            "Ideal outlines with noise of {} px whose correlation falls to 1/e in {} px, random poses; then with calibrations that \
             are wrong too, by {} mm (source) and {} mm (detector) along each axis, drawn anew for every set of poses. All \
             verdicts count. Stated is what `match` gives: **it knows of residuals alone**, and takes them to be correlated over \
             150 px, so it says too much of noise and nothing of calibration; the goal is 93 to 97 % in every column.",
            NOISE_PX.0, NOISE_PX.1, WRONG_MM.0, WRONG_MM.1
        )],
        tables: vec![table],
        plots: vec![lines(
            "coverage.svg",
            "Coverage: share of truths inside the stated interval, mean over the six",
            &[panel],
        )?],
    }))
}
