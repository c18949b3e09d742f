//! `barrelstack motion spectrum`: peak responses of oscillators, per component and over all
//! directions.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{anyhow, bail};
use barrelstack::scenario::Dimension;
use barrelstack_motion::{
    Channel, Record, ResponsePeaks, RotatedPeak, STANDARD_GRAVITY, response, rotated_spectrum,
    standard_periods,
};
use barrelstack_report::csv_field;

use super::info;
use super::input::{Chain, Choice, Input, number_or};
use super::output::vacant;
use super::process::share;
use super::table::{Table, number, percent};
use crate::printer;
use crate::tables::write_one;

/// Arguments of `spectrum`.
#[derive(Debug, clap::Args)]
pub(super) struct SpectrumArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    choice: Choice,
    /// Damping ratio, such as 0.05 or "5 %"; may be repeated.
    #[arg(long, value_name = "SHARE", default_value = "5 %")]
    damping: Vec<String>,
    /// Periods separated by commas, in seconds or each with its own unit, such as "100 ms,0.2,1"; a
    /// period of 0 gives the peak ground acceleration. By default, 16 periods are printed and 121
    /// are written.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    periods: Vec<String>,
    #[arg(
        long,
        help = "Also compute RotD50 and RotD100, the median and the largest value over all horizontal directions"
    )]
    rotd: bool,
    /// Write the spectrum as .csv or .xlsx, in SI units.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists.
    #[arg(long, requires = "output")]
    overwrite: bool,
}

const PRINTED: [f64; 16] =
    [0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 10.0];

/// The response spectra of one record at one damping ratio.
struct Spectra {
    periods: Vec<f64>,
    damping: f64,
    channels: Vec<(String, Vec<ResponsePeaks>)>,
    rotated: Option<Rotated>,
}

/// Peak responses over all horizontal directions, with the direction of the largest response at each period.
struct Rotated {
    peaks: Vec<RotatedPeak>,
    /// Direction of the largest response at each period (degrees): clockwise from north if both azimuths are known,
    /// otherwise from the first component towards the second.
    directions: Vec<f64>,
    /// Reference from which `directions` are measured, as stated in column headings.
    from: &'static str,
}

impl Rotated {
    fn of((one, two): (&Channel, &Channel), periods: &[f64], damping: f64) -> anyhow::Result<Self> {
        let (a, b) = (&one.acceleration, &two.acceleration);
        let peaks = rotated_spectrum(one.time_step, a, b, periods, damping)?;
        let azimuths: Option<Vec<f64>> =
            peaks.iter().map(|peak| peak.azimuth(&one.direction, &two.direction)).collect();
        let from = if azimuths.is_some() { "azimuth" } else { "from the first" };
        let directions = azimuths.unwrap_or_else(|| peaks.iter().map(|p| p.angle).collect());
        Ok(Self { peaks, directions, from })
    }
}

impl Spectra {
    fn of(record: &Record, periods: &[f64], damping: f64, rotd: bool) -> anyhow::Result<Self> {
        let mut channels = Vec::new();
        for channel in &record.channels {
            let peaks = periods
                .iter()
                .map(|period| response(channel.time_step, &channel.acceleration, *period, damping))
                .collect::<Result<Vec<_>, _>>()?;
            channels.push((channel.name.clone(), peaks));
        }
        let pair = rotd.then(|| record.horizontal_pair()).transpose();
        let pair = pair.map_err(|error| anyhow!("--rotd: {error}"))?;
        let rotated = pair.map(|pair| Rotated::of(pair, periods, damping)).transpose()?;
        Ok(Self { periods: periods.to_vec(), damping, channels, rotated })
    }

    fn table(&self) -> Vec<String> {
        let mut head = vec!["period (s)".to_owned()];
        for (name, _) in &self.channels {
            head.extend([format!("{name} Sa (g)"), "PSV (cm/s)".to_owned(), "Sd (cm)".to_owned()]);
        }
        if let Some(rotated) = &self.rotated {
            head.extend(["RotD50 Sa (g)", "RotD100 Sa (g)"].map(str::to_owned));
            head.push(format!("{} (°)", rotated.from));
        }
        let mut table = Table::new(0, head);
        for (k, period) in self.periods.iter().enumerate() {
            let mut row = vec![format!("{period}")];
            for (_, peaks) in &self.channels {
                row.push(number(peaks[k].pseudo_acceleration / STANDARD_GRAVITY));
                row.push(number(100.0 * peaks[k].pseudo_velocity));
                row.push(number(100.0 * peaks[k].displacement));
            }
            if let Some(rotated) = &self.rotated {
                row.push(number(rotated.peaks[k].median / STANDARD_GRAVITY));
                row.push(number(rotated.peaks[k].largest / STANDARD_GRAVITY));
                row.push(format!("{:.0}", rotated.directions[k]));
            }
            table.row(row);
        }
        let title = format!("pseudo-spectra at {} damping", percent(self.damping));
        std::iter::once(title).chain(table.lines()).collect()
    }

    fn csv(&self, text: &mut String) {
        let damping = self.damping;
        let mut head = vec!["damping".to_owned(), "period (s)".to_owned()];
        for (name, _) in &self.channels {
            let name = name.replace(',', " ");
            head.extend([
                format!("{name} pseudo-acceleration (m/s2)"),
                format!("{name} pseudo-velocity (m/s)"),
                format!("{name} displacement (m)"),
                format!("{name} absolute acceleration (m/s2)"),
            ]);
        }
        if let Some(rotated) = &self.rotated {
            head.extend(["RotD50 (m/s2)", "RotD100 (m/s2)"].map(str::to_owned));
            head.push(format!("direction of RotD100 (deg {})", rotated.from));
        }
        if text.is_empty() {
            let head: Vec<String> = head.iter().map(|cell| csv_field(cell)).collect();
            text.push_str(&head.join(","));
            text.push('\n');
        }
        for (k, period) in self.periods.iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = write!(text, "{damping},{period}");
            for (_, peaks) in &self.channels {
                let p = &peaks[k];
                let _ = write!(
                    text,
                    ",{},{},{},{}",
                    p.pseudo_acceleration, p.pseudo_velocity, p.displacement, p.acceleration
                );
            }
            if let Some(rotated) = &self.rotated {
                let (r, direction) = (&rotated.peaks[k], rotated.directions[k]);
                let _ = write!(text, ",{},{},{direction}", r.median, r.largest);
            }
            text.push('\n');
        }
    }
}

/// Computes the spectra, prints them, and writes them if requested.
pub(super) fn spectrum(args: &SpectrumArgs) -> anyhow::Result<()> {
    if let Some(output) = &args.output {
        let is =
            |of: &str| output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(of));
        if !is("csv") && !is("xlsx") {
            bail!("{}: spectra are written as .csv or .xlsx", output.display());
        }
        vacant(output, args.overwrite)?;
    }
    let period = |text: &String| number_or("--periods", text, Dimension::TIME);
    let given = args.periods.iter().map(period).collect::<Result<Vec<_>, _>>()?;
    let or = |other: Vec<f64>| if given.is_empty() { other } else { given.clone() };
    let dampings: Vec<f64> =
        args.damping.iter().map(|text| share("--damping", text)).collect::<Result<_, _>>()?;
    let read = args.input.read()?;
    let record = args.choice.take(&read, Chain::Default)?;
    let mut lines = record.notes.clone();
    let mut text = String::new();
    for damping in dampings {
        if !lines.is_empty() {
            lines.push(String::new());
        }
        lines.extend(Spectra::of(&record, &or(PRINTED.to_vec()), damping, args.rotd)?.table());
        if args.output.is_some() {
            let periods = or(standard_periods(40));
            Spectra::of(&record, &periods, damping, args.rotd)?.csv(&mut text);
        }
    }
    if let Some(output) = &args.output {
        write_one(output, &text)?;
        lines.extend([String::new(), format!("written: {}", output.display())]);
    }
    printer::lines(lines)?;
    info::warn(&Record { stage: record.stage, ..read });
    Ok(())
}
