//! The scene on which five codes agree is the same, whether it is written in a file or built in code.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::f64::consts::TAU;

use barrelstack::Scenario;
use barrelstack::assemble::assemble;
use barrelstack_dynamics::{Method, Model, Planar, Scratch, Simulation, State, settle, simulate};
use barrelstack_validation::drive::Shake;
use barrelstack_validation::problems::consensus;

/// Returns time, poses, twists and the work after 2 s, when four barrels have fallen.
fn after(model: &Model<Planar>) -> (Vec<u64>, u64) {
    let (mut state, mut scratch) = (State::initial(model), Scratch::new(model));
    settle(model, &mut state, &mut scratch, 1e-9).unwrap();
    let drive = Shake::Swing { amplitude: 0.1016, omega: TAU / 1.0748 };
    let simulation =
        Simulation { method: Method::VelocityVerlet, time_step: 0.25e-3, end_time: 2.0 };
    simulate(model, &drive, &mut state, &mut scratch, &simulation, &mut ()).unwrap();
    let poses = state.poses.iter().flat_map(|p| [p.position.x, p.position.z, p.orientation]);
    let twists = state.twists.iter().flat_map(|t| [t.linear.x, t.linear.z, t.angular]);
    let all = poses.chain(twists).chain([state.time]);
    (all.map(f64::to_bits).collect(), scratch.contact_evaluations)
}

#[test]
fn the_scene_of_the_file_moves_as_the_one_in_code_bit_for_bit() {
    let text = include_str!("../cases/five-codes.toml");
    let scenario = Scenario::parse("five-codes.toml", text, &[]).unwrap();
    let written = assemble(&scenario).unwrap().model;
    let coded = consensus::eight_barrels(20.0).unwrap();
    for (one, other) in written.bodies().iter().zip(coded.bodies()) {
        assert_eq!((&one.name, one.mass, one.inertia), (&other.name, other.mass, other.inertia));
        assert_eq!(one.pose, other.pose, "{}", one.name);
        assert_eq!(one.surfaces.len(), other.surfaces.len(), "{}", one.name);
    }
    assert_eq!(after(&written), after(&coded));
}
