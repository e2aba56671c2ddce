//! `biplane convert`: calibrations and lists of beads from one program's format to another's.
//!
//! What a format cannot hold is told where no picture would show it, and refused where one would. No file is overwritten
//! unless asked.

use std::io::Write;
use std::path::{Path, PathBuf};

use biplane_acquisition::beads::{
    BeadFile, read_bead_list, read_xmalab_references, write_bead_csv, write_xmalab_cube,
};
use biplane_acquisition::calibration::{
    CalibratedView, CalibrationError, ReadOptions, WriteError, WriteOptions, Written, read_calibrations,
    write_distortion_csv, write_four_points, write_jointtrack, write_jointtrack_biplane, write_mayacam1,
    write_mayacam2, write_plane_json,
};
use biplane_acquisition::meshes::LengthUnit;
use biplane_artifact::{Artifact, PixelOrigin, PlateFit};
use clap::ValueEnum;

use crate::diagnostics::slashes;

/// Bytes of a plate's fit that are read.
const MAX_BYTES: u64 = 64 << 20;

/// What `biplane convert` takes.
#[derive(Debug, clap::Args)]
pub struct ConvertArguments {
    /// Calibrations, a list of beads, or (to `distortion`) what a run stored of a plate.
    #[arg(required = true)]
    pub inputs: Vec<PathBuf>,
    /// The format to write.
    #[arg(long, value_enum)]
    pub to: Format,
    /// The file to write.
    #[arg(short, long)]
    pub output: PathBuf,
    /// Names for views of files that hold one without a name, in the order of the files; or which views to take.
    #[arg(long = "view", value_name = "NAME")]
    pub views: Vec<String>,
    /// Side of a pixel on the detector, mm, where the input does not say it and the output needs it.
    #[arg(long, value_parser = positive)]
    pub pixel_mm: Option<f64>,
    /// Where the input counts pixels from, if its format does not say.
    #[arg(long, value_enum, default_value = "centre")]
    pub pixel_origin: Origin,
    /// Where the output shall count pixels from, if its format does not say.
    #[arg(long, value_enum, default_value = "centre")]
    pub output_pixel_origin: Origin,
    /// Columns and rows of the pictures, for JointTrack's files, which do not say it.
    #[arg(long, value_name = "COLUMNS,ROWS", value_parser = size)]
    pub size: Option<[usize; 2]>,
    /// Unit of a cube file of XMALab, which does not say it.
    #[arg(long, value_enum, default_value = "mm")]
    pub units: Unit,
    /// XMALab's file of reference beads, beside a cube file.
    #[arg(long, value_name = "FILE")]
    pub references: Option<PathBuf>,
    /// Leave a distortion out that the output cannot hold: the file is then for corrected pictures.
    #[arg(long)]
    pub without_distortion: bool,
    /// Overwrite the output.
    #[arg(long)]
    pub force: bool,
}

impl ConvertArguments {
    fn writing(&self) -> WriteOptions {
        WriteOptions {
            pixel_origin: self.output_pixel_origin.into(),
            pixel_mm: self.pixel_mm,
            without_distortion: self.without_distortion,
        }
    }
}

/// Formats that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// MayaCam 2.0 (XMALab, Autoscoper): one view
    #[value(name = "mayacam2")]
    MayaCam2,
    /// MayaCam 1.0 (Autoscoper): one view
    #[value(name = "mayacam1")]
    MayaCam1,
    /// JointTrack, one plane (JT_INTCALIB): one view, whose camera becomes the world
    #[value(name = "jointtrack")]
    JointTrack,
    /// JointTrack, two planes (JTA_INTCALIB_BIPLANE): two views; camera A becomes the world
    #[value(name = "jointtrack-biplane")]
    JointTrackBiplane,
    /// Source and detector plane, JSON: all views
    #[value(name = "plane")]
    Plane,
    /// Four points a fluoroscope, CSV: all views
    #[value(name = "four-points")]
    FourPoints,
    /// Distortion table, CSV: one view
    #[value(name = "distortion")]
    Distortion,
    /// XMALab's cube file of beads, and its references beside
    #[value(name = "xmalab-cube")]
    XmaLabCube,
    /// List of beads, CSV
    #[value(name = "beads")]
    Beads,
}

/// Where a file counts pixels from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Origin {
    /// the centre of the first pixel
    Centre,
    /// the corner of the first pixel
    Corner,
}

impl From<Origin> for PixelOrigin {
    fn from(origin: Origin) -> Self {
        match origin {
            Origin::Centre => Self::Centre,
            Origin::Corner => Self::Corner,
        }
    }
}

/// Unit of a list of beads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
#[expect(missing_docs, reason = "the variants are the units' own symbols")]
pub enum Unit {
    Mm,
    Cm,
    M,
    In,
}

impl From<Unit> for LengthUnit {
    fn from(unit: Unit) -> Self {
        match unit {
            Unit::Mm => Self::Millimetres,
            Unit::Cm => Self::Centimetres,
            Unit::M => Self::Metres,
            Unit::In => Self::Inches,
        }
    }
}

fn positive(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v: &f64| *v > 0.0 && *v < 100.0)
        .ok_or_else(|| "expected mm, such as 0.3".to_owned())
}

fn size(text: &str) -> Result<[usize; 2], String> {
    let sides: Option<Vec<usize>> =
        text.split([',', 'x']).map(|s| s.trim().parse().ok().filter(|n| (1..=16384).contains(n))).collect();
    sides
        .and_then(|s| <[usize; 2]>::try_from(s).ok())
        .ok_or_else(|| "expected columns and rows, such as 1024,1024".to_owned())
}

/// Why nothing was converted.
#[derive(Debug, thiserror::Error)]
pub enum ConvertError {
    /// An input that cannot be read.
    #[error(transparent)]
    Input(#[from] CalibrationError),
    /// A format that cannot hold what was read.
    #[error(transparent)]
    Output(#[from] WriteError),
    /// The output is there.
    #[error("{} exists, and was not overwritten; name another file, or add --force", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The operating system said no.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Not as many views as the format holds.
    #[error("{format} holds {expected}, but the input has {}; choose with --view NAME", views(found))]
    Count {
        /// The format's word.
        format: String,
        /// How many it holds.
        expected: &'static str,
        /// Views there.
        found: Vec<String>,
    },
    /// A view that is not there.
    #[error("the input has no view \"{view}\"; it has {}", views(found))]
    NoSuchView {
        /// The view asked for.
        view: String,
        /// Views there.
        found: Vec<String>,
    },
    /// Two files with the same name of a view.
    #[error("two views are called \"{view}\"; name them with --view, once for each file")]
    Twice {
        /// The name.
        view: String,
    },
    /// Lists of beads come one at a time.
    #[error("a list of beads is one file; {found} were given")]
    OneList {
        /// Files given.
        found: usize,
    },
    /// Nothing to make a table of.
    #[error(
        "view \"{view}\" has no distortion; its pictures are corrected already, or the table lies in a file of its own"
    )]
    NoDistortion {
        /// The view.
        view: String,
    },
}

fn views(names: &[String]) -> String {
    match names {
        [] => "none".to_owned(),
        names => names.join(", "),
    }
}

/// Reads, writes, and says what was written and what the format could not hold.
///
/// # Errors
/// An input is none of the formats or is damaged, the output's format cannot hold what was read, the output exists, or
/// cannot be written.
pub fn convert(arguments: &ConvertArguments) -> Result<String, ConvertError> {
    let Files { main, beside, notes } = match arguments.to {
        Format::MayaCam2 => one_view(arguments, write_mayacam2)?,
        Format::MayaCam1 => one_view(arguments, write_mayacam1)?,
        Format::JointTrack => one_view(arguments, write_jointtrack)?,
        Format::JointTrackBiplane => {
            let views = read_views(arguments)?;
            let [a, b] = views.as_slice() else { return Err(count(arguments.to, "two views", &views)) };
            Files::of(
                write_jointtrack_biplane([a, b], &arguments.writing())?,
                Some(arguments.output_pixel_origin),
            )
        }
        Format::Plane => all_views(arguments, write_plane_json)?,
        Format::FourPoints => all_views(arguments, write_four_points)?,
        Format::Distortion => distortion(arguments)?,
        Format::XmaLabCube | Format::Beads => beads(arguments)?,
    };
    let paths: Vec<(PathBuf, &str)> = std::iter::once((arguments.output.clone(), main.as_str()))
        .chain(beside.as_deref().map(|text| (references_path(&arguments.output), text)))
        .collect();
    // Both or none.
    if !arguments.force
        && let Some((path, _)) = paths.iter().find(|(path, _)| path.exists())
    {
        return Err(ConvertError::Exists { path: path.clone() });
    }
    let mut said = String::new();
    for (path, text) in paths {
        put(&path, text, arguments.force)?;
        said += &format!("wrote {}\n", slashes(&path));
    }
    for note in notes {
        said += &format!("  {note}\n");
    }
    Ok(said)
}

/// What to write, and what to say of it.
struct Files {
    main: String,
    beside: Option<String>,
    notes: Vec<String>,
}

impl Files {
    /// Of a calibration; `origin` where its format does not say where pixels count from.
    fn of(written: Written, origin: Option<Origin>) -> Self {
        let Written { text, lost, notes } = written;
        let lost = lost.iter().map(|lost| format!("lost: {lost}"));
        let mut said: Vec<String> = lost.chain(notes.iter().map(|note| format!("note: {note}"))).collect();
        if let Some(origin) = origin {
            let word = if origin == Origin::Corner { "corner" } else { "centre" };
            said.push(format!(
                "note: pixels count from the {word} of the first one, which the format does not say"
            ));
        }
        Self { main: text, beside: None, notes: said }
    }
}

/// XMALab's references beside a cube file: `cube.csv` and `cube_references.txt`.
fn references_path(output: &Path) -> PathBuf {
    let stem = output.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    output.with_file_name(format!("{stem}_references.txt"))
}

fn put(path: &Path, text: &str, force: bool) -> Result<(), ConvertError> {
    let io = |source| ConvertError::Io { path: path.to_owned(), source };
    let mut options = std::fs::File::options();
    options.write(true);
    if force {
        options.create(true).truncate(true);
    } else {
        options.create_new(true);
    }
    let mut file = options.open(path).map_err(|source| match source.kind() {
        std::io::ErrorKind::AlreadyExists => ConvertError::Exists { path: path.to_owned() },
        _ => io(source),
    })?;
    file.write_all(text.as_bytes()).map_err(io)
}

fn beads(arguments: &ConvertArguments) -> Result<Files, ConvertError> {
    let [input] = arguments.inputs.as_slice() else {
        return Err(ConvertError::OneList { found: arguments.inputs.len() });
    };
    let BeadFile { mut list, bright, notes } = read_bead_list(input, arguments.units.into())?;
    if let Some(references) = &arguments.references {
        read_xmalab_references(references, &mut list)?;
    }
    let mut notes: Vec<String> = notes.into_iter().map(|note| format!("note: {note}")).collect();
    if arguments.to == Format::Beads {
        if bright == Some(true) {
            notes.push("lost: that beads are brighter than what is around them".to_owned());
        }
        return Ok(Files { main: write_bead_csv(&list), beside: None, notes });
    }
    let cube = write_xmalab_cube(&list, bright.unwrap_or(false));
    notes.extend(cube.lost.iter().map(|lost| format!("lost: {lost}")));
    Ok(Files { main: cube.cube, beside: Some(cube.references).filter(|r| !r.is_empty()), notes })
}

/// To a format of one view, which does not say where pixels count from.
fn one_view(
    arguments: &ConvertArguments,
    write: fn(&CalibratedView, &WriteOptions) -> Result<Written, WriteError>,
) -> Result<Files, ConvertError> {
    let views = read_views(arguments)?;
    let written = write(only(arguments.to, &views)?, &arguments.writing())?;
    Ok(Files::of(written, Some(arguments.output_pixel_origin)))
}

/// To a format of any number of views, in which pixels count from the centre of the first one.
fn all_views(
    arguments: &ConvertArguments,
    write: fn(&[CalibratedView], &WriteOptions) -> Result<Written, WriteError>,
) -> Result<Files, ConvertError> {
    Ok(Files::of(write(&read_views(arguments)?, &arguments.writing())?, None))
}

fn distortion(arguments: &ConvertArguments) -> Result<Files, ConvertError> {
    if let [input] = arguments.inputs.as_slice()
        && let Some(fit) = plate_fit(input)
    {
        return Ok(Files { main: write_distortion_csv(&fit.table), beside: None, notes: Vec::new() });
    }
    let views = read_views(arguments)?;
    let view = only(arguments.to, &views)?;
    let Some(table) = &view.calibration.distortion else {
        return Err(ConvertError::NoDistortion { view: view.calibration.view.clone() });
    };
    let notes = vec!["lost: everything but the distortion".to_owned()];
    Ok(Files { main: write_distortion_csv(table), beside: None, notes })
}

/// What a run stored of a plate, if that is what the file is.
fn plate_fit(path: &Path) -> Option<PlateFit> {
    let length = std::fs::metadata(path).ok()?.len();
    (length <= MAX_BYTES).then(|| std::fs::read(path).ok()).flatten().and_then(|b| PlateFit::decode(&b).ok())
}

/// The views of all inputs, named and chosen.
fn read_views(arguments: &ConvertArguments) -> Result<Vec<CalibratedView>, ConvertError> {
    let options = ReadOptions { pixel_origin: arguments.pixel_origin.into(), size: arguments.size };
    let mut views: Vec<CalibratedView> = Vec::new();
    let mut named = false;
    for input in &arguments.inputs {
        let set = read_calibrations(input, &options)?;
        named |= !set.format.has_one_view();
        views.extend(set.views.into_iter().map(|mut view| {
            if view.calibration.view.is_empty() {
                let stem = input.file_stem().unwrap_or_default();
                view.calibration.view = stem.to_string_lossy().replace(',', "_");
            }
            view
        }));
    }
    if !named && arguments.views.len() == views.len() {
        for (view, name) in views.iter_mut().zip(&arguments.views) {
            view.calibration.view.clone_from(name);
        }
    } else if !arguments.views.is_empty() {
        let chosen = arguments.views.iter().map(|wanted| {
            let found = views.iter().find(|v| v.calibration.view == *wanted).cloned();
            found.ok_or_else(|| ConvertError::NoSuchView { view: wanted.clone(), found: names(&views) })
        });
        views = chosen.collect::<Result<_, _>>()?;
    }
    let twice = views
        .iter()
        .enumerate()
        .find(|(i, view)| views.iter().take(*i).any(|other| other.calibration.view == view.calibration.view));
    match twice {
        Some((_, view)) => Err(ConvertError::Twice { view: view.calibration.view.clone() }),
        None => Ok(views),
    }
}

fn names(views: &[CalibratedView]) -> Vec<String> {
    views.iter().map(|v| v.calibration.view.clone()).collect()
}

fn count(format: Format, expected: &'static str, views: &[CalibratedView]) -> ConvertError {
    let format = format.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned());
    ConvertError::Count { format, expected, found: names(views) }
}

fn only(format: Format, views: &[CalibratedView]) -> Result<&CalibratedView, ConvertError> {
    match views {
        [view] => Ok(view),
        _ => Err(count(format, "one view", views)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: ConvertArguments,
    }

    fn run(folder: &Path, line: &str) -> Result<String, String> {
        let words = line.split_whitespace().map(|w| w.replace("@", &format!("{}/", folder.display())));
        let line = Line::try_parse_from(std::iter::once("convert".to_owned()).chain(words))
            .map_err(|e| e.to_string())?;
        convert(&line.arguments).map_err(|e| e.to_string())
    }

    const TWO: &str = "JTA_INTCALIB_BIPLANE\n1000,0,0,0.5\n1000,0,0,0.5\n500,0,-500\n0,0,1\n0,1,0\n-1,0,0\n";

    #[test]
    fn two_planes_become_mayacams_and_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        std::fs::write(at.join("jt.txt"), TWO).unwrap();
        let e = run(at, "@jt.txt --to mayacam2 --output @a.txt").unwrap_err();
        assert!(e.contains("--size"), "{e}");
        let e = run(at, "@jt.txt --size 400,300 --to mayacam2 --output @a.txt").unwrap_err();
        assert!(e.contains("mayacam2 holds one view, but the input has A, B; choose with --view"), "{e}");
        let e = run(at, "@jt.txt --size 400,300 --view C --to mayacam2 --output @a.txt").unwrap_err();
        assert!(e.contains("no view \"C\"; it has A, B"), "{e}");
        let e = run(at, "@jt.txt --size 400 --to plane --output @a.txt").unwrap_err();
        assert!(e.contains("such as 1024,1024"), "{e}");
        for view in ["A", "B"] {
            let line = format!("@jt.txt --size 400,300 --view {view} --to mayacam2 --output @{view}.txt");
            let said = run(at, &line).unwrap();
            assert!(
                said.contains("lost: the size of a pixel") && said.contains("centre of the first"),
                "{said}"
            );
        }
        let e = run(at, "@A.txt @B.txt --to jointtrack-biplane --output @back.txt").unwrap_err();
        assert!(e.contains("--pixel-mm"), "{e}");
        run(at, "@A.txt @B.txt --pixel-mm 0.5 --to jointtrack-biplane --output @back.txt").unwrap();
        let numbers = |text: &str| -> Vec<f64> {
            text.split([',', '\n']).skip(1).filter_map(|w| w.parse().ok()).collect()
        };
        let back = numbers(&std::fs::read_to_string(at.join("back.txt")).unwrap());
        assert_eq!(back.len(), 20);
        for (found, expected) in back.iter().zip(numbers(TWO)) {
            assert!((found - expected).abs() < 1e-9, "{back:?}");
        }
    }

    #[test]
    fn nothing_is_overwritten_unless_asked() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        std::fs::write(at.join("jt.txt"), TWO).unwrap();
        let line = "@jt.txt --size 400,300 --to plane --output @out.json";
        std::fs::write(at.join("out.json"), "mine").unwrap();
        let e = run(at, line).unwrap_err();
        assert!(e.contains("out.json exists, and was not overwritten"), "{e}");
        assert_eq!(std::fs::read_to_string(at.join("out.json")).unwrap(), "mine");
        run(at, &format!("{line} --force")).unwrap();
        assert!(std::fs::read_to_string(at.join("out.json")).unwrap().contains("fluoroscopes"));
    }

    #[test]
    fn beads_go_to_xmalab_with_their_references() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let list = "bead,x_mm,y_mm,z_mm,radius_mm\n1,0,0,0,1\n2,50,0,0,1\n3,0,50,0,1\n4,50,50,9,1\n5,0,0,50,1\n6,50,9,50,2\n";
        std::fs::write(at.join("beads.csv"), list).unwrap();
        let said = run(at, "@beads.csv --to xmalab-cube --output @cube.csv").unwrap();
        assert!(said.contains("cube_references.txt") && said.contains("lost: the beads' radii"), "{said}");
        assert_eq!(std::fs::read_to_string(at.join("cube_references.txt")).unwrap(), "6 6\n");
        run(at, "@cube.csv --references @cube_references.txt --to beads --output @back.csv").unwrap();
        let back = std::fs::read_to_string(at.join("back.csv")).unwrap();
        assert!(back.contains("6,50,9,50,,1\n") && back.contains("5,0,0,50,,0\n"), "{back}");
    }
}
