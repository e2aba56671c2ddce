//! A whole study through the program: results, caching, edits, failures that stop nothing else.

use crate::scene::{HEADER, SIZE, Scene, row, truth};

/// A column of `results/poses.csv`.
fn column(scene: &Scene, name: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_path(scene.path("results/poses.csv")).unwrap();
    let at = reader.headers().unwrap().iter().position(|h| h == name).unwrap();
    reader.records().map(|r| r.unwrap()[at].to_owned()).collect()
}

fn number(scene: &Scene, name: &str, row: usize) -> f64 {
    column(scene, name)[row].parse().unwrap()
}

#[test]
fn images_become_poses_and_a_second_run_does_nothing() {
    let scene = Scene::new();
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    for frame in 0..3 {
        let (_, t) = truth(frame);
        for (name, expected) in [("tx_mm", t.x), ("ty_mm", t.y), ("tz_mm", t.z)] {
            // Drawn with edges of a pixel (0.25 mm) in 8 bits: a tenth of a pixel is what can be asked.
            let found = number(&scene, name, frame);
            assert!((found - expected).abs() < 0.05, "frame {frame} {name}: {found}, expected {expected}");
        }
    }
    assert_eq!(column(&scene, "start"), ["file", "interpolated", "file"]);
    assert_eq!(column(&scene, "time_s"), ["0.000000", "0.100000", "0.200000"]);
    assert!(err.contains("1 of 3 frames have no start of their own"), "{err}");
    assert!(out.contains("Overlays results/overlays"), "{out}");
    let overlay = image::open(scene.path("results/overlays/squat/0002_B.png")).unwrap().to_rgb8();
    assert_eq!(overlay.dimensions(), (SIZE, SIZE));
    assert!(overlay.pixels().filter(|p| p[0].abs_diff(p[2]) > 60).count() > 200, "a coloured outline");
    assert!(scene.read("results/report.html").contains("1 of 3 frames have no start of their own"));
    let before: Vec<_> = ["poses.csv", "report.html"].map(|f| scene.read(&format!("results/{f}"))).into();
    let written = std::fs::metadata(scene.path("results/poses.csv")).unwrap().modified().unwrap();

    // A picture that cannot be decoded any more, and looks as it did from outside, shows that none is decoded.
    let path = scene.path("frames/A/0001.png");
    let modified = std::fs::metadata(&path).unwrap().modified().unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    let half = bytes.len() / 2;
    bytes[half..].fill(0);
    std::fs::write(&path, &bytes).unwrap();
    std::fs::File::options().write(true).open(&path).unwrap().set_modified(modified).unwrap();
    let (code, again, _) = scene.biplane(&["run"]);
    assert_eq!(code, 0);
    assert!(again.contains("Nothing to do: 25 items cached."), "{again}");
    let table = |text: &str| text.split("\n\n").next().unwrap().to_owned();
    assert_eq!(table(&out), table(&again));
    let after: Vec<_> = ["poses.csv", "report.html"].map(|f| scene.read(&format!("results/{f}"))).into();
    assert_eq!(before, after);
    assert_eq!(std::fs::metadata(scene.path("results/poses.csv")).unwrap().modified().unwrap(), written);
    assert_eq!(scene.biplane(&["explain"]).1, "nothing would run: 25 items are cached\n");
}

/// A box turned by half about any of its axes is the same box: no picture tells which way round it is, a start does.
#[test]
fn without_starts_a_box_is_found_and_said_to_be_ambiguous() {
    let scene = Scene::new();
    scene.edit("starts = \"starts.csv\"\n", "");
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("0 good, 0 doubtful, 3 ambiguous, 0 failed"), "{out}");
    assert_eq!(column(&scene, "start"), ["anywhere"; 3]);
    assert!(out.contains("edits/poses.csv") && !out.contains("Hardly a match is good"), "what to do: {out}");
    for frame in 0..3 {
        let (q, t) = truth(frame);
        for (name, expected) in [("tx_mm", t.x), ("ty_mm", t.y), ("tz_mm", t.z)] {
            for prefix in ["", "alternative_"] {
                let found = number(&scene, &format!("{prefix}{name}"), frame);
                assert!((found - expected).abs() < 0.05, "frame {frame} {prefix}{name}: {found}, {expected}");
            }
        }
        let turns = ["", "alternative_"].map(|prefix| {
            let [w, x, y, z] =
                ["qw", "qx", "qy", "qz"].map(|n| number(&scene, &format!("{prefix}{n}"), frame));
            let found = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
            (q.inverse() * found).quaternion().coords
        });
        // Of each rotation from the true pose one number of the quaternion is 1: none, or half a turn about an axis of the box.
        for turn in turns {
            assert!(turn.amax() > 0.999, "frame {frame}: {turn}");
        }
        assert!(turns[0].iamax() != turns[1].iamax(), "two poses: {turns:?}");
    }
    assert!(scene.read("results/report.html").contains("another pose fits as well"));
    // A start near one of them is the choice.
    scene.write("edits/poses.csv", format!("{HEADER}{}", row(1, 2.0)).as_bytes());
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(out.contains("3 good, 0 doubtful, 0 failed"), "{out}");
    std::fs::remove_dir_all(scene.path("edits")).unwrap();
    scene.biplane(&["run"]);
    assert_eq!(scene.biplane(&["explain"]).1, "nothing would run: 25 items are cached\n");
}

#[test]
fn how_sure_calibrations_are_is_in_what_is_stated_of_poses() {
    let scene = Scene::new();
    scene.biplane(&["run"]);
    let unknown = scene.read("results/report.html");
    assert!(unknown.contains("How sure the calibration is, is not known"));
    assert_eq!(column(&scene, "calibration_sigma_t_mm"), [""; 3]);
    let edges: Vec<f64> = (0..3).map(|frame| number(&scene, "sigma_t_mm", frame)).collect();
    for view in ["A", "B"] {
        let calibration = format!("calibration = \"{view}.txt\"");
        let stated = "uncertainty = { source_mm = 0.3, detector_mm = 0.1, pixel_mm = 0.25 }";
        scene.edit(&calibration, &format!("{calibration}\n{stated}"));
    }
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("match 3 run, 0 cached"), "nothing else hangs on it: {out}");
    for (frame, edges) in edges.iter().enumerate() {
        let [own, all] = ["calibration_sigma_t_mm", "sigma_t_mm"].map(|name| number(&scene, name, frame));
        // The source and the detector are about as far from the box as it is from one to the other: a third of a millimetre at
        // the source is half of it at the box.
        assert!((0.1..0.6).contains(&own), "{own}");
        // Both parts are in it; that of the edges is estimated anew, with weights that take no residual of the calibration for an outlier.
        let of_edges = (all * all - own * own).sqrt() / edges;
        assert!((0.5..2.0).contains(&of_edges), "{all} of {edges} and {own}");
        let half = number(&scene, "interval95_tx_mm", frame);
        let sigma = number(&scene, "cov_tx_tx_mm2", frame).sqrt();
        assert!((half - 1.959_964 * sigma).abs() < 1e-4, "{half} {sigma}");
    }
    let known = scene.read("results/report.html");
    assert!(!known.contains("is not known") && known.contains("source_mm = 0.3"));
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let results = ["1", "4"].map(|threads| {
        let scene = Scene::new();
        assert_eq!(scene.biplane(&["run", "--threads", threads]).0, 0);
        (scene.read("results/poses.csv"), scene.read("results/report.html"))
    });
    assert_eq!(results[0], results[1]);
}

#[test]
fn an_edit_wins_over_a_start_and_runs_only_its_frame() {
    let scene = Scene::new();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    scene.write("edits/poses.csv", format!("{HEADER}{}", row(2, 0.5)).as_bytes());
    let (_, why, _) = scene.biplane(&["explain"]);
    // Frame 1 starts halfway between 0 and 2, so it changes too.
    let expected = [1, 2].map(|f| {
        let after = |item: &str| format!("{item}: runs if what it follows comes out differently\n");
        let contours = ["A/box", "B/box"].map(|last| after(&format!("contour/squat/000{f}/{last}")));
        let overlays = ["A", "B"].map(|last| after(&format!("overlay/squat/000{f}/{last}")));
        let report = after(&format!("report_frame/squat/000{f}"));
        format!(
            "match/squat/000{f}/box: input start[0] changed\n{}{}{report}",
            contours.concat(),
            overlays.concat()
        )
    });
    assert_eq!(why, expected.concat());
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 0);
    assert!(out.contains("segment 0 run, 6 cached; match 2 run, 1 cached"), "{out}");
    assert_eq!(column(&scene, "start"), ["file", "interpolated", "edit"]);
    assert_eq!(scene.read("edits/poses.csv"), format!("{HEADER}{}", row(2, 0.5)));
}

#[test]
fn flat_ends_of_a_mesh_file_are_kept_where_nothing_is_said_and_ignoring_them_is_another_match() {
    let scene = Scene::new();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    scene.edit("mesh = \"box.stl\"", "mesh = \"box.stl\"\ncut_ends = \"keep\"");
    assert_eq!(scene.biplane(&["explain"]).1, "nothing would run: 25 items are cached\n");
    scene.edit("cut_ends = \"keep\"", "cut_ends = \"ignore\"");
    let (_, why, _) = scene.biplane(&["explain", "match/*/0001"]);
    assert!(why.contains("parameter ignore_cut_ends"), "{why}");
}

#[test]
fn a_changed_parameter_is_explained_and_a_comment_is_none() {
    let scene = Scene::new();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    scene.edit("search_px = 20.0", "# as far as starts are wrong\nsearch_px = 20.0\nseed = 1");
    assert_eq!(scene.biplane(&["explain"]).1, "nothing would run: 25 items are cached\n");
    scene.edit("search_px = 20.0", "search_px = 25.0");
    let (_, why, _) = scene.biplane(&["explain", "match/*/0001"]);
    assert_eq!(why, "match/squat/0001/box: parameter search_px changed from 20 to 25\n");
    assert!(
        scene.biplane(&["plan"]).1.contains("match              0       3"),
        "{}",
        scene.biplane(&["plan"]).1
    );
}

#[test]
fn bad_pictures_stop_only_their_frames() {
    let scene = Scene::new();
    let small = image::GrayImage::new(200, 256);
    let mut png = std::io::Cursor::new(Vec::new());
    small.write_to(&mut png, image::ImageFormat::Png).unwrap();
    scene.write("frames/A/0001.png", png.get_ref());
    let whole = std::fs::read(scene.path("frames/B/0002.png")).unwrap();
    scene.write("frames/B/0002.png", &whole[..whole.len() / 2]);
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 1, "{out}");
    let size = format!(
        "segment/squat/0001/A: frames/A/0001.png: 200 x 256 pixels, but the calibration of view A (A.txt) is for {SIZE} x {SIZE}"
    );
    assert!(out.contains(&size), "{out}");
    assert!(out.contains("segment/squat/0002/B: frames/B/0002.png"), "{out}");
    assert_eq!(column(&scene, "verdict"), ["good", "failed", "failed"]);
    assert_eq!(column(&scene, "reason")[1], "not matched: segment/squat/0001/A failed");
    assert!(scene.read("results/report.html").contains("Could not be done (2)"));
    // Mended, only what was missing runs.
    scene.write("frames/B/0002.png", &whole);
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(out.contains("segment 1 run, 4 cached; match 1 run, 1 cached"), "{out}");
}

#[test]
fn a_mask_hides_edges_of_its_view_alone() {
    let scene = Scene::new();
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}");
    let pipeline = scene.read("pipeline.toml");
    scene.write(
        "pipeline.toml",
        pipeline.replace("[fluoroscope.A]", "[fluoroscope.A]\nmask = \"mask.png\"").as_bytes(),
    );
    let put = |mask: &image::GrayImage| {
        let mut png = std::io::Cursor::new(Vec::new());
        mask.write_to(&mut png, image::ImageFormat::Png).unwrap();
        scene.write("mask.png", png.get_ref());
    };
    put(&image::GrayImage::from_pixel(SIZE, SIZE, image::Luma([255])));
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}");
    assert!(
        out.contains("segment 3 run, 3 cached; match 3 cached") || out.contains("match 0 run, 3 cached"),
        "{out}"
    );
    put(&image::GrayImage::new(SIZE, SIZE));
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("segment/squat/0001/A: no edge in a frame"), "{out}");
    put(&image::GrayImage::new(SIZE, SIZE / 2));
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(out.contains("the mask has"), "{out}");
}

#[test]
fn a_start_far_off_ends_in_a_verdict_and_a_code() {
    let scene = Scene::new();
    scene.write("starts.csv", format!("{HEADER}{}", row(0, 40.0)).as_bytes());
    let (code, out, _) = scene.biplane(&["run"]);
    assert!(
        code == 0 && out.contains("0 good, 0 doubtful, 3 ambiguous, 0 failed"),
        "looked for anywhere: {out}"
    );
    scene.edit("[match]", "[match]\nanywhere = false");
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 1, "{out}");
    assert!(column(&scene, "verdict").contains(&"failed".to_owned()), "{out}");
    assert_eq!(scene.biplane(&["status"]).0, 0);
}

#[test]
fn results_can_be_starts_and_are_shown_by_status() {
    let scene = Scene::new();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    scene.edit("starts.csv", "results/poses.csv");
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}");
    assert_eq!(column(&scene, "start"), ["file", "file", "file"]);
    let (_, status, _) = scene.biplane(&["status"]);
    assert!(status.contains("3 good, 0 doubtful, 0 failed (results/poses.csv)"), "{status}");
    let (_, cleaned, _) = scene.biplane(&["clean"]);
    assert!(cleaned.starts_with("freed 18 entries"), "{cleaned}");
}

#[test]
fn a_stopped_run_leaves_the_results_alone_and_the_next_one_ends_it() {
    let scene = Scene::new();
    let context = biplane_stage::Context::new();
    context.cancel();
    let study = || biplane::study::Study::load(&scene.path("pipeline.toml")).unwrap();
    let error = biplane::run::run(study(), 1, &context).unwrap_err();
    assert!(error.to_string().starts_with("stopped: 0 of 3 frames are finished"), "{error}");
    assert!(!scene.path("results").exists());
    let (_, outcome) = biplane::run::run(study(), 1, &biplane_stage::Context::new()).unwrap();
    assert_eq!(outcome.verdicts(), [3, 0, 0, 0]);
}

#[test]
fn a_picture_that_is_not_what_was_hashed_is_an_error_once_and_then_read_again() {
    let scene = Scene::new();
    // The next frame's picture with the size and time of this one: both made as long with bytes after their end.
    let path = scene.path("frames/A/0001.png");
    let mut bytes = std::fs::read(&path).unwrap();
    let mut other = std::fs::read(scene.path("frames/A/0002.png")).unwrap();
    let longest = bytes.len().max(other.len());
    bytes.resize(longest, 0);
    other.resize(longest, 0);
    scene.write("frames/A/0001.png", &bytes);
    let modified = std::fs::metadata(&path).unwrap().modified().unwrap();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    assert_eq!(scene.biplane(&["clean", "--all"]).0, 0);
    std::fs::write(&path, &other).unwrap();
    std::fs::File::options().write(true).open(&path).unwrap().set_modified(modified).unwrap();
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 1);
    assert!(
        out.contains("segment/squat/0001/A: input frame changed while the program ran; run it again"),
        "{out}"
    );
    let (_, out, _) = scene.biplane(&["run"]);
    // Its curves are there already: they go by content, and the next frame has this very picture.
    assert!(
        !out.contains("changed while") && out.contains("segment 0 run, 6 cached; match 1 run, 2 cached"),
        "{out}"
    );
}

#[test]
fn one_view_is_a_study_too() {
    let scene = Scene::new();
    scene.edit("[fluoroscope.B]\ncalibration = \"B.txt\"\n", "");
    scene.edit(", B = \"frames/B\"", "");
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code < 2, "{out}{err}");
    assert!(
        out.contains(
            "segment 3 run, 0 cached; match 3 run, 0 cached; contour 3 run, 0 cached; overlay 3 run, 0 cached"
        ),
        "{out}"
    );
}

#[test]
fn init_writes_a_file_that_runs_and_never_overwrites_one() {
    let scene = Scene::new();
    let (code, _, said) = scene.biplane(&["init"]);
    assert_eq!(code, 2);
    assert!(said.contains("is there already"), "{said}");
    std::fs::remove_file(scene.path("pipeline.toml")).unwrap();
    assert_eq!(scene.biplane(&["init", "."]).0, 0);
    let starts = scene.read("starts.csv").replace("squat", "trial1");
    scene.write("starts.csv", starts.as_bytes());
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}\n{}", scene.read("pipeline.toml"));
}

/// Fault: overlays of frames that were taken out of the study stayed among the results as if they were of it.
#[test]
fn overlays_of_frames_that_are_gone_go_and_a_persons_files_stay() {
    let scene = Scene::new();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    scene.write("results/notes.txt", b"mine");
    scene.write("results/overlays/squat/notes.txt", b"mine");
    for view in ["A", "B"] {
        std::fs::remove_file(scene.path(&format!("frames/{view}/0001.png"))).unwrap();
    }
    let (code, _, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("removed 3 picture(s) of earlier runs"), "{err}");
    let overlay = |frame: &str| scene.path(&format!("results/overlays/squat/{frame}.png")).exists();
    assert!(!overlay("0001_A") && !overlay("0001_B") && overlay("0000_A") && overlay("0002_B"));
    scene.edit("name = \"squat\"", "name = \"lunge\"");
    scene.write("starts.csv", scene.read("starts.csv").replace("squat", "lunge").as_bytes());
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let left: Vec<_> = std::fs::read_dir(scene.path("results/overlays/squat")).unwrap().collect();
    assert_eq!(left.len(), 1, "only the notes: {left:?}");
    assert_eq!(scene.read("results/notes.txt"), "mine");
}

/// Fault to guard against: views exchanged must never come out good.
#[test]
fn exchanged_views_never_come_out_good_and_the_end_says_what_to_check() {
    let scene = Scene::new();
    scene.edit("{ A = \"frames/A\", B = \"frames/B\" }", "{ A = \"frames/B\", B = \"frames/A\" }");
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(!column(&scene, "verdict").contains(&"good".to_owned()), "{out}");
    assert!(out.contains("of two views exchanged?"), "{out}");
}

/// Fault: that the folder of results cannot be written came out at the end, after all the work.
#[test]
fn results_that_cannot_be_written_are_told_before_the_work() {
    let scene = Scene::new();
    scene.write("results", b"a file in the way");
    let (code, _, err) = scene.biplane(&["run"]);
    assert!(code == 4 && err.contains("(the folder of results)"), "{err}");
    let (_, plan, _) = scene.biplane(&["plan"]);
    assert!(plan.contains("segment            0       6"), "{plan}");
}

/// Fault: `init` on a folder without start poses left a study that named no table, and none was there to fill in.
#[test]
fn init_writes_a_table_of_starts_that_may_stay_empty_and_never_overwrites_one() {
    let scene = Scene::new();
    for name in ["pipeline.toml", "starts.csv"] {
        std::fs::remove_file(scene.path(name)).unwrap();
    }
    let (code, out, _) = scene.biplane(&["init"]);
    assert!(code == 0 && out.contains("wrote ./starts.csv: a table of start poses"), "{out}");
    let table = scene.read("starts.csv");
    assert!(table.contains("# trial1,0000,box,...") && table.contains(HEADER), "{table}");
    // It need not be filled in; where it is, it counts.
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code == 0 && !err.contains("no start pose"), "{out}{err}");
    assert_eq!(column(&scene, "start"), ["anywhere"; 3]);
    scene.write("starts.csv", (table + &row(0, 1.0).replace("squat", "trial1")).as_bytes());
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code == 0 && out.contains("3 good, 0 doubtful, 0 failed"), "{out}{err}");

    std::fs::remove_file(scene.path("pipeline.toml")).unwrap();
    scene.write("starts.csv", b"mine");
    assert_eq!(scene.biplane(&["init"]).0, 0);
    assert_eq!(scene.read("starts.csv"), "mine");
    assert!(scene.read("pipeline.toml").contains("starts = \"start-poses.csv\""));
}
