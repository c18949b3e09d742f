//! The cases of Candia, de la Llera and Almazán (2008): results of the paper, and invariants of every run.
//!
//! The paper does not fully describe the barrels and the racks, and its cases are chaotic after the first impacts.
//! The tests therefore check ranges in which a faithful model must lie, not exact values.
//! The six-barrel cases need a record that may not be redistributed; without it they are reported as skipped.

#![allow(clippy::print_stdout, reason = "measured values are shown with --nocapture")]

use crate::common;
use std::path::Path;
use std::sync::LazyLock;

use barrelstack::assemble::PartKind;
use barrelstack::outcome::{CollapseMode, Outcome};
use barrelstack::overlap::{Boundaries, Overlap};
use barrelstack::{Run, Scenario, Summary};

/// Largest residual of the energy balance of a run, as a share of the energy exchanged, even if the run continues until
/// the fallen barrels are at rest. Measured: 3.4e-5 with steps of 0.25 ms, and 4e-6 with steps of 0.1 ms.
const ENERGY: f64 = 1e-4;

fn run(name: &str, overrides: &[&str]) -> Run {
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    let scenario = Scenario::builtin(name, &overrides).unwrap();
    scenario.run().unwrap()
}

/// Returns the run of the benchmark, to which most tests refer; it is computed only once.
fn eight() -> &'static Run {
    static RUN: LazyLock<Run> = LazyLock::new(|| run("candia-8-barrels", &[]));
    &RUN
}

/// Returns the collapse of a stack: mode, time (s), level of the first body.
fn collapse(run: &Run) -> (CollapseMode, f64, u32) {
    let Outcome::Collapse { mode, time, first, .. } = &run.outcome else {
        panic!("no collapse: {:?}", run.outcome)
    };
    let part = run.assembly.parts.iter().find(|part| part.name == *first).unwrap();
    (*mode, *time, part.level.unwrap())
}

/// Returns the times (s) at which the barrels of a level had fallen, sorted.
fn falls(run: &Run, level: u32) -> Vec<f64> {
    let barrels = run.assembly.of_kind(PartKind::Barrel);
    let mut times: Vec<f64> = barrels
        .filter(|body| run.assembly.parts[*body].level == Some(level))
        .filter_map(|body| run.fates.fate(body).fell_at)
        .collect();
    times.sort_by(f64::total_cmp);
    times
}

/// Returns the histories of displacement, of the ground and of all bodies.
fn histories(run: &Run) -> impl Iterator<Item = &barrelstack::watch::Channel> {
    run.recording.channels.iter().filter(|channel| channel.name.contains("displacement"))
}

fn within(what: &str, value: f64, low: f64, high: f64) {
    assert!((low..=high).contains(&value), "{what} = {value}, expected {low} to {high}");
}

fn energy_balances(run: &Run) {
    within("energy residual ratio", run.energy.unwrap().residual_ratio(), 0.0, ENERGY);
}

#[test]
fn eight_barrels_lose_their_top_level_first_by_ejection() {
    let run = eight();
    let (mode, time, level) = collapse(run);
    println!("eight barrels: {mode:?} of level {level} at {time:.3} s, falls {:?}", falls(run, 4));
    assert_eq!(mode, CollapseMode::Ejection);
    assert_eq!(level, 4);
    // The paper: first barrel at 1.5 s, second at 2.5 s; measured 1.59 s and 2.63 s.
    within("loss of seat", time, 1.0, 2.0);
    within("first fall", run.fates.first_fall().unwrap(), 1.3, 1.8);
    within("second fall", falls(run, 4)[1], 2.2, 2.9);
    assert_eq!(run.fates.first_fall(), falls(run, 4).first().copied());
}

#[test]
fn eight_barrels_drift_and_press_as_in_the_paper() {
    let summary = Summary::of(eight(), None);
    let drift = summary.demands.top_drift_ratio.unwrap();
    let amplification = summary.demands.stress_amplification.unwrap();
    println!("eight barrels: drift {drift}, amplification {amplification}");
    // The paper: a drift of 5.2 % of the height, and 3.0 times the stress at rest.
    within("drift", drift, 0.04, 0.07);
    within("amplification", amplification, 2.5, 3.5);
}

#[test]
fn eight_barrels_balance_their_energy() {
    energy_balances(eight());
}

#[test]
fn half_scale_is_full_scale_in_another_unit() {
    // Both with the same share of the time scale as step, so that they take the same steps.
    let full = run("candia-8-barrels", &["run.step=0.1 ms"]);
    let half = run("candia-8-barrels-half-scale", &["run.step=0.1 ms"]);
    let (length, time) = (0.5, 0.5_f64.sqrt());
    let (full_end, half_end) = (collapse(&full).1, collapse(&half).1);
    println!("collapse at {full_end} s, at half scale {half_end} s: {}", half_end / full_end);
    assert!((half_end / (time * full_end) - 1.0).abs() < 1e-6);
    let samples = full.recording.times.iter().take_while(|t| **t < full_end).count();
    for (a, b) in full.recording.times.iter().zip(&half.recording.times).take(samples) {
        assert!((a * time - b).abs() < 1e-9, "sampled at {a} s and {b} s");
    }
    let mut worst = 0.0_f64;
    for (full, half) in histories(&full).zip(histories(&half)) {
        let (full, half) = (&full.values[..samples], &half.values[..samples]);
        let largest = full.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let apart = full.iter().zip(half).map(|(a, b)| (a * length - b).abs());
        let apart = apart.fold(0.0, f64::max);
        if largest > 0.0 {
            worst = worst.max(apart / (largest * length));
        }
    }
    println!("largest difference of a displacement history: {worst:e} of its peak");
    assert!(worst < 1e-6);
}

#[test]
fn a_mirrored_stack_falls_the_other_way_at_the_same_times() {
    let straight = eight();
    let mirrored = run("candia-8-barrels", &["stack.mirror=true", "motion.scale.factor=-1"]);
    println!("{:?} {:?}", straight.outcome, mirrored.outcome);
    println!("{:?} {:?}", falls(straight, 4), falls(&mirrored, 4));
    assert_eq!(straight.outcome, mirrored.outcome);
    assert_eq!(straight.fates.first_fall(), mirrored.fates.first_fall());
    for body in straight.assembly.of_kind(PartKind::Barrel) {
        let (a, b) = (straight.fates.fate(body), mirrored.fates.fate(body));
        println!("{}: {:?} and {:?}", straight.assembly.parts[body].name, a.fell_at, b.fell_at);
        assert_eq!(a.displacement_at_collapse, -b.displacement_at_collapse);
        assert_eq!(a.fell_at, b.fell_at);
    }
}

#[test]
fn half_the_step_gives_the_same_collapse() {
    let whole = eight();
    let half = format!("run.step={} s", 0.5 * whole.simulation.time_step);
    let fine = run("candia-8-barrels", &[&half]);
    let (mode, time, level) = collapse(&fine);
    let (a, b) = (whole.fates.first_fall().unwrap(), fine.fates.first_fall().unwrap());
    println!("half step: {mode:?} at {time} s; first falls {a} s and {b} s");
    assert_eq!((mode, level), (collapse(whole).0, collapse(whole).2));
    within("loss of seat moved", (time - collapse(whole).1).abs(), 0.0, 0.003); // measured 0.1 ms
    within("first fall moved", (a - b).abs(), 0.0, 0.003); // measured 0.3 ms
}

#[test]
fn along_the_barrels_a_rack_walks_off() {
    let run = run("candia-8-barrels-longitudinal", &[]);
    let (mode, time, level) = collapse(&run);
    println!(
        "longitudinal: {mode:?} of level {level} at {time} s, {:?}",
        run.energy.unwrap().residual_ratio()
    );
    assert_eq!(mode, CollapseMode::RackSliding);
    // The paper: the rack of the second level leaves its seat first, at 4.5 s.
    assert_eq!(level, 2);
    within("collapse", time, 3.0, 6.0);
    energy_balances(&run);
}

#[test]
fn two_runs_are_the_same_to_the_last_bit() {
    let again = run("candia-8-barrels", &[]);
    assert_eq!(Summary::of(eight(), None).to_json(), Summary::of(&again, None).to_json());
    assert_eq!(eight().recording.frames, again.recording.frames);
    assert_eq!(eight().recording.channels, again.recording.channels);
}

/// Returns the record of the six-barrel cases, if present.
fn hollywood() -> Option<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/ground-motions/peer");
    let file = folder.join("RSN995_NORTHR_PEL360.AT2");
    if file.is_file() {
        return Some(format!("motion.record={:?}", file.display().to_string()));
    }
    common::skipped("RSN995_NORTHR_PEL360.AT2 is not there; it may not be passed on");
    None
}

#[test]
fn six_barrels_rock_off_above_the_first_level() {
    let Some(record) = hollywood() else { return };
    let run = run("candia-6-barrels", &[&record]);
    let (mode, time, level) = collapse(&run);
    let summary = Summary::of(&run, None);
    let amplification = summary.demands.stress_amplification.unwrap();
    let slip = summary.demands.base_slip_residual.unwrap();
    let fallen: Vec<f64> = [falls(&run, 2), falls(&run, 3)].concat();
    println!(
        "six barrels: {mode:?} of level {level} at {time} s, falls {fallen:?}, amplification \
         {amplification}, slip {slip} m, {:?}",
        run.energy.unwrap().residual_ratio()
    );
    assert_eq!((mode, level), (CollapseMode::Rocking, 2));
    assert_eq!(fallen.len(), 4);
    assert!(falls(&run, 1).is_empty());
    // The paper: falls after 10 s of the motion, 2.9 times the stress at rest, and a residual slip of 2 cm.
    for fell in fallen {
        within("fall", fell, 9.5, 12.5);
    }
    // The beam lands on the crown beside its foot before the seat is lost: one point bears 7.5 times its stress
    // at rest (paper: 2.9 on average), while the whole seat of barrel 1 bears 2.5 times.
    within("amplification", amplification, 2.5, 9.0);
    within("residual slip", slip.abs(), 0.0, 0.05);
    energy_balances(&run);
}

#[test]
fn a_slippery_floor_keeps_six_barrels_up_and_moves_them_further() {
    let Some(record) = hollywood() else { return };
    let slippery = run("candia-6-barrels-low-friction", &[&record]);
    let rough = run("candia-6-barrels", &[&record]);
    let slip = |run: &Run| Summary::of(run, None).demands.base_slip_residual.unwrap();
    println!("slips {} m and {} m", slip(&slippery), slip(&rough));
    assert_eq!(slippery.outcome, Outcome::Stable);
    assert!(slip(&slippery).abs() > slip(&rough).abs());
    energy_balances(&slippery);
}

#[test]
fn nothing_stands_in_anything_while_it_falls() {
    let run = eight();
    let parts = &run.assembly.parts;
    let boundaries = Boundaries::new(&run.assembly);
    let (mut deepest, mut at_end) = (0.0_f64, 0.0_f64);
    let frames = &run.recording.frames;
    for (index, poses) in frames.all_poses().enumerate() {
        for Overlap { bodies: [a, b], depth } in boundaries.overlaps(&poses) {
            // At seats, feet sink into crowns and barrels into cradles, because the contacts of the paper are soft.
            let seat = parts[b].carrier == Some(a)
                || parts[b].supports.contains(&a)
                || (a == 0 && parts[b].kind == PartKind::Rack && parts[b].supports.is_empty());
            if !seat {
                deepest = deepest.max(depth);
                if index + 1 == frames.times.len() {
                    at_end = at_end.max(depth);
                }
            }
        }
    }
    println!("deepest {deepest} m, at the end {at_end} m");
    assert!(deepest < 0.015, "{deepest}");
    assert!(at_end < 0.005, "{at_end}");
}
