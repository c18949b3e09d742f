//! Checks that need more than the toolchain: done where that is at hand, skipped in so many words elsewhere.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::browser;
use crate::steps::cargo;

/// A check that not every machine can do.
pub(crate) struct Extra {
    /// What is announced.
    pub(crate) name: &'static str,
    /// The command, or what is missing and how to come by it.
    pub(crate) command: Result<Command, String>,
    /// The next move after a failure.
    pub(crate) remedy: &'static str,
    /// Pages that are made by the program, which is built first.
    pub(crate) pages: Option<browser::Check>,
}

/// The oldest toolchain that builds the workspace: `rust-version` in `Cargo.toml`.
const OLDEST: &str = env!("CARGO_PKG_RUST_VERSION");

/// The target of browsers.
const BROWSER_TARGET: &str = "wasm32-unknown-unknown";

/// All of them, the quickest first.
pub(crate) fn all(root: &Path) -> Vec<Extra> {
    let licenses = Extra {
        name: "cargo deny check",
        command: if succeeds(Command::new(cargo()).args(["deny", "--version"])) {
            Ok(with(Command::new(cargo()), &["deny", "check"]))
        } else {
            Err("no cargo-deny; type `cargo install cargo-deny` to check licenses, advisories and \
                 sources of what is built in"
                .into())
        },
        remedy: "see above; what is allowed stands in deny.toml",
        pages: None,
    };
    let oldest = Extra {
        name: "check with the oldest toolchain",
        command: if succeeds(Command::new("rustup").args(["run", OLDEST, "rustc", "--version"])) {
            Ok(with(Command::new("rustup"), &["run", OLDEST, "cargo", "check", "--workspace"]))
        } else {
            Err(format!("no toolchain {OLDEST}; type `rustup toolchain install {OLDEST}`"))
        },
        remedy: "write what that toolchain knows, or raise rust-version in Cargo.toml and say so in \
                 CHANGELOG.md",
        pages: None,
    };
    let libraries = ["dynamics", "motion", "fragility", "input", "report"];
    let mut check = with(Command::new(cargo()), &["check", "--target", BROWSER_TARGET]);
    check.args(libraries.map(|library| format!("--package=barrelstack-{library}")));
    check.arg("--package=barrelstack");
    let browser = Extra {
        name: "check the libraries for wasm32-unknown-unknown",
        command: if has_target() {
            Ok(check)
        } else {
            Err(format!("no target {BROWSER_TARGET}; type `rustup target add {BROWSER_TARGET}`"))
        },
        remedy: "see the error above",
        pages: None,
    };
    let pages = browser::find(root).map(|check| Extra {
        name: browser::NAME,
        command: check.command(),
        remedy: "see above",
        pages: Some(check),
    });
    [licenses, oldest, browser].into_iter().chain(pages).collect()
}

fn with(mut command: Command, words: &[&str]) -> Command {
    command.args(words);
    command
}

/// Whether a command is there and answers.
fn succeeds(command: &mut Command) -> bool {
    let status = command.stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

/// Whether the standard library for browsers is installed.
fn has_target() -> bool {
    let mut command = with(Command::new("rustc"), &["--print", "target-libdir"]);
    let output = command.args(["--target", BROWSER_TARGET]).output();
    output.is_ok_and(|output| Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir())
}
