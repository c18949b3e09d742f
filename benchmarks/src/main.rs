//! Benchmarks: one run, many runs in lanes, and game engines and a plain loop on the same scenes.
//!
//! ```sh
//! cargo xtask bench                     # all benchmarks; the last table compares targets with measurements
//! cargo xtask bench --cases 10000       # runs all 10,000 cases of the study, which takes minutes
//! cargo xtask bench table               # only the last table
//! cargo xtask bench table --protect     # with the command `protect`, which takes minutes
//! cargo xtask bench profile             # shares of time by phase of the step; needs `perf`
//! cargo xtask bench growth              # only the cost against the size
//! cargo xtask bench history             # counts of work of some runs, compared with the last release
//! cargo xtask bench history keep        # writes these counts to benchmarks/history.csv
//! ```
//!
//! One process measures all figures, so their ratios also hold on a busy machine. Times are
//! processor times if the operating system reports these, and apply to one core unless a table
//! states otherwise.

#![allow(clippy::disallowed_methods, reason = "measured times do not depend on the last bits of a sine")]

mod accuracy;
mod count;
mod growth;
mod history;
mod lanes;
mod memory;
mod peer;
mod peer3;
mod plain;
mod profile;
mod program;
mod scene;
mod space;
mod table;
mod time;
mod user;

use barrelstack_dynamics::Method;

type Failure = Box<dyn std::error::Error>;

/// Default number of cases that are run, out of the ten thousand of the study.
const CASES: usize = 128;

fn main() -> Result<(), Failure> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        [] => all(CASES),
        ["--cases", cases] => all(cases.parse().map_err(|_| "--cases: expected a number")?),
        ["table"] => table::print(CASES, false),
        ["table", "--protect"] => table::print(CASES, true),
        ["profile"] => profile::print(),
        ["work", kind] => profile::work(kind),
        ["growth"] => growth::with_size(),
        ["history"] => history::compare(false),
        ["history", "keep"] => history::compare(true),
        other => Err(format!(
            "cargo xtask bench: unknown argument `{}`; expected nothing, `--cases NUMBER`, `table`, \
             `table --protect`, `profile`, `growth`, `history` or `history keep`",
            other.join(" ")
        )
        .into()),
    }
}

fn all(cases: usize) -> Result<(), Failure> {
    let scene = scene::Scene::consensus(20.0)?;
    let step = accuracy::work_and_precision(&scene)?;
    println!();
    lanes::against_width(&scene, step);
    println!();
    count::per_step(&scene, Method::VelocityVerlet, step);
    println!();
    growth::with_size()?;
    println!();
    table::print(cases, false)
}
