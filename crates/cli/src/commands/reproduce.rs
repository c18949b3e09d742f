//! `barrelstack reproduce`: the paper's numbers and figures beside ours.

use std::path::Path;
use std::process::ExitCode;

use anyhow::Context;
use barrelstack::render::write_figures;
use barrelstack_report::{Paper, document_pdf};
use barrelstack_reproduction::{
    Comparison, ReproduceError, Reproduction, percent, reproduce as run_all,
};

use crate::args::ReproduceArgs;
use crate::interrupt::Stopped;
use crate::printer;
use crate::progress::Progress;
use crate::store::{store, writable};

/// Runs every case, writes the page, prints the table.
pub(crate) fn reproduce(args: &ReproduceArgs) -> anyhow::Result<ExitCode> {
    prepare(&args.out)?;
    let progress = Progress::new(true);
    let result = run_all(args.record.as_deref(), !args.no_studies, &|done, of| {
        progress.counted(done as u64, of as u64, "runs")
    });
    drop(progress);
    let found = match result {
        Err(ReproduceError::Stopped) => return Err(Stopped.into()),
        other => other?,
    };
    let written = write(args, &found);
    print(&found)?;
    written?;
    printer::lines(["", &format!("page: {}", args.out.join("index.html").display())])?;
    found.document.warnings.iter().for_each(|warning| printer::warning(warning));
    Ok(ExitCode::SUCCESS)
}

/// The folder must be there to be written to before the work is done.
fn prepare(out: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    writable(out)
}

fn write(args: &ReproduceArgs, found: &Reproduction) -> anyhow::Result<()> {
    let out = &args.out;
    let put = |name: &str, bytes: &[u8]| store(&out.join(name), bytes);
    put("index.html", barrelstack_report::html(&found.document).as_bytes())?;
    let bundle = barrelstack_report::markdown(&found.document, "figures");
    put("index.md", bundle.text.as_bytes())?;
    put("table.md", barrelstack_reproduction::table(found).as_bytes())?;
    prepare(&out.join("figures"))?;
    for file in &bundle.files {
        put(&format!("figures/{}", file.name), &file.bytes)?;
    }
    put("index.pdf", &document_pdf(&found.document, Paper::A4))?;
    let formats = args.figures.formats();
    write_figures(&found.document, &out.join("figures"), &formats, args.figures.dpi)?;
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
            row.verdict.words().to_owned(),
        ]
    };
    let head = ["quantity", "published", "ours", "difference", "verdict"].map(str::to_owned);
    let rows: Vec<[String; 5]> =
        std::iter::once(head).chain(found.comparisons.iter().map(cells)).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: [usize; 5] = std::array::from_fn(|column| width(column).unwrap_or(0));
    let lines = rows.iter().map(|row| {
        let padded = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}"));
        format!("  {}", padded.collect::<Vec<_>>().join("  ")).trim_end().to_owned()
    });
    let headline = found.document.verdict.headline.clone();
    printer::lines([headline, String::new()].into_iter().chain(lines))
}
