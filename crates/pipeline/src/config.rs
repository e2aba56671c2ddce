//! `pipeline.toml` as it is written: tables, keys, types, defaults. Nothing is looked up on disk here.
//!
//! The doc comments of the fields are the text of the JSON Schema and of `docs/pipeline-reference.md`. Names and paths
//! keep their place in the file ([`Located`]), so that what [`crate::study`] finds wrong points at its line. `flatten`
//! and tagged enums are avoided: they lose those places.

use biplane_optimisation::MatchParams;
use biplane_segmentation::SegmentParams;
use schemars::JsonSchema;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// A text and where it stands in the file.
pub type Located = toml::Spanned<String>;

/// One study: its fluoroscopes, bodies and trials, and how they are worked on. Paths are relative to this file's folder.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "biplane pipeline.toml")]
pub struct PipelineFile {
    /// What the study is.
    pub study: StudySection,
    /// The fluoroscopes, one table each: `[fluoroscope.A]`. One, two or more; their order is that of the file.
    #[schemars(with = "std::collections::BTreeMap<String, FluoroscopeSection>")]
    pub fluoroscope: InOrder<FluoroscopeSection>,
    /// The bodies to find, one `[[body]]` each.
    pub body: Vec<BodySection>,
    /// The recordings, one `[[trial]]` each.
    pub trial: Vec<TrialSection>,
    /// How edges are found in the pictures.
    #[serde(default)]
    pub segment: SegmentParams,
    /// How poses are found from the edges.
    #[serde(default, rename = "match")]
    pub matching: MatchParams,
    /// Where results go.
    #[serde(default)]
    pub output: OutputSection,
}

/// `[study]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudySection {
    /// Name of the study, shown in the report.
    pub name: String,
}

/// `[fluoroscope.A]`: one fluoroscope (a view).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FluoroscopeSection {
    /// Calibration file: MayaCam 2.0 text (as XMALab writes it) or source-and-plane JSON.
    #[schemars(with = "String")]
    pub calibration: Located,
    /// Where the calibration file counts pixels from: the centre or the corner of the first pixel.
    #[serde(default)]
    pub pixel_origin: Origin,
    /// Distortion table (CSV) of pictures that are not corrected. Without it the pictures must be corrected already.
    #[schemars(with = "Option<String>")]
    pub distortion: Option<Located>,
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

/// `[[body]]`: a bone or an implant part.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodySection {
    /// Name of the body, as start poses and results call it.
    #[schemars(with = "String")]
    pub name: Located,
    /// Its surface: an STL file.
    #[schemars(with = "String")]
    pub mesh: Located,
    /// Unit of the mesh's coordinates.
    #[serde(default)]
    pub units: Units,
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

/// `[output]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OutputSection {
    /// Folder of results: `poses.csv`, `overlays/`, `report.html`.
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
