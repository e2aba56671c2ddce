//! Plates with a known pattern, by which a laboratory measures the distortion of its intensifier: a perforated metal plate
//! (bright holes; concentric circles in the thesis, 2.2.1), or metal balls on a thin sheet (dark dots).
//!
//! The plate's frame: x and y in the plane halfway through the plate, mm, z at a right angle; the first spot of a pattern is
//! its centre, the second lies on +x and gives the orientation. The light through a hole is even about the point halfway
//! through, so that point's projection is the centre of what the picture shows, also where rays are oblique.
//!
//! What a real plate has, the picture can have too, apart from the list of spots that a laboratory knows: holes that are
//! missing, scratches, and a plate that is turned, shifted and tilted. **Not here:** conical or rough holes.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::sync::Arc;

use biplane_geometry::{Mesh, MeshError, Point2, Point3, Pose, Vector2, Vector3};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use crate::prism::Prisms;
use crate::shadow::{area_centroid, circle, shadow_outline};
use crate::{Absorber, Ball, IntensifierDistortion, Material, Surface, TrueFluoroscope};

/// Where the spots of a plate are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpotPattern {
    /// A centre with `rings` circles around it, `ring_mm` apart, with 6, 12, 18... spots.
    Concentric {
        /// Number of circles.
        rings: usize,
        /// Distance of circles, mm.
        ring_mm: f64,
    },
    /// A square grid, as far as `reach_mm` from its centre.
    Square {
        /// Distance of neighbours, mm.
        pitch_mm: f64,
        /// Distance of the farthest spots from the centre, mm.
        reach_mm: f64,
    },
    /// A grid of equilateral triangles, as far as `reach_mm` from its centre.
    Hexagonal {
        /// Distance of neighbours, mm.
        pitch_mm: f64,
        /// Distance of the farthest spots from the centre, mm.
        reach_mm: f64,
    },
}

/// Most rows of a grid on each side of its centre.
const MOST_ROWS: f64 = 500.0;

impl SpotPattern {
    /// Centres of the spots on the plate, mm, from the middle outwards and then from x to y: the first is the middle, the
    /// second lies on +x. None where the pitch is no length; rows beyond the 500th from the middle are left out.
    pub fn centres(&self) -> Vec<Point2> {
        match *self {
            Self::Concentric { rings, ring_mm } => {
                let circles = (1..=rings).flat_map(|ring| {
                    let (radius, count) = (ring as f64 * ring_mm, 6 * ring);
                    (0..count).map(move |i| {
                        let (sin, cos) = (TAU * i as f64 / count as f64).sin_cos();
                        Point2::new(radius * cos, radius * sin)
                    })
                });
                std::iter::once(Point2::origin()).chain(circles).collect()
            }
            Self::Square { pitch_mm, reach_mm } => {
                lattice(pitch_mm, reach_mm, Vector2::y(), |i, j| i * i + j * j)
            }
            Self::Hexagonal { pitch_mm, reach_mm } => {
                let up = Vector2::new(0.5, 0.75_f64.sqrt());
                lattice(pitch_mm, reach_mm, up, |i, j| i * i + i * j + j * j)
            }
        }
    }

    /// The same as spots; the first two may be larger, to be told from the others.
    pub fn spots(&self, radii_mm: SpotRadii) -> Vec<Spot> {
        let radius = |i: usize| match i {
            0 => radii_mm.centre,
            1 => radii_mm.orientation,
            _ => radii_mm.others,
        };
        let spots = self.centres().into_iter().enumerate();
        spots.map(|(i, centre)| Spot { centre, radius_mm: radius(i) }).collect()
    }
}

/// Points `pitch (i, 0) + pitch j up` whose distance from the origin, `pitch` times the root of `square(i, j)`, is at most
/// `reach`, by distance and then by angle.
fn lattice(pitch_mm: f64, reach_mm: f64, up: Vector2, square: fn(i64, i64) -> i64) -> Vec<Point2> {
    if pitch_mm.is_nan() || pitch_mm <= 0.0 {
        return Vec::new();
    }
    // A lattice row is at least 0.75^0.5 pitches from the next.
    let most = (reach_mm / pitch_mm * 1.2).clamp(0.0, MOST_ROWS) as i64;
    let within = |s: i64| (s as f64).sqrt() * pitch_mm <= reach_mm * (1.0 + 1e-12);
    let mut points: Vec<(i64, Point2)> = (-most..=most)
        .flat_map(|j| (-most..=most).map(move |i| (i, j)))
        .filter(|&(i, j)| within(square(i, j)))
        .map(|(i, j)| {
            let place = (Vector2::x() * i as f64 + up * j as f64) * pitch_mm;
            (square(i, j), Point2::from(place))
        })
        .collect();
    let angle = |p: &Point2| p.y.atan2(p.x).rem_euclid(TAU);
    points.sort_by(|a, b| a.0.cmp(&b.0).then(angle(&a.1).total_cmp(&angle(&b.1))));
    points.into_iter().map(|(_, p)| p).collect()
}

/// Radii of a pattern's spots, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpotRadii {
    /// Of the first one, in the middle.
    pub centre: f64,
    /// Of the second one, on +x.
    pub orientation: f64,
    /// Of all others.
    pub others: f64,
}

/// A hole of a plate, or a ball on a sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Its centre on the plate, mm.
    pub centre: Point2,
    /// Its radius, mm.
    pub radius_mm: f64,
}

/// What the spots are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpotKind {
    /// Holes right through the plate, at a right angle to it: bright.
    Hole,
    /// Balls, their centres in the plate's middle plane: dark.
    Ball {
        /// Attenuation of the balls less that of the plate, 1/mm.
        attenuation_per_mm: f64,
    },
}

/// A straight scratch or a burr on one face of a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scratch {
    /// One end on the plate, mm.
    pub from: Point2,
    /// The other end, mm.
    pub to: Point2,
    /// Its width, mm.
    pub width_mm: f64,
    /// How deep it is, mm: a bright line; negative is a burr that stands out, a dark line.
    pub depth_mm: f64,
}

/// A plate as it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Plate {
    /// Its thickness, mm.
    pub thickness_mm: f64,
    /// Its attenuation, 1/mm.
    pub attenuation_per_mm: f64,
    /// Half the side of the square plate, mm; usually beyond the picture.
    pub half_side_mm: f64,
    /// What its spots are.
    pub kind: SpotKind,
    /// Its spots as a laboratory knows them; on a perforated plate they do not overlap.
    pub spots: Vec<Spot>,
    /// Numbers of spots that are not there: closed holes, lost balls.
    pub missing: Vec<usize>,
    /// Lines on it; where one crosses a hole it is interrupted.
    pub scratches: Vec<Scratch>,
}

impl Plate {
    /// A perforated plate like the thesis's: 721 holes of 2.5 mm on circles 10 mm apart, the middle one 4.4 mm and the one for
    /// the orientation 3.8 mm wide. Steel of 0.8 mm: it lets 29 % through.
    pub fn concentric() -> Self {
        let radii = SpotRadii { centre: 2.2, orientation: 1.9, others: 1.25 };
        Self::perforated(SpotPattern::Concentric { rings: 15, ring_mm: 10.0 }.spots(radii))
    }

    /// The same plate with other holes.
    pub fn perforated(spots: Vec<Spot>) -> Self {
        Self {
            thickness_mm: 0.8,
            attenuation_per_mm: Material::Steel.attenuation_per_mm(),
            half_side_mm: 170.0,
            kind: SpotKind::Hole,
            spots,
            missing: Vec::new(),
            scratches: Vec::new(),
        }
    }

    /// Steel balls on an acrylic sheet of 1.5 mm.
    pub fn dotted(spots: Vec<Spot>) -> Self {
        let [sheet, ball] = [Material::Acrylic, Material::Steel].map(|m| m.attenuation_per_mm());
        Self {
            thickness_mm: 1.5,
            attenuation_per_mm: sheet,
            kind: SpotKind::Ball { attenuation_per_mm: ball - sheet },
            ..Self::perforated(spots)
        }
    }

    /// What is in the beam, in the plate's frame.
    ///
    /// # Errors
    /// A size or a place that is not finite, or no thickness.
    pub fn absorbers(&self) -> Result<Vec<Absorber>, MeshError> {
        let half = self.thickness_mm / 2.0;
        let mut solid = Prisms::default();
        solid.add_sheet(self.half_side_mm, -half, half);
        let (mut hollow, mut burrs) = (Prisms::default(), Prisms::default());
        let mut absorbers = Vec::new();
        for spot in self.present().map(|(_, spot)| spot) {
            match self.kind {
                SpotKind::Hole => hollow.add_cylinder(&spot.centre, spot.radius_mm, -half, half),
                SpotKind::Ball { attenuation_per_mm } => {
                    let centre = Point3::new(spot.centre.x, spot.centre.y, 0.0);
                    let ball = Surface::Ball(Ball { centre, radius: spot.radius_mm });
                    absorbers.push(Absorber { surface: ball, attenuation_per_mm });
                }
            }
        }
        for scratch in &self.scratches {
            for outline in self.interrupted(scratch) {
                if scratch.depth_mm > 0.0 {
                    hollow.add(&outline, half - scratch.depth_mm.min(self.thickness_mm), half);
                } else {
                    burrs.add(&outline, half, half - scratch.depth_mm);
                }
            }
        }
        let mut add = |mesh: Option<Mesh>, attenuation_per_mm: f64| {
            absorbers
                .extend(mesh.map(|m| Absorber { surface: Surface::Mesh(Arc::new(m)), attenuation_per_mm }));
        };
        add(solid.mesh()?, self.attenuation_per_mm);
        add(hollow.mesh()?, -self.attenuation_per_mm);
        add(burrs.mesh()?, self.attenuation_per_mm);
        Ok(absorbers)
    }

    /// The spots that are there, with their numbers.
    pub fn present(&self) -> impl Iterator<Item = (usize, &Spot)> {
        self.spots.iter().enumerate().filter(|(number, _)| !self.missing.contains(number))
    }

    /// Outlines of the parts of a scratch between the holes.
    fn interrupted(&self, scratch: &Scratch) -> Vec<[Point2; 4]> {
        let along = scratch.to - scratch.from;
        let length = along.norm();
        let Some(along) = along.try_normalize(1e-9) else { return Vec::new() };
        let across = Vector2::new(-along.y, along.x) * (scratch.width_mm / 2.0);
        // The parts of the line that lie in holes, in order.
        let mut holes: Vec<[f64; 2]> = self
            .present()
            .filter(|_| self.kind == SpotKind::Hole)
            .filter_map(|(_, spot)| {
                let to = spot.centre - scratch.from;
                let reach = spot.radius_mm + scratch.width_mm / 2.0;
                let half = (reach * reach - along.perp(&to).powi(2)).max(0.0).sqrt();
                (half > 0.0).then(|| [along.dot(&to) - half, along.dot(&to) + half])
            })
            .collect();
        holes.sort_by(|a, b| a[0].total_cmp(&b[0]));
        holes.push([length, length]);
        let mut parts = Vec::new();
        let mut start = 0.0_f64;
        for [into, out_of] in holes {
            let end = into.min(length);
            if end > start {
                let (a, b) = (scratch.from + along * start, scratch.from + along * end);
                parts.push([a - across, b - across, b + across, a + across]);
            }
            start = start.max(out_of);
        }
        parts
    }

    /// Where the spots that are there appear within the picture, by their numbers.
    pub fn seen(
        &self,
        pose: &Pose,
        view: &TrueFluoroscope,
        distortion: &IntensifierDistortion,
    ) -> Vec<SeenSpot> {
        let last = view.size.map(|n| n as f64 - 1.0);
        let in_picture = |p: &Point2| (0..2).all(|a| p[a] >= 0.0 && p[a] <= last[a]);
        self.present()
            .filter_map(|(number, spot)| {
                let on_plate = |p: Point2| pose.transform(&Point3::new(p.x, p.y, 0.0));
                let world = on_plate(spot.centre);
                let mut outline: Vec<Point2> = match self.kind {
                    SpotKind::Hole => circle(32)
                        .map(|p| Some(view.project(&on_plate(spot.centre + p * spot.radius_mm))?.0))
                        .collect::<Option<_>>()?,
                    SpotKind::Ball { .. } => {
                        shadow_outline(view, &Ball { centre: world, radius: spot.radius_mm })?
                    }
                };
                let ideal = area_centroid(&outline)?;
                outline.iter_mut().for_each(|p| *p = distortion.recorded(p));
                let centroid = area_centroid(&outline)?;
                let recorded = distortion.recorded(&ideal);
                in_picture(&recorded).then_some(SeenSpot { number, world, ideal, recorded, centroid })
            })
            .collect()
    }

    /// The list that a laboratory has of its plate: `hole,x_mm,y_mm,radius_mm`, holes numbered from 0, with missing ones.
    pub fn csv(&self) -> String {
        let mut text = String::from("hole,x_mm,y_mm,radius_mm\n");
        for (number, Spot { centre, radius_mm }) in self.spots.iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{number},{:.4},{:.4},{radius_mm}", centre.x, centre.y);
        }
        text
    }
}

/// Where a spot of a plate truly appears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenSpot {
    /// Its number on the plate, from 0.
    pub number: usize,
    /// Its centre in the laboratory, mm.
    pub world: Point3,
    /// Ideal pixel of the centre of its outline: of a hole the projection of its centre, but of a ball beside that.
    pub ideal: Point2,
    /// The pixel where the intensifier records the point `ideal`.
    pub recorded: Point2,
    /// Centre of the outline as it is recorded. A distortion that bends the outline moves it from `recorded`: a hole of 4 px by
    /// some thousandths of a pixel.
    pub centroid: Point2,
}

/// How a plate is held before an intensifier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlatePlacement {
    /// Turned in its plane, from the detector's `along_x` to its `along_y`, rad.
    pub turn_rad: f64,
    /// Shifted along the detector's axes, mm.
    pub shift_mm: [f64; 2],
    /// Tilted about the detector's `along_x`, then `along_y`, rad.
    pub tilt_rad: [f64; 2],
    /// Distance of its middle plane from the detector, towards the source, mm.
    pub before_mm: f64,
}

impl PlatePlacement {
    /// Clipped onto the detector, straight.
    pub fn on_detector() -> Self {
        Self { turn_rad: 0.0, shift_mm: [0.0; 2], tilt_rad: [0.0; 2], before_mm: 0.0 }
    }

    /// The plate's pose in the laboratory.
    pub fn pose(&self, view: &TrueFluoroscope) -> Pose {
        let axes = [view.along_x, view.along_y, view.along_x.cross(&view.along_y)];
        let detector = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&axes));
        let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), self.tilt_rad[1])
            * Rotation3::from_axis_angle(&Vector3::x_axis(), self.tilt_rad[0]);
        let turn = detector * tilt * Rotation3::from_axis_angle(&Vector3::z_axis(), self.turn_rad);
        let middle = view.centre + view.along_x * self.shift_mm[0] + view.along_y * self.shift_mm[1]
            - view.normal() * self.before_mm;
        Pose::new(UnitQuaternion::from_rotation_matrix(&turn), middle.coords)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Exposure, PosedBody, Scene, biplane, picture};
    use approx::assert_relative_eq;
    use biplane_artifact::Frame;

    /// A view whose ray through the middle meets the detector obliquely, 600 x 600 pixels over 184.6 mm.
    fn view() -> TrueFluoroscope {
        let [view, _] = biplane(90.0);
        TrueFluoroscope { source: Point3::new(30.0, -520.0, -12.0), size: [600, 600], ..view }
    }

    fn bent() -> IntensifierDistortion {
        IntensifierDistortion {
            pincushion_px: 20.0,
            s_shape_px: 8.0,
            ..IntensifierDistortion::none([600, 600])
        }
    }

    fn photographed(
        plate: &Plate,
        pose: &Pose,
        distortion: Option<IntensifierDistortion>,
        samples_per_px: usize,
    ) -> Frame {
        let body = PosedBody::at_rest(*pose, plate.absorbers().unwrap());
        let scene = Scene { bodies: vec![body], ..Scene::default() };
        let exposure = Exposure { distortion, samples_per_px, ..Exposure::ideal() };
        picture(&scene, &view(), &exposure, 1).unwrap()
    }

    /// Centroid of what differs from `ground` within `reach` of a pixel.
    fn centroid(frame: &Frame, about: &Point2, reach: f64, ground: f64) -> Point2 {
        let (mut sum, mut weight) = (Vector2::zeros(), 0.0);
        let range = |c: f64, most: usize| {
            ((c - reach).ceil().max(0.0) as usize)..=((c + reach).floor() as usize).min(most - 1)
        };
        for y in range(about.y, frame.height) {
            for x in range(about.x, frame.width) {
                let w = f64::from(frame.samples[y * frame.width + x]) - ground;
                sum += Vector2::new(x as f64, y as f64) * w;
                weight += w;
            }
        }
        Point2::from(sum / weight)
    }

    /// Grey of a plate without holes near a pixel.
    fn ground(frame: &Frame, at: &Point2) -> f64 {
        f64::from(frame.samples[at.y.round() as usize * frame.width + at.x.round() as usize])
    }

    #[test]
    fn the_concentric_pattern_is_that_of_the_simulated_studies() {
        let spots = Plate::concentric().spots;
        assert_eq!(spots.len(), 721);
        // Lines of calibration/plate.csv of the study "knee-implant" that another program made.
        for (hole, x, y, radius) in [
            (0, 0.0, 0.0, 2.2),
            (1, 10.0, 0.0, 1.9),
            (2, 5.0, 8.6603, 1.25),
            (8, 17.3205, 10.0, 1.25),
            (20, 28.1908, 10.2606, 1.25),
        ] {
            let Spot { centre, radius_mm } = spots[hole];
            assert_relative_eq!(centre, Point2::new(x, y), epsilon = 1e-4);
            assert_eq!(radius_mm, radius);
        }
        assert!(
            Plate::concentric()
                .csv()
                .starts_with("hole,x_mm,y_mm,radius_mm\n0,0.0000,0.0000,2.2\n1,10.0000,")
        );
    }

    #[test]
    fn grids_are_whole_and_start_with_middle_and_orientation() {
        let square = SpotPattern::Square { pitch_mm: 10.0, reach_mm: 50.0 }.centres();
        // Integer points within 5 of the origin (Gauss's circle problem): 81.
        assert_eq!(square.len(), 81);
        let hexagonal = SpotPattern::Hexagonal { pitch_mm: 10.0, reach_mm: 30.0 }.centres();
        // 1 + 6 + 6 + 6 + 12 + 6 points at distances 0, 1, sqrt 3, 2, sqrt 7, 3.
        assert_eq!(hexagonal.len(), 37);
        for centres in [square, hexagonal] {
            assert_eq!(centres[0], Point2::origin());
            assert_eq!(centres[1], Point2::new(10.0, 0.0));
            let nearest = centres[2..].iter().map(|p| (p - centres[1]).norm()).fold(f64::MAX, f64::min);
            assert_relative_eq!(nearest, 10.0, epsilon = 1e-9);
        }
        assert_eq!(SpotPattern::Square { pitch_mm: 0.0, reach_mm: 9.0 }.centres(), []);
    }

    #[test]
    fn holes_appear_where_the_projection_says() {
        let placement =
            PlatePlacement { turn_rad: 0.3, shift_mm: [2.0, -3.0], tilt_rad: [0.05, -0.03], before_mm: 40.0 };
        let plate = Plate { thickness_mm: 2.0, ..Plate::concentric() };
        let pose = placement.pose(&view());
        for distortion in [None, Some(bent())] {
            let frame = photographed(&plate, &pose, distortion, 64);
            let seen =
                plate.seen(&pose, &view(), &distortion.unwrap_or(IntensifierDistortion::none([600, 600])));
            assert!(seen.len() > 200, "{}", seen.len());
            let mut worst = 0.0_f64;
            for spot in seen {
                let reach = 12.0;
                let inside = (0..2).all(|a| spot.recorded[a] > reach && spot.recorded[a] < 599.0 - reach);
                if inside {
                    let between = spot.recorded + Vector2::new(reach, 0.0);
                    let found = centroid(&frame, &spot.recorded, reach, ground(&frame, &between));
                    worst = worst.max((found - spot.centroid).norm());
                }
            }
            assert!(worst < 0.02, "{worst} px, distortion {distortion:?}");
        }
    }

    #[test]
    fn a_plate_on_the_detector_is_seen_at_its_size() {
        let plate = Plate::concentric();
        let placement =
            PlatePlacement { turn_rad: 0.5, shift_mm: [4.0, 1.0], ..PlatePlacement::on_detector() };
        let pose = placement.pose(&view());
        let seen = plate.seen(&pose, &view(), &IntensifierDistortion::none([600, 600]));
        let pixel = view().pixel_mm;
        assert_relative_eq!(
            seen[0].ideal,
            Point2::new(299.5 + 4.0 / pixel, 299.5 + 1.0 / pixel),
            epsilon = 1e-9
        );
        let (sin, cos) = 0.5_f64.sin_cos();
        let along = Vector2::new(cos, sin) * (10.0 / pixel);
        assert_relative_eq!(seen[1].ideal - seen[0].ideal, along, epsilon = 1e-9);
        // Metal and holes: the plate lets exp(-1.54 0.8 / cos) through, a hole all.
        let frame = photographed(&plate, &pose, None, 16);
        let in_hole = ground(&frame, &seen[0].ideal) / 65535.0;
        let on_plate = ground(&frame, &(seen[0].ideal + Vector2::new(16.0, 16.0))) / 65535.0;
        assert!(in_hole > 0.999, "{in_hole}");
        let expected = (-plate.attenuation_per_mm * plate.thickness_mm).exp();
        assert_relative_eq!(on_plate, expected, max_relative = 0.005);
    }

    #[test]
    fn missing_holes_are_not_in_the_picture_but_in_the_list() {
        let plate = Plate { missing: vec![0, 5], ..Plate::concentric() };
        let pose = PlatePlacement::on_detector().pose(&view());
        let seen = plate.seen(&pose, &view(), &IntensifierDistortion::none([600, 600]));
        assert!(seen.iter().all(|s| s.number != 0 && s.number != 5));
        assert_eq!(plate.csv(), Plate::concentric().csv());
        let frame = photographed(&plate, &pose, None, 16);
        assert!(ground(&frame, &Point2::new(299.5, 299.5)) / 65535.0 < 0.35);
    }

    #[test]
    fn scratches_are_bright_burrs_dark_and_neither_touches_a_hole() {
        let line = |y: f64, depth_mm: f64| Scratch {
            from: Point2::new(-60.0, y),
            to: Point2::new(60.0, y),
            width_mm: 0.8,
            depth_mm,
        };
        let plain = Plate::concentric();
        let plate = Plate { scratches: vec![line(0.0, 0.3), line(-4.5, -0.3)], ..plain.clone() };
        let pose = PlatePlacement::on_detector().pose(&view());
        let [before, after] = [&plain, &plate].map(|p| photographed(p, &pose, None, 16));
        let grey = |frame: &Frame, x: f64, y: f64| {
            let place = Vector2::new(x, y) / view().pixel_mm;
            ground(frame, &(Point2::new(299.5, 299.5) + place))
                / ground(&before, &(Point2::new(299.5, 299.5) + place))
        };
        let lets = |mm: f64| (-plain.attenuation_per_mm * mm).exp();
        assert_relative_eq!(grey(&after, 15.0, 0.0), lets(-0.3), max_relative = 0.02);
        assert_relative_eq!(grey(&after, 15.0, -4.5), lets(0.3), max_relative = 0.02);
        // In a hole that the scratch runs through nothing changes.
        assert_relative_eq!(grey(&after, 10.0, 0.0), 1.0, epsilon = 1e-4);
    }

    #[test]
    fn balls_on_a_sheet_are_dark_where_their_shadows_are() {
        let radii = SpotRadii { centre: 2.0, orientation: 1.6, others: 1.0 };
        let plate = Plate::dotted(SpotPattern::Square { pitch_mm: 12.0, reach_mm: 70.0 }.spots(radii));
        let placement = PlatePlacement { turn_rad: -0.2, before_mm: 25.0, ..PlatePlacement::on_detector() };
        let pose = placement.pose(&view());
        let frame = photographed(&plate, &pose, Some(bent()), 64);
        for spot in plate.seen(&pose, &view(), &bent()) {
            let between = spot.recorded + Vector2::new(14.0, 0.0);
            let found = centroid(&frame, &spot.recorded, 14.0, ground(&frame, &between));
            let off = (found - spot.centroid).norm();
            assert!(off < 0.02, "ball {}: {found} instead of {}", spot.number, spot.centroid);
        }
    }
}
