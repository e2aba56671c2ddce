//! Axes of a femur from its shape: shaft, condyles, and the head where it is there.
//!
//! With the head, y runs from the middle of the condyles' axis to the head's centre (the mechanical axis) and is kept. Without it, the
//! condyles' axis is kept as z and the shaft made square to it: the shaft leans outwards by 5 to 7 degrees against the mechanical
//! axis, to which the condyles' axis is nearly square.
//!
//! Behind is where the notch is deep and to where the condyles stand out from the shaft's line.

use biplane_artifact::BodyKind;
use biplane_geometry::Vector3;

use crate::condyles::{self, Condyles};
use crate::figures;
use crate::frame::angle_deg;
use crate::head::{self, Head};
use crate::proposal::{Proposal, Refusal};
use crate::section::{Section, section};
use crate::shaft::{self, Shaft};
use crate::shape::Shape;

pub(crate) fn propose(shape: &Shape) -> Result<Proposal, Refusal> {
    let mut warnings = Vec::new();
    let (shaft, head) = stand(shape)?;
    let y = shaft.direction;
    let ends = Ends::of(shape, &y).ok_or("no section through the condyles was found")?;
    let (x, z) = ends.senses(shape, &shaft, &mut warnings)?;
    // The shaft and the head are good for a person's landmarks even where no condyles are.
    let mut marks = vec![("shaft_distal", shaft.ends[0]), ("shaft_proximal", shaft.ends[1])];
    let mut features = vec![figures::line("shaft", &shaft.ends[0], &shaft.ends[1])];
    if let Some(head) = &head {
        marks.push(("hip_centre", head.centre));
        features.push(figures::sphere("femoral head", &head.centre, head.radius));
    }
    let Some(fitted) = condyles::fit(shape, [x, y, z], &ends.middle, ends.width, condyles::BONE) else {
        let why =
            "no two round condyles were found at the end away from the shaft (were they cut for an implant?)";
        return Err(Refusal { why: why.to_owned(), marks, features });
    };
    judge(&shaft, &fitted, head.as_ref(), ends.width, &mut warnings);
    if let Some(said) = other_side(shape, &fitted, &y, ends.width) {
        warnings.push(said);
    }
    let [medial, lateral] = fitted.centres;
    marks.push(("medial_condyle", medial));
    marks.push(("lateral_condyle", lateral));
    features.push(figures::line("axis of the condyles", &medial, &lateral));
    for (k, name) in ["medial condyle", "lateral condyle"].into_iter().enumerate() {
        let half = fitted.axis * fitted.half_widths[k];
        let at = fitted.centres[k];
        features.push(figures::cylinder(name, &(at - half), &(at + half), fitted.radii[k]));
    }
    Ok(Proposal::of_marks(BodyKind::Femur, marks, features, warnings)?)
}

/// The shaft, pointing up, and the head.
fn stand(shape: &Shape) -> Result<(Shaft, Option<Head>), String> {
    if let Some(mut shaft) = shaft::whole_line(shape) {
        let heads = [1.0, -1.0].map(|sense| {
            let up = shaft.direction * sense;
            let (low, high) = shape.reach(&up);
            head::fit(shape, &up, &shaft.ends[0], high - 0.16 * (high - low))
        });
        let far = |h: &Head| {
            let d = h.centre - shaft.ends[0];
            (d - shaft.direction * d.dot(&shaft.direction)).norm()
        };
        // The head stands beside the shaft by more than its radius; a sphere in the condyles does not.
        let beside = heads.map(|h| h.filter(|h| far(h) > h.radius));
        return match beside {
            [Some(head), None] => Ok((shaft, Some(head))),
            [None, Some(head)] => {
                shaft.direction = -shaft.direction;
                shaft.ends.swap(0, 1);
                Ok((shaft, Some(head)))
            }
            [Some(a), Some(b)] => {
                let up = far(&a) >= far(&b);
                if !up {
                    shaft.direction = -shaft.direction;
                    shaft.ends.swap(0, 1);
                }
                Ok((shaft, Some(if up { a } else { b })))
            }
            [None, None] => Err("it is long, but no femoral head was found at either end".to_owned()),
        };
    }
    let shaft = shaft::cut(shape, shape.hint.map(|h| h.superior))
        .ok_or("the shape does not tell which of its ends is cut through the shaft")?;
    Ok((shaft, None))
}

/// The block of the condyles, seen along the shaft.
struct Ends {
    /// Largest width, mm.
    width: f64,
    /// The widest direction, unit, square to the shaft.
    across: Vector3,
    /// Middle of the section through the condyles.
    middle: Vector3,
    sections: Vec<Section>,
}

impl Ends {
    fn of(shape: &Shape, y: &Vector3) -> Option<Self> {
        let (low, high) = shape.reach(y);
        let all: Vec<Section> = (1..40)
            .filter_map(|k| section(shape, y, low + (high - low).min(110.0) * f64::from(k) / 40.0))
            .collect();
        let width_of = |s: &Section| {
            let (d, _) = s.principal();
            s.width(&d)
        };
        let width = all.iter().map(width_of).fold(0.0, f64::max);
        let sections: Vec<Section> = [0.14, 0.18, 0.22, 0.26, 0.30, 0.34, 0.38]
            .into_iter()
            .filter_map(|s| section(shape, y, low + s * width))
            .collect();
        // Where the width ends most far apart: the mean of the longest directions, by their doubled angles.
        let first = sections.first()?.principal().0;
        let mut across = Vector3::zeros();
        for s in &sections {
            let (d, [long, short]) = s.principal();
            let sense = if d.dot(&first) < 0.0 { -1.0 } else { 1.0 };
            across += d * (sense * (long * long - short * short));
        }
        let across = across.try_normalize(1e-9)?;
        let middle = sections.iter().map(|s| s.centroid).sum::<Vector3>() / sections.len() as f64;
        Some(Self { width, across, middle, sections })
    }

    /// Where anterior and lateral are.
    fn senses(
        &self,
        shape: &Shape,
        shaft: &Shaft,
        warnings: &mut Vec<String>,
    ) -> Result<(Vector3, Vector3), String> {
        let y = shaft.direction;
        let forward = y.cross(&self.across).normalize();
        // The notch: how far the outline of the middle strip stays behind that of the sides.
        let depth = |to: &Vector3| {
            let mut depths = self.sections.iter().map(|s| {
                let reach = |inner: bool| {
                    s.segments
                        .iter()
                        .flatten()
                        .filter(|p| ((*p - s.centroid).dot(&self.across).abs() < 0.06 * self.width) == inner)
                        .map(|p| (p - s.centroid).dot(to))
                        .fold(f64::NEG_INFINITY, f64::max)
                };
                let (inner, outer) = (reach(true), reach(false));
                if inner.is_finite() { outer - inner } else { outer }
            });
            let first = depths.next().unwrap_or(0.0);
            depths.fold(first, f64::max)
        };
        let notch = depth(&-forward) - depth(&forward);
        // The condyles stand out behind the shaft's line.
        let on_line = |h: &Vector3| shaft.ends[0] + y * (h - shaft.ends[0]).dot(&y);
        let stand_out: f64 = self
            .sections
            .iter()
            .map(|s| {
                let (back, front) = s.reach(&forward);
                let off = (s.centroid - on_line(&s.centroid)).dot(&forward);
                -(off + back) - (off + front)
            })
            .sum::<f64>()
            / self.sections.len().max(1) as f64;
        let (notch, stand_out) = (notch / self.width, stand_out / self.width);
        let vote = notch + stand_out;
        if let Some(hint) = shape.hint {
            let sense = hint.anterior.dot(&forward).signum();
            if sense * vote < -0.1 {
                warnings.push(
                    "the scanner's frame and the shape do not agree on what is in front; the frame was followed"
                        .to_owned(),
                );
            }
            let x = forward * sense;
            return Ok((x, x.cross(&y)));
        }
        if vote.abs() < 0.05 {
            return Err("its front and back look alike (no notch between the condyles)".to_owned());
        }
        if notch * stand_out < 0.0 && notch.abs().min(stand_out.abs()) > 0.03 || vote.abs() < 0.12 {
            warnings.push(
                "the shape does not tell well what is in front and what is behind; look at the axes, or give landmarks"
                    .to_owned(),
            );
        }
        let x = forward * vote.signum();
        Ok((x, x.cross(&y)))
    }
}

/// Says what is doubtful about the parts.
fn judge(shaft: &Shaft, condyles: &Condyles, head: Option<&Head>, width: f64, warnings: &mut Vec<String>) {
    if shaft.margin < 0.15 {
        warnings.push(
            "the shape hardly tells which end is cut through the shaft; look at the axes, give landmarks, or set frame = \"lps\""
                .to_owned(),
        );
    }
    let length = shaft.length();
    if length < 1.2 * shaft.radius {
        warnings.push(format!(
            "only {length:.0} mm of the shaft are there, at a radius of {:.0} mm: its direction is uncertain; give hip_centre, or \
             shaft_proximal and shaft_distal",
            shaft.radius
        ));
    } else if head.is_none() && shaft.rms > 0.02 * length.max(20.0) {
        warnings.push(format!(
            "the shaft is bent: its sections' middles lie {:.1} mm (rms) off a line of {length:.0} mm",
            shaft.rms
        ));
    }
    if condyles.rms > 0.015 * width {
        warnings.push(format!(
            "the condyles are no good cylinders: {:.2} mm rms off radii of {:.1} and {:.1} mm",
            condyles.rms, condyles.radii[0], condyles.radii[1]
        ));
    }
    let [a, b] = condyles.radii;
    if a.max(b) > 1.35 * a.min(b) {
        warnings.push(format!(
            "the condyles' radii differ much: {a:.1} mm medial, {b:.1} mm lateral; look at the axis through them"
        ));
    }
    let lean = 90.0 - angle_deg(&shaft.direction, &condyles.axis);
    if lean.abs() > 15.0 {
        warnings.push(format!("the shaft leans by {:.0} degrees against the condyles' axis", lean.abs()));
    }
}

/// Says if the femur looks like one of the other side: the shaft leans to the lateral side going up, and the lateral ridge of the groove
/// stands farther forward. Only where both say so.
fn other_side(shape: &Shape, condyles: &Condyles, y: &Vector3, width: f64) -> Option<String> {
    let z = condyles.axis;
    let lean = 90.0 - angle_deg(y, &z);
    let x = y.cross(&z).normalize();
    let middle = (condyles.centres[0] + condyles.centres[1]) / 2.0;
    let distal = shape.reach(y).0;
    let ridge = |side: f64| {
        shape
            .samples
            .iter()
            .filter(|s| {
                let h = s.at.dot(y) - distal;
                let t = (s.at - middle).dot(&z) * side;
                (0.15 * width..0.6 * width).contains(&h) && (0.08 * width..0.35 * width).contains(&t)
            })
            .map(|s| (s.at - middle).dot(&x))
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let ahead = ridge(1.0) - ridge(-1.0);
    // Each is about 1 in a usual knee of the side that was said.
    let [lean_vote, ahead_vote] = [lean / 5.0, ahead / (0.03 * width)];
    (lean_vote < -0.2 && ahead_vote < -0.2 && lean_vote + ahead_vote < -0.8).then(|| {
        format!(
            "it looks like a femur of the other side: its shaft leans {:.1} degrees to what would be medial, and the ridge of the groove \
             that would be lateral stays {:.1} mm behind the other one; check side",
            -lean, -ahead
        )
    })
}
