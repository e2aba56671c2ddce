//! The command line: what it takes, what it prints, how it ends.
//!
//! Results go to stdout, everything else to stderr. Exit codes: 0 good, 1 some items failed, 2 the configuration (or the
//! command line) is wrong, 3 an input is wrong, 4 the program or the disk failed, 130 stopped by a person.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use biplane_acquisition::inspect::InspectError;
use biplane_artifact::AxesSource;
use biplane_objective::Kind;
use biplane_optimiser::Optimiser;
use biplane_stage::{Clean, Context, Size, Store};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ArgAction, Parser, Subcommand};

use crate::compare::{CompareError, CompareWish, compare};
use crate::convert::{ConvertArguments, ConvertError, convert};
use crate::correct::{By, CorrectError, correct};
use crate::diagnostics::slashes;
use crate::doctor::{DoctorError, doctor};
use crate::edit::{EditCommandError, Wish, edit};
use crate::edit_list::{EditListError, list};
use crate::exchange::{ExchangeError, Foreign, difference, import};
use crate::exports::{EXPORTS, TraLayout};
use crate::logging::{self, LogFormat};
use crate::look::{Fate, LookError, counts, look};
use crate::models::MODELS;
use crate::outcome::{ModelOutcome, Outcome, SlicesOutcome};
use crate::run::{RunError, run};
use crate::slices::SLICES;
use crate::slices::command::{SliceWish, edit_slices};
use crate::smoothing::effect;
use crate::study::{Study, StudyError};
use crate::tables::{PoseTable, TableError};
use crate::{init, reference, summary};

/// Outlines to look at that are listed at the end of a run.
const FEW_OUTLINES: usize = 20;

/// How a command ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// All is well.
    Good = 0,
    /// Some items failed.
    SomeFailed = 1,
    /// `pipeline.toml` or the command line is wrong.
    BadConfiguration = 2,
    /// An input file is wrong.
    BadInput = 3,
    /// The program or the disk failed.
    Internal = 4,
    /// Stopped by a person.
    Stopped = 130,
}

impl From<End> for ExitCode {
    fn from(end: End) -> Self {
        ExitCode::from(end as u8)
    }
}

/// From two X-ray videos of a joint, their calibrations and meshes of its bones or implants to the pose of each body in
/// each frame.
///
/// A study is a folder with a `pipeline.toml`. `biplane init FOLDER` writes one for a folder of data; `biplane run` does
/// what is to do and no more: what was computed before, from the same files and settings, is not computed again.
#[derive(Debug, Parser)]
#[command(
    name = "biplane",
    version,
    after_help = "Examples:
  biplane init my-study           look at a folder of data, write my-study/pipeline.toml
  biplane inspect frames/A/*.tif  say what files hold
  biplane run my-study            images to poses: results/poses.csv, overlays, report.html
  biplane explain 0017            why the items of frame 0017 would run
  biplane clean --dry-run         what the store could free

Exit codes: 0 good, 1 some frames failed, 2 bad configuration, 3 bad input, 4 internal, 130 stopped."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// How log lines on stderr look.
    #[arg(long, global = true, value_enum, default_value = "text")]
    log_format: LogFormat,
    /// Say more; twice for everything.
    #[arg(short, long, global = true, action = ArgAction::Count)]
    verbose: u8,
    /// Say only what went wrong.
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
}

#[derive(Debug, clap::Args)]
struct Pipeline {
    /// The pipeline file, or the folder it lies in.
    #[arg(default_value = "pipeline.toml", value_name = "PIPELINE")]
    file: PathBuf,
}

/// Poses of another program, and what its file does not say of itself.
#[derive(Debug, clap::Args)]
struct ForeignArguments {
    /// The file.
    file: PathBuf,
    /// The study.
    #[arg(long, default_value = "pipeline.toml", value_name = "FILE")]
    pipeline: PathBuf,
    /// The trial whose frames it has.
    #[arg(long, value_name = "NAME")]
    trial: Option<String>,
    /// A body in it; more than one in their order.
    #[arg(long = "body", value_name = "NAME")]
    bodies: Vec<String>,
    /// JointTrack: the fluoroscope whose camera it is in the frame of.
    #[arg(long, value_name = "NAME")]
    view: Option<String>,
    /// Autoscoper: how a pose is written, where the numbers do not tell.
    #[arg(long, value_enum)]
    layout: Option<TraLayout>,
    /// Autoscoper: lengths are in centimetres.
    #[arg(long)]
    centimetres: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Do what is to do: images to curves to poses, a table and a report.
    #[command(after_help = "Examples:
  biplane run                       the pipeline.toml of this folder
  biplane run study/pipeline.toml --threads 4

Stop it with Ctrl-C at any time: finished frames are kept, and the same command goes on.
To correct a pose, write a row into edits/poses.csv beside the pipeline file and run again;
to correct an outline, `biplane edit`.")]
    Run {
        #[command(flatten)]
        pipeline: Pipeline,
        /// Threads; 0 is one for each core. The results do not depend on it.
        #[arg(long, default_value_t = 0)]
        threads: usize,
    },
    /// Check the pipeline file and the inputs, and say how much a run would do; nothing is run.
    #[command(after_help = "Examples:
  biplane plan                      how many items of each step are cached or would run, and what cannot run
  biplane explain                   which ones, and why")]
    Plan {
        #[command(flatten)]
        pipeline: Pipeline,
    },
    /// Say why each step would run.
    #[command(after_help = "Examples:
  biplane explain                     everything that would run
  biplane explain match/lunge/0017    the bodies of one frame
  biplane explain femur --all         every item with `femur` in its name, cached ones too")]
    Explain {
        /// Part of an item's name (step/trial/frame/view or body); `*` stands for anything.
        pattern: Option<String>,
        /// The pipeline file, or the folder it lies in.
        #[arg(short, long, default_value = "pipeline.toml")]
        pipeline: PathBuf,
        /// Cached items too.
        #[arg(long)]
        all: bool,
    },
    /// Write outlines of bodies for a person to put right: drawings that Inkscape opens, in edits/ beside the pipeline file.
    #[command(after_help = "Examples:
  biplane edit lunge 17 A           edits/lunge/0017_A.svg: the outlines in one picture
  biplane edit lunge 17             in every view of a frame
  biplane edit --flagged            where little of an outline was found, or the match is not good
  biplane edit lunge 17 A --csv     as a table, for CAD or MATLAB
  biplane edit --slices femur 17    slice 17 of a volume; without a number, those that ask to be looked at

The next run takes what a person changed in place of its own outlines, for that picture and those bodies alone. A file that nobody
changed is no edit, and no file is overwritten.")]
    Edit {
        /// The trial; with none, every picture that asks to be looked at.
        trial: Option<String>,
        /// The frame; with none, every picture of the trial that asks to be looked at.
        frame: Option<String>,
        /// The view; with none, all of them.
        view: Option<String>,
        /// Every picture that asks to be looked at.
        #[arg(long, conflicts_with = "frame")]
        flagged: bool,
        /// Slices of this bone of [[slices]]; the first argument is then the number of a slice.
        #[arg(long, value_name = "BONE", conflicts_with = "frame")]
        slices: Option<String>,
        /// Tables, not drawings.
        #[arg(long)]
        csv: bool,
        /// Where an edit is there already, write what the program finds beside it, as `.new`.
        #[arg(long)]
        again: bool,
        /// The pipeline file, or the folder it lies in.
        #[arg(short, long, default_value = "pipeline.toml")]
        pipeline: PathBuf,
    },
    /// List the edited contours: whether they are used, and how far they moved the outlines.
    #[command(after_help = "Exit code 1 where a file cannot be used, or is of no picture of the study.")]
    Edits {
        #[command(flatten)]
        pipeline: Pipeline,
    },
    /// Say whether the calibration still fits the frames: with the matches of the last run, do the views agree, has the
    /// picture moved on the detector, how sure can a pose be?
    #[command(after_help = "Examples:
  biplane doctor                    every trial of the study
  biplane doctor --trial lunge

The limits are in [doctor] of the pipeline file. Exit code 1 where one is not kept.")]
    Doctor {
        #[command(flatten)]
        pipeline: Pipeline,
        /// This trial alone.
        #[arg(long)]
        trial: Option<String>,
    },
    /// Compare objectives and optimisers on the study: error or repeatability, share converged, calls and time, as the thesis's
    /// Tables 5.1 and 5.2. Changes no result.
    #[command(after_help = "Examples:
  biplane compare                                     three frames of every trial, without known poses: repeatability
  biplane compare --body femur --reference known.csv  errors against known poses (a table of poses, or 16 numbers a row)
  biplane compare --objectives symmetric,inverse_point --optimisers sqp,powell --frames 0 --csv compare.csv

Searches start where [match.search] of the pipeline file says, whatever the study's own method is.")]
    Compare {
        #[command(flatten)]
        pipeline: Pipeline,
        /// Objectives, parted by commas; all of them if none is named.
        #[arg(long, value_delimiter = ',', value_name = "NAME", value_parser = named(&Kind::ALL, Kind::name))]
        objectives: Vec<Kind>,
        /// Optimisers, parted by commas.
        #[arg(
            long,
            value_delimiter = ',',
            value_name = "NAME",
            value_parser = named(&Optimiser::ALL, Optimiser::name),
            default_value = "levenberg_marquardt,sqp,bfgs"
        )]
        optimisers: Vec<Optimiser>,
        /// Leave out `method = "rim"` and `"bingham2006"`.
        #[arg(long)]
        no_presets: bool,
        /// This trial alone.
        #[arg(long)]
        trial: Option<String>,
        /// This body alone.
        #[arg(long)]
        body: Option<String>,
        /// Frames of each trial, evenly over it; 0 for all.
        #[arg(long, default_value_t = 3)]
        frames: usize,
        /// Starts of each frame, in place of those of [match.search].
        #[arg(long)]
        starts: Option<usize>,
        /// Calls of each search, in place of those of [match.search].
        #[arg(long)]
        calls: Option<usize>,
        /// Known poses: errors are told, and only of frames that have one.
        #[arg(long, value_name = "CSV")]
        reference: Option<PathBuf>,
        /// Write the table as CSV too.
        #[arg(long, value_name = "FILE")]
        csv: Option<PathBuf>,
        /// Threads; 0 is one for each core. With more than one, times are not to be relied on.
        #[arg(long, default_value_t = 1)]
        threads: usize,
    },
    /// Write the report of the last run as one file with chosen frames, to be sent to somebody.
    #[command(after_help = "Examples:
  biplane report --single-file --frames 3,17           results/report_single.html: these frames of every trial
  biplane report --single-file --frames lunge/3 --output knee.html

It is made of results/report.html and results/report/ as the last run wrote them. Without --frames it has every frame.")]
    Report {
        #[command(flatten)]
        pipeline: Pipeline,
        /// Everything in one file; without it the path of the report is printed, and nothing is written.
        #[arg(long)]
        single_file: bool,
        /// Labels or numbers of frames, each with its trial and `/` before it or not, parted by commas.
        #[arg(long, value_delimiter = ',', value_name = "FRAME", requires = "single_file")]
        frames: Vec<String>,
        /// The file; by default report_single.html in the folder of results.
        #[arg(short, long, requires = "single_file")]
        output: Option<PathBuf>,
    },
    /// Show the results of the last run and the size of the store.
    #[command(
        after_help = "The fit is the root mean square distance of the outline from its edges, over all views.
The store, .biplane/ beside the pipeline file, keeps what was computed; deleting it loses only time."
    )]
    Status {
        #[command(flatten)]
        pipeline: Pipeline,
    },
    /// Free what the store keeps of earlier settings and inputs. Results and edits are left alone.
    #[command(after_help = "Examples:
  biplane clean --dry-run           how much it would free
  biplane clean                     what no item of the study uses any more
  biplane clean --all               everything: the next run computes all anew")]
    Clean {
        #[command(flatten)]
        pipeline: Pipeline,
        /// Only say what would be freed.
        #[arg(long)]
        dry_run: bool,
        /// Free everything: the next run starts from the images.
        #[arg(long)]
        all: bool,
    },
    /// Say what files hold: images, calibrations, distortion tables, meshes, tables of poses.
    #[command(after_help = "Examples:
  biplane inspect cam1.txt                  source, focal length, principal point, convention
  biplane inspect frames/A frames/A/1.tif   size, bits, levels, frames a second
  biplane inspect femur.stl starts.csv      size and unit of a mesh; which frames a table has poses for")]
    Inspect {
        /// Files, or folders of images.
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
    /// Make a table of start poses from another program's file: Autoscoper (.tra), XMALab, JointTrack (.jts, .jtak, .jtap).
    #[command(after_help = "Examples:
  biplane import old/femur.jts --trial lunge --body femur --output starts.csv
  biplane import lunge.tra --body femur --body tibia --layout matrix-rows     prints the table

Its frames are those of the trial, from the first. Name the table in the pipeline file: starts = \"starts.csv\".")]
    Import {
        #[command(flatten)]
        foreign: ForeignArguments,
        /// Where to write the table; an existing file is not overwritten. Not given, it is printed.
        #[arg(long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Say how far results lie from the poses of another file: median, 95 %, worst, and the frames that are farthest off.
    #[command(after_help = "Examples:
  biplane difference old/poses.csv
  biplane difference femur.jts --trial lunge --body femur")]
    Difference {
        #[command(flatten)]
        foreign: ForeignArguments,
        /// Poses in place of those of results/poses.csv.
        #[arg(long, value_name = "FILE")]
        of: Option<PathBuf>,
    },
    /// Write the frames without distortion, for other programs; a run needs no such pictures.
    #[command(after_help = "Examples:
  biplane correct --output corrected                every frame, and a mask of what is valid
  biplane correct study --output c --by bilinear")]
    Correct {
        #[command(flatten)]
        pipeline: Pipeline,
        /// The folder to write into: TRIAL/VIEW/LABEL.png.
        #[arg(short, long)]
        output: PathBuf,
        /// How a grey between recorded pixels is found.
        #[arg(long, value_enum, default_value = "bicubic")]
        by: By,
        /// Overwrite pictures that are there.
        #[arg(long)]
        force: bool,
    },
    /// Turn a calibration into another program's format, and say what that cannot hold.
    #[command(after_help = "Examples:
  biplane convert results/calibration/fluoroscopes.json --view A --to mayacam2 --output A.txt
  biplane convert cam1.txt cam2.txt --to jointtrack-biplane --pixel-mm 0.3 --output both.txt")]
    Convert(ConvertArguments),
    /// Look at a folder of data and write a commented pipeline.toml for it, and a table of start poses that may be filled in.
    #[command(
        after_help = "It looks for: folders of pictures side by side (one a fluoroscope), calibrations with the fluoroscope's
name in theirs, meshes, distortion tables, tables of start poses. What it does not find, it says.
No file is overwritten. Then: read pipeline.toml through, `biplane plan`, `biplane run`."
    )]
    Init {
        /// The folder; the file is written there, unless there is one.
        #[arg(default_value = ".")]
        folder: PathBuf,
    },
    /// Print the JSON Schema of pipeline.toml, for editors.
    Schema,
}

/// Runs one command line; the first argument is the program's name.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(help) => {
            let end = if help.use_stderr() { End::BadConfiguration } else { End::Good };
            let _ = help.print();
            return end.into();
        }
    };
    let verbosity = if arguments.quiet { -1 } else { i8::try_from(arguments.verbose).unwrap_or(i8::MAX) };
    logging::start(arguments.log_format, verbosity);
    match obey(arguments.command) {
        Ok(end) => end.into(),
        Err((end, message)) => {
            eprintln!("{message}");
            end.into()
        }
    }
}

type Ended = Result<End, (End, String)>;

impl ForeignArguments {
    fn taken(self) -> Result<(Study, PathBuf, Foreign), (End, String)> {
        let Self { file, pipeline, trial, bodies, view, layout, centimetres } = self;
        Ok((load(&pipeline)?, file, Foreign { trial, bodies, view, layout, centimetres }))
    }
}

fn exchange_failed(error: ExchangeError) -> (End, String) {
    let end = match &error {
        ExchangeError::Store(_) => End::Internal,
        ExchangeError::Asked(_) => End::BadConfiguration,
        _ => End::BadInput,
    };
    (end, error.to_string())
}

fn obey(command: Command) -> Ended {
    match command {
        Command::Run { pipeline, threads } => run_command(load(&pipeline.file)?, threads),
        Command::Plan { pipeline } => {
            let looks = look(load(&pipeline.file)?).map_err(look_failed)?;
            print(&counts(&looks));
            let failing: Vec<&str> =
                looks.iter().filter(|l| l.fate == Fate::Fails).map(|l| l.line.as_str()).collect();
            if failing.is_empty() {
                return Ok(End::Good);
            }
            print(&format!("\nCannot run:\n{}\n", failing.join("\n")));
            Ok(End::SomeFailed)
        }
        Command::Explain { pattern, pipeline, all } => {
            let looks = look(load(&pipeline)?).map_err(look_failed)?;
            let pattern = pattern.map(|p| glob::Pattern::new(&format!("*{p}*")));
            let pattern =
                pattern.transpose().map_err(|e| (End::BadConfiguration, format!("the pattern: {e}")))?;
            let matching: Vec<_> = looks
                .iter()
                .filter(|l| {
                    let name = l.line.split(':').next().unwrap_or_default();
                    pattern.as_ref().is_none_or(|p| p.matches(name))
                })
                .collect();
            let shown: Vec<&str> =
                matching.iter().filter(|l| all || l.fate != Fate::Cached).map(|l| l.line.as_str()).collect();
            match (matching.len(), shown.len()) {
                (0, _) => print("no item has such a name (step/trial/frame/view or body)\n"),
                (n, 0) => print(&format!("nothing would run: {n} items are cached\n")),
                _ => print(&(shown.join("\n") + "\n")),
            }
            Ok(End::Good)
        }
        Command::Edit { trial, frame, view, flagged: _, slices, csv, again, pipeline } => {
            let [trial, frame, view] = [&trial, &frame, &view].map(Option::as_deref);
            let study = load(&pipeline)?;
            let written = match &slices {
                Some(bone) => edit_slices(study, &SliceWish { bone, slice: trial, csv, again }),
                None => edit(study, &Wish { trial, frame, view, csv, again }),
            };
            let text = written.map_err(|error| {
                let end = match &error {
                    EditCommandError::Exists(_) | EditCommandError::NoSuch { .. } => End::BadConfiguration,
                    EditCommandError::Store(_) | EditCommandError::Write { .. } => End::Internal,
                    _ => End::BadInput,
                };
                (end, error.to_string())
            })?;
            print(&text);
            Ok(End::Good)
        }
        Command::Edits { pipeline } => {
            let (text, well) = list(load(&pipeline.file)?).map_err(|error| {
                let end =
                    if matches!(error, EditListError::Store(_)) { End::Internal } else { End::BadInput };
                (end, error.to_string())
            })?;
            print(&text);
            Ok(if well { End::Good } else { End::SomeFailed })
        }
        Command::Import { foreign, output } => {
            let (study, path, wish) = foreign.taken()?;
            let text = import(study, &path, &wish).map_err(exchange_failed)?;
            match output {
                None => print(&text),
                Some(output) => {
                    let written = std::fs::File::create_new(&output).and_then(|mut file| {
                        use std::io::Write;
                        file.write_all(text.as_bytes())
                    });
                    written.map_err(|e| {
                        (End::BadInput, format!("{}: {e}; nothing was overwritten", output.display()))
                    })?;
                    let poses = text.lines().count().saturating_sub(1);
                    print(&format!("{}: {poses} poses\n", output.display()));
                }
            }
            Ok(End::Good)
        }
        Command::Difference { foreign, of } => {
            let (study, path, wish) = foreign.taken()?;
            print(&difference(study, &path, of.as_deref(), &wish).map_err(exchange_failed)?);
            Ok(End::Good)
        }
        Command::Report { pipeline, single_file, frames, output } => {
            let study = load(&pipeline.file)?;
            let path = study.output.join("report.html");
            if !single_file {
                print(&format!("{}\n", path.display()));
                return Ok(if path.exists() { End::Good } else { End::SomeFailed });
            }
            let page = crate::report::single::single_file(&study.output, &frames);
            let page = page.map_err(|error| (End::BadInput, error.to_string()))?;
            let to = output.unwrap_or_else(|| study.output.join("report_single.html"));
            crate::results::write_if_changed(&to, page.as_bytes())
                .map_err(|error| (End::Internal, format!("cannot write {}: {error}", to.display())))?;
            print(&format!("{} ({:.1} MB)\n", to.display(), page.len() as f64 / 1e6));
            Ok(End::Good)
        }
        Command::Doctor { pipeline, trial } => {
            let found = doctor(load(&pipeline.file)?, trial.as_deref()).map_err(|error| {
                let end = match &error {
                    DoctorError::Store(_) => End::Internal,
                    DoctorError::Trial { .. } => End::BadConfiguration,
                    _ => End::BadInput,
                };
                (end, error.to_string())
            })?;
            print(&found.text);
            Ok(if found.well { End::Good } else { End::SomeFailed })
        }
        Command::Compare {
            pipeline,
            objectives,
            optimisers,
            no_presets,
            trial,
            body,
            frames,
            starts,
            calls,
            reference,
            csv,
            threads,
        } => {
            let objectives = if objectives.is_empty() { Kind::ALL.to_vec() } else { objectives };
            let presets = !no_presets;
            let wish = CompareWish {
                objectives,
                optimisers,
                presets,
                trial,
                body,
                frames,
                starts,
                calls,
                reference,
                csv,
                threads,
            };
            let context = Context::new();
            stop_on_interrupt(&context);
            let text = compare(load(&pipeline.file)?, &wish, &context).map_err(|error| {
                let end = match &error {
                    CompareError::Stopped { .. } => End::Stopped,
                    CompareError::NoSuch { .. } | CompareError::Nothing(_) | CompareError::Parameters(_) => {
                        End::BadConfiguration
                    }
                    CompareError::Store(_) | CompareError::Write { .. } | CompareError::Threads(_) => {
                        End::Internal
                    }
                    _ => End::BadInput,
                };
                (end, error.to_string())
            })?;
            print(&text);
            Ok(End::Good)
        }
        Command::Status { pipeline } => status(&load(&pipeline.file)?),
        Command::Clean { pipeline, dry_run, all } => {
            let store = Store::open(&load(&pipeline.file)?.hidden()).map_err(internal)?;
            let which = if all { Clean::Everything } else { Clean::Unreferenced };
            let Size { entries, bytes } = store.clean(which, dry_run).map_err(internal)?;
            let verb = if dry_run { "would free" } else { "freed" };
            print(&format!("{verb} {entries} entries, {}\n", megabytes(bytes)));
            Ok(End::Good)
        }
        Command::Inspect { files } => {
            let mut end = End::Good;
            for file in files {
                match (biplane_acquisition::inspect::describe(&file), file.is_file()) {
                    (Ok(text), _) => print(&format!("{}\n{text}\n", slashes(&file))),
                    (Err(InspectError::Unknown { .. }), true) if is_pipeline(&file) => {
                        print(&format!("{}\npipeline file: `biplane plan` checks it\n", slashes(&file)));
                    }
                    (Err(error), is_file) => match PoseTable::read(&file) {
                        Ok(table) => print(&format!("{}\n{}\n", slashes(&file), poses(&table))),
                        // A table with a fault in it is still a table: its own message says more.
                        Err(fault)
                            if is_file && !matches!(fault, TableError::NoColumn { .. }) && is_csv(&file) =>
                        {
                            eprintln!("{fault}");
                            end = End::BadInput;
                        }
                        Err(_) => {
                            eprintln!("{error}");
                            end = End::BadInput;
                        }
                    },
                }
            }
            Ok(end)
        }
        Command::Correct { pipeline, output, by, force } => {
            let context = Context::new();
            stop_on_interrupt(&context);
            match correct(load(&pipeline.file)?, &output, by, force, &context) {
                Ok(text) => {
                    print(&text);
                    Ok(End::Good)
                }
                Err(error) => {
                    let end = match &error {
                        CorrectError::Stopped => End::Stopped,
                        CorrectError::Exists(_) | CorrectError::None => End::BadConfiguration,
                        CorrectError::Store(_) => End::Internal,
                        _ => End::BadInput,
                    };
                    Err((end, error.to_string()))
                }
            }
        }
        Command::Convert(arguments) => match convert(&arguments) {
            Ok(text) => {
                print(&text);
                Ok(End::Good)
            }
            Err(error @ ConvertError::Io { .. }) => Err((End::Internal, error.to_string())),
            Err(error @ (ConvertError::Exists { .. } | ConvertError::Count { .. })) => {
                Err((End::BadConfiguration, error.to_string()))
            }
            Err(error) => Err((End::BadInput, error.to_string())),
        },
        Command::Init { folder } => match init::init(&folder) {
            Ok(text) => {
                print(&text);
                Ok(End::Good)
            }
            Err(error @ init::InitError::Exists { .. }) => Err((End::BadConfiguration, error.to_string())),
            Err(error) => Err((End::BadInput, error.to_string())),
        },
        Command::Schema => {
            print(&reference::schema());
            Ok(End::Good)
        }
    }
}

/// Takes one of some names; a wrong one is answered with all of them.
fn named<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names = PossibleValuesParser::new(all.iter().map(|item| name(*item)));
    names.try_map(move |given| {
        let found = all.iter().find(|item| name(**item) == given);
        found.copied().ok_or("not one of the names")
    })
}

fn is_pipeline(file: &Path) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

fn is_csv(file: &Path) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"))
}

/// What `inspect` says of a table of poses.
fn poses(table: &PoseTable) -> String {
    let mut groups: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for row in &table.rows {
        groups.entry((row.trial.as_deref().unwrap_or("any"), &row.body)).or_default().push(&row.frame);
    }
    let mut text =
        format!("table of poses (world_from_model, mm, unit quaternions), {} rows", table.rows.len());
    for ((trial, body), frames) in groups {
        let ends = [frames.first(), frames.last()].map(|f| f.copied().unwrap_or_default());
        text +=
            &format!("\n  trial {trial}, body {body}: {} frames, {} to {}", frames.len(), ends[0], ends[1]);
    }
    text
}

fn load(file: &Path) -> Result<Study, (End, String)> {
    let path = if file.is_dir() { file.join("pipeline.toml") } else { file.to_owned() };
    Study::load(&path).map_err(|error| {
        let text = match &error {
            StudyError::Wrong(problems) => problems.render(std::io::stderr().is_terminal()),
            StudyError::Unreadable { .. } => error.to_string(),
        };
        (End::BadConfiguration, text)
    })
}

fn run_command(study: Study, threads: usize) -> Ended {
    let context = Context::new();
    stop_on_interrupt(&context);
    let (study, outcome) = run(study, threads, &context).map_err(|error| {
        let end = match &error {
            RunError::Inputs(_) | RunError::Calibration(_) => End::BadInput,
            RunError::Stopped { .. } => End::Stopped,
            _ => End::Internal,
        };
        (end, error.to_string())
    })?;
    print(&closing(&study, &outcome));
    Ok(if outcome.any_failed() { End::SomeFailed } else { End::Good })
}

/// Ctrl-C lets frames under way finish or stop; a second one ends the program at once.
fn stop_on_interrupt(context: &Context) {
    let context = context.clone();
    let handler = move || {
        if context.cancelled() {
            std::process::exit(End::Stopped as i32);
        }
        context.cancel();
        eprintln!("stopping; what is finished is kept (Ctrl-C again ends at once)");
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        tracing::debug!("Ctrl-C is not handled: {error}");
    }
}

/// How good the calibration from pictures is, in a line a view; nothing where calibrations come from files.
fn calibration_line(outcome: &Outcome) -> String {
    let calibrated = &outcome.calibration;
    let Some(environment) = &calibrated.environment else { return String::new() };
    let mut text = format!("Calibration: {}", calibrated.verdict().word());
    if let Some(angle) = environment.angle_deg {
        text += &format!(", views {angle:.1} degrees apart");
    }
    if let Some(mm) = environment.triangulation_rms_mm {
        text += &format!(", beads found again to {mm:.3} mm");
    }
    text += "\n";
    for (view, plate) in environment.views.iter().zip(&calibrated.plates) {
        let used = view.beads.iter().filter(|b| b.used).count();
        text += &format!("  {}: ", view.view);
        if let Some(fit) = plate {
            let held_out = fit.models.iter().find(|m| m.name == fit.model).map(|m| m.held_out_rms_px);
            let holes = fit.matched.iter().filter(|m| m.used).count();
            let left =
                held_out.map_or(String::new(), |px| format!(", {px:.3} px left of {:.2}", fit.before_rms_px));
            text += &format!("{holes} holes, {}{left}; ", fit.model);
        }
        text += &format!(
            "{used} beads to {:.3} px, source to detector {:.1} mm\n",
            view.reprojection_rms_px, view.source_to_detector_mm
        );
    }
    text + "\n"
}

/// The outlines that a person should look at, and the edits that were used.
fn to_look_at(study: &Study, outcome: &Outcome) -> String {
    let mut text = String::new();
    let [used, untouched] = outcome.edits;
    if used + untouched > 0 {
        text += &format!(
            "Edited contours: {used} file(s) used, {untouched} not edited yet (`biplane edits` lists them).\n"
        );
    }
    let flagged = outcome.flagged().count();
    if flagged == 0 {
        return text;
    }
    text += &format!(
        "\nLook at these outlines ({flagged}); `biplane edit --flagged` writes drawings to put them right:\n"
    );
    for (frame, body, slot, why) in outcome.flagged().take(FEW_OUTLINES) {
        let trial = &study.trials[frame.trial];
        let view = trial.frames.get(slot).map_or("", |(view, _)| study.views[*view].name.as_str());
        let body = &study.bodies[body.body].name;
        text += &format!("  {} {} {view}, {body}: {}\n", trial.name, frame.label, why.join(", "));
    }
    if flagged > FEW_OUTLINES {
        text += &format!("  ... and {} more in the report\n", flagged - FEW_OUTLINES);
    }
    text
}

/// What was found of bones in slices, a line each.
fn slices_lines(study: &Study, outcome: &Outcome) -> String {
    let line = |found: &SlicesOutcome| {
        let name = &study.slices[found.bone].name;
        if found.slices == 0 {
            return format!("Slices of {name}: none, see above\n");
        }
        let mut line = format!(
            "Slices of {name}: {} contours in {} of {} slices",
            found.contours, found.with_bone, found.slices
        );
        if !found.edited.is_empty() {
            line += &format!(", {} drawn by hand", found.edited.len());
        }
        if !found.flagged.is_empty() {
            line += &format!(
                ", {} to look at (`biplane edit --slices {name}` writes drawings to put them right)",
                found.flagged.len()
            );
        }
        line + "\n"
    };
    outcome.slices.iter().map(line).collect()
}

/// What was made of bodies, a line each; nothing of mesh files that are matched as they are.
fn models_lines(study: &Study, outcome: &Outcome) -> String {
    let line = |found: &ModelOutcome| {
        let name = &study.bodies[found.body].name;
        if found.points == 0 {
            return format!("Model of {name}: none, see above\n");
        }
        let mut line = format!("Model of {name}: {} points from {}", found.points, found.from);
        match found.surface.as_ref().map(|s| s.faults.len()) {
            Some(0) => line += ", a closed surface without faults",
            Some(faults) => line += &format!(", {faults} faults of its surface, see above"),
            None => {}
        }
        if found.axes.is_some_and(|(by, _)| by == AxesSource::Shape) {
            line += "; its axes are proposed from the shape: look at them";
        }
        line + "\n"
    };
    let told = outcome.models.iter().filter(|m| m.made || m.axes.is_some() || m.points == 0);
    told.map(line).collect()
}

/// What a run says at its end.
fn closing(study: &Study, outcome: &Outcome) -> String {
    let mut text = calibration_line(outcome);
    if !outcome.frames.is_empty() {
        text += &summary::table(&summary::of_outcome(study, outcome));
        text += "\n";
    }
    let cached: usize = outcome.steps.iter().map(|(_, c)| c.cached).sum();
    let ran: usize = outcome.steps.iter().map(|(_, c)| c.ran).sum();
    let [good, doubtful, ambiguous, failed] = outcome.verdicts();
    text += &format!("{}. ", summary::counts([good, doubtful, ambiguous, failed]));
    text += &match (ran, outcome.failures.len()) {
        (0, 0) => format!("Nothing to do: {cached} items cached.\n"),
        _ => {
            let steps = outcome.steps.iter();
            let parts = steps.map(|(name, c)| format!("{name} {} run, {} cached", c.ran, c.cached));
            format!("Items: {}.\n", parts.collect::<Vec<_>>().join("; "))
        }
    };
    if !outcome.failures.is_empty() {
        text += &format!("\nCould not be done ({}):\n", outcome.failures.len());
        for failure in &outcome.failures {
            text += &format!("  {}: {}\n", failure.item, failure.message);
        }
    }
    text += &slices_lines(study, outcome);
    text += &models_lines(study, outcome);
    text.extend(outcome.smoothed.iter().map(|of| effect(study, of) + "\n"));
    text += &to_look_at(study, outcome);
    let rows = good + doubtful + ambiguous + failed;
    if ambiguous > 0 {
        text += "\nAn ambiguous pose fits no better than another one: put a pose near the right one into edits/poses.csv, rough is enough\n\
                 (poses.csv has the other one in alternative_*), and run again.\n";
    }
    if outcome.failures.is_empty() && rows > 0 && (good + ambiguous == 0 || 2 * failed > rows) {
        text += "\nHardly a match is good. Check first: are the folders (or calibrations) of two views exchanged? Do the\n\
                 paired frames belong together (`offset`)? Are the start poses in the world of the calibration, of these\n\
                 meshes, in mm? Is a distortion table missing? The overlays show it.\n";
    }
    let at = |name: &str| {
        let path = study.output.join(name);
        let shown =
            std::env::current_dir().ok().and_then(|here| path.strip_prefix(here).ok().map(Path::to_owned));
        slashes(shown.as_deref().unwrap_or(&path))
    };
    text += &format!("\nPoses    {}\n", at("poses.csv"));
    if !outcome.smoothed.is_empty() {
        text += &format!("Smoothed {}\n", at("poses_smoothed.csv"));
    }
    if !outcome.joints.is_empty() {
        text += &format!("Joints   {}\n", at("kinematics.csv"));
    }
    if !study.export.formats.is_empty() {
        text += &format!("Exports  {}\n", at(EXPORTS));
    }
    if !outcome.calibration.drawings.is_empty() {
        text += &format!("Calibration {}\n", at("calibration"));
    }
    if outcome.slices.iter().any(|s| s.table.is_some()) {
        text += &format!("Slices   {}\n", at(SLICES));
    }
    if outcome.models.iter().any(|m| m.sheet.is_some()) {
        text += &format!("Models   {}\n", at(MODELS));
    }
    if outcome.frames.iter().any(|f| !f.overlays.is_empty()) {
        text += &format!("Overlays {}\n", at("overlays"));
    }
    text + &format!("Report   {}\n", at("report.html"))
}

fn status(study: &Study) -> Ended {
    let path = study.output.join("poses.csv");
    if path.is_file() {
        let rows = summary::of_file(&path).map_err(|e| (End::BadInput, e.to_string()))?;
        print(&summary::table(&rows));
        let verdicts = summary::VERDICTS.map(|v| rows.iter().filter(|r| r.verdict == v.word()).count());
        print(&format!("\n{} ({})\n", summary::counts(verdicts), study.relative(&path)));
    } else {
        print("no results yet: `biplane run` makes them\n");
    }
    let Size { entries, bytes } = Store::open(&study.hidden()).and_then(|s| s.size()).map_err(internal)?;
    print(&format!("store: {entries} entries, {}\n", megabytes(bytes)));
    Ok(End::Good)
}

fn look_failed(error: LookError) -> (End, String) {
    let end = if matches!(error, LookError::Inputs(_) | LookError::Calibration(_)) {
        End::BadInput
    } else {
        End::Internal
    };
    (end, error.to_string())
}

fn internal(error: impl std::fmt::Display) -> (End, String) {
    (End::Internal, error.to_string())
}

fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

/// To stdout; a reader that went away (`| head`) is no error.
fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
