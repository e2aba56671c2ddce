//! Studies that this program had no part in making: another simulator's pictures and outlines, and a real sequence.

use biplane_optimisation::BinghamParams;

use super::SectionError;
use crate::outcome::{Method, Outcome, outcomes};
use crate::plot::distributions;
use crate::summary::{cumulative_errors, distribution_columns, distribution_row};
use crate::{
    Cell, Column, Distribution, Lab, Row, STARTS, Scene, Section, StartOffset, Table, elsewhere, lab, set_a,
    turned,
};

/// A study and a body of it: name, pipeline file, body, reference.
pub(super) type Studied = (&'static str, &'static str, &'static str, &'static str);

/// gVirtualXray's.
pub(super) const SIMULATED: [Studied; 6] = [
    (
        "knee implant, femoral component",
        "pipeline.toml",
        "femoral_component",
        "fixtures/knee/truth/femoral_component_world_from_model.csv",
    ),
    ("knee implant, tray", "pipeline.toml", "tray", "fixtures/knee/truth/tray_world_from_model.csv"),
    (
        "natural knee, femur",
        "fixtures/knee-natural/meshes.toml",
        "femur",
        "fixtures/knee-natural/truth/femur_world_from_model.csv",
    ),
    (
        "natural knee, femur from MRI",
        "fixtures/knee-natural/pipeline.toml",
        "femur",
        "fixtures/knee-natural/truth/femur_world_from_model.csv",
    ),
    (
        "natural knee, tibia",
        "fixtures/knee-natural/meshes.toml",
        "tibia",
        "fixtures/knee-natural/truth/tibia_world_from_model.csv",
    ),
    (
        "natural knee, tibia from MRI",
        "fixtures/knee-natural/pipeline.toml",
        "tibia",
        "fixtures/knee-natural/truth/tibia_world_from_model.csv",
    ),
];

/// The real femur's reference, from the project's folder, and the pipeline files that count pixels either way.
const REAL_REFERENCE: &str = "../shared/data/real/knee-implant-biplane/reference_femur_world_from_model.csv";
pub(super) const REAL: [Studied; 2] = [
    (
        "real femur, pixel_origin = \"centre\"",
        "fixtures/real/knee-implant-biplane-centre.toml",
        "femur",
        REAL_REFERENCE,
    ),
    (
        "real femur, pixel_origin = \"corner\"",
        "fixtures/real/knee-implant-biplane-corner.toml",
        "femur",
        REAL_REFERENCE,
    ),
];

fn columns() -> Vec<Column> {
    let mut columns = distribution_columns();
    columns.extend([
        Column::at_most("residual, px, median", 3),
        Column::at_most("of the reference, px, median", 3),
        Column::at_most("squared error over stated covariance, mean", 1),
    ]);
    columns
}

fn table(id: &str, heading: &str) -> Table {
    Table { id: id.to_owned(), heading: heading.to_owned(), columns: columns(), rows: Vec::new() }
}

fn row(label: &str, all: &[Outcome]) -> Row {
    let mut row = distribution_row(label, all);
    let counted = || all.iter().filter(|o| o.counts);
    let median = |f: fn(&crate::outcome::Stated) -> f64| {
        Distribution::of(counted().filter_map(|o| o.stated.as_ref().map(f)).collect()).median
    };
    let squared: Vec<f64> = counted().filter_map(Outcome::normalised_squared).collect();
    row.cells.extend([
        Cell::Number(median(|s| s.residual_px)),
        Cell::Number(median(|s| s.truth_residual_px)),
        Cell::Number(squared.iter().sum::<f64>() / squared.len() as f64),
    ]);
    row
}

fn matched(lab: &Lab, studied: &Studied, count: usize) -> Result<Vec<Outcome>, SectionError> {
    let (_, pipeline, body, reference) = studied;
    let scene = Scene::load(&lab.root.join(pipeline), body, &lab.root.join(reference))?;
    let starts = StartOffset { count, seed: lab.seed, ..STARTS };
    let draw = |truth: &_, centroid: &_, frame| starts.draw(truth, centroid, frame);
    Ok(outcomes(&scene, Method::Default, &BinghamParams::default(), &draw))
}

/// Measures another simulator's data.
pub fn simulated(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let mut pictures = table("gvirtualxray", "gVirtualXray's pictures");
    let mut panels = [Vec::new(), Vec::new()];
    for studied in &SIMULATED {
        let all = matched(lab, studied, lab.count(20, 3))?;
        pictures.rows.push(row(studied.0, &all));
        for (panel, series) in panels.iter_mut().zip(cumulative_errors(studied.0, &all)) {
            panel.push(series);
        }
    }
    let mut outlines = table("outlines-made-elsewhere", "ideal outlines made elsewhere");
    for body in elsewhere::BODIES {
        for points in [3_500, 15_000] {
            let scene = elsewhere::scene(&lab.root, body, 36_000, points, &lab::ideal_params())?;
            let count = lab.count(50, 5);
            let draw = |truth: &_, centroid: &_, frame| set_a(truth, centroid, lab.seed, frame, count);
            let all = outcomes(&scene, Method::Default, &lab::thesis_params(), &draw);
            outlines.rows.push(row(&format!("{body}, {points} points"), &all));
        }
    }
    Ok(Some(Section {
        title: "Against another simulator".to_owned(),
        text: vec![
            "Nothing of this program had a part in these: pictures by gVirtualXray (`fixtures/knee`, the example study, and \
             `fixtures/knee-natural`), from finer meshes than the ones matched, distorted, blurred and noisy; bones *from MRI* are made by the \
             stages from the simulator's volumes, each from one seed; and ideal outlines \
             of a mesh of 36,000 points (`fixtures/scene`) with models of fewer. Fluoroscopes are calibrated by the stages \
             from the simulator's pictures of a plate and a frame of beads. Pictures: starts exactly 6 mm and 6 degrees off. \
             Outlines: starts as in Table 4.1."
                .to_owned(),
        ],
        tables: vec![pictures, outlines],
        plots: vec![distributions(
            "gvirtualxray.svg",
            "gVirtualXray's pictures: share of matches below an error",
            panels,
        )?],
    }))
}

/// Measures how starts from far away end: none may be called good where it is wrong.
pub fn far(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let mut table = Table {
        id: "turned".to_owned(),
        heading: "example study, starts turned by 45 to 180 degrees".to_owned(),
        columns: vec![Column::at_least("good", 0), Column::at_most("good, yet wrong", 0)],
        rows: Vec::new(),
    };
    for (name, pipeline, body, reference) in &SIMULATED[..2] {
        let mut scene = Scene::load(&lab.root.join(pipeline), body, &lab.root.join(reference))?;
        // Few of the twelve frames: these searches use up all their starts.
        let frames = std::mem::take(&mut scene.frames);
        scene.frames = frames.into_iter().step_by(lab.count(4, 12)).collect();
        let draw = |truth: &_, centroid: &_, _| turned(truth, centroid);
        let all = outcomes(&scene, Method::Default, &lab::thesis_params(), &draw);
        let good: Vec<&Outcome> = all.iter().filter(|o| o.counts).collect();
        table.rows.push(Row::ours(
            *name,
            vec![
                Cell::Share(good.len(), all.len()),
                Cell::Number(good.iter().filter(|o| !o.right()).count() as f64),
            ],
        ));
    }
    Ok(Some(Section {
        title: "Starts that cannot succeed".to_owned(),
        text: vec![
            "42 starts a frame, turned by 45, 90, 170 and 180 degrees about six axes: into the basins where a nearly symmetric \
             body fits almost as well. What counts is that no wrong pose is called good."
                .to_owned(),
        ],
        tables: vec![table],
        plots: Vec::new(),
    }))
}

/// Measures the real sequence, where its folder is present.
pub fn real(lab: &Lab) -> Result<Option<Section>, SectionError> {
    if !lab.root.join(REAL_REFERENCE).is_file() {
        return Ok(None);
    }
    let mut table = table("real", "real sequence, distance from somebody else's poses");
    for studied in &REAL[..lab.count(2, 1)] {
        table.rows.push(row(studied.0, &matched(lab, studied, lab.count(20, 2))?));
    }
    Ok(Some(Section {
        title: "A real sequence".to_owned(),
        text: vec![
            "Twenty pairs of in-vivo frames of a knee replacement, against poses that somebody else fitted: a reference and not \
             truth, which moves more than ours do ([real-knee.md](real-knee.md)). The data is not part of this project; where \
             it is missing this section is left out."
                .to_owned(),
        ],
        tables: vec![table],
        plots: Vec::new(),
    }))
}
