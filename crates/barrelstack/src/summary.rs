//! The summary of a run: one JSON document, the same numbers in print.

mod devices;

use barrelstack_dynamics::EnergySummary;
use barrelstack_report::described;

use crate::assemble::PartKind;
use crate::demand::Demands;
use crate::ground::MotionSummary;
use crate::outcome::Outcome;
use crate::run::Run;
use crate::scenario::View;
use crate::variants::{Remedy, Spread};
use crate::verify::Verification;
use crate::watch::{Joint, StressEnvelope};

pub use devices::{Device, Devices, ElementSummary};

described! {
    /// The summary of a run. Lengths in m, times in s, forces in N, angles in rad; null where it did not
    /// happen or does not apply.
    #[derive(Clone, Debug)]
    pub struct Summary {
        /// Name and version of this layout.
        pub schema: &'static str ["summary/2"],
        /// The scenario's title.
        pub title: String,
        /// The plane of the model; null for a free scene.
        pub view: Option<&'static str> ["transverse", "longitudinal"],
        /// Which variant of the stack this is; 0 as it is stated.
        pub variant: u32,
        /// What all variants say together; null where none were run.
        pub ensemble: Option<Spread>,
        /// What would have kept the stack up; null where it stands, or nothing was looked for.
        pub remedy: Option<Remedy>,
        /// What happened.
        pub outcome: OutcomeSummary,
        /// Every body but the ground; none where the run is invalid.
        pub bodies: Vec<BodySummary>,
        /// Demands on the stack.
        pub demands: Demands,
        /// Forces between bodies; none where the run is invalid.
        pub interfaces: Vec<JointSummary>,
        /// The force elements of every device, where there are any.
        #[serde(flatten)]
        pub devices: Devices,
        /// The energy books; null where numbers were lost.
        pub energy: Option<EnergyBooks>,
        /// What shook it.
        pub motion: Option<MotionSummary>,
        /// How it was computed.
        pub run: RunSummary,
        /// What the reader should know.
        pub warnings: Vec<String>,
        /// What made the result.
        pub provenance: Provenance,
        /// What repeats say about it; null where there were none.
        pub verification: Option<Verification>,
        /// The same of the other plane, where the scenario looks at its stack in both: this one is the worse.
        pub other_plane: Option<Box<Summary>>,
    }

    /// What happened.
    #[derive(Clone, Debug)]
    pub struct OutcomeSummary {
        /// What it was.
        pub kind: &'static str ["stable", "collapse", "not-judged", "interrupted", "invalid"],
        /// How it collapsed.
        pub mode: Option<&'static str> ["ejection", "rocking", "rack-sliding", "overturning"],
        /// When the first body left its seat.
        pub time: Option<f64> as "s",
        /// That body.
        pub first: Option<String>,
        /// The lowest level that gave way.
        pub from_level: Option<u32>,
        /// The highest level that went.
        pub to_level: Option<u32>,
        /// When the first barrel had fallen.
        pub first_fall: Option<f64> as "s",
        /// Barrels that had fallen at the end; null where the run is invalid.
        pub barrels_fallen: Option<usize>,
        /// Barrels in all.
        pub barrels: usize,
        /// Why the run is invalid.
        pub reason: Option<String>,
    }

    /// One body.
    #[derive(Clone, Debug)]
    pub struct BodySummary {
        /// Its name.
        pub name: String,
        /// What it is.
        pub kind: &'static str ["barrel", "rack", "body"],
        /// Level, 1 at the bottom.
        pub level: Option<u32>,
        /// Column, 1 at the left.
        pub column: Option<u32>,
        /// When it left its seat.
        pub left_seat_at: Option<f64> as "s",
        /// When it had fallen.
        pub fell_at: Option<f64> as "s",
        /// Largest drop below its place at rest, for what fell.
        pub fall_height: Option<f64> as "m",
        /// When it landed: when it went down less than half as fast as it had since it fell.
        pub landed_at: Option<f64> as "s",
        /// Its largest speed downward until then.
        pub landing_speed: Option<f64> as "m/s",
        /// Largest force on it since it had fallen.
        pub fall_force: Option<f64> as "N",
        /// Displacement along x relative to the ground, at the end.
        pub residual_displacement: f64 as "m",
        /// Largest displacement along x relative to the ground, while the stack stood.
        pub peak_displacement: f64 as "m",
        /// Displacement relative to what it stands on, at the end: a rack's walk, a barrel's way in its
        /// cradle.
        pub residual_slip: f64 as "m",
        /// Largest such displacement while the stack stood.
        pub peak_slip: f64 as "m",
        /// Largest rise above its place at rest while the stack stood.
        pub peak_uplift: f64 as "m",
        /// Largest tilt while the stack stood; racks only.
        pub peak_tilt: Option<f64> as "rad",
        /// Largest normal stress at rest, per meter of boundary.
        pub stress_at_rest: Option<f64> as "N/m",
        /// Largest normal stress while the stack stood, over the largest at rest.
        pub stress_amplification: Option<f64> as "1",
        /// Average over the loaded boundary of the same ratio.
        pub mean_stress_amplification: Option<f64> as "1",
    }

    /// The force between two bodies.
    #[derive(Clone, Debug)]
    pub struct JointSummary {
        /// Such as "R1 on ground".
        pub name: String,
        /// Vertical force on the upper body at rest.
        pub at_rest: f64 as "N",
        /// Largest vertical force on the upper body, and when.
        pub peak_vertical: f64 as "N",
        /// When.
        pub peak_vertical_at: f64 as "s",
        /// Largest horizontal force on the upper body, and when; in a plane with its sign.
        pub peak_horizontal: f64 as "N",
        /// When.
        pub peak_horizontal_at: f64 as "s",
    }

    /// The energy books at the end (J), relative to the start.
    #[derive(Clone, Debug)]
    pub struct EnergyBooks {
        /// Kinetic energy.
        pub kinetic: f64 as "J",
        /// Potential energy in gravity.
        pub potential: f64 as "J",
        /// In contact springs and force elements.
        pub elastic: f64 as "J",
        /// In sticks.
        pub stick: f64 as "J",
        /// Lost in the dampers of contacts and elements, and with elements that broke.
        pub damped: f64 as "J",
        /// Lost to friction.
        pub friction: f64 as "J",
        /// Lost to viscous damping.
        pub viscous: f64 as "J",
        /// Work of the ground.
        pub ground_work: f64 as "J",
        /// What does not balance.
        pub residual: f64 as "J",
        /// Energy that went through: absolute work of the ground plus the drop of potential energy.
        pub input: f64 as "J",
        /// |residual| / input.
        pub residual_ratio: f64 as "1",
    }

    /// How it was computed.
    #[derive(Clone, Debug)]
    pub struct RunSummary {
        /// Integration method.
        pub method: &'static str,
        /// Time step.
        pub time_step: f64 as "s",
        /// Accepted steps.
        pub steps: u64,
        /// Evaluations of all forces.
        pub evaluations: u64,
        /// Contact elements tested.
        pub contact_evaluations: u64,
        /// Simulated time reached.
        pub end_time: f64 as "s",
        /// Why it ended.
        pub ending: &'static str ["rest", "after-collapse", "duration", "patience", "interrupted", "broken"],
        /// Whether it was stopped early by the user.
        pub interrupted: bool,
        /// What contact constants are stated for.
        pub stiffness_basis: &'static str ["node", "length", "mixed"],
        /// Length scale of similitude.
        pub similitude: f64 as "1",
        /// Steps taken to find equilibrium.
        pub settle_steps: Option<u64>,
        /// Time on the clock.
        pub wall_seconds: Option<f64> as "s",
    }

    /// What made the result.
    #[derive(Clone, Debug)]
    pub struct Provenance {
        /// The program.
        pub program: &'static str,
        /// Its version.
        pub version: &'static str,
        /// Hash of the scenario with every default written out.
        pub scenario_hash: String,
        /// Where the motion came from and what was done to it, one sentence each.
        pub motion: Vec<String>,
    }
}

impl EnergyBooks {
    /// Those of a run.
    pub fn of(books: &EnergySummary) -> Self {
        Self {
            kinetic: books.kinetic,
            potential: books.potential,
            elastic: books.elastic,
            stick: books.stick,
            damped: books.damped,
            friction: books.friction,
            viscous: books.viscous,
            ground_work: books.ground_work,
            residual: books.residual,
            input: books.throughput,
            residual_ratio: books.residual_ratio(),
        }
    }
}

impl Summary {
    /// Sums up a run; `wall_seconds` is the time it took on the clock, where it was measured.
    pub fn of(run: &Run, wall_seconds: Option<f64>) -> Self {
        Self {
            schema: "summary/2",
            title: run.stated.title.clone(),
            view: run.assembly.view.map(View::name),
            variant: 0,
            ensemble: None,
            remedy: None,
            outcome: outcome(run),
            // Numbers of a run that broke down look like results and are none.
            bodies: if sound(run) { bodies(run) } else { Vec::new() },
            demands: if sound(run) {
                Demands::of(&run.assembly, &run.fates, &run.stresses, run.recording.forces())
            } else {
                Demands::default()
            },
            interfaces: if sound(run) { joints(run) } else { Vec::new() },
            devices: Devices::of(run),
            energy: run.energy.as_ref().map(EnergyBooks::of),
            motion: run.ground.motion.as_ref().map(MotionSummary::of),
            run: RunSummary {
                method: run.simulation.method.name(),
                time_step: run.simulation.time_step,
                steps: run.work.steps,
                evaluations: run.work.evaluations,
                contact_evaluations: run.work.contact_evaluations,
                end_time: run.end_time,
                ending: run.ending.name(),
                interrupted: run.interrupted,
                stiffness_basis: run.stiffness_basis(),
                similitude: run.scenario.run.similitude,
                settle_steps: run.settled.map(|settled| settled.steps),
                wall_seconds,
            },
            warnings: run.warnings.clone(),
            provenance: Provenance {
                program: "barrelstack",
                version: env!("CARGO_PKG_VERSION"),
                scenario_hash: format!("{:016x}", run.stated.fingerprint()),
                motion: run
                    .ground
                    .motion
                    .as_ref()
                    .map(|motion| motion.provenance.clone())
                    .unwrap_or_default(),
            },
            verification: None,
            other_plane: None,
        }
    }

    /// What all variants say in each plane in which they were run, across the barrels first.
    pub fn spreads(&self) -> Vec<(View, &Spread)> {
        let own = std::iter::once(self).chain(self.other_plane.as_deref());
        let known = |one: &Self| View::ALL.into_iter().find(|view| Some(view.name()) == one.view);
        let mut all: Vec<_> =
            own.filter_map(|one| Some((known(one)?, one.ensemble.as_ref()?))).collect();
        all.sort_by_key(|(view, _)| *view == View::Longitudinal);
        all
    }

    /// The summary as JSON text, indented.
    ///
    /// ```
    /// use barrelstack::{Scenario, Summary};
    ///
    /// let run = Scenario::builtin("sliding-block", &[])?.run()?;
    /// assert!(Summary::of(&run, None).to_json().contains(r#""kind": "not-judged""#));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_json(&self) -> String {
        // Only maps with keys that are not text could fail, and there is none.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

/// Whether the numbers of a run are results.
fn sound(run: &Run) -> bool {
    !matches!(run.outcome, Outcome::Invalid { .. })
}

fn outcome(run: &Run) -> OutcomeSummary {
    let barrels: Vec<usize> = run.assembly.of_kind(PartKind::Barrel).collect();
    let mut summary = OutcomeSummary {
        kind: if run.interrupted && sound(run) { "interrupted" } else { run.outcome.kind() },
        mode: None,
        time: None,
        first: None,
        from_level: None,
        to_level: None,
        first_fall: run.fates.first_fall().filter(|_| sound(run)),
        barrels_fallen: sound(run).then(|| {
            barrels.iter().filter(|body| run.fates.fate(**body).fell_at.is_some()).count()
        }),
        barrels: barrels.len(),
        reason: None,
    };
    match &run.outcome {
        Outcome::Collapse { mode, time, first, from_level, to_level } => {
            summary.mode = Some(mode.name());
            summary.time = Some(*time);
            summary.first = Some(first.clone());
            summary.from_level = Some(*from_level);
            summary.to_level = Some(*to_level);
        }
        Outcome::Invalid { reason } => summary.reason = Some(reason.clone()),
        Outcome::Stable | Outcome::NotJudged => {}
    }
    summary
}

fn bodies(run: &Run) -> Vec<BodySummary> {
    let parts = run.assembly.parts.iter().enumerate();
    parts
        .filter(|(_, part)| part.kind != PartKind::Ground)
        .map(|(i, part)| {
            let fate = run.fates.fate(i);
            let stress = run.stresses.of(i);
            BodySummary {
                name: part.name.clone(),
                kind: part.kind.name(),
                level: part.level,
                column: part.column,
                left_seat_at: fate.left_seat.map(|(time, _)| time),
                fell_at: fate.fell_at,
                fall_height: fate.fell_at.map(|_| fate.drop),
                landed_at: fate.landed_at,
                landing_speed: fate.landing_speed,
                fall_force: fate.fall_force,
                residual_displacement: fate.residual_displacement,
                peak_displacement: fate.peak_displacement,
                residual_slip: fate.residual_slip,
                peak_slip: fate.peak_slip,
                peak_uplift: fate.peak_uplift,
                peak_tilt: (part.kind == PartKind::Rack).then_some(fate.peak_tilt),
                stress_at_rest: stress.map(|s| s.at_rest.iter().copied().fold(0.0, f64::max)),
                stress_amplification: stress.and_then(StressEnvelope::amplification),
                mean_stress_amplification: stress.and_then(StressEnvelope::mean_amplification),
            }
        })
        .collect()
}

impl JointSummary {
    /// That of a joint with its name; none where nothing ever leaned on it.
    pub fn of(name: String, joint: &Joint) -> Option<Self> {
        let (peak_vertical, peak_vertical_at) = joint.peak_vertical;
        let (peak_horizontal, peak_horizontal_at) = joint.peak_horizontal;
        (peak_vertical > 0.0).then_some(Self {
            name,
            at_rest: joint.at_rest,
            peak_vertical,
            peak_vertical_at,
            peak_horizontal,
            peak_horizontal_at,
        })
    }
}

fn joints(run: &Run) -> Vec<JointSummary> {
    let joints = run.recording.forces().joints.iter();
    joints.filter_map(|joint| JointSummary::of(joint.name(&run.assembly), joint)).collect()
}
