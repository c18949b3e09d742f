//! How fast stacks are computed: one run, many in lanes, and a game engine on the same scenes.
//!
//! ```sh
//! cargo xtask bench                     # all of it; the last table says what was promised and what is
//! cargo xtask bench --cases 10000       # the study of that many cases in full, which takes minutes
//! cargo xtask bench table               # the last table alone
//! cargo xtask bench growth              # cost against size alone
//! cargo xtask bench history             # the work of some runs beside that of the last release
//! cargo xtask bench history keep        # writes it down in benchmarks/history.csv
//! ```
//!
//! All figures are of one process, so that their ratios hold on a machine that others use, too;
//! times are those the processor spent on it where the system tells them, and of one core where
//! nothing else is said.

mod accuracy;
mod count;
mod growth;
mod history;
mod lanes;
mod memory;
mod peer;
mod scene;
mod table;
mod time;
mod user;

use barrelstack_dynamics::Method;

type Failure = Box<dyn std::error::Error>;

/// Cases of the study of ten thousand that are run where nothing else is said.
const CASES: usize = 128;

fn main() -> Result<(), Failure> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        [] => all(CASES),
        ["--cases", cases] => all(cases.parse().map_err(|_| "--cases: expected a number")?),
        ["table"] => table::print(CASES),
        ["growth"] => growth::with_size(),
        ["history"] => history::compare(false),
        ["history", "keep"] => history::compare(true),
        other => Err(format!(
            "cargo xtask bench: there is no `{}`; expected nothing, `--cases NUMBER`, `table`, `growth`, \
             `history` or `history keep`",
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
    table::print(cases)
}
