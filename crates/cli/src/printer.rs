//! Everything that is printed: results to standard output, errors and warnings to standard error.
#![expect(clippy::print_stderr, reason = "this is where printing is done")]

use std::io::{ErrorKind, Write as _};

use anyhow::Context as _;
use barrelstack::variants::{Answer, Shown};
use barrelstack_report::Characters;

use crate::remedy::remedy;

/// Lines of a result.
pub(crate) fn lines<T: AsRef<str>>(lines: impl IntoIterator<Item = T>) -> anyhow::Result<()> {
    let mut whole = String::new();
    for line in lines {
        whole.push_str(line.as_ref());
        whole.push('\n');
    }
    text(&whole)
}

/// A text as it is.
///
/// A reader that has gone away (`| head`) wants no more, and no message either.
/// Any other failure, such as a full disk, would leave half a result behind and is an error.
pub(crate) fn text(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(error).context("cannot write to standard output")
        }
        _ => Ok(()),
    }
}

/// A number of things, such as "1 case" and "2 cases".
pub(crate) fn counted(count: u64, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// An error, with its causes, as one paragraph.
pub(crate) fn error(error: &anyhow::Error) {
    match remedy(error) {
        Some(next) => eprintln!("error: {error:#}; {next}"),
        None => eprintln!("error: {error:#}"),
    }
}

/// What became of the work, beside a result.
pub(crate) fn note(text: &str) {
    eprintln!("{text}");
}

/// What the reader of a result should know, one sentence.
pub(crate) fn warning(text: &str) {
    eprintln!("warning: {text}");
}

/// What the reader of a result should know.
pub(crate) fn warnings(answer: &Answer) {
    let own = &answer.decides.summary.warnings;
    let other = answer.other.iter().flat_map(|other| &other.summary.warnings);
    let all = own.iter().chain(other.filter(|text| !own.contains(text)));
    all.for_each(|text| warning(text));
}

/// The answer for people; `changes` are the values changed on the command line.
pub(crate) fn answer(
    answer: &Answer,
    changes: &[String],
    characters: Characters,
) -> anyhow::Result<()> {
    let Shown { run, summary, .. } = &answer.decides;
    let mut all = vec![summary.title.clone()];
    let sentences = barrelstack::report::sentences(run, summary);
    all.extend(sentences.into_iter().map(|sentence| format!("  {sentence}")));
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

/// What repeats of a run say about it.
pub(crate) fn verification(found: &barrelstack::verify::Verification) -> anyhow::Result<()> {
    let rows = found.rows();
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0) + 2;
    let rows = rows.iter().map(|(name, value)| format!("  {name:width$}{value}"));
    lines(["", "verification"].map(str::to_owned).into_iter().chain(rows))
}
