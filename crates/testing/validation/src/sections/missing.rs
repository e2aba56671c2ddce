//! Noisy outlines of which one view misses a part, with edges that are not the body's: how near matches end, and whether those that fail say so.

use biplane_artifact::{Curves, Verdict};
use biplane_optimisation::{EdgeBias, MatchParams};
use biplane_phantom::{Body, biplane};
use rand::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::SectionError;
use crate::faults::{cluttered, cut, noisy, random};
use crate::goals::Goals;
use crate::lab::{Frames, calibrations, thesis_params};
use crate::many_outlines::frames;
use crate::outcome::{Method, Outcome, outcomes};
use crate::plot::{Panel, Series, lines};
use crate::scene::{Claim, Made, Origin};
use crate::{Cell, Column, Distribution, Lab, Row, Scene, Section, StartOffset, Table};

/// Noise of outlines: standard deviation and correlation length, px.
const NOISE_PX: (f64, f64) = (0.5, 3.0);
/// Shares of the second view's outline that are missing.
const MISSING: [f64; 5] = [0.0, 0.2, 0.4, 0.6, 0.8];
/// In how many pieces at most.
const PIECES: usize = 3;
/// Share of wrong edges among all of a view.
const WRONG: f64 = 0.1;
/// Goals: median and 95 %, mm and degrees.
const GOALS: [f64; 4] = [0.1, 0.2, 0.15, 0.4];
const BODIES: [(Body, &str); 3] = [
    (Body::FemoralComponent, "femoral component"),
    (Body::TibialTray, "tibial component"),
    (Body::DistalFemur, "femur"),
];
const POINTS: usize = 15_000;
const VERDICTS: [Verdict; 4] = [Verdict::Good, Verdict::Doubtful, Verdict::Ambiguous, Verdict::Failed];

/// Takes `share` of the points away, in one to three contiguous pieces.
fn cut_in_pieces(curves: &Curves, share: f64, chance: &mut Xoshiro256PlusPlus) -> Curves {
    let pieces = chance.random_range(1..=PIECES);
    let each = share / pieces as f64;
    (0..pieces).fold(curves.clone(), |left, taken| cut(&left, each / (1.0 - taken as f64 * each), chance))
}

/// The same frames with noise, clutter in every view, and `share` of the last view's outline missing.
fn disturbed(lab: &Lab, ideal: &Frames, share: f64) -> Frames {
    let disturb = |number: usize, curves: &[Curves]| -> Vec<Curves> {
        let mut chance = random(lab.seed, 60, number);
        let last = curves.len() - 1;
        let mut of = |(view, outline): (usize, &Curves)| {
            let moved = noisy(outline, NOISE_PX.0, NOISE_PX.1, &mut chance);
            let left = if view == last { cut_in_pieces(&moved, share, &mut chance) } else { moved };
            cluttered(&left, WRONG, &mut chance)
        };
        curves.iter().enumerate().map(&mut of).collect()
    };
    let frame = |(number, (label, pose, curves)): (usize, &(String, _, Vec<Curves>))| {
        (label.clone(), *pose, disturb(number, curves))
    };
    ideal.iter().enumerate().map(frame).collect()
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let views = biplane(90.0);
    let mut columns: Vec<Column> = vec![Column::at_least("right", 0)];
    let errors = ["mm, median", "95 %", "degrees, median", "95 %, degrees"];
    columns.extend(errors.iter().map(|name| Column::at_most(name, 3)));
    columns.push(Column::at_most("wrong, yet called good", 0));
    columns.extend([
        Column::at_least("good", 0),
        Column::at_most("doubtful", 0),
        Column::at_most("ambiguous", 0),
        Column::at_most("failed", 0),
    ]);
    let mut table = Table {
        id: "missing".to_owned(),
        heading: "missing of view B's outline, 15,000 points".to_owned(),
        columns,
        rows: Vec::new(),
    };
    let mut goals = Goals::default();
    let mut series: [Vec<Series>; 2] = Default::default();
    let poses = lab.count(400, 20);
    let near = StartOffset { translation_mm: 3.0, rotation_deg: 3.0, count: 1, seed: lab.seed };
    for (body, name) in BODIES {
        let ideal = frames(body, &views, lab.seed + 6, poses);
        let mesh = lab.workshop.surface(body, POINTS)?;
        let mut at_95: [Vec<(f64, f64)>; 2] = Default::default();
        for share in MISSING {
            // Who cuts an outline short expects no more of it.
            let good_share = 0.75 * (1.0 - share);
            let params = MatchParams {
                good_share,
                failed_share: good_share / 2.0,
                edge_bias: EdgeBias::None,
                ..MatchParams::default()
            };
            let made = Made { origin: Origin::Solid, claim: Claim::Accuracy, params };
            let frames = disturbed(lab, &ideal, share);
            let scene = Scene::made(made, &mesh, &calibrations(&views), frames)?;
            let draw = |truth: &_, centroid: &_, frame| near.draw(truth, centroid, frame);
            let all = outcomes(&scene, Method::Default, &thesis_params(), &draw);
            let mm = Distribution::of(all.iter().map(|o| o.error.translation_mm).collect());
            let deg = Distribution::of(all.iter().map(|o| o.error.rotation_rad.to_degrees()).collect());
            let right = all.iter().filter(|o| o.right()).count();
            let wrong_good = all.iter().filter(|o| o.counts && !o.right()).count();
            let label = format!("{name}, {:.0} %", 100.0 * share);
            for ((what, value, unit), goal) in [
                ("median", mm.median, "mm"),
                ("95 %", mm.p95, "mm"),
                ("median", deg.median, "degrees"),
                ("95 %", deg.p95, "degrees"),
            ]
            .into_iter()
            .zip(GOALS)
            {
                goals.at_most(&format!("{label} missing, {what}"), value, goal, unit);
            }
            goals.none(&format!("{label} missing, wrong yet called good"), wrong_good);
            for (line, p95) in at_95.iter_mut().zip([mm.p95, deg.p95]) {
                line.push((100.0 * share, p95));
            }
            let mut cells = vec![Cell::Share(right, all.len())];
            cells.extend([mm.median, mm.p95, deg.median, deg.p95].map(Cell::Number));
            cells.push(Cell::Number(wrong_good as f64));
            let said = |o: &Outcome, verdict| o.stated.as_ref().is_some_and(|s| s.verdict == verdict);
            let count = |verdict| all.iter().filter(|o| said(o, verdict)).count();
            cells.extend(VERDICTS.map(|v| Cell::Share(count(v), all.len())));
            table.rows.push(Row::ours(label, cells));
        }
        for (series, points) in series.iter_mut().zip(at_95) {
            series.push(Series { name: name.to_owned(), points });
        }
    }
    let [mm, deg] = series;
    let panel = |y: &str, series, limit| Panel {
        x: "missing of one view's outline, %".to_owned(),
        y: y.to_owned(),
        series,
        limit: Some(limit),
    };
    Ok(Some(Section {
        title: "Outlines with parts missing and edges that are not the body's".to_owned(),
        text: vec![
            format!(
                "`cargo xtask validate --only missing --seed {}`: {poses} random poses a body, one start 3 mm and 3 degrees off each. Ideal \
                 outlines with noise of {} px (correlation {} px), `edge_bias = \"none\"`; of view B's a share is missing, in one to {PIECES} contiguous pieces; \
                 {:.0} % of the edges of both views are wrong ones, stretches and arcs of 15 to 60 px about the outline in any direction. Limits \
                 of the verdict on the share found are lowered by as much as is missing. Errors are of **all** matches, whatever \
                 their verdict. Goals: median {} mm and {} degrees, 95 % {} mm and {} degrees, none wrong yet called good.",
                lab.seed,
                NOISE_PX.0,
                NOISE_PX.1,
                100.0 * WRONG,
                GOALS[0],
                GOALS[2],
                GOALS[1],
                GOALS[3]
            ),
            goals.text(),
        ],
        tables: vec![table],
        plots: vec![lines(
            "missing.svg",
            "Error at 95 % against the missing share of one view's outline; the limit is the goal",
            &[panel("position, mm", mm, GOALS[1]), panel("rotation, degrees", deg, GOALS[3])],
        )?],
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Curve, EdgePoint, Point2, Vector2};

    #[test]
    fn pieces_add_up_to_their_share() {
        let point = |k: u16| EdgePoint {
            position: Point2::new(f64::from(k), 0.0),
            direction: Vector2::y(),
            strength: 1.0,
            sigma_px: 0.1,
        };
        let whole = Curves(vec![Curve { points: (0..1000).map(point).collect(), closed: true }]);
        for draw in 0..20 {
            let left = cut_in_pieces(&whole, 0.6, &mut random(1, 2, draw));
            let points = left.0.iter().map(|c| c.points.len()).sum::<usize>();
            assert!(points.abs_diff(400) <= 2, "{points}");
        }
    }
}
