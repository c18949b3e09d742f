//! `barrelstack motion select`: a set of records for a target spectrum, ready for a study.

mod limits;
mod page;
mod set;
mod target;

use std::path::PathBuf;
use std::process::ExitCode;

use barrelstack_campaign::study::StudyTable;
use barrelstack_motion::MotionError;
use barrelstack_selection::{Candidate, Choosing, Selection, SelectionTarget, select as choose};
use clap::ValueEnum;

use super::folder::{self, Batch, FolderArgs, Worked};
use super::input::Input;
use crate::language::LanguageArgs;
use crate::number::{real, whole};
use crate::printer;
use crate::tables::TableArgs;
use limits::{Limits, Range};

/// Text at the end of the help.
const AFTER_HELP: &str = "\
Targets:
  FILE.csv     a ground-motion model's table: \"period (s), median (g), sigma\", sigma of ln Sa;
               with --at and --level or --epsilon the spectrum conditional on one period
               (correlations of Baker and Jayaram 2008), otherwise the model's own spectrum
  asce7:…, ec8:…, …   a code spectrum, which every record should follow; see motion match --help
Example:
  barrelstack motion select records --flatfile NGA.csv --target model.csv --at 1.0 --epsilon 2 \\
    --count 30 --scale 0.25..4 --magnitude 6.. --out set
  barrelstack study set/study.toml --out runs";

/// Arguments of `select`.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(super) struct SelectArgs {
    #[command(flatten)]
    input: Input,
    /// Target of the spectra; the kinds of targets are listed below.
    #[arg(long, value_name = "TARGET")]
    target: String,
    /// Period at which Sa is given; it must be one of the periods in the table of the ground-motion model.
    #[arg(long, value_name = "TIME")]
    at: Option<String>,
    /// Sa at the period given with --at, such as "0.6 g".
    #[arg(long, value_name = "ACCELERATION", requires = "at", conflicts_with = "epsilon")]
    level: Option<String>,
    /// Sa at the period given with --at, as the number of standard deviations of ln Sa above the median.
    #[arg(
        long, value_name = "NUMBER", requires = "at", allow_hyphen_values = true,
        value_parser = real("a number of standard deviations, such as 1.5 or -0.5", |_| true)
    )]
    epsilon: Option<f64>,
    /// Shortest period to match.
    #[arg(long, value_name = "TIME", default_value = "0.05 s")]
    shortest: String,
    /// Longest period to match.
    #[arg(long, value_name = "TIME", default_value = "5 s")]
    longest: String,
    /// Number of records; by default 30, or fewer if fewer records can be scaled to the target.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = whole(1..=usize::MAX))]
    count: Option<usize>,
    /// Kind of spectrum that is compared with the target, for each record.
    #[arg(long, value_enum, default_value_t = Spectrum::Rotd50)]
    spectrum: Spectrum,
    /// Range of permitted scale factors.
    #[arg(long, value_name = "FROM..TO", default_value = "0.25..4")]
    scale: Range,
    #[command(flatten)]
    limits: Limits,
    /// Maximum number of records of one earthquake.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = whole(1..=usize::MAX))]
    most_of_event: Option<usize>,
    /// Seed of the random spectra that are drawn from the target.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 1, allow_negative_numbers = true,
        value_parser = whole(0..=u64::MAX)
    )]
    seed: u64,
    /// Scenario that the study of the selected set runs.
    #[arg(long, value_name = "SCENARIO", default_value = "candia-8-barrels")]
    base: String,
    /// Folder for the set, the study, the page and the table of all records.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    folder: FolderArgs,
}

/// Spectrum of a record that is compared with the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Spectrum {
    /// Median over all directions of the two horizontal components.
    Rotd50,
    /// Largest value over all directions of the two horizontal components.
    Rotd100,
    /// The first horizontal component.
    H1,
}

impl Spectrum {
    fn column(self, period: f64) -> String {
        match self {
            Self::Rotd50 => format!("sa_rotd50_{period}"),
            Self::Rotd100 => format!("sa_rotd100_{period}"),
            Self::H1 => format!("sa_h1_{period}"),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Rotd50 => "RotD50",
            Self::Rotd100 => "RotD100",
            Self::H1 => "first horizontal",
        }
    }
}

/// Measures the records, selects a set, and writes it.
pub(super) fn select(args: &SelectArgs) -> anyhow::Result<ExitCode> {
    let target = target::target(args)?;
    let periods = target.periods().to_vec();
    let batch = Batch::new(&args.input, &args.out, &args.folder, "select".to_owned());
    let batch = Batch { periods: Some(periods.clone()), tables: TableArgs::default(), ..batch };
    let found = folder::run(&batch, &|_, record| Ok(Worked::as_read(record.clone())))?;
    let status = found.print_summary()?;
    if status != ExitCode::SUCCESS {
        return Ok(status);
    }
    let (rows, left_out) = args.limits.rows(&found.table);
    let (rows, candidates) = candidates(args, &found.table, &rows, &periods);
    let mut statement =
        left_out.sentence(found.table.rows(), candidates.len(), args.spectrum.name());
    if !found.refused.is_empty() {
        let files = printer::counted(found.refused.len() as u64, "file");
        let unread = format!("; {files} could not be read, see refused.csv");
        statement.push_str(&unread);
    }
    let [least, largest] = args.scale.ends();
    let choosing = Choosing {
        count: args.count.unwrap_or(USUAL_COUNT),
        scale: [least.max(f64::MIN_POSITIVE), largest],
        most_of_group: args.most_of_event,
        seed: args.seed,
    };
    let selection = match args.count {
        Some(_) => choose(&target, &candidates, &choosing),
        None => as_many_as_there_are(&target, &candidates, &choosing),
    };
    let selection = selection.inspect_err(|_| printer::note(&statement))?;
    if args.count.is_none() && selection.chosen.len() < USUAL_COUNT {
        let few = format!(
            "; a set usually has {USUAL_COUNT} records, but this one has only the {} that can be \
             scaled to the target",
            selection.chosen.len()
        );
        statement.push_str(&few);
    }
    printer::lines([&statement])?;
    let set = set::Set { args, table: &found.table, rows: &rows, selection: &selection };
    set.write()?;
    page::write(&set, &target, &candidates, &statement)?;
    printer::lines(set.summary(&target))?;
    Ok(ExitCode::SUCCESS)
}

/// Default size of a set.
const USUAL_COUNT: usize = 30;

/// Selects the largest set of records, up to the default size, for which the selection succeeds.
///
/// If the selection fails for every size, returns the error of the first attempt.
fn as_many_as_there_are(
    target: &SelectionTarget,
    candidates: &[Candidate],
    choosing: &Choosing,
) -> Result<Selection, MotionError> {
    let most = candidates.len().clamp(2, choosing.count);
    let sized = |count| choose(target, candidates, &Choosing { count, ..choosing.clone() });
    let first = sized(most);
    let smaller = || (2..most).rev().find_map(|count| sized(count).ok());
    first.or_else(|error| smaller().ok_or(error))
}

/// Returns the rows with a complete spectrum as candidates, grouped by event.
fn candidates(
    args: &SelectArgs,
    table: &StudyTable,
    rows: &[usize],
    periods: &[f64],
) -> (Vec<usize>, Vec<Candidate>) {
    let columns: Vec<&[Option<f64>]> =
        periods.iter().filter_map(|period| table.numbers(&args.spectrum.column(*period))).collect();
    let events = table.texts("event").unwrap_or_default();
    let names = table.texts("record").unwrap_or_default();
    let mut kept = Vec::new();
    let mut candidates = Vec::new();
    for &row in rows {
        let spectrum: Option<Vec<f64>> =
            columns.iter().map(|column| column[row].filter(|sa| *sa > 0.0)).collect();
        let Some(spectrum) = spectrum else { continue };
        let group = events[row].clone().unwrap_or_else(|| format!("record {row}"));
        kept.push(row);
        let name = names[row].clone().unwrap_or_else(|| format!("row {}", row + 1));
        candidates.push(Candidate { name, spectrum, group });
    }
    (kept, candidates)
}
