//! The problems, grouped by theory.

mod consensus;
mod fragility;
mod gravity;
mod housner;
mod invariances;
mod pulses;
mod regimes;
mod restitution;
mod rolling;
mod sliding;
mod stacks;
mod statistics;

use crate::Problem;

/// Every problem, in the order of the report.
pub fn all() -> Vec<Problem> {
    let groups = [
        housner::problems(),
        pulses::problems(),
        regimes::problems(),
        sliding::problems(),
        rolling::problems(),
        restitution::problems(),
        gravity::problems(),
        stacks::problems(),
        invariances::problems(),
        statistics::problems(),
        fragility::problems(),
        consensus::problems(),
        crate::cases::shipped(),
    ];
    groups.into_iter().flatten().collect()
}
