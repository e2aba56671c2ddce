//! The levels of the shell and of what surrounds the bone, as shares of the marrow's level beside them.

use crate::marching;
use crate::ring::{self, Plane};
use crate::stack::Stack;

/// Share of the marrow's level, over the whole bone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shares {
    pub dark: f64,
    pub outside: f64,
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

/// How far the rays go beyond the darkest place, mm.
const BEYOND_MM: f64 = 4.0;
/// Least number of rays that say something.
const LEAST_RAYS: usize = 30;

/// Looks outward from the marrow's outline in every slice: the darkest place within `shell_mm`, and the level beyond it.
/// `levels` are the marrow's, carried on beyond it. None where too few rays see anything dark.
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
    let (mut darks, mut outsides) = (Vec::new(), Vec::new());
    for k in 0..stack.size[2] {
        let span = k * stack.slice_voxels()..(k + 1) * stack.slice_voxels();
        let columns = stack.size[0];
        let slice = Slice { values: &smooth[span.clone()], columns };
        let level = Slice { values: &levels[span.clone()], columns };
        for found in marching::contours(&marrow[span], columns, 0.5, 0.0) {
            let scaled: Vec<Plane> = found.iter().map(|p| [p[0] * dx, p[1] * dy]).collect();
            let points = ring::resampled(&scaled, 3.0 * pixel);
            for (p, n) in points.iter().zip(normals(&points)) {
                let px = |s: f64| [(p[0] + s * n[0]) / dx, (p[1] + s * n[1]) / dy];
                let shell = (shell_mm / step) as usize;
                let all = shell + (BEYOND_MM / step) as usize;
                let here = level.at([p[0] / dx, p[1] / dy]);
                let ray: Vec<f64> = (0..=all).map(|m| slice.at(px(m as f64 * step)) / here).collect();
                let Some(darkest) = (0..=shell).min_by(|&a, &b| ray[a].total_cmp(&ray[b])) else { continue };
                let mut beyond: Vec<f64> =
                    ray[darkest..].iter().skip((1.5 * pixel / step) as usize).copied().collect();
                beyond.truncate((BEYOND_MM / step) as usize);
                beyond.sort_by(f64::total_cmp);
                if let Some(&outside) = beyond.get(beyond.len() / 2) {
                    darks.push(ray[darkest]);
                    outsides.push(outside);
                }
            }
        }
    }
    if darks.len() < LEAST_RAYS {
        return None;
    }
    let median = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    Some(Shares { dark: median(&mut darks), outside: median(&mut outsides) })
}
