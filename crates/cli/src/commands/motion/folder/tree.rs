//! Files below given folders, in the same order on every machine.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use barrelstack_motion::{RecordFiles, group_files};

use crate::commands::motion::{archives, input};

/// Maximum depth of nested folders. The limit ends cycles of symbolic links.
const DEEPEST: usize = 32;

/// The files of one record, and the folder in which they were found.
#[derive(Clone, Debug)]
pub(in crate::commands::motion) struct Source {
    root: PathBuf,
    /// Name of the record and its files, relative to the folder.
    pub(in crate::commands::motion) record: RecordFiles,
}

impl Source {
    /// Returns the paths of the files of the record.
    pub(in crate::commands::motion) fn paths(&self) -> Vec<PathBuf> {
        self.record.files.iter().map(|file| self.root.join(file)).collect()
    }

    /// Returns the path of an output file in a folder: the name of the record with another
    /// extension.
    pub(in crate::commands::motion) fn beside(&self, out: &Path, ending: &str) -> PathBuf {
        let name = self.record.name.replace('?', "X");
        out.join(format!("{name}.{ending}"))
    }
}

/// Returns the records in given files and folders; the records of each folder are sorted. Hidden
/// files and files below `out` are skipped.
pub(super) fn sources(given: &[String], out: &Path) -> anyhow::Result<Vec<Source>> {
    let out = out.canonicalize().map_err(input::plain).context("cannot find the output folder")?;
    let is_folder =
        |path: &&String| Path::new(path).is_dir() || archives::is_archive(Path::new(path));
    let folders = given.iter().filter(is_folder).count();
    let mut sources = Vec::new();
    for path in given {
        let root = Path::new(path);
        let mut files = Vec::new();
        let within = archives::names(root)?;
        let (root, label) = if root.is_dir() || within.is_some() {
            match within {
                Some(names) => files = names,
                None => walk(root, "", &out, 0, &mut files)?,
            }
            let name = root.file_name().map(|name| name.to_string_lossy().into_owned());
            // Records of different folders may have the same name.
            let label = name.filter(|_| folders > 1).map_or_else(String::new, |n| format!("{n}/"));
            (root.to_owned(), label)
        } else {
            let Some(name) = root.file_name().map(|name| name.to_string_lossy().into_owned())
            else {
                bail!("cannot read {path}: there is no such file");
            };
            files.push(name);
            (root.parent().unwrap_or(Path::new("")).to_owned(), String::new())
        };
        for mut record in group_files(&files) {
            record.name = format!("{label}{}", record.name);
            sources.push(Source { root: root.clone(), record });
        }
    }
    sources.sort_by(|a, b| a.record.name.cmp(&b.record.name));
    for pair in sources.windows(2) {
        if pair[0].record.name == pair[1].record.name {
            let [one, two] = [&pair[0], &pair[1]].map(|s| s.root.display().to_string());
            bail!(
                "{} is in both {one} and {two}: run the command separately for each folder",
                pair[0].record.name
            );
        }
    }
    Ok(sources)
}

fn walk(
    folder: &Path,
    before: &str,
    out: &Path,
    depth: usize,
    files: &mut Vec<String>,
) -> anyhow::Result<()> {
    let refused = || format!("cannot read the folder {}", folder.display());
    if depth > DEEPEST {
        bail!("{}: the folder is nested more than {DEEPEST} levels deep", refused());
    }
    let entries = std::fs::read_dir(folder).map_err(input::plain).with_context(refused)?;
    for entry in entries {
        let entry = entry.map_err(input::plain).with_context(refused)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') {
            continue;
        }
        let path = entry.path();
        if path.is_dir() {
            let own = path.canonicalize().is_ok_and(|path| path == *out);
            if !own {
                walk(&path, &format!("{before}{name}/"), out, depth + 1, files)?;
            }
        } else if let Some(names) = archives::names(&path)? {
            files.extend(names.iter().map(|inner| format!("{before}{name}/{inner}")));
        } else {
            files.push(format!("{before}{name}"));
        }
    }
    Ok(())
}
