//! Exact Euclidean distance to a set of voxels, in mm, over voxels that are no cubes and slices spaced as they are.
//!
//! Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions" (2012): the lower envelope of parabolas, one axis
//! after the other, at the places where the samples are.

use crate::stack::Stack;

/// Which neighbours count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Within {
    /// Only those of the same slice.
    Slice,
    /// Those of all slices.
    Stack,
}

/// Distance of each voxel's centre to that of the nearest voxel that is in the set, mm; infinite where there is none.
pub(crate) fn to_set(stack: &Stack, set: impl Fn(usize) -> bool, within: Within) -> Vec<f32> {
    let mut squares: Vec<f32> =
        (0..stack.voxels()).map(|v| if set(v) { 0.0 } else { f32::INFINITY }).collect();
    let steps = [1, stack.size[0], stack.slice_voxels()];
    let axes = if within == Within::Slice { 2 } else { 3 };
    for (axis, &step) in steps.iter().enumerate().take(axes) {
        let count = stack.size[axis];
        let at: Vec<f32> = (0..count)
            .map(|n| match axis {
                2 => stack.heights_mm[n] as f32,
                _ => (n as f64 * stack.pixel_mm[axis]) as f32,
            })
            .collect();
        let mut envelope = Envelope::default();
        let mut line = vec![0.0; count];
        for block in (0..stack.voxels()).step_by(count * step) {
            for first in block..block + step {
                for (n, value) in line.iter_mut().enumerate() {
                    *value = squares[first + n * step];
                }
                if line.iter().all(|v| v.is_infinite()) || line.iter().all(|v| *v == 0.0) {
                    continue;
                }
                envelope.of(&line, &at);
                envelope.write(&line, &at, |n, value| squares[first + n * step] = value);
            }
        }
    }
    squares.into_iter().map(f32::sqrt).collect()
}

/// Which parabola is lowest where.
#[derive(Default)]
struct Envelope {
    /// Sample each parabola stands on.
    lowest: Vec<usize>,
    /// From where on it is the lowest.
    from: Vec<f32>,
}

impl Envelope {
    fn of(&mut self, line: &[f32], at: &[f32]) {
        self.lowest.clear();
        self.from.clear();
        for q in (0..line.len()).filter(|&q| line[q].is_finite()) {
            let mut start = f32::NEG_INFINITY;
            while let Some(&v) = self.lowest.last() {
                // Where the parabolas of v and q meet.
                let middle = (at[q] + at[v]) / 2.0;
                start = middle + (line[q] - line[v]) / (2.0 * (at[q] - at[v]));
                if self.from.last().is_some_and(|&f| start <= f) {
                    self.lowest.pop();
                    self.from.pop();
                    start = f32::NEG_INFINITY;
                } else {
                    break;
                }
            }
            self.lowest.push(q);
            self.from.push(start);
        }
    }

    fn write(&self, line: &[f32], at: &[f32], mut out: impl FnMut(usize, f32)) {
        let mut k = 0;
        for (n, &x) in at.iter().enumerate() {
            while self.from.get(k + 1).is_some_and(|&f| f < x) {
                k += 1;
            }
            if let Some(&v) = self.lowest.get(k) {
                out(n, (x - at[v]).powi(2) + line[v]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    #[test]
    fn it_is_what_trying_all_gives() {
        let mut rng = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(1);
        let stack =
            Stack { size: [9, 8, 5], pixel_mm: [0.5, 0.7], heights_mm: vec![0.0, 2.0, 2.5, 6.0, 7.0] };
        let at = |v: usize| {
            let [i, j, k] = stack.place(v);
            [0.5 * i as f64, 0.7 * j as f64, stack.heights_mm[k]]
        };
        for share in [0.005, 0.05, 0.5] {
            let set: Vec<bool> = (0..stack.voxels()).map(|_| rng.random::<f64>() < share).collect();
            for within in [Within::Slice, Within::Stack] {
                let found = to_set(&stack, |v| set[v], within);
                for v in 0..stack.voxels() {
                    let same = |u: &usize| within == Within::Stack || stack.place(*u)[2] == stack.place(v)[2];
                    let wanted = (0..stack.voxels())
                        .filter(|&u| set[u])
                        .filter(same)
                        .map(|u| (0..3).map(|a| (at(u)[a] - at(v)[a]).powi(2)).sum::<f64>().sqrt())
                        .fold(f64::INFINITY, f64::min);
                    let found = f64::from(found[v]);
                    assert!(found == wanted || (found - wanted).abs() < 1e-4, "{found} {wanted}");
                }
            }
        }
    }
}
