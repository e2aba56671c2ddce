//! The bodies of the report in 3D: `report/models.js`, a script with one call that holds every body's simplified mesh.

use std::collections::BTreeSet;

use biplane_geometry::{Mesh, Point3};
use biplane_stage::How;
use serde::Serialize;

use crate::drawings::base64;
use crate::outcome::Failure;
use crate::steps::{ItemError, REPORT_MODEL, Steps};
use crate::study::Study;

/// The meshes that the report shows, and how they were come by.
#[derive(Debug, Clone, Default)]
pub struct Bodies {
    /// Index of the body in the study, and its mesh, mm, model frame.
    pub meshes: Vec<(usize, Mesh)>,
    /// Area centroid of each body of the study (of the mesh that is matched), mm, model frame.
    pub centroids: Vec<Point3>,
    /// What was done.
    pub done: Vec<(&'static str, String, How)>,
    /// Bodies that are not shown, and why.
    pub failures: Vec<Failure>,
}

/// The bodies that a trial looks for.
pub fn shown(study: &Study) -> BTreeSet<usize> {
    study.trials.iter().flat_map(|trial| trial.bodies.iter().copied()).collect()
}

/// Simplifies the bodies of all trials; `None` if the run was stopped. One without a model is left out: why is said where it is made.
pub fn bodies(steps: &Steps<'_>) -> Option<Bodies> {
    let study = &steps.prepared.study;
    let mut all = Bodies { centroids: steps.pivots(), ..Bodies::default() };
    for body in shown(study).into_iter().filter(|body| steps.model(*body).is_ok()) {
        let item = format!("{REPORT_MODEL}/{}", study.bodies[body].name);
        match steps.report_model(body) {
            Ok((mesh, how)) => {
                all.done.extend(how.map(|how| (REPORT_MODEL, item, how)));
                all.meshes.push((body, mesh.0.clone()));
            }
            Err(ItemError::Cancelled) => return None,
            Err(ItemError::Failed(message)) => {
                all.failures.push(Failure { item, message: study.shorten(&message) });
            }
        }
    }
    Some(all)
}

#[derive(Serialize)]
struct Shown {
    body: usize,
    /// `f32`, x, y, z of each vertex from `middle`, mm.
    vertices: String,
    /// `u32`, three vertices of each triangle.
    triangles: String,
    /// What vertices count from, mm, model frame.
    middle: [f64; 3],
}

/// `report/models.js`.
pub fn script(bodies: &Bodies) -> String {
    let of = |(body, mesh): &(usize, Mesh)| {
        let (low, high) = mesh.bounding_box();
        let middle = nalgebra::center(&low, &high);
        let vertices = mesh.vertices().iter().flat_map(|p| (p - middle).map(|v| v as f32).data.0[0]);
        let triangles = mesh.triangles().iter().flatten();
        Shown {
            body: *body,
            vertices: base64::encode(&vertices.flat_map(f32::to_le_bytes).collect::<Vec<u8>>()),
            triangles: base64::encode(&triangles.flat_map(|t| t.to_le_bytes()).collect::<Vec<u8>>()),
            middle: [middle.x, middle.y, middle.z],
        }
    };
    let shown: Vec<Shown> = bodies.meshes.iter().map(of).collect();
    // Numbers and base64 alone: nothing that JSON could refuse.
    format!("biplaneModels({});\n", serde_json::to_string(&shown).unwrap_or_else(|_| "[]".to_owned()))
}
