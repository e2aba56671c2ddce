//! The direct linear transformation: a view from six or more labelled beads, without a guess.
//!
//! Abdel-Aziz and Karara 1971, with Hartley's scaling (1997). The 3x4 matrix is split into `K [R | t]`; the model of this crate
//! has square pixels of a held size and no skew, so of `K` the focal lengths' geometric mean and the principal point are kept.

use biplane_geometry::{Point2, Point3, Vector2, Vector3};
use nalgebra::{Matrix3, Matrix3x4, Rotation3, SMatrix, SVector};

use crate::view::View;

/// A view from places and pixels; none with fewer than six, or where they do not decide it (all in a plane).
pub(crate) fn direct_linear(pairs: &[(Point3, Point2)], pixel_mm: f64, middle: Point2) -> Option<View> {
    if pairs.len() < 6 {
        return None;
    }
    let n = pairs.len() as f64;
    let mean = pairs.iter().map(|(p, _)| p.coords).sum::<Vector3>() / n;
    let mean_px = pairs.iter().map(|(_, q)| q.coords).sum::<Vector2>() / n;
    let spread = (pairs.iter().map(|(p, _)| (p.coords - mean).norm_squared()).sum::<f64>() / n).sqrt();
    let spread_px = (pairs.iter().map(|(_, q)| (q.coords - mean_px).norm_squared()).sum::<f64>() / n).sqrt();
    if !(spread > 0.0 && spread_px > 0.0) {
        return None;
    }
    let mut normal = SMatrix::<f64, 12, 12>::zeros();
    for (place, pixel) in pairs {
        let x = ((place.coords - mean) / spread).push(1.0);
        let u = (pixel.coords - mean_px) / spread_px;
        for (row, value) in [(0, u.x), (4, u.y)] {
            let mut equation = SVector::<f64, 12>::zeros();
            equation.fixed_rows_mut::<4>(row).copy_from(&x);
            equation.fixed_rows_mut::<4>(8).copy_from(&(-x * value));
            normal += equation * equation.transpose();
        }
    }
    let eigen = normal.symmetric_eigen();
    let order = eigen.eigenvalues.as_slice();
    let least = (0..12).min_by(|&a, &b| order[a].total_cmp(&order[b]))?;
    let p = eigen.eigenvectors.column(least);
    let scaled = Matrix3x4::from_row_slice(p.as_slice());
    let to_pixels = Matrix3::new(spread_px, 0.0, mean_px.x, 0.0, spread_px, mean_px.y, 0.0, 0.0, 1.0);
    let mut m: Matrix3<f64> = to_pixels * scaled.fixed_columns::<3>(0) / spread;
    let mut last: Vector3 = to_pixels * scaled.column(3) - m * mean;
    // The sign of the whole is free: depths are positive.
    let depth = pairs.iter().map(|(p, _)| m.row(2).transpose().dot(&p.coords) + last.z).sum::<f64>();
    if depth < 0.0 {
        m = -m;
        last = -last;
    }
    let source = Point3::from(-(m.try_inverse()? * last));
    let norm = m.row(2).norm();
    if norm.is_nan() || norm <= 0.0 {
        return None;
    }
    m /= norm;
    let (row_x, row_y, normal) = (m.row(0).transpose(), m.row(1).transpose(), m.row(2).transpose());
    let (px, py) = (row_x.dot(&normal), row_y.dot(&normal));
    let (x, y) = (row_x - normal * px, row_y - normal * py);
    let focal = (x.norm() * y.norm()).sqrt();
    // The two axes with equal shares of what they lack to a right angle; left-handed where the pixels are a mirror image.
    let (ex, ey) = (x.try_normalize(0.0)?, y.try_normalize(0.0)?);
    let (sum, difference) = ((ex + ey).try_normalize(0.0)?, (ex - ey).try_normalize(0.0)?);
    let root = std::f64::consts::FRAC_1_SQRT_2;
    let (ex, ey) = ((sum + difference) * root, (sum - difference) * root);
    if ex.cross(&ey).dot(&normal) < 0.0 {
        return None;
    }
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[ex, ey, ex.cross(&ey)]));
    let centre = source
        + rotation * Vector3::new((middle.x - px) * pixel_mm, (middle.y - py) * pixel_mm, focal * pixel_mm);
    let view = View { source, centre, rotation, pixel_mm, middle };
    let finite = |p: &Point3| p.iter().all(|v| v.is_finite());
    (finite(&source) && finite(&centre) && rotation.matrix().iter().all(|v| v.is_finite())).then_some(view)
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_phantom::biplane;

    #[test]
    fn exact_points_give_the_view_exactly() {
        let [truth, _] = biplane(90.0);
        let pairs: Vec<_> = (0..9)
            .map(|k| {
                let s = f64::from(k);
                let p = Point3::new(60.0 * s.sin(), 50.0 * (2.0 * s).cos(), 40.0 * (3.0 * s).sin());
                (p, truth.project(&p).unwrap().0)
            })
            .collect();
        let view = direct_linear(&pairs, truth.pixel_mm, Point2::new(511.5, 511.5)).unwrap();
        assert!((view.source - truth.source).norm() < 1e-6, "{:?}", view.source);
        assert!((view.centre - truth.centre).norm() < 1e-6, "{:?}", view.centre);
        assert!((view.rotation * Vector3::x() - truth.along_x).norm() < 1e-9);
        let mirrored: Vec<_> = pairs.iter().map(|(p, q)| (*p, Point2::new(1023.0 - q.x, q.y))).collect();
        assert!(direct_linear(&mirrored, truth.pixel_mm, Point2::new(511.5, 511.5)).is_none());
        assert!(direct_linear(&pairs[..5], truth.pixel_mm, Point2::new(511.5, 511.5)).is_none());
    }
}
