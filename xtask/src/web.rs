//! Builds the pages that contain the engine, in English and in Spanish.
//!
//! The engine is compiled to WebAssembly with the tools of this machine. The build fails if the engine imports a
//! function that the page does not provide.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail, ensure};

use crate::extra::OLDEST;
use crate::steps::{cargo, target};

/// Target triple of the engine, which runs in browsers.
const TARGET: &str = "wasm32-unknown-unknown";

/// Functions that the page provides; the engine may import no others.
const GIVEN: [&str; 1] = ["page.progress"];

/// Compiler for this target, which Debian's packages `rustc-web` and `libstd-rust-web-dev` install.
const DEBIAN: &str = "/usr/bin/rustc";

/// A build of the engine and its page that is possible with the tools of this machine.
pub(crate) struct Build {
    root: PathBuf,
    /// Linker, if the standard library of the target must be built from source; `None` if that library is installed.
    linker: Option<PathBuf>,
}

impl Build {
    /// Returns the build, or a message that names what is missing and how to install it.
    ///
    /// The build uses the installed standard library of the target. If there is none, the standard
    /// library is built from Debian's `rust-web-src`, with Debian's compiler and the linker of the
    /// toolchain.
    pub(crate) fn find(root: &Path) -> Result<Self, String> {
        let linker = if has_target() {
            None
        } else {
            Some(debian().ok_or_else(|| {
                format!(
                    "no target {TARGET}; run `rustup target add {TARGET}`, or install Debian's packages \
                     rustc-web, rust-web-src and libstd-rust-web-dev, version {OLDEST} or newer"
                )
            })?)
        };
        Ok(Self { root: root.to_path_buf(), linker })
    }

    /// Builds the page in each language with its engine, and prints their sizes.
    ///
    /// The English engine, which contains no translations, is built last, so it is the one that
    /// remains at the path [`module`].
    pub(crate) fn run(self) -> anyhow::Result<()> {
        self.page("es", &["--features", "languages"], &spanish(&self.root))?;
        self.page("en", &[], &page(&self.root))
    }

    /// Builds the page in a language.
    fn page(&self, language: &str, options: &[&str], page: &Path) -> anyhow::Result<()> {
        let mut command = Command::new(cargo());
        command.args(["build", "--package", "barrelstack-web", "--profile", "web"]);
        command.args(["--target", TARGET]).args(options).current_dir(&self.root);
        if let Some(linker) = &self.linker {
            command.args(["-Zbuild-std=std,panic_abort"]);
            command.env("RUSTC", DEBIAN).env("RUSTC_BOOTSTRAP", "1");
            command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
        }
        let status = command.status().context("cannot start cargo")?;
        ensure!(status.success(), "building the engine failed: see above");
        let file = module(&self.root);
        let bytes =
            std::fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
        let imported = imports(&bytes).context("the module cannot be read")?;
        if let Some(foreign) = imported.iter().find(|name| !GIVEN.contains(&name.as_str())) {
            bail!(
                "the module imports {foreign}, which the page does not provide: a dependency needs an \
                 operating system; build it without that feature"
            );
        }
        println!(
            "{}: {:.2} MB, imports {}",
            file.display(),
            megabytes(&bytes),
            imported.join(", ")
        );
        // The same packages as for the test `bits` in the release profile, so that both builds share dependencies.
        let packages = ["--package=barrelstack-library", "--package=barrelstack-web"];
        let mut build = Command::new(cargo());
        build.args(["build", "--quiet", "--release", "--example=page"]).args(packages);
        let status = build.current_dir(&self.root).status().context("cannot start cargo")?;
        ensure!(status.success(), "building the program that writes the page failed: see above");
        let writer = format!("page{}", std::env::consts::EXE_SUFFIX);
        let writer = target(&self.root).join("release/examples").join(writer);
        let status = Command::new(writer)
            .args([PARTS, TITLE, language])
            .args([file.as_path(), page])
            .current_dir(&self.root)
            .status()
            .context("cannot start the program that writes the page")?;
        ensure!(status.success(), "writing the page failed: see above");
        let bytes =
            std::fs::read(page).with_context(|| format!("cannot read {}", page.display()))?;
        println!("{}: {:.3} MB, opens in any browser", page.display(), megabytes(&bytes));
        Ok(())
    }
}

/// Folder of the parts of the page, in the repository.
const PARTS: &str = "crates/web/page";

/// Title of the page.
const TITLE: &str = "barrelstack: wine barrels in earthquakes";

/// Returns the path of the page.
pub(crate) fn page(root: &Path) -> PathBuf {
    target(root).join("barrelstack.html")
}

/// Returns the path of the page in Spanish.
pub(crate) fn spanish(root: &Path) -> PathBuf {
    target(root).join("barrelstack-es.html")
}

/// Returns the path of the WebAssembly module.
pub(crate) fn module(root: &Path) -> PathBuf {
    target(root).join(TARGET).join("web").join("barrelstack_web.wasm")
}

#[expect(clippy::cast_precision_loss, reason = "a size in print")]
fn megabytes(bytes: &[u8]) -> f64 {
    bytes.len() as f64 * 1e-6
}

/// Returns `true` if the standard library of [`TARGET`] is installed.
fn has_target() -> bool {
    let found = said(Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]));
    found.is_some_and(|folder| Path::new(&folder).is_dir())
}

/// Returns the linker of the toolchain, if Debian's compiler and the sources of its standard library are installed.
fn debian() -> Option<PathBuf> {
    let version = said(Command::new(DEBIAN).arg("--version"))?;
    let version = version.split_whitespace().nth(1)?;
    let minor = |version: &str| version.split('.').nth(1)?.parse::<u32>().ok();
    let sources = said(Command::new(DEBIAN).args(["--print", "sysroot"]))?;
    let sources = Path::new(&sources).join("lib/rustlib/src/rust/library/Cargo.lock");
    let own = said(Command::new("rustc").args(["--print", "sysroot"]))?;
    let host = said(Command::new("rustc").args(["--print", "host-tuple"]))?;
    let linker = Path::new(&own).join("lib/rustlib").join(host).join("bin/rust-lld");
    let there = minor(version)? >= minor(OLDEST)? && sources.is_file() && linker.is_file();
    there.then_some(linker)
}

/// Returns the first line that a command prints; `None` if the command does not exist or fails.
fn said(command: &mut Command) -> Option<String> {
    let output = command.stderr(Stdio::null()).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    Some(text.lines().next()?.to_owned()).filter(|_| output.status.success())
}

/// Returns the imports of a WebAssembly module, as `module.name`; `None` if the bytes are not a module.
///
/// Spec: WebAssembly 2.0, sections 5.5.2 and 5.5.5.
fn imports(bytes: &[u8]) -> Option<Vec<String>> {
    /// Identifier of the import section.
    const IMPORTS: u8 = 2;
    /// Kind of an imported function; the index of its type follows.
    const FUNCTION: u8 = 0;
    let mut rest = bytes.strip_prefix(b"\0asm\x01\0\0\0")?;
    while let Some((kind, after)) = rest.split_first() {
        rest = after;
        let length = number(&mut rest)?;
        let (mut section, later) = rest.split_at_checked(length)?;
        rest = later;
        if *kind != IMPORTS {
            continue;
        }
        let mut found = Vec::new();
        for _ in 0..number(&mut section)? {
            let (module, name) = (word(&mut section)?, word(&mut section)?);
            found.push(format!("{module}.{name}"));
            let (kind, after) = section.split_first()?;
            section = after;
            if *kind != FUNCTION {
                // An imported memory or table is refused by its name, so the rest of the list does not matter.
                return Some(found);
            }
            number(&mut section)?;
        }
        return Some(found);
    }
    Some(Vec::new())
}

/// Reads an unsigned LEB128 number: seven bits per byte, the lowest first.
fn number(bytes: &mut &[u8]) -> Option<usize> {
    let mut value = 0;
    for shift in (0..35).step_by(7) {
        let (byte, after) = bytes.split_first()?;
        *bytes = after;
        value |= usize::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

/// Reads a UTF-8 string that is preceded by its length in bytes.
fn word(bytes: &mut &[u8]) -> Option<String> {
    let length = number(bytes)?;
    let (text, after) = bytes.split_at_checked(length)?;
    *bytes = after;
    String::from_utf8(text.to_vec()).ok()
}

#[cfg(test)]
mod tests {
    use super::imports;

    #[test]
    fn an_import_that_no_page_provides_is_listed() {
        // One type () -> (), and two imported functions: "page.progress", "env.now".
        let mut module = b"\0asm\x01\0\0\0\x01\x04\x01\x60\0\0\x02\x1b\x02".to_vec();
        module.extend(b"\x04page\x08progress\0\0\x03env\x03now\0\0");
        assert_eq!(imports(&module).unwrap(), ["page.progress", "env.now"]);
        assert_eq!(imports(b"\0asm\x01\0\0\0").unwrap(), [""; 0]);
        assert_eq!(imports(&module[..20]), None);
        assert_eq!(imports(b"MZ"), None);
    }
}
