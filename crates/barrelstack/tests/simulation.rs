//! Simulations that advance step by step: the bits of a run, copies, and forces from outside.

use barrelstack::dynamics::{Applied, Vec2};
use barrelstack::watch::Ending;
use barrelstack::{Run, Scenario, Simulation};

fn scenario(name: &str, changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Scenario::builtin(name, &changes).unwrap()
}

fn started(scenario: &Scenario) -> Simulation {
    Simulation::new(scenario, scenario.ground().unwrap()).unwrap()
}

/// Returns the bits of all recordings of a run, and everything else as text.
fn bits(run: &Run) -> (Vec<u64>, String) {
    let recording = &run.recording;
    let histories = recording.channels.iter().flat_map(|channel| &channel.values);
    let forces =
        recording.joints.iter().flat_map(|joint| joint.vertical.iter().chain(&joint.horizontal));
    let frames = recording.frames.poses.iter().flatten().flatten();
    let numbers = recording.times.iter().chain(histories).chain(forces).chain(frames);
    let rest = (&run.outcome, &run.fates, &run.elements, &run.stresses, &run.energy, run.work);
    let ends = (run.end_time, run.ending, run.interrupted, &run.warnings);
    (numbers.map(|number| number.to_bits()).collect(), format!("{rest:?} {ends:?}"))
}

/// Scenarios that end at rest, after a collapse, or after their duration, and one with adaptive steps.
const RUNS: [(&str, &[&str]); 4] = [
    ("candia-8-barrels", &["run.duration='6 s'"]),
    ("demo-napa", &["stack.view='longitudinal'", "stack.levels=3", "run.until='verdict'"]),
    ("sliding-block", &[]),
    (
        "bouncing-disc",
        &["run.method='bogacki-shampine'", "run.tolerance=1e-7", "run.duration='2 s'"],
    ),
];

#[test]
fn steps_in_any_portions_have_the_bits_of_the_run() {
    for (name, changes) in RUNS {
        let scenario = scenario(name, changes);
        let run = scenario.run().unwrap();
        let mut simulation = started(&scenario);
        let mut portions = [1, 2, 7, 100, 999].into_iter().cycle();
        let mut taken = 0;
        while simulation.ending().is_none() {
            let most = portions.next().unwrap();
            let steps = simulation.step(most);
            assert!(steps == most || simulation.ending().is_some());
            taken += steps;
        }
        assert_eq!(simulation.step(10), 0, "an ended run takes no step");
        assert_eq!((taken, simulation.ending()), (run.work.steps, Some(run.ending)), "{name}");
        assert_eq!(bits(&simulation.finish()), bits(&run), "{name}");
        assert_eq!(bits(&started(&scenario).run()), bits(&run), "{name}");
    }
}

#[test]
fn a_copy_continues_with_the_same_bits_whatever_becomes_of_the_original() {
    let scenario = scenario("candia-8-barrels", &["run.duration='8 s'"]);
    let run = scenario.run().unwrap();
    let mut simulation = started(&scenario);
    simulation.step(run.work.steps / 2);
    let kept = simulation.clone();
    assert!(kept.is_clone_of(&simulation) && !kept.is_clone_of(&started(&scenario)));
    let body = simulation.assembly().model.body_named("B4.1").unwrap();
    let force = Vec2::new(2e3, 0.0);
    simulation.apply(Applied { body, force, point: Vec2::default(), moment: 0.0 }).unwrap();
    let pushed = simulation.run();
    assert_ne!(bits(&pushed), bits(&run));
    assert!(pushed.energy.unwrap().residual_ratio() < 1e-3, "{:?}", pushed.energy);
    assert_ne!(pushed.energy.unwrap().applied_work, 0.0);
    assert_eq!(bits(&kept.run()), bits(&run));
}

#[test]
fn a_brake_stops_a_block_earlier_by_the_force_over_its_mass() {
    let scenario = scenario("sliding-block", &[]);
    let mut simulation = started(&scenario);
    let mass = simulation.assembly().model.bodies()[1].mass;
    let way = |run: &Run| run.fates.fate(1).residual_displacement;
    // Friction decelerates by 0.3 g; the brake adds as much until the block has almost stopped.
    let friction = 0.3 * scenario.run.gravity;
    let force = Vec2::new(-friction * mass, 0.0);
    simulation.apply(Applied { body: 1, force, point: Vec2::default(), moment: 0.0 }).unwrap();
    while simulation.state().twists[1].linear.x > 0.01 {
        assert_eq!(simulation.step(1), 1);
    }
    let none = Applied { body: 1, force: Vec2::default(), point: Vec2::default(), moment: 0.0 };
    simulation.apply(none).unwrap();
    let ratio = way(&simulation.run()) / way(&scenario.run().unwrap());
    // measured 0.50007
    assert!((ratio - 0.5).abs() < 1e-3, "{ratio}");
}

#[test]
fn forces_between_bodies_are_those_of_the_histories_by_the_same_names() {
    let scenario = scenario("candia-8-barrels", &["stack.levels=2", "run.duration='4 s'"]);
    let mut simulation = started(&scenario);
    let mut observed = Vec::new();
    while simulation.ending().is_none() {
        simulation.step(1);
        let parts = &simulation.assembly().parts;
        let forces = simulation.forces();
        let named = forces.iter().map(|one| (one.named(|body| &parts[body].name), one.force));
        observed.push((simulation.time(), named.collect::<Vec<_>>()));
    }
    let run = simulation.finish();
    let mut compared = 0;
    for (time, forces) in &observed {
        let Some(at) = run.recording.times.iter().position(|sample| sample == time) else {
            continue;
        };
        for joint in &run.recording.joints {
            let force = forces.iter().find(|(name, _)| *name == joint.name);
            let now = force.map_or(Vec2::default(), |(_, force)| *force);
            assert_eq!(
                [now.x, now.z],
                [joint.horizontal[at], joint.vertical[at]],
                "{}",
                joint.name
            );
            compared += 1;
        }
    }
    assert!(compared > 1000, "{compared}");
}

#[test]
fn what_is_finished_early_counts_as_interrupted() {
    let mut simulation = started(&scenario("rocking-block", &[]));
    simulation.step(100);
    let time = simulation.time();
    let run = simulation.finish();
    assert!(run.interrupted);
    assert_eq!((run.ending, run.end_time, run.work.steps), (Ending::Interrupted, time, 100));
}
