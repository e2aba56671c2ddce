//! scratch
use biplane_validation::*; use std::path::PathBuf; use biplane_artifact::PixelOrigin; use biplane_segmentation::SegmentParams; use biplane_outline::*;
fn main() {
    let data = PathBuf::from("/work/shared/data"); let which = std::env::args().nth(1).unwrap();
    let mut segment = SegmentParams::default(); if let Ok(v) = std::env::var("SM") { segment.smoothing_px = v.parse().unwrap(); }
    let d = |v: &str, real: bool| if real { let r = data.join("real/knee-implant-biplane"); ViewFiles { name: v.into(), calibration: r.join(format!("cam{}.mayacam2.txt", if v=="A" {1} else {2})), distortion: None, frames: r.join(format!("cam{}", if v=="A" {1} else {2})), extension: "tif".into() } }
      else { let r = data.join("simulated/knee-implant"); ViewFiles { name: v.into(), calibration: r.join("truth/truth.json"), distortion: Some(r.join(format!("truth/distortion_{v}.csv"))), frames: r.join("frames").join(v), extension: "png".into() } };
    let (real, origin, mesh, reference) = match which.as_str() {
        "real" => (true, PixelOrigin::Corner, data.join("real/knee-implant-biplane/femur0.stl"), data.join("real/knee-implant-biplane/reference_femur_world_from_model.csv")),
        "realc" => (true, PixelOrigin::Centre, data.join("real/knee-implant-biplane/femur0.stl"), data.join("real/knee-implant-biplane/reference_femur_world_from_model.csv")),
        "femur" => (false, PixelOrigin::Centre, data.join("simulated/knee-implant/models/femoral_component_15000.stl"), data.join("simulated/knee-implant/truth/femoral_component_world_from_model.csv")),
        _ => (false, PixelOrigin::Centre, data.join("simulated/knee-implant/models/tray_15000.stl"), data.join("simulated/knee-implant/truth/tray_world_from_model.csv")),
    };
    let scene = Scene::load(&SceneFiles { views: vec![d("A", real), d("B", real)], pixel_origin: origin, mesh, reference }, &segment).unwrap();
    let mut o = Outline::new();
    for (label, pose, views) in &scene.frames { let pose = &if std::env::var("FIT").is_ok() { biplane_geometry::Pose::from(biplane_optimisation::match_body(&scene.rim, views, &scene.names, pose, &Default::default(), || false).unwrap().pose) } else { *pose }; for (i, v) in views.iter().enumerate() {
        o.trace(&scene.rim, pose, &v.fluoroscope, Sampling { step_px: 1.0 });
        let mut r = vec![];
        for p in o.points() { if let Some(e) = v.edges.nearest(&p.pixel, &p.normal, 6.0, 0.9) { r.push((e.direction.dot(&(e.position - p.pixel)), p.normal, p.length_px, p.pixel)); } }
        let w: f64 = r.iter().map(|x| x.2).sum();
        // fit e = a + b nx + c ny
        let mut m = nalgebra::Matrix3::zeros(); let mut y = nalgebra::Vector3::zeros();
        for x in &r { let a = nalgebra::Vector3::new(1.0, x.1.x, x.1.y); m += a*a.transpose()*x.2; y += a*x.0*x.2; }
        let s = m.try_inverse().unwrap()*y;
        let mut med: Vec<f64> = r.iter().map(|x| x.0).collect(); med.sort_by(f64::total_cmp);
        println!("{label} view {i}: outline {:.0} matched {:.0}  mean {:+.3} median {:+.3} fit const {:+.3} x {:+.3} y {:+.3} rms {:.3}", o.length_px(), w, r.iter().map(|x| x.0*x.2).sum::<f64>()/w, med[med.len()/2], s[0], s[1], s[2], (r.iter().map(|x| x.0*x.0*x.2).sum::<f64>()/w).sqrt());
        if std::env::var("D").is_ok_and(|v| v == format!("{label}{i}")) { for x in &r { println!("R {:.2} {:.2} {:.3} {:.3} {:.3} {:.3}", x.3.x, x.3.y, x.1.x, x.1.y, x.0, x.2); } }
    } }
}
