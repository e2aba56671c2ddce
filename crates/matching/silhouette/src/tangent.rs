//! Planes through the source that touch a body's shadow.
//!
//! A line of the picture that touches the shadow from outside and the source span a plane that touches the body's convex hull. In
//! homogeneous pixels the line is `u . p = c` with its normal `u` away from the shadow, and `w p = M (X - source)` makes the plane's normal
//! `M' (u, -c)`: exact for a cone of rays, however deep the body is.

use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{EdgePoint, Point2, Point3, Vector2, Vector3};

/// A plane through the source of a view that touches the body from outside.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tangent {
    /// Unit normal, laboratory frame, away from the body.
    pub normal: Vector3,
    /// A point of the plane: the source.
    pub source: Point3,
}

/// The convex hull of points, in order around it (Andrew 1979).
pub(crate) fn hull(mut points: Vec<Point2>) -> Vec<Point2> {
    points.retain(|p| p.coords.iter().all(|v| v.is_finite()));
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = &Point2>| {
        let mut chain: Vec<Point2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b - a).perp(&(p - b)) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(*p);
        }
        chain.pop();
        chain
    };
    let mut around = half(&mut points.iter());
    around.extend(half(&mut points.iter().rev()));
    around
}

/// The middle of a hull's area; `None` where it has none.
pub(crate) fn middle(hull: &[Point2]) -> Option<Point2> {
    let first = hull.first()?;
    let (mut area, mut sum) = (0.0, Vector2::zeros());
    for pair in hull.windows(2) {
        let (a, b) = (pair[0] - first, pair[1] - first);
        area += a.perp(&b);
        sum += (a + b) * (a.perp(&b) / 3.0);
    }
    (area > 1.0).then(|| first + sum / area)
}

/// What is so near the picture's border was cut by it, px.
const BORDER_PX: f64 = 3.0;
/// Edges so near a touching point, px, must face as the tangent does within so much, rad, or face to both sides of it, as at a corner.
const BESIDE: (f64, f64) = (6.0, 0.3);
/// An edge that is turned from a tangent by more than this, rad, faces backward.
const BACKWARD: f64 = 1.75;

/// Tangent planes in `count` directions around the hull of a view's edges, `contrast` +1 for a body darker than what is around it.
///
/// Left out are those that touch where the picture ends, and those that touch where no edge faces their way: the end of a curve
/// whose rest is missing, or an edge of something else.
pub(crate) fn tangents(
    edges: &[EdgePoint],
    hull: &[Point2],
    view: &Fluoroscope,
    contrast: f64,
    count: usize,
) -> Vec<Tangent> {
    let m = view.matrix();
    let faces = |u: &Vector2, touched: &Point2| {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for e in edges.iter().filter(|e| (e.position - touched).norm_squared() < BESIDE.0 * BESIDE.0) {
            let d = e.direction * contrast;
            let angle = u.perp(&d).atan2(u.dot(&d));
            if angle.abs() < BACKWARD {
                (least, most) = (least.min(angle), most.max(angle));
            }
        }
        least <= BESIDE.1 && most >= -BESIDE.1
    };
    let tangent = |k: usize| {
        let turn = std::f64::consts::TAU * k as f64 / count as f64;
        let u = Vector2::new(turn.cos(), turn.sin());
        let touched = hull.iter().max_by(|a, b| u.dot(&a.coords).total_cmp(&u.dot(&b.coords)))?;
        let line = Vector3::new(u.x, u.y, -u.dot(&touched.coords));
        let normal = (m.transpose() * line).try_normalize(0.0)?;
        let valid = view.on_image(touched, BORDER_PX) && faces(&u, touched);
        valid.then_some(Tangent { normal, source: *view.source() })
    };
    (0..count).filter_map(tangent).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_phantom::biplane;

    #[test]
    fn the_hull_is_convex_and_holds_every_point() {
        let points: Vec<Point2> = (0..300)
            .map(|k| {
                let (a, r) = (f64::from(k) * 2.4, f64::from(k % 17));
                Point2::new((r * a.cos()).round(), (r * a.sin()).round())
            })
            .collect();
        let around = hull(points.clone());
        for k in 0..around.len() {
            let (a, b) = (around[k], around[(k + 1) % around.len()]);
            assert!(points.iter().all(|p| (b - a).perp(&(p - a)) >= 0.0));
        }
        assert!(around.len() > 8 && hull(Vec::new()).is_empty());
        let square = hull(
            [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (2.0, 4.0)]
                .map(|(x, y)| Point2::new(x, y))
                .into(),
        );
        assert_eq!(square.len(), 4);
        assert!((middle(&square).unwrap() - Point2::new(2.0, 2.0)).norm() < 1e-12);
    }

    /// The outline of a ball is touched by planes at the ball's radius from its middle.
    #[test]
    fn planes_touch_what_cast_the_shadow() {
        let [a, _] = biplane(90.0);
        let view = Fluoroscope::from(&a.calibration("A"));
        let ball = biplane_phantom::Ball { centre: Point3::origin(), radius: 25.0 };
        let pose = biplane_geometry::Pose::new(
            nalgebra::UnitQuaternion::identity(),
            Vector3::new(31.0, -60.0, 12.0),
        );
        let outline = biplane_phantom::ideal_outline(&ball, &pose, &a, 0.5);
        let edges: Vec<EdgePoint> = outline.into_iter().flat_map(|c| c.points).collect();
        let around = |edges: &[EdgePoint]| hull(edges.iter().map(|p| p.position).collect());
        let planes = tangents(&edges, &around(&edges), &view, 1.0, 40);
        assert_eq!(planes.len(), 40);
        assert!(tangents(&edges, &around(&edges), &view, -1.0, 40).is_empty());
        // Half of the outline is missing: what its ends are touched by touches no ball.
        let half: Vec<EdgePoint> = edges.into_iter().filter(|e| e.direction.x > 0.0).collect();
        let left = tangents(&half, &around(&half), &view, 1.0, 40);
        assert!(left.len() >= 19 && left.len() <= 25, "{}", left.len());
        for plane in planes.iter().chain(&left) {
            let outside = plane.normal.dot(&(plane.source - Point3::from(pose.translation())));
            assert!((outside - 25.0).abs() < 1.2, "{outside}");
        }
        for plane in planes {
            let outside = plane.normal.dot(&(plane.source - Point3::from(pose.translation())));
            assert!((outside - 25.0).abs() < 0.01, "{outside}");
        }
    }
}
