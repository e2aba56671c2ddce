//! Frames of the phantom through the whole stage: labels, estimate, faults.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

mod scene;

use biplane_artifact::Verdict;
use biplane_environment::{EnvironmentParams, source_region};
use biplane_phantom::BeadLayout;
use scene::Scene;

#[test]
fn frames_are_recognised_without_a_person() {
    for (layout, share) in [(BeadLayout::large(), 0.5), (BeadLayout::small(), 0.7)] {
        for seed in 0..10 {
            let scene = Scene::drawn(&layout, share, 60.0 + 5.0 * seed as f64, seed);
            let found = scene.find(&EnvironmentParams::default()).unwrap();
            for (i, (view, truth)) in found.views.iter().zip(&scene.fluoroscopes).enumerate() {
                assert_eq!(view.beads.len(), 30);
                // One scene in ten thousand lies outside; these have fixed seeds.
                let region = source_region(&found, i, 0.9999).unwrap();
                assert!(region.holds(&truth.source), "{region:?}");
                assert!(view.reprojection_rms_px < 0.2);
            }
            assert_eq!(found.verdict, Verdict::Good, "{:?}", found.warnings);
        }
    }
}
