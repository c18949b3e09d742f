//! The sentences of a report: what a person would say who had watched the run.

use barrelstack_motion::STANDARD_GRAVITY;

use crate::outcome::{CollapseMode, Outcome};
use crate::run::Run;
use crate::summary::Summary;

/// The answer in one sentence.
pub(super) fn headline(run: &Run, summary: &Summary) -> String {
    let outcome = &summary.outcome;
    match &run.outcome {
        Outcome::Stable => "The stack stands.".into(),
        Outcome::NotJudged => "The scene ran to its end.".into(),
        Outcome::Invalid { .. } => "The run broke down and says nothing about the stack.".into(),
        Outcome::Collapse { time, .. } => match outcome.barrels_fallen {
            0 => format!("The stack comes apart after {time:.1} s, but no barrel falls."),
            1 => format!(
                "One of {} barrels falls, the stack gives way after {time:.1} s.",
                outcome.barrels
            ),
            fallen if fallen == outcome.barrels => {
                format!("All {fallen} barrels fall, the stack gives way after {time:.1} s.")
            }
            fallen => format!(
                "{fallen} of {} barrels fall, the stack gives way after {time:.1} s.",
                outcome.barrels
            ),
        },
    }
}

/// Levels in words: "level 3", "levels 2 to 4".
fn levels(from: u32, to: u32) -> String {
    if from == to { format!("level {from}") } else { format!("levels {from} to {to}") }
}

/// The sentences that back the headline.
pub(super) fn details(run: &Run, summary: &Summary) -> Vec<String> {
    let mut sentences = Vec::new();
    match &run.outcome {
        Outcome::Collapse { mode, first, from_level, to_level, .. } => {
            let part = levels(*from_level, *to_level);
            let what = match mode {
                CollapseMode::Ejection => format!(
                    "The barrels of {part} are thrown off the stack; {first} leaves its seat first."
                ),
                CollapseMode::Rocking => format!(
                    "The part above, {part}, rocks on the barrels below and topples; {first} leaves \
                     its seat first."
                ),
                CollapseMode::RackSliding => format!(
                    "Rack {first} walks along the barrels below until it is off them, and takes \
                     {part} with it."
                ),
                CollapseMode::Overturning => {
                    "The whole stack turns over about its foot.".to_owned()
                }
            };
            sentences.push(what);
        }
        Outcome::Stable => {
            let drift = summary.demands.top_drift_ratio.unwrap_or(0.0);
            let slip = summary.demands.base_slip_residual.unwrap_or(0.0);
            sentences.push(format!(
                "Its top sways by up to {:.1} % of its height, and its foot ends {:.1} cm from where \
                 it stood.",
                100.0 * drift,
                100.0 * slip.abs()
            ));
        }
        Outcome::NotJudged => {}
        Outcome::Invalid { reason } => sentences.push(format!("{}.", capital(reason))),
    }
    if let Some(motion) = &summary.motion {
        sentences.push(format!(
            "The ground moved as in {}: up to {:.2} g and {:.0} cm/s{}.",
            motion.name,
            motion.pga / STANDARD_GRAVITY,
            100.0 * motion.pgv,
            if motion.vertical { ", with its vertical component" } else { "" }
        ));
    }
    if run.assembly.levels > 0 {
        sentences.push(
            "One run is one possible course: small changes of friction or gaps can change who falls \
             when, so judge a stack by many runs."
                .into(),
        );
    }
    sentences
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + chars.as_str())
}

/// What made the result, in pairs of name and value.
pub(super) fn provenance(run: &Run, summary: &Summary) -> Vec<(String, String)> {
    let mut pairs = vec![
        ("program".to_owned(), format!("barrelstack {}", summary.provenance.version)),
        ("scenario fingerprint".to_owned(), summary.provenance.scenario_hash.clone()),
        (
            "integration".to_owned(),
            format!(
                "{}, time step {:.4} ms, {} steps",
                summary.run.method,
                1e3 * summary.run.time_step,
                summary.run.steps
            ),
        ),
        (
            "contact constants".to_owned(),
            match summary.run.stiffness_basis {
                "node" => "stated per contact node, as in the paper".to_owned(),
                "length" => "stated per meter of boundary".to_owned(),
                other => other.to_owned(),
            },
        ),
        (
            "energy books".to_owned(),
            format!(
                "residual {:.2e} of the {:.0} J that went through",
                summary.energy.residual_ratio, summary.energy.input
            ),
        ),
    ];
    for (index, step) in summary.provenance.motion.iter().enumerate() {
        pairs.push((format!("motion, step {}", index + 1), step.clone()));
    }
    if run.scenario.run.similitude != 1.0 {
        pairs.push((
            "similitude".to_owned(),
            format!("length scale {}, everything below at that scale", run.scenario.run.similitude),
        ));
    }
    pairs
}
