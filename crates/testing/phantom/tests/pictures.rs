//! X-ray pictures against what geometry and statistics say they must be.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use biplane_artifact::Frame;
use biplane_geometry::{Mesh, Point2, Point3, Pose, Twist, Vector2, Vector3};
use biplane_phantom::{
    Absorber, Ball, Ellipsoid, Exposure, IntensifierDistortion, PictureError, PosedBody, Scene, Surface,
    Transmission, TrueFluoroscope, biplane, picture,
};
use nalgebra::UnitQuaternion;

/// A ball's mesh: an octahedron whose sides are parted in four `rounds` times, its corners on the ball.
fn ball_mesh(radius: f64, rounds: usize) -> Mesh {
    let v = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    let mut soup = Vec::new();
    for octant in 0..8 {
        let s = |axis: usize| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 };
        let (a, b, c) = (v(s(0), 0.0, 0.0), v(0.0, s(1), 0.0), v(0.0, 0.0, s(2)));
        soup.push(if s(0) * s(1) * s(2) > 0.0 { [a, b, c] } else { [a, c, b] });
    }
    for _ in 0..rounds {
        soup = soup
            .iter()
            .flat_map(|&[a, b, c]| {
                let m = |p: Point3, q: Point3| Point3::from((p.coords + q.coords).normalize());
                let (ab, bc, ca) = (m(a, b), m(b, c), m(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    Mesh::from_soup(&soup.iter().map(|t| t.map(|p| p * radius)).collect::<Vec<_>>()).unwrap()
}

/// A box about the origin, 12 triangles wound outward.
fn box_mesh(size: Vector3) -> Mesh {
    let v = |i: usize| {
        let side = |axis: usize| size[axis] * (0.5 - f64::from(u8::from(i >> axis & 1 == 0)));
        Point3::new(side(0), side(1), side(2))
    };
    let soup: Vec<_> = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .iter()
        .flat_map(|q| [[v(q[0]), v(q[1]), v(q[2])], [v(q[0]), v(q[2]), v(q[3])]])
        .collect();
    Mesh::from_soup(&soup).unwrap()
}

/// A view with larger pixels, so that a test looks at fewer.
fn small_view() -> TrueFluoroscope {
    TrueFluoroscope { pixel_mm: 315.0 / 256.0, size: [256, 256], ..biplane(90.0)[0].clone() }
}

fn mirrored(view: TrueFluoroscope) -> TrueFluoroscope {
    TrueFluoroscope { along_x: -view.along_x, ..view }
}

fn one(surface: Surface, attenuation_per_mm: f64, pose: Pose) -> Scene {
    let absorber = Absorber { surface, attenuation_per_mm };
    Scene { bodies: vec![PosedBody::at_rest(pose, vec![absorber])], tissue: Vec::new() }
}

/// A quarter of the pixels have one ray through their middle.
fn single_rays() -> Exposure {
    Exposure { samples_per_px: 1, ..Exposure::ideal() }
}

/// Length of the ray of each pixel in a surface, mm, from a weak absorber's transmission.
fn lengths(surface: Surface, pose: Pose, view: &TrueFluoroscope) -> Vec<f64> {
    let scene = one(surface, 0.01, pose);
    let through = Transmission::of_scene(&scene, view, &single_rays()).unwrap();
    through.values.iter().map(|t| -f64::from(*t).ln() / 0.01).collect()
}

fn oblique(k: usize) -> Pose {
    let s = k as f64;
    Pose::new(
        UnitQuaternion::from_euler_angles(0.7 * s, 1.3 * s, 0.4 - s),
        Vector3::new(20.0 * s.sin(), 60.0 * (2.0 * s).cos(), -15.0 * s.cos()),
    )
}

/// Length inside a ball of the ray of a pixel, mm: the chord of the ray's distance from the centre.
fn chord(view: &TrueFluoroscope, pixel: &Point2, ball: &Ball) -> f64 {
    let ray = view.ray(pixel);
    let distance = (ball.centre - view.source).cross(&ray).norm();
    2.0 * (ball.radius * ball.radius - distance * distance).max(0.0).sqrt()
}

#[test]
fn a_ball_has_its_chords() {
    for view in [small_view(), mirrored(small_view())] {
        let ball = Ball { centre: Point3::new(8.0, -3.0, 5.0), radius: 21.0 };
        let found = lengths(Surface::Ball(ball), oblique(1), &view);
        let placed = Ball { centre: oblique(1).transform(&ball.centre), ..ball };
        for (i, length) in found.iter().enumerate() {
            let pixel = Point2::new((i % 256) as f64, (i / 256) as f64);
            assert!((length - chord(&view, &pixel, &placed)).abs() < 1e-3, "{pixel}: {length}");
        }
        assert!(found.iter().any(|l| *l > 41.9));
    }
}

#[test]
fn a_meshed_ball_has_no_seam_and_its_error_falls_with_density() {
    for view in [small_view(), mirrored(small_view())] {
        for k in 0..12 {
            let ball = Ball { centre: oblique(k).transform(&Point3::origin()), radius: 40.0 };
            let worst = |rounds: usize| {
                let mesh = Surface::Mesh(Arc::new(ball_mesh(40.0, rounds)));
                let found = lengths(mesh, oblique(k), &view);
                let mut worst = 0.0_f64;
                for (i, length) in found.iter().enumerate() {
                    let pixel = Point2::new((i % 256) as f64, (i / 256) as f64);
                    // At the rim a chord ends in a root, where any error of the radius is magnified.
                    let exact = chord(&view, &pixel, &ball);
                    assert!(*length > -1e-3 && *length < exact + 1e-3, "{pixel}: {length} of {exact}");
                    if exact > 20.0 || exact == 0.0 {
                        worst = worst.max((length - exact).abs());
                    }
                }
                worst
            };
            let (coarse, fine) = (worst(4), worst(6));
            // Sides a quarter as long leave a sixteenth of the sag; the f32 of the transmission adds 1e-3 mm.
            assert!(coarse < 1.5 && fine < coarse / 12.0 + 2e-3, "pose {k}: {coarse} {fine}");
        }
    }
}

#[test]
fn a_box_has_the_lengths_between_its_sides() {
    let size = Vector3::new(30.0, 40.0, 50.0);
    let view = small_view();
    for k in 0..6 {
        let pose = oblique(k);
        let found = lengths(Surface::Mesh(Arc::new(box_mesh(size))), pose, &view);
        let (start, back) = (pose.inverse().transform(&view.source), pose.rotation().inverse());
        for (i, length) in found.iter().enumerate() {
            let ray = back * view.ray(&Point2::new((i % 256) as f64, (i / 256) as f64));
            // The part of the ray that lies between all three pairs of sides.
            let (mut from, mut to) = (0.0_f64, f64::INFINITY);
            for axis in 0..3 {
                let at = [-0.5, 0.5].map(|side| (side * size[axis] - start[axis]) / ray[axis]);
                (from, to) = (from.max(at[0].min(at[1])), to.min(at[0].max(at[1])));
            }
            assert!((length - (to - from).max(0.0)).abs() < 5e-3, "pose {k}, pixel {i}: {length}");
        }
    }
}

#[test]
fn every_ray_leaves_a_closed_mesh_as_often_as_it_enters() {
    // Vertices on samples, edges along rows and columns of samples: a box seen straight on whose sides fall on whole pixels.
    let view = TrueFluoroscope {
        source: Point3::new(0.0, 0.0, -1024.0),
        centre: Point3::new(0.0, 0.0, 1024.0),
        along_x: Vector3::x(),
        along_y: Vector3::y(),
        pixel_mm: 1.0,
        size: [129, 129],
    };
    // At depths 1024 -+ 0 both faces of a thin box project onto nearly the same pixels; a long box has both inside.
    for size in
        [Vector3::new(32.0, 32.0, 1e-9), Vector3::new(32.0, 16.0, 64.0), Vector3::new(31.0, 17.0, 512.0)]
    {
        let found = lengths(Surface::Mesh(Arc::new(box_mesh(size))), Pose::identity(), &view);
        let longest = size.z * 1.01;
        assert!(found.iter().all(|l| *l > -1e-3 && *l < longest + 1e-3));
    }
}

#[test]
fn a_mesh_with_a_hole_is_refused() {
    let whole = ball_mesh(40.0, 4);
    let holed = Mesh::new(whole.vertices().to_vec(), whole.triangles()[1..].to_vec()).unwrap();
    let scene = one(Surface::Mesh(Arc::new(holed)), 0.1, Pose::identity());
    let found = picture(&scene, &small_view(), &Exposure::ideal(), 0);
    assert!(matches!(found, Err(PictureError::Open { triangles: 2047, .. })), "{found:?}");
}

#[test]
fn a_body_that_is_not_in_the_beam_is_refused() {
    let view = small_view();
    let behind = Pose::new(UnitQuaternion::identity(), Vector3::new(0.0, -530.0, 0.0));
    let mesh = one(Surface::Mesh(Arc::new(ball_mesh(40.0, 2))), 0.1, behind);
    assert!(matches!(picture(&mesh, &view, &Exposure::ideal(), 0), Err(PictureError::OutOfBeam { .. })));
    let ball = one(Surface::Ball(Ball { centre: Point3::origin(), radius: 40.0 }), 0.1, behind);
    assert!(matches!(picture(&ball, &view, &Exposure::ideal(), 0), Err(PictureError::AroundSource { .. })));
}

#[test]
fn a_half_covered_pixel_has_half_of_the_light() {
    // A block that lets nothing through, from a column of the picture to the right.
    let view = small_view();
    let exposure = Exposure::ideal();
    let cover = |dx: f64| {
        let block = box_mesh(Vector3::new(200.0, 0.01, 200.0));
        // Its left side at pixel 150 + dx at the depth of 500 mm.
        let at_px = |x: f64| (x - 127.5) * view.pixel_mm * 500.0 / 1000.0;
        let pose = Pose::new(UnitQuaternion::identity(), Vector3::new(at_px(150.0 + dx) + 100.0, 0.0, 0.0));
        let scene = one(Surface::Mesh(Arc::new(block)), 1e5, pose);
        Transmission::of_scene(&scene, &view, &exposure).unwrap().values[128 * 256 + 150]
    };
    // A pixel reaches from -0.5 to 0.5; 16 samples at different distances.
    for dx in [-0.45, -0.25, 0.0, 0.1, 0.4] {
        assert!((f64::from(cover(dx)) - (0.5 + dx)).abs() < 1.0 / 30.0, "{dx}: {}", cover(dx));
    }
}

#[test]
fn bending_draws_a_ball_where_it_is_recorded() {
    let view = small_view();
    let bent = IntensifierDistortion {
        pincushion_px: 8.0,
        s_shape_px: 5.0,
        shift_px: Vector2::new(0.7, -0.4),
        ..IntensifierDistortion::none([256, 256])
    };
    let exposure = Exposure { distortion: Some(bent), ..single_rays() };
    let ball = Ball { centre: Point3::new(-40.0, 5.0, 30.0), radius: 15.0 };
    let of = |surface: Surface| {
        Transmission::of_scene(&one(surface, 0.01, Pose::identity()), &view, &exposure).unwrap()
    };
    // A coarse cube, whose long sides are parted, and a ball: chords of the ideal pixels.
    let balls = of(Surface::Ball(ball));
    let cube = of(Surface::Mesh(Arc::new(box_mesh(Vector3::new(60.0, 30.0, 50.0)))));
    let straight =
        lengths(Surface::Mesh(Arc::new(box_mesh(Vector3::new(60.0, 30.0, 50.0)))), Pose::identity(), &view);
    let mut compared = 0;
    for i in 0..256 * 256 {
        let ideal = bent.ideal(&Point2::new((i % 256) as f64, (i / 256) as f64));
        let length = -f64::from(balls.values[i]).ln() / 0.01;
        assert!((length - chord(&view, &ideal, &ball)).abs() < 2e-3);
        // The straight picture of the cube at that place, where it is smooth: its corners are cut by bilinear mixing.
        let (x, y) = (ideal.x.floor(), ideal.y.floor());
        if x >= 0.0 && y >= 0.0 && x < 255.0 && y < 255.0 {
            let at = |dx: usize, dy: usize| straight[(y as usize + dy) * 256 + x as usize + dx];
            let around = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
            let (s, t) = (ideal.x - x, ideal.y - y);
            let mixed = (around[0] * (1.0 - s) + around[1] * s) * (1.0 - t)
                + (around[2] * (1.0 - s) + around[3] * s) * t;
            if around.iter().all(|l| (l - around[0]).abs() < 0.2) {
                compared += usize::from(mixed > 1.0);
                let length = -f64::from(cube.values[i]).ln() / 0.01;
                assert!((length - mixed).abs() < 0.2, "{i}: {length} {mixed}");
            }
        }
    }
    assert!(compared > 2000, "{compared}");
}

/// Where the grey along a line of the picture passes `level`, seen from the ball's middle outwards, px.
fn crossing(frame: &Frame, from: Point2, direction: Vector2, level: f64) -> f64 {
    let at = |p: Point2| {
        let (x, y) = (p.x.floor(), p.y.floor());
        let v = |dx: usize, dy: usize| {
            f64::from(frame.samples[(y as usize + dy) * frame.width + x as usize + dx])
        };
        let (s, t) = (p.x - x, p.y - y);
        (v(0, 0) * (1.0 - s) + v(1, 0) * s) * (1.0 - t) + (v(0, 1) * (1.0 - s) + v(1, 1) * s) * t
    };
    let mut r = 0.0;
    while at(from + direction * r) < level {
        r += 0.01;
    }
    r
}

#[test]
fn edges_of_a_picture_lie_where_many_rays_put_them() {
    let view = TrueFluoroscope { pixel_mm: 315.0 / 1024.0, size: [256, 256], ..biplane(90.0)[0].clone() };
    let scene =
        one(Surface::Ball(Ball { centre: Point3::new(0.3, 0.0, 0.2), radius: 15.0 }), 1.0, Pose::identity());
    let of = |samples_per_px: usize| {
        let exposure = Exposure { samples_per_px, detector_blur_px: 0.8, ..Exposure::ideal() };
        picture(&scene, &view, &exposure, 0).unwrap()
    };
    let (usual, dense) = (of(8), of(256));
    let middle = view.project(&Point3::new(0.3, 0.0, 0.2)).unwrap().0;
    let (mut sum, mut squares) = (0.0, 0.0_f64);
    for k in 0..720 {
        let a = f64::from(k) * std::f64::consts::PI / 360.0;
        let direction = Vector2::new(a.cos(), a.sin());
        let of = |frame: &Frame| crossing(frame, middle, direction, 32768.0);
        let error = of(&usual) - of(&dense);
        sum += error;
        squares += error * error;
    }
    let (mean, rms) = (sum / 720.0, (squares / 720.0).sqrt());
    assert!(mean.abs() < 0.005 && rms < 0.025, "mean {mean} rms {rms}");
}

/// An even field: no body.
fn even(exposure: &Exposure, seed: u64) -> Frame {
    picture(&Scene::default(), &small_view(), exposure, seed).unwrap()
}

fn mean_and_variance(frame: &Frame) -> (f64, f64) {
    let n = frame.samples.len() as f64;
    let mean = frame.samples.iter().map(|s| f64::from(*s)).sum::<f64>() / n;
    (mean, frame.samples.iter().map(|s| (f64::from(*s) - mean).powi(2)).sum::<f64>() / n)
}

#[test]
fn quantum_noise_has_its_mean_for_variance() {
    for photons_per_px in [5.0, 400.0] {
        // One grey level a photon.
        let exposure = Exposure { photons_per_px, brightness: photons_per_px / 65535.0, ..Exposure::ideal() };
        let (mean, variance) = mean_and_variance(&even(&exposure, 3));
        // 65536 pixels: standard errors sqrt(m / 65536) of the mean and about m sqrt(2 / 65536) of the variance.
        assert!((mean - photons_per_px).abs() < 5.0 * (photons_per_px / 65536.0).sqrt(), "{mean}");
        assert!((variance / photons_per_px - 1.0).abs() < 0.035, "{variance}");
    }
}

#[test]
fn electronic_noise_is_as_wide_as_it_says() {
    let exposure = Exposure { brightness: 0.5, electronic_noise: 0.01, ..Exposure::ideal() };
    let (mean, variance) = mean_and_variance(&even(&exposure, 3));
    assert!((mean / 65535.0 - 0.5).abs() < 2e-4);
    assert!((variance.sqrt() / 655.35 - 1.0).abs() < 0.015);
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_others() {
    let exposure = Exposure { brightness: 0.5, ..Exposure::fluoroscopy() };
    assert!(even(&exposure, 7) == even(&exposure, 7));
    assert!(even(&exposure, 7) != even(&exposure, 8));
}

#[test]
fn what_is_too_bright_saturates_at_every_depth() {
    for bits in [8, 10, 12, 16] {
        let full = ((1_u32 << bits) - 1) as u16;
        let bright = even(&Exposure { bits, brightness: 1.7, ..Exposure::ideal() }, 0);
        assert!(bright.bits == bits && bright.samples.iter().all(|s| *s == full));
        let dark = even(&Exposure { bits, brightness: 0.0, black_level: -0.2, ..Exposure::ideal() }, 0);
        assert!(dark.samples.iter().all(|s| *s == 0));
        let half = even(&Exposure { bits, brightness: 0.5, ..Exposure::ideal() }, 0);
        assert!(half.samples.iter().all(|s| (i32::from(*s) * 2 - i32::from(full)).abs() <= 1));
    }
}

#[test]
fn blur_and_scatter_keep_what_they_spread() {
    let ball = one(
        Surface::Ball(Ball { centre: Point3::new(40.0, 0.0, 30.0), radius: 20.0 }),
        1.0,
        Pose::identity(),
    );
    let mean =
        |exposure: &Exposure| mean_and_variance(&picture(&ball, &small_view(), exposure, 0).unwrap()).0;
    // A grey level that is whole, so that rounding leans to no side.
    let sharp = mean(&Exposure { brightness: 0.4, ..Exposure::ideal() });
    let blurred =
        mean(&Exposure { brightness: 0.4, focal_spot_mm: 3.0, detector_blur_px: 2.0, ..Exposure::ideal() });
    assert!((blurred / sharp - 1.0).abs() < 1e-5, "{}", blurred / sharp);
    let scattered = mean(&Exposure { brightness: 0.4, scatter: 0.4, scatter_px: 60.0, ..Exposure::ideal() });
    // The mirror at the border of blocks of 16 px keeps the mean too.
    assert!((scattered / sharp - 1.4).abs() < 1e-3, "{}", scattered / sharp);
}

#[test]
fn the_focal_spot_blurs_by_magnification() {
    // A straight edge at half of the way: a spot of 3 mm casts a penumbra of 3 mm, whose variance is 9 / 12 mm^2.
    let view = biplane(90.0)[0].clone();
    let at_depth = |depth: f64| {
        let block = box_mesh(Vector3::new(100.0, 0.01, 100.0));
        let pose = Pose::new(UnitQuaternion::identity(), Vector3::new(50.0, depth - 500.0, 0.0));
        let scene = one(Surface::Mesh(Arc::new(block)), 1e5, pose);
        let frame = picture(&scene, &view, &Exposure { focal_spot_mm: 3.0, ..Exposure::ideal() }, 0).unwrap();
        let row = &frame.samples[512 * 1024 + 400..512 * 1024 + 624];
        // The derivative of an edge is its spread function.
        let weight = |i: usize| f64::from(row[i]) - f64::from(row[i + 1]);
        let total: f64 = (0..223).map(weight).sum();
        let mean = (0..223).map(|i| i as f64 * weight(i)).sum::<f64>() / total;
        ((0..223).map(|i| (i as f64 - mean).powi(2) * weight(i)).sum::<f64>() / total).sqrt() * view.pixel_mm
    };
    for depth in [500.0, 800.0] {
        let expected = 3.0 * (1000.0 / depth - 1.0) / 12.0_f64.sqrt();
        // An edge between two pixels adds the variance of a pixel, 0.008 mm^2.
        assert!((at_depth(depth) / expected - 1.0).abs() < 0.02, "{depth}: {} {expected}", at_depth(depth));
    }
}

#[test]
fn motion_smears_both_ways_alike() {
    let view = small_view();
    let ball = Absorber {
        surface: Surface::Ball(Ball { centre: Point3::origin(), radius: 20.0 }),
        attenuation_per_mm: 0.2,
    };
    let moving = |speed: f64| {
        let mut body = PosedBody::at_rest(Pose::identity(), vec![ball.clone()]);
        body.velocity = Twist { translation: Vector3::new(speed, 0.0, 0.0), rotation: Vector3::zeros() };
        let scene = Scene { bodies: vec![body], tissue: Vec::new() };
        let exposure = Exposure { time_s: 0.01, moments: 8, samples_per_px: 64, ..Exposure::ideal() };
        Transmission::of_scene(&scene, &view, &exposure).unwrap().values
    };
    let (right, left, still) = (moving(500.0), moving(-500.0), moving(0.0));
    let centre_x = |values: &[f32]| {
        let absorbed = |i: usize| 1.0 - f64::from(values[i]);
        let total: f64 = (0..values.len()).map(absorbed).sum();
        (0..values.len()).map(|i| (i % 256) as f64 * absorbed(i)).sum::<f64>() / total
    };
    // 5 mm on the way are 8 px: the smear is there, and its middle is where the ball is in the middle of the exposure.
    let largest = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(largest(&right, &still) > 0.2);
    // Each moment has other rays of a pixel, so to and fro differ by a part of what one of eight moments counts.
    assert!(largest(&right, &left) < 0.05, "{}", largest(&right, &left));
    assert!((centre_x(&right) - centre_x(&still)).abs() < 0.01, "{}", centre_x(&right) - centre_x(&still));
    assert!((centre_x(&left) - centre_x(&still)).abs() < 0.01, "{}", centre_x(&left) - centre_x(&still));
}

#[test]
fn tissue_heel_vignetting_and_border_are_where_they_should_be() {
    let view = small_view();
    let tissue = Ellipsoid {
        centre: Point3::origin(),
        semi_axes: Vector3::new(50.0, 60.0, f64::INFINITY),
        attenuation_per_mm: 0.01,
    };
    let scene = Scene { bodies: Vec::new(), tissue: vec![tissue] };
    let through = Transmission::of_scene(&scene, &view, &Exposure::ideal()).unwrap();
    // The middle ray passes the cylinder's 120 mm, at every height nearly, and misses it at the picture's sides.
    assert!((through.values[128 * 256 + 128] - (-1.2_f32).exp()).abs() < 1e-3);
    assert!(through.values[128 * 256] == 1.0 && through.values[5 * 256 + 128] < 0.31);
    let exposure = Exposure {
        brightness: 0.5,
        heel: Vector2::new(0.0, 0.1),
        vignetting: 0.2,
        border_px: 120.0,
        ..Exposure::ideal()
    };
    let frame = even(&exposure, 0);
    let share = |x: usize, y: usize| f64::from(frame.samples[y * 256 + x]) / 65535.0;
    let expected = |x: f64, y: f64| {
        let r2 = ((x - 127.5).powi(2) + (y - 127.5).powi(2)) / (128.0 * 128.0);
        0.5 * (1.0 + 0.1 * (y - 127.5) / 128.0) * (1.0 - 0.2 * r2)
    };
    for (x, y) in [(128, 128), (60, 200), (200, 50)] {
        assert!((share(x, y) - expected(x as f64, y as f64)).abs() < 1e-4);
    }
    assert!(share(128, 3) == 0.0 && share(0, 0) == 0.0 && share(128, 12) > 0.3);
}

#[test]
fn a_field_on_the_detector_is_averaged_over_recorded_pixels() {
    let view = small_view();
    let bent = IntensifierDistortion { pincushion_px: 8.0, ..IntensifierDistortion::none([256, 256]) };
    let exposure = Exposure { samples_per_px: 64, distortion: Some(bent), ..Exposure::ideal() };
    let hole = Point2::new(40.0, 200.0);
    let through =
        Transmission::on_detector(&view, &exposure, |p| f64::from(u8::from((p - hole).norm() < 6.0)));
    let (mut sum, mut at) = (0.0, Vector2::zeros());
    for (i, v) in through.values.iter().enumerate() {
        sum += f64::from(*v);
        at += Vector2::new((i % 256) as f64, (i / 256) as f64) * f64::from(*v);
    }
    // The disc is enlarged by the determinant of the map at its middle and recorded there, but for the map's bend.
    let step = 1e-4;
    let of = |dx: f64, dy: f64| bent.recorded(&(hole + Vector2::new(dx, dy)));
    let (dx, dy) =
        ((of(step, 0.0) - of(-step, 0.0)) / (2.0 * step), (of(0.0, step) - of(0.0, -step)) / (2.0 * step));
    let area = std::f64::consts::PI * 36.0 * (dx.x * dy.y - dx.y * dy.x);
    assert!((sum / area - 1.0).abs() < 0.003, "{}", sum / area);
    assert!((at / sum - bent.recorded(&hole).coords).norm() < 0.05);
}
