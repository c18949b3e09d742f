//! The records that may not be bundled, in a folder `shared` beside the checkout.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// A file or folder among them; where it is not there, the test is skipped and says so.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/ground-motions");
    let full = root.join(path);
    if full.exists() {
        return Some(full);
    }
    // Past the runner, which keeps what a passing test prints, to where skipped tests are counted.
    let notice = format!("skipped: {} is not there\n", full.display());
    std::io::stdout().write_all(notice.as_bytes()).unwrap();
    None
}
