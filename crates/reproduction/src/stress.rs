//! Every definition of stress amplification that the paper's words allow, with its value.

use barrelstack::run::Run;
use barrelstack::watch::StressEnvelope;
use barrelstack_report::significant;

use super::compare::{Comparison, Verdict};
use super::numbering;

/// The envelope of one of the paper's barrels.
pub(super) fn envelope(run: &Run, number: u32) -> Option<&StressEnvelope> {
    let name = numbering::name(number, run.scenario.stack()?.columns);
    let body = run.assembly.parts.iter().position(|part| part.name == name)?;
    run.stresses.of(body)
}

/// The largest vertical force until the first loss of seat over that at rest, of what lies on barrel 1 or of what
/// carries it.
fn of_boundary(run: &Run, above: bool) -> Option<f64> {
    let body = envelope(run, 1)?.body;
    let joint =
        run.recording.joints.iter().map(|history| &history.joint).find(|joint| {
            joint.by_design && body == if above { joint.lower } else { joint.upper }
        })?;
    Some(joint.until_loss.vertical.0 / joint.at_rest)
}

/// A definition: its name, its value in a run, and what it is.
type Definition = (&'static str, fn(&Run) -> Option<f64>, &'static str);

/// Definitions of the stress amplification of barrel 1.
const DEFINITIONS: [Definition; 7] = [
    (
        "largest stress over largest at rest",
        |run| envelope(run, 1)?.amplification(),
        "one point of the envelope over one point at rest, each wherever it is largest",
    ),
    (
        "mean of ratios",
        |run| envelope(run, 1)?.mean_ratio(),
        "the envelope over the stress at rest point by point, averaged over the boundary that is loaded at rest",
    ),
    (
        "mean of the envelope over the mean at rest",
        average,
        "both averaged over the boundary that is loaded at rest",
    ),
    (
        "mean of the envelope where it is loaded over the mean at rest",
        |run| envelope(run, 1)?.mean_of_envelope(),
        "the envelope averaged over all of the boundary that it covers, the stress at rest over what is loaded then",
    ),
    (
        "upper boundary: largest force over that at rest",
        |run| of_boundary(run, true),
        "the vertical force of the rack above",
    ),
    (
        "lower boundary: largest force over that at rest",
        |run| of_boundary(run, false),
        "the vertical force of the barrel on its own rack",
    ),
    (
        "all forces: largest sum over that at rest",
        |run| envelope(run, 1)?.total_amplification(),
        "the sum of all normal forces on the barrel at one instant, which is the integral of the stress",
    ),
];

/// The largest stresses on barrel 1 until the first loss of seat over those at rest, both averaged over the boundary that
/// is loaded at rest.
pub(super) fn average(run: &Run) -> Option<f64> {
    envelope(run, 1)?.mean_amplification()
}

/// A row for every definition, of a case that the paper says a number of.
pub(super) fn definitions(run: &Run, place: &'static str, case: &str) -> Vec<Comparison> {
    let row = |(name, value, meaning): Definition| Comparison {
        place,
        quantity: format!("{case}, barrel 1, by definition: {name}"),
        published: "not stated".to_owned(),
        ours: value(run).map_or_else(|| "–".to_owned(), |value| significant(value, 3)),
        difference: None,
        band: None,
        verdict: Verdict::NotCompared,
        why: format!("{meaning}; until the first loss of seat"),
    };
    DEFINITIONS.into_iter().map(row).collect()
}
