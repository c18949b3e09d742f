//! Measures how fast a three-dimensional stack is computed on one core, relative to real time.
//!
//! ```text
//! cargo run --release -p barrelstack-space --example speed -- stack.levels=4
//! ```

#![allow(clippy::print_stdout, reason = "an example prints")]

use std::time::Instant;

use barrelstack::Scenario;
use barrelstack_space::run;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut changes = vec!["stack.view=spatial".to_owned()];
    changes.extend(std::env::args().skip(1));
    let scenario = Scenario::builtin("demo-napa", &changes)?;
    let start = Instant::now();
    let run = run::run(&scenario)?;
    let seconds = start.elapsed().as_secs_f64();
    let work = run.work;
    println!(
        "{}: {:?}, {:.1} s of motion in {seconds:.2} s: {:.1} times real time; {} steps of at most {:.3} ms, \
         {:.0} contact elements per step, {:.0} ns each; energy residual {:.1e}; settled in {:?} steps",
        scenario.title,
        run.outcome,
        run.end_time,
        run.end_time / seconds,
        work.steps,
        1e3 * run.stack.step,
        work.contact_evaluations as f64 / work.evaluations as f64,
        1e9 * seconds / work.contact_evaluations as f64,
        run.energy.map_or(f64::NAN, |energy| energy.residual_ratio()),
        run.settled.map(|settled| settled.steps),
    );
    Ok(())
}
