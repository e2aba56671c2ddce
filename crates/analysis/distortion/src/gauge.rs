//! Where ideal pixels begin, how they are turned, and how large they are: what a plate's picture leaves free.
//!
//! They are chosen so that the map from recorded to ideal pixels moves those in the middle of the picture least, in the sense of
//! weighted least squares. A corrected picture then looks like the recorded one, and has its scale in the middle. The plate's turn and shift
//! are in the similarity from ideal pixels to the plate.

use biplane_geometry::Point2;

use crate::affine::Affine;

/// Standard deviation of the Gaussian weight about the middle of the picture, part of half its shorter side.
const MIDDLE: f64 = 0.35;

/// Ideal pixels of the plate's mm, with a reflection where the plate is seen from its back. The side of a pixel is `pixel_mm` if
/// that is given. `None` where the pairs are fewer than three or lie along a line.
///
/// `recorded` and `plate` are px and mm of the same spots.
pub(crate) fn ideal_from_plate(
    recorded: &[Point2],
    plate: &[Point2],
    size: [usize; 2],
    pixel_mm: Option<f64>,
) -> Option<Affine> {
    let middle = Point2::from(size.map(|n| (n as f64 - 1.0) / 2.0));
    let sigma = MIDDLE * size[0].min(size[1]) as f64 / 2.0;
    let exponent = |p: &Point2| (p - middle).norm_squared() / (2.0 * sigma * sigma).max(1e-9);
    // Relative to the nearest spot, so that they do not all vanish where the middle has none.
    let least = recorded.iter().map(exponent).fold(f64::INFINITY, f64::min);
    let pairs: Vec<(Point2, Point2, f64)> =
        plate.iter().zip(recorded).map(|(m, p)| (*m, *p, (least - exponent(p)).exp())).collect();
    let even: Vec<_> = pairs.iter().map(|(m, p, _)| (*m, *p, 1.0)).collect();
    let mirrored = Affine::best(&even)?.mirrors();
    let mut best = Affine::best_similarity(&pairs, mirrored)?;
    if let Some(pixel_mm) = pixel_mm {
        best.linear /= best.scale() * pixel_mm;
    }
    Some(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use biplane_geometry::Vector2;

    #[test]
    fn the_middle_of_the_picture_stays_where_it_is() {
        let size = [1024, 1024];
        let middle = Point2::new(511.5, 511.5);
        for mirrored in [1.0, -1.0] {
            let (mut plate, mut recorded) = (Vec::new(), Vec::new());
            for k in 0..400 {
                let p = Point2::new(f64::from(k % 20) * 51.0 + 20.0, f64::from(k / 20) * 51.0 + 20.0);
                let q: Vector2 = (p - middle) / 512.0;
                // Pincushion of 10 px; a plate turned by a quarter, 0.3 mm a px.
                recorded.push(p + q * q.norm_squared() * 10.0);
                plate.push(Point2::new(-(p.y - 200.0) * 0.3, mirrored * (p.x - 100.0) * 0.3));
            }
            let g = ideal_from_plate(&recorded, &plate, size, None).unwrap();
            assert_eq!(g.mirrors(), mirrored < 0.0);
            let (at, moved) = (g.apply(&plate[210]), recorded[210]);
            assert!((at - moved).norm() < 0.3, "{at} {moved}");
            // Of 1 % at most, the part of the pincushion within the Gaussian: 10 / 512 times 2 times 0.35^2 twice.
            assert_relative_eq!(1.0 / g.scale(), 0.3, max_relative = 0.01);
            let held = ideal_from_plate(&recorded, &plate, size, Some(0.25)).unwrap();
            assert_relative_eq!(held.scale(), 4.0, epsilon = 1e-12);
        }
        assert_eq!(ideal_from_plate(&[middle], &[middle], size, None), None);
    }
}
