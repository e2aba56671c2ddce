//! From a picture to its spots: border, candidates, a first fit of each by itself, a second one that knows its neighbours and the light
//! around, and the rules by which a fit is a spot.

use biplane_artifact::{Circle, Frame, Spot, Spots};

use crate::border::{border, mirrored_beyond};
use crate::candidates::{Candidate, candidates};
use crate::cells::Cells;
use crate::fit::{Effort, Fit, fit};
use crate::ground::{Outside, Ridges, about_plane, unevenness};
use crate::noise::Correlation;
use crate::profile::{COUNT, Parameters, light_and_derivative};
use crate::window::{Field, Round, Window};
use crate::{Look, SpotError, SpotParams};
use biplane_grey::Grey;

/// Spots on whose surroundings the noise is measured.
const NOISE_WINDOWS: usize = 64;
/// Unevenness of the light about a spot, in its contrast, from which on a plane does not do.
const UNEVEN: f64 = 0.015;
/// Radius from which on a first fit looks at every second pixel, px.
const FINE: f64 = 9.0;
/// Elongation beyond which a spot is two, or part of one.
const LONGEST: f64 = 1.35;
/// Residual beyond which a spot is two, or something lies across it, in residuals of the other spots.
const MISFIT: f64 = 2.5;
/// Residual that any spot may have, in its contrast.
const LEAST_MISFIT: f64 = 0.02;
/// Fewer spots than any plate or frame has.
const FEW: usize = 4;
/// Grey level at the top of the scale.
const WHITE: f64 = 254.0;
/// Least share of the noise that is left in residuals.
const LEAST_LEFT: f64 = 0.2;

/// The round border of an intensifier's picture; none where the picture fills its rectangle, or is not what its size says.
pub fn find_border(frame: &Frame) -> Option<Circle> {
    let whole = frame.width.checked_mul(frame.height) == Some(frame.samples.len());
    (whole && !frame.samples.is_empty()).then(|| border(&Grey::of(frame)))?
}

/// The round spots of a picture.
///
/// # Errors
/// A parameter out of range; a frame that does not hold what its size says.
pub fn find_spots(frame: &Frame, params: &SpotParams) -> Result<Spots, SpotError> {
    params.settings.check()?;
    let &Frame { width, height, ref samples, .. } = frame;
    if width.checked_mul(height) != Some(samples.len()) {
        return Err(SpotError::Picture { width, height, samples: samples.len() });
    }
    let empty = Spots { size: [width, height], spots: Vec::new(), border: None, warnings: Vec::new() };
    if samples.is_empty() {
        return Ok(empty);
    }
    let grey = Grey::of(frame);
    let border = border(&grey);
    let even = border.map_or_else(|| grey.clone(), |circle| mirrored_beyond(&grey, &circle));
    let finder = Finder { field: Field { grey: &grey, border }, params, noise: grey.noise() };
    let mut spots = finder.spots(&even);
    spots.sort_by(|a, b| a.at_px[1].total_cmp(&b.at_px[1]).then(a.at_px[0].total_cmp(&b.at_px[0])));
    let warnings = finder.warnings(&spots, &even);
    Ok(Spots { spots, border, warnings, ..empty })
}

/// What a window has shown.
#[derive(Debug, Clone)]
struct Found {
    round: Round,
    elongation: f64,
    contrast: f64,
    blur: f64,
    /// Grey levels.
    residual: f64,
    sigma: f64,
    /// Share of the spread of the window's pixels that the profile explains.
    explained: f64,
    /// In radii of the window about the round's middle: a start for the next fit.
    parameters: Parameters,
}

impl Found {
    /// Residual in contrasts.
    fn misfit(&self) -> f64 {
        self.residual / self.contrast
    }
}

/// Median misfit.
fn usual_misfit(found: &[Found]) -> f64 {
    let mut all: Vec<f64> = found.iter().map(Found::misfit).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

struct Finder<'a> {
    field: Field<'a>,
    params: &'a SpotParams,
    noise: f64,
}

impl Finder<'_> {
    fn spots(&self, even: &Grey) -> Vec<Spot> {
        let settings = &self.params.settings;
        let least = (0.5 * settings.min_contrast).max(3.0 * self.noise).max(0.5);
        let radii = [settings.min_radius_px, settings.max_radius_px];
        let mut places = candidates(even, self.params.look, radii, least);
        places.retain(|c| self.field.depth(c.at) > 0.0);

        let first = distinct(self.alone(&places), &self.field);

        let near = Neighbours::of(first.iter().map(|f| f.round), &self.field);
        let correlation = self.correlation(&first, &near);
        let again = |(i, f): (usize, &Found)| {
            let own = near.rounds[i];
            let reach = own.radius + (3.5 * f.blur).max(0.25 * own.radius).max(4.0);
            let others = near.about(i, reach);
            let mut window = self.field.window(&own, reach, &others, 1);
            if let Some(ridges) = self.ridges(f, &near.about(i, ground_reach(f) * 1.5)) {
                let floor = self.floor(&own);
                for px in &mut window.pixels {
                    px.ground = (ridges.light(px.x * own.radius, px.y * own.radius) - floor).max(1.0);
                    px.value -= floor;
                }
            }
            let mut start = f.parameters;
            if window.pixels.iter().any(|px| px.ground != 1.0) {
                (start[8], start[9], start[10]) = (1.0, 0.0, 0.0);
            }
            let fit = fit(&window.pixels, &start, &Effort::FINE)?;
            let found = self.found(&own, &window, &fit, Some(&correlation));
            self.is_spot(&found).then_some(found)
        };
        let second = distinct(first.iter().enumerate().filter_map(again).collect(), &self.field);
        let near = Neighbours::of(second.iter().map(|f| f.round), &self.field);
        let usual = usual_misfit(&second);
        second.iter().enumerate().map(|(i, f)| self.spot(i, f, &near, usual)).collect()
    }

    /// A first fit of each candidate, the strongest first. The rim of a large spot has corners that are candidates too: those that lie in a
    /// spot that was found are none, and none counts as a neighbour of one that is twice as strong.
    fn alone(&self, places: &[Candidate]) -> Vec<Found> {
        let mut near =
            Neighbours::of(places.iter().map(|c| Round { at: c.at, radius: c.radius }), &self.field);
        let mut is_taken = vec![false; places.len()];
        let mut all = Vec::new();
        for (i, c) in places.iter().enumerate() {
            if is_taken[i] {
                continue;
            }
            let own = near.rounds[i];
            let reach = own.radius + (0.25 * own.radius).max(4.0);
            let others =
                near.numbers(i, reach).filter(|&k| !is_taken[k] && places[k].contrast > 0.5 * c.contrast);
            let others: Vec<Round> = others.map(|k| near.rounds[k]).collect();
            let window = self.field.window(&own, reach, &others, 1 + (own.radius / FINE) as usize);
            let found = fit(&window.pixels, &self.start(c), &Effort::ROUGH)
                .map(|fit| self.found(&own, &window, &fit, None));
            if let Some(found) = found.filter(|f| self.is_spot(f)) {
                near.rounds[i] = found.round;
                near.largest = near.largest.max(found.round.radius);
                let within = near.numbers(i, found.round.radius + 1.0);
                let within: Vec<usize> = within
                    .filter(|&k| k > i && near.rounds[k].distance(&found.round) < found.round.radius + 1.0)
                    .collect();
                within.into_iter().for_each(|k| is_taken[k] = true);
                all.push(found);
            }
        }
        all
    }

    /// The light that uneven light behind a spot has no part in: what comes through the middle of a bead is scatter and darkness.
    fn floor(&self, own: &Round) -> f64 {
        match self.params.look {
            Look::Bright => 0.0,
            Look::Dark => {
                let (s, [x, y]) = (0.2 * own.radius, own.at);
                let about = [[x - s, y], [x + s, y], [x, y - s], [x, y + s]];
                about.iter().map(|p| self.field.grey.at(p[0], p[1])).sum::<f64>() / 4.0
            }
        }
    }

    /// What is worth a look, for people.
    fn warnings(&self, spots: &[Spot], even: &Grey) -> Vec<String> {
        let mut warnings = Vec::new();
        let (name, other, other_name) = match self.params.look {
            Look::Bright => ("bright", Look::Dark, "dark"),
            Look::Dark => ("dark", Look::Bright, "bright"),
        };
        if spots.len() < FEW {
            let settings = &self.params.settings;
            let mut text = format!(
                "{} {name} spots of {} to {} px radius and {} grey levels contrast",
                spots.len(),
                settings.min_radius_px,
                settings.max_radius_px,
                settings.min_contrast
            );
            let params = SpotParams { look: other, settings: settings.clone() };
            let others = Finder { params: &params, ..*self }.spots(even).len();
            if others >= FEW {
                text += &format!(", but {others} {other_name} ones: is it the right picture?");
            } else {
                text += ": is it the right picture, or do [spots] min_radius_px, max_radius_px, min_contrast rule them out?";
            }
            warnings.push(text);
        }
        let saturated = spots.iter().filter(|s| self.is_saturated(s)).count();
        if saturated > 0 {
            warnings.push(format!(
                "the light of {saturated} of {} spots is at the top of the scale, which can move their centres by some tenths of \
                 a pixel where the light is uneven; take the picture with less radiation",
                spots.len()
            ));
        }
        let cut = spots.iter().filter(|s| s.cut).count();
        if 2 * cut > spots.len() {
            warnings.push(format!(
                "{cut} of {} spots are cut by the border or run into another: is it the right picture?",
                spots.len()
            ));
        }
        warnings
    }

    /// Whether the brighter side of a spot's edge is white.
    fn is_saturated(&self, spot: &Spot) -> bool {
        let ring = match self.params.look {
            Look::Bright => 0.5 * spot.radius_px,
            Look::Dark => spot.radius_px * spot.elongation.sqrt() + 4.0,
        };
        let white = (0..8).filter(|k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(*k) / 8.0).sin_cos();
            self.field.grey.at(spot.at_px[0] + ring * cos, spot.at_px[1] + ring * sin) > WHITE
        });
        white.count() >= 4
    }

    fn start(&self, c: &Candidate) -> Parameters {
        let ground = self.field.grey.at(c.at[0], c.at[1]);
        let contrast = match self.params.look {
            Look::Bright => c.contrast,
            Look::Dark => -c.contrast,
        };
        let ground = (ground - contrast).max(1.0);
        Parameters::from([0.0, 0.0, 1.0, 0.0, 1.0, 2.5, contrast / ground, 0.0, ground, 0.0, 0.0])
    }

    /// Pixels of the light around a spot.
    fn outside(&self, f: &Found, others: &[Round]) -> Window {
        let mut window = self.field.window(&f.round, ground_reach(f), others, 1);
        let edge = 1.0 + 3.0 * f.blur / f.round.radius;
        let keep: Vec<bool> =
            window.pixels.iter().map(|px| px.x.hypot(px.y) > edge * f.elongation.sqrt()).collect();
        let mut kept = keep.iter();
        window.pixels.retain(|_| kept.next() == Some(&true));
        let mut kept = keep.iter();
        window.places.retain(|_| kept.next() == Some(&true));
        window
    }

    /// The light around a spot where it is not that of a plane but changes across one direction.
    fn ridges(&self, f: &Found, others: &[Round]) -> Option<Ridges> {
        if f.residual < 0.7 * UNEVEN * f.contrast {
            return None;
        }
        let window = self.outside(f, others);
        let r = f.round.radius;
        let outside: Vec<Outside> = window.pixels.iter().map(|px| [px.x * r, px.y * r, px.value]).collect();
        let uneven = unevenness(&outside)?;
        if uneven < UNEVEN * f.contrast || uneven < 2.0 * self.noise {
            return None;
        }
        let mut raster = vec![f64::NAN; window.size];
        window.places.iter().zip(&window.pixels).for_each(|(&p, px)| raster[p] = px.value);
        let difference = |p: usize, by: usize| {
            let slope = (raster.get(p + by)? - raster.get(p.checked_sub(by)?)?) / 2.0;
            slope.is_finite().then_some(slope)
        };
        let gradients: Vec<[f64; 2]> = window
            .places
            .iter()
            .filter_map(|&p| Some([difference(p, 1)?, difference(p, window.stride)?]))
            .collect();
        let ridges = Ridges::fitted(&outside, &gradients, ground_reach(f))?;
        (ridges.unevenness(&outside) < 0.7 * uneven).then_some(ridges)
    }

    /// How noise goes together, from the even light around some spots.
    fn correlation(&self, found: &[Found], near: &Neighbours) -> Correlation {
        let step = found.len().div_ceil(NOISE_WINDOWS).max(1);
        let mut windows: Vec<(f64, Window, Vec<f64>)> = (0..found.len())
            .step_by(step)
            .filter_map(|i| {
                let f = &found[i];
                let window = self.outside(f, &near.about(i, ground_reach(f)));
                let outside: Vec<Outside> = window.pixels.iter().map(|px| [px.x, px.y, px.value]).collect();
                let residuals = about_plane(&outside)?;
                let variance = residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64;
                Some((variance, window, residuals))
            })
            .collect();
        // The more even half.
        windows.sort_by(|a, b| a.0.total_cmp(&b.0));
        windows.truncate(windows.len().div_ceil(2));
        Correlation::measured(windows.iter().map(|(_, window, residuals)| (window, &residuals[..])))
    }

    fn found(&self, own: &Round, window: &Window, fit: &Fit, correlation: Option<&Correlation>) -> Found {
        let p = &fit.parameters;
        let pixels = &window.pixels;
        let scale = own.radius;
        let determinant = p[2] * p[4] - p[3] * p[3];
        let radius = scale / determinant.sqrt();
        // Eigenvalues of M: the inverse of the axes.
        let (mean, half) = ((p[2] + p[4]) / 2.0, ((p[2] - p[4]) / 2.0).hypot(p[3]));
        let n = pixels.len() as f64;
        let average = pixels.iter().map(|px| px.value).sum::<f64>() / n;
        let spread: f64 = pixels.iter().map(|px| (px.value - average).powi(2)).sum();
        let light = pixels.iter().map(|px| px.ground).sum::<f64>() / n;
        let ground = (p[8] + p[9] * p[0] + p[10] * p[1]) * light;
        let variance = fit.squares / (n - COUNT as f64);
        let sigma = correlation.map_or(0.0, |c| spread_of_centre(window, fit, c) * scale);
        let mut parameters = *p;
        // About the new middle, in new radii.
        let grow = radius / scale;
        (parameters[0], parameters[1]) = (0.0, 0.0);
        for k in 2..5 {
            parameters[k] *= grow;
        }
        parameters[8] = ground;
        parameters[9] *= grow;
        parameters[10] *= grow;
        Found {
            round: Round { at: [own.at[0] + p[0] * scale, own.at[1] + p[1] * scale], radius },
            elongation: (mean + half) / (mean - half),
            contrast: match self.params.look {
                Look::Bright => ground * (p[6] + p[7]),
                Look::Dark => -ground * (p[6] + p[7]),
            },
            blur: radius / p[5],
            residual: variance.sqrt(),
            sigma,
            explained: 1.0 - fit.squares / spread.max(1e-12),
            parameters,
        }
    }

    fn is_spot(&self, f: &Found) -> bool {
        let settings = &self.params.settings;
        f.contrast >= settings.min_contrast
            && (settings.min_radius_px..=settings.max_radius_px).contains(&f.round.radius)
            && f.explained > 0.9
            && f.elongation < 2.0
            && f.residual < 0.12 * f.contrast
            && f.blur < 0.75 * f.round.radius
            && f.sigma < 0.1 * f.round.radius
            && self.field.depth(f.round.at) > 0.0
    }

    fn spot(&self, number: usize, f: &Found, near: &Neighbours, usual: f64) -> Spot {
        let edge = f.round.radius * f.elongation.sqrt();
        let meets = !near.about(number, edge + 1.0).is_empty();
        let cut = meets
            || self.field.depth(f.round.at) < edge + f.blur.min(1.5)
            || f.elongation > LONGEST
            || f.misfit() > (MISFIT * usual).max(LEAST_MISFIT);
        Spot {
            at_px: f.round.at,
            radius_px: f.round.radius,
            elongation: f.elongation,
            contrast: f.contrast,
            sigma_px: f.sigma,
            cut,
        }
    }
}

/// Standard deviation of a coordinate of the fitted centre, radii of the window.
///
/// The size of the noise is that of the residuals where they move the centre, at the spot's edge, where a picture may have more of it than
/// in even light. The fit takes a share of the noise out of the residuals: `leverage` of independent noise, and more of noise that goes
/// together, by about the factor by which that moves the centre more.
fn spread_of_centre(window: &Window, fit: &Fit, correlation: &Correlation) -> f64 {
    // The weight of each pixel in both coordinates of the centre.
    let mut weights = [Vec::with_capacity(window.pixels.len()), Vec::with_capacity(window.pixels.len())];
    let (mut independent, mut squares, mut taken) = (0.0, 0.0, 0.0);
    for px in &window.pixels {
        let (light, row) = light_and_derivative(&fit.parameters, px.x, px.y);
        let row = Parameters::from(row) * px.ground;
        let solved = fit.inverse * row;
        let weight = solved[0] * solved[0] + solved[1] * solved[1];
        let leverage = row.dot(&solved);
        independent += weight;
        squares += weight * (px.value - px.ground * light).powi(2);
        taken += weight * leverage;
        weights[0].push(solved[0]);
        weights[1].push(solved[1]);
    }
    let [x, y] = weights.map(|w| correlation.variance(window, w.into_iter()));
    let more = (x + y) / independent.max(1e-300);
    let left = (independent - more * taken).max(LEAST_LEFT * independent);
    (squares / left.max(1e-300) * (x + y) / 2.0).sqrt()
}

/// How far about a spot its light is looked at, px.
fn ground_reach(f: &Found) -> f64 {
    1.5 * f.round.radius + 3.0 * f.blur + 6.0
}

/// Round things by place.
struct Neighbours {
    rounds: Vec<Round>,
    cells: Cells,
    largest: f64,
}

impl Neighbours {
    fn of(rounds: impl Iterator<Item = Round>, field: &Field<'_>) -> Self {
        let rounds: Vec<Round> = rounds.collect();
        let mut cells = Cells::new([field.grey.width, field.grey.height]);
        rounds.iter().enumerate().for_each(|(i, r)| cells.add(r.at, i));
        let largest = rounds.iter().map(|r| r.radius).fold(0.0, f64::max);
        Self { rounds, cells, largest }
    }

    /// Numbers of those that come within `reach` of the middle of one.
    fn numbers(&self, number: usize, reach: f64) -> impl Iterator<Item = usize> + '_ {
        let own = self.rounds[number];
        let others = self.cells.near(own.at, reach + self.largest).filter(move |&k| k != number);
        others.filter(move |&k| own.distance(&self.rounds[k]) < reach + self.rounds[k].radius)
    }

    /// Those that come within `reach` of the middle of one.
    fn about(&self, number: usize, reach: f64) -> Vec<Round> {
        self.numbers(number, reach).map(|k| self.rounds[k]).collect()
    }
}

/// Those whose middles lie in none that explains its window better.
fn distinct(mut found: Vec<Found>, field: &Field<'_>) -> Vec<Found> {
    found.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    let mut cells = Cells::new([field.grey.width, field.grey.height]);
    let largest = found.iter().map(|f| f.round.radius).fold(0.0, f64::max);
    let mut kept: Vec<Found> = Vec::new();
    for f in found {
        let within = |k: &Found| k.round.distance(&f.round) < 0.9 * k.round.radius.max(f.round.radius);
        if !cells.near(f.round.at, largest).any(|k| within(&kept[k])) {
            cells.add(f.round.at, kept.len());
            kept.push(f);
        }
    }
    kept
}
