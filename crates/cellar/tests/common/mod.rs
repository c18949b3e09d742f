//! Rooms for tests.

use std::ops::ControlFlow;

use barrelstack::Scenario;
use barrelstack_cellar::{Placed, Room, RoomRun, Settings, run};
use barrelstack_space::Ground;

/// Returns the three-dimensional demo with changes.
pub(crate) fn demo(changes: &[&str]) -> Scenario {
    let changes: Vec<String> =
        ["stack.view=spatial"].iter().chain(changes).map(|&change| change.to_owned()).collect();
    Scenario::builtin("demo-napa", &changes).unwrap()
}

/// Returns a room under the motion of its first stack.
pub(crate) fn room(stacks: Vec<Placed>) -> Room {
    let ground = Ground::of_spec(&stacks[0].scenario.motion, 1.0).unwrap();
    Room { stacks, obstacles: Vec::new(), ground }
}

/// Runs a room on a number of threads.
pub(crate) fn on(threads: usize, room: &Room) -> RoomRun {
    let settings = Settings { threads, ..Settings::default() };
    run(room, &settings, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// Name of a stack, bits of its poses, of the impulse on it and of its loss of a seat, and whether it was knocked over.
type StackBits = (String, Vec<[u64; 14]>, Option<u64>, Option<u64>, bool);

/// Returns everything of a run that must not depend on threads or on the order of the stacks, stack by stack in the
/// order of their names.
pub(crate) fn bits(run: &RoomRun) -> Vec<StackBits> {
    let number = |x: f64| x.to_bits();
    let mut all: Vec<StackBits> = run
        .stacks
        .iter()
        .map(|stack| {
            let poses = run.bodies[stack.bodies.clone()].iter().map(|body| {
                let mut both = [0; 14];
                for (bits, x) in both.iter_mut().zip(body.own.iter().chain(&body.to)) {
                    *bits = number(*x);
                }
                both
            });
            let touched = stack.touched.map(|touch| number(touch.impulse));
            let lost = stack.lost_seat.map(|(time, _)| number(time));
            (stack.name.clone(), poses.collect(), touched, lost, stack.knocked_over)
        })
        .collect();
    all.sort();
    all
}
