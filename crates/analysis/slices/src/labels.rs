//! The boundary of a label at a fraction of a voxel.
//!
//! A map of labels says of each voxel's centre whether it is inside; so much the contours keep: on every line between
//! neighbouring centres of which one is inside, the contour passes between them (the condition of constrained surface
//! nets: Gibson 1998). Within that freedom they are smooth: the label's indicator, smoothed by a Gaussian of one size in mm
//! in all directions, is passed at one half. What would vanish in that, a part about one voxel thin, is smoothed less.
//!
//! **Not here:** doubt of whoever drew the labels. A boundary drawn a voxel off is a voxel off.

use std::collections::BTreeSet;

use biplane_artifact::{SlicePoint, Volume};
use biplane_stage::Context;

use crate::SlicesError;
use crate::blur::gaussian;
use crate::marching::{self, Saddles};
use crate::ring::Plane;
use crate::stack::Stack;
use crate::stage::Found;

/// Size of the Gaussian where a part is thin, pixels.
const THIN_PX: f64 = 0.5;
/// By how much a voxel's centre may be smoothed beyond one half before it counts as thin: of a smooth boundary it is not.
const THIN: f32 = 0.06;
/// How near to one half a centre may come, so that contours do not touch themselves there.
const MARGIN: f32 = 0.02;
/// Standard deviation of the contour for a smooth body, in shares of a pixel: measured on balls and bones, see the tests.
const SIGMA_PX: f64 = 0.12;

/// Most labels that an error names.
const MOST_NAMED: usize = 20;

/// `smoothing_px` is the Gaussian's standard deviation in pixels of the slice, their geometric mean.
///
/// # Errors
/// No voxel has the label, or the run was cancelled.
pub(crate) fn contours(
    volume: &Volume,
    stack: &Stack,
    label: u32,
    smoothing_px: f64,
    context: &Context,
) -> Result<Vec<Found>, SlicesError> {
    let wanted = label as f32;
    let pixel = (stack.pixel_mm[0] * stack.pixel_mm[1]).sqrt();
    let sigma = smoothing_px * pixel;
    let Some((low, high)) = stack.bounds(|v| volume.samples[v] == wanted, 4.0 * sigma.max(pixel)) else {
        return Err(SlicesError::NoLabel { label, present: present(volume) });
    };
    let part = stack.part(low, high);
    let inside: Vec<f32> = stack
        .cut(&volume.samples, low, high)
        .into_iter()
        .map(|s| if s == wanted { 1.0 } else { 0.0 })
        .collect();
    let field = constrained(&part, &inside, sigma, THIN_PX * pixel);
    let mut slices = vec![Found::default(); stack.size[2]];
    for k in 0..part.size[2] {
        if context.cancelled() {
            return Err(SlicesError::Cancelled);
        }
        let slice = &field[k * part.slice_voxels()..(k + 1) * part.slice_voxels()];
        let point =
            |p: &Plane| SlicePoint::rounded(p[0] + low[0] as f64, p[1] + low[1] as f64, SIGMA_PX * pixel);
        let found = marching::contours(slice, part.size[0], 0.5, 0.0, Saddles::Joined);
        slices[low[2] + k].rings = found.iter().map(|c| c.iter().map(point).collect()).collect();
    }
    Ok(slices)
}

/// The labels that there are, as a person reads them.
fn present(volume: &Volume) -> String {
    let whole = |s: &&f32| (1.0..=65535.0).contains(*s) && s.fract() == 0.0;
    let labels: BTreeSet<u16> = volume.samples.iter().filter(whole).map(|&s| s as u16).collect();
    if labels.is_empty() {
        return "none above 0".to_owned();
    }
    let mut named: Vec<String> = labels.iter().take(MOST_NAMED).map(u16::to_string).collect();
    if labels.len() > MOST_NAMED {
        named.push(format!("and {} more (is it a map of labels?)", labels.len() - MOST_NAMED));
    }
    named.join(", ")
}

/// A field that is above one half where `inside` is 1, below where it is 0, and smooth.
fn constrained(stack: &Stack, inside: &[f32], sigma: f64, thin_sigma: f64) -> Vec<f32> {
    let smooth = gaussian(stack, inside, [sigma; 3]);
    // How far a centre is on the wrong side of one half.
    let wrong = |s: f32, i: f32| (0.5 - s) * (2.0 * i - 1.0);
    let thin: Vec<f32> =
        smooth.iter().zip(inside).map(|(&s, &i)| if wrong(s, i) > THIN { 1.0 } else { 0.0 }).collect();
    let little = gaussian(stack, inside, [thin_sigma; 3]);
    let share = gaussian(stack, &thin, [sigma.max(thin_sigma); 3]);
    let mut field: Vec<f32> = smooth
        .iter()
        .zip(&little)
        .zip(&share)
        .map(|((&s, &l), &w)| s + (l - s) * (4.0 * w).min(1.0))
        .collect();
    for (f, &i) in field.iter_mut().zip(inside) {
        if wrong(*f, i) > -MARGIN {
            *f = 0.5 + MARGIN * (2.0 * i - 1.0);
        }
    }
    field
}
