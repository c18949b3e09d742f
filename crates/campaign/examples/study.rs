//! Runs a study in memory: stacks of several heights under one motion at three intensities.
#![expect(clippy::print_stdout, reason = "a program for people at a terminal")]

use barrelstack_campaign::Study;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let study = Study::parse(
        "heights.toml",
        r#"
        schema = 1
        [base]
        extends = "demo-napa"
        [base.stack]
        view = "longitudinal"
        [[factor]]
        field = "stack.levels"
        values = [2, 4, 6]
        [intensity]
        measure = "pgv"
        range = { from = "40 cm/s", to = "80 cm/s", count = 3 }
        [design]
        kind = "full-factorial"
        "#,
    )?;
    println!("{}", study.table()?.to_csv());
    Ok(())
}
