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
use crate::{Absorber, Ball, Exposure, IntensifierDistortion, PosedBody, Scene, Surface, TrueFluoroscope};

/// Why a picture cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PictureError {
    /// A body is not between the source and the picture.
    #[error(
        "a body reaches the laboratory point {point:?} mm, which is not in front of the source or projects more than \
         8000 px from the picture: move the body into the beam"
    )]
    OutOfBeam {
        /// The point, mm.
        point: Point3,
    },
    /// A mesh has a hole, through which rays would enter that never leave.
    #[error(
        "a mesh of {triangles} triangles is not closed: their areas as vectors add up to {open_mm2:.3e} mm^2 instead of \
         nothing: close it, and wind all triangles the same way"
    )]
    Open {
        /// How many triangles it has.
        triangles: usize,
        /// Length of the sum of the triangles' area vectors, mm^2.
        open_mm2: f64,
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

/// The ideal places of recorded pixels.
struct Places<'a> {
    distortion: &'a IntensifierDistortion,
    guess: Point2,
}

impl<'a> Places<'a> {
    fn new(distortion: &'a IntensifierDistortion) -> Self {
        Self { distortion, guess: distortion.centre }
    }

    /// Of a pixel and, per pixel of recorded distance, the change; quick where pixels follow each other.
    fn at(&mut self, x: usize, y: usize) -> (Point2, Matrix2<f64>) {
        let recorded = Point2::new(x as f64, y as f64);
        let found = self.distortion.ideal_with_derivative(&recorded, &self.guess);
        self.guess = found.0 + found.1.column(0);
        found
    }

    /// Of a row of pixels, for what is smooth: every eighth is exact, those between are on straight lines, within
    /// 0.002 px where the rim is shifted by 20 px.
    fn row(&mut self, width: usize, y: usize) -> Vec<Point2> {
        let mut places = Vec::with_capacity(width + 8);
        let mut from = self.at(0, y).0;
        for x in (0..width).step_by(8) {
            let to = self.at(x + 8, y).0;
            let step = (to - from) / 8.0;
            places.extend((0..8).map(|k| from + step * f64::from(k)));
            from = to;
        }
        places.truncate(width);
        places
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
    /// A mesh is not closed, or a body is not in the beam.
    pub fn of_scene(
        scene: &Scene,
        view: &TrueFluoroscope,
        exposure: &Exposure,
    ) -> Result<Self, PictureError> {
        let none = IntensifierDistortion::none(view.size);
        let camera = Camera { view, distortion: exposure.distortion.as_ref().unwrap_or(&none) };
        scene.bodies.iter().flat_map(|b| &b.absorbers).try_for_each(closed)?;
        let moves = exposure.time_s > 0.0 && scene.bodies.iter().any(PosedBody::moves);
        let parts = Lattice::new(exposure.samples_per_px).parts(if moves { exposure.moments } else { 1 });

        // What the tissue lets through, and the length of each ray over its depth.
        let mut values = Vec::with_capacity(view.size[0] * view.size[1]);
        let mut lengths = Vec::with_capacity(view.size[0] * view.size[1]);
        let mut places = Places::new(camera.distortion);
        for y in 0..view.size[1] {
            for ideal in places.row(view.size[0], y) {
                let ray = direction(view, &ideal);
                let length = ray.norm();
                let depth: f64 =
                    scene.tissue.iter().map(|e| e.attenuation_per_mm * e.chord(&view.source, &ray)).sum();
                values.push((-(depth * length) as f32).exp());
                lengths.push(length as f32);
            }
        }

        let mut through = vec![1.0_f32; values.len()];
        for (moment, lattice) in parts.iter().enumerate() {
            let time_s = exposure.time_s * ((moment as f64 + 0.5) / parts.len() as f64 - 0.5);
            absorb(
                &drawn(lattice, &scene.bodies, time_s, &camera)?,
                &lengths,
                parts.len(),
                view,
                &mut through,
            );
        }
        for (value, through) in values.iter_mut().zip(through) {
            *value *= through;
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
        let offsets = lattice.offsets_px();
        let mut values = Vec::with_capacity(view.size[0] * view.size[1]);
        for y in 0..view.size[1] {
            for x in 0..view.size[0] {
                let (ideal, change) = places.at(x, y);
                let sum: f64 = offsets.iter().map(|offset| transmitted(&(ideal + change * offset))).sum();
                values.push((sum / offsets.len() as f64) as f32);
            }
        }
        Self { size: view.size, values, spot_px_per_mm: 0.0 }
    }
}

/// Area that may be open for rounding, as a share of the surface.
const OPEN_SHARE: f64 = 1e-9;

/// The area vectors of a closed surface add up to nothing, whatever its shape.
fn closed(absorber: &Absorber) -> Result<(), PictureError> {
    let Surface::Mesh(mesh) = &absorber.surface else { return Ok(()) };
    let triangles = mesh.triangles().len();
    let (mut sum, mut area) = (Vector3::zeros(), 0.0);
    for triangle in 0..triangles {
        let vector = mesh.area_vector(triangle);
        sum += vector;
        area += vector.norm();
    }
    let open_mm2 = sum.norm();
    if open_mm2 > OPEN_SHARE * area { Err(PictureError::Open { triangles, open_mm2 }) } else { Ok(()) }
}

/// The samples with the bodies as they are at a moment of the exposure.
fn drawn(
    lattice: &Lattice,
    bodies: &[PosedBody],
    time_s: f64,
    camera: &Camera,
) -> Result<Samples, PictureError> {
    let poses: Vec<Pose> = bodies.iter().map(|b| b.pose_at(time_s)).collect();
    let mut whole: Option<Window> = None;
    let mut join = |window: Option<Window>| {
        whole = match (whole, window) {
            (Some(a), Some(b)) => Some(a.joined(b)),
            (a, b) => a.or(b),
        };
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
    let mut samples = Samples::new(whole.unwrap_or(Window { first: [0; 2], last: [0; 2] }), lattice);
    for (projected, pose, attenuation) in meshes {
        samples.add_mesh(&projected, pose, camera, attenuation);
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
    let offsets = samples.lattice.offsets_px();
    let from_centre = camera.view.source - ball.centre;
    let c = from_centre.norm_squared() - ball.radius * ball.radius;
    let mut places = Places::new(camera.distortion);
    let whole = samples.window;
    for y in window.first[1]..window.last[1] {
        for x in window.first[0]..window.last[0] {
            let (ideal, change) = places.at(x, y);
            let start = ((y - whole.first[1]) * whole.width() + x - whole.first[0]) * offsets.len();
            for (sample, offset) in samples.values[start..].iter_mut().zip(&offsets) {
                let ray = direction(camera.view, &(ideal + change * offset));
                let (a, b) = (ray.norm_squared(), from_centre.dot(&ray));
                let discriminant = b * b - a * c;
                if discriminant > 0.0 {
                    *sample += (attenuation_per_mm * 2.0 * discriminant.sqrt() / a) as f32;
                }
            }
        }
    }
}

/// Takes from the transmission what samples absorb in one of `moments` moments. `lengths` of rays are for 1 mm of depth.
fn absorb(samples: &Samples, lengths: &[f32], moments: usize, view: &TrueFluoroscope, through: &mut [f32]) {
    let (window, n) = (samples.window, samples.lattice.len());
    let share = 1.0 / (moments * n) as f32;
    let mut of_pixels = samples.values.chunks_exact(n);
    for y in window.first[1]..window.last[1] {
        let pixels = y * view.size[0] + window.first[0]..y * view.size[0] + window.last[0];
        let rays = through[pixels.clone()].iter_mut().zip(&lengths[pixels]);
        for ((through, length), of_pixel) in rays.zip(of_pixels.by_ref()) {
            if of_pixel.iter().any(|v| *v != 0.0) {
                *through -= share * of_pixel.iter().map(|v| 1.0 - (-v * length).exp()).sum::<f32>();
            }
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
                    let sum: Vector3 = mesh.vertices().iter().map(|v| v.coords).sum();
                    Point3::from(sum / mesh.vertices().len() as f64)
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
