//! Stacks that meet nobody move as each does alone.

use barrelstack_cellar::Placed;
use barrelstack_space::Ground;

use crate::common::{demo, on, room};

#[test]
fn far_apart_each_stack_has_the_bits_of_the_stack_alone() {
    let scenario = demo(&["stack.levels=2", "run.duration=1 s"]);
    let turned = demo(&["stack.levels=2", "run.duration=1 s", "stack.azimuth=\"30 deg\""]);
    let mut stacks: Vec<Placed> = (0..3)
        .map(|at| Placed::new(&format!("S{at}"), scenario.clone(), [20.0 * f64::from(at), 1.3]))
        .collect();
    stacks[2].azimuth = 30_f64.to_radians();
    let run = on(2, &room(stacks));
    let ground = Ground::of(&turned).unwrap();
    for (stack, alone) in run.stacks.iter().zip([&scenario, &scenario, &turned]) {
        let go_on = &mut |_| std::ops::ControlFlow::Continue(());
        let own = if std::ptr::eq(alone, &raw const turned) {
            barrelstack_space::run::run_on(alone, ground.clone(), go_on).unwrap()
        } else {
            barrelstack_space::run::run(alone).unwrap()
        };
        let fates: Vec<_> = run.bodies[stack.bodies.clone()].iter().map(|body| body.fate).collect();
        assert_eq!(fates, own.fates[1..], "{}", stack.name);
        assert_eq!((stack.end_time, &stack.outcome), (own.end_time, &own.outcome));
        assert!(stack.touched.is_none() && !stack.knocked_over);
    }
    assert_eq!(run.merges, 0);
}

#[test]
fn merged_without_contact_each_stack_moves_as_alone() {
    let scenario = demo(&["stack.levels=2", "run.duration=2 s"]);
    let alone = barrelstack_space::run::run(&scenario).unwrap();
    // Equal stacks sway alike, so a gap of 3 mm between their racks, which are 1.498 m wide, stays open, but is too
    // small for two islands.
    let place = |at: u32| [1.501 * f64::from(at), 0.0];
    let stacks = (0..3).map(|at| Placed::new(&format!("S{at}"), scenario.clone(), place(at)));
    let run = on(1, &room(stacks.collect()));
    assert_eq!((run.merges, run.meetings.len()), (1, 0));
    let mut most = 0.0_f64;
    for stack in &run.stacks {
        for (body, own) in run.bodies[stack.bodies.clone()].iter().zip(&alone.fates[1..]) {
            most = most.max((body.fate.moved - own.moved).length());
        }
    }
    println!("largest difference after the merge {most:e} m");
    // Positions are in the frame of the first stack, so they are rounded otherwise: measured 7e-14.
    assert!(most < 1e-11, "{most:e}");
}
