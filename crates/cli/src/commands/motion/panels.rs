//! Figures of a record, or of a record before and after processing: every component with its peaks,
//! Husid plots, and spectra.

use std::path::Path;

use anyhow::{anyhow, bail};
use barrelstack_motion::{
    Channel, FourierSpectrum, NoiseCriterion, Quantity, Record, ResponseSpectrum, STANDARD_GRAVITY,
    Sampled, TargetSpectrum, husid, rotated_spectrum, standard_periods,
};
use barrelstack_report::{Axis, Band, Figure, Format, Mark, Panels, Plot, Series, significant};

use super::measures::{columns, peak_reading};
use super::output::vacant;
use crate::store::store;

/// Damping ratio of the spectra.
const DAMPING: f64 = 0.05;
/// Resolution (dots per inch) of raster images, at which three plots side by side are about 2000
/// pixels wide.
const DPI: f64 = 96.0;
/// Limit of the velocity axis, relative to the peak velocity after processing; the larger drift
/// before processing is cut off.
const BEYOND: f64 = 1.5;

/// The quantities of a component that are plotted over time.
const QUANTITIES: [Quantity; 3] =
    [Quantity::Acceleration, Quantity::Velocity, Quantity::Displacement];

/// Returns the values of a quantity in its customary unit.
fn history(quantity: Quantity, motion: &Sampled) -> Vec<f64> {
    let (_, factor, _) = peak_reading(quantity);
    let values = match quantity {
        Quantity::Acceleration => motion.acceleration(),
        Quantity::Velocity => motion.velocity(),
        Quantity::Displacement => motion.displacement(),
    };
    values.iter().map(|value| factor * value).collect()
}

fn axis(quantity: Quantity, channel: &str) -> Axis {
    Axis::new(format!("{channel}: {quantity}"), peak_reading(quantity).0)
}

/// Plots a record: acceleration, velocity and displacement of every component with their peaks, the
/// build-up of the Arias intensity, and response and Fourier spectra.
///
/// The Fourier spectra show the corner frequencies suggested by the noise of the record as `read`.
pub(super) fn record(record: &Record, read: &Record) -> anyhow::Result<Figure> {
    let mut rows = Vec::new();
    for channel in &record.channels {
        let motion = channel.sampled()?;
        let row = QUANTITIES.map(|quantity| {
            let values = history(quantity, &motion);
            let marks = peak_mark(quantity, channel.time_step, &values).into_iter().collect();
            let series = vec![Series::new("", times(channel), values)];
            Plot { x: time(), y: axis(quantity, &channel.name), series, marks, ..Plot::default() }
        });
        rows.push(row.to_vec());
    }
    let corners = read.noise_corners(&NoiseCriterion::default());
    let corners: Vec<(f64, f64)> =
        corners.into_iter().flatten().map(|c| (c.high_pass, c.low_pass)).collect();
    let channels = columns(record);
    rows.push(vec![
        build_up(record),
        response(&channels, Some(record), None)?,
        fourier(&channels, &corners),
    ]);
    Ok(figure(record, "panels", "components, build-up of the Arias intensity, and spectra", rows))
}

/// Plots a record before and after processing: every component, response spectra, and Fourier
/// amplitudes.
pub(super) fn before_after(before: &Record, after: &Record) -> anyhow::Result<Figure> {
    compared(before, after, None)
}

/// Plots a record like [`before_after`], with the target spectrum that was matched.
pub(super) fn compared(
    before: &Record,
    after: &Record,
    target: Option<&TargetSpectrum>,
) -> anyhow::Result<Figure> {
    let mut rows = Vec::new();
    let mut channels = Vec::new();
    for (old, new) in before.channels.iter().zip(&after.channels) {
        let (was, is) = (old.sampled()?, new.sampled()?);
        // The longer record has pads at both ends, so its recorded part begins later.
        let shift = 0.5 * (new.duration() - old.duration());
        let row = QUANTITIES.map(|quantity| {
            let values = history(quantity, &is);
            let marks = peak_mark(quantity, new.time_step, &values).into_iter().collect();
            let peak = values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
            let range =
                (quantity != Quantity::Acceleration).then_some([-BEYOND * peak, BEYOND * peak]);
            let y = Axis { range, ..axis(quantity, &new.name) };
            let earlier: Vec<f64> = times(old).iter().map(|t| t + shift).collect();
            let series = vec![
                Series::new("before", earlier, history(quantity, &was)),
                Series::new("after", times(new), values),
            ];
            Plot { x: time(), y, series, marks, ..Plot::default() }
        });
        rows.push(row.to_vec());
        channels.push((format!("{} before", old.name), old));
        channels.push((format!("{} after", new.name), new));
    }
    let pair = target.filter(|_| after.channels.len() > 1).map(|_| after);
    rows.push(vec![response(&channels, pair, target)?, fourier(&channels, &[])]);
    Ok(figure(after, "before-after", "before and after", rows))
}

/// Writes a picture in the format of its extension.
pub(super) fn write(path: &Path, figure: &Figure) -> anyhow::Result<()> {
    store(path, &figure.to_bytes(known_format(path)?, DPI))
}

/// Returns an error if the extension of a path is not that of a picture format, or if [`vacant`] rejects the path.
pub(super) fn vacant_picture(path: &Path, overwrite: bool) -> anyhow::Result<()> {
    known_format(path)?;
    vacant(path, overwrite)
}

fn known_format(path: &Path) -> anyhow::Result<Format> {
    format_of(path)
        .ok_or_else(|| anyhow!("{}: figures are written as .svg, .png or .pdf", path.display()))
}

/// Returns the format of a picture by its extension; `None` for a folder.
pub(super) fn format_of(path: &Path) -> Option<Format> {
    let ending = path.extension()?;
    Format::ALL.into_iter().find(|format| ending.eq_ignore_ascii_case(format.extension()))
}

/// Returns a copy of a record with only the channel of index `place`; an error if there is no such channel.
pub(super) fn only(record: &Record, place: usize) -> anyhow::Result<Record> {
    let Some(channel) = record.channels.get(place) else { bail!("there is no such component") };
    Ok(Record { channels: vec![channel.clone()], ..record.clone() })
}

fn figure(record: &Record, id: &str, what: &str, rows: Vec<Vec<Plot>>) -> Figure {
    let parts = [record.station.as_str(), record.event.as_str()];
    let known: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    // The folders of this machine mean nothing to other readers of the picture.
    let file = Path::new(&record.file).file_name().unwrap_or_default().to_string_lossy();
    let title = if known.is_empty() { file.to_string() } else { known.join(", ") };
    let mut lines = vec![format!("{file}, format {}, stage {}", record.format, record.stage)];
    if let Some(channel) = record.channels.first() {
        let start = channel.start.map_or_else(String::new, |start| format!(", from {start}"));
        let samples = channel.acceleration.len();
        lines.push(format!("{samples} samples, one every {} s{start}", channel.time_step));
    }
    let caption = format!("{title}: {what}");
    Figure::new(id, caption, Panels { title, lines, rows })
}

pub(super) fn time() -> Axis {
    Axis::new("time", "s")
}

pub(super) fn times(channel: &Channel) -> Vec<f64> {
    (0..channel.acceleration.len()).map(|k| k as f64 * channel.time_step).collect()
}

/// Returns the value with the largest magnitude, including its sign.
fn at_peak(values: &[f64]) -> f64 {
    let larger =
        |best: usize, k: usize| if values[k].abs() > values[best].abs() { k } else { best };
    (0..values.len()).reduce(larger).unwrap_or(0) as f64
}

fn peak_mark(quantity: Quantity, time_step: f64, values: &[f64]) -> Option<Mark> {
    let (unit, _, peak) = peak_reading(quantity);
    let at = time_step * at_peak(values);
    let largest = values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let label = format!("{peak} {} {unit} at {} s", significant(largest, 3), significant(at, 4));
    (!values.is_empty()).then_some(Mark { at, label })
}

/// Plots the build-up of the Arias intensity (Husid plots), with the strong-motion part of the
/// strongest component shaded.
fn build_up(record: &Record) -> Plot {
    let mut plot =
        Plot { x: time(), y: Axis::new("share of the Arias intensity", ""), ..Plot::default() };
    let strongest = record.channels.iter().reduce(|a, b| if b.pga() > a.pga() { b } else { a });
    for channel in &record.channels {
        let values = husid(&channel.acceleration);
        if strongest.is_some_and(|strongest| std::ptr::eq(strongest, channel)) {
            let at = |share: f64| {
                values.iter().position(|v| *v >= share).unwrap_or(0) as f64 * channel.time_step
            };
            let (from, to) = (at(0.05), at(0.95));
            let label = format!("{}: D5-95 {} s", channel.name, significant(to - from, 3));
            plot.bands.push(Band { from, to, label });
        }
        plot.series.push(Series::new(channel.name.as_str(), times(channel), values));
    }
    plot
}

/// Plots response spectra and, if a target is given, the target. If there are two horizontals, the
/// spectra over all directions are plotted, too.
fn response(
    channels: &[(String, &Channel)],
    whole: Option<&Record>,
    target: Option<&TargetSpectrum>,
) -> anyhow::Result<Plot> {
    let periods = standard_periods(30);
    let damping = target.map_or(DAMPING, TargetSpectrum::damping);
    let in_g = |values: Vec<f64>| values.iter().map(|v| v / STANDARD_GRAVITY).collect::<Vec<f64>>();
    let mut plot = Plot {
        x: Axis::new("period", "s").log(),
        y: Axis::new(format!("pseudo-acceleration, {}", super::table::percent(damping)), "g").log(),
        ..Plot::default()
    };
    if let Some(target) = target {
        let values = periods.iter().map(|t| target.acceleration(*t)).collect();
        plot.series.push(Series::new("target", periods.clone(), in_g(values)));
    }
    for (name, channel) in channels {
        let spectrum =
            ResponseSpectrum::new(channel.time_step, &channel.acceleration, &periods, damping)?;
        let values = in_g(spectrum.pseudo_acceleration());
        plot.series.push(Series::new(name.as_str(), periods.clone(), values));
    }
    if let Some((one, two)) = whole.and_then(|record| record.horizontal_pair().ok()) {
        let peaks = rotated_spectrum(
            one.time_step,
            &one.acceleration,
            &two.acceleration,
            &periods,
            damping,
        )?;
        let median = peaks.iter().map(|peak| peak.median).collect();
        let largest = peaks.iter().map(|peak| peak.largest).collect();
        plot.series.push(Series::new("RotD50", periods.clone(), in_g(median)));
        plot.series.push(Series::new("RotD100", periods, in_g(largest)));
    }
    Ok(plot)
}

/// Returns the axes of Fourier amplitude plots.
pub(super) fn fourier_axes() -> (Axis, Axis) {
    (Axis::new("frequency", "Hz").log(), Axis::new("Fourier amplitude", "m/s").log())
}

/// Returns the Fourier amplitudes of a channel.
pub(super) fn fourier_series(name: &str, channel: &Channel) -> Series {
    let spectrum = FourierSpectrum::new(channel.time_step, &channel.acceleration);
    // A logarithmic axis cannot show frequency 0.
    Series::new(name, spectrum.frequency[1..].to_vec(), spectrum.amplitude[1..].to_vec())
}

/// Plots Fourier amplitudes, with the corner frequencies suggested by the noise.
fn fourier(channels: &[(String, &Channel)], corners: &[(f64, f64)]) -> Plot {
    let (x, y) = fourier_axes();
    let mut plot = Plot {
        x,
        y,
        series: channels.iter().map(|(name, channel)| fourier_series(name, channel)).collect(),
        ..Plot::default()
    };
    let mut known: Vec<f64> = Vec::new();
    for (corner, what) in
        corners.iter().flat_map(|(high, low)| [(*high, "high-pass"), (*low, "low-pass")])
    {
        if !known.contains(&corner) {
            known.push(corner);
            let label = format!("{what} {} Hz", significant(corner, 3));
            plot.marks.push(Mark { at: corner, label });
        }
    }
    plot
}
