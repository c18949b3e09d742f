//! `barrelstack study export`: fragility and loss for other programs.

use std::path::PathBuf;

use anyhow::Context as _;
use barrelstack_campaign::decision::{Request, decide_folder, export as exported};

use crate::printer;
use crate::store::store;

/// Arguments of `study export`.
#[derive(Debug, clap::Args)]
pub(super) struct ExportArgs {
    /// A folder that `barrelstack study` wrote.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Folder for the files.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Name of the stack in the other program (taxonomy in OpenQuake, id of the component in
    /// Pelicun).
    #[arg(long, value_name = "NAME", default_value = "wine.barrel.stack")]
    asset: String,
}

/// Writes the files, and prints a list of the results that the files do not contain.
pub(super) fn export(args: &ExportArgs) -> anyhow::Result<()> {
    let (decision, made) = decide_folder(&args.folder, &Request::default())?;
    let found = exported(&decision, &made, &args.asset)?;
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot create {}", args.out.display()))?;
    for (name, text) in &found.files {
        let path = args.out.join(name);
        store(&path, text.as_bytes())?;
        printer::lines([path.display().to_string()])?;
    }
    found.notes.iter().for_each(|note| printer::warning(note));
    Ok(())
}
