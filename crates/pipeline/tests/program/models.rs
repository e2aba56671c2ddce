//! Models of bodies: from labels and contours to meshes that are matched, with their axes; a person's landmarks; faults.

use crate::scene::{HEADER, Scene, truth};

/// Voxels of the map along x, y and z, and their side, mm.
const SIZE: [usize; 3] = [128, 92, 68];
const VOXEL_MM: f64 = 0.5;

/// A map of labels in which 2 is the box of the scene, 52 x 34 x 22 mm about the origin.
fn labels() -> Vec<u8> {
    let first = SIZE.map(|n| -VOXEL_MM * (n as f64 - 1.0) / 2.0);
    let mut bytes = format!(
        "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\nspace directions: (0.5,0,0) (0,0.5,0) \
         (0,0,0.5)\nspace origin: ({},{},{})\nencoding: raw\n\n",
        SIZE[0], SIZE[1], SIZE[2], first[0], first[1], first[2]
    )
    .into_bytes();
    let within = |i: usize, axis: usize, side: f64| (first[axis] + VOXEL_MM * i as f64).abs() < side / 2.0;
    for k in 0..SIZE[2] {
        for j in 0..SIZE[1] {
            for i in 0..SIZE[0] {
                bytes.push(if within(i, 0, 52.0) && within(j, 1, 34.0) && within(k, 2, 22.0) {
                    2
                } else {
                    0
                });
            }
        }
    }
    bytes
}

// A box ends in flat faces, and pictures show them.
const FROM_SLICES: &str =
    "slices = \"box\"\nmodel = { points = 3000 }\naxes = { body = \"other\" }\ncut_ends = \"keep\"";

/// The scene with its box from a map of labels, and axes.
fn scene() -> Scene {
    let scene = Scene::new();
    scene.write("mri/box.nrrd", &labels());
    scene.edit("mesh = \"box.stl\"", FROM_SLICES);
    let section = "\n[[slices]]\nname = \"box\"\nvolume = \"mri/box.nrrd\"\nfind = { label = 2 }\n";
    scene.write("pipeline.toml", (scene.read("pipeline.toml") + section).as_bytes());
    scene
}

/// Distance of the found place of the box's middle from the true one in each frame, mm, and the verdicts.
fn errors(scene: &Scene) -> Vec<(f64, String)> {
    let mut reader = csv::Reader::from_path(scene.path("results/poses.csv")).unwrap();
    let rows = reader.records().map(|row| row.unwrap());
    let off = |row: csv::StringRecord| {
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let (_, t) = truth(row[1].parse().unwrap());
        let off = (number(4) - t.x).hypot(number(5) - t.y).hypot(number(6) - t.z);
        (off, row[3].to_owned())
    };
    rows.map(off).collect()
}

#[test]
fn slices_become_a_model_that_is_matched_and_a_second_run_does_nothing() {
    let scene = scene();
    let (_, why, _) = scene.biplane(&["explain"]);
    for step in
        ["slices/box: never ran", "loft/box: never ran", "model/box: never ran", "axes/box: never ran"]
    {
        assert!(why.contains(step), "{step}: {why}");
    }
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("loft 1 run, 0 cached; model 1 run, 0 cached; axes 1 run, 0 cached"), "{out}");
    let found = errors(&scene);
    // The box's edges are sharp and those of a surface from voxels of 0.5 mm are not.
    assert!(
        found.len() == 3 && found.iter().all(|(mm, verdict)| *mm < 0.15 && verdict == "good"),
        "{found:?}"
    );
    for file in ["box.stl", "box.ply", "box.svg", "box_axes.csv", "box_axes.json", "README.txt"] {
        assert!(scene.path("results/models").join(file).is_file(), "{file}");
    }
    let page = scene.read("results/report.html");
    assert!(page.contains("id=\"models\"") && page.contains("src=\"models&#x2f;box.svg\""), "{page}");
    assert!(page.contains("proposed from the shape"));
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(out.contains("Nothing to do"), "{out}");
    let (code, again, err) = scene.biplane(&["inspect", "results/models/box.stl", "results/models/box.ply"]);
    assert!(code == 0 && again.contains("3,000") | again.contains("3000"), "{again}{err}");

    // Another number of points reruns what hangs on the model, and no slice.
    scene.edit("points = 3000", "points = 2000");
    let (_, why, _) = scene.biplane(&["explain"]);
    assert!(why.contains("model/box: parameter points changed from 3000 to 2000"), "{why}");
    assert!(!why.contains("loft/") && !why.contains("slices/box"), "{why}");
    scene.edit("points = 2000", "points = 3000");

    // A slice put right goes all the way.
    assert_eq!(scene.biplane(&["edit", "--slices", "box", "30"]).0, 0);
    let svg = scene.read("edits/slices/box/30.svg");
    let moved =
        svg.replacen("inkscape:label=\"box\"", "inkscape:label=\"box\" transform=\"translate(0.5 0)\"", 1);
    scene.write("edits/slices/box/30.svg", moved.as_bytes());
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("slice_edits 1 run, 0 cached; loft 1 run, 0 cached; model 1 run"), "{out}");
    assert!(out.contains("segment 0 run, 6 cached; match 3 run"), "{out}");
    // Where nothing is said, flat ends of a surface from slices are those at which its volume was cut.
    scene.edit("\ncut_ends = \"keep\"", "");
    let (_, why, _) = scene.biplane(&["explain", "match/*/0001"]);
    assert!(why.contains("parameter ignore_cut_ends"), "{why}");
}

#[test]
fn a_map_of_labels_becomes_a_model_without_contours() {
    let scene = scene();
    scene.edit("slices = \"box\"", "slices = \"box\"\nlabel_surface = {}");
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("label_surface 1 run, 0 cached; model 1 run") && !out.contains("loft"), "{out}");
    let found = errors(&scene);
    assert!(found.iter().all(|(mm, verdict)| *mm < 0.15 && verdict == "good"), "{found:?}");
}

#[test]
fn landmarks_of_a_person_win_and_run_the_axes_alone() {
    let scene = scene();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let proposed = scene.read("results/models/box_axes.csv");
    let given = "landmark,x_mm,y_mm,z_mm\norigin,1,2,3\nx,1,12,3\ny,1,2,13\nz,11,2,3\n";
    scene.write("edits/landmarks/box.csv", given.as_bytes());
    let (_, why, _) = scene.biplane(&["explain"]);
    assert!(why.contains("axes/box: input landmarks"), "{why}");
    assert!(!why.contains("match/") && !why.contains("model/box"), "{why}");
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(
        out.contains("model 0 run, 1 cached; axes 1 run") && out.contains("match 0 run, 3 cached"),
        "{out}"
    );
    let axes = scene.read("results/models/box_axes.csv");
    assert_ne!(axes, proposed);
    assert!(
        axes.contains("origin,1.000000,2.000000,3.000000") && axes.contains("z,51.000000,2.000000,3.000000")
    );
    assert_eq!(scene.read("edits/landmarks/box.csv"), given, "a run never writes there");
    // Strangers are told, a second file for the body is refused.
    scene.write("edits/landmarks/bos.csv", given.as_bytes());
    let (_, _, err) = scene.biplane(&["run"]);
    assert!(
        err.contains("edits/landmarks/bos.csv is not used") && err.contains("did you mean `box`?"),
        "{err}"
    );
    scene.write("edits/landmarks/box.fcsv", given.as_bytes());
    let (code, _, err) = scene.biplane(&["run"]);
    assert!(code == 3 && err.contains("keep one of them"), "{code} {err}");
}

#[test]
fn a_bone_without_a_surface_fails_alone() {
    let scene = scene();
    // A second body whose volume is damaged: the box from its mesh file goes on.
    let text = scene.read("pipeline.toml").replacen(FROM_SLICES, "mesh = \"box.stl\"", 1);
    let other = "\n[[body]]\nname = \"other\"\nslices = \"box\"\n\n[[trial]]";
    scene.write("pipeline.toml", text.replacen("\n[[trial]]", other, 1).as_bytes());
    let starts = scene.read("starts.csv");
    scene.write("starts.csv", (starts.clone() + &starts.replace("box", "other")[HEADER.len()..]).as_bytes());
    scene.write("mri/box.nrrd", &labels()[..9000]);
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 1, "{out}{err}");
    assert!(out.contains("slices/box: mri/box.nrrd"), "{out}");
    assert!(out.contains("3 good, 0 doubtful, 3 failed"), "{out}");
    let (code, why, err) = scene.biplane(&["plan"]);
    assert!(code == 1, "{why}{err}");
}

#[test]
fn a_study_of_models_alone_needs_no_pictures() {
    let scene = scene();
    let models = "[study]\nname = \"models\"\n\n[[slices]]\nname = \"box\"\nvolume = \"mri/box.nrrd\"\nfind = { label = 2 }\n\n[[body]]\nname \
                  = \"box\"\nslices = \"box\"\n";
    scene.write("pipeline.toml", models.as_bytes());
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("loft 1 run, 0 cached; model 1 run"), "{out}");
    assert!(scene.path("results/models/box.stl").is_file());
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(out.contains("Nothing to do"), "{out}");
    // Half of a study with pictures is a fault.
    scene.write(
        "pipeline.toml",
        (models.to_owned() + "\n[fluoroscope.A]\ncalibration = \"A.txt\"\n").as_bytes(),
    );
    let (code, _, err) = scene.biplane(&["run"]);
    assert!(code == 2 && err.contains("there is no trial"), "{err}");
}

#[test]
fn faults_of_a_body_are_shown_at_their_lines() {
    let scene = scene();
    let faults = [
        ("slices = \"box\"\nmodel", "slices = \"bos\"\nmodel", "did you mean `box`?", ":12:"),
        ("slices = \"box\"\nmodel", "model", "does not say where its surface comes from", ":11:"),
        ("slices = \"box\"\nmodel", "slices = \"box\"\nmesh = \"box.stl\"\nmodel", "says twice", ":11:"),
        ("slices = \"box\"\nmodel", "mesh = \"box.stl\"\nloft = {}\nmodel", "this one has a mesh", ":13:"),
        ("points = 3000", "points = 3", "points = 3", ":13:"),
        ("points = 3000", "point = 3000", "unknown key `point`", ":13:"),
        ("body = \"other\"", "body = \"femur\"", "side = \"left\"", ":14:"),
        ("axes = { body = \"other\" }", "loft = { cell_mm = 99.0 }", "cell_mm = 99", ":14:"),
        (
            "axes = { body = \"other\" }",
            "landmarks = \"starts.csv\"",
            "landmarks are for a body's axes",
            ":14:",
        ),
        ("axes = { body = \"other\" }", "label_surface = { label = 5 }", "not found by this label", ":14:"),
        ("name = \"squat\"", "name = \"landmarks\"", "a trial cannot be called `landmarks`", ":18:"),
    ];
    for (from, to, expected, place) in faults {
        let text = scene.read("pipeline.toml");
        scene.edit(from, to);
        let (code, _, err) = scene.biplane(&["plan"]);
        assert!(code == 2 && err.contains(expected) && err.contains(place), "{expected} {place}\n{err}");
        scene.write("pipeline.toml", text.as_bytes());
    }
}
