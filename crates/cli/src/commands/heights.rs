//! `barrelstack heights`: finds safe heights of stacks, and presents them on one page.

use std::path::PathBuf;
use std::process::ExitCode;

use barrelstack_campaign::heights::{
    HIGHEST, Heights, HeightsError, LOWEST, Request, VELOCITIES, heights,
};

use super::page::{PageArgs, of_option};
use crate::number::whole;

/// Arguments of `heights`.
#[derive(Debug, clap::Args)]
pub(crate) struct HeightsArgs {
    /// Name of the rack in the catalog.
    #[arg(long, value_name = "NAME", default_value = "two-barrel")]
    rack: String,
    /// Name of the barrel in the catalog.
    #[arg(long, value_name = "NAME", default_value = "bordeaux-225")]
    barrel: String,
    /// Number of levels of the highest stack.
    #[arg(
        long, visible_alias = "levels", value_name = "LEVELS", default_value_t = HIGHEST,
        allow_negative_numbers = true,
        value_parser = whole(LOWEST..=HIGHEST)
    )]
    highest: u32,
    /// Simulate the stacks in three dimensions, shaken in a random horizontal direction in every run, instead of in the
    /// two planes across and along the barrels.
    #[arg(long)]
    space: bool,
    /// File of an additional motion, such as a record from your own site; may be repeated.
    #[arg(long, value_name = "FILE")]
    record: Vec<PathBuf>,
    /// Number of synthetic motions in addition to the bundled record.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 22, allow_negative_numbers = true,
        value_parser = whole(0_u32..=10_000)
    )]
    synthetic: u32,
    /// Seed of the random motions and of the random friction, stiffness and damping of the seats.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 1, allow_negative_numbers = true,
        value_parser = whole(0..=u32::MAX)
    )]
    seed: u32,
    /// Folder for the page and its studies; to continue after a stop, run the command again.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-heights")]
    out: PathBuf,
    #[command(flatten)]
    page: PageArgs,
}

/// Runs every height in every direction, writes the page, and prints the table.
pub(crate) fn run(args: &HeightsArgs) -> anyhow::Result<ExitCode> {
    let request = Request {
        rack: args.rack.clone(),
        barrel: args.barrel.clone(),
        records: args.record.clone(),
        synthetic: args.synthetic,
        seed: args.seed,
        highest: args.highest,
        in_space: args.space,
    };
    let (options, progress) = args.page.begin(&args.out)?;
    let result =
        heights(&request, &args.out, &options, &|done, of| progress.counted(done, of, "runs"));
    drop(progress);
    let found = match result {
        Err(HeightsError::Study(error)) => {
            let records = if args.record.is_empty() { "" } else { "--record" };
            return Err(of_option(error, records, &args.out));
        }
        other => other?,
    };
    let file = (args.out.as_path(), "heights.json");
    args.page.end(file, &found.document, &found.to_document(), lines(&found), &found.warnings)
}

/// Formats the table as lines of text.
fn lines(found: &Heights) -> Vec<String> {
    let mut lines = vec![found.document.verdict.headline.clone(), String::new()];
    for direction in found.request.directions() {
        lines.push(format!("  collapsed, shaken {}", direction.words()));
        let heads =
            found.request.heights().map(|levels| format!("{:>18}", format!("{levels} levels")));
        lines.push(format!("  {:>10}{}", "shaking", heads.collect::<String>()));
        for velocity in VELOCITIES {
            let cells = found.request.heights().map(|levels| {
                let at = found.of(levels, direction).and_then(|height| height.at(velocity));
                let share = at.map_or_else(String::new, |at| {
                    let range = at
                        .range
                        .map(|[low, high]| format!(" ({:.0} to {:.0})", 100.0 * low, 100.0 * high));
                    format!("{:.0} %{}", 100.0 * at.stripe.fraction(), range.unwrap_or_default())
                });
                format!("{share:>18}")
            });
            lines.push(format!(
                "  {:>10}{}",
                format!("{:.0} cm/s", 100.0 * velocity),
                cells.collect::<String>()
            ));
        }
        lines.push(String::new());
    }
    lines.push(
        "in brackets: 95 % range over the uncertain friction, stiffness and damping of the seats"
            .to_owned(),
    );
    lines
}
