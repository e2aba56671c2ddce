//! From a first guess outwards: each next spot is looked for where its neighbours that are known already say.
//!
//! The affine map of least squares through the known spots around one tells where on the plate it is. Distortion bends the plate
//! slowly, so over one spacing that is right to a small part of it. What is named is later held against its neighbours again,
//! itself left out, and forgotten if it disagrees: so wrong names at the beginning do not stay.

use std::collections::BTreeMap;

use biplane_geometry::Point2;

use crate::affine::Affine;
use crate::pattern::{Layout, Site, SiteNumber};
use crate::recognise::seed::{ON_SITE, Seed};
use crate::recognise::seen::Seen;

/// Known spots that say where one is, at most; and at least.
const SAY: usize = 12;
const LEAST_SAY: usize = 4;

/// Rounds of growing, forgetting and growing again.
const REVISIONS: usize = 6;

/// A spot is of a site if it is within this many times the usual (median) distance of spots from where their neighbours say;
const USUAL_TIMES: f64 = 8.0;

/// but never dropped within this part of the site's spacing: at the rim neighbours are on one side alone, and rows bend.
const SURE: f64 = 0.08;

/// Which site each spot is.
#[derive(Debug, Clone)]
pub(crate) struct Names {
    pub(crate) site: Vec<Option<Site>>,
}

impl Names {
    /// Spots that have one, with it.
    pub(crate) fn named(&self) -> impl Iterator<Item = (usize, &Site)> {
        self.site.iter().enumerate().filter_map(|(i, s)| Some((i, s.as_ref()?)))
    }

    /// How many spots have one.
    pub(crate) fn count(&self) -> usize {
        self.named().count()
    }

    /// Where the named spots around one say that it is, on the plate.
    pub(crate) fn expected(&self, seen: &Seen, spot: usize) -> Option<Point2> {
        let around = seen.around[spot].iter().filter_map(|(other, _)| {
            let site = self.site[*other].as_ref()?;
            Some((seen.at[*other], site.at, 1.0))
        });
        let pairs: Vec<_> = around.take(SAY).collect();
        if pairs.len() < LEAST_SAY {
            return None;
        }
        Some(Affine::best(&pairs)?.apply(&seen.at[spot]))
    }

    /// How far each named spot is from where its neighbours say, parts of its site's spacing; none where they do not say.
    pub(crate) fn deviations(&self, seen: &Seen) -> Vec<(usize, f64)> {
        let off = |(spot, site): (usize, &Site)| {
            Some((spot, (self.expected(seen, spot)? - site.at).norm() / site.spacing))
        };
        self.named().filter_map(off).collect()
    }

    /// Median of the deviations of whole spots; infinite if there are none.
    pub(crate) fn usual_deviation(&self, seen: &Seen) -> f64 {
        let mut all: Vec<f64> =
            self.deviations(seen).into_iter().filter(|(spot, _)| seen.whole[*spot]).map(|(_, d)| d).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(f64::INFINITY)
    }

    /// Names all that can be named from what is named.
    pub(crate) fn spread(&mut self, seen: &Seen, layout: &Layout) {
        let mut taken: BTreeMap<SiteNumber, usize> =
            self.named().map(|(spot, site)| (site.number, spot)).collect();
        let mut due: Vec<bool> = vec![true; seen.len()];
        loop {
            let mut found: Vec<(f64, usize, Site)> = Vec::new();
            for spot in (0..seen.len()).filter(|spot| self.site[*spot].is_none()) {
                if !std::mem::take(&mut due[spot]) {
                    continue;
                }
                let Some(expected) = self.expected(seen, spot) else { continue };
                let Some(site) = layout.nearest(&expected) else { continue };
                let off = (expected - site.at).norm() / site.spacing;
                if off <= ON_SITE && !taken.contains_key(&site.number) {
                    found.push((off, spot, site));
                }
            }
            if found.is_empty() {
                return;
            }
            found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            for (_, spot, site) in found {
                if let std::collections::btree_map::Entry::Vacant(free) = taken.entry(site.number) {
                    free.insert(spot);
                    self.site[spot] = Some(site);
                    seen.around[spot].iter().for_each(|(other, _)| due[*other] = true);
                }
            }
        }
    }

    /// Forgets names that neighbours contradict; whether there were any.
    fn revise(&mut self, seen: &Seen) -> bool {
        let limit = (USUAL_TIMES * self.usual_deviation(seen)).clamp(SURE, ON_SITE);
        let mut wrong = false;
        for (spot, off) in self.deviations(seen) {
            // The centre of a cut spot may be anywhere in it.
            if off > if seen.whole[spot] { limit } else { ON_SITE } {
                self.site[spot] = None;
                wrong = true;
            }
        }
        wrong
    }
}

/// Names the spots of a picture from a guess.
pub(crate) fn grow(seen: &Seen, layout: &Layout, seed: &Seed) -> Names {
    let mut names = Names { site: vec![None; seen.len()] };
    let mut taken: Vec<SiteNumber> = Vec::new();
    for spot in std::iter::once(seed.anchor).chain(seen.around[seed.anchor].iter().map(|(i, _)| *i)) {
        let on_plate = seed.plate_from_picture.apply(&seen.at[spot]);
        let Some(site) = layout.nearest(&on_plate) else { continue };
        if (on_plate - site.at).norm() <= ON_SITE * site.spacing && !taken.contains(&site.number) {
            taken.push(site.number);
            names.site[spot] = Some(site);
        }
    }
    for _ in 0..REVISIONS {
        names.spread(seen, layout);
        if !names.revise(seen) {
            break;
        }
    }
    names
}
