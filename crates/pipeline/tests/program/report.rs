//! The report: tried in a browser without a screen, the same bytes anywhere, and no patient in it.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::scene::Scene;

/// A browser, where there is one.
fn browser() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|path| path.is_file())
}

/// What the page found when it tried itself; none where there is no browser.
fn selftest(page: &Path) -> Option<String> {
    let Some(browser) = browser() else {
        eprintln!("skipped: no Chromium found (chromium, chromium-browser, google-chrome)");
        return None;
    };
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
        ])
        .args(["--window-size=1280,800", "--virtual-time-budget=240000", "--dump-dom", "--no-first-run"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("file://{}#selftest", page.display()))
        .output()
        .unwrap();
    let page = String::from_utf8_lossy(&output.stdout).into_owned();
    let from = page.find("<pre id=\"selftest-result\">");
    assert!(from.is_some(), "the page did not try itself:\n{}", String::from_utf8_lossy(&output.stderr));
    let from = from.unwrap();
    Some(page[from..].split("</pre>").next().unwrap().to_owned())
}

fn every_file(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { all.extend(every_file(&path)) } else { all.push(path) }
    }
    all.sort();
    all
}

/// Opens, shows the frame one clicks, plays, draws plots and 3D, and a pose dragged in the review becomes a row of `edits/poses.csv`
/// that the next run starts from.
#[test]
fn the_page_opens_draws_plays_and_saves_a_pose_in_a_browser() {
    let scene = Scene::new();
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    let Some(told) = selftest(&scene.path("results/report.html")) else { return };
    assert!(told.contains("selftest passed") && told.matches("\nok ").count() >= 6, "{told}");

    let row = told.lines().find_map(|line| line.strip_prefix("row ")).unwrap();
    let header = "trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz";
    scene.write("edits/poses.csv", format!("{header}\n{row}\n").as_bytes());
    let (code, out, err) = scene.biplane(&["run"]);
    assert!(code < 2 && out.contains("segment 0 run, 6 cached"), "{out}{err}");
    let poses = scene.read("results/poses.csv");
    let name: Vec<&str> = row.split(',').take(3).collect();
    let edited = poses.lines().find(|line| line.starts_with(&name.join(","))).unwrap();
    assert!(edited.contains(",edit,"), "{edited}");

    let (code, out, err) = scene.biplane(&["report", "--single-file"]);
    assert_eq!(code, 0, "{out}{err}");
    let alone = tempfile::tempdir().unwrap();
    let moved = alone.path().join("sent.html");
    std::fs::copy(scene.path("results/report_single.html"), &moved).unwrap();
    let told = selftest(&moved).unwrap();
    assert!(told.contains("selftest passed"), "the page alone, in another folder: {told}");
}

#[test]
fn the_report_has_the_same_bytes_in_another_folder_and_stays_when_nothing_changed() {
    let results = |scene: &Scene| -> Vec<(String, Vec<u8>)> {
        let folder = scene.path("results");
        let read = |path: PathBuf| {
            (path.strip_prefix(&folder).unwrap().display().to_string(), std::fs::read(&path).unwrap())
        };
        every_file(&folder).into_iter().map(read).collect()
    };
    let (one, other) = (Scene::new(), Scene::new());
    assert_eq!(one.biplane(&["run"]).0, 0);
    assert_eq!(other.biplane(&["run", "--threads", "1"]).0, 0);
    let (first, second) = (results(&one), results(&other));
    assert!(first.iter().any(|(name, _)| name == "report/frames/squat/0002.js"));
    assert!(first == second, "another folder, another number of threads");
    let folder = one.path(".").canonicalize().unwrap().display().to_string();
    for (name, bytes) in &first {
        assert!(!String::from_utf8_lossy(bytes).contains(&folder), "{name} names the folder");
    }
    let time = |name: &str| std::fs::metadata(one.path(name)).unwrap().modified().unwrap();
    let before =
        ["results/report.html", "results/report/models.js", "results/report/frames/squat/0001.js"].map(time);
    assert_eq!(one.biplane(&["run"]).0, 0);
    let after =
        ["results/report.html", "results/report/models.js", "results/report/frames/squat/0001.js"].map(time);
    assert_eq!(before, after);

    // A frame that is taken out of the study leaves the report.
    for view in ["A", "B"] {
        std::fs::remove_file(one.path(&format!("frames/{view}/0001.png"))).unwrap();
    }
    assert_eq!(one.biplane(&["run"]).0, 0);
    assert!(!one.path("results/report/frames/squat/0001.js").exists());
    assert!(one.path("results/report/frames/squat/0002.js").exists());
}

#[test]
fn the_report_as_one_file_has_the_frames_that_were_asked_for() {
    let scene = Scene::new();
    let (code, _, err) = scene.biplane(&["report", "--single-file"]);
    assert!(code == 3 && err.contains("Run `biplane run` first"), "{code} {err}");
    assert_eq!(scene.biplane(&["run"]).0, 0);
    let (code, out, err) =
        scene.biplane(&["report", "--single-file", "--frames", "2,squat/0000", "--output", "two.html"]);
    assert_eq!(code, 0, "{out}{err}");
    let page = scene.read("two.html");
    assert_eq!(page.matches("data-src=\"report/frames/").count(), 2);
    assert!(
        page.contains("data-src=\"report/frames/squat/0002.js\"")
            && !page.contains("data-src=\"report/frames/squat/0001.js\"")
    );
    assert!(!page.contains("src=\"report/report.js\""), "the script is in it");
    let (code, _, err) = scene.biplane(&["report", "--single-file", "--frames", "17"]);
    assert!(code == 3 && err.contains("no frame `17`") && err.contains("squat/0000"), "{code} {err}");
}

const SECRETS: [&str; 5] = ["Secret^Walter", "MRN-0815", "19450203", "Secret Hospital", "Dr. Hidden"];

/// A DICOM object of one picture whose header names a patient wherever it can: explicit little endian, 16 bits.
fn dicom(width: u16, height: u16, samples: &[u8]) -> Vec<u8> {
    fn element(out: &mut Vec<u8>, tag: (u16, u16), vr: &str, value: &[u8]) {
        out.extend(tag.0.to_le_bytes());
        out.extend(tag.1.to_le_bytes());
        out.extend(vr.as_bytes());
        let mut value = value.to_vec();
        if value.len() % 2 == 1 {
            value.push(if vr == "UI" || vr == "OW" { 0 } else { b' ' });
        }
        if vr == "OW" {
            out.extend([0, 0]);
            out.extend((value.len() as u32).to_le_bytes());
        } else {
            out.extend((value.len() as u16).to_le_bytes());
        }
        out.extend(value);
    }
    let mut meta = Vec::new();
    element(&mut meta, (2, 2), "UI", b"1.2.840.10008.5.1.4.1.1.12.2");
    element(&mut meta, (2, 3), "UI", b"1.2.3.4.5.6.7.8.9");
    element(&mut meta, (2, 0x10), "UI", b"1.2.840.10008.1.2.1");
    let mut out = vec![0; 128];
    out.extend(b"DICM");
    element(&mut out, (2, 0), "UL", &(meta.len() as u32).to_le_bytes());
    out.extend(meta);
    let [name, id, birth, hospital, physician] = SECRETS;
    element(&mut out, (8, 0x80), "LO", hospital.as_bytes());
    element(&mut out, (8, 0x90), "PN", physician.as_bytes());
    element(&mut out, (8, 0x103e), "LO", name.as_bytes());
    element(&mut out, (0x10, 0x10), "PN", name.as_bytes());
    element(&mut out, (0x10, 0x20), "LO", id.as_bytes());
    element(&mut out, (0x10, 0x30), "DA", birth.as_bytes());
    element(&mut out, (0x10, 0x4000), "LT", name.as_bytes());
    let number = |out: &mut Vec<u8>, tag, value: u16| element(out, tag, "US", &value.to_le_bytes());
    number(&mut out, (0x28, 2), 1);
    element(&mut out, (0x28, 4), "CS", b"MONOCHROME2");
    number(&mut out, (0x28, 0x10), height);
    number(&mut out, (0x28, 0x11), width);
    number(&mut out, (0x28, 0x100), 16);
    number(&mut out, (0x28, 0x101), 8);
    number(&mut out, (0x28, 0x102), 7);
    number(&mut out, (0x28, 0x103), 0);
    let pixels: Vec<u8> = samples.iter().flat_map(|s| u16::from(*s).to_le_bytes()).collect();
    element(&mut out, (0x7fe0, 0x10), "OW", &pixels);
    out
}

#[test]
fn no_patient_of_a_dicom_header_is_anywhere_in_the_results() {
    let scene = Scene::new();
    for view in ["A", "B"] {
        for frame in 0..3 {
            let png = scene.path(&format!("frames/{view}/{frame:04}.png"));
            let picture = image::open(&png).unwrap().to_luma8();
            let object = dicom(picture.width() as u16, picture.height() as u16, picture.as_raw());
            let there = |secret: &str| object.windows(secret.len()).any(|w| w == secret.as_bytes());
            assert!(SECRETS.into_iter().all(there), "the file does name the patient");
            scene.write(&format!("frames/{view}/{frame:04}.dcm"), &object);
            std::fs::remove_file(png).unwrap();
        }
    }
    let (code, out, err) = scene.biplane(&["run"]);
    assert_eq!(code, 0, "{out}{err}");
    assert_eq!(scene.biplane(&["report", "--single-file"]).0, 0);
    let mut looked = 0;
    for file in [every_file(&scene.path("results")), every_file(&scene.path(".biplane"))].concat() {
        let bytes = std::fs::read(&file).unwrap();
        looked += 1;
        for secret in SECRETS.into_iter().chain(["Secret", "Walter", "Hidden", "1.2.3.4.5.6.7.8.9"]) {
            assert!(
                !bytes.windows(secret.len()).any(|w| w == secret.as_bytes()),
                "`{secret}` in {}",
                file.display()
            );
        }
    }
    assert!(looked > 20 && scene.path("results/report/frames/squat/0000.js").exists(), "{looked} files");
    for text in [out, err] {
        assert!(!text.contains("Secret") && !text.contains("MRN"), "{text}");
    }
}
