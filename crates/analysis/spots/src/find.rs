//! From a picture to its spots: border, candidates, a first fit of each by itself, a second one that knows its neighbours, and the
//! rules by which a fit is a spot.

use biplane_artifact::{Circle, Frame, Spot, Spots};

use crate::border::{border, mirrored_beyond};
use crate::candidates::{Candidate, candidates};
use crate::cells::Cells;
use crate::fit::{Fit, Pixel, fit};
use crate::grey::Grey;
use crate::profile::{COUNT, Parameters};
use crate::{Look, SpotError, SpotParams};

/// How far inside the border a picture is whole, px.
const BORDER_EDGE: f64 = 2.0;

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
    let finder = Finder { grey: &grey, border, params, noise: grey.noise() };
    let mut spots = finder.spots(&even);
    spots.sort_by(|a, b| a.at_px[1].total_cmp(&b.at_px[1]).then(a.at_px[0].total_cmp(&b.at_px[0])));
    Ok(Spots { spots, border, ..empty })
}

/// A round thing of the picture: its middle and its radius, px.
#[derive(Debug, Clone, Copy)]
struct Round {
    at: [f64; 2],
    radius: f64,
}

impl Round {
    fn holds(&self, x: f64, y: f64, margin: f64) -> bool {
        (x - self.at[0]).powi(2) + (y - self.at[1]).powi(2) < (self.radius + margin).powi(2)
    }

    fn distance(&self, other: &Self) -> f64 {
        (self.at[0] - other.at[0]).hypot(self.at[1] - other.at[1])
    }
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

struct Finder<'a> {
    grey: &'a Grey,
    border: Option<Circle>,
    params: &'a SpotParams,
    noise: f64,
}

impl Finder<'_> {
    fn spots(&self, even: &Grey) -> Vec<Spot> {
        let settings = &self.params.settings;
        let least = (0.5 * settings.min_contrast).max(3.0 * self.noise).max(0.5);
        let radii = [settings.min_radius_px, settings.max_radius_px];
        let mut places = candidates(even, self.params.look, radii, least);
        places.retain(|c| self.depth(c.at) > 0.0);
        let first: Vec<Found> = {
            let rounds: Vec<Round> = places.iter().map(|c| Round { at: c.at, radius: c.radius }).collect();
            let cells = self.cells(&rounds);
            let one = |(i, c): (usize, &Candidate)| {
                let start = self.start(c);
                let found = self.fitted(i, &rounds, &cells, 4.0, &start, 12)?;
                self.is_spot(&found).then_some(found)
            };
            places.iter().enumerate().filter_map(one).collect()
        };
        let first = distinct(first);
        let rounds: Vec<Round> = first.iter().map(|f| f.round).collect();
        let cells = self.cells(&rounds);
        let second = first.iter().enumerate().filter_map(|(i, f)| {
            let found = self.fitted(i, &rounds, &cells, (3.5 * f.blur).max(4.0), &f.parameters, 30)?;
            self.is_spot(&found).then(|| self.spot(i, &found, &rounds, &cells))
        });
        second.collect()
    }

    fn cells(&self, rounds: &[Round]) -> Cells {
        let mut cells = Cells::new([self.grey.width, self.grey.height]);
        rounds.iter().enumerate().for_each(|(i, r)| cells.add(r.at, i));
        cells
    }

    /// How far within the border of picture and intensifier a place is, px.
    fn depth(&self, at: [f64; 2]) -> f64 {
        let [w, h] = [self.grey.width, self.grey.height].map(|n| n as f64);
        let of_picture = (at[0] + 0.5).min(at[1] + 0.5).min(w - 0.5 - at[0]).min(h - 0.5 - at[1]);
        self.border.map_or(of_picture, |c| {
            of_picture.min(c.radius_px - (at[0] - c.centre_px[0]).hypot(at[1] - c.centre_px[1]))
        })
    }

    fn start(&self, c: &Candidate) -> Parameters {
        let ground = self.grey.at(c.at[0], c.at[1]);
        let contrast = match self.params.look {
            Look::Bright => c.contrast,
            Look::Dark => -c.contrast,
        };
        let ground = (ground - contrast).max(1.0);
        Parameters::from([0.0, 0.0, 1.0, 0.0, 1.0, 2.5, contrast / ground, 0.0, ground, 0.0, 0.0])
    }

    /// Fits the profile in the window of one round thing, without the pixels of the others.
    fn fitted(
        &self,
        number: usize,
        rounds: &[Round],
        cells: &Cells,
        margin: f64,
        start: &Parameters,
        steps: usize,
    ) -> Option<Found> {
        let own = rounds[number];
        let reach = own.radius + margin.max(0.25 * own.radius);
        let largest = self.params.settings.max_radius_px;
        let others: Vec<Round> = cells
            .near(own.at, reach + largest)
            .filter(|&k| k != number)
            .map(|k| rounds[k])
            .filter(|o| own.distance(o) < reach + o.radius + 3.0)
            .collect();
        let pixels = self.window(&own, reach, &others);
        let fit = fit(&pixels, start, steps)?;
        Some(self.found(&own, &pixels, &fit))
    }

    fn window(&self, own: &Round, reach: f64, others: &[Round]) -> Vec<Pixel> {
        let [cx, cy] = own.at;
        let range = |c: f64, n: usize| {
            (c - reach).ceil().max(0.0) as usize..((c + reach).floor() + 1.0).clamp(0.0, n as f64) as usize
        };
        let rim = self.border.map(|c| (c.centre_px, c.radius_px - BORDER_EDGE));
        let mut pixels = Vec::with_capacity((4.0 * reach * reach) as usize);
        for j in range(cy, self.grey.height) {
            let y = j as f64;
            let row = &self.grey.samples[j * self.grey.width..];
            for i in range(cx, self.grey.width) {
                let x = i as f64;
                if (x - cx).powi(2) + (y - cy).powi(2) > reach * reach
                    || rim.is_some_and(|(c, r)| (x - c[0]).powi(2) + (y - c[1]).powi(2) > r * r)
                    || others.iter().any(|o| o.holds(x, y, 2.5))
                {
                    continue;
                }
                let value = f64::from(row[i]);
                pixels.push(Pixel { x: (x - cx) / own.radius, y: (y - cy) / own.radius, value });
            }
        }
        pixels
    }

    fn found(&self, own: &Round, pixels: &[Pixel], fit: &Fit) -> Found {
        let p = &fit.parameters;
        let scale = own.radius;
        let determinant = p[2] * p[4] - p[3] * p[3];
        let radius = scale / determinant.sqrt();
        // Eigenvalues of M: the inverse of the axes.
        let (mean, half) = ((p[2] + p[4]) / 2.0, ((p[2] - p[4]) / 2.0).hypot(p[3]));
        let ground = p[8] + p[9] * p[0] + p[10] * p[1];
        let n = pixels.len() as f64;
        let average = pixels.iter().map(|px| px.value).sum::<f64>() / n;
        let spread: f64 = pixels.iter().map(|px| (px.value - average).powi(2)).sum();
        let variance = fit.squares / (n - COUNT as f64);
        let sigma = (variance * (fit.inverse[(0, 0)] + fit.inverse[(1, 1)]) / 2.0).sqrt() * scale;
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
            && f.explained > 0.8
            && f.elongation < 2.0
            && f.residual < 0.12 * f.contrast
            && self.depth(f.round.at) > 0.0
    }

    fn spot(&self, number: usize, f: &Found, rounds: &[Round], cells: &Cells) -> Spot {
        let edge = f.round.radius * f.elongation.sqrt();
        let largest = self.params.settings.max_radius_px;
        let meets = cells
            .near(f.round.at, edge + largest + 2.0)
            .any(|k| k != number && f.round.distance(&rounds[k]) < edge + rounds[k].radius + 1.0);
        let cut = meets || self.depth(f.round.at) < edge + f.blur.min(1.5) || f.elongation > 1.35;
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

/// Those whose middles lie in none that explains its window better.
fn distinct(mut found: Vec<Found>) -> Vec<Found> {
    found.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    let mut kept: Vec<Found> = Vec::new();
    for f in found {
        if kept.iter().all(|k| k.round.distance(&f.round) > 0.7 * k.round.radius.max(f.round.radius)) {
            kept.push(f);
        }
    }
    kept
}
