//! A study: `pipeline.toml` read, checked, its names resolved and its paths made absolute.
//!
//! Every fault found is reported at its line in one go: unknown, misspelt or missing keys, wrong types, names used
//! twice, a trial that names a fluoroscope or body that is not there, a file that does not exist.

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use biplane_optimisation::{MatchError, MatchParams};
use biplane_segmentation::{SegmentError, SegmentParams};

use crate::config::{InOrder, Located, Origin, PairBy, PipelineFile, TrialSection, Units};
use crate::diagnostics::{Problem, Problems, from_toml, meant, slashes};

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
    /// How edges are found.
    pub segment: SegmentParams,
    /// How poses are found.
    pub matching: MatchParams,
    /// Folder of results.
    pub output: PathBuf,
}

/// One fluoroscope.
#[derive(Debug, Clone)]
pub struct View {
    /// Its name.
    pub name: String,
    /// Its calibration file.
    pub calibration: PathBuf,
    /// Where that file counts pixels from.
    pub pixel_origin: Origin,
    /// Its distortion table, if its pictures are not corrected.
    pub distortion: Option<PathBuf>,
}

/// One bone or implant part.
#[derive(Debug, Clone)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Its surface.
    pub mesh: PathBuf,
    /// Unit of that file.
    pub units: Units,
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
    /// Where a person's own poses are read from; a run never writes there.
    pub fn edits(&self) -> PathBuf {
        self.root.join("edits").join("poses.csv")
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
                SegmentError::NoEdge { .. } => None,
            };
            check.list.push(parameter(&text, "segment", key, &error.to_string()));
        }
        if let Err(error) = file.matching.check() {
            let key = match &error {
                MatchError::Parameter { name, .. } => Some(*name),
                MatchError::Views { .. } | MatchError::Cancelled => None,
            };
            check.list.push(parameter(&text, "match", key, &error.to_string()));
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
        let PipelineFile { study, fluoroscope, body, trial, segment, matching, output } = file;
        let name = study.name;
        self.names("fluoroscope", fluoroscope.0.iter().map(|(n, _)| n));
        self.names("body", body.iter().map(|b| &b.name));
        self.names("trial", trial.iter().map(|t| &t.name));
        for (what, example, count) in [
            ("fluoroscope", "[fluoroscope.A]", fluoroscope.0.len()),
            ("body", "[[body]]", body.len()),
            ("trial", "[[trial]]", trial.len()),
        ] {
            if count == 0 {
                self.list.push(
                    Problem { span: None, ..Problem::at(0..0, format!("there is no {what}")) }
                        .help(format!("add a table `{example}`")),
                );
            }
        }
        let views: Vec<View> = fluoroscope
            .0
            .into_iter()
            .map(|(name, f)| View {
                name: name.into_inner(),
                calibration: self.file(&f.calibration, "calibration"),
                pixel_origin: f.pixel_origin,
                distortion: f.distortion.map(|d| self.file(&d, "distortion table")),
            })
            .collect();
        let bodies: Vec<Body> = body
            .into_iter()
            .map(|b| Body { mesh: self.file(&b.mesh, "mesh"), name: b.name.into_inner(), units: b.units })
            .collect();
        let trials = trial.into_iter().map(|t| self.trial(t, &views, &bodies)).collect();
        let folder = self.root.join(output.folder.get_ref());
        if [self.root.clone(), self.root.join("edits"), self.root.join(".biplane")].contains(&tidy(&folder)) {
            self.list.push(
                Problem::at(output.folder.span(), "results need a folder of their own")
                    .help("such as folder = \"results\""),
            );
        }
        Study { root: self.root.clone(), name, views, bodies, trials, segment, matching, output: folder }
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
