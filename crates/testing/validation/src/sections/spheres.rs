//! Table 4.4: eight touching spheres of three materials, from pictures.

use std::f64::consts::TAU;
use std::sync::Arc;

use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_optimisation::{EdgeField, MatchParams};
use biplane_phantom::{
    Absorber, Ball, Exposure, Material, PosedBody, Surface, TrueFluoroscope, ball_mesh, biplane,
};
use nalgebra::{Rotation3, UnitQuaternion};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;

use super::SectionError;
use crate::lab::{Frames, thesis_params};
use crate::outcome::{Method, Outcome, chosen, outcomes};
use crate::pictures::{Equipment, expose};
use crate::plot::{Panel, cumulative, lines};
use crate::scene::{Claim, Made, Origin};
use crate::{Cell, Column, Lab, Row, Scene, SceneError, Section, Spread, StartOffset, Table};

/// Diameter, mm.
const DIAMETER_MM: f64 = 12.70;
/// Points of the model.
const POINTS: usize = 2_500;
/// Materials of spheres 1 to 8.
const MATERIALS: [Material; 8] = {
    use Material::{Ceramic, Steel, Tungsten};
    [Steel, Ceramic, Steel, Steel, Tungsten, Steel, Ceramic, Steel]
};
/// The thesis's distances of neighbours, mm.
const THESIS: [&str; 7] = [
    "12.76 ± 0.04 [0.07]",
    "12.72 ± 0.03 [0.03]",
    "12.56 ± 0.01 [0.14]",
    "12.72 ± 0.02 [0.03]",
    "12.66 ± 0.04 [0.06]",
    "12.75 ± 0.06 [0.07]",
    "12.68 ± 0.05 [0.06]",
];
/// A start lies this far off: nearer to its own sphere than to a neighbour.
const STARTS: StartOffset = StartOffset { translation_mm: 3.0, rotation_deg: 0.0, count: 10, seed: 1 };

const STILL: f64 = 0.1;
/// Centres of the spheres: two rows in a vertical plane, each sphere touching the next; the plane turned about the
/// vertical, tilted and shifted at random.
fn centres(seed: u64, scene: usize) -> [Point3; 8] {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(31_337).wrapping_add(scene as u64));
    // One and the same scene for the thesis's table, others for the distribution.
    let turn = if scene == 0 { 0.7 } else { random.random_range(0.0..TAU) };
    let mut within = |size: f64| random.random_range(-size..=size);
    let tilt = Rotation3::from_scaled_axis(Vector3::new(within(0.15), within(0.15), 0.0));
    let shift = Vector3::new(within(10.0), within(10.0), within(10.0));
    let about_z = Rotation3::from_axis_angle(&Vector3::z_axis(), turn);
    std::array::from_fn(|k| {
        let along = (k as f64 - 3.5) * DIAMETER_MM / 2.0;
        let up = if k % 2 == 0 { -1.0 } else { 1.0 } * DIAMETER_MM * 3_f64.sqrt() / 4.0;
        Point3::from(tilt * (about_z * Vector3::new(along, 0.0, up)) + shift)
    })
}

fn at(centre: &Point3) -> Pose {
    Pose::new(UnitQuaternion::identity(), centre.coords)
}

/// Starts of all eight spheres of a scene by each method: `[sphere][method]`.
fn matched(
    lab: &Lab,
    number: usize,
    model: &Mesh,
    equipment: &Equipment,
    methods: &[Method],
    starts: usize,
) -> Result<Vec<Vec<Vec<Outcome>>>, SceneError> {
    let centres = centres(lab.seed, number);
    let bodies = centres.iter().zip(MATERIALS).map(|(centre, material)| {
        let ball = Ball { centre: Point3::origin(), radius: DIAMETER_MM / 2.0 };
        PosedBody::at_rest(at(centre), vec![Absorber::new(Surface::Ball(ball), material, Material::Air)])
    });
    let beam = biplane_phantom::Scene { bodies: bodies.collect(), tissue: Vec::new() };
    let (_, curves) = expose(&beam, equipment, lab.seed, number)?;
    let calibrations = equipment.calibrations();
    // A ball can turn as it likes, so its turning says nothing; and neighbours hide up to two thirds of its outline.
    let params = MatchParams {
        search_px: 25.0,
        still_mm: STILL,
        good_share: 0.25,
        failed_share: 0.1,
        good_sigma_deg: f64::MAX,
        ..MatchParams::default()
    };
    centres
        .iter()
        .enumerate()
        .map(|(sphere, centre)| {
            let made = Made { origin: Origin::Solid, claim: Claim::Accuracy, params: params.clone() };
            let frames: Frames = vec![(format!("{number}"), at(centre), curves.clone())];
            let mut scene = Scene::made(made, model, &calibrations, frames)?;
            for frame in &mut scene.frames {
                for (curves, view) in frame.curves.iter_mut().zip(&mut frame.views) {
                    *curves = chosen(curves, &view.fluoroscope, &scene.rim, &frame.reference);
                    view.edges = EdgeField::new(curves, view.fluoroscope.distortion());
                }
            }
            let offset = StartOffset { count: starts, seed: lab.seed, ..STARTS };
            let draw = move |truth: &Pose, centroid: &_, _| offset.draw(truth, centroid, 8 * number + sphere);
            let thesis = biplane_optimisation::BinghamParams { outline_points: 60, ..thesis_params() };
            Ok(methods.iter().map(|&method| outcomes(&scene, method, &thesis, &draw)).collect())
        })
        .collect()
}

/// Distances of a sphere from the next one, over starts that count for both.
fn distances(spheres: &[Vec<Vec<Outcome>>], pair: usize, method: usize) -> (Vec<f64>, usize) {
    let (a, b) = (&spheres[pair][method], &spheres[pair + 1][method]);
    let centre = |o: &Outcome| o.pose.transform(&Point3::origin());
    let counted = a.iter().zip(b).filter(|(a, b)| a.counts && b.counts);
    (counted.map(|(a, b)| (centre(b) - centre(a)).norm()).collect(), a.len())
}

fn distance_row(label: String, distances: &[f64], starts: usize) -> Row {
    let errors: Vec<f64> = distances.iter().map(|d| d - DIAMETER_MM).collect();
    let spread = Spread::of(&errors);
    Row::ours(
        label,
        vec![
            Cell::Number(DIAMETER_MM + spread.mean),
            Cell::Spread(spread),
            Cell::Share(distances.len(), starts),
        ],
    )
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let views: [TrueFluoroscope; 2] = biplane(90.0);
    // No limb in the beam, so less light is needed.
    let exposure = Exposure { brightness: 0.9, photons_per_px: 12_000.0, ..Exposure::fluoroscopy() };
    let equipment = Equipment::new(&views, &exposure);
    let model: Arc<Mesh> =
        Arc::new(ball_mesh(DIAMETER_MM / 2.0, POINTS).map_err(|e| SceneError::Mesh(e.to_string()))?);
    let methods: &[Method] = if lab.full() { &[Method::Default, Method::Thesis] } else { &[Method::Default] };
    let mut table = Table {
        id: "4.4".to_owned(),
        heading: "Table 4.4: spheres".to_owned(),
        columns: vec![
            Column::within("distance, mm", 3),
            Column::at_most("error, mm", 3),
            Column::at_least("starts that count", 0),
        ],
        rows: Vec::new(),
    };
    let one = matched(lab, 0, &model, &equipment, methods, STARTS.count)?;
    let mut mean_of = vec![Vec::new(); methods.len()];
    for (pair, thesis) in THESIS.iter().enumerate() {
        table.rows.push(Row::published(format!("{} to {}, thesis", pair + 1, pair + 2), &[thesis, "-", "-"]));
        for (index, method) in methods.iter().enumerate().rev() {
            let (found, starts) = distances(&one, pair, index);
            table.rows.push(distance_row(
                format!("{} to {}, {}", pair + 1, pair + 2, method.name()),
                &found,
                starts,
            ));
            mean_of[index].extend(found);
        }
    }
    table.rows.push(Row::published("mean, thesis", &["12.69 ± 0.06 [0.06]", "-", "-"]));
    for (index, method) in methods.iter().enumerate().rev() {
        let starts = 7 * STARTS.count;
        table.rows.push(distance_row(format!("mean, {}", method.name()), &mean_of[index], starts));
    }
    let count = lab.count(50, 6);
    let many: Vec<_> = (1..=count)
        .into_par_iter()
        .map(|number| matched(lab, number, &model, &equipment, &[Method::Default], 1))
        .collect::<Result<_, _>>()?;
    let mut all = Vec::new();
    let mut starts = 0;
    for spheres in &many {
        for pair in 0..7 {
            let (found, tried) = distances(spheres, pair, 0);
            all.extend(found);
            starts += tried;
        }
    }
    let plotted: Vec<f64> = all.iter().map(|d| (d - DIAMETER_MM).abs()).collect();
    table.rows.push(distance_row("other scenes, one start each, default".to_owned(), &all, starts));
    let panel = Panel {
        y: "share of pairs".to_owned(),
        series: vec![cumulative("default, many scenes", &plotted)],
        limit: None,
    };
    Ok(Some(Section {
        title: "Eight touching spheres: Table 4.4".to_owned(),
        text: vec![format!(
            "Spheres of 12.70 mm (five of steel, two of ceramic, one of tungsten) in two rows of a vertical plane, each touching \
             the next, X-rayed as exact balls with blur, scatter and noise; the model is a mesh of {POINTS} points. In both views \
             they hide a part of one another. Ten starts, each 3 mm off; then {} scenes turned, tilted and shifted at random, \
             one start a sphere. The thesis prints distances; the column of errors is distance less 12.70 mm, mean ± sample \
             standard deviation [root mean square]. The goal of the whole program is 0.01 mm on average and 0.03 mm root mean \
             square over at least 50 scenes.",
            count
        )],
        tables: vec![table],
        plots: vec![lines(
            "table-4-4.svg",
            "Spheres in many scenes: share of neighbours whose distance is wrong by less than x",
            "error of the distance, mm",
            &[panel],
        )?],
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_touch_and_nobody_overlaps() {
        for scene in 0..20 {
            let c = centres(7, scene);
            for i in 0..8 {
                for j in 0..i {
                    let distance = (c[i] - c[j]).norm();
                    let expected = if i == j + 1 || i == j + 2 { DIAMETER_MM } else { f64::NAN };
                    assert!(distance > DIAMETER_MM - 1e-9);
                    assert!(expected.is_nan() || (distance - expected).abs() < 1e-9);
                }
            }
        }
    }
}
