//! Loading and reading of the record of a scenario.

use std::path::{Component, Path, PathBuf};

use barrelstack_input::names::advice;
use barrelstack_input::{FileRef, system};
use barrelstack_motion::{
    AccelerationUnit, Archive, Given, MotionError, ReadFailure, ReadOptions, Record, Refusal,
};

use super::GroundError;
use crate::motion::{MotionSource, MotionSpec, RecordMotion, RecordSource, Vertical};

/// Size (bytes) of the largest record that is read; the longest strong-motion files are a tenth of that size.
pub const RECORD_LIMIT: usize = 256 << 20;

/// Returns a reference to a file in memory that contains a record.
///
/// # Errors
/// If the record has no channel, or its channels have different time steps.
pub fn held(record: &Record) -> Result<FileRef, MotionError> {
    let mut file = FileRef::new(&record.file, PathBuf::new());
    file.hold(barrelstack_motion::write::npz(record)?);
    Ok(file)
}

/// Reads a file from disk, for [`MotionSpec::with_files`].
///
/// A path may lead into an archive: `records.zip/a.AT2` is the file `a.AT2` in the archive `records.zip`.
///
/// # Errors
/// If the file cannot be read, or is larger than [`RECORD_LIMIT`].
pub fn from_disk(path: &Path) -> Result<Vec<u8>, String> {
    let Some((archive, inner)) = Archive::path_inside(path).filter(|_| !path.exists()) else {
        return system::read(path, RECORD_LIMIT);
    };
    let bytes = system::read(&archive, RECORD_LIMIT)?;
    let opened = Archive::open(bytes, &archive.display().to_string()).map_err(|e| e.to_string())?;
    let opened = opened.ok_or_else(|| format!("{} is not an archive", archive.display()))?;
    opened.file(&inner).map_err(|error| error.to_string())
}

impl MotionSpec {
    /// Returns the motion with its files loaded.
    ///
    /// `fetch` is called with the path of every file that is not loaded yet.
    ///
    /// The error of `fetch` is a message in the style of the operating system, such as "there is no such file".
    ///
    /// # Errors
    /// If `fetch` fails.
    pub fn with_files(
        mut self,
        fetch: &mut dyn FnMut(&Path) -> Result<Vec<u8>, String>,
    ) -> Result<Self, GroundError> {
        if let MotionSource::Record(record) = &mut self.source {
            let obtain = how_to_obtain(record);
            if let RecordSource::File(file) = &mut record.source {
                hold(file, &obtain, fetch)?;
            }
            if let Vertical::File(file) = &mut record.vertical {
                hold(file, OTHER_VERTICAL, fetch)?;
            }
        }
        Ok(self)
    }
}

/// Loads a file, unless it is already loaded.
fn hold(
    file: &mut FileRef,
    obtain: &str,
    fetch: &mut dyn FnMut(&Path) -> Result<Vec<u8>, String>,
) -> Result<(), GroundError> {
    if !file.is_held() {
        let path = file.resolve();
        file.hold(fetch(&path).map_err(|reason| unreadable(path, reason, obtain))?);
    }
    Ok(())
}

fn unreadable(path: PathBuf, reason: String, obtain: &str) -> GroundError {
    GroundError::Unreadable { path, reason, obtain: obtain.to_owned() }
}

/// Returns advice on obtaining the file of a record, worded so that it can follow the reason of an error.
fn how_to_obtain(record: &RecordMotion) -> String {
    record.obtain.as_ref().map_or_else(|| "; correct the path".to_owned(), |how| format!("; {how}"))
}

/// Advice at the end of the error message if the separate file of the vertical component cannot be read.
pub(super) const OTHER_VERTICAL: &str = "; correct motion.vertical";

/// Returns the reader options that a scenario specifies.
pub(super) fn read_options(spec: &RecordMotion) -> Result<ReadOptions, GroundError> {
    Ok(ReadOptions {
        unit: spec.unit.map(unit).transpose()?,
        time_step: spec.time_step,
        sensitivity: spec.sensitivity,
        ..ReadOptions::default()
    })
}

pub(super) fn read(spec: &RecordMotion) -> Result<Record, GroundError> {
    let options = read_options(spec)?;
    match &spec.source {
        RecordSource::Bundled(name) => {
            barrelstack_motion::bundled(name).ok_or_else(|| GroundError::UnknownBundled {
                name: name.clone(),
                next: advice(name, barrelstack_motion::BUNDLED),
            })
        }
        RecordSource::File(file) => read_file(file, &options, &how_to_obtain(spec)),
    }
}

pub(super) fn read_file(
    file: &FileRef,
    options: &ReadOptions,
    obtain: &str,
) -> Result<Record, GroundError> {
    let path = file.resolve();
    let bytes =
        if file.is_held() { file.read(RECORD_LIMIT) } else { from_disk(&path).map(Into::into) };
    let bytes = bytes.map_err(|reason| unreadable(path.clone(), reason, obtain))?;
    let record = barrelstack_motion::read(&bytes, &path.display().to_string(), options);
    // Reports show the name of the file, not its path.
    let named = |record: Record| {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        Record { file: name.unwrap_or_else(|| record.file.clone()), ..record }
    };
    record.map(named).map_err(|error| {
        let mut failure: ReadFailure = (*error).clone();
        if is_outside(file) {
            "other text, which is not shown, since the file lies outside the folder of the scenario"
                .clone_into(&mut failure.found);
        }
        // The reader reports which information is missing; add where the scenario can state this information.
        if let Refusal::Missing(given) = failure.refusal {
            failure.remedy += match given {
                Given::UnitOrSensitivity => {
                    " in the scenario, as motion.unit = \"1 g\" or motion.sensitivity = 427819"
                }
                Given::Unit => " in the scenario, for example motion.unit = \"1 g\"",
                Given::Step => " in the scenario, for example motion.time_step = \"0.01 s\"",
                Given::Sensitivity => " in the scenario, for example motion.sensitivity = 427819",
            };
            failure.remedy += ", or in `each` of a study's [[motion]]";
        }
        GroundError::Read(failure.into())
    })
}

/// Returns `true` if a file lies outside the folder of the file that names it.
///
/// Messages do not quote the content of such a file, since a scenario from someone else could name a private file.
fn is_outside(file: &FileRef) -> bool {
    if file.is_of_caller() {
        return false;
    }
    let folder = if file.folder.as_os_str().is_empty() { Path::new(".") } else { &file.folder };
    match (file.resolve().canonicalize(), folder.canonicalize()) {
        (Ok(path), Ok(folder)) => !path.starts_with(folder),
        // A file that is held in memory need not exist on the disk; then the path as written decides.
        _ => Path::new(&file.path)
            .components()
            .any(|part| !matches!(part, Component::Normal(_) | Component::CurDir)),
    }
}

fn unit(meters_per_second_squared: f64) -> Result<AccelerationUnit, GroundError> {
    AccelerationUnit::ALL
        .into_iter()
        .find(|unit| (unit.factor() / meters_per_second_squared - 1.0).abs() < 1e-6)
        .ok_or(GroundError::Unit { unit: meters_per_second_squared })
}
