//! Coverage: how often the truth lies where the stated uncertainty says.

use biplane_artifact::{CalibrationUncertainty, Curves, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Pose, Twist};
use biplane_optimisation::{EdgeBias, EdgeField, MatchParams, View, match_anywhere};
use biplane_outline::RimMesh;
use biplane_phantom::{Body, TrueFluoroscope, biplane};
use nalgebra::{Matrix6, Vector6};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;

use super::SectionError;
use crate::faults::{miscalibrated, noisy, normal_vector, random};
use crate::goals::Goals;
use crate::lab::calibrations;
use crate::many_outlines::frames;
use crate::plot::{Panel, Series, lines};
use crate::{Cell, Column, Lab, Row, Section, Table};

/// Noise of outlines: standard deviation and correlation length, px.
const NOISE_PX: (f64, f64) = (0.3, 20.0);
/// Errors of calibrations: source, detector, mm.
const WRONG_MM: (f64, f64) = (0.3, 0.1);
/// Starts: standard deviation along each axis, mm and degrees.
const START: (f64, f64) = (3.0, 3.0);
/// Standard deviations that hold 95 % of a normal number.
const NINETY_FIVE: f64 = 1.959_964;
/// Levels of the plot, and standard deviations that hold them.
const LEVELS: [(f64, f64); 6] =
    [(0.5, 0.67449), (0.6827, 1.0), (0.8, 1.28155), (0.9, 1.64485), (0.95, NINETY_FIVE), (0.99, 2.57583)];

/// A match's errors of the six (mm, rad), each over its stated standard deviation, and what else is said of it.
struct Scored {
    normalised: [f64; 6],
    squared: f64,
    good: bool,
    right: bool,
}

/// Matches the ideal outlines of `truth` with noise and, if `wrong`, with calibrations that are wrong: drawn anew from `chance`.
fn scored(
    rim: &RimMesh,
    truth: &Pose,
    ideal: &[Curves],
    views: &[TrueFluoroscope],
    wrong: bool,
    chance: &mut Xoshiro256PlusPlus,
) -> Option<Scored> {
    let (source, detector) = if wrong { WRONG_MM } else { (0.0, 0.0) };
    let curves: Vec<Curves> = ideal.iter().map(|c| noisy(c, NOISE_PX.0, NOISE_PX.1, chance)).collect();
    let seen: Vec<_> = views.iter().map(|v| miscalibrated(v, source, detector, chance)).collect();
    let calibrations = calibrations(&seen);
    let names: Vec<String> = calibrations.iter().map(|c| c.view.clone()).collect();
    let fluoroscopes = calibrations.iter().map(Fluoroscope::from);
    let matched: Vec<View> = fluoroscopes
        .zip(&curves)
        .map(|(fluoroscope, curves)| View { edges: EdgeField::new(curves, None), fluoroscope })
        .collect();
    let places: Vec<[f64; 3]> =
        seen.iter().map(|v| [(v.centre - v.source).norm(), source, detector]).collect();
    let uncertainty = wrong.then(|| CalibrationUncertainty::independent(&places));
    let centroid = rim.centroid();
    let off = Twist {
        translation: normal_vector(START.0, chance),
        rotation: normal_vector(f64::to_radians(START.1), chance),
    };
    let start = truth.moved(&off, &truth.transform(centroid));
    // Outlines that are ideal but for noise have no bias.
    let params = MatchParams { edge_bias: EdgeBias::None, ..MatchParams::default() };
    let of = (matched.as_slice(), names.as_slice());
    let found =
        match_anywhere(rim, of, uncertainty.as_ref(), Some(&start), Vec::new, &params, || false).ok()?;
    let pose = Pose::from(found.pose);
    let moved = pose.transform(centroid) - truth.transform(centroid);
    let turned = (pose.rotation() * truth.rotation().inverse()).scaled_axis();
    let error = Vector6::new(moved.x, moved.y, moved.z, turned.x, turned.y, turned.z);
    let covariance = Matrix6::from_fn(|i, j| found.covariance[i][j]);
    let away = pose.error_against(truth, centroid);
    Some(Scored {
        normalised: std::array::from_fn(|i| error[i] / covariance[(i, i)].sqrt()),
        squared: error.dot(&(covariance.try_inverse()? * error)),
        good: found.verdict == Verdict::Good,
        right: away.translation_mm < 1.0 && away.rotation_rad < 1_f64.to_radians(),
    })
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
    let mut goals = Goals::default();
    for (body, name) in [(Body::FemoralComponent, "femoral component"), (Body::TibialTray, "tray")] {
        let ideal = frames(body, &views, lab.seed + 1, lab.count(1000, 40));
        let rim = RimMesh::new(&*lab.workshop.surface(body, 15_000)?);
        for (wrong, what) in [(false, "noise"), (true, "noise and calibration")] {
            let all: Vec<Scored> = ideal
                .par_iter()
                .enumerate()
                .filter_map(|(number, (_, truth, curves))| {
                    let mut chance = random(lab.seed, u64::from(wrong) + 10, number);
                    scored(&rim, truth, curves, &views, wrong, &mut chance)
                })
                .collect();
            let inside = |i: usize, sigmas: f64| {
                all.iter().filter(|s| s.normalised[i].abs() <= sigmas).count() as f64 / all.len() as f64
            };
            let mut cells: Vec<Cell> = (0..6).map(|i| Cell::Number(inside(i, NINETY_FIVE))).collect();
            for (i, axis) in axes.iter().enumerate() {
                let share = 100.0 * inside(i, NINETY_FIVE);
                goals.between(&format!("{name}, {what}, {axis}"), share, (93.0, 97.0), "%");
            }
            let mean = all.iter().map(|s| s.squared).sum::<f64>() / all.len() as f64;
            goals.between(&format!("{name}, {what}, squared error over covariance"), mean, (5.0, 7.0), "");
            cells.push(Cell::Number(mean));
            let good = all.iter().filter(|s| s.good).count();
            cells.push(Cell::Share(good, ideal.len()));
            cells.push(Cell::Number(all.iter().filter(|s| s.good && !s.right).count() as f64));
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
        text: vec![
            format!(
                "Ideal outlines with noise of {} px whose correlation falls to 1/e in {} px, random poses, starts {} mm and {} degrees \
                 off along each axis; then with calibrations that are wrong too, by {} mm (source) and {} mm (detector) along each \
                 axis, drawn anew for every pose and told to the match as that uncertainty. All verdicts count. Goals: 93 to 97 % of \
                 truths inside the stated 95 % interval of each degree of freedom, a mean squared error over the covariance of 6.",
                NOISE_PX.0, NOISE_PX.1, START.0, START.1, WRONG_MM.0, WRONG_MM.1
            ),
            goals.text(),
        ],
        tables: vec![table],
        plots: vec![lines(
            "coverage.svg",
            "Coverage: share of truths inside the stated interval, mean over the six",
            &[panel],
        )?],
    }))
}
