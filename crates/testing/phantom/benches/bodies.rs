//! How long the bodies' meshes and ideal outlines take on one core. `cargo bench -p biplane-phantom --bench bodies` prints it.

use std::time::Instant;

use biplane_geometry::{Pose, Vector3};
use biplane_phantom::{Body, biplane, ideal_outline, mesh};
use nalgebra::UnitQuaternion;

fn main() {
    let views = biplane(90.0);
    for body in Body::ALL {
        for points in [3_500, 15_000, 36_000, 200_000] {
            let begin = Instant::now();
            match mesh(body.solid(), points) {
                Ok(mesh) => println!(
                    "{} of {} points: {:.3} s",
                    body.name(),
                    mesh.vertices().len(),
                    begin.elapsed().as_secs_f64()
                ),
                Err(e) => println!("{}: {e}", body.name()),
            }
        }
        let begin = Instant::now();
        let (mut outlines, mut points) = (0.0, 0);
        for k in 0..5 {
            let turn = UnitQuaternion::from_euler_angles(0.3 * f64::from(k), -0.2, 0.5 * f64::from(k));
            let pose = Pose::new(turn, Vector3::new(5.0, -10.0, 8.0));
            for view in &views {
                outlines += 1.0;
                points += ideal_outline(body.solid(), &pose, view, 0.5)
                    .iter()
                    .map(|c| c.points.len())
                    .sum::<usize>();
            }
        }
        let each = begin.elapsed().as_secs_f64() / outlines;
        println!(
            "{}: {each:.3} s an outline in one view, {:.0} points in the mean",
            body.name(),
            points as f64 / outlines
        );
    }
}
