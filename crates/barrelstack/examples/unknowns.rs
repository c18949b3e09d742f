//! Compares the stated range over uncertain constants with shares under known constants: `cargo run --release -p barrelstack-library
//! --example unknowns -- TRUTHS`.
//!
//! The constants are drawn from their distributions many times. For each draw, 64 stacks that differ only in positions
//! and masses are shaken; the share that falls is the true share for these constants, up to the sampling error of 64
//! stacks. The stated range comes from the usual 64 variants, whose constants are drawn independently.
#![expect(clippy::print_stdout, reason = "a program for people at a terminal")]

use std::ops::ControlFlow;

use barrelstack::variants::{self, Variants};
use barrelstack::{Scenario, scenario::View};

/// Stacks: name in the table, and changes to the demo.
const STACKS: [(&str, &[&str]); 3] = [
    ("five levels", &[]),
    ("three levels", &["stack.levels=3"]),
    ("five levels, half the motion", &["motion.scale.factor=0.5"]),
];

fn run(changes: &[String]) -> Result<Vec<Variants>, Box<dyn std::error::Error>> {
    let scenario = Scenario::builtin("demo-napa", changes)?;
    let planes = variants::planes(&scenario)?;
    let found = variants::run(&planes, &|_, _| ControlFlow::Continue(()))?;
    found.ok_or_else(|| "stopped".into())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let truths: u32 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(40);
    println!(
        "| stack | plane | stated range | true shares: least, quarters, greatest | in the range |"
    );
    println!("|---|---|---|---|---|");
    for (name, changes) in STACKS {
        let own = |more: Vec<String>| {
            changes.iter().map(|&change| change.to_owned()).chain(more).collect::<Vec<_>>()
        };
        let stated = run(&own(Vec::new()))?;
        let mut shares = vec![Vec::new(); stated.len()];
        for truth in 1..=truths {
            // The constants, but not the positions and masses, are those of a variant drawn with another seed.
            let draw = own(vec![
                "imperfections.drawn=false".to_owned(),
                "imperfections.seed=1000".to_owned(),
            ]);
            let scenario = Scenario::builtin("demo-napa", &draw)?;
            let planes = variants::planes(&scenario)?;
            let constants = planes.first().map(|plane| plane.variant(truth));
            let settings = constants.map(|one| one.settings()).unwrap_or_default();
            let drawn = settings
                .iter()
                .filter(|one| one.path.starts_with("interface.") && !one.path.ends_with("basis"))
                .filter(|one| {
                    ["coefficient", "stiffness", "restitution"]
                        .iter()
                        .any(|end| one.path.ends_with(&format!(".{end}")))
                })
                .map(|one| format!("{}={}", one.path, one.value));
            let places = ["unknowns.drawn=false".to_owned(), format!("imperfections.seed={truth}")];
            let found = run(&own(drawn.chain(places).collect()))?;
            for (shares, one) in shares.iter_mut().zip(&found) {
                shares.extend(one.spread.share);
            }
        }
        for (one, mut shares) in stated.iter().zip(shares) {
            let Some([low, high]) = one.spread.range else { continue };
            let held = shares.iter().filter(|share| low <= **share && **share <= high).count();
            shares.sort_by(f64::total_cmp);
            let at = |part: usize| 100.0 * shares[(shares.len() - 1) * part / 4];
            println!(
                "| {name} | {} | {:.0} to {:.0} % | {:.0}, {:.0}, {:.0}, {:.0}, {:.0} % | {held} of {} |",
                one.view.map_or("", View::words),
                100.0 * low,
                100.0 * high,
                at(0),
                at(1),
                at(2),
                at(3),
                at(4),
                shares.len()
            );
        }
    }
    Ok(())
}
