//! What attenuates and what blurs, from how far the edges of a body lie beside its outline.
//!
//! Gauss and Newton on all samples of all views at once. Unknown are the motion that the pose still wants (as nuisance: what the
//! motion explains is no bias), the attenuation (its logarithm) and the blur, which the views share, and an inset of each view that
//! the prediction does not know of. Robust weights (Geman and McClure) as in matching. Every unknown but the motion has a prior: where
//! the outline does not tell it, that is what is answered.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

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

    /// What is left of each residual, px, and by how much the logarithms of attenuation and blur change it.
    fn left(&self, samples: &[Sample]) -> Vec<Left> {
        let of = |s: &Sample| {
            let (bias, by_attenuation, by_blur) = s
                .chords
                .as_ref()
                .map_or((0.0, 0.0, 0.0), |c| differentiated(c, self.attenuation_per_mm, self.blur_px));
            let own = self.inset_px.get(s.view).copied().unwrap_or(0.0);
            let px = s.residual_px + bias + own - s.motion.dot(&self.motion);
            Left { px, by_attenuation, by_blur }
        };
        samples.iter().map(of).collect()
    }

    fn step(&mut self, samples: &[Sample], prior: &Prior) -> Option<()> {
        let views = self.inset_px.len();
        let left = self.left(samples);
        let sigma = spread(&left)?;
        let mut normal = Normal::new(views);
        for (s, l) in samples.iter().zip(&left) {
            let weight = robust(sigma, l.px) * s.length_px / (prior.correlation_px * sigma * sigma);
            normal.add(s, l, weight);
        }
        for k in 0..6 {
            normal.know(k, prior.motion_sigma[k], self.motion[k]);
        }
        self.know(&mut normal, prior);
        let step = normal.matrix.cholesky()?.solve(&normal.vector);
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

    /// What is known of all but the motion.
    fn know(&self, normal: &mut Normal, prior: &Prior) {
        let off = (self.attenuation_per_mm / prior.attenuation_per_mm).ln();
        normal.know(6, prior.attenuation_ln_sigma, off);
        // The blur's logarithm is moved, its size has the prior.
        let off = (self.blur_px - prior.blur_px) / self.blur_px;
        normal.know(7, prior.blur_sigma_px / self.blur_px, off);
        for (view, inset) in self.inset_px.iter().enumerate() {
            normal.know(8 + view, prior.inset_sigma_px, *inset);
        }
    }

    /// Covariance of the motion, with what is not known of attenuation, blur and insets in it: a sandwich, in which residuals within one
    /// correlation length are one observation. None where a motion is not held by anything.
    pub fn covariance(&self, samples: &[Sample], prior: &Prior) -> Option<Matrix6<f64>> {
        let (views, left) = (self.inset_px.len(), self.left(samples));
        let sigma = spread(&left)?;
        // Sums of weight, of its square, of weighted and twice weighted squares, and of the slope of weight times residual.
        let mut sums = [0.0; 5];
        for (s, l) in samples.iter().zip(&left) {
            let (w, squared) = (robust(sigma, l.px), l.px * l.px);
            let far = squared / scale_squared(sigma);
            let slope = w * (1.0 - 3.0 * far) / (1.0 + far);
            for (sum, term) in sums.iter_mut().zip([w, w * w, w * squared, w * w * squared, slope]) {
                *sum += s.length_px * term;
            }
        }
        let (count, fitted) = (samples.len() as f64, 8.0 + views as f64);
        let [weight, twice, squared, twice_squared, slope] = sums;
        if weight <= 0.0 || slope <= 0.0 || count <= fitted {
            return None;
        }
        let free = count / (count - fitted);
        let variance = (squared / weight * free).max(LEAST_SIGMA_PX * LEAST_SIGMA_PX);
        let [mut normal, mut noise] = [Normal::new(views), Normal::new(views)];
        for (s, l) in samples.iter().zip(&left) {
            let (w, share) = (robust(sigma, l.px), s.length_px / (prior.correlation_px * variance));
            normal.add(s, l, w * share * slope / weight);
            noise.add(s, l, w * w * share * (twice_squared / twice * free / variance));
        }
        self.know(&mut normal, prior);
        self.know(&mut noise, prior);
        let inverse = normal.matrix.cholesky()?.inverse();
        let all = &inverse * noise.matrix * &inverse;
        Some(Matrix6::from_fn(|i, j| all[(i, j)])).filter(|c| c.iter().all(|v| v.is_finite()))
    }
}

/// What a residual leaves.
struct Left {
    px: f64,
    by_attenuation: f64,
    by_blur: f64,
}

/// Standard deviation by the median size, px; none of nothing.
fn spread(left: &[Left]) -> Option<f64> {
    let mut sizes: Vec<f64> = left.iter().map(|l| l.px.abs()).collect();
    if sizes.is_empty() {
        return None;
    }
    let middle = sizes.len() / 2;
    let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    Some((median / MEDIAN_SIZE).max(LEAST_SIGMA_PX))
}

/// Square of the robust weight's scale, px^2.
fn scale_squared(sigma: f64) -> f64 {
    (2.5 * sigma).max(LEAST_SCALE_PX).powi(2)
}

/// Geman and McClure's weight.
fn robust(sigma: f64, px: f64) -> f64 {
    let scale_squared = scale_squared(sigma);
    (scale_squared / (scale_squared + px * px)).powi(2)
}

/// Normal equations: six of the motion, the logarithms of attenuation and blur, an inset a view.
struct Normal {
    matrix: DMatrix<f64>,
    vector: DVector<f64>,
}

impl Normal {
    fn new(views: usize) -> Self {
        let count = 8 + views;
        Self { matrix: DMatrix::zeros(count, count), vector: DVector::zeros(count) }
    }

    fn add(&mut self, sample: &Sample, left: &Left, weight: f64) {
        // Of what is left, by the unknowns; a view's inset is one of them.
        let mut row = [0.0; 9];
        row[..6].copy_from_slice((-sample.motion).as_slice());
        row[6..].copy_from_slice(&[left.by_attenuation, left.by_blur, 1.0]);
        let place = |k: usize| if k < 8 { k } else { 8 + sample.view };
        for (k, a) in row.iter().enumerate() {
            self.vector[place(k)] -= weight * a * left.px;
            for (l, b) in row.iter().enumerate() {
                self.matrix[(place(k), place(l))] += weight * a * b;
            }
        }
    }

    /// A further observation of an unknown; one without deviation is held.
    fn know(&mut self, k: usize, sigma: f64, off: f64) {
        if sigma > 0.0 {
            self.matrix[(k, k)] += 1.0 / (sigma * sigma);
            self.vector[k] -= off / (sigma * sigma);
        } else {
            self.matrix.row_mut(k).fill(0.0);
            self.matrix.column_mut(k).fill(0.0);
            self.matrix[(k, k)] = 1.0;
            self.vector[k] = 0.0;
        }
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
        samples_of(2, radii, truth, motion, wrong)
    }

    fn samples_of(
        seed: u64,
        radii: [f64; 2],
        truth: (f64, f64),
        motion: &Vector6<f64>,
        wrong: f64,
    ) -> Vec<Sample> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
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
    fn the_covariance_is_the_scatter_of_the_motion() {
        // Each sample is an observation of its own here, and the noise is even between -0.05 and 0.05 px.
        let prior = Prior { correlation_px: 4.0, ..prior() };
        let (mut mean, mut count) = (0.0, 0.0);
        for seed in 0..60 {
            let samples = samples_of(seed, [0.5, 40.0], (0.3, 1.65), &Vector6::zeros(), 0.0);
            let mut found = Estimate::of(&prior, 2);
            for _ in 0..3 {
                found.refine(&samples, &prior);
            }
            let covariance = found.covariance(&samples, &prior).unwrap();
            mean += found.motion.dot(&(covariance.try_inverse().unwrap() * found.motion));
            count += 1.0;
        }
        assert!((4.5..7.5).contains(&(mean / count)), "{}, where 6 would be right", mean / count);
        assert_eq!(Estimate::of(&prior, 2).covariance(&[], &prior), None);
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
