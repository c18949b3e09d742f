//! Cases in lanes have the bits of single runs.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use std::num::NonZero;
use std::ops::ControlFlow;

use barrelstack::variants::planes;
use barrelstack_space::Ground;
use barrelstack_space::variants::{Case, run_each, run_each_alone};

use crate::common::soft_demo;

/// Racks and devices whose contacts differ in kind: tubes on staves and heads on the floor, feet, straps.
const STACKS: [&[&str]; 3] = [
    &["motion.scale.factor=2"],
    &["stack.rack=two-barrel-feet", "stack.levels=3"],
    &["stack.strap.levels=2", "stack.strap.ties=levels-together", "stack.strap.pretension='2 kN'"],
];

#[test]
fn cases_in_lanes_have_the_bits_of_single_runs() {
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    let (mut all, mut fallen) = (0, 0);
    for changes in STACKS {
        let changes = ["stack.view=spatial", "run.duration='4.6 s'"].iter().chain(changes);
        let changes: Vec<String> = changes.map(|&change| change.to_owned()).collect();
        let plane = planes(&soft_demo(&changes)).unwrap().remove(0);
        let ground = Ground::of(&plane.scenario).unwrap();
        // Every thread has enough cases for its lanes.
        let numbers: Vec<u32> = (1..=6 * u32::try_from(threads).unwrap()).collect();
        let build = |number: &u32| (plane.trial(*number), ground.clone());
        let texts =
            |cases: Vec<Case>| cases.iter().map(|case| format!("{case:?}")).collect::<Vec<_>>();
        let lanes = texts(run_each(&numbers, &build, &|_| ControlFlow::Continue(())));
        let single = texts(run_each_alone(&numbers, &build, &|_| ControlFlow::Continue(())));
        for ((lane, single), number) in lanes.iter().zip(&single).zip(&numbers) {
            assert!(lane == single, "variant {number} of {changes:?}");
        }
        all += single.len();
        fallen += single.iter().filter(|case| case.contains("Collapse")).count();
    }
    println!("{fallen} of {all} cases collapse");
    assert!(fallen > 0 && fallen < all, "{fallen} of {all}");
}
