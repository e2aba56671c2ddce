//! A bone whose model was cut through its shaft, against outlines of the whole bone, whose shaft goes on.

#![allow(clippy::unwrap_used)] // a test whose set-up fails has failed

use std::collections::BTreeSet;

use biplane_artifact::{Calibration, Curves, Match, ModelMesh, Start, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Mesh, Point3, Pose, Twist, Vector3};
use biplane_optimisation::{EdgeBias, MatchBody, MatchInputs, MatchParams};
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_phantom::{Body, biplane, ideal_outline, mesh};
use biplane_stage::{Context, Hashed, Stage};
use nalgebra::UnitQuaternion;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A mesh below the plane `z = height`, closed there by a fan: corners of triangles that reach beyond are put onto the plane.
fn cut_at(whole: &Mesh, height: f64) -> Mesh {
    let below = |v: &u32| whole.vertices()[*v as usize].z < height;
    let mut kept: Vec<[u32; 3]> = whole.triangles().iter().filter(|t| t.iter().any(below)).copied().collect();
    let sides = |t: &[u32; 3]| [0, 1, 2].map(|k| (t[k], t[(k + 1) % 3]));
    let all: BTreeSet<(u32, u32)> = kept.iter().flat_map(sides).collect();
    let rim: Vec<(u32, u32)> = all.iter().filter(|(a, b)| !all.contains(&(*b, *a))).copied().collect();
    let mut vertices: Vec<Point3> =
        whole.vertices().iter().map(|v| Point3::new(v.x, v.y, v.z.min(height))).collect();
    let middle = rim.iter().map(|(a, _)| vertices[*a as usize].coords).sum::<Vector3>() / rim.len() as f64;
    let centre = vertices.len() as u32;
    vertices.push(middle.into());
    kept.extend(rim.iter().map(|(a, b)| [*b, *a, centre]));
    let soup: Vec<[Point3; 3]> = kept.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
    Mesh::from_soup(&soup).unwrap()
}

/// How far beyond the model's cut end something else has an edge, px.
const BESIDE_PX: f64 = 1.0;
/// Edges of the noisy pictures are off by up to this, px.
const NOISE_PX: f64 = 1.0;

#[test]
fn a_bone_cut_through_its_shaft_is_matched_better_without_its_cut_end() {
    let solid = Body::DistalFemur.solid();
    let whole = mesh(solid, 6000).unwrap();
    let (low, high) = whole.bounding_box();
    let height = low.z + 0.55 * (high.z - low.z);
    let cut = cut_at(&whole, height);
    assert!(cut.topology().open_edges == 0);
    let (centroid, rim) = (cut.area_centroid(), RimMesh::new(&cut));
    let fluoroscopes = biplane(80.0);
    let calibrations: Vec<Hashed<Calibration>> =
        fluoroscopes.iter().zip(["A", "B"]).map(|(view, name)| Hashed::new(view.calibration(name))).collect();
    let model = Hashed::new(ModelMesh(cut));
    // One context for all: the two ways to prepare one mesh must not be taken for each other.
    let context = Context::new();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    let mut doubted = 0;
    for number in 0..4 {
        let k = f64::from(number);
        let turn = UnitQuaternion::from_euler_angles(0.3 - 0.1 * k, 0.2 * k - 0.3, 0.5 + 0.8 * k);
        let pose = Pose::new(turn, Vector3::new(4.0, -3.0 + k, 6.0) - turn * centroid.coords);
        let seen: Vec<Vec<Curve>> =
            fluoroscopes.iter().map(|view| ideal_outline(solid, &pose, view, 0.5)).collect();
        let noisy: Vec<Vec<Curve>> = seen
            .iter()
            .map(|curves| {
                let mut curves = curves.clone();
                for p in curves.iter_mut().flat_map(|c| &mut c.points) {
                    p.position += p.direction * random.random_range(-NOISE_PX..NOISE_PX);
                }
                curves
            })
            .collect();
        // An edge that runs along the cut end by chance.
        let beside = |view: &Calibration| {
            let mut outline = Outline::new();
            outline.trace(&rim, &pose, &Fluoroscope::from(view), Sampling { step_px: 1.0 });
            let at_end = |p: &Point3| (pose.inverse().transform(p).z - height).abs() < 1e-6;
            let points = outline.points().iter().filter(|p| at_end(&p.world)).map(|p| EdgePoint {
                position: p.pixel + p.normal * BESIDE_PX,
                direction: p.normal,
                strength: 20.0,
                sigma_px: 0.05,
            });
            Curve { points: points.collect(), closed: false }
        };
        let twist =
            Twist { translation: Vector3::new(2.0, -3.0, 2.0), rotation: Vector3::new(0.05, 0.02, -0.04) };
        let start = Hashed::new(Start(pose.moved(&twist, &pose.transform(&centroid))));
        let matched = |with_edge: bool, ignore_cut_ends: bool| -> (Match, f64) {
            let curves =
                if with_edge { &noisy } else { &seen }.iter().zip(&calibrations).map(|(seen, view)| {
                    let edge = with_edge.then(|| beside(view));
                    Hashed::new(Curves(seen.iter().cloned().chain(edge).collect()))
                });
            let inputs = MatchInputs {
                curves: curves.collect(),
                calibrations: calibrations.clone(),
                model: model.clone(),
                start: vec![start.clone()],
                calibration_uncertainty: Vec::new(),
            };
            let edge_bias = EdgeBias::None;
            let params =
                MatchParams { ignore_cut_ends, edge_bias, anywhere: false, ..MatchParams::default() };
            let found = MatchBody::run(&inputs, &params, &context).unwrap();
            let error = Pose::from(found.pose).error_against(&pose, &centroid).translation_mm;
            (found, error)
        };
        let least = |found: &Match| found.views.iter().fold(1.0_f64, |least, v| least.min(v.matched_share));
        let [(kept, kept_mm), (ignored, ignored_mm)] = [false, true].map(|ignore| matched(false, ignore));
        let [(_, kept_beside), (other, ignored_beside)] = [false, true].map(|ignore| matched(true, ignore));
        println!(
            "kept: {} {:.2} {kept_mm:.4} mm, beside an edge {kept_beside:.4} mm; ignored: {} {:.2} {ignored_mm:.4} mm, {ignored_beside:.4} mm",
            kept.verdict.word(),
            least(&kept),
            ignored.verdict.word(),
            least(&ignored),
        );
        doubted += u32::from(kept.verdict != Verdict::Good);
        assert_eq!((ignored.verdict, other.verdict), (Verdict::Good, Verdict::Good), "{}", ignored.reason);
        assert!(least(&ignored) > 0.9 && least(&kept) < least(&ignored) - 0.1);
        assert!(ignored_mm < 0.005);
        assert!(kept_beside > 2.0 * ignored_beside, "{kept_beside} {ignored_beside}");
    }
    assert!(doubted > 0, "an outline that no picture can show is held against the match where it is kept");
}
