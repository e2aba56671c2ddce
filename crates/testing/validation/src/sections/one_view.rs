//! One view: errors in its plane and in depth, beside the least that any unbiased method can have from the same noisy outline.
//!
//! **Bound.** Each outline point is moved along its normal by independent noise of standard deviation `sigma`, so the information of an
//! outline is `sum(j j') / sigma^2` with `j` the derivative of the contour's place along its normal by the six of the pose, and its
//! inverse the least covariance (Cramer and Rao). `j` is that of the point of the analytic surface that the ray touches. Where an inset of
//! the whole outline is solved for, it is a seventh unknown with `j = 1`, known beforehand to the deviation that the method assumes.

use biplane_artifact::Verdict;
use biplane_geometry::{EdgePoint, Point3, Pose, Vector3};
use biplane_optimisation::{EdgeBias, MatchParams};
use biplane_phantom::{Body, TrueFluoroscope, biplane};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use super::SectionError;
use crate::faults::{noisy, random};
use crate::goals::Goals;
use crate::lab::{calibrations, thesis_params};
use crate::many_outlines::frames;
use crate::outcome::{Method, Outcome, by_plane, outcomes};
use crate::scene::{Claim, Made, Origin};
use crate::{Cell, Column, Distribution, Lab, Row, Scene, Section, Spread, StartOffset, Table};

/// Noise of each outline point, px: independent, the points 1 px apart ([`frames`]).
const NOISE_PX: f64 = 0.3;
/// Step of the differences of a projected point, in mm and rad.
const DIFFERENCE: f64 = 1e-4;
/// Shortest step along a ray, mm.
const SHORTEST_STEP_MM: f64 = 0.2;
/// In a basin that is not the truth's: in plane beyond this, mm, or turned by more than this, degrees.
const ELSEWHERE: (f64, f64) = (1.0, 3.0);
/// Goal for the length of the error in plane at 95 %, mm.
const IN_PLANE_MM: f64 = 0.1;
/// What counts as depth as good as geometry allows, of the bound.
const OF_THE_BOUND: f64 = 1.5;
const BODIES: [(Body, &str); 3] = [
    (Body::FemoralComponent, "femoral component"),
    (Body::TibialTray, "tibial component"),
    (Body::DistalFemur, "femur"),
];
const POINTS: usize = 15_000;

/// Least covariance: displacement along the view's x, y and normal (mm), rotation about them (rad), and the inset (px).
type Bound = SMatrix<f64, 7, 7>;

/// Derivatives by the six of the place along its normal of the contour at a point of the outline, px a mm and rad: those of the point of
/// the body that the ray touches, held fixed to the body, since what else a rim point does runs along the contour.
fn derivatives(
    body: Body,
    pose: &Pose,
    centre: &Point3,
    view: &TrueFluoroscope,
    point: &EdgePoint,
) -> Option<[f64; 6]> {
    let touched = touched(body, pose, view, point);
    let axes = [view.along_x, view.along_y, view.normal()];
    let place = |by: Vector3| view.project(&(touched + by)).map(|p| p.0.coords.dot(&point.direction));
    let mut derivatives = [0.0; 6];
    for (k, derivative) in derivatives.iter_mut().enumerate() {
        let axis = axes[k % 3];
        let velocity = if k < 3 { axis } else { axis.cross(&(touched - centre)) };
        *derivative = (place(velocity * DIFFERENCE)? - place(-velocity * DIFFERENCE)?) / (2.0 * DIFFERENCE);
    }
    Some(derivatives)
}

/// The point in the laboratory where the ray of an outline point is nearest to the body: it touches it there.
fn touched(body: Body, pose: &Pose, view: &TrueFluoroscope, point: &EdgePoint) -> Point3 {
    let (solid, back) = (body.solid(), pose.inverse());
    let source = back.transform(&view.source);
    let ray = (back.transform(&view.detector_point(&point.position)) - source).normalize();
    let value = |at: f64| solid.value(&(source + ray * at));
    let (low, high) = solid.bounds();
    let (middle, radius) = (nalgebra::center(&low, &high), (high - low).norm() / 2.0);
    let nearest = (middle - source).dot(&ray);
    // The function grows by at most the distance, so no least value is stepped over by more than the shortest step.
    let (mut at, mut best) = (nearest - radius, (f64::INFINITY, nearest));
    while at < nearest + radius {
        let here = value(at);
        if here < best.0 {
            best = (here, at);
        }
        at += here.max(SHORTEST_STEP_MM);
    }
    // Golden section.
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut a, mut b) = (best.1 - SHORTEST_STEP_MM, best.1 + SHORTEST_STEP_MM);
    while b - a > 1e-4 {
        let (c, d) = (b - golden * (b - a), a + golden * (b - a));
        if value(c) < value(d) { b = d } else { a = c }
    }
    pose.transform(&(source + ray * ((a + b) / 2.0)))
}

/// What the points of an outline tell of the pose and of the inset.
fn information(
    body: Body,
    pose: &Pose,
    centroid: &Point3,
    view: &TrueFluoroscope,
    points: &[EdgePoint],
) -> Bound {
    let centre = pose.transform(centroid);
    let mut information = Bound::zeros();
    for point in points {
        let Some(d) = derivatives(body, pose, &centre, view, point) else { continue };
        let row = SVector::<f64, 7>::from_fn(|i, _| d.get(i).copied().unwrap_or(1.0));
        information += row * row.transpose() / (NOISE_PX * NOISE_PX);
    }
    information
}

/// The bound; `prior_px` of the inset, 0 where it is held. `None` where the outline does not determine the pose.
fn bound(information: &Bound, prior_px: f64) -> Option<Bound> {
    let mut information = *information;
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
        let posed = frames(body, std::slice::from_ref(&view), lab.seed + 8, poses);
        let told: Vec<Bound> = posed
            .par_iter()
            .map(|(_, pose, curves)| {
                let points: Vec<EdgePoint> =
                    curves.iter().flat_map(|c| &c.0).flat_map(|c| &c.points).copied().collect();
                information(body, pose, &centroid, &view, &points)
            })
            .collect();
        for inset_px in [0.0, MatchParams::default().inset_px] {
            let bounds: Vec<Bound> = told.iter().filter_map(|i| bound(i, inset_px)).collect();
            let disturbed = posed
                .iter()
                .enumerate()
                .map(|(k, (label, pose, curves))| {
                    let mut chance = random(lab.seed, 70, k);
                    let moved = curves.iter().map(|c| noisy(c, NOISE_PX, 0.0, &mut chance)).collect();
                    (label.clone(), *pose, moved)
                })
                .collect();
            // Depth is loose in one view: that alone does not speak against a pose.
            let edge_bias = if inset_px > 0.0 { EdgeBias::Constant } else { EdgeBias::None };
            let params =
                MatchParams { edge_bias, inset_px, good_sigma_mm: f64::MAX, ..MatchParams::default() };
            let made = Made { origin: Origin::Solid, claim: Claim::Accuracy, params };
            let views = std::slice::from_ref(&view);
            let scene = Scene::made(made, &mesh, &calibrations(views), disturbed)?;
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
            goals.at_most(&format!("{label}, depth"), errors[1] / least[1], OF_THE_BOUND, "of its bound");
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
                 outlines from the analytic surfaces, points 1 px apart, each moved along its normal by independent noise of {NOISE_PX} \
                 px. The bound is that of Cramer and Rao for this noise: no unbiased method that knows the true surface does better. It is \
                 computed from the analytic surfaces alone. Errors are of matches in the truth's basin, whatever their \
                 verdict; elsewhere is beyond {} mm in plane or {} degrees. Edges of X-ray pictures lie inside a smooth \
                 outline; where that inset is solved for (`edge_bias = \"constant\"`), it is told from depth by perspective alone. Both it \
                 and `\"none\"` are measured. \
                 Goals: {IN_PLANE_MM} mm in plane at 95 %; depth as good as \
                 geometry allows, which shall be {OF_THE_BOUND} of the bound.",
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
    use crate::knee::Posture;
    use crate::many_outlines::outline;
    use crate::true_outline::TrueOutline;
    use biplane_geometry::Twist;

    /// A view, a body, a pose, and the points of its outline.
    fn seen() -> (TrueFluoroscope, Body, Pose, Vec<EdgePoint>) {
        let [view, _] = biplane(90.0);
        let (body, pose) = (Body::FemoralComponent, Posture::flexed(40.0).pose(Body::FemoralComponent));
        let outline = outline(body, &pose, &view, 1.0);
        (view.clone(), body, pose, outline.iter().flat_map(|c| &c.points).copied().collect())
    }

    #[test]
    fn derivatives_are_those_of_differences_of_the_outline() {
        let (view, body, pose, points) = seen();
        let centre = pose.transform(&Point3::origin());
        let axes = [view.along_x, view.along_y, view.normal()];
        for k in 0..6 {
            let step = if k < 3 { 0.1 } else { 1.5e-3 };
            let [ahead, behind] = [step, -step].map(|step| {
                let by = |own: bool| if own { axes[k % 3] * step } else { Vector3::zeros() };
                let moved = pose.moved(&Twist { translation: by(k < 3), rotation: by(k >= 3) }, &centre);
                TrueOutline::new(outline(body, &moved, &view, 0.25))
            });
            let (mut off, mut all) = (0.0, 0.0);
            for point in points.iter().step_by(7) {
                let outside = |outline: &TrueOutline| outline.outside_px(&point.position, 2.0).unwrap();
                let difference = (outside(&behind) - outside(&ahead)) / (2.0 * step);
                let exact = derivatives(body, &pose, &centre, &view, point).unwrap()[k];
                off += (difference - exact).powi(2);
                all += exact * exact;
            }
            assert!(off < 1e-3 * all, "{k}: {off} of {all}");
        }
    }

    #[test]
    fn depth_is_bound_worse_than_plane_and_more_so_with_an_inset() {
        let (view, body, pose, points) = seen();
        let told = |points: &[EdgePoint]| information(body, &pose, &Point3::origin(), &view, points);
        let all = told(&points);
        let (held, free) =
            (deviations(&[bound(&all, 0.0).unwrap()]), deviations(&[bound(&all, 1.0).unwrap()]));
        assert!(held[1] > 5.0 * held[0] && free[1] > 1.5 * held[1], "{held:?} {free:?}");
        // Every second point tells half as much.
        let half: Vec<EdgePoint> = points.iter().step_by(2).copied().collect();
        let fewer = deviations(&[bound(&told(&half), 0.0).unwrap()]);
        assert!((fewer[1] / held[1] - 2.0_f64.sqrt()).abs() < 0.1, "{fewer:?} {held:?}");
    }
}
