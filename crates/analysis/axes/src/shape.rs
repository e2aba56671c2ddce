//! A mesh in its own frame: where it is looked at, so that what is found turns with it.
//!
//! Its centroid is the origin and its principal axes are the axes ([`crate::moments`]). A left body is mirrored first and is a right
//! one from then on.

use std::f64::consts::PI;

use biplane_artifact::{BodyAxes, BodyKind, Side};
use biplane_geometry::{Mesh, Vector3};
use nalgebra::Matrix3;

use crate::stage::Found;
use crate::{ModelFrame, figures, moments};

/// A corner of a triangle: a place on the surface with its share of the area.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    pub at: Vector3,
    /// Of the triangle, unit, outward where the mesh is closed.
    pub normal: Vector3,
    /// A third of the triangle's, mm^2.
    pub area: f64,
}

/// Directions over a half sphere, spread evenly (a Fibonacci lattice).
pub(crate) fn half_sphere(count: i32) -> impl Iterator<Item = Vector3> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    (0..count).map(move |k| {
        let z = (f64::from(k) + 0.5) / f64::from(count);
        let (r, a) = ((1.0 - z * z).sqrt(), golden * f64::from(k));
        Vector3::new(r * a.cos(), r * a.sin(), z)
    })
}

/// A right body in its own frame.
pub(crate) struct Shape {
    pub vertices: Vec<Vector3>,
    pub triangles: Vec<[u32; 3]>,
    pub samples: Vec<Sample>,
    /// Standard deviations along the own axes, mm, descending.
    pub spread: [f64; 3],
    /// Third moments along them, of unit size.
    pub skew: [f64; 3],
    /// Edges with one triangle.
    pub open_edges: usize,
    /// Where superior and anterior are, in the own frame, if the frame of the mesh says so.
    pub hint: Option<Hint>,
    centroid: Vector3,
    turn: Matrix3<f64>,
    mirrored: bool,
}

/// Directions that the scanner's frame gives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hint {
    pub superior: Vector3,
    pub anterior: Vector3,
}

fn mirror(v: &Vector3) -> Vector3 {
    Vector3::new(-v.x, v.y, v.z)
}

fn samples(vertices: &[Vector3], triangles: &[[u32; 3]]) -> Vec<Sample> {
    triangles
        .iter()
        .flat_map(|t| {
            let [a, b, c] = t.map(|v| vertices[v as usize]);
            let normal = (b - a).cross(&(c - a));
            let size = normal.norm();
            [a, b, c].map(|at| Sample { at, normal: normal / size, area: size / 6.0 })
        })
        .filter(|s| s.area > 0.0)
        .collect()
}

impl Shape {
    pub fn of(mesh: &Mesh, side: Side, frame: ModelFrame) -> Self {
        let mirrored = side == Side::Left;
        let inside_out = mesh.signed_volume() < 0.0;
        let placed = |v: &Vector3| if mirrored { mirror(v) } else { *v };
        let mut vertices: Vec<Vector3> = mesh.vertices().iter().map(|p| placed(&p.coords)).collect();
        let mut triangles = mesh.triangles().to_vec();
        if mirrored != inside_out {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        let moments = moments::moments(&vertices, &triangles);
        let back = moments.axes.transpose();
        vertices.iter_mut().for_each(|v| *v = back * (*v - moments.centroid));
        let samples = samples(&vertices, &triangles);
        let hint = (frame == ModelFrame::Lps)
            .then(|| Hint { superior: back * Vector3::z(), anterior: back * -Vector3::y() });
        Self {
            vertices,
            triangles,
            samples,
            spread: moments.spread,
            skew: moments.skew,
            open_edges: mesh.topology().open_edges,
            hint,
            centroid: moments.centroid,
            turn: moments.axes,
            mirrored,
        }
    }

    /// A place of the model in the own frame.
    pub fn own(&self, model: &Vector3) -> Vector3 {
        let v = if self.mirrored { mirror(model) } else { *model };
        self.turn.transpose() * (v - self.centroid)
    }

    fn model(&self, own: &Vector3) -> Vector3 {
        let v = self.turn * own + self.centroid;
        if self.mirrored { mirror(&v) } else { v }
    }

    fn model_direction(&self, own: &Vector3) -> Vector3 {
        let v = self.turn * own;
        if self.mirrored { mirror(&v) } else { v }
    }
    /// What was found, in model coordinates. The axes of a mirrored body: x and y are mirrored, z points to the right again.
    pub fn placed(&self, found: Found, body: BodyKind, side: Side) -> BodyAxes {
        let [x, y, z] = found.frame.axes.map(|a| self.model_direction(&a));
        let z = if self.mirrored { -z } else { z };
        let features = found
            .features
            .into_iter()
            .map(|f| figures::moved(f, |v| self.model(v), |v| self.model_direction(v)))
            .collect();
        BodyAxes {
            origin_mm: self.model(&found.frame.origin).into(),
            axes: [x, y, z].map(Into::into),
            body,
            side,
            source: found.source,
            features,
            warnings: found.warnings,
        }
    }

    /// The same body with fewer triangles, for searches that cut it often: vertices of one cell of a cubic grid become one. Its sections
    /// stay closed where they were.
    pub fn coarse(&self) -> Option<Self> {
        const MOST: usize = 12_000;
        if self.triangles.len() <= MOST {
            return None;
        }
        let (low, high) = self.bounds();
        let side = (high - low).norm() / 70.0;
        let cell = |v: &Vector3| [0, 1, 2].map(|k| ((v[k] - low[k]) / side).floor() as i64);
        let mut order: Vec<([i64; 3], u32)> =
            self.vertices.iter().enumerate().map(|(i, v)| (cell(v), i as u32)).collect();
        order.sort_unstable();
        let mut number = vec![0; self.vertices.len()];
        let mut vertices: Vec<Vector3> = Vec::new();
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            let sum: Vector3 = group.iter().map(|(_, i)| self.vertices[*i as usize]).sum();
            group.iter().for_each(|(_, i)| number[*i as usize] = vertices.len() as u32);
            vertices.push(sum / group.len() as f64);
        }
        let triangles = self.triangles.iter().map(|t| t.map(|v| number[v as usize]));
        let triangles: Vec<[u32; 3]> = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        let samples = samples(&vertices, &triangles);
        Some(Self { vertices, triangles, samples, ..*self })
    }

    /// Smallest and largest coordinates along the own axes.
    pub fn bounds(&self) -> (Vector3, Vector3) {
        let first = self.samples.first().map_or(Vector3::zeros(), |s| s.at);
        self.samples.iter().fold((first, first), |(low, high), s| (low.inf(&s.at), high.sup(&s.at)))
    }

    /// How far the surface reaches along a direction, from its smallest to its largest coordinate.
    pub fn reach(&self, direction: &Vector3) -> (f64, f64) {
        self.samples.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| {
            let h = s.at.dot(direction);
            (low.min(h), high.max(h))
        })
    }
}
