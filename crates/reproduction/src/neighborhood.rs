//! The neighborhood of the reconstructed rack: counts how many slightly different racks, with slightly different
//! contact parameters, reproduce the findings of the paper.

use barrelstack::scenario::{Cradle, Scenario, StackSpec};
use barrelstack::summary::Summary;
use barrelstack_report::{Block, Cell, Table};

use super::cases::PaperCases;
use super::pool::Job;
use super::vary::{self, brief, with};

/// Number of samples: racks near the reconstructed rack.
pub(super) const COUNT: usize = 40;

/// Largest relative change of each length and angle of the rack, and of each coefficient of
/// friction.
const REACH: f64 = 0.05;

/// Largest relative change of stiffness and damping.
const PARAMETERS: f64 = 0.10;

/// The findings checked for each sample.
const QUESTIONS: [&str; 5] = [
    "eight barrels: the top level leaves first",
    "eight barrels: drift within 4 to 7 %",
    "six barrels: both upper levels fall by rocking after 8.5 to 12 s",
    "along the barrels: the rack of the second level slides off first",
    "along the barrels: the first body leaves its seat after 3 to 6 s",
];

/// For each finding, `true` if a sample reproduces it; `None` if the finding needs the paper's
/// record, but this record was not given.
pub(super) type Kept = [Option<bool>; 5];

/// Returns a coordinate of a sample, between −1 and 1.
///
/// Coordinates are fractional parts of multiples of square roots of primes (Richtmyer 1951), so
/// that the samples cover the range of every coordinate evenly and are the same on every machine.
fn draw(index: usize, dimension: usize) -> f64 {
    const PRIMES: [f64; 12] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0];
    2.0 * ((index + 1) as f64 * PRIMES[dimension].sqrt()).fract() - 1.0
}

fn change(stack: &mut StackSpec, index: usize) {
    let near = |dimension| 1.0 + REACH * draw(index, dimension);
    let wide = |dimension| 1.0 + PARAMETERS * draw(index, dimension);
    let rack = &mut stack.rack;
    if let Cradle::Supports { angle } = &mut rack.cradle {
        *angle *= near(0);
    }
    rack.foot_half_length *= near(1);
    rack.foot_height *= near(2);
    rack.clearance *= near(3);
    rack.pitch *= near(4);
    rack.width *= near(4);
    rack.rail_half_spacing *= near(5);
    rack.rail_width *= near(6);
    rack.mass *= near(7);
    vary::stiffness(stack, wide(8));
    vary::damping(stack, wide(9));
    vary::barrel_rack_friction(stack, near(10));
    vary::rack_ground_friction(stack, near(11));
}

/// Returns the runs of every sample: the eight barrels, the stack along the barrels, and, if the paper's record is
/// given, the six barrels.
pub(super) fn jobs(cases: &PaperCases) -> Vec<Job> {
    let mut jobs = Vec::new();
    for index in 0..COUNT {
        let mut job = |case: &str, base: &Scenario, until: Option<f64>| {
            let mut scenario = with(&brief(base, 0.05), |stack| change(stack, index));
            scenario.run.duration = until.or(scenario.run.duration);
            jobs.push(Job::brief(format!("{case}, neighbor {}", index + 1), scenario));
        };
        job("eight barrels", &cases.eight, None);
        job("along the barrels", &cases.along, None);
        if cases.motion.is_papers() {
            job("six barrels", &cases.six, Some(20.0));
        }
    }
    jobs
}

/// Evaluates the findings of each sample from the summaries, which `next` returns in the order of the jobs. The
/// summaries include the six barrels if `with_six` is `true`.
pub(super) fn read(with_six: bool, next: &mut dyn Iterator<Item = Summary>) -> Vec<Kept> {
    let mut kept = Vec::new();
    while let (true, Some(eight), Some(along)) = (kept.len() < COUNT, next.next(), next.next()) {
        let six = if with_six { next.next() } else { None };
        let within = |value: Option<f64>, low: f64, high: f64| {
            value.is_some_and(|value| (low..=high).contains(&value))
        };
        kept.push([
            Some(eight.outcome.mode == Some("ejection") && eight.outcome.from_level == Some(4)),
            Some(within(eight.demands.top_drift_ratio, 0.04, 0.07)),
            six.map(|six| {
                six.outcome.mode == Some("rocking")
                    && six.outcome.from_level == Some(2)
                    && within(six.outcome.time, 8.5, 12.0)
            }),
            Some(along.outcome.mode == Some("rack-sliding") && along.outcome.from_level == Some(2)),
            Some(within(along.outcome.time, 3.0, 6.0)),
        ]);
    }
    kept
}

/// Builds the table of the findings, with the numbers of samples that reproduce them.
pub(super) fn block(kept: &[Kept]) -> Block {
    let mut table = Table::new(
        format!(
            "Variations of the reconstructed rack: {} racks, spread evenly over the following ranges. Lengths, angles \
             and both coefficients of friction differ from those of the reconstructed rack by at most 5 %, k and c by \
             at most 10 %.",
            kept.len()
        ),
        &[("finding", ""), ("racks that reproduce the finding", "")],
    );
    for (at, question) in QUESTIONS.into_iter().enumerate() {
        let count: Option<usize> = kept.iter().map(|answers| answers[at].map(usize::from)).sum();
        let cell = Cell::maybe(count.map(|count| count.to_string()));
        table.rows.push(vec![Cell::text(question), cell]);
    }
    let all = kept.iter().filter(|answers| answers.iter().all(|answer| answer.unwrap_or(true)));
    table
        .rows
        .push(vec![Cell::text("all that could be checked"), Cell::text(all.count().to_string())]);
    Block::Table(table)
}
