//! Machine-readable tables and documents: columns, fields with unit and meaning, JSON Schema, and numbers as text.
//!
//! A [`column::Column`] has a name, a unit, a role and values. This crate writes columns as CSV; other crates can write
//! them in other formats. [`described!`] declares a document: each field once, with its unit and meaning. JSON, JSON
//! Schema and the data dictionary are generated from this declaration.
//!
//! Convention: a number that is not finite is a missing value in a file, and a dash in text for human readers.

pub mod column;
pub mod described;
pub mod number;
mod words;

pub use number::{measured, shortest, significant};
pub use words::{capital, csv_field, listed, one_line, with_unit};

/// The example of the README, which is compiled and run as a doc test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
