//! Shared parts of the commands that present study results on a page.

use std::path::Path;
use std::process::ExitCode;

use barrelstack_campaign::study::{RunOptions, StudyError};
use barrelstack_report::{Document, described, html, markdown};
use serde::Serialize;

use crate::interrupt::{Stopped, keeps};
use crate::lanes::LanesArgs;
use crate::language::LanguageArgs;
use crate::printer;
use crate::progress::Progress;
use crate::store::{folder_below, store_all, writable};

/// Options of the commands that run studies and write a page.
#[derive(Debug, clap::Args)]
pub(super) struct PageArgs {
    #[command(flatten)]
    lanes: LanesArgs,
    #[command(flatten)]
    pub(super) language: LanguageArgs,
    /// Print one JSON document in place of the table.
    #[arg(long)]
    json: bool,
    /// Show no progress.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

impl PageArgs {
    /// Checks that the folder is writable, and sets the message that is printed if the program is stopped. Returns the
    /// options for the runs, and the progress display.
    pub(super) fn begin(&self, out: &Path) -> anyhow::Result<(RunOptions, Progress)> {
        writable(out)?;
        keeps(format!(
            "finished runs are kept in {}; the same command continues from there",
            out.display()
        ));
        let options = RunOptions { lanes: self.lanes.lanes, ..RunOptions::default() };
        Ok((options, Progress::new(!self.quiet)))
    }

    /// Writes the page and the JSON document, and prints the findings.
    pub(super) fn end(
        &self,
        (out, name): (&Path, &str),
        page: &Document,
        document: &impl Serialize,
        mut lines: Vec<String>,
        warnings: &[String],
    ) -> anyhow::Result<ExitCode> {
        // The answer is printed even if the files cannot be written.
        let written = write_both(out, name, &self.language.page(page), document);
        if self.json {
            printer::document(document)?;
        } else {
            lines.extend(place(out));
            printer::lines(lines)?;
        }
        for warning in warnings {
            printer::warning(warning);
        }
        written?;
        Ok(ExitCode::SUCCESS)
    }
}

/// Prefixes an error with the command-line option that caused the error. A position in a study file would not help,
/// because the command generates the studies.
pub(super) fn of_option(error: StudyError, motions: &str, out: &Path) -> anyhow::Error {
    let option = match error {
        StudyError::Stopped => return Stopped.into(),
        StudyError::Motion { .. } | StudyError::File(_) if !motions.is_empty() => {
            motions.to_owned()
        }
        StudyError::Folder { .. } => format!("--out {}", out.display()),
        StudyError::Motion { .. }
        | StudyError::File(_)
        | StudyError::System { .. }
        | StudyError::Shard { .. }
        | StudyError::BuiltIn(_)
        | StudyError::Table(_)
        | StudyError::Chunk(_) => return error.into(),
    };
    anyhow::Error::from(error).context(option)
}

/// Writes a page, and a JSON document under the given name.
pub(super) fn write_both(
    out: &Path,
    name: &str,
    page: &Document,
    document: &impl Serialize,
) -> anyhow::Result<()> {
    let json = described::to_json(document)? + "\n";
    write(out, page, &[(name, json.as_bytes())])
}

/// Writes a page as HTML and as Markdown with its figures, and further files; either all files are
/// written or none.
pub(super) fn write(out: &Path, page: &Document, further: &[(&str, &[u8])]) -> anyhow::Result<()> {
    let figures = folder_below(out, "figures")?;
    let (html, bundle) = (html(page), markdown(page, "figures"));
    let texts = [("index.html", html.as_bytes()), ("index.md", bundle.text.as_bytes())];
    let texts = texts.iter().chain(further).map(|(name, bytes)| (out.join(name), *bytes));
    let files = bundle.files.iter();
    let files = files.map(|file| (figures.join(&file.name), file.bytes.as_slice()));
    store_all(out, &texts.chain(files))
}

/// Returns an empty line and a line with the path of the page, to be printed below the findings.
pub(super) fn place(out: &Path) -> [String; 2] {
    [String::new(), format!("page: {}", out.join("index.html").display())]
}
