//! Fits the map from recorded to ideal pixels to spots whose places in both are known, and says how good it is.
//!
//! Wrong spots are left out first, the same for every model: a polynomial that is at least as flexible as the one that is asked for
//! is fitted robustly (weights that fall with the residual, Huber's), then again and again to the spots within `reject_sigmas`
//! times the robust spread of its held-out residuals, until these stay the same. Then every model is fitted by plain least squares to what is
//! left and scored by what it says of spots that are held out. Beyond the spots a map goes on as a plane; see `reach.rs`.
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

/// Least robust spread of residuals that counts, px (standard deviation of a coordinate): the finder of spots knows no better,
/// and pictures without noise would lose spots to what a model cannot follow.
const LEAST_SPREAD_PX: f64 = 0.01;

/// Largest share of spots that may be left out.
const MOST_REJECTED: f64 = 0.2;

/// Spots that a polynomial needs for each coefficient: with fewer, spots that are held out say little.
const SPOTS_PER_COEFFICIENT: usize = 2;

/// The same for the polynomial by which wrong spots are told, which should not bend to them.
const SPOTS_PER_FLEXIBLE_COEFFICIENT: usize = 4;

/// Fits with falling weights, and most fits to what is left.
const ROBUST_ROUNDS: usize = 15;

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

/// Fits the models of distortion to spots: `recorded` and `target` are their recorded and their ideal pixels.
///
/// # Errors
/// See [`FitError`].
pub fn fit(recorded: &[Point2], target: &[Point2], params: &DistortionParams) -> Result<Fitted, FitError> {
    check(recorded, target, params)?;
    let used = inliers(recorded, target, params)?;
    let kept = |all: &[Point2]| -> Vec<Point2> {
        all.iter().zip(&used).filter(|(_, used)| **used).map(|(p, _)| *p).collect()
    };
    let (from, to) = (kept(recorded), kept(target));

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

    let mut of_used = chosen.held_out_px.into_iter();
    let residual = |((p, q), used): ((&Point2, &Point2), &bool)| {
        let held_out = if *used { of_used.next() } else { None };
        held_out.unwrap_or_else(|| chosen.fit.at(p).0 - q)
    };
    let held_out_px = recorded.iter().zip(target).zip(&used).map(residual).collect();
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

/// Which pairs fit a smooth map.
fn inliers(recorded: &[Point2], target: &[Point2], params: &DistortionParams) -> Result<Vec<bool>, FitError> {
    let least = if params.model == Model::Polynomial { params.degree } else { 1 };
    let mut weights = vec![1.0; recorded.len()];
    let (degree, mut solved) = flexible(recorded, target, &weights, [least, MOST_DEGREE])?;
    let distances = |solved: &Solved| -> (Vec<f64>, f64) {
        let residuals = held_out::of_polynomial(solved, recorded, target);
        // Half of the lengths of a vector whose coordinates are Gaussian are below 1.1774 standard deviations.
        let spread = held_out::quantile(&residuals, 0.5) / (2.0 * 2.0_f64.ln()).sqrt();
        (residuals.iter().map(|r| r.norm()).collect(), spread.max(LEAST_SPREAD_PX))
    };
    for _ in 0..ROBUST_ROUNDS {
        let (distances, spread) = distances(&solved);
        for (weight, distance) in weights.iter_mut().zip(distances) {
            *weight = (spread / distance.max(spread)).max(1e-6);
        }
        solved = Polynomial::fit(recorded, target, &weights, degree)?;
    }
    let most = (MOST_REJECTED * recorded.len() as f64) as usize;
    let mut used = Vec::new();
    for _ in 0..ROBUST_ROUNDS {
        let (distances, spread) = distances(&solved);
        let near: Vec<bool> = distances.iter().map(|d| *d <= params.reject_sigmas * spread).collect();
        let rejected = near.iter().filter(|near| !**near).count();
        if rejected > most {
            let (of, sigmas, spread_px) = (near.len(), params.reject_sigmas, spread);
            return Err(FitError::TooManyRejected { rejected, of, most, sigmas, spread_px });
        }
        if near == used {
            break;
        }
        used = near;
        weights = used.iter().map(|used| f64::from(u8::from(*used))).collect();
        solved = Polynomial::fit(recorded, target, &weights, degree)?;
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
