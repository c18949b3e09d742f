//! The `barrelstack` command: arguments, progress, printing, exit status.

#![warn(clippy::disallowed_methods)]

mod args;
mod commands;
mod figures;
mod interrupt;
mod lanes;
mod printer;
mod progress;
mod remedy;
mod rows;
mod store;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let args = args::Args::parse();
    match commands::dispatch(args) {
        Ok(code) => code,
        Err(error) => {
            printer::error(&error);
            // The same status as for a mistyped option, so that scripts can tell both from a verdict.
            ExitCode::from(2)
        }
    }
}
