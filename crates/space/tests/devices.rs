//! Devices in three dimensions: tensions of straps at rest, idle devices without effect, all devices on the demo and
//! its mirror image, and straps that hold or tear.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use barrelstack::Scenario;
use barrelstack::assemble::PartKind;
use barrelstack::device::{DEVICES, Setting};
use barrelstack_dynamics::{Element, Spatial, evaluate};
use barrelstack_space::run::{Run, Standing, run, stand};

use crate::common::soft_demo;

fn demo(changes: &[&str]) -> Scenario {
    let all: Vec<String> =
        ["stack.view=spatial"].iter().chain(changes).map(|change| (*change).to_owned()).collect();
    soft_demo(&all)
}

/// Returns the upward force (N) on a body from all its contacts.
fn borne(standing: &Standing, body: usize) -> f64 {
    let forces = standing.scratch.pair_forces.iter();
    forces
        .map(|force| match (force.contactor == body, force.target == body) {
            (true, _) => force.force.z,
            (_, true) => -force.force.z,
            _ => 0.0,
        })
        .sum()
}

/// Returns the names and tensions (N) of all straps of a stack at rest.
fn tensions(standing: &Standing) -> Vec<(String, f64)> {
    let told = |element: &Element<Spatial>| {
        (element.link().name.clone(), element.load(&standing.state).force)
    };
    standing.stack.model.elements().iter().map(told).collect()
}

#[test]
fn seats_bear_the_weight_and_what_the_straps_pull() {
    let changes = [
        "stack.levels=3",
        "stack.strap.levels=2",
        "stack.strap.ties=levels-together",
        "stack.strap.pretension='2 kN'",
    ];
    let mut standing = stand(&demo(&changes)).unwrap();
    evaluate(&standing.stack.model, &standing.state, &mut standing.scratch);
    let all = tensions(&standing);
    // Two over each of four barrels; the rack of the third level is tied to the one below on its four sides.
    assert_eq!(all.len(), 4 * 2 + 4, "{all:?}");
    let mut worst = 0.0_f64;
    for body in standing.stack.of_kind(PartKind::Barrel) {
        let part = &standing.stack.parts[body];
        let own = all.iter().filter(|(name, _)| name.starts_with(&format!("{}-", part.name)));
        let (count, pull) = own.fold((0, 0.0), |(count, sum), (_, force)| (count + 1, sum + force));
        assert_eq!(count, if part.level > 1 { 2 } else { 0 }, "{}", part.name);
        if part.level == 3 {
            // Nothing lies on the top barrels, so their cradles carry the whole force.
            let weight = 9.80665 * standing.stack.model.bodies()[body].mass;
            let seat = borne(&standing, body);
            println!("{}: seat {seat:.1} N, straps {pull:.1} N, weight {weight:.1} N", part.name);
            worst = worst.max((seat / (weight + pull) - 1.0).abs());
            // The stack settles under the straps, which keep most of their pretension.
            assert!(pull > 2.0 * 1500.0 && pull < 2.0 * 2000.0, "{pull}"); // measured 3772
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-6, "{worst:e}"); // measured 4e-11
}

/// Returns all numbers that distinguish two runs.
fn bits(run: &Run) -> Vec<u64> {
    let poses = run.frames.poses.iter().flatten().flatten();
    poses.map(|value| value.to_bits()).collect()
}

#[test]
fn every_idle_device_changes_no_bit_and_every_other_one_does() {
    // The run is long enough for the top barrels to hit their lids, and the stops are so soft that impacts do not
    // change the time steps.
    let common = [
        "stack.levels=3",
        "run.duration='9 s'",
        "run.step='0.1 ms'",
        "stack.walking_stop.stiffness='10 kN/m'",
        "stack.walking_stop.damping='10 N s/m'",
        "stack.lid.stiffness='10 kN/m'",
        "stack.lid.damping='10 N s/m'",
    ];
    let of = |more: &[&str]| bits(&run(&demo(&[&common, more].concat())).unwrap());
    for words in DEVICES {
        let law: Vec<&str> =
            words.idle.iter().copied().filter(|setting| !setting.starts_with("stack.")).collect();
        let bare = of(&law);
        let idle = Setting { name: "idle", overrides: words.idle };
        let candidate = &words.candidates[0];
        assert!(bare == of(&idle.over(candidate)), "{} is not idle", words.one);
        assert!(
            words.candidates.iter().any(|it| bare != of(&[&law, it.overrides].concat())),
            "{} changes nothing",
            words.one
        );
    }
}

#[test]
fn every_candidate_and_what_becomes_of_it_can_be_put_on_the_demo() {
    let mut worst = 0.0_f64;
    for words in DEVICES {
        for candidate in words.candidates {
            for degraded in [None].into_iter().chain(words.degraded.iter().map(Some)) {
                let settings =
                    degraded.map_or(candidate.overrides.to_vec(), |worn| worn.over(candidate));
                let short = ["run.duration='0.05 s'", "run.until=duration"];
                let run = run(&demo(&[&short[..], &settings].concat()));
                let run = run.unwrap_or_else(|error| panic!("{settings:?}: {error}"));
                assert_eq!(run.outcome.kind(), "stable", "{settings:?}: {:?}", run.outcome);
                let missing = run.energy.unwrap().residual_ratio();
                worst = worst.max(missing);
                assert!(missing < 1e-9, "{settings:?}: {missing:e}"); // measured 1.5e-13
            }
        }
    }
    println!("{worst:e}");
}

#[test]
fn straps_hold_what_would_fall_and_tear_where_they_are_weak() {
    let common = [
        "stack.levels=4",
        "motion.scale.factor=0.6",
        "run.stop_after_collapse='0.1 s'",
        "run.duration='16 s'",
    ];
    let strapped = [
        "stack.strap.levels=4",
        "stack.strap.ties=levels-together",
        "stack.strap.pretension='5 kN'",
    ];
    let of = |more: &[&str]| run(&demo(&[&common, more].concat())).unwrap();
    let without = of(&[]);
    assert_eq!(without.outcome.kind(), "collapse", "{:?}", without.outcome);
    let with = of(&strapped);
    assert_eq!(with.outcome.kind(), "stable", "{:?}", with.outcome);
    let peak = with.elements.iter().map(|fate| fate.peak.0).fold(0.0, f64::max);
    let missing = with.energy.unwrap().residual_ratio();
    println!("{peak:.0} N, balance {missing:e}");
    assert!(peak > 5e3, "{peak}"); // measured 5416
    assert!(missing < 1e-8, "{missing:e}"); // measured 2e-10
    // Straps with a strength slightly above their tension at rest tear, and the energy balance includes it.
    let weak = of(&[&strapped[..], &["stack.strap.strength='5.1 kN'"]].concat());
    let torn = weak.elements.iter().filter(|fate| fate.broken_at.is_some()).count();
    let missing = weak.energy.unwrap().residual_ratio();
    println!("{torn} of {} torn, {:?}, balance {missing:e}", weak.elements.len(), weak.outcome);
    assert!(torn > 0); // measured 5 of 28
    assert!(missing < 5e-5, "{missing:e}"); // measured 1.1e-5
    assert!(weak.elements.iter().all(|fate| fate.broken_at.is_some() || fate.peak.0 <= 5.1e3));
}

#[test]
fn a_mirrored_stack_has_its_straps_on_the_other_side() {
    // A rack with a small offset distinguishes the mirror image from the stack.
    let changes = [
        "stack.levels=2",
        "stack.override=[{kind=\"rack\",level=2,column=1,offset_x=\"1 cm\"}]",
        "stack.strap.levels=2",
        "stack.strap.ties=levels-together",
    ];
    let of = |more: &[&str]| stand(&demo(&[&changes, more].concat())).unwrap();
    let (one, other) = (of(&[]), of(&["stack.mirror=true"]));
    // Each tie of one has its mirror image in the other.
    let ends = |standing: &Standing| -> Vec<[f64; 3]> {
        let elements = standing.stack.model.elements().iter();
        let end = |(body, point): (usize, barrelstack_dynamics::Vec3)| {
            let pose = standing.state.poses[body];
            let at = pose.position + pose.orientation.matrix().apply(point);
            [at.x, at.y, at.z]
        };
        elements.flat_map(Element::ends).map(end).collect()
    };
    let (one, other) = (ends(&one), ends(&other));
    assert_eq!(one.len(), 2 * (4 * 2 + 4));
    let mut worst = 0.0_f64;
    for [x, y, z] in &one {
        let off = |[u, v, w]: &[f64; 3]| (x + u).abs().max((y - v).abs()).max((z - w).abs());
        let nearest = other.iter().map(off).fold(f64::INFINITY, f64::min);
        worst = worst.max(nearest);
    }
    println!("{worst:e}");
    assert!(worst < 1e-12, "{worst:e}"); // measured 2e-15
}
