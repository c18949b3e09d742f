//! Result of a calibration: parameters with intervals, lines for a scenario, and warnings.

use std::collections::BTreeMap;

use barrelstack::scenario::Dimension;
use barrelstack_report::{Figure, described};

/// A parameter with its 95 % interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Name, such as "stiffness k".
    pub name: String,
    /// Value (SI).
    pub value: f64,
    /// Lower end of the interval (SI); `−∞` or 0 if the test does not bound it.
    pub low: f64,
    /// Upper end of the interval (SI); infinite if the test does not bound it.
    pub high: f64,
    /// Physical dimension of the value.
    pub dimension: Dimension,
}

/// Model prediction for one statement about an earthquake: the share of stacks that fall, or of barrels that lie on
/// the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelShare {
    /// Name of the statement.
    pub statement: String,
    /// Interval that holds the central 90 % of the predicted shares before the statements are used. The shares are
    /// predicted for random parameters, random motions and random mixtures of stacks with different numbers of levels.
    pub before: [f64; 2],
    /// Interval that holds the central 90 % of the predicted shares, given all statements.
    pub given: [f64; 2],
}

/// Result of a calibration from one test or several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Calibration {
    /// Title on one line, such as "tap test stack.csv: period of sway".
    pub title: String,
    /// Estimated parameters.
    pub estimates: Vec<Estimate>,
    /// Correlation matrix of the estimates, in the order of `estimates`; empty if the parameters are not
    /// fitted together.
    pub correlation: Vec<Vec<f64>>,
    /// Condition number of the fit: ratio of the largest to the smallest eigenvalue of the normalized
    /// information matrix; `None` if parameters are not fitted together.
    pub condition: Option<f64>,
    /// Figures that compare the measurements with the fit.
    pub figures: Vec<Figure>,
    /// Shares that the model predicts for the statements; empty if the parameters are not estimated from statements.
    pub shares: Vec<ModelShare>,
    /// Sentences on what the intervals cover and what they do not; `None` for the default sentences, which apply to a
    /// calibration from tests.
    pub covers: Option<&'static str>,
    /// Further results for display, as pairs of name and value.
    pub facts: Vec<(String, String)>,
    /// Lines to paste into a scenario.
    pub scenario: String,
    /// Warnings, for example about limits of the test; one sentence each.
    pub warnings: Vec<String>,
}

/// Converts the name of an interface into a phrase for its pair of bodies, such as "barrel-rack" into "barrels on
/// racks". Other names are returned unchanged.
pub(super) fn bodies(interface: &str) -> &str {
    match interface {
        "rack-ground" => "racks on the ground",
        "barrel-rack" => "barrels on racks",
        "rack-rack" => "racks on racks",
        "barrel-barrel" => "barrels on barrels",
        "barrel-ground" => "barrels on the ground",
        "fallen-barrel-rack" => "fallen barrels on racks",
        "fallen-rack-ground" => "fallen racks on the ground",
        "fallen-rack-rack" => "fallen racks on racks",
        other => other,
    }
}

impl Estimate {
    /// Creates an estimate with a symmetric interval.
    pub(super) fn symmetric(name: &str, value: f64, half: f64, dimension: Dimension) -> Self {
        let (low, high) = (value - half, value + half);
        Self { name: name.to_owned(), value, low, high, dimension }
    }

    /// Creates an estimate from its logarithm and half the width of the interval, which is symmetric in the logarithm.
    /// `of` converts a logarithm to the value.
    pub(super) fn of_log(
        name: &str,
        log: f64,
        half: f64,
        dimension: Dimension,
        of: impl Fn(f64) -> f64,
    ) -> Self {
        let [value, low, high] = [log, log - half, log + half].map(of);
        Self { name: name.to_owned(), value, low, high, dimension }
    }

    /// `true` if a value lies within the interval.
    pub fn covers(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Returns the SI unit of the value; empty if the value is dimensionless.
    pub(super) fn unit(&self) -> String {
        if self.dimension == Dimension::NONE { String::new() } else { self.dimension.si_unit() }
    }

    /// Returns half the width of the interval, relative to the value.
    pub fn relative(&self) -> f64 {
        0.5 * (self.high - self.low) / self.value.abs()
    }
}

impl Calibration {
    /// Returns the estimate of the parameter with the name `name`; `None` if there is no such parameter.
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }

    /// Formats the result for a terminal: a table of the estimates, further results, and the lines for a
    /// scenario.
    pub fn lines(&self) -> Vec<String> {
        let head = ["parameter", "value", "95 % interval", "unit"].map(str::to_owned);
        let cells = |estimate: &Estimate| {
            let interval = match (estimate.low.is_finite(), estimate.high.is_finite()) {
                (true, true) => format!("{} to {}", short(estimate.low), short(estimate.high)),
                (true, false) => format!("above {}", short(estimate.low)),
                _ => "not determined".to_owned(),
            };
            [estimate.name.clone(), short(estimate.value), interval, estimate.unit()]
        };
        let rows: Vec<[String; 4]> =
            std::iter::once(head).chain(self.estimates.iter().map(cells)).collect();
        let mut lines = vec![self.title.clone(), String::new()];
        lines.extend(aligned(&rows));
        if !self.correlation.is_empty() {
            lines.extend([String::new(), "correlation".to_owned()]);
            let rows: Vec<Vec<String>> = self
                .estimates
                .iter()
                .zip(&self.correlation)
                .map(|(estimate, row)| {
                    let values = row.iter().map(|value| format!("{value:+.2}"));
                    std::iter::once(estimate.name.clone()).chain(values).collect()
                })
                .collect();
            lines.extend(aligned(&rows));
        }
        if !self.facts.is_empty() {
            lines.push(String::new());
            let rows: Vec<[String; 2]> =
                self.facts.iter().map(|(name, value)| [name.clone(), value.clone()]).collect();
            lines.extend(aligned(&rows));
        }
        if !self.scenario.is_empty() {
            lines.extend([String::new(), "for a scenario:".to_owned(), String::new()]);
            lines.extend(self.scenario.lines().map(str::to_owned));
        }
        lines
    }

    /// Returns the result as a machine-readable document. All numbers are in SI units; unbounded ends of intervals are
    /// null.
    pub fn to_document(&self) -> CalibrationDocument {
        CalibrationDocument::of(self)
    }
}

described! {
    /// Contact parameters from tests.
    pub struct CalibrationDocument of found: &Calibration {
        /// Name and version of the format of this document.
        pub schema: &'static str ["calibration/1"] = "calibration/1",
        /// Title: the test in one line.
        pub title: String = found.title.clone(),
        /// Confidence level of the intervals.
        pub confidence: f64 as "1" = 0.95,
        /// The parameters.
        pub estimates: Vec<EstimateRow> = found.estimates.iter().map(EstimateRow::of).collect(),
        /// Correlation matrix of the estimates, in the order of `estimates`; empty if the parameters are not
        /// fitted together.
        pub correlation: Vec<Vec<f64>> as "1" = found.correlation.clone(),
        /// Condition number of the fit: ratio of the largest to the smallest eigenvalue of the normalized
        /// information matrix.
        pub condition: Option<f64> as "1" = found.condition.and_then(bounded),
        /// Shares of stacks or barrels that fall according to the model, for each statement on what fell in an
        /// earthquake; empty for a fit to tests.
        pub shares: Vec<ShareRow> = found.shares.iter().map(ShareRow::of).collect(),
        /// Further results for display, as texts with their names.
        pub facts: BTreeMap<String, String> = found.facts.iter().cloned().collect(),
        /// Lines to paste into a scenario.
        pub scenario: String = found.scenario.clone(),
        /// Warnings.
        pub warnings: Vec<String> = found.warnings.clone(),
    }

    /// Share of stacks or barrels that fall according to the model, for one statement on what fell in an earthquake.
    pub struct ShareRow of share: &ModelShare {
        /// Name of the statement.
        pub statement: String = share.statement.clone(),
        /// Interval that holds the central 90 % of the predicted shares, before the statements are used.
        pub before: [f64; 2] as "1" = share.before,
        /// Interval that holds the central 90 % of the predicted shares, given all statements.
        pub given: [f64; 2] as "1" = share.given,
    }

    /// One estimated parameter.
    pub struct EstimateRow of estimate: &Estimate {
        /// Name of the parameter.
        pub name: String = estimate.name.clone(),
        /// Value of the parameter.
        pub value: f64 as "as `unit` says" = estimate.value,
        /// Lower end of the 95 % interval; null if unbounded.
        pub low: Option<f64> as "as `unit` says" = bounded(estimate.low),
        /// Upper end of the 95 % interval; null if unbounded.
        pub high: Option<f64> as "as `unit` says" = bounded(estimate.high),
        /// SI unit of the value and of the interval.
        pub unit: String = estimate.dimension.si_unit(),
    }
}

/// Returns a warning for every pair of estimates whose correlation exceeds a limit.
pub(super) fn inseparable(
    estimates: &[Estimate],
    correlation: &[Vec<f64>],
    limit: f64,
) -> Vec<String> {
    let mut warnings = Vec::new();
    for (i, row) in correlation.iter().enumerate() {
        for (j, value) in row.iter().enumerate().skip(i + 1).filter(|(_, v)| v.abs() > limit) {
            warnings.push(format!(
                "the measurements do not separate {} from {} (correlation {value:.3}): determine one of them by a \
                 separate test and fit the other",
                estimates[i].name, estimates[j].name
            ));
        }
    }
    warnings
}

fn bounded(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Pads the cells of rows so that their columns align.
fn aligned<R: AsRef<[String]>>(rows: &[R]) -> Vec<String> {
    let columns = rows.iter().map(|row| row.as_ref().len()).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter()
            .filter_map(|row| row.as_ref().get(column))
            .map(|cell| cell.chars().count())
            .max()
    };
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let padded = |row: &R| {
        let cells = row.as_ref().iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
        format!("  {}", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned()
    };
    rows.iter().map(padded).collect()
}

/// Rounds a number to four significant digits: the three that are displayed, and one more for further
/// computation.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Formats a number with four significant digits.
pub(super) fn short(value: f64) -> String {
    let value = rounded(value);
    if value != 0.0 && !(1e-3..1e4).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Formats a quantity with its unit, in quotes, for a scenario.
pub(super) fn quoted(value: f64, dimension: Dimension) -> String {
    format!("\"{} {}\"", short(value), dimension.si_unit())
}
