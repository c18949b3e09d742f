//! Speed of a run on one core, and growth of its cost with the size of the stack.
//!
//! `cargo bench -p barrelstack-library` prints the figures; nothing is asserted, since they depend on the machine.
#![expect(clippy::print_stdout, reason = "benchmarks print their results")]

use std::ops::ControlFlow;
use std::time::Instant;

use barrelstack::assemble::{Assembly, assemble};
use barrelstack::ground::Ground;
use barrelstack::scenario::Scene;
use barrelstack::watch::{End, Thresholds, Watch};
use barrelstack::{Scenario, Summary};
use barrelstack_dynamics::{
    Method, Observer, Planar, Scratch, Simulation, State, look, settle, simulate,
};

/// Number of measurements of each figure; the median is printed.
const REPEATS: usize = 7;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    // `cargo test --benches` runs benches, too, without figures.
    if std::env::args().any(|argument| argument == "--test") {
        return Ok(());
    }
    whole_run()?;
    println!();
    report()?;
    println!();
    growth("levels", 2..=8)?;
    println!();
    growth("columns", [2, 4, 8])
}

/// Measures the eight-barrel case from its scenario to its outcome, and the cost of its observers.
fn whole_run() -> Result<(), Failure> {
    let scenario = Scenario::builtin("candia-8-barrels", &[])?;
    let mut end_time = 0.0;
    let mut seconds = Vec::new();
    for _ in 0..REPEATS {
        let start = Instant::now();
        let run = scenario.run()?;
        seconds.push(start.elapsed().as_secs_f64());
        end_time = run.end_time;
    }
    let whole = median(seconds);

    let stage = Stage::new(&scenario)?;
    let after = scenario.run.stop_after_collapse;
    let watched = stage.measure(|stage, state, scratch| stage.watched(state, scratch, after));
    let blind =
        stage.measure(|stage, state, scratch| stage.shaken(state, scratch, end_time, &mut ()));
    let touched = stage.touched(end_time);

    println!("candia-8-barrels, one run on one core, median of {REPEATS}");
    println!("  time step                      {:10.1} µs", 1e6 * stage.step);
    println!("  simulated                      {end_time:10.3} s");
    println!("  from scenario to outcome       {:10.1} ms", 1e3 * whole);
    println!("  ... times real time            {:10.1}", end_time / whole);
    println!("  shaking alone, watched         {:10.1} ms", 1e3 * watched.seconds);
    println!("  ... times real time            {:10.1}", end_time / watched.seconds);
    println!("  ... a step                     {:10.3} µs", 1e6 * watched.seconds / watched.steps);
    println!(
        "  ... share of the watching      {:10.1} %",
        100.0 * (1.0 - blind.seconds / watched.seconds)
    );
    println!(
        "  contact elements tested        {:10.1} million/s",
        1e-6 * watched.elements / watched.seconds
    );
    println!(
        "  contacts that touch            {:10.1} million/s",
        1e-6 * touched / watched.seconds
    );
    Ok(())
}

/// Measures the report of a minute of a large stack: time to write it, and its size.
fn report() -> Result<(), Failure> {
    let changes = [
        "stack.view=longitudinal",
        "stack.levels=6",
        "run.duration=60 s",
        "motion.scale.factor=0.6",
    ];
    let scenario = Scenario::builtin("demo-napa", &changes.map(str::to_owned))?;
    let run = scenario.run()?;
    let summary = Summary::of(&run, None);
    let (mut seconds, mut bytes) = (Vec::new(), 0);
    for _ in 0..REPEATS {
        let start = Instant::now();
        bytes = barrelstack_report::html(&barrelstack::report::document(&run, &summary)).len();
        seconds.push(start.elapsed().as_secs_f64());
    }
    println!("the report of {:.0} s of twelve barrels, median of {REPEATS}", run.end_time);
    println!("  from the run to the page       {:10.1} ms", 1e3 * median(seconds));
    println!("  size of the page               {:10.2} MB", 1e-6 * bytes as f64);
    Ok(())
}

/// Measures the cost of a step while the stack stands, against the number of its levels or columns.
fn growth(what: &str, values: impl IntoIterator<Item = u32>) -> Result<(), Failure> {
    /// Time (s) at which the stack still stands.
    const STANDING: f64 = 0.5;
    println!("a step of the standing stack against its {what}");
    println!("  {what:>8}   bodies   tested   touching   µs/step   ns/touching contact");
    for value in values {
        let scenario = Scenario::builtin("candia-8-barrels", &[format!("stack.{what}={value}")])?;
        let stage = Stage::new(&scenario)?;
        let cost =
            stage.measure(|stage, state, scratch| stage.shaken(state, scratch, STANDING, &mut ()));
        let touching = stage.touched(STANDING) / cost.steps;
        println!(
            "  {value:8} {:8} {:8.1} {touching:10.1} {:9.3} {:21.1}",
            stage.assembly.parts.len() - 1,
            cost.elements / cost.steps,
            1e6 * cost.seconds / cost.steps,
            1e9 * cost.seconds / cost.steps / touching,
        );
    }
    Ok(())
}

/// A stack at rest, ready to be shaken repeatedly.
struct Stage {
    scenario: Scenario,
    assembly: Assembly,
    ground: Ground,
    state: State<Planar>,
    scratch: Scratch<Planar>,
    step: f64,
}

/// Cost of a simulation.
struct Cost {
    seconds: f64,
    steps: f64,
    /// Number of tested contact elements.
    elements: f64,
}

impl Stage {
    fn new(scenario: &Scenario) -> Result<Self, Failure> {
        let assembly = assemble(scenario)?;
        let ground = scenario.ground()?;
        let step = assembly.step;
        let mut state = State::initial(&assembly.model);
        let mut scratch = Scratch::new(&assembly.model);
        settle(&assembly.model, &mut state, &mut scratch, 1e-10)?;
        Ok(Self { scenario: scenario.clone(), assembly, ground, state, scratch, step })
    }

    /// Returns the median cost of shaking from rest; `shake` returns its number of steps.
    fn measure(
        &self,
        shake: impl Fn(&Self, &mut State<Planar>, &mut Scratch<Planar>) -> u64,
    ) -> Cost {
        let (mut seconds, mut steps, mut elements) = (Vec::new(), 0, 0);
        for _ in 0..REPEATS {
            let (mut state, mut scratch) = (self.state.clone(), self.scratch.clone());
            let before = scratch.contact_evaluations;
            let start = Instant::now();
            steps = shake(self, &mut state, &mut scratch);
            seconds.push(start.elapsed().as_secs_f64());
            elements = scratch.contact_evaluations - before;
        }
        Cost { seconds: median(seconds), steps: steps as f64, elements: elements as f64 }
    }

    /// Simulates with an observer until `end_time` (s).
    fn shaken(
        &self,
        state: &mut State<Planar>,
        scratch: &mut Scratch<Planar>,
        end_time: f64,
        observer: &mut impl Observer<Planar>,
    ) -> u64 {
        let simulation =
            Simulation { method: Method::VelocityVerlet, time_step: self.step, end_time };
        simulate(&self.assembly.model, &self.ground, state, scratch, &simulation, observer)
            .map_or(0, |totals| totals.steps)
    }

    /// Returns the number of touching contacts until `end_time` (s), summed over all steps.
    fn touched(&self, end_time: f64) -> f64 {
        let (mut state, mut scratch) = (self.state.clone(), self.scratch.clone());
        let mut count = 0;
        let mut counting = look(|_: &State<Planar>, scratch, _| {
            count += scratch.contacts.len();
            ControlFlow::Continue(())
        });
        self.shaken(&mut state, &mut scratch, end_time, &mut counting);
        drop(counting);
        count as f64
    }

    /// Simulates as a run does, with all its observers, until `after` (s) from the collapse.
    fn watched(
        &self,
        state: &mut State<Planar>,
        scratch: &mut Scratch<Planar>,
        after: Option<f64>,
    ) -> u64 {
        let Scene::Stack { outcome, .. } = &self.scenario.scene else { return 0 };
        let record = &self.scenario.record;
        let mut scenario = self.scenario.clone();
        scenario.run.stop_after_collapse = after;
        let mut watch = Watch::new(
            &self.assembly,
            state,
            scratch,
            Thresholds::of(outcome, 1.0),
            (record.frame_rate, record.history_rate),
            End::new(&scenario, &self.assembly, &self.ground),
        );
        let mut watching = look(|state, scratch, energy| {
            watch.see(&self.assembly, &self.ground, state, scratch, energy);
            watch.end(state);
            if watch.ending.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let end_time = self.scenario.run.duration.unwrap_or(12.0);
        self.shaken(state, scratch, end_time, &mut watching)
    }
}

/// Returns the median of an odd number of measurements.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
