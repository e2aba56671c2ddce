//! Says what a laboratory's file holds, and in which convention, for a person to read.
//!
//! The kind is told by content. Nothing of a DICOM header but what describes the pixels is shown.

mod mesh;
mod volume;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use biplane_artifact::{DistortionTable, Frame, PixelOrigin, PlatePattern};
use nalgebra::Vector3;

use crate::beads::{BeadFile, BeadFormat, read_bead_list};
use crate::calibration::camera::Camera;
use crate::calibration::{
    CalibratedView, CalibrationError, CalibrationFormat, CalibrationSet, ReadOptions, is_distortion_csv,
    parse, read_distortion_csv, read_text,
};
use crate::frames::{FramesError, list_frames};
use crate::images::{ImageError, ImageFile, ImageFormat, ImageInfo};
use crate::landmarks::{LandmarkFile, LandmarkFileError, LandmarkFormat};
use crate::meshes::{LengthUnit, MeshFileError, is_cad, is_mesh};
use crate::plates::{is_plate_list, read_plate_list};
use crate::volumes::{VolumeFileError, VolumeFormat, is_series, read_volume};

/// What a file holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Description {
    /// What it is, in a few words.
    pub kind: String,
    /// What is measured or stated, and its value with its unit.
    pub lines: Vec<(String, String)>,
}

impl Description {
    fn new(kind: impl Into<String>) -> Self {
        Self { kind: kind.into(), lines: Vec::new() }
    }

    fn line(&mut self, label: impl Into<String>, value: impl Into<String>) {
        self.lines.push((label.into(), value.into()));
    }
}

impl std::fmt::Display for Description {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let width = self.lines.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
        write!(f, "{}", self.kind)?;
        for (label, value) in &self.lines {
            write!(f, "\n  {label:width$}  {value}")?;
        }
        Ok(())
    }
}

/// Why a file could not be described.
#[derive(Debug, thiserror::Error)]
pub enum InspectError {
    /// The operating system said no.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// None of the kinds known.
    #[error(
        "{} is none of the files this program reads: images (PNG, TIFF, DICOM, JPEG, BMP), calibrations (MayaCam, \
         JointTrack, source and plane as JSON, four points, distortion as CSV), lists of a plate's holes or a frame's beads, meshes (STL, PLY, \
         OBJ, OFF, VTK, VTP), landmarks (CSV, Slicer's .fcsv and .mrk.json), volumes \
         (NRRD, NIfTI-1, a folder of DICOM slices)", path.display()
    )]
    Unknown {
        /// The file.
        path: PathBuf,
    },
    /// An image that cannot be read.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A folder of images that cannot be listed.
    #[error(transparent)]
    Frames(#[from] FramesError),
    /// A calibration that cannot be read.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// A mesh that cannot be read.
    #[error(transparent)]
    Mesh(#[from] MeshFileError),
    /// Landmarks that cannot be read.
    #[error(transparent)]
    Landmarks(#[from] LandmarkFileError),
    /// A volume that cannot be read.
    #[error(transparent)]
    Volume(#[from] VolumeFileError),
}

/// Describes a file, a folder of images, or one of a volume's slices.
///
/// # Errors
/// The file cannot be read, is of no known kind, or is damaged.
pub fn describe(path: impl AsRef<Path>) -> Result<Description, InspectError> {
    let path = path.as_ref();
    let io = |source| InspectError::Io { path: path.to_owned(), source };
    if path.is_dir() {
        return if is_series(path) { Ok(volume::describe(&read_volume(path)?)) } else { folder(path) };
    }
    let mut file = File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    let mut start = Vec::new();
    file.by_ref().take(4096).read_to_end(&mut start).map_err(io)?;
    drop(file);
    if ImageFormat::of_start(&start).is_some() {
        return image(path);
    }
    if VolumeFormat::of_start(&start).is_some() {
        return Ok(volume::describe(&read_volume(path)?));
    }
    if is_mesh(&start, length) || is_cad(path, &start) {
        return Ok(mesh::describe(path)?);
    }
    let unknown = || InspectError::Unknown { path: path.to_owned() };
    match read_text(path) {
        Ok(text) => match CalibrationFormat::of_text(&text) {
            Some(_) => calibration(path, &text),
            None if LandmarkFormat::of_text(&text).is_some() => {
                Ok(landmarks(&crate::landmarks::parse(path, &text)?))
            }
            None if is_distortion_csv(&text) => Ok(distortion(&read_distortion_csv(path)?)),
            None if is_plate_list(&text) => Ok(plate(&read_plate_list(path)?)),
            None => match BeadFormat::of_text(&text) {
                Some(format) => Ok(beads(format, &read_bead_list(path, LengthUnit::Millimetres)?)),
                None => Err(unknown()),
            },
        },
        Err(CalibrationError::Io { source, .. }) => Err(io(source)),
        // Not text, so the last chance is a binary mesh, whose reader says what is wrong with it.
        Err(_) => mesh::describe(path).map_err(|error| match error {
            MeshFileError::Truncated { .. } => error.into(),
            _ => unknown(),
        }),
    }
}

fn folder(path: &Path) -> Result<Description, InspectError> {
    let frames = list_frames(path, "")?;
    let mut d = Description::new("folder of images");
    d.line("frames", frames.len().to_string());
    if let (Some(first), Some(last)) = (frames.first(), frames.last()) {
        d.line("first, last", format!("{}, {}", first.label, last.label));
        let mut file = ImageFile::open(&first.path)?;
        let frame = file.frame(first.index_in_file)?;
        image_lines(&mut d, file.info(), &frame);
    }
    Ok(d)
}

fn image(path: &Path) -> Result<Description, InspectError> {
    let mut file = ImageFile::open(path)?;
    let frame = file.frame(0)?;
    let info = file.info();
    let mut d = Description::new(format!("{} image", info.format.name()));
    d.line("frames", info.frames.to_string());
    image_lines(&mut d, info, &frame);
    let rate =
        info.rate_hz.map_or("not stated in the file".to_owned(), |r| format!("{r:.3} frames a second"));
    d.line("rate", rate);
    Ok(d)
}

fn image_lines(d: &mut Description, info: &ImageInfo, frame: &Frame) {
    d.line("size", format!("{} x {} px (columns x rows)", info.width, info.height));
    d.line("bits", frame.bits.to_string());
    let (min, max) = frame.samples.iter().fold((u16::MAX, 0), |(a, b), &s| (a.min(s), b.max(s)));
    let mean = frame.samples.iter().map(|&s| f64::from(s)).sum::<f64>() / frame.samples.len().max(1) as f64;
    d.line("levels of the first frame", format!("{min} to {max}, mean {mean:.1}; larger is brighter"));
}

/// Shown for a format that does not say how many pixels a picture has.
const NOMINAL_SIZE: [usize; 2] = [1024, 1024];

fn calibration(path: &Path, text: &str) -> Result<Description, InspectError> {
    let options = ReadOptions { pixel_origin: PixelOrigin::Centre, size: Some(NOMINAL_SIZE) };
    let CalibrationSet { format, views } = parse(path, text, &options)?;
    let one = if format.has_one_view() { " (one fluoroscope)" } else { "" };
    let mut d = Description::new(format!("calibration, {}{one}", format.name()));
    if !format.has_one_view() {
        let names: Vec<&str> = views.iter().map(|v| v.calibration.view.as_str()).collect();
        d.line("fluoroscopes", names.join(", "));
    }
    let (frame, pixels) = conventions(format);
    d.line("frame", frame);
    d.line("pixel origin", pixels);
    let says_size = !matches!(format, CalibrationFormat::JointTrack | CalibrationFormat::JointTrackBiplane);
    for view in &views {
        let name = &view.calibration.view;
        let prefix = if name.is_empty() { String::new() } else { format!("{name}: ") };
        camera(&mut d, &prefix, view, says_size);
    }
    if let [a, b, ..] = views.as_slice() {
        let middle = |v: &CalibratedView| v.calibration.size.map(|n| (n as f64 - 1.0) / 2.0);
        let [from_a, from_b] = [a, b].map(|v| Camera::of(&v.calibration).ray(middle(v)));
        let names = format!("{} and {}", a.calibration.view, b.calibration.view);
        let angle = from_a.angle(&from_b).to_degrees();
        d.line(
            format!("angle between {names}"),
            format!("{angle:.2} degrees, of the rays to the pictures' middles"),
        );
        let apart = (Vector3::from(a.calibration.source) - Vector3::from(b.calibration.source)).norm();
        d.line("sources", format!("{apart:.2} mm apart"));
    }
    Ok(d)
}

/// Which frame and axes a format has, and where it counts pixels from.
fn conventions(format: CalibrationFormat) -> (&'static str, &'static str) {
    match format {
        CalibrationFormat::MayaCam2 => (
            "the laboratory's, mm; the camera's axes are OpenCV's (x right, y down, z away from the source), right-handed",
            "not in this format: shown as if the centre of the first pixel were (0, 0); `pixel_origin` sets it",
        ),
        CalibrationFormat::MayaCam1 => (
            "the laboratory's, taken as mm; the camera's axes are x right, y up, z towards the source, right-handed",
            "counted from 1, rows upward; shown as if the centre of the first pixel were (1, 1); `pixel_origin` sets it",
        ),
        CalibrationFormat::JointTrack => (
            "the camera is the world, mm: x right, y up, z towards the source, right-handed",
            "offsets from half the width and height, rows upward; shown as if the centre of the first pixel were (0, 0)",
        ),
        CalibrationFormat::JointTrackBiplane => (
            "camera A is the world, mm: x right, y up, z towards the source, right-handed",
            "offsets from half the width and height, rows upward; shown as if the centre of the first pixel were (0, 0)",
        ),
        CalibrationFormat::PlaneJson => {
            ("the laboratory's, mm", "does not matter in this format: it gives the middle of the picture")
        }
        CalibrationFormat::FourPoints => ("the laboratory's, mm", "centre of the first pixel at (0, 0)"),
        CalibrationFormat::Environment => {
            ("that of the beads, mm", "centre of the first pixel at (0, 0), of corrected pictures")
        }
    }
}

fn camera(d: &mut Description, prefix: &str, view: &CalibratedView, says_size: bool) {
    let camera = Camera::of(&view.calibration);
    let Camera { focal: [fx, fy], skew, principal: [cx, cy], axes, source } = camera;
    let normal = axes.row(2).transpose();
    let triple =
        |v: &Vector3<f64>, digits: usize| format!("({:.digits$}, {:.digits$}, {:.digits$})", v.x, v.y, v.z);
    let mut line = |label: &str, value: String| d.line(format!("{prefix}{label}"), value);
    let [columns, rows] = view.calibration.size;
    let size = format!("{columns} x {rows} px");
    line(
        "size",
        if says_size {
            format!("{size} (columns x rows)")
        } else {
            format!("not in this format; what follows is for {size}")
        },
    );
    let far = source.norm();
    line("source", format!("{} mm, {far:.1} mm from the frame's origin", triple(&source, 3)));
    line(
        "distance of source and detector",
        match (view.source_to_detector_mm(), view.pixel_mm) {
            (Some(distance), Some(pixel)) => format!("{distance:.3} mm, with pixels of {pixel:.6} mm"),
            _ => "not in this format: it needs the size of a pixel".to_owned(),
        },
    );
    line(
        "viewing direction",
        format!("{} (from the source, at right angles to the detector)", triple(&normal, 4)),
    );
    line("focal length", format!("{fx:.2} x {fy:.2} px, skew {skew:.3}"));
    line("principal point", format!("({cx:.3}, {cy:.3}) px, the centre of the first pixel being (0, 0)"));
    let mirrored = axes.determinant() < 0.0;
    let side =
        if mirrored { "mirrored: as seen from behind the detector" } else { "as seen from the source" };
    line("picture", side.to_owned());
    let corrected = match &view.calibration.distortion {
        None => "none: pictures must be corrected already".to_owned(),
        Some(t) => format!("in the file, sampled here on {} x {} points", t.count[0], t.count[1]),
    };
    line("distortion", corrected);
    if view.covariance {
        line("covariance", "in the file".to_owned());
    }
}

fn distortion(table: &DistortionTable) -> Description {
    let DistortionTable { first_px, step_px, count, ideal_px } = table;
    let mut d = Description::new("distortion samples (CSV): recorded to ideal pixels");
    let last = [0, 1].map(|i| first_px[i] + step_px[i] * (count[i] - 1) as f64);
    d.line(
        "grid",
        format!("{} x {} samples every {:.3} x {:.3} px", count[0], count[1], step_px[0], step_px[1]),
    );
    d.line("covers", format!("({}, {}) to ({}, {}) px", first_px[0], first_px[1], last[0], last[1]));
    let moved = ideal_px.iter().enumerate().map(|(i, ideal)| {
        let x = first_px[0] + step_px[0] * (i % count[0]) as f64;
        let y = first_px[1] + step_px[1] * (i / count[0]) as f64;
        (ideal[0] - x).hypot(ideal[1] - y)
    });
    d.line("largest shift", format!("{:.2} px", moved.fold(0.0, f64::max)));
    d.line("pixel origin", "centre of the first pixel at (0, 0)");
    d
}

fn plate(pattern: &PlatePattern) -> Description {
    let mut d = Description::new("list of a plate's holes (CSV)");
    if let PlatePattern::List(spots) = pattern {
        d.line("holes", spots.len().to_string());
        let reach = spots.iter().map(|s| s.at_mm[0].hypot(s.at_mm[1])).fold(0.0, f64::max);
        d.line("farthest from the plate's origin", format!("{reach:.3} mm"));
        d.line("radii", radii(spots.iter().map(|s| s.radius_mm)));
    }
    d
}

fn beads(format: BeadFormat, file: &BeadFile) -> Description {
    let BeadFile { list, bright, notes } = file;
    let mut d = Description::new(match format {
        BeadFormat::Csv => "list of a frame's beads (CSV)",
        BeadFormat::XmaLabCube => "list of a frame's beads, cube file of XMALab",
    });
    d.line("beads", list.0.len().to_string());
    let extent = [0, 1, 2].map(|axis| {
        let values = list.0.iter().map(|b| b.at_mm[axis]);
        let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    });
    d.line("size", format!("{:.3} x {:.3} x {:.3} mm", extent[0], extent[1], extent[2]));
    d.line("radii", radii(list.0.iter().map(|b| b.radius_mm)));
    let marks: Vec<&str> = list.0.iter().filter(|b| b.mark).map(|b| b.name.as_str()).collect();
    d.line("marks", if marks.is_empty() { "none".to_owned() } else { marks.join(", ") });
    if let Some(bright) = bright {
        d.line("in pictures", if *bright { "brighter than what is around them" } else { "dark" });
    }
    d.line("frame", "the laboratory's, if the fluoroscopes are found from it");
    for note in notes {
        d.line("note", note);
    }
    d
}

fn landmarks(file: &LandmarkFile) -> Description {
    let LandmarkFile { format, turned, landmarks } = file;
    let mut d = Description::new(format!("landmarks, {}", format.name()));
    d.line("landmarks", landmarks.0.len().to_string());
    d.line(
        "frame",
        match (format, turned) {
            (_, true) => {
                "left-posterior-superior; the file has right-anterior-superior, so x and y changed their sign"
            }
            (LandmarkFormat::Fcsv | LandmarkFormat::MrkJson, _) => {
                "left-posterior-superior, as the file says"
            }
            _ => "that of the model",
        },
    );
    for landmark in &landmarks.0 {
        let [x, y, z] = landmark.at_mm;
        d.line(landmark.name.as_str(), format!("({x:.3}, {y:.3}, {z:.3}) mm"));
    }
    d
}

/// The radii of a list, and how many have each.
fn radii(radii: impl Iterator<Item = Option<f64>>) -> String {
    let mut counts: Vec<(Option<f64>, usize)> = Vec::new();
    for radius in radii {
        match counts.iter_mut().find(|(r, _)| *r == radius) {
            Some((_, count)) => *count += 1,
            None => counts.push((radius, 1)),
        }
        if counts.len() > 8 {
            return "more than eight different ones".to_owned();
        }
    }
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let words = counts.iter().map(|(radius, count)| match radius {
        Some(radius) => format!("{count} of {radius} mm"),
        None => format!("{count} not stated"),
    });
    words.collect::<Vec<_>>().join(", ")
}
