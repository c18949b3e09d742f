//! The bundle of three.js in report pages: packed by esbuild from a pinned release, and compared with the committed
//! bundle.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, ensure};

/// Folder of the modules and the entry point of the bundle.
const SOURCE: &str = "crates/report/bundle";

/// Folder of the committed bundle that pages include.
const KEPT: &str = "crates/report/assets/vendor";

/// Command that installs the modules, to be run in the root of the repository.
const INSTALL: &str = "npm ci --prefix crates/report/bundle";

/// The bundle of three.js, ready to be packed.
pub(crate) struct Bundle {
    root: PathBuf,
}

impl Bundle {
    /// Returns the bundle, or a message that names what is missing and how to install it.
    pub(crate) fn find(root: &Path) -> Result<Self, String> {
        let modules = Command::new("node")
            .args(["--eval", "require.resolve('esbuild'), require.resolve('three')"])
            .current_dir(root.join(SOURCE))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        match modules {
            Ok(status) if status.success() => Ok(Self { root: root.to_path_buf() }),
            Ok(_) => Err(format!("the modules of the bundle are not installed; run `{INSTALL}`")),
            Err(_) => Err("no node on the PATH; install Node.js 20 or newer".into()),
        }
    }

    /// Packs the bundle, and writes the bundle and its license to the folder from which pages
    /// include them.
    pub(crate) fn write(&self) -> anyhow::Result<()> {
        for (name, bytes) in self.packed()? {
            let path = self.root.join(KEPT).join(name);
            std::fs::write(&path, &bytes)
                .with_context(|| format!("cannot write {}", path.display()))?;
            println!("{}: {} bytes", path.display(), bytes.len());
        }
        Ok(())
    }

    /// Compares the bundle and its license with the committed files, byte for byte.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        for (name, bytes) in self.packed()? {
            let path = self.root.join(KEPT).join(name);
            let kept =
                std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
            ensure!(kept == bytes, "{} differs from its sources", path.display());
            println!("{}: {} bytes, equal to its sources", path.display(), bytes.len());
        }
        Ok(())
    }

    /// Packs the bundle; returns the names and contents of the files.
    fn packed(&self) -> anyhow::Result<[(&'static str, Vec<u8>); 2]> {
        let folder = self.root.join(SOURCE);
        let output = Command::new("node")
            .arg("pack.mjs")
            .current_dir(&folder)
            .stderr(Stdio::inherit())
            .output()
            .context("cannot start node")?;
        ensure!(output.status.success(), "packing the bundle failed: see above");
        let license = folder.join("node_modules/three/LICENSE");
        let license = std::fs::read(&license)
            .with_context(|| format!("cannot read {}", license.display()))?;
        Ok([("three.iife.min.js", output.stdout), ("three-LICENSE", license)])
    }
}
