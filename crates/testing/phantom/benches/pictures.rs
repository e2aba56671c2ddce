//! How long a picture takes on one core: 1024 x 1024, two bodies of 200,706 points with a cortical shell each (four meshes
//! of 401,408 triangles), a limb's soft tissue, every fault on. `cargo bench -p biplane-phantom` prints it with its parts.

use std::sync::Arc;
use std::time::Instant;

use biplane_geometry::{Mesh, Point3, Pose, Twist, Vector2, Vector3};
use biplane_phantom::{
    Absorber, Ellipsoid, Exposure, IntensifierDistortion, Material, PosedBody, Scene, Surface, Transmission,
    biplane,
};
use nalgebra::UnitQuaternion;

/// A lumpy ball: an octahedron whose sides are parted in `n`, its points moved out.
fn lump(radius: f64, n: usize) -> Mesh {
    let place = |corners: &[Vector3; 3], i: usize, j: usize| {
        let (s, t) = (i as f64 / n as f64, j as f64 / n as f64);
        let v = (corners[0] * (1.0 - s - t) + corners[1] * s + corners[2] * t).normalize();
        Point3::from(v * radius * (1.0 + 0.2 * (3.0 * v.x).sin() * (2.0 * v.z).cos()))
    };
    let mut soup = Vec::new();
    for octant in 0..8 {
        let side = |axis: usize| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 };
        let mut corners = [Vector3::x() * side(0), Vector3::y() * side(1), Vector3::z() * side(2)];
        if side(0) * side(1) * side(2) < 0.0 {
            corners.swap(1, 2);
        }
        for i in 0..n {
            for j in 0..n - i {
                let at = |di: usize, dj: usize| place(&corners, i + di, j + dj);
                soup.push([at(0, 0), at(1, 0), at(0, 1)]);
                if i + j + 1 < n {
                    soup.push([at(1, 0), at(1, 1), at(0, 1)]);
                }
            }
        }
    }
    Mesh::from_soup(&soup).unwrap_or_else(|e| unreachable!("a ball is a mesh: {e}"))
}

/// The least time of five, s.
fn least<T>(mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64()
    };
    (0..5).map(once).fold(f64::INFINITY, f64::min)
}

fn main() {
    let (outer, inner) = (Arc::new(lump(35.0, 224)), Arc::new(lump(32.5, 224)));
    let body = |z: f64| {
        let absorbers = vec![
            Absorber::new(Surface::Mesh(outer.clone()), Material::CorticalBone, Material::SoftTissue),
            Absorber::new(Surface::Mesh(inner.clone()), Material::TrabecularBone, Material::CorticalBone),
        ];
        let pose = Pose::new(UnitQuaternion::from_euler_angles(0.4, z, 1.0), Vector3::new(3.0, 5.0, z));
        let velocity =
            Twist { translation: Vector3::new(120.0, 30.0, -60.0), rotation: Vector3::new(0.0, 1.5, 0.0) };
        PosedBody { velocity, ..PosedBody::at_rest(pose, absorbers) }
    };
    let tissue = Ellipsoid {
        centre: Point3::origin(),
        semi_axes: Vector3::new(62.0, 58.0, f64::INFINITY),
        attenuation_per_mm: Material::SoftTissue.attenuation_per_mm(),
    };
    let scene = Scene { bodies: vec![body(38.0), body(-38.0)], tissue: vec![tissue] };
    let view = &biplane(70.0)[0];
    let distortion = IntensifierDistortion {
        pincushion_px: 12.0,
        s_shape_px: 6.0,
        shift_px: Vector2::new(1.0, -2.0),
        ..IntensifierDistortion::none(view.size)
    };
    let all = Exposure { distortion: Some(distortion), ..Exposure::fluoroscopy() };

    let radiation = |exposure: &Exposure| least(|| Transmission::of_scene(&scene, view, exposure));
    let still = Exposure { time_s: 0.0, distortion: None, ..all.clone() };
    let bare = Scene { tissue: Vec::new(), ..scene.clone() };
    println!("{:6.3} s  through bodies", least(|| Transmission::of_scene(&bare, view, &still)));
    println!("{:6.3} s  with soft tissue", radiation(&still));
    println!("{:6.3} s  and distortion", radiation(&Exposure { time_s: 0.0, ..all.clone() }));
    println!("{:6.3} s  and motion over {} moments", radiation(&all), all.moments);
    match Transmission::of_scene(&scene, view, &all) {
        Ok(through) => println!(
            "{:6.3} s  recording: blur, scatter, noise, grey levels",
            least(|| all.record(&through, 1))
        ),
        Err(error) => println!("{error}"),
    }
    println!("{:6.3} s  all of a picture", least(|| biplane_phantom::picture(&scene, view, &all, 1)));
}
