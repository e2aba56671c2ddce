//! How long splines take on one core: `cargo bench -p biplane-spline`. A frame is 20 curves of 500 points about a pixel apart.

use std::time::Instant;

use biplane_geometry::{Point2, Vector2};
use biplane_spline::{ArcLength, FootFinder, Piece, Smoothing, Spline};
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, Normal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// The least time of many, s.
fn least<T>(rounds: usize, mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64()
    };
    (0..rounds).map(once).fold(f64::INFINITY, f64::min)
}

/// A wobbly loop of points a pixel apart with noise of 0.2 px.
fn wobbly(count: usize, random: &mut Xoshiro256PlusPlus) -> Vec<Point2> {
    let Ok(noise) = Normal::new(0.0, 0.2) else { return Vec::new() };
    let radius = count as f64 / std::f64::consts::TAU;
    let phase = random.random_range(0.0..6.0);
    let middle = Vector2::new(random.random_range(200.0..800.0), random.random_range(200.0..800.0));
    (0..count)
        .map(|k| {
            let a = std::f64::consts::TAU * k as f64 / count as f64;
            let r = radius * (1.0 + 0.1 * (3.0 * a + phase).sin()) + noise.sample(random);
            Point2::new(r * a.cos(), r * a.sin()) + middle
        })
        .collect()
}

/// Distance of a place from the sides of a polyline, all of them looked at.
fn scan(points: &[Point2], place: &Point2) -> f64 {
    let square = |w: &[Point2]| {
        let (along, off) = (w[1] - w[0], place - w[0]);
        let t = (off.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (off - along * t).norm_squared()
    };
    points.windows(2).map(square).fold(f64::INFINITY, f64::min).sqrt()
}

fn main() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let curves: Vec<(Vec<Point2>, bool)> = (0..20).map(|k| (wobbly(500, &mut random), k % 2 == 0)).collect();
    let sigmas = [0.2; 500];
    let near =
        |(points, closed): &(Vec<Point2>, bool)| Spline::near(points, &sigmas, *closed, Smoothing::default());
    let through = |(points, closed): &(Vec<Point2>, bool)| Spline::through(points, *closed);
    println!("frame of 20 curves x 500 points");
    let time = least(15, || curves.iter().map(through).collect::<Vec<_>>());
    println!("{:8.2} ms  through all points", time * 1e3);
    let time = least(15, || curves.iter().map(near).collect::<Vec<_>>());
    println!("{:8.2} ms  near them, smoothing chosen", time * 1e3);
    let pieces: Vec<Piece> =
        curves.iter().filter_map(|c| near(c).ok()).map(|s| Piece::whole(s.spline)).collect();
    let time = least(15, || FootFinder::new(&pieces));
    println!("{:8.2} ms  finder of closest points", time * 1e3);
    let time = least(15, || pieces.iter().map(|p| ArcLength::new(p.spline()).total()).sum::<f64>());
    println!("{:8.2} ms  arc lengths", time * 1e3);
    let beziers = || pieces.iter().map(|p| p.fewer_beziers(60.0, 0.05)).collect::<Vec<_>>();
    let time = least(3, beziers);
    let fits = beziers();
    let count: usize = fits.iter().map(|f| f.curves.len()).sum();
    let error = fits.iter().map(|f| f.error).fold(0.0, f64::max);
    println!("{:8.2} ms  {count} Bezier curves for editing, largest error {error:.4} px", time * 1e3);

    let points = wobbly(1000, &mut random);
    let Ok(smoothed) = Spline::near(&points, &[0.2; 1000], true, Smoothing::default()) else { return };
    let spline = smoothed.spline;
    let finder = FootFinder::of(&spline);
    println!("closest point of 1,000 cubics");
    for (name, reach) in [("within 20 px", 20.0), ("within 2 px", 2.0), ("anywhere", 1000.0)] {
        // In order along the curve, as the points of an outline come.
        let places: Vec<Point2> = (0..2000)
            .map(|k| {
                let near = spline.point(spline.end() * f64::from(k) / 2000.0);
                near + Vector2::new(random.random_range(-reach..reach), random.random_range(-reach..reach))
            })
            .collect();
        let per = 1e9 / places.len() as f64;
        let tree = per
            * least(15, || places.iter().filter_map(|p| finder.closest(p)).map(|f| f.distance).sum::<f64>());
        let plain = per * least(5, || places.iter().map(|p| scan(&points, p)).sum::<f64>());
        println!(
            "{tree:8.0} ns  {name}; {plain:.0} ns a scan of all sides, {:.0} times as long",
            plain / tree
        );
    }
    let round: Vec<Point2> = (0..1000)
        .map(|k| std::f64::consts::TAU * f64::from(k) / 1000.0)
        .map(|a| Point2::new(160.0 * a.cos(), 160.0 * a.sin()))
        .collect();
    let Ok(circle) = Spline::through(&round, true) else { return };
    let finder = FootFinder::of(&circle);
    let time = least(15, || finder.closest(&Point2::origin()));
    println!("{:8.0} ns  at the centre of a circle, where all of it is equally near", time * 1e9);
}
