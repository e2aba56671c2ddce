//! Lengths of rays inside closed meshes, by drawing their triangles.
//!
//! The length of a ray inside a closed surface is the sum of its distances to the surface where it leaves, less those
//! where it enters (Freud, Duvauchelle, Letang and Babot 2006, Nucl. Instr. Meth. B 248:175: the "L-buffer"), so triangles
//! may come in any order: each adds its distance at every sample that it covers, with the sign of its side.
//!
//! **A sample on a shared edge counts once**: corners are rounded to 1/16384 px, edge functions are exact integers, and
//! the top-left rule gives a sample on an edge to one side. So every sample gets as many entries as exits where the mesh
//! is closed, and no ray passes through a seam.
//!
//! **Samples** form a rank-1 lattice: `n` to a pixel, no two of a pixel in the same row or column. An upright or level
//! edge thus meets `n` different distances where a square grid of as many samples has the root of `n`.
//!
//! **Depth** is exact: its inverse is linear over the picture. Sums are kept as `Z / depth - 1` against a plane `Z`
//! through the body, so that rounding to f32 is relative to the body's size and not to its distance from the source.

use biplane_geometry::{Mesh, Point2, Point3, Pose};

use crate::{IntensifierDistortion, PictureError, TrueFluoroscope};

/// One pixel in the integers that corners are rounded to, as a power of two.
const PIXEL_BITS: u32 = 14;
/// One pixel.
const PIXEL: i64 = 1 << PIXEL_BITS;
/// How far from the first pixel a corner may lie, px: products of two differences then fit an i64.
const FARTHEST_PX: f64 = 32_000.0;
/// With distortion, sides longer than this are parted, since a straight line is recorded as a curve, px. The rim of a
/// picture with shifts of 20 px bends a chord of 4 px by 20 * 6 / 512^2 * 4^2 / 8 = 0.001 px.
const LONGEST_SIDE_PX: f64 = 4.0;

/// Generators of the rank-1 lattices of 1, 2, 4, ... 256 points: of the odd numbers one with the longest shortest vector,
/// found by trying them all.
const GENERATORS: [usize; 9] = [1, 1, 3, 3, 5, 7, 19, 39, 71];

/// Where in its pixel each of a pixel's samples lies.
#[derive(Debug, Clone)]
pub(crate) struct Lattice {
    /// Offsets from the pixel's centre along x, by row; in integers of [`PIXEL`].
    offsets: Vec<i64>,
}

impl Lattice {
    /// At least `samples` to a pixel, rounded up to a power of two (so that their places are integers), 1 to 256.
    pub fn new(samples: usize) -> Self {
        let n = samples.clamp(1, 256).next_power_of_two();
        let generator = GENERATORS[n.trailing_zeros() as usize];
        let step = PIXEL / n as i64;
        let offsets =
            (0..n).map(|row| ((generator * row) % n) as i64 * step + step / 2 - PIXEL / 2).collect();
        Self { offsets }
    }

    /// Samples to a pixel, each in a row of its own.
    pub fn rows(&self) -> usize {
        self.offsets.len()
    }

    /// Offset of a sample from its pixel's centre, px.
    pub fn offset(&self, row: usize) -> [f64; 2] {
        let n = self.rows() as f64;
        [self.offsets[row] as f64 / PIXEL as f64, (row as f64 + 0.5) / n - 0.5]
    }
}

/// A part of the picture: columns and rows of pixels from the first to before the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Window {
    pub first: [usize; 2],
    pub last: [usize; 2],
}

impl Window {
    /// The smallest that holds both.
    pub fn joined(self, other: Self) -> Self {
        Self {
            first: std::array::from_fn(|a| self.first[a].min(other.first[a])),
            last: std::array::from_fn(|a| self.last[a].max(other.last[a])),
        }
    }

    pub fn width(&self) -> usize {
        self.last[0] - self.first[0]
    }

    pub fn height(&self) -> usize {
        self.last[1] - self.first[1]
    }
}

/// A view as drawing needs it.
#[derive(Debug, Clone)]
pub(crate) struct Camera<'a> {
    pub view: &'a TrueFluoroscope,
    pub distortion: &'a IntensifierDistortion,
}

impl Camera<'_> {
    /// Recorded pixel and depth of a laboratory point; `None` where it is not well in front of the source.
    pub fn project(&self, point: &Point3) -> Option<(Point2, f64)> {
        let (ideal, depth) = self.view.project(point)?;
        let recorded = self.distortion.recorded(&ideal);
        recorded.coords.iter().all(|c| c.abs() < FARTHEST_PX).then_some((recorded, depth))
    }
}

/// A corner of a triangle on the picture.
#[derive(Debug, Clone, Copy)]
struct Corner {
    /// Recorded pixel in integers of [`PIXEL`].
    x: i64,
    y: i64,
    /// `Z / depth - 1`.
    u: f32,
}

/// A mesh on the picture, before it is drawn.
pub(crate) struct Projected<'a> {
    mesh: &'a Mesh,
    corners: Vec<Corner>,
    /// Depth of the plane that depths are relative to, mm.
    plane_mm: f64,
    window: Option<Window>,
    /// -1 where the picture is mirrored (as seen from behind the detector), so that triangles run the other way.
    side: f64,
}

impl<'a> Projected<'a> {
    /// # Errors
    /// A vertex is not in front of the source, or far beside the picture.
    pub fn new(mesh: &'a Mesh, pose: &Pose, camera: &Camera) -> Result<Self, PictureError> {
        let turn = pose.rotation().to_rotation_matrix();
        let place = |p: &Point3| turn * p + pose.translation();
        let (low, high) = mesh.bounding_box();
        let middle = place(&nalgebra::center(&low, &high));
        let plane_mm = (middle - camera.view.source).dot(&camera.view.normal()).max(1.0);
        // The same projection as `TrueFluoroscope::project`, with what is common to all points taken out.
        let calibration = camera.view.calibration("");
        let matrix = nalgebra::Matrix3::from_row_slice(&calibration.matrix.concat());
        let from_model = matrix * turn.matrix();
        let from_origin = matrix * (pose.translation() - camera.view.source.coords);
        let mut corners = Vec::with_capacity(mesh.vertices().len());
        let (mut least, mut most) = ([i64::MAX; 2], [i64::MIN; 2]);
        for vertex in mesh.vertices() {
            let h = from_model * vertex.coords + from_origin;
            let recorded = camera.distortion.recorded(&Point2::new(h.x / h.z, h.y / h.z));
            let seen = h.z > 0.0 && recorded.x.abs() < FARTHEST_PX && recorded.y.abs() < FARTHEST_PX;
            if !seen {
                return Err(PictureError::OutOfBeam { point: place(vertex) });
            }
            let corner = rounded(&recorded, h.z, plane_mm);
            least = [least[0].min(corner.x), least[1].min(corner.y)];
            most = [most[0].max(corner.x), most[1].max(corner.y)];
            corners.push(corner);
        }
        let pixels = |c: i64| (c as f64) / PIXEL as f64;
        let window = window(least.map(pixels), most.map(pixels), camera.view.size);
        let across = camera.view.along_x.cross(&camera.view.along_y);
        Ok(Self { mesh, corners, plane_mm, window, side: across.dot(&camera.view.normal()).signum() })
    }

    /// What one unit of `1 / (1 + u)` counts.
    fn weight(&self, attenuation_per_mm: f64) -> f32 {
        (attenuation_per_mm * self.plane_mm * self.side) as f32
    }

    /// The pixels it may touch.
    pub fn window(&self) -> Option<Window> {
        self.window
    }
}

/// The pixels that a box of the picture touches.
pub(crate) fn window(least: [f64; 2], most: [f64; 2], size: [usize; 2]) -> Option<Window> {
    let first: [usize; 2] = std::array::from_fn(|a| (least[a] - 1.0).max(0.0) as usize);
    let last: [usize; 2] = std::array::from_fn(|a| ((most[a] + 2.0).max(0.0) as usize).min(size[a]));
    (first[0] < last[0] && first[1] < last[1]).then_some(Window { first, last })
}

fn rounded(recorded: &Point2, depth: f64, plane_mm: f64) -> Corner {
    let to_integer = |c: f64| (c * PIXEL as f64).round() as i64;
    Corner { x: to_integer(recorded.x), y: to_integer(recorded.y), u: (plane_mm / depth - 1.0) as f32 }
}

/// Attenuation along the detector's normal at every sample of a window; the one along the ray is this times the ray's
/// length over its depth.
#[derive(Debug, Clone)]
pub(crate) struct Samples {
    pub window: Window,
    pub lattice: Lattice,
    /// Row by row of samples, `lattice.rows()` rows to a pixel, one sample of a row to a pixel.
    pub values: Vec<f32>,
}

impl Samples {
    pub fn new(window: Window, lattice: &Lattice) -> Self {
        let values = vec![0.0; window.width() * window.height() * lattice.rows()];
        Self { window, lattice: lattice.clone(), values }
    }

    /// The same in a window that holds this one's.
    pub fn widened(&self, window: Window) -> Self {
        let mut wide = Self::new(window, &self.lattice);
        if self.window.width() > 0 {
            let left = self.window.first[0] - window.first[0];
            let top = (self.window.first[1] - window.first[1]) * self.lattice.rows();
            for (row, values) in self.values.chunks_exact(self.window.width()).enumerate() {
                let start = (top + row) * window.width() + left;
                wide.values[start..start + values.len()].copy_from_slice(values);
            }
        }
        wide
    }

    /// Adds a mesh whose inside attenuates by `attenuation_per_mm` more than its outside, in a picture without distortion.
    pub fn add_mesh(&mut self, drawn: &Projected, attenuation_per_mm: f64) {
        let weight = drawn.weight(attenuation_per_mm);
        for triangle in drawn.mesh.triangles() {
            self.add_triangle(triangle.map(|v| drawn.corners[v as usize]), weight);
        }
    }

    /// The same for a bent picture: long sides are parted in space and their parts projected anew. Whether a side is
    /// parted depends on the side alone, so neighbours agree.
    pub fn add_mesh_bent(
        &mut self,
        drawn: &Projected,
        pose: &Pose,
        camera: &Camera,
        attenuation_per_mm: f64,
    ) {
        let weight = drawn.weight(attenuation_per_mm);
        let mut parts = Vec::new();
        for triangle in drawn.mesh.triangles() {
            let corners = triangle.map(|v| drawn.corners[v as usize]);
            if !(0..3).any(|k| is_long(&corners[k], &corners[(k + 1) % 3])) {
                self.add_triangle(corners, weight);
                continue;
            }
            parts.push(triangle.map(|v| (drawn.mesh.vertices()[v as usize], drawn.corners[v as usize])));
            while let Some(part) = parts.pop() {
                let middles: [Option<(Point3, Corner)>; 3] = std::array::from_fn(|k| {
                    let (a, b) = (&part[k], &part[(k + 1) % 3]);
                    if !is_long(&a.1, &b.1) {
                        return None;
                    }
                    let middle = nalgebra::center(&a.0, &b.0);
                    let (recorded, depth) = camera.project(&pose.transform(&middle))?;
                    Some((middle, rounded(&recorded, depth, drawn.plane_mm)))
                });
                // Turned so that a lone middle is on the first side, and a lone whole side is the last.
                let turn = match middles.map(|m| m.is_some()) {
                    [false, false, false] => {
                        self.add_triangle(part.map(|p| p.1), weight);
                        continue;
                    }
                    [true, false, false] | [true, true, false] | [true, true, true] => 0,
                    [false, true, false] | [false, true, true] => 1,
                    [false, false, true] | [true, false, true] => 2,
                };
                let [a, b, c] = std::array::from_fn(|k| part[(k + turn) % 3]);
                let [ab, bc, ca] = std::array::from_fn(|k| middles[(k + turn) % 3]);
                match (ab, bc, ca) {
                    (Some(ab), Some(bc), Some(ca)) => {
                        parts.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
                    }
                    (Some(ab), Some(bc), None) => parts.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
                    (Some(ab), None, None) => parts.extend([[a, ab, c], [ab, b, c]]),
                    _ => {}
                }
            }
        }
    }

    /// Adds `weight * (1 / (1 + u) - 1)` where a triangle is left by the rays, and takes it away where it is entered.
    #[inline]
    fn add_triangle(&mut self, [a, mut b, mut c]: [Corner; 3], weight: f32) {
        let twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if twice_area == 0 {
            return;
        }
        // In a picture seen from the source, y downwards, an outside that looks at the source runs against the clock.
        let mut sign = weight;
        if twice_area < 0 {
            std::mem::swap(&mut b, &mut c);
            sign = -weight;
        }
        let n = self.lattice.rows() as i64;
        let row_step = PIXEL / n;
        let first_row_y = row_step / 2 - PIXEL / 2;
        let row_bits = PIXEL_BITS - n.trailing_zeros();
        let (low, high) = (self.window.first.map(|v| v as i64), self.window.last.map(|v| v as i64));
        let (y_min, y_max) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        let row_from = ((y_min - first_row_y + row_step - 1) >> row_bits).max(low[1] * n);
        let row_to = ((y_max - first_row_y) >> row_bits).min(high[1] * n - 1);
        if row_from > row_to {
            return;
        }
        let (x_min, x_max) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let edges = [Edge::new(&b, &c), Edge::new(&c, &a), Edge::new(&a, &b)];
        let over_area = 1.0 / twice_area.unsigned_abs() as f32;
        let (ub, uc) = ((b.u - a.u) * over_area, (c.u - a.u) * over_area);
        let width = self.window.width();
        for row in row_from..=row_to {
            let offset = self.lattice.offsets[(row & (n - 1)) as usize];
            let from = ((x_min - offset + PIXEL - 1) >> PIXEL_BITS).max(low[0]);
            let to = ((x_max - offset) >> PIXEL_BITS).min(high[0] - 1);
            if from > to {
                continue;
            }
            let (x, y) = (from * PIXEL + offset, row * row_step + first_row_y);
            let mut at = edges.map(|e| e.value(x, y));
            let start = (row - low[1] * n) as usize * width + (from - low[0]) as usize;
            for sample in &mut self.values[start..=start + (to - from) as usize] {
                if (at[0] | at[1] | at[2]) >= 0 {
                    let u = a.u + (at[1] + edges[1].bias) as f32 * ub + (at[2] + edges[2].bias) as f32 * uc;
                    *sample -= sign * u / (1.0 + u);
                }
                for (value, edge) in at.iter_mut().zip(&edges) {
                    *value -= edge.dy * PIXEL;
                }
            }
        }
    }
}

/// Whether a side must be parted.
fn is_long(a: &Corner, b: &Corner) -> bool {
    const LONGEST: i64 = (LONGEST_SIDE_PX * PIXEL as f64) as i64;
    (a.x - b.x).abs().max((a.y - b.y).abs()) > LONGEST
}

/// The line from one corner to the next: positive on the inside, less one where a sample on it belongs to the other side.
#[derive(Clone, Copy)]
struct Edge {
    x: i64,
    y: i64,
    dx: i64,
    dy: i64,
    bias: i64,
}

impl Edge {
    fn new(from: &Corner, to: &Corner) -> Self {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        // Of the two triangles at an edge, which run along it in opposite senses, exactly one has this.
        let own = dy < 0 || (dy == 0 && dx > 0);
        Self { x: from.x, y: from.y, dx, dy, bias: i64::from(!own) }
    }

    fn value(&self, x: i64, y: i64) -> i64 {
        self.dx * (y - self.y) - self.dy * (x - self.x) - self.bias
    }
}
