//! The key of an entry: one hash over everything that decides a stage's output.

use std::fmt;

use biplane_artifact::{Content, ContentHash, ContentHasher};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{InputHash, InputHashes, InputPart, Stage};

/// Raised when what goes into a key, or how an entry is laid out, changes.
pub(crate) const FORMAT: u32 = 1;

/// Names an entry of the store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key(ContentHash);

impl Key {
    /// 64 hexadecimal digits.
    pub fn to_hex(&self) -> String {
        self.0.to_hex()
    }

    pub(crate) fn from_hex(text: &str) -> Option<Self> {
        ContentHash::from_hex(text).map(Self)
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.to_hex())
    }
}

/// Parameters with every default filled in, written out once as JSON with sorted keys and no spaces.
///
/// This text is what is hashed and what `run` gets its parameters from. It comes from a value, so comments, the order
/// of keys and spelled-out defaults in a study's file cannot be seen in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParamsText(String);

/// Parameters cannot be written out and read back unchanged.
#[derive(Debug, thiserror::Error)]
pub enum ParamsError {
    /// They have no JSON form, or cannot be read from it: for instance a number that is not finite.
    #[error("the parameters cannot be written as JSON and read back ({0}): are all numbers finite?")]
    NotJson(#[from] serde_json::Error),
    /// Reading them back gives others, so what runs would not be what is hashed.
    #[error("the parameters change when they are read back: {written} became {read}")]
    Unfaithful {
        /// What was written.
        written: String,
        /// What reading it and writing it again gave.
        read: String,
    },
}

impl ParamsText {
    /// Writes the parameters out, and makes sure that reading gives the same ones.
    ///
    /// # Errors
    /// They do not survive being written and read. A number that is not finite is found, except in an `Option`, where
    /// JSON cannot tell it from none: then `run` gets none.
    pub fn of<P: Serialize + DeserializeOwned>(params: &P) -> Result<Self, ParamsError> {
        let write = |p: &P| serde_json::to_value(p).map(|value| canonical(&value));
        let written = write(params)?;
        let read = write(&serde_json::from_str(&written)?)?;
        if written == read { Ok(Self(written)) } else { Err(ParamsError::Unfaithful { written, read }) }
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    pub(crate) fn read<P: DeserializeOwned>(&self) -> Result<P, ParamsError> {
        Ok(serde_json::from_str(&self.0)?)
    }

    pub(crate) fn value(&self) -> Value {
        // The text was written from a value, so it always reads.
        serde_json::from_str(&self.0).unwrap_or_default()
    }
}

/// JSON with sorted keys, whatever order the map type keeps.
fn canonical(value: &Value) -> String {
    match value {
        Value::Object(map) => {
            let mut members: Vec<_> = map.iter().collect();
            members.sort_by_key(|(name, _)| *name);
            let members = members
                .into_iter()
                .map(|(name, member)| format!("{}:{}", Value::from(name.as_str()), canonical(member)));
            format!("{{{}}}", members.collect::<Vec<_>>().join(","))
        }
        Value::Array(items) => format!("[{}]", items.iter().map(canonical).collect::<Vec<_>>().join(",")),
        plain => plain.to_string(),
    }
}

/// Everything that decides a stage's output, and so everything that its key is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyParts {
    pub(crate) stage: String,
    pub(crate) code: String,
    pub(crate) params: ParamsText,
    pub(crate) inputs: Vec<InputPart>,
    pub(crate) output_kind: String,
    pub(crate) output_schema: u32,
}

impl KeyParts {
    /// Of stage `S` on these parameters and inputs.
    pub fn of<S: Stage>(params: &ParamsText, inputs: &impl InputHashes) -> Self {
        Self {
            stage: S::NAME.to_owned(),
            code: S::CODE.to_owned(),
            params: params.clone(),
            inputs: inputs.parts(),
            output_kind: S::Output::KIND.to_owned(),
            output_schema: S::Output::SCHEMA,
        }
    }

    /// The hash over all parts.
    pub fn key(&self) -> Key {
        let Self { stage, code, params, inputs, output_kind, output_schema } = self;
        let mut h = ContentHasher::new("key", FORMAT);
        h.text(stage).text(code).text(params.as_str()).unsigned(inputs.len() as u64);
        for InputPart { role, kind, schema, hash } in inputs {
            h.text(role).text(kind).unsigned(u64::from(*schema));
            match hash {
                InputHash::One(hash) => h.text("one").bytes(hash.as_bytes()),
                InputHash::List(hashes) => {
                    h.text("list").unsigned(hashes.len() as u64);
                    hashes.iter().fold(&mut h, |h, hash| h.bytes(hash.as_bytes()))
                }
            };
        }
        h.text(output_kind).unsigned(u64::from(*output_schema));
        Key(h.finish())
    }
}

/// `entry.json`: what made an entry, and what its file must be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Record {
    pub format: u32,
    pub stage: String,
    pub code: String,
    pub params: Value,
    pub inputs: Vec<InputPart>,
    pub output: OutputRecord,
}

/// What a lookup needs of [`Record`].
#[derive(Debug, Deserialize)]
pub(crate) struct RecordHead {
    pub format: u32,
    pub output: OutputRecord,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct OutputRecord {
    pub kind: String,
    pub schema: u32,
    pub file: String,
    pub bytes: u64,
    pub hash: ContentHash,
}

impl Record {
    pub(crate) fn new(parts: &KeyParts, output: OutputRecord) -> Self {
        let KeyParts { stage, code, params, inputs, output_kind: _, output_schema: _ } = parts;
        Self {
            format: FORMAT,
            stage: stage.clone(),
            code: code.clone(),
            params: params.value(),
            inputs: inputs.clone(),
            output,
        }
    }
}
