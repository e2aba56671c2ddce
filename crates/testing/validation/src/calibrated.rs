//! Fluoroscopes calibrated as a laboratory does it: the product's stages on pictures of a plate before each detector and of a
//! frame of beads before both.

use biplane_artifact::{
    BeadClicks, BeadList, Calibration, Detector, Environment, Frame, PlateFit, Spots, Verdict,
};
use biplane_distortion::{DistortionParams, fit_plate};
use biplane_environment::{EnvironmentParams, find_environment};
use biplane_fluoroscope::Fluoroscope;
use biplane_phantom::{BeadLayout, Exposure, TrueFluoroscope};
use biplane_spots::find_spots;

use crate::bead_scenes::{BeadScene, beads_of, calibration};
use crate::faults::random;
use crate::pictures::Equipment;
use crate::plates::{HeldPlate, PlateKind};
use crate::setups::of_a_plate;
use crate::{Lab, SceneError};

/// What the stages made of the pictures.
#[derive(Debug, Clone)]
pub struct Calibrated {
    /// A plate's map a view; none where pictures are not bent.
    pub fits: Vec<PlateFit>,
    /// The fluoroscopes.
    pub environment: Environment,
}

impl Calibrated {
    /// The views as what follows uses them.
    pub fn calibrations(&self) -> Vec<Calibration> {
        let with_map = |(index, view)| calibration(view, self.fits.get(index).map(|f: &PlateFit| &f.table));
        self.environment.views.iter().enumerate().map(with_map).collect()
    }

    /// The same, ready for use.
    pub fn fluoroscopes(&self) -> Vec<Fluoroscope> {
        self.calibrations().iter().map(Fluoroscope::from).collect()
    }

    /// Whether every stage calls it good.
    pub fn good(&self) -> bool {
        self.environment.verdict == Verdict::Good && self.fits.iter().all(|f| f.verdict == Verdict::Good)
    }
}

/// The stage `environment` with its defaults; `None` where it refuses.
pub fn environment(
    detectors: &[Detector; 2],
    spots: &[Spots; 2],
    beads: &BeadList,
    clicks: Option<&BeadClicks>,
) -> Option<Environment> {
    let [a, b] = spots;
    find_environment(&detectors.each_ref(), &[a, b], beads, clicks, &EnvironmentParams::default()).ok()
}

/// Takes the pictures of plates (where an exposure bends them) and of the beads, a seed each that follows from `lab` and
/// `number`, and calibrates; `None` where a stage refuses. The pictures come too: plates, then beads.
///
/// # Errors
/// Something is not in the beam.
pub fn calibrated(
    lab: &Lab,
    scene: &BeadScene,
    exposures: [&Exposure; 2],
    number: usize,
) -> Result<(Option<Calibrated>, Vec<Frame>), SceneError> {
    let mut chance = random(lab.seed, 86, number);
    let seed =
        |picture: u64| lab.seed.wrapping_mul(104_729).wrapping_add(8 * number as u64).wrapping_add(picture);
    let (mut frames, mut fits) = (Vec::new(), Vec::new());
    for (index, (view, exposure)) in scene.views.iter().zip(exposures).enumerate() {
        if exposure.distortion.is_none() {
            continue;
        }
        let held = HeldPlate::drawn(PlateKind::Concentric, view, &mut chance);
        let frame = held.picture(view, exposure, seed(index as u64))?;
        let spots = find_spots(&frame, &held.spot_params()).ok();
        fits.push(spots.and_then(|s| fit_plate(&s, &held.pattern, None, &DistortionParams::default()).ok()));
        frames.push(frame);
    }
    let beads = scene.pictures(exposures, seed(4))?;
    let bent = !fits.is_empty();
    let found = fits.into_iter().collect::<Option<Vec<PlateFit>>>().and_then(|fits| {
        let detectors = match fits.as_slice() {
            [a, b] => [a, b].map(|f| (f.pixel_mm, Some(f.table.clone()))),
            _ if bent => return None,
            _ => scene.views.each_ref().map(|v| (v.pixel_mm, None)),
        };
        let [a, b] = detectors;
        let detectors = [scene.detector(0, a.0, a.1), scene.detector(1, b.0, b.1)];
        let spots = [beads_of(&beads[0]).ok()?, beads_of(&beads[1]).ok()?];
        Some(Calibrated { environment: environment(&detectors, &spots, &scene.list(), None)?, fits })
    });
    frames.extend(beads);
    Ok((found, frames))
}

/// Calibrations of a laboratory's equipment, from pictures of a plate and of a frame of beads of 100 mm that it takes itself, the
/// open beam unsaturated. Another `number`, other plates, beads and noise.
///
/// # Errors
/// The equipment has not two views, or cannot be calibrated.
pub fn of_equipment(lab: &Lab, equipment: &Equipment, number: usize) -> Result<Vec<Calibration>, SceneError> {
    let views: Vec<TrueFluoroscope> = equipment.views.iter().map(|(v, _)| v.clone()).collect();
    let views =
        <[TrueFluoroscope; 2]>::try_from(views).map_err(|_| SceneError::Mesh("not two views".to_owned()))?;
    let scene = BeadScene::before(views, &BeadLayout::small(), &mut random(lab.seed, 87, number))?;
    let exposures: Vec<Exposure> = equipment.views.iter().map(|(_, e)| of_a_plate(e.distortion)).collect();
    let found = calibrated(lab, &scene, [&exposures[0], &exposures[1]], 1000 + number)?.0;
    let found = found.ok_or_else(|| SceneError::Mesh(format!("equipment {number} cannot be calibrated")))?;
    Ok(found.calibrations())
}
