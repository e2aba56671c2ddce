//! The scenes that are measured, with what each must reach.

use std::path::{Path, PathBuf};

use biplane_geometry::{Point3, Pose};

use crate::{Scene, SceneError, StartOffset, Summary, attempts, turned};

/// A body of a study, measured from seeded starts, and its limits.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Shown above its figures.
    pub name: String,
    /// Its pipeline file, from the project's root.
    pub pipeline: PathBuf,
    /// The body.
    pub body: String,
    /// The poses to compare with.
    pub reference: PathBuf,
    /// How starts are drawn.
    pub starts: StartOffset,
    /// What the figures may be; none where they are only shown.
    pub limits: Option<Limits>,
}

/// What figures may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Median displacement of the centroid, mm.
    pub median_mm: f64,
    /// Median angle, degrees.
    pub median_deg: f64,
    /// Share of matches that may be said to have failed.
    pub failed_share: f64,
}

/// Starts of the checks: exactly 6 mm and 6 degrees off in random directions.
pub const STARTS: StartOffset = StartOffset { translation_mm: 6.0, rotation_deg: 6.0, count: 20, seed: 1 };

impl Check {
    /// Measures it.
    ///
    /// # Errors
    /// Something cannot be read.
    pub fn measure(&self, root: &Path) -> Result<Summary, SceneError> {
        let scene = Scene::load(&root.join(&self.pipeline), &self.body, &root.join(&self.reference))?;
        let draw = |pose: &Pose, centroid: &Point3, frame| self.starts.draw(pose, centroid, frame);
        Ok(Summary::of(&attempts(&scene, draw)))
    }

    /// Measures it from starts turned far away, where all that counts is that no wrong pose is called good.
    ///
    /// # Errors
    /// Something cannot be read.
    pub fn measure_turned(&self, root: &Path) -> Result<Summary, SceneError> {
        let scene = Scene::load(&root.join(&self.pipeline), &self.body, &root.join(&self.reference))?;
        Ok(Summary::of(&attempts(&scene, |pose, centroid, _| turned(pose, centroid))))
    }

    /// What of a summary is beyond the limits, one line each. A wrong pose called good always is.
    pub fn passed_limits(&self, summary: &Summary) -> Vec<String> {
        let mut found = Vec::new();
        if summary.wrong_called_good > 0 {
            found.push(format!(
                "{}: {} wrong poses called good, limit 0",
                self.name, summary.wrong_called_good
            ));
        }
        let Some(limits) = self.limits else { return found };
        let mut hold = |what: &str, value: f64, limit: f64| {
            if value.is_nan() || value > limit {
                found.push(format!("{}: {what} {value:.3}, limit {limit:.3}", self.name));
            }
        };
        hold("median mm", summary.translation_mm.median, limits.median_mm);
        hold("median degrees", summary.rotation_deg.median, limits.median_deg);
        hold("share failed", summary.verdicts[2] as f64 / summary.count.max(1) as f64, limits.failed_share);
        found
    }
}

/// The example study, whose truth another program's simulator gives.
pub fn knee() -> Vec<Check> {
    let check = |body: &str, median_mm, median_deg| Check {
        name: format!("simulated knee, {body}"),
        pipeline: "pipeline.toml".into(),
        body: body.to_owned(),
        reference: format!("fixtures/knee/truth/{body}_world_from_model.csv").into(),
        starts: STARTS,
        limits: Some(Limits { median_mm, median_deg, failed_share: 0.05 }),
    };
    vec![check("femoral_component", 0.05, 0.10), check("tray", 0.05, 0.15)]
}

/// The real knee implant with both ways of counting pixels, if its data is there. Its reference is somebody else's fit.
pub fn real_knee(root: &Path) -> Option<Vec<Check>> {
    let data = Path::new("../shared/data/real/knee-implant-biplane");
    let reference = data.join("reference_femur_world_from_model.csv");
    root.join(&reference).is_file().then(|| {
        ["centre", "corner"]
            .map(|origin| Check {
                name: format!("real knee, femur, pixel_origin = \"{origin}\""),
                pipeline: format!("fixtures/real/knee-implant-biplane-{origin}.toml").into(),
                body: "femur".to_owned(),
                reference: reference.clone(),
                starts: STARTS,
                limits: None,
            })
            .to_vec()
    })
}
