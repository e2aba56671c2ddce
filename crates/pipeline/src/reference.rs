//! The JSON Schema of `pipeline.toml` for editors, and the reference of its keys for people, both from the types of
//! [`crate::config`]: key, type, default and meaning are written down once.

use std::fmt::Write;

use serde_json::{Map, Value};

use crate::config::PipelineFile;

/// The tables in the order of a pipeline file: a schema has none.
const ORDER: [&str; 20] = [
    "study",
    "fluoroscope",
    "plate",
    "beads",
    "body",
    "trial",
    "slices",
    "joint",
    "spots",
    "distortion",
    "environment",
    "segment",
    "edit",
    "match",
    "track",
    "smooth",
    "contour",
    "doctor",
    "output",
    "export",
];

/// The JSON Schema, indented, with a newline at its end.
pub fn schema() -> String {
    let mut text = serde_json::to_string_pretty(&root()).unwrap_or_default();
    text.push('\n');
    text
}

/// Every table and key in Markdown.
pub fn reference() -> String {
    let root = root();
    let mut out = String::from(
        "# pipeline.toml\n\nGenerated from the program's types: `BIPLANE_REGENERATE=1 cargo test -p biplane` rewrites this \
         file and\n`pipeline.schema.json`, which editors can check and complete a pipeline file with. A key that is not \
         listed here is an\nerror.\n",
    );
    let _ = write!(out, "\n{}\n", description(&root));
    let mut tables: Vec<_> = properties(&root).collect();
    tables.sort_by_key(|(name, _)| ORDER.iter().position(|o| o == name));
    for (name, property) in tables {
        let (heading, table) = section(&root, name, property);
        let _ = write!(out, "\n## `{heading}`\n\n{}\n", description(property));
        rows(&root, table, "", &mut out);
    }
    out
}

/// The first sentence that the reference says of a key, wherever it is.
pub fn meaning(key: &str) -> Option<String> {
    let root = root();
    properties(&root)
        .chain(properties(&root).flat_map(|(name, p)| properties(section(&root, name, p).1)))
        .find(|(name, _)| *name == key)
        .map(|(_, p)| description(p))
        .filter(|text| !text.is_empty())
}

fn root() -> Value {
    schemars::schema_for!(PipelineFile).to_value()
}

fn properties(schema: &Value) -> impl Iterator<Item = (&str, &Value)> {
    static NONE: std::sync::LazyLock<Map<String, Value>> = std::sync::LazyLock::new(Map::new);
    let map = schema.get("properties").and_then(Value::as_object).unwrap_or(&NONE);
    map.iter().map(|(k, v)| (k.as_str(), v))
}

/// The heading of a top-level key in TOML, and the schema of its table.
fn section<'a>(root: &'a Value, name: &str, property: &'a Value) -> (String, &'a Value) {
    if let Some(items) = property.get("items") {
        (format!("[[{name}]]"), resolve(root, items))
    } else if let Some(entries) = property.get("additionalProperties").filter(|p| p.is_object()) {
        (format!("[{name}.NAME]"), resolve(root, entries))
    } else {
        (format!("[{name}]"), resolve(root, property))
    }
}

/// Follows `$ref`, through the `allOf` or `anyOf` that carries a description or `null` beside it.
fn resolve<'a>(root: &'a Value, schema: &'a Value) -> &'a Value {
    if let Some(name) = schema.get("$ref").and_then(Value::as_str).and_then(|r| r.strip_prefix("#/")) {
        return root.pointer(&format!("/{name}")).map_or(schema, |s| resolve(root, s));
    }
    let list = ["allOf", "anyOf"].iter().find_map(|k| schema.get(k)).and_then(Value::as_array);
    match list.and_then(|l| l.iter().find(|s| s.get("$ref").is_some())) {
        Some(inner) => resolve(root, inner),
        None => schema,
    }
}

fn description(schema: &Value) -> String {
    schema.get("description").and_then(Value::as_str).unwrap_or_default().replace('\n', " ")
}

fn rows(root: &Value, table: &Value, prefix: &str, out: &mut String) {
    if prefix.is_empty() {
        out.push_str("\n| key | type | default | meaning |\n|---|---|---|---|\n");
    }
    let required: Vec<&str> = table
        .get("required")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    let mut keys: Vec<_> = properties(table).collect();
    // A schema has no order: what must be given comes first.
    keys.sort_by_key(|(key, _)| !required.contains(key));
    for (key, property) in keys {
        let inner = resolve(root, property);
        if inner.get("properties").is_some() {
            rows(root, inner, &format!("{prefix}{key}."), out);
            continue;
        }
        let default = match property.get("default") {
            _ if required.contains(&key) => "*required*".to_owned(),
            Some(Value::Null) | None => "none".to_owned(),
            Some(value) => format!("`{value}`"),
        };
        let meaning = description(property).replace('|', "\\|");
        let _ = writeln!(out, "| `{prefix}{key}` | {} | {default} | {meaning} |", type_of(root, property));
    }
}

fn type_of(root: &Value, property: &Value) -> String {
    let schema = resolve(root, property);
    let constants: Vec<String> = match (schema.get("enum"), schema.get("oneOf")) {
        (Some(Value::Array(words)), _) => words.iter().map(|w| format!("`{w}`")).collect(),
        (_, Some(Value::Array(cases))) => {
            cases.iter().filter_map(|c| c.get("const")).map(|w| format!("`{w}`")).collect()
        }
        _ => Vec::new(),
    };
    if !constants.is_empty() {
        return constants.join(" or ");
    }
    let name = match schema.get("type") {
        Some(Value::String(name)) => name.as_str(),
        Some(Value::Array(names)) => {
            names.iter().filter_map(Value::as_str).find(|n| *n != "null").unwrap_or("any")
        }
        _ => "any",
    };
    match name {
        "string" => "text".to_owned(),
        "integer" => "whole number".to_owned(),
        "boolean" => "true or false".to_owned(),
        "array" => format!("list of {}", schema.get("items").map_or("any".to_owned(), |i| type_of(root, i))),
        "object" => match schema.get("additionalProperties").filter(|p| p.is_object()) {
            Some(entry) => format!("table NAME = {}", type_of(root, entry)),
            None => "table".to_owned(),
        },
        other => other.to_owned(),
    }
}
