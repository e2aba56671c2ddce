//! Axes of the components of a knee replacement from their shapes: mirror plane, planes, and what sticks out.
//!
//! **Femoral component.** z is the normal of its mirror plane and is kept; y is the normal of the distal cut, the flat inner face that
//! looks to where the component is open; the flange is in front, it is higher and in one piece. The origin lies on the mirror plane,
//! in the middle of the axis through the posterior condyles.
//!
//! **Tray.** y is the normal of the plate, away from the keel; z is the normal of the mirror plane, square to y; the notch is behind.
//! The origin is the middle of the plate's section, on its upper face.

use std::f64::consts::PI;

use biplane_artifact::BodyKind;
use biplane_geometry::Vector3;

use crate::condyles;
use crate::figures;
use crate::frame::angle_deg;
use crate::proposal::Proposal;
use crate::section::{Section, section};
use crate::shape::{Shape, half_sphere};
use crate::symmetry::{Mirror, Places};

/// Above this a body is hardly its own mirror image: misfit over size.
const ASYMMETRIC: f64 = 0.018;

/// Directions to start the search for a mirror plane from: the own axes, and others all around.
fn starts() -> Vec<Vector3> {
    [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().chain(half_sphere(150)).collect()
}

pub(crate) fn propose_femoral(shape: &Shape) -> Result<Proposal, String> {
    let mut warnings = Vec::new();
    let places = Places::of(shape);
    let mirror = places.mirror(&starts(), None).ok_or("it has no mirror plane")?;
    if mirror.cost > ASYMMETRIC {
        warnings.push(format!(
            "it is hardly its own mirror image (misfit {:.1} % of its size); look at z",
            100.0 * mirror.cost
        ));
    }
    let sideways = mirror.normal;
    let up = opening(shape, &sideways)
        .ok_or("it is not open to any side, as a femoral component is to the bone")?;
    let y = match distal_cut(shape, &sideways, &up) {
        Some(y) => y,
        None => {
            warnings.push(
                "no flat inner face (distal cut) was found: y points to where the component is open; look at it, or give peg_base and \
                 peg_tip"
                    .to_owned(),
            );
            up
        }
    };
    let (x, sure) = front(shape, &mirror, &y);
    if sure < 0.15 {
        warnings.push(
            "the shape does not tell well which side is the flange's; look at the axes, or give posterior and anterior"
                .to_owned(),
        );
    }
    let z = x.cross(&y);
    let (low, high) = shape.reach(&z);
    let width = high - low;
    let middle = z * (mirror.height * z.dot(&mirror.normal));
    let fitted = condyles::fit(shape, [x, y, z], &middle, width, condyles::IMPLANT)
        .ok_or("no two round condyles were found behind")?;
    if fitted.rms > 0.012 * width {
        warnings.push(format!("the condyles are no good cylinders: {:.2} mm rms", fitted.rms));
    }
    let lean = angle_deg(&fitted.axis, &z);
    if lean > 4.0 {
        warnings.push(format!(
            "the axis through the posterior condyles stands {lean:.1} degrees off the normal of the mirror plane, which was taken for z"
        ));
    }
    if let Some(said) = other_flange(shape, [x, y, z], &middle, width) {
        warnings.push(said);
    }
    // The condyles' middles, put on a line along z.
    let on_axis = (fitted.centres[0] + fitted.centres[1]) / 2.0;
    let centre = on_axis + z * (middle - on_axis).dot(&z);
    let half = (fitted.centres[1] - fitted.centres[0]).norm() / 2.0;
    let distal = centre + y * (shape.reach(&y).0 - centre.dot(&y));
    let marks = vec![
        ("medial", centre - z * half),
        ("lateral", centre + z * half),
        ("distal", distal),
        ("proximal", centre + y * (shape.reach(&y).1 - centre.dot(&y))),
    ];
    let mut features = vec![
        figures::plane("mirror plane", &centre, &z, 0.5 * width),
        figures::line("axis of the condyles", &fitted.centres[0], &fitted.centres[1]),
        figures::line("up: normal of the distal cut", &distal, &(distal + y * (0.5 * width))),
    ];
    for (k, name) in ["medial condyle", "lateral condyle"].into_iter().enumerate() {
        let (half, at) = (fitted.axis * fitted.half_widths[k], fitted.centres[k]);
        features.push(figures::cylinder(name, &(at - half), &(at + half), fitted.radii[k]));
    }
    Proposal::of_marks(BodyKind::FemoralComponent, marks, features, warnings)
}

/// Where in the mirror plane the component is open: the direction around its middle with least surface.
fn opening(shape: &Shape, z: &Vector3) -> Option<Vector3> {
    let u = crate::frame::square_to(z);
    let v = z.cross(&u);
    // The middle of the smallest circle around its side view, by moving towards the farthest place in ever smaller steps.
    let flat: Vec<(f64, f64, f64)> =
        shape.samples.iter().map(|s| (s.at.dot(&u), s.at.dot(&v), s.area)).collect();
    let (mut a, mut b) = (0.0, 0.0);
    let far = |a: f64, b: f64| {
        flat.iter().map(|p| (p, (p.0 - a).hypot(p.1 - b))).max_by(|x, y| x.1.total_cmp(&y.1))
    };
    for k in 1..400 {
        let (p, _) = far(a, b)?;
        let step = 1.0 / (f64::from(k) + 1.0);
        a += (p.0 - a) * step;
        b += (p.1 - b) * step;
    }
    let (_, radius) = far(a, b)?;
    let (mut best, mut most) = (f64::INFINITY, 0.0_f64);
    let mut direction = None;
    let outer: Vec<(f64, f64)> = flat
        .iter()
        .filter(|p| (p.0 - a).hypot(p.1 - b) > 0.5 * radius)
        .map(|p| ((p.1 - b).atan2(p.0 - a), p.2))
        .collect();
    for k in 0..180 {
        let angle = 2.0 * PI * f64::from(k) / 180.0;
        let area: f64 = outer
            .iter()
            .map(|(at, area)| {
                let off = (at - angle).cos();
                area * if off > 0.5 { (off - 0.5).powi(2) } else { 0.0 }
            })
            .sum();
        most = most.max(area);
        if area < best {
            best = area;
            direction = Some(u * angle.cos() + v * angle.sin());
        }
    }
    (best < 0.25 * most).then_some(direction).flatten()
}

/// The normal of the distal cut: of the flat inner faces square to the mirror plane, the one that looks most nearly to where the
/// component is open and has the anterior and the posterior cut at right angles on both sides (the chamfers have not).
fn distal_cut(shape: &Shape, z: &Vector3, up: &Vector3) -> Option<Vector3> {
    /// Bins around the circle, and how many of them are a degree.
    const BINS: usize = 720;
    const DEGREE: f64 = 2.0;
    let side = z.cross(up);
    let total: f64 = shape.samples.iter().map(|s| s.area).sum();
    let faces: Vec<(f64, f64)> = shape
        .samples
        .iter()
        .filter(|s| s.normal.dot(z).abs() < 0.1)
        .map(|s| (s.normal.dot(&side).atan2(s.normal.dot(up)).to_degrees(), s.area))
        .collect();
    let mut bins = vec![0.0; BINS];
    for (angle, area) in &faces {
        bins[((angle + 360.0) * DEGREE).round() as usize % BINS] += area / total;
    }
    let at = |k: i32| bins[k.rem_euclid(BINS as i32) as usize];
    // What faces within 3 degrees of each angle.
    let density: Vec<f64> = (0..BINS as i32)
        .map(|k| (-6..=6).map(|d| at(k + d) * (1.0 - f64::from(d * d) / 49.0)).sum())
        .collect();
    let around = |degrees: f64, range: f64| {
        let (from, to) = ((degrees - range) * DEGREE, (degrees + range) * DEGREE);
        (from.round() as i32..=to.round() as i32)
            .map(|k| density[k.rem_euclid(BINS as i32) as usize])
            .fold(0.0, f64::max)
    };
    let mut sorted = density.clone();
    sorted.sort_by(f64::total_cmp);
    let least = f64::max(0.012, 4.0 * sorted[BINS / 2]);
    let candidates = (-100..=100).map(|k| f64::from(k) / DEGREE).filter_map(|angle| {
        let here = around(angle, 0.0);
        let peak = here > least && here >= around(angle, 2.0);
        let cuts = around(angle + 90.0, 10.0).min(around(angle - 90.0, 10.0));
        peak.then_some(((1.0 - (angle / 60.0).powi(2)) * (here + 3.0 * cuts), angle))
    });
    let (_, mut angle) = candidates.max_by(|a, b| a.0.total_cmp(&b.0))?;
    for _ in 0..50 {
        let (mut sum, mut weight) = (0.0, 0.0);
        for (a, area) in &faces {
            let t = (a - angle) / 2.5;
            if t.abs() < 1.0 {
                let w = area * (1.0 - t * t).powi(2);
                sum += w * (a - angle);
                weight += w;
            }
        }
        if weight <= 0.0 {
            return None;
        }
        angle += sum / weight;
        if (sum / weight).abs() < 1e-11 {
            break;
        }
    }
    let (sine, cosine) = angle.to_radians().sin_cos();
    Some(up * cosine + side * sine)
}

/// Where the flange is, and how sure that is: it is higher than the condyles behind, and it is there in the middle.
fn front(shape: &Shape, mirror: &Mirror, y: &Vector3) -> (Vector3, f64) {
    let x = y.cross(&mirror.normal).normalize();
    let (low, high) = shape.reach(&x);
    let (bottom, top) = shape.reach(y);
    let width = {
        let (a, b) = shape.reach(&mirror.normal);
        b - a
    };
    let part = |s: f64| {
        if s > 0.7 {
            1
        } else if s < 0.3 {
            0
        } else {
            2
        }
    };
    let mut tops = [bottom; 3];
    let mut in_middle = [0.0; 3];
    for s in &shape.samples {
        let k = part((s.at.dot(&x) - low) / (high - low));
        tops[k] = tops[k].max(s.at.dot(y));
        if (s.at.dot(&mirror.normal) - mirror.height).abs() < 0.06 * width {
            in_middle[k] += s.area;
        }
    }
    let higher = (tops[1] - tops[0]) / (top - bottom);
    let both = in_middle[0] + in_middle[1];
    let there = if both > 0.0 { (in_middle[1] - in_middle[0]) / both } else { 0.0 };
    let vote = higher + 0.5 * there;
    (x * vote.signum(), vote.abs())
}

/// Says if the flange looks like one of the other side: its top lies to the lateral side.
fn other_flange(shape: &Shape, [x, y, z]: [Vector3; 3], middle: &Vector3, width: f64) -> Option<String> {
    let aside = flange_aside(shape, [x, y, z], middle, width);
    (aside < -0.04 * width).then(|| {
        format!(
            "it looks like a component of the other side: the top of the flange lies {:.1} mm to what would be medial; check side",
            -aside
        )
    })
}

/// How far the top of the flange lies to the lateral side, mm.
fn flange_aside(shape: &Shape, [x, y, z]: [Vector3; 3], middle: &Vector3, width: f64) -> f64 {
    let (low, high) = shape.reach(&x);
    let front: Vec<_> = shape.samples.iter().filter(|s| s.at.dot(&x) > low + 0.6 * (high - low)).collect();
    let top = front.iter().map(|s| s.at.dot(&y)).fold(f64::NEG_INFINITY, f64::max);
    let (mut sum, mut weight) = (0.0, 0.0);
    for s in front {
        let w = (1.0 - (top - s.at.dot(&y)) / (0.12 * width)).max(0.0) * s.area;
        sum += w * (s.at - middle).dot(&z);
        weight += w;
    }
    if weight > 0.0 { sum / weight } else { 0.0 }
}

pub(crate) fn propose_tray(shape: &Shape) -> Result<Proposal, String> {
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
        let u = crate::frame::square_to(&y);
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
    let sections: Vec<(f64, Section)> =
        (0..LEVELS).filter_map(|k| section(shape, flat, at(k)).map(|s| (at(k), s))).collect();
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
