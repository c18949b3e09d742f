//! Report of a run: sections, their order and their wording.

mod depth;
mod drawing;
mod glossary;
mod inputs;
mod planes;
mod sections;
mod spectrum;
mod stamp;
mod tables;
mod trust;
mod unknowns;
mod words;

use barrelstack_report::{Block, Document, Tone, Verdict};

pub(crate) use drawing::ground_histories;
pub use drawing::ground_history;
pub use drawing::{legend, scene};

use crate::assemble::{AssembleError, Assembly, assemble};
use crate::outcome::Outcome;
use crate::run::Run;
use crate::summary::Summary;
use crate::variants::{self, Answer, Plane, Remedy, Shown, Variants};

pub use glossary::WORDS;
pub use inputs::{inputs, not_modeled};
pub(crate) use inputs::{settings_table, shown};
pub use planes::RANGES;
pub use sections::{balanced, player, standing_range, stress_figure};
pub(crate) use sections::{standing_until, traces};
pub use stamp::stamp_pages;
pub use tables::{demand_table, device_table, interface_table};
pub use trust::trust;
pub use unknowns::unknowns;
pub use words::{command, device as device_sentence, fine, record_fingerprints, stopped};
pub(crate) use words::{headline, provenance};

/// Summarizes the result in a few plain sentences: the verdict, its cause, and its reliability.
pub fn sentences(run: &Run, summary: &Summary) -> Vec<String> {
    let mut sentences = vec![headline(run, summary)];
    sentences.extend(summary.remedy.as_ref().map(Remedy::sentence));
    sentences.extend(words::details(run, summary, None));
    sentences
}

/// Builds the whole report as a document that is independent of any output format.
pub fn document(run: &Run, summary: &Summary) -> Document {
    page(run, summary, (None, None))
}

/// Builds the report of an answer.
///
/// The report describes the governing plane, and shows the players of both planes side by side. If the shown run was
/// repeated with small changes, the report includes the results of these repeats.
pub fn answer_document(answer: &Answer) -> Document {
    let Answer { decides, other, .. } = answer;
    let variants = (decides.variants.as_ref(), other.as_ref());
    page(&decides.run, &decides.summary, variants)
}

/// Returns the player of the run that an answer shows, with a pane for each plane of the answer.
pub fn stage(answer: &Answer) -> Block {
    let Answer { decides: Shown { run, summary, variants, .. }, other, .. } = answer;
    let scene = drawing::scene_among(run, variants.as_ref());
    sections::stage(run, summary, other.as_ref(), &scene)
}

/// Draws the stack as assembled, in each of its planes, for a page that does not show a run yet.
///
/// # Errors
/// When the stack cannot be assembled.
pub fn still(planes: &[Plane]) -> Result<Block, AssembleError> {
    let assemblies: Result<Vec<Assembly>, _> =
        planes.iter().map(|plane| assemble(&plane.scenario)).collect();
    Ok(planes::still(&assemblies?))
}

fn page(
    run: &Run,
    summary: &Summary,
    (variants, other): (Option<&Variants>, Option<&Shown>),
) -> Document {
    let scene = drawing::scene_among(run, variants);
    let mut warnings = run.warnings.clone();
    let more = other.into_iter().flat_map(|other| &other.run.warnings);
    warnings.extend(more.filter(|text| !run.warnings.contains(text)).cloned());
    Document {
        title: run.scenario.title.clone(),
        verdict: Verdict {
            headline: headline(run, summary),
            dots: variants::words::dots(&summary.spreads()),
            advice: summary.remedy.as_ref().map(Remedy::sentence).unwrap_or_default(),
            command: command(summary.remedy.as_ref()),
            shown: words::shown_run(summary),
            fine: fine(run, summary),
            sentences: words::details(run, summary, summary.verification.as_ref()),
            tone: tone(run, summary),
        },
        blocks: sections::all(run, summary, (variants, other), &scene),
        provenance: provenance(run, summary),
        words: WORDS.to_vec(),
        warnings,
        ..Document::default()
    }
}

/// Returns the kind of verdict, such as [`Tone::Stands`].
pub(crate) fn tone(run: &Run, summary: &Summary) -> Tone {
    let spreads = summary.spreads();
    if !spreads.is_empty() {
        return variants::words::tone(&spreads);
    }
    match run.outcome {
        Outcome::Stable => Tone::Stands,
        Outcome::Collapse { .. } => Tone::Falls,
        Outcome::NotJudged | Outcome::Interrupted => Tone::Neutral,
        Outcome::Invalid { .. } => Tone::Invalid,
    }
}
