//! Small stages on texts.

use std::convert::Infallible;

use biplane_artifact::{Artifact, Content, ContentHash, ContentHasher, DecodeError};
use biplane_stage::{Context, Key, KeyParts, ParamsText, Promise, Promised, Stage, inputs};
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, PartialEq)]
pub struct Text(pub String);

/// Text by another kind or schema, with the same hash: only the key can tell them apart.
macro_rules! text_artifact {
    ($name:ident, $kind:literal, $schema:literal) => {
        impl Content for $name {
            const KIND: &'static str = $kind;
            const SCHEMA: u32 = $schema;
            fn content_hash(&self) -> ContentHash {
                ContentHasher::new(Self::KIND, Self::SCHEMA).bytes(self.0.as_bytes()).finish()
            }
        }

        impl Artifact for $name {
            const EXTENSION: &'static str = "txt";
            fn encode(&self) -> Vec<u8> {
                self.0.clone().into_bytes()
            }
            fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
                String::from_utf8(bytes.to_vec()).map(Self).map_err(DecodeError::of::<Self>)
            }
        }
    };
}

pub struct OtherKind(String);
pub struct OtherSchema(String);
text_artifact!(Text, "text", 1);
text_artifact!(OtherKind, "other", 1);
text_artifact!(OtherSchema, "text", 2);

inputs! {
    /// What [`Join`] joins.
    pub struct JoinInputs {
        head: Text,
        /// In this order.
        tail: [Text],
        other: [Text],
    }
}

#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct JoinParams {
    pub separator: String,
    pub limit: Limit,
}

#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Limit {
    pub scale: f64,
    pub longest: u32,
}

impl Default for JoinParams {
    fn default() -> Self {
        Self { separator: ", ".into(), limit: Limit::default() }
    }
}

impl Default for Limit {
    fn default() -> Self {
        Self { scale: 1.5, longest: 100 }
    }
}

#[derive(Debug, thiserror::Error)]
#[error("asked to fail")]
pub struct Failed;

macro_rules! join_stage {
    ($stage:ident, $name:literal, $code:literal) => {
        pub struct $stage;
        impl Stage for $stage {
            const NAME: &'static str = $name;
            const CODE: &'static str = $code;
            type Inputs = JoinInputs;
            type Params = JoinParams;
            type Output = Text;
            type Error = Failed;
            fn run(inputs: &JoinInputs, params: &JoinParams, _: &Context) -> Result<Text, Failed> {
                if inputs.head.0 == "fail" {
                    return Err(Failed);
                }
                let parts = std::iter::once(&inputs.head).chain(&inputs.tail).chain(&inputs.other);
                let parts: Vec<_> = parts.map(|t| t.0.as_str()).collect();
                Ok(Text(parts.join(&params.separator)))
            }
        }
    };
}

join_stage!(Join, "join", "1");
join_stage!(OtherName, "other", "1");
join_stage!(OtherCode, "join", "2");

inputs! {
    /// What [`Trim`] trims.
    pub struct TrimInputs { raw: Text }
}

#[derive(Serialize, Deserialize)]
pub struct TrimParams {
    pub suffix: String,
}

pub struct Trim;

impl Stage for Trim {
    const NAME: &'static str = "trim";
    const CODE: &'static str = "1";
    type Inputs = TrimInputs;
    type Params = TrimParams;
    type Output = Text;
    type Error = Infallible;
    fn run(inputs: &TrimInputs, params: &TrimParams, _: &Context) -> Result<Text, Infallible> {
        Ok(Text(format!("{}{}", inputs.raw.0, params.suffix).trim().to_owned()))
    }
}

/// Any parameters, no inputs.
pub struct Any;

impl Stage for Any {
    const NAME: &'static str = "any";
    const CODE: &'static str = "1";
    type Inputs = ();
    type Params = serde_json::Value;
    type Output = Text;
    type Error = Infallible;
    fn run((): &(), params: &serde_json::Value, _: &Context) -> Result<Text, Infallible> {
        Ok(Text(params.to_string()))
    }
}

macro_rules! unsound_stage {
    ($stage:ident, $artifact:ident, $kind:literal, $hash:expr, $decode:expr) => {
        #[derive(Debug)]
        pub struct $artifact;
        impl Content for $artifact {
            const KIND: &'static str = $kind;
            const SCHEMA: u32 = 1;
            fn content_hash(&self) -> ContentHash {
                ContentHasher::new(Self::KIND, Self::SCHEMA).bytes($hash).finish()
            }
        }
        impl Artifact for $artifact {
            const EXTENSION: &'static str = "txt";
            fn encode(&self) -> Vec<u8> {
                b"text".to_vec()
            }
            fn decode(_: &[u8]) -> Result<Self, DecodeError> {
                $decode
            }
        }
        pub struct $stage;
        impl Stage for $stage {
            const NAME: &'static str = "unsound";
            const CODE: &'static str = "1";
            type Inputs = ();
            type Params = ();
            type Output = $artifact;
            type Error = Infallible;
            fn run((): &(), (): &(), _: &Context) -> Result<$artifact, Infallible> {
                Ok($artifact)
            }
        }
    };
}

unsound_stage!(Liar, Lie, "lie", b"another text", Ok(Self));
unsound_stage!(Mute, Silence, "mute", b"text", Err(DecodeError::of::<Self>("nothing to read")));

/// Writes a number that is one larger than itself.
#[derive(Deserialize)]
pub struct Drifting(pub u32);

impl Serialize for Drifting {
    fn serialize<S: serde::Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_u32(self.0 + 1)
    }
}

macro_rules! kind_stage {
    ($stage:ident, $inputs:ident, $role:ident, $input:ident, $output:ident) => {
        inputs! {
            pub struct $inputs { $role: $input }
        }
        pub struct $stage;
        impl Stage for $stage {
            const NAME: &'static str = "kinds";
            const CODE: &'static str = "1";
            type Inputs = $inputs;
            type Params = serde_json::Value;
            type Output = $output;
            type Error = Infallible;
            fn run(inputs: &$inputs, _: &serde_json::Value, _: &Context) -> Result<$output, Infallible> {
                Ok($output(inputs.$role.0.clone()))
            }
        }
    };
}

kind_stage!(Plain, PlainInputs, text, Text, Text);
kind_stage!(Role, RoleInputs, title, Text, Text);
kind_stage!(KindIn, KindInInputs, text, OtherKind, Text);
kind_stage!(SchemaIn, SchemaInInputs, text, OtherSchema, Text);
kind_stage!(KindOut, KindOutInputs, text, Text, OtherKind);
kind_stage!(SchemaOut, SchemaOutInputs, text, Text, OtherSchema);

pub fn keys_that_differ_in_role_kind_or_schema_alone(params: &ParamsText, hash: ContentHash) -> [Key; 6] {
    [
        KeyParts::of::<Plain>(params, &PlainInputs::<Promised> { text: Promise::new(hash) }).key(),
        KeyParts::of::<Role>(params, &RoleInputs::<Promised> { title: Promise::new(hash) }).key(),
        KeyParts::of::<KindIn>(params, &KindInInputs::<Promised> { text: Promise::new(hash) }).key(),
        KeyParts::of::<SchemaIn>(params, &SchemaInInputs::<Promised> { text: Promise::new(hash) }).key(),
        KeyParts::of::<KindOut>(params, &KindOutInputs::<Promised> { text: Promise::new(hash) }).key(),
        KeyParts::of::<SchemaOut>(params, &SchemaOutInputs::<Promised> { text: Promise::new(hash) }).key(),
    ]
}
