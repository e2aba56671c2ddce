//! Frames of metal beads at known places, by which a laboratory finds where its fluoroscopes stand (the thesis's 2.2.3).
//!
//! The frame of the beads is the laboratory's frame. A bead's shadow is an ellipse whose centre is **not** the projection of
//! the bead's centre; both are given.

use std::f64::consts::TAU;
use std::fmt::Write;

use biplane_geometry::{Point2, Point3, Pose, Vector3};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::shadow::{area_centroid, shadow_outline};
use crate::{
    Absorber, Ball, Ellipsoid, IntensifierDistortion, Material, PosedBody, Scene, Surface, TrueFluoroscope,
};

/// Beads, and the acrylic tube that holds them, in the laboratory frame.
#[derive(Debug, Clone, PartialEq)]
pub struct BeadFrame {
    /// The beads, mm.
    pub beads: Vec<Ball>,
    /// Attenuation of the beads less that of what they are in, 1/mm.
    pub attenuation_per_mm: f64,
    /// The tube; none where beads float in the air.
    pub tube: Option<Tube>,
}

/// A tube about the laboratory's z axis, longer than the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tube {
    /// Outer radius, mm.
    pub radius_mm: f64,
    /// Thickness of its wall, mm.
    pub wall_mm: f64,
    /// Its attenuation, 1/mm.
    pub attenuation_per_mm: f64,
}

/// What a frame is to be like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeadLayout {
    /// Number of beads, 8 to 1000; the last two are larger.
    pub count: usize,
    /// Height of the frame, mm; the beads are on rings of a third of it in radius.
    pub height_mm: f64,
    /// Radius of the beads, mm.
    pub radius_mm: f64,
    /// Radius of the last two, mm.
    pub large_radius_mm: f64,
    /// Least gap between the shadows of any two beads in each view, ideal px.
    pub least_gap_px: f64,
    /// Least gap between a shadow and the largest circle in the picture, ideal px: room for the intensifier's round border
    /// and for pincushion distortion.
    pub border_gap_px: f64,
}

impl BeadLayout {
    /// 30 steel balls of 3 mm, two of them 5 mm, in 150 mm.
    pub fn large() -> Self {
        Self {
            count: 30,
            height_mm: 150.0,
            radius_mm: 1.5,
            large_radius_mm: 2.5,
            least_gap_px: 8.0,
            border_gap_px: 25.0,
        }
    }

    /// The same number of smaller ones, 2 mm and 4 mm, in 100 mm.
    pub fn small() -> Self {
        Self { height_mm: 100.0, radius_mm: 1.0, large_radius_mm: 2.0, ..Self::large() }
    }
}

/// Why there is no frame of a layout.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum BeadFrameError {
    /// Fewer beads than are spread over space, or more than a frame holds.
    #[error("{count} beads; a frame has 8 to 1000")]
    Count {
        /// As given.
        count: usize,
    },
    /// The shadows do not fit.
    #[error(
        "no place for {count} beads in a frame of {height_mm} mm with {least_gap_px} px between their shadows; \
             ask for fewer beads or a smaller gap"
    )]
    NoRoom {
        /// As given.
        count: usize,
        /// As given.
        height_mm: f64,
        /// As given.
        least_gap_px: f64,
    },
}

/// Frames begun before a layout is given up.
const FRAMES: usize = 100;
/// Places tried for one bead of a frame.
const PLACES: usize = 60;

impl BeadFrame {
    /// Beads on rings around the z axis, each at a random place of its own sector, two larger ones near the top and the bottom;
    /// spread over all three directions, so never nearly in a plane. Coordinates are whole micrometres.
    ///
    /// # Errors
    /// A layout that is none, or whose shadows do not fit into the views.
    pub fn drawn(layout: &BeadLayout, views: &[TrueFluoroscope], seed: u64) -> Result<Self, BeadFrameError> {
        let BeadLayout { count, height_mm, least_gap_px, .. } = *layout;
        if !(8..=1000).contains(&count) {
            return Err(BeadFrameError::Count { count });
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let beads = (0..FRAMES)
            .find_map(|_| beads_drawn(layout, views, &mut rng))
            .ok_or(BeadFrameError::NoRoom { count, height_mm, least_gap_px })?;
        let [acrylic, steel] = [Material::Acrylic, Material::Steel].map(|m| m.attenuation_per_mm());
        let (radius_mm, wall_mm) = (height_mm / 3.0 + 1.5, 3.0);
        let tube = Tube { radius_mm, wall_mm, attenuation_per_mm: acrylic };
        Ok(Self { beads, attenuation_per_mm: steel - acrylic, tube: Some(tube) })
    }

    /// What is in the beam.
    pub fn scene(&self) -> Scene {
        let bead = |&ball: &Ball| Absorber {
            surface: Surface::Ball(ball),
            attenuation_per_mm: self.attenuation_per_mm,
        };
        let beads = PosedBody::at_rest(Pose::identity(), self.beads.iter().map(bead).collect());
        let cylinder = |radius: f64, attenuation_per_mm: f64| Ellipsoid {
            centre: Point3::origin(),
            semi_axes: Vector3::new(radius, radius, f64::INFINITY),
            attenuation_per_mm,
        };
        let wall = |t: &Tube| {
            [
                cylinder(t.radius_mm, t.attenuation_per_mm),
                cylinder(t.radius_mm - t.wall_mm, -t.attenuation_per_mm),
            ]
        };
        Scene { bodies: vec![beads], tissue: self.tube.iter().flat_map(wall).collect() }
    }

    /// Where the beads appear whose shadows are whole within the picture's rectangle, by their numbers.
    pub fn seen(&self, view: &TrueFluoroscope, distortion: &IntensifierDistortion) -> Vec<SeenBead> {
        let cones: Vec<_> = self.beads.iter().map(|b| Cone::around(view, b)).collect();
        self.beads
            .iter()
            .enumerate()
            .filter_map(|(index, bead)| {
                let cone = cones[index].as_ref()?;
                let (projected, depth) = view.project(&bead.centre)?;
                let mut outline = shadow_outline(view, bead)?;
                let shadow = area_centroid(&outline)?;
                outline.iter_mut().for_each(|p| *p = distortion.recorded(p));
                let shadow_recorded = area_centroid(&outline)?;
                let radius_px = bead.radius * view.source_to_detector_mm() / (depth * view.pixel_mm);
                let whole = (0..2).all(|a| {
                    let last = view.size[a] as f64 - 1.0;
                    shadow_recorded[a] >= radius_px && shadow_recorded[a] <= last - radius_px
                });
                let overlaps = cones.iter().enumerate().filter(|(other, _)| *other != index);
                let overlaps = overlaps
                    .filter(|(_, c)| c.as_ref().is_some_and(|c| c.meets(cone)))
                    .map(|(other, _)| other + 1)
                    .collect();
                whole.then(|| SeenBead {
                    number: index + 1,
                    projected,
                    shadow,
                    projected_recorded: distortion.recorded(&projected),
                    shadow_recorded,
                    radius_px,
                    overlaps,
                })
            })
            .collect()
    }

    /// The list that a laboratory has of its beads: `bead,x_mm,y_mm,z_mm,radius_mm`, numbered from 1; places to whole
    /// micrometres, as [`BeadFrame::drawn`] makes them.
    pub fn csv(&self) -> String {
        let mut text = String::from("bead,x_mm,y_mm,z_mm,radius_mm\n");
        for (index, Ball { centre, radius }) in self.beads.iter().enumerate() {
            // Writing to a String cannot fail.
            let _ =
                writeln!(text, "{},{:.3},{:.3},{:.3},{radius:.2}", index + 1, centre.x, centre.y, centre.z);
        }
        text
    }
}

/// One frame; `None` where a bead found no place.
fn beads_drawn(
    layout: &BeadLayout,
    views: &[TrueFluoroscope],
    rng: &mut Xoshiro256PlusPlus,
) -> Option<Vec<Ball>> {
    let small = layout.count - 2;
    // About 7 to a ring, as laboratories' frames of 30 have; at least two rings.
    let rings = small.div_ceil(7).max(2);
    let (ring_radius, height) = (layout.height_mm / 3.0, layout.height_mm);
    let mut beads: Vec<Ball> = Vec::with_capacity(layout.count);
    for index in 0..layout.count {
        let mut place = || {
            let mut between = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
            if index >= small {
                // The larger ones: above and below the rings, inside them.
                let (r, angle) = (ring_radius * between(0.1, 0.7), between(0.0, TAU));
                let z = height * between(0.43, 0.45) * if index == small { 1.0 } else { -1.0 };
                return Ball {
                    centre: rounded(r * angle.cos(), r * angle.sin(), z),
                    radius: layout.large_radius_mm,
                };
            }
            let (ring, first) = (index * rings / small, |ring: usize| (ring * small).div_ceil(rings));
            let in_ring = (first(ring + 1) - first(ring)) as f64;
            let sector = (index - first(ring)) as f64 + 0.5 * (ring % 2) as f64;
            let angle = TAU * (sector + between(-0.45, 0.45)) / in_ring;
            let step = 0.72 * height / (rings as f64 - 1.0);
            let z = -0.36 * height + step * (ring as f64 + between(-0.12, 0.12));
            let r = ring_radius * between(0.94, 1.04);
            Ball { centre: rounded(r * angle.cos(), r * angle.sin(), z), radius: layout.radius_mm }
        };
        let bead = (0..PLACES)
            .map(|_| place())
            .find(|bead| views.iter().all(|view| is_clear(view, bead, &beads, layout)))?;
        beads.push(bead);
    }
    Some(beads)
}

/// A place to whole micrometres, as a list of beads is written.
fn rounded(x: f64, y: f64, z: f64) -> Point3 {
    Point3::new(x, y, z).map(|c| (c * 1000.0).round() / 1000.0)
}

/// Whether a bead's shadow keeps its distance from the others' and from the round border of the picture.
fn is_clear(view: &TrueFluoroscope, bead: &Ball, others: &[Ball], layout: &BeadLayout) -> bool {
    let shadow = |b: &Ball| {
        let (at, depth) = view.project(&b.centre)?;
        Some((at, b.radius * view.source_to_detector_mm() / (depth * view.pixel_mm)))
    };
    let Some((at, radius)) = shadow(bead) else { return false };
    let [w, h] = view.size.map(|n| n as f64);
    let middle = Point2::new((w - 1.0) / 2.0, (h - 1.0) / 2.0);
    (at - middle).norm() + radius + layout.border_gap_px <= w.min(h) / 2.0
        && others.iter().filter_map(shadow).all(|(p, r)| (p - at).norm() >= r + radius + layout.least_gap_px)
}

/// The cone of rays that meet a ball.
struct Cone {
    axis: Vector3,
    half_angle: f64,
}

impl Cone {
    fn around(view: &TrueFluoroscope, ball: &Ball) -> Option<Self> {
        let to = ball.centre - view.source;
        let sine = ball.radius / to.norm();
        (sine < 1.0).then(|| Self { axis: to.normalize(), half_angle: sine.asin() })
    }

    fn meets(&self, other: &Self) -> bool {
        self.axis.angle(&other.axis) < self.half_angle + other.half_angle
    }
}

/// Where a bead truly appears.
#[derive(Debug, Clone, PartialEq)]
pub struct SeenBead {
    /// Its number, from 1.
    pub number: usize,
    /// Ideal pixel of its centre's projection.
    pub projected: Point2,
    /// Ideal pixel of the centre of its shadow's outline.
    pub shadow: Point2,
    /// The pixel where the intensifier records its centre's projection.
    pub projected_recorded: Point2,
    /// Centre of its shadow's outline as the intensifier records it. It is not where the point `shadow` is recorded, since a
    /// distortion that bends the outline moves its centre: by 0.02 px with 20 px of pincushion at the rim and a radius of 10 px.
    pub shadow_recorded: Point2,
    /// About the radius of its shadow, px.
    pub radius_px: f64,
    /// Numbers of beads whose shadows meet this one's.
    pub overlaps: Vec<usize>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Exposure, biplane, picture};
    use biplane_geometry::Vector2;

    #[test]
    fn frames_are_spread_and_keep_their_distances() {
        let views = biplane(90.0);
        for layout in [BeadLayout::large(), BeadLayout::small()] {
            for seed in 0..20 {
                let frame = BeadFrame::drawn(&layout, &views, seed).unwrap();
                assert_eq!(frame.beads.len(), 30);
                assert!(frame.beads[28..].iter().all(|b| b.radius == layout.large_radius_mm));
                // Not nearly in a plane: the spread along the thinnest direction is a fifth of the height.
                let points = nalgebra::Matrix3xX::from_iterator(
                    30,
                    frame.beads.iter().flat_map(|b| b.centre.coords.iter().copied().collect::<Vec<_>>()),
                );
                let mean = points.column_mean();
                let centred = nalgebra::Matrix3xX::from_fn(30, |i, j| points[(i, j)] - mean[i]);
                let thinnest = (centred.singular_values().min().powi(2) / 30.0).sqrt();
                assert!(thinnest > 0.2 * layout.height_mm, "{thinnest}");
                for view in &views {
                    let seen = frame.seen(view, &IntensifierDistortion::none(view.size));
                    assert_eq!(seen.len(), 30);
                    for (i, a) in seen.iter().enumerate() {
                        assert!(a.overlaps.is_empty());
                        for b in &seen[..i] {
                            let gap = (a.projected - b.projected).norm() - a.radius_px - b.radius_px;
                            assert!(gap >= layout.least_gap_px - 1e-9, "{gap}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn the_same_seed_draws_the_same_frame() {
        let drawn = |seed| BeadFrame::drawn(&BeadLayout::large(), &biplane(70.0), seed).unwrap();
        assert_eq!(drawn(3), drawn(3));
        assert_ne!(drawn(3), drawn(4));
    }

    #[test]
    fn layouts_that_cannot_be_are_refused() {
        for count in [7, usize::MAX] {
            let layout = BeadLayout { count, ..BeadLayout::large() };
            assert_eq!(BeadFrame::drawn(&layout, &[], 1), Err(BeadFrameError::Count { count }));
        }
        let crowded = BeadLayout { least_gap_px: 200.0, ..BeadLayout::large() };
        let refused = BeadFrame::drawn(&crowded, &biplane(90.0), 1);
        assert!(matches!(refused, Err(BeadFrameError::NoRoom { .. })), "{refused:?}");
    }

    #[test]
    fn the_list_is_in_the_form_of_the_simulated_studies_and_exact() {
        let frame = BeadFrame::drawn(&BeadLayout::large(), &biplane(90.0), 9).unwrap();
        let csv = frame.csv();
        let mut lines = csv.lines();
        assert_eq!(lines.next(), Some("bead,x_mm,y_mm,z_mm,radius_mm"));
        for (index, (line, bead)) in lines.zip(&frame.beads).enumerate() {
            let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
            assert_eq!(numbers[0] as usize, index + 1);
            assert_eq!(Point3::new(numbers[1], numbers[2], numbers[3]), bead.centre);
            assert_eq!(numbers[4], bead.radius);
        }
    }

    #[test]
    fn shadows_in_the_picture_are_where_the_truth_says() {
        let [view, other] = biplane(90.0);
        let frame = BeadFrame {
            tube: None,
            ..BeadFrame::drawn(&BeadLayout::large(), &[view.clone(), other], 2).unwrap()
        };
        let distortion = IntensifierDistortion {
            pincushion_px: 20.0,
            s_shape_px: 8.0,
            ..IntensifierDistortion::none(view.size)
        };
        let exposure = Exposure { distortion: Some(distortion), samples_per_px: 16, ..Exposure::ideal() };
        let picture = picture(&frame.scene(), &view, &exposure, 1).unwrap();
        for bead in frame.seen(&view, &distortion) {
            let reach = bead.radius_px + 3.0;
            let (mut sum, mut weight) = (Vector2::zeros(), 0.0);
            let at = bead.shadow_recorded;
            for y in (at.y - reach) as usize..=(at.y + reach) as usize {
                for x in (at.x - reach) as usize..=(at.x + reach) as usize {
                    let w = 1.0 - f64::from(picture.samples[y * picture.width + x]) / 65535.0;
                    sum += Vector2::new(x as f64, y as f64) * w;
                    weight += w;
                }
            }
            let found = Point2::from(sum / weight);
            assert!((found - at).norm() < 0.02, "bead {}: {found} instead of {at}", bead.number);
        }
    }

    #[test]
    fn beads_in_a_line_with_the_source_overlap() {
        let [view, _] = biplane(90.0);
        let ball = |y: f64| Ball { centre: Point3::new(0.0, y, 0.0), radius: 1.5 };
        let aside = Ball { centre: Point3::new(20.0, 0.0, 0.0), radius: 1.5 };
        let frame =
            BeadFrame { beads: vec![ball(-30.0), aside, ball(40.0)], attenuation_per_mm: 1.0, tube: None };
        let seen = frame.seen(&view, &IntensifierDistortion::none(view.size));
        let overlaps: Vec<_> = seen.iter().map(|b| b.overlaps.clone()).collect();
        assert_eq!(overlaps, [vec![3], vec![], vec![1]]);
    }
}
