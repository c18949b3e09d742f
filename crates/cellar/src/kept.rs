//! Results of variants in a folder, so that work that was stopped can be continued, and divided among several
//! machines.

use std::path::{Path, PathBuf};

use barrelstack_input::system;
use serde::{Deserialize, Serialize};

use crate::sample::{Case, CellarFailure, Prepared};

/// A folder with results of the variants of one cellar, one file per variant.
#[derive(Clone, Debug)]
pub struct Kept {
    folder: PathBuf,
    /// Fingerprint of the cellar.
    cellar_hash: String,
}

/// Name and version of the file format.
const SCHEMA: &str = "cellar-variant/1";

/// A file with the result of a variant.
#[derive(Serialize, Deserialize)]
struct File<C> {
    schema: String,
    /// Version of the program that wrote the file. Other versions refuse to read the file.
    version: String,
    cellar_hash: String,
    case: C,
}

/// Share of the variants that a machine runs: those whose numbers leave the remainder `part - 1` when divided by `of`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Number of the part, from 1.
    pub part: u32,
    /// Number of parts.
    pub of: u32,
}

impl Part {
    /// `true` if a variant belongs to the part.
    pub fn has(self, variant: u32) -> bool {
        variant % self.of == self.part - 1
    }
}

impl Kept {
    /// Opens a folder for the results of a cellar, and creates the folder if it is missing.
    ///
    /// # Errors
    /// If the folder cannot be created.
    pub fn open(folder: &Path, prepared: &Prepared) -> Result<Self, CellarFailure> {
        std::fs::create_dir_all(folder).map_err(|error| failure(folder, &system::words(&error)))?;
        let cellar_hash = prepared.plan.summary.cellar_hash.clone();
        Ok(Self { folder: folder.to_owned(), cellar_hash })
    }

    fn path(&self, variant: u32) -> PathBuf {
        self.folder.join(format!("variant-{variant:04}.json"))
    }

    /// Returns the result of a variant; `None` if it is not in the folder.
    ///
    /// # Errors
    /// If the file cannot be read, or was written for another cellar or by another version of the program.
    pub fn read(&self, variant: u32) -> Result<Option<Case>, CellarFailure> {
        let path = self.path(variant);
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(failure(&path, &system::words(&error))),
        };
        let file: File<Case> = serde_json::from_slice(&bytes).map_err(|error| {
            failure(&path, &format!("it is not the result of a variant ({error})"))
        })?;
        let own = (SCHEMA, env!("CARGO_PKG_VERSION"));
        if (file.schema.as_str(), file.version.as_str()) != own {
            return Err(failure(
                &path,
                &format!(
                    "it was written by version {} ({}), not by this version, {} ({})",
                    file.version, file.schema, own.1, own.0
                ),
            ));
        }
        if file.cellar_hash != self.cellar_hash {
            let message = format!(
                "it belongs to a cellar with the hash {}, but this cellar has the hash {}: the scenario file, the \
                 changes to its values, or the number of variants differs",
                file.cellar_hash, self.cellar_hash
            );
            return Err(failure(&path, &message));
        }
        if file.case.variant != variant {
            return Err(failure(&path, &format!("it belongs to variant {}", file.case.variant)));
        }
        Ok(Some(file.case))
    }

    /// Writes the result of a variant; does nothing if the computation of the variant failed.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, case: &Case) -> Result<(), CellarFailure> {
        if !case.valid {
            return Ok(());
        }
        let path = self.path(case.variant);
        let file = File {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            cellar_hash: self.cellar_hash.clone(),
            case,
        };
        let text =
            serde_json::to_string(&file).map_err(|error| failure(&path, &error.to_string()))?;
        system::store(&path, text.as_bytes())
            .map_err(|error| failure(&path, &system::words(&error)))
    }
}

fn failure(path: &Path, reason: &str) -> CellarFailure {
    CellarFailure::Kept { path: path.display().to_string(), reason: reason.to_owned() }
}
