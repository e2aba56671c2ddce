//! The conventions of `docs/conventions.md` that no crate's own tests hold, through the public functions of the crates:
//! numbers come from the example study, from a scene that another program made, or from arithmetic written out here.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use biplane_acquisition::calibration::{read_calibration, read_distortion_csv};
use biplane_artifact::{Calibration, Curves, PixelOrigin, PoseRecord};
use biplane_fluoroscope::{Distortion, Fluoroscope};
use biplane_geometry::{Curve, EdgePoint, Mesh, Point2, Point3, Pose, Rigid, Twist, Vector2, Vector3};
use biplane_optimisation::{Contrast, EdgeField, MatchParams, Refined, View, refine};
use biplane_outline::{Outline, OutlinePoint, RimMesh, Sampling};
use biplane_segmentation::{SegmentParams, find_edges};
use nalgebra::{Matrix4, UnitQuaternion};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn vector(value: &serde_json::Value) -> Vector3 {
    Vector3::from_iterator(value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()))
}

/// `scene.json` of a scene that another program made.
fn scene() -> serde_json::Value {
    json(&root().join("fixtures/scene/scene.json"))
}

// Poses

#[test]
fn a_pose_maps_model_to_world_with_its_scalar_first() {
    // A quarter turn about z: qw = qz = sqrt(1/2) takes x to y. Written with qw >= 0, whichever of the two it was.
    let half = 0.5_f64.sqrt();
    for sign in [1.0, -1.0] {
        let q = nalgebra::Quaternion::new(sign * half, 0.0, 0.0, sign * half);
        let pose = Pose::new(UnitQuaternion::from_quaternion(q), Vector3::new(10.0, 20.0, 30.0));
        let record = PoseRecord::from(pose);
        assert!(
            (record.quaternion_wxyz[0] - half).abs() < 1e-15
                && (record.quaternion_wxyz[3] - half).abs() < 1e-15
        );
        let world = Pose::from(record).transform(&Point3::new(1.0, 0.0, 0.0));
        assert!((world - Point3::new(10.0, 21.0, 30.0)).norm() < 1e-12, "{world}");
    }
}

#[test]
fn frames_are_in_the_type() {
    // Laboratory from model, by way of the other body: only neighbours that match compose.
    let femur: Pose =
        Rigid::new(UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3), Vector3::new(1.0, 2.0, 3.0));
    let tibia: Pose =
        Rigid::new(UnitQuaternion::from_euler_angles(-0.4, 0.5, 0.6), Vector3::new(4.0, 5.0, 6.0));
    let p = Point3::new(7.0, -8.0, 9.0);
    let tibia_from_femur: Rigid<biplane_geometry::Model, biplane_geometry::Model> = tibia.inverse() * femur;
    assert!((tibia.transform(&tibia_from_femur.transform(&p)) - femur.transform(&p)).norm() < 1e-12);
}

#[test]
fn thesis_angles_are_those_of_a_scene_made_elsewhere() {
    let scene = scene();
    let mut count = 0;
    for (body, object) in scene["objects"].as_object().unwrap() {
        for pose in object["poses"].as_array().unwrap() {
            let rows = pose["matrix"].as_array().unwrap();
            let matrix = Matrix4::from_fn(|i, j| rows[i][j].as_f64().unwrap());
            let (angles, t) = (vector(&pose["euler"]) * 1_f64.to_radians(), vector(&pose["t"]));
            let ours = Pose::from_thesis(angles.x, angles.y, angles.z, t, Vector3::zeros());
            let off = (ours.matrix() - matrix).abs().max();
            assert!(off < 1e-12, "{body}: Eq. 3.2 differs from the scene's matrix by {off:e}");
            let (back, t_back) = Pose::from_matrix(&matrix).unwrap().to_thesis(Vector3::zeros());
            assert!((Vector3::from(back) - angles).norm() < 1e-9 && (t_back - t).norm() < 1e-9);
            count += 1;
        }
    }
    assert!(count >= 4, "{count} poses in the scene");
}

#[test]
fn files_carry_the_translation_of_the_model_origin_not_the_one_of_the_thesis() {
    let (o, t) = (Vector3::new(3.0, -8.0, 90.0), Vector3::new(10.0, 20.0, -30.0));
    let pose = Pose::from_thesis(0.4, -0.7, 0.25, t, o);
    let r = pose.rotation();
    assert!((pose.translation() - (o + t - r * o)).norm() < 1e-12);
    // Eq. 3.1 for any point m.
    let m = Vector3::new(-5.0, 6.0, 7.0);
    assert!((pose.transform(&Point3::from(m)).coords - (r * (m - o) + o + t)).norm() < 1e-12);
}

#[test]
fn a_twist_turns_about_a_laboratory_point_then_translates() {
    let pose = Pose::new(UnitQuaternion::from_euler_angles(0.9, -0.4, 2.0), Vector3::new(5.0, 6.0, 7.0));
    let (center, p) = (Point3::new(-3.0, 40.0, 12.0), Point3::new(1.0, 2.0, 3.0));
    let quarter = std::f64::consts::FRAC_PI_2;
    let twist =
        Twist { translation: Vector3::new(100.0, 0.0, 0.0), rotation: Vector3::new(0.0, 0.0, quarter) };
    let (before, after) = (pose.transform(&p), pose.moved(&twist, &center).transform(&p));
    // A quarter turn about the laboratory's z axis takes (x, y) to (-y, x), seen from the centre.
    let arm = before - center;
    let expected = center + Vector3::new(-arm.y, arm.x, arm.z) + Vector3::new(100.0, 0.0, 0.0);
    assert!((after - expected).norm() < 1e-12, "{after} {expected}");
}

#[test]
fn mean_target_error_is_the_mean_distance_of_the_vertices() {
    let reference = Pose::new(UnitQuaternion::from_euler_angles(0.2, 0.1, -0.3), Vector3::new(1.0, 2.0, 3.0));
    let vertices = [Point3::new(0.0, 0.0, 0.0), Point3::new(30.0, 0.0, 0.0), Point3::new(0.0, 0.0, 50.0)];
    // A turn by an angle about the model's z axis moves a vertex by the chord 2 r sin(angle / 2), r its distance from it.
    let angle = 0.1_f64;
    let turned = Pose::new(
        reference.rotation() * UnitQuaternion::from_euler_angles(0.0, 0.0, angle),
        reference.translation(),
    );
    let expected = 2.0 * 30.0 * (angle / 2.0).sin() / 3.0;
    assert!((turned.mean_target_error_mm(&reference, &vertices) - expected).abs() < 1e-12);
    let error = turned.error_against(&reference, &vertices[1]);
    assert!((error.rotation_rad - angle).abs() < 1e-12);
    assert!((error.translation_mm - 3.0 * expected).abs() < 1e-12);
}

// Pictures

/// A picture of 64 x 48 pixels that is dark left of and above a corner: two straight edges.
fn step(bright: impl Fn(usize, usize) -> bool) -> Vec<EdgePoint> {
    let samples = (0..64 * 48).map(|i| if bright(i % 64, i / 64) { 200.0 } else { 50.0 }).collect();
    let points = find_edges(64, 48, samples, &SegmentParams::default()).points;
    points
        .into_iter()
        .filter(|p| (8.0..56.0).contains(&p.position.x) && (8.0..40.0).contains(&p.position.y))
        .collect()
}

#[test]
fn the_first_pixel_has_its_centre_at_zero_and_edges_point_from_dark_to_bright() {
    // Between the centres of columns 19 and 20 lies x = 19.5; rows are stored from the top, y grows downwards.
    let upright = step(|x, _| x >= 20);
    assert!(upright.len() > 20);
    for p in upright {
        assert!((p.position.x - 19.5).abs() < 0.01, "{}", p.position);
        assert!((p.direction - Vector2::new(1.0, 0.0)).norm() < 0.01, "{}", p.direction);
    }
    let level = step(|_, y| y < 30);
    assert!(level.len() > 20);
    for p in level {
        assert!((p.position.y - 29.5).abs() < 0.01, "{}", p.position);
        assert!((p.direction - Vector2::new(0.0, -1.0)).norm() < 0.01, "{}", p.direction);
    }
}

#[test]
fn the_example_studys_detector_is_read_as_its_simulator_describes_it() {
    let path = root().join("fixtures/knee/truth/fluoroscopes.json");
    let file = json(&path);
    let pixel = file["pixel_mm"].as_f64().unwrap();
    for view in ["A", "B"] {
        let f = &file["fluoroscopes"][view];
        let [source, centre, u, v] = ["source", "centre", "u", "v"].map(|key| vector(&f[key]));
        let fluoroscope = Fluoroscope::from(&read_calibration(&path, view, PixelOrigin::Centre).unwrap());
        assert!((fluoroscope.source().coords - source).norm() < 1e-9);
        for (x, y) in [(0.0, 0.0), (1023.0, 0.0), (511.5, 511.5), (300.25, 900.75)] {
            // The file's own words: "ideal pixel (0,0) is the centre of the first pixel; detector point = centre +
            // ((x-511.5) u + (y-511.5) v) * pixel_mm".
            let on_detector = centre + (u * (x - 511.5) + v * (y - 511.5)) * pixel;
            // Any point of the ray appears there.
            let halfway = Point3::from((source + on_detector) / 2.0);
            let p = fluoroscope.project(&halfway).unwrap();
            assert!((p.pixel - Point2::new(x, y)).norm() < 1e-8, "{view}: {} for ({x}, {y})", p.pixel);
            assert!((p.depth - f["l"].as_f64().unwrap() / 2.0).abs() < 1e-6, "depth is along the normal, mm");
        }
        // x right, y down, and the third axis away from the source: the picture is seen from the source.
        assert!(u.cross(&v).dot(&(centre - source)) > 0.0 && !fluoroscope.keeps_orientation());
    }
}

#[test]
fn distortion_maps_recorded_to_ideal_pixels() {
    let path = root().join("fixtures/knee/truth/distortion_A.csv");
    let table = read_distortion_csv(&path).unwrap();
    let distortion = Distortion::from(&table);
    let text = std::fs::read_to_string(&path).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next().unwrap().trim(), "distorted_x_px,distorted_y_px,ideal_x_px,ideal_y_px");
    for line in lines.step_by(97) {
        let n: Vec<f64> = line.split(',').map(|t| t.trim().parse().unwrap()).collect();
        let (recorded, ideal) = (Point2::new(n[0], n[1]), Point2::new(n[2], n[3]));
        // The grid's values are printed with four decimals.
        assert!((distortion.ideal(&recorded) - ideal).norm() < 1e-3, "{line}");
        assert!((distortion.recorded(&ideal).unwrap() - recorded).norm() < 1e-3, "{line}");
    }
}

#[test]
fn edges_are_carried_into_ideal_pixels_with_their_direction() {
    let table = read_distortion_csv(root().join("fixtures/knee/truth/distortion_B.csv")).unwrap();
    let distortion = Distortion::from(&table);
    let tangent = Vector2::new(0.6, 0.8);
    let direction = Vector2::new(0.8, -0.6);
    for k in 0..20 {
        let position = Point2::new(150.0 + 37.0 * k as f64, 900.0 - 31.0 * k as f64);
        let point = EdgePoint { position, direction, strength: 5.0, sigma_px: 0.1 };
        let corrected = distortion.correct(&Curve { points: vec![point], closed: false }).points[0];
        assert!((corrected.position - distortion.ideal(&position)).norm() < 1e-12);
        // Across the edge stays across it, and bright stays on the same side.
        let along =
            distortion.ideal(&(position + tangent * 0.01)) - distortion.ideal(&(position - tangent * 0.01));
        let across = distortion.ideal(&(position + direction * 0.01)) - distortion.ideal(&position);
        assert!(along.normalize().dot(&corrected.direction).abs() < 1e-4);
        assert!((corrected.direction.norm() - 1.0).abs() < 1e-12 && across.dot(&corrected.direction) > 0.0);
    }
}

// Matching

/// A knotty spindle along x, 60 mm long and about 30 and 16 mm thick, its centre at `centre` of its model's frame.
fn spindle(centre: Vector3) -> Mesh {
    let n = 48;
    let point = |i: usize, j: usize| {
        let polar = std::f64::consts::PI * i as f64 / n as f64;
        let around = std::f64::consts::TAU * (j % n) as f64 / n as f64;
        // No ellipsoid, whose outline is an ellipse and does not tell of six motions.
        let across = if i == 0 || i == n { 0.0 } else { polar.sin() * (1.0 + 0.3 * (3.0 * polar).cos()) };
        Point3::new(30.0 * polar.cos(), 15.0 * across * around.cos(), 8.0 * across * around.sin()) + centre
    };
    let quads = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let soup: Vec<[Point3; 3]> = quads
        .flat_map(|(i, j)| {
            let (a, b, c, d) = (point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
            [[a, b, c], [a, c, d]]
        })
        .collect();
    Mesh::from_soup(&soup).unwrap()
}

/// Looks along the laboratory's z axis, 8 px per mm at the origin.
fn along_z() -> Fluoroscope {
    Fluoroscope::from(&Calibration {
        view: "A".to_owned(),
        size: [1024, 1024],
        source: [0.0, 0.0, -1000.0],
        matrix: [[8000.0, 0.0, 511.5], [0.0, 8000.0, 511.5], [0.0, 0.0, 1.0]],
        distortion: None,
    })
}

/// Looks along the laboratory's y axis.
fn along_y() -> Fluoroscope {
    Fluoroscope::from(&Calibration {
        view: "B".to_owned(),
        size: [1024, 1024],
        source: [0.0, -1000.0, 0.0],
        matrix: [[8000.0, 511.5, 0.0], [0.0, 511.5, -8000.0], [0.0, 1.0, 0.0]],
        distortion: None,
    })
}

/// What a descent makes of the edges of a dark body, `inside(x)` px within its outline at `x` from its centroid (model axes).
fn matched(
    mesh: &Mesh,
    truth: &Pose,
    fluoroscopes: &[Fluoroscope],
    inside: impl Fn(&Vector3) -> f64,
    contrast: Contrast,
) -> Refined {
    let (rim, mut outline) = (RimMesh::new(mesh), Outline::new());
    let mut views = Vec::new();
    for fluoroscope in fluoroscopes {
        outline.trace(&rim, truth, fluoroscope, Sampling { step_px: 1.0 });
        assert!(outline.length_px() > 200.0);
        // In order round the middle: these outlines are star-shaped about it.
        let middle = fluoroscope.project(&truth.transform(rim.centroid())).unwrap().pixel;
        let angle = |p: &OutlinePoint| (p.pixel.y - middle.y).atan2(p.pixel.x - middle.x);
        let mut around = outline.points().to_vec();
        around.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        let at = |p: &OutlinePoint| truth.inverse().transform(&p.world) - rim.centroid();
        let points = around.iter().map(|p| EdgePoint {
            position: p.pixel - p.normal * inside(&at(p)),
            // From dark to bright: outward.
            direction: p.normal,
            strength: 10.0,
            sigma_px: 0.1,
        });
        let curves = Curves(vec![Curve { points: points.collect(), closed: true }]);
        views.push(View { edges: EdgeField::new(&curves, None), fluoroscope: fluoroscope.clone() });
    }
    let params = MatchParams { search_px: 10.0, contrast, ..MatchParams::default() };
    refine(&rim, &views, truth, &params.search())
}

#[test]
fn a_positive_inset_means_edges_inside_the_outline() {
    let truth = Pose::new(UnitQuaternion::from_euler_angles(0.1, -0.2, 0.3), Vector3::new(4.0, -3.0, 0.0));
    for inside in [0.4, -0.3] {
        let mesh = spindle(Vector3::zeros());
        let refined = matched(&mesh, &truth, &[along_z(), along_y()], |_| inside, Contrast::Dark);
        for evidence in &refined.evidence {
            assert!((evidence.inset_px - inside).abs() < 0.05, "{} px for {inside} px", evidence.inset_px);
        }
    }
}

#[test]
fn a_dark_body_finds_edges_that_brighten_outward_alone() {
    let (mesh, truth) = (spindle(Vector3::zeros()), Pose::identity());
    let evidence = matched(&mesh, &truth, &[along_z()], |_| 0.0, Contrast::Dark).evidence[0];
    assert!(evidence.matched_px > 0.95 * evidence.in_image_px, "{evidence:?}");
    let other = matched(&mesh, &truth, &[along_z()], |_| 0.0, Contrast::Bright).evidence[0];
    assert!(other.in_image_px > 0.0 && other.matched_px == 0.0, "{other:?}");
}

#[test]
fn covariance_is_translation_then_rotation_along_laboratory_axes_at_the_centroid() {
    // Edges are off by a wave along the outline, the same one each time: how it spreads over the six is the shape's doing.
    let sigma = |mesh: &Mesh, truth: &Pose| {
        let refined = matched(
            mesh,
            truth,
            &[along_z()],
            |x| 0.2 * (2.0 * x.dot(&Vector3::new(1.0, 2.0, 3.0))).sin(),
            Contrast::Dark,
        );
        let c = refined.covariance.unwrap();
        std::array::from_fn::<f64, 6, _>(|i| c[(i, i)].sqrt())
    };
    let mesh = spindle(Vector3::zeros());
    // Tilted, so that an outline tells of every turn.
    let tilt = UnitQuaternion::from_euler_angles(0.8, 0.15, 0.0);
    let level = sigma(&mesh, &Pose::new(tilt, Vector3::zeros()));
    // Seen along z, the depth is held least of the three translations; of the turns, that in the picture's plane best.
    assert!(level[2] > 3.0 * level[0].max(level[1]), "{level:?}");
    assert!(level[5] < 0.7 * level[3].min(level[4]), "{level:?}");
    // Turned so that its long axis is the laboratory's y: x and y change places, whatever the model's axes are called.
    let quarter = UnitQuaternion::from_euler_angles(0.0, 0.0, std::f64::consts::FRAC_PI_2);
    let upright = sigma(&mesh, &Pose::new(quarter * tilt, Vector3::zeros()));
    for (a, b) in [(0, 1), (1, 0), (2, 2), (3, 4), (4, 3), (5, 5)] {
        assert!((level[a] / upright[b] - 1.0).abs() < 0.1, "{a} {b}: {level:?} {upright:?}");
    }
    let differ = |a: f64, b: f64| (a / b - 1.0).abs() > 0.2;
    assert!(
        differ(level[0], level[1]) && differ(level[3], level[4]),
        "too round to tell axes apart: {level:?}"
    );
    // The same body with its model's origin 500 mm away: its centroid is where it was, and known as well.
    let shift = Vector3::new(0.0, 500.0, 0.0);
    let far = sigma(&spindle(shift), &Pose::new(tilt, -(tilt * shift)));
    for i in 0..6 {
        assert!((level[i] / far[i] - 1.0).abs() < 0.02, "{i}: {level:?} {far:?}");
    }
}
