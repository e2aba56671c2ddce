//! The stage `match`: the curves of a frame's views, their calibrations, a body's mesh and a start in; its pose out.

use std::sync::Arc;

use biplane_artifact::{Calibration, CalibrationUncertainty, Curves, Match, ModelMesh, Start, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::Pose;
use biplane_objective::{Body, DistanceField, Kind};
use biplane_outline::{RimMesh, RimWithoutCutEnds};
use biplane_silhouette::SilhouetteLibrary;
use biplane_stage::{Context, Hashed, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::answer::{answer_of, best_end, with_calibration};
use crate::consistency::outline_sigma_of_calibration;
use crate::refine::{Buffers, LEAST_SCALE_PX, refine_with};
use crate::search::{SearchParams, match_search, mm_per_px, targets};
use crate::{
    BiasParams, BinghamParams, BinghamView, EdgeField, Limits, RefineParams, Refined, View, judge,
    match_bingham, own_contour, starts, take_out,
};

inputs! {
    /// One body in one frame, seen in any number of views.
    pub struct MatchInputs {
        /// One a view.
        curves: [Curves],
        /// One a view, in the same order.
        calibrations: [Calibration],
        /// The body.
        model: ModelMesh,
        /// Where to start; empty where nobody says: then starts are looked for anywhere.
        start: [Start],
        /// How sure the calibrations are, all together; empty where nothing is known of it.
        calibration_uncertainty: [CalibrationUncertainty],
    }
}

/// Whether a body is darker or brighter than what surrounds it in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Contrast {
    /// As X-rays make bone and metal where larger grey levels mean more radiation.
    Dark,
    /// The other way round.
    Bright,
}

/// Which objective and optimiser find the pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// The exact rim of the mesh against edges of its direction, by Levenberg and Marquardt.
    Rim,
    /// The thesis's own: outline on a grid, mean distance from the contour, bounded BFGS from ten starts.
    Bingham2006,
    /// Any objective by any optimiser.
    Search,
}

/// What is taken for the distance of edges from the outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum EdgeBias {
    /// At the end it is predicted from the body's chords behind each rim, with attenuation and blur as the edges tell them.
    Predicted,
    /// One inset a view, the same all along the outline.
    Constant,
    /// Nothing.
    None,
}

/// Steps of a descent with its last search radius at most; most need five to ten.
const FINAL_STEPS: u32 = 30;

/// The robust weight's scale is at least so many times what an unsure calibration makes of outlines: such residuals are shared by whole
/// views, and where the larger of them count as outliers the body turns to where the others agree. Chosen on the draws of
/// `wrong_calibrations_drawn_at_random_move_poses_as_much_as_is_stated`, whose variances it brings within 36 % of those stated; fresh draws
/// are in `cargo xtask validate --only coverage`.
const SURE: f64 = 6.0;
/// Edges are looked for that many times as far as an unsure calibration moves outlines: what is left out beyond pulls on the body too.
const WIDE: f64 = 5.0;
/// Poses that are tried where a body is looked for anywhere.
const CANDIDATES: usize = 16;

/// A pose that is turned from a given start by more than this is not the one that is meant, rad.
const START_DECIDES: f64 = 0.6;

/// Ends nearer than this to the best are the same pose: the centroid's displacement, mm, and the rotation, rad.
const SAME: (f64, f64) = (0.5, 0.02);

/// How poses are searched and judged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MatchParams {
    /// How poses are found: `"rim"`; or, slower and less sure, to compare with: `"bingham2006"`, the thesis's own method, and `"search"`, any
    /// objective by any optimiser (`[match.search]`).
    pub method: Method,
    /// How far from its start an outline looks for edges, px. As far as starts are wrong, and no farther.
    #[schemars(range(min = 1.0, max = 500.0))]
    pub search_px: f64,
    /// How far from the outline an edge may lie at the end to count as found, px.
    #[schemars(range(min = 0.5, max = 50.0))]
    pub final_search_px: f64,
    /// By how much the image's edges lie inside the outline as a whole, as the rim of a smooth body and smoothing make
    /// them, px (1 sigma). It is solved for in each view beside the pose; 0 holds it at zero.
    #[schemars(range(min = 0.0, max = 20.0))]
    pub inset_px: f64,
    /// How far inside the outline X-rays show the edges of a body: `"predicted"` from its shape, rim by rim, once the pose is nearly found;
    /// `"constant"` for one inset a view, `"none"` for none at all.
    pub edge_bias: EdgeBias,
    /// With `edge_bias = "predicted"`: how much more bodies attenuate X-rays than what they stand in, 1/mm (bone about 0.06, titanium 0.5,
    /// cobalt-chrome 1.8). Without it, each body's is found from its edges.
    #[schemars(range(min = 0.001, max = 20.0))]
    pub attenuation_per_mm: Option<f64>,
    /// With `edge_bias = "predicted"`: about how much pictures and `smoothing_px` blur edges together, px (1 sigma); how much exactly, is
    /// found from the edges.
    #[schemars(range(min = 0.3, max = 2.8))]
    pub blur_px: f64,
    /// A search ends when a step moves the body by less than this, mm.
    #[schemars(range(min = 1e-9, max = 1.0))]
    pub still_mm: f64,
    /// `"dark"`, or `"bright"` if bodies are brighter than their surroundings.
    pub contrast: Contrast,
    /// Further starts around the given one, tried while no match is good.
    #[schemars(range(max = 1000))]
    pub retries: usize,
    /// Standard deviation of the further starts, mm.
    pub retry_mm: f64,
    /// Standard deviation of the further starts, degrees.
    pub retry_deg: f64,
    /// Seed of the further starts.
    pub seed: u64,
    /// Whether a body may be looked for anywhere, by the shapes of its shadows: where no start is given, and where none around the
    /// given one leads to a good pose. Not with `method = "bingham2006"`, which needs a start.
    pub anywhere: bool,
    /// A pose is good if at least this share of its outline finds an edge in each view. Right poses had 0.81 or more on the
    /// simulated and the real knee, wrong ones (from starts turned by 45 to 180 degrees) up to 0.82, but then an rms of
    /// 0.89 px: it takes both limits, and that of the rotation, to tell them apart.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub good_share: f64,
    /// It has failed if less than this share does in any view.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub failed_share: f64,
    /// A pose is good if its root mean square residual is at most this in each view, px. Right poses had at most 0.64.
    pub good_rms_px: f64,
    /// It has failed above this in any view, px.
    pub failed_rms_px: f64,
    /// A pose is good if its centroid is known to this, mm (1 sigma).
    pub good_sigma_mm: f64,
    /// and its rotation to this, degrees (1 sigma). Wrong poses that fitted nearly as well as right ones had 0.86 or more.
    pub good_sigma_deg: f64,
    /// Settings of the thesis's own method.
    pub bingham2006: BinghamParams,
    /// Settings of a search by any objective and optimiser.
    pub search: SearchParams,
    /// Whether the body's flat ends, where its volume was cut, are no outline. Each body's own: `[[body]]` says it.
    #[schemars(skip)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub ignore_cut_ends: bool,
}

impl Default for MatchParams {
    fn default() -> Self {
        Self {
            method: Method::Rim,
            search_px: 40.0,
            final_search_px: 3.0,
            inset_px: 1.0,
            edge_bias: EdgeBias::Predicted,
            attenuation_per_mm: None,
            blur_px: 1.6,
            still_mm: 2e-4,
            contrast: Contrast::Dark,
            retries: 12,
            retry_mm: 4.0,
            retry_deg: 4.0,
            seed: 1,
            anywhere: true,
            good_share: 0.75,
            failed_share: 0.5,
            good_rms_px: 0.75,
            failed_rms_px: 2.0,
            good_sigma_mm: 0.5,
            good_sigma_deg: 0.75,
            bingham2006: BinghamParams::default(),
            search: SearchParams::default(),
            ignore_cut_ends: false,
        }
    }
}

/// Why a match could not be tried. (A match that was tried and failed is a [`Match`] with that verdict.)
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MatchError {
    /// A parameter out of range.
    #[error("[match] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A parameter of `[track]` out of range.
    #[error("[track] {name} = {value}, expected {expected}")]
    TrackParameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// Curves and calibrations are not one a view.
    #[error(
        "{curves} views with curves but {calibrations} calibrations: expected one of each a view, and at least one"
    )]
    Views {
        /// Sets of curves.
        curves: usize,
        /// Calibrations.
        calibrations: usize,
    },
    /// There is no start, and none may be looked for.
    #[error(
        "no start pose: give one in edits/poses.csv or in a table named by `starts` of the trial, or let bodies be looked for with \
         [match] method = \"rim\" and anywhere = true"
    )]
    NoStart,
    /// The optimiser cannot search the objective.
    #[error(
        "[match.search] optimiser = \"{optimiser}\" needs derivatives, which objective = \"{objective}\" has not: take another optimiser, or \
         \"spline_rim\" for an objective"
    )]
    Optimiser {
        /// The objective.
        objective: &'static str,
        /// The optimiser.
        optimiser: &'static str,
    },
    /// The run was stopped.
    #[error("stopped")]
    Cancelled,
}

impl MatchParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), MatchError> {
        let Self {
            method: _,
            search_px,
            final_search_px,
            inset_px,
            edge_bias: _,
            attenuation_per_mm,
            blur_px,
            still_mm,
            contrast: _,
            retries,
            retry_mm,
            retry_deg,
            seed: _,
            anywhere: _,
            good_share,
            failed_share,
            good_rms_px,
            failed_rms_px,
            good_sigma_mm,
            good_sigma_deg,
            bingham2006,
            search,
            ignore_cut_ends: _,
        } = *self;
        let within = |name, value: f64, low: f64, high: f64, expected| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                Err(MatchError::Parameter { name, value, expected })
            }
        };
        let any = f64::MAX;
        within("search_px", search_px, 1.0, 500.0, "1 to 500 px")?;
        within("final_search_px", final_search_px, 0.5, 50.0, "0.5 to 50 px")?;
        within("inset_px", inset_px, 0.0, 20.0, "0 to 20 px")?;
        within("attenuation_per_mm", attenuation_per_mm.unwrap_or(1.0), 0.001, 20.0, "0.001 to 20 per mm")?;
        within("blur_px", blur_px, 0.3, 2.8, "0.3 to 2.8 px")?;
        within("still_mm", still_mm, 1e-9, 1.0, "1e-9 to 1 mm")?;
        within("retries", retries as f64, 0.0, 1000.0, "0 to 1000")?;
        within("retry_mm", retry_mm, 0.0, 1000.0, "0 to 1000 mm")?;
        within("retry_deg", retry_deg, 0.0, 180.0, "0 to 180 degrees")?;
        within("good_share", good_share, 0.0, 1.0, "0 to 1")?;
        within("failed_share", failed_share, 0.0, good_share, "0 to good_share")?;
        within("good_rms_px", good_rms_px, 0.0, any, "0 or more px")?;
        within("failed_rms_px", failed_rms_px, good_rms_px, any, "at least good_rms_px")?;
        within("good_sigma_mm", good_sigma_mm, 0.0, any, "0 or more mm")?;
        within("good_sigma_deg", good_sigma_deg, 0.0, any, "0 or more degrees")?;
        bingham2006.check()?;
        search.check()
    }

    /// How a descent searches.
    pub fn search(&self) -> RefineParams {
        RefineParams {
            search_px: self.search_px,
            final_search_px: self.final_search_px,
            contrast: match self.contrast {
                Contrast::Dark => 1.0,
                Contrast::Bright => -1.0,
            },
            inset_px: if self.edge_bias == EdgeBias::None { 0.0 } else { self.inset_px },
            still_mm: self.still_mm,
            most_steps: FINAL_STEPS,
            least_scale_px: LEAST_SCALE_PX,
        }
    }

    /// What is known of the edges' bias, if it is to be predicted.
    pub fn bias(&self) -> Option<BiasParams> {
        let params = BiasParams { attenuation_per_mm: self.attenuation_per_mm, blur_px: self.blur_px };
        (self.edge_bias == EdgeBias::Predicted && self.inset_px > 0.0).then_some(params)
    }

    pub(crate) fn limits(&self) -> Limits {
        Limits {
            matched_share: (self.good_share, self.failed_share),
            rms_px: (self.good_rms_px, self.failed_rms_px),
            sigma: (self.good_sigma_mm, self.good_sigma_deg.to_radians()),
        }
    }
}

/// Matches one body, seen in `views` named `names`, from `start`, and from starts around it while no match is good.
///
/// # Errors
/// Only [`MatchError::Cancelled`], when `cancelled` says so between two starts.
pub fn match_body(
    mesh: &RimMesh,
    views: &[View],
    names: &[String],
    start: &Pose,
    params: &MatchParams,
    cancelled: impl Fn() -> bool,
) -> Result<Match, MatchError> {
    match_anywhere(mesh, (views, names), None, Some(start), Vec::new, params, cancelled)
}

/// As [`match_body`]; where no match from around the start is good, or there is none, also from each of the poses that `anywhere` gives,
/// and around the best of them. `uncertainty` is that of the views' calibrations, if anything is known of it: what it makes of residuals is
/// then not taken for outliers, and it is in the covariance.
///
/// # Errors
/// [`MatchError::NoStart`] where there is neither a start nor a pose to begin with; [`MatchError::Cancelled`], when `cancelled` says so
/// between two starts.
pub fn match_anywhere(
    mesh: &RimMesh,
    (views, names): (&[View], &[String]),
    uncertainty: Option<&CalibrationUncertainty>,
    start: Option<&Pose>,
    anywhere: impl FnOnce() -> Vec<Pose>,
    params: &MatchParams,
    cancelled: impl Fn() -> bool,
) -> Result<Match, MatchError> {
    let (search, limits) = (params.search(), params.limits());
    let mut ends: Vec<Refined> = Vec::new();
    let mut buffers = Buffers::default();
    let good = |ends: &[Refined]| best_end(ends).is_some_and(|e| judge(e, names, &limits).1 == Verdict::Good);
    let mut descend = |from: &Pose, ends: &mut Vec<Refined>| {
        if cancelled() {
            return Err(MatchError::Cancelled);
        }
        ends.push(refine_with(mesh, views, from, &search, &mut buffers));
        Ok(())
    };
    let around = |from: &Pose| {
        let sigma_rad = params.retry_deg.to_radians();
        starts::around(from, mesh.centroid(), params.retry_mm, sigma_rad, params.seed, params.retries)
    };
    if let Some(start) = start {
        for from in std::iter::once(*start).chain(around(start)) {
            if good(&ends) {
                break;
            }
            descend(&from, &mut ends)?;
        }
    }
    if !good(&ends) {
        let before = ends.len();
        for from in anywhere() {
            descend(&from, &mut ends)?;
        }
        // All are tried, so that two places that cannot be told apart are seen; around the best of them as around a start.
        let best = best_end(&ends[before..]).map(|end| end.pose);
        for from in best.iter().flat_map(around) {
            if good(&ends) {
                break;
            }
            descend(&from, &mut ends)?;
        }
    }
    if good(&ends)
        && let Some(best) = best_end(&ends).map(|end| end.pose)
    {
        // What looks nearly alike from elsewhere is held against it, unless a start says that it is not there.
        let meant =
            |pose: &Pose| start.is_none_or(|s| s.rotation().angle_to(&pose.rotation()) < START_DECIDES);
        let alike = mesh.looks_alike(&best, views.iter().map(|view| &view.fluoroscope));
        for from in alike.iter().filter(|pose| meant(pose)) {
            descend(from, &mut ends)?;
        }
    }
    let best = best_end(&ends).map(|end| end.pose);
    let same = |end: &Refined, as_one: &Pose| {
        let away = end.pose.error_against(as_one, mesh.centroid());
        away.translation_mm < SAME.0 && away.rotation_rad < SAME.1
    };
    if let Some((known, best)) = uncertainty.zip(best) {
        let unsure = outline_sigma_of_calibration(mesh, views, &best, known, &search);
        let least_scale_px = SURE * unsure.unwrap_or_default();
        if least_scale_px > search.least_scale_px {
            let final_search_px = search.final_search_px.max(WIDE * unsure.unwrap_or_default());
            let settled =
                RefineParams { search_px: final_search_px, final_search_px, least_scale_px, ..search };
            for end in ends.iter_mut().filter(|end| same(end, &best)) {
                let steps = end.steps;
                *end = refine_with(mesh, views, &end.pose, &settled, &mut buffers);
                end.steps += steps;
            }
        }
    }
    if let Some((bias, best)) = params.bias().zip(best_end(&ends).map(|end| end.pose)) {
        for end in &mut ends {
            if same(end, &best) {
                let verdict = |of: &Refined| judge(of, names, &limits).1;
                // A pose that fits is not given for one that does not.
                let free = take_out(mesh, views, end, &search, &bias);
                if let Some(free) = free.filter(|free| verdict(free) <= verdict(end)) {
                    *end = free;
                }
            }
        }
    }
    let steps = ends.iter().map(|end| end.steps).sum();
    let found = answer_of(&ends, mesh, names, &limits, steps).ok_or(MatchError::NoStart)?;
    Ok(match uncertainty {
        None => found,
        Some(uncertainty) => with_calibration(found, mesh, views, uncertainty, &search),
    })
}

/// The body's rim, as the parameters want it.
pub fn prepared_rim(inputs: &MatchInputs, params: &MatchParams, context: &Context) -> Arc<RimMesh> {
    let (model, hash) = (&inputs.model.0, inputs.model.hash());
    if params.ignore_cut_ends {
        Arc::clone(&context.prepared(hash, || RimWithoutCutEnds::new(model)).0)
    } else {
        context.prepared(hash, || RimMesh::new(model))
    }
}

/// Fluoroscope and edges of each view.
pub(crate) fn views_of(curves: &[Hashed<Curves>], calibrations: &[Hashed<Calibration>]) -> Vec<View> {
    let of = |(curves, calibration): (&Hashed<Curves>, &Hashed<Calibration>)| {
        let fluoroscope = Fluoroscope::from(&**calibration);
        View { edges: EdgeField::new(curves, fluoroscope.distortion()), fluoroscope }
    };
    curves.iter().zip(calibrations).map(of).collect()
}

/// The stage `match`.
#[derive(Debug, Clone, Copy)]
pub struct MatchBody;

impl Stage for MatchBody {
    const NAME: &'static str = "match";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = MatchInputs;
    type Params = MatchParams;
    type Output = Match;
    type Error = MatchError;

    fn run(inputs: &MatchInputs, params: &MatchParams, context: &Context) -> Result<Match, MatchError> {
        params.check()?;
        let (curves, calibrations) = (inputs.curves.len(), inputs.calibrations.len());
        if curves != calibrations || curves == 0 {
            return Err(MatchError::Views { curves, calibrations });
        }
        let mesh = prepared_rim(inputs, params, context);
        let views = views_of(&inputs.curves, &inputs.calibrations);
        let names: Vec<String> = inputs.calibrations.iter().map(|c| c.view.clone()).collect();
        let start = inputs.start.first().map(|start| &start.0);
        let uncertainty = inputs.calibration_uncertainty.first().map(|known| &**known);
        let of = (views.as_slice(), names.as_slice());
        let found = match params.method {
            Method::Rim => {
                let anywhere = || candidates(inputs, &views, params, context);
                let cancelled = || context.cancelled();
                return match_anywhere(&mesh, of, uncertainty, start, anywhere, params, cancelled);
            }
            Method::Bingham2006 => {
                let start = start.ok_or(MatchError::NoStart)?;
                let contours: Vec<BinghamView> = inputs
                    .curves
                    .iter()
                    .zip(&views)
                    .map(|(curves, View { fluoroscope, .. })| {
                        let own = own_contour(curves, &mesh, fluoroscope, start, params);
                        BinghamView::new(fluoroscope.clone(), &own, mm_per_px(fluoroscope, &mesh, start))
                    })
                    .collect();
                let points = inputs.model.0.vertices();
                match_bingham(points, &contours, &mesh, of, start, params, || context.cancelled())
            }
            Method::Search => {
                let start = start.ok_or(MatchError::NoStart)?;
                let field = || context.prepared(inputs.model.hash(), || DistanceField::new(&inputs.model.0));
                let field = (params.search.objective == Kind::InversePoint).then(field);
                let body = Body { mesh: &inputs.model.0, rim: &mesh, field };
                let targets = targets(inputs, &mesh, &views, start, params);
                match_search(&body, &targets, (&views, &names), start, params, || context.cancelled())
            }
        }?;
        Ok(match uncertainty {
            None => found,
            Some(uncertainty) => with_calibration(found, &mesh, &views, uncertainty, &params.search()),
        })
    }
}

/// Poses at which the body may be, by the shapes of its shadows, if it may be looked for.
fn candidates(inputs: &MatchInputs, views: &[View], params: &MatchParams, context: &Context) -> Vec<Pose> {
    if !params.anywhere {
        return Vec::new();
    }
    let library = context.prepared(inputs.model.hash(), || SilhouetteLibrary::new(&inputs.model.0));
    let shadows: Vec<(&Fluoroscope, &Curves)> =
        views.iter().map(|v| &v.fluoroscope).zip(inputs.curves.iter().map(|c| &**c)).collect();
    library
        .starts(&shadows, params.search().contrast, CANDIDATES)
        .into_iter()
        .map(|candidate| candidate.pose)
        .collect()
}
