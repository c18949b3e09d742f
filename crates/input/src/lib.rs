//! Reads, merges, writes and documents input files whose values carry units.
//!
//! Each kind of file is declared once as a [`field::Section`]: nested tables of fields with their
//! kinds, defaults, ranges and meanings. Everything else is derived from this declaration:
//!
//! - the [`reader`], whose errors name the file, line and column, the expected value and a remedy;
//! - the [`writer`], which writes every default out;
//! - [`merge`], which combines files and overrides;
//! - the [JSON Schema](schema) for editors;
//! - the [`reference`](mod@reference) in Markdown.
//!
//! This crate does not interpret the fields; the caller does.

// Results must be bit-identical on every machine, and so must the input numbers (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![allow(
    clippy::missing_errors_doc,
    reason = "every reading function returns the first problem found, with its place"
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
pub mod names;
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

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
