//! Three-dimensional simulations that advance step by step: results bit-identical to those of a run, copies, and forces
//! from outside.

use barrelstack::Scenario;
use barrelstack_dynamics::{Applied, Vec3};
use barrelstack_space::{Ground, Run, Simulation, run};

fn scenario(name: &str, changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Scenario::builtin(name, &changes).unwrap()
}

fn started(scenario: &Scenario) -> Simulation {
    Simulation::new(scenario, Ground::of(scenario).unwrap()).unwrap()
}

/// Returns everything that a run recorded; the text of a number identifies its bits.
fn recorded(run: &Run) -> String {
    let parts = (&run.frames, &run.last, &run.fates, &run.elements, &run.seats, &run.energy);
    format!("{parts:?} {:?}", (&run.outcome, run.work, run.end_time, run.ending, &run.warnings))
}

#[test]
fn steps_in_any_portions_have_the_bits_of_the_run_and_so_has_a_copy() {
    let stack = ["stack.view='spatial'", "stack.levels=2", "run.duration='3 s'"];
    for (name, changes) in [("demo-napa", &stack[..]), ("rolling-ball", &[])] {
        let scenario = scenario(name, changes);
        let run = run::run(&scenario).unwrap();
        let mut simulation = started(&scenario);
        assert!(!simulation.scratch().contacts.is_empty());
        simulation.step(run.work.steps / 2);
        let kept = simulation.clone();
        while simulation.ending().is_none() {
            simulation.step(7);
        }
        assert_eq!(recorded(&simulation.finish()), recorded(&run), "{name}");
        assert_eq!(recorded(&kept.run()), recorded(&run), "{name}");
    }
}

#[test]
fn a_ball_is_pushed_off_its_course() {
    let scenario = scenario("rolling-ball", &[]);
    let mut simulation = started(&scenario);
    let push = Applied {
        body: 1,
        force: Vec3::new(0.0, 0.0, 50.0),
        point: Vec3::default(),
        moment: Vec3::default(),
    };
    let height = |simulation: &Simulation| simulation.state().poses[1].position.z;
    let before = height(&simulation);
    simulation.apply(push).unwrap();
    simulation.step(200);
    // A constant force through the center does the work of the force times the rise of the center.
    let (rise, work) = (height(&simulation) - before, simulation.energy().applied_work);
    assert!(rise > 1e-6, "{rise} m");
    assert!((work - 50.0 * rise).abs() < 1e-12, "{work} J for a rise of {rise} m");
    assert!(simulation.energy().residual_ratio() < 1e-3, "{:?}", simulation.energy());
}
