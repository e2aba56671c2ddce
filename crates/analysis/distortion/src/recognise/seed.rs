//! The first guess of a plate's place: similarities that take a few spots around one onto sites of the plate.
//!
//! One spot and one of its nearest neighbours are held against every site and each of its neighbours, as seen from either side.
//! What is counted is how many of the spots around fall on sites, of all spots and sites there: so neither a pattern that is
//! too coarse nor one that is too fine wins.

use biplane_geometry::Point2;

use crate::affine::Affine;
use crate::pattern::{Layout, Site};
use crate::recognise::seen::Seen;

/// Spots around the first one that are counted.
const COUNTED: usize = 18;

/// Of these so many may fall beside a site before a guess is dropped.
const MISSES: usize = 6;

/// A spot is on a site within this part of the site's spacing: rows of an intensifier's picture bend, so a similarity is off
/// after a few of them.
pub(crate) const ON_SITE: f64 = 0.25;

/// Share of spots and sites together that a guess must bring together.
const LEAST_SHARE: f64 = 0.5;

/// A guess.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seed {
    /// From recorded px to the plate's mm, near the anchor.
    pub(crate) plate_from_picture: Affine,
    /// The spot that it was made at.
    pub(crate) anchor: usize,
    /// 1 if all spots around fall exactly on sites, and all sites there have spots.
    score: f64,
}

/// The best guesses at one spot, best first.
pub(crate) fn seeds(seen: &Seen, layout: &Layout, anchor: usize, sites: &[Site], most: usize) -> Vec<Seed> {
    let around = &seen.around[anchor];
    let mut found = Vec::new();
    for site in sites {
        let neighbours = layout.neighbours(site);
        for (other, _) in around.iter().take(3) {
            for (neighbour, mirrored) in neighbours.iter().flat_map(|n| [(n, false), (n, true)]) {
                let from = [seen.at[anchor], seen.at[*other]];
                let Some(guess) = Affine::similarity(from, [site.at, neighbour.at], mirrored) else {
                    continue;
                };
                if let Some(score) = score(seen, layout, anchor, &guess) {
                    found.push(Seed { plate_from_picture: guess, anchor, score });
                }
            }
        }
    }
    best(found, most)
}

/// Guesses from pairs of spots whose sites are known.
pub(crate) fn of_pairs(seen: &Seen, layout: &Layout, known: &[(usize, Site)], most: usize) -> Vec<Seed> {
    let mut found = Vec::new();
    for (a, site_a) in known {
        for (b, site_b) in known.iter().filter(|(b, _)| b != a) {
            for mirrored in [false, true] {
                let (from, to) = ([seen.at[*a], seen.at[*b]], [site_a.at, site_b.at]);
                let Some(guess) = Affine::similarity(from, to, mirrored) else { continue };
                // A person's word counts also where the spots around are few.
                let score = score(seen, layout, *a, &guess).unwrap_or(0.0);
                found.push(Seed { plate_from_picture: guess, anchor: *a, score });
            }
        }
    }
    best(found, most)
}

fn best(mut found: Vec<Seed>, most: usize) -> Vec<Seed> {
    // A stable sort: guesses of one score stay in the order of sites.
    found.sort_by(|a, b| b.score.total_cmp(&a.score));
    found.truncate(most);
    found
}

/// How well a guess does around its spot; `None` if badly.
fn score(seen: &Seen, layout: &Layout, anchor: usize, guess: &Affine) -> Option<f64> {
    let around = &seen.around[anchor][..seen.around[anchor].len().min(COUNTED)];
    let allowed = MISSES.min(around.len() / 3);
    let (mut numbers, mut squares, mut misses) = (Vec::with_capacity(COUNTED + 1), 0.0, 0);
    for spot in std::iter::once(anchor).chain(around.iter().map(|(i, _)| *i)) {
        let on_plate: Point2 = guess.apply(&seen.at[spot]);
        let site = layout.nearest(&on_plate)?;
        let off = (on_plate - site.at).norm() / site.spacing;
        if off <= ON_SITE && !numbers.contains(&site.number) {
            numbers.push(site.number);
            squares += (off / ON_SITE).powi(2);
        } else {
            misses += 1;
            if misses > allowed {
                return None;
            }
        }
    }
    let reach = around.last().map_or(0.0, |(_, distance)| distance * guess.scale());
    let sites = layout.within(&guess.apply(&seen.at[anchor]), reach * (1.0 + 1e-9), 4 * COUNTED)?;
    let on_sites = numbers.len() as f64;
    let of = (around.len() + 1 + sites.len()) as f64 - on_sites;
    let share = on_sites / of.max(1.0);
    (share >= LEAST_SHARE).then(|| share - 0.5 * squares / on_sites)
}
