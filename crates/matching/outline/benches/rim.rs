//! How long an outline takes: `cargo bench -p biplane-outline`. Balls of three sizes of mesh in two views, beside the floor: a plain loop
//! over all faces and edges that says which edges are on the rim, and nothing else.

use std::time::Instant;

use biplane_artifact::Calibration;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_outline::{Outline, RimMesh, Sampling};

/// The least time of many, s.
fn least<T>(rounds: usize, mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64()
    };
    (0..rounds).map(once).fold(f64::INFINITY, f64::min)
}

/// A ball of radius 40 mm with `n` rings and `2 n` sectors, its triangles in bands round it.
fn ball(n: usize) -> Option<Mesh> {
    let point = |i: usize, j: usize| {
        let turn = |k: usize| std::f64::consts::PI * k as f64 / n as f64;
        let (a, b) = (turn(i), turn(j % (2 * n)));
        if i == 0 || i == n {
            return Point3::new(0.0, 0.0, if i == 0 { 40.0 } else { -40.0 });
        }
        Point3::new(40.0 * a.sin() * b.cos(), 40.0 * a.sin() * b.sin(), 40.0 * a.cos())
    };
    let cell = |i: usize, j: usize| {
        let (p, q, r, s) = (point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
        [[p, q, r], [p, r, s]]
    };
    let soup: Vec<[Point3; 3]> = (0..n).flat_map(|i| (0..2 * n).flat_map(move |j| cell(i, j))).collect();
    Mesh::from_soup(&soup).ok()
}

/// What the rim of all triangles costs at least: which faces look at the source, and the edges between those that do and do not.
struct Floor {
    planes: [Vec<f64>; 4],
    sides: Vec<[u32; 2]>,
    facing: Vec<bool>,
}

impl Floor {
    fn of(mesh: &Mesh) -> Self {
        let mut planes = [const { Vec::new() }; 4];
        for t in 0..mesh.triangles().len() {
            let n = mesh.area_vector(t);
            let row = [n.x, n.y, n.z, n.dot(&mesh.corners(t)[0].coords)];
            planes.iter_mut().zip(row).for_each(|(list, v)| list.push(v));
        }
        let edges = biplane_surface::Edges::of(mesh);
        let sides = edges.iter().filter(|(_, h)| h.len() == 2).map(|(_, h)| [h[0] / 3, h[1] / 3]).collect();
        Self { planes, sides, facing: Vec::new() }
    }

    fn rim(&mut self, source: &Point3) -> usize {
        let [x, y, z, d] = &self.planes;
        self.facing.clear();
        self.facing.extend(
            x.iter()
                .zip(y)
                .zip(z)
                .zip(d)
                .map(|(((x, y), z), d)| x * source.x + y * source.y + z * source.z > *d),
        );
        self.sides.iter().filter(|s| self.facing[s[0] as usize] != self.facing[s[1] as usize]).count()
    }
}

fn main() {
    let view = |source: [f64; 3], matrix: [[f64; 3]; 3]| {
        Fluoroscope::from(&Calibration {
            view: "A".to_owned(),
            size: [1000, 1000],
            source,
            matrix,
            distortion: None,
        })
    };
    let views = [
        view([0.0, 0.0, -1000.0], [[4000.0, 0.0, 500.0], [0.0, 4000.0, 500.0], [0.0, 0.0, 1.0]]),
        view([-1000.0, 0.0, 0.0], [[500.0, 4000.0, 0.0], [500.0, 0.0, 4000.0], [1.0, 0.0, 0.0]]),
    ];
    let poses: Vec<Pose> = (0..50)
        .map(|k| {
            let turn =
                nalgebra::UnitQuaternion::from_euler_angles(0.1 * f64::from(k), 0.7, 0.05 * f64::from(k));
            Pose::new(turn, Vector3::new(f64::from(k), 5.0, 2.0))
        })
        .collect();
    let per = 1e6 / poses.len() as f64;
    println!("us a pose, both views; times the floor");
    for rings in [42, 87, 134] {
        let Some(mesh) = ball(rings) else { return };
        let prepared = 1e3 * least(5, || RimMesh::new(&mesh));
        let mut floor = Floor::of(&mesh);
        let floor = per
            * least(40, || {
                let sources = |pose: &Pose| views.each_ref().map(|v| pose.inverse().transform(v.source()));
                poses.iter().flat_map(sources).map(|s| floor.rim(&s)).sum::<usize>()
            });
        println!(
            "{} points: floor {floor:.1}; a mesh is prepared in {prepared:.1} ms",
            mesh.vertices().len()
        );
        for (name, rim) in [("flat", RimMesh::flat(&mesh)), ("curved", RimMesh::new(&mesh))] {
            let mut outline = Outline::lean();
            let mut time = |spacing: f64| {
                per * least(40, || {
                    let mut sum = 0.0;
                    for (pose, view) in poses.iter().flat_map(|p| views.iter().map(move |v| (p, v))) {
                        outline.trace_thinned(&rim, pose, view, Sampling { step_px: 1000.0 }, spacing);
                        // The row of each point: its normal speed by the six of the pose.
                        for point in outline.points() {
                            if let Some((_, by_point)) = view.project_with_derivative(&point.world) {
                                let gradient = by_point.transpose() * point.normal;
                                sum += gradient.x + point.world.coords.cross(&gradient).x;
                            }
                        }
                    }
                    sum
                })
            };
            let (alone, whole) = (time(f64::INFINITY), time(0.0));
            println!(
                "    {name}: rim {alone:.1} ({:.1}), visible outline with its derivative {whole:.1} ({:.1})",
                alone / floor,
                whole / floor
            );
        }
    }
}
