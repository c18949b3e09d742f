//! `barrelstack motion`: read, inspect, change and synthesize ground motions.

mod archives;
mod change;
mod folder;
mod info;
mod input;
mod matching;
mod measures;
mod output;
mod page;
mod panels;
mod plot;
mod process;
mod pulses;
mod scale;
mod select;
mod spectrum;
mod synth;
pub(super) mod table;
mod target;

use std::process::ExitCode;

use barrelstack_motion::FORMATS;
use clap::Subcommand;

/// Text at the end of `motion --help`.
const AFTER_HELP: &str = "\
Start with:
  barrelstack motion info my-site.AT2                    duration, PGA, PGV, PGD: is the unit right?
  barrelstack motion plot my-site.AT2 -o pictures        accelerations, velocities, spectra as SVG
  barrelstack motion info records --out table            a whole folder: one row per record, CSV and Parquet
  barrelstack motion select records --target ec8:ag=0.3,site=B --out set   a set for a study
  barrelstack motion scale my-site.AT2 --to \"pgv=60 cm/s\" -o strong.txt
  barrelstack run demo-napa --record strong.txt --set motion.vertical=false

Quantities carry their unit: \"60 cm/s\", \"0.35 g\", \"0.1 Hz\", \"0.8 s\".
Every processing step is printed, and written into the header of the file.
Accelerations are linear between samples; velocities and displacements are their exact integrals.";

pub(crate) use info::MotionInfo;

/// Returns the text at the end of `motion --help`, with the formats that can be read.
fn after_help() -> String {
    let formats = FORMATS.iter().map(|format| format!("  {:14}{}", format.name, format.title));
    let formats = formats.collect::<Vec<_>>().join("\n");
    format!(
        "{AFTER_HELP}\n\nFormats that are read; the content of a file determines its format:\n{formats}"
    )
}

/// Arguments of `motion`.
#[derive(Debug, clap::Args)]
#[command(after_help = after_help())]
pub(crate) struct MotionArgs {
    /// Action on the motion.
    #[command(subcommand)]
    command: MotionCommand,
}

/// Actions on a motion.
#[derive(Debug, Subcommand)]
enum MotionCommand {
    /// Print the contents of a file: header, channels, stated and measured peaks, intensity
    /// measures.
    Info(info::InfoArgs),
    /// Plot acceleration, velocity, displacement, Arias intensity and spectra as SVG, with CSV
    /// files.
    Plot(plot::PlotArgs),
    /// Write a record as AT2, CSV or NPZ, or in the program's own text format.
    Convert(change::ConvertArgs),
    /// Remove the mean, taper, filter, and bring the final velocity and displacement to zero; every
    /// step is printed.
    Process(process::ProcessArgs),
    /// Select a set of records whose spectra have the mean and spread of a target.
    Select(select::SelectArgs),
    /// Scale all components by one factor: to a value of an intensity measure, by a number, or to
    /// another length scale.
    Scale(scale::ScaleArgs),
    /// Match the response spectrum to a code spectrum or to a table.
    Match(matching::MatchArgs),
    /// Compute response spectra at any damping, also over all directions; `plot` draws Fourier
    /// spectra.
    Spectrum(spectrum::SpectrumArgs),
    /// Make a motion from a formula, or from random numbers with a given seed.
    Synth(synth::SynthArgs),
}

/// Runs the given subcommand.
pub(crate) fn motion(args: &MotionArgs) -> anyhow::Result<ExitCode> {
    match &args.command {
        MotionCommand::Info(args) => return info::info(args),
        MotionCommand::Plot(args) => return plot::plot(args),
        MotionCommand::Convert(args) => return change::convert(args),
        MotionCommand::Process(args) => return process::process(args),
        MotionCommand::Select(args) => return select::select(args),
        MotionCommand::Scale(args) => scale::scale(args),
        MotionCommand::Match(args) => return matching::match_spectrum(args),
        MotionCommand::Spectrum(args) => spectrum::spectrum(args),
        MotionCommand::Synth(args) => synth::synth(args),
    }?;
    Ok(ExitCode::SUCCESS)
}
