//! The report of a run: which sections, in which order, with which words.

mod drawing;
mod sections;
mod spectrum;
mod words;

use barrelstack_report::{Document, Tone, Verdict};

pub(crate) use drawing::scene;

use crate::outcome::Outcome;
use crate::run::Run;
use crate::summary::Summary;

pub(crate) use sections::{standing_range, stress_figure};

/// What happened, in three plain sentences: the verdict, the why, and how far to trust it.
pub fn sentences(run: &Run, summary: &Summary) -> Vec<String> {
    let mut sentences = vec![words::headline(run, summary)];
    sentences.extend(words::details(run, summary));
    sentences
}

/// The whole report as a document, free of any output format.
pub fn document(run: &Run, summary: &Summary) -> Document {
    let tone = match run.outcome {
        Outcome::Stable => Tone::Stands,
        Outcome::Collapse { .. } => Tone::Falls,
        Outcome::NotJudged => Tone::Neutral,
        Outcome::Invalid { .. } => Tone::Invalid,
    };
    let scene = scene(run);
    Document {
        title: run.scenario.title.clone(),
        verdict: Verdict {
            headline: words::headline(run, summary),
            sentences: words::details(run, summary),
            tone,
        },
        blocks: sections::all(run, summary, &scene),
        provenance: words::provenance(run, summary),
        warnings: run.warnings.clone(),
    }
}
