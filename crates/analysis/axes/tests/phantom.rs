//! Proposals on bodies whose condyles, shafts, plates and planes are known, and on the same bodies turned, mirrored, meshed anew, cut and
//! spoilt. Run with `--nocapture` for the figures.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use biplane_artifact::{AxesFeature, AxesSource, BodyAxes, BodyKind, Side};
use biplane_axes::{AxesError, AxesParams, ModelFrame, body_axes};
use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_phantom::{Ball, Body, DistalFemur, ProximalTibia, Solid, mesh};
use biplane_stage::Context;
use nalgebra::{Matrix3, Rotation3, Unit};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

const BODIES: [(Body, BodyKind); 5] = [
    (Body::DistalFemur, BodyKind::Femur),
    (Body::ProximalTibia, BodyKind::Tibia),
    (Body::Patella, BodyKind::Patella),
    (Body::FemoralComponent, BodyKind::FemoralComponent),
    (Body::TibialTray, BodyKind::TibialTray),
];

fn params(body: BodyKind, side: Side) -> AxesParams {
    AxesParams { body, side: Some(side), frame: ModelFrame::Unknown }
}

fn right(mesh: &Mesh, body: BodyKind) -> BodyAxes {
    body_axes(mesh, &[], &params(body, Side::Right), &Context::new()).unwrap()
}

fn moved(mesh: &Mesh, to: impl Fn(&Vector3) -> Vector3, flip: bool) -> Mesh {
    let vertices = mesh.vertices().iter().map(|v| Point3::from(to(&v.coords))).collect();
    let triangles = mesh.triangles().iter().map(|&[a, b, c]| if flip { [a, c, b] } else { [a, b, c] });
    Mesh::new(vertices, triangles.collect()).unwrap()
}

fn axes(found: &BodyAxes) -> [Vector3; 3] {
    found.axes.map(Vector3::from)
}

fn origin(found: &BodyAxes) -> Vector3 {
    Vector3::from(found.origin_mm)
}

/// Angle between two frames, degrees: small ones too.
fn angle(a: &[Vector3; 3], b: &[Vector3; 3]) -> f64 {
    let turn = Matrix3::from_columns(a).transpose() * Matrix3::from_columns(b);
    let skew =
        Vector3::new(turn[(2, 1)] - turn[(1, 2)], turn[(0, 2)] - turn[(2, 0)], turn[(1, 0)] - turn[(0, 1)])
            / 2.0;
    skew.norm().atan2((turn.trace() - 1.0) / 2.0).to_degrees()
}

fn between(a: &Vector3, b: &Vector3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b)).to_degrees()
}

fn random_turn(random: &mut Xoshiro256PlusPlus) -> Rotation3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
        if (0.1..1.0).contains(&v.norm()) {
            return Rotation3::from_axis_angle(
                &Unit::new_normalize(v),
                random.random_range(0.0..std::f64::consts::PI),
            );
        }
    }
}

/// Median, 95 % and worst.
fn distribution(mut all: Vec<f64>) -> [f64; 3] {
    all.sort_by(f64::total_cmp);
    let at = |s: f64| all[((all.len() - 1) as f64 * s).ceil() as usize];
    [at(0.5), at(0.95), at(1.0)]
}

#[test]
fn axes_are_orthonormal_and_right_handed_and_made_of_something() {
    for (body, kind) in BODIES {
        let found = right(&mesh(body.solid(), 2_500).unwrap(), kind);
        let [x, y, z] = axes(&found);
        assert!((x.cross(&y) - z).norm() < 1e-12 && (x.norm() - 1.0).abs() < 1e-12, "{kind:?}");
        assert!(x.dot(&y).abs() < 1e-12 && (y.norm() - 1.0).abs() < 1e-12, "{kind:?}");
        assert_eq!((found.source, found.body, found.side), (AxesSource::Shape, kind, Side::Right));
        assert!(found.features.len() >= 3, "{kind:?}: {:?}", found.features);
    }
}

/// Poses of a mesh.
const POSES: usize = 40;

/// The mesh is turned and moved, and the axes with it.
fn turned(body: Body, kind: BodyKind) {
    let mesh = mesh(body.solid(), 1_500).unwrap();
    let still = right(&mesh, kind);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(6);
    let (mut degrees, mut millimetres) = (Vec::new(), Vec::new());
    for _ in 0..POSES {
        let turn = random_turn(&mut random);
        let shift = Vector3::from_fn(|_, _| random.random_range(-300.0..300.0));
        let found = right(&moved(&mesh, |v| turn * v + shift, false), kind);
        degrees.push(angle(&axes(&found), &axes(&still).map(|a| turn * a)));
        millimetres.push((origin(&found) - (turn * origin(&still) + shift)).norm());
        assert_eq!(found.warnings, still.warnings);
    }
    let [degrees, millimetres] = [degrees, millimetres].map(distribution);
    println!("{kind:?} in {POSES} poses: {degrees:.6?} degrees, {millimetres:.6?} mm (median, 95 %, worst)");
    assert!(degrees[2] < 0.01 && millimetres[2] < 0.01, "{kind:?}: {degrees:?} {millimetres:?}");
}

#[test]
fn a_turned_femur_has_turned_axes() {
    turned(Body::DistalFemur, BodyKind::Femur);
}

#[test]
fn a_turned_tibia_has_turned_axes() {
    turned(Body::ProximalTibia, BodyKind::Tibia);
}

#[test]
fn a_turned_patella_has_turned_axes() {
    turned(Body::Patella, BodyKind::Patella);
}

#[test]
fn a_turned_femoral_component_has_turned_axes() {
    turned(Body::FemoralComponent, BodyKind::FemoralComponent);
}

#[test]
fn a_turned_tray_has_turned_axes() {
    turned(Body::TibialTray, BodyKind::TibialTray);
}

#[test]
fn a_mirrored_body_of_the_other_side_has_mirrored_axes() {
    let mirror = |v: &Vector3| Vector3::new(-v.x, v.y, v.z);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    for (body, kind) in BODIES {
        let turn = random_turn(&mut random);
        let mesh =
            moved(&mesh(body.solid(), 1_500).unwrap(), |v| turn * v + Vector3::new(90.0, 0.0, 5.0), false);
        let still = right(&mesh, kind);
        let left =
            body_axes(&moved(&mesh, mirror, true), &[], &params(kind, Side::Left), &Context::new()).unwrap();
        let [x, y, z] = axes(&still).map(|a| mirror(&a));
        // z points to the right on both sides: laterally on the right, medially on the left.
        let off = angle(&axes(&left), &[x, y, -z]);
        let far = (origin(&left) - mirror(&origin(&still))).norm();
        assert!(off < 1e-6 && far < 1e-6, "{kind:?}: {off} degrees, {far} mm");
        assert_eq!(left.warnings, still.warnings);
        assert_eq!(left.side, Side::Left);
    }
}

/// Deviations from what the phantom's bodies were built from, over meshes of 1,500 to 36,000 points.
struct Truth {
    x: Vector3,
    y: Vector3,
    origin: Vector3,
    /// Degrees and mm that the worst of the meshes may have: x or y, origin.
    limits: [f64; 2],
}

fn against(body: Body, kind: BodyKind, truth: &Truth) -> Vec<BodyAxes> {
    let all: Vec<BodyAxes> = [1_500, 2_500, 3_500, 6_000, 10_000, 15_000, 36_000]
        .map(|points| right(&mesh(body.solid(), points).unwrap(), kind))
        .into();
    let dev = |f: &dyn Fn(&BodyAxes) -> f64| distribution(all.iter().map(f).collect());
    let x = dev(&|a| between(&axes(a)[0], &truth.x));
    let y = dev(&|a| between(&axes(a)[1], &truth.y));
    let o = dev(&|a| (origin(a) - truth.origin).norm());
    println!(
        "{kind:?} against its construction: x {x:.2?} degrees, y {y:.2?} degrees, origin {o:.2?} mm (median, 95 %, worst)"
    );
    assert!(x[2] < truth.limits[0] && y[2] < truth.limits[0] && o[2] < truth.limits[1], "{kind:?}");
    // Meshed anew: 3,500, 15,000 and 36,000 points.
    let last = &all[6];
    let off = [&all[2], &all[5]].map(|a| angle(&axes(a), &axes(last)));
    let far = [&all[2], &all[5]].map(|a| (origin(a) - origin(last)).norm());
    println!("{kind:?} of 3,500 and of 15,000 points against 36,000: {off:.3?} degrees, {far:.3?} mm");
    assert!(off.iter().all(|v| *v < 0.35) && far.iter().all(|v| *v < 0.2), "{kind:?}: {off:?} {far:?}");
    all
}

fn cylinders(found: &BodyAxes) -> Vec<f64> {
    let radius = |f: &AxesFeature| match f {
        AxesFeature::Cylinder { radius_mm, .. } => Some(*radius_mm),
        _ => None,
    };
    found.features.iter().filter_map(radius).collect()
}

#[test]
fn femur_condyles_and_shaft_are_those_it_is_built_from() {
    // The middles of the posterior capsules, and the shaft's axis made square to the line through them.
    let (medial, lateral) = (Vector3::new(-21.5, -15.5, -26.0), Vector3::new(22.0, -14.0, -25.0));
    let z = (lateral - medial).normalize();
    let shaft = Vector3::new(2.0, 2.0, 85.0);
    let y = (shaft - z * shaft.dot(&z)).normalize();
    let truth = Truth { x: y.cross(&z), y, origin: (medial + lateral) / 2.0, limits: [2.5, 0.8] };
    for found in against(Body::DistalFemur, BodyKind::Femur, &truth) {
        let radii = cylinders(&found);
        // Built from radii of 17 and 16.5 mm, whose blends with their neighbours stand out a little.
        assert!((radii[0] - 17.0).abs() < 1.0 && (radii[1] - 16.5).abs() < 0.5, "{radii:?}");
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    }
}

#[test]
fn tibia_plateau_and_shaft_are_those_it_is_built_from() {
    let y = Vector3::new(2.0, 2.0, 80.0).normalize();
    // The line through the plateau's lobes, square to the shaft.
    let lobes = Vector3::new(28.5, -1.5, 0.0);
    let z = (lobes - y * lobes.dot(&y)).normalize();
    // Upper face of the plate, 8 mm above its middle plane, between the lobes.
    let truth = Truth { x: y.cross(&z), y, origin: Vector3::new(0.25, -0.25, 36.1), limits: [2.5, 2.0] };
    for found in against(Body::ProximalTibia, BodyKind::Tibia, &truth) {
        let plane = found.features.iter().find_map(|f| match f {
            AxesFeature::Plane { normal, .. } => Some(Vector3::from(*normal)),
            _ => None,
        });
        let off = between(&plane.unwrap(), &Vector3::new(0.0, 0.1, 0.99_f64.sqrt()));
        println!("  the plateau's plane: {off:.2} degrees");
        assert!(off < 1.5, "{off}");
    }
}

#[test]
fn patella_axes_are_near_those_it_is_built_from() {
    let truth =
        Truth { x: Vector3::y(), y: Vector3::z(), origin: Vector3::new(0.0, 0.0, 0.0), limits: [5.0, 1.5] };
    against(Body::Patella, BodyKind::Patella, &truth);
}

#[test]
fn femoral_component_planes_and_condyles_are_those_it_is_built_from() {
    let truth =
        Truth { x: Vector3::y(), y: Vector3::z(), origin: Vector3::new(0.0, -9.0, -5.0), limits: [0.2, 0.4] };
    against(Body::FemoralComponent, BodyKind::FemoralComponent, &truth);
}

#[test]
fn tray_plate_and_mirror_plane_are_those_it_is_built_from() {
    // The upper face lies 2.5 mm above the plate's middle.
    let truth =
        Truth { x: Vector3::y(), y: Vector3::z(), origin: Vector3::new(0.0, 1.2, 16.0), limits: [0.3, 0.3] };
    against(Body::TibialTray, BodyKind::TibialTray, &truth);
}

#[test]
fn a_bone_in_the_scanners_frame_follows_it() {
    let lps = Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(8);
    for (body, kind) in &BODIES[..3] {
        let mesh = mesh(body.solid(), 2_500).unwrap();
        let still = right(&mesh, *kind);
        for _ in 0..5 {
            let axis = Unit::new_normalize(Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)));
            let turn = Rotation3::from_axis_angle(&axis, 0.35) * lps;
            let params = AxesParams { frame: ModelFrame::Lps, ..params(*kind, Side::Right) };
            let found = body_axes(&moved(&mesh, |v| turn * v, false), &[], &params, &Context::new()).unwrap();
            let off = angle(&axes(&found), &axes(&still).map(|a| turn * a));
            assert!(off < 0.5, "{kind:?}: {off} degrees");
            assert!(!found.warnings.iter().any(|w| w.contains("scanner")), "{:?}", found.warnings);
        }
        // On its head: the frame is believed, and the disagreement is said or the shape refused.
        let upside = Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI) * lps;
        let params = AxesParams { frame: ModelFrame::Lps, ..params(*kind, Side::Right) };
        match body_axes(&moved(&mesh, |v| upside * v, false), &[], &params, &Context::new()) {
            Err(AxesError::Shape { .. }) => {}
            Ok(found) => assert!(!found.warnings.is_empty(), "{kind:?}"),
            Err(other) => panic!("{other}"),
        }
    }
}

#[test]
fn a_body_given_as_one_of_the_other_side_is_told() {
    for (body, kind) in [BODIES[0], BODIES[1], BODIES[3]] {
        let mesh = mesh(body.solid(), 3_500).unwrap();
        let wrong = body_axes(&mesh, &[], &params(kind, Side::Left), &Context::new()).unwrap();
        println!("{kind:?} of a right knee given as left: {:?}", wrong.warnings);
        assert!(wrong.warnings.iter().any(|w| w.contains("other side")), "{kind:?}");
        let said = right(&mesh, kind).warnings;
        assert!(!said.iter().any(|w| w.contains("other side")), "{kind:?}: {said:?}");
    }
}

/// The triangles of a mesh that lie below a height.
fn below(mesh: &Mesh, height: f64) -> Mesh {
    let keep = |t: &&[u32; 3]| t.iter().all(|&v| mesh.vertices()[v as usize].z < height);
    Mesh::new(mesh.vertices().to_vec(), mesh.triangles().iter().filter(keep).copied().collect()).unwrap()
}

#[test]
fn cut_open_coarse_and_strange_bodies_are_refused_or_doubted() {
    let femur = mesh(Body::DistalFemur.solid(), 3_500).unwrap();
    let run = |mesh: &Mesh, kind| body_axes(mesh, &[], &params(kind, Side::Right), &Context::new());
    let still = axes(&right(&femur, BodyKind::Femur));
    // Cut ever lower, and open above.
    for height in [45.0, 30.0, 20.0, 10.0, 0.0, -10.0, -20.0] {
        match run(&below(&femur, height), BodyKind::Femur) {
            Ok(found) => {
                let off = angle(&axes(&found), &still);
                println!("femur cut at {height} mm: {off:.1} degrees, {:?}", found.warnings);
                assert!(!found.warnings.is_empty(), "open at least");
                assert!(
                    off < 4.0 || found.warnings.len() > 1,
                    "a wrong answer has to be doubted: {off} degrees"
                );
            }
            Err(AxesError::Shape { why, .. }) => println!("femur cut at {height} mm: {why}"),
            Err(other) => panic!("{other}"),
        }
    }
    let coarse = Mesh::new(femur.vertices().to_vec(), femur.triangles()[..50].to_vec()).unwrap();
    let ball = mesh(&Ball { centre: Point3::origin(), radius: 30.0 }, 2_500).unwrap();
    for (_, kind) in BODIES {
        assert!(matches!(run(&coarse, kind), Err(AxesError::Shape { .. })), "{kind:?} of 50 triangles");
        let found = run(&ball, kind);
        println!("a ball as {kind:?}: {:?}", found.as_ref().map(|f| &f.warnings));
        assert!(matches!(found, Err(AxesError::Shape { .. })), "a ball is no {kind:?}");
    }
    // What is one body and said to be another.
    for (body, _) in BODIES {
        let mesh = mesh(body.solid(), 2_500).unwrap();
        for (own, kind) in BODIES {
            match run(&mesh, kind) {
                Ok(found) if own != body => println!("{body:?} as {kind:?}: {:?}", found.warnings),
                Err(AxesError::Shape { why, .. }) if own != body => println!("{body:?} as {kind:?}: {why}"),
                Ok(_) => {}
                Err(other) => panic!("{other}"),
            }
        }
    }
}

#[test]
fn noise_on_the_surface_moves_the_axes_little() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    for ((body, kind), most) in BODIES.into_iter().zip([1.0, 1.0, 3.0, 1.0, 1.0]) {
        let mesh = mesh(body.solid(), 6_000).unwrap();
        let still = right(&mesh, kind);
        let spoilt = mesh.vertices().iter().map(|v| {
            // As of a segmentation for bones, as of a scanner for metal.
            let most =
                if matches!(kind, BodyKind::FemoralComponent | BodyKind::TibialTray) { 0.05 } else { 0.25 };
            v + Vector3::from_fn(|_, _| random.random_range(-most..most))
        });
        let spoilt = Mesh::new(spoilt.collect(), mesh.triangles().to_vec()).unwrap();
        let found = right(&spoilt, kind);
        let off = angle(&axes(&found), &axes(&still));
        let far = (origin(&found) - origin(&still)).norm();
        println!("{kind:?} with noise on its vertices: {off:.2} degrees, {far:.2} mm");
        assert!(off < most && far < 1.0, "{kind:?}: {off} degrees, {far} mm");
    }
}

/// Distance from the line between two places, beyond a radius.
fn rod(p: &Point3, a: [f64; 3], b: [f64; 3], radius: f64) -> f64 {
    let (a, b) = (Vector3::from(a), Vector3::from(b));
    let s = ((p.coords - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
    (p.coords - a - (b - a) * s).norm() - radius
}

/// The phantom's distal femur with a shaft of 360 mm, a neck and a head.
struct WholeFemur;

const HEAD: [f64; 3] = [-38.0, 12.0, 395.0];

impl Solid for WholeFemur {
    fn value(&self, p: &Point3) -> f64 {
        let shaft = rod(p, [2.0, 4.0, 40.0], [10.0, 6.0, 350.0], 14.0);
        let neck = rod(p, [8.0, 6.0, 345.0], HEAD, 15.0);
        let trochanter = rod(p, [18.0, 4.0, 360.0], [20.0, 2.0, 375.0], 16.0);
        let head = (p.coords - Vector3::from(HEAD)).norm() - 24.0;
        DistalFemur.value(p).min(shaft).min(neck).min(trochanter).min(head)
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::new(-65.0, -38.0, -50.5), Point3::new(50.0, 40.0, 420.0))
    }
}

/// The phantom's proximal tibia with a shaft of 330 mm and an ankle.
struct WholeTibia;

impl Solid for WholeTibia {
    fn value(&self, p: &Point3) -> f64 {
        let shaft = rod(p, [-1.0, -3.0, -45.0], [-4.0, -6.0, -300.0], 12.0);
        let ankle = rod(p, [-8.0, -6.0, -310.0], [4.0, -6.0, -310.0], 17.0);
        ProximalTibia.value(p).min(shaft).min(ankle)
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::new(-41.0, -29.0, -328.0), Point3::new(41.0, 29.0, 44.0))
    }
}

#[test]
fn whole_bones_have_their_mechanical_axes() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(10);
    let turn = random_turn(&mut random);
    let femur = right(&moved(&mesh(&WholeFemur, 6_000).unwrap(), |v| turn * v, false), BodyKind::Femur);
    let middle = (Vector3::new(-21.5, -15.5, -26.0) + Vector3::new(22.0, -14.0, -25.0)) / 2.0;
    let off = between(&axes(&femur)[1], &(turn * (Vector3::from(HEAD) - middle)));
    let head = femur.features.iter().find_map(|f| match f {
        AxesFeature::Sphere { centre_mm, radius_mm, .. } => Some((Vector3::from(*centre_mm), *radius_mm)),
        _ => None,
    });
    let (centre, radius) = head.unwrap();
    let far = (centre - turn * Vector3::from(HEAD)).norm();
    println!("whole femur: mechanical axis {off:.3} degrees, head {far:.3} mm and {radius:.3} mm of 24");
    assert!(off < 0.2 && far < 0.2 && (radius - 24.0).abs() < 0.2);
    assert!(axes(&femur)[0].dot(&(turn * Vector3::y())) > 0.99, "anterior: {:?}", femur.axes);
    assert!(femur.warnings.is_empty(), "{:?}", femur.warnings);

    let tibia = right(&moved(&mesh(&WholeTibia, 6_000).unwrap(), |v| turn * v, false), BodyKind::Tibia);
    let axis = Vector3::new(0.25, -0.25, 36.1) - Vector3::new(-2.0, -6.0, -310.0);
    let off = between(&axes(&tibia)[1], &(turn * axis));
    println!("whole tibia: mechanical axis {off:.3} degrees");
    assert!(off < 0.5 && axes(&tibia)[0].dot(&(turn * Vector3::y())) > 0.99, "{:?}", tibia.axes);
    assert!(tibia.warnings.is_empty(), "{:?}", tibia.warnings);
}
