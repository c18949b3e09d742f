//! The check of reports in a browser: whether there is one, and what it needs.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Where the check stands in the repository.
const SCRIPT: &str = "crates/report/tests/browser/check.mjs";

/// What is announced.
pub(crate) const NAME: &str = "node crates/report/tests/browser/check.mjs";

/// Names under which systems install a browser that can be driven.
const BROWSERS: [&str; 4] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// A check that opens reports in a browser.
pub(crate) struct Check {
    root: PathBuf,
}

/// The check, where the repository has one.
pub(crate) fn find(root: &Path) -> Option<Check> {
    root.join(SCRIPT).is_file().then(|| Check { root: root.to_path_buf() })
}

impl Check {
    /// The command, which is told where the browser is by the variable `CHROMIUM`; or why it cannot
    /// be run here.
    pub(crate) fn command(&self) -> Result<Command, String> {
        let browser = BROWSERS.into_iter().find_map(on_path);
        let browser =
            browser.ok_or("no chromium on the PATH; install it to check reports in it")?;
        if on_path("node").is_none() {
            return Err("no node on the PATH; install it to check reports in a browser".into());
        }
        let script = self.root.join(SCRIPT);
        let folder = script.parent().unwrap_or(&self.root);
        let library = Command::new("node")
            .args(["--eval", "require.resolve('playwright-core')"])
            .current_dir(folder)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        if !library.is_ok_and(|status| status.success()) {
            return Err(format!(
                "node finds no playwright-core; install it with `npm install playwright-core` in {}",
                Path::new(SCRIPT).parent().unwrap_or(Path::new(".")).display()
            ));
        }
        let mut command = Command::new("node");
        command.arg(SCRIPT).current_dir(&self.root).env("CHROMIUM", browser);
        Ok(command)
    }
}

/// A program on the search path.
fn on_path(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    std::env::split_paths(&folders).map(|folder| folder.join(&file)).find(|path| path.is_file())
}
