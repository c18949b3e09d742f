//! Output of the commands: motion files by their extension, written atomically, never replaced unasked.

use std::path::{Path, PathBuf};

use anyhow::bail;
use barrelstack_motion::{Record, Stage, write};

use super::folder::Source;
use crate::store::{folder, store};
use crate::typed::word;

/// Where a motion goes.
#[derive(Debug, clap::Args)]
pub(super) struct Output {
    /// The file to write; its ending says the form: .at2 (PEER, g, one component), .csv, .npz (NumPy)
    /// or .txt (the program's own, exact). Of whole folders, the folder for all.
    #[arg(long, short, value_name = "FILE", visible_alias = "out")]
    pub(super) output: PathBuf,
    /// Replace the file if it is there.
    #[arg(long)]
    pub(super) overwrite: bool,
}

/// Forms that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Form {
    /// NumPy.
    Npz,
    /// Numbers between commas.
    Csv,
    /// The program's own, exact.
    Txt,
    // One component alone, so that the files of whole folders are never written as such.
    #[value(skip)]
    At2,
}

/// A motion file that may be written.
#[derive(Debug)]
pub(super) struct Target {
    pub(super) path: PathBuf,
    form: Form,
}

impl Form {
    /// Writes a record into a file of this form, and creates its folder if missing.
    pub(super) fn write(self, source: &Source, out: &Path, record: &Record) -> anyhow::Result<()> {
        let path = source.beside(out, &word(self));
        make_folder_of(&path)?;
        Target { path, form: self }.write(record).map(drop)
    }
}

impl Output {
    /// Checks the file before the work is done.
    pub(super) fn prepare(&self) -> anyhow::Result<Target> {
        let ending = self.output.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let form = match ending.as_str() {
            "at2" => Form::At2,
            "csv" => Form::Csv,
            "npz" => Form::Npz,
            "txt" => Form::Txt,
            _ => bail!(
                "{}: the extension of the name does not say the format; use .at2, .csv, .npz or .txt",
                self.output.display()
            ),
        };
        vacant(&self.output, self.overwrite)?;
        Ok(Target { path: self.output.clone(), form })
    }
}

impl Target {
    /// Writes the record and returns warnings for readers of the file.
    pub(super) fn write(&self, record: &Record) -> anyhow::Result<Vec<String>> {
        let bytes = match self.form {
            Form::At2 if record.channels.len() != 1 => {
                let names: Vec<&str> = record.channels.iter().map(|c| c.name.as_str()).collect();
                bail!(
                    "{}: an AT2 file holds one component, and there are {}: name one with \
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

    /// Describes the information that the file cannot hold.
    fn losses(&self, record: &Record) -> Vec<String> {
        let mut losses = Vec::new();
        if self.form != Form::At2 {
            return losses;
        }
        if record.stage == Stage::Raw {
            losses.push(
                "AT2 files are taken for corrected records and this one is raw: write .txt, or \
                 process it first"
                    .to_owned(),
            );
        }
        for channel in &record.channels {
            // Rounding errors at the edge of a pulse are not a velocity.
            if channel.initial_velocity.abs() > 1e-6 * channel.pgv() {
                losses.push(format!(
                    "channel {} starts with a velocity of {} cm/s, for which AT2 has no place but the \
                     title: read back, it starts from rest; .txt, .csv and .npz keep it",
                    channel.name,
                    super::table::number(100.0 * channel.initial_velocity)
                ));
            }
        }
        losses
    }
}

/// Refuses an existing file, and one in a missing folder.
pub(super) fn vacant(path: &Path, overwrite: bool) -> anyhow::Result<()> {
    if path.is_dir() {
        bail!("{} is a folder, not a file", path.display());
    }
    if path.exists() && !overwrite {
        bail!("{} is there already: name another file, or add --overwrite", path.display());
    }
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            bail!(
                "cannot write {}: there is no folder {}; make it, or name another",
                path.display(),
                folder.display()
            )
        }
        _ => Ok(()),
    }
}

/// Creates the folder of a file if missing.
pub(super) fn make_folder_of(path: &Path) -> anyhow::Result<()> {
    path.parent().map_or(Ok(()), folder)
}
