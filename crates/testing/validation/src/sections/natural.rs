//! Table 4.3: a natural knee with ideal outlines.

use biplane_phantom::{Body, biplane};

use super::SectionError;
use crate::knee::Posture;
use crate::lab::thesis_params;
use crate::outcome::{Method, Outcome, columns, outcomes, row, thesis_row};
use crate::thesis::{NATURAL_FEMUR, NATURAL_TIBIA};
use crate::{Lab, Section, Table, set_a};

/// Points of the models.
const POINTS: u32 = 3_500;
/// Flexion, degrees.
const POSITIONS: [f64; 3] = [30.0, 60.0, 90.0];
/// Starts of a pose.
const STARTS: usize = 10;

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let views = biplane(90.0);
    let mut table = Table {
        id: "4.3".to_owned(),
        heading: "Table 4.3: natural knee, 3,500 points".to_owned(),
        columns: columns(),
        rows: Vec::new(),
    };
    let draw = |truth: &_, centroid: &_, frame| set_a(truth, centroid, lab.seed, frame, STARTS);
    let bones = [(Body::DistalFemur, "femur", NATURAL_FEMUR), (Body::ProximalTibia, "tibia", NATURAL_TIBIA)];
    for (body, name, thesis) in bones {
        let postures: Vec<_> =
            POSITIONS.iter().map(|deg| (format!("{deg:.0}"), Posture::flexed(*deg))).collect();
        let outlines = lab.outlines(body, &postures, &views);
        let scanned = lab.ideal_with(&lab.scanned(body, POINTS)?, &views, outlines.clone())?;
        let exact = lab.ideal(body, POINTS as usize, &views, outlines)?;
        let methods: &[Method] = if lab.full() { &Method::BOTH } else { &[Method::Default] };
        let with = |scene, method| outcomes(scene, method, &thesis_params(), &draw);
        let mut found: Vec<(String, Vec<Outcome>)> =
            methods.iter().map(|&m| (m.name().to_owned(), with(&scanned, m))).collect();
        found
            .push((format!("{}, model not from MRI", Method::Default.name()), with(&exact, Method::Default)));
        for (number, errors) in thesis.iter().enumerate() {
            let at = format!("{name}, {} ({:.0} degrees)", number + 1, POSITIONS[number]);
            table.rows.push(thesis_row(&format!("{at}, thesis"), errors, "160", "30 s"));
            for (how, all) in &found {
                let all: Vec<&Outcome> = all.iter().filter(|o| o.frame == number).collect();
                table.rows.push(row(&format!("{at}, {how}"), &all));
            }
        }
    }
    Ok(Some(Section {
        title: "A natural knee with ideal outlines: Table 4.3".to_owned(),
        text: vec![
            "As Table 4.2, with bones. **The models are from MRI:** the phantom's bones are scanned (sagittal slices of 1 mm, pixels \
             of 0.5 mm, the faults of the section on surfaces), segmented from one seed, lofted, and given 3,500 points, all by the \
             stages with their defaults. Rows *not from MRI* have meshes of the analytic surfaces instead, and show what MRI adds. The \
             bones' shafts are cut off flat, and the cut is part of the outline, which makes depth along the shaft easier than it \
             is in a real knee."
                .to_owned(),
        ],
        tables: vec![table],
        plots: Vec::new(),
    }))
}
