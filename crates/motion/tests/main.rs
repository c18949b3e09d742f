//! Tests of records and motions: every format, every kind of damage, and all measures.
//!
//! All tests are modules of one program, because separate programs would each compile and link the
//! crate again.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod collection;
mod column_headers;
mod column_statements;
mod columns;
mod consistency;
mod corners;
mod damaged_files;
mod formats;
mod fuzz;
mod fuzz_readers;
mod gravity;
mod headers;
mod intensity;
mod kinematics;
#[path = "fuzz/large.rs"]
#[expect(dead_code, reason = "absurd large files are for the long run")]
mod large;
mod leniency;
mod matching;
mod matching_pair;
mod matching_shared;
mod near_formats;
mod odd_tables;
mod packed;
mod pulse_class;
mod recorded;
mod records;
mod reference;
mod shared;
mod shared_folder;
mod synthesis;
mod writing;
