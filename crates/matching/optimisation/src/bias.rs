//! Takes the bias of X-ray edges at smooth rims out of a pose that a descent found.
//!
//! The descent gives each view one inset, the same all along the outline. What is left differs from rim to rim, with the chords of the
//! body behind them, and moves and turns the pose. Here the chords are taken from the mesh, and attenuation, blur and the motion that
//! the pose still wants are solved for together ([`biplane_edge_bias`]).
//!
//! **Guaranteed:** a pose whose edges lie on the outline as it is (ideal outlines), whose mesh is open there, or which would be led away
//! from where it fits, stays as it was. **Not guaranteed:** attenuation and blur themselves: where the outline does not tell them apart they
//! are what was expected, and the bias that they give together is right all the same.

use biplane_edge_bias::{ChordFinder, Estimate, Prior, Sample};
use biplane_geometry::{Point2, Pose, Twist, Vector3};
use biplane_outline::{Outline, RimMesh, Sampling};
use nalgebra::Vector6;

use crate::refine::{Evidence, MIN_COSINE, RefineParams, Refined, View};

/// What is known of the edges of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BiasParams {
    /// Attenuation of the body over that of what it stands in, 1/mm; found from the edges where nobody says.
    pub attenuation_per_mm: Option<f64>,
    /// Blur of the pictures and of the search for edges together, px; what it is, is found from the edges.
    pub blur_px: f64,
}

/// What is expected of an attenuation, 1/mm, and the standard deviation of its logarithm: from bone in soft tissue, 0.06, to
/// cobalt-chrome, 1.8.
const ATTENUATION: (f64, f64) = (0.3, 1.3);
/// Standard deviation of the blur, px.
const BLUR_SIGMA_PX: f64 = 0.5;
/// Standard deviation of what a view's edges lie inside beside what is predicted, px.
const INSET_SIGMA_PX: f64 = 0.25;
/// Length along a contour over which residuals still move together once the bias is out of them, px. It gives a mean squared error over the
/// stated covariance of 4.2 (femoral component), 4.0 (tray) and 1.2 to 3.3 (bones) on the simulated knees, where 6 would be right
/// (`cargo xtask validate --only simulated`).
const UNBIASED_CORRELATION_PX: f64 = 40.0;
/// Rounds at most; the second one moves the body by some micrometres.
const ROUNDS: usize = 4;
/// Distance of samples, px: noise of edges is shared over as much.
const SPACING_PX: f64 = 4.0;
/// Edges that lie on the outline to this, as a root mean square or in the median, px, have no bias worth a search.
const ON_OUTLINE_PX: f64 = 0.05;
/// Share of the samples that must have chords.
const WITH_CHORDS: f64 = 0.7;
/// Share of the outline found that must be found still.
const STILL_FOUND: f64 = 0.95;
/// How far the bias may have moved the body, mm of the centroid or of the surface by turning (one standard deviation, each round).
const MOVED_MM: f64 = 1.0;

/// The pose that `found` has without the bias, with its covariance; none where it is as good as it is.
pub fn take_out(
    mesh: &RimMesh,
    views: &[View],
    found: &Refined,
    search: &RefineParams,
    params: &BiasParams,
) -> Option<Refined> {
    let off = |e: &Evidence| e.inset_px.hypot((e.squared / e.matched_px.max(1e-9)).sqrt());
    if found.evidence.iter().all(|e| off(e) < ON_OUTLINE_PX) {
        return None;
    }
    let arm = mesh.radius_of_gyration().max(1e-3);
    let turned = MOVED_MM / arm;
    let prior = Prior {
        attenuation_per_mm: params.attenuation_per_mm.unwrap_or(ATTENUATION.0),
        attenuation_ln_sigma: if params.attenuation_per_mm.is_some() { 0.0 } else { ATTENUATION.1 },
        blur_px: params.blur_px,
        blur_sigma_px: BLUR_SIGMA_PX,
        inset_sigma_px: INSET_SIGMA_PX,
        correlation_px: UNBIASED_CORRELATION_PX,
        motion_sigma: Vector6::new(MOVED_MM, MOVED_MM, MOVED_MM, turned, turned, turned),
    };
    let mut estimate = Estimate::of(&prior, views.len());
    let mut buffers = Buffers::default();
    let mut pose = found.pose;
    for round in 0..ROUNDS {
        buffers.collect(mesh, views, &pose, search);
        if round == 0 && !buffers.worth_it() {
            return None;
        }
        estimate.refine(&buffers.samples, &prior);
        let [x, y, z, a, b, c] = estimate.motion.into();
        let twist = Twist { translation: Vector3::new(x, y, z), rotation: Vector3::new(a, b, c) };
        pose = pose.moved(&twist, &pose.transform(mesh.centroid()));
        if twist.translation.norm().max(twist.rotation.norm() * arm) < search.still_mm {
            break;
        }
    }
    buffers.collect(mesh, views, &pose, search);
    estimate.motion = Vector6::zeros();
    let evidence: Vec<Evidence> = (0..views.len()).map(|view| buffers.evidence(view, &estimate)).collect();
    let matched = |evidence: &[Evidence]| evidence.iter().map(|e| e.matched_px).sum::<f64>();
    if matched(&evidence) < STILL_FOUND * matched(&found.evidence) {
        return None;
    }
    let covariance = estimate.covariance(&buffers.samples, &prior);
    Some(Refined { pose, evidence, covariance, ..found.clone() })
}

/// Samples of the outline, used again from round to round.
#[derive(Default)]
struct Buffers {
    outline: Outline,
    finder: ChordFinder,
    samples: Vec<Sample>,
    /// Size of a pixel at the depth of each sample.
    mm_per_px: Vec<f64>,
    /// Lengths of the outline, all and on the picture, px.
    lengths: Vec<(f64, f64)>,
}

impl Buffers {
    fn collect(&mut self, mesh: &RimMesh, views: &[View], pose: &Pose, search: &RefineParams) {
        self.samples.clear();
        self.mm_per_px.clear();
        self.lengths.clear();
        for number in 0..views.len() {
            self.collect_view(mesh, views, number, pose, search);
        }
    }

    fn collect_view(
        &mut self,
        mesh: &RimMesh,
        views: &[View],
        number: usize,
        pose: &Pose,
        search: &RefineParams,
    ) {
        let View { fluoroscope, edges } = &views[number];
        self.outline.trace(mesh, pose, fluoroscope, Sampling { step_px: 1.0 });
        let model_from_world = pose.inverse();
        let (center, source) =
            (pose.transform(mesh.centroid()), model_from_world.transform(fluoroscope.source()));
        let depth_axis = fluoroscope.matrix().row(2).transpose();
        // To a pixel's ray, 1 mm deep.
        let deep = |pixel: &Point2| fluoroscope.ray(pixel).map(|ray| ray / depth_axis.dot(&ray));
        let (mut all, mut in_image, mut passed) = (0.0, 0.0, 0.0);
        for point in self.outline.points() {
            all += point.length_px;
            passed += point.length_px;
            if passed < SPACING_PX {
                continue;
            }
            let length_px = std::mem::take(&mut passed);
            if !fluoroscope.on_image(&point.pixel, 2.0) {
                continue;
            }
            in_image += length_px;
            let (direction, radius) = (point.normal * search.contrast, search.final_search_px);
            let Some(edge) = edges.nearest(&point.pixel, &direction, radius, MIN_COSINE) else { continue };
            let across = edge.direction * search.contrast;
            let residual_px = across.dot(&(edge.position - point.pixel)) / across.dot(&point.normal);
            if residual_px.abs() > radius {
                continue;
            }
            let Some((_, by_point)) = fluoroscope.project_with_derivative(&point.world) else { continue };
            let gradient = by_point.transpose() * point.normal;
            let turn = (point.world - center).cross(&gradient);
            let beside = deep(&(point.pixel - point.normal)).zip(deep(&point.pixel));
            let chords = beside.and_then(|(inner, outer)| {
                let inward = model_from_world.rotation() * ((inner - outer) * point.depth);
                let rim = model_from_world.transform(&point.world);
                self.finder.find(mesh.surface(), &source, &rim, &inward)
            });
            self.samples.push(Sample {
                view: number,
                residual_px,
                motion: Vector6::new(gradient.x, gradient.y, gradient.z, turn.x, turn.y, turn.z),
                length_px,
                chords,
            });
            self.mm_per_px.push(fluoroscope.mm_per_px(point.depth));
        }
        self.lengths.push((all, in_image));
    }

    /// Whether edges lie off the outline, on a body whose chords are known.
    fn worth_it(&self) -> bool {
        let mut sizes: Vec<f64> = self.samples.iter().map(|s| s.residual_px.abs()).collect();
        let with = self.samples.iter().filter(|s| s.chords.is_some()).count();
        if sizes.is_empty() || (with as f64) < WITH_CHORDS * sizes.len() as f64 {
            return false;
        }
        let middle = sizes.len() / 2;
        *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 > ON_OUTLINE_PX
    }

    /// What a view says of the pose, without the bias.
    fn evidence(&self, view: usize, estimate: &Estimate) -> Evidence {
        let (outline_px, in_image_px) = self.lengths.get(view).copied().unwrap_or_default();
        let mut evidence = Evidence { outline_px, in_image_px, ..Evidence::default() };
        for (s, mm_per_px) in self.samples.iter().zip(&self.mm_per_px).filter(|(s, _)| s.view == view) {
            let inset = estimate.inset_px(view, s.chords.as_ref());
            let squared = (s.residual_px + inset).powi(2);
            evidence.inset_px += s.length_px * inset;
            evidence.matched_px += s.length_px;
            evidence.squared += s.length_px * squared;
            evidence.squared_mm += s.length_px * squared * mm_per_px * mm_per_px;
            evidence.close_px += s.length_px * (-squared / 2.0).exp();
        }
        evidence.inset_px /= evidence.matched_px.max(1e-9);
        evidence
    }
}
