//! scratch
use biplane_validation::*; use std::path::PathBuf; use biplane_artifact::PixelOrigin; use biplane_optimisation::MatchParams; use biplane_segmentation::SegmentParams;
fn main() {
    let data = PathBuf::from("/work/shared/data"); let mut args = std::env::args().skip(1);
    let which = args.next().unwrap(); let count: usize = args.next().unwrap().parse().unwrap();
    let retries: usize = args.next().unwrap().parse().unwrap();
    let mm: f64 = args.next().map_or(6.0, |v| v.parse().unwrap());
    let mut segment = SegmentParams::default(); if let Ok(v) = std::env::var("SM") { segment.smoothing_px = v.parse().unwrap(); }
    if let Ok(v) = std::env::var("HI") { segment.high_threshold = v.parse().unwrap(); segment.low_threshold = segment.high_threshold*0.4; }
    let d = |v: &str, real: bool| if real { let r = data.join("real/knee-implant-biplane"); ViewFiles { name: v.into(), calibration: r.join(format!("cam{}.mayacam2.txt", if v=="A" {1} else {2})), distortion: None, frames: r.join(format!("cam{}", if v=="A" {1} else {2})), extension: "tif".into() } }
      else { let r = data.join("simulated/knee-implant"); ViewFiles { name: v.into(), calibration: r.join("truth/truth.json"), distortion: Some(r.join(format!("truth/distortion_{v}.csv"))), frames: r.join("frames").join(v), extension: "png".into() } };
    let (real, origin, mesh, reference) = match which.as_str() {
        "real" => (true, PixelOrigin::Corner, data.join("real/knee-implant-biplane/femur0.stl"), data.join("real/knee-implant-biplane/reference_femur_world_from_model.csv")),
        "realc" => (true, PixelOrigin::Centre, data.join("real/knee-implant-biplane/femur0.stl"), data.join("real/knee-implant-biplane/reference_femur_world_from_model.csv")),
        "femur" => (false, PixelOrigin::Centre, data.join("simulated/knee-implant/models/femoral_component_15000.stl"), data.join("simulated/knee-implant/truth/femoral_component_world_from_model.csv")),
        _ => (false, PixelOrigin::Centre, data.join("simulated/knee-implant/models/tray_15000.stl"), data.join("simulated/knee-implant/truth/tray_world_from_model.csv")),
    };
    let t = std::time::Instant::now();
    let scene = Scene::load(&SceneFiles { views: vec![d("A", real), d("B", real)], pixel_origin: origin, mesh, reference }, &segment).unwrap();
    eprintln!("load {:?}", t.elapsed()); let t = std::time::Instant::now();
    let a = attempts(&scene, &StartOffset { translation_mm: mm, rotation_deg: mm, count, seed: 1 }, &MatchParams { retries, ..Default::default() });
    println!("{which} {:?} a match (2 threads)\n{}", t.elapsed() / a.len() as u32, Summary::of(&a));
    if std::env::var("T").is_ok() { for x in &a { let r = &scene.frames.iter().find(|f| f.0 == x.frame).unwrap().1; let c = r.transform(scene.rim.centroid()); let m = biplane_geometry::Pose::from(x.answer.pose); let mc = m.transform(scene.rim.centroid()); println!("T {} ref {:.3} {:.3} {:.3}  ours {:.3} {:.3} {:.3}", x.frame, c.x, c.y, c.z, mc.x, mc.y, mc.z); } }
    if std::env::var("V").is_ok() { for x in &a { let v = &x.answer.views; println!("{} {:2} {:8} {:.3} mm {:.3} deg  share {:.2} {:.2} rms {:.2} {:.2} sig {:.3} {:.3} it {} d {:?} w {:?} {}", x.frame, x.start, x.verdict().word(), x.error.translation_mm, x.error.rotation_rad.to_degrees(), v[0].matched_share, v[1].matched_share, v[0].rms_px, v[1].rms_px, x.answer.translation_sigma_mm(), x.answer.rotation_sigma_rad().to_degrees(), x.answer.iterations, x.difference.1.as_slice(), (x.difference.0*57.3).as_slice(), x.answer.reason); } }
}
