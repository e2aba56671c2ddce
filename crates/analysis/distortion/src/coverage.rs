//! How much of a picture the spots of a plate cover: elsewhere the map of distortion is a continuation.

use biplane_artifact::Circle;
use biplane_geometry::Point2;

use crate::nearby::Nearby;

/// Places along each side of the picture at which it is asked.
const PLACES: usize = 64;

/// A place is covered if a spot is within this many times the usual distance of neighbouring spots.
const NEAR: f64 = 1.2;

/// Whether a place lies in the picture, and in its round border if it has one, by at least `inside_px`.
pub(crate) fn in_picture(place: &Point2, size: [usize; 2], border: Option<&Circle>, inside_px: f64) -> bool {
    let in_frame = (0..2).all(|a| place[a] >= inside_px && place[a] <= size[a] as f64 - 1.0 - inside_px);
    let in_circle = |c: &Circle| (place - Point2::from(c.centre_px)).norm() <= c.radius_px - inside_px;
    in_frame && border.is_none_or(in_circle)
}

/// The share of the picture, within its round border, that lies near one of the spots (recorded px).
pub(crate) fn covered_share(spots: &[Point2], size: [usize; 2], border: Option<&Circle>) -> f64 {
    let nearby = Nearby::new(spots.to_vec());
    let mut to_next: Vec<f64> = spots.iter().filter_map(|p| Some(nearby.closest(p, 2).get(1)?.1)).collect();
    to_next.sort_by(f64::total_cmp);
    let Some(usual) = to_next.get(to_next.len() / 2) else { return 0.0 };
    let at = |k: usize, side: usize| (k as f64 + 0.5) / PLACES as f64 * (side as f64 - 1.0);
    let places = (0..PLACES * PLACES).map(|k| Point2::new(at(k % PLACES, size[0]), at(k / PLACES, size[1])));
    let (mut all, mut covered) = (0_usize, 0_usize);
    for place in places.filter(|p| in_picture(p, size, border, 0.0)) {
        all += 1;
        covered += usize::from(nearby.nearest(&place).is_some_and(|(_, d)| d <= NEAR * usual));
    }
    covered as f64 / all.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_picture_is_half_covered() {
        let grid = |columns: u32| -> Vec<Point2> {
            (0..columns * 40)
                .map(|k| Point2::new(f64::from(k % columns), f64::from(k / columns)) * 10.0)
                .collect()
        };
        assert_eq!(covered_share(&grid(40), [391, 391], None), 1.0);
        // 20 columns reach to 190 px, and 12 px on: 202 of 390.
        let half = covered_share(&grid(20), [391, 391], None);
        assert!((half - 202.0 / 390.0).abs() < 0.02, "{half}");
        let circle = Circle { centre_px: [90.0, 195.0], radius_px: 80.0 };
        assert_eq!(covered_share(&grid(20), [391, 391], Some(&circle)), 1.0);
        assert_eq!(covered_share(&[], [391, 391], None), 0.0);
        assert!(!in_picture(&Point2::new(169.0, 195.0), [391, 391], Some(&circle), 3.0));
    }
}
