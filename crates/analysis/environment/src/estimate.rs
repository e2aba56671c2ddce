//! The estimate and its covariance: robust at first, then plain weighted least squares over what was not rejected.
//!
//! A bead is left out where its residual is longer than `reject_sigmas` times its view's spread (from the median, so one that is
//! wrong does not hide itself). The variance of a coordinate is what the picture's noise gives each spot plus a part that is
//! the same for all of a view (list, distortion); the common part is such that residuals are as large as they should be
//! (Paule and Mandel 1982), so equal noise has equal weights whatever the spots' own figures say, and the figures count where they
//! explain the residuals.

use biplane_geometry::Vector2;
use nalgebra::{DMatrix, SMatrix};

use crate::adjust::{Arrangement, Observation, Rules, inverse, minimise};
use crate::label::{RAYLEIGH_MEDIAN, median};
use crate::view::VIEW;

/// A bead in a picture, and whether it may count.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    pub observation: Observation,
    /// Of its spot, px.
    pub radius_px: f64,
    /// From the picture's noise, px.
    pub sigma_px: f64,
    /// Its centre is not that of the bead.
    pub cut: bool,
}

/// Where everything stands, and how sure that is.
#[derive(Debug, Clone)]
pub(crate) struct Estimate {
    pub at: Arrangement,
    pub used: Vec<bool>,
    /// Found less predicted, ideal px.
    pub residuals: Vec<Vector2>,
    /// Standard deviation of a coordinate, by view, px.
    pub sigma_px: Vec<f64>,
    /// The observations used, with their final weights.
    pub observations: Vec<Observation>,
    /// Of the views' parameters.
    pub covariance: DMatrix<f64>,
}

/// What is missing for an estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lacking {
    /// A view has fewer than six beads left.
    Beads { view: usize, used: usize },
    /// They do not decide a view.
    Decision { view: usize, used: usize },
}

/// Residuals below this are not rejected, px: exact input has no spread.
const LEAST_REJECT_PX: f64 = 0.02;
/// No spot is better than this, px.
const LEAST_SIGMA_PX: f64 = 1e-4;

/// The estimate near `start`.
pub(crate) fn estimate(
    start: &Arrangement,
    measured: &[Measured],
    reject_sigmas: f64,
    huber_px: f64,
) -> Result<Estimate, Lacking> {
    let views = start.views.len();
    let plain = Rules::default();
    let picked = |used: &[bool]| -> Vec<Observation> {
        measured.iter().zip(used).filter(|(_, u)| **u).map(|(m, _)| m.observation).collect()
    };
    let enough = |used: &[bool]| -> Result<(), Lacking> {
        for view in 0..views {
            let count = picked(used).iter().filter(|o| o.view == view).count();
            if count < 6 {
                return Err(Lacking::Beads { view, used: count });
            }
        }
        Ok(())
    };
    let undecided = |used: &[bool]| Lacking::Decision { view: 0, used: picked(used).len() };
    let mut used: Vec<bool> = measured.iter().map(|m| !m.cut).collect();
    enough(&used)?;
    let robust = Rules { huber_px: Some(huber_px), ..plain };
    let mut at = minimise(start, &picked(&used), &robust).ok_or(undecided(&used))?.at;
    for _ in 0..20 {
        let next = kept(&at, measured, reject_sigmas);
        enough(&next)?;
        at = minimise(&at, &picked(&next), &plain).ok_or(undecided(&next))?.at;
        if next == used {
            break;
        }
        used = next;
    }

    let mut observations = picked(&used);
    let noise: Vec<f64> = measured.iter().zip(&used).filter(|(_, u)| **u).map(|(m, _)| m.sigma_px).collect();
    let freedom = freedoms(&observations, views, start.frames.len());
    let mut fit = None;
    // The common parts settle in a few rounds: weights change the residuals little.
    for _ in 0..4 {
        for (view, freedom) in freedom.iter().enumerate() {
            weigh(&mut observations, &noise, &at, view, *freedom);
        }
        let next = minimise(&at, &observations, &plain).ok_or(undecided(&used))?;
        at = next.at.clone();
        fit = Some(next);
    }
    let fit = fit.ok_or(undecided(&used))?;
    let of_view = |view: usize| observations.iter().filter(move |o| o.view == view);
    for view in 0..views {
        let block = fit.normal.fixed_view::<VIEW, VIEW>(VIEW * view, VIEW * view).into_owned();
        if !is_decided(&block) {
            return Err(Lacking::Decision { view, used: of_view(view).count() });
        }
    }
    let all = inverse(&fit.normal).ok_or(undecided(&used))?;
    let sigma_px = (0..views)
        .map(|view| {
            let squares = of_view(view).filter_map(|o| at.residual(o)).map(|r| r.norm_squared()).sum::<f64>();
            (squares / freedom[view]).sqrt()
        })
        .collect();
    Ok(Estimate {
        residuals: measured.iter().map(|m| at.residual(&m.observation).unwrap_or_default()).collect(),
        covariance: all.view((0, 0), (VIEW * views, VIEW * views)).into_owned(),
        at,
        used,
        sigma_px,
        observations,
    })
}

/// Which beads count, by their residuals at an arrangement.
fn kept(at: &Arrangement, measured: &[Measured], reject_sigmas: f64) -> Vec<bool> {
    let length = |m: &Measured| at.residual(&m.observation).map_or(f64::INFINITY, |r| r.norm());
    let limits: Vec<f64> = (0..at.views.len())
        .map(|view| {
            let mut lengths: Vec<f64> =
                measured.iter().filter(|m| !m.cut && m.observation.view == view).map(length).collect();
            // A fit takes up its share of the noise.
            let n = 2.0 * lengths.len() as f64;
            let share = (n / (n - VIEW as f64).max(1.0)).sqrt();
            let spread = median(&mut lengths).unwrap_or_default() / RAYLEIGH_MEDIAN * share;
            (reject_sigmas * spread).max(LEAST_REJECT_PX)
        })
        .collect();
    measured.iter().map(|m| !m.cut && length(m) <= limits[m.observation.view]).collect()
}

/// Residual coordinates less unknowns, by view; unknowns of the bead frames are shared out by the number of beads.
fn freedoms(observations: &[Observation], views: usize, sets: usize) -> Vec<f64> {
    let shared = 6.0 * sets.saturating_sub(1) as f64 / observations.len().max(1) as f64;
    (0..views)
        .map(|view| {
            let n = observations.iter().filter(|o| o.view == view).count() as f64;
            (2.0 * n - VIEW as f64 - shared * n).max(1.0)
        })
        .collect()
}

/// Weights of one view's observations such that the weighted squares of its residuals sum to their degrees of freedom.
fn weigh(observations: &mut [Observation], noise: &[f64], at: &Arrangement, view: usize, freedom: f64) {
    let own: Vec<(f64, f64)> = observations
        .iter()
        .zip(noise)
        .filter(|(o, _)| o.view == view)
        .map(|(o, s)| {
            let s = if s.is_finite() { s.max(LEAST_SIGMA_PX) } else { LEAST_SIGMA_PX };
            (at.residual(o).map_or(0.0, |r| r.norm_squared()), s * s)
        })
        .collect();
    let sum = |common: f64| own.iter().map(|(square, s2)| square / (s2 + common)).sum::<f64>();
    let (common, factor) = if sum(0.0) <= freedom {
        // The spots' own figures suffice or are too large: all variances are taken smaller alike.
        (0.0, (sum(0.0) / freedom).max(1e-12))
    } else {
        let (mut low, mut high) = (0.0, own.iter().map(|(square, _)| square).sum::<f64>() / freedom);
        for _ in 0..100 {
            let middle = (low + high) / 2.0;
            if sum(middle) > freedom { low = middle } else { high = middle }
        }
        ((low + high) / 2.0, 1.0)
    };
    let variances: Vec<f64> = own.iter().map(|(_, s2)| (s2 + common) * factor).collect();
    for (o, v) in observations.iter_mut().filter(|o| o.view == view).zip(variances) {
        o.weight = 1.0 / v;
    }
}

/// Whether the nine parameters of a view can be told apart: its normal matrix, diagonal scaled to one, is not singular.
fn is_decided(block: &SMatrix<f64, VIEW, VIEW>) -> bool {
    let scale = block.diagonal().map(|v| if v > 0.0 { 1.0 / v.sqrt() } else { 0.0 });
    let scaled = SMatrix::<f64, VIEW, VIEW>::from_fn(|i, j| block[(i, j)] * scale[i] * scale[j]);
    scaled.iter().all(|v| v.is_finite()) && scaled.symmetric_eigenvalues().min() > 1e-13
}
