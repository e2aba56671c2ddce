//! `pipeline.toml` as it is written: tables, keys, types, defaults. Nothing is looked up on disk here.
//!
//! The doc comments of the fields are the text of the JSON Schema and of `docs/pipeline-reference.md`. Names and paths
//! keep their place in the file ([`Located`]), so that what [`crate::study`] finds wrong points at its line. `flatten`
//! and tagged enums are avoided: they lose those places.

use biplane_axes::AxesParams;
use biplane_contour::ContourParams;
use biplane_distortion::DistortionParams;
use biplane_environment::EnvironmentParams;
use biplane_label_surface::LabelSurfaceParams;
use biplane_lofting::LoftParams;
use biplane_optimisation::{MatchParams, TrackParams};
use biplane_point_model::ModelParams;
use biplane_segmentation::{SegmentParams, TraceParams};
use biplane_slices::SlicesParams;
use biplane_spots::{Look, SpotSettings};
use biplane_trial::SmoothSettings;
use schemars::JsonSchema;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::exports::ExportSection;
use crate::joints::section::JointSection;

/// A text and where it stands in the file.
pub type Located = toml::Spanned<String>;

/// One study: its fluoroscopes, bodies and trials, and how they are worked on. Paths are relative to this file's folder.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "biplane pipeline.toml")]
pub struct PipelineFile {
    /// What the study is.
    pub study: StudySection,
    /// The fluoroscopes, one table each: `[fluoroscope.A]`. One, two or more; their order is that of the file. A study of models alone has
    /// neither fluoroscopes nor trials.
    #[serde(default)]
    #[schemars(with = "std::collections::BTreeMap<String, FluoroscopeSection>")]
    pub fluoroscope: InOrder<FluoroscopeSection>,
    /// The plate whose pictures show the distortion (`plate` of a fluoroscope).
    #[schemars(with = "Option<PlateSection>")]
    pub plate: Option<toml::Spanned<PlateSection>>,
    /// The frame of beads whose pictures show where the fluoroscopes stand (`beads` of a fluoroscope).
    #[schemars(with = "Option<BeadsSection>")]
    pub beads: Option<toml::Spanned<BeadsSection>>,
    /// How holes and beads are found in calibration pictures.
    #[serde(default)]
    pub spots: SpotSettings,
    /// How distortion is fitted to the plate.
    #[serde(default)]
    pub distortion: DistortionParams,
    /// How the fluoroscopes are found from the beads.
    #[serde(default)]
    pub environment: EnvironmentParams,
    /// The bodies to find, one `[[body]]` each.
    pub body: Vec<BodySection>,
    /// The recordings, one `[[trial]]` each.
    #[serde(default)]
    pub trial: Vec<TrialSection>,
    /// Bones in MRI, CT or maps of labels, one `[[slices]]` each; there may be none.
    #[serde(default)]
    pub slices: Vec<SlicesSection>,
    /// Joints between bodies, one `[[joint]]` each; there may be none.
    #[serde(default)]
    pub joint: Vec<JointSection>,
    /// How edges are found in the pictures.
    #[serde(default)]
    pub segment: SegmentParams,
    /// How contours that a person drew are taken.
    #[serde(default)]
    pub edit: TraceParams,
    /// How poses are found from the edges.
    #[serde(default, rename = "match")]
    pub matching: MatchParams,
    /// How the frames of a trial, and the bodies of a frame, help each other.
    #[serde(default)]
    pub track: TrackParams,
    /// How edges are chosen for the outline of a posed body, and when a person should look.
    #[serde(default)]
    pub contour: ContourParams,
    /// Limits of `biplane doctor`.
    #[serde(default)]
    pub doctor: DoctorSection,
    /// Smoothing of whole trials, off unless asked for.
    #[serde(default)]
    pub smooth: SmoothSettings,
    /// Where results go.
    #[serde(default)]
    pub output: OutputSection,
    /// Results for other programs.
    #[serde(default)]
    pub export: ExportSection,
}

/// `[study]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudySection {
    /// Name of the study, shown in the report.
    pub name: String,
}

/// `[fluoroscope.A]`: one fluoroscope (a view). Either `beads` (raw calibration pictures) or `calibration` (a file of
/// another program) says where it stands.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FluoroscopeSection {
    /// Picture of the frame of beads, or a list of pictures of it in several places (the same places for every fluoroscope;
    /// the first one is the laboratory's frame).
    #[schemars(with = "Option<OneOrMoreTexts>")]
    pub beads: Option<OneOrMore>,
    /// Picture of the plate on this fluoroscope's intensifier. Without it the pictures must be corrected already.
    #[schemars(with = "Option<String>")]
    pub plate: Option<Located>,
    /// Side of a pixel on the detector, mm: needed with `beads` where there is no `plate` (a flat panel's data sheet has it).
    #[schemars(with = "Option<f64>")]
    pub pixel_mm: Option<toml::Spanned<f64>>,
    /// Calibration file: MayaCam 2.0 or 1.0, JointTrack, four points, or source-and-plane JSON.
    #[schemars(with = "Option<String>")]
    pub calibration: Option<Located>,
    /// Where the calibration file counts pixels from: the centre or the corner of the first pixel.
    #[serde(default)]
    pub pixel_origin: Origin,
    /// Distortion table (CSV) of pictures that are not corrected, instead of a `plate`.
    #[schemars(with = "Option<String>")]
    pub distortion: Option<Located>,
    /// How sure the calibration file is, where its program tells: `uncertainty = { source_mm = 0.3, detector_mm = 0.1, pixel_mm = 0.31 }`.
    /// It becomes a part of the stated uncertainty of every pose. Of all fluoroscopes or of none; not with `beads`, which tell it.
    #[schemars(with = "Option<StatedUncertainty>")]
    pub uncertainty: Option<toml::Spanned<StatedUncertainty>>,
    /// Picture of the same size as its frames, black where edges do not count (a marker, a collimator).
    #[schemars(with = "Option<String>")]
    pub mask: Option<Located>,
}

/// How sure a calibration of another program is. Errors of different axes and fluoroscopes are taken as independent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StatedUncertainty {
    /// Standard deviation of the source's place along each axis, mm.
    #[schemars(range(min = 0.0))]
    pub source_mm: f64,
    /// Standard deviation of the detector's place along each axis, mm.
    #[schemars(range(min = 0.0))]
    pub detector_mm: f64,
    /// Side of a pixel on the detector, mm: it tells how far the detector is from the source.
    #[schemars(range(min = 0.0))]
    pub pixel_mm: f64,
}

/// One path, or a list of them.
#[derive(Debug)]
pub struct OneOrMore(pub Vec<Located>);

/// The schema of [`OneOrMore`].
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "only its schema is used")]
enum OneOrMoreTexts {
    One(String),
    More(Vec<String>),
}

impl<'de> Deserialize<'de> for OneOrMore {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // Not through an untagged enum: it would lose the places in the file.
        let value = toml::Spanned::<toml::Value>::deserialize(deserializer)?;
        let (span, text) = (value.span(), "a path, or a list of paths");
        let path = |v: toml::Value| match v {
            toml::Value::String(path) => Ok(toml::Spanned::new(span.clone(), path)),
            other => Err(serde::de::Error::custom(format!("expected {text}, found {}", other.type_str()))),
        };
        match value.into_inner() {
            toml::Value::Array(list) => list.into_iter().map(path).collect::<Result<_, _>>().map(Self),
            one => Ok(Self(vec![path(one)?])),
        }
    }
}

/// `[plate]`: the plate of known pattern that was fixed to the intensifiers. Either `list` or `pattern` and `pitch_mm`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlateSection {
    /// Where its holes are (CSV: `hole,x_mm,y_mm,radius_mm`): any pattern, such as concentric circles.
    #[schemars(with = "Option<String>")]
    pub list: Option<Located>,
    /// A regular grid instead of a list.
    pub pattern: Option<Grid>,
    /// Distance of neighbours of that grid, mm.
    #[schemars(with = "Option<f64>")]
    pub pitch_mm: Option<toml::Spanned<f64>>,
    /// Whether its spots are brighter (holes) or darker (dots, beads) than the plate.
    #[serde(default = "bright")]
    pub spots: Look,
}

fn bright() -> Look {
    Look::Bright
}

/// A regular grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Grid {
    /// Squares.
    Square,
    /// Equilateral triangles (XMALab's plate).
    Hexagonal,
}

/// `[beads]`: the frame of beads at known places. Its coordinates are the laboratory's.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BeadsSection {
    /// Where the beads are: CSV `bead,x_mm,y_mm,z_mm,radius_mm`, or an XMALab cube file.
    #[schemars(with = "String")]
    pub list: Located,
    /// Unit of the list.
    #[serde(default)]
    pub units: Units,
    /// XMALab's file of reference beads: the marks by which the frame is recognised.
    #[schemars(with = "Option<String>")]
    pub references: Option<Located>,
    /// Whether beads are darker or brighter than what is around them.
    #[serde(default = "dark")]
    pub spots: Look,
}

fn dark() -> Look {
    Look::Dark
}

/// Where a calibration file has its pixel (0, 0).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// The centre of the first pixel (OpenCV, XMALab).
    #[default]
    Centre,
    /// The corner of the first pixel, so that its centre is (0.5, 0.5).
    Corner,
}

impl Origin {
    /// The word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Centre => "centre",
            Self::Corner => "corner",
        }
    }
}

/// `[[body]]`: a bone or an implant part. Its surface comes either from a `mesh` file, or from the `slices` of a volume.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodySection {
    /// Name of the body, as start poses and results call it.
    #[schemars(with = "String")]
    pub name: Located,
    /// Its surface: an STL, PLY, OBJ, OFF or VTK file.
    #[schemars(with = "Option<String>")]
    pub mesh: Option<Located>,
    /// Unit of the mesh's coordinates. Not given, a mesh whose size can only be mm is taken as mm; of any other the run asks.
    pub units: Option<Units>,
    /// Instead of a mesh: the name of a `[[slices]]` table. The bone's contours become its surface, in the scanner's frame.
    #[schemars(with = "Option<String>")]
    pub slices: Option<Located>,
    /// With `slices`: how contours become a surface.
    #[schemars(with = "Option<LoftParams>")]
    pub loft: Option<toml::Spanned<LoftParams>>,
    /// With `slices` that are found by a label: the surface is made straight from the map of labels, not from contours. Its `label`
    /// need not be given again.
    #[schemars(with = "Option<LabelSurfaceParams>")]
    pub label_surface: Option<toml::Spanned<LabelSurfaceParams>>,
    /// How many points the model has, and how they are spread. Not given, a mesh file's own vertices are matched as they are, and a
    /// surface from slices gets 15,000 points spread evenly.
    #[schemars(with = "Option<ModelParams>")]
    pub model: Option<toml::Spanned<ModelParams>>,
    /// Whether flat ends, where a volume or a scan was cut, are outline: `"ignore"` where pictures show the bone beyond its model,
    /// `"keep"` where the body truly ends so. Not given, they are ignored on surfaces from slices, and kept in mesh files.
    pub cut_ends: Option<CutEnds>,
    /// Its local coordinate system: what it is and of which side, `axes = { body = "femur", side = "left" }`.
    #[schemars(with = "Option<AxesParams>")]
    pub axes: Option<toml::Spanned<AxesParams>>,
    /// Landmarks that a person placed on it, or an origin and points on its axes (CSV, `.fcsv`, `.mrk.json`): they win over what the
    /// shape proposes. A file `edits/landmarks/NAME.csv` wins over this one.
    #[schemars(with = "Option<String>")]
    pub landmarks: Option<Located>,
    /// Another mesh of the same body in the same frame, to be compared with: its distance map is drawn.
    #[schemars(with = "Option<String>")]
    pub reference: Option<Located>,
    /// Unit of the reference's coordinates.
    pub reference_units: Option<Units>,
}

/// What flat ends of a body's surface are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CutEnds {
    /// Where its volume was cut: no outline.
    Ignore,
    /// Its own: outline as the rest.
    Keep,
}

/// Unit of length of a mesh file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Units {
    /// Millimetres.
    #[default]
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches.
    In,
}

/// `[[trial]]`: one recording of all fluoroscopes.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrialSection {
    /// Name of the trial, as start poses and results call it.
    #[schemars(with = "String")]
    pub name: Located,
    /// Where each fluoroscope's pictures are: a folder, a pattern (`frames/A/*.tif`), or one file with many pictures.
    #[schemars(with = "std::collections::BTreeMap<String, String>")]
    pub frames: InOrder<Located>,
    /// How pictures of the fluoroscopes are paired: by the number in their names or by their place in the list.
    #[serde(default)]
    pub pair_by: PairBy,
    /// Added to the number (or place) of the first fluoroscope's picture to get that of the second one's taken with it.
    #[serde(default)]
    pub offset: i64,
    /// Pictures per second; wins over what the files say.
    #[schemars(with = "Option<f64>")]
    pub frame_rate_hz: Option<toml::Spanned<f64>>,
    /// Start poses (CSV). Poses in `edits/poses.csv` win over these.
    #[schemars(with = "Option<String>")]
    pub starts: Option<Located>,
    /// The bodies to find in this trial; all of them if not given.
    #[schemars(with = "Option<Vec<String>>")]
    pub bodies: Option<Vec<Located>>,
}

/// `[[slices]]`: a bone in an MRI, a CT or a map of labels. Its contours in every slice go to `results/slices/NAME.csv`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlicesSection {
    /// Name of the bone, as results and edits call it.
    #[schemars(with = "String")]
    pub name: Located,
    /// Its volume: a NRRD or NIfTI file, or a folder with the slices of one DICOM series.
    #[schemars(with = "String")]
    pub volume: Located,
    /// How it is found: `find = { method = "bone", seed_mm = [x, y, z] }`, or `find = { label = 3 }`.
    #[schemars(with = "SlicesParams")]
    pub find: toml::Spanned<SlicesParams>,
}

/// How pictures of two fluoroscopes are paired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PairBy {
    /// By the last number in the file's name.
    #[default]
    Number,
    /// By the place in the sorted list.
    Index,
}

/// `[doctor]`: when a calibration is said not to fit the frames of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DoctorSection {
    /// Median disagreement of two views about where a body is, across their epipolar planes, mm.
    #[schemars(range(min = 0.0))]
    pub max_disagreement_mm: f64,
    /// How far the intensifier's round border may have moved since the plate's picture, px.
    #[schemars(range(min = 0.0))]
    pub max_border_shift_px: f64,
    /// Standard deviation of a body's position that the calibration alone may bring, mm.
    #[schemars(range(min = 0.0))]
    pub max_pose_sigma_mm: f64,
}

impl Default for DoctorSection {
    fn default() -> Self {
        Self { max_disagreement_mm: 0.1, max_border_shift_px: 1.0, max_pose_sigma_mm: 0.2 }
    }
}

/// `[output]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OutputSection {
    /// Folder of results: `poses.csv`, `kinematics.csv`, `overlays/`, `report.html`.
    #[schemars(with = "String")]
    pub folder: Located,
}

impl Default for OutputSection {
    fn default() -> Self {
        Self { folder: toml::Spanned::new(0..0, "results".to_owned()) }
    }
}

/// The entries of a table in the order of the file, with the places of their keys.
#[derive(Debug)]
pub struct InOrder<T>(pub Vec<(Located, T)>);

impl<T> Default for InOrder<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for InOrder<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(std::marker::PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Vec<(Located, T)>;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a table with one entry a fluoroscope, such as { A = ..., B = ... }")
            }
            fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Self::Value, M::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(entries)
            }
        }
        deserializer.deserialize_map(Entries(std::marker::PhantomData)).map(Self)
    }
}
