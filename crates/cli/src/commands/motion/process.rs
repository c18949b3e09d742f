//! `barrelstack motion process`: prepares a raw record for integration, in explicit steps.

use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

use anyhow::{anyhow, bail};
use barrelstack::scenario::Dimension;
use barrelstack_motion::{Channel, MeanRemoval, NoiseCriterion, Pads, Processing, Record, Stage};
use clap::ValueEnum;

use super::folder::{self, Batch, FolderArgs, Source, Worked};
use super::input::{self, Chain, Input, number_or, quantity};
use super::measures;
use super::output::{Form, Output};
use super::page::{self, PageText};
use super::panels;
use crate::language::LanguageArgs;
use crate::number::whole;
use crate::typed::{typed, word};

/// Arguments of `process`.
#[derive(Debug, clap::Args)]
pub(super) struct ProcessArgs {
    #[command(flatten)]
    input: Input,
    /// Component to use: a name, an azimuth in degrees, h1, h2 or vertical; may be repeated.
    #[arg(long, value_name = "NAME")]
    component: Vec<String>,
    /// Chain of processing steps to start from; the options below change it.
    #[arg(long, value_enum, default_value_t = Chain::Compact)]
    chain: Chain,
    /// Mean to remove from the record.
    #[arg(long, value_enum)]
    mean: Option<Mean>,
    /// Subtract the straight line that fits the acceleration best by least squares.
    #[arg(long)]
    detrend: bool,
    /// Length of the cosine taper at each end, as a share of the length of the record, such as "2
    /// %"; 0 for none.
    #[arg(long, value_name = "SHARE")]
    taper: Option<String>,
    /// Corner frequency of the high-pass filter, such as "0.05 Hz", or none.
    #[arg(long, value_name = "FREQUENCY")]
    high_pass: Option<String>,
    /// Corner frequency of the low-pass filter, such as "25 Hz", or none.
    #[arg(long, value_name = "FREQUENCY")]
    low_pass: Option<String>,
    /// Order of the Butterworth filter, which is applied forward and backward.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = whole(1..=12_u32))]
    order: Option<u32>,
    /// Treatment of the zeros that are added before and after the record for the filter (pads).
    #[arg(long, value_enum)]
    pads: Option<Fate>,
    /// Bring the final velocity and displacement to zero by adding the smallest smooth acceleration
    /// that does so.
    #[arg(long, value_enum)]
    close: Option<YesOrNo>,
    /// Take both corner frequencies from the record. With auto, the signal between the corners is at least three times
    /// the noise before the first arrival; both horizontal components have the same corners.
    #[arg(long, value_enum, conflicts_with_all = ["high_pass", "low_pass"])]
    corners: Option<CornersFrom>,
    /// Rotate the horizontal components first. strike:122 rotates them to the fault-normal and fault-parallel
    /// directions of a strike of 122 degrees; vmax rotates them to the direction of the largest velocity.
    #[arg(long, value_name = "AXES", conflicts_with = "component")]
    rotate: Option<Axes>,
    #[command(flatten)]
    output: Output,
    /// Format of the output files, if the input is a folder.
    #[arg(long, value_enum, default_value_t = Form::Txt)]
    form: Form,
    /// Plot the record before and after processing: as panels (.png, .svg, .pdf) or as a page (.html).
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    folder: FolderArgs,
}

/// Source of the corner frequencies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum CornersFrom {
    /// The corners between which the signal is at least three times the noise before the first arrival.
    Auto,
}

/// Directions to which the horizontals are rotated.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Axes {
    Strike(f64),
    Fastest,
}

impl FromStr for Axes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let strike = text.strip_prefix("strike:").and_then(|degrees| degrees.trim().parse().ok());
        match (text, strike) {
            ("vmax", _) => Ok(Self::Fastest),
            (_, Some(strike)) if f64::is_finite(strike) => Ok(Self::Strike(strike)),
            _ => Err(
                "expected `vmax`, or a strike in degrees clockwise from north, such as `strike:122`"
                    .to_owned(),
            ),
        }
    }
}

typed! {
    /// Mean to remove from the record.
    enum Mean of MeanRemoval {
        /// Remove no mean.
        Keep = Self::Keep,
        /// Remove the mean of the quiet part before the first arrival.
        PreEvent = Self::PreEvent,
        /// Remove the mean of the whole record.
        Whole = Self::Whole,
    }
}

typed! {
    /// Treatment of the pads of the filter.
    enum Fate of Pads {
        /// Keep the pads.
        Keep = Self::Kept,
        /// Cut the pads off.
        Remove = Self::Removed,
    }
}

typed! {
    /// Yes or no.
    enum YesOrNo of bool {
        /// Bring the final velocity and displacement to zero.
        Yes = true,
        /// Leave the final velocity and displacement as they are.
        No = false,
    }
}

impl ProcessArgs {
    /// Returns all settings that affect the result, as text.
    fn settings(&self) -> String {
        let Self { form, component, chain, mean, detrend, taper, .. } = self;
        let Self { high_pass, low_pass, order, pads, close, corners, rotate, .. } = self;
        format!(
            "process to {form:?}, {component:?} {chain:?} {mean:?} {detrend} {taper:?} {high_pass:?} \
             {low_pass:?} {order:?} {pads:?} {close:?} {corners:?} {rotate:?}"
        )
    }

    fn chain(&self, stage: Stage) -> anyhow::Result<Processing> {
        let mut chain = self.chain.of(stage);
        chain.mean = self.mean.map_or(chain.mean, Into::into);
        chain.detrend |= self.detrend;
        if let Some(taper) = &self.taper {
            chain.taper = share("--taper", taper)?;
        }
        let corner = |option: &str, text: &str| match text.trim() {
            "none" => Ok(None),
            text => quantity(option, text, Dimension::FREQUENCY).map(Some),
        };
        if let Some(text) = &self.high_pass {
            chain.high_pass = corner("--high-pass", text)?;
        }
        if let Some(text) = &self.low_pass {
            chain.low_pass = corner("--low-pass", text)?;
        }
        chain.order = self.order.unwrap_or(chain.order);
        chain.pads = self.pads.map_or(chain.pads, Into::into);
        chain.close = self.close.map_or(chain.close, Into::into);
        Ok(chain)
    }

    /// Returns the record before and after processing. Both have only the selected components, which are rotated if
    /// requested.
    fn both(&self, read: &Record) -> anyhow::Result<(Record, Record)> {
        let choice = input::Choice { component: self.component.clone(), processing: None };
        let mut before = choice.take(read, Chain::None)?;
        if let Some(axes) = self.rotate {
            let turned = match axes {
                Axes::Strike(strike) => read.fault_axes(strike)?,
                Axes::Fastest => read.fastest_axes()?,
            };
            before.channels.retain(Channel::is_vertical);
            before.channels.splice(0..0, [turned.first, turned.second]);
            before.notes.push(turned.note);
        }
        let chain = self.chain(read.stage)?;
        if chain.is_none() && self.corners.is_none() && self.rotate.is_none() {
            bail!(
                "no processing step is given: add one, such as --high-pass \"0.1 Hz\", or use `barrelstack motion \
                 convert`"
            );
        }
        let after = match self.corners {
            Some(CornersFrom::Auto) => by_noise(&before, &chain)?,
            None => before.processed(&chain)?,
        };
        Ok((before, after))
    }
}

/// Applies the chain to every channel, with the corner frequencies that [`Record::noise_corners`] derives from the
/// noise of the record.
fn by_noise(before: &Record, chain: &Processing) -> anyhow::Result<Record> {
    let criterion = NoiseCriterion::default();
    let mut after = before.clone();
    after.channels.clear();
    for (channel, corners) in before.channels.iter().zip(before.noise_corners(&criterion)) {
        let corners = corners.map_err(|error| {
            anyhow!(
                "--corners auto: {error}: give --high-pass and --low-pass in place of --corners"
            )
        })?;
        let chain = Processing {
            high_pass: Some(corners.high_pass),
            low_pass: Some(corners.low_pass),
            ..chain.clone()
        };
        let alone = Record { channels: vec![channel.clone()], notes: Vec::new(), ..before.clone() };
        let done = alone.processed(&chain)?;
        after.notes.push(format!("{}: {}", channel.name, corners.sentence(&criterion)));
        after.notes.extend(done.notes);
        after.channels.extend(done.channels);
    }
    after.stage = Stage::Corrected;
    after.cut_to_shortest();
    Ok(after)
}

/// Parses a share given as a plain number or in percent.
pub(super) fn share(option: &str, text: &str) -> anyhow::Result<f64> {
    let value = number_or(option, text, Dimension::NONE)?;
    if !value.is_finite() {
        bail!("{option}: `{text}` is not a fraction; write a number such as 0.05, or 5 %");
    }
    Ok(value)
}

/// Processes the record and writes the result.
pub(super) fn process(args: &ProcessArgs) -> anyhow::Result<ExitCode> {
    if args.input.has_folder() {
        return folders(args);
    }
    args.folder.tables.need(false)?;
    let target = args.output.prepare()?;
    page::vacant_figure(args.figure.as_deref(), args.output.overwrite)?;
    let read = args.input.read()?;
    let (before, after) = args.both(&read)?;
    let table = measures::before_after(&before, &after)?;
    super::change::finish(&target, &read, &after, table.lines())?;
    if let Some(figure) = &args.figure {
        let drawn = panels::before_after(&before, &after)?;
        let headline = "The record before and after processing.".to_owned();
        let tables = vec![table.on_page("Measures of the motion before and after processing.")];
        let text = PageText { headline, tables, language: args.language };
        page::write(figure, &drawn, &after, text)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Processes all records in folders.
fn folders(args: &ProcessArgs) -> anyhow::Result<ExitCode> {
    let out = args.output.output.as_path();
    if args.figure.is_some() {
        bail!(
            "--figure applies to a single record; to plot the records of a folder, use `barrelstack motion plot`"
        );
    }
    let batch = Batch::new(&args.input, out, &args.folder, args.settings());
    let batch = Batch { ending: Some(word(args.form)), ..batch };
    let work = |source: &Source, record: &Record| {
        let (_, after) = args.both(record)?;
        args.form.write(source, out, &after)?;
        Ok(Worked::done(after))
    };
    folder::run(&batch, &work)?.print_summary()
}
