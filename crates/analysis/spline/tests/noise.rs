//! What smoothing makes of noise, on curves whose truth is known.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use biplane_geometry::{Point2, Vector2};
use biplane_spline::{Choice, FootFinder, Smoothed, Smoothing, Spline};
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

/// Errors of a smoothed curve at the parameters of its points.
fn errors(truth: &Truth, smoothed: &Smoothed) -> Vec<f64> {
    truth.errors(smoothed.spline.parameters().iter().map(|t| smoothed.spline.point(*t)))
}

#[test]
fn explore() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let truths = [
        ("ellipse", Truth::ellipse(&mut random)),
        ("circle40", Truth::circle(40.0, &mut random)),
        ("circle10", Truth::circle(10.0, &mut random)),
        ("snake", Truth::snake(&mut random)),
    ];
    for (name, truth) in &truths {
        for (kind, stated, shared) in [
            (Kind::Across, 1.0, 1.0),
            (Kind::Both, 1.0, 1.0),
            (Kind::Across, 0.5, 1.0),
            (Kind::Across, 2.0, 1.0),
            (Kind::Shared, 1.0, 1.0),
            (Kind::Shared, 1.0, 5.3),
            (Kind::Shared, 0.5, 5.3),
        ] {
            for sigma in [0.05, 0.2, 0.5] {
                let mut line = format!("{name:9} {kind:?} stated x{stated} shared {shared} sigma {sigma}:");
                for choice in [Choice::Risk, Choice::Discrepancy, Choice::CrossValidation] {
                    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
                    let (mut before, mut after, mut bias, mut worst, mut freedom, mut cover) =
                        (0.0, 0.0, 0.0, 0.0_f64, 0.0, 0.0);
                    let rounds = 10;
                    for _ in 0..rounds {
                        let points = truth.noisy(sigma, kind, &mut random);
                        let sigmas = vec![stated * sigma; points.len()];
                        let s = Spline::near(
                            &points,
                            &sigmas,
                            truth.closed,
                            Smoothing { choice, correlated_points: shared },
                        )
                        .unwrap();
                        before += rms(&truth.errors(points.into_iter())) / f64::from(rounds);
                        let e = errors(truth, &s);
                        after += rms(&e) / f64::from(rounds);
                        worst = worst.max(rms(&e));
                        bias += mean(&e) / f64::from(rounds);
                        freedom += s.freedom / f64::from(rounds);
                        let inside = e.iter().zip(&s.sigmas).filter(|(e, s)| e.abs() < 1.96 * **s).count();
                        cover += inside as f64 / e.len() as f64 / f64::from(rounds);
                    }
                    if choice == Choice::Risk {
                        line += &format!(" {before:.3} ->");
                    }
                    line += &format!(
                        " | {after:.4} (worst {worst:.3}, bias {bias:+.4}, df {freedom:.0}, cov {cover:.2})"
                    );
                }
                println!("{line}");
            }
        }
    }
}
