//! From pictures of beads to two fluoroscopes.

use std::time::Instant;

use biplane_artifact::{BeadClick, BeadClicks, Detector, PlateFit, Spots, Verdict, ViewEnvironment};
use biplane_environment::{EnvironmentParams, covariance_of_point, source_region};
use biplane_fluoroscope::{Distortion, Fluoroscope};
use biplane_geometry::{Point3, Vector3};
use biplane_phantom::{IntensifierDistortion, TrueFluoroscope};
use nalgebra::Matrix3;
use rayon::prelude::*;

use super::SectionError;
use crate::bead_scenes::{
    BeadScene, STANDS, Stand, ViewError, VolumeError, beads_of, fluoroscope, mislabelled, rms,
};
use crate::bound::{Known, fisher_quantile, normalised_square, of_point, of_view, triangulated};
use crate::calibrated::{calibrated, environment};
use crate::faults::{normal_vector, random};
use crate::plates::disturbed;
use crate::plot::{Panel, cumulative, lines, strip};
use crate::setups::{along_and_across, bent, of_a_plate, plain};
use crate::simulated_calibration::{STUDIES, Simulated};
use crate::{Cell, Column, Distribution, Lab, Row, SceneError, Section, Table};

/// Noise put on each coordinate of the centres that were found, px.
const NOISE_PX: f64 = 0.1;
/// Fresh points triangulated in each scene.
const POINTS: usize = 20;
/// Share of truths that a stated region shall hold.
const STATED: f64 = 0.95;

/// A scene with what was found in its pictures.
struct Seen {
    scene: BeadScene,
    spots: [Spots; 2],
    /// Errors of the finder alone, before the noise, px.
    centres_px: Vec<f64>,
    /// Fresh points and their noisy ideal pixels.
    fresh: Vec<Point3>,
    number: usize,
}

fn seen(lab: &Lab, stand: &Stand, index: usize, number: usize) -> Result<Seen, SceneError> {
    let mut chance = random(lab.seed, 80 + index as u64, number);
    let scene = BeadScene::drawn(stand, &mut chance)?;
    let exposure = plain();
    let frames = scene.pictures([&exposure; 2], lab.seed.wrapping_mul(7919).wrapping_add(number as u64))?;
    let mut centres_px = Vec::new();
    let mut found = Vec::new();
    for (view, frame) in scene.views.iter().zip(&frames) {
        let mut spots = beads_of(frame).map_err(|e| SceneError::Mesh(e.to_string()))?;
        let truth = scene.frame.seen(view, &IntensifierDistortion::none(view.size));
        for bead in truth {
            let off =
                spots.spots.iter().map(|s| (biplane_geometry::Point2::from(s.at_px) - bead.shadow).norm());
            centres_px.extend(Some(off.fold(f64::INFINITY, f64::min)).filter(|d| *d < 2.0));
        }
        for spot in &mut spots.spots {
            spot.at_px = disturbed(spot.at_px, NOISE_PX, &mut chance);
            spot.sigma_px = spot.sigma_px.hypot(NOISE_PX);
        }
        found.push(spots);
    }
    let (radius, height) = volume(stand);
    let fresh = BeadScene::points(radius, height, POINTS, &mut chance);
    let [a, b] = <[Spots; 2]>::try_from(found).map_err(|_| SceneError::Mesh("two views".to_owned()))?;
    Ok(Seen { scene, spots: [a, b], centres_px, fresh, number })
}

/// Radius and height of the volume that a frame of beads encloses, mm.
fn volume(stand: &Stand) -> (f64, f64) {
    let height = (stand.layout)().height_mm;
    (height / 3.0, 0.72 * height)
}

/// A figure of a scene: what was measured and what the bound says, both squared, summed over so many numbers.
#[derive(Default, Clone, Copy)]
struct Figure {
    error: f64,
    bound: f64,
    count: f64,
}

impl Figure {
    fn add(&mut self, error: f64, bound: f64, count: f64) {
        self.error += error;
        self.bound += bound;
        self.count += count;
    }

    fn cells(&self, scale: f64, decimals: usize) -> Vec<Cell> {
        let (error, bound) =
            ((self.error / self.count).sqrt() * scale, (self.bound / self.count).sqrt() * scale);
        vec![Cell::Number(error), Cell::text(format!("{bound:.decimals$}")), Cell::Number(error / bound)]
    }
}

/// What one scene says.
#[derive(Default)]
struct Scored {
    figures: [Figure; FIGURES.len()],
    /// Whether the stated regions hold the truth: of sources, of fresh points.
    sources_held: Vec<bool>,
    points_held: Vec<bool>,
    points_mm: Vec<f64>,
    wrong_labels: usize,
    good: bool,
    seconds: f64,
}

/// What is compared with the bound, and what turns its unit into the one that is printed.
const FIGURES: [(&str, f64); 8] = [
    ("source along the view, mm", 1.0),
    ("source across the view, mm", 1.0),
    ("middle of the detector along the view, mm", 1.0),
    ("middle of the detector across the view, mm", 1.0),
    ("detector turned in its plane, degrees", 180.0 / std::f64::consts::PI),
    ("detector tilted, degrees", 180.0 / std::f64::consts::PI),
    ("other points triangulated, mm", 1.0),
    ("beads left out and triangulated, mm", 1.0),
];

fn scored(lab: &Lab, seen: &Seen, stand: usize) -> Option<Scored> {
    let Seen { scene, spots, fresh, .. } = seen;
    let begun = Instant::now();
    let found = environment(&scene.detectors(), spots, &scene.list(), None)?;
    let mut s = Scored { seconds: begun.elapsed().as_secs_f64(), ..Scored::default() };
    let none = scene.views.each_ref().map(|v| IntensifierDistortion::none(v.size));
    s.wrong_labels = mislabelled(&found, scene, none.each_ref());
    s.good = found.verdict == Verdict::Good;
    let centres: Vec<Point3> = scene.frame.beads.iter().map(|b| b.centre).collect();
    let mut bounds = Vec::new();
    for (index, (view, truth)) in found.views.iter().zip(&scene.views).enumerate() {
        let bound = of_view(truth, &centres, NOISE_PX)?;
        let error = ViewError::of(view, truth);
        let axis = truth.normal();
        for (k, vector) in [error.source, error.centre, error.turn].iter().enumerate() {
            let (along, across) = along_and_across(vector, &axis);
            let block: Matrix3<f64> = bound.fixed_view::<3, 3>(3 * k, 3 * k).into_owned();
            let bound_along = (axis.transpose() * block * axis).x;
            s.figures[2 * k].add(along * along, bound_along, 1.0);
            s.figures[2 * k + 1].add(across * across, block.trace() - bound_along, 2.0);
        }
        s.sources_held.push(source_region(&found, index, STATED)?.holds(&truth.source));
        bounds.push(bound);
    }
    let views: Vec<Fluoroscope> = found.views.iter().map(|v| fluoroscope(v, None)).collect();
    let mut chance = random(lab.seed, 82 + stand as u64, seen.number);
    let freedom: f64 = found.views.iter().map(freedom).sum();
    let quantile = fisher_quantile(3.0, freedom, STATED);
    // Both views count alike where a point is triangulated, so their noise counts together.
    let sigma_px = rms(found.views.iter().map(|v| v.sigma_px));
    for point in fresh {
        let pixels: Vec<_> = scene
            .views
            .iter()
            .filter_map(|v| v.project(point))
            .map(|p| disturbed(p.0.coords.into(), NOISE_PX, &mut chance).into())
            .collect();
        let error = triangulated(&views, &pixels, point)? - point;
        let known = |v: usize| Known { view: &scene.views[v], covariance: &bounds[v], sigma_px: NOISE_PX };
        let bound = of_point([known(0), known(1)], point)?;
        s.figures[6].add(error.norm_squared(), bound.trace(), 1.0);
        s.points_mm.push(error.norm());
        let square = normalised_square(&error, &covariance_of_point(&found, point, sigma_px)?)?;
        s.points_held.push(square <= quantile);
    }
    for bead in &found.triangulated {
        let others = || centres.iter().enumerate().filter(|(i, _)| *i != bead.bead).map(|(_, c)| c);
        let [a, b] = [0, 1].map(|v: usize| of_view(&scene.views[v], others(), NOISE_PX));
        let (a, b) = (a?, b?);
        let known = |v: usize, covariance| Known { view: &scene.views[v], covariance, sigma_px: NOISE_PX };
        let bound = of_point([known(0, &a), known(1, &b)], &centres[bead.bead])?;
        s.figures[7].add(Vector3::from(bead.error_mm).norm_squared(), bound.trace(), 1.0);
    }
    Some(s)
}

/// How many residuals more than parameters tell a view's noise.
fn freedom(view: &ViewEnvironment) -> f64 {
    2.0 * view.beads.iter().filter(|b| b.used).count() as f64 - 9.0
}

fn table(id: &str, heading: &str, columns: Vec<Column>) -> Table {
    Table { id: id.to_owned(), heading: heading.to_owned(), columns, rows: Vec::new() }
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let mut accuracy = table(
        "environment",
        "frames of 30 beads",
        vec![
            Column::at_most("error, rms", 3),
            Column::at_most("Cramer-Rao bound", 3),
            Column::at_most("error over bound", 2),
        ],
    );
    let mut scenes = table(
        "environment-scenes",
        "frames of 30 beads",
        vec![
            Column::at_least("calibrated", 0),
            Column::at_least("good", 0),
            Column::at_most("beads with a wrong label", 0),
            Column::at_most("error of centres before the noise was added, px", 3),
            Column::at_most("time, ms", 0),
        ],
    );
    let mut coverage = table(
        "environment-coverage",
        "stated 95 % regions that hold the truth",
        vec![Column::within("source", 3), Column::within("other points triangulated", 3)],
    );
    let mut bad = table("environment-bad", "what is wrong", bad_columns());
    let mut faults = vec![Faulty::default(); FAULTS.len()];
    let mut series = Vec::new();
    let count = lab.count(200, 20);
    for (index, stand) in STANDS.iter().enumerate() {
        let all: Vec<Seen> = (0..count)
            .into_par_iter()
            .map(|number| seen(lab, stand, index, number))
            .collect::<Result<_, _>>()?;
        let scores: Vec<Option<Scored>> = all.par_iter().map(|s| scored(lab, s, index)).collect();
        let found: Vec<&Scored> = scores.iter().flatten().collect();
        for (k, (figure, scale)) in FIGURES.iter().enumerate() {
            let mut sum = Figure::default();
            found.iter().map(|s| s.figures[k]).for_each(|f| sum.add(f.error, f.bound, f.count));
            let cells = match sum.count > 0.0 {
                true => sum.cells(*scale, 3),
                false => vec![Cell::text("-"); 3],
            };
            accuracy.rows.push(Row::ours(format!("{}: {figure}", stand.name), cells));
        }
        let seconds = Distribution::of(found.iter().map(|s| s.seconds).collect()).median;
        scenes.rows.push(Row::ours(
            stand.name,
            vec![
                Cell::Share(found.len(), count),
                Cell::Share(found.iter().filter(|s| s.good).count(), count),
                Cell::Number(found.iter().map(|s| s.wrong_labels).sum::<usize>() as f64),
                Cell::Number(rms(all.iter().flat_map(|s| s.centres_px.iter().copied()))),
                if seconds.is_finite() { Cell::Number(1e3 * seconds) } else { Cell::text("-") },
            ],
        ));
        // A few scenes say nothing of coverage.
        if lab.full() {
            let share = |held: fn(&Scored) -> &[bool]| {
                let all: Vec<bool> = found.iter().flat_map(|s| held(s).iter().copied()).collect();
                Cell::Number(all.iter().filter(|h| **h).count() as f64 / all.len() as f64)
            };
            coverage
                .rows
                .push(Row::ours(stand.name, vec![share(|s| &s.sources_held), share(|s| &s.points_held)]));
        }
        let points: Vec<f64> = found.iter().flat_map(|s| s.points_mm.iter().copied()).collect();
        series.push(cumulative(stand.name, &points));
        for (fault, sum) in FAULTS.iter().zip(&mut faults) {
            // A quick run tries the first frame of beads alone.
            let tried = if index == 0 { lab.count(3, 1) } else { lab.count(3, 0) };
            let each: Vec<Faulty> = all[..tried].par_iter().map(|s| faulty(lab, s, *fault)).collect();
            each.iter().for_each(|f| sum.add(f));
        }
    }
    for (fault, sum) in FAULTS.iter().zip(&faults) {
        bad.rows.push(Row::ours(fault.name(), sum.cells()));
    }
    let (chain, shown) = chain(lab)?;
    let mut tables = vec![accuracy, scenes];
    tables.extend((!coverage.rows.is_empty()).then_some(coverage));
    tables.extend([chain, simulated(lab)?, bad]);
    let panel = Panel::shares("triangulated point off by, mm", series);
    Ok(Some(Section {
        title: "Environment".to_owned(),
        text: text(count),
        tables,
        plots: vec![
            strip(
                "beads.png",
                "Pictures by which phantom fluoroscopes are calibrated: plates and beads of both views (square root of the grey \
                 level)",
                &shown.iter().collect::<Vec<_>>(),
            )?,
            lines(
                "environment.svg",
                "Points triangulated from noisy centres: share below an error",
                &[panel],
            )?,
        ],
    }))
}

fn text(count: usize) -> Vec<String> {
    vec![
        format!(
            "{count} scenes with each frame of beads: two fluoroscopes 75 to 105 degrees apart, sources displaced by 15 mm along \
             each axis, detectors turned by 1 degree and moved by 8 mm; pictures by the phantom without noise, in which the beads \
             are found; normal noise of {NOISE_PX} px on each coordinate of the centres, so that it is known; labelled \
             and fitted by the stage with its defaults. The size of a pixel is held, the source's distance is found. The bound is \
             that of Cramer and Rao for the same scenes, from the true geometry by central differences: no unbiased method has a \
             smaller error. Across: of each of the two axes. *Other points*: {POINTS} points of the volume a scene that are no \
             beads, with the same noise; *beads left out*: as the stage itself reports them, each from a calibration made without \
             it. The goal is 1.2 times the bound."
        ),
        "Stated regions: of the source from the stated covariance, of points from it and the stated noise, with Fisher's F for \
         a noise that is itself estimated. The goal is 93 to 97 %."
            .to_owned(),
        "Through distortion: the whole way from raw pictures. A plate before each intensifier, the beads in the bent picture, both \
         noisy, 8 bit. *Projected*: how far points of the volume are from the rays of the pixels where they are truly recorded, in \
         their depth; *triangulated*: from both such rays. So all that is left of calibration and distortion together, of a plate \
         and a frame of beads whose lists are exact, as no laboratory's are: an error of a list comes on top."
            .to_owned(),
        "Bad inputs: what a laboratory gets wrong. A calibration that comes out of it counts as wrong if it puts points of the \
         volume farther off than the limit that the stage itself states for its beads (root mean square)."
            .to_owned(),
    ]
}

/// What a scene through distortion comes to.
struct Chained {
    sources: Vec<(f64, f64)>,
    error: VolumeError,
    good: bool,
}

fn chain(lab: &Lab) -> Result<(Table, Vec<biplane_artifact::Frame>), SectionError> {
    let mut table = table(
        "environment-chain",
        "from raw pictures of plate and beads",
        vec![
            Column::at_most("source along the view, mm rms", 3),
            Column::at_most("source across the view, mm rms", 3),
            Column::at_most("projected, mm rms", 4),
            Column::at_most("projected, worst scene", 4),
            Column::at_most("triangulated, mm rms", 4),
            Column::at_most("triangulated, worst scene", 4),
            Column::at_least("good", 0),
        ],
    );
    let mut shown = Vec::new();
    for (index, stand) in STANDS.iter().enumerate() {
        type Done = (Option<Chained>, Vec<biplane_artifact::Frame>);
        let all: Vec<Done> = (0..lab.count(12, 1))
            .into_par_iter()
            .map(|number| {
                let mut chance = random(lab.seed, 84 + index as u64, number);
                let scene = BeadScene::drawn(stand, &mut chance)?;
                let distortions = scene.views.each_ref().map(|v| bent(v.size, &mut chance));
                let exposures = distortions.map(|d| of_a_plate(Some(d)));
                let [a, b] = &exposures;
                let (found, frames) = calibrated(lab, &scene, [a, b], 100 * index + number)?;
                let (radius, height) = volume(stand);
                let points = BeadScene::points(radius, height, 10 * POINTS, &mut chance);
                let truth = [(&scene.views[0], &distortions[0]), (&scene.views[1], &distortions[1])];
                let source = |(v, t): (&ViewEnvironment, &TrueFluoroscope)| {
                    along_and_across(&ViewError::of(v, t).source, &t.normal())
                };
                let done = found.map(|found| Chained {
                    sources: found.environment.views.iter().zip(&scene.views).map(source).collect(),
                    error: VolumeError::of(&found.fluoroscopes(), &truth, &points),
                    good: found.good(),
                });
                Ok::<Done, SceneError>((done, frames))
            })
            .collect::<Result<_, _>>()?;
        if index == 0 {
            shown.extend(all.first().map(|a| a.1.clone()).unwrap_or_default());
        }
        let done: Vec<&Chained> = all.iter().filter_map(|a| a.0.as_ref()).collect();
        let good = Cell::Share(done.iter().filter(|c| c.good).count(), all.len());
        let cells = match done.is_empty() {
            true => vec![Cell::text("-"); 6],
            false => {
                let worst = |f: fn(&Chained) -> &[f64]| {
                    done.iter().map(|c| rms(f(c).iter().copied())).fold(0.0, f64::max)
                };
                let all_rms = |f: fn(&Chained) -> &[f64]| rms(done.iter().flat_map(|c| f(c).iter().copied()));
                let sources = || done.iter().flat_map(|c| c.sources.iter());
                [
                    rms(sources().map(|s| s.0)),
                    rms(sources().map(|s| s.1 / 2.0_f64.sqrt())),
                    all_rms(|c| &c.error.projected),
                    worst(|c| &c.error.projected),
                    all_rms(|c| &c.error.triangulated),
                    worst(|c| &c.error.triangulated),
                ]
                .map(Cell::Number)
                .into()
            }
        };
        table.rows.push(Row::ours(stand.name, cells.into_iter().chain([good]).collect()));
    }
    Ok((table, shown))
}

fn simulated(lab: &Lab) -> Result<Table, SectionError> {
    let mut table = table(
        "environment-gvirtualxray",
        "gVirtualXray's pictures of plate and beads",
        vec![
            Column::at_most("source A along the view, mm", 3),
            Column::at_most("across", 3),
            Column::at_most("source B along the view, mm", 3),
            Column::at_most("across, B", 3),
            Column::at_most("projected, mm rms", 4),
            Column::at_most("triangulated, mm rms", 4),
            Column::at_most("beads left out, as stated, mm rms", 4),
            Column::at_least("good", 0),
        ],
    );
    for (name, folder) in STUDIES {
        let study = Simulated::read(&lab.root.join(folder))?;
        let truth = study.truth();
        let fits: Vec<PlateFit> = (0..2).filter_map(|v| study.plate_fit(v)).collect();
        let spots: Vec<Spots> = (0..2).filter_map(|v| study.bead_spots(v)).collect();
        let calibrated = <[Spots; 2]>::try_from(spots).ok().zip(<[PlateFit; 2]>::try_from(fits).ok());
        let done = calibrated.and_then(|(spots, fits)| {
            let detectors = [0, 1].map(|v| Detector {
                view: crate::bead_scenes::name(v),
                size: truth[v].0.size,
                pixel_mm: fits[v].pixel_mm,
                distortion: Some(fits[v].table.clone()),
            });
            Some((environment(&detectors, &spots, &study.beads, None)?, fits))
        });
        let Some((found, fits)) = done else {
            let cells = vec![Cell::text("-"); 7].into_iter().chain([Cell::Share(0, 1)]);
            table.rows.push(Row::ours(name, cells.collect()));
            continue;
        };
        let views: Vec<Fluoroscope> =
            found.views.iter().zip(&fits).map(|(v, fit)| fluoroscope(v, Some(&fit.table))).collect();
        let points = BeadScene::points(45.0, 100.0, 400, &mut random(lab.seed, 88, 0));
        let recording: Vec<(&TrueFluoroscope, &Distortion)> = truth.iter().map(|(v, d)| (*v, d)).collect();
        let error = VolumeError::of(&views, &recording, &points);
        let mut cells: Vec<Cell> = found
            .views
            .iter()
            .zip(&truth)
            .flat_map(|(v, (t, _))| {
                let (along, across) = along_and_across(&ViewError::of(v, t).source, &t.normal());
                [Cell::Number(along), Cell::Number(across)]
            })
            .collect();
        cells.extend([
            Cell::Number(rms(error.projected)),
            Cell::Number(rms(error.triangulated)),
            Cell::Number(found.triangulation_rms_mm.unwrap_or(f64::NAN)),
            Cell::Share(usize::from(found.verdict == Verdict::Good), 1),
        ]);
        table.rows.push(Row::ours(name, cells));
    }
    Ok(table)
}

/// What a laboratory gets wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    /// Six beads clicked in each view, two of them swapped in the first.
    SwappedClicks,
    /// One bead of the list 2 mm from where it is.
    MovedBead,
    /// The list in another unit: its numbers are so many times too small.
    Unit(&'static str, f64),
    /// The list left-handed.
    LeftHanded,
    /// Pictures mirrored: this many of the two.
    Mirrored(usize),
    /// The list of another frame.
    OtherFrame,
}

const FAULTS: [Fault; 9] = [
    Fault::SwappedClicks,
    Fault::MovedBead,
    Fault::Unit("cm", 10.0),
    Fault::Unit("inches", 25.4),
    Fault::Unit("m", 1000.0),
    Fault::LeftHanded,
    Fault::Mirrored(1),
    Fault::Mirrored(2),
    Fault::OtherFrame,
];

impl Fault {
    fn name(self) -> String {
        match self {
            Self::SwappedClicks => "two of six clicks swapped in one view".to_owned(),
            Self::MovedBead => "one bead of the list off by 2 mm".to_owned(),
            Self::Unit(unit, _) => format!("list of the beads in {unit}, taken for mm"),
            Self::LeftHanded => "list of the beads left-handed".to_owned(),
            Self::Mirrored(1) => "pictures of one view mirrored".to_owned(),
            Self::Mirrored(_) => "pictures of both views mirrored".to_owned(),
            Self::OtherFrame => "list of another frame".to_owned(),
        }
    }
}

/// How calibrations from bad inputs end.
#[derive(Debug, Clone, Copy, Default)]
struct Faulty {
    refused: usize,
    doubtful: usize,
    good: usize,
    good_yet_wrong: usize,
}

fn bad_columns() -> Vec<Column> {
    let names = ["refused", "doubtful", "good"].map(|n| Column::at_most(n, 0));
    names.into_iter().chain([Column::at_most("good, yet wrong", 0)]).collect()
}

impl Faulty {
    fn add(&mut self, other: &Self) {
        self.refused += other.refused;
        self.doubtful += other.doubtful;
        self.good += other.good;
        self.good_yet_wrong += other.good_yet_wrong;
    }

    fn cells(&self) -> Vec<Cell> {
        let shown = [self.refused, self.doubtful, self.good].map(|n| Cell::text(n.to_string()));
        shown.into_iter().chain([Cell::Number(self.good_yet_wrong as f64)]).collect()
    }
}

fn faulty(lab: &Lab, seen: &Seen, fault: Fault) -> Faulty {
    let Seen { scene, spots, number, .. } = seen;
    let mut chance = random(lab.seed, 89, *number);
    let (mut spots, mut beads, mut clicks) = (spots.clone(), scene.list(), None);
    match fault {
        Fault::SwappedClicks => {
            let mut all = Vec::new();
            for (view, truth) in scene.views.iter().enumerate() {
                // Beads of all rings, and the two larger ones.
                let clicked = [0, 7, 14, 21, 28, 29];
                for (place, bead) in clicked.into_iter().enumerate() {
                    let named = if view == 0 && place < 2 { clicked[1 - place] } else { bead };
                    let at = scene.frame.beads.get(bead).and_then(|b| truth.project(&b.centre));
                    let click = |at_px| BeadClick { view, picture: 0, bead: named, at_px };
                    all.extend(at.map(|(p, _)| click(p.coords.into())));
                }
            }
            clicks = Some(BeadClicks(all));
        }
        Fault::MovedBead => {
            let by = normal_vector(1.0, &mut chance).normalize() * 2.0;
            let count = beads.0.len().max(1);
            if let Some(bead) = beads.0.get_mut(number % count) {
                bead.at_mm = (Vector3::from(bead.at_mm) + by).into();
            }
        }
        Fault::Unit(_, times) => {
            for bead in &mut beads.0 {
                bead.at_mm = bead.at_mm.map(|v| v / times);
                bead.radius_mm = bead.radius_mm.map(|r| r / times);
            }
        }
        Fault::LeftHanded => beads.0.iter_mut().for_each(|b| b.at_mm[0] = -b.at_mm[0]),
        Fault::Mirrored(count) => {
            for spots in &mut spots[..count.min(2)] {
                let last = spots.size[0] as f64 - 1.0;
                spots.spots.iter_mut().for_each(|s| s.at_px[0] = last - s.at_px[0]);
            }
        }
        Fault::OtherFrame => {
            let layout = if scene.frame.beads[0].radius > 1.2 { STANDS[0].layout } else { STANDS[1].layout };
            if let Ok(other) = BeadScene::before(scene.views.clone(), &layout(), &mut chance) {
                beads = other.list();
            }
        }
    }
    let Some(found) = environment(&scene.detectors(), &spots, &beads, clicks.as_ref()) else {
        return Faulty { refused: 1, ..Faulty::default() };
    };
    if found.verdict != Verdict::Good {
        return Faulty { doubtful: 1, ..Faulty::default() };
    }
    let none = scene.views.each_ref().map(|v| IntensifierDistortion::none(v.size));
    let truth = [(&scene.views[0], &none[0]), (&scene.views[1], &none[1])];
    let views: Vec<Fluoroscope> = found.views.iter().map(|v| fluoroscope(v, None)).collect();
    let error = VolumeError::of(&views, &truth, &seen.fresh);
    let limit = EnvironmentParams::default().max_triangulation_mm;
    let off = rms(error.triangulated.iter().copied());
    let wrong = off.is_nan() || off > limit || error.triangulated.len() < seen.fresh.len();
    Faulty { good: 1, good_yet_wrong: usize::from(wrong), ..Faulty::default() }
}
