//! Fluoroscopes as laboratories set them up: displaced, bent, and never twice the same. Each is drawn from a seed.

use biplane_geometry::{Point3, Vector2, Vector3};
use biplane_phantom::{Exposure, IntensifierDistortion, TrueFluoroscope, biplane};
use nalgebra::Rotation3;
use rand::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::faults::normal_vector;

/// Two fluoroscopes at an angle of 75 to 105 degrees, their sources displaced by 15 mm and their detectors by 8 mm along each
/// axis (standard deviations).
pub fn displaced(chance: &mut Xoshiro256PlusPlus) -> [TrueFluoroscope; 2] {
    biplane(chance.random_range(75.0..105.0)).map(|view| TrueFluoroscope {
        source: view.source + normal_vector(15.0, chance),
        centre: view.centre + normal_vector(8.0, chance),
        ..view
    })
}

/// Two fluoroscopes at such an angle with the laboratory's origin `share` of the way from source to detector: sources displaced
/// by 15 mm along each axis, detectors turned by 1 degree about each, and moved so that the origin is within some 8 mm of their
/// middle.
pub fn aimed(share: f64, chance: &mut Xoshiro256PlusPlus) -> [TrueFluoroscope; 2] {
    biplane(chance.random_range(75.0..105.0)).map(|view| {
        let length = view.source_to_detector_mm();
        let source = Point3::origin() - view.normal() * (share * length) + normal_vector(15.0, chance);
        let beyond = -source.coords * ((1.0 - share) / share);
        let turn = Rotation3::from_scaled_axis(normal_vector(1.0_f64.to_radians(), chance));
        TrueFluoroscope {
            source,
            centre: Point3::from(beyond + normal_vector(8.0, chance)),
            along_x: turn * view.along_x,
            along_y: turn * view.along_y,
            ..view
        }
    })
}

/// Pincushion of 6 to 12 px and an S of up to 12 px at the rim, and a shift of up to 2 px along each axis.
pub fn bent(size: [usize; 2], chance: &mut Xoshiro256PlusPlus) -> IntensifierDistortion {
    IntensifierDistortion {
        pincushion_px: chance.random_range(6.0..12.0),
        s_shape_px: chance.random_range(-12.0..12.0),
        shift_px: Vector2::new(chance.random_range(-2.0..2.0), chance.random_range(-2.0..2.0)),
        ..IntensifierDistortion::none(size)
    }
}

/// How pictures of plates and beads are taken: as those of a knee, but with so little radiation that the open beam is not
/// saturated.
pub fn of_a_plate(distortion: Option<IntensifierDistortion>) -> Exposure {
    Exposure { brightness: 0.8, distortion, ..Exposure::fluoroscopy() }
}

/// A picture with nothing but the detector's blur, on a scale of 16 bits.
pub fn plain() -> Exposure {
    Exposure { samples_per_px: 8, detector_blur_px: 1.0, brightness: 0.8, ..Exposure::ideal() }
}

/// Parts of a vector along a unit vector and across it, mm.
pub fn along_and_across(vector: &Vector3, along: &Vector3) -> (f64, f64) {
    let part = vector.dot(along);
    (part, (vector - along * part).norm())
}
