//! Cases that run side by side in SIMD lanes give bit-identical results to cases that run alone.
#![expect(clippy::print_stdout, reason = "prints the comparisons and their lanes")]

use crate::common::Random;
use barrelstack::ensemble::{Audience, CaseResult, Prepared, simulate_in};
use barrelstack::outcome::Outcome;
use barrelstack::watch::Joint;
use barrelstack::{Run, Scenario, Summary};
use barrelstack_dynamics::lanes::Width;

/// Number of random cases.
const CASES: u64 = 1000;

/// Devices of all kinds, or sloshing wine; every other stack has none.
const DEVICES: [&[&str]; 14] = [
    &[
        "stack.walking_stop.levels=12",
        "stack.walking_stop.holds=both",
        "stack.walking_stop.lip=\"5 mm\"",
    ],
    &[],
    &["stack.chock.levels=2"],
    &[],
    &["stack.pad.stiffness=\"500 kN/m\""],
    &[],
    &["stack.isolator.path=dish", "stack.isolator.stroke=\"5 cm\""],
    &[],
    &[
        "stack.tie.levels=1",
        "stack.tie.yields_at=\"2 kN\"",
        "stack.tie.strength=\"9 kN\"",
        "stack.tie.damping=\"2 kN s/m\"",
    ],
    &[],
    &["stack.tuned_mass.mass=\"60 kg\"", "stack.tuned_mass.stroke=\"5 cm\""],
    &[],
    &["stack.barrel.fill=part", "stack.barrel.filled=0.8"],
    &[],
];

/// A stack of two to four levels with random friction and, one in five, straps that may tear, and devices of
/// other kinds, under a random sine that topples about half of them.
fn random_case(seed: u64) -> Prepared {
    let mut random = Random(seed);
    let levels = 2 + seed % 3;
    let strapped = if seed.is_multiple_of(5) { 2 } else { 0 };
    let mut settings = vec![
        format!("stack.strap.levels={strapped}"),
        format!("stack.strap.strength=\"{:.1} kN\"", random.between(3.0, 12.0)),
        format!("stack.levels={levels}"),
        format!("motion.sine.period=\"{:.4} s\"", random.between(0.5, 1.3)),
        format!("motion.sine.amplitude=\"{:.4} cm\"", random.between(3.0, 16.0)),
        "motion.sine.ramp_cycles=0".to_owned(),
        format!("interface.rack-ground.friction.coefficient={:.4}", random.between(0.1, 0.6)),
        format!("interface.barrel-rack.friction.coefficient={:.4}", random.between(0.1, 0.6)),
        "run.duration=\"1.6 s\"".to_owned(),
        "run.stop_after_collapse=\"0.2 s\"".to_owned(),
    ];
    let devices = DEVICES[usize::try_from(seed / 3).unwrap() % DEVICES.len()];
    settings.extend(devices.iter().map(|setting| (*setting).to_owned()));
    Prepared::new(Scenario::builtin("candia-8-barrels", &settings).unwrap()).unwrap()
}

fn results(width: Width, cases: &[Prepared]) -> Vec<CaseResult> {
    let mut reported = 0;
    let mut on_case = |_: &CaseResult| reported += 1;
    let mut audience = Audience { on_case: &mut on_case, stop: &|| false };
    let results = simulate_in(width, cases, &mut audience).unwrap();
    assert_eq!(reported, cases.len(), "every case is reported once");
    results
}

#[test]
fn cases_in_lanes_come_to_the_bits_of_single_runs_collapses_included() {
    let cases: Vec<Prepared> = (0..CASES).map(random_case).collect();
    let alone: Vec<String> =
        cases.chunks(1).map(|case| format!("{:?}", results(Width::Scalar, case)[0])).collect();
    let collapses = alone.iter().filter(|result| result.contains("Collapse")).count();
    let share = collapses as f64 / alone.len() as f64;
    println!("{collapses} of {} cases collapse", alone.len());
    assert!((0.2..0.8).contains(&share), "{share}"); // measured 0.45
    for width in Width::ALL {
        if !width.is_here() {
            println!("this machine has no {} lanes: not checked", width.name());
            continue;
        }
        // All cases in the lanes of this machine, a tenth of them in the others.
        let count = if width == Width::widest() { cases.len() } else { cases.len() / 10 };
        let together = results(width, &cases[..count]);
        for (index, (one, many)) in alone.iter().zip(&together).enumerate() {
            assert_eq!(*one, format!("{many:?}"), "case {index} in {} lanes", width.name());
        }
        println!("{count} cases in {} lanes have the bits of single runs", width.name());
    }
}

#[test]
fn a_case_of_an_ensemble_is_a_run() {
    for seed in 0..12 {
        let case = random_case(seed);
        let run = case.scenario.run().unwrap();
        let result = &results(Width::widest(), &[case])[0];
        assert_eq!(result.outcome, Ok(run.outcome.clone()), "case {seed}");
        assert_eq!(result.first_fall, run.fates.first_fall(), "case {seed}");
        assert_eq!(result.end_time, Some(run.end_time), "case {seed}");
        assert_eq!(result.steps, Some(run.work.steps), "case {seed}");
        let balance = run.energy.map(|energy| energy.residual_ratio());
        assert_eq!(result.energy_residual_ratio, balance, "case {seed}");
    }
}

/// A random case in one of both planes, recorded in lanes as fully as alone.
fn random_case_of_a_plane(seed: u64) -> Prepared {
    let mut random = Random(seed);
    let name = ["candia-8-barrels", "candia-8-barrels-longitudinal"][usize::from(seed % 2 == 1)];
    let settings = [
        format!("stack.levels={}", 2 + seed % 2),
        format!("motion.sine.period=\"{:.4} s\"", random.between(0.4, 1.0)),
        format!("motion.sine.amplitude=\"{:.4} cm\"", random.between(3.0, 25.0)),
        "motion.sine.ramp_cycles=0".to_owned(),
        format!("interface.barrel-rack.friction.coefficient={:.4}", random.between(0.15, 0.6)),
        "run.duration=\"1.2 s\"".to_owned(),
        "run.stop_after_collapse=\"0.2 s\"".to_owned(),
    ];
    Prepared::new(Scenario::builtin(name, &settings).unwrap()).unwrap()
}

/// Returns the number of pairs of bodies that met without leaning on each other by design.
fn joints_met(run: &Run) -> usize {
    run.recording.forces().listed().iter().filter(|joint| !joint.by_design).count()
}

#[test]
fn forces_and_stresses_of_a_case_in_lanes_have_the_bits_of_a_run() {
    const COUNT: u64 = 120;
    let cases: Vec<Prepared> = (0..COUNT).map(random_case_of_a_plane).collect();
    let together = results(Width::widest(), &cases);
    let (mut fallen, mut met) = ([0; 2], 0);
    for (index, (case, result)) in cases.iter().zip(&together).enumerate() {
        let run = case.scenario.run().unwrap();
        assert_eq!(result.outcome, Ok(run.outcome.clone()), "case {index}");
        let Summary { demands, demands_whole_run, .. } = Summary::of(&run, None);
        assert!(demands.stress_amplification.is_some_and(|times| times > 1.0), "case {index}");
        assert_eq!(format!("{:?}", result.demands), format!("{demands:?}"), "case {index}");
        let whole = format!("{:?}", result.demands_whole_run);
        assert_eq!(whole, format!("{demands_whole_run:?}"), "case {index}");
        let joints = run.recording.forces().listed();
        assert_eq!(result.joints.len(), joints.len(), "case {index}");
        for ((name, own), joint) in result.joints.iter().zip(joints) {
            assert_eq!(*name, joint.name(&run.assembly));
            let all = |joint: &Joint| {
                let peaks = [joint.until_loss, joint.whole_run];
                let peaks = peaks.map(|peaks| [peaks.vertical, peaks.horizontal]);
                let bits = peaks.as_flattened().iter().flat_map(|(force, at)| [*force, *at]);
                bits.chain([joint.at_rest]).map(f64::to_bits).collect::<Vec<u64>>()
            };
            assert_eq!(all(own), all(joint), "case {index}: {name}");
        }
        met += joints_met(&run);
        fallen[index % 2] += u64::from(matches!(run.outcome, Outcome::Collapse { .. }));
    }
    println!("{fallen:?} of {} of each plane fall; {met} pairs met", COUNT / 2);
    assert!(met > 0);
    // Measured in release: 40 and 19 of 60.
    assert!(fallen.iter().all(|fallen| (1..COUNT / 2).contains(fallen)), "{fallen:?}");
}

#[test]
fn what_stands_beside_a_case_changes_nothing_about_it() {
    let cases: Vec<Prepared> = (0..24).map(random_case).collect();
    let all = results(Width::widest(), &cases);
    let mut reversed = cases;
    reversed.reverse();
    let mut again = results(Width::widest(), &reversed);
    again.reverse();
    assert_eq!(format!("{all:?}"), format!("{again:?}"));
}

#[test]
fn a_broken_case_is_told_and_leaves_its_neighbors_alone() {
    let mut cases: Vec<Prepared> = (0..20).map(|seed| random_case(3 * seed)).collect();
    let sound = results(Width::widest(), &cases);
    // A step that is refused before it is taken.
    let broken = Scenario::builtin(
        "candia-8-barrels",
        &["stack.levels=2".into(), "run.duration=\"1.6 s\"".into(), "run.step=\"2.4 ms\"".into()],
    );
    cases.insert(7, Prepared::new(broken.unwrap()).unwrap());
    let mut with = results(Width::widest(), &cases);
    let broken = with.remove(7);
    println!("{:?}", broken.outcome);
    assert!(broken.outcome.unwrap_err().contains("is too long"));
    assert_eq!(format!("{sound:?}"), format!("{with:?}"));
}

#[test]
fn a_motion_too_long_to_run_is_told_whatever_shares_its_stack() {
    // Strong, so that the short one is over at once; 3605 s are 1.03e9 of these steps.
    let shaken = |cycles: u32| {
        let text = format!(
            "schema = 1\n[stack]\nlevels = 2\ncolumns = 2\nbarrel = \"bordeaux-225\"\nrack = \"two-barrel\"\n\
             [motion.sine]\namplitude = \"40 cm\"\nperiod = \"0.8 s\"\nramp_cycles = 0\ncycles = {cycles}\n\
             [run]\nstep = \"3.5 us\"\nstop_after_collapse = \"0 s\"\n"
        );
        Prepared::new(Scenario::from_str(&text).unwrap()).unwrap()
    };
    let short = shaken(2);
    let long = Prepared { ground: shaken(4500).ground, ..short.clone() };
    for cases in [[short.clone(), long.clone()], [long, short]] {
        let outcomes = results(Width::Scalar, &cases).into_iter().map(|result| result.outcome);
        let (reported, ran): (Vec<_>, Vec<_>) = outcomes.partition(Result::is_err);
        assert!(matches!(&ran[..], [Ok(Outcome::Collapse { .. })]), "{ran:?}");
        assert!(
            matches!(&reported[..], [Err(reason)] if reason.contains("1e9 steps")),
            "{reported:?}"
        );
    }
}

#[test]
fn a_case_without_stresses_differs_only_in_the_demands_that_need_them() {
    let with: Vec<Prepared> = (0..12).map(random_case).collect();
    let mut mixed = with.clone();
    for case in mixed.iter_mut().step_by(2) {
        case.records_stresses = false;
    }
    let mut recorded = 0;
    for width in [Width::Scalar, Width::widest()] {
        for (at, (with, mut mixed)) in
            results(width, &with).into_iter().zip(results(width, &mixed)).enumerate()
        {
            for (own, other) in [
                (&with.demands, &mut mixed.demands),
                (&with.demands_whole_run, &mut mixed.demands_whole_run),
            ] {
                recorded += u32::from(own.stress_amplification.is_some());
                if at.is_multiple_of(2) {
                    assert_eq!(other.stress_amplification, None);
                    assert_eq!(other.mean_stress_amplification, None);
                    other.stress_amplification = own.stress_amplification;
                    other.mean_stress_amplification = own.mean_stress_amplification;
                }
            }
            assert_eq!(format!("{with:?}"), format!("{mixed:?}"), "case {at}");
        }
    }
    assert!(recorded >= 40, "{recorded} of 48");
}

#[test]
fn an_ensemble_stops_when_asked() {
    let cases: Vec<Prepared> = (0..12).map(random_case).collect();
    let asked = std::cell::Cell::new(0);
    let stop = || {
        asked.set(asked.get() + 1);
        asked.get() > 14
    };
    let mut audience = Audience { on_case: &mut |_| {}, stop: &stop };
    assert!(simulate_in(Width::widest(), &cases, &mut audience).is_none());
}
