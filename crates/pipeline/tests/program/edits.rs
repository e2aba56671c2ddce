//! Outlines that a person puts right: written, taken, listed, never overwritten.

use std::time::SystemTime;

use crate::scene::Scene;

fn column(scene: &Scene, name: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_path(scene.path("results/poses.csv")).unwrap();
    let at = reader.headers().unwrap().iter().position(|h| h == name).unwrap();
    reader.records().map(|r| r.unwrap()[at].to_owned()).collect()
}

/// Everything in `edits/`: names, bytes, times of change.
fn all_edits(scene: &Scene) -> Vec<(String, Vec<u8>, SystemTime)> {
    let mut all = Vec::new();
    let mut folders = vec![scene.path("edits")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            if entry.path().is_dir() {
                folders.push(entry.path());
            } else {
                let modified = entry.metadata().unwrap().modified().unwrap();
                all.push((
                    entry.path().display().to_string(),
                    std::fs::read(entry.path()).unwrap(),
                    modified,
                ));
            }
        }
    }
    all.sort();
    all
}

/// A study that was run, with the drawing of frame 1, view A.
fn drawn() -> Scene {
    let scene = Scene::new();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let (code, out, err) = scene.biplane(&["edit", "squat", "1", "A"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.starts_with("wrote edits/squat/0001_A.svg\nOpen them in Inkscape"), "{out}");
    scene
}

/// Moves what is in the layer of the box.
fn move_layer(scene: &Scene, x: f64) {
    let text = scene.read("edits/squat/0001_A.svg");
    let layer = "inkscape:label=\"box\"";
    assert!(text.contains(layer), "{text}");
    let moved = text.replacen(layer, &format!("{layer} transform=\"translate({x} 0)\""), 1);
    scene.write("edits/squat/0001_A.svg", moved.as_bytes());
}

#[test]
fn an_outline_put_right_is_taken_and_only_its_frame_runs() {
    let scene = drawn();
    let svg = scene.read("edits/squat/0001_A.svg");
    assert!(
        svg.contains("xlink:href=\"../../frames/A/0001.png\"") && svg.contains("biplane:frame=\"0001\""),
        "{svg}"
    );
    let before = all_edits(&scene);
    // As it was written it is no edit.
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 0);
    assert!(out.contains("Nothing to do: 25 items cached."), "{out}");
    assert!(out.contains("Edited contours: 0 file(s) used, 1 not edited yet"), "{out}");
    let (code, listed, _) = scene.biplane(&["edits"]);
    assert_eq!(code, 0);
    let row = |listed: &str| -> Vec<String> {
        let row = listed.lines().find(|l| l.contains("0001_A.svg")).unwrap();
        row.split_whitespace().map(str::to_owned).collect()
    };
    assert_eq!(row(&listed)[..8], ["edits/squat/0001_A.svg", "box", "no", "-", "-", "-", "not", "edited"]);
    assert_eq!(all_edits(&scene), before, "a run writes nothing there");

    // 8 px are 2 mm at the body: the other view and the other frames stay.
    let x = |frame: usize| column(&scene, "tx_mm")[frame].parse::<f64>().unwrap();
    let old = [x(0), x(1), x(2)];
    move_layer(&scene, 8.0);
    let before = all_edits(&scene);
    let (_, why, _) = scene.biplane(&["explain"]);
    let after = |item: &str| format!("{item}: runs if what it follows comes out differently\n");
    let expected = "edit/squat/0001/A/box: never ran\n".to_owned()
        + &["match/squat/0001/box", "contour/squat/0001/A/box", "contour/squat/0001/B/box"]
            .map(after)
            .concat()
        + &["overlay/squat/0001/A", "overlay/squat/0001/B", "report_frame/squat/0001"].map(after).concat();
    assert_eq!(why, expected);
    let (_, out, err) = scene.biplane(&["run"]);
    assert!(
        out.contains(
            "segment 0 run, 6 cached; edit 1 run, 0 cached; match 1 run, 2 cached; contour 2 run, 4 cached"
        ),
        "{out}{err}"
    );
    assert!(out.contains("Edited contours: 1 file(s) used, 0 not edited yet"), "{out}");
    assert_eq!([x(0), x(2)], [old[0], old[2]]);
    let moved = x(1) - old[1];
    assert!((1.0..3.0).contains(&moved), "moved by {moved} mm");
    assert_eq!(all_edits(&scene), before);
    assert!(scene.read("results/report.html").contains("A: edited by hand"));
    let (code, listed, _) = scene.biplane(&["edits"]);
    assert_eq!(code, 0);
    let row = row(&listed);
    let median: f64 = row[3].parse().unwrap();
    assert_eq!(row[..3], ["edits/squat/0001_A.svg", "box", "yes"]);
    assert!((1.0..=8.0).contains(&median), "{listed}");
    assert!(scene.biplane(&["run"]).1.contains("Nothing to do: 26 items cached."));
    assert_eq!(scene.biplane(&["doctor"]).2, "", "it reads what was matched");
}

#[test]
fn a_damaged_edit_stops_only_its_frame() {
    let scene = drawn();
    let text = scene.read("edits/squat/0001_A.svg");
    let line = 1 + text[..text.find("<path").unwrap()].matches('\n').count();
    scene.write("edits/squat/0001_A.svg", text.replacen(" d=\"M ", " d=\"M x", 1).as_bytes());
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 1, "{out}");
    let message = format!(
        "edit/squat/0001/A: edits/squat/0001_A.svg, line {line}: <path> `box 1` (id box_1): its path data cannot be read"
    );
    assert!(out.contains(&message), "{message}\n{out}");
    assert_eq!(column(&scene, "verdict"), ["good", "failed", "good"]);
    assert_eq!(column(&scene, "reason")[1], "not matched: edit/squat/0001/A failed");
    let (code, listed, _) = scene.biplane(&["edits"]);
    assert!(code == 1 && listed.contains("Cannot be used (1):\n  edits/squat/0001_A.svg, line"), "{listed}");
    assert!(scene.biplane(&["plan"]).1.contains("edits/squat/0001_A.svg, line"));
    let (code, _, err) = scene.biplane(&["edit", "squat", "1", "A", "--again"]);
    assert!(code == 3 && err.contains("edits/squat/0001_A.svg, line"), "{err}");
    // Cut in half, as a full disk leaves it.
    scene.write("edits/squat/0001_A.svg", &text.as_bytes()[..text.len() / 2]);
    let (code, out, _) = scene.biplane(&["run"]);
    assert!(code == 1 && out.contains(": the file is damaged:"), "{out}");
    scene.write("edits/squat/0001_A.svg", text.as_bytes());
    assert_eq!(scene.biplane(&["run"]).0, 0);
}

#[test]
fn nothing_that_is_there_is_overwritten() {
    let scene = drawn();
    move_layer(&scene, 2.0);
    let before = all_edits(&scene);
    let (code, _, err) = scene.biplane(&["edit", "squat", "1", "A"]);
    assert_eq!(code, 2);
    assert!(err.starts_with("edits/squat/0001_A.svg is there already and is not overwritten"), "{err}");
    assert_eq!(all_edits(&scene), before);
    assert!(scene.biplane(&["edit", "squat", "1", "A", "--again"]).2.contains("not up to date"));
    assert!(scene.biplane(&["run"]).0 < 2);
    let (code, out, err) = scene.biplane(&["edit", "squat", "1", "A", "--again"]);
    assert_eq!(code, 0, "{err}");
    assert!(out.starts_with("wrote edits/squat/0001_A.new.svg\nFiles named `.new` are not used"), "{out}");
    let after = all_edits(&scene);
    assert!(before.iter().all(|file| after.contains(file)) && after.len() == before.len() + 1);
    let (code, listed, _) = scene.biplane(&["edits"]);
    assert!(
        code == 1
            && listed.contains("edits/squat/0001_A.new.svg is not used: it was written beside the edit that is used; take what you need from it"),
        "{listed}"
    );
    let (code, _, err) = scene.biplane(&["edit", "squat", "1", "A", "--again"]);
    assert!(code == 2 && err.starts_with("edits/squat/0001_A.new.svg is there already"), "{err}");
    // A table for the same picture: which one is meant?
    std::fs::remove_file(scene.path("edits/squat/0001_A.new.svg")).unwrap();
    scene.write("edits/squat/1_A.csv", b"body,x_px,y_px\nbox,1,2\nbox,9,9\n");
    let (code, out, _) = scene.biplane(&["run"]);
    assert_eq!(code, 1);
    assert!(
        out.contains(
            "edits/squat/0001_A.svg and edits/squat/1_A.csv are all for one picture; keep one of them"
        ),
        "{out}"
    );
}

#[test]
fn a_picture_that_changed_since_is_flagged_and_the_edit_used() {
    let scene = drawn();
    move_layer(&scene, 2.0);
    let mut picture = image::open(scene.path("frames/A/0001.png")).unwrap().to_luma8();
    picture.put_pixel(3, 3, image::Luma([0]));
    let mut png = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut png, image::ImageFormat::Png).unwrap();
    scene.write("frames/A/0001.png", png.get_ref());
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code < 2 && out.contains("Edited contours: 1 file(s) used"), "{out}{err}");
    let warning = "0001_A.svg: the picture has changed since it was drawn; it is used";
    assert!(err.contains(warning) && scene.read("results/report.html").contains(warning), "{err}");
    assert!(scene.biplane(&["edits"]).1.contains("the picture has changed since"));
}

#[test]
fn files_of_no_picture_are_named_with_what_may_be_meant() {
    let scene = drawn();
    move_layer(&scene, 2.0);
    let text = scene.read("edits/squat/0001_A.svg");
    for name in ["squat/0001_a.svg", "squat/0009_A.svg", "squad/0001_A.svg", "0001_A.svg"] {
        scene.write(&format!("edits/{name}"), text.as_bytes());
    }
    std::fs::remove_file(scene.path("edits/squat/0001_A.svg")).unwrap();
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code == 0 && out.contains("Nothing to do"), "{out}");
    for said in [
        "edits/squat/0001_a.svg is not used: its name is not FRAME_VIEW: trial squat has no view `a`: did you mean `A`?",
        "edits/squat/0009_A.svg is not used: trial squat has no frame `0009`, it has 0000 to 0002",
        "edits/squad/0001_A.svg is not used: the study has no trial `squad`: did you mean `squat`?",
        "edits/0001_A.svg is not used: it lies beside the trials' folders; expected edits/TRIAL/FRAME_VIEW.svg",
    ] {
        assert!(err.contains(said), "{said}\n{err}");
    }
    // The file says which body: of a body that is not there too.
    scene.edit("name = \"box\"\nmesh", "name = \"boxes\"\nmesh");
    let starts = scene.read("starts.csv").replace(",box,", ",boxes,");
    scene.write("starts.csv", starts.as_bytes());
    scene.write("edits/squat/0001_A.svg", text.replace("stroke:#56c8ff", "stroke:red").as_bytes());
    for (wish, said) in [
        (["edit", "squad", "1", "A"], "there is no trial `squad`: did you mean `squat`?"),
        (["edit", "squat", "9", "A"], "there is no frame `9`: known here: `0000`, `0001`, `0002`"),
        (["edit", "squat", "1", "C"], "there is no view `C`"),
    ] {
        let (code, _, err) = scene.biplane(&wish);
        assert!(code == 2 && err.contains(said), "{err}");
    }
}

#[test]
fn tables_and_bodies_of_which_nothing_is_trusted() {
    let scene = Scene::new();
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let (code, out, _) = scene.biplane(&["edit", "squat", "1", "--csv"]);
    assert!(
        code == 0 && out.starts_with("wrote edits/squat/0001_A.csv\nwrote edits/squat/0001_B.csv\n"),
        "{out}"
    );
    assert!(scene.biplane(&["run"]).1.contains("0 file(s) used, 2 not edited yet"));
    // Half of the outline in A.
    let text = scene.read("edits/squat/0001_A.csv");
    let rows: Vec<&str> = text.lines().filter(|l| l.starts_with("box,")).collect();
    let half = format!(
        "body,piece,closed,trusted,x_px,y_px\n{}\n",
        rows[..rows.len() / 2].join("\n").replace(",1,1,", ",0,1,")
    );
    scene.write("edits/squat/0001_A.csv", half.as_bytes());
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code < 2 && out.contains("1 file(s) used, 1 not edited yet"), "{out}{err}");
    // Nothing of it in A: the match has the other view alone, and says so.
    scene.write("edits/squat/0001_A.csv", b"body,piece,x_px,y_px\nbox,,,\n");
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code < 2 && out.contains("edit 1 run"), "{out}{err}");
    assert_ne!(column(&scene, "verdict")[1], "good");
    assert!(scene.biplane(&["edits"]).1.contains("nothing of it is trusted in this picture"));
}

#[test]
fn a_picture_that_drawing_programs_show_too_dark_is_copied() {
    let scene = Scene::new();
    for frame in 0..3 {
        let name = format!("frames/A/{frame:04}.png");
        let picture = image::open(scene.path(&name)).unwrap().to_luma8();
        let deep =
            image::ImageBuffer::<image::Luma<u16>, _>::from_fn(picture.width(), picture.height(), |x, y| {
                image::Luma([16 * u16::from(picture.get_pixel(x, y)[0])])
            });
        let mut png = std::io::Cursor::new(Vec::new());
        deep.write_to(&mut png, image::ImageFormat::Png).unwrap();
        scene.write(&name, png.get_ref());
    }
    // Grey levels are a sixteenth of what they were.
    scene.edit("[match]", "[segment]\nhigh_threshold = 0.2\nlow_threshold = 0.1\n\n[match]");
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code < 2, "{out}{err}");
    let (code, out, err) = scene.biplane(&["edit", "squat", "0", "A"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(scene.read("edits/squat/0000_A.svg").contains("xlink:href=\"0000_A.png\""));
    let shown = image::open(scene.path("edits/squat/0000_A.png")).unwrap().to_luma8();
    let (low, high) = shown.pixels().fold((255, 0), |(low, high), p| (p[0].min(low), p[0].max(high)));
    assert_eq!((low, high), (0, 255));
}

#[test]
fn outlines_to_look_at_are_listed_and_written_down() {
    let scene = Scene::new();
    // No outline is found to its last pixel.
    scene.edit("[match]", "[contour]\nflag_found_share = 1.0\n\n[match]");
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("Look at these outlines (") && out.contains("`biplane edit --flagged`"), "{out}");
    let listed = out.lines().filter(|l| l.starts_with("  squat 000")).count();
    assert!(
        listed > 0
            && scene.read("results/report.html").contains(&format!("<b>{listed}</b>outlines to look at")),
        "{out}"
    );
    let (code, said, err) = scene.biplane(&["edit", "--flagged"]);
    assert!(code == 0 && said.matches("wrote edits/squat/").count() == listed, "{said}{err}\n{out}");
    let (_, said, _) = scene.biplane(&["edit"]);
    assert!(
        said.starts_with(&format!("{listed} picture(s) have an edit already; it was left alone")),
        "{said}"
    );
    // What was put right asks no more.
    let first = out.lines().find(|l| l.starts_with("  squat 000")).unwrap();
    let (frame, view) = (&first[8..12], &first[13..14]);
    let path = format!("edits/squat/{frame}_{view}.svg");
    let text = scene.read(&path).replacen(
        "inkscape:label=\"box\"",
        "inkscape:label=\"box\" transform=\"translate(0.05 0)\"",
        1,
    );
    scene.write(&path, text.as_bytes());
    let (_, out, _) = scene.biplane(&["run"]);
    assert!(!out.contains(first) && out.contains("1 file(s) used"), "{out}");
}
