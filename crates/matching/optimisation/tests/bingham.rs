//! The thesis's own method on bodies whose outline is known in closed form, and as a stage.

// A test whose set-up fails has failed.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use biplane_artifact::{Calibration, Curves, Match, ModelMesh, Start, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Mesh, Point2, Point3, Pose, Twist, Vector2, Vector3};
use biplane_optimisation::{
    BinghamParams, BinghamView, Descent, MatchBody, MatchError, MatchInputs, MatchParams, Method, best,
    descend, own_contour, spread,
};
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_stage::{Context, Hashed, Stage};

/// Two views at right angles, sources 1000 mm from the middle, 6.7 px a mm there.
fn calibrations() -> [Calibration; 2] {
    let make = |view: &str, source: [f64; 3], right: [f64; 3], forward: [f64; 3]| {
        let row = |v: [f64; 3]| std::array::from_fn(|k| 6700.0 * v[k] + 511.5 * forward[k]);
        Calibration {
            view: view.to_owned(),
            size: [1024, 1024],
            source,
            matrix: [row(right), row([0.0, 0.0, -1.0]), forward],
            distortion: None,
        }
    };
    [
        make("A", [0.0, -1000.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        make("B", [1000.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]),
    ]
}

fn fluoroscopes() -> Vec<Fluoroscope> {
    calibrations().iter().map(Fluoroscope::from).collect()
}

/// Points spread evenly over a ball (golden spiral).
fn ball(radius: f64, count: usize) -> Vec<Point3> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..count)
        .map(|k| {
            let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
            let (r, a) = ((1.0 - z * z).sqrt(), golden * k as f64);
            Point3::new(radius * r * a.cos(), radius * r * a.sin(), radius * z)
        })
        .collect()
}

/// The outline of a ball at `centre`: where planes through the source touch it, exactly.
fn ball_outline(view: &Fluoroscope, centre: &Point3, radius: f64) -> Curves {
    let away = centre - view.source();
    let distance = away.norm();
    let axis = away / distance;
    // The circle of contact: at `middle` on the axis, of radius `wide`.
    let middle = view.source() + axis * (distance - radius * radius / distance);
    let wide = radius * (1.0 - (radius / distance).powi(2)).sqrt();
    let u = axis.cross(&Vector3::new(0.3, 0.5, 0.8)).normalize();
    let v = axis.cross(&u);
    let point = |k: usize| {
        let a = std::f64::consts::TAU * k as f64 / 1000.0;
        let pixel = view.project(&(middle + (u * a.cos() + v * a.sin()) * wide)).unwrap().pixel;
        EdgePoint { position: pixel, direction: Vector2::x(), strength: 1.0, sigma_px: 0.1 }
    };
    Curves(vec![Curve { points: (0..1000).map(point).collect(), closed: true }])
}

/// A ball of 50 mm with 9,500 points, as in the thesis's Table 5.3. Its rotation is free.
#[test]
fn a_ball_is_found_in_two_views_and_across_the_ray_in_one() {
    let (points, centre) = (ball(25.0, 9500), Point3::new(3.0, -4.0, 5.0));
    let views: Vec<BinghamView> = fluoroscopes()
        .into_iter()
        .map(|f| {
            let curves = ball_outline(&f, &centre, 25.0);
            BinghamView::new(f, &curves, 0.15)
        })
        .collect();
    let start =
        Pose::new(nalgebra::UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3), Vector3::new(-4.0, 3.0, -3.0));
    let find = |views: &[BinghamView]| {
        let found = descend(&points, &Point3::origin(), views, &start, &BinghamParams::default());
        assert!(found.converged, "{found:?}");
        (found, found.pose.translation() - centre.coords)
    };
    let (two, off) = find(&views);
    // Points lie up to half their distance (0.9 mm) inside the outline: 25 (1 - cos(0.45 / 25)) = 0.004 mm, and more
    // where a cell has none at the rim.
    assert!(off.norm() < 0.05 && two.objective < 0.2, "{off} {}", two.objective);
    let (_, off) = find(&views[..1]);
    // View A looks along y.
    assert!(off.x.abs() < 0.1 && off.z.abs() < 0.1 && off.y.abs() < 10.0, "{off}");
}

#[test]
fn a_view_without_outline_counts_a_hundred() {
    let [a, b] = fluoroscopes().try_into().unwrap();
    let none = [
        BinghamView::new(a.clone(), &Curves::default(), 0.15),
        BinghamView::new(b, &Curves::default(), 0.15),
    ];
    let params = BinghamParams::default();
    let found = descend(&ball(25.0, 500), &Point3::origin(), &none, &Pose::identity(), &params);
    assert_eq!((found.objective, found.pose), (200.0, Pose::identity()));
    // All points at one pixel: an outline of one point at most. Behind the source: none.
    let contour = ball_outline(&a, &Point3::origin(), 25.0);
    let view = [BinghamView::new(a, &contour, 0.15)];
    for points in [vec![Point3::origin(); 5], vec![Point3::new(0.0, -2000.0, 0.0); 5], vec![]] {
        let found = descend(&points, &Point3::origin(), &view, &Pose::identity(), &params);
        assert_eq!(found.objective, 100.0);
    }
}

#[test]
fn starts_are_seeded_cut_and_begin_with_the_given_one() {
    let params = BinghamParams { starts: 500, ..BinghamParams::default() };
    let (given, origin) = (Pose::identity(), Point3::new(5.0, 0.0, 90.0));
    let starts = params.starts(&given, &origin);
    assert_eq!(starts, params.starts(&given, &origin));
    assert_ne!(starts[1..], BinghamParams { seed: 2, ..params }.starts(&given, &origin)[1..]);
    assert!(starts.len() == 500 && starts[0] == given);
    let (mut most, mut squares) = (0.0_f64, 0.0);
    for start in &starts[1..] {
        let (angles, t) = start.to_thesis(origin.coords);
        for offset in angles.map(f64::to_degrees).into_iter().chain([t.x, t.y, t.z]) {
            most = most.max(offset.abs());
            squares += offset * offset / (6.0 * 499.0);
        }
    }
    // A normal distribution cut at two standard deviations has 0.88 of its deviation.
    assert!(most <= 20.0 + 1e-9 && (8.5..9.1).contains(&squares.sqrt()), "{most} {}", squares.sqrt());
}

#[test]
fn the_lowest_objective_that_converged_is_the_answer_and_the_others_give_the_spread() {
    let descent = |x: f64, objective: f64, converged: bool| Descent {
        pose: Pose::identity(),
        variables: [x, 0.0, 0.0, 0.0, 0.0, 2.0 * x],
        objective,
        calls: 5,
        converged,
    };
    let all = [descent(1.0, 0.5, true), descent(9.0, 0.1, false), descent(3.0, 0.4, true)];
    assert_eq!(best(&all), Some(&all[2]));
    assert_eq!(best(&all[1..2]), Some(&all[1]));
    assert_eq!(best(&[]), None);
    // Of 1 and 3: root 2.
    let root = 2.0_f64.sqrt();
    let found = spread(&all).unwrap();
    assert!((found[0] - root).abs() < 1e-12 && (found[5] - 2.0 * root).abs() < 1e-12 && found[1] == 0.0);
    assert_eq!(spread(&all[..2]), None);
}

#[test]
fn settings_out_of_range_are_named() {
    let name = |params: BinghamParams| match params.check() {
        Err(MatchError::Parameter { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    let d = BinghamParams::default();
    assert_eq!(d.check(), Ok(()));
    assert_eq!(name(BinghamParams { grid: 1, ..d }), "bingham2006.grid");
    assert_eq!(name(BinghamParams { bound_mm: f64::NAN, ..d }), "bingham2006.bound_mm");
    let longer = BinghamParams { last_difference_mm_deg: 2.0, ..d };
    assert_eq!(name(longer), "bingham2006.last_difference_mm_deg");
    let whole = MatchParams { bingham2006: BinghamParams { starts: 0, ..d }, ..MatchParams::default() };
    assert!(matches!(whole.check(), Err(MatchError::Parameter { name: "bingham2006.starts", .. })));
}

/// A ball stretched and bent, without symmetry, about 60 mm long.
fn body() -> Mesh {
    let n = 60;
    let point = |i: usize, j: usize| {
        let a = std::f64::consts::PI * i as f64 / n as f64;
        let b = std::f64::consts::PI * (j % (2 * n)) as f64 / n as f64;
        let s = if i == 0 || i == n { 0.0 } else { a.sin() };
        let d = Vector3::new(s * b.cos(), s * b.sin(), a.cos());
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

/// The stage on the outlines of the body at `truth`, beside them a line that is not the body's.
fn run(truth: &Pose, start: &Pose, own: BinghamParams) -> Match {
    let mesh = body();
    let rim = RimMesh::new(&mesh);
    let fluoroscopes = fluoroscopes();
    let curves = fluoroscopes.iter().map(|f| {
        let mut outline = Outline::new();
        outline.trace(&rim, truth, f, Sampling { step_px: 1.0 });
        // In order round the middle: this body's outline is star-shaped about it.
        let middle = f.project(&truth.transform(rim.centroid())).unwrap().pixel;
        let mut points: Vec<EdgePoint> = outline
            .points()
            .iter()
            .map(|p| EdgePoint { position: p.pixel, direction: p.normal, strength: 20.0, sigma_px: 0.05 })
            .collect();
        let angle = |p: &EdgePoint| (p.position.y - middle.y).atan2(p.position.x - middle.x);
        points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        let far = (0..300).map(|k| EdgePoint {
            position: Point2::new(f64::from(k) + 20.0, 20.0),
            direction: Vector2::y(),
            strength: 20.0,
            sigma_px: 0.05,
        });
        Hashed::new(Curves(vec![
            Curve { points, closed: true },
            Curve { points: far.collect(), closed: false },
        ]))
    });
    let inputs = MatchInputs {
        curves: curves.collect(),
        calibrations: calibrations().into_iter().map(Hashed::new).collect(),
        model: Hashed::new(ModelMesh(mesh)),
        start: vec![Hashed::new(Start(*start))],
        calibration_uncertainty: vec![],
    };
    let params = MatchParams { method: Method::Bingham2006, bingham2006: own, ..MatchParams::default() };
    MatchBody::run(&inputs, &params, &Context::new()).unwrap()
}

fn truth() -> Pose {
    Pose::new(nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.5, 0.9), Vector3::new(4.0, -3.0, 6.0))
}

fn start() -> Pose {
    let twist =
        Twist { translation: Vector3::new(1.0, -2.0, 2.0), rotation: Vector3::new(0.04, 0.02, -0.04) };
    truth().moved(&twist, &truth().transform(&body().area_centroid()))
}

#[test]
fn the_stage_finds_the_pose_as_the_thesis_does() {
    let near = BinghamParams { start_sigma_mm: 2.0, start_sigma_deg: 2.0, ..BinghamParams::default() };
    let own = BinghamParams { starts: 1, ..near };
    let answer = run(&truth(), &start(), own);
    let error = Pose::from(answer.pose).error_against(&truth(), &body().area_centroid());
    let deg = error.rotation_rad.to_degrees();
    assert!(error.translation_mm < 0.05 && deg < 0.5, "{} mm, {deg} degrees", error.translation_mm);
    assert_eq!(answer.verdict, Verdict::Good, "{}", answer.reason);
    assert!(answer.iterations > 100 && answer.iterations < 800, "{}", answer.iterations);
    assert_eq!(answer, run(&truth(), &start(), own));
    // This body is nearly round about its long axis: from some starts a search ends within 0.02 mm, but more than 0.75 degrees off.
    let several = |seed| run(&truth(), &start(), BinghamParams { starts: 3, seed, ..near });
    let doubtful = (1..12).map(several).find(|three| three.verdict == Verdict::Doubtful);
    let three = doubtful.expect("starts that end apart");
    assert!(three.reason.contains("of 3 starts converged"), "{}", three.reason);
    assert!(three.iterations > answer.iterations);
}

#[test]
fn a_search_that_uses_up_its_calls_is_not_called_good() {
    let own = BinghamParams { starts: 2, calls: 30, ..BinghamParams::default() };
    let answer = run(&truth(), &start(), own);
    assert_ne!(answer.verdict, Verdict::Good);
    assert!(answer.reason.contains("did not converge: 30 calls from each of 2 starts"), "{}", answer.reason);
    assert_eq!(answer.iterations, 60);
}

#[test]
fn of_the_curves_those_near_the_outline_that_run_with_it_are_the_bodys() {
    let (mesh, view) = (body(), fluoroscopes().remove(0));
    let rim = RimMesh::new(&mesh);
    let mut outline = Outline::new();
    outline.trace(&rim, &truth(), &view, Sampling { step_px: 1.0 });
    let curve = |shift: f64, sign: f64| {
        let point = |p: &biplane_outline::OutlinePoint| EdgePoint {
            position: p.pixel + p.normal * shift,
            direction: p.normal * sign,
            strength: 20.0,
            sigma_px: 0.05,
        };
        Curve { points: outline.points().iter().map(point).collect(), closed: true }
    };
    let params = MatchParams { search_px: 20.0, ..MatchParams::default() };
    // Near; too far; of the wrong contrast.
    let curves = Curves(vec![curve(5.0, 1.0), curve(60.0, 1.0), curve(5.0, -1.0)]);
    let own = own_contour(&curves, &rim, &view, &truth(), &params);
    assert_eq!(own.0, curves.0[..1]);
}

#[test]
fn a_run_that_is_stopped_says_so() {
    let (mesh, context) = (body(), Context::new());
    context.cancel();
    let inputs = MatchInputs {
        curves: vec![Hashed::new(Curves::default())],
        calibrations: calibrations().into_iter().take(1).map(Hashed::new).collect(),
        model: Hashed::new(ModelMesh(mesh)),
        start: vec![Hashed::new(Start(truth()))],
        calibration_uncertainty: vec![],
    };
    let params = MatchParams { method: Method::Bingham2006, ..MatchParams::default() };
    assert_eq!(MatchBody::run(&inputs, &params, &context), Err(MatchError::Cancelled));
}
