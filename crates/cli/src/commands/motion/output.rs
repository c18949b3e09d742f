//! Output of the motion commands. The extension of a motion file selects its format. Files are written atomically, and
//! replaced only on request.

use std::path::{Path, PathBuf};

use anyhow::bail;
use barrelstack_motion::{Record, Stage, write};

use super::folder::Source;
use crate::store::{folder, store};
use crate::typed::word;

/// The output file of a motion.
#[derive(Debug, clap::Args)]
pub(super) struct Output {
    /// File to write; the extension selects the format: .at2 (PEER, g, one component), .csv, .npz
    /// (NumPy) or .txt (the program's own format, exact). Where the input is a folder, this is
    /// the folder to write.
    #[arg(long, short, value_name = "FILE", visible_alias = "out")]
    pub(super) output: PathBuf,
    /// Replace the file if it exists.
    #[arg(long)]
    pub(super) overwrite: bool,
}

/// File formats in which the records of a folder can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Form {
    /// NumPy archive.
    Npz,
    /// Comma-separated values.
    Csv,
    /// The program's own text format, exact.
    Txt,
    // An AT2 file has one component only, so the records of folders are never written as such.
    #[value(skip)]
    At2,
}

/// Path and format of a motion file. The path has been checked: a file may be written there.
#[derive(Debug)]
pub(super) struct Target {
    pub(super) path: PathBuf,
    form: Form,
}

impl Form {
    /// Writes a record as a file of this format below the folder `out`, creating missing folders.
    pub(super) fn write(self, source: &Source, out: &Path, record: &Record) -> anyhow::Result<()> {
        let path = source.beside(out, &word(self));
        make_folder_of(&path)?;
        Target { path, form: self }.write(record).map(drop)
    }
}

impl Output {
    /// Determines the format from the extension, and checks that the file may be written. This is done before the
    /// computation starts.
    pub(super) fn prepare(&self) -> anyhow::Result<Target> {
        let ending = self.output.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let form = match ending.as_str() {
            "at2" => Form::At2,
            "csv" => Form::Csv,
            "npz" => Form::Npz,
            "txt" => Form::Txt,
            _ => bail!(
                "{}: the extension does not state a format; use .at2, .csv, .npz or .txt",
                self.output.display()
            ),
        };
        vacant(&self.output, self.overwrite)?;
        Ok(Target { path: self.output.clone(), form })
    }
}

impl Target {
    /// Writes the record, and returns warnings about what the file format cannot store.
    pub(super) fn write(&self, record: &Record) -> anyhow::Result<Vec<String>> {
        let bytes = match self.form {
            Form::At2 if record.channels.len() != 1 => {
                let names: Vec<&str> = record.channels.iter().map(|c| c.name.as_str()).collect();
                bail!(
                    "{}: an AT2 file has one component, but there are {}: select one with \
                     --component ({}), or write .txt, .csv or .npz",
                    self.path.display(),
                    names.len(),
                    names.join(", ")
                )
            }
            Form::At2 => write::at2(record)?.into_bytes(),
            Form::Csv => write::csv(record)?.into_bytes(),
            Form::Txt => write::text(record)?.into_bytes(),
            Form::Npz => write::npz(record)?,
        };
        store(&self.path, &bytes)?;
        Ok(self.losses(record))
    }

    /// Returns warnings about what the file format cannot store, such as the stage of a raw record or the initial
    /// velocity of a channel.
    fn losses(&self, record: &Record) -> Vec<String> {
        let mut losses = Vec::new();
        if self.form != Form::At2 {
            return losses;
        }
        if record.stage == Stage::Raw {
            losses.push(
                "AT2 files are read as corrected records, but this one is raw: write .txt, or \
                 process it first"
                    .to_owned(),
            );
        }
        for channel in &record.channels {
            // Rounding errors at the edge of a pulse do not count as a velocity.
            if channel.initial_velocity.abs() > 1e-6 * channel.pgv() {
                losses.push(format!(
                    "channel {} starts with a velocity of {} cm/s, which AT2 can state only in the title, so a motion read from this file starts from rest; .txt, .csv and .npz keep the velocity",
                    channel.name,
                    super::table::number(100.0 * channel.initial_velocity)
                ));
            }
        }
        losses
    }
}

/// Returns an error if the path is a folder, if the file exists and must not be overwritten, or if its parent folder
/// does not exist.
pub(super) fn vacant(path: &Path, overwrite: bool) -> anyhow::Result<()> {
    if path.is_dir() {
        bail!("{} is a folder, not a file", path.display());
    }
    if path.exists() && !overwrite {
        bail!("{} exists already: give another file, or add --overwrite", path.display());
    }
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            bail!(
                "cannot write {}: there is no folder {}; create it, or give another",
                path.display(),
                folder.display()
            )
        }
        _ => Ok(()),
    }
}

/// Creates the parent folder of a file if it is missing.
pub(super) fn make_folder_of(path: &Path) -> anyhow::Result<()> {
    path.parent().map_or(Ok(()), folder)
}
