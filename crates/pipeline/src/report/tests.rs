//! The page: small with many frames, escaped, and drawn by the bundle of its sources.

use super::*;
use crate::outcome::{FrameOutcome, StartKind};
use crate::study::{Body, MeshSource, SurfaceSource, Trial, View};

fn study() -> Study {
    let view = |name: &str| View {
        name: name.into(),
        mask: None,
        source: crate::study::ViewSource::File {
            calibration: "c".into(),
            pixel_origin: crate::config::Origin::Centre,
            distortion: None,
            uncertainty: None,
        },
    };
    Study {
        root: "/study".into(),
        name: "<script> & co".into(),
        views: vec![view("A"), view("B")],
        bodies: vec![Body {
            name: "femur".into(),
            surface: SurfaceSource::File(MeshSource { path: "m".into(), units: None }),
            model: None,
            ignore_cut_ends: false,
            axes: None,
            landmarks: None,
            reference: None,
        }],
        slices: vec![],
        joints: vec![],
        trials: vec![Trial {
            name: "lunge".into(),
            frames: vec![(0, "a".into()), (1, "b".into())],
            pair_by: crate::config::PairBy::Number,
            offset: 0,
            frame_rate_hz: None,
            starts: None,
            bodies: vec![0],
        }],
        plate: None,
        beads: None,
        spots: Default::default(),
        distortion: Default::default(),
        environment: Default::default(),
        doctor: Default::default(),
        segment: Default::default(),
        edit: Default::default(),
        matching: Default::default(),
        tracking: Default::default(),
        smoothing: Default::default(),
        contour: Default::default(),
        output: "/study/results".into(),
        export: Default::default(),
    }
}

#[test]
fn two_thousand_frames_are_one_small_page_of_escaped_text_without_pictures() {
    let frame = |i: usize| FrameOutcome {
        trial: 0,
        label: format!("{i:04}"),
        time_s: Some(i as f64 / 100.0),
        bodies: vec![BodyOutcome {
            body: 0,
            start: StartKind::File,
            start_pose: Some(biplane_geometry::Pose::identity()),
            result: Err("a < b".into()),
            bridged: None,
            contours: vec![],
        }],
        overlays: vec![(0, format!("overlays/lunge/{i:04}_A.png").into())],
        script: Some(format!("report/frames/lunge/{i:04}.js").into()),
    };
    let outcome = Outcome { frames: (0..2000).map(frame).collect(), ..Outcome::default() };
    let provenance = Provenance { parameters: vec![], inputs: vec![("x.png".into(), "00".into())] };
    let contents = Contents { provenance: &provenance, bodies: &Bodies::default(), searches: &[] };
    let page = page(&study(), &outcome, &contents).unwrap();
    assert!(page.contains("&lt;script&gt; &amp; co") && !page.contains("<script> & co"), "escaped");
    assert!(page.contains("\\u003cscript> & co"), "escaped within the script");
    assert!(page.contains("not matched: a &lt; b"));
    assert!(!page.contains("data:image"), "pictures are not in it");
    assert_eq!(page.matches("report/frames/lunge/").count(), 2000);
    assert_eq!(page.matches("<td class=\"t failed\">failed</td>").count(), 2000, "for who has no scripts");
    assert!(!page.contains("/study") && !page.contains("http"), "no absolute path, no network");
    assert!(page.len() < 2_000_000, "{} bytes", page.len());
}

/// FNV-1a of 64 bits over names and contents, as `web/build.mjs` does it.
#[test]
fn the_bundle_is_that_of_its_sources() {
    let web = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("web");
    let sources = std::fs::read_dir(web.join("src")).unwrap();
    let mut names: Vec<String> =
        sources.map(|entry| format!("src/{}", entry.unwrap().file_name().to_str().unwrap())).collect();
    names.extend(["build.mjs", "package-lock.json", "package.json"].map(str::to_owned));
    names.sort();
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for name in names {
        let text = std::fs::read(web.join(&name)).unwrap();
        for byte in format!("{name}\n{}\n", text.len()).bytes().chain(text) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    }
    let head = SCRIPT.lines().next().unwrap();
    assert!(
        head.contains(&format!("Sources {hash:016x}.")),
        "web/ was changed: run `npm ci && npm run build` in crates/pipeline/web. {hash:016x}, but {head}"
    );
    let lock = std::fs::read_to_string(web.join("package-lock.json")).unwrap();
    assert!(!lock.contains("resolved"), "the lock file names no host");
    assert!(LICENCES.contains("Copyright") && LICENCES.contains("three") && LICENCES.contains("uPlot"));
}

#[test]
fn odd_names_still_make_a_link() {
    assert_eq!(url("overlays/a b/x#1_é.png"), "overlays/a%20b/x%231_%C3%A9.png");
}
