//! Passes the commit of the sources to the program.
//!
//! The variable `BARRELSTACK_COMMIT` names the commit; without it, git does where the sources are a
//! clone. Sources from an archive have no commit.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-env-changed=BARRELSTACK_COMMIT");
    let commit = std::env::var("BARRELSTACK_COMMIT").ok().or_else(of_git).unwrap_or_default();
    println!("cargo::rustc-env=BARRELSTACK_COMMIT={}", commit.trim());
}

/// Returns the commit of the clone; `None` where there is no git, or where the sources are part of
/// another repository.
fn of_git() -> Option<String> {
    let root = Path::new("../..");
    if !root.join(".git").exists() {
        return None;
    }
    // In a worktree, these files are not in the folder `.git`.
    for file in ["HEAD", "logs/HEAD"] {
        let path = git(&["rev-parse", "--git-path", file])?;
        if Path::new(path.trim_end()).exists() {
            println!("cargo::rerun-if-changed={}", path.trim_end());
        }
    }
    git(&["rev-parse", "--short=12", "HEAD"])
}

/// Returns what git prints; `None` if it fails.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}
