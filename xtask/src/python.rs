//! The Python package: built by pip into an environment of its own, tested there, its site built.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};

use crate::steps::{build_program, cargo, program, target};

/// What the tests need beside the package.
const TESTS: [&str; 16] = [
    "maturin>=1.9,<2",
    "numpy",
    "pytest",
    "pytest-xdist",
    "mypy",
    "typing_extensions",
    "polars",
    "pyarrow",
    "pandas",
    "matplotlib",
    "pint",
    "nbclient",
    "nbformat",
    "ipykernel",
    "mkdocs>=1.6,<2",
    "distributed",
];

/// What some of them need that takes long to install.
const HEAVY: [&str; 3] = ["obspy", "dask-jobqueue", "pyright"];

/// Pelicun, and the packages that `OpenQuake` imports; its full list would have pip build GDAL.
const OTHERS: [&str; 14] = [
    "alpha_shapes",
    "decorator",
    "django>=4.2,<5",
    "docutils",
    "fiona",
    "geopandas",
    "h3",
    "h5py",
    "numba",
    "pelicun",
    "psutil",
    "pyzmq",
    "requests",
    "toml",
];

/// The step of the test command, where there is a Python; else what is missing.
pub(crate) fn find(root: &Path) -> Result<Command, String> {
    if !root.join("pyproject.toml").is_file() {
        return Err("there is no pyproject.toml".to_owned());
    }
    interpreter()?;
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut command = Command::new(own);
    command.arg("python");
    Ok(command)
}

/// A Python that makes environments, 3.10 or later.
fn interpreter() -> Result<&'static str, String> {
    let check = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))";
    let answers = |name: &&&str| {
        let run = Command::new(**name).args(["-c", check]).stderr(Stdio::null()).status();
        run.is_ok_and(|status| status.success())
    };
    ["python3", "python"].iter().find(answers).copied().ok_or_else(|| {
        "no Python 3.10 or later with venv; install one to build and test the Python package"
            .to_owned()
    })
}

/// Builds and tests; with `heavy` also what takes long to install, with `site` the site alone.
pub(crate) fn run(root: &Path, what: Option<&str>) -> anyhow::Result<()> {
    let Some(python) = environment(root, what == Some("heavy"))? else {
        println!("skipped: pip cannot install maturin; is there a net?");
        println!("0 passed, 0 failed, 1 skipped");
        return Ok(());
    };
    // What numbers are held against; built already where the tests of the workspace ran before.
    build_program(root)?;
    checked(inside(&python).arg("docs/build.py").current_dir(root), "the site")?;
    if what == Some("site") {
        return Ok(());
    }
    let mut tests = inside(&python);
    tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "crates/python/tests"]);
    // Two files at a time: most tests wait for a single process.
    if installed(&python, "pytest-xdist") {
        tests.args(["-n", "2", "--dist", "loadfile"]);
    }
    tests.env("BARRELSTACK_COMMAND", program(root)).env("MPLBACKEND", "Agg").current_dir(root);
    if what != Some("heavy") {
        tests.args(["-m", "not heavy"]);
    }
    checked(&mut tests, "the tests of the package")?;
    if what == Some("heavy") { run_others(root) } else { Ok(()) }
}

/// Runs `OpenQuake` and Pelicun on exported files, from an environment of their own: Pelicun needs an older pandas.
fn run_others(root: &Path) -> anyhow::Result<()> {
    let python = environment_at(&target(root).join("python-others"))?;
    for words in [&OTHERS[..], &["--no-deps", "openquake-engine"]] {
        checked(pip(&python).args(words), "the installation of OpenQuake and Pelicun")?;
    }
    let mut tests = Command::new(cargo());
    tests.args(["test", "-p", "barrelstack-campaign", "--test", "all", "exports::"]);
    tests.args(["--", "--ignored", "--nocapture"]).current_dir(root);
    checked(tests.env("BARRELSTACK_PYTHON", python), "OpenQuake and Pelicun on exported files")
}

/// The Python of the environment in a folder, which is made if it is not there.
fn environment_at(folder: &Path) -> anyhow::Result<PathBuf> {
    let bin = if cfg!(windows) { "Scripts" } else { "bin" };
    let python = folder.join(bin).join(format!("python{}", std::env::consts::EXE_SUFFIX));
    if !python.is_file() {
        let base = interpreter().map_err(anyhow::Error::msg)?;
        checked(Command::new(base).args(["-m", "venv"]).arg(folder), "the environment")?;
    }
    Ok(python)
}

/// The environment with the package as it is now, kept from run to run; none without the net.
fn environment(root: &Path, heavy: bool) -> anyhow::Result<Option<PathBuf>> {
    let python = environment_at(&target(root).join("python"))?;
    let mut needed = TESTS.to_vec();
    if heavy {
        needed.extend(HEAVY);
    }
    let install = |words: &[&str]| {
        let status = pip(&python).args(words).current_dir(root).status();
        status.is_ok_and(|status| status.success())
    };
    for name in needed.iter().filter(|name| !installed(&python, name)) {
        if !install(&[*name]) {
            // Tests say by themselves what they lack.
            println!("pip cannot install {name}; is there a net?");
        }
    }
    if !installed(&python, "maturin") {
        return Ok(None);
    }
    // With the environment's own maturin, so that no net is asked for what is there.
    if !install(&["--no-build-isolation", "--no-deps", "--force-reinstall", "."]) {
        bail!("`pip install .` failed: see above");
    }
    Ok(Some(python))
}

/// Returns `true` if an environment has a package, so that the net is not needed for it.
fn installed(python: &Path, requirement: &str) -> bool {
    let name = requirement.split(['<', '>', '=']).next().unwrap_or(requirement);
    let show = ["-m", "pip", "--disable-pip-version-check", "show", "--quiet", name];
    let run = Command::new(python).args(show).stderr(Stdio::null()).status();
    run.is_ok_and(|status| status.success())
}

/// The installation command of an environment.
fn pip(python: &Path) -> Command {
    let mut pip = inside(python);
    pip.args(["-m", "pip", "--disable-pip-version-check", "install", "--quiet"]);
    pip
}

/// A Python of an environment, whose programs it finds before those of others.
fn inside(python: &Path) -> Command {
    let mut command = Command::new(python);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let own = python.parent().map(Path::to_path_buf);
    if let Ok(all) = std::env::join_paths(own.into_iter().chain(std::env::split_paths(&path))) {
        command.env("PATH", all);
    }
    command
}

fn checked(command: &mut Command, what: &str) -> anyhow::Result<()> {
    let status = command.status().with_context(|| format!("{what}: it does not start"))?;
    if !status.success() {
        bail!("{what} failed: see above");
    }
    Ok(())
}
