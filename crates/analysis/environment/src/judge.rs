//! Whether a calibration can be used, and what a person should look at.

use biplane_artifact::{BeadList, TriangulatedBead, Verdict, ViewEnvironment};
use biplane_geometry::{Point2, Vector3};

use crate::estimate::{Estimate, Measured};
use crate::label::median;
use crate::stage::EnvironmentParams;
use crate::view::VIEW;

/// Two beads whose shadows run into each other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hidden {
    pub view: usize,
    pub picture: usize,
    pub beads: [usize; 2],
}

/// What is judged.
pub(crate) struct Judged<'a> {
    pub views: &'a [ViewEnvironment],
    pub measured: &'a [Measured],
    pub estimate: &'a Estimate,
    pub triangulated: &'a [TriangulatedBead],
    pub triangulation_rms_mm: Option<f64>,
    pub angle_deg: Option<f64>,
    pub hidden: &'a [Hidden],
}

/// Fewer beads than this are few.
const FEW: usize = 12;
/// Angles below this say little of depth, degrees.
const NARROW_DEG: f64 = 20.0;

/// Doubtful where a limit is passed; warnings besides.
pub(crate) fn judge(j: &Judged, beads: &BeadList, params: &EnvironmentParams) -> (Verdict, Vec<String>) {
    let (mut doubts, mut remarks) = (Vec::new(), Vec::new());
    for (i, view) in j.views.iter().enumerate() {
        let name = &view.view;
        if view.reprojection_rms_px > params.max_reprojection_px {
            doubts.push(format!(
                "view {name}: beads are {:.2} px (rms) from where the fluoroscope has them, more than {} px: check the distortion \
                 correction and the bead list",
                view.reprojection_rms_px, params.max_reprojection_px
            ));
        }
        let used = view.beads.iter().filter(|b| b.used).count();
        if used < FEW {
            doubts.push(format!("view {name}: only {used} beads used; {FEW} or more make it sure"));
        }
        let cut = |bead: usize, set: usize| {
            let same = |m: &&Measured| {
                let o = &m.observation;
                o.view == i && o.bead == bead && o.set == set
            };
            j.measured.iter().find(same).is_some_and(|m| m.cut)
        };
        let rejected: Vec<String> = view
            .beads
            .iter()
            .filter(|b| !b.used && !cut(b.bead, b.picture))
            .map(|b| format!("{} ({:.1} px)", b.name, b.residual_px[0].hypot(b.residual_px[1])))
            .collect();
        if !rejected.is_empty() {
            let text = format!("view {name}: left out, since far off: beads {}", rejected.join(", "));
            // A few may be spots of something else; many are a wrong list.
            if rejected.len() * 5 > view.beads.len() { &mut doubts } else { &mut remarks }.push(text);
        }
        let expected = view.beads.len() + view.missing.len();
        if view.missing.len() * 4 > expected {
            doubts.push(format!("view {name}: {} of {expected} beads not found", view.missing.len()));
        } else if !view.missing.is_empty() {
            let names: Vec<&str> = view.missing.iter().map(|m| beads.0[m.1].name.as_str()).collect();
            remarks.push(format!("view {name}: beads not found: {}", names.join(", ")));
        }
        let covered = covered(j, i, view.size);
        if covered < 0.1 {
            doubts.push(format!(
                "view {name}: the beads used cover {:.0} % of the picture; outside of them the fluoroscope is a guess",
                100.0 * covered
            ));
        }
        let to_source = (Vector3::from(view.centre) - Vector3::from(view.source)).normalize();
        let spread = j.estimate.covariance.fixed_view::<3, 3>(VIEW * i, VIEW * i);
        let sigma = (spread * to_source).dot(&to_source).max(0.0).sqrt();
        if sigma > 0.01 * view.source_to_detector_mm {
            doubts.push(format!(
                "view {name}: the distance of the source is known to {sigma:.1} mm only (standard deviation): use beads spread \
                 more in depth"
            ));
        }
        if let Some(ratio) = size_ratio(j, i)
            && !(0.7..=1.4).contains(&ratio)
        {
            doubts.push(format!(
                "view {name}: spots are {ratio:.2} times as large as the list's beads would be: is the list in mm, and has it \
                 radii, not diameters?"
            ));
        }
    }
    for h in j.hidden {
        let [a, b] = h.beads.map(|b| beads.0[b].name.as_str());
        remarks.push(format!(
            "view {}, picture {}: beads {a} and {b} hide each other; turn the frame a little",
            j.views[h.view].view, h.picture
        ));
    }
    if let Some(rms) = j.triangulation_rms_mm
        && rms > params.max_triangulation_mm
    {
        let length = |t: &TriangulatedBead| Vector3::from(t.error_mm).norm();
        let worst = j.triangulated.iter().max_by(|a, b| length(a).total_cmp(&length(b)));
        let worst = worst.map_or(String::new(), |w| format!("; bead {} by {:.2} mm", w.name, length(w)));
        doubts.push(format!(
            "beads found again without their own help are {rms:.2} mm (rms) off, more than {} mm{worst}: check the list, and that \
             all views are of one placing of the frame",
            params.max_triangulation_mm
        ));
    }
    if j.views.len() > 1 && j.triangulated.is_empty() {
        doubts.push(
            "no bead is seen whole in two views: how the views stand to each other is not checked".to_owned(),
        );
    }
    if let Some(angle) = j.angle_deg
        && !(NARROW_DEG..=180.0 - NARROW_DEG).contains(&angle)
    {
        doubts.push(format!(
            "the central rays of the first two views are {angle:.0} degrees apart: depth is poorly seen below {NARROW_DEG:.0}"
        ));
    }
    let verdict = if doubts.is_empty() { Verdict::Good } else { Verdict::Doubtful };
    doubts.extend(remarks);
    (verdict, doubts)
}

/// Share of the picture within the convex hull of the beads used.
fn covered(j: &Judged, view: usize, size: [usize; 2]) -> f64 {
    let used = j.measured.iter().zip(&j.estimate.used).filter(|(m, u)| **u && m.observation.view == view);
    let mut points: Vec<Point2> = used.map(|(m, _)| m.observation.at).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    // Andrew's monotone chain, once each way.
    let chain = |points: &mut dyn Iterator<Item = Point2>| {
        let mut hull: Vec<Point2> = Vec::new();
        for p in points {
            while hull.len() >= 2
                && (hull[hull.len() - 1] - hull[hull.len() - 2]).perp(&(p - hull[hull.len() - 1])) <= 0.0
            {
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
        hull
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    let twice: f64 =
        hull.iter().zip(hull.iter().cycle().skip(1)).map(|(a, b)| a.coords.perp(&b.coords)).sum();
    twice.abs() / 2.0 / (size[0] as f64 * size[1] as f64)
}

/// Median of the spots' radii over what the list's radii would be; none where the list has none.
fn size_ratio(j: &Judged, view: usize) -> Option<f64> {
    let found = &j.estimate.at.views[view];
    let mut ratios = Vec::new();
    for (m, used) in j.measured.iter().zip(&j.estimate.used) {
        let o = &m.observation;
        if !*used || o.view != view || o.radius <= 0.0 {
            continue;
        }
        let place = j.estimate.at.frames[o.set].transform(&o.point);
        ratios.push(m.radius_px / found.shadow_radius_px(&place, o.radius));
    }
    median(&mut ratios)
}
