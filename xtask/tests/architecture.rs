//! The invariants of `docs/architecture.md` that the compiler does not hold: each test says what to do when it fails.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use biplane_artifact::Frame;
use biplane_segmentation::{Segment, SegmentInputs, SegmentParams};
use biplane_stage::{Context, Hashed, How, Item, ParamsText, Store};

/// Crates by layer, lowest first. A crate may depend on those of lower layers alone, so those of one layer do not know
/// each other.
const LAYERS: &[&[&str]] = &[
    &["biplane-geometry"],
    &["biplane-artifact"],
    &["biplane-stage"],
    &[
        "biplane-fluoroscope",
        "biplane-grey",
        "biplane-optimiser",
        "biplane-phantom",
        "biplane-spline",
        "biplane-trial",
    ],
    &["biplane-surface"],
    &["biplane-edge-bias", "biplane-edge-field", "biplane-outline"],
    &["biplane-objective", "biplane-silhouette"],
    &[
        "biplane-acquisition",
        "biplane-spots",
        "biplane-distortion",
        "biplane-environment",
        "biplane-segmentation",
        "biplane-slices",
        "biplane-lofting",
        "biplane-label-surface",
        "biplane-point-model",
        "biplane-axes",
        "biplane-kinematics",
        "biplane-trial",
        "biplane-contour",
        "biplane-optimisation",
    ],
    &["biplane"],
    &["biplane-validation"],
    &["xtask"],
];

/// A tool of build scripts: no crate has it as an ordinary dependency, and it knows none of the others.
const BUILD_TOOL: &str = "biplane-code-hash";

/// Folders of the crates that take values and give values.
const METHOD: [&str; 26] = [
    "crates/foundation/geometry",
    "crates/foundation/artifact",
    "crates/analysis/distortion",
    "crates/analysis/environment",
    "crates/analysis/grey",
    "crates/analysis/segmentation",
    "crates/analysis/slices",
    "crates/analysis/surface",
    "crates/analysis/lofting",
    "crates/analysis/label-surface",
    "crates/analysis/point-model",
    "crates/analysis/axes",
    "crates/analysis/kinematics",
    "crates/analysis/trial",
    "crates/analysis/spline",
    "crates/analysis/spots",
    "crates/matching/contour",
    "crates/matching/edge-bias",
    "crates/matching/edge-field",
    "crates/matching/fluoroscope",
    "crates/matching/objective",
    "crates/matching/optimiser",
    "crates/matching/outline",
    "crates/matching/optimisation",
    "crates/matching/silhouette",
    "crates/testing/phantom",
];

/// What a crate of a method must not contain: files, environment, clocks, threads, chance that no seed decides, and logs.
const FOREIGN_TO_A_METHOD: [&str; 19] = [
    "std::fs",
    "std::env",
    "std::time",
    "std::net",
    "std::process",
    "std::thread",
    "rayon",
    "std::io",
    "print!",
    "println!",
    "dbg!",
    "tracing",
    "Instant::",
    "SystemTime",
    "rand::rng",
    "thread_rng",
    "from_entropy",
    "from_os_rng",
    "RandomState",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// All files below a folder, without what a study's runs leave there.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for path in entries.map(|e| e.unwrap().path()) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !path.is_dir() {
            files.push(path);
        } else if ![".biplane", "results", "target", ".git", "node_modules"].contains(&name.as_str()) {
            files.extend(files_below(&path));
        }
    }
    files.sort();
    files
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// Every crate of the workspace: its folder and its manifest, by package name.
fn crates() -> BTreeMap<String, (PathBuf, toml::Table)> {
    let mut crates = BTreeMap::new();
    for folder in [root().join("crates"), root().join("xtask")] {
        for path in files_below(&folder).into_iter().filter(|p| p.ends_with("Cargo.toml")) {
            let manifest: toml::Table = read(&path).parse().unwrap();
            let name = manifest["package"]["name"].as_str().unwrap().to_owned();
            crates.insert(name, (path.parent().unwrap().to_owned(), manifest));
        }
    }
    crates
}

fn dependencies(manifest: &toml::Table, table: &str) -> BTreeSet<String> {
    let table = manifest.get(table).and_then(toml::Value::as_table);
    table.into_iter().flatten().map(|(name, _)| name.clone()).collect()
}

fn is_internal(name: &str) -> bool {
    name == "biplane" || name == "xtask" || name.starts_with("biplane-")
}

#[test]
fn every_crate_has_its_layer() {
    let names: BTreeSet<String> = crates().into_keys().collect();
    let listed: BTreeSet<String> =
        LAYERS.iter().flat_map(|l| l.iter()).chain([&BUILD_TOOL]).map(ToString::to_string).collect();
    assert_eq!(names, listed, "keep LAYERS in xtask/tests/architecture.rs and docs/architecture.md true");
}

#[test]
fn dependencies_point_one_way() {
    let layer = |name: &str| LAYERS.iter().position(|l| l.contains(&name));
    for (name, (_, manifest)) in crates() {
        let build = dependencies(&manifest, "build-dependencies");
        assert!(
            build.iter().filter(|d| is_internal(d)).all(|d| d == BUILD_TOOL),
            "{name} has the build-dependencies {build:?}: of this workspace a build script may use {BUILD_TOOL} alone"
        );
        for table in ["dependencies", "dev-dependencies"] {
            for on in dependencies(&manifest, table).into_iter().filter(|d| is_internal(d)) {
                assert_ne!(name, BUILD_TOOL, "{BUILD_TOOL} depends on {on}: it must know no other crate");
                let own = layer(&name).unwrap_or_else(|| {
                    panic!("{name} is in no layer: add it to LAYERS in xtask/tests/architecture.rs")
                });
                let other =
                    layer(&on).unwrap_or_else(|| panic!("{name} depends on {on}, which is in no layer"));
                assert!(
                    other < own,
                    "{name} depends on {on}, which is not in a layer below it: move what both need into a named \
                     library of a lower layer, or do it in the crate `biplane`"
                );
            }
        }
    }
}

#[test]
fn the_phantom_knows_nothing_of_what_it_measures() {
    let (_, manifest) = &crates()["biplane-phantom"];
    for table in ["dependencies", "dev-dependencies"] {
        let own: Vec<String> = dependencies(manifest, table).into_iter().filter(|d| is_internal(d)).collect();
        assert!(
            own.iter().all(|d| d == "biplane-geometry" || d == "biplane-artifact"),
            "phantom has {own:?} in [{table}]: truth that uses the code it measures hides that code's faults"
        );
    }
}

#[test]
fn geometry_has_no_serde() {
    let (_, manifest) = &crates()["biplane-geometry"];
    for table in ["dependencies", "dev-dependencies"] {
        let found: Vec<String> = dependencies(manifest, table)
            .into_iter()
            .filter(|d| d.starts_with("serde") || d == "schemars")
            .collect();
        assert!(
            found.is_empty(),
            "geometry has {found:?} in [{table}]: what is stored is a type of `artifact`"
        );
    }
    let workspace: toml::Table = read(&root().join("Cargo.toml")).parse().unwrap();
    let features =
        workspace["workspace"]["dependencies"]["nalgebra"].get("features").map(ToString::to_string);
    assert!(
        !features.unwrap_or_default().contains("serde"),
        "nalgebra has a serde feature in the root Cargo.toml: store a record of numbers instead, as `PoseRecord` does"
    );
}

/// The code lines of a file with their numbers, without comments and without the tests at its end.
fn code_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .take_while(|l| l.trim() != "#[cfg(test)]")
        .enumerate()
        .map(|(i, l)| (i + 1, l.find("//").map_or(l, |at| &l[..at])))
}

#[test]
fn methods_take_values_and_give_values() {
    let mut faults = Vec::new();
    for folder in METHOD {
        for path in files_below(&root().join(folder).join("src")) {
            for (number, line) in code_lines(&read(&path)) {
                let found = FOREIGN_TO_A_METHOD.iter().filter(|word| line.contains(*word));
                faults.extend(found.map(|word| format!("{}:{number}: {word}", relative(&path))));
            }
        }
    }
    assert!(
        faults.is_empty(),
        "a method reads no file, environment or clock, and logs nothing; take the value as an argument, or do it in \
         `acquisition`, `stage` or `biplane`:\n{}",
        faults.join("\n")
    );
}

#[test]
fn equal_frames_are_segmented_once() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(&folder.path().join(".biplane")).unwrap();
    let params = ParamsText::of(&SegmentParams::default()).unwrap();
    let frame = |level: u16| {
        let samples = (0..64 * 64).map(|i| if i % 64 < 32 { level } else { 200 }).collect();
        Hashed::new(Frame { width: 64, height: 64, samples, bits: 8 })
    };
    let how = |item: &str, frame: Hashed<Frame>| {
        let promised = SegmentInputs { frame: frame.promise(), mask: Vec::new() };
        let load =
            || Ok::<_, std::convert::Infallible>(SegmentInputs { frame: frame.clone(), mask: Vec::new() });
        let context = Context::new();
        store
            .execute::<Segment, _>("segment", &Item::from(item), &params, &promised, load, &context)
            .unwrap()
            .how
    };
    assert_eq!(how("walk/0000/A", frame(50)), How::Ran);
    assert_eq!(
        how("walk/0001/A", frame(50)),
        How::Cached,
        "a name went into the key: what a thing is called decides nothing"
    );
    assert_eq!(how("walk/0001/A", frame(51)), How::Ran, "another picture has the same key");
}

#[test]
fn no_module_is_a_drawer() {
    const DRAWERS: [&str; 9] =
        ["util", "utils", "utilities", "common", "helper", "helpers", "misc", "shared", "stuff"];
    let mut faults = Vec::new();
    for folder in ["crates", "xtask"] {
        for path in files_below(&root().join(folder)) {
            let name = relative(&path);
            let parts = name.split('/').map(|p| p.split('.').next().unwrap_or(p));
            faults.extend(parts.filter(|p| DRAWERS.contains(p)).map(|p| format!("{name}: {p}")));
            if path.extension().is_some_and(|e| e == "rs") {
                for (number, line) in read(&path).lines().enumerate() {
                    let module = line.trim().trim_start_matches("pub ").strip_prefix("mod ");
                    let module = module.map(|m| m.trim_end_matches([';', '{', ' ', '}']));
                    if module.is_some_and(|m| DRAWERS.contains(&m)) {
                        faults.push(format!("{name}:{}: {}", number + 1, line.trim()));
                    }
                }
            }
        }
    }
    assert!(
        faults.is_empty(),
        "name a module after the noun or the step that it holds:\n{}",
        faults.join("\n")
    );
}

#[test]
fn every_source_file_says_what_it_is() {
    let mut faults = Vec::new();
    for (folder, _) in crates().values() {
        for path in files_below(&folder.join("src")) {
            if path.extension().is_some_and(|e| e == "rs") && !read(&path).starts_with("//!") {
                faults.push(relative(&path));
            }
        }
    }
    assert!(
        faults.is_empty(),
        "open these files with a `//!` comment: what it does, where the equation or format is from, what it guarantees \
         and what not:\n{}",
        faults.join("\n")
    );
}

/// Tracked files, from git; `None`, with a message, where this is not a git checkout.
fn tracked() -> Option<Vec<PathBuf>> {
    let output = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output();
    let Some(output) = output.ok().filter(|o| o.status.success()) else {
        println!("no git checkout, so what is tracked is not known");
        return None;
    };
    let names = String::from_utf8(output.stdout).unwrap();
    // A tracked file may be deleted in the working tree.
    Some(names.split_terminator('\0').map(|n| root().join(n)).filter(|p| p.is_file()).collect())
}

/// Whether an absolute path into a person's or a workplace's folder starts in a line.
fn names_a_home(line: &str) -> bool {
    // Put together here, so that this file does not hold them.
    ["work", "home", "root", "Users"].map(|folder| format!("/{folder}/")).iter().any(|home| {
        // Not a link's path, nor a folder within a relative one.
        let inside = |c: char| c.is_alphanumeric() || "._-/*}".contains(c);
        line.match_indices(home.as_str()).any(|(at, _)| !line[..at].ends_with(inside))
    })
}

#[test]
fn nothing_names_the_machine_it_was_made_on() {
    let slash = '/';
    assert!(
        names_a_home(&format!("at {slash}home{slash}me/x"))
            && !names_a_home("see a.org/home/me and ../home/x")
    );
    let registries =
        [["replace", "with"].join("-"), ["sparse", "http"].join("+"), ["[regist", "ries"].concat()];
    let public = "registry+https://github.com/rust-lang/crates.io-index";
    let mut faults = Vec::new();
    for path in tracked().into_iter().flatten() {
        // What is not text (pictures, meshes) has no lines.
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        for (number, line) in text.lines().enumerate() {
            let registry = registries.iter().any(|r| line.contains(r.as_str()))
                || (path.ends_with("Cargo.lock") && line.starts_with("source = ") && !line.contains(public));
            if names_a_home(line) || registry {
                faults.push(format!("{}:{}: {}", relative(&path), number + 1, line.trim()));
            }
        }
    }
    assert!(
        faults.is_empty(),
        "use paths relative to the repository, and name no registry of one place:\n{}",
        faults.join("\n")
    );
}

#[test]
fn fixtures_are_under_40_mb() {
    let fixtures = root().join("fixtures");
    let files = tracked().map_or_else(
        || files_below(&fixtures),
        |all| all.into_iter().filter(|p| p.starts_with(&fixtures)).collect(),
    );
    assert!(!files.is_empty(), "nothing is tracked below {}", fixtures.display());
    let mut sizes: Vec<(u64, String)> =
        files.iter().map(|p| (std::fs::metadata(p).unwrap().len(), relative(p))).collect();
    sizes.sort();
    let total: u64 = sizes.iter().map(|s| s.0).sum();
    assert!(
        total < 40_000_000,
        "fixtures/ has {total} bytes, at most 40 MB are kept: generate what can be generated. The largest are {:?}",
        sizes.iter().rev().take(5).collect::<Vec<_>>()
    );
}

/// The pages that are checked against the sources.
fn pages() -> Vec<PathBuf> {
    let docs =
        files_below(&root().join("docs")).into_iter().filter(|p| p.extension().is_some_and(|e| e == "md"));
    docs.chain([root().join("README.md"), root().join("fixtures/README.md")])
        .filter(|p| p.is_file())
        .collect()
}

/// Whether `crate::module::test` is a test: the crate by its folder's name, the module by the path of its file in `src/`
/// or `tests/` (nothing for `lib.rs`).
fn is_test(name: &str, crates: &BTreeMap<String, (PathBuf, toml::Table)>) -> bool {
    let parts: Vec<&str> = name.split("::").collect();
    let [first, module @ .., function] = &parts[..] else { return false };
    let Some((folder, _)) = crates.values().find(|(f, _)| f.file_name().is_some_and(|n| n == *first)) else {
        return false;
    };
    let stem = if module.is_empty() { "lib".to_owned() } else { module.join("/") };
    let files = ["src", "tests"].map(|place| folder.join(place).join(format!("{stem}.rs")));
    files.iter().filter_map(|p| std::fs::read_to_string(p).ok()).any(|text| {
        text.split("#[test]").skip(1).any(|after| {
            let signature = after.split('{').next().unwrap_or_default();
            signature.contains(&format!("fn {function}("))
        })
    })
}

/// What a page has in backticks and looks like the path of a test throughout: lower case, with `::`.
fn tests_named(text: &str) -> BTreeSet<String> {
    let of_path = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "_-:".contains(c);
    let quoted = text.split('`').skip(1).step_by(2);
    quoted.filter(|t| t.contains("::") && t.chars().all(of_path)).map(str::to_owned).collect()
}

#[test]
fn tests_named_in_the_pages_exist() {
    let crates = crates();
    assert!(is_test("xtask::architecture::every_crate_has_its_layer", &crates));
    assert!(
        !is_test("xtask::architecture::tests_named", &crates),
        "a function that is no test counts as one"
    );
    for path in pages() {
        let missing: Vec<String> =
            tests_named(&read(&path)).into_iter().filter(|t| !is_test(t, &crates)).collect();
        assert!(
            missing.is_empty(),
            "{} names tests that are not there; write crate::module::test with the crate's folder and the path of the \
             file in src/ or tests/, or follow the test that was renamed:\n{}",
            relative(&path),
            missing.join("\n")
        );
    }
}

#[test]
fn every_convention_and_invariant_names_its_test() {
    let crates = crates();
    let holds = |text: &str| tests_named(text).iter().any(|t| is_test(t, &crates));
    let conventions = read(&root().join("docs/conventions.md"));
    let sections: Vec<&str> = conventions.split("\n## ").skip(1).collect();
    assert!(sections.len() >= 8, "docs/conventions.md has {} sections", sections.len());
    for section in sections.iter().filter(|s| !s.starts_with("Not here")) {
        let title = section.lines().next().unwrap_or_default();
        assert!(
            holds(section),
            "docs/conventions.md, section \"{title}\" names no test: write one and name it"
        );
    }
    let architecture = read(&root().join("docs/architecture.md"));
    let invariants = architecture.split("\n## ").find(|s| s.starts_with("Invariants")).unwrap_or_default();
    let bold: Vec<&str> = invariants.split("\n- ").filter(|b| b.starts_with("**")).collect();
    assert!(bold.len() >= 8, "docs/architecture.md has {} invariants in bold", bold.len());
    for invariant in bold {
        let title = invariant.lines().next().unwrap_or_default();
        assert!(holds(invariant), "docs/architecture.md: `{title}` names no test: write one and name it");
    }
}

#[test]
fn links_of_the_pages_lead_somewhere() {
    let mut faults = Vec::new();
    for path in pages() {
        let text = read(&path);
        for after in text.split("](").skip(1) {
            let target = after.split([')', ' ', '#']).next().unwrap_or_default();
            let elsewhere = target.contains("://") || target.starts_with("mailto:") || target.is_empty();
            if !elsewhere && !path.parent().unwrap().join(target).exists() {
                faults.push(format!("{}: {target}", relative(&path)));
            }
        }
    }
    assert!(faults.is_empty(), "correct these links, or add what they lead to:\n{}", faults.join("\n"));
}

/// Licence expressions as crates write them: `(MIT OR Apache-2.0) AND Unicode-3.0`, or the older `MIT/Apache-2.0`.
struct Licences<'a> {
    words: Vec<&'a str>,
    next: usize,
    allowed: &'a BTreeSet<String>,
}

impl Licences<'_> {
    /// Whether the allowed licences suffice for an expression.
    fn suffice(expression: &str, allowed: &BTreeSet<String>) -> bool {
        let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
        let mut licences = Licences { words: spaced.split_whitespace().collect(), next: 0, allowed };
        licences.any() && licences.next == licences.words.len()
    }

    fn take(&mut self, word: &str) -> bool {
        let found = self.words.get(self.next) == Some(&word);
        self.next += usize::from(found);
        found
    }

    fn any(&mut self) -> bool {
        let mut result = self.all();
        while self.take("OR") {
            result |= self.all();
        }
        result
    }

    fn all(&mut self) -> bool {
        let mut result = self.one();
        while self.take("AND") {
            result &= self.one();
        }
        result
    }

    fn one(&mut self) -> bool {
        if self.take("(") {
            return self.any() && self.take(")");
        }
        let mut licence = self.words.get(self.next).copied().unwrap_or_default().to_owned();
        self.next += 1;
        if self.take("WITH") {
            licence = format!("{licence} WITH {}", self.words.get(self.next).copied().unwrap_or_default());
            self.next += 1;
        }
        self.allowed.contains(&licence)
    }
}

#[test]
fn licences_of_dependencies_are_allowed() {
    let deny: toml::Table = read(&root().join("deny.toml")).parse().unwrap();
    let allowed: BTreeSet<String> = deny["licenses"]["allow"]
        .as_array()
        .unwrap()
        .iter()
        .map(|l| l.as_str().unwrap().to_owned())
        .collect();
    for (expression, expected) in [
        ("(MIT OR GPL-3.0) AND Apache-2.0", true),
        ("MIT AND GPL-3.0", false),
        ("GPL-3.0/MIT", true),
        ("", false),
    ] {
        assert_eq!(Licences::suffice(expression, &allowed), expected, "{expression}");
    }
    // What other systems would need may not have been downloaded here.
    let version = Command::new("rustc").arg("-vV").output().unwrap();
    let version = String::from_utf8(version.stdout).unwrap();
    let host = version.lines().find_map(|l| l.strip_prefix("host: ")).unwrap();
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--offline", "--locked", "--filter-platform", host])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > LAYERS.len());
    let faults: Vec<String> = packages
        .iter()
        .filter(|p| !Licences::suffice(p["license"].as_str().unwrap_or_default(), &allowed))
        .map(|p| format!("{} {}: {}", p["name"], p["version"], p["license"]))
        .collect();
    assert!(
        faults.is_empty(),
        "licences that deny.toml does not allow: choose another crate, or allow the licence there and say why:\n{}",
        faults.join("\n")
    );
}

#[test]
fn versions_are_named_in_the_workspace_alone() {
    let workspace: toml::Table = read(&root().join("Cargo.toml")).parse().unwrap();
    for (name, dependency) in workspace["workspace"]["dependencies"].as_table().unwrap() {
        let version = dependency.as_str().or_else(|| dependency.get("version").and_then(toml::Value::as_str));
        let fits =
            if is_internal(name) { version.is_none() } else { version.is_some_and(|v| !v.contains('*')) };
        assert!(
            fits,
            "{name} has the version {version:?} in Cargo.toml: name one without `*`; crates here have a path"
        );
    }
    for (krate, (_, manifest)) in crates() {
        for table in ["dependencies", "dev-dependencies", "build-dependencies"] {
            for (name, dependency) in
                manifest.get(table).and_then(toml::Value::as_table).into_iter().flatten()
            {
                assert!(
                    dependency.get("workspace").and_then(toml::Value::as_bool) == Some(true),
                    "{krate}: {name} in [{table}] must be `{name}.workspace = true`, its version in the root Cargo.toml"
                );
            }
        }
    }
}
