//! A body's support function over the whole sphere of directions.
//!
//! `H(m) = max over the body of m . x` for a unit vector `m`: how far the body reaches along `m`. A plane with outward normal `m`
//! touches the body's convex hull where `m . x = H(m)`. It is kept on an octahedral map, one cell of which is 0.5 to 1.2 degrees wide.

use biplane_geometry::{Mesh, Point3, Vector3};

use crate::octahedron;

/// Cells along a side of the map.
const SIDE: usize = 256;
/// Cells along a side of the coarser map whose extreme vertices are taken for all that there are.
const COARSE: usize = 128;

/// The support function of a mesh about its area centroid.
#[derive(Debug, Clone)]
pub(crate) struct Support {
    /// `H` at the middle of each cell, mm, row by row.
    reach: Vec<f32>,
    /// The vertex that reaches farthest there.
    extreme: Vec<u32>,
    /// Vertices that are extreme in some direction, about the centroid, mm.
    vertices: Vec<Vector3>,
}

/// Coordinates of points as three lists, padded by repeating the last to a whole number of lanes.
struct Cloud {
    axes: [Vec<f32>; 3],
}

/// Points that are looked at together.
const LANES: usize = 16;

impl Cloud {
    fn of(points: &[Vector3]) -> Self {
        let whole = points.len().next_multiple_of(LANES);
        let axis = |k: usize| {
            let all = points.iter().chain(points.last().into_iter().cycle());
            all.take(whole).map(|p| p[k] as f32).collect()
        };
        Self { axes: [axis(0), axis(1), axis(2)] }
    }

    /// The number of the point that reaches farthest along `m`, of equals the first of its lane.
    fn farthest(&self, m: &Vector3) -> usize {
        let [x, y, z] = &self.axes;
        let (mx, my, mz) = (m.x as f32, m.y as f32, m.z as f32);
        let (mut best, mut at) = ([f32::NEG_INFINITY; LANES], [0_u32; LANES]);
        let blocks =
            x.as_chunks::<LANES>().0.iter().zip(y.as_chunks::<LANES>().0).zip(z.as_chunks::<LANES>().0);
        for (block, ((x, y), z)) in (0_u32..).zip(blocks) {
            for k in 0..LANES {
                let reach = mx * x[k] + my * y[k] + mz * z[k];
                let farther = reach > best[k];
                best[k] = if farther { reach } else { best[k] };
                at[k] = if farther { block } else { at[k] };
            }
        }
        let lane = (0..LANES).fold(0, |a, b| if best[b] > best[a] { b } else { a });
        at[lane] as usize * LANES + lane
    }
}

impl Support {
    /// Of a mesh, about `centroid`.
    pub fn of(mesh: &Mesh, centroid: &Point3) -> Self {
        let mut used = vec![false; mesh.vertices().len()];
        mesh.triangles().as_flattened().iter().for_each(|&v| used[v as usize] = true);
        let points: Vec<Vector3> =
            mesh.vertices().iter().zip(&used).filter(|(_, used)| **used).map(|(v, _)| v - centroid).collect();
        let cloud = Cloud::of(&points);
        let mut extremes: Vec<usize> =
            octahedron::middles(COARSE).map(|m| cloud.farthest(&m).min(points.len() - 1)).collect();
        extremes.sort_unstable();
        extremes.dedup();
        let vertices: Vec<Vector3> = extremes.iter().map(|&k| points[k]).collect();
        let cloud = Cloud::of(&vertices);
        let extreme: Vec<u32> =
            octahedron::middles(SIDE).map(|m| cloud.farthest(&m).min(vertices.len() - 1) as u32).collect();
        let reach = octahedron::middles(SIDE)
            .zip(&extreme)
            .map(|(m, &v)| m.dot(&vertices[v as usize]) as f32)
            .collect();
        Self { reach, extreme, vertices }
    }

    /// `H` at the nearest cell's middle: off by at most the body's radius times half a cell.
    #[inline]
    pub fn coarse(&self, x: f32, y: f32, z: f32) -> f32 {
        let scale = 1.0 / (x.abs() + y.abs() + z.abs());
        let (u, v) = (x * scale, y * scale);
        // The lower half is folded outward over the edges of the square.
        let (fold_u, fold_v) = ((1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v));
        let (u, v) = if z < 0.0 { (fold_u, fold_v) } else { (u, v) };
        let half = SIDE as f32 / 2.0;
        let cell = |w: f32| ((w + 1.0) * half) as usize;
        self.reach.get(cell(v).min(SIDE - 1) * SIDE + cell(u).min(SIDE - 1)).copied().unwrap_or(0.0)
    }

    /// The mean of `H` over the map, mm.
    pub fn mean(&self) -> f64 {
        self.reach.iter().map(|h| f64::from(*h)).sum::<f64>() / self.reach.len() as f64
    }

    /// Distance of the farthest vertex, mm.
    pub fn radius(&self) -> f64 {
        self.vertices.iter().map(|v| v.norm()).fold(0.0, f64::max)
    }

    /// The vertex that reaches farthest along the unit vector `m`, among those of the cells around its place.
    pub fn farthest(&self, m: &Vector3) -> &Vector3 {
        let place = |w: f64| (w + 1.0) * (SIDE as f64 / 2.0) - 0.5;
        let cell = |w: f64| w.clamp(0.0, (SIDE - 1) as f64) as usize;
        let [u, v] = octahedron::fold(m).map(place);
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let at = |(du, dv)| &self.vertices[self.extreme[cell(v + dv) * SIDE + cell(u + du)] as usize];
        corners.map(at).into_iter().fold(at((0.0, 0.0)), |a, b| if b.dot(m) > a.dot(m) { b } else { a })
    }
}

#[cfg(test)]
mod tests {
    use biplane_phantom::{Body, mesh};
    use rand::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    #[test]
    fn it_is_the_largest_over_all_vertices() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
        for body in Body::ALL {
            let mesh = mesh(body.solid(), 3000).unwrap();
            let centroid = mesh.area_centroid();
            let support = Support::of(&mesh, &centroid);
            let radius = mesh.vertices().iter().map(|v| (v - centroid).norm()).fold(0.0, f64::max);
            for _ in 0..500 {
                let m = Vector3::from([0; 3].map(|_| random.random_range(-1.0..1.0))).normalize();
                let truth = mesh.vertices().iter().map(|v| m.dot(&(v - centroid))).fold(f64::MIN, f64::max);
                let found = support.farthest(&m).dot(&m);
                assert!(found <= truth + 1e-9 && found > truth - 0.02, "{found} {truth}");
                let coarse = f64::from(support.coarse(m.x as f32, m.y as f32, m.z as f32));
                // Half a cell's diagonal is at most 0.8 degrees.
                assert!((coarse - truth).abs() < radius * 0.014, "{coarse} {truth}");
            }
        }
    }
}
