//! Other racks, compared with the rack of the catalog. The comparison shows that the results and
//! their robustness depend on dimensions that the paper does not state.

use barrelstack::scenario::{Cradle, StackSpec};
use barrelstack::summary::Summary;
use barrelstack_report::{Block, Cell, Table};

use super::cases::PaperCases;
use super::ensemble;
use super::pool::Job;
use super::vary::{self, brief, with};

/// A rack: a description, and the function that changes the rack of the catalog into this rack.
type Rack = (&'static str, fn(&mut StackSpec));

/// Other solid racks with feet. They were found by random searches in which the cradle, feet, clearance, rails, node
/// spacing and mass varied.
///
/// Some of the searches considered only the cases in the transverse plane, across the barrels. The rack of the catalog
/// was chosen because it also reproduces the case in the longitudinal plane, along the barrels.
const RACKS: [Rack; 4] = [
    ("cradle ±30°, feet ±6 cm, clearance 12 cm, 30 kg", |stack| {
        cradle(stack, 30.0);
        let rack = &mut stack.rack;
        (rack.foot_half_length, rack.clearance, rack.mass) = (0.06, 0.12, 30.0);
    }),
    ("cradle ±30°, feet ±6 cm and 7 cm high, clearance 18 cm, 30 kg", |stack| {
        cradle(stack, 30.0);
        let rack = &mut stack.rack;
        (rack.foot_half_length, rack.foot_height) = (0.06, 0.07);
        (rack.clearance, rack.mass) = (0.18, 30.0);
    }),
    ("cradle ±28°, feet ±7 cm and 7 cm high, nodes every 0.5 cm, 30 kg", |stack| {
        cradle(stack, 28.0);
        let rack = &mut stack.rack;
        (rack.foot_half_length, rack.foot_height) = (0.07, 0.07);
        (rack.node_spacing, rack.mass) = (0.005, 30.0);
    }),
    (
        "cradle ±31.1°, feet ±6.39 cm and 7.79 cm high, clearance 14.76 cm, beam 4 cm, pitch 76.36 cm, 30 kg, \
         tangential stiffness doubled",
        |stack| {
            cradle(stack, 31.1);
            let rack = &mut stack.rack;
            (rack.foot_half_length, rack.foot_height) = (0.0639, 0.0779);
            (rack.clearance, rack.beam_height) = (0.1476, 0.04);
            (rack.pitch, rack.node_spacing, rack.mass) = (0.7636, 0.01, 30.0);
            vary::stick_stiffness(stack, 2.0);
        },
    ),
];

fn cradle(stack: &mut StackSpec, degrees: f64) {
    if let Cradle::Supports { angle } = &stack.rack.cradle {
        let more = degrees.to_radians() - angle;
        vary::cradle_angle(stack, more);
    }
}

/// The results obtained with one rack.
pub(super) struct Tried {
    /// Description of the rack.
    pub(super) name: &'static str,
    eight: Summary,
    /// Summary of the six barrels, if the paper's record is given.
    six: Option<Summary>,
    /// Number of combinations of contact parameters, each changed by 10 %, in which the collapse mode of the eight
    /// barrels stays the same.
    pub(super) same_mode: usize,
    /// Number of combinations that were run.
    pub(super) members: usize,
}

/// Returns the runs of each rack: the six barrels, the eight barrels, and the eight barrels with every combination of
/// changed contact parameters.
pub(super) fn jobs(cases: &PaperCases) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (name, change) in RACKS {
        let job = |case: &str, scenario| Job::brief(format!("{case} with {name}"), scenario);
        if cases.motion.is_papers() {
            let mut six = with(&brief(&cases.six, 0.1), change);
            six.run.duration = Some(20.0);
            jobs.push(job("six barrels", six));
        }
        let eight = with(&brief(&cases.eight, 1.0), change);
        // The mode is determined at the first loss of a seat.
        jobs.extend(ensemble::jobs(&brief(&eight, 0.05)));
        jobs.push(job("eight barrels", eight));
    }
    jobs
}

/// Collects the results of each rack from the summaries, which `next` returns in the order of the jobs. The summaries
/// include the six barrels if `with_six` is `true`.
pub(super) fn read(with_six: bool, next: &mut dyn Iterator<Item = Summary>) -> Vec<Tried> {
    let mut found = Vec::new();
    for (name, _) in RACKS {
        let six = if with_six { next.next() } else { None };
        let members: Vec<Summary> = next.take(ensemble::COUNT).collect();
        let Some(eight) = next.next() else { break };
        let same = members.iter().filter(|member| member.outcome.mode == eight.outcome.mode);
        let (same_mode, members) = (same.count(), members.len());
        found.push(Tried { name, eight, six, same_mode, members });
    }
    found
}

/// Builds the table of the racks and their results.
pub(super) fn block(found: &[Tried]) -> Block {
    let mode = |summary: &Summary| summary.outcome.mode.unwrap_or(summary.outcome.kind);
    let stress = |summary: &Summary| summary.demands.stress_amplification;
    let drift = |summary: &Summary| summary.demands.top_drift_ratio.map(|drift| 100.0 * drift);
    let table = Table::of(
        "Other racks that also agree with the paper's text. The column \"robust\" gives the number of combinations \
         of contact parameters, each changed by 10 %, with which the mode stays the same.",
        found,
        &[
            ("rack", "", &|rack| Cell::text(rack.name)),
            ("eight barrels", "", &|rack| Cell::text(mode(&rack.eight))),
            ("robust", "", &|rack| Cell::text(format!("{} of {}", rack.same_mode, rack.members))),
            ("first fall", "s", &|rack| Cell::number(rack.eight.outcome.first_fall, 3)),
            ("drift", "%", &|rack| Cell::number(drift(&rack.eight), 3)),
            ("largest stress", "× at rest", &|rack| Cell::number(stress(&rack.eight), 3)),
            ("six barrels", "", &|rack| Cell::maybe(rack.six.as_ref().map(mode))),
            ("stands for", "s", &|rack| {
                Cell::number(rack.six.as_ref().and_then(|six| six.outcome.time), 3)
            }),
            ("largest stress", "× at rest", &|rack| {
                Cell::number(rack.six.as_ref().and_then(stress), 3)
            }),
        ],
    );
    Block::Table(table)
}
