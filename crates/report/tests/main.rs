//! Pages: their text, figures, players and data.
//!
//! All tests are in one program, since every further test program would have to be compiled and linked.

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
