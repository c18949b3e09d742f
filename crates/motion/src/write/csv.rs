//! Writes CSV files: columns of time and acceleration, separated by commas.

use std::fmt::Write as _;

use crate::error::MotionError;
use crate::record::Record;

/// Start of the comment that states the velocity at the first sample of each channel. The comment is
/// written only if one of these velocities is not zero.
pub(crate) const INITIAL_VELOCITY: &str = "# initial velocity (m/s):";

/// First line of CSV files written by this crate; states quantity and unit.
pub(crate) const FIRST_LINE: &str = "# acceleration (m/s2)";

/// Writes a record as CSV.
///
/// The file has comment lines that start with `#`, the header `time (s),NAME (m/s2),…`, and one row
/// per sample. Accelerations have the fewest digits that read back to the same double; times are
/// rounded to a nanosecond.
///
/// ```
/// use barrelstack_motion::{ReadOptions, bundled, read, write};
/// let napa = bundled("napa-college-2014").unwrap();
/// let table = write::csv(&napa)?;
/// let again = read(table.as_bytes(), "copy.csv", &ReadOptions::default()).unwrap();
/// assert_eq!(again.channels[2].acceleration, napa.channels[2].acceleration);
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
///
/// # Errors
/// If the record has no channel or the time steps differ.
pub fn csv(record: &Record) -> Result<String, MotionError> {
    let (step, rows) = super::common(record)?;
    // Readers that recognize this line ignore steps, units and quantities in the comments below.
    let mut text = format!("{FIRST_LINE}\n");
    for (key, value) in [("event", &record.event), ("station", &record.station)] {
        if !value.is_empty() {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "# {key}: {}", plain(value));
        }
    }
    let _ = writeln!(text, "# stage: {}", record.stage);
    for note in super::provenance(record) {
        let _ = writeln!(text, "# processing: {}", plain(&note));
    }
    if let Some(velocities) = super::initial_velocities(record) {
        let _ = writeln!(text, "{INITIAL_VELOCITY} {velocities}");
    }
    text.push_str("time (s)");
    for name in super::names(&record.channels) {
        let guard = if is_formula(&name) { "'" } else { "" };
        let _ = write!(text, ",{guard}{name} (m/s2)");
    }
    text.push('\n');
    for row in 0..rows {
        text.push_str(&nanoseconds(row as f64 * step));
        for channel in &record.channels {
            let value = channel.acceleration[row];
            let tiny = value != 0.0 && value.abs() < 1e-4;
            let _ = if tiny { write!(text, ",{value:e}") } else { write!(text, ",{value}") };
        }
        text.push('\n');
    }
    Ok(text)
}

/// Prepares a string for a comment: joins it to one line, breaks up the words by which readers recognize other formats,
/// and puts an apostrophe before each comma-separated part that is a formula ([`is_formula`]).
fn plain(text: &str) -> String {
    let line = super::broken(&super::line(text), &super::FOREIGN);
    let cells = line
        .split(',')
        .map(|cell| if is_formula(cell) { format!("'{cell}") } else { cell.to_owned() });
    cells.collect::<Vec<_>>().join(",")
}

/// Returns `true` if a spreadsheet would evaluate a cell as a formula; an apostrophe before the
/// cell prevents this.
fn is_formula(cell: &str) -> bool {
    let cell = cell.trim_start();
    cell.starts_with(['=', '+', '-', '@']) && cell.len() > 1 && cell.parse::<f64>().is_err()
}

/// Formats a time (s) with up to nine decimals, without trailing zeros.
fn nanoseconds(time: f64) -> String {
    let digits = format!("{time:.9}");
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}
