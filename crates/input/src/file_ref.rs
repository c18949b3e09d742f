//! References from an input file to other files, by path or by content.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use crate::{fnv1a, system};

/// A file referred to by an input file, such as the record of a scenario.
///
/// ```
/// use barrelstack_input::FileRef;
///
/// let mut file = FileRef::new("site.at2", "records".into());
/// assert!(file.read(1 << 20).is_err(), "there is no such file");
/// file.hold(b"0.01 0.02".to_vec());
/// assert_eq!(file.read(1 << 20)?[..4], *b"0.01");
/// # Ok::<(), String>(())
/// ```
#[derive(Clone)]
pub struct FileRef {
    /// The path as written.
    pub path: String,
    /// Folder of the referring file; empty for the current folder.
    pub folder: PathBuf,
    /// `true` if the path was given by the caller, `false` if it was read from a file.
    is_of_caller: bool,
    /// Content of the file, if loaded.
    bytes: Option<Arc<[u8]>>,
}

impl FileRef {
    /// Creates a reference from a path and the folder of the referring file.
    pub fn new(path: impl Into<String>, folder: PathBuf) -> Self {
        Self { path: path.into(), folder, is_of_caller: false, bytes: None }
    }

    /// Creates a reference from a path that the caller gives, relative to the current folder.
    pub fn of_caller(path: impl Into<String>) -> Self {
        Self { is_of_caller: true, ..Self::new(path, PathBuf::new()) }
    }

    /// Returns `true` if the path was given by the caller, and `false` if it was read from a file. A path
    /// in a file cannot be trusted, since somebody else may have written the file.
    pub fn is_of_caller(&self) -> bool {
        self.is_of_caller
    }

    /// Returns the path to open.
    pub fn resolve(&self) -> PathBuf {
        self.folder.join(&self.path)
    }

    /// Stores the content, so that the file is not opened again.
    pub fn hold(&mut self, bytes: impl Into<Arc<[u8]>>) {
        self.bytes = Some(bytes.into());
    }

    /// Returns `true` if the content is loaded.
    pub fn is_held(&self) -> bool {
        self.bytes.is_some()
    }

    /// Returns the stored content, or reads the file, which may have at most `limit` bytes.
    ///
    /// # Errors
    /// A message if the file cannot be read or is larger than `limit`.
    pub fn read(&self, limit: usize) -> Result<Arc<[u8]>, String> {
        match &self.bytes {
            Some(bytes) => Ok(Arc::clone(bytes)),
            None => system::read(&self.resolve(), limit).map(Into::into),
        }
    }

    /// Returns a reference that identifies the file by its content instead of its path. If the
    /// content is not loaded, the reference is returned unchanged.
    #[must_use]
    pub fn by_content(&self) -> Self {
        match &self.bytes {
            Some(bytes) => Self::new(format!("{:016x}", fnv1a(bytes)), PathBuf::new()),
            None => self.clone(),
        }
    }
}

/// References are equal if their paths as written and their contents are equal. The folder is not
/// compared, so that a scenario keeps its identity when its folder moves.
impl PartialEq for FileRef {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path && self.bytes == other.bytes
    }
}

/// Writes the length of the content only, since the content may be megabytes long.
#[expect(
    clippy::missing_fields_in_debug,
    reason = "this text is part of the keys of results, which do not depend on who named the file"
)]
impl fmt::Debug for FileRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_struct("FileRef");
        all.field("path", &self.path).field("folder", &self.folder);
        if let Some(bytes) = &self.bytes {
            all.field("bytes", &bytes.len());
        }
        all.finish()
    }
}
