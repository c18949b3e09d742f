//! The demo as a user runs it: the released program as a process, by the clock.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::Failure;

/// Environment variable that states the path of a program to measure; without it, the program is built.
const PROGRAM: &str = "BARRELSTACK_PROGRAM";

/// Start of the line that reports the first verdict.
const FIRST: &str = "after the first";

/// Times (s) by the clock, from the start of the command.
pub(crate) struct Demo {
    /// The first sentence.
    pub(crate) first: f64,
    /// The whole answer, with the change that would have prevented the collapse.
    pub(crate) answer: f64,
    /// The same with a page: the end of the command.
    pub(crate) page: f64,
}

/// Returns the path of the program, which is built unless [`PROGRAM`] states a path.
pub(crate) fn path() -> Result<PathBuf, Failure> {
    if let Some(path) = std::env::var_os(PROGRAM) {
        return Ok(path.into());
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let built = Command::new("cargo")
        .args(["build", "--quiet", "--release", "--package", "barrelstack"])
        .current_dir(&root)
        .status()?;
    if !built.success() {
        return Err("the program could not be built".into());
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    Ok(target.join("release").join("barrelstack").with_extension(std::env::consts::EXE_EXTENSION))
}

/// Runs the demo `repeats` times without a page and with one; returns the smallest times.
pub(crate) fn demo(program: &Path, repeats: usize) -> Result<Demo, Failure> {
    let folder = std::env::temp_dir().join(format!("barrelstack-bench-{}", std::process::id()));
    let out = folder.to_string_lossy().into_owned();
    let mut least = Demo { first: f64::INFINITY, answer: f64::INFINITY, page: f64::INFINITY };
    for _ in 0..repeats {
        let (first, answer) = timed(program, &["run", "demo-napa"])?;
        let (early, page) = timed(program, &["run", "demo-napa", "--out", &out, "--overwrite"])?;
        let first = first.into_iter().chain(early).fold(f64::INFINITY, f64::min);
        least = Demo {
            first: least.first.min(first),
            answer: least.answer.min(answer),
            page: least.page.min(page),
        };
    }
    // The folder holds a copy of what anyone can compute.
    std::fs::remove_dir_all(&folder)?;
    Ok(least)
}

/// Returns the time (s) of `barrelstack protect` on the demo by the clock.
pub(crate) fn protect(program: &Path) -> Result<f64, Failure> {
    let folder = std::env::temp_dir().join(format!("barrelstack-protect-{}", std::process::id()));
    let out = folder.to_string_lossy().into_owned();
    let (_, all) = timed(program, &["protect", "demo-napa", "--out", &out])?;
    std::fs::remove_dir_all(&folder)?;
    Ok(all)
}

/// Runs the program; returns the times (s) of the first verdict and of the end.
fn timed(program: &Path, words: &[&str]) -> Result<(Option<f64>, f64), Failure> {
    let start = Instant::now();
    let mut child = Command::new(program)
        .args(words)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("{}: {error}", program.display()))?;
    let (mut first, mut said) = (None, Vec::new());
    for line in BufReader::new(child.stderr.take().ok_or("no messages")?).lines() {
        let line = line?;
        if first.is_none() && line.contains(FIRST) {
            first = Some(start.elapsed().as_secs_f64());
        }
        said.push(line);
    }
    if !child.wait()?.success() {
        return Err(format!("barrelstack {}: {}", words.join(" "), said.join("\n")).into());
    }
    Ok((first, start.elapsed().as_secs_f64()))
}
