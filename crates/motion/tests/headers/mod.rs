//! Tables of synthetic motions with headers of every style, and damage to these headers.

use barrelstack_motion::{Random, ReadOptions, read};

fn below(random: &mut Random, n: usize) -> usize {
    usize::try_from(random.bits() % n as u64).unwrap_or(0)
}

fn pick<'a, T>(random: &mut Random, from: &'a [T]) -> &'a T {
    &from[below(random, from.len())]
}

/// Style of a unit next to a name.
#[derive(Clone, Copy)]
enum Style {
    Parentheses,
    Brackets,
    Comma,
    Row,
    Prose,
}

/// A table with the record that it represents.
pub(crate) struct Table {
    header: String,
    rows: String,
    step: f64,
    /// Peak of each channel (m/s²) in the order of the columns.
    peaks: Vec<f64>,
    samples: usize,
    /// Line that states the peak of the only channel.
    peak_line: Option<String>,
}

/// Result of reading a table.
pub(crate) enum Verdict {
    Right,
    Refused,
    Wrong(String),
}

const UNITS: [(&str, f64); 9] = [
    ("g", 9.80665),
    ("m/s2", 1.0),
    ("m/s^2", 1.0),
    ("cm/s2", 0.01),
    ("cm/sec/sec", 0.01),
    ("gal", 0.01),
    ("mm/s2", 0.001),
    ("M/S**2", 1.0),
    ("m/s/s", 1.0),
];
const STEPS: [f64; 6] = [0.005, 0.01, 0.02, 0.004, 0.0025, 0.003_906_25];

/// Generates a random table.
#[allow(clippy::too_many_lines, reason = "one table, from top to bottom")]
pub(crate) fn table(random: &mut Random) -> Table {
    let step = *pick(random, &STEPS);
    let samples = 60 + below(random, 30);
    let (unit, factor) = *pick(random, &UNITS);
    let channels = 1 + below(random, 3);
    let others = below(random, 2) == 0;
    let timed = others || channels > 1 && below(random, 2) == 0 || below(random, 2) == 0;
    let (separator, style) = *pick(
        random,
        &[
            (",", Style::Parentheses),
            (",", Style::Brackets),
            ("\t", Style::Parentheses),
            ("\t", Style::Comma),
            (";", Style::Brackets),
            ("\t", Style::Row),
            (",", Style::Row),
            (",", Style::Prose),
            (" ", Style::Prose),
        ],
    );
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut names: Vec<(String, &str)> = Vec::new();
    let mut peaks = Vec::new();
    let milliseconds = timed && below(random, 5) == 0;
    if timed {
        let scale = if milliseconds { 1000.0 } else { 1.0 };
        columns.push((0..samples).map(|k| k as f64 * step * scale).collect());
        let name = *pick(random, &["Time", "time", "t"]);
        names.push((name.to_owned(), if milliseconds { "ms" } else { "s" }));
    }
    for channel in 0..channels {
        let (frequency, phase) = (1.0 + 3.0 * random.uniform(), 6.0 * random.uniform());
        let wave: Vec<f64> = (0..samples)
            .map(|k| {
                let t = k as f64 * step;
                (frequency * 6.2 * t + phase).sin() * (-0.4 * t).exp() * 1.7 / factor
            })
            .collect();
        let printed: Vec<f64> = wave.iter().map(|v| format!("{v:.6}").parse().unwrap()).collect();
        peaks.push(factor * printed.iter().fold(0.0_f64, |peak, v| peak.max(v.abs())));
        let direction = ["EW", "NS", "UD"][channel];
        let name = match (channels, below(random, 3)) {
            (1, 0) => "Acceleration".to_owned(),
            (1, 1) => "acc".to_owned(),
            (_, 2) => format!("{direction} acceleration"),
            _ => direction.to_owned(),
        };
        names.push((name, unit));
        columns.push(printed);
    }
    if others {
        for (name, unit) in [("Velocity", "cm/s"), ("Displacement", "cm")] {
            let mut sum = 0.0;
            let of = columns.last().unwrap().clone();
            names.push((name.to_owned(), unit));
            columns.push(
                of.iter()
                    .map(|v| {
                        sum += v * step * 100.0;
                        sum
                    })
                    .collect(),
            );
        }
    }
    // Names with blanks are incompatible with blanks as separators.
    if separator == " " {
        for (name, _) in &mut names {
            *name = name.replace(" acceleration", "");
        }
    }
    let mut header = String::new();
    let mut line = |text: String| {
        header += &text;
        header.push('\n');
    };
    for _ in 0..below(random, 3) {
        line((*pick(random, &PROSE)).to_owned());
    }
    let states_count = below(random, 2) == 0;
    if states_count {
        let style = below(random, 3);
        line(match style {
            0 => format!("Number of Data : {samples}"),
            1 => format!("{samples} samples"),
            _ => format!("NO. OF POINTS: {samples}"),
        });
    }
    if !timed || below(random, 3) == 0 {
        let style = below(random, 4);
        line(match style {
            0 => format!("dt = {step}"),
            1 => format!("Time Increment (s) : {step}"),
            2 => format!("Sampling rate: {} Hz", 1.0 / step),
            _ => format!("time step: {} ms", 1000.0 * step),
        });
    }
    let states_peak = channels == 1 && below(random, 2) == 0;
    let peak_line = states_peak.then(|| format!("PGA ({unit}) : {:.6}", peaks[0] / factor));
    if let Some(text) = &peak_line {
        line(text.clone());
    }
    let of_time =
        |(name, unit): &(String, &str)| *unit == "ms" || name.to_lowercase().starts_with('t');
    match style {
        Style::Prose => {
            line(format!("acceleration in {unit}"));
            let plain = |entry: &(String, &str)| match entry.1 {
                "ms" => "time_ms".to_owned(),
                _ => entry.0.clone(),
            };
            line(names.iter().map(plain).collect::<Vec<_>>().join(separator));
        }
        Style::Row => {
            line(names.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>().join(separator));
            let brackets = below(random, 2) == 0;
            let shown = |unit: &str| if brackets { format!("({unit})") } else { unit.to_owned() };
            line(names.iter().map(|(_, unit)| shown(unit)).collect::<Vec<_>>().join(separator));
        }
        Style::Parentheses | Style::Brackets | Style::Comma => {
            let shown = |entry: &(String, &str)| match style {
                Style::Parentheses => format!("{} ({})", entry.0, entry.1),
                Style::Brackets => format!("{} [{}]", entry.0, entry.1),
                Style::Comma | Style::Row | Style::Prose => format!("{}, {}", entry.0, entry.1),
            };
            line(names.iter().map(shown).collect::<Vec<_>>().join(separator));
        }
    }
    let mut rows = String::new();
    for row in 0..samples {
        let shown = |(column, entry): (&Vec<f64>, &(String, &str))| {
            if of_time(entry) {
                format!("{:.8}", column[row])
            } else {
                format!("{:.6}", column[row])
            }
        };
        rows += &(columns.iter().zip(&names).map(shown).collect::<Vec<_>>().join(separator) + "\n");
    }
    Table { header, rows, step, peaks, samples, peak_line }
}

/// Lines unrelated to the samples.
const PROSE: [&str; 8] = [
    "Station 12, Nowhere",
    "Filter: 0.1 - 25 Hz, 4th order",
    "Processed with care in 2020, baseline corrected in time",
    "Event 2020-01-01 00:00:00",
    "Latitude (degree): 38.0  Longitude (degree): 27.0",
    "# made up",
    "Corrected data of a made-up network",
    "Magnitude 6.6, epicentral distance 14 km",
];

impl Table {
    /// Returns the file.
    pub(crate) fn text(&self) -> String {
        format!("{}{}", self.header, self.rows)
    }

    /// Compares the record read from a text with the record of the table.
    pub(crate) fn verdict(&self, text: &str) -> Verdict {
        let Ok(record) = read(text.as_bytes(), "table.txt", &ReadOptions::default()) else {
            return Verdict::Refused;
        };
        if record.channels.len() != self.peaks.len() {
            return Verdict::Wrong(format!(
                "{} channels of {}",
                record.channels.len(),
                self.peaks.len()
            ));
        }
        for (channel, peak) in record.channels.iter().zip(&self.peaks) {
            if (channel.time_step / self.step - 1.0).abs() > 1e-6 {
                return Verdict::Wrong(format!("step {} of {}", channel.time_step, self.step));
            }
            if (channel.pga() / peak - 1.0).abs() > 1e-6
                || channel.acceleration.len() != self.samples
            {
                return Verdict::Wrong(format!("peak {} of {peak}", channel.pga()));
            }
        }
        Verdict::Right
    }

    /// Checks that the peak of a record read from a damaged text agrees with that of the table
    /// within 1 %, or that a warning contradicts the stated peak.
    pub(crate) fn peak_verdict(&self, text: &str) -> Verdict {
        let Ok(record) = read(text.as_bytes(), "table.txt", &ReadOptions::default()) else {
            return Verdict::Refused;
        };
        let off = |peak: f64| self.peaks.iter().all(|own| (peak / own - 1.0).abs() > 0.01);
        let wrong = record.channels.iter().find(|channel| off(channel.pga()));
        let kept = |line: &String| text.lines().any(|other| other == line);
        let stated = self.peak_line.as_ref().is_some_and(kept);
        let warned = record.warnings.iter().any(|w| w.message.contains("states a peak"));
        match wrong {
            Some(channel) if stated && !warned => {
                Verdict::Wrong(format!("peak {} of {:?}", channel.pga(), self.peaks))
            }
            _ => Verdict::Right,
        }
    }
}

/// Returns the file with one to three changes to its header.
pub(crate) fn mutated(table: &Table, random: &mut Random) -> String {
    let mut header = table.header.clone().into_bytes();
    for _ in 0..=below(random, 3) {
        let at = below(random, header.len().max(1));
        match below(random, 6) {
            0 if at < header.len() => {
                header.remove(at);
            }
            1 => header.insert(at, *pick(random, b"0123456789 ,;\t()[]/.-gmscEN\n")),
            2 if at < header.len() => header[at] = *pick(random, b"0123456789 ,;\t()[]/.-gmscEN\n"),
            3 => {
                let text = String::from_utf8_lossy(&header).into_owned();
                let mut lines: Vec<&str> = text.lines().collect();
                if !lines.is_empty() {
                    lines.remove(below(random, lines.len()));
                }
                header = lines.iter().flat_map(|line| [line.as_bytes(), b"\n"].concat()).collect();
            }
            4 => {
                let text = String::from_utf8_lossy(&header).into_owned();
                let mut lines: Vec<&str> = text.lines().collect();
                if lines.len() > 1 {
                    let (a, b) = (below(random, lines.len()), below(random, lines.len()));
                    lines.swap(a, b);
                }
                header = lines.iter().flat_map(|line| [line.as_bytes(), b"\n"].concat()).collect();
            }
            _ => {
                let word = *pick(
                    random,
                    &["velocity", "g", "cm", "time", "(s)", "dt", "10", "in", "units"],
                );
                let at = at.min(header.len());
                header.splice(at..at, word.bytes());
            }
        }
    }
    format!("{}{}", String::from_utf8_lossy(&header), table.rows)
}
