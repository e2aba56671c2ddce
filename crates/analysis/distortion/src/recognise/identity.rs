//! Which hole is which, where the pattern looks like itself when it is turned, shifted or mirrored.
//!
//! All motions of the plate in its plane that take named sites onto sites are compared. Those count that a person's clicks allow;
//! of these the one under which sizes of spots agree with sizes of holes (marks), then the one that explains most spots. What then is
//! left are true symmetries of the pattern, harmless to the map of distortion: of them the one that is not mirrored, is turned
//! least, and has the plate's middle nearest to that of the picture.

use biplane_geometry::Point2;

use crate::affine::Affine;
use crate::pattern::{Layout, Site, SiteNumber};
use crate::recognise::grow::Names;
use crate::recognise::seen::Seen;

/// A site is taken onto a site if it comes within this part of its spacing: lists are rounded, plates are drilled.
const SAME: f64 = 0.02;

/// Motions are compared that explain at least this share of what the best one explains.
const NEARLY_ALL: f64 = 0.98;

/// A spot or hole is large if its radius is this many times the median.
const LARGE: f64 = 1.15;

/// Differences of sizes are told apart to this much of the median radius, in sum.
const SIZE_STEP: f64 = 0.2;

/// Differences of relative radii up to this one are none.
const NOISE: f64 = 0.1;

/// Most times that names are exchanged and spread again.
const ROUNDS: usize = 12;

/// What a motion explains.
#[derive(Debug)]
struct Motion {
    move_plate: Affine,
    clicks: usize,
    explained: usize,
    /// Sum of differences of relative sizes of large spots or holes, in steps.
    sizes: i64,
    mirrored: bool,
    /// How far the plate is turned in the picture, degrees.
    turned_deg: i64,
    off_middle: f64,
}

/// What was chosen.
#[derive(Debug)]
pub(crate) struct Identified {
    pub(crate) names: Names,
    /// In how many ways the pattern lies on the spots as well, the one chosen counted; 1 if a person's clicks decided.
    pub(crate) ways: usize,
    /// The clicks that are not met, by number.
    pub(crate) unmet: Vec<usize>,
}

/// Chooses among the ways in which the pattern lies on the spots; `clicks` are spots with the sites that a person gave.
pub(crate) fn identify(seen: &Seen, layout: &Layout, names: Names, clicks: &[(usize, Site)]) -> Identified {
    let mut chosen = Identified { names, ways: 1, unmet: Vec::new() };
    for _ in 0..ROUNDS {
        let before = chosen.names.count();
        let Some((motion, ways)) = best_motion(seen, layout, &chosen.names, clicks) else { break };
        chosen.ways = ways;
        for site in &mut chosen.names.site {
            *site = site.and_then(|s| moved(layout, &motion, &s.at));
        }
        chosen.names.spread(seen, layout);
        // In an endless lattice nothing more can be gained.
        if chosen.names.count() <= before || matches!(layout, Layout::Lattice(_)) {
            break;
        }
    }
    let met =
        |(spot, site): &(usize, Site)| chosen.names.site[*spot].is_some_and(|s| s.number == site.number);
    chosen.unmet = (0..clicks.len()).filter(|i| !met(&clicks[*i])).collect();
    chosen
}

/// The site onto which a place of the plate is moved.
fn moved(layout: &Layout, motion: &Affine, at: &Point2) -> Option<Site> {
    let to = motion.apply(at);
    layout.nearest(&to).filter(|site| (to - site.at).norm() <= SAME * site.spacing)
}

fn best_motion(
    seen: &Seen,
    layout: &Layout,
    names: &Names,
    clicks: &[(usize, Site)],
) -> Option<(Affine, usize)> {
    let named: Vec<(usize, Site)> =
        names.named().filter(|(spot, _)| seen.whole[*spot]).map(|(spot, site)| (spot, *site)).collect();
    let pairs: Vec<_> = named.iter().map(|(spot, site)| (seen.at[*spot], site.at, 1.0)).collect();
    let plate_from_picture = Affine::best(&pairs)?;
    // Spots beside named ones, which another way might explain.
    let beside: Vec<Point2> = (0..seen.len())
        .filter(|spot| seen.whole[*spot] && names.site[*spot].is_none())
        .filter_map(|spot| names.expected(seen, spot))
        .collect();
    let sizes = Sizes::new(seen, layout, &named);

    // From which site to which others the plate may move: from that of a click to what the click says, else from one in the middle.
    let clicked = clicks.iter().filter_map(|(spot, to)| Some((names.site[*spot]?, vec![*to])));
    let mut bases: Vec<(Site, Vec<Site>)> = clicked.collect();
    if bases.is_empty() {
        let off_middle = |(spot, _): &&(usize, Site)| (seen.at[*spot] - seen.middle).norm();
        let (_, base) = named.iter().min_by(|a, b| off_middle(a).total_cmp(&off_middle(b)))?;
        bases.push((*base, layout.representatives()));
    }

    let mut motions: Vec<Motion> = Vec::new();
    let mut most = 0;
    for (base, site) in bases.iter().flat_map(|(base, to)| to.iter().map(move |site| (base, site))) {
        let Some(beside_base) = layout.neighbours(base).into_iter().next() else { continue };
        let length = (beside_base.at - base.at).norm();
        for neighbour in layout.neighbours(site) {
            if ((neighbour.at - site.at).norm() - length).abs() > SAME * length {
                continue;
            }
            for mirrored in [false, true] {
                let Some(mut motion) =
                    Affine::similarity([base.at, beside_base.at], [site.at, neighbour.at], mirrored)
                else {
                    continue;
                };
                motion.linear /= motion.scale();
                let may_miss = (named.len() as f64 * (1.0 - NEARLY_ALL)) as usize;
                let mut misses = 0;
                let on_sites = named.iter().take_while(|(_, s)| {
                    misses += usize::from(moved(layout, &motion, &s.at).is_none());
                    misses <= may_miss
                });
                if on_sites.count() < named.len() {
                    continue;
                }
                let gained = beside.iter().filter(|p| {
                    let to = motion.apply(p);
                    layout.nearest(&to).is_some_and(|s| (to - s.at).norm() <= 0.1 * s.spacing)
                });
                let explained = named.len() - misses + gained.count();
                most = most.max(explained);
                let met = clicks.iter().filter(|(spot, site)| {
                    let now = names.site[*spot].and_then(|s| moved(layout, &motion, &s.at));
                    now.is_some_and(|s| s.number == site.number)
                });
                let linear = motion.linear * plate_from_picture.linear;
                motions.push(Motion {
                    move_plate: motion,
                    clicks: met.count(),
                    explained,
                    sizes: sizes.difference(layout, &motion),
                    mirrored: linear.determinant() < 0.0,
                    turned_deg: linear[(1, 0)].atan2(linear[(0, 0)]).to_degrees().round().abs() as i64,
                    off_middle: (motion.apply(&plate_from_picture.apply(&seen.middle)) - layout.middle())
                        .norm(),
                });
            }
        }
    }
    motions.retain(|m| m.explained as f64 >= NEARLY_ALL * most as f64);
    let told = |m: &Motion| (std::cmp::Reverse(m.clicks), m.sizes, std::cmp::Reverse(m.explained));
    let best = motions.iter().min_by(|a, b| {
        told(a)
            .cmp(&told(b))
            .then(a.mirrored.cmp(&b.mirrored))
            .then(a.turned_deg.cmp(&b.turned_deg))
            .then(a.off_middle.total_cmp(&b.off_middle))
    })?;
    let ways = if clicks.is_empty() { motions.iter().filter(|m| told(m) == told(best)).count() } else { 1 };
    Some((best.move_plate, ways))
}

/// Sizes of spots and holes.
struct Sizes {
    /// Named places with the radius of their spot over the usual one.
    spots: Vec<(Point2, f64)>,
    /// Holes that are marks, with their radius over the usual one.
    marks: Vec<(SiteNumber, f64)>,
}

impl Sizes {
    fn new(seen: &Seen, layout: &Layout, named: &[(usize, Site)]) -> Self {
        let marks = layout.marks(LARGE);
        if marks.is_empty() {
            return Self { spots: Vec::new(), marks };
        }
        let mut radii: Vec<f64> = named.iter().map(|(spot, _)| seen.radius_px[*spot]).collect();
        radii.sort_by(f64::total_cmp);
        let median = radii.get(radii.len() / 2).copied().unwrap_or(1.0);
        let spots = named.iter().map(|(spot, site)| (site.at, seen.radius_px[*spot] / median)).collect();
        Self { spots, marks }
    }

    /// How badly sizes agree under a motion, in steps.
    fn difference(&self, layout: &Layout, motion: &Affine) -> i64 {
        if self.marks.is_empty() {
            return 0;
        }
        let mut sum = 0.0;
        for (at, spot) in &self.spots {
            // A large spot that is moved off all holes is as wrong as one on a small hole.
            let site = moved(layout, motion, at);
            let mark = self.marks.iter().find(|(n, _)| site.is_some_and(|s| s.number == *n)).map(|(_, r)| *r);
            if mark.is_some() || *spot > LARGE {
                // Noise of a radius is no difference.
                sum += ((spot - mark.unwrap_or(1.0)).abs() - NOISE).max(0.0);
            }
        }
        (sum / SIZE_STEP).round() as i64
    }
}
