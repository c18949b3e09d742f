//! Downloaded archives: access to the files inside zip, tar, tar.gz and nested archives.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use crate::error::{ReadError, Refusal};
use crate::format::{LARGEST_UNPACKED, Source, shorten, zip};

#[cfg(not(target_family = "wasm"))]
mod tape;

/// Replacement for the tar reader in the WebAssembly build, which omits tar to stay small. No file is
/// recognized as a tar archive.
#[cfg(target_family = "wasm")]
mod tape {
    pub(super) fn is_tar(_: &[u8]) -> bool {
        false
    }

    pub(super) fn each_file<E>(
        _: &[u8],
        _: impl FnMut(&str, Option<&[u8]>) -> Result<bool, E>,
    ) -> std::io::Result<Result<(), E>> {
        Ok(Ok(()))
    }
}

/// Largest number of files in an archive.
const MOST: usize = 50_000;
/// Largest size of a decompressed tar archive (bytes).
const LARGEST_TAR: u64 = 256 << 20;
/// Maximum nesting depth of archives that are opened; the outermost archive has depth 1.
const DEEPEST: usize = 2;
/// File name extensions of archives, in lower case.
const ENDINGS: [&str; 4] = [".zip", ".tar", ".tgz", ".tar.gz"];

/// An archive whose files can be read one by one.
///
/// ```
/// use barrelstack_motion::Archive;
/// let plain = Archive::open(b"0.1\n0.2\n".to_vec(), "a.txt")?;
/// assert!(plain.is_none());
/// # Ok::<(), barrelstack_motion::ReadError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Archive {
    name: String,
    bytes: Vec<u8>,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Zip,
    Tar,
}

impl Archive {
    /// Returns `true` if a name has the extension of an archive: `.zip`, `.tar`, `.tgz` or
    /// `.tar.gz`.
    pub fn is_named(name: &str) -> bool {
        let lower = name.to_ascii_lowercase();
        ENDINGS.iter().any(|ending| lower.ends_with(ending))
    }

    /// Opens bytes that are a zip, tar or tar.gz archive. Returns `None` for anything else,
    /// including NumPy archives. `name` is used only in messages.
    ///
    /// # Errors
    /// If a compressed tar archive is damaged, or larger than 256 MB when unpacked.
    pub fn open(bytes: Vec<u8>, name: &str) -> Result<Option<Self>, ReadError> {
        let archive = |bytes, kind| Ok(Some(Self { name: name.to_owned(), bytes, kind }));
        if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06") {
            let numpy = zip::is_numpy(&bytes);
            return if numpy { Ok(None) } else { archive(bytes, Kind::Zip) };
        }
        if tape::is_tar(&bytes) {
            return archive(bytes, Kind::Tar);
        }
        if !bytes.starts_with(&[0x1F, 0x8B]) {
            return Ok(None);
        }
        let inside = || flate2::read::MultiGzDecoder::new(bytes.as_slice());
        let mut head = Vec::new();
        // A gzip file damaged this early is reported later, when read as a gzip file of one record.
        if inside().take(512).read_to_end(&mut head).is_err() || !tape::is_tar(&head) {
            return Ok(None);
        }
        let mut all = Vec::new();
        let read = inside().take(LARGEST_TAR + 1).read_to_end(&mut all);
        read.map_err(|error| damaged(name, &error.to_string()))?;
        if all.len() as u64 > LARGEST_TAR {
            return Err(damaged(
                name,
                &format!("more than {} MB when unpacked", LARGEST_TAR >> 20),
            ));
        }
        archive(all, Kind::Tar)
    }

    /// Splits a path such as `folder/records.zip/a.AT2` into the path of the archive and the name
    /// inside it. Returns `None` if no folder of the path has the extension of an archive.
    pub fn path_inside(path: &Path) -> Option<(PathBuf, String)> {
        let outer = path.ancestors().skip(1).filter(|folder| {
            folder.file_name().is_some_and(|name| Self::is_named(&name.to_string_lossy()))
        });
        // Use the outermost archive; the others are nested in it.
        let archive = outer.last()?;
        let inner = path.strip_prefix(archive).ok()?;
        Some((archive.to_owned(), inner.to_string_lossy().replace('\\', "/")))
    }

    /// Returns the names of all files, sorted. Files in nested archives are named `inner.zip/name`.
    ///
    /// Folders, hidden files and metadata files of operating systems are omitted.
    ///
    /// # Errors
    /// If the archive is damaged.
    pub fn names(&self) -> Result<Vec<String>, ReadError> {
        let mut names = Vec::new();
        self.list(&mut names, "", 1)?;
        names.sort_unstable();
        Ok(names)
    }

    fn list(&self, names: &mut Vec<String>, before: &str, depth: usize) -> Result<(), ReadError> {
        for name in self.own_names()? {
            let hidden = |part: &str| part.starts_with('.') || part == "__MACOSX";
            if name.ends_with('/') || name.split('/').any(hidden) {
                continue;
            }
            if names.len() >= MOST {
                return Err(damaged(&self.name, &format!("more than {MOST} files")));
            }
            if Self::is_named(&name) && depth < DEEPEST {
                let within = format!("{}/{name}", self.name);
                if let Some(inner) = Self::open(self.own_file(&name)?, &within)? {
                    inner.list(names, &format!("{before}{name}/"), depth + 1)?;
                    continue;
                }
            }
            names.push(format!("{before}{name}"));
        }
        Ok(())
    }

    /// Returns the content of a file, given its name from [`Archive::names`].
    ///
    /// # Errors
    /// If there is no such file, or if it is damaged, encrypted or larger than 12 MB.
    pub fn file(&self, name: &str) -> Result<Vec<u8>, ReadError> {
        if let Some((archive, inner)) = Self::path_inside(Path::new(name)) {
            let archive = archive.to_string_lossy().replace('\\', "/");
            let within = format!("{}/{archive}", self.name);
            if let Some(opened) = Self::open(self.own_file(&archive)?, &within)? {
                return opened.file(&inner);
            }
        }
        self.own_file(name)
    }

    fn own_names(&self) -> Result<Vec<String>, ReadError> {
        Ok(match self.kind {
            Kind::Zip => {
                let entries = zip::entries(&self.bytes).map_err(|e| damaged(&self.name, &e))?;
                entries.into_iter().map(|entry| entry.name).collect()
            }
            Kind::Tar => {
                let mut names = Vec::new();
                self.each_of_tar(|name, _| {
                    names.push(name.to_owned());
                    names.len() <= MOST
                })?;
                names
            }
        })
    }

    fn own_file(&self, name: &str) -> Result<Vec<u8>, ReadError> {
        let limit = if Self::is_named(name) { LARGEST_TAR } else { LARGEST_UNPACKED };
        let too_large =
            || damaged(&self.name, &format!("{name} with more than {} MB", limit >> 20));
        let mut found = None;
        match self.kind {
            Kind::Zip => {
                let entries = zip::entries(&self.bytes).map_err(|e| damaged(&self.name, &e))?;
                if let Some(entry) = entries.iter().find(|entry| entry.name == name) {
                    found = Some(entry.unpack(limit).map_err(|e| damaged(&self.name, &e))?);
                }
            }
            Kind::Tar => self.each_of_tar(|other, bytes| {
                if other == name {
                    found = Some(bytes.to_vec());
                }
                found.is_none()
            })?,
        }
        let found = found.ok_or_else(|| self.no_such_file(name))?;
        if found.len() as u64 > limit { Err(too_large()) } else { Ok(found) }
    }

    /// Calls `take` with the name and the content of every file until `take` returns `false`.
    fn each_of_tar(&self, mut take: impl FnMut(&str, &[u8]) -> bool) -> Result<(), ReadError> {
        tape::each_file(&self.bytes, |name, bytes| match bytes {
            Some(bytes) => Ok(take(name, bytes)),
            None => Err(damaged(&self.name, &format!("{name} cut"))),
        })
        .map_err(|error| damaged(&self.name, &error.to_string()))?
    }

    fn no_such_file(&self, name: &str) -> ReadError {
        let names = self.own_names().unwrap_or_default();
        Source::new(&self.name, &[]).error(
            (),
            Refusal::Options,
            format!("one of {} files ({})", names.len(), shorten(&names.join(", "))),
            format!("\"{name}\", as given"),
            "correct the path inside the archive",
        )
    }
}

fn damaged(name: &str, found: &str) -> ReadError {
    Source::new(name, &[]).damaged(
        (),
        "a readable archive",
        found,
        "unpack it with another program, or get it again from its source",
    )
}
