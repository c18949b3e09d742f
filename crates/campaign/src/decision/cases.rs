//! Cases of a study that have a verdict, with their motions and intensities.

use std::collections::BTreeMap;
use std::sync::Arc;

use barrelstack_fragility::Interval;
use barrelstack_motion::STANDARD_GRAVITY;
use barrelstack_report::Cell;

use super::DecisionError;
use crate::outcome::CollapseMode;
use crate::study::{Collected, Endings, Provenance, Role, StudyTable, Value, word};
use crate::watch::Ending;

/// Intensity measure, with the name and unit in which it is displayed.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Name of the measure: the name of its column in the table or, without such a column, its name in the study file.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Name for display.
    pub label: String,
    /// Unit for display.
    pub shown_unit: &'static str,
    /// Factor from the SI unit to the unit for display.
    pub scale: f64,
}

impl Measure {
    fn new(name: &str, unit: &str) -> Self {
        let (shown_unit, scale) = match unit {
            "m/s2" | "m/s^2" | "m/s²" => ("g", 1.0 / STANDARD_GRAVITY),
            "m/s" if name == "pgv" => ("cm/s", 100.0),
            "m" => ("cm", 100.0),
            "m/s" => ("m/s", 1.0),
            "s" => ("s", 1.0),
            _ => ("", 1.0),
        };
        let label = match name {
            "pga" => "PGA".to_owned(),
            "pgv" => "PGV".to_owned(),
            "pgd" => "PGD".to_owned(),
            "pgv_over_pga" => "PGV/PGA".to_owned(),
            "arias" => "Arias intensity".to_owned(),
            "cav" => "CAV".to_owned(),
            "d5_95" => "duration D5–95".to_owned(),
            other => match other.strip_prefix("sa_") {
                Some(period) => format!("Sa({period} s)"),
                None => other.to_owned(),
            },
        };
        Self { name: name.to_owned(), unit: unit.to_owned(), label, shown_unit, scale }
    }

    /// Converts an intensity (SI) to the unit for display.
    pub fn shown(&self, intensity: f64) -> f64 {
        self.scale * intensity
    }

    /// Returns a table cell with an intensity (SI), converted to the unit for display.
    pub(super) fn cell(&self, intensity: f64) -> Cell {
        Cell::Number(self.shown(intensity), 3)
    }

    /// Formats an interval with its unit, as "… or more" or "… or less" if it has only one bound.
    pub fn range(&self, bounds: Interval) -> String {
        match (bounds.low > 0.0, bounds.high.is_finite()) {
            (true, true) => format!("{} to {}", self.digits(bounds.low), self.words(bounds.high)),
            (true, false) => format!("{} or more", self.words(bounds.low)),
            (false, true) => format!("{} or less", self.words(bounds.high)),
            (false, false) => "anywhere".to_owned(),
        }
    }

    /// Formats an intensity with its unit, with three significant digits.
    pub fn words(&self, intensity: f64) -> String {
        let number = self.digits(intensity);
        if self.shown_unit.is_empty() { number } else { format!("{number} {}", self.shown_unit) }
    }

    /// Formats an intensity without its unit, with three significant digits.
    fn digits(&self, intensity: f64) -> String {
        let shown = self.shown(intensity);
        // Whole levels are printed as 36 rather than 36.0, although 100 × 0.36 is not exactly 36.
        let whole = shown >= 10.0 && (shown - shown.round()).abs() < 1e-9 * shown;
        if whole { format!("{shown:.0}") } else { barrelstack_report::significant(shown, 3) }
    }
}

/// A case that has a verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedCase {
    /// Index of the table row of the case.
    pub row: u32,
    /// Index of the motion in [`Cases::records`].
    pub record: u32,
    /// `true` if a barrel or rack lost its seat.
    pub collapsed: bool,
    /// `true` if the stack fell under its own weight, before it was shaken.
    pub fell_at_rest: bool,
    /// Mode of collapse, as an index into [`Cases::modes`]; `None` if the stack stood.
    pub mode: Option<u8>,
    /// `true` if the case was simulated until nothing moved, so that all falls are known.
    pub followed: bool,
    /// Number of barrels in the stack.
    pub barrels: u32,
    /// Height of fall (m) of every barrel that fell.
    pub falls: Box<[f64]>,
    /// Largest force (N) on each fallen barrel from the time at which it counts as fallen, including the impact on
    /// landing. `None` if the study does not record forces, or if the stack fell under its own weight.
    pub forces: Option<Box<[f64]>>,
    /// Volume of wine (m³) in each fallen barrel.
    pub wines: Box<[f64]>,
    /// Volume of wine (m³) in all barrels of the stack.
    pub wine: f64,
    /// Peak drift ratio of the top of the stack before any loss of a seat; NaN if unknown.
    drift: f64,
    /// Intensities (SI) of the case, one for each measure in [`Cases::measures`]; NaN if unknown.
    intensities: Box<[f64]>,
    /// Index of the curve to which the case belongs.
    ///
    /// If cases are independent samples, each case is a curve. Otherwise, a curve consists of the cases of one motion
    /// that agree in all factors except those drawn for each case. In an incremental dynamic analysis, a curve is one
    /// hunt: all runs of the search for the level at which one motion makes the stack collapse.
    pub curve: u32,
}

impl JudgedCase {
    /// Returns the intensity (SI) of the case in the measure at an index; `None` if unknown.
    pub fn intensity(&self, measure: usize) -> Option<f64> {
        self.intensities.get(measure).copied().filter(|value| !value.is_nan())
    }

    /// Returns the peak drift ratio of the top of the stack before any loss of a seat; `None` if unknown.
    pub fn drift(&self) -> Option<f64> {
        Some(self.drift).filter(|value| !value.is_nan())
    }

    /// Returns the number of barrels that fell.
    pub fn fallen(&self) -> u32 {
        u32::try_from(self.falls.len()).unwrap_or(u32::MAX)
    }

    /// Returns the number of fallen barrels divided by the number of barrels in the stack; 0 for a stack without
    /// barrels.
    pub fn fallen_share(&self) -> f64 {
        f64::from(self.fallen()) / f64::from(self.barrels.max(1))
    }
}

/// Cases of a study that have a verdict, with the names, measures and settings that all cases share.
#[derive(Clone, Debug, PartialEq)]
pub struct Cases {
    /// Title of the study.
    pub title: String,
    /// Description of the stacks, without the properties that a factor varies; `None` for scenarios without a stack.
    pub stacks: Option<String>,
    /// Names of the motions; [`JudgedCase::record`] is an index into this list.
    pub records: Vec<String>,
    /// Names of the modes of collapse, in the order of first occurrence.
    pub modes: Vec<String>,
    /// Intensity measures of the cases.
    pub measures: Vec<Measure>,
    /// Index in `measures` of the intensity measure of the study. This is the measure to whose levels the motions are
    /// scaled or, if they are not scaled to levels, `pgv`.
    pub main: usize,
    /// `true` if every motion was scaled to a requested level of the study's intensity measure. The share of cases that
    /// collapse can then be computed at each level.
    pub leveled: bool,
    /// `true` for an incremental dynamic analysis, in which each level depends on the results of earlier runs.
    pub hunted: bool,
    /// `true` if cases are independent samples: motion, level and factors are drawn for each case.
    pub sampled: bool,
    /// Names of the factors whose values are drawn at random, so that even cases of the same motion differ in them.
    pub drawn: Vec<String>,
    /// Numbers of cases that were followed until nothing moved, and of cases that were stopped earlier.
    pub endings: Endings,
    /// All cases. They are reference-counted, since there may be a million of them, and subsets share them.
    pub all: Vec<Arc<JudgedCase>>,
    /// Number of rows without a verdict: the case could not start, its run failed or was interrupted, or it has no
    /// seats that could be lost.
    pub left_out: usize,
    /// Seed of the study. The data sets that are simulated for [`LimitCurve::monotony`](super::LimitCurve::monotony)
    /// are drawn with this seed.
    pub seed: u64,
}

/// Assigns consecutive numbers to names, in the order of first occurrence.
#[derive(Default)]
struct Numbering(BTreeMap<String, u32>);

impl Numbering {
    fn of(&mut self, name: &str) -> u32 {
        if let Some(known) = self.0.get(name) {
            return *known;
        }
        let next = small(self.0.len());
        self.0.insert(name.to_owned(), next);
        next
    }

    /// Returns the names in the order of their numbers.
    fn names(self) -> Vec<String> {
        let mut names: Vec<(String, u32)> = self.0.into_iter().collect();
        names.sort_by_key(|(_, number)| *number);
        names.into_iter().map(|(name, _)| name).collect()
    }
}

/// Converts a number of cases to `u32`; there are at most ten million cases.
fn small(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// Reader that converts a table to cases part by part, so that the table need not be held in memory.
pub(super) struct Reading {
    cases: Cases,
    records: Numbering,
    modes: Numbering,
    curves: Numbering,
    /// Number of rows read so far.
    rows: usize,
    /// Number of rows read so far, not counting the cases of a Saltelli design that combine the values of two samples.
    own: usize,
    /// Number of varied quantities of a Saltelli design; 0 for other designs. A block of the design has two cases more
    /// than this number.
    varied: usize,
}

impl Reading {
    /// Creates a reader for the rows of a study; `made` is the provenance of the rows.
    pub(super) fn new(made: &Provenance) -> Result<Self, DecisionError> {
        let measures = made.columns.iter().filter(|column| column.role == Role::Intensity);
        let mut measures: Vec<Measure> =
            measures.map(|column| Measure::new(&column.name, &column.unit)).collect();
        // The measure `sa(0.5)` has the column `sa_0.5`.
        let requested = made.measure.as_deref().map(|name| name.replace('(', "_").replace(')', ""));
        let known = |name: &str| measures.iter().position(|measure| measure.name == name);
        let main = match requested.as_deref() {
            Some(name) => known(name).unwrap_or_else(|| {
                let level = made.columns.iter().find(|column| column.name == "level");
                let unit = level.map_or("", |column| column.unit.as_str());
                measures.push(Measure::new(name, unit));
                measures.len() - 1
            }),
            None => known("pgv").ok_or(DecisionError::Column("pgv"))?,
        };
        let cases = Cases {
            title: made.title.clone(),
            stacks: made.stacks.clone(),
            records: Vec::new(),
            modes: Vec::new(),
            measures,
            main,
            leveled: requested.is_some(),
            hunted: made.design == "ida",
            sampled: made.is_sampled(),
            drawn: made.drawn.clone(),
            endings: Endings::default(),
            all: Vec::new(),
            left_out: 0,
            seed: made.seed,
        };
        Ok(Self {
            cases,
            records: Numbering::default(),
            modes: Numbering::default(),
            curves: Numbering::default(),
            rows: 0,
            own: 0,
            varied: made.varied.len(),
        })
    }

    /// Converts the next rows to cases, and adds those that have a verdict.
    pub(super) fn add(&mut self, table: &StudyTable) -> Result<(), DecisionError> {
        let text = |name| table.texts(name).ok_or(DecisionError::Column(name));
        let (outcomes, records, ended) = (text("outcome")?, text("record")?, text("ended")?);
        let barrels = table.integers("barrels").ok_or(DecisionError::Column("barrels"))?;
        let (modes, heights) = (table.texts("mode"), table.texts("fall_heights"));
        let forces = table.texts("fall_forces");
        let (wines, wine) = (table.texts("fall_wine"), table.numbers("stack_wine"));
        // A table with heights of fall must also have the wine in the barrels.
        if heights.is_some() && (wines.is_none() || wine.is_none()) {
            return Err(DecisionError::Column("fall_wine"));
        }
        let (drift, level) = (table.numbers("top_drift_ratio"), table.numbers("level"));
        let columns: Vec<Option<&[Option<f64>]>> =
            self.cases.measures.iter().map(|measure| table.numbers(&measure.name)).collect();
        let drawn = &self.cases.drawn;
        let fixed: Vec<_> =
            table.of_role(Role::Factor).filter(|f| !drawn.contains(&f.spec.name)).collect();
        // Only the first two cases of a block are independent samples; each of the others is the first sample with one
        // quantity taken from the second.
        let block = i64::try_from(self.varied + 2).unwrap_or(i64::MAX);
        let numbers = table.integers("case").filter(|_| self.varied > 0);
        let exchanged =
            |row: usize| numbers.is_some_and(|all| all[row].is_some_and(|n| n % block > 1));
        let first = self.rows;
        self.rows += table.rows();
        self.cases.endings.add(table);
        for row in (0..table.rows()).filter(|row| !exchanged(*row)) {
            self.own += 1;
            let collapsed = match outcomes[row].as_deref() {
                Some("collapse") => true,
                Some("stable") => false,
                _ => continue,
            };
            let name = records[row].as_deref().unwrap_or_default();
            let cell = |of: Option<&[Option<f64>]>| of.and_then(|of| of[row]);
            let mut intensities: Box<[f64]> =
                columns.iter().map(|column| cell(*column).unwrap_or(f64::NAN)).collect();
            if self.cases.leveled
                && let Some(level) = cell(level)
            {
                // Use the requested level, which is the same number in every case of a stripe.
                intensities[self.cases.main] = level;
            }
            let mode = modes.and_then(|of| of[row].as_deref());
            let fell_at_rest = mode == Some(CollapseMode::Gravity.name());
            let mode = mode.and_then(|mode| u8::try_from(self.modes.of(mode)).ok());
            let numbers = |column, of: Option<&[Option<String>]>| {
                let text = of.and_then(|of| of[row].as_deref()).unwrap_or_default();
                let filled = text.split(';').map(str::trim).filter(|number| !number.is_empty());
                let parsed = filled.map(|number| {
                    let list = || DecisionError::List { column, found: text.to_owned() };
                    number.parse::<f64>().map_err(|_| list())
                });
                parsed.collect::<Result<Box<[f64]>, _>>()
            };
            let curve = if self.cases.sampled {
                small(self.cases.all.len())
            } else {
                let factors = fixed.iter().map(|f| format_value(f.values.get(row)));
                let key: Vec<String> = std::iter::once(name.to_owned()).chain(factors).collect();
                self.curves.of(&key.join("\n"))
            };
            let (falls, lost) = (numbers("fall_heights", heights)?, numbers("fall_wine", wines)?);
            if lost.len() != falls.len() {
                let found = wines.and_then(|of| of[row].clone()).unwrap_or_default();
                return Err(DecisionError::List { column: "fall_wine", found });
            }
            self.cases.all.push(Arc::new(JudgedCase {
                row: small(first + row),
                record: self.records.of(name),
                collapsed,
                mode,
                followed: [Ending::Rest, Ending::NotShaken]
                    .iter()
                    .any(|ending| ended[row].as_deref() == Some(ending.name())),
                barrels: u32::try_from(barrels[row].unwrap_or(0)).unwrap_or(0),
                falls,
                wines: lost,
                wine: cell(wine).unwrap_or(0.0),
                fell_at_rest,
                forces: match forces.filter(|_| !fell_at_rest) {
                    Some(_) => Some(numbers("fall_forces", forces)?),
                    None => None,
                },
                drift: cell(drift).unwrap_or(f64::NAN),
                intensities,
                curve,
            }));
        }
        Ok(())
    }

    /// Returns the cases of all added rows.
    ///
    /// # Errors
    /// If no case has a verdict.
    pub(super) fn finish(self) -> Result<Cases, DecisionError> {
        let Self { mut cases, records, modes, rows, own, .. } = self;
        if cases.all.is_empty() {
            return Err(DecisionError::NoCases { rows });
        }
        cases.left_out = own - cases.all.len();
        cases.records = records.names();
        cases.modes = modes.names();
        Ok(cases)
    }
}

impl Cases {
    /// Reads the cases of a table.
    pub(crate) fn read(collected: &Collected) -> Result<Self, DecisionError> {
        let mut reading = Reading::new(&collected.provenance)?;
        reading.add(&collected.table)?;
        reading.finish()
    }

    /// Returns a copy that contains only the cases for which `keep` returns `true`.
    #[must_use]
    pub fn only(&self, keep: impl Fn(&JudgedCase) -> bool) -> Self {
        let mut fewer = self.clone();
        fewer.all.retain(|case| keep(case));
        fewer
    }

    /// Returns the number of cases whose stack fell under its own weight, before it was shaken.
    pub fn fallen_at_rest(&self) -> usize {
        self.all.iter().filter(|case| case.fell_at_rest).count()
    }

    /// Returns the intensity measure of the study.
    pub fn measure(&self) -> &Measure {
        &self.measures[self.main]
    }

    /// Returns the largest number of barrels in a stack of the study.
    pub fn most_barrels(&self) -> u32 {
        self.all.iter().map(|case| case.barrels).max().unwrap_or(0)
    }

    /// Returns the largest volume of wine (m³) in a stack of the study.
    pub fn most_wine(&self) -> f64 {
        self.all.iter().map(|case| case.wine).fold(0.0, f64::max)
    }

    /// Returns the number of curves ([`JudgedCase::curve`]).
    pub fn curves(&self) -> usize {
        self.all.iter().map(|case| case.curve).max().map_or(0, |last| last as usize + 1)
    }

    /// Returns the phrase that reports use for the curves: "motions" if each motion has a single curve, otherwise a
    /// longer phrase.
    pub fn curves_are(&self) -> &'static str {
        if self.curves() == self.records.len() {
            "motions"
        } else {
            "curves (one motion and one choice of factors each)"
        }
    }

    /// Returns `true` if losses are reported, that is, if almost every case was simulated until nothing moved.
    pub fn has_losses(&self) -> bool {
        self.endings.no_losses().is_none()
    }

    /// Returns a copy that contains only the cases that were simulated until nothing moved.
    #[must_use]
    pub fn with_known_falls(&self) -> Self {
        self.only(|case| case.followed)
    }

    /// Groups the cases by intensity, in ascending order.
    ///
    /// If [`Cases::shares_levels`] returns `true`, the groups are the levels of the study. Otherwise the groups are
    /// bins with equal numbers of neighboring cases, and the intensity of a bin is the geometric mean over its cases. A
    /// bin has at least 24 cases (or all cases, if there are fewer), because the fraction of failures in a smaller bin
    /// would be too uncertain. There are at most 16 bins, because a trend is easiest to recognize with about a dozen.
    pub fn groups(&self, measure: usize) -> Vec<(f64, Vec<&JudgedCase>)> {
        let mut sorted: Vec<(f64, &JudgedCase)> = self
            .all
            .iter()
            .filter_map(|case| Some((case.intensity(measure)?, case.as_ref())))
            .collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.row.cmp(&b.1.row)));
        let mut found: Vec<(f64, Vec<&JudgedCase>)> = Vec::new();
        if self.shares_levels(measure) {
            for (level, case) in sorted {
                match found.last_mut() {
                    Some((last, cases)) if *last == level => cases.push(case),
                    _ => found.push((level, vec![case])),
                }
            }
            return found;
        }
        let bins = (sorted.len() / FEWEST_OF_BIN).clamp(1, MOST_BINS).min(sorted.len());
        for bin in 0..bins {
            let part = &sorted[bin * sorted.len() / bins..(bin + 1) * sorted.len() / bins];
            let mean = part.iter().map(|(x, _)| libm::log(*x)).sum::<f64>() / part.len() as f64;
            found.push((libm::exp(mean), part.iter().map(|(_, case)| *case).collect()));
        }
        found
    }

    /// Returns `true` if [`Cases::groups`] groups the cases by the levels of a measure instead of bins. The measure
    /// must be the intensity measure of the study, with levels that do not depend on earlier runs. In a study of
    /// independent samples, the levels must also have at least eight cases on average.
    pub fn shares_levels(&self, measure: usize) -> bool {
        if !self.leveled || self.hunted || measure != self.main {
            return false;
        }
        let mut levels: Vec<f64> =
            self.all.iter().filter_map(|case| case.intensity(measure)).collect();
        let cases = levels.len();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        !self.sampled || cases >= FEWEST_OF_LEVEL * levels.len()
    }
}

/// Minimum number of cases in a bin, unless the study has fewer cases.
const FEWEST_OF_BIN: usize = 24;

/// Maximum number of bins.
const MOST_BINS: usize = 16;

/// Minimum mean number of cases per level in a study of independent samples. With fewer cases, the cases are grouped in
/// bins that may contain several levels.
const FEWEST_OF_LEVEL: usize = 8;

/// Formats a value of a factor; `None` gives an empty string.
pub(super) fn format_value(value: Option<Value>) -> String {
    value.map_or_else(String::new, |value| word(&value))
}
