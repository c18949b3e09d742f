//! Rendering of a run to files: figures, report, animations, frames and ParaView series.

mod terminal;

use std::cell::LazyCell;
use std::fmt::{Display, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use barrelstack_report::{
    Animation, Attachment, Document, Film, Format, Language, Paper, Scene, document_pdf, figures,
    markdown, paraview,
};

use crate::export::ExportError;
use crate::pool;
use crate::report;
use crate::run::Run;
use crate::summary::Summary;
use barrelstack_input::system;

pub use terminal::{drift_line, final_picture};

/// A part of a rendering, with its own folder or file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// `figures/`: every figure of the report, with its numbers as CSV; also `report.md`.
    Figures,
    /// `report.pdf`: the report for printing.
    Report,
    /// `animation/`: the stack as a GIF and as an animated PNG.
    Animation,
    /// `frames/`: numbered pictures of equal size, and `times.csv` with the time of each picture.
    Frames,
    /// `paraview/`: bodies and contact forces over time; `stack.pvd` is the file to open.
    Paraview,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 5] =
        [Self::Figures, Self::Report, Self::Animation, Self::Frames, Self::Paraview];

    /// Returns the name of the part on the command line.
    pub fn name(self) -> &'static str {
        if self == Self::Report { "report" } else { self.place() }
    }

    /// Returns the name of the folder or file of the part.
    pub fn place(self) -> &'static str {
        match self {
            Self::Figures => "figures",
            Self::Report => "report.pdf",
            Self::Animation => "animation",
            Self::Frames => "frames",
            Self::Paraview => "paraview",
        }
    }
}

/// Options of a rendering.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// Formats of the figures besides SVG, which is always written. Frames are PNG if this list
    /// contains PNG, and SVG otherwise.
    pub formats: Vec<Format>,
    /// Resolution (dots per inch) of figures in PNG.
    pub dpi: f64,
    /// Paper size of the report.
    pub paper: Paper,
    /// Number of frames, and of ParaView time steps, per second of simulated time.
    pub rate: f64,
    /// Time interval (s) to render; `None` for the whole run.
    pub between: Option<[f64; 2]>,
    /// Length (pixels) of the longer side of animations.
    pub largest: u32,
    /// Language of the figures and of the report.
    pub language: Language,
}

impl Default for Rendering {
    fn default() -> Self {
        Self {
            formats: Format::ALL.to_vec(),
            dpi: 200.0,
            paper: Paper::A4,
            rate: 20.0,
            between: None,
            largest: 480,
            language: Language::English,
        }
    }
}

impl Rendering {
    /// Checks that a run that ends at `end_time` (s) can be rendered with these options; the error is a sentence for
    /// the user.
    ///
    /// # Errors
    /// When a number is out of range, or when the run ends before the interval begins.
    pub fn check(&self, end_time: f64) -> Result<(), String> {
        let expected =
            |what: &str, found: &dyn Display| Err(format!("expected {what}, found {found}"));
        if !(20.0..=1200.0).contains(&self.dpi) {
            return expected("20 to 1200 dots per inch, such as 300", &self.dpi);
        }
        if !(self.rate.is_finite() && self.rate > 0.0) {
            return expected("a number of frames per second above zero, such as 20", &self.rate);
        }
        if !(64..=4096).contains(&self.largest) {
            return expected("64 to 4096 pixels, such as 480", &self.largest);
        }
        match self.between {
            Some([from, to]) if !(from >= 0.0 && to > from) => Err(format!(
                "expected a start time of 0 s or more and a later end time, found {from} s and {to} s"
            )),
            Some([from, _]) if from > end_time => Err(format!(
                "the run ends at {end_time:.2} s, so there is nothing to render after {from} s; choose an earlier start"
            )),
            _ => Ok(()),
        }
    }
}

/// Extensions of the files that a rendering writes into its folders; only files with these
/// extensions are removed from the folders.
const KINDS: [&str; 7] = ["svg", "png", "pdf", "gif", "csv", "vtp", "pvd"];

/// Maximum frame rate (1/s) that viewers of animations support.
const FASTEST: f64 = 50.0;

/// Function that writes one file of a series.
pub type Put<'a> = &'a mut dyn FnMut(Attachment) -> Result<(), ExportError>;

/// Output folder of a rendering, which [`RenderFolder::prepare`] has checked.
#[derive(Clone, Debug)]
pub struct RenderFolder {
    path: PathBuf,
    parts: Vec<Part>,
    /// `true` if the files of an earlier rendering may be replaced.
    overwrite: bool,
}

/// The written files of one part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rendered {
    /// The part.
    pub part: Part,
    /// Folder or file of the part.
    pub place: PathBuf,
    /// Number of files written.
    pub files: usize,
}

impl RenderFolder {
    /// Checks a folder before the computation starts; creates and removes nothing yet.
    ///
    /// # Errors
    /// When the folder or file of a part exists from an earlier rendering and `overwrite` is not
    /// set, or when a path that should be a folder is a file.
    pub fn prepare(path: &Path, parts: &[Part], overwrite: bool) -> Result<Self, ExportError> {
        let folders = parts.iter().filter(|part| **part != Part::Report);
        let folders = folders.map(|part| path.join(part.place()));
        for folder in std::iter::once(path.to_owned()).chain(folders) {
            if folder.exists() && !folder.is_dir() {
                return Err(ExportError::write(&folder, "it is a file, not a folder"));
            }
        }
        let folder = Self { path: path.to_owned(), parts: parts.to_vec(), overwrite };
        if !overwrite {
            for part in parts {
                if let Some(file) = folder.earlier(*part)?.first() {
                    return Err(folder.occupied(file));
                }
            }
        }
        system::writable(path).map_err(|reason| ExportError::write(path, reason))?;
        Ok(folder)
    }

    /// Returns the error for a folder that already holds a file.
    fn occupied(&self, file: &Path) -> ExportError {
        let file = file.strip_prefix(&self.path).unwrap_or(file).display().to_string();
        ExportError::Occupied { folder: self.path.clone(), file }
    }

    /// Writes all parts.
    ///
    /// Files of an earlier rendering are first removed from the folders of these parts, so that no
    /// frames of a longer run remain beside those of a shorter run.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(
        &self,
        run: &Run,
        summary: &Summary,
        how: &Rendering,
    ) -> Result<Vec<Rendered>, ExportError> {
        let document = || report::document(run, summary);
        self.write_by(document, &report::scene(run), how, &mut |filmed, put| {
            paraview(filmed, how.rate).into_iter().try_for_each(put)
        })
    }

    /// Writes all parts like [`RenderFolder::write`], from a document, a scene, and a function that produces the
    /// ParaView series file by file, so that a long series need not fit into memory.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_by(
        &self,
        document: impl FnOnce() -> Document,
        scene: &Arc<Scene>,
        how: &Rendering,
        series: &mut dyn FnMut(&Scene, Put<'_>) -> Result<(), ExportError>,
    ) -> Result<Vec<Rendered>, ExportError> {
        let filmed = how
            .between
            .map_or_else(|| Arc::clone(scene), |[from, to]| Arc::new(scene.between(from, to)));
        let document = LazyCell::new(|| document().in_language(how.language));
        let mut written = Vec::new();
        for &part in &self.parts {
            written.push(self.whole(part, |place| match part {
                Part::Figures => {
                    let bundle = markdown(&document, part.place());
                    put(&self.path.join("report.md"), bundle.text.as_bytes())?;
                    Ok(write_all(place, &bundle.files)?
                        + write_figures(&document, place, &how.formats, how.dpi)?)
                }
                Part::Report => put(place, &document_pdf(&document, how.paper)),
                Part::Animation => animation(place, &filmed, how),
                Part::Frames => frames(place, &Film::of_run(Arc::clone(&filmed), how.rate), how),
                Part::Paraview => {
                    let mut files = 0;
                    series(&filmed, &mut |file| {
                        files += put(&place.join(&file.name), &file.bytes)?;
                        Ok(())
                    })?;
                    Ok(files)
                }
            })?);
        }
        Ok(written)
    }

    /// Writes a part by calling `write`, which returns the number of files; if writing fails,
    /// removes the files already written.
    fn whole(
        &self,
        part: Part,
        write: impl FnOnce(&Path) -> Result<usize, ExportError>,
    ) -> Result<Rendered, ExportError> {
        let place = self.cleared(part)?;
        match write(&place) {
            Ok(files) => Ok(Rendered { part, place, files }),
            Err(error) => {
                for file in self.earlier(part).unwrap_or_default() {
                    // A file that cannot be removed is left in place; the error of the write, which is returned, is
                    // more informative.
                    let _ = std::fs::remove_file(file);
                }
                if part != Part::Report {
                    let _ = std::fs::remove_dir(&place);
                }
                Err(error)
            }
        }
    }

    /// Creates the folder of a part, and removes the files of an earlier rendering from it.
    fn cleared(&self, part: Part) -> Result<PathBuf, ExportError> {
        let place = self.path.join(part.place());
        let folder = if part == Part::Report { "" } else { part.place() };
        system::folder_below(&self.path, Path::new(folder))
            .map_err(|error| ExportError::refused(&place, &error))?;
        let earlier = self.earlier(part)?;
        if let (false, Some(file)) = (self.overwrite, earlier.first()) {
            // Another rendering has written this file since the folder was checked.
            return Err(self.occupied(file));
        }
        for file in earlier {
            system::replaceable(&file)
                .and_then(|()| std::fs::remove_file(&file))
                .map_err(|error| ExportError::refused(&file, &error))?;
        }
        Ok(place)
    }

    /// Returns the files of an earlier rendering in the folder of a part, sorted.
    fn earlier(&self, part: Part) -> Result<Vec<PathBuf>, ExportError> {
        let place = self.path.join(part.place());
        let alone = match part {
            Part::Report => Some(place.clone()),
            Part::Figures => Some(self.path.join("report.md")),
            Part::Animation | Part::Frames | Part::Paraview => None,
        };
        let mut files = Vec::new();
        if let Some(alone) = alone {
            let name = alone.file_name().unwrap_or_default().to_os_string();
            // A killed rendering leaves an unfinished file beside the final one.
            let own = |path: &PathBuf| {
                *path == alone || system::is_unfinished(path, |whole| *whole == *name)
            };
            files.extend(entries(&self.path)?.into_iter().filter(own));
        }
        for path in entries(&place)? {
            let kind = path.extension().and_then(|kind| kind.to_str()).unwrap_or_default();
            let unfinished = system::is_unfinished(&path, |whole| {
                KINDS.iter().any(|kind| whole.ends_with(kind))
            });
            if path.is_file() && (KINDS.contains(&kind) || unfinished) {
                files.push(path);
            }
        }
        files.sort();
        Ok(files)
    }
}

/// Returns the paths in a folder; empty if the path is not a folder.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, ExportError> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let refused = |error| ExportError::refused(folder, &error);
    let found = std::fs::read_dir(folder).map_err(refused)?;
    found.map(|entry| Ok(entry.map_err(refused)?.path())).collect()
}

/// Writes the figures of a document in formats other than SVG, named like the SVG files, and
/// returns the number of files.
///
/// `dpi` (dots per inch) applies to pixel formats.
///
/// # Errors
/// When a file cannot be written.
pub fn write_figures(
    document: &Document,
    folder: &Path,
    formats: &[Format],
    dpi: f64,
) -> Result<usize, ExportError> {
    let mut count = 0;
    for (name, figure) in figures(document) {
        for format in formats.iter().filter(|format| **format != Format::Svg) {
            let file = format!("{name}.{}", format.extension());
            count += put(&folder.join(file), &figure.to_bytes(*format, dpi))?;
        }
    }
    Ok(count)
}

/// Writes the animation in both formats, from the same pictures.
fn animation(folder: &Path, scene: &Arc<Scene>, how: &Rendering) -> Result<usize, ExportError> {
    let film = Film::of_run(Arc::clone(scene), how.rate.min(FASTEST));
    let Some(animation) = Animation::of(&film, how.largest) else { return Ok(0) };
    Ok(put(&folder.join("stack.gif"), &animation.gif())?
        + put(&folder.join("stack.png"), &animation.apng())?)
}

/// Writes numbered pictures and the table of their times. All cores render, each of them one
/// picture at a time.
fn frames(folder: &Path, film: &Film, how: &Rendering) -> Result<usize, ExportError> {
    let digits = film.len().to_string().len().max(4);
    let pixels = how.formats.contains(&Format::Png);
    let name = |at: usize| {
        let format = if pixels { Format::Png } else { Format::Svg };
        format!("frame-{:0digits$}.{}", at + 1, format.extension())
    };
    // If one picture cannot be written, the remaining ones would fail too, so they are skipped.
    let refused = AtomicBool::new(false);
    let paint = |at: usize| {
        if refused.load(Ordering::Relaxed) {
            return Ok(0);
        }
        let bytes = if pixels { film.png(at, 96.0) } else { film.svg(at).map(String::into_bytes) };
        let written = bytes.map_or(Ok(0), |bytes| put(&folder.join(name(at)), &bytes));
        refused.fetch_or(written.is_err(), Ordering::Relaxed);
        written
    };
    let numbers: Vec<usize> = (0..film.len()).collect();
    let painted = pool::map(&numbers, |at| paint(*at), &|_| ());
    let count = painted.into_iter().sum::<Result<usize, ExportError>>()?;
    let mut times = String::from("file,time (s)\n");
    for (at, time) in (0..film.len()).filter_map(|at| Some((at, film.time(at)?))) {
        // Writing to a String cannot fail.
        let _ = writeln!(times, "{},{time}", name(at));
    }
    Ok(count + put(&folder.join("times.csv"), times.as_bytes())?)
}

fn write_all(folder: &Path, files: &[Attachment]) -> Result<usize, ExportError> {
    files.iter().map(|file| put(&folder.join(&file.name), &file.bytes)).sum()
}

/// Writes one file.
fn put(path: &Path, bytes: &[u8]) -> Result<usize, ExportError> {
    system::store(path, bytes).map_err(|error| ExportError::refused(path, &error))?;
    Ok(1)
}
