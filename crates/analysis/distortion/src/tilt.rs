//! Whether a plate is seen at an angle: a plate on the intensifier is not.
//!
//! A tilted plate is seen in perspective: `w = (A u) / (1 + p . u)` of its own coordinates `u`. Its axes differ in scale by the
//! cosine of the tilt, and the scale changes along the picture by `p = sin(tilt) / distance of the source`. An intensifier on top of
//! it adds pincushion and S-shape about a centre of its own, `K |w - d|^2 (w - d)`, which also has terms of second order if `d` is not
//! the middle. In complex numbers (`z` for `u`, `K = k + i s`) the sum has
//!
//! `z^2: -conj(p) / 2 - K conj(d)`, `|z|^2: -p / 2 - 2 K d`, `z: 1`, `conj(z): m + K d^2`, `z |z|^2: K`,
//!
//! so all four unknowns follow from the coefficients of a polynomial of third degree. **Not guaranteed:** that a distortion of
//! another kind is not taken for a tilt; that is why a tilt is a warning.

use biplane_geometry::Point2;
use nalgebra::{Complex, SMatrix, SVector};

/// What a picture says of its plate's tilt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tilt {
    /// How the plate's scale changes over the picture, as an angle of the plate to the intensifier, degrees.
    pub(crate) by_perspective_deg: f64,
    /// Largest over smallest scale in the middle of the picture, less 1.
    pub(crate) anisotropy: f64,
}

const TERMS: usize = 10;

/// Judges a plate from ideal pixels (of any similarity) and recorded ones of its spots. `source_px` is the distance of the source from the
/// plate in ideal pixels. `None` where the spots do not determine a polynomial of third degree.
pub(crate) fn tilt(ideal: &[Point2], recorded: &[Point2], size: [usize; 2], source_px: f64) -> Option<Tilt> {
    if ideal.len() < 2 * TERMS {
        return None;
    }
    let middle = Point2::from(size.map(|n| (n as f64 - 1.0) / 2.0));
    let rim = size[0].min(size[1]) as f64 / 2.0;
    let number = |p: &Point2| Complex::new((p.x - middle.x) / rim, (p.y - middle.y) / rim);
    let mut normal = SMatrix::<Complex<f64>, TERMS, TERMS>::zeros();
    let mut right = SVector::<Complex<f64>, TERMS>::zeros();
    for (u, v) in ideal.iter().zip(recorded) {
        let (z, v) = (number(u), number(v));
        let c = z.conj();
        let terms = SVector::from([
            Complex::new(1.0, 0.0),
            z,
            c,
            z * z,
            z * c,
            c * c,
            z * z * z,
            z * z * c,
            z * c * c,
            c * c * c,
        ]);
        normal += terms.conjugate() * terms.transpose();
        right += terms.conjugate() * v;
    }
    let cholesky = normal.cholesky()?;
    let t = cholesky.solve(&right);
    // Everything relative to the scale and the turn in the middle.
    let [scale, stretch, square, modulus, cubic] = [t[1], t[2] / t[1], t[3] / t[1], t[4] / t[1], t[7] / t[1]];
    (scale.norm() > 1e-3).then_some(())?;
    let weighted = Complex::new(cubic.re, 3.0 * cubic.im);
    let off =
        if weighted.norm() > 1e-9 { (square.conj() - modulus) / weighted } else { Complex::new(0.0, 0.0) };
    let perspective = (square.conj() + cubic.conj() * off) * -2.0;
    let stretch = (stretch - cubic * off * off).norm().min(0.99);
    let sine = perspective.norm() * source_px / rim;
    Some(Tilt {
        by_perspective_deg: sine.min(1.0).asin().to_degrees(),
        anisotropy: 2.0 * stretch / (1.0 - stretch),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Pose, Vector2};
    use biplane_phantom::{
        IntensifierDistortion, Plate, PlatePlacement, SpotPattern, SpotRadii, TrueFluoroscope, biplane,
    };

    /// What is found of a plate of the phantom that is tilted so.
    fn found(tilt_deg: [f64; 2], distortion: &IntensifierDistortion) -> Tilt {
        let [view, _] = biplane(90.0);
        let TrueFluoroscope { size, pixel_mm, .. } = view;
        let radii = SpotRadii { centre: 1.0, orientation: 1.0, others: 1.0 };
        let plate = Plate::dotted(SpotPattern::Square { pitch_mm: 12.0, reach_mm: 150.0 }.spots(radii));
        let tilt_rad = tilt_deg.map(f64::to_radians);
        let placement = PlatePlacement { turn_rad: 0.4, tilt_rad, ..PlatePlacement::on_detector() };
        let pose: Pose = placement.pose(&view);
        let (mut ideal, mut recorded) = (Vec::new(), Vec::new());
        for spot in plate.seen(&pose, &view, distortion) {
            let on_plate = plate.spots[spot.number].centre;
            let (sin, cos) = 0.4_f64.sin_cos();
            let turned =
                Vector2::new(cos * on_plate.x - sin * on_plate.y, sin * on_plate.x + cos * on_plate.y);
            ideal.push(Point2::new(511.5, 511.5) + turned / pixel_mm);
            recorded.push(spot.recorded);
        }
        tilt(&ideal, &recorded, size, 1000.0 / pixel_mm).unwrap()
    }

    #[test]
    fn a_tilt_is_told_from_distortion_about_any_centre() {
        let straight = IntensifierDistortion::none([1024, 1024]);
        let bent = IntensifierDistortion { pincushion_px: 12.0, s_shape_px: 12.0, ..straight };
        let beside = IntensifierDistortion { centre: Point2::new(540.0, 490.0), ..bent };
        for distortion in [straight, bent, beside] {
            let none = found([0.0, 0.0], &distortion);
            assert!(none.by_perspective_deg < 0.15 && none.anisotropy < 2e-4, "{none:?}");
            for tilt_deg in [[1.0, 0.0], [0.0, -3.0], [4.0, 4.0]] {
                let tilted = found(tilt_deg, &distortion);
                let [a, b] = tilt_deg.map(|d: f64| d.to_radians());
                let truth = (a.cos() * b.cos()).acos().to_degrees();
                let off = (tilted.by_perspective_deg - truth).abs();
                assert!(off < 0.15 + 0.03 * truth, "{tilted:?} instead of {truth}");
                let stretched = 1.0 / truth.to_radians().cos() - 1.0;
                assert!((tilted.anisotropy - stretched).abs() < 4e-4, "{tilted:?} instead of {stretched}");
            }
        }
    }
}
