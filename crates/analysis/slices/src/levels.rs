//! The levels of the shell and of what surrounds the bone, as shares of the marrow's level beside them.

use crate::blur::gaussian;
use crate::marching::{self, Saddles};
use crate::ring::{self, Plane};
use crate::stack::Stack;

/// Levels around a bone, as shares of the marrow's: the shell's one for all of it; that outside changes from place to place
/// (fat, muscle, cartilage) and is kept in cells.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Shares {
    pub dark: f64,
    /// What is usual outside.
    pub outside: f64,
    outsides: Vec<f32>,
    /// How far from the marrow the shell ends, mm.
    ends: Vec<f32>,
    /// Voxels in a cell along each axis, and the number of cells.
    cell: [usize; 3],
    size: [usize; 3],
}

impl Shares {
    /// Share of the level outside of the bone near a voxel.
    pub fn outside_at(&self, place: [usize; 3]) -> f64 {
        f64::from(self.outsides[self.cell_of(place)])
    }

    /// How far from the marrow the shell ends near a voxel, mm.
    pub fn end_mm_at(&self, place: [usize; 3]) -> f64 {
        f64::from(self.ends[self.cell_of(place)])
    }

    fn cell_of(&self, place: [usize; 3]) -> usize {
        let at: [usize; 3] = std::array::from_fn(|a| (place[a] / self.cell[a]).min(self.size[a] - 1));
        (at[2] * self.size[1] + at[1]) * self.size[0] + at[0]
    }
}

/// One slice, to be read between its pixels.
pub(crate) struct Slice<'a> {
    pub values: &'a [f32],
    pub columns: usize,
}

impl Slice<'_> {
    /// Linear between pixels; beyond the border as on it.
    pub fn at(&self, [i, j]: Plane) -> f64 {
        let rows = self.values.len() / self.columns;
        let split = |v: f64, count: usize| {
            let v = v.clamp(0.0, count as f64 - 1.0);
            let low = (v as usize).min(count.saturating_sub(2));
            (low, v - low as f64, usize::from(count > 1))
        };
        let ((x, s, right), (y, t, down)) = (split(i, self.columns), split(j, rows));
        let value = |x: usize, y: usize| f64::from(self.values[y * self.columns + x]);
        let row = |y: usize| value(x, y) * (1.0 - s) + value(x + right, y) * s;
        row(y) * (1.0 - t) + row(y + down) * t
    }
}

/// Unit normals of a ring of evenly spread points: to the right of the way, which is outward where bone is to the left.
pub(crate) fn normals(ring: &[Plane]) -> Vec<Plane> {
    let count = ring.len();
    (0..count)
        .map(|n| {
            let (before, after) = (ring[(n + count - 2) % count], ring[(n + 2) % count]);
            let along = [after[0] - before[0], after[1] - before[1]];
            let size = along[0].hypot(along[1]).max(f64::MIN_POSITIVE);
            [along[1] / size, -along[0] / size]
        })
        .collect()
}

/// How far the rays go beyond the shell, mm.
const BEYOND_MM: f64 = 4.0;
/// By how much of the marrow's level it gets brighter beyond a shell.
const RISE: f64 = 0.12;
/// Least number of rays that say something.
const LEAST_RAYS: usize = 30;
/// A shell has to be darker than marrow and than what is outside by this share of the marrow's level.
pub(crate) const LEAST_CONTRAST: f64 = 0.1;
/// Side of a cell, and the reach of a ray's word, mm.
const CELL_MM: f64 = 3.0;
/// The darkest places differ by how much of a voxel the shell fills: so many of them are as dark as the shell.
const DARK_SHARE: f64 = 0.25;
/// How many rays the usual level outside counts for in a cell.
const USUAL_RAYS: f32 = 0.02;

/// Looks outward from the marrow's outline in every slice: the darkest place within `shell_mm` before it gets brighter again,
/// and the level beyond it. `levels` are the marrow's, carried on beyond it. None where too few rays see anything dark.
pub(crate) fn shares(
    stack: &Stack,
    smooth: &[f32],
    marrow: &[f32],
    levels: &[f32],
    shell_mm: f64,
) -> Option<Shares> {
    let [dx, dy] = stack.pixel_mm;
    let pixel = (dx * dy).sqrt();
    let step = pixel / 2.0;
    let shell = (shell_mm / step) as usize;
    let beyond = (BEYOND_MM / step) as usize;
    let (mut darks, mut seen) = (Vec::new(), Vec::new());
    for k in 0..stack.size[2] {
        let span = k * stack.slice_voxels()..(k + 1) * stack.slice_voxels();
        let columns = stack.size[0];
        let slice = Slice { values: &smooth[span.clone()], columns };
        let level = Slice { values: &levels[span.clone()], columns };
        let own = Slice { values: &marrow[span.clone()], columns };
        for found in marching::contours(&marrow[span], columns, 0.5, 0.0, Saddles::Bilinear) {
            let scaled: Vec<Plane> = found.iter().map(|p| [p[0] * dx, p[1] * dy]).collect();
            let points = ring::resampled(&scaled, 2.0 * pixel);
            for (p, n) in points.iter().zip(normals(&points)) {
                let px = |s: f64| [(p[0] + s * n[0]) / dx, (p[1] + s * n[1]) / dy];
                let here = level.at(px(0.0));
                let ray: Vec<f64> =
                    (0..=shell + beyond).map(|m| slice.at(px(m as f64 * step)) / here).collect();
                let Some(darkest) = valley(&ray, shell) else { continue };
                let first = darkest + (1.5 * pixel / step) as usize;
                let last = ray.len().min(first + beyond);
                // A ray that comes to marrow again says nothing of what is outside.
                if (first..last).any(|m| own.at(px(m as f64 * step)) > 0.0) {
                    continue;
                }
                let mut after = ray[first.min(last)..last].to_vec();
                after.sort_by(f64::total_cmp);
                // The upper quartile: a part of the way may still be in a shell that leans.
                if let Some(&outside) = after.get(after.len() * 3 / 4) {
                    darks.push(ray[darkest]);
                    let [i, j] = px(darkest as f64 * step).map(|v| v.round().max(0.0) as usize);
                    let half = (ray[darkest] + outside) / 2.0;
                    let end = (darkest..ray.len()).find(|&m| ray[m] > half).unwrap_or(shell);
                    seen.push(([i, j, k], [outside, end as f64 * step]));
                }
            }
        }
    }
    if darks.len() < LEAST_RAYS {
        return None;
    }
    let at = |mut values: Vec<f64>, share: f64| {
        values.sort_by(f64::total_cmp);
        values[(values.len() as f64 * share) as usize]
    };
    let usual = [0, 1].map(|n| at(seen.iter().map(|s| s.1[n]).collect(), 0.5));
    let thickness = stack.thickness_mm(stack.size[2] / 2);
    let cell = [dx, dy, thickness].map(|mm| ((CELL_MM / mm).round() as usize).max(1));
    let size: [usize; 3] = std::array::from_fn(|a| stack.size[a].div_ceil(cell[a]));
    let coarse = Stack {
        size,
        pixel_mm: [dx * cell[0] as f64, dy * cell[1] as f64],
        heights_mm: (0..size[2]).map(|k| thickness * (cell[2] * k) as f64).collect(),
    };
    let mut sums = [0, 1, 2].map(|_| vec![0.0_f32; coarse.voxels()]);
    for (place, values) in seen {
        let at = coarse.index(std::array::from_fn(|a| (place[a] / cell[a]).min(size[a] - 1)));
        for (sum, value) in sums.iter_mut().zip([values[0], values[1], 1.0]) {
            sum[at] += value as f32;
        }
    }
    let [outside, end, rays] = sums.map(|v| gaussian(&coarse, &v, [CELL_MM; 3]));
    let mean = |sum: Vec<f32>, usual: f64| {
        let of = |(s, w): (f32, &f32)| (s + USUAL_RAYS * usual as f32) / (w + USUAL_RAYS);
        sum.into_iter().zip(&rays).map(of).collect()
    };
    Some(Shares {
        dark: at(darks, DARK_SHARE),
        outside: usual[0],
        outsides: mean(outside, usual[0]),
        ends: mean(end, usual[1]),
        cell,
        size,
    })
}

/// The darkest place of a ray, at most `shell` from its start, before it gets brighter by [`RISE`].
fn valley(ray: &[f64], shell: usize) -> Option<usize> {
    let mut darkest = 0;
    for (n, &level) in ray.iter().enumerate() {
        if level < ray[darkest] {
            darkest = n;
        } else if level > ray[darkest] + RISE && ray[darkest] < 1.0 - RISE {
            return (darkest <= shell).then_some(darkest);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slice_is_linear_between_its_pixels() {
        let slice = Slice { values: &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], columns: 3 };
        assert_eq!(slice.at([0.25, 0.5]), 1.75);
        assert_eq!((slice.at([-3.0, 0.0]), slice.at([9.0, 9.0])), (0.0, 5.0));
        assert_eq!(Slice { values: &[7.0], columns: 1 }.at([0.4, 0.4]), 7.0);
    }

    #[test]
    fn the_first_valley_counts_and_it_has_two_sides() {
        assert_eq!(valley(&[1.0, 0.6, 0.2, 0.25, 0.5, 0.1, 0.6], 6), Some(2));
        assert_eq!(valley(&[1.0, 0.6, 0.2, 0.25, 0.5, 0.1, 0.6], 1), None);
        assert_eq!(valley(&[1.0, 0.6, 0.2, 0.2], 3), None);
        assert_eq!(valley(&[1.0, 1.05, 1.2, 1.4], 3), None);
    }
}
