//! Ideal outlines for sections that need thousands: traced on a lattice of three pixels, each point then as exact as any.
//!
//! `ideal_outline` spends most of its time on finding where the outline passes, pixel by pixel. A fluoroscope with pixels three times as
//! wide has a ninth of them; points that it puts on the same shadow are brought onto it by the same Newton steps. **Not guaranteed:**
//! holes, pieces and necks narrower than three pixels, half a millimetre at the body.

use biplane_geometry::{Curve, EdgePoint, Point2, Pose};
use biplane_phantom::{Body, TrueFluoroscope, ideal_outline};
use rayon::prelude::*;

use crate::knee::Posture;
use crate::lab::Frames;

/// Width of the lattice, px.
const LATTICE: f64 = 3.0;
/// Distance of the points of outlines, px.
const STEP_PX: f64 = 1.0;

/// As `ideal_outline`, in the pixels of `view`.
pub fn outline(body: Body, pose: &Pose, view: &TrueFluoroscope, step_px: f64) -> Vec<Curve> {
    let coarse = TrueFluoroscope { pixel_mm: LATTICE * view.pixel_mm, ..view.clone() };
    // Both count from the same middle.
    let [mx, my] = view.size.map(|n| (n as f64 - 1.0) / 2.0);
    let fine = |p: Point2| Point2::new(mx + LATTICE * (p.x - mx), my + LATTICE * (p.y - my));
    let mut curves = ideal_outline(body.solid(), pose, &coarse, step_px / LATTICE);
    for point in curves.iter_mut().flat_map(|c| &mut c.points) {
        *point = EdgePoint { position: fine(point.position), ..*point };
    }
    curves
}

/// Frames of a body in `count` random postures of a seed.
pub fn frames(body: Body, views: &[TrueFluoroscope], seed: u64, count: usize) -> Frames {
    (0..count)
        .into_par_iter()
        .map(|k| {
            let pose = Posture::random(seed, k).pose(body);
            let seen = |view| biplane_artifact::Curves(outline(body, &pose, view, STEP_PX));
            (k.to_string(), pose, views.iter().map(seen).collect())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::true_outline::TrueOutline;
    use biplane_phantom::biplane;

    #[test]
    fn it_is_the_outline_that_the_pixels_give() {
        let views = biplane(90.0);
        for (number, body) in
            [Body::FemoralComponent, Body::TibialTray, Body::ProximalTibia].iter().enumerate()
        {
            let pose = Posture::random(3, number).pose(*body);
            for view in &views {
                let exact = ideal_outline(body.solid(), &pose, view, 0.25);
                let found = outline(*body, &pose, view, STEP_PX);
                let length = |curves: &[Curve], step: f64| {
                    step * curves.iter().map(|c| c.points.len()).sum::<usize>() as f64
                };
                // A piece that takes less than 6 px of outline is no longer than the lattice is wide.
                let wide = exact.iter().filter(|c| c.points.len() > 24).count();
                assert!((wide..=exact.len()).contains(&found.len()));
                let ratio = length(&found, STEP_PX) / length(&exact, 0.25);
                // A coarser polygon is shorter, so its points stand a little wider.
                assert!((0.97..1.01).contains(&ratio), "{body:?}: {ratio}");
                let exact = TrueOutline::new(exact);
                let worst = found
                    .iter()
                    .flat_map(|c| &c.points)
                    .map(|p| exact.outside_px(&p.position, 1.0).map_or(f64::INFINITY, f64::abs));
                // What a nearest point 0.125 px away says of a curved line.
                assert!(worst.fold(0.0, f64::max) < 0.02);
            }
        }
    }
}
