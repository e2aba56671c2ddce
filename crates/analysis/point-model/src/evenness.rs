//! How evenly a mesh's points are spread.

use biplane_geometry::Mesh;
use biplane_surface::Edges;

/// How evenly the points of a mesh are spread, and how good its triangles are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evenness {
    /// Vertices of its triangles.
    pub points: usize,
    /// Mean length of the edges, mm.
    pub mean_edge_mm: f64,
    /// Standard deviation of the edges' lengths as a share of their mean.
    pub edge_variation: f64,
    /// Standard deviation of the areas that the vertices stand for (a third of the triangles at each) as a share of their mean.
    pub area_variation: f64,
    /// The smallest angle of any triangle, degrees.
    pub smallest_angle_deg: f64,
    /// One per cent of the triangles have a smaller angle than this, degrees.
    pub one_percent_angle_deg: f64,
}

impl Evenness {
    /// Of a mesh; vertices without a triangle are left out.
    pub fn of(mesh: &Mesh) -> Self {
        let at = mesh.vertices();
        let lengths: Vec<f64> =
            Edges::of(mesh).iter().map(|([a, b], _)| (at[a as usize] - at[b as usize]).norm()).collect();
        let mut areas = vec![0.0; at.len()];
        let mut angles = Vec::with_capacity(mesh.triangles().len());
        for (t, triangle) in mesh.triangles().iter().enumerate() {
            let corners = mesh.corners(t);
            let angle = |k: usize| {
                let (u, v) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
                u.cross(&v).norm().atan2(u.dot(&v)).to_degrees()
            };
            angles.push(angle(0).min(angle(1)).min(angle(2)));
            let area = mesh.area_vector(t).norm() / 3.0;
            for v in triangle {
                areas[*v as usize] += area;
            }
        }
        areas.retain(|area| *area > 0.0);
        angles.sort_unstable_by(f64::total_cmp);
        let (mean_edge_mm, edge_variation) = mean_and_variation(&lengths);
        Self {
            points: areas.len(),
            mean_edge_mm,
            edge_variation,
            area_variation: mean_and_variation(&areas).1,
            smallest_angle_deg: angles[0],
            one_percent_angle_deg: angles[angles.len() / 100],
        }
    }
}

/// The mean, and the standard deviation as a share of it.
fn mean_and_variation(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64;
    (mean, square.sqrt() / mean)
}
