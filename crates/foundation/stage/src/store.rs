//! Entries on disk: found by key, written whole or not at all.

use std::fmt;
use std::fs;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use biplane_artifact::{Artifact, ContentHash, ContentHasher, DecodeError};

use crate::input::{Hashed, Promise};
use crate::item::relative_path;
use crate::key::{FORMAT, OutputRecord, Record, RecordHead};
use crate::{Context, InputHashes, InputPart, Inputs, Item, Key, KeyParts, ParamsError, ParamsText, Stage};

const RECORD_FILE: &str = "entry.json";

/// A folder in `tmp/` lives only while an entry is written; one this old was left by a run that was killed.
const LEFT_OVER_AFTER: Duration = Duration::from_secs(3600);

/// From <https://bford.info/cachedir/>: backup programs leave out a folder with this file.
const CACHEDIR_TAG: &str = "Signature: 8a477f597d28d172789f06886806bc55\n\
    # The entries of a biplane study. Deleting this folder loses nothing but computing time.\n";

/// The entries of one study, in its folder `.biplane/`.
#[derive(Debug, Clone)]
pub struct Store {
    dir: PathBuf,
}

/// The store's folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file system said no.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// On what.
        path: PathBuf,
        /// Its answer.
        source: io::Error,
    },
    /// An entry is not what was written.
    #[error(transparent)]
    Damaged(#[from] Damaged),
    /// Items of one step have different numbers of parts.
    #[error(
        "{}: the name of an item is in the way of {step}/{item}; items of one step need the same number of parts. If it \
         is of an earlier version, remove it: that loses no result",
        path.display()
    )]
    ItemClash {
        /// The step.
        step: String,
        /// The item that has no place.
        item: Item,
        /// What is there.
        path: PathBuf,
    },
    /// An artifact cannot be read from the file it writes, for instance because a number is not finite.
    #[error("the stage's output cannot be read back from its own file, so it was not kept: {0}")]
    DoesNotReadBack(#[source] DecodeError),
    /// The artifact's [`content_hash`](biplane_artifact::Content::content_hash) is not the hash of its file.
    #[error("the content hash of a {kind} is not that of its file's bytes: an error of the program")]
    HashOfAnotherFile {
        /// The artifact's kind.
        kind: &'static str,
    },
}

impl StoreError {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_path_buf(), source }
    }
}

/// An entry is not what was written.
///
/// What a lookup can see, [`Store::execute`] mends by itself. What shows only when an output is loaded, inside the `load`
/// of a step that follows, comes out as the error of that step: [`Store::discard`] the entry and execute its step again.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("entry {key} is damaged: {what}")]
pub struct Damaged {
    /// Which entry.
    pub key: Key,
    /// What was found, and what was expected.
    pub what: String,
}

/// An entry that was found, its output not yet read.
pub struct Stored<A> {
    key: Key,
    path: PathBuf,
    bytes: u64,
    hash: ContentHash,
    of: PhantomData<fn() -> A>,
}

impl<A> Clone for Stored<A> {
    fn clone(&self) -> Self {
        Self { key: self.key, path: self.path.clone(), bytes: self.bytes, hash: self.hash, of: PhantomData }
    }
}

impl<A> fmt::Debug for Stored<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Stored").field("path", &self.path).field("hash", &self.hash).finish_non_exhaustive()
    }
}

impl<A: Artifact> Stored<A> {
    /// Which entry.
    pub fn key(&self) -> Key {
        self.key
    }

    /// Hash of the output, as the entry states it.
    pub fn hash(&self) -> ContentHash {
        self.hash
    }

    /// The same, for the key of what follows.
    pub fn promise(&self) -> Promise<A> {
        Promise::new(self.hash)
    }

    /// The output's file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Length of the output's file.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Reads the output and holds its bytes against the entry's hash.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] if they are others, or gone.
    pub fn load(&self) -> Result<Hashed<A>, StoreError> {
        let damaged =
            |what: String| Damaged { key: self.key, what: format!("{}: {what}", self.path.display()) };
        let bytes = match fs::read(&self.path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                return Err(damaged("the file is gone".into()).into());
            }
            Err(e) => return Err(StoreError::io("read", &self.path)(e)),
        };
        let hash = hash_of_file::<A>(&bytes);
        if hash != self.hash {
            let what = format!(
                "{} bytes with hash {hash:?}, {} bytes with hash {:?} were written",
                bytes.len(),
                self.bytes,
                self.hash
            );
            return Err(damaged(what).into());
        }
        let value = A::decode(&bytes).map_err(|e| damaged(e.to_string()))?;
        Ok(Hashed::of_checked(value, hash))
    }
}

/// The content hash of an artifact, from its file: the convention of the artifact crate.
fn hash_of_file<A: Artifact>(bytes: &[u8]) -> ContentHash {
    ContentHasher::new(A::KIND, A::SCHEMA).bytes(bytes).finish()
}

/// How an item came to its output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum How {
    /// It was there.
    Cached,
    /// The stage ran.
    Ran,
    /// The stage ran because the entry that was there is damaged; worth telling.
    Remade(Damaged),
}

/// What [`Store::execute`] gives.
pub struct Outcome<A> {
    /// Whether the stage ran.
    pub how: How,
    /// The entry.
    pub output: Stored<A>,
}

impl<A> Clone for Outcome<A> {
    fn clone(&self) -> Self {
        Self { how: self.how.clone(), output: self.output.clone() }
    }
}

impl<A> fmt::Debug for Outcome<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Outcome").field("how", &self.how).field("output", &self.output).finish()
    }
}

/// Why an item has no output. `S` is the stage's error, `L` that of loading its inputs.
#[derive(Debug, thiserror::Error)]
pub enum ExecuteError<S, L> {
    /// The context was cancelled before the item was finished; nothing was kept.
    #[error("cancelled")]
    Cancelled,
    /// The stage failed.
    #[error(transparent)]
    Stage(S),
    /// The inputs could not be loaded.
    #[error(transparent)]
    Load(L),
    /// What was loaded is not what the key was made from.
    #[error("input {role} changed while the program ran; run it again")]
    InputChanged {
        /// Which input: `curves[1]`.
        role: String,
    },
    /// The text is not one of this stage's parameters.
    #[error(transparent)]
    Params(#[from] ParamsError),
    /// The entry could not be read or written.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl Store {
    /// Opens a study's store, and makes it if it is not there. Takes away what killed runs left behind an hour ago or more.
    ///
    /// # Errors
    /// [`StoreError::Io`] if the folder cannot be made or read.
    pub fn open(dir: &Path) -> Result<Self, StoreError> {
        let store = Self { dir: dir.to_path_buf() };
        for folder in [store.entries(), store.tmp(), store.steps()] {
            fs::create_dir_all(&folder).map_err(StoreError::io("make the folder", &folder))?;
        }
        let tag = dir.join("CACHEDIR.TAG");
        if !tag.exists() {
            fs::write(&tag, CACHEDIR_TAG).map_err(StoreError::io("write", &tag))?;
        }
        store.remove_left_overs()?;
        Ok(store)
    }

    /// Its folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    pub(crate) fn entries(&self) -> PathBuf {
        self.dir.join("entries")
    }

    pub(crate) fn steps(&self) -> PathBuf {
        self.dir.join("steps")
    }

    fn tmp(&self) -> PathBuf {
        self.dir.join("tmp")
    }

    pub(crate) fn entry_dir(&self, key: Key) -> PathBuf {
        self.dir.join(entry_path(key))
    }

    /// Where `steps/<step>/<item>` is, whether or not it exists.
    pub fn link_path(&self, step: &str, item: &Item) -> PathBuf {
        self.steps().join(relative_path(step, item))
    }

    /// Looks for an entry, without reading its output: reads `entry.json` and asks for the output's length.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] if there is one that is not whole.
    pub fn get<A: Artifact>(&self, key: Key) -> Result<Option<Stored<A>>, StoreError> {
        let dir = self.entry_dir(key);
        let record = dir.join(RECORD_FILE);
        let text = match fs::read(&record) {
            Ok(text) => text,
            // An entry's folder comes by one rename, so a folder without its record lost it later.
            Err(e) if e.kind() == io::ErrorKind::NotFound && !dir.exists() => return Ok(None),
            Err(e) => return Err(Damaged { key, what: format!("{}: {e}", record.display()) }.into()),
        };
        let path = dir.join(output_file::<A>());
        match whole::<A>(&text, &path) {
            Ok(OutputRecord { bytes, hash, .. }) => {
                Ok(Some(Stored { key, path, bytes, hash, of: PhantomData }))
            }
            Err(what) => Err(Damaged { key, what }.into()),
        }
    }

    /// Takes an entry away, so that it is made again. It is not an error if it is gone already.
    ///
    /// # Errors
    /// [`StoreError::Io`].
    pub fn discard(&self, key: Key) -> Result<(), StoreError> {
        let aside = self.unused_tmp_name();
        let dir = self.entry_dir(key);
        match fs::rename(&dir, &aside) {
            Ok(()) => fs::remove_dir_all(&aside).map_err(StoreError::io("remove", &aside)),
            Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(()),
            Err(e) => Err(StoreError::io("remove", &dir)(e)),
        }
    }

    /// Brings one item of a step to its output: finds the entry of its key, or else loads the inputs, runs the stage and
    /// writes the entry. Afterwards `steps/<step>/<item>` leads to it.
    ///
    /// `load` is called only if the stage must run, and what it gives must be what `inputs` promised.
    ///
    /// # Errors
    /// See [`ExecuteError`]. No error leaves a half entry, nor touches that of an earlier run.
    pub fn execute<S: Stage, E>(
        &self,
        step: &str,
        item: &Item,
        params: &ParamsText,
        inputs: &<S::Inputs as Inputs>::Hashes,
        load: impl FnOnce() -> Result<S::Inputs, E>,
        context: &Context,
    ) -> Result<Outcome<S::Output>, ExecuteError<S::Error, E>> {
        let parts = KeyParts::of::<S>(params, inputs);
        let key = parts.key();
        let how = match self.get::<S::Output>(key) {
            Ok(Some(found)) => {
                if !self.link(step, item, key)? {
                    return Ok(Outcome { how: How::Cached, output: found });
                }
                // The link is new: until now `clean` could have taken the entry, so look again.
                match self.get::<S::Output>(key)? {
                    Some(output) => return Ok(Outcome { how: How::Cached, output }),
                    None => How::Ran,
                }
            }
            Ok(None) => How::Ran,
            Err(StoreError::Damaged(damage)) => How::Remade(damage),
            Err(e) => return Err(e.into()),
        };
        if context.cancelled() {
            return Err(ExecuteError::Cancelled);
        }
        let params: S::Params = params.read()?;
        let loaded = load().map_err(ExecuteError::Load)?;
        if let Some(role) = first_difference(&parts.inputs, &loaded.parts()) {
            return Err(ExecuteError::InputChanged { role });
        }
        let result = S::run(&loaded, &params, context);
        if context.cancelled() {
            return Err(ExecuteError::Cancelled);
        }
        let value = result.map_err(ExecuteError::Stage)?;
        let output = self.put(step, item, &parts, &value)?;
        Ok(Outcome { how, output })
    }

    /// Writes an entry beside and renames it into place.
    fn put<A: Artifact>(
        &self,
        step: &str,
        item: &Item,
        parts: &KeyParts,
        value: &A,
    ) -> Result<Stored<A>, StoreError> {
        let key = parts.key();
        let bytes = value.encode();
        let hash = hash_of_file::<A>(&bytes);
        // What follows will read the stored form, so it is the stored form that must be sound.
        let read = A::decode(&bytes).map_err(StoreError::DoesNotReadBack)?;
        if read.content_hash() != hash {
            return Err(StoreError::HashOfAnotherFile { kind: A::KIND });
        }
        let output = OutputRecord {
            kind: A::KIND.to_owned(),
            schema: A::SCHEMA,
            file: output_file::<A>(),
            bytes: bytes.len() as u64,
            hash,
        };
        let record = record_text(&Record::new(parts, output));

        let new = self.unused_tmp_name();
        fs::create_dir(&new).map_err(StoreError::io("make the folder", &new))?;
        let written = self.write_and_publish::<A>(&new, &bytes, &record, step, item, key);
        if new.exists() {
            // Not published: another run was first, or something failed, which is what the caller should hear of.
            let _ = fs::remove_dir_all(&new);
        }
        written?;
        let found = self.get::<A>(key)?;
        found.ok_or_else(|| Damaged { key, what: "it vanished as soon as it was written".to_owned() }.into())
    }

    fn write_and_publish<A: Artifact>(
        &self,
        new: &Path,
        bytes: &[u8],
        record: &[u8],
        step: &str,
        item: &Item,
        key: Key,
    ) -> Result<(), StoreError> {
        for (name, bytes) in [(output_file::<A>().as_str(), bytes), (RECORD_FILE, record)] {
            let path = new.join(name);
            fs::write(&path, bytes).map_err(StoreError::io("write", &path))?;
        }
        // The link comes first: `clean` lists entries before links, so it takes no entry whose link is on its way.
        self.link(step, item, key)?;
        let place = self.entry_dir(key);
        let parent = place.parent().unwrap_or(&self.dir);
        fs::create_dir_all(parent).map_err(StoreError::io("make the folder", parent))?;
        if fs::rename(new, &place).is_ok() {
            return Ok(());
        }
        match self.get::<A>(key) {
            // Another run made the same entry meanwhile: theirs stays, as others may have it open.
            Ok(Some(_)) => return Ok(()),
            Ok(None) => {}
            Err(StoreError::Damaged(_)) => self.discard(key)?,
            Err(e) => return Err(e),
        }
        match fs::rename(new, &place) {
            Ok(()) => Ok(()),
            Err(_) if matches!(self.get::<A>(key), Ok(Some(_))) => Ok(()),
            Err(e) => Err(StoreError::io("write", &place)(e)),
        }
    }

    /// Makes `steps/<step>/<item>` lead to the entry; false if it does already.
    fn link(&self, step: &str, item: &Item, key: Key) -> Result<bool, StoreError> {
        let path = self.link_path(step, item);
        let target = Path::new(&"../".repeat(item.parts().len() + 1)).join(entry_path(key));
        if link::read(&path).is_some_and(|t| t == target) {
            return Ok(false);
        }
        let new = self.unused_tmp_name();
        link::write(&target, &new).map_err(StoreError::io("write", &new))?;
        let clash = |path: &Path| StoreError::ItemClash {
            step: step.to_owned(),
            item: item.clone(),
            path: path.to_path_buf(),
        };
        let parent = path.parent().unwrap_or(&self.dir);
        // A link that leads to a folder is not one itself.
        let is_folder = |p: &Path| p.symlink_metadata().is_ok_and(|about| about.is_dir());
        let in_the_way = || {
            let mut above = path.ancestors().skip(1).take(item.parts().len());
            above.find(|p| link::read(p).is_some()).or_else(|| is_folder(&path).then_some(&path))
        };
        let placed = match in_the_way() {
            Some(other) => Err(clash(other)),
            None => fs::create_dir_all(parent)
                .map_err(StoreError::io("make the folder", parent))
                .and_then(|()| fs::rename(&new, &path).map_err(StoreError::io("write", &path))),
        };
        if placed.is_err() {
            // The caller hears of the first error.
            let _ = fs::remove_file(&new);
        }
        placed.map(|()| true)
    }

    /// The key that `steps/<step>/<item>` leads to.
    pub(crate) fn linked(&self, link: &Path) -> Option<Key> {
        Key::from_hex(link::read(link)?.file_name()?.to_str()?)
    }

    pub(crate) fn record(&self, key: Key) -> Result<Record, String> {
        let path = self.entry_dir(key).join(RECORD_FILE);
        let text = fs::read(&path).map_err(|e| e.to_string())?;
        serde_json::from_slice(&text).map_err(|e| e.to_string())
    }

    fn unused_tmp_name(&self) -> PathBuf {
        // A new RandomState has new keys, so an empty hash under it is a random number.
        let random = || RandomState::new().build_hasher().finish();
        self.tmp().join(format!("{}-{:016x}{:016x}", std::process::id(), random(), random()))
    }

    pub(crate) fn remove_left_overs(&self) -> Result<(), StoreError> {
        let tmp = self.tmp();
        let now = SystemTime::now();
        for entry in fs::read_dir(&tmp).map_err(StoreError::io("list", &tmp))?.flatten() {
            let Ok(about) = entry.metadata() else { continue };
            let age = about.modified().ok().and_then(|t| now.duration_since(t).ok()).unwrap_or_default();
            if age >= LEFT_OVER_AFTER {
                // Another run may be removing the same ones; what stays now goes another time.
                let _ = if about.is_dir() {
                    fs::remove_dir_all(entry.path())
                } else {
                    fs::remove_file(entry.path())
                };
            }
        }
        Ok(())
    }
}

/// From the store's folder.
fn entry_path(key: Key) -> PathBuf {
    let hex = key.to_hex();
    Path::new("entries").join(&hex[..2]).join(hex)
}

fn output_file<A: Artifact>() -> String {
    format!("output.{}", A::EXTENSION)
}

fn record_text(record: &Record) -> Vec<u8> {
    // Texts, whole numbers and JSON values always have a JSON form.
    let mut text = serde_json::to_vec_pretty(record).unwrap_or_default();
    text.push(b'\n');
    text
}

/// Whether an entry is whole, as far as its record and its output's length tell.
fn whole<A: Artifact>(record: &[u8], output: &Path) -> Result<OutputRecord, String> {
    let RecordHead { format, output: stated } =
        serde_json::from_slice(record).map_err(|e| format!("{RECORD_FILE}: {e}"))?;
    let OutputRecord { kind, schema, file, bytes, hash: _ } = &stated;
    if format != FORMAT || kind != A::KIND || *schema != A::SCHEMA || *file != output_file::<A>() {
        return Err(format!(
            "{RECORD_FILE} is of format {format} and has a {kind} (schema {schema}) in {file}"
        ));
    }
    match fs::metadata(output) {
        Ok(about) if about.len() == *bytes => Ok(stated),
        Ok(about) => Err(format!("{file} has {} bytes, {bytes} were written", about.len())),
        Err(e) => Err(format!("{file}: {e}")),
    }
}

/// The first input that is not the same, as `curves[1]`.
pub(crate) fn first_difference(promised: &[InputPart], loaded: &[InputPart]) -> Option<String> {
    crate::explain::input_differences(promised, loaded).into_iter().next().map(|difference| difference.role())
}

/// `steps/<step>/<item>`: a relative symbolic link where the system has them, else a file that holds the path.
pub(crate) mod link {
    use std::io;
    use std::path::{Path, PathBuf};

    #[cfg(unix)]
    pub(crate) fn write(target: &Path, path: &Path) -> io::Result<()> {
        std::os::unix::fs::symlink(target, path)
    }

    #[cfg(unix)]
    pub(crate) fn read(path: &Path) -> Option<PathBuf> {
        std::fs::read_link(path).ok()
    }

    #[cfg(not(unix))]
    pub(crate) fn write(target: &Path, path: &Path) -> io::Result<()> {
        std::fs::write(path, target.to_string_lossy().replace('\\', "/") + "\n")
    }

    #[cfg(not(unix))]
    pub(crate) fn read(path: &Path) -> Option<PathBuf> {
        std::fs::read_to_string(path).ok().map(|text| PathBuf::from(text.trim_end()))
    }
}
