//! The program as a user runs it: commands, messages, files, interrupts.
//!
//! One program, since each would compile and link what it tests anew.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

#[cfg(unix)]
#[path = "common/cases.rs"]
mod cases;
mod cellar;
mod cli;
mod cluster;
mod common;
mod compare;
mod decision;
mod documented;
mod features;
mod hostile_commands;
mod hostile_records;
mod hostile_scenarios;
mod interrupt;
mod languages;
mod motion;
mod motion_folders;
mod motion_more;
mod outputs;
mod pictures;
mod schemas;
mod space;
mod study;
mod tables;
mod words;
#[cfg(feature = "xlsx")]
mod workbooks;
