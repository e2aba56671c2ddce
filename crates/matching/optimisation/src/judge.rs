//! The verdict on a pose, from its fit.

use biplane_artifact::{Verdict, ViewFit};

use crate::Refined;

/// What a pose must reach to be called good, and below what it has failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Least share of the outline on the picture that finds its edge, in each view: good, failed.
    pub matched_share: (f64, f64),
    /// Largest root mean square residual, px, in each view: good, failed.
    pub rms_px: (f64, f64),
    /// Largest standard deviation: centroid's position, mm, and rotation, rad, to be good.
    pub sigma: (f64, f64),
}

/// The fit of each view, the verdict and its reason (empty if good). `names` are the views' names.
pub fn judge(refined: &Refined, names: &[String], limits: &Limits) -> (Vec<ViewFit>, Verdict, String) {
    let fits: Vec<ViewFit> = refined
        .evidence
        .iter()
        .map(|e| {
            let over = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
            ViewFit {
                rms_px: over(e.squared, e.matched_px).sqrt(),
                rms_mm: over(e.squared_mm, e.matched_px).sqrt(),
                matched_share: over(e.matched_px, e.in_image_px),
                in_image_share: over(e.in_image_px, e.outline_px).min(1.0),
                outline_px: e.outline_px,
                inset_px: e.inset_px,
            }
        })
        .collect();
    let mut verdict = Verdict::Good;
    let mut reasons = Vec::new();
    let mut find = |worse: Verdict, reason: String| {
        verdict = verdict.max(worse);
        reasons.push(reason);
    };
    for (fit, name) in fits.iter().zip(names) {
        let grade = |failed: bool| if failed { Verdict::Failed } else { Verdict::Doubtful };
        if fit.outline_px <= 0.0 || fit.in_image_share <= 0.0 {
            find(Verdict::Failed, format!("view {name}: the body is outside the picture"));
            continue;
        }
        let (good, failed) = limits.matched_share;
        if fit.matched_share < good {
            let percent = 100.0 * fit.matched_share;
            find(
                grade(fit.matched_share < failed),
                format!("view {name}: {percent:.0} % of the outline found an edge"),
            );
        }
        let (good, failed) = limits.rms_px;
        if fit.rms_px > good {
            find(grade(fit.rms_px > failed), format!("view {name}: residual {:.2} px", fit.rms_px));
        }
        if fit.in_image_share < 0.5 {
            let percent = 100.0 * fit.in_image_share;
            find(Verdict::Doubtful, format!("view {name}: {percent:.0} % of the outline is on the picture"));
        }
    }
    match &refined.covariance {
        None => find(Verdict::Failed, "the edges found do not hold every motion of the body".to_owned()),
        Some(c) => {
            let sigma = |from: usize| (from..from + 3).map(|i| c[(i, i)].max(0.0)).sum::<f64>().sqrt();
            if sigma(0) > limits.sigma.0 || sigma(3) > limits.sigma.1 {
                find(
                    Verdict::Doubtful,
                    format!("uncertain: {:.2} mm, {:.2} deg (1 sigma)", sigma(0), sigma(3).to_degrees()),
                );
            }
        }
    }
    if !refined.still {
        find(Verdict::Doubtful, "the search did not come to rest".to_owned());
    }
    (fits, verdict, reasons.join("; "))
}
