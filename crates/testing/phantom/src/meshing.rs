//! Closed meshes of a wanted density from solids: all vertices on the surface, evenly spread.
//!
//! The solid's inside is marked on the corners of a cubic grid, whose cells at the surface give one vertex each
//! ("surface nets": Gibson, "Constrained elastic surface nets", MICCAI 1998). Where marked and unmarked corners meet only
//! across a diagonal, corners are added until none do: such a set is "well-composed" (Latecki, 1997) and its surface is a
//! closed two-manifold. The vertices then go to the surface by Newton's method and spread over it by moving towards the
//! middle of the triangles around them.
//!
//! **Guaranteed:** a closed two-manifold, wound outward, vertices within [`ON_SURFACE_MM`] of the surface's zero, their
//! number within [`NUMBER_TOLERANCE`] of the wanted one; the same mesh on every run. **Not guaranteed:** parts of the
//! body thinner than a grid cell.

use std::collections::BTreeMap;

use biplane_geometry::{Mesh, Point3, Vector3};
use nalgebra::Matrix3;

use crate::{Solid, gradient};

/// Largest value of the solid at a vertex, mm.
pub const ON_SURFACE_MM: f64 = 1e-7;
/// Largest relative difference of the number of vertices from the wanted one.
pub const NUMBER_TOLERANCE: f64 = 0.02;
/// Rounds of spreading.
const ROUNDS: usize = 12;
/// Side of a block of cells that is looked at or skipped as a whole.
const BLOCK: usize = 4;
/// Most grid corners: memory is a byte each.
const MOST_CORNERS: f64 = 4e8;

/// Why a solid could not be meshed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MeshingError {
    /// The solid's box is not a box, or too fine a grid would be needed in it.
    #[error(
        "{points} points cannot be spread over this body: ask for 100 to some 1,000,000, and check its bounds"
    )]
    Unreachable {
        /// Points asked for.
        points: usize,
    },
    /// A vertex did not get to the surface.
    #[error(
        "a vertex at {at:?} mm stays {value} mm from the surface: the body's function is not smooth enough there"
    )]
    OffSurface {
        /// Where, in the model's frame, mm.
        at: [f64; 3],
        /// The solid's value there, mm.
        value: f64,
    },
}

/// The grid over a solid: which corners are inside.
struct Grid {
    origin: Point3,
    /// The grid's axes, as long as a cell.
    axes: Matrix3<f64>,
    /// Corners along each axis: cells and one more.
    corners: [usize; 3],
    inside: Vec<bool>,
    /// Blocks that the surface may pass, by their first cell.
    blocks: Vec<[usize; 3]>,
}

impl Grid {
    fn new(solid: &dyn Solid, cell: f64, points: usize) -> Result<Self, MeshingError> {
        // Axes that all lean equally to those of the model: flat faces along the model's axes, which implants have, then get
        // as many cells for their area as the rest of the surface has in the mean.
        let turn = Matrix3::new(2.0, -1.0, 2.0, 2.0, 2.0, -1.0, -1.0, 2.0, 2.0) / 3.0;
        let (low, high) = solid.bounds();
        let half = turn.transpose().abs() * (high - low) / 2.0 + Vector3::repeat(1.4 * cell);
        let origin = nalgebra::center(&low, &high) - turn * half;
        let cells = half * 2.0 / cell;
        if !(cell > 0.0 && cells.iter().all(|n| *n >= 1.0) && cells.product() < MOST_CORNERS) {
            return Err(MeshingError::Unreachable { points });
        }
        let blocks = cells.map(|n| (n / BLOCK as f64).ceil() as usize);
        let corners = [0, 1, 2].map(|i| blocks[i] * BLOCK + 1);
        let mut grid = Self {
            origin,
            axes: turn * cell,
            corners,
            inside: vec![false; corners.iter().product()],
            blocks: Vec::new(),
        };
        // A block of blocks first: most of the box is far from the surface.
        const COARSE: usize = 4;
        let coarse = [0, 1, 2].map(|i| blocks[i].div_ceil(COARSE));
        for at in triples(coarse) {
            let first = at.map(|n| n * COARSE);
            let value = grid.middle_value(solid, first.map(|n| n * BLOCK), COARSE * BLOCK);
            let last = [0, 1, 2].map(|i| (first[i] + COARSE).min(blocks[i]) - first[i]);
            for within in triples(last) {
                let block = [0, 1, 2].map(|i| (first[i] + within[i]) * BLOCK);
                grid.mark(solid, block, value);
            }
        }
        Ok(grid)
    }

    fn corner(&self, at: [usize; 3]) -> Point3 {
        self.origin + self.axes * Vector3::new(at[0] as f64, at[1] as f64, at[2] as f64)
    }

    fn index(&self, at: [usize; 3]) -> usize {
        (at[2] * self.corners[1] + at[1]) * self.corners[0] + at[0]
    }

    /// The solid's value in the middle of a cube of `side` cells, none if the surface may pass the cube.
    fn middle_value(&self, solid: &dyn Solid, first: [usize; 3], side: usize) -> Option<f64> {
        let to_middle = self.axes * Vector3::repeat(side as f64 / 2.0);
        let value = solid.value(&(self.corner(first) + to_middle));
        (value.abs() > to_middle.norm()).then_some(value)
    }

    /// Marks the corners of a block; `known` is the value of a cube around it that the surface does not pass.
    fn mark(&mut self, solid: &dyn Solid, block: [usize; 3], known: Option<f64>) {
        let known = known.or_else(|| self.middle_value(solid, block, BLOCK));
        if known.is_some_and(|v| v > 0.0) {
            return;
        }
        if known.is_none() {
            self.blocks.push(block);
        }
        for within in triples([BLOCK + 1; 3]) {
            let at = [0, 1, 2].map(|i| block[i] + within[i]);
            let i = self.index(at);
            self.inside[i] = known.is_some() || self.inside[i] || solid.value(&self.corner(at)) < 0.0;
        }
    }

    /// The corners of a cell that are inside, a bit each: bit 0 for x, bit 1 for y, bit 2 for z of the corner's number.
    fn mask(&self, cell: [usize; 3]) -> u8 {
        (0..8).filter(|&c| self.inside[self.index(corner_of(cell, c))]).fold(0, |mask, c| mask | 1 << c)
    }

    /// Cells at the surface, in order.
    fn cells(&self) -> Vec<[usize; 3]> {
        let mut cells: Vec<[usize; 3]> = self
            .blocks
            .iter()
            .flat_map(|block| triples([BLOCK; 3]).map(|w| [0, 1, 2].map(|i| block[i] + w[i])))
            .filter(|cell| !matches!(self.mask(*cell), 0 | 255))
            .collect();
        cells.sort_unstable_by_key(|cell| self.index(*cell));
        cells
    }

    /// Adds corners to the inside until no cell has parts that meet across a diagonal only.
    fn compose(&mut self, solid: &dyn Solid) {
        let mut doubtful = self.cells();
        while !doubtful.is_empty() {
            let mut added = Vec::new();
            for cell in doubtful {
                while !well_composed(self.mask(cell)) {
                    let outside = (0..8).map(|c| corner_of(cell, c)).filter(|c| !self.inside[self.index(*c)]);
                    let nearest = outside.min_by(|a, b| {
                        solid.value(&self.corner(*a)).total_cmp(&solid.value(&self.corner(*b)))
                    });
                    let Some(nearest) = nearest else { break };
                    let i = self.index(nearest);
                    self.inside[i] = true;
                    added.push(nearest);
                }
            }
            doubtful = added
                .iter()
                .flat_map(|corner| (0..8).filter_map(|c| cell_before(*corner, c)))
                .filter(|cell| (0..3).all(|i| cell[i] + 1 < self.corners[i]))
                .collect();
            // A corner on the rim of a block may have made cells of its neighbour part of the surface.
            for cell in &doubtful {
                let block = cell.map(|n| n / BLOCK * BLOCK);
                if !self.blocks.contains(&block) {
                    self.blocks.push(block);
                }
            }
        }
    }
}

/// All triples below `size`, the first number running fastest.
fn triples(size: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..size[2]).flat_map(move |k| (0..size[1]).flat_map(move |j| (0..size[0]).map(move |i| [i, j, k])))
}

/// A corner of a cell by its number.
fn corner_of(cell: [usize; 3], corner: u8) -> [usize; 3] {
    [0, 1, 2].map(|i| cell[i] + usize::from(corner >> i & 1))
}

/// The cell of which a grid corner is the corner of that number.
fn cell_before(at: [usize; 3], corner: u8) -> Option<[usize; 3]> {
    let mut cell = at;
    for (i, n) in cell.iter_mut().enumerate() {
        *n = n.checked_sub(usize::from(corner >> i & 1))?;
    }
    Some(cell)
}

/// Whether the corners inside hang together along edges of the cell, those outside too, and on every face as well.
fn well_composed(mask: u8) -> bool {
    let connected = |set: u8| {
        let mut reached = set & set.wrapping_neg();
        for _ in 0..8 {
            let spread = (0..8u8)
                .filter(|c| reached >> c & 1 == 1)
                .fold(reached, |r, c| r | (0..3).fold(0, |n, axis| n | 1 << (c ^ 1 << axis)));
            reached = spread & set;
        }
        reached == set
    };
    let faces = (0..3u8).all(|axis| {
        (0..2u8).all(|side| {
            let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            let first = side << axis;
            let [a, b, c, d] = [first, first | u, first | u | v, first | v].map(|n| mask >> n & 1);
            !(a == c && b == d && a != b)
        })
    });
    connected(mask) && connected(!mask) && faces
}

/// A mesh of a solid with about `points` vertices.
///
/// # Errors
/// The number cannot be reached with a grid of sensible size, or the solid's function does not lead to its surface.
pub fn mesh(solid: &dyn Solid, points: usize) -> Result<Mesh, MeshingError> {
    let unreachable = MeshingError::Unreachable { points };
    let (low, high) = solid.bounds();
    let size = high - low;
    if points < 50 || !(size.min() > 0.0 && size.max().is_finite()) {
        return Err(unreachable);
    }
    let wanted = points as f64;
    let mut cell = ((size.x * size.y + size.y * size.z + size.z * size.x) * 2.0 / wanted).sqrt();
    for _ in 0..12 {
        let mut grid = Grid::new(solid, cell, points)?;
        grid.compose(solid);
        let cells = grid.cells();
        let ratio = cells.len() as f64 / wanted;
        if (ratio - 1.0).abs() < NUMBER_TOLERANCE * 0.9 {
            return net(solid, &grid, &cells, points);
        }
        cell *= if cells.is_empty() { 0.5 } else { ratio.sqrt().clamp(0.25, 4.0) };
    }
    Err(unreachable)
}

/// The surface net over the cells: four-sided faces, one for each grid edge from inside to outside, made triangles.
fn net(solid: &dyn Solid, grid: &Grid, cells: &[[usize; 3]], points: usize) -> Result<Mesh, MeshingError> {
    let mut vertices: Vec<Point3> = cells.iter().map(|cell| start(grid, *cell)).collect();
    let number = |cell: Option<[usize; 3]>| {
        cell.and_then(|c| cells.binary_search_by_key(&grid.index(c), |c| grid.index(*c)).ok())
    };
    let mut faces: Vec<[usize; 4]> = Vec::with_capacity(cells.len());
    for cell in cells {
        let here = grid.inside[grid.index(*cell)];
        for axis in 0..3 {
            let (u, v) = (1u8 << ((axis + 1) % 3), 1u8 << ((axis + 2) % 3));
            if grid.inside[grid.index(corner_of(*cell, 1 << axis))] == here {
                continue;
            }
            let around = [0, u, u | v, v].map(|c| number(cell_before(*cell, c)));
            if let [Some(a), Some(b), Some(c), Some(d)] = around {
                // Counter-clockwise seen from the end of the axis; turned where the outside is on the other end.
                faces.push(if here { [a, b, c, d] } else { [d, c, b, a] });
            }
        }
    }
    for vertex in &mut vertices {
        settle(solid, vertex);
        settle(solid, vertex);
    }
    for _ in 0..ROUNDS {
        spread(solid, &mut vertices, &faces);
    }
    for vertex in &mut vertices {
        let value = finish(solid, vertex);
        let there = value.abs() <= ON_SURFACE_MM;
        if !there {
            return Err(MeshingError::OffSurface { at: (*vertex).into(), value });
        }
    }
    let triangles = faces.iter().flat_map(|f| split(&vertices, f)).collect();
    Mesh::new(vertices, triangles).map_err(|_| MeshingError::Unreachable { points })
}

/// Where a cell's vertex starts: the mean of the middles of its edges from inside to outside.
fn start(grid: &Grid, cell: [usize; 3]) -> Point3 {
    let mask = grid.mask(cell);
    let (mut sum, mut count) = (Vector3::zeros(), 0.0);
    for c in 0..8u8 {
        for axis in (0..3).filter(|axis| c >> axis & 1 == 0) {
            let other = c | 1 << axis;
            if mask >> c & 1 != mask >> other & 1 {
                sum += (grid.corner(corner_of(cell, c)).coords + grid.corner(corner_of(cell, other)).coords)
                    / 2.0;
                count += 1.0;
            }
        }
    }
    Point3::from(sum / count)
}

/// The two triangles of a four-sided face, parted along its shorter diagonal.
fn split(vertices: &[Point3], &[a, b, c, d]: &[usize; 4]) -> [[u32; 3]; 2] {
    let along = |i: usize, j: usize| (vertices[i] - vertices[j]).norm_squared();
    let [p, q, r, s] = [a, b, c, d].map(|n| n as u32);
    if along(a, c) <= along(b, d) { [[p, q, r], [p, r, s]] } else { [[p, q, s], [q, r, s]] }
}

/// One step of Newton's method towards the surface, with the gradient from forward differences.
fn settle(solid: &dyn Solid, vertex: &mut Point3) {
    const STEP_MM: f64 = 1e-4;
    let value = solid.value(vertex);
    let slope = Vector3::from_fn(|axis, _| {
        let mut at = *vertex;
        at[axis] += STEP_MM;
        (solid.value(&at) - value) / STEP_MM
    });
    *vertex -= slope * (value / slope.norm_squared().max(0.01));
}

/// Newton's method to the end; the value that is left.
fn finish(solid: &dyn Solid, vertex: &mut Point3) -> f64 {
    let mut value = solid.value(vertex);
    for _ in 0..30 {
        if value.abs() < ON_SURFACE_MM * 0.01 {
            break;
        }
        let slope = gradient(solid, vertex);
        *vertex -= slope * (value / slope.norm_squared().max(0.01));
        value = solid.value(vertex);
    }
    value
}

/// Moves every vertex along the surface towards the middle of the triangles around it, weighted by area.
fn spread(solid: &dyn Solid, vertices: &mut [Point3], faces: &[[usize; 4]]) {
    let mut middles = vec![(Vector3::zeros(), 0.0, Vector3::zeros()); vertices.len()];
    for triangle in faces.iter().flat_map(|f| split(vertices, f)) {
        let [a, b, c] = triangle.map(|v| vertices[v as usize]);
        let area = (b - a).cross(&(c - a));
        let (size, middle) = (area.norm(), (a.coords + b.coords + c.coords) / 3.0);
        for v in triangle {
            let sum = &mut middles[v as usize];
            sum.0 += middle * size;
            sum.1 += size;
            sum.2 += area;
        }
    }
    for (vertex, (middle, size, area)) in vertices.iter_mut().zip(middles) {
        let (Some(normal), true) = (area.try_normalize(0.0), size > 0.0) else { continue };
        let shift = middle / size - vertex.coords;
        *vertex += shift - normal * shift.dot(&normal);
        settle(solid, vertex);
    }
}

/// A ball's mesh about the origin: an icosahedron whose faces are divided, all vertices on the ball. The number of points
/// is the one of the form `10 n^2 + 2` that is nearest to the wanted one.
///
/// # Errors
/// The radius is not a positive number, or more than 10,000,000 points are wanted.
pub fn ball_mesh(radius: f64, points: usize) -> Result<Mesh, MeshingError> {
    if !(radius > 0.0 && radius.is_finite()) || points > 10_000_000 {
        return Err(MeshingError::Unreachable { points });
    }
    let n = ((points as f64 / 10.0).sqrt().round() as usize).max(1);
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let corners = [0, 1, 2].map(|axis| {
        [[1.0, golden], [-1.0, golden], [1.0, -golden], [-1.0, -golden]].map(|[one, long]| {
            let mut corner = Vector3::zeros();
            corner[(axis + 1) % 3] = one;
            corner[(axis + 2) % 3] = long;
            corner
        })
    });
    let corners = corners.as_flattened();
    // The twelve corners have sides of length 2; three that are all that far from each other are a face.
    let joined = |a: usize, b: usize| ((corners[a] - corners[b]).norm() - 2.0).abs() < 1e-9;
    let mut numbers: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (a, b, c) in (0..12).flat_map(|a| (a + 1..12).flat_map(move |b| (b + 1..12).map(move |c| (a, b, c))))
    {
        if !(joined(a, b) && joined(b, c) && joined(a, c)) {
            continue;
        }
        let outward = corners[a].cross(&corners[b]).dot(&corners[c]) > 0.0;
        let [p, q, r] = if outward { [a, b, c] } else { [a, c, b] }.map(|k| corners[k]);
        let mut vertex = |i: usize, j: usize| {
            let along = |from: Vector3, to: Vector3, part: usize| (to - from) * (part as f64 / n as f64);
            let direction = (p + along(p, q, i) + along(p, r, j)).normalize();
            // Faces share the vertices on their sides: the same but for rounding.
            let key: [i64; 3] = (direction * 1e7).map(|v| v.round() as i64).into();
            *numbers.entry(key).or_insert_with(|| {
                vertices.push(Point3::from(direction * radius));
                vertices.len() as u32 - 1
            })
        };
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j))) {
            triangles.push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
            if i + j + 2 <= n {
                triangles.push([vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
            }
        }
    }
    Mesh::new(vertices, triangles).map_err(|_| MeshingError::Unreachable { points })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ball;
    use biplane_geometry::Topology;

    const CLOSED: Topology =
        Topology { open_edges: 0, non_manifold_edges: 0, inconsistent_edges: 0, bodies: 1 };

    #[test]
    fn balls_have_the_points_wanted_on_them() {
        for (points, expected) in [(1, 12), (12, 12), (2500, 2562), (9500, 9612)] {
            let ball = ball_mesh(7.0, points).unwrap();
            assert_eq!(ball.vertices().len(), expected);
            assert_eq!(ball.topology(), CLOSED);
            assert!(ball.signed_volume() > 0.0);
            assert!(ball.vertices().iter().all(|v| (v.coords.norm() - 7.0).abs() < 1e-12));
        }
        assert!(ball_mesh(f64::NAN, 100).is_err());
    }

    #[test]
    fn a_ball_meshed_as_a_solid_has_its_volume() {
        let ball = Ball { centre: Point3::new(3.0, -2.0, 1.0), radius: 10.0 };
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 1000.0;
        let short = [3_500, 36_000].map(|points| 1.0 - mesh(&ball, points).unwrap().signed_volume() / volume);
        // A chord of length h falls short of the ball by h^2 / 8 r: in proportion to one over the number of points.
        assert!(short[0] > 0.0 && short[0] < 0.003, "{short:?}");
        assert!((short[0] / short[1] * 3_500.0 / 36_000.0 - 1.0).abs() < 0.1, "{short:?}");
    }

    #[test]
    fn impossible_wishes_are_errors() {
        let ball = Ball { centre: Point3::origin(), radius: 10.0 };
        assert!(mesh(&ball, 3).is_err());
        assert!(mesh(&ball, usize::MAX).is_err());
        assert!(mesh(&Ball { radius: f64::NAN, ..ball }, 3_500).is_err());
        assert!(mesh(&Ball { radius: -1.0, ..ball }, 3_500).is_err());
    }
}
