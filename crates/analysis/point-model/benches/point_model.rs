//! How long a point model takes, and which of two gives the better outline: `cargo bench -p biplane-point-model`. Times for 15,000
//! points from 70,000 triangles, as shares of their limit. Then, over 200 views at random, how far the outline of a model lies from that
//! of the mesh that it was made of, mm in the body's plane.

use std::time::Instant;

use biplane_artifact::Calibration;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_phantom::{Body, mesh};
use biplane_point_model::{Deviation, Evenness, even_points, laid_out, simplified};
use biplane_surface::{Spread, Surface};
use nalgebra::{Quaternion, UnitQuaternion};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Views of each body.
const VIEWS: usize = 200;

fn seconds<T>(of: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = of();
    (result, start.elapsed().as_secs_f64())
}

/// A source 1 m away from a plane through the body, 1 px to the millimetre there.
fn view() -> Fluoroscope {
    Fluoroscope::from(&Calibration {
        view: "A".to_owned(),
        size: [400, 400],
        source: [0.0, 0.0, -1000.0],
        matrix: [[1000.0, 0.0, 200.0], [0.0, 1000.0, 200.0], [0.0, 0.0, 1.0]],
        distortion: None,
    })
}

fn poses(about: &Point3) -> Vec<Pose> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut turns = Vec::new();
    while turns.len() < VIEWS {
        let [a, b, c, d] = [0; 4].map(|_| random.random_range(-1.0..1.0_f64));
        let q = Quaternion::new(a, b, c, d);
        if (0.01..1.0).contains(&q.norm_squared()) {
            let turn = UnitQuaternion::from_quaternion(q);
            turns.push(Pose::new(turn, -(turn * about.coords)));
        }
    }
    turns
}

/// Distances of the points of a model's outline from the outline of the original, all views together.
fn outline_errors(model: &Mesh, original: &Mesh) -> Spread {
    let (rim, true_rim) = (RimMesh::new(model), RimMesh::new(original));
    let (view, sampling) = (view(), Sampling { step_px: 0.5 });
    let (mut outline, mut truth) = (Outline::new(), Outline::new());
    let mut errors = Vec::new();
    for pose in poses(&original.area_centroid()) {
        outline.trace(&rim, &pose, &view, sampling);
        truth.trace(&true_rim, &pose, &view, sampling);
        let mut ends = Vec::with_capacity(2 * truth.points().len());
        for p in truth.points() {
            let half = Vector3::new(-p.normal.y, p.normal.x, 0.0) * (p.length_px / 2.0);
            let at = Point3::new(p.pixel.x, p.pixel.y, 0.0);
            ends.extend([at - half, at + half]);
        }
        let sides: Vec<[u32; 2]> = (0..truth.points().len() as u32).map(|k| [2 * k, 2 * k + 1]).collect();
        let Some(lines) = Surface::of_segments(&ends, &sides) else { continue };
        let off = |p: &biplane_outline::OutlinePoint| {
            lines.closest(&Point3::new(p.pixel.x, p.pixel.y, 0.0)).distance_mm
        };
        errors.extend(outline.points().iter().map(off));
    }
    Spread::of(&errors)
}

fn main() {
    println!(
        "            body     method  points      s of 1 s  edges  areas  1% angle    bound mm  outline rms, worst mm"
    );
    for body in [Body::FemoralComponent, Body::TibialTray, Body::DistalFemur, Body::ProximalTibia] {
        let Ok(original) = mesh(body.solid(), 35_000) else { continue };
        for points in [3_500, 15_000] {
            let even = seconds(|| even_points(&original, points, 40.0).ok().and_then(|m| laid_out(&m).ok()));
            let simple = seconds(|| simplified(&original, points, 40.0).ok().and_then(|m| laid_out(&m).ok()));
            for (method, (model, time)) in [("even", even), ("simplified", simple)] {
                let Some(model) = model else { continue };
                let evenness = Evenness::of(&model);
                let bound = Deviation::between(&model, &original, 1e-3).silhouette_mm();
                let errors = outline_errors(&model, &original);
                println!(
                    "{:>17} {method:>10} {points:>6}  {time:10.2}  {:7.3} {:6.3} {:8.1}  {bound:10.3} {:12.4} {:8.3}",
                    body.name(),
                    evenness.edge_variation,
                    evenness.area_variation,
                    evenness.one_percent_angle_deg,
                    errors.rms,
                    errors.worst
                );
            }
        }
    }
}
