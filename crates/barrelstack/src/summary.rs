//! The summary of a run: one JSON document, the same numbers in print.

mod devices;

use barrelstack_dynamics::EnergySummary;
use barrelstack_report::described;

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

described! {
    /// The summary of a run. Lengths in m, times in s, forces in N, angles in rad; null where it did not
    /// happen or does not apply.
    #[derive(Clone, Debug)]
    pub struct Summary of run: &Run, wall_seconds: Option<f64> {
        /// Name and version of this layout.
        pub schema: &'static str ["summary/2"] = "summary/2",
        /// The scenario's title.
        pub title: String = run.stated.title.clone(),
        /// The plane of the model; null for a free scene.
        pub view: Option<&'static str> ["transverse", "longitudinal"] = run.assembly.view.map(View::name),
        /// Which variant of the stack this is; 0 as it is stated.
        pub variant: u32 = 0,
        /// Statistics of all variants; null where none were run.
        pub ensemble: Option<Spread> = None,
        /// Number of its runs that were done; null unless they were stopped before all were.
        pub unfinished: Option<Unfinished> = None,
        /// Changes that would have kept the stack up; null where it stands, or none was searched.
        pub remedy: Option<Remedy> = None,
        /// Outcome of the run.
        pub outcome: OutcomeSummary = outcome(run),
        /// Every body but the ground; none where the run is invalid.
        pub bodies: Vec<BodySummary> = bodies(run),
        /// Demands on the stack until the first loss of seat.
        pub demands: Demands = demands(run, Span::UntilLoss),
        /// Demands on the stack over the whole run, falls included.
        pub demands_whole_run: Demands = demands(run, Span::WholeRun),
        /// Forces between all bodies that have pressed on each other; none where the run is invalid.
        pub interfaces: Vec<JointSummary> = joints(run),
        /// The force elements of every device, where there are any.
        #[serde(flatten)]
        pub devices: Devices = Devices::of(run),
        /// The energy balance; null where numbers were lost.
        pub energy: Option<EnergyBalance> = run.energy.as_ref().map(EnergyBalance::of),
        /// Ground motion of the run.
        pub motion: Option<MotionSummary> = run.ground.motion.as_ref().map(MotionSummary::of),
        /// Settings and work of the computation.
        pub run: RunSummary = RunSummary::of(run, wall_seconds),
        /// Warnings.
        pub warnings: Vec<String> = run.warnings.clone(),
        /// Provenance of the result.
        pub provenance: Provenance = Provenance::of(run),
        /// Comparison with its repeats; null where there were none.
        pub verification: Option<Verification> = None,
        /// The same of the other plane, where the scenario looks at its stack in both: this one is the worse.
        pub other_plane: Option<Box<Summary>> = None,
    }

    /// Runs of the stack as it is stated and of its variants, in all planes, which were stopped before all were done:
    /// those that collapse end first, so what is done is no sample of all.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Unfinished {
        /// Runs that are done.
        pub done: usize,
        /// Runs in all.
        pub of: usize,
    }

    /// Outcome of the run.
    #[derive(Clone, Debug, Default)]
    pub struct OutcomeSummary {
        /// Kind of the outcome.
        pub kind: &'static str ["stable", "collapse", "not-judged", "interrupted", "invalid"],
        /// Mode of the collapse.
        pub mode: Option<&'static str> ["ejection", "rocking", "rack-sliding", "overturning"],
        /// When the first body left its seat.
        pub time: Option<f64> as "s",
        /// Name of the first body that left its seat.
        pub first: Option<String>,
        /// The lowest level that gave way.
        pub from_level: Option<u32>,
        /// The highest level that went.
        pub to_level: Option<u32>,
        /// When the first barrel had fallen.
        pub first_fall: Option<f64> as "s",
        /// Barrels that had fallen at the end; null where the run is invalid or was stopped before.
        pub barrels_fallen: Option<usize>,
        /// Barrels in all.
        pub barrels: usize,
        /// Why the run is invalid.
        pub reason: Option<String>,
    }

    /// One body.
    #[derive(Clone, Debug)]
    pub struct BodySummary of part: &Part, fate: Fate, stress: Option<&StressEnvelope> {
        /// Its name.
        pub name: String = part.name.clone(),
        /// Kind of the body.
        pub kind: &'static str ["barrel", "rack", "body"] = part.kind.name(),
        /// Level, 1 at the bottom.
        pub level: Option<u32> = part.level,
        /// Column, 1 at the left.
        pub column: Option<u32> = part.column,
        /// When it left its seat.
        pub left_seat_at: Option<f64> as "s" = fate.left_seat.map(|(time, _)| time),
        /// When it had fallen.
        pub fell_at: Option<f64> as "s" = fate.fell_at,
        /// Largest drop below its place at rest, for what fell.
        pub fall_height: Option<f64> as "m" = fate.fell_at.map(|_| fate.drop),
        /// When it landed: when it went down less than half as fast as it had since it fell.
        pub landed_at: Option<f64> as "s" = fate.landed_at,
        /// Its largest speed downward until then.
        pub landing_speed: Option<f64> as "m/s" = fate.landing_speed,
        /// Largest force on it since it had fallen.
        pub fall_force: Option<f64> as "N" = fate.fall_force,
        /// Displacement along x relative to the ground, at the end.
        pub residual_displacement: f64 as "m" = fate.residual_displacement,
        /// Largest displacement along x relative to the ground, while the stack stood.
        pub peak_displacement: f64 as "m" = fate.peak_displacement,
        /// Displacement relative to what it stands on, at the end: a rack's walk, a barrel's slip in its
        /// cradle.
        pub residual_slip: f64 as "m" = fate.residual_slip,
        /// Largest such displacement while the stack stood.
        pub peak_slip: f64 as "m" = fate.peak_slip,
        /// Largest rise above its place at rest while the stack stood.
        pub peak_uplift: f64 as "m" = fate.peak_uplift,
        /// Largest tilt while the stack stood; racks only.
        pub peak_tilt: Option<f64> as "rad" = (part.kind == PartKind::Rack).then_some(fate.peak_tilt),
        /// Largest normal stress at rest, per meter of boundary.
        pub stress_at_rest: Option<f64> as "N/m" = stress.map(|s| s.at_rest.iter().copied().fold(0.0, f64::max)),
        /// Largest normal stress until the first loss of seat, over the largest at rest, wherever each of them is.
        pub stress_amplification: Option<f64> as "1" = stress.and_then(StressEnvelope::amplification),
        /// The largest normal stresses until the first loss of seat, averaged over the boundary that is loaded at
        /// rest, over the average at rest.
        pub mean_stress_amplification: Option<f64> as "1" = stress.and_then(StressEnvelope::mean_amplification),
        /// Largest sum of all normal contact forces on the body until the first loss of seat, over that at rest.
        pub total_force_amplification: Option<f64> as "1" = stress.and_then(StressEnvelope::total_amplification),
        /// As `stress_amplification`, over the whole run.
        pub stress_amplification_whole_run: Option<f64> as "1" = stress.and_then(StressEnvelope::amplification_whole_run),
    }

    /// The force between two bodies: on the upper one, or on the one that is named first where neither leans on the
    /// other by design. Largest forces are those of any step that are largest in size, in a plane with their sign.
    #[derive(Clone, Debug)]
    pub struct JointSummary {
        /// Such as "R1 on ground"; "R1.1 against R1.2" where the two have met while shaken.
        pub name: String,
        /// Vertical force at rest.
        pub at_rest: f64 as "N",
        /// Largest vertical force until the first loss of seat; zero where the two met only later.
        pub peak_vertical: f64 as "N",
        /// When.
        pub peak_vertical_at: f64 as "s",
        /// Largest horizontal force until the first loss of seat.
        pub peak_horizontal: f64 as "N",
        /// When.
        pub peak_horizontal_at: f64 as "s",
        /// Largest vertical force over the whole run, falls included.
        pub peak_vertical_whole_run: f64 as "N",
        /// When.
        pub peak_vertical_whole_run_at: f64 as "s",
        /// Largest horizontal force over the whole run.
        pub peak_horizontal_whole_run: f64 as "N",
        /// When.
        pub peak_horizontal_whole_run_at: f64 as "s",
    }

    /// The energy balance at the end (J), relative to the start.
    #[derive(Clone, Debug)]
    pub struct EnergyBalance of balance: &EnergySummary {
        /// Kinetic energy.
        pub kinetic: f64 as "J" = balance.kinetic,
        /// Potential energy in gravity.
        pub potential: f64 as "J" = balance.potential,
        /// In contact springs and force elements.
        pub elastic: f64 as "J" = balance.elastic,
        /// In sticks.
        pub stick: f64 as "J" = balance.stick,
        /// Lost in the dampers of contacts and elements, and with elements that broke.
        pub damped: f64 as "J" = balance.damped,
        /// Lost to friction.
        pub friction: f64 as "J" = balance.friction,
        /// Lost to viscous damping.
        pub viscous: f64 as "J" = balance.viscous,
        /// Work of the ground.
        pub ground_work: f64 as "J" = balance.ground_work,
        /// Residual of the balance.
        pub residual: f64 as "J" = balance.residual,
        /// Energy that went through: absolute work of the ground plus the drop of potential energy.
        pub input: f64 as "J" = balance.throughput,
        /// |residual| / input.
        pub residual_ratio: f64 as "1" = balance.residual_ratio(),
    }

    /// Settings and work of the computation.
    #[derive(Clone, Debug)]
    pub struct RunSummary of run: &Run, wall_seconds: Option<f64> {
        /// Integration method.
        pub method: &'static str = run.simulation.method.name(),
        /// Time step.
        pub time_step: f64 as "s" = run.simulation.time_step,
        /// Accepted steps.
        pub steps: u64 = run.work.steps,
        /// Evaluations of all forces.
        pub evaluations: u64 = run.work.evaluations,
        /// Contact elements tested.
        pub contact_evaluations: u64 = run.work.contact_evaluations,
        /// Simulated time reached.
        pub end_time: f64 as "s" = run.end_time,
        /// Why it ended.
        pub ending: &'static str ["rest", "after-collapse", "duration", "patience", "interrupted", "broken"] = run.ending.name(),
        /// True if the user stopped it early.
        pub interrupted: bool = run.interrupted,
        /// Basis of the contact constants.
        pub stiffness_basis: &'static str ["seat", "node", "length", "mixed"] = run.stiffness_basis(),
        /// Length scale of similitude.
        pub similitude: f64 as "1" = run.scenario.run.similitude,
        /// Steps taken to find equilibrium.
        pub settle_steps: Option<u64> = run.settled.map(|settled| settled.steps),
        /// Time on the clock.
        pub wall_seconds: Option<f64> as "s" = wall_seconds,
    }

    /// Provenance of the result.
    #[derive(Clone, Debug)]
    pub struct Provenance of run: &Run {
        /// The program.
        pub program: &'static str = "barrelstack",
        /// Its version.
        pub version: &'static str = env!("CARGO_PKG_VERSION"),
        /// Hash of the scenario with every default written out.
        pub scenario_hash: String = format!("{:016x}", run.stated.fingerprint()),
        /// Where the motion came from and what was done to it, one sentence each.
        pub motion: Vec<String> = run.ground.motion.iter().flat_map(|motion| motion.provenance.clone()).collect(),
    }
}

impl Unfinished {
    /// Returns a caveat for the reader of a result.
    pub fn warning(&self) -> String {
        let Self { done, of } = self;
        format!(
            "{done} of {of} runs were done when it was stopped, those that collapse sooner than others: nothing \
             is said of the share that collapses"
        )
    }
}

impl Summary {
    /// Returns the statistics of variants in each plane in which they were run, across the barrels first.
    pub fn spreads(&self) -> Vec<(View, &Spread)> {
        let own = std::iter::once(self).chain(self.other_plane.as_deref());
        let known = |one: &Self| View::ALL.into_iter().find(|view| Some(view.name()) == one.view);
        let mut all: Vec<_> =
            own.filter_map(|one| Some((known(one)?, one.ensemble.as_ref()?))).collect();
        all.sort_by_key(|(view, _)| *view == View::Longitudinal);
        all
    }

    /// Returns the summary as JSON text, indented.
    ///
    /// ```
    /// use barrelstack::{Scenario, Summary};
    ///
    /// let run = Scenario::builtin("sliding-block", &[])?.run()?;
    /// assert!(Summary::of(&run, None).to_json().contains(r#""kind": "not-judged""#));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_json(&self) -> String {
        // Only maps with non-text keys could fail, and there are none.
        described::to_json(self).unwrap_or_default()
    }
}

/// `true` if the numbers of a run are valid; those of a failed computation merely look like results.
fn sound(run: &Run) -> bool {
    !matches!(run.outcome, Outcome::Invalid { .. })
}

fn outcome(run: &Run) -> OutcomeSummary {
    // Events before an interruption are reported with the bodies.
    let ended = sound(run) && run.outcome != Outcome::Interrupted;
    let barrels: Vec<usize> = run.assembly.of_kind(PartKind::Barrel).collect();
    let summary = OutcomeSummary {
        kind: run.outcome.kind(),
        first_fall: run.fates.first_fall().filter(|_| ended),
        barrels_fallen: ended.then(|| {
            barrels.iter().filter(|body| run.fates.fate(**body).fell_at.is_some()).count()
        }),
        barrels: barrels.len(),
        ..OutcomeSummary::default()
    };
    match &run.outcome {
        Outcome::Collapse { mode, time, first, from_level, to_level } => OutcomeSummary {
            mode: Some(mode.name()),
            time: Some(*time),
            first: Some(first.clone()),
            from_level: Some(*from_level),
            to_level: Some(*to_level),
            ..summary
        },
        Outcome::Invalid { reason } => OutcomeSummary { reason: Some(reason.clone()), ..summary },
        Outcome::Stable | Outcome::NotJudged | Outcome::Interrupted => summary,
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
    /// Returns the summary of a joint under its name; `None` if its bodies never touched.
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
