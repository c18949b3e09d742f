//! Exact numbers of arithmetic operations per step, which depend neither on the machine nor on its load.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use barrelstack::Scenario;
use barrelstack::assemble::assemble;
use barrelstack_dynamics::lanes::Case;
use barrelstack_dynamics::{Method, Model, Planar, Scratch, State, settle};
use barrelstack_validation::counting::{Operations, Work};
use barrelstack_validation::drive::Shake;
use barrelstack_validation::problems::consensus;

/// Recorded cost of a step: scene, method, touching nodes, and operations.
///
/// Record smaller numbers here; larger ones need a reason in the commit message.
const KNOWN: [(&str, Method, [u64; 4]); 4] = [
    ("five codes", Method::VelocityVerlet, [24, 5826, 71, 1547]),
    ("five codes", Method::SemiImplicitEuler, [24, 5607, 71, 1535]),
    ("five codes", Method::RungeKutta4, [24, 20763, 275, 5069]),
    ("paper", Method::VelocityVerlet, [80, 14414, 175, 5162]),
];

/// Number of steps that are averaged, in which the stack rocks and nothing falls.
const STEPS: u64 = 1000;

/// The ground motion of the paper's benchmark, reduced so that both stacks stand.
const GROUND: Shake = Shake::Swing { amplitude: 0.05, omega: 5.846 };

#[test]
#[allow(clippy::print_stdout, reason = "the counts, to be written down when they get smaller")]
fn a_step_takes_no_more_arithmetic_than_it_did() {
    let now = now();
    println!("touching nodes, plain operations, divisions, choices: {now:#?}");
    assert_eq!(now, KNOWN);
}

/// Returns the present cost of a step, as in [`KNOWN`].
pub(crate) fn now() -> [(&'static str, Method, [u64; 4]); 4] {
    let five_codes = consensus::eight_barrels(20.0).unwrap();
    let paper = assemble(&Scenario::builtin("candia-8-barrels", &[]).unwrap()).unwrap().model;
    KNOWN.map(|(name, method, _)| {
        let model = if name == "paper" { &paper } else { &five_codes };
        (name, method, per_step(model, method))
    })
}

/// Returns touching nodes, plain operations, divisions and choices per step.
fn per_step(model: &Model<Planar>, method: Method) -> [u64; 4] {
    let mut rest = State::initial(model);
    settle(model, &mut rest, &mut Scratch::new(model), 1e-9).unwrap();
    let time_step = 0.25e-3;
    let end_time = time_step * STEPS as f64;
    let case = Case { model, state: rest, drive: GROUND, time_step, end_time };
    let Work { steps, touching, operations } = Work::of(method, case);
    assert_eq!(steps, STEPS);
    let Operations { plain, divisions, choices } = operations;
    [touching, plain, divisions, choices].map(|count| count / STEPS)
}
