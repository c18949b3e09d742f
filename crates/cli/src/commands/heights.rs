//! `barrelstack heights`: how high is safe, on one page.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context as _;
use barrelstack_campaign::heights::{
    HEIGHTS, Heights, HeightsError, Request, VELOCITIES, View, heights,
};
use barrelstack_campaign::study::{RunOptions, StudyError};

use crate::interrupt::{Stopped, keeps};
use crate::lanes::LanesArgs;
use crate::printer;
use crate::progress::Progress;
use crate::store::{store, writable};

/// Arguments of `heights`.
#[derive(Debug, clap::Args)]
pub(crate) struct HeightsArgs {
    /// Rack of the catalog.
    #[arg(long, value_name = "NAME", default_value = "two-barrel")]
    rack: String,
    /// Barrel of the catalog.
    #[arg(long, value_name = "NAME", default_value = "bordeaux-225")]
    barrel: String,
    /// File of a further motion, such as that of your own site; may be repeated.
    #[arg(long, value_name = "FILE")]
    record: Vec<PathBuf>,
    /// Synthetic motions beside the bundled record.
    #[arg(long, value_name = "NUMBER", default_value_t = 22, value_parser = clap::value_parser!(u32).range(0..=10_000))]
    synthetic: u32,
    /// Seed of motions and friction.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u32,
    /// Where to write the page and the studies behind it; run again to go on after a stop.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-heights")]
    out: PathBuf,
    #[command(flatten)]
    lanes: LanesArgs,
    /// Print one JSON document in place of the table.
    #[arg(long)]
    json: bool,
    /// Show no progress.
    #[arg(long, short)]
    quiet: bool,
}

/// Runs every height in both directions, writes the page, prints the table.
pub(crate) fn run(args: &HeightsArgs) -> anyhow::Result<ExitCode> {
    let request = Request {
        rack: args.rack.clone(),
        barrel: args.barrel.clone(),
        records: args.record.clone(),
        synthetic: args.synthetic,
        seed: args.seed,
    };
    writable(&args.out)?;
    keeps(format!(
        "what was run is kept in {}, the same command goes on from there",
        args.out.display()
    ));
    let progress = Progress::new(!args.quiet);
    let options = RunOptions { lanes: args.lanes.lanes, ..RunOptions::default() };
    let result =
        heights(&request, &args.out, &options, &|done, of| progress.counted(done, of, "runs"));
    drop(progress);
    let found = match result {
        Err(HeightsError::Study(StudyError::Stopped)) => {
            return Err(Stopped.into());
        }
        other => other?,
    };
    // The answer is printed even where it cannot be written.
    let written = write(&args.out, &found);
    if args.json {
        printer::document(&found.to_document())?;
    } else {
        print(&found)?;
        printer::lines(["", &format!("page: {}", args.out.join("index.html").display())])?;
    }
    found.warnings.iter().for_each(|warning| printer::warning(warning));
    written?;
    Ok(ExitCode::SUCCESS)
}

fn write(out: &Path, found: &Heights) -> anyhow::Result<()> {
    let json = serde_json::to_string_pretty(&found.to_document())? + "\n";
    page(out, &found.html(), &found.markdown("figures"))?;
    store(&out.join("heights.json"), json.as_bytes())
}

/// Writes a page as HTML and as Markdown with its figures beside it.
pub(crate) fn page(
    out: &Path,
    html: &str,
    markdown: &barrelstack_report::MarkdownBundle,
) -> anyhow::Result<()> {
    let figures = out.join("figures");
    std::fs::create_dir_all(&figures)
        .with_context(|| format!("cannot make {}", figures.display()))?;
    store(&out.join("index.html"), html.as_bytes())?;
    store(&out.join("index.md"), markdown.text.as_bytes())?;
    markdown.files.iter().try_for_each(|file| store(&figures.join(&file.name), &file.bytes))
}

fn print(found: &Heights) -> anyhow::Result<()> {
    let mut lines = vec![found.document.verdict.headline.clone(), String::new()];
    for view in View::ALL {
        lines.push(format!("  collapsed, shaken {}", view.words()));
        let heads = HEIGHTS.map(|levels| format!("{:>9}", format!("{levels} levels")));
        lines.push(format!("  {:>10}{}", "shaking", heads.concat()));
        for velocity in VELOCITIES {
            let cells = HEIGHTS.map(|levels| {
                let at = found.of(levels, view).and_then(|height| height.at(velocity));
                let share = at.map_or_else(String::new, |at| {
                    format!("{:.0} %", 100.0 * at.stripe.fraction())
                });
                format!("{share:>9}")
            });
            lines.push(format!(
                "  {:>10}{}",
                format!("{:.0} cm/s", 100.0 * velocity),
                cells.concat()
            ));
        }
        lines.push(String::new());
    }
    lines.pop();
    printer::lines(lines)
}
