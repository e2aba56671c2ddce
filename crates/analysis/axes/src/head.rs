//! The femoral head: a sphere at the proximal end, far to the side of the shaft.

use biplane_geometry::Vector3;
use nalgebra::{Matrix4, Vector4};

use crate::shape::Shape;

/// What is farther from the sphere than this is no part of it.
const NEAR_MM: f64 = 4.0;

/// A sphere.
#[derive(Debug, Clone)]
pub(crate) struct Head {
    pub centre: Vector3,
    pub radius: f64,
}

/// Looks for the head among what is above `floor` along `up`, on the side of the place that is farthest from the shaft's line. None where
/// no sphere of 15 to 35 mm fits.
pub(crate) fn fit(shape: &Shape, up: &Vector3, on_shaft: &Vector3, floor: f64) -> Option<Head> {
    let block: Vec<_> = shape.samples.iter().filter(|s| s.at.dot(up) > floor).collect();
    let aside = |v: &Vector3| {
        let d = v - on_shaft;
        d - up * d.dot(up)
    };
    let outmost =
        block.iter().max_by(|a, b| aside(&a.at).norm_squared().total_cmp(&aside(&b.at).norm_squared()))?;
    let out = aside(&outmost.at).try_normalize(1e-6)?;
    let facing = (out + up).normalize();
    let reach = aside(&outmost.at).dot(&out);
    // p = c + r n over what faces up and out, within 30 mm of the outmost place.
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for s in &block {
        if s.normal.dot(&facing) < 0.5 || aside(&s.at).dot(&out) < reach - 30.0 {
            continue;
        }
        let (p, n, w) = (s.at, s.normal, s.area);
        for k in 0..3 {
            let mut j = Vector4::zeros();
            j[k] = 1.0;
            j[3] = n[k];
            normal += j * j.transpose() * w;
            right += j * (p[k] * w);
        }
    }
    let first = normal.lu().solve(&right)?;
    let (mut centre, mut radius) = (first.xyz(), first.w);
    let mut rms = f64::INFINITY;
    for _ in 0..60 {
        let mut near: Vec<(f64, f64, Vector3)> = Vec::new();
        for s in &block {
            let d = s.at - centre;
            let far = d.norm();
            let (e, r) = (d / far.max(1e-9), far - radius);
            // The neck and the pit of the ligament face another way.
            if r.abs() < NEAR_MM && s.normal.dot(&e) > 0.9 {
                near.push((r, s.area, e));
            }
        }
        near.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let half = near.iter().map(|(_, area, _)| area).sum::<f64>() / 2.0;
        let mut sum = 0.0;
        let median = near.iter().find(|(_, area, _)| {
            sum += area;
            sum >= half
        });
        let scale = (1.4826 * median.map_or(0.0, |(r, ..)| r.abs())).clamp(0.1, 1.0);
        let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
        let (mut total, mut squares) = (0.0, 0.0);
        for (r, area, e) in &near {
            let u = (r / (4.7 * scale)).clamp(-1.0, 1.0);
            let w = area * (1.0 - u * u).powi(2);
            let j = Vector4::new(-e.x, -e.y, -e.z, -1.0);
            normal += j * j.transpose() * w;
            right -= j * (r * w);
            total += w;
            squares += w * r * r;
        }
        let step = normal.cholesky()?.solve(&right);
        centre += step.xyz();
        radius += step.w;
        rms = (squares / total).sqrt();
        if step.norm() < 1e-10 {
            break;
        }
    }
    ((15.0..35.0).contains(&radius) && rms < 1.5).then_some(Head { centre, radius })
}
