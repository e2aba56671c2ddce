//! Poses found from outlines of known pose, and what is said of those that cannot be found.
//!
//! Outlines here come from the very mesh that is matched, so these tests say nothing of accuracy on images (that is
//! `cargo xtask validate`): they hold the optimiser, the robust weights, the inset and the verdict.

// A test whose set-up fails has failed.
#![allow(clippy::unwrap_used)]

use biplane_artifact::{Calibration, Curves, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Mesh, Point3, Pose, Twist, Vector2, Vector3};
use biplane_optimisation::{EdgeBias, EdgeField, MatchParams, View, match_body};
use biplane_outline::{Outline, OutlinePoint, RimMesh, Sampling};

/// A body without symmetry, about 60 mm long: a ball stretched and bent, with a bump.
fn body() -> Mesh {
    let n = 40;
    let point = |i: usize, j: usize| {
        let (a, b) = (
            std::f64::consts::PI * i as f64 / n as f64,
            std::f64::consts::PI * (j % (2 * n)) as f64 / n as f64,
        );
        let d = if i == 0 || i == n {
            Vector3::new(0.0, 0.0, if i == 0 { 1.0 } else { -1.0 })
        } else {
            Vector3::new(a.sin() * b.cos(), a.sin() * b.sin(), a.cos())
        };
        let bump = 9.0 * (-8.0 * (d - Vector3::new(0.6, 0.7, 0.3).normalize()).norm_squared()).exp();
        let r = Vector3::new(30.0 * d.x, 18.0 * d.y, 22.0 * d.z) + d * bump;
        Point3::new(r.x + 0.006 * r.z * r.z, r.y + 0.05 * r.x, r.z)
    };
    let soup: Vec<[Point3; 3]> = (0..n)
        .flat_map(|i| (0..2 * n).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let (p, q, r, s) = (point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
            [[p, q, r], [p, r, s]]
        })
        .collect();
    Mesh::from_soup(&soup).unwrap()
}

/// Two views at right angles, source 1000 mm from the middle; `focal_px` over 1000 is the px per mm there.
fn fluoroscopes(focal_px: f64) -> Vec<Fluoroscope> {
    let make = |view: &str, source: [f64; 3], right: [f64; 3], forward: [f64; 3]| {
        let row = |v: [f64; 3], f: f64, c: f64| std::array::from_fn(|k| f * v[k] + c * forward[k]);
        Fluoroscope::from(&Calibration {
            view: view.to_owned(),
            size: [1024, 1024],
            source,
            matrix: [row(right, focal_px, 511.5), row([0.0, 0.0, -1.0], focal_px, 511.5), forward],
            distortion: None,
        })
    };
    vec![
        make("A", [0.0, -1000.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        make("B", [1000.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]),
    ]
}

fn truth() -> Pose {
    Pose::new(nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.5, 0.9), Vector3::new(4.0, -3.0, 6.0))
}

/// Views whose edges are the outline at `pose`, each point passed through `change` (left out where it gives none).
fn views(
    rim: &RimMesh,
    pose: &Pose,
    change: impl Fn(usize, &OutlinePoint) -> Option<EdgePoint>,
) -> Vec<View> {
    views_of(fluoroscopes(6700.0), rim, pose, change)
}

fn views_of(
    fluoroscopes: Vec<Fluoroscope>,
    rim: &RimMesh,
    pose: &Pose,
    change: impl Fn(usize, &OutlinePoint) -> Option<EdgePoint>,
) -> Vec<View> {
    let see = |(number, fluoroscope): (usize, Fluoroscope)| {
        let mut outline = Outline::new();
        outline.trace(rim, pose, &fluoroscope, Sampling { step_px: 1.0 });
        // In order round the middle: this body's outline is star-shaped about it.
        let middle = fluoroscope.project(&pose.transform(rim.centroid())).unwrap().pixel;
        let mut around = outline.points().to_vec();
        around.sort_by(|a, b| {
            let angle = |p: &OutlinePoint| (p.pixel.y - middle.y).atan2(p.pixel.x - middle.x);
            angle(a).total_cmp(&angle(b))
        });
        let points: Vec<EdgePoint> = around.iter().filter_map(|p| change(number, p)).collect();
        let curves = Curves(vec![Curve { points, closed: false }]);
        View { edges: EdgeField::new(&curves, None), fluoroscope }
    };
    fluoroscopes.into_iter().enumerate().map(see).collect()
}

fn edge(p: &OutlinePoint, inside: f64) -> EdgePoint {
    EdgePoint { position: p.pixel - p.normal * inside, direction: p.normal, strength: 20.0, sigma_px: 0.05 }
}

fn off(pose: &Pose, centroid: &Point3, mm: f64, deg: f64) -> Pose {
    let twist = Twist {
        translation: Vector3::new(1.0, -2.0, 2.0) * (mm / 3.0),
        rotation: Vector3::new(2.0, 1.0, -2.0) * (deg.to_radians() / 3.0),
    };
    pose.moved(&twist, &pose.transform(centroid))
}

struct Found {
    answer: biplane_artifact::Match,
    mm: f64,
    deg: f64,
}

fn find(views: &[View], rim: &RimMesh, params: &MatchParams) -> Found {
    let names = ["A".to_owned(), "B".to_owned()];
    let start = off(&truth(), rim.centroid(), 5.0, 5.0);
    let answer = match_body(rim, views, &names, &start, params, || false).unwrap();
    let error = Pose::from(answer.pose).error_against(&truth(), rim.centroid());
    Found { answer, mm: error.translation_mm, deg: error.rotation_rad.to_degrees() }
}

#[test]
fn an_ideal_outline_gives_its_pose_back() {
    let rim = RimMesh::new(&body());
    let found = find(&views(&rim, &truth(), |_, p| Some(edge(p, 0.0))), &rim, &MatchParams::default());
    assert_eq!(found.answer.verdict, Verdict::Good, "{}", found.answer.reason);
    assert!(found.mm < 0.005 && found.deg < 0.02, "{} mm, {} degrees", found.mm, found.deg);
    assert!(found.answer.views.iter().all(|v| v.matched_share > 0.99 && v.inset_px.abs() < 0.05));
}

#[test]
fn edges_that_lie_inside_as_a_whole_are_told_as_inset_and_do_not_turn_the_body() {
    let rim = RimMesh::new(&body());
    let views = views(&rim, &truth(), |number, p| Some(edge(p, if number == 0 { 0.6 } else { 0.3 })));
    let constant = MatchParams { edge_bias: EdgeBias::Constant, ..MatchParams::default() };
    let found = find(&views, &rim, &constant);
    assert!(found.mm < 0.01 && found.deg < 0.05, "{} mm, {} degrees", found.mm, found.deg);
    assert!((found.answer.views[0].inset_px - 0.6).abs() < 0.05, "{}", found.answer.views[0].inset_px);
    assert!((found.answer.views[1].inset_px - 0.3).abs() < 0.05, "{}", found.answer.views[1].inset_px);
    // Held at zero, the same edges move the pose: the nuisance parameter does something.
    let held = find(&views, &rim, &MatchParams { inset_px: 0.0, ..constant });
    assert!(held.mm + held.deg > 3.0 * (found.mm + found.deg), "{} mm, {} degrees", held.mm, held.deg);
}

#[test]
fn a_bright_body_is_found_as_bright_and_not_as_dark() {
    let rim = RimMesh::new(&body());
    let views = views(&rim, &truth(), |_, p| Some(EdgePoint { direction: -p.normal, ..edge(p, 0.0) }));
    let bright = MatchParams { contrast: biplane_optimisation::Contrast::Bright, ..MatchParams::default() };
    let found = find(&views, &rim, &bright);
    assert_eq!(found.answer.verdict, Verdict::Good, "{}", found.answer.reason);
    assert!(found.mm < 0.005, "{} mm", found.mm);
    assert_ne!(find(&views, &rim, &MatchParams::default()).answer.verdict, Verdict::Good);
}

#[test]
fn with_half_of_one_outline_missing_the_pose_is_right_and_not_called_good() {
    let rim = RimMesh::new(&body());
    let views = views(&rim, &truth(), |number, p| (number == 1 || p.normal.x > 0.0).then(|| edge(p, 0.0)));
    let found = find(&views, &rim, &MatchParams::default());
    assert!(found.mm < 0.02 && found.deg < 0.05, "{} mm, {} degrees", found.mm, found.deg);
    assert_ne!(found.answer.verdict, Verdict::Good);
    assert!(found.answer.reason.contains("view A"), "{}", found.answer.reason);
}

#[test]
fn edges_of_something_else_are_said_to_have_failed() {
    let rim = RimMesh::new(&body());
    // A circle of 60 px where the body is: nothing of its outline.
    let views = views(&rim, &truth(), |_, p| {
        let a = p.pixel.x + 7.0 * p.pixel.y;
        let direction = Vector2::new(a.cos(), a.sin());
        Some(EdgePoint {
            position: nalgebra::Point2::new(511.5, 511.5) + direction * 60.0,
            direction,
            ..edge(p, 0.0)
        })
    });
    let found = find(&views, &rim, &MatchParams::default());
    assert_eq!(found.answer.verdict, Verdict::Failed);
    assert!(!found.answer.reason.is_empty());
}

/// Regression: an outline shorter than a few correlation lengths had no covariance and always failed.
#[test]
fn a_body_that_is_small_in_the_picture_can_be_good() {
    let rim = RimMesh::new(&body());
    let views = views_of(fluoroscopes(1500.0), &rim, &truth(), |_, p| Some(edge(p, 0.0)));
    let found = find(&views, &rim, &MatchParams::default());
    assert!(found.answer.views.iter().all(|v| v.outline_px < 300.0));
    assert_eq!(found.answer.verdict, Verdict::Good, "{}", found.answer.reason);
}

#[test]
fn no_edges_at_all_are_a_failure_and_not_a_panic() {
    let rim = RimMesh::new(&body());
    let found = find(&views(&rim, &truth(), |_, _| None), &rim, &MatchParams::default());
    assert_eq!(found.answer.verdict, Verdict::Failed);
}

#[test]
fn the_outline_moves_as_its_derivative_says() {
    // The residuals of an outline against that of a pose a little away are the derivative times the twist: one
    // Levenberg-Marquardt step undoes a small twist to second order, whatever its direction.
    let rim = RimMesh::new(&body());
    let params = MatchParams { search_px: 3.0, retries: 0, ..MatchParams::default() };
    let views = views(&rim, &truth(), |_, p| Some(edge(p, 0.0)));
    for axis in 0..6 {
        let mut twist = Twist { translation: Vector3::zeros(), rotation: Vector3::zeros() };
        if axis < 3 {
            twist.translation[axis] = 0.2;
        } else {
            twist.rotation[axis - 3] = 0.2 / rim.radius_of_gyration();
        }
        let start = truth().moved(&twist, &truth().transform(rim.centroid()));
        let search = biplane_optimisation::RefineParams { most_steps: 1, ..params.search() };
        let one = biplane_optimisation::refine(&rim, &views, &start, &search);
        let left = one.pose.error_against(&truth(), rim.centroid());
        let size = left.translation_mm.max(left.rotation_rad * rim.radius_of_gyration());
        assert!(size < 0.02, "axis {axis}: {size} mm left of 0.2 mm after one step");
    }
}

#[test]
fn the_same_inputs_give_the_same_bytes() {
    use biplane_artifact::Artifact;
    let rim = RimMesh::new(&body());
    let views = views(&rim, &truth(), |_, p| (p.pixel.y > 500.0).then(|| edge(p, 0.2)));
    let answer = || find(&views, &rim, &MatchParams::default()).answer.encode();
    assert_eq!(answer(), answer());
}
