//! Summary of a run: a JSON document with the numbers that the report prints.

mod devices;
mod space;

use barrelstack_dynamics::EnergySummary;
use barrelstack_report::described;
use barrelstack_report::described::{Described, Objects};

use crate::assemble::{Part, PartKind};
use crate::demand::{Demands, Span};
use crate::ground::MotionSummary;
use crate::outcome::Outcome;
use crate::run::Run;
use crate::scenario::View;
use crate::variants::{Remedy, Spread};
use crate::verify::Verification;
use crate::watch::{Fate, Joint, PeakForces, StressEnvelope};

pub use devices::{Device, Devices, ElementSummary};
pub use space::{BodyInSpace, Directions, OutcomeInSpace, RunInSpace, SummaryInSpace};

described! {
    /// The summary of a run. Lengths are in m, times in s, forces in N and angles in rad; a value
    /// is null if it does not apply or if the event did not happen.
    #[derive(Clone, Debug)]
    pub struct Summary of run: &Run, wall_seconds: Option<f64> {
        /// Name and version of the format of this document.
        pub schema: &'static str ["summary/2"] = "summary/2",
        /// Title of the scenario.
        pub title: String = run.stated.title.clone(),
        /// The plane of the model; null for a free scene.
        pub view: Option<&'static str> ["transverse", "longitudinal"] = run.assembly.view.map(View::name),
        /// Number of the variant of the stack; 0 is the stack as stated.
        pub variant: u32 = 0,
        /// Statistics of all variants; null if no variants were run.
        pub ensemble: Option<Spread> = None,
        /// Progress of the runs when they were stopped; null if they were not stopped early.
        pub unfinished: Option<Unfinished> = None,
        /// Changes that would have kept the stack up; null if the stack stands, or if no change was searched for.
        pub remedy: Option<Remedy> = None,
        /// Outcome of the run.
        pub outcome: OutcomeSummary = outcome(run),
        /// Every body except the ground; empty if the run is invalid.
        pub bodies: Vec<BodySummary> = bodies(run),
        /// Demands on the stack until the first loss of a seat.
        pub demands: Demands = demands(run, Span::UntilLoss),
        /// Demands on the stack over the whole run, falls included.
        pub demands_whole_run: Demands = demands(run, Span::WholeRun),
        /// Forces between every two bodies that pressed on each other; empty if the run is invalid.
        pub interfaces: Vec<JointSummary> = joints(run),
        /// The force elements of every device.
        #[serde(flatten)]
        pub devices: Devices = Devices::of(run),
        /// The energy balance; null if the computation failed.
        pub energy: Option<EnergyBalance> = run.energy.as_ref().map(EnergyBalance::of),
        /// Ground motion of the run; null if the run has no ground motion.
        pub motion: Option<MotionSummary> = run.ground.motion.as_ref().map(MotionSummary::of),
        /// Settings of the computation, and the amount of work that it took.
        pub run: RunSummary = RunSummary::of(run, wall_seconds),
        /// Warnings about inputs and results.
        pub warnings: Vec<String> = run.warnings.clone(),
        /// Provenance of the result.
        pub provenance: Provenance = Provenance::of(run),
        /// Comparison of the run with its repeats; null if there were no repeats.
        pub verification: Option<Verification> = None,
        /// Summary of the run in the other plane; null if the scenario has only one plane. The summary that contains
        /// this one is that of the governing plane.
        pub other_plane: Option<Box<Summary>> = None,
    }

    /// Progress of runs that were stopped early, counted over the nominal case and all variants in all planes. Runs
    /// that collapse end first, so the finished runs are a biased sample.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Unfinished {
        /// Number of finished runs.
        pub done: usize,
        /// Total number of runs.
        pub of: usize,
    }

    /// Outcome of the run.
    #[derive(Clone, Debug, Default)]
    pub struct OutcomeSummary {
        /// Kind of the outcome.
        pub kind: &'static str ["stable", "collapse", "not-judged", "interrupted", "invalid"],
        /// Mode of the collapse.
        pub mode: Option<&'static str> ["ejection", "rocking", "rack-sliding", "overturning"],
        /// Time at which the first body left its seat.
        pub time: Option<f64> as "s",
        /// Name of the first body that left its seat.
        pub first: Option<String>,
        /// The lowest level that lost its seat.
        pub from_level: Option<u32>,
        /// The highest level involved in the collapse.
        pub to_level: Option<u32>,
        /// Time at which the first barrel counts as fallen.
        pub first_fall: Option<f64> as "s",
        /// Number of barrels that had fallen by the end of the run; null if the run is invalid or was stopped early.
        pub barrels_fallen: Option<usize>,
        /// Number of all barrels.
        pub barrels: usize,
        /// Reason why the run is invalid.
        pub reason: Option<String>,
    }

    /// Result of one body.
    #[derive(Clone, Debug)]
    pub struct BodySummary of part: &Part, fate: Fate, stress: Option<&StressEnvelope> {
        /// Name of the body.
        pub name: String = part.name.clone(),
        /// Kind of the body.
        pub kind: &'static str ["barrel", "rack", "body"] = part.kind.name(),
        /// Level, 1 at the bottom.
        pub level: Option<u32> = part.level,
        /// Column, 1 at the left.
        pub column: Option<u32> = part.column,
        /// Time at which the body left its seat.
        pub left_seat_at: Option<f64> as "s" = fate.left_seat.map(|(time, _)| time),
        /// Time at which the body counts as fallen.
        pub fell_at: Option<f64> as "s" = fate.fell_at,
        /// Largest drop of a fallen body below its position at rest; null if the body did not fall.
        pub fall_height: Option<f64> as "m" = fate.fell_at.map(|_| fate.drop),
        /// Time at which a fallen body landed: when its downward speed fell below half of its
        /// maximum since the fall.
        pub landed_at: Option<f64> as "s" = fate.landed_at,
        /// Largest downward speed before the landing.
        pub landing_speed: Option<f64> as "m/s" = fate.landing_speed,
        /// Largest force on the body after its fall.
        pub fall_force: Option<f64> as "N" = fate.fall_force,
        /// Displacement along x relative to the ground, at the end of the run.
        pub residual_displacement: f64 as "m" = fate.residual_displacement,
        /// Largest displacement along x relative to the ground, while the stack stood.
        pub peak_displacement: f64 as "m" = fate.peak_displacement,
        /// Displacement relative to the support of the body, at the end of the run: the walk of a rack, or the slip of
        /// a barrel in its cradle.
        pub residual_slip: f64 as "m" = fate.residual_slip,
        /// Largest displacement relative to the support, while the stack stood.
        pub peak_slip: f64 as "m" = fate.peak_slip,
        /// Largest rise above the position at rest, while the stack stood.
        pub peak_uplift: f64 as "m" = fate.peak_uplift,
        /// Largest tilt while the stack stood; racks only.
        pub peak_tilt: Option<f64> as "rad" = (part.kind == PartKind::Rack).then_some(fate.peak_tilt),
        /// Largest normal stress at rest, as a force per meter of boundary.
        pub stress_at_rest: Option<f64> as "N/m" = stress.map(|s| s.at_rest.iter().copied().fold(0.0, f64::max)),
        /// Largest normal stress until the first loss of a seat, divided by the largest normal stress
        /// at rest; the two may occur at different points.
        pub stress_amplification: Option<f64> as "1" = stress.and_then(StressEnvelope::amplification),
        /// Average of the largest normal stresses until the first loss of a seat, divided by the
        /// average of the normal stresses at rest; both averages are taken over the boundary that
        /// is loaded at rest.
        pub mean_stress_amplification: Option<f64> as "1" = stress.and_then(StressEnvelope::mean_amplification),
        /// Largest sum of all normal contact forces on the body until the first loss of a seat,
        /// divided by the sum at rest.
        pub total_force_amplification: Option<f64> as "1" = stress.and_then(StressEnvelope::total_amplification),
        /// Stress amplification over the whole run.
        pub stress_amplification_whole_run: Option<f64> as "1" = stress.and_then(StressEnvelope::amplification_whole_run),
    }

    /// The force between two bodies, as it acts on the upper body, or on the body named first if neither rests on the
    /// other. A largest force is the one of largest magnitude over all steps; in a planar model, it has a sign.
    #[derive(Clone, Debug)]
    pub struct JointSummary {
        /// Names of the bodies, such as "R1 on ground", or "R1.1 against R1.2" for bodies that
        /// touched only during the motion.
        pub name: String,
        /// Vertical force at rest.
        pub at_rest: f64 as "N",
        /// Largest vertical force until the first loss of a seat; zero if the two bodies touched only
        /// later.
        pub peak_vertical: f64 as "N",
        /// Time of the largest vertical force until the first loss of a seat.
        pub peak_vertical_at: f64 as "s",
        /// Largest horizontal force until the first loss of a seat.
        pub peak_horizontal: f64 as "N",
        /// Time of the largest horizontal force until the first loss of a seat.
        pub peak_horizontal_at: f64 as "s",
        /// Largest vertical force over the whole run, falls included.
        pub peak_vertical_whole_run: f64 as "N",
        /// Time of the largest vertical force over the whole run.
        pub peak_vertical_whole_run_at: f64 as "s",
        /// Largest horizontal force over the whole run.
        pub peak_horizontal_whole_run: f64 as "N",
        /// Time of the largest horizontal force over the whole run.
        pub peak_horizontal_whole_run_at: f64 as "s",
    }

    /// The energy balance (J) at the end of the run, relative to the start.
    #[derive(Clone, Debug)]
    pub struct EnergyBalance of balance: &EnergySummary {
        /// Kinetic energy.
        pub kinetic: f64 as "J" = balance.kinetic,
        /// Gravitational potential energy.
        pub potential: f64 as "J" = balance.potential,
        /// Energy stored in contact springs and force elements.
        pub elastic: f64 as "J" = balance.elastic,
        /// Energy stored in the tangential springs of sticking contacts.
        pub stick: f64 as "J" = balance.stick,
        /// Energy dissipated by the dampers of contacts and elements, and lost with broken
        /// elements.
        pub damped: f64 as "J" = balance.damped,
        /// Energy dissipated by friction.
        pub friction: f64 as "J" = balance.friction,
        /// Energy dissipated by viscous damping.
        pub viscous: f64 as "J" = balance.viscous,
        /// Work done by the ground.
        pub ground_work: f64 as "J" = balance.ground_work,
        /// Energy that the other terms of the balance do not account for; it is the error of the computation.
        pub residual: f64 as "J" = balance.residual,
        /// The energy exchanged is the work of the ground and of external forces in every step, added up without its
        /// sign, plus the energy available at the start, which is the kinetic energy, the energy of springs, and the
        /// potential energy above its lowest value in the run.
        pub input: f64 as "J" = balance.throughput,
        /// Absolute value of the residual divided by the energy exchanged (`input`).
        pub residual_ratio: f64 as "1" = balance.residual_ratio(),
    }

    /// Settings of the computation, and the amount of work that it took.
    #[derive(Clone, Debug)]
    pub struct RunSummary of run: &Run, wall_seconds: Option<f64> {
        /// Integration method.
        pub method: &'static str = run.simulation.method.name(),
        /// Time step.
        pub time_step: f64 as "s" = run.simulation.time_step,
        /// Number of accepted steps.
        pub steps: u64 = run.work.steps,
        /// Number of evaluations of all forces.
        pub evaluations: u64 = run.work.evaluations,
        /// Number of contact elements tested in all evaluations.
        pub contact_evaluations: u64 = run.work.contact_evaluations,
        /// Simulated time reached.
        pub end_time: f64 as "s" = run.end_time,
        /// Reason why the run ended.
        pub ending: &'static str ["rest", "after-collapse", "duration", "patience", "interrupted", "broken"] = run.ending.name(),
        /// True if the user stopped the run early.
        pub interrupted: bool = run.interrupted,
        /// Unit for which the contact constants are stated: a seat, a contact node or a length of boundary; "mixed" if
        /// it differs between contacts.
        pub stiffness_basis: &'static str ["seat", "node", "length", "mixed"] = run.stiffness_basis(),
        /// Length scale of the similitude; 1 if none is applied.
        pub similitude: f64 as "1" = run.scenario.run.similitude,
        /// Number of steps taken to find equilibrium.
        pub settle_steps: Option<u64> = run.settled.map(|settled| settled.steps),
        /// Wall-clock time of the run; null if it was not measured.
        pub wall_seconds: Option<f64> as "s" = wall_seconds,
    }

    /// Provenance of the result.
    #[derive(Clone, Debug)]
    pub struct Provenance of run: &Run {
        /// Name of the program.
        pub program: &'static str = "barrelstack",
        /// Version of the program.
        pub version: &'static str = env!("CARGO_PKG_VERSION"),
        /// Hash of the scenario, including all defaults.
        pub scenario_hash: String = format!("{:016x}", run.stated.fingerprint()),
        /// Source of the motion and the processing steps applied to it, one sentence each.
        pub motion: Vec<String> = run.ground.motion.iter().flat_map(|motion| motion.provenance.clone()).collect(),
    }
}

impl Unfinished {
    /// Returns a warning that the runs were stopped, and that the share of collapses is therefore unknown.
    pub fn warning(&self) -> String {
        let Self { done, of } = self;
        format!(
            "stopped when {done} of {of} runs were finished: runs that collapse finish sooner, so the share that \
             collapses is not known"
        )
    }
}

impl Summary {
    /// Returns the statistics of the variants in each plane in which they were run, the plane
    /// across the barrels first.
    pub fn spreads(&self) -> Vec<(View, &Spread)> {
        let planes = self.planes().into_iter();
        planes.filter_map(|(view, one)| Some((view, one.ensemble.as_ref()?))).collect()
    }

    /// Returns the summary of each plane in which the stack was run, the plane across the barrels first; empty for a
    /// free scene.
    pub fn planes(&self) -> Vec<(View, &Self)> {
        let own = std::iter::once(self).chain(self.other_plane.as_deref());
        let known = |one: &Self| View::ALL.into_iter().find(|view| Some(view.name()) == one.view);
        let mut all: Vec<_> = own.filter_map(|one| Some((known(one)?, one))).collect();
        all.sort_by_key(|(view, _)| *view == View::Longitudinal);
        all
    }

    /// Returns the summary as indented JSON text.
    ///
    /// ```
    /// use barrelstack::{Scenario, Summary};
    ///
    /// let run = Scenario::builtin("sliding-block", &[])?.run()?;
    /// assert!(Summary::of(&run, None).to_json().contains(r#""kind": "not-judged""#));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_json(&self) -> String {
        // Serialization can only fail for maps with keys other than strings, and there are none.
        described::to_json(self).unwrap_or_default()
    }
}

/// Returns `true` if the results of a run are valid, and `false` if its computation failed.
fn sound(run: &Run) -> bool {
    !matches!(run.outcome, Outcome::Invalid { .. })
}

fn outcome(run: &Run) -> OutcomeSummary {
    let barrels: Vec<usize> = run.assembly.of_kind(PartKind::Barrel).collect();
    let fallen = barrels.iter().filter(|body| run.fates.fate(**body).fell_at.is_some());
    OutcomeSummary::of(&run.outcome, run.fates.first_fall(), [fallen.count(), barrels.len()])
}

impl OutcomeSummary {
    /// Summarizes an outcome.
    ///
    /// `first_fall` is the time (s) of the first fall of a barrel, `None` if no barrel falls. `fallen` is the number of
    /// fallen barrels, and `barrels` the number of all barrels. The summary of an invalid or interrupted run omits the
    /// time of the first fall and the number of fallen barrels.
    pub fn of(outcome: &Outcome, first_fall: Option<f64>, [fallen, barrels]: [usize; 2]) -> Self {
        // For an interrupted run, falls are reported per body but not in the outcome.
        let ended = !matches!(outcome, Outcome::Invalid { .. } | Outcome::Interrupted);
        let summary = Self {
            kind: outcome.kind(),
            first_fall: first_fall.filter(|_| ended),
            barrels_fallen: ended.then_some(fallen),
            barrels,
            ..Self::default()
        };
        match outcome {
            Outcome::Collapse { mode, time, first, from_level, to_level } => Self {
                mode: Some(mode.name()),
                time: Some(*time),
                first: Some(first.clone()),
                from_level: Some(*from_level),
                to_level: Some(*to_level),
                ..summary
            },
            Outcome::Invalid { reason } => Self { reason: Some(reason.clone()), ..summary },
            Outcome::Stable | Outcome::NotJudged | Outcome::Interrupted => summary,
        }
    }
}

/// The summary of a run in a plane or in three dimensions.
#[derive(Clone, Debug, serde::Serialize)]
#[serde(untagged)]
pub enum AnySummary {
    /// Summary of a run in a plane.
    Planar(Box<Summary>),
    /// Summary of a three-dimensional run.
    Spatial(Box<SummaryInSpace>),
}

/// Evaluates an expression on the contained summary, whether planar or three-dimensional.
macro_rules! either {
    ($of:expr, $one:pat => $value:expr) => {
        match $of {
            AnySummary::Planar($one) => $value,
            AnySummary::Spatial($one) => $value,
        }
    };
}

impl AnySummary {
    /// Returns the outcome of the run.
    pub fn outcome(&self) -> &OutcomeSummary {
        match self {
            Self::Planar(summary) => &summary.outcome,
            Self::Spatial(summary) => &summary.outcome.common,
        }
    }

    /// Returns the statistics of all variants; `None` if no variants were run.
    pub fn ensemble(&self) -> Option<&Spread> {
        either!(self, summary => summary.ensemble.as_ref())
    }

    /// Returns the demands on the stack until the first loss of a seat.
    pub fn demands(&self) -> &Demands {
        either!(self, summary => &summary.demands)
    }

    /// Returns the number of the variant of the stack; 0 is the stack as stated.
    pub fn variant(&self) -> u32 {
        either!(self, summary => summary.variant)
    }

    /// Returns the changes that would have kept the stack up; `None` if the stack stands, or if no search was
    /// made.
    pub fn remedy(&self) -> Option<&Remedy> {
        either!(self, summary => summary.remedy.as_ref())
    }

    /// Returns the warnings about inputs and results.
    pub fn warnings(&self) -> &[String] {
        either!(self, summary => &summary.warnings)
    }
}

impl Described for AnySummary {
    fn schema(objects: &mut Objects) -> serde_json::Value {
        let either = [Summary::schema(objects), SummaryInSpace::schema(objects)];
        serde_json::json!({ "anyOf": either })
    }
}

fn bodies(run: &Run) -> Vec<BodySummary> {
    let parts = run.assembly.parts.iter().enumerate().filter(|_| sound(run));
    parts
        .filter(|(_, part)| part.kind != PartKind::Ground)
        .map(|(i, part)| BodySummary::of(part, run.fates.fate(i), run.stresses.of(i)))
        .collect()
}

fn demands(run: &Run, span: Span) -> Demands {
    if !sound(run) {
        return Demands::default();
    }
    Demands::of(&run.assembly, &run.fates, &run.stresses, run.recording.forces(), span)
}

impl JointSummary {
    /// Summarizes the forces between two bodies, with a name for the pair; `None` if the bodies never
    /// touched.
    pub fn of(name: String, joint: &Joint) -> Option<Self> {
        let PeakForces { vertical, horizontal } = joint.until_loss;
        let whole = joint.whole_run;
        joint.has_met().then_some(Self {
            name,
            at_rest: joint.at_rest,
            peak_vertical: vertical.0,
            peak_vertical_at: vertical.1,
            peak_horizontal: horizontal.0,
            peak_horizontal_at: horizontal.1,
            peak_vertical_whole_run: whole.vertical.0,
            peak_vertical_whole_run_at: whole.vertical.1,
            peak_horizontal_whole_run: whole.horizontal.0,
            peak_horizontal_whole_run_at: whole.horizontal.1,
        })
    }
}

fn joints(run: &Run) -> Vec<JointSummary> {
    let joints = run.recording.forces().listed().into_iter().filter(|_| sound(run));
    joints.filter_map(|joint| JointSummary::of(joint.name(&run.assembly), joint)).collect()
}
