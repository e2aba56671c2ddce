//! All objectives on a body without symmetry: lowest at the right pose, gradients against finite differences, one view and three, what is missing
//! and what is wrong, and each one's own claims.

use biplane_artifact::Calibration;
use biplane_geometry::{Curve, EdgePoint, Point2, Point3, Twist, Vector2, Vector3};
use biplane_optimiser::{Function, Optimiser, Search};
use biplane_outline::{Outline, Sampling};
use biplane_spline::Spline;
use nalgebra::{UnitQuaternion, Vector6};
use rand::{Rng, SeedableRng};

use super::*;

/// A body without symmetry, about 60 mm long: a ball stretched and bent, with a bump. Made of `n` rings.
fn body_of(n: usize) -> Mesh {
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

pub(crate) fn body() -> Mesh {
    body_of(40)
}

/// Three views, the first two at right angles, source 1000 mm from the middle, 4 px per mm there.
pub(crate) fn fluoroscopes() -> Vec<Fluoroscope> {
    let make = |view: &str, source: [f64; 3], right: [f64; 3], forward: [f64; 3]| {
        let row = |v: [f64; 3]| std::array::from_fn(|k| 4000.0 * v[k] + 511.5 * forward[k]);
        Fluoroscope::from(&Calibration {
            view: view.to_owned(),
            size: [1024, 1024],
            source,
            matrix: [row(right), row([0.0, 0.0, -1.0]), forward],
            distortion: None,
        })
    };
    let h = std::f64::consts::FRAC_1_SQRT_2;
    vec![
        make("A", [0.0, -1000.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        make("B", [1000.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]),
        make("C", [1000.0 * h, -1000.0 * h, 0.0], [h, h, 0.0], [-h, h, 0.0]),
    ]
}

pub(crate) fn truth() -> Pose {
    Pose::new(UnitQuaternion::from_euler_angles(0.3, -0.5, 0.9), Vector3::new(4.0, -3.0, 6.0))
}

fn settings() -> Settings {
    Settings {
        contrast: 1.0,
        spacing_px: 2.0,
        outline_points: 50,
        grid: 30,
        reach_px: 80.0,
        wide_px: 30.0,
        fine_px: 2.0,
        stages: 3,
        inset_px: 0.0,
    }
}

/// The visible outline as a closed contour, in order: points by their angle about the middle, which this body's outline allows.
fn contour(rim: &RimMesh, pose: &Pose, view: &Fluoroscope) -> Curve {
    let mut outline = Outline::new();
    outline.trace(rim, pose, view, Sampling { step_px: 1.0 });
    let middle =
        outline.points().iter().map(|p| p.pixel.coords).sum::<Vector2>() / outline.points().len() as f64;
    let mut points: Vec<EdgePoint> = outline
        .points()
        .iter()
        .map(|p| EdgePoint { position: p.pixel, direction: p.normal, strength: 20.0, sigma_px: 0.05 })
        .collect();
    let angle = |p: &EdgePoint| (p.position.y - middle.y).atan2(p.position.x - middle.x);
    points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    Curve { points, closed: true }
}

fn targets(rim: &RimMesh, views: usize, change: impl Fn(usize, Curve) -> Vec<Curve>) -> Vec<Target> {
    let of = |(number, view): (usize, Fluoroscope)| Target {
        curves: Curves(change(number, contour(rim, &truth(), &view))),
        fluoroscope: view,
        mm_per_px: 0.25,
    };
    fluoroscopes().into_iter().take(views).enumerate().map(of).collect()
}

/// Off the truth by a twist about the centroid (mm, and mm at the radius of gyration).
fn off(rim: &RimMesh, at: &Vector6<f64>) -> Pose {
    Variables::new(&truth(), rim.centroid(), rim.radius_of_gyration()).pose(at)
}

/// In its last stage.
fn entered<'a>(kind: Kind, body: &Body<'a>, targets: &[Target]) -> Box<dyn Objective + 'a> {
    let mut objective = kind.of(body, targets, &settings()).unwrap();
    objective.enter(objective.stages() - 1);
    objective
}

#[test]
fn each_is_lowest_at_the_right_pose_in_one_view_two_and_three() {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let body = Body { mesh: &mesh, rim: &rim, field: Some(Arc::new(DistanceField::new(&mesh))) };
    let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(7);
    for views in 1..=3 {
        let targets = targets(&rim, views, |_, c| vec![c]);
        for kind in Kind::ALL {
            let mut objective = entered(kind, &body, &targets);
            let least = objective.value(&truth());
            // The grid's cells are 1.5 mm; the field's errors and a mean over views are far below.
            let expected = if kind == Kind::SplineGrid { 0.5 } else { 0.03 };
            assert!(least < expected * views as f64, "{}: {least}", kind.name());
            for _ in 0..12 {
                // Motion along the rays of a single view changes little.
                let away =
                    Vector6::from_fn(
                        |i, _| if views == 1 && i == 1 { 0.0 } else { random.random_range(-3.0..3.0) },
                    );
                let value = objective.value(&off(&rim, &away));
                assert!(value > least + 0.05, "{} {views}: {value} at {away}", kind.name());
                assert_eq!(value, objective.value(&off(&rim, &away)), "no memory");
            }
            // Behind a source, or far beside all pictures: a number.
            for far in [Vector3::new(0.0, -3000.0, 0.0), Vector3::new(4e4, 5e4, 6e4), Vector3::repeat(1e12)] {
                assert!(
                    objective.value(&Pose::new(truth().rotation(), far)).is_finite(),
                    "{} {far}",
                    kind.name()
                );
            }
        }
    }
}

/// Over so small a step that rim and partners mostly stay the same, at many places; jumps of single points are left out by taking the median.
#[test]
fn rows_are_the_gradient_of_the_value() {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let body = Body { mesh: &mesh, rim: &rim, field: Some(Arc::new(DistanceField::new(&mesh))) };
    let targets = targets(&rim, 2, |_, c| vec![c]);
    let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(8);
    for kind in Kind::ALL {
        for (stage, inset_px) in [(0, 0.0), (2, 0.0), (2, 1.0)] {
            let mut objective = kind.of(&body, &targets, &Settings { inset_px, ..settings() }).unwrap();
            objective.enter(stage.min(objective.stages() - 1));
            let mut rows = Vec::new();
            if objective.linearise(&truth(), &mut rows).is_none() {
                assert!(!kind.has_rows() && rows.is_empty());
                continue;
            }
            assert!(kind.has_rows());
            // The smooth ones over a short step; the others change with their rows of pixels, or with which edges are the rim: over a long one.
            let exact = [Kind::ImageToModel, Kind::InversePoint].contains(&kind);
            let (step, tolerance) = if exact { (1e-5, 0.01) } else { (0.2, 0.15) };
            let mut errors = Vec::new();
            for _ in 0..24 {
                let at = Vector6::from_fn(|_, _| random.random_range(-2.0..2.0));
                let variables = Variables::new(&truth(), rim.centroid(), rim.radius_of_gyration());
                rows.clear();
                let value = objective.linearise(&variables.pose(&at), &mut rows).unwrap();
                assert!((value - objective.value(&variables.pose(&at))).abs() < 1e-12);
                variables.chain(&at, &mut rows);
                let gradient: Vector6<f64> =
                    rows.iter().map(|r| r.derivative * (r.weight * r.residual)).sum();
                let numeric = Vector6::from_fn(|i, _| {
                    let beside = [-1.0, 1.0].map(|sign| {
                        let mut beside = at;
                        beside[i] += sign * step;
                        objective.value(&variables.pose(&beside))
                    });
                    (beside[1] - beside[0]) / (2.0 * step)
                });
                errors.push((gradient - numeric).norm() / numeric.norm());
            }
            errors.sort_by(f64::total_cmp);
            let middle = errors[errors.len() / 2];
            assert!(middle < tolerance, "{} {stage}: {errors:?}", kind.name());
        }
    }
}

struct Searched<'a> {
    objective: Box<dyn Objective + 'a>,
    variables: Variables,
}

impl Function for Searched<'_> {
    fn value(&mut self, at: &Vector6<f64>) -> f64 {
        self.objective.value(&self.variables.pose(at))
    }
    fn linearise(&mut self, at: &Vector6<f64>, rows: &mut Vec<Row>) -> Option<f64> {
        let value = self.objective.linearise(&self.variables.pose(at), rows)?;
        self.variables.chain(at, rows);
        Some(value)
    }
}

/// From 3 mm and 5 degrees off, by Levenberg and Marquardt (by BFGS where there are no rows): error in mm and degrees, and calls.
fn found(kind: Kind, body: &Body<'_>, targets: &[Target]) -> (f64, f64, usize) {
    found_with(kind, body, targets, &settings())
}

fn found_with(kind: Kind, body: &Body<'_>, targets: &[Target], settings: &Settings) -> (f64, f64, usize) {
    let twist =
        Twist { translation: Vector3::new(1.0, -2.0, 2.0), rotation: Vector3::new(0.06, 0.03, -0.06) };
    let start = truth().moved(&twist, &truth().transform(body.rim.centroid()));
    let variables = Variables::new(&start, body.rim.centroid(), body.rim.radius_of_gyration());
    let mut searched = Searched { objective: kind.of(body, targets, settings).unwrap(), variables };
    let search = Search {
        low: Vector6::repeat(-20.0),
        high: Vector6::repeat(20.0),
        tolerance: 5e-4,
        calls: 1500,
        first_difference: 0.5,
        last_difference: 0.02,
        reach: 4.0,
        seed: 1,
    };
    let optimiser = if kind.has_rows() { Optimiser::LevenbergMarquardt } else { Optimiser::Bfgs };
    let (mut at, mut calls) = (Vector6::zeros(), 0);
    for stage in 0..searched.objective.stages() {
        searched.objective.enter(stage);
        let ended = optimiser.minimise(&mut searched, &at, &search).unwrap();
        at = ended.at;
        calls += ended.calls;
    }
    let error = variables.pose(&at).error_against(&truth(), body.rim.centroid());
    (error.translation_mm, error.rotation_rad.to_degrees(), calls)
}

#[test]
fn a_search_finds_the_pose_by_each_of_them() {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let body = Body { mesh: &mesh, rim: &rim, field: Some(Arc::new(DistanceField::new(&mesh))) };
    let targets = targets(&rim, 2, |_, c| vec![c]);
    for kind in Kind::ALL {
        let (mm, deg, calls) = found(kind, &body, &targets);
        let (most_mm, most_deg) = if kind == Kind::SplineGrid { (0.5, 1.0) } else { (0.05, 0.15) };
        let most = if kind.has_rows() { 60 } else { 800 };
        assert!(calls <= most, "{}: {calls} calls", kind.name());
        assert!(mm < most_mm && deg < most_deg, "{}: {mm} mm, {deg} degrees", kind.name());
    }
}

/// Edges that lie 0.6 and 0.3 px inside as a whole: told with the inset free, and turning the body with it held.
#[test]
fn edges_that_lie_inside_as_a_whole_do_not_move_the_body_where_that_is_solved_for() {
    let mesh = body();
    // The distance field is that of the triangles.
    let rim = RimMesh::flat(&mesh);
    let body = Body { mesh: &mesh, rim: &rim, field: Some(Arc::new(DistanceField::new(&mesh))) };
    let inside = targets(&rim, 2, |view, mut contour| {
        let px = if view == 0 { 0.6 } else { 0.3 };
        contour.points.iter_mut().for_each(|p| p.position -= p.direction * px);
        vec![contour]
    });
    for kind in [Kind::ImageToModel, Kind::Symmetric, Kind::InversePoint] {
        let held = found_with(kind, &body, &inside, &settings());
        let free = found_with(kind, &body, &inside, &Settings { inset_px: 1.0, ..settings() });
        assert!(free.0 < 0.01 && free.1 < 0.08, "{}: {free:?}", kind.name());
        assert!(held.0 + held.1 > 3.0 * (free.0 + free.1), "{}: {held:?}", kind.name());
    }
}

/// Half of one view's contour is gone, and a straight line that is no edge of the body lies across it.
#[test]
fn robust_ones_stand_missing_and_wrong_contour() {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let body = Body { mesh: &mesh, rim: &rim, field: Some(Arc::new(DistanceField::new(&mesh))) };
    let spoilt = targets(&rim, 2, |view, mut contour| {
        if view == 0 {
            contour.points.truncate(contour.points.len() / 2);
            contour.closed = false;
        }
        let from = contour.points[10].position;
        let line = (0..80).map(|k| EdgePoint {
            position: from + Vector2::new(1.0, 0.6) * f64::from(k),
            direction: Vector2::new(-0.6, 1.0).normalize(),
            strength: 20.0,
            sigma_px: 0.05,
        });
        vec![contour, Curve { points: line.collect(), closed: false }]
    });
    for kind in [Kind::ImageToModel, Kind::Symmetric, Kind::InversePoint] {
        let (mm, deg, _) = found(kind, &body, &spoilt);
        assert!(mm < 0.1 && deg < 0.3, "{}: {mm} mm, {deg} degrees", kind.name());
    }
}

#[test]
fn what_no_edge_was_found_for_is_an_error_and_so_is_a_contour_around_nothing() {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let body = Body { mesh: &mesh, rim: &rim, field: None };
    let empty = targets(&rim, 2, |view, c| if view == 1 { vec![] } else { vec![c] });
    for kind in Kind::ALL {
        assert_eq!(kind.of(&body, &empty, &settings()).err(), Some(ObjectiveError::NoCurve(2)));
    }
    let straight = targets(&rim, 1, |_, mut c| {
        c.points.iter_mut().for_each(|p| p.position.y = p.position.x);
        c.closed = false;
        vec![c]
    });
    assert_eq!(Kind::NonOverlap.of(&body, &straight, &settings()).err(), Some(ObjectiveError::NoArea(1)));
}

#[test]
fn fewer_than_two_points_cost_what_the_listing_says() {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let body = Body { mesh: &mesh, rim: &rim, field: None };
    let targets = targets(&rim, 2, |_, c| vec![c]);
    // Behind the first source, and before the second one.
    let behind = Pose::new(truth().rotation(), Vector3::new(0.0, -1500.0, 0.0));
    for kind in [Kind::SplineGrid, Kind::SplineRim, Kind::ImageToModel, Kind::NonOverlap] {
        let mut one = kind.of(&body, &targets[..1], &settings()).unwrap();
        assert_eq!(one.value(&behind), NO_OUTLINE, "{}", kind.name());
        let mut both = kind.of(&body, &targets, &settings()).unwrap();
        let second = both.value(&behind) - NO_OUTLINE;
        assert!(second > 0.0, "{}: {second}", kind.name());
    }
}

/// Only a part of the spline is trusted: the distance is that from its ends.
#[test]
fn a_trusted_range_ends_where_it_is_said_to() {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let body = Body { mesh: &mesh, rim: &rim, field: None };
    let targets = targets(&rim, 1, |_, c| vec![c]);
    let points: Vec<Point2> = targets[0].curves.0[0].points.iter().map(|p| p.position).collect();
    let spline = Spline::through(&points, true).unwrap();
    let half = biplane_spline::Piece::new(spline.clone(), 0.0, spline.end() / 2.0).unwrap();
    let finder = biplane_spline::FootFinder::new(std::slice::from_ref(&half));
    let mut whole = SplineDistance::of_rim(&body, &targets, &settings());
    let mut trusted = SplineDistance::of_rim(&body, &targets, &settings()).with_pieces(&[vec![half]]);
    let mut outline = Outline::new();
    outline.trace(&rim, &truth(), &targets[0].fluoroscope, Sampling { step_px: 2.0 });
    let weighed = outline.points().iter().map(|p| p.length_px * finder.closest(&p.pixel).unwrap().distance);
    let expected = 0.25 * weighed.sum::<f64>() / outline.length_px();
    assert!((trusted.value(&truth()) - expected).abs() < 1e-9);
    assert!(trusted.value(&truth()) > 100.0 * whole.value(&truth()));
}

/// The shadow's area against triangles filled one by one, and what an area says of two boxes' overlap.
#[test]
fn shadows_are_those_of_the_triangles_and_gaps_of_a_contour_are_bridged() {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let view = fluoroscopes().remove(0);
    let mut spans = shadow::Spans::default();
    Shadow::new(&mesh).cast(&truth(), &view, &mut spans).unwrap();
    let area: f64 = spans.spans().iter().map(|(_, [a, b])| b - a).sum();
    let mut filled = vec![false; 1024 * 1024];
    for t in 0..mesh.triangles().len() {
        let [a, b, c] = mesh.corners(t).map(|p| view.project(&truth().transform(&p)).unwrap().pixel);
        let cross = |o: &Point2, p: &Point2, q: &Point2| (p - o).perp(&(q - o));
        let turn = cross(&a, &b, &c);
        let (low, high) = (a.coords.inf(&b.coords).inf(&c.coords), a.coords.sup(&b.coords).sup(&c.coords));
        for y in low.y.ceil() as usize..=high.y.floor() as usize {
            for x in low.x.ceil() as usize..=high.x.floor() as usize {
                let q = Point2::new(x as f64, y as f64);
                let sides = [cross(&a, &b, &q), cross(&b, &c, &q), cross(&c, &a, &q)];
                filled[y * 1024 + x] |= sides.iter().all(|v| v * turn >= 0.0);
            }
        }
    }
    let counted = filled.iter().filter(|f| **f).count() as f64;
    assert!((area - counted).abs() < 0.002 * counted, "{area} {counted}");
    // The contour of the same shadow, closed, and in four pieces with a fifth of it missing, two of them run through backwards.
    let whole = contour(&rim, &truth(), &view);
    let inside = |curves: Vec<Curve>| {
        let region = Region::new(&Curves(curves), view.size(), 1.0).unwrap();
        let bright = Region::new(&Curves(vec![whole.clone()]), view.size(), -1.0);
        assert!(
            bright.is_none(),
            "turned inside out, a contour surrounds what is outside: nothing that is bounded"
        );
        region.spans().iter().map(|(_, [a, b])| b - a).sum::<f64>()
    };
    assert!((inside(vec![whole.clone()]) / area - 1.0).abs() < 2e-3);
    let lengths: Vec<f64> = whole
        .points
        .windows(2)
        .scan(0.0, |sum, w| {
            *sum += (w[1].position - w[0].position).norm();
            Some(*sum)
        })
        .collect();
    let all = lengths[lengths.len() - 1];
    let pieces: Vec<Curve> = (0..4)
        .map(|k| {
            let range = f64::from(k) / 4.0 * all..(f64::from(k) + 0.8) / 4.0 * all;
            let kept = whole.points.iter().zip(&lengths).filter(|(_, l)| range.contains(l));
            let mut points: Vec<EdgePoint> = kept.map(|(p, _)| *p).collect();
            if k % 2 == 1 {
                points.reverse();
            }
            Curve { points, closed: false }
        })
        .collect();
    let bridged = inside(pieces);
    assert!((bridged / area - 1.0).abs() < 0.03, "{bridged} {area}");
}

/// Distances of a ball are known everywhere; between the grid's points the field has them to a small part of a cell.
#[test]
fn a_field_has_the_distances_of_a_ball_and_their_gradient() {
    let n = 90;
    let point = |i: usize, j: usize| {
        let (a, b) = (
            std::f64::consts::PI * i as f64 / n as f64,
            std::f64::consts::PI * (j % (2 * n)) as f64 / n as f64,
        );
        let z = if i == 0 {
            1.0
        } else if i == n {
            -1.0
        } else {
            a.cos()
        };
        let ring = if i == 0 || i == n { 0.0 } else { a.sin() };
        Point3::new(20.0 * ring * b.cos(), 20.0 * ring * b.sin(), 20.0 * z)
    };
    let soup: Vec<[Point3; 3]> = (0..n)
        .flat_map(|i| (0..2 * n).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let (p, q, r, s) = (point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
            [[p, q, r], [p, r, s]]
        })
        .collect();
    let field = DistanceField::with_cells(&Mesh::from_soup(&soup).unwrap(), 40);
    let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(9);
    for _ in 0..500 {
        let direction = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize();
        let radius: f64 = random.random_range(17.0..23.0);
        let (value, gradient) = field.cubic(&Point3::from(direction * radius));
        // The mesh lies inside the ball by up to 20 (pi / 180)^2 / 2, 0.003 mm.
        assert!((value - (radius - 20.0)).abs() < 0.01, "{value} {radius}");
        assert!((gradient - direction).norm() < 0.02, "{gradient}");
        assert!((field.linear(&Point3::from(direction * radius)) - value).abs() < 0.05);
    }
    // Within and beyond the box, the gradient is that of the value.
    for _ in 0..500 {
        let at = Point3::from(Vector3::from_fn(|_, _| random.random_range(-60.0..60.0)));
        let (_, gradient) = field.cubic(&at);
        let numeric = Vector3::from_fn(|k, _| {
            let step = Vector3::from_fn(|i, _| if i == k { 1e-5 } else { 0.0 });
            (field.cubic(&(at + step)).0 - field.cubic(&(at - step)).0) / 2e-5
        });
        assert!((gradient - numeric).norm() < 1e-4, "{at}: {gradient} {numeric}");
    }
    assert!(field.cubic(&Point3::new(1e9, 0.0, 0.0)).0 > 9e8);
}

#[test]
fn variables_are_millimetres_about_the_start_and_their_chain_rule_holds() {
    let rim = RimMesh::new(&body());
    let variables = Variables::new(&truth(), rim.centroid(), rim.radius_of_gyration());
    let still = variables.pose(&Vector6::zeros()).error_against(&truth(), rim.centroid());
    assert!(still.rotation_rad < 1e-7 && still.translation_mm < 1e-12, "{still:?}");
    let point = Point3::new(10.0, -20.0, 5.0);
    // A quantity of the pose: where a point is, along some way.
    let along = Vector3::new(0.3, -0.8, 0.5);
    let at = Vector6::new(3.0, -4.0, 5.0, 14.0, -9.0, 20.0);
    let pose = variables.pose(&at);
    let centre = pose.transform(rim.centroid());
    let derivative = motion::by_twist(&along, &pose.transform(&point), &centre);
    let mut rows = [Row { residual: 1.0, weight: 1.0, derivative }];
    variables.chain(&at, &mut rows);
    for i in 0..6 {
        let there = |sign: f64| {
            let mut beside = at;
            beside[i] += sign * 1e-5;
            variables.pose(&beside).transform(&point).coords.dot(&along)
        };
        let numeric = (there(1.0) - there(-1.0)) / 2e-5;
        assert!((numeric - rows[0].derivative[i]).abs() < 1e-7, "{i}: {numeric} {}", rows[0].derivative[i]);
    }
}
