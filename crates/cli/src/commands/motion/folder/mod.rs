//! Batch processing of folders: reads, processes and measures every record, and writes one row of a
//! table per record.

mod columns;
mod journal;
mod tree;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::bail;
use barrelstack::pool;
use barrelstack::scenario::{Dimension, fnv1a};
use barrelstack_campaign::study::StudyTable;
use barrelstack_motion::{Flatfile, Processing, Record, Stage, measure, record_sequence_number};
use barrelstack_report::csv_field;
use indicatif::ProgressBar;

use super::input::{self, Chain, Input};
use crate::interrupt::Interrupt;
use crate::printer;
use crate::progress::{Bar, Lines, Of, style};
use crate::store::store;
use crate::tables::TableArgs;
use columns::{RecordData, cells};
use journal::{Journal, JournalEntry};
pub(super) use tree::Source;

/// Default periods (s) of the spectra.
const PERIODS: [f64; 20] = [
    0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0,
    4.0, 5.0, 10.0,
];
/// Maximum number of refused files listed on the terminal; refused.csv lists all of them.
const NAMED: usize = 5;
/// File names of the tables that are written for a folder of records.
const TABLES: [&str; 2] = ["records.csv", "refused.csv"];

/// Options for folders.
#[derive(Debug, clap::Args)]
pub(super) struct FolderArgs {
    /// Flatfile (CSV) of NGA-West2, matched by the record sequence number in the file names, or of
    /// ESM, matched by event and station.
    #[arg(long, value_name = "FILE.csv")]
    pub(super) flatfile: Option<PathBuf>,
    /// Periods of the spectra in the table, separated by commas, in seconds or each with its own
    /// unit.
    #[arg(long = "table-periods", value_name = "LIST", value_delimiter = ',')]
    periods: Vec<String>,
    #[command(flatten)]
    pub(super) tables: TableArgs,
    /// Show no progress.
    #[arg(long, short)]
    quiet: bool,
}

impl FolderArgs {
    /// Returns the periods (s) of the spectra in the table, in ascending order.
    fn periods(&self) -> anyhow::Result<Vec<f64>> {
        if self.periods.is_empty() {
            return Ok(PERIODS.to_vec());
        }
        let one = |text: &String| input::number_or("--table-periods", text, Dimension::TIME);
        let mut periods = self.periods.iter().map(one).collect::<Result<Vec<f64>, _>>()?;
        if let Some(wrong) = periods.iter().find(|t| !(t.is_finite() && **t > 0.0)) {
            bail!("--table-periods: expected periods above 0 s, found {wrong}");
        }
        periods.sort_by(f64::total_cmp);
        periods.dedup();
        Ok(periods)
    }
}

/// A batch that processes all records in given folders.
pub(super) struct Batch<'a> {
    /// Files and folders to read, and the options for reading them.
    pub(super) input: &'a Input,
    /// Folder for all output.
    pub(super) out: &'a Path,
    /// Options that apply to folders of records: the flatfile and the periods.
    pub(super) folder: &'a FolderArgs,
    /// Settings that affect the rows, as text; an existing table is continued only if its settings are the same.
    pub(super) settings: String,
    /// Periods (s) of the spectra; `None` for the periods in `folder`.
    pub(super) periods: Option<Vec<f64>>,
    /// Extension of the output file of each record, or `None` if the batch writes no file per record. A record whose
    /// output file is missing is processed again.
    pub(super) ending: Option<String>,
    /// Further file formats of the tables.
    pub(super) tables: TableArgs,
}

impl<'a> Batch<'a> {
    /// Creates a batch that only measures records. The spectra have the periods that are stated in `folder`.
    pub(super) fn new(
        input: &'a Input,
        out: &'a Path,
        folder: &'a FolderArgs,
        settings: String,
    ) -> Self {
        Self { input, out, folder, settings, periods: None, ending: None, tables: folder.tables }
    }
}

/// A record to be measured, with the processing to apply before the measurement.
pub(super) struct Worked {
    /// The record, possibly processed.
    pub(super) record: Record,
    /// Further processing to apply before the record is measured.
    pub(super) before: Processing,
}

impl Worked {
    /// Wraps a record as read. Before the record is measured, it is processed like a record in a scenario by default
    /// ([`Chain::Default`]).
    pub(super) fn as_read(record: Record) -> Self {
        let before = Chain::Default.of(record.stage);
        Self { record, before }
    }

    /// Wraps a processed record, to be measured without further processing.
    pub(super) fn done(record: Record) -> Self {
        Self { record, before: Processing::none() }
    }
}

/// Results of a batch.
pub(super) struct Measurements {
    /// One row per record, sorted by name.
    pub(super) table: StudyTable,
    pub(super) refused: Vec<(String, String)>,
    before: usize,
    /// `true` if the batch was stopped before all records were processed.
    stopped: bool,
    out: PathBuf,
    tables: TableArgs,
}

/// Outcome of processing one record.
enum Done {
    /// The record is in the journal.
    Noted,
    /// Refused files, with reasons that may be temporary. The record is not in the journal, so the next run of the
    /// command processes it again.
    Unsure(Vec<(String, String)>),
    /// The command was stopped before this record was finished.
    Stopped,
}

/// Applies `work` to every record, on all cores, and writes the table.
///
/// The table is written to `records.csv` and `records.parquet`. The refused files are listed, with the reasons, in
/// `refused.csv`.
///
/// Each finished record is added to `rows.jsonl`, with the fingerprint of the contents of its files.
/// After an interruption, the same command continues the work. It processes records again if their
/// files have changed.
pub(super) fn run(
    batch: &Batch<'_>,
    work: &(dyn Fn(&Source, &Record) -> anyhow::Result<Worked> + Sync),
) -> anyhow::Result<Measurements> {
    let flatfile = batch.folder.flatfile.as_deref().map(flatfile).transpose()?;
    let periods = match &batch.periods {
        Some(periods) => periods.clone(),
        None => batch.folder.periods()?,
    };
    crate::store::folder(batch.out)?;
    let sources = tree::sources(&batch.input.files, batch.out)?;
    if sources.is_empty() {
        bail!("{}: there are no files", batch.input.files.join(", "));
    }
    let specs: Vec<_> = cells(None, &periods).into_iter().map(|(spec, _)| spec).collect();
    let fingerprint = flatfile.as_ref().map_or(0, |(_, hash)| *hash);
    let settings =
        format!("{}; {}; flatfile {fingerprint:016x}", batch.settings, batch.input.description());
    let journal = Journal::open(batch.out, &settings, &specs)?;
    let bar = Bar::new(!batch.folder.quiet, || {
        let template = "{spinner} {bar:30} {pos} of {len} records, {per_sec}, {eta} to go";
        ProgressBar::new(sources.len() as u64).with_style(style(template))
    });
    let lines = Lines::new(!batch.folder.quiet);
    crate::interrupt::keeps(format!(
        "finished records are in {}: the same command continues from there",
        batch.out.display()
    ));
    let interrupt = Interrupt::listen();
    let before = AtomicUsize::new(0);
    let one = |source: &Source| -> anyhow::Result<Done> {
        if interrupt.is_requested() {
            return Ok(Done::Stopped);
        }
        let hash = fingerprint_of(source);
        let made = |ending: &str| source.beside(batch.out, ending).exists();
        let known = journal.known(&source.record.name, hash);
        let whole = |measured: &bool| !measured || batch.ending.as_deref().is_none_or(made);
        if let Some(measured) = known.filter(whole) {
            before.fetch_add(usize::from(measured), Ordering::Relaxed);
            return Ok(Done::Noted);
        }
        let (entry, sure) = entry(batch.input, source, hash, &periods, flatfile.as_ref(), work);
        if !sure {
            return Ok(Done::Unsure(entry.refused));
        }
        journal.note(&entry)?;
        Ok(Done::Noted)
    };
    let done = pool::map(&sources, one, &|done| {
        if let Some(bar) = &bar.0 {
            bar.set_position(done as u64);
        }
        lines.at(done as f64, sources.len() as f64, Of::Many, || {
            format!("{done} of {} records", sources.len())
        });
    });
    drop(bar);
    let mut table = StudyTable::empty(&specs);
    let (mut refused, mut stopped) = (Vec::new(), false);
    for (done, source) in done.into_iter().zip(&sources) {
        match done? {
            Done::Stopped => stopped = true,
            Done::Unsure(reasons) => refused.extend(reasons),
            Done::Noted => {
                let entry = journal.entry(&source.record.name)?;
                if let Some(row) = entry.row {
                    table.push(row)?;
                }
                refused.extend(entry.refused);
            }
        }
    }
    let before = before.into_inner();
    let (out, tables) = (batch.out.to_owned(), batch.tables);
    let found = Measurements { table, refused, before, stopped, out, tables };
    found.write()?;
    Ok(found)
}

impl Measurements {
    fn write(&self) -> anyhow::Result<()> {
        store(&self.out.join("records.csv"), self.table.to_csv().as_bytes())?;
        store(&self.out.join("records.parquet"), &self.table.to_parquet()?)?;
        let mut text = "file,reason\n".to_owned();
        for (file, reason) in &self.refused {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{},{}", csv_field(file), csv_field(reason));
        }
        store(&self.out.join("refused.csv"), text.as_bytes())?;
        self.tables.write(&self.out, &TABLES)
    }

    /// Prints a summary and returns the exit status, which is 130 if the batch was stopped.
    pub(super) fn print_summary(&self) -> anyhow::Result<ExitCode> {
        let before = (self.before > 0).then(|| format!(" ({} of them earlier)", self.before));
        let mut lines = vec![format!(
            "{} measured{}, {} refused",
            printer::counted(self.table.rows() as u64, "record"),
            before.unwrap_or_default(),
            printer::counted(self.refused.len() as u64, "file")
        )];
        lines.extend(self.refused.iter().take(NAMED).map(|(_, reason)| format!("  {reason}")));
        if self.refused.len() > NAMED {
            lines.push(format!("  and {} more in refused.csv", self.refused.len() - NAMED));
        }
        let out = self.out.display();
        let book = if self.tables.xlsx { ", tables.xlsx" } else { "" };
        lines.push(format!(
            "written: {out}, with records.csv, records.parquet{book} and refused.csv"
        ));
        printer::lines(lines)?;
        if self.stopped {
            printer::note("stopped; the same command continues from here");
            return Ok(ExitCode::from(130));
        }
        if self.table.rows() == 0 {
            bail!("no record could be read; refused.csv lists the reasons");
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Returns a fingerprint of the contents of all files of a record. A file that cannot be read counts as a file with
/// the fingerprint zero.
fn fingerprint_of(source: &Source) -> u64 {
    let mut all = Vec::new();
    for path in source.paths() {
        let hash = input::bytes(&path).map_or(0, |bytes| fnv1a(&bytes));
        all.extend_from_slice(&hash.to_le_bytes());
    }
    fnv1a(&all)
}

/// Reads, processes and measures one record.
///
/// Files that cannot be read, and records that cannot be processed, are refused with the reason.
/// Returns the journal entry, and `true` if the entry is final. It is not final if `work` fails, because the cause may
/// be the disk; the next run of the command then processes the record again.
fn entry(
    input: &Input,
    source: &Source,
    hash: u64,
    periods: &[f64],
    flatfile: Option<&(Flatfile, u64)>,
    work: &(dyn Fn(&Source, &Record) -> anyhow::Result<Worked> + Sync),
) -> (JournalEntry, bool) {
    let mut entry =
        JournalEntry { record: source.record.name.clone(), hash, row: None, refused: Vec::new() };
    let mut records = Vec::new();
    for path in source.paths() {
        let file = path.display().to_string();
        match input.read_alone(&file) {
            Ok(record) => records.push(record),
            Err(error) => entry.refused.push((file, format!("{error:#}"))),
        }
    }
    if records.is_empty() {
        return (entry, true);
    }
    let whole =
        source.paths().iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ");
    // The reason, and whether it is final.
    let refused = |reason: String, sure: bool| (format!("{whole}: {reason}"), sure);
    let row = input
        .unite(&records)
        .map_err(|error| refused(format!("the files do not form one record: {error:#}"), true))
        .and_then(|record| work(source, &record).map_err(|e| refused(format!("{e:#}"), false)))
        .and_then(|worked| {
            let measured = measure(&worked.record, &worked.before, periods)
                .map_err(|error| refused(error.to_string(), true))?;
            let number = record_sequence_number(&source.record.files[0]);
            let flat = flatfile.and_then(|(flatfile, _)| {
                number.and_then(|n| flatfile.get(n)).or_else(|| flatfile.of_record(&worked.record))
            });
            let data = RecordData { source, worked: &worked, measured: &measured, number, flat };
            Ok(cells(Some(&data), periods).into_iter().map(|(_, value)| value).collect())
        });
    match row {
        Ok(row) => entry.row = Some(row),
        Err((reason, sure)) => {
            entry.refused.push((whole, reason));
            return (entry, sure);
        }
    }
    (entry, true)
}

fn flatfile(path: &Path) -> anyhow::Result<(Flatfile, u64)> {
    let bytes = input::bytes(path)?;
    let text = String::from_utf8_lossy(&bytes);
    Ok((Flatfile::parse(&path.display().to_string(), &text)?, fnv1a(&bytes)))
}

/// Returns the processing stage of a record, and a description of the processing that is applied before the record is
/// measured.
fn stage_of(worked: &Worked) -> (String, &'static str) {
    let processing = match (worked.record.stage, worked.before.is_none()) {
        (Stage::Raw, false) => "compact, for the measures",
        (Stage::Raw, true) => "none",
        (Stage::Corrected | Stage::Unknown, _) => "as it is",
    };
    (worked.record.stage.to_string(), processing)
}
