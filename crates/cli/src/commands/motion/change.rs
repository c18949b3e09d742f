//! `barrelstack motion convert`, and the output of all commands that write a motion.

use std::process::ExitCode;

use barrelstack_motion::Record;

use super::folder::{self, Batch, FolderArgs, Source, Worked};
use super::info;
use super::input::{Chain, Choice, Input};
use super::measures;
use super::output::{Form, Output, Target};
use crate::printer;
use crate::typed::word;

/// Formats of motion files, for the end of the help.
const FORMS: &str = "\
Forms:
  .txt  the program's own, exact: lines that start with #, then one column per channel in m/s2
          # barrelstack motion 1
          # station: Napa College
          # event: South Napa, 2014-08-24, M 6.0
          # processing: one line for each step
          # stage: raw, corrected or unknown
          # unit: m/s2
          # time_step: 0.005
          # channels: E az=90, N az=0, UP vertical
          1.2345e-3 -2.3456e-4 0e0
        az is the azimuth in degrees clockwise from north, vertical is positive upward
  .csv  time (s) and accelerations (m/s2), the processing steps in lines that start with #
  .npz  NumPy: time, NAME_acceleration, NAME_velocity and NAME_displacement in SI units
  .at2  PEER: one component in g with eight digits, five to a line, below four lines of header";

/// Arguments of `convert`.
#[derive(Debug, clap::Args)]
#[command(after_help = FORMS)]
pub(super) struct ConvertArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    choice: Choice,
    #[command(flatten)]
    output: Output,
    /// Format of the output files, if the input is a folder.
    #[arg(long, value_enum, default_value_t = Form::Txt)]
    form: Form,
    #[command(flatten)]
    folder: FolderArgs,
}

/// Reads the motion, selects components, and writes it.
pub(super) fn convert(args: &ConvertArgs) -> anyhow::Result<ExitCode> {
    if args.input.has_folder() {
        let out = args.output.output.as_path();
        let settings = format!("convert to {:?}, {:?}", args.form, args.choice);
        let batch = Batch::new(&args.input, out, &args.folder, settings);
        let batch = Batch { ending: Some(word(args.form)), ..batch };
        let work = |source: &Source, record: &Record| {
            let chosen = args.choice.take(record, Chain::None)?;
            args.form.write(source, out, &chosen)?;
            Ok(Worked::as_read(chosen))
        };
        return folder::run(&batch, &work)?.print_summary();
    }
    args.folder.tables.need(false)?;
    let target = args.output.prepare()?;
    let read = args.input.read()?;
    let chosen = args.choice.take(&read, Chain::None)?;
    finish(&target, &read, &chosen, measures::usual(&chosen)?.lines())?;
    Ok(ExitCode::SUCCESS)
}

/// Writes a motion, then prints its processing, its measures and its path.
///
/// Nothing is printed if writing fails.
pub(super) fn finish(
    target: &Target,
    read: &Record,
    made: &Record,
    measures: Vec<String>,
) -> anyhow::Result<()> {
    let losses = target.write(made)?;
    let mut lines: Vec<String> = made.notes.clone();
    lines.push(String::new());
    lines.extend(measures);
    lines.extend([String::new(), format!("written: {}", target.path.display())]);
    printer::lines(lines)?;
    // A motion that was processed by the command is no longer raw.
    info::warn(&Record { stage: made.stage, ..read.clone() });
    for loss in losses {
        printer::warning(&loss);
    }
    Ok(())
}
