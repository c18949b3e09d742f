//! The flatfile of NGA-West2: magnitude, distances and site of every record, by its sequence number.

use std::collections::BTreeMap;

use crate::error::MotionError;
use crate::format::shorten;

/// What a flatfile says of one record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatRow {
    /// Earthquake.
    pub event: String,
    /// Station.
    pub station: String,
    /// Moment magnitude.
    pub magnitude: Option<f64>,
    /// Closest distance to the rupture (km).
    pub rupture_distance: Option<f64>,
    /// Joyner-Boore distance (km).
    pub surface_distance: Option<f64>,
    /// Time-averaged shear-wave velocity of the upper 30 m (m/s).
    pub vs30: Option<f64>,
    /// Strike of the fault (degrees clockwise from north).
    pub strike: Option<f64>,
}

/// Rows by record sequence number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flatfile {
    rows: BTreeMap<u64, FlatRow>,
}

/// Columns of the published table, which its short forms name as well.
const NUMBER: &[&str] = &["record sequence number", "rsn"];
const EVENT: &[&str] = &["earthquake name", "event"];
const STATION: &[&str] = &["station name", "station"];
const MAGNITUDE: &[&str] = &["earthquake magnitude", "magnitude"];
const RUPTURE: &[&str] = &["clstd (km)", "rrup (km)", "rrup"];
const SURFACE: &[&str] = &["joyner-boore dist. (km)", "rjb (km)", "rjb"];
const VS30: &[&str] = &["vs30 (m/s) selected for analysis", "vs30 (m/s)", "vs30"];
const STRIKE: &[&str] = &["strike (deg)", "strike"];

impl Flatfile {
    /// Reads the table as CSV, its first line the names of the columns; −999 stands for unknown.
    ///
    /// # Errors
    /// If there is no column of sequence numbers, a number is none, or a sequence number comes twice.
    pub fn parse(file: &str, text: &str) -> Result<Self, MotionError> {
        let mut lines = rows(text);
        let Some((_, head)) = lines.next() else {
            return Err(MotionError::parameter(file, "a table with a line of names", "nothing"));
        };
        let head: Vec<String> = head
            .iter()
            .map(|name| name.trim().trim_start_matches('\u{feff}').to_ascii_lowercase())
            .collect();
        let column = |names: &[&str]| names.iter().find_map(|n| head.iter().position(|h| h == n));
        let Some(number) = column(NUMBER) else {
            let expected = "a column \"Record Sequence Number\" or \"RSN\"";
            let found = format!("{} others ({})", head.len(), shorten(&head.join(", ")));
            return Err(MotionError::parameter(file, expected, found));
        };
        let texts = [column(EVENT), column(STATION)];
        let numbers = [MAGNITUDE, RUPTURE, SURFACE, VS30, STRIKE].map(column);
        let mut found = BTreeMap::new();
        for (line, cells) in lines {
            let cell = |at: Option<usize>| at.and_then(|at| cells.get(at)).map_or("", |c| c.trim());
            let refuse = |at: Option<usize>, expected: &str| {
                let name = at.and_then(|at| head.get(at)).map_or("", String::as_str);
                let what = format!("{file}, line {line}, column \"{}\"", shorten(name));
                MotionError::parameter(what, expected, format!("\"{}\"", shorten(cell(at))))
            };
            let value = |at: Option<usize>| -> Result<Option<f64>, MotionError> {
                match cell(at) {
                    "" => Ok(None),
                    text => match text.parse::<f64>() {
                        Ok(value) if value.is_finite() => Ok((value > -998.0).then_some(value)),
                        _ => Err(refuse(at, "a number")),
                    },
                }
            };
            let Ok(sequence) = cell(Some(number)).parse::<u64>() else {
                return Err(refuse(Some(number), "a whole number"));
            };
            let row = FlatRow {
                event: cell(texts[0]).to_owned(),
                station: cell(texts[1]).to_owned(),
                magnitude: value(numbers[0])?,
                rupture_distance: value(numbers[1])?,
                surface_distance: value(numbers[2])?,
                vs30: value(numbers[3])?,
                strike: value(numbers[4])?,
            };
            if found.insert(sequence, row).is_some() {
                return Err(refuse(Some(number), "each sequence number once"));
            }
        }
        Ok(Self { rows: found })
    }

    /// The row of a record.
    pub fn get(&self, number: u64) -> Option<&FlatRow> {
        self.rows.get(&number)
    }

    /// How many records it holds.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// The record sequence number in a name such as `RSN995_NORTHR_PEL360.AT2`.
pub fn record_sequence_number(path: &str) -> Option<u64> {
    let file = path.rsplit(['/', '\\']).next()?;
    let digits =
        file.get(..3).filter(|start| start.eq_ignore_ascii_case("RSN")).map(|_| &file[3..])?;
    let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
    digits[..end].parse().ok()
}

/// Rows of a table (RFC 4180) with the line on which each begins; empty lines are left out.
fn rows(text: &str) -> impl Iterator<Item = (usize, Vec<String>)> {
    let mut line = 1;
    let mut rest = text;
    std::iter::from_fn(move || {
        while !rest.is_empty() {
            let first = line;
            let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
            let mut letters = rest.char_indices().peekable();
            let mut end = rest.len();
            while let Some((at, letter)) = letters.next() {
                match letter {
                    '"' if quoted && matches!(letters.peek(), Some((_, '"'))) => {
                        cell.push('"');
                        letters.next();
                    }
                    '"' => quoted = !quoted,
                    ',' if !quoted => cells.push(std::mem::take(&mut cell)),
                    '\n' => {
                        line += 1;
                        if !quoted {
                            end = at + 1;
                            break;
                        }
                        cell.push(' ');
                    }
                    '\r' => {}
                    other => cell.push(other),
                }
            }
            rest = &rest[end..];
            cells.push(cell);
            if cells.iter().any(|cell| !cell.trim().is_empty()) {
                return Some((first, cells));
            }
        }
        None
    })
}
