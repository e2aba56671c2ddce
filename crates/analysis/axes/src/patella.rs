//! Axes of a patella from its shape: flat from front to back, with an apex below and a ridge behind.
//!
//! x runs along the direction of least spread; y away from the apex, by the third moments of the surface in the plane square to x: it
//! is there that the outline tapers. Both senses are told by the surface behind, which the ridge folds about one direction while
//! the front bulges alike about all. None of this is sharp; how sure it is stands in the warnings.

use biplane_artifact::BodyKind;
use biplane_geometry::Vector3;

use crate::figures;
use crate::proposal::Proposal;
use crate::shape::Shape;

pub(crate) fn propose(shape: &Shape) -> Result<Proposal, String> {
    let mut warnings = Vec::new();
    let thin = Vector3::z();
    let [a, b, c] = shape.spread;
    if c > 0.85 * b {
        return Err(format!(
            "it is not flat enough to tell front and back (spreads of {a:.1}, {b:.1} and {c:.1} mm)"
        ));
    }
    let (mut x, sure) = behind(shape, &thin);
    if let Some(hint) = shape.hint {
        x = thin * hint.anterior.dot(&thin).signum();
    } else if sure < 0.1 {
        warnings.push(
            "the shape does not tell well which face is the front; look at the axes, or give medial and lateral"
                .to_owned(),
        );
    }
    let (taper, size) = taper(shape);
    let mut y = -taper;
    if let Some(hint) = shape.hint
        && hint.superior.dot(&y) < 0.0
    {
        y = -y;
    }
    if size < 0.05 {
        warnings.push(format!(
            "the apex hardly shows (taper {size:.2}); look at the axes, or give superior and inferior"
        ));
    }
    y = (y - x * y.dot(&x)).normalize();
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

/// Where the outline square to z tapers, unit, and how much of a third moment that is.
fn taper(shape: &Shape) -> (Vector3, f64) {
    let (mut sum, mut total, mut square) = (Vector3::zeros(), 0.0, 0.0);
    for s in &shape.samples {
        let p = Vector3::new(s.at.x, s.at.y, 0.0);
        sum += p * (p.norm_squared() * s.area);
        square += p.norm_squared() * s.area;
        total += s.area;
    }
    let unit = (square / total).sqrt();
    let third = sum / total / unit.powi(3);
    (third.try_normalize(1e-12).unwrap_or(Vector3::x()), third.norm())
}

/// The sense of `thin` that points to the front, and how sure it is.
fn behind(shape: &Shape, thin: &Vector3) -> (Vector3, f64) {
    // On each face the normals' spread: the ridge makes two facets of the face behind, whose normals spread about one direction.
    let faces = [1.0, -1.0].map(|sense| {
        let (mut xx, mut xy, mut yy, mut total) = (0.0, 0.0, 0.0, 0.0);
        for s in &shape.samples {
            if s.normal.dot(thin) * sense > 0.6 {
                let n = s.normal;
                xx += n.x * n.x * s.area;
                xy += n.x * n.y * s.area;
                yy += n.y * n.y * s.area;
                total += s.area;
            }
        }
        let (mean, half) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
        if total > 0.0 { half / mean.max(1e-12) } else { 0.0 }
    });
    let vote = faces[1] - faces[0];
    (thin * vote.signum(), vote.abs())
}
