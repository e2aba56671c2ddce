//! Analytic solids lofted from their exact contours: how far the surface is from them, both ways, as the spacing is refined.

#![allow(clippy::unwrap_used, dead_code)] // the helpers of tests are tests

mod made;

use biplane_artifact::BoneSurface;
use biplane_geometry::{Point3, Vector3};
use biplane_lofting::{Caps, LoftError, LoftParams, Method, loft};
use biplane_phantom::{Ball, DistalFemur, ProximalTibia, Solid, gradient, mesh};
use biplane_surface::{Spread, Surface};
use made::{assert_good, at_heights, cut, ellipse, even, hole};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// An ellipsoid, turned.
struct Egg;

impl Solid for Egg {
    fn value(&self, p: &Point3) -> f64 {
        let (sin, cos) = 0.5_f64.sin_cos();
        let q = Vector3::new(p.x, cos * p.y - sin * p.z, sin * p.y + cos * p.z);
        let k0 = Vector3::new(q.x / 26.0, q.y / 17.0, q.z / 21.0).norm();
        let k1 = Vector3::new(q.x / 676.0, q.y / 289.0, q.z / 441.0).norm();
        k0 * (k0 - 1.0) / k1.max(1e-12)
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::new(-26.0, -22.0, -22.0), Point3::new(26.0, 22.0, 22.0))
    }
}

/// Distance of a point near the surface, to the first order.
fn off(solid: &dyn Solid, p: &Point3) -> f64 {
    solid.value(p) / gradient(solid, p).norm().max(0.1)
}

/// How steep the surface stands on the slices: 1 where it is upright, 0 where it lies in them.
fn upright(solid: &dyn Solid, p: &Point3) -> f64 {
    let g = gradient(solid, p);
    (g.x.hypot(g.y)) / g.norm().max(1e-9)
}

fn order(spacings: &[f64], errors: &[f64]) -> f64 {
    let n = spacings.len() as f64;
    let (x, y): (Vec<f64>, Vec<f64>) = spacings.iter().zip(errors).map(|(h, e)| (h.ln(), e.ln())).unzip();
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let above: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    above / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>()
}

#[test]
fn the_error_falls_with_the_square_of_the_spacing() {
    let ball = Ball { centre: Point3::new(0.3, -0.2, 0.1), radius: 20.0 };
    let solids: [(&str, &dyn Solid); 4] =
        [("ball", &ball), ("egg", &Egg), ("femur", &DistalFemur), ("tibia", &ProximalTibia)];
    let spacings = [2.8, 2.0, 1.4, 1.0];
    for (name, solid) in solids {
        let truth = mesh(solid, 20_000).unwrap();
        let (low, high) = solid.bounds();
        let mut there = Vec::new();
        let mut back = Vec::new();
        for h in spacings {
            let count = ((high.z - low.z + 6.0) / h) as usize + 1;
            let contours = at_heights(even(low.z - 3.0, h, count), |z| cut(solid, z, h / 2.0));
            let surface = loft(&contours, &LoftParams::default()).unwrap();
            assert_good(name, &surface);
            // Neither at the ends of the body nor where a part of it ends or branches: there the surface lies along the slices.
            let away = |p: &Point3| upright(solid, p) > 0.7 && p.z > low.z + 6.0 && p.z < high.z - 6.0;
            let all: Vec<f64> = surface.mesh.vertices().iter().map(|p| off(solid, p).abs()).collect();
            let vertices = surface.mesh.vertices().iter().filter(|p| away(p));
            let some: Vec<f64> = vertices.map(|p| off(solid, p).abs()).collect();
            let tree = Surface::new(&surface.mesh);
            let points = truth.vertices().iter().filter(|p| away(p));
            let returned: Vec<f64> = points.map(|p| tree.closest(p).distance_mm).collect();
            let show = |s: &Spread| format!("{:.4} / {:.4} / {:.4}", s.median, s.p95, s.worst);
            let (all, some, returned) = (Spread::of(&all), Spread::of(&some), Spread::of(&returned));
            println!(
                "{name}, {h} mm: all {}, away from ends {}, back {}",
                show(&all),
                show(&some),
                show(&returned)
            );
            assert!(some.rms < 0.0085 * h * h && returned.rms < 0.0095 * h * h, "{name}, {h} mm");
            there.push(some);
            back.push(returned);
        }
        for (way, of) in [("there", &there), ("back", &back)] {
            let by = |f: fn(&Spread) -> f64| order(&spacings, &of.iter().map(f).collect::<Vec<f64>>());
            let [median, p95, rms] = [by(|s| s.median), by(|s| s.p95), by(|s| s.rms)];
            println!("{name}, {way}: order {median:.2} in the median, {p95:.2} at 95 %, {rms:.2} rms");
            assert!(median >= 1.8 && p95 >= 1.8 && rms >= 1.8, "{name}, {way}");
        }
    }
}

#[test]
fn ends_close_as_the_shape_suggests() {
    // Balls whose poles lie anywhere between two slices, and what a flat lid would leave of them.
    for step in [1.0, 2.0, 4.0] {
        for part in [0.1, 0.35, 0.6, 0.85] {
            let ball = Ball { centre: Point3::new(0.0, 0.0, part * step), radius: 20.0 };
            let contours = at_heights(even(-32.0, step, (64.0 / step) as usize), |z| cut(&ball, z, 0.5));
            let [shaped, flat] = [Caps::Shape, Caps::Flat].map(|caps| {
                let surface = loft(&contours, &LoftParams { caps, ..LoftParams::default() }).unwrap();
                assert_good("ball", &surface);
                surface
            });
            let error = |surface: &BoneSurface| {
                let top = surface.mesh.vertices().iter().map(|v| v.z).fold(f64::MIN, f64::max);
                let bottom = surface.mesh.vertices().iter().map(|v| v.z).fold(f64::MAX, f64::min);
                (top - ball.centre.z - 20.0).abs().max((bottom - ball.centre.z + 20.0).abs())
            };
            let worst = shaped.mesh.vertices().iter().map(|p| off(&ball, p).abs()).fold(0.0, f64::max);
            println!(
                "ball, {step} mm, {part}: poles off by {:.3} mm, with flat lids {:.3}; worst {worst:.3} mm",
                error(&shaped),
                error(&flat)
            );
            assert!(error(&shaped) < 0.02 + 0.05 * step && worst < 0.02 + 0.075 * step, "{worst}");
        }
    }
}

#[test]
fn smoothing_takes_off_what_slices_do_not_share_and_keeps_the_volume() {
    let solid = DistalFemur;
    let (low, high) = solid.bounds();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let count = ((high.z - low.z + 6.0) / 2.0) as usize;
    let mut contours = at_heights(even(low.z - 3.0, 2.0, count), |z| cut(&solid, z, 0.7));
    for slice in &mut contours.slices {
        // Moved, and in or out on two sides.
        let [dx, dy, wider] = [(); 3].map(|()| random.random_range(-0.4..0.4));
        for point in slice.contours.iter_mut().flat_map(|c| &mut c.points) {
            point.i += dx + wider * point.i / 30.0;
            point.j += dy;
        }
    }
    let [plain, smooth] = [0.0, 0.4].map(|smoothing_mm| {
        let surface = loft(&contours, &LoftParams { smoothing_mm, ..LoftParams::default() }).unwrap();
        assert_good("femur", &surface);
        let vertices = surface.mesh.vertices().iter().filter(|p| p.z < 48.0);
        let errors: Vec<f64> = vertices.map(|p| off(&solid, p).abs()).collect();
        (Spread::of(&errors).rms, surface.report)
    });
    println!("{:.3} mm rms, smoothed {:.3}", plain.0, smooth.0);
    assert!(smooth.0 < 0.85 * plain.0);
    assert_eq!(plain.1.volume_mm3, plain.1.unsmoothed_volume_mm3);
    assert!((smooth.1.unsmoothed_volume_mm3 / plain.1.volume_mm3 - 1.0).abs() < 1e-9);
    assert!((smooth.1.volume_mm3 / smooth.1.unsmoothed_volume_mm3 - 1.0).abs() < 1e-6, "{:?}", smooth.1);
}

#[test]
fn diagonals_close_a_tube_and_say_what_they_leave_out() {
    let params = LoftParams { method: Method::Diagonal, ..LoftParams::default() };
    let tube = at_heights(even(0.0, 2.0, 20), |z| {
        let ring = ellipse([50.0 + 0.2 * z, 50.0], [12.0 + z / 10.0, 9.0], 60 + (z as usize % 7));
        if (z as usize).is_multiple_of(4) { vec![hole(ring)] } else { vec![ring] }
    });
    let surface = loft(&tube, &params).unwrap();
    assert_good("tube", &surface);
    assert!(surface.report.warnings.is_empty(), "{:?}", surface.report.warnings);
    // Flat lids: from the first slice to the last.
    let exact: f64 =
        (0..380).map(|k| std::f64::consts::PI * (12.0 + (f64::from(k) + 0.5) / 100.0) * 9.0 * 0.1).sum();
    assert!((surface.report.volume_mm3 / exact - 1.0).abs() < 4e-3, "{} {exact}", surface.report.volume_mm3);
    let open = LoftParams { closed: false, gap_mm: 3.0, ..params.clone() };
    let surface = loft(&tube, &open).unwrap();
    assert!(
        surface.report.faults.iter().any(|f| f.what.starts_with("open along an edge") && f.slice == Some(0))
    );
    let branching = at_heights(even(0.0, 2.0, 8), |z| {
        let mut rings = vec![ellipse([50.0, 50.0], [12.0, 9.0], 60)];
        if z > 5.0 && z < 13.0 {
            rings.push(ellipse([80.0, 50.0], [5.0, 5.0], 30));
        }
        if z == 2.0 {
            rings.push(ellipse([20.0, 50.0], [5.0, 5.0], 30));
        }
        rings
    });
    let surface = loft(&branching, &params).unwrap();
    println!("{:#?}", surface.report.warnings);
    assert_good("branching", &surface);
    assert_eq!(surface.report.pieces, 2);
    let said = |what: &str| surface.report.warnings.iter().any(|w| w == what);
    assert!(said("slice 1: contour 1 has no partner in a slice beside it and is left out"));
    assert!(said("slice 3: contour 1 has no partner in the slice before it and is closed there"));
    assert!(said("slice 6: contour 1 has no partner in the slice behind it and is closed there"));
    let alone =
        at_heights(
            even(0.0, 2.0, 3),
            |z| if z == 2.0 { vec![ellipse([0.0; 2], [5.0; 2], 9)] } else { vec![] },
        );
    assert!(matches!(loft(&alone, &params), Err(LoftError::NoNeighbours { slice: 1 })));
}
