//! `biplane compare`, and studies that are matched by `method = "search"`.

use nalgebra::Matrix3;

use crate::scene::{HEADER, Scene, row, truth};

/// Two objectives by two optimisers, one pair of which cannot be.
const QUICK: [&str; 5] =
    ["compare", "--objectives", "symmetric,spline_grid", "--optimisers", "levenberg_marquardt,nelder_mead"];

fn with(more: &[&'static str]) -> Vec<&'static str> {
    QUICK.iter().chain(more).copied().collect()
}

/// The cells of the line of an objective and an optimiser.
fn line(table: &str, objective: &str, optimiser: &str) -> Vec<String> {
    let cells = |l: &str| l.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let mut lines = table.lines().map(cells);
    let found =
        lines.find(|c| c.len() > 3 && c[0] == objective && (optimiser.is_empty() || c[1] == optimiser));
    assert!(found.is_some(), "no line {objective} {optimiser} in\n{table}");
    found.unwrap()
}

#[test]
fn a_table_tells_errors_against_known_poses_and_the_file_has_the_same_numbers() {
    let scene = Scene::new();
    let known: String = (0..3).map(|frame| row(frame, 0.0)).collect();
    scene.write("known.csv", format!("{HEADER}{known}").as_bytes());
    let arguments =
        with(&["--reference", "known.csv", "--starts", "3", "--frames", "2", "--csv", "table.csv"]);
    let (code, out, err) = scene.biplane(&arguments);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.starts_with("2 bodies in frames (squat/0000/box, squat/0002/box), 3 starts each"), "{out}");
    let symmetric = line(&out, "symmetric", "levenberg_marquardt");
    // objective, optimiser, converged, right, error mm (three), error degrees (three), sd (two), calls, ms.
    let number = |cell: &str| cell.parse::<f64>().unwrap();
    assert_eq!(symmetric.len(), 14, "{out}");
    assert!(number(&symmetric[6]) < 0.1 && number(&symmetric[9]) < 0.5, "{out}");
    assert!(number(&symmetric[3]) > 99.0 && number(&symmetric[12]) > 3.0, "{out}");
    for (objective, optimiser) in
        [("symmetric", "nelder_mead"), ("spline_grid", "nelder_mead"), ("rim", ""), ("bingham2006", "")]
    {
        line(&out, objective, optimiser);
    }
    // What cannot be is told, not left out.
    let none = line(&out, "spline_grid", "levenberg_marquardt").join(" ");
    assert!(none.ends_with("the optimiser needs derivatives, the objective has none"), "{out}");
    let mut reader = csv::Reader::from_path(scene.path("table.csv")).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 6);
    assert_eq!((&rows[0][0], &rows[0][1], &rows[0][2]), ("symmetric", "levenberg_marquardt", "6"));
    assert!((number(&rows[0][7]) - number(&symmetric[6])).abs() < 6e-4, "{out}");
    // A comparison is no result.
    assert!(!scene.path("results").exists());

    // The same poses as 16 numbers a row, and the same errors.
    let matrix = |frame: usize| {
        let (q, t) = truth(frame);
        let r: Matrix3<f64> = *q.to_rotation_matrix().matrix();
        let row = |i: usize| format!("{},{},{},{}", r[(i, 0)], r[(i, 1)], r[(i, 2)], t[i]);
        format!("{frame:04},{},{},{},0,0,0,1\n", row(0), row(1), row(2))
    };
    let header = "frame,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23,m30,m31,m32,m33\n";
    scene.write("matrices.csv", format!("{header}{}", (0..3).map(matrix).collect::<String>()).as_bytes());
    let (code, again, err) =
        scene.biplane(&with(&["--reference", "matrices.csv", "--starts", "3", "--frames", "2"]));
    assert_eq!(code, 0, "{again}{err}");
    let same = line(&again, "symmetric", "levenberg_marquardt");
    assert_eq!(same[..13], symmetric[..13], "{again}");
}

#[test]
fn without_known_poses_it_tells_how_far_searches_end_apart() {
    let scene = Scene::new();
    let (code, out, err) = scene.biplane(&with(&["--starts", "4", "--frames", "1", "--no-presets"]));
    assert_eq!(code, 0, "{out}{err}");
    let symmetric = line(&out, "symmetric", "levenberg_marquardt");
    // objective, optimiser, converged, sd (two), calls, ms.
    assert_eq!(symmetric.len(), 7, "{out}");
    assert!(symmetric[3].parse::<f64>().unwrap() < 0.05, "{out}");
    assert!(!out.contains("bingham2006") && !out.contains("error mm"), "{out}");
}

#[test]
fn a_wrong_name_is_answered_with_those_there_are() {
    let scene = Scene::new();
    for (arguments, expected) in [
        (
            &["compare", "--objectives", "symetric"][..],
            &[
                "invalid value 'symetric'",
                "spline_grid, spline_rim, image_to_model, symmetric, non_overlap, inverse_point",
                "similar value exists: 'symmetric'",
            ][..],
        ),
        (
            &["compare", "--optimisers", "lm"],
            &["invalid value 'lm'", "levenberg_marquardt, sqp, bfgs, powell"],
        ),
        (&["compare", "--body", "bxo"], &["there is no body `bxo`, did you mean `box`?"]),
        (&["compare", "--trial", "squad"], &["there is no trial `squad`, did you mean `squat`?"]),
        (&["compare", "--starts", "0"], &["search.starts = 0, expected 1 to 1000"]),
    ] {
        let (code, _, err) = scene.biplane(arguments);
        assert_eq!(code, 2, "{arguments:?}: {err}");
        for text in expected {
            assert!(err.contains(text), "expected: {text}\nsaid:\n{err}");
        }
    }
    scene.write("known.csv", b"frame,m00\n0000,1\n");
    let (code, _, err) = scene.biplane(&["compare", "--reference", "known.csv"]);
    assert!(code == 3 && err.contains("known.csv: line 2: expected a frame and the 16 numbers"), "{err}");
    let (code, _, err) = scene.biplane(&["compare", "--reference", "none.csv"]);
    assert!(code == 3 && err.contains("none.csv"), "{err}");
}

#[test]
fn a_study_is_matched_by_any_objective_and_optimiser() {
    let scene = Scene::new();
    scene.edit(
        "[match]\n",
        "[match.search]\nobjective = \"image_to_model\"\noptimiser = \"sqp\"\nstarts = 2\n\n[match]\nmethod = \"search\"\n",
    );
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("3 good"), "{out}");
    // An optimiser that cannot search an objective is pointed at.
    scene.edit("image_to_model", "spline_grid");
    scene.edit("\"sqp\"", "\"levenberg_marquardt\"");
    let (code, _, err) = scene.biplane(&["run"]);
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("pipeline.toml:22:13") && err.contains("needs derivatives"), "{err}");
    scene.edit("\"levenberg_marquardt\"", "\"levenberg\"");
    let (code, _, err) = scene.biplane(&["run"]);
    assert!(code == 2 && err.contains("levenberg_marquardt"), "{err}");
}
