//! Finds column names: a header line is used only if its words are names of quantities.

use std::cmp::Ordering;

use super::facts::{folded, time_factor};
use super::words::{ACCELERATIONS, DISPLACEMENTS, VELOCITIES};
use crate::direction::Direction;
use crate::error::ReadError;
use crate::format::source::{Source, quoted};
use crate::record::Quantity;
use crate::units::MotionUnit;

/// Content of a column, derived from its name and unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Holds {
    Time,
    /// Row numbers.
    Index,
    Motion(Quantity),
    /// Values of one component. The name of the column is only a direction, such as `EW`.
    Component,
    /// A period, a frequency or a spectral ordinate.
    Spectrum,
    /// A named quantity other than motion, such as a force.
    Other,
    Unknown,
}

/// Name of a column, with its unit.
#[derive(Clone, Debug)]
pub(super) struct Name {
    /// Name without the unit.
    pub(super) label: String,
    /// Unit as written, if there is one.
    pub(super) unit: Option<String>,
    pub(super) holds: Holds,
}

impl Name {
    /// Returns the unit if it is a unit of motion.
    pub(super) fn motion_unit(&self) -> Option<MotionUnit> {
        self.unit.as_deref().and_then(MotionUnit::parse)
    }

    /// Returns `true` if the name denotes the magnitude of a vector, such as a resultant.
    pub(super) fn says_length(&self) -> bool {
        let lower = self.label.to_lowercase();
        let mut words = lower.split(|c: char| !c.is_alphanumeric());
        words.any(|word| {
            ["abs", "absolute", "resultant", "magnitude", "norm", "total", "vector"].contains(&word)
        })
    }

    /// Formats the name and the unit for messages.
    pub(super) fn shown(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} ({unit})", self.label),
            None => self.label.clone(),
        }
    }
}

/// Finds the line of column names directly above a table of `width` columns. Returns the number of
/// this line (counted from 0) and the names.
///
/// # Errors
/// If the line is a row of units and some of the units are unknown.
pub(super) fn find(
    source: &Source<'_>,
    first: usize,
    width: usize,
) -> Result<Option<(usize, Vec<Name>)>, ReadError> {
    let mut lines = (0..first).rev().filter(|&line| !is_rule(&source.text(line)));
    let Some(last) = lines.next() else { return Ok(None) };
    let text = source.text(last);
    let Some(units) = units_row(&text, width) else {
        if let Some(damaged) = damaged_unit(&text, width) {
            return Err(source.damaged(
                last,
                format!("{width} units, one for each column"),
                format!("{}, which is not a known unit", quoted(&damaged)),
                "correct it, or write names and units in one line, such as \"time (s), acceleration (g)\"",
            ));
        }
        return Ok(names(&text, width).map(|names| (last, names)));
    };
    let above = lines.next().and_then(|line| Some((line, names(&source.text(line), width)?)));
    let (line, mut names) = above.unwrap_or_else(|| {
        let by_unit = |unit: &String| Name {
            label: if time_factor(unit).is_some() { "time" } else { "column" }.to_owned(),
            unit: None,
            holds: Holds::Unknown,
        };
        (last, units.iter().map(by_unit).collect())
    });
    for (name, unit) in names.iter_mut().zip(units) {
        name.unit = name.unit.take().or(Some(unit).filter(|unit| unit != "-"));
        name.holds = holds(&name.label, name.unit.as_deref());
    }
    Ok(Some((line, by_company(names))))
}

/// Returns the index of the time column if this is not the first column.
pub(super) fn time_behind(names: &[Name]) -> Option<usize> {
    names.iter().position(|name| name.holds == Holds::Time).filter(|at| *at > 0)
}

/// Returns `true` if a line is empty or consists only of rule characters, such as dashes.
fn is_rule(text: &str) -> bool {
    text.chars().all(|c| " -=+|_#*\t,;".contains(c))
}

fn plain(text: &str) -> &str {
    text.trim_start_matches(['#', '%', '!', '/', ' ', '|']).trim_end_matches(['|', ' ', ',', ';'])
}

/// Splits a line at each possible separator in turn and returns one list of parts per separator. The
/// flag is `true` if the separator does not occur in prose.
fn splits(text: &str) -> Vec<(bool, Vec<String>)> {
    let tidy = |part: &str| part.trim().trim_matches(['"', '\'']).trim().to_owned();
    let by = |mark: char| text.split(mark).map(tidy).collect::<Vec<_>>();
    let mut all = Vec::new();
    for mark in ['\t', ';', '|', ','] {
        if text.contains(mark) {
            all.push((true, by(mark)));
        }
    }
    let wide: Vec<String> = text.split("  ").map(tidy).filter(|part| !part.is_empty()).collect();
    if wide.len() > 1 {
        all.push((true, wide));
    }
    all.push((false, text.split_whitespace().map(tidy).collect()));
    all
}

const BRACKETS: [char; 7] = ['(', ')', '[', ']', '{', '}', ' '];

/// Parses a row below the names that contains only units.
fn units_row(text: &str, width: usize) -> Option<Vec<String>> {
    let bare = |part: &str| part.trim_matches(BRACKETS).to_owned();
    splits(plain(text)).into_iter().find_map(|(_, parts)| {
        let units: Vec<String> = parts.iter().map(|part| bare(part)).collect();
        let each = units.iter().all(|unit| is_any_unit(unit));
        let any = units.iter().any(|unit| is_unit(unit));
        // A row of names may be "N E" or "S"; except for "g" and "m", no unit looks like a
        // direction.
        let direction = units.iter().all(|unit| Direction::parse(unit) != Direction::default());
        (units.len() == width && each && any && !direction).then_some(units)
    })
}

/// Returns the first word that is not a known unit, if the line is otherwise a row of units.
///
/// A line is a row of units if more than half of its words are units. If exactly half of the words are units, three
/// more conditions apply: the separator does not occur in prose, the line does not contain "unit", and the other words
/// are not all names of quantities, as in `time, g`.
fn damaged_unit(text: &str, width: usize) -> Option<String> {
    splits(plain(text)).into_iter().find_map(|(separated, parts)| {
        if parts.len() != width || parts.iter().any(String::is_empty) {
            return None;
        }
        let bare = |part: &String| part.trim_matches(BRACKETS).to_owned();
        let others: Vec<String> =
            parts.iter().map(bare).filter(|part| !is_any_unit(part)).collect();
        let names = others.iter().all(|part| name(part).holds != Holds::Unknown);
        // In prose, "Unit: g" states the unit of all columns.
        let enough = match (parts.len() - others.len()).cmp(&others.len()) {
            Ordering::Greater => true,
            Ordering::Equal => separated && !names && !text.to_lowercase().contains("unit"),
            Ordering::Less => false,
        };
        others.into_iter().next().filter(|_| enough)
    })
}

/// Units of quantities other than motion and time, in lower case; letters that are also directions
/// are omitted.
const OTHER_UNITS: &[&str] = &[
    "kn",
    "mn",
    "kip",
    "kips",
    "lbf",
    "kg",
    "kpa",
    "mpa",
    "psi",
    "knm",
    "kn-m",
    "kn.m",
    "mv",
    "volt",
    "volts",
    "counts",
    "lsb",
    "rad",
    "deg",
    "rad/s",
    "deg/s",
    "rad/s2",
    "deg/s2",
    "degc",
    "mm/m",
    "strain",
    "microstrain",
    "hz",
    "%",
];

/// Returns `true` for a unit of motion, time or another quantity, and for the placeholders `-` and
/// `#`, which mean that a column has no unit.
fn is_any_unit(text: &str) -> bool {
    is_unit(text)
        || ["-", "#"].contains(&text)
        || OTHER_UNITS.contains(&text.to_lowercase().as_str())
}

fn is_unit(text: &str) -> bool {
    MotionUnit::parse(text).is_some() || time_factor(text).is_some()
}

fn names(text: &str, width: usize) -> Option<Vec<Name>> {
    splits(plain(text)).into_iter().find_map(|(separated, parts)| {
        let parts = if parts.len() > width { merged(parts) } else { parts };
        // "0.005" and "#N/A" occur in rows of numbers.
        let of_a_row = |part: &String| {
            part.contains('.') && part.parse::<f64>().is_ok() || part.starts_with("#N")
        };
        if parts.len() != width || parts.iter().any(|part| part.is_empty() || of_a_row(part)) {
            return None;
        }
        let names = by_company(parts.iter().map(|part| name(part)).collect());
        says_quantities(&names, separated).then_some(names)
    })
}

/// Merges each separate unit (`Time, s, Acceleration, g`) with the name before it.
fn merged(parts: Vec<String>) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for part in parts {
        let bare = part.trim_matches(['(', ')', '[', ']', '{', '}']);
        let in_brackets = bare.len() < part.len();
        match out.last_mut() {
            Some(last) if (in_brackets || is_unit(bare)) && !last.ends_with([')', ']']) => {
                *last = format!("{last} ({bare})");
            }
            _ => out.push(part),
        }
    }
    out
}

/// Returns `true` if the words of a line are column names rather than prose. `separated` is `true` if the separator
/// between the words does not occur in prose. In general, every word must be the name of a quantity. Other words are
/// allowed if `separated` is `true` and the first column contains times, row numbers or a spectrum.
fn says_quantities(names: &[Name], separated: bool) -> bool {
    let says = |name: &Name| name.holds != Holds::Unknown;
    let leads = matches!(names[0].holds, Holds::Time | Holds::Index | Holds::Spectrum);
    // Time is normally the first column. Elsewhere, all names must be quantities, because a
    // sentence may mention time.
    let times = names.iter().filter(|name| name.holds == Holds::Time).count();
    let time_after_index = names[0].holds == Holds::Index
        && names.get(1).is_some_and(|name| name.holds == Holds::Time);
    if names.iter().all(says) && (times == 0 || separated && times == 1) {
        return true;
    }
    // A second time column, in another unit, may follow the first.
    if names[0].holds == Holds::Time && times > 1 && (separated || names.iter().all(says)) {
        return true;
    }
    if times > usize::from(names[0].holds == Holds::Time) && !time_after_index {
        return false;
    }
    if names.iter().all(says) {
        return true;
    }
    names.len() > 1 && separated && leads
}

/// Parses a name and its unit, such as `Acceleration (g)`, `Accel [cm/s2]`, `acc, g`, `acc_g` or
/// `Acceleration in g`.
fn name(text: &str) -> Name {
    let mut label = text.trim();
    let mut unit = None;
    // "a_g" is the acceleration of the ground, and "v_g" its velocity.
    let ground = matches!(label.to_lowercase().as_bytes(), [_, b'_', b'g']);
    if let Some((before, inner)) = label.split_once(['(', '[', '{'])
        && let Some((inner, after)) = inner.rsplit_once([')', ']', '}'])
        && !before.trim().is_empty()
    {
        // The parentheses in "Acc (EW)" do not contain a unit.
        let inner = inner.trim();
        if Direction::parse(inner) == Direction::default() || is_unit(inner) {
            unit = Some(inner.to_owned());
            label = if after.trim().is_empty() { before.trim() } else { label };
        }
    }
    if unit.is_none() && !ground {
        for mark in [", ", ",", " in ", ": ", "_", " "] {
            if let Some((before, last)) = label.rsplit_once(mark)
                && is_unit(last)
                && !before.trim().is_empty()
                // "acc_m" and "UP m" are too ambiguous; "time s" and "acc g" are not.
                && MotionUnit::parse(last).is_none_or(|unit| unit.quantity != Quantity::Displacement)
            {
                unit = Some(last.trim().to_owned());
                label = before.trim().trim_end_matches([',', ':']);
                break;
            }
        }
    }
    Name { label: label.to_owned(), holds: holds(label, unit.as_deref()), unit }
}

/// Units of rotations, in lower case.
const ROTATIONS: &[&str] = &["rad", "rad/s", "rad/s2", "deg", "deg/s"];

fn holds(label: &str, unit: Option<&str>) -> Holds {
    // Labels were decoded as Latin-1, one character per byte.
    let bytes: Option<Vec<u8>> = label.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect();
    let lower = bytes.map_or_else(|| label.to_lowercase(), |bytes| folded(&bytes));
    let plain_unit = unit.map(|unit| unit.to_lowercase().replace([' ', '^', '*'], ""));
    match plain_unit.as_deref() {
        Some("hz" | "khz") => return Holds::Spectrum,
        Some(unit) if ROTATIONS.contains(&unit) => return Holds::Other,
        _ => {}
    }
    let words: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let begins = |starts: &[&str]| {
        words.iter().any(|word| starts.iter().any(|start| word.starts_with(start)))
    };
    let is = |exact: &[&str]| words.iter().any(|word| exact.contains(word));
    let unit_of_motion = unit.and_then(MotionUnit::parse).map(|unit| unit.quantity);
    if begins(&[
        "spectr", "spettr", "espectr", "spektr", "freq", "frec", "frek", "period", "psa", "psv",
        "fourier", "damp",
    ]) || label == "Se"
        || is(&["sa", "sv", "sd", "sae", "sve", "sde", "psd", "fas", "per", "hz"])
    {
        return Holds::Spectrum;
    }
    if begins(ACCELERATIONS) || is(&["a", "ag", "ax", "ay", "az", "ugdd", "uddg"]) {
        return Holds::Motion(Quantity::Acceleration);
    }
    if begins(VELOCITIES) || is(&["vel", "vg", "vx", "vy", "vz", "vels", "hiz"]) {
        return Holds::Motion(Quantity::Velocity);
    }
    if begins(DISPLACEMENTS) || is(&["dis", "disp", "dx", "dy", "dz"]) {
        return Holds::Motion(Quantity::Displacement);
    }
    let time_words = [
        "time",
        "times",
        "t",
        "tiempo",
        "zaman",
        "zeit",
        "temps",
        "tempo",
        "sec",
        "secs",
        "seconds",
        "msec",
        "\u{6642}\u{9593}",
        "\u{65f6}\u{95f4}",
    ];
    if is(&time_words) || begins(&["timest", "elapsed", "datetime"]) {
        return Holds::Time;
    }
    if Direction::parse(label) != Direction::default() {
        return unit_of_motion.map_or(Holds::Component, Holds::Motion);
    }
    if is(&[
        "index", "idx", "sample", "samples", "point", "points", "no", "nr", "row", "i", "step",
        "id",
    ]) || label == "#"
    {
        return Holds::Index;
    }
    let others = [
        "force", "load", "strain", "stress", "press", "temp", "count", "volt", "angle", "rot",
        "tilt", "grav", "lat", "lon", "moment", "mass", "energy", "arias", "cav", "husid", "error",
        "std", "sigma", "phase", "imag",
    ];
    if begins(&others) {
        return Holds::Other;
    }
    match (unit_of_motion, unit) {
        (Some(quantity), _) => Holds::Motion(quantity),
        // A stated unit that is not a unit of motion belongs to another quantity.
        (None, Some(unit)) if time_factor(unit).is_none() => Holds::Other,
        _ => Holds::Unknown,
    }
}

/// Interprets single letters as quantities where the other columns show that they are not
/// directions: `v` as a velocity, `d` and `u` as displacements.
fn by_company(mut names: Vec<Name>) -> Vec<Name> {
    let acceleration = names.iter().any(|name| name.holds == Holds::Motion(Quantity::Acceleration));
    let horizontal = names.iter().any(|name| {
        let direction = Direction::parse(&name.label);
        name.holds == Holds::Component && direction.azimuth.is_some()
    });
    for name in &mut names {
        let letter =
            name.label.trim_end_matches(|c: char| c.is_ascii_digit() || "_ ()tg".contains(c));
        let quantity = match letter {
            "v" | "V" if acceleration && !horizontal => Quantity::Velocity,
            "d" | "D" | "u" if acceleration && !horizontal => Quantity::Displacement,
            "v" if !horizontal => Quantity::Velocity,
            "d" => Quantity::Displacement,
            _ => continue,
        };
        if matches!(name.holds, Holds::Component | Holds::Unknown) {
            name.holds = Holds::Motion(quantity);
        }
    }
    names
}
