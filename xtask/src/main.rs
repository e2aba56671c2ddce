//! `cargo xtask COMMAND`: thin, calls the crates.
//!
//! `cargo xtask run pipeline.toml` is `biplane run pipeline.toml`, and every other command of the program passes through
//! too. What only the project itself needs is here: `validate`, `accuracy`, `kinematics` and `starts`.

mod kinematics;
mod pictures;

use std::error::Error;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use biplane::prepare::Prepared;
use biplane::results::pose_line;
use biplane::study::Study;
use biplane::tables::{PoseTable, same_frame};
use biplane_acquisition::meshes::{LengthUnit, read_mesh};
use biplane_stage::Store;
use biplane_validation::{
    Budgets, Distribution, Effort, Lab, STARTS, SceneError, StartOffset, Table, noise, read_body,
    read_reference, sections, seen_from,
};
use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Make known truth, run the product's own stages on it, print the thesis's tables with ours beside them, and hold
    /// every figure to its limit. The full run writes docs/validation.md and the README's table (half an hour on two cores).
    Validate {
        /// The form of a minute or two that CI runs: fewer frames; writes nothing.
        #[arg(long)]
        quick: bool,
        /// Measure these sections alone; a full run of them takes their place in docs/validation.md.
        #[arg(long, value_delimiter = ',', value_name = "SECTION", value_parser = section_names())]
        only: Vec<String>,
        /// Seed of all that is drawn; limits are for seed 1, and another one writes nothing.
        #[arg(long, default_value_t = SEED)]
        seed: u64,
    },
    /// Hold a study's results/poses.csv against known poses; fails beyond the limits.
    Accuracy {
        /// The study.
        pipeline: PathBuf,
        /// The body.
        #[arg(long)]
        body: String,
        /// CSV: frame, then the 16 numbers of world_from_model.
        #[arg(long)]
        reference: PathBuf,
        /// Largest displacement of the mesh's centroid in any frame, mm.
        #[arg(long)]
        limit_mm: f64,
        /// Largest angle in any frame, degrees.
        #[arg(long)]
        limit_deg: f64,
    },
    /// Hold a study's results/kinematics.csv against what known poses of a joint's bodies give; fails beyond the limits.
    Kinematics {
        /// The study.
        pipeline: PathBuf,
        /// The joint.
        #[arg(long)]
        joint: String,
        /// CSV: frame, then the 16 numbers of world_from_model of the proximal body.
        #[arg(long)]
        proximal: PathBuf,
        /// The same of the distal body.
        #[arg(long)]
        distal: PathBuf,
        /// Largest error of a translation in any frame, mm.
        #[arg(long)]
        limit_mm: f64,
        /// Largest error of an angle in any frame, degrees.
        #[arg(long)]
        limit_deg: f64,
    },
    /// Show where one body lies in the frame of another over frames that follow each other, with the poses of
    /// results/poses.csv and with known poses of the first body, and how much noise each has: needs no truth.
    Relative {
        /// The study.
        pipeline: PathBuf,
        /// The body.
        #[arg(long)]
        body: String,
        /// The other body.
        #[arg(long)]
        seen_from: String,
        /// CSV: frame, then the 16 numbers of world_from_model of the first body.
        #[arg(long)]
        reference: PathBuf,
        /// First and last frame label, for example 050..060.
        #[arg(long)]
        frames: String,
    },
    /// Put pictures of the same size side by side at half their size: how the README's picture is made.
    Picture {
        /// PNG files, left to right.
        #[arg(required = true)]
        pictures: Vec<PathBuf>,
        /// The PNG to write.
        #[arg(long)]
        output: PathBuf,
    },
    /// Take pictures of a report with a Chromium without a screen: those of docs/images are of the example study.
    Pictures {
        /// The folder of results.
        results: PathBuf,
        /// The folder to write into.
        #[arg(long, default_value = "docs/images")]
        output: PathBuf,
    },
    /// Print start poses (CSV) that lie exactly so far from known poses, in random directions.
    Starts {
        /// The trial they are for.
        trial: String,
        /// The bodies, each with its mesh (mm) and its known poses: BODY=MESH.stl,REFERENCE.csv
        #[arg(required = true)]
        bodies: Vec<String>,
        #[command(flatten)]
        drawn: Drawn,
    },
}

/// How start poses are drawn around known ones.
#[derive(clap::Args)]
struct Drawn {
    /// How far off each start is, mm.
    #[arg(long, default_value_t = STARTS.translation_mm)]
    mm: f64,
    /// How far off each start is, degrees.
    #[arg(long, default_value_t = STARTS.rotation_deg)]
    deg: f64,
    /// Seed of the starts.
    #[arg(long, default_value_t = STARTS.seed)]
    seed: u64,
}

impl Drawn {
    fn offset(&self, count: usize) -> StartOffset {
        StartOffset { translation_mm: self.mm, rotation_deg: self.deg, count, seed: self.seed }
    }
}

/// The seed that limits are stated for.
const SEED: u64 = 1;

fn section_names() -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(sections::ALL.iter().map(|s| s.0))
}

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let own = ["validate", "accuracy", "kinematics", "relative", "picture", "pictures", "starts"];
    if !arguments.get(1).is_some_and(|a| own.iter().any(|o| a == o)) {
        let passed = arguments.into_iter().skip(1);
        return biplane::cli::main(std::iter::once(OsString::from("cargo xtask")).chain(passed));
    }
    let done = match Arguments::parse().task {
        Task::Validate { quick, only, seed } => validate(quick, &only, seed),
        Task::Accuracy { pipeline, body, reference, limit_mm, limit_deg } => {
            accuracy(&pipeline, &body, &reference, limit_mm, limit_deg)
        }
        Task::Kinematics { pipeline, joint, proximal, distal, limit_mm, limit_deg } => {
            kinematics::kinematics(&pipeline, &joint, [&proximal, &distal], (limit_mm, limit_deg))
        }
        Task::Relative { pipeline, body, seen_from, reference, frames } => {
            relative(&pipeline, &body, &seen_from, &reference, &frames)
        }
        Task::Picture { pictures, output } => match side_by_side(&pictures, &output) {
            Ok(()) => Ok(true),
            Err(error) => {
                eprintln!("{error}");
                Ok(false)
            }
        },
        Task::Pictures { results, output } => pictures::pictures(&results, &output),
        Task::Starts { trial, bodies, drawn } => starts(&trial, &bodies, &drawn.offset(1)),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(3)
        }
    }
}

/// The project's folder.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

/// What stands above the sections of docs/validation.md.
const HEAD: &str = "# Validation

Written by `cargo xtask validate`, which makes known truth, runs the program's own stages on it and holds every figure of
ours to the limit below it; `--quick` does a part of it in CI. Seed 1. Truth is made by `crates/testing/phantom`, which shares no
projection, outline or distortion with the code that it measures, except where a section says that it is another's. Errors
of a pose are at the area centroid of its mesh ([conventions.md](conventions.md)); a match is *wrong* beyond 1 mm or 1 degree.
Times are of one core of the machine that wrote this page. Limits are in `crates/testing/validation/budgets.toml`.
";

fn validate(quick: bool, only: &[String], seed: u64) -> Result<bool, Box<dyn Error>> {
    let budgets = Budgets::built_in()?;
    let effort = if quick { Effort::Quick } else { Effort::Full };
    let lab = Lab::new(root(), effort, seed);
    let mut measured = Vec::new();
    for (name, measure) in sections::ALL.iter().filter(|s| only.is_empty() || only.iter().any(|o| o == s.0)) {
        let begun = std::time::Instant::now();
        eprintln!("{name} ...");
        match measure(&lab)? {
            Some(section) => {
                println!("{}", section.markdown(&budgets, "docs/validation"));
                measured.push(section);
            }
            None => println!("{name}: left out, its data is not here\n"),
        }
        eprintln!("{name}: {:.1} s", begun.elapsed().as_secs_f64());
    }
    let tables: Vec<&Table> = measured.iter().flat_map(|s| &s.tables).collect();
    let mut beyond: Vec<String> = tables.iter().flat_map(|t| t.beyond(&budgets)).collect();
    if !quick && only.is_empty() && measured.len() == sections::ALL.len() {
        beyond.extend(budgets.left_over(&tables));
    }
    if !quick && only.is_empty() && seed == SEED {
        biplane_validation::write(&root().join("docs"), HEAD, &measured, &budgets)?;
        let path = root().join("README.md");
        match biplane_validation::readme(&std::fs::read_to_string(&path)?, &measured) {
            Some(text) => std::fs::write(path, text)?,
            None => beyond.push("README.md: the marks between which its table goes are gone".to_owned()),
        }
        println!("written: docs/validation.md, docs/validation/*.svg, the table of README.md");
    }
    if !quick && !only.is_empty() && seed == SEED {
        biplane_validation::put(&root().join("docs"), &measured, &budgets)?;
    }
    for line in &beyond {
        println!("BEYOND ITS LIMIT: {line}");
    }
    println!("{} figures beyond their limits", beyond.len());
    Ok(beyond.is_empty())
}

fn accuracy(
    pipeline: &Path,
    body: &str,
    reference: &Path,
    limit_mm: f64,
    limit_deg: f64,
) -> Result<bool, Box<dyn Error>> {
    let prepared = Prepared::of(Study::load(pipeline)?)?;
    let store = Store::open(&prepared.study.hidden())?;
    let (_, mesh) = read_body(&prepared, &store, pipeline, body)?;
    let results = prepared.study.output.join("poses.csv");
    let table = PoseTable::read(&results).map_err(|e| SceneError::Mesh(e.to_string()))?;
    let known = read_reference(reference)?;
    let centroid = mesh.area_centroid();
    let errors: Vec<_> = known
        .iter()
        .filter_map(|(label, pose)| {
            let row = table.rows.iter().find(|r| r.body == body && same_frame(&r.frame, label))?;
            Some(row.pose.error_against(pose, &centroid))
        })
        .collect();
    let mm = Distribution::of(errors.iter().map(|e| e.translation_mm).collect());
    let deg = Distribution::of(errors.iter().map(|e| e.rotation_rad.to_degrees()).collect());
    println!("{body}: {} of {} frames with a known pose", errors.len(), known.len());
    println!("  translation, mm   {mm}; limit {limit_mm}");
    println!("  rotation, degrees {deg}; limit {limit_deg}");
    Ok(!errors.is_empty() && errors.len() == known.len() && mm.worst <= limit_mm && deg.worst <= limit_deg)
}

fn relative(
    pipeline: &Path,
    body: &str,
    other: &str,
    reference: &Path,
    frames: &str,
) -> Result<bool, Box<dyn Error>> {
    let prepared = Prepared::of(Study::load(pipeline)?)?;
    let store = Store::open(&prepared.study.hidden())?;
    let (_, mesh) = read_body(&prepared, &store, pipeline, body)?;
    let table = PoseTable::read(&prepared.study.output.join("poses.csv"))
        .map_err(|e| SceneError::Mesh(e.to_string()))?;
    let centroid = mesh.area_centroid();
    let (first, last) = frames.split_once("..").unwrap_or((frames, frames));
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    println!("frame  {body}'s centroid in the model frame of {other}, mm: results | reference");
    for (label, known) in read_reference(reference)? {
        let row = |name: &str| table.rows.iter().find(|r| r.body == name && same_frame(&r.frame, &label));
        let (Some(found), Some(base)) = (row(body), row(other)) else { continue };
        if label.as_str() < first || label.as_str() > last {
            continue;
        }
        let (a, b) =
            (seen_from(&base.pose, &found.pose, &centroid), seen_from(&base.pose, &known, &centroid));
        println!("{label:5}  {:8.3} {:8.3} {:8.3} | {:8.3} {:8.3} {:8.3}", a.x, a.y, a.z, b.x, b.y, b.z);
        ours.push(a);
        theirs.push(b);
    }
    match (noise(&ours), noise(&theirs)) {
        (Some(a), Some(b)) => {
            println!("noise  {:8.3} {:8.3} {:8.3} | {:8.3} {:8.3} {:8.3}", a.x, a.y, a.z, b.x, b.y, b.z);
            Ok(true)
        }
        _ => {
            eprintln!("fewer than four frames with poses of both bodies from {first} to {last}");
            Ok(false)
        }
    }
}

fn side_by_side(pictures: &[PathBuf], output: &Path) -> image::ImageResult<()> {
    let halves = pictures
        .iter()
        .map(|path| {
            let full = image::open(path)?;
            let filter = image::imageops::FilterType::Triangle;
            Ok(full.resize(full.width() / 2, full.height() / 2, filter).to_rgb8())
        })
        .collect::<image::ImageResult<Vec<_>>>()?;
    let width = halves.iter().map(image::RgbImage::width).sum();
    let mut joined =
        image::RgbImage::new(width, halves.iter().map(image::RgbImage::height).max().unwrap_or(0));
    let mut x = 0;
    for half in &halves {
        image::imageops::replace(&mut joined, half, x, 0);
        x += i64::from(half.width());
    }
    joined.save(output)
}

fn starts(trial: &str, bodies: &[String], offset: &StartOffset) -> Result<bool, Box<dyn Error>> {
    println!("{}", biplane::tables::EXAMPLE_HEADER);
    for (number, text) in bodies.iter().enumerate() {
        let parts = text.split_once('=').and_then(|(body, files)| Some((body, files.split_once(',')?)));
        let Some((body, (mesh, reference))) = parts else {
            eprintln!("{text}: expected BODY=MESH.stl,REFERENCE.csv");
            return Ok(false);
        };
        let mesh =
            read_mesh(mesh, Some(LengthUnit::Millimetres)).map_err(|e| SceneError::Mesh(e.to_string()))?;
        let centroid = mesh.model.0.area_centroid();
        for (index, (label, pose)) in read_reference(Path::new(reference))?.iter().enumerate() {
            // Bodies of one frame are off in different directions.
            for start in offset.draw(pose, &centroid, index + 1000 * number) {
                println!("{}", pose_line(trial, label, body, start));
            }
        }
    }
    Ok(true)
}
