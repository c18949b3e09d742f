//! `barrelstack motion info`: the contents of a file, to check units and time steps.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
use barrelstack_motion::{
    Channel, Corners, FORMATS, NoiseCriterion, Orientation, Processing, PulseFit, Record, Stage,
    StatedPeak,
};
use barrelstack_report::described;

use super::folder::{self, Batch, FolderArgs, Worked};
use super::input::Input;
use super::measures::{self, FURTHER, Shown, USUAL};
use super::table::{Table, number};
use crate::printer;

/// Arguments of `info`.
#[derive(Debug, clap::Args)]
pub(super) struct InfoArgs {
    #[command(flatten)]
    input: Input,
    #[arg(
        long,
        help = "Also print standardized CAV, RMS, Housner, ASI, VSI, Fajfar, Sa, RotD50 and RotD100, \
                and the dominant velocity pulse"
    )]
    all_measures: bool,
    /// Print one JSON document, in SI units.
    #[arg(long)]
    json: bool,
    /// Folder for the table of all records, if the input is a folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    folder: FolderArgs,
}

/// Prints header, channels, stated peaks and measures of every record.
pub(super) fn info(args: &InfoArgs) -> anyhow::Result<ExitCode> {
    match &args.out {
        Some(out) => return table(args, out),
        None if args.input.has_folder() => {
            bail!(
                "the input is a folder or an archive of several records, whose measures are written to a table: \
                 give the folder of this table with --out DIR"
            )
        }
        None => args.folder.tables.need(false)?,
    }
    let records = args.input.read_each()?;
    let records =
        if args.input.join { vec![args.input.unite(&records)?] } else { together(&records)? };
    let shown = [USUAL, if args.all_measures { FURTHER } else { &[] }].concat();
    if args.json {
        let documents = records.iter().map(|record| document(record, &shown, args.all_measures));
        let records = documents.collect::<Result<_, _>>()?;
        printer::document(&MotionInfo { schema: "motion-info/1", records })?;
    } else {
        let mut lines = Vec::new();
        for record in &records {
            if !lines.is_empty() {
                lines.push(String::new());
            }
            lines.extend(block(record, &shown, args.all_measures)?);
        }
        printer::lines(lines)?;
    }
    for record in &records {
        warn(record);
    }
    Ok(ExitCode::SUCCESS)
}

/// Measures all records of folders, and writes the table.
fn table(args: &InfoArgs, out: &Path) -> anyhow::Result<ExitCode> {
    if args.json || args.all_measures || args.input.join {
        bail!(
            "--json, --all-measures and --join apply to single files, not to folders, whose table has fixed columns; \
             leave these options out for a folder"
        );
    }
    let batch = Batch::new(&args.input, out, &args.folder, "info".to_owned());
    folder::run(&batch, &|_, record| Ok(Worked::as_read(record.clone())))?.print_summary()
}

/// Combines consecutive records of the same event, station and time step into one record.
fn together(records: &[Record]) -> anyhow::Result<Vec<Record>> {
    let mut groups: Vec<Vec<Record>> = Vec::new();
    for record in records {
        let fits = |group: &Vec<Record>| {
            let first = &group[0];
            let same_step =
                |a: &Channel, b: &Channel| (a.time_step / b.time_step - 1.0).abs() < 1e-9;
            Record::gather(&[first.clone(), record.clone()]).is_ok()
                && !(first.event.is_empty() && first.station.is_empty())
                && same_step(&first.channels[0], &record.channels[0])
        };
        match groups.last_mut() {
            Some(group) if fits(group) => group.push(record.clone()),
            _ => groups.push(vec![record.clone()]),
        }
    }
    groups.iter().map(|group| Ok(Record::gather(group)?)).collect()
}

/// Prints warnings about a record.
pub(super) fn warn(record: &Record) {
    for warning in &record.warnings {
        printer::warning(&format!("{}: {warning}", record.file));
    }
    if record.is_part() {
        printer::warning(&format!(
            "{}: `barrelstack motion convert FIRST SECOND --join -o whole.txt` joins the parts; give whole.txt to \
             `run` with --record",
            record.file
        ));
    }
    if record.stage == Stage::Raw {
        printer::warning(&format!(
            "{}: this is a raw record; its PGV and PGD are dominated by drift until it is processed: `run` processes \
             it, and `barrelstack motion process` writes the processed record",
            record.file
        ));
    }
}

fn block(record: &Record, shown: &[Shown], all: bool) -> anyhow::Result<Vec<String>> {
    let title = FORMATS.iter().find(|format| format.name == record.format);
    let mut lines: Vec<String> = record.file.split(", ").map(str::to_owned).collect();
    let mut row = |name: &str, value: &str| {
        let value = if value.is_empty() { "not stated" } else { value };
        lines.push(format!("  {name:10}{value}"));
    };
    row("format", title.map_or(record.format, |format| format.title));
    row("event", &record.event);
    row("station", &record.station);
    row("stage", stage(record.stage));
    lines.push(String::new());
    let mut channels = Table::new(2, ["channel", "direction", "samples", "step (s)", "length (s)"]);
    for channel in &record.channels {
        channels.row([
            channel.name.clone(),
            direction(channel),
            channel.acceleration.len().to_string(),
            format!("{}", channel.time_step),
            number(channel.duration()),
        ]);
    }
    lines.extend(channels.lines());
    for table in [recorded(record), stated(record)].iter().filter(|table| !table.is_empty()) {
        lines.push(String::new());
        lines.extend(table.lines());
    }
    lines.push(String::new());
    lines.extend(measures::table(&measures::columns(record), shown)?.lines());
    if all {
        match measures::rotated(record) {
            Err(error) if record.channels.len() > 1 => {
                lines
                    .extend([String::new(), format!("  no measures over all directions: {error}")]);
            }
            Err(_) => {}
            Ok(rotated) => {
                let mut table = Table::new(2, ["over all directions", "unit", "RotD50", "RotD100"]);
                for row in rotated {
                    let (unit, factor) = measures::reading(&row.measure);
                    table.row([
                        row.name,
                        unit.to_owned(),
                        number(factor * row.peak.median),
                        number(factor * row.peak.largest),
                    ]);
                }
                lines.push(String::new());
                lines.extend(table.lines());
            }
        }
        lines.push(String::new());
        lines.extend(measures::pulses(record).into_iter().map(|line| format!("  {line}")));
    }
    if record.stage == Stage::Raw {
        lines.extend([String::new(), "  processing in a run".to_owned()]);
        lines.extend(in_a_run().into_iter().map(|line| format!("    {line}")));
        lines.extend([
            String::new(),
            "  corners suggested by the noise before the shaking".to_owned(),
        ]);
        lines.extend(corners(record).into_iter().map(|line| format!("    {line}")));
    }
    if !record.notes.is_empty() {
        lines.extend([String::new(), "  processing".to_owned()]);
        let step = |note: &String| note.strip_prefix("processing: ").unwrap_or(note).to_owned();
        lines.extend(record.notes.iter().map(|note| format!("    {}", step(note))));
    }
    Ok(lines)
}

/// Describes the processing of a raw record in a run, and how to change it.
fn in_a_run() -> [String; 3] {
    let chain = Processing::compact();
    let corner = |corner: Option<f64>, name: &str| match corner {
        Some(frequency) => format!("a {name} corner at {frequency} Hz"),
        None => format!("no {name} corner"),
    };
    [
        format!(
            "`run` removes the mean before the shaking, filters with {} and {}, and corrects the baseline so that \
             velocity and displacement end at zero",
            corner(chain.high_pass, "high-pass"),
            corner(chain.low_pass, "low-pass"),
        ),
        "other corners: `barrelstack motion process FILE --corners auto -o processed.txt`, or --high-pass and \
         --low-pass; then `run --record processed.txt`"
            .to_owned(),
        "no processing: `run --set motion.processing=none`".to_owned(),
    ]
}

fn stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Raw => "raw, as recorded",
        Stage::Corrected => "corrected",
        Stage::Unknown => "not stated",
    }
}

/// Describes the direction of a channel.
fn direction(channel: &Channel) -> String {
    match (channel.direction.azimuth, channel.direction.orientation) {
        (Some(azimuth), _) => format!("azimuth {azimuth}°"),
        (None, Some(Orientation::Vertical)) => "up".to_owned(),
        (None, Some(Orientation::Horizontal)) => "horizontal".to_owned(),
        (None, None) => "unknown".to_owned(),
    }
}

/// Describes, in one sentence per channel, the corner frequencies that `process --corners auto`
/// uses.
fn corners(record: &Record) -> Vec<String> {
    let criterion = NoiseCriterion::default();
    let found = record.channels.iter().zip(record.noise_corners(&criterion));
    found
        .map(|(channel, corners)| match corners {
            Ok(corners) => format!("{}: {}", channel.name, corners.sentence(&criterion)),
            Err(error) => format!("none: {error}"),
        })
        .collect()
}

/// Function that formats a channel for one column.
type Cell<'a> = &'a dyn Fn(&Channel) -> String;

/// Tabulates the start time and the location of each channel, as stated in the file; empty columns
/// are left out.
fn recorded(record: &Record) -> Table {
    let degrees = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.4}"));
    let meters = |value: Option<f64>| value.map_or_else(String::new, number);
    let several = record.channels.iter().any(|c| c.site.station != record.station);
    let station = |c: &Channel| if several { c.site.station.clone() } else { String::new() };
    let columns: [(&str, Cell<'_>); 7] = [
        ("station", &station),
        ("sensor", &|c| c.site.sensor.clone()),
        ("start (UTC)", &|c| c.start.map_or_else(String::new, |start| start.to_string())),
        ("latitude", &|c| degrees(c.site.latitude)),
        ("longitude", &|c| degrees(c.site.longitude)),
        ("elevation (m)", &|c| meters(c.site.elevation)),
        ("Vs30 (m/s)", &|c| meters(c.site.vs30)),
    ];
    let shown: Vec<_> = columns
        .iter()
        .filter(|(_, cell)| record.channels.iter().any(|channel| !cell(channel).is_empty()))
        .collect();
    let words = shown.iter().filter(|(head, _)| ["station", "sensor"].contains(head)).count();
    let head = std::iter::once("channel").chain(shown.iter().map(|(head, _)| *head));
    let mut table = Table::new(1 + words, head);
    for channel in record.channels.iter().filter(|_| !shown.is_empty()) {
        let cells = shown.iter().map(|(_, cell)| cell(channel));
        table.row(std::iter::once(channel.name.clone()).chain(cells));
    }
    table
}

/// Tabulates the peaks that the header states, and the peaks of the samples.
fn stated(record: &Record) -> Table {
    let mut table = Table::new(3, ["channel", "stated peak", "unit", "header", "numbers", "agree"]);
    for channel in &record.channels {
        for peak in &channel.peaks {
            let (unit, factor, _) = measures::peak_reading(peak.quantity);
            table.row([
                channel.name.clone(),
                peak.quantity.to_string(),
                unit.to_owned(),
                number(factor * peak.stated),
                number(factor * peak.measured),
                if peak.agrees() { "yes" } else { "NO" }.to_owned(),
            ]);
        }
    }
    table
}

described! {
    /// Contents of motion records. Lengths are in m, times in s, and directions in degrees clockwise from north.
    pub(crate) struct MotionInfo {
        /// Name and version of the format of this document.
        schema: &'static str ["motion-info/1"],
        /// The records.
        records: Vec<RecordInfo>,
    }

    /// A record.
    struct RecordInfo of found: (&Record, Vec<ChannelInfo>, &[measures::Rotated]) {
        /// Path of the file.
        file: String = found.0.file.clone(),
        /// Format of the file.
        format: &'static str = found.0.format,
        /// The event, as stated in the file.
        event: String = found.0.event.clone(),
        /// The station, as stated in the file.
        station: String = found.0.station.clone(),
        /// Stage of processing: raw or corrected.
        stage: String = found.0.stage.to_string(),
        /// Components of the record.
        channels: Vec<ChannelInfo> = found.1,
        /// Peaks over all horizontal directions; empty unless all measures are requested.
        over_all_directions: Vec<RotatedInfo> = found.2.iter().map(RotatedInfo::of).collect(),
        /// Warnings about the record.
        warnings: Vec<String> = found.0.warnings.iter().map(ToString::to_string).collect(),
        /// Notes on the processing of the record.
        notes: Vec<String> = found.0.notes.clone(),
    }

    /// One component of a record.
    struct ChannelInfo of found: (&Channel, Option<Corners>, BTreeMap<String, MeasureInfo>, Option<PulseFit>) {
        /// Name of the component.
        name: String = found.0.name.clone(),
        /// Azimuth of the component, clockwise from north; null if unknown.
        azimuth: Option<f64> as "deg" = found.0.direction.azimuth,
        /// `true` if the component is vertical.
        vertical: bool = found.0.is_vertical(),
        /// Universal time of the first sample.
        start: Option<String> = found.0.start.map(|start| start.to_string()),
        /// Name of the station.
        station: String = found.0.site.station.clone(),
        /// Name of the sensor.
        sensor: String = found.0.site.sensor.clone(),
        /// Latitude, positive to the north.
        latitude: Option<f64> as "deg" = found.0.site.latitude,
        /// Longitude, positive to the east.
        longitude: Option<f64> as "deg" = found.0.site.longitude,
        /// Elevation.
        elevation: Option<f64> as "m" = found.0.site.elevation,
        /// Mean shear-wave velocity of the upper 30 m.
        vs30: Option<f64> as "m/s" = found.0.site.vs30,
        /// Number of samples.
        samples: usize = found.0.acceleration.len(),
        /// Time between two samples.
        time_step: f64 as "s" = found.0.time_step,
        /// Time from the first sample to the last.
        duration: f64 as "s" = found.0.duration(),
        /// Velocity at the first sample.
        initial_velocity: f64 as "m/s" = found.0.initial_velocity,
        /// Peaks that the file states, with the corresponding peaks of the samples.
        stated_peaks: Vec<PeakInfo> = found.0.peaks.iter().map(PeakInfo::of).collect(),
        /// Frequencies between which the signal exceeds the noise; null if they are unknown.
        noise_corners: Option<CornersInfo> = found.1.as_ref().map(CornersInfo::of),
        /// Intensity measures, by name.
        measures: BTreeMap<String, MeasureInfo> = found.2,
        /// The dominant velocity pulse; null unless all measures are requested.
        velocity_pulse: Option<PulseInfo> = found.3.as_ref().map(PulseInfo::of),
    }

    /// A peak stated in a file.
    struct PeakInfo of peak: &StatedPeak {
        /// Quantity whose peak is stated.
        quantity: String = peak.quantity.to_string(),
        /// Stated peak, in SI units.
        stated: f64 as "SI" = peak.stated,
        /// Peak of the samples, in SI units.
        measured: f64 as "SI" = peak.measured,
        /// `true` if the stated peak and the peak of the samples agree.
        agrees: bool = peak.agrees(),
    }

    /// Frequencies between which the signal exceeds the noise.
    struct CornersInfo of found: &Corners {
        /// Lower corner frequency.
        high_pass: f64 as "Hz" = found.high_pass,
        /// Upper corner frequency.
        low_pass: f64 as "Hz" = found.low_pass,
        /// Time at which the signal arrives.
        arrival: f64 as "s" = found.arrival,
        /// Required signal-to-noise ratio.
        least_ratio: f64 as "1" = found.least_ratio,
    }

    /// An intensity measure.
    struct MeasureInfo of found: (f64, &str) {
        /// Value of the measure, in the unit that `unit` states.
        value: f64 as "as `unit` says" = found.0,
        /// Unit of the value.
        unit: String = found.1.to_owned(),
    }

    /// The dominant velocity pulse of a component.
    struct PulseInfo of fit: &PulseFit {
        /// Period of the pulse.
        period: f64 as "s" = fit.period,
        /// Peak velocity of the pulse.
        peak_velocity: f64 as "m/s" = fit.peak_velocity,
        /// Time at which the pulse starts.
        start: f64 as "s" = fit.start,
        /// Energy of the pulse divided by the energy of the record; energy is the integral of the squared velocity.
        energy_share: f64 as "1" = fit.energy_share,
    }

    /// A peak over all horizontal directions.
    struct RotatedInfo of row: &measures::Rotated {
        /// Name of the measure.
        measure: String = row.measure.to_string(),
        /// Unit of both values.
        unit: String = row.measure.unit().to_string(),
        /// Median over all directions.
        rotd50: f64 as "as `unit` says" = row.peak.median,
        /// Largest value over all directions.
        rotd100: f64 as "as `unit` says" = row.peak.largest,
    }
}

fn document(record: &Record, shown: &[Shown], all: bool) -> anyhow::Result<RecordInfo> {
    let mut channels = Vec::new();
    let corners = record.noise_corners(&NoiseCriterion::default());
    for (channel, corners) in record.channels.iter().zip(corners) {
        let motion = channel.sampled()?;
        let mut values = BTreeMap::new();
        for (_, measure) in shown {
            let value = MeasureInfo::of((measure.of(&motion)?, measure.unit()));
            values.insert(measure.to_string(), value);
        }
        let pulse = all.then(|| measures::pulse(&motion).ok()).flatten();
        channels.push(ChannelInfo::of((channel, corners.ok(), values, pulse)));
    }
    let rotated = if all { measures::rotated(record).unwrap_or_default() } else { Vec::new() };
    Ok(RecordInfo::of((record, channels, &rotated)))
}
