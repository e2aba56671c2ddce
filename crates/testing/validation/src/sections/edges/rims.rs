//! Rims of smooth X-rayed bodies: how far inside the true outline the steepest place of the picture lies.
//!
//! Just inside the outline of a smooth body a ray passes through `sqrt(8 r d)` of it, `d` inside, `r` the body's radius of curvature along the ray.
//! So the radiation falls by `exp(-k sqrt(d / s))`, `k = mu sqrt(8 r s)`, and blurred by `s` it is steepest where
//! `integral over u > 0 of exp(-k u) exp(-(x - u^2)^2 / 2)` is largest, `x = d / s`: at 0.765 blurs for weak absorption (`k = 0`), at the outline for
//! strong. That is what the pictures are held against.

use std::sync::Arc;

use biplane_geometry::{Curve, EdgePoint, Mesh, Point3, Pose, Vector3};
use biplane_phantom::{
    Absorber, Ball, Exposure, Material, PosedBody, Scene, Solid, Surface, TrueFluoroscope, ball_mesh,
    biplane, ideal_outline, picture,
};
use biplane_segmentation::{SegmentParams, curves};
use nalgebra::UnitQuaternion;
use rayon::prelude::*;

use crate::plot::{Panel, Series, lines};
use crate::sections::SectionError;
use crate::true_outline::TrueOutline;
use crate::{Cell, Column, Lab, Plot, Row, SceneError, Table};

/// A body before the middle of a fluoroscope.
#[derive(Debug, Clone, Copy)]
enum Shape {
    /// An ellipsoid of revolution about the ray: its radius in the picture, and its half length along the ray, mm.
    Ellipsoid(f64, f64),
    /// A plate across the ray: its radius and thickness, mm, and whether its wall runs along the rays or along the axis.
    Plate(f64, f64, bool),
}

/// A picture of a body.
#[derive(Debug, Clone, Copy)]
struct Case {
    label: &'static str,
    shape: Shape,
    material: Material,
    /// Blur of the detector, px; that of the focal spot is 0.56 px.
    detector_px: f64,
    smoothing_px: f64,
}

const fn case(
    label: &'static str,
    shape: Shape,
    material: Material,
    detector_px: f64,
    smoothing_px: f64,
) -> Case {
    Case { label, shape, material, detector_px, smoothing_px }
}

const CASES: [Case; 18] = {
    use Material::{CobaltChrome, CorticalBone, Steel, Titanium, TrabecularBone};
    use Shape::{Ellipsoid, Plate};
    let ball = Ellipsoid(12.0, 12.0);
    [
        case("bone, ball of 12 mm", ball, CorticalBone, 1.0, 1.0),
        case("bone, ball of 4 mm", Ellipsoid(4.0, 4.0), CorticalBone, 1.0, 1.0),
        case("bone, ball of 25 mm", Ellipsoid(25.0, 25.0), CorticalBone, 1.0, 1.0),
        case("bone, 4 mm, along the ray 12 mm", Ellipsoid(4.0, 12.0), CorticalBone, 1.0, 1.0),
        case("bone, 12 mm, along the ray 4 mm", Ellipsoid(12.0, 4.0), CorticalBone, 1.0, 1.0),
        case("bone, 12 mm, along the ray 30 mm", Ellipsoid(12.0, 30.0), CorticalBone, 1.0, 1.0),
        case("spongy bone, ball of 12 mm", ball, TrabecularBone, 1.0, 1.0),
        case("titanium, ball of 12 mm", ball, Titanium, 1.0, 1.0),
        case("steel, ball of 6 mm", Ellipsoid(6.0, 6.0), Steel, 1.0, 1.0),
        case("cobalt-chrome, ball of 12 mm", ball, CobaltChrome, 1.0, 1.0),
        case("cobalt-chrome, 12 mm, along the ray 3 mm", Ellipsoid(12.0, 3.0), CobaltChrome, 1.0, 1.0),
        case("bone, ball of 12 mm, sharp picture", ball, CorticalBone, 0.3, 1.0),
        case("bone, ball of 12 mm, blurred picture", ball, CorticalBone, 2.0, 1.0),
        case("bone, ball of 12 mm, little smoothing", ball, CorticalBone, 1.0, 0.5),
        case("bone, ball of 12 mm, much smoothing", ball, CorticalBone, 1.0, 3.0),
        case("cobalt-chrome, ball of 12 mm, much smoothing", ball, CobaltChrome, 1.0, 3.0),
        case("titanium, plate of 5 mm, wall along the rays", Plate(12.0, 5.0, true), Titanium, 1.0, 1.0),
        case("titanium, plate of 5 mm, wall along its axis", Plate(12.0, 5.0, false), Titanium, 1.0, 1.0),
    ]
};

/// Sides of a plate's polygon: its sagitta is 1e-5 of the radius.
const SIDES: usize = 720;
/// Points of an ellipsoid's mesh: within 2e-4 mm of the ellipsoid.
const POINTS: usize = 90_000;
/// Side of the focal spot, mm.
const FOCAL_SPOT_MM: f64 = 0.6;
/// Variance that the difference adds to the blur along the gradient, px^2.
const DIFFERENCE: f64 = 1.0 / 3.0;
/// Distance of the points of true outlines, px.
const STEP_PX: f64 = 0.25;
/// An edge farther from the outline would be another's, px.
const REACH_PX: f64 = 6.0;

/// An ellipsoid of revolution about y.
struct Ellipsoid {
    axes: Vector3,
}

impl Solid for Ellipsoid {
    fn value(&self, point: &Point3) -> f64 {
        (point.coords.component_div(&self.axes).norm() - 1.0) * self.axes.min()
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::from(-self.axes), Point3::from(self.axes))
    }
}

/// A plate about y, its wall a cylinder or a cone whose tip is the source at `source_mm` before it.
fn plate(radius: f64, thickness: f64, cone: bool, source_mm: f64) -> Result<Mesh, SceneError> {
    let faces = [-0.5, 0.5].map(|half| half * thickness);
    let mut vertices = Vec::new();
    for y in faces {
        let r = if cone { radius * (source_mm + y) / source_mm } else { radius };
        vertices.push(Point3::new(0.0, y, 0.0));
        vertices.extend((0..SIDES).map(|k| {
            let (sine, cosine) = (std::f64::consts::TAU * k as f64 / SIDES as f64).sin_cos();
            Point3::new(r * cosine, y, r * sine)
        }));
    }
    let far = SIDES as u32 + 1;
    let triangles = (0..SIDES as u32).flat_map(|k| {
        let (a, b) = (1 + k, 1 + (k + 1) % SIDES as u32);
        [[0, a, b], [far, far + b, far + a], [a, far + a, b], [b, far + a, far + b]]
    });
    let mesh = Mesh::new(vertices, triangles.collect()).map_err(|e| SceneError::Mesh(e.to_string()))?;
    Ok(if mesh.signed_volume() < 0.0 { mesh.inverted() } else { mesh })
}

/// The surface of a shape, and its outline.
fn body(shape: Shape, pose: &Pose, view: &TrueFluoroscope) -> Result<(Surface, Vec<Curve>), SceneError> {
    match shape {
        Shape::Ellipsoid(radius, along) => {
            let ellipsoid = Ellipsoid { axes: Vector3::new(radius, along, radius) };
            let outline = ideal_outline(&ellipsoid, pose, view, STEP_PX);
            if radius == along {
                return Ok((Surface::Ball(Ball { centre: Point3::origin(), radius }), outline));
            }
            let unit = ball_mesh(1.0, POINTS).map_err(|e| SceneError::Mesh(e.to_string()))?;
            let vertices = unit.vertices().iter().map(|v| v.coords.component_mul(&ellipsoid.axes).into());
            let mesh = Mesh::new(vertices.collect(), unit.triangles().to_vec())
                .map_err(|e| SceneError::Mesh(e.to_string()))?;
            Ok((Surface::Mesh(Arc::new(mesh)), outline))
        }
        Shape::Plate(radius, thickness, cone) => {
            let mesh = plate(radius, thickness, cone, (pose.translation() - view.source.coords).norm())?;
            // The rim of the near face has the larger shadow, or both have the same.
            let rim = &mesh.vertices()[1..=SIDES];
            let middle = view.project(&Point3::from(pose.translation())).map(|p| p.0);
            let points = rim.iter().filter_map(|v| {
                let (position, _) = view.project(&pose.transform(v))?;
                let direction = (position - middle?).normalize();
                Some(EdgePoint { position, direction, strength: 1.0, sigma_px: 0.01 })
            });
            let outline = vec![Curve { points: points.collect(), closed: true }];
            Ok((Surface::Mesh(Arc::new(mesh)), outline))
        }
    }
}

/// Where a rim that absorbs with `k` is steepest, in blurs inside the outline.
fn steepest(k: f64) -> f64 {
    let slope = |x: f64| {
        let step = 0.01;
        (0..320)
            .map(|i| {
                let u = (f64::from(i) + 0.5) * step;
                (-k * u - (x - u * u).powi(2) / 2.0).exp()
            })
            .sum::<f64>()
    };
    let (mut low, mut high) = (-1.0, 1.5);
    for _ in 0..60 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if slope(a) < slope(b) {
            low = a;
        } else {
            high = b;
        }
    }
    (low + high) / 2.0
}

/// A body before a fluoroscope, and its outline.
struct Shown {
    view: TrueFluoroscope,
    scene: Scene,
    outline: TrueOutline,
}

impl Shown {
    fn new(shape: Shape, material: Material) -> Result<Self, SceneError> {
        let [whole, _] = biplane(90.0);
        let (Shape::Ellipsoid(radius, _) | Shape::Plate(radius, ..)) = shape;
        let side = (2.0 * radius / mm_per_px(&whole)) as usize + 80;
        let view = TrueFluoroscope { size: [side, side], ..whole };
        // Off the middle of the picture's pixels, but where a plate's wall must run along the rays.
        let shift = match shape {
            Shape::Ellipsoid(..) => Vector3::new(0.3, 0.0, 0.1) * mm_per_px(&view),
            Shape::Plate(..) => Vector3::zeros(),
        };
        let pose = Pose::new(UnitQuaternion::identity(), shift);
        let (surface, outline) = body(shape, &pose, &view)?;
        let absorber = Absorber::new(surface, material, ground(material));
        let scene = Scene { bodies: vec![PosedBody::at_rest(pose, vec![absorber])], tissue: Vec::new() };
        Ok(Self { view, scene, outline: TrueOutline::new(outline) })
    }

    /// How far inside the outline the edges of a picture lie, px, and their stated standard deviations.
    fn edges(
        &self,
        exposure: &Exposure,
        smoothing_px: f64,
        seed: u64,
    ) -> Result<Vec<(f64, f64)>, SceneError> {
        let frame =
            picture(&self.scene, &self.view, exposure, seed).map_err(|e| SceneError::Mesh(e.to_string()))?;
        let params = SegmentParams { smoothing_px, ..SegmentParams::default() };
        let found = curves(&frame, None, &params)?;
        let points = found.0.iter().flat_map(|c| &c.points);
        let near = |p: &EdgePoint| Some((-self.outline.outside_px(&p.position, REACH_PX)?, p.sigma_px));
        Ok(points.filter_map(near).collect())
    }
}

/// What stands around a body.
fn ground(material: Material) -> Material {
    match material {
        Material::CorticalBone | Material::TrabecularBone => Material::SoftTissue,
        _ => Material::Air,
    }
}

/// What a pixel is at the laboratory's origin.
fn mm_per_px(view: &TrueFluoroscope) -> f64 {
    view.pixel_mm * -view.source.y / view.source_to_detector_mm()
}

/// What a case came to.
struct Found {
    blur_px: f64,
    k: Option<f64>,
    insets: Vec<f64>,
}

impl Found {
    /// Where the edge should be found, px inside; none for a plate, whose wall may be seen.
    fn expected_px(&self) -> Option<f64> {
        self.k.map(|k| steepest(k) * self.blur_px)
    }
}

fn measured(lab: &Lab, case: &Case) -> Result<Found, SceneError> {
    let shown = Shown::new(case.shape, case.material)?;
    let exposure = Exposure {
        samples_per_px: lab.count(64, 16),
        focal_spot_mm: FOCAL_SPOT_MM,
        detector_blur_px: case.detector_px,
        brightness: 0.9,
        ..Exposure::ideal()
    };
    let insets = shown.edges(&exposure, case.smoothing_px, 0)?.into_iter().map(|e| e.0).collect();
    let view = &shown.view;
    // Beyond the body the way to the detector is as long as to the source, so the spot is seen at its own size.
    let spot_px = FOCAL_SPOT_MM / view.pixel_mm / 12.0_f64.sqrt();
    let squares = [spot_px, case.detector_px, case.smoothing_px].map(|s| s * s).iter().sum::<f64>();
    let blur_px = (squares + 1.0 / 12.0 + DIFFERENCE).sqrt();
    let k = match case.shape {
        Shape::Ellipsoid(radius, along) => {
            let mu = case.material.attenuation_per_mm() - ground(case.material).attenuation_per_mm();
            Some(mu * (8.0 * along * along / radius * blur_px * mm_per_px(view)).sqrt())
        }
        Shape::Plate(..) => None,
    };
    Ok(Found { blur_px, k, insets })
}

/// Edges of a bone's ball in so many noisy pictures: their scatter, and their stated standard deviations, px.
pub fn noisy(pictures: usize, smoothing_px: f64, seed: u64) -> Result<Vec<(f64, f64)>, SceneError> {
    let shown = Shown::new(Shape::Ellipsoid(12.0, 12.0), Material::CorticalBone)?;
    // The light behind a knee: 120 mm of soft tissue.
    let behind = (-120.0 * Material::SoftTissue.attenuation_per_mm()).exp();
    let usual = Exposure::fluoroscopy();
    let exposure = Exposure {
        brightness: usual.brightness * behind,
        photons_per_px: usual.photons_per_px * behind,
        border_px: f64::INFINITY,
        vignetting: 0.0,
        ..usual
    };
    let mut all = Vec::new();
    for number in 0..pictures {
        all.extend(shown.edges(&exposure, smoothing_px, seed + number as u64)?);
    }
    let mean = all.iter().map(|e| e.0).sum::<f64>() / all.len().max(1) as f64;
    Ok(all.into_iter().map(|(inset, sigma)| (inset - mean, sigma)).collect())
}

/// The table of insets, and their plot.
pub fn insets(lab: &Lab) -> Result<(Table, Plot), SectionError> {
    let found: Vec<Found> = CASES.par_iter().map(|case| measured(lab, case)).collect::<Result<_, _>>()?;
    let mut measured: Vec<(f64, f64)> = Vec::new();
    let rows = CASES.iter().zip(&found).map(|(case, found)| {
        let n = found.insets.len().max(1) as f64;
        let mean = found.insets.iter().sum::<f64>() / n;
        let scatter = (found.insets.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt();
        let expected = found.expected_px();
        measured.extend(found.k.map(|k| (k.log10(), mean / found.blur_px)));
        Row::ours(
            case.label,
            vec![
                Cell::text(format!("{:.2}", found.blur_px)),
                Cell::text(found.k.map_or("-".to_owned(), |k| format!("{k:.2}"))),
                Cell::text(expected.map_or("-".to_owned(), |e| format!("{e:.3}"))),
                Cell::Number(mean),
                Cell::Number(scatter),
                expected.map_or(Cell::text("-"), |e| Cell::Number(mean - e)),
            ],
        )
    });
    let table = Table {
        id: "edges-rims".to_owned(),
        heading: "body before its ground".to_owned(),
        columns: vec![
            Column::at_most("blur, px", 2),
            Column::at_most("k", 2),
            Column::at_most("inside, expected, px", 2),
            Column::at_most("inside, mean, px", 3),
            Column::at_most("deviation along the rim, px", 3),
            Column::at_most("less what is expected, px", 3),
        ],
        rows: rows.collect(),
    };
    measured.sort_by(|a, b| a.0.total_cmp(&b.0));
    let expected =
        (-7..=6).map(|i| f64::from(i) / 5.0).map(|power| (power, steepest(10_f64.powf(power)))).collect();
    let panel = Panel {
        x: "log10 of k = mu sqrt(8 r s)".to_owned(),
        y: "inset, blurs".to_owned(),
        series: vec![
            Series { name: "expected".to_owned(), points: expected },
            Series { name: "measured".to_owned(), points: measured },
        ],
        limit: None,
    };
    let plot = lines(
        "edges-rims.svg",
        "How far inside the outline of a smooth body its edge is found, in blurs, by its absorption across a blur",
        &[panel],
    )?;
    Ok((table, plot))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weak_rim_is_steepest_at_0_765_blurs_and_a_strong_one_at_its_outline() {
        // Largest value of the integral of exp(-(x - u^2)^2 / 2), a parabolic cylinder function, D_{-1/2}(-x) exp(-x^2 / 4): 0.7650.
        assert!((steepest(0.0) - 0.765).abs() < 1e-3, "{}", steepest(0.0));
        assert!(steepest(1.0) < steepest(0.0) && steepest(30.0).abs() < 0.01);
    }

    #[test]
    fn plates_are_closed_and_as_large_as_they_should_be() {
        let cylinder = plate(3.0, 2.0, false, 500.0).unwrap();
        assert!((cylinder.signed_volume() / (std::f64::consts::PI * 18.0) - 1.0).abs() < 1e-4);
        assert_eq!(cylinder.topology(), plate(3.0, 2.0, true, 500.0).unwrap().topology());
    }
}
