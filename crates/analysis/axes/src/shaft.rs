//! The shaft of a long bone: which end of the body it is, and its axis through the centroids of its sections.

use biplane_geometry::Vector3;

use crate::section::{Section, section};
use crate::shape::Shape;

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
/// Sections along the body.
const LEVELS: usize = 60;

/// The line that was found, before it is known which end is which.
pub(crate) fn whole_line(shape: &Shape) -> Option<Shaft> {
    let (low, high) = shape.bounds();
    let size = high - low;
    if size.x < WHOLE * size.y.max(size.z) {
        return None;
    }
    let mut shaft = line(shape, Vector3::x(), |shape, direction| {
        let (low, high) = shape.reach(direction);
        let at = |s: f64| low + s * (high - low);
        let sections = (0..LEVELS).filter_map(|k| {
            let h = at(0.3 + 0.4 * k as f64 / (LEVELS - 1) as f64);
            section(shape, direction, h).map(|s| (h, s))
        });
        sections.collect()
    })?;
    shaft.whole = true;
    shaft.margin = 1.0;
    Some(shaft)
}

/// The shaft of a body that has one of its ends only, the other being cut through the shaft. `towards` is where the shaft's end should
/// lie, if that is known.
pub(crate) fn cut(shape: &Shape, towards: Option<Vector3>) -> Option<Shaft> {
    let mut scores: Vec<(f64, Vector3)> = Vec::new();
    let steps = [-1.0, 0.0, 1.0];
    for x in steps {
        for y in steps {
            for z in steps {
                let Some(d) = Vector3::new(x, y, z).try_normalize(0.5) else { continue };
                if towards.is_none_or(|t| t.dot(&d) > 0.55) {
                    scores.push((likeness(shape, &d), d));
                }
            }
        }
    }
    scores.extend(towards.map(|t| (likeness(shape, &t), t)));
    scores.sort_by(|a, b| b.0.total_cmp(&a.0));
    let &(best, direction) = scores.first()?;
    let next = scores.iter().find(|(_, d)| d.dot(&direction) < 0.6).map_or(0.0, |(s, _)| *s);
    let mut shaft = line(shape, direction, of_cut)?;
    shaft.margin = if towards.is_some() { 1.0 } else { (best - next).max(0.0) };
    Some(shaft)
}

/// How much the end in a direction looks like one cut through a shaft: its sections are alike, round, and much smaller than those
/// elsewhere. 0 to 1.
fn likeness(shape: &Shape, d: &Vector3) -> f64 {
    let (low, high) = shape.reach(d);
    let middle = (1..20).filter_map(|k| section(shape, d, low + (high - low) * f64::from(k) / 20.0));
    let largest = middle.map(|s| s.area).fold(0.0, f64::max);
    let unit = largest.sqrt();
    let at = |s: f64| section(shape, d, high - s * unit);
    let (Some(near), Some(far)) = (at(0.1), at(0.25)) else { return 0.0 };
    let alike = (near.area / far.area).min(far.area / near.area);
    alike * alike * far.roundness().min(1.0) * (1.0 - far.area / largest).max(0.0)
}

/// Sections of the shaft of a cut body from near its end up to where it widens.
fn of_cut(shape: &Shape, direction: &Vector3) -> Vec<(f64, Section)> {
    let (low, high) = shape.reach(direction);
    let sections: Vec<(f64, Section)> = (1..LEVELS)
        .filter_map(|k| {
            let h = high - (high - low) * k as f64 / LEVELS as f64;
            section(shape, direction, h).map(|s| (h, s))
        })
        .collect();
    let Some(first) =
        sections.iter().map(|(_, s)| s.area).fold(None, |m: Option<f64>, a| Some(m.map_or(a, |m| m.max(a))))
    else {
        return sections;
    };
    // The cap of the cut is left out: what is nearer to the end than a tenth of the body's width.
    let cap = high - 0.08 * first.sqrt();
    let shaft: Vec<(f64, Section)> = sections.into_iter().filter(|(h, _)| *h < cap).collect();
    let near_end = shaft.iter().take(LEVELS / 3).map(|(_, s)| s.area).fold(f64::INFINITY, f64::min);
    shaft.into_iter().take_while(|(_, s)| s.area < 1.35 * near_end).collect()
}

/// The line through the centroids of sections at right angles to itself.
fn line(
    shape: &Shape,
    start: Vector3,
    sections: impl Fn(&Shape, &Vector3) -> Vec<(f64, Section)>,
) -> Option<Shaft> {
    let mut direction = start;
    let mut found = None;
    for _ in 0..12 {
        let cuts = sections(shape, &direction);
        if cuts.len() < 3 {
            return found;
        }
        let count = cuts.len() as f64;
        let mean = cuts.iter().map(|(_, s)| s.centroid).sum::<Vector3>() / count;
        let (mut slope, mut weight) = (Vector3::zeros(), 0.0);
        for (_, s) in &cuts {
            let d = s.centroid - mean;
            let h = d.dot(&direction);
            slope += d * h;
            weight += h * h;
        }
        let next = (slope / weight).try_normalize(1e-9)?;
        let moved = (next - direction).norm();
        direction = next;
        let along = |s: &Section| (s.centroid - mean).dot(&direction);
        let (low, high) = cuts
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), (_, s)| (l.min(along(s)), h.max(along(s))));
        let off = |s: &Section| {
            let d = s.centroid - mean;
            (d - direction * d.dot(&direction)).norm_squared()
        };
        found = Some(Shaft {
            direction,
            ends: [mean + direction * low, mean + direction * high],
            radius: cuts.iter().map(|(_, s)| (s.area / std::f64::consts::PI).sqrt()).sum::<f64>() / count,
            rms: (cuts.iter().map(|(_, s)| off(s)).sum::<f64>() / count).sqrt(),
            margin: 0.0,
            whole: false,
        });
        if moved < 1e-10 {
            break;
        }
    }
    found
}
