//! A smooth field that is above one half where the label is, on an even lattice.
//!
//! The label's indicator `I`, known at the voxels' centres, is smoothed by a kernel that is the product over the axes of
//!
//! ```text
//! k(x) = (3 - x^2 / s^2) / 2 * exp(-x^2 / (2 s^2)) / (s sqrt(2 pi))
//! f(x) = sum of T_n k(x - x_n) I_n / sum of T_n k(x - x_n)          along each axis, T_n the thickness of voxel n
//! ```
//!
//! the Gaussian of standard deviation `s` with its second moment taken out (Wand and Jones 1995, section 2.8; in volumes what
//! Taubin 1995 is on meshes). A Gaussian alone moves a surface inward by `s^2 / 2` times the sum of its curvatures: 0.05 mm on a
//! condyle of 20 mm for `s` of 1 mm; this kernel by terms of `s^4` only. `s` is one number of mm, but along each axis at least
//! [`FINEST`] times the distance of the voxels there: with less, their stairs remain.
//!
//! The sum is taken at any place, not at voxels only, so the lattice is even whatever the voxels are.

use crate::parts::Mask;
use crate::stack::Stack;

/// Least standard deviation, in distances of voxels.
pub(crate) const FINEST: f64 = 0.6;
/// Weights beyond this many standard deviations are left out.
const REACH: f64 = 4.0;
/// The lattice's step, in standard deviations, where voxels are finer than that.
const STEP: f64 = 0.5;
/// Most places of the lattice: 200 MB of field. Beyond, the step grows.
const MOST_PLACES: f64 = 5e7;

/// Places along an axis: `first + n step`, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line {
    pub first: f64,
    pub step: f64,
    pub count: usize,
    /// Whether the volume ends there while the label goes on: then a place of [`Line::ends`] is at the border of the volume.
    pub lids: [bool; 2],
}

impl Line {
    /// Numbers of the first and the last place that may be inside.
    pub fn ends(&self) -> [usize; 2] {
        [1, self.count - 3]
    }

    /// The place of a fraction of a step.
    pub fn at(&self, n: f64) -> f64 {
        self.first + n * self.step
    }
}

/// The field on its lattice; rows run fastest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Field {
    pub lines: [Line; 3],
    pub values: Vec<f32>,
    /// Whether the lattice is coarser than it should be, since there would be too many places.
    pub coarser: bool,
}

/// The standard deviation along an axis at a place, mm.
fn sigma(stack: &Stack, axis: usize, at: f64, smoothing_mm: f64) -> f64 {
    let gap = match axis {
        2 => {
            let below = stack.slice_below(at);
            let (low, high) = (stack.place_mm(2, below as isize), stack.place_mm(2, below as isize + 1));
            let part = ((at - low) / (high - low)).clamp(0.0, 1.0);
            let above = (below + 1).min(stack.size[2] - 1);
            (1.0 - part) * stack.thickness_mm(2, below) + part * stack.thickness_mm(2, above)
        }
        _ => stack.pixel_mm[axis],
    };
    smoothing_mm.max(FINEST * gap)
}

impl Field {
    /// The field of the voxels inside a mask, and two steps beyond.
    pub fn of(mask: &Mask, stack: &Stack, smoothing_mm: f64) -> Self {
        let touches = mask.touches(stack);
        // The finest distance of voxels, but no finer than the field is smooth.
        let slices = mask.low[2]..mask.low[2] + mask.size[2];
        let thinnest = slices.map(|k| stack.thickness_mm(2, k)).fold(f64::INFINITY, f64::min);
        let finest = thinnest.min(stack.pixel_mm[0]).min(stack.pixel_mm[1]);
        let mut step = finest.max(STEP * smoothing_mm);
        let mut lines = [0, 1, 2].map(|a| line(mask, stack, a, touches[a], smoothing_mm, step));
        let mut coarser = false;
        while lines.iter().map(|l| l.count as f64).product::<f64>() > MOST_PLACES {
            coarser = true;
            step *= 1.1;
            lines = [0, 1, 2].map(|a| line(mask, stack, a, touches[a], smoothing_mm, step));
        }
        let mut size = mask.size;
        let mut values: Vec<f32> = mask.inside.iter().map(|v| f32::from(*v)).collect();
        for axis in 0..3 {
            let taps: Vec<Taps> = (0..lines[axis].count)
                .map(|n| Taps::at(mask, stack, axis, lines[axis].at(n as f64), smoothing_mm, touches[axis]))
                .collect();
            let count = size[axis];
            let stride = size[..axis].iter().product();
            values = resampled(&values, stride, count, &taps);
            size[axis] = taps.len();
        }
        let mut field = Self { lines, values, coarser };
        field.close();
        field
    }

    /// How many places there are along the axes.
    pub fn size(&self) -> [usize; 3] {
        self.lines.map(|l| l.count)
    }

    /// Makes the places beyond the ends outside, so that what is inside is enclosed.
    fn close(&mut self) {
        let [columns, rows, _] = self.size();
        let within = |axis: usize, n: usize| {
            let [first, last] = self.lines[axis].ends();
            (first..=last).contains(&n)
        };
        let [first, last] = self.lines[0].ends();
        for (line, values) in self.values.chunks_exact_mut(columns).enumerate() {
            let inside = within(1, line % rows) && within(2, line / rows);
            let row = if inside { first..last + 1 } else { 0..0 };
            values[..row.start].fill(0.0);
            values[row.end..].fill(0.0);
        }
    }
}

/// The lattice along an axis: from face to face where the label touches the border of the volume, else with room around it.
fn line(mask: &Mask, stack: &Stack, axis: usize, lids: [bool; 2], smoothing_mm: f64, step: f64) -> Line {
    let end = |n: usize, outward: f64, lid: bool| {
        let place = stack.places_mm[axis][n];
        let face = place + outward * stack.thickness_mm(axis, n) / 2.0;
        let room = if lid { 0.0 } else { sigma(stack, axis, place, smoothing_mm) + step };
        face + outward * room
    };
    let low = end(mask.low[axis], -1.0, lids[0]);
    let high = end(mask.low[axis] + mask.size[axis] - 1, 1.0, lids[1]);
    let steps = ((high - low) / step).ceil().max(1.0);
    let step = (high - low) / steps;
    // Places outside at either end; the library leaves out what lies between the last two.
    Line { first: low - step, step, count: steps as usize + 4, lids }
}

/// Weights of the voxels of a mask along an axis, from the first one that counts.
struct Taps {
    first: usize,
    weights: Vec<f32>,
}

impl Taps {
    fn at(mask: &Mask, stack: &Stack, axis: usize, at: f64, smoothing_mm: f64, lids: [bool; 2]) -> Self {
        let sigma = sigma(stack, axis, at, smoothing_mm);
        let nearest = stack.places_mm[axis].partition_point(|p| *p < at) as isize;
        let place = |n: isize| stack.place_mm(axis, n);
        let mut from = nearest;
        while at - place(from - 1) <= REACH * sigma {
            from -= 1;
        }
        let last = mask.size[axis] as isize - 1;
        let mut weights = vec![0.0; mask.size[axis]];
        let mut sum = 0.0;
        let mut n = from;
        while place(n) - at <= REACH * sigma {
            let x = (place(n) - at) / sigma;
            let inside = n.clamp(0, stack.size[axis] as isize - 1) as usize;
            let weight = stack.thickness_mm(axis, inside) * (3.0 - x * x) / 2.0 * (-x * x / 2.0).exp();
            sum += weight;
            // Beyond the border of the volume the label goes on as it is there.
            let of_mask = n - mask.low[axis] as isize;
            let of_mask = match (of_mask < 0, of_mask > last) {
                (true, _) if lids[0] => Some(0),
                (_, true) if lids[1] => Some(last),
                (false, false) => Some(of_mask),
                _ => None,
            };
            if let Some(voxel) = of_mask {
                weights[voxel as usize] += weight;
            }
            n += 1;
        }
        let first = weights.iter().position(|w| *w != 0.0).unwrap_or(0);
        let end = weights.iter().rposition(|w| *w != 0.0).map_or(first, |n| n + 1);
        Self { first, weights: weights[first..end].iter().map(|w| (w / sum) as f32).collect() }
    }
}

/// Values of an axis of `count` places, `stride` apart, taken at other places.
fn resampled(values: &[f32], stride: usize, count: usize, taps: &[Taps]) -> Vec<f32> {
    let blocks = values.chunks_exact(count * stride);
    let mut all = vec![0.0; blocks.len() * taps.len() * stride];
    for (block, out) in blocks.zip(all.chunks_exact_mut(taps.len() * stride)) {
        for (Taps { first, weights }, out) in taps.iter().zip(out.chunks_exact_mut(stride)) {
            if stride == 1 {
                out[0] = weights.iter().zip(&block[*first..]).map(|(w, v)| w * v).sum();
                continue;
            }
            for (weight, from) in weights.iter().zip(block[first * stride..].chunks_exact(stride)) {
                for (o, v) in out.iter_mut().zip(from) {
                    *o += weight * v;
                }
            }
        }
    }
    all
}
