//! Signed distances of simple shapes, and smooth ways to join them: what the bodies are modelled from.
//!
//! Every function is negative inside, positive outside, in mm, and changes by at most the distance moved (its Lipschitz
//! constant is 1); joining keeps that. So a body made of them has a value whose size is at most the distance to its
//! surface. The shapes are those of Inigo Quilez, "Distance functions" (iquilezles.org/articles/distfunctions) and the
//! cubic blend is that of "Smooth minimum" there (iquilezles.org/articles/smin).
//!
//! **Not guaranteed:** that the size *is* the distance. It is for the single shapes outside of them, but for
//! [`ellipsoid`]; after joining it is smaller near a blend.

use biplane_geometry::{Point3, Vector3};

/// Length of the hypotenuse, without the care of `f64::hypot` for numbers near the limits of floating point.
pub fn hypotenuse(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// Both shapes, filled at their seam by a blend that begins where they are `blend` mm apart in value. With the cubic
/// blend even the curvature is continuous; two faces at a right angle are rounded by a radius of about half of `blend`.
pub fn union(a: f64, b: f64, blend: f64) -> f64 {
    let h = (blend - (a - b).abs()).max(0.0) / blend;
    a.min(b) - h * h * h * blend / 6.0
}

/// What lies in both shapes, its new edges rounded as in [`union`].
pub fn intersection(a: f64, b: f64, blend: f64) -> f64 {
    -union(-a, -b, blend)
}

/// The first shape without the second, its new edges rounded as in [`union`].
pub fn difference(a: f64, b: f64, blend: f64) -> f64 {
    -union(-a, b, blend)
}

/// A ball.
pub fn ball(p: &Point3, centre: [f64; 3], radius: f64) -> f64 {
    (p - Point3::from(centre)).norm() - radius
}

/// A cylinder with hemispheres at its ends, around the line from `a` to `b`.
pub fn capsule(p: &Point3, a: [f64; 3], b: [f64; 3], radius: f64) -> f64 {
    let (from_a, along) = (p - Point3::from(a), Point3::from(b) - Point3::from(a));
    let s = (from_a.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (from_a - along * s).norm() - radius
}

/// The hull of two balls, `(centre, radius)`; the larger one may not hold the smaller one.
pub fn round_cone(p: &Point3, a: ([f64; 3], f64), b: ([f64; 3], f64)) -> f64 {
    let (from_a, along) = (p - Point3::from(a.0), Point3::from(b.0) - Point3::from(a.0));
    let length = along.norm();
    let axial = from_a.dot(&along) / length;
    let radial = (from_a.norm_squared() - axial * axial).max(0.0).sqrt();
    // The flank leans by this sine.
    let sine = (a.1 - b.1) / length;
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    // Where along the axis a point's foot on the flank begins decides between the two balls and the flank.
    let k = axial * cosine - radial * sine;
    if k < 0.0 {
        hypotenuse(axial, radial) - a.1
    } else if k > length * cosine {
        hypotenuse(axial - length, radial) - b.1
    } else {
        radial * cosine + axial * sine - a.1
    }
}

/// An ellipsoid; its value is the smallest radius times how far out, in radii, a point is.
pub fn ellipsoid(p: &Point3, centre: [f64; 3], radii: [f64; 3]) -> f64 {
    let scaled = (p - Point3::from(centre)).component_div(&Vector3::from(radii));
    (scaled.norm() - 1.0) * radii[0].min(radii[1]).min(radii[2])
}

/// All that lies against `normal` (of any length) of the plane through `on`.
pub fn half_space(p: &Point3, on: [f64; 3], normal: [f64; 3]) -> f64 {
    let n = Vector3::from(normal);
    (p - Point3::from(on)).dot(&n) / n.norm()
}

/// A flat plate: the two-dimensional shape of value `outline`, of half height `half` about height 0, at height `height`;
/// its edges rounded by `radius` (the outline and the height are those with the rounding).
pub fn plate(outline: f64, height: f64, half: f64, radius: f64) -> f64 {
    let (a, b) = (outline + radius, height.abs() - half + radius);
    hypotenuse(a.max(0.0), b.max(0.0)) + a.max(b).min(0.0) - radius
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn at(x: f64, y: f64, z: f64) -> Point3 {
        Point3::new(x, y, z)
    }

    #[test]
    fn distances_are_those_of_geometry() {
        assert_eq!(ball(&at(4.0, 6.0, 0.0), [1.0, 2.0, 0.0], 2.0), 3.0);
        assert_eq!(capsule(&at(5.0, 3.0, 0.0), [0.0; 3], [9.0, 0.0, 0.0], 1.0), 2.0);
        assert_eq!(capsule(&at(12.0, 4.0, 0.0), [0.0; 3], [9.0, 0.0, 0.0], 1.0), 4.0);
        assert_eq!(half_space(&at(7.0, 1.0, 3.0), [5.0, 0.0, 0.0], [2.0, 0.0, 0.0]), 2.0);
        // A disc of radius 5 and half height 2: above its middle, beside it, out from its rounded rim, within.
        let disc = |x: f64, z: f64| plate(hypotenuse(x, 0.0) - 5.0, z, 2.0, 1.0);
        assert_eq!([disc(0.0, 6.0), disc(9.0, 0.0), disc(7.0, 5.0), disc(4.5, 0.0)], [4.0, 4.0, 4.0, -0.5]);
        let egg = |x: f64, y: f64| ellipsoid(&at(x, y, 0.0), [1.0, 0.0, 0.0], [3.0, 2.0, 4.0]);
        assert_eq!([egg(4.0, 0.0), egg(1.0, 2.0), egg(1.0, 0.0), egg(7.0, 0.0)], [0.0, 0.0, -2.0, 2.0]);
    }

    #[test]
    fn a_round_cone_touches_both_of_its_balls() {
        // Balls of 3 and 1, 4 apart: the flank leans by the sine (3 - 1) / 4, so it touches the first one at 60 degrees.
        let cone = |x: f64, y: f64| round_cone(&at(x, y, 0.0), ([0.0; 3], 3.0), ([4.0, 0.0, 0.0], 1.0));
        let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
        let flank =
            |s: f64, out: f64| (4.0 * s + (3.0 - 2.0 * s + out) * sine, (3.0 - 2.0 * s + out) * cosine);
        for (s, out) in [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.3, 2.0), (0.6, -0.5)] {
            let (x, y) = flank(s, out);
            assert_relative_eq!(cone(x, y), out, epsilon = 1e-12);
        }
        assert_relative_eq!(cone(-5.0, 0.0), 2.0);
        assert_relative_eq!(cone(7.0, 0.0), 2.0);
    }

    #[test]
    fn blends_begin_at_their_width_and_keep_to_one_side() {
        assert_eq!(union(1.0, 5.0, 4.0), 1.0);
        assert_relative_eq!(union(0.0, 0.0, 6.0), -1.0);
        assert_relative_eq!(intersection(0.0, 0.0, 6.0), 1.0);
        assert_relative_eq!(difference(-1.0, -2.0, 1e-3), 2.0);
        // A step of the arguments changes the result by no more than the larger of the two steps.
        for k in 0..1000 {
            let (a, b) = (3.0 * f64::from(k).sin(), 3.0 * (1.7 * f64::from(k)).cos());
            let change = union(a + 1e-3, b - 1e-3, 2.0) - union(a, b, 2.0);
            assert!(change.abs() <= 1e-3 * (1.0 + 1e-9) && union(a, b, 2.0) <= a.min(b));
        }
    }
}
