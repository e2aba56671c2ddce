//! Closed meshes of straight prisms: sheets, holes and scratches for X-ray pictures.

use biplane_geometry::{Mesh, MeshError, Point2, Point3};

use crate::shadow::circle;

/// Sides of a polygon that stands for a circle.
const SIDES: usize = 64;
/// Squares along the side of a sheet.
const SQUARES: u32 = 32;

/// Prisms along z, one beside another, as one mesh.
#[derive(Default)]
pub(crate) struct Prisms {
    vertices: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
}

impl Prisms {
    /// Adds a prism over a convex polygon that runs from x to y, from `low` to `high`, mm.
    pub fn add(&mut self, polygon: &[Point2], low: f64, high: f64) {
        let (start, n) = (self.vertices.len() as u32, polygon.len() as u32);
        for z in [low, high] {
            self.vertices.extend(polygon.iter().map(|p| Point3::new(p.x, p.y, z)));
        }
        let (bottom, top) = (|i: u32| start + i % n, |i: u32| start + n + i % n);
        for i in 0..n {
            self.triangles.extend([[bottom(i), bottom(i + 1), top(i + 1)], [bottom(i), top(i + 1), top(i)]]);
        }
        for i in 1..n.saturating_sub(1) {
            self.triangles.extend([[bottom(0), bottom(i + 1), bottom(i)], [top(0), top(i), top(i + 1)]]);
        }
    }

    /// Adds a circular cylinder, as a polygon of the circle's area: its rim is off the circle by at most
    /// `radius (pi / sides)^2 / 3`, 0.001 mm at a radius of 1.25 mm.
    pub fn add_cylinder(&mut self, centre: &Point2, radius: f64, low: f64, high: f64) {
        let turn = std::f64::consts::TAU / SIDES as f64;
        let corner_radius = radius * (turn / turn.sin()).sqrt();
        let polygon: Vec<Point2> = circle(SIDES).map(|p| centre + p * corner_radius).collect();
        self.add(&polygon, low, high);
    }

    /// Adds a square sheet about the origin, its faces of small squares: long thin triangles are slow to draw bent.
    pub fn add_sheet(&mut self, half_side: f64, low: f64, high: f64) {
        let (start, n) = (self.vertices.len() as u32, SQUARES + 1);
        let place = |i: u32| half_side * (2.0 * f64::from(i) / f64::from(SQUARES) - 1.0);
        for z in [low, high] {
            for j in 0..n {
                self.vertices.extend((0..n).map(|i| Point3::new(place(i), place(j), z)));
            }
        }
        let at = |i: u32, j: u32, face: u32| start + (face * n + j) * n + i;
        let mut add = |[a, b, c, d]: [u32; 4]| self.triangles.extend([[a, b, c], [a, c, d]]);
        for k in 0..SQUARES {
            for i in 0..SQUARES {
                add([at(i, k, 1), at(i + 1, k, 1), at(i + 1, k + 1, 1), at(i, k + 1, 1)]);
                add([at(i, k, 0), at(i, k + 1, 0), at(i + 1, k + 1, 0), at(i + 1, k, 0)]);
            }
            add([at(k, 0, 0), at(k + 1, 0, 0), at(k + 1, 0, 1), at(k, 0, 1)]);
            add([at(k + 1, SQUARES, 0), at(k, SQUARES, 0), at(k, SQUARES, 1), at(k + 1, SQUARES, 1)]);
            add([at(0, k + 1, 0), at(0, k, 0), at(0, k, 1), at(0, k + 1, 1)]);
            add([at(SQUARES, k, 0), at(SQUARES, k + 1, 0), at(SQUARES, k + 1, 1), at(SQUARES, k, 1)]);
        }
    }

    /// The mesh; `None` where nothing was added.
    ///
    /// # Errors
    /// A coordinate that is not finite, or prisms without volume.
    pub fn mesh(self) -> Result<Option<Mesh>, MeshError> {
        if self.triangles.is_empty() {
            return Ok(None);
        }
        Mesh::new(self.vertices, self.triangles).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn prisms_are_closed_and_have_their_volume() {
        let mut prisms = Prisms::default();
        prisms.add_cylinder(&Point2::new(3.0, -2.0), 1.25, -0.4, 0.4);
        let square = [[9.0, 0.0], [11.0, 0.0], [11.0, 3.0], [9.0, 3.0]].map(Point2::from);
        prisms.add(&square, 1.0, 2.0);
        prisms.add_sheet(30.0, 5.0, 5.5);
        let mesh = prisms.mesh().unwrap().unwrap();
        let topology = mesh.topology();
        assert_eq!((topology.open_edges, topology.inconsistent_edges, topology.bodies), (0, 0, 3));
        // The polygon has the circle's area.
        let expected = std::f64::consts::PI * 1.25 * 1.25 * 0.8 + 6.0 + 60.0 * 60.0 * 0.5;
        assert_relative_eq!(mesh.signed_volume(), expected, epsilon = 1e-9);
        assert_eq!(Prisms::default().mesh(), Ok(None));
    }
}
