//! Pictures that this project did not make.

use std::path::{Path, PathBuf};

use biplane_artifact::Frame;
use biplane_spots::{Look, SpotParams, SpotSettings, find_spots};

fn data(path: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data").join(path);
    if !path.exists() {
        println!("skipped: {} is not there", path.display());
        return None;
    }
    Some(path)
}

fn frame(path: &Path) -> Frame {
    let grey = image::open(path).unwrap().into_luma8();
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    Frame { width, height, samples: grey.into_raw().into_iter().map(u16::from).collect(), bits: 8 }
}

#[test]
fn probe() {
    for (p, look) in [
        ("simulated/knee-implant/calibration/plate_A.png", Look::Bright),
        ("simulated/knee-implant/calibration/plate_B.png", Look::Bright),
        ("simulated/knee-natural/calibration/plate_B.png", Look::Bright),
        ("simulated/knee-implant/calibration/beads_A.png", Look::Dark),
        ("simulated/knee-implant/calibration/beads_B.png", Look::Dark),
        ("simulated/knee-natural/calibration/beads_A.png", Look::Dark),
        ("simulated/knee-natural/calibration/beads_B.png", Look::Dark),
        ("simulated/knee-implant/frames/A/0003.png", Look::Dark),
        ("simulated/knee-implant/frames/A/0003.png", Look::Bright),
        ("real/grids/dot_pattern_01.jpg", Look::Dark),
        ("real/grids/line_pattern_01.jpg", Look::Dark),
        ("real/knee-implant-biplane/frames/A/000.png", Look::Dark),
    ] {
        let Some(path) = data(p) else { continue };
        let f = frame(&path);
        let t = std::time::Instant::now();
        let s = find_spots(&f, &SpotParams { look, settings: SpotSettings::default() }).unwrap();
        println!(
            "{p} {look:?}: {} spots {} cut {:?} {:.0} ms",
            s.spots.len(),
            s.spots.iter().filter(|s| s.cut).count(),
            s.border,
            t.elapsed().as_secs_f64() * 1e3
        );
        for q in s.spots.iter().filter(|q| q.cut || s.spots.len() < 40) {
            println!(
                "   {:.2} {:.2} r {:.2} e {:.3} c {:.1} s {:.4} {}",
                q.at_px[0], q.at_px[1], q.radius_px, q.elongation, q.contrast, q.sigma_px, q.cut
            );
        }
    }
}
