//! The marrow around a seed: voxels of the seed's level that hang together.
//!
//! The level is followed from voxel to voxel (each takes a small share of its own value into the level that its neighbours
//! are held against), so the slow change of a coil's gain does not stop it. What hangs together only through a neck narrower
//! than twice `leak_mm` is cut off: a hole of the shell is such a neck, and behind it lies another tissue of a like level.

use std::collections::VecDeque;

use crate::distance::{Within, to_set};
use crate::stack::Stack;

/// Share of a voxel's own value in its level.
const FOLLOW: f32 = 0.05;
/// By how much a level may differ from the seed's, as a factor: a coil's gain, not another tissue.
const FARTHEST: f32 = 2.5;
/// Voxels this near to the seed are where growth begins, mm.
const SEED_MM: f64 = 2.0;

/// Level of each voxel of the marrow, NaN elsewhere. Grows over `smooth` from a voxel; `tolerance` is by how much a voxel
/// may differ, as a share of the level.
pub(crate) fn grow(stack: &Stack, smooth: &[f32], seed: usize, tolerance: f32) -> Vec<f32> {
    let near = around(stack, seed);
    let mut values: Vec<f32> = near.iter().map(|&v| smooth[v]).collect();
    values.sort_by(f32::total_cmp);
    let seed_level = values[values.len() / 2];
    let mut levels = vec![f32::NAN; stack.voxels()];
    let mut queue = VecDeque::new();
    for v in near.into_iter().filter(|&v| (smooth[v] - seed_level).abs() <= tolerance * seed_level) {
        levels[v] = seed_level;
        queue.push_back(v);
    }
    while let Some(v) = queue.pop_front() {
        let level = levels[v];
        for n in stack.neighbours(v) {
            let off = smooth[n] - level;
            if levels[n].is_nan() && off.abs() <= tolerance * level {
                let own = level + FOLLOW * off;
                if (seed_level / FARTHEST..=seed_level * FARTHEST).contains(&own) {
                    levels[n] = own;
                    queue.push_back(n);
                }
            }
        }
    }
    levels
}

/// Voxels within [`SEED_MM`] of one, itself always.
fn around(stack: &Stack, seed: usize) -> Vec<usize> {
    let centre = stack.place(seed);
    let mm = |place: [usize; 3]| {
        let plane =
            (0..2).map(|a| (place[a].abs_diff(centre[a]) as f64 * stack.pixel_mm[a]).powi(2)).sum::<f64>();
        (plane + (stack.heights_mm[place[2]] - stack.heights_mm[centre[2]]).powi(2)).sqrt()
    };
    let reach = [0, 1].map(|a| (SEED_MM / stack.pixel_mm[a]) as usize);
    let span = |a: usize| centre[a].saturating_sub(reach[a])..(centre[a] + reach[a] + 1).min(stack.size[a]);
    let mut found = Vec::new();
    for k in 0..stack.size[2] {
        for j in span(1) {
            found.extend(span(0).map(|i| [i, j, k]).filter(|p| mm(*p) <= SEED_MM).map(|p| stack.index(p)));
        }
    }
    found
}

/// The part of a set that hangs together with the seed through nothing narrower than twice `leak_mm`; all of the set's
/// piece around the seed where even that is narrower.
pub(crate) fn without_leaks(stack: &Stack, set: &[bool], seed: usize, leak_mm: f32) -> Vec<bool> {
    if leak_mm <= 0.0 {
        return set.to_vec();
    }
    let depth = to_set(stack, |v| !set[v], Within::Stack);
    let start = around(stack, seed)
        .into_iter()
        .filter(|&v| set[v])
        .max_by(|&a, &b| depth[a].total_cmp(&depth[b]).then(b.cmp(&a)));
    let Some(start) = start else {
        return set.to_vec();
    };
    let core = piece(stack, |v| depth[v] > leak_mm, start);
    if !core[start] {
        return set.to_vec();
    }
    let off = to_set(stack, |v| core[v], Within::Stack);
    let reach = leak_mm + (stack.pixel_mm[0].max(stack.pixel_mm[1])) as f32;
    piece(stack, |v| set[v] && off[v] <= reach, start)
}

/// The voxels of a set that hang together with one, across faces; none where that is not in the set.
pub(crate) fn piece(stack: &Stack, set: impl Fn(usize) -> bool, start: usize) -> Vec<bool> {
    reached(stack, set, [start])
}

/// The voxels of a set that hang together with any of those given, across faces.
pub(crate) fn reached(
    stack: &Stack,
    set: impl Fn(usize) -> bool,
    starts: impl IntoIterator<Item = usize>,
) -> Vec<bool> {
    let mut seen = vec![false; stack.voxels()];
    let mut open: Vec<usize> = Vec::new();
    for v in starts {
        if set(v) && !seen[v] {
            seen[v] = true;
            open.push(v);
        }
    }
    while let Some(v) = open.pop() {
        for n in stack.neighbours(v) {
            if !seen[n] && set(n) {
                seen[n] = true;
                open.push(n);
            }
        }
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two balls of marrow in a stack of 40 x 24 x 24 voxels of 1 mm, joined by a neck; the level rises by a third along x.
    fn dumbbell(neck: f64) -> (Stack, Vec<f32>) {
        let stack =
            Stack { size: [40, 24, 24], pixel_mm: [1.0; 2], heights_mm: (0..24).map(f64::from).collect() };
        let values = (0..stack.voxels())
            .map(|v| {
                let [x, y, z] = stack.place(v).map(|c| c as f64);
                let off = ((y - 12.0).powi(2) + (z - 12.0).powi(2)).sqrt();
                let inside = (x - 10.0).hypot(off) < 8.0 || (x - 30.0).hypot(off) < 8.0;
                let joined = off < neck && (10.0..30.0).contains(&x);
                if inside || joined { 900.0 + 300.0 * x as f32 / 40.0 } else { 200.0 }
            })
            .collect();
        (stack, values)
    }

    #[test]
    fn a_changing_level_is_followed_and_a_leak_is_cut_off() {
        let (stack, values) = dumbbell(1.5);
        let seed = stack.index([10, 12, 12]);
        let levels = grow(&stack, &values, seed, 0.15);
        let set: Vec<bool> = levels.iter().map(|l| !l.is_nan()).collect();
        assert_eq!(set, values.iter().map(|&v| v > 500.0).collect::<Vec<_>>());
        let kept = without_leaks(&stack, &set, seed, 2.0);
        assert!(kept[stack.index([4, 12, 12])] && !kept[stack.index([30, 12, 12])]);
        let (stack, values) = dumbbell(5.0);
        let set: Vec<bool> = values.iter().map(|&v| v > 500.0).collect();
        assert!(without_leaks(&stack, &set, seed, 2.0)[stack.index([36, 12, 12])]);
    }
}
