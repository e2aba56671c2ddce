//! Axes of a tibial tray from its shape.
//!
//! y is the normal of the plate, away from the keel; z is the normal of the mirror plane, square to y; the notch is behind. The origin
//! is the middle of the plate's section, on its upper face.

use std::f64::consts::PI;

use biplane_artifact::BodyKind;
use biplane_geometry::Vector3;

use crate::figures;
use crate::frame::square_to;
use crate::proposal::Proposal;
use crate::section::{Section, section, sections};
use crate::shape::{Shape, half_sphere};
use crate::symmetry::{ASYMMETRIC, Mirror, Places};

pub(crate) fn propose(shape: &Shape) -> Result<Proposal, String> {
    let mut warnings = Vec::new();
    let flat = plate_normal(shape).ok_or("no flat plate was found")?;
    let [along, all] = [0.99, -1.0].map(|least| {
        shape.samples.iter().filter(|s| s.normal.dot(&flat).abs() > least).map(|s| s.area).sum::<f64>()
    });
    if along < 0.15 * all {
        return Err(format!(
            "no flat plate was found: the flattest direction has {:.0} % of the surface, a tray has 15 and more",
            100.0 * along / all
        ));
    }
    let (y, plate) = plate(shape, &flat)?;
    let round: Vec<Vector3> = {
        let u = square_to(&y);
        let v = y.cross(&u);
        (0..24).map(|k| PI * f64::from(k) / 24.0).map(|a| u * a.cos() + v * a.sin()).collect()
    };
    let mirror = Places::of(shape).mirror(&round, Some(&y)).ok_or("it has no mirror plane")?;
    if mirror.cost > ASYMMETRIC {
        warnings.push(format!(
            "it is hardly its own mirror image (misfit {:.1} % of its size); look at z",
            100.0 * mirror.cost
        ));
    }
    let forward = y.cross(&mirror.normal).normalize();
    let reach = |d: &Vector3| {
        let (a, b) = plate.section.reach(d);
        b - a
    };
    let (width, depth) = (reach(&mirror.normal), reach(&forward));
    if depth > 0.95 * width {
        warnings.push(format!(
            "the plate is {width:.0} mm wide across its mirror plane and {depth:.0} mm deep along it; a tray is wider than deep: look at the axes"
        ));
    }
    let notch = notch(&plate.section, &mirror, &forward, width);
    if notch.abs() < 0.012 * width {
        return Err(format!(
            "its plate has no notch that tells front from back (its ends differ by {:.1} mm)",
            notch.abs()
        ));
    }
    if notch.abs() < 0.025 * width {
        warnings.push(format!(
            "the plate's notch, which tells front from back, is {:.1} mm deep only; look at the axes, or give anterior and posterior",
            notch.abs()
        ));
    }
    // The notch is behind.
    let x = if notch > 0.0 { -forward } else { forward };
    let z = x.cross(&y);
    let c = plate.section.centroid;
    let c = c + z * (mirror.height * z.dot(&mirror.normal) - c.dot(&z));
    let centre = c + y * (plate.top - c.dot(&y));
    let keel = shape.reach(&y).0;
    let tip = centre + y * (keel - centre.dot(&y));
    let marks = vec![
        ("medial", centre - z * (0.5 * width)),
        ("lateral", centre + z * (0.5 * width)),
        ("posterior", centre - x * (0.5 * depth)),
        ("anterior", centre + x * (0.5 * depth)),
        ("plate_centre", centre),
    ];
    let features = vec![
        figures::plane("plate", &centre, &y, 0.5 * width),
        figures::plane("mirror plane", &centre, &z, 0.5 * depth),
        figures::line("keel", &tip, &centre),
    ];
    Proposal::of_marks(BodyKind::TibialTray, marks, features, warnings)
}

/// The direction that most of the surface is square to, as the two faces of a plate are.
fn plate_normal(shape: &Shape) -> Option<Vector3> {
    let facing = |d: &Vector3, range: f64| -> f64 {
        shape
            .samples
            .iter()
            .map(|s| {
                let t = (1.0 - s.normal.dot(d).abs()) / range;
                if t < 1.0 { s.area * (1.0 - t) } else { 0.0 }
            })
            .sum()
    };
    let all = half_sphere(400);
    let coarse: Vec<(f64, Vector3)> = all.map(|d| (facing(&d, 0.02), d)).collect();
    let mut normal = coarse.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?.1;
    let mut range = 0.02;
    for _ in 0..60 {
        let mut sum = Vector3::zeros();
        for s in &shape.samples {
            let c = s.normal.dot(&normal);
            let t = (1.0 - c.abs()) / range;
            if t < 1.0 {
                sum += s.normal * (c.signum() * s.area * (1.0 - t).powi(2));
            }
        }
        let next = sum.try_normalize(1e-12)?;
        let moved = (next - normal).norm();
        normal = next;
        range = f64::max(0.7 * range, 0.0006);
        if moved < 1e-12 && range <= 0.0006 {
            break;
        }
    }
    Some(normal)
}

/// A tray's plate.
struct PlateOf {
    /// Its section in the middle of its thickness.
    section: Section,
    /// Height of its upper face along y.
    top: f64,
}

/// Which way is up (the keel is below), and the plate.
fn plate(shape: &Shape, flat: &Vector3) -> Result<(Vector3, PlateOf), String> {
    let (low, high) = shape.reach(flat);
    const LEVELS: i32 = 240;
    let at = |k: i32| low + (high - low) * (f64::from(k) + 0.5) / f64::from(LEVELS);
    let heights: Vec<f64> = (0..LEVELS).map(at).collect();
    let cuts = sections(shape, flat, &heights);
    let sections: Vec<(f64, Section)> =
        heights.into_iter().zip(cuts).filter_map(|(h, s)| Some((h, s?))).collect();
    let wide = |s: &Section| {
        let (d, _) = s.principal();
        s.width(&d)
    };
    // By its extent and not its area: of an open mesh the area says nothing.
    let widest = sections.iter().map(|(_, s)| wide(s)).fold(0.0, f64::max);
    let band: Vec<&(f64, Section)> = sections.iter().filter(|(_, s)| wide(s) > 0.9 * widest).collect();
    let (Some(first), Some(last)) = (band.first(), band.last()) else {
        return Err("no flat plate was found".to_owned());
    };
    let (below, above) = (first.0 - low, high - last.0);
    if below.max(above) < 0.12 * widest || below.max(above) < 1.5 * below.min(above) {
        return Err(format!(
            "no keel tells which face of the plate is below (it reaches {below:.1} mm beyond one and {above:.1} mm beyond the other)"
        ));
    }
    let sense = if below > above { 1.0 } else { -1.0 };
    let y = flat * sense;
    let middle = (first.0 + last.0) / 2.0;
    let section = section(shape, flat, middle).ok_or("no flat plate was found")?;
    // The upper face: the height with most of the surface that looks up.
    let up: Vec<(f64, f64)> =
        shape.samples.iter().filter(|s| s.normal.dot(&y) > 0.995).map(|s| (s.at.dot(&y), s.area)).collect();
    let density = |h: f64| -> f64 {
        up.iter()
            .map(|(at, area)| {
                let t: f64 = (at - h) / 0.5;
                if t.abs() < 1.0 { area * (1.0 - t * t) } else { 0.0 }
            })
            .sum()
    };
    let (bottom, ceiling) = shape.reach(&y);
    let count = (((ceiling - bottom) / 0.2) as i32).clamp(1, 5_000);
    let heights = (0..=count).map(|k| bottom + (ceiling - bottom) * f64::from(k) / f64::from(count));
    // Of faces of like size the uppermost: a hollow tray has some inside.
    let all: Vec<(f64, f64)> = heights.map(|h| (density(h), h)).collect();
    let most = all.iter().map(|(d, _)| *d).fold(0.0, f64::max);
    let last = all.iter().rposition(|(d, _)| *d > 0.35 * most).unwrap_or(all.len() - 1);
    let near = all.iter().skip(last.saturating_sub(3)).take(4);
    let mut top = near.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(ceiling, |(_, h)| *h);
    for _ in 0..50 {
        let (mut sum, mut weight) = (0.0, 0.0);
        for (at, area) in &up {
            let t = (at - top) / 0.5;
            if t.abs() < 1.0 {
                let w = area * (1.0 - t * t).powi(2);
                sum += w * (at - top);
                weight += w;
            }
        }
        if weight <= 0.0 {
            break;
        }
        top += sum / weight;
        if (sum / weight).abs() < 1e-12 {
            break;
        }
    }
    Ok((y, PlateOf { section, top }))
}

/// How much deeper the plate's outline is notched towards `forward` than to the other side, near the mirror plane, mm.
fn notch(section: &Section, mirror: &Mirror, forward: &Vector3, width: f64) -> f64 {
    let reach = |inner: bool, sense: f64| {
        section
            .segments
            .iter()
            .filter(|[p, q]| {
                let [a, b] = [p, q].map(|v| v.dot(&mirror.normal) - mirror.height);
                // Long segments of a coarse outline cross the middle without a corner in it.
                let near = a.min(b) < 0.05 * width && a.max(b) > -0.05 * width;
                near == inner
            })
            .map(|[p, q]| {
                let [a, b] = [p, q].map(|v| (v - section.centroid).dot(forward) * sense);
                if inner { (a + b) / 2.0 } else { a.max(b) }
            })
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let depth = |sense: f64| reach(false, sense) - reach(true, sense);
    depth(1.0) - depth(-1.0)
}
