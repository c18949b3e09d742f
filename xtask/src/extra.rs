//! Checks that need more than the Rust toolchain; a check with a missing requirement is reported as
//! skipped.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::bundle::Bundle;
use crate::steps::cargo;
use crate::{browser, python, web};

/// A check that not every machine can run.
pub(crate) struct Extra {
    /// Name in the heading of the step.
    pub(crate) name: &'static str,
    /// The command, or a message that names what is missing and how to install it.
    pub(crate) command: Result<Command, String>,
    /// Advice after a failure.
    pub(crate) remedy: &'static str,
    /// The browser check that `command` runs; `None` if it runs none. The program writes the pages to be checked, so it
    /// is built before the check.
    pub(crate) pages: Option<browser::Check>,
}

/// The oldest toolchain that builds the workspace: `rust-version` in `Cargo.toml`.
pub(crate) const OLDEST: &str = env!("CARGO_PKG_RUST_VERSION");

/// Returns a command that starts a program of the oldest toolchain, or a message that this toolchain
/// is missing. The toolchain may be installed as `1.x` or as `1.x.0`.
pub(crate) fn of_oldest(words: &[&str]) -> Result<Command, String> {
    let started = |name: &str| with(Command::new("rustup"), &["run", name]);
    for name in [OLDEST.to_owned(), format!("{OLDEST}.0")] {
        if succeeds(started(&name).args(["rustc", "--version"])) {
            return Ok(with(started(&name), words));
        }
    }
    Err(format!("no toolchain {OLDEST}; run `rustup toolchain install {OLDEST}`"))
}

/// Returns all extra checks, the quickest first.
pub(crate) fn all(root: &Path) -> Vec<Extra> {
    let licenses = Extra {
        name: "cargo deny check",
        command: if succeeds(Command::new(cargo()).args(["deny", "--version"])) {
            Ok(with(Command::new(cargo()), &["deny", "check"]))
        } else {
            Err("no cargo-deny; run `cargo install cargo-deny` to check licenses, advisories and \
                 sources of the dependencies"
                .into())
        },
        remedy: "see above; deny.toml lists what is allowed",
        pages: None,
    };
    let oldest = Extra {
        name: "check with the oldest toolchain",
        command: of_oldest(&["cargo", "check", "--workspace"]),
        remedy: "use only features of that toolchain, or raise rust-version in Cargo.toml and note it \
                 in CHANGELOG.md",
        pages: None,
    };
    let own = || std::env::current_exe().map(Command::new).map_err(|error| error.to_string());
    let bundle = Extra {
        name: "cargo xtask bundle check",
        command: Bundle::find(root)
            .and_then(|_| own())
            .map(|command| with(command, &["bundle", "check"])),
        remedy: "run `cargo xtask bundle` and commit the files that it writes",
        pages: None,
    };
    let web = Extra {
        name: "cargo xtask web",
        command: web::Build::find(root).and_then(|_| own()).map(|command| with(command, &["web"])),
        remedy: "see the error above",
        pages: None,
    };
    let reports = browser::find(root, browser::REPORTS).map(|check| Extra {
        name: "node crates/report/tests/browser/check.mjs",
        command: check.command(),
        remedy: "see above",
        pages: Some(check),
    });
    // This check uses the module and the page that `cargo xtask web` has built before.
    let engine = browser::find(root, browser::ENGINE).map(|check| Extra {
        name: "node crates/web/tests/check.mjs",
        command: web::Build::find(root).and_then(|_| check.command()).map(|mut command| {
            command.env("ENGINE", web::module(root)).env("PAGE", web::page(root));
            command.env("PAGE_ES", web::spanish(root));
            command
        }),
        remedy: "see above",
        pages: Some(check),
    });
    let package = Extra {
        name: "tests of the Python package",
        command: python::find(root),
        remedy: "see above; `cargo xtask python` runs this step alone, `cargo xtask python heavy` also the tests that need \
                 ObsPy, OpenQuake, Pelicun, Dask and Slurm",
        pages: None,
    };
    [licenses, oldest, bundle, web]
        .into_iter()
        .chain([package])
        .chain(engine)
        .chain(reports)
        .collect()
}

fn with(mut command: Command, words: &[&str]) -> Command {
    command.args(words);
    command
}

/// Runs a command, and returns `true` if the command exists and succeeds.
fn succeeds(command: &mut Command) -> bool {
    let status = command.stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}
