//! Frames of the phantom through the whole stage: labels without a person, clicks, several placings, distortion, and input that is wrong.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

mod scene;

use biplane_artifact::{BeadClick, BeadClicks, Environment, Verdict};
use biplane_environment::{
    EnvironmentError, EnvironmentParams, covariance_of_point, source_covariance, source_region,
};
use biplane_geometry::{Point2, Point3, Pose, Vector3};
use biplane_phantom::{BeadFrame, BeadLayout, IntensifierDistortion};
use nalgebra::{Matrix3, UnitQuaternion};
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use scene::{NOISE_PX, Scene, exact_spots, spot};

fn scene(seed: u64) -> Scene {
    let (layout, share) =
        if seed.is_multiple_of(2) { (BeadLayout::large(), 0.5) } else { (BeadLayout::small(), 0.7) };
    Scene::drawn(&layout, share, 60.0 + 5.0 * seed as f64, seed)
}

fn find(scene: &Scene) -> Result<Environment, EnvironmentError> {
    scene.find(&EnvironmentParams::default())
}

/// That the sources are where their covariance lets them be. One scene in ten thousand lies outside; seeds are fixed.
fn assert_true(found: &Environment, scene: &Scene) {
    for (v, truth) in scene.fluoroscopes.iter().enumerate() {
        let region = source_region(found, v, 0.9999).unwrap();
        assert!(region.holds(&truth.source), "{region:?} {:?} {:?}", truth.source, found.warnings);
    }
}

/// Spots that are no beads, and all in another order.
fn add_clutter(scene: &mut Scene, count: usize, seed: u64) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    for s in &mut scene.spots {
        for _ in 0..count {
            let at = Point2::new(rng.random::<f64>() * 1023.0, rng.random::<f64>() * 1023.0);
            s.spots.push(spot(at, 4.0 + 12.0 * rng.random::<f64>()));
        }
        s.spots.shuffle(&mut rng);
    }
}

fn drop_spots(scene: &mut Scene, share: f64, seed: u64) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    scene.spots.iter_mut().for_each(|s| s.spots.retain(|_| rng.random::<f64>() > share));
}

/// Nothing tells one bead from another but its place.
fn make_alike(scene: &mut Scene) {
    for b in &mut scene.list.0 {
        (b.mark, b.radius_mm) = (false, None);
    }
    scene.spots.iter_mut().flat_map(|s| &mut s.spots).for_each(|s| s.radius_px = 8.0);
}

fn mirror(scene: &mut Scene, view: usize) {
    scene.spots[view].spots.iter_mut().for_each(|s| s.at_px[0] = 1023.0 - s.at_px[0]);
}

/// The spot of a bead in a view.
fn click(scene: &Scene, view: usize, bead: usize, named: usize) -> BeadClick {
    let place = Point3::from(scene.list.0[bead].at_mm);
    let (at, _) = scene.fluoroscopes[view].project(&place).unwrap();
    BeadClick { view, picture: 0, bead: named, at_px: [at.x + 3.0, at.y - 2.0] }
}

#[test]
fn frames_are_recognised_without_a_person() {
    for seed in 0..10 {
        let scene = scene(seed);
        let found = find(&scene).unwrap();
        assert_true(&found, &scene);
        assert_eq!(found.verdict, Verdict::Good, "{:?}", found.warnings);
        for (view, truth) in found.views.iter().zip(&scene.fluoroscopes) {
            assert!(view.beads.len() == 30 && view.missing.is_empty() && view.strays.is_empty());
            assert!(view.reprojection_rms_px < 0.2 && (view.sigma_px - NOISE_PX).abs() < 0.04);
            let m = Matrix3::from_row_slice(&view.matrix.concat());
            let h = m * (Point3::new(10.0, 20.0, 30.0) - Point3::from(view.source));
            let (at, _) = truth.project(&Point3::new(10.0, 20.0, 30.0)).unwrap();
            assert!((h.xy() / h.z - at.coords).norm() < 0.3);
        }
        assert_eq!(found.triangulated.len(), 30);
        assert!(found.triangulation_rms_mm.unwrap() < 0.1);
        assert!((found.angle_deg.unwrap() - (60.0 + 5.0 * seed as f64)).abs() < 0.5);
        assert_eq!(find(&scene).unwrap(), found, "another run found something else");
    }
}

#[test]
fn false_spots_and_missing_beads_do_no_harm() {
    for seed in 0..6 {
        let mut scene = scene(seed);
        drop_spots(&mut scene, 0.1, seed + 5);
        add_clutter(&mut scene, 15, seed);
        let found = find(&scene).unwrap();
        assert_true(&found, &scene);
        assert!(found.views.iter().all(|v| v.strays.len() >= 12), "{:?}", found.warnings);
    }
}

#[test]
fn beads_that_look_alike_are_told_apart_by_place() {
    for seed in 0..4 {
        let mut scene = scene(seed);
        make_alike(&mut scene);
        let found = find(&scene).unwrap();
        assert_true(&found, &scene);
        assert_eq!(found.verdict, Verdict::Good, "{:?}", found.warnings);
    }
}

#[test]
fn a_frame_that_looks_the_same_from_two_sides_asks_for_clicks() {
    // A box: eight corners, each like the next.
    let mut scene = Scene::exact(&BeadLayout { count: 8, ..BeadLayout::large() }, 0.5, 90.0, 1);
    let balls: Vec<_> = (0..8)
        .map(|i| biplane_phantom::Ball {
            centre: Point3::new(
                if i & 1 > 0 { 40.0 } else { -40.0 },
                if i & 2 > 0 { 40.0 } else { -40.0 },
                if i & 4 > 0 { 40.0 } else { -40.0 },
            ),
            radius: 1.5,
        })
        .collect();
    for (bead, ball) in scene.list.0.iter_mut().zip(&balls) {
        (bead.at_mm, bead.radius_mm, bead.mark) = (ball.centre.coords.into(), Some(1.5), false);
    }
    let frame = BeadFrame { beads: balls, attenuation_per_mm: 1.0, tube: None };
    for f in &mut scene.fluoroscopes {
        // A little aside, so that no two corners hide each other.
        f.source += Vector3::new(13.0, 17.0, 23.0);
    }
    scene.spots = scene.fluoroscopes.iter().map(|f| exact_spots(&frame, f)).collect();
    scene.add_noise(NOISE_PX, 1);
    assert!(matches!(find(&scene), Err(EnvironmentError::Ambiguous { .. })), "{:?}", find(&scene));
    let clicks = [0, 1].into_iter().flat_map(|v| [0, 1, 2, 4].map(|b| (v, b)));
    scene.clicks = Some(BeadClicks(clicks.map(|(v, b)| click(&scene, v, b, b)).collect()));
    assert_true(&find(&scene).unwrap(), &scene);
}

#[test]
fn clicks_name_beads_and_wrong_ones_are_refused() {
    let mut scene = scene(3);
    make_alike(&mut scene);
    let right: Vec<BeadClick> = [2, 8, 15, 21].map(|b| click(&scene, 0, b, b)).to_vec();
    scene.clicks = Some(BeadClicks(right.clone()));
    assert_true(&find(&scene).unwrap(), &scene);

    let with = |clicks: Vec<BeadClick>| Scene { clicks: Some(BeadClicks(clicks)), ..scene.clone() };
    let mut swapped = right.clone();
    (swapped[0].bead, swapped[1].bead) = (8, 2);
    let error = find(&with(swapped)).unwrap_err();
    assert!(matches!(error, EnvironmentError::WrongClicks { .. }), "{error}");
    assert!(error.to_string().contains("3, 9"), "{error}");

    let mut far = right.clone();
    far[2].at_px = [5.0, 5.0];
    let error = find(&with(far)).unwrap_err();
    assert!(matches!(&error, EnvironmentError::ClickFar { bead, .. } if bead == "16"), "{error}");
    let mut nan = right.clone();
    nan[2].at_px = [f64::NAN, 5.0];
    assert!(matches!(find(&with(nan)), Err(EnvironmentError::ClickFar { .. })));

    let mut twice = right.clone();
    twice[3].at_px = twice[2].at_px;
    assert!(matches!(find(&with(twice)), Err(EnvironmentError::ClicksClash { .. })));
    for (view, picture, bead) in [(2, 0, 0), (0, 1, 0), (0, 0, 30)] {
        let clicks = vec![BeadClick { view, picture, bead, at_px: [0.0, 0.0] }];
        assert!(matches!(find(&with(clicks)), Err(EnvironmentError::ClickOfNothing { .. })));
    }
}

#[test]
fn mirror_images_are_told_or_taken_as_such() {
    let plain = scene(2);
    let mirrored = EnvironmentParams { mirrored: true, ..EnvironmentParams::default() };
    let mut one = plain.clone();
    mirror(&mut one, 1);
    let error = find(&one).unwrap_err();
    assert!(
        matches!(&error, EnvironmentError::Mirrored { views, all: false, .. } if views == "B"),
        "{error}"
    );

    let mut both = one.clone();
    mirror(&mut both, 0);
    let error = find(&both).unwrap_err();
    assert!(matches!(&error, EnvironmentError::Mirrored { all: true, mirrored: false, .. }), "{error}");
    assert!(error.to_string().contains("mirrored = true"), "{error}");
    let mut left_handed = plain.clone();
    left_handed.list.0.iter_mut().for_each(|b| b.at_mm[1] *= -1.0);
    assert!(matches!(find(&left_handed), Err(EnvironmentError::Mirrored { all: true, .. })));
    assert!(matches!(
        plain.find(&mirrored),
        Err(EnvironmentError::Mirrored { all: true, mirrored: true, .. })
    ));

    // The same place in space, and pixels that run the other way.
    let (a, b) = (find(&plain).unwrap(), both.find(&mirrored).unwrap());
    for (a, b) in a.views.iter().zip(&b.views) {
        assert!((Point3::from(a.source) - Point3::from(b.source)).norm() < 1e-6);
        assert!((Vector3::from(a.along_x) + Vector3::from(b.along_x)).norm() < 1e-9);
        let m = Matrix3::from_row_slice(&b.matrix.concat());
        for bead in &b.beads {
            let place = Point3::from(plain.list.0[bead.bead].at_mm);
            let h = m * (place - Point3::from(b.source));
            let expected = Point2::from(bead.at_px) - h.xy() / h.z;
            // Shadows are off the projection by up to 0.01 px.
            assert!((expected - Point2::from(bead.residual_px)).norm() < 0.02);
        }
    }
}

#[test]
fn a_wrong_unit_is_named() {
    for (unit, mm) in [("centimetres", 10.0), ("inches", 25.4), ("metres", 1000.0), ("micrometres", 0.001)] {
        // With radii in another unit than the coordinates too; once, since sizes are of no use then and the search is long.
        for radii_too in [true, false].into_iter().take(if unit == "metres" { 2 } else { 1 }) {
            let mut scene = scene(0);
            for b in &mut scene.list.0 {
                b.at_mm = b.at_mm.map(|v| v / mm);
                b.radius_mm = b.radius_mm.map(|r| if radii_too { r / mm } else { r });
            }
            let error = find(&scene).unwrap_err();
            assert!(matches!(&error, EnvironmentError::Unit { hint, .. } if hint.contains(unit)), "{error}");
        }
    }
    // Diameters for radii.
    let mut scene = scene(0);
    scene.list.0.iter_mut().for_each(|b| b.radius_mm = b.radius_mm.map(|r| 2.0 * r));
    let found = find(&scene).unwrap();
    assert!(found.verdict == Verdict::Doubtful && found.warnings.iter().any(|w| w.contains("diameters")));
}

#[test]
fn a_wrong_list_is_never_called_good() {
    for seed in 0..5 {
        let mut moved = scene(seed);
        moved.list.0[7].at_mm[(seed % 3) as usize] += 2.0;
        let found = find(&moved).unwrap();
        assert_eq!(found.verdict, Verdict::Doubtful);
        assert!(found.warnings.iter().any(|w| w.contains("bead 8 ")), "{:?}", found.warnings);
        // The rest is right all the same.
        assert_true(&found, &moved);
    }
    let mut other = scene(0);
    other.list = scene(2).list;
    assert!(matches!(find(&other), Err(EnvironmentError::Unknown { .. })));

    let mut flat = scene(0);
    flat.list.0.iter_mut().for_each(|b| b.at_mm[0] = 0.1 * b.at_mm[1] + 3.0);
    assert!(matches!(find(&flat), Err(EnvironmentError::Flat { .. })));
    let mut same = scene(0);
    same.list.0[3].at_mm = same.list.0[9].at_mm;
    let error = find(&same).unwrap_err().to_string();
    assert!(error.contains("beads 4 and 10") || error.contains("beads 10 and 4"), "{error}");
    let mut nan = scene(0);
    nan.list.0[3].at_mm[1] = f64::NAN;
    assert!(matches!(find(&nan), Err(EnvironmentError::NoNumber { name }) if name == "4"));
    let mut short = scene(0);
    short.list.0.truncate(5);
    assert!(matches!(find(&short), Err(EnvironmentError::ShortList { listed: 5 })));
}

#[test]
fn pictures_of_something_else_are_refused() {
    let mut few = scene(0);
    few.spots[1].spots.truncate(4);
    assert!(matches!(find(&few), Err(EnvironmentError::TooFew { view, found: 4, .. }) if view == "B"));
    let mut noise = scene(0);
    noise.spots.iter_mut().for_each(|s| s.spots.clear());
    add_clutter(&mut noise, 120, 1);
    assert!(matches!(find(&noise), Err(EnvironmentError::Unknown { spots: 120, .. })));
    let mut odd = scene(0);
    odd.spots.push(odd.spots[0].clone());
    assert!(matches!(find(&odd), Err(EnvironmentError::Pictures { pictures: 3, views: 2 })));
    let mut nowhere = scene(0);
    nowhere.spots[0].spots.iter_mut().for_each(|s| s.at_px = [f64::NAN, 1e300]);
    assert!(matches!(find(&nowhere), Err(EnvironmentError::TooFew { found: 0, .. })));
    let mut heap = scene(0);
    heap.spots[0].spots.iter_mut().for_each(|s| s.at_px = [500.0, 500.0]);
    assert!(matches!(find(&heap), Err(EnvironmentError::Unknown { .. })), "{:?}", find(&heap));
    let mut no_pixel = scene(0);
    no_pixel.detectors[0].pixel_mm = 0.0;
    assert!(matches!(find(&no_pixel), Err(EnvironmentError::Detector { .. })));
    let mut torn = scene(0);
    let mut table = IntensifierDistortion::none([1024, 1024]).table([1024, 1024], 64);
    table.ideal_px.truncate(7);
    torn.detectors[1].distortion = Some(table);
    assert!(matches!(find(&torn), Err(EnvironmentError::Detector { view, .. }) if view == "B"));
}

#[test]
fn beads_that_hide_each_other_are_named_and_left_out() {
    let mut scene = Scene::exact(&BeadLayout::large(), 0.5, 90.0, 4);
    // Bead 6 comes to stand behind bead 5 in view A, a little aside: one spot between the two.
    let a = Point3::from(scene.list.0[4].at_mm);
    let to = (a - scene.fluoroscopes[0].source).normalize();
    let place = a + to * 30.0 + Vector3::new(1.0, 0.0, 0.5);
    scene.list.0[5].at_mm = place.coords.into();
    let beads = scene
        .list
        .0
        .iter()
        .map(|b| biplane_phantom::Ball { centre: Point3::from(b.at_mm), radius: b.radius_mm.unwrap() });
    let frame = BeadFrame { beads: beads.collect(), attenuation_per_mm: 1.0, tube: None };
    scene.spots = scene.fluoroscopes.iter().map(|f| exact_spots(&frame, f)).collect();
    let [first, second] = [4, 5].map(|b| {
        let p = frame.seen(&scene.fluoroscopes[0], &IntensifierDistortion::none([1024, 1024]));
        p[b].shadow
    });
    scene.spots[0].spots.retain(|s| Point2::from(s.at_px) != first && Point2::from(s.at_px) != second);
    scene.spots[0].spots.push(spot(nalgebra::center(&first, &second), 7.0));
    scene.add_noise(NOISE_PX, 4);
    let found = find(&scene).unwrap();
    assert_true(&found, &scene);
    assert!(
        found.warnings.iter().any(|w| w.contains("beads 5 and 6 hide each other")),
        "{:?}",
        found.warnings
    );
    assert!(found.views[0].beads.iter().all(|b| !(b.bead == 4 || b.bead == 5) || !b.used));
    assert_eq!(found.verdict, Verdict::Good, "{:?}", found.warnings);
}

#[test]
fn several_placings_are_solved_together() {
    let mut scene = Scene::exact(&BeadLayout::large(), 0.5, 80.0, 6);
    let turn = UnitQuaternion::from_euler_angles(0.4, -0.3, 0.9);
    let pose = Pose::new(turn, Vector3::new(6.0, -4.0, 3.0));
    let balls = scene.list.0.iter().map(|b| biplane_phantom::Ball {
        centre: pose.transform(&Point3::from(b.at_mm)),
        radius: b.radius_mm.unwrap(),
    });
    let frame = BeadFrame { beads: balls.collect(), attenuation_per_mm: 1.0, tube: None };
    let again: Vec<_> = scene.fluoroscopes.iter().map(|f| exact_spots(&frame, f)).collect();
    scene.spots.extend(again);
    scene.add_noise(NOISE_PX, 6);
    let found = find(&scene).unwrap();
    assert_true(&found, &scene);
    let second = Pose::from(found.bead_frames[1]);
    assert!(second.rotation().angle_to(&turn) < 1e-3);
    assert!((second.translation() - pose.translation()).norm() < 0.1, "{second:?}");
    assert_eq!(found.verdict, Verdict::Good, "{:?}", found.warnings);
    let one = find(&Scene { spots: scene.spots[..2].to_vec(), ..scene.clone() }).unwrap();
    let sum = |e: &Environment| source_covariance(e, 0).unwrap().trace();
    assert!(sum(&found) < 0.8 * sum(&one), "{} {}", sum(&found), sum(&one));
}

#[test]
fn distorted_spots_are_corrected_as_areas() {
    let mut scene = Scene::exact(&BeadLayout::large(), 0.5, 80.0, 8);
    let size = [1024, 1024];
    let distortion =
        IntensifierDistortion { pincushion_px: 12.0, s_shape_px: -10.0, ..IntensifierDistortion::none(size) };
    let beads = scene
        .list
        .0
        .iter()
        .map(|b| biplane_phantom::Ball { centre: Point3::from(b.at_mm), radius: b.radius_mm.unwrap() });
    let frame = BeadFrame { beads: beads.collect(), attenuation_per_mm: 1.0, tube: None };
    for v in 0..2 {
        scene.detectors[v].distortion = Some(distortion.table(size, 16));
        let seen = frame.seen(&scene.fluoroscopes[v], &distortion);
        scene.spots[v].spots = seen.iter().map(|b| spot(b.shadow_recorded, b.radius_px)).collect();
    }
    let found = find(&scene).unwrap();
    for (view, truth) in found.views.iter().zip(&scene.fluoroscopes) {
        // Centres taken as points would leave residuals of 0.005 px.
        assert!(view.reprojection_rms_px < 2e-3, "{}", view.reprojection_rms_px);
        assert!((Point3::from(view.source) - truth.source).norm() < 0.05);
    }
}

#[test]
fn the_covariance_of_a_point_is_that_of_draws() {
    // Fresh points through calibrations of one scene: the error of a triangulated point over many draws of the noise.
    let exact = Scene::exact(&BeadLayout::large(), 0.5, 90.0, 11);
    let point = Point3::new(30.0, -20.0, 40.0);
    let mut predicted = Matrix3::zeros();
    let mut seen = Matrix3::zeros();
    let draws = 200;
    for draw in 0..draws {
        let mut scene = exact.clone();
        scene.add_noise(NOISE_PX, draw);
        let found = find(&scene).unwrap();
        predicted += covariance_of_point(&found, &point, 0.0).unwrap() / draws as f64;
        // Where the true pixels of the point lead: nearest to both rays.
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for (view, truth) in found.views.iter().zip(&scene.fluoroscopes) {
            let (at, _) = truth.project(&point).unwrap();
            let inverse = Matrix3::from_row_slice(&view.matrix.concat()).try_inverse().unwrap();
            let ray = (inverse * Vector3::new(at.x, at.y, 1.0)).normalize();
            let across = Matrix3::identity() - ray * ray.transpose();
            normal += across;
            right += across * Vector3::from(view.source);
        }
        let error = normal.try_inverse().unwrap() * right - point.coords;
        seen += error * error.transpose() / draws as f64;
    }
    // The trace of 200 draws scatters by about 6 %.
    let ratio = seen.trace() / predicted.trace();
    assert!((0.8..1.2).contains(&ratio), "{ratio} {seen} {predicted}");
    let whole = covariance_of_point(&find(&exact).unwrap(), &point, 1.0).unwrap();
    assert!(whole.trace() > 100.0 * seen.trace());
}
