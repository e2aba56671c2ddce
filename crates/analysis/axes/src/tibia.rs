//! Axes of a tibia from its shape: shaft, plateau, tuberosity.
//!
//! y runs along the shaft (from the ankle's centre to the plateau's where the whole bone is there) and is kept; z runs along the widest
//! direction of the plateau's sections and is made square to it.
//!
//! In front is where the crest and the tuberosity stand out from the shaft below the plateau, and the plateau's notch is behind.

use biplane_artifact::BodyKind;
use biplane_geometry::Vector3;
use nalgebra::Matrix3;

use crate::figures;
use crate::proposal::Proposal;
use crate::section::{Section, section};
use crate::shaft::{self, Shaft};
use crate::shape::Shape;

pub(crate) fn propose(shape: &Shape) -> Result<Proposal, String> {
    let mut warnings = Vec::new();
    let (shaft, mut up) = stand(shape)?;
    if shaft.margin < 0.15 {
        warnings.push(
            "the shape hardly tells which end is cut through the shaft; look at the axes, give landmarks, or set frame = \"lps\""
                .to_owned(),
        );
    }
    let found = || "no plateau was found at the end away from the shaft";
    let mut top = Top::of(shape, &up).ok_or_else(found)?;
    let short = !shaft.whole && shaft.length() < 1.2 * shaft.radius;
    if short {
        // A short stump's own direction says little: the line from its end to the middle of the plateau is longer.
        warnings.push(format!(
            "only {:.0} mm of the shaft are there, at a radius of {:.0} mm: y runs from its end to the middle of the plateau, and is \
             uncertain; give ankle_centre, or shaft_proximal and shaft_distal",
            shaft.length(),
            shaft.radius
        ));
        for _ in 0..10 {
            let to_top = up * ((top.height - top.middle.dot(&up)).max(0.0));
            up = (top.middle + to_top - shaft.ends[1]).try_normalize(1e-6).ok_or_else(found)?;
            top = Top::of(shape, &up).ok_or_else(found)?;
        }
    }
    let x = top.front(shape, &shaft, &up, &mut warnings)?;
    let z = x.cross(&up);
    let plane = plateau(shape, &up, &top).ok_or_else(found)?;
    let slope = up.dot(&plane.normal).clamp(-1.0, 1.0).acos().to_degrees();
    if slope > 20.0 {
        warnings
            .push(format!("the plateau stands {slope:.0} degrees off square to the shaft; look at the axes"));
    }
    if plane.rms > 0.03 * top.width {
        warnings.push(format!("the plateau is no plane: {:.1} mm rms off it; is this a tibia?", plane.rms));
    }
    // The middle of the rim's section, carried up along y to the plateau.
    let to_plane = |p: &Vector3| p + up * ((plane.centre - p).dot(&plane.normal) / up.dot(&plane.normal));
    let centre = to_plane(&top.middle);
    let (medial, lateral) =
        (to_plane(&(top.middle - z * (0.25 * top.width))), to_plane(&(top.middle + z * (0.25 * top.width))));
    if let Some(said) = other_side(&top, &x, &z) {
        warnings.push(said);
    }
    // z comes from the section, not from the sloping plane.
    let level = |p: &Vector3| p - up * (p - centre).dot(&up);
    let mut marks = vec![
        ("medial_plateau", level(&medial)),
        ("lateral_plateau", level(&lateral)),
        ("plateau_centre", centre),
    ];
    let [near, far] = shaft.ends;
    if !short {
        marks.push(("shaft_proximal", near));
    }
    marks.push(("shaft_distal", far));
    let mut features = vec![
        figures::line("shaft", &far, &near),
        figures::plane("plateau", &plane.centre, &plane.normal, 0.5 * top.width),
        figures::line("width of the plateau", &level(&medial), &level(&lateral)),
        figures::point("centre of the plateau", &centre),
    ];
    if shaft.whole {
        let (low, high) = shape.reach(&up);
        let ankle = section(shape, &up, low + 0.04 * (high - low)).map(|s| s.centroid);
        if let Some(ankle) = ankle {
            marks.push(("ankle_centre", ankle));
            features.push(figures::point("centre of the ankle", &ankle));
        }
    }
    Proposal::of_marks(BodyKind::Tibia, marks, features, warnings)
}

/// The shaft with its direction down, and up.
fn stand(shape: &Shape) -> Result<(Shaft, Vector3), String> {
    if let Some(mut shaft) = shaft::whole_line(shape) {
        let largest = |up: &Vector3| {
            let (low, high) = shape.reach(up);
            let at = |k: i32| high - 0.2 * (high - low) * f64::from(k) / 16.0;
            (1..16).filter_map(|k| section(shape, up, at(k))).map(|s| s.area).fold(0.0, f64::max)
        };
        let ends = [largest(&shaft.direction), largest(&-shaft.direction)];
        if ends[0].max(ends[1]) < 1.25 * ends[0].min(ends[1]) {
            return Err("its two ends are alike in size".to_owned());
        }
        if ends[0] > ends[1] {
            shaft.direction = -shaft.direction;
        }
        let up = -shaft.direction;
        if shaft.ends[0].dot(&up) < shaft.ends[1].dot(&up) {
            shaft.ends.swap(0, 1);
        }
        return Ok((shaft, up));
    }
    let shaft = shaft::cut(shape, shape.hint.map(|h| -h.superior))
        .ok_or("the shape does not tell which of its ends is cut through the shaft")?;
    let up = -shaft.direction;
    Ok((shaft, up))
}

/// The sections just below the plateau.
struct Top {
    width: f64,
    across: Vector3,
    middle: Vector3,
    /// Height of the widest section along y.
    height: f64,
    sections: Vec<Section>,
}

impl Top {
    fn of(shape: &Shape, up: &Vector3) -> Option<Self> {
        let (low, high) = shape.reach(up);
        let range = (high - low).min(90.0);
        let all: Vec<(f64, Section)> = (1..60)
            .filter_map(|k| {
                let h = high - range * f64::from(k) / 60.0;
                section(shape, up, h).map(|s| (h, s))
            })
            .collect();
        let (height, largest) = all.iter().max_by(|a, b| a.1.area.total_cmp(&b.1.area))?;
        let (height, area) = (*height, largest.area);
        // Those that are nearly as large.
        let sections: Vec<Section> = (-8..=8)
            .filter_map(|k| section(shape, up, height + f64::from(k) * 0.015 * area.sqrt()))
            .filter(|s| s.area > 0.85 * area)
            .collect();
        let first = sections.first()?.principal().0;
        let mut across = Vector3::zeros();
        for s in &sections {
            let (d, [long, short]) = s.principal();
            let sense = if d.dot(&first) < 0.0 { -1.0 } else { 1.0 };
            across += d * (sense * (long * long - short * short));
        }
        let across = across.try_normalize(1e-9)?;
        let middle = sections.iter().map(|s| s.centroid).sum::<Vector3>() / sections.len() as f64;
        let width = sections.iter().map(|s| s.width(&across)).fold(0.0, f64::max);
        Some(Self { width, across, middle, height, sections })
    }

    /// Where anterior is.
    fn front(
        &self,
        shape: &Shape,
        shaft: &Shaft,
        up: &Vector3,
        warnings: &mut Vec<String>,
    ) -> Result<Vector3, String> {
        let forward = up.cross(&self.across).normalize();
        // The tuberosity and the crest: below the plateau, how much farther the outline reaches to one side of its middle.
        let mut crest = 0.0;
        let mut count = 0.0;
        for k in 0..8 {
            let h = self.height - (0.3 + 0.04 * f64::from(k)) * self.width;
            if let Some(s) = section(shape, up, h) {
                let (back, front) = s.reach(&forward);
                crest += front + back;
                count += 1.0;
            }
        }
        let crest = if count > 0.0 { crest / count / self.width } else { 0.0 };
        // The plateau overhangs the shaft behind.
        let line = shaft.ends[0] + up * (self.middle - shaft.ends[0]).dot(up);
        let overhang = -(self.middle - line).dot(&forward) / self.width;
        // The notch between the condyles is behind.
        let depth = |to: &Vector3| {
            let depths = self.sections.iter().map(|s| {
                let reach = |inner: bool| {
                    s.segments
                        .iter()
                        .flatten()
                        .filter(|p| ((*p - s.centroid).dot(&self.across).abs() < 0.06 * self.width) == inner)
                        .map(|p| (p - s.centroid).dot(to))
                        .fold(f64::NEG_INFINITY, f64::max)
                };
                reach(false) - reach(true)
            });
            let all: Vec<f64> = depths.filter(|d| d.is_finite()).collect();
            all.iter().sum::<f64>() / all.len().max(1) as f64
        };
        let notch = (depth(&-forward) - depth(&forward)) / self.width;
        let vote = 1.5 * crest + notch + 0.25 * overhang;
        if let Some(hint) = shape.hint {
            let sense = hint.anterior.dot(&forward).signum();
            if sense * vote < -0.05 {
                warnings.push(
                    "the scanner's frame and the shape do not agree on what is in front; the frame was followed"
                        .to_owned(),
                );
            }
            return Ok(forward * sense);
        }
        if vote.abs() < 0.03 {
            return Err("its front and back look alike (neither tuberosity nor notch)".to_owned());
        }
        if notch * crest < 0.0 && notch.abs().min(crest.abs()) > 0.02 || vote.abs() < 0.06 {
            warnings.push(
                "the shape does not tell well what is in front and what is behind; look at the axes, or give landmarks"
                    .to_owned(),
            );
        }
        if crest.abs() < 0.01 {
            warnings.push("no tuberosity stands out below the plateau; is this a tibia?".to_owned());
        }
        Ok(forward * vote.signum())
    }
}

/// A plane through a cloud of places.
struct Plane {
    centre: Vector3,
    normal: Vector3,
    /// Of the places that count, mm.
    rms: f64,
}

/// The plane of the articular surfaces: what faces up on both sides of the eminence, robustly.
fn plateau(shape: &Shape, up: &Vector3, top: &Top) -> Option<Plane> {
    let floor = top.height - 0.05 * top.width;
    let inner = |d: &Vector3| {
        let along = d.dot(&top.across).abs();
        let off = (d - up * d.dot(up)).norm();
        // The eminence in the middle and the rim are no plateau.
        (0.13 * top.width..0.4 * top.width).contains(&along) && off < 0.42 * top.width
    };
    let on_top: Vec<_> = shape
        .samples
        .iter()
        .filter(|s| s.normal.dot(up) > 0.85 && s.at.dot(up) > floor && inner(&(s.at - top.middle)))
        .collect();
    let total: f64 = on_top.iter().map(|s| s.area).sum();
    if total < 0.03 * top.width * top.width {
        return None;
    }
    let mut plane = Plane {
        centre: on_top.iter().map(|s| s.at * s.area).sum::<Vector3>() / total,
        normal: *up,
        rms: 0.0,
    };
    let mut scale = 0.04 * top.width;
    for _ in 0..60 {
        let (mut sum, mut weight, mut squares) = (Vector3::zeros(), 0.0, 0.0);
        let weighed: Vec<(f64, Vector3)> = on_top
            .iter()
            .map(|s| {
                let r = (s.at - plane.centre).dot(&plane.normal);
                let u = (r / (4.7 * scale)).clamp(-1.0, 1.0);
                let w = s.area * (1.0 - u * u).powi(2);
                squares += w * r * r;
                sum += s.at * w;
                weight += w;
                (w, s.at)
            })
            .collect();
        if weight <= 0.0 {
            return None;
        }
        let centre = sum / weight;
        let spread: Matrix3<f64> =
            weighed.iter().map(|(w, p)| (p - centre) * (p - centre).transpose() * *w).sum();
        let eigen = spread.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        let normal = Vector3::from(eigen.eigenvectors.column(least));
        let normal = if normal.dot(up) < 0.0 { -normal } else { normal };
        let moved = (normal - plane.normal).norm() + (centre - plane.centre).norm();
        plane = Plane { centre, normal, rms: (squares / weight).sqrt() };
        scale = (0.8 * scale).max((squares / weight).sqrt().max(0.004 * top.width));
        if moved < 1e-10 {
            break;
        }
    }
    Some(plane)
}

/// Says if the tibia looks like one of the other side: the medial plateau is the deeper one from front to back.
fn other_side(top: &Top, x: &Vector3, z: &Vector3) -> Option<String> {
    let depth = |side: f64| {
        let depths = top.sections.iter().map(|s| {
            let (low, high) = s
                .segments
                .iter()
                .flatten()
                .filter(|p| {
                    let t = (*p - top.middle).dot(z) * side / top.width;
                    (0.15..0.35).contains(&t)
                })
                .map(|p| p.dot(x))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            high - low
        });
        depths.sum::<f64>() / top.sections.len().max(1) as f64
    };
    let [medial, lateral] = [depth(-1.0), depth(1.0)];
    (medial.is_finite() && lateral.is_finite() && lateral > 1.05 * medial).then(|| {
        format!(
            "it looks like a tibia of the other side: the plateau that would be lateral is {lateral:.1} mm deep, the medial one \
             {medial:.1} mm, and the medial one is the deeper one in most knees; check side"
        )
    })
}
