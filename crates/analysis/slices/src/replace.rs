//! A person's contours of a slice in the place of the automatic ones.

use biplane_artifact::{SliceContour, SliceContours, SlicePoint};

use crate::ring::{self, Plane};

/// Why drawn contours cannot stand for a slice.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReplaceError {
    /// There is no such slice.
    #[error("slice {slice}: the volume has the slices 0 to {last}; name the file after one of them")]
    NoSuchSlice {
        /// As asked for.
        slice: usize,
        /// The last one there is.
        last: usize,
    },
    /// A contour without an inside.
    #[error(
        "slice {slice}, contour {contour}: its {points} points enclose {area} px^2; a contour has at least three points \
         that are finite and not on a line; redraw or delete it"
    )]
    Flat {
        /// Number of the slice.
        slice: usize,
        /// Number of the contour, from 0.
        contour: usize,
        /// How many points it has.
        points: usize,
        /// What they enclose.
        area: f64,
    },
}

/// Least area of a contour, px^2.
const LEAST_PX2: f64 = 1e-3;

/// Puts drawn contours, px, in the place of all those of one slice; none says that the bone is not in that slice. Which way
/// they were drawn does not matter: a contour inside an odd number of others is a hole. `sigma_mm` is the standard deviation
/// of a drawn point. The slice's flags go: a person has looked.
///
/// # Errors
/// A slice that is not there, or a contour without an inside; nothing is changed then.
pub fn replace(
    contours: &mut SliceContours,
    slice: usize,
    drawn: &[Vec<[f64; 2]>],
    sigma_mm: f64,
) -> Result<(), ReplaceError> {
    let last = contours.slices.len().saturating_sub(1);
    let target = contours.slices.get_mut(slice).ok_or(ReplaceError::NoSuchSlice { slice, last })?;
    for (contour, ring) in drawn.iter().enumerate() {
        let area = ring::signed_area(ring);
        if ring.len() < 3 || !area.is_finite() || area.abs() < LEAST_PX2 {
            return Err(ReplaceError::Flat { slice, contour, points: ring.len(), area });
        }
    }
    target.contours = drawn
        .iter()
        .enumerate()
        .map(|(n, ring)| {
            let around = |other: &(usize, &Vec<Plane>)| other.0 != n && ring::winding(other.1, ring[0]) != 0;
            let hole = drawn.iter().enumerate().filter(around).count() % 2 == 1;
            let mut points: Vec<SlicePoint> =
                ring.iter().map(|p| SlicePoint::rounded(p[0], p[1], sigma_mm)).collect();
            if hole == (ring::signed_area(ring) > 0.0) {
                points.reverse();
            }
            SliceContour { points }
        })
        .collect();
    target.flags.clear();
    target.edited = true;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_artifact::{ContourSlice, SliceFlag};

    fn square(low: f64, high: f64) -> Vec<Plane> {
        vec![[low, low], [high, low], [high, high], [low, high]]
    }

    fn sample() -> SliceContours {
        let slice = ContourSlice {
            origin_mm: [0.0; 3],
            contours: Vec::new(),
            flags: vec![SliceFlag::Lost],
            edited: false,
        };
        SliceContours {
            columns: 20,
            rows: 20,
            column_step_mm: [1.0, 0.0, 0.0],
            row_step_mm: [0.0, 1.0, 0.0],
            slices: vec![slice.clone(), slice],
            warnings: Vec::new(),
        }
    }

    #[test]
    fn a_drawn_slice_stands_for_the_automatic_one_whichever_way_it_was_drawn() {
        let mut contours = sample();
        let mut backward = square(1.0, 9.0);
        backward.reverse();
        replace(&mut contours, 1, &[backward, square(3.0, 5.0), square(12.0, 14.0)], 0.2).unwrap();
        let slice = &contours.slices[1];
        let areas: Vec<f64> = slice.contours.iter().map(SliceContour::area_px2).collect();
        assert_eq!(areas, [64.0, -4.0, 4.0]);
        assert!(slice.edited && slice.flags.is_empty() && slice.contours[0].points[0].sigma_mm == 0.2);
        assert_eq!(contours.slices[0], sample().slices[0]);
    }

    #[test]
    fn what_cannot_stand_is_refused_and_changes_nothing() {
        let mut contours = sample();
        let flat = vec![[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]];
        let nan = vec![[f64::NAN, 1.0], [2.0, 2.0], [3.0, 1.0]];
        for bad in [flat, nan, Vec::new()] {
            assert!(matches!(
                replace(&mut contours, 0, &[square(1.0, 4.0), bad], 0.2),
                Err(ReplaceError::Flat { slice: 0, contour: 1, .. })
            ));
        }
        let none = replace(&mut contours, 2, &[], 0.2);
        assert_eq!(none, Err(ReplaceError::NoSuchSlice { slice: 2, last: 1 }));
        assert_eq!(contours, sample());
    }
}
