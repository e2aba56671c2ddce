//! From a study to a list of jobs: calibrations read, frames listed and paired, starts found. No picture is decoded.
//!
//! What is wrong with an input that everything hangs on (a calibration, a mesh, a table of starts, frames that do not
//! pair) ends the run before it starts, with all such faults at once. What is wrong with one picture is found when its
//! turn comes, and stops only what needs it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use biplane_acquisition::beads::{read_bead_clicks, read_bead_list, read_xmalab_references};
use biplane_acquisition::calibration::{CalibrationError, read_calibration, read_distortion_csv};
use biplane_acquisition::frames::{FrameSource, PairBy, list_frames, pair};
use biplane_acquisition::images::{ImageError, ImageFile, read_frame};
use biplane_acquisition::plates::{read_plate_clicks, read_plate_list};
use biplane_artifact::{
    BeadClicks, BeadList, Calibration, DistortionTable, Frame, PixelOrigin, PlateClicks, PlatePattern, Start,
};
use biplane_geometry::Point3;
use biplane_optimisation::Method;
use biplane_spots::{Look, SpotParams};
use biplane_stage::{Hashed, ParamsText};

use crate::config;
use crate::edits;
use crate::models::landmarks::{GivenLandmarks, given};
use crate::models::{self, MeshOfFile};
use crate::outcome::StartKind;
use crate::slices;
use crate::sources::InputIndex;
use crate::starts::{starts_of, unused_edits, unused_starts};
use crate::study::{Correction, MeshSource, PlateSource, Study, Trial, View, ViewSource};
use crate::tables::PoseTable;

/// Files with many pictures that are kept open at a time.
const OPEN_FILES: usize = 8;

/// What is wrong with the inputs, one message each.
#[derive(Debug, thiserror::Error)]
#[error("{}", .0.join("\n"))]
pub struct InputErrors(pub Vec<String>);

/// Pictures taken together, and what is to be found in them.
#[derive(Debug)]
pub struct Job {
    /// Index of the trial.
    pub trial: usize,
    /// The frame's label.
    pub label: String,
    /// Seconds from the trial's first picture, if known.
    pub time_s: Option<f64>,
    /// One picture a view of the trial.
    pub pictures: Vec<FrameSource>,
    /// Index of each body, where its start came from, and the start, if there is one.
    pub bodies: Vec<(usize, StartKind, Option<Hashed<Start>>)>,
    /// Files of what a person drew in each picture; more than one is a fault.
    pub edits: Vec<Vec<PathBuf>>,
}

/// A study ready to be run or looked at.
#[derive(Debug)]
pub struct Prepared {
    /// The study.
    pub study: Study,
    /// What is known of the input files.
    pub index: InputIndex,
    /// Where the fluoroscopes stand, or what that is found from.
    pub equipment: Equipment,
    /// The mesh file of each body of the study; none of one that comes from slices.
    pub meshes: Vec<Option<Arc<MeshOfFile>>>,
    /// The mesh that each body is compared with, if any.
    pub references: Vec<Option<Arc<MeshOfFile>>>,
    /// A person's landmarks of each body, if any.
    pub landmarks: Vec<Option<GivenLandmarks>>,
    /// What hides edges in each view.
    pub masks: Vec<Vec<Hashed<Frame>>>,
    /// In the order of trials and frames.
    pub jobs: Vec<Job>,
    /// Files of what a person drew in slices, with the number of the slice, one list a bone of the study.
    pub slice_edits: Vec<Vec<(usize, PathBuf)>>,
    /// Files in `edits/` that are of no picture, and why.
    pub stray_edits: Vec<(PathBuf, String)>,
    /// Worth a look.
    pub warnings: Vec<String>,
    /// Parameters of the step `segment`.
    pub segment: ParamsText,
    /// Parameters of the step `edit`.
    pub edit: ParamsText,
    /// Parameters of the step `match`, one a body of the study.
    pub matching: Vec<ParamsText>,
    /// Parameters of the step `contour`, one a body of the study.
    pub contour: Vec<ParamsText>,
    pictures: Pictures,
}

/// Where the fluoroscopes stand, or what that is found from.
#[derive(Debug)]
pub enum Equipment {
    /// Read from files: one a view of the study.
    Known(Vec<Hashed<Calibration>>),
    /// To be found from raw pictures.
    Pictures(Box<CalibrationInputs>),
}

impl Equipment {
    /// What is known without running anything.
    pub fn known(&self) -> &[Hashed<Calibration>] {
        match self {
            Self::Known(calibrations) => calibrations,
            Self::Pictures(_) => &[],
        }
    }

    /// What it is to be found from.
    pub fn inputs(&self) -> Option<&CalibrationInputs> {
        match self {
            Self::Known(_) => None,
            Self::Pictures(inputs) => Some(inputs),
        }
    }
}

/// All that finding the fluoroscopes needs beside the pictures.
#[derive(Debug)]
pub struct CalibrationInputs {
    /// The plate, if there is one.
    pub pattern: Option<Hashed<PlatePattern>>,
    /// A person's correspondences on the plate, one a view.
    pub plate_clicks: Vec<Option<Hashed<PlateClicks>>>,
    /// Distortion tables from files, one a view.
    pub tables: Vec<Option<DistortionTable>>,
    /// The frame of beads.
    pub beads: Hashed<BeadList>,
    /// A person's clicks on beads, of all views together.
    pub bead_clicks: Option<Hashed<BeadClicks>>,
    /// How many pictures of the beads each view has.
    pub placings: usize,
    /// Parameters of `spots` on a plate.
    pub plate_spots: ParamsText,
    /// Parameters of `spots` on beads.
    pub bead_spots: ParamsText,
    /// Parameters of `distortion`.
    pub distortion: ParamsText,
    /// Parameters of `environment`.
    pub environment: ParamsText,
}

/// Reads pictures; files that hold many are opened once, not once a picture.
#[derive(Debug, Default)]
struct Pictures {
    many: BTreeSet<PathBuf>,
    open: Mutex<BTreeMap<PathBuf, Arc<Mutex<Option<ImageFile>>>>>,
}

impl Pictures {
    fn read(&self, path: &Path, index: usize) -> Result<Frame, ImageError> {
        if !self.many.contains(path) {
            return read_frame(path, index);
        }
        let slot = {
            let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
            if open.len() >= OPEN_FILES && !open.contains_key(path) {
                open.pop_first();
            }
            Arc::clone(open.entry(path.to_owned()).or_default())
        };
        let mut file = slot.lock().unwrap_or_else(PoisonError::into_inner);
        match file.as_mut() {
            Some(file) => file.frame(index),
            None => file.insert(ImageFile::open(path)?).frame(index),
        }
    }
}

impl Prepared {
    /// Reads what is small, lists what is large.
    ///
    /// # Errors
    /// All faults of inputs that everything hangs on.
    pub fn of(study: Study) -> Result<Self, InputErrors> {
        let index = InputIndex::open(&study.root, &study.hidden());
        let mut faults = Faults { study: &study, list: Vec::new() };
        let mut warnings = Vec::new();
        let equipment = if study.calibrates() {
            calibration_inputs(&study, &mut faults).map(|inputs| Equipment::Pictures(Box::new(inputs)))
        } else {
            let calibrations = study.views.iter().filter_map(|v| faults.keep(calibration(v)).flatten());
            Some(Equipment::Known(calibrations.map(Hashed::new).collect()))
        };
        let masks: Vec<Vec<Hashed<Frame>>> = study
            .views
            .iter()
            .map(|v| {
                let mask = v.mask.as_deref().and_then(|path| faults.keep(read_frame(path, 0)));
                mask.into_iter().map(Hashed::new).collect()
            })
            .collect();
        let of_file = |source: Option<&MeshSource>, faults: &mut Faults<'_>| {
            let mesh = source.map(|source| faults.keep(MeshOfFile::of(source, &index)).map(Arc::new));
            mesh.map_or(Some(None), |read| read.map(Some))
        };
        let mut meshes = Vec::new();
        let mut references = Vec::new();
        let mut landmarks = Vec::new();
        for body in &study.bodies {
            meshes.extend(of_file(body.surface.file(), &mut faults));
            references.extend(of_file(body.reference.as_ref(), &mut faults));
            landmarks.extend(faults.keep(given(&study, body)));
            let read = meshes.last().into_iter().chain(references.last()).flatten();
            warnings.extend(read.flat_map(|mesh: &Arc<MeshOfFile>| {
                let file = study.relative(mesh.path());
                mesh.facts.notes.iter().map(move |note| format!("body {} ({file}): {note}", body.name))
            }));
        }
        let edits = study.edited_poses();
        let has_edits = edits.is_file();
        let edits = if has_edits { faults.keep(PoseTable::read(&edits)) } else { None };
        let mut tables: BTreeMap<&Path, PoseTable> = BTreeMap::new();
        for path in study.trials.iter().filter_map(|t| t.starts.as_deref()) {
            if !tables.contains_key(path) {
                tables.extend(faults.keep(PoseTable::read(path)).map(|table| (path, table)));
            }
        }
        let trial_names: Vec<&str> = study.trials.iter().map(|t| t.name.as_str()).collect();
        let body_names: Vec<&str> = study.bodies.iter().map(|b| b.name.as_str()).collect();
        for table in tables.values().chain(&edits) {
            warnings.extend(faults.keep(table.strangers(&trial_names, &body_names)).into_iter().flatten());
        }
        let mut jobs = Vec::new();
        let mut pictures = Pictures::default();
        for (number, trial) in study.trials.iter().enumerate() {
            let Some(pairs) = frames(trial, &study, &mut faults, &mut warnings) else { continue };
            for source in pairs.iter().flat_map(|(_, _, sources)| sources).filter(|s| s.index_in_file > 0) {
                pictures.many.insert(source.path.clone());
            }
            let labels: Vec<&str> = pairs.iter().map(|(label, _, _)| label.as_str()).collect();
            if let Some(edits) = &edits {
                warnings.extend(unused_edits(edits, &trial.name, &labels, study.trials.len() == 1));
            }
            let table = trial.starts.as_deref().and_then(|path| tables.get(path));
            warnings
                .extend(table.and_then(|t| unused_starts(t, &trial.name, &labels, study.trials.len() == 1)));
            // A fault before this one leaves indices that do not fit, or starts that seem to be missing; it is reported,
            // and this trial is not looked at.
            let unread = (trial.starts.is_some() && table.is_none()) || (has_edits && edits.is_none());
            if unread || [meshes.len(), references.len(), landmarks.len()] != [study.bodies.len(); 3] {
                continue;
            }
            let mut starts = Vec::new();
            for &body in &trial.bodies {
                let centroid = centre(&study, body, meshes[body].as_deref());
                let name = &study.bodies[body].name;
                let found = match starts_of(&trial.name, name, &labels, edits.as_ref(), table, centroid) {
                    Ok(found) => found,
                    Err(none) if study.looks_anywhere() => {
                        // An empty table is a form that nobody filled in.
                        let given = table.filter(|table| !table.rows.is_empty());
                        warnings
                            .extend(given.map(|_| format!("{none}. Until then it is looked for anywhere")));
                        vec![(StartKind::Anywhere, None); labels.len()]
                    }
                    Err(none) => {
                        let other = match study.matching.method {
                            Method::Bingham2006 => "; `method = \"bingham2006\"` needs one",
                            Method::Search => "; `method = \"search\"` needs one",
                            Method::Rim => ", or let the body be looked for: [match] anywhere = true",
                        };
                        faults.list.push(study.shorten(&format!("{none}{other}")));
                        continue;
                    }
                };
                let between = found.iter().filter(|(kind, _)| *kind == StartKind::Interpolated).count();
                if between > 0 {
                    let all = found.len();
                    warnings.push(format!(
                        "trial {}, body {name}: {between} of {all} frames have no start of their own; they start between the \
                         poses given for others",
                        trial.name
                    ));
                }
                starts.push((body, found));
            }
            for (place, (label, time_s, sources)) in pairs.into_iter().enumerate() {
                let bodies = starts.iter().filter_map(|(body, found)| {
                    let (kind, pose) = found.get(place)?;
                    Some((*body, kind.clone(), pose.map(|pose| Hashed::new(Start(pose)))))
                });
                let edits = vec![Vec::new(); sources.len()];
                jobs.push(Job {
                    trial: number,
                    label,
                    time_s,
                    bodies: bodies.collect(),
                    pictures: sources,
                    edits,
                });
            }
        }
        let mut stray_edits = edits::find(&study, &mut jobs);
        let (slice_edits, strays) = slices::drawn::find(&study);
        stray_edits.extend(strays);
        stray_edits.extend(models::landmarks::strays(&study));
        warnings.extend(
            stray_edits.iter().map(|(path, why)| format!("{} is not used: {why}", study.relative(path))),
        );
        let segment = faults.keep(ParamsText::of(&study.segment));
        let edit = faults.keep(ParamsText::of(&study.edit));
        let bodies = || 0..study.bodies.len();
        let matching =
            bodies().map(|body| ParamsText::of(&study.matching_of(body))).collect::<Result<_, _>>();
        let contour = bodies().map(|body| ParamsText::of(&study.contour_of(body))).collect::<Result<_, _>>();
        let (matching, contour) = (faults.keep(matching), faults.keep(contour));
        let warnings: Vec<String> = warnings.iter().map(|w| study.shorten(w)).collect();
        let parameters = segment.zip(edit).zip(matching).zip(contour);
        match (equipment, parameters, faults.list) {
            (Some(equipment), Some((((segment, edit), matching), contour)), list) if list.is_empty() => {
                Ok(Self {
                    study,
                    index,
                    equipment,
                    meshes,
                    references,
                    landmarks,
                    masks,
                    jobs,
                    slice_edits,
                    stray_edits,
                    warnings,
                    segment,
                    edit,
                    matching,
                    contour,
                    pictures,
                })
            }
            (.., mut list) => {
                // What is odd may be the reason of what is wrong: a misspelt name, say.
                for warning in &warnings {
                    tracing::warn!("{warning}");
                }
                // One file may be read for several views.
                let mut seen = BTreeSet::new();
                list.retain(|message| seen.insert(message.clone()));
                Err(InputErrors(list))
            }
        }
    }

    /// Decodes one picture.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn read(&self, source: &FrameSource) -> Result<Frame, ImageError> {
        self.pictures.read(&source.path, source.index_in_file)
    }
}

/// Collects messages.
struct Faults<'a> {
    study: &'a Study,
    list: Vec<String>,
}

impl Faults<'_> {
    fn keep<T, E: std::fmt::Display>(&mut self, result: Result<T, E>) -> Option<T> {
        result.map_err(|e| self.list.push(self.study.shorten(&e.to_string()))).ok()
    }
}

/// `None` where raw pictures say where a view stands.
fn calibration(view: &View) -> Result<Option<Calibration>, CalibrationError> {
    let ViewSource::File { calibration, pixel_origin, distortion, .. } = &view.source else {
        return Ok(None);
    };
    let origin = match pixel_origin {
        config::Origin::Centre => PixelOrigin::Centre,
        config::Origin::Corner => PixelOrigin::Corner,
    };
    let mut calibration = read_calibration(calibration, &view.name, origin)?;
    if let Some(path) = distortion {
        calibration.distortion = Some(read_distortion_csv(path)?);
    }
    Ok(Some(calibration))
}

fn calibration_inputs(study: &Study, faults: &mut Faults<'_>) -> Option<CalibrationInputs> {
    let pattern = match &study.plate {
        None => None,
        Some(plate) => Some(match &plate.pattern {
            PlateSource::List(path) => faults.keep(read_plate_list(path))?,
            PlateSource::Grid(config::Grid::Square, pitch_mm) => PlatePattern::Square { pitch_mm: *pitch_mm },
            PlateSource::Grid(config::Grid::Hexagonal, pitch_mm) => {
                PlatePattern::Hexagonal { pitch_mm: *pitch_mm }
            }
        }),
    };
    let frame = study.beads.as_ref()?;
    let mut read = faults.keep(read_bead_list(&frame.list, models::unit(frame.units)))?;
    for note in &read.notes {
        tracing::info!("{}: {note}", study.relative(&frame.list));
    }
    if let Some(references) = &frame.references {
        faults.keep(read_xmalab_references(references, &mut read.list))?;
    }
    let beads = read.list;
    let (mut plate_clicks, mut tables) = (Vec::new(), Vec::new());
    let (mut clicks, mut placings) = (BeadClicks::default(), 0);
    for (number, view) in study.views.iter().enumerate() {
        let ViewSource::Pictures { beads: pictures, correction } = &view.source else { continue };
        placings = pictures.len();
        let own = study.clicks("plate", &view.name);
        let given = pattern.as_ref().filter(|_| own.is_file());
        let given = given.and_then(|pattern| faults.keep(read_plate_clicks(&own, pattern)));
        plate_clicks.push(given.map(Hashed::new));
        tables.push(match correction {
            Correction::Table(path, _) => faults.keep(read_distortion_csv(path)),
            Correction::Plate(_) | Correction::None(_) => None,
        });
        let own = study.clicks("beads", &view.name);
        if own.is_file() {
            clicks
                .0
                .extend(faults.keep(read_bead_clicks(&own, number, &beads)).into_iter().flat_map(|c| c.0));
        }
    }
    let spots = |look| ParamsText::of(&SpotParams { look, settings: study.spots.clone() });
    let on_plate = study.plate.as_ref().map_or(Look::Bright, |p| p.spots);
    Some(CalibrationInputs {
        pattern: pattern.map(Hashed::new),
        plate_clicks,
        tables,
        beads: Hashed::new(beads),
        bead_clicks: (!clicks.0.is_empty()).then(|| Hashed::new(clicks)),
        placings,
        plate_spots: faults.keep(spots(on_plate))?,
        bead_spots: faults.keep(spots(frame.spots))?,
        distortion: faults.keep(ParamsText::of(&study.distortion))?,
        environment: faults.keep(ParamsText::of(&study.environment))?,
    })
}

/// The point between whose places a start is interpolated, model coordinates: near the middle of the body. What is made from slices is not
/// there yet, but its seed is known.
fn centre(study: &Study, body: usize, mesh: Option<&MeshOfFile>) -> Point3 {
    let seed = || study.slices.get(study.bodies[body].surface.bone()?)?.find.seed_mm;
    let file = mesh.map(|mesh| mesh.facts.centroid);
    Point3::from(file.or_else(seed).unwrap_or_default())
}

type Pair = (String, Option<f64>, Vec<FrameSource>);

/// Label, time and pictures of each frame of a trial.
fn frames(
    trial: &Trial,
    study: &Study,
    faults: &mut Faults<'_>,
    warnings: &mut Vec<String>,
) -> Option<Vec<Pair>> {
    let mut views = Vec::new();
    for (view, place) in &trial.frames {
        let named = |e: biplane_acquisition::frames::FramesError| format!("trial {}: {e}", trial.name);
        let list = faults.keep(list_frames(&study.root, place).map_err(named));
        views.extend(list.map(|list| (study.views[*view].name.clone(), list)));
    }
    if views.len() != trial.frames.len() {
        return None;
    }
    let by = match trial.pair_by {
        config::PairBy::Number => PairBy::Number,
        config::PairBy::Index => PairBy::Index,
    };
    let paired = pair(&views, by, trial.offset).map_err(|e| format!("trial {}: {e}", trial.name));
    let paired = faults.keep(paired)?;
    warnings.extend(paired.unpaired.iter().map(|u| format!("trial {}: {u}", trial.name)));
    let first = paired.pairs.first().and_then(|p| p.sources.first()).and_then(|s| s.number);
    let time = |place: usize, source: Option<&FrameSource>| match (trial.frame_rate_hz, by, source) {
        (Some(hz), PairBy::Number, Some(s)) => {
            s.number.zip(first).map(|(number, first)| number.abs_diff(first) as f64 / hz)
        }
        (Some(hz), _, _) => Some(place as f64 / hz),
        (None, _, source) => source.and_then(|s| s.time_s),
    };
    let pairs = paired.pairs.into_iter().enumerate();
    Some(pairs.map(|(place, p)| (p.label, time(place, p.sources.first()), p.sources)).collect())
}
