//! The contours of a slice, to a fraction of a pixel, from which voxels are bone.
//!
//! The outline of the bone's voxels, each counted by how much of it is dark, is smoothed; along its normals the outside of the
//! shell is placed by a model of the scanner ([`crate::shell`]); the places are smoothed along the outline by their standard
//! deviations ([`crate::evenly`]). Where there is no edge, the outline is carried across.

use biplane_artifact::SlicePoint;

use crate::blur::gaussian;
use crate::distance::{Within, to_set};
use crate::evenly;
use crate::levels::{LEAST_CONTRAST, Shares, Slice, normals};
use crate::marching::{self, Saddles};
use crate::ring::{self, Plane};
use crate::shell::{Known, Profile, outside};
use crate::stack::Stack;
use crate::stage::Found;

/// Smoothing of the shares of bone, pixels.
const SHARE_PX: f64 = 0.6;
/// A surface that a slice spreads over more pixels than this has no edge in it.
const MOST_LEAN_PX: f64 = 5.0;
/// Spacing of the contours' points, pixels.
const SPACING_PX: f64 = 1.0;
/// Reach of the smoothing of the first outline and of the edges' places, mm; at least so many points.
const OUTLINE_REACH_MM: f64 = 1.5;
const EDGE_REACH_MM: f64 = 2.5;
const LEAST_REACH: f64 = 3.5;
/// Standard deviation of the first outline, pixels, where there is no edge.
const OUTLINE_SIGMA_PX: f64 = 0.7;
/// Outlines smaller than this are noise, pixels.
const LEAST_AREA_PX2: f64 = 4.0;
/// Above this share of points without an edge a slice is unclear.
const UNCLEAR: f64 = 1.0 / 3.0;

/// What is needed to place the contours of a slice.
pub(crate) struct Placing<'a> {
    pub stack: &'a Stack,
    pub samples: &'a [f32],
    pub levels: &'a [f32],
    pub bone: &'a [bool],
    pub shares: &'a Shares,
    pub noise: f64,
    pub shell_mm: f64,
}

impl Placing<'_> {
    /// Distance of each voxel from the bone's outline in its slice, positive outside, mm, a little smoothed.
    pub fn off_outline(&self) -> Vec<f32> {
        let outer = to_set(self.stack, |v| self.bone[v], Within::Slice);
        let inner = to_set(self.stack, |v| !self.bone[v], Within::Slice);
        // Beyond this nothing is asked.
        let most = 20.0;
        let off: Vec<f32> = outer.iter().zip(&inner).map(|(o, i)| o.min(most) - i.min(most)).collect();
        let [dx, dy] = self.stack.pixel_mm;
        gaussian(self.stack, &off, [dx, dy, 0.0])
    }

    /// How much of each voxel of a slice is bone, as far as its level tells.
    fn shares_of_bone(&self, k: usize) -> Vec<f32> {
        let Stack { size: [columns, rows, _], .. } = *self.stack;
        let first = k * columns * rows;
        let bone = |i: usize, j: usize| self.bone[first + j * columns + i];
        let dark_share = |v: usize| {
            let (dark, out) = (self.shares.dark as f32, self.shares.outside_at(self.stack.place(v)) as f32);
            (out - self.samples[v] / self.levels[v]) / (out - dark).max(0.05)
        };
        let mut field = Vec::with_capacity(columns * rows);
        for j in 0..rows {
            for i in 0..columns {
                let here = bone(i, j);
                let span = |c: usize, most: usize| c.saturating_sub(1)..=(c + 1).min(most - 1);
                let rim = span(j, rows).any(|y| span(i, columns).any(|x| bone(x, y) != here));
                let dark = dark_share(first + j * columns + i);
                field.push(match (here, rim) {
                    (true, false) => 1.0,
                    (true, true) => dark.clamp(0.5, 1.0),
                    (false, true) => dark.clamp(0.0, 0.5),
                    (false, false) => 0.0,
                });
            }
        }
        let flat = Stack { size: [columns, rows, 1], pixel_mm: self.stack.pixel_mm, heights_mm: vec![0.0] };
        let [dx, dy] = self.stack.pixel_mm;
        gaussian(&flat, &field, [SHARE_PX * dx, SHARE_PX * dy, 0.0])
    }

    /// Contours of slice `k` of the part, in pixels of the whole.
    pub fn slice(&self, k: usize, off: &[f32], offset: Plane) -> Found {
        let columns = self.stack.size[0];
        let [dx, dy] = self.stack.pixel_mm;
        let mut found = Found::default();
        let (mut unclear, mut all) = (0, 0);
        for ring in marching::contours(&self.shares_of_bone(k), columns, 0.5, 0.0, Saddles::Bilinear) {
            if ring::signed_area(&ring).abs() < LEAST_AREA_PX2 {
                continue;
            }
            let scaled: Vec<Plane> = ring.iter().map(|p| [p[0] * dx, p[1] * dy]).collect();
            // What crosses itself once smoothed is taken as it was.
            let outline = Some(smooth_outline(&scaled, dx.min(dy))).filter(|o| ring::is_simple(o));
            let edges = self.edges(k, off, &outline.unwrap_or(scaled));
            unclear += edges.unclear;
            all += edges.points.len();
            let point = |(p, sigma): &(Plane, f64)| {
                SlicePoint::rounded(p[0] / dx + offset[0], p[1] / dy + offset[1], *sigma)
            };
            found.rings.push(edges.points.iter().map(point).collect());
        }
        found.unclear = unclear as f64 > UNCLEAR * all as f64;
        found
    }

    /// Moves an outline, mm, to the outside of the shell.
    fn edges(&self, k: usize, off: &[f32], outline: &[Plane]) -> Edges {
        let [dx, dy] = self.stack.pixel_mm;
        let (size, slices) = (self.stack.slice_voxels(), self.stack.size[2]);
        let span = k * size..(k + 1) * size;
        let columns = self.stack.size[0];
        let (before, after) = (k.saturating_sub(1), (k + 1).min(slices - 1));
        let [low, high] = [before, after].map(|k| Slice { values: &off[k * size..(k + 1) * size], columns });
        let samples = Slice { values: &self.samples[span.clone()], columns };
        let levels = Slice { values: &self.levels[span], columns };
        let heights = &self.stack.heights_mm;
        let apart = (heights[after] - heights[before]).max(f64::MIN_POSITIVE);
        let thickness = self.stack.thickness_mm(k);
        let pixel = (dx * dy).sqrt();
        let outline_sigma = OUTLINE_SIGMA_PX * pixel;
        let step = pixel / 2.0;
        let directions = normals(outline);
        let mut shifts = Vec::with_capacity(outline.len());
        let mut sigmas = Vec::with_capacity(outline.len());
        let mut unclear = 0;
        let mut ray = Vec::new();
        for (p, n) in outline.iter().zip(&directions) {
            let px = |s: f64| [(p[0] + s * n[0]) / dx, (p[1] + s * n[1]) / dy];
            let level = levels.at(px(0.0));
            let [i, j] = px(0.0).map(|v| v.round().max(0.0) as usize);
            let beyond = self.shares.outside_at([i, j, k]).max(self.shares.dark + LEAST_CONTRAST / 2.0);
            // By how much the outline moves across the slice's thickness.
            let lean = (high.at(px(0.0)) - low.at(px(0.0))).abs() / apart * thickness;
            let width = (n[0] * dx).hypot(n[1] * dy);
            let known = Known {
                marrow: level,
                dark: level * self.shares.dark,
                outside: level * beyond,
                noise: self.noise,
                // The box of a pixel (variance 1/12) and linear interpolation (1/6): as one box.
                pixel: 3.0_f64.sqrt() * width,
                lean,
                shell: self.shell_mm,
                reach: 1.5 * width + (lean / 2.0).min(width),
            };
            let first = -(((self.shell_mm + 3.0 * width + lean) / step).ceil()) * step;
            let last = known.reach + 3.0 * width + lean;
            ray.clear();
            ray.extend(
                (0..=((last - first) / step) as usize).map(|m| samples.at(px(first + m as f64 * step))),
            );
            let leans = lean > MOST_LEAN_PX * pixel;
            let edge = if leans { None } else { outside(&Profile { first, step, levels: &ray }, &known) };
            unclear += usize::from(!leans && edge.is_none());
            // The outline itself is known too, though badly.
            let (shift, sigma) = match edge {
                Some(edge) => {
                    let (a, b) = (edge.sigma.powi(-2), (outline_sigma + lean / 2.0).powi(-2));
                    (edge.at * a / (a + b), (a + b).sqrt().recip())
                }
                None => (0.0, outline_sigma + lean / 2.0),
            };
            shifts.push(shift);
            sigmas.push(sigma);
        }
        let spacing = ring::length(outline) / outline.len() as f64;
        let smooth = evenly::smoothed(&shifts, &sigmas, (EDGE_REACH_MM / spacing).max(LEAST_REACH));
        let moved = |part: f64| -> Vec<Plane> {
            let shift = |n: usize, a: usize| directions[n][a] * smooth.values[n] * part;
            (0..outline.len()).map(|n| std::array::from_fn(|a| outline[n][a] + shift(n, a))).collect()
        };
        // In a narrow bay, points that move outward from either side may pass each other.
        let ring = [1.0, 0.5].map(moved).into_iter().find(|r| ring::is_simple(r));
        let ring = ring.unwrap_or_else(|| outline.to_vec());
        let off_by = |n: usize, p: &Plane| {
            let wanted: Plane = std::array::from_fn(|a| outline[n][a] + directions[n][a] * smooth.values[n]);
            smooth.sigmas[n].hypot((wanted[0] - p[0]).hypot(wanted[1] - p[1]))
        };
        let points = ring.into_iter().enumerate().map(|(n, p)| (p, off_by(n, &p))).collect();
        Edges { points, unclear }
    }
}

/// A contour, mm in its slice, with standard deviations, and how many of its points should have an edge and have none.
struct Edges {
    points: Vec<(Plane, f64)>,
    unclear: usize,
}

/// An outline without the noise of single pixels, its points evenly spread.
fn smooth_outline(ring: &[Plane], pixel: f64) -> Vec<Plane> {
    let points = ring::resampled(ring, SPACING_PX * pixel);
    let spacing = ring::length(ring) / points.len() as f64;
    let reach = (OUTLINE_REACH_MM / spacing).max(LEAST_REACH);
    let same = vec![1.0; points.len()];
    let [x, y] = [0, 1].map(|a| {
        let values: Vec<f64> = points.iter().map(|p| p[a]).collect();
        evenly::smoothed(&values, &same, reach).values
    });
    let smooth: Vec<Plane> = x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
    ring::resampled(&smooth, SPACING_PX * pixel)
}
