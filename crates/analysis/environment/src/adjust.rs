//! Least squares over all views and all sets of pictures at once: Levenberg-Marquardt with exact derivatives.
//!
//! Unknowns are nine numbers a view and, for each set of pictures but the first, the six of the pose of the bead frame; the
//! first set's frame is the laboratory. Rotations are stepped on the rotation group.

use biplane_geometry::{Point2, Point3, Pose, Twist, Vector2, Vector3};
use nalgebra::{DMatrix, DVector, Matrix2x6, Matrix3, SMatrix};

use crate::view::{VIEW, View};

/// Unknowns of a set's frame.
const FRAME: usize = 6;
/// Steps of one minimisation; from a start that labelling gives, about ten are needed.
const STEPS: usize = 80;

/// A bead's shadow in a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Observation {
    pub view: usize,
    pub set: usize,
    /// Place in the list.
    pub bead: usize,
    /// In the frame of the beads, mm.
    pub point: Point3,
    /// mm; 0 where it is not known.
    pub radius: f64,
    /// Ideal px.
    pub at: Point2,
    /// Inverse variance of each coordinate, 1/px^2.
    pub weight: f64,
}

/// Where everything stands.
#[derive(Debug, Clone)]
pub(crate) struct Arrangement {
    pub views: Vec<View>,
    /// `world_from_beads` of each set; the first is the identity.
    pub frames: Vec<Pose>,
}

/// A soft belief about a detector, for views of which few beads are labelled yet: its middle opposite the source and a
/// distance, each with a standard deviation in units of the weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Belief {
    pub source_to_detector_mm: f64,
    /// Standard deviations of the middle's offset and of the distance, as shares of the distance.
    pub shares: [f64; 2],
}

/// How the residuals count.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Rules {
    /// Residuals longer than this count linearly (Huber), px; none for plain least squares.
    pub huber_px: Option<f64>,
    pub belief: Option<Belief>,
}

/// The outcome of a minimisation.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub at: Arrangement,
    /// `J' W J` there: nine rows a view, then six a later set.
    pub normal: DMatrix<f64>,
}

impl Arrangement {
    pub fn unknowns(&self) -> usize {
        VIEW * self.views.len() + FRAME * self.frames.len().saturating_sub(1)
    }

    /// A bead's place in the laboratory.
    pub fn place(&self, o: &Observation) -> Option<Point3> {
        Some(self.frames.get(o.set)?.transform(&o.point))
    }

    /// Found less predicted, px; none where the bead is behind the source.
    pub fn residual(&self, o: &Observation) -> Option<Vector2> {
        Some(o.at - self.views.get(o.view)?.shadow(&self.place(o)?, o.radius)?)
    }

    fn moved(&self, step: &[f64]) -> Self {
        let views = self.views.iter().zip(step.chunks(VIEW)).map(|(v, s)| v.moved(s)).collect();
        let rest = step.get(VIEW * self.views.len()..).unwrap_or_default();
        let twist = |s: &[f64]| Twist {
            translation: Vector3::from_fn(|k, _| s[k]),
            rotation: Vector3::from_fn(|k, _| s[3 + k]),
        };
        let later = self.frames.iter().skip(1).zip(rest.chunks_exact(FRAME));
        let moved = later.map(|(f, s)| f.moved(&twist(s), &Point3::from(f.translation())));
        Self { views, frames: self.frames.iter().take(1).copied().chain(moved).collect() }
    }
}

/// Cost, gradient and normal matrix; none where a bead is behind the source.
struct Linearised {
    cost: f64,
    gradient: DVector<f64>,
    normal: DMatrix<f64>,
}

fn cost(at: &Arrangement, observations: &[Observation], rules: &Rules) -> Option<f64> {
    let mut sum = 0.0;
    for o in observations {
        sum += o.weight * huber(at.residual(o)?.norm(), rules.huber_px).0;
    }
    for view in at.views.iter().filter(|_| rules.belief.is_some()) {
        sum += belief_rows(view, rules).iter().map(|(r, _)| r * r).sum::<f64>();
    }
    sum.is_finite().then_some(sum)
}

/// Cost of a residual's length, and the weight with which its square has the same slope.
fn huber(length: f64, bound: Option<f64>) -> (f64, f64) {
    match bound {
        Some(k) if length > k => (k * (2.0 * length - k), k / length),
        _ => (length * length, 1.0),
    }
}

/// Residuals of the belief, and their derivatives by the view.
fn belief_rows(view: &View, rules: &Rules) -> Vec<(f64, SMatrix<f64, 1, VIEW>)> {
    let Some(Belief { source_to_detector_mm: length, shares }) = rules.belief else { return Vec::new() };
    let transposed: Matrix3<f64> = view.rotation.matrix().transpose();
    let arm = view.centre - view.source;
    let (d, turn) = (transposed * arm, transposed * arm.cross_matrix());
    [(0, 0.0, shares[0]), (1, 0.0, shares[0]), (2, length, shares[1])]
        .map(|(axis, expected, share)| {
            let sigma = share * length;
            let mut row = SMatrix::<f64, 1, VIEW>::zeros();
            row.fixed_columns_mut::<3>(0).copy_from(&(-transposed.row(axis) / sigma));
            row.fixed_columns_mut::<3>(3).copy_from(&(transposed.row(axis) / sigma));
            row.fixed_columns_mut::<3>(6).copy_from(&(turn.row(axis) / sigma));
            ((d[axis] - expected) / sigma, row)
        })
        .to_vec()
}

fn linearise(at: &Arrangement, observations: &[Observation], rules: &Rules) -> Option<Linearised> {
    let n = at.unknowns();
    let mut l = Linearised { cost: 0.0, gradient: DVector::zeros(n), normal: DMatrix::zeros(n, n) };
    for o in observations {
        let view = at.views.get(o.view)?;
        let place = at.place(o)?;
        let shadow = view.shadow_with_derivatives(&place, o.radius)?;
        let residual = o.at - shadow.at;
        let (value, share) = huber(residual.norm(), rules.huber_px);
        let w = o.weight * share;
        l.cost += o.weight * value;
        let first = VIEW * o.view;
        let by_view = &shadow.by_view;
        let mut block = l.normal.fixed_view_mut::<VIEW, VIEW>(first, first);
        block += by_view.transpose() * by_view * w;
        let mut part = l.gradient.fixed_rows_mut::<VIEW>(first);
        part += by_view.transpose() * residual * w;
        if o.set > 0 {
            // The place moves by t + turn x (place - origin of the frame).
            let arm = place.coords - at.frames.get(o.set)?.translation();
            let mut by_frame = Matrix2x6::zeros();
            by_frame.fixed_columns_mut::<3>(0).copy_from(&shadow.by_point);
            by_frame.fixed_columns_mut::<3>(3).copy_from(&(-shadow.by_point * arm.cross_matrix()));
            let second = VIEW * at.views.len() + FRAME * (o.set - 1);
            let mut block = l.normal.fixed_view_mut::<FRAME, FRAME>(second, second);
            block += by_frame.transpose() * by_frame * w;
            let mixed = by_view.transpose() * by_frame * w;
            let mut block = l.normal.fixed_view_mut::<VIEW, FRAME>(first, second);
            block += mixed;
            let mut block = l.normal.fixed_view_mut::<FRAME, VIEW>(second, first);
            block += mixed.transpose();
            let mut part = l.gradient.fixed_rows_mut::<FRAME>(second);
            part += by_frame.transpose() * residual * w;
        }
    }
    for (i, view) in at.views.iter().enumerate() {
        for (residual, row) in belief_rows(view, rules) {
            l.cost += residual * residual;
            let mut block = l.normal.fixed_view_mut::<VIEW, VIEW>(VIEW * i, VIEW * i);
            block += row.transpose() * row;
            let mut part = l.gradient.fixed_rows_mut::<VIEW>(VIEW * i);
            part -= row.transpose() * residual;
        }
    }
    l.cost.is_finite().then_some(l)
}

/// The arrangement of least cost near `start`; none where a bead comes to lie behind the source at the start, or the numbers
/// are no numbers. A fit of fewer residuals than unknowns is not refused here.
pub(crate) fn minimise(start: &Arrangement, observations: &[Observation], rules: &Rules) -> Option<Fit> {
    let mut at = start.clone();
    let mut here = linearise(&at, observations, rules)?;
    let mut damping = 1e-5;
    for _ in 0..STEPS {
        let diagonal = here.normal.diagonal();
        let largest = diagonal.max();
        let mut damped = here.normal.clone();
        for i in 0..diagonal.len() {
            damped[(i, i)] += damping * diagonal[i].max(1e-12 * largest);
        }
        let Some(step) = damped.cholesky().map(|c| c.solve(&here.gradient)) else {
            damping *= 10.0;
            if damping > 1e12 {
                break;
            }
            continue;
        };
        let next = at.moved(step.as_slice());
        // How much the step moves the predicted pixels, squared and weighted: what is far below rounding is the end.
        let moved = (step.transpose() * &here.normal * &step)[(0, 0)];
        match cost(&next, observations, rules) {
            Some(value) if value <= here.cost => {
                let gain = here.cost - value;
                at = next;
                here = linearise(&at, observations, rules)?;
                damping = (damping * 0.1).max(1e-15);
                if moved <= 1e-18 * observations.len() as f64 || (gain <= 1e-15 * value && damping < 1e-6) {
                    break;
                }
            }
            _ => {
                damping *= 10.0;
                if damping > 1e12 || moved <= 1e-18 {
                    break;
                }
            }
        }
    }
    Some(Fit { at, normal: here.normal })
}

/// The inverse of a symmetric positive matrix, by Cholesky with its diagonal scaled to one: mm and radians differ by thousands.
pub(crate) fn inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = matrix.diagonal().map(|v| if v > 0.0 { 1.0 / v.sqrt() } else { 0.0 });
    let scaled =
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] * scale[i] * scale[j]);
    let inverse = scaled.cholesky()?.inverse();
    let out = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| inverse[(i, j)] * scale[i] * scale[j]);
    out.iter().all(|v| v.is_finite()).then_some(out)
}
