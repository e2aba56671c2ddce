//! The axis through the posterior condyles: one line, a radius for each condyle.
//!
//! Both condyles' flexion facets are close to cylinders about one axis (Eckhoff et al., J. Bone Joint Surg. Am. 87 S2 (2005) 71). The
//! radii need not be equal here, so that one larger condyle does not tilt the axis. The start is the circle `p - r n = c` of each
//! condyle in the sagittal plane, linear in `c` and `r`; then Gauss-Newton on the distances, weighted by area and by Tukey's function.
//! What counts as facet is chosen anew in every round: normals square to the axis, in the range of the facet's arc.

use biplane_geometry::Vector3;
use nalgebra::{Matrix3, SMatrix, SVector};

use crate::frame::square_to;
use crate::shape::{Sample, Shape};

/// Two cylinders about one axis.
#[derive(Debug, Clone)]
pub(crate) struct Condyles {
    /// Unit, from the medial to the lateral condyle.
    pub axis: Vector3,
    /// On the axis: the middle of the medial facet, and of the lateral one.
    pub centres: [Vector3; 2],
    /// Medial, lateral; mm.
    pub radii: [f64; 2],
    /// Half the widths of the facets along the axis, mm.
    pub half_widths: [f64; 2],
    /// Root mean square distance of the facets from the cylinders, mm.
    pub rms: f64,
}

/// The facet's arc on a bone, from the posterior direction towards the distal one, rad.
pub(crate) const BONE: [f64; 2] = [-0.6, 0.8];
/// The same on an implant, which goes on straight above the arc.
pub(crate) const IMPLANT: [f64; 2] = [-0.1, 0.9];
/// Over how much the ends of the arc are faded out, rad.
const FADE: f64 = 0.17;
/// How far a facet's normal may be turned about the axis against the cylinder's, rad.
const TURNED: f64 = 0.35;
/// The same at the start.
const WIDE: f64 = 0.8;
/// What is farther from the cylinders than this is none of them, of the width.
const FARTHEST: f64 = 0.06;
/// Weight of the radii's difference, of that of the facets.
const ALIKE: f64 = 0.004;
/// How far from square to the axis a facet's normal may be (sine).
const LEAN: f64 = 0.4;

/// Fits the axis to the surface behind and below. `x` is anterior, `y` proximal, `z` lateral, roughly; `middle` is a place between the
/// condyles.
pub(crate) fn fit(
    shape: &Shape,
    [x, y, z]: [Vector3; 3],
    middle: &Vector3,
    width: f64,
    arc: [f64; 2],
) -> Option<Condyles> {
    let distal = shape.reach(&y).0;
    let near = |s: &&Sample| s.at.dot(&y) < distal + 0.62 * width;
    let behind: Vec<Sample> = shape.samples.iter().filter(near).copied().collect();
    let starts = [-1.0, 1.0].map(|side| start(&behind, [x, y, z], middle, side, width));
    let [Some(medial), Some(lateral)] = starts else { return None };
    let mut axis = (lateral.0 - medial.0).try_normalize(1e-6)?;
    if axis.dot(&z) < 0.8 {
        axis = z;
    }
    let mut at = (medial.0 + lateral.0) / 2.0;
    at += axis * (middle - at).dot(&axis);
    let mut radii = [medial.1, lateral.1];
    let mut facets: Vec<Facet> = Vec::new();
    for round in 0..80 {
        let back = (-x + axis * x.dot(&axis)).try_normalize(1e-6)?;
        let across = axis.cross(&back);
        let down = if across.dot(&y) < 0.0 { across } else { -across };
        // Wide at first, so that a start that is off does not choose what confirms it.
        let narrow = f64::from(round.min(20)) / 20.0;
        let turn = WIDE + (TURNED - WIDE) * narrow;
        facets.clear();
        for s in &behind {
            let d = s.at - at;
            let t = d.dot(&axis);
            let radial = d - axis * t;
            let far = radial.norm();
            let lean = s.normal.dot(&axis) / LEAN;
            if far < 1e-6 || t.abs() < 0.1 * width || lean.abs() >= 1.0 {
                continue;
            }
            let e = radial / far;
            let side = usize::from(t > 0.0);
            let r = far - radii[side];
            if r.abs() > FARTHEST * width {
                continue;
            }
            // A flat wall that goes on where the arc ends faces another way than the axis says.
            let [at_angle, facing] = [e, s.normal].map(|d| d.dot(&down).atan2(d.dot(&back)));
            let turned = (facing - at_angle) / turn;
            let fade = |v: f64| (v / FADE).clamp(0.0, 1.0);
            let within = |angle: f64| fade(angle - arc[0]) * fade(arc[1] - angle);
            let weight = s.area * within(facing) * within(at_angle) * (1.0 - lean * lean).powi(2);
            if weight > 0.0 && turned.abs() < 1.0 {
                facets.push(Facet { t, e, r, side, weight: weight * (1.0 - turned * turned).powi(2) });
            }
        }
        // Tukey's weights, by the median distance: it does not shrink with what it leaves out.
        let scale = (1.4826 * median_distance(&mut facets)).clamp(0.002 * width, 0.03 * width);
        for f in &mut facets {
            let u = f.r / (4.7 * scale);
            f.weight *= (1.0 - u * u).max(0.0).powi(2);
        }
        let total: f64 = facets.iter().map(|f| f.weight).sum();
        let both = [0, 1].map(|side| facets.iter().filter(|f| f.side == side).map(|f| f.weight).sum::<f64>());
        if both.iter().any(|w| *w < 2e-3 * width * width) {
            return None;
        }
        let u = square_to(&axis);
        let v = axis.cross(&u);
        let mut normal = SMatrix::<f64, 6, 6>::zeros();
        let mut right = SVector::<f64, 6>::zeros();
        for f in &facets {
            let (eu, ev) = (f.e.dot(&u), f.e.dot(&v));
            let mut j = SVector::<f64, 6>::from([-eu, -ev, -f.t * eu, -f.t * ev, 0.0, 0.0]);
            j[4 + f.side] = -1.0;
            normal += j * j.transpose() * f.weight;
            right -= j * (f.r * f.weight);
        }
        // The radii are alike unless the facets say otherwise.
        let alike = SVector::<f64, 6>::from([0.0, 0.0, 0.0, 0.0, 1.0, -1.0]);
        normal += alike * alike.transpose() * (ALIKE * total);
        right -= alike * ((radii[0] - radii[1]) * ALIKE * total);
        let step = normal.cholesky()?.solve(&right);
        at += u * step[0] + v * step[1];
        axis = (axis + u * step[2] + v * step[3]).normalize();
        radii = [radii[0] + step[4], radii[1] + step[5]];
        if round > 25 && step.norm() < 1e-8 {
            break;
        }
    }
    if radii.iter().any(|r| !(0.08 * width..0.6 * width).contains(r)) || axis.dot(&z) < 0.8 {
        return None;
    }
    let total: f64 = facets.iter().map(|f| f.weight).sum();
    let rms = (facets.iter().map(|f| f.weight * f.r * f.r).sum::<f64>() / total).sqrt();
    let spans = [0, 1].map(|side| {
        let of = || facets.iter().filter(move |f| f.side == side);
        let weight: f64 = of().map(|f| f.weight).sum();
        let mean = of().map(|f| f.weight * f.t).sum::<f64>() / weight;
        let variance = of().map(|f| f.weight * (f.t - mean).powi(2)).sum::<f64>() / weight;
        (mean, (3.0 * variance).sqrt())
    });
    Some(Condyles {
        axis,
        centres: spans.map(|(mean, _)| at + axis * mean),
        radii,
        half_widths: spans.map(|(_, half)| half),
        rms,
    })
}

/// A sample of a facet, seen from the axis.
struct Facet {
    /// Along the axis, mm.
    t: f64,
    /// Away from it, unit.
    e: Vector3,
    /// Distance beyond the radius, mm.
    r: f64,
    /// 0 medial, 1 lateral.
    side: usize,
    weight: f64,
}

/// The distance beyond which half of the weight lies; sorts the facets by distance.
fn median_distance(facets: &mut [Facet]) -> f64 {
    facets.sort_by(|a, b| a.r.abs().total_cmp(&b.r.abs()));
    let half = facets.iter().map(|f| f.weight).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    let beyond = facets.iter().find(|f| {
        sum += f.weight;
        sum >= half
    });
    beyond.map_or(0.0, |f| f.r.abs())
}

/// Centre and radius of one condyle's back.
fn start(
    samples: &[Sample],
    [x, y, z]: [Vector3; 3],
    middle: &Vector3,
    side: f64,
    width: f64,
) -> Option<(Vector3, f64)> {
    let on_side = |s: &&Sample| (s.at - middle).dot(&z) * side > 0.1 * width;
    let back = samples.iter().filter(on_side).map(|s| s.at.dot(&x)).fold(f64::INFINITY, f64::min);
    let facing = |s: &&Sample| {
        let n = s.normal;
        n.dot(&z).abs() < 0.5 && n.dot(&x) < -0.3 && n.dot(&y) < 0.7 && s.at.dot(&x) < back + 0.2 * width
    };
    // Minimises the sum of w |p - c - r n|^2 over c in the sagittal plane and r.
    let (mut normal, mut right, mut along, mut total) = (Matrix3::zeros(), Vector3::zeros(), 0.0, 0.0);
    for s in samples.iter().filter(on_side).filter(facing) {
        let (px, py) = (s.at.dot(&x), s.at.dot(&y));
        let (nx, ny) = (s.normal.dot(&x), s.normal.dot(&y));
        let w = s.area;
        normal += Matrix3::new(1.0, 0.0, nx, 0.0, 1.0, ny, nx, ny, nx * nx + ny * ny) * w;
        right += Vector3::new(px, py, px * nx + py * ny) * w;
        along += s.at.dot(&z) * w;
        total += w;
    }
    if total < 1e-3 * width * width {
        return None;
    }
    let c = normal.lu().solve(&right)?;
    (c.z > 0.05 * width && c.z < 0.6 * width).then(|| (x * c.x + y * c.y + z * (along / total), c.z))
}
