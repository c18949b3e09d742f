//! Flatfiles: tables with the magnitude, distances and site of every record.
//!
//! Records are identified by the sequence numbers of NGA-West2, or by the events and stations of ESM.

use std::collections::BTreeMap;

use crate::error::MotionError;
use crate::format::shorten;
use crate::record::Record;

/// The row of a flatfile for one record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatRow {
    /// Name of the earthquake.
    pub event: String,
    /// Name of the station.
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

/// A flatfile, with rows indexed by record sequence number, or by event and station.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flatfile {
    rows: BTreeMap<u64, FlatRow>,
    /// Rows by event, network and station, all in lower case.
    stations: BTreeMap<(String, String, String), FlatRow>,
}

/// Names of the column with the record sequence number, in lower case: the name in the published table, then the names
/// in abridged versions. The other constants of type `&[&str]` list the names of other columns.
const NUMBER: &[&str] = &["record sequence number", "rsn"];
const EVENT: &[&str] = &["earthquake name", "event", "event_id"];
const STATION: &[&str] = &["station name", "station", "station_code"];
/// Columns that identify a record in the ESM flatfile.
const ESM_KEY: [&str; 3] = ["event_id", "network_code", "station_code"];
const MAGNITUDE: &[&str] = &["earthquake magnitude", "magnitude", "mw", "emec_mw", "ml"];
const RUPTURE: &[&str] = &["clstd (km)", "rrup (km)", "rrup", "rup_dist"];
const SURFACE: &[&str] = &["joyner-boore dist. (km)", "rjb (km)", "rjb", "jb_dist"];
const VS30: &[&str] = &["vs30 (m/s) selected for analysis", "vs30 (m/s)", "vs30", "vs30_m_sec"];
const STRIKE: &[&str] = &["strike (deg)", "strike", "es_strike"];

impl Flatfile {
    /// Parses a flatfile from CSV text with column names on the first line; −999 means unknown.
    ///
    /// The ESM flatfile uses semicolons and has no sequence numbers; its rows are identified by
    /// event, network and station. The magnitude is Mw or, if this is unknown, EMEC Mw or ML.
    ///
    /// # Errors
    /// If the text is empty, if there is neither a column of sequence numbers nor the identifying columns of ESM, if a
    /// number is invalid, or if a sequence number is repeated.
    pub fn parse(file: &str, text: &str) -> Result<Self, MotionError> {
        let head = text.lines().next().unwrap_or_default();
        let mark = if head.contains(';') && !head.contains(',') { ';' } else { ',' };
        let mut lines = rows(text, mark);
        let Some((_, head)) = lines.next() else {
            return Err(MotionError::parameter(
                file,
                "a table with column names in the first line",
                "nothing",
            ));
        };
        let head: Vec<String> = head
            .iter()
            .map(|name| name.trim().trim_start_matches('\u{feff}').to_ascii_lowercase())
            .collect();
        let column = |names: &[&str]| names.iter().find_map(|n| head.iter().position(|h| h == n));
        let key = ESM_KEY.map(|name| column(&[name]));
        let number = column(NUMBER);
        if number.is_none() && key.contains(&None) {
            let expected = "a column \"Record Sequence Number\" or \"RSN\", or the ESM columns event_id, \
                 network_code and station_code";
            let found = format!("{} others ({})", head.len(), shorten(&head.join(", ")));
            return Err(MotionError::parameter(file, expected, found));
        }
        let texts = [column(EVENT), column(STATION)];
        let numbers = [RUPTURE, SURFACE, VS30, STRIKE].map(column);
        let magnitudes: Vec<Option<usize>> = MAGNITUDE.iter().map(|name| column(&[name])).collect();
        let mut all = Self::default();
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
            let row = FlatRow {
                event: cell(texts[0]).to_owned(),
                station: cell(texts[1]).to_owned(),
                magnitude: magnitudes.iter().find_map(|at| value(*at).transpose()).transpose()?,
                rupture_distance: value(numbers[0])?,
                surface_distance: value(numbers[1])?,
                vs30: value(numbers[2])?,
                strike: value(numbers[3])?,
            };
            if number.is_none() {
                // Several instruments of one station share these values.
                let [event, network, station] = key.map(|at| cell(at).to_ascii_lowercase());
                all.stations.entry((event, network, station)).or_insert(row);
                continue;
            }
            let Ok(sequence) = cell(number).parse::<u64>() else {
                return Err(refuse(number, "a whole number"));
            };
            if all.rows.insert(sequence, row).is_some() {
                return Err(refuse(number, "each sequence number once"));
            }
        }
        Ok(all)
    }

    /// Returns the row with the given record sequence number.
    pub fn get(&self, number: u64) -> Option<&FlatRow> {
        self.rows.get(&number)
    }

    /// Returns the row of a record, found by the event in its header and the code of its station.
    ///
    /// Returns `None` if no row has this event and this code, or if stations of several networks have this code.
    pub fn of_record(&self, record: &Record) -> Option<&FlatRow> {
        let event = record.earthquake.id.to_ascii_lowercase();
        let named = record.channels.first()?.site.station.to_ascii_lowercase();
        let mut words = named.split_whitespace().next()?.rsplit('.');
        let (station, network) = (words.next()?, words.next());
        let mut fitting = self.stations.iter().filter(|((of, net, code), _)| {
            !event.is_empty() && *of == event && code == station && network.is_none_or(|n| n == net)
        });
        let (_, row) = fitting.next()?;
        fitting.next().is_none().then_some(row)
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.rows.len() + self.stations.len()
    }

    /// Returns `true` if the flatfile has no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Returns the record sequence number in a file name such as `RSN995_NORTHR_PEL360.AT2`; `None` if
/// the name does not begin with `RSN` and a number.
pub fn record_sequence_number(path: &str) -> Option<u64> {
    let file = path.rsplit(['/', '\\']).next()?;
    let digits =
        file.get(..3).filter(|start| start.eq_ignore_ascii_case("RSN")).map(|_| &file[3..])?;
    let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
    digits[..end].parse().ok()
}

/// Returns the rows of a CSV table (RFC 4180) whose cells are separated by `mark`. Each row has the
/// number of the line on which it begins. Rows of blank cells are skipped.
fn rows(text: &str, mark: char) -> impl Iterator<Item = (usize, Vec<String>)> {
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
                    other if other == mark && !quoted => cells.push(std::mem::take(&mut cell)),
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
