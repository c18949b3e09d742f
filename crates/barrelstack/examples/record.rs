//! A stack under a record, scaled, with a look at every twentieth of a second and its report as a page.
#![expect(clippy::print_stdout, reason = "a program for people at a terminal")]

use std::ops::ControlFlow;

use barrelstack::Scenario;
use barrelstack_motion::IntensityMeasure;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let record = barrelstack_motion::bundled("napa-college-2014").ok_or("it is bundled")?;
    let motion = record.default_motion()?.scale_to(IntensityMeasure::Pgv, 0.8)?;
    let scenario = Scenario::builtin("candia-8-barrels", &["run.duration=20 s".to_owned()])?;
    let run = scenario.run_on(motion.into(), &mut |progress| {
        println!("{:.1} of {:.1} s", progress.time, progress.end_time);
        ControlFlow::Continue(())
    })?;
    let page = barrelstack_report::html(&barrelstack::report::document(&run, &run.summary()));
    println!("{}: a report of {} bytes", run.outcome.kind(), page.len());
    Ok(())
}
