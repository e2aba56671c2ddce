//! Edges that lie inside the outline as X-rays show them: what a match makes of them with and without the prediction.
//!
//! Edges here are those of the mesh that is matched, moved by what [`biplane_edge_bias`] says of one attenuation and one blur: these tests
//! hold that both are found and taken out. That real shadows are so is held by `cargo xtask validate --only bias`.

// A test whose set-up fails has failed.
#![allow(clippy::unwrap_used)]

use std::sync::OnceLock;

use biplane_artifact::{Curves, Match, Verdict};
use biplane_edge_bias::{ChordFinder, predicted};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Mesh, Point2, Pose, PoseError, Twist, Vector3};
use biplane_optimisation::{EdgeBias, EdgeField, MatchParams, View, match_body};
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_phantom::{Body, TrueFluoroscope, biplane, mesh};

fn truth() -> Pose {
    Pose::new(nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.2, 0.9), Vector3::new(4.0, -3.0, 6.0))
}

/// Views of a body at the truth whose edges an attenuation and a blur moved, px of noise beside it.
fn views(rim: &RimMesh, attenuation_per_mm: f64, blur_px: f64, noise_px: f64) -> Vec<View> {
    let see = |view: &TrueFluoroscope| {
        let fluoroscope = Fluoroscope::from(&view.calibration("A"));
        let mut outline = Outline::new();
        outline.trace(rim, &truth(), &fluoroscope, Sampling { step_px: 1.0 });
        let model_from_world = truth().inverse();
        let source = model_from_world.transform(fluoroscope.source());
        let axis = fluoroscope.matrix().row(2).transpose();
        let deep = |pixel: &Point2| {
            let ray = fluoroscope.ray(pixel).unwrap();
            ray / axis.dot(&ray)
        };
        let mut finder = ChordFinder::default();
        let mut wave = 0.0;
        let edge = |p: &biplane_outline::OutlinePoint| {
            let inward = (deep(&(p.pixel - p.normal)) - deep(&p.pixel)) * p.depth;
            let rim_point = model_from_world.transform(&p.world);
            let chords =
                finder.find(rim.surface(), &source, &rim_point, &(model_from_world.rotation() * inward))?;
            wave += 2.4;
            let inside = predicted(&chords, attenuation_per_mm, blur_px) + noise_px * f64::sin(wave);
            let position = p.pixel - p.normal * inside;
            Some(EdgePoint { position, direction: p.normal, strength: 20.0, sigma_px: 0.05 })
        };
        let points: Vec<EdgePoint> = outline.points().iter().filter_map(edge).collect();
        let curves = Curves(vec![Curve { points, closed: false }]);
        View { edges: EdgeField::new(&curves, None), fluoroscope }
    };
    biplane(90.0).iter().map(see).collect()
}

fn found(rim: &RimMesh, views: &[View], params: &MatchParams) -> (Match, PoseError) {
    let twist =
        Twist { translation: Vector3::new(1.0, -2.0, 1.5), rotation: Vector3::new(0.03, 0.02, -0.02) };
    let start = truth().moved(&twist, &truth().transform(rim.centroid()));
    let names: Vec<String> = (0..views.len()).map(|k| k.to_string()).collect();
    let params = MatchParams { retries: 0, ..params.clone() };
    let answer = match_body(rim, views, &names, &start, &params, || false).unwrap();
    let error = Pose::from(answer.pose).error_against(&truth(), rim.centroid());
    (answer, error)
}

/// Made once.
fn tray() -> &'static Mesh {
    static TRAY: OnceLock<Mesh> = OnceLock::new();
    TRAY.get_or_init(|| mesh(Body::TibialTray.solid(), 6_000).unwrap())
}

#[test]
fn what_an_attenuation_and_a_blur_do_to_edges_is_taken_out() {
    let rim = RimMesh::new(tray());
    for (attenuation, blur) in [(0.06, 1.65), (0.5, 1.65), (0.5, 1.2), (1.8, 2.2)] {
        let views = views(&rim, attenuation, blur, 0.05);
        let (answer, without) = found(&rim, &views, &MatchParams::default());
        let constant = MatchParams { edge_bias: EdgeBias::Constant, ..MatchParams::default() };
        let (_, with) = found(&rim, &views, &constant);
        let degrees = without.rotation_rad.to_degrees();
        assert_eq!(answer.verdict, Verdict::Good, "{}", answer.reason);
        assert!(
            without.translation_mm < 0.004 && degrees < 0.03,
            "{attenuation} {blur}: {} mm, {degrees} degrees, beside {with:?}",
            without.translation_mm
        );
        assert!(with.rotation_rad > 3.0 * without.rotation_rad, "{attenuation} {blur}: {without:?} {with:?}");
    }
}

#[test]
fn a_said_attenuation_is_held() {
    let rim = RimMesh::new(tray());
    let views = views(&rim, 0.5, 1.65, 0.05);
    let said = |attenuation| {
        let params = MatchParams { attenuation_per_mm: Some(attenuation), ..MatchParams::default() };
        found(&rim, &views, &params).1
    };
    let (right, wrong) = (said(0.5), said(0.05));
    assert!(right.translation_mm < 0.004 && right.rotation_rad.to_degrees() < 0.02, "{right:?}");
    assert!(wrong.translation_mm > 3.0 * right.translation_mm, "{right:?} {wrong:?}");
}

#[test]
fn edges_on_the_outline_and_open_meshes_are_left_as_they_are() {
    let whole = tray();
    let rim = RimMesh::new(whole);
    // An attenuation without end shows every edge at its outline.
    let sharp = views(&rim, 1e6, 1.65, 0.0);
    let blurred = views(&rim, 0.5, 1.65, 0.05);
    // Every tenth triangle is missing.
    let kept = whole.triangles().iter().enumerate().filter(|(k, _)| k % 10 != 0).map(|(_, t)| *t).collect();
    let open = RimMesh::new(&Mesh::new(whole.vertices().to_vec(), kept).unwrap());
    let constant = MatchParams { edge_bias: EdgeBias::Constant, ..MatchParams::default() };
    for (rim, views) in [(&rim, &sharp), (&open, &blurred)] {
        let (a, _) = found(rim, views, &MatchParams::default());
        let (b, _) = found(rim, views, &constant);
        assert_eq!(a, b);
    }
}
