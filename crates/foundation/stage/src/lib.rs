//! The contract between a stage and its store: what has been computed is not computed again, and never wrongly reused.
//!
//! # Invariants
//!
//! 1. **Everything that can change an output is in the key.** A [`Key`] is one hash over the format of keys, the stage's
//!    name, the hash of its code, its parameters, the role, kind, schema and content hash of every input, and the kind and
//!    schema of its output ([`KeyParts`]).
//! 2. **A stage sees nothing that is not in the key.** [`Stage::run`] gets inputs, parameters and a context. The inputs
//!    come from one list of fields ([`inputs!`]) that makes both the struct of values and its part of the key, so a field
//!    that nobody hashes cannot exist. The parameters are read from the very text that is hashed ([`ParamsText`]). The
//!    [`Context`] says how to run and holds nothing that a result could depend on.
//! 3. **Inputs are hashed before the run, and the run sees exactly those bytes.** A key may be made from hashes alone
//!    ([`Promise`]); before the stage runs, the loaded values are held against them.
//! 4. **Steps follow each other by content.** What follows a step has the hash of its output in its key, not the step's
//!    own key: a stage that ran again and gave the same bytes leaves what follows cached. What follows always reads the
//!    stored form.
//! 5. **An entry is whole or absent.** It is written beside and renamed into place. A killed run leaves no half entry and
//!    loses no finished one; of two runs that make the same entry, the first one's stays.
//! 6. **Damage is found.** A lookup compares the output's length, loading compares its hash; a damaged entry is made
//!    again, and [`How::Remade`] says so.
//! 7. **Entries hold no trace of how they were made**: no time, no machine, no thread. The same key gives the same files.
//!
//! What the contract cannot see: a stage that reads a file, an environment variable or a clock by itself, or whose
//! result depends on threads; the compiler's version; code outside the workspace beyond what the lock file pins.
//!
//! # On disk
//!
//! ```text
//! .biplane/
//!   CACHEDIR.TAG                      backups leave this folder out
//!   entries/ab/ab3f.../output.npy     the artifact, in a format other programs read
//!   entries/ab/ab3f.../entry.json     which stage, code, parameters and inputs made it
//!   steps/match/lunge/0017/femur      leads to the entry: the latest one of this item
//!   tmp/                              entries being written
//! ```
//!
//! Everything here can be deleted at any time; that loses nothing but computing time.
//!
//! # A stage
//!
//! ```
//! use biplane_artifact::{Artifact, Content, ContentHash, ContentHasher, DecodeError};
//! use biplane_stage::{Context, Hashed, How, Item, ParamsText, Promised, Stage, Store, inputs};
//! use serde::{Deserialize, Serialize};
//! # use std::convert::Infallible;
//!
//! /// What the stages of this example hand to each other.
//! struct Length(f64);
//!
//! impl Content for Length {
//!     const KIND: &'static str = "length";
//!     const SCHEMA: u32 = 1;
//!     fn content_hash(&self) -> ContentHash {
//!         ContentHasher::new(Self::KIND, Self::SCHEMA).bytes(&self.encode()).finish()
//!     }
//! }
//!
//! impl Artifact for Length {
//!     const EXTENSION: &'static str = "txt";
//!     fn encode(&self) -> Vec<u8> {
//!         format!("{} mm\n", self.0).into_bytes()
//!     }
//!     fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
//!         let text = std::str::from_utf8(bytes).map_err(DecodeError::of::<Self>)?;
//!         text.trim_end_matches(" mm\n").parse().map(Length).map_err(DecodeError::of::<Self>)
//!     }
//! }
//!
//! inputs! {
//!     struct SumInputs { lengths: [Length] }
//! }
//!
//! #[derive(Serialize, Deserialize)]
//! #[serde(default, deny_unknown_fields)]
//! struct SumParams { scale: f64 }
//!
//! impl Default for SumParams {
//!     fn default() -> Self { Self { scale: 1.0 } }
//! }
//!
//! struct Sum;
//!
//! impl Stage for Sum {
//!     const NAME: &'static str = "sum";
//!     const CODE: &'static str = "in a stage's crate: env!(\"BIPLANE_CODE_HASH\")";
//!     type Inputs = SumInputs;
//!     type Params = SumParams;
//!     type Output = Length;
//!     type Error = Infallible;
//!     fn run(inputs: &SumInputs, params: &SumParams, _: &Context) -> Result<Length, Infallible> {
//!         Ok(Length(params.scale * inputs.lengths.iter().map(|l| l.0).sum::<f64>()))
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! let store = Store::open(&folder.path().join(".biplane"))?;
//! let params = ParamsText::of(&SumParams::default())?;
//! let lengths = [Hashed::new(Length(1.5)), Hashed::new(Length(2.0))];
//! let hashes = SumInputs::<Promised> { lengths: lengths.iter().map(Hashed::promise).collect() };
//! let load = || Ok::<_, Infallible>(SumInputs { lengths: lengths.to_vec() });
//!
//! let (item, context) = (Item::from("lunge/0017"), Context::new());
//! let first = store.execute::<Sum, _>("total", &item, &params, &hashes, load, &context)?;
//! assert_eq!(first.how, How::Ran);
//! assert_eq!(first.output.load()?.0, 3.5);
//!
//! let again = store.execute::<Sum, _>("total", &item, &params, &hashes, load, &context)?;
//! assert_eq!(again.how, How::Cached);
//! assert_eq!(std::fs::read_to_string(again.output.path())?, "3.5 mm\n");
//! # Ok(())
//! # }
//! ```

mod clean;
mod context;
mod explain;
mod input;
mod item;
mod key;
mod store;

use serde::Serialize;
use serde::de::DeserializeOwned;

pub use biplane_artifact::{Artifact, Content, ContentHash};
pub use clean::{Clean, Size};
pub use context::Context;
pub use explain::{Explanation, InputDifference, Reason};
pub use input::{Form, Hashed, InputHash, InputHashes, InputPart, Inputs, Loaded, Promise, Promised, Slot};
pub use item::Item;
pub use key::{Key, KeyParts, ParamsError, ParamsText};
pub use store::{Damaged, ExecuteError, How, Outcome, Store, StoreError, Stored};

/// One kind of computation whose results are worth keeping.
///
/// `run` is a function of its inputs and parameters: it reads no file, no environment variable, no clock and no global
/// random state (a seed is a parameter), and gives the same bytes on one thread or many.
pub trait Stage {
    /// Its name in keys and entries.
    const NAME: &'static str;
    /// `env!("BIPLANE_CODE_HASH")`, which the crate's build script makes.
    const CODE: &'static str;
    /// A struct made by [`inputs!`], or `()`.
    type Inputs: Inputs;
    /// Parameters. Defaults belong to their `Deserialize`, so that a study's file need not spell them out.
    type Params: Serialize + DeserializeOwned;
    /// What it makes.
    type Output: Artifact;
    /// Why it could not.
    type Error: std::error::Error + Send + Sync + 'static;

    /// Computes the output.
    ///
    /// # Errors
    /// The stage's own; nothing is stored then.
    fn run(
        inputs: &Self::Inputs,
        params: &Self::Params,
        context: &Context,
    ) -> Result<Self::Output, Self::Error>;
}
