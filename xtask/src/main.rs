//! Project tasks, such as `cargo xtask test`, which runs all tests, locally and in CI.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program that prints to a terminal"
)]

mod browser;
mod bundle;
mod dist;
mod extra;
mod lines;
mod programs;
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
  test       formatting, lints, documentation, and all tests, also after a failed test
  golden     saves pictures of all report pages as references for the tests; look at them before you commit
  golden bits  saves hashes of results as references for the tests, after their version is raised
  film       records the animation of the demo for the README, in three dimensions
  web        builds one page that contains the program as WebAssembly and works without a network
  bundle     packs the parts of three.js that pages use, with esbuild; `check` compares them with the committed bundle
  python     builds the Python package in an environment under target/ and runs its tests, notebooks and site;
             `heavy`: also the tests that need ObsPy, OpenQuake, Pelicun, Dask and Slurm; `site`: only the site
  validate   runs every problem with an exact answer and writes a report; `--out DIR`, `--only TEXT`, `--fast`
  field      runs the hindcasts of real earthquakes, validation/field.md; `--records DIR`, `--only TEXT`, `--page`
  bench      measures speed, and that of game engines on the same scenes; `--cases N`, `table`, `table --protect`,
             `profile` (shares of time by phase; needs perf), `growth`,
             `history` (counts of work compared with the last release; `history keep` saves them)
  tests      only the tests of the workspace, on any system
  miri       runs the tests of unsafe code under Miri, with the nightly toolchain
  semver     compares the interfaces of the crates with those of the last release, or of a given revision,
             with cargo-semver-checks
  dist       makes or checks one part of a release under target/dist: all, binary [TARGET], chroot,
             wheel [TARGET], threads PYTHON, try PYTHON..., sdist, crates, deb, image, programs, checksums, lint, msrv; see RELEASING.md
  lines      counts lines of code and comments by crate, and lists the longest files
  fuzz       feeds damaged files to every reader of records; `--executions N`, `--reader NAME`, `--first K`";

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
        ["tests"] => status(steps::tests().map(done)),
        ["miri"] => status(steps::miri().map(done)),
        ["semver"] => status(steps::semver(None).map(done)),
        ["semver", revision] => status(steps::semver(Some(*revision)).map(done)),
        ["dist", rest @ ..] => status(dist::run(&steps::root(), rest).map(done)),
        ["lines"] => status(lines::list(&steps::root()).map(done)),
        ["python", rest @ ..] if matches!(rest, [] | ["heavy" | "site"]) => {
            status(python::run(&steps::root(), rest.first().copied()).map(done))
        }
        ["golden", "bits"] => {
            release(&["--package", "barrelstack-library", "--example", "golden"], &[])
        }
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
            eprintln!("xtask: unknown task `{}`\n\n{USAGE}", other.join(" "));
            ExitCode::from(2)
        }
    }
}

/// Converts the `()` of a task that succeeded into its exit status.
fn done((): ()) -> ExitCode {
    ExitCode::SUCCESS
}

/// Returns the exit status of a task, and prints the reason if the task failed.
fn status(result: anyhow::Result<ExitCode>) -> ExitCode {
    result.unwrap_or_else(|error| {
        eprintln!("xtask: {error:#}");
        ExitCode::FAILURE
    })
}

/// Runs a program of the workspace in the release profile. The exit status is a failure if the program fails or cargo
/// cannot be started.
///
/// `program` contains the arguments by which cargo selects the program; `words` are the arguments of the program.
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
            eprintln!("xtask: cannot start cargo: {error}");
            ExitCode::FAILURE
        }
    }
}
