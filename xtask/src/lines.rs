//! Number of lines of code of each crate, and the longest files, for information.

use std::path::{Path, PathBuf};

use anyhow::Context as _;

/// Number of files in the list of the longest files.
const LONGEST: usize = 12;

/// Numbers of lines of a source text.
#[derive(Clone, Copy, Default)]
struct Lines {
    code: usize,
    comments: usize,
}

impl Lines {
    /// Counts the lines that are not blank, excluding the tests at the end of a file.
    fn of(text: &str) -> Self {
        let mut lines = Self::default();
        let product = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or(text);
        for line in product.lines().map(str::trim).filter(|line| !line.is_empty()) {
            if line.starts_with("//") {
                lines.comments += 1;
            } else {
                lines.code += 1;
            }
        }
        lines
    }
}

/// Prints the lines of code and of comments of each crate, their sums, and the longest files.
pub(crate) fn list(root: &Path) -> anyhow::Result<()> {
    let (mut all, mut files) = (Lines::default(), Vec::new());
    let mut crates: Vec<PathBuf> = entries(&root.join("crates"))?;
    crates.sort();
    println!("{:>7} {:>8}  crate", "code", "comments");
    for folder in crates {
        let mut own = Lines::default();
        for path in sources(&folder.join("src"))? {
            let text = std::fs::read_to_string(&path)
                .with_context(|| format!("cannot read {}", path.display()))?;
            let lines = Lines::of(&text);
            own.code += lines.code;
            own.comments += lines.comments;
            files.push((lines.code, path));
        }
        all.code += own.code;
        all.comments += own.comments;
        let name = folder.file_name().unwrap_or_default().display().to_string();
        println!("{:>7} {:>8}  {name}", own.code, own.comments);
    }
    println!("{:>7} {:>8}  in all\n\nlongest files", all.code, all.comments);
    files.sort_by(|a, b| b.cmp(a));
    for (code, path) in files.iter().take(LONGEST) {
        println!("{code:>7}  {}", path.strip_prefix(root).unwrap_or(path).display());
    }
    Ok(())
}

/// Returns the paths of the entries of a folder; empty if the folder does not exist.
pub(crate) fn entries(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let read =
        std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    read.map(|entry| Ok(entry?.path())).collect()
}

/// Returns the Rust files of a folder and its subfolders.
pub(crate) fn sources(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for path in entries(folder)? {
        if path.is_dir() {
            found.extend(sources(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    Ok(found)
}
