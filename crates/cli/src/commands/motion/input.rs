//! Input of the motion commands: files, how they are combined, and the components selected from
//! them.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail};
use barrelstack::scenario::{Dimension, Quantity};
use barrelstack_motion::{
    self as motion, AccelerationUnit, Component, Given, Instrument, Pads, Processing, ReadError,
    ReadOptions, Record, Refusal, Stage, bundled, read, station_xml,
};
use clap::ValueEnum;

use super::archives;
pub(super) use crate::store::plain;
use crate::typed::typed;

/// Maximum size (bytes) of a file that is read, about ten times the size of the largest
/// strong-motion files.
const LIMIT: u64 = 256 << 20;

/// Files, and options for information that the files may lack.
#[derive(Debug, clap::Args)]
pub(super) struct Input {
    /// Motion files of any known format, or napa-college-2014, which is bundled. Several files are
    /// read as components of one record; for files that do not belong together, `info` lists each
    /// file separately. `info`, `plot`, `process`, `convert` and `select` also accept folders, and use
    /// all records in them.
    #[arg(required = true, value_name = "FILE")]
    pub(super) files: Vec<String>,
    /// Join several files into one long record; each file must overlap the next.
    #[arg(long)]
    pub(super) join: bool,
    /// Combine the components of several files even if they differ in station, sensor, event or
    /// publisher.
    #[arg(long, conflicts_with = "join")]
    pub(super) allow_mixed: bool,
    /// Unit of acceleration if a file does not state one: g, g/10, m/s2, cm/s2, gal, mm/s2, ft/s2
    /// or in/s2.
    #[arg(long, value_name = "UNIT")]
    unit: Option<String>,
    /// Time step if a file does not state one, such as "0.005 s".
    #[arg(long, value_name = "TIME")]
    time_step: Option<String>,
    /// Sensitivity of files that contain counts, in counts per m/s2, for all channels, or for one channel, as in
    /// HNE=427819; may be repeated for other channels.
    #[arg(long, value_name = "[CHANNEL=]NUMBER")]
    sensitivity: Vec<String>,
    /// `StationXML` file with the sensitivity and direction of each channel, or a folder of such
    /// files; by default, the .xml files in the folder of a file in counts are used.
    #[arg(long, value_name = "PATH")]
    station_xml: Option<PathBuf>,
    /// Quantity recorded in SEED and SAC files of instruments other than accelerometers; velocities
    /// and displacements are differentiated to accelerations.
    #[arg(long = "as", value_enum, value_name = "QUANTITY")]
    recorded: Option<Recorded>,
}

typed! {
    /// Quantity recorded by an instrument.
    pub(super) enum Recorded of motion::Quantity {
        /// Accelerations, regardless of the channel code.
        Acceleration = Self::Acceleration,
        /// Velocities; the sensitivity is then in counts per m/s.
        Velocity = Self::Velocity,
        /// Displacements; the sensitivity is then in counts per m.
        Displacement = Self::Displacement,
    }
}

/// Components to use, and the processing to apply first.
#[derive(Debug, clap::Args)]
pub(super) struct Choice {
    /// Component to use: a name in the file, an azimuth in degrees (computed by rotation if no channel has this
    /// azimuth), h1, h2 or vertical; may be repeated. By default, all components are used.
    #[arg(long, value_name = "NAME")]
    pub(super) component: Vec<String>,
    /// Processing to apply first; by default, `convert` uses the numbers as read, and all other
    /// commands use `default`.
    #[arg(long, value_enum)]
    pub(super) processing: Option<Chain>,
}

/// Named chains of processing steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Chain {
    /// Use the numbers as read.
    None,
    /// Process as in a scenario: the chain `compact` for raw records, and no processing for all others.
    Default,
    /// Remove the pre-event mean, taper 2 % of each end, apply a zero-phase high-pass filter at 0.1 Hz, remove the pads
    /// of the filter, and bring the final velocity and displacement to zero.
    Compact,
    /// Like `compact`, but keep the pads of the filter: quiet time before and after the shaking.
    Padded,
}

impl Chain {
    /// Returns the processing steps of this chain for a record; `stage` is the processing stage that the
    /// file states.
    pub(super) fn of(self, stage: Stage) -> Processing {
        match (self, stage) {
            (Self::Default, Stage::Raw) | (Self::Compact, _) => Processing::compact(),
            (Self::Padded, _) => Processing { pads: Pads::Kept, ..Processing::raw() },
            (Self::None, _) | (Self::Default, Stage::Corrected | Stage::Unknown) => {
                Processing::none()
            }
        }
    }
}

impl Input {
    /// Reads every file as a separate record.
    pub(super) fn read_each(&self) -> anyhow::Result<Vec<Record>> {
        self.files.iter().map(|file| self.read_alone(file)).collect()
    }

    /// Reads the record of one file.
    pub(super) fn read_alone(&self, file: &str) -> anyhow::Result<Record> {
        let mut record = self.read_one(file, &self.options()?)?;
        record.mixed = self.allow_mixed;
        Ok(record)
    }

    /// Returns `true` if a folder, or an archive of several records, is among the files.
    pub(super) fn has_folder(&self) -> bool {
        let several = |path: &Path, file: &str| {
            let options = self.options().unwrap_or_default();
            let error = archives::is_archive(path).then(|| read_file(file, &options).err())??;
            let refusal = error.downcast_ref::<ReadError>()?.refusal;
            (refusal == Refusal::SeveralRecords).then_some(())
        };
        self.files.iter().any(|file| {
            let path = Path::new(file);
            path.is_dir() || several(path, file).is_some()
        })
    }

    /// Returns the options that affect how files are read, as text.
    pub(super) fn description(&self) -> String {
        format!(
            "unit {:?}, step {:?}, sensitivity {:?} of {:?}, as {:?}, mixed {}",
            self.unit,
            self.time_step,
            self.sensitivity,
            self.station_xml,
            self.recorded,
            self.allow_mixed
        )
    }

    fn options(&self) -> anyhow::Result<ReadOptions> {
        Ok(ReadOptions {
            unit: self
                .unit
                .as_deref()
                .map(str::parse::<AccelerationUnit>)
                .transpose()
                .map_err(|error| anyhow!("--unit: {error}"))?,
            time_step: time_step(self.time_step.as_deref())?,
            recorded: self.recorded.map(Into::into),
            ..self.sensitivities()?
        })
    }

    /// Returns read options with the sensitivities given on the command line and those of the `StationXML` files.
    fn sensitivities(&self) -> anyhow::Result<ReadOptions> {
        let mut options = ReadOptions::default();
        for text in &self.sensitivity {
            let (channel, number) = text.split_once('=').unwrap_or(("", text));
            let value = number.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v > 0.0);
            let sensitivity = value.ok_or_else(|| {
                anyhow!("--sensitivity {text}: expected a number above 0, or a channel and its sensitivity, such as \
                     HNE=427819")
            })?;
            if channel.is_empty() {
                options.sensitivity = Some(sensitivity);
            } else {
                let channel = channel.trim().to_owned();
                let known = Instrument { channel, sensitivity, ..Instrument::default() };
                options.instruments.push(known);
            }
        }
        if let Some(path) = &self.station_xml {
            options.instruments.extend(instruments(path)?);
        }
        Ok(options)
    }

    /// Reads one file. If the samples are in counts and the sensitivity of the instrument is missing, the
    /// sensitivity is taken from the `StationXML` files in the same folder.
    fn read_one(&self, file: &str, options: &ReadOptions) -> anyhow::Result<Record> {
        let first = read_file(file, options);
        let lacking = first.as_ref().is_err_and(|error| {
            error.downcast_ref::<ReadError>().is_some_and(|error| {
                let counts = [Given::Sensitivity, Given::UnitOrSensitivity];
                counts.iter().any(|given| error.refusal == Refusal::Missing(*given))
            })
        });
        if !lacking || self.station_xml.is_some() {
            return first.map_err(with_option);
        }
        let beside = beside(Path::new(file));
        let mut more = options.clone();
        let (mut used, mut damaged) = (Vec::new(), None);
        for path in &beside {
            match read_station_xml(path) {
                // A catalog of events, or a station file without responses, does not apply to this
                // record.
                Ok(found) if found.is_empty() => {}
                Ok(found) => {
                    more.instruments.extend(found);
                    used.push(path.display().to_string());
                }
                Err(error) => damaged = damaged.or(Some(error)),
            }
        }
        if more.instruments.len() > options.instruments.len() {
            let mut record = read_file(file, &more).map_err(with_option)?;
            let (of, lie) = match used.as_slice() {
                [one] => (one.clone(), "which lies"),
                several => (format!("{} StationXML files", several.len()), "which lie"),
            };
            record
                .notes
                .push(format!("sensitivities from {of}, {lie} in the folder of the record"));
            return Ok(record);
        }
        first.map_err(|error| match damaged {
            Some(why) => with_option(error)
                .context(format!("{why:#}; no other file in the same folder states a sensitivity")),
            None => with_option(error),
        })
    }

    /// Reads all files as one record.
    pub(super) fn read(&self) -> anyhow::Result<Record> {
        self.unite(&self.read_each()?)
    }

    /// Combines several records into one. They are overlapping parts of one long record if `join` is set,
    /// otherwise components of the same record.
    pub(super) fn unite(&self, records: &[Record]) -> anyhow::Result<Record> {
        if self.join {
            return Ok(Record::join(records)?);
        }
        if self.allow_mixed {
            return Ok(Record::gather_mixed(records)?);
        }
        // Differences in station and publisher can be overruled, but not differences in time step and start time.
        Record::gather(records).map_err(|error| match Record::gather_mixed(records) {
            Ok(_) => anyhow!("{error}, or add --allow-mixed"),
            Err(_) => error.into(),
        })
    }
}

impl Choice {
    /// Returns the selected components of a record, cut to the length of the shortest.
    ///
    /// The components are processed by the requested chain or, if none is requested, by the `usual`
    /// chain of the command; the notes of the record list the processing.
    pub(super) fn take(&self, record: &Record, usual: Chain) -> anyhow::Result<Record> {
        let mut chosen = record.clone();
        let from = format!(
            "read from {}, format {}, stage {}",
            base_names(record),
            record.format,
            record.stage
        );
        if record.format == "barrelstack" {
            // A file in the program's own format already states its processing steps.
            for note in &mut chosen.notes {
                if let Some(step) = note.strip_prefix("processing: ") {
                    *note = step.to_owned();
                }
            }
            chosen.notes.push(from);
        } else {
            chosen.notes.insert(0, from);
        }
        if !self.component.is_empty() {
            chosen.channels = Vec::new();
            for name in &self.component {
                let channel = record.component(&component(record, name)?)?;
                if chosen.channels.iter().any(|other| other.name == channel.name) {
                    bail!("--component {name}: channel {} is already selected", channel.name);
                }
                if !record.channels.contains(&channel) {
                    chosen.notes.push(format!(
                        "{} is obtained by rotation from two horizontals of known azimuth",
                        channel.name
                    ));
                }
                chosen.channels.push(channel);
            }
        }
        chosen.cut_to_shortest();
        let chain = self.processing.unwrap_or(usual).of(record.stage);
        Ok(if chain.is_none() { chosen } else { chosen.processed(&chain)? })
    }
}

/// Returns the names of the files of a record, without their folders, joined by commas.
fn base_names(record: &Record) -> String {
    let names: Vec<&str> = record
        .file
        .split(", ")
        .map(|file| file.rsplit(['/', '\\']).next().unwrap_or(file))
        .collect();
    names.join(", ")
}

/// Parses a component. The text is the name of a channel of the record or, if no channel has this name, an azimuth in
/// degrees or any other designation of a [`Component`].
pub(super) fn component(record: &Record, name: &str) -> anyhow::Result<Component> {
    let by_name = Component::Name(name.to_owned());
    if record.component(&by_name).is_ok() {
        return Ok(by_name);
    }
    Ok(match name.trim().parse::<f64>() {
        Ok(azimuth) if azimuth.is_finite() => Component::Azimuth(azimuth),
        _ if name.eq_ignore_ascii_case("up") => Component::Vertical,
        _ => name.parse()?,
    })
}

/// Parses a quantity with its unit, and converts it to SI units; errors name the option.
pub(super) fn quantity(option: &str, text: &str, dimension: Dimension) -> anyhow::Result<f64> {
    let suggestion = Quantity::suggestion(text, &[dimension]);
    let example = match dimension {
        // Without a better suggestion, the example of the dimension is used.
        _ if suggestion != dimension.example() => suggestion,
        Dimension::FREQUENCY => "0.1 Hz".to_owned(),
        Dimension::TIME if option == "--time-step" => "0.01 s".to_owned(),
        Dimension::TIME => "0.5 s".to_owned(),
        Dimension::LENGTH => "20 cm".to_owned(),
        Dimension::STIFFNESS_PER_LENGTH => "7 MPa".to_owned(),
        Dimension::NONE => "5 %".to_owned(),
        _ => suggestion,
    };
    Quantity::parse_as(text, &[dimension])
        .map(|quantity| quantity.value)
        .map_err(|error| anyhow!("{option}: {error}; write for example \"{example}\""))
}

/// Parses a time step (s), if one is given.
pub(super) fn time_step(text: Option<&str>) -> anyhow::Result<Option<f64>> {
    text.map(|text| quantity("--time-step", text, Dimension::TIME)).transpose()
}

/// Parses a plain number, or a quantity with its unit, and converts it to SI units.
pub(super) fn number_or(option: &str, text: &str, dimension: Dimension) -> anyhow::Result<f64> {
    text.trim().parse().or_else(|_| quantity(option, text, dimension))
}

/// Reads one file, or a bundled record if there is no file with that name.
fn read_file(file: &str, options: &ReadOptions) -> anyhow::Result<Record> {
    let path = Path::new(file);
    if let (false, Some(record)) = (path.exists(), bundled(file)) {
        return Ok(record);
    }
    let bytes = bytes(path)?;
    Ok(read(&bytes, file, options)?)
}

/// Adds to a reading error the command-line option that supplies the missing information.
fn with_option(error: anyhow::Error) -> anyhow::Error {
    let Some(cause) = error.downcast_ref::<ReadError>() else { return error };
    let option = match cause.refusal {
        Refusal::OtherInstrument => "add --as velocity, with the sensitivity in counts per m/s",
        Refusal::Missing(Given::Unit) => {
            "add --unit g, or the actual unit; values in a unit that --unit does not support must be converted first"
        }
        Refusal::Missing(Given::Step) => {
            "add --time-step with the time between two samples, as the publisher of the file states it"
        }
        Refusal::Missing(Given::Sensitivity) => {
            "add --sensitivity with the counts per m/s2, or --station-xml with the file of the station"
        }
        Refusal::SeveralRecords => "info, plot, process and convert accept it with --out DIR",
        Refusal::Missing(Given::UnitOrSensitivity) => {
            "add --unit g, or the actual unit, or --sensitivity with the counts per m/s2"
        }
        Refusal::Options | Refusal::NotAcceleration | Refusal::Damaged | Refusal::Unrecognized => {
            return error;
        }
    };
    anyhow!("{error}: {option}")
}

/// Reads the channels of a `StationXML` file, or of all such files in a folder.
fn instruments(path: &Path) -> anyhow::Result<Vec<Instrument>> {
    if !path.is_dir() {
        return instruments_of_file(path);
    }
    let files = xml_files(path);
    let mut found = Vec::new();
    for file in &files {
        // Catalogs of events and stations without responses may be among the files.
        found.extend(read_station_xml(file)?);
    }
    if found.is_empty() {
        bail!(
            "{}: no file in this folder is a StationXML file with a sensitivity (number of .xml files: {})",
            path.display(),
            files.len()
        );
    }
    Ok(found)
}

/// Reads the channels of a `StationXML` file.
fn instruments_of_file(path: &Path) -> anyhow::Result<Vec<Instrument>> {
    let found = read_station_xml(path)?;
    if found.is_empty() {
        bail!("{}: it states no sensitivity for any channel", path.display());
    }
    Ok(found)
}

/// Reads an XML file, and returns the channels for which the file states a sensitivity.
fn read_station_xml(path: &Path) -> anyhow::Result<Vec<Instrument>> {
    let text = bytes(path)?;
    station_xml(&String::from_utf8_lossy(&text)).with_context(|| path.display().to_string())
}

/// Returns the .xml files in the folder of a file, sorted by name; they may be `StationXML` files.
fn beside(file: &Path) -> Vec<PathBuf> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    xml_files(folder.unwrap_or(Path::new(".")))
}

/// Returns the .xml files of a folder, sorted by name.
fn xml_files(folder: &Path) -> Vec<PathBuf> {
    let inside = archives::files_below(folder);
    if !inside.is_empty() {
        let ends = |path: &PathBuf| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xml"));
        return inside.into_iter().filter(ends).collect();
    }
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut found: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xml")))
        .collect();
    found.sort();
    found
}

/// Returns the bytes of a file; an error if there are more than `LIMIT` bytes.
pub(super) fn bytes(path: &Path) -> anyhow::Result<Vec<u8>> {
    let refused = || format!("cannot read {}", path.display());
    if let Some(bytes) = archives::bytes_inside(path)? {
        return Ok(bytes);
    }
    if path.is_dir() {
        bail!("{}: it is a folder, not a file; give one of its files", refused());
    }
    let plain = |error| anyhow!("{:#}; correct the path", plain(error));
    let file = barrelstack_input::system::open(path)
        .map_err(|reason| anyhow!("{reason}; correct the path"))
        .with_context(refused)?;
    let mut bytes = Vec::new();
    file.take(LIMIT + 1).read_to_end(&mut bytes).map_err(plain).with_context(refused)?;
    if bytes.len() as u64 > LIMIT {
        bail!(
            "{}: it is larger than 256 MB, the limit for strong-motion files; correct the path",
            refused()
        );
    }
    Ok(bytes)
}
