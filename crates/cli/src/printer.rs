//! Everything that is printed: results to standard output, errors to standard error.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "this is where printing is done")]

use std::io::Write as _;

use barrelstack::{Run, Summary};

/// A line of a result.
pub(crate) fn line(text: &str) {
    this_text(text, true);
}

/// A text as it is.
pub(crate) fn text(text: &str) {
    this_text(text, false);
}

fn this_text(text: &str, newline: bool) {
    let mut out = std::io::stdout().lock();
    let end = if newline { "\n" } else { "" };
    // A reader that has gone away (`| head`) wants no more, and no message either.
    let _ = write!(out, "{text}{end}");
}

/// An error, with its causes, as one paragraph.
pub(crate) fn error(error: &anyhow::Error) {
    eprintln!("error: {error:#}");
}

/// What the reader of a result must know.
pub(crate) fn warning(text: &str) {
    eprintln!("warning: {text}");
}

/// The summary for people.
pub(crate) fn summary(run: &Run, summary: &Summary) {
    line(&summary.title);
    for sentence in barrelstack::report::sentences(run, summary) {
        line(&format!("  {sentence}"));
    }
    line("");
    for row in crate::pages::rows(run, summary) {
        line(&row);
    }
    for warning in &summary.warnings {
        self::warning(warning);
    }
}
