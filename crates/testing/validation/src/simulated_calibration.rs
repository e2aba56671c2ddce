//! Calibration pictures that another program made, with its truth: `fixtures/knee` and `fixtures/knee-natural`.

use std::path::{Path, PathBuf};

use biplane_acquisition::images::read_frame;
use biplane_artifact::{Bead, BeadList, DistortionTable, Frame, PlateFit, PlatePattern, PlateSpot, Spots};
use biplane_distortion::{DistortionParams, fit_plate};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Vector2, Vector3};
use biplane_phantom::TrueFluoroscope;
use biplane_spots::{Look, SpotParams, SpotSettings, find_spots};
use nalgebra::Rotation2;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::SceneError;
use crate::bead_scenes::{beads_of, name};
use crate::plates::{MapError, on_plate};

/// Their names in tables, and their folders.
pub const STUDIES: [(&str, &str); 2] =
    [("knee implant", "fixtures/knee"), ("natural knee", "fixtures/knee-natural")];

#[derive(Deserialize)]
struct Truth {
    pixel_mm: f64,
    size: [usize; 2],
    fluoroscopes: std::collections::BTreeMap<String, TrueView>,
}

#[derive(Deserialize)]
struct TrueView {
    source: [f64; 3],
    centre: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
}

#[derive(Deserialize)]
struct Hole {
    x_mm: f64,
    y_mm: f64,
    radius_mm: f64,
}

#[derive(Deserialize)]
struct OnDetector {
    hole: usize,
    detector_u_mm: f64,
    detector_v_mm: f64,
}

#[derive(Deserialize)]
struct Sample {
    distorted_x_px: f64,
    distorted_y_px: f64,
    ideal_x_px: f64,
    ideal_y_px: f64,
}

#[derive(Deserialize)]
struct ListedBead {
    bead: String,
    x_mm: f64,
    y_mm: f64,
    z_mm: f64,
    radius_mm: f64,
}

/// The pictures and the truth of one view.
struct View {
    truth: TrueFluoroscope,
    plate: Frame,
    beads: Frame,
    samples: Vec<(Point2, Point2)>,
    table: DistortionTable,
    /// From the detector, mm from its middle, to the plate: rotation, then translation.
    to_plate: (Rotation2<f64>, Vector2),
}

/// A study.
pub struct Simulated {
    pattern: PlatePattern,
    /// The beads as listed.
    pub beads: BeadList,
    views: Vec<View>,
}

fn bad(path: &Path, what: impl std::fmt::Display) -> SceneError {
    SceneError::Mesh(format!("{}: {what}", path.display()))
}

fn rows<T: DeserializeOwned>(path: PathBuf) -> Result<Vec<T>, SceneError> {
    let mut reader = csv::Reader::from_path(&path).map_err(|e| bad(&path, e))?;
    reader.deserialize().collect::<Result<_, _>>().map_err(|e| bad(&path, e))
}

impl Simulated {
    /// Reads a study's folder.
    ///
    /// # Errors
    /// A file cannot be read, or is something else.
    pub fn read(folder: &Path) -> Result<Self, SceneError> {
        let path = folder.join("truth/fluoroscopes.json");
        let text = std::fs::read_to_string(&path).map_err(|e| bad(&path, e))?;
        let truth: Truth = serde_json::from_str(&text).map_err(|e| bad(&path, e))?;
        let holes: Vec<Hole> = rows(folder.join("calibration/plate.csv"))?;
        let listed: Vec<ListedBead> = rows(folder.join("calibration/beads.csv"))?;
        let smallest = listed.iter().map(|b| b.radius_mm).fold(f64::INFINITY, f64::min);
        let beads = listed.into_iter().map(|b| Bead {
            name: b.bead,
            at_mm: [b.x_mm, b.y_mm, b.z_mm],
            radius_mm: Some(b.radius_mm),
            mark: b.radius_mm > 1.2 * smallest,
        });
        let beads = BeadList(beads.collect());
        let mut views = Vec::new();
        for view in 0..2 {
            let name = name(view);
            let of = truth.fluoroscopes.get(&name).ok_or_else(|| bad(&path, format!("no view {name}")))?;
            let samples: Vec<Sample> = rows(folder.join(format!("truth/distortion_{name}.csv")))?;
            let samples: Vec<(Point2, Point2)> = samples
                .iter()
                .map(|s| {
                    (Point2::new(s.distorted_x_px, s.distorted_y_px), Point2::new(s.ideal_x_px, s.ideal_y_px))
                })
                .collect();
            let placed: Vec<OnDetector> = rows(folder.join(format!("truth/plate_{name}.csv")))?;
            let read = |kind: &str| read_frame(folder.join(format!("calibration/{kind}_{name}.png")), 0);
            views.push(View {
                truth: TrueFluoroscope {
                    source: of.source.into(),
                    centre: of.centre.into(),
                    along_x: Vector3::from(of.u),
                    along_y: Vector3::from(of.v),
                    pixel_mm: truth.pixel_mm,
                    size: truth.size,
                },
                plate: read("plate")?,
                beads: read("beads")?,
                table: table(&samples)
                    .ok_or_else(|| bad(folder, "the samples of the distortion are no grid"))?,
                samples,
                to_plate: motion(&placed, &holes),
            });
        }
        let spots = holes.iter().map(|h| PlateSpot { at_mm: [h.x_mm, h.y_mm], radius_mm: Some(h.radius_mm) });
        Ok(Self { pattern: PlatePattern::List(spots.collect()), beads, views })
    }

    /// What the product makes of a plate's picture; `None` where it fails.
    pub fn plate_fit(&self, view: usize) -> Option<PlateFit> {
        let params = SpotParams { look: Look::Bright, settings: SpotSettings::default() };
        let spots = find_spots(&self.views[view].plate, &params).ok()?;
        fit_plate(&spots, &self.pattern, None, &DistortionParams::default()).ok()
    }

    /// The spots of a picture of beads; `None` where the product finds none.
    pub fn bead_spots(&self, view: usize) -> Option<Spots> {
        beads_of(&self.views[view].beads).ok()
    }

    /// The true views, with the true distortion.
    pub fn truth(&self) -> Vec<(&TrueFluoroscope, Distortion)> {
        self.views.iter().map(|v| (&v.truth, Distortion::from(&v.table))).collect()
    }

    /// Error of a map inside `share` of the round border's radius, at the samples.
    pub fn map_error(&self, view: usize, fit: &PlateFit, share: f64) -> MapError {
        let View { truth, samples, to_plate: (turn, shift), .. } = &self.views[view];
        let middle = Point2::from(truth.size.map(|n| (n as f64 - 1.0) / 2.0));
        let (centre, radius) =
            fit.border.map_or((middle, middle.x), |b| (Point2::from(b.centre_px), b.radius_px));
        let near: Vec<_> = samples.iter().filter(|s| (s.0 - centre).norm() <= share * radius).collect();
        let recorded: Vec<Point2> = near.iter().map(|s| s.0).collect();
        let true_mm: Vec<Point2> =
            near.iter().map(|s| Point2::from(turn * ((s.1 - middle) * truth.pixel_mm) + shift)).collect();
        MapError::of(&on_plate(fit, &recorded), &true_mm, truth.pixel_mm)
    }
}

/// The rigid motion from places on the detector to the plate's own.
fn motion(placed: &[OnDetector], holes: &[Hole]) -> (Rotation2<f64>, Vector2) {
    let pairs: Vec<(Vector2, Vector2)> = placed
        .iter()
        .filter_map(|p| {
            let hole = holes.get(p.hole)?;
            Some((Vector2::new(p.detector_u_mm, p.detector_v_mm), Vector2::new(hole.x_mm, hole.y_mm)))
        })
        .collect();
    let count = pairs.len().max(1) as f64;
    let from = pairs.iter().map(|p| p.0).sum::<Vector2>() / count;
    let to = pairs.iter().map(|p| p.1).sum::<Vector2>() / count;
    let dot: f64 = pairs.iter().map(|p| (p.0 - from).dot(&(p.1 - to))).sum();
    let cross: f64 = pairs.iter().map(|p| (p.0 - from).perp(&(p.1 - to))).sum();
    let turn = Rotation2::new(cross.atan2(dot));
    (turn, to - turn * from)
}

/// Samples on a regular grid, x running fastest, as a table.
fn table(samples: &[(Point2, Point2)]) -> Option<DistortionTable> {
    let first = samples.first()?.0;
    let columns = samples.iter().take_while(|s| s.0.y == first.y).count();
    let (next, below) = (samples.get(1)?.0, samples.get(columns)?.0);
    samples.len().is_multiple_of(columns).then(|| DistortionTable {
        first_px: first.coords.into(),
        step_px: [next.x - first.x, below.y - first.y],
        count: [columns, samples.len() / columns],
        ideal_px: samples.iter().map(|s| s.1.coords.into()).collect(),
    })
}
