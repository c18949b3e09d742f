//! `barrelstack protect`: ranks protections of a stack by benefit and cost, on one page.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use barrelstack::scenario::{Dimension, quantity::Quantity};
use barrelstack_campaign::decision::SiteHazard;
use barrelstack_campaign::protect::{
    ProtectError, Ranking, Reached, Request, Shaking, VELOCITIES, protect,
};
use barrelstack_report::significant;

use super::page::{PageArgs, of_option};
use crate::args::ScenarioArgs;
use crate::number::{real, whole};
use crate::printer;
use crate::progress::Progress;

/// Arguments of `protect`.
#[derive(Debug, clap::Args)]
pub(crate) struct ProtectArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Hazard curve of the site: a CSV file with `pgv (cm/s)` and `rate (1/year)`.
    #[arg(long, value_name = "FILE", conflicts_with = "pgv")]
    site: Option<PathBuf>,
    /// Peak ground velocity to which motions are scaled, such as "50 cm/s"; may be repeated.
    #[arg(long, value_name = "VELOCITY")]
    pgv: Vec<String>,
    /// Folder of recorded motions. All of them are used, in place of the bundled record and synthetic motions.
    #[arg(long, value_name = "DIR")]
    motions: Option<PathBuf>,
    /// Maximum cost of the protection of one stack (US$).
    #[arg(
        long, value_name = "NUMBER", allow_negative_numbers = true,
        value_parser = real("an amount in US$ of 0 or more, such as 500", |number| number >= 0.0)
    )]
    budget: Option<f64>,
    /// Number of motions per round, if no folder of motions is given.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 12, allow_negative_numbers = true,
        value_parser = whole(4_u32..=1000)
    )]
    count: u32,
    /// Number of rounds. The first round evaluates all protections; each further round evaluates the better half of the
    /// protections of the round before.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 3, allow_negative_numbers = true,
        value_parser = whole(1_u32..=12)
    )]
    rounds: u32,
    /// Seed of the random motions and of the random friction, stiffness and damping of the seats.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 1, allow_negative_numbers = true,
        value_parser = whole(0..=u32::MAX)
    )]
    seed: u32,
    /// Folder for the page and its studies; to continue after a stop, run the command again.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-protect")]
    out: PathBuf,
    #[command(flatten)]
    page: PageArgs,
}

/// Evaluates all protections, writes the page, and prints the table.
pub(crate) fn run(args: &ProtectArgs) -> anyhow::Result<ExitCode> {
    let request = request(args)?;
    let (options, progress) = args.page.begin(&args.out)?;
    let result = protect(&request, &args.out, &options, &|Reached { round, done, of }| {
        progress.counted_of_part(done, of, &format!("runs of round {round}"))
    });
    drop(progress);
    let mut found = match result {
        Err(ProtectError::Study(error)) => return Err(of_option(error, &motions(args), &args.out)),
        Err(ProtectError::Stack(failure)) => {
            return Err(super::placed(failure, &request.scenario, &args.scenario));
        }
        other => other?,
    };
    // The ranking is finished, and is kept if the two following runs are stopped.
    before_and_after(args, &mut found)?;
    crate::interrupt::finished();
    let file = (args.out.as_path(), "protect.json");
    args.page.end(
        file,
        &found.document,
        &found.to_document(),
        lines(&found),
        &found.document.warnings,
    )
}

/// Returns the options that name recorded motions, with their values, as on a command line.
fn motions(args: &ProtectArgs) -> String {
    let record = args.scenario.record.iter().map(|file| format!("--record {}", file.display()));
    let folder = args.motions.iter().map(|folder| format!("--motions {}", folder.display()));
    record.chain(folder).collect::<Vec<_>>().join(" ")
}

fn request(args: &ProtectArgs) -> anyhow::Result<Request> {
    let scenario = super::load(&args.scenario)?;
    let shaking = match &args.site {
        Some(file) => Shaking::Site(SiteHazard::load(file)?),
        None if args.pgv.is_empty() => Shaking::Levels(VELOCITIES.to_vec()),
        None => Shaking::Levels(velocities(&args.pgv)?),
    };
    if let Some(folder) = args.motions.as_ref().filter(|folder| !folder.is_dir()) {
        bail!(
            "--motions {}: there is no such folder; give a folder with record files, or leave the option out",
            folder.display()
        );
    }
    Ok(Request {
        scenario,
        shaking,
        records: args.scenario.record.iter().cloned().collect(),
        folder: args.motions.clone(),
        motions: args.count,
        rounds: args.rounds,
        budget: args.budget,
        seed: args.seed,
    })
}

/// Parses velocities (m/s), sorted and without duplicates.
fn velocities(typed: &[String]) -> anyhow::Result<Vec<f64>> {
    let read = |text: &String| {
        let said =
            || format!("--pgv {text:?}: expected a velocity above zero, such as \"50 cm/s\"");
        let value = Quantity::parse_as(text, &[Dimension::VELOCITY]).with_context(said)?.value;
        anyhow::ensure!(value > 0.0 && value.is_finite(), said());
        Ok(value)
    };
    let mut all: Vec<f64> = typed.iter().map(read).collect::<anyhow::Result<_>>()?;
    all.sort_by(f64::total_cmp);
    all.dedup();
    Ok(all)
}

/// Adds a comparison of the stack without and with the best protection, under the motion of the
/// scenario.
fn before_and_after(args: &ProtectArgs, found: &mut Ranking) -> anyhow::Result<()> {
    let progress = Progress::new(!args.page.quiet);
    let shown = found.show_before_and_after(&mut |reached| progress.advance(reached));
    drop(progress);
    match shown {
        Ok(_) => Ok(()),
        Err(ProtectError::Stack(failure)) => {
            Err(super::placed(failure, &found.request.scenario, &args.scenario))
        }
        Err(error) => Err(error.into()),
    }
}

/// Formats the table as lines of text.
fn lines(found: &Ranking) -> Vec<String> {
    let mut lines = printer::verdict(&found.document.verdict);
    lines.push(String::new());
    lines.push(format!(
        "  {:44}{:>12}{:>14}{:>18}",
        "protection", "US$ a stack", "collapse", "barrels fallen"
    ));
    for one in &found.all {
        let sign = if one.on_front { "*" } else { " " };
        lines.push(format!(
            "{sign} {:44}{:>12.0}{:>14}{:>18}",
            one.protection.name,
            one.cost(),
            significant(one.collapse.mean, 2),
            significant(one.fallen.mean, 2)
        ));
    }
    lines.push(
        "* no other protection that was tried has smaller losses at the same or a lower cost"
            .to_owned(),
    );
    lines
}
