//! `barrelstack study report`: makes the page of a study from its table.

use std::path::{Path, PathBuf};

use barrelstack_campaign::decision::{Decision, Request, SiteHazard, decide_folder};

use crate::commands::page;
use crate::language::LanguageArgs;
use crate::number::whole;
use crate::printer;

/// Text at the end of the help.
const AFTER_HELP: &str = "\
A hazard curve is a table (CSV) of the intensity, with its unit, and the annual rate at which it is exceeded:

  pgv (cm/s),rate (1/year)
  5,0.1
  20,0.01
  60,0.001";

/// Arguments of `study report`.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(super) struct ReportArgs {
    /// A folder that `barrelstack study` wrote, finished or not.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Hazard curve of the site; the page then also has annual rates and expected losses.
    #[arg(long, value_name = "FILE")]
    hazard: Option<PathBuf>,
    /// Number of years for which probabilities are given.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 50, requires = "hazard", allow_negative_numbers = true,
        value_parser = whole(1_u32..=10_000)
    )]
    years: u32,
    /// Folder for the page, in place of the folder of the study.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    language: LanguageArgs,
    /// Print one JSON document in place of the summary.
    #[arg(long)]
    json: bool,
}

/// Reads the folder, writes the page, and prints a summary.
pub(super) fn report(args: &ReportArgs) -> anyhow::Result<()> {
    let hazard = args.hazard.as_deref().map(SiteHazard::load).transpose()?;
    let request = Request { hazard, years: Some(f64::from(args.years)) };
    let (decision, _) = decide_folder(&args.folder, &request)?;
    let out = args.out.as_deref().unwrap_or(&args.folder);
    write(out, &decision, args.language)?;
    if args.json {
        printer::document(&decision.to_document())?;
    } else {
        let verdict = printer::verdict(&decision.document.verdict);
        printer::lines(verdict.into_iter().chain(page::place(out)))?;
    }
    decision.warnings.iter().for_each(|warning| printer::warning(warning));
    Ok(())
}

/// Writes the page of a study after the study was run.
///
/// A study in which no case has a verdict has no page. This is not an error; the table of the study
/// states the reasons.
pub(super) fn write_page(out: &Path, language: LanguageArgs) -> anyhow::Result<Option<PathBuf>> {
    match decide_folder(out, &Request::default()) {
        Ok((decision, _)) => {
            write(out, &decision, language)?;
            Ok(Some(out.join("index.html")))
        }
        Err(error) => {
            printer::warning(&format!("no page: {error}"));
            Ok(None)
        }
    }
}

fn write(out: &Path, decision: &Decision, language: LanguageArgs) -> anyhow::Result<()> {
    let document = language.page(&decision.document);
    page::write_both(out, "decision.json", &document, &decision.to_document())
}
