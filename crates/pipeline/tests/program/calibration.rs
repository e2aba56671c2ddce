//! Studies that begin with raw pictures of a plate and of beads: those of `fixtures/knee-natural`, with a frame of it.

use std::path::{Path, PathBuf};

use crate::scene::{Scene, run};

/// A copy of the fixture with its first frame and the tibia alone.
struct Raw {
    folder: tempfile::TempDir,
}

const PIPELINE: &str = "
[study]
name = \"raw\"
[fluoroscope.A]
plate = \"calibration/plate_A.png\"
beads = \"calibration/beads_A.png\"
[fluoroscope.B]
plate = \"calibration/plate_B.png\"
beads = \"calibration/beads_B.png\"
[plate]
list = \"calibration/plate.csv\"
[beads]
list = \"calibration/beads.csv\"
[[body]]
name = \"tibia\"
mesh = \"models/tibia_3500.stl\"
[[trial]]
name = \"flexion\"
frames = { A = \"frames/A\", B = \"frames/B\" }
starts = \"starts.csv\"
bodies = [\"tibia\"]
";

impl Raw {
    fn new() -> Self {
        let fixture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/knee-natural");
        let raw = Self { folder: tempfile::tempdir().unwrap() };
        let calibration =
            ["plate_A.png", "plate_B.png", "beads_A.png", "beads_B.png", "plate.csv", "beads.csv"];
        let names = calibration.iter().map(|n| format!("calibration/{n}"));
        let others = ["frames/A/0000.png", "frames/B/0000.png", "models/tibia_3500.stl"].map(str::to_owned);
        for name in names.chain(others) {
            let to = raw.path(&name);
            std::fs::create_dir_all(to.parent().unwrap()).unwrap();
            std::fs::copy(fixture.join(&name), to).unwrap();
        }
        let starts = std::fs::read_to_string(fixture.join("starts.csv")).unwrap();
        let kept = starts.lines().filter(|l| l.starts_with("trial,") || l.contains(",0000,tibia,"));
        raw.write("starts.csv", &kept.map(|l| format!("{l}\n")).collect::<String>());
        raw.write("pipeline.toml", PIPELINE);
        raw
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        std::fs::write(self.path(name), text).unwrap();
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    fn biplane(&self, arguments: &[&str]) -> (i32, String, String) {
        run(self.folder.path(), arguments)
    }
}

#[test]
fn raw_pictures_become_fluoroscopes_and_poses_and_what_changed_alone_runs_again() {
    let raw = Raw::new();
    let (code, out, _) = raw.biplane(&["plan"]);
    assert_eq!(code, 0, "{out}");
    assert!(out.contains("environment") && out.contains("spots"), "{out}");

    let (code, out, err) = raw.biplane(&["run"]);
    assert_eq!(code, 0, "{out}\n{err}");
    assert!(out.contains("Calibration: good") && out.contains("1 good, 0 doubtful, 0 failed"), "{out}");
    for name in ["plate_A.svg", "distortion_B.svg", "beads_A.svg", "fluoroscopes.svg", "fluoroscopes.json"] {
        assert!(raw.path("results/calibration").join(name).is_file(), "{name}");
    }
    let report = raw.read("results/report.html");
    assert!(report.contains("fluoroscopes.svg") && report.contains("left, held out px"), "shown");
    // The simulator's truth, which is not in the study: sources of A and B.
    let found: serde_json::Value =
        serde_json::from_str(&raw.read("results/calibration/fluoroscopes.json")).unwrap();
    let fixture =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/knee-natural/truth/fluoroscopes.json");
    let truth: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(fixture).unwrap()).unwrap();
    for view in found["views"].as_array().unwrap() {
        let off: f64 = (0..3)
            .map(|i| {
                let truth = &truth["fluoroscopes"][view["view"].as_str().unwrap()]["source"][i];
                (view["source"][i].as_f64().unwrap() - truth.as_f64().unwrap()).powi(2)
            })
            .sum();
        assert!(off.sqrt() < 0.5, "source of {} is {} mm off", view["view"], off.sqrt());
    }

    let (code, out, _) = raw.biplane(&["run"]);
    assert!(code == 0 && out.contains("Nothing to do"), "{out}");
    let (code, out, err) = raw.biplane(&["doctor"]);
    assert!(code == 0 && out.contains("fits") && out.contains("stays"), "{out}\n{err}");

    // A limit changes what is said of the plate, not the map: beads and frames stay as they are.
    raw.write("pipeline.toml", &format!("{PIPELINE}[distortion]\nmax_held_out_px = 0.001\n"));
    let (code, out, _) = raw.biplane(&["explain"]);
    assert!(code == 0 && out.contains("distortion/A"), "{out}");
    let (code, out, err) = raw.biplane(&["run"]);
    assert!(code == 0 && out.contains("Calibration: doubtful"), "{out}\n{err}");
    assert!(out.contains("environment 0 run, 1 cached") && out.contains("match 0 run, 1 cached"), "{out}");
}

#[test]
fn a_picture_of_something_else_is_an_error_and_what_was_found_is_drawn() {
    let raw = Raw::new();
    std::fs::copy(raw.path("calibration/beads_A.png"), raw.path("calibration/plate_A.png")).unwrap();
    let (code, out, err) = raw.biplane(&["run"]);
    assert_eq!(code, 3, "{out}\n{err}");
    assert!(err.contains("distortion/A") && err.contains("no frame was matched"), "{err}");
    assert!(raw.path("results/calibration/plate_B.svg").is_file(), "the other view can still be looked at");
    assert!(!raw.path("results/poses.csv").exists());
}

#[test]
fn clicks_that_name_no_bead_are_told_with_file_and_line() {
    let raw = Raw::new();
    raw.write("edits/beads_A.csv", "bead,x_px,y_px\n1,100,100\nnone,5,5\n");
    let (code, _, err) = raw.biplane(&["run"]);
    assert_eq!(code, 3, "{err}");
    assert!(err.contains("beads_A.csv") && err.contains("line 3") && err.contains("none"), "{err}");
}

#[test]
fn a_study_that_does_not_say_where_a_fluoroscope_stands_is_told_how() {
    let raw = Raw::new();
    for (from, to, expected) in [
        ("beads = \"calibration/beads_B.png\"\n", "", "does not say where it stands"),
        ("[plate]\nlist = \"calibration/plate.csv\"\n", "", "it is not said what this plate is"),
        ("[beads]\nlist = \"calibration/beads.csv\"\n", "", "it is not said where these beads are"),
        ("plate = \"calibration/plate_A.png\"\n", "", "the size of a pixel of A is not known"),
        (
            "list = \"calibration/plate.csv\"",
            "pattern = \"square\"",
            "it is not clear where the plate's holes are",
        ),
        (
            "beads = \"calibration/beads_B.png\"",
            "beads = [\"calibration/beads_B.png\", \"calibration/beads_A.png\"]",
            "2 picture(s) of beads, but fluoroscope A has 1",
        ),
    ] {
        assert!(PIPELINE.contains(from), "{from}");
        raw.write("pipeline.toml", &PIPELINE.replacen(from, to, 1));
        let (code, _, err) = raw.biplane(&["plan"]);
        assert!(code == 2 && err.contains(expected), "{expected}\n{err}");
    }
}

#[test]
fn init_recognises_raw_calibration_pictures() {
    let raw = Raw::new();
    std::fs::remove_file(raw.path("pipeline.toml")).unwrap();
    raw.write("starts.csv", &raw.read("starts.csv").replace("flexion,", "trial1,"));
    let (code, out, err) = raw.biplane(&["init"]);
    assert_eq!(code, 0, "{out}\n{err}");
    let text = raw.read("pipeline.toml");
    assert!(
        text.contains("plate = \"calibration/plate_A.png\"")
            && text.contains("beads = \"calibration/beads_B.png\""),
        "{text}"
    );
    let (code, out, err) = raw.biplane(&["plan"]);
    assert_eq!(code, 0, "{out}\n{err}\n{text}");
}

#[test]
fn a_fluoroscope_that_was_moved_after_its_calibration_is_found_by_the_doctor() {
    let scene = Scene::new();
    let (code, _, err) = scene.biplane(&["doctor"]);
    assert!(code == 3 && err.contains("`biplane run` first"), "{err}");
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let (code, out, err) = scene.biplane(&["doctor"]);
    assert!(code == 0 && out.contains("fits") && !out.contains("does not fit"), "{out}\n{err}");
    assert!(out.contains("it is not said how sure it is"), "a file without covariance: {out}");

    // The second fluoroscope 0.25 mm higher than its calibration says.
    scene.write(
        "B.txt",
        scene.read("B.txt").replace("translation\n0\n0\n", "translation\n0\n0.25\n").as_bytes(),
    );
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code == 0 && out.contains("0 failed"), "the poses still fit, each view half\n{out}\n{err}");
    for view in ["A", "B"] {
        let calibration = format!("calibration = \"{view}.txt\"");
        let stated = "uncertainty = { source_mm = 0.1, detector_mm = 0.05, pixel_mm = 0.25 }";
        scene.edit(&calibration, &format!("{calibration}\n{stated}"));
    }
    scene.biplane(&["run"]);
    let (code, out, err) = scene.biplane(&["doctor", "--trial", "squat"]);
    let line = out.lines().rfind(|line| line.starts_with("box")).unwrap();
    assert!(line.ends_with("  sure"), "what is stated of the calibration is passed on: {out}");
    assert!(code == 1 && out.contains("does not fit"), "{out}\n{err}");
    let (code, _, err) = scene.biplane(&["doctor", "--trial", "other"]);
    assert!(code == 2 && err.contains("squat"), "{err}");
}
