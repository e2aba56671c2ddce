//! The bound of a silhouette's error, against silhouettes; simplification to a number of points and to a bound.

#![allow(clippy::unwrap_used)]

use biplane_artifact::{BoneSurface, ModelMesh, SurfaceReport};
use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_phantom::{Body, mesh};
use biplane_point_model::{
    Deviation, Method, Model, ModelError, ModelInputs, ModelParams, even_points, fewest, point_model,
    simplified,
};
use biplane_stage::{Context, Hashed, Stage};
use biplane_surface::{MeshCheck, Spread, Surface, distances};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// The shadow of a mesh on a plane across a direction: its triangles pressed flat.
fn shadow(mesh: &Mesh, along: &Vector3) -> Mesh {
    let vertices = mesh.vertices().iter().map(|v| v - along * v.coords.dot(along)).collect();
    Mesh::new(vertices, mesh.triangles().to_vec()).unwrap()
}

fn any_direction(random: &mut Xoshiro256PlusPlus) -> Vector3 {
    loop {
        let v = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
        if (0.01..1.0).contains(&v.norm_squared()) {
            return v.normalize();
        }
    }
}

/// In many views no point of either shadow lies farther from the other shadow than the bound, and the bound is not idle.
#[test]
fn no_silhouette_differs_by_more_than_is_said() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    for body in [Body::TibialTray, Body::FemoralComponent, Body::DistalFemur] {
        let original = mesh(body.solid(), 8_000).unwrap();
        for model in [even_points(&original, 1_500, 40.0).unwrap(), simplified(&original, 600, 40.0).unwrap()]
        {
            let bound = Deviation::between(&model, &original, 1e-3);
            assert!(bound.of_model.at_most_mm - bound.of_model.at_least_mm <= 1e-3);
            assert!(bound.of_original.at_most_mm - bound.of_original.at_least_mm <= 1e-3);
            let mut worst = 0.0_f64;
            for _ in 0..12 {
                let along = any_direction(&mut random);
                let (of_model, of_original) = (shadow(&model, &along), shadow(&original, &along));
                for (from, to) in [(&of_model, &of_original), (&of_original, &of_model)] {
                    let tree = Surface::new(to);
                    let at_vertices = from.vertices().iter().map(|v| tree.closest(v).distance_mm);
                    worst = at_vertices.fold(worst, f64::max);
                    worst = worst.max(Spread::of(&distances(from, &tree, 3_000)).worst);
                }
            }
            let said = bound.silhouette_mm();
            assert!(worst <= said + 1e-9, "{}: {worst} mm, said {said}", body.name());
            assert!(worst > 0.2 * said, "{}: {worst} mm, said {said}", body.name());
        }
    }
}

#[test]
fn simplified_meshes_are_nearer_than_even_ones() {
    for body in Body::ALL {
        let original = mesh(body.solid(), 12_000).unwrap();
        let apart = |model: &Mesh| {
            assert!(MeshCheck::of(model).is_closed_manifold());
            assert!(Surface::new(model).self_crossings(1).is_empty());
            assert_eq!(model.vertices().len(), 2_500);
            Deviation::between(model, &original, 1e-3).silhouette_mm()
        };
        let even = apart(&even_points(&original, 2_500, 40.0).unwrap());
        let simple = apart(&simplified(&original, 2_500, 40.0).unwrap());
        assert!(simple < even, "{}: simplified {simple} mm, even {even} mm", body.name());
    }
}

#[test]
fn a_bound_is_kept_by_few_points_or_refused_with_what_can_be_had() {
    let original = mesh(Body::Patella.solid(), 3_000).unwrap();
    let model = fewest(&original, 0.1, 40.0, &Context::new()).unwrap();
    assert!(Deviation::between(&model, &original, 1e-3).silhouette_mm() <= 0.1);
    let count = model.vertices().len();
    assert!(count < 1_500, "{count}");
    let fewer = simplified(&original, count * 7 / 10, 40.0).unwrap();
    assert!(Deviation::between(&fewer, &original, 1e-3).silhouette_mm() > 0.1);
    for method in [Method::Even, Method::Simplified] {
        let params = ModelParams { points: 200, method, max_error_mm: 0.1, ..ModelParams::default() };
        match point_model(&original, &params, &Context::new()) {
            Err(error @ ModelError::TooFar { points: 200, found_mm, .. }) => {
                assert!(found_mm > 0.1 && error.to_string().contains(&format!("{count} points")), "{error}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn the_stage_takes_one_mesh_or_one_surface() {
    let patella = mesh(Body::Patella.solid(), 2_000).unwrap();
    let params = ModelParams { points: 500, ..ModelParams::default() };
    let run = |meshes: usize, surfaces: usize| {
        let surface = BoneSurface { mesh: patella.clone(), report: SurfaceReport::default() };
        let inputs = ModelInputs {
            mesh: vec![Hashed::new(ModelMesh(patella.clone())); meshes],
            surface: vec![Hashed::new(surface); surfaces],
        };
        Model::run(&inputs, &params, &Context::new())
    };
    let model = run(1, 0).unwrap();
    assert_eq!(model.0.vertices().len(), 500);
    assert_eq!(run(0, 1).unwrap(), model);
    for (meshes, surfaces) in [(0, 0), (1, 1), (2, 0)] {
        assert_eq!(run(meshes, surfaces), Err(ModelError::Inputs { meshes, surfaces }));
    }
    // As they are: the same vertices and triangles in another order.
    let same = point_model(&patella, &ModelParams::default(), &Context::new()).unwrap();
    let sorted = |m: &Mesh| {
        let mut all: Vec<[u64; 3]> =
            m.vertices().iter().map(|v: &Point3| [v.x, v.y, v.z].map(f64::to_bits)).collect();
        all.sort_unstable();
        all
    };
    assert_eq!(sorted(&same), sorted(&patella));
    assert_eq!(same.triangles().len(), patella.triangles().len());
}

#[test]
fn parameters_out_of_range_are_named() {
    let bad = |params: ModelParams| params.check().unwrap_err().to_string();
    let fine = ModelParams::default();
    assert_eq!(fine.check(), Ok(()));
    assert!(bad(ModelParams { points: 100, ..fine }).contains("points = 100"));
    assert!(bad(ModelParams { points: 600_000, ..fine }).contains("points = 600000"));
    assert!(bad(ModelParams { keep_edges_deg: 5.0, ..fine }).contains("keep_edges_deg = 5"));
    assert!(bad(ModelParams { max_error_mm: f64::NAN, ..fine }).contains("max_error_mm"));
    let ball = mesh(Body::Patella.solid(), 1_000).unwrap();
    let few = simplified(&ball, 5_000, 40.0).unwrap_err().to_string();
    assert!(few.contains(&format!("{} points", ball.vertices().len())), "{few}");
}
