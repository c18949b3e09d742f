//! Tables and documents for programs: columns, fields with unit and meaning, JSON Schema, and numbers as text.
//!
//! A [`column::Column`] has a name, a unit, a role and values; CSV is written from it, and other formats can be.
//! [`described!`] declares a document: each field once, with its unit and meaning. JSON, JSON Schema and the data
//! dictionary are generated from this declaration.
//!
//! Conventions: a number that is not finite has no value in a file and is a dash for readers.

pub mod column;
pub mod described;
pub mod number;
mod words;

pub use number::{measured, shortest, significant};
pub use words::{capital, csv_field, listed, one_line, with_unit};

/// The example of the README, which is compiled and run with the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
