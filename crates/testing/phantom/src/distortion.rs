//! The distortion of an image intensifier, in a laboratory's terms.
//!
//! Electrons that leave the curved input screen land too far out (pincushion, growing with the third power of the
//! distance from the centre), and the earth's magnetic field turns their paths, more the farther out they start, so that
//! a straight line through the centre becomes an S. Both change slowly while the tube warms up or turns in the field.
//!
//! With `q = (ideal - centre) / rim` and `r = |q|`:
//!
//! `recorded = centre + shift + rim (1 + pincushion r^2) turn(s_shape r^2) q`,
//!
//! where `pincushion` and `s_shape` are the shifts at the rim in px over `rim`, and `turn(a)` turns by `2 atan(a / 2)`. So the way from ideal to recorded is a
//! formula, and the way back are Newton steps. **Guaranteed:** the two undo each other to 1e-10 px within twice the
//! rim for shifts of up to a tenth of it. Nothing of the product's code is used.

use biplane_artifact::DistortionTable;
use biplane_geometry::{Point2, Vector2};
use nalgebra::Matrix2;

/// How an intensifier bends its picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntensifierDistortion {
    /// The pixel that distortion is about.
    pub centre: Point2,
    /// Distance from the centre at which the two shifts below are given, px.
    pub rim_px: f64,
    /// How much farther out than ideal a point of the rim is recorded, px; negative is a barrel.
    pub pincushion_px: f64,
    /// How far along the rim a point of it is turned, from x to y, px.
    pub s_shape_px: f64,
    /// Shift of the whole picture, px.
    pub shift_px: Vector2,
    /// How the shift grows, px a frame.
    pub drift_px_per_frame: Vector2,
    /// How the S-shape grows, px at the rim a frame.
    pub s_shape_drift_px_per_frame: f64,
}

impl IntensifierDistortion {
    /// None, about the middle of a picture of `size` pixels, with its rim at half the shorter side.
    pub fn none(size: [usize; 2]) -> Self {
        let [w, h] = size.map(|n| n as f64);
        Self {
            centre: Point2::new((w - 1.0) / 2.0, (h - 1.0) / 2.0),
            rim_px: w.min(h) / 2.0,
            pincushion_px: 0.0,
            s_shape_px: 0.0,
            shift_px: Vector2::zeros(),
            drift_px_per_frame: Vector2::zeros(),
            s_shape_drift_px_per_frame: 0.0,
        }
    }

    /// The distortion of a later frame: what has drifted by then is part of the shift and of the S-shape.
    pub fn at_frame(&self, frame: f64) -> Self {
        Self {
            shift_px: self.shift_px + self.drift_px_per_frame * frame,
            s_shape_px: self.s_shape_px + self.s_shape_drift_px_per_frame * frame,
            drift_px_per_frame: Vector2::zeros(),
            s_shape_drift_px_per_frame: 0.0,
            ..*self
        }
    }

    /// Whether every pixel is recorded where it ideally is.
    pub fn is_none(&self) -> bool {
        self.pincushion_px == 0.0 && self.s_shape_px == 0.0 && self.shift_px == Vector2::zeros()
    }

    /// The recorded pixel of an ideal one, and the derivative.
    fn recorded_with_derivative(&self, ideal: &Point2) -> (Point2, Matrix2<f64>) {
        let (k, s) = (self.pincushion_px / self.rim_px, self.s_shape_px / self.rim_px);
        let q = (ideal - self.centre) / self.rim_px;
        let r2 = q.norm_squared();
        // Sine and cosine of the angle whose half has the tangent t: s r^2 but for its third power over 12.
        let t = s * r2 / 2.0;
        let over = 1.0 / (1.0 + t * t);
        let (sin, cos) = (2.0 * t * over, (1.0 - t * t) * over);
        let turn = Matrix2::new(cos, -sin, sin, cos);
        let turned = turn * q;
        let grown = 1.0 + k * r2;
        let across = Vector2::new(-turned.y, turned.x);
        let by_r2 = turned * k + across * (grown * s * over);
        let derivative = turn * grown + by_r2 * (2.0 * q).transpose();
        (self.centre + self.shift_px + turned * (grown * self.rim_px), derivative)
    }

    /// The recorded pixel of an ideal one.
    pub fn recorded(&self, ideal: &Point2) -> Point2 {
        if self.is_none() { *ideal } else { self.recorded_with_derivative(ideal).0 }
    }

    /// The ideal pixel of a recorded one.
    pub fn ideal(&self, recorded: &Point2) -> Point2 {
        self.ideal_with_derivative(recorded, &(recorded - self.shift_px)).0
    }

    /// The ideal pixel of a recorded one, found from a guess, and the derivative (to 1e-6).
    pub(crate) fn ideal_with_derivative(&self, recorded: &Point2, guess: &Point2) -> (Point2, Matrix2<f64>) {
        if self.is_none() {
            return (*recorded, Matrix2::identity());
        }
        let (mut ideal, mut inverse) = (*guess, Matrix2::identity());
        for _ in 0..40 {
            let (at, derivative) = self.recorded_with_derivative(&ideal);
            inverse = derivative.try_inverse().unwrap_or_else(Matrix2::identity);
            let step = inverse * (recorded - at);
            ideal += step;
            if step.norm() < 1e-6 {
                // Newton squares the error, so what is left is far below 1e-10.
                break;
            }
        }
        (ideal, inverse)
    }

    /// Samples of the map from recorded to ideal pixels every `step_px` over a picture of `size` pixels, reaching at
    /// least to the centres of its last pixels.
    pub fn table(&self, size: [usize; 2], step_px: usize) -> DistortionTable {
        let step = step_px.max(1);
        let count = size.map(|n| n.saturating_sub(1).div_ceil(step) + 1);
        let ideal_px = (0..count[1])
            .flat_map(|j| (0..count[0]).map(move |i| Point2::new((i * step) as f64, (j * step) as f64)))
            .map(|recorded| self.ideal(&recorded).coords.into())
            .collect();
        DistortionTable { first_px: [0.0; 2], step_px: [step as f64; 2], count, ideal_px }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn bent() -> IntensifierDistortion {
        IntensifierDistortion {
            pincushion_px: 30.0,
            s_shape_px: -12.0,
            shift_px: Vector2::new(1.5, -0.7),
            drift_px_per_frame: Vector2::new(0.01, 0.0),
            s_shape_drift_px_per_frame: 0.02,
            ..IntensifierDistortion::none([1024, 1000])
        }
    }

    #[test]
    fn recorded_and_ideal_undo_each_other() {
        for d in [bent(), bent().at_frame(300.0), IntensifierDistortion { pincushion_px: -20.0, ..bent() }] {
            for k in 0..2000 {
                let p = Point2::new(f64::from(k % 50) * 22.0 - 40.0, f64::from(k / 50) * 27.0 - 40.0);
                assert_relative_eq!(d.recorded(&d.ideal(&p)), p, epsilon = 1e-10);
                assert_relative_eq!(d.ideal(&d.recorded(&p)), p, epsilon = 1e-10);
            }
        }
    }

    #[test]
    fn shifts_at_the_rim_are_what_was_asked_for() {
        let none = IntensifierDistortion::none([1024, 1024]);
        let rim = none.centre + Vector2::new(none.rim_px, 0.0);
        let pincushion = IntensifierDistortion { pincushion_px: 9.0, ..none };
        assert_relative_eq!(pincushion.recorded(&rim) - rim, Vector2::new(9.0, 0.0), epsilon = 1e-10);
        // Halfway out the shift is an eighth: it grows with the third power.
        let half = none.centre + Vector2::new(0.0, -none.rim_px / 2.0);
        assert_relative_eq!(
            pincushion.recorded(&half) - half,
            Vector2::new(0.0, -9.0 / 8.0),
            epsilon = 1e-10
        );
        let s = IntensifierDistortion { s_shape_px: 5.0, ..none };
        let shift = s.recorded(&rim) - rim;
        // 5 px along the rim's arc, but for (5 / 512)^2 of it.
        assert_relative_eq!(shift.norm(), 5.0, epsilon = 1e-4);
        assert!(shift.y > 4.99);
        // A line through the centre becomes an S: odd about the centre.
        let other = none.centre - Vector2::new(none.rim_px, 0.0);
        assert_relative_eq!(s.recorded(&other) - other, -shift, epsilon = 1e-10);
    }

    #[test]
    fn drift_is_in_the_shift_of_later_frames() {
        let later = bent().at_frame(100.0);
        assert_relative_eq!(later.shift_px, Vector2::new(2.5, -0.7), epsilon = 1e-12);
        assert_relative_eq!(later.s_shape_px, -10.0, epsilon = 1e-12);
        assert_eq!(later.at_frame(500.0), later);
    }

    #[test]
    fn the_table_covers_the_picture_and_holds_the_map() {
        let d = bent();
        let t = d.table([1024, 1000], 32);
        assert_eq!(t.count, [33, 33]);
        let recorded = Point2::new(5.0 * 32.0, 7.0 * 32.0);
        assert_eq!(t.ideal_px[7 * 33 + 5], <[f64; 2]>::from(d.ideal(&recorded).coords));
    }
}
