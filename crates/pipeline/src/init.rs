//! `biplane init`: looks at a folder of data and writes a commented `pipeline.toml` for it.
//!
//! What files are is told by what they hold; which belong together is guessed from names, and the file says so. An
//! existing file is never overwritten. Where there are no start poses, a table that may be filled in is written beside it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::{Read, Write as _};
use std::path::{Path, PathBuf};

use biplane_acquisition::calibration::CalibrationFormat;
use biplane_acquisition::images::{ImageFile, ImageFormat};
use biplane_acquisition::meshes::{LengthUnit, read_mesh};
use biplane_optimisation::MatchParams;

use crate::diagnostics::slashes;
use crate::tables::{EXAMPLE_HEADER, PoseTable};

/// Folders deeper than this are not looked into.
const DEPTH: usize = 5;
/// Files looked at.
const MOST_FILES: usize = 100_000;
/// Text files larger than this are neither calibration nor starts.
const MOST_TEXT: u64 = 16 << 20;

/// Endings of mesh files.
const MESHES: [&str; 6] = ["stl", "ply", "obj", "off", "vtk", "vtp"];
/// Endings of files of volumes.
const VOLUMES: [&str; 4] = [".nrrd", ".nhdr", ".nii", ".nii.gz"];

/// Why no file was written.
#[derive(Debug, thiserror::Error)]
pub enum InitError {
    /// There is one already.
    #[error("{path} is there already and is left as it is; rename it to have a new one written")]
    Exists {
        /// The file.
        path: String,
    },
    /// The folder cannot be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The folder or file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
}

/// What lies in a folder, paths relative to it with forward slashes.
#[derive(Debug, Default)]
struct Found {
    /// Folder, and how many pictures it holds.
    pictures: BTreeMap<String, usize>,
    /// Files with several pictures each.
    films: Vec<String>,
    calibrations: Vec<(String, CalibrationFormat)>,
    distortions: Vec<String>,
    /// Pictures with a plate, and with beads, in their names.
    plate_pictures: Vec<String>,
    bead_pictures: Vec<String>,
    /// Tables of holes, and of beads.
    plate_lists: Vec<String>,
    bead_lists: Vec<String>,
    meshes: Vec<FoundMesh>,
    /// MRI, CT or maps of labels: files of volumes.
    volumes: Vec<String>,
    starts: Vec<String>,
    /// The table of start poses that is to be filled in.
    template: Option<&'static str>,
    files: usize,
}

/// File, unit that gives a plausible size, bytes.
type FoundMesh = (String, Option<LengthUnit>, u64);

/// A recording: its name, and each view's name and pictures.
type Trial = (String, Vec<(String, String)>);

/// Names the table of start poses may get; the first that no other file has.
const TABLES: [&str; 2] = ["starts.csv", "start-poses.csv"];

/// Looks at `folder`, writes `folder/pipeline.toml` (and a table of start poses to fill in, if there is none), and says what was found and what is missing.
///
/// # Errors
/// See [`InitError`].
pub fn init(folder: &Path) -> Result<String, InitError> {
    let path = folder.join("pipeline.toml");
    let shown = slashes(&path);
    if path.exists() {
        return Err(InitError::Exists { path: shown });
    }
    let io = |path: &Path| {
        let path = slashes(path);
        move |source| InitError::Io { path, source }
    };
    let mut found = Found::default();
    look_into(folder, folder, DEPTH, &mut found).map_err(io(folder))?;
    let name = std::path::absolute(folder)
        .ok()
        .and_then(|p| p.file_name().map(|n| n.to_string_lossy().into_owned()));
    if found.starts.is_empty() {
        found.template = TABLES.into_iter().find(|t| {
            let path = folder.join(t);
            !path.exists() || PoseTable::read(&path).is_ok_and(|t| t.rows.is_empty())
        });
    }
    let (text, missing) = compose(&found, name.as_deref().unwrap_or("study"));
    let create = |path: &Path, text: &str| {
        let file = std::fs::File::options().write(true).create_new(true).open(path);
        file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(io(path))
    };
    create(&path, &text)?;
    let table = found.template.map(|t| folder.join(t)).filter(|t| !t.exists() && !trials(&found).is_empty());
    if let Some(table) = &table {
        create(table, &template(&found, folder))?;
    }
    let mut said = format!(
        "wrote {shown}: looked at {} files, found {} folder(s) of pictures, {} calibration(s), {} mesh(es), {} volume(s), {} \
         table(s) of start poses\n",
        found.files,
        found.pictures.len() + found.films.len(),
        found.calibrations.len(),
        found.meshes.len(),
        found.volumes.len(),
        found.starts.len()
    );
    if let Some(table) = &table {
        let _ = writeln!(said, "wrote {}: a table of start poses, which may stay as it is", slashes(table));
    }
    for line in &missing {
        let _ = writeln!(said, "missing: {line}");
    }
    let fill = if missing.is_empty() { "" } else { ", give what is missing" };
    let _ = writeln!(
        said,
        "Read {shown} through (which file is which was guessed from names){fill}, then: biplane run {shown}"
    );
    Ok(said)
}

fn look_into(root: &Path, folder: &Path, depth: usize, found: &mut Found) -> std::io::Result<()> {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)?.flatten().map(|e| e.path()).collect();
    entries.sort();
    for path in entries {
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let hidden = name.starts_with('.') || ["results", "edits", "truth"].contains(&name.as_str());
        if hidden || found.files >= MOST_FILES {
            continue;
        }
        if path.is_dir() {
            // A folder that may not be read is passed over; the one that was named is not.
            if depth > 0
                && let Err(error) = look_into(root, &path, depth - 1, found)
            {
                tracing::warn!("{}: {error}", path.display());
            }
        } else {
            found.files += 1;
            look_at(root, &path, found);
        }
    }
    Ok(())
}

fn look_at(root: &Path, path: &Path, found: &mut Found) {
    let relative = |p: &Path| slashes(p.strip_prefix(root).unwrap_or(p));
    let mut start = Vec::new();
    let Ok(file) = std::fs::File::open(path) else { return };
    let bytes = file.metadata().map_or(0, |m| m.len());
    if file.take(4096).read_to_end(&mut start).is_err() {
        return;
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if let Some(format) = ImageFormat::of_start(&start) {
        let several = matches!(format, ImageFormat::Tiff | ImageFormat::Dicom)
            && ImageFile::open(path).is_ok_and(|f| f.info().frames > 1);
        let says = |words: &[&str]| words.iter().any(|word| speaks_of(&relative(path), word));
        if says(&["plate", "grid"]) {
            found.plate_pictures.push(relative(path));
        } else if says(&["beads", "bead", "cube"]) {
            found.bead_pictures.push(relative(path));
        } else if several {
            found.films.push(relative(path));
        } else {
            *found.pictures.entry(relative(path.parent().unwrap_or(root))).or_default() += 1;
        }
    } else if is_volume(path) {
        found.volumes.push(relative(path));
    } else if MESHES.contains(&extension.as_str()) {
        let unit = LengthUnit::ALL.into_iter().find(|unit| {
            read_mesh(path, Some(*unit)).is_ok_and(|m| {
                let (low, high) = m.model.0.bounding_box();
                (10.0..=1000.0).contains(&(high - low).norm())
            })
        });
        found.meshes.push((relative(path), unit, bytes));
    } else if bytes <= MOST_TEXT && ["txt", "csv", "json", ""].contains(&extension.as_str()) {
        let start = String::from_utf8_lossy(&start);
        let header = start.lines().find(|l| !l.trim().is_empty() && !l.starts_with('#')).unwrap_or_default();
        let column = |name: &str| header.split(',').any(|c| c.trim() == name);
        if column("landmark") {
            // A person's landmarks are no list of beads.
        } else if start.contains("distorted_x_px") {
            found.distortions.push(relative(path));
        } else if column("x_mm") && column("y_mm") && !column("tx_mm") {
            if column("z_mm") { &mut found.bead_lists } else { &mut found.plate_lists }.push(relative(path));
        } else if let Some(format) =
            std::fs::read_to_string(path).ok().and_then(|t| CalibrationFormat::of_text(&t))
        {
            found.calibrations.push((relative(path), format));
        } else if extension == "csv" && PoseTable::read(path).is_ok_and(|t| !t.rows.is_empty()) {
            found.starts.push(relative(path));
        }
    }
}

/// Whether a file is a volume, by its name: reading it would take long.
fn is_volume(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    VOLUMES.iter().any(|ending| name.ends_with(ending))
}

/// Whether a file's name speaks of a view: one of its words is the view's name.
fn speaks_of(path: &str, view: &str) -> bool {
    let stem = path.rsplit('/').next().unwrap_or(path).to_lowercase();
    let view = view.to_lowercase();
    stem.split(|c: char| !c.is_alphanumeric()).any(|word| word == view)
}

fn last(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

fn stem(path: &str) -> &str {
    last(path).rsplit_once('.').map_or(last(path), |(stem, _)| stem)
}

/// A name that can be a folder and a column.
fn plain(name: &str) -> String {
    let name: String =
        name.chars().map(|c| if c.is_alphanumeric() || "-_".contains(c) { c } else { '_' }).collect();
    if name.is_empty() { "unnamed".to_owned() } else { name }
}

/// Folders of pictures (or files with many) that lie side by side are the views of one trial.
fn trials(found: &Found) -> Vec<Trial> {
    let mut groups: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    let single = found.pictures.iter().filter(|(folder, _)| !folder.to_lowercase().contains("calib"));
    for path in single.map(|(folder, _)| folder.as_str()).chain(found.films.iter().map(String::as_str)) {
        let parent = path.rsplit_once('/').map_or("", |(parent, _)| parent);
        let view = if found.films.iter().any(|f| f == path) { stem(path) } else { last(path) };
        groups
            .entry(parent.to_owned())
            .or_default()
            .push((plain(view), if path.is_empty() { "." } else { path }.to_owned()));
    }
    let several = groups.values().any(|views| views.len() > 1);
    groups
        .into_iter()
        .filter(|(_, views)| views.len() > 1 || !several)
        .map(|(parent, views)| {
            let name = match last(&parent) {
                "" | "frames" | "images" | "trials" => "trial1".to_owned(),
                other => plain(other),
            };
            (name, views)
        })
        .collect()
}

impl Found {
    /// Whether raw calibration pictures are there for every view, and a list of beads.
    fn raw(&self, views: &[String]) -> bool {
        let pictured = |view: &String| self.bead_pictures.iter().any(|path| speaks_of(path, view));
        !views.is_empty() && !self.bead_lists.is_empty() && views.iter().all(pictured)
    }
}

/// The file's text, and what it lacks.
fn compose(found: &Found, name: &str) -> (String, Vec<String>) {
    let mut missing = Vec::new();
    let trials = trials(found);
    let views: Vec<String> =
        trials.first().map_or_else(Vec::new, |(_, v)| v.iter().map(|(n, _)| n.clone()).collect());
    let mut out = String::from(
        "# Written by `biplane init` from what lies in this folder. Which file is which was guessed from names: check it.\n\
         # Paths are relative to this file. All keys and defaults: docs/pipeline-reference.md, or `biplane schema`.\n\n[study]\n",
    );
    let _ = writeln!(out, "name = {}\n", quoted(name));
    if views.is_empty() {
        missing.push("pictures: no folder of images, and no file with many, was found".to_owned());
    }
    let raw = found.raw(&views);
    for view in &views {
        if raw {
            let _ = writeln!(out, "[fluoroscope.{view}]");
            match found.plate_pictures.iter().find(|path| speaks_of(path, view)) {
                Some(path) => {
                    let _ = writeln!(out, "plate = {}", quoted(path));
                }
                None => {
                    out += "# plate = \"...\"             # a picture of the plate; for corrected pictures instead:\n\
                                pixel_mm = 0.3              # FILL IN: side of a pixel on the detector, mm\n"
                }
            }
            let own = found.bead_pictures.iter().find(|path| speaks_of(path, view));
            let _ = writeln!(out, "beads = {}\n", quoted(own.map_or("FILL IN", String::as_str)));
            continue;
        }
        let own =
            found.calibrations.iter().find(|(path, format)| !format.has_one_view() || speaks_of(path, view));
        let _ = writeln!(out, "[fluoroscope.{view}]");
        match own {
            Some((path, format)) => {
                let _ = writeln!(out, "calibration = {}", quoted(path));
                if format.leaves_pixel_origin_open() {
                    out += "pixel_origin = \"centre\"   # or \"corner\": where the file counts pixels from; it does not say\n";
                }
            }
            None => {
                missing.push(format!(
                    "a calibration of view {view} (MayaCam 2.0 text with `{view}` in its name; or a picture of the beads, \
                     such as beads_{view}.png, and their list)"
                ));
                out += "calibration = \"FILL IN\"     # MayaCam 2.0 text as XMALab writes it, or source-and-plane JSON\n";
            }
        }
        match found.distortions.iter().find(|path| speaks_of(path, view)) {
            Some(path) => {
                let _ = writeln!(out, "distortion = {}", quoted(path));
            }
            None => out += "# distortion = \"...\"        # only if the pictures are not corrected\n",
        }
        out.push('\n');
    }
    if raw {
        if !found.plate_pictures.is_empty() {
            out += "[plate]\n";
            match found.plate_lists.first() {
                Some(path) => {
                    let _ = writeln!(out, "list = {}", quoted(path));
                }
                None => {
                    missing
                        .push("where the plate's holes are: a list, or `pattern` and `pitch_mm`".to_owned());
                    out += "list = \"FILL IN\"            # CSV hole,x_mm,y_mm,radius_mm; or pattern = \"square\" and pitch_mm = 10.0\n";
                }
            }
            out += "spots = \"bright\"            # or \"dark\": holes are bright, dots and balls dark\n\n";
        }
        let list = found.bead_lists.first().map_or("FILL IN", String::as_str);
        let _ = writeln!(out, "[beads]\nlist = {}\nunits = \"mm\"\n", quoted(list));
    }
    compose_bodies(found, &mut out, &mut missing);
    for (trial, pictures) in &trials {
        let names: Vec<&String> = pictures.iter().map(|(n, _)| n).collect();
        if names != views.iter().collect::<Vec<_>>() {
            let _ = writeln!(out, "# {trial}: its views are {names:?}, not those above; left out\n");
            continue;
        }
        let list: Vec<String> =
            pictures.iter().map(|(view, path)| format!("{view} = {}", quoted(path))).collect();
        let _ = writeln!(out, "[[trial]]\nname = {}\nframes = {{ {} }}", quoted(trial), list.join(", "));
        out += "pair_by = \"number\"          # the number in the files' names; or \"index\", the place in the list\n\
                offset = 0                  # the second view's number minus the first one's\n\
                # frame_rate_hz = 100.0\n";
        match found.starts.as_slice() {
            [] => {
                let table = found.template.unwrap_or(TABLES[0]);
                let _ = writeln!(
                    out,
                    "starts = \"{table}\"     # may stay empty: a body without a start is looked for\n"
                );
            }
            [first, others @ ..] => {
                let _ = writeln!(out, "starts = {}", quoted(first));
                for other in others {
                    let _ = writeln!(out, "# starts = {}", quoted(other));
                }
                out.push('\n');
            }
        }
    }
    if found.starts.is_empty() {
        out += &explained("#");
        out.push('\n');
    }
    if views.is_empty() {
        out += "# FILL IN one table for each fluoroscope and one for each recording:\n\
                # [fluoroscope.A]\n# calibration = \"A.txt\"\n# [fluoroscope.B]\n# calibration = \"B.txt\"\n\
                # [[trial]]\n# name = \"trial1\"\n# frames = { A = \"frames/A\", B = \"frames/B\" }\n# starts = \"starts.csv\"\n\n";
    }
    out += "[segment]                   # how edges are found\n\n[match]                     # how poses are found\n\n\
            [output]\nfolder = \"results\"\n";
    (out, missing)
}

/// What a table of start poses holds, as comment lines.
fn explained(mark: &str) -> String {
    let reach = MatchParams::default().search_px;
    [
        format!("Start poses, one row a body and frame, with the columns {EXAMPLE_HEADER}:"),
        "  trial, frame, body    names as in pipeline.toml; the frame is the number in the picture's name".to_owned(),
        "  tx_mm, ty_mm, tz_mm   where the mesh's origin lies in the world of the calibration, mm".to_owned(),
        "  qw, qx, qy, qz        rotation from mesh to world: unit quaternion, its scalar (qw) first".to_owned(),
        "That is x_world = R(q) x_mesh + t. Not needed: a body without a start is looked for. With one it is found faster,".to_owned(),
        "and told from a place where it fits as well. Rough is enough: the outline should come within about".to_owned(),
        format!("{reach} px of its edges ([match] search_px). Frames without a row start between those that have one."),
    ]
    .map(|line| format!("{mark} {line}\n"))
    .concat()
}

/// A table of start poses without rows, and a row that may be filled in for each body of each trial.
fn template(found: &Found, folder: &Path) -> String {
    let mut out = explained("#");
    out += "# Take the # and the space from a line below, and write numbers for the dots.\n";
    let _ = writeln!(out, "{EXAMPLE_HEADER}");
    for (trial, views) in trials(found) {
        let first = views.first().and_then(|(_, place)| {
            let frames = biplane_acquisition::frames::list_frames(folder, place).ok()?;
            frames.first().map(|f| f.label.clone())
        });
        let of_volumes = found.volumes.iter().map(|path| plain(last(path).split('.').next().unwrap_or(path)));
        let names: BTreeSet<String> = bodies(found).into_keys().chain(of_volumes).collect();
        for body in names {
            let frame = first.as_deref().unwrap_or("0000");
            let _ = writeln!(out, "# {trial},{frame},{body},...,...,...,...,...,...,...");
        }
    }
    out
}

/// Meshes by the name of their body.
fn bodies(found: &Found) -> BTreeMap<String, Vec<&FoundMesh>> {
    let mut bodies: BTreeMap<String, Vec<&FoundMesh>> = BTreeMap::new();
    for mesh in &found.meshes {
        let base = stem(&mesh.0).trim_end_matches(|c: char| c.is_ascii_digit() || "_-. ".contains(c));
        bodies.entry(plain(if base.is_empty() { stem(&mesh.0) } else { base })).or_default().push(mesh);
    }
    bodies
}

/// One table a mesh; of meshes that differ by a number at the end only the largest, the others as comments.
fn compose_bodies(found: &Found, out: &mut String, missing: &mut Vec<String>) {
    let bodies = bodies(found);
    compose_volumes(found, &bodies, out, missing);
    if bodies.is_empty() && found.volumes.is_empty() {
        missing.push(
            "meshes (STL, PLY, OBJ, OFF, VTK) of the bodies, or MRI, CT or maps of labels of their bones"
                .to_owned(),
        );
        *out += "[[body]]\nname = \"femur\"\nmesh = \"FILL IN\"\n\n";
    }
    for (name, mut meshes) in bodies {
        meshes.sort_by_key(|(path, _, bytes)| (std::cmp::Reverse(*bytes), path.clone()));
        for (place, (path, unit, _)) in meshes.into_iter().enumerate() {
            if place > 0 {
                let _ = writeln!(out, "# mesh = {}", quoted(path));
                continue;
            }
            let _ = writeln!(out, "[[body]]\nname = {}\nmesh = {}", quoted(&name), quoted(path));
            match unit {
                Some(unit) => {
                    let _ =
                        writeln!(out, "units = \"{}\"                # guessed from its size", unit.name());
                }
                None => missing
                    .push(format!("a usable mesh in {path}: `biplane inspect` says what is wrong with it")),
            }
        }
        out.push('\n');
    }
}

/// A bone and a body for each volume; as comments where there is a mesh of that name.
fn compose_volumes(
    found: &Found,
    bodies: &BTreeMap<String, Vec<&FoundMesh>>,
    out: &mut String,
    missing: &mut Vec<String>,
) {
    let mut seen = BTreeSet::new();
    for path in &found.volumes {
        let name = plain(last(path).split('.').next().unwrap_or(path));
        if !seen.insert(name.clone()) {
            let _ = writeln!(out, "# {path} is another volume of that name: left out\n");
            continue;
        }
        let meshed = bodies.contains_key(&name);
        let mark = if meshed { "# " } else { "" };
        let lines = [
            "[[slices]]".to_owned(),
            format!("name = {}", quoted(&name)),
            format!("volume = {}", quoted(path)),
            "find = { method = \"bone\", seed_mm = [0.0, 0.0, 0.0] }   # FILL IN: a point in its marrow, mm; or { label = 1 }".to_owned(),
            String::new(),
            "[[body]]".to_owned(),
            format!("name = {}", quoted(&name)),
            format!("slices = {}                   # its contours become its surface", quoted(&name)),
            "# axes = { body = \"femur\", side = \"left\" }   # its local coordinate system".to_owned(),
            String::new(),
        ];
        for line in lines {
            let _ = writeln!(out, "{}", if line.is_empty() { line } else { format!("{mark}{line}") });
        }
        if !meshed {
            missing
                .push(format!("where the bone {name} lies in {path}: a point in its marrow, or its label"));
        }
    }
}

/// A TOML text.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_side_by_side_are_one_trial_and_calibration_pictures_are_none() {
        let mut found = Found::default();
        for (folder, count) in [("calibration", 4), ("frames/A", 12), ("frames/B", 12), ("other", 1)] {
            found.pictures.insert(folder.to_owned(), count);
        }
        found.calibrations = vec![("calibration/a.txt".to_owned(), CalibrationFormat::MayaCam2)];
        found.meshes = vec![
            ("models/tray_3500.stl".to_owned(), Some(LengthUnit::Millimetres), 1),
            ("models/tray_15000.stl".to_owned(), Some(LengthUnit::Millimetres), 2),
        ];
        let (text, missing) = compose(&found, "my \"knee\"");
        assert!(text.contains("frames = { A = \"frames/A\", B = \"frames/B\" }"), "{text}");
        assert!(
            text.contains("mesh = \"models/tray_15000.stl\"")
                && text.contains("# mesh = \"models/tray_3500.stl\"")
        );
        assert_eq!(missing.len(), 1, "the calibration of B, and no starts: {missing:?}");
        let file: Result<crate::config::PipelineFile, _> = toml::from_str(&text);
        assert!(file.is_ok(), "{text}\n{file:?}");
    }

    #[test]
    fn a_view_is_a_word_of_a_file_name() {
        assert!(speaks_of("calibration/cam1.mayacam2.txt", "cam1") && speaks_of("x/distortion_A.csv", "a"));
        assert!(!speaks_of("cam10.txt", "cam1"));
    }
}
