//! The `barrelstack` command: arguments, progress, printing, exit status.

#![warn(clippy::disallowed_methods)]

mod args;
mod commands;
mod comparison;
mod figures;
mod interrupt;
mod lanes;
mod language;
mod number;
mod printer;
mod process;
mod progress;
mod remedy;
mod rows;
mod store;
mod tables;
mod typed;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    // `--json` is parsed first, so that argument errors honor it.
    let json = std::env::args_os().any(|argument| argument == "--json");
    interrupt::watch(json);
    let args = match args::Args::try_parse() {
        Ok(args) => args,
        // Arguments may contain any characters, so the message is printed through the escaping
        // printer.
        Err(error) if error.use_stderr() => {
            printer::usage(&error.render().to_string(), json);
            return ExitCode::from(2);
        }
        Err(help) => {
            return match printer::help(&help) {
                Ok(()) => ExitCode::SUCCESS,
                Err(error) => {
                    printer::error(&error, false);
                    ExitCode::from(2)
                }
            };
        }
    };
    if let Some(wrong) = tables::refusal(std::env::args_os()) {
        printer::error(&anyhow::Error::msg(wrong), json);
        return ExitCode::from(2);
    }
    barrelstack_input::system::guard_inputs();
    if let Err(wrong) = barrelstack::report::stamp_pages(env!("BARRELSTACK_COMMIT")) {
        printer::error(&anyhow::Error::msg(wrong), json);
        return ExitCode::from(2);
    }
    interrupt::stop_at(args.stop_at.clone());
    match commands::dispatch(args) {
        // Stopped work is not a success, even if results are kept.
        Ok(code) if code == ExitCode::SUCCESS && interrupt::has_stopped() => {
            ExitCode::from(interrupt::STATUS)
        }
        Ok(code) => code,
        Err(error) if error.is::<interrupt::Stopped>() => {
            printer::stopped(json);
            ExitCode::from(interrupt::STATUS)
        }
        Err(error) => {
            printer::error(&error, json);
            // The status is the same as for a mistyped option, so that scripts can distinguish errors from a verdict.
            ExitCode::from(2)
        }
    }
}
