//! The folder of a study: its manifest, and the shards of finished chunks.
//!
//! ```text
//! study.json                        the provenance of the shards
//! study.toml                        a copy of the study file
//! shards/000012-<fingerprint>.parquet   one chunk; its name holds the fingerprint of its bytes
//! shards/000013.claim               locked by the process that works on the chunk
//! table.csv, table.parquet, columns.csv, provenance.json   all rows, their columns, and their provenance,
//!                                   written when the study is collected
//! ```

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use barrelstack_report::described;

use crate::scenario::fnv1a;
use crate::system;

use super::claim::Claim;
use super::design::Design;
use super::draft::write_whole;
use super::error::StudyError;
use super::grow::{Common, difference};
use super::manifest::{self, Manifest, manifest_of};
use super::motions::hash_files;
use super::shard;
use super::stop::StopRule;
use super::table::StudyTable;
use super::{Intensity, Study};
use barrelstack_report::column::ColumnSpec;

/// Version of the layout of a folder.
pub(super) const LAYOUT: u32 = 3;

/// Largest file (bytes) of a folder that is read.
const FILE_LIMIT: usize = 1 << 30;

pub(super) const MANIFEST: &str = "study.json";
const SHARDS: &str = "shards";

/// Copy of the study file.
const COPY: &str = "study.toml";

/// Metadata key of the key of a chunk in its shard.
const KEY: &str = "chunk";

described! {
    /// Provenance of the rows of a study.
    #[derive(Clone, Debug, PartialEq, serde::Deserialize)]
    pub struct Provenance {
        /// Version of this layout.
        pub schema: u32,
        /// The program.
        pub program: String,
        /// Its version.
        pub version: String,
        /// The title of the study.
        pub title: String,
        /// Fingerprint of the study file, the scenarios it extends, the bytes of its records, and the version.
        pub study_hash: String,
        /// Fingerprint of the bytes of the study file, of which a folder has a copy.
        pub text_hash: String,
        /// Seed of everything that was drawn.
        pub seed: u64,
        /// The design, as study files name it.
        pub design: String,
        /// The intensity measure of the column `level`.
        pub measure: Option<String>,
        /// When a Monte Carlo design has enough cases.
        pub stop: Option<StopRule>,
        /// Factors that are drawn anew for each case of a motion.
        pub drawn: Vec<String>,
        /// Quantities that a sensitivity design exchanges, in the order of the cases of a block; empty for others.
        pub varied: Vec<String>,
        /// Inputs common to all cases.
        pub common: Vec<Common>,
        /// The motions, in order.
        pub motions: Vec<MotionSource>,
        /// The columns of the table.
        pub columns: Vec<ColumnSpec>,
        /// Chunks in all; of a Monte Carlo design, at most.
        pub chunks: usize,
        /// Chunks that are done.
        pub chunks_done: usize,
        /// Rows of the table.
        pub cases: usize,
        /// `true` if nothing is left to run.
        pub complete: bool,
    }
}

impl Provenance {
    /// `true` if cases are drawn, each with a motion, a level and factors of its own.
    pub fn is_sampled(&self) -> bool {
        self.is_sample() || self.design == "saltelli"
    }

    /// As [`Design::is_sample`].
    pub fn is_sample(&self) -> bool {
        matches!(self.design.as_str(), "latin-hypercube" | "sobol" | "monte-carlo")
    }
}

described! {
    /// A motion of a study.
    #[derive(Clone, Debug, PartialEq, Eq, serde::Deserialize)]
    pub struct MotionSource {
        /// Its name in the table.
        pub name: String,
        /// Where it comes from: files, or how it is made.
        pub source: String,
        /// Fingerprint of the bytes of its files; none where it has none.
        pub hash: Option<String>,
        /// Fingerprint of how it is made.
        pub key: String,
    }
}

/// A folder that belongs to a study.
#[derive(Clone, Debug)]
pub(super) struct Folder {
    path: PathBuf,
    /// Fingerprint of the study for which it is open.
    study: String,
    /// `true` if its manifest was damaged and has been written anew.
    pub(super) healed: bool,
}

impl Folder {
    /// Opens a folder for a study: creates it if missing, checks it if not.
    ///
    /// The folder of a study that grew, or changed in nothing that all its cases have in common, is kept; only a run of
    /// the whole study may decide that (`grows`), and takes it over by [`Folder::describe`].
    pub(super) fn open(path: &Path, study: &Study, grows: bool) -> Result<Self, StudyError> {
        let mut folder = Self { path: path.to_owned(), study: study.fingerprint(), healed: false };
        let refuse = |reason: String| Err(StudyError::Folder { folder: path.to_owned(), reason });
        if path.is_file() {
            return refuse("is a file, not a folder; name another".to_owned());
        }
        let (manifest, shards) = (path.join(MANIFEST), path.join(SHARDS));
        if fs::symlink_metadata(&shards).is_ok() {
            // Already there: refused if it is a link.
            system::folder_below(path, Path::new(SHARDS))
                .map_err(StudyError::system("write in", &shards))?;
        }
        // List before looking for the manifest: files that another run makes meanwhile come after its manifest.
        let foreign = first_in(path, &[SHARDS]).or_else(|| first_in(&shards, &[]));
        if manifest.is_file() {
            let known = match manifest::read(path)? {
                Manifest::Sound(known) => known,
                // Chunks carry their own keys; the copy of the study file identifies the folder.
                Manifest::Damaged(how) => {
                    let copy =
                        system::read_result(&path.join(COPY), FILE_LIMIT).unwrap_or_default();
                    if !grows || copy != study.text.as_bytes() {
                        return Err(manifest::damaged(path, &how));
                    }
                    manifest::write(path, &study.provenance()?)?;
                    folder.healed = true;
                    return Ok(folder);
                }
            };
            if known.study_hash != folder.study {
                let reason = match difference(&known, &study.provenance()?) {
                    None if grows => return Ok(folder),
                    None => "the study was changed since; run it as a whole once, which keeps what is still valid".to_owned(),
                    Some(reason) => format!("belongs to another study: {reason}"),
                };
                return refuse(format!(
                    "{reason}; name another folder, or go back to the study that it belongs to (a copy of its file is {})",
                    path.join("study.toml").display()
                ));
            }
        } else if let Some(foreign) = foreign {
            return refuse(format!(
                "holds {foreign} and is not a study folder; name another, new or empty"
            ));
        }
        system::folder_below(path, Path::new(SHARDS))
            .map_err(StudyError::system("make the folder", &shards))?;
        folder.describe(study)?;
        Ok(folder)
    }

    /// Writes the manifest if it is missing or states an earlier form of the study.
    pub(super) fn describe(&self, study: &Study) -> Result<(), StudyError> {
        let manifest = self.path.join(MANIFEST);
        // An earlier version may have made other keys of the same motions.
        let keys = || study.motions.iter().map(|motion| format!("{:016x}", motion.shaking.key()));
        let same = |known: &Provenance| {
            known.motions.iter().map(|m| m.key.clone()).eq(keys())
                && known.text_hash == study.text_hash()
        };
        if !manifest.is_file() || !self.is_ours()? || !same(&manifest_of(&self.path)?) {
            manifest::write(&self.path, &study.provenance()?)?;
        }
        // After the manifest, so that a folder without one has at most an empty folder of shards of ours.
        let copy = self.path.join(COPY);
        if system::read_result(&copy, FILE_LIMIT).is_ok_and(|text| text == study.text.as_bytes()) {
            return Ok(());
        }
        write_whole(&copy, study.text.as_bytes())
    }

    /// `true` if the folder still belongs to the study that it was opened for.
    fn is_ours(&self) -> Result<bool, StudyError> {
        Ok(manifest_of(&self.path)?.study_hash == self.study)
    }

    /// Returns the shards of chunks, sorted.
    pub(super) fn shards(&self) -> Result<Vec<(usize, PathBuf)>, StudyError> {
        shards(&self.path)
    }

    /// Claims a chunk for this process and thread; `None` while another has it.
    ///
    /// A process that began before the study grew is refused, since it would compute the earlier study.
    pub(super) fn claim(&self, chunk: usize) -> Result<Option<Claim>, StudyError> {
        let claim = Claim::take(self.path.join(SHARDS).join(format!("{chunk:06}.claim")))?;
        if claim.is_some() && !self.is_ours()? {
            let reason = "has been given to a study that grew since this run began; run that one";
            return Err(StudyError::Folder {
                folder: self.path.clone(),
                reason: reason.to_owned(),
            });
        }
        Ok(claim)
    }

    /// Removes files left behind by killed runs.
    pub(super) fn clean(&self) -> Result<(), StudyError> {
        let shards = self.path.join(SHARDS);
        for path in list(&self.path)?.into_iter().chain(list(&shards)?) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let claim = name.strip_suffix(".claim").is_some_and(|chunk| {
                path.starts_with(&shards) && chunk.bytes().all(|c| c.is_ascii_digit())
            });
            let draft = name.starts_with('.') && name.ends_with(".part");
            if !(claim || draft) {
                continue;
            }
            // A live owner holds it locked; it may also have been renamed by now, or be gone. Network file
            // systems lock only files that are open for writing.
            // Anything but a file, such as a link, has no live owner.
            let found = fs::symlink_metadata(&path);
            if found.is_ok_and(|found| !found.is_file()) {
                drop(fs::remove_file(&path));
                continue;
            }
            let Ok(file) = File::options().write(true).open(&path) else { continue };
            if file.try_lock().is_ok() {
                drop(fs::remove_file(&path));
            }
        }
        Ok(())
    }

    /// Writes the shard of a chunk: under a temporary name first, so that it is renamed only when it is complete and on
    /// the disk.
    pub(super) fn write_shard(
        &self,
        chunk: usize,
        key: u64,
        table: &StudyTable,
    ) -> Result<(), StudyError> {
        let about = [(KEY, format!("{key:016x}"))];
        let bytes = shard::to_bytes(table, &about)?;
        let name = format!("{chunk:06}-{:016x}.parquet", fnv1a(&bytes));
        write_whole(&self.path.join(SHARDS).join(name), &bytes)
    }
}

/// Returns the bytes of a file of a folder.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, StudyError> {
    system::read_result(path, FILE_LIMIT).map_err(|reason| StudyError::System {
        doing: "read",
        path: path.to_owned(),
        reason,
    })
}

/// Returns the first name in a folder except for some names and hidden ones, to be reported; `None` if there is no
/// folder.
fn first_in(folder: &Path, but: &[&str]) -> Option<String> {
    let names = fs::read_dir(folder).ok()?.flatten();
    let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| !but.contains(&name.as_str()) && !name.starts_with('.')).min()
}

/// Returns the files of a folder, sorted.
fn list(folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let failed = StudyError::system("list", folder);
    let entries = fs::read_dir(folder).map_err(failed)?;
    let paths = entries.map(|entry| Ok(entry.map_err(failed)?.path()));
    let mut paths: Vec<PathBuf> = paths.collect::<Result<_, StudyError>>()?;
    paths.sort();
    Ok(paths)
}

/// Returns the shards of a folder with their chunks, sorted.
pub(super) fn shards(folder: &Path) -> Result<Vec<(usize, PathBuf)>, StudyError> {
    let paths = list(&folder.join(SHARDS))?.into_iter();
    Ok(paths.filter_map(|path| Some((named(&path)?.0, path))).collect())
}

/// Returns chunk and fingerprint in the name of a shard; `None` for any other file.
fn named(path: &Path) -> Option<(usize, u64)> {
    let name = path.file_name()?.to_str()?.strip_suffix(".parquet")?;
    let (chunk, hash) = name.split_once('-')?;
    Some((chunk.parse().ok()?, u64::from_str_radix(hash, 16).ok()?))
}

/// Returns the copy of the study file in a folder, which must match the fingerprint in its manifest.
pub(super) fn study_text(folder: &Path, made: &Provenance) -> Result<String, StudyError> {
    let path = folder.join(COPY);
    let bytes = read_file(&path)?;
    let found = format!("{:016x}", fnv1a(&bytes));
    let text = String::from_utf8(bytes).ok().filter(|_| found == made.text_hash);
    text.ok_or_else(|| StudyError::Folder {
        folder: folder.to_owned(),
        reason: format!(
            "holds a damaged {COPY}: its fingerprint is {found}, not {}; run the study again, which writes it anew",
            made.text_hash
        ),
    })
}

/// Reads a shard and the key of its chunk; its bytes must match the fingerprint in its name.
pub(super) fn read_shard(
    path: &Path,
    specs: &[ColumnSpec],
) -> Result<(StudyTable, Option<u64>), StudyError> {
    let damaged = |reason: String| StudyError::Shard { path: path.to_owned(), reason };
    let bytes = read_file(path)?;
    let (chunk, hash) =
        named(path).ok_or_else(|| damaged("its name is not that of a shard".to_owned()))?;
    let found = fnv1a(&bytes);
    if found != hash {
        return Err(damaged(format!(
            "its {} bytes have the fingerprint {found:016x}, not the one in its name",
            bytes.len()
        )));
    }
    let (table, key) = shard::from_bytes(bytes, KEY).map_err(|error| damaged(error.to_string()))?;
    let of_chunk =
        |number: &Option<i64>| number.and_then(|n| usize::try_from(n).ok()) == Some(chunk);
    if !table.specs().eq(specs.iter())
        || !table.integers("chunk").is_some_and(|all| all.iter().all(of_chunk))
    {
        return Err(damaged("it holds rows of something else".to_owned()));
    }
    Ok((table, key.and_then(|key| u64::from_str_radix(&key, 16).ok())))
}

impl Study {
    /// Returns the provenance of the rows of the study, before there are any.
    ///
    /// # Errors
    /// When a record cannot be read.
    pub fn provenance(&self) -> Result<Provenance, StudyError> {
        let base = self.scenario(&[])?;
        let motions = self.motions.iter().map(|motion| {
            let files = motion.shaking.files(Some(&base.motion));
            let source = motion.shaking.source(&base.motion);
            let hash = hash_files(&motion.name, &files)?.map(|hash| format!("{hash:016x}"));
            let key = format!("{:016x}", motion.shaking.key());
            Ok(MotionSource { name: motion.name.clone(), source, hash, key })
        });
        let motions = motions.collect::<Result<_, StudyError>>()?;
        Ok(Provenance {
            schema: LAYOUT,
            program: "barrelstack".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            title: self.title.clone(),
            study_hash: self.fingerprint(),
            text_hash: self.text_hash(),
            seed: self.seed,
            design: self.design.name().to_owned(),
            measure: self.intensity.as_ref().map(|Intensity { measure, .. }| measure.to_string()),
            stop: self.stop_rule(),
            drawn: self.drawn(),
            varied: if matches!(self.design, Design::Saltelli { .. }) {
                self.varied().into_iter().map(|(_, name)| name).collect()
            } else {
                Vec::new()
            },
            common: self.common()?,
            motions,
            columns: self.columns(),
            chunks: self.chunk_count(),
            chunks_done: 0,
            cases: 0,
            complete: false,
        })
    }

    /// Returns the fingerprint of its file as text.
    fn text_hash(&self) -> String {
        format!("{:016x}", fnv1a(self.text.as_bytes()))
    }

    /// Returns its fingerprint as text.
    fn fingerprint(&self) -> String {
        format!("{:016x}", self.hash())
    }

    /// Returns the factors that stripes draw anew for each case, and one-at-a-time designs for each draw.
    fn drawn(&self) -> Vec<String> {
        let drawn = self.factors.iter().filter(|factor| factor.crossed().is_none());
        let names = drawn.map(|factor| factor.name.clone());
        let draws = matches!(self.design, Design::Stripes | Design::OneAtATime { draws: 1.., .. });
        if draws { names.collect() } else { Vec::new() }
    }

    /// Returns the stop rule; `None` where all cases are run.
    pub(super) fn stop_rule(&self) -> Option<StopRule> {
        let Design::MonteCarlo { half_width, least, .. } = self.design else { return None };
        half_width.map(|half_width| StopRule { half_width, least })
    }
}
