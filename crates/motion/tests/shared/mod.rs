//! Access to records that may not be bundled, in a folder `shared` next to the checkout.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Returns the path of a file or folder in `shared`; if it is missing, reports the test as skipped.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/ground-motions");
    let full = root.join(path);
    if full.exists() {
        return Some(full);
    }
    // Write to standard output directly: the runner captures the output of passing tests.
    let notice = format!("skipped: {} is not there\n", full.display());
    std::io::stdout().write_all(notice.as_bytes()).unwrap();
    None
}
