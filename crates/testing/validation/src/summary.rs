//! Distributions of errors.

use std::fmt;

use biplane_artifact::Verdict;

use crate::Attempt;

/// Median, 95 % and worst of some errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    /// Half are at most this.
    pub median: f64,
    /// 95 of 100 are at most this.
    pub p95: f64,
    /// None is above.
    pub worst: f64,
}

impl Distribution {
    /// Of the values (nearest rank); NaN where there are none.
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let rank = (share * values.len() as f64).ceil() as usize;
            values.get(rank.saturating_sub(1)).copied().unwrap_or(f64::NAN)
        };
        Self { median: at(0.5), p95: at(0.95), worst: at(1.0) }
    }
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "median {:.3}, 95 % {:.3}, worst {:.3}", self.median, self.p95, self.worst)
    }
}

/// What many matches of one body came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Matches.
    pub count: usize,
    /// With each verdict: good, doubtful, failed.
    pub verdicts: [usize; 3],
    /// Called good and yet beyond 1 mm or 1 degree: there must be none.
    pub wrong_called_good: usize,
    /// Not called good though within 1 mm and 1 degree.
    pub right_not_good: usize,
    /// Of all matches, mm.
    pub translation_mm: Distribution,
    /// Of all matches, degrees.
    pub rotation_deg: Distribution,
    /// Of all matches, mm.
    pub mean_target_mm: Distribution,
    /// Mean of the squared error over the stated covariance, of those called good: 6 where the covariance is right.
    pub good_normalised: f64,
    /// Root mean square residual of the answers, px, the larger view's.
    pub rms_px: Distribution,
    /// The same of the reference poses.
    pub reference_rms_px: Distribution,
    /// Of those called good, mm.
    pub good_translation_mm: Distribution,
    /// Of those called good, degrees.
    pub good_rotation_deg: Distribution,
}

impl Summary {
    /// Of attempts.
    pub fn of(attempts: &[Attempt]) -> Self {
        let right = |a: &Attempt| a.error.translation_mm <= 1.0 && a.error.rotation_rad.to_degrees() <= 1.0;
        let good = |a: &&Attempt| a.verdict() == Verdict::Good;
        let count = |v: Verdict| attempts.iter().filter(|a| a.verdict() == v).count();
        let of = |f: fn(&Attempt) -> f64| Distribution::of(attempts.iter().map(f).collect());
        let of_good =
            |f: fn(&Attempt) -> f64| Distribution::of(attempts.iter().filter(good).map(f).collect());
        Self {
            count: attempts.len(),
            verdicts: [count(Verdict::Good), count(Verdict::Doubtful), count(Verdict::Failed)],
            wrong_called_good: attempts.iter().filter(good).filter(|a| !right(a)).count(),
            right_not_good: attempts.iter().filter(|a| !good(a) && right(a)).count(),
            translation_mm: of(|a| a.error.translation_mm),
            rotation_deg: of(|a| a.error.rotation_rad.to_degrees()),
            mean_target_mm: of(|a| a.mean_target_mm),
            good_normalised: {
                let good: Vec<f64> = attempts.iter().filter(good).map(|a| a.normalised_squared).collect();
                good.iter().sum::<f64>() / good.len() as f64
            },
            rms_px: of(|a| a.answer.views.iter().map(|v| v.rms_px).fold(0.0, f64::max)),
            reference_rms_px: of(|a| a.reference_rms_px),
            good_translation_mm: of_good(|a| a.error.translation_mm),
            good_rotation_deg: of_good(|a| a.error.rotation_rad.to_degrees()),
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [good, doubtful, failed] = self.verdicts;
        writeln!(f, "  {} matches: {good} good, {doubtful} doubtful, {failed} failed", self.count)?;
        writeln!(f, "  translation, mm   all {}; good {}", self.translation_mm, self.good_translation_mm)?;
        writeln!(f, "  rotation, degrees all {}; good {}", self.rotation_deg, self.good_rotation_deg)?;
        writeln!(f, "  mTRE, mm          all {}", self.mean_target_mm)?;
        writeln!(f, "  residual, px      answers {}", self.rms_px)?;
        writeln!(f, "                    references {}", self.reference_rms_px)?;
        writeln!(
            f,
            "  squared error over stated covariance, good ones: mean {:.1} (6 if the covariance holds all)",
            self.good_normalised
        )?;
        write!(
            f,
            "  called good beyond 1 mm or 1 degree: {}; not good though within: {}",
            self.wrong_called_good, self.right_not_good
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_those_of_the_sorted_values() {
        let d = Distribution::of((1..=100).rev().map(f64::from).collect());
        assert_eq!((d.median, d.p95, d.worst), (50.0, 95.0, 100.0));
        assert!(Distribution::of(vec![]).median.is_nan());
    }
}
