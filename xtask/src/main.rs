//! Project tasks: `cargo xtask test`, the one test command at home and in CI.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program for people at a terminal"
)]

mod browser;
mod steps;
mod tally;

use std::process::ExitCode;

/// What can be asked for.
const USAGE: &str = "\
usage: cargo xtask TASK

tasks:
  test   formatting, lints, documentation, and all tests in both profiles; stops at the first failure";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["test"] => match steps::test() {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("xtask: {error:#}");
                ExitCode::FAILURE
            }
        },
        [] | ["help" | "--help" | "-h"] => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        other => {
            eprintln!("xtask: there is no task `{}`\n\n{USAGE}", other.join(" "));
            ExitCode::from(2)
        }
    }
}
