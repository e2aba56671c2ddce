//! Volumes: NRRD, NIfTI-1 and folders of DICOM slices, as MRI, CT and label maps come.
//!
//! Guaranteed of what is read: positions are those of voxel centres, left-posterior-superior, in mm; the first axis of the
//! file runs fastest and its third one goes from slice to slice; every sample is a finite number, after the file's slope and
//! intercept; no more memory is taken than the file fills, and never more than 4 GiB of samples. Not guaranteed: that slices
//! are evenly apart, that the axes are at right angles, or that they are right-handed; the notes say where they are not.
//!
//! Own readers: there is no crate for NRRD, the one for NIfTI takes memory for what a header claims, and those for DICOM keep
//! the patient's name. Text of a header is shown in a message only where it stands in a field that describes the voxels.

mod grid;
mod nifti;
mod nrrd;
mod orientation;
mod samples;
mod series;

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use biplane_artifact::Volume;

use crate::frames::FramesError;
use crate::images::ImageError;

pub use orientation::Orientation;
pub(crate) use series::is_series;

/// Voxels a volume may have: 4 GiB of samples.
const MAX_VOXELS: u64 = 1 << 30;
/// Voxels along one axis.
const MAX_ALONG: u64 = 65_535;
/// First bytes that tell what a file is: the header of NIfTI-1.
const START: usize = 348;

/// What a volume is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VolumeFormat {
    /// Nearly raw raster data, attached (`.nrrd`) or detached (`.nhdr`).
    Nrrd,
    /// NIfTI-1 in one file (`.nii`, `.nii.gz`).
    Nifti,
    /// A folder of DICOM slices.
    DicomSeries,
}

impl VolumeFormat {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nrrd => "NRRD",
            Self::Nifti => "NIfTI-1",
            Self::DicomSeries => "DICOM series",
        }
    }

    /// The format of a file that starts like this, if one of those read here; a few hundred bytes are enough.
    pub(crate) fn of_start(start: &[u8]) -> Option<Self> {
        if start.starts_with(nrrd::MAGIC) {
            return Some(Self::Nrrd);
        }
        let unpacked = samples::is_gzip(start).then(|| {
            let mut bytes = Vec::new();
            // A file's start is no whole gzip stream, so an error at its end says nothing.
            let _ = flate2::read::GzDecoder::new(start).take(START as u64).read_to_end(&mut bytes);
            bytes
        });
        nifti::is_nifti(unpacked.as_deref().unwrap_or(start)).then_some(Self::Nifti)
    }
}

/// Something about a volume that its user should know, and that did not keep it from being read.
#[derive(Debug, Clone, PartialEq)]
pub enum VolumeNote {
    /// NRRD without `space`, or with one that is not the patient's: its axes were taken as left-posterior-superior.
    UnknownSpace,
    /// NRRD without `space directions`: the file's axes were taken to be those of its space, with its `spacings`.
    SpacingsAlone,
    /// NRRD without `space origin`: the first voxel was put at (0, 0, 0).
    NoOrigin,
    /// Which of its placements NIfTI was read with.
    PlacedBy {
        /// `sform`, `qform` or `pixdim`.
        form: &'static str,
        /// What the file says the frame is.
        space: &'static str,
    },
    /// The two placements of a NIfTI file differ.
    FormsDiffer {
        /// By at most this much, at a corner of the volume, mm.
        mm: f64,
    },
    /// The two axes of a slice are not at right angles.
    Skewed {
        /// By this much.
        degrees: f64,
    },
    /// Slices are shifted against each other: their stack does not run along their normal.
    Tilted {
        /// By this much.
        degrees: f64,
    },
    /// Whole numbers too large for the 24 bits that a sample has.
    Rounded {
        /// Of this many voxels.
        voxels: usize,
    },
    /// Slices that seem to be missing.
    Gap {
        /// File before the gap.
        before: String,
        /// File after it.
        after: String,
        /// From one to the other, along the normal, mm.
        apart_mm: f64,
        /// Median of all slices, mm.
        usual_mm: f64,
    },
    /// Slices that are not evenly apart, gaps left out; kept where they are.
    Uneven {
        /// The nearest neighbours, mm.
        least_mm: f64,
        /// The farthest, mm.
        most_mm: f64,
    },
    /// A slice that is there twice, the same to the last sample: one was left out.
    Copy {
        /// The one left out.
        file: String,
        /// The one kept.
        of: String,
    },
    /// DICOM files of the folder without a picture (directories, reports), passed over.
    NoPicture {
        /// Their names.
        files: Vec<String>,
    },
    /// The slices say `MONOCHROME1`: bright levels are meant to be shown dark. Levels were left as stored.
    ShownInverted,
}

impl fmt::Display for VolumeNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownSpace => write!(
                f,
                "does not say which way its axes run in the patient; taken as left-posterior-superior (`space: \
                 left-posterior-superior` says so)"
            ),
            Self::SpacingsAlone => write!(
                f,
                "has no `space directions`; its axes were taken to run along those of its space, by its `spacings`"
            ),
            Self::NoOrigin => write!(f, "has no `space origin`; the first voxel was put at (0, 0, 0)"),
            Self::PlacedBy { form, space } => write!(f, "placed by its {form}, {space}"),
            Self::FormsDiffer { mm } => {
                write!(
                    f,
                    "sform and qform differ by up to {mm:.3} mm; a program that prefers the other sees it elsewhere"
                )
            }
            Self::Skewed { degrees } => {
                write!(f, "rows and columns of a slice are {degrees:.2} degrees from a right angle")
            }
            Self::Tilted { degrees } => {
                write!(f, "slices are stacked {degrees:.2} degrees off their normal; kept where they are")
            }
            Self::Rounded { voxels } => {
                write!(f, "{voxels} voxels have whole numbers beyond 2^24, which were rounded")
            }
            Self::Gap { before, after, apart_mm, usual_mm } => {
                let missing = (apart_mm / usual_mm).round() - 1.0;
                write!(
                    f,
                    "{missing} slice(s) missing between {before} and {after}: {apart_mm:.3} mm, where {usual_mm:.3} mm are usual"
                )
            }
            Self::Uneven { least_mm, most_mm } => {
                write!(f, "slices are {least_mm:.3} to {most_mm:.3} mm apart; kept where they are")
            }
            Self::Copy { file, of } => write!(f, "{file} is a copy of {of} and was left out"),
            Self::NoPicture { files } => {
                write!(f, "{} file(s) without a picture were passed over: {}", files.len(), some_of(files))
            }
            Self::ShownInverted => {
                write!(f, "meant to be shown inverted (MONOCHROME1); levels were left as they are stored")
            }
        }
    }
}

/// The first few names of a list.
fn some_of(names: &[String]) -> String {
    const SHOWN: usize = 4;
    let more = if names.len() > SHOWN { ", ..." } else { "" };
    format!("{}{more}", names[..names.len().min(SHOWN)].join(", "))
}

/// A volume as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeFile {
    /// Its voxels and where they are.
    pub volume: Volume,
    /// What it is written in.
    pub format: VolumeFormat,
    /// How its samples are stored: type, byte order where there is one, encoding.
    pub stored: String,
    /// The files that it was read from: of DICOM, file `k` holds slice `k`; otherwise the header, then its data file.
    pub files: Vec<PathBuf>,
    /// What its user should know.
    pub notes: Vec<VolumeNote>,
}

/// Why a volume could not be read.
#[derive(Debug, thiserror::Error)]
pub enum VolumeFileError {
    /// The operating system said no.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Not a volume.
    #[error("{} is not a volume this program reads; expected NRRD, NIfTI-1, or a folder of DICOM slices{hint}", path.display())]
    Unknown {
        /// The file.
        path: PathBuf,
        /// What it seems to be instead, and what to do.
        hint: &'static str,
    },
    /// A line of a header is wrong.
    #[error("{}, line {line}: expected {expected}, found {found}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: usize,
        /// What should stand there.
        expected: String,
        /// What does.
        found: String,
    },
    /// A format that is read, but not this kind of it.
    #[error("{} is {what}; {advice}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What was found.
        what: String,
        /// What to do about it.
        advice: &'static str,
    },
    /// Something in the file contradicts itself.
    #[error("{} is damaged: {what}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What was found.
        what: String,
    },
    /// The file ends before its voxels do.
    #[error(
        "{} is cut short: it holds {found} of {expected} voxels; copy it again from where it was made", path.display()
    )]
    Truncated {
        /// The file of the voxels.
        path: PathBuf,
        /// Voxels that are whole.
        found: u64,
        /// Voxels that the header says there are.
        expected: u64,
    },
    /// The file goes on after its voxels.
    #[error(
        "{} holds more than the {expected} voxels that its header says: another header belongs to it, or the voxels do not \
         start where the header says (NRRD: `byte skip: -1` where they are at the file's end)", path.display()
    )]
    Longer {
        /// The file of the voxels.
        path: PathBuf,
        /// Voxels that the header says there are.
        expected: u64,
    },
    /// More voxels than the file can hold, or than are read.
    #[error(
        "{} claims {} x {} x {} voxels, which a file of {length} bytes cannot hold (it is cut short, or damaged), or more than \
         are read ({MAX_VOXELS}, {MAX_ALONG} along an axis)", path.display(), sizes[0], sizes[1], sizes[2]
    )]
    Impossible {
        /// The file of the voxels.
        path: PathBuf,
        /// Voxels along each axis, as claimed.
        sizes: [u64; 3],
        /// Bytes of the file.
        length: u64,
    },
    /// A sample without a value.
    #[error(
        "{}: the voxel ({}, {}, {}), counted from 0, is not a number, or none that 32 bits hold; give such voxels a level \
         (0, say) in the program that made the file", path.display(), at[0], at[1], at[2]
    )]
    NotFinite {
        /// The file of the voxels.
        path: PathBuf,
        /// Its place in the file.
        at: [usize; 3],
    },
    /// A folder without slices.
    #[error(
        "no DICOM slice among the {files} file(s) of {}: name the folder of one series, or a NRRD or NIfTI file", folder.display()
    )]
    NoSlices {
        /// The folder.
        folder: PathBuf,
        /// Files looked at.
        files: usize,
    },
    /// Slices that do not belong together.
    #[error(
        "{} holds slices of {} series: put those of one into a folder of their own.\n  {}", folder.display(), series.len(),
        series.join("\n  ")
    )]
    SeveralSeries {
        /// The folder.
        folder: PathBuf,
        /// A line for each: its files, size, spacing, orientation and echo.
        series: Vec<String>,
    },
    /// Two pictures of one slice.
    #[error(
        "{} and {} are two pictures of one place ({place_mm:.3} mm along the slices' normal): two times or echoes of one \
         series; take those of one out of the folder", first.display(), second.display()
    )]
    SamePlace {
        /// One of them.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// Where they are.
        place_mm: f64,
    },
    /// A slice that cannot be read.
    #[error(transparent)]
    Slice(#[from] ImageError),
    /// A folder that cannot be listed.
    #[error(transparent)]
    Folder(#[from] FramesError),
}

/// Reads a volume: a NRRD or NIfTI-1 file, or a folder that holds the slices of one DICOM series.
///
/// # Errors
/// The file or folder cannot be read, is no volume, is cut short or damaged, contradicts itself, or is of a kind that is
/// not read (the message says which and what to do).
pub fn read_volume(path: impl AsRef<Path>) -> Result<VolumeFile, VolumeFileError> {
    let path = path.as_ref();
    if path.is_dir() {
        return series::read(path);
    }
    let source = Source(path);
    let mut start = Vec::new();
    File::open(path).and_then(|file| file.take(4096).read_to_end(&mut start)).map_err(|e| source.io(e))?;
    match VolumeFormat::of_start(&start) {
        Some(VolumeFormat::Nrrd) => nrrd::read(path),
        Some(VolumeFormat::Nifti) => nifti::read(path),
        _ => Err(VolumeFileError::Unknown { path: path.to_owned(), hint: hint(&start) }),
    }
}

/// What a file that is no volume seems to be.
fn hint(start: &[u8]) -> &'static str {
    if start.get(128..132) == Some(b"DICM") {
        " (this is one DICOM file: name the folder of its series)"
    } else if start.is_empty() {
        " (it is empty)"
    } else {
        ""
    }
}

/// Which file an error is about.
#[derive(Clone, Copy)]
struct Source<'a>(&'a Path);

impl Source<'_> {
    fn path(self) -> PathBuf {
        self.0.to_owned()
    }

    fn io(self, source: io::Error) -> VolumeFileError {
        VolumeFileError::Io { path: self.path(), source }
    }

    fn damaged(self, what: impl Into<String>) -> VolumeFileError {
        VolumeFileError::Damaged { path: self.path(), what: what.into() }
    }

    fn unsupported(self, what: impl Into<String>, advice: &'static str) -> VolumeFileError {
        VolumeFileError::Unsupported { path: self.path(), what: what.into(), advice }
    }
}
