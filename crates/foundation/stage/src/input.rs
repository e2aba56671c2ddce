//! What a stage reads: values that were hashed, and the list of them that is part of its key.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;
use std::sync::Arc;

use biplane_artifact::{Content, ContentHash};
use serde::{Deserialize, Serialize};

/// A value together with its content hash; there is no way to have one without the other. Cloning shares the value.
pub struct Hashed<T> {
    value: Arc<T>,
    hash: ContentHash,
}

impl<T: Content> Hashed<T> {
    /// Hashes the value.
    pub fn new(value: T) -> Self {
        let hash = value.content_hash();
        Self { value: Arc::new(value), hash }
    }

    /// For the store, which hashed the file's bytes.
    pub(crate) fn of_checked(value: T, hash: ContentHash) -> Self {
        Self { value: Arc::new(value), hash }
    }

    /// The content hash.
    pub fn hash(&self) -> ContentHash {
        self.hash
    }

    /// The hash alone.
    pub fn promise(&self) -> Promise<T> {
        Promise::new(self.hash)
    }
}

impl<T> Deref for Hashed<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T> Clone for Hashed<T> {
    fn clone(&self) -> Self {
        Self { value: Arc::clone(&self.value), hash: self.hash }
    }
}

impl<T: Content> fmt::Debug for Hashed<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", T::KIND, self.hash)
    }
}

/// The content hash of a `T` that need not be at hand: enough to compute a key.
///
/// It is a claim. A key made from a wrong one finds nothing, and before a stage runs the claim is held against the value.
pub struct Promise<T> {
    hash: ContentHash,
    of: PhantomData<fn() -> T>,
}

impl<T: Content> Promise<T> {
    /// Of a hash that was computed from a `T` before.
    pub fn new(hash: ContentHash) -> Self {
        Self { hash, of: PhantomData }
    }

    /// The content hash.
    pub fn hash(&self) -> ContentHash {
        self.hash
    }
}

impl<T> Clone for Promise<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Promise<T> {}

impl<T: Content> fmt::Debug for Promise<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", T::KIND, self.hash)
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Loaded {}
    impl Sealed for super::Promised {}
}

/// In which form a struct made by [`inputs!`](crate::inputs) holds its inputs: [`Loaded`] or [`Promised`].
pub trait Form: Clone + sealed::Sealed {
    /// What stands for one `T`.
    type Of<T: Content>: Clone;
    /// Its hash.
    fn hash<T: Content>(held: &Self::Of<T>) -> ContentHash;
}

/// The values themselves, as [`Hashed`]: what `run` gets.
#[derive(Debug, Clone, Copy)]
pub enum Loaded {}

/// Only the hashes, as [`Promise`]: what a key is made from.
#[derive(Debug, Clone, Copy)]
pub enum Promised {}

impl Form for Loaded {
    type Of<T: Content> = Hashed<T>;
    fn hash<T: Content>(held: &Hashed<T>) -> ContentHash {
        held.hash()
    }
}

impl Form for Promised {
    type Of<T: Content> = Promise<T>;
    fn hash<T: Content>(held: &Promise<T>) -> ContentHash {
        held.hash()
    }
}

/// What can be a field of [`inputs!`](crate::inputs): one content `T`, or a list `[T]` of it.
pub trait Slot {
    /// `F::Of<T>`, or a vector of them.
    type Of<F: Form>: Clone;
    /// The field's part of the key.
    fn part<F: Form>(role: &str, held: &Self::Of<F>) -> InputPart;
    /// The hashes of what was loaded.
    fn promised(held: &Self::Of<Loaded>) -> Self::Of<Promised>;
}

impl<T: Content> Slot for T {
    type Of<F: Form> = F::Of<T>;
    fn part<F: Form>(role: &str, held: &F::Of<T>) -> InputPart {
        InputPart::new::<T>(role, InputHash::One(F::hash(held)))
    }
    fn promised(held: &Hashed<T>) -> Promise<T> {
        held.promise()
    }
}

impl<T: Content> Slot for [T] {
    type Of<F: Form> = Vec<F::Of<T>>;
    fn part<F: Form>(role: &str, held: &Vec<F::Of<T>>) -> InputPart {
        InputPart::new::<T>(role, InputHash::List(held.iter().map(F::hash).collect()))
    }
    fn promised(held: &Vec<Hashed<T>>) -> Vec<Promise<T>> {
        held.iter().map(Hashed::promise).collect()
    }
}

/// One field of a stage's inputs, as it enters the key.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputPart {
    /// The field's name.
    pub role: String,
    /// [`Content::KIND`].
    pub kind: String,
    /// [`Content::SCHEMA`].
    pub schema: u32,
    /// What it holds.
    pub hash: InputHash,
}

impl InputPart {
    fn new<T: Content>(role: &str, hash: InputHash) -> Self {
        Self { role: role.to_owned(), kind: T::KIND.to_owned(), schema: T::SCHEMA, hash }
    }
}

/// The hash of one input, or of each of a list in its order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum InputHash {
    /// A field `name: T`.
    One(ContentHash),
    /// A field `name: [T]`.
    List(Vec<ContentHash>),
}

/// Hashes of every input of a stage: enough for its key. Made by [`inputs!`](crate::inputs).
pub trait InputHashes {
    /// One part a field, in the order of the fields.
    fn parts(&self) -> Vec<InputPart>;
}

/// The inputs of a stage. Made by [`inputs!`](crate::inputs), never by hand: the macro is what makes every field count.
pub trait Inputs: InputHashes {
    /// The same fields, holding only hashes.
    type Hashes: InputHashes + Clone;
    /// The hashes of these values.
    fn hashes(&self) -> Self::Hashes;
}

/// A stage that reads nothing but its parameters.
impl InputHashes for () {
    fn parts(&self) -> Vec<InputPart> {
        Vec::new()
    }
}

impl Inputs for () {
    type Hashes = ();
    fn hashes(&self) {}
}

/// Makes the struct of a stage's inputs from one list of fields, so that a field which nobody hashes cannot exist.
///
/// A field is `name: T` or `name: [T]` with `T:` [`Content`]. The struct has a parameter for the form it holds them in:
/// `Name`, which is `Name<`[`Loaded`]`>`, has [`Hashed<T>`](Hashed) and `Vec<Hashed<T>>`; `Name<`[`Promised`]`>` has
/// [`Promise<T>`](Promise) and `Vec<Promise<T>>`.
///
/// ```
/// use biplane_artifact::{Calibration, ModelMesh};
/// use biplane_stage::{Hashed, Promised, inputs};
///
/// inputs! {
///     /// What the outline is made from.
///     pub struct OutlineInputs {
///         /// One a view.
///         calibrations: [Calibration],
///         model: ModelMesh,
///     }
/// }
///
/// fn promised(views: &[Hashed<Calibration>], model: &Hashed<ModelMesh>) -> OutlineInputs<Promised> {
///     OutlineInputs { calibrations: views.iter().map(Hashed::promise).collect(), model: model.promise() }
/// }
/// ```
///
/// What has no content hash cannot be an input:
///
/// ```compile_fail
/// biplane_stage::inputs! {
///     pub struct Leak { folder: std::path::PathBuf }
/// }
/// ```
#[macro_export]
macro_rules! inputs {
    ($(#[$meta:meta])* $vis:vis struct $name:ident { $($(#[$field_meta:meta])* $role:ident : $slot:ty),+ $(,)? }) => {
        $(#[$meta])*
        $vis struct $name<F: $crate::Form = $crate::Loaded> {
            $(
                $(#[$field_meta])*
                #[doc = concat!("\n\nInput `", stringify!($role), ": ", stringify!($slot), "`.")]
                pub $role: <$slot as $crate::Slot>::Of<F>,
            )+
        }

        impl<F: $crate::Form> Clone for $name<F> {
            fn clone(&self) -> Self {
                let Self { $($role),+ } = self;
                Self { $($role: Clone::clone($role)),+ }
            }
        }

        impl<F: $crate::Form> ::core::fmt::Debug for $name<F> {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                f.debug_list().entries($crate::InputHashes::parts(self)).finish()
            }
        }

        impl<F: $crate::Form> $crate::InputHashes for $name<F> {
            fn parts(&self) -> ::std::vec::Vec<$crate::InputPart> {
                let Self { $($role),+ } = self;
                ::std::vec![$(<$slot as $crate::Slot>::part::<F>(stringify!($role), $role)),+]
            }
        }

        impl $crate::Inputs for $name<$crate::Loaded> {
            type Hashes = $name<$crate::Promised>;
            fn hashes(&self) -> Self::Hashes {
                let Self { $($role),+ } = self;
                $name { $($role: <$slot as $crate::Slot>::promised($role)),+ }
            }
        }
    };
}
