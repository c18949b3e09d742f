//! Stacks that touch each other.

use barrelstack_cellar::{Advance, Placed, Room, RoomRun, Settings, run};

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
    // measured 3.9e-7
    assert!(run.energy.unwrap().residual_ratio() < 1e-5);
    // The result is bit-identical for any number of threads and any order of the stacks.
    assert_eq!(bits(&run), bits(&on(1, &room)));
    let mut turned = room;
    turned.stacks.reverse();
    assert_eq!(bits(&run), bits(&on(2, &turned)));
}

/// Returns a room after a shock: its stacks start where their bodies ended.
fn after(room: &Room, run: &RoomRun) -> Room {
    let mut next = room.clone();
    for (placed, stack) in next.stacks.iter_mut().zip(&run.stacks) {
        let own = run.bodies[stack.bodies.clone()].iter().map(|body| body.own);
        placed.start = Some(own.collect());
    }
    next
}

#[test]
fn a_second_shock_starts_from_the_stated_displacements() {
    let scenario = demo(&["stack.levels=3", "run.duration=4 s"]);
    let places = [0.0, 1.55, 4.0];
    let stack = |x: f64| Placed::new(&format!("at {x}"), scenario.clone(), [x, 0.0]);
    let room = room(places.map(stack).to_vec());
    let first = on(2, &room);
    let mut second = after(&room, &first);
    // The same displacements as a file states them.
    let mut stated = second.clone();
    for pose in stated.stacks.iter_mut().flat_map(|stack| stack.start.iter_mut().flatten()) {
        *pose = pose.map(|x| x.to_string().parse().unwrap());
    }
    for room in [&mut second, &mut stated] {
        room.ground = room.ground.scaled(0.5);
    }
    let runs = [on(1, &second), on(2, &stated)];
    assert_eq!(bits(&runs[0]), bits(&runs[1]));
    // On ground at rest, the bodies stay in these poses, except that a rack turns slightly until its sticking contacts
    // bear again.
    let mut still = second;
    still.ground = still.ground.scaled(0.0);
    let run = on(2, &still);
    let displacement = |(from, to): (&[f64; 7], &[f64; 7])| {
        (0..3).map(|at| (to[at] - from[at]).powi(2)).sum::<f64>().sqrt()
    };
    let ends = run.bodies.iter().zip(&first.bodies);
    let most = ends.map(|(to, from)| displacement((&from.own, &to.own))).fold(0.0, f64::max);
    println!("largest displacement on ground at rest {most:e} m");
    // measured 0.7 mm
    assert!(most < 2e-3, "{most:e}");
}

#[test]
fn hostile_rooms_are_refused_with_a_reason() {
    let scenario = demo(&["stack.levels=1", "run.duration=0.1 s"]);
    let failure = |room: &Room| {
        let go_on = &mut |_: &Advance| std::ops::ControlFlow::Continue(());
        run(room, &Settings::default(), go_on).unwrap_err().to_string()
    };
    let stack = |name: &str, x: f64| Placed::new(name, scenario.clone(), [x, 0.0]);
    let overlap = failure(&room(vec![stack("A", 0.0), stack("B", 0.5)]));
    assert!(overlap.contains("overlap by") && overlap.contains("move them apart"), "{overlap}");
    let twins = failure(&room(vec![stack("A", 0.0), stack("A", 5.0)]));
    assert!(twins.contains("are named \"A\""), "{twins}");
    let mut short = stack("A", 0.0);
    short.start = Some(vec![[0.0; 7]]);
    let short = failure(&room(vec![short]));
    assert!(short.contains("1 poses"), "{short}");
    let mut many = room(vec![stack("A", 0.0)]);
    many.stacks.resize(20_000, stack("A", 0.0));
    assert!(failure(&many).contains("at most 30000 are allowed"));
    let mut empty = room(vec![stack("A", 0.0)]);
    empty.stacks.clear();
    assert!(failure(&empty).contains("no stack"));
}

#[test]
fn the_observer_may_stop_a_run() {
    let room = room(vec![Placed::new("A", demo(&["stack.levels=2"]), [0.0, 0.0])]);
    let run = run(&room, &Settings::default(), &mut |now| {
        if now.time > 0.0 {
            std::ops::ControlFlow::Break(())
        } else {
            std::ops::ControlFlow::Continue(())
        }
    });
    let run = run.unwrap();
    assert!(run.interrupted && run.end_time < 60.0);
    assert_eq!(run.stacks[0].outcome.kind(), "interrupted");
}
