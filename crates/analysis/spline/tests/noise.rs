//! What smoothing makes of noise, on curves whose truth is known.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use biplane_geometry::{Point2, Vector2};
use biplane_spline::{Choice, FootFinder, Smoothing, Spline};
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, Normal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A true curve, and points near it about a pixel apart.
struct Truth {
    finder: FootFinder,
    points: Vec<Point2>,
    normals: Vec<Vector2>,
    closed: bool,
}

/// How the noise of points is made.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Across,
    Both,
    /// Across, averaged over neighbours by a Gaussian of 1.5 points.
    Shared,
}

impl Truth {
    /// Points of a curve given by its place at shares 0 to 1 of the way, `length` of them, unevenly spaced.
    fn new(length: usize, closed: bool, random: &mut Xoshiro256PlusPlus, at: impl Fn(f64) -> Point2) -> Self {
        let dense: Vec<Point2> =
            (0..8 * length + usize::from(!closed)).map(|k| at(k as f64 / (8 * length) as f64)).collect();
        let spline = Spline::through(&dense, closed).unwrap();
        let count = length as f64;
        let shares: Vec<f64> =
            (0..length).map(|k| (k as f64 + random.random_range(0.2..0.8)) / count).collect();
        let t: Vec<f64> = shares.iter().map(|s| s * spline.end()).collect();
        Self {
            points: t.iter().map(|t| spline.point(*t)).collect(),
            normals: t.iter().map(|t| spline.normal(*t).unwrap()).collect(),
            finder: FootFinder::of(&spline),
            closed,
        }
    }

    fn circle(radius: f64, random: &mut Xoshiro256PlusPlus) -> Self {
        let length = (std::f64::consts::TAU * radius).round() as usize;
        Self::new(length, true, random, |s| {
            let a = std::f64::consts::TAU * s;
            Point2::new(100.0 + radius * a.cos(), 100.0 + radius * a.sin())
        })
    }

    fn ellipse(random: &mut Xoshiro256PlusPlus) -> Self {
        Self::new(510, true, random, |s| {
            let a = std::f64::consts::TAU * s;
            Point2::new(300.0 + 100.0 * a.cos(), 200.0 + 60.0 * a.sin())
        })
    }

    /// An open curve with bends of 12 to 100 px radius.
    fn snake(random: &mut Xoshiro256PlusPlus) -> Self {
        Self::new(400, false, random, |s| {
            let x = 350.0 * s;
            Point2::new(x, 200.0 + 25.0 * (x * x / 9000.0).sin() + 0.1 * x)
        })
    }

    fn noisy(&self, sigma: f64, kind: Kind, random: &mut Xoshiro256PlusPlus) -> Vec<Point2> {
        let normal = Normal::new(0.0, sigma).unwrap();
        let count = self.points.len();
        let white: Vec<f64> = (0..count).map(|_| normal.sample(random)).collect();
        let across = |k: usize| {
            if kind != Kind::Shared {
                return white[k];
            }
            let weights: Vec<f64> = (-6..=6).map(|d| (-0.5 * (f64::from(d) / 1.5).powi(2)).exp()).collect();
            let size = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
            weights.iter().enumerate().map(|(d, w)| w * white[(k + count + d - 6) % count]).sum::<f64>()
                / size
        };
        (0..count)
            .map(|k| {
                let n = self.normals[k];
                let along = if kind == Kind::Both { normal.sample(random) } else { 0.0 };
                self.points[k] + n * across(k) + Vector2::new(n.y, -n.x) * along
            })
            .collect()
    }

    /// Distances of points from the truth, px: positive on the side of the normal.
    fn errors(&self, points: impl Iterator<Item = Point2>) -> Vec<f64> {
        points
            .map(|p| {
                let foot = self.finder.closest(&p).unwrap();
                let near = |q: &&(usize, &Point2)| (q.1 - foot.point).norm();
                let all: Vec<(usize, &Point2)> = self.points.iter().enumerate().collect();
                let (k, _) = all.iter().min_by(|a, b| near(a).total_cmp(&near(b))).copied().unwrap();
                (p - foot.point).dot(&self.normals[k])
            })
            .collect()
    }
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// What smoothing did to noise, over some rounds.
#[derive(Debug, Default)]
struct Outcome {
    /// Root mean square distance of the points, and of the curve at them.
    before: f64,
    after: f64,
    /// Mean distance of the curve, positive to the side of the normal.
    bias: f64,
    /// Share of points where the curve is within 1.96 of its stated standard deviations.
    covered: f64,
    /// Mean of `Smoothed::mean_square`.
    mean_square: f64,
}

/// Smooths points of a truth, their standard deviations stated `stated` times too large.
fn outcome(truth: &Truth, sigma: f64, kind: Kind, stated: f64, how: Smoothing, rounds: u32) -> Outcome {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut outcome = Outcome::default();
    let each = 1.0 / f64::from(rounds);
    for _ in 0..rounds {
        let points = truth.noisy(sigma, kind, &mut random);
        let s = Spline::near(&points, &vec![stated * sigma; points.len()], truth.closed, how).unwrap();
        let e = truth.errors(s.spline.parameters().iter().map(|t| s.spline.point(*t)));
        outcome.before += each * rms(&truth.errors(points.into_iter()));
        outcome.after += each * rms(&e);
        outcome.bias += each * mean(&e);
        let inside = e.iter().zip(&s.sigmas).filter(|(e, s)| e.abs() < 1.96 * **s).count();
        outcome.covered += each * inside as f64 / e.len() as f64;
        outcome.mean_square += each * s.mean_square;
    }
    outcome
}

fn by(choice: Choice, correlated_points: f64) -> Smoothing {
    Smoothing { choice, correlated_points }
}

/// Points that share an error under `Kind::Shared`: the sum of the autocorrelation, `2 sqrt(pi) 1.5`.
const SHARED: f64 = 5.3;

#[test]
fn noise_is_reduced_and_what_remains_is_as_large_as_is_said() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let truths = [
        ("ellipse", Truth::ellipse(&mut random), 0.27),
        ("circle of 40 px", Truth::circle(40.0, &mut random), 0.25),
        ("circle of 10 px", Truth::circle(10.0, &mut random), 0.38),
        ("open curve", Truth::snake(&mut random), 0.45),
    ];
    for (name, truth, most) in &truths {
        for sigma in [0.05, 0.1, 0.2, 0.5] {
            let o = outcome(truth, sigma, Kind::Across, 1.0, Smoothing::default(), 10);
            println!(
                "{name}: {:.3} px -> {:.4} px, bias {:+.4} px, {:.0} % covered, mean square {:.2}",
                o.before,
                o.after,
                o.bias,
                100.0 * o.covered,
                o.mean_square
            );
            assert!(o.after < most * o.before, "{name} {sigma}: {o:?}");
            // Of 95 that 1.96 standard deviations should cover, the bias not counted.
            assert!((0.88..0.995).contains(&o.covered), "{name} {sigma}: {o:?}");
            assert!((0.85..1.15).contains(&o.mean_square), "{name} {sigma}: {o:?}");
        }
    }
}

#[test]
fn a_circle_keeps_its_radius() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let circle = Truth::circle(40.0, &mut random);
    for sigma in [0.05, 0.1, 0.2, 0.5] {
        for kind in [Kind::Across, Kind::Both] {
            let o = outcome(&circle, sigma, kind, 1.0, Smoothing::default(), 60);
            println!("circle of 40 px, noise of {sigma} px ({kind:?}): bias {:+.4} px", o.bias);
            assert!(o.bias.abs() < 0.01, "{sigma} {kind:?}: {o:?}");
        }
    }
}

#[test]
fn the_risk_is_the_best_choice_and_the_safest() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let ellipse = Truth::ellipse(&mut random);
    let cases = [
        ("as stated", Kind::Across, 1.0, 1.0),
        ("stated half as large", Kind::Across, 0.5, 1.0),
        ("stated twice as large", Kind::Across, 2.0, 1.0),
        ("shared by neighbours", Kind::Shared, 1.0, 1.0),
        ("shared, and said so", Kind::Shared, 1.0, SHARED),
        ("shared, said, stated half", Kind::Shared, 0.5, SHARED),
    ];
    println!("| noise of 0.2 px | risk | discrepancy | cross-validation |");
    for (name, kind, stated, shared) in cases {
        let of = |choice| outcome(&ellipse, 0.2, kind, stated, by(choice, shared), 20).after;
        let [risk, discrepancy, cross] = [Choice::Risk, Choice::Discrepancy, Choice::CrossValidation].map(of);
        println!("| {name} | {risk:.3} | {discrepancy:.3} | {cross:.3} |");
        // Never worse than the points.
        assert!(risk < 0.18, "{name}: {risk}");
        if kind == Kind::Across {
            assert!(risk < 0.05, "{name}: {risk}");
            assert!(discrepancy > risk, "{name}: {discrepancy} {risk}");
        }
        if stated == 1.0 {
            assert!(risk < 1.02 * discrepancy.min(cross) || shared < SHARED, "{name}");
        }
    }
}

#[test]
fn noise_larger_than_stated_is_noticed() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let ellipse = Truth::ellipse(&mut random);
    let points = ellipse.noisy(0.2, Kind::Across, &mut random);
    let smoothed =
        |sigma: f64| Spline::near(&points, &vec![sigma; points.len()], true, Smoothing::default()).unwrap();
    assert!((smoothed(0.1).sigma_factor - 2.0).abs() < 0.25);
    assert!((smoothed(0.1).mean_square - 4.0).abs() < 0.6);
    // Larger ones are believed.
    assert_eq!(smoothed(0.5).sigma_factor, 1.0);
    let cross =
        Spline::near(&points, &vec![7.0; points.len()], true, by(Choice::CrossValidation, 1.0)).unwrap();
    assert!((7.0 * cross.sigma_factor - 0.2).abs() < 0.02);
}

#[test]
fn without_noise_it_goes_through_and_with_much_it_is_a_line() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    for count in [5, 40, 400, 2000] {
        let points: Vec<Point2> = (0..count)
            .map(|k| {
                let x = f64::from(k) + random.random_range(-0.3..0.3);
                Point2::new(x, 0.5 * x + 0.1 * f64::from(count) * (6.0 * x / f64::from(count)).sin())
            })
            .collect();
        let near = |sigma: f64| {
            Spline::near(&points, &vec![sigma; points.len()], false, Smoothing::default()).unwrap()
        };
        let through = Spline::through(&points, false).unwrap();
        let (none, tiny, huge) = (near(0.0).spline, near(1e-9), near(1e6));
        for k in 0..=1000 {
            let t = through.end() * f64::from(k) / 1000.0;
            assert!((none.point(t) - through.point(t)).norm() < 1e-9);
            assert!((tiny.spline.point(t) - through.point(t)).norm() < 0.01, "{count}");
        }
        // The straight line of least squares over the same parameters.
        let t = huge.spline.parameters();
        let n = t.len() as f64;
        let middle = t.iter().sum::<f64>() / n;
        let centre = points.iter().map(|p| p.coords).sum::<Vector2>() / n;
        let spread: f64 = t.iter().map(|t| (t - middle).powi(2)).sum();
        let slope =
            points.iter().zip(t).map(|(p, t)| (p.coords - centre) * (t - middle)).sum::<Vector2>() / spread;
        for t in t {
            let off = (huge.spline.point(*t).coords - centre - slope * (t - middle)).norm();
            assert!(off < 2e-4 * f64::from(count), "{count}: {off}");
        }
        assert!((huge.freedom - 2.0).abs() < 0.05, "{}", huge.freedom);
    }
}

#[test]
fn a_point_without_noise_is_met_and_one_with_much_is_passed_by() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let circle = Truth::circle(40.0, &mut random);
    let mut points = circle.noisy(0.2, Kind::Across, &mut random);
    let mut sigmas = vec![0.2; points.len()];
    sigmas[50] = 0.0;
    points[120] += circle.normals[120] * 2.0;
    sigmas[120] = 1e6;
    let smoothed = Spline::near(&points, &sigmas, true, Smoothing::default()).unwrap();
    let at = |k: usize| smoothed.spline.point(smoothed.spline.parameters()[k]);
    assert!((at(50) - points[50]).norm() < 1e-9);
    assert_eq!(smoothed.sigmas[50], 0.0);
    assert!((at(120) - circle.points[120]).norm() < 0.3);
}
