//! What part of the radiation gets through a scene to each pixel: Beer and Lambert's law, before any fault but the bending
//! of the picture and the motion of the bodies.
//!
//! `T = mean over a pixel's samples and the exposure's moments of exp(-sum attenuation length)`. The mean is taken after
//! the exponential, as the detector does, so a half-covered pixel has half of the light.
//!
//! **Bending** is not done by resampling: corners of triangles are drawn where they are recorded, and rays of balls are
//! those of their recorded samples.

use biplane_geometry::{Point2, Point3, Pose, Vector3};
use nalgebra::Matrix2;

use crate::raster::{Camera, Lattice, Projected, Samples, Window, window};
use crate::{Ball, Exposure, IntensifierDistortion, PosedBody, Scene, Surface, TrueFluoroscope};

/// Why a picture cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PictureError {
    /// A body is not between the source and the picture.
    #[error(
        "a body reaches the laboratory point {point:?} mm, which is not in front of the source or projects more than \
         32000 px from the picture: move the body into the beam"
    )]
    OutOfBeam {
        /// The point, mm.
        point: Point3,
    },
    /// A ball holds the source.
    #[error(
        "the ball of {radius} mm about the laboratory point {centre:?} mm holds the source: move it away"
    )]
    AroundSource {
        /// Its centre, mm.
        centre: Point3,
        /// Its radius, mm.
        radius: f64,
    },
}

/// Parts of the radiation that get through, row by row of recorded pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Transmission {
    /// Columns and rows.
    pub size: [usize; 2],
    /// 0 to 1, `values[y * size[0] + x]`.
    pub values: Vec<f32>,
    /// Blur of a focal spot of 1 mm at the mean depth of the bodies: its width on the picture, px. What is nearer to the
    /// source is blurred more, which is left out.
    pub spot_px_per_mm: f64,
}

/// The ideal place of recorded pixels.
struct Places<'a> {
    distortion: &'a IntensifierDistortion,
    last: Point2,
}

impl Places<'_> {
    /// Of the pixel and, per pixel of recorded distance, the change; quick where pixels follow each other.
    fn at(&mut self, x: usize, y: usize) -> (Point2, Matrix2<f64>) {
        let recorded = Point2::new(x as f64, y as f64);
        let found = self.distortion.ideal_with_derivative(&recorded, &self.last);
        self.last = found.0 + found.1.column(0);
        found
    }

    fn new(distortion: &IntensifierDistortion) -> Places<'_> {
        Places { distortion, last: distortion.centre }
    }
}

/// From the source to an ideal pixel, one millimetre in depth.
fn direction(view: &TrueFluoroscope, ideal: &Point2) -> Vector3 {
    (view.detector_point(ideal) - view.source) / view.source_to_detector_mm()
}

impl Transmission {
    /// Of a scene.
    ///
    /// # Errors
    /// A body is not in the beam.
    pub fn of_scene(
        scene: &Scene,
        view: &TrueFluoroscope,
        exposure: &Exposure,
    ) -> Result<Self, PictureError> {
        let none = IntensifierDistortion::none(view.size);
        let camera = Camera { view, distortion: exposure.distortion.as_ref().unwrap_or(&none) };
        let lattice = Lattice::new(exposure.samples_per_px);
        let lasts = exposure.time_s > 0.0;
        let (moving, resting): (Vec<&PosedBody>, Vec<&PosedBody>) =
            scene.bodies.iter().partition(|b| lasts && b.moves());
        let empty = Samples::new(Window { first: [0; 2], last: [0; 2] }, &lattice);
        let still = drawn(&empty, &resting, 0.0, &camera)?;

        let moments = if moving.is_empty() { 1 } else { exposure.moments.max(1) };
        let mut values = vec![1.0_f32; view.size[0] * view.size[1]];
        for moment in 0..moments {
            let time_s = exposure.time_s * ((moment as f64 + 0.5) / moments as f64 - 0.5);
            let samples = drawn(&still, &moving, time_s, &camera)?;
            absorb(&samples, &camera, moments as f32, &mut values);
        }
        if !scene.tissue.is_empty() {
            let mut places = Places::new(camera.distortion);
            for (index, value) in values.iter_mut().enumerate() {
                let ray = direction(view, &places.at(index % view.size[0], index / view.size[0]).0);
                let through = |e: &crate::Ellipsoid| e.attenuation_per_mm * e.chord(&view.source, &ray);
                let depth: f64 = scene.tissue.iter().map(through).sum();
                *value *= (-(depth * ray.norm()) as f32).exp();
            }
        }
        Ok(Self { size: view.size, values, spot_px_per_mm: spot_px_per_mm(scene, view) })
    }

    /// Of a thin thing that lies on the detector, as a perforated plate: `transmitted` says what part gets through at an
    /// ideal pixel, and is averaged over each pixel's samples.
    pub fn on_detector(
        view: &TrueFluoroscope,
        exposure: &Exposure,
        mut transmitted: impl FnMut(&Point2) -> f64,
    ) -> Self {
        let none = IntensifierDistortion::none(view.size);
        let mut places = Places::new(exposure.distortion.as_ref().unwrap_or(&none));
        let lattice = Lattice::new(exposure.samples_per_px);
        let offsets: Vec<_> = (0..lattice.rows()).map(|row| lattice.offset(row)).collect();
        let mut values = Vec::with_capacity(view.size[0] * view.size[1]);
        for y in 0..view.size[1] {
            for x in 0..view.size[0] {
                let (ideal, change) = places.at(x, y);
                let at = |o: &[f64; 2]| ideal + change * nalgebra::Vector2::from(*o);
                let sum: f64 = offsets.iter().map(|o| transmitted(&at(o))).sum();
                values.push((sum / offsets.len() as f64) as f32);
            }
        }
        Self { size: view.size, values, spot_px_per_mm: 0.0 }
    }
}

/// Samples with bodies added that are at a moment of the exposure.
fn drawn(
    samples: &Samples,
    bodies: &[&PosedBody],
    time_s: f64,
    camera: &Camera,
) -> Result<Samples, PictureError> {
    let poses: Vec<Pose> = bodies.iter().map(|b| b.pose_at(time_s)).collect();
    let mut joined = samples.window;
    let mut join = |window: Option<Window>| {
        if let Some(window) = window {
            joined = if joined.width() == 0 { window } else { joined.joined(window) };
        }
    };
    let (mut meshes, mut balls) = (Vec::new(), Vec::new());
    for (body, pose) in bodies.iter().zip(&poses) {
        for absorber in &body.absorbers {
            match &absorber.surface {
                Surface::Mesh(mesh) => {
                    let projected = Projected::new(mesh, pose, camera)?;
                    join(projected.window());
                    meshes.push((projected, pose, absorber.attenuation_per_mm));
                }
                Surface::Ball(ball) => {
                    let placed = Ball { centre: pose.transform(&ball.centre), radius: ball.radius };
                    let window = ball_window(&placed, camera)?;
                    join(window);
                    balls.extend(window.map(|w| (placed, w, absorber.attenuation_per_mm)));
                }
            }
        }
    }
    let mut samples = samples.widened(joined);
    for (projected, pose, attenuation) in meshes {
        if camera.distortion.is_none() {
            samples.add_mesh(&projected, attenuation);
        } else {
            samples.add_mesh_bent(&projected, pose, camera, attenuation);
        }
    }
    for (ball, window, attenuation) in balls {
        add_ball(&mut samples, &ball, window, camera, attenuation);
    }
    Ok(samples)
}

/// The pixels that a ball may touch.
fn ball_window(ball: &Ball, camera: &Camera) -> Result<Option<Window>, PictureError> {
    if (ball.centre - camera.view.source).norm() <= ball.radius {
        return Err(PictureError::AroundSource { centre: ball.centre, radius: ball.radius });
    }
    let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in 0..8 {
        let side = |axis: usize| if corner >> axis & 1 == 0 { -ball.radius } else { ball.radius };
        let point = ball.centre + Vector3::new(side(0), side(1), side(2));
        let (pixel, _) = camera.project(&point).ok_or(PictureError::OutOfBeam { point })?;
        for axis in 0..2 {
            least[axis] = least[axis].min(pixel[axis]);
            most[axis] = most[axis].max(pixel[axis]);
        }
    }
    Ok(window(least, most, camera.view.size))
}

/// Adds a ball by the chords of its samples' rays.
fn add_ball(samples: &mut Samples, ball: &Ball, window: Window, camera: &Camera, attenuation_per_mm: f64) {
    let offsets: Vec<_> = (0..samples.lattice.rows()).map(|row| samples.lattice.offset(row)).collect();
    let from_centre = camera.view.source - ball.centre;
    let c = from_centre.norm_squared() - ball.radius * ball.radius;
    let mut places = Places::new(camera.distortion);
    let whole = samples.window;
    for y in window.first[1]..window.last[1] {
        for x in window.first[0]..window.last[0] {
            let (ideal, change) = places.at(x, y);
            for (row, offset) in offsets.iter().enumerate() {
                let ray = direction(camera.view, &(ideal + change * nalgebra::Vector2::from(*offset)));
                let (a, b) = (ray.norm_squared(), from_centre.dot(&ray));
                let discriminant = b * b - a * c;
                if discriminant > 0.0 {
                    let row = (y - whole.first[1]) * offsets.len() + row;
                    samples.values[row * whole.width() + x - whole.first[0]] +=
                        (attenuation_per_mm * 2.0 * discriminant.sqrt() / a) as f32;
                }
            }
        }
    }
}

/// Takes from the transmission what samples absorb in one of `moments` moments.
fn absorb(samples: &Samples, camera: &Camera, moments: f32, values: &mut [f32]) {
    let (window, rows) = (samples.window, samples.lattice.rows());
    if window.width() == 0 {
        return;
    }
    let share = 1.0 / (moments * rows as f32);
    let mut places = Places::new(camera.distortion);
    for (y, of_row) in samples.values.chunks_exact(window.width() * rows).enumerate() {
        for x in 0..window.width() {
            let column = of_row[x..].iter().step_by(window.width());
            if column.clone().all(|&v| v == 0.0) {
                continue;
            }
            let at = [window.first[0] + x, window.first[1] + y];
            let length = direction(camera.view, &places.at(at[0], at[1]).0).norm() as f32;
            let absorbed: f32 = column.map(|v| 1.0 - (-v * length).exp()).sum();
            values[at[1] * camera.view.size[0] + at[0]] -= absorbed * share;
        }
    }
}

/// Width on the picture of a focal spot of 1 mm, seen through a pinhole at the mean depth of the bodies.
fn spot_px_per_mm(scene: &Scene, view: &TrueFluoroscope) -> f64 {
    let depths: Vec<f64> = scene
        .bodies
        .iter()
        .flat_map(|body| body.absorbers.iter().map(move |a| (body, a)))
        .map(|(body, absorber)| {
            let middle = match &absorber.surface {
                Surface::Mesh(mesh) => {
                    let (low, high) = mesh.bounding_box();
                    nalgebra::center(&low, &high)
                }
                Surface::Ball(ball) => ball.centre,
            };
            (body.pose.transform(&middle) - view.source).dot(&view.normal())
        })
        .collect();
    if depths.is_empty() {
        return 0.0;
    }
    let depth = depths.iter().sum::<f64>() / depths.len() as f64;
    (view.source_to_detector_mm() / depth - 1.0).max(0.0) / view.pixel_mm
}
