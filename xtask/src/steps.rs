//! The steps of `cargo xtask test`, run in order.
//!
//! If a check of the sources (format, lints, documentation) fails, no further step is run, since such errors can be
//! corrected quickly. If tests fail, the other steps are still run, so that one run reports all failed tests.

use std::ffi::OsString;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;

use anyhow::{Context as _, bail};

use crate::browser;
use crate::bundle::Bundle;
use crate::extra;
use crate::tally::Tally;
use crate::web;

/// One command, with advice in case the command fails.
struct Step {
    /// Arguments of `cargo`.
    arguments: &'static [&'static str],
    /// `true` if rustdoc warnings are errors.
    strict_docs: bool,
    /// Advice after a failure.
    remedy: &'static str,
}

/// The steps that need only the Rust toolchain, the quickest first.
const STEPS: [Step; 5] = [
    Step {
        arguments: &["fmt", "--all", "--check"],
        strict_docs: false,
        remedy: "run `cargo fmt --all`",
    },
    Step {
        arguments: &[
            "clippy",
            "--workspace",
            "--all-targets",
            "--features",
            "xlsx",
            "--",
            "-D",
            "warnings",
        ],
        strict_docs: false,
        remedy: "see the lint above",
    },
    Step {
        arguments: &["doc", "--workspace", "--no-deps"],
        strict_docs: true,
        remedy: "see the warning of rustdoc above",
    },
    Step {
        arguments: &["test", "--workspace", "--features", "xlsx", "--no-fail-fast"],
        strict_docs: false,
        remedy: "see the failed tests above; they are listed again at the end of the step",
    },
    Step {
        // `barrelstack-web` is selected, too, as in the build of its example `page`, so that this build and
        // the build of the page have the same features and share their dependencies.
        arguments: &[
            "test",
            "--release",
            "--package=barrelstack-library",
            "--package=barrelstack-web",
            "--test=bits",
        ],
        strict_docs: false,
        remedy: "results depend on the optimization level: see the failed test above, which passes with debug assertions",
    },
];

/// Tests of unsafe code that Miri can run.
const MIRI: [&[&str]; 1] = [&["--package", "barrelstack-dynamics", "--lib", "lanes::"]];

/// Runs all steps. At the end, prints how many tests passed, how many failed and how many were skipped.
///
/// # Errors
///
/// If a check of the sources fails, the error names this check. Otherwise, the error lists all steps that failed.
pub(crate) fn test() -> anyhow::Result<()> {
    let root = root();
    let start = Instant::now();
    let mut report = Report::default();
    let extras = extra::all(&root);
    let count = STEPS.len() + extras.len();
    for (index, step) in STEPS.iter().enumerate() {
        let name = format!("cargo {}", step.arguments.join(" "));
        println!("\n== step {} of {count}: {name}", index + 1);
        let mut command = Command::new(cargo());
        command.args(step.arguments).current_dir(&root);
        if step.strict_docs {
            command.env("RUSTDOCFLAGS", "-D warnings");
        }
        let passed = report.run(&name, &mut command, step.remedy);
        if !passed && step.arguments[0] != "test" {
            break;
        }
    }
    if report.failures.is_empty() || report.total != Tally::default() {
        for (index, extra) in extras.into_iter().enumerate() {
            println!("\n== step {} of {count}: {}", STEPS.len() + index + 1, extra.name);
            match extra.command {
                Ok(mut command) => {
                    if let Some(Err(error)) = extra.pages.map(|pages| pages.build()) {
                        report.failures.push(format!("{}: {error:#}", extra.name));
                        continue;
                    }
                    report.run(extra.name, command.current_dir(&root), extra.remedy);
                }
                Err(reason) => {
                    println!("skipped: {reason}");
                    report.total.skipped += 1;
                    report.closing.push(format!("{}: skipped, {reason}", extra.name));
                }
            }
        }
    }
    report.close(start);
    if report.failures.is_empty() {
        return Ok(());
    }
    bail!("{} failed:\n  {}", steps_of(report.failures.len()), report.failures.join("\n  "))
}

/// Returns a number of steps as text, such as "1 step" or "2 steps".
fn steps_of(count: usize) -> String {
    format!("{count} step{}", if count == 1 { "" } else { "s" })
}

/// Results of the steps that were run.
#[derive(Default)]
struct Report {
    /// Numbers of tests that passed, failed and were skipped, each added up over all steps.
    total: Tally,
    /// For each step that was run or skipped, a line with its result, such as the numbers of tests.
    closing: Vec<String>,
    /// For each failed step, its name and advice.
    failures: Vec<String>,
}

impl Report {
    /// Runs the command of a step and keeps its result. Returns `true` if the step passed.
    fn run(&mut self, name: &str, command: &mut Command, remedy: &str) -> bool {
        let begin = Instant::now();
        let passed = match watched(command) {
            Ok((passed, tally)) => {
                self.total.add(tally);
                let counts =
                    if tally == Tally::default() { String::new() } else { format!(": {tally}") };
                let failed = if passed { "" } else { " (failed)" };
                let seconds = begin.elapsed().as_secs_f64();
                self.closing.push(format!("{name}{counts}, {seconds:.0} s{failed}"));
                passed
            }
            Err(error) => {
                println!("{error:#}");
                self.closing.push(format!("{name}: not run, {error:#}"));
                false
            }
        };
        if !passed {
            println!("\n== failed: {name}; {remedy}");
            self.failures.push(format!("{name}: {remedy}"));
        }
        passed
    }

    /// Prints the counts and the time of each step, and the total counts on the last line.
    ///
    /// Prints nothing if no test was run, because `0 passed, 0 failed` would look like a success.
    fn close(&self, start: Instant) {
        if self.total == Tally::default() {
            return;
        }
        println!("\n== closing lines, after {:.0} s", start.elapsed().as_secs_f64());
        for line in &self.closing {
            println!("{line}");
        }
        println!("{}", self.total);
    }
}

/// Runs only the tests of the workspace, which need nothing but the Rust toolchain.
pub(crate) fn tests() -> anyhow::Result<()> {
    let mut command = Command::new(cargo());
    let (passed, tally) = watched(command.args(STEPS[3].arguments).current_dir(root()))?;
    println!("{tally}");
    if passed { Ok(()) } else { bail!("tests failed: {}", STEPS[3].remedy) }
}

/// Compares the interfaces of the published crates with those of a git revision, by default the last release, and fails
/// if the version number does not allow a difference.
///
/// Prints the reason and skips the comparison if cargo-semver-checks is not installed, or if no revision is given and
/// there is no release.
pub(crate) fn semver(revision: Option<&str>) -> anyhow::Result<()> {
    const TOOL: &str = "semver-checks";
    let there = Command::new(cargo()).args([TOOL, "--version"]).output();
    if !there.is_ok_and(|output| output.status.success()) {
        println!("skipped: no cargo-{TOOL}; run `cargo install --locked cargo-{TOOL}`");
        return Ok(());
    }
    let last = ["describe", "--tags", "--abbrev=0", "--match", "v*"];
    let last = Command::new("git").args(last).current_dir(root()).output()?;
    let last = String::from_utf8_lossy(&last.stdout).trim().to_owned();
    let baseline = revision.unwrap_or(&last);
    if baseline.is_empty() {
        println!(
            "skipped: there is no release yet; name a revision, such as `cargo xtask semver HEAD~1`"
        );
        return Ok(());
    }
    let mut command = Command::new(cargo());
    command.args([TOOL, "--workspace", "--baseline-rev", baseline]).current_dir(root());
    if command.status().context("cannot start cargo")?.success() {
        return Ok(());
    }
    bail!("the interfaces differ from those of {baseline}: raise the version, or undo the change")
}

/// Runs tests of unsafe code under Miri: the selection of the SIMD instruction set at run time in
/// `crates/dynamics/src/lanes/mod.rs`, and the AVX2 operations. Miri interprets code for x86-64 on any machine.
///
/// The other unsafe code interacts with the program loader, Python or the browser, which Miri does not support.
pub(crate) fn miri() -> anyhow::Result<()> {
    for arguments in MIRI {
        let mut command = Command::new("cargo");
        command
            .args(["+nightly", "miri", "test", "--target", "x86_64-unknown-linux-gnu"])
            .args(arguments)
            .current_dir(root());
        // These variables select the toolchain that runs this program; cargo must use the nightly toolchain instead.
        for name in ["CARGO", "RUSTC", "RUSTUP_TOOLCHAIN"] {
            command.env_remove(name);
        }
        command.env("MIRIFLAGS", "-Zmiri-disable-isolation");
        // With this flag, Miri supports AVX2; without AVX2, the AVX2 operations would not be executed.
        command.env("RUSTFLAGS", "-C target-cpu=x86-64-v3");
        if !command.status().context("cannot start cargo")?.success() {
            bail!("Miri failed, or is missing: `rustup +nightly component add miri rust-src`");
        }
    }
    Ok(())
}

/// Builds the page that contains the engine.
pub(crate) fn web() -> anyhow::Result<()> {
    let build = web::Build::find(&root()).map_err(anyhow::Error::msg)?;
    build.run()
}

/// Packs the bundle of three.js and applies `use_it`, which writes or compares the result.
pub(crate) fn bundle(use_it: fn(&Bundle) -> anyhow::Result<()>) -> anyhow::Result<()> {
    use_it(&Bundle::find(&root()).map_err(anyhow::Error::msg)?)
}

/// Records the animation of the demo for the README.
pub(crate) fn film() -> anyhow::Result<ExitCode> {
    let check = browser::find(&root(), browser::FILM)
        .context("this repository does not contain the script that records pages")?;
    check.film()
}

/// Saves the present appearance of all report pages as the reference for later checks.
pub(crate) fn golden() -> anyhow::Result<ExitCode> {
    let check = browser::find(&root(), browser::REPORTS)
        .context("this repository does not contain the script that checks pages")?;
    check.renew()
}

/// Runs a command and prints its output as it arrives; returns `true` if the command succeeded, and
/// the counts of the test runners in the output.
fn watched(command: &mut Command) -> anyhow::Result<(bool, Tally)> {
    let program = Path::new(command.get_program()).display().to_string();
    let mut child = command
        .stdout(Stdio::piped())
        .spawn()
        .with_context(|| format!("cannot start {program}: is it installed and on the PATH?"))?;
    let mut lines = Vec::new();
    if let Some(output) = child.stdout.take() {
        let mut shown = std::io::stdout().lock();
        for line in BufReader::new(output).split(b'\n') {
            let line = line.context("cannot read the output")?;
            shown.write_all(&line)?;
            shown.write_all(b"\n")?;
            shown.flush()?;
            lines.push(String::from_utf8_lossy(&line).into_owned());
        }
    }
    let passed = child.wait()?.success();
    Ok((passed, Tally::of(lines.iter().map(String::as_str))))
}

/// Returns the path of the cargo program that started this program, so that all steps use the same
/// toolchain.
pub(crate) fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Returns the folder in which cargo builds.
pub(crate) fn target(root: &Path) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    root.join(target.unwrap_or_else(|| PathBuf::from("target")))
}

/// Builds the program in the release profile.
///
/// The Python package is selected, too, so that the program and the package are built with the same features of their
/// dependencies, and each dependency is compiled only once.
pub(crate) fn build_program(root: &Path) -> anyhow::Result<()> {
    let packages = ["--package=barrelstack", "--package=barrelstack-python", "--bin=barrelstack"];
    let mut build = Command::new(cargo());
    build.args(["build", "--quiet", "--release"]).args(packages);
    let status = build.current_dir(root).status();
    if !status.context("cannot start cargo")?.success() {
        bail!("building the program failed: see above");
    }
    Ok(())
}

/// Returns the path of the program that [`build_program`] builds.
pub(crate) fn program(root: &Path) -> PathBuf {
    target(root).join("release").join(format!("barrelstack{}", std::env::consts::EXE_SUFFIX))
}

/// Returns the root of the repository, independent of the working directory.
pub(crate) fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own).to_path_buf()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::fs;
    use std::path::PathBuf;

    use super::{Command, Report, cargo, root};
    use crate::lines::{entries, sources};

    /// After a failed step, later steps must still be run, and the failure must be reported at the end.
    #[test]
    fn steps_after_a_failed_step_are_run() {
        let mut report = Report::default();
        assert!(!report.run("one", Command::new(cargo()).arg("--no-such-option"), "mend it"));
        assert!(!report.run("two", &mut Command::new("no-such-program"), "install it"));
        assert!(report.run("three", Command::new(cargo()).arg("--version"), "unused"));
        assert_eq!(report.failures, ["one: mend it", "two: install it"]);
        assert_eq!(report.closing.len(), 3);
        assert!(report.closing[0].ends_with("(failed)") && !report.closing[2].contains("failed"));
    }

    /// A test file must be declared as a module in `tests/main.rs`; otherwise its tests would not be run.
    #[test]
    #[allow(clippy::unwrap_used, reason = "a test fails by panic")]
    fn every_file_of_tests_is_run() {
        let mut programs = 0;
        for folder in fs::read_dir(root().join("crates")).unwrap() {
            let folder = folder.unwrap().path();
            let Ok(modules) = fs::read_to_string(folder.join("tests/main.rs")) else { continue };
            let package = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
            programs += 1;
            for entry in fs::read_dir(folder.join("tests")).unwrap() {
                let path = entry.unwrap().path();
                let name = path.file_stem().unwrap().to_str().unwrap();
                let is_test = path.extension().is_some_and(|extension| extension == "rs");
                let stated = modules.contains(&format!("\nmod {name};\n"))
                    || package.contains(&format!("[[test]]\nname = \"{name}\"\n"));
                assert!(!is_test || name == "main" || stated, "{} is not run", path.display());
            }
        }
        assert!(programs >= 8, "{programs}");
    }

    /// Returns the folder of each package of the workspace.
    #[allow(clippy::unwrap_used, reason = "a test fails by panic")]
    fn packages() -> BTreeMap<String, PathBuf> {
        let mut found = BTreeMap::new();
        for folder in entries(&root().join("crates")).unwrap() {
            let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
            let name = manifest.split('"').nth(1).unwrap();
            found.insert(name.to_owned(), folder);
        }
        found
    }

    /// Documents must not contain commands with packages, tests or examples that do not exist.
    #[test]
    #[allow(clippy::unwrap_used, reason = "a test fails by panic")]
    fn commands_of_documents_name_packages_and_targets_that_exist() {
        let packages = packages();
        let mut files = Vec::new();
        for folder in ["", "docs", "validation"] {
            files.extend(entries(&root().join(folder)).unwrap());
        }
        files.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
        for folder in packages.values() {
            files.extend(
                entries(folder).unwrap().into_iter().filter(|path| path.ends_with("README.md")),
            );
            for kind in ["src", "tests", "examples", "benches"] {
                files.extend(sources(&folder.join(kind)).unwrap());
            }
        }
        let mut count = 0;
        for file in files {
            let text = fs::read_to_string(&file).unwrap();
            for line in text.lines().filter(|line| line.contains("cargo ")) {
                let words: Vec<&str> = line
                    .split(|c: char| !(c.is_alphanumeric() || matches!(c, '-' | '_')))
                    .collect();
                let after = |names: &[&str]| {
                    words.windows(2).find(|pair| names.contains(&pair[0])).map(|pair| pair[1])
                };
                let Some(name) = after(&["-p", "--package"]) else { continue };
                let folder = packages.get(name);
                let folder =
                    folder.unwrap_or_else(|| panic!("{}: no package {name}", file.display()));
                let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
                for (option, kind) in [("--test", "tests"), ("--example", "examples")] {
                    let Some(target) = after(&[option]).filter(|target| !target.is_empty()) else {
                        continue;
                    };
                    let stated = manifest.contains(&format!("]]\nname = \"{target}\"\n"));
                    let there = folder.join(kind).join(format!("{target}.rs")).is_file();
                    assert!(stated || there, "{}: {name} has no {kind} {target}", file.display());
                }
                count += 1;
            }
        }
        assert!(count >= 30, "{count}");
    }
}
