//! The index of input files: what they hold, known without reading them again.
//!
//! A file whose size and time of change are those of the last look has the content it had then: a run in which nothing
//! is to do opens no picture. `.biplane/inputs.json` holds, for each file (and picture in it) and reader setting, the
//! content hash and a few facts. It is dropped whole when the readers' code changes. A file changed less than
//! two seconds before it was read could change again without its time changing (coarse clocks), so it is not trusted yet.
//!
//! A wrong entry cannot make a wrong result: before a stage runs, the store holds what was read against the hash.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use biplane_artifact::{Content, ContentHash, Frame, ModelMesh, Volume};
use biplane_stage::{Hashed, Promise};
use serde::{Deserialize, Serialize};

use crate::diagnostics::slashes;
use crate::results::write_if_changed;

/// Raised when the layout of the index changes.
const FORMAT: u32 = 1;
/// The code of the readers, and of everything else that decides what a file means.
const CODE: &str = env!("BIPLANE_CODE_HASH");
/// A file must have been left alone this long before its time of change is trusted (FAT counts in 2 s).
const SETTLED: Duration = Duration::from_secs(2);

/// What is known of one picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrameFacts {
    hash: ContentHash,
    /// Columns and rows.
    pub size: [usize; 2],
}

impl FrameFacts {
    fn of(frame: &Frame) -> Self {
        Self { hash: frame.content_hash(), size: [frame.width, frame.height] }
    }

    /// The hash, for keys.
    pub fn promise(&self) -> Promise<Frame> {
        Promise::new(self.hash)
    }

    /// The hash, for the report.
    pub fn hash(&self) -> ContentHash {
        self.hash
    }
}

/// What is known of one mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshFacts {
    hash: ContentHash,
    /// Area centroid in model coordinates, mm.
    pub centroid: [f64; 3],
    /// Vertices.
    pub points: usize,
    /// Triangles.
    pub triangles: usize,
    /// What the reader found worth saying.
    pub notes: Vec<String>,
}

impl MeshFacts {
    /// Of a mesh and what its reader noted.
    pub fn of(mesh: &Hashed<ModelMesh>, notes: Vec<String>) -> Self {
        let c = mesh.0.area_centroid();
        let (points, triangles) = (mesh.0.vertices().len(), mesh.0.triangles().len());
        Self { hash: mesh.hash(), centroid: [c.x, c.y, c.z], points, triangles, notes }
    }

    /// The hash, for keys.
    pub fn promise(&self) -> Promise<ModelMesh> {
        Promise::new(self.hash)
    }

    /// The hash, for the report.
    pub fn hash(&self) -> ContentHash {
        self.hash
    }
}

/// What is known of one volume.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeFacts {
    hash: ContentHash,
    /// What the reader found worth saying.
    pub notes: Vec<String>,
}

impl VolumeFacts {
    /// Of a volume and what its reader noted.
    pub fn of(volume: &Hashed<Volume>, notes: Vec<String>) -> Self {
        Self { hash: volume.hash(), notes }
    }

    /// The hash, for keys.
    pub fn promise(&self) -> Promise<Volume> {
        Promise::new(self.hash)
    }

    /// The hash, for the report.
    pub fn hash(&self) -> ContentHash {
        self.hash
    }
}

/// Bytes and time of change (ns since 1970) of files.
type FileLooks = BTreeMap<PathBuf, (u64, u64)>;

/// A volume's files as they were when it was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct KnownVolume {
    files: FileLooks,
    settled: bool,
    facts: VolumeFacts,
}

/// A file as it was when it was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Known<F> {
    bytes: u64,
    modified_ns: u64,
    settled: bool,
    facts: F,
}

type Table<F> = BTreeMap<String, Known<F>>;

#[derive(Debug, Default, Serialize, Deserialize)]
struct Tables {
    format: u32,
    code: String,
    frames: Table<FrameFacts>,
    meshes: Table<MeshFacts>,
    volumes: BTreeMap<String, KnownVolume>,
}

/// The index of one study; many threads may ask it at once.
#[derive(Debug)]
pub struct InputIndex {
    root: PathBuf,
    file: PathBuf,
    old: Tables,
    new: Mutex<Tables>,
    distrusted: Mutex<BTreeSet<String>>,
}

impl InputIndex {
    /// Reads the index in `hidden` (the study's `.biplane`). One that is damaged, of another program or not there is
    /// empty: that costs time only.
    pub fn open(root: &Path, hidden: &Path) -> Self {
        let file = hidden.join("inputs.json");
        let old = std::fs::read(&file)
            .ok()
            .and_then(|bytes| serde_json::from_slice::<Tables>(&bytes).ok())
            .filter(|t| t.format == FORMAT && t.code == CODE)
            .unwrap_or_default();
        Self { root: root.to_owned(), file, old, new: Mutex::default(), distrusted: Mutex::default() }
    }

    /// What is known of picture `index` of a file; reads it if it may have changed.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn frame<E>(
        &self,
        path: &Path,
        index: usize,
        read: impl FnOnce() -> Result<Frame, E>,
    ) -> Result<FrameFacts, E> {
        let key = format!("{}#{index}", self.relative(path));
        self.known(&key, path, &self.old.frames, |t| &mut t.frames, || read().map(|f| FrameFacts::of(&f)))
    }

    /// What is known of a mesh read in `unit`; `read` is called if it may have changed.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn mesh<E>(
        &self,
        path: &Path,
        unit: &str,
        read: impl FnOnce() -> Result<MeshFacts, E>,
    ) -> Result<MeshFacts, E> {
        let key = format!("{} in {unit}", self.relative(path));
        self.known(&key, path, &self.old.meshes, |t| &mut t.meshes, read)
    }

    /// What is known of a volume: one file, one and its data file, or all the files of a folder. `read` is called if any of them
    /// may have changed, and says which files it read.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn volume<E>(
        &self,
        path: &Path,
        read: impl FnOnce() -> Result<(VolumeFacts, Vec<PathBuf>), E>,
    ) -> Result<VolumeFacts, E> {
        let key = format!("{} as a volume", self.relative(path));
        let seen = self.new.lock().unwrap_or_else(PoisonError::into_inner).volumes.get(&key).cloned();
        let old = self.old.volumes.get(&key).filter(|known| known.settled).cloned();
        let known = seen.or(old).filter(|known| {
            let files = if path.is_dir() { files_in(path) } else { known.files.keys().cloned().collect() };
            looks(&files).is_some_and(|(now, _)| now == known.files)
        });
        let known = match known {
            Some(known) => known,
            None => {
                // Looked at before it is read, and left alone since: a change during it makes the next run read again.
                let before = SystemTime::now();
                let listed = path.is_dir().then(|| files_in(path));
                let early = listed.as_deref().and_then(looks);
                let (facts, files) = read()?;
                let Some((files, newest)) = early.or_else(|| looks(&files)) else { return Ok(facts) };
                let settled = before.duration_since(newest).is_ok_and(|age| age >= SETTLED);
                KnownVolume { files, settled, facts }
            }
        };
        let facts = known.facts.clone();
        self.new.lock().unwrap_or_else(PoisonError::into_inner).volumes.insert(key, known);
        Ok(facts)
    }

    fn known<F: Clone, E>(
        &self,
        key: &str,
        path: &Path,
        old: &Table<F>,
        table: fn(&mut Tables) -> &mut Table<F>,
        make: impl FnOnce() -> Result<F, E>,
    ) -> Result<F, E> {
        // Looked at before reading: a change during it makes the next run read again.
        let look = look(path);
        let entry = match (old.get(key), look) {
            (Some(known), Some((bytes, modified_ns, _)))
                if known.settled && (known.bytes, known.modified_ns) == (bytes, modified_ns) =>
            {
                known.clone()
            }
            (_, Some((bytes, modified_ns, settled))) => Known { bytes, modified_ns, settled, facts: make()? },
            (_, None) => return make(),
        };
        let facts = entry.facts.clone();
        table(&mut self.new.lock().unwrap_or_else(PoisonError::into_inner)).insert(key.to_owned(), entry);
        Ok(facts)
    }

    /// A file turned out to hold something else than the index says, though its size and time of change are the same
    /// (or it changed while the program ran): the next run reads it again.
    pub fn distrust(&self, path: &Path) {
        self.distrusted.lock().unwrap_or_else(PoisonError::into_inner).insert(self.relative(path));
    }

    /// Writes the index. What was not asked for in this run is kept unless the run was a `whole` one.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn save(self, whole: bool) -> std::io::Result<()> {
        let Self { old, new, file, distrusted, .. } = self;
        let distrusted = distrusted.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut tables = new.into_inner().unwrap_or_else(PoisonError::into_inner);
        if !whole {
            for (key, known) in old.frames {
                tables.frames.entry(key).or_insert(known);
            }
            for (key, known) in old.meshes {
                tables.meshes.entry(key).or_insert(known);
            }
            for (key, known) in old.volumes {
                tables.volumes.entry(key).or_insert(known);
            }
        }
        let trusted = |key: &String| {
            let of = |path: &String| key.strip_prefix(path).is_some_and(|rest| rest.starts_with(['#', ' ']));
            !distrusted.iter().any(of)
        };
        tables.frames.retain(|key, _| trusted(key));
        tables.meshes.retain(|key, _| trusted(key));
        tables.volumes.retain(|key, _| trusted(key));
        tables.format = FORMAT;
        tables.code = CODE.to_owned();
        let mut bytes = serde_json::to_vec_pretty(&tables)?;
        bytes.push(b'\n');
        write_if_changed(&file, &bytes).map(|_| ())
    }

    fn relative(&self, path: &Path) -> String {
        slashes(path.strip_prefix(&self.root).unwrap_or(path))
    }
}

/// Size, time of change (ns since 1970) and whether that time lies far enough back; `None` if the system cannot say.
fn look(path: &Path) -> Option<(u64, u64, bool)> {
    let about = std::fs::metadata(path).ok()?;
    let modified = about.modified().ok()?;
    let ns = modified.duration_since(SystemTime::UNIX_EPOCH).ok()?.as_nanos();
    let settled = SystemTime::now().duration_since(modified).is_ok_and(|age| age >= SETTLED);
    Some((about.len(), u64::try_from(ns).ok()?, settled))
}

/// The files of a folder, in order.
fn files_in(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path());
    let mut files: Vec<PathBuf> = entries.filter(|p| p.is_file()).collect();
    files.sort();
    files
}

/// Size and time of change of each file, and the latest of those times; `None` if the system cannot say.
fn looks(files: &[PathBuf]) -> Option<(FileLooks, SystemTime)> {
    let mut newest = SystemTime::UNIX_EPOCH;
    let mut all = BTreeMap::new();
    for path in files {
        let (bytes, modified_ns, _) = look(path)?;
        newest = newest.max(SystemTime::UNIX_EPOCH + Duration::from_nanos(modified_ns));
        all.insert(path.clone(), (bytes, modified_ns));
    }
    Some((all, newest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn frame(level: u16) -> Frame {
        Frame { width: 2, height: 1, samples: vec![level, 0], bits: 8 }
    }

    fn put(path: &Path, text: &str, seconds_ago: u64) {
        std::fs::write(path, text).unwrap();
        let file = std::fs::File::options().write(true).open(path).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(seconds_ago)).unwrap();
    }

    #[test]
    fn an_unchanged_file_is_not_read_and_a_changed_one_is() {
        let folder = tempfile::tempdir().unwrap();
        let (root, path) = (folder.path(), folder.path().join("a.png"));
        let hidden = root.join(".biplane");
        let ask = |level: Option<u16>| {
            let index = InputIndex::open(root, &hidden);
            let read = || level.map(frame).ok_or("read");
            let facts = index.frame(&path, 0, read);
            index.save(true).unwrap();
            facts
        };
        put(&path, "x", 60);
        let first = ask(Some(7)).unwrap();
        assert_eq!(ask(None), Ok(first.clone()), "unchanged: not read");
        put(&path, "xy", 50);
        assert_eq!(ask(None), Err("read"), "another size and time");
        assert_ne!(ask(Some(8)).unwrap(), first);
        put(&path, "yx", 0);
        ask(Some(9)).unwrap();
        assert_eq!(ask(None), Err("read"), "changed a moment ago: not trusted yet");
    }

    #[test]
    fn a_volume_is_read_again_when_one_of_its_files_changed_or_came() {
        let folder = tempfile::tempdir().unwrap();
        let (root, series) = (folder.path(), folder.path().join("mri"));
        std::fs::create_dir(&series).unwrap();
        let volume = |level: f32| Volume {
            columns: 1,
            rows: 1,
            column_step_mm: [1.0, 0.0, 0.0],
            row_step_mm: [0.0, 1.0, 0.0],
            origins_mm: vec![[0.0; 3]],
            samples: vec![level],
        };
        let ask = |path: &Path, level: Option<f32>| {
            let index = InputIndex::open(root, &root.join(".biplane"));
            let facts = |level| {
                (
                    VolumeFacts::of(&Hashed::new(volume(level)), vec!["tilted".into()]),
                    vec![root.join("a.nhdr"), root.join("a.raw")],
                )
            };
            let facts = index.volume(path, || level.map(facts).ok_or("read"));
            index.save(true).unwrap();
            facts
        };
        put(&series.join("1.dcm"), "x", 60);
        let first = ask(&series, Some(1.0)).unwrap();
        assert_eq!(ask(&series, None), Ok(first), "unchanged: not read");
        put(&series.join("2.dcm"), "x", 60);
        assert_eq!(ask(&series, None), Err("read"), "one more file");
        ask(&series, Some(1.0)).unwrap();
        put(&series.join("1.dcm"), "y", 50);
        assert_eq!(ask(&series, None), Err("read"), "another time");

        let header = root.join("a.nhdr");
        put(&header, "h", 60);
        put(&root.join("a.raw"), "r", 60);
        ask(&header, Some(1.0)).unwrap();
        assert!(ask(&header, None).is_ok());
        put(&root.join("a.raw"), "s", 50);
        assert_eq!(ask(&header, None), Err("read"), "its data file changed");
        put(&root.join("a.raw"), "s", 0);
        ask(&header, Some(1.0)).unwrap();
        assert_eq!(ask(&header, None), Err("read"), "changed a moment ago: not trusted yet");
    }

    #[test]
    fn a_damaged_index_is_no_index() {
        let folder = tempfile::tempdir().unwrap();
        let hidden = folder.path().join(".biplane");
        std::fs::create_dir_all(&hidden).unwrap();
        std::fs::write(hidden.join("inputs.json"), "{").unwrap();
        let index = InputIndex::open(folder.path(), &hidden);
        let path = folder.path().join("gone.png");
        assert_eq!(index.frame(&path, 3, || Ok::<_, Infallible>(frame(1))).unwrap().size, [2, 1]);
        index.save(false).unwrap();
    }
}
