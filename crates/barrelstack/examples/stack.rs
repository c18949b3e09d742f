//! A stack of wine barrels, shaken by a sine.
#![expect(clippy::print_stdout, reason = "an example that prints its result")]

use barrelstack::Scenario;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let run = Scenario::from_str(
        r#"
        schema = 1
        [stack]
        levels = 4
        columns = 2
        [motion.sine]
        amplitude = "10 cm"
        period = "0.8 s"
        cycles = 5
        "#,
    )?
    .run()?;
    println!("{} after {:.2} s", run.outcome.kind(), run.end_time);
    Ok(())
}
