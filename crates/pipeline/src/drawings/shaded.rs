//! A mesh as one sees it: a picture with light and shade, and what of a line on it is hidden.
//!
//! Triangles are drawn into a buffer of depths at twice the picture's resolution; each dot is shaded by Lambert's law with light
//! from the viewer's upper left and some from everywhere; outlines are darkened; then dots are averaged. Normals are means over a
//! corner's triangles, but not across edges sharper than 40 degrees, so that bones look round and implants keep their edges.

use biplane_geometry::{Mesh, Point3, Vector3};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::camera::Camera;
use super::{DrawingError, base64};

/// How finely a picture is drawn: dots for each unit of the drawing, before averaging.
pub(super) const FINE: f64 = 2.5;
/// See [`FINE`]: for small pictures and for such as have so many colours that their file is large.
pub(super) const COARSE: f64 = 2.0;
/// Dots that are averaged, along either side.
const AVERAGED: usize = 2;
/// Cosine of the sharpest edge that is shown round.
const ROUND: f32 = 0.766;
/// Where the light comes from: right, up, toward the viewer.
const LIGHT: [f32; 3] = [-0.397, 0.496, 0.772];
/// Share of the light that comes from everywhere.
const AMBIENT: f32 = 0.36;
/// Steps of light: nobody sees them, and the picture's file is far smaller.
const STEPS: f32 = 56.0;
/// How far a line may lie below the surface and still be drawn on it, mm and units of the drawing.
const BELOW_MM: f64 = 0.4;
const BELOW: f64 = 2.0;
/// A step in depth, in units of the drawing, that is an outline.
const OUTLINE: f64 = 7.0;

/// Colour of a bone where no other is asked for.
pub(super) const BONE: [f32; 3] = [236.0, 227.0, 208.0];
/// The inside of a surface that is open.
const INSIDE: [f32; 3] = [190.0, 142.0, 122.0];

/// A mesh made ready for drawing.
#[derive(Debug)]
pub(super) struct Shape<'a> {
    pub mesh: &'a Mesh,
    /// Unit normals in the corners of each triangle.
    normals: Vec<[[f32; 3]; 3]>,
}

impl<'a> Shape<'a> {
    pub(super) fn new(mesh: &'a Mesh) -> Self {
        let single = |v: &Vector3| [v.x as f32, v.y as f32, v.z as f32];
        let triangles = mesh.triangles();
        let areas: Vec<[f32; 3]> = (0..triangles.len()).map(|t| single(&(mesh.area_vector(t)))).collect();
        let faces: Vec<[f32; 3]> = areas.iter().map(|a| normalised(*a)).collect();
        // The triangles about each vertex, by counting.
        let mut start = vec![0_u32; mesh.vertices().len() + 1];
        for &v in triangles.as_flattened() {
            start[v as usize + 1] += 1;
        }
        for v in 1..start.len() {
            start[v] += start[v - 1];
        }
        let mut next = start.clone();
        let mut about = vec![0_u32; triangles.len() * 3];
        for (t, corners) in triangles.iter().enumerate() {
            for &v in corners {
                about[next[v as usize] as usize] = t as u32;
                next[v as usize] += 1;
            }
        }
        // A vertex with a great many triangles (the tip of a fan) is not made round: it would take the square of their number.
        const MOST: usize = 64;
        let normal = |t: usize, v: u32| {
            let around = &about[start[v as usize] as usize..start[v as usize + 1] as usize];
            if around.len() > MOST {
                return faces[t];
            }
            let mut sum = [0.0; 3];
            for &other in around {
                if dot(faces[t], faces[other as usize]) > ROUND {
                    let area = areas[other as usize];
                    (0..3).for_each(|a| sum[a] += area[a]);
                }
            }
            let sum = normalised(sum);
            if sum == [0.0; 3] { faces[t] } else { sum }
        };
        let normals =
            triangles.iter().enumerate().map(|(t, corners)| corners.map(|v| normal(t, v))).collect();
        Self { mesh, normals }
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn normalised(v: [f32; 3]) -> [f32; 3] {
    // Twice, since the square of a small or large number is none.
    let most = v.iter().fold(0.0_f32, |m, c| m.max(c.abs()));
    if !(most > 0.0 && most < f32::INFINITY) {
        return [0.0; 3];
    }
    let v = v.map(|c| c / most);
    let length = dot(v, v).sqrt();
    v.map(|c| c / length)
}

/// What colours a surface.
#[derive(Clone, Copy)]
pub(super) enum Paint<'a> {
    /// One colour, and how far it is faded towards white, 0 to 1.
    Plain { faded: f32 },
    /// A value at each vertex, and the colour of a value.
    Values { values: &'a [f32], colour: &'a dyn Fn(f32) -> [f32; 3] },
}

/// A picture, and the depths of what is seen in it.
#[derive(Debug)]
pub(super) struct Picture {
    /// As PNG, in base64.
    pub base64: String,
    camera: Camera,
    /// Dots for each unit of the drawing.
    fineness: f64,
    /// Columns and rows of dots, and the depth of each; negative infinity where nothing is.
    size: [usize; 2],
    depths: Vec<f32>,
}

/// Draws a mesh through a camera.
///
/// # Errors
/// The picture cannot be written as PNG.
pub(super) fn shaded(
    shape: &Shape,
    camera: &Camera,
    paint: Paint,
    fineness: f64,
) -> Result<Picture, DrawingError> {
    let dots = camera.enlarged(fineness);
    let even = |v: f64| (v.clamp(2.0, 8000.0) as usize).next_multiple_of(AVERAGED);
    let size = [0, 1].map(|a| even(dots.size()[a]));
    let mut buffer = Buffer {
        size,
        depths: vec![f32::NEG_INFINITY; size[0] * size[1]],
        colours: vec![[0; 3]; size[0] * size[1]],
    };
    let mesh = shape.mesh;
    let seen: Vec<[f64; 3]> = mesh
        .vertices()
        .iter()
        .map(|p| {
            let [x, y] = dots.onto(p);
            [x, y, dots.depth(dots.nearness(p))]
        })
        .collect();
    let turn = [Vector3::x(), Vector3::y(), Vector3::z()].map(|e| dots.turned(&e));
    let row = |a: usize| [turn[0][a] as f32, turn[1][a] as f32, turn[2][a] as f32];
    let rows = [row(0), row(1), row(2)];
    for (corners, normals) in mesh.triangles().iter().zip(&shape.normals) {
        let at = corners.map(|v| seen[v as usize]);
        let normals = normals.map(|n| rows.map(|row| dot(row, n)));
        let values = match paint {
            Paint::Values { values, .. } => corners.map(|v| values.get(v as usize).copied().unwrap_or(0.0)),
            Paint::Plain { .. } => [0.0; 3],
        };
        buffer.triangle(at, normals, values, paint);
    }
    let step = (OUTLINE / camera.scale()) as f32;
    let nearness = |d: f32| dots.nearness_of(f64::from(d)) as f32;
    let bytes = buffer.averaged(step, nearness);
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive).write_image(
        &bytes,
        (size[0] / AVERAGED) as u32,
        (size[1] / AVERAGED) as u32,
        ExtendedColorType::Rgb8,
    )?;
    Ok(Picture { base64: base64::encode(&png), camera: *camera, fineness, size, depths: buffer.depths })
}

struct Buffer {
    size: [usize; 2],
    depths: Vec<f32>,
    colours: Vec<[u8; 3]>,
}

impl Buffer {
    fn triangle(&mut self, at: [[f64; 3]; 3], normals: [[f32; 3]; 3], values: [f32; 3], paint: Paint) {
        let [a, b, c] = at;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area.is_nan() || area.abs() < 1e-9 {
            return;
        }
        // In a picture with y down a triangle that faces the viewer runs the other way.
        let faces = area < 0.0;
        // Casts saturate: what lies outside is cut off.
        let span = |axis: usize| {
            let low = at.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let high = at.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            let first = (low - 0.5).ceil().max(0.0) as usize;
            first..((high - 0.5).floor().max(-1.0) + 1.0).min(self.size[axis] as f64) as usize
        };
        let (columns, rows) = (span(0), span(1));
        for y in rows {
            for x in columns.clone() {
                let p = [x as f64 + 0.5, y as f64 + 0.5];
                let part = |q: [f64; 3], r: [f64; 3]| {
                    ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / area
                };
                let shares = [part(b, c), part(c, a), part(a, b)];
                if shares.iter().any(|s| *s < 0.0) {
                    continue;
                }
                let depth = (0..3).map(|k| shares[k] * at[k][2]).sum::<f64>() as f32;
                let place = y * self.size[0] + x;
                if depth > self.depths[place] {
                    self.depths[place] = depth;
                    let shares = shares.map(|s| s as f32);
                    let mixed = |a: usize| (0..3).map(|k| shares[k] * normals[k][a]).sum::<f32>();
                    let normal = normalised([mixed(0), mixed(1), mixed(2)]);
                    let value = (0..3).map(|k| shares[k] * values[k]).sum();
                    self.colours[place] = colour(normal, faces, value, paint);
                }
            }
        }
    }

    /// The picture's colours on white, with outlines darkened.
    fn averaged(&self, step: f32, nearness: impl Fn(f32) -> f32) -> Vec<u8> {
        let [width, height] = self.size;
        let near: Vec<f32> =
            self.depths.iter().map(|d| if *d == f32::NEG_INFINITY { *d } else { nearness(*d) }).collect();
        let light = |x: usize, y: usize| {
            let place = y * width + x;
            let here = near[place];
            if here == f32::NEG_INFINITY {
                return [255.0; 3];
            }
            let beside = [
                (x > 0).then(|| place - 1),
                (x + 1 < width).then(|| place + 1),
                (y > 0).then(|| place - width),
                (y + 1 < height).then(|| place + width),
            ];
            let outline = beside.into_iter().flatten().any(|p| here - near[p] > step);
            let darkened = if outline { 0.5 } else { 1.0 };
            self.colours[place].map(|c| f32::from(c) * darkened)
        };
        let mut bytes = Vec::with_capacity(width * height / (AVERAGED * AVERAGED) * 3);
        for y in (0..height).step_by(AVERAGED) {
            for x in (0..width).step_by(AVERAGED) {
                let mut sum = [0.0; 3];
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let c = light(x + dx, y + dy);
                    (0..3).for_each(|a| sum[a] += c[a]);
                }
                bytes.extend(sum.map(|s| (s / 4.0) as u8));
            }
        }
        bytes
    }
}

/// Colour of a dot whose normal is given as right, up, toward the viewer.
fn colour(normal: [f32; 3], faces: bool, value: f32, paint: Paint) -> [u8; 3] {
    // The inside of a surface is lit as if it were an outside.
    let normal = if faces { normal } else { normal.map(|c| -c) };
    let lambert = dot(normal, LIGHT).max(0.0);
    // Towards the outline a surface gets a little darker, as round things do.
    let rim = 0.80 + 0.20 * (normal[2].max(0.0) * 1.8).min(1.0);
    let (base, faded, ambient) = match paint {
        _ if !faces => (INSIDE, 0.0, AMBIENT),
        Paint::Plain { faded } => (BONE, faded, AMBIENT),
        // Colours that mean something are lit more evenly, so that they can be read.
        Paint::Values { colour, .. } => (colour(value), 0.0, 0.6),
    };
    let steps = if matches!(paint, Paint::Values { .. }) { STEPS / 3.0 } else { STEPS };
    let light = ((ambient + (1.0 - ambient) * lambert) * rim * steps).round() / steps;
    base.map(|c| {
        let lit = c * light;
        (lit + (255.0 - lit) * faded).clamp(0.0, 255.0) as u8
    })
}

impl Picture {
    /// Whether a point on or before the surface is seen.
    fn sees(&self, p: &Point3) -> bool {
        let at = self.camera.onto(p);
        let [x, y] = at.map(|v| (v * self.fineness).clamp(0.0, 1e6) as usize);
        let here = self.camera.nearness(p) + BELOW_MM + BELOW / self.camera.scale();
        // The farthest of the dots about it: on a surface seen from its edge one dot is far from the next.
        let mut depth = f32::INFINITY;
        for y in y.saturating_sub(1)..=y + 1 {
            for x in x.saturating_sub(1)..=x + 1 {
                if x < self.size[0] && y < self.size[1] {
                    depth = depth.min(self.depths[y * self.size[0] + x]);
                }
            }
        }
        !depth.is_finite() || self.camera.nearness_of(f64::from(depth)) <= here
    }

    /// A line in space as the parts of it that are seen, and those that the surface hides, in units of the drawing.
    pub(super) fn parted(&self, line: &[Point3], closed: bool) -> [Vec<Vec<[f64; 2]>>; 2] {
        let mut parts = [Vec::new(), Vec::new()];
        let ends = line.iter().zip(line.iter().skip(1).chain(line.iter().take(usize::from(closed))));
        let mut part: Vec<[f64; 2]> = Vec::new();
        let mut kind = 0;
        let short = |at: [f64; 2]| at.map(|v| (v * 10.0).round() / 10.0);
        for (from, to) in ends {
            let (a, b) = (self.camera.onto(from), self.camera.onto(to));
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let pieces = (length / 4.0).ceil().clamp(1.0, 400.0) as usize;
            for n in 0..pieces {
                let at = |n: usize| from + (to - from) * (n as f64 / pieces as f64);
                let of_piece = usize::from(!self.sees(&at(n)) || !self.sees(&at(n + 1)));
                if of_piece != kind || part.is_empty() {
                    if part.len() > 1 {
                        parts[kind].push(std::mem::take(&mut part));
                    }
                    part = vec![short(self.camera.onto(&at(n)))];
                    kind = of_piece;
                }
                let next = short(self.camera.onto(&at(n + 1)));
                // A piece that goes on straight needs no point between.
                if n > 0 && part.len() > 1 {
                    part.pop();
                }
                part.push(next);
            }
        }
        if part.len() > 1 {
            parts[kind].push(part);
        }
        parts
    }
}
