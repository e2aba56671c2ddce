//! From raw calibration pictures to the fluoroscopes: the steps `spots`, `distortion`, `environment` and `drawing`.
//!
//! `spots/plate/<view>` and `spots/beads/<view>/<placing>` find holes and beads, `distortion/<view>` maps the recorded pixels of
//! a view to ideal ones, `environment/fluoroscopes` finds all sources and detectors at once, `drawing/...` shows each to people.
//! One walk over these serves both running and looking ([`Way`]), so that what `explain` says is what `run` does.

use std::path::{Path, PathBuf};

use biplane_acquisition::images::read_frame;
use biplane_artifact::{
    Calibration, CalibrationUncertainty, Content, Detector, Environment, Picture, PlateFit, Spots, Verdict,
};
use biplane_distortion::{DistortionInputs, FitDistortion};
use biplane_environment::{EnvironmentInputs, EnvironmentParams, FindEnvironment};
use biplane_fluoroscope::Fluoroscope;
use biplane_spots::{FindSpots, SpotInputs};
use biplane_stage::{Artifact, Context, Hashed, Item, ParamsText, Promised, Store};

use crate::diagnostics::slashes;
use crate::drawings::{
    BeadDrawingInputs, BeadDrawingParams, DrawBeads, DrawPlate, DrawResiduals, DrawSpace, PlateDrawingInputs,
    PlateDrawingParams, ResidualDrawingInputs, SpaceDrawingInputs, SpaceDrawingParams,
};
use crate::prepare::{CalibrationInputs, Prepared};
use crate::results::write_if_changed;
use crate::sources::FrameFacts;
use crate::steps::{DISTORTION, DRAWING, ENVIRONMENT, ItemError, SPOTS};
use crate::study::{Correction, Study, Trial, ViewSource};
use crate::walk::{Walk, Way};

/// What the raw calibration pictures of a study gave.
#[derive(Debug, Default)]
pub struct Calibrated {
    /// One a view.
    pub calibrations: Vec<Hashed<Calibration>>,
    /// One a view; none where no plate was pictured.
    pub plates: Vec<Option<Hashed<PlateFit>>>,
    /// How sure the calibrations of each trial are; none where nothing is known of it.
    pub uncertainties: Vec<Option<Hashed<CalibrationUncertainty>>>,
    /// None where calibrations come from files.
    pub environment: Option<Hashed<Environment>>,
    /// What people look at.
    pub drawings: Vec<Drawn>,
    /// Calibration pictures and the hashes of their contents.
    pub inputs: Vec<(String, String)>,
}

/// A drawing in the folder of results.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// What it shows.
    pub title: String,
    /// Its place, relative to the folder of results.
    pub place: PathBuf,
    stored: PathBuf,
}

/// Walks over the calibration of a study.
#[derive(Debug)]
pub struct Calibrating<'a> {
    prepared: &'a Prepared,
    inputs: &'a CalibrationInputs,
    walk: Walk<'a>,
}

/// What a calibration gave, and how its steps were done; or why there is none.
pub type Walked = (Result<Option<Calibrated>, CalibrateError>, Way);

/// Why there are no fluoroscopes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CalibrateError {
    /// The run was stopped.
    #[error("stopped")]
    Cancelled,
    /// One message an item.
    #[error("{}", .0.join("\n"))]
    Failed(Vec<String>),
}

/// Finds the fluoroscopes of a study, or says what finding them would take. `Ok(None)` where looking cannot know yet.
/// Calibrations from files are there already.
pub fn calibrate(prepared: &Prepared, store: &Store, context: &Context, way: Way) -> Walked {
    let Some(inputs) = prepared.equipment.inputs() else {
        let calibrations = prepared.equipment.known().to_vec();
        let stated = |trial: &Trial| stated(&prepared.study, &calibrations, trial).map(Hashed::new);
        let uncertainties = prepared.study.trials.iter().map(stated).collect();
        return (Ok(Some(Calibrated { calibrations, uncertainties, ..Calibrated::default() })), way);
    };
    let walk = Walk::new(&prepared.study, store, context, way);
    let mut calibrating = Calibrating { prepared, inputs, walk };
    let result = calibrating.all();
    let walk = calibrating.walk;
    let result = match result {
        Err(ItemError::Cancelled) => Err(CalibrateError::Cancelled),
        Err(ItemError::Failed(message)) => Err(CalibrateError::Failed(vec![message])),
        // Only looking goes on past what cannot be done: it says so item by item.
        Ok(_) if !walk.faults.is_empty() && matches!(walk.way, Way::Run(_)) => {
            let faults = walk.faults.iter().map(|f| format!("{}: {}", f.item, f.message));
            Err(CalibrateError::Failed(faults.collect()))
        }
        Ok(calibrated) => Ok(calibrated),
    };
    (result, walk.way)
}

/// What the pipeline file says of how sure the calibrations of a trial are, if it says so.
fn stated(
    study: &Study,
    calibrations: &[Hashed<Calibration>],
    trial: &Trial,
) -> Option<CalibrationUncertainty> {
    let view = |(view, _): &(usize, String)| match &study.views.get(*view)?.source {
        ViewSource::File { uncertainty: Some(stated), .. } => {
            // Its distortion does not count here, and takes time to invert.
            let ideal = Calibration { distortion: None, ..Calibration::clone(calibrations.get(*view)?) };
            let distance = Fluoroscope::from(&ideal).source_to_detector_mm(stated.pixel_mm);
            Some([distance, stated.source_mm, stated.detector_mm])
        }
        _ => None,
    };
    let views: Vec<[f64; 3]> = trial.frames.iter().map(view).collect::<Option<_>>()?;
    Some(CalibrationUncertainty::independent(&views))
}

impl Calibrating<'_> {
    fn all(&mut self) -> Result<Option<Calibrated>, ItemError> {
        let mut drawings = Vec::new();
        let study = &self.prepared.study;
        let mut plates = Vec::new();
        for (view, name) in study.views.iter().map(|v| v.name.clone()).enumerate() {
            plates.push(match self.correction(view) {
                Correction::Plate(path) => Some(self.plate(view, &name, &path, &mut drawings)?),
                Correction::Table(..) | Correction::None(_) => None,
            });
        }
        let mut spots = Vec::new();
        for placing in 0..self.inputs.placings {
            for view in 0..study.views.len() {
                spots.push(self.bead_spots(view, placing)?);
            }
        }
        let plates: Option<Vec<Option<Hashed<PlateFit>>>> =
            plates.into_iter().map(|fit| fit.map_or(Some(None), |f| f.map(Some))).collect();
        let spots: Option<Vec<Hashed<Spots>>> = spots.into_iter().collect();
        let (Some(plates), Some(spots)) = (plates, spots) else {
            self.walk.follows(ENVIRONMENT, &Item::from("fluoroscopes"));
            self.write(&drawings)?;
            return Ok(None);
        };
        let detectors = self.detectors(&plates, &spots)?;
        let environment = self.environment(&detectors, spots)?;
        let Some(environment) = environment else {
            self.write(&drawings)?;
            return Ok(None);
        };
        self.draw_beads(&environment, &mut drawings)?;
        self.write(&drawings)?;
        let calibrations = environment.views.iter().zip(&detectors).map(|(found, detector)| {
            Hashed::new(Calibration {
                view: found.view.clone(),
                size: found.size,
                source: found.source,
                matrix: found.matrix,
                distortion: detector.distortion.clone(),
            })
        });
        let calibrations = calibrations.collect();
        let inputs = self.pictures();
        let of = |trial: &Trial| {
            let views: Vec<usize> = trial.frames.iter().map(|(view, _)| *view).collect();
            CalibrationUncertainty::of(&environment, &views).map(Hashed::new)
        };
        let uncertainties = study.trials.iter().map(of).collect();
        Ok(Some(Calibrated {
            calibrations,
            plates,
            uncertainties,
            environment: Some(environment),
            drawings,
            inputs,
        }))
    }

    fn correction(&self, view: usize) -> Correction {
        match &self.prepared.study.views[view].source {
            ViewSource::Pictures { correction, .. } => correction.clone(),
            ViewSource::File { .. } => Correction::None(1.0),
        }
    }

    fn bead_picture(&self, view: usize, placing: usize) -> PathBuf {
        match &self.prepared.study.views[view].source {
            ViewSource::Pictures { beads, .. } => beads.get(placing).cloned().unwrap_or_default(),
            ViewSource::File { .. } => PathBuf::new(),
        }
    }

    /// All calibration pictures and their hashes.
    fn pictures(&self) -> Vec<(String, String)> {
        let study = &self.prepared.study;
        let mut paths: Vec<PathBuf> = Vec::new();
        for (number, view) in study.views.iter().enumerate() {
            if let ViewSource::Pictures { beads, .. } = &view.source {
                paths.extend(beads.iter().cloned());
            }
            if let Correction::Plate(path) = self.correction(number) {
                paths.push(path);
            }
        }
        let hash = |path: &PathBuf| Some((study.relative(path), self.facts(path).ok()?.hash().to_hex()));
        paths.iter().filter_map(hash).collect()
    }

    fn facts(&self, path: &Path) -> Result<FrameFacts, ItemError> {
        self.prepared.index.frame(path, 0, || read_frame(path, 0)).map_err(ItemError::of)
    }

    fn plate(
        &mut self,
        view: usize,
        name: &str,
        path: &Path,
        drawings: &mut Vec<Drawn>,
    ) -> Result<Option<Hashed<PlateFit>>, ItemError> {
        let item = Item::of(["plate", name]);
        let facts = match self.facts(path) {
            Ok(facts) => facts,
            Err(error) => return self.walk.fault(SPOTS, &item, &error),
        };
        let frame = || read_frame(path, 0).map(Hashed::new).map_err(|e| e.to_string());
        let (inputs, params) = (self.inputs, &self.inputs.plate_spots);
        let promised = SpotInputs::<Promised> { frame: facts.promise() };
        let spots = self
            .walk
            .step::<FindSpots>(SPOTS, &item, params, &promised, || Ok(SpotInputs { frame: frame()? }))?;
        let own = Item::of([name]);
        let (Some((spots, _)), Some(pattern)) = (spots, &inputs.pattern) else {
            self.walk.follows(DISTORTION, &own);
            return Ok(None);
        };
        let clicks: Vec<_> = inputs.plate_clicks[view].iter().cloned().collect();
        let given = DistortionInputs { spots, pattern: pattern.clone(), clicks };
        let fit = self.walk.ready::<FitDistortion>(DISTORTION, &own, &inputs.distortion, given)?;
        let Some((fit, _)) = fit else { return Ok(None) };
        let limit = self.prepared.study.distortion.max_held_out_px;
        let params = PlateDrawingParams { view: name.to_owned(), max_held_out_px: limit };
        let params = ParamsText::of(&params).map_err(ItemError::of)?;
        let title = format!("Plate on {name}: holes found, matched and used");
        let promised = PlateDrawingInputs::<Promised> { frame: facts.promise(), fit: fit.promise() };
        let load = || Ok(PlateDrawingInputs { frame: frame()?, fit: fit.clone() });
        let item = Item::of(["plate", name]);
        let drawn = self.walk.step::<DrawPlate>(DRAWING, &item, &params, &promised, load)?;
        drawings.extend(drawn.map(|(_, path)| Drawn::of(title, format!("plate_{name}.svg"), path)));
        let title = format!("Distortion of {name}, and what the correction leaves");
        let given = ResidualDrawingInputs { fit: fit.clone() };
        let item = Item::of(["distortion", name]);
        let drawn = self.walk.ready::<DrawResiduals>(DRAWING, &item, &params, given)?;
        drawings.extend(drawn.map(|(_, path)| Drawn::of(title, format!("distortion_{name}.svg"), path)));
        Ok(Some(fit))
    }

    fn bead_spots(&mut self, view: usize, placing: usize) -> Result<Option<Hashed<Spots>>, ItemError> {
        let path = self.bead_picture(view, placing);
        let item = Item::of(["beads", &self.prepared.study.views[view].name, &placing.to_string()]);
        let facts = match self.facts(&path) {
            Ok(facts) => facts,
            Err(error) => return self.walk.fault(SPOTS, &item, &error),
        };
        let promised = SpotInputs::<Promised> { frame: facts.promise() };
        let load =
            || Ok(SpotInputs { frame: read_frame(&path, 0).map(Hashed::new).map_err(|e| e.to_string())? });
        let params = &self.inputs.bead_spots;
        Ok(self.walk.step::<FindSpots>(SPOTS, &item, params, &promised, load)?.map(|(spots, _)| spots))
    }

    fn detectors(
        &self,
        plates: &[Option<Hashed<PlateFit>>],
        spots: &[Hashed<Spots>],
    ) -> Result<Vec<Hashed<Detector>>, ItemError> {
        let views = &self.prepared.study.views;
        let mut detectors = Vec::new();
        for (view, (seen, fit)) in views.iter().zip(spots.iter().zip(plates)) {
            if let Some(fit) = fit.as_ref().filter(|fit| fit.size != seen.size) {
                let [plate, beads] = [fit.size, seen.size].map(|[w, h]| format!("{w} x {h}"));
                return Err(ItemError::Failed(format!(
                    "view {}: the picture of the plate has {plate} pixels, that of the beads {beads}. Take both with the \
                     same settings of the fluoroscope, and neither crop nor scale them",
                    view.name
                )));
            }
            let (pixel_mm, distortion) = match (fit, self.correction(detectors.len())) {
                (Some(fit), _) => (fit.pixel_mm, Some(fit.table.clone())),
                (None, Correction::Table(_, mm)) => (mm, self.inputs.tables[detectors.len()].clone()),
                (None, Correction::None(mm)) => (mm, None),
                (None, Correction::Plate(_)) => continue,
            };
            let (name, size) = (view.name.clone(), seen.size);
            detectors.push(Hashed::new(Detector { view: name, size, pixel_mm, distortion }));
        }
        Ok(detectors)
    }

    fn environment(
        &mut self,
        detectors: &[Hashed<Detector>],
        spots: Vec<Hashed<Spots>>,
    ) -> Result<Option<Hashed<Environment>>, ItemError> {
        let inputs = self.inputs;
        let given = EnvironmentInputs {
            detectors: detectors.to_vec(),
            spots,
            beads: inputs.beads.clone(),
            clicks: inputs.bead_clicks.iter().cloned().collect(),
        };
        let item = Item::from("fluoroscopes");
        let found = self.walk.ready::<FindEnvironment>(ENVIRONMENT, &item, &inputs.environment, given)?;
        Ok(found.map(|(environment, _)| environment))
    }

    fn draw_beads(
        &mut self,
        environment: &Hashed<Environment>,
        drawings: &mut Vec<Drawn>,
    ) -> Result<(), ItemError> {
        let (inputs, study) = (self.inputs, &self.prepared.study);
        let EnvironmentParams { max_reprojection_px, max_triangulation_mm, .. } = study.environment;
        for (view, name) in study.views.iter().map(|v| v.name.as_str()).enumerate() {
            for placing in 0..inputs.placings {
                let path = self.bead_picture(view, placing);
                let facts = self.facts(&path)?;
                let beads = inputs.beads.clone();
                let promised = BeadDrawingInputs::<Promised> {
                    frame: facts.promise(),
                    environment: environment.promise(),
                    beads: beads.promise(),
                };
                let load = || {
                    let frame = Hashed::new(read_frame(&path, 0).map_err(|e| e.to_string())?);
                    Ok(BeadDrawingInputs { frame, environment: environment.clone(), beads })
                };
                let params = BeadDrawingParams { view, picture: placing, max_reprojection_px };
                let params = ParamsText::of(&params).map_err(ItemError::of)?;
                let item = Item::of(["beads", name, &placing.to_string()]);
                let drawn = self.walk.step::<DrawBeads>(DRAWING, &item, &params, &promised, load)?;
                let (place, title) = match inputs.placings {
                    1 => (format!("beads_{name}.svg"), format!("Beads in {name}, and what the fit leaves")),
                    _ => (
                        format!("beads_{name}_{placing}.svg"),
                        format!("Beads in {name}, picture {placing}, and what the fit leaves"),
                    ),
                };
                drawings.extend(drawn.map(|(_, stored)| Drawn::of(title, place, stored)));
            }
        }
        let given = SpaceDrawingInputs { environment: environment.clone(), beads: inputs.beads.clone() };
        let item = Item::from("fluoroscopes");
        let params = SpaceDrawingParams { max_reprojection_px, max_triangulation_mm };
        let params = ParamsText::of(&params).map_err(ItemError::of)?;
        let drawn = self.walk.ready::<DrawSpace>(DRAWING, &item, &params, given)?;
        let title = "The fluoroscopes and the beads in space".to_owned();
        drawings.extend(drawn.map(|(_, path)| Drawn::of(title, "fluoroscopes.svg".to_owned(), path)));
        Ok(())
    }

    /// Copies drawings to the folder of results: also those that show why there are no fluoroscopes.
    fn write(&self, drawings: &[Drawn]) -> Result<(), ItemError> {
        if matches!(self.walk.way, Way::Look(_)) {
            return Ok(());
        }
        for drawn in drawings {
            let place = self.prepared.study.output.join(&drawn.place);
            let copied = crate::results::copy_if_other(&drawn.stored, &place);
            copied.map_err(|e| ItemError::Failed(format!("cannot write {}: {e}", slashes(&place))))?;
        }
        Ok(())
    }
}

impl Drawn {
    fn of(title: String, name: String, stored: PathBuf) -> Self {
        Self { title, place: Path::new("calibration").join(name), stored }
    }
}

impl Calibrated {
    /// What is worth a look, for people.
    pub fn warnings(&self, views: &[crate::study::View]) -> Vec<String> {
        let mut warnings = Vec::new();
        for (view, fit) in views.iter().zip(&self.plates) {
            let fit = fit.iter();
            warnings.extend(fit.flat_map(|f| &f.warnings).map(|w| format!("plate of {}: {w}", view.name)));
        }
        let environment = self.environment.iter();
        warnings.extend(environment.flat_map(|e| &e.warnings).map(|w| format!("beads: {w}")));
        warnings
    }

    /// The worst verdict of all plates and of the environment.
    pub fn verdict(&self) -> Verdict {
        let plates = self.plates.iter().flatten().map(|fit| fit.verdict);
        plates.chain(self.environment.iter().map(|e| e.verdict)).max().unwrap_or(Verdict::Good)
    }

    /// Writes what other programs can use into the folder of results: `calibration/fluoroscopes.json`, which `biplane convert`
    /// turns into other formats, and the distortion tables. Returns each file and the hash by which it is known as made by a run.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(
        &self,
        results: &Path,
        views: &[crate::study::View],
    ) -> Result<Vec<(String, String)>, (PathBuf, std::io::Error)> {
        let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
        for drawn in &self.drawings {
            let bytes = std::fs::read(results.join(&drawn.place)).map_err(|e| (drawn.place.clone(), e))?;
            files.push((drawn.place.clone(), bytes));
        }
        let folder = Path::new("calibration");
        if let Some(environment) = &self.environment {
            files.push((folder.join("fluoroscopes.json"), environment.encode()));
        }
        for (view, fit) in views.iter().zip(&self.plates) {
            if let Some(fit) = fit {
                let name = folder.join(format!("distortion_{}.csv", view.name));
                files.push((name, crate::results::distortion_csv(&fit.table).into_bytes()));
            }
        }
        let mut made = Vec::new();
        for (place, bytes) in files {
            write_if_changed(&results.join(&place), &bytes).map_err(|e| (place.clone(), e))?;
            made.push((slashes(&place), Picture(bytes).content_hash().to_hex()));
        }
        Ok(made)
    }
}
