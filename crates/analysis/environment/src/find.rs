//! From spots to fluoroscopes: ideal pixels, labels, a common start, the estimate, and what is told of it.

use std::collections::BTreeMap;

use biplane_artifact::{
    BeadClicks, BeadList, Detector, DistortionTable, Environment, PoseRecord, SeenBead, Spots,
    TriangulatedBead, ViewEnvironment,
};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Point3, Pose, Vector2, Vector3};
use nalgebra::{Matrix3, UnitQuaternion};

use crate::adjust::{Arrangement, Observation};
use crate::clicks::named_beads;
use crate::error::EnvironmentError;
use crate::estimate::{Estimate, Lacking, Measured, estimate};
use crate::judge::{Hidden, Judged, judge};
use crate::label::{Labelling, Seen, Task, Unlabelled, Visible};
use crate::stage::EnvironmentParams;
use crate::triangulate::leave_one_out;
use crate::view::View;

/// One bead picture, its spots in ideal px.
pub(crate) struct BeadPicture<'a> {
    pub view: usize,
    pub set: usize,
    pub spots: &'a Spots,
    /// As they are recorded, not turned round.
    pub seen: Vec<Seen>,
    pub named: Vec<Option<usize>>,
    pub visible: Visible,
}

/// The beads as the method wants them.
pub(crate) struct Frame {
    pub places: Vec<Point3>,
    /// mm; 0 where not known.
    pub radii: Vec<f64>,
    pub marks: Vec<bool>,
}

/// The fluoroscopes that pictures of a frame of beads show; `spots` is set by set, view by view within a set.
///
/// # Errors
/// See [`EnvironmentError`].
pub fn find_environment(
    detectors: &[&Detector],
    spots: &[&Spots],
    beads: &BeadList,
    clicks: Option<&BeadClicks>,
    params: &EnvironmentParams,
) -> Result<Environment, EnvironmentError> {
    let (views, pictures) = (detectors.len(), spots.len());
    if views == 0 || pictures == 0 || !pictures.is_multiple_of(views) {
        return Err(EnvironmentError::Pictures { pictures, views });
    }
    detectors.iter().try_for_each(|d| check_detector(d))?;
    let frame = check_beads(beads)?;
    let distortions: Vec<Option<Distortion>> =
        detectors.iter().map(|d| d.distortion.as_ref().map(Distortion::from)).collect();
    let mut pictures: Vec<BeadPicture> = Vec::with_capacity(pictures);
    for (i, spots) in spots.iter().enumerate() {
        let (view, set) = (i % views, i / views);
        let seen = ideal_spots(spots, distortions[view].as_ref());
        if seen.len() < 6 {
            let view = detectors[view].view.clone();
            let (found, listed) = (seen.len(), frame.places.len());
            return Err(EnvironmentError::TooFew { view, picture: set, found, listed });
        }
        let visible = Visible::new(detectors[view].size, spots.border.as_ref(), distortions[view].as_ref());
        pictures.push(BeadPicture { view, set, spots, seen, named: vec![None; frame.places.len()], visible });
    }
    if let Some(clicks) = clicks {
        named_beads(&mut pictures, detectors, beads, clicks)?;
    }

    let labelled = labels(&pictures, detectors, &frame, params.mirrored)?;
    for (picture, labelling) in pictures.iter().zip(&labelled) {
        check_found(picture, labelling, detectors, &frame)?;
    }
    let (measured, hidden) = measure(&pictures, &labelled, &frame, params.mirrored);
    let start = arrange(&pictures, &labelled, views, &frame);
    // Wrong labels are pixels off, right ones tenths: what a picture of 1024 px has.
    let px = detectors.iter().flat_map(|d| d.size).max().unwrap_or(1024) as f64 / 1024.0;
    let found = estimate(&start, &measured, params.reject_sigmas, px).map_err(|lacking| match lacking {
        Lacking::Beads { view, used } => EnvironmentError::TooFew {
            view: detectors[view].view.clone(),
            picture: 0,
            found: used,
            listed: frame.places.len(),
        },
        Lacking::Decision { view, used } => {
            EnvironmentError::Undecided { view: detectors[view].view.clone(), used }
        }
    })?;

    let whole: Vec<Observation> = measured.iter().filter(|m| !m.cut).map(|m| m.observation).collect();
    let left_out = leave_one_out(&found, &whole, frame.places.len());
    let triangulated: Vec<TriangulatedBead> = left_out
        .iter()
        .map(|l| TriangulatedBead {
            picture: l.set,
            bead: l.bead,
            name: beads.0[l.bead].name.clone(),
            error_mm: l.error.into(),
        })
        .collect();
    let squares = left_out.iter().map(|l| l.error.norm_squared()).sum::<f64>();
    let triangulation_rms_mm = (!left_out.is_empty()).then(|| (squares / left_out.len() as f64).sqrt());

    let out = Output { pictures: &pictures, measured: &measured, labelled: &labelled, estimate: &found };
    let views: Vec<ViewEnvironment> = detectors
        .iter()
        .enumerate()
        .map(|(view, d)| out.view(view, d, distortions[view].as_ref(), &frame, beads, params.mirrored))
        .collect();
    let central = |v: &View| (v.centre - v.source).normalize();
    let angle_deg = match found.at.views.as_slice() {
        [a, b, ..] => Some(central(a).angle(&central(b)).to_degrees()),
        _ => None,
    };
    let judged = Judged {
        views: &views,
        measured: &measured,
        estimate: &found,
        triangulated: &triangulated,
        triangulation_rms_mm,
        angle_deg,
        hidden: &hidden,
    };
    let (verdict, warnings) = judge(&judged, beads, params);
    let covariance = found.covariance.row_iter().map(|r| r.iter().copied().collect()).collect();
    let bead_frames = found.at.frames.iter().map(|f| PoseRecord::from(*f)).collect();
    Ok(Environment {
        views,
        bead_frames,
        angle_deg,
        triangulated,
        triangulation_rms_mm,
        covariance,
        verdict,
        warnings,
    })
}

fn check_detector(d: &Detector) -> Result<(), EnvironmentError> {
    let wrong = |what: String| Err(EnvironmentError::Detector { view: d.view.clone(), what });
    if !(d.pixel_mm > 0.0 && d.pixel_mm.is_finite()) {
        return wrong(format!(
            "a pixel of {} mm is none; set the size of a pixel on the detector",
            d.pixel_mm
        ));
    }
    if d.size.contains(&0) {
        return wrong(format!("its pictures have {} x {} pixels; give pictures", d.size[0], d.size[1]));
    }
    if let Some(DistortionTable { first_px, step_px, count, ideal_px }) = &d.distortion {
        let whole = count[0].checked_mul(count[1]) == Some(ideal_px.len()) && count.iter().all(|n| *n >= 2);
        let numbers = first_px.iter().chain(ideal_px.iter().flatten()).all(|v| v.is_finite());
        if !whole || !numbers || !step_px.iter().all(|s| *s > 0.0 && s.is_finite()) {
            return wrong(format!(
                "its distortion has {} samples for a grid of {} x {}, or some that are no numbers; make it anew from the plate",
                ideal_px.len(),
                count[0],
                count[1]
            ));
        }
    }
    Ok(())
}

fn check_beads(beads: &BeadList) -> Result<Frame, EnvironmentError> {
    let list = &beads.0;
    if list.len() < 6 {
        return Err(EnvironmentError::ShortList { listed: list.len() });
    }
    for b in list {
        let usable = |v: f64| v.is_finite() && v.abs() < 1e9;
        if !b.at_mm.iter().all(|v| usable(*v)) || b.radius_mm.is_some_and(|r| !usable(r) || r < 0.0) {
            return Err(EnvironmentError::NoNumber { name: b.name.clone() });
        }
    }
    let places: Vec<Point3> = list.iter().map(|b| Point3::from(b.at_mm)).collect();
    let mut order: Vec<usize> = (0..list.len()).collect();
    order.sort_by(|&a, &b| {
        let by = |axis: usize| list[a].at_mm[axis].total_cmp(&list[b].at_mm[axis]);
        by(0).then(by(1)).then(by(2))
    });
    for pair in order.windows(2) {
        if places[pair[0]] == places[pair[1]] {
            let [first, second] = [0, 1].map(|i| list[pair[i]].name.clone());
            return Err(EnvironmentError::SamePlace { first, second });
        }
    }
    check_depth(&places, || "the beads of the list".to_owned())?;
    let radii: Vec<f64> = list.iter().map(|b| b.radius_mm.unwrap_or(0.0)).collect();
    Ok(Frame { places, radii, marks: list.iter().map(|b| b.mark).collect() })
}

/// That places are not in a plane: a hundredth of their extent is too little to tell source and detector by.
fn check_depth(places: &[Point3], which: impl FnOnce() -> String) -> Result<(), EnvironmentError> {
    let n = places.len().max(1) as f64;
    let mean = places.iter().map(|p| p.coords).sum::<Vector3>() / n;
    let spread = places.iter().map(|p| p.coords - mean).map(|d| d * d.transpose()).sum::<Matrix3<f64>>() / n;
    let values = spread.symmetric_eigenvalues();
    let [thickness_mm, extent_mm] = [values.min(), values.max()].map(|v| v.max(0.0).sqrt());
    if thickness_mm > 0.01 * extent_mm {
        return Ok(());
    }
    Err(EnvironmentError::Flat { which: which(), thickness_mm, extent_mm })
}

/// Spots in ideal pixels. Centres of area are carried as areas: the circle of the spot's size is corrected and its centroid taken,
/// since a distortion that bends an outline moves its centre (0.02 px at the rim of an intensifier for a radius of 10 px).
fn ideal_spots(spots: &Spots, distortion: Option<&Distortion>) -> Vec<Seen> {
    let usable =
        |(_, s): &(usize, &biplane_artifact::Spot)| s.at_px.iter().all(|v| v.is_finite() && v.abs() < 1e6);
    spots
        .spots
        .iter()
        .enumerate()
        .filter(usable)
        .filter_map(|(spot, s)| {
            let recorded = Point2::from(s.at_px);
            let (mut at, mut radius_px, mut sigma_px) = (recorded, s.radius_px, s.sigma_px);
            if let Some(d) = distortion {
                let (ideal, derivative) = d.ideal_with_derivative(&recorded);
                let stretch = derivative.determinant().abs().sqrt();
                at = corrected_area(d, &recorded, s.radius_px).unwrap_or(ideal);
                radius_px *= stretch;
                sigma_px *= stretch;
            }
            at.iter().all(|v| v.is_finite()).then_some(Seen { spot, at, radius_px, sigma_px, cut: s.cut })
        })
        .collect()
}

/// Centroid of a corrected circle, by a polygon of 16 corners.
fn corrected_area(d: &Distortion, centre: &Point2, radius: f64) -> Option<Point2> {
    if !(radius > 0.0 && radius < 1e3) {
        return None;
    }
    let corners: Vec<Vector2> = (0..16)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 16.0).sin_cos();
            d.ideal(&(centre + Vector2::new(cos, sin) * radius)).coords
        })
        .collect();
    let first = corners[0];
    let (mut sum, mut area) = (Vector2::zeros(), 0.0);
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (a, b) = (a - first, b - first);
        let twice = a.perp(&b);
        sum += (a + b) * (twice / 3.0);
        area += twice;
    }
    (area != 0.0).then(|| Point2::from(first + sum / area))
}

/// A pixel of a mirrored picture as it would be seen from the source, and back.
fn turned_round(at: &Point2, width: usize, mirrored: bool) -> Point2 {
    if mirrored { Point2::new(width as f64 - 1.0 - at.x, at.y) } else { *at }
}

/// Labels of one picture.
fn label(
    picture: &BeadPicture,
    detector: &Detector,
    frame: &Frame,
    named: &[Option<usize>],
    mirrored: bool,
    by_size: bool,
) -> Result<Labelling, Unlabelled> {
    let width = detector.size[0];
    let turned = |s: &Seen| Seen { at: turned_round(&s.at, width, mirrored), ..*s };
    let seen: Vec<Seen> = picture.seen.iter().map(turned).collect();
    Task {
        beads: &frame.places,
        radii: &frame.radii,
        marks: &frame.marks,
        seen: &seen,
        named,
        pixel_mm: detector.pixel_mm,
        size: detector.size,
        visible: picture.visible.turned(|p| turned_round(p, width, mirrored)),
    }
    .solve(by_size)
}

/// Labels of all pictures. Where some do not fit, or fit badly, their mirror images are tried, to say so.
fn labels(
    pictures: &[BeadPicture],
    detectors: &[&Detector],
    frame: &Frame,
    mirrored: bool,
) -> Result<Vec<Labelling>, EnvironmentError> {
    let of = |p: &BeadPicture, hand: bool, by_size: bool| {
        label(p, detectors[p.view], frame, &p.named, hand, by_size)
    };
    let doubted = |l: &Labelling, p: &BeadPicture| {
        let px = detectors[p.view].size[0].max(detectors[p.view].size[1]) as f64 / 1024.0;
        l.spread_px > px || l.share() < 0.75
    };
    let (mut found, mut other_hand) = (Vec::new(), Vec::new());
    'pictures: for p in pictures {
        let mut most = 0;
        for by_size in [true, false] {
            match of(p, mirrored, by_size) {
                Ok(l) => {
                    let better = |o: Labelling| o.spread_px < 0.3 * l.spread_px && o.found >= l.found;
                    if doubted(&l, p) && of(p, !mirrored, by_size).is_ok_and(better) {
                        other_hand.push(p);
                    }
                    found.push(l);
                    continue 'pictures;
                }
                Err(Unlabelled::Unknown { best }) => most = most.max(best),
                Err(why) => return Err(unlabelled(why, p, detectors[p.view], frame, mirrored)),
            }
            if of(p, !mirrored, by_size).is_ok() {
                other_hand.push(p);
                continue 'pictures;
            }
        }
        let why = Unlabelled::Unknown { best: most };
        return Err(unlabelled(why, p, detectors[p.view], frame, mirrored));
    }
    if !other_hand.is_empty() {
        let names: BTreeMap<usize, &str> =
            other_hand.iter().map(|p| (p.view, detectors[p.view].view.as_str())).collect();
        let views = names.into_values().collect::<Vec<_>>().join(", ");
        return Err(EnvironmentError::Mirrored { views, all: other_hand.len() == pictures.len(), mirrored });
    }
    Ok(found)
}

/// The error of a picture without labels.
fn unlabelled(
    why: Unlabelled,
    picture: &BeadPicture,
    detector: &Detector,
    frame: &Frame,
    mirrored: bool,
) -> EnvironmentError {
    let (view, at) = (detector.view.clone(), picture.set);
    match why {
        Unlabelled::Ambiguous { beads } => EnvironmentError::Ambiguous { view, picture: at, beads },
        Unlabelled::Unknown { best } => {
            let spots = picture.spots.spots.len();
            let listed = frame.places.len();
            if picture.named.iter().all(Option::is_none) {
                return EnvironmentError::Unknown { view, picture: at, best, listed, spots };
            }
            // Without the clicks, which of them are off?
            let free = vec![None; listed];
            let hint = match label(picture, detector, frame, &free, mirrored, true) {
                Ok(l) => {
                    let off =
                        (0..listed).filter(|&b| picture.named[b].is_some() && picture.named[b] != l.spot[b]);
                    let off: Vec<String> = off.map(|b| (b + 1).to_string()).collect();
                    format!(
                        "without clicks {} of {} beads are recognised, and the clicks on the list's beads in line {} disagree: \
                         correct or remove them in edits/beads_{view}.csv",
                        l.found,
                        l.expected,
                        off.join(", ")
                    )
                }
                Err(_) => {
                    format!("check their names in edits/beads_{view}.csv, and that the list is of this frame")
                }
            };
            EnvironmentError::WrongClicks { view, picture: at, hint }
        }
    }
}

/// That the beads found have depth, and that sizes go together.
fn check_found(
    picture: &BeadPicture,
    l: &Labelling,
    detectors: &[&Detector],
    frame: &Frame,
) -> Result<(), EnvironmentError> {
    let name = &detectors[picture.view].view;
    let places: Vec<Point3> =
        l.spot.iter().zip(&frame.places).filter(|(s, _)| s.is_some()).map(|(_, p)| *p).collect();
    check_depth(&places, || format!("the beads found in view {name}"))?;
    let mean = Point3::from(places.iter().map(|p| p.coords).sum::<Vector3>() / places.len() as f64);
    let magnification = l.view.source_to_detector_mm() / l.view.depth(&mean);
    if (1.0..=5.0).contains(&magnification) {
        return Ok(());
    }
    let fits = [("micrometres", 0.001), ("centimetres", 10.0), ("inches", 25.4), ("metres", 1000.0)]
        .map(|(unit, mm)| (unit, mm, magnification / mm))
        .into_iter()
        .filter(|(_, _, m)| (1.0..=5.0).contains(m))
        .min_by(|a, b| (a.2 / 1.5).ln().abs().total_cmp(&(b.2 / 1.5).ln().abs()));
    let hint = match fits {
        Some((unit, mm, _)) => {
            format!("the bead list seems to be in {unit}: multiply its coordinates by {mm}")
        }
        None => format!(
            "check the unit of the bead list and the size of a pixel on the detector, {} mm",
            detectors[picture.view].pixel_mm
        ),
    };
    Err(EnvironmentError::Unit { view: name.clone(), magnification, hint })
}

/// All labelled beads, and those that hide each other: where two shadows run into each other and one spot is all that was found of
/// them, that spot is neither's.
fn measure(
    pictures: &[BeadPicture],
    labelled: &[Labelling],
    frame: &Frame,
    mirrored: bool,
) -> (Vec<Measured>, Vec<Hidden>) {
    let (mut measured, mut hidden) = (Vec::new(), Vec::new());
    for (p, l) in pictures.iter().zip(labelled) {
        let mut sizes: Vec<f64> = l.spot.iter().flatten().map(|&s| p.seen[s].radius_px).collect();
        let typical = crate::label::median(&mut sizes).unwrap_or_default();
        let shadow = |bead: usize| {
            let (place, radius) = (&frame.places[bead], frame.radii[bead]);
            let size = if radius > 0.0 { l.view.shadow_radius_px(place, radius) } else { typical };
            l.view.shadow(place, radius).map(|at| (at, size))
        };
        let shadows: Vec<Option<(Point2, f64)>> = (0..frame.places.len()).map(shadow).collect();
        let mut merged = vec![false; shadows.len()];
        for (i, a) in shadows.iter().enumerate() {
            for (j, b) in shadows.iter().enumerate().take(i) {
                if let (Some(a), Some(b)) = (a, b)
                    && (a.0 - b.0).norm() < a.1 + b.1
                {
                    let one = l.spot[i].is_none() || l.spot[j].is_none();
                    merged[i] |= one;
                    merged[j] |= one;
                    hidden.push(Hidden { view: p.view, picture: p.set, beads: [j, i] });
                }
            }
        }
        for (bead, spot) in l.spot.iter().enumerate() {
            let Some(seen) = spot.map(|s| &p.seen[s]) else { continue };
            let observation = Observation {
                view: p.view,
                set: p.set,
                bead,
                point: frame.places[bead],
                radius: frame.radii[bead],
                at: turned_round(&seen.at, (2.0 * l.view.middle.x + 1.0) as usize, mirrored),
                weight: 1.0,
            };
            let cut = seen.cut || merged[bead];
            let Seen { radius_px, sigma_px, .. } = *seen;
            measured.push(Measured { observation, radius_px, sigma_px, cut });
        }
    }
    (measured, hidden)
}

/// Views of the first set as they are; frames of later sets from the view that sees most of both.
fn arrange(pictures: &[BeadPicture], labelled: &[Labelling], views: usize, frame: &Frame) -> Arrangement {
    let at = |set: usize, view: usize| &labelled[set * views + view];
    let sets = pictures.len() / views;
    let frames = (0..sets)
        .map(|set| {
            if set == 0 {
                return Pose::identity();
            }
            let best = (0..views).max_by_key(|&v| at(0, v).found.min(at(set, v).found)).unwrap_or(0);
            let (first, here) = (&at(0, best).view, &at(set, best).view);
            let turn = UnitQuaternion::from_rotation_matrix(&(first.rotation * here.rotation.inverse()));
            // Distances that were found one by one differ; the beads' middle keeps its place on the first view's detector.
            let middle = frame.places.iter().map(|p| p.coords).sum::<Vector3>() / frame.places.len() as f64;
            let seen = first.source + turn * (Point3::from(middle) - here.source);
            Pose::new(turn, seen.coords - turn * middle)
        })
        .collect();
    Arrangement { views: (0..views).map(|v| at(0, v).view).collect(), frames }
}

/// What the artifact's views are made of.
struct Output<'a> {
    pictures: &'a [BeadPicture<'a>],
    measured: &'a [Measured],
    labelled: &'a [Labelling],
    estimate: &'a Estimate,
}

impl Output<'_> {
    fn view(
        &self,
        view: usize,
        detector: &Detector,
        distortion: Option<&Distortion>,
        frame: &Frame,
        list: &BeadList,
        mirrored: bool,
    ) -> ViewEnvironment {
        let found = &self.estimate.at.views[view];
        let hand = if mirrored { -1.0 } else { 1.0 };
        let mut matrix = found.matrix();
        if mirrored {
            let row = matrix.row(2) * (detector.size[0] as f64 - 1.0) - matrix.row(0);
            matrix.set_row(0, &row);
        }
        let own = || self.measured.iter().enumerate().filter(move |(_, m)| m.observation.view == view);
        let picture_of = |set: usize| self.pictures.iter().position(|p| p.view == view && p.set == set);
        let beads: Vec<SeenBead> = own()
            .filter_map(|(i, m)| {
                let o = &m.observation;
                let p = picture_of(o.set)?;
                let seen = &self.pictures[p].seen[self.labelled[p].spot[o.bead]?];
                let r = self.estimate.residuals[i];
                Some(SeenBead {
                    picture: o.set,
                    bead: o.bead,
                    name: list.0[o.bead].name.clone(),
                    at_px: self.pictures[p].spots.spots[seen.spot].at_px,
                    residual_px: [hand * r.x, r.y],
                    used: self.estimate.used[i],
                })
            })
            .collect();
        let (mut strays, mut missing) = (Vec::new(), Vec::new());
        for (p, l) in self.pictures.iter().zip(self.labelled).filter(|(p, _)| p.view == view) {
            let beads = || l.spot.iter().flatten().map(|&s| p.seen[s].spot);
            let others = (0..p.spots.spots.len()).filter(|s| beads().all(|b| b != *s));
            strays.extend(others.map(|s| (p.set, p.spots.spots[s].at_px)));
            for bead in (0..frame.places.len()).filter(|&b| l.spot[b].is_none()) {
                let place = self.estimate.at.frames[p.set].transform(&frame.places[bead]);
                let Some(at) = found.shadow(&place, frame.radii[bead]) else { continue };
                let ideal = turned_round(&at, detector.size[0], mirrored);
                let recorded = distortion.map_or(Some(ideal), |d| d.recorded(&ideal));
                if let Some(recorded) = recorded.filter(|_| p.visible.holds(&ideal)) {
                    missing.push((p.set, bead, recorded.into()));
                }
            }
        }
        let squares: Vec<f64> = own()
            .filter(|(i, _)| self.estimate.used[*i])
            .map(|(i, _)| self.estimate.residuals[i].norm_squared())
            .collect();
        ViewEnvironment {
            view: detector.view.clone(),
            size: detector.size,
            pixel_mm: detector.pixel_mm,
            source: found.source.into(),
            centre: found.centre.into(),
            along_x: (found.rotation * Vector3::x() * hand).into(),
            along_y: (found.rotation * Vector3::y()).into(),
            matrix: std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)])),
            source_to_detector_mm: found.source_to_detector_mm(),
            reprojection_rms_px: (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt(),
            sigma_px: self.estimate.sigma_px[view],
            beads,
            strays,
            missing,
        }
    }
}
