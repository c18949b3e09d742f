//! Builds the example programs in the READMEs of some crates, each in an empty target folder, and measures the CPU
//! time.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, ensure};

use crate::dist::folder;
use crate::python::checked;
use crate::steps::cargo;

/// Programs to build: folder of the crate whose README contains the program, `true` to build it with the default
/// features, and maximum CPU time (s) allowed for the build.
///
/// `docs/install.md` states the measured times.
const PROGRAMS: [(&str, bool, f64); 4] = [
    ("dynamics", true, 60.0),
    ("motion", true, 60.0),
    ("stack", false, 60.0),
    ("stack", true, 90.0),
];

/// Builds the program of each README in the dev profile, prints the CPU time, and runs the program.
///
/// The target folder is empty at first, as for a new user, so the CPU time includes the dependencies.
pub(crate) fn measure(root: &Path) -> anyhow::Result<()> {
    for (name, default, most) in PROGRAMS {
        let readme = fs::read_to_string(root.join("crates").join(name).join("README.md"))?;
        let program = readme.split("```rust\n").nth(1).and_then(|rest| rest.split("```").next());
        let program = program.with_context(|| format!("no program in the README of {name}"))?;
        let here = folder(root).join("programs").join(name);
        if here.exists() {
            fs::remove_dir_all(&here)?;
        }
        fs::create_dir_all(here.join("src"))?;
        fs::write(here.join("src/main.rs"), program)?;
        let path = root.join("crates").join(name);
        let manifest = format!(
            "[package]\nname = \"program\"\nedition = \"2024\"\n[dependencies]\nbarrelstack-{name} = {{ path = {:?}, \
             default-features = {default} }}\n[workspace]\n",
            path.display().to_string()
        );
        fs::write(here.join("Cargo.toml"), manifest)?;
        fs::copy(root.join("Cargo.lock"), here.join("Cargo.lock"))?;
        let before = children()?;
        let mut build = Command::new(cargo());
        build.args(["build", "--quiet"]).current_dir(&here);
        build.env("CARGO_TARGET_DIR", here.join("target"));
        checked(&mut build, "the build")?;
        let seconds = children()? - before;
        let lines = program.lines().count();
        let features = if default { "" } else { " without its default features" };
        println!("barrelstack-{name}{features}: {lines} lines, {seconds:.1} CPU seconds");
        ensure!(seconds <= most, "more than {most} CPU seconds");
        let binary = here.join("target/debug/program");
        checked(&mut Command::new(binary), "the program")?;
        fs::remove_dir_all(here.join("target"))?;
    }
    Ok(())
}

/// Returns the CPU time (s) of all processes that this one has started and that have ended; Linux only.
fn children() -> anyhow::Result<f64> {
    let text =
        fs::read_to_string("/proc/self/stat").context("CPU time is measured on Linux only")?;
    let fields: Vec<&str> =
        text.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    // The sixteenth and seventeenth field of the file, in ticks of 10 ms; the first two fields end at the parenthesis.
    let ticks = |at: usize| fields.get(at).and_then(|field| field.parse::<f64>().ok());
    Ok((ticks(13).context("no time")? + ticks(14).context("no time")?) / 100.0)
}
