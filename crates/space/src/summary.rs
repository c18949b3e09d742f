//! Summary of a run in space as one JSON document, with the same numbers as the printed results.

use barrelstack::assemble::PartKind;
use barrelstack::demand::{Demands, Span};
use barrelstack::ground::MotionSummary;
use barrelstack::outcome::Outcome;
use barrelstack::scenario::Scenario;
use barrelstack::summary::Unfinished;
use barrelstack::summary::{Devices, EnergyBalance, JointSummary, Provenance};
use barrelstack::variants::{Remedy, Spread};
use barrelstack_dynamics::Vec3;
use barrelstack_report::described;

use crate::fate::Heading;
use crate::run::Run;
use crate::variants::{Case, demands};

described! {
    /// The summary of a run in space. Lengths are in m, times in s, angles in rad; `x` is across the barrels, `y` along
    /// the barrels, `z` up. A value is null where an event did not happen or does not apply.
    #[derive(Clone, Debug)]
    pub struct Summary {
        /// Name and version of this layout.
        pub schema: &'static str ["space/1"],
        /// Title of the scenario.
        pub title: String,
        /// Number of the variant that was run; 0 for the stack as stated.
        pub variant: u32,
        /// Statistics of all variants; null where no variants were run.
        pub ensemble: Option<Spread>,
        /// Number of runs that finished; null unless the variants were stopped early.
        pub unfinished: Option<Unfinished>,
        /// Changes that would have kept the stack up; null if the stack stands or if no change was searched for.
        pub remedy: Option<Remedy>,
        /// Numbers of variants and barrels that fall in each direction; null where no variants were run.
        pub directions: Option<Directions>,
        /// Outcome of the run.
        pub outcome: OutcomeInSpace,
        /// All bodies except the ground; empty where the run is invalid.
        pub bodies: Vec<BodyInSpace>,
        /// Demands on the stack until the first loss of seat.
        pub demands: Demands,
        /// Demands on the stack over the whole run, falls included.
        pub demands_whole_run: Demands,
        /// Forces between every two bodies that pressed on each other; empty where the run is invalid.
        pub interfaces: Vec<JointSummary>,
        /// Force of every element of the devices, if there are any.
        #[serde(flatten)]
        pub devices: Devices,
        /// The energy balance; null where the numbers are no longer finite.
        pub energy: Option<EnergyBalance>,
        /// The horizontal component of the ground motion that the scenario names, and the vertical component.
        pub motion: Option<MotionSummary>,
        /// The other horizontal component of the ground motion; null where the motion has only one.
        pub other_component: Option<MotionSummary>,
        /// Settings and work of the computation.
        pub run: RunInSpace,
        /// Warnings.
        pub warnings: Vec<String>,
        /// Provenance of the result.
        pub provenance: Provenance,
    }

    /// Numbers of variants and barrels that fall in each direction.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Directions of cases: &[Case] {
        /// Number of variants whose first body leaves its seat to the right (positive x).
        pub first_right: u32 = first(cases, Heading::Right),
        /// Number of variants whose first body leaves its seat to the left (negative x).
        pub first_left: u32 = first(cases, Heading::Left),
        /// Number of variants whose first body leaves its seat along the barrels, away from the viewer (positive y).
        pub first_away: u32 = first(cases, Heading::Away),
        /// Number of variants whose first body leaves its seat along the barrels, toward the near side (negative y).
        pub first_near: u32 = first(cases, Heading::Near),
        /// Number of fallen barrels, in all variants, whose displacement from rest is mainly to the right.
        pub debris_right: u32 = debris(cases, Heading::Right),
        /// Number of fallen barrels, in all variants, whose displacement from rest is mainly to the left.
        pub debris_left: u32 = debris(cases, Heading::Left),
        /// Number of fallen barrels, in all variants, whose displacement from rest is mainly along the barrels, away
        /// from the viewer.
        pub debris_away: u32 = debris(cases, Heading::Away),
        /// Number of fallen barrels, in all variants, whose displacement from rest is mainly along the barrels, toward
        /// the near side.
        pub debris_near: u32 = debris(cases, Heading::Near),
    }

    /// Outcome of a run in space.
    #[derive(Clone, Debug, Default)]
    pub struct OutcomeInSpace {
        /// Kind of the outcome.
        pub kind: &'static str ["stable", "collapse", "not-judged", "interrupted", "invalid"],
        /// Mode of the collapse.
        pub mode: Option<&'static str> ["ejection", "rocking", "rack-sliding", "overturning"],
        /// Time at which the first body left its seat.
        pub time: Option<f64> as "s",
        /// Name of the first body that left its seat.
        pub first: Option<String>,
        /// Direction in which the first body left its seat.
        pub heading: Option<&'static str> ["right", "left", "away", "near"],
        /// Lowest of the levels that collapse.
        pub from_level: Option<u32>,
        /// Highest of the levels that collapse.
        pub to_level: Option<u32>,
        /// Time at which the first barrel counts as fallen.
        pub first_fall: Option<f64> as "s",
        /// Number of barrels that had fallen at the end; null where the run is invalid or was interrupted.
        pub barrels_fallen: Option<usize>,
        /// Number of all barrels.
        pub barrels: usize,
        /// Reason why the run is invalid.
        pub reason: Option<String>,
    }

    /// One body in space.
    #[derive(Clone, Debug)]
    pub struct BodyInSpace {
        /// Name of the body.
        pub name: String,
        /// Kind of the body.
        pub kind: &'static str ["barrel", "rack", "device", "body"],
        /// Level, 1 at the bottom; 0 in a free scene.
        pub level: u32,
        /// Column, 1 for the leftmost; 0 in a free scene.
        pub column: u32,
        /// Row along the barrels, 1 for the nearest; 0 in a free scene.
        pub row: u32,
        /// Time at which the body left its seat.
        pub left_seat_at: Option<f64> as "s",
        /// Direction in which the body left its seat.
        pub left_seat_to: Option<&'static str> ["right", "left", "away", "near"],
        /// Time at which the body counts as fallen.
        pub fell_at: Option<f64> as "s",
        /// Largest drop below the position at rest.
        pub drop: f64 as "m",
        /// Largest force on the body after its fall.
        pub fall_force: Option<f64> as "N",
        /// Displacement x, y, z at the end, relative to the ground and measured from the position at rest.
        pub moved: [f64; 3] as "m",
        /// Position x, y, z of the center of mass at the end, relative to the initial position of the ground.
        pub position: [f64; 3] as "m",
        /// Orientation of the principal axes at the end, as the quaternion w, x, y, z.
        pub orientation: [f64; 4] as "1",
        /// Velocity x, y, z of the center of mass at the end, including the velocity of the ground.
        pub velocity: [f64; 3] as "m/s",
        /// Spin about x, y, z at the end.
        pub spin: [f64; 3] as "rad/s",
        /// Largest horizontal displacement relative to the ground before the first loss of seat.
        pub peak_displacement: f64 as "m",
        /// Largest horizontal displacement, in any direction, relative to the supports before the first loss of seat.
        pub peak_slip: f64 as "m",
        /// Largest displacement across the barrels relative to the supports before the first loss of seat.
        pub peak_slip_across: f64 as "m",
        /// Largest displacement along the barrels relative to the supports before the first loss of seat; may occur at
        /// another time than the largest displacement across the barrels.
        pub peak_slip_along: f64 as "m",
        /// Largest rise above the position at rest before the first loss of seat.
        pub peak_uplift: f64 as "m",
        /// Largest tilt before the first loss of seat; racks only.
        pub peak_tilt: Option<f64> as "rad",
        /// Largest contact force on the body before the first loss of seat, divided by the largest contact force at
        /// rest.
        pub stress_amplification: Option<f64> as "1",
        /// Sum of the largest contact forces on the body before the first loss of seat, divided by the sum of the
        /// contact forces at rest.
        pub mean_stress_amplification: Option<f64> as "1",
    }

    /// Settings and work of the computation.
    #[derive(Clone, Debug)]
    pub struct RunInSpace of run: &Run {
        /// Integration method.
        pub method: &'static str = run.simulation.method.name(),
        /// Time step.
        pub time_step: f64 as "s" = run.simulation.time_step,
        /// Number of accepted steps.
        pub steps: u64 = run.work.steps,
        /// Number of force evaluations.
        pub evaluations: u64 = run.work.evaluations,
        /// Number of contact elements tested in all evaluations.
        pub contact_evaluations: u64 = run.work.contact_evaluations,
        /// Simulated time reached.
        pub end_time: f64 as "s" = run.end_time,
        /// Reason for the end of the run.
        pub ending: &'static str ["rest", "after-collapse", "duration", "patience", "interrupted", "broken"] =
            run.ending.name(),
        /// Number of steps of settling.
        pub settle_steps: Option<u64> = run.settled.map(|settled| settled.steps),
        /// Wall-clock time, including all variants.
        pub wall_seconds: Option<f64> as "s" = None,
    }
}

/// Returns the number of cases in which the first body leaves its seat in a given direction.
fn first(cases: &[Case], heading: Heading) -> u32 {
    count(cases, |case| usize::from(case.first == Some(heading)))
}

/// Returns the number of barrels, in all cases, that fell in a given direction.
fn debris(cases: &[Case], heading: Heading) -> u32 {
    count(cases, |case| case.debris.iter().filter(|lies| **lies == heading).count())
}

fn count(cases: &[Case], of: impl Fn(&Case) -> usize) -> u32 {
    u32::try_from(cases.iter().map(of).sum::<usize>()).unwrap_or(u32::MAX)
}

impl Directions {
    /// Returns the number of variants whose first body leaves its seat across the barrels, and the number of those
    /// whose first body leaves it along the barrels.
    pub fn first(&self) -> [u32; 2] {
        [self.first_right + self.first_left, self.first_away + self.first_near]
    }

    /// Returns the number of barrels that fell across the barrels, and the number of those that fell along the barrels.
    pub fn debris(&self) -> [u32; 2] {
        [self.debris_right + self.debris_left, self.debris_away + self.debris_near]
    }
}

impl Summary {
    /// Summarizes a run; `stated` is the scenario as stated, of which the run may be a variant.
    pub fn of(run: &Run, stated: &Scenario) -> Self {
        let sound = !matches!(run.outcome, Outcome::Invalid { .. });
        let motion = |ground: &barrelstack::Ground| ground.motion.as_ref().map(MotionSummary::of);
        let first = &run.ground.first;
        let demands_in = |span: Span| if sound { demands(run, span) } else { Demands::default() };
        Self {
            schema: "space/1",
            title: stated.title.clone(),
            variant: 0,
            ensemble: None,
            unfinished: None,
            remedy: None,
            directions: None,
            outcome: outcome(run, sound),
            // The numbers of a failed run look like results but are invalid.
            bodies: if sound { bodies(run) } else { Vec::new() },
            demands: demands_in(Span::UntilLoss),
            demands_whole_run: demands_in(Span::WholeRun),
            interfaces: if sound { interfaces(run) } else { Vec::new() },
            devices: Devices::borne(&run.devices()),
            energy: run.energy.as_ref().map(EnergyBalance::of),
            motion: motion(first),
            other_component: run.ground.second.as_ref().and_then(motion),
            run: RunInSpace::of(run),
            warnings: run.warnings.clone(),
            provenance: Provenance {
                program: "barrelstack",
                version: env!("CARGO_PKG_VERSION"),
                scenario_hash: format!("{:016x}", stated.fingerprint()),
                motion: run.ground.provenance(),
            },
        }
    }

    /// Returns the summary as indented JSON text.
    pub fn to_json(&self) -> String {
        // Serialization can only fail for maps with non-text keys, and there are none.
        described::to_json(self).unwrap_or_default()
    }
}

fn outcome(run: &Run, sound: bool) -> OutcomeInSpace {
    // For an interrupted run, events before the stop are listed with the bodies only.
    let ended = sound && run.outcome != Outcome::Interrupted;
    let mut summary = OutcomeInSpace {
        kind: run.outcome.kind(),
        heading: run.heading.map(Heading::name).filter(|_| ended),
        first_fall: run.first_fall.filter(|_| ended),
        barrels_fallen: ended.then(|| run.fallen().count()),
        barrels: run.stack.of_kind(PartKind::Barrel).count(),
        ..OutcomeInSpace::default()
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
        Outcome::Stable | Outcome::NotJudged | Outcome::Interrupted => {}
    }
    summary
}

fn interfaces(run: &Run) -> Vec<JointSummary> {
    let named = run.seats.named(&run.stack);
    named.filter_map(|(name, joint)| JointSummary::of(name, joint)).collect()
}

fn bodies(run: &Run) -> Vec<BodyInSpace> {
    let ends = run.last.poses.iter().zip(&run.last.twists);
    let parts = run.stack.parts.iter().zip(&run.fates).zip(ends).skip(1);
    let three = |v: Vec3| [v.x, v.y, v.z];
    parts
        .enumerate()
        .map(|(at, ((part, fate), (pose, twist)))| BodyInSpace {
            name: part.name.clone(),
            kind: part.kind.name(),
            level: part.level,
            column: part.column,
            row: part.row,
            left_seat_at: fate.left_seat.map(|(time, ..)| time),
            left_seat_to: fate.left_seat.map(|(.., heading)| heading.name()),
            fell_at: fate.fell_at,
            drop: fate.drop,
            fall_force: fate.fell_at.map(|_| fate.fall_force),
            moved: three(fate.moved),
            position: three(pose.position),
            orientation: {
                let turned = pose.orientation;
                [turned.w, turned.v.x, turned.v.y, turned.v.z]
            },
            velocity: three(twist.linear),
            spin: three(twist.angular),
            peak_displacement: fate.until_loss.displacement,
            peak_slip: fate.until_loss.slip,
            peak_slip_across: fate.peak_slip[0],
            peak_slip_along: fate.peak_slip[1],
            peak_uplift: fate.peak_uplift,
            peak_tilt: (part.kind == PartKind::Rack).then_some(fate.until_loss.tilt),
            // One more, since the first body, the ground, is omitted.
            stress_amplification: run.seats.amplification(at + 1, Span::UntilLoss),
            mean_stress_amplification: run.seats.mean_amplification(at + 1, Span::UntilLoss),
        })
        .collect()
}
