//! `method = "search"`: any objective by any optimiser from so many starts.
//!
//! The objectives are those of `biplane-objective`, the optimisers those of `biplane-optimiser`; what is searched are the curves that may be the
//! body's at the start ([`own_contour`](crate::own_contour)), as for the thesis's own method. Each start is searched in the objective's stages, one after
//! the other; the lowest objective among the searches that came to rest is the answer, judged as that of any other method.
//!
//! **The scale that does best**, of `symmetric` by `levenberg_marquardt`: `biplane compare pipeline.toml --body femoral_component --reference
//! fixtures/knee/truth/femoral_component_world_from_model.csv --objectives symmetric --optimisers levenberg_marquardt --no-presets --frames 4`
//! (and `--body tray`), with `start_sigma_mm` and `start_sigma_deg` 10, 40 searches each. Errors of answers are medians, hardly changed by any of these.
//!
//! | `wide_px`, `stages`, `partner_px` | femoral component: right | error, mm / degrees | calls | tray: right | error, mm / degrees | calls |
//! |---|---|---|---|---|---|---|
//! | 10, 3, 40 | 70 % | 0.016 / 0.049 | 46 | 52 % | 0.021 / 0.109 | 53 |
//! | 20, 4, 60 | 92 % | 0.016 / 0.048 | 30 | 85 % | 0.021 / 0.120 | 47 |
//! | 40, 3, 120 | 98 % | 0.016 / 0.050 | 25 | 100 % | 0.021 / 0.109 | 38 |
//! | **80, 4, 200** | **100 %** | **0.016 / 0.049** | **26** | **100 %** | **0.021 / 0.109** | **41** |
//!
//! `biplane compare` runs the same searches one by one ([`Single`]) and prints what came of them, those of `method = "rim"` and `"bingham2006"` beside
//! them.

use std::sync::Arc;

use biplane_artifact::{Curves, Match, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose};
use biplane_objective::{Body, DistanceField, Kind, Objective, Settings, Target, Variables};
use biplane_optimiser::{Function, Optimiser, Row, Search};
use biplane_outline::RimMesh;
use nalgebra::Vector6;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::answer::{Searched, answer, starts_tried};
use crate::starts::normal;
use crate::{
    BinghamView, MatchError, MatchInputs, MatchParams, Method, RefineParams, View, assess, descend, judge,
    own_contour, refine,
};

/// `[match.search]`: which objective, which optimiser, from which starts. They count with `method = "search"` alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SearchParams {
    /// What is minimised.
    pub objective: Kind,
    /// What minimises it.
    pub optimiser: Optimiser,
    /// Starts all together: the one given, and Gaussian ones around it.
    #[schemars(range(min = 1, max = 1000))]
    pub starts: usize,
    /// Standard deviation of the starts in x, y and z each, mm.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub start_sigma_mm: f64,
    /// Standard deviation of the starts in each component of the rotation vector, degrees.
    #[schemars(range(min = 0.0, max = 180.0))]
    pub start_sigma_deg: f64,
    /// No offset of a start is larger than this many standard deviations.
    #[schemars(range(min = 0.1, max = 100.0))]
    pub start_cut_sigma: f64,
    /// Seed of the starts, and of optimisers that draw.
    pub seed: u64,
    /// How far from its start a search may go in x, y and z each, mm.
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub bound_mm: f64,
    /// How far from its start a search may go in each component of the rotation vector, degrees.
    #[schemars(range(min = 0.001, max = 180.0))]
    pub bound_deg: f64,
    /// Calls of the objective from one start after which a search has not converged. The thesis allows 800; swarm, annealing and
    /// genetic search need thousands.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub calls: usize,
    /// A search has converged when every variable changes by less than this, mm; rotations count at the body's radius of gyration.
    #[schemars(range(min = 0.000_000_001, max = 1.0))]
    pub tolerance_mm: f64,
    /// Step of finite differences at first, mm.
    #[schemars(range(min = 0.000_001, max = 10.0))]
    pub first_difference_mm: f64,
    /// Step of finite differences at the end, mm.
    #[schemars(range(min = 0.000_001, max = 10.0))]
    pub last_difference_mm: f64,
    /// First steps of optimisers without derivatives and the spread of first populations, mm.
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub reach_mm: f64,
    /// Distance of points along outlines and along the picture's curves, px.
    #[schemars(range(min = 0.5, max = 100.0))]
    pub spacing_px: f64,
    /// Points of the grid outline, of objective `"spline_grid"`.
    #[schemars(range(min = 2, max = 100_000))]
    pub outline_points: usize,
    /// Cells along the shorter side of the projected body, of objective `"spline_grid"`.
    #[schemars(range(min = 2, max = 1000))]
    pub grid: usize,
    /// How far robust objectives look for a partner, px.
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub partner_px: f64,
    /// Scale of robust objectives in the first stage, px: residuals well above it count little.
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub wide_px: f64,
    /// Scale of robust objectives in the last stage, px.
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub fine_px: f64,
    /// Stages of robust objectives from wide to fine.
    #[schemars(range(min = 1, max = 20))]
    pub stages: usize,
}

impl Default for SearchParams {
    fn default() -> Self {
        Self {
            objective: Kind::Symmetric,
            optimiser: Optimiser::LevenbergMarquardt,
            starts: 10,
            start_sigma_mm: 4.0,
            start_sigma_deg: 4.0,
            start_cut_sigma: 2.0,
            seed: 1,
            bound_mm: 40.0,
            bound_deg: 40.0,
            calls: 800,
            tolerance_mm: 0.0005,
            first_difference_mm: 0.5,
            last_difference_mm: 0.02,
            reach_mm: 8.0,
            spacing_px: 3.0,
            outline_points: 50,
            grid: 30,
            partner_px: 200.0,
            wide_px: 80.0,
            fine_px: 1.0,
            stages: 4,
        }
    }
}

impl SearchParams {
    /// # Errors
    /// Names the first parameter that is out of its range, and an optimiser that cannot search the objective.
    pub fn check(&self) -> Result<(), MatchError> {
        let Self {
            objective,
            optimiser,
            starts,
            start_sigma_mm,
            start_sigma_deg,
            start_cut_sigma,
            seed: _,
            bound_mm,
            bound_deg,
            calls,
            tolerance_mm,
            first_difference_mm,
            last_difference_mm,
            reach_mm,
            spacing_px,
            outline_points,
            grid,
            partner_px,
            wide_px,
            fine_px,
            stages,
        } = *self;
        let within = |name, value: f64, low: f64, high: f64, expected| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                Err(MatchError::Parameter { name, value, expected })
            }
        };
        let count = |name, value: usize, low, high, expected| within(name, value as f64, low, high, expected);
        let step = "0.000001 to 10 mm";
        count("search.starts", starts, 1.0, 1e3, "1 to 1000")?;
        within("search.start_sigma_mm", start_sigma_mm, 0.0, 1e3, "0 to 1000 mm")?;
        within("search.start_sigma_deg", start_sigma_deg, 0.0, 180.0, "0 to 180 degrees")?;
        within("search.start_cut_sigma", start_cut_sigma, 0.1, 100.0, "0.1 to 100")?;
        within("search.bound_mm", bound_mm, 0.001, 1e3, "0.001 to 1000 mm")?;
        within("search.bound_deg", bound_deg, 0.001, 180.0, "0.001 to 180 degrees")?;
        count("search.calls", calls, 1.0, 1e6, "1 to 1000000")?;
        within("search.tolerance_mm", tolerance_mm, 1e-9, 1.0, "0.000000001 to 1 mm")?;
        within("search.first_difference_mm", first_difference_mm, 1e-6, 10.0, step)?;
        let expected = "0.000001 mm to first_difference_mm";
        within("search.last_difference_mm", last_difference_mm, 1e-6, first_difference_mm, expected)?;
        within("search.reach_mm", reach_mm, 0.001, 1e3, "0.001 to 1000 mm")?;
        within("search.spacing_px", spacing_px, 0.5, 100.0, "0.5 to 100 px")?;
        count("search.outline_points", outline_points, 2.0, 1e5, "2 to 100000")?;
        count("search.grid", grid, 2.0, 1e3, "2 to 1000")?;
        within("search.partner_px", partner_px, 1.0, 1e3, "1 to 1000 px")?;
        within("search.wide_px", wide_px, 0.1, 1e3, "0.1 to 1000 px")?;
        within("search.fine_px", fine_px, 0.1, wide_px, "0.1 px to wide_px")?;
        count("search.stages", stages, 1.0, 20.0, "1 to 20")?;
        if optimiser == Optimiser::LevenbergMarquardt && !objective.has_rows() {
            return Err(MatchError::Optimiser { objective: objective.name(), optimiser: optimiser.name() });
        }
        Ok(())
    }

    /// The start poses: `start` itself, then Gaussian ones around it, turned about the point `centroid` (model, mm).
    pub fn starts(&self, start: &Pose, centroid: &Point3) -> Vec<Pose> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(self.seed);
        let variables = Variables::new(start, centroid, 1.0);
        let mut offset = |sigma: f64| {
            // Drawn again where it is cut: even at a tenth of a standard deviation one of thirteen is kept.
            let drawn = std::iter::repeat_with(|| normal(&mut random));
            sigma * drawn.take(10_000).find(|n| n.abs() <= self.start_cut_sigma).unwrap_or(0.0)
        };
        let (mm, rad) = (self.start_sigma_mm, self.start_sigma_deg.to_radians());
        let others = (1..self.starts)
            .map(|_| variables.pose(&Vector6::from_fn(|i, _| offset(if i < 3 { mm } else { rad }))));
        std::iter::once(*start).chain(others).collect()
    }

    /// The contrast and inset are those of the other methods.
    fn settings(&self, common: &RefineParams) -> Settings {
        Settings {
            contrast: common.contrast,
            inset_px: common.inset_px,
            spacing_px: self.spacing_px,
            outline_points: self.outline_points,
            grid: self.grid,
            reach_px: self.partner_px,
            wide_px: self.wide_px,
            fine_px: self.fine_px,
            stages: self.stages,
        }
    }
}

/// Tolerance of all stages but the last, mm.
const COARSE_MM: f64 = 0.02;

/// Where one search ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ended {
    /// The pose.
    pub pose: Pose,
    /// The objective there; compares with others of the same method and views alone.
    pub objective: f64,
    /// Calls of the objective; steps of `method = "rim"`.
    pub calls: usize,
    /// Whether it came to rest.
    pub converged: bool,
}

/// An objective as a function of six variables about a start.
struct About<'a, 'o> {
    objective: &'a mut (dyn Objective + 'o),
    variables: Variables,
}

impl Function for About<'_, '_> {
    fn value(&mut self, at: &Vector6<f64>) -> f64 {
        self.objective.value(&self.variables.pose(at))
    }

    fn linearise(&mut self, at: &Vector6<f64>, rows: &mut Vec<Row>) -> Option<f64> {
        let value = self.objective.linearise(&self.variables.pose(at), rows)?;
        self.variables.chain(at, rows);
        Some(value)
    }
}

/// One search from `from`, in all stages of the objective; the calls are those of all stages together.
fn search_from(objective: &mut dyn Objective, rim: &RimMesh, from: &Pose, params: &SearchParams) -> Ended {
    let variables = Variables::new(from, rim.centroid(), rim.radius_of_gyration());
    let (mm, turned) = (params.bound_mm, params.bound_deg.to_radians() * variables.arm_mm());
    let bound = Vector6::new(mm, mm, mm, turned, turned, turned);
    let mut search = Search {
        low: -bound,
        high: bound,
        tolerance: params.tolerance_mm,
        calls: params.calls,
        first_difference: params.first_difference_mm,
        last_difference: params.last_difference_mm,
        reach: params.reach_mm,
        seed: params.seed,
    };
    let mut about = About { objective, variables };
    let mut at = Vector6::zeros();
    let mut ended = Ended { pose: *from, objective: f64::MAX, calls: 0, converged: false };
    let stages = about.objective.stages();
    for stage in 0..stages {
        about.objective.enter(stage);
        search.calls = params.calls - ended.calls;
        // What a later stage finds better need not be found finely.
        let last = stage + 1 == stages;
        search.tolerance = params.tolerance_mm.max(if last { 0.0 } else { COARSE_MM });
        search.last_difference = if last { params.last_difference_mm } else { params.first_difference_mm };
        // Checked with the parameters: an optimiser that needs rows has an objective with rows.
        let Ok(found) = params.optimiser.minimise(&mut about, &at, &search) else { return ended };
        at = found.at;
        ended.objective = found.value;
        ended.calls += found.calls;
        ended.converged = found.converged;
        // Later populations are about what was found.
        search.reach = (search.reach / 2.0).max(params.tolerance_mm);
    }
    ended.pose = variables.pose(&at);
    ended
}

/// What the curves of each view that may be the body's at `start` are to an objective.
pub(crate) fn targets(
    inputs: &MatchInputs,
    rim: &RimMesh,
    views: &[View],
    start: &Pose,
    params: &MatchParams,
) -> Vec<Target> {
    let of = |(curves, view): (&Curves, &View)| {
        let fluoroscope = &view.fluoroscope;
        let own = own_contour(curves, rim, fluoroscope, start, params);
        Target::new(fluoroscope.clone(), &own, mm_per_px(fluoroscope, rim, start))
    };
    inputs.curves.iter().map(|c| &**c).zip(views).map(of).collect()
}

/// Millimetres of a pixel at the depth of the body where it starts; behind the source nothing is seen anyway.
pub(crate) fn mm_per_px(fluoroscope: &Fluoroscope, rim: &RimMesh, start: &Pose) -> f64 {
    fluoroscope.project(&start.transform(rim.centroid())).map_or(1.0, |p| fluoroscope.mm_per_px(p.depth))
}

/// Matches one body by [`MatchParams::search`]. Where its objective cannot be made of the curves, that is the reason of a failed match.
///
/// # Errors
/// Only [`MatchError::Cancelled`], when `cancelled` says so between two starts.
pub(crate) fn match_search(
    body: &Body<'_>,
    targets: &[Target],
    (views, names): (&[View], &[String]),
    start: &Pose,
    params: &MatchParams,
    cancelled: impl Fn() -> bool,
) -> Result<Match, MatchError> {
    let own = &params.search;
    let search = params.search();
    let mut ends = Vec::with_capacity(own.starts);
    let made = own.objective.of(body, targets, &own.settings(&search));
    let unmade = made.as_ref().err().map(ToString::to_string);
    if let Ok(mut objective) = made {
        for from in own.starts(start, body.rim.centroid()) {
            if cancelled() {
                return Err(MatchError::Cancelled);
            }
            ends.push(search_from(objective.as_mut(), body.rim, &from, own));
        }
    }
    let none = Ended { pose: *start, objective: f64::MAX, calls: 0, converged: false };
    let best = lowest(&ends).unwrap_or(none);
    let assessed = assess(body.rim, views, &best.pose, &search);
    let (fits, mut verdict, mut reason) = judge(&assessed, names, &params.limits());
    let mut find = |worse: Verdict, what: String| {
        verdict = verdict.max(worse);
        reason = if reason.is_empty() { what } else { format!("{what}; {reason}") };
    };
    match unmade {
        Some(why) => find(Verdict::Failed, why),
        None if !best.converged => find(
            Verdict::Doubtful,
            format!("did not converge: {} calls from each of {} starts", own.calls, ends.len()),
        ),
        None => {}
    }
    let calls: usize = ends.iter().map(|e| e.calls).sum();
    let rested: Vec<Pose> = ends.iter().filter(|e| e.converged).map(|e| e.pose).collect();
    let searched = Searched {
        objective: best.objective,
        iterations: u32::try_from(calls).unwrap_or(u32::MAX),
        starts: starts_tried(ends.len(), &rested, body.rim.centroid()),
        alternative: None,
    };
    Ok(answer(&assessed, (fits, verdict, reason), searched))
}

/// The lowest objective among searches that came to rest; among all of them, where none did.
pub fn lowest(ends: &[Ended]) -> Option<Ended> {
    let least = |only: bool| {
        let counting = ends.iter().filter(|e| e.converged || !only);
        counting.min_by(|a, b| a.objective.total_cmp(&b.objective)).copied()
    };
    least(true).or_else(|| least(false))
}

/// Searches of one body in one frame, one at a time, by whatever method the parameters say.
pub struct Single<'a> {
    rim: &'a RimMesh,
    params: &'a MatchParams,
    way: Way<'a>,
}

enum Way<'a> {
    Rim(Vec<View>),
    Bingham(&'a [Point3], Vec<BinghamView>),
    Search(Box<dyn Objective + 'a>),
}

impl<'a> Single<'a> {
    /// Of a body in the views of `inputs`, near `start`: curves that may be the body's there are searched. `rim` is that of the inputs' mesh, `field`
    /// makes its signed distances, which one objective alone needs.
    ///
    /// # Errors
    /// The curves do not do for the objective; for people.
    pub fn new(
        inputs: &'a MatchInputs,
        rim: &'a RimMesh,
        field: impl FnOnce() -> Arc<DistanceField>,
        start: &Pose,
        params: &'a MatchParams,
    ) -> Result<Self, String> {
        let mesh: &Mesh = &inputs.model.0;
        let views = crate::stage::views_of(&inputs.curves, &inputs.calibrations);
        let way = match params.method {
            Method::Rim => Way::Rim(views),
            Method::Bingham2006 => {
                let of = |(curves, View { fluoroscope, .. }): (&Curves, &View)| {
                    let own = own_contour(curves, rim, fluoroscope, start, params);
                    BinghamView::new(fluoroscope.clone(), &own, mm_per_px(fluoroscope, rim, start))
                };
                let contours = inputs.curves.iter().map(|c| &**c).zip(&views).map(of).collect();
                Way::Bingham(mesh.vertices(), contours)
            }
            Method::Search => {
                let kind = params.search.objective;
                let field = (kind == Kind::InversePoint).then(field);
                let targets = targets(inputs, rim, &views, start, params);
                let settings = params.search.settings(&params.search());
                let made = kind.of(&Body { mesh, rim, field }, &targets, &settings);
                Way::Search(made.map_err(|e| e.to_string())?)
            }
        };
        Ok(Self { rim, params, way })
    }

    /// One search.
    pub fn from(&mut self, start: &Pose) -> Ended {
        match &mut self.way {
            Way::Rim(views) => {
                let found = refine(self.rim, views, start, &self.params.search());
                Ended {
                    pose: found.pose,
                    objective: 1.0 - found.score(),
                    calls: found.steps as usize,
                    converged: found.still,
                }
            }
            Way::Bingham(points, views) => {
                let found = descend(points, self.rim.centroid(), views, start, &self.params.bingham2006);
                Ended {
                    pose: found.pose,
                    objective: found.objective,
                    calls: found.calls,
                    converged: found.converged,
                }
            }
            Way::Search(objective) => search_from(objective.as_mut(), self.rim, start, &self.params.search),
        }
    }
}
