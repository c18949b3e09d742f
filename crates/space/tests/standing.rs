//! Three-dimensional stacks come to rest on seats that carry their weight, stay at rest, and conserve energy when
//! shaken.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use barrelstack::Scenario;
use barrelstack::assemble::PartKind;
use barrelstack_dynamics::{Method, Simulation, Still, evaluate, simulate};
use barrelstack_space::run::{Standing, stand};
use barrelstack_space::{Stack, run};

use crate::common::soft_demo;

fn demo(changes: &[&str]) -> Scenario {
    let all: Vec<String> =
        ["stack.view=spatial"].iter().chain(changes).map(|change| (*change).to_owned()).collect();
    soft_demo(&all)
}

/// Returns the upward force (N) on a body from all bodies that `by` selects.
fn borne(standing: &Standing, body: usize, by: impl Fn(usize) -> bool) -> f64 {
    let forces = standing.scratch.pair_forces.iter();
    forces
        .map(|force| match (force.contactor == body, force.target == body) {
            (true, _) if by(force.target) => force.force.z,
            (_, true) if by(force.contactor) => -force.force.z,
            _ => 0.0,
        })
        .sum()
}

#[test]
fn two_to_six_levels_settle_and_every_seat_bears_what_stands_on_it() {
    for levels in 2..=6 {
        let mut standing = stand(&demo(&[&format!("stack.levels={levels}")])).unwrap();
        let settled = standing.settled.unwrap();
        evaluate(&standing.stack.model, &standing.state, &mut standing.scratch);
        let bodies = standing.stack.model.bodies();
        let gravity = 9.80665;
        let above = |level: u32| -> f64 {
            let parts = standing.stack.parts.iter().zip(bodies);
            parts.filter(|(p, _)| p.level >= level.max(1)).map(|(_, b)| b.mass * gravity).sum()
        };
        let mut worst = 0.0_f64;
        for body in standing.stack.of_kind(PartKind::Rack) {
            let part = &standing.stack.parts[body];
            let on = |other: usize| other == Stack::GROUND || part.supports.contains(&other);
            let force = borne(&standing, body, on);
            worst = worst.max((force / above(part.level) - 1.0).abs());
        }
        println!("{levels} levels: {} steps, {worst:e} of the weight", settled.steps);
        assert!(worst < 1e-6, "{worst:e}"); // measured 3e-11
        // Four supports of a cradle carry each of the top barrels.
        for body in standing.stack.of_kind(PartKind::Barrel) {
            if standing.stack.parts[body].level == standing.stack.levels {
                let rack = standing.stack.parts[body].carrier.unwrap();
                let force = borne(&standing, body, |other| other == rack);
                assert!((force / (bodies[body].mass * gravity) - 1.0).abs() < 1e-6);
                let touched = standing.scratch.contacts.iter().filter(|contact| {
                    let pair = standing.stack.model.pair(contact.pair);
                    contact.touching && (pair.contactor == body || pair.target == body)
                });
                assert_eq!(touched.count(), 4);
            }
        }
    }
}

#[test]
fn racks_side_by_side_and_one_behind_the_other_stand_each_on_its_own() {
    let changes =
        ["stack.levels=2", "stack.columns=4", "stack.columns_along=2", "stack.gap='0.2 m'"];
    let mut standing = stand(&demo(&changes)).unwrap();
    evaluate(&standing.stack.model, &standing.state, &mut standing.scratch);
    let bodies = standing.stack.model.bodies();
    let names: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(standing.stack.of_kind(PartKind::Rack).count(), 8);
    assert_eq!(standing.stack.of_kind(PartKind::Barrel).count(), 16);
    assert!(names.contains(&"R2.2.1") && names.contains(&"B2.4.2"), "{names:?}");
    for rack in standing.stack.of_kind(PartKind::Rack) {
        let part = &standing.stack.parts[rack];
        let own = |barrel: &usize| standing.stack.parts[*barrel].carrier == Some(rack);
        let carried = standing.stack.of_kind(PartKind::Barrel).filter(own);
        let weight = 9.80665 * carried.map(|b| bodies[b].mass).sum::<f64>();
        let top = part.level == 2;
        let force = borne(&standing, rack, |other| part.supports.contains(&other));
        let expected = weight + 9.80665 * bodies[rack].mass;
        assert!(!top || (force / expected - 1.0).abs() < 1e-6, "{force} N of {expected} N");
        // Supports are the barrels of the rack below, which stand at its place.
        for barrel in &part.supports {
            let below = standing.state.poses[*barrel].position;
            let here = standing.state.poses[rack].position;
            assert!((here.x - below.x).abs() < 0.5 && (here.y - below.y).abs() < 0.1);
        }
    }
}

#[test]
fn a_row_that_differs_asks_for_steps_of_its_own_and_stands_where_it_was_put() {
    let changes = ["stack.levels=2", "stack.columns_along=2"];
    let other = "stack.override=[{ kind = \"rack\", level = 2, row = 1, mass = \"5 kg\" }, \
                 { kind = \"barrel\", level = 2, column = 1, row = 1, fill = \"empty\", offset_y = \"1 cm\" }]";
    let regular = Stack::of(&demo(&changes)).unwrap();
    let standing = stand(&demo(&[&changes[..], &[other]].concat())).unwrap();
    let named = |name: &str| standing.stack.parts.iter().position(|p| p.name == name).unwrap();
    let [light, beside, rack] = ["B2.1.1", "B2.1.2", "R2.1.1"].map(named);
    let bodies = standing.stack.model.bodies();
    assert!(bodies[light].mass < 0.2 * bodies[beside].mass);
    assert!((bodies[rack].mass - 5.0).abs() < 1e-12);
    println!("{} s in place of {} s", standing.stack.step, regular.step);
    assert!(standing.stack.step < 0.8 * regular.step); // measured 0.05 ms of 0.25 ms
    let moved = |body: usize| {
        standing.state.poses[body].position - regular.model.bodies()[body].pose.position
    };
    // It comes to rest in its cradle at an offset of 8.5 mm.
    assert!((moved(light).y - 0.01).abs() < 3e-3, "{:?}", moved(light));
    assert!(moved(beside).y.abs() < 1e-3, "{:?}", moved(beside));
}

#[test]
fn bodies_that_stand_in_each_other_are_refused_by_name() {
    let into =
        "stack.override=[{ kind = \"barrel\", level = 1, column = 1, offset_x = \"0.2 m\" }]";
    let error = stand(&demo(&["stack.levels=2", into])).unwrap_err().to_string();
    println!("{error}");
    assert!(error.contains("B1.1") && error.contains("overlap"), "{error}");
}

#[test]
fn what_has_come_to_rest_stays() {
    let mut standing = stand(&demo(&["stack.levels=4"])).unwrap();
    let before = standing.state.clone();
    let simulation = Simulation {
        method: Method::VelocityVerlet,
        time_step: standing.stack.step,
        end_time: 1.0,
    };
    let Standing { stack, state, scratch, .. } = &mut standing;
    simulate(&stack.model, &Still, state, scratch, &simulation, &mut ()).unwrap();
    let poses = state.poses.iter().zip(&before.poses);
    let moved = poses.map(|(a, b)| (a.position - b.position).length()).fold(0.0, f64::max);
    println!("moved {moved:e}");
    assert!(moved < 1e-9, "{moved:e}"); // measured 4e-13
}

#[test]
fn a_stack_that_is_shaken_keeps_its_energy_balance() {
    // While it stands, and after all has fallen and come to rest.
    for (end, most) in [("8.5 s", 1e-7), ("25 s", 1e-5)] {
        let duration = format!("run.duration='{end}'");
        let run = run::run(&demo(&["stack.levels=2", &duration])).unwrap();
        let missing = run.energy.unwrap().residual_ratio();
        println!("{:?} {missing:e} after {} s", run.outcome, run.end_time);
        // Measured 2e-8 and 2e-6.
        assert!(missing < most, "{missing:e}");
    }
}

#[test]
fn what_is_not_known_in_space_is_refused_with_its_field() {
    for (change, field) in [
        ("stack.rack=candia-2008", "stack.rack"),
        ("stack.rack=rack-on-rack", "stack.rack"),
        ("stack.rack=single-bar", "stack.rack.contact"),
        ("stack.rack=two-barrel-inclined", "stack.rack.incline"),
        ("stack.barrel.fill=part", "stack.barrel.fill"),
        ("run.similitude=0.5", "run.similitude"),
        (
            "stack.rack.cradle={type=\"arc\",radius=\"0.4 m\",half_angle=\"30 deg\"}",
            "stack.rack.cradle",
        ),
    ] {
        let error = Stack::of(&demo(&[change])).unwrap_err();
        println!("{error}");
        assert_eq!(error.fields(), [field], "{change}");
    }
    let two = demo(&["stack.columns=4", "stack.gap='1 cm'"]);
    assert_eq!(Stack::of(&two).unwrap_err().fields(), ["stack.gap"]);
    // Functions for plane models reject a three-dimensional stack.
    let error = demo(&[]).run().unwrap_err();
    assert_eq!(error.fields(), ["stack.view"], "{error}");
}

#[test]
fn the_forces_of_a_frame_carry_the_stack_below_its_center_of_mass() {
    let run = run::run(&demo(&["stack.levels=3", "run.duration=0.2 s"])).unwrap();
    let model = &run.stack.model;
    let others = (0..model.bodies().len()).filter(|body| *body != Stack::GROUND);
    let (mut weight, mut middle) = (0.0, [0.0; 2]);
    for body in others {
        let own = model.bodies()[body].mass * 9.80665;
        let [x, y, ..] = run.frames.poses[0][body];
        weight += own;
        middle = [middle[0] + own * x, middle[1] + own * y];
    }
    let grounded = |pair: usize| {
        let pair = model.pair(pair);
        pair.contactor == Stack::GROUND || pair.target == Stack::GROUND
    };
    let (mut borne, mut center) = (0.0, [0.0; 2]);
    for &(pair, [x, y, z, _, _, up]) in &run.frames.forces[0] {
        assert!(up > 0.0, "pair {pair} pushes down");
        if grounded(pair) {
            assert!(z.abs() < 0.01, "the floor presses at a height of {z} m");
            borne += up;
            center = [center[0] + up * x, center[1] + up * y];
        }
    }
    assert!((borne / weight - 1.0).abs() < 1e-4, "{borne} of {weight} N");
    for axis in 0..2 {
        let off = (center[axis] - middle[axis]) / weight;
        assert!(off.abs() < 1e-3, "the forces act {off} m beside the weight");
    }
    assert_eq!(run.frames.forces.len(), run.frames.times.len());
}
