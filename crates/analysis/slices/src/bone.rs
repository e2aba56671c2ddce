//! A bone in an MRI or CT, from one seed in its marrow.
//!
//! In three dimensions: the marrow is grown from the seed ([`crate::grow`]); the levels of the shell and of what is outside
//! are measured around it ([`crate::levels`]); the bone is the marrow, the dark voxels that hang on it within the shell's
//! greatest thickness, and what these enclose. So the bone is followed from slice to slice, ends where it ends, and parts and
//! joins of itself.
//!
//! In each slice the contours are then placed to a fraction of a pixel ([`crate::placing`]).
//!
//! **Not here:** a bone whose shell is open over more than `leak_mm`, or that touches something as dark as its shell over
//! a long way (a tendon, a meniscus): there the outline may be off by up to the shell's thickness.

use std::borrow::Cow;
use std::collections::VecDeque;

use biplane_artifact::Volume;
use biplane_stage::Context;

use crate::blur::gaussian;
use crate::distance::{Within, to_set};
use crate::levels::{LEAST_CONTRAST, Shares, shares};
use crate::placing::Placing;
use crate::stack::Stack;
use crate::stage::{Contrast, Found, SeedPlace, SlicesParams};
use crate::{SlicesError, grow};

/// Smoothing of the levels that voxels are sorted by, pixels.
const SORTING_PX: f64 = 0.6;
/// Less marrow than this is none, mm^3.
const LEAST_MARROW_MM3: f64 = 100.0;
/// More of the volume than this is no marrow.
const MOST_MARROW: f64 = 0.5;
/// A voxel is dark from this share of the shell's contrast on: of a shell thinner than a slice that leans there is no more.
const DARK: f64 = 0.25;
/// The shell is nowhere thicker than this times what it is on the whole around there.
const END: f64 = 1.5;
/// Part of a slice's thickness over which marrow may fade before the shell is dark.
const SPREAD: f64 = 1.0;

/// Contours of each slice of the whole stack.
pub(crate) struct BoneContours {
    pub slices: Vec<Found>,
    pub warnings: Vec<String>,
}

/// # Errors
/// No bone around the seed, or the run was cancelled.
pub(crate) fn contours(
    volume: &Volume,
    whole: &Stack,
    (place, slice): SeedPlace,
    seed_mm: [f64; 3],
    params: &SlicesParams,
    context: &Context,
) -> Result<BoneContours, SlicesError> {
    let none = |found: String, change| SlicesError::NoBone { seed: seed_mm, found, change };
    let pixel = (whole.pixel_mm[0] * whole.pixel_mm[1]).sqrt();
    let samples = dark_shell(&volume.samples, params.contrast);
    let sorting = gaussian(whole, &samples, [SORTING_PX * pixel; 3]);
    let nearest = |a: usize| (place[a].round().max(0.0) as usize).min(whole.size[a] - 1);
    let seed = whole.index([nearest(0), nearest(1), slice]);
    let grown = grow::grow(whole, &sorting, seed, params.tolerance as f32);
    let margin = params.shell_mm + 6.0 * pixel;
    let Some((low, high)) = whole.bounds(|v| !grown[v].is_nan(), margin) else {
        return Err(none("is no level that can be followed".to_owned(), "contrast"));
    };
    stop_if(context)?;

    let stack = whole.part(low, high);
    let samples = whole.cut(&samples, low, high);
    let sorting = whole.cut(&sorting, low, high);
    let mut levels = whole.cut(&grown, low, high);
    let at = whole.place(seed);
    let seed = stack.index(std::array::from_fn(|a| at[a] - low[a]));
    let grown: Vec<bool> = levels.iter().map(|l| !l.is_nan()).collect();
    let marrow = grow::without_leaks(&stack, &grown, seed, params.leak_mm as f32);
    let count = marrow.iter().filter(|&&m| m).count();
    let voxel_mm3 = whole.pixel_mm[0] * whole.pixel_mm[1] * whole.thickness_mm(slice);
    let mm3 = count as f64 * voxel_mm3;
    if mm3 < LEAST_MARROW_MM3 {
        let found = format!("hang together only {mm3:.0} mm^3 of one level");
        return Err(none(found, "tolerance (larger) or leak_mm (smaller)"));
    }
    if count as f64 > MOST_MARROW * whole.voxels() as f64 {
        let share = 100.0 * count as f64 / whole.voxels() as f64;
        let found = format!("{share:.0} % of the volume hang together at one level: no shell closes it off");
        return Err(none(found, "tolerance (smaller) or leak_mm (larger)"));
    }
    for (level, _) in levels.iter_mut().zip(&marrow).filter(|(_, m)| !**m) {
        *level = f32::NAN;
    }
    carry_on(&stack, &mut levels);
    let noise = noise(&stack, &samples, &marrow);
    stop_if(context)?;

    let filled: Vec<f32> = marrow.iter().map(|&m| if m { 1.0 } else { 0.0 }).collect();
    let found = shares(&stack, &sorting, &filled, &levels, params.shell_mm);
    let Some(shares) = found.as_ref().filter(|s| s.outside.min(1.0) - s.dark > LEAST_CONTRAST) else {
        let found = match &found {
            Some(s) => format!(
                "the marrow's border is at {:.0} % of its level and what lies beyond at {:.0} %: no shell between them",
                100.0 * s.dark,
                100.0 * s.outside
            ),
            None => "no shell is to be seen".to_owned(),
        };
        return Err(none(found, "contrast, shell_mm or tolerance"));
    };
    let bone = enclosed(&stack, &sorting, &marrow, &levels, shares, params.shell_mm);
    stop_if(context)?;

    let placing = Placing {
        stack: &stack,
        samples: &samples,
        levels: &levels,
        bone: &bone,
        shares,
        noise,
        shell_mm: params.shell_mm,
    };
    let off = placing.off_outline();
    let mut slices = vec![Found::default(); whole.size[2]];
    for k in 0..stack.size[2] {
        stop_if(context)?;
        slices[low[2] + k] = placing.slice(k, &off, [low[0] as f64, low[1] as f64]);
    }
    let mut warnings = Vec::new();
    let dropped = grown.iter().filter(|&&g| g).count() - count;
    if dropped > count {
        warnings.push(format!(
            "what hangs together at the marrow's level is {:.0} times as large as the bone: it was cut off where it is narrower \
             than {} mm (leak_mm); look whether the contours leave the bone",
            dropped as f64 / count as f64 + 1.0,
            2.0 * params.leak_mm
        ));
    }
    Ok(BoneContours { slices, warnings })
}

fn stop_if(context: &Context) -> Result<(), SlicesError> {
    if context.cancelled() { Err(SlicesError::Cancelled) } else { Ok(()) }
}

/// Levels of which the shell's are the lowest, and none is negative. Bright shells are turned round about the level that one
/// voxel in a thousand exceeds, so that metal does not set it.
fn dark_shell(samples: &[f32], contrast: Contrast) -> Cow<'_, [f32]> {
    let mut sorted = samples.to_vec();
    match contrast {
        Contrast::Dark => {
            if samples.iter().all(|s| *s >= 0.0) {
                return Cow::Borrowed(samples);
            }
            Cow::Owned(samples.iter().map(|s| s.max(0.0)).collect())
        }
        Contrast::Bright => {
            let at = (sorted.len() - 1) - sorted.len() / 1000;
            let (_, top, _) = sorted.select_nth_unstable_by(at, f32::total_cmp);
            let top = *top;
            Cow::Owned(samples.iter().map(|s| (top - s).max(0.0)).collect())
        }
    }
}

/// Carries levels on to where there is none (NaN): each takes that of the neighbour that was reached first.
fn carry_on(stack: &Stack, levels: &mut [f32]) {
    let mut queue: VecDeque<usize> = (0..levels.len()).filter(|&v| !levels[v].is_nan()).collect();
    while let Some(v) = queue.pop_front() {
        for n in stack.neighbours(v) {
            if levels[n].is_nan() {
                levels[n] = levels[v];
                queue.push_back(n);
            }
        }
    }
}

/// Standard deviation of a voxel's level in the marrow, from how it differs from the mean of the four beside it in the slice.
fn noise(stack: &Stack, samples: &[f32], marrow: &[bool]) -> f64 {
    let row = stack.size[0];
    let mut off: Vec<f32> = Vec::new();
    for v in (0..samples.len()).filter(|&v| marrow[v]) {
        let [i, j, _] = stack.place(v);
        if i > 0 && j > 0 && i + 1 < row && j + 1 < stack.size[1] {
            let beside = [v - 1, v + 1, v - row, v + row];
            if beside.iter().all(|&b| marrow[b]) {
                off.push((samples[v] - beside.iter().map(|&b| samples[b]).sum::<f32>() / 4.0).abs());
            }
        }
    }
    off.sort_by(f32::total_cmp);
    // The variance of such a difference is 5/4 of a voxel's; 1.4826 takes the median of sizes to a standard deviation.
    let median = off.get(off.len() / 2).copied().unwrap_or(0.0);
    1.4826 * f64::from(median) / 1.25_f64.sqrt()
}

/// The marrow, the dark voxels that hang on it no farther than the shell is thick, and all that these enclose.
fn enclosed(
    stack: &Stack,
    sorting: &[f32],
    marrow: &[bool],
    levels: &[f32],
    shares: &Shares,
    shell_mm: f64,
) -> Vec<bool> {
    let pixel = stack.pixel_mm[0].max(stack.pixel_mm[1]);
    // A shell that lies flat in a thick slice is a slice away from the marrow: slices count as no farther than that.
    let mut near = stack.clone();
    for k in 1..stack.size[2] {
        let gap = (stack.heights_mm[k] - stack.heights_mm[k - 1]).min(0.9 * shell_mm);
        near.heights_mm[k] = near.heights_mm[k - 1] + gap;
    }
    let off = to_set(&near, |v| marrow[v], Within::Stack);
    let least = |v: usize| {
        let outside = shares.outside_at(stack.place(v));
        (outside - DARK * (outside - shares.dark)) as f32
    };
    let rim = 1.5 * pixel as f32;
    let reach = |v: usize| {
        let place = stack.place(v);
        let least = SPREAD * stack.thickness_mm(place[2]);
        (END * shares.end_mm_at(place)).max(least).min(shell_mm) as f32 + rim
    };
    let shell =
        |v: usize| off[v] <= shell_mm as f32 + rim && off[v] <= reach(v) && sorting[v] < least(v) * levels[v];
    // Across a thick slice a leaning surface goes from bright to dark over a part of its thickness.
    let first: Vec<f32> =
        (0..stack.size[2]).map(|k| rim.max((SPREAD * stack.thickness_mm(k)) as f32)).collect();
    let starts = (0..stack.voxels())
        .filter(|&v| off[v] > 0.0 && off[v] <= first[v / stack.slice_voxels()] && shell(v));
    let solid = grow::reached(stack, shell, starts);
    let kept = between(stack, &off, &solid);
    let open = |v: usize| !(marrow[v] || kept[v]);
    let border = (0..stack.voxels()).filter(|&v| {
        let place = stack.place(v);
        (0..3).any(|a| place[a] == 0 || place[a] + 1 == stack.size[a])
    });
    let mut bone: Vec<bool> = grow::reached(stack, open, border).into_iter().map(|beyond| !beyond).collect();
    let pixel_mm2 = stack.pixel_mm[0] * stack.pixel_mm[1];
    let small = std::f64::consts::PI * shell_mm * shell_mm / pixel_mm2;
    fill_gaps(stack, &mut bone, small as usize, |v| off[v] <= reach(v));
    bone
}

/// Fills what a slice shows enclosed by bone, where it is small or all of it near enough to the marrow: from a thick slice
/// to the next the way between marrow and shell may be open.
fn fill_gaps(stack: &Stack, bone: &mut [bool], small: usize, near: impl Fn(usize) -> bool) {
    let gaps = grow::Pieces::of(stack, |v| !bone[v]);
    for gap in gaps.voxels {
        let inside = |&v: &usize| {
            let [i, j, _] = stack.place(v);
            i > 0 && j > 0 && i + 1 < stack.size[0] && j + 1 < stack.size[1]
        };
        if gap.iter().all(inside) && (gap.len() <= small || gap.iter().all(|&v| near(v))) {
            gap.iter().for_each(|&v| bone[v] = true);
        }
    }
}

/// A set with all that lies between it and the marrow: the way down the distance `off` from the marrow, from voxel to voxel.
/// Where a slice is thick, marrow and shell share voxels that are neither bright nor dark.
fn between(stack: &Stack, off: &[f32], set: &[bool]) -> Vec<bool> {
    let mut kept = set.to_vec();
    let mut walked = vec![false; set.len()];
    for start in (0..set.len()).filter(|&v| set[v]) {
        let mut at = start;
        while !walked[at] && off[at] > 0.0 {
            (walked[at], kept[at]) = (true, true);
            let below = stack.neighbours(at).min_by(|&a, &b| off[a].total_cmp(&off[b]));
            at = below.filter(|&b| off[b] < off[at]).unwrap_or(at);
        }
    }
    kept
}
