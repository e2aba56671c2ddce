//! The same points through OpenCV's `calibrateCamera`: square pixels, no distortion, no skew, a free principal point, as here.
//!
//! Python is `$BIPLANE_PYTHON`, or `python3`; where it has no `cv2` (pip: opencv-python-headless) the test says that it is skipped.
//! With OpenCV 5.0.0, `cargo test -p biplane-environment --test opencv -- --nocapture` printed for the four views of the two frames
//! sources that are 3e-13 to 4e-9 mm apart, equal rms to all six printed places (0.097911 to 0.121268 px), and `solvePnP` within
//! 1.1e-5 mm of `calibrateCamera`.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

mod scene;

use std::fmt::Write as _;
use std::process::Command;

use biplane_environment::EnvironmentParams;
use biplane_geometry::{Point2, Point3};
use biplane_phantom::BeadLayout;
use scene::{Scene, spot};

/// Reads lines `x y z u v` from its argument, prints `source_x source_y source_z rms`; of points not in a plane a guess of the
/// intrinsic numbers is needed.
const PROGRAM: &str = r#"
import sys
try:
    import cv2, numpy as np
except ImportError:
    sys.exit(77)
rows = np.array([[float(v) for v in l.split()] for l in sys.argv[1].strip().splitlines()])
x, u = rows[:, :3].astype(np.float32), rows[:, 3:].astype(np.float32)
k = np.array([[3500.0, 0, 511.5], [0, 3500.0, 511.5], [0, 0, 1]])
flags = (cv2.CALIB_USE_INTRINSIC_GUESS | cv2.CALIB_FIX_ASPECT_RATIO | cv2.CALIB_ZERO_TANGENT_DIST
         | cv2.CALIB_FIX_K1 | cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3)
stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 500, 1e-14)
rms, k, d, r, t = cv2.calibrateCamera([x], [u], (1024, 1024), k, np.zeros(5), flags=flags, criteria=stop)
source = -cv2.Rodrigues(r[0])[0].T @ t[0]
ok, r2, t2 = cv2.solvePnP(x.astype(float), u.astype(float), k, d, flags=cv2.SOLVEPNP_ITERATIVE)
again = -cv2.Rodrigues(r2)[0].T @ t2
print(*source.ravel(), rms, float(np.linalg.norm(again - source)), cv2.__version__)
"#;

/// Source, rms and how far `solvePnP` with the same intrinsic numbers is from it; none without `cv2`.
fn opencv(points: &str) -> Option<(Point3, f64, f64)> {
    let python = std::env::var("BIPLANE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let output = Command::new(python).args(["-c", PROGRAM, points]).output().ok()?;
    if output.status.code() == Some(77) {
        return None;
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let n: Vec<f64> = text.split_whitespace().take(5).map(|v| v.parse().unwrap()).collect();
    Some((Point3::new(n[0], n[1], n[2]), n[3], n[4]))
}

#[test]
fn opencv_finds_the_same_source() {
    for (name, layout, share) in
        [("150 mm midway", BeadLayout::large(), 0.5), ("100 mm at 0.7", BeadLayout::small(), 0.7)]
    {
        let mut scene = Scene::exact(&layout, share, 80.0, 21);
        // OpenCV knows points, no shadows.
        scene.list.0.iter_mut().for_each(|b| b.radius_mm = None);
        for (spots, truth) in scene.spots.iter_mut().zip(&scene.fluoroscopes) {
            spots.spots = scene
                .list
                .0
                .iter()
                .map(|b| {
                    let (at, _) = truth.project(&Point3::from(b.at_mm)).unwrap();
                    spot(at, if b.mark { 15.0 } else { 9.0 })
                })
                .collect();
        }
        scene.add_noise(0.1, 21);
        // OpenCV takes float32: the same rounded numbers for both.
        for b in &mut scene.list.0 {
            b.at_mm = b.at_mm.map(|v| f64::from(v as f32));
        }
        for s in scene.spots.iter_mut().flat_map(|s| &mut s.spots) {
            s.at_px = s.at_px.map(|v| f64::from(v as f32));
        }
        let found = scene.find(&EnvironmentParams::default()).unwrap();
        for (view, truth) in found.views.iter().zip(&scene.fluoroscopes) {
            assert!(view.beads.iter().all(|b| b.used));
            let mut points = String::new();
            for b in &view.beads {
                let [x, y, z] = scene.list.0[b.bead].at_mm;
                let at = Point2::from(b.at_px);
                writeln!(points, "{x} {y} {z} {} {}", at.x, at.y).unwrap();
            }
            let Some((source, rms, again)) = opencv(&points) else {
                println!("skipped: no cv2 in $BIPLANE_PYTHON or python3");
                return;
            };
            let own = Point3::from(view.source);
            println!(
                "{name}, view {}: {:.2e} mm between the sources, {:.3} mm from the truth; rms {:.6} px, OpenCV's {rms:.6} px; \
                 solvePnP {again:.1e} mm",
                view.view,
                (own - source).norm(),
                (own - truth.source).norm(),
                view.reprojection_rms_px,
            );
            assert!((own - source).norm() < 1e-5);
            assert!((view.reprojection_rms_px - rms).abs() < 1e-6);
            assert!(again < 1e-3);
        }
    }
}
