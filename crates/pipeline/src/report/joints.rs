//! Joints as the page plots them: a curve for each angle and translation, with its 95 % band, and how far the surfaces are apart.

use super::{Joint, Quantity};
use crate::joints::series::series;
use crate::outcome::Outcome;
use crate::study::Study;

/// All joints, trial by trial; a value is none where a body has no pose to rely on.
pub(super) fn joints(study: &Study, outcome: &Outcome) -> Vec<Joint> {
    let mut all = Vec::new();
    for of in &outcome.joints {
        let Some(joint) = study.joints.get(of.joint) else { continue };
        let names = joint.convention.names();
        for series in series(outcome, of, joint) {
            let numbers: Vec<usize> = outcome
                .frames
                .iter()
                .enumerate()
                .filter(|(_, f)| f.trial == series.trial)
                .map(|(i, _)| i)
                .collect();
            let at = |frame: usize| series.frames.iter().find(|f| f.frame == frame);
            let frames: Vec<_> = numbers.iter().map(|frame| at(*frame)).collect();
            let curve = |k: usize| Quantity {
                label: names[k].replace('_', " "),
                unit: if k < 3 { "°" } else { "mm" }.to_owned(),
                values: frames.iter().map(|f| Some(rounded((*f)?.values?[k]))).collect(),
                half_width_95: frames.iter().map(|f| Some(rounded((*f)?.half_widths?[k]))).collect(),
                smoothed: None,
            };
            let mut quantities: Vec<Quantity> = (0..6).map(curve).collect();
            if joint.distance {
                quantities.push(Quantity {
                    label: "distance of the surfaces".to_owned(),
                    unit: "mm".to_owned(),
                    values: frames
                        .iter()
                        .map(|f| (*f)?.joint.pose.as_ref()?.distance_mm.map(rounded))
                        .collect(),
                    half_width_95: vec![None; frames.len()],
                    smoothed: None,
                });
            }
            all.push(Joint { trial: series.trial, name: joint.name.clone(), quantities });
        }
    }
    all
}

fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
