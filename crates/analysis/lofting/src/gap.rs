//! The field between two slices: below 0 in the bone, above outside; its zero is the surface.
//!
//! It is put together from parts. A [`Blend`] interpolates the signed distances of linked regions along the normal, by a cubic through the
//! two slices whose slopes in them come from the slices before and behind, or from the dome that closes a piece there. The cubic is held by its Bezier controls: where a node is inside in
//! both slices it stays inside, where it is outside in both it stays outside, and where it changes it does so once. A thin piece that moves
//! by more than it is wide is interpolated in coordinates that move with its centroid. A [`Dome`] closes what ends. Bone is where any part
//! is, but for the domes of holes that end.

use std::rc::Rc;

use crate::dome::Dome;
use crate::layer::Grid;
use crate::plane::Plane;

/// How near to zero the controls of a cubic may come, as a share of the smaller end value.
const KEPT: f32 = 0.2;

/// Regions linked across a gap.
#[derive(Debug, Clone)]
pub(crate) struct Blend {
    /// Signed distances in the slice before the lower one, in the lower, in the upper, and behind it; of the outer two what is there.
    planes: [Option<Rc<Plane>>; 4],
    /// The lower and the upper slice, mm.
    heights: [f64; 2],
    /// The four centroids, cells, for coordinates that move.
    centres: Option<[[f64; 2]; 4]>,
    /// Controls of the cubic, as sums of the four values.
    controls: [[f32; 4]; 2],
    /// What is added to the controls.
    added: [f32; 2],
    /// The box of nodes beyond which it is far outside.
    bounds: [[usize; 2]; 2],
}

impl Blend {
    /// `planes` of the two slices are there; all planes are complete. `heights` of planes that are not there do not matter.
    pub fn new(
        planes: [Option<Rc<Plane>>; 4],
        heights: [f64; 4],
        centres: Option<[[f64; 2]; 4]>,
        bounds: [[usize; 2]; 2],
    ) -> Self {
        let there = [planes[0].is_some(), planes[3].is_some()];
        let rise = heights[2] - heights[1];
        let secant = |k: usize| {
            let mut s = [0.0; 4];
            s[k] = -1.0 / (heights[k + 1] - heights[k]);
            s[k + 1] = -s[k];
            s
        };
        let mix = |a: [f64; 4], p: f64, b: [f64; 4], q: f64| {
            std::array::from_fn::<f64, 4, _>(|k| a[k] * p + b[k] * q)
        };
        let middle = secant(1);
        // Slope of the parabola through three slices, in the middle one or at its end.
        let slope = |outer: usize, own: bool, other: bool| -> [f64; 4] {
            let (before, far) = (if outer == 0 { 0 } else { 2 }, if outer == 0 { 2 } else { 0 });
            if own {
                let width = heights[before + 1] - heights[before];
                mix(secant(before), rise / (rise + width), middle, width / (rise + width))
            } else if other {
                let width = heights[far + 1] - heights[far];
                let share = rise / (rise + width);
                mix(middle, 1.0 + share, secant(far), -share)
            } else {
                middle
            }
        };
        let [low, high] = [slope(0, there[0], there[1]), slope(3, there[1], there[0])];
        let control = |slope: [f64; 4], end: usize, sign: f64| {
            std::array::from_fn(|k| (f64::from(u8::from(k == end)) + sign * rise / 3.0 * slope[k]) as f32)
        };
        let controls = [control(low, 1, 1.0), control(high, 2, -1.0)];
        Self { planes, heights: [heights[1], heights[2]], centres, controls, added: [0.0; 2], bounds }
    }

    /// With slopes known of the lower and the upper slice, cells for each mm upwards, as where the piece ends beyond them.
    pub fn with_slopes(mut self, slopes: [Option<f64>; 2]) -> Self {
        let rise = self.heights[1] - self.heights[0];
        for (end, sign) in [(0, 1.0), (1, -1.0)] {
            if let (Some(slope), None) = (slopes[end], self.centres) {
                self.controls[end] = std::array::from_fn(|k| f32::from(u8::from(k == end + 1)));
                self.added[end] = (sign * slope * rise / 3.0) as f32;
            }
        }
        self
    }

    /// Bernstein's weights at a height.
    fn weights(&self, height: f64) -> [f32; 4] {
        let t = ((height - self.heights[0]) / (self.heights[1] - self.heights[0])).clamp(0.0, 1.0);
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t].map(|w| w as f32)
    }

    #[inline(always)]
    fn cubic(&self, f: [f32; 4], w: [f32; 4]) -> f32 {
        let dot = |c: &[f32; 4]| c[0] * f[0] + c[1] * f[1] + c[2] * f[2] + c[3] * f[3];
        let mut p = dot(&self.controls[0]) + self.added[0];
        let mut q = dot(&self.controls[1]) + self.added[1];
        let (low, high) = (f[1].min(f[2]), f[1].max(f[2]));
        if high < 0.0 {
            let most = KEPT * high;
            (p, q) = (p.min(most), q.min(most));
        } else if low > 0.0 {
            let least = KEPT * low;
            (p, q) = (p.max(least), q.max(least));
        } else {
            (p, q) = (p.clamp(low, high), q.clamp(low, high));
            // One change of sign.
            if (q - p) * (f[2] - f[1]) < 0.0 {
                let mean = (p + q) / 2.0;
                (p, q) = (mean, mean);
            }
        }
        w[0] * f[1] + w[1] * p + w[2] * q + w[3] * f[2]
    }

    /// By how much the coordinates of each plane have moved, cells.
    fn moved(&self, w: [f32; 4]) -> Option<[[f32; 2]; 4]> {
        let centres = self.centres?;
        let at = [0, 1].map(|a| {
            let dot = |c: &[f32; 4]| (0..4).map(|k| f64::from(c[k]) * centres[k][a]).sum::<f64>();
            let controls = [centres[1][a], dot(&self.controls[0]), dot(&self.controls[1]), centres[2][a]];
            (0..4).map(|k| f64::from(w[k]) * controls[k]).sum::<f64>()
        });
        Some(centres.map(|c| [0, 1].map(|a| (c[a] - at[a]) as f32)))
    }

    fn value(&self, grid: &Grid, node: usize, height: f64) -> f32 {
        let w = self.weights(height);
        let f = match self.moved(w) {
            None => std::array::from_fn(|k| self.planes[k].as_ref().map_or(0.0, |p| p.values[node])),
            Some(off) => {
                let [x, y] = [node % grid.size[0], node / grid.size[0]].map(|v| v as f32);
                std::array::from_fn(|k| {
                    self.planes[k].as_ref().map_or(0.0, |p| p.between(grid, x + off[k][0], y + off[k][1]))
                })
            }
        };
        self.cubic(f, w)
    }

    /// Takes the smaller of what is there and its own values, in its box of nodes.
    fn fill(&self, grid: &Grid, height: f64, out: &mut [f32]) {
        let [low, high] = self.bounds;
        let w = self.weights(height);
        if self.centres.is_some() {
            for j in low[1]..=high[1] {
                let row = j * grid.size[0];
                for (i, out) in out[row..].iter_mut().enumerate().take(high[0] + 1).skip(low[0]) {
                    *out = out.min(self.value(grid, row + i, height));
                }
            }
            return;
        }
        let [Some(below), Some(above)] = [&self.planes[1], &self.planes[2]] else { return };
        // A plane that is not there counts with weight 0: any other stands in.
        let [before, behind] = [&self.planes[0], &self.planes[3]].map(|p| p.as_ref().unwrap_or(below));
        for j in low[1]..=high[1] {
            let row = j * grid.size[0] + low[0]..j * grid.size[0] + high[0] + 1;
            let (a, b) = (&before.values[row.clone()], &below.values[row.clone()]);
            let (c, d) = (&above.values[row.clone()], &behind.values[row.clone()]);
            for (k, o) in out[row].iter_mut().enumerate() {
                *o = o.min(self.cubic([a[k], b[k], c[k], d[k]], w));
            }
        }
    }
}

/// The field of a gap.
#[derive(Debug, Clone, Default)]
pub(crate) struct Field {
    pub blends: Vec<Blend>,
    pub domes: Vec<Dome>,
    /// Domes of holes that end.
    pub pits: Vec<Dome>,
}

impl Field {
    /// Whether a place of the plane, in cells, lies on the rim of a flat lid.
    pub fn has_rim_at(&self, place: [f64; 2], height: f64) -> bool {
        self.domes.iter().chain(&self.pits).any(|d| d.has_rim_at(place, height))
    }

    /// At a node and height.
    pub fn value(&self, grid: &Grid, node: usize, height: f64) -> f64 {
        let mut value = 1e9_f64;
        for blend in &self.blends {
            value = value.min(f64::from(blend.value(grid, node, height)));
        }
        if !self.domes.is_empty() || !self.pits.is_empty() {
            let [x, y] = [node % grid.size[0], node / grid.size[0]].map(|v| v as f64);
            for dome in &self.domes {
                value = value.min(dome.value(x, y, height));
            }
            for pit in &self.pits {
                value = value.max(-pit.value(x, y, height));
            }
        }
        value
    }

    /// The values of all nodes; 1e9 far outside.
    pub fn fill(&self, grid: &Grid, height: f64, out: &mut Vec<f32>) {
        out.clear();
        out.resize(grid.nodes(), 1e9);
        for blend in &self.blends {
            blend.fill(grid, height, out);
        }
        for (dome, add) in self.domes.iter().map(|d| (d, true)).chain(self.pits.iter().map(|d| (d, false))) {
            let [low, high] = dome.bounds(grid, height);
            for j in low[1]..=high[1] {
                for i in low[0]..=high[0] {
                    let out = &mut out[j * grid.size[0] + i];
                    let value = dome.value(i as f64, j as f64, height) as f32;
                    *out = if add { out.min(value) } else { out.max(-value) };
                }
            }
        }
    }

    /// Where the field changes its sign between two heights, at a node; it does, by the signs of the levels.
    pub fn root(&self, grid: &Grid, node: usize, [low, high]: [f64; 2]) -> f64 {
        let value = |t: f64| self.value(grid, node, low + t * (high - low));
        let (mut a, mut b) = (0.0, 1.0);
        let (mut at_a, mut at_b) = (value(a), value(b));
        if at_a * at_b >= 0.0 {
            return low + (high - low) / 2.0;
        }
        // A flat lid lies in the slice itself.
        const LID: f64 = 1e-6;
        if self.blends.is_empty() || !self.domes.is_empty() || !self.pits.is_empty() {
            if value(LID) * at_a < 0.0 {
                return low;
            }
            if value(1.0 - LID) * at_b < 0.0 {
                return high;
            }
        }
        // The rule of false position, halving the end that stays (Illinois).
        let mut stayed = 0;
        for _ in 0..8 {
            let t = (a * at_b - b * at_a) / (at_b - at_a);
            let at_t = value(t);
            if at_t * at_b > 0.0 {
                (b, at_b) = (t, at_t);
                at_a *= if stayed == 1 { 0.5 } else { 1.0 };
                stayed = 1;
            } else {
                (a, at_a) = (t, at_t);
                at_b *= if stayed == -1 { 0.5 } else { 1.0 };
                stayed = -1;
            }
            if at_t.abs() < 1e-4 || b - a < 1e-4 {
                break;
            }
        }
        let t = (a * at_b - b * at_a) / (at_b - at_a);
        let least = f64::from(crate::plane::LEAST);
        low + (high - low) * t.clamp(least, 1.0 - least)
    }
}
