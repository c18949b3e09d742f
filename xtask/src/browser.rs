//! The checks of pages in a browser: what they need, and how they are run.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use anyhow::Context as _;

use crate::steps::{build_program, program, target};

/// Where the checks of report pages stand in the repository.
pub(crate) const REPORTS: &str = "crates/report/tests/browser/check.mjs";

/// Script that films the demo for the README.
pub(crate) const FILM: &str = "crates/report/tests/browser/film.mjs";

/// The film.
const FILMED: &str = "docs/pictures/demo.gif";

/// Where those of the engine in a page stand.
pub(crate) const ENGINE: &str = "crates/web/tests/check.mjs";

/// Where their modules are.
const MODULES: &str = "crates/report/tests/browser";

/// Command that installs the modules of the checks, typed in the root of the repository.
const INSTALL: &str = "npm ci --prefix crates/report/tests/browser";

/// Names under which systems install a browser that can be driven.
const BROWSERS: [&str; 4] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Checks that open pages in a browser.
pub(crate) struct Check {
    root: PathBuf,
    script: &'static str,
}

/// The checks, where the repository has them.
pub(crate) fn find(root: &Path, script: &'static str) -> Option<Check> {
    root.join(script).is_file().then(|| Check { root: root.to_path_buf(), script })
}

impl Check {
    /// The command, with the path of the browser in the variable `CHROMIUM` and that of the
    /// program that makes the pages in `BARRELSTACK`; or why it cannot be run here.
    pub(crate) fn command(&self) -> Result<Command, String> {
        let browser = BROWSERS.into_iter().find_map(on_path).ok_or(
            "no chromium on the PATH; install the package `chromium` of your system to check pages \
             in it",
        )?;
        if on_path("node").is_none() {
            return Err("no node on the PATH; install Node.js 20 or newer to check pages".into());
        }
        let modules = Command::new("node")
            .args([
                "--eval",
                "for (const m of ['playwright-core', '@fontsource/roboto', 'axe-core']) require.resolve(m)",
            ])
            .current_dir(self.root.join(MODULES))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        if !modules.is_ok_and(|status| status.success()) {
            return Err(format!("the modules of the checks are not installed; type `{INSTALL}`"));
        }
        let mut command = Command::new("node");
        command.arg(self.script).current_dir(&self.root).env("CHROMIUM", browser);
        command.env("BARRELSTACK", program(&self.root));
        Ok(command)
    }

    /// Builds the program in release.
    pub(crate) fn build(&self) -> anyhow::Result<()> {
        build_program(&self.root)
    }

    /// Films the demo for the README.
    pub(crate) fn film(&self) -> anyhow::Result<ExitCode> {
        let mut command = self.command().map_err(anyhow::Error::msg)?;
        self.build()?;
        let folder = target(&self.root).join("browser").join("film");
        let mut demo = Command::new(program(&self.root));
        demo.args(["run", "demo-napa", "--quiet", "--overwrite", "--out"]).arg(&folder);
        // Its status says whether the stack falls.
        demo.status().context("the program does not start")?;
        let report = folder.join("report.html");
        let status = command.arg(report).arg(FILMED).status().context("node does not start")?;
        Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    }

    /// Keeps the looks of all pages as they are now.
    pub(crate) fn renew(&self) -> anyhow::Result<ExitCode> {
        let mut command = self.command().map_err(anyhow::Error::msg)?;
        self.build()?;
        let status = command.arg("--renew").status().context("node does not start")?;
        Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    }
}

/// A program on the search path.
fn on_path(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    std::env::split_paths(&folders).map(|folder| folder.join(&file)).find(|path| path.is_file())
}
