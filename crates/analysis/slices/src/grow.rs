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

/// A piece of a slice far from its neighbour belongs to that one's where this part of it lies over it,
const COVERED: f64 = 0.75;
/// or no farther beside it than this times the distance of the slices.
const SLOPE: f64 = 1.0;

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
/// piece around the seed where even that is narrower. Slices farther apart than `leak_mm` are followed by what they show: a
/// piece of one belongs to that of the next where it lies over it for the most part.
pub(crate) fn without_leaks(stack: &Stack, set: &[bool], seed: usize, leak_mm: f32) -> Vec<bool> {
    let depth = to_set(stack, |v| !set[v], Within::Stack);
    let deepest = |&a: &usize, &b: &usize| depth[a].total_cmp(&depth[b]).then(b.cmp(&a));
    let Some(start) = around(stack, seed).into_iter().filter(|&v| set[v]).max_by(deepest) else {
        return vec![false; set.len()];
    };
    let leak_mm = leak_mm.min(0.99 * depth[start]);
    let core = followed(stack, &depth, leak_mm, start);
    let off = to_set(stack, |v| core[v], Within::Stack);
    let reach = leak_mm + (stack.pixel_mm[0].max(stack.pixel_mm[1])) as f32;
    reached(stack, |v| set[v] && off[v] <= reach, (0..core.len()).filter(|&v| core[v]))
}

/// The voxels deeper than `leak_mm` that hang together with `start`.
fn followed(stack: &Stack, depth: &[f32], leak_mm: f32, start: usize) -> Vec<bool> {
    let size = stack.slice_voxels();
    let deep = |v: usize| depth[v] > leak_mm;
    let pieces = Pieces::of(stack, deep);
    let mut taken = vec![false; pieces.voxels.len()];
    let mut open = vec![pieces.number[start]];
    while let Some(piece) = open.pop().filter(|&p| p != NO_PIECE) {
        if std::mem::replace(&mut taken[piece as usize], true) {
            continue;
        }
        let here = &pieces.voxels[piece as usize];
        let k = here[0] / size;
        for next in [k.checked_sub(1), (k + 1 < stack.size[2]).then_some(k + 1)].into_iter().flatten() {
            let gap = (stack.heights_mm[next] - stack.heights_mm[k]).abs();
            let beside = |v: usize| v % size + next * size;
            let mut met: Vec<u32> =
                here.iter().map(|&v| pieces.number[beside(v)]).filter(|&p| p != NO_PIECE).collect();
            met.sort_unstable();
            met.dedup();
            met.retain(|&p| !taken[p as usize]);
            if gap as f32 > leak_mm && !met.is_empty() {
                let flat = Stack {
                    size: [stack.size[0], stack.size[1], 1],
                    pixel_mm: stack.pixel_mm,
                    heights_mm: vec![0.0],
                };
                let mut mask = vec![false; size];
                here.iter().for_each(|&v| mask[v % size] = true);
                let off = to_set(&flat, |v| mask[v], Within::Slice);
                met.retain(|&p| {
                    let all = &pieces.voxels[p as usize];
                    let over = all.iter().filter(|&&v| f64::from(off[v % size]) <= SLOPE * gap).count();
                    over as f64 >= COVERED * all.len() as f64
                });
            }
            open.extend(met);
        }
    }
    (0..stack.voxels()).map(|v| pieces.number[v] != NO_PIECE && taken[pieces.number[v] as usize]).collect()
}

/// Pieces of a set within each slice.
pub(crate) struct Pieces {
    /// The piece each voxel belongs to.
    number: Vec<u32>,
    pub voxels: Vec<Vec<usize>>,
}

const NO_PIECE: u32 = u32::MAX;

impl Pieces {
    pub fn of(stack: &Stack, set: impl Fn(usize) -> bool) -> Self {
        let mut pieces = Self { number: vec![NO_PIECE; stack.voxels()], voxels: Vec::new() };
        for start in 0..stack.voxels() {
            if !set(start) || pieces.number[start] != NO_PIECE {
                continue;
            }
            let own = pieces.voxels.len() as u32;
            pieces.number[start] = own;
            let mut voxels = vec![start];
            let mut at = 0;
            while let Some(&v) = voxels.get(at) {
                at += 1;
                for n in stack.neighbours(v).filter(|n| n / stack.slice_voxels() == v / stack.slice_voxels())
                {
                    if set(n) && pieces.number[n] == NO_PIECE {
                        pieces.number[n] = own;
                        voxels.push(n);
                    }
                }
            }
            pieces.voxels.push(voxels);
        }
        pieces
    }
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
