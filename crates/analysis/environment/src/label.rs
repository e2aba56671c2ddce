//! Labels for one picture: guesses grown to full labellings, the best of them taken if it is good enough and alone.

use biplane_artifact::Circle;
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Point3, Pose, Vector2};

use crate::adjust::{Arrangement, Belief, Observation, Rules, minimise};
use crate::linear::direct_linear;
use crate::search::{Guess, Scene, triples};
use crate::view::View;

/// A spot as this crate sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    /// Its place in the picture's list.
    pub spot: usize,
    /// Centre of its area in ideal px, as seen from the source.
    pub at: Point2,
    /// Ideal px.
    pub radius_px: f64,
    pub sigma_px: f64,
    pub cut: bool,
}

/// One picture and what is known of its beads.
pub(crate) struct Task<'a> {
    /// Taken as points: a shadow's centre is off by a hundredth of a pixel, and lengths need no unit here.
    pub beads: &'a [Point3],
    /// mm; 0 where not known.
    pub radii: &'a [f64],
    pub marks: &'a [bool],
    pub seen: &'a [Seen],
    /// By bead: the place in `seen` that a person named.
    pub named: &'a [Option<usize>],
    pub pixel_mm: f64,
    pub size: [usize; 2],
    pub visible: Visible,
}

/// Which spot each bead is, and about where the fluoroscope stands.
#[derive(Debug, Clone)]
pub(crate) struct Labelling {
    pub view: View,
    /// By bead: place in `seen`.
    pub spot: Vec<Option<usize>>,
    pub found: usize,
    /// Beads that the view has within the picture.
    pub expected: usize,
    /// Robust standard deviation of a coordinate, px.
    pub spread_px: f64,
    /// Beads for which a spot would lie as near by chance.
    by_chance: f64,
}

/// The part of a detector, in ideal px, that its picture shows: a rectangle, and a circle where the intensifier has a round border.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Visible {
    low: Point2,
    high: Point2,
    round: Option<(Point2, f64)>,
}

impl Visible {
    pub fn new(size: [usize; 2], border: Option<&Circle>, distortion: Option<&Distortion>) -> Self {
        let ideal = |p: Point2| distortion.map_or(p, |d| d.ideal(&p));
        let last = size.map(|n| n as f64 - 1.0);
        let corners = [[0.0, 0.0], [last[0], 0.0], [0.0, last[1]], last].map(|c| ideal(Point2::from(c)));
        let fold = |f: fn(f64, f64) -> f64| {
            corners.iter().skip(1).fold(corners[0], |a, p| Point2::new(f(a.x, p.x), f(a.y, p.y)))
        };
        let round = border.map(|b| {
            let middle = Point2::from(b.centre_px);
            let centre = ideal(middle);
            let reach = [Vector2::x(), Vector2::y(), -Vector2::x(), -Vector2::y()]
                .map(|to| (ideal(middle + to * b.radius_px) - centre).norm());
            (centre, reach.iter().sum::<f64>() / 4.0)
        });
        Self { low: fold(f64::min), high: fold(f64::max), round }
    }

    /// The same with its pixels turned round.
    pub fn turned(&self, turn: impl Fn(&Point2) -> Point2) -> Self {
        let (a, b) = (turn(&self.low), turn(&self.high));
        Self {
            low: Point2::new(a.x.min(b.x), a.y.min(b.y)),
            high: Point2::new(a.x.max(b.x), a.y.max(b.y)),
            round: self.round.map(|(centre, radius)| (turn(&centre), radius)),
        }
    }

    /// Whether an ideal pixel lies in it.
    pub fn holds(&self, p: &Point2) -> bool {
        let inside = (0..2).all(|k| p[k] >= self.low[k] && p[k] <= self.high[k]);
        inside && self.round.is_none_or(|(centre, radius)| (p - centre).norm() <= radius)
    }
}

/// Why there are none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unlabelled {
    /// Nothing explains enough; the most that was explained.
    Unknown { best: usize },
    /// Two labellings do about equally well.
    Ambiguous { beads: usize },
}

impl Labelling {
    /// Share of the beads that should be seen that were found, 0 to 1.
    pub fn share(&self) -> f64 {
        self.found as f64 / self.expected.max(1) as f64
    }
}

impl Task<'_> {
    /// Pixels of a 1024 px picture, in this one.
    fn scaled(&self, px: f64) -> f64 {
        px * self.size[0].max(self.size[1]) as f64 / 1024.0
    }

    fn middle(&self) -> Point2 {
        Point2::from(self.size.map(|n| (n as f64 - 1.0) / 2.0))
    }

    /// The labels of this picture, with what sizes say or without: a list may have no radii or wrong ones, and spots run into
    /// others. Without is not tried where sizes say nothing.
    pub fn solve(&self, by_size: bool) -> Result<Labelling, Unlabelled> {
        let (sizes, free) = (Sizes::of(self), Sizes::unknown(self));
        if by_size {
            self.solve_with(&sizes)
        } else if sizes == free {
            Err(Unlabelled::Unknown { best: 0 })
        } else {
            self.solve_with(&free)
        }
    }

    fn solve_with(&self, sizes: &Sizes) -> Result<Labelling, Unlabelled> {
        let spots: Vec<Point2> = self.seen.iter().map(|s| s.at).collect();
        let scene = Scene {
            beads: self.beads,
            spots: &spots,
            may_be: &sizes.may_be,
            scale: sizes.scale,
            pixel_mm: self.pixel_mm,
            middle: self.middle(),
            tolerance_px: self.scaled(15.0),
        };
        let mut good: Vec<Labelling> = Vec::new();
        let none = vec![None; self.beads.len()];
        let mut best = 0;
        scene.guesses(triples(self.beads, &sizes.anchors), |guesses| {
            for Guess { view, explained } in guesses {
                best = best.max(*explained);
                // Most guesses lead to what is known already.
                let near = self.nearest(view, sizes, scene.tolerance_px, &none);
                if good.iter().any(|g| agree(&g.spot, &near)) {
                    continue;
                }
                let Some(grown) = self.grown(view, sizes) else { continue };
                best = best.max(grown.found);
                if self.is_good(&grown) && good.iter().all(|g| g.spot != grown.spot) {
                    good.push(grown);
                }
            }
            !good.is_empty()
        });
        good.sort_by(|a, b| b.found.cmp(&a.found).then(a.spread_px.total_cmp(&b.spread_px)));
        let Some(first) = good.first() else { return Err(Unlabelled::Unknown { best }) };
        let rival = |l: &&Labelling| {
            // Another one, not the same with a bead more or less.
            let differ = |(a, b): (&Option<usize>, &Option<usize>)| a.is_some() && b.is_some() && a != b;
            let differing = l.spot.iter().zip(&first.spot).filter(|p| differ(*p)).count();
            differing * 4 > first.found
                && l.found + 1 + first.found / 10 >= first.found
                && l.spread_px <= 3.0 * first.spread_px + self.scaled(0.3)
        };
        match good.iter().skip(1).find(rival) {
            Some(rival) => Err(Unlabelled::Ambiguous { beads: rival.found }),
            None => Ok(first.clone()),
        }
    }

    /// Whether a labelling can be believed: most of the beads that should be seen are found, all that a person named are.
    fn is_good(&self, l: &Labelling) -> bool {
        let named = self.named.iter().zip(&l.spot).all(|(n, s)| n.is_none() || n == s);
        // Of few beads, nine parameters may explain half by chance.
        let least = if l.found < 10 { 0.8 } else { 0.5 };
        let by_chance = 5.0 + 3.0 * l.by_chance;
        named
            && l.found >= 6
            && l.found as f64 > by_chance
            && l.share() >= least
            && l.spread_px <= self.scaled(3.0)
    }

    /// The labelling that a guess leads to: label what is near, fit, look again, nearer.
    fn grown(&self, guess: &View, sizes: &Sizes) -> Option<Labelling> {
        let mut view = *guess;
        let none = vec![None; self.beads.len()];
        let mut spread = self.scaled(5.0);
        for (round, reach) in [15.0, 12.0, 9.0, 7.0, 5.0, 4.0, 4.0].into_iter().enumerate() {
            let reach = self.scaled(reach).min(self.scaled(4.0).max(6.0 * spread));
            let spot = self.nearest(&view, sizes, if round < 2 { self.scaled(15.0) } else { reach }, &none);
            let observations = self.observations(&spot);
            if observations.len() < 4 {
                return None;
            }
            let belief = Belief { source_to_detector_mm: view.source_to_detector_mm(), shares: [0.05, 0.2] };
            let decided = observations.len() >= 12 && round >= 3;
            let rules = Rules { huber_px: Some(self.scaled(1.0)), belief: (!decided).then_some(belief) };
            let pairs: Vec<(Point3, Point2)> = observations.iter().map(|o| (o.point, o.at)).collect();
            let linear = decided.then(|| direct_linear(&pairs, self.pixel_mm, self.middle())).flatten();
            let fitted = [Some(view), linear]
                .into_iter()
                .flatten()
                .filter_map(|start| {
                    let at = Arrangement { views: vec![start], frames: vec![Pose::identity()] };
                    minimise(&at, &observations, &rules).and_then(|f| f.at.views.first().copied())
                })
                .map(|v| (v, self.spread(&v, &observations)))
                .min_by(|a, b| a.1.total_cmp(&b.1))?;
            (view, spread) = fitted;
        }
        let reach = self.scaled(3.0).max(6.0 * spread);
        let spot = self.nearest(&view, sizes, reach, &none);
        let crowding = self.seen.len() as f64 * std::f64::consts::PI * reach * reach;
        let by_chance = self.beads.len() as f64 * crowding / (self.size[0] as f64 * self.size[1] as f64);
        let found = spot.iter().flatten().count();
        let spread_px = self.spread(&view, &self.observations(&spot));
        let expected = (0..self.beads.len()).filter(|&b| self.in_picture(&view, b)).count().max(found);
        // What is left and lies nearest to each other, farther off: a bead that is not where the list has it must show.
        let spot = self.nearest(&view, sizes, self.scaled(15.0), &spot);
        Some(Labelling { view, spot, found, expected, spread_px, by_chance })
    }

    /// Whether a bead's shadow lies in the picture.
    fn in_picture(&self, view: &View, bead: usize) -> bool {
        view.shadow(&self.beads[bead], 0.0).is_some_and(|p| self.visible.holds(&p))
    }

    /// The spot of each bead within reach; each the nearest of the other, of those that are not `taken`.
    fn nearest(&self, view: &View, sizes: &Sizes, reach: f64, taken: &[Option<usize>]) -> Vec<Option<usize>> {
        let mut of_spot: Vec<Option<(f64, usize)>> = vec![None; self.seen.len()];
        for (bead, place) in self.beads.iter().enumerate() {
            let Some(at) = view.shadow(place, 0.0) else { continue };
            let near = (0..self.seen.len())
                .filter(|s| taken[bead].is_none() && !taken.contains(&Some(*s)))
                .filter(|s| sizes.may_be[bead * self.seen.len() + s])
                .map(|s| ((self.seen[s].at - at).norm(), s))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((distance, s)) = near.filter(|n| n.0 <= reach)
                && of_spot[s].is_none_or(|(d, _)| distance < d)
            {
                of_spot[s] = Some((distance, bead));
            }
        }
        let mut of_bead = taken.to_vec();
        for (s, owner) in of_spot.iter().enumerate() {
            if let Some((_, bead)) = owner {
                of_bead[*bead] = Some(s);
            }
        }
        of_bead
    }

    fn observations(&self, spot: &[Option<usize>]) -> Vec<Observation> {
        spot.iter()
            .enumerate()
            .filter_map(|(bead, s)| {
                let seen = self.seen.get((*s)?)?;
                Some(Observation {
                    view: 0,
                    set: 0,
                    bead,
                    point: self.beads[bead],
                    radius: 0.0,
                    at: seen.at,
                    weight: 1.0,
                })
            })
            .collect()
    }

    /// From the median length of the residuals.
    fn spread(&self, view: &View, observations: &[Observation]) -> f64 {
        let mut lengths: Vec<f64> = observations
            .iter()
            .map(|o| view.shadow(&o.point, o.radius).map_or(f64::INFINITY, |p| (o.at - p).norm()))
            .collect();
        median(&mut lengths).map_or(f64::INFINITY, |m| m / RAYLEIGH_MEDIAN)
    }
}

/// Whether most of what `near` labels is labelled so in `known`.
fn agree(known: &[Option<usize>], near: &[Option<usize>]) -> bool {
    let labelled = near.iter().flatten().count();
    let same = known.iter().zip(near).filter(|(k, n)| n.is_some() && k == n).count();
    same * 5 >= labelled * 4
}

/// Median length of a vector of two normal coordinates of unit variance: sqrt(2 ln 2).
pub(crate) const RAYLEIGH_MEDIAN: f64 = 1.177_410_022_515_474_7;

/// The middle one in order, the upper of two; none of none.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// What sizes say.
#[derive(Debug, Clone, PartialEq)]
struct Sizes {
    /// Row by row, a row a bead.
    may_be: Vec<bool>,
    /// Beads that few spots can be.
    anchors: Vec<usize>,
    /// px a mm.
    scale: Option<f64>,
}

impl Sizes {
    /// Any spot may be any bead, but for those that a person named.
    fn unknown(task: &Task) -> Self {
        let (n, m) = (task.beads.len(), task.seen.len());
        let taken = |s: usize| task.named.contains(&Some(s));
        let may_be = (0..n * m)
            .map(|i| match task.named[i / m] {
                Some(s) => s == i % m,
                None => !taken(i % m),
            })
            .collect();
        let anchors = (0..n).filter(|&b| task.named[b].is_some()).collect();
        Self { may_be, anchors, scale: None }
    }

    fn of(task: &Task) -> Self {
        let mut sizes = Self::unknown(task);
        let m = task.seen.len();
        let mut px: Vec<f64> = task.seen.iter().map(|s| s.radius_px).collect();
        let mut mm: Vec<f64> = task.radii.to_vec();
        let (Some(px), Some(mm)) = (median(&mut px), median(&mut mm)) else { return sizes };
        if px.is_nan() || px <= 0.0 {
            return sizes;
        }
        let known = task.radii.iter().all(|r| *r > 0.0);
        // Most beads are of one size, and most spots are beads.
        let scale = px / mm;
        let fits = |bead: usize, spot: usize| {
            let seen = task.seen[spot].radius_px;
            if known {
                // Depth and blur change a shadow's size by less than this.
                (seen / (scale * task.radii[bead])).ln().abs() < 1.4_f64.ln()
            } else {
                !task.marks[bead] || seen > 1.15 * px
            }
        };
        for (i, may_be) in sizes.may_be.iter_mut().enumerate() {
            *may_be &= task.named[i / m].is_some() || fits(i / m, i % m);
        }
        let distinct = |b: usize| {
            let could_be = (0..m).filter(|s| sizes.may_be[b * m + s]).count();
            could_be > 0 && could_be * 3 <= m
        };
        sizes.anchors = (0..task.beads.len()).filter(|&b| distinct(b)).collect();
        sizes.scale = known.then_some(scale);
        sizes
    }
}
