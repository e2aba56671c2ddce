//! Calibrations written here and read back by projecting points; every broken one with its message.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::PathBuf;

use approx::assert_relative_eq;
use biplane_acquisition::calibration::{
    read_calibration, read_distortion_csv, read_mayacam2, read_plane_json,
};
use biplane_artifact::{Calibration, PixelOrigin};
use nalgebra::{Matrix3, Rotation3, Vector3};
use tempfile::TempDir;

const FOCAL: [f64; 2] = [4576.5, 4601.75];
const SKEW: f64 = 1.25;
const PRINCIPAL: [f64; 2] = [395.25, 588.5];

fn rotation() -> Matrix3<f64> {
    *Rotation3::from_euler_angles(0.4, -0.9, 2.1).matrix()
}

fn translation() -> Vector3<f64> {
    Vector3::new(36.25, -134.5, 1345.5)
}

fn mayacam_text() -> String {
    let r = rotation();
    let t = translation();
    let row = |i: usize| format!("{:.12},{:.12},{:.12}", r[(i, 0)], r[(i, 1)], r[(i, 2)]);
    format!(
        "image size\n1024,768\n\ncamera matrix\n{},{SKEW},{}\n0,{},{}\n0,0,1\n\nrotation\n{}\n{}\n{}\n\ntranslation\n{}\n{}\n{}\n",
        FOCAL[0],
        PRINCIPAL[0],
        FOCAL[1],
        PRINCIPAL[1],
        row(0),
        row(1),
        row(2),
        t.x,
        t.y,
        t.z
    )
}

fn write(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

/// `w (x, y, 1) = matrix (X - source)`.
fn project(c: &Calibration, point: Vector3<f64>) -> ([f64; 2], f64) {
    let m = Matrix3::from_fn(|i, j| c.matrix[i][j]);
    let p = m * (point - Vector3::from(c.source));
    ([p.x / p.z, p.y / p.z], p.z)
}

fn points() -> Vec<Vector3<f64>> {
    vec![Vector3::zeros(), Vector3::new(80.0, -30.0, 12.5), Vector3::new(-17.0, 55.0, -90.0)]
}

#[test]
fn mayacam_projects_as_opencv_does() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "cam.txt", &mayacam_text());
    let calibration = read_mayacam2(&path, PixelOrigin::Centre).unwrap();
    assert_eq!(calibration.size, [1024, 768]);
    assert_eq!(calibration.distortion, None);
    for point in points() {
        // OpenCV, "Camera Calibration and 3D Reconstruction": x' = X/Z, u = fx x' + s y' + cx.
        let q = rotation() * point + translation();
        let (x, y) = (q.x / q.z, q.y / q.z);
        let expected = [FOCAL[0] * x + SKEW * y + PRINCIPAL[0], FOCAL[1] * y + PRINCIPAL[1]];
        let ([u, v], depth) = project(&calibration, point);
        assert_relative_eq!(u, expected[0], epsilon = 1e-6);
        assert_relative_eq!(v, expected[1], epsilon = 1e-6);
        // The camera's z axis is the detector's normal.
        assert_relative_eq!(depth, q.z, epsilon = 1e-6);
    }
}

#[test]
fn counted_from_the_corner_every_pixel_is_half_a_pixel_less() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "cam.txt", &mayacam_text());
    let centre = read_calibration(&path, "A", PixelOrigin::Centre).unwrap();
    let corner = read_calibration(&path, "A", PixelOrigin::Corner).unwrap();
    assert_eq!(centre.source, corner.source);
    for point in points() {
        let ([u, v], depth) = project(&centre, point);
        let ([u2, v2], depth2) = project(&corner, point);
        assert_relative_eq!(u2, u - 0.5, epsilon = 1e-9);
        assert_relative_eq!(v2, v - 0.5, epsilon = 1e-9);
        assert_relative_eq!(depth2, depth, epsilon = 1e-9);
    }
}

#[test]
fn line_ends_blanks_and_a_byte_order_mark_do_not_matter() {
    let folder = TempDir::new().unwrap();
    let plain = read_mayacam2(write(&folder, "a", &mayacam_text()), PixelOrigin::Centre).unwrap();
    let variants = [
        format!("\u{feff}{}", mayacam_text().replace('\n', "\r\n")),
        mayacam_text().replace('\n', "  \n") + "\n\n \n",
        mayacam_text().replace("\n\n", "\n"),
        mayacam_text().replace(',', ", ").replace("image size", "Image Size"),
        mayacam_text() + "\nundistortion\n0,0,0,0,0,0,0,0\n",
    ];
    for text in variants {
        let read = read_mayacam2(write(&folder, "b", &text), PixelOrigin::Centre).unwrap();
        assert_eq!(read, plain, "{text:?}");
    }
}

#[test]
fn every_missing_line_is_named() {
    let folder = TempDir::new().unwrap();
    let text = mayacam_text();
    let lines: Vec<&str> = text.lines().collect();
    for missing in 0..lines.len() {
        if lines[missing].is_empty() {
            continue;
        }
        let rest: Vec<&str> =
            lines.iter().enumerate().filter(|(i, _)| *i != missing).map(|(_, l)| *l).collect();
        let path = write(&folder, "cam1.txt", &rest.join("\n"));
        let error = read_mayacam2(&path, PixelOrigin::Centre).unwrap_err().to_string();
        assert!(error.contains("cam1.txt, line "), "{error}");
        assert!(error.contains("expected ") && error.contains("found "), "{error}");
    }
    // The second row of the camera matrix is gone: the third stands in its place, and what follows is one short.
    let path = write(&folder, "cam1.txt", &text.replace("0,0,1\n", ""));
    let error = read_mayacam2(&path, PixelOrigin::Centre).unwrap_err().to_string();
    assert!(
        error.contains(
            "cam1.txt, line 8: expected row 3 of the camera matrix, three numbers `0,0,1`, found `rotation`"
        ),
        "{error}"
    );
    let cut = text.trim_end().rsplit_once('\n').unwrap().0;
    let error = read_mayacam2(write(&folder, "cut.txt", cut), PixelOrigin::Centre).unwrap_err().to_string();
    assert!(
        error.contains("line 17: expected the z of the translation, one number, found the end of the file"),
        "{error}"
    );
    let error = read_mayacam2(write(&folder, "empty.txt", ""), PixelOrigin::Centre).unwrap_err().to_string();
    assert!(
        error.contains("line 1: expected the heading `image size`, found the end of the file"),
        "{error}"
    );
}

#[test]
fn numbers_that_cannot_be_are_refused() {
    let folder = TempDir::new().unwrap();
    let text = mayacam_text();
    let error = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let path = write(&folder, "cam.txt", &text.replacen(from, to, 1));
        read_mayacam2(path, PixelOrigin::Centre).unwrap_err().to_string()
    };
    let e = error("4576.5", "-4576.5");
    assert!(e.contains("fx = -4576.5, fy = 4601.75; expected both positive"), "{e}");
    let e = error("1024,768", "0,768");
    assert!(e.contains("image size 0 x 768"), "{e}");
    let e = error("1024,768", "1024");
    assert!(e.contains("line 2: expected two numbers `width,height`, found `1024`"), "{e}");
    let e = error("36.25", "NaN");
    assert!(e.contains("the x of the translation") && e.contains("`NaN`"), "{e}");
    let e = error("0,0,1", "0,0,2");
    assert!(e.contains("lines 5 to 7, the camera matrix: found"), "{e}");
    let r = rotation();
    let first = format!("{:.12},{:.12},{:.12}", r[(0, 0)], r[(0, 1)], r[(0, 2)]);
    let e = error(&first, &format!("{:.12},{:.12},{:.12}", r[(0, 0)] * 1.01, r[(0, 1)], r[(0, 2)]));
    assert!(e.contains("rotation is not one"), "{e}");
    let e = error(&first, &format!("{:.12},{:.12},{:.12}", -r[(0, 0)], -r[(0, 1)], -r[(0, 2)]));
    assert!(e.contains("determinant -1"), "{e}");
}

#[test]
fn a_rotation_of_few_decimals_becomes_the_nearest_one() {
    let folder = TempDir::new().unwrap();
    let r = rotation();
    let row = |i: usize, n: usize| format!("{:.n$},{:.n$},{:.n$}", r[(i, 0)], r[(i, 1)], r[(i, 2)]);
    let text = (0..3).fold(mayacam_text(), |t, i| t.replace(&row(i, 12), &row(i, 4)));
    let c = read_mayacam2(write(&folder, "cam.txt", &text), PixelOrigin::Centre).unwrap();
    let normal = Vector3::from(c.matrix[2]);
    assert_relative_eq!(normal.norm(), 1.0, epsilon = 1e-12);
    assert!((normal - r.row(2).transpose()).norm() < 1e-4);
}

/// OpenCV's rational model, written once more and independently: the recorded pixel of an ideal one.
fn distorted(ideal: [f64; 2], k: [f64; 8]) -> [f64; 2] {
    let [k1, k2, p1, p2, k3, k4, k5, k6] = k;
    let y = (ideal[1] - PRINCIPAL[1]) / FOCAL[1];
    let x = (ideal[0] - PRINCIPAL[0] - SKEW * y) / FOCAL[0];
    let r2 = x * x + y * y;
    let (r4, r6) = (r2.powi(2), r2.powi(3));
    let radial = (1.0 + k1 * r2 + k2 * r4 + k3 * r6) / (1.0 + k4 * r2 + k5 * r4 + k6 * r6);
    let xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
    let yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
    [FOCAL[0] * xd + SKEW * yd + PRINCIPAL[0], FOCAL[1] * yd + PRINCIPAL[1]]
}

/// Catmull-Rom interpolation of the table, inside it.
fn interpolated(c: &Calibration, recorded: [f64; 2]) -> [f64; 2] {
    let t = c.distortion.as_ref().unwrap();
    let weights = |s: f64| {
        let (s2, s3) = (s * s, s * s * s);
        [
            0.5 * (-s3 + 2.0 * s2 - s),
            0.5 * (3.0 * s3 - 5.0 * s2 + 2.0),
            0.5 * (-3.0 * s3 + 4.0 * s2 + s),
            0.5 * (s3 - s2),
        ]
    };
    let g = [0, 1].map(|i| (recorded[i] - t.first_px[i]) / t.step_px[i]);
    let cell = g.map(|v| v.floor() as usize);
    let w = [0, 1].map(|i| weights(g[i].fract()));
    let mut value = [0.0; 2];
    for (j, wy) in w[1].iter().enumerate() {
        for (i, wx) in w[0].iter().enumerate() {
            let at = t.ideal_px[(cell[1] + j - 1) * t.count[0] + cell[0] + i - 1];
            value[0] += wx * wy * at[0];
            value[1] += wx * wy * at[1];
        }
    }
    value
}

#[test]
fn undistortion_is_sampled_to_a_thousandth_of_a_pixel() {
    let folder = TempDir::new().unwrap();
    // Pincushion of some 20 px in the corner, with every term; then a mild one as XMALab fits it.
    for k in [[2.5, -4.0, 0.02, -0.03, 30.0, 0.4, -2.0, 5.0], [0.3, 0.0, 0.0, 0.001, 0.0, 0.0, 0.0, 0.0]] {
        let row: Vec<String> = k.iter().map(f64::to_string).collect();
        let one_row = mayacam_text() + "\nundistortion\n" + &row.join(",") + "\n";
        let lines = mayacam_text() + "\nundistortion\n" + &row.join("\n") + "\n";
        let c = read_mayacam2(write(&folder, "a", &one_row), PixelOrigin::Centre).unwrap();
        assert_eq!(c, read_mayacam2(write(&folder, "b", &lines), PixelOrigin::Centre).unwrap());
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for y in 0..60 {
            for x in 0..60 {
                let ideal = [f64::from(x) * 17.31, f64::from(y) * 12.93];
                let recorded = distorted(ideal, k);
                if recorded[0] < -0.5 || recorded[0] > 1023.5 || recorded[1] < -0.5 || recorded[1] > 767.5 {
                    continue;
                }
                let found = interpolated(&c, recorded);
                worst = worst.max((found[0] - ideal[0]).hypot(found[1] - ideal[1]));
                largest = largest.max((recorded[0] - ideal[0]).hypot(recorded[1] - ideal[1]));
            }
        }
        assert!(worst < 1e-3, "{worst} px");
        assert!(largest > 0.5, "{largest} px: nothing was tested");
    }
}

#[test]
fn undistortion_moves_with_the_pixel_origin() {
    let folder = TempDir::new().unwrap();
    let text = mayacam_text() + "\nundistortion\n2,0,0,0,0,0,0,0\n";
    let path = write(&folder, "a", &text);
    let centre = read_mayacam2(&path, PixelOrigin::Centre).unwrap();
    let corner = read_mayacam2(&path, PixelOrigin::Corner).unwrap();
    let [a, b] = [interpolated(&centre, [900.5, 700.5]), interpolated(&corner, [900.0, 700.0])];
    assert_relative_eq!(a[0] - 0.5, b[0], epsilon = 1e-3);
    assert_relative_eq!(a[1] - 0.5, b[1], epsilon = 1e-3);
}

#[test]
fn undistortion_that_folds_or_ends_early_is_refused() {
    let folder = TempDir::new().unwrap();
    let error = |tail: &str| {
        let path = write(&folder, "cam.txt", &(mayacam_text() + "\nundistortion\n" + tail));
        read_mayacam2(path, PixelOrigin::Centre).unwrap_err().to_string()
    };
    let e = error("-200,0,0,0,0,0,0,0\n");
    assert!(e.contains("undistortion folds the picture over at pixel"), "{e}");
    let e = error("1\n2\n3\n");
    assert!(e.contains("expected p2 of the undistortion, one number, found the end of the file"), "{e}");
    let e = error("1,2,3,4,5\n");
    assert!(e.contains("eight numbers"), "{e}");
    let e = error("0,0,0,0,0,0,0,0\nmore\n");
    assert!(e.contains("expected the end of the file, found `more`"), "{e}");
}

const PLANE: &str = r#"{ "seed": 1, "pixel_mm": 0.5, "size": [100, 80], "bodies": {}, "pixel_convention": "...",
  "fluoroscopes": {
    "A": { "source": [0, 0, 1000], "centre": [10, 20, 0], "u": [1, 0, 0], "v": [0, -1, 0], "n": [0, 0, -1], "l": 1000 },
    "B": { "source": [0, 0, 1000], "centre": [10, 20, 0], "u": [1, 0, 0], "v": [0, 1, 0] } } }"#;

#[test]
fn the_plane_form_projects_onto_the_plane() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "truth.json", PLANE);
    for (view, sign) in [("A", -1.0), ("B", 1.0)] {
        let c = read_calibration(&path, view, PixelOrigin::Centre).unwrap();
        // By hand: the middle of 100 x 80 pixels is (49.5, 39.5); a point of the plane is its own picture.
        let ([x, y], depth) = project(&c, Vector3::new(10.0, 20.0, 0.0));
        assert_relative_eq!(x, 49.5, epsilon = 1e-9);
        assert_relative_eq!(y, 39.5, epsilon = 1e-9);
        assert_relative_eq!(depth, 1000.0, epsilon = 1e-9);
        let ([x, y], _) = project(&c, Vector3::new(15.0, 22.0, 0.0));
        assert_relative_eq!(x, 59.5, epsilon = 1e-9);
        assert_relative_eq!(y, 39.5 + sign * 4.0, epsilon = 1e-9);
        // Half-way to the source, everything is twice as large: (7.5, 11) appears where (15, 22, 0) does.
        let ([x2, y2], depth) = project(&c, Vector3::new(7.5, 11.0, 500.0));
        assert_relative_eq!(x2, x, epsilon = 1e-9);
        assert_relative_eq!(y2, y, epsilon = 1e-9);
        assert_relative_eq!(depth, 500.0, epsilon = 1e-9);
        // The file names the middle of the picture: the same in either convention.
        assert_eq!(read_calibration(&path, view, PixelOrigin::Corner).unwrap(), c);
    }
}

#[test]
fn a_plane_that_cannot_be_is_refused() {
    let folder = TempDir::new().unwrap();
    let error = |from: &str, to: &str| {
        assert!(PLANE.contains(from), "{from}");
        let path = write(&folder, "truth.json", &PLANE.replacen(from, to, 1));
        read_plane_json(path, "A").unwrap_err().to_string()
    };
    let e = read_plane_json(write(&folder, "truth.json", PLANE), "C").unwrap_err().to_string();
    assert!(e.contains("no fluoroscope \"C\"; it has A, B"), "{e}");
    let e = error("[1, 0, 0]", "[1, 0.1, 0]");
    assert!(e.contains("u and v differ from unit vectors"), "{e}");
    let e = error("[0, 0, -1]", "[0, 0, 1]");
    assert!(e.contains("n is [0.0000, 0.0000, 1.0000], but u, v and the source give"), "{e}");
    let e = error("\"l\": 1000", "\"l\": 990");
    assert!(e.contains("l is 990 mm, but source and plane are 1000 mm apart"), "{e}");
    let e = error("\"source\": [0, 0, 1000]", "\"source\": [0, 0, 0]");
    assert!(e.contains("0.000 mm from the detector's plane"), "{e}");
    let e = error("\"pixel_mm\": 0.5", "\"pixel_mm\": 0");
    assert!(e.contains("pixel_mm is 0"), "{e}");
    let e = error("\"centre\": [10, 20, 0], ", "");
    assert!(e.contains("missing field `centre`") && e.contains("line 3"), "{e}");
}

#[test]
fn what_is_no_calibration_is_named() {
    let folder = TempDir::new().unwrap();
    let error = |text: &str| {
        read_calibration(write(&folder, "x.txt", text), "A", PixelOrigin::Centre).unwrap_err().to_string()
    };
    for (text, what) in [
        ("", "it is empty"),
        ("1,2,3\n4,5,6\n7,8,9\n1,2,3\n", "thesis's matrix of four points"),
        ("hello\n", "its first line is `hello`"),
        ("{}", "JSON without `fluoroscopes`"),
    ] {
        let e = error(text);
        assert!(e.contains(what) && e.contains("it reads MayaCam 2.0"), "{e}");
    }
    let path = folder.path().join("binary");
    std::fs::write(&path, [0x89, 0xff, 0, 1]).unwrap();
    let e = read_calibration(path, "A", PixelOrigin::Centre).unwrap_err().to_string();
    assert!(e.contains("byte 0 is not text"), "{e}");
}

fn table_text(change: impl Fn(usize, usize) -> Option<[f64; 2]>) -> String {
    let mut text = "distorted_x_px,distorted_y_px,ideal_x_px,ideal_y_px\n".to_owned();
    for j in 0..5 {
        for i in 0..6 {
            if let Some([x, y]) = change(i, j) {
                text += &format!("{},{},{x},{y}\n", 40 + 24 * i, 30 + 20 * j);
            }
        }
    }
    text
}

#[test]
fn distortion_samples_are_read_and_checked() {
    let folder = TempDir::new().unwrap();
    let read = |text: &str| read_distortion_csv(write(&folder, "d.csv", text)).map_err(|e| e.to_string());
    let good = |i: usize, j: usize| Some([50.0 + 23.0 * i as f64, 33.0 + 19.0 * j as f64]);
    let table = read(&table_text(good)).unwrap();
    assert_eq!((table.first_px, table.step_px, table.count), ([40.0, 30.0], [24.0, 20.0], [6, 5]));
    assert_eq!(table.ideal_px[6 + 2], [96.0, 52.0]);
    // In any order of rows.
    let text = table_text(good);
    let mut lines: Vec<&str> = text.lines().collect();
    lines[1..].reverse();
    assert_eq!(read(&lines.join("\n")), Ok(table));

    let e = read(&table_text(|i, j| good(i, j).filter(|_| (i, j) != (2, 3)))).unwrap_err();
    assert!(e.contains("29 samples, but a full grid of 6 x 5 has 30; the first one missing is that of recorded pixel (88, 90)"), "{e}");
    let e = read(&table_text(|i, j| if (i, j) == (2, 3) { good(4, 3) } else { good(i, j) })).unwrap_err();
    assert!(e.contains("folds over at recorded pixel"), "{e}");
    let e = read(&text.replacen("50,33", "NaN,33", 1)).unwrap_err();
    assert!(e.contains("line 2: expected a finite number in column `ideal_x_px`, found `NaN`"), "{e}");
    let e = read(&text.replacen("ideal_y_px", "y", 1)).unwrap_err();
    assert!(e.contains("a header with the column `ideal_y_px`"), "{e}");
    let e = read(&text.replacen("\n64,30", "\n65,30", 1)).unwrap_err();
    assert!(e.contains("is not on a regular grid"), "{e}");
}
