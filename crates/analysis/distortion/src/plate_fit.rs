//! From spots and pattern to the map of distortion and all that is said of it: recognise, choose ideal pixels, fit, judge.

use biplane_artifact::{MatchedSpot, PlateClicks, PlateFit, PlatePattern, Spots, Verdict};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Vector2};

use crate::affine::Affine;
use crate::coverage::{covered_share, in_picture};
use crate::gauge::ideal_from_plate;
use crate::model::{Fitted, fit};
use crate::pattern::Layout;
use crate::recognise::{Named, Recognised, recognise};
use crate::stage::{DistortionError, DistortionParams};
use crate::tilt::tilt;

/// Anisotropy is called a fault where it is that of a tilt so many times `max_tilt_deg`: it shows small tilts badly.
const TILTS_OF_ANISOTROPY: f64 = 5.0;

/// The tilt is judged where at least this share of the picture is covered.
const COVERED_FOR_TILT: f64 = 0.3;

/// Share of the spots left out of the fit from which it is worth a look.
const MANY_LEFT_OUT: f64 = 0.05;

/// Most columns or rows of a picture: the table of the map grows with them.
const MOST_PIXELS: usize = 16_384;

/// Most holes of an endless pattern that are looked for in a picture.
const MOST_HOLES: usize = 1_000_000;

/// The distortion that a plate's picture shows.
///
/// # Errors
/// See [`DistortionError`].
pub fn fit_plate(
    spots: &Spots,
    pattern: &PlatePattern,
    clicks: Option<&PlateClicks>,
    params: &DistortionParams,
) -> Result<PlateFit, DistortionError> {
    params.check()?;
    if !spots.size.iter().all(|n| (1..=MOST_PIXELS).contains(n)) {
        return Err(DistortionError::Size { size: spots.size, most: MOST_PIXELS });
    }
    let (recognised, layout) = recognise(spots, pattern, clicks, params.min_matched_share)?;
    let recorded = |n: &Named| Point2::from(spots.spots[n.spot].at_px);
    let is_whole = |n: &&Named| !spots.spots[n.spot].cut;

    let whole: Vec<&Named> = recognised.named.iter().filter(is_whole).collect();
    let from: Vec<Point2> = whole.iter().map(|n| recorded(n)).collect();
    let plate: Vec<Point2> = whole.iter().map(|n| n.plate_mm).collect();
    let line = DistortionError::Line { spots: whole.len() };
    let to_ideal = ideal_from_plate(&from, &plate, spots.size, params.pixel_mm).ok_or(line.clone())?;
    let to_plate = to_ideal.inverse().ok_or(line)?;
    let to: Vec<Point2> = plate.iter().map(|p| to_ideal.apply(p)).collect();
    let fitted = fit(&from, &to, params)?;
    let sampled = fitted.table(spots.size);

    let mut of_whole = fitted.held_out_px.iter().zip(&fitted.used);
    let matched: Vec<MatchedSpot> = recognised
        .named
        .iter()
        .map(|n| {
            let at = recorded(n);
            let off = || fitted.ideal(&at) - to_ideal.apply(&n.plate_mm);
            let fit = if is_whole(&n) { of_whole.next() } else { None };
            let (residual, used) = fit.map_or_else(|| (off(), false), |(r, used)| (*r, *used));
            let plate_mm = n.plate_mm.coords.into();
            MatchedSpot { at_px: at.coords.into(), plate_mm, residual_px: residual.into(), used }
        })
        .collect();
    let moved = || from.iter().zip(&to).zip(&fitted.used).filter(|(_, used)| **used).map(|((p, q), _)| p - q);
    let before = moved().map(|d: Vector2| d.norm_squared()).sum::<f64>() / moved().count().max(1) as f64;

    let mut has_name = vec![false; spots.spots.len()];
    recognised.named.iter().for_each(|n| has_name[n.spot] = true);
    let strays = spots.spots.iter().zip(&has_name).filter(|(s, named)| !**named && !s.cut);
    let linear = to_plate.linear;
    let offset = to_plate.apply(&Point2::origin());
    let mut plate_fit = PlateFit {
        size: spots.size,
        pixel_mm: to_plate.scale(),
        plate_from_ideal: [0, 1].map(|i| [linear[(i, 0)], linear[(i, 1)], offset[i]]),
        mirrored: to_plate.mirrors(),
        model: fitted.model.clone(),
        models: fitted.scores.clone(),
        strays_px: strays.map(|(s, _)| s.at_px).collect(),
        missing_px: missing(spots, &recognised, &layout, &to_ideal, &fitted, &(&sampled.table).into()),
        border: spots.border,
        before_rms_px: before.sqrt(),
        round_trip_px: sampled.round_trip_px,
        verdict: Verdict::Good,
        warnings: Vec::new(),
        table: sampled.table,
        matched,
    };
    judge(&mut plate_fit, &recognised, pattern, &fitted, [&from, &to], params);
    Ok(plate_fit)
}

/// Holes that should be among the spots, and are not: about where, recorded px.
fn missing(
    spots: &Spots,
    recognised: &Recognised,
    layout: &Layout,
    to_ideal: &Affine,
    fitted: &Fitted,
    table: &Distortion,
) -> Vec<[f64; 2]> {
    let middle = Point2::from(spots.size.map(|n| (n as f64 - 1.0) / 2.0));
    let Some(to_plate) = to_ideal.inverse() else { return Vec::new() };
    let reach = spots.size.map(|n| n as f64).iter().sum::<f64>() * to_plate.scale();
    let sites = layout.within(&to_plate.apply(&middle), reach, MOST_HOLES).unwrap_or_default();
    let mut found: Vec<[u64; 2]> =
        recognised.named.iter().map(|n| [n.plate_mm.x.to_bits(), n.plate_mm.y.to_bits()]).collect();
    found.sort_unstable();
    let mut radii: Vec<f64> = recognised.named.iter().map(|n| spots.spots[n.spot].radius_px).collect();
    radii.sort_by(f64::total_cmp);
    // A hole that the border cuts cannot be missed.
    let inside_px = radii.get(radii.len() / 2).map_or(1.0, |r| r + 1.0);
    let mut missing: Vec<[f64; 2]> = sites
        .iter()
        .filter(|s| found.binary_search(&[s.at.x.to_bits(), s.at.y.to_bits()]).is_err())
        .filter_map(|s| table.recorded(&to_ideal.apply(&s.at)))
        .filter(|p| in_picture(p, spots.size, spots.border.as_ref(), inside_px) && fitted.reach.holds(p))
        .map(|p| p.coords.into())
        .collect();
    missing.sort_by(|a, b| a[1].total_cmp(&b[1]).then(a[0].total_cmp(&b[0])));
    missing
}

/// Fills in the verdict and the warnings.
fn judge(
    fit: &mut PlateFit,
    recognised: &Recognised,
    pattern: &PlatePattern,
    fitted: &Fitted,
    [from, to]: [&[Point2]; 2],
    params: &DistortionParams,
) {
    let mut faults: Vec<String> = Vec::new();
    if let Some(score) =
        fitted.score().filter(|s| !(0.0..=params.max_held_out_px).contains(&s.held_out_rms_px))
    {
        faults.push(format!(
            "held-out residual {:.3} px rms of {}, more than max_held_out_px = {}: look at the residuals; another model or \
             degree may do better",
            score.held_out_rms_px, fit.model, params.max_held_out_px
        ));
    }
    let share = |part: usize, rest: usize| part as f64 / (part + rest).max(1) as f64;
    let (named, strays, missing) = (fit.matched.len(), fit.strays_px.len(), fit.missing_px.len());
    if share(strays, named) > params.max_stray_share {
        faults.push(format!(
            "{strays} of {} spots belong to no hole of the plate, more than max_stray_share = {}: look at [spots], and at the plate's \
             list",
            strays + named,
            params.max_stray_share
        ));
    }
    if share(missing, named) > params.max_missing_share {
        faults.push(format!(
            "{missing} of {} holes among those found were not found, more than max_missing_share = {}: look at [spots], and at the \
             plate's list",
            missing + named,
            params.max_missing_share
        ));
    }
    let keep = |all: &[Point2]| -> Vec<Point2> {
        all.iter().zip(&fitted.used).filter(|(_, used)| **used).map(|(p, _)| *p).collect()
    };
    let (from, to) = (keep(from), keep(to));
    let covered = covered_share(&from, fit.size, fit.border.as_ref());
    if covered < params.min_covered_share {
        faults.push(format!(
            "holes cover {:.0} % of the picture, less than min_covered_share = {}: elsewhere the map is a continuation; use a plate that \
             fills the view",
            covered * 100.0,
            params.min_covered_share
        ));
    }
    let source_px = params.source_distance_mm / fit.pixel_mm;
    let tilt = tilt(&to, &from, fit.size, source_px).filter(|_| covered >= COVERED_FOR_TILT);
    if let Some(tilt) = tilt {
        let worst = (params.max_tilt_deg * TILTS_OF_ANISOTROPY).min(89.0).to_radians();
        if tilt.by_perspective_deg > params.max_tilt_deg || tilt.anisotropy > 1.0 / worst.cos() - 1.0 {
            faults.push(format!(
                "the plate seems tilted by {:.1} degrees (by its perspective, with the source {} mm away; its scale in the middle \
                 differs by {:.2} % between directions), more than max_tilt_deg = {}: clip the plate onto the intensifier",
                tilt.by_perspective_deg,
                params.source_distance_mm,
                tilt.anisotropy * 100.0,
                params.max_tilt_deg
            ));
        }
    }
    if !faults.is_empty() {
        fit.verdict = Verdict::Doubtful;
    }
    let left_out = fitted.used.iter().filter(|used| !**used).count();
    if left_out as f64 > MANY_LEFT_OUT * fitted.used.len() as f64 {
        faults.push(format!(
            "{left_out} of {} holes lie farther than {} times the usual off the map, and were left out",
            fitted.used.len(),
            params.reject_sigmas
        ));
    }
    // Mirror images alone are the rule: a plate with two marks has one.
    if matches!(pattern, PlatePattern::List(_)) && recognised.ways > 2 {
        faults.push(format!(
            "the plate's list fits the spots in {} ways: the one that is turned least was taken; which hole is which is thus not known, \
             which does not matter to the distortion",
            recognised.ways
        ));
    }
    fit.warnings = faults;
}
