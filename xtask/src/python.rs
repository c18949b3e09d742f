//! Builds the Python package with pip in a virtual environment, tests it there, and builds its documentation site.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};

use crate::steps::{build_program, cargo, program, target};

/// Packages that the tests need.
const TESTS: [&str; 21] = [
    "maturin>=1.9,<2",
    "numpy",
    "openpyxl",
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
    "gymnasium",
    "joblib",
    "scipy",
    "xarray",
];

/// Packages that the research tasks on the documentation site import. A task is shown, but not executed, if a package
/// that it imports is not installed.
const RESEARCH: [&str; 6] = ["SALib", "joblib", "netCDF4", "scipy", "statsmodels", "xarray"];

/// Packages that only the heavy tests need, because their installation takes long.
const HEAVY: [&str; 3] = ["obspy", "dask-jobqueue", "pyright"];

/// Pelicun, and the packages that `OpenQuake` imports.
///
/// `OpenQuake` is installed without the dependencies that its package lists, because pip would have
/// to build GDAL for them.
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

/// Returns the command that builds and tests the package, or a message that names what is missing.
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

/// Returns the name of a Python of version 3.10 or later that can create virtual environments.
pub(crate) fn interpreter() -> Result<&'static str, String> {
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

/// Builds the package and runs its tests, which also build its documentation site.
///
/// If `what` is `heavy`, also runs the tests whose packages take long to install. If `what` is `site`, builds the
/// package and the site, and runs no tests.
pub(crate) fn run(root: &Path, what: Option<&str>) -> anyhow::Result<()> {
    let Some(python) = environment(root, what == Some("heavy"))? else {
        println!("skipped: pip cannot install maturin; is there a network connection?");
        println!("0 passed, 0 failed, 1 skipped");
        return Ok(());
    };
    // The tests compare the numbers of the package with those of the program.
    build_program(root)?;
    if what == Some("site") {
        return checked(inside(&python).arg("docs/build.py").current_dir(root), "the site");
    }
    let mut tests = inside(&python);
    tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "crates/python/tests"]);
    // Two files at a time, since most tests keep only one core busy.
    if installed(&python, "pytest-xdist") {
        tests.args(["-n", "2", "--dist", "loadfile"]);
    }
    // The tests of the site build the site with its notebooks, in the same folder as the task `site`.
    tests.env("BARRELSTACK_COMMAND", program(root)).env("BARRELSTACK_SITE", target(root));
    tests.env("MPLBACKEND", "Agg").current_dir(root);
    if what != Some("heavy") {
        tests.args(["-m", "not heavy"]);
    }
    checked(&mut tests, "the tests of the package")?;
    if what == Some("heavy") { run_others(root) } else { Ok(()) }
}

/// Runs `OpenQuake` and Pelicun on exported files, in a second environment, because Pelicun needs an older version of
/// pandas than the tests of the package.
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

/// Returns the Python interpreter of the virtual environment in a folder, and creates the
/// environment if it does not exist.
pub(crate) fn environment_at(folder: &Path) -> anyhow::Result<PathBuf> {
    let bin = if cfg!(windows) { "Scripts" } else { "bin" };
    let python = folder.join(bin).join(format!("python{}", std::env::consts::EXE_SUFFIX));
    if !python.is_file() {
        let base = interpreter().map_err(anyhow::Error::msg)?;
        checked(Command::new(base).args(["-m", "venv"]).arg(folder), "the environment")?;
    }
    Ok(python)
}

/// Installs the package, as built from the sources, into the virtual environment. Returns the Python
/// interpreter of the environment; `None` if maturin cannot be installed.
///
/// The environment is kept between runs.
fn environment(root: &Path, heavy: bool) -> anyhow::Result<Option<PathBuf>> {
    let python = environment_at(&target(root).join("python"))?;
    let mut needed = [&TESTS[..], &RESEARCH].concat();
    if heavy {
        needed.extend(HEAVY);
    }
    let install = |words: &[&str]| {
        let status = pip(&python).args(words).current_dir(root).status();
        status.is_ok_and(|status| status.success())
    };
    for name in needed.iter().filter(|name| !installed(&python, name)) {
        if !install(&[*name]) {
            // Tests report by themselves which packages they miss.
            println!("pip cannot install {name}; is there a network connection?");
        }
    }
    if !installed(&python, "maturin") {
        return Ok(None);
    }
    // The environment has maturin already, so pip needs no network to build the package.
    if !install(&["--no-build-isolation", "--no-deps", "--force-reinstall", "."]) {
        bail!("`pip install .` failed: see above");
    }
    Ok(Some(python))
}

/// Returns `true` if an environment contains a package.
fn installed(python: &Path, requirement: &str) -> bool {
    let name = requirement.split(['<', '>', '=']).next().unwrap_or(requirement);
    let show = ["-m", "pip", "--disable-pip-version-check", "show", "--quiet", name];
    let run = Command::new(python).args(show).stderr(Stdio::null()).status();
    run.is_ok_and(|status| status.success())
}

/// Returns a `pip install` command for the environment of a Python interpreter.
pub(crate) fn pip(python: &Path) -> Command {
    let mut pip = inside(python);
    pip.args(["-m", "pip", "--disable-pip-version-check", "install", "--quiet"]);
    pip
}

/// Returns a command that starts a Python interpreter. The folder of the interpreter, which contains
/// the programs of its environment, comes first on the search path.
pub(crate) fn inside(python: &Path) -> Command {
    let mut command = Command::new(python);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let own = python.parent().map(Path::to_path_buf);
    if let Ok(all) = std::env::join_paths(own.into_iter().chain(std::env::split_paths(&path))) {
        command.env("PATH", all);
    }
    command
}

pub(crate) fn checked(command: &mut Command, what: &str) -> anyhow::Result<()> {
    let status = command.status().with_context(|| format!("cannot start {what}"))?;
    if !status.success() {
        bail!("{what} failed: see above");
    }
    Ok(())
}
