//! A study: `pipeline.toml` read, checked, its names resolved and its paths made absolute.
//!
//! Every fault found is reported at its line in one go: unknown, misspelt or missing keys, wrong types, names used
//! twice, a trial that names a fluoroscope or body that is not there, a file that does not exist.

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use biplane_axes::{AxesParams, ModelFrame};
use biplane_contour::{ContourError, ContourParams};
use biplane_distortion::{DistortionError, DistortionParams};
use biplane_environment::EnvironmentParams;
use biplane_label_surface::LabelSurfaceParams;
use biplane_lofting::LoftParams;
use biplane_optimisation::{MatchError, MatchParams, Method, TrackFrameParams, TrackParams};
use biplane_point_model::ModelParams;
use biplane_segmentation::{SegmentError, SegmentParams, TraceError, TraceParams};
use biplane_slices::SlicesParams;
use biplane_spots::{Look, SpotError, SpotSettings};

use crate::config::{
    BeadsSection, BodySection, CutEnds, DoctorSection, FluoroscopeSection, Grid, InOrder, Located, OneOrMore,
    Origin, PairBy, PipelineFile, PlateSection, SlicesSection, StatedUncertainty, TrialSection, Units,
};
use crate::diagnostics::{Problem, Problems, from_toml, meant, slashes};
use biplane_trial::SmoothSettings;

use crate::exports::ExportSection;
use crate::joints::{StudyJoint, section};
use crate::models::LANDMARKS;
use crate::slices::SLICES;

/// The key of `[match]` and `[contour]` that a run sets for each body from its `cut_ends`: nobody writes it, no message offers it.
pub const SET_FOR_EACH_BODY: &str = "ignore_cut_ends";

/// Points of a model from slices, where it is not said.
const POINTS: u32 = 15_000;

/// A checked study.
#[derive(Debug)]
pub struct Study {
    /// The folder of `pipeline.toml`; all relative paths start there.
    pub root: PathBuf,
    /// Name for the report.
    pub name: String,
    /// In the order of the file.
    pub views: Vec<View>,
    /// In the order of the file.
    pub bodies: Vec<Body>,
    /// In the order of the file.
    pub trials: Vec<Trial>,
    /// Bones in volumes, in the order of the file.
    pub slices: Vec<SlicedBone>,
    /// Joints, in the order of the file.
    pub joints: Vec<StudyJoint>,
    /// The plate of the calibration pictures, if there is one.
    pub plate: Option<Plate>,
    /// The frame of beads of the calibration pictures, if there is one.
    pub beads: Option<Beads>,
    /// How holes and beads are found.
    pub spots: SpotSettings,
    /// How distortion is fitted.
    pub distortion: DistortionParams,
    /// How fluoroscopes are found from beads.
    pub environment: EnvironmentParams,
    /// How edges are found.
    pub segment: SegmentParams,
    /// How drawn contours are taken.
    pub edit: TraceParams,
    /// How poses are found.
    pub matching: MatchParams,
    /// How frames help each other.
    pub tracking: TrackParams,
    /// How whole trials are smoothed.
    pub smoothing: SmoothSettings,
    /// How edges are chosen for outlines.
    pub contour: ContourParams,
    /// Limits of `doctor`.
    pub doctor: DoctorSection,
    /// Folder of results.
    pub output: PathBuf,
    /// What is written for other programs.
    pub export: ExportSection,
}

/// One fluoroscope.
#[derive(Debug, Clone)]
pub struct View {
    /// Its name.
    pub name: String,
    /// What says where it stands.
    pub source: ViewSource,
    /// Picture that is black where edges do not count.
    pub mask: Option<PathBuf>,
}

/// What says where a fluoroscope stands. All fluoroscopes of a study are of one kind.
#[derive(Debug, Clone)]
pub enum ViewSource {
    /// Another program's calibration.
    File {
        /// Its calibration file.
        calibration: PathBuf,
        /// Where that file counts pixels from.
        pixel_origin: Origin,
        /// Its distortion table, if its pictures are not corrected.
        distortion: Option<PathBuf>,
        /// How sure it is, if a person says so.
        uncertainty: Option<StatedUncertainty>,
    },
    /// Raw calibration pictures.
    Pictures {
        /// Pictures of the frame of beads, one a placing.
        beads: Vec<PathBuf>,
        /// How its pictures are corrected.
        correction: Correction,
    },
}

/// How recorded pixels become ideal ones, and how large those are.
#[derive(Debug, Clone)]
pub enum Correction {
    /// As the picture of a plate shows.
    Plate(PathBuf),
    /// As a distortion table says; the size of a pixel in mm.
    Table(PathBuf, f64),
    /// Not at all; the size of a pixel in mm.
    None(f64),
}

/// The plate of the calibration pictures.
#[derive(Debug, Clone)]
pub struct Plate {
    /// Its spots.
    pub pattern: PlateSource,
    /// Whether they are bright or dark.
    pub spots: Look,
}

/// Where a plate's spots are said to be.
#[derive(Debug, Clone)]
pub enum PlateSource {
    /// In a file.
    List(PathBuf),
    /// On a grid; its pitch in mm.
    Grid(Grid, f64),
}

/// The frame of beads of the calibration pictures.
#[derive(Debug, Clone)]
pub struct Beads {
    /// Where its beads are.
    pub list: PathBuf,
    /// Unit of that file.
    pub units: Units,
    /// XMALab's file of reference beads.
    pub references: Option<PathBuf>,
    /// Whether they are dark or bright.
    pub spots: Look,
}

/// One bone or implant part.
#[derive(Debug, Clone)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Where its surface comes from.
    pub surface: SurfaceSource,
    /// How its points are spread; `None` where the vertices of its mesh are matched as they are.
    pub model: Option<ModelParams>,
    /// Whether its flat ends, where its volume was cut, are no outline.
    pub ignore_cut_ends: bool,
    /// What it is, for its local coordinate system, if one is wanted.
    pub axes: Option<AxesParams>,
    /// A person's landmarks; those in `edits/` win.
    pub landmarks: Option<PathBuf>,
    /// Another mesh of it to be compared with.
    pub reference: Option<MeshSource>,
}

/// A mesh in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeshSource {
    /// The file.
    pub path: PathBuf,
    /// Unit of that file, if it was said.
    pub units: Option<Units>,
}

/// Where a body's surface comes from.
#[derive(Debug, Clone)]
pub enum SurfaceSource {
    /// A mesh file.
    File(MeshSource),
    /// The contours of a bone of the study.
    Contours(usize, LoftParams),
    /// The labels in which a bone of the study is found.
    Labels(usize, LabelSurfaceParams),
}

impl SurfaceSource {
    /// The mesh file, if it is one.
    pub fn file(&self) -> Option<&MeshSource> {
        match self {
            Self::File(mesh) => Some(mesh),
            Self::Contours(..) | Self::Labels(..) => None,
        }
    }

    /// The bone of the study whose slices it comes from, if it does.
    pub fn bone(&self) -> Option<usize> {
        match self {
            Self::File(_) => None,
            Self::Contours(bone, _) | Self::Labels(bone, _) => Some(*bone),
        }
    }
}

/// A bone in the slices of a volume.
#[derive(Debug, Clone)]
pub struct SlicedBone {
    /// Its name.
    pub name: String,
    /// A file, or a folder of DICOM slices.
    pub volume: PathBuf,
    /// How it is found.
    pub find: SlicesParams,
}

/// One recording.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Its name.
    pub name: String,
    /// Which views it has, and where their pictures are (relative to the study's folder), in the order of the views.
    pub frames: Vec<(usize, String)>,
    /// How they are paired.
    pub pair_by: PairBy,
    /// What is added to the first view's number (or place) to get the second's.
    pub offset: i64,
    /// Pictures per second, if given.
    pub frame_rate_hz: Option<f64>,
    /// Start poses, if given.
    pub starts: Option<PathBuf>,
    /// Which bodies to find, in the order of the study's bodies.
    pub bodies: Vec<usize>,
}

/// Why there is no study.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The file cannot be read.
    #[error(
        "{path}: {source}. Name a pipeline file (`biplane run path/to/pipeline.toml`), or let `biplane init FOLDER` \
         write one for a folder of data"
    )]
    Unreadable {
        /// Which.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// The file says something that cannot be.
    #[error("{0}")]
    Wrong(Problems),
}

impl Study {
    /// Whether a body without a start is looked for.
    pub fn looks_anywhere(&self) -> bool {
        self.matching.anywhere && self.matching.method == Method::Rim
    }

    /// How a body is matched.
    pub fn matching_of(&self, body: usize) -> MatchParams {
        let ignore_cut_ends = self.bodies.get(body).is_some_and(|b| b.ignore_cut_ends);
        MatchParams { ignore_cut_ends, ..self.matching.clone() }
    }

    /// How a body in a frame is tried again.
    pub fn tracking_of(&self, body: usize, others: &[usize]) -> TrackFrameParams {
        let cut = |body: &usize| self.bodies.get(*body).is_some_and(|b| b.ignore_cut_ends);
        TrackFrameParams {
            matching: self.matching_of(body),
            claim_px: self.tracking.claim_px,
            others_without_cut_ends: others.iter().map(cut).collect(),
        }
    }

    /// Whether frames help each other.
    pub fn tracks(&self) -> bool {
        self.tracking.enabled && self.matching.method == Method::Rim
    }

    /// How the contour of a body is chosen.
    pub fn contour_of(&self, body: usize) -> ContourParams {
        let ignore_cut_ends = self.bodies.get(body).is_some_and(|b| b.ignore_cut_ends);
        ContourParams { ignore_cut_ends, ..self.contour.clone() }
    }

    /// Where a person's own work is read from; a run never writes there.
    pub fn edits(&self) -> PathBuf {
        self.root.join("edits")
    }

    /// Where a person's own poses are read from.
    pub fn edited_poses(&self) -> PathBuf {
        self.edits().join("poses.csv")
    }

    /// Where a person's own correspondences of a view's plate or bead pictures are read from (`plate_A.csv`, `beads_A.csv`); a
    /// run never writes there.
    pub fn clicks(&self, what: &str, view: &str) -> PathBuf {
        self.edits().join(format!("{what}_{view}.csv"))
    }

    /// Whether the fluoroscopes are found from raw pictures.
    pub fn calibrates(&self) -> bool {
        self.views.iter().any(|v| matches!(v.source, ViewSource::Pictures { .. }))
    }

    /// Where a person's own landmarks of a body are read from, in the order in which they are looked for; a run never writes there.
    pub fn edited_landmarks(&self, body: &str) -> [PathBuf; 3] {
        ["csv", "fcsv", "mrk.json"]
            .map(|ending| self.edits().join(LANDMARKS).join(format!("{body}.{ending}")))
    }

    /// The folder of the store and of the index of inputs.
    pub fn hidden(&self) -> PathBuf {
        self.root.join(".biplane")
    }

    /// A path as a person wrote it: relative to the study's folder where it lies within, with forward slashes.
    pub fn relative(&self, path: &Path) -> String {
        slashes(path.strip_prefix(&self.root).unwrap_or(path))
    }

    /// A message of a lower layer with the study's own folder left out of its paths: results and reports are the same
    /// wherever the study lies.
    pub fn shorten(&self, message: &str) -> String {
        message.replace(&format!("{}{}", self.root.display(), std::path::MAIN_SEPARATOR), "")
    }

    /// Reads and checks a pipeline file.
    ///
    /// # Errors
    /// The file cannot be read, or has faults; all that can be found at once are in the error.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let unreadable = |source| StudyError::Unreadable { path: slashes(path), source };
        let text = std::fs::read_to_string(path).map_err(unreadable)?;
        let folder = match path.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        };
        let root = std::path::absolute(folder).map_err(unreadable)?;
        let wrong = |list| StudyError::Wrong(Problems { path: path.to_owned(), text: text.clone(), list });
        let file: PipelineFile = toml::from_str(&text).map_err(|e| wrong(vec![from_toml(&e, &text)]))?;
        let mut check = Check { root, list: Vec::new() };
        if let Err(error) = file.segment.check() {
            let key = match &error {
                SegmentError::Parameter { name, .. } => Some(*name),
                SegmentError::NoSeed => Some("method"),
                SegmentError::Region { .. } => Some("region_px"),
                SegmentError::Mask { .. } | SegmentError::NoEdge { .. } => None,
            };
            check.list.push(parameter(&text, "segment", key, &error.to_string()));
        }
        if let Err(error) = file.edit.check() {
            let TraceError::Parameter { name, .. } = &error;
            check.list.push(parameter(&text, "edit", Some(*name), &error.to_string()));
        }
        if let Err(error) = file.contour.check() {
            let ContourError::Parameter { name, .. } = &error;
            check.list.push(parameter(&text, "contour", Some(*name), &error.to_string()));
        }
        if let Err(error) = file.matching.check() {
            let key = match &error {
                MatchError::Parameter { name, .. } => Some(*name),
                MatchError::Optimiser { .. } => Some("search.optimiser"),
                MatchError::TrackParameter { .. }
                | MatchError::Views { .. }
                | MatchError::NoStart
                | MatchError::Cancelled => None,
            };
            check.list.push(parameter(&text, "match", key, &error.to_string()));
        }
        if let Err(error) = file.track.check() {
            let key = if let MatchError::TrackParameter { name, .. } = &error { Some(*name) } else { None };
            check.list.push(parameter(&text, "track", key, &error.to_string()));
        }
        for (table, said) in
            [("match", file.matching.ignore_cut_ends), ("contour", file.contour.ignore_cut_ends)]
        {
            if said {
                let what = "each body says for itself whether its cut ends are outline: [[body]] cut_ends = \"ignore\"";
                check.list.push(parameter(&text, table, Some(SET_FOR_EACH_BODY), what));
            }
        }
        if let Err(error) = file.spots.check() {
            let key = match &error {
                SpotError::Parameter { name, .. } => Some(*name),
                SpotError::Picture { .. } => None,
            };
            check.list.push(parameter(&text, "spots", key, &error.to_string()));
        }
        if let Err(error) = file.distortion.check() {
            let key = match &error {
                DistortionError::Parameter { name, .. } => Some(*name),
                _ => None,
            };
            check.list.push(parameter(&text, "distortion", key, &error.to_string()));
        }
        check.list.extend(crate::slices::section::faults(&file.slices, &text));
        check.list.extend(crate::models::section::faults(&file.body, &file.slices, &text));
        if let Some(view) = file.export.view.as_ref()
            && !file.fluoroscope.0.iter().any(|(name, _)| name.get_ref() == view)
        {
            let names: Vec<&str> =
                file.fluoroscope.0.iter().map(|(name, _)| name.get_ref().as_str()).collect();
            let text_of =
                format!("[export] there is no fluoroscope `{view}`: {}", meant(view, names.iter().copied()));
            check.list.push(parameter(&text, "export", Some("view"), &text_of));
        }
        for (key, value) in [
            ("acceleration_mm_s2", file.smooth.acceleration_mm_s2),
            ("acceleration_deg_s2", file.smooth.acceleration_deg_s2),
        ] {
            if let Some(value) = value.filter(|v| !v.is_finite() || *v <= 0.0) {
                let what = format!("[smooth] {key} = {value}, expected a number above 0, or none to find it");
                check.list.push(parameter(&text, "smooth", Some(key), &what));
            }
        }
        let study = check.study(file);
        if check.list.is_empty() { Ok(study) } else { Err(wrong(check.list)) }
    }
}

/// Collects problems while names and paths are resolved.
struct Check {
    root: PathBuf,
    list: Vec<Problem>,
}

impl Check {
    fn study(&mut self, file: PipelineFile) -> Study {
        let PipelineFile {
            study,
            fluoroscope,
            plate,
            beads,
            spots,
            distortion,
            environment,
            body,
            trial,
            slices,
            joint,
            segment,
            edit,
            matching,
            track,
            contour,
            doctor,
            smooth,
            output,
            export,
        } = file;
        let name = study.name;
        self.names("fluoroscope", fluoroscope.0.iter().map(|(n, _)| n));
        self.names("body", body.iter().map(|b| &b.name));
        self.names("trial", trial.iter().map(|t| &t.name));
        for (what, example, count) in [
            ("fluoroscope", "[fluoroscope.A]", fluoroscope.0.len()),
            ("body", "[[body]]", body.len()),
            ("trial", "[[trial]]", trial.len()),
        ] {
            // A study of models alone has no pictures.
            if count == 0 && (what == "body" || fluoroscope.0.len() + trial.len() > 0) {
                self.list.push(
                    Problem { span: None, ..Problem::at(0..0, format!("there is no {what}")) }
                        .help(format!("add a table `{example}`")),
                );
            }
        }
        let used = |f: &FluoroscopeSection| (f.plate.is_some(), f.beads.is_some());
        let used = fluoroscope.0.iter().map(|(_, f)| used(f));
        let (plates, frames) = used.fold((false, false), |(p, b), (plate, beads)| (p || plate, b || beads));
        let plate = self.plate(plate, plates);
        let beads = self.beads(beads, frames);
        let views = self.views(fluoroscope, plate.is_some(), beads.is_some());
        let bodies: Vec<Body> = body.into_iter().map(|b| self.body(b, &slices)).collect();
        self.names("bone", slices.iter().map(|s| &s.name));
        for (taken, what, used) in [
            (SLICES, "what a person drew in slices", !slices.is_empty()),
            (LANDMARKS, "a person's landmarks of bodies", bodies.iter().any(|b| b.axes.is_some())),
        ] {
            for trial in trial.iter().filter(|t| used && t.name.get_ref() == taken) {
                let text = format!("a trial cannot be called `{taken}` in this study");
                let help = format!("edits/{taken}/ holds {what}: give the trial another name");
                self.list.push(Problem::at(trial.name.span(), text).help(help));
            }
        }
        let trials = trial.into_iter().map(|t| self.trial(t, &views, &bodies)).collect();
        let slices = slices.into_iter().map(|s| self.sliced(s)).collect();
        self.names("joint", joint.iter().map(|j| &j.name));
        for joint in &joint {
            // A joint is an item of a frame beside its bodies.
            if bodies.iter().any(|b| b.name == *joint.name.get_ref()) {
                let text = format!("joint `{}` has the name of a body", joint.name.get_ref());
                self.list.push(Problem::at(joint.name.span(), text).help("give the joint a name of its own"));
            }
        }
        let joints = joint.into_iter().filter_map(|j| section::joint(j, &bodies, &mut self.list)).collect();
        let folder = self.root.join(output.folder.get_ref());
        if [self.root.clone(), self.root.join("edits"), self.root.join(".biplane")].contains(&tidy(&folder)) {
            self.list.push(
                Problem::at(output.folder.span(), "results need a folder of their own")
                    .help("such as folder = \"results\""),
            );
        }
        Study {
            root: self.root.clone(),
            name,
            views,
            bodies,
            trials,
            slices,
            joints,
            plate,
            beads,
            spots,
            distortion,
            environment,
            segment,
            edit,
            matching,
            tracking: track,
            smoothing: smooth,
            contour,
            doctor,
            output: folder,
            export,
        }
    }

    fn plate(&mut self, section: Option<toml::Spanned<PlateSection>>, used: bool) -> Option<Plate> {
        let section = section?;
        let span = section.span();
        if !used {
            let problem = Problem::at(span.clone(), "no fluoroscope has a picture of this plate");
            self.list.push(problem.help("name it: plate = \"calibration/plate_A.png\" in [fluoroscope.A]"));
        }
        let PlateSection { list, pattern, pitch_mm, spots } = section.into_inner();
        let pattern = match (list, pattern, pitch_mm) {
            (Some(list), None, None) => PlateSource::List(self.file(&list, "list of holes")),
            (None, Some(grid), Some(pitch)) => PlateSource::Grid(grid, self.length(&pitch, "a pitch")?),
            _ => {
                let problem = Problem::at(span, "it is not clear where the plate's holes are");
                self.list.push(problem.help(
                    "give either list = \"plate.csv\", or a grid: pattern = \"square\" (or \"hexagonal\") and pitch_mm = 10.0",
                ));
                return None;
            }
        };
        Some(Plate { pattern, spots })
    }

    fn beads(&mut self, section: Option<toml::Spanned<BeadsSection>>, used: bool) -> Option<Beads> {
        let section = section?;
        if !used {
            let problem = Problem::at(section.span(), "no fluoroscope has a picture of these beads");
            self.list.push(problem.help("name it: beads = \"calibration/beads_A.png\" in [fluoroscope.A]"));
        }
        let BeadsSection { list, units, references, spots } = section.into_inner();
        let list = self.file(&list, "list of beads");
        Some(Beads {
            list,
            units,
            references: references.map(|r| self.file(&r, "file of reference beads")),
            spots,
        })
    }

    /// A length in mm above zero.
    fn length(&mut self, value: &toml::Spanned<f64>, what: &str) -> Option<f64> {
        let mm = *value.get_ref();
        if mm.is_finite() && mm > 0.0 {
            return Some(mm);
        }
        self.list.push(Problem::at(value.span(), format!("{what} of {mm} mm cannot be")));
        None
    }

    fn views(&mut self, sections: InOrder<FluoroscopeSection>, plate: bool, beads: bool) -> Vec<View> {
        let mut views = Vec::new();
        // The first view that has bead pictures, and how many.
        let mut placings: Option<(String, usize)> = None;
        let mut kinds = [None, None];
        let mut stated = None;
        for (name, section) in sections.0 {
            let FluoroscopeSection {
                beads: pictures,
                plate: on_plate,
                pixel_mm,
                calibration,
                pixel_origin,
                distortion,
                mask,
                uncertainty,
            } = section;
            let mask = mask.map(|m| self.file(&m, "mask"));
            if let Some(uncertainty) = &uncertainty {
                stated.get_or_insert((name.get_ref().clone(), uncertainty.span()));
            }
            kinds[usize::from(pictures.is_some())].get_or_insert_with(|| name.clone());
            if let Some(plated) = on_plate.as_ref().filter(|_| !plate) {
                let problem = Problem::at(plated.span(), "it is not said what this plate is");
                self.list.push(problem.help("add a table [plate] with `list`, or `pattern` and `pitch_mm`"));
            }
            let source = match (calibration, pictures) {
                (Some(calibration), None) => {
                    if let Some(plate) = &on_plate {
                        self.list.push(
                            Problem::at(plate.span(), "a plate does not go with another program's calibration").help(
                                "what a calibration file says holds for that program's own corrected pixels: give its \
                                 corrected pictures, or a `distortion` table, or calibrate here from pictures of `beads`",
                            ),
                        );
                    }
                    Some(ViewSource::File {
                        calibration: self.file(&calibration, "calibration"),
                        pixel_origin,
                        distortion: distortion.map(|d| self.file(&d, "distortion table")),
                        uncertainty: uncertainty.and_then(|u| self.uncertainty(&u)),
                    })
                }
                (None, Some(OneOrMore(pictures))) => {
                    let first = pictures.first().map_or(name.span(), toml::Spanned::span);
                    if !beads {
                        let problem = Problem::at(first.clone(), "it is not said where these beads are");
                        self.list.push(problem.help("add a table [beads] with `list`"));
                    }
                    let (other, count) =
                        placings.get_or_insert_with(|| (name.get_ref().clone(), pictures.len())).clone();
                    if count != pictures.len() || pictures.is_empty() {
                        let found = pictures.len();
                        self.list.push(
                            Problem::at(first, format!("{found} picture(s) of beads, but fluoroscope {other} has {count}"))
                                .help("each placing of the frame needs a picture of every fluoroscope, in the same order"),
                        );
                    }
                    if let Some(stated) = uncertainty {
                        let problem =
                            Problem::at(stated.span(), "the beads tell how sure this fluoroscope is");
                        self.list.push(problem.help("remove `uncertainty`"));
                    }
                    let beads = pictures.iter().map(|p| self.file(p, "picture of beads")).collect();
                    let correction = self.correction(&name, on_plate, distortion, pixel_mm);
                    correction.map(|correction| ViewSource::Pictures { beads, correction })
                }
                (calibration, _) => {
                    let both = calibration.is_some();
                    let text = if both {
                        "says twice where it stands: `calibration` and `beads`"
                    } else {
                        "does not say where it stands"
                    };
                    self.list.push(
                        Problem::at(name.span(), format!("fluoroscope {} {text}", name.get_ref())).help(
                            "give either beads = \"a picture of the frame of beads\" (and plate = \"a picture of the plate\"), or \
                             calibration = \"a calibration file\"",
                        ),
                    );
                    None
                }
            };
            views.extend(source.map(|source| View { name: name.into_inner(), source, mask }));
        }
        let unsaid = |view: &&View| matches!(view.source, ViewSource::File { uncertainty: None, .. });
        if let (Some((said, span)), Some(other)) = (stated, views.iter().find(unsaid)) {
            let text = format!("it is said how sure {said} is, but not how sure {} is", other.name);
            let problem = Problem::at(span, text);
            self.list.push(problem.help("give `uncertainty` of every fluoroscope, or of none"));
        }
        if let [Some(file), Some(pictures)] = &kinds {
            self.list.push(
                Problem::at(
                    file.span(),
                    format!("{} has no pictures of beads, but {} has", file.get_ref(), pictures.get_ref()),
                )
                .help(
                    "all fluoroscopes are found from one frame of beads, or all come from calibration files",
                ),
            );
        }
        views
    }

    fn uncertainty(&mut self, stated: &toml::Spanned<StatedUncertainty>) -> Option<StatedUncertainty> {
        let StatedUncertainty { source_mm, detector_mm, pixel_mm } = *stated.get_ref();
        let deviation = |mm: f64| mm.is_finite() && mm >= 0.0;
        if deviation(source_mm) && deviation(detector_mm) && pixel_mm.is_finite() && pixel_mm > 0.0 {
            return Some(*stated.get_ref());
        }
        self.list.push(
            Problem::at(stated.span(), "these standard deviations cannot be")
                .help("source_mm and detector_mm are 0 or more, pixel_mm is the side of a pixel on the detector, all mm"),
        );
        None
    }

    fn correction(
        &mut self,
        name: &Located,
        plate: Option<Located>,
        distortion: Option<Located>,
        pixel_mm: Option<toml::Spanned<f64>>,
    ) -> Option<Correction> {
        let pixel = pixel_mm.as_ref().and_then(|p| self.length(p, "a pixel"));
        match (plate, distortion, pixel_mm) {
            (Some(plate), None, None) => Some(Correction::Plate(self.file(&plate, "picture of the plate"))),
            (Some(plate), distortion, _) => {
                let (what, why) = match distortion {
                    Some(_) => ("distortion", "the distortion"),
                    None => ("pixel_mm", "the size of a pixel"),
                };
                self.list.push(
                    Problem::at(plate.span(), format!("the plate shows {why} already"))
                        .help(format!("remove `{what}`, or `plate`")),
                );
                None
            }
            (None, _, None) => {
                self.list.push(
                    Problem::at(name.span(), format!("the size of a pixel of {} is not known", name.get_ref())).help(
                        "give plate = \"a picture of the plate\", or for corrected pictures pixel_mm, the side of a pixel on the \
                         detector in mm",
                    ),
                );
                None
            }
            (None, Some(table), Some(_)) => {
                Some(Correction::Table(self.file(&table, "distortion table"), pixel?))
            }
            (None, None, Some(_)) => Some(Correction::None(pixel?)),
        }
    }

    fn trial(&mut self, trial: TrialSection, views: &[View], bodies: &[Body]) -> Trial {
        let TrialSection { name, frames, pair_by, offset, frame_rate_hz, starts, bodies: wanted } = trial;
        let view_names: Vec<&str> = views.iter().map(|v| v.name.as_str()).collect();
        let mut found = Vec::new();
        let InOrder(frames) = frames;
        if frames.is_empty() {
            self.list
                .push(Problem::at(name.span(), format!("trial `{}` has no frames", name.get_ref())).help(
                "say where each fluoroscope's pictures are: frames = { A = \"frames/A\", B = \"frames/B\" }",
            ));
        }
        for (view, place) in frames {
            match view_names.iter().position(|n| *n == view.get_ref()) {
                Some(index) => {
                    self.pictures(&place);
                    found.push((index, place.into_inner()));
                }
                None => self.list.push(
                    Problem::at(view.span(), format!("there is no fluoroscope `{}`", view.get_ref()))
                        .label(meant(view.get_ref(), view_names.iter().copied()))
                        .help(format!(
                            "each name in `frames` needs a table [fluoroscope.{}]",
                            view.get_ref()
                        )),
                ),
            }
        }
        found.sort_by_key(|(view, _)| *view);
        let body_names: Vec<&str> = bodies.iter().map(|b| b.name.as_str()).collect();
        let mut chosen: Vec<usize> = (0..bodies.len()).collect();
        if let Some(wanted) = wanted {
            chosen.clear();
            for body in wanted {
                match body_names.iter().position(|n| *n == body.get_ref()) {
                    Some(index) if chosen.contains(&index) => self
                        .list
                        .push(Problem::at(body.span(), format!("body `{}` is named twice", body.get_ref()))),
                    Some(index) => chosen.push(index),
                    None => self.list.push(
                        Problem::at(body.span(), format!("there is no body `{}`", body.get_ref()))
                            .label(meant(body.get_ref(), body_names.iter().copied()))
                            .help("`bodies` takes names of [[body]] tables"),
                    ),
                }
            }
            chosen.sort_unstable();
        }
        let rate = frame_rate_hz.and_then(|rate| {
            let hz = *rate.get_ref();
            if hz.is_finite() && hz > 0.0 {
                return Some(hz);
            }
            let problem = Problem::at(rate.span(), format!("a frame rate of {hz} Hz cannot be"));
            self.list.push(problem.help("give pictures per second, such as frame_rate_hz = 100.0"));
            None
        });
        Trial {
            starts: starts.map(|s| self.file(&s, "table of start poses")),
            name: name.into_inner(),
            frames: found,
            pair_by,
            offset,
            frame_rate_hz: rate,
            bodies: chosen,
        }
    }

    fn body(&mut self, section: BodySection, bones: &[SlicesSection]) -> Body {
        let BodySection {
            name,
            mesh,
            units,
            slices,
            loft,
            label_surface,
            model,
            cut_ends,
            axes,
            landmarks,
            reference,
            reference_units,
        } = section;
        let surface = match (mesh, slices) {
            (Some(mesh), None) => {
                let spans =
                    [loft.as_ref().map(toml::Spanned::span), label_surface.as_ref().map(toml::Spanned::span)];
                for span in spans.into_iter().flatten() {
                    let problem =
                        Problem::at(span, "this is for bodies from slices, and this one has a mesh");
                    self.list.push(problem.help("remove it, or give `slices` instead of `mesh`"));
                }
                SurfaceSource::File(MeshSource { path: self.file(&mesh, "mesh"), units })
            }
            (None, Some(slices)) => self.surface_from_slices(&name, &slices, loft, label_surface, bones),
            (mesh, _) => {
                let text = if mesh.is_some() {
                    "says twice where its surface comes from: `mesh` and `slices`"
                } else {
                    "does not say where its surface comes from"
                };
                self.list.push(Problem::at(name.span(), format!("body {} {text}", name.get_ref())).help(
                    "give either mesh = \"a mesh file\", or slices = \"the name of a [[slices]] table\"",
                ));
                SurfaceSource::File(MeshSource { path: PathBuf::new(), units })
            }
        };
        let wanted = axes.is_some();
        if let Some(landmarks) = landmarks.as_ref().filter(|_| !wanted) {
            self.list.push(
                Problem::at(landmarks.span(), "landmarks are for a body's axes, and it is not said what this body is")
                    .help("add axes = { body = \"femur\", side = \"left\" } (or tibia, patella, femoral_component, ...)"),
            );
        }
        let model = model.map(toml::Spanned::into_inner);
        let axes = axes.map(|axes| {
            let mut axes = axes.into_inner();
            // A surface from slices is in the scanner's frame.
            if surface.bone().is_some() && axes.frame == ModelFrame::Auto {
                axes.frame = ModelFrame::Lps;
            }
            axes
        });
        Body {
            // A surface from slices has more points than a match needs; so many as the thesis settles on do.
            model: model
                .or_else(|| surface.bone().map(|_| ModelParams { points: POINTS, ..ModelParams::default() })),
            name: name.into_inner(),
            ignore_cut_ends: match cut_ends {
                Some(said) => said == CutEnds::Ignore,
                None => surface.bone().is_some(),
            },
            surface,
            axes,
            landmarks: landmarks.map(|l| self.file(&l, "file of landmarks")),
            reference: reference
                .map(|r| MeshSource { path: self.file(&r, "reference mesh"), units: reference_units }),
        }
    }

    /// The surface of a body from the bone called `slices`.
    fn surface_from_slices(
        &mut self,
        name: &Located,
        slices: &Located,
        loft: Option<toml::Spanned<LoftParams>>,
        labels: Option<toml::Spanned<LabelSurfaceParams>>,
        bones: &[SlicesSection],
    ) -> SurfaceSource {
        let names = || bones.iter().map(|b| b.name.get_ref().as_str());
        let Some(bone) = names().position(|n| n == slices.get_ref()) else {
            self.list.push(
                Problem::at(slices.span(), format!("there is no [[slices]] called `{}`", slices.get_ref()))
                    .label(meant(slices.get_ref(), names()))
                    .help("`slices` takes the name of a [[slices]] table"),
            );
            return SurfaceSource::Contours(0, LoftParams::default());
        };
        match (loft, labels) {
            (loft, None) => {
                SurfaceSource::Contours(bone, loft.map(toml::Spanned::into_inner).unwrap_or_default())
            }
            (Some(loft), Some(_)) => {
                let text = format!("body {} says twice how its surface is made", name.get_ref());
                let problem = Problem::at(loft.span(), text);
                self.list.push(
                    problem.help("give either `loft` (from contours) or `label_surface` (from labels)"),
                );
                SurfaceSource::Contours(bone, LoftParams::default())
            }
            (None, Some(labels)) => {
                let label = bones[bone].find.get_ref().label;
                let span = labels.span();
                let mut params = labels.into_inner();
                if params.label == 0 {
                    params.label = label;
                }
                if label == 0 || params.label != label {
                    let problem = Problem::at(span, "the bone is not found by this label");
                    self.list.push(problem.help(
                        "a label surface needs [[slices]] with find = { label = N }, and the same label if it is given again",
                    ));
                }
                SurfaceSource::Labels(bone, params)
            }
        }
    }

    fn sliced(&mut self, section: SlicesSection) -> SlicedBone {
        let SlicesSection { name, volume, find } = section;
        let path = self.root.join(volume.get_ref());
        if !path.exists() {
            let problem = Problem::at(volume.span(), "the volume is not there");
            self.list.push(self.similar(problem, &path));
        }
        SlicedBone { name: name.into_inner(), volume: path, find: find.into_inner() }
    }

    /// Names go into paths and column names: letters, digits, `-`, `_` and `.`, and each one once.
    fn names<'a>(&mut self, what: &str, names: impl Iterator<Item = &'a Located>) {
        let mut seen: HashMap<String, Range<usize>> = HashMap::new();
        for name in names {
            let text = name.get_ref();
            let fits = text.chars().all(|c| c.is_alphanumeric() || "-_.".contains(c));
            if text.is_empty() || !fits || text.starts_with('.') {
                self.list.push(
                    Problem::at(name.span(), format!("`{text}` cannot be the name of a {what}"))
                        .help("names become folders and columns: use letters, digits, `-`, `_` and `.`"),
                );
            } else if seen.insert(text.to_lowercase(), name.span()).is_some() {
                self.list.push(
                    Problem::at(name.span(), format!("the name `{text}` is used for a {what} before"))
                        .label("second use")
                        .help("give each one its own name (capital letters do not tell names apart)"),
                );
            }
        }
    }

    /// The absolute path of a file that must be there.
    fn file(&mut self, place: &Located, what: &str) -> PathBuf {
        let path = self.root.join(place.get_ref());
        if !path.is_file() {
            let is_folder = path.is_dir();
            let mut problem = Problem::at(
                place.span(),
                if is_folder {
                    format!("the {what} is a folder, not a file")
                } else {
                    format!("the {what} is not there")
                },
            );
            if !is_folder {
                problem.label = format!("no such file in {}", self.shown(&path));
            }
            self.list.push(self.similar(problem, &path));
        }
        path
    }

    /// A folder, a file, or a pattern that matches something.
    fn pictures(&mut self, place: &Located) {
        let path = self.root.join(place.get_ref());
        if path.exists() {
            return;
        }
        let pattern = place.get_ref().contains(['*', '?', '[']);
        let matches =
            pattern && glob::glob(&path.to_string_lossy()).is_ok_and(|mut paths| paths.next().is_some());
        if !matches {
            let title = if pattern { "no file matches this pattern" } else { "the frames are not there" };
            let problem = Problem::at(place.span(), title).help(
                "frames are a folder of pictures, a pattern such as \"frames/A/*.tif\", or one file with many pictures",
            );
            self.list.push(if pattern { problem } else { self.similar(problem, &path) });
        }
    }

    /// Adds what lies nearby under a similar name.
    fn similar(&self, problem: Problem, path: &Path) -> Problem {
        let folder = path.parent().unwrap_or(&self.root);
        let Ok(entries) = std::fs::read_dir(folder) else {
            return problem.help(format!(
                "the folder {} is not there either; paths are relative to the pipeline file",
                self.shown(path)
            ));
        };
        let mut names: Vec<String> =
            entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        let wanted = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        match crate::diagnostics::nearest(&wanted, names.iter().map(String::as_str)) {
            Some(name) if *name != wanted => {
                problem.help(format!("did you mean `{name}`? It lies in the same folder"))
            }
            _ => problem.help("paths are relative to the folder of the pipeline file"),
        }
    }

    /// The folder of a path, as a person would write it.
    fn shown(&self, path: &Path) -> String {
        let folder = path.parent().unwrap_or(path);
        let text = slashes(folder.strip_prefix(&self.root).unwrap_or(folder));
        if text.is_empty() { "the folder of the pipeline file".to_owned() } else { format!("`{text}`") }
    }
}

/// A parameter out of range, at its value.
fn parameter(text: &str, table: &str, key: Option<&str>, message: &str) -> Problem {
    let span = || {
        let tables = toml::de::DeTable::parse(text).ok()?;
        let (mut place, mut at) = (None, tables.get_ref());
        // A key of a table within the table has its name and a dot before it.
        for name in std::iter::once(table).chain(key?.split('.')) {
            let inner = at.get(name)?;
            place = Some(inner.span());
            match inner.get_ref().as_table() {
                Some(table) => at = table,
                None => break,
            }
        }
        place
    };
    Problem { span: span(), ..Problem::at(0..0, message) }
}

/// Without `.` and trailing slashes.
fn tidy(path: &Path) -> PathBuf {
    path.components().collect()
}
