//! Edits of contours: what is written, what Inkscape and others make of it, and what a person may do wrong.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use biplane_acquisition::edits::{
    Edit, Sketch, SketchBody, SketchPiece, read_edit, write_drawing, write_table,
};
use biplane_artifact::{ContentHash, EditedPiece};

const SIZE: [usize; 2] = [256, 200];
const BODIES: [&str; 2] = ["femoral component", "tray"];

type Pair = [f64; 2];

fn distance(a: Pair, b: Pair) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// An arc with points about a pixel apart.
fn arc(centre: Pair, radius: f64, from: f64, to: f64) -> Vec<Pair> {
    let count = ((to - from) * radius).ceil() as usize;
    let angle = |i: usize| from + (to - from) * i as f64 / count as f64;
    (0..=count).map(|i| [centre[0] + radius * angle(i).cos(), centre[1] + radius * angle(i).sin()]).collect()
}

/// An arc of radius 60 about (110, 90), trusted but for 10 points at either end; a circle of radius 20 about (200, 150); a wave.
fn sketch() -> Sketch {
    let piece = |points: Vec<Pair>, closed, off: usize| SketchPiece {
        sigmas: vec![0.05; points.len()],
        trusted: [off, points.len() - 1 - off],
        points,
        closed,
    };
    let mut circle = arc([200.0, 150.0], 20.0, 0.0, TAU);
    circle.pop();
    let wave = (0..=120).map(|i| 30.0 + f64::from(i)).map(|x| [x, 170.0 + 5.0 * (x / 25.0).sin()]).collect();
    let body = |name: &str, colour, pieces| SketchBody {
        name: name.into(),
        colour,
        pieces,
        flags: vec!["a < b".into()],
    };
    Sketch {
        trial: "lunge".into(),
        frame: "0017".into(),
        view: "A".into(),
        picture: ContentHash::from_bytes([7; 32]),
        size: SIZE,
        bodies: vec![
            body(
                BODIES[0],
                [86, 200, 255],
                vec![piece(arc([110.0, 90.0], 60.0, 0.3, 4.3), false, 10), piece(circle, true, 0)],
            ),
            body(BODIES[1], [255, 176, 0], vec![piece(wave, false, 0)]),
        ],
    }
}

fn saved(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/edits").join(name)
}

fn read_saved(name: &str) -> Edit {
    read_edit(saved(name), &BODIES, SIZE).unwrap()
}

fn try_text(name: &str, text: &[u8], bodies: &[&str]) -> Result<Edit, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    let shown = format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR);
    read_edit(&path, bodies, SIZE).map_err(|e| e.to_string().replace(&shown, ""))
}

/// A drawing whose user units are pixels.
fn svg(inner: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" viewBox=\"-0.5 -0.5 256 200\">\n{inner}\n</svg>"
    )
}

/// The one piece of a drawing of one body.
fn piece(inner: &str) -> EditedPiece {
    let edit =
        try_text("x.svg", svg(inner).as_bytes(), &["femur"]).unwrap_or_else(|e| panic!("{inner}: {e}"));
    let [body] = &edit.bodies[..] else { panic!("{inner}: {edit:?}") };
    let [piece] = &body.contour.pieces[..] else { panic!("{inner}: {edit:?}") };
    piece.clone()
}

/// How far one piece's points are from another's polygon, at most.
fn off(piece: &EditedPiece, from: &EditedPiece) -> f64 {
    let sides: Vec<(Pair, Pair)> = {
        let next = from.points.iter().cycle().skip(1);
        let count = from.points.len() - usize::from(!from.closed);
        from.points.iter().copied().zip(next.copied()).take(count).collect()
    };
    let to_side = |p: Pair, (a, b): (Pair, Pair)| {
        let along = [b[0] - a[0], b[1] - a[1]];
        let square = along[0].powi(2) + along[1].powi(2);
        let t = (((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / square).clamp(0.0, 1.0);
        distance(p, [a[0] + t * along[0], a[1] + t * along[1]])
    };
    let to_all = |p: &Pair| sides.iter().map(|s| to_side(*p, *s)).fold(f64::MAX, f64::min);
    piece.points.iter().map(to_all).fold(0.0, f64::max)
}

#[track_caller]
fn assert_on_circle(piece: &EditedPiece, centre: Pair, radius: f64, within: f64) {
    for p in &piece.points {
        let off = distance(*p, centre) - radius;
        assert!(off.abs() <= within, "{}: {p:?} is {off} px off the circle", piece.name);
    }
}

#[track_caller]
fn assert_near(a: Pair, b: Pair, within: f64) {
    assert!(distance(a, b) <= within, "{a:?}, expected {b:?}");
}

fn ends(piece: &EditedPiece) -> [Pair; 2] {
    [piece.points[0], *piece.points.last().unwrap()]
}

#[track_caller]
fn assert_same(a: &Edit, b: &Edit, within: f64) {
    assert_eq!(a.bodies.len(), b.bodies.len());
    for (a, b) in a.bodies.iter().zip(&b.bodies) {
        assert_eq!((a.body, a.contour.pieces.len()), (b.body, b.contour.pieces.len()));
        for (a, b) in a.contour.pieces.iter().zip(&b.contour.pieces) {
            assert_eq!(a.closed, b.closed, "{}", a.name);
            let off = off(a, b).max(off(b, a));
            assert!(off <= within, "{}: {off} px", a.name);
        }
    }
}

#[test]
fn what_is_written_comes_back_untouched() {
    let sketch = sketch();
    for (name, text) in
        [("a.svg", write_drawing(&sketch, "../frames/é 1.png")), ("a.csv", write_table(&sketch))]
    {
        let edit = try_text(name, text.as_bytes(), &BODIES).unwrap();
        assert_eq!(edit.notes, [""; 0], "{name}");
        let about = &edit.about;
        let said = [&about.trial, &about.frame, &about.view].map(|t| t.as_deref().unwrap());
        assert_eq!((said, about.picture), (["lunge", "0017", "A"], Some(sketch.picture)));
        let [femoral, tray] = &edit.bodies[..] else { panic!("{edit:?}") };
        assert!(!femoral.touched && !tray.touched, "{name}");
        let [open, closed] = &femoral.contour.pieces[..] else { panic!("{name}") };
        assert!(!open.closed && closed.closed);
        // A path is within 0.05 px of a smooth curve near the points, and written to 0.001 px.
        assert_on_circle(open, [110.0, 90.0], 60.0, 0.06);
        assert_on_circle(closed, [200.0, 150.0], 20.0, 0.06);
        for (at, end) in ends(open).iter().zip(sketch.bodies[0].pieces[0].trusted) {
            assert_near(*at, sketch.bodies[0].pieces[0].points[end], 0.06);
        }
        for piece in [open, closed, &tray.contour.pieces[0]] {
            assert!(piece.points.windows(2).all(|w| distance(w[0], w[1]) <= 1.0 + 1e-9), "{}", piece.name);
        }
    }
    assert!(write_drawing(&sketch, "../frames/é 1.png").contains("xlink:href=\"../frames/%C3%A9%201.png\""));
    assert!(write_drawing(&sketch, "x").matches("C ").count() > 3);
    // Nodes that a person can drag: fewer than one in 15 px of 240 + 126 + 121.
    let nodes = write_drawing(&sketch, "x")
        .lines()
        .filter(|l| l.trim().starts_with("d="))
        .map(|l| l.matches(' ').count() / 3)
        .sum::<usize>();
    assert!((12..33).contains(&nodes), "{nodes} nodes");
}

#[test]
fn a_body_without_an_edge_has_an_empty_layer_that_is_no_edit() {
    let mut sketch = sketch();
    sketch.bodies[1].pieces.clear();
    for (name, text) in [("a.svg", write_drawing(&sketch, "x.png")), ("a.csv", write_table(&sketch))] {
        let edit = try_text(name, text.as_bytes(), &BODIES).unwrap();
        assert!(edit.bodies[1].contour.pieces.is_empty() && !edit.bodies[1].touched, "{name}");
    }
}

#[test]
fn the_saved_files_are_of_the_sketch_and_saving_alone_is_no_edit() {
    // How smooth a written path is may change; what was committed is of the same sketch.
    let now = try_text("a.svg", write_drawing(&sketch(), "picture.png").as_bytes(), &BODIES).unwrap();
    let written = read_saved("written.svg");
    assert_same(&now, &written, 0.1);
    assert_eq!(now.about, written.about);
    for name in ["written.svg", "resaved.svg", "fitted.svg", "dpi.svg"] {
        let edit = read_saved(name);
        assert_same(&edit, &written, 0.02);
        assert_eq!(edit.about, written.about, "{name}");
        assert!(edit.bodies.iter().all(|b| !b.touched), "{name}");
        assert_eq!(edit.notes, [""; 0], "{name}");
    }
}

#[test]
fn a_moved_a_deleted_and_a_drawn_piece_of_inkscape() {
    let edit = read_saved("edited.svg");
    assert!(edit.bodies.iter().all(|b| b.touched));
    let [moved] = &edit.bodies[0].contour.pieces[..] else { panic!("the second one was deleted") };
    // Smooth curves run less exactly at their very ends, which are not trusted as written.
    assert_on_circle(moved, [115.0, 93.0], 60.0, 0.15);
    // The first mark stayed at (163.584, 116.995): the closest point of the moved circle. The other one was dragged beyond the end.
    let [from, to] = ends(moved);
    let (x, y) = (163.584 - 115.0, 116.995 - 93.0);
    assert_near(from, [115.0 + 60.0 * x / f64::hypot(x, y), 93.0 + 60.0 * y / f64::hypot(x, y)], 0.06);
    let end = *sketch().bodies[0].pieces[0].points.last().unwrap();
    assert_near(to, [end[0] + 5.0, end[1] + 3.0], 0.15);
    let [_, drawn] = &edit.bodies[1].contour.pieces[..] else { panic!("one was drawn") };
    assert_eq!(ends(drawn), [[40.0, 20.0], [90.0, 50.0]]);
    // de Casteljau at one half: (70, 20), (80, 20), (90, 30), (90, 40).
    let middle = drawn.points.iter().map(|p| distance(*p, [83.75, 26.25])).fold(f64::MAX, f64::min);
    assert!(middle < 0.5, "{middle}");
}

#[test]
fn mm_pages_moved_layers_and_plain_files_of_inkscape() {
    let mm = read_saved("mm.svg");
    assert_on_circle(&mm.bodies[0].contour.pieces[0], [120.0, 84.0], 60.0, 0.06);
    assert_on_circle(&mm.bodies[0].contour.pieces[1], [200.0, 150.0], 20.0, 0.06);
    assert!(mm.bodies[0].touched && !mm.bodies[1].touched);
    let plain = read_saved("plain.svg");
    assert!(!plain.bodies[0].touched && plain.bodies[1].touched);
    // Scaled by 1.1 about the middle of the box of piece and marks, x from 27.5 to 152.5: (90, ...).
    let [from, to] = ends(&plain.bodies[1].contour.pieces[0]);
    assert!((from[0] - 24.0).abs() < 0.02 && (to[0] - 156.0).abs() < 0.02, "{from:?} {to:?}");
    let grouped = read_saved("grouped.svg");
    assert_eq!(grouped.notes.len(), 1, "{:?}", grouped.notes);
    assert_eq!(
        grouped.notes[0],
        "line 82: <path> `femoral component 2` (id femoral_component_2) is hidden; it is left out"
    );
    let [turned] = &grouped.bodies[0].contour.pieces[..] else { panic!("{grouped:?}") };
    let [own, cloned] = &grouped.bodies[1].contour.pieces[..] else { panic!("{grouped:?}") };
    assert_near(cloned.points[50], [own.points[50][0], own.points[50][1] - 30.0], 1e-6);
    // Turned by 30 degrees and scaled by 0.8 like its marks, so trusted between the same points of it.
    let was = &read_saved("written.svg").bodies[0].contour.pieces[0];
    let chord = |p: &EditedPiece| {
        let [a, b] = ends(p);
        [b[0] - a[0], b[1] - a[1]]
    };
    let ([x, y], (sin, cos)) = (chord(was), f64::to_radians(30.0).sin_cos());
    assert_near(chord(turned), [0.8 * (cos * x - sin * y), 0.8 * (sin * x + cos * y)], 0.02);
}

/// Boxes as `inkscape --query-all` printed them (x, y, width, height with the stroke, px from the page's corner), less those of the
/// backdrop of the file, which begins half a pixel before the centre of the first one.
#[test]
fn inkscape_has_the_pieces_in_the_same_boxes() {
    // File, body, piece; the backdrop's corner, the size of a pixel, the stroke's width; the box; whether it begins and ends within the
    // trusted part at the left, top, right, bottom.
    type Row = (&'static str, usize, usize, Pair, f64, f64, [f64; 4], [bool; 4]);
    let all = [true; 4];
    let smooth = [true, false, false, true];
    let rows: [Row; 10] = [
        ("resaved.svg", 0, 1, [0.0, 0.0], 1.0, 1.5, [179.761, 129.76, 41.4782, 41.4794], all),
        ("resaved.svg", 0, 0, [0.0, 0.0], 1.0, 1.5, [49.7502, 34.7375, 118.904, 116.502], smooth),
        ("fitted.svg", 0, 1, [-49.7502, -34.7375], 1.0, 1.5, [130.011, 95.0229, 41.4782, 41.4794], all),
        ("fitted.svg", 0, 0, [-49.7502, -34.7375], 1.0, 1.5, [0.0, 0.0, 118.904, 116.502], smooth),
        ("mm.svg", 0, 1, [76.2244, 119.311], 1.0, 1.5, [255.985, 249.071, 41.4782, 41.4794], all),
        ("mm.svg", 0, 0, [76.2244, 119.311], 1.0, 1.5, [135.975, 148.049, 118.904, 116.502], smooth),
        ("dpi.svg", 0, 1, [0.0, 0.0], 1.066_67, 1.5, [191.746, 138.411, 44.2435, 44.2448], all),
        ("dpi.svg", 0, 0, [0.0, 0.0], 1.066_67, 1.5, [53.067, 37.0534, 126.831, 124.27], smooth),
        ("grouped.svg", 0, 0, [0.0, 0.0], 1.0, 1.2, [61.0296, 42.733, 81.6675, 97.1746], smooth),
        ("plain.svg", 0, 1, [0.0, 0.0], 1.0, 1.5, [179.761, 129.76, 41.4782, 41.4794], all),
    ];
    for (file, body, piece, backdrop, pixel, stroke, [x, y, w, h], sides) in rows {
        let edit = read_saved(file);
        let points = &edit.bodies[body].contour.pieces[piece].points;
        let least =
            |axis: usize, sign: f64| sign * points.iter().map(|p| sign * p[axis]).fold(f64::MAX, f64::min);
        let found = [least(0, 1.0), least(1, 1.0), least(0, -1.0), least(1, -1.0)];
        let to_px = |v: f64, axis: usize, grown: f64| (v - backdrop[axis]) / pixel + grown - 0.5;
        let expected = [
            to_px(x, 0, stroke / 2.0),
            to_px(y, 1, stroke / 2.0),
            to_px(x + w, 0, -stroke / 2.0),
            to_px(y + h, 1, -stroke / 2.0),
        ];
        for side in (0..4).filter(|s| sides[*s]) {
            let off = found[side] - expected[side];
            assert!(
                off.abs() <= 0.02,
                "{file}, piece {piece}, side {side}: {} and {}",
                found[side],
                expected[side]
            );
        }
    }
}

#[test]
fn other_writers() {
    let edit = read_saved("matplotlib.svg");
    // A polygon of 241 points is 0.0002 px off its circle.
    assert_on_circle(&edit.bodies[0].contour.pieces[0], [110.0, 90.0], 60.0, 0.002);
    let [from, to] = ends(&edit.bodies[1].contour.pieces[0]);
    assert_near(from, [30.0, 170.0], 1e-6);
    assert_near(to, [150.0, 170.0], 1e-6);
    // y = 170 - 60 t (1 - t) (1 - 2 t): its top where 6 t^2 - 6 t + 1 = 0, 10 / sqrt(3) px up and down.
    let curve = &edit.bodies[1].contour.pieces[0].points;
    let (top, bottom) = (
        curve.iter().map(|p| p[1]).fold(f64::MAX, f64::min),
        curve.iter().map(|p| p[1]).fold(f64::MIN, f64::max),
    );
    let rise = 10.0 / f64::sqrt(3.0);
    assert!((170.0 - top - rise).abs() < 0.02 && (bottom - 170.0 - rise).abs() < 0.02, "{top} {bottom}");
    assert!(edit.notes[0].contains("has no stroke and is in no layer of a body"), "{:?}", edit.notes);
    assert_eq!(edit.notes[1], "there is no picture in it, so its page was taken for the picture");

    let edit = read_edit(saved("cairo.svg"), &["femur"], SIZE).unwrap();
    let [arc] = &edit.bodies[0].contour.pieces[..] else { panic!("{edit:?}") };
    let (sin, cos) = f64::sin_cos(0.4);
    for p in &arc.points {
        let (x, y) = (p[0] - 110.0, p[1] - 90.0);
        // Cairo draws arcs to a tenth of a pixel, and writes 1/256 px.
        let radius = ((cos * x + sin * y) / 2.0).hypot(cos * y - sin * x);
        assert!((radius - 30.0).abs() < 0.06, "{p:?}: {radius}");
    }
    let message = read_edit(saved("cairo.svg"), &["femur", "tibia"], SIZE).unwrap_err().to_string();
    assert!(message.contains("cairo.svg, line 4: <path> without a name: it is in no layer"), "{message}");
}

#[test]
fn every_command_of_a_path() {
    // The same outline in different words: lines, cubics, quadratics and arcs.
    for (a, b) in [
        ("M 10 20 L 50 20 L 50 60", "m 10,20 h 40 v 40"),
        ("M 10 20 L 50 20 L 50 60", "M10-0 20 20zM10 20H50V60"),
        ("M 10 20 L 50 20 L 50 60", "m 10,20 40,0 0,40"),
        ("M 10 20 C 20 0 40 0 50 20 C 60 40 80 40 90 20", "M10,20 c10-20,30-20,40,0 s30,20,40,0"),
        ("M 10 20 C 20 0 40 0 50 20 C 60 40 80 40 90 20", "M10,20 C 20 0 40 0 50 20 S80,40,90,20"),
        ("M 10 20 Q 30 0 50 20 Q 70 40 90 20", "m10 20q20-20 40 0t40 0"),
        ("M 10 20 Q 30 0 50 20 Q 70 40 90 20", "M10 20 Q 30 0 50 20 T 90 20"),
        ("M 10 20 C 23.333333333 6.666666667 36.666666667 6.666666667 50 20", "M 10 20 Q 30 0 50 20"),
        ("M 10 20 A 20 20 0 0 1 50 20", "m10 20a20 20 0 0140 0"),
        ("M 10 20 A 20 20 0 0 1 50 20", "M 10 20 A 5 5 30 0 1 50 20"),
        ("M 10 20 L 50 20", "M 10 20 A 0 5 0 0 1 50 20"),
        ("M 10 20 L 50 20 L 50 60 Z", "M 10 20 L 50 20 L 50 60 L 10 20 Z"),
    ] {
        let [a, b] = [a, b].map(|d| {
            let text = svg(&format!("<g id='femur'><path d='{d}'/></g>"));
            let edit = try_text("x.svg", text.as_bytes(), &["femur"]).unwrap_or_else(|e| panic!("{d}: {e}"));
            edit.bodies[0].contour.pieces.last().unwrap().clone()
        });
        assert_eq!(a.closed, b.closed);
        assert!(off(&a, &b) < 0.011 && off(&b, &a) < 0.011, "{a:?} {b:?}");
    }
    // SVG 1.1, section 8.3.8: the four arcs of two ellipses through two points. Centres by hand: (30, 20 -+ sqrt(25^2 - 20^2)).
    for (large, sweep, centre, high) in [
        (0, 0, [30.0, 50.0], false),
        (0, 1, [30.0, 80.0], true),
        (1, 0, [30.0, 80.0], false),
        (1, 1, [30.0, 50.0], true),
    ] {
        let arc = piece(&format!("<path stroke='red' d='M 10 65 A 25 25 0 {large} {sweep} 50 65'/>"));
        assert_on_circle(&arc, centre, 25.0, 0.011);
        let far =
            arc.points.iter().map(|p| if high { 65.0 - p[1] } else { p[1] - 65.0 }).fold(f64::MIN, f64::max);
        assert!((far - if large == 1 { 40.0 } else { 10.0 }).abs() < 0.02, "{large} {sweep}: {far}");
    }
    // An ellipse turned by 30 degrees.
    let turned = piece("<path stroke='red' d='M 60 90 A 50 25 30 1 0 61 90 Z'/>");
    let (sin, cos) = f64::to_radians(30.0).sin_cos();
    let rim = |p: &Pair, c: Pair| {
        ((cos * (p[0] - c[0]) + sin * (p[1] - c[1])) / 50.0)
            .hypot((cos * (p[1] - c[1]) - sin * (p[0] - c[0])) / 25.0)
    };
    let [low, high] = [0, 1].map(|i| {
        let of = |sign: f64| sign * turned.points.iter().map(|p| sign * p[i]).fold(f64::MAX, f64::min);
        [of(1.0), of(-1.0)]
    });
    let centre = [(low[0] + low[1]) / 2.0, (high[0] + high[1]) / 2.0];
    assert!(turned.points.iter().all(|p| (rim(p, centre) - 1.0).abs() < 1e-3));
    let lone = piece("<path stroke='red' d='M 5 5 M 10 20 L 50 20 M 7 7'/>");
    assert_eq!(ends(&lone), [[10.0, 20.0], [50.0, 20.0]], "lone moves draw nothing");
}

#[test]
fn shapes_transformations_and_units() {
    let circle = piece("<circle cx='60' cy='70' r='30' stroke='red'/>");
    assert!(circle.closed);
    assert_on_circle(&circle, [60.0, 70.0], 30.0, 0.011);
    assert_on_circle(
        &piece("<ellipse cx='60' cy='70' rx='30' ry='30' stroke='red'/>"),
        [60.0, 70.0],
        30.0,
        0.011,
    );
    let same = |a: &str, b: &str| {
        let (a, b) = (piece(a), piece(b));
        assert!(off(&a, &b).max(off(&b, &a)) < 0.011 && a.closed == b.closed, "{a:?} {b:?}");
    };
    let line = "<path stroke='red' d='M 10 20 L 70 100'/>";
    same("<line x1='10' y1='20' x2='70' y2='100' stroke='red'/>", line);
    same("<polyline points='10,20 70,100' stroke='red'/>", line);
    same(
        "<polygon points='10 20,70 100,10 100' stroke='red'/>",
        "<path stroke='red' d='M 10 20 L 70 100 L 10 100 Z'/>",
    );
    same(
        "<rect x='10' y='20' width='60' height='80' stroke='red'/>",
        "<path stroke='red' d='M 10 20 h 60 v 80 h -60 Z'/>",
    );
    same(
        "<rect x='10' y='20' width='60' height='80' rx='10' stroke='red'/>",
        "<path stroke='red' d='M 20 20 h 40 a 10 10 0 0 1 10 10 v 60 a 10 10 0 0 1 -10 10 h -40 a 10 10 0 0 1 -10 -10 v -60 a 10 10 0 0 1 10 -10 Z'/>",
    );
    // Each by hand from SVG 1.1, section 7.6.
    for (transform, d) in [
        ("translate(10, 20)", "M 0 0 L 60 80"),
        ("translate(10) translate(0 20)", "M 0 0 L 60 80"),
        ("matrix(1 0 0 1 10 20)", "M 0 0 L 60 80"),
        ("scale(2)", "M 5 10 L 35 50"),
        ("scale(2,4)", "M 5 5 L 35 25"),
        ("translate(10 20) rotate(90)", "M 0 0 L 80 -60"),
        ("rotate(90, 10, 20)", "M 10 20 L 90 -40"),
        ("skewX(45)", "M -10 20 L -30 100"),
        ("skewY(45)", "M 10 10 L 70 30"),
    ] {
        same(&format!("<g transform='{transform}'><path stroke='red' d='{d}'/></g>"), line);
        same(&format!("<g stroke='red'><path transform='{transform}' d='{d}'/></g>"), line);
    }
    same(
        "<g transform='scale(2)'><g transform='translate(5 10)'><path stroke='red' d='M 0 0 L 30 40'/></g></g>",
        line,
    );
    same(
        "<svg x='10' y='20' width='60' height='80' viewBox='0 0 6 8'><path stroke='red' d='M 0 0 L 6 8'/></svg>",
        line,
    );
    // Twice as high as needed: kept in shape, in the middle.
    same(
        "<svg x='10' y='-20' width='60' height='160' viewBox='0 0 6 8'><path stroke='red' d='M 0 0 L 6 8'/></svg>",
        line,
    );
    same(
        "<svg x='10' y='20' width='60' height='80' viewBox='0 0 1 1' preserveAspectRatio='none'><path stroke='red' d='M 0 0 L 1 1'/></svg>",
        line,
    );
    same(
        "<defs><path id='p' d='M 0 0 L 60 80'/></defs><use stroke='red' xlink:href='#p' x='10' y='20'/>",
        line,
    );
    same("<line x1='2.6458333mm' y1='0.2083333in' x2='27.34375%' y2='75pt' stroke='red'/>", line);
}

#[test]
fn the_picture_is_where_its_backdrop_is() {
    let line = piece("<path stroke='red' d='M 10 20 L 70 100'/>");
    let image = |attributes: &str| format!("<image {attributes} xlink:href='a.png'/>");
    for (backdrop, d) in [
        (image("x='-0.5' y='-0.5' width='256' height='200'"), "M 10 20 L 70 100"),
        (image("x='9.5' y='19.5' width='256' height='200'"), "M 20 40 L 80 120"),
        (image("x='-1' y='-1' width='512' height='400'"), "M 20 40 L 140 200"),
        (
            image("x='-1mm' y='-1mm' width='512mm' height='400mm'"),
            "M 75.590551 151.181102 L 529.133858 755.905512",
        ),
        // In a box that is too wide it lies in the middle: 44 px to the right.
        (image("x='-0.5' y='-0.5' width='344' height='200'"), "M 54 20 L 114 100"),
        (
            image("x='-0.5' y='-0.5' width='512' height='200' preserveAspectRatio='none'"),
            "M 20.5 20 L 140.5 100",
        ),
        (
            format!("<g transform='rotate(90)'>{}</g>", image("x='-0.5' y='-0.5' width='256' height='200'")),
            "M -20 10 L -100 70",
        ),
        (
            format!("<g style='display:none'>{}</g>", image("x='9.5' y='19.5' width='256' height='200'")),
            "M 20 40 L 80 120",
        ),
        (
            image("x='9.5' y='19.5' width='256' height='200' id='backdrop'") + &image("width='9' height='9'"),
            "M 20 40 L 80 120",
        ),
        (image("x='-0.5' y='-0.5'"), "M 10 20 L 70 100"),
    ] {
        let moved = piece(&format!("{backdrop}<path stroke='red' d='{d}'/>"));
        assert!(off(&moved, &line).max(off(&line, &moved)) < 0.001, "{backdrop}: {:?}", ends(&moved));
    }
    // The corner of the page is the corner of the picture.
    let text = svg("<path stroke='red' d='M 10 20 L 70 100'/>").replace("-0.5 -0.5 256 200", "0 0 512 400");
    let edit = try_text("x.svg", text.as_bytes(), &["femur"]).unwrap();
    assert_eq!(ends(&edit.bodies[0].contour.pieces[0]), [[4.5, 9.5], [34.5, 49.5]]);
}

#[test]
fn bodies_by_layer_and_what_is_hidden() {
    let layer = |name: &str, more: &str, inner: &str| {
        format!("<g inkscape:groupmode='layer' inkscape:label='{name}' id='l' {more}>{inner}</g>")
    };
    let line = "<path d='M 10 20 L 70 100'/>";
    let read = |inner: &str| try_text("x.svg", svg(inner).as_bytes(), &BODIES);
    let bodies = |inner: &str| -> Vec<(usize, usize)> {
        let edit = read(inner).unwrap();
        edit.bodies.iter().map(|b| (b.body, b.contour.pieces.len())).collect()
    };
    assert_eq!(bodies(&layer("tray", "", line)), [(1, 1)]);
    assert_eq!(bodies(&layer("Femoral_Component", "", &format!("<g>{line}</g>"))), [(0, 1)]);
    assert_eq!(bodies(&layer("notes", "", &layer("tray", "", line))), [(1, 1)]);
    assert_eq!(bodies("<path id='tray-2' d='M 10 20 L 70 100' stroke='red'/>"), [(1, 1)]);
    assert_eq!(bodies(&layer("tray", "", "")), [(1, 0)], "nothing of it is to be trusted");
    assert_eq!(bodies(&layer("tray", "style='display:none'", line)), [], "as if it were not there");
    assert_eq!(
        bodies(&layer("tray", "", "<path style='visibility:hidden' d='M 10 20 L 70 100'/>")),
        [(1, 0)]
    );
    assert_eq!(
        bodies(&layer("tray", "visibility='hidden'", "<path visibility='visible' d='M 10 20 L 70 100'/>")),
        [(1, 1)]
    );
    assert_eq!(
        bodies(&layer("tray", "", "<path d='M 300 20 L 370 100'/><path d='M 10 20 L 11 20'/>")),
        [(1, 0)]
    );
    assert_eq!(
        bodies(&layer("tray", "", "<path d='M -10 20 L 20 20 L 20 -9 L 30 -9 L 30 20'/>")),
        [(1, 2)],
        "cut at the picture's edge"
    );
    assert_eq!(bodies("<clipPath id='c'><rect width='9' height='9' stroke='red'/></clipPath>"), []);
    let error = read(&layer("femoral komponent", "", "<path stroke='red' id='p1' d='M 10 20 L 70 100'/>"))
        .unwrap_err();
    assert_eq!(
        error,
        "x.svg, line 2: <path> `p1`: it is in the layer `femoral komponent`, which is named after no body (the trial has `femoral \
         component`, `tray`; is `femoral component` meant?). Move it into the layer of its body (Layer > Move Selection to Layer), or \
         delete it"
    );
}

#[test]
fn marks_bound_what_is_trusted() {
    let line = "<path id='femur 1' d='M 10 20 L 110 20' stroke='red'/>";
    let mark = |name: &str, x: f64| format!("<circle id='{name}' cx='{x}' cy='25' r='3' stroke='red'/>");
    let end_x = |inner: &str| ends(&piece(inner)).map(|p| p[0]);
    assert_eq!(
        end_x(&(line.to_owned() + &mark("femur 1 from", 30.5) + &mark("femur 1 to", 90.25))),
        [30.5, 90.25]
    );
    assert_eq!(
        end_x(&(mark("femur_1_to", 30.5) + &mark("femur_1_from", 90.25) + line)),
        [30.5, 90.25],
        "a path turned round"
    );
    assert_eq!(end_x(&(line.to_owned() + &mark("femur 1 to", 30.5))), [10.0, 30.5]);
    // A piece of another name has the mark too, if it is as near: programs rename what they cut.
    let renamed = line.replace("femur 1", "path77");
    assert_eq!(end_x(&(renamed.clone() + &mark("femur 1 from", 30.5).replace("25", "22"))), [30.5, 110.0]);
    assert_eq!(end_x(&(renamed + &mark("femur 1 from", 30.5))), [10.0, 110.0]);
    let twice = svg(&(line.to_owned() + &mark("femur 1 to", 30.5) + &mark("femur 1 to", 40.5)));
    let error = try_text("x.svg", twice.as_bytes(), &["femur"]).unwrap_err();
    assert!(
        error.contains("it is the second mark `to` of the piece `femur 1`; delete one of the two"),
        "{error}"
    );
}

#[test]
fn faults_name_the_line_and_what_to_do() {
    let cases: [(&str, &str, &str); 15] = [
        ("x.svg", "<svg><path d='M 1 1'", "x.svg, line 1: the file is damaged"),
        ("x.svg", "<svg>\n<g>\n</svg>", "x.svg, line 3: the file is damaged"),
        ("x.svg", "<html/>", "x.svg, line 1: the file is XML of the kind <html>; expected a drawing, <svg>"),
        ("x.svg", "", "x.svg: the file is empty; expected a drawing (SVG, as Inkscape saves it) or a table"),
        ("x.svg", "\u{1f}\u{8b}", "x.svg: the file begins with"),
        ("x.svg", "<!DOCTYPE svg [\n<!ENTITY a 'b'>]><svg/>", "x.svg, line 2: the file defines entities"),
        (
            "x.svg",
            "<svg viewBox='0 0 9 9'>\n<path stroke='red' d='M 1 1 L 2'/></svg>",
            "x.svg, line 2: <path> without a name: its path data cannot be read",
        ),
        (
            "x.svg",
            "<svg viewBox='0 0 256 200'>\n<path id='a' transform='turn(3)'/></svg>",
            "x.svg, line 2: <path> `a`: its transform cannot be read",
        ),
        (
            "x.svg",
            "<svg viewBox='0 0 256 200'>\n<rect id='a' width='3em' height='2' stroke='red'/></svg>",
            "x.svg, line 2: <rect> `a`: its width `3em` depends on a letter's size; expected px, mm",
        ),
        (
            "x.svg",
            "<svg viewBox='0 0 256 0'/>",
            "x.svg, line 1: <svg> without a name: its viewBox `0 0 256 0` is not four numbers with sides above 0",
        ),
        (
            "x.svg",
            "<svg viewBox='0 0 210 297'><path stroke='red' d='M 1 1 L 9 9'/></svg>",
            "x.svg, line 1: the drawing has no picture in it, and its page of 210 x 297 has not the shape of the frame of 256 x 200 pixels",
        ),
        (
            "x.svg",
            "<svg><image width='9' height='9'/>\n<image id='b' width='9' height='9'/></svg>",
            "x.svg, line 2: <image> `b`: it is one of several pictures",
        ),
        (
            "x.svg",
            "<svg viewBox='0 0 256 200'>\n<path id='a' stroke='red' d='M 0 0 L 1e9 1e300'/></svg>",
            "x.svg, line 2: <path> `a`: it is not of the size of a picture",
        ),
        (
            "x.svg",
            "<svg viewBox='0 0 256 200' xmlns:biplane='urn:biplane:edit' biplane:version='2'/>",
            "x.svg, line 1: <svg> without a name: it is of version `2` and this program knows up to 1",
        ),
        (
            "x.svg",
            "<svg viewBox='0 0 256 200'>\n<use stroke='red' href='#nothing'/></svg>",
            "x.svg, line 2: <use> without a name: it is a clone of `#nothing`, which is no shape of this file; unlink it",
        ),
    ];
    for (name, text, expected) in cases {
        let error = try_text(name, text.as_bytes(), &["femur"]).unwrap_err();
        assert!(error.starts_with(expected), "{error}\n{expected}");
    }
    let error = try_text("x.svg", b"<svg>\n<g>\xff", &["femur"]).unwrap_err();
    assert_eq!(error, "x.svg, line 2: byte 9 is not text (UTF-8); save the file as SVG or CSV again");
    let error = try_text("x.svgz", &[0x1f, 0x8b, 8, 0], &["femur"]).unwrap_err();
    assert!(error.starts_with("x.svgz: the file is compressed (.svgz)"), "{error}");
}

#[test]
fn nothing_grows_without_end() {
    let deep = "<g>".repeat(100_000) + &"</g>".repeat(100_000);
    let error = try_text("x.svg", svg(&deep).as_bytes(), &["femur"]).unwrap_err();
    assert!(error.contains("groups within groups") || error.contains("damaged"), "{error}");
    let round = "<g id='a'><use href='#b' stroke='red'/></g><g id='b'><use href='#a'/></g>";
    assert!(
        try_text("x.svg", svg(round).as_bytes(), &["femur"]).unwrap_err().contains("groups within groups")
    );
    let level = |i: usize| format!("<g id='g{}'>{}</g>", i + 1, format!("<use href='#g{i}'/>").repeat(10));
    let bomb = "<g id='g0'><path d='M 0 0 L 9 9' stroke='red'/></g>".to_owned()
        + &(0..9).map(level).collect::<String>();
    assert!(
        try_text("x.svg", svg(&bomb).as_bytes(), &["femur"])
            .unwrap_err()
            .contains("more than 200000 elements")
    );
    let long = "<path stroke='red' d='M 0 0 L 400000 0'/>".repeat(3);
    assert!(try_text("x.svg", svg(&long).as_bytes(), &["femur"]).unwrap_err().contains("px of curves"));
}

#[test]
fn damage_is_an_error_and_never_a_panic() {
    for name in ["edited.svg", "grouped.svg", "matplotlib.svg"] {
        let whole = std::fs::read(saved(name)).unwrap();
        let mut damaged: Vec<Vec<u8>> =
            (0..whole.len()).step_by(61).map(|end| whole[..end].to_vec()).collect();
        for at in (0..whole.len()).step_by(23) {
            for byte in [b'<', b'9', b'-', b'"', 0, 0xc3] {
                let mut bytes = whole.clone();
                bytes[at] = byte;
                damaged.push(bytes);
            }
        }
        for bytes in damaged {
            if let Err(error) = try_text("x.svg", &bytes, &BODIES) {
                assert!(error.starts_with("x.svg"), "{error}");
            }
        }
    }
    let table = write_table(&sketch());
    for at in (0..table.len()).step_by(97) {
        let mut bytes = table.clone().into_bytes();
        for byte in *b",-\n\0x" {
            bytes[at] = byte;
            if let Err(error) = try_text("x.csv", &bytes, &BODIES) {
                assert!(error.starts_with("x.csv"), "{error}");
            }
        }
        let _ = try_text("x.csv", &table.as_bytes()[..at], &BODIES);
    }
}

#[test]
fn tables_of_cad_and_spreadsheets() {
    // Thirty points on a circle of radius 60: a spline through them stays within 0.01 px of it.
    let angle = |i: usize| TAU * i as f64 / 30.0;
    let rows = |closed: &str, last: usize| -> String {
        let row = |i| {
            format!(
                "Tray,rim,{closed},{},{}\n",
                110.0 + 60.0 * f64::cos(angle(i)),
                90.0 + 60.0 * f64::sin(angle(i))
            )
        };
        (0..last).map(row).collect()
    };
    for text in [rows("1", 30), rows("", 30) + "Tray,rim,,170,90\n"] {
        let edit =
            try_text("x.csv", format!("body,piece,closed,x_px,y_px\n{text}").as_bytes(), &BODIES).unwrap();
        let [body] = &edit.bodies[..] else { panic!("{edit:?}") };
        assert!(body.body == 1 && body.touched && body.contour.pieces[0].closed);
        assert_on_circle(&body.contour.pieces[0], [110.0, 90.0], 60.0, 0.02);
        assert!(body.contour.pieces[0].points.len() > 370);
    }
    // What a spreadsheet does: commas at the ends of comments, blank rows, quotes; one stretch is not trusted.
    let text = "# trial: lunge,,,,\n# frame hash: 0707070707070707070707070707070707070707070707070707070707070707,,,,\n,,,,\n"
        .replace(",,,,\n,,,,", ",,,,\n\n")
        + "\"body\",\"piece\",\"x_px\",\"y_px\",\"trusted\"\ntray,1,10,20,1\ntray,1,20,20,1\ntray,1,30,20,0\ntray,1,40,20,\ntray,1,50,20,yes\nfemoral component,,,,\n";
    let edit = try_text("x.csv", text.as_bytes(), &BODIES).unwrap();
    assert_eq!(
        (edit.about.trial.as_deref(), edit.about.picture),
        (Some("lunge"), Some(ContentHash::from_bytes([7; 32])))
    );
    assert!(edit.bodies[0].contour.pieces.is_empty() && edit.bodies[0].touched);
    let stretches: Vec<_> = edit.bodies[1].contour.pieces.iter().map(|p| ends(p).map(|e| e[0])).collect();
    assert_eq!(stretches, [[10.0, 20.0], [40.0, 50.0]]);
    for (text, expected) in [
        (
            "body,x_px,y_px\ntray,1,2\ntrai,1,2\n",
            "x.csv, line 3: expected a body of the trial (the trial has `femoral component`, `tray`; is `tray` meant?), found `trai`",
        ),
        (
            "body,x_px,y_px\ntray,1,two\n",
            "x.csv, line 2: expected a finite number in column `y_px`, found `two`",
        ),
        ("body,x_px,y\ntray,1,2\n", "x.csv, line 1: expected a header with the column `y_px`"),
        ("body,x_px,y_px\ntray,1,2\ntray,1,2\n", "x.csv, line 2: piece `1`:"),
        (
            "body,x_px,y_px,closed\ntray,1,2,maybe\n",
            "x.csv, line 2: expected 1 or 0 in column `closed`, found `maybe`",
        ),
        (
            "# frame hash: 12\nbody,x_px,y_px\n",
            "x.csv, line 1: the frame's hash `12` is not 64 hexadecimal digits",
        ),
        (
            "# version: 9\nbody,x_px,y_px\n",
            "x.csv, line 1: it is of version 9 and this program knows up to 1",
        ),
        (
            "hello\n",
            "x.csv: the file begins with `hello`; expected a drawing (SVG, as Inkscape saves it) or a table (CSV",
        ),
        ("body,x_px,y_px\ntray,1,2\ntray,9e8,2\n", "x.csv, line 2: piece `1`:"),
    ] {
        let error = try_text("x.csv", text.as_bytes(), &BODIES).unwrap_err();
        assert!(error.starts_with(expected), "{error}\n{expected}");
    }
}
