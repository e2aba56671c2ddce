//! How long starts without a guess take: `cargo bench -p biplane-silhouette`. Two views of the phantom's bodies, meshes of 15,000
//! points, ideal outlines at poses over all rotations; among other edges: the same with as many more edges of random curves.

use std::time::Instant;

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Point2, Pose, Vector2, Vector3};
use biplane_phantom::{Body, biplane, ideal_outline, mesh};
use biplane_silhouette::SilhouetteLibrary;
use nalgebra::UnitQuaternion;

/// Least and median time of some calls, ms.
fn times(rounds: usize, mut of: impl FnMut(usize)) -> (f64, f64) {
    let mut all: Vec<f64> = (0..rounds)
        .map(|k| {
            let start = Instant::now();
            of(k);
            1e3 * start.elapsed().as_secs_f64()
        })
        .collect();
    all.sort_by(f64::total_cmp);
    (all[0], all[rounds / 2])
}

/// Circles of many sizes all over a picture.
fn circles(count: u32) -> impl Iterator<Item = Curve> {
    (0..count).map(|k| {
        let at = |a: f64, b: f64| (f64::from(k) * a).fract() * b;
        let (middle, radius) =
            (Point2::new(at(0.618_03, 1024.0), at(0.414_21, 1024.0)), 20.0 + at(0.732_05, 300.0));
        let point = |j: u32| {
            let turn = f64::from(j) / radius;
            let direction = Vector2::new(turn.cos(), turn.sin());
            EdgePoint { position: middle + direction * radius, direction, strength: 1.0, sigma_px: 0.1 }
        };
        Curve { points: (0..(4.0 * radius) as u32).map(point).collect(), closed: false }
    })
}

fn main() {
    let views = biplane(90.0);
    let seen_by = views.each_ref().map(|v| Fluoroscope::from(&v.calibration("A")));
    for body in [Body::FemoralComponent, Body::TibialTray, Body::DistalFemur] {
        let Ok(mesh) = mesh(body.solid(), 15_000) else { continue };
        println!("{}, {} points", body.name(), mesh.vertices().len());
        let (least, median) = times(5, |_| {
            std::hint::black_box(SilhouetteLibrary::new(&mesh));
        });
        println!("{median:9.1} ms  preparation (least {least:.1})");
        let library = SilhouetteLibrary::new(&mesh);
        let poses: Vec<[Curves; 2]> = (0..4)
            .map(|k| {
                let turn = UnitQuaternion::from_euler_angles(f64::from(k) * 1.7, f64::from(k) * 0.9, 0.4);
                let pose = Pose::new(turn, turn * -library.centroid().coords + Vector3::new(5.0, -8.0, 3.0));
                views.each_ref().map(|v| Curves(ideal_outline(body.solid(), &pose, v, 0.5)))
            })
            .collect();
        let all = |curves: &[Curves; 2], contrast: f64, alone: bool| {
            let seen = [(&seen_by[0], &curves[0]), (&seen_by[1], &curves[1])];
            let found = if alone {
                library.isolated(&seen, contrast, 20)
            } else {
                library.among(&seen, contrast, 20)
            };
            std::hint::black_box(found);
        };
        let (least, median) = times(40, |k| all(&poses[k % 4], 1.0, true));
        println!("{median:9.1} ms  20 candidates, the body alone (least {least:.1})");
        let crowded: Vec<[Curves; 2]> = poses
            .into_iter()
            .map(|pair| pair.map(|c| Curves(c.0.into_iter().chain(circles(60)).collect())))
            .collect();
        let edges: usize = crowded[0].iter().map(Curves::point_count).sum();
        let (least, median) = times(8, |k| all(&crowded[k % 4], 1.0, false));
        println!("{median:9.1} ms  20 candidates among {edges} edge points (least {least:.1})");
    }
}
