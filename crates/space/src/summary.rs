//! Summary of a three-dimensional run as one JSON document, with the same numbers as the printed results.

use barrelstack::assemble::PartKind;
use barrelstack::demand::{Demands, Span};
use barrelstack::ground::MotionSummary;
use barrelstack::outcome::Outcome;
use barrelstack::scenario::Scenario;
use barrelstack::summary::{
    BodyInSpace, Devices, Directions, EnergyBalance, JointSummary, OutcomeInSpace, OutcomeSummary,
    Provenance, RunInSpace,
};
use barrelstack_dynamics::Vec3;

pub use barrelstack::summary::SummaryInSpace as Summary;

use crate::fate::Heading;
use crate::run::Run;
use crate::variants::{Case, demands};

/// Summarizes a run of the scenario `stated` or of one of its variants.
pub fn of(run: &Run, stated: &Scenario) -> Summary {
    let sound = !matches!(run.outcome, Outcome::Invalid { .. });
    let motion = |ground: &barrelstack::Ground| ground.motion.as_ref().map(MotionSummary::of);
    let first = &run.ground.first;
    let demands_in = |span: Span| if sound { demands(run, span) } else { Demands::default() };
    Summary {
        schema: "space/1",
        title: stated.title.clone(),
        variant: 0,
        ensemble: None,
        unfinished: None,
        remedy: None,
        directions: None,
        outcome: outcome(run),
        // The numbers of a failed run look like results but are invalid.
        bodies: if sound { bodies(run) } else { Vec::new() },
        demands: demands_in(Span::UntilLoss),
        demands_whole_run: demands_in(Span::WholeRun),
        interfaces: if sound { interfaces(run) } else { Vec::new() },
        devices: Devices::borne(&run.devices()),
        energy: run.energy.as_ref().map(EnergyBalance::of),
        motion: motion(first),
        other_component: run.ground.second.as_ref().and_then(motion),
        run: settings(run),
        warnings: run.warnings.clone(),
        provenance: Provenance {
            program: "barrelstack",
            version: env!("CARGO_PKG_VERSION"),
            scenario_hash: format!("{:016x}", stated.fingerprint()),
            motion: run.ground.provenance(),
        },
        verification: None,
    }
}

/// Returns the outcome of a run, with its direction.
pub(crate) fn outcome(run: &Run) -> OutcomeInSpace {
    let counts = [run.fallen().count(), run.stack.of_kind(PartKind::Barrel).count()];
    let common = OutcomeSummary::of(&run.outcome, run.first_fall, counts);
    // In the summary of an interrupted run, events before the stop appear only in the list of bodies.
    let ended = common.barrels_fallen.is_some();
    OutcomeInSpace { common, heading: run.heading.map(Heading::name).filter(|_| ended) }
}

fn settings(run: &Run) -> RunInSpace {
    RunInSpace {
        method: run.simulation.method.name(),
        time_step: run.simulation.time_step,
        steps: run.work.steps,
        evaluations: run.work.evaluations,
        contact_evaluations: run.work.contact_evaluations,
        end_time: run.end_time,
        ending: run.ending.name(),
        settle_steps: run.settled.map(|settled| settled.steps),
        wall_seconds: None,
    }
}

/// Counts, for each direction, the variants in which the first body leaves its seat in this direction, and the barrels
/// that fall in this direction.
pub fn directions(cases: &[Case]) -> Directions {
    let first = |heading| count(cases, |case| usize::from(case.first == Some(heading)));
    let debris =
        |heading| count(cases, |case| case.debris.iter().filter(|lies| **lies == heading).count());
    Directions {
        first_right: first(Heading::Right),
        first_left: first(Heading::Left),
        first_away: first(Heading::Away),
        first_near: first(Heading::Near),
        debris_right: debris(Heading::Right),
        debris_left: debris(Heading::Left),
        debris_away: debris(Heading::Away),
        debris_near: debris(Heading::Near),
    }
}

fn count(cases: &[Case], of: impl Fn(&Case) -> usize) -> u32 {
    u32::try_from(cases.iter().map(of).sum::<usize>()).unwrap_or(u32::MAX)
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
            // The index is larger by one, because the ground, which is the first body, is omitted from the list.
            stress_amplification: run.seats.amplification(at + 1, Span::UntilLoss),
            mean_stress_amplification: run.seats.mean_amplification(at + 1, Span::UntilLoss),
        })
        .collect()
}
