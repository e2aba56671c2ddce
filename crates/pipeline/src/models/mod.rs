//! Models of bodies: from a mesh file, or the slices of a volume, to the mesh that is matched, its axes, and a sheet that shows both.
//!
//! `loft/<body>` joins the contours of a bone's slices, `label_surface/<body>` follows the boundary of a label; `model/<body>` spreads
//! the points that are matched; `axes/<body>` is the body's local coordinate system, from a person's landmarks or proposed from the
//! shape; `drawing/models/<body>` shows them. A mesh file of which nothing is asked is matched as it is. A fault in one body stops
//! that body alone.

pub mod landmarks;
pub mod look;
pub mod run;
pub mod section;
pub mod tables;
pub mod walk;

use std::path::Path;
use std::sync::{Arc, OnceLock};

use biplane_acquisition::meshes::{LengthUnit, MeshFileError, read_mesh};
use biplane_artifact::ModelMesh;
use biplane_stage::{Hashed, Promise};

use crate::config::Units;
use crate::sources::{InputIndex, MeshFacts};
use crate::study::MeshSource;

/// The folder of results that is theirs.
pub const MODELS: &str = "models";
/// The folder of `edits/` with a person's landmarks.
pub const LANDMARKS: &str = "landmarks";

/// A mesh file, read when it is first needed.
#[derive(Debug)]
pub struct MeshOfFile {
    /// What is known of it.
    pub facts: MeshFacts,
    source: MeshSource,
    loaded: OnceLock<Result<Hashed<ModelMesh>, String>>,
}

impl MeshOfFile {
    /// What is known of a mesh file; it is read if it may have changed.
    ///
    /// # Errors
    /// It cannot be read, or its unit is not clear.
    pub fn of(source: &MeshSource, index: &InputIndex) -> Result<Self, MeshFileError> {
        let unit = source.units.map(unit);
        let loaded = OnceLock::new();
        let facts = index.mesh(&source.path, unit.map_or("an unknown unit", LengthUnit::name), || {
            let file = read_mesh(&source.path, unit)?;
            let notes = file.notes.iter().map(ToString::to_string).collect();
            let model = Hashed::new(file.model);
            let facts = MeshFacts::of(&model, notes);
            let _ = loaded.set(Ok(model));
            Ok(facts)
        })?;
        Ok(Self { facts, source: source.clone(), loaded })
    }

    /// Its file.
    pub fn path(&self) -> &Path {
        &self.source.path
    }

    /// The mesh.
    ///
    /// # Errors
    /// It cannot be read any more.
    pub fn load(&self) -> Result<Hashed<ModelMesh>, String> {
        let read = || {
            let file = read_mesh(&self.source.path, self.source.units.map(unit));
            file.map(|m| Hashed::new(m.model)).map_err(|e| e.to_string())
        };
        self.loaded.get_or_init(read).clone()
    }
}

/// The unit of a file as its reader knows it.
pub fn unit(units: Units) -> LengthUnit {
    match units {
        Units::Mm => LengthUnit::Millimetres,
        Units::Cm => LengthUnit::Centimetres,
        Units::M => LengthUnit::Metres,
        Units::In => LengthUnit::Inches,
    }
}

/// The mesh of a body that is matched.
#[derive(Debug, Clone)]
pub enum BodyModel {
    /// As a file has it.
    File(Arc<MeshOfFile>),
    /// As a step made it.
    Made(Hashed<ModelMesh>),
}

impl BodyModel {
    /// Its hash, for keys.
    pub fn promise(&self) -> Promise<ModelMesh> {
        match self {
            Self::File(file) => file.facts.promise(),
            Self::Made(mesh) => mesh.promise(),
        }
    }

    /// The mesh.
    ///
    /// # Errors
    /// Its file cannot be read any more.
    pub fn load(&self) -> Result<Hashed<ModelMesh>, String> {
        match self {
            Self::File(file) => file.load(),
            Self::Made(mesh) => Ok(mesh.clone()),
        }
    }

    /// The mesh file that it is, if it is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File(file) => Some(file.path()),
            Self::Made(_) => None,
        }
    }
}
