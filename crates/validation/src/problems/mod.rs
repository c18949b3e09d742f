//! The problems, grouped by theory.

pub mod consensus;
mod devices;
mod devices_on_stacks;
mod falls;
mod fragility;
mod gravity;
mod housner;
mod intensity;
mod invariances;
mod measured;
mod ode;
mod overlaps;
mod pulses;
mod racks_along;
mod regimes;
mod restitution;
mod rolling;
mod rooms;
mod sliding;
mod slosh;
mod solids;
mod space;
mod stacks;
mod statistics;
mod symmetry;

use crate::Problem;

/// Returns every problem, in the order of the report.
pub fn all() -> Vec<Problem> {
    let groups = [
        housner::problems(),
        pulses::problems(),
        regimes::problems(),
        sliding::problems(),
        rolling::problems(),
        solids::problems(),
        restitution::problems(),
        measured::problems(),
        falls::problems(),
        gravity::problems(),
        stacks::problems(),
        devices::problems(),
        devices_on_stacks::problems(),
        racks_along::problems(),
        slosh::problems(),
        ode::problems(),
        space::problems(),
        invariances::problems(),
        symmetry::problems(),
        rooms::problems(),
        intensity::problems(),
        statistics::problems(),
        fragility::problems(),
        consensus::problems(),
        crate::cases::shipped(),
    ];
    groups.into_iter().flatten().collect()
}
