//! A mesh laid out for finding its rim: normals at the corners, creases, and boxes of planes.
//!
//! **Curved** ([`RimMesh::new`]): the triangles are taken for a sample of a smooth surface with creases. A *wedge* is the part of a
//! vertex's neighbourhood between two creases, with one normal (mean of its faces', weighted by their angles; Thürmer and
//! Wüthrich 1998). A wedge looks at the source where `g = n . (s - x) > 0`; `g` is interpolated along edges, and the rim runs through the
//! triangles where it changes its sign (Hertzmann and Zorin 2000), or along a crease whose two sides look differently. Points of the rim
//! are lifted from the chord onto the surface, by `t (1 - t) / 2 (n1 - n0) . (x1 - x0)` along the normal: the sagitta of a circle to
//! second order. That takes out the bias of triangles, which lie inside a convex surface by `edge^2 / 8 R`.
//!
//! **Flat** ([`RimMesh::flat`]): every edge is a crease and every wedge its face: the exact rim of the triangles as they are.

use std::collections::HashMap;
use std::sync::Arc;

use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_surface::{Edges, Surface, cut_ends};

use crate::symmetry::NearSymmetries;
use crate::tree::{Item, Tree};

/// Faces that meet at more than this are a crease, degrees.
const CREASE_DEG: f64 = 35.0;
/// A line of creases that turns by more than this at a vertex has a corner there, degrees.
const CORNER_DEG: f64 = 40.0;

/// A mesh with the adjacency that the rim needs. Made once a mesh, used for every pose.
#[derive(Debug, Clone)]
pub struct RimMesh {
    pub(crate) wedges: Vec<Wedge>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) creases: Vec<Crease>,
    pub(crate) sides: Vec<Side>,
    pub(crate) tree: Tree,
    pub(crate) edges: usize,
    /// How far beside the rim one looks whether a face covers the picture, px.
    pub(crate) beside_px: f64,
    surface: Surface,
    symmetries: NearSymmetries,
    centroid: Point3,
    radius_of_gyration: f64,
}

/// A vertex as one side of the creases that meet there sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wedge {
    /// From the mesh's centroid, mm.
    pub at: Vector3,
    /// Unit normal; zero where all faces are degenerate.
    pub normal: Vector3,
}

/// A triangle through which the rim can run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle {
    /// Its wedges' slots in the tree.
    pub slots: [u32; 3],
    /// Its sides, from each corner to the next: the number of a smooth edge, or [`Triangle::CREASE`] and that of a crease.
    pub edges: [u32; 3],
    /// The rim on it does not count as outline.
    pub ignored: bool,
}

impl Triangle {
    /// Marks the number of a crease.
    pub const CREASE: u32 = 1 << 31;
}

/// An edge whose sides look differently, or at which the surface ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crease {
    /// Its ends, from the mesh's centroid, mm.
    pub ends: [Vector3; 2],
    /// Derivatives of the curve along the crease at its ends, mm.
    pub along: [Vector3; 2],
    /// Where its sides begin and end.
    pub sides: [u32; 2],
    /// The rim on it does not count as outline.
    pub ignored: bool,
}

impl Crease {
    /// The point of the crease at 0 to 1, and its derivative: a cubic through the ends with their derivatives.
    pub fn at(&self, t: f64) -> (Vector3, Vector3) {
        let [a, b] = self.ends;
        let [u, v] = self.along;
        let s = 1.0 - t;
        let point =
            a * (s * s * (1.0 + 2.0 * t)) + b * (t * t * (3.0 - 2.0 * t)) + u * (t * s * s) - v * (t * t * s);
        let derivative = (b - a) * (6.0 * t * s) + u * (s * (1.0 - 3.0 * t)) + v * (t * (3.0 * t - 2.0));
        (point, derivative)
    }
}

/// One face at a crease.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Side {
    /// Slots of its wedges at the crease's ends.
    pub slots: [u32; 2],
    /// Whether the face runs from the first end to the second (+1) or back (-1).
    pub sign: i32,
}

impl RimMesh {
    /// Poses at which the body looks nearly as at `pose` in one of the views, or in all of them: it is nearly its own mirror image, or the same after half
    /// a turn. None for a body without such a symmetry about its principal axes.
    pub fn looks_alike<'a>(&self, pose: &Pose, views: impl Iterator<Item = &'a Fluoroscope>) -> Vec<Pose> {
        self.symmetries.others(pose, &self.centroid, views)
    }

    /// A mesh as a sample of a smooth surface with creases.
    pub fn new(mesh: &Mesh) -> Self {
        Self::build(mesh, CREASE_DEG, &|_| false)
    }

    /// The triangles as they are.
    pub fn flat(mesh: &Mesh) -> Self {
        Self::build(mesh, 0.0, &|_| false)
    }

    /// As [`Self::new`], where the rim on faces that are `ignored` is no outline: a bone's end where its volume was cut.
    pub fn without(mesh: &Mesh, ignored: impl Fn(usize) -> bool) -> Self {
        Self::build(mesh, CREASE_DEG, &ignored)
    }

    /// The order of everything depends on the mesh alone.
    fn build(mesh: &Mesh, crease_deg: f64, ignored: &dyn Fn(usize) -> bool) -> Self {
        let corners = mesh.triangles().as_flattened();
        let centroid = mesh.area_centroid();
        let unit: Vec<Vector3> = (0..mesh.triangles().len())
            .map(|t| mesh.area_vector(t).try_normalize(0.0).unwrap_or_else(Vector3::zeros))
            .collect();
        let all = Edges::of(mesh);
        let flat = crease_deg <= 0.0;
        let least_cosine = crease_deg.to_radians().cos();
        let runs_along = |edge: [u32; 2], half: u32| corners[half as usize] == edge[0];
        let smooth = |edge: [u32; 2], halves: &[u32]| match *halves {
            [a, b] if !flat && runs_along(edge, a) != runs_along(edge, b) => {
                unit[a as usize / 3].dot(&unit[b as usize / 3]) >= least_cosine
            }
            _ => false,
        };

        // Corners that see each other round a vertex without a crease between are one wedge.
        let mut group: Vec<u32> = (0..corners.len() as u32).collect();
        fn root(group: &mut [u32], mut of: u32) -> u32 {
            while group[of as usize] != of {
                let next = group[group[of as usize] as usize];
                group[of as usize] = next;
                of = next;
            }
            of
        }
        let next = |half: u32| if half % 3 == 2 { half - 2 } else { half + 1 };
        let mut number = 0;
        let mut place = vec![0_u32; corners.len()];
        for (edge, halves) in all.iter() {
            if smooth(edge, halves) {
                let (a, b) = (halves[0], halves[1]);
                for (i, j) in [(a, next(b)), (next(a), b)] {
                    let (i, j) = (root(&mut group, i), root(&mut group, j));
                    let (low, high) = (i.min(j), i.max(j));
                    group[high as usize] = low;
                }
                place[a as usize] = number;
                place[b as usize] = number;
                number += 1;
            }
        }
        let mut wedges: Vec<Wedge> = Vec::new();
        let mut wedge_of = vec![u32::MAX; corners.len()];
        for corner in 0..corners.len() as u32 {
            let face = corner as usize / 3;
            // Without smooth edges a face's corners share its plane to the bit.
            let first = if flat { corner - corner % 3 } else { root(&mut group, corner) };
            if wedge_of[first as usize] == u32::MAX {
                wedge_of[first as usize] = wedges.len() as u32;
                let at = mesh.vertices()[corners[first as usize] as usize] - centroid;
                wedges.push(Wedge { at, normal: Vector3::zeros() });
            }
            wedge_of[corner as usize] = wedge_of[first as usize];
            let [here, after, before] = [corner, next(corner), next(next(corner))]
                .map(|c| mesh.vertices()[corners[c as usize] as usize]);
            let angle = if flat { 1.0 } else { (after - here).angle(&(before - here)) };
            wedges[wedge_of[corner as usize] as usize].normal +=
                unit[face] * if angle.is_finite() { angle } else { 0.0 };
        }
        for wedge in &mut wedges {
            wedge.normal = wedge.normal.try_normalize(1e-12).unwrap_or_else(Vector3::zeros);
        }

        let mut lines: HashMap<u32, Vec<(u32, f64)>> = HashMap::new();
        let mut creases = Vec::new();
        let mut sides: Vec<Side> = Vec::new();
        let mut ends_of = Vec::new();
        for (edge, halves) in all.iter() {
            if smooth(edge, halves) {
                continue;
            }
            let crease = creases.len() as u32;
            let start = sides.len() as u32;
            for &half in halves {
                place[half as usize] = Triangle::CREASE | crease;
                let along = runs_along(edge, half);
                let (a, b) = if along { (half, next(half)) } else { (next(half), half) };
                let slots = [a, b].map(|c| wedge_of[c as usize]);
                sides.push(Side { slots, sign: if along { 1 } else { -1 } });
            }
            let ends = edge.map(|v| mesh.vertices()[v as usize] - centroid);
            for (v, sign) in [(edge[0], 1.0), (edge[1], -1.0)] {
                lines.entry(v).or_default().push((crease, sign));
            }
            ends_of.push(edge);
            creases.push(Crease {
                ends,
                along: [ends[1] - ends[0]; 2],
                sides: [start, sides.len() as u32],
                ignored: halves.iter().any(|h| ignored(*h as usize / 3)),
            });
        }
        if !flat {
            bend(&mut creases, &ends_of, &lines);
        }

        let triangle = |t: usize| Triangle {
            slots: [0, 1, 2].map(|k| wedge_of[3 * t + k]),
            edges: [0, 1, 2].map(|k| place[3 * t + k]),
            ignored: ignored(t),
        };
        let mut triangles: Vec<Triangle> = Vec::new();
        if !flat {
            triangles.extend((0..mesh.triangles().len()).map(triangle));
        }
        let items = (0..triangles.len() as u32).map(Item::Triangle);
        let items = items.chain((0..creases.len() as u32).map(Item::Crease)).collect();
        let tree = Tree::new(items, &mut wedges, &mut triangles, &mut creases, &mut sides);
        let surface = Surface::new(mesh);
        let symmetries = NearSymmetries::of(mesh, &surface);
        Self {
            wedges,
            triangles,
            creases,
            sides,
            tree,
            edges: number as usize,
            beside_px: if flat { 1e-8 } else { 0.05 },
            surface,
            symmetries,
            centroid,
            radius_of_gyration: mesh.radius_of_gyration(),
        }
    }

    /// The mesh's triangles, for searches in space.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The mesh's area centroid, model coordinates, mm.
    pub fn centroid(&self) -> &Point3 {
        &self.centroid
    }

    /// Root mean square distance of the surface from its centroid, mm.
    pub fn radius_of_gyration(&self) -> f64 {
        self.radius_of_gyration
    }
}

/// A mesh as [`RimMesh::new`] takes it, but where the flat ends at which its volume was cut ([`cut_ends`]) are no outline: a type of its
/// own, so that one mesh can be kept prepared both ways.
#[derive(Debug, Clone)]
pub struct RimWithoutCutEnds(pub Arc<RimMesh>);

impl RimWithoutCutEnds {
    /// Looks for the cut ends of `mesh`, and prepares it.
    pub fn new(mesh: &Mesh) -> Self {
        let cut = cut_ends(mesh);
        Self(Arc::new(RimMesh::without(mesh, |face| cut.get(face).copied().unwrap_or(false))))
    }
}

/// Bends creases where two meet at a vertex and go on: the derivative there is that of the circle through three points.
fn bend(creases: &mut [Crease], ends: &[[u32; 2]], lines: &HashMap<u32, Vec<(u32, f64)>>) {
    let chords: Vec<Vector3> = creases.iter().map(|c| c.ends[1] - c.ends[0]).collect();
    for (number, crease) in creases.iter_mut().enumerate() {
        for (end, outward) in [(0, 1.0), (1, -1.0)] {
            let Some([a, b]) = lines.get(&ends[number][end]).map(Vec::as_slice) else { continue };
            let other = if a.0 as usize == number { b } else { a };
            // Both chords in the direction of this crease.
            let (own, before) = (chords[number], chords[other.0 as usize] * (-other.1 * outward));
            let (long, short) = (own.norm(), before.norm());
            if long <= 0.0 || short <= 0.0 || own.dot(&before) < CORNER_DEG.to_radians().cos() * long * short
            {
                continue;
            }
            let tangent = (own / long * short + before / short * long) / (long + short);
            crease.along[end] = tangent.try_normalize(0.0).unwrap_or(tangent) * long;
        }
    }
}
