//! Output files of a run, in one folder.

mod dictionary;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

pub use dictionary::dictionary;

use barrelstack_report::column::column_name;
use barrelstack_report::{
    Document, Language, Paper, Trial, base64, csv_field, document_pdf, html_with, shortest,
};
use serde_json::{Value, json};

use crate::ground::RECORD_LIMIT;
use crate::outcome::Outcome;
use crate::report;
use crate::run::Run;
use crate::scenario::{FileRef, MotionSource, RecordSource, Scenario, Vertical, View};
use crate::variants::{Answer, Shown};
use barrelstack_input::system;

/// Names of the files that a run writes once, even if it has two planes.
const FILES: [&str; 5] =
    ["summary.json", "scenario.toml", "variants.csv", "report.html", "columns.csv"];
const FILES_OF_PLANE: [&str; 5] =
    ["histories.csv", "histories.npz", "forces.csv", "envelopes.csv", "frames.csv"];

/// Maximum size (bytes) of a summary that is read.
const SUMMARY_LIMIT: usize = 256 << 20;

/// Maximum delay between the last modification of the summary of a run and that of any other file of this run. A file
/// that was modified later counts as changed after the run.
const AT_ONCE: Duration = Duration::from_secs(10);

/// Error while writing output files.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The folder is not empty.
    #[error("{folder} is not empty (it contains {file})", folder = folder.display())]
    Occupied {
        /// The folder.
        folder: PathBuf,
        /// Name of a file in the folder.
        file: String,
    },
    /// A file to be replaced was not written by an earlier run, or has been changed since.
    #[error(
        "{file} in {folder} was not written by an earlier run, or has been changed since",
        folder = folder.display()
    )]
    Foreign {
        /// The folder.
        folder: PathBuf,
        /// Name of the file.
        file: String,
    },
    /// A system call failed.
    #[error("cannot write {path}: {reason}", path = path.display())]
    Write {
        /// Path that cannot be written.
        path: PathBuf,
        /// Error message from the operating system.
        reason: String,
    },
}

impl ExportError {
    /// Returns the error for a path that cannot be written, with the reason.
    pub(crate) fn write(path: &Path, reason: impl Into<String>) -> Self {
        Self::Write { path: path.to_owned(), reason: reason.into() }
    }

    /// Returns the error for a path at which a system call failed.
    pub(crate) fn refused(path: &Path, error: &std::io::Error) -> Self {
        Self::write(path, system::words(error))
    }
}

/// A folder that is ready for the files of a run.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    /// `true` if the folder existed when it was checked.
    existed: bool,
    /// `true` if existing files must not be replaced.
    fresh: bool,
    /// `true` once this run has begun to write into the folder.
    claimed: Arc<AtomicBool>,
}

impl Folder {
    /// Checks a folder before the computation starts; creates nothing yet.
    ///
    /// # Errors
    /// When the folder is not empty and `overwrite` is not set, when the path is not a folder, or when the folder or
    /// one of its files cannot be written.
    pub fn prepare(path: &Path, overwrite: bool) -> Result<Self, ExportError> {
        if path.as_os_str().is_empty() {
            return Err(ExportError::write(path, "the name is empty"));
        }
        // The nearest existing ancestor must be a folder.
        let there = path.ancestors().find(|folder| folder.exists());
        if let Some(file) = there.filter(|there| !there.is_dir()) {
            let reason = format!("{} is a file, not a folder", file.display());
            return Err(ExportError::write(path, reason));
        }
        if let (false, Some(file)) = (overwrite, first_in(path)) {
            return Err(ExportError::Occupied { folder: path.to_owned(), file });
        }
        // A file that cannot be replaced is reported before the computation starts.
        for name in FILES {
            let file = path.join(name);
            system::replaceable(&file).map_err(|error| ExportError::refused(&file, &error))?;
        }
        system::writable(path).map_err(|reason| ExportError::write(path, reason))?;
        let claimed = Arc::new(AtomicBool::new(false));
        Ok(Self { path: path.to_owned(), existed: path.exists(), fresh: !overwrite, claimed })
    }

    /// Creates the folder if it is missing, and returns `true` if it was missing.
    ///
    /// Refuses a folder that another run has created or filled since the check.
    fn claim(&self) -> Result<bool, ExportError> {
        let refused = |error: std::io::Error| ExportError::refused(&self.path, &error);
        if let Some(above) = self.path.parent() {
            std::fs::create_dir_all(above).map_err(refused)?;
        }
        let first = self.fresh && !self.claimed.swap(true, Ordering::Relaxed);
        // If several processes create the folder, only one succeeds.
        match std::fs::create_dir(&self.path) {
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {
                let theirs = first_in(&self.path);
                let theirs =
                    theirs.or((!self.existed).then(|| "the files of another run".to_owned()));
                match theirs.filter(|_| first) {
                    Some(file) => Err(ExportError::Occupied { folder: self.path.clone(), file }),
                    None => Ok(false),
                }
            }
            made => made.map(|()| true).map_err(refused),
        }
    }

    /// Checks a folder like [`Folder::prepare`], but allows files of an earlier run (and no other
    /// files) to be replaced.
    ///
    /// # Errors
    /// When a file that would be replaced was not written by a run, or has been changed since.
    pub fn prepare_again(path: &Path) -> Result<Self, ExportError> {
        let folder = Self::prepare(path, true)?;
        let changed =
            |name: &str| std::fs::metadata(path.join(name)).and_then(|m| m.modified()).ok();
        let summary = system::read_result(&path.join(FILES[0]), SUMMARY_LIMIT).unwrap_or_default();
        let summary: Value = serde_json::from_slice(&summary).unwrap_or_default();
        let written =
            changed(FILES[0]).filter(|_| summary["provenance"]["program"] == "barrelstack");
        let foreign = |name: &String| {
            let Some(at) = changed(name) else { return false };
            written
                .is_none_or(|written| at.duration_since(written).is_ok_and(|late| late > AT_ONCE))
        };
        let planes = std::iter::once(String::new())
            .chain(View::ALL.into_iter().map(|view| format!("{}-", view.name())));
        let of_planes =
            planes.flat_map(|plane| FILES_OF_PLANE.map(|name| format!("{plane}{name}")));
        match FILES.into_iter().map(String::from).chain(of_planes).find(foreign) {
            Some(file) => Err(ExportError::Foreign { folder: path.to_owned(), file }),
            None => Ok(folder),
        }
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the path of the report.
    pub fn report(&self) -> PathBuf {
        self.path.join("report.html")
    }

    /// Writes all [`files`].
    ///
    /// The files are first written under temporary names and then renamed together. No file is
    /// therefore ever incomplete, and if the disk is full, the files of an earlier run remain
    /// unchanged.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, answer: &Answer, language: Language) -> Result<(), ExportError> {
        self.write_files(&files(answer, language)?)
    }

    /// Writes files, each given with its name; otherwise works like [`Folder::write`].
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_files(&self, files: &[(String, Vec<u8>)]) -> Result<(), ExportError> {
        self.put(&files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())))
    }

    /// Writes a page as `report.html` and as `report.md`, with the figures and tables of
    /// `report.md` in `figures/`.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_page(&self, document: &Document) -> Result<(), ExportError> {
        const FIGURES: &str = "figures";
        let page = barrelstack_report::html(document);
        let bundle = barrelstack_report::markdown(document, FIGURES);
        let names: Vec<String> =
            bundle.files.iter().map(|file| format!("{FIGURES}/{}", file.name)).collect();
        let figures = names.iter().map(String::as_str);
        let figures = figures.zip(bundle.files.iter().map(|file| file.bytes.as_slice()));
        let texts = [("report.html", page.as_bytes()), ("report.md", bundle.text.as_bytes())];
        self.put(&figures.chain(texts))
    }

    /// Writes files under temporary names, then renames them together.
    ///
    /// # Errors
    /// When a file cannot be written, when one of the files was read as an input, or when another run has
    /// written into the folder since the check.
    pub fn put<'a>(
        &self,
        files: &(impl Iterator<Item = (&'a str, &'a [u8])> + Clone),
    ) -> Result<(), ExportError> {
        let new = self.claim()?;
        let below = || files.clone().filter_map(|(name, _)| Path::new(name).parent());
        let written = below()
            .try_for_each(|part| system::folder_below(&self.path, part).map(drop))
            .map_err(|error| (self.path.clone(), error))
            .and_then(|()| {
                let paths = files.clone().map(|(name, bytes)| (self.path.join(name), bytes));
                system::store_all(&paths)
            });
        if new && written.is_err() {
            for part in below().chain([Path::new("")]) {
                // A folder that holds any file is not removed.
                let _ = std::fs::remove_dir(self.path.join(part));
            }
        }
        written.map_err(|(path, error)| ExportError::refused(&path, &error))
    }

    /// Rewrites `report.html`, and embeds a page in it with which a reader can change the scenario and run it.
    ///
    /// `page` is the HTML of the embedded page, which contains the simulation program. The page opens with `scenario`.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_with_engine(
        &self,
        document: &Document,
        scenario: &Scenario,
        page: &str,
    ) -> Result<(), ExportError> {
        let start = start_of(scenario);
        let trial = Trial { page, start: &start.to_string() };
        let bytes = html_with(document, &trial).into_bytes();
        self.put(&std::iter::once(("report.html", bytes.as_slice())))
    }

    /// Writes a report for printing, `report.pdf`, into the folder.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_pdf(&self, document: &Document, paper: Paper) -> Result<(), ExportError> {
        let bytes = document_pdf(document, paper);
        self.put(&std::iter::once(("report.pdf", bytes.as_slice())))
    }
}

/// Returns the alphabetically first file in a folder.
fn first_in(folder: &Path) -> Option<String> {
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten();
    names.map(|entry| entry.file_name().to_string_lossy().into_owned()).min()
}

/// Returns the output files of an answer as pairs of name and content. The report is in `language`.
///
/// If there are two planes, each plane has its own histories, forces, envelopes and frames, in files whose names begin
/// with the name of the plane.
///
/// # Errors
/// When the archive of histories cannot be written.
pub fn files(answer: &Answer, language: Language) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    let Shown { run, summary, .. } = &answer.decides;
    let document = report::answer_document(answer).in_language(language);
    let mut files = vec![
        ("summary.json".to_owned(), (summary.to_json() + "\n").into_bytes()),
        ("scenario.toml".to_owned(), answer.scenario.to_resolved_toml().into_bytes()),
        ("variants.csv".to_owned(), variants_csv(answer).into_bytes()),
    ];
    let both = answer.other.is_some();
    for run in std::iter::once(run).chain(answer.other.as_ref().map(|other| &other.run)) {
        // If the run has two planes, each plane has its own files.
        let view = run.assembly.view.filter(|_| both);
        let plane = view.map_or_else(String::new, |view| format!("{}-", view.name()));
        let npz = format!("{plane}histories.npz");
        let refused = |error| ExportError::refused(Path::new(&npz), &error);
        let histories = histories_npz(run).map_err(refused)?;
        files.extend([
            (format!("{plane}histories.csv"), histories_csv(run).into_bytes()),
            (npz, histories),
            (format!("{plane}forces.csv"), forces_csv(run).into_bytes()),
            (format!("{plane}envelopes.csv"), envelopes_csv(run).into_bytes()),
            (format!("{plane}frames.csv"), frames_csv(run).into_bytes()),
        ]);
    }
    files.push(("report.html".to_owned(), barrelstack_report::html(&document).into_bytes()));
    files.push(dictionary(&files, &|_| None));
    Ok(files)
}

/// Returns the data with which the page embedded in a report opens: the scenario as text, and its records in base64.
/// Records are named by their file names without folders, so that the page does not depend on paths.
fn start_of(scenario: &Scenario) -> Value {
    let mut packed = scenario.clone();
    let mut records = Vec::new();
    if let MotionSource::Record(motion) = &mut packed.motion.source {
        let mut hold = |file: &mut FileRef| {
            let Ok(bytes) = file.read(RECORD_LIMIT) else { return };
            let name =
                Path::new(&file.path).file_name().map(|name| name.to_string_lossy().into_owned());
            *file = FileRef::new(name.unwrap_or_default(), PathBuf::new());
            records.push(json!({ "path": file.path, "base64": base64(&bytes) }));
        };
        if let RecordSource::File(file) = &mut motion.source {
            hold(file);
        }
        if let Vertical::File(file) = &mut motion.vertical {
            hold(file);
        }
    }
    json!({ "name": "scenario.toml", "text": packed.to_resolved_toml(), "records": records })
}

/// Returns an NPZ archive of the times (as `time`), all channels and the contact forces. The arrays are named like the
/// columns of the CSV files, without units.
fn histories_npz(run: &Run) -> std::io::Result<Vec<u8>> {
    let recording = &run.recording;
    let mut arrays = vec![("time".to_owned(), recording.times.as_slice())];
    for channel in &recording.channels {
        arrays.push((channel.name.clone(), channel.values.as_slice()));
    }
    for joint in &recording.joints {
        let [vertical, horizontal] = force_names(&joint.name);
        arrays.push((vertical, &joint.vertical));
        arrays.push((horizontal, &joint.horizontal));
    }
    barrelstack_motion::write::archive(&arrays)
}

/// Returns the column names of the vertical and the horizontal force of a contact such as "R1 on ground".
fn force_names(contact: &str) -> [String; 2] {
    ["vertical", "horizontal"].map(|axis| format!("{}_{axis}_force", column_name(contact)))
}

/// Writes a table whose first column is `time (s)`: the column names, then one row per time, with
/// empty cells for missing values.
fn csv<R: Iterator<Item = Option<f64>>>(
    times: &[f64],
    names: impl Iterator<Item = String>,
    row: impl Fn(usize) -> R,
) -> String {
    let mut text = String::from("time (s)");
    for name in names {
        let _ = write!(text, ",{}", csv_field(&name));
    }
    text.push('\n');
    for (at, time) in times.iter().enumerate() {
        text.push_str(&shortest(*time));
        for value in row(at) {
            let _ = write!(text, ",{}", value.map(shortest).unwrap_or_default());
        }
        text.push('\n');
    }
    text
}

/// Returns `variants.csv`: in each plane, one row for the nominal case and one for each variant, except interrupted
/// cases.
fn variants_csv(answer: &Answer) -> String {
    let mut text = String::from(
        "plane,variant,outcome,mode,first_body,first_loss (s),first_fall (s),barrels_fallen,barrels\n",
    );
    let planes = std::iter::once(&answer.decides).chain(&answer.other);
    for Shown { run, variants, stopped, .. } in planes {
        let view = run.assembly.view.map_or("", View::name);
        let results = variants.as_ref().map(|found| &found.results).or(stopped.as_ref());
        for (number, result) in results.into_iter().flatten().enumerate() {
            let (kind, collapse) = match &result.outcome {
                // Interrupted cases have no row.
                Ok(Outcome::Interrupted) => continue,
                Ok(Outcome::Collapse { mode, time, first, .. }) => {
                    ("collapse", format!("{},{},{time}", mode.name(), csv_field(first)))
                }
                Ok(outcome) => (outcome.kind(), ",,".to_owned()),
                Err(_) => ("error", ",,".to_owned()),
            };
            let first = result.first_fall.map_or_else(String::new, |time| time.to_string());
            let fallen = result.falls.iter().filter(|(_, at)| at.is_some()).count();
            let _ = writeln!(
                text,
                "{view},{number},{kind},{collapse},{first},{fallen},{}",
                result.barrels
            );
        }
    }
    text
}

fn histories_csv(run: &Run) -> String {
    let channels = || run.recording.channels.iter();
    let names = channels().map(|channel| format!("{} ({})", channel.name, channel.unit));
    let row = |at| channels().map(move |channel| channel.values.get(at).copied());
    csv(&run.recording.times, names, row)
}

fn forces_csv(run: &Run) -> String {
    let joints = || run.recording.joints.iter();
    let names =
        joints().flat_map(|joint| force_names(&joint.name).map(|name| format!("{name} (N)")));
    let row = |at: usize| {
        let of = move |values: &Vec<f64>| values.get(at).copied();
        joints().flat_map(move |joint| [&joint.vertical, &joint.horizontal].map(of))
    };
    csv(&run.recording.times, names, row)
}

fn envelopes_csv(run: &Run) -> String {
    let mut text = String::from(
        "body,x (m),z (m),coordinate (rad or m),length_of_boundary (m),stress_at_rest (N/m),\
         peak_stress_until_first_loss_of_seat (N/m),peak_stress_of_whole_run (N/m)\n",
    );
    for envelope in &run.stresses.envelopes {
        let name = csv_field(&run.assembly.parts[envelope.body].name);
        for (at, point) in envelope.points.iter().enumerate() {
            let values = [
                point.position.x,
                point.position.z,
                point.coordinate,
                envelope.lengths[at],
                envelope.at_rest[at],
                envelope.peak[at],
                envelope.peak_whole_run[at],
            ];
            let _ = writeln!(text, "{name},{}", values.map(shortest).join(","));
        }
    }
    text
}

fn frames_csv(run: &Run) -> String {
    let frames = &run.recording.frames;
    let count = frames.times.len().min(frames.poses.len());
    let names = run.assembly.parts.iter().flat_map(|part| {
        ["x (m)", "z (m)", "angle (rad)"].map(|what| format!("{}_{what}", column_name(&part.name)))
    });
    let row = |at: usize| frames.poses[at].iter().flatten().copied().map(Some);
    csv(&frames.times[..count], names, row)
}
