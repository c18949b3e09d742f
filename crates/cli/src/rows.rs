//! The summary of a run as rows of text.

use std::fmt::Write as _;

use barrelstack::outcome::Outcome;
use barrelstack::render::{drift_line, final_picture};
use barrelstack::variants::words::{course, percent};
use barrelstack::{Run, Summary};
use barrelstack_report::{Characters, measured};

/// Width (characters) of the column of names.
const NAME: usize = 24;
/// Width (characters) of the plot of the drift over time.
const SPARKS: usize = 40;

/// Returns the rows in reading order; `changes` are the values changed on the command line.
pub(crate) fn rows(
    run: &Run,
    summary: &Summary,
    changes: &[String],
    characters: Characters,
) -> Vec<String> {
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push(format!("  {name:NAME$}{value}"));
    for (index, change) in changes.iter().enumerate() {
        row(if index == 0 { "changed" } else { "" }, change.clone());
    }
    if let Some(spread) = &summary.ensemble {
        let [low, high] = spread.interval.map(percent);
        row(
            "variants",
            format!(
                "{} of {} collapse, 95 % interval {low} to {high}",
                spread.collapsed, spread.variants
            ),
        );
        if let Some([low, high]) = spread.range.map(|range| range.map(percent)) {
            row("", format!("{low} to {high} over the uncertain constants of the seats"));
        }
        if spread.first_loss.is_some() {
            row("", course(spread));
        }
        let modes: Vec<String> =
            spread.modes.iter().map(|(mode, count)| format!("{mode} in {count}")).collect();
        if !modes.is_empty() {
            row("", modes.join(", "));
        }
        let shown = match summary.variant {
            0 => "the stack as stated".to_owned(),
            number => format!("variant {number}"),
        };
        row("shown below", shown);
    }
    row("outcome", verdict(summary));
    if matches!(run.outcome, Outcome::Invalid { .. }) {
        row("computed", format!("until {:.3} s", summary.run.end_time));
        row("time step", format!("{} ms", three_digits(1e3 * summary.run.time_step)));
        return rows;
    }
    let outcome = &summary.outcome;
    if let Some(fallen) = outcome.barrels_fallen.filter(|_| outcome.barrels > 0) {
        row("barrels fallen", format!("{fallen} of {}", outcome.barrels));
    }
    let mut fallen: Vec<(f64, f64, &str)> = summary
        .bodies
        .iter()
        .filter(|body| body.kind == "barrel")
        .filter_map(|body| Some((body.fell_at?, body.fall_height?, body.name.as_str())))
        .collect();
    fallen.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (at, height, name) in fallen {
        row(&format!("  {name}"), format!("fell at {at:.2} s from {height:.2} m"));
    }
    let demands = &summary.demands;
    if let Some(drift) = demands.top_drift_ratio {
        let drift = measured(100.0 * drift, 1);
        row("drift of the top", format!("{drift} % of the height"));
        if let Some((line, [until, peak])) = drift_line(run, SPARKS, characters) {
            row("  while it stood", format!("{line} {until:.1} s"));
            row("", format!("largest at {peak:.2} s"));
        }
    }
    if let Some(amplification) = demands.stress_amplification {
        row("stress amplification", format!("{} × at rest", three_digits(amplification)));
    }
    if let Some(load) = demands.stave_utilization {
        let whole = summary.demands_whole_run.stave_utilization.filter(|whole| *whole > load);
        let falls = whole.map_or_else(String::new, |whole| {
            format!(" until the first loss of a seat, {:.0} % over the whole run", 100.0 * whole)
        });
        row("load on staves", format!("{:.0} % of their capacity{falls}", 100.0 * load));
    }
    if let Some(slip) = demands.base_slip_residual {
        row("slip of the bottom rack", moved(slip));
    }
    if let Some(energy) = &summary.energy {
        row(
            "energy balance",
            format!(
                "residual {:.1e} of the {} exchanged",
                energy.residual_ratio,
                joules(energy.input)
            ),
        );
    }
    row("computed", computed(summary));
    row("contact constants", format!("per {}", run.stiffness_basis()));
    rows
}

/// Draws the stack at the end of the run, below a title.
pub(crate) fn picture(run: &Run, characters: Characters) -> Vec<String> {
    let picture = final_picture(run, characters);
    if picture.is_empty() {
        return Vec::new();
    }
    let title = format!("  at the end, {:.1} s:", run.end_time);
    let lines = picture.into_iter().map(|line| format!("  {line}").trim_end().to_owned());
    [String::new(), title].into_iter().chain(lines).collect()
}

/// Describes the outcome in a few words.
fn verdict(summary: &Summary) -> String {
    let outcome = &summary.outcome;
    match (outcome.kind, outcome.mode, outcome.time) {
        (kind, Some(mode), Some(time)) => format!("{kind} by {mode} at {time:.2} s"),
        ("interrupted", ..) => "none: stopped before its end".to_owned(),
        ("not-judged", ..) => "not judged: a free scene has no seats to lose".to_owned(),
        (kind, ..) => kind.to_owned(),
    }
}

/// Describes the computation and its speed.
fn computed(summary: &Summary) -> String {
    let run = &summary.run;
    let mut text = format!(
        "{:.1} s in {} steps of {} ms ({})",
        run.end_time,
        run.steps,
        three_digits(1e3 * run.time_step),
        run.method
    );
    if let Some(wall) = run.wall_seconds {
        let _ = write!(text, ", {wall:.2} s elapsed");
    }
    text
}

/// Formats an energy (J) with its unit.
fn joules(energy: f64) -> String {
    if energy.abs() < 1e3 {
        format!("{} J", three_digits(energy))
    } else {
        format!("{} kJ", three_digits(1e-3 * energy))
    }
}

/// Formats a displacement (m) with its direction.
fn moved(distance: f64) -> String {
    if distance.abs() < 5e-4 {
        return "none at the end".to_owned();
    }
    let side = if distance > 0.0 { "right" } else { "left" };
    format!("{:.1} cm to the {side} at the end", 100.0 * distance.abs())
}

/// Formats a number with three significant digits.
fn three_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::disallowed_methods,
        reason = "a small exponent of a printed number"
    )]
    let exponent = value.abs().log10().floor() as i32;
    let decimals = usize::try_from((2 - exponent).max(0)).unwrap_or(0);
    if (-3..6).contains(&exponent) { format!("{value:.decimals$}") } else { format!("{value:.2e}") }
}
