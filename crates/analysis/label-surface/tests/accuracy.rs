//! Bodies of the phantom as maps of labels, and how far the surfaces made of them are from the bodies themselves.
//!
//! A voxel has the label if its centre is inside. `cargo test -p biplane-label-surface --test accuracy -- --nocapture` shows the figures.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::time::Instant;

use biplane_artifact::Volume;
use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_label_surface::{LabelSurfaceParams, label_surface};
use biplane_phantom::{Ball, Body, Solid, gradient};
use biplane_stage::Context;
use biplane_surface::{MeshCheck, Spread, spread_points};
use nalgebra::Rotation3;

/// A volume around a solid, turned against it, with label 7 where voxels' centres are inside.
fn rasterised(
    solid: &dyn Solid,
    voxel: [f64; 3],
    turn: Vector3,
    heights: impl Fn(usize) -> f64,
) -> (Volume, Rotation3<f64>) {
    let rotation = Rotation3::from_scaled_axis(turn);
    let (low, high) = solid.bounds();
    let half = (high - low).norm() / 2.0 + 4.0;
    let middle = nalgebra::center(&low, &high);
    let [u, v, w] = [0, 1, 2].map(|a| rotation * Vector3::ith(a, 1.0));
    let count = voxel.map(|s| (2.0 * half / s).ceil() as usize);
    let first = rotation * middle - (u + v + w) * half;
    let origins: Vec<Point3> = (0..count[2]).map(|k| first + w * heights(k)).collect();
    let mut samples = Vec::new();
    for origin in &origins {
        for j in 0..count[1] {
            samples.extend((0..count[0]).map(|i| {
                let at = origin + u * (i as f64 * voxel[0]) + v * (j as f64 * voxel[1]);
                if solid.value(&(rotation.inverse() * at)) < 0.0 { 7.0 } else { 0.0 }
            }));
        }
    }
    let volume = Volume {
        columns: count[0],
        rows: count[1],
        column_step_mm: (u * voxel[0]).into(),
        row_step_mm: (v * voxel[1]).into(),
        origins_mm: origins.iter().map(|o| o.coords.into()).collect(),
        samples,
    };
    (volume, rotation)
}

/// Distances of points of a mesh from the solid's surface, to first order, mm.
fn off(mesh: &Mesh, solid: &dyn Solid, rotation: &Rotation3<f64>) -> Spread {
    let distance = |p: &Point3| {
        let p = rotation.inverse() * p;
        (solid.value(&p) / gradient(solid, &p).norm().max(0.1)).abs()
    };
    Spread::of(&spread_points(mesh, 40_000).iter().map(distance).collect::<Vec<f64>>())
}

#[test]
fn probe() {
    let env = |n: &str, d: f64| std::env::var(n).ok().and_then(|v| v.parse().ok()).unwrap_or(d);
    let ball = Ball { centre: Point3::new(1.0, 2.0, 3.0), radius: 15.0 };
    let solids: [(&str, &dyn Solid); 5] = [
        ("ball", &ball),
        ("femur", Body::DistalFemur.solid()),
        ("tibia", Body::ProximalTibia.solid()),
        ("component", Body::FemoralComponent.solid()),
        ("tray", Body::TibialTray.solid()),
    ];
    for (name, solid) in solids {
        for (voxel, turn) in [
            ([0.4, 0.4, 0.7], Vector3::zeros()),
            ([0.4, 0.4, 0.7], Vector3::new(0.3, -0.5, 0.2)),
            ([0.4, 0.4, 3.0], Vector3::zeros()),
            ([0.4, 0.4, 3.0], Vector3::new(0.3, -0.5, 0.2)),
        ] {
            let (volume, rotation) = rasterised(solid, voxel, turn, |k| k as f64 * voxel[2]);
            let params = LabelSurfaceParams { label: 7, smoothing_mm: env("S", 0.7), ..Default::default() };
            let start = Instant::now();
            let surface = label_surface(&volume, &params, &Context::new()).unwrap();
            let seconds = start.elapsed().as_secs_f64();
            let d = off(&surface.mesh, solid, &rotation);
            let r = &surface.report;
            println!(
                "{name:9} {:.1} {} median {:.3} 95% {:.3} worst {:.3} volume {:+.3}% vertices {} {:.2} s {:?} {:?} {}",
                voxel[2],
                if turn.norm() > 0.0 { "oblique" } else { "straight" },
                d.median,
                d.p95,
                d.worst,
                100.0 * (r.volume_mm3 / r.unsmoothed_volume_mm3 - 1.0),
                surface.mesh.vertices().len(),
                seconds,
                r.faults.iter().take(3).collect::<Vec<_>>(),
                r.warnings,
                MeshCheck::of(&surface.mesh).is_closed_manifold(),
            );
        }
    }
}
