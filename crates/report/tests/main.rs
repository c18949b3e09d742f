//! Pages: their text, figures, players and data.
//!
//! One program, since each would compile and link what it tests anew.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

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
