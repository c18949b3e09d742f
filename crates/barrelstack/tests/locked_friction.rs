//! Dependence of locked friction on the settling history, and its effects.
#![expect(clippy::print_stdout, reason = "the table that validation/README.md shows")]

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use barrelstack::Scenario;
use barrelstack::assemble::{Assembly, assemble};
use barrelstack_dynamics::{
    Body, FrictionLaw, Interface, Method, Model, Planar, Scratch, Simulation, State, Still, look,
    settle, simulate,
};

/// A method of settling.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// As in runs: gravity acts on all bodies at once, and overshoot dies out quickly.
    AtOnce,
    /// Gravity grows in a number of increments; the stack comes to rest after each.
    Growing(u32),
    /// Level by level: a level is almost weightless until all levels below have settled.
    LevelByLevel,
    /// With the real equations of motion, damped at a rate of 5 1/s.
    Swinging,
    /// Without friction while the stack settles; friction acts only afterwards.
    Smooth,
}

/// Returns the model with other masses, friction and gravity.
fn changed(
    assembly: &Assembly,
    body: impl Fn(usize, &Body<Planar>) -> Body<Planar>,
    friction: bool,
    gravity: f64,
) -> Model<Planar> {
    let model = &assembly.model;
    let bodies = model.bodies().iter().enumerate().map(|(i, b)| body(i, b)).collect();
    let law = |interface: &Interface<Planar>| {
        let kept = interface.friction;
        let friction = if friction { kept } else { FrictionLaw::Frictionless };
        Interface { friction, ..interface.clone() }
    };
    let interfaces = model.interfaces().iter().map(law).collect();
    Model::new(bodies, interfaces, model.pairs().collect(), model.gravity() * gravity).unwrap()
}

fn settled(assembly: &Assembly, way: Way) -> (State<Planar>, Scratch<Planar>) {
    let model = &assembly.model;
    let mut state = State::initial(model);
    let mut scratch = Scratch::new(model);
    let same = |_: usize, body: &Body<Planar>| body.clone();
    let mut part = |model: &Model<Planar>| {
        settle(model, &mut state, &mut Scratch::new(model), 1e-9).unwrap();
    };
    match way {
        Way::AtOnce => {}
        Way::Growing(parts) => {
            for i in 1..parts {
                part(&changed(assembly, same, true, f64::from(i) / f64::from(parts)));
            }
        }
        Way::LevelByLevel => {
            let levels = assembly.parts.iter().filter_map(|part| part.level).max().unwrap();
            for level in 1..levels {
                let light = |i: usize, body: &Body<Planar>| {
                    let above = assembly.parts[i].level.is_some_and(|l| l > level);
                    let share = if above { 1e-3 } else { 1.0 };
                    let (mass, inertia) = (share * body.mass, share * body.inertia);
                    Body { mass, inertia, ..body.clone() }
                };
                part(&changed(assembly, light, true, 1.0));
            }
        }
        Way::Swinging => {
            let damped = |_: usize, b: &Body<Planar>| {
                let (m, i) = (5.0 * b.mass, 5.0 * b.inertia);
                Body { damping: Some([[m, 0.0, 0.0], [0.0, m, 0.0], [0.0, 0.0, i]]), ..b.clone() }
            };
            let model = changed(assembly, damped, true, 1.0);
            let simulation = Simulation {
                method: Method::VelocityVerlet,
                time_step: assembly.step,
                end_time: 10.0,
            };
            let mut scratch = Scratch::new(&model);
            simulate(&model, &Still, &mut state, &mut scratch, &simulation, &mut ()).unwrap();
            state.time = 0.0;
        }
        Way::Smooth => part(&changed(assembly, same, false, 1.0)),
    }
    settle(model, &mut state, &mut scratch, 1e-9).unwrap();
    (state, scratch)
}

fn drop_of(
    from: &barrelstack_dynamics::Pose<Planar>,
    to: &barrelstack_dynamics::Pose<Planar>,
) -> f64 {
    from.position.z - to.position.z
}

/// Returns the time (s) at which the first body falls.
fn first_fall(scenario: &Scenario, assembly: &Assembly, rest: &State<Planar>) -> f64 {
    let ground = scenario.ground().unwrap();
    let simulation =
        Simulation { method: Method::VelocityVerlet, time_step: assembly.step, end_time: 15.0 };
    let (mut state, mut scratch) = (rest.clone(), Scratch::new(&assembly.model));
    let falls = |(from, to): (&_, &_)| drop_of(from, to) > 0.2;
    let mut first_fall = look(|state: &State<Planar>, _, _| {
        let fallen = rest.poses.iter().zip(&state.poses).any(falls);
        if fallen { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let (model, observer) = (&assembly.model, &mut first_fall);
    simulate(model, &ground, &mut state, &mut scratch, &simulation, observer).unwrap();
    state.time
}

type NodeForces = BTreeMap<(usize, u32), f64>;

fn node_forces(scratch: &Scratch<Planar>) -> NodeForces {
    scratch.contacts.iter().map(|c| ((c.pair, c.node), c.normal_force)).collect()
}

/// Returns the largest difference of a node's force, as a share of the largest of all.
fn farthest(a: &NodeForces, b: &NodeForces) -> f64 {
    let of = |forces: &NodeForces, key| forces.get(key).copied().unwrap_or(0.0);
    let apart = a.keys().chain(b.keys()).map(|key| (of(a, key) - of(b, key)).abs());
    apart.fold(0.0, f64::max) / a.values().copied().fold(0.0, f64::max)
}

/// Returns friction as a share of the normal forces.
fn locked(scratch: &Scratch<Planar>) -> f64 {
    let (friction, normal) = scratch
        .contacts
        .iter()
        .fold((0.0, 0.0), |sum, c| (sum.0 + c.friction_force.abs(), sum.1 + c.normal_force));
    friction / normal
}

fn compare(name: &str, ways: &[Way], runs: bool) -> Vec<(Way, f64, f64, f64)> {
    let along = (name == "demo-napa").then(|| "stack.view=longitudinal".to_owned());
    let scenario = Scenario::builtin(name, &Vec::from_iter(along)).unwrap();
    let assembly = assemble(&scenario).unwrap();
    let usual = node_forces(&settled(&assembly, Way::AtOnce).1);
    let mut rows = Vec::new();
    for way in ways {
        let (state, scratch) = settled(&assembly, *way);
        let apart = farthest(&usual, &node_forces(&scratch));
        let fall = if runs { first_fall(&scenario, &assembly, &state) } else { f64::NAN };
        let share = locked(&scratch);
        println!(
            "| {name} | {way:?} | {:.2} % | {:.2} % | {fall:.3} s |",
            100.0 * share,
            100.0 * apart
        );
        rows.push((*way, share, apart, fall));
    }
    rows
}

#[test]
fn a_stack_at_rest_at_once_bears_what_it_bears_under_gravity_that_grows() {
    for (way, _, apart, _) in compare("candia-8-barrels", &[Way::Growing(20)], false) {
        assert!(apart < 0.02, "{way:?}: {apart}");
    }
}

#[test]
#[ignore = "the table of validation/README.md, with a run for every way"]
fn ways_to_come_to_rest() {
    let ways = [
        Way::AtOnce,
        Way::Growing(10),
        Way::Growing(100),
        Way::LevelByLevel,
        Way::Swinging,
        Way::Smooth,
    ];
    for name in ["candia-8-barrels", "candia-8-barrels-longitudinal", "demo-napa"] {
        compare(name, &ways, true);
    }
}
