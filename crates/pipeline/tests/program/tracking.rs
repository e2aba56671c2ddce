//! Frames of a trial that help each other, through the program.

use nalgebra::UnitQuaternion;

use crate::scene::{HEADER, Scene, row, truth};

fn column(scene: &Scene, name: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_path(scene.path("results/poses.csv")).unwrap();
    let at = reader.headers().unwrap().iter().position(|h| h == name).unwrap();
    reader.records().map(|r| r.unwrap()[at].to_owned()).collect()
}

/// How far a frame's pose is turned from the truth, degrees, and its place off, mm.
fn error(scene: &Scene, frame: usize) -> (f64, f64) {
    let number = |name: &str| column(scene, name)[frame].parse::<f64>().unwrap();
    let [w, x, y, z] = ["qw", "qx", "qy", "qz"].map(number);
    let found = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
    let (q, t) = truth(frame);
    let place = nalgebra::Vector3::from(["tx_mm", "ty_mm", "tz_mm"].map(number));
    (found.angle_to(&q).to_degrees(), (place - t).norm())
}

/// A start for the middle frame from which the box is found turned by half about one of its axes, or not at all.
fn turned_start(scene: &Scene, degrees: f64) {
    let (q, t) = truth(1);
    let q = q * UnitQuaternion::from_axis_angle(&nalgebra::Vector3::x_axis(), degrees.to_radians());
    let turned = format!("squat,1,box,{},{},{},{},{},{},{}\n", t.x, t.y, t.z, q.w, q.i, q.j, q.k);
    scene.write("starts.csv", format!("{HEADER}{}{turned}{}", row(0, 1.0), row(2, 1.0)).as_bytes());
}

#[test]
fn a_frame_that_is_lost_by_itself_is_found_from_those_beside_it() {
    let scene = Scene::new();
    scene.edit("[match]", "[match]\nanywhere = false\nretries = 0");
    turned_start(&scene, 80.0);
    scene.edit("search_px = 20.0\n", "search_px = 20.0\n[track]\nenabled = false\n");
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(column(&scene, "verdict")[1] != "good", "by itself: {out}");
    scene.edit("enabled = false", "enabled = true");
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert_eq!(column(&scene, "verdict"), ["good"; 3], "{out}");
    assert_eq!(column(&scene, "start"), ["file", "neighbours", "file"]);
    let (turned, off) = error(&scene, 1);
    assert!(turned < 0.2 && off < 0.1, "{turned} {off}");
    let (_, again, _) = scene.biplane(&["run"]);
    assert!(again.to_lowercase().contains("nothing to do"), "{again}");
    assert!(
        scene.biplane(&["explain"]).1.starts_with("nothing would run"),
        "{}",
        scene.biplane(&["explain"]).1
    );
}

#[test]
fn where_the_box_fits_in_two_ways_the_frames_beside_it_decide() {
    let scene = Scene::new();
    // The middle frame has no start near: found anywhere, it is ambiguous by itself.
    turned_start(&scene, 80.0);
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert_eq!(column(&scene, "verdict"), ["good"; 3], "{out}");
    assert!(
        column(&scene, "reason")[1].contains("the frames beside it decide"),
        "{:?}",
        column(&scene, "reason")
    );
    let (turned, off) = error(&scene, 1);
    assert!(turned < 0.2 && off < 0.1, "{turned} {off}");
}

#[test]
fn a_lost_frame_says_what_is_seen_of_it_and_is_bridged_only_if_asked() {
    let scene = Scene::new();
    // Nothing but a marker in a corner.
    let blank = image::GrayImage::from_fn(crate::scene::SIZE, crate::scene::SIZE, |x, y| {
        image::Luma([if x.max(y) < 40 { 60 } else { 200 }])
    });
    let mut png = std::io::Cursor::new(Vec::new());
    blank.write_to(&mut png, image::ImageFormat::Png).unwrap();
    for view in ["A", "B"] {
        scene.write(&format!("frames/{view}/0001.png"), png.get_ref());
    }
    scene.edit("search_px = 20.0\n", "search_px = 20.0\n[track]\nbridge = false\n");
    assert_eq!(scene.biplane(&["run"]).0, 1);
    let reason = &column(&scene, "reason")[1];
    assert!(reason.starts_with("lost: where the frames beside it say the body is, view A 100 %"), "{reason}");
    assert_eq!(column(&scene, "verdict")[1], "failed");
    scene.edit("bridge = false", "bridge = true");
    assert_eq!(scene.biplane(&["run"]).0, 1, "a bridge is no match");
    assert_eq!(column(&scene, "verdict")[1], "failed");
    let reason = &column(&scene, "reason")[1];
    assert!(reason.starts_with("the pose is no match: it bridges frames 0000 and 0002"), "{reason}");
    assert_eq!(column(&scene, "sigma_t_mm")[1], "");
    let (turned, off) = error(&scene, 1);
    assert!(turned < 1.0 && off < 0.5, "{turned} {off}");
}

#[test]
fn a_persons_pose_is_left_as_it_came_out() {
    let scene = Scene::new();
    scene.edit("[match]", "[match]\nanywhere = false\nretries = 0");
    turned_start(&scene, 80.0);
    let table = scene.read("starts.csv");
    let edited: String =
        table.lines().filter(|l| l.starts_with("squat,1")).map(|l| format!("{l}\n")).collect();
    scene.write("edits/poses.csv", format!("{HEADER}{edited}").as_bytes());
    scene.biplane(&["run"]);
    assert_eq!(column(&scene, "start")[1], "edit");
}

#[test]
fn a_smoothed_trial_stands_beside_the_raw_one_and_says_what_it_moved() {
    let scene = Scene::new();
    scene.edit("search_px = 20.0\n", "search_px = 20.0\n[smooth]\nenabled = true\n");
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("smoothing moved box in squat by 0.0"), "{out}");
    let raw = scene.read("results/poses.csv");
    let smoothed = scene.read("results/poses_smoothed.csv");
    assert_eq!(smoothed.lines().count(), 4, "{smoothed}");
    assert!(smoothed.lines().nth(2).unwrap().starts_with("squat,0001,box,smoothed,"), "{smoothed}");
    assert!(
        scene.biplane(&["explain"]).1.starts_with("nothing would run"),
        "{}",
        scene.biplane(&["explain"]).1
    );
    scene.edit("enabled = true", "enabled = false");
    scene.biplane(&["run"]);
    assert_eq!(scene.read("results/poses.csv"), raw, "raw poses are the same with and without");
}
