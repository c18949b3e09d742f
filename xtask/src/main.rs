//! Project tasks: `cargo xtask test`, the one test command at home and in CI.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program for people at a terminal"
)]

mod browser;
mod bundle;
mod extra;
mod lines;
mod python;
mod steps;
mod tally;
mod web;
#[cfg(test)]
mod wording;

use std::process::ExitCode;

/// Help text.
const USAGE: &str = "\
usage: cargo xtask TASK

tasks:
  test       formatting, lints, documentation, and all tests; stops at the first failure
  golden     keeps how all report pages look now, for the next test; look at what it keeps before you commit it
  golden bits  keeps what results are now, to the last bit, once their version is raised
  film       films the demo for the README, in three dimensions
  web        one page that holds the program, as WebAssembly, and works without a network; says how large it is
  bundle     packs what pages use of three.js, with esbuild; `check` compares it with the one that is kept
  python     the Python package in an environment of its own under target/: its tests, its notebooks, its site;
             `heavy` also those that need ObsPy, OpenQuake, Pelicun, Dask and Slurm; `site` the site alone
  validate   every problem with an exact answer, in full, with a report; `--out DIR`, `--only TEXT`, `--fast`
  field      hindcasts of real earthquakes, validation/field.md; `--records DIR`, `--only TEXT`, `--page`
  bench      how fast stacks are computed, beside a game engine on the same scenes; `--cases N`, `table`, `growth`,
             `history` (the work of runs beside that of the last release; `history keep` writes it down)
  lines      lines of product code and comments by crate, and the longest files
  fuzz       damaged files through every reader of records; `--executions N`, `--reader NAME`, `--first K`";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["test"] => status(steps::test().map(done)),
        ["golden"] => status(steps::golden()),
        ["film"] => status(steps::film()),
        ["bundle"] => status(steps::bundle(bundle::Bundle::write).map(done)),
        ["bundle", "check"] => status(steps::bundle(bundle::Bundle::check).map(done)),
        ["web"] => status(steps::web().map(done)),
        ["lines"] => status(lines::list(&steps::root()).map(done)),
        ["python", rest @ ..] if matches!(rest, [] | ["heavy" | "site"]) => {
            status(python::run(&steps::root(), rest.first().copied()).map(done))
        }
        ["golden", "bits"] => release(&["--package", "barrelstack", "--example", "golden"], &[]),
        ["validate", rest @ ..] => release(&["--package", "barrelstack-validation"], rest),
        ["field", rest @ ..] => {
            release(&["--package", "barrelstack-validation", "--example", "field"], rest)
        }
        ["bench", rest @ ..] => release(&["--manifest-path", "benchmarks/Cargo.toml"], rest),
        ["fuzz", rest @ ..] => {
            release(&["--package", "barrelstack-motion", "--example", "fuzz"], rest)
        }
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

/// The status of a task that is done.
fn done((): ()) -> ExitCode {
    ExitCode::SUCCESS
}

/// Returns the status of a task; prints the reason of a failure.
fn status(result: anyhow::Result<ExitCode>) -> ExitCode {
    result.unwrap_or_else(|error| {
        eprintln!("xtask: {error:#}");
        ExitCode::FAILURE
    })
}

/// Runs a program of the workspace in release and passes its words and its status on.
fn release(program: &[&str], words: &[&str]) -> ExitCode {
    let run = ["run", "--quiet", "--release"];
    match std::process::Command::new(steps::cargo())
        .args(run)
        .args(program)
        .arg("--")
        .args(words)
        .status()
    {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("xtask: cargo does not start: {error}");
            ExitCode::FAILURE
        }
    }
}
