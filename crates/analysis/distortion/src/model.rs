//! Fits the map from recorded to ideal pixels to spots whose places in both are known, and says how good it is.
//!
//! Wrong spots are left out first, the same for every model. A polynomial that is at least as flexible as the one that is asked
//! for is fitted robustly (weights that fall with the residual, Huber's), then again and again to the spots within
//! `reject_sigmas` times the robust spread of its held-out residuals; then the local weighted mean judges in the same way, so
//! that a spot is wrong that disagrees with its neighbours, not one that a polynomial cannot follow. Every model is fitted by
//! plain least squares to what is left and scored by what it says of spots that are held out. Beyond the spots a map goes on
//! as a plane; see `reach.rs`.
//!
//! **Guaranteed:** scores of all models are of the same spots; the same pairs give the same bits. **Not guaranteed:** that
//! wrong spots are found where they are many and agree with each other.

use biplane_artifact::ModelScore;
use biplane_geometry::{Point2, Vector2};
use nalgebra::Matrix2;

use crate::held_out;
use crate::local_weighted_mean::{self, LocalWeightedMean};
use crate::polynomial::{self, MOST_DEGREE, Polynomial, Solved, coefficients};
use crate::reach::Reach;
use crate::stage::{DistortionParams, Model};

/// Least robust spread of residuals that counts, px (standard deviation of a coordinate). Spots of a dim rim are several times
/// as noisy as the usual one, and the map needs them there, while a wrong hole is off by whole pixels: on a real grid
/// (`tests/real_grid.rs`) 0.01 px for this uses 6352 of 6910 dots, 0.05 px uses 6635.
const LEAST_SPREAD_PX: f64 = 0.05;

/// Largest share of spots that may be left out.
const MOST_REJECTED: f64 = 0.2;

/// Spots that a polynomial needs for each coefficient: with fewer, spots that are held out say little.
const SPOTS_PER_COEFFICIENT: usize = 2;

/// The same for the polynomial by which wrong spots are told, which should not bend to them.
const SPOTS_PER_FLEXIBLE_COEFFICIENT: usize = 4;

/// Fits with falling weights, and most fits to what is left.
const ROBUST_ROUNDS: usize = 15;

/// Most fits of the local weighted mean to what is left.
const LOCAL_ROUNDS: usize = 5;

/// Highest degree of the polynomial that fills holes of the local weighted mean.
const WHOLE_DEGREE: u32 = 4;

/// Why no map was fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// A parameter out of its range.
    #[error("{name} = {found} in [distortion]: it must be {expected}")]
    Parameter {
        /// Its name.
        name: &'static str,
        /// What it is.
        found: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The two lists do not belong together, or a number in them is not finite.
    #[error(
        "{recorded} recorded and {target} ideal places of spots; both lists must be of one length, of finite numbers"
    )]
    Pairs {
        /// Length of the one.
        recorded: usize,
        /// Length of the other.
        target: usize,
    },
    /// Too few spots for the model.
    #[error(
        "{found} spots can be used, a {model} needs {needed}: lower `degree`, choose another model, or use a plate with more holes"
    )]
    TooFew {
        /// The model.
        model: String,
        /// Spots.
        found: usize,
        /// Spots that it needs.
        needed: usize,
    },
    /// The spots do not determine the model.
    #[error(
        "the {found} spots do not determine a {model} (condition number {condition:.1e}): they lie on few lines or circles; use \
         spots that fill the picture, or lower `degree`"
    )]
    BadlyPlaced {
        /// The model.
        model: String,
        /// Spots.
        found: usize,
        /// By how much their errors would be magnified.
        condition: f64,
    },
    /// So many spots fit no map that nothing can be said.
    #[error(
        "{rejected} of {of} spots lie farther than reject_sigmas = {sigmas} times {spread_px:.3} px from any smooth map, at most \
         {most} may: spots are matched to wrong holes, or this is no picture of this plate"
    )]
    TooManyRejected {
        /// Spots that would be left out.
        rejected: usize,
        /// Of so many.
        of: usize,
        /// So many may.
        most: usize,
        /// The limit.
        sigmas: f64,
        /// Its unit: robust standard deviation of each coordinate of a residual, px.
        spread_px: f64,
    },
}

/// One model, fitted.
#[derive(Debug, Clone)]
enum Fit {
    Polynomial(Polynomial),
    LocalWeightedMean(LocalWeightedMean),
}

impl Fit {
    fn at(&self, p: &Point2) -> (Point2, Matrix2<f64>) {
        match self {
            Self::Polynomial(m) => m.at(p),
            Self::LocalWeightedMean(m) => m.at(p),
        }
    }
}

/// A map from recorded to ideal pixels, with what is known of its quality.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// The model that was chosen: its name as in `scores`.
    pub model: String,
    /// All models that the spots suffice for, polynomials by degree and then the local weighted mean; all on the spots that are used.
    pub scores: Vec<ModelScore>,
    /// Of each pair: where a map that was fitted without it takes it, less where it belongs, ideal px.
    pub held_out_px: Vec<Vector2>,
    /// Of each pair: whether the map was fitted to it.
    pub used: Vec<bool>,
    fit: Fit,
    pub(crate) reach: Reach,
}

impl Fitted {
    /// The ideal pixel of a recorded one, also beyond the spots.
    pub fn ideal(&self, recorded: &Point2) -> Point2 {
        self.reach.continued(recorded, |p| self.fit.at(p))
    }

    /// The score of the chosen model.
    pub fn score(&self) -> Option<&ModelScore> {
        self.scores.iter().find(|s| s.name == self.model)
    }
}

/// A model that was fitted to the spots that are used.
struct Candidate {
    score: ModelScore,
    fit: Fit,
    held_out_px: Vec<Vector2>,
}

impl Candidate {
    /// Held-out residuals of all pairs: of those that are not used, what the map says of them.
    fn held_out_of_all(&self, recorded: &[Point2], target: &[Point2], used: &[bool]) -> Vec<Vector2> {
        let mut of_used = self.held_out_px.iter();
        let residual = |((p, q), used): ((&Point2, &Point2), &bool)| {
            let held_out = if *used { of_used.next().copied() } else { None };
            held_out.unwrap_or_else(|| self.fit.at(p).0 - q)
        };
        recorded.iter().zip(target).zip(used).map(residual).collect()
    }
}

/// The points that are used.
fn kept(all: &[Point2], used: &[bool]) -> Vec<Point2> {
    all.iter().zip(used).filter(|(_, used)| **used).map(|(p, _)| *p).collect()
}

/// Fits the models of distortion to spots: `recorded` and `target` are their recorded and their ideal pixels.
///
/// # Errors
/// See [`FitError`].
pub fn fit(recorded: &[Point2], target: &[Point2], params: &DistortionParams) -> Result<Fitted, FitError> {
    check(recorded, target, params)?;
    let used = inliers(recorded, target, params)?;
    let (from, to) = (kept(recorded, &used), kept(target, &used));

    let polynomials = (1..=MOST_DEGREE).map(|degree| polynomial_candidate(&from, &to, degree));
    let mut candidates: Vec<Result<Candidate, FitError>> = polynomials.collect();
    candidates.push(local_candidate(&from, &to, params.neighbours));
    let scores = candidates.iter().flatten().map(|c| c.score.clone()).collect();
    let chosen = match params.model {
        Model::Polynomial => candidates.swap_remove(params.degree as usize - 1)?,
        Model::LocalWeightedMean => candidates.swap_remove(MOST_DEGREE as usize)?,
        Model::Best => {
            let held_out = |c: &Result<Candidate, FitError>| {
                c.as_ref().map_or(f64::INFINITY, |c| c.score.held_out_rms_px)
            };
            let least = (0..candidates.len())
                .min_by(|a, b| held_out(&candidates[*a]).total_cmp(&held_out(&candidates[*b])));
            candidates.swap_remove(least.unwrap_or_default())?
        }
    };

    let held_out_px = chosen.held_out_of_all(recorded, target, &used);
    let reach = Reach::new(&from);
    Ok(Fitted { model: chosen.score.name, scores, held_out_px, used, fit: chosen.fit, reach })
}

/// Refuses parameters out of range, and lists that are no pairs.
fn check(recorded: &[Point2], target: &[Point2], params: &DistortionParams) -> Result<(), FitError> {
    let wrong = |name, found, expected| Err(FitError::Parameter { name, found, expected });
    if !(1..=MOST_DEGREE).contains(&params.degree) {
        return wrong("degree", f64::from(params.degree), "1 to 7");
    }
    if !(6..=50).contains(&params.neighbours) {
        return wrong("neighbours", params.neighbours as f64, "6 to 50");
    }
    if !(2.0..=1e9).contains(&params.reject_sigmas) {
        return wrong("reject_sigmas", params.reject_sigmas, "at least 2");
    }
    let finite = recorded.iter().chain(target).all(|p| p.coords.iter().all(|c| c.abs() < 1e9));
    if recorded.len() != target.len() || !finite {
        return Err(FitError::Pairs { recorded: recorded.len(), target: target.len() });
    }
    Ok(())
}

/// The polynomial of the highest degree, `least` to `most`, for which each coefficient has some spots; of degree `least` in any
/// case.
fn flexible(
    recorded: &[Point2],
    target: &[Point2],
    weights: &[f64],
    [least, most]: [u32; 2],
) -> Result<(u32, Solved), FitError> {
    let mut degrees = (least..=most)
        .rev()
        .filter(|d| *d == least || recorded.len() >= SPOTS_PER_FLEXIBLE_COEFFICIENT * coefficients(*d));
    let first = degrees.find_map(|d| Polynomial::fit(recorded, target, weights, d).ok().map(|s| (d, s)));
    first.map_or_else(|| Polynomial::fit(recorded, target, weights, least).map(|s| (least, s)), Ok)
}

/// Lengths of residuals and their robust spread: the standard deviation of a coordinate, were they Gaussian.
fn distances(residuals: &[Vector2]) -> (Vec<f64>, f64) {
    // Half of the lengths of a Gaussian vector are below 1.1774 standard deviations.
    let spread = held_out::quantile(residuals, 0.5) / (2.0 * 2.0_f64.ln()).sqrt();
    (residuals.iter().map(|r| r.norm()).collect(), spread.max(LEAST_SPREAD_PX))
}

/// Which pairs fit a smooth map.
fn inliers(recorded: &[Point2], target: &[Point2], params: &DistortionParams) -> Result<Vec<bool>, FitError> {
    let least = if params.model == Model::Polynomial { params.degree } else { 1 };
    let mut weights = vec![1.0; recorded.len()];
    let (degree, mut solved) = flexible(recorded, target, &weights, [least, MOST_DEGREE])?;
    for _ in 0..ROBUST_ROUNDS {
        let (distances, spread) = distances(&held_out::of_polynomial(&solved, recorded, target));
        for (weight, distance) in weights.iter_mut().zip(distances) {
            *weight = (spread / distance.max(spread)).max(1e-6);
        }
        solved = Polynomial::fit(recorded, target, &weights, degree)?;
    }
    let (mut used, mut spread_px) = (Vec::new(), 0.0);
    // Whether those that are near are the same as before.
    let mut settle = |residuals: &[Vector2], used: &mut Vec<bool>| {
        let (distances, spread) = distances(residuals);
        let near: Vec<bool> = distances.iter().map(|d| *d <= params.reject_sigmas * spread).collect();
        spread_px = spread;
        std::mem::replace(used, near) == *used
    };
    for _ in 0..ROBUST_ROUNDS {
        if settle(&held_out::of_polynomial(&solved, recorded, target), &mut used) {
            break;
        }
        weights = used.iter().map(|used| f64::from(u8::from(*used))).collect();
        solved = Polynomial::fit(recorded, target, &weights, degree)?;
    }
    // What a polynomial cannot follow is no fault of a spot that agrees with its neighbours.
    for _ in 0..LOCAL_ROUNDS {
        let local = local_candidate(&kept(recorded, &used), &kept(target, &used), params.neighbours);
        let Ok(local) = local else { break };
        if settle(&local.held_out_of_all(recorded, target, &used), &mut used) {
            break;
        }
    }
    let (of, sigmas) = (used.len(), params.reject_sigmas);
    let rejected = used.iter().filter(|used| !**used).count();
    let most = (MOST_REJECTED * of as f64) as usize;
    if rejected > most {
        return Err(FitError::TooManyRejected { rejected, of, most, sigmas, spread_px });
    }
    Ok(used)
}

/// A polynomial with its score.
fn polynomial_candidate(from: &[Point2], to: &[Point2], degree: u32) -> Result<Candidate, FitError> {
    let (model, found) = (polynomial::name(degree), from.len());
    let needed = SPOTS_PER_COEFFICIENT * coefficients(degree);
    if found < needed {
        return Err(FitError::TooFew { model, found, needed });
    }
    let solved = Polynomial::fit(from, to, &vec![1.0; found], degree)?;
    let held_out_px = held_out::of_polynomial(&solved, from, to);
    let fit = Fit::Polynomial(solved.polynomial);
    Ok(Candidate { score: held_out::score(model, residuals(&fit, from, to), &held_out_px), fit, held_out_px })
}

/// The local weighted mean with its score.
fn local_candidate(from: &[Point2], to: &[Point2], neighbours: usize) -> Result<Candidate, FitError> {
    let (model, found) = (local_weighted_mean::NAME.to_owned(), from.len());
    if found <= neighbours {
        return Err(FitError::TooFew { model, found, needed: neighbours + 1 });
    }
    let (_, whole) = flexible(from, to, &vec![1.0; found], [1, WHOLE_DEGREE])?;
    let (map, held_out) = LocalWeightedMean::fit(from, to, neighbours, &whole.polynomial);
    let held_out_px: Vec<Vector2> = held_out.iter().zip(to).map(|(p, q)| p - q).collect();
    let fit = Fit::LocalWeightedMean(map);
    Ok(Candidate { score: held_out::score(model, residuals(&fit, from, to), &held_out_px), fit, held_out_px })
}

/// Where a model takes spots, less where they belong.
fn residuals(fit: &Fit, from: &[Point2], to: &[Point2]) -> impl Iterator<Item = Vector2> {
    from.iter().zip(to).map(|(p, q)| fit.at(p).0 - q)
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_phantom::{IntensifierDistortion, Plate, PlatePlacement, SpotPattern, SpotRadii, biplane};
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// Distortion at its worst by the project's goal: 12 px of pincushion and of S at the rim.
    fn bent() -> IntensifierDistortion {
        IntensifierDistortion {
            pincushion_px: 12.0,
            s_shape_px: 12.0,
            shift_px: Vector2::new(2.0, -1.0),
            ..IntensifierDistortion::none([1024, 1024])
        }
    }

    /// Recorded centres with noise and ideal places of the spots of a plate that lie within the intensifier's border.
    fn pairs(
        plate: &Plate,
        distortion: &IntensifierDistortion,
        noise_px: f64,
        seed: u64,
    ) -> [Vec<Point2>; 2] {
        let view = &biplane(90.0)[0];
        let pose = PlatePlacement { turn_rad: 0.3, shift_mm: [4.0, -3.0], ..PlatePlacement::on_detector() }
            .pose(view);
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut noise = || noise_px * random.sample::<f64, _>(StandardNormal);
        plate
            .seen(&pose, view, distortion)
            .into_iter()
            .filter(|s| (s.centroid - Point2::new(511.5, 511.5)).norm() < 498.0)
            .map(|s| (s.centroid + Vector2::new(noise(), noise()), s.ideal))
            .unzip::<_, _, Vec<_>, Vec<_>>()
            .into()
    }

    /// Root mean square and largest error of the map inside 95 % of the radius.
    fn true_error(fitted: &Fitted, distortion: &IntensifierDistortion) -> [f64; 2] {
        let grid = (0..103)
            .flat_map(|j| (0..103).map(move |i| Point2::new(f64::from(i) * 10.0, f64::from(j) * 10.0)));
        let inside = grid.filter(|p| (p - Point2::new(511.5, 511.5)).norm() < 0.95 * 512.0);
        let errors: Vec<Vector2> = inside.map(|p| fitted.ideal(&p) - distortion.ideal(&p)).collect();
        [held_out::rms(errors.iter().copied()), held_out::quantile(&errors, 1.0)]
    }

    /// A polynomial of the default degree.
    fn polynomial() -> DistortionParams {
        DistortionParams { model: Model::Polynomial, ..DistortionParams::default() }
    }

    fn plates() -> [Plate; 3] {
        let radii = SpotRadii { centre: 2.2, orientation: 1.9, others: 1.25 };
        let square = SpotPattern::Square { pitch_mm: 10.0, reach_mm: 165.0 };
        let hexagonal = SpotPattern::Hexagonal { pitch_mm: 8.0, reach_mm: 165.0 };
        [Plate::concentric(), Plate::perforated(square.spots(radii)), Plate::dotted(hexagonal.spots(radii))]
    }

    #[test]
    fn the_default_reaches_the_goal_and_the_degree_of_the_thesis_does_worse() {
        for (plate, seed) in plates().iter().zip(1..) {
            let [from, to] = pairs(plate, &bent(), 0.03, seed);
            let fitted = fit(&from, &to, &DistortionParams::default()).unwrap();
            assert_eq!(fitted.model, "polynomial, degree 5");
            // The project's goal is 0.05 px inside 95 % of the radius.
            let [rms, worst] = true_error(&fitted, &bent());
            assert!(rms < 0.012 && worst < 0.05, "{rms} px, {worst} px at most");
            // A degree less leaves out what the inverse of the cubic map has of the fifth power.
            let less = DistortionParams { degree: 4, ..polynomial() };
            let less = fit(&from, &to, &less).unwrap();
            assert!(true_error(&less, &bent())[0] > 2.0 * rms);
            assert!(less.score().unwrap().held_out_rms_px > 1.1 * fitted.score().unwrap().held_out_rms_px);
            assert_eq!(fitted.scores.len(), 8);
            assert!(fitted.used.iter().all(|u| *u));
        }
    }

    #[test]
    fn what_the_leverage_says_of_a_spot_held_out_is_what_a_fit_without_it_says() {
        let [from, to] = pairs(&plates()[1], &bent(), 0.1, 3);
        let params = DistortionParams { degree: 6, ..polynomial() };
        let fitted = fit(&from, &to, &params).unwrap();
        for of in [0, 5, 333, from.len() - 1] {
            let mut weights = vec![1.0; from.len()];
            weights[of] = 0.0;
            let without = Polynomial::fit(&from, &to, &weights, 6).unwrap().polynomial;
            assert!((without.at(&from[of]).0 - to[of] - fitted.held_out_px[of]).norm() < 1e-9);
        }
    }

    #[test]
    fn spots_of_wrong_holes_are_left_out_and_do_no_harm() {
        let clean = pairs(&plates()[1], &bent(), 0.03, 9);
        let [mut from, to] = clean.clone();
        // One in twelve is off by a hole (32 px) or by what a scratch does to it, on one side of the picture.
        let wrong = |i: usize| i.is_multiple_of(6) && to[i].x > 500.0;
        for i in (0..from.len()).filter(|i| wrong(*i)) {
            from[i] += if i.is_multiple_of(12) { Vector2::new(32.0, 3.0) } else { Vector2::new(-0.4, 0.5) };
        }
        for model in [Model::Polynomial, Model::LocalWeightedMean, Model::Best] {
            let params = DistortionParams { model, ..polynomial() };
            let fitted = fit(&from, &to, &params).unwrap();
            for (i, used) in fitted.used.iter().enumerate() {
                assert_eq!(*used, !wrong(i), "{i}: {}", fitted.held_out_px[i].norm());
                assert_eq!(fitted.held_out_px[i].norm() < 0.3, *used);
            }
            assert!(true_error(&fitted, &bent())[0] < 0.03);
        }
        // Where every third is wrong nothing is said.
        let [mut from, to] = clean;
        from.iter_mut().step_by(3).for_each(|p| p.x += 32.0);
        let error = fit(&from, &to, &polynomial()).unwrap_err();
        assert!(matches!(error, FitError::TooManyRejected { .. }), "{error}");
    }

    #[test]
    fn the_best_model_is_that_of_the_least_held_out_residual() {
        let best = DistortionParams { model: Model::Best, ..polynomial() };
        let [from, to] = pairs(&plates()[2], &bent(), 0.02, 4);
        let fitted = fit(&from, &to, &best).unwrap();
        assert_eq!(fitted.model, "polynomial, degree 5");
        // A dent of 60 px that no polynomial follows, though other spots agree with those in it.
        let dent = |p: &Point2| {
            Vector2::new(1.0, -0.5) * (-(p - Point2::new(400.0, 600.0)).norm_squared() / 7200.0).exp()
        };
        let to: Vec<Point2> = from.iter().zip(&to).map(|(p, q)| q + dent(p)).collect();
        let fitted = fit(&from, &to, &best).unwrap();
        assert_eq!(fitted.model, "local weighted mean");
        let least = fitted.scores.iter().map(|s| s.held_out_rms_px).fold(f64::INFINITY, f64::min);
        assert_eq!(fitted.score().unwrap().held_out_rms_px, least);
    }

    #[test]
    fn a_table_follows_its_map_and_leads_back() {
        let [from, to] = pairs(&plates()[0], &bent(), 0.03, 6);
        for model in [Model::Polynomial, Model::LocalWeightedMean] {
            let fitted = fit(&from, &to, &DistortionParams { model, ..polynomial() }).unwrap();
            let sampled = fitted.table([1024, 1024]);
            assert!(sampled.error_px < 1e-3 && sampled.round_trip_px < 1.1e-3, "{sampled:?}");
            let read = biplane_fluoroscope::Distortion::from(&sampled.table);
            for p in from.iter().map(|p| p + Vector2::new(3.3, -7.1)) {
                assert!((read.ideal(&p) - fitted.ideal(&p)).norm() < 1e-3);
            }
        }
    }

    #[test]
    fn beyond_the_spots_no_map_runs_away() {
        let [from, to] = pairs(&plates()[0], &bent(), 0.1, 6);
        let models = [(Model::Polynomial, 5), (Model::Polynomial, 7), (Model::LocalWeightedMean, 5)];
        for (model, degree) in models {
            let params = DistortionParams { model, degree, ..polynomial() };
            let fitted = fit(&from, &to, &params).unwrap();
            for corner in [Point2::new(0.0, 0.0), Point2::new(1023.0, 0.0), Point2::new(-50.0, 1073.0)] {
                // What a plane leaves of 17 px (12 each way) times the third power of the distance.
                let r = (corner - Point2::new(511.5, 511.5)).norm() / 512.0;
                let error = (fitted.ideal(&corner) - bent().ideal(&corner)).norm();
                assert!(
                    error < 17.0 * (r.powi(3) - 3.0 * r + 2.0),
                    "{model:?} {degree}: {error} px at {corner}"
                );
            }
        }
    }

    #[test]
    fn what_cannot_be_fitted_is_an_error_with_its_numbers() {
        let [from, to] = pairs(&plates()[0], &bent(), 0.03, 6);
        let of = |count: usize, degree: u32| {
            let params = DistortionParams { degree, ..polynomial() };
            fit(&from[..count], &to[..count], &params).map(|f| f.scores.len())
        };
        let too_few = |found, degree: u32, needed| {
            Err(FitError::TooFew { model: format!("polynomial, degree {degree}"), found, needed })
        };
        assert_eq!(of(29, 4), too_few(29, 4, 30));
        assert_eq!(of(10, 4), too_few(10, 4, 15));
        assert_eq!(of(0, 1), too_few(0, 1, 3));
        let line: Vec<Point2> = (0..80).map(|k| Point2::new(f64::from(k), 2.0 * f64::from(k))).collect();
        let circle: Vec<Point2> =
            (0..80).map(|k| Point2::new(f64::from(k).cos(), f64::from(k).sin()) * 300.0).collect();
        for spots in [line, circle, vec![Point2::origin(); 80]] {
            let error = fit(&spots, &spots, &polynomial()).unwrap_err();
            assert!(matches!(error, FitError::BadlyPlaced { found: 80, .. }), "{error}");
        }
        let with = |params: DistortionParams| fit(&from, &to, &params).map(|_| ()).unwrap_err().to_string();
        let usual = polynomial;
        assert!(with(DistortionParams { degree: 8, ..usual() }).starts_with("degree = 8 in [distortion]"));
        assert!(with(DistortionParams { neighbours: 5, ..usual() }).contains("6 to 50"));
        assert!(with(DistortionParams { reject_sigmas: f64::NAN, ..usual() }).contains("at least 2"));
        assert!(matches!(fit(&from, &to[1..], &usual()), Err(FitError::Pairs { .. })));
        let mut broken = to.clone();
        broken[3].x = f64::NAN;
        assert!(matches!(fit(&from, &broken, &usual()), Err(FitError::Pairs { .. })));
    }
}
