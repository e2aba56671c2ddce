//! The shadow of a body on the rows of a picture: exact in x, a sample in y for each row of pixels.
//!
//! The boundary of the front faces, projected, winds about a pixel as often as front faces lie over it, that of the back faces likewise; a pixel is in
//! shadow where one of the two is not zero. That holds for any triangles, open or badly wound. Crossings of these boundaries with a row, in
//! order, make the row's spans.

use biplane_fluoroscope::{Fluoroscope, Projection};
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_surface::Edges;

/// A mesh laid out for its shadow. Made once a mesh.
#[derive(Debug, Clone)]
pub struct Shadow {
    vertices: Vec<Point3>,
    /// Of each face: outward normal and offset, positive on the outer side.
    planes: Vec<(Vector3, f64)>,
    ends: Vec<[u32; 2]>,
    /// Faces at each edge: `faces[start[e]..start[e + 1]]`, with +1 if the face runs from its first end to its second.
    start: Vec<u32>,
    faces: Vec<(u32, i32)>,
}

/// Spans of rows, with buffers that are used again.
#[derive(Debug, Clone, Default)]
pub struct Spans {
    facing: Vec<bool>,
    projected: Vec<Option<Projection>>,
    crossings: Vec<Crossing>,
    /// Row, from and to, in the order of rows and of x.
    spans: Vec<(u32, [f64; 2])>,
}

#[derive(Debug, Clone, Copy)]
struct Crossing {
    row: u32,
    x: f64,
    front: i32,
    back: i32,
}

impl Spans {
    /// What was found last: row, and from where to where in x, px; in the order of rows and of x, no two touch.
    pub fn spans(&self) -> &[(u32, [f64; 2])] {
        &self.spans
    }
}

impl Shadow {
    /// Builds the adjacency.
    pub fn new(mesh: &Mesh) -> Self {
        let corners = mesh.triangles().as_flattened();
        let edges = Edges::of(mesh);
        let (mut ends, mut start, mut faces) = (Vec::with_capacity(edges.len()), vec![0], Vec::new());
        for (edge, halves) in edges.iter() {
            ends.push(edge);
            let face = |half: &u32| (half / 3, if corners[*half as usize] == edge[0] { 1 } else { -1 });
            faces.extend(halves.iter().map(face));
            start.push(faces.len() as u32);
        }
        let plane = |t: usize| {
            let normal = mesh.area_vector(t);
            (normal, normal.dot(&mesh.corners(t)[0].coords))
        };
        let planes = (0..mesh.triangles().len()).map(plane).collect();
        Self { vertices: mesh.vertices().to_vec(), planes, ends, start, faces }
    }

    /// Finds the shadow at `pose` on the rows of the view's picture, within its width; `None` if a part of its boundary lies at or behind the source.
    pub fn cast(&self, pose: &Pose, view: &Fluoroscope, spans: &mut Spans) -> Option<()> {
        let Spans { facing, projected, crossings, spans } = spans;
        let source = pose.inverse().transform(view.source());
        facing.clear();
        facing.extend(self.planes.iter().map(|(normal, offset)| normal.dot(&source.coords) > *offset));
        projected.clear();
        projected.resize(self.vertices.len(), None);
        crossings.clear();
        spans.clear();
        let [width, height] = view.size().map(|n| n as f64);
        for (edge, ends) in self.ends.iter().enumerate() {
            let (mut front, mut back) = (0, 0);
            for &(face, sign) in &self.faces[self.start[edge] as usize..self.start[edge + 1] as usize] {
                *(if facing[face as usize] { &mut front } else { &mut back }) += sign;
            }
            if front == 0 && back == 0 {
                continue;
            }
            let mut seen = |v: u32| {
                let place = &mut projected[v as usize];
                if place.is_none() {
                    *place = view.project(&pose.transform(&self.vertices[v as usize]));
                }
                place.map(|p| p.pixel)
            };
            let (from, to) = (seen(ends[0])?, seen(ends[1])?);
            let (low, high, sign) = if from.y <= to.y { (from, to, 1) } else { (to, from, -1) };
            // Rows with low.y <= row < high.y, so that a corner on a row counts once.
            let rows = low.y.ceil().max(0.0)..high.y.min(height);
            let slope = (high.x - low.x) / (high.y - low.y);
            let mut row = rows.start;
            while row < rows.end {
                crossings.push(Crossing {
                    row: row as u32,
                    x: low.x + (row - low.y) * slope,
                    front: sign * front,
                    back: sign * back,
                });
                row += 1.0;
            }
        }
        crossings.sort_unstable_by(|a, b| a.row.cmp(&b.row).then(a.x.total_cmp(&b.x)));
        for row in crossings.chunk_by(|a, b| a.row == b.row) {
            let (mut front, mut back, mut begun) = (0, 0, None);
            for crossing in row {
                front += crossing.front;
                back += crossing.back;
                let covered = front != 0 || back != 0;
                match (begun, covered) {
                    (None, true) => begun = Some(crossing.x),
                    (Some(from), false) => {
                        let span = [from, crossing.x].map(|x: f64| x.clamp(-0.5, width - 0.5));
                        if span[1] > span[0] {
                            spans.push((crossing.row, span));
                        }
                        begun = None;
                    }
                    _ => {}
                }
            }
        }
        Some(())
    }
}
