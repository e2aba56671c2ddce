//! Whether a calibration still fits matched frames, and what its uncertainty does to a pose.
//!
//! **Between two views.** A point seen from two sources lies in one plane with them. Moving a body along the normal of that plane
//! moves both its outlines, so both views measure where the body is along it, and the pose can only halve what they disagree about.
//! One step of the fit in which the first view's outline may also move along the normal gives that **disagreement**: zero but for
//! noise where the calibration fits, whatever the pose. It is the epipolar residual of outlines, in mm at the body. Errors of calibration within the plane move the pose instead, and cannot be seen
//! in this way.
//!
//! **Of a pose.** With outlines `r(pose, c) = 0` and calibration parameters `c` of covariance `S`, the pose that a wrong `c` gives is
//! off by `-(J' W J)^-1 J' W B dc`, `J` and `B` being the derivatives of the outlines along their normals by pose and by `c`.

use biplane_artifact::CalibrationUncertainty;
use biplane_geometry::Pose;
use biplane_outline::RimMesh;
use nalgebra::{DMatrix, Matrix6, RowSVector, SMatrix, SVector, Vector6};

use crate::View;
use crate::refine::{
    Buffers, CORRELATION_PX, RefineParams, Row, collect_anew, robust_scale_squared, robust_weight,
};

/// Unknowns of the step: six of the pose, an inset a view, and the first view's own motion.
const UNKNOWN: usize = 9;
/// Times the step is weighed anew.
const REWEIGHED: usize = 12;

/// Parameters of a view's place.
const VIEW: usize = CalibrationUncertainty::PARAMETERS;

/// How far two views disagree about where a body is, along the normal of the plane through it and both sources.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disagreement {
    /// The first view's place less the second's, mm.
    pub mm: f64,
    /// Its standard deviation from the residuals of the outlines, mm.
    pub sigma_mm: f64,
}

/// How two views disagree about a body at a pose that was matched in both; `None` where edges hold too little of an outline,
/// or the sources and the body lie in a line.
pub fn disagreement(
    mesh: &RimMesh,
    views: &[View],
    pose: &Pose,
    params: &RefineParams,
) -> Option<Disagreement> {
    let [first, second] = views else { return None };
    let centre = pose.transform(mesh.centroid());
    let [to_first, to_second] = [first, second].map(|v| centre - v.fluoroscope.source());
    let normal = to_first.cross(&to_second).try_normalize(1e-6 * to_first.norm() * to_second.norm())?;
    let mut buffers = Buffers::default();
    collect_anew(mesh, views, pose, params, &mut buffers);
    let scale_squared = robust_scale_squared(&mut buffers, params.final_search_px, params.least_scale_px);
    // The pose, an inset a view, and how far the first view's outline is moved along the normal: all at once, because turning the
    // body takes up a part of what the views disagree about.
    let rows = || {
        buffers
            .by_view()
            .enumerate()
            .flat_map(|(view, (rows, inset))| rows.iter().map(move |r| (view, inset, r)))
    };
    let column = |view: usize, row: &Row| {
        let mut c = SVector::<f64, UNKNOWN>::zeros();
        c.fixed_rows_mut::<6>(0).copy_from(&row.derivative);
        c[6 + view] = 1.0;
        if view == 0 {
            c[UNKNOWN - 1] = row.derivative.fixed_rows::<3>(0).dot(&normal);
        }
        c
    };
    // The weights of the pose that was found are those of residuals with the disagreement in them: begin with them, and weigh anew.
    let mut solution = SVector::<f64, UNKNOWN>::zeros();
    let mut inverse = SMatrix::<f64, UNKNOWN, UNKNOWN>::zeros();
    for step in 0..REWEIGHED {
        let mut matrix = SMatrix::<f64, UNKNOWN, UNKNOWN>::zeros();
        let mut vector = SVector::<f64, UNKNOWN>::zeros();
        for (view, inset, row) in rows() {
            let c = column(view, row);
            let left = if step == 0 { row.residual - inset } else { row.residual - c.dot(&solution) };
            let weight = row.length * robust_weight(scale_squared, left);
            matrix.syger(weight, &c, &c, 1.0);
            vector += c * (weight * row.residual);
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        inverse = matrix.try_inverse()?;
        solution = inverse * vector;
    }
    // What the disagreement owes to each residual.
    let share = inverse.row(UNKNOWN - 1);
    let (mut squared, mut weights, mut spread) = (0.0, 0.0, 0.0);
    for (view, _, row) in rows() {
        let c = column(view, row);
        let left = row.residual - c.dot(&solution);
        let robust = robust_weight(scale_squared, left);
        squared += row.length * robust * left.powi(2);
        weights += row.length * robust;
        spread += row.length * CORRELATION_PX * (robust * (share * c)[0]).powi(2);
    }
    if weights <= 0.0 {
        return None;
    }
    let found = Disagreement { mm: solution[UNKNOWN - 1], sigma_mm: (spread * squared / weights).sqrt() };
    (found.mm.is_finite() && found.sigma_mm.is_finite()).then_some(found)
}

/// Covariance of a pose that was matched (as [`biplane_artifact::Match`] orders it, about the body's centroid) that the uncertainty of
/// the views' places brings, by the outline points that found their edge; `None` where these do not hold the pose, or `uncertainty` is not
/// of these views.
pub fn pose_covariance_of_calibration(
    mesh: &RimMesh,
    views: &[View],
    pose: &Pose,
    uncertainty: &CalibrationUncertainty,
    params: &RefineParams,
) -> Option<Matrix6<f64>> {
    let covariance = covariance_of(uncertainty, views.len())?;
    let mut normal = Matrix6::zeros();
    let mut mixed = DMatrix::<f64>::zeros(6, covariance.nrows());
    for (number, responses) in responses(mesh, views, pose, uncertainty, params).iter().enumerate() {
        // The inset of a view takes up what is common to its outline.
        let (mut sum, mut by_pose, mut by_view) = (0.0, Vector6::zeros(), RowSVector::<f64, VIEW>::zeros());
        let mut own_mixed = SMatrix::<f64, 6, VIEW>::zeros();
        for Response { by_pose: own, by_view: moved, weight, .. } in responses {
            normal += own * own.transpose() * *weight;
            own_mixed += own * moved * *weight;
            sum += weight;
            by_pose += own * *weight;
            by_view += moved * *weight;
        }
        if sum > 0.0 && params.inset_px > 0.0 {
            normal -= by_pose * by_pose.transpose() / sum;
            own_mixed -= by_pose * by_view / sum;
        }
        mixed.fixed_view_mut::<6, VIEW>(0, VIEW * number).copy_from(&own_mixed);
    }
    let answer = -(normal.try_inverse()? * mixed);
    let found = &answer * covariance * answer.transpose();
    let found = Matrix6::from_fn(|i, j| found[(i, j)]);
    found.iter().all(|v| v.is_finite()).then_some(found)
}

/// How far the uncertainty of the views' places moves outlines across themselves, px: root mean square over the outline points that found
/// their edge. `None` where there are none, or `uncertainty` is not of these views.
pub(crate) fn outline_sigma_of_calibration(
    mesh: &RimMesh,
    views: &[View],
    pose: &Pose,
    uncertainty: &CalibrationUncertainty,
    params: &RefineParams,
) -> Option<f64> {
    let covariance = covariance_of(uncertainty, views.len())?;
    let (mut squared, mut length) = (0.0, 0.0);
    for (number, responses) in responses(mesh, views, pose, uncertainty, params).iter().enumerate() {
        let own = covariance.fixed_view::<VIEW, VIEW>(VIEW * number, VIEW * number);
        for response in responses {
            squared += (response.by_view * own * response.by_view.transpose())[0] * response.length;
            length += response.length;
        }
    }
    (length > 0.0).then(|| (squared / length).sqrt())
}

/// The covariance as a matrix, if it is of so many views.
fn covariance_of(uncertainty: &CalibrationUncertainty, views: usize) -> Option<DMatrix<f64>> {
    let (rows, parameters) = (&uncertainty.covariance, VIEW * views);
    let fits = uncertainty.source_to_detector_mm.len() == views
        && rows.len() == parameters
        && rows.iter().all(|row| row.len() == parameters);
    fits.then(|| DMatrix::from_fn(parameters, parameters, |i, j| rows[i][j]))
}

/// How an outline point moves across its outline.
struct Response {
    /// By the pose, px/mm and px/rad.
    by_pose: Vector6<f64>,
    /// By the place of its view, px/mm and px/rad.
    by_view: RowSVector<f64, VIEW>,
    /// As the match weighs it: by the squared residual in mm.
    weight: f64,
    /// Length of the outline it stands for, px.
    length: f64,
}

/// The outline points of each view that found their edge.
fn responses(
    mesh: &RimMesh,
    views: &[View],
    pose: &Pose,
    uncertainty: &CalibrationUncertainty,
    params: &RefineParams,
) -> Vec<Vec<Response>> {
    let mut buffers = Buffers::default();
    collect_anew(mesh, views, pose, params, &mut buffers);
    let of_view = |(number, (rows, _)): (usize, (&[Row], f64))| {
        let (view, distance) = (&views[number], uncertainty.source_to_detector_mm[number]);
        let response = |row: &Row| {
            let point = buffers.sample(number, row);
            Some(Response {
                by_pose: row.derivative,
                by_view: point.normal.transpose()
                    * view.fluoroscope.pixel_by_placement(&point.world, distance)?,
                weight: row.weight(),
                length: row.length,
            })
        };
        rows.iter().filter_map(response).collect()
    };
    buffers.by_view().enumerate().map(of_view).collect()
}
