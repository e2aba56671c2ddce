//! Starts from no guess at all: random poses over all rotations with ideal outlines, pictures of other simulators, a real sequence.

use std::time::Instant;

use biplane_artifact::{Curves, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_optimisation::{EdgeField, MatchParams, View, match_body, refine};
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_phantom::{Body, TrueFluoroscope, biplane};
use biplane_silhouette::{Candidate, SilhouetteLibrary, descend};
use nalgebra::{Quaternion, UnitQuaternion};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;

use super::SectionError;
use super::studies::{REAL, SIMULATED};
use crate::goals::Goals;
use crate::lab::{calibrations, unbiased_params};
use crate::many_outlines;
use crate::outcome::outline_curves;
use crate::{Cell, Column, Distribution, Lab, Row, Scene, SceneError, Section, Table, elsewhere};

/// Points of the models.
const POINTS: usize = 15_000;
/// Candidates of a pose.
const CANDIDATES: usize = 20;
/// A candidate within these, degrees and mm, is in the right basin.
const BASIN: (f64, f64) = (15.0, 12.0);
/// A descent this good ends the search among candidates that fit worse.
const ENOUGH: f64 = 0.75;
/// Distance of the points of ideal outlines, px.
const STEP_PX: f64 = 1.0;
/// How far from the laboratory's origin the centroid may be along each axis, mm.
const REACH_MM: f64 = 15.0;

/// A rotation drawn evenly over all (Shoemake 1992), the centroid in a box about the origin.
fn random_pose(seed: u64, number: usize, centroid: &Point3) -> Pose {
    let mut random =
        Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(15_485_863).wrapping_add(number as u64));
    let [a, b, c]: [f64; 3] = std::array::from_fn(|_| random.random());
    let (b, c) = (std::f64::consts::TAU * b, std::f64::consts::TAU * c);
    let (r, s) = ((1.0 - a).sqrt(), a.sqrt());
    let turn = Quaternion::new(s * c.cos(), r * b.sin(), r * b.cos(), s * c.sin());
    let turn = UnitQuaternion::from_quaternion(turn);
    let at = Vector3::from_fn(|_, _| random.random_range(-REACH_MM..REACH_MM));
    Pose::new(turn, at - turn * centroid.coords)
}

/// What came of one pose that nobody guessed.
struct Found {
    /// The place of the first candidate in the right basin.
    place: Option<usize>,
    right: bool,
    good: bool,
    candidates_ms: f64,
    all_ms: f64,
}

/// A body as it is sought.
struct Sought<'a> {
    library: &'a SilhouetteLibrary,
    rim: &'a RimMesh,
    params: &'a MatchParams,
    names: &'a [String],
}

impl Sought<'_> {
    fn find(&self, views: &[(&Fluoroscope, &Curves)], truth: &Pose) -> Found {
        let begun = Instant::now();
        let search = self.params.search();
        let candidates = self.library.starts(views, search.contrast, CANDIDATES);
        let candidates_ms = 1e3 * begun.elapsed().as_secs_f64();
        let seen: Vec<View> = views
            .iter()
            .map(|(fluoroscope, curves)| View {
                edges: EdgeField::new(curves, fluoroscope.distortion()),
                fluoroscope: (*fluoroscope).clone(),
            })
            .collect();
        let descents = descend(&candidates, ENOUGH, |start| {
            let refined = refine(self.rim, &seen, start, &search);
            let score = refined.score();
            Some((refined.pose, score))
        });
        let all_ms = 1e3 * begun.elapsed().as_secs_f64();
        let centroid = self.rim.centroid();
        let within = |pose: &Pose, deg: f64, mm: f64| {
            let error = pose.error_against(truth, centroid);
            error.rotation_rad.to_degrees() <= deg && error.translation_mm <= mm
        };
        let best = descents.first().map(|d| d.0);
        // Nothing cancels here, so every match gives an answer.
        let matched =
            best.and_then(|p| match_body(self.rim, &seen, self.names, &p, self.params, || false).ok());
        Found {
            place: candidates.iter().position(|c: &Candidate| within(&c.pose, BASIN.0, BASIN.1)),
            right: best.is_some_and(|p| within(&p, 1.0, 1.0)),
            good: matched.is_some_and(|m| m.verdict == Verdict::Good),
            candidates_ms,
            all_ms,
        }
    }
}

fn columns() -> Vec<Column> {
    vec![
        Column::at_least("right", 0),
        Column::at_least("right basin first", 0),
        Column::at_least("right basin among 20", 0),
        Column::at_least("good", 0),
        Column::at_most("good, yet wrong", 0),
        Column::at_most("ms to candidates, median", 1),
        Column::at_most("ms in all, median", 1),
        Column::at_most("95 %", 1),
        Column::at_most("preparation of a mesh, s", 2),
    ]
}

fn table(id: &str, heading: &str) -> Table {
    Table { id: id.to_owned(), heading: heading.to_owned(), columns: columns(), rows: Vec::new() }
}

/// A row; where the reference is no better than one view's depth, `near` alone is told and not what is right.
fn row(label: &str, all: &[Found], prepared_s: f64, near: bool) -> Row {
    let share = |of: &dyn Fn(&Found) -> bool| Cell::Share(all.iter().filter(|f| of(f)).count(), all.len());
    let times = |of: fn(&Found) -> f64| Distribution::of(all.iter().map(of).collect());
    let whole = times(|f| f.all_ms);
    let wrong = all.iter().filter(|f| f.good && !f.right).count();
    Row::ours(
        label,
        vec![
            if near { Cell::text("-") } else { share(&|f| f.right) },
            share(&|f| f.place == Some(0)),
            share(&|f| f.place.is_some()),
            share(&|f| f.good),
            if near { Cell::text("-") } else { Cell::Number(wrong as f64) },
            Cell::Number(times(|f| f.candidates_ms).median),
            Cell::Number(whole.median),
            Cell::Number(whole.p95),
            Cell::Number(prepared_s),
        ],
    )
}

fn library(mesh: &Mesh) -> (SilhouetteLibrary, f64) {
    let begun = Instant::now();
    let library = SilhouetteLibrary::new(mesh);
    (library, begun.elapsed().as_secs_f64())
}

/// Random poses of a mesh, with the outlines that `outlines` makes of each.
fn random(
    lab: &Lab,
    mesh: &Mesh,
    views: &[TrueFluoroscope],
    poses: usize,
    outlines: &(dyn Fn(&Pose) -> Vec<Curves> + Sync),
) -> (Vec<Found>, f64) {
    let (library, prepared_s) = library(mesh);
    // Candidates are near: edges need not be looked for as far as from starts that somebody guessed.
    let params = MatchParams { search_px: MatchParams::default().search_px, ..unbiased_params() };
    let rim = RimMesh::new(mesh);
    let calibrations = calibrations(views);
    let names: Vec<String> = calibrations.iter().map(|c| c.view.clone()).collect();
    let fluoroscopes: Vec<Fluoroscope> = calibrations.iter().map(Fluoroscope::from).collect();
    let sought = Sought { library: &library, rim: &rim, params: &params, names: &names };
    let found = (0..poses)
        .into_par_iter()
        .map(|number| {
            let truth = random_pose(lab.seed, number, rim.centroid());
            let curves = outlines(&truth);
            let seen: Vec<_> = fluoroscopes.iter().zip(&curves).collect();
            sought.find(&seen, &truth)
        })
        .collect();
    (found, prepared_s)
}

/// Frames of a study.
fn pictures(scene: &Scene) -> (Vec<Found>, f64) {
    let (library, prepared_s) = library(&scene.mesh);
    let sought = Sought { library: &library, rim: &scene.rim, params: &scene.params, names: &scene.names };
    let found = scene
        .frames
        .iter()
        .map(|frame| {
            let seen: Vec<_> =
                frame.views.iter().zip(&frame.curves).map(|(v, c)| (&v.fluoroscope, c)).collect();
            sought.find(&seen, &frame.reference)
        })
        .collect();
    (found, prepared_s)
}

/// The tray of the real sequence, for which nobody published poses: what is held against are the poses that its match reaches from a
/// person's rough ones.
fn real_tray(lab: &Lab, femur: Scene) -> Result<Scene, SceneError> {
    let pipeline = lab.root.join(REAL[0].1);
    let folder = tempfile::tempdir().map_err(SceneError::Folder)?;
    let store = biplane_stage::Store::open(&folder.path().join("store"))?;
    let prepared = biplane::prepare::Prepared::of(biplane::study::Study::load(&pipeline)?)?;
    let (_, mesh) = crate::read_body(&prepared, &store, &pipeline, "tibia")?;
    let rim = RimMesh::new(&mesh);
    let path = lab.root.join("fixtures/real/knee-implant-biplane-starts.csv");
    let bad = |row: usize| SceneError::Reference { path: path.clone(), row };
    let mut starts = Vec::new();
    let mut reader = csv::Reader::from_path(&path).map_err(|_| bad(0))?;
    for (number, record) in reader.records().enumerate() {
        let record = record.map_err(|_| bad(number + 2))?;
        if &record[2] == "tibia" {
            let v: Vec<f64> = record.iter().skip(3).filter_map(|v| v.trim().parse().ok()).collect();
            let &[x, y, z, qw, qx, qy, qz] = v.as_slice() else { return Err(bad(number + 2)) };
            let turn = UnitQuaternion::from_quaternion(Quaternion::new(qw, qx, qy, qz));
            starts.push((record[1].to_owned(), Pose::new(turn, Vector3::new(x, y, z))));
        }
    }
    let mut frames = Vec::new();
    for mut frame in femur.frames {
        let Some(start) = starts.iter().find(|s| s.0 == frame.label) else { continue };
        let found = match_body(&rim, &frame.views, &femur.names, &start.1, &femur.params, || false);
        if let Ok(found) = found {
            frame.reference = found.pose.into();
            frames.push(frame);
        }
    }
    Ok(Scene { mesh, rim, params: femur.params, names: femur.names, frames })
}

/// The real sequence of one view: mesh, its poses as JointTrack wrote them, name of the row.
const SINGLE: [(&str, &str, &str); 2] = [
    ("KR_right_7_fem.stl", "fem.jts", "real femoral component, one view"),
    ("KR_right_6_tib.stl", "tib.jts", "real tray, one view"),
];
/// Its folder, from the project's, and its frames.
const SINGLE_FOLDER: &str = "../shared/data/real/knee-implant-single";
const SINGLE_FRAMES: [&str; 3] = ["0160", "0170", "0180"];

/// A body of the real sequence of one view. JointTrack's camera is at the origin and looks along -z, x to the right and y up; its poses are
/// `Rz Rx Ry x + t`, a row `tx, ty, tz, z, x, y` a frame, mm and degrees.
fn real_single(lab: &Lab, (mesh, poses, _): (&str, &str, &str)) -> Result<Scene, SceneError> {
    let data = std::path::absolute(lab.root.join(SINGLE_FOLDER)).map_err(SceneError::Folder)?;
    let folder = tempfile::tempdir().map_err(SceneError::Folder)?;
    let file = |name: &str| folder.path().join(name);
    let write = |name: &str, text: String| std::fs::write(file(name), text).map_err(SceneError::Folder);
    // The middle of the picture, which lies half a pixel before (512, 512).
    let (pixel, away) = (0.373, 1198.0);
    write(
        "calibration.json",
        format!(
            r#"{{"fluoroscopes": {{"A": {{"pixel_mm": {pixel}, "size": [1024, 1024], "source": [0, 0, 0],
            "centre": [{0}, {0}, -{away}], "u": [1, 0, 0], "v": [0, -1, 0]}}}}}}"#,
            -pixel / 2.0
        ),
    )?;
    write(
        "pipeline.toml",
        format!(
            "[study]\nname = \"kneel\"\n[fluoroscope.A]\ncalibration = \"calibration.json\"\n[[body]]\nname = \"body\"\nmesh = {:?}\n[[trial]]\nname = \"kneel\"\nframes \
             = {{ A = {:?} }}\n",
            data.join(mesh),
            data.join("AT_K1_V1_*.tif"),
        ),
    )?;
    let path = data.join(poses);
    let bad = |row: usize| SceneError::Reference { path: path.clone(), row };
    let text = std::fs::read_to_string(&path).map_err(|_| bad(0))?;
    let mut reference = "frame".to_owned() + &",m".repeat(16) + "\n";
    for (k, (frame, line)) in SINGLE_FRAMES.iter().zip(text.lines().skip(2)).enumerate() {
        let v: Vec<f64> = line.split(',').filter_map(|v| v.trim().parse().ok()).collect();
        let &[tx, ty, tz, z, x, y] = v.as_slice() else { return Err(bad(k + 3)) };
        let about = |axis, deg: f64| UnitQuaternion::from_axis_angle(&axis, deg.to_radians());
        let turn = about(Vector3::z_axis(), z) * about(Vector3::x_axis(), x) * about(Vector3::y_axis(), y);
        let matrix = Pose::new(turn, Vector3::new(tx, ty, tz)).matrix();
        let row: Vec<String> = matrix.transpose().iter().map(f64::to_string).collect();
        reference += &format!("{frame},{}\n", row.join(","));
    }
    write("reference.csv", reference)?;
    Scene::load(&file("pipeline.toml"), "body", &file("reference.csv"))
}

const BODIES: [(Body, &str); 4] = [
    (Body::FemoralComponent, "femoral component"),
    (Body::TibialTray, "tibial component"),
    (Body::DistalFemur, "femur"),
    (Body::ProximalTibia, "tibia"),
];

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let views = biplane(90.0);
    let poses = lab.count(1_000, 20);
    let mut ideal = table("anywhere", "two views, ideal outlines");
    let mut one = table("anywhere-one-view", "one view, ideal outlines");
    let mut goals = Goals::default();
    let mut add = |table: &mut Table, label: &str, (found, prepared_s): (Vec<Found>, f64), goal: bool| {
        let added = row(label, &found, prepared_s, false);
        if goal {
            let right = found.iter().filter(|f| f.right).count();
            goals.share(&format!("{label}, right"), (right, found.len()), 0.99);
            let whole = Distribution::of(found.iter().map(|f| f.all_ms).collect());
            goals.at_most(&format!("{label}, in all, median"), whole.median, 50.0, "ms");
            goals.at_most(&format!("{label}, preparation"), prepared_s, 2.0, "s");
        }
        table.rows.push(added);
    };
    for (body, name) in BODIES {
        let mesh = lab.workshop.surface(body, POINTS)?;
        let outlines = |number: usize| {
            let views = views[..number].to_vec();
            move |pose: &Pose| {
                views.iter().map(|v| Curves(many_outlines::outline(body, pose, v, STEP_PX))).collect()
            }
        };
        add(&mut ideal, name, random(lab, &mesh, &views, poses, &outlines(2)), true);
        add(&mut one, name, random(lab, &mesh, &views[..1], lab.count(200, 10), &outlines(1)), false);
    }
    for body in elsewhere::BODIES {
        // Outlines of the very mesh, drawn by this program at poses that no file has: they say how the search ends, and no more.
        let scene = elsewhere::scene(&lab.root, body, 36_000, POINTS, &unbiased_params())?;
        let fluoroscopes: Vec<Fluoroscope> = calibrations(&views).iter().map(Fluoroscope::from).collect();
        let outlines = |pose: &Pose| {
            let mut outline = Outline::new();
            let mut seen = |view: &Fluoroscope| {
                outline.trace(&scene.rim, pose, view, Sampling { step_px: STEP_PX });
                outline_curves(&outline)
            };
            fluoroscopes.iter().map(&mut seen).collect()
        };
        let label = format!("{body} of `fixtures/scene`");
        add(&mut ideal, &label, random(lab, &scene.mesh, &views, poses, &outlines), true);
    }
    let mut seen = table("anywhere-pictures", "pictures of everything");
    for (name, pipeline, body, reference) in &SIMULATED[..lab.count(SIMULATED.len(), 2)] {
        let scene = Scene::load(&lab.root.join(pipeline), body, &lab.root.join(reference))?;
        add(&mut seen, name, pictures(&scene), false);
    }
    let (_, pipeline, body, reference) = REAL[0];
    if lab.root.join(reference).is_file() {
        let scene = Scene::load(&lab.root.join(pipeline), body, &lab.root.join(reference))?;
        add(&mut seen, "real femoral component", pictures(&scene), false);
        add(&mut seen, "real tray", pictures(&real_tray(lab, scene)?), false);
    }
    if lab.root.join(SINGLE_FOLDER).is_dir() {
        for single in SINGLE {
            let (found, prepared_s) = pictures(&real_single(lab, single)?);
            seen.rows.push(row(single.2, &found, prepared_s, true));
        }
    }
    Ok(Some(Section {
        title: "Starts from no guess at all".to_owned(),
        text: vec![
            "Nobody says where a body is: candidates come from its silhouettes over all rotations (`silhouette`), a descent from each of the \
             likeliest decides. Ideal outlines: rotations drawn evenly over all, the centroid within 15 mm of the origin along each \
             axis, models of 15,000 points; outlines of `fixtures/scene` are drawn by this program from the matched mesh itself. The right basin is within 15 degrees and 12 mm, right within 1 mm and 1 degree. Times run from curves to the best descent \
             of all, one thread a pose. One view alone tells depth by size, and mirror images apart by little: what counts \
             there is that the right basin is among the candidates."
                .to_owned(),
            "Pictures: all edges of both bodies, bones and the intensifier's border, nothing chosen. For the real tray nobody published poses; \
             its match from a person's rough poses stands for them (eleven frames). With one real view the reference's depth is no better than ours, \
             so the right basin alone is told. Real sequences are not part of this project; where they are missing their rows are \
             left out."
                .to_owned(),
            goals.text(),
        ],
        tables: vec![ideal, one, seen],
        plots: Vec::new(),
    }))
}
