//! `barrelstack motion plot`: a record as figures, with their numbers as CSV.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
use barrelstack_motion::{
    Channel, Record, ResponseSpectrum, STANDARD_GRAVITY, arias, husid, standard_periods,
};
use barrelstack_report::{Axis, Band, Figure, Format, Plot, Series};
use clap::ValueEnum;

use super::folder::{self, Batch, FolderArgs, Source, Worked};
use super::info;
use super::input::{Chain, Choice, Input};
use super::output::{self, vacant};
use super::panels::{self, format_of, time, times};
use super::process::share;
use crate::figures::FigureArgs;
use crate::printer;
use crate::store::{self, store};
use crate::typed::word;

/// Arguments of `plot`.
#[derive(Debug, clap::Args)]
pub(super) struct PlotArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    choice: Choice,
    /// Folder for all figures, or one .svg, .png or .pdf file; the numbers of each figure are written beside it as
    /// .csv.
    #[arg(long, short, value_name = "DIR|FILE", visible_alias = "out")]
    output: PathBuf,
    /// Figure to draw; may be repeated. By default, all figures if the output is a folder, and the accelerations if it
    /// is a file.
    #[arg(long, value_enum)]
    figure: Vec<Kind>,
    #[command(flatten)]
    formats: FigureArgs,
    /// Damping ratio of the response spectra; may be repeated.
    #[arg(long, value_name = "SHARE", default_value = "5 %")]
    damping: Vec<String>,
    /// Replace figures that already exist.
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    folder: FolderArgs,
}

/// Figures of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// All panels of a record: components with their peaks, Husid plots, response and Fourier
    /// spectra.
    Panels,
    /// Acceleration (g) against time.
    Acceleration,
    /// Velocity (cm/s) against time.
    Velocity,
    /// Displacement (cm) against time.
    Displacement,
    /// Arias intensity (m/s) accumulated over time.
    Arias,
    /// Pseudo-spectral acceleration (g) against period.
    Response,
    /// Fourier amplitudes (m/s) of the acceleration against frequency.
    Fourier,
}

impl Kind {
    fn file(self) -> String {
        let spectrum =
            if matches!(self, Self::Response | Self::Fourier) { "-spectrum" } else { "" };
        format!("{}{spectrum}", word(self))
    }
}

/// Draws the figures and writes them.
pub(super) fn plot(args: &PlotArgs) -> anyhow::Result<ExitCode> {
    if args.input.has_folder() {
        return folders(args);
    }
    args.folder.tables.need(false)?;
    let files = files(args)?;
    for (_, path) in &files {
        let in_folder =
            path.parent().is_none_or(|folder| folder.as_os_str().is_empty() || folder.is_dir());
        for ending in endings(args) {
            if in_folder {
                vacant(&path.with_extension(ending), args.overwrite)?;
            }
        }
    }
    let damping: Vec<f64> =
        args.damping.iter().map(|text| share("--damping", text)).collect::<Result<_, _>>()?;
    let read = args.input.read()?;
    let record = args.choice.take(&read, Chain::Default)?;
    let figures: Vec<(Figure, &Path)> = files
        .iter()
        .map(|(kind, path)| Ok((figure(*kind, &record, &read, &damping)?, path.as_path())))
        .collect::<anyhow::Result<_>>()?;
    if !is_file(&args.output) {
        store::folder(&args.output)?;
    }
    let mut lines = record.notes.clone();
    lines.push(String::new());
    for (figure, path) in figures {
        for format in formats(args) {
            let bytes = figure.to_bytes(format, args.formats.dpi);
            store(&path.with_extension(format.extension()), &bytes)?;
        }
        store(&path.with_extension("csv"), figure.to_csv().as_bytes())?;
        let beside: Vec<String> =
            endings(args).skip(1).map(|ending| format!(".{ending}")).collect();
        lines.push(format!("written: {}, and beside it {}", path.display(), beside.join(", ")));
    }
    printer::lines(lines)?;
    info::warn(&Record { stage: record.stage, ..read });
    Ok(ExitCode::SUCCESS)
}

/// Draws the panels of every record in folders.
fn folders(args: &PlotArgs) -> anyhow::Result<ExitCode> {
    if args.figure.iter().any(|kind| *kind != Kind::Panels) {
        bail!(
            "records of a folder are drawn as panels: leave --figure out, or give --figure panels"
        );
    }
    let formats = if args.formats.names_any() { args.formats.formats() } else { vec![Format::Png] };
    let out = args.output.as_path();
    let settings = format!("plot {formats:?}, {:?}", args.choice);
    let batch = Batch::new(&args.input, out, &args.folder, settings);
    let batch = Batch { ending: Some(formats[0].extension().to_owned()), ..batch };
    let work = |source: &Source, record: &Record| {
        let chosen = args.choice.take(record, Chain::Default)?;
        let figure = panels::record(&chosen, record)?;
        for format in &formats {
            let path = source.beside(out, format.extension());
            output::make_folder_of(&path)?;
            panels::write(&path, &figure)?;
        }
        Ok(Worked::done(chosen))
    };
    folder::run(&batch, &work)?.print_summary()
}

fn is_file(output: &Path) -> bool {
    format_of(output).is_some()
}

/// Returns the formats in which figures are written.
fn formats(args: &PlotArgs) -> Vec<Format> {
    format_of(&args.output).map_or_else(|| args.formats.formats(), |format| vec![format])
}

/// Returns the extensions of the files that are written for each figure: the extensions of its formats, and the
/// extension of CSV.
fn endings(args: &PlotArgs) -> impl Iterator<Item = &'static str> {
    formats(args).into_iter().map(Format::extension).chain(["csv"])
}

/// Returns the figures to draw, with their files.
fn files(args: &PlotArgs) -> anyhow::Result<Vec<(Kind, PathBuf)>> {
    let mut kinds = args.figure.clone();
    if is_file(&args.output) {
        if args.formats.names_any() {
            bail!(
                "--format applies to a folder, but the name {} already states the format; leave --format out",
                args.output.display()
            );
        }
        vacant(&args.output, true)?;
        let kind = match kinds.as_slice() {
            [] => Kind::Acceleration,
            [kind] => *kind,
            _ => bail!(
                "{} can hold only one figure: select one with --figure, or give a folder",
                args.output.display()
            ),
        };
        return Ok(vec![(kind, args.output.clone())]);
    }
    if args.output.is_file() {
        bail!(
            "{} is a file, not a folder, and does not end in .svg, .png or .pdf",
            args.output.display()
        );
    }
    if let Some(ending) = args.output.extension().filter(|_| !args.output.is_dir()) {
        bail!(
            "{}: figures are written as .svg, .png or .pdf, not as .{}; give such a file or a folder",
            args.output.display(),
            ending.to_string_lossy()
        );
    }
    if kinds.is_empty() {
        kinds = Kind::value_variants().to_vec();
    }
    Ok(kinds
        .into_iter()
        .map(|kind| (kind, args.output.join(kind.file()).with_extension("svg")))
        .collect())
}

fn figure(kind: Kind, record: &Record, read: &Record, damping: &[f64]) -> anyhow::Result<Figure> {
    if kind == Kind::Panels {
        return panels::record(record, read);
    }
    let mut plot = Plot::default();
    // The strongest channel is drawn first, so that weaker ones are drawn over it and stay visible.
    let mut channels: Vec<&Channel> = record.channels.iter().collect();
    channels.sort_by(|a, b| b.pga().total_cmp(&a.pga()));
    for channel in &channels {
        plot.series.extend(series(kind, channel, damping)?);
    }
    (plot.x, plot.y) = match kind {
        Kind::Panels => (Axis::default(), Axis::default()),
        Kind::Acceleration => (time(), Axis::new("acceleration", "g")),
        Kind::Velocity => (time(), Axis::new("velocity", "cm/s")),
        Kind::Displacement => (time(), Axis::new("displacement", "cm")),
        Kind::Arias => (time(), Axis::new("Arias intensity", "m/s")),
        Kind::Response => {
            (Axis::new("period", "s").log(), Axis::new("pseudo-spectral acceleration", "g").log())
        }
        Kind::Fourier => panels::fourier_axes(),
    };
    if let (Kind::Arias, Some(first)) = (kind, channels.first()) {
        plot.bands.extend(strong_part(first));
    }
    let caption = format!("{}, {}", title(record), plot.y.label);
    Ok(Figure::new(kind.file(), caption, plot))
}

/// Returns the name of the record for a caption.
fn title(record: &Record) -> String {
    let mut parts = vec![record.event.as_str(), record.station.as_str()];
    parts.retain(|part| !part.is_empty());
    if parts.is_empty() { record.file.clone() } else { parts.join(", ") }
}

/// Returns the time interval in which the Arias intensity grows from 5 to 95 % of its final value, labeled with the
/// name of the channel. Returns `None` if the accelerations are all zero.
fn strong_part(channel: &Channel) -> Option<Band> {
    let build_up = husid(&channel.acceleration);
    let time = |share: f64| {
        let sample = build_up.iter().position(|value| *value >= share)?;
        Some(sample as f64 * channel.time_step)
    };
    Some(Band { from: time(0.05)?, to: time(0.95)?, label: format!("{}: 5 to 95 %", channel.name) })
}

fn series(kind: Kind, channel: &Channel, damping: &[f64]) -> anyhow::Result<Vec<Series>> {
    let (step, a) = (channel.time_step, &channel.acceleration);
    let name = channel.name.as_str();
    let over_time = |values: &[f64], factor: f64| {
        let values = values.iter().map(|value| factor * value).collect();
        vec![Series::new(name, times(channel), values)]
    };
    Ok(match kind {
        Kind::Panels => Vec::new(),
        Kind::Acceleration => over_time(a, 1.0 / STANDARD_GRAVITY),
        Kind::Velocity => over_time(channel.sampled()?.velocity(), 100.0),
        Kind::Displacement => over_time(channel.sampled()?.displacement(), 100.0),
        Kind::Arias => over_time(&husid(a), arias(step, a)),
        Kind::Response => {
            let periods = standard_periods(40);
            let mut lines = Vec::new();
            for damping in damping {
                let spectrum = ResponseSpectrum::new(step, a, &periods, *damping)?;
                let label = format!("{name}, {}", super::table::percent(*damping));
                let values = spectrum.pseudo_acceleration();
                let in_g = values.iter().map(|value| value / STANDARD_GRAVITY).collect();
                lines.push(Series::new(label, periods.clone(), in_g));
            }
            lines
        }
        Kind::Fourier => {
            vec![panels::fourier_series(name, channel)]
        }
    })
}
