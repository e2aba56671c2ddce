//! Axes of a patella from its shape: flat from front to back, with an apex below and a ridge behind.
//!
//! x runs along the direction of least spread. Behind is the face that is folded, about the ridge, more than the other one (or that was
//! cut flat for a button); the front bulges alike about all directions. z is the normal of the plane, square to x and nearly along the
//! ridge, about which the bone is most nearly its own mirror image. Below is where it is narrower and where its end lies farther
//! forward. None of this is sharp: how sure it is stands in the warnings.

use biplane_artifact::BodyKind;
use biplane_geometry::Vector3;
use nalgebra::{Matrix2, SMatrix, SVector};

use crate::figures;
use crate::proposal::Proposal;
use crate::shape::Shape;
use crate::symmetry::Places;

pub(crate) fn propose(shape: &Shape) -> Result<Proposal, String> {
    let mut warnings = Vec::new();
    let thin = Vector3::z();
    let [a, b, c] = shape.spread;
    if c > 0.85 * b {
        return Err(format!(
            "it is not flat enough to tell front and back (spreads of {a:.1}, {b:.1} and {c:.1} mm)"
        ));
    }
    let (low, high) = shape.bounds();
    if (high - low).max() > 75.0 {
        warnings.push(format!("it is {:.0} mm long; is this a patella?", (high - low).max()));
    }
    let faces = [1.0, -1.0].map(|sense| Face::of(shape, sense));
    let [Some(above), Some(below)] = faces else {
        return Err("one of its faces has no surface".to_owned());
    };
    let front = front(shape, &above, &below);
    let mut x = thin * front.signum();
    if let Some(hint) = shape.hint {
        x = thin * hint.anterior.dot(&thin).signum();
    } else if front.abs() < 0.1 {
        warnings.push(
            "the shape does not tell well which face is the front; look at the axes, give medial and lateral, or set frame = \"lps\""
                .to_owned(),
        );
    }
    // Across the ridge, or across the scanner's up.
    let behind = if x.z > 0.0 { &below } else { &above };
    let guess = match shape.hint {
        Some(hint) => hint.superior.cross(&thin).try_normalize(1e-3).unwrap_or(behind.across),
        None => behind.across,
    };
    let near: Vec<Vector3> = (-6..=6)
        .map(|k| f64::from(k) * 0.09)
        .map(|a| guess * a.cos() + thin.cross(&guess) * a.sin())
        .collect();
    let across = Places::of(shape).mirror(&near, Some(&thin));
    let across = across.ok_or("it has no mirror plane")?;
    if across.cost > 0.012 {
        warnings.push(format!(
            "it is hardly its own mirror image (misfit {:.1} % of its size): y and z are uncertain by 10 degrees and more",
            100.0 * across.cost
        ));
    }
    let along = across.normal.cross(&x).normalize();
    let up = apex_below(shape, &along, &across.normal, &x);
    let mut y = along * up.signum();
    if let Some(hint) = shape.hint {
        let sense = hint.superior.dot(&along).signum();
        if up * sense < -0.08 {
            warnings.push(
                "the scanner's frame and the shape do not agree on where the apex is; the frame was followed"
                    .to_owned(),
            );
        }
        y = along * sense;
    } else if up.abs() < 0.05 {
        warnings.push(
            "the shape does not tell well which end is the apex; look at the axes, give superior and inferior, or set frame = \"lps\""
                .to_owned(),
        );
    }
    let z = x.cross(&y);
    let end = |d: &Vector3| {
        let (low, high) = shape.reach(d);
        (low, high)
    };
    let [(inferior, superior), (medial, lateral)] = [end(&y), end(&z)];
    let centre = y * ((inferior + superior) / 2.0) + z * ((medial + lateral) / 2.0);
    let (half_y, half_z) = ((superior - inferior) / 2.0, (lateral - medial) / 2.0);
    let marks = vec![
        ("superior", centre + y * half_y),
        ("inferior", centre - y * half_y),
        ("medial", centre - z * half_z),
        ("lateral", centre + z * half_z),
    ];
    let features = vec![
        figures::line("apex to base", &(centre - y * half_y), &(centre + y * half_y)),
        figures::line("medial to lateral", &(centre - z * half_z), &(centre + z * half_z)),
        figures::plane("plane of the patella", &centre, &x, half_z),
    ];
    Proposal::of_marks(BodyKind::Patella, marks, features, warnings)
}

/// How a face is curved: a quadric over the plane of the bone.
struct Face {
    /// Largest and smallest curvature, 1/mm, positive where it bulges.
    bent: [f64; 2],
    /// The direction of the largest one.
    across: Vector3,
    /// How much of the bone's surface is flat on this side.
    flat: f64,
}

impl Face {
    fn of(shape: &Shape, sense: f64) -> Option<Self> {
        let total: f64 = shape.samples.iter().map(|s| s.area).sum();
        let unit = shape.spread[0];
        let (mut normal, mut right, mut flat) =
            (SMatrix::<f64, 6, 6>::zeros(), SVector::<f64, 6>::zeros(), 0.0);
        for s in &shape.samples {
            let facing = s.normal.z * sense;
            if facing > 0.995 {
                flat += s.area;
            }
            let (u, v) = (s.at.x / unit, s.at.y / unit);
            let far = (u * u + v * v) / 2.2;
            if facing < 0.4 || far > 1.0 {
                continue;
            }
            let w = s.area * (1.0 - far).powi(2);
            let j = SVector::<f64, 6>::from([1.0, u, v, u * u, u * v, v * v]);
            normal += j * j.transpose() * w;
            right += j * (s.at.z * sense * w);
        }
        let c = normal.cholesky()?.solve(&right);
        let eigen = Matrix2::new(c[3], c[4] / 2.0, c[4] / 2.0, c[5]).symmetric_eigen();
        let most = eigen.eigenvalues.imin();
        let d = eigen.eigenvectors.column(most);
        let bent = [most, 1 - most].map(|k| -2.0 * eigen.eigenvalues[k] / (unit * unit));
        Some(Self { bent, across: Vector3::new(d[0], d[1], 0.0), flat: flat / total })
    }
}

/// Positive where +z of the own frame is the front, and how sure that is, from the faces on the sides of +z and -z.
fn front(shape: &Shape, above: &Face, below: &Face) -> f64 {
    let cut = below.flat - above.flat;
    if cut.abs() > 0.15 {
        return cut;
    }
    let fold = |f: &Face| (f.bent[0] - f.bent[1]) * shape.spread[0];
    fold(below) - fold(above)
}

/// Positive where `along` points away from the apex, and how sure that is: the end of the apex is narrower, and lies farther forward.
fn apex_below(shape: &Shape, along: &Vector3, across: &Vector3, x: &Vector3) -> f64 {
    let (low, high) = shape.reach(along);
    let ends = [0.0, 1.0].map(|end| {
        let (mut square, mut mean, mut ahead, mut total) = (0.0, 0.0, 0.0, 0.0);
        for s in &shape.samples {
            let h = (s.at.dot(along) - low) / (high - low);
            let w = s.area * (1.0 - (h - end).abs() / 0.25).max(0.0);
            let t = s.at.dot(across);
            square += w * t * t;
            mean += w * t;
            ahead += w * s.at.dot(x);
            total += w;
        }
        let mean = mean / total;
        ((square / total - mean * mean).max(0.0).sqrt(), ahead / total)
    });
    let [(width_low, ahead_low), (width_high, ahead_high)] = ends;
    0.5 * (width_high - width_low) / (width_high + width_low) + (ahead_low - ahead_high) / (high - low)
}
