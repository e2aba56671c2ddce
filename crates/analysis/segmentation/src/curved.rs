//! Moves the points of curved edges to where the step was before it was blurred.
//!
//! Smoothing shrinks round outlines: the gradient of a disc of radius `R` blurred by a Gaussian of `s` px is
//! `(R / s^2) exp(-(r^2 + R^2) / 2 s^2) I1(r R / s^2)`, largest at the `r` for which `R = r I1(x) / I1'(x)`, `x = r R / s^2`; for `R` well
//! above `s`, `R - r` is `s^2 / 2r`. Here `r` is the radius of curvature of the curve that was found and `s` the edge's own width, which holds
//! the blur of the picture too; both are taken along a stretch of the curve.
//!
//! Corners are not discs: where the curvature is not steady, or its radius below two blurs, nothing is moved.
//!
//! **Guaranteed:** no point moves by more than half the blur. **Not guaranteed:** an edge that is no blurred step, like the rim of
//! a smooth body under X-rays, whose steepest place lies inside whatever the blur; matching, which knows the body, takes that out.

use biplane_geometry::{Curve, EdgePoint};

/// Half the stretch over which curvature is taken, in units of the edge's width.
const STRETCH: f64 = 5.0;
/// A closed curve with fewer points than so many half stretches is a disc, and not the outline of a body with corners.
const DISC: f64 = 14.0;

/// Corrects all points of a curve. `blurs` are squares of the edge's width at each point, px^2; below 0 for a method that finds
/// round outlines too large by as much. `fit` times the curvature is what the fit adds, px^2.
pub(crate) fn correct(curve: &mut Curve, blurs: &[f64], fit: f64) {
    let n = curve.points.len();
    if n < 5 || blurs.len() != n {
        return;
    }
    let mut sorted = blurs.to_vec();
    let blur_squared = *sorted.select_nth_unstable_by(n / 2, f64::total_cmp).1;
    let half = STRETCH * blur_squared.abs().sqrt();
    let course = Course::of(&curve.points, curve.closed, half);
    // A short curve that closes is a disc, however tight.
    let disc = curve.closed && (n as f64) < DISC * half;
    let mut windows = [[0, 0]; 3];
    let stretches = [[half, half], [half, 0.0], [0.0, half]];
    for (i, p) in curve.points.iter_mut().enumerate() {
        let found: [f64; 3] = std::array::from_fn(|w| course.curvature(i, stretches[w], &mut windows[w]));
        let curvature = if disc {
            found[0]
        } else {
            steadiest(found) * trusted(found[0].abs() * blur_squared.abs().sqrt())
        };
        // The course is the direction turned by a quarter from x to y, so where it turns that way its centre is on the dark side.
        let outward = p.direction * curvature.signum();
        let shift = shrunk_by(curvature.abs(), blur_squared.abs(), fit);
        p.position += outward * shift * blur_squared.signum();
    }
}

/// Of the curvatures over a whole stretch and its halves the middle one, and none where they turn different ways: where two bodies
/// meet the outline is no arc of one disc.
fn steadiest([whole, behind, ahead]: [f64; 3]) -> f64 {
    let same = whole * behind > 0.0 && whole * ahead > 0.0;
    if same { whole.clamp(behind.min(ahead), behind.max(ahead)) } else { 0.0 }
}

/// How far a disc of this curvature, in units of one over the blur, can be trusted to be one, 0 to 1: a corner that was blurred
/// looks like a disc of one or two blurs.
fn trusted(curvature: f64) -> f64 {
    ((0.6 - curvature) / 0.1).clamp(0.0, 1.0)
}

/// How far outside the found point the step lies, px, where the curve has this curvature, 1 / px.
fn shrunk_by(curvature: f64, blur_squared: f64, fit: f64) -> f64 {
    // The fit's own error comes on top of the crest's.
    let found = 1.0 / curvature.max(1e-9) + fit * curvature;
    let mut radius = found;
    for _ in 0..8 {
        radius = found / slope_of_bessel(found * radius / blur_squared).clamp(0.5, 1.0);
    }
    (radius - found).min(0.5 * blur_squared.sqrt()) + fit * curvature
}

/// `I1'(x) / I1(x)`, which is `I0 / I1 - 1 / x`, of the modified Bessel functions.
fn slope_of_bessel(x: f64) -> f64 {
    if x > 30.0 {
        return 1.0 - 1.0 / (2.0 * x) + 3.0 / (8.0 * x * x) + 3.0 / (8.0 * x * x * x);
    }
    // I1 / I0 as a continued fraction (Gauss), from behind.
    let ratio = (1..50).rev().fold(0.0, |rest, k| 1.0 / (2.0 * f64::from(k) / x + rest));
    1.0 / ratio - 1.0 / x
}

/// The angle with this sine and cosine, of 60 degrees at most, to 1e-6 rad: by the tangent of its half.
fn turn(sine: f64, cosine: f64) -> f64 {
    let t = sine / (1.0 + cosine).max(1.0);
    let tt = t * t;
    2.0 * t * (1.0 - tt * (1.0 / 3.0 - tt * (0.2 - tt * (1.0 / 7.0 - tt / 9.0))))
}

/// Sums along a curve for straight lines of the course's angle by its length.
struct Course {
    /// Length along the curve to each point, px; a closed one goes round three times.
    along: Vec<f64>,
    /// Sums over the points before each: count, length, angle, length^2, length x angle.
    sums: Vec<[f64; 5]>,
    /// Place of the first point of the middle round.
    offset: usize,
}

impl Course {
    fn of(points: &[EdgePoint], closed: bool, half: f64) -> Self {
        let n = points.len();
        // Enough of the rounds before and after for the stretch around any point.
        let extra = if closed { n.min((2.0 * half).ceil() as usize + 1) } else { 0 };
        let at = |i: usize| &points[(i + n - extra) % n];
        let count = n + 2 * extra;
        let (mut along, mut angle) = (0.0, at(0).direction.y.atan2(at(0).direction.x));
        let mut course = Self { along: Vec::with_capacity(count), sums: vec![[0.0; 5]], offset: extra };
        let mut sums = [0.0; 5];
        for i in 0..count {
            if i > 0 {
                let (a, b) = (at(i - 1), at(i));
                along += (b.position - a.position).norm();
                angle += turn(a.direction.perp(&b.direction), a.direction.dot(&b.direction));
            }
            for (sum, v) in sums.iter_mut().zip([1.0, along, angle, along * along, along * angle]) {
                *sum += v;
            }
            course.along.push(along);
            course.sums.push(sums);
        }
        course
    }

    /// Turn of the course over a stretch behind point `i` and ahead of it, rad a px, positive from x to y (clockwise as seen). `window`
    /// is that of the point before, and becomes that of this one.
    fn curvature(&self, i: usize, [behind, ahead]: [f64; 2], window: &mut [usize; 2]) -> f64 {
        let here = self.along[i + self.offset];
        let [first, last] = window;
        while self.along[*first] < here - behind {
            *first += 1;
        }
        while self.along.get(*last).is_some_and(|s| *s <= here + ahead) {
            *last += 1;
        }
        let (first, last) = (*first, *last);
        let [count, s, a, ss, sa] = std::array::from_fn(|k| self.sums[last][k] - self.sums[first][k]);
        let spread = ss - s * s / count;
        if count < 4.0 || spread < 1e-9 { 0.0 } else { (sa - s * a / count) / spread }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Point2, Vector2};

    /// The crest of a blurred disc, by a search for the largest value of its gradient.
    fn crest_of_disc(radius: f64, blur: f64) -> f64 {
        // I1 without its factor exp(x), by its integral.
        let bessel = |x: f64| {
            let n = 2000;
            let step = std::f64::consts::PI / f64::from(n);
            (0..n)
                .map(|k| {
                    let t = (f64::from(k) + 0.5) * step;
                    (x * (t.cos() - 1.0)).exp() * t.cos() * step
                })
                .sum::<f64>()
                / std::f64::consts::PI
        };
        let s2 = blur * blur;
        let gradient = |r: f64| (-(r - radius).powi(2) / (2.0 * s2)).exp() * bessel(r * radius / s2);
        let (mut low, mut high) = (radius - blur, radius + 0.1 * blur);
        for _ in 0..60 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if gradient(a) < gradient(b) {
                low = a;
            } else {
                high = b;
            }
        }
        (low + high) / 2.0
    }

    #[test]
    fn the_crest_of_a_blurred_disc_is_moved_to_its_edge() {
        for (radius, blur, most) in
            [(40.0, 1.3, 1e-4), (10.0, 2.0, 1e-3), (6.5, 1.3, 1e-3), (5.0, 1.6, 1e-3), (2.0, 0.6, 1e-3)]
        {
            let crest = crest_of_disc(radius, blur);
            assert!(radius - crest > 0.4 * blur * blur / radius / 2.0, "there is something to correct");
            let corrected = crest + shrunk_by(1.0 / crest, blur * blur, 0.0);
            assert!((corrected - radius).abs() < most, "{radius} {blur}: {corrected}");
        }
    }

    #[test]
    fn dark_and_bright_discs_grow_and_straight_edges_stay() {
        let n = 60;
        let radius = 10.0;
        for sign in [1.0, -1.0] {
            let points = (0..n).map(|i| {
                // In the order of a curve: the course is the direction turned by a quarter.
                let a = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
                let radial = Vector2::new(a.cos(), a.sin());
                EdgePoint {
                    position: Point2::new(50.0, 50.0) + radius * radial,
                    direction: sign * radial,
                    strength: 1.0,
                    sigma_px: 0.1,
                }
            });
            let mut points: Vec<EdgePoint> = points.collect();
            if sign < 0.0 {
                points.reverse();
            }
            let mut disc = Curve { points, closed: true };
            correct(&mut disc, &[2.0; 60], 0.0);
            for p in &disc.points {
                let found = (p.position - Point2::new(50.0, 50.0)).norm();
                assert!((found - (radius + shrunk_by(0.1, 2.0, 0.0))).abs() < 1e-3, "{found}");
            }
        }
        let straight = |i: i32| EdgePoint {
            position: Point2::new(f64::from(i), 3.0),
            direction: Vector2::new(0.0, -1.0),
            strength: 1.0,
            sigma_px: 0.1,
        };
        let mut line = Curve { points: (0..20).map(straight).collect(), closed: false };
        correct(&mut line, &[2.0; 20], 0.0);
        assert!(line.points.iter().all(|p| (p.position.y - 3.0).abs() < 1e-9));
    }
}
