//! Every calibration format: numbers worked by hand for its signs, round trips to every other one, what is refused.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::{Path, PathBuf};

use biplane_acquisition::calibration::{
    CalibratedView, CalibrationFormat, CalibrationSet, ReadOptions, WriteError, WriteOptions, Written,
    read_calibration, read_calibrations, read_distortion_csv, write_distortion_csv, write_four_points,
    write_jointtrack, write_jointtrack_biplane, write_mayacam1, write_mayacam2, write_plane_json,
};
use biplane_acquisition::inspect::describe;
use biplane_artifact::{
    Artifact, Calibration, Environment, PixelOrigin, PoseRecord, Verdict, ViewEnvironment,
};
use nalgebra::{Matrix3, Rotation3, Vector3};
use tempfile::TempDir;

const SIZE: [usize; 2] = [1024, 768];
const OPTIONS: WriteOptions =
    WriteOptions { pixel_origin: PixelOrigin::Centre, pixel_mm: None, without_distortion: false };
const ORIGINS: [PixelOrigin; 2] = [PixelOrigin::Centre, PixelOrigin::Corner];

fn write(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn read(folder: &TempDir, text: &str, origin: PixelOrigin, size: [usize; 2]) -> CalibrationSet {
    let path = write(folder, "calibration", text);
    read_calibrations(path, &ReadOptions { pixel_origin: origin, size: Some(size) }).unwrap()
}

/// `w (x, y, 1) = matrix (X - source)`.
fn project(view: &CalibratedView, point: Vector3<f64>) -> [f64; 2] {
    let c = &view.calibration;
    let p = Matrix3::from_fn(|i, j| c.matrix[i][j]) * (point - Vector3::from(c.source));
    [p.x / p.z, p.y / p.z]
}

fn near(found: [f64; 2], expected: [f64; 2], limit: f64, what: &str) {
    let apart = (found[0] - expected[0]).hypot(found[1] - expected[1]);
    assert!(apart < limit, "{what}: {found:?} is {apart} px from {expected:?}");
}

/// Numbers from 0 to 1 that repeat: multiples of the golden ratio.
fn fraction(index: usize, of: usize) -> f64 {
    (0.618_033_988_75 * (index * 31 + of + 1) as f64).fract()
}

/// Where a fluoroscope's axes (rows right, down, away) and source are, the focal length and the principal point.
struct Geometry {
    axes: Matrix3<f64>,
    source: Vector3<f64>,
    focal: f64,
    principal: [f64; 2],
    pixel_mm: f64,
}

/// A fluoroscope about a metre away that looks at the laboratory's origin, nearly, turned in any way.
fn geometry(index: usize) -> Geometry {
    let r = |of: usize| fraction(index, of);
    let turn = Rotation3::from_euler_angles(6.3 * r(0), 3.0 * r(1) - 1.5, 6.3 * r(2));
    let axes = *turn.matrix();
    let pixel_mm = 0.2 + 0.2 * r(3);
    let away = axes.row(2).transpose();
    let aside = axes.row(0).transpose() * (60.0 * r(4) - 30.0);
    Geometry {
        axes,
        source: aside - away * (400.0 + 400.0 * r(5)),
        focal: (900.0 + 200.0 * r(6)) / pixel_mm,
        principal: [512.0 + 40.0 * (r(7) - 0.5), 384.0 + 40.0 * (r(8) - 0.5)],
        pixel_mm,
    }
}

fn view(name: &str, g: &Geometry) -> CalibratedView {
    let k = Matrix3::new(g.focal, 0.0, g.principal[0], 0.0, g.focal, g.principal[1], 0.0, 0.0, 1.0);
    let m = k * g.axes;
    let calibration = Calibration {
        view: name.to_owned(),
        size: SIZE,
        source: g.source.into(),
        matrix: [0, 1, 2].map(|i| [m[(i, 0)], m[(i, 1)], m[(i, 2)]]),
        distortion: None,
    };
    CalibratedView { calibration, pixel_mm: Some(g.pixel_mm), coefficients: None, covariance: false }
}

/// 100 points of the volume that both fluoroscopes see.
fn volume() -> impl Iterator<Item = Vector3<f64>> {
    (0..100).map(|i| Vector3::new(fraction(i, 0), fraction(i, 1), fraction(i, 2)).map(|v| 200.0 * v - 100.0))
}

/// From the laboratory to camera A of JointTrack: x right, y up, z towards the source.
fn into_camera(g: &Geometry, point: Vector3<f64>) -> Vector3<f64> {
    let p = g.axes * (point - g.source);
    Vector3::new(p.x, -p.y, -p.z)
}

/// A writer of one view, and whether its world is the camera.
type OneView = (&'static str, fn(&CalibratedView, &WriteOptions) -> Result<Written, WriteError>);

fn plane(view: &CalibratedView, options: &WriteOptions) -> Result<Written, WriteError> {
    write_plane_json(std::slice::from_ref(view), options)
}

fn points(view: &CalibratedView, options: &WriteOptions) -> Result<Written, WriteError> {
    write_four_points(std::slice::from_ref(view), options)
}

const IN_THE_LABORATORY: [OneView; 4] =
    [("mayacam2", write_mayacam2), ("mayacam1", write_mayacam1), ("plane", plane), ("points", points)];

#[test]
fn every_pair_of_formats_keeps_projections() {
    let folder = TempDir::new().unwrap();
    for index in 0..10 {
        let g = geometry(index);
        let original = view("A", &g);
        for origin in ORIGINS {
            let options = WriteOptions { pixel_origin: origin, pixel_mm: Some(g.pixel_mm), ..OPTIONS };
            for (first, write_first) in IN_THE_LABORATORY {
                let text = write_first(&original, &options).unwrap().text;
                let once = read(&folder, &text, origin, SIZE).views.remove(0);
                assert_eq!(once.calibration.size, SIZE, "{first}");
                for (second, write_second) in IN_THE_LABORATORY {
                    let text = write_second(&once, &options).unwrap().text;
                    let twice = read(&folder, &text, origin, SIZE).views.remove(0);
                    for point in volume() {
                        let expected = project(&original, point);
                        near(
                            project(&twice, point),
                            expected,
                            1e-6,
                            &format!("{first} to {second}, {index}"),
                        );
                    }
                }
                let text = write_jointtrack(&once, &options).unwrap().text;
                let twice = read(&folder, &text, origin, SIZE).views.remove(0);
                for point in volume() {
                    let expected = project(&original, point);
                    near(
                        project(&twice, into_camera(&g, point)),
                        expected,
                        1e-6,
                        &format!("{first} to JointTrack"),
                    );
                }
                // And on from there, in its own world.
                let text = write_second_plane(&twice, &options);
                let thrice = read(&folder, &text, origin, SIZE).views.remove(0);
                for point in volume() {
                    let at = into_camera(&g, point);
                    near(project(&thrice, at), project(&twice, at), 1e-6, "JointTrack to plane");
                }
            }
        }
    }
}

fn write_second_plane(view: &CalibratedView, options: &WriteOptions) -> String {
    plane(view, options).unwrap().text
}

#[test]
fn two_views_keep_their_relation_in_jointtrack() {
    let folder = TempDir::new().unwrap();
    for index in 0..10 {
        let (a, b) = (geometry(index), geometry(index + 50));
        let views = [view("left", &a), view("right", &b)];
        for origin in ORIGINS {
            let options = WriteOptions { pixel_origin: origin, ..OPTIONS };
            let written = write_jointtrack_biplane([&views[0], &views[1]], &options).unwrap();
            assert!(written.lost.iter().any(|l| l.contains("camera A is the world")), "{:?}", written.lost);
            let set = read(&folder, &written.text, origin, SIZE);
            assert_eq!(set.format, CalibrationFormat::JointTrackBiplane);
            for point in volume() {
                for (from, to) in views.iter().zip(&set.views) {
                    near(
                        project(to, into_camera(&a, point)),
                        project(from, point),
                        1e-6,
                        &to.calibration.view,
                    );
                }
            }
            // Through four points and back, both views in a file.
            let text = write_four_points(&set.views, &options).unwrap().text;
            let again = read(&folder, &text, origin, SIZE);
            let text = write_plane_json(&again.views, &options).unwrap().text;
            let again = read(&folder, &text, origin, SIZE);
            let text = write_jointtrack_biplane([&again.views[0], &again.views[1]], &options).unwrap().text;
            let again = read(&folder, &text, origin, SIZE);
            for point in volume() {
                for (from, to) in views.iter().zip(&again.views) {
                    near(
                        project(to, into_camera(&a, point)),
                        project(from, point),
                        1e-6,
                        &to.calibration.view,
                    );
                }
            }
        }
    }
}

#[test]
fn jointtrack_one_plane_by_hand() {
    let folder = TempDir::new().unwrap();
    // f = 1000 mm, x0 = 5, y0 = -3 mm, pixels of 0.5 mm; the point (10, 20, -500):
    // column = 400/2 + 5/0.5 - (1000/0.5) 10/(-500) = 250; row from the bottom = 300/2 - 6 - 2000 20/(-500) = 224.
    let point = Vector3::new(10.0, 20.0, -500.0);
    for word in ["JT_INTCALIB", "JTA_INTCALIB"] {
        for between in ["\n", ",", " ", "\t"] {
            let text = [word, "1000", "5", "-3", "0.5"].join(between);
            // Counted from the centre: row 224 from the bottom is 299 - 224 from the top.
            let set = read(&folder, &text, PixelOrigin::Centre, [400, 300]);
            assert_eq!(set.format, CalibrationFormat::JointTrack);
            near(project(&set.views[0], point), [250.0, 75.0], 1e-9, word);
            assert_eq!(set.views[0].pixel_mm, Some(0.5));
            // From the corner: half a pixel less from the left, and from the bottom.
            let set = read(&folder, &text, PixelOrigin::Corner, [400, 300]);
            near(project(&set.views[0], point), [249.5, 75.5], 1e-9, word);
        }
    }
    // Without offsets and counted from corners, the axis goes through the picture's middle, (W - 1) / 2.
    let set = read(&folder, "JT_INTCALIB\n1198\n0\n0\n0.373\n", PixelOrigin::Corner, [1024, 1024]);
    near(project(&set.views[0], Vector3::new(0.0, 0.0, -9.0)), [511.5, 511.5], 1e-9, "middle");
}

/// B stands at (500, 0, -500) of A and looks along -x of A; its x runs along -z, its y is A's.
const TWO_PLANES: &str =
    "JTA_INTCALIB_BIPLANE\n1000,0,0,0.5\n1000,0,0,0.5\n500,0,-500\n0,0,1\n0,1,0\n-1,0,0\n";

#[test]
fn jointtrack_two_planes_by_hand() {
    let folder = TempDir::new().unwrap();
    let set = read(&folder, TWO_PLANES, PixelOrigin::Centre, [400, 300]);
    let point = Vector3::new(0.0, 10.0, -480.0);
    // A: column 200, row from the bottom 150 - 2000 10/(-480) = 191.6667.
    near(project(&set.views[0], point), [200.0, 299.0 - 191.666_666_667], 1e-6, "A");
    // B: p - o = (-500, 10, 20); along B's x -20, y 10, z -500: column 200 - 2000 (-20)/(-500), row 150 + 40.
    near(project(&set.views[1], point), [120.0, 109.0], 1e-9, "B");
    let names: Vec<&str> = set.views.iter().map(|v| v.calibration.view.as_str()).collect();
    assert_eq!(names, ["A", "B"]);
}

#[test]
fn mayacam1_by_hand() {
    let folder = TempDir::new().unwrap();
    let at = |source: &str, angles: &str, point: [f64; 3], origin| {
        let text = format!("{source}\n{angles}\n0,0,-200\n513,513,-2000\n0.1,1024,0\n");
        let set = read(&folder, &text, origin, [1, 1]);
        assert_eq!((set.format, set.views[0].calibration.size), (CalibrationFormat::MayaCam1, [1024, 1024]));
        project(&set.views[0], point.into())
    };
    // Looks along -z, x right, y up: column 513 - 1 + 2000 10/1000; rows upward 513 - 1 + 2000 20/1000 = 552, 1023 - 552.
    let found = at("0,0,1000", "0,0,0", [10.0, 20.0, 0.0], PixelOrigin::Centre);
    near(found, [532.0, 471.0], 1e-9, "straight");
    let found = at("0,0,1000", "0,0,0", [10.0, 20.0, 0.0], PixelOrigin::Corner);
    near(found, [531.5, 470.5], 1e-9, "from the corner");
    // A quarter turn about z: right is y, up is -x, so 20 right and 10 down.
    let found = at("0,0,1000", "0,0,90", [10.0, 20.0, 0.0], PixelOrigin::Centre);
    near(found, [552.0, 531.0], 1e-9, "about z");
    // Rz(90) Rx(90): right is y, up is z, back is x.
    let found = at("1000,0,0", "90,0,90", [0.0, 10.0, 20.0], PixelOrigin::Centre);
    near(found, [532.0, 471.0], 1e-9, "about x, then z");
}

#[test]
fn mayacam1_is_what_xmalab_makes_of_a_mayacam2() {
    let folder = TempDir::new().unwrap();
    for index in 0..10 {
        let g = geometry(index);
        let original = view("A", &g);
        // XMALab's Camera::getMayaCam, step by step: x and z of the camera are turned round, the y of the principal point
        // is counted from the bottom; then the camera's place, and three angles of the inverse rotation in degrees.
        let flip = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, -1.0));
        let t = flip * -(g.axes * g.source);
        let r = (flip * g.axes).transpose();
        let place = -(r * t);
        let angles = [
            (-r[(2, 1)]).atan2(r[(2, 2)]),
            r[(2, 0)].atan2(r[(2, 1)].hypot(r[(2, 2)])),
            (-r[(1, 0)]).atan2(-r[(0, 0)]),
        ]
        .map(f64::to_degrees);
        let (cx, cy) = (g.principal[0], SIZE[1] as f64 - 1.0 - g.principal[1]);
        let text = format!(
            "{},{},{}\n{},{},{}\n0,0,0\n{},{},{}\n0.1,{},{}\n",
            place.x,
            place.y,
            place.z,
            angles[0],
            angles[1],
            angles[2],
            cx + 1.0,
            cy + 1.0,
            -g.focal,
            SIZE[0],
            SIZE[1]
        );
        let set = read(&folder, &text, PixelOrigin::Centre, SIZE);
        for point in volume() {
            near(project(&set.views[0], point), project(&original, point), 1e-6, "XMALab's");
        }
    }
}

#[test]
fn the_sample_of_autoscopers_documents_looks_at_the_origin() {
    let folder = TempDir::new().unwrap();
    let text = "-737.5,-514.9,94.3\n89.7,-2.0,-55.2\n3.9,4.1,-632.5\n840.2,839.2,-6325.8\n0.1,1760,1760\n";
    let set = read(&folder, text, PixelOrigin::Centre, SIZE);
    let [x, y] = project(&set.views[0], Vector3::zeros());
    assert!(set.views[0].calibration.matrix[2][0] > 0.0, "looks away");
    assert!((0.0..1760.0).contains(&x) && (0.0..1760.0).contains(&y), "({x}, {y})");
}

const POINTS: &str = "view,columns,rows,point,x_mm,y_mm,z_mm,x_px,y_px\n# seen from above\nA,400,300,viewpoint,0,0,1000,,\n\
                      A,400,300,origin,0,0,0,200,150\nA,400,300,first,100,0,0,400,150\nA,400,300,second,0,-50,0,200,250\n";

#[test]
fn four_points_by_hand() {
    let folder = TempDir::new().unwrap();
    let set = read(&folder, POINTS, PixelOrigin::Corner, [1, 1]);
    assert_eq!((set.format, set.views[0].calibration.size), (CalibrationFormat::FourPoints, [400, 300]));
    // Pixels of 0.5 mm; half-way up everything is twice as large: (10, 20, 500) casts its shadow at (20, 40, 0).
    near(project(&set.views[0], Vector3::new(10.0, 20.0, 500.0)), [240.0, 70.0], 1e-9, "square");
    assert_eq!(set.views[0].pixel_mm, Some(0.5));
    // Pixels that are not squares, and a skew: what other formats cannot hold.
    let skewed = POINTS.replace("second,0,-50,0", "second,5,-40,0");
    let set = read(&folder, &skewed, PixelOrigin::Centre, [1, 1]);
    near(project(&set.views[0], Vector3::new(5.0, -40.0, 0.0)), [200.0, 250.0], 1e-9, "skewed");
    near(project(&set.views[0], Vector3::new(50.0, 0.0, 0.0)), [300.0, 150.0], 1e-9, "skewed");
    assert_eq!(set.views[0].pixel_mm, None);
    let options = WriteOptions { pixel_mm: Some(0.5), ..OPTIONS };
    for (name, write) in
        [("mayacam1", write_mayacam1 as fn(&_, &_) -> _), ("plane", plane), ("jt", write_jointtrack)]
    {
        let error = write(&set.views[0], &options).unwrap_err();
        assert!(matches!(error, WriteError::Moves { px, .. } if px > 1.0), "{name}: {error}");
    }
    for (name, write) in [("mayacam2", write_mayacam2 as fn(&_, &_) -> _), ("points", points)] {
        let text = write(&set.views[0], &options).unwrap().text;
        let back = read(&folder, &text, PixelOrigin::Centre, [1, 1]);
        for point in volume() {
            near(project(&back.views[0], point), project(&set.views[0], point), 1e-6, name);
        }
    }
}

#[test]
fn what_pictures_would_show_is_refused_and_the_rest_is_told() {
    let g = geometry(3);
    let mut unequal = view("A", &g);
    let along_x = Vector3::from(unequal.calibration.matrix[0])
        - Vector3::from(unequal.calibration.matrix[2]) * g.principal[0];
    let nudge = |by: f64| {
        let mut v = view("A", &g);
        for (m, a) in v.calibration.matrix[0].iter_mut().zip(along_x.iter()) {
            *m += a * by;
        }
        v
    };
    // A focal length longer by 1e-5 moves the picture's edge, 500 px and more from the axis, by half of that: 0.003 px.
    let slight = write_mayacam1(&nudge(1e-5), &OPTIONS).unwrap();
    assert!(slight.lost.iter().any(|l| l.contains("separate axes")), "{:?}", slight.lost);
    let e = write_mayacam1(&nudge(1e-3), &OPTIONS).unwrap_err().to_string();
    assert!(e.contains("MayaCam 1.0 cannot hold view \"A\": projections would move by up to 0.3"), "{e}");
    assert!(e.contains("its focal lengths are"), "{e}");

    unequal.covariance = true;
    let lost = write_mayacam2(&unequal, &OPTIONS).unwrap().lost;
    assert!(lost[0].contains("size of a pixel") && lost[1].contains("covariance"), "{lost:?}");

    let mut mirrored = view("A", &g);
    let last = SIZE[0] as f64 - 1.0;
    let depth = Vector3::from(mirrored.calibration.matrix[2]);
    mirrored.calibration.matrix[0] = (depth * last - Vector3::from(mirrored.calibration.matrix[0])).into();
    for write in [write_mayacam1, write_mayacam2, write_jointtrack] {
        let error = write(&mirrored, &OPTIONS).unwrap_err();
        assert!(matches!(error, WriteError::Mirrored { .. }), "{error}");
    }
    assert!(plane(&mirrored, &OPTIONS).is_ok() && points(&mirrored, &OPTIONS).is_ok());

    let no_pixel = CalibratedView { pixel_mm: None, ..view("A", &g) };
    for write in [plane, points, write_jointtrack] {
        let e = write(&no_pixel, &OPTIONS).unwrap_err().to_string();
        assert!(e.contains("--pixel-mm"), "{e}");
    }
}

#[test]
fn a_distortion_is_kept_by_its_coefficients_or_refused() {
    let folder = TempDir::new().unwrap();
    let plain = view("A", &geometry(4));
    let text = write_mayacam2(&plain, &OPTIONS).unwrap().text + "\nundistortion\n2,0,0,0.01,0,0,0,0\n";
    let distorted = read(&folder, &text, PixelOrigin::Centre, SIZE).views.remove(0);
    for origin in ORIGINS {
        let options = WriteOptions { pixel_origin: origin, ..OPTIONS };
        let text = write_mayacam2(&distorted, &options).unwrap().text;
        let back = read(&folder, &text, origin, SIZE).views.remove(0);
        let [was, is] = [&distorted, &back].map(|v| v.calibration.distortion.as_ref().unwrap());
        for (a, b) in was.ideal_px.iter().zip(&is.ideal_px) {
            near(*b, *a, 1e-6, "distortion");
        }
    }
    let options = WriteOptions { pixel_mm: Some(0.3), ..OPTIONS };
    for write in [plane, points, write_jointtrack, write_mayacam1] {
        let e = write(&distorted, &options).unwrap_err().to_string();
        assert!(e.contains("cannot hold the distortion") && e.contains("--without-distortion"), "{e}");
        let written = write(&distorted, &WriteOptions { without_distortion: true, ..options }).unwrap();
        assert!(written.lost.iter().any(|l| l.contains("for corrected pictures")), "{:?}", written.lost);
    }
    // The table goes into a file of its own.
    let table = distorted.calibration.distortion.unwrap();
    let path = write(&folder, "d.csv", &write_distortion_csv(&table));
    let back = read_distortion_csv(path).unwrap();
    assert_eq!((back.count, back.step_px, back.ideal_px), (table.count, table.step_px, table.ideal_px));
}

fn environment() -> Environment {
    let views = [("left", geometry(7)), ("right", geometry(8))].map(|(name, g)| {
        let CalibratedView { calibration: c, pixel_mm, .. } = view(name, &g);
        ViewEnvironment {
            view: c.view,
            size: c.size,
            pixel_mm: pixel_mm.unwrap(),
            source: c.source,
            centre: [0.0; 3],
            along_x: [0.0; 3],
            along_y: [0.0; 3],
            matrix: c.matrix,
            source_to_detector_mm: g.focal * g.pixel_mm,
            reprojection_rms_px: 0.1,
            sigma_px: 0.1,
            beads: Vec::new(),
            strays: Vec::new(),
            missing: Vec::new(),
        }
    });
    let standing = PoseRecord { translation_mm: [0.0; 3], quaternion_wxyz: [1.0, 0.0, 0.0, 0.0] };
    Environment {
        views: views.into(),
        bead_frames: vec![standing],
        angle_deg: None,
        triangulated: Vec::new(),
        triangulation_rms_mm: None,
        covariance: Vec::new(),
        verdict: Verdict::Good,
        warnings: Vec::new(),
    }
}

#[test]
fn an_environment_of_this_program_goes_out_to_others() {
    let folder = TempDir::new().unwrap();
    let text = String::from_utf8(environment().encode()).unwrap();
    let set = read(&folder, &text, PixelOrigin::Corner, SIZE);
    assert_eq!(set.format, CalibrationFormat::Environment);
    let written = write_mayacam2(&set.views[1], &OPTIONS).unwrap();
    assert!(written.lost.iter().any(|l| l.contains("covariance")), "{:?}", written.lost);
    let back = read(&folder, &written.text, PixelOrigin::Centre, SIZE);
    for point in volume() {
        near(project(&back.views[0], point), project(&view("right", &geometry(8)), point), 1e-6, "right");
    }
    let path = write(&folder, "e.json", &text);
    assert_eq!(read_calibration(&path, "left", PixelOrigin::Centre).unwrap().view, "left");
    let e = read_calibration(&path, "A", PixelOrigin::Centre).unwrap_err().to_string();
    assert!(e.contains("no fluoroscope \"A\"; it has left, right"), "{e}");
    let mut broken = environment();
    broken.views[0].matrix[2] = [0.0, 0.0, 2.0];
    let path = write(&folder, "e.json", &String::from_utf8(broken.encode()).unwrap());
    let e = read_calibration(&path, "left", PixelOrigin::Centre).unwrap_err().to_string();
    assert!(e.contains("view left: its matrix is no projection"), "{e}");
}

#[test]
fn views_of_a_plane_file_may_have_their_own_pixels() {
    let folder = TempDir::new().unwrap();
    let views = [view("A", &geometry(1)), view("B", &geometry(2))];
    let text = write_plane_json(&views, &OPTIONS).unwrap().text;
    let set = read(&folder, &text, PixelOrigin::Centre, SIZE);
    for (from, to) in views.iter().zip(&set.views) {
        let [a, b] = [from, to].map(|v| v.pixel_mm.unwrap());
        assert!((a - b).abs() < 1e-12);
    }
    let e = read_calibrations(
        write(&folder, "x", &text.replacen("pixel_mm", "pixel", 1)),
        &ReadOptions { pixel_origin: PixelOrigin::Centre, size: None },
    )
    .unwrap_err()
    .to_string();
    assert!(e.contains("fluoroscope A has no `pixel_mm`"), "{e}");
}

#[test]
fn broken_files_are_refused_by_line() {
    let folder = TempDir::new().unwrap();
    let error = |text: &str, size: Option<[usize; 2]>| {
        let options = ReadOptions { pixel_origin: PixelOrigin::Centre, size };
        read_calibrations(write(&folder, "c.txt", text), &options).unwrap_err().to_string()
    };
    let e = error("JT_INTCALIB\n1198\n0\n0\n0.373\n", None);
    assert!(e.contains("does not hold the picture's size") && e.contains("--size"), "{e}");
    let size = Some([400, 300]);
    for (from, text, what) in [
        (
            "JT",
            "JT_INTCALIB\n1198\n0\n0\n",
            "line 5: expected number 4 of 4 after the first word, found nothing",
        ),
        (
            "JT",
            "JT_INTCALIB\n1198\n0\nzero\n0.3",
            "line 4: expected number 3 of 4 after the first word, found `zero`",
        ),
        (
            "JT",
            "JT_INTCALIB\n1198\n0\n0\n0.3\n7",
            "line 6: expected the end of the file after 4 numbers, found `7`",
        ),
        ("JT", "JT_INTCALIB\n1198\n0\n0\n0", "pixels of 0 mm"),
        ("MayaCam 1", "0,0,1\n0,0,0\n0,0,0\n1,1,2000\n0.1,10,10", "expected u0,v0,Z with a negative Z"),
        ("MayaCam 1", "0,0,1\n0,0,0\n0,0,0\n1,1,-2000\n0.1,10.5,10", "line 5 says 10.5 x 10 pixels"),
    ] {
        let e = error(text, size);
        assert!(e.contains(what), "{from}: {e}");
    }
    let e = error(&TWO_PLANES.replace("-1,0,0\n", "-1,0.1,0\n"), size);
    assert!(e.contains("the axes of camera B are no rotation"), "{e}");
    let e = error(&TWO_PLANES.replace("-1,0,0\n", "1,0,0\n"), size);
    assert!(e.contains("or mirror"), "{e}");
    for (from, to, what) in [
        ("A,400,300,second,0,-50,0,200,250\n", "", "view A: no row for its second"),
        ("second,0,-50,0,200,250", "second,50,0,0,200,250", "lie in a line"),
        ("second,0,-50,0,200,250", "second,0,-50,0,300,150", "lie in a line"),
        ("viewpoint,0,0,1000", "viewpoint,0,0,0", "its viewpoint lies 0.000 mm from the plane"),
        ("A,400,300,first", "A,401,300,first", "line 5: expected a picture of 400 x 300 pixels"),
        ("first,100", "third,100", "line 5: expected viewpoint, origin, first or second, found `third`"),
        ("A,400,300,first", "A,400,300,origin", "line 5: expected each point once, found the origin again"),
    ] {
        assert!(POINTS.contains(from), "{from}");
        let e = error(&POINTS.replace(from, to), None);
        assert!(e.contains(what), "{e}");
    }
}

#[test]
fn damaged_files_never_panic() {
    let folder = TempDir::new().unwrap();
    let g = [geometry(1), geometry(2)];
    let views = [view("A", &g[0]), view("B", &g[1])];
    let texts = [
        write_mayacam1(&views[0], &OPTIONS).unwrap().text,
        write_mayacam2(&views[0], &OPTIONS).unwrap().text,
        write_jointtrack(&views[0], &OPTIONS).unwrap().text,
        TWO_PLANES.to_owned(),
        POINTS.to_owned(),
        write_plane_json(&views, &OPTIONS).unwrap().text,
        String::from_utf8(environment().encode()).unwrap(),
    ];
    let options = ReadOptions { pixel_origin: PixelOrigin::Centre, size: Some(SIZE) };
    let path = folder.path().join("damaged");
    for text in texts {
        let bytes = text.as_bytes();
        for place in (0..bytes.len()).step_by(bytes.len() / 25 + 1) {
            for with in [&b""[..], b"-", b"e9", b"1e308", b"\xff", b"nan", b",", b"\n"] {
                let mut damaged = bytes[..place].to_vec();
                if !with.is_empty() {
                    damaged.extend(with);
                    damaged.extend(&bytes[place + 1..]);
                }
                std::fs::write(&path, &damaged).unwrap();
                if let Ok(set) = read_calibrations(&path, &options) {
                    for view in &set.views {
                        let all = WriteOptions { pixel_mm: Some(0.3), ..OPTIONS };
                        for (_, write) in IN_THE_LABORATORY {
                            let _ = write(view, &all);
                        }
                        let _ = write_jointtrack(view, &all);
                    }
                }
                let _ = describe(&path);
            }
        }
    }
}

#[test]
fn formats_are_described_with_their_conventions() {
    let folder = TempDir::new().unwrap();
    let says = |text: &str, parts: &[&str]| {
        let described = describe(write(&folder, "c", text)).unwrap().to_string();
        for part in parts {
            assert!(described.contains(part), "{part} not in: {described}");
        }
    };
    says(
        TWO_PLANES,
        &[
            "JointTrack, two planes",
            "A, B",
            "camera A is the world",
            "B: source",
            "(500.000, 0.000, -500.000) mm",
            "1000.000 mm, with pixels of 0.500000 mm",
            "90.0",
            "707.11 mm apart",
            "not in this format; what follows is for",
        ],
    );
    says("JT_INTCALIB\n1198\n0\n0\n0.373\n", &["JointTrack, one plane (one fluoroscope)", "1198.000 mm"]);
    let one = view("A", &geometry(1));
    says(
        &write_mayacam1(&one, &OPTIONS).unwrap().text,
        &[
            "MayaCam 1.0",
            "rows upward",
            "it needs the size of a pixel",
            "1024 x 768 px",
            "as seen from the source",
        ],
    );
    says(
        POINTS,
        &["four points", "1000.000 mm, with pixels of 0.500000 mm", "centre of the first pixel at (0, 0)"],
    );
    says(
        std::str::from_utf8(&environment().encode()).unwrap(),
        &[
            "found from beads",
            "left, right",
            "that of the beads",
            "covariance",
            "in the file",
            "angle between left and right",
        ],
    );
}

#[test]
fn real_calibrations_survive_every_format() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/real");
    let folder = TempDir::new().unwrap();
    if !data.is_dir() {
        println!("skipped: no real data beside this checkout");
        return;
    }
    let options = WriteOptions { pixel_mm: Some(0.3), ..OPTIONS };
    for name in ["knee-implant-biplane", "knee-natural-biplane"] {
        for camera in ["cam1", "cam2"] {
            let path = data.join(name).join(format!("{camera}.mayacam2.txt"));
            let set =
                read_calibrations(&path, &ReadOptions { pixel_origin: PixelOrigin::Centre, size: None })
                    .unwrap();
            let original = &set.views[0];
            for (format, write) in [("mayacam2", write_mayacam2 as fn(&_, &_) -> _), ("points", points)] {
                let text = write(original, &options).unwrap().text;
                let back = read(&folder, &text, PixelOrigin::Centre, SIZE);
                for point in volume() {
                    near(project(&back.views[0], point), project(original, point), 1e-6, format);
                }
            }
            // Their focal lengths differ by 0.5 %, which MayaCam 1.0 and JointTrack cannot hold.
            for write in [write_mayacam1, write_jointtrack, plane] {
                assert!(
                    matches!(write(original, &options), Err(WriteError::Moves { .. })),
                    "{}",
                    path.display()
                );
            }
        }
    }
    let path = data.join("knee-implant-single/calibration.txt");
    let size = Some([1024, 1024]);
    let set = read_calibrations(&path, &ReadOptions { pixel_origin: PixelOrigin::Centre, size }).unwrap();
    // As that data's README projects: u = 512 + (1198 / 0.373) x / -z.
    let [x, _] = project(&set.views[0], Vector3::new(18.5, 19.7, -1027.7));
    assert!((x - (512.0 + 1198.0 / 0.373 * 18.5 / 1027.7)).abs() < 1e-9);
    let text = write_jointtrack(&set.views[0], &OPTIONS).unwrap().text;
    let numbers: Vec<f64> = text.lines().skip(1).map(|l| l.parse().unwrap()).collect();
    for (found, expected) in numbers.iter().zip([1198.0, 0.0, 0.0, 0.373]) {
        assert!((found - expected).abs() < 1e-9, "{text}");
    }
}
