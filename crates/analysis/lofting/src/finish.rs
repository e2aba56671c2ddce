//! What is done to the vertices after the surface is made: triangles made more even, and a volume kept.
//!
//! Vertices on the edges of a grid make slivers. Each vertex moves towards the middle of its neighbours, along the surface only, and not where
//! the surface has an edge; on the rim of a flat lid along the rim.

use biplane_geometry::Vector3;

/// Rounds of evening, and the share of the way in each.
const EVENING: usize = 4;
const EVENING_SHARE: f64 = 0.6;
/// A vertex whose triangles' normals add up to less than this share of their lengths lies on an edge of the surface.
const STRAIGHT: f64 = 0.9;

/// Volume within a closed surface, mm^3.
pub(crate) fn volume(vertices: &[Vector3], triangles: &[[u32; 3]]) -> f64 {
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| vertices[v as usize]);
        a.dot(&b.cross(&c)) / 6.0
    };
    triangles.iter().map(of).sum()
}

/// What the triangles around a vertex say.
#[derive(Clone, Copy, Default)]
struct Around {
    /// Sum of the neighbours, each twice, and their number, twice.
    sum: Vector3,
    count: f64,
    /// Sum of twice the triangles' area vectors, and of their lengths.
    normal: Vector3,
    area: f64,
}

/// Of a vertex on a rim only neighbours on a rim count as such.
fn around(vertices: &[Vector3], triangles: &[[u32; 3]], rims: &[bool], into: &mut Vec<Around>) {
    into.clear();
    into.resize(vertices.len(), Around::default());
    for t in triangles {
        let [a, b, c] = t.map(|v| vertices[v as usize]);
        let normal = (b - a).cross(&(c - a));
        let area = normal.norm();
        let on_rim = t.map(|v| rims[v as usize]);
        for (k, (p, q)) in [(b, c), (c, a), (a, b)].into_iter().enumerate() {
            let of = &mut into[t[k] as usize];
            if on_rim[k] {
                for (other, _) in [(p, (k + 1) % 3), (q, (k + 2) % 3)].into_iter().filter(|o| on_rim[o.1]) {
                    of.sum += other;
                    of.count += 1.0;
                }
            } else {
                of.sum += p + q;
                of.count += 2.0;
            }
            of.normal += normal;
            of.area += area;
        }
    }
}

/// Evens the triangles.
pub(crate) fn even(vertices: &mut [Vector3], triangles: &[[u32; 3]], rims: &[bool]) {
    let mut all = Vec::new();
    for _ in 0..EVENING {
        around(vertices, triangles, rims, &mut all);
        for ((v, of), rim) in vertices.iter_mut().zip(&all).zip(rims) {
            // A rim lies in a slice, so its normal does.
            let normal = if *rim { Vector3::new(of.normal.x, of.normal.y, 0.0) } else { of.normal };
            let square = normal.norm_squared();
            // The normals of a smooth surface add up.
            if of.count > 0.0 && square > 0.0 && (*rim || square > (STRAIGHT * of.area).powi(2)) {
                let way = of.sum / of.count - *v;
                *v += EVENING_SHARE * (way - normal * (way.dot(&normal) / square));
            }
        }
    }
}

/// Moves all vertices along their normals by one length, so that the volume becomes what is wanted; rims of lids stay. The length is at most a
/// quarter of a `cell`.
pub(crate) fn keep_volume(
    vertices: &mut [Vector3],
    triangles: &[[u32; 3]],
    rims: &[bool],
    wanted: f64,
    cell: f64,
) {
    let mut all = Vec::new();
    // Twice: the area changes a little on the way.
    for _ in 0..2 {
        around(vertices, triangles, rims, &mut all);
        let area: f64 = all.iter().map(|of| of.area).sum::<f64>() / 6.0;
        let off = (wanted - volume(vertices, triangles)) / area.max(f64::MIN_POSITIVE);
        let off = off.clamp(-cell / 4.0, cell / 4.0);
        for ((v, of), rim) in vertices.iter_mut().zip(&all).zip(rims) {
            if !rim {
                *v += of.normal.try_normalize(0.0).unwrap_or_default() * off;
            }
        }
    }
}
