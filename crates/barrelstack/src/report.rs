//! The report of a run: which sections, in which order, with which words.

mod drawing;
mod inputs;
mod sections;
mod spectrum;
mod trust;
mod words;

use barrelstack_report::{Document, Tone, Verdict};

pub(crate) use drawing::ground_histories;
pub use drawing::scene;

use crate::outcome::Outcome;
use crate::run::Run;
use crate::summary::Summary;
use crate::verify::Verification;

pub(crate) use inputs::{readable, setting_row};
pub(crate) use sections::traces;
pub use sections::{standing_range, stress_figure};
pub(crate) use words::{headline, provenance};

/// What happened, in three plain sentences: the verdict, the why, and how far to trust it.
pub fn sentences(run: &Run, summary: &Summary) -> Vec<String> {
    let mut sentences = vec![headline(run, summary)];
    sentences.extend(words::details(run, summary, None));
    sentences
}

/// The whole report as a document, free of any output format.
pub fn document(run: &Run, summary: &Summary) -> Document {
    verified_document(run, summary, None)
}

/// As [`document`], with what repeats of the run say about it.
pub fn verified_document(
    run: &Run,
    summary: &Summary,
    verification: Option<&Verification>,
) -> Document {
    let scene = scene(run);
    Document {
        title: run.scenario.title.clone(),
        verdict: Verdict {
            headline: headline(run, summary),
            sentences: words::details(run, summary, verification),
            tone: tone(run),
        },
        blocks: sections::all(run, summary, verification, &scene),
        provenance: provenance(run, summary),
        warnings: run.warnings.clone(),
    }
}

/// The kind of verdict.
pub(crate) fn tone(run: &Run) -> Tone {
    match run.outcome {
        Outcome::Stable => Tone::Stands,
        Outcome::Collapse { .. } => Tone::Falls,
        Outcome::NotJudged => Tone::Neutral,
        Outcome::Invalid { .. } => Tone::Invalid,
    }
}
