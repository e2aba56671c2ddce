//! Axes of a femoral component from its shape.
//!
//! z is the normal of its mirror plane and is kept; y is the normal of the distal cut, the flat inner face that looks to where the
//! component is open; the flange is in front, it is higher and in one piece. The origin lies on the mirror plane, in the middle of
//! the axis through the posterior condyles.

use std::f64::consts::PI;

use biplane_artifact::BodyKind;
use biplane_geometry::Vector3;

use crate::condyles;
use crate::figures;
use crate::frame::{angle_deg, square_to};
use crate::proposal::Proposal;
use crate::shape::{Shape, half_sphere};
use crate::symmetry::{ASYMMETRIC, Mirror, Places};

/// Directions to start the search for a mirror plane from: the own axes, and others all around.
fn starts() -> Vec<Vector3> {
    [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().chain(half_sphere(150)).collect()
}

pub(crate) fn propose(shape: &Shape) -> Result<Proposal, String> {
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
    let u = square_to(z);
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
    for k in 0..72 {
        let angle = 2.0 * PI * f64::from(k) / 72.0;
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
