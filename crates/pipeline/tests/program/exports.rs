//! Results for other programs, and theirs brought back, through the program.

use crate::scene::Scene;

/// A run with everything exported; the middle frame shows nothing, so its match fails.
fn exported() -> Scene {
    let scene = Scene::new();
    let blank = image::GrayImage::from_fn(crate::scene::SIZE, crate::scene::SIZE, |x, y| {
        image::Luma([if x.max(y) < 40 { 60 } else { 200 }])
    });
    let mut png = std::io::Cursor::new(Vec::new());
    blank.write_to(&mut png, image::ImageFormat::Png).unwrap();
    for view in ["A", "B"] {
        scene.write(&format!("frames/{view}/0001.png"), png.get_ref());
    }
    let formats = "[export]\nformats = [\"json\", \"tra\", \"xmalab\", \"jts\", \"jtak\", \"sto\", \"mot\"]\nview = \"B\"\n";
    scene.edit("[match]", &format!("{formats}\n[match]"));
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 1, "{out}{err}");
    scene
}

#[test]
fn every_format_is_written_and_comes_back_as_the_same_poses() {
    let scene = exported();
    for (file, more) in [
        ("squat.tra", vec![]),
        ("squat_box_xmalab.csv", vec![]),
        ("squat_box.jts", vec!["--view", "B"]),
        ("squat_box.jtak", vec!["--view", "B"]),
    ] {
        let path = format!("results/exports/{file}");
        let mut arguments = vec!["difference", &path, "--trial", "squat", "--body", "box"];
        arguments.extend(more);
        let (code, out, err) = scene.biplane(&arguments);
        assert_eq!(code, 0, "{file}: {out}{err}");
        let row: Vec<&str> =
            out.lines().find(|l| l.starts_with("box ")).unwrap().split_whitespace().collect();
        assert_eq!(
            row[..8],
            ["box", "2", "0.000", "0.000", "0.000", "0.000", "0.000", "0.000"],
            "{file}: {out}"
        );
    }
    // In the frame of another camera they are elsewhere.
    let (_, out, _) =
        scene.biplane(&["difference", "results/exports/squat_box.jts", "--body", "box", "--view", "A"]);
    assert!(!out.contains(" 0.000 "), "{out}");
    let json: serde_json::Value = serde_json::from_str(&scene.read("results/exports/poses.json")).unwrap();
    assert_eq!(json["version"], 1);
    assert_eq!(json["frames"][1]["bodies"][0]["verdict"], "failed");
    assert!(json["frames"][0]["bodies"][0]["covariance"][0][0].as_f64().unwrap() > 0.0);
    assert_eq!(json["frames"][2]["time_s"], 0.2);
    let sto = scene.read("results/exports/squat_box.sto");
    assert!(
        sto.contains("nRows=3\nnColumns=8\ninDegrees=no\n") && sto.contains("\n0.100000\tnan\t"),
        "{sto}"
    );
    assert!(scene.read("results/exports/README.txt").contains("squat: 3 frames, 0000 to 0002"));
    // What is not asked for any more goes away.
    scene.edit("\"tra\", ", "");
    scene.biplane(&["run"]);
    assert!(!scene.path("results/exports/squat.tra").exists());
}

#[test]
fn another_programs_poses_become_starts() {
    let scene = exported();
    let arguments = ["import", "results/exports/squat.tra", "--body", "box", "--output", "from_tra.csv"];
    let (code, out, err) = scene.biplane(&arguments);
    assert_eq!((code, out.as_str()), (0, "from_tra.csv: 2 poses\n"), "{err}");
    let (code, _, err) = scene.biplane(&arguments);
    assert!(code == 3 && err.contains("nothing was overwritten"), "{code} {err}");
    scene.edit("starts = \"starts.csv\"", "starts = \"from_tra.csv\"");
    let (_, out, err) = scene.biplane(&["run"]);
    assert!(out.contains("2 good, 0 doubtful, 1 failed"), "{out}{err}");
}

#[test]
fn what_cannot_be_read_says_what_to_do() {
    let scene = exported();
    for (arguments, expected) in [
        (vec!["import", "results/exports/squat.tra", "--body", "bux"], "the study has no body `bux`"),
        (vec!["import", "results/exports/squat_box.jts", "--view", "C"], "the study has no fluoroscope `C`"),
        (vec!["import", "nothing.tra"], "nothing.tra: "),
        (vec!["import", "A.txt"], "A.txt:"),
    ] {
        let (code, _, err) = scene.biplane(&arguments);
        assert!(code >= 2 && err.contains(expected), "{arguments:?}: {code} {err}");
    }
    scene.edit("view = \"B\"", "view = \"D\"");
    let (code, _, err) = scene.biplane(&["plan"]);
    assert!(code == 2 && err.contains("there is no fluoroscope `D`"), "{err}");
}
