//! Recognises a plate: which of its holes or dots each spot of a picture is, without a person's help or with it.
//!
//! A first guess of a few neighbouring spots (`seed.rs`) grows outwards (`grow.rs`) and is then held against the other ways in which
//! the pattern could lie there (`identity.rs`). Any turn, shift and scale is found, plates seen from the back too; holes may be
//! missing, and false spots lie between them. **Guaranteed:** the same spots give the same names. **Not guaranteed:** which of several equal
//! holes is which where the pattern looks like itself: the warning says so, and the map of distortion does not depend on it.

mod grow;
mod identity;
mod seed;
mod seen;

use biplane_artifact::{PlateClick, PlateClicks, PlatePattern, Spots};
use biplane_geometry::Point2;

use crate::pattern::{Layout, PatternError, Site};
use grow::{Names, grow};
use identity::identify;
use seen::Seen;

/// Spots at which guesses are made before giving up.
const ANCHORS: usize = 12;

/// Guesses of each that grow.
const GUESSES: usize = 6;

/// No further guess is made once this share of the whole spots has names.
const ENOUGH: f64 = 0.85;

/// Largest usual distance of a spot from where its neighbours say, part of the spacing. Spots of a plate have some hundredths, spots
/// at random 0.1 to 0.2 if they have names at all.
const LIKE_A_PLATE: f64 = 0.06;

/// Why the plate was not recognised.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecogniseError {
    /// The pattern is none.
    #[error(transparent)]
    Pattern(#[from] PatternError),
    /// A spot at no place.
    #[error("spot {spot} of the picture (counted from 0) is at {at_px:?} px: expected finite numbers")]
    Spot {
        /// Its number.
        spot: usize,
        /// Where it is said to be, px.
        at_px: [f64; 2],
    },
    /// A click where there is no spot.
    #[error(
        "click {click} of the plate is at ({:.1}, {:.1}) px, but the nearest spot of the picture is {distance_px:.1} px off, at ({:.1}, \
         {:.1}) px: click on a hole, within {limit_px:.1} px of its centre", at_px[0], at_px[1], spot_px[0], spot_px[1]
    )]
    ClickOffSpots {
        /// Its number, from 1.
        click: usize,
        /// Where it is, recorded px.
        at_px: [f64; 2],
        /// The nearest spot, recorded px.
        spot_px: [f64; 2],
        /// How far that is, px.
        distance_px: f64,
        /// How far it may be, px.
        limit_px: f64,
    },
    /// A click of a hole that the plate does not have.
    #[error(
        "click {click} says ({}, {}) mm on the plate, but the nearest hole of its pattern is {distance_mm:.2} mm off, at ({:.3}, \
         {:.3}) mm: give the coordinates of the plate's list", plate_mm[0], plate_mm[1], hole_mm[0], hole_mm[1]
    )]
    ClickOffPlate {
        /// Its number, from 1.
        click: usize,
        /// What it says, mm.
        plate_mm: [f64; 2],
        /// The nearest hole, mm.
        hole_mm: [f64; 2],
        /// How far that is, mm.
        distance_mm: f64,
    },
    /// Clicks that cannot all be true.
    #[error(
        "click {click} says that the spot at ({:.1}, {:.1}) px is the hole at ({}, {}) mm, but by the other clicks and the pattern it is \
         {}: correct the one that is wrong", at_px[0], at_px[1], plate_mm[0], plate_mm[1],
        found_mm.map_or_else(|| "no hole of the plate".to_owned(), |m| format!("the one at ({:.3}, {:.3}) mm", m[0], m[1]))
    )]
    Contradictory {
        /// The number of the click that does not fit, from 1.
        click: usize,
        /// Where it is, recorded px.
        at_px: [f64; 2],
        /// What it says, mm.
        plate_mm: [f64; 2],
        /// What the others say, mm.
        found_mm: Option<[f64; 2]>,
    },
    /// The spots do not lie as the pattern says.
    #[error(
        "the spots lie on no plate of this pattern: at best {named} of {spots} whole spots fit it, at least {needed} should \
         (min_matched_share in [distortion]); check that this is the picture of this plate, its pitch or list, and [spots]; or \
         give the first correspondences in a file"
    )]
    NoPlate {
        /// Spots that fit.
        named: usize,
        /// Whole spots of the picture.
        spots: usize,
        /// How many should.
        needed: usize,
    },
}

/// A spot with its hole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Named {
    /// Number of the spot in the picture.
    pub(crate) spot: usize,
    /// Its place on the plate, mm.
    pub(crate) plate_mm: Point2,
    /// Distance of the nearest other hole, mm.
    pub(crate) spacing_mm: f64,
}

/// What was recognised.
#[derive(Debug, Clone)]
pub(crate) struct Recognised {
    /// In the order of the picture's spots.
    pub(crate) named: Vec<Named>,
    /// In how many ways the pattern could lie on the spots as well, the one chosen counted.
    pub(crate) ways: usize,
}

/// Recognises a plate's spots. At least the share `least` of the whole spots must belong to it.
///
/// # Errors
/// See [`RecogniseError`].
pub(crate) fn recognise(
    spots: &Spots,
    pattern: &PlatePattern,
    clicks: Option<&PlateClicks>,
    least: f64,
) -> Result<(Recognised, Layout), RecogniseError> {
    let layout = Layout::new(pattern)?;
    let no_place = |at: &[f64; 2]| at.iter().any(|v| !(-1e6..=1e6).contains(v));
    if let Some((spot, s)) = spots.spots.iter().enumerate().find(|(_, s)| no_place(&s.at_px)) {
        return Err(RecogniseError::Spot { spot, at_px: s.at_px });
    }
    let seen = Seen::new(spots);
    let clicks = clicks.map_or(&[][..], |c| &c.0);
    let known: Vec<(usize, Site)> = clicks
        .iter()
        .enumerate()
        .map(|(i, click)| known_site(&seen, &layout, i + 1, click))
        .collect::<Result<_, _>>()?;

    let names = best_names(&seen, &layout, &known);
    let count = |names: &Names| names.named().filter(|(spot, _)| seen.whole[*spot]).count();
    let (whole, named) = (seen.whole_count(), names.as_ref().map_or(0, count));
    let needed = ((whole as f64 * least).ceil() as usize).max(3);
    let Some(names) = names.filter(|n| named >= needed && n.usual_deviation(&seen) <= LIKE_A_PLATE) else {
        return Err(RecogniseError::NoPlate { named, spots: whole, needed });
    };

    let identified = identify(&seen, &layout, names, &known);
    if let Some(&i) = identified.unmet.first() {
        let PlateClick { plate_mm, at_px } = clicks[i];
        let found_mm = identified.names.site[known[i].0].map(|s| s.at.coords.into());
        return Err(RecogniseError::Contradictory { click: i + 1, at_px, plate_mm, found_mm });
    }
    let named = identified.names.named();
    let named = named.map(|(spot, s)| Named { spot, plate_mm: s.at, spacing_mm: s.spacing }).collect();
    Ok((Recognised { named, ways: identified.ways }, layout))
}

/// The spot and the site of a person's click.
fn known_site(
    seen: &Seen,
    layout: &Layout,
    click: usize,
    at: &PlateClick,
) -> Result<(usize, Site), RecogniseError> {
    let place = Point2::from(at.at_px);
    let distance = |i: &usize| (seen.at[*i] - place).norm();
    let nearest = (0..seen.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let to_next = |i: usize| seen.around[i].first().map_or(f64::MAX, |(_, d)| *d);
    match nearest.map(|i| (i, distance(&i), to_next(i) / 2.0)) {
        Some((spot, off, limit)) if off <= limit => {
            let wanted = Point2::from(at.plate_mm);
            let off_mm = |s: &Site| (s.at - wanted).norm();
            match layout.nearest(&wanted) {
                Some(site) if off_mm(&site) <= 0.1 * site.spacing => Ok((spot, site)),
                site => Err(RecogniseError::ClickOffPlate {
                    click,
                    plate_mm: at.plate_mm,
                    hole_mm: site.map_or([f64::NAN; 2], |s| s.at.coords.into()),
                    distance_mm: site.map_or(f64::NAN, |s| off_mm(&s)),
                }),
            }
        }
        found => Err(RecogniseError::ClickOffSpots {
            click,
            at_px: at.at_px,
            spot_px: found.map_or([f64::NAN; 2], |(i, ..)| seen.at[i].coords.into()),
            distance_px: found.map_or(f64::INFINITY, |(_, off, _)| off),
            limit_px: found.map_or(0.0, |(.., limit)| limit),
        }),
    }
}

/// The names that explain most spots, of all guesses that are made.
fn best_names(seen: &Seen, layout: &Layout, known: &[(usize, Site)]) -> Option<Names> {
    let enough = ENOUGH * seen.whole_count() as f64;
    let mut best: Option<(usize, f64, Names)> = None;
    let mut consider = |seeds: Vec<seed::Seed>| {
        for seed in seeds {
            let names = grow(seen, layout, &seed);
            let (count, deviation) = (names.count(), names.usual_deviation(seen));
            let better = best.as_ref().is_none_or(|(most, least, _)| {
                let like = |d: f64| d <= LIKE_A_PLATE;
                (like(deviation), count) > (like(*least), *most)
            });
            if better {
                best = Some((count, deviation, names));
            }
            if count as f64 >= enough && deviation <= LIKE_A_PLATE {
                return true;
            }
        }
        false
    };
    let mut found = consider(seed::of_pairs(seen, layout, known, GUESSES));
    for (spot, site) in known {
        found = found || consider(seed::seeds(seen, layout, *spot, &[*site], GUESSES));
    }
    let sites = layout.representatives();
    for anchor in seen.anchors(ANCHORS) {
        found = found || consider(seed::seeds(seen, layout, anchor, &sites, GUESSES));
    }
    best.map(|(.., names)| names)
}
