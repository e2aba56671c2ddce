//! How long the way of rays through a body is, from its rim inward.

use biplane_geometry::{Point3, Vector3};
use biplane_surface::Surface;

/// Depths at which chords are taken.
pub const NODES: usize = 20;
/// Root of the depth of the first, px: chords of a smooth rim grow as the root of the depth, so steps are even in it.
pub(crate) const STEP: f64 = 0.175;
/// A rim may lie this far from where its chords begin, px: an outline that is corrected for the curvature between vertices runs
/// outside the triangles.
const RIM_PX: f64 = 3.0;

/// Lengths of chords, mm, at depths of `(j STEP)^2` px inside the rim, `j` from 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chords(pub(crate) [f64; NODES]);

/// What is cut out of a triangle by the plane of a source and a normal of the outline: depths in the picture, px, and ways from
/// the source, in ways of the rim point.
#[derive(Debug, Clone, Copy)]
struct Piece {
    from: [f64; 2],
    to: [f64; 2],
    sign: f64,
}

/// Finds chords; keeps its buffer.
#[derive(Debug, Default)]
pub struct ChordFinder {
    pieces: Vec<Piece>,
}

impl Chords {
    /// Those of a smooth rim with a radius of curvature along the ray: `sqrt(8 r d)` at the depth `d`.
    pub fn of_radius(radius_mm: f64, mm_per_px: f64) -> Self {
        let slope = (8.0 * radius_mm.max(0.0) * mm_per_px.max(0.0)).sqrt();
        Self(std::array::from_fn(|j| slope * STEP * (j + 1) as f64))
    }
}

impl ChordFinder {
    /// Chords of a surface from a rim point inward; none where it has no rim or is open there. All in the frame of the surface:
    /// `inward` is by how much a point beside the rim point has to move, at its depth and parallel to the detector, to be seen one
    /// pixel farther inside.
    pub fn find(
        &mut self,
        surface: &Surface,
        source: &Point3,
        rim: &Point3,
        inward: &Vector3,
    ) -> Option<Chords> {
        let ray = rim - source;
        // A point of the plane is `a ray + b inward` from the source and is seen `b / a` px inside the rim.
        let normal = ray.cross(inward);
        let squared = normal.norm_squared();
        if squared.is_nan() || squared <= 0.0 {
            return None;
        }
        let (along, across) = (inward.cross(&normal) / squared, normal.cross(&ray) / squared);
        let (reach, pieces) = ((STEP * NODES as f64).powi(2), &mut self.pieces);
        pieces.clear();
        // Rays of all depths are within this of the middle one, and a little beyond the body they part by as little.
        let half = (reach + RIM_PX) / 2.0;
        let middle = ray + inward * (reach / 2.0);
        surface.along(source, &middle, &normal, 1.2 * half * inward.norm(), |corners| {
            let heights = corners.map(|c| normal.dot(&(c - source)));
            let below = heights.map(|h| h < 0.0);
            let count = below.iter().filter(|b| **b).count();
            if count == 0 || count == 3 {
                return;
            }
            // The corner that is alone on its side.
            let Some(k) = (0..3).find(|&k| below[k] == (count == 1)) else { return };
            let cut = |other: usize| {
                // Both triangles of an edge cut it from below, so that they agree to the bit.
                let (low, high) = if below[k] { (k, other) } else { (other, k) };
                let share = heights[low] / (heights[low] - heights[high]);
                let v = corners[low] + (corners[high] - corners[low]) * share - source;
                [along.dot(&v), across.dot(&v)]
            };
            let (from, to) = (cut((k + 1) % 3), cut((k + 2) % 3));
            if from[0] <= 0.0 || to[0] <= 0.0 {
                return;
            }
            let outward = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            pieces.push(Piece { from, to, sign: outward.dot(&ray).signum() });
        });
        let ends = |p: &Piece| {
            let (a, b) = (p.from[1] / p.from[0], p.to[1] / p.to[0]);
            (a.min(b), a.max(b))
        };
        let begin = pieces.iter().map(ends).filter(|e| e.1 > 0.0).map(|e| e.0).fold(f64::INFINITY, f64::min);
        if begin.is_nan() || begin > RIM_PX {
            return None;
        }
        let begin = begin.max(-RIM_PX);
        let mut lengths = [0.0; NODES];
        // How often more a ray leaves than it enters.
        let mut balance = [0.0; NODES];
        for piece in pieces.iter() {
            let (low, high) = ends(piece);
            if high <= begin {
                continue;
            }
            let place = |depth: f64| (((depth - begin).max(0.0).sqrt() / STEP).ceil() as usize).max(1);
            for j in place(low)..=NODES {
                let depth = begin + (STEP * j as f64).powi(2);
                if depth < low || depth >= high {
                    if depth >= high {
                        break;
                    }
                    continue;
                }
                let [a, b] = piece.from;
                let (da, db) = (piece.to[0] - a, piece.to[1] - b);
                let t = ((depth * a - b) / (db - depth * da)).clamp(0.0, 1.0);
                let way = (ray + inward * depth).norm();
                lengths[j - 1] += piece.sign * (a + t * da) * way;
                balance[j - 1] += piece.sign;
            }
        }
        // A surface that is wound inward has all its chords negative; an open one lets rays in and not out.
        balance.iter().all(|b| *b == 0.0).then(|| Chords(lengths.map(f64::abs)))
    }
}

#[cfg(test)]
mod tests {
    use biplane_geometry::Mesh;
    use biplane_phantom::ball_mesh;

    use super::*;

    const SOURCE: Point3 = Point3::new(0.0, 0.0, -500.0);
    const MM_PER_PX: f64 = 0.15;

    /// A block of 20 x 20 mm across the ray and `z` along it, its near face at -10 mm.
    fn block(z: f64) -> Mesh {
        let corner = |k: u32| {
            let side = |bit: u32, low: f64, high: f64| if k >> bit & 1 == 0 { low } else { high };
            Point3::new(side(0, -10.0, 10.0), side(1, -10.0, 10.0), side(2, -10.0, z - 10.0))
        };
        let faces: [[u32; 4]; 6] =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh::new((0..8).map(corner).collect(), triangles).unwrap()
    }

    #[test]
    fn chords_of_a_ball_are_those_of_a_circle() {
        let radius = 12.0;
        let mesh = ball_mesh(radius, 40_000).unwrap();
        // Where the tangent touches, and a point outside it as a smoothed rim would have it.
        let sine: f64 = radius / 500.0;
        let cosine = (1.0 - sine * sine).sqrt();
        let rim = Point3::new(radius * cosine, 0.0, -radius * sine);
        let inward = Vector3::new(-MM_PER_PX, 0.0, 0.0);
        for (surface, off) in [(mesh.clone(), 0.0), (mesh.clone().inverted(), 0.0), (mesh, 0.4)] {
            let surface = Surface::new(&surface);
            let seen = rim - inward * off;
            let found = ChordFinder::default().find(&surface, &SOURCE, &seen, &inward).unwrap();
            for (j, length) in found.0.iter().enumerate() {
                let depth = (STEP * (j + 1) as f64).powi(2);
                let ray = (rim + inward * depth - SOURCE).normalize();
                let nearest = (Point3::origin() - SOURCE).cross(&ray).norm();
                let expected = 2.0 * (radius * radius - nearest * nearest).sqrt();
                // Facets of 0.2 mm: the first chords are between two of them.
                assert!((length - expected).abs() < 0.05 + 0.01 * expected, "{j}: {length} {expected}");
            }
            let smooth = Chords::of_radius(radius, MM_PER_PX);
            assert!((found.0[5] / smooth.0[5] - 1.0).abs() < 0.02);
        }
    }

    #[test]
    fn a_wall_along_the_ray_has_its_whole_chord_at_once_and_a_thin_body_no_more_than_it_is_thick() {
        for thick in [2.0, 15.0] {
            let surface = Surface::new(&block(thick));
            // The near edge of the face x = 10 is the rim; the wall behind it is hidden by it.
            let (rim, inward) = (Point3::new(10.0, 1.3, -10.0), Vector3::new(-MM_PER_PX, 0.0, 0.0));
            let found = ChordFinder::default().find(&surface, &SOURCE, &rim, &inward).unwrap();
            // From the near face to the wall or to the far face, whichever the ray meets first.
            for (j, length) in found.0.iter().enumerate() {
                let depth = (STEP * (j + 1) as f64).powi(2);
                let slope = (10.0 - depth * MM_PER_PX) / 490.0;
                let through = (depth * MM_PER_PX / slope).min(thick);
                let slant = (1.0 + slope * slope + (1.3_f64 / 490.0).powi(2)).sqrt();
                assert!((length - through * slant).abs() < 1e-9, "{thick} {j}: {length} {through}");
            }
        }
    }

    #[test]
    fn where_there_is_no_rim_there_are_no_chords() {
        let surface = Surface::new(&block(5.0));
        let mut finder = ChordFinder::default();
        let inward = Vector3::new(-MM_PER_PX, 0.0, 0.0);
        assert_eq!(finder.find(&surface, &SOURCE, &Point3::new(30.0, 0.0, 0.0), &inward), None);
        assert_eq!(finder.find(&surface, &SOURCE, &Point3::new(10.0, 0.0, 0.0), &Vector3::zeros()), None);
        assert_eq!(finder.find(&surface, &SOURCE, &SOURCE, &inward), None);
        // Without its near face.
        let whole = block(5.0);
        let open = Mesh::new(whole.vertices().to_vec(), whole.triangles()[2..].to_vec()).unwrap();
        let rim = Point3::new(10.0, 1.3, -10.0);
        assert_eq!(finder.find(&Surface::new(&open), &SOURCE, &rim, &inward), None);
    }
}
