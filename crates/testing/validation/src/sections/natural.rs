//! Table 4.3: a natural knee with ideal outlines.

use biplane_phantom::{Body, biplane};

use super::SectionError;
use crate::knee::Posture;
use crate::lab::thesis_params;
use crate::outcome::{Method, Outcome, columns, outcomes, row, thesis_row};
use crate::thesis::{NATURAL_FEMUR, NATURAL_TIBIA};
use crate::{Lab, Section, Table, set_a};

/// Points of the models.
const POINTS: usize = 3_500;
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
        let scene = lab.ideal(body, POINTS, &views, lab.outlines(body, &postures, &views))?;
        let methods: &[Method] = if lab.full() { &Method::BOTH } else { &[Method::Default] };
        let found: Vec<_> =
            methods.iter().map(|&m| (m, outcomes(&scene, m, &thesis_params(), &draw))).collect();
        for (number, errors) in thesis.iter().enumerate() {
            let at = format!("{name}, {} ({:.0} degrees)", number + 1, POSITIONS[number]);
            table.rows.push(thesis_row(&format!("{at}, thesis"), errors, "160", "30 s"));
            for (method, all) in &found {
                let all: Vec<&Outcome> = all.iter().filter(|o| o.frame == number).collect();
                table.rows.push(row(&format!("{at}, {}", method.name()), &all));
            }
        }
    }
    Ok(Some(Section {
        title: "A natural knee with ideal outlines: Table 4.3".to_owned(),
        text: vec![
            "As Table 4.2, with bones. **The models are not from MRI:** no stage segments and lofts slices yet, so they are \
             meshes of the analytic surfaces, and the figures leave out what MRI adds. The bones' shafts are cut off flat, and \
             the cut is part of the outline, which makes depth along the shaft easier than it is in a real knee."
                .to_owned(),
        ],
        tables: vec![table],
        plots: Vec::new(),
    }))
}
