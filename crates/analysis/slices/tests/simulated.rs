//! Both bones of the simulated natural knee, from one seed each, against the meshes that made the volumes; skipped where
//! the data is not there.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::io::Read;
use std::path::PathBuf;

use biplane_artifact::{SliceContours, Volume};
use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_slices::{Method, SlicesParams, slice_contours};
use biplane_stage::Context;

/// A folder of the data, or none with a message.
fn folder(path: &str) -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data").join(path);
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: no folder shared/data/{path} beside the workspace");
    None
}

/// A gzipped NRRD of the kind that lies there: three axes, 8 or 16 bits.
fn nrrd(path: &PathBuf) -> Volume {
    let bytes = std::fs::read(path).unwrap();
    let end = bytes.windows(2).position(|w| w == b"\n\n").unwrap();
    let header = String::from_utf8(bytes[..end].to_vec()).unwrap();
    let field = |name: &str| {
        header
            .lines()
            .find_map(|l| l.strip_prefix(name)?.strip_prefix(": "))
            .unwrap_or_else(|| panic!("{name}"))
    };
    let vector = |text: &str| -> [f64; 3] {
        let parts = text.trim_matches(['(', ')']).split(',').map(|p| p.parse().unwrap());
        parts.collect::<Vec<f64>>().try_into().unwrap()
    };
    let sizes: Vec<usize> = field("sizes").split(' ').map(|s| s.parse().unwrap()).collect();
    let steps: Vec<[f64; 3]> = field("space directions").split(' ').map(vector).collect();
    let origin = vector(field("space origin"));
    let mut data = Vec::new();
    flate2::read::GzDecoder::new(&bytes[end + 2..]).read_to_end(&mut data).unwrap();
    let samples = match field("type") {
        "uint16" => data.chunks(2).map(|b| f32::from(u16::from_le_bytes([b[0], b[1]]))).collect(),
        _ => data.iter().map(|&b| f32::from(b)).collect(),
    };
    let slice = |k: usize| std::array::from_fn(|a| origin[a] + k as f64 * steps[2][a]);
    Volume {
        columns: sizes[0],
        rows: sizes[1],
        column_step_mm: steps[0],
        row_step_mm: steps[1],
        origins_mm: (0..sizes[2]).map(slice).collect(),
        samples,
    }
}

/// A binary STL.
fn stl(path: &PathBuf) -> Mesh {
    let bytes = std::fs::read(path).unwrap();
    let number = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()));
    let corners: Vec<[Point3; 3]> = (0..(bytes.len() - 84) / 50)
        .map(|t| {
            std::array::from_fn(|c| {
                Point3::from(std::array::from_fn(|a| number(84 + 50 * t + 12 + 12 * c + 4 * a)))
            })
        })
        .collect();
    Mesh::from_soup(&corners).unwrap()
}

/// Triangles by the cubes of 3 mm that they touch, grown by one cube: nearer than that a distance is exact.
struct Near<'a> {
    mesh: &'a Mesh,
    low: Point3,
    size: [usize; 3],
    cubes: Vec<Vec<u32>>,
}

const CUBE_MM: f64 = 3.0;

impl<'a> Near<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let (low, high) = mesh.bounding_box();
        let low = low - Vector3::repeat(2.0 * CUBE_MM);
        let size: [usize; 3] = std::array::from_fn(|a| ((high[a] - low[a]) / CUBE_MM) as usize + 4);
        let mut near = Self { mesh, low, size, cubes: vec![Vec::new(); size.iter().product()] };
        for t in 0..mesh.triangles().len() {
            let corners = mesh.corners(t).map(|p| near.cube(&p));
            let least: [usize; 3] =
                std::array::from_fn(|a| corners.map(|c| c[a]).into_iter().min().unwrap() - 1);
            let most: [usize; 3] =
                std::array::from_fn(|a| corners.map(|c| c[a]).into_iter().max().unwrap() + 1);
            for k in least[2]..=most[2] {
                for j in least[1]..=most[1] {
                    for i in least[0]..=most[0] {
                        near.cubes[(k * size[1] + j) * size[0] + i].push(t as u32);
                    }
                }
            }
        }
        near
    }

    fn cube(&self, p: &Point3) -> [usize; 3] {
        std::array::from_fn(|a| (((p[a] - self.low[a]) / CUBE_MM).max(0.0) as usize).min(self.size[a] - 1))
    }

    /// Distance from the surface, negative inside; at most a cube's side is exact, what is farther counts as that.
    fn distance(&self, p: &Point3) -> f64 {
        let [i, j, k] = self.cube(p);
        let mut best = (CUBE_MM, 1.0);
        for &t in &self.cubes[(k * self.size[1] + j) * self.size[0] + i] {
            let foot = foot(p, self.mesh.corners(t as usize));
            let away = p - foot;
            if away.norm() < best.0 {
                best = (away.norm(), away.dot(&self.mesh.area_vector(t as usize)).signum());
            }
        }
        best.0 * best.1
    }
}

/// Nearest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
fn foot(p: &Point3, [a, b, c]: [Point3; 3]) -> Point3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let all = va + vb + vc;
    a + ab * (vb / all) + ac * (vc / all)
}

fn distances(contours: &SliceContours, mesh: &Mesh) -> Vec<f64> {
    let near = Near::new(mesh);
    let each = |k: usize| (0..contours.slices[k].contours.len()).flat_map(move |c| contours.points_mm(k, c));
    (0..contours.slices.len()).flat_map(each).map(|p| near.distance(&Point3::from(p))).collect()
}

#[test]
fn both_bones_of_the_simulated_knee_are_found_from_one_seed_each() {
    let Some(folder) = folder("simulated/knee-natural") else { return };
    for (bone, seed) in [("femur", [-4.0, 0.0, 20.0]), ("tibia", [2.0, 0.0, -25.0])] {
        let volume = nrrd(&folder.join(format!("mri/{bone}.nrrd")));
        let mesh = stl(&folder.join(format!("models/{bone}_15000.stl")));
        let params = SlicesParams { method: Method::Bone, seed_mm: Some(seed), ..SlicesParams::default() };
        let contours = slice_contours(&volume, &params, &Context::new()).unwrap();
        let off = distances(&contours, &mesh);
        let mut sizes: Vec<f64> = off.iter().map(|d| d.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let at = |share: f64| sizes[((sizes.len() - 1) as f64 * share) as usize];
        let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let (median, most, worst) = (at(0.5), at(0.95), at(1.0));
        println!(
            "{bone}: {} points, mean {mean:+.3}, rms {rms:.3}, median {median:.3}, 95 % {most:.3}, worst {worst:.3} mm",
            off.len()
        );
        // Measured 0.056 and 0.51 (femur), 0.051 and 0.33 (tibia); what is asked for is an rms of 0.15.
        assert!(rms < 0.08 && worst < 0.8, "{bone}: rms {rms}, worst {worst} mm");
    }
}

/// A legacy VTK file of triangles, as text.
fn vtk(path: &PathBuf) -> Mesh {
    let text = std::fs::read_to_string(path).unwrap();
    let numbers = |after: &str| -> Vec<f64> {
        let at = text.find(after).unwrap() + after.len();
        let lines = text[at..].split_once('\n').unwrap().1;
        lines.split_whitespace().map_while(|w| w.parse().ok()).collect()
    };
    let points = numbers("POINTS").chunks(3).map(|p| Point3::new(p[0], p[1], p[2])).collect();
    let triangles =
        numbers("CONNECTIVITY").chunks(3).map(|t| [t[0] as u32, t[1] as u32, t[2] as u32]).collect();
    Mesh::new(points, triangles).unwrap()
}

#[test]
fn the_tibia_of_a_real_map_of_labels_lies_where_a_third_party_has_it() {
    let Some(folder) = folder("real/knee-mri") else { return };
    let volume = nrrd(&folder.join("knee-labels.nrrd"));
    let params = SlicesParams { label: 6, ..SlicesParams::default() };
    let contours = slice_contours(&volume, &params, &Context::new()).unwrap();
    // Between the centres of voxels inside and outside: about every centre a contour runs as often as the label says.
    for k in (0..volume.origins_mm.len()).step_by(9) {
        let rings: Vec<Vec<[f64; 2]>> = contours.slices[k]
            .contours
            .iter()
            .map(|c| c.points.iter().map(|p| [p.i, p.j]).collect())
            .collect();
        for (v, sample) in volume.slice(k).unwrap().iter().enumerate() {
            let [i, j] = [(v % volume.columns) as f64, (v / volume.columns) as f64];
            let right = |ring: &Vec<[f64; 2]>| {
                let sides = ring.iter().zip(ring.iter().cycle().skip(1));
                let crosses = sides.filter(|(p, q)| (p[1] <= j) != (q[1] <= j));
                crosses.filter(|(p, q)| p[0] + (j - p[1]) / (q[1] - p[1]) * (q[0] - p[0]) > i).count()
            };
            let odd = rings.iter().map(right).sum::<usize>() % 2 == 1;
            assert_eq!(odd, *sample == 6.0, "slice {k}, voxel {i}, {j}");
        }
    }
    // The data's README: that mesh lies 0.19 to 0.22 mm in the median, 0.40 mm at 95 %, from the label's surface.
    let mesh = vtk(&folder.join("tibia_mesh.vtk"));
    let mut sizes: Vec<f64> = distances(&contours, &mesh).into_iter().map(f64::abs).collect();
    sizes.sort_by(f64::total_cmp);
    let at = |share: f64| sizes[((sizes.len() - 1) as f64 * share) as usize];
    println!("tibia: {} points, median {:.3}, 95 % {:.3} mm from the mesh", sizes.len(), at(0.5), at(0.95));
    assert!(at(0.5) < 0.25 && at(0.95) < 0.45, "{} {}", at(0.5), at(0.95));
}
