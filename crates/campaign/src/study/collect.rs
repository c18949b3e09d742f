//! Reads the rows of a study from the shards in its folder.
//!
//! Rows are read in parts, so that memory does not grow with the number of cases.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use barrelstack_report::column::{csv_heading, csv_rows};

use super::draft::{Draft, write_whole};
use super::error::StudyError;
use super::folder::{Provenance, read_shard, shards, study_text};
use super::manifest::manifest_of;
use super::shard;
use super::stop::Tally;
use super::table::StudyTable;

/// Rows of a study with their provenance.
#[derive(Clone, Debug, PartialEq)]
pub struct Collected {
    /// Table with one row per finished case.
    pub table: StudyTable,
    /// Provenance of the study; its number of cases is the number of rows in `table`.
    pub provenance: Provenance,
}

/// Progress of a study in a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Provenance of the study in the folder.
    pub provenance: Provenance,
    /// Numbers of finished cases by outcome.
    pub tally: Tally,
    /// Indices of the chunks that still have to be run, in ascending order.
    pub missing: Vec<usize>,
}

/// Reader of the shards in a folder, in the order of their first cases.
///
/// In a Monte Carlo design, chunks are read in order up to the first unfinished chunk, or up to the chunk
/// with which the stopping rule is satisfied. The result therefore does not depend on which later chunks were
/// run.
struct Shards {
    provenance: Provenance,
    paths: BTreeMap<usize, PathBuf>,
    next: usize,
    tally: Tally,
}

impl Shards {
    fn open(folder: &Path) -> Result<Self, StudyError> {
        let provenance = manifest_of(folder)?;
        let paths = shards(folder)?.into_iter().collect();
        Ok(Self { provenance, paths, next: 0, tally: Tally::default() })
    }

    fn read(&mut self) -> Result<Option<StudyTable>, StudyError> {
        let ordered = self.provenance.design == "monte-carlo";
        while self.next < self.provenance.chunks && !self.provenance.complete {
            let path = self.paths.get(&self.next);
            self.next += 1;
            let Some(path) = path else {
                if ordered {
                    return Ok(None);
                }
                continue;
            };
            let (part, _) = read_shard(path, &self.provenance.columns)?;
            self.tally = self.tally.plus(Tally::of(&part));
            let made = &mut self.provenance;
            made.cases += part.rows();
            made.chunks_done += 1;
            made.complete = made.chunks_done == made.chunks
                || made.stop.is_some_and(|rule| rule.met(self.tally));
            return Ok(Some(part));
        }
        Ok(None)
    }
}

/// Reads the finished rows of a study, complete or not, and returns the provenance of the study.
///
/// `visit` receives all rows in the order of the cases, as tables of one or several chunks, with the
/// provenance of the rows read so far.
///
/// # Errors
/// If the folder is not the folder of a study, a shard is damaged, or `visit` fails.
pub fn read_shards<E: From<StudyError>>(
    folder: &Path,
    visit: &mut dyn FnMut(&Provenance, &StudyTable) -> Result<(), E>,
) -> Result<Provenance, E> {
    let mut parts = Shards::open(folder)?;
    let specs = parts.provenance.columns.clone();
    // Rows that are held back, since a later chunk may have cases that precede them.
    let mut open = StudyTable::empty(&specs);
    while let Some(part) = parts.read()? {
        // Chunks are ordered by their first cases, so no later row precedes the first row of this chunk.
        if let Some(Some(first)) = part.integers("case").and_then(|cases| cases.first()) {
            let later = open.split_off(open.rows_before(*first));
            let ready = std::mem::replace(&mut open, later);
            if ready.rows() > 0 {
                visit(&parts.provenance, &ready)?;
            }
        }
        open = if open.rows() == 0 { part } else { StudyTable::join(&specs, &[open, part])? };
    }
    if open.rows() > 0 {
        visit(&parts.provenance, &open)?;
    }
    Ok(parts.provenance)
}

/// Writes the rows of a study into its folder, as `table.csv`, `table.parquet`, `columns.csv` and `provenance.json`.
///
/// While the rows are written, `visit` receives them as in [`read_shards`].
///
/// # Errors
/// As for [`read_shards`], or if a file cannot be written.
pub fn collect(
    folder: &Path,
    visit: &mut dyn FnMut(&Provenance, &StudyTable) -> Result<(), StudyError>,
) -> Result<Provenance, StudyError> {
    let specs = manifest_of(folder)?.columns;
    let empty = StudyTable::empty(&specs);
    let path = folder.join("table.csv");
    let failed = StudyError::system("write", &path);
    let part = Draft::create(&path).map_err(failed)?;
    let mut csv = BufWriter::new(&part.file);
    csv.write_all(csv_heading(empty.columns()).as_bytes()).map_err(failed)?;
    let columns = folder.join("table.parquet");
    let encode = |error: &dyn Display| StudyError::System {
        doing: "write",
        path: columns.clone(),
        reason: error.to_string(),
    };
    let stored = Draft::create(&columns).map_err(|error| encode(&error))?;
    let mut parquet =
        shard::Writer::new(BufWriter::new(&stored.file), &specs).map_err(|error| encode(&error))?;
    let made = read_shards(folder, &mut |made, rows| {
        csv.write_all(csv_rows(rows.columns()).as_bytes()).map_err(failed)?;
        parquet.add(rows).map_err(|error| encode(&error))?;
        visit(made, rows)
    })?;
    csv.flush().map_err(failed)?;
    drop(csv);
    let provenance = serde_json::to_string_pretty(&made)
        .map_err(|error| StudyError::Table(error.to_string()))?;
    // The Parquet file contains its provenance, since it may be copied without the other files.
    let study = study_text(folder, &made)?;
    let about = [("study", study), ("provenance", provenance.clone())];
    parquet.finish(&about).map_err(|error| encode(&error))?;
    part.name().map_err(failed)?;
    stored.name().map_err(|error| encode(&error))?;
    write_whole(&folder.join("columns.csv"), empty.dictionary().as_bytes())?;
    write_whole(&folder.join("provenance.json"), format!("{provenance}\n").as_bytes())?;
    Ok(made)
}

impl Collected {
    /// Reads all finished rows of a study, complete or not, into memory.
    ///
    /// # Errors
    /// As for [`read_shards`].
    pub fn read(folder: &Path) -> Result<Self, StudyError> {
        let mut parts = Vec::new();
        let provenance = read_shards(folder, &mut |_, rows| {
            parts.push(rows.clone());
            Ok::<(), StudyError>(())
        })?;
        let table = StudyTable::join(&provenance.columns, &parts)?;
        Ok(Self { table, provenance })
    }

    /// Returns the progress of the study in a folder.
    ///
    /// # Errors
    /// As for [`read_shards`].
    pub fn status(folder: &Path) -> Result<Status, StudyError> {
        let mut parts = Shards::open(folder)?;
        while parts.read()?.is_some() {}
        let Shards { provenance, paths, tally, .. } = parts;
        let missing = if provenance.complete {
            Vec::new()
        } else {
            (0..provenance.chunks).filter(|chunk| !paths.contains_key(chunk)).collect()
        };
        Ok(Status { provenance, tally, missing })
    }
}
