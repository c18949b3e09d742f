//! Straps on a stack: their effect, their forces, and independence of step and scale.
#![allow(clippy::print_stdout, reason = "measured values are shown with --nocapture")]

use barrelstack::outcome::Outcome;
use barrelstack::summary::ElementSummary;
use barrelstack::{Run, Scenario, Summary};

const TOGETHER: &str = "stack.strap.ties=\"levels-together\"";
const PRETENSION: &str = "stack.strap.pretension=\"3 kN\"";

fn scenario(name: &str, changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Scenario::builtin(name, &changes).unwrap()
}

fn run(name: &str, changes: &[&str]) -> Run {
    scenario(name, changes).run().unwrap()
}

/// Returns the summary of every strap.
fn straps(run: &Run) -> Vec<ElementSummary> {
    Summary::of(run, None).devices.named("straps").to_vec()
}

/// Runs a stack of two levels under a small sine, with straps that tie both levels together.
fn small(changes: &[&str]) -> Run {
    unstrapped(&[&["stack.strap.levels=2", TOGETHER][..], changes].concat())
}

/// Runs the stack of [`small`] without straps, with the given changes.
fn unstrapped(changes: &[&str]) -> Run {
    let all = ["stack.levels=2", "run.duration=\"1 s\"", "motion.sine.amplitude=\"5 cm\""];
    run("candia-8-barrels", &[&all[..], changes].concat())
}

/// The weaker plane of the demo.
const ALONG: &str = "stack.view=longitudinal";

#[test]
fn a_stack_that_falls_stands_when_all_its_levels_are_strapped_together() {
    let bare = run("demo-napa", &[ALONG]);
    assert!(matches!(bare.outcome, Outcome::Collapse { .. }));
    let held = run("demo-napa", &[ALONG, "stack.strap.levels=5", TOGETHER, PRETENSION]);
    assert_eq!(held.outcome, Outcome::Stable);
    let summary = Summary::of(&held, None);
    // Ten barrels and the eight racks above the first level, each at both ends.
    assert_eq!(summary.devices.named("straps").len(), 36);
    let most = summary.devices.named("straps").iter().map(|strap| strap.peak).fold(0.0, f64::max);
    let residual = summary.energy.unwrap().residual_ratio;
    println!("largest tension {most} N, residual {residual:e}");
    assert!((3e3..6e3).contains(&most)); // measured 3795 N
    assert!(residual < 1e-6); // measured 6.3e-10
    let said = barrelstack::report::sentences(&held, &Summary::of(&held, None));
    let holds =
        format!("All 36 straps hold; the largest force in one of them is {:.1} kN.", 1e-3 * most);
    assert!(said.contains(&holds), "{said:?}");
}

#[test]
fn straps_without_slack_bear_nothing_at_rest_and_leave_the_weight_where_it_is() {
    let base = |run: &Run| run.recording.joints[0].joint.at_rest;
    let (bare, loose, tight) = (
        unstrapped(&["stack.strap.levels=0", "stack.strap.ties=\"barrels-to-racks\""]),
        small(&[]),
        small(&[PRETENSION]),
    );
    println!("on the ground {} N, {} N, {} N", base(&bare), base(&loose), base(&tight));
    assert_eq!(base(&bare), base(&loose));
    // The straps pull only between bodies of the stack.
    assert!((base(&tight) / base(&bare) - 1.0).abs() < 1e-6);
    // The stack is compliant: some of the pretension is lost, and none is gained.
    let still = run(
        "candia-8-barrels",
        &[
            "stack.strap.levels=4",
            TOGETHER,
            PRETENSION,
            "motion.scale.factor=1e-6",
            "run.duration=\"0.1 s\"",
        ],
    );
    for strap in straps(&still) {
        println!("{}: {} N", strap.name, strap.peak);
        assert!((1500.0..3000.0).contains(&strap.peak), "{strap:?}");
    }
}

#[test]
fn a_mirrored_stack_has_the_same_tensions_on_the_other_side() {
    let changes = [
        "stack.strap.levels=3",
        TOGETHER,
        "stack.strap.strength=\"2.2 kN\"",
        "run.duration=\"4 s\"",
    ];
    let straight = run("candia-8-barrels", &changes);
    let turned = [&changes[..], &["stack.mirror=true", "motion.scale.factor=-1"]].concat();
    let mirrored = run("candia-8-barrels", &turned);
    let (straight_straps, mirrored_straps) = (straps(&straight), straps(&mirrored));
    let torn = straight_straps.iter().filter(|strap| strap.broken_at.is_some()).count();
    assert!(torn > 1, "{torn} tear");
    let said = barrelstack::report::sentences(&straight, &Summary::of(&straight, None));
    let words = format!("{torn} of {} straps tear, the first after", straight_straps.len());
    assert!(said.iter().any(|line| line.starts_with(&words)), "{said:?}");
    for (a, b) in straight_straps.iter().zip(&mirrored_straps) {
        let swapped = if a.name.ends_with("left") {
            a.name.replace("left", "right")
        } else {
            a.name.replace("right", "left")
        };
        assert_eq!(swapped, b.name);
        assert_eq!((a.peak, a.peak_at, a.broken_at), (b.peak, b.peak_at, b.broken_at));
    }
    assert_eq!(straight.outcome, mirrored.outcome);
}

#[test]
fn half_scale_straps_are_full_scale_straps_in_another_unit() {
    let changes = [PRETENSION, "run.step=\"0.2 ms\""];
    let full = straps(&small(&changes));
    let half = straps(&small(&[&changes[..], &["run.similitude=0.5"]].concat()));
    for (a, b) in full.iter().zip(&half) {
        let apart = (b.peak / (a.peak / 8.0) - 1.0).abs();
        println!("{}: {} N and {} N, {apart:e}", a.name, a.peak, b.peak);
        assert!(apart < 1e-6);
    }
}

#[test]
fn the_result_does_not_hang_on_the_step() {
    let peak = |step: &str| {
        let all = straps(&small(&[PRETENSION, step]));
        all.iter().map(|strap| strap.peak).fold(0.0, f64::max)
    };
    let (whole, half) = (peak("run.step=\"0.2 ms\""), peak("run.step=\"0.1 ms\""));
    println!("{whole} N, {half} N");
    assert!((whole / half - 1.0).abs() < 1e-2);
}

#[test]
fn along_the_barrels_both_straps_of_a_barrel_share_its_pull() {
    let changes = ["stack.strap.levels=2", "stack.strap.slack=\"2 mm\"", "run.duration=\"4 s\""];
    let all = straps(&run("candia-8-barrels-longitudinal", &changes));
    for pair in all.chunks(2) {
        assert!(pair[0].name.ends_with("front") && pair[1].name.ends_with("back"), "{pair:?}");
        assert_eq!(pair[0].peak, pair[1].peak);
    }
    assert!(all.iter().any(|strap| strap.peak > 0.0));
}

#[test]
fn a_pretension_that_a_strap_is_too_short_for_is_refused_with_its_length() {
    let changes = ["stack.strap.levels=1", "stack.strap.stiffness=\"3 kN/m\"", PRETENSION];
    let scenario = scenario("candia-8-barrels", &changes);
    let error = scenario.run().unwrap_err();
    let said = error.to_string();
    println!("{said}");
    assert!(said.contains("by 1.000 m") && said.contains("less pretension"), "{said}");
}

#[test]
fn impossible_straps_are_refused_with_what_to_do() {
    let wrong: [(&[&str], &str); 5] = [
        (&["stack.strap.levels=9"], "the stack has only 4"),
        (&["stack.strap.levels=1", TOGETHER], "ties at least 2"),
        (&["stack.strap.slack=\"1 cm\"", PRETENSION], "leave `pretension` or `slack` out"),
        (&["stack.strap.strength=\"2 kN\"", PRETENSION], "not below the strength"),
        (&["stack.strap.stiffness=\"3 kN\""], "stiffness"),
    ];
    for (changes, words) in wrong {
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        let error = Scenario::builtin("candia-8-barrels", &changes).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}
