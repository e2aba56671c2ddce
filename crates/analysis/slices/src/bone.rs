//! A bone in an MRI or CT, from one seed in its marrow.
//!
//! In three dimensions: the marrow is grown from the seed ([`crate::grow`]); the levels of the shell and of what is outside
//! are measured around it ([`crate::levels`]); the bone is the marrow, the dark voxels that hang on it within the shell's
//! greatest thickness, and what these enclose. So the bone is followed from slice to slice, ends where it ends, and parts and
//! joins of itself.
//!
//! In each slice: the outline of the bone's voxels, each counted by how much of it is dark, is smoothed; along its normals
//! the outside of the shell is placed by a model of the scanner ([`crate::shell`]); the places are smoothed along the outline
//! by their standard deviations ([`crate::evenly`]). Where there is no edge, the outline is carried across.
//!
//! **Not here:** a bone whose shell is open over more than `leak_mm`, or that touches something as dark as its shell over
//! a long way (a tendon, a meniscus): there the outline may be off by up to the shell's thickness.

use std::borrow::Cow;
use std::collections::VecDeque;

use biplane_artifact::{SlicePoint, Volume};
use biplane_stage::Context;

use crate::blur::gaussian;
use crate::distance::{Within, to_set};
use crate::levels::{Shares, Slice, normals, shares};
use crate::marching::{self, Saddles};
use crate::ring::{self, Plane};
use crate::shell::{Known, Profile, outside};
use crate::stack::Stack;
use crate::stage::{Contrast, Found, SeedPlace, SlicesParams};
use crate::{SlicesError, evenly, grow};

/// Smoothing of the levels that voxels are sorted by, pixels.
const SORTING_PX: f64 = 0.6;
/// Less marrow than this is none, mm^3.
const LEAST_MARROW_MM3: f64 = 100.0;
/// More of the volume than this is no marrow.
const MOST_MARROW: f64 = 0.5;
/// A shell has to be darker than marrow and than what is outside by this share of the marrow's level.
const LEAST_CONTRAST: f64 = 0.1;
/// A voxel is dark from this share of the shell's contrast on: of a shell thinner than a slice that leans there is no more.
const DARK: f64 = 0.25;
/// The shell is nowhere thicker than this times what it is on the whole around there.
const END: f64 = 1.5;
/// Part of a slice's thickness over which marrow may fade before the shell is dark.
const SPREAD: f64 = 1.0;
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

    let job = Job {
        stack: &stack,
        samples: &samples,
        levels: &levels,
        bone: &bone,
        shares,
        noise,
        shell_mm: params.shell_mm,
    };
    let off = job.off_outline();
    let mut slices = vec![Found::default(); whole.size[2]];
    for k in 0..stack.size[2] {
        stop_if(context)?;
        slices[low[2] + k] = job.slice(k, &off, [low[0] as f64, low[1] as f64]);
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

/// What is needed to place the contours of a slice.
struct Job<'a> {
    stack: &'a Stack,
    samples: &'a [f32],
    levels: &'a [f32],
    bone: &'a [bool],
    shares: &'a Shares,
    noise: f64,
    shell_mm: f64,
}

impl Job<'_> {
    /// Distance of each voxel from the bone's outline in its slice, positive outside, mm, a little smoothed.
    fn off_outline(&self) -> Vec<f32> {
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
        gaussian(&flat, &field, [SORTING_PX * dx, SORTING_PX * dy, 0.0])
    }

    /// Contours of slice `k` of the part, in pixels of the whole.
    fn slice(&self, k: usize, off: &[f32], offset: Plane) -> Found {
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
