//! The definitions of the stress amplification that are consistent with the wording of the paper, and their values.

use barrelstack::run::Run;
use barrelstack::watch::StressEnvelope;
use barrelstack_report::significant;

use super::compare::{Agreement, Comparison, NOT_STATED};
use super::numbering;

/// Returns the stress envelope of the barrel that has the given number in the paper; `None` if the run has none.
pub(super) fn envelope(run: &Run, number: u32) -> Option<&StressEnvelope> {
    let name = numbering::name(number, run.scenario.stack()?.columns);
    let body = run.assembly.parts.iter().position(|part| part.name == name)?;
    run.stresses.of(body)
}

/// Returns the largest vertical force on barrel 1 until the first loss of a seat, divided by the force at rest. The
/// force comes from the rack above the barrel if `above` is `true`, and otherwise from the rack below it. `None` if
/// there is no such rack.
fn of_boundary(run: &Run, above: bool) -> Option<f64> {
    let body = envelope(run, 1)?.body;
    let joint =
        run.recording.joints.iter().map(|history| &history.joint).find(|joint| {
            joint.by_design && body == if above { joint.lower } else { joint.upper }
        })?;
    Some(joint.until_loss.vertical.0 / joint.at_rest)
}

/// A definition of the stress amplification: its name, the function that computes its value for a run, and an
/// explanation.
type Definition = (&'static str, fn(&Run) -> Option<f64>, &'static str);

/// Definitions of the stress amplification of barrel 1.
const DEFINITIONS: [Definition; 7] = [
    (
        "the largest stress divided by the largest stress at rest",
        |run| envelope(run, 1)?.amplification(),
        "the largest value of the envelope divided by the largest stress at rest; the two may occur at different points of the boundary",
    ),
    (
        "the mean of the ratios of the largest stress to the stress at rest",
        |run| envelope(run, 1)?.mean_ratio(),
        "the ratio of the envelope to the stress at rest at each point, averaged over the boundary that is loaded at rest",
    ),
    (
        "the mean of the envelope divided by the mean stress at rest",
        average,
        "envelope and stress at rest, both averaged over the boundary that is loaded at rest",
    ),
    (
        "the mean of the envelope over its loaded part, divided by the mean stress at rest",
        |run| envelope(run, 1)?.mean_of_envelope(),
        "the envelope averaged over the boundary that is loaded at any time, the stress at rest \
         averaged over the boundary that is loaded at rest",
    ),
    (
        "the largest force on the upper boundary divided by the force at rest",
        |run| of_boundary(run, true),
        "the vertical force of the rack above on the barrel",
    ),
    (
        "the largest force on the lower boundary divided by the force at rest",
        |run| of_boundary(run, false),
        "the vertical force of the barrel on its own rack",
    ),
    (
        "the largest sum of all forces divided by their sum at rest",
        |run| envelope(run, 1)?.total_amplification(),
        "the sum of all normal forces on the barrel at one instant, which is the integral of the stress",
    ),
];

/// Returns the mean of the stress envelope of barrel 1, divided by the mean stress at rest.
///
/// The envelope is the largest stress at each point until the first loss of a seat. Both means are taken over the part
/// of the boundary that is loaded at rest.
pub(super) fn average(run: &Run) -> Option<f64> {
    envelope(run, 1)?.mean_amplification()
}

/// Returns one row for every definition of the stress amplification, with its value in the run of a case. `place` is
/// the place in the paper that states an amplification for this case.
pub(super) fn definitions(run: &Run, place: &'static str, case: &str) -> Vec<Comparison> {
    let row = |(name, value, meaning): Definition| Comparison {
        place,
        quantity: format!("{case}, barrel 1, amplification defined as {name}"),
        published: NOT_STATED.to_owned(),
        ours: value(run).map_or_else(|| "–".to_owned(), |value| significant(value, 3)),
        difference: None,
        band: None,
        agreement: Agreement::NotCompared,
        why: format!("{meaning}; evaluated until the first loss of a seat"),
    };
    DEFINITIONS.into_iter().map(row).collect()
}
