//! Other racks that give the paper's numbers as well, but for the residual slip: how robust its result is
//! hangs on what it does not state.

use barrelstack::scenario::{Cradle, Scenario, StackSpec};
use barrelstack::summary::Summary;
use barrelstack_report::{Block, Cell, Table};

use super::cases::Cases;
use super::ensemble;
use super::pool::Job;
use super::vary::{self, brief, with};

/// A rack, in words and as a change of the regular one.
type Rack = (&'static str, fn(&mut StackSpec));

/// Solid racks with feet that a random search over cradle, feet, clearance, rails, node spacing and mass
/// found beside that of the catalog, and two of an independent search that knew the cases across the
/// barrels only. The catalog's was taken because it gives the case along the barrels as well.
const RACKS: [Rack; 3] = [
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
];

fn cradle(stack: &mut StackSpec, degrees: f64) {
    if let Cradle::Supports { angle } = &stack.rack.cradle {
        let more = degrees.to_radians() - angle;
        vary::cradle_angle(stack, more);
    }
}

/// What a rack gives.
pub(super) struct Tried {
    /// The rack in words.
    pub(super) name: &'static str,
    eight: Summary,
    /// Six barrels, where the paper's record shook them.
    six: Option<Summary>,
    /// How many combinations of contact parameters 10 % off keep the mode of the eight barrels.
    pub(super) same_mode: usize,
    /// Of how many.
    pub(super) members: usize,
}

/// The runs: for each rack the six barrels, the eight barrels, and these with every combination.
pub(super) fn jobs(cases: &Cases) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (name, change) in RACKS {
        let job = |case: &str, scenario: Scenario| Job {
            label: format!("{case} with {name}"),
            scenario,
            keep: false,
        };
        if cases.motion.is_papers() {
            let mut six = with(&brief(&cases.six, 0.1), change);
            six.run.duration = Some(20.0);
            jobs.push(job("six barrels", six));
        }
        let eight = with(&brief(&cases.eight, 1.0), change);
        // The mode is known with the first loss of seat.
        jobs.extend(ensemble::jobs(&brief(&eight, 0.05)));
        jobs.push(job("eight barrels", eight));
    }
    jobs
}

/// Puts the summaries together, which come in the order of the jobs.
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

/// The table.
pub(super) fn block(found: &[Tried]) -> Block {
    let mut table = Table::new(
        "Other racks, which the paper's text would allow as well. Robust: combinations of contact \
         parameters 10 % off that keep the mode.",
        &[
            ("rack", ""),
            ("eight barrels", ""),
            ("robust", ""),
            ("first fall", "s"),
            ("drift", "%"),
            ("stress", "× at rest"),
            ("six barrels", ""),
            ("stands for", "s"),
            ("stress", "× at rest"),
        ],
    );
    let number = |value: Option<f64>, factor: f64| {
        value.map_or(Cell::Missing, |v| Cell::Number(v * factor, 3))
    };
    let mode = |summary: &Summary| summary.outcome.mode.unwrap_or(summary.outcome.kind);
    for rack in found {
        let six = rack.six.as_ref();
        table.rows.push(vec![
            Cell::text(rack.name),
            Cell::text(mode(&rack.eight)),
            Cell::text(format!("{} of {}", rack.same_mode, rack.members)),
            number(rack.eight.outcome.first_fall, 1.0),
            number(rack.eight.demands.top_drift_ratio, 100.0),
            number(rack.eight.demands.stress_amplification, 1.0),
            six.map_or(Cell::Missing, |six| Cell::text(mode(six))),
            number(six.and_then(|six| six.outcome.time), 1.0),
            number(six.and_then(|six| six.demands.stress_amplification), 1.0),
        ]);
    }
    Block::Table(table)
}
