//! Lengths of rays inside closed meshes, by drawing their triangles.
//!
//! The length of a ray inside a closed surface is the sum of its distances to the surface where it leaves, less those
//! where it enters (Freud, Duvauchelle, Letang and Babot 2006, Nucl. Instr. Meth. B 248:175: the "L-buffer"), so triangles
//! may come in any order: each adds its distance at every sample that it covers, with the sign of its side.
//!
//! **A sample on a shared edge counts once**: corners are rounded to 1/4096 px, edge functions are exact integers, and
//! the top-left rule gives a sample on an edge to one side. So every sample gets as many entries as exits where the mesh
//! is closed, and no ray passes through a seam.
//!
//! **Samples** form a rank-1 lattice: `n` to a pixel, no two of a pixel in the same row or column. An upright or level
//! edge thus meets `n` different distances where a square grid of as many samples has the root of `n`.
//!
//! **Depth** is exact: its inverse is linear over the picture. Sums are kept as `Z / depth - 1` against a plane `Z`
//! through one of the body's corners, so that rounding to f32 is relative to the body's size and not to its distance from the source.

use biplane_geometry::{Mesh, Point2, Point3, Pose, Vector2};

use crate::{IntensifierDistortion, PictureError, TrueFluoroscope};

/// One pixel in the integers that corners are rounded to, as a power of two.
const PIXEL_BITS: u32 = 12;
/// One pixel.
const PIXEL: i32 = 1 << PIXEL_BITS;
/// How far from the first pixel a corner may lie, px: sums of products of two differences are then below 2^53, so that
/// they are exact as floats.
const FARTHEST_PX: f64 = 8_000.0;
/// With distortion, sides longer than this are parted, since a straight line is recorded as a curve, px. The rim of a
/// picture with shifts of 20 px bends a chord of 4 px by 20 * 6 / 512^2 * 4^2 / 8 = 0.001 px.
const LONGEST_SIDE_PX: f64 = 4.0;

/// Generators of the rank-1 lattices of 1, 2, 4, ... 256 points: of the odd numbers one with the longest shortest vector,
/// found by trying them all.
const GENERATORS: [usize; 9] = [1, 1, 3, 3, 5, 7, 19, 39, 71];

/// Where in its pixel each of a pixel's samples lies: offsets from its centre in units of 1/4096 px.
#[derive(Debug, Clone)]
pub(crate) struct Lattice {
    xs: Vec<f64>,
    ys: Vec<f64>,
}

impl Lattice {
    /// At least `samples` to a pixel, rounded up to a power of two, 1 to 256; symmetric about the pixel's centre.
    pub fn new(samples: usize) -> Self {
        let n = samples.clamp(1, 256).next_power_of_two();
        let generator = GENERATORS[n.trailing_zeros() as usize];
        let step = PIXEL / n as i32;
        let place = |index: usize| f64::from(index as i32 * step + step / 2 - PIXEL / 2);
        // The shift makes sample n - 1 - k the mirror image of sample k.
        let column = |row: usize| (generator * row + (generator - 1) / 2) % n;
        Self { xs: (0..n).map(column).map(place).collect(), ys: (0..n).map(place).collect() }
    }

    /// Samples to a pixel.
    pub fn len(&self) -> usize {
        self.xs.len()
    }

    /// Their offsets from the pixel's centre, px.
    pub fn offsets_px(&self) -> Vec<Vector2> {
        self.xs.iter().zip(&self.ys).map(|(x, y)| Vector2::new(*x, *y) / f64::from(PIXEL)).collect()
    }

    /// The lattice parted among the moments of an exposure, `moments` rounded up to a power of two and at most one for two
    /// samples. Each part is symmetric about the pixel's centre, so no part leans to a side; parts that follow each other
    /// lie far apart.
    pub fn parts(&self, moments: usize) -> Vec<Self> {
        let n = self.len();
        let count = moments.clamp(1, (n / 2).max(1)).next_power_of_two();
        if count == 1 {
            return vec![self.clone()];
        }
        let part = |moment: usize| {
            let first = moment.reverse_bits() >> (usize::BITS - count.trailing_zeros());
            let pairs = (first..n / 2).step_by(count).flat_map(|k| [k, n - 1 - k]);
            let (xs, ys) = pairs.map(|k| (self.xs[k], self.ys[k])).unzip();
            Self { xs, ys }
        };
        (0..count).map(part).collect()
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
    x: i32,
    y: i32,
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
        let first = mesh.vertices().first().map(place).unwrap_or(camera.view.centre);
        let plane_mm = (first - camera.view.source).dot(&camera.view.normal()).max(1.0);
        // The same projection as `TrueFluoroscope::project`, with what is common to all points taken out.
        let calibration = camera.view.calibration("");
        let matrix = nalgebra::Matrix3::from_row_slice(&calibration.matrix.concat());
        let from_model = matrix * turn.matrix();
        let from_origin = matrix * (pose.translation() - camera.view.source.coords);
        let mut corners = Vec::with_capacity(mesh.vertices().len());
        let (mut least, mut most) = ([i32::MAX; 2], [i32::MIN; 2]);
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
        let pixels = |c: i32| f64::from(c) / f64::from(PIXEL);
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
    let to_integer = |c: f64| (c * f64::from(PIXEL)).round_ties_even() as i32;
    Corner { x: to_integer(recorded.x), y: to_integer(recorded.y), u: (plane_mm / depth - 1.0) as f32 }
}

/// Attenuation along the detector's normal at every sample of a window; the one along the ray is this times the ray's
/// length over its depth.
#[derive(Debug, Clone)]
pub(crate) struct Samples {
    pub window: Window,
    pub lattice: Lattice,
    /// Row by row of pixels, a pixel's samples after each other.
    pub values: Vec<f32>,
}

impl Samples {
    pub fn new(window: Window, lattice: &Lattice) -> Self {
        let values = vec![0.0; window.width() * window.height() * lattice.len()];
        Self { window, lattice: lattice.clone(), values }
    }

    /// Adds a mesh whose inside attenuates by `attenuation_per_mm` more than its outside.
    pub fn add_mesh(&mut self, drawn: &Projected, pose: &Pose, camera: &Camera, attenuation_per_mm: f64) {
        // The samples of a pixel that are done at once.
        let add = match self.lattice.len() {
            1 => Self::add_triangles::<1>,
            2 => Self::add_triangles::<2>,
            4 => Self::add_triangles::<4>,
            _ => Self::add_triangles::<8>,
        };
        add(self, drawn, pose, camera, drawn.weight(attenuation_per_mm));
    }

    fn add_triangles<const LANES: usize>(
        &mut self,
        drawn: &Projected,
        pose: &Pose,
        camera: &Camera,
        weight: f32,
    ) {
        if camera.distortion.is_none() {
            for triangle in drawn.mesh.triangles() {
                self.add_triangle::<LANES>(triangle.map(|v| drawn.corners[v as usize]), weight);
            }
            return;
        }
        // In a bent picture long sides are parted in space and their parts projected anew. Whether a side is parted
        // depends on the side alone, so neighbours agree.
        let mut parts = Vec::new();
        for triangle in drawn.mesh.triangles() {
            let corners = triangle.map(|v| drawn.corners[v as usize]);
            if !(0..3).any(|k| is_long(&corners[k], &corners[(k + 1) % 3])) {
                self.add_triangle::<LANES>(corners, weight);
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
                        self.add_triangle::<LANES>(part.map(|p| p.1), weight);
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
    fn add_triangle<const LANES: usize>(&mut self, [a, mut b, mut c]: [Corner; 3], weight: f32) {
        let side = |to: i32, from: i32| f64::from(to - from);
        let twice_area = side(b.x, a.x) * side(c.y, a.y) - side(b.y, a.y) * side(c.x, a.x);
        if twice_area == 0.0 {
            return;
        }
        // In a picture seen from the source, y downwards, an outside that looks at the source runs against the clock.
        let mut sign = weight;
        if twice_area < 0.0 {
            std::mem::swap(&mut b, &mut c);
            sign = -weight;
        }
        let (x_min, x_max) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (y_min, y_max) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        // The pixels whose samples may be covered: a pixel reaches half a one to each side of its centre.
        let reach = |min: i32, max: i32, axis: usize| {
            let (low, high) = (self.window.first[axis] as i32, self.window.last[axis] as i32);
            (((min + PIXEL / 2) >> PIXEL_BITS).max(low), ((max + PIXEL / 2) >> PIXEL_BITS).min(high - 1))
        };
        let ((left, right), (top, bottom)) = (reach(x_min, x_max, 0), reach(y_min, y_max, 1));
        if left > right || top > bottom {
            return;
        }
        let edges = [Edge::new(&b, &c), Edge::new(&c, &a), Edge::new(&a, &b)];
        let (u, over_area) = (f64::from(a.u), 1.0 / twice_area.abs());
        let (ub, uc) = (f64::from(b.u - a.u) * over_area, f64::from(c.u - a.u) * over_area);
        let n = self.lattice.len();
        let width = self.window.width();
        let first = (top as usize - self.window.first[1]) * width + left as usize - self.window.first[0];
        let (across, down) = ((right - left) as usize + 1, (bottom - top) as usize + 1);
        let at_first = edges.map(|e| e.value(left << PIXEL_BITS, top << PIXEL_BITS));
        for chunk in 0..n / LANES {
            let (xs, ys) = (
                &self.lattice.xs.as_chunks::<LANES>().0[chunk],
                &self.lattice.ys.as_chunks::<LANES>().0[chunk],
            );
            // How the edge functions and u differ from their values at the pixel's centre.
            let by_sample: [[f64; LANES]; 3] =
                edges.map(|e| std::array::from_fn(|l| e.dx * ys[l] - e.dy * xs[l]));
            let u_by_sample: [f32; LANES] =
                std::array::from_fn(|l| (by_sample[1][l] * ub + by_sample[2][l] * uc) as f32);
            for y in 0..down {
                let start = (first + y * width) * n + chunk * LANES;
                let mut at: [f64; 3] =
                    std::array::from_fn(|k| at_first[k] + edges[k].dx * f64::from((y as i32) << PIXEL_BITS));
                for pixel in self.values[start..start + (across - 1) * n + LANES].chunks_mut(n) {
                    let u = (u + at[1] * ub + at[2] * uc) as f32;
                    if let Some(samples) = pixel.first_chunk_mut::<LANES>() {
                        for l in 0..LANES {
                            // No branch: which samples are covered cannot be foreseen.
                            let least = (at[0] + by_sample[0][l])
                                .min(at[1] + by_sample[1][l])
                                .min(at[2] + by_sample[2][l]);
                            let u = u + u_by_sample[l];
                            samples[l] -= if least >= 0.0 { sign * u / (1.0 + u) } else { 0.0 };
                        }
                    }
                    for k in 0..3 {
                        at[k] -= edges[k].dy * f64::from(PIXEL);
                    }
                }
            }
        }
    }
}

/// Whether a side must be parted.
fn is_long(a: &Corner, b: &Corner) -> bool {
    const LONGEST: i32 = (LONGEST_SIDE_PX * PIXEL as f64) as i32;
    (a.x - b.x).abs().max((a.y - b.y).abs()) > LONGEST
}

/// The line from one corner to the next: a function that is positive on the inside and 0 on the line. All its values are
/// integers, exact as floats, but for the half that is taken away where samples on the line belong to the other side.
#[derive(Clone, Copy)]
struct Edge {
    x: i32,
    y: i32,
    dx: f64,
    dy: f64,
    bias: f64,
}

impl Edge {
    fn new(from: &Corner, to: &Corner) -> Self {
        let (dx, dy) = (f64::from(to.x - from.x), f64::from(to.y - from.y));
        // Of the two triangles at an edge, which run along it in opposite senses, exactly one has this.
        let own = dy < 0.0 || (dy == 0.0 && dx > 0.0);
        Self { x: from.x, y: from.y, dx, dy, bias: if own { 0.0 } else { 0.5 } }
    }

    fn value(&self, x: i32, y: i32) -> f64 {
        self.dx * f64::from(y - self.y) - self.dy * f64::from(x - self.x) - self.bias
    }
}
