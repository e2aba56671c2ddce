//! What must hold of every drawing: well-formed, self-contained, every mark of the artifact drawn once, a bad verdict seen at once.

use biplane_artifact::{
    Bead, BeadList, Circle, DistortionTable, Environment, Frame, MatchedSpot, ModelScore, PlateFit,
    PoseRecord, SeenBead, TriangulatedBead, Verdict, ViewEnvironment,
};

use super::*;

/// An element, the number of the one it is in, and its class.
struct Element {
    name: String,
    within: Option<usize>,
    class: String,
}

/// Reads what the drawings use of XML, and panics where it is not well-formed.
fn elements(text: &str) -> Vec<Element> {
    let (mut all, mut open) = (Vec::<Element>::new(), Vec::<usize>::new());
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        let (before, tag) = rest.split_at(start);
        check_text(before);
        assert!(!open.is_empty() || before.trim().is_empty(), "text outside: {before:?}");
        let end = tag.find('>').expect("a tag ends");
        let inner = &tag[1..end];
        rest = &tag[end + 1..];
        if let Some(name) = inner.strip_prefix('/') {
            let last = open.pop().expect("an element is open");
            assert_eq!(all[last].name, name);
            continue;
        }
        let (inner, alone) = inner.strip_suffix('/').map_or((inner, false), |i| (i, true));
        let (name, mut attributes) = inner.split_once(' ').unwrap_or((inner, ""));
        assert!(all.is_empty() == open.is_empty(), "one root element");
        let mut seen = Vec::new();
        let mut class = String::new();
        while !attributes.is_empty() {
            let (key, after) = attributes.split_once("=\"").expect("a quoted value");
            let (value, after) = after.split_once('"').expect("the quote is closed");
            assert!(
                !seen.contains(&key) && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '-'),
                "{key}"
            );
            seen.push(key);
            check_text(value);
            if key == "class" {
                class = value.to_owned();
            }
            assert!(after.is_empty() || after.starts_with(' '), "{after}");
            attributes = after.trim_start();
        }
        all.push(Element { name: name.to_owned(), within: open.last().copied(), class });
        if !alone {
            open.push(all.len() - 1);
        }
    }
    assert!(open.is_empty() && rest.trim().is_empty());
    all
}

/// No mark of XML stands in a text unescaped, and no number in it is none.
fn check_text(text: &str) {
    for after in text.split('&').skip(1) {
        assert!(["amp;", "lt;", "gt;", "quot;", "#39;"].iter().any(|e| after.starts_with(e)), "&{after}");
    }
    assert!(!text.contains('<') && !text.chars().any(|c| c.is_control() && c != '\n'));
    if text.len() < 10_000 {
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}

/// Marks directly within the groups of a class.
fn marks(text: &str, class: &str) -> usize {
    let all = elements(text);
    assert!(all.iter().any(|e| e.class == class), "no group {class}");
    all.iter().filter(|e| e.within.is_some_and(|w| all[w].class == class)).count()
}

fn check(text: &str) {
    assert!(text.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1000\""));
    let all = elements(text);
    for foreign in ["script", "foreignObject", "a", "use", "style"] {
        assert!(all.iter().all(|e| e.name != foreign), "{foreign}");
    }
    assert_eq!(text.matches("://").count(), 1, "the name of SVG is the only address");
    assert_eq!(text.matches("href=").count(), text.matches("href=\"data:image/png;base64,").count());
    assert!(text.len() < 1_500_000, "{} bytes", text.len());
}

/// Noise in every bit, which compresses least.
fn frame() -> Frame {
    let mut state = 1_u64;
    let samples = (0..1024 * 1024)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 48) as u16
        })
        .collect();
    Frame { width: 1024, height: 1024, samples, bits: 16 }
}

fn params() -> PlateDrawingParams {
    PlateDrawingParams { view: "A <&> \"left\"".to_owned(), max_held_out_px: 0.3 }
}

fn fit() -> PlateFit {
    let spot = |i: usize, used| MatchedSpot {
        at_px: [60.0 + 40.0 * (i % 23) as f64, 60.0 + 40.0 * (i / 23) as f64],
        plate_mm: [0.0, 0.0],
        residual_px: [0.05 * (i as f64).sin(), if used { 0.02 } else { 9.0 }],
        used,
    };
    let samples = (0..11 * 11).map(|i| ((i % 11) as f64 * 110.0 - 40.0, (i / 11) as f64 * 110.0 - 40.0));
    PlateFit {
        size: [1024, 1024],
        table: DistortionTable {
            first_px: [-40.0, -40.0],
            step_px: [110.0, 110.0],
            count: [11, 11],
            ideal_px: samples.map(|(x, y)| [x + 1e-5 * (x - 500.0) * (y - 500.0), y * 1.01]).collect(),
        },
        pixel_mm: 0.31,
        plate_from_ideal: [[0.31, 0.0, 0.0], [0.0, 0.31, 0.0]],
        mirrored: false,
        model: "polynomial, degree 4".to_owned(),
        models: vec![ModelScore {
            name: "polynomial, degree 4".to_owned(),
            fitted_rms_px: 0.05,
            held_out_rms_px: 0.06,
            held_out_p95_px: 0.1,
        }],
        matched: (0..460).map(|i| spot(i, i % 100 != 7)).collect(),
        strays_px: vec![[100.0, 100.0], [700.0, 900.0]],
        missing_px: vec![[300.0, 300.0]; 3],
        border: Some(Circle { centre_px: [505.0, 508.0], radius_px: 500.0 }),
        before_rms_px: 8.2,
        round_trip_px: 0.001,
        verdict: Verdict::Good,
        warnings: vec![],
    }
}

fn beads() -> BeadList {
    let bead = |i: u32| Bead {
        name: format!("<{i}>"),
        at_mm: [f64::from(i % 5) * 20.0 - 40.0, f64::from(i / 5) * 20.0 - 40.0, f64::from(i % 3) * 30.0],
        radius_mm: i.is_multiple_of(2).then_some(1.5),
        mark: false,
    };
    BeadList((0..20).map(bead).collect())
}

fn environment() -> Environment {
    let seen = |i: usize, picture| SeenBead {
        picture,
        bead: i,
        name: format!("<{i}>"),
        at_px: [200.0 + 30.0 * i as f64, 300.0],
        residual_px: [0.1, -0.05],
        used: i != 3,
    };
    let view = |name: &str, source: [f64; 3]| ViewEnvironment {
        view: name.to_owned(),
        size: [1024, 1024],
        pixel_mm: 0.31,
        source,
        centre: source.map(|v| -v),
        along_x: [0.0, 0.0, 1.0],
        along_y: [0.7, 0.7, 0.0],
        matrix: [[3000.0, 0.0, 500.0], [0.0, 3000.0, 500.0], [0.0, 1.0, 0.0]],
        source_to_detector_mm: 1000.0,
        reprojection_rms_px: 0.12,
        sigma_px: 0.1,
        beads: (0..16).map(|i| seen(i, 0)).chain((0..9).map(|i| seen(i, 1))).collect(),
        strays: vec![(0, [50.0, 60.0]), (1, [70.0, 80.0]), (1, [90.0, 80.0])],
        missing: vec![(0, 17, [400.0, 500.0]), (0, 999, [410.0, 500.0]), (1, 12, [1.0, 2.0])],
    };
    let identity = PoseRecord { translation_mm: [0.0; 3], quaternion_wxyz: [1.0, 0.0, 0.0, 0.0] };
    Environment {
        views: vec![view("A & B", [0.0, -500.0, 0.0]), view("<script>", [500.0, 0.0, 10.0])],
        bead_frames: vec![identity; 2],
        angle_deg: Some(90.3),
        triangulated: vec![TriangulatedBead {
            picture: 0,
            bead: 1,
            name: "<1>".to_owned(),
            error_mm: [0.01; 3],
        }],
        triangulation_rms_mm: Some(0.02),
        covariance: vec![vec![0.1; 18]; 18],
        verdict: Verdict::Good,
        warnings: vec![],
    }
}

fn bead_params(view: usize, picture: usize) -> BeadDrawingParams {
    BeadDrawingParams { view, picture, max_reprojection_px: 0.5 }
}

const SPACE: SpaceDrawingParams = SpaceDrawingParams { max_reprojection_px: 0.5, max_triangulation_mm: 0.2 };

#[test]
fn every_hole_is_drawn_once_as_what_became_of_it() {
    let fit = fit();
    let plate = plate_drawing(&frame(), &fit, &params()).unwrap();
    check(&plate);
    let used = fit.matched.iter().filter(|m| m.used).count();
    assert_eq!((used, marks(&plate, "used")), (455, 455));
    assert_eq!(marks(&plate, "rejected"), 5);
    assert_eq!((marks(&plate, "strays"), marks(&plate, "missing"), marks(&plate, "border")), (2, 3, 1));
    assert!(plate.contains("A &lt;&amp;&gt; &quot;left&quot;"));
    let residual = residual_drawing(&fit, &params()).unwrap();
    check(&residual);
    assert_eq!((marks(&residual, "residuals"), marks(&residual, "rejected")), (455, 5));
    assert_eq!(plate, plate_drawing(&frame(), &fit, &params()).unwrap());
}

#[test]
fn every_bead_is_drawn_once_in_its_picture() {
    let (frame, environment, beads) = (frame(), environment(), beads());
    for (picture, counts) in [(0, [15, 1, 1, 2]), (1, [8, 1, 2, 1])] {
        let text = bead_drawing(&frame, &environment, &beads, &bead_params(1, picture)).unwrap();
        check(&text);
        assert_eq!(["used", "unused", "strays", "missing"].map(|class| marks(&text, class)), counts);
        let [used, unused, _, missing] = counts;
        assert_eq!((marks(&text, "arrows"), marks(&text, "arrows-unused")), (used, unused));
        assert_eq!(marks(&text, "names"), used + unused + missing);
        assert!(text.contains("&lt;3&gt;") && text.contains("&lt;script&gt;: the frame of beads, picture"));
    }
    let space = space_drawing(&environment, &beads, &SPACE);
    check(&space);
    assert_eq!(marks(&space, "beads"), 4 * 20, "in four panels");
    assert_eq!((marks(&space, "source"), marks(&space, "detector")), (4 * 2, 4 * 2));
}

#[test]
fn a_bad_verdict_has_a_red_frame_and_its_reasons_on_top() {
    let (mut fit, mut environment) = (fit(), environment());
    let good = residual_drawing(&fit, &params()).unwrap();
    assert!(!good.contains("class=\"alarm\"") && !good.contains("class=\"reasons\""));
    for verdict in [Verdict::Doubtful, Verdict::Failed] {
        (fit.verdict, environment.verdict) = (verdict, verdict);
        fit.warnings = vec!["held-out residual 1.2 px > 0.3 px & <so on>".to_owned()];
        environment.warnings = vec!["beads \"4\" and \"5\" are swapped?".to_owned()];
        let all = [
            plate_drawing(&frame(), &fit, &params()).unwrap(),
            residual_drawing(&fit, &params()).unwrap(),
            bead_drawing(&frame(), &environment, &beads(), &bead_params(0, 0)).unwrap(),
            space_drawing(&environment, &beads(), &SPACE),
        ];
        for text in all {
            check(&text);
            assert_eq!((marks(&text, "alarm"), marks(&text, "reasons")), (1, 1));
            let reasons = text.contains("1.2 px &gt; 0.3 px &amp; &lt;so on&gt;")
                || text.contains("beads &quot;4&quot; and &quot;5&quot; are swapped?");
            assert!(reasons && text.contains(&verdict.word().to_uppercase()));
        }
    }
}

#[test]
fn numbers_that_are_none_do_no_harm() {
    for wild in [f64::NAN, f64::INFINITY, -1e300, 0.0] {
        let mut fit = fit();
        (fit.before_rms_px, fit.pixel_mm, fit.models[0].held_out_rms_px) = (wild, wild, wild);
        fit.border = Some(Circle { centre_px: [wild, 3.0], radius_px: wild });
        (fit.matched[0].at_px, fit.matched[1].residual_px, fit.missing_px[0]) =
            ([wild; 2], [wild; 2], [wild; 2]);
        let params = PlateDrawingParams { max_held_out_px: wild, ..params() };
        check(&plate_drawing(&frame(), &fit, &params).unwrap());
        check(&residual_drawing(&fit, &params).unwrap());
        let mut environment = environment();
        environment.views[0].source = [wild; 3];
        environment.views[1].pixel_mm = wild;
        environment.views[1].matrix = [[wild; 3]; 3];
        environment.views[1].beads[0].at_px = [wild; 2];
        environment.covariance = vec![vec![wild]];
        environment.triangulated[0].error_mm = [wild; 3];
        let mut beads = beads();
        (beads.0[2].at_mm, beads.0[4].radius_mm) = ([wild; 3], Some(wild));
        check(&bead_drawing(&frame(), &environment, &beads, &bead_params(1, 0)).unwrap());
        check(&space_drawing(&environment, &beads, &SPACE));
    }
}

#[test]
fn what_is_missing_leaves_a_drawing_of_the_rest() {
    let mut fit = fit();
    (fit.matched, fit.models, fit.border) = (vec![], vec![], None);
    check(&plate_drawing(&frame(), &fit, &params()).unwrap());
    check(&residual_drawing(&fit, &params()).unwrap());
    let mut environment = environment();
    let nothing = bead_drawing(&frame(), &environment, &BeadList(vec![]), &bead_params(0, 7)).unwrap();
    check(&nothing);
    assert_eq!(marks(&nothing, "used"), 0);
    environment.views.clear();
    (environment.bead_frames, environment.angle_deg, environment.triangulation_rms_mm) = (vec![], None, None);
    check(&space_drawing(&environment, &BeadList(vec![]), &SPACE));
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let (small, fit) = (Frame { width: 2, height: 1, samples: vec![1, 2], bits: 8 }, fit());
    assert!(matches!(plate_drawing(&small, &fit, &params()), Err(DrawingError::Size { .. })));
    let environment = environment();
    let draw = |frame: &Frame, view| bead_drawing(frame, &environment, &beads(), &bead_params(view, 0));
    assert!(matches!(draw(&small, 0), Err(DrawingError::Size { .. })));
    assert!(matches!(draw(&frame(), 2), Err(DrawingError::View { view: 2, views: 2 })));
    let spoil = |spoil: fn(&mut DistortionTable)| {
        let mut fit = fit.clone();
        spoil(&mut fit.table);
        residual_drawing(&fit, &params())
    };
    let tables: [fn(&mut DistortionTable); 5] = [
        |t| t.count = [11, 12],
        |t| t.count = [usize::MAX, 2],
        |t| (t.count, t.ideal_px) = ([1, 1], vec![[0.0, 0.0]]),
        |t| t.step_px[1] = 0.0,
        |t| t.ideal_px[5][0] = f64::NAN,
    ];
    for table in tables {
        assert!(matches!(spoil(table), Err(DrawingError::Table { .. })));
    }
}
