//! Content hashes, and the two traits of what stages exchange.

use std::fmt;

/// The blake3 hash of an artifact's kind, schema and bytes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContentHash([u8; 32]);

impl ContentHash {
    /// From raw bytes of a hash.
    pub fn from_bytes(bytes: [u8; 32]) -> Self {
        Self(bytes)
    }

    /// The raw bytes.
    pub fn as_bytes(&self) -> &[u8; 32] {
        &self.0
    }

    /// 64 hexadecimal digits.
    pub fn to_hex(&self) -> String {
        blake3::Hash::from_bytes(self.0).to_hex().to_string()
    }

    /// From 64 hexadecimal digits.
    pub fn from_hex(text: &str) -> Option<Self> {
        blake3::Hash::from_hex(text).ok().map(|h| Self(*h.as_bytes()))
    }
}

impl fmt::Debug for ContentHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", &self.to_hex()[..16])
    }
}

impl serde::Serialize for ContentHash {
    fn serialize<S: serde::Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&self.to_hex())
    }
}

impl<'de> serde::Deserialize<'de> for ContentHash {
    fn deserialize<D: serde::Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let text = <std::borrow::Cow<'de, str>>::deserialize(d)?;
        Self::from_hex(&text).ok_or_else(|| serde::de::Error::custom("expected 64 hexadecimal digits"))
    }
}

/// Feeds values to a hash so that no two different sequences of values feed the same bytes.
#[derive(Debug)]
pub struct ContentHasher(blake3::Hasher);

impl ContentHasher {
    /// Starts with the kind and schema number.
    pub fn new(kind: &str, schema: u32) -> Self {
        let mut h = Self(blake3::Hasher::new());
        h.text(kind).unsigned(u64::from(schema));
        h
    }

    /// A byte string, preceded by its length.
    pub fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.update(&(bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
        self
    }

    /// A text, preceded by its length.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.bytes(text.as_bytes())
    }

    /// An unsigned number.
    pub fn unsigned(&mut self, value: u64) -> &mut Self {
        self.0.update(&value.to_le_bytes());
        self
    }

    /// A floating-point number, by its bits.
    pub fn float(&mut self, value: f64) -> &mut Self {
        self.unsigned(value.to_bits())
    }

    /// The hash of all that was fed.
    pub fn finish(&self) -> ContentHash {
        ContentHash(*self.0.finalize().as_bytes())
    }
}

/// Anything that can be an input of a stage.
pub trait Content {
    /// What it is, one word.
    const KIND: &'static str;
    /// Raised when the meaning of the bytes changes.
    const SCHEMA: u32;
    /// Hash over kind, schema and every byte of content.
    fn content_hash(&self) -> ContentHash;
}

/// Content that the store keeps as a file.
pub trait Artifact: Content + Sized {
    /// Extension of its file, without the dot: a format other programs read.
    const EXTENSION: &'static str;
    /// The file's bytes; the same value gives the same bytes.
    fn encode(&self) -> Vec<u8>;
    /// Back from a file's bytes.
    ///
    /// # Errors
    /// The bytes are not what [`Artifact::encode`] writes.
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError>;
}

/// The bytes of a stored artifact are not what its kind writes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("not a {kind} (schema {schema}): {what}")]
pub struct DecodeError {
    /// The kind expected.
    pub kind: &'static str,
    /// Its schema number.
    pub schema: u32,
    /// What was found.
    pub what: String,
}

impl DecodeError {
    /// For content `C`.
    pub fn of<C: Content>(what: impl fmt::Display) -> Self {
        Self { kind: C::KIND, schema: C::SCHEMA, what: what.to_string() }
    }
}

/// The content hash of an artifact is that of its file's bytes: what is on disk can be checked without decoding it.
pub(crate) fn hash_encoded<A: Artifact>(bytes: &[u8]) -> ContentHash {
    ContentHasher::new(A::KIND, A::SCHEMA).bytes(bytes).finish()
}

/// The bytes of a struct of numbers and texts.
pub(crate) fn encode_json<A: serde::Serialize>(value: &A) -> Vec<u8> {
    // Such a struct always has a JSON form.
    let mut bytes = serde_json::to_vec_pretty(value).unwrap_or_default();
    bytes.push(b'\n');
    bytes
}

/// Back from [`encode_json`].
pub(crate) fn decode_json<A: Content + serde::de::DeserializeOwned>(bytes: &[u8]) -> Result<A, DecodeError> {
    serde_json::from_slice(bytes).map_err(DecodeError::of::<A>)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_keep_neighbours_apart() {
        let a = ContentHasher::new("k", 1).text("ab").text("c").finish();
        let b = ContentHasher::new("k", 1).text("a").text("bc").finish();
        assert_ne!(a, b);
        assert_ne!(ContentHasher::new("k", 1).finish(), ContentHasher::new("k", 2).finish());
        assert_eq!(ContentHash::from_hex(&a.to_hex()), Some(a));
        assert_eq!(serde_json::from_str::<ContentHash>(&serde_json::to_string(&a).unwrap()).unwrap(), a);
    }
}
