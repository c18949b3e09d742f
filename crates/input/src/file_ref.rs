//! A file named by an input file: where it lies, or what is in it.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use crate::{fnv1a, system};

/// A file named by a scenario.
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
    /// Folder of the file that wrote it; empty for the current folder.
    pub folder: PathBuf,
    /// Whether the caller named it, and not a file.
    is_of_caller: bool,
    /// What is in it, where that is at hand.
    bytes: Option<Arc<[u8]>>,
}

impl FileRef {
    /// A file by its path and the folder of the file that wrote it.
    pub fn new(path: impl Into<String>, folder: PathBuf) -> Self {
        Self { path: path.into(), folder, is_of_caller: false, bytes: None }
    }

    /// A file that the caller names, by its path from the current folder.
    pub fn of_caller(path: impl Into<String>) -> Self {
        Self { is_of_caller: true, ..Self::new(path, PathBuf::new()) }
    }

    /// Whether the caller named it, and not a file: a scenario of somebody else names files, too.
    pub fn is_of_caller(&self) -> bool {
        self.is_of_caller
    }

    /// The path to open.
    pub fn resolve(&self) -> PathBuf {
        self.folder.join(&self.path)
    }

    /// Has it at hand from now on, so that it is opened no more.
    pub fn hold(&mut self, bytes: impl Into<Arc<[u8]>>) {
        self.bytes = Some(bytes.into());
    }

    /// Whether it is at hand.
    pub fn is_held(&self) -> bool {
        self.bytes.is_some()
    }

    /// What is in it: as it is at hand, else as the system gives it, if it has at most `limit` bytes.
    ///
    /// # Errors
    /// In words, when the file cannot be read or is larger.
    pub fn read(&self, limit: usize) -> Result<Arc<[u8]>, String> {
        match &self.bytes {
            Some(bytes) => Ok(Arc::clone(bytes)),
            None => system::read(&self.resolve(), limit).map(Into::into),
        }
    }

    /// The file by what is in it, wherever it lies and whatever it is called; as it is where that is not at
    /// hand.
    #[must_use]
    pub fn by_content(&self) -> Self {
        match &self.bytes {
            Some(bytes) => Self::new(format!("{:016x}", fnv1a(bytes)), PathBuf::new()),
            None => self.clone(),
        }
    }
}

/// Two references are equal when they were written alike and the same is at hand, so that a scenario keeps
/// its identity when its folder moves.
impl PartialEq for FileRef {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path && self.bytes == other.bytes
    }
}

/// Without what is in it, which may be megabytes.
#[expect(
    clippy::missing_fields_in_debug,
    reason = "keys of results hold this text, and who names a file changes no result"
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
