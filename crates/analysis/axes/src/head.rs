//! The femoral head: a sphere at the proximal end, far to the side of the shaft.

use biplane_geometry::Vector3;
use nalgebra::{Matrix4, Vector4};

use crate::shape::Shape;

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
    let (mut scale, mut rms) = (2.0_f64, f64::INFINITY);
    for _ in 0..60 {
        let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
        let (mut total, mut squares) = (0.0, 0.0);
        for s in &block {
            let d = s.at - centre;
            let far = d.norm();
            let (e, r) = (d / far.max(1e-9), far - radius);
            let u = r / (4.7 * scale);
            if u.abs() >= 1.0 || s.normal.dot(&e) < 0.7 {
                continue;
            }
            let w = s.area * (1.0 - u * u).powi(2);
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
        scale = (0.7 * scale).max((1.2 * rms).max(0.2));
        if step.norm() < 1e-10 {
            break;
        }
    }
    ((15.0..35.0).contains(&radius) && rms < 1.5).then_some(Head { centre, radius })
}
