//! Stacks that touch each other.

use barrelstack_cellar::{Placed, Room, RoomRun};

use crate::common::{bits, demo, on, room};

/// Constants of the contact nodes of Candia et al. (2008), with which a stack falls within seconds.
const SOFT: [&str; 10] = [
    "interface.rack-ground.basis=node",
    "interface.rack-ground.stiffness=980 kN/m",
    "interface.rack-ground.damping=2200 N*s/m",
    "interface.rack-ground.friction.coefficient=0.5",
    "interface.rack-ground.friction.tangential_stiffness_ratio=1",
    "interface.barrel-rack.basis=node",
    "interface.barrel-rack.stiffness=980 kN/m",
    "interface.barrel-rack.damping=2200 N*s/m",
    "interface.barrel-rack.friction.coefficient=0.22",
    "interface.barrel-rack.friction.tangential_stiffness_ratio=1",
];

/// A high stack on soft seats between low ones.
fn crowd(seconds: &str, mirror: f64) -> Room {
    let duration = format!("run.duration={seconds} s");
    let mut high: Vec<&str> = SOFT.to_vec();
    high.extend(["stack.levels=5", duration.as_str()]);
    let (high, low) = (demo(&high), demo(&["stack.levels=2", &duration]));
    let low = |name: &str, x: f64, y: f64| Placed::new(name, low.clone(), [mirror * x, y]);
    room(vec![
        Placed::new("high", high, [0.0, 0.0]),
        low("right", 1.75, 0.0),
        low("left", -1.75, 0.0),
        low("behind", 0.1, 1.3),
        low("before", -0.1, -1.3),
    ])
}

fn show(run: &RoomRun) {
    for stack in &run.stacks {
        println!(
            "{}: {:?} at {:?}, touched {:?}, knocked over {}, {:?} at {:.3} s",
            stack.name,
            stack.outcome.kind(),
            stack.lost_seat,
            stack.touched,
            stack.knocked_over,
            stack.ending,
            stack.end_time
        );
    }
    let energy = run.energy.unwrap();
    println!("{} merges, {:?}, residual {:e}", run.merges, run.work, energy.residual_ratio());
}

#[test]
fn a_stack_that_falls_on_its_neighbors_is_the_first_and_they_are_touched() {
    let room = crowd("11", 1.0);
    let run = on(2, &room);
    show(&run);
    let [high, others] = [&run.stacks[..1], &run.stacks[1..]];
    let (fell, _) = high[0].lost_seat.unwrap();
    assert!(!high[0].knocked_over);
    let touched: Vec<_> = others.iter().filter_map(|stack| stack.touched).collect();
    assert!(!touched.is_empty());
    for touch in touched {
        assert!(touch.time > fell && touch.impulse > 0.0);
        assert_ne!(run.bodies[touch.body].stack, run.bodies[touch.by].stack);
    }
    for stack in others {
        let lost = stack.lost_seat.map(|(time, _)| time);
        let expected = lost.zip(stack.touched).is_some_and(|(lost, touch)| touch.time <= lost);
        assert_eq!(stack.knocked_over, expected);
    }
    assert!(run.energy.unwrap().residual_ratio() < 1e-3);
    // Threads and the order of the stacks change no bit.
    assert_eq!(bits(&run), bits(&on(1, &room)));
    let mut turned = room.clone();
    turned.stacks.reverse();
    assert_eq!(bits(&run), bits(&on(2, &turned)));
}
