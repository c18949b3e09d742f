//! The `barrelstack` command: arguments, progress, printing, exit status.

mod args;
mod commands;
mod pages;
mod printer;
mod progress;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let args = args::Args::parse();
    match commands::dispatch(args) {
        Ok(code) => code,
        Err(error) => {
            printer::error(&error);
            // The same status for every user's mistake, so that scripts can tell it from a verdict.
            ExitCode::from(2)
        }
    }
}
