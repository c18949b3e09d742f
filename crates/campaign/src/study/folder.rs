//! Folder of a study, with its manifest and the shards of finished chunks.
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

use crate::direction::Direction;
use crate::scenario::{Scenario, fnv1a};
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

/// Maximum size (bytes) of a file in the folder; larger files are not read.
const FILE_LIMIT: usize = 1 << 30;

pub(super) const MANIFEST: &str = "study.json";
const SHARDS: &str = "shards";

/// Name of the copy of the study file.
const COPY: &str = "study.toml";

/// Name of the metadata entry in which a shard stores the key of its chunk.
const KEY: &str = "chunk";

described! {
    /// Provenance of the rows of a study: their inputs, and the progress of the study.
    #[derive(Clone, Debug, PartialEq, serde::Deserialize)]
    pub struct Provenance {
        /// Version of the layout of the folder.
        pub schema: u32,
        /// Name of the program.
        pub program: String,
        /// Version of the program.
        pub version: String,
        /// Title of the study.
        pub title: String,
        /// Description of the stacks, such as "stacks of 4 levels on two-barrel racks, shaken along the barrels",
        /// without the properties that a factor varies; null for scenarios without a stack.
        pub stacks: Option<String>,
        /// Fingerprint of the study file, the scenarios that it extends, the bytes of its records, and the
        /// version of the program.
        pub study_hash: String,
        /// Fingerprint of the bytes of the study file; the folder contains a copy of this file.
        pub text_hash: String,
        /// Seed of all random draws.
        pub seed: u64,
        /// Name of the design in study files.
        pub design: String,
        /// Intensity measure of the column `level`; null if there are no levels.
        pub measure: Option<String>,
        /// Stopping rule of a Monte Carlo design; null if there is none.
        pub stop: Option<StopRule>,
        /// Names of the factors whose values are drawn at random, so that even cases of the same motion differ in them.
        pub drawn: Vec<String>,
        /// Names of the quantities that a Saltelli design exchanges between the two samples of a block, in the order of
        /// the cases in a block; empty for other designs.
        pub varied: Vec<String>,
        /// Inputs that all cases share.
        pub common: Vec<Common>,
        /// Motions of the study, in the order of the study file.
        pub motions: Vec<MotionSource>,
        /// Columns of the table.
        pub columns: Vec<ColumnSpec>,
        /// Total number of chunks; for a Monte Carlo design, the maximum number.
        pub chunks: usize,
        /// Number of finished chunks.
        pub chunks_done: usize,
        /// Number of rows of the table.
        pub cases: usize,
        /// `true` if no chunk is left to run.
        pub complete: bool,
    }
}

impl Provenance {
    /// Returns `true` if cases are samples: motion, level and factors are drawn for each case.
    pub fn is_sampled(&self) -> bool {
        self.is_sample() || self.design == "saltelli"
    }

    /// Returns [`Design::is_sample`] for the design of the study.
    pub fn is_sample(&self) -> bool {
        matches!(self.design.as_str(), "latin-hypercube" | "sobol" | "monte-carlo")
    }
}

described! {
    /// Source of a motion of a study.
    #[derive(Clone, Debug, PartialEq, Eq, serde::Deserialize)]
    pub struct MotionSource {
        /// Name of the motion in the table.
        pub name: String,
        /// Description of the source: the files, or the method by which the motion is made.
        pub source: String,
        /// Fingerprint of the bytes of the files; none if the motion has no files.
        pub hash: Option<String>,
        /// Fingerprint of the method and its settings.
        pub key: String,
    }
}

/// Folder that is open for a study.
#[derive(Clone, Debug)]
pub(super) struct Folder {
    path: PathBuf,
    /// Fingerprint of the study for which the folder is open.
    study: String,
    /// `true` if the manifest was damaged and has been rewritten.
    pub(super) healed: bool,
}

impl Folder {
    /// Opens a folder for a study: creates the folder, or checks that an existing folder belongs to the
    /// study.
    ///
    /// The folder of an earlier form of the study is accepted if `grows` is `true` and all inputs that the
    /// cases share are unchanged. Only a run of the whole study sets `grows`; such a run then calls
    /// [`Folder::describe`].
    pub(super) fn open(path: &Path, study: &Study, grows: bool) -> Result<Self, StudyError> {
        let mut folder = Self { path: path.to_owned(), study: study.fingerprint(), healed: false };
        let refuse = |reason: String| Err(StudyError::Folder { folder: path.to_owned(), reason });
        if path.is_file() {
            return refuse("is a file, not a folder; name a folder".to_owned());
        }
        let (manifest, shards) = (path.join(MANIFEST), path.join(SHARDS));
        if fs::symlink_metadata(&shards).is_ok() {
            // An existing folder of shards is refused if it is a link.
            system::folder_below(path, Path::new(SHARDS))
                .map_err(StudyError::system("write in", &shards))?;
        }
        // The folder is listed before the search for the manifest. A concurrent run writes its manifest before any
        // other file, so that its files are never mistaken for foreign ones.
        let foreign = first_in(path, &[SHARDS]).or_else(|| first_in(&shards, &[]));
        if manifest.is_file() {
            let known = match manifest::read(path)? {
                Manifest::Sound(known) => known,
                // Shards contain their own keys, so the copy of the study file is enough to identify the folder.
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
                    None => "was written before the study changed; run the whole study once, which keeps the chunks that are still valid".to_owned(),
                    Some(reason) => format!("belongs to another study: {reason}"),
                };
                return refuse(format!(
                    "{reason}; name another folder, or use the study to which this folder belongs (a copy of the file \
                     of that study is {})",
                    path.join("study.toml").display()
                ));
            }
        } else if let Some(foreign) = foreign {
            return refuse(format!(
                "holds {foreign} and is not a study folder; name a new or an empty folder"
            ));
        }
        system::folder_below(path, Path::new(SHARDS))
            .map_err(StudyError::system("create the folder", &shards))?;
        folder.describe(study)?;
        Ok(folder)
    }

    /// Writes the manifest and the copy of the study file, if these files are missing or belong to an earlier
    /// form of the study.
    pub(super) fn describe(&self, study: &Study) -> Result<(), StudyError> {
        let manifest = self.path.join(MANIFEST);
        // An earlier version may have computed other keys for the same motions.
        let keys = || study.motions.iter().map(|motion| format!("{:016x}", motion.shaking.key()));
        let same = |known: &Provenance| {
            known.motions.iter().map(|m| m.key.clone()).eq(keys())
                && known.text_hash == study.text_hash()
        };
        if !manifest.is_file() || !self.is_ours()? || !same(&manifest_of(&self.path)?) {
            manifest::write(&self.path, &study.provenance()?)?;
        }
        // The copy is written after the manifest, so that a folder without a manifest holds at most an empty folder of
        // shards.
        let copy = self.path.join(COPY);
        if system::read_result(&copy, FILE_LIMIT).is_ok_and(|text| text == study.text.as_bytes()) {
            return Ok(());
        }
        write_whole(&copy, study.text.as_bytes())
    }

    /// Returns `true` if the folder still belongs to the study for which it was opened.
    fn is_ours(&self) -> Result<bool, StudyError> {
        Ok(manifest_of(&self.path)?.study_hash == self.study)
    }

    /// Returns the chunks that have shards, with the paths of the shards, in ascending order.
    pub(super) fn shards(&self) -> Result<Vec<(usize, PathBuf)>, StudyError> {
        shards(&self.path)
    }

    /// Claims a chunk for this process and thread; returns `None` while another process or thread holds the
    /// claim.
    ///
    /// A process that began before the study grew receives an error, since it would compute the earlier form
    /// of the study.
    pub(super) fn claim(&self, chunk: usize) -> Result<Option<Claim>, StudyError> {
        let claim = Claim::take(self.path.join(SHARDS).join(format!("{chunk:06}.claim")))?;
        if claim.is_some() && !self.is_ours()? {
            let reason = "holds a larger version of the study, which was started after this run; run that version";
            return Err(StudyError::Folder {
                folder: self.path.clone(),
                reason: reason.to_owned(),
            });
        }
        Ok(claim)
    }

    /// Removes files that killed runs have left behind.
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
            // A process that is alive keeps its file locked. The file may also have been renamed or removed by now.
            // Network file systems lock only files that are open for writing. An entry that is not a file, such as a
            // link, belongs to no process.
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

    /// Writes the shard of a chunk.
    ///
    /// The file has a temporary name until it is complete and on the disk.
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

/// Reads a file of the folder.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, StudyError> {
    system::read_result(path, FILE_LIMIT).map_err(|reason| StudyError::System {
        doing: "read",
        path: path.to_owned(),
        reason,
    })
}

/// Returns the name of the first entry of a folder in sorted order, for an error message. Hidden entries and those
/// named in `but` are ignored.
///
/// Returns `None` if there is no such entry or no such folder.
fn first_in(folder: &Path, but: &[&str]) -> Option<String> {
    let names = fs::read_dir(folder).ok()?.flatten();
    let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| !but.contains(&name.as_str()) && !name.starts_with('.')).min()
}

/// Returns the sorted paths of the entries in a folder.
fn list(folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let failed = StudyError::system("list", folder);
    let entries = fs::read_dir(folder).map_err(failed)?;
    let paths = entries.map(|entry| Ok(entry.map_err(failed)?.path()));
    let mut paths: Vec<PathBuf> = paths.collect::<Result<_, StudyError>>()?;
    paths.sort();
    Ok(paths)
}

/// Returns the chunks that have shards in a folder, with the paths of the shards, in ascending order.
pub(super) fn shards(folder: &Path) -> Result<Vec<(usize, PathBuf)>, StudyError> {
    let paths = list(&folder.join(SHARDS))?.into_iter();
    Ok(paths.filter_map(|path| Some((named(&path)?.0, path))).collect())
}

/// Returns the chunk number and the fingerprint in the name of a shard; `None` for any other file.
fn named(path: &Path) -> Option<(usize, u64)> {
    let name = path.file_name()?.to_str()?.strip_suffix(".parquet")?;
    let (chunk, hash) = name.split_once('-')?;
    Some((chunk.parse().ok()?, u64::from_str_radix(hash, 16).ok()?))
}

/// Returns the copy of the study file in a folder, after checking that it matches the fingerprint in the
/// manifest.
pub(super) fn study_text(folder: &Path, made: &Provenance) -> Result<String, StudyError> {
    let path = folder.join(COPY);
    let bytes = read_file(&path)?;
    let found = format!("{:016x}", fnv1a(&bytes));
    let text = String::from_utf8(bytes).ok().filter(|_| found == made.text_hash);
    text.ok_or_else(|| StudyError::Folder {
        folder: folder.to_owned(),
        reason: format!(
            "holds a damaged {COPY}: its fingerprint is {found}, not {}; run the study again, which rewrites the file",
            made.text_hash
        ),
    })
}

/// Reads a shard and the key of its chunk, and checks the bytes of the shard against the fingerprint in its
/// name.
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
        return Err(damaged("it holds rows of another study".to_owned()));
    }
    Ok((table, key.and_then(|key| u64::from_str_radix(&key, 16).ok())))
}

impl Study {
    /// Returns the provenance of the study before any chunk is finished.
    ///
    /// # Errors
    /// If a record cannot be read.
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
            stacks: self.stacks(&base),
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

    /// Describes the stacks of the study by the number of levels, the rack and the direction of shaking in `base`. Each
    /// of these is omitted if a factor varies it; the rack is omitted also if a factor varies one of its dimensions.
    /// Returns `None` for a scenario without a stack.
    fn stacks(&self, base: &Scenario) -> Option<String> {
        let fields = || self.factors.iter().flat_map(|factor| &factor.fields);
        let varied = |path: &str| {
            let inside = |rest: &str| rest.is_empty() || rest.starts_with('.');
            fields().any(|field| field.strip_prefix(path).is_some_and(inside))
        };
        let stack = base.stack()?;
        let plural = if stack.levels == 1 { "" } else { "s" };
        let levels =
            (!varied("stack.levels")).then(|| format!(" of {} level{plural}", stack.levels));
        let rack = (!varied("stack.rack")).then(|| format!(" on {} racks", stack.rack.base));
        let direction = Direction::of(base).filter(|_| !varied("stack.view"));
        let shaken = direction.map(|direction| format!(", shaken {}", direction.words()));
        let said = [levels, rack, shaken].into_iter().flatten();
        Some("stacks".to_owned() + &said.collect::<String>())
    }

    /// Returns the fingerprint of the study file as 16 hexadecimal digits.
    fn text_hash(&self) -> String {
        format!("{:016x}", fnv1a(self.text.as_bytes()))
    }

    /// Returns the fingerprint of the study as 16 hexadecimal digits.
    fn fingerprint(&self) -> String {
        format!("{:016x}", self.hash())
    }

    /// Returns the names of the factors whose values are drawn at random: for each case of a stripes design, or for
    /// each draw of a one-at-a-time design. Empty for all other designs.
    fn drawn(&self) -> Vec<String> {
        let drawn = self.factors.iter().filter(|factor| factor.crossed().is_none());
        let names = drawn.map(|factor| factor.name.clone());
        let draws = matches!(self.design, Design::Stripes | Design::OneAtATime { draws: 1.., .. });
        if draws { names.collect() } else { Vec::new() }
    }

    /// Returns the stopping rule; `None` if all cases are run.
    pub(super) fn stop_rule(&self) -> Option<StopRule> {
        let Design::MonteCarlo { half_width, least, .. } = self.design else { return None };
        half_width.map(|half_width| StopRule { half_width, least })
    }
}
