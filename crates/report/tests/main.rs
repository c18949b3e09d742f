//! Pages: their text, figures, players and data.
//!
//! One program, since each would compile and link what it tests anew.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

mod common;
mod depth;
mod figures;
mod page;
mod payload;
mod pictures;
mod players;
mod series;
mod solids;
mod text;
