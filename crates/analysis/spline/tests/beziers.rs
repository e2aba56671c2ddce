//! Splines as chains of Bezier curves, and back to points.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use biplane_geometry::{Point2, Vector2};
use biplane_spline::{Bezier, FlattenError, FootFinder, Piece, Smoothing, Spline, flatten};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_xoshiro::Xoshiro256PlusPlus;

fn at(curve: &Bezier, s: f64) -> Point2 {
    let r = 1.0 - s;
    let weights = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
    Point2::from(curve.iter().zip(weights).map(|(p, w)| p.coords * w).sum::<Vector2>())
}

/// Pieces of smoothed noisy outlines like those of bones: an ellipse, a bean with a narrow end, an open stretch.
fn outlines() -> Vec<Piece> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    let noise = Normal::new(0.0, 0.2).unwrap();
    let mut all = Vec::new();
    for (a, b, bean) in [(100.0, 60.0, 0.0), (90.0, 40.0, 0.3), (30.0, 28.0, 0.0)] {
        for closed in [true, false] {
            let count = (std::f64::consts::PI * (a + b)) as usize;
            let points: Vec<Point2> = (0..count)
                .map(|k| {
                    let u = std::f64::consts::TAU * k as f64 / count as f64;
                    let r = 1.0 + bean * (2.0 * u).cos() + noise.sample(&mut random) / a;
                    Point2::new(400.0 + a * r * u.cos(), 300.0 + b * r * u.sin())
                })
                .collect();
            let spline =
                Spline::near(&points, &vec![0.2; count], closed, Smoothing::default()).unwrap().spline;
            // Neither end on a knot.
            let end = spline.end();
            all.push(Piece::new(spline.clone(), 0.3 * end + 0.123, 0.8 * end + 0.456).unwrap());
            if closed {
                all.push(Piece::new(spline.clone(), 0.8 * end + 0.123, 0.3 * end + 0.456).unwrap());
            }
            all.push(Piece::whole(spline));
        }
    }
    all
}

fn assert_chain(curves: &[Bezier], piece: &Piece) {
    let [from, to] = piece.trusted();
    let spline = piece.spline();
    assert!((curves[0][0] - spline.point(from)).norm() < 1e-9);
    assert!((curves[curves.len() - 1][3] - spline.point(to)).norm() < 1e-9);
    for w in curves.windows(2) {
        assert!((w[0][3] - w[1][0]).norm() < 1e-9);
        // No corner at a node.
        let (before, after) = ((w[0][3] - w[0][2]).normalize(), (w[1][1] - w[1][0]).normalize());
        assert!((before - after).norm() < 1e-6);
    }
}

#[test]
fn every_cubic_is_a_bezier_curve_exactly() {
    for piece in outlines() {
        let curves = piece.beziers();
        assert_chain(&curves, &piece);
        let [from, to] = piece.trusted();
        let spline = piece.spline();
        let inner = spline.parameters().iter().filter(|t| {
            let t = if **t <= from { **t + spline.end() } else { **t };
            t > from + 1e-9 && t < to - 1e-9
        });
        assert_eq!(curves.len(), inner.count() + 1, "one for each cubic that the trusted part touches");
        let finder = FootFinder::of(spline);
        for curve in &curves {
            for k in 0..=4 {
                assert!(finder.closest(&at(curve, f64::from(k) / 4.0)).unwrap().distance < 1e-9);
            }
        }
    }
}

#[test]
fn fewer_curves_stay_within_the_tolerance_with_nodes_far_apart() {
    for piece in outlines() {
        let fit = piece.fewer_beziers(60.0, 0.05);
        assert_chain(&fit.curves, &piece);
        let finder = FootFinder::new(std::slice::from_ref(&piece));
        let [from, to] = piece.trusted();
        let apart = (to - from) / fit.curves.len() as f64;
        println!(
            "{:4.0} px: {} curves, {apart:.0} px each, within {:.4} px",
            to - from,
            fit.curves.len(),
            fit.error
        );
        assert!(apart > 15.0 && apart < 65.0, "{apart}");
        let mut worst = 0.0_f64;
        let mut dense = Vec::new();
        for curve in &fit.curves {
            dense.extend((0..2000).map(|k| at(curve, f64::from(k) / 2000.0)));
        }
        for p in &dense {
            worst = worst.max(finder.closest(p).unwrap().distance);
        }
        // What it says is what it found at a place a pixel; between them it may be a little more.
        assert!(worst <= 1.05 * fit.error + 1e-6 && fit.error <= 0.05, "{worst} {}", fit.error);
        // The spline is nowhere far from the chain.
        for k in 0..=300 {
            let p = piece.spline().point(from + (to - from) * f64::from(k) / 300.0);
            let least = dense.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
            assert!(least < 0.06, "{least}");
        }
    }
}

#[test]
fn a_tolerance_that_one_curve_cannot_keep_takes_more_and_none_at_all_takes_all() {
    for piece in outlines() {
        let count = |longest: f64, tolerance: f64| {
            let fit = piece.fewer_beziers(longest, tolerance);
            assert!(fit.error <= tolerance.max(0.0));
            fit.curves.len()
        };
        assert!(count(60.0, 0.005) >= count(60.0, 0.05) && count(60.0, 0.05) >= count(200.0, 0.5));
        for (longest, tolerance) in [(60.0, 0.0), (60.0, f64::NAN), (0.0, 1.0), (f64::NAN, 0.0)] {
            assert_eq!(piece.fewer_beziers(longest, tolerance).curves.len(), piece.beziers().len());
        }
    }
}

#[test]
fn a_straight_line_is_one_curve() {
    let points: Vec<Point2> = (0..50).map(|k| Point2::new(f64::from(k), 2.0 * f64::from(k))).collect();
    let fit = Piece::whole(Spline::through(&points, false).unwrap()).fewer_beziers(200.0, 0.05);
    assert_eq!(fit.curves.len(), 1);
    assert!(fit.error < 1e-9);
}

#[test]
fn points_of_a_chain_are_near_each_other_and_their_lines_near_the_curve() {
    for piece in outlines() {
        let fit = piece.fewer_beziers(60.0, 0.05);
        for (step, tolerance) in [(1.0, 0.01), (30.0, 0.01), (0.3, 1.0)] {
            let points = flatten(&fit.curves, step, tolerance, piece.is_loop()).unwrap();
            let exact: Vec<Point2> =
                fit.curves.iter().flat_map(|c| (0..2000).map(|k| at(c, f64::from(k) / 2000.0))).collect();
            let sides = points.windows(2).map(|w| (w[0], w[1]));
            let seam = piece.is_loop().then(|| (points[points.len() - 1], points[0]));
            for (a, b) in sides.chain(seam) {
                assert!((b - a).norm() <= step + 1e-9);
                assert!(b != a);
                let middle = Point2::from((a.coords + b.coords) / 2.0);
                let off = exact.iter().map(|p| (p - middle).norm()).fold(f64::INFINITY, f64::min);
                // The samples are less than 0.06 px apart.
                assert!(off < tolerance.hypot(0.03), "{off}");
            }
            assert!(fit.curves.iter().all(|c| points.contains(&c[0])));
        }
    }
}

#[test]
fn chains_that_people_draw_are_no_trouble() {
    let p = Point2::new;
    // Handles drawn in, as for a straight line: not evenly run through.
    let line = [p(0.0, 0.0), p(0.0, 0.0), p(10.0, 0.0), p(10.0, 0.0)];
    let points = flatten(&[line], 1.0, 0.01, false).unwrap();
    assert!(points.windows(2).all(|w| w[1].x > w[0].x && w[1].x - w[0].x <= 1.0));
    assert_eq!((points[0], points[points.len() - 1]), (line[0], line[3]));
    // A node twice, a closed chain, a gap.
    let dot = [p(10.0, 0.0); 4];
    assert_eq!(flatten(&[line, dot], 1.0, 0.01, false).unwrap(), points);
    let back = [p(10.0, 0.0), p(10.0, 9.0), p(0.0, 9.0), p(0.0, 0.0)];
    let closed = flatten(&[line, back], 1.0, 0.01, true).unwrap();
    assert!(closed.first() != closed.last());
    let open = flatten(&[line, back], 1.0, 0.01, false).unwrap();
    assert_eq!((open.len(), open.first()), (closed.len() + 1, open.last()));
    assert_eq!(flatten(&[], 1.0, 0.01, true), Ok(Vec::new()));
    assert_eq!(flatten(&[dot], 1.0, 0.01, true), Ok(vec![dot[0]]));
    // What cannot be.
    let far = [p(0.0, 0.0), p(1e8, 0.0), p(2e8, 0.0), p(3e8, 0.0)];
    assert!(matches!(flatten(&[line, far], 1.0, 0.01, false), Err(FlattenError::TooLong { index: 1, .. })));
    let nan = [p(0.0, 0.0), p(f64::NAN, 0.0), p(2.0, 0.0), p(3.0, 0.0)];
    assert!(matches!(flatten(&[line, nan], 1.0, 0.01, false), Err(FlattenError::NotAPlace { index: 1, .. })));
    for (step, tolerance) in [(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0)] {
        assert!(matches!(flatten(&[line], step, tolerance, false), Err(FlattenError::Limits { .. })));
    }
}
