//! How long a surface takes: `cargo bench -p biplane-surface`. Times as shares of the limit that each is held to.

use std::time::Instant;

use biplane_geometry::{Mesh, Point3};
use biplane_phantom::{Body, mesh};
use biplane_surface::{MeshCheck, Surface, farthest, spread_points};

/// The least time of many, s.
fn least<T>(rounds: usize, mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64()
    };
    (0..rounds).map(once).fold(f64::INFINITY, f64::min)
}

fn tell(what: &str, seconds: f64, limit: f64) {
    println!("{:9.3} ms  {:5.2} of {:.3} ms  {what}", seconds * 1e3, seconds / limit, limit * 1e3);
}

fn main() {
    let Ok(femur) = mesh(Body::DistalFemur.solid(), 90_000) else { return };
    println!("{} triangles", femur.triangles().len());
    tell("check of a mesh", least(5, || MeshCheck::of(&femur)), 0.060);
    tell("tree of boxes", least(5, || Surface::new(&femur)), 0.060);
    let surface = Surface::new(&femur);
    tell("crossings of a surface with itself", least(5, || surface.self_crossings(1)), 0.3);
    let Ok(coarse) = mesh(Body::DistalFemur.solid(), 15_000) else { return };
    let near: Vec<Point3> = spread_points(&coarse, 100_000);
    let places = [("in order", near.clone()), ("in no order", shuffled(&near))];
    for (name, places) in &places {
        let per = 1e3 / places.len() as f64;
        let time = least(5, || places.iter().map(|p| surface.closest(p).distance_mm).sum::<f64>());
        tell(&format!("1,000 closest points, places {name}"), time * per, 0.002);
        let mut last = 0;
        let mut hinted = |p: &Point3| {
            let found = surface.closest_near(p, last);
            last = found.triangle;
            found.distance_mm
        };
        let time = least(5, || places.iter().map(&mut hinted).sum::<f64>());
        tell(&format!("1,000 closest points near the last, places {name}"), time * per, 0.002);
        let time = least(5, || places.iter().filter(|p| surface.contains(p)).count());
        tell(&format!("1,000 winding numbers, places {name}"), time * per, 0.002);
    }
    let other = Surface::new(&coarse);
    let both = |a: &Mesh, to: &Surface| farthest(a, to, 1e-3);
    tell("farthest point, fine from coarse, to 0.001 mm", least(3, || both(&femur, &other)), 0.4);
    tell("farthest point, coarse from fine, to 0.001 mm", least(3, || both(&coarse, &surface)), 0.4);
    let Ok(tibia) = mesh(Body::ProximalTibia.solid(), 7_500) else { return };
    let tibia = Surface::new(&tibia);
    for gap in [60.0, 45.0] {
        let turn = nalgebra::UnitQuaternion::from_scaled_axis(nalgebra::Vector3::new(0.4, 0.1, 0.2));
        let place = biplane_geometry::Pose::new(turn, nalgebra::Vector3::new(0.0, -gap, 0.0));
        let found = other.apart(&tibia, &place);
        let what = format!("distance of a femur and a tibia, {:.2} mm", found.distance_mm);
        tell(&what, least(5, || other.apart(&tibia, &place).distance_mm), 0.002);
    }
    println!(
        "at most {:.4} and {:.4} mm",
        both(&femur, &other).at_most_mm,
        both(&coarse, &surface).at_most_mm
    );
}

/// The same places in an order without sense.
fn shuffled(places: &[Point3]) -> Vec<Point3> {
    let count = places.len();
    (0..count).map(|k| places[(k * 61_803) % count]).collect()
}
