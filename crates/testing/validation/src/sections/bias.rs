//! The bias of X-ray edges at smooth rims: with and without it in the pose.

use biplane_geometry::Vector3;
use biplane_optimisation::{EdgeBias, MatchParams};
use biplane_phantom::{Exposure, biplane};

use super::SectionError;
use crate::goals::Goals;
use crate::knee::Posture;
use crate::lab::{calibrations, thesis_params};
use crate::outcome::{Method, Outcome, outcomes};
use crate::pictures::{Equipment, Knee};
use crate::plot::{Dots, dots};
use crate::{Cell, Column, Distribution, Lab, Row, STARTS, Section, StartOffset, Table};

/// Points of the models, and of models whose own error shall not count.
const POINTS: usize = 15_000;
const FINE_POINTS: usize = 120_000;
/// What is aimed at: mm and degrees that are left.
const GOAL: (f64, f64) = (0.01, 0.02);

const WAYS: [(EdgeBias, &str); 3] =
    [(EdgeBias::None, "none"), (EdgeBias::Constant, "constant"), (EdgeBias::Predicted, "predicted")];

fn columns() -> Vec<Column> {
    ["mm, median", "95 %", "common, mm", "degrees, median", "95 %, degrees", "common, degrees"]
        .iter()
        .map(|name| Column::at_most(name, 4))
        .chain([Column::at_least("good", 0)])
        .collect()
}

/// Length of the mean of what all poses are off by, along the body's own axes.
fn common(outcomes: &[&Outcome], off: fn(&Outcome) -> Vector3) -> f64 {
    let sum: Vector3 = outcomes.iter().map(|o| o.pose.rotation().inverse() * off(o)).sum();
    sum.norm() / outcomes.len().max(1) as f64
}

/// Median and 95 % of position and rotation, and what all poses have in common of them.
fn figures(outcomes: &[Outcome]) -> [f64; 6] {
    let right: Vec<&Outcome> = outcomes.iter().filter(|o| o.right()).collect();
    let degrees = 1_f64.to_degrees();
    let mm = Distribution::of(right.iter().map(|o| o.error.translation_mm).collect());
    let deg = Distribution::of(right.iter().map(|o| o.error.rotation_rad * degrees).collect());
    let (moved, turned) = (common(&right, |o| o.moved), common(&right, |o| o.turned) * degrees);
    [mm.median, mm.p95, moved, deg.median, deg.p95, turned]
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let views = biplane(90.0);
    let count = lab.count(20, 5);
    let postures: Vec<_> = (0..count).map(|k| (k.to_string(), Posture::random(lab.seed + 7, k))).collect();
    let noiseless = Exposure {
        photons_per_px: f64::INFINITY,
        electronic_noise: 0.0,
        bits: 16,
        ..Exposure::fluoroscopy()
    };
    let kinds = [
        ("bias", "pictures without noise, fine models", noiseless, FINE_POINTS),
        ("bias-noise", "pictures with noise, 15,000 points", Exposure::fluoroscopy(), POINTS),
    ];
    let mut goals = Goals::default();
    let (mut tables, mut plotted) = (Vec::new(), [Vec::new(), Vec::new()]);
    for (id, heading, exposure, points) in kinds {
        let equipment = Equipment::new(&views, &exposure);
        let mut rows = Vec::new();
        for knee in [Knee::Implants, Knee::Natural] {
            let recorded = lab.record(knee, &postures, &equipment)?;
            for body in knee.bodies() {
                let name = body.name().replace('-', " ");
                let mut shown = [Vec::new(), Vec::new()];
                for (edge_bias, way) in WAYS {
                    let params = MatchParams { edge_bias, ..MatchParams::default() };
                    let scene = lab.recorded_scene(body, points, &recorded, &calibrations(&views), params)?;
                    let starts = StartOffset { count: 1, seed: lab.seed, ..STARTS };
                    let draw = |truth: &_, centroid: &_, frame| starts.draw(truth, centroid, frame);
                    let found = outcomes(&scene, Method::Default, &thesis_params(), &draw);
                    let figures = figures(&found);
                    if edge_bias == EdgeBias::Predicted {
                        goals.at_most(&format!("{name}, {heading}, common"), figures[2], GOAL.0, "mm");
                        goals.at_most(&format!("{name}, {heading}, common"), figures[5], GOAL.1, "degrees");
                        if points == FINE_POINTS {
                            goals.at_most(&format!("{name}, median"), figures[0], GOAL.0, "mm");
                            goals.at_most(&format!("{name}, median"), figures[3], GOAL.1, "degrees");
                        }
                    }
                    shown[0].push(Some(figures[0]));
                    shown[1].push(Some(figures[3]));
                    let good = found.iter().filter(|o| o.counts).count();
                    let mut cells: Vec<Cell> = figures.map(Cell::Number).into();
                    cells.push(Cell::Share(good, found.len()));
                    rows.push(Row::ours(format!("{name}, {way}"), cells));
                }
                if points == FINE_POINTS {
                    for (plotted, values) in plotted.iter_mut().zip(shown) {
                        plotted.push(Dots { label: name.clone(), values });
                    }
                }
            }
        }
        tables.push(Table { id: id.to_owned(), heading: heading.to_owned(), columns: columns(), rows });
    }
    let ways = WAYS.map(|w| w.1);
    let [mm, degrees] = plotted;
    Ok(Some(Section {
        title: "The bias of edges at smooth rims".to_owned(),
        text: vec![
            format!(
                "The same pictures of the phantom, {count} random poses of each knee, matched with `edge_bias = \"none\"`, with one inset a view \
                 (`\"constant\"`), and with the inset of each rim predicted from the body's chords behind it (`\"predicted\"`, the default). Nothing is \
                 said of what bodies are made of or of how sharp pictures are: both are found from the edges. Without noise, and with \
                 models of {FINE_POINTS} points, what is left is bias; *common* is the length of its mean along the body's axes. One start a \
                 body, 6 mm and 6 degrees off; errors are those of all poses within 1 mm and 1 degree."
            ),
            format!("Aimed at: below {} mm and {} degrees of bias. {}", GOAL.0, GOAL.1, goals.text()),
        ],
        tables,
        plots: vec![
            dots("bias-position.svg", "Bias of the position without noise, median", "mm", &ways, &mm)?,
            dots(
                "bias-rotation.svg",
                "Bias of the rotation without noise, median",
                "degrees",
                &ways,
                &degrees,
            )?,
        ],
    }))
}
