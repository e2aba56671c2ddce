//! From the picture of a plate to the map from recorded to ideal pixels.

use biplane_acquisition::images::read_frame;
use biplane_artifact::{Frame, PlateFit, PlatePattern, Spots, Verdict};
use biplane_distortion::{DistortionParams, Model, fit_plate};
use biplane_geometry::Point2;
use biplane_phantom::{Exposure, IntensifierDistortion, TrueFluoroscope};
use biplane_spots::{Look, SpotParams, SpotSettings, find_spots};
use rayon::prelude::*;

use super::SectionError;
use crate::faults::random;
use crate::plates::{HeldPlate, MapError, PlateKind, inside, on_plate};
use crate::plot::{Dots, Panel, cumulative, dots, lines, strip};
use crate::setups::{bent, displaced, of_a_plate};
use crate::simulated_calibration::{STUDIES, Simulated};
use crate::{Cell, Column, Distribution, Lab, Row, SceneError, Section, Table};

/// The part of the round border's radius inside which maps are measured.
const SHARE: f64 = 0.95;
/// The real dot grid, from the project's folder, and the distance of its dots, mm (only ratios to it are measured).
const GRID: &str = "../shared/data/real/grids/dot_pattern_01.jpg";
const GRID_PITCH_MM: f64 = 1.0;

/// A plate before a bent intensifier, its picture and its spots.
struct Setup {
    view: TrueFluoroscope,
    exposure: Exposure,
    held: HeldPlate,
    frame: Frame,
    spots: Option<Spots>,
}

impl Setup {
    fn drawn(lab: &Lab, kind: PlateKind, number: usize) -> Result<Self, SceneError> {
        let mut chance = random(lab.seed, 70 + kind as u64, number);
        let [view, _] = displaced(&mut chance);
        let exposure = of_a_plate(Some(bent(view.size, &mut chance)));
        let held = HeldPlate::drawn(kind, &view, &mut chance);
        let frame = held.picture(&view, &exposure, lab.seed.wrapping_mul(1_000_003) + number as u64)?;
        let spots = find_spots(&frame, &held.spot_params()).ok();
        Ok(Self { view, exposure, held, frame, spots })
    }

    fn distortion(&self) -> IntensifierDistortion {
        self.exposure.distortion.unwrap_or_else(|| IntensifierDistortion::none(self.view.size))
    }

    /// The map, if there is one.
    fn fitted(&self, params: &DistortionParams) -> Option<PlateFit> {
        fit_plate(self.spots.as_ref()?, &self.held.pattern, None, params).ok()
    }

    fn error(&self, fit: &PlateFit) -> MapError {
        let middle = Point2::from(self.view.size.map(|n| (n as f64 - 1.0) / 2.0));
        let grid = inside(&middle, self.exposure.border_px, SHARE);
        let distortion = self.distortion();
        let truth: Vec<Point2> =
            grid.iter().map(|p| self.held.recorded_from_mm(&self.view, &distortion, p)).collect();
        MapError::of(&on_plate(fit, &grid), &truth, self.held.pixel_mm(&self.view))
    }

    /// Errors of the centres of whole spots that are used, px, and how many whole spots of the plate there are.
    fn centres(&self, fit: &PlateFit) -> (Vec<f64>, usize) {
        let middle = Point2::from(self.view.size.map(|n| (n as f64 - 1.0) / 2.0));
        // The plates' largest marks have a radius of some 8 px.
        let whole = self.exposure.border_px - 12.0;
        let seen = self.held.plate.seen(&self.held.pose, &self.view, &self.distortion());
        let seen: Vec<Point2> =
            seen.into_iter().map(|s| s.centroid).filter(|p| (p - middle).norm() < whole).collect();
        let used: Vec<Point2> =
            fit.matched.iter().filter(|m| m.used).map(|m| Point2::from(m.at_px)).collect();
        let nearest = |p: &Point2| used.iter().map(|u| (u - p).norm()).fold(f64::INFINITY, f64::min);
        let errors = seen.iter().map(nearest).filter(|d| *d < 2.0).collect();
        (errors, seen.len())
    }
}

/// What was measured of one set-up.
struct Measured {
    fit: PlateFit,
    error: MapError,
    centres: (Vec<f64>, usize),
}

fn held_out(fit: &PlateFit) -> f64 {
    fit.models.iter().find(|m| m.name == fit.model).map_or(f64::NAN, |m| m.held_out_rms_px)
}

fn column_of(values: impl Iterator<Item = f64>) -> Distribution {
    Distribution::of(values.collect())
}

/// Cells of a distribution, or dashes.
fn cells(d: Distribution) -> [Cell; 3] {
    [d.median, d.p95, d.worst].map(number)
}

fn number(value: f64) -> Cell {
    if value.is_finite() { Cell::Number(value) } else { Cell::text("-") }
}

fn kinds_row(kind: PlateKind, all: &[Option<Measured>]) -> Row {
    let found: Vec<&Measured> = all.iter().flatten().collect();
    let mut row: Vec<Cell> = cells(column_of(found.iter().map(|m| m.error.rms_px))).into();
    row.push(match kind {
        PlateKind::Concentric | PlateKind::Balls => {
            number(column_of(found.iter().map(|m| m.error.raw_px)).worst)
        }
        PlateKind::Square | PlateKind::Hexagonal => Cell::text("-"),
    });
    row.push(number(column_of(found.iter().map(|m| held_out(&m.fit))).median));
    let centres: Vec<f64> = found.iter().flat_map(|m| m.centres.0.iter().copied()).collect();
    let whole = found.iter().map(|m| m.centres.1).sum();
    row.push(number(crate::bead_scenes::rms(centres.iter().copied())));
    row.push(Cell::Share(centres.len(), whole));
    let good = found.iter().filter(|m| m.fit.verdict == Verdict::Good).count();
    row.push(Cell::Share(good, all.len()));
    Row::ours(kind.name(), row)
}

/// The models that are compared.
fn models() -> Vec<(String, DistortionParams)> {
    let polynomial =
        |degree: u32| DistortionParams { model: Model::Polynomial, degree, ..DistortionParams::default() };
    let local = DistortionParams { model: Model::LocalWeightedMean, ..DistortionParams::default() };
    (1..=7)
        .map(|d| (format!("polynomial, degree {d}"), polynomial(d)))
        .chain([("local weighted mean".to_owned(), local)])
        .collect()
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let mut plates = Table {
        id: "distortion".to_owned(),
        heading: "phantom plates".to_owned(),
        columns: [
            ("error of the map, px, median", 3),
            ("95 %", 3),
            ("worst", 3),
            ("with the plate's own place, worst", 3),
            ("held-out residual, median", 3),
            ("centres of spots, px", 3),
        ]
        .map(|(name, decimals)| Column::at_most(name, decimals))
        .into_iter()
        .chain([Column::at_least("whole spots used", 0), Column::at_least("good", 0)])
        .collect(),
        rows: Vec::new(),
    };
    let (mut shown, mut series, mut compared) = (Vec::new(), Vec::new(), Vec::new());
    for kind in PlateKind::ALL {
        let setups: Vec<Setup> = (0..lab.count(10, 1))
            .into_par_iter()
            .map(|number| Setup::drawn(lab, kind, number))
            .collect::<Result<_, _>>()?;
        let measured: Vec<Option<Measured>> = setups
            .par_iter()
            .map(|setup| {
                let fit = setup.fitted(&DistortionParams::default())?;
                let (error, centres) = (setup.error(&fit), setup.centres(&fit));
                Some(Measured { fit, error, centres })
            })
            .collect();
        plates.rows.push(kinds_row(kind, &measured));
        let errors: Vec<f64> = measured.iter().flatten().map(|m| m.error.rms_px).collect();
        series.push(cumulative(kind.name(), &errors));
        shown.push(setups[0].frame.clone());
        let of_kind = if kind == PlateKind::Concentric { 1 } else { 0 };
        compared.extend(setups.into_iter().take(lab.count(2, of_kind)));
    }
    let (by_model, model_dots) = compare_models(&compared);
    let simulated = simulated(lab)?;
    let mut tables = vec![plates, by_model, simulated];
    let mut text = vec![
        format!(
            "Pictures of plates by the phantom, {} of each kind: turned by any angle, shifted, up to 10 mm before the \
             detector, one spot of fifty missing, scratched; bent (pincushion 6 to 12 px, S up to 12 px at the rim), blurred, \
             scattered, noisy, 8 bit, with a round border. The spots are found, matched and fitted by the stages with their \
             defaults. Error: root mean square length between where the map and where the truth puts recorded pixels on the \
             plate, every 8 px inside 95 % of the border's radius, in pixels there, after the best rigid motion of the plane; \
             and, where each spot of the plate is known by itself so that nothing is free, without one. The goal is 0.05 px.",
            lab.count(10, 1)
        ),
        "The held-out residual, by which models are chosen, has the noise of the spots in it: where it is honest, it is no \
         smaller than the error of the map and the error of the spots' centres together."
            .to_owned(),
        "gVirtualXray's plates: nothing of this program had a part in them. Against its own samples of the distortion \
         inside 95 % of the radius."
            .to_owned(),
    ];
    match real(lab)? {
        Some(table) => {
            tables.push(table);
            text.push(
                "The real dot grid: one picture of a sheet of dots through an X-ray detector with a lens, by others. Nobody \
                 knows its true map: what is left of the dots is measured, held out of the fit and not, and how straight the \
                 rows of the lattice become (distance of their dots from the best line)."
                    .to_owned(),
            );
        }
        None => text.push("The real dot grid is left out: its data is not here.".to_owned()),
    }
    let panel = Panel { limit: None, ..Panel::shares("error of the map, px rms", series) };
    Ok(Some(Section {
        title: "Distortion".to_owned(),
        text,
        tables,
        plots: vec![
            strip(
                "plates.png",
                "Pictures of the phantom's plates (square root of the grey level)",
                &shown.iter().collect::<Vec<_>>(),
            )?,
            lines("distortion.svg", "Plates of the phantom: share of set-ups below an error", &[panel])?,
            dots(
                "distortion-models.svg",
                "Models of the distortion: the error of the map and the residual held out, medians",
                "px",
                &["error of the map", "held-out residual", "fitted residual"],
                &model_dots,
            )?,
        ],
    }))
}

fn compare_models(setups: &[Setup]) -> (Table, Vec<Dots>) {
    let mut rows = Vec::new();
    let mut plotted = Vec::new();
    for (name, params) in models() {
        let found: Vec<Option<(f64, f64, f64)>> = setups
            .par_iter()
            .map(|setup| {
                let fit = setup.fitted(&params)?;
                let fitted =
                    fit.models.iter().find(|m| m.name == fit.model).map_or(f64::NAN, |m| m.fitted_rms_px);
                Some((setup.error(&fit).rms_px, held_out(&fit), fitted))
            })
            .collect();
        let of = |f: fn(&(f64, f64, f64)) -> f64| column_of(found.iter().flatten().map(f));
        let error = of(|v| v.0);
        let mut row: Vec<Cell> = cells(error).into();
        row.extend([of(|v| v.1).median, of(|v| v.2).median].map(number));
        row.push(Cell::Share(found.iter().flatten().count(), found.len()));
        plotted.push(Dots {
            label: name.clone(),
            values: [error.median, of(|v| v.1).median, of(|v| v.2).median]
                .map(|v| v.is_finite().then_some(v))
                .into(),
        });
        rows.push(Row::ours(name, row));
    }
    let columns = [
        "error of the map, px, median",
        "95 %",
        "worst",
        "held-out residual, median",
        "fitted residual, median",
    ];
    let columns =
        columns.map(|c| Column::at_most(c, 3)).into_iter().chain([Column::at_least("fitted", 0)]).collect();
    (Table { id: "distortion-models".to_owned(), heading: "model".to_owned(), columns, rows }, plotted)
}

fn simulated(lab: &Lab) -> Result<Table, SectionError> {
    let mut table = Table {
        id: "distortion-gvirtualxray".to_owned(),
        heading: "gVirtualXray's plates".to_owned(),
        columns: ["error of the map, px", "with the plate's own place", "held-out residual", "before, px"]
            .map(|c| Column::at_most(c, 3))
            .into_iter()
            .chain([Column::at_least("spots used", 0), Column::at_least("good", 0)])
            .collect(),
        rows: Vec::new(),
    };
    for (name, folder) in STUDIES {
        let study = Simulated::read(&lab.root.join(folder))?;
        for (index, view) in ["A", "B"].into_iter().enumerate() {
            let label = format!("{name}, view {view}");
            let Some(fit) = study.plate_fit(index) else {
                table.rows.push(Row::ours(
                    label,
                    vec![Cell::text("-"); 4]
                        .into_iter()
                        .chain([Cell::Share(0, 1), Cell::Share(0, 1)])
                        .collect(),
                ));
                continue;
            };
            let (error, used) =
                (study.map_error(index, &fit, SHARE), fit.matched.iter().filter(|m| m.used).count());
            table.rows.push(Row::ours(
                label,
                vec![
                    number(error.rms_px),
                    number(error.raw_px),
                    number(held_out(&fit)),
                    Cell::Number(fit.before_rms_px),
                    Cell::Share(used, used + fit.missing_px.len()),
                    Cell::Share(usize::from(fit.verdict == Verdict::Good), 1),
                ],
            ));
        }
    }
    Ok(table)
}

/// Root mean square distance of the dots of each row and column of a lattice from their best line, px.
fn straightness(dots: &[([i64; 2], Point2)]) -> f64 {
    let mut lines = std::collections::BTreeMap::<(usize, i64), Vec<Point2>>::new();
    for (cell, at) in dots {
        for (axis, number) in cell.iter().enumerate() {
            lines.entry((axis, *number)).or_default().push(*at);
        }
    }
    let (mut squares, mut count) = (0.0, 0);
    for points in lines.values().filter(|p| p.len() >= 5) {
        let middle = points.iter().map(|p| p.coords).sum::<biplane_geometry::Vector2>() / points.len() as f64;
        let scatter = points
            .iter()
            .map(|p| (p.coords - middle) * (p.coords - middle).transpose())
            .sum::<nalgebra::Matrix2<f64>>();
        squares += scatter.symmetric_eigenvalues().min();
        count += points.len();
    }
    (squares / count as f64).sqrt()
}

fn real(lab: &Lab) -> Result<Option<Table>, SectionError> {
    let path = lab.root.join(GRID);
    if !path.is_file() {
        return Ok(None);
    }
    let frame = read_frame(&path, 0).map_err(SceneError::from)?;
    let settings = SpotSettings::default();
    let spots = find_spots(&frame, &SpotParams { look: Look::Dark, settings });
    let pattern = PlatePattern::Square { pitch_mm: GRID_PITCH_MM };
    let mut rows = Vec::new();
    let full = ["degree 3", "degree 4", "degree 5", "degree 6", "weighted mean"];
    let shown = if lab.full() { full.as_slice() } else { &full[2..3] };
    for (name, params) in models().into_iter().filter(|m| shown.iter().any(|s| m.0.ends_with(s))) {
        let fit = spots.as_ref().ok().and_then(|s| fit_plate(s, &pattern, None, &params).ok());
        let label = format!("dot grid, {name}");
        let Some(fit) = fit else {
            rows.push(Row::ours(label, vec![Cell::Number(0.0)]));
            continue;
        };
        let map = biplane_fluoroscope::Distortion::from(&fit.table);
        let used: Vec<_> = fit.matched.iter().filter(|m| m.used).collect();
        let cell =
            |m: &&biplane_artifact::MatchedSpot| m.plate_mm.map(|v| (v / GRID_PITCH_MM).round() as i64);
        let at = |corrected: bool| -> Vec<([i64; 2], Point2)> {
            used.iter()
                .map(|m| {
                    let p = Point2::from(m.at_px);
                    (cell(m), if corrected { map.ideal(&p) } else { p })
                })
                .collect()
        };
        let score = fit.models.iter().find(|m| m.name == fit.model);
        rows.push(Row::ours(
            label,
            vec![
                Cell::Number(used.len() as f64),
                number(fit.before_rms_px),
                number(score.map_or(f64::NAN, |s| s.fitted_rms_px)),
                number(held_out(&fit)),
                number(straightness(&at(false))),
                number(straightness(&at(true))),
            ],
        ));
    }
    let columns = ["residual before, px", "fitted", "held out", "rows' straightness before, px", "after"];
    let columns = columns.map(|c| Column::at_most(c, 3));
    let columns = std::iter::once(Column::at_least("dots used", 0)).chain(columns).collect();
    Ok(Some(Table { id: "distortion-real".to_owned(), heading: "real".to_owned(), columns, rows }))
}
