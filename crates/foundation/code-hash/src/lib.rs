//! The hash of the code that a stage is built from, computed by the build script of the stage's crate.
//!
//! A stage crate has this `build.rs`, and reads the result as `env!("BIPLANE_CODE_HASH")`:
//!
//! ```no_run
//! biplane_code_hash::emit();
//! ```
//!
//! The hash is over the bytes of
//! - `Cargo.toml`, the build script and every file under `src/` of the crate itself,
//! - the same of every crate below it that is given by a path, directly or through `[workspace.dependencies]`,
//! - `Cargo.toml` and `Cargo.lock` of the workspace: versions, features and profiles.
//!
//! Files are named in it by package and path within the package, in sorted order, so neither the place of the checkout
//! nor the file system's order matters. Dev-dependencies, `tests/`, `benches/` and `examples/` do not count. Every
//! dependency that is declared counts, also an optional one that is switched off or one for another target.
//!
//! What it does not see: the compiler's version, the features and flags that were chosen on the command line, and files
//! outside `src/` that the code includes.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

/// Prints what cargo must know: the variable `BIPLANE_CODE_HASH` (64 hexadecimal digits), and the files to watch.
///
/// Only for build scripts. What goes wrong is printed as `cargo::error`, which ends the build with that message.
pub fn emit() {
    let found = std::env::var_os("CARGO_MANIFEST_DIR")
        .ok_or_else(|| CodeHashError {
            path: PathBuf::from("build.rs"),
            what: "CARGO_MANIFEST_DIR is not set: call this from a build script".to_owned(),
        })
        .and_then(|dir| CodeHash::of(Path::new(&dir)));
    match found {
        Ok(code) => {
            println!("cargo::rustc-env=BIPLANE_CODE_HASH={}", code.hex);
            for path in code.watched {
                println!("cargo::rerun-if-changed={}", path.display());
            }
        }
        Err(error) => println!("cargo::error={error}"),
    }
}

/// A file that the hash needs cannot be read or understood.
#[derive(Debug)]
pub struct CodeHashError {
    /// The file or folder.
    pub path: PathBuf,
    /// What is wrong with it.
    pub what: String,
}

impl fmt::Display for CodeHashError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Cargo takes one line a message.
        write!(
            f,
            "hash of the stage's code: {}: {}",
            self.path.display(),
            self.what.trim().replace('\n', " ")
        )
    }
}

impl std::error::Error for CodeHashError {}

/// The hash of a crate's code, and where that code lies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CodeHash {
    /// 64 hexadecimal digits.
    pub hex: String,
    /// Every file and folder which, if changed, may change the hash.
    pub watched: BTreeSet<PathBuf>,
}

impl CodeHash {
    /// Of the crate whose `Cargo.toml` lies in `crate_dir`, somewhere below its workspace's folder (or alone).
    ///
    /// # Errors
    /// A `Cargo.toml` or source file cannot be read, or a dependency's path leads nowhere.
    pub fn of(crate_dir: &Path) -> Result<Self, CodeHashError> {
        let root = workspace_root(crate_dir)?;
        let shared = shared_paths(&root)?;
        let mut code = Code { files: BTreeMap::new(), watched: BTreeSet::new() };
        for name in ["Cargo.toml", "Cargo.lock"] {
            let path = root.join(name);
            // Without a lock file cargo chooses versions anew and writes one: no file is a state of its own.
            if path.is_file() {
                code.add(format!("workspace {name}"), path)?;
            }
        }
        let mut seen = BTreeSet::new();
        let mut waiting = vec![crate_dir.to_path_buf()];
        while let Some(dir) = waiting.pop() {
            if seen.insert(resolved(&dir)?) {
                waiting.extend(code.add_crate(&dir, &shared)?);
            }
        }
        let mut hasher = blake3::Hasher::new();
        for (name, bytes) in &code.files {
            for part in [name.as_bytes(), bytes] {
                hasher.update(&(part.len() as u64).to_le_bytes());
                hasher.update(part);
            }
        }
        Ok(Self { hex: hasher.finalize().to_hex().to_string(), watched: code.watched })
    }
}

struct Code {
    files: BTreeMap<String, Vec<u8>>,
    watched: BTreeSet<PathBuf>,
}

impl Code {
    fn add(&mut self, name: String, path: PathBuf) -> Result<(), CodeHashError> {
        self.read(name, &path)?;
        self.watched.insert(path);
        Ok(())
    }

    fn read(&mut self, name: String, path: &Path) -> Result<(), CodeHashError> {
        self.files.insert(name, fs::read(path).map_err(|e| failed(path, e))?);
        Ok(())
    }

    /// Takes in one crate's files, and gives the folders of the path crates it depends on.
    fn add_crate(
        &mut self,
        dir: &Path,
        shared: &BTreeMap<String, PathBuf>,
    ) -> Result<Vec<PathBuf>, CodeHashError> {
        let manifest_path = dir.join("Cargo.toml");
        let manifest = read_manifest(&manifest_path)?;
        let package = manifest
            .get("package")
            .and_then(Value::as_table)
            .ok_or_else(|| failed(&manifest_path, "no [package] table"))?;
        let name = package
            .get("name")
            .and_then(Value::as_str)
            .ok_or_else(|| failed(&manifest_path, "[package] has no name"))?;
        self.add(format!("{name} Cargo.toml"), manifest_path)?;
        let script = package.get("build").and_then(Value::as_str).unwrap_or("build.rs");
        let script_path = dir.join(script);
        if script_path.is_file() {
            self.add(format!("{name} {script}"), script_path)?;
        }
        let source = dir.join("src");
        self.read_folder(&format!("{name} src"), &source)?;
        // Cargo watches everything below a folder.
        self.watched.insert(source);
        Ok(path_dependencies(&manifest).filter_map(|d| d.folder(dir, shared)).collect())
    }

    fn read_folder(&mut self, name: &str, dir: &Path) -> Result<(), CodeHashError> {
        for entry in fs::read_dir(dir).map_err(|e| failed(dir, e))? {
            let entry = entry.map_err(|e| failed(dir, e))?;
            let path = entry.path();
            let within = format!("{name}/{}", entry.file_name().to_string_lossy());
            let kind = entry.file_type().map_err(|e| failed(&path, e))?;
            if kind.is_dir() {
                self.read_folder(&within, &path)?;
            } else if path.is_file() {
                self.read(within, &path)?;
            }
        }
        Ok(())
    }
}

/// One line of a dependency table.
struct Dependency<'a> {
    name: &'a str,
    value: &'a Value,
}

impl Dependency<'_> {
    /// The folder of the crate, if it is given by a path.
    fn folder(&self, dir: &Path, shared: &BTreeMap<String, PathBuf>) -> Option<PathBuf> {
        let table = self.value.as_table()?;
        if table.get("workspace").and_then(Value::as_bool) == Some(true) {
            shared.get(self.name).cloned()
        } else {
            Some(dir.join(table.get("path")?.as_str()?))
        }
    }
}

/// All dependencies that take part in a build, of every target. Build scripts can write code, so theirs count.
fn path_dependencies(manifest: &Table) -> impl Iterator<Item = Dependency<'_>> {
    let targets = manifest.get("target").and_then(Value::as_table).into_iter().flatten();
    std::iter::once(manifest)
        .chain(targets.filter_map(|(_, t)| t.as_table()))
        .flat_map(|table| ["dependencies", "build-dependencies"].into_iter().filter_map(|n| table.get(n)))
        .filter_map(Value::as_table)
        .flatten()
        .map(|(name, value)| Dependency { name, value })
}

/// The nearest folder upward whose `Cargo.toml` has a `[workspace]` table; the crate's own if there is none.
fn workspace_root(crate_dir: &Path) -> Result<PathBuf, CodeHashError> {
    for dir in crate_dir.ancestors() {
        let path = dir.join("Cargo.toml");
        if path.is_file() && read_manifest(&path)?.contains_key("workspace") {
            return Ok(dir.to_path_buf());
        }
    }
    Ok(crate_dir.to_path_buf())
}

/// Folders of the crates that `[workspace.dependencies]` gives by a path.
fn shared_paths(root: &Path) -> Result<BTreeMap<String, PathBuf>, CodeHashError> {
    let manifest = read_manifest(&root.join("Cargo.toml"))?;
    let table = manifest.get("workspace").and_then(|w| w.get("dependencies")).and_then(Value::as_table);
    let path_of = |value: &Value| value.get("path").and_then(Value::as_str).map(|path| root.join(path));
    Ok(table
        .into_iter()
        .flatten()
        .filter_map(|(name, value)| path_of(value).map(|path| (name.clone(), path)))
        .collect())
}

fn read_manifest(path: &Path) -> Result<Table, CodeHashError> {
    let text = fs::read_to_string(path).map_err(|e| failed(path, e))?;
    text.parse().map_err(|e| failed(path, e))
}

fn resolved(dir: &Path) -> Result<PathBuf, CodeHashError> {
    fs::canonicalize(dir).map_err(|e| failed(dir, e))
}

fn failed(path: &Path, what: impl fmt::Display) -> CodeHashError {
    CodeHashError { path: path.to_path_buf(), what: what.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A workspace of four crates: `match` on `outline` (through the workspace) on `geometry` (by path), with `phantom`
    /// as a dev-dependency.
    struct Workspace(tempfile::TempDir);

    impl Workspace {
        fn new() -> Self {
            let w = Self(tempfile::tempdir().unwrap());
            w.write(
                "Cargo.toml",
                "[workspace]\nmembers = ['crates/*']\n[workspace.dependencies]\noutline = { path = 'crates/outline' }\n\
                 phantom = { path = 'crates/phantom' }\nserde = '1'\n",
            );
            w.write("Cargo.lock", "version = 4\n");
            w.crate_with(
                "match",
                "[dependencies]\nserde.workspace = true\n[target.'cfg(unix)'.dependencies]\noutline = { workspace = true }\n\
                 [dev-dependencies]\nphantom.workspace = true\n",
            );
            w.crate_with("outline", "[dependencies]\ngeometry = { path = '../geometry' }\n");
            w.crate_with("geometry", "");
            w.crate_with("phantom", "");
            w
        }

        fn crate_with(&self, name: &str, dependencies: &str) {
            self.write(
                &format!("crates/{name}/Cargo.toml"),
                &format!("[package]\nname = '{name}'\n{dependencies}"),
            );
            self.write(&format!("crates/{name}/src/lib.rs"), "mod deep;\n");
            self.write(&format!("crates/{name}/src/deep/mod.rs"), "// nothing\n");
            self.write(&format!("crates/{name}/tests/all.rs"), "// a test\n");
        }

        fn write(&self, path: &str, text: &str) {
            let path = self.0.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }

        fn hash(&self) -> String {
            CodeHash::of(&self.0.path().join("crates/match")).unwrap().hex
        }
    }

    #[test]
    fn the_same_code_in_another_folder_has_the_same_hash() {
        assert_eq!(Workspace::new().hash(), Workspace::new().hash());
    }

    #[test]
    fn every_file_that_is_built_counts() {
        for path in [
            "crates/match/src/lib.rs",
            "crates/match/src/deep/mod.rs",
            "crates/match/src/new.rs",
            "crates/match/build.rs",
            "crates/outline/src/deep/mod.rs",
            "crates/geometry/src/lib.rs",
            "Cargo.lock",
        ] {
            let w = Workspace::new();
            let before = w.hash();
            w.write(path, "// changed\n");
            assert_ne!(w.hash(), before, "{path}");
        }
        let w = Workspace::new();
        let before = w.hash();
        w.crate_with("geometry", "[features]\nfast = []\n");
        assert_ne!(w.hash(), before, "a manifest below");
    }

    #[test]
    fn line_endings_count_as_they_are() {
        let w = Workspace::new();
        let before = w.hash();
        w.write("crates/match/src/lib.rs", "mod deep;\r\n");
        assert_ne!(w.hash(), before);
    }

    #[test]
    fn tests_and_what_only_tests_use_do_not_count() {
        let w = Workspace::new();
        let before = w.hash();
        for path in ["crates/match/tests/all.rs", "crates/geometry/tests/new.rs", "crates/phantom/src/lib.rs"]
        {
            w.write(path, "// changed\n");
            assert_eq!(w.hash(), before, "{path}");
        }
    }

    #[test]
    fn a_file_moved_between_crates_or_renamed_changes_the_hash() {
        let w = Workspace::new();
        let before = w.hash();
        let root = w.0.path();
        fs::rename(root.join("crates/match/src/deep"), root.join("crates/match/src/shallow")).unwrap();
        assert_ne!(w.hash(), before);
    }

    #[test]
    fn crates_that_depend_on_each_other_end_and_a_missing_one_is_named() {
        let w = Workspace::new();
        w.crate_with("geometry", "[build-dependencies]\nmatch = { path = '../match' }\n");
        w.hash();
        w.crate_with("geometry", "[dependencies]\ngone = { path = '../gone' }\n");
        let error = CodeHash::of(&w.0.path().join("crates/match")).unwrap_err().to_string();
        assert!(error.contains("gone"), "{error}");
        w.crate_with("geometry", "[dependencies\n");
        let error = CodeHash::of(&w.0.path().join("crates/match")).unwrap_err().to_string();
        assert!(error.contains("geometry") && !error.contains('\n'), "{error}");
    }

    #[test]
    fn everything_hashed_is_watched() {
        let w = Workspace::new();
        let code = CodeHash::of(&w.0.path().join("crates/match")).unwrap();
        for path in ["Cargo.lock", "crates/match/src", "crates/outline/src", "geometry/Cargo.toml"] {
            assert!(code.watched.iter().any(|p| p.ends_with(path)), "{path} in {:?}", code.watched);
        }
        assert!(!code.watched.iter().any(|p| p.ends_with("phantom/src")));
    }

    #[test]
    fn this_workspace_is_understood() {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        let code = CodeHash::of(&here.join("../stage")).unwrap();
        for path in ["stage/src", "artifact/src", "geometry/src", "artifact/Cargo.toml", "Cargo.lock"] {
            assert!(code.watched.iter().any(|p| p.ends_with(path)), "{path} in {:?}", code.watched);
        }
        assert_ne!(code.hex, CodeHash::of(&here.join("../geometry")).unwrap().hex);
    }
}
