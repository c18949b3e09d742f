//! Printing: results to standard output, errors and warnings to standard error.
#![expect(clippy::print_stderr, reason = "all printing is done here")]

use std::fmt::Write as _;
use std::io::{ErrorKind, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context as _, bail};
use barrelstack::scenario::ScenarioError;
use barrelstack::scenario::error::Place;
use barrelstack::summary::AnySummary;
use barrelstack::variants::Shown;
use barrelstack_report::{Characters, Verdict, described};
use barrelstack_space::AnyAnswer;

use serde::Serialize;

use crate::interrupt::{STATUS, Stopped};
use crate::process;
use crate::remedy::remedy;

/// Prints lines of a result.
pub(crate) fn lines<T: AsRef<str>>(lines: impl IntoIterator<Item = T>) -> anyhow::Result<()> {
    let mut whole = String::new();
    for line in lines {
        whole.push_str(line.as_ref());
        whole.push('\n');
    }
    text(&whole)
}

/// Prints text, in which only control characters are replaced.
///
/// A reader that has closed the pipe (`| head`) is not an error. Any other failure, such as a full
/// disk, is an error, because the result would be incomplete.
pub(crate) fn text(text: &str) -> anyhow::Result<()> {
    raw(&harmless(text))
}

/// Prints text as [`text`] does, but without replacing control characters.
fn raw(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    printed(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// Prints the help or the version of the program, in color if the terminal supports it.
pub(crate) fn help(help: &clap::Error) -> anyhow::Result<()> {
    printed(help.print().and_then(|()| std::io::stdout().flush()))
}

/// Returns an error if printing a result has failed, unless the reader has closed the pipe.
fn printed(result: std::io::Result<()>) -> anyhow::Result<()> {
    const WHERE: &str = "cannot write to standard output";
    match result {
        _ if process::output_was_closed() => {
            bail!(
                "{WHERE}, because it is closed; redirect it to a file (> result.txt) or to /dev/null"
            )
        }
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).context(WHERE),
        _ => Ok(()),
    }
}

/// Prints a JSON document.
pub(crate) fn document(document: &impl Serialize) -> anyhow::Result<()> {
    let text = described::to_json(document)? + "\n";
    PRINTED.store(true, Ordering::Relaxed);
    let mut whole = String::with_capacity(text.len());
    for c in text.chars() {
        // Escapes control characters that JSON leaves unchanged but a terminal interprets.
        if c.is_control() && c != '\n' {
            let _ = write!(whole, "\\u{:04x}", u32::from(c));
        } else {
            whole.push(c);
        }
    }
    raw(&whole)
}

/// `true` if a document has been printed; no second document is printed then.
static PRINTED: AtomicBool = AtomicBool::new(false);

/// Replaces control characters, which could disturb a terminal.
pub(crate) fn harmless(text: &str) -> String {
    let shown = |c: char| if c.is_control() && !matches!(c, '\n' | '\t') { '\u{fffd}' } else { c };
    text.chars().map(shown).collect()
}

/// Formats a count with its noun, such as "1 case" or "2 cases".
pub(crate) fn counted(count: u64, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// Prints an error with its causes as one paragraph; with `json`, also as a document.
pub(crate) fn error(error: &anyhow::Error, json: bool) {
    let (next, words) = (remedy(error), bounded(&format!("{error:#}")));
    match next {
        Some(next) => eprintln!("error: {}; {next}", harmless(&words)),
        None => eprintln!("error: {}", harmless(&words)),
    }
    let read = error.chain().find_map(|cause| cause.downcast_ref::<ScenarioError>());
    let place = error.downcast_ref::<Place>().or(read.map(ScenarioError::place));
    error_document(&ErrorDocument::of(&(&words, next, place, 2)), json);
}

/// Shortens text that is too long by omitting its middle.
fn bounded(text: &str) -> String {
    const LONGEST: usize = 2000;
    const KEPT: usize = 400;
    let length = text.chars().count();
    if length <= LONGEST {
        return text.to_owned();
    }
    let [first, last] = [0, length - KEPT].map(|skip| text.chars().skip(skip).take(KEPT));
    first.chain(" […] ".chars()).chain(last).collect()
}

/// Prints an error of the command-line parser.
pub(crate) fn usage(words: &str, json: bool) {
    let words = &bounded(words);
    eprint!("{}", harmless(words));
    let first = words.split("\n\n").next().unwrap_or(words).trim_start_matches("error: ");
    error_document(&ErrorDocument::of(&(first, None, None, 2)), json);
}

/// Prints that the program was stopped, and which results are kept.
pub(crate) fn stopped(json: bool) {
    let words = Stopped.to_string();
    note(&words);
    error_document(&ErrorDocument::of(&(&words, None, None, STATUS)), json);
}

/// Prints an error as a JSON document, if `json` is `true` and no document has been printed yet.
fn error_document(document: &ErrorDocument, json: bool) {
    if json && !PRINTED.load(Ordering::Relaxed) {
        // If standard output is closed, standard error has the message.
        drop(self::document(document));
    }
}

described! {
    /// Reason why a command has no result.
    pub(crate) struct ErrorDocument of error: &(&str, Option<&str>, Option<&Place>, u8) {
        /// Name and version of the format of this document.
        schema: &'static str ["error/1"] = "error/1",
        /// Error message, with the causes of the error.
        error: String = error.0.to_owned(),
        /// Command or option that may help; null if no single command or option does.
        next: Option<String> = error.1.map(str::to_owned),
        /// The file that contains the error; null if the error is not in a file.
        file: Option<String> = match error.2 {
            Some(Place::File { file, .. } | Place::Whole { file }) => Some(file.clone()),
            Some(Place::Override { .. } | Place::Unknown) | None => None,
        },
        /// The override that contains the error, as typed; null if the error is not in an override.
        change: Option<String> = if let Some(Place::Override { text }) = error.2 { Some(text.clone()) } else { None },
        /// Line of the error, counted from 1.
        line: Option<usize> = if let Some(Place::File { line, .. }) = error.2 { Some(*line) } else { None },
        /// Column of the error in characters, counted from 1.
        column: Option<usize> = if let Some(Place::File { column, .. }) = error.2 { Some(*column) } else { None },
        /// Exit status of the program.
        status: u32 = u32::from(error.3),
    }
}

/// Prints a note about the work, separate from the result.
pub(crate) fn note(text: &str) {
    eprintln!("{}", harmless(text));
}

/// Prints a warning about a result, in one sentence.
pub(crate) fn warning(text: &str) {
    eprintln!("warning: {}", harmless(text));
}

/// Prints all warnings about a result.
pub(crate) fn warnings(answer: &AnyAnswer) {
    answer.warnings().into_iter().for_each(warning);
}

/// Returns the lines of a verdict: its headline, then its sentences.
pub(crate) fn verdict(verdict: &Verdict) -> Vec<String> {
    let sentences = verdict.sentences.iter().map(|sentence| format!("  {sentence}"));
    std::iter::once(verdict.headline.clone()).chain(sentences).collect()
}

/// Returns a sentence with the command that compares the stack without and with the remedy (the smallest sufficient
/// change); `None` if there is no such command.
pub(crate) fn side_by_side(summary: &AnySummary) -> Option<String> {
    let command = summary.remedy()?.comparison.as_ref()?;
    Some(format!("To compare the stack with and without the change: {command}"))
}

/// Prints the answer as text; `changes` are the values changed on the command line.
pub(crate) fn answer(
    answer: &AnyAnswer,
    changes: &[String],
    characters: Characters,
) -> anyhow::Result<()> {
    let mut all = vec![answer.title().to_owned()];
    all.extend(answer.sentences().into_iter().map(|sentence| format!("  {sentence}")));
    if let AnyAnswer::Planes(answer) = answer {
        let Shown { run, summary, .. } = &answer.decides;
        let fine = barrelstack::report::fine(run, summary);
        all.extend(fine.into_iter().map(|sentence| format!("  {sentence}")));
    }
    all.extend(side_by_side(&answer.summary()).map(|line| format!("  {line}")));
    let answer = match answer {
        AnyAnswer::Planes(answer) => answer,
        AnyAnswer::Space(answer) => {
            all.push(String::new());
            all.extend(aligned(&barrelstack_space::words::rows(&answer.run, &answer.summary)));
            return lines(all);
        }
    };
    for (changes, shown) in std::iter::once((changes, &answer.decides))
        .chain(answer.other.iter().map(|one| (&[][..], one)))
    {
        all.push(String::new());
        if let (Some(view), true) = (shown.run.assembly.view, answer.other.is_some()) {
            all.push(format!("  {}", view.words()));
        }
        all.extend(crate::rows::rows(&shown.run, &shown.summary, changes, characters));
        all.extend(crate::rows::picture(&shown.run, characters));
    }
    lines(all)
}

/// Prints the comparison of a run with its repeats.
pub(crate) fn verification(found: &barrelstack::verify::Verification) -> anyhow::Result<()> {
    let rows = found.rows();
    lines(["", "verification"].map(str::to_owned).into_iter().chain(aligned(&rows)))
}

/// Formats pairs of name and value as lines, with the values aligned in a column.
fn aligned(rows: &[(String, String)]) -> impl Iterator<Item = String> {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0) + 2;
    rows.iter().map(move |(name, value)| format!("  {name:width$}{value}"))
}
