//! A stack under user-supplied accelerations, scaled, with its response and its report as a page.
#![expect(clippy::print_stdout, reason = "an example that prints its result")]

use std::ops::ControlFlow;

use barrelstack::motion::{AccelerationUnit, Stage, bundled};
use barrelstack::{Record, Scenario, Summary, report};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Any samples will do; these are those of the bundled record.
    let own = &bundled("napa-college-2014").ok_or("it is bundled")?.channels[0];
    let (samples, unit) = (&own.acceleration[..], AccelerationUnit::MetersPerSecondSquared);
    let mut record = Record::of_samples("my site", &[("E", samples)], own.time_step, unit)?;
    // As recorded, so that the baseline drift is removed.
    record.stage = Stage::Raw;
    let changes = ["motion.scale.pgv=80 cm/s", "run.duration=20 s"].map(str::to_owned);
    let scenario = Scenario::builtin("candia-8-barrels", &changes)?.with_record(&record)?;
    let run = scenario.run_watched(&mut |progress| {
        println!("{:.1} of {:.1} s", progress.time, progress.end_time);
        ControlFlow::Continue(())
    })?;
    let page = barrelstack_report::html(&report::document(&run, &Summary::of(&run, None)));
    println!("{}: a report of {} bytes", run.outcome.kind(), page.len());
    Ok(())
}
