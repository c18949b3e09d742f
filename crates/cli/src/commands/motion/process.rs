//! `barrelstack motion process`: from a raw record to one that can be integrated, in visible steps.

use anyhow::bail;
use barrelstack::scenario::Dimension;
use barrelstack_motion::{MeanRemoval, Pads, Processing};
use clap::ValueEnum;

use super::input::{self, Chain, Input, quantity};
use super::measures;
use super::output::Output;

/// Arguments of `process`.
#[derive(Debug, clap::Args)]
pub(super) struct ProcessArgs {
    #[command(flatten)]
    input: Input,
    /// A component: its name, an azimuth in degrees, h1, h2 or vertical; may be repeated.
    #[arg(long, value_name = "NAME")]
    component: Vec<String>,
    /// The chain to start from; the options below change it.
    #[arg(long, value_enum, default_value_t = Chain::Compact)]
    chain: Chain,
    /// Which mean is removed.
    #[arg(long, value_enum)]
    mean: Option<Mean>,
    /// Subtract the least-squares line of the acceleration.
    #[arg(long)]
    detrend: bool,
    /// Length of the cosine taper at each end over the length of the record, such as "2 %"; 0 for none.
    #[arg(long, value_name = "SHARE")]
    taper: Option<String>,
    /// Corner of the high-pass, such as "0.05 Hz", or none.
    #[arg(long, value_name = "FREQUENCY")]
    high_pass: Option<String>,
    /// Corner of the low-pass, such as "25 Hz", or none.
    #[arg(long, value_name = "FREQUENCY")]
    low_pass: Option<String>,
    /// Order of the Butterworth filter, which runs forth and back.
    #[arg(long, value_name = "NUMBER")]
    order: Option<u32>,
    /// What becomes of the zeros added for the filter.
    #[arg(long, value_enum)]
    pads: Option<Fate>,
    /// Bring the last velocity and displacement to zero by the smallest smooth acceleration.
    #[arg(long, value_enum)]
    close: Option<Answer>,
    #[command(flatten)]
    output: Output,
}

/// Which mean is removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Mean {
    /// None.
    Keep,
    /// That of the quiet part before the first arrival.
    PreEvent,
    /// That of the whole record.
    Whole,
}

/// What becomes of pads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Fate {
    /// They stay.
    Keep,
    /// They are cut off.
    Remove,
}

/// Yes or no.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Answer {
    /// Do it.
    Yes,
    /// Leave it.
    No,
}

impl ProcessArgs {
    fn chain(&self, stage: barrelstack_motion::Stage) -> anyhow::Result<Processing> {
        let mut chain = self.chain.of(stage);
        match self.mean {
            Some(Mean::Keep) => chain.mean = MeanRemoval::Keep,
            Some(Mean::PreEvent) => chain.mean = MeanRemoval::PreEvent,
            Some(Mean::Whole) => chain.mean = MeanRemoval::Whole,
            None => {}
        }
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
        match self.pads {
            Some(Fate::Keep) => chain.pads = Pads::Kept,
            Some(Fate::Remove) => chain.pads = Pads::Removed,
            None => {}
        }
        match self.close {
            Some(Answer::Yes) => chain.close = true,
            Some(Answer::No) => chain.close = false,
            None => {}
        }
        Ok(chain)
    }
}

/// A share as a plain number or in percent.
pub(super) fn share(option: &str, text: &str) -> anyhow::Result<f64> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => bail!("{option}: `{text}` is no share; write a number such as 0.05, or 5 %"),
        Err(_) => quantity(option, text, Dimension::NONE),
    }
}

/// Processes and writes.
pub(super) fn process(args: &ProcessArgs) -> anyhow::Result<()> {
    let target = args.output.prepare()?;
    let read = args.input.read()?;
    let choice = input::Choice { component: args.component.clone(), processing: Chain::None };
    let before = choice.take(&read)?;
    let chain = args.chain(read.stage)?;
    if chain.is_none() {
        bail!(
            "this chain does nothing: name a step, such as --high-pass \"0.1 Hz\", or use convert"
        );
    }
    let after = input::processed(&before, &chain)?;
    let table = measures::before_after(&before, &after)?;
    super::change::finish(&target, &read, &after, table.lines())
}
