//! The sheet of a model: that all it should show is there and in its place, and that no mesh breaks it.

use biplane_artifact::{
    AxesFeature, AxesSource, BodyAxes, BodyKind, ContourSlice, Side, SliceContour, SliceContours, SliceFlag,
    SlicePoint, SurfaceFault, SurfaceReport,
};
use biplane_geometry::{Mesh, Point3};

use super::{ModelDrawing, model_drawing};

/// A ball about the origin, of `rings` x `2 rings` quads.
fn ball(radius: f64, rings: usize) -> Mesh {
    let columns = 2 * rings;
    let mut vertices = vec![Point3::new(0.0, 0.0, -radius)];
    for ring in 1..rings {
        let (sin, cos) = (std::f64::consts::PI * ring as f64 / rings as f64).sin_cos();
        for column in 0..columns {
            let (s, c) = (std::f64::consts::TAU * column as f64 / columns as f64).sin_cos();
            vertices.push(Point3::new(radius * sin * c, radius * sin * s, -radius * cos));
        }
    }
    let top = vertices.len() as u32;
    vertices.push(Point3::new(0.0, 0.0, radius));
    let at = |ring: usize, column: usize| (1 + (ring - 1) * columns + column % columns) as u32;
    let mut triangles = Vec::new();
    for column in 0..columns {
        triangles.push([0, at(1, column + 1), at(1, column)]);
        triangles.push([top, at(rings - 1, column), at(rings - 1, column + 1)]);
        for ring in 1..rings - 1 {
            let [a, b] = [at(ring, column), at(ring, column + 1)];
            let [c, d] = [at(ring + 1, column), at(ring + 1, column + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    Mesh::new(vertices, triangles).unwrap()
}

/// Slices of a ball of 20 mm, 1 mm apart.
fn contours() -> SliceContours {
    let circle = |z: f64| {
        let r = (400.0 - z * z).sqrt();
        let at = |n: usize| {
            let (s, c) = (n as f64 * std::f64::consts::TAU / 60.0).sin_cos();
            SlicePoint::rounded(30.0 + r * c, 30.0 + r * s, 0.1)
        };
        SliceContour { points: (0..60).map(at).collect() }
    };
    let slice = |k: usize| ContourSlice {
        origin_mm: [-30.0, -30.0, k as f64 - 25.0],
        contours: if (6..45).contains(&k) { vec![circle(k as f64 - 25.0)] } else { Vec::new() },
        flags: match k {
            10..=12 => vec![SliceFlag::Jumped],
            44 => vec![SliceFlag::CutOff],
            _ => Vec::new(),
        },
        edited: false,
    };
    SliceContours {
        columns: 61,
        rows: 61,
        column_step_mm: [1.0, 0.0, 0.0],
        row_step_mm: [0.0, 1.0, 0.0],
        slices: (0..50).map(slice).collect(),
        warnings: vec!["the slices are odd".to_owned()],
    }
}

fn axes(source: AxesSource) -> BodyAxes {
    BodyAxes {
        origin_mm: [0.0, 0.0, -0.01],
        axes: [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]],
        body: BodyKind::Femur,
        side: Side::Right,
        source,
        features: vec![
            AxesFeature::Point { name: "top <of all>".to_owned(), at_mm: [0.0, 0.0, 20.0] },
            AxesFeature::Line { name: "shaft".to_owned(), from_mm: [0.0; 3], to_mm: [0.0, 0.0, 15.0] },
            AxesFeature::Sphere { name: "head".to_owned(), centre_mm: [0.0; 3], radius_mm: 20.0 },
            AxesFeature::Cylinder {
                name: "condyles".to_owned(),
                from_mm: [-15.0, 0.0, 0.0],
                to_mm: [15.0, 0.0, 0.0],
                radius_mm: 8.0,
            },
            AxesFeature::Plane {
                name: "middle".to_owned(),
                centre_mm: [0.0; 3],
                normal: [1.0, 0.0, 0.0],
                radius_mm: 22.0,
            },
        ],
        warnings: vec!["the axes are a guess".to_owned()],
    }
}

fn report() -> SurfaceReport {
    SurfaceReport {
        method: "labels".to_owned(),
        slices: 39,
        contours: 39,
        volume_mm3: 33_500.0,
        unsmoothed_volume_mm3: 33_510.0,
        area_mm2: 5026.0,
        pieces: 1,
        faults: vec![SurfaceFault { slice: Some(20), what: "2 open edges".to_owned() }],
        warnings: vec!["look at the lid".to_owned()],
    }
}

/// The bytes of a base64 text.
fn decoded(text: &str) -> Vec<u8> {
    let six = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let data = text.trim_end_matches('=').as_bytes();
    let bits =
        |four: &[u8]| four.iter().enumerate().fold(0, |n, (i, c)| n | u32::from(six(*c)) << (18 - 6 * i));
    let bytes = |four: &[u8]| bits(four).to_be_bytes()[1..four.len()].to_vec();
    data.chunks(4).flat_map(bytes).collect()
}

/// The pictures in a drawing, decoded.
fn pictures(svg: &str) -> Vec<image::RgbImage> {
    svg.split("data:image/png;base64,")
        .skip(1)
        .map(|rest| {
            let text = rest.split('"').next().unwrap();
            let bytes = decoded(text);
            image::load_from_memory(&bytes).unwrap().into_rgb8()
        })
        .collect()
}

#[test]
fn all_that_is_known_is_shown() {
    let (model, reference) = (ball(20.0, 60), ball(19.8, 60));
    let (contours, axes, report) = (contours(), axes(AxesSource::Shape), report());
    let shown = ModelDrawing {
        body: "a<b",
        axes: Some(&axes),
        contours: Some(&contours),
        surface: Some(&report),
        reference: Some(&reference),
    };
    let svg = model_drawing(&model, &shown).unwrap();
    for part in [
        "Model of a&lt;b",
        "7,082 vertices, 14,160 triangles",
        ">faulty<",
        "axes proposed from the shape",
        "from anterior",
        "from lateral",
        "from proximal",
        "in perspective",
        ">X anterior<",
        ">Y proximal<",
        ">Z right<",
        "top &lt;of all&gt;",
        ">condyles<",
        "origin at 0.0, 0.0, 0.0 mm",
        "slices 10 to 12: jumped",
        "slice 20: 2 open edges",
        ">slice 6<",
        "all 39 slices",
        ">-0.030 %<",
        "the slices are odd",
        "the axes are a guess",
        "look at the lid",
        ">right femur<",
        ">median<",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    // Both spheres are polyhedra, so 0.2 mm but for their sagitta.
    assert!(svg.contains(">0.200 mm<") && svg.contains("+0.20 mm"), "the distance map's numbers");
    assert_eq!(svg.matches("class=\"contour-flagged\"").count(), 1);
    assert_eq!(pictures(&svg).len(), 4 + 2 + 2);
    assert_eq!(model_drawing(&model, &shown).unwrap(), svg, "the same bytes");
    assert!(svg.len() < 600_000, "{} bytes", svg.len());
    let by_hand = BodyAxes { source: AxesSource::Landmarks, ..axes.clone() };
    let svg = model_drawing(&model, &ModelDrawing { axes: Some(&by_hand), ..shown }).unwrap();
    assert!(svg.contains("axes by a person&#39;s landmarks") && !svg.contains("proposed"));
}

#[test]
fn a_ball_is_round_lit_from_the_upper_left_and_where_it_should_be() {
    let svg =
        model_drawing(&ball(20.0, 60), &ModelDrawing { body: "ball", ..ModelDrawing::default() }).unwrap();
    assert!(svg.contains(">good<") && svg.contains("front: x right, z up"));
    let pictures = pictures(&svg);
    assert_eq!(pictures.len(), 4);
    let picture = &pictures[0];
    let (width, height) = picture.dimensions();
    let bright = |x: u32, y: u32| picture.get_pixel(x, y).0.iter().map(|c| u32::from(*c)).sum::<u32>();
    let (x, y) = (width / 2, height / 2);
    assert!(bright(x - width / 6, y - height / 6) > bright(x + width / 6, y + height / 6) + 100);
    assert_eq!(bright(2, 2), 3 * 255, "the corner is empty");
    // As wide as it is high, and as large as the frame lets it be but for its room.
    let covered =
        |along: &dyn Fn(u32) -> u32, end: u32| (0..end).filter(|n| along(*n) < 3 * 255).count() as f64;
    let (wide, high) = (covered(&|n| bright(n, y), width), covered(&|n| bright(x, n), height));
    assert!((wide - high).abs() <= 2.0, "{wide} {high}");
    assert!((high / f64::from(height) - (224.0 - 28.0) / 224.0).abs() < 0.02, "{high} of {height}");
}

#[test]
fn the_far_half_of_the_contours_is_faint() {
    let contours = contours();
    let shown = ModelDrawing { body: "ball", contours: Some(&contours), ..ModelDrawing::default() };
    let svg = model_drawing(&ball(20.0, 60), &shown).unwrap();
    let length = |class: &str| -> f64 {
        let group = svg.split(&format!("class=\"{class}\"")).nth(1).unwrap().split("</g>").next().unwrap();
        let path = group.split(" d=\"").nth(1).unwrap().split('"').next().unwrap();
        let mut sum = 0.0;
        for line in path.split('M').skip(1) {
            let points: Vec<[f64; 2]> = line
                .split('L')
                .map(|p| p.split_once(' ').unwrap())
                .map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()])
                .collect();
            sum += points.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum::<f64>();
        }
        sum
    };
    let (seen, hidden) = (length("contour"), length("contour-hidden"));
    // Half of a ball's points face the viewer; a little beyond its outline counts as seen.
    let share = seen / (seen + hidden);
    assert!((0.49..0.56).contains(&share), "{share}");
}

#[test]
fn no_mesh_and_no_artifact_breaks_it() {
    let mesh = |vertices: &[[f64; 3]], triangles: &[[u32; 3]]| {
        Mesh::new(vertices.iter().map(|v| Point3::from(*v)).collect(), triangles.to_vec()).unwrap()
    };
    let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 5.0, 5.0]];
    let meshes = [
        mesh(&flat, &[[0, 1, 2]]),
        mesh(&flat, &[[0, 1, 2], [0, 1, 2], [2, 1, 0]]),
        mesh(&[[1e-9, 0.0, 0.0], [0.0, 1e-9, 0.0], [0.0, 0.0, 1e-9]], &[[0, 1, 2]]),
        mesh(&[[1e9, 0.0, 0.0], [0.0, 1e9, 0.0], [0.0, 0.0, 1e9]], &[[0, 1, 2]]),
        mesh(&[[1e120, 0.0, 0.0], [0.0, 1e120, 0.0], [0.0, 0.0, 1e120]], &[[0, 1, 2]]),
        mesh(&[[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0], [0.0, 1e-6, 0.0]], &[[0, 1, 2]]),
        ball(20.0, 3).inverted(),
    ];
    let mut odd = axes(AxesSource::Shape);
    odd.axes = [[0.0; 3], [f64::NAN, 0.0, 1.0], [0.0, 0.0, 1e300]];
    odd.origin_mm = [1e200, f64::NAN, 0.0];
    odd.features.push(AxesFeature::Cylinder {
        name: String::new(),
        from_mm: [0.0; 3],
        to_mm: [0.0; 3],
        radius_mm: f64::INFINITY,
    });
    let mut empty = contours();
    empty.slices.clear();
    let mut far = report();
    far.faults.push(SurfaceFault { slice: Some(usize::MAX), what: String::new() });
    far.unsmoothed_volume_mm3 = 0.0;
    let (usual, slices) = (axes(AxesSource::Points), contours());
    for model in &meshes {
        for (axes, contours) in [(None, None), (Some(&odd), Some(&empty)), (Some(&usual), Some(&slices))] {
            for surface in [None, Some(&far)] {
                let shown = ModelDrawing { body: "", axes, contours, surface, reference: Some(&meshes[0]) };
                let svg = model_drawing(model, &shown).unwrap();
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "a number that is none");
            }
        }
    }
}

#[test]
fn half_a_million_triangles_are_drawn_soon() {
    let model = ball(50.0, 354);
    assert!(model.triangles().len() > 499_000);
    let start = std::time::Instant::now();
    let svg = model_drawing(&model, &ModelDrawing { body: "large", ..ModelDrawing::default() }).unwrap();
    println!(
        "{:.2} s for {} triangles, {} bytes",
        start.elapsed().as_secs_f64(),
        model.triangles().len(),
        svg.len()
    );
    let start = std::time::Instant::now();
    let usual = ball(50.0, 134);
    let (axes, reference) = (axes(AxesSource::Shape), ball(49.5, 134));
    let shown = ModelDrawing {
        body: "usual",
        axes: Some(&axes),
        reference: Some(&reference),
        ..ModelDrawing::default()
    };
    let svg = model_drawing(&usual, &shown).unwrap();
    println!(
        "{:.2} s for {} points, {} bytes",
        start.elapsed().as_secs_f64(),
        usual.vertices().len(),
        svg.len()
    );
}
