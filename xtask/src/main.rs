//! `cargo xtask COMMAND`: thin, calls the crates.
//!
//! `cargo xtask run pipeline.toml` is `biplane run pipeline.toml`, and every other command of the program passes through
//! too. What only the project itself needs is here: `validate`, `compare` and `starts`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use biplane::prepare::Prepared;
use biplane::results::pose_line;
use biplane::study::Study;
use biplane::tables::{PoseTable, same_frame};
use biplane_acquisition::meshes::{LengthUnit, read_mesh};
use biplane_validation::{
    Check, Distribution, STARTS, SceneError, StartOffset, knee, noise, read_body, read_reference, real_knee,
    seen_from,
};
use clap::{Parser, Subcommand, ValueEnum};

#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Measure accuracy from seeded starts against poses that this program did not make, and hold it to its limits.
    Validate {
        /// What to measure.
        #[arg(value_enum, default_values_t = [Scenes::Knee, Scenes::Real])]
        scenes: Vec<Scenes>,
        /// Starts for each frame.
        #[arg(long, default_value_t = STARTS.count)]
        count: usize,
        #[command(flatten)]
        drawn: Drawn,
    },
    /// Compare a study's results/poses.csv with known poses; fails beyond the limits.
    Compare {
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

#[derive(Clone, Copy, ValueEnum)]
enum Scenes {
    /// The example study: simulated, truth known.
    Knee,
    /// The real knee implant, where its data folder is present.
    Real,
    /// The example study from starts turned by 45 to 180 degrees: none may be called good where it is wrong (minutes).
    Turned,
}

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let own = ["validate", "compare", "relative", "picture", "starts"];
    if !arguments.get(1).is_some_and(|a| own.iter().any(|o| a == o)) {
        let passed = arguments.into_iter().skip(1);
        return biplane::cli::main(std::iter::once(OsString::from("cargo xtask")).chain(passed));
    }
    let done = match Arguments::parse().task {
        Task::Validate { scenes, count, drawn } => validate(&scenes, &drawn.offset(count)),
        Task::Compare { pipeline, body, reference, limit_mm, limit_deg } => {
            compare(&pipeline, &body, &reference, limit_mm, limit_deg)
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

fn validate(scenes: &[Scenes], starts: &StartOffset) -> Result<bool, SceneError> {
    let mut beyond = Vec::new();
    for scene in scenes {
        let checks = match scene {
            Scenes::Knee => knee(),
            Scenes::Real => real_knee(root()).unwrap_or_else(|| {
                println!("real knee: left out, its data folder ../shared/data/real is not here");
                Vec::new()
            }),
            Scenes::Turned => {
                for check in knee() {
                    let check = Check { limits: None, ..check };
                    let summary = check.measure_turned(root())?;
                    println!("{}: 42 starts a frame, turned by 45 to 180 degrees about six axes", check.name);
                    println!("{summary}");
                    beyond.extend(check.passed_limits(&summary));
                }
                continue;
            }
        };
        for check in checks {
            // The limits are for the starts they were set with.
            let same =
                starts.translation_mm == STARTS.translation_mm && starts.rotation_deg == STARTS.rotation_deg;
            let check = Check { starts: *starts, limits: check.limits.filter(|_| same), ..check };
            let begun = std::time::Instant::now();
            let summary = check.measure(root())?;
            println!(
                "{}: {} starts a frame, each {} mm and {} degrees off, seed {} ({:.1} s)",
                check.name,
                starts.count,
                starts.translation_mm,
                starts.rotation_deg,
                starts.seed,
                begun.elapsed().as_secs_f64()
            );
            println!("{summary}");
            beyond.extend(check.passed_limits(&summary));
        }
    }
    for line in &beyond {
        println!("BEYOND ITS LIMIT: {line}");
    }
    Ok(beyond.is_empty())
}

fn compare(
    pipeline: &Path,
    body: &str,
    reference: &Path,
    limit_mm: f64,
    limit_deg: f64,
) -> Result<bool, SceneError> {
    let prepared = Prepared::of(Study::load(pipeline)?)?;
    let (_, mesh) = read_body(&prepared, pipeline, body)?;
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
) -> Result<bool, SceneError> {
    let prepared = Prepared::of(Study::load(pipeline)?)?;
    let (_, mesh) = read_body(&prepared, pipeline, body)?;
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

fn starts(trial: &str, bodies: &[String], offset: &StartOffset) -> Result<bool, SceneError> {
    println!("{}", biplane::tables::EXAMPLE_HEADER);
    for (number, text) in bodies.iter().enumerate() {
        let parts = text.split_once('=').and_then(|(body, files)| Some((body, files.split_once(',')?)));
        let Some((body, (mesh, reference))) = parts else {
            eprintln!("{text}: expected BODY=MESH.stl,REFERENCE.csv");
            return Ok(false);
        };
        let mesh = read_mesh(mesh, LengthUnit::Millimetres).map_err(|e| SceneError::Mesh(e.to_string()))?;
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
