//! Many cases together: the share of collapses against the friction under the racks, and all results as a table.
#![expect(clippy::print_stdout, reason = "an example that prints its result")]

use barrelstack::ensemble::{Ensemble, Prepared, table};
use barrelstack::{Scenario, outcome::Outcome};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut cases = Vec::new();
    for friction in 1..=16 {
        let friction = 0.05 * f64::from(friction);
        let change = format!("interface.rack-ground.friction.coefficient={friction:.2}");
        cases.push(Prepared::new(Scenario::builtin("candia-8-barrels", &[change])?)?);
    }
    let results = Ensemble { cases, ..Ensemble::default() }.run();
    let fell = |result: &_| matches!(result, Ok(Outcome::Collapse { .. }));
    let fallen = results.iter().filter(|result| fell(&result.outcome)).count();
    println!("{fallen} of {} came down\n", results.len());
    println!("{}", barrelstack_report::column::to_csv(&table(&results)));
    Ok(())
}
