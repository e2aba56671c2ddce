//! The map between recorded and ideal pixels, from samples on a regular grid.
//!
//! Between samples the map is bicubic (Catmull-Rom, with the border samples continued on a straight line), so it is
//! smooth and passes through every sample; beyond the grid it goes on linearly. The inverse is found by Newton steps.

use biplane_artifact::DistortionTable;
use biplane_geometry::{Curve, EdgePoint, Point2, Vector2};
use nalgebra::Matrix2;

/// Recorded to ideal pixels and back.
#[derive(Debug, Clone)]
pub struct Distortion {
    table: DistortionTable,
}

impl From<&DistortionTable> for Distortion {
    fn from(table: &DistortionTable) -> Self {
        Self { table: table.clone() }
    }
}

/// Catmull-Rom weights of four neighbours at `t` in 0..1, and their derivatives by `t`.
fn weights(t: f64) -> ([f64; 4], [f64; 4]) {
    let (t2, t3) = (t * t, t * t * t);
    (
        [
            (-t3 + 2.0 * t2 - t) / 2.0,
            (3.0 * t3 - 5.0 * t2 + 2.0) / 2.0,
            (-3.0 * t3 + 4.0 * t2 + t) / 2.0,
            (t3 - t2) / 2.0,
        ],
        [
            (-3.0 * t2 + 4.0 * t - 1.0) / 2.0,
            (9.0 * t2 - 10.0 * t) / 2.0,
            (-9.0 * t2 + 8.0 * t + 1.0) / 2.0,
            (3.0 * t2 - 2.0 * t) / 2.0,
        ],
    )
}

impl Distortion {
    /// A sample, continued on a straight line beyond the grid by one step.
    fn sample(&self, i: isize, j: isize) -> Vector2 {
        let [nx, ny] = self.table.count;
        let at = |i: usize, j: usize| Vector2::from(self.table.ideal_px[j * nx + i]);
        let row = |j: usize| {
            if i < 0 {
                at(0, j) * 2.0 - at(1.min(nx - 1), j)
            } else if i as usize >= nx {
                at(nx - 1, j) * 2.0 - at(nx.saturating_sub(2), j)
            } else {
                at(i as usize, j)
            }
        };
        if j < 0 {
            row(0) * 2.0 - row(1.min(ny - 1))
        } else if j as usize >= ny {
            row(ny - 1) * 2.0 - row(ny.saturating_sub(2))
        } else {
            row(j as usize)
        }
    }

    /// The ideal pixel of a recorded one, and the derivative.
    pub fn ideal_with_derivative(&self, recorded: &Point2) -> (Point2, Matrix2<f64>) {
        let t = &self.table;
        let cell = |axis: usize| {
            let last = t.count[axis] as f64 - 1.0;
            let g = (recorded[axis] - t.first_px[axis]) / t.step_px[axis];
            let inside = g.clamp(0.0, last.max(0.0));
            let base = inside.floor().min((last - 1.0).max(0.0));
            (base as isize, inside - base, g - inside)
        };
        let ((i, tx, over_x), (j, ty, over_y)) = (cell(0), cell(1));
        let ((wx, dx), (wy, dy)) = (weights(tx), weights(ty));
        let (mut value, mut by_x, mut by_y) = (Vector2::zeros(), Vector2::zeros(), Vector2::zeros());
        for (b, (wb, db)) in wy.iter().zip(&dy).enumerate() {
            for (a, (wa, da)) in wx.iter().zip(&dx).enumerate() {
                let s = self.sample(i + a as isize - 1, j + b as isize - 1);
                value += s * (wa * wb);
                by_x += s * (da * wb);
                by_y += s * (wa * db);
            }
        }
        value += by_x * over_x + by_y * over_y;
        (Point2::from(value), Matrix2::from_columns(&[by_x / t.step_px[0], by_y / t.step_px[1]]))
    }

    /// The ideal pixel of a recorded one.
    pub fn ideal(&self, recorded: &Point2) -> Point2 {
        self.ideal_with_derivative(recorded).0
    }

    /// The recorded pixel of an ideal one; `None` where the map cannot be undone (far outside the grid).
    pub fn recorded(&self, ideal: &Point2) -> Option<Point2> {
        let mut p = *ideal;
        for _ in 0..30 {
            let (at, derivative) = self.ideal_with_derivative(&p);
            let error = ideal - at;
            if error.norm() < 1e-10 {
                return Some(p);
            }
            p += derivative.try_inverse()? * error;
        }
        // Rounding may keep the last steps from the strict bound above.
        ((ideal - self.ideal(&p)).norm() < 1e-9).then_some(p)
    }

    /// A curve of recorded pixels in ideal pixels: positions, directions across the edge and standard deviations.
    pub fn correct(&self, curve: &Curve) -> Curve {
        let points = curve
            .points
            .iter()
            .map(|p| {
                let (position, derivative) = self.ideal_with_derivative(&p.position);
                // A gradient is carried by the inverse transpose; distances along it stretch by its length's inverse.
                let gradient = derivative.try_inverse().map_or(p.direction, |i| i.transpose() * p.direction);
                let stretch = gradient.norm().max(1e-9);
                EdgePoint {
                    position,
                    direction: gradient / stretch,
                    strength: p.strength * stretch,
                    sigma_px: p.sigma_px / stretch,
                }
            })
            .collect();
        Curve { points, closed: curve.closed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pincushion and S-shape of a few pixels, as an intensifier has.
    fn truth(p: &Point2) -> Point2 {
        let d = (p - Point2::new(512.0, 512.0)) / 512.0;
        let r2 = d.norm_squared();
        let s = Vector2::new(-d.y, d.x) * (6.0 * r2);
        p + d * (-10.0 * r2) + s
    }

    fn table() -> DistortionTable {
        let (first_px, step_px, count) = ([40.0, 40.0], [24.0, 24.0], [40, 40]);
        let ideal_px = (0..count[1])
            .flat_map(|j| (0..count[0]).map(move |i| (i, j)))
            .map(|(i, j)| truth(&Point2::new(40.0 + 24.0 * i as f64, 40.0 + 24.0 * j as f64)).into())
            .collect();
        DistortionTable { first_px, step_px, count, ideal_px }
    }

    #[test]
    fn follows_the_true_map_between_samples_and_back() {
        let d = Distortion::from(&table());
        let mut worst: f64 = 0.0;
        for k in 0..2000 {
            let p = Point2::new(41.0 + (k * 37 % 930) as f64 + 0.31, 41.0 + (k * 53 % 930) as f64 + 0.77);
            let (ideal, derivative) = d.ideal_with_derivative(&p);
            worst = worst.max((ideal - truth(&p)).norm());
            assert!((d.recorded(&ideal).unwrap() - p).norm() < 1e-8);
            let h = 1e-4;
            let numeric =
                (d.ideal(&(p + Vector2::new(h, 0.0))) - d.ideal(&(p - Vector2::new(h, 0.0)))) / (2.0 * h);
            assert!((numeric - derivative.column(0)).norm() < 1e-6);
        }
        // Third differences of this cubic map over 24 px at the grid's border, where samples are continued straight.
        assert!(worst < 0.02, "worst {worst} px");
        // Beyond the grid it goes on smoothly.
        let outside = Point2::new(20.0, 1010.0);
        assert!((d.ideal(&outside) - truth(&outside)).norm() < 0.5);
    }
}
