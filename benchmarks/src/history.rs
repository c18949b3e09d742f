//! Counts of the work that a few runs take, compared with the counts of the last release.
//!
//! The counts do not depend on the machine, so added work shows on every machine. Cases and counts
//! are taken from two test suites: `crates/barrelstack/tests/golden` for whole runs, and
//! `crates/validation/tests/arithmetic.rs` for single steps.

#[path = "../../crates/validation/tests/arithmetic.rs"]
#[allow(dead_code, reason = "its test runs in its own crate")]
mod arithmetic;
#[path = "../../crates/barrelstack/tests/golden/mod.rs"]
#[allow(dead_code, reason = "the comparison of bits is used in its own crate")]
mod golden;

use std::path::Path;

use crate::{Failure, time};

/// File that keeps the counts of every release.
const FILE: &str = "history.csv";

/// Header line of the file [`FILE`].
const HEAD: &str = "version,case,count,value";

/// One count of one case.
struct Count {
    case: String,
    count: &'static str,
    value: u64,
}

/// Prints the present counts beside the last counts in the file, and the number of counts that
/// differ.
///
/// With `keep`, the present counts are added to the file under the present version.
pub(crate) fn compare(keep: bool) -> Result<(), Failure> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(FILE);
    let kept = std::fs::read_to_string(&path).unwrap_or_else(|_| format!("{HEAD}\n"));
    let rows: Vec<Vec<&str>> = kept.lines().skip(1).map(|row| row.split(',').collect()).collect();
    if let Some(at) = rows.iter().position(|row| row.len() != 4 || row[3].parse::<u64>().is_err()) {
        let line = at + 2;
        return Err(format!("{}, line {line}: expected {HEAD}", path.display()).into());
    }
    let version = format!("{} bits {}", release()?, golden::VERSION);
    let now = counts();
    println!("{:30} {:22} {:>14} {:>14}  {:>8}  since", "case", "count", "now", "last", "change");
    let mut changed = 0;
    for Count { case, count, value } in &now {
        let last = rows.iter().rev().find(|row| row[1] == case && row[2] == *count);
        let (last, since) = last.map_or((None, ""), |row| (row[3].parse::<u64>().ok(), row[0]));
        changed += usize::from(last.is_some_and(|last| last != *value));
        let change = last.map_or(String::new(), |last| {
            format!("{:+.2} %", 100.0 * (*value as f64 / last as f64 - 1.0))
        });
        let last = last.map_or("none".to_owned(), |last| last.to_string());
        println!("{case:30} {count:22} {value:14} {last:>14}  {change:>8}  {since}");
    }
    println!("{changed} of {} counts differ from the last counts in the file", now.len());
    if now.iter().all(|count| count.count != "instructions") {
        println!("(this machine or its operating system does not let programs count instructions)");
    }
    if keep {
        let others = rows.iter().filter(|row| row[0] != version).map(|row| row.join(","));
        let own = now
            .iter()
            .map(|Count { case, count, value }| format!("{version},{case},{count},{value}"));
        let lines: Vec<String> =
            std::iter::once(HEAD.to_owned()).chain(others).chain(own).collect();
        std::fs::write(&path, lines.join("\n") + "\n")?;
        println!("written to {} as the counts of version {version}", path.display());
    }
    Ok(())
}

/// Returns the version of the workspace, which is read from its manifest because this program is
/// not a member of the workspace.
fn release() -> Result<String, Failure> {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
    let text = std::fs::read_to_string(&manifest)?;
    let version =
        text.lines().find_map(|line| line.strip_prefix("version = \"")?.strip_suffix('"'));
    Ok(version.ok_or("Cargo.toml: expected a line `version = \"…\"`")?.to_owned())
}

fn counts() -> Vec<Count> {
    let mut counts = Vec::new();
    let mut add = |case: &str, count, value| {
        counts.push(Count { case: case.to_owned(), count, value });
    };
    for line in golden::Table::now().lines {
        add(&line.name, "steps", line.work.steps);
        // Runs in lanes do not count their evaluations.
        if line.work.evaluations > 0 {
            add(&line.name, "evaluations", line.work.evaluations);
            add(&line.name, "contact evaluations", line.work.contact_evaluations);
        }
    }
    if let Some(instructions) = time::instructions(|| drop(golden::Table::now())) {
        add("all of these", "instructions", instructions);
    }
    for (scene, method, [touching, plain, divisions, choices]) in arithmetic::now() {
        let case = format!("step of {scene} by {}", method.name());
        add(&case, "touching nodes", touching);
        add(&case, "plain operations", plain);
        add(&case, "divisions", divisions);
        add(&case, "choices", choices);
    }
    counts
}
