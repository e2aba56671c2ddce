//! One view: errors in its plane and in depth, beside the least that any unbiased method can have from the same noisy outline.
//!
//! **Bound.** Each outline point is moved along its normal by independent noise of standard deviation `sigma`, so the information of an
//! outline is `sum(j j') / sigma^2` with `j` the derivative of the contour's place along its normal by the six of the pose, and its
//! inverse the least covariance (Cramer and Rao). `j` is taken from the analytic outlines, by central differences. Where an inset of
//! the whole outline is solved for, it is a seventh unknown with `j = 1`, known beforehand to the deviation that the method assumes.

use biplane_artifact::{Curves, Verdict};
use biplane_geometry::{EdgePoint, Point3, Pose, Twist, Vector3};
use biplane_optimisation::MatchParams;
use biplane_phantom::{Body, TrueFluoroscope, biplane, ideal_outline};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use super::SectionError;
use crate::faults::{noisy, random};
use crate::goals::Goals;
use crate::knee::Posture;
use crate::lab::{Frames, calibrations, thesis_params};
use crate::outcome::{Method, Outcome, by_plane, outcomes};
use crate::scene::{Claim, Made, Origin};
use crate::true_outline::TrueOutline;
use crate::{Cell, Column, Distribution, Lab, Row, Scene, Section, Spread, StartOffset, Table};

/// Noise of each outline point, px: independent, the points 1 px apart.
const NOISE_PX: f64 = 0.3;
const STEP_PX: f64 = 1.0;
/// Steps of the differences, mm and rad, and the distance of the points of the outlines that they are taken from, px.
const DIFFERENCE: (f64, f64) = (0.1, 1.5e-3);
const FINE_PX: f64 = 0.25;
/// How far an outline that is moved by such a step is looked for, px.
const REACH_PX: f64 = 2.0;
/// In a basin that is not the truth's: in plane beyond this, mm, or turned by more than this, degrees.
const ELSEWHERE: (f64, f64) = (1.0, 3.0);
/// Goal for the length of the error in plane at 95 %, mm.
const IN_PLANE_MM: f64 = 0.1;
const BODIES: [(Body, &str); 3] = [
    (Body::FemoralComponent, "femoral component"),
    (Body::TibialTray, "tibial component"),
    (Body::DistalFemur, "femur"),
];
const POINTS: usize = 15_000;

/// Least covariance: displacement along the view's x, y and normal (mm), rotation about them (rad), and the inset (px).
type Bound = SMatrix<f64, 7, 7>;

/// The bound at a pose, from `points` of its outline; `prior_px` of the inset, 0 where it is held. `None` where the outline does not
/// determine the pose.
fn bound(
    body: Body,
    pose: &Pose,
    centroid: &Point3,
    view: &TrueFluoroscope,
    points: &[EdgePoint],
    prior_px: f64,
) -> Option<Bound> {
    let centre = pose.transform(centroid);
    let axes = [view.along_x, view.along_y, view.normal()];
    let mut rows = vec![Some(SVector::<f64, 7>::repeat(1.0)); points.len()];
    for k in 0..6 {
        let step = if k < 3 { DIFFERENCE.0 } else { DIFFERENCE.1 };
        let [ahead, behind] = [step, -step].map(|step| {
            let by = |own: bool| if own { axes[k % 3] * step } else { Vector3::zeros() };
            let moved = pose.moved(&Twist { translation: by(k < 3), rotation: by(k >= 3) }, &centre);
            TrueOutline::new(ideal_outline(body.solid(), &moved, view, FINE_PX))
        });
        for (row, point) in rows.iter_mut().zip(points) {
            let outside = |outline: &TrueOutline| outline.outside_px(&point.position, REACH_PX);
            *row = row.and_then(|mut row| {
                row[k] = (outside(&behind)? - outside(&ahead)?) / (2.0 * step);
                Some(row)
            });
        }
    }
    let mut information = Bound::zeros();
    for row in rows.iter().flatten() {
        information += row * row.transpose() / (NOISE_PX * NOISE_PX);
    }
    // An inset that is held is known without limit.
    information[(6, 6)] += 1.0 / prior_px.max(1e-6).powi(2);
    // Millimetres, radians and pixels: balanced first, lest the inverse lose its digits.
    let scale = Bound::from_diagonal(&information.diagonal().map(|v| 1.0 / v.sqrt()));
    Some(scale * (scale * information * scale).try_inverse()? * scale)
}

/// Root mean square over poses of the bound's deviations, in the order of [`by_plane`]: an axis in plane, depth (mm), about the view's
/// axis, about an axis across it (degrees).
fn deviations(bounds: &[Bound]) -> [f64; 4] {
    let mean =
        |of: &dyn Fn(&Bound) -> f64| (bounds.iter().map(of).sum::<f64>() / bounds.len().max(1) as f64).sqrt();
    [
        mean(&|c| (c[(0, 0)] + c[(1, 1)]) / 2.0),
        mean(&|c| c[(2, 2)]),
        mean(&|c| c[(5, 5)]).to_degrees(),
        mean(&|c| (c[(3, 3)] + c[(4, 4)]) / 2.0).to_degrees(),
    ]
}

fn in_plane_mm(outcome: &Outcome, view: &TrueFluoroscope) -> f64 {
    outcome.moved.dot(&view.along_x).hypot(outcome.moved.dot(&view.along_y))
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let [view, _] = biplane(90.0);
    let names = ["in plane, mm an axis", "depth, mm", "about the view's axis, °", "about axes across it, °"];
    let mut columns: Vec<Column> =
        names.iter().flat_map(|name| [Column::at_most(name, 4), Column::at_most("its bound", 4)]).collect();
    columns.extend([
        Column::at_most("depth over its bound", 2),
        Column::at_most("in plane, mm, 95 %", 4),
        Column::at_most("elsewhere", 0),
        Column::at_most("of these called good", 0),
    ]);
    let mut table = Table {
        id: "one-view".to_owned(),
        heading: "one view, 15,000 points; root mean squares".to_owned(),
        columns,
        rows: Vec::new(),
    };
    let mut goals = Goals::default();
    let poses = lab.count(100, 10);
    let near = StartOffset { translation_mm: 3.0, rotation_deg: 3.0, count: 1, seed: lab.seed };
    for (body, name) in BODIES {
        let mesh = lab.workshop.surface(body, POINTS)?;
        let centroid = mesh.area_centroid();
        let posed: Vec<(Pose, Curves)> = (0..poses)
            .into_par_iter()
            .map(|k| {
                let pose = Posture::random(lab.seed + 8, k).pose(body);
                (pose, Curves(ideal_outline(body.solid(), &pose, &view, STEP_PX)))
            })
            .collect();
        for inset_px in [0.0, MatchParams::default().inset_px] {
            let bounds: Vec<Bound> = posed
                .par_iter()
                .filter_map(|(pose, curves)| {
                    let points: Vec<EdgePoint> = curves.0.iter().flat_map(|c| &c.points).copied().collect();
                    bound(body, pose, &centroid, &view, &points, inset_px)
                })
                .collect();
            let frames: Frames = posed
                .iter()
                .enumerate()
                .map(|(k, (pose, curves))| {
                    let mut chance = random(lab.seed, 70, k);
                    (k.to_string(), *pose, vec![noisy(curves, NOISE_PX, 0.0, &mut chance)])
                })
                .collect();
            // Depth is loose in one view: that alone does not speak against a pose.
            let params = MatchParams { inset_px, good_sigma_mm: f64::MAX, ..MatchParams::default() };
            let made = Made { origin: Origin::Solid, claim: Claim::Accuracy, params };
            let views = std::slice::from_ref(&view);
            let scene = Scene::made(made, &mesh, &calibrations(views), frames)?;
            let draw = |truth: &_, centroid: &_, frame| near.draw(truth, centroid, frame);
            let all = outcomes(&scene, Method::Default, &thesis_params(), &draw);
            let there = |o: &Outcome| {
                in_plane_mm(o, &view) <= ELSEWHERE.0 && o.error.rotation_rad.to_degrees() <= ELSEWHERE.1
            };
            let (right, elsewhere): (Vec<&Outcome>, Vec<&Outcome>) = all.iter().partition(|o| there(o));
            let said_good = |o: &&&Outcome| o.stated.as_ref().is_some_and(|s| s.verdict == Verdict::Good);
            let errors = by_plane(&right, &view).map(|v| Spread::of(&v).rms);
            let least = deviations(&bounds);
            let p95 = Distribution::of(right.iter().map(|o| in_plane_mm(o, &view)).collect()).p95;
            let label = match inset_px > 0.0 {
                true => format!("{name}, an inset solved for"),
                false => name.to_owned(),
            };
            goals.at_most(&format!("{label}, in plane at 95 %"), p95, IN_PLANE_MM, "mm");
            goals.none(&format!("{label}, elsewhere"), elsewhere.len());
            let mut cells: Vec<Cell> = errors
                .iter()
                .zip(least)
                .flat_map(|(error, bound)| [Cell::Number(*error), Cell::text(format!("{bound:.4}"))])
                .collect();
            cells.extend([
                Cell::Number(errors[1] / least[1]),
                Cell::Number(p95),
                Cell::Number(elsewhere.len() as f64),
                Cell::Number(elsewhere.iter().filter(said_good).count() as f64),
            ]);
            table.rows.push(Row::ours(label, cells));
        }
    }
    Ok(Some(Section {
        title: "One view, beside the least error that there can be".to_owned(),
        text: vec![
            format!(
                "`cargo xtask validate --only one-view --seed {}`: {poses} random poses a body, one start 3 mm and 3 degrees off each. Ideal \
                 outlines from the analytic surfaces, points {STEP_PX} px apart, each moved along its normal by independent noise of {NOISE_PX} \
                 px. The bound is that of Cramer and Rao for this noise: no unbiased method that knows the true surface does better. It is \
                 computed from the analytic outlines alone, by differences. Errors are of matches in the truth's basin, whatever their \
                 verdict; elsewhere is beyond {} mm in plane or {} degrees. As edges of X-ray pictures lie inside a smooth outline, the default \
                 solves for an inset in each view, and in one view that is told from depth by perspective alone: both ways are measured. \
                 Goals: {IN_PLANE_MM} mm in plane at 95 %; depth as good as geometry allows.",
                lab.seed, ELSEWHERE.0, ELSEWHERE.1
            ),
            goals.text(),
        ],
        tables: vec![table],
        plots: Vec::new(),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_bound_worse_than_plane_and_more_so_with_an_inset() {
        let [view, _] = biplane(90.0);
        let body = Body::FemoralComponent;
        let pose = Posture::flexed(40.0).pose(body);
        let outline = ideal_outline(body.solid(), &pose, &view, STEP_PX);
        let points: Vec<EdgePoint> = outline.iter().flat_map(|c| &c.points).copied().collect();
        let at = |prior| bound(body, &pose, &Point3::origin(), &view, &points, prior).unwrap();
        let (held, free) = (deviations(&[at(0.0)]), deviations(&[at(1.0)]));
        // Half the pixel's size at the body, over the root of some 700 points, and depth worse by about twice the distance over the size.
        assert!((0.002..0.02).contains(&held[0]), "{held:?}");
        assert!(held[1] > 5.0 * held[0] && held[1] < 0.5, "{held:?}");
        assert!(free[1] > 1.5 * held[1], "{free:?} {held:?}");
        // Every second point tells half as much.
        let half: Vec<EdgePoint> = points.iter().step_by(2).copied().collect();
        let fewer = deviations(&[bound(body, &pose, &Point3::origin(), &view, &half, 0.0).unwrap()]);
        assert!((fewer[1] / held[1] - 2.0_f64.sqrt()).abs() < 0.1, "{fewer:?} {held:?}");
    }
}
