//! The bundle of three.js in pages: packed by esbuild from a pinned release, and compared with the one that is kept.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, ensure};

/// Where modules and entry of the bundle are.
const SOURCE: &str = "crates/report/bundle";

/// Where pages take the bundle from.
const KEPT: &str = "crates/report/assets/vendor";

/// Command that installs the modules, typed in the root of the repository.
const INSTALL: &str = "npm ci --prefix crates/report/bundle";

/// Packs the bundle.
pub(crate) struct Bundle {
    root: PathBuf,
}

impl Bundle {
    /// Returns the bundle, or what is missing here and how to come by it.
    pub(crate) fn find(root: &Path) -> Result<Self, String> {
        let modules = Command::new("node")
            .args(["--eval", "require.resolve('esbuild'), require.resolve('three')"])
            .current_dir(root.join(SOURCE))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        match modules {
            Ok(status) if status.success() => Ok(Self { root: root.to_path_buf() }),
            Ok(_) => Err(format!("the modules of the bundle are not installed; type `{INSTALL}`")),
            Err(_) => Err("no node on the PATH; install Node.js 20 or newer".into()),
        }
    }

    /// Writes bundle and license to where pages take them from.
    pub(crate) fn write(&self) -> anyhow::Result<()> {
        for (name, bytes) in self.packed()? {
            let path = self.root.join(KEPT).join(name);
            std::fs::write(&path, &bytes)
                .with_context(|| format!("cannot write {}", path.display()))?;
            println!("{}: {} bytes", path.display(), bytes.len());
        }
        Ok(())
    }

    /// Compares bundle and license with those that are kept, byte for byte.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        for (name, bytes) in self.packed()? {
            let path = self.root.join(KEPT).join(name);
            let kept =
                std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
            ensure!(kept == bytes, "{} differs from its sources", path.display());
            println!("{}: {} bytes, as rebuilt", path.display(), bytes.len());
        }
        Ok(())
    }

    /// Packs the bundle; returns the files with their names.
    fn packed(&self) -> anyhow::Result<[(&'static str, Vec<u8>); 2]> {
        let folder = self.root.join(SOURCE);
        let output = Command::new("node")
            .arg("pack.mjs")
            .current_dir(&folder)
            .stderr(Stdio::inherit())
            .output()
            .context("node does not start")?;
        ensure!(output.status.success(), "the bundle is not packed: see above");
        let license = folder.join("node_modules/three/LICENSE");
        let license = std::fs::read(&license)
            .with_context(|| format!("cannot read {}", license.display()))?;
        Ok([("three.iife.min.js", output.stdout), ("three-LICENSE", license)])
    }
}
