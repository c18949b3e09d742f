//! What a calibration gives: parameters with intervals, lines for a scenario, warnings.

use barrelstack::scenario::Dimension;
use serde_json::{Value, json};

/// A parameter with its 95 % interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// What it is, such as "stiffness k".
    pub name: String,
    /// Value (SI).
    pub value: f64,
    /// Lower end of the interval (SI); `−∞` or 0 where the test does not bound it.
    pub low: f64,
    /// Upper end of the interval (SI); infinite where the test does not bound it.
    pub high: f64,
    /// What it measures.
    pub dimension: Dimension,
}

/// What a test gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Calibration {
    /// The test, in one line.
    pub title: String,
    /// Parameters.
    pub estimates: Vec<Estimate>,
    /// Correlations between the estimates, in their order; empty where they are not fitted together.
    pub correlation: Vec<Vec<f64>>,
    /// Ratio of the largest to the smallest eigenvalue of the correlation of the sensitivities; none
    /// where parameters are not fitted together.
    pub condition: Option<f64>,
    /// Further figures for people, name and value.
    pub facts: Vec<(String, String)>,
    /// Lines to paste into a scenario.
    pub scenario: String,
    /// What the reader should know, one sentence each.
    pub warnings: Vec<String>,
}

impl Estimate {
    /// An estimate with an interval of equal arms.
    pub(super) fn symmetric(name: &str, value: f64, half: f64, dimension: Dimension) -> Self {
        let (low, high) = (value - half, value + half);
        Self { name: name.to_owned(), value, low, high, dimension }
    }

    /// Whether a value lies within the interval.
    pub fn covers(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// The unit; nothing for a plain number.
    fn unit(&self) -> String {
        if self.dimension == Dimension::NONE { String::new() } else { self.dimension.si_unit() }
    }

    /// Half the width of the interval over the value.
    pub fn relative(&self) -> f64 {
        0.5 * (self.high - self.low) / self.value.abs()
    }
}

impl Calibration {
    /// The estimate of a name.
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }

    /// The result for people: a table, further figures, the lines for a scenario.
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

    /// The result for programs, all numbers in SI; an end that the test does not bound is null.
    pub fn to_json(&self) -> Value {
        let estimates = self.estimates.iter().map(|estimate| {
            json!({
                "name": estimate.name,
                "value": estimate.value,
                "low": bounded(estimate.low),
                "high": bounded(estimate.high),
                "unit": estimate.dimension.si_unit(),
            })
        });
        let facts: serde_json::Map<String, Value> =
            self.facts.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
        json!({
            "title": self.title,
            "confidence": 0.95,
            "estimates": estimates.collect::<Vec<_>>(),
            "correlation": self.correlation,
            "condition": self.condition.and_then(bounded),
            "facts": facts,
            "scenario": self.scenario,
            "warnings": self.warnings,
        })
    }
}

/// A warning for every two estimates whose correlation is above a limit.
pub(super) fn inseparable(
    estimates: &[Estimate],
    correlation: &[Vec<f64>],
    limit: f64,
) -> Vec<String> {
    let mut warnings = Vec::new();
    for (i, row) in correlation.iter().enumerate() {
        for (j, value) in row.iter().enumerate().skip(i + 1).filter(|(_, v)| v.abs() > limit) {
            warnings.push(format!(
                "{} and {} cannot be told apart by what was measured: correlation {value:.3}; state one \
                 of them from a test of its own and fit the other",
                estimates[i].name, estimates[j].name
            ));
        }
    }
    warnings
}

fn bounded(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Rows with their columns under each other.
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

/// Four significant digits: three that are read and one to compute with.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// A number for people, with four significant digits.
pub(super) fn short(value: f64) -> String {
    let value = rounded(value);
    if value != 0.0 && !(1e-3..1e4).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// A quantity as a scenario takes it, with its quotes.
pub(super) fn quoted(value: f64, dimension: Dimension) -> String {
    format!("\"{} {}\"", short(value), dimension.si_unit())
}
