//! How long the spots of a picture take on one core: 1024 x 1024, a plate of 721 holes and a frame of 30 beads.
//! `cargo bench -p biplane-spots` prints it.

use std::time::Instant;

use biplane_artifact::Frame;
use biplane_phantom::{
    BeadFrame, BeadLayout, Exposure, IntensifierDistortion, Plate, PlatePlacement, PosedBody, Scene, biplane,
    picture,
};
use biplane_spots::{Look, SpotParams, SpotSettings, find_spots};

/// Its name, the picture, and what is looked for in it.
type Case = (&'static str, Frame, Look);

fn pictures() -> Result<[Case; 2], Box<dyn std::error::Error>> {
    let views = biplane(90.0);
    let view = &views[0];
    let distortion = IntensifierDistortion {
        pincushion_px: 12.0,
        s_shape_px: 6.0,
        ..IntensifierDistortion::none(view.size)
    };
    let exposure = Exposure { distortion: Some(distortion), brightness: 0.8, ..Exposure::fluoroscopy() };
    let plate =
        PosedBody::at_rest(PlatePlacement::on_detector().pose(view), Plate::concentric().absorbers()?);
    let plate = Scene { bodies: vec![plate], ..Scene::default() };
    let beads = BeadFrame::drawn(&BeadLayout::large(), &views, 1)?.scene();
    Ok([
        ("plate", picture(&plate, view, &exposure, 1)?, Look::Bright),
        ("beads", picture(&beads, view, &exposure, 1)?, Look::Dark),
    ])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (name, frame, look) in pictures()? {
        let params = SpotParams { look, settings: SpotSettings::default() };
        let (mut least, mut count) = (f64::INFINITY, 0);
        for _ in 0..9 {
            let start = Instant::now();
            count = find_spots(&frame, &params)?.spots.len();
            least = least.min(start.elapsed().as_secs_f64());
        }
        println!("{name}: {count} spots, {:.1} ms, the least of nine", 1e3 * least);
    }
    Ok(())
}
