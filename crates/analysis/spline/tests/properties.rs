//! What a spline must be, on seeded random curves: smooth over its knots and its seam, the same wherever it lies, and with the right
//! closest points.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use biplane_geometry::{Point2, Vector2};
use biplane_spline::{ArcLength, FootFinder, Piece, PieceError, PointsError, Smoothing, Spline};
use nalgebra::Rotation2;
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, Normal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A wobbly loop about a place, `radius` px wide, with noise.
fn wobbly(count: usize, radius: f64, noise: f64, random: &mut Xoshiro256PlusPlus) -> Vec<Point2> {
    let waves: Vec<[f64; 2]> = (2..7)
        .map(|k| [random.random_range(0.0..0.5) / f64::from(k), random.random_range(0.0..6.0)])
        .collect();
    let noise = Normal::new(0.0, noise).unwrap();
    (0..count)
        .map(|i| {
            let a = std::f64::consts::TAU * i as f64 / count as f64;
            let wave = |(k, [size, phase]): (usize, &[f64; 2])| size * ((k + 2) as f64 * a + phase).sin();
            let r = radius * (1.0 + 0.5 * waves.iter().enumerate().map(wave).sum::<f64>());
            Point2::new(
                200.0 + r * a.cos() + noise.sample(random),
                300.0 + 0.7 * r * a.sin() + noise.sample(random),
            )
        })
        .collect()
}

fn random(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

/// Splines of all kinds.
fn splines(seed: u64) -> Vec<Spline> {
    let mut random = random(seed);
    let mut all = Vec::new();
    for (count, radius) in [(3, 20.0), (4, 20.0), (5, 9.0), (40, 60.0), (300, 50.0), (1000, 160.0)] {
        for closed in [true, false] {
            let points = wobbly(count, radius, 0.2, &mut random);
            all.push(Spline::through(&points, closed).unwrap());
            all.push(Spline::near(&points, &vec![0.2; count], closed, Smoothing::default()).unwrap().spline);
        }
    }
    all.push(Spline::through(&[Point2::new(1.0, 2.0), Point2::new(4.0, -2.0)], false).unwrap());
    all
}

#[test]
fn a_spline_goes_through_its_points() {
    let mut random = random(1);
    for closed in [true, false] {
        let points = wobbly(200, 60.0, 0.3, &mut random);
        let spline = Spline::through(&points, closed).unwrap();
        assert_eq!(spline.parameters().len(), 200);
        for (p, t) in points.iter().zip(spline.parameters()) {
            assert!((spline.point(*t) - p).norm() < 1e-12);
        }
        // The parameter is the cumulative chord length.
        assert!((spline.parameters()[1] - (points[1] - points[0]).norm()).abs() < 1e-12);
    }
}

#[test]
fn values_are_those_of_scipy() {
    // scipy 1.17.1: CubicSpline(t, points, bc_type="natural") and "periodic", t the cumulative chord length; value and both derivatives.
    let points =
        [(0.0, 0.0), (3.0, 4.0), (3.0, 10.0), (-5.0, 16.0), (-11.0, 8.0)].map(|(x, y)| Point2::new(x, y));
    let expected = [
        (
            false,
            2.0,
            [
                1.3726590538336052,
                1.5150407830342576,
                0.6534420880913541,
                0.7737030995106037,
                -0.04933115823817291,
                0.024274061990212148,
            ],
        ),
        (
            false,
            9.5,
            [
                3.4644066068515498,
                8.458982463295268,
                -0.20181484502446978,
                1.0338295269168025,
                -0.14168026101141928,
                -0.0017128874388254722,
            ],
        ),
        (
            false,
            26.25,
            [
                -8.560431382544861,
                13.052895799347471,
                -0.563944942903752,
                -0.910062805872757,
                0.03180097879282217,
                -0.09707667210440454,
            ],
        ),
        (
            true,
            2.0,
            [
                1.4981386015793738,
                1.2374291034347027,
                0.6520710719749044,
                0.7820585721739184,
                -0.09858576551145505,
                0.1350193171666996,
            ],
        ),
        (
            true,
            9.5,
            [
                3.4127676168790306,
                8.511108476837277,
                -0.17812561276872899,
                0.9985502554748634,
                -0.12703632624539796,
                -0.0063912728034279725,
            ],
        ),
        (
            true,
            26.25,
            [
                -9.517036337611845,
                13.03272912007674,
                -0.6518640852455879,
                -0.9149312040052187,
                0.1128158801141337,
                -0.09524785601937368,
            ],
        ),
    ];
    for (closed, t, [x, y, dx, dy, ddx, ddy]) in expected {
        let spline = Spline::through(&points, closed).unwrap();
        assert!((spline.point(t) - Point2::new(x, y)).norm() < 1e-12);
        assert!((spline.derivative(t) - Vector2::new(dx, dy)).norm() < 1e-12);
        assert!((spline.second_derivative(t) - Vector2::new(ddx, ddy)).norm() < 1e-12);
    }
}

#[test]
fn two_derivatives_are_the_same_on_both_sides_of_knots_and_seam() {
    for spline in splines(2) {
        let end = spline.end();
        let knots =
            spline.parameters().iter().copied().filter(|t| spline.is_closed() || (*t > 0.0 && *t < end));
        for t in knots {
            let (before, after) = (t - 1e-9, t + 1e-9);
            // Over 2e-9 px a curve whose second derivative stays below 1e3 changes by less than this.
            assert!((spline.point(before) - spline.point(after)).norm() < 1e-7);
            assert!((spline.derivative(before) - spline.derivative(after)).norm() < 1e-5);
            let jump = (spline.second_derivative(before) - spline.second_derivative(after)).norm();
            assert!(jump < 1e-5, "{jump} at {t} of {end}");
        }
        if spline.is_closed() {
            for t in [0.0, 0.3, 17.0] {
                assert!((spline.point(t) - spline.point(t + end)).norm() < 1e-9);
                assert!((spline.derivative(t) - spline.derivative(t - end)).norm() < 1e-9);
                assert!(
                    (spline.second_derivative(t) - spline.second_derivative(t + 2.0 * end)).norm() < 1e-8
                );
            }
        } else {
            assert!(
                spline.second_derivative(0.0).norm() < 1e-9 && spline.second_derivative(end).norm() < 1e-9
            );
            assert_eq!(spline.point(-5.0), spline.point(0.0));
            assert_eq!(spline.point(end + 5.0), spline.point(end));
        }
    }
}

#[test]
fn a_moved_curve_has_the_moved_spline() {
    let mut random = random(3);
    for closed in [true, false] {
        let points = wobbly(150, 40.0, 0.3, &mut random);
        let sigmas: Vec<f64> = (0..150).map(|_| random.random_range(0.1..0.5)).collect();
        let (turn, shift) = (Rotation2::new(1.1), Vector2::new(-40.0, 75.0));
        let moved: Vec<Point2> = points.iter().map(|p| turn * p + shift).collect();
        let pairs = [
            (Spline::through(&points, closed).unwrap(), Spline::through(&moved, closed).unwrap()),
            (
                Spline::near(&points, &sigmas, closed, Smoothing::default()).unwrap().spline,
                Spline::near(&moved, &sigmas, closed, Smoothing::default()).unwrap().spline,
            ),
        ];
        for (one, two) in pairs {
            for k in 0..400 {
                let t = one.end() * f64::from(k) / 400.0;
                assert!((turn * one.point(t) + shift - two.point(t)).norm() < 1e-8);
                assert!((turn * one.normal(t).unwrap() - two.normal(t).unwrap()).norm() < 1e-8);
                assert!((one.curvature(t).unwrap() - two.curvature(t).unwrap()).abs() < 1e-7);
            }
        }
    }
}

#[test]
fn normal_and_curvature_of_a_circle() {
    let points: Vec<Point2> = (0..100)
        .map(|k| std::f64::consts::TAU * f64::from(k) / 100.0)
        .map(|a| Point2::new(40.0 * a.cos(), 40.0 * a.sin()))
        .collect();
    let spline = Spline::through(&points, true).unwrap();
    for k in 0..100 {
        let t = spline.end() * f64::from(k) / 100.0;
        // From x towards y: the centre is on the normal's side.
        assert!((spline.normal(t).unwrap() + spline.point(t).coords / 40.0).norm() < 1e-3);
        assert!((spline.curvature(t).unwrap() - 1.0 / 40.0).abs() < 1e-4);
    }
}

#[test]
fn natural_ends_are_off_by_little_and_not_far() {
    // An arc of 20 px radius, points a pixel apart.
    let points: Vec<Point2> =
        (0..60).map(|k| f64::from(k) / 20.0).map(|a| Point2::new(20.0 * a.cos(), 20.0 * a.sin())).collect();
    let spline = Spline::through(&points, false).unwrap();
    let off = |t: f64| (spline.point(t).coords.norm() - 20.0).abs();
    let worst = |from: f64, to: f64| {
        (0..1000).map(|k| off(from + (to - from) * f64::from(k) / 1000.0)).fold(0.0, f64::max)
    };
    println!(
        "within a pixel of the end {:.5} px, 3 to 4 px from it {:.6} px",
        worst(0.0, 1.0),
        worst(3.0, 4.0)
    );
    assert!(worst(0.0, 1.0) < 0.003 && worst(3.0, 4.0) < 1e-4);
}

#[test]
fn arc_length_is_that_of_a_circle_and_of_a_fine_sum() {
    // A spline through 720 points of a circle is off by less than (2 pi / 720)^4 / 384 of its radius.
    let points: Vec<Point2> = (0..720)
        .map(|k| f64::from(k).to_radians() / 2.0)
        .map(|a| Point2::new(40.0 * a.cos(), 40.0 * a.sin()))
        .collect();
    let circle = Spline::through(&points, true).unwrap();
    let length = ArcLength::new(&circle);
    assert!((length.total() / (80.0 * std::f64::consts::PI) - 1.0).abs() < 1e-10);
    for spline in splines(4) {
        let length = ArcLength::new(&spline);
        // Richardson's extrapolation of sums of chords, whose error goes with the square of the step.
        let sum = |n: u32| -> f64 {
            let mut sum = 0.0;
            // Knots are ends of steps, so that every step is on one cubic.
            let mut knots: Vec<f64> = spline.parameters().to_vec();
            if spline.is_closed() {
                knots.push(spline.end());
            }
            for w in knots.windows(2) {
                let at = |k: u32| {
                    let s = f64::from(k) / f64::from(n);
                    // Not beyond the end of a closed one.
                    spline.point(w[0] + (w[1] - w[0]) * s)
                };
                sum += (0..n).map(|k| (at(k + 1) - at(k)).norm()).sum::<f64>();
            }
            sum
        };
        let (coarse, fine) = (sum(1000), sum(2000));
        let extrapolated = fine + (fine - coarse) / 3.0;
        assert!((length.total() / extrapolated - 1.0).abs() < 1e-9, "{} {extrapolated}", length.total());
        for share in [0.0, 0.1, 0.5, 0.77, 1.0] {
            let wanted = share * length.total();
            let t = length.parameter(wanted);
            assert!((length.at(t) - wanted).abs() < 1e-9 * length.total());
            assert!((length.point(wanted) - spline.point(t)).norm() < 1e-12);
        }
    }
}

/// The closest of many samples, made finer around the best ones.
fn brute_force(piece: &Piece, place: &Point2) -> f64 {
    let [from, to] = piece.trusted();
    let spline = piece.spline();
    let count = 40 * spline.parameters().len();
    let step = (to - from) / count as f64;
    let distance = |t: f64| (spline.point(t) - place).norm();
    let sampled: Vec<f64> = (0..=count).map(|k| distance(from + step * k as f64)).collect();
    let least = sampled.iter().copied().fold(f64::INFINITY, f64::min);
    let mut best = least;
    for (k, d) in sampled.iter().enumerate().filter(|(_, d)| **d < least + 2.0 * step) {
        let (mut low, mut high) =
            (from + step * k.saturating_sub(1) as f64, (from + step * (k + 1) as f64).min(to));
        for _ in 0..60 {
            let third = (high - low) / 3.0;
            if distance(low + third) < distance(high - third) { high -= third } else { low += third }
        }
        best = best.min(distance(0.5 * (low + high))).min(*d);
    }
    best
}

#[test]
fn the_closest_point_is_that_of_brute_force() {
    let mut random = random(5);
    for spline in splines(6) {
        let end = spline.end();
        let closed = spline.is_closed();
        let mut pieces = vec![Piece::whole(spline.clone())];
        for _ in 0..3 {
            let (a, b) = (random.random_range(0.0..end), random.random_range(0.0..end));
            let (a, b) = if closed { (a, b) } else { (a.min(b), a.max(b)) };
            pieces.push(Piece::new(spline.clone(), a, b).unwrap());
        }
        for piece in pieces {
            let finder = FootFinder::new(std::slice::from_ref(&piece));
            for k in 0..25 {
                let near = spline.point(random.random_range(0.0..end));
                let reach = if k % 3 == 0 { 200.0 } else { 20.0 };
                let place = near
                    + Vector2::new(random.random_range(-reach..reach), random.random_range(-reach..reach));
                let foot = finder.closest(&place).unwrap();
                let expected = brute_force(&piece, &place);
                assert!(foot.distance <= expected + 1e-9, "{} {expected}", foot.distance);
                assert!(
                    (foot.distance - expected).abs() < 1e-9 * (1.0 + expected),
                    "{} {expected}",
                    foot.distance
                );
                assert!((foot.distance - (foot.point - place).norm()).abs() < 1e-12);
                assert!((spline.point(foot.t) - foot.point).norm() < 1e-9);
                let [from, to] = piece.trusted();
                let t = if foot.t < from - 1e-9 { foot.t + end } else { foot.t };
                assert!(t >= from - 1e-9 && t <= to + 1e-9, "{t} is not in {from}..{to}");
                assert_eq!(finder.closest_within(&place, foot.distance * 1.001 + 1e-9).unwrap(), foot);
                assert!(finder.closest_within(&place, foot.distance * 0.999).is_none());
            }
        }
    }
}

#[test]
fn a_circles_centre_is_as_far_as_its_nearest_point() {
    let points: Vec<Point2> = (0..360)
        .map(|k| f64::from(k).to_radians())
        .map(|a| Point2::new(50.0 + 40.0 * a.cos(), 60.0 + 40.0 * a.sin()))
        .collect();
    let piece = Piece::whole(Spline::through(&points, true).unwrap());
    let foot = FootFinder::of(piece.spline()).closest(&Point2::new(50.0, 60.0)).unwrap();
    assert!((foot.distance - 40.0).abs() < 1e-6);
    assert!(foot.distance <= brute_force(&piece, &Point2::new(50.0, 60.0)) + 1e-9);
}

#[test]
fn of_several_pieces_the_nearest_trusted_part_counts() {
    let line = |y: f64| {
        let points: Vec<Point2> = (0..11).map(|k| Point2::new(f64::from(k), y)).collect();
        Spline::through(&points, false).unwrap()
    };
    let pieces = [
        Piece::between_points(line(0.0), 2, 4).unwrap(),
        Piece::new(line(3.0), 6.0, 9.0).unwrap(),
        Piece::whole(line(100.0)),
    ];
    let finder = FootFinder::new(&pieces);
    let foot = finder.closest(&Point2::new(1.0, 1.0)).unwrap();
    // The first point is not trusted.
    assert_eq!((foot.piece, foot.point), (0, Point2::new(2.0, 0.0)));
    let foot = finder.closest(&Point2::new(7.5, 1.0)).unwrap();
    assert_eq!((foot.piece, foot.t), (1, 7.5));
    assert_eq!(finder.closest(&Point2::new(50.0, 99.0)).unwrap().piece, 2);
    assert!(finder.closest(&Point2::new(f64::NAN, 1.0)).is_none());
    assert!(FootFinder::new(&[]).closest(&Point2::origin()).is_none());
    // One point alone is a trusted part as well.
    let one = Piece::between_points(line(0.0), 10, 10).unwrap();
    assert_eq!(FootFinder::new(&[one]).closest(&Point2::new(10.0, 2.0)).unwrap().distance, 2.0);
}

#[test]
fn a_trusted_part_may_run_through_the_seam_and_not_further() {
    let points = wobbly(50, 30.0, 0.0, &mut random(8));
    let spline = Spline::through(&points, true).unwrap();
    let end = spline.end();
    let piece = Piece::between_points(spline.clone(), 45, 5).unwrap();
    let finder = FootFinder::new(std::slice::from_ref(&piece));
    assert!(finder.closest(&points[0]).unwrap().distance < 1e-12);
    assert!(finder.closest(&points[25]).unwrap().distance > 5.0);
    assert!(!piece.is_loop() && Piece::whole(spline.clone()).is_loop());
    for k in 1..50 {
        // Once round from any point.
        let from = spline.parameters()[k];
        let round = Piece::new(spline.clone(), from, from + end).unwrap();
        assert!(FootFinder::new(&[round]).closest(&points[k / 2]).unwrap().distance < 1e-12);
    }
    assert!(matches!(Piece::new(spline.clone(), 1.0, end + 2.0), Err(PieceError::Outside { .. })));
    assert!(matches!(Piece::new(spline.clone(), f64::NAN, 1.0), Err(PieceError::Outside { .. })));
    assert!(matches!(Piece::between_points(spline, 3, 50), Err(PieceError::NoSuchPoint { count: 50, .. })));
    let open = Spline::through(&points, false).unwrap();
    assert!(matches!(Piece::new(open, 5.0, 4.0), Err(PieceError::Outside { .. })));
}

#[test]
fn points_that_coincide_count_once_and_what_is_no_curve_is_refused() {
    let p = |x: f64, y: f64| Point2::new(x, y);
    let square = [p(0.0, 0.0), p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(1.0, 1.0), p(0.0, 1.0), p(0.0, 0.0)];
    let spline = Spline::through(&square, true).unwrap();
    assert_eq!(spline.parameters(), [0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 0.0]);
    assert_eq!(spline.end(), 4.0);
    let smoothed = Spline::near(&square, &[0.1; 7], true, Smoothing::default()).unwrap();
    assert_eq!(smoothed.sigmas.len(), 7);
    let too_few = |points: &[Point2], closed| {
        let sigmas = vec![1.0; points.len()];
        let near = Spline::near(points, &sigmas, closed, Smoothing::default()).map(|_| ());
        assert_eq!(Spline::through(points, closed).map(|_| ()), near);
        matches!(near, Err(PointsError::TooFew { .. }))
    };
    assert!(too_few(&[], false) && too_few(&[], true));
    assert!(too_few(&[p(1.0, 1.0); 5], false) && too_few(&[p(1.0, 1.0); 5], true));
    assert!(too_few(&[p(0.0, 0.0), p(1.0, 0.0)], true) && !too_few(&[p(0.0, 0.0), p(1.0, 0.0)], false));
    let bad = [p(0.0, 0.0), p(f64::NAN, 1.0), p(2.0, 0.0)];
    assert!(matches!(Spline::through(&bad, false), Err(PointsError::NotAPlace { index: 1, .. })));
    let far = [p(0.0, 0.0), p(1.0, 1.0), p(2e300, 0.0)];
    assert!(matches!(Spline::through(&far, false), Err(PointsError::NotAPlace { index: 2, .. })));
    let near = |sigmas: &[f64]| Spline::near(&square[2..6], sigmas, true, Smoothing::default()).map(|_| ());
    assert!(matches!(near(&[1.0; 3]), Err(PointsError::Count { points: 4, sigmas: 3 })));
    assert!(matches!(near(&[1.0, -1.0, 1.0, 1.0]), Err(PointsError::NotASigma { index: 1, .. })));
    assert!(matches!(near(&[1.0, 1.0, 1.0, f64::NAN]), Err(PointsError::NotASigma { index: 3, .. })));
}

#[test]
fn no_input_makes_it_panic_or_leave_the_picture() {
    let mut random = random(9);
    for round in 0..3000 {
        let count = random.random_range(0..40);
        let size = 10.0_f64.powf(random.random_range(-40.0..8.5));
        // Coarse places: many coincide, run back, or lie on a line.
        let points: Vec<Point2> = (0..count)
            .map(|_| {
                let mut v = || size * f64::from(random.random_range(-3..4));
                Point2::new(v(), v())
            })
            .collect();
        let sigmas: Vec<f64> = (0..count)
            .map(|_| {
                if random.random_bool(0.2) {
                    0.0
                } else {
                    10.0_f64.powf(random.random_range(if round % 3 == 0 { -200.0 } else { -9.0 }..8.9))
                }
            })
            .collect();
        let closed = round % 2 == 0;
        let smoothed = match Spline::near(&points, &sigmas, closed, Smoothing::default()) {
            Ok(smoothed) => smoothed,
            Err(e) => {
                assert!(matches!(e, PointsError::TooFew { .. }), "{e}: {points:?} {sigmas:?}");
                continue;
            }
        };
        let spline = smoothed.spline;
        assert!(smoothed.sigmas.iter().all(|s| s.is_finite()) && smoothed.freedom.is_finite());
        for k in 0..20 {
            let p = spline.point(spline.end() * f64::from(k) / 19.0);
            assert!(p.x.is_finite() && p.y.is_finite());
            assert!(p.coords.amax() < 1e3 * size, "{p} of {points:?} {sigmas:?}");
        }
        let foot = FootFinder::of(&spline).closest(&Point2::new(size, 0.3 * size)).unwrap();
        assert!(foot.distance.is_finite());
        let piece = Piece::whole(spline);
        assert!(piece.fewer_beziers(60.0, 0.05).error <= 0.05);
        let length = ArcLength::new(piece.spline());
        assert!(length.point(0.5 * length.total()).coords.amax() < 1e3 * size);
    }
}
