//! Input files with units: fields declared once, read with positions, merged, written out, listed.
//!
//! A kind of file is a [`field::Section`]: its fields with their kinds, defaults, ranges and meaning, in nested
//! tables.
//! From it derive the [`reader`], whose errors name file, line and column, the expected value and the next
//! move; the [`writer`] of resolved text, every default written out; [`merge`], which merges files and
//! overrides; the [JSON Schema](schema); and the [`reference`](mod@reference).
//! The meaning of a field for the domain is up to the caller.

// Results must be bit-identical on every machine, so their input numbers must be, too (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![allow(
    clippy::missing_errors_doc,
    reason = "all that reads returns the first problem found, at its place"
)]

pub mod choices;
pub mod declared;
pub mod dimension;
pub mod error;
pub mod field;
mod file_ref;
mod fingerprint;
pub mod listing;
pub mod measured;
pub mod merge;
pub mod quantity;
pub mod reader;
pub mod reference;
pub mod schema;
pub mod system;
pub mod tree;
pub mod unit;
pub mod writer;

pub use dimension::Dimension;
pub use error::{InputError, Place, Problem};
pub use file_ref::FileRef;
pub use fingerprint::fnv1a;
pub use listing::{Setting, Source};
pub use quantity::{Quantity, QuantityError};
