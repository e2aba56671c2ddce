//! What the program says of a wrong `pipeline.toml` or wrong inputs: where, what, and what to do.

use crate::scene::{HEADER, PIPELINE, Scene, row};

/// Runs a study whose pipeline file has `from` replaced by `to`; it must end with code 2 and say all of `expected`.
fn refuses(from: &str, to: &str, expected: &[&str]) {
    let scene = Scene::new();
    scene.edit(from, to);
    let (code, _, said) = scene.biplane(&["run"]);
    assert_eq!(code, 2, "{said}");
    for text in expected {
        assert!(said.contains(text), "expected: {text}\nsaid:\n{said}");
    }
    assert!(!scene.path("results").exists());
}

#[test]
fn a_misspelt_key_is_shown_with_its_line_and_what_was_meant() {
    let scene = Scene::new();
    scene.edit("search_px = 20.0", "serch_px = 20.0");
    let (code, _, said) = scene.biplane(&["run"]);
    assert_eq!(code, 2);
    let expected = "error: unknown key `serch_px`
  --> pipeline.toml:21:1
   |
21 | serch_px = 20.0
   | ^^^^^^^^ did you mean `search_px`?
   |
   = help: the keys of this table are `method`, `search_px`, ";
    assert!(said.starts_with(expected), "{said}");
}

#[test]
fn faults_of_the_file_point_at_their_place() {
    refuses(
        "frame_rate_hz = 10.0",
        "frame_rate_hz = \"fast\"",
        &["pipeline.toml:17:17", "string \"fast\"", "a number"],
    );
    refuses(
        "frame_rate_hz = 10.0",
        "frame_rate_hz = 0",
        &["pipeline.toml:17:17", "a frame rate of 0 Hz cannot be"],
    );
    refuses(
        "mesh = \"box.stl\"\n",
        "",
        &["pipeline.toml:11:8", "does not say where its surface comes from", "a mesh file"],
    );
    refuses(
        "search_px = 20.0",
        "search_px = 20.0\nignore_cut_ends = true",
        &["pipeline.toml:22:", "each body says for itself", "[[body]] cut_ends"],
    );
    refuses("\"starts.csv\"", "\"start.csv\"", &["pipeline.toml:18:10", "did you mean `starts.csv`?"]);
    refuses("\"frames/A\"", "\"frame/A\"", &["pipeline.toml:16:16", "`frame` is not there either"]);
    refuses("\"frames/A\"", "\"frames/A/*.tif\"", &["pipeline.toml:16:16", "no file matches this pattern"]);
    refuses(
        "{ A =",
        "{ C =",
        &["pipeline.toml:16:12", "there is no fluoroscope `C`", "known here: `A`, `B`"],
    );
    refuses(
        "[match]",
        "bodies = [\"bxo\"]\n[match]",
        &["pipeline.toml:20:11", "there is no body `bxo`", "did you mean `box`?"],
    );
    refuses(
        "[match]",
        "[[body]]\nname = \"Box\"\nmesh = \"box.stl\"\n[match]",
        &["pipeline.toml:21:8", "the name `Box` is used"],
    );
    refuses(
        "name = \"squat\"",
        "name = \"a/b\"",
        &["pipeline.toml:15:8", "`a/b` cannot be the name of a trial"],
    );
    refuses(
        "search_px = 20.0",
        "search_px = -3",
        &["pipeline.toml:21:13", "search_px = -3, expected 1 to 500 px"],
    );
    refuses(
        "search_px = 20.0",
        "contrast = \"drak\"",
        &["pipeline.toml:21:12", "`drak` is none", "did you mean `dark`?"],
    );
    refuses(
        "search_px = 20.0",
        "[match.bingham2006]\ngird = 40",
        &["pipeline.toml:22:1", "unknown key `gird`", "did you mean `grid`?"],
    );
    refuses(
        "search_px = 20.0",
        "[match.bingham2006]\ncalls = 0",
        &["pipeline.toml:22:9", "bingham2006.calls = 0, expected 1 to 1000000"],
    );
    refuses("[study]", "[study", &["pipeline.toml:1:7"]);
}

#[test]
fn all_faults_are_shown_at_once() {
    let scene = Scene::new();
    scene.write("pipeline.toml", PIPELINE.replace("A.txt", "X.txt").replace("B.txt", "Y.txt").as_bytes());
    let (_, _, said) = scene.biplane(&["plan"]);
    assert!(said.contains("pipeline.toml:5:15") && said.contains("pipeline.toml:8:15"), "{said}");
}

#[test]
fn a_bad_row_of_starts_names_line_and_column() {
    let scene = Scene::new();
    scene.write("starts.csv", format!("{HEADER}{}squat,1,box,1,2,3,1,1,0,0\n", row(0, 0.0)).as_bytes());
    let (code, _, said) = scene.biplane(&["run"]);
    assert_eq!(code, 3);
    assert!(
        said.starts_with("starts.csv:3: column `qw`: qw, qx, qy, qz have length 1.414214, expected 1"),
        "{said}"
    );
}

#[test]
fn a_body_without_start_says_how_to_give_one() {
    let scene = Scene::new();
    scene.write("starts.csv", HEADER.as_bytes());
    scene.edit("[match]", "[match]\nanywhere = false");
    let (code, _, said) = scene.biplane(&["run"]);
    assert_eq!(code, 3);
    assert!(said.contains("no start pose for body `box` in trial `squat`"), "{said}");
    assert!(said.contains("let the body be looked for: [match] anywhere = true"), "{said}");
    assert!(
        said.contains("trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz") && said.contains("starts.csv"),
        "{said}"
    );
}

#[test]
fn a_table_of_starts_without_a_body_is_told_and_the_body_looked_for() {
    let scene = Scene::new();
    scene.write("starts.csv", format!("{HEADER}squat,7,box,0,0,0,1,0,0,0\n").as_bytes());
    let (code, out, said) = scene.biplane(&["plan"]);
    assert_eq!(code, 0, "{out}{said}");
    assert!(said.contains("starts.csv has 1 row(s) for it, none for a frame of the trial"), "{said}");
    assert!(said.contains("Until then it is looked for anywhere"), "{said}");
}

#[test]
fn how_sure_calibrations_are_is_said_of_all_or_of_none_and_must_be_possible() {
    let stated = |text: &str| {
        let scene = Scene::new();
        scene.edit("calibration = \"A.txt\"", &format!("calibration = \"A.txt\"\nuncertainty = {text}"));
        let (code, _, said) = scene.biplane(&["run"]);
        assert_eq!(code, 2, "{said}");
        said
    };
    let said = stated("{ source_mm = 0.3, detector_mm = 0.1, pixel_mm = 0.25 }");
    assert!(said.contains("it is said how sure A is, but not how sure B is"), "{said}");
    let said = stated("{ source_mm = -0.3, detector_mm = 0.1, pixel_mm = 0.25 }");
    assert!(
        said.contains("these standard deviations cannot be") && said.contains("pipeline.toml:6:"),
        "{said}"
    );
    let said = stated("{ source_mm = 0.3 }");
    assert!(said.contains("detector_mm"), "{said}");
}

#[test]
fn frames_that_do_not_pair_end_the_run_with_what_each_view_has() {
    let scene = Scene::new();
    for frame in 0..3 {
        let (from, to) = (format!("frames/B/{frame:04}.png"), format!("frames/B/{:04}.png", frame + 50));
        std::fs::rename(scene.path(&from), scene.path(&to)).unwrap();
    }
    let (code, _, said) = scene.biplane(&["run"]);
    assert_eq!(code, 3);
    assert!(said.contains("trial squat: no frame of one view belongs to one of another"), "{said}");
    assert!(said.contains("0000, 0001, 0002") && said.contains("0050, 0051, 0052"), "{said}");
    scene.edit("frame_rate_hz", "offset = 50\nframe_rate_hz");
    assert_eq!(scene.biplane(&["run"]).0, 0);
}

#[test]
fn a_calibration_and_a_mesh_that_cannot_be_read_are_both_told() {
    let scene = Scene::new();
    scene.write("A.txt", b"image size\n256,256\n");
    scene.write("box.stl", b"solid nothing\nendsolid nothing\n");
    let (code, _, said) = scene.biplane(&["run"]);
    assert_eq!(code, 3);
    assert!(said.contains("A.txt, line") && said.contains("box.stl"), "{said}");
}

#[test]
fn a_missing_pipeline_file_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let (code, _, said) = crate::scene::run(folder.path(), &["run"]);
    assert_eq!(code, 2);
    assert!(said.starts_with("pipeline.toml: ") && said.contains("biplane init"), "{said}");
}

/// Fault: `[body]` for `[[body]]` was called a duplicate key, or a map where a sequence is expected.
#[test]
fn single_brackets_are_told_to_be_double() {
    refuses("[[body]]", "[body]", &["pipeline.toml:10:1", "write `[[body]]` in double brackets"]);
    let twice = "[trial]\nname = \"a\"\nframes = { A = \"frames/A\" }\n[trial]";
    refuses("[[trial]]", twice, &["pipeline.toml:17:2", "`trial` is there twice", "`[[trial]]`"]);
}

/// Fault: a table of starts that cannot be read was followed by "the trial names no table" for each body.
#[test]
fn one_fault_is_told_once() {
    let scene = Scene::new();
    scene.write("starts.csv", HEADER.replace(",qz", ",q").as_bytes());
    let (code, _, said) = scene.biplane(&["run"]);
    assert_eq!((code, said.lines().count()), (3, 1), "{said}");
    scene.write("edits/poses.csv", b"frame\n");
    assert_eq!(scene.biplane(&["run"]).2.lines().count(), 2);
}

/// Fault: with no row of the right name, what the name may be was not said; and `plan` showed no warnings.
#[test]
fn a_misspelt_name_in_starts_is_told_with_what_is_meant() {
    let scene = Scene::new();
    scene.write("starts.csv", scene.read("starts.csv").replace("squat", "sqaut").as_bytes());
    let (code, _, said) = scene.biplane(&["plan"]);
    assert_eq!(code, 0);
    assert!(said.contains("the study has no trial `sqaut`: did you mean `squat`?"), "{said}");
    assert!(said.contains("Until then it is looked for anywhere"), "{said}");
    scene.write("starts.csv", format!("{HEADER}{}{}", row(0, 1.0), row(7, 1.0)).as_bytes());
    let (code, _, said) = scene.biplane(&["plan"]);
    assert_eq!(code, 0);
    assert!(
        said.contains("1 row(s) are for frames that trial squat does not have, and are not used: 7"),
        "{said}"
    );
}

/// Fault: `inspect` did not know the tables of poses that every study has.
#[test]
fn inspect_knows_tables_of_poses() {
    let scene = Scene::new();
    let (code, out, err) = scene.biplane(&["inspect", "starts.csv", "pipeline.toml"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("trial squat, body box: 2 frames, 0 to 2") && out.contains("`biplane plan` checks it"),
        "{out}"
    );
    scene.write("starts.csv", format!("{HEADER}squat,0,box,1,2,3,1,0,0,x\n").as_bytes());
    let (code, _, err) = scene.biplane(&["inspect", "starts.csv", "nowhere.csv"]);
    assert!(
        code == 3 && err.contains("starts.csv:2: column `qz`") && err.contains("cannot read nowhere.csv"),
        "{err}"
    );
}
