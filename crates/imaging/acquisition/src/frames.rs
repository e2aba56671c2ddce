//! The frames of one view, and which of them were taken at the same time as those of the others.
//!
//! A view's frames are named by a folder (all images in it), a pattern (`frames/A/*.png`), or one file of one frame or
//! many. They come in natural order: runs of digits compare as numbers, so `9.tif` is before `10.tif`.
//!
//! A damaged picture among those of a folder is still one frame of the list: it fails when it is read, and the others
//! keep their places. Which frames a damaged file of many held cannot be known, so beside such files it is an error.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::images::{ImageError, ImageFile, ImageFormat};

/// One frame of one view.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameSource {
    /// Its file.
    pub path: PathBuf,
    /// Its place in that file, from 0.
    pub index_in_file: usize,
    /// The last run of digits in the file's name; where a file holds several frames, the place in the list.
    pub number: Option<u64>,
    /// The number as the file's name writes it, with its zeros; otherwise the place in the list, four digits.
    pub label: String,
    /// Seconds after the first frame of its file, if the file says.
    pub time_s: Option<f64>,
}

/// Why a list of frames could not be made.
#[derive(Debug, thiserror::Error)]
pub enum FramesError {
    /// The operating system said no.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Nothing of that name.
    #[error("{} is not there; frames are named by a folder, a pattern such as `frames/A/*.png`, or one file", path.display())]
    Missing {
        /// What was named.
        path: PathBuf,
    },
    /// Not a pattern.
    #[error("`{pattern}` is not a pattern of file names: {what}")]
    Pattern {
        /// The pattern.
        pattern: String,
        /// What is wrong with it.
        what: &'static str,
    },
    /// No image among the files.
    #[error("no image in {}: {files} file(s), none of them PNG, TIFF, DICOM, JPEG or BMP", path.display())]
    NoImages {
        /// The folder or pattern.
        path: PathBuf,
        /// Files looked at.
        files: usize,
    },
    /// An image that cannot be opened.
    #[error(transparent)]
    Image(#[from] ImageError),
}

/// Lists the frames that `named` names, relative to the folder `base`.
///
/// In a folder, and among what a pattern finds, files that are not images are passed over; hidden ones are too. A file
/// that is named like an image or starts like one, but cannot be opened, counts as one frame.
///
/// # Errors
/// Nothing of that name, no image among it, or an image that cannot be opened where that leaves unknown which frames
/// there are: it is the only file, none of the files can be opened, or others hold many frames.
pub fn list_frames(base: impl AsRef<Path>, named: &str) -> Result<Vec<FrameSource>, FramesError> {
    let path = base.as_ref().join(named);
    if path.is_file() {
        return of_files(&[path]);
    }
    let (files, all_of_it) = if path.is_dir() {
        (files_of_folder(&path)?, path)
    } else if named.contains(['*', '?', '[']) {
        (files_of_pattern(base.as_ref(), named)?, path)
    } else {
        return Err(FramesError::Missing { path });
    };
    let count = files.len();
    let mut images = Vec::with_capacity(count);
    for file in files {
        if is_image(&file) {
            images.push(file);
        }
    }
    if images.is_empty() {
        return Err(FramesError::NoImages { path: all_of_it, files: count });
    }
    images.sort_by(|a, b| natural(&a.to_string_lossy(), &b.to_string_lossy()));
    of_files(&images)
}

pub(crate) fn files_of_folder(folder: &Path) -> Result<Vec<PathBuf>, FramesError> {
    let io = |source| FramesError::Io { path: folder.to_owned(), source };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        if !entry.file_name().to_string_lossy().starts_with('.') && entry.path().is_file() {
            files.push(entry.path());
        }
    }
    Ok(files)
}

fn files_of_pattern(base: &Path, pattern: &str) -> Result<Vec<PathBuf>, FramesError> {
    // A folder whose name holds `[` is no pattern.
    let whole = if Path::new(pattern).is_absolute() || base.as_os_str().is_empty() {
        pattern.to_owned()
    } else {
        format!("{}/{pattern}", glob::Pattern::escape(&base.to_string_lossy()))
    };
    let options = glob::MatchOptions {
        case_sensitive: true,
        require_literal_separator: true,
        require_literal_leading_dot: true,
    };
    let found = glob::glob_with(&whole, options)
        .map_err(|e| FramesError::Pattern { pattern: pattern.to_owned(), what: e.msg })?;
    let mut files = Vec::new();
    for entry in found {
        let path = entry.map_err(|e| FramesError::Io { path: e.path().to_owned(), source: e.into() })?;
        if path.is_file() {
            files.push(path);
        }
    }
    Ok(files)
}

/// Whether a file is an image or is meant to be one: by its first bytes, or by its name (an empty or overwritten file, or
/// one that may not be read, is a frame that is missing, not a file to pass over).
fn is_image(path: &Path) -> bool {
    let named = path.extension().is_some_and(|e| {
        let e = e.to_string_lossy().to_lowercase();
        ["png", "tif", "tiff", "dcm", "jpg", "jpeg", "bmp"].contains(&e.as_str())
    });
    let starts = || {
        let mut start = Vec::with_capacity(132);
        let read = File::open(path).and_then(|file| file.take(132).read_to_end(&mut start));
        read.is_ok() && ImageFormat::of_start(&start).is_some()
    };
    named || starts()
}

fn of_files(paths: &[PathBuf]) -> Result<Vec<FrameSource>, FramesError> {
    let mut sources = Vec::with_capacity(paths.len());
    let mut several = false;
    let mut damaged = None;
    let mut opened = 0_usize;
    for path in paths {
        let (frames, times_s) = match ImageFile::open(path) {
            Ok(file) => {
                opened += 1;
                (file.info().frames, file.info().times_s.clone())
            }
            Err(error) => {
                damaged.get_or_insert(error);
                (1, Vec::new())
            }
        };
        several |= frames > 1;
        let digits = last_digits(path);
        for index_in_file in 0..frames {
            let number = digits.as_deref().and_then(|d| d.parse().ok());
            let place = format!("{:04}", sources.len());
            sources.push(FrameSource {
                path: path.clone(),
                index_in_file,
                number,
                label: digits.clone().filter(|_| number.is_some()).unwrap_or(place),
                time_s: if frames > 1 { times_s.get(index_in_file).copied() } else { None },
            });
        }
    }
    if let Some(error) = damaged.filter(|_| several || opened == 0) {
        return Err(error.into());
    }
    if several {
        for (place, source) in sources.iter_mut().enumerate() {
            source.number = Some(place as u64);
            source.label = format!("{place:04}");
        }
    }
    Ok(sources)
}

/// The last run of digits in a file's name without its extension.
fn last_digits(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_string_lossy();
    // An extension has a letter: in `run.0138` the digits are the number.
    let stem = match name.rsplit_once('.') {
        Some((stem, extension))
            if extension.contains(|c: char| c.is_ascii_alphabetic()) && !stem.is_empty() =>
        {
            stem
        }
        _ => &name,
    };
    let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = stem[..end]
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |i| i + stem[i..].chars().next().map_or(1, char::len_utf8));
    Some(stem[start..end].to_owned())
}

/// Compares texts with runs of digits as numbers; equal numbers with different zeros go by the text.
pub(crate) fn natural(a: &str, b: &str) -> Ordering {
    let (mut x, mut y) = (a, b);
    loop {
        let (Some(p), Some(q)) = (x.chars().next(), y.chars().next()) else {
            return x.len().cmp(&y.len()).then_with(|| a.cmp(b));
        };
        let step = if p.is_ascii_digit() && q.is_ascii_digit() {
            let run = |s: &str| s.find(|c: char| !c.is_ascii_digit()).unwrap_or(s.len());
            let (m, n) = (run(x), run(y));
            let (u, v) = (x[..m].trim_start_matches('0'), y[..n].trim_start_matches('0'));
            (x, y) = (&x[m..], &y[n..]);
            u.len().cmp(&v.len()).then_with(|| u.cmp(v))
        } else {
            (x, y) = (&x[p.len_utf8()..], &y[q.len_utf8()..]);
            p.cmp(&q)
        };
        if step != Ordering::Equal {
            return step;
        }
    }
}

/// By what the frames of the views belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PairBy {
    /// By the number in the file's name (or the place in a file of many frames).
    #[default]
    Number,
    /// By the place in the list.
    Index,
}

/// Frames of all views taken at the same time.
#[derive(Debug, Clone, PartialEq)]
pub struct FramePair {
    /// Its name: the digits of the first view's file name with their zeros, or the place in the first view's list.
    pub label: String,
    /// One a view, in the order of the views.
    pub sources: Vec<FrameSource>,
}

/// Frames of one view that belong to none of another.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unpaired {
    /// The view.
    pub view: String,
    /// How many of its frames.
    pub count: usize,
    /// Labels of the first few.
    pub first: Vec<String>,
}

impl std::fmt::Display for Unpaired {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let more = if self.count > self.first.len() { ", ..." } else { "" };
        write!(
            f,
            "{} frame(s) of view {} are left out, since not every other view has the frame taken with them: {}{more}",
            self.count,
            self.view,
            self.first.join(", ")
        )
    }
}

/// The frames that belong together, and what is left over.
#[derive(Debug, Clone, PartialEq)]
pub struct Pairing {
    /// In the order of the first view.
    pub pairs: Vec<FramePair>,
    /// One for each view that has frames left over.
    pub unpaired: Vec<Unpaired>,
}

/// Why frames could not be paired.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PairError {
    /// Nothing belongs together.
    #[error(
        "no frame of one view belongs to one of another (paired by {by}, offset {offset}): {views}; check the folders, \
         `pair_by` and `offset`"
    )]
    NoPairs {
        /// `number` or `index`.
        by: &'static str,
        /// The offset of the second view.
        offset: i64,
        /// How each view's list starts.
        views: String,
    },
    /// Two frames of one view with one number.
    #[error(
        "view {view}: {} and {} both have the number {number}; rename one, or pair by index", first.display(), second.display()
    )]
    SameNumber {
        /// The view.
        view: String,
        /// The number.
        number: u64,
        /// A file.
        first: PathBuf,
        /// Another.
        second: PathBuf,
    },
    /// A file without digits in its name.
    #[error("view {view}: {} has no number in its name; name the files by frame, or pair by index", path.display())]
    NoNumber {
        /// The view.
        view: String,
        /// The file.
        path: PathBuf,
    },
}

/// Labels named in messages.
const NAMED: usize = 5;

/// Pairs the frames of all views.
///
/// Frame `k` of the first view (and of the third and further ones) belongs to frame `k + offset` of the second.
///
/// # Errors
/// A number is missing or there twice (by number only), or nothing belongs together.
pub fn pair(views: &[(String, Vec<FrameSource>)], by: PairBy, offset: i64) -> Result<Pairing, PairError> {
    let mut keyed: Vec<BTreeMap<i128, &FrameSource>> = Vec::with_capacity(views.len());
    for (v, (view, sources)) in views.iter().enumerate() {
        let shift = if v == 1 { i128::from(offset) } else { 0 };
        let mut keys = BTreeMap::new();
        for (place, source) in sources.iter().enumerate() {
            let number = match by {
                PairBy::Index => place as u64,
                PairBy::Number => source
                    .number
                    .ok_or_else(|| PairError::NoNumber { view: view.clone(), path: source.path.clone() })?,
            };
            if let Some(other) = keys.insert(i128::from(number) - shift, source) {
                return Err(PairError::SameNumber {
                    view: view.clone(),
                    number,
                    first: other.path.clone(),
                    second: source.path.clone(),
                });
            }
        }
        keyed.push(keys);
    }
    let label = |key: i128, source: &FrameSource| match by {
        PairBy::Number => source.label.clone(),
        PairBy::Index => format!("{key:04}"),
    };
    let shared = |key: &i128| keyed.iter().all(|keys| keys.contains_key(key));
    let pairs: Vec<FramePair> = keyed
        .first()
        .into_iter()
        .flatten()
        .filter(|(key, _)| shared(key))
        .map(|(key, first)| FramePair {
            label: label(*key, first),
            sources: keyed.iter().filter_map(|keys| keys.get(key).map(|s| (*s).clone())).collect(),
        })
        .collect();
    if pairs.is_empty() {
        let start = |(view, sources): &(String, Vec<FrameSource>)| {
            let labels: Vec<&str> = sources.iter().take(NAMED).map(|s| s.label.as_str()).collect();
            let more = if sources.len() > NAMED { ", ..." } else { "" };
            format!("view {view} has {} frame(s): {}{more}", sources.len(), labels.join(", "))
        };
        return Err(PairError::NoPairs {
            by: match by {
                PairBy::Number => "number",
                PairBy::Index => "index",
            },
            offset,
            views: views.iter().map(start).collect::<Vec<_>>().join("; "),
        });
    }
    let unpaired = views
        .iter()
        .zip(&keyed)
        .filter_map(|((view, _), keys)| {
            let alone: Vec<&FrameSource> = keys.iter().filter(|(k, _)| !shared(k)).map(|(_, s)| *s).collect();
            (!alone.is_empty()).then(|| Unpaired {
                view: view.clone(),
                count: alone.len(),
                first: alone.iter().take(NAMED).map(|s| s.label.clone()).collect(),
            })
        })
        .collect();
    Ok(Pairing { pairs, unpaired })
}
