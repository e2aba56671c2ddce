//! A plate's pattern as recognition sees it: sites with numbers, their neighbours and their spacing.

use biplane_artifact::PlatePattern;
use biplane_geometry::Point2;

use crate::lattice::Lattice;
use crate::nearby::Nearby;

/// The number of a site: `[number of the hole, 0]` in a list, `[column, row]` in a lattice.
pub(crate) type SiteNumber = [i64; 2];

/// A place of the plate where a hole or dot is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Site {
    pub(crate) number: SiteNumber,
    /// On the plate, mm.
    pub(crate) at: Point2,
    /// Distance of the nearest other site, mm.
    pub(crate) spacing: f64,
}

/// Why a pattern is none.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PatternError {
    /// A pitch that is no distance of holes.
    #[error(
        "the plate's pitch is {pitch_mm} mm: expected a length of 1e-3 to 1e6 mm; correct it in pipeline.toml"
    )]
    Pitch {
        /// As given, mm.
        pitch_mm: f64,
    },
    /// Too few holes to recognise.
    #[error("the plate's list has {found} spots: at least 3 are needed")]
    TooFew {
        /// How many.
        found: usize,
    },
    /// A hole at no place.
    #[error(
        "spot {spot} of the plate's list (counted from 0) is at {at_mm:?} mm: expected numbers within 1e6 mm"
    )]
    Place {
        /// Its number.
        spot: usize,
        /// Where it is said to be, mm.
        at_mm: [f64; 2],
    },
    /// Two holes at one place.
    #[error("spots {} and {} of the plate's list (counted from 0) are at the same place {at_mm:?} mm: remove one", spots[0], spots[1])]
    Same {
        /// Their numbers.
        spots: [usize; 2],
        /// Where they are, mm.
        at_mm: [f64; 2],
    },
}

/// A pattern that can be searched.
#[derive(Debug, Clone)]
pub(crate) enum Layout {
    /// Spots one by one.
    List {
        nearby: Nearby,
        /// Distance of the nearest other one, mm.
        spacing: Vec<f64>,
        /// mm.
        radius: Vec<Option<f64>>,
    },
    /// A lattice without end.
    Lattice(Lattice),
}

impl Layout {
    /// # Errors
    /// See [`PatternError`].
    pub(crate) fn new(pattern: &PlatePattern) -> Result<Self, PatternError> {
        let lattice = |pitch_mm: f64, make: fn(f64) -> Lattice| {
            if (1e-3..=1e6).contains(&pitch_mm) {
                Ok(Self::Lattice(make(pitch_mm)))
            } else {
                Err(PatternError::Pitch { pitch_mm })
            }
        };
        match pattern {
            PlatePattern::Square { pitch_mm } => lattice(*pitch_mm, Lattice::square),
            PlatePattern::Hexagonal { pitch_mm } => lattice(*pitch_mm, Lattice::hexagonal),
            PlatePattern::List(spots) => {
                if spots.len() < 3 {
                    return Err(PatternError::TooFew { found: spots.len() });
                }
                let no_place = |at: &[f64; 2]| at.iter().any(|v| !(-1e6..=1e6).contains(v));
                if let Some((spot, s)) = spots.iter().enumerate().find(|(_, s)| no_place(&s.at_mm)) {
                    return Err(PatternError::Place { spot, at_mm: s.at_mm });
                }
                let nearby = Nearby::new(spots.iter().map(|s| Point2::from(s.at_mm)).collect());
                let mut spacing = Vec::with_capacity(spots.len());
                for (i, s) in spots.iter().enumerate() {
                    let two = nearby.closest(&Point2::from(s.at_mm), 2);
                    let (other, distance) =
                        two.into_iter().find(|(other, _)| *other != i).unwrap_or((i, f64::MAX));
                    if distance < 1e-6 {
                        return Err(PatternError::Same { spots: [i, other], at_mm: s.at_mm });
                    }
                    spacing.push(distance);
                }
                Ok(Self::List { nearby, spacing, radius: spots.iter().map(|s| s.radius_mm).collect() })
            }
        }
    }

    fn site(&self, number: SiteNumber) -> Site {
        match self {
            Self::List { nearby, spacing, .. } => {
                let i = number[0] as usize;
                Site { number, at: nearby.points()[i], spacing: spacing[i] }
            }
            Self::Lattice(lattice) => Site { number, at: lattice.at(number), spacing: lattice.pitch_mm() },
        }
    }

    /// The site nearest to a place; `None` for a place that is none.
    pub(crate) fn nearest(&self, place: &Point2) -> Option<Site> {
        if place.iter().any(|v| !v.is_finite()) {
            return None;
        }
        match self {
            Self::List { nearby, .. } => nearby.nearest(place).map(|(i, _)| self.site([i as i64, 0])),
            Self::Lattice(lattice) => Some(self.site(lattice.nearest(place))),
        }
    }

    /// All sites within `reach` mm of a place, or `None` if they are more than `most`.
    pub(crate) fn within(&self, place: &Point2, reach: f64, most: usize) -> Option<Vec<Site>> {
        let numbers = match self {
            Self::List { nearby, .. } => {
                nearby.within(place, reach).into_iter().map(|(i, _)| [i as i64, 0]).collect()
            }
            Self::Lattice(lattice) => lattice.within(place, reach, most)?,
        };
        (numbers.len() <= most).then(|| numbers.into_iter().map(|n| self.site(n)).collect())
    }

    /// Neighbours of a site: those not much farther off than the nearest one.
    pub(crate) fn neighbours(&self, site: &Site) -> Vec<Site> {
        let mut found = self.within(&site.at, site.spacing * 1.6, usize::MAX / 4).unwrap_or_default();
        found.retain(|other| other.number != site.number);
        found
    }

    /// Sites of which one is like any site of the plate: all of a list; in a lattice all are alike.
    pub(crate) fn representatives(&self) -> Vec<Site> {
        match self {
            Self::List { nearby, .. } => {
                (0..nearby.points().len()).map(|i| self.site([i as i64, 0])).collect()
            }
            Self::Lattice(_) => vec![self.site([0, 0])],
        }
    }

    /// Marks: holes larger than `large` times the median, with their radius over it. None where no radii are known.
    pub(crate) fn marks(&self, large: f64) -> Vec<(SiteNumber, f64)> {
        let Self::List { radius, .. } = self else { return Vec::new() };
        let mut known: Vec<f64> = radius.iter().flatten().copied().collect();
        known.sort_by(f64::total_cmp);
        let Some(median) = known.get(known.len() / 2).filter(|m| **m > 0.0) else { return Vec::new() };
        let relative = radius.iter().enumerate().filter_map(|(i, r)| Some(([i as i64, 0], (*r)? / median)));
        relative.filter(|(_, r)| *r > large).collect()
    }

    /// Middle of the plate: of a list its mean; of a lattice any site.
    pub(crate) fn middle(&self) -> Point2 {
        match self {
            Self::List { nearby, .. } => {
                let sum = nearby.points().iter().fold(Point2::origin().coords, |s, p| s + p.coords);
                Point2::from(sum / nearby.points().len() as f64)
            }
            Self::Lattice(_) => Point2::origin(),
        }
    }
}
