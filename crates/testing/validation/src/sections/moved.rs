//! Tables 4.5 and 4.6: a knee moved by known distances, and repeatability over starts, both from pictures.

use biplane_geometry::{Point3, Vector3};
use biplane_optimisation::MatchParams;
use biplane_phantom::{Exposure, biplane};

use super::SectionError;
use crate::knee::Posture;
use crate::lab::thesis_params;
use crate::outcome::{Method, Outcome, by_plane, chosen, compared_columns, compared_rows, outcomes};
use crate::pictures::{Equipment, Knee};
use crate::plot::{Dots, dots};
use crate::thesis::{COMPARED_IN_VIVO, REPEATABILITY};
use crate::{Cell, Column, Lab, Row, STARTS, Scene, Section, Spread, StartOffset, Table};

/// How far the knee is moved, mm, and the thesis's errors of femur and tibia.
const MOVED: [(f64, [&str; 2]); 4] = [
    (2.0, ["0.28 ± 0.89", "0.56 ± 0.53"]),
    (5.0, ["0.20 ± 1.25", "0.47 ± 0.95"]),
    (10.0, ["-0.05 ± 0.69", "0.31 ± 0.82"]),
    (15.0, ["-0.02 ± 0.58", "0.82 ± 0.91"]),
];
/// Points of the models.
const POINTS: usize = 15_000;
/// Starts of a pose.
const TEN: StartOffset = StartOffset { count: 10, ..STARTS };

/// Leaves the thesis's method only the curves that a person would choose for the body; the default sees all edges.
fn by_hand(mut scene: Scene) -> Scene {
    for frame in &mut scene.frames {
        for (curves, view) in frame.curves.iter_mut().zip(&frame.views) {
            *curves = chosen(curves, &view.fluoroscope, &scene.rim, &frame.reference);
        }
    }
    scene
}

/// Both methods on one scene of pictures; a quick run leaves the thesis's out.
fn measured(lab: &Lab, scene: Scene) -> Vec<(Method, Vec<Outcome>)> {
    let draw =
        |truth: &_, centroid: &_, frame| StartOffset { seed: lab.seed, ..TEN }.draw(truth, centroid, frame);
    let scene = by_hand(scene);
    let methods: &[Method] = if lab.full() { &Method::BOTH } else { &[Method::Default] };
    methods.iter().map(|&m| (m, outcomes(&scene, m, &thesis_params(), &draw))).collect()
}

/// How much farther than `distance` three points fixed to a body have moved from one pose to another, mm.
fn moved_too_far(from: &Outcome, to: &Outcome, centroid: &Point3, distance: f64) -> f64 {
    let arms = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| centroid + 30.0 * axis);
    let moved = |p: &Point3| (to.pose.transform(p) - from.pose.transform(p)).norm() - distance;
    arms.iter().map(moved).sum::<f64>() / 3.0
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let equipment = Equipment::new(&biplane(90.0), &Exposure::fluoroscopy());
    let calibrations = equipment.calibrations();

    let mut postures = vec![("0 mm".to_owned(), Posture::flexed(20.0))];
    for (distance, _) in MOVED {
        // Along the machine's axis, which is the knee's, a little inclined to the laboratory.
        let axis = Vector3::new(0.06, -0.04, 1.0).normalize();
        postures.push((format!("{distance} mm"), Posture::flexed(20.0).moved(axis * distance)));
    }
    let recorded = lab.record(Knee::Natural, &postures, &equipment)?;
    let mut moved = Table {
        id: "4.5".to_owned(),
        heading: "Table 4.5: error of the distance moved, mm".to_owned(),
        columns: ["femur", "tibia"]
            .iter()
            .flat_map(|bone| {
                [Column::at_most(bone, 3), Column::at_least(&format!("{bone}: starts that count"), 0)]
            })
            .collect(),
        rows: Vec::new(),
    };
    let mut by_bone = Vec::new();
    for body in Knee::Natural.bodies() {
        let scene = lab.recorded_scene(body, POINTS, &recorded, &calibrations, MatchParams::default())?;
        let centroid = *scene.rim.centroid();
        by_bone.push((centroid, measured(lab, scene)));
    }
    for (number, (distance, thesis)) in MOVED.iter().enumerate() {
        let cells = [thesis[0], "-", thesis[1], "-"];
        moved.rows.push(Row::published(format!("{distance} mm, thesis"), &cells));
        for method in 0..by_bone[0].1.len() {
            let mut cells = Vec::new();
            for (centroid, by_method) in &by_bone {
                let all = &by_method[method].1;
                let of = |frame: usize| all.iter().filter(move |o| o.frame == frame);
                let pairs: Vec<_> = of(0).zip(of(number + 1)).collect();
                let errors: Vec<f64> = pairs
                    .iter()
                    .filter(|(a, b)| a.counts && b.counts)
                    .map(|(a, b)| moved_too_far(a, b, centroid, *distance))
                    .collect();
                cells.push(Cell::Spread(Spread::of(&errors)));
                cells.push(Cell::Share(errors.len(), pairs.len()));
            }
            let name = by_bone[0].1[method].0.name();
            moved.rows.push(Row::ours(format!("{distance} mm, {name}"), cells));
        }
    }

    let axes = ["x, mm", "y, mm", "z, mm", "α, °", "β, °", "γ, °"];
    let mut repeated = Table {
        id: "4.6".to_owned(),
        heading: "Table 4.6: standard deviation over ten starts".to_owned(),
        columns: axes
            .iter()
            .map(|a| Column::at_most(a, 4))
            .chain([Column::at_least("starts that count", 0)])
            .collect(),
        rows: Vec::new(),
    };
    let postures: Vec<_> = [10.0, 50.0].map(|deg| (format!("{deg:.0}"), Posture::flexed(deg))).into();
    let recorded = lab.record(Knee::Implants, &postures, &equipment)?;
    let mut compared = Table {
        id: "5.2".to_owned(),
        heading: "Table 5.2: repeatability".to_owned(),
        columns: compared_columns(),
        rows: compared_rows(&COMPARED_IN_VIVO),
    };
    let mut largest: Vec<(Method, [f64; 4])> = Vec::new();
    let (mut plotted_mm, mut plotted_deg) = (Vec::new(), Vec::new());
    for (index, body) in Knee::Implants.bodies().into_iter().enumerate() {
        let scene = lab.recorded_scene(body, POINTS, &recorded, &calibrations, MatchParams::default())?;
        let found = measured(lab, scene);
        for position in 0..2 {
            let (label, thesis) = REPEATABILITY[2 * index + position];
            let cells = thesis.iter().map(|v| Cell::text(v.to_string())).chain([Cell::text("-")]).collect();
            repeated.rows.push(Row { label: format!("{label}, thesis"), ours: false, cells });
            let length = |v: &[f64]| v.iter().map(|s| s * s).sum::<f64>().sqrt();
            let mut values_mm = vec![Some(length(&thesis[..3])), None, None];
            let mut values_deg = vec![Some(length(&thesis[3..])), None, None];
            for (method, all) in &found {
                let all: Vec<&Outcome> = all.iter().filter(|o| o.frame == position).collect();
                let counted: Vec<&&Outcome> = all.iter().filter(|o| o.counts).collect();
                let deviations: [f64; 6] = std::array::from_fn(|i| {
                    Spread::of(&counted.iter().map(|o| o.variables[i]).collect::<Vec<_>>()).deviation
                });
                let mut cells: Vec<Cell> = deviations.iter().map(|v| Cell::Number(*v)).collect();
                cells.push(Cell::Share(counted.len(), all.len()));
                repeated.rows.push(Row::ours(format!("{label}, {}", method.name()), cells));
                let pairs: Vec<&Outcome> = counted.iter().map(|o| **o).collect();
                // Largest standard deviation of any axis, as the thesis's own row has it.
                let planes = by_plane(&pairs, &equipment.views[0].0);
                let of = |values: &[f64], axes: usize| {
                    (0..axes)
                        .map(|a| {
                            let axis: Vec<f64> = values.iter().skip(a).step_by(axes).copied().collect();
                            Spread::of(&axis).deviation
                        })
                        .fold(0.0, f64::max)
                };
                let own = [of(&planes[0], 2), of(&planes[2], 1), of(&planes[1], 1), of(&planes[3], 2)];
                match largest.iter_mut().find(|l| l.0 == *method) {
                    Some((_, kept)) => kept.iter_mut().zip(own).for_each(|(k, v)| *k = k.max(v)),
                    None => largest.push((*method, own)),
                }
                let column = if *method == Method::Thesis { 1 } else { 2 };
                values_mm[column] = Some(length(&deviations[..3]));
                values_deg[column] = Some(length(&deviations[3..]));
            }
            plotted_mm.push(Dots { label: format!("{label}, mm"), values: values_mm });
            plotted_deg.push(Dots { label: format!("{label}, °"), values: values_deg });
        }
    }
    for (method, values) in largest {
        let mut cells: Vec<Cell> = values.map(Cell::Number).into();
        cells.push(Cell::text("two views, phantom"));
        compared.rows.push(Row::ours(format!("this program, {}", method.name()), cells));
    }
    plotted_mm.extend(plotted_deg);
    Ok(Some(Section {
        title: "From pictures: Tables 4.5, 4.6 and 5.2".to_owned(),
        text: vec![
            "X-ray pictures of the phantom (1024 x 1024, 8 bit, focal-spot and detector blur, scatter, heel, vignetting, \
             Poisson noise), of meshes of 200,000 points; models of 15,000 points. Two views at 90 degrees, calibration known, \
             no distortion. Ten starts a pose, each exactly 6 mm and 6 degrees off. Curves are those of the stage `segment`. The \
             default finds a body's edges among all of them; `bingham2006` is left with those within 4 px of the true outline, as \
             a person chooses them in the thesis."
                .to_owned(),
            "Table 4.5 moves a natural knee by known distances; an entry is how much farther than that three points of a bone, \
             30 mm from its centroid, are found to have moved. The bones' models are meshes of the analytic surface; Table 4.3 has \
             them from MRI."
                .to_owned(),
            "Table 4.6 is repeatability and not accuracy: the same pictures from ten starts. In Table 5.2 ours are the largest \
             standard deviations of Table 4.6 along any axis, as the thesis's own row is; the others' pictures were of patients."
                .to_owned(),
        ],
        tables: vec![moved, repeated, compared],
        plots: vec![dots(
            "table-4-6.svg",
            "Table 4.6: standard deviation over ten starts, length over the three axes",
            "mm or degrees",
            &["thesis, in vivo", "bingham2006, ours", "default"],
            &plotted_mm,
        )?],
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::Pose;
    use nalgebra::UnitQuaternion;

    #[test]
    fn distances_are_those_of_points_fixed_to_the_body() {
        let at = |x: f64| {
            let pose = Pose::new(UnitQuaternion::identity(), Vector3::new(x, 0.0, 0.0));
            let none = Vector3::zeros();
            Outcome {
                frame: 0,
                pose,
                error: pose.error_against(&pose, &Point3::origin()),
                variables: [0.0; 6],
                moved: none,
                turned: none,
                counts: true,
                calls: 0,
                seconds: 0.0,
                stated: None,
            }
        };
        assert!((moved_too_far(&at(1.0), &at(6.5), &Point3::origin(), 5.0) - 0.5).abs() < 1e-12);
    }
}
