//! `barrelstack reproduce`: numbers and figures of the paper compared with those of the program.

use std::process::ExitCode;

use barrelstack::render::write_figures;
use barrelstack_report::{Paper, document_pdf};
use barrelstack_reproduction::{
    Comparison, ReproduceError, Reproduction, percent, reproduce as run_all,
};

use super::motion::table::Table;
use crate::args::ReproduceArgs;
use crate::interrupt::Stopped;
use crate::printer;
use crate::progress::Progress;
use crate::store::writable;

/// Runs every case, writes the page, prints the table.
pub(crate) fn reproduce(args: &ReproduceArgs) -> anyhow::Result<ExitCode> {
    writable(&args.out)?;
    let progress = Progress::new(true);
    let result = run_all(args.record.as_deref(), !args.no_studies, &|done, of| {
        progress.counted(done as u64, of as u64, "runs")
    });
    drop(progress);
    let found = match result {
        Err(ReproduceError::Stopped { done }) => {
            let lines = done.into_iter().map(|(case, became)| format!("{case}: {became}"));
            printer::lines(lines)?;
            return Err(Stopped.into());
        }
        other => other?,
    };
    crate::interrupt::finished();
    let written = write(args, &found);
    print(&found)?;
    written?;
    printer::lines(["", &format!("page: {}", args.out.join("index.html").display())])?;
    found.document.warnings.iter().for_each(|warning| printer::warning(warning));
    Ok(ExitCode::SUCCESS)
}

fn write(args: &ReproduceArgs, found: &Reproduction) -> anyhow::Result<()> {
    let out = &args.out;
    let table = barrelstack_reproduction::table(found);
    let document = args.language.page(&found.document);
    let paper = document_pdf(&document, Paper::A4);
    super::page::write(out, &document, &[("table.md", table.as_bytes()), ("index.pdf", &paper)])?;
    let formats = args.figures.formats();
    write_figures(&document, &out.join("figures"), &formats, args.figures.dpi)?;
    Ok(())
}

fn print(found: &Reproduction) -> anyhow::Result<()> {
    let cells = |row: &Comparison| {
        let difference = row.difference.map(percent);
        [
            row.quantity.clone(),
            row.published.clone(),
            row.ours.clone(),
            difference.unwrap_or_default(),
            row.agreement.words().to_owned(),
        ]
    };
    let mut table = Table::new(5, ["quantity", "published", "ours", "difference", "verdict"]);
    found.comparisons.iter().for_each(|row| table.row(cells(row)));
    let headline = found.document.verdict.headline.clone();
    printer::lines([headline, String::new()].into_iter().chain(table.lines()))
}
