//! The summary of a run as rows of text.

use barrelstack::{Run, Summary};

/// Width of the name of a row.
const NAME: usize = 24;

/// The rows, in reading order.
pub(crate) fn rows(run: &Run, summary: &Summary) -> Vec<String> {
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push(format!("  {name:NAME$}{value}"));
    let outcome = &summary.outcome;
    let verdict = match (outcome.mode, outcome.time) {
        (Some(mode), Some(time)) => format!("{} by {mode} at {time:.3} s", outcome.kind),
        _ => outcome.kind.to_owned(),
    };
    row("outcome", verdict);
    if outcome.barrels > 0 {
        row("barrels fallen", format!("{} of {}", outcome.barrels_fallen, outcome.barrels));
    }
    for body in summary.bodies.iter().filter(|b| b.kind == "barrel") {
        if let (Some(fell), Some(height)) = (body.fell_at, body.fall_height) {
            row(&format!("  {}", body.name), format!("fell at {fell:.2} s from {height:.2} m"));
        }
    }
    let demands = &summary.demands;
    let mut demand = |name: &str, value: Option<f64>, factor: f64, unit: &str| {
        if let Some(value) = value {
            row(name, format!("{} {unit}", three_digits(factor * value)));
        }
    };
    demand("drift of the top", demands.top_drift_ratio, 100.0, "% of the height");
    demand("stress amplification", demands.stress_amplification, 1.0, "× at rest");
    demand("slip of the bottom rack", demands.base_slip_residual, 100.0, "cm at the end");
    row(
        "energy books",
        format!("residual {:.1e} of {:.0} J", summary.energy.residual_ratio, summary.energy.input),
    );
    let speed = summary
        .run
        .wall_seconds
        .filter(|wall| *wall > 0.0)
        .map(|wall| format!(", {wall:.2} s on the clock"))
        .unwrap_or_default();
    row(
        "computed",
        format!(
            "{:.1} s in {} steps of {} ms ({}){speed}",
            summary.run.end_time,
            summary.run.steps,
            three_digits(1e3 * summary.run.time_step),
            summary.run.method
        ),
    );
    row("contact constants", format!("per {}", run.stiffness_basis()));
    rows
}

/// A number with three significant digits.
fn three_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    #[expect(clippy::cast_possible_truncation, reason = "a small exponent")]
    let exponent = value.abs().log10().floor() as i32;
    let decimals = usize::try_from((2 - exponent).max(0)).unwrap_or(0);
    if (-3..6).contains(&exponent) { format!("{value:.decimals$}") } else { format!("{value:.2e}") }
}
