//! `barrelstack render`: a run as figures, a report for printing, animations and a ParaView series.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use barrelstack::render::{Part, RenderFolder, Rendering};

use crate::args::{ScenarioArgs, VariantArgs};
use crate::figures::{FigureArgs, PaperName};
use crate::interrupt::keeps;
use crate::language::LanguageArgs;
use crate::number::{real, whole};
use crate::printer;
use crate::typed::typed;

/// Arguments of `render`.
#[derive(Debug, clap::Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    #[command(flatten)]
    variants: VariantArgs,
    /// Folder to write to: figures/ with report.md beside it, report.pdf, animation/, frames/,
    /// paraview/.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Part to write; may be repeated.
    #[arg(long, value_enum, value_name = "PART")]
    only: Vec<PartName>,
    #[command(flatten)]
    figures: FigureArgs,
    /// Paper size of report.pdf.
    #[arg(long, value_enum, value_name = "PAPER", default_value = "a4")]
    paper: PaperName,
    #[command(flatten)]
    language: LanguageArgs,
    /// Frames and ParaView time steps per second of simulated time; animations have at most 50 frames per second.
    #[arg(
        long, value_name = "HZ", default_value = "20", allow_negative_numbers = true,
        value_parser = real("a number of frames per second above 0, such as 20", |number| number > 0.0)
    )]
    rate: f64,
    /// Start (s) of the interval to render.
    #[arg(
        long, value_name = "SECONDS", allow_negative_numbers = true,
        value_parser = real("a time in seconds of 0 or more, such as 2.5", |number| number >= 0.0)
    )]
    from: Option<f64>,
    /// End (s) of the interval to render.
    #[arg(
        long, value_name = "SECONDS", allow_negative_numbers = true,
        value_parser = real("a time in seconds above 0, such as 10", |number| number > 0.0)
    )]
    to: Option<f64>,
    /// Longer side of animations (pixels).
    #[arg(
        long, value_name = "PIXELS", default_value = "480", allow_negative_numbers = true,
        value_parser = whole(64_u32..=4096)
    )]
    size: u32,
    /// Replace the files that an earlier rendering of the same parts wrote.
    #[arg(long)]
    overwrite: bool,
    /// Show no progress.
    #[arg(long, short)]
    quiet: bool,
}

typed! {
    /// The parts, by their names on the command line.
    enum PartName of Part {
        /// Every figure of the report, with its numbers as CSV.
        Figures = Self::Figures,
        /// The report for printing, as PDF.
        Report = Self::Report,
        /// The stack as GIF and as animated PNG, which play in every browser.
        Animation = Self::Animation,
        /// Numbered pictures of equal size, from which an encoder makes a video, such as `ffmpeg
        /// -framerate 20 -i frame-%04d.png -pix_fmt yuv420p stack.mp4`.
        Frames = Self::Frames,
        /// Bodies and contact forces over time.
        Paraview = Self::Paraview,
    }
}

impl RenderArgs {
    /// Returns the parts to write, each once, in the order in which the help lists them.
    fn parts(&self) -> Vec<Part> {
        let requested = |part: &Part| {
            self.only.is_empty() || self.only.iter().any(|name| Part::from(*name) == *part)
        };
        Part::ALL.into_iter().filter(requested).collect()
    }

    fn between(&self) -> anyhow::Result<Option<[f64; 2]>> {
        let (from, to) = (self.from.unwrap_or(0.0), self.to.unwrap_or(f64::INFINITY));
        if !(from >= 0.0 && to > from) {
            bail!(
                "--from {from} --to {to}: expected a start time of 0 s or more and a later end time"
            );
        }
        Ok((self.from.is_some() || self.to.is_some()).then_some([from, to]))
    }
}

/// Runs the scenario and writes the requested parts.
pub(crate) fn render(args: &RenderArgs) -> anyhow::Result<ExitCode> {
    let mut scenario = super::load(&args.scenario)?;
    let selection = super::run::selected(&mut scenario, args.variants)?;
    let how = Rendering {
        formats: args.figures.formats(),
        dpi: args.figures.dpi,
        paper: args.paper.into(),
        rate: args.rate,
        between: args.between()?,
        largest: args.size,
        language: args.language.of(),
    };
    // The folder is checked before the computation starts.
    let folder = RenderFolder::prepare(&args.out, &args.parts(), args.overwrite)?;
    for part in args.parts() {
        crate::interrupt::writes_to(&args.out.join(part.place()));
    }
    crate::interrupt::writes_to(&args.out);
    let answer = super::run::answered(&scenario, selection, !args.quiet)
        .map_err(|error| super::placed(error, &scenario, &args.scenario))?;
    how.check(answer.end_time()).map_err(anyhow::Error::msg)?;
    keeps(format!("the finished parts are in {}", args.out.display()));
    let written = answer.render(&folder, &how)?;
    printer::lines(written.iter().map(|part| match part.files {
        1 => part.place.display().to_string(),
        files => format!("{}: {files} files", part.place.display()),
    }))?;
    printer::warnings(&answer);
    Ok(super::run::status(&answer))
}
