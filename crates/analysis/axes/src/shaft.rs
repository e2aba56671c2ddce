//! The shaft of a long bone: which end of the body it is, and its axis through the centroids of its sections.

use biplane_geometry::Vector3;

use crate::frame::square_to;
use crate::section::{Section, sections};
use crate::shape::{Shape, half_sphere};

/// A shaft's axis.
#[derive(Debug, Clone)]
pub(crate) struct Shaft {
    /// Unit, from the joint's end towards the shaft's.
    pub direction: Vector3,
    /// The ends of the part that was used: next to the joint, and far from it.
    pub ends: [Vector3; 2],
    /// Mean radius of its sections, as of circles of their area, mm.
    pub radius: f64,
    /// Root mean square distance of the centroids from the line, mm.
    pub rms: f64,
    /// How much better the chosen end looks like a shaft's than the next one of another direction: 0 to 1.
    pub margin: f64,
    /// Whether the body has both of its ends.
    pub whole: bool,
}

impl Shaft {
    /// Length of the part that was used, mm.
    pub fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }
}

/// A body longer than this times its width has both of its ends.
const WHOLE: f64 = 2.6;
/// Where a section is this much larger than the smallest one, the shaft ends.
const WIDER: f64 = 1.4;
/// Sections along the body.
const LEVELS: usize = 60;

/// The line that was found, before it is known which end is which.
pub(crate) fn whole_line(shape: &Shape) -> Option<Shaft> {
    let (low, high) = shape.bounds();
    let size = high - low;
    if size.x < WHOLE * size.y.max(size.z) {
        return None;
    }
    let mut shaft = line(shape, Vector3::x(), low.x + 0.3 * size.x, low.x + 0.7 * size.x)?;
    shaft.whole = true;
    shaft.margin = 1.0;
    Some(shaft)
}

/// Sections at even steps from one height to another, lowest first.
fn levels(shape: &Shape, direction: &Vector3, from: f64, to: f64) -> Vec<(f64, Section)> {
    let heights: Vec<f64> =
        (0..LEVELS).map(|k| from + (to - from) * (k as f64 + 0.5) / LEVELS as f64).collect();
    let found = sections(shape, direction, &heights);
    heights.into_iter().zip(found).filter_map(|(h, s)| Some((h, s?))).collect()
}

/// The shaft of a body that has one of its ends only, the other being cut through the shaft. `towards` is where the shaft's end should
/// lie, if that is known.
pub(crate) fn cut(shape: &Shape, towards: Option<Vector3>) -> Option<Shaft> {
    let allowed = |d: &Vector3| towards.is_none_or(|t| t.dot(d) > 0.55);
    let coarse = shape.coarse();
    let quick = coarse.as_ref().unwrap_or(shape);
    let own = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut scores: Vec<(f64, Vector3)> = own
        .into_iter()
        .chain(half_sphere(60))
        .flat_map(|d| [d, -d])
        .filter(|d| allowed(d))
        .map(|d| (likeness(quick, &d), d))
        .collect();
    scores.extend(towards.map(|t| (likeness(quick, &t), t)));
    scores.sort_by(|a, b| b.0.total_cmp(&a.0));
    // The best of different directions, each made better by small turns.
    let mut best: Vec<(f64, Vector3)> = Vec::new();
    for (score, d) in &scores {
        if best.len() < 4 && best.iter().all(|(_, b)| b.dot(d) < 0.9) {
            best.push(climb(quick, (*score, *d), &allowed));
        }
    }
    best.sort_by(|a, b| b.0.total_cmp(&a.0));
    let &(score, direction) = best.first()?;
    let next = best.iter().chain(&scores).filter(|(_, d)| d.dot(&direction) < 0.7);
    let next = next.map(|(s, _)| *s).fold(0.0, f64::max);
    if score < 0.05 {
        return None;
    }
    let (from, to) = of_cut(shape, &direction)?;
    let mut shaft = line(shape, direction, from, to)?;
    shaft.margin = if towards.is_some() { 1.0 } else { score - next };
    // Neither alone nor long: any end might be it.
    (shaft.margin > 0.15 || shaft.length() > 0.5 * shaft.radius).then_some(shaft)
}

/// Turns a direction in ever smaller steps to where the likeness is largest.
fn climb(shape: &Shape, start: (f64, Vector3), allowed: &impl Fn(&Vector3) -> bool) -> (f64, Vector3) {
    let mut best = start;
    let mut step = 0.2;
    while step > 0.02 {
        let u = square_to(&best.1);
        let v = best.1.cross(&u);
        let around = [u, -u, v, -v].map(|d| (best.1 + d * step).normalize());
        let next = around
            .into_iter()
            .filter(|d| allowed(d))
            .map(|d| (likeness(shape, &d), d))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match next {
            Some(next) if next.0 > best.0 => best = next,
            _ => step /= 2.0,
        }
    }
    best
}

/// How much the end in a direction looks like one cut through a shaft: its sections are alike, round, and much smaller than those
/// elsewhere. 0 to 1.
fn likeness(shape: &Shape, d: &Vector3) -> f64 {
    let (low, high) = shape.reach(d);
    let heights: Vec<f64> = (1..16).map(|k| low + (high - low) * f64::from(k) / 16.0).collect();
    let largest = sections(shape, d, &heights).into_iter().flatten().map(|s| s.area).fold(0.0, f64::max);
    let unit = largest.sqrt();
    let near_end = sections(shape, d, &[high - 0.25 * unit, high - 0.1 * unit]);
    let [Some(far), Some(near)] = near_end.as_slice() else { return 0.0 };
    let alike = (near.area / far.area).min(far.area / near.area);
    alike * alike * far.roundness().min(1.0) * (1.0 - far.area / largest).max(0.0)
}

/// From where to where the shaft of a cut body reaches along a direction: from where it widens to near its end.
fn of_cut(shape: &Shape, direction: &Vector3) -> Option<(f64, f64)> {
    let (low, high) = shape.reach(direction);
    let mut all = levels(shape, direction, low, high);
    all.reverse();
    let largest = all.iter().map(|(_, s)| s.area).fold(0.0, f64::max);
    // The cap of the cut is left out: what is nearer to the end than a small part of the body's width.
    let cap = high - 0.08 * largest.sqrt();
    all.retain(|(h, _)| *h < cap);
    let smallest = all.iter().take(LEVELS / 3).map(|(_, s)| s.area).fold(f64::INFINITY, f64::min);
    let widening = all.iter().position(|(_, s)| s.area > WIDER * smallest).unwrap_or(all.len());
    let (to, _) = all.first()?;
    let (from, _) = all.get(widening.clamp(5, all.len().max(6) - 1))?;
    Some((*from, *to))
}

/// The line through the centroids of sections at right angles to itself, over the part of the body that lies between two heights along
/// the direction it starts with.
fn line(shape: &Shape, start: Vector3, from: f64, to: f64) -> Option<Shaft> {
    let mut direction = start;
    let mut mean = levels(shape, &start, from, to).iter().map(|(_, s)| s.centroid).sum::<Vector3>();
    mean /= levels(shape, &start, from, to).len().max(1) as f64;
    let half = (to - from) / 2.0;
    let mut found = None;
    for _ in 0..15 {
        let at = mean.dot(&direction);
        let mut cuts = levels(shape, &direction, at - half, at + half);
        // Where the cut's plane leans, sections near it are corners of it.
        let mut areas: Vec<f64> = cuts.iter().map(|(_, s)| s.area).collect();
        areas.sort_by(f64::total_cmp);
        let middle = areas.get(areas.len() / 2).copied().unwrap_or(0.0);
        cuts.retain(|(_, s)| s.area > 0.8 * middle);
        if cuts.len() < 3 {
            return found;
        }
        let count = cuts.len() as f64;
        let centre = cuts.iter().map(|(_, s)| s.centroid).sum::<Vector3>() / count;
        let (mut slope, mut weight) = (Vector3::zeros(), 0.0);
        for (_, s) in &cuts {
            let d = s.centroid - centre;
            let h = d.dot(&direction);
            slope += d * h;
            weight += h * h;
        }
        let next = (slope / weight).try_normalize(1e-9)?;
        let moved = (next - direction).norm();
        direction = next;
        let along = |s: &Section| (s.centroid - centre).dot(&direction);
        let (low, high) = cuts
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), (_, s)| (l.min(along(s)), h.max(along(s))));
        let off = |s: &Section| {
            let d = s.centroid - centre;
            (d - direction * d.dot(&direction)).norm_squared()
        };
        found = Some(Shaft {
            direction,
            ends: [centre + direction * low, centre + direction * high],
            radius: cuts.iter().map(|(_, s)| (s.area / std::f64::consts::PI).sqrt()).sum::<f64>() / count,
            rms: (cuts.iter().map(|(_, s)| off(s)).sum::<f64>() / count).sqrt(),
            margin: 0.0,
            whole: false,
        });
        // The part stays where it is: about the place of the line that is nearest to its first middle.
        mean = centre + direction * (mean - centre).dot(&direction);
        if moved < 1e-10 {
            break;
        }
    }
    found
}
