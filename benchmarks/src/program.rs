//! Measures the demo as a user runs it: runs the command-line program as a process, and measures wall-clock times and
//! processor times.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::{Failure, time};

/// Environment variable that states the path of a program to measure; without it, the program is built.
const PROGRAM: &str = "BARRELSTACK_PROGRAM";

/// Text by which the line with the first verdict is recognized.
const FIRST: &str = "after the first";

/// Shortest times (s) of the demo: wall-clock times from the start of the command, and processor times.
pub(crate) struct Demo {
    /// Time until the first verdict is printed.
    pub(crate) first: f64,
    /// Time until the command ends without writing a page. The answer includes the change that would have prevented the
    /// collapse.
    pub(crate) answer: f64,
    /// Time until the command ends, if it writes a page.
    pub(crate) page: f64,
    /// Least processor time (s) of all cores together, without a page and with one.
    pub(crate) spent: [f64; 2],
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

/// Runs the demo `repeats` times without writing a page and as often with a page; returns the shortest times.
pub(crate) fn demo(program: &Path, repeats: usize) -> Result<Demo, Failure> {
    let folder = std::env::temp_dir().join(format!("barrelstack-bench-{}", std::process::id()));
    let out = folder.to_string_lossy().into_owned();
    let mut least = Demo {
        first: f64::INFINITY,
        answer: f64::INFINITY,
        page: f64::INFINITY,
        spent: [f64::INFINITY; 2],
    };
    for _ in 0..repeats {
        let answer = timed(program, &["run", "demo-napa"])?;
        let page = timed(program, &["run", "demo-napa", "--out", &out, "--overwrite"])?;
        for first in answer.first.into_iter().chain(page.first) {
            least.first = least.first.min(first);
        }
        least.answer = least.answer.min(answer.end);
        least.page = least.page.min(page.end);
        least.spent = [least.spent[0].min(answer.spent), least.spent[1].min(page.spent)];
    }
    // The folder holds only results that can be computed again.
    std::fs::remove_dir_all(&folder)?;
    Ok(least)
}

/// Returns the wall-clock time (s) and the processor time (s) of `barrelstack protect` on the demo.
pub(crate) fn protect(program: &Path) -> Result<(f64, f64), Failure> {
    let folder = std::env::temp_dir().join(format!("barrelstack-protect-{}", std::process::id()));
    let out = folder.to_string_lossy().into_owned();
    let times = timed(program, &["protect", "demo-napa", "--out", &out])?;
    std::fs::remove_dir_all(&folder)?;
    Ok((times.end, times.spent))
}

/// Times (s) of one command: the wall-clock times until the first verdict and until the end, and the processor time.
struct Times {
    first: Option<f64>,
    end: f64,
    spent: f64,
}

/// Runs the program.
fn timed(program: &Path, words: &[&str]) -> Result<Times, Failure> {
    let before = time::of_commands().unwrap_or(f64::NAN);
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
    let spent = time::of_commands().unwrap_or(f64::NAN) - before;
    Ok(Times { first, end: start.elapsed().as_secs_f64(), spent })
}
