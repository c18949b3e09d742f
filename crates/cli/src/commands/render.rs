//! `barrelstack render`: a run as figures, pictures and a ParaView series.

use std::path::PathBuf;
use std::process::ExitCode;

use barrelstack::render::{Part, RenderFolder};

use crate::args::ScenarioArgs;
use crate::printer;

/// Arguments of `render`.
#[derive(Debug, clap::Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Where to write: figures/ with report.md beside it, frames/, paraview/.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Write only this part; may be repeated.
    #[arg(long, value_enum, value_name = "PART")]
    only: Vec<PartName>,
    /// Pictures, and ParaView times, for every second of the run.
    #[arg(long, value_name = "HZ", default_value = "20", value_parser = rate)]
    rate: f64,
    /// Remove what an earlier rendering wrote into the folders of these parts.
    #[arg(long)]
    overwrite: bool,
    /// Show no progress.
    #[arg(long, short)]
    quiet: bool,
}

/// The parts, as typed.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum PartName {
    /// Every figure and table of the report as SVG and CSV.
    Figures,
    /// Numbered pictures of one size.
    Frames,
    /// Bodies and contact forces over time.
    Paraview,
}

impl From<PartName> for Part {
    fn from(name: PartName) -> Self {
        match name {
            PartName::Figures => Self::Figures,
            PartName::Frames => Self::Frames,
            PartName::Paraview => Self::Paraview,
        }
    }
}

fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if rate.is_finite() && rate > 0.0 => Ok(rate),
        _ => Err("expected a number of pictures a second above zero, such as 20".into()),
    }
}

/// Runs the scenario and writes its parts.
pub(crate) fn render(args: &RenderArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    let parts = if args.only.is_empty() {
        Part::ALL.to_vec()
    } else {
        let mut parts: Vec<Part> = Vec::new();
        for part in args.only.iter().copied().map(Part::from) {
            if !parts.contains(&part) {
                parts.push(part);
            }
        }
        parts
    };
    // The folder is looked at before the work is done, not after.
    let folder = RenderFolder::prepare(&args.out, &parts, args.overwrite)?;
    let (run, summary) = super::run::watched(&scenario, !args.quiet)?;
    let written = folder.write(&run, &summary, args.rate)?;
    printer::lines(
        written.iter().map(|part| format!("{}: {} files", part.folder.display(), part.files)),
    )?;
    Ok(if run.interrupted { ExitCode::from(130) } else { ExitCode::SUCCESS })
}
