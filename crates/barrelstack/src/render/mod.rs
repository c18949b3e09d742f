//! A run as files for papers, films and ParaView, in one folder.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use barrelstack_report::{Attachment, Film, markdown, paraview};

use crate::export::ExportError;
use crate::report;
use crate::run::Run;
use crate::summary::Summary;

/// What can be rendered; each part has a folder of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// `figures/`: every figure and table of the report as SVG and CSV; `report.md` beside it.
    Figures,
    /// `frames/`: numbered pictures of one size, and `times.csv` with the time of each.
    Frames,
    /// `paraview/`: bodies and contact forces over time; `stack.pvd` is the file to open.
    Paraview,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 3] = [Self::Figures, Self::Frames, Self::Paraview];

    /// The name of its folder.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Figures => "figures",
            Self::Frames => "frames",
            Self::Paraview => "paraview",
        }
    }
}

/// Kinds of files that rendering writes into its folders, and may remove from them.
const KINDS: [&str; 4] = ["svg", "csv", "vtp", "pvd"];

/// A folder that is ready to take rendered parts.
#[derive(Clone, Debug)]
pub struct RenderFolder {
    path: PathBuf,
    parts: Vec<Part>,
}

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rendered {
    /// The part.
    pub part: Part,
    /// Its folder.
    pub folder: PathBuf,
    /// Count of its files.
    pub files: usize,
}

impl RenderFolder {
    /// Checks a folder before the work is done; makes and removes nothing yet.
    ///
    /// # Errors
    /// When a part's folder holds files of an earlier rendering and `overwrite` is not set, or
    /// when something that should be a folder is a file.
    pub fn prepare(path: &Path, parts: &[Part], overwrite: bool) -> Result<Self, ExportError> {
        let folders = parts.iter().map(|part| path.join(part.folder()));
        for folder in std::iter::once(path.to_owned()).chain(folders) {
            if folder.exists() && !folder.is_dir() {
                return Err(ExportError::Write {
                    path: folder,
                    reason: "it is a file, not a folder".into(),
                });
            }
        }
        let folder = Self { path: path.to_owned(), parts: parts.to_vec() };
        if !overwrite {
            for part in parts {
                if let Some(file) = folder.earlier(*part)?.first() {
                    let file = file.strip_prefix(path).unwrap_or(file).display().to_string();
                    return Err(ExportError::Occupied { folder: path.to_owned(), file });
                }
            }
        }
        Ok(folder)
    }

    /// Writes all parts; `rate` (1/s of the run's time) is that of pictures and ParaView times.
    /// Files of an earlier rendering in the folders of these parts are removed first, so that a
    /// shorter run leaves no frames of a longer one.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn write(
        &self,
        run: &Run,
        summary: &Summary,
        rate: f64,
    ) -> Result<Vec<Rendered>, ExportError> {
        let scene = report::scene(run);
        let mut written = Vec::new();
        for &part in &self.parts {
            let folder = self.path.join(part.folder());
            std::fs::create_dir_all(&folder).map_err(|error| refused(&folder, &error))?;
            for file in self.earlier(part)? {
                std::fs::remove_file(&file).map_err(|error| refused(&file, &error))?;
            }
            let files = match part {
                Part::Figures => {
                    let bundle = markdown(&report::document(run, summary), part.folder());
                    put(&self.path.join("report.md"), bundle.text.as_bytes())?;
                    write_all(&folder, &bundle.files)?
                }
                Part::Frames => frames(&folder, &Film::of_run(scene.clone(), rate))?,
                Part::Paraview => write_all(&folder, &paraview(&scene, rate))?,
            };
            written.push(Rendered { part, folder, files });
        }
        Ok(written)
    }

    /// Files in the folder of a part that an earlier rendering wrote, sorted.
    fn earlier(&self, part: Part) -> Result<Vec<PathBuf>, ExportError> {
        let folder = self.path.join(part.folder());
        if !folder.exists() {
            return Ok(Vec::new());
        }
        let entries = std::fs::read_dir(&folder).map_err(|error| refused(&folder, &error))?;
        let mut files = Vec::new();
        for entry in entries {
            let path = entry.map_err(|error| refused(&folder, &error))?.path();
            let kind = path.extension().and_then(|kind| kind.to_str()).unwrap_or_default();
            if path.is_file() && KINDS.contains(&kind) {
                files.push(path);
            }
        }
        files.sort();
        Ok(files)
    }
}

/// Pictures one after the other, so that only one of them is in memory.
fn frames(folder: &Path, film: &Film) -> Result<usize, ExportError> {
    let digits = film.len().to_string().len().max(4);
    let mut times = String::from("file,time (s)\n");
    let mut count = 0;
    for at in 0..film.len() {
        let (Some(svg), Some(time)) = (film.svg(at), film.time(at)) else { continue };
        let name = format!("frame-{:0digits$}.svg", at + 1);
        put(&folder.join(&name), svg.as_bytes())?;
        // Writing to a String cannot fail.
        let _ = writeln!(times, "{name},{time}");
        count += 1;
    }
    put(&folder.join("times.csv"), times.as_bytes())?;
    Ok(count + 1)
}

fn write_all(folder: &Path, files: &[Attachment]) -> Result<usize, ExportError> {
    for file in files {
        put(&folder.join(&file.name), &file.bytes)?;
    }
    Ok(files.len())
}

fn put(path: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    std::fs::write(path, bytes).map_err(|error| refused(path, &error))
}

fn refused(path: &Path, error: &std::io::Error) -> ExportError {
    ExportError::Write { path: path.to_owned(), reason: error.to_string() }
}
