//! Checks of pages in a browser: scripts, requirements, and the commands that run the checks.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use anyhow::Context as _;

use crate::steps::{build_program, program, target};

/// Path, in the repository, of the script that checks report pages.
pub(crate) const REPORTS: &str = "crates/report/tests/browser/check.mjs";

/// Path, in the repository, of the script that records the animation of the demo for the README.
pub(crate) const FILM: &str = "crates/report/tests/browser/film.mjs";

/// Path, in the repository, of the animation that the README shows.
const FILMED: &str = "docs/pictures/demo.gif";

/// Path, in the repository, of the screenshot of the demo's report that the README shows.
const PICTURED: &str = "docs/pictures/demo.png";

/// Path, in the repository, of the script that checks the page of the engine.
pub(crate) const ENGINE: &str = "crates/web/tests/check.mjs";

/// Folder of the Node.js modules that the checks use.
const MODULES: &str = "crates/report/tests/browser";

/// Command that installs the modules, to be run in the root of the repository.
const INSTALL: &str = "npm ci --prefix crates/report/tests/browser";

/// Program names of the browsers that a script can control.
const BROWSERS: [&str; 4] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// A check of pages in a browser, performed by a script of the repository.
pub(crate) struct Check {
    root: PathBuf,
    script: &'static str,
}

/// Returns the check with this script; `None` if the repository does not contain the script.
pub(crate) fn find(root: &Path, script: &'static str) -> Option<Check> {
    root.join(script).is_file().then(|| Check { root: root.to_path_buf(), script })
}

impl Check {
    /// Returns the command, or the reason why it cannot be run here.
    ///
    /// The environment variable `CHROMIUM` is set to the path of the browser, and `BARRELSTACK` to
    /// the path of the program that writes the pages.
    pub(crate) fn command(&self) -> Result<Command, String> {
        let browser = BROWSERS.into_iter().find_map(on_path).ok_or(
            "no chromium on the PATH; install the package `chromium` of your system to check pages",
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

    /// Builds the program in the release profile.
    pub(crate) fn build(&self) -> anyhow::Result<()> {
        build_program(&self.root)
    }

    /// Records the animation of the demo, and takes a screenshot of its report, for the README.
    pub(crate) fn film(&self) -> anyhow::Result<ExitCode> {
        let mut command = self.command().map_err(anyhow::Error::msg)?;
        self.build()?;
        let folder = target(&self.root).join("browser").join("film");
        let mut demo = Command::new(program(&self.root));
        demo.args(["demo", "--no-remedy", "--out"]).arg(&folder);
        // The exit status is not checked: it reports whether the stack falls.
        demo.status().context("cannot start the program")?;
        let report = folder.join("report.html");
        let status =
            command.arg(report).args([FILMED, PICTURED]).status().context("cannot start node")?;
        Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    }

    /// Saves the present appearance of all pages as the reference for later checks.
    pub(crate) fn renew(&self) -> anyhow::Result<ExitCode> {
        let mut command = self.command().map_err(anyhow::Error::msg)?;
        self.build()?;
        let status = command.arg("--renew").status().context("cannot start node")?;
        Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    }
}

/// Returns the path of a program on the search path.
fn on_path(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    std::env::split_paths(&folders).map(|folder| folder.join(&file)).find(|path| path.is_file())
}
