//! Groups the files of a folder into records by their file names.

use std::collections::BTreeMap;

use crate::format::file_stem;

/// The files of one record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordFiles {
    /// Name of the record: the path without the part that identifies the component.
    pub name: String,
    /// Paths of the files, sorted.
    pub files: Vec<String>,
}

/// Groups paths (with `/` between folders) into records, sorted by name.
///
/// Files of one folder belong to the same record if their names differ only in the component. Each
/// kind of name has its own rule:
///
/// - Names that end in `.AT2` and contain a record sequence number, such as
///   `RSN995_NORTHR_PEL090.AT2` and `RSN995_NORTHR_PEL-UP.AT2`, are grouped by this number. Other
///   names that end in `.AT2` are grouped by the part before the component, such as an azimuth, `-E`
///   or `-UP`.
/// - Names such as `AOM0011801241951.EW` are grouped by the part before `.EW`, `.NS` or `.UD`. The
///   borehole (`.EW1`) and the surface (`.EW2`) are separate records.
/// - Names that contain a SEED channel code such as `HNE`, between dots, dashes or underscores, may
///   differ in the last letter of this code.
/// - Other names may differ in the letters before their extension: `_E`, `_N` and `_U` (or `_Z`), as
///   AFAD names its files, or `_EW`, `_NS` and `_UD`. The separator may also be a dash or a dot;
///   between a digit and two letters, it may be missing, as in the names of CSMNC.
/// - Names that end in `.000`, `.090` and `.ver`, as the Broadband Platform names its files, are
///   grouped by the part before this ending.
///
/// Any other file is a record of its own. [`crate::Record::gather`] checks whether the channels
/// really belong together.
///
/// ```
/// use barrelstack_motion::group_files;
/// let files = ["a/RSN6_ELC180.AT2", "a/RSN6_ELC270.AT2", "a/x.smc"].map(str::to_owned);
/// let records = group_files(&files);
/// assert_eq!(records[0].name, "a/RSN6_ELC");
/// assert_eq!(records[0].files.len(), 2);
/// assert_eq!(records[1].name, "a/x.smc");
/// ```
pub fn group_files(paths: &[String]) -> Vec<RecordFiles> {
    let mut groups: BTreeMap<String, RecordFiles> = BTreeMap::new();
    let mut sorted: Vec<&String> = paths.iter().collect();
    sorted.sort_unstable();
    sorted.dedup();
    for path in sorted {
        let (folder, file) = match path.rfind('/') {
            Some(at) => path.split_at(at + 1),
            None => ("", path.as_str()),
        };
        let (key, name) = key(file);
        let record = groups
            .entry(format!("{folder}{key}"))
            .or_insert_with(|| RecordFiles { name: format!("{folder}{name}"), files: Vec::new() });
        record.files.push(path.clone());
    }
    let mut records: Vec<RecordFiles> = groups.into_values().collect();
    for record in &mut records {
        // A single file keeps its full name, which is unique.
        if let [file] = record.files.as_slice() {
            record.name.clone_from(file);
        }
    }
    records.sort_by(|a, b| a.name.cmp(&b.name));
    records
}

/// Returns the key of a file, which is equal for all files of a record, and the name of the record.
fn key(file: &str) -> (String, String) {
    let stem = file_stem(file);
    let ending = file.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_uppercase();
    if ending == "AT2" {
        let name = without_component(&stem);
        let number = super::flatfile::record_sequence_number(file);
        return (number.map_or_else(|| format!("{name}.AT2"), |n| format!("RSN{n}.AT2")), name);
    }
    for component in ["EW", "NS", "UD"] {
        if let Some(sensor) = ending.strip_prefix(component)
            && matches!(sensor, "" | "1" | "2")
        {
            let name = if sensor.is_empty() { stem } else { format!("{stem}.{sensor}") };
            return (format!("{name}.knet"), name);
        }
    }
    if matches!(ending.as_str(), "000" | "090" | "VER") {
        return (format!("{stem}.bbp"), stem);
    }
    let named = seed(file).or_else(|| {
        let (name, ending) = (direction_off(&stem)?, file.get(stem.len()..)?);
        Some(format!("{name}?{ending}"))
    });
    named.map_or_else(|| (file.to_owned(), file.to_owned()), |name| (name.clone(), name))
}

/// Returns a name without the direction at its end; `None` if the name does not end in a direction. A direction is one
/// or two letters after a separator, or two letters after a digit.
fn direction_off(stem: &str) -> Option<&str> {
    let upper = stem.to_ascii_uppercase();
    let marked = |direction: &&str| {
        let before = upper.strip_suffix(*direction).unwrap_or_default();
        before.len() > 1 && before.ends_with(['_', '-', '.'])
    };
    let numbered = |direction: &&str| {
        let before = upper.strip_suffix(*direction).unwrap_or_default();
        direction.len() == 2 && before.ends_with(|c: char| c.is_ascii_digit())
    };
    let found = ["EW", "NS", "UD", "E", "N", "U", "Z"]
        .into_iter()
        .find(|direction| marked(direction) || numbered(direction))?;
    stem.get(..stem.len() - found.len())
}

/// Returns the name of a PEER file without the component at its end, such as `-UP` or an azimuth.
fn without_component(stem: &str) -> String {
    let upper = stem.to_ascii_uppercase();
    for ending in ["-UP", "-DWN", "-DN", "-VER", "-V", "-N", "-E", "-S", "-W", "-NS", "-EW", "UP"] {
        if upper.ends_with(ending) {
            return stem[..stem.len() - ending.len()].to_owned();
        }
    }
    let azimuth = stem.len().checked_sub(3).and_then(|at| stem.get(at..));
    match azimuth {
        Some(digits) if digits.bytes().all(|b| b.is_ascii_digit()) => {
            stem[..stem.len() - 3].trim_end_matches(['-', '_']).to_owned()
        }
        _ => stem.to_owned(),
    }
}

/// Replaces the direction, which is the last letter of the SEED channel code in a file name, with a question mark.
/// Returns `None` if the name contains no SEED channel code.
fn seed(file: &str) -> Option<String> {
    let mut start = 0;
    for part in file.split_inclusive(['.', '_', '-']) {
        let word = part.trim_end_matches(['.', '_', '-']);
        if let [band, instrument, direction] = word.as_bytes()
            && band.is_ascii_uppercase()
            && matches!(instrument, b'N' | b'L' | b'G' | b'H')
            && matches!(direction, b'N' | b'E' | b'Z' | b'1' | b'2' | b'3')
        {
            return Some(format!("{}?{}", &file[..start + 2], &file[start + 3..]));
        }
        start += part.len();
    }
    None
}
