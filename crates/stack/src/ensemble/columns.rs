//! Columns of tables of cases, declared in one list for all such tables.

use barrelstack_columns::column::{Column, ColumnSpec, Role, Value, ValueKind, Values};

use super::CaseResult;
use crate::outcome::Outcome;
use crate::scenario::quantity::plain;
use crate::watch::Joint;

/// A column of a table of cases.
#[derive(Clone, Copy, Debug)]
pub struct CaseColumn {
    /// Name without the unit.
    pub name: &'static str,
    /// SI unit; empty for pure numbers and for strings.
    pub unit: &'static str,
    /// Role of the column.
    pub role: Role,
    /// Description of the column.
    pub meaning: &'static str,
    /// Returns the value of the column for a case; `None` if the value does not apply or is unknown.
    pub get: Get,
}

/// Function that returns the value of a column for a case; each variant is for one type of value.
#[derive(Clone, Copy, Debug)]
pub enum Get {
    /// An integer.
    Integer(fn(&CaseResult) -> Option<usize>),
    /// A number in SI units.
    Number(fn(&CaseResult) -> Option<f64>),
    /// A string.
    Text(fn(&CaseResult) -> Option<String>),
}

impl CaseColumn {
    /// Returns the specification of the column.
    pub fn spec(&self) -> ColumnSpec {
        let kind = match self.get {
            Get::Integer(_) => ValueKind::Integer,
            Get::Number(_) => ValueKind::Number,
            Get::Text(_) => ValueKind::Text,
        };
        ColumnSpec::new(self.name, self.unit, self.role, kind)
    }

    /// Returns the value of this column for a case.
    pub fn of(&self, case: &CaseResult) -> Option<Value> {
        self.values(&mut std::iter::once(case)).get(0)
    }

    /// Returns the values of this column for all cases.
    fn values(&self, cases: &mut dyn Iterator<Item = &CaseResult>) -> Values {
        match self.get {
            Get::Integer(get) => {
                let whole = |case| get(case).and_then(|count| i64::try_from(count).ok());
                Values::Integer(cases.map(whole).collect())
            }
            // A NaN is left out, because it would look like a value.
            Get::Number(get) => {
                let number = |case| get(case).filter(|value| !value.is_nan());
                Values::Number(cases.map(number).collect())
            }
            Get::Text(get) => {
                let text = |case| get(case).filter(|text| !text.is_empty());
                Values::Text(cases.map(text).collect())
            }
        }
    }
}

/// Returns a table of cases with the columns of [`CASE_COLUMNS`]: one row per case, in the order of `cases`.
///
/// ```
/// use barrelstack_stack::ensemble::{Ensemble, Prepared, table};
/// use barrelstack_stack::Scenario;
/// use barrelstack_columns::column::to_csv;
///
/// let cases = vec![Prepared::new(Scenario::builtin("sliding-block", &[])?)?];
/// let table = table(&Ensemble { cases, ..Ensemble::default() }.run());
/// assert!(to_csv(&table).starts_with("outcome,mode,first_loss (s),"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn table(cases: &[CaseResult]) -> Vec<Column> {
    columns(&cases.iter())
}

fn columns<'a>(cases: &(impl Iterator<Item = &'a CaseResult> + Clone)) -> Vec<Column> {
    let column = |column: &CaseColumn| Column {
        spec: column.spec(),
        values: column.values(&mut cases.clone()),
    };
    CASE_COLUMNS.iter().map(column).collect()
}

/// Returns a table of the variants of a stack: the number of the variant, then the columns of [`CASE_COLUMNS`].
///
/// Number 0 is the stack as the scenario states it, without changes. Interrupted cases have no row.
pub fn variants<'a>(cases: impl Iterator<Item = &'a CaseResult> + Clone) -> Vec<Column> {
    let ended = (0..).zip(cases).filter(|(_, case)| !case.is_interrupted());
    let spec = ColumnSpec::new(VARIANT.0, "", Role::Key, ValueKind::Integer);
    let numbers = Values::Integer(ended.clone().map(|(number, _)| Some(number)).collect());
    let mut all = vec![Column { spec, values: numbers }];
    all.extend(columns(&ended.map(|(_, case)| case)));
    all
}

/// Name and description of the first column of [`variants`].
const VARIANT: (&str, &str) = ("variant", "number of the variant; 0 is the stack as stated");

/// Returns the description of the column `name` of a table of cases or variants; `None` if there is no such column.
pub fn meaning(name: &str) -> Option<&'static str> {
    let known = CASE_COLUMNS.iter().map(|column| (column.name, column.meaning));
    known.chain([VARIANT]).find_map(|(known, meaning)| (known == name).then_some(meaning))
}

/// Declares the columns. Each line has a description, name, unit, role, and accessor.
macro_rules! columns {
    ($(
        #[doc = $meaning:literal]
        $name:ident $unit:literal: $role:ident $kind:ident $get:expr;
    )*) => {
        /// All columns of a table of cases, in order.
        pub static CASE_COLUMNS: &[CaseColumn] = &[$(CaseColumn {
            name: stringify!($name),
            unit: $unit,
            role: Role::$role,
            meaning: $meaning.trim_ascii(),
            get: Get::$kind($get),
        }),*];
    };
}

columns! {
    /// stable, collapse, not-judged, invalid or error
    outcome "": Outcome Text |case| {
        Some(case.outcome.as_ref().map_or("error", Outcome::kind).to_owned())
    };
    /// mode of the collapse: ejection, rocking, rack-sliding, overturning, or gravity (a collapse before the shaking)
    mode "": Outcome Text |case| match &case.outcome {
        Ok(Outcome::Collapse { mode, .. }) => Some(mode.name().to_owned()),
        Ok(Outcome::Stable | Outcome::NotJudged | Outcome::Interrupted | Outcome::Invalid { .. }) | Err(_) => None,
    };
    /// time at which the first body left its seat; 0 if the stack fell under its own weight
    first_loss "s": Outcome Number |case| match &case.outcome {
        Ok(Outcome::Collapse { time, .. }) => Some(*time),
        Ok(Outcome::Stable | Outcome::NotJudged | Outcome::Interrupted | Outcome::Invalid { .. }) | Err(_) => None,
    };
    /// time at which the first barrel counted as fallen
    first_fall "s": Outcome Number |case| case.first_fall;
    /// number of barrels in the stack
    barrels "": Outcome Integer |case| case.outcome.is_ok().then_some(case.barrels);
    /// number of barrels that had fallen when the case ended
    barrels_fallen "": Outcome Integer |case| {
        let judged = matches!(&case.outcome, Ok(Outcome::Stable | Outcome::Collapse { .. }));
        judged.then_some(case.fall_heights.len())
    };
    /// largest drop of each fallen barrel (m), separated by semicolons
    fall_heights "m": Outcome Text |case| Some(list(&case.fall_heights));
    /// largest force on each fallen barrel after its fall (N), separated by semicolons
    fall_forces "N": Outcome Text |case| Some(list(&case.fall_forces));
    /// wine in each fallen barrel (m³), separated by semicolons
    fall_wine "m3": Outcome Text |case| Some(list(&case.fall_wine));
    /// wine in all barrels of the stack
    stack_wine "m3": Outcome Number |case| case.outcome.is_ok().then_some(case.wine);
    /// largest displacement of the top divided by the height of the stack, until the first loss of a seat
    top_drift_ratio "": Demand Number |case| case.demands.top_drift_ratio;
    /// largest slip of the bottom rack until the first loss of a seat
    base_slip_peak "m": Demand Number |case| case.demands.base_slip_peak;
    /// slip of the bottom rack at the end of the case
    base_slip_residual "m": Demand Number |case| case.demands.base_slip_residual;
    /// largest tilt of a rack until the first loss of a seat
    rack_tilt_peak "rad": Demand Number |case| case.demands.rack_tilt_peak;
    /// largest displacement of a rack on its supports until the first loss of a seat
    rack_walk_peak "m": Demand Number |case| case.demands.rack_walk_peak;
    /// largest normal stress on a bottom barrel divided by the largest stress at rest, until the first loss of a seat
    stress_amplification "": Demand Number |case| case.demands.stress_amplification;
    /// like stress_amplification, but each stress is an average over the part of the boundary that is loaded at rest
    mean_stress_amplification "": Demand Number |case| case.demands.mean_stress_amplification;
    /// largest vertical force between two bodies until the first loss of a seat
    vertical_force_peak "N": Demand Number |case| force(case, |joint| joint.until_loss.vertical.0);
    /// largest horizontal force between two bodies until the first loss of a seat
    horizontal_force_peak "N": Demand Number |case| force(case, |joint| joint.until_loss.horizontal.0);
    /// largest vertical force between a barrel and a rack until the first loss of a seat, divided by the stave capacity
    stave_utilization "": Demand Number |case| case.demands.stave_utilization;
    /// top_drift_ratio over the whole run, including falls
    top_drift_ratio_whole_run "": Outcome Number |case| case.demands_whole_run.top_drift_ratio;
    /// base_slip_peak over the whole run
    base_slip_peak_whole_run "m": Outcome Number |case| case.demands_whole_run.base_slip_peak;
    /// rack_tilt_peak over the whole run
    rack_tilt_peak_whole_run "rad": Outcome Number |case| case.demands_whole_run.rack_tilt_peak;
    /// rack_walk_peak over the whole run
    rack_walk_peak_whole_run "m": Outcome Number |case| case.demands_whole_run.rack_walk_peak;
    /// stress_amplification over the whole run
    stress_amplification_whole_run "": Outcome Number |case| case.demands_whole_run.stress_amplification;
    /// mean_stress_amplification over the whole run
    mean_stress_amplification_whole_run "": Outcome Number |case| {
        case.demands_whole_run.mean_stress_amplification
    };
    /// vertical_force_peak over the whole run
    vertical_force_peak_whole_run "N": Outcome Number |case| force(case, |joint| joint.whole_run.vertical.0);
    /// horizontal_force_peak over the whole run
    horizontal_force_peak_whole_run "N": Outcome Number |case| force(case, |joint| joint.whole_run.horizontal.0);
    /// stave_utilization over the whole run
    stave_utilization_whole_run "": Outcome Number |case| case.demands_whole_run.stave_utilization;
    /// largest displacement of a barrel at the end of the case
    residual_displacement "m": Demand Number |case| case.residual_displacement;
    /// reason for the end of the case: rest, after-collapse, duration, patience, broken or not-shaken
    ended "": Run Text |case| case.ending.map(|ending| ending.name().to_owned());
    /// duration of the ground motion that remained when the case ended
    motion_left "s": Run Number |case| case.cut;
    /// simulated time that the case reached
    end_time "s": Run Number |case| case.end_time;
    /// number of accepted time steps
    steps "": Run Integer |case| case.steps.and_then(|steps| usize::try_from(steps).ok());
    /// error of the energy balance divided by the energy exchanged
    energy_residual_ratio "": Run Number |case| case.energy_residual_ratio;
    /// number of warnings
    warnings "": Run Integer |case| Some(case.warnings.len());
    /// reason why there is no verdict
    error "": Run Text |case| match &case.outcome {
        Ok(Outcome::Invalid { reason }) | Err(reason) => Some(reason.clone()),
        Ok(Outcome::Stable | Outcome::NotJudged | Outcome::Interrupted | Outcome::Collapse { .. }) => None,
    };
}

/// Joins numbers with semicolons.
fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|number| plain(*number)).collect::<Vec<_>>().join(";")
}

/// Returns the largest magnitude, over all joints of a case, of the force that `of` selects; `None` if the case has no
/// joints.
fn force(case: &CaseResult, of: fn(&Joint) -> f64) -> Option<f64> {
    case.joints.iter().map(|(_, joint)| of(joint).abs()).reduce(f64::max)
}
