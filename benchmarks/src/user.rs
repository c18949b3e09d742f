//! Typical work of a user: studies of eight barrels, and single runs.

use std::cell::Cell;
use std::sync::Arc;
use std::time::Instant;

use barrelstack::ensemble::{Audience, Ensemble, Prepared, simulate};
use barrelstack::{Run, Scenario};

use crate::{Failure, time};

/// The stack of the paper.
const STACK: &str = "candia-8-barrels";

/// Number of cases of a measured study: four bundles.
const CASES: usize = 32;

/// Simulated time (s) of each case.
const DURATION: f64 = 20.0;

/// Range of amplitudes (m) for which the stack stands under the sine motion of the paper.
pub(crate) const STANDING: [f64; 2] = [0.01, 0.02];
/// Range of amplitudes (m) for which half of the cases collapse under this motion.
pub(crate) const HALF: [f64; 2] = [0.0165, 0.0265];

/// Number of values of each of the two friction coefficients in the study in which every stack collapses. The study has
/// one case for each pair of values.
const GRID: usize = 8;

/// Cost of a study.
pub(crate) struct Cost {
    /// Processor time (s) per simulated second of a case.
    pub(crate) second: f64,
    /// Share of the cases that collapsed.
    pub(crate) collapsed: f64,
}

/// Measures a study of one stack on one core, including outcomes and demands, under motions whose
/// amplitudes (m) span a range.
pub(crate) fn study(amplitudes: [f64; 2]) -> Result<Cost, Failure> {
    let scenario = Arc::new(Scenario::builtin(STACK, &[format!("run.duration=\"{DURATION} s\"")])?);
    let case = |at: usize| {
        let amplitude = between(amplitudes, at, CASES);
        let shaken = Scenario::builtin(STACK, &shaking(amplitude))?;
        Ok(Prepared { scenario: Arc::clone(&scenario), ground: Arc::new(shaken.ground()?) })
    };
    let cases: Vec<Prepared> = (0..CASES).map(case).collect::<Result<_, Failure>>()?;
    let (simulated, fallen) = (Cell::new(0.0), Cell::new(0));
    let spent = time::least(|| {
        let results = on_one_core(&cases);
        simulated.set(results.iter().filter_map(|result| result.end_time).sum());
        fallen.set(results.iter().filter(|result| result.first_fall.is_some()).count());
    });
    Ok(Cost { second: spent / simulated.get(), collapsed: fallen.get() as f64 / CASES as f64 })
}

/// Measures, on one core, a study of 64 cases that differ in two friction coefficients. All stacks collapse within
/// about two seconds, and are simulated to the end of the motion of the paper.
pub(crate) fn collapsing() -> Result<Cost, Failure> {
    let case = |at: usize| {
        let share = |at: usize| at as f64 / (GRID - 1) as f64;
        let (seat, ground) = (0.18 + 0.07 * share(at % GRID), 0.40 + 0.14 * share(at / GRID));
        let settings = [
            "run.stop_after_collapse=\"20 s\"".to_owned(),
            format!("interface.barrel-rack.friction.coefficient={seat}"),
            format!("interface.rack-ground.friction.coefficient={ground}"),
        ];
        Ok(Prepared::new(Scenario::builtin(STACK, &settings)?)?)
    };
    let cases: Vec<Prepared> = (0..GRID * GRID).map(case).collect::<Result<_, Failure>>()?;
    let results = Cell::new(Vec::new());
    let spent = time::least_of(2, || drop(results.replace(on_one_core(&cases))));
    let results = results.take();
    let simulated: f64 = results.iter().filter_map(|result| result.end_time).sum();
    let fallen = results.iter().filter(|result| result.first_fall.is_some()).count();
    Ok(Cost { second: spent / simulated, collapsed: fallen as f64 / cases.len() as f64 })
}

/// Returns the time (s) that it takes to build and settle a case that differs from the other cases
/// in its friction.
pub(crate) fn settling() -> Result<f64, Failure> {
    let cases = differing(CASES, 1e-3)?;
    Ok(time::least(|| drop(on_one_core(&cases))) / CASES as f64)
}

/// Time of a study on all cores.
pub(crate) struct OnAllCores {
    pub(crate) cores: usize,
    /// Processor time (s) of all cores together.
    pub(crate) spent: f64,
    /// Time (s) by the clock.
    pub(crate) clock: f64,
}

/// Runs, on all cores, a study of cases in which the stack stands; the cases differ in friction and amplitude.
pub(crate) fn on_all_cores(cases: usize) -> Result<OnAllCores, Failure> {
    let ensemble = Ensemble { cases: differing(cases, DURATION)?, ..Ensemble::default() };
    let (before, start) = (time::of_process(), Instant::now());
    let results = ensemble.run();
    let clock = start.elapsed().as_secs_f64();
    assert!(results.iter().all(|result| result.outcome.is_ok()), "every case runs");
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let spent = time::of_process().zip(before).map(|(now, before)| now - before);
    Ok(OnAllCores { cores, spent: spent.unwrap_or(clock * cores as f64), clock })
}

/// Returns the ratio of the simulated time to the real time of a single run of a built-in scenario,
/// with all recordings.
pub(crate) fn single(name: &str, settings: &[String]) -> Result<f64, Failure> {
    let scenario = Scenario::builtin(name, settings)?;
    let run: Run = scenario.run()?;
    Ok(run.end_time / time::least(|| drop(scenario.run())))
}

fn on_one_core(cases: &[Prepared]) -> Vec<barrelstack::ensemble::CaseResult> {
    let mut audience = Audience { on_case: &mut |_| {}, stop: &|| false };
    simulate(cases, &mut audience).unwrap_or_default()
}

/// Returns cases of a given duration (s) in which the stack stands. The cases differ in two friction coefficients and
/// in the amplitude of the motion.
fn differing(cases: usize, duration: f64) -> Result<Vec<Prepared>, Failure> {
    let case = |at: usize| {
        let share = |turn: f64| (at as f64 * turn).fract();
        let settings = [
            format!("run.duration=\"{duration} s\""),
            format!("interface.rack-ground.friction.coefficient={}", 0.4 + 0.2 * share(0.618)),
            format!("interface.barrel-rack.friction.coefficient={}", 0.18 + 0.08 * share(0.755)),
        ];
        let amplitude = between(STANDING, at % CASES, CASES);
        let settings = [&settings[..], &shaking(amplitude)].concat();
        Ok(Prepared::new(Scenario::builtin(STACK, &settings)?)?)
    };
    (0..cases).map(case).collect()
}

/// Returns the settings of the sine motion of the paper with the given amplitude (m). The motion has enough cycles to
/// last for the whole run.
fn shaking(amplitude: f64) -> Vec<String> {
    vec![format!("motion.sine.amplitude=\"{amplitude} m\""), "motion.sine.cycles=20".to_owned()]
}

fn between([low, high]: [f64; 2], at: usize, of: usize) -> f64 {
    low + (high - low) * at as f64 / of as f64
}
