//! Moments of a surface over its area, exact for flat triangles.

use biplane_geometry::Vector3;
use nalgebra::{Matrix3, SymmetricEigen};

/// A surface's centroid and principal axes.
pub(crate) struct Moments {
    pub centroid: Vector3,
    /// Columns are the principal axes, right-handed: the longest spread first.
    pub axes: Matrix3<f64>,
    /// Standard deviations along them, mm.
    pub spread: [f64; 3],
    /// Third moments along them over the cubes of the spreads; their signs are not negative for the first two.
    pub skew: [f64; 3],
}

/// Moments of triangles. The first two axes point to the side of the longer tail (positive third moment), the third follows.
pub(crate) fn moments(vertices: &[Vector3], triangles: &[[u32; 3]]) -> Moments {
    let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
    let mut area = 0.0;
    let mut sum = Vector3::zeros();
    for t in triangles {
        let [a, b, c] = corners(t);
        let w = (b - a).cross(&(c - a)).norm() / 2.0;
        area += w;
        sum += (a + b + c) * (w / 3.0);
    }
    let centroid = sum / area;
    let mut second = Matrix3::zeros();
    for t in triangles {
        let [a, b, c] = corners(t).map(|v| v - centroid);
        let w = (b - a).cross(&(c - a)).norm() / 2.0;
        let s = a + b + c;
        second +=
            (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose()) * (w / 12.0);
    }
    let eigen = SymmetricEigen::new(second / area);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    let spread = order.map(|i| eigen.eigenvalues[i].max(0.0).sqrt());
    let mut axes = order.map(|i| Vector3::from(eigen.eigenvectors.column(i)));
    let mut skew = [0, 1, 2].map(|i| {
        let third = triangles.iter().map(|t| {
            let corners = corners(t).map(|v| v - centroid);
            let w = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm() / 2.0;
            let [a, b, c] = corners.map(|v| v.dot(&axes[i]));
            // The complete homogeneous polynomial of degree 3 over its ten terms is the mean of the cube.
            w * (a * a * a
                + b * b * b
                + c * c * c
                + a * b * c
                + a * a * (b + c)
                + b * b * (a + c)
                + c * c * (a + b))
                / 10.0
        });
        third.sum::<f64>() / area / spread[i].powi(3).max(f64::MIN_POSITIVE)
    });
    for i in 0..2 {
        if skew[i] < 0.0 {
            axes[i] = -axes[i];
            skew[i] = -skew[i];
        }
    }
    let third = axes[0].cross(&axes[1]);
    if third.dot(&axes[2]) < 0.0 {
        skew[2] = -skew[2];
    }
    axes[2] = third;
    Moments { centroid, axes: Matrix3::from_columns(&axes), spread, skew }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_right_triangle_by_hand() {
        // Corners (0,0), (6,0), (0,3): variances 36/18 and 9/18, covariance -18/36; third central moment along x a^3/135.
        let v = [Vector3::zeros(), Vector3::new(6.0, 0.0, 0.0), Vector3::new(0.0, 3.0, 0.0)];
        let m = moments(&v, &[[0, 1, 2]]);
        assert!((m.centroid - Vector3::new(2.0, 1.0, 0.0)).norm() < 1e-12);
        let total: f64 = m.spread.iter().map(|s| s * s).sum();
        assert!((total - 2.5).abs() < 1e-12, "{:?}", m.spread);
        assert!(m.spread[2] < 1e-6 && (m.axes.determinant() - 1.0).abs() < 1e-9);
        let flat = [Vector3::zeros(), Vector3::new(6.0, 0.0, 0.0), Vector3::new(3.0, 0.0, 1e-9)];
        let thin = moments(&flat, &[[0, 1, 2]]);
        assert!(thin.skew[0].abs() < 1e-9, "symmetric along x: {:?}", thin.skew);
        assert!(m.skew[0] > 0.1 && m.axes[(0, 0)] > 0.9, "the tail is at the sharp corner: {:?}", m.skew);
    }
}
