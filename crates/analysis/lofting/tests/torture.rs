//! Stacks that are hard to loft. Each becomes a closed, oriented two-manifold without crossing triangles, the same every time.

#![allow(clippy::unwrap_used, clippy::panic, dead_code)] // the helpers of tests are tests

mod made;

use biplane_artifact::{Artifact, BoneSurface, SliceContours, SliceFlag};
use biplane_geometry::Point3;
use biplane_lofting::{Caps, LoftError, LoftParams, loft, surface_of};
use biplane_phantom::Body;
use made::{Ring, assert_good, at_heights, cut, disc, ellipse, even, hole, least_angles, slice, stack};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Lofted both ways to cap, checked, and the same again; the one with caps as shaped.
fn lofted(what: &str, contours: &SliceContours) -> BoneSurface {
    let params = LoftParams::default();
    let surface = loft(contours, &params).unwrap_or_else(|e| panic!("{what}: {e}"));
    let angles = least_angles(&surface);
    println!(
        "{what}: {} triangles, least angle {:.2}, 1 % {:.1}, volume {:.1}, {} pieces {:?}",
        angles.len(),
        angles[0],
        angles[angles.len() / 100],
        surface.report.volume_mm3,
        surface.report.pieces,
        surface.report.warnings
    );
    assert_good(what, &surface);
    assert!(surface.mesh.vertices().iter().all(|v| v.iter().all(|c| c.is_finite())));
    let flat = loft(contours, &LoftParams { caps: Caps::Flat, ..params.clone() }).unwrap();
    assert_good(what, &flat);
    let [once, again] = [(); 2].map(|()| surface_of(contours, &params).unwrap().encode());
    assert_eq!(once, again, "{what}");
    surface
}

fn pieces(surface: &BoneSurface, wanted: usize) {
    assert_eq!(surface.report.pieces, wanted, "{:?}", surface.report);
}

/// Handles of a closed surface: V - E + F = 2 (pieces - handles).
fn handles(surface: &BoneSurface) -> i64 {
    let mut used = vec![false; surface.mesh.vertices().len()];
    surface.mesh.triangles().iter().flatten().for_each(|v| used[*v as usize] = true);
    let vertices = used.iter().filter(|u| **u).count() as i64;
    let triangles = surface.mesh.triangles().len() as i64;
    surface.report.pieces as i64 - (vertices - triangles / 2) / 2
}

#[test]
fn branches_of_two_and_three() {
    for step in [0.5, 1.0, 2.0, 4.0] {
        let y = at_heights(even(-20.0, step, (40.0 / step) as usize + 1), |z| {
            if z < 0.0 {
                vec![disc([50.0, 50.0], 10.0)]
            } else {
                vec![disc([44.0 - z / 4.0, 50.0], 6.0), disc([56.0 + z / 4.0, 50.0], 5.0)]
            }
        });
        let surface = lofted(&format!("Y at {step} mm"), &y);
        pieces(&surface, 1);
        assert_eq!(handles(&surface), 0);
        let trident = at_heights(even(-20.0, step, (40.0 / step) as usize + 1), |z| match z {
            z if z < 0.0 => vec![ellipse([50.0, 50.0], [20.0, 8.0], 80)],
            _ => vec![disc([35.0, 50.0], 5.0), disc([50.0, 50.0], 4.0), disc([65.0, 50.0], 5.0)],
        });
        let surface = lofted(&format!("trident at {step} mm"), &trident);
        pieces(&surface, 1);
        assert_eq!(handles(&surface), 0);
        // Two that join, around a hole that closes.
        let ring = at_heights(even(-20.0, step, (40.0 / step) as usize + 1), |z| match z {
            z if z < -8.0 => vec![disc([40.0, 50.0], 7.0), disc([60.0, 50.0], 7.0)],
            z if z < 6.0 => vec![ellipse([50.0, 50.0], [20.0, 12.0], 80), hole(disc([50.0, 50.0], 5.0))],
            _ => vec![ellipse([50.0, 50.0], [18.0, 11.0], 80)],
        });
        let surface = lofted(&format!("two, ring, one at {step} mm"), &ring);
        pieces(&surface, 1);
        assert_eq!(handles(&surface), 0, "the hole is open below and closed above");
    }
}

#[test]
fn holes_nested_ending_and_opening() {
    let nested = at_heights(even(0.0, 1.5, 20), |_| {
        vec![
            disc([50.0, 50.0], 30.0),
            hole(disc([50.0, 50.0], 20.0)),
            disc([50.0, 50.0], 14.0),
            hole(disc([50.0, 50.0], 8.0)),
            disc([50.0, 50.0], 4.0),
        ]
    });
    let surface = lofted("nested", &nested);
    pieces(&surface, 3);
    let pit = at_heights(even(0.0, 2.0, 12), |z| {
        let mut rings = vec![disc([50.0, 50.0], 20.0)];
        if z > 9.0 && z < 15.0 {
            rings.push(hole(disc([50.0, 52.0], 5.0)));
        }
        rings
    });
    let surface = lofted("a bubble", &pit);
    pieces(&surface, 2);
    let tunnel = at_heights(even(0.0, 2.0, 12), |z| {
        // A hole that becomes a notch.
        if z < 10.0 {
            return vec![disc([50.0, 50.0], 20.0), hole(disc([60.0, 50.0], 5.0))];
        }
        let mut ring: Ring = disc([50.0, 50.0], 20.0).into_iter().skip(4).take(53).collect();
        ring.extend([[60.0, 45.0], [55.0, 47.0], [55.0, 53.0], [60.0, 55.0]]);
        vec![ring]
    });
    pieces(&lofted("a hole becomes a notch", &tunnel), 1);
}

#[test]
fn beginning_ending_and_missing() {
    let condyles = at_heights(even(0.0, 3.0, 14), |z| {
        let mut rings = vec![];
        if (4.0..34.0).contains(&z) {
            rings.push(disc([40.0, 50.0], (100.0 - (z - 19.0).powi(2) / 2.5).max(1.0).sqrt()));
        }
        if (13.0..28.0).contains(&z) {
            rings.push(disc([70.0, 50.0], 6.0));
        }
        rings
    });
    pieces(&lofted("two that begin and end", &condyles), 2);
    let mut missing = at_heights(even(0.0, 2.0, 16), |z| {
        if (12.0..17.0).contains(&z) { vec![] } else { vec![disc([50.0, 50.0 + z / 5.0], 9.0)] }
    });
    pieces(&lofted("empty between", &missing), 2);
    for slice in &mut missing.slices {
        if slice.contours.is_empty() {
            slice.flags.push(SliceFlag::Lost);
        }
    }
    let bridged = lofted("lost between", &missing);
    pieces(&bridged, 1);
    assert_eq!(bridged.report.warnings.len(), 3, "{:?}", bridged.report.warnings);
    let mut others_lost =
        at_heights(even(0.0, 2.0, 3), |z| if z == 2.0 { vec![disc([50.0, 50.0], 9.0)] } else { vec![] });
    for k in [0, 2] {
        others_lost.slices[k].flags.push(SliceFlag::Lost);
    }
    pieces(&lofted("all others lost", &others_lost), 1);
    let alone =
        at_heights(even(0.0, 2.0, 5), |z| if z == 4.0 { vec![disc([50.0, 50.0], 9.0)] } else { vec![] });
    let surface = lofted("one slice of five", &alone);
    // A dome of 3/4 of the distance on both sides is as much as a slice of its thickness.
    let slab = std::f64::consts::PI * 81.0 * 2.0;
    assert!((surface.report.volume_mm3 / slab - 1.0).abs() < 0.1, "{} {slab}", surface.report.volume_mm3);
}

#[test]
fn uneven_and_sheared() {
    let mut z = 0.0;
    let heights: Vec<f64> = (0..20)
        .map(|k| {
            z += [0.5, 5.0, 1.0, 0.7, 3.3][k % 5];
            z
        })
        .collect();
    let uneven =
        at_heights(heights.clone(), |z| vec![ellipse([50.0, 50.0], [10.0 + 4.0 * (z / 7.0).sin(), 8.0], 70)]);
    pieces(&lofted("uneven", &uneven), 1);
    // The same body in slices with other origins.
    let mut sheared = uneven.clone();
    for (k, slice) in sheared.slices.iter_mut().enumerate() {
        let [dx, dy] = [7.0 * k as f64, -3.0 * k as f64];
        slice.origin_mm[0] += dx;
        slice.origin_mm[1] += dy;
        for point in slice.contours.iter_mut().flat_map(|c| &mut c.points) {
            point.i -= dx;
            point.j -= dy;
        }
    }
    let [a, b] = [&uneven, &sheared].map(|c| loft(c, &LoftParams::default()).unwrap());
    assert_eq!(a.mesh.triangles().len(), b.mesh.triangles().len());
    let worst =
        a.mesh.vertices().iter().zip(b.mesh.vertices()).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst}");
    // An oblique body seen in slices that are stacked obliquely too, and turned upside down.
    let mut tilted = uneven;
    for (k, slice) in tilted.slices.iter_mut().enumerate() {
        slice.origin_mm[0] += 2.0 * heights[k];
    }
    let up = lofted("sheared", &tilted);
    pieces(&up, 1);
    tilted.slices.reverse();
    let down = lofted("upside down", &tilted);
    assert_eq!(up.mesh.triangles().len(), down.mesh.triangles().len());
    let apart = |(p, q): (&Point3, &Point3)| (p - q).norm();
    let worst = up.mesh.vertices().iter().zip(down.mesh.vertices()).map(apart).fold(0.0, f64::max);
    assert!(worst < 1e-3, "{worst}");
    // Left-handed steps: the normal is the other way, the body is the same.
    let mut mirrored = tilted.clone();
    mirrored.row_step_mm = [0.0, -1.0, 0.0];
    for point in mirrored.slices.iter_mut().flat_map(|s| &mut s.contours).flat_map(|c| &mut c.points) {
        point.j = -point.j;
    }
    let mirrored = lofted("mirrored steps", &mirrored);
    assert!((mirrored.report.volume_mm3 / up.report.volume_mm3 - 1.0).abs() < 2e-3);
}

#[test]
fn odd_points() {
    let triangle = at_heights(even(0.0, 2.0, 8), |_| vec![vec![[40.0, 40.0], [60.0, 40.0], [50.0, 60.0]]]);
    let surface = lofted("three points", &triangle);
    assert!((surface.report.volume_mm3 / (200.0 * 14.0) - 1.0).abs() < 0.1, "{}", surface.report.volume_mm3);
    let many = at_heights(even(0.0, 2.0, 8), |_| vec![ellipse([50.0, 50.0], [15.0, 12.0], 10_000)]);
    pieces(&lofted("ten thousand points", &many), 1);
    let uneven = at_heights(even(0.0, 2.0, 8), |_| {
        let mut ring = ellipse([50.0, 50.0], [15.0, 12.0], 8);
        ring.splice(
            3..3,
            (1..100).map(|k| {
                let (sin, cos) = ((2.0 + f64::from(k) / 100.0) / 8.0 * std::f64::consts::TAU).sin_cos();
                [50.0 + 15.0 * cos, 50.0 + 12.0 * sin]
            }),
        );
        vec![ring]
    });
    pieces(&lofted("a hundred to one", &uneven), 1);
    let twice = at_heights(even(0.0, 2.0, 8), |_| {
        vec![disc([50.0, 50.0], 12.0).into_iter().flat_map(|p| [p, p, p]).chain([[62.0, 50.0]]).collect()]
    });
    pieces(&lofted("every point three times", &twice), 1);
    let far = stack(
        even(0.0, 2.0, 8)
            .into_iter()
            .map(|z| slice([1e6, -1e6, 1e6 + z], vec![disc([50.0, 50.0], 12.0)]))
            .collect(),
    );
    let near = at_heights(even(0.0, 2.0, 8), |_| vec![disc([50.0, 50.0], 12.0)]);
    let [far, near] = [lofted("at 1e6 mm", &far), lofted("near", &near)];
    assert!((far.report.volume_mm3 / near.report.volume_mm3 - 1.0).abs() < 1e-3);
}

#[test]
fn contours_that_touch_cross_and_run_the_wrong_way() {
    let touching = at_heights(even(0.0, 2.0, 8), |_| {
        let square = |x: f64| vec![[x, 40.0], [x + 10.0, 40.0], [x + 10.0, 50.0], [x, 50.0]];
        vec![square(30.0), square(40.0), vec![[50.0, 50.0], [60.0, 50.0], [60.0, 60.0], [50.0, 60.0]]]
    });
    lofted("touching squares", &touching);
    let eight =
        at_heights(even(0.0, 2.0, 8), |_| vec![vec![[30.0, 30.0], [60.0, 60.0], [60.0, 30.0], [30.0, 60.0]]]);
    let surface = lofted("figure eight", &eight);
    assert!(
        surface.report.warnings.iter().any(|w| w.starts_with("slice 0: contour 0 crosses itself")),
        "{:?}",
        surface.report.warnings
    );
    let overlapping = at_heights(even(0.0, 2.0, 8), |_| {
        vec![disc([45.0, 50.0], 10.0), disc([57.0, 50.0], 8.0), disc([50.0, 50.0], 3.0)]
    });
    let surface = lofted("overlapping", &overlapping);
    pieces(&surface, 1);
    assert_eq!(surface.report.warnings.len(), 16, "{:?}", surface.report.warnings);
    let right = at_heights(even(0.0, 2.0, 8), |_| vec![disc([45.0, 50.0], 10.0)]);
    let wrong = at_heights(even(0.0, 2.0, 8), |_| vec![hole(disc([45.0, 50.0], 10.0))]);
    let [right, wrong] = [lofted("right way", &right), lofted("wrong way", &wrong)];
    assert!((right.report.volume_mm3 / wrong.report.volume_mm3 - 1.0).abs() < 1e-3);
}

#[test]
fn thin_oblique_tubes_stay_one() {
    for (lean, step) in [(1.0, 4.0), (2.0, 4.0), (3.0, 2.0), (-2.5, 3.0)] {
        let tube = at_heights(even(0.0, step, 12), |z| {
            vec![ellipse([100.0 + lean * z, 50.0 + 0.3 * z], [2.5, 2.0], 24)]
        });
        let surface = lofted(&format!("tube leaning {lean}, {step} mm"), &tube);
        pieces(&surface, 1);
        // Its ends, of one slice and a half at most, aside it is a sheared cylinder.
        let whole = std::f64::consts::PI * 5.0 * 11.0 * step;
        let ratio = surface.report.volume_mm3 / whole;
        assert!((0.97..1.2).contains(&ratio), "{ratio}");
    }
    // Two tubes that cross over, each thin.
    let crossing = at_heights(even(0.0, 3.0, 14), |z| {
        vec![disc([30.0 + 2.0 * z, 50.0], 2.5), disc([110.0 - 2.0 * z, 62.0], 2.5)]
    });
    pieces(&lofted("two tubes passing", &crossing), 2);
}

#[test]
fn contours_far_apart_stay_apart() {
    let apart = at_heights(even(0.0, 3.0, 10), |z| {
        let mut rings = vec![disc([0.0, 0.0], 8.0), disc([300.0, 250.0], 10.0)];
        if z > 14.0 {
            rings.push(disc([18.0, 0.0], 6.0));
        }
        rings
    });
    pieces(&lofted("far apart", &apart), 3);
}

#[test]
fn bodies_of_the_phantom() {
    for body in Body::ALL {
        let solid = body.solid();
        let (low, high) = solid.bounds();
        for step in [1.0, 2.0, 4.0] {
            let count = ((high.z - low.z + 6.0) / step) as usize;
            let contours = at_heights(even(low.z - 3.0, step, count), |z| cut(solid, z, 1.2));
            lofted(&format!("{} at {step} mm", body.name()), &contours);
        }
    }
}

#[test]
fn random_blobs() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    let mut worst = f64::INFINITY;
    for case in 0..240 {
        let blobs: Vec<([f64; 3], [f64; 3], f64)> = (0..random.random_range(1..7))
            .map(|_| {
                let centre = [
                    random.random_range(20.0..60.0),
                    random.random_range(20.0..60.0),
                    random.random_range(5.0..25.0),
                ];
                let radii = [
                    random.random_range(2.0..14.0),
                    random.random_range(2.0..14.0),
                    random.random_range(2.0..12.0),
                ];
                (centre, radii, random.random_range(0.0..6.3))
            })
            .collect();
        let mut z = -10.0;
        let mut slices = Vec::new();
        while z < 40.0 {
            let mut rings = Vec::new();
            for (centre, radii, turn) in &blobs {
                let left = 1.0 - ((z - centre[2]) / radii[2]).powi(2);
                if left > 0.0 {
                    let count = random.random_range(3..60);
                    let ring: Ring = (0..count)
                        .map(|k| {
                            let a = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
                            let r = left.sqrt() * (1.0 + 0.3 * (3.0 * a + turn).sin());
                            [centre[0] + r * radii[0] * a.cos(), centre[1] + r * radii[1] * a.sin()]
                        })
                        .collect();
                    rings.push(if random.random_range(0..8) == 0 { hole(ring) } else { ring });
                }
            }
            slices.push(slice([0.0, 0.0, z], rings));
            z += if case % 3 == 0 { 1.5 } else { random.random_range(0.4..5.0) };
        }
        let contours = stack(slices);
        let params = LoftParams {
            smoothing_mm: [0.0, 1.0][case % 2],
            caps: [Caps::Shape, Caps::Flat][case / 2 % 2],
            cell_mm: [0.0, 0.0, 0.5, 2.5][case / 4 % 4],
            ..LoftParams::default()
        };
        match loft(&contours, &params) {
            Ok(surface) => {
                assert_good(&format!("blobs {case}"), &surface);
                worst = worst.min(least_angles(&surface)[0]);
                if case % 20 == 0 {
                    assert_eq!(surface.encode(), loft(&contours, &params).unwrap().encode());
                }
            }
            Err(error) => assert!(
                matches!(error, LoftError::Empty { .. } | LoftError::Small { .. }),
                "blobs {case}: {error}"
            ),
        }
    }
    println!("least angle of all {worst:.3} degrees");
}

#[test]
fn what_is_no_stack_is_named() {
    let good = || at_heights(even(0.0, 2.0, 6), |_| vec![disc([50.0, 50.0], 9.0)]);
    let error = |contours: &SliceContours| loft(contours, &LoftParams::default()).unwrap_err();
    let mut nan = good();
    nan.slices[3].contours[0].points[17].j = f64::NAN;
    assert!(
        matches!(error(&nan), LoftError::Point { slice: 3, contour: 0, point: 17, .. }),
        "{:?}",
        error(&nan)
    );
    let mut nan = good();
    nan.slices[0].contours[0].points[0].i = f64::INFINITY;
    assert!(matches!(error(&nan), LoftError::Point { slice: 0, contour: 0, point: 0, .. }));
    let mut few = good();
    few.slices[2].contours[0].points.iter_mut().skip(1).for_each(|p| (p.i, p.j) = (1.0, 2.0));
    assert!(matches!(error(&few), LoftError::Few { slice: 2, contour: 0, distinct: 2 }));
    let mut order = good();
    order.slices[4].origin_mm[2] = 3.0;
    assert!(matches!(error(&order), LoftError::Order { slice: 4 }), "{:?}", error(&order));
    let mut origin = good();
    origin.slices[1].origin_mm[0] = f64::NAN;
    assert!(matches!(error(&origin), LoftError::Origin { slice: 1, .. }));
    let mut steps = good();
    steps.row_step_mm = [2.0, 0.0, 0.0];
    assert!(matches!(error(&steps), LoftError::Steps { .. }));
    let mut single = good();
    single.slices.truncate(1);
    assert!(matches!(error(&single), LoftError::Single));
    assert!(matches!(error(&at_heights(even(0.0, 1.0, 4), |_| vec![])), LoftError::Empty { slices: 4 }));
    assert!(matches!(error(&stack(vec![])), LoftError::Empty { slices: 0 }));
    let line = at_heights(even(0.0, 2.0, 6), |_| vec![vec![[0.0, 0.0], [5.0, 0.0], [9.0, 0.0]]]);
    assert!(matches!(error(&line), LoftError::Small { .. }), "{:?}", error(&line));
    for message in [error(&nan).to_string(), error(&few).to_string(), error(&single).to_string()] {
        println!("{message}");
    }
    let params = LoftParams { cell_mm: 0.001, ..LoftParams::default() };
    assert!(matches!(loft(&good(), &params), Err(LoftError::Parameter { name: "cell_mm", .. })));
    let cut = good();
    let surface = loft(&cut, &LoftParams::default()).unwrap();
    let top = surface.mesh.vertices().iter().map(|v: &Point3| v.z).fold(0.0, f64::max);
    assert_eq!(top, 10.0, "an end of the volume where the bone goes on is flat");
}

/// Contours that no bone has: points drawn anywhere, slices lost and cut, shifted against each other.
#[test]
fn scribbles() {
    for case in 0..60 {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(case);
        let size = 10_f64.powf(random.random_range(-0.5..2.5));
        let mut z = 0.0;
        let mut slices = Vec::new();
        for _ in 0..random.random_range(2..7) {
            z += size * 10_f64.powf(random.random_range(-2.0..0.0));
            let mut rings = Vec::new();
            for _ in 0..random.random_range(0..4) {
                let centre = [(); 2].map(|()| random.random_range(0.0..size));
                let wide = size * 10_f64.powf(random.random_range(-1.5..0.0));
                // Some on a coarse lattice, where points and sides coincide.
                let step = if random.random_range(0..3) == 0 { size / 20.0 } else { size * 1e-9 };
                let point = |v: f64, random: &mut Xoshiro256PlusPlus| {
                    ((v + wide * random.random_range(-1.0..1.0)) / step).round() * step
                };
                let count = random.random_range(3..30);
                rings.push((0..count).map(|_| centre.map(|v| point(v, &mut random))).collect::<Ring>());
            }
            let mut slice = slice([random.random_range(-0.2..0.2) * size, 0.0, z], rings);
            for flag in [SliceFlag::Lost, SliceFlag::CutOff] {
                if random.random_range(0..4) == 0 {
                    slice.flags.push(flag);
                }
            }
            slices.push(slice);
        }
        let contours = stack(slices);
        let params = LoftParams {
            cell_mm: (size / 40.0).clamp(0.02, 20.0),
            smoothing_mm: [0.0, 0.5][case as usize % 2],
            caps: [Caps::Shape, Caps::Flat][case as usize / 2 % 2],
            ..LoftParams::default()
        };
        match loft(&contours, &params) {
            Ok(surface) => assert_good(&format!("scribble {case}"), &surface),
            Err(error) => println!("scribble {case}: {error}"),
        }
        // The thesis's way need not succeed, but says what is wrong.
        let diagonal = LoftParams { method: biplane_lofting::Method::Diagonal, ..params };
        if let Err(error) = loft(&contours, &diagonal) {
            println!("scribble {case}, diagonal: {error}");
        }
    }
}
