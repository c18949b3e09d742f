//! Runs the built program as a user does.

#![allow(clippy::print_stdout, reason = "messages are shown with --nocapture")]

use std::ffi::OsStr;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Two barrels on two levels; the duration of shaking is appended.
pub(crate) const HEAD: &str = "\
schema = 1
title = \"two barrels for a moment\"
[base.stack]
levels = 2
columns = 2
[base.run]
";

/// Forty short cases in ten chunks, after [`HEAD`].
pub(crate) const STUDY: &str = "\
duration = \"0.4 s\"
[base.motion.pulse]
kind = \"one-sine\"
amplitude = \"1 g\"
period = \"0.3 s\"
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
range = { from = 0.2, to = 0.6, count = 10 }
[[factor]]
field = \"motion.pulse.amplitude\"
values = [\"0.3 g\", \"0.6 g\", \"0.9 g\", \"1.2 g\"]
[design]
kind = \"full-factorial\"
chunk = 4
";

/// Reports a skipped test.
pub(crate) fn skipped(why: &str) {
    // Write to the terminal directly: the runner captures `print!` of passing tests.
    std::io::stdout().write_all(format!("skipped: {why}\n").as_bytes()).unwrap();
}

/// `true` if an external program works; otherwise reports a skipped test.
pub(crate) fn there(command: &str, arguments: &[&str]) -> bool {
    let found = Command::new(command).args(arguments).output().is_ok_and(|o| o.status.success());
    if !found {
        skipped(&format!("{command} {arguments:?} does not answer"));
    }
    found
}

/// Returns the program, with empty standard input.
pub(crate) fn program<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_barrelstack"));
    command.args(arguments).stdin(Stdio::null());
    // Pages are the same on every day and at every commit.
    command.env("SOURCE_DATE_EPOCH", "1408875644").env("BARRELSTACK_COMMIT", "0123456789ab");
    command
}

/// Runs the program to its end.
pub(crate) fn barrelstack<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Output {
    program(arguments).output().unwrap()
}

/// Returns standard output.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// Returns standard error.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Returns the entries of a folder, sorted; `None` if there is no folder.
pub(crate) fn names(folder: &Path) -> Option<Vec<String>> {
    let entries = std::fs::read_dir(folder).ok()?;
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    Some(names)
}

/// Checks the response to a mistake: one error with the usual prefix that contains all of `words`, status 2,
/// nothing on standard output, nothing written to `out`.
pub(crate) fn refused(what: &str, output: &Output, out: &Path, words: &[&str]) {
    let message = stderr(output);
    println!("---- {what}\n{message}");
    assert_eq!(output.status.code(), Some(2), "{what}: {message}");
    assert_eq!(stdout(output), "", "{what}");
    assert!(message.starts_with("error: "), "{what}: {message}");
    assert_eq!(message.matches("error:").count(), 1, "{what}: {message}");
    assert!(!message.contains("warning:"), "{what}: {message}");
    assert!(!message.contains("panicked"), "{what}: {message}");
    let strange = message.chars().find(|c| c.is_control() && *c != '\n');
    assert_eq!(strange, None, "{what}: {message:?}");
    for word in words {
        assert!(message.contains(word), "{what}: no {word:?} in {message}");
    }
    assert_eq!(names(out), None, "{what}: {}", out.display());
}
