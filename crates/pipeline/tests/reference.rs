//! The schema and the reference in `docs/` are what the program's types say. `BIPLANE_REGENERATE=1` rewrites them.

#![allow(clippy::unwrap_used)]

use std::path::Path;

fn same(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name);
    if std::env::var_os("BIPLANE_REGENERATE").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(
        kept == text,
        "docs/{name} is not what the types say: BIPLANE_REGENERATE=1 cargo test -p biplane"
    );
}

#[test]
fn the_schema_is_that_of_the_types() {
    same("pipeline.schema.json", &biplane::reference::schema());
}

#[test]
fn the_reference_is_that_of_the_types() {
    same("pipeline-reference.md", &biplane::reference::reference());
}
