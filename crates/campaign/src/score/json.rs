//! The score sheet for programs, in SI units.

use barrelstack_report::described;

use super::{Capacity, Scored, Sheet};

described! {
    /// The RockScore of a rack and its devices.
    pub struct ScoreDocument of sheet: &Sheet {
        /// Name and version of this layout.
        pub schema: &'static str ["rockscore/1"] = "rockscore/1",
        /// Name and version of the protocol; scores of another one do not compare.
        pub protocol: &'static str = sheet.protocol.name,
        /// The stack that was scored.
        pub title: String = sheet.scenario.title.clone(),
        /// The rack.
        pub rack: Option<String> = sheet.scenario.stack().map(|stack| stack.rack.base.to_owned()),
        /// The score: the least of all velocities, rounded down.
        pub score: u32 as "cm/s" = sheet.score(),
        /// Levels of the stack.
        pub levels: u32 = sheet.protocol.levels,
        /// Peak ground velocities to which every motion was scaled.
        pub velocities: Vec<f64> as "m/s" = sheet.protocol.velocities.clone(),
        /// Motions.
        pub motions: usize = sheet.protocol.count(),
        /// The chance of collapse at which the velocity is the score.
        pub chance: f64 as "1" = sheet.protocol.chance,
        /// Every state in every direction.
        pub states: Vec<StateRow> = sheet.rows.iter().map(|row| StateRow::of(&(row, sheet))).collect(),
    }

    /// A stack in one state, shaken in one direction.
    pub struct StateRow of row: &(&Scored, &Sheet) {
        /// The state.
        pub state: String = row.0.state.name.clone(),
        /// Its changes, as overrides of the scenario.
        pub changes: Vec<String> = row.0.state.changes.clone(),
        /// The direction of shaking.
        pub direction: &'static str ["transverse", "longitudinal"] = row.0.view.name(),
        /// The velocity at which the chance is reached.
        pub velocity: f64 as "m/s" = row.0.capacity.velocity(),
        /// Source: a fitted curve, the highest level at which no more than one in ten collapsed, or beyond all levels.
        pub found: &'static str ["curve", "between-levels", "above-all-levels", "below-all-levels"] =
            match row.0.capacity {
                Capacity::Fitted(..) => "curve",
                Capacity::Between(..) => "between-levels",
                Capacity::Above(_) => "above-all-levels",
                Capacity::Below(_) => "below-all-levels",
            },
        /// Its 95 % interval, for which the runs of one motion go together; null where there is none.
        pub interval: Option<[f64; 2]> as "m/s" = row.0.capacity.interval().map(|of| [of.low, of.high]),
        /// Share that collapsed at each of the velocities; null where no run has a verdict.
        pub collapsed: Vec<Option<f64>> as "1" = row.1.protocol.velocities.iter()
            .map(|velocity| row.0.at(*velocity).map(|stripe| stripe.fraction())).collect(),
        /// Runs.
        pub runs: usize = row.0.runs,
        /// Runs without a verdict.
        pub runs_without_verdict: usize = row.0.left_out,
        /// Runs whose stack fell under its own weight, before it was shaken; they count as collapsed.
        pub runs_fallen_at_rest: usize = row.0.fallen_at_rest,
    }
}
