//! What attenuates and what blurs, from how far the edges of a body lie beside its outline.
//!
//! Gauss and Newton on all samples of all views at once. Unknown are the motion that the pose still wants (as nuisance: what the
//! motion explains is no bias), the attenuation (its logarithm) and the blur, which the views share, and an inset of each view that
//! the prediction does not know of. Robust weights (Geman and McClure) as in matching. Every unknown but the motion has a prior: where
//! the outline does not tell it, that is what is answered.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chords::Chords;
use crate::profile::Profile;

/// A point of an outline that found its edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Number of the view, from 0.
    pub view: usize,
    /// How far outside the outline the edge lies, px.
    pub residual_px: f64,
    /// By how much a small motion moves the outline outward here, px a unit.
    pub motion: Vector6<f64>,
    /// Length of the outline it stands for, px.
    pub length_px: f64,
    /// The chords behind it; without them no bias is predicted.
    pub chords: Option<Chords>,
}

/// What is known before the edges are looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Attenuation of the body over that of what it stands in, 1/mm.
    pub attenuation_per_mm: f64,
    /// Standard deviation of its natural logarithm; 0 holds it.
    pub attenuation_ln_sigma: f64,
    /// Blur of the picture and of the search for edges together, px.
    pub blur_px: f64,
    /// Its standard deviation, px; 0 holds it.
    pub blur_sigma_px: f64,
    /// Standard deviation of an inset that a view has beside what is predicted, px; 0 for none.
    pub inset_sigma_px: f64,
    /// Length over which residuals move together, px.
    pub correlation_px: f64,
    /// How far the body may still have to move, in units of the motion.
    pub motion_sigma: Vector6<f64>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Attenuation, 1/mm.
    pub attenuation_per_mm: f64,
    /// Blur, px.
    pub blur_px: f64,
    /// The inset of each view that is not predicted, px.
    pub inset_px: Vec<f64>,
    /// The motion.
    pub motion: Vector6<f64>,
}

/// Rounds of Gauss and Newton.
const ROUNDS: usize = 2;
/// Least and greatest blur, px: chords do not reach farther in.
const BLUR_PX: (f64, f64) = (0.05, 2.8);
/// Least and greatest attenuation, 1/mm.
const ATTENUATION_PER_MM: (f64, f64) = (1e-3, 20.0);
/// The robust weight's scale is never below this, px.
const LEAST_SCALE_PX: f64 = 0.1;
/// Residuals are never said to be surer than this, px.
const LEAST_SIGMA_PX: f64 = 0.01;
/// A median size is so much of a standard deviation.
const MEDIAN_SIZE: f64 = 0.6745;
/// Differences by which the prediction is differentiated: of the logarithm of the attenuation, and of that of the blur.
const STEP: f64 = 0.02;

impl Estimate {
    /// What the prior says.
    pub fn of(prior: &Prior, views: usize) -> Self {
        Self {
            attenuation_per_mm: prior.attenuation_per_mm,
            blur_px: prior.blur_px,
            inset_px: vec![0.0; views],
            motion: Vector6::zeros(),
        }
    }

    /// How far inside the outline an edge is expected, px.
    pub fn inset_px(&self, view: usize, chords: Option<&Chords>) -> f64 {
        let own = self.inset_px.get(view).copied().unwrap_or(0.0);
        own + chords.map_or(0.0, |c| predicted(c, self.attenuation_per_mm, self.blur_px))
    }

    /// Brings the estimate nearer to what the samples say.
    pub fn refine(&mut self, samples: &[Sample], prior: &Prior) {
        self.motion = Vector6::zeros();
        for _ in 0..ROUNDS {
            if self.step(samples, prior).is_none() {
                return;
            }
        }
    }

    fn step(&mut self, samples: &[Sample], prior: &Prior) -> Option<()> {
        let views = self.inset_px.len();
        let unknowns = 8 + views;
        // What is left of each residual, and by how much the logarithms of attenuation and blur change the prediction.
        let left: Vec<(f64, f64, f64)> = samples
            .iter()
            .map(|s| {
                let (bias, by_attenuation, by_blur) = s
                    .chords
                    .as_ref()
                    .map_or((0.0, 0.0, 0.0), |c| differentiated(c, self.attenuation_per_mm, self.blur_px));
                let own = self.inset_px.get(s.view).copied().unwrap_or(0.0);
                (s.residual_px + bias + own - s.motion.dot(&self.motion), by_attenuation, by_blur)
            })
            .collect();
        let mut sizes: Vec<f64> = left.iter().map(|l| l.0.abs()).collect();
        if sizes.is_empty() {
            return None;
        }
        let middle = sizes.len() / 2;
        let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        let sigma = (median / MEDIAN_SIZE).max(LEAST_SIGMA_PX);
        let scale_squared = (2.5 * sigma).max(LEAST_SCALE_PX).powi(2);
        let mut matrix = DMatrix::<f64>::zeros(unknowns, unknowns);
        let mut vector = DVector::<f64>::zeros(unknowns);
        for (s, &(e, by_attenuation, by_blur)) in samples.iter().zip(&left) {
            let robust = (scale_squared / (scale_squared + e * e)).powi(2);
            let weight = robust * s.length_px / (prior.correlation_px * sigma * sigma);
            // Of what is left, by the unknowns; a view's inset is one of them.
            let mut row = [0.0; 9];
            row[..6].copy_from_slice((-s.motion).as_slice());
            row[6..].copy_from_slice(&[by_attenuation, by_blur, 1.0]);
            let place = |k: usize| if k < 8 { k } else { 8 + s.view };
            for (k, a) in row.iter().enumerate() {
                vector[place(k)] -= weight * a * e;
                for (l, b) in row.iter().enumerate() {
                    matrix[(place(k), place(l))] += weight * a * b;
                }
            }
        }
        // Priors, as further observations; what is held has none and no column.
        let mut known = |k: usize, sigma: f64, off: f64| {
            if sigma > 0.0 {
                matrix[(k, k)] += 1.0 / (sigma * sigma);
                vector[k] -= off / (sigma * sigma);
            } else {
                matrix.row_mut(k).fill(0.0);
                matrix.column_mut(k).fill(0.0);
                matrix[(k, k)] = 1.0;
                vector[k] = 0.0;
            }
        };
        for k in 0..6 {
            known(k, prior.motion_sigma[k], self.motion[k]);
        }
        let off = (self.attenuation_per_mm / prior.attenuation_per_mm).ln();
        known(6, prior.attenuation_ln_sigma, off);
        // The blur's logarithm is moved, its size has the prior.
        known(7, prior.blur_sigma_px / self.blur_px, (self.blur_px - prior.blur_px) / self.blur_px);
        for view in 0..views {
            known(8 + view, prior.inset_sigma_px, self.inset_px[view]);
        }
        let step = matrix.cholesky()?.solve(&vector);
        if !step.iter().all(|v| v.is_finite()) {
            return None;
        }
        self.motion += Vector6::from_fn(|k, _| step[k]);
        let bounded = |value: f64, step: f64, (low, high): (f64, f64)| {
            (value * step.clamp(-1.0, 1.0).exp()).clamp(low, high)
        };
        self.attenuation_per_mm = bounded(self.attenuation_per_mm, step[6], ATTENUATION_PER_MM);
        self.blur_px = bounded(self.blur_px, step[7], BLUR_PX);
        for (view, inset) in self.inset_px.iter_mut().enumerate() {
            *inset += step[8 + view];
        }
        Some(())
    }
}

/// How far inside its outline the edge of a body is found, px: 0 where it has none.
pub fn predicted(chords: &Chords, attenuation_per_mm: f64, blur_px: f64) -> f64 {
    Profile::of(chords, attenuation_per_mm).inset_px(blur_px, 0.4 * blur_px).unwrap_or(0.0)
}

/// How far inside its outline the edge of a smooth rim is found, px, whose radius of curvature along the ray is `radius_mm`. A crease,
/// whose radius is none, has its edge on the outline.
pub fn rim_inset_px(radius_mm: f64, attenuation_per_mm: f64, blur_px: f64, mm_per_px: f64) -> f64 {
    predicted(&Chords::of_radius(radius_mm, mm_per_px), attenuation_per_mm, blur_px)
}

/// The same with its derivatives by the logarithms of attenuation and blur.
fn differentiated(chords: &Chords, attenuation_per_mm: f64, blur_px: f64) -> (f64, f64, f64) {
    let profile = Profile::of(chords, attenuation_per_mm);
    let Some(here) = profile.inset_px(blur_px, 0.4 * blur_px) else { return (0.0, 0.0, 0.0) };
    let more = STEP.exp();
    let darker = Profile::of(chords, attenuation_per_mm * more).inset_px(blur_px, here);
    let softer = profile.inset_px(blur_px * more, here);
    let slope = |other: Option<f64>| other.map_or(0.0, |o| (o - here) / STEP);
    (here, slope(darker), slope(softer))
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    const MM_PER_PX: f64 = 0.15;

    fn prior() -> Prior {
        Prior {
            attenuation_per_mm: 0.3,
            attenuation_ln_sigma: 1.3,
            blur_px: 1.6,
            blur_sigma_px: 0.5,
            inset_sigma_px: 0.1,
            correlation_px: 150.0,
            motion_sigma: Vector6::repeat(5.0),
        }
    }

    /// Two views of 400 samples each with edges where an attenuation and a blur put them, moved by a motion, a part of them wrong.
    fn samples(radii: [f64; 2], truth: (f64, f64), motion: &Vector6<f64>, wrong: f64) -> Vec<Sample> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
        (0..800)
            .map(|k| {
                let radius = (random.random_range(radii[0].ln()..=radii[1].ln())).exp();
                let chords = Chords::of_radius(radius, MM_PER_PX);
                let row = Vector6::from_fn(|_, _| random.random_range(-5.0..5.0));
                let off = if random.random_bool(wrong) { random.random_range(-3.0..3.0) } else { 0.0 };
                let noise = random.random_range(-0.05..0.05) + off;
                let residual_px = row.dot(motion) - predicted(&chords, truth.0, truth.1) + noise;
                Sample { view: k / 400, residual_px, motion: row, length_px: 4.0, chords: Some(chords) }
            })
            .collect()
    }

    #[test]
    fn attenuation_blur_and_motion_are_found_from_afar_with_wrong_edges_among_them() {
        let motion = Vector6::new(0.02, -0.01, 0.03, 0.01, -0.02, 0.005);
        for truth in [(0.057, 1.65), (0.49, 1.3), (0.3, 2.3), (1.8, 1.65)] {
            for wrong in [0.0, 0.1] {
                let samples = samples([0.5, 40.0], truth, &motion, wrong);
                let mut found = Estimate::of(&prior(), 2);
                for _ in 0..3 {
                    found.refine(&samples, &prior());
                }
                let off = (found.attenuation_per_mm / truth.0).ln().abs();
                assert!(off < 0.25, "{truth:?} {wrong}: {found:?}");
                assert!((found.motion - motion).amax() < 2e-3, "{truth:?} {wrong}: {found:?}");
                let worst = samples.iter().map(|s| {
                    let chords = s.chords.as_ref().unwrap();
                    (found.inset_px(s.view, s.chords.as_ref()) - predicted(chords, truth.0, truth.1)).abs()
                });
                assert!(worst.fold(0.0, f64::max) < 0.03, "{truth:?} {wrong}: {found:?}");
            }
        }
    }

    #[test]
    fn one_radius_all_along_is_one_inset_all_along() {
        let samples = samples([12.0, 12.000_1], (0.057, 1.65), &Vector6::zeros(), 0.0);
        let mut found = Estimate::of(&prior(), 2);
        for _ in 0..3 {
            found.refine(&samples, &prior());
        }
        let expected = predicted(samples[0].chords.as_ref().unwrap(), 0.057, 1.65);
        for view in 0..2 {
            assert!((found.inset_px(view, samples[0].chords.as_ref()) - expected).abs() < 0.02, "{found:?}");
        }
        assert!(found.motion.amax() < 2e-3);
        assert!(found.attenuation_per_mm > 0.02 && (1.0..2.3).contains(&found.blur_px), "{found:?}");
    }

    #[test]
    fn edges_on_the_outline_have_no_blur_and_no_bias() {
        let mut samples = samples([0.5, 40.0], (0.3, 1.65), &Vector6::zeros(), 0.0);
        for s in &mut samples {
            s.residual_px = 0.0;
        }
        let mut found = Estimate::of(&prior(), 2);
        for _ in 0..6 {
            found.refine(&samples, &prior());
        }
        let most =
            samples.iter().map(|s| found.inset_px(s.view, s.chords.as_ref()).abs()).fold(0.0, f64::max);
        assert!(most < 0.01 && found.motion.amax() < 1e-4, "{most} {found:?}");
    }

    #[test]
    fn what_is_held_stays_and_nothing_changes_without_samples() {
        let samples = samples([0.5, 40.0], (0.057, 1.65), &Vector6::zeros(), 0.0);
        let held = Prior { attenuation_ln_sigma: 0.0, blur_sigma_px: 0.0, inset_sigma_px: 0.0, ..prior() };
        let mut found = Estimate::of(&held, 2);
        found.refine(&samples, &held);
        assert_eq!((found.attenuation_per_mm, found.blur_px, &found.inset_px[..]), (0.3, 1.6, &[0.0; 2][..]));
        let mut nothing = Estimate::of(&prior(), 2);
        nothing.refine(&[], &prior());
        assert_eq!(nothing, Estimate::of(&prior(), 2));
        // Without chords there is the inset of a view alone.
        let bare: Vec<Sample> =
            samples.iter().map(|s| Sample { residual_px: -0.4, chords: None, ..*s }).collect();
        let loose = Prior { inset_sigma_px: 1.0, ..prior() };
        let mut constant = Estimate::of(&loose, 2);
        constant.refine(&bare, &loose);
        assert!(constant.inset_px.iter().all(|c| (c - 0.4).abs() < 1e-3), "{constant:?}");
        assert_eq!((constant.attenuation_per_mm, constant.blur_px), (0.3, 1.6));
    }

    #[test]
    fn limits_are_those_of_sharp_flat_and_far_rims() {
        assert_eq!(rim_inset_px(0.0, 0.5, 1.6, 0.15), 0.0);
        let flat = rim_inset_px(1e9, 0.5, 1.6, 0.15);
        assert!((0.0..1e-6).contains(&flat), "{flat}");
        let weak = rim_inset_px(10.0, 1e-9, 1.6, 0.15);
        assert!((weak / 1.6 - 0.764_6).abs() < 0.05, "{weak}");
        assert_eq!(rim_inset_px(f64::NAN, 0.5, 1.6, 0.15), 0.0);
    }
}
