//! Input files with units: every field declared once, read with its place, merged, written out, listed.
//!
//! A kind of file is a [`field::Section`]: its fields with their kinds, defaults, ranges and meaning, one
//! table inside another.
//! From it come the [`reader`], whose errors name file, line and column, what was expected and the next
//! move; the [`writer`] of resolved text, every default written out; [`merge`], which lays files and
//! overrides over one another; the [JSON Schema](schema); and the [`reference`](mod@reference).
//! What a field means for the domain is the caller's.

// Physics reads its numbers here, so they have the same bits on every machine (`clippy.toml`).
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
