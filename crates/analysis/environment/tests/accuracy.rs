//! How far the source is from the truth, against the Cramer-Rao bound of the same scene, and whether the 95 % region holds it.
//!
//! `cargo test -p biplane-environment --test accuracy -- --nocapture` printed, of 500 draws each (bound in brackets): 150 mm midway, along
//! the view 0.443 mm (0.432), across 0.058 mm (0.059), region 94.6 %; 100 mm at 0.7 of the way, 2.681 mm (2.686), 0.170 mm (0.172),
//! 94.8 %. The bound is computed here, by central differences
//! of the phantom's own projection.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

mod scene;

use biplane_environment::{EnvironmentParams, source_region};
use biplane_geometry::{Point3, Vector3};
use biplane_phantom::{BeadLayout, TrueFluoroscope};
use nalgebra::{Matrix3, Rotation3, SMatrix};
use scene::{NOISE_PX, Scene};

/// Covariance of the source from points with noise of `NOISE_PX`, mm^2.
fn cramer_rao(truth: &TrueFluoroscope, scene: &Scene) -> Matrix3<f64> {
    let moved = |k: usize, h: f64| {
        let mut f = truth.clone();
        match k {
            0..3 => f.source[k] += h,
            3..6 => f.centre[k - 3] += h,
            _ => {
                let mut turn = Vector3::zeros();
                turn[k - 6] = h;
                let turn = Rotation3::from_scaled_axis(turn);
                (f.along_x, f.along_y) = (turn * f.along_x, turn * f.along_y);
            }
        }
        f
    };
    let mut information = SMatrix::<f64, 9, 9>::zeros();
    for bead in &scene.list.0 {
        let place = Point3::from(bead.at_mm);
        let by: Vec<_> = (0..9)
            .map(|k| {
                let h = if k < 6 { 1e-2 } else { 1e-5 };
                let at = |h: f64| moved(k, h).project(&place).unwrap().0;
                (at(h) - at(-h)) / (2.0 * h)
            })
            .collect();
        let j = SMatrix::<f64, 2, 9>::from_columns(&by);
        information += j.transpose() * j / (NOISE_PX * NOISE_PX);
    }
    information.try_inverse().unwrap().fixed_view::<3, 3>(0, 0).into_owned()
}

#[test]
fn the_source_is_as_sure_as_it_can_be_and_as_it_says() {
    for (name, layout, share) in
        [("150 mm midway", BeadLayout::large(), 0.5), ("100 mm at 0.7", BeadLayout::small(), 0.7)]
    {
        let (mut along, mut across, mut held, mut count) = ([0.0, 0.0], [0.0, 0.0], 0, 0);
        for frame in 0..25_u64 {
            let exact = Scene::exact(&layout, share, 75.0 + frame as f64, frame);
            let bounds = [0, 1].map(|v| cramer_rao(&exact.fluoroscopes[v], &exact));
            for draw in 0..10_u64 {
                let mut scene = exact.clone();
                scene.add_noise(NOISE_PX, 1000 * frame + draw);
                let found = scene.find(&EnvironmentParams::default()).unwrap();
                for (v, truth) in scene.fluoroscopes.iter().enumerate() {
                    let n = truth.normal();
                    let error = Point3::from(found.views[v].source) - truth.source;
                    along[0] += error.dot(&n).powi(2);
                    along[1] += n.dot(&(bounds[v] * n));
                    across[0] += error.norm_squared() - error.dot(&n).powi(2);
                    across[1] += bounds[v].trace() - n.dot(&(bounds[v] * n));
                    held += usize::from(source_region(&found, v, 0.95).unwrap().holds(&truth.source));
                    count += 1;
                }
            }
        }
        let rms = |s: f64| (s / f64::from(count)).sqrt();
        let share = held as f64 / f64::from(count);
        println!(
            "{name}: source along {:.3} mm (bound {:.3}), across {:.3} mm (bound {:.3}); 95 % region holds {:.1} % of {count}",
            rms(along[0]),
            rms(along[1]),
            rms(across[0]),
            rms(across[1]),
            100.0 * share
        );
        assert!((0.93..=0.97).contains(&share));
        for [found, bound] in [along, across] {
            // Of 500 draws the root mean square has a standard deviation of 3.2 %.
            let ratio = (found / bound).sqrt();
            assert!((0.9..1.1).contains(&ratio), "{ratio}");
        }
    }
}
