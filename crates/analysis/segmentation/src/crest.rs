//! Crests of the gradient's size, to a fraction of a pixel.
//!
//! **The gradient** is a central difference, averaged across with weights `(a, 1 - 2a, a)`: 1/6 blurs as much across as the
//! difference does along (variance 1/3 px^2), so edges of all directions are seen alike; Sobel's is 1/4, Prewitt's 1/3. Roberts's
//! cross, turned by 45 degrees, is the difference of neighbours averaged over two rows, half a pixel to the right and below.
//!
//! **A pixel owns a crest** if its gradient is larger than between the two neighbours that it points between, and as large as between
//! those behind (Canny's own interpolation).
//!
//! **Its place.** The gradient of a step that was blurred by Gaussians is a Gaussian across the edge, so its logarithm is a
//! parabola: a quadratic through the logarithm in the 3 x 3 pixels around gives the crest's offset and the edge's width, for
//! straight edges exactly. A curved edge's crest lies inside, and a sixth of its curvature more is the fit's own error;
//! [`crate::curved`] takes both out.
//!
//! **Its standard deviation** is that of the second derivative of smoothed noise over the third derivative of the edge (Canny
//! 1986), with the noise of the smoothed picture at this level.

use biplane_geometry::{EdgePoint, Vector2};
use biplane_grey::{Grey, Noise, Processor};

use crate::edges::{BORDER, CANDIDATE, STRONG, point_at};

/// How the gradient is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operator {
    Isotropic,
    Sobel,
    Prewitt,
    Roberts,
}

/// Weight of the neighbours across the difference.
fn across(operator: Operator) -> f32 {
    match operator {
        Operator::Isotropic | Operator::Roberts => 1.0 / 6.0,
        Operator::Sobel => 0.25,
        Operator::Prewitt => 1.0 / 3.0,
    }
}

/// Variance that the operator adds to that of the smoothing, px^2.
fn variance(operator: Operator) -> f64 {
    match operator {
        Operator::Isotropic => 1.0 / 3.0,
        Operator::Sobel => 5.0 / 12.0,
        Operator::Prewitt => 0.5,
        Operator::Roberts => 1.0 / 6.0,
    }
}

/// A smoothed picture and how its gradient is taken.
#[derive(Clone, Copy)]
pub(crate) struct Field<'a> {
    pub smooth: &'a Grey,
    pub operator: Operator,
}

impl Field<'_> {
    /// Marks pixels that own a crest whose size reaches `low`, and `high`.
    pub fn crests(&self, low: f64, high: f64) -> Vec<u8> {
        let mut marks = vec![0_u8; self.smooth.width * self.smooth.height];
        // An even picture has no crests, whatever the threshold.
        let limits = [low, high].map(|t| (t as f32).max(1e-4));
        Processor::new().dispatch(
            #[inline(always)]
            || crests(*self, limits, &mut marks),
        );
        marks
    }

    /// Square of the gradient's size at a pixel, at least one from the picture's edge.
    pub fn size_at(&self, k: usize) -> f32 {
        let [gx, gy] = self.gradient_at(k);
        gx * gx + gy * gy
    }

    /// Gradient at a pixel, at least one from the picture's edge.
    pub fn gradient_at(&self, k: usize) -> [f32; 2] {
        let (w, s) = (self.smooth.width, &self.smooth.samples);
        if self.operator == Operator::Roberts {
            let (falling, rising) = (s[k + w + 1] - s[k], s[k + 1] - s[k + w]);
            return [(falling + rising) / 2.0, (falling - rising) / 2.0];
        }
        let a = across(self.operator);
        let b = 1.0 - 2.0 * a;
        let column = |k: usize| a * (s[k - w] + s[k + w]) + b * s[k];
        let row = |k: usize| a * (s[k - 1] + s[k + 1]) + b * s[k];
        [(column(k + 1) - column(k - 1)) / 2.0, (row(k + w) - row(k - w)) / 2.0]
    }

    /// The crests that pixels own, and for each the square of the edge's width, px^2.
    pub fn points(&self, pixels: &[u32], noise: &Noise, smoothing_px: f64) -> (Vec<EdgePoint>, Vec<f64>) {
        // Deviation of the second derivative across the edge of white noise of deviation 1, smoothed by Gaussians of variance
        // `along` the gradient, where the second difference adds 1/6, and `across`, where the fit's weights add theirs.
        let smoothing = smoothing_px * smoothing_px + variance(self.operator);
        let (along, across) = (smoothing + 1.0 / 6.0, smoothing + FIT_VARIANCE);
        let curvature_noise =
            (3.0 / (16.0 * std::f64::consts::PI)).sqrt() / (along.powf(1.25) * across.powf(0.25));
        Processor::new().dispatch(
            #[inline(always)]
            || pixels.iter().map(|&k| self.point(k as usize, noise, curvature_noise)).unzip(),
        )
    }

    /// Gradient along x and y in the 3 x 3 pixels around one, row by row.
    #[inline(always)]
    fn gradients_around(&self, k: usize) -> [[f32; 9]; 2] {
        let w = self.smooth.width;
        if self.operator == Operator::Roberts {
            let all: [[f32; 2]; 9] = std::array::from_fn(|i| self.gradient_at(k + i / 3 * w + i % 3 - w - 1));
            return [all.map(|g| g[0]), all.map(|g| g[1])];
        }
        let a = across(self.operator);
        let b = 1.0 - 2.0 * a;
        // Five rows of five; a pixel with a crest is far enough from the picture's edge.
        let first = k - 2 * w - 2;
        let mut patch = [[0.0_f32; 5]; 5];
        for (j, row) in patch.iter_mut().enumerate() {
            row.copy_from_slice(&self.smooth.samples[first + j * w..first + j * w + 5]);
        }
        let mut found = [[0.0; 9]; 2];
        for j in 0..3 {
            let mut sums = [0.0; 5];
            let mut rises = [0.0; 5];
            for x in 0..5 {
                sums[x] = a * (patch[j][x] + patch[j + 2][x]) + b * patch[j + 1][x];
                rises[x] = patch[j + 2][x] - patch[j][x];
            }
            for x in 0..3 {
                found[0][3 * j + x] = 0.5 * (sums[x + 2] - sums[x]);
                found[1][3 * j + x] = 0.5 * (a * (rises[x] + rises[x + 2]) + b * rises[x + 1]);
            }
        }
        found
    }

    #[inline(always)]
    fn point(&self, k: usize, noise: &Noise, curvature_noise: f64) -> (EdgePoint, f64) {
        let w = self.smooth.width;
        let [along_x, along_y] = self.gradients_around(k);
        let (gx, gy) = (f64::from(along_x[4]), f64::from(along_y[4]));
        let steep = gy.abs() > gx.abs();
        let size = (gx * gx + gy * gy).sqrt().max(1e-12);
        let n = Vector2::new(gx / size, gy / size);
        // Logarithms of the gradient's size around; the least keeps that of 0 finite.
        let mut logarithms = [0.0_f32; 9];
        for i in 0..9 {
            logarithms[i] = 0.5 * ln((along_x[i] * along_x[i] + along_y[i] * along_y[i]).max(1e-12));
        }
        let l: [[f64; 3]; 3] =
            std::array::from_fn(|j| std::array::from_fn(|i| f64::from(logarithms[3 * j + i])));
        // Slopes and bends of a quadratic, averaged across with weights 1, 4, 1: of all weights those whose error on a curved edge,
        // a sixth of its curvature, does not depend on direction.
        let column = |i: usize| (l[0][i] + 4.0 * l[1][i] + l[2][i]) / 6.0;
        let row = |j: usize| (l[j][0] + 4.0 * l[j][1] + l[j][2]) / 6.0;
        let (lx, ly) = ((column(2) - column(0)) / 2.0, (row(2) - row(0)) / 2.0);
        let (lxx, lyy) = (column(2) - 2.0 * column(1) + column(0), row(2) - 2.0 * row(1) + row(0));
        let lxy = (l[2][2] + l[0][0] - l[0][2] - l[2][0]) / 4.0;
        let slope = lx * n.x + ly * n.y;
        let bend = lxx * n.x * n.x + 2.0 * lxy * n.x * n.y + lyy * n.y * n.y;
        let mut offset = -slope / bend;
        let mut width_squared = -1.0 / bend;
        if bend > -0.02 || offset.abs() > 0.8 {
            // Where edges meet there is no such quadratic; along the axis there is always a largest of three.
            let (a, b, c) = if steep { (l[0][1], l[1][1], l[2][1]) } else { (l[1][0], l[1][1], l[1][2]) };
            let along = (a - 2.0 * b + c).min(-1e-6);
            let axis = if steep { n.y } else { n.x };
            offset = (a - c) / (2.0 * along) * axis;
            width_squared = (-axis * axis / along).min(25.0);
        }
        let strength = (l[1][1] + 0.5 * slope.abs().min(1.0) * offset.abs()).exp();
        let level = f64::from(self.smooth.samples[k]);
        let sigma = noise.at(level) * curvature_noise * width_squared / strength;
        let half = if self.operator == Operator::Roberts { 0.5 } else { 0.0 };
        let pixel = [(k % w) as f64 + half, (k / w) as f64 + half];
        (point_at(pixel, offset, n, strength, sigma), width_squared)
    }
}

/// Variance of the fit's weights across, px^2: it adds to the smoothing of the noise, and to the shrinkage of curved edges.
pub(crate) const FIT_VARIANCE: f64 = 1.0 / 3.0;

/// Natural logarithm of a positive normal number, to 2e-6: the same on every processor, and faster than the exact one.
#[inline(always)]
fn ln(x: f32) -> f32 {
    let bits = x.to_bits();
    // The mantissa between the roots of 1/2 and 2.
    let up = u32::from(bits & 0x7f_ffff > 0x35_04f3);
    let exponent = (bits >> 23) as i32 - 127 + up as i32;
    let m = f32::from_bits((bits & 0x7f_ffff) | ((127 - up) << 23));
    let z = (m - 1.0) / (m + 1.0);
    let zz = z * z;
    2.0 * z * (1.0 + zz * (1.0 / 3.0 + zz * (0.2 + zz / 7.0))) + exponent as f32 * std::f32::consts::LN_2
}

/// Rows of the gradient: that of the row whose crests are marked and of the next one, and the sizes of three rows.
struct Rows {
    along: [[Vec<f32>; 2]; 2],
    sizes: [Vec<f32>; 3],
    /// Sums and differences of columns, for one row.
    columns: [Vec<f32>; 2],
}

/// Marks pixels that own a crest of at least the low limit, and of the high one.
#[inline(always)]
fn crests(field: Field<'_>, limits: [f32; 2], marks: &mut [u8]) {
    let (w, h) = (field.smooth.width, field.smooth.height);
    let row = || vec![0.0_f32; w];
    let mut rows = Rows {
        along: [[row(), row()], [row(), row()]],
        sizes: [row(), row(), row()],
        columns: [row(), row()],
    };
    // The gradient of row y + 1, then the crests of row y.
    for y in 0..h - BORDER {
        rows.along.rotate_left(1);
        rows.sizes.rotate_left(1);
        let [above, here, below] = [y, y + 1, y + 2].map(|j| &field.smooth.samples[j * w..(j + 1) * w]);
        let gradient = (&mut rows.along[1], &mut rows.sizes[2]);
        if field.operator == Operator::Roberts {
            roberts(here, below, gradient);
        } else {
            difference(field.operator, [above, here, below], &mut rows.columns, gradient);
        }
        if y >= BORDER {
            mark(&rows, limits, &mut marks[y * w..(y + 1) * w]);
        }
    }
}

/// Gradient along x and y and its size, of one row, but for its first and last pixel.
#[inline(always)]
fn difference(
    operator: Operator,
    [above, here, below]: [&[f32]; 3],
    [sums, rises]: &mut [Vec<f32>; 2],
    ([along_x, along_y], sizes): (&mut [Vec<f32>; 2], &mut Vec<f32>),
) {
    let w = here.len();
    let a = across(operator);
    let b = 1.0 - 2.0 * a;
    let (above, below) = (&above[..w], &below[..w]);
    let (sums, rises) = (&mut sums[..w], &mut rises[..w]);
    for x in 0..w {
        sums[x] = a * (above[x] + below[x]) + b * here[x];
        rises[x] = below[x] - above[x];
    }
    let n = w - 2;
    let (left, right) = (&sums[..n], &sums[2..2 + n]);
    let (before, middle, after) = (&rises[..n], &rises[1..1 + n], &rises[2..2 + n]);
    let (along_x, along_y) = (&mut along_x[1..1 + n], &mut along_y[1..1 + n]);
    let sizes = &mut sizes[1..1 + n];
    for x in 0..n {
        let gx = 0.5 * (right[x] - left[x]);
        let gy = 0.5 * (a * (before[x] + after[x]) + b * middle[x]);
        along_x[x] = gx;
        along_y[x] = gy;
        sizes[x] = (gx * gx + gy * gy).sqrt();
    }
}

/// The same by Roberts's cross.
#[inline(always)]
fn roberts(here: &[f32], below: &[f32], ([along_x, along_y], sizes): (&mut [Vec<f32>; 2], &mut Vec<f32>)) {
    for x in 1..here.len() - 1 {
        let (falling, rising) = (below[x + 1] - here[x], here[x + 1] - below[x]);
        let (gx, gy) = ((falling + rising) / 2.0, (falling - rising) / 2.0);
        along_x[x] = gx;
        along_y[x] = gy;
        sizes[x] = (gx * gx + gy * gy).sqrt();
    }
}

/// Marks the pixels of a row that own a crest.
#[inline(always)]
fn mark(rows: &Rows, [low, high]: [f32; 2], marks: &mut [u8]) {
    let n = marks.len() - 2 * BORDER;
    let row = |r: usize, x: usize| &rows.sizes[r][x..x + n];
    let (al, am, ar) = (row(0, BORDER - 1), row(0, BORDER), row(0, BORDER + 1));
    let (hl, hm, hr) = (row(1, BORDER - 1), row(1, BORDER), row(1, BORDER + 1));
    let (bl, bm, br) = (row(2, BORDER - 1), row(2, BORDER), row(2, BORDER + 1));
    let (along_x, along_y) = (&rows.along[0][0][BORDER..BORDER + n], &rows.along[0][1][BORDER..BORDER + n]);
    let marks = &mut marks[BORDER..BORDER + n];
    for x in 0..n {
        // All are read before any is chosen, so that the choice needs no branch.
        let (al, am, ar) = (al[x], am[x], ar[x]);
        let (hl, m, hr) = (hl[x], hm[x], hr[x]);
        let (bl, bm, br) = (bl[x], bm[x], br[x]);
        let (gx, gy) = (along_x[x], along_y[x]);
        let steep = gy.abs() > gx.abs();
        let same = gx * gy > 0.0;
        let most = gx.abs().max(gy.abs());
        let least = gx.abs().min(gy.abs());
        // The neighbours between which the gradient points, and those behind.
        let ahead = if steep { bm } else { hr };
        let behind = if steep { am } else { hl };
        let ahead_turned = if steep { bl } else { ar };
        let behind_turned = if steep { ar } else { bl };
        let ahead_aside = if same { br } else { ahead_turned };
        let behind_aside = if same { al } else { behind_turned };
        // Both sides of the comparison are multiplied by `most`, which saves a division.
        let before = (most - least) * behind + least * behind_aside;
        let after = (most - least) * ahead + least * ahead_aside;
        let owns = (m >= low) & (m * most >= before) & (m * most > after);
        marks[x] = (u8::from(owns) * CANDIDATE) | (u8::from(owns & (m >= high)) * STRONG);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_logarithm_is_one() {
        for k in 0..4000 {
            let x = 1e-10_f32 * 1.012_f32.powi(k);
            assert!((f64::from(ln(x)) - f64::from(x).ln()).abs() < 2e-6, "{x}");
        }
    }
}
