//! Stacks that stand far apart move as each does alone.

use std::ops::ControlFlow;

use barrelstack::Scenario;
use barrelstack_cellar::{Placed, Room, Settings, run};
use barrelstack_space::Ground;

#[test]
fn far_apart_each_stack_has_the_bits_of_the_stack_alone() {
    let changes = ["stack.view=spatial", "stack.levels=2", "run.duration=1 s"].map(str::to_owned);
    let scenario = Scenario::builtin("demo-napa", &changes).unwrap();
    let alone = barrelstack_space::run::run(&scenario).unwrap();
    let ground = Ground::of_spec(&scenario.motion, 1.0).unwrap();
    let stack = |name: &str, x: f64| Placed::new(name, scenario.clone(), [x, 1.3]);
    let room =
        Room { stacks: vec![stack("A", 0.0), stack("B", 20.0)], obstacles: Vec::new(), ground };
    let run = run(&room, &Settings::default(), &mut |_| ControlFlow::Continue(())).unwrap();
    for stack in &run.stacks {
        let fates: Vec<_> = run.bodies[stack.bodies.clone()].iter().map(|body| body.fate).collect();
        assert_eq!(fates, alone.fates[1..], "{}", stack.name);
        assert_eq!(stack.end_time, alone.end_time);
    }
}
