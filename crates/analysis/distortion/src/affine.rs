//! Affine maps of the plane, similarities among them, from pairs of points.

use biplane_geometry::{Point2, Vector2};
use nalgebra::Matrix2;

/// `q = linear (p - from) + to`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Affine {
    /// Derivative.
    pub(crate) linear: Matrix2<f64>,
    /// A point,
    pub(crate) from: Point2,
    /// and where it goes.
    pub(crate) to: Point2,
}

/// The similarity matrix that takes direction `a` to `b`, or its mirror image about `a` to `b`; `None` where `a` has no length.
fn similarity_of(a: Vector2, b: Vector2, mirrored: bool) -> Option<Matrix2<f64>> {
    let square = a.norm_squared();
    if square.is_nan() || square <= 0.0 {
        return None;
    }
    let sign = if mirrored { -1.0 } else { 1.0 };
    // As complex numbers: b / a, or b / conj(a) after conj.
    let (re, im) = ((b.x * a.x + sign * b.y * a.y) / square, (b.y * a.x - sign * b.x * a.y) / square);
    Some(Matrix2::new(re, -sign * im, im, sign * re))
}

impl Affine {
    /// Where a point goes.
    pub(crate) fn apply(&self, p: &Point2) -> Point2 {
        self.to + self.linear * (p - self.from)
    }

    /// The way back; `None` where there is none.
    pub(crate) fn inverse(&self) -> Option<Self> {
        Some(Self { linear: self.linear.try_inverse()?, from: self.to, to: self.from })
    }

    /// By how much lengths grow.
    pub(crate) fn scale(&self) -> f64 {
        self.linear.determinant().abs().sqrt()
    }

    /// Whether it is one with a reflection.
    pub(crate) fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// The similarity that takes two points to two others; `None` where the first two are one.
    pub(crate) fn similarity(from: [Point2; 2], to: [Point2; 2], mirrored: bool) -> Option<Self> {
        let linear = similarity_of(from[1] - from[0], to[1] - to[0], mirrored)?;
        Some(Self { linear, from: from[0], to: to[0] })
    }

    /// The similarity that takes points to others with the least weighted sum of squared distances; `None` where the points are
    /// fewer than two or one place. Triples: from, to, weight.
    pub(crate) fn best_similarity(pairs: &[(Point2, Point2, f64)], mirrored: bool) -> Option<Self> {
        let (from, to) = means(pairs)?;
        let sign = if mirrored { -1.0 } else { 1.0 };
        let (mut re, mut im, mut square) = (0.0, 0.0, 0.0);
        for (p, q, w) in pairs {
            let (a, b) = (p - from, q - to);
            re += w * (b.x * a.x + sign * b.y * a.y);
            im += w * (b.y * a.x - sign * b.x * a.y);
            square += w * a.norm_squared();
        }
        let (re, im) = (re / square, im / square);
        let linear = Matrix2::new(re, -sign * im, im, sign * re);
        (linear.iter().all(|v| v.is_finite())).then_some(Self { linear, from, to })
    }

    /// The affine map of least squares; `None` where the points are fewer than three or lie along a line.
    pub(crate) fn best(pairs: &[(Point2, Point2, f64)]) -> Option<Self> {
        let (from, to) = means(pairs)?;
        let (mut normal, mut mixed) = (Matrix2::zeros(), Matrix2::zeros());
        for (p, q, w) in pairs {
            let (a, b) = (p - from, q - to);
            normal += a * a.transpose() * *w;
            mixed += b * a.transpose() * *w;
        }
        // Smaller over larger squared width of the set of points: about a quarter of the determinant over the squared trace.
        let wide_enough = normal.determinant() > 1e-3 * normal.trace().powi(2);
        wide_enough.then_some(())?;
        Some(Self { linear: mixed * normal.try_inverse()?, from, to })
    }
}

fn means(pairs: &[(Point2, Point2, f64)]) -> Option<(Point2, Point2)> {
    let (mut from, mut to, mut weight) = (Vector2::zeros(), Vector2::zeros(), 0.0);
    for (p, q, w) in pairs {
        from += p.coords * *w;
        to += q.coords * *w;
        weight += w;
    }
    (weight > 0.0).then(|| (Point2::from(from / weight), Point2::from(to / weight)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn similarities_from_two_points_and_from_many_are_the_same() {
        let p = [Point2::new(1.0, 2.0), Point2::new(4.0, -1.0), Point2::new(0.0, 7.0)];
        for mirrored in [false, true] {
            let q = [Point2::new(10.0, 5.0), Point2::new(3.0, 3.0)];
            let s = Affine::similarity([p[0], p[1]], q, mirrored).unwrap();
            assert_relative_eq!(s.apply(&p[0]), q[0], epsilon = 1e-12);
            assert_relative_eq!(s.apply(&p[1]), q[1], epsilon = 1e-12);
            assert_eq!(s.mirrors(), mirrored);
            let stretch = (q[1] - q[0]).norm() / (p[1] - p[0]).norm();
            assert_relative_eq!(s.scale(), stretch, epsilon = 1e-12);
            let pairs = p.map(|p| (p, s.apply(&p), 2.0));
            let best = Affine::best_similarity(&pairs, mirrored).unwrap();
            assert_relative_eq!(best.linear, s.linear, epsilon = 1e-12);
            assert_relative_eq!(best.apply(&p[2]), s.apply(&p[2]), epsilon = 1e-12);
            let affine = Affine::best(&pairs).unwrap();
            assert_relative_eq!(affine.linear, s.linear, epsilon = 1e-12);
            assert_relative_eq!(s.inverse().unwrap().apply(&q[1]), p[1], epsilon = 1e-12);
        }
    }

    #[test]
    fn too_few_points_give_none() {
        let p = Point2::new(1.0, 1.0);
        assert_eq!(Affine::similarity([p, p], [p, Point2::origin()], false), None);
        assert_eq!(Affine::best_similarity(&[(p, p, 1.0)], false), None);
        let line = [0.0, 1.0, 2.0, 3.0].map(|t| (Point2::new(t, 2.0 * t), Point2::new(t, t), 1.0));
        assert_eq!(Affine::best(&line), None);
    }
}
