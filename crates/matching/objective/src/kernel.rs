//! The robust function of residuals, its stages, and what is common to the residuals of a view (S. Geman and D. McClure, "Statistical methods for tomographic image reconstruction", 1987).

use biplane_optimiser::Row;
use nalgebra::Vector6;

use crate::Settings;

/// `s u / (1 + u)` with `u = (r / s)^2`: `r^2 / s` for small residuals, `s` for large ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kernel {
    /// mm.
    scale: f64,
}

impl Kernel {
    /// With a scale in mm.
    pub fn new(scale_mm: f64) -> Self {
        Self { scale: scale_mm.max(1e-9) }
    }

    pub fn value(self, residual: f64) -> f64 {
        let u = (residual / self.scale).powi(2);
        // Not `u / (1 + u)`, which is no number for infinite ones.
        self.scale * (1.0 - 1.0 / (1.0 + u))
    }

    /// The derivative over the residual.
    pub fn weight(self, residual: f64) -> f64 {
        2.0 / self.scale / (1.0 + (residual / self.scale).powi(2)).powi(2)
    }
}

/// A residual and what it counts, before the robust function.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Partner {
    /// mm; positive where the edge lies outside the outline.
    pub residual: f64,
    /// Share of the view's sum.
    pub share: f64,
    /// Of the residual, by the twist; anything where no rows are wanted.
    pub derivative: Vector6<f64>,
}

/// Rounds in which a view's inset is found at most; the robust weights settle in a few.
const ROUNDS: usize = 30;

/// The robust sum over a view's partners, with their rows. Edges may lie inside the outline as a whole, by what makes the sum least, up to `limit` mm
/// either way (0 holds it at zero): what is common to all residuals is then neither value nor gradient.
pub(crate) fn settle(kernel: Kernel, partners: &[Partner], limit: f64, rows: Option<&mut Vec<Row>>) -> f64 {
    let weight = |p: &Partner, inset: f64| p.share * kernel.weight(p.residual - inset);
    let mut inset = 0.0;
    let mut held = true;
    for _ in 0..if limit > 0.0 { ROUNDS } else { 0 } {
        let (mut sum, mut weights) = (0.0, 0.0);
        for p in partners {
            let w = weight(p, inset);
            (sum, weights) = (sum + w * p.residual, weights + w);
        }
        if weights <= 0.0 {
            break;
        }
        let next: f64 = (sum / weights).clamp(-limit, limit);
        held = next.abs() >= limit;
        let moved = (next - inset).abs();
        inset = next;
        if moved < 1e-9 {
            break;
        }
    }
    if let Some(rows) = rows {
        // With the inset free, a motion that shifts all residuals alike moves nothing: the mean derivative goes.
        let mut mean = Vector6::zeros();
        if !held {
            let mut weights = 0.0;
            for p in partners {
                let w = weight(p, inset);
                mean += p.derivative * w;
                weights += w;
            }
            mean /= weights;
        }
        rows.extend(partners.iter().map(|p| Row {
            residual: p.residual - inset,
            weight: weight(p, inset),
            derivative: p.derivative - mean,
        }));
    }
    partners.iter().map(|p| p.share * kernel.value(p.residual - inset)).sum()
}

/// What a stage measures by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stage {
    /// Scale of the robust function, px: from wide to fine by the same factor each time.
    pub scale_px: f64,
    /// How far a partner is sought, px. Beyond four scales residuals count nearly the same.
    pub reach_px: f64,
    /// Least cosine between directions of edge and outline: 60 degrees apart at first, 30 at the end.
    pub cosine: f64,
    /// Limit of the inset, px. Far off, what is common to all residuals is motion.
    pub inset_px: f64,
    pub last: bool,
}

impl Stage {
    pub fn of(settings: &Settings, stage: usize) -> Self {
        let end = settings.stages.max(1) - 1;
        let last = stage >= end;
        let share = if last { 1.0 } else { stage as f64 / end as f64 };
        let scale_px = settings.wide_px * (settings.fine_px / settings.wide_px).powf(share);
        Self {
            scale_px,
            reach_px: settings.reach_px.min(4.0 * scale_px),
            cosine: if last { 0.866 } else { 0.5 },
            inset_px: if last { 2.0 * settings.inset_px } else { 0.0 },
            last,
        }
    }
}
