//! `barrelstack score`: the RockScore of a rack or a device, on one sheet.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use barrelstack_campaign::score::{League, Protocol, ScoreError, Sheet, league, score};

use super::page::{self, PageArgs, of_option, write};
use crate::args::ScenarioArgs;
use crate::number::whole;
use crate::printer;

/// Arguments of `score`.
#[derive(Debug, clap::Args)]
pub(crate) struct ScoreArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Score every rack and device of the catalog, in stacks like that of the scenario, and write a table, also as CSV.
    #[arg(long, conflicts_with = "json")]
    catalog: bool,
    /// Use South Napa and one in NUMBER of the other motions, for a faster estimate; the sheet states this number.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 1, allow_negative_numbers = true,
        value_parser = whole(1_u32..=4)
    )]
    one_in: u32,
    /// Folder for the sheet and its studies; to continue after a stop, run the command again.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-score")]
    out: PathBuf,
    #[command(flatten)]
    tables: crate::tables::TableArgs,
    #[command(flatten)]
    page: PageArgs,
}

/// Runs the protocol, writes the sheet, and prints it.
pub(crate) fn run(args: &ScoreArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    if args.scenario.record.is_some() {
        bail!(
            "--record: a score uses only the motions of its protocol, which are the same for all racks; \
             leave --record out"
        );
    }
    if !args.catalog && args.tables.need(false).is_err() {
        bail!(
            "--xlsx and --decimal-comma apply to tables, which only --catalog writes; leave both options out"
        );
    }
    let (options, progress) = args.page.begin(&args.out)?;
    let protocol = Protocol::rockscore().thinned(args.one_in);
    let report = |done, of| progress.counted(done, of, "runs");
    let place = |error| match error {
        ScoreError::Study(error) => of_option(error, "", &args.out),
        ScoreError::Stack(failure) => super::placed(failure, &scenario, &args.scenario),
        other @ (ScoreError::NoStack(_)
        | ScoreError::State { .. }
        | ScoreError::Ground(_)
        | ScoreError::Decision(_)
        | ScoreError::Curve { .. }) => other.into(),
    };
    if args.catalog {
        let found = league(&scenario, &protocol, &args.out, &options, &report).map_err(place)?;
        drop(progress);
        let csv = found.to_csv();
        let files = args.tables.of(vec![("league.csv".to_owned(), csv.into_bytes())])?;
        let files: Vec<(&str, &[u8])> =
            files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())).collect();
        write(&args.out, &args.page.language.page(&found.document), &files)?;
        let mut lines = vec![found.document.verdict.headline.clone(), String::new()];
        lines.extend(table(&found));
        lines.extend(page::place(&args.out));
        printer::lines(lines)?;
        found.document.warnings.iter().for_each(|text| printer::warning(text));
        return Ok(ExitCode::SUCCESS);
    }
    let result = score(&scenario, &protocol, &args.out, &options, &report);
    drop(progress);
    let sheet = result.map_err(place)?;
    let file = (args.out.as_path(), "rockscore.json");
    args.page.end(
        file,
        &sheet.document,
        &sheet.to_document(),
        lines(&sheet),
        &sheet.document.warnings,
    )
}

/// Formats the league table as lines of text.
fn table(found: &League) -> Vec<String> {
    let mut lines =
        vec![format!("  {:60}{:>10}{:>16}", "rack or device", "RockScore", "95 % range")];
    for (contender, sheet) in &found.rows {
        let range =
            sheet.range().map_or_else(String::new, |[low, high]| format!("{low} to {high}"));
        lines.push(format!("  {:60}{:>10}{range:>16}", contender.name, sheet.score()));
    }
    for (contender, reason) in &found.not_scored {
        lines.push(format!("  {}: not scored, {reason}", contender.name));
    }
    lines.push(
        "95 % range: over the uncertain friction, stiffness and damping of the seats".to_owned(),
    );
    lines
}

/// Formats the verdict and the tables of the sheet as lines of text.
fn lines(sheet: &Sheet) -> Vec<String> {
    let mut lines = printer::verdict(&sheet.document.verdict);
    let velocities = &sheet.protocol.velocities;
    let cells = |of: &dyn Fn(f64) -> String| {
        let cells: Vec<String> = velocities.iter().map(|at| format!("{:>7}", of(*at))).collect();
        cells.concat()
    };
    lines.push(String::new());
    let heads = cells(&|velocity| format!("{:.0}", 100.0 * velocity));
    lines.push(format!("  {:36}{:24}{heads}", "% collapsed at cm/s", "shaken"));
    for row in &sheet.rows {
        let share = |velocity| {
            let stripe = row.at(velocity);
            stripe.map_or_else(String::new, |stripe| format!("{:.0}", 100.0 * stripe.fraction()))
        };
        lines.push(format!("  {:36}{:24}{}", row.state.name, row.direction.words(), cells(&share)));
    }
    lines
}
