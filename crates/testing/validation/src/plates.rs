//! Plates before an intensifier, and how far the product's map is from the true one.
//!
//! Where the product's plate coordinates begin and how they are turned is up to it where the plate is a lattice without end;
//! where each hole is known, there is no such freedom. A pixel is that of the plate's plane.

use biplane_artifact::{Frame, PlateFit, PlatePattern, PlateSpot};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Point3, Pose, Vector2};
use biplane_phantom::{
    Exposure, IntensifierDistortion, Plate, PlatePlacement, PosedBody, Scene, Scratch, SpotPattern,
    SpotRadii, TrueFluoroscope, picture,
};
use biplane_spots::{Look, SpotParams, SpotSettings};
use nalgebra::Rotation2;
use rand::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::SceneError;
use crate::faults::normal;

/// Kinds of plates that laboratories have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlateKind {
    /// The thesis's: holes on circles 10 mm apart, two of them larger.
    Concentric,
    /// Holes of 2.5 mm on a square grid of 10 mm.
    Square,
    /// Perforated metal as XMALab's users take it: holes of 3.2 mm on a triangular grid of 4.76 mm.
    Hexagonal,
    /// Balls of 3 mm on an acrylic sheet, on a square grid of 12 mm; the first two, 5 and 4 mm, give place and direction.
    Balls,
}

impl PlateKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Concentric, Self::Square, Self::Hexagonal, Self::Balls];

    /// In tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Concentric => "holes on circles, two marked",
            Self::Square => "holes on a square grid",
            Self::Hexagonal => "holes on a triangular grid",
            Self::Balls => "balls on a square grid, two marked",
        }
    }

    fn plate(self) -> (Plate, PlatePattern) {
        let alike = |radius: f64| SpotRadii { centre: radius, orientation: radius, others: radius };
        match self {
            Self::Concentric => listed(Plate::concentric()),
            Self::Square => {
                let pattern = SpotPattern::Square { pitch_mm: 10.0, reach_mm: 165.0 };
                (Plate::perforated(pattern.spots(alike(1.25))), PlatePattern::Square { pitch_mm: 10.0 })
            }
            Self::Hexagonal => {
                let pitch_mm = 4.7625;
                let pattern = SpotPattern::Hexagonal { pitch_mm, reach_mm: 165.0 };
                (Plate::perforated(pattern.spots(alike(1.5875))), PlatePattern::Hexagonal { pitch_mm })
            }
            Self::Balls => {
                let radii = SpotRadii { centre: 2.5, orientation: 2.0, others: 1.5 };
                let pattern = SpotPattern::Square { pitch_mm: 12.0, reach_mm: 160.0 };
                listed(Plate::dotted(pattern.spots(radii)))
            }
        }
    }

    fn look(self) -> Look {
        if self == Self::Balls { Look::Dark } else { Look::Bright }
    }
}

/// A plate of which each spot is known.
fn listed(plate: Plate) -> (Plate, PlatePattern) {
    let known =
        |s: &biplane_phantom::Spot| PlateSpot { at_mm: s.centre.into(), radius_mm: Some(s.radius_mm) };
    let pattern = PlatePattern::List(plate.spots.iter().map(known).collect());
    (plate, pattern)
}

/// A plate before an intensifier, and what its owner knows of it.
#[derive(Debug, Clone)]
pub struct HeldPlate {
    /// As it is.
    pub plate: Plate,
    /// As its owner knows it.
    pub pattern: PlatePattern,
    /// Holes or balls.
    pub look: Look,
    /// Where it is.
    pub pose: Pose,
    /// Distance of its middle plane before the detector, mm.
    pub before_mm: f64,
}

impl HeldPlate {
    /// Turned by any angle, shifted by up to 6 mm along each axis, up to 10 mm before the detector, with one spot of fifty missing
    /// (no marks), two scratches and a burr.
    pub fn drawn(kind: PlateKind, view: &TrueFluoroscope, chance: &mut Xoshiro256PlusPlus) -> Self {
        let (mut plate, pattern) = kind.plate();
        plate.missing = (2..plate.spots.len()).filter(|_| chance.random_bool(0.02)).collect();
        let mut place =
            || Point2::new(chance.random_range(-110.0..110.0), chance.random_range(-110.0..110.0));
        let lines = [0.2, 0.1, -0.1].map(|depth_mm| (place(), place(), depth_mm));
        plate.scratches =
            lines.map(|(from, to, depth_mm)| Scratch { from, to, width_mm: 0.4, depth_mm }).to_vec();
        let placement = PlatePlacement {
            turn_rad: chance.random_range(0.0..std::f64::consts::TAU),
            shift_mm: [chance.random_range(-6.0..6.0), chance.random_range(-6.0..6.0)],
            tilt_rad: [0.0; 2],
            before_mm: chance.random_range(0.0..10.0),
        };
        let pose = placement.pose(view);
        Self { plate, pattern, look: kind.look(), pose, before_mm: placement.before_mm }
    }

    /// Its picture.
    ///
    /// # Errors
    /// The plate is not in the beam.
    pub fn picture(
        &self,
        view: &TrueFluoroscope,
        exposure: &Exposure,
        seed: u64,
    ) -> Result<Frame, SceneError> {
        let absorbers = self.plate.absorbers().map_err(|e| SceneError::Mesh(e.to_string()))?;
        let scene = Scene { bodies: vec![PosedBody::at_rest(self.pose, absorbers)], ..Scene::default() };
        picture(&scene, view, exposure, seed).map_err(|e| SceneError::Mesh(e.to_string()))
    }

    /// How its spots are looked for.
    pub fn spot_params(&self) -> SpotParams {
        SpotParams { look: self.look, settings: SpotSettings::default() }
    }

    /// The point of the plate that is recorded at a pixel, mm.
    pub fn recorded_from_mm(
        &self,
        view: &TrueFluoroscope,
        distortion: &IntensifierDistortion,
        recorded: &Point2,
    ) -> Point2 {
        let to_plate = self.pose.inverse();
        let through = to_plate.transform(&view.detector_point(&distortion.ideal(recorded)));
        let source = to_plate.transform(&view.source);
        let ray: Point3 = source + (through - source) * (source.z / (source.z - through.z));
        ray.xy()
    }

    /// Side of an ideal pixel in the plate's plane, mm.
    pub fn pixel_mm(&self, view: &TrueFluoroscope) -> f64 {
        view.pixel_mm * (1.0 - self.before_mm / view.source_to_detector_mm())
    }
}

/// Recorded pixels every 8 px inside `share` of a round border.
pub fn inside(centre: &Point2, radius_px: f64, share: f64) -> Vec<Point2> {
    let reach = radius_px * share;
    let steps = (reach / 8.0).ceil() as i32;
    (-steps..=steps)
        .flat_map(|j| (-steps..=steps).map(move |i| Vector2::new(f64::from(i), f64::from(j)) * 8.0))
        .filter(|v| v.norm() <= reach)
        .map(|v| centre + v)
        .collect()
}

/// Where the product's map puts recorded pixels on the plate, mm.
pub fn on_plate(fit: &PlateFit, recorded: &[Point2]) -> Vec<Point2> {
    let map = Distortion::from(&fit.table);
    let place = |p: &Point2| {
        let ideal = map.ideal(p);
        let [x, y] = fit.plate_from_ideal.map(|[a, b, c]| a * ideal.x + b * ideal.y + c);
        Point2::new(x, y)
    };
    recorded.iter().map(place).collect()
}

/// Error of a map, root mean square lengths, px of the plate's plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapError {
    /// As it is.
    pub raw_px: f64,
    /// After the best rigid motion of the plane: what no placement of the plate explains.
    pub rms_px: f64,
}

impl MapError {
    /// Of places on the plate against the true ones, mm; `pixel_mm` is the size of a pixel.
    pub fn of(found: &[Point2], truth: &[Point2], pixel_mm: f64) -> Self {
        let count = found.len().max(1) as f64;
        let mean = |points: &[Point2]| points.iter().map(|p| p.coords).sum::<Vector2>() / count;
        let middles = [mean(found), mean(truth)];
        let (mut dot, mut cross, mut raw) = (0.0, 0.0, 0.0);
        for (f, t) in found.iter().zip(truth) {
            let (a, b) = (f.coords - middles[0], t.coords - middles[1]);
            dot += a.dot(&b);
            cross += a.perp(&b);
            raw += (f - t).norm_squared();
        }
        let turn = Rotation2::new(cross.atan2(dot));
        let left: f64 = found
            .iter()
            .zip(truth)
            .map(|(f, t)| (turn * (f.coords - middles[0]) - (t.coords - middles[1])).norm_squared())
            .sum();
        Self { raw_px: (raw / count).sqrt() / pixel_mm, rms_px: (left / count).sqrt() / pixel_mm }
    }
}

/// A normal number of standard deviation `sigma` for each coordinate.
pub fn disturbed(at: [f64; 2], sigma: f64, chance: &mut Xoshiro256PlusPlus) -> [f64; 2] {
    at.map(|v| v + sigma * normal(chance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faults::random;
    use crate::setups::bent;
    use biplane_phantom::biplane;

    #[test]
    fn a_motion_of_the_plate_is_no_error_of_the_map_but_a_stretch_is() {
        let truth = inside(&Point2::new(3.0, 4.0), 100.0, 1.0);
        let turn = Rotation2::new(0.7);
        let moved: Vec<Point2> = truth.iter().map(|p| turn * p + Vector2::new(5.0, -2.0)).collect();
        let error = MapError::of(&moved, &truth, 0.5);
        assert!(error.rms_px < 1e-9 && error.raw_px > 10.0, "{error:?}");
        let stretched: Vec<Point2> = truth.iter().map(|p| p * 1.01).collect();
        // A disc of radius R has the root mean square distance R / sqrt 2 from its middle: 1 % of 100 / sqrt 2 over 0.5.
        let error = MapError::of(&stretched, &truth, 0.5);
        assert!((error.rms_px - 1.414).abs() < 0.02, "{error:?}");
    }

    #[test]
    fn a_hole_is_where_the_plate_is_recorded() {
        let view = &biplane(90.0)[0];
        let mut chance = random(1, 70, 0);
        let distortion = bent(view.size, &mut chance);
        let held = HeldPlate::drawn(PlateKind::Concentric, view, &mut chance);
        for seen in held.plate.seen(&held.pose, view, &distortion) {
            let found = held.recorded_from_mm(view, &distortion, &seen.recorded);
            assert!((found - held.plate.spots[seen.number].centre).norm() < 1e-6);
        }
    }
}
