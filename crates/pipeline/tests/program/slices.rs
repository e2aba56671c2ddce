//! Bones in volumes: contours of slices as results, put right by hand, beside frames that they do not disturb.

use crate::scene::Scene;

const COLUMNS: usize = 40;
const ROWS: usize = 32;
const SLICES: usize = 12;

/// A map of labels in which 3 is a ball of 8 mm about the middle of 0.8 x 0.8 x 2 mm voxels; its middle slice has a hole.
fn labels(size: [usize; 3]) -> Vec<u8> {
    let [columns, rows, slices] = size;
    let mut bytes = format!(
        "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: {columns} {rows} {slices}\n\
         space directions: (0.8,0,0) (0,0.8,0) (0,0,2)\nspace origin: (10,20,30)\nencoding: raw\n\n"
    )
    .into_bytes();
    for k in 0..slices {
        for j in 0..rows {
            for i in 0..columns {
                let [x, y, z] = [0.8 * (i as f64 - 19.5), 0.8 * (j as f64 - 15.5), 2.0 * (k as f64 - 5.5)];
                let hole = k == 6 && x.hypot(y) < 3.0;
                bytes.push(if x * x + y * y + z * z < 64.0 && !hole { 3 } else { 0 });
            }
        }
    }
    bytes
}

/// The scene with a bone in a volume.
fn scene() -> Scene {
    let scene = Scene::new();
    scene.write("mri/ball.nrrd", &labels([COLUMNS, ROWS, SLICES]));
    let section = "\n[[slices]]\nname = \"ball\"\nvolume = \"mri/ball.nrrd\"\nfind = { label = 3 }\n";
    scene.write("pipeline.toml", (scene.read("pipeline.toml") + section).as_bytes());
    scene
}

/// Rows of the table of points, as numbers.
fn points(scene: &Scene) -> Vec<Vec<f64>> {
    let mut reader = csv::Reader::from_path(scene.path("results/slices/ball.csv")).unwrap();
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(header.join(","), "slice,contour,hole,point,i_px,j_px,x_mm,y_mm,z_mm,sigma_mm");
    reader.records().map(|r| r.unwrap().iter().map(|c| c.parse().unwrap()).collect()).collect()
}

#[test]
fn a_volume_becomes_contours_and_a_second_run_does_nothing() {
    let scene = scene();
    let (_, why, _) = scene.biplane(&["explain", "slices/"]);
    assert_eq!(why, "slices/ball: never ran\ndrawing/slices/ball: never ran\n");
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("Items: slices 1 run, 0 cached; drawing 2 run, 0 cached; segment 6 run"), "{out}");
    assert!(out.contains("Slices of ball: 9 contours in 8 of 12 slices"), "{out}");
    let rows = points(&scene);
    // About the middle of the ball, in the scanner's millimetres; a voxel is 0.8 mm wide.
    let middle = [10.0 + 0.8 * 19.5, 20.0 + 0.8 * 15.5, 30.0 + 2.0 * 5.5];
    for row in rows.iter().filter(|r| r[2] == 0.0) {
        let r = (0..3).map(|a| (row[6 + a] - middle[a]).powi(2)).sum::<f64>().sqrt();
        assert!((r - 8.0).abs() < 0.8, "{row:?} is {r} mm from the middle");
        assert!((row[6] - (10.0 + 0.8 * row[4])).abs() < 2e-5 && row[8] == 30.0 + 2.0 * row[0]);
    }
    let holes: Vec<f64> = rows.iter().filter(|r| r[2] == 1.0).map(|r| r[0]).collect();
    assert!(!holes.is_empty() && holes.iter().all(|slice| *slice == 6.0), "{holes:?}");
    let sheet = scene.read("results/slices/ball.svg");
    assert!(sheet.contains("ball: 12 slices, 8 with the bone") && sheet.contains("class=\"hole\""));
    let page = scene.read("results/report.html");
    assert!(page.contains("id=\"slices\"") && page.contains("src=\"slices&#x2f;ball.svg\""));
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(out.contains("Nothing to do: 27 items cached."), "{out}");
    let (_, why, _) = scene.biplane(&["explain"]);
    assert_eq!(why, "nothing would run: 27 items are cached\n");
    scene.edit("label = 3 }", "label = 3, smoothing_px = 1.5 }");
    let (_, why, _) = scene.biplane(&["explain"]);
    assert_eq!(
        why,
        "slices/ball: parameter smoothing_px changed from 1 to 1.5\ndrawing/slices/ball: runs if what it follows comes out \
         differently\n"
    );
    // A bone that is taken out of the study takes its files with it.
    let text = scene.read("pipeline.toml");
    scene.write("pipeline.toml", text.split("\n[[slices]]").next().unwrap().as_bytes());
    assert_eq!(scene.biplane(&["run"]).0, 0);
    assert!(!scene.path("results/slices").exists());
}

#[test]
fn a_slice_put_right_is_taken_and_only_its_bone_runs() {
    let scene = scene();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let before = points(&scene);
    let (code, out, err) = scene.biplane(&["edit", "--slices", "ball", "4"]);
    assert!(
        code == 0 && out.starts_with("wrote edits/slices/ball/4.svg\nOpen them in Inkscape"),
        "{out}{err}"
    );
    assert!(scene.path("edits/slices/ball/4.png").is_file(), "its picture");
    let (code, _, err) = scene.biplane(&["edit", "--slices", "ball", "4"]);
    assert!(code == 2 && err.contains("edits/slices/ball/4.svg is there already"), "{err}");
    let (code, _, err) = scene.biplane(&["edit", "--slices", "ball", "12"]);
    assert!(code == 2 && err.contains("the slices of ball are 0 to 11"), "{err}");
    let (code, _, err) = scene.biplane(&["edit", "--slices", "bal", "4"]);
    assert!(code == 2 && err.contains("did you mean `ball`?"), "{err}");
    // As it was written it is no edit.
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(out.contains("Nothing to do: 27 items cached."), "{out}");
    assert!(out.contains("Edited contours: 0 file(s) used, 1 not edited yet"), "{out}");

    let svg = scene.read("edits/slices/ball/4.svg");
    let moved =
        svg.replacen("inkscape:label=\"ball\"", "inkscape:label=\"ball\" transform=\"translate(2 0)\"", 1);
    assert_ne!(moved, svg);
    scene.write("edits/slices/ball/4.svg", moved.as_bytes());
    let (_, why, _) = scene.biplane(&["explain"]);
    assert_eq!(
        why,
        "slice_edits/ball: never ran\ndrawing/slices/ball: runs if what it follows comes out differently\n"
    );
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(
        out.contains("slices 0 run, 1 cached; slice_edits 1 run, 0 cached; drawing 1 run, 1 cached"),
        "{out}"
    );
    assert!(out.contains("segment 0 run, 6 cached") && out.contains(", 1 drawn by hand"), "{out}");
    let after = points(&scene);
    let of = |rows: &[Vec<f64>], slice: f64| -> Vec<Vec<f64>> {
        rows.iter().filter(|r| r[0] == slice).cloned().collect()
    };
    for slice in [2.0, 3.0, 5.0, 6.0, 9.0] {
        assert_eq!(of(&after, slice), of(&before, slice), "slice {slice}");
    }
    let middle = |rows: Vec<Vec<f64>>| {
        let ends = [f64::min, f64::max].map(|f| rows.iter().map(|r| r[4]).reduce(f).unwrap());
        (ends[0] + ends[1]) / 2.0
    };
    let by = middle(of(&after, 4.0)) - middle(of(&before, 4.0));
    assert!((by - 2.0).abs() < 0.1, "moved by {by} px");
    let (code, listed, _) = scene.biplane(&["edits"]);
    assert_eq!(code, 0, "{listed}");
    let row: Vec<&str> =
        listed.lines().find(|l| l.contains("slices/ball/4.svg")).unwrap().split_whitespace().collect();
    assert_eq!(row[..3], ["edits/slices/ball/4.svg", "ball", "yes"]);
    assert!((1.0..3.0).contains(&row[4].parse::<f64>().unwrap()), "{listed}");
    assert!(scene.biplane(&["run"]).1.contains("Nothing to do: 28 items cached."));

    // Another volume of the same size: the edit is kept, and said to be of the old one.
    let mut other = labels([COLUMNS, ROWS, SLICES]);
    *other.last_mut().unwrap() = 1;
    scene.write("mri/ball.nrrd", &other);
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code == 0 && out.contains("slices 1 run"), "{out}{err}");
    assert!(err.contains("edits/slices/ball/4.svg: the volume has changed since it was drawn"), "{err}");
}

#[test]
fn a_table_edits_a_slice_too_and_open_pieces_are_refused() {
    let scene = scene();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let square = "body,piece,i,x_px,y_px,closed\nball,a,0,10,10,1\nball,a,1,20,10,1\nball,a,2,20,20,1\nball,a,3,10,20,1\n";
    scene.write("edits/slices/ball/5.csv", square.as_bytes());
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let rows = points(&scene);
    assert!(rows.iter().filter(|r| r[0] == 5.0).all(|r| (8.0..22.0).contains(&r[4]) && r[9] == 0.4));
    scene.write("edits/slices/ball/5.csv", square.replace(",1\n", ",0\n").as_bytes());
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("slice_edits/ball: edits/slices/ball/5.csv: piece `a` is open"), "{out}");
    assert!(out.contains("3 good, 0 doubtful, 0 failed"), "{out}");
    assert_eq!(scene.biplane(&["edits"]).0, 1);
    scene.write("edits/slices/ball/5.csv", b"body,x_px,y_px\nball,,\n");
    scene.write("edits/slices/ball/99.csv", square.as_bytes());
    scene.write("edits/slices/bal/5.csv", square.as_bytes());
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(
        code == 1 && out.contains("edits/slices/ball/99.csv: the volume has the slices 0 to 11"),
        "{out}"
    );
    assert!(
        err.contains(
            "edits/slices/bal/5.csv is not used: [[slices]] has no bone `bal`: did you mean `ball`?"
        ),
        "{err}"
    );
    std::fs::remove_file(scene.path("edits/slices/ball/99.csv")).unwrap();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    assert!(points(&scene).iter().all(|r| r[0] != 5.0), "the bone is not in that slice");
}

#[test]
fn a_bad_volume_fails_alone_and_is_told() {
    let scene = scene();
    scene.write("mri/ball.nrrd", &labels([COLUMNS, ROWS, SLICES])[..9000]);
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("slices/ball: mri/ball.nrrd"), "{out}");
    assert!(
        out.contains("3 good, 0 doubtful, 0 failed") && out.contains("Slices of ball: none, see above"),
        "{out}"
    );
    assert_eq!(scene.biplane(&["plan"]).0, 1);
    let (code, _, err) = scene.biplane(&["edit", "--slices", "ball"]);
    assert!(code == 3 && err.contains("slices/ball"), "{err}");
    // No such label, with those there are.
    scene.write("mri/ball.nrrd", &labels([COLUMNS, ROWS, SLICES]));
    scene.edit("label = 3", "label = 4");
    let (code, out, _) = scene.biplane(&["run"]);
    assert!(code == 1 && out.contains("no voxel has the label 4; the volume has the labels 3"), "{out}");
}

#[test]
fn faults_of_the_section_are_shown_at_their_lines() {
    let scene = scene();
    let faults = [
        ("label = 3 }", "labels = 3 }", "unknown key `labels`", ":26:"),
        ("label = 3 }", "label = 3, shell_mm = 90.0 }", "shell_mm = 90", "26:32"),
        ("label = 3 }", "method = \"bone\" }", "needs seed_mm", ":26:"),
        ("ball.nrrd", "bal.nrrd", "did you mean `ball.nrrd`?", ":25:"),
        ("name = \"squat\"", "name = \"slices\"", "a trial cannot be called `slices`", ":15:"),
    ];
    for (from, to, expected, place) in faults {
        let text = scene.read("pipeline.toml");
        scene.edit(from, to);
        let (code, _, err) = scene.biplane(&["plan"]);
        assert!(code == 2 && err.contains(expected) && err.contains(place), "{expected} {place}\n{err}");
        scene.write("pipeline.toml", text.as_bytes());
    }
}
