//! From what became of a case to its row.

use crate::outcome::Outcome;

use super::Study;
use super::column::{ColumnSpec, Role, Value, ValueKind};
use super::design::Case;
use super::motions::{MEASURES, Shaken};
use crate::ensemble::CaseResult;
use crate::watch::Joint;

/// Columns of every table before those of the factors.
const KEYS: [(&str, ValueKind); 3] =
    [("case", ValueKind::Integer), ("id", ValueKind::Text), ("chunk", ValueKind::Integer)];

/// Columns of every table behind the measures: name, unit, role, kind.
const RESULTS: [(&str, &str, Role, ValueKind); 24] = [
    ("outcome", "", Role::Outcome, ValueKind::Text),
    ("mode", "", Role::Outcome, ValueKind::Text),
    ("first_loss", "s", Role::Outcome, ValueKind::Number),
    ("first_fall", "s", Role::Outcome, ValueKind::Number),
    ("barrels", "", Role::Outcome, ValueKind::Integer),
    ("barrels_fallen", "", Role::Outcome, ValueKind::Integer),
    ("fall_heights", "m", Role::Outcome, ValueKind::Text),
    ("top_drift_ratio", "", Role::Demand, ValueKind::Number),
    ("base_slip_peak", "m", Role::Demand, ValueKind::Number),
    ("base_slip_residual", "m", Role::Demand, ValueKind::Number),
    ("rack_tilt_peak", "rad", Role::Demand, ValueKind::Number),
    ("rack_walk_peak", "m", Role::Demand, ValueKind::Number),
    ("stress_amplification", "", Role::Demand, ValueKind::Number),
    ("mean_stress_amplification", "", Role::Demand, ValueKind::Number),
    ("vertical_force_peak", "N", Role::Demand, ValueKind::Number),
    ("horizontal_force_peak", "N", Role::Demand, ValueKind::Number),
    ("residual_displacement", "m", Role::Demand, ValueKind::Number),
    ("ended", "", Role::Run, ValueKind::Text),
    ("motion_left", "s", Role::Run, ValueKind::Number),
    ("end_time", "s", Role::Run, ValueKind::Number),
    ("steps", "", Role::Run, ValueKind::Integer),
    ("energy_residual_ratio", "", Role::Run, ValueKind::Number),
    ("warnings", "", Role::Run, ValueKind::Integer),
    ("error", "", Role::Run, ValueKind::Text),
];

/// Columns that tell the motion.
const MOTION: [&str; 3] = ["record", "level", "scale_factor"];

/// What a column tells.
pub(super) fn meaning(spec: &ColumnSpec) -> &'static str {
    match (spec.role, spec.name.as_str()) {
        (Role::Key, "case") => "number of the case in its study",
        (Role::Key, "id") => "what tells the case from every other, however many there are",
        (Role::Key, _) => "chunk that ran the case",
        (Role::Factor, _) => "value of a varied field",
        (Role::Motion, "record") => "name of the motion",
        (Role::Motion, "level") => "intensity to which the motion was scaled",
        (Role::Motion, _) => "factor by which it was scaled",
        (Role::Intensity, _) => "intensity measure of the motion as shaken",
        (_, "outcome") => "stable, collapse, not-judged, invalid or error",
        (_, "mode") => "how it collapsed",
        (_, "first_loss") => "when the first body left its seat",
        (_, "first_fall") => "when the first barrel had fallen",
        (_, "barrels") => "barrels of the stack",
        (_, "barrels_fallen") => "barrels that had fallen when the case ended",
        (_, "fall_heights") => "largest drop of each barrel that fell (m), divided by semicolons",
        (_, "top_drift_ratio") => {
            "peak displacement of the top over its height, before the collapse"
        }
        (_, "base_slip_peak") => "largest slip of the bottom rack, before the collapse",
        (_, "base_slip_residual") => "slip of the bottom rack at the end",
        (_, "rack_tilt_peak") => "largest tilt of a rack, before the collapse",
        (_, "rack_walk_peak") => "largest way of a rack on what it stands on, before the collapse",
        (_, "stress_amplification") => {
            "largest normal stress on a bottom barrel over the largest at rest, before the collapse"
        }
        (_, "mean_stress_amplification") => {
            "the same, averaged over the boundary that is loaded at rest"
        }
        (_, "vertical_force_peak") => {
            "largest vertical force of a barrel on its rack, or of a rack on what it stands on"
        }
        (_, "horizontal_force_peak") => "largest horizontal force between two of them",
        (_, "residual_displacement") => "largest displacement of a barrel at the end",
        (_, "ended") => "why the case ended: rest, after-collapse, duration, patience or broken",
        (_, "motion_left") => "time of the motion that was left when it ended",
        (_, "end_time") => "simulated time that it reached",
        (_, "steps") => "accepted time steps",
        (_, "energy_residual_ratio") => {
            "energy missing from the books over the energy that went through"
        }
        (_, "warnings") => "number of warnings",
        (_, "error") => "why there is no verdict",
        (Role::Outcome | Role::Demand | Role::Run, _) => "",
    }
}

/// The names of the columns that every table has.
pub(super) fn fixed_columns() -> impl Iterator<Item = &'static str> {
    let keys = KEYS.iter().map(|(name, _)| *name);
    let measures = MEASURES.iter().map(|(name, _)| *name);
    keys.chain(MOTION).chain(measures).chain(RESULTS.iter().map(|(name, ..)| *name))
}

impl Study {
    /// The columns of the table, in order.
    pub(super) fn columns(&self) -> Vec<ColumnSpec> {
        let unit = self.intensity.as_ref().map_or("", |intensity| intensity.measure.unit());
        let key = |(name, kind): &(&str, ValueKind)| ColumnSpec::new(name, "", Role::Key, *kind);
        let motion = [("", ValueKind::Text), (unit, ValueKind::Number), ("", ValueKind::Number)];
        let motion = MOTION
            .iter()
            .zip(motion)
            .map(|(name, (unit, kind))| ColumnSpec::new(name, unit, Role::Motion, kind));
        let measures = MEASURES.iter().map(|(name, measure)| {
            ColumnSpec::new(name, measure.unit(), Role::Intensity, ValueKind::Number)
        });
        let results = RESULTS
            .iter()
            .map(|(name, unit, role, kind)| ColumnSpec::new(name, unit, *role, *kind));
        let factors = self.factors.iter().map(|factor| factor.column.clone());
        KEYS.iter().map(key).chain(factors).chain(motion).chain(measures).chain(results).collect()
    }

    /// The row of a case; `shaken` is none where the motion could not be had.
    pub(super) fn row(
        &self,
        case: &Case,
        chunk: usize,
        shaken: Option<&Shaken>,
        result: &CaseResult,
    ) -> Vec<Option<Value>> {
        let mut row = vec![
            Some(Value::Integer(i64::try_from(case.number).unwrap_or(i64::MAX))),
            text(&format!("{:016x}", case.id)),
            count(chunk),
        ];
        row.extend((0..self.factors.len()).map(|factor| self.told(case, factor)));
        row.push(text(&self.motions[case.motion].name));
        row.push(case.level.map(Value::Number));
        row.push(shaken.map(|shaken| Value::Number(shaken.factor)));
        let measures = shaken.and_then(|shaken| shaken.measures);
        row.extend((0..MEASURES.len()).map(|at| number(measures.map(|measures| measures[at]))));
        row.extend(results(result));
        row
    }
}

/// The values of [`RESULTS`].
fn results(result: &CaseResult) -> [Option<Value>; 24] {
    let (kind, mode, first_loss, error) = match &result.outcome {
        Ok(Outcome::Collapse { mode, time, .. }) => {
            ("collapse", text(mode.name()), number(Some(*time)), None)
        }
        Ok(Outcome::Invalid { reason }) => ("invalid", None, None, text(reason)),
        Ok(outcome @ (Outcome::Stable | Outcome::NotJudged)) => (outcome.kind(), None, None, None),
        Err(reason) => ("error", None, None, text(reason)),
    };
    let judged = matches!(&result.outcome, Ok(Outcome::Stable | Outcome::Collapse { .. }));
    let heights: Vec<String> = result
        .fall_heights
        .iter()
        .map(|height| crate::scenario::quantity::plain(*height))
        .collect();
    let demands = &result.demands;
    let force = |of: fn(&Joint) -> f64| {
        number(result.joints.iter().map(|(_, joint)| of(joint)).reduce(f64::max))
    };
    [
        text(kind),
        mode,
        first_loss,
        number(result.first_fall),
        count(result.barrels).filter(|_| result.outcome.is_ok()),
        count(heights.len()).filter(|_| judged),
        text(&heights.join(";")),
        number(demands.top_drift_ratio),
        number(demands.base_slip_peak),
        number(demands.base_slip_residual),
        number(demands.rack_tilt_peak),
        number(demands.rack_walk_peak),
        number(demands.stress_amplification),
        number(demands.mean_stress_amplification),
        force(|joint| joint.peak_vertical.0),
        force(|joint| joint.peak_horizontal.0.abs()),
        number(result.residual_displacement),
        result.ending.and_then(|ending| text(ending.name())),
        number(result.cut),
        number(result.end_time),
        result.steps.and_then(|steps| i64::try_from(steps).ok()).map(Value::Integer),
        number(result.energy_residual_ratio),
        count(result.warnings.len()),
        error,
    ]
}

/// A text; none when it is empty.
fn text(text: &str) -> Option<Value> {
    (!text.is_empty()).then(|| Value::Text(text.to_owned()))
}

/// A number, unless it is none: a NaN in a table looks like a value and is none.
fn number(value: Option<f64>) -> Option<Value> {
    value.filter(|value| !value.is_nan()).map(Value::Number)
}

fn count(count: usize) -> Option<Value> {
    i64::try_from(count).ok().map(Value::Integer)
}
