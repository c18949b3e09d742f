//! Reliability of a run, from repeats with a shorter time step, with more closely spaced nodes, and with tiny
//! perturbations.
//!
//! Contact is chaotic: after enough impacts, two runs that differ only in the last digit diverge.
//! Results before the divergence are predictions; later results are one possible course. A verdict
//! that all repeats share is nevertheless robust.

mod robust;

use std::fmt::Write as _;
use std::ops::ControlFlow;

use barrelstack_report::described;

use crate::assemble::PartKind;
use crate::run::{Progress, Run, RunFailure};
use crate::scenario::{
    Basis, BodyOverride, Method, Nodes, Scenario, Scene, SeatContact, StackBody, View,
};
use crate::summary::{OutcomeSummary, Summary};
use crate::variants::run_together;
use crate::watch::Channel;
use barrelstack_dynamics::Simulation;

pub use robust::Robust;

/// Distance (m at full scale) beyond which the positions of a body in two runs count as diverged.
pub const APART: f64 = 0.01;

/// Largest initial displacement (m at full scale) of a body in a perturbed repeat.
pub const DISTURBANCE: f64 = 1e-9;

/// Number of perturbed repeats.
pub const DISTURBED: u64 = 4;

described! {
    /// Comparison of a run with its repeats. Times are in s and lengths in m, at the scale of the
    /// run.
    #[derive(Clone, Debug)]
    pub struct Verification {
        /// Distance beyond which the positions of a body in two runs count as diverged.
        pub apart: f64 as "m",
        /// Time until which every body in every repeat stays within the distance `apart` of its position in the run;
        /// null if this holds to the end of the run.
        pub predictable_until: Option<f64> as "s",
        /// Agreement between the run and its repeats.
        pub robust: Robust,
        /// The repeats.
        pub repeats: Vec<Repeat>,
        /// Repeats that were not made, or were stopped.
        pub skipped: Vec<Skipped>,
    }

    /// One repeat of the run.
    #[derive(Clone, Debug)]
    pub struct Repeat {
        /// What the repeat changes in the run.
        pub change: String,
        /// Outcome of the repeat.
        pub outcome: OutcomeSummary,
        /// True if kind, mode and first body are the same as in the run.
        pub same_outcome: bool,
        /// Time at which a body is first farther than the distance `apart` from its position in the
        /// run; null if no body ever is.
        pub apart_at: Option<f64> as "s",
        /// Largest difference between the fall times of a barrel in the repeat and in the run,
        /// before any repeat diverges; null if no barrel falls by then.
        pub fall_difference: Option<f64> as "s",
        /// Time at which each barrel counts as fallen.
        #[serde(skip)]
        falls: Vec<Option<f64>>,
    }

    /// A repeat that was not made, or was stopped.
    #[derive(Clone, Debug)]
    pub struct Skipped {
        /// Name of the repeat, such as "nodes at half the spacing".
        pub change: &'static str,
        /// Reason why the repeat was not made, or was stopped.
        pub reason: String,
    }
}

/// A run that can be repeated, in a plane or in three dimensions.
pub trait Repeatable: Sized + Send + Sync {
    /// Runs a scenario; the observer receives the progress and may cancel.
    ///
    /// # Errors
    /// When the scenario cannot be built, or its stack does not stand by itself.
    fn again(
        scenario: &Scenario,
        observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Self, RunFailure>;

    /// Returns the scenario of the run.
    fn scenario(&self) -> &Scenario;

    /// Returns the integration settings.
    fn simulation(&self) -> &Simulation;

    /// `true` if the run was stopped early.
    fn is_interrupted(&self) -> bool;

    /// Returns the outcome.
    fn outcome(&self) -> OutcomeSummary;

    /// Returns, for each barrel, the time (s) at which it counts as fallen; `None` if it does not fall.
    fn falls(&self) -> Vec<Option<f64>>;

    /// Returns the times (s) of the samples.
    fn times(&self) -> &[f64];

    /// Returns, for every body, its displacement x, y, z (m) relative to the ground in every sample; zero along an axis
    /// that the model lacks.
    fn paths(&self) -> Vec<Vec<[f64; 3]>>;
}

impl Repeatable for Run {
    fn again(
        scenario: &Scenario,
        observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Self, RunFailure> {
        scenario.run_watched(observer)
    }

    fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    fn is_interrupted(&self) -> bool {
        self.interrupted
    }

    fn outcome(&self) -> OutcomeSummary {
        Summary::of(self, None).outcome
    }

    fn falls(&self) -> Vec<Option<f64>> {
        let barrels = self.assembly.of_kind(PartKind::Barrel);
        barrels.map(|body| self.fates.fate(body).fell_at).collect()
    }

    fn times(&self) -> &[f64] {
        &self.recording.times
    }

    fn paths(&self) -> Vec<Vec<[f64; 3]>> {
        let channels: Vec<_> = self
            .recording
            .channels
            .iter()
            .filter(|channel| {
                channel.name.contains("_displacement_") && !channel.name.starts_with("ground")
            })
            .collect();
        // Displacement channels come in pairs, x and z of each body.
        let path = |pair: &[&Channel]| {
            pair[0].values.iter().zip(&pair[1].values).map(|(x, z)| [*x, 0.0, *z]).collect()
        };
        channels.chunks_exact(2).map(path).collect()
    }
}

/// Repeats a run: with half the step (for an adaptive method, with a tenth of the tolerance), with nodes at half the
/// spacing, and four times with the bodies displaced by up to a nanometer.
///
/// `progress` receives the combined progress of all repeats and may cancel; canceled repeats are
/// listed as skipped.
///
/// # Errors
/// When a repeat cannot be built, or its stack does not stand by itself.
pub fn verify<R: Repeatable>(
    base: &R,
    progress: &mut (dyn FnMut(Progress) -> ControlFlow<()> + Send),
) -> Result<Verification, RunFailure> {
    let (change, finer) = finer_step(base);
    let (mut changes, mut scenarios, mut skipped) = (vec![change], vec![finer], Vec::new());
    let mut add = |change: String, scenario| {
        changes.push(change);
        scenarios.push(scenario);
    };
    match finer_nodes(base.scenario()) {
        Ok(scenario) => add("nodes at half the spacing".to_owned(), scenario),
        Err(reason) => skipped.push(Skipped { change: "nodes at half the spacing", reason }),
    }
    for seed in 1..=DISTURBED {
        let change = format!("disturbed by 1 nm, {seed} of {DISTURBED}");
        add(change, disturbed(base.scenario(), seed));
    }
    let mut repeats = Vec::new();
    // A canceled repeat becomes `None`.
    let own = Base { run: base, outcome: base.outcome(), paths: base.paths() };
    let repeat =
        |at: usize, run: R| (!run.is_interrupted()).then(|| Repeat::of(&own, &run, &changes[at]));
    let done = run_together(&scenarios, base.simulation().end_time, progress, &R::again, &repeat)?;
    for (repeat, change) in done.into_iter().zip(&changes) {
        if let Some(repeat) = repeat {
            repeats.push(repeat);
        } else {
            let disturbed = change.starts_with("disturbed");
            let change = if disturbed { "a disturbed repeat" } else { "a finer repeat" };
            skipped.push(Skipped { change, reason: "stopped before its end".into() });
        }
    }
    Ok(judge(base, repeats, skipped))
}

/// Returns the scenario with half the time step (for an adaptive method, with a tenth of the
/// tolerance), and the name of the change.
fn finer_step<R: Repeatable>(base: &R) -> (String, Scenario) {
    let mut scenario = base.scenario().clone();
    if let Method::BogackiShampine { tolerance } = &mut scenario.run.method {
        *tolerance *= 0.1;
        return ("a tenth of the tolerance".into(), scenario);
    }
    scenario.run.step = Some(0.5 * base.simulation().time_step / scenario.run.similitude.sqrt());
    ("half the step".into(), scenario)
}

/// Returns the scenario with nodes at half the spacing, or the reason why halving the spacing would
/// change the stack.
fn finer_nodes(scenario: &Scenario) -> Result<Scenario, String> {
    const PER_NODE: &str =
        "contact constants are stated per node, so more nodes would make the contacts stiffer";
    const IN_SPACE: &str = "bodies of a three-dimensional model have no contact nodes";
    let mut finer = scenario.clone();
    match &mut finer.scene {
        Scene::Spatial(_) => return Err(IN_SPACE.into()),
        Scene::Stack { stack, .. } if stack.space.is_some() => return Err(IN_SPACE.into()),
        Scene::Stack { stack, .. } => {
            let seats = [stack.interfaces.rack_ground, stack.interfaces.barrel_rack];
            if seats.iter().any(|interface| interface.basis == Basis::Node) {
                return Err(PER_NODE.into());
            }
            if stack.rack.contact != SeatContact::Nodes {
                return Err("no rack has contact nodes along its faces".into());
            }
            let per_seat = seats.iter().all(|interface| interface.basis == Basis::Seat);
            if stack.view == View::Transverse && !per_seat {
                return Err(
                    "contact constants are stated per unit length, and in the transverse section a cradle support, a \
                     beam corner or a rolling barrel touches with a single node, whose stiffness is proportional to \
                     the node spacing, so halving the spacing would make these contacts softer"
                        .into(),
                );
            }
            stack.rack.node_spacing *= 0.5;
        }
        Scene::Free(scene) => {
            if scene.interfaces.iter().any(|interface| interface.law.basis == Basis::Node) {
                return Err(PER_NODE.into());
            }
            let mut refined = false;
            for body in &mut scene.bodies {
                let further = body.boundaries.iter_mut().map(|boundary| &mut boundary.nodes);
                for nodes in further.chain([&mut body.nodes]) {
                    match nodes {
                        Nodes::Spacing(spacing) => *spacing *= 0.5,
                        Nodes::Count(count) => *count *= 2,
                        Nodes::Corners | Nodes::Rolling | Nodes::Exact | Nodes::At(_) => continue,
                    }
                    refined = true;
                }
            }
            if !refined {
                return Err("no body has contact nodes along its sides".into());
            }
        }
    }
    Ok(finer)
}

/// Returns the scenario with random horizontal displacements of every barrel of a stack, or of every movable body of a
/// free scene. Each component is at most a nanometer.
fn disturbed(scenario: &Scenario, seed: u64) -> Scenario {
    let mut changed = scenario.clone();
    let mut state = seed;
    let mut offset = || DISTURBANCE * noise(&mut state);
    match &mut changed.scene {
        Scene::Stack { stack, .. } => {
            let (levels, columns) = (stack.levels, stack.columns);
            let rows: Vec<Option<u32>> = match stack.space {
                Some(space) => (1..=space.columns_along).map(Some).collect(),
                None => vec![None],
            };
            let places = rows.into_iter().flat_map(|row| {
                let of = move |level| (1..=columns).map(move |column| (level, column, row));
                (1..=levels).flat_map(of)
            });
            stack.overrides.extend(places.map(|(level, column, row)| BodyOverride {
                body: StackBody::Barrel,
                level,
                column: Some(column),
                row,
                mass: None,
                fill: None,
                offset_x: offset(),
                offset_y: row.map_or(0.0, |_| offset()),
            }));
        }
        Scene::Spatial(scene) => {
            for body in scene.bodies.iter_mut().filter(|body| !body.fixed_to_ground) {
                body.position[0] += offset();
            }
        }
        Scene::Free(scene) => {
            for body in scene.bodies.iter_mut().filter(|body| !body.fixed_to_ground) {
                body.position[0] += offset();
            }
        }
    }
    changed
}

/// Returns a pseudorandom number between −1 and 1 (`SplitMix64` of Steele, Lea and Flood 2014).
fn noise(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    // The upper 53 bits as an integer below 2⁵³.
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// The run with which repeats are compared, its outcome, and the paths of its bodies (m).
struct Base<'a, R> {
    run: &'a R,
    outcome: OutcomeSummary,
    paths: Vec<Vec<[f64; 3]>>,
}

impl Repeat {
    /// Compares a repeat with the base run.
    fn of<R: Repeatable>(base: &Base<'_, R>, other: &R, change: &str) -> Self {
        let (outcome, own) = (other.outcome(), &base.outcome);
        Self {
            change: change.to_owned(),
            // Kind, mode and first body.
            same_outcome: (outcome.kind, outcome.mode, &outcome.first)
                == (own.kind, own.mode, &own.first),
            outcome,
            apart_at: apart_at((base.run, &base.paths), other),
            fall_difference: None,
            falls: other.falls(),
        }
    }
}

/// Returns the first sample time (s) at which a body is farther than [`APART`] from its position in
/// the base run; `None` if there is no such sample.
fn apart_at<R: Repeatable>((base, paths): (&R, &[Vec<[f64; 3]>]), other: &R) -> Option<f64> {
    let limit = APART * base.scenario().run.similitude;
    let (times, others) = (other.times(), other.paths());
    let mut before = 0;
    for (at, time) in base.times().iter().enumerate() {
        // Samples are taken at the first step after they are due, so their times differ between the
        // runs.
        while before + 2 < times.len() && times[before + 1] <= *time {
            before += 1;
        }
        let (Some(from), Some(to)) = (times.get(before), times.get(before + 1)) else { break };
        if *time > *to {
            break;
        }
        let share = ((time - from) / (to - from)).clamp(0.0, 1.0);
        for (mine, theirs) in paths.iter().zip(&others) {
            let [x, y, z] = [0, 1, 2].map(|axis| {
                let (a, b) = (theirs[before][axis], theirs[before + 1][axis]);
                a + (b - a) * share - mine[at][axis]
            });
            // A value that is not finite counts as diverged.
            let distance = libm::hypot(libm::hypot(x, z), y);
            if distance > limit || distance.is_nan() {
                return Some(*time);
            }
        }
    }
    None
}

/// Compares the fall times of every repeat with those of the base run, and combines all repeats into one result.
fn judge<R: Repeatable>(base: &R, mut repeats: Vec<Repeat>, skipped: Vec<Skipped>) -> Verification {
    let predictable_until = repeats.iter().filter_map(|repeat| repeat.apart_at).reduce(f64::min);
    let until = predictable_until.unwrap_or(f64::INFINITY);
    let scale = base.scenario().run.similitude;
    let own = base.falls();
    for repeat in &mut repeats {
        let pairs = own.iter().zip(&repeat.falls);
        // A barrel that falls in only one of the two runs has an infinite difference.
        let differences = pairs.filter_map(|pair| match pair {
            (Some(mine), Some(theirs)) if mine.min(*theirs) < until => Some((mine - theirs).abs()),
            (Some(one), None) | (None, Some(one)) if *one < until => Some(f64::INFINITY),
            _ => None,
        });
        repeat.fall_difference = differences.reduce(f64::max);
    }
    let robust = Robust::of(&base.outcome(), &repeats);
    Verification { apart: APART * scale, predictable_until, robust, repeats, skipped }
}

/// Formats a short time (s) for display.
fn shortly(time: f64) -> String {
    if time < 1.0 { format!("{:.1} ms", 1e3 * time) } else { format!("{time:.1} s") }
}

impl Verification {
    fn judged(&self) -> bool {
        self.repeats.iter().any(|repeat| repeat.outcome.kind != "not-judged")
    }

    /// Returns the names of the parts of the outcome that are compared. If no repeat collapses, this is
    /// only the kind of the outcome.
    fn parts(&self) -> &'static [&'static str] {
        let collapses = self.repeats.iter().any(|repeat| repeat.outcome.mode.is_some());
        if collapses { &["kind", "mode", "first body"] } else { &["kind"] }
    }

    /// Describes the findings in plain sentences.
    pub fn sentences(&self) -> Vec<String> {
        if self.repeats.is_empty() {
            return vec![
                "No repeat of this run reached its end, so its reliability is not known.".into(),
            ];
        }
        let mut sentences = Vec::new();
        if self.judged() {
            let Robust { first_fall_within, barrels_fallen: [least, most], .. } = self.robust;
            let count = self.repeats.len();
            sentences.push(if self.robust.outcome() {
                format!(
                    "The outcome ({}) is robust: it is the same in all {count} repeats, with a finer step or with barrels \
                     displaced by a nanometer.",
                    self.parts().join(", ")
                )
            } else {
                let others = self.repeats.iter().filter(|repeat| !repeat.same_outcome).count();
                let end = if others == 1 { "ends" } else { "end" };
                format!(
                    "The outcome is not robust: {others} of {count} repeats, with a finer step or with barrels \
                     displaced by a nanometer, {end} differently; judge this stack by many variants."
                )
            });
            sentences.extend(first_fall_within.map(|late| {
                format!(
                    "In all repeats, the first barrel falls within {} of the time at which it falls in this run.",
                    shortly(late)
                )
            }));
            sentences.extend((most > 0).then(|| match least {
                1 if most == 1 => "1 barrel falls in the run and in all repeats.".to_owned(),
                _ if least == most => format!("{most} barrels fall in the run and in all repeats."),
                _ => format!("The number of barrels that fall is not robust: {least} to {most}."),
            }));
        }
        let centimeters = barrelstack_report::significant(100.0 * self.apart, 2);
        sentences.push(match self.predictable_until {
            Some(time) => format!(
                "Details are predictable until {time:.2} s; after that, a body in at least one repeat is more than \
                 {centimeters} cm from its position in this run, so the run shows only one possible course of events."
            ),
            None => format!(
                "Details are predictable to the end: in every repeat each body stays within \
                 {centimeters} cm of its position in the run."
            ),
        });
        sentences
    }

    /// Returns the findings as pairs of strings: name and value.
    pub fn rows(&self) -> Vec<(String, String)> {
        const UNKNOWN: &str = "not known: no repeat reached its end";
        let centimeters = barrelstack_report::significant(100.0 * self.apart, 2);
        let mut rows = Vec::new();
        let mut row = |name: &str, value: String| rows.push((name.to_owned(), value));
        let predictable = match self.predictable_until {
            None if self.repeats.is_empty() => UNKNOWN.to_owned(),
            Some(time) => format!(
                "until {time:.2} s; after that, a body in at least one repeat is more than {centimeters} cm from its \
                 position in the run"
            ),
            None => {
                format!(
                    "to the end; every body in every repeat stays within {centimeters} cm of its position in the run"
                )
            }
        };
        row("predictable", predictable);
        let count = self.repeats.len();
        let outcome = if self.repeats.is_empty() {
            UNKNOWN.to_owned()
        } else if !self.judged() {
            "not judged, because a free scene has no verdict".to_owned()
        } else if self.robust.outcome() {
            format!("robust in {}: the same in all {count} repeats", self.parts().join(", "))
        } else {
            let alike = self.repeats.iter().filter(|repeat| repeat.same_outcome).count();
            format!("not robust: the same in {alike} of {count} repeats")
        };
        row("outcome", outcome);
        if let Some(late) = self.robust.first_fall_within {
            row("first fall", format!("within {} in all repeats", shortly(late)));
        }
        // Without repeats there is no judgment.
        match self.robust.barrels_fallen {
            _ if !self.judged() => {}
            [least, most] if least == most => row("barrels fallen", format!("{most} in all runs")),
            [least, most] => row("barrels fallen", format!("not robust: {least} to {most}")),
        }
        for repeat in &self.repeats {
            let outcome = &repeat.outcome;
            let mut what = match (outcome.mode, outcome.time, &outcome.first) {
                (Some(mode), Some(time), Some(first)) => {
                    format!("{} by {mode} at {time:.3} s, {first} first", outcome.kind)
                }
                _ => outcome.kind.to_owned(),
            };
            if let Some(difference) = repeat.fall_difference {
                // Writing to a String cannot fail.
                let _ = write!(what, "; falls within {:.1} ms", 1e3 * difference);
            }
            if let Some(time) = repeat.apart_at {
                let _ = write!(what, "; diverges at {time:.2} s");
            }
            row(&format!("  {}", repeat.change), what);
        }
        for skipped in &self.skipped {
            row(&format!("  {}", skipped.change), format!("not repeated: {}", skipped.reason));
        }
        rows
    }
}
