//! The robust function of residuals and its stages (S. Geman and D. McClure, "Statistical methods for tomographic image reconstruction", 1987).

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

/// The scale of a stage, px: from wide to fine by the same factor each time.
pub(crate) fn scale_px(settings: &Settings, stage: usize) -> f64 {
    let last = settings.stages.max(1) - 1;
    if last == 0 || stage >= last {
        return settings.fine_px;
    }
    settings.wide_px * (settings.fine_px / settings.wide_px).powf(stage as f64 / last as f64)
}

/// Least cosine between directions of edge and outline in a stage: 60 degrees at first, 30 at the end.
pub(crate) fn min_cosine(settings: &Settings, stage: usize) -> f64 {
    if stage + 1 < settings.stages.max(1) { 0.5 } else { 0.866 }
}
