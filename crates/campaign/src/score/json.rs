//! JSON document of a score sheet, in SI units.

use barrelstack::variants::Unknown;
use barrelstack_report::described;

use super::{Capacity, Scored, Sheet};

described! {
    /// RockScore of a rack with its devices.
    pub struct ScoreDocument of sheet: &Sheet {
        /// Name and version of the format of this document.
        pub schema: &'static str ["rockscore/1"] = "rockscore/1",
        /// Name and version of the protocol; only scores of the same protocol are comparable.
        pub protocol: String = sheet.protocol.name.clone(),
        /// Title of the scored scenario.
        pub title: String = sheet.scenario.title.clone(),
        /// Name of the rack.
        pub rack: Option<String> = sheet.scenario.stack().map(|stack| stack.rack.base.to_owned()),
        /// Score: the smallest velocity over all states and directions, rounded down.
        pub score: u32 as "cm/s" = sheet.score(),
        /// Range that contains the score with a probability of 95 %, given the uncertain constants of the seats
        /// (friction, stiffness, damping) and the sampling error; rounded outward. Without uncertain constants it is
        /// the 95 % interval for the sampling error alone. Null if a run has no verdict, or if there are too few runs.
        pub range: Option<[u32; 2]> as "cm/s" = sheet.range(),
        /// The uncertain constant with the largest effect on the share of stacks that collapse at the velocity of the
        /// score, in the state and direction with the smallest velocity. Null if no constant changes this share both
        /// significantly and by at least 20 percentage points.
        pub decides: Option<Unknown> = sheet.decisive().cloned(),
        /// Number of levels of the stack.
        pub levels: u32 = sheet.protocol.levels,
        /// Peak ground velocities to which every motion was scaled.
        pub velocities: Vec<f64> as "m/s" = sheet.protocol.velocities.clone(),
        /// Number of motions of the protocol.
        pub motions: usize = sheet.protocol.count(),
        /// Probability of collapse that defines the score.
        pub chance: f64 as "1" = sheet.protocol.chance,
        /// One result for each combination of a state of the stack and a direction of shaking.
        pub states: Vec<StateRow> = sheet.rows.iter().map(|row| StateRow::of(&(row, sheet))).collect(),
    }

    /// Result of a stack in one state, shaken in one direction.
    pub struct StateRow of row: &(&Scored, &Sheet) {
        /// Name of the state.
        pub state: String = row.0.state.name.clone(),
        /// Changes to the scenario in this state, as overrides.
        pub changes: Vec<String> = row.0.state.changes.clone(),
        /// Direction of shaking: across the barrels, along them, or three-dimensional with all components of the
        /// motions.
        pub direction: &'static str ["transverse", "longitudinal", "spatial"] = row.0.direction.name(),
        /// Peak ground velocity at which one stack in ten collapses; 0 if that velocity is below all levels.
        pub velocity: f64 as "m/s" = row.0.capacity.velocity(),
        /// Source of the velocity: the fitted curve, the lower of the two levels between which the share of collapses
        /// rises above one in ten, or one end of the range of levels.
        pub found: &'static str ["curve", "between-levels", "above-all-levels", "below-all-levels"] =
            match row.0.capacity {
                Capacity::Fitted(..) => "curve",
                Capacity::Between(..) => "between-levels",
                Capacity::Above(_) => "above-all-levels",
                Capacity::Below(_) => "below-all-levels",
            },
        /// 95 % interval of the velocity, clustered by motion; null if there is none.
        pub interval: Option<[f64; 2]> as "m/s" = row.0.capacity.interval().map(|of| [of.low, of.high]),
        /// Range of the velocity over the uncertain constants, defined like `range` of the score. An end below all
        /// levels is given as 0, and an end above all levels as the highest level.
        pub range: Option<[f64; 2]> as "m/s" = row.0.range().map(|of| [of.low, of.high]),
        /// Share of stacks that collapse at each of the velocities of the protocol; null where no run has a verdict.
        pub collapsed: Vec<Option<f64>> as "1" = row.1.protocol.velocities.iter()
            .map(|velocity| row.0.at(*velocity).map(|stripe| stripe.fraction())).collect(),
        /// Number of runs.
        pub runs: usize = row.0.runs,
        /// Number of runs without a verdict.
        pub runs_without_verdict: usize = row.0.left_out,
        /// Number of runs whose stack fell under its own weight, before it was shaken; they count as collapsed.
        pub runs_fallen_at_rest: usize = row.0.fallen_at_rest,
    }
}
