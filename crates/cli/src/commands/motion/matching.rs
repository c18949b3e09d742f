//! `barrelstack motion match`: a motion whose response spectrum follows a target.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{anyhow, bail};
use barrelstack::scenario::Dimension;
use barrelstack_motion::{
    Horizontals, MatchMethod, Matching, MotionError, Record, STANDARD_GRAVITY, TargetSpectrum,
    missed_in_words, response, rotated_spectrum,
};

use super::input::{self, Chain, Choice, Input, quantity};
use super::measures;
use super::output::Output;
use super::page::{self, PageText};
use super::panels;
use super::process::share;
use super::table::{Table, number, percent};
use super::target;
use crate::language::LanguageArgs;
use crate::printer;
use crate::typed::typed;

/// Arguments of `match`.
#[derive(Debug, clap::Args)]
#[command(after_help = target::CODES)]
pub(super) struct MatchArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    choice: Choice,
    /// Target spectrum, at 5 % damping unless the target states another damping; the targets are
    /// listed below.
    #[arg(long, value_name = "TARGET")]
    to: String,
    /// Component to match; by default, the first horizontal component. `rotd50` and `rotd100` match both horizontal
    /// components together, by their response over all directions. All other components are only scaled.
    #[arg(long, value_name = "NAME")]
    of: Option<String>,
    /// Method for a single component. For two horizontal components, the amplitudes are matched first, and wavelets are
    /// then added.
    #[arg(long, value_enum, default_value_t = Method::Time)]
    method: Method,
    /// Shortest period to match.
    #[arg(long, value_name = "TIME", default_value = "0.1 s")]
    shortest: String,
    /// Longest period to match.
    #[arg(long, value_name = "TIME", default_value = "3 s")]
    longest: String,
    /// Maximum accepted misfit at any matched period.
    #[arg(long, value_name = "SHARE", default_value = "5 %")]
    tolerance: String,
    /// Write the best motion even if it misses the tolerance. In this case, the misfit is printed and the exit status
    /// is 3.
    #[arg(long)]
    accept_misfit: bool,
    #[command(flatten)]
    output: Output,
    /// Plot the target and the motion before and after matching: as panels (.png, .svg, .pdf) or as
    /// a page (.html).
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
    #[command(flatten)]
    language: LanguageArgs,
}

/// Exit status if a motion was written although its spectrum misses the target.
const NEAR: u8 = 3;

typed! {
    /// Method of matching.
    enum Method of MatchMethod {
        /// Add wavelets at the times of the peak responses; the motion keeps its character.
        Time = Self::Time,
        /// Scale the Fourier amplitudes and keep the phases; the character of the whole motion changes.
        Frequency = Self::Frequency,
    }
}

/// Matches the motion and writes the result.
pub(super) fn match_spectrum(args: &MatchArgs) -> anyhow::Result<ExitCode> {
    let target = args.output.prepare()?;
    page::vacant_figure(args.figure.as_deref(), args.output.overwrite)?;
    let spectrum = target::target(&args.to)?;
    let settings = Matching {
        method: args.method.into(),
        shortest: quantity("--shortest", &args.shortest, Dimension::TIME)?,
        longest: quantity("--longest", &args.longest, Dimension::TIME)?,
        tolerance: share("--tolerance", &args.tolerance)?,
        ..Matching::default()
    };
    let read = args.input.read()?;
    let before = args.choice.take(&read, Chain::Default)?;
    let part = Part::of(args, &before)?;
    let (after, missed) = matched(args, &before, &part, &spectrum, &settings)?;
    let measured = measures::before_after(&before, &after)?;
    let compared = comparison(&part, [&before, &after], &spectrum, &settings)?;
    let mut lines = measured.lines();
    lines.push(String::new());
    lines.extend(compared.lines());
    super::change::finish(&target, &read, &after, lines)?;
    if let Some(figure) = &args.figure {
        let drawn = panels::compared(&part.alone(&before)?, &part.alone(&after)?, Some(&spectrum))?;
        let name = part.name(&before)?;
        let headline = match &missed {
            None => format!(
                "The spectrum of {name} follows {} within {}.",
                args.to,
                percent(settings.tolerance)
            ),
            Some(words) => format!("The spectrum of {name} misses {} {words}.", args.to),
        };
        let tables = vec![
            compared.on_page("The target spectrum, and the spectra before and after matching."),
            measured.on_page("Measures of the motion before and after matching."),
        ];
        let text = PageText { headline, tables, language: args.language };
        page::write(figure, &drawn, &after, text)?;
    }
    match missed {
        None => Ok(ExitCode::SUCCESS),
        Some(words) => {
            printer::warning(&format!(
                "the target is missed {words}; the motion was written nevertheless, because --accept-misfit is set; \
                 the exit status is {NEAR}"
            ));
            Ok(ExitCode::from(NEAR))
        }
    }
}

/// The part of a record that is matched.
enum Part {
    /// The channel with this index.
    One(usize),
    /// Both horizontal components; their spectrum over all directions is matched to the target.
    Pair(Horizontals),
}

impl Part {
    fn of(args: &MatchArgs, record: &Record) -> anyhow::Result<Self> {
        let Some(name) = &args.of else {
            let first = record.channels.iter().position(|c| !c.is_vertical());
            return Ok(Self::One(first.unwrap_or(0)));
        };
        if let Ok(measure) = name.parse() {
            record.horizontal_pair().map_err(|error| anyhow!("--of {name}: {error}"))?;
            return Ok(Self::Pair(measure));
        }
        let channel = record.component(&input::component(record, name)?)?;
        match record.channels.iter().position(|other| other.name == channel.name) {
            Some(place) => Ok(Self::One(place)),
            None => bail!("--of {name}: this component is not selected; add --component {name}"),
        }
    }

    /// Returns the name of the part for use in a sentence.
    fn name(&self, record: &Record) -> anyhow::Result<String> {
        Ok(match self {
            Self::One(place) => record.channels[*place].name.clone(),
            Self::Pair(measure) => {
                let (first, second) = record.horizontal_pair()?;
                format!("{} and {} ({measure})", first.name, second.name)
            }
        })
    }

    /// Returns the record reduced to this part.
    fn alone(&self, record: &Record) -> anyhow::Result<Record> {
        match self {
            Self::One(place) => panels::only(record, *place),
            Self::Pair(_) => {
                let (first, second) = record.horizontal_pair()?;
                Ok(Record { channels: vec![first.clone(), second.clone()], ..record.clone() })
            }
        }
    }

    /// Returns the pseudo-acceleration (m/s²) of this part of a record at a period (s); for both horizontal components,
    /// the median or the largest value over all directions.
    fn response(&self, record: &Record, period: f64, damping: f64) -> anyhow::Result<f64> {
        match self {
            Self::One(place) => {
                let channel = &record.channels[*place];
                let peaks = response(channel.time_step, &channel.acceleration, period, damping)?;
                Ok(peaks.pseudo_acceleration)
            }
            Self::Pair(measure) => {
                let (one, two) = record.horizontal_pair()?;
                let (a, b) = (&one.acceleration, &two.acceleration);
                let peaks = rotated_spectrum(one.time_step, a, b, &[period], damping)?;
                let all_directions = |large: bool| {
                    peaks.iter().map(|peak| if large { peak.largest } else { peak.median }).sum()
                };
                Ok(all_directions(*measure == Horizontals::RotD100))
            }
        }
    }
}

/// Returns the matched record and, if its spectrum misses the target, a description of the periods at
/// which the spectrum misses.
fn matched(
    args: &MatchArgs,
    before: &Record,
    part: &Part,
    spectrum: &TargetSpectrum,
    settings: &Matching,
) -> anyhow::Result<(Record, Option<String>)> {
    let nearly = args.accept_misfit;
    let done = match part {
        Part::One(place) => before
            .matched(*place, spectrum, &args.to, settings, nearly)
            .map(|(after, matched)| (after, matched.missed)),
        Part::Pair(measure) => before
            .matched_pair(*measure, spectrum, &args.to, settings, nearly)
            .map(|(after, matched)| (after, matched.missed)),
    };
    let (after, missed) = done.map_err(|error| match error {
        MotionError::NotConverged { .. } => anyhow!("{error}: add --accept-misfit"),
        other @ (MotionError::Parameter { .. }
        | MotionError::NotScalable { .. }
        | MotionError::Zero { .. }
        | MotionError::NoChannel { .. }
        | MotionError::Mismatch { .. }) => other.into(),
    })?;
    Ok((after, (!missed.is_empty()).then(|| missed_in_words(&missed))))
}

/// Tabulates the target and the spectra before and after matching, at fixed periods within the matched range.
fn comparison(
    part: &Part,
    [before, after]: [&Record; 2],
    spectrum: &TargetSpectrum,
    settings: &Matching,
) -> anyhow::Result<Table> {
    let damping = spectrum.damping();
    let mut table =
        Table::new(0, ["period (s)", "target Sa (g)", "before (g)", "after (g)", "misfit"]);
    let within = |period: &&f64| (settings.shortest..=settings.longest).contains(*period);
    for period in [0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0].iter().filter(within) {
        let at = |record| part.response(record, *period, damping);
        let (goal, old, new) = (spectrum.acceleration(*period), at(before)?, at(after)?);
        table.row([
            format!("{period}"),
            number(goal / STANDARD_GRAVITY),
            number(old / STANDARD_GRAVITY),
            number(new / STANDARD_GRAVITY),
            percent(0.001 * (1000.0 * (new / goal - 1.0)).round()),
        ]);
    }
    Ok(table)
}
