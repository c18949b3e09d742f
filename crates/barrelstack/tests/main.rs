//! Stacks as a user states them: verdicts, variants, comparisons, pages and files, and the numbers that they rest on.
//!
//! All tests are in one program, since every further test program would have to be compiled and linked.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

mod accuracy;
mod common;
mod compare;
mod devices;
mod documents;
mod ensemble;
mod free_elements;
mod free_solids;
mod locked_friction;
mod moment;
mod page;
mod paper;
mod period;
mod racks_along;
mod remedy;
mod render;
mod rest;
mod scenario_barrel;
mod scenario_builtin;
mod scenario_cases;
mod scenario_hostile;
mod scenario_quantity;
mod scenario_schema;
mod scenario_unknowns;
mod scenario_variants;
mod seats;
mod settling;
mod similitude;
mod simulation;
mod straps;
mod stress;
mod thickness;
mod variants;
mod verify;
