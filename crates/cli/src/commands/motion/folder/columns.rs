//! Columns of the table of records: header data, flatfile data and measures.

use barrelstack_campaign::study::{ColumnSpec, Role, Value, ValueKind};
use barrelstack_motion::{ClassifiedPulse, FlatRow, Measured, MeasuredComponent};

use super::{Source, Worked, stage_of};

/// Data of a record for a row of the table.
pub(super) struct RecordData<'a> {
    pub(super) source: &'a Source,
    pub(super) worked: &'a Worked,
    pub(super) measured: &'a Measured,
    /// Record sequence number.
    pub(super) number: Option<u64>,
    pub(super) flat: Option<&'a FlatRow>,
}

impl RecordData<'_> {
    /// Returns the file that contains the horizontal component with the index `horizontal`, and the
    /// channel of the component in this file, such as `#1` for the first channel.
    ///
    /// `None` if there is no such component. Also `None` if the record has several files, but not one
    /// file per channel, because the file of a channel is then unknown.
    fn place(&self, horizontal: usize) -> Option<(String, String)> {
        let (paths, channels) = (self.source.paths(), &self.worked.record.channels);
        let flat = channels.iter().enumerate().filter(|(_, channel)| !channel.is_vertical());
        let (at, _) = flat.take(2).nth(horizontal)?;
        let (file, number) = match paths.len() {
            1 => (0, at + 1),
            n if n == channels.len() => (at, 1),
            _ => return None,
        };
        Some((paths[file].display().to_string(), format!("#{number}")))
    }
}

/// A column, and the value of one row in this column, if any.
type Cell = (ColumnSpec, Option<Value>);

fn spec(name: String, unit: &str, role: Role, kind: ValueKind) -> ColumnSpec {
    ColumnSpec { name, unit: unit.to_owned(), role, kind }
}

fn text(name: &str, value: Option<String>) -> Cell {
    let value = value.filter(|text| !text.is_empty()).map(Value::Text);
    (spec(name.to_owned(), "", Role::Motion, ValueKind::Text), value)
}

fn number(name: impl Into<String>, unit: &str, role: Role, value: Option<f64>) -> Cell {
    let value = value.filter(|value| value.is_finite()).map(Value::Number);
    (spec(name.into(), unit, role, ValueKind::Number), value)
}

fn integer(name: impl Into<String>, value: Option<usize>) -> Cell {
    let value = value.and_then(|value| i64::try_from(value).ok()).map(Value::Integer);
    (spec(name.into(), "", Role::Motion, ValueKind::Integer), value)
}

/// Returns all columns in order, with the values of a row if `data` is given.
pub(super) fn cells(data: Option<&RecordData<'_>>, periods: &[f64]) -> Vec<Cell> {
    let mut cells = header(data);
    let horizontal = |k: usize| data.and_then(|f| f.measured.horizontals.get(k));
    for (k, place) in ["h1", "h2"].into_iter().enumerate() {
        let (file, component) = data.and_then(|f| f.place(k)).unzip();
        cells.push(text(&format!("file_{place}"), file));
        cells.push(text(&format!("place_{place}"), component));
    }
    component(&mut cells, "h1", horizontal(0));
    pulse(&mut cells, "baker_h1", data.and_then(|_| horizontal(0)?.pulse.as_ref()));
    component(&mut cells, "h2", horizontal(1));
    pulse(&mut cells, "baker_h2", data.and_then(|_| horizontal(1)?.pulse.as_ref()));
    component(&mut cells, "v", data.and_then(|f| f.measured.vertical.as_ref()));
    let pair = data.and_then(|f| f.measured.pair.as_ref());
    let im = Role::Intensity;
    cells.push(number("pga_rotd50", "m/s2", im, pair.map(|pair| pair.peaks[0])));
    cells.push(number("pgv_rotd50", "m/s", im, pair.map(|pair| pair.peaks[1])));
    let both = pair.and_then(|pair| pair.pulse.as_ref());
    let why = data.and_then(|f| f.measured.no_pair.clone());
    cells.push(number("pga_rotd100", "m/s2", im, pair.map(|pair| pair.largest[0])));
    cells.push(number("pgv_rotd100", "m/s", im, pair.map(|pair| pair.largest[1])));
    cells.push(text("no_rotd50_because", why));
    pulse(&mut cells, "shahi_baker", both);
    let angle = both.map(|pulse| pulse.angle);
    cells.push(number("shahi_baker_direction_from_h1", "deg", im, angle));
    for (k, period) in periods.iter().enumerate() {
        let median = pair.and_then(|pair| pair.spectrum.get(k)).map(|peak| peak.median);
        cells.push(number(format!("sa_rotd50_{period}"), "m/s2", im, median));
    }
    for (k, period) in periods.iter().enumerate() {
        let largest = pair.and_then(|pair| pair.spectrum.get(k)).map(|peak| peak.largest);
        cells.push(number(format!("sa_rotd100_{period}"), "m/s2", im, largest));
    }
    for (k, period) in periods.iter().enumerate() {
        let sa = horizontal(0).and_then(|h1| h1.spectrum.get(k)).copied();
        cells.push(number(format!("sa_h1_{period}"), "m/s2", im, sa));
    }
    cells
}

/// Returns the columns that describe a record and its processing; a flatfile takes precedence over
/// a header.
fn header(data: Option<&RecordData<'_>>) -> Vec<Cell> {
    let record = data.map(|f| &f.worked.record);
    let first = record.and_then(|record| record.channels.first());
    let flat = data.and_then(|f| f.flat);
    let either = |flat: Option<&String>, header: Option<&String>| {
        flat.filter(|text| !text.is_empty()).or(header).cloned()
    };
    let files = data.map(|f| {
        let paths = f.source.paths();
        paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join("; ")
    });
    let names = record.map(|record| {
        record.channels.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join("; ")
    });
    let site = first.map(|channel| &channel.site);
    let facts = Role::Motion;
    vec![
        (
            spec("record".to_owned(), "", Role::Key, ValueKind::Text),
            data.map(|f| Value::Text(f.source.record.name.clone())),
        ),
        text("files", files),
        text("format", record.map(|record| record.format.to_owned())),
        text("event", either(flat.map(|row| &row.event), record.map(|record| &record.event))),
        text("station", either(flat.map(|row| &row.station), record.map(|r| &r.station))),
        text("sensor", site.map(|site| site.sensor.clone())),
        text("start", first.and_then(|c| c.start).map(|start| start.to_string())),
        text("components", names),
        text("stage", data.map(|f| stage_of(f.worked).0)),
        text("processing", data.map(|f| stage_of(f.worked).1.to_owned())),
        number("latitude", "deg", facts, site.and_then(|site| site.latitude)),
        number("longitude", "deg", facts, site.and_then(|site| site.longitude)),
        integer("rsn", data.and_then(|f| f.number).and_then(|n| usize::try_from(n).ok())),
        number(
            "magnitude",
            "",
            facts,
            flat.and_then(|row| row.magnitude)
                .or_else(|| record.and_then(|record| record.earthquake.magnitude)),
        ),
        number("rupture_distance", "km", facts, flat.and_then(|row| row.rupture_distance)),
        number("surface_distance", "km", facts, flat.and_then(|row| row.surface_distance)),
        number(
            "epicentral_distance",
            "km",
            facts,
            record.and_then(barrelstack_motion::Record::epicentral_distance),
        ),
        number(
            "vs30",
            "m/s",
            facts,
            flat.and_then(|row| row.vs30).or_else(|| site.and_then(|site| site.vs30)),
        ),
        number("time_step", "s", facts, first.map(|channel| channel.time_step)),
        integer("samples", first.map(|channel| channel.acceleration.len())),
        integer("warnings", record.map(|record| record.warnings.len())),
    ]
}

fn component(cells: &mut Vec<Cell>, place: &str, measured: Option<&MeasuredComponent>) {
    let im = Role::Intensity;
    let of = |what: &str| format!("{what}_{place}");
    cells.push(text(&format!("name_{place}"), measured.map(|m| m.name.clone())));
    cells.push(number(of("azimuth"), "deg", Role::Motion, measured.and_then(|m| m.azimuth)));
    cells.push(number(of("pga"), "m/s2", im, measured.map(|m| m.peaks[0])));
    cells.push(number(of("pgv"), "m/s", im, measured.map(|m| m.peaks[1])));
    cells.push(number(of("pgd"), "m", im, measured.map(|m| m.peaks[2])));
    cells.push(number(of("arias"), "m/s", im, measured.map(|m| m.arias)));
    cells.push(number(of("cav"), "m/s", im, measured.map(|m| m.cav)));
    cells.push(number(of("d5_95"), "s", im, measured.map(|m| m.duration)));
    cells.push(number(of("fiv3_1s"), "m/s", im, measured.map(|m| m.fiv3)));
}

/// Adds the pulse class (1 or 0), the pulse indicator, and the pulse period. The column names end with `how`, which
/// names the method of classification and, for a single component, the component.
fn pulse(cells: &mut Vec<Cell>, how: &str, pulse: Option<&ClassifiedPulse>) {
    let im = Role::Intensity;
    cells.push(integer(format!("pulse_{how}"), pulse.map(|p| usize::from(p.pulse_like))));
    cells.push(number(format!("pulse_indicator_{how}"), "", im, pulse.map(|p| p.indicator)));
    cells.push(number(format!("pulse_period_{how}"), "s", im, pulse.map(|p| p.period)));
}
