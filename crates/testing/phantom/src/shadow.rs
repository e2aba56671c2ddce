//! Where the shadow of a ball, and of what else is round, has its outline and its centre on a picture.
//!
//! A ball's shadow is bounded by the rays that touch it, which make a cone about the ray through its centre. The centre of
//! the shadow is **not** the projection of the ball's centre: the ellipse in which a cone meets a plane has its centre farther
//! from the foot of the source. A distorted outline has its centre elsewhere again.

use biplane_geometry::{Point2, Vector2, Vector3};

use crate::{Ball, TrueFluoroscope};

/// Points of an outline. The polygon's centroid is off the ellipse's centre by less than 0.001 of the latter's distance from
/// the projection of the ball's centre.
const POINTS: usize = 128;

/// Ideal pixels of the outline of a ball's shadow, in order; `None` where the shadow is not bounded, or the source is in the
/// ball.
pub fn shadow_outline(view: &TrueFluoroscope, ball: &Ball) -> Option<Vec<Point2>> {
    let to = ball.centre - view.source;
    let sine = ball.radius / to.norm();
    // Touching points lie on a circle around the axis, nearer to the source than the ball's centre.
    let cosine = (1.0 - sine * sine).sqrt();
    let aside = if to.x.abs() < to.y.abs() { Vector3::x() } else { Vector3::y() };
    let first = to.cross(&aside).try_normalize(0.0)?;
    let second = to.normalize().cross(&first);
    let middle = ball.centre - to * (sine * sine);
    circle(POINTS)
        .map(|p| Some(view.project(&(middle + (first * p.x + second * p.y) * (ball.radius * cosine)))?.0))
        .collect()
}

/// Points of the unit circle, from x to y.
pub(crate) fn circle(count: usize) -> impl Iterator<Item = Vector2> {
    (0..count).map(move |i| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / count as f64).sin_cos();
        Vector2::new(cos, sin)
    })
}

/// Centroid of the area of a polygon; `None` where it has none.
pub fn area_centroid(polygon: &[Point2]) -> Option<Point2> {
    let first = polygon.first()?;
    let (mut sum, mut area) = (Vector2::zeros(), 0.0);
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        // Relative to the first corner, so that no digits are lost far from the origin.
        let (a, b) = (a - first, b - first);
        let twice = a.perp(&b);
        sum += (a + b) * (twice / 3.0);
        area += twice;
    }
    (area != 0.0).then(|| first + sum / area)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::biplane;
    use approx::assert_relative_eq;
    use biplane_geometry::Point3;

    #[test]
    fn the_shadow_is_not_centred_on_the_projection() {
        let [view, _] = biplane(90.0);
        // Far off the axis, where the cone meets the detector obliquely.
        let ball = Ball { centre: Point3::new(120.0, 20.0, -40.0), radius: 12.0 };
        let outline = shadow_outline(&view, &ball).unwrap();
        let shadow = area_centroid(&outline).unwrap();
        let (projected, _) = view.project(&ball.centre).unwrap();
        // In the plane through the source, the ball's centre and the foot of the source the shadow reaches from angle a - b to
        // a + b, with a the angle of the centre from the detector's normal and sin b = radius / distance.
        let to = ball.centre - view.source;
        let (a, b) = (to.angle(&view.normal()), (ball.radius / to.norm()).asin());
        let foot = Point2::new(511.5, 511.5);
        let reach = |angle: f64| 1000.0 * angle.tan() / view.pixel_mm;
        let middle = foot + (projected - foot).normalize() * ((reach(a + b) + reach(a - b)) / 2.0);
        let beside = (shadow - projected).norm();
        assert!(beside > 0.1, "{beside}");
        assert_relative_eq!(shadow, middle, epsilon = 1e-3 * beside);
        // Every ray of the outline touches the ball.
        for p in outline {
            assert_relative_eq!(view.ray(&p).cross(&to).norm(), ball.radius, epsilon = 1e-9);
        }
    }

    #[test]
    fn without_an_outline_there_is_none() {
        let [view, _] = biplane(90.0);
        for (centre, radius) in [
            (Point3::new(0.0, -600.0, 0.0), 1.0),
            (Point3::new(0.0, -499.0, 0.0), 2.0),
            (Point3::new(0.0, -500.0, 0.0), 1.0),
            (Point3::new(f64::NAN, 0.0, 0.0), 1.0),
        ] {
            let outline = shadow_outline(&view, &Ball { centre, radius });
            assert!(outline.is_none_or(|o| o.iter().all(|p| p.x.is_nan())), "{centre}");
        }
    }

    #[test]
    fn centroids_are_those_of_areas() {
        // An L of three unit squares.
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]].map(Point2::from);
        assert_relative_eq!(area_centroid(&l).unwrap(), Point2::new(2.5 / 3.0, 2.5 / 3.0), epsilon = 1e-12);
        assert_eq!(area_centroid(&[]), None);
        assert_eq!(area_centroid(&l[..2]), None);
    }
}
