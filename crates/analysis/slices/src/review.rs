//! What a person should look at: slices unlike their neighbours, lost ones, and those that the volume cuts off.

use biplane_artifact::{ContourSlice, SliceContours, SliceFlag};

use crate::ring;

/// A slice is never flagged for less than this, mm.
const LEAST_MM: f64 = 1.0;
/// nor for less than this many times what is usual in the stack.
const USUAL: f64 = 5.0;

/// Area of the bone in a slice, its centroid and the length of its contours, in mm.
struct Sizes {
    area: f64,
    centroid: [f64; 2],
    length: f64,
}

fn sizes(slice: &ContourSlice, pixel_mm: [f64; 2]) -> Option<Sizes> {
    let (mut area, mut length, mut moment) = (0.0, 0.0, [0.0; 2]);
    for contour in &slice.contours {
        let ring: Vec<[f64; 2]> =
            contour.points.iter().map(|p| [p.i * pixel_mm[0], p.j * pixel_mm[1]]).collect();
        area += ring::signed_area(&ring);
        length += ring::length(&ring);
        let m = ring::moment(&ring);
        moment = [moment[0] + m[0], moment[1] + m[1]];
    }
    (area > 0.0 && length > 0.0).then(|| Sizes { area, centroid: moment.map(|m| m / area), length })
}

/// Adds the flags that can be told from the contours alone.
pub(crate) fn flag(contours: &mut SliceContours, pixel_mm: [f64; 2], heights_mm: &[f64]) {
    let all: Vec<Option<Sizes>> = contours.slices.iter().map(|s| sizes(s, pixel_mm)).collect();
    let (Some(first), Some(last)) =
        (all.iter().position(Option::is_some), all.iter().rposition(Option::is_some))
    else {
        return;
    };
    // By how much a slice is off the line through two others: its outline as a whole, and its place, mm.
    let off_line = |k: usize, [a, b]: [usize; 2]| {
        let (here, a_sizes, b_sizes) = (all[k].as_ref()?, all.get(a)?.as_ref()?, all.get(b)?.as_ref()?);
        let t = (heights_mm[k] - heights_mm[a]) / (heights_mm[b] - heights_mm[a]);
        let on_line = |a: f64, b: f64| a + (b - a) * t;
        let length = here.length.max(a_sizes.length).max(b_sizes.length);
        let grown = (here.area - on_line(a_sizes.area, b_sizes.area)).abs() / length;
        let moved = (0..2)
            .map(|n| here.centroid[n] - on_line(a_sizes.centroid[n], b_sizes.centroid[n]))
            .fold(0.0, |sum: f64, d| sum.hypot(d));
        Some(grown.max(moved))
    };
    // Where a part of the bone begins or ends, a slice goes with those on one side; a bad one goes with none.
    let odd: Vec<Option<f64>> = (0..all.len())
        .map(|k| {
            let between = off_line(k, [k.checked_sub(1)?, k + 1])?;
            let before = k.checked_sub(2).and_then(|two| off_line(k, [two, k - 1]));
            let after = off_line(k, [k + 1, k + 2]);
            Some(before.unwrap_or(between).min(after.unwrap_or(between)).min(between))
        })
        .collect();
    let mut known: Vec<f64> = odd.iter().flatten().copied().collect();
    known.sort_by(f64::total_cmp);
    let usual = known.get(known.len() / 2).copied().unwrap_or(0.0);
    let limit = LEAST_MM.max(USUAL * usual);
    for k in 0..all.len() {
        let slice = &mut contours.slices[k];
        if odd[k].is_some_and(|o| o > limit) {
            slice.flags.push(SliceFlag::Jumped);
        }
        if (first..=last).contains(&k) && all[k].is_none() {
            slice.flags.push(SliceFlag::Lost);
        }
        let border = slice.contours.iter().flat_map(|c| &c.points).any(|p| {
            let near = |v: f64, count: usize| v < 0.25 || v > count as f64 - 1.25;
            near(p.i, contours.columns) || near(p.j, contours.rows)
        });
        if border {
            slice.flags.push(SliceFlag::TouchesBorder);
        }
        if all[k].is_some() && (k == 0 || k + 1 == all.len()) {
            slice.flags.push(SliceFlag::CutOff);
        }
        slice.flags.sort();
        slice.flags.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_artifact::{SliceContour, SlicePoint};

    /// Circles of the radii given (0: none), 1 mm apart, px of 1 mm.
    fn stack(radii: &[f64], shift: impl Fn(usize) -> f64) -> SliceContours {
        let slices = radii.iter().enumerate().map(|(k, &radius)| {
            let points = (0..64)
                .map(|n| {
                    let (sin, cos) = (f64::from(n) * std::f64::consts::TAU / 64.0).sin_cos();
                    SlicePoint::rounded(30.0 + shift(k) + radius * cos, 30.0 + radius * sin, 0.1)
                })
                .collect();
            let contours = if radius > 0.0 { vec![SliceContour { points }] } else { Vec::new() };
            ContourSlice { origin_mm: [0.0, 0.0, k as f64], contours, flags: Vec::new(), edited: false }
        });
        SliceContours {
            columns: 60,
            rows: 60,
            column_step_mm: [1.0, 0.0, 0.0],
            row_step_mm: [0.0, 1.0, 0.0],
            slices: slices.collect(),
            warnings: Vec::new(),
        }
    }

    fn flags(radii: &[f64], shift: impl Fn(usize) -> f64) -> Vec<(usize, SliceFlag)> {
        let mut contours = stack(radii, shift);
        let heights: Vec<f64> = (0..radii.len()).map(|k| k as f64).collect();
        flag(&mut contours, [1.0; 2], &heights);
        let of = |(k, s): (usize, &ContourSlice)| s.flags.iter().map(move |f| (k, *f)).collect::<Vec<_>>();
        contours.slices.iter().enumerate().flat_map(of).collect()
    }

    #[test]
    fn an_even_stack_has_no_flags_and_a_jump_has_one() {
        let even = [0.0, 8.0, 10.0, 11.0, 12.0, 12.5, 13.0, 13.2, 13.3, 13.2, 13.0, 12.0, 10.0, 0.0];
        assert_eq!(flags(&even, |k| 0.5 * k as f64), []);
        let mut fat = even;
        fat[4] = 18.0;
        assert_eq!(flags(&fat, |_| 0.0), [(4, SliceFlag::Jumped)]);
        assert_eq!(flags(&even, |k| if k == 6 { 5.0 } else { 0.0 }), [(6, SliceFlag::Jumped)]);
    }

    #[test]
    fn lost_and_cut_slices_are_named() {
        use SliceFlag::{CutOff, Lost, TouchesBorder};
        assert_eq!(flags(&[10.0, 10.0, 0.0, 10.0, 0.0], |_| 0.0), [(0, CutOff), (2, Lost)]);
        assert_eq!(flags(&[0.0, 10.0, 0.0], |_| 19.8), [(1, TouchesBorder)]);
    }
}
