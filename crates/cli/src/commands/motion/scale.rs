//! `barrelstack motion scale`: scales all components by one factor, or to another length scale.

use anyhow::{anyhow, bail};
use barrelstack::scenario::Dimension;
use barrelstack_motion::{GroundMotion, History, Horizontals, IntensityMeasure, Record};

use super::input::{self, Chain, Choice, Input, quantity};
use super::measures::{self, reading};
use super::output::Output;
use super::table::number;
use crate::number::real;

/// Arguments of `scale`.
#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("how").required(true).multiple(true).args(["to", "factor", "froude"]))]
pub(super) struct ScaleArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    choice: Choice,
    /// Scale the motion to a value of an intensity measure of one component, such as "pgv=60 cm/s",
    /// "pga=0.4 g", "arias=2 m/s", "sa(1.0)=0.5 g" (period in s, damping 5 %) or "sa(1.0,0.02)=0.5
    /// g".
    #[arg(long, value_name = "MEASURE=VALUE", conflicts_with = "factor")]
    to: Option<String>,
    /// Component to which --to refers; by default, the first horizontal component. For both horizontal components:
    /// rotd50 or rotd100 (median or largest value over all directions), or geomean.
    #[arg(long, value_name = "NAME", requires = "to")]
    of: Option<String>,
    /// Multiply the accelerations by this factor.
    #[arg(
        long, value_name = "NUMBER", allow_negative_numbers = true,
        value_parser = real("a number other than 0, such as 2", |number| number != 0.0)
    )]
    factor: Option<f64>,
    /// Length of a model divided by that of its prototype, such as 0.25: time is multiplied by the square root of this
    /// ratio, and accelerations remain unchanged. Applied after --to or --factor, if one of them is also given.
    #[arg(
        long, value_name = "RATIO", allow_negative_numbers = true,
        value_parser = real("a ratio of lengths above 0, such as 0.25", |number| number > 0.0)
    )]
    froude: Option<f64>,
    #[command(flatten)]
    output: Output,
}

/// Scales the motion and writes it.
pub(super) fn scale(args: &ScaleArgs) -> anyhow::Result<()> {
    let target = args.output.prepare()?;
    let goal = args.to.as_deref().map(goal).transpose()?;
    let read = args.input.read()?;
    let before = args.choice.take(&read, Chain::Default)?;
    let mut after = before.clone();
    if let Some((measure, value)) = goal {
        let (factor, of) = factor_to(args, &before, measure, value)?;
        let (unit, readable) = reading(&measure);
        after = after.multiplied(factor);
        after.notes.push(format!(
            "scaled by {factor:.6}, which brings {measure} of {of} to {} {unit}; one factor for all \
             components",
            number(readable * value)
        ));
    }
    if let Some(factor) = args.factor {
        after = after.multiplied(factor);
        after.notes.push(format!("scaled by {factor}; one factor for all components"));
    }
    if let Some(length) = args.froude {
        froude(&mut after, length);
    }
    let table = measures::before_after(&before, &after)?;
    super::change::finish(&target, &read, &after, table.lines())
}

/// Returns the scale factor, and the name of the component (or the names of the two components) that the requested
/// value of the measure refers to.
fn factor_to(
    args: &ScaleArgs,
    record: &Record,
    measure: IntensityMeasure,
    value: f64,
) -> anyhow::Result<(f64, String)> {
    if let Some(over) = args.of.as_deref().and_then(|name| name.parse::<Horizontals>().ok()) {
        let (first, second) =
            record.horizontal_pair().map_err(|error| anyhow!("--of {over}: {error}"))?;
        let factor = over.scale_factor(measure, &first.sampled()?, &second.sampled()?, value)?;
        return Ok((factor, format!("{} and {} ({over})", first.name, second.name)));
    }
    let channel = match &args.of {
        Some(name) => record.component(&input::component(record, name)?)?,
        None => record
            .channels
            .iter()
            .find(|channel| !channel.is_vertical())
            .unwrap_or(&record.channels[0])
            .clone(),
    };
    let motion =
        GroundMotion::new(channel.name.clone(), History::Sampled(channel.sampled()?), None);
    Ok((motion.scale_factor(measure, value)?, channel.name))
}

fn froude(record: &mut Record, length: f64) {
    let time = length.sqrt();
    for channel in &mut record.channels {
        channel.time_step *= time;
        channel.initial_velocity *= time;
        channel.peaks.clear();
    }
    record.notes.push(format!(
        "Froude-scaled to {length} times the length: time and velocity times {time:.6}, displacement \
         times {length}, acceleration unchanged"
    ));
}

/// Parses `MEASURE=VALUE` to an intensity measure and its value in SI units.
fn goal(text: &str) -> anyhow::Result<(IntensityMeasure, f64)> {
    let (name, value) = text.rsplit_once('=').ok_or_else(|| {
        anyhow!("--to {text}: expected a measure and its value, such as \"pgv=60 cm/s\"")
    })?;
    let measure: IntensityMeasure =
        name.parse().map_err(|error| anyhow!("--to {text}: {error}"))?;
    if measure == IntensityMeasure::Fajfar {
        // No other quantity has the unit m/s^0.75, so it is parsed here.
        let plain = value.trim().strip_suffix("m/s^0.75").unwrap_or(value).trim();
        return match plain.parse::<f64>() {
            Ok(goal) if goal.is_finite() && goal > 0.0 => Ok((measure, goal)),
            _ => {
                bail!("--to {text}: expected a number above 0 in m/s^0.75, such as \"fajfar=0.9\"")
            }
        };
    }
    let dimension = match measure.unit() {
        "m/s2" => Dimension::ACCELERATION,
        "m/s" => Dimension::VELOCITY,
        "m" => Dimension::LENGTH,
        "s" => Dimension::TIME,
        unit => bail!(
            "--to {text}: a motion cannot be scaled to a value in {unit}; choose another measure"
        ),
    };
    let goal = quantity(&format!("--to {}", name.trim()), value, dimension)?;
    if goal <= 0.0 {
        bail!("--to {text}: expected a value above 0");
    }
    Ok((measure, goal))
}
