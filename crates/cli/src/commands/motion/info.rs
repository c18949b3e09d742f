//! `barrelstack motion info`: what a file holds, so that a wrong unit or step is seen.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
use barrelstack_motion::{
    Channel, FORMATS, NoiseCriterion, Orientation, Quantity, Record, STANDARD_GRAVITY, Stage,
};
use serde_json::{Value, json};

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
        help = "Also CAV standardized, RMS, Housner, ASI, VSI, Fajfar, Sa, RotD50 and RotD100, and \
                the dominant velocity pulse"
    )]
    all_measures: bool,
    /// Print one JSON document, in SI units.
    #[arg(long)]
    json: bool,
    /// Where the table of folders goes.
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
            bail!("a folder is measured as a table: say where it goes, with --out DIR")
        }
        None => {}
    }
    let records = args.input.read_each()?;
    let records =
        if args.input.join { vec![args.input.unite(&records)?] } else { together(&records)? };
    let shown: Vec<&Shown> =
        USUAL.iter().chain(if args.all_measures { FURTHER } else { &[] }).collect();
    if args.json {
        let documents: Vec<Value> = records
            .iter()
            .map(|record| document(record, &shown, args.all_measures))
            .collect::<Result<_, _>>()?;
        let whole = json!({ "units": "m, s, degrees clockwise from north", "records": documents });
        printer::lines([serde_json::to_string_pretty(&whole)?])?;
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

/// Measures whole folders.
fn table(args: &InfoArgs, out: &Path) -> anyhow::Result<ExitCode> {
    if args.json || args.all_measures || args.input.join {
        bail!(
            "--json, --all-measures and --join are for files; the table of a folder has its own columns"
        );
    }
    let batch = Batch {
        input: &args.input,
        out,
        folder: &args.folder,
        settings: "info".to_owned(),
        periods: None,
        ending: None,
    };
    folder::run(&batch, &|_, record| Ok(Worked::as_read(record.clone())))?.tell()
}

/// Neighboring files of one event, station and step are one record.
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

/// What should be known of a record beside its numbers.
fn cautions(record: &Record) -> Vec<String> {
    let mut cautions: Vec<String> =
        record.warnings.iter().map(|warning| format!("{}: {warning}", record.file)).collect();
    if record.stage == Stage::Raw {
        cautions.push(format!(
            "{}: a raw record; its PGV and PGD are drift until it is processed (barrelstack motion \
             process)",
            record.file
        ));
    }
    cautions
}

/// Prints the cautions.
pub(super) fn warn(record: &Record) {
    for caution in cautions(record) {
        printer::warning(&caution);
    }
}

fn block(record: &Record, shown: &[&Shown], all: bool) -> anyhow::Result<Vec<String>> {
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
    let head = ["channel", "direction", "samples", "step (s)", "length (s)"];
    let mut channels = Table::new(2, head.map(str::to_owned));
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
    let recorded = recorded(record);
    if !recorded.is_empty() {
        lines.push(String::new());
        lines.extend(recorded.lines());
    }
    let stated = stated(record);
    if !stated.is_empty() {
        lines.push(String::new());
        lines.extend(stated.lines());
    }
    lines.push(String::new());
    let columns: Vec<(String, &Channel)> =
        record.channels.iter().map(|channel| (channel.name.clone(), channel)).collect();
    lines.extend(measures::table(&columns, shown)?.lines());
    if all {
        let rotated = measures::rotated(record);
        if let Err(error) = &rotated
            && record.channels.len() > 1
        {
            lines.extend([String::new(), format!("  no measure over all directions: {error}")]);
        }
        if let Ok(rotated) = rotated {
            let head = ["over all directions", "unit", "RotD50", "RotD100"];
            let mut table = Table::new(2, head.map(str::to_owned));
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
        lines.push(String::new());
        lines.extend(measures::pulses(record).into_iter().map(|line| format!("  {line}")));
    }
    if record.stage == Stage::Raw {
        lines.extend([
            String::new(),
            "  corners that the noise before the shaking suggests".to_owned(),
        ]);
        lines.extend(corners(record).into_iter().map(|line| format!("    {line}")));
    }
    if !record.notes.is_empty() {
        lines.extend([String::new(), "  what was done".to_owned()]);
        lines.extend(
            record
                .notes
                .iter()
                .map(|note| format!("    {}", note.strip_prefix("processing: ").unwrap_or(note))),
        );
    }
    Ok(lines)
}

fn stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Raw => "raw, as recorded",
        Stage::Corrected => "corrected",
        Stage::Unknown => "not stated",
    }
}

/// Where a channel points, in words.
pub(super) fn direction(channel: &Channel) -> String {
    match (channel.direction.azimuth, channel.direction.orientation) {
        (Some(azimuth), _) => format!("azimuth {azimuth}°"),
        (None, Some(Orientation::Vertical)) => "up".to_owned(),
        (None, Some(Orientation::Horizontal)) => "horizontal".to_owned(),
        (None, None) => "unknown".to_owned(),
    }
}

/// Corners of every channel, one sentence each; process takes them with `--corners auto`.
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

/// What a channel has in one column.
type Cell<'a> = &'a dyn Fn(&Channel) -> String;

/// When and where each channel was recorded, as far as the file tells; columns that would be empty
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
    let told: Vec<_> = columns
        .iter()
        .filter(|(_, cell)| record.channels.iter().any(|channel| !cell(channel).is_empty()))
        .collect();
    let words = told.iter().filter(|(head, _)| ["station", "sensor"].contains(head)).count();
    let head = std::iter::once("channel").chain(told.iter().map(|(head, _)| *head));
    let mut table = Table::new(1 + words, head.map(str::to_owned));
    for channel in record.channels.iter().filter(|_| !told.is_empty()) {
        let cells = told.iter().map(|(_, cell)| cell(channel));
        table.row(std::iter::once(channel.name.clone()).chain(cells));
    }
    table
}

/// Peaks of the header beside those of the numbers.
fn stated(record: &Record) -> Table {
    let head = ["channel", "stated peak", "unit", "header", "numbers", "agree"];
    let mut table = Table::new(3, head.map(str::to_owned));
    for channel in &record.channels {
        for peak in &channel.peaks {
            let (unit, factor) = match peak.quantity {
                Quantity::Acceleration => ("g", 1.0 / STANDARD_GRAVITY),
                Quantity::Velocity => ("cm/s", 100.0),
                Quantity::Displacement => ("cm", 100.0),
            };
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

fn document(record: &Record, shown: &[&Shown], all: bool) -> anyhow::Result<Value> {
    let mut channels = Vec::new();
    let corners = record.noise_corners(&NoiseCriterion::default());
    for (channel, corners) in record.channels.iter().zip(corners) {
        let motion = measures::sampled(channel)?;
        let mut values = serde_json::Map::new();
        for Shown { measure, .. } in shown {
            let value = json!({ "value": measure.of(&motion)?, "unit": measure.unit() });
            values.insert(measure.to_string(), value);
        }
        let peaks: Vec<Value> = channel
            .peaks
            .iter()
            .map(|peak| {
                json!({
                    "quantity": peak.quantity.to_string(),
                    "stated": peak.stated,
                    "measured": peak.measured,
                    "agrees": peak.agrees(),
                })
            })
            .collect();
        let pulse = all.then(|| measures::pulse(&motion).ok()).flatten().map(|fit| {
            json!({
                "period": fit.period,
                "peak_velocity": fit.peak_velocity,
                "start": fit.start,
                "energy_share": fit.energy_share,
            })
        });
        channels.push(json!({
            "name": channel.name,
            "azimuth": channel.direction.azimuth,
            "vertical": channel.is_vertical(),
            "start": channel.start.map(|start| start.to_string()),
            "station": channel.site.station,
            "sensor": channel.site.sensor,
            "latitude": channel.site.latitude,
            "longitude": channel.site.longitude,
            "elevation": channel.site.elevation,
            "vs30": channel.site.vs30,
            "samples": channel.acceleration.len(),
            "time_step": channel.time_step,
            "duration": channel.duration(),
            "initial_velocity": channel.initial_velocity,
            "stated_peaks": peaks,
            "noise_corners": corners.ok().map(|c| json!({
                "high_pass": c.high_pass,
                "low_pass": c.low_pass,
                "arrival": c.arrival,
                "least_ratio": c.least_ratio,
            })),
            "measures": values,
            "velocity_pulse": pulse,
        }));
    }
    let rotated = if all { measures::rotated(record).unwrap_or_default() } else { Vec::new() };
    let rotated: Vec<Value> = rotated
        .iter()
        .map(|row| {
            json!({
                "measure": row.measure.to_string(),
                "unit": row.measure.unit(),
                "rotd50": row.peak.median,
                "rotd100": row.peak.largest,
            })
        })
        .collect();
    Ok(json!({
        "file": record.file,
        "format": record.format,
        "event": record.event,
        "station": record.station,
        "stage": record.stage.to_string(),
        "channels": channels,
        "over_all_directions": rotated,
        "warnings": record.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "notes": record.notes,
    }))
}
