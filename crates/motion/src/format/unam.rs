//! Reader of UNAM and CICESE files, Mexico: the "archivo estándar de aceleración" (ASA 2.0),
//! columns in gal.
//!
//! Keys are Spanish and have several spellings; `ORIENTACION C1-C6` states the order of the
//! columns. Spec: Sociedad Mexicana de Ingeniería Sísmica, formato estándar de aceleración, version
//! 2.0.

use super::source::{
    Columns, GAL, LARGEST_ACCELERATION, Source, leading_number, leading_printed, quoted,
};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::earthquake::Earthquake;
use crate::error::ReadError;
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::utc::{DateOrder, Utc};

pub(crate) const FORMAT: Format =
    Format { name: "unam", title: "UNAM and CICESE ASA 2.0 (Mexico)", sniff, read };

const MOST_HEADER_LINES: usize = 200;

fn sniff(source: &Source<'_>) -> bool {
    // Accented capitals may be missing or depend on the encoding.
    (0..20).any(|line| source.has(line, "ARCHIVO EST") && source.has(line, "NDAR DE ACELERACI"))
}

/// Reduces a key to its letters and digits, so that "C1-C6, (s)" equals "C1-C6 (s)".
fn reduced(text: &str) -> String {
    text.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_uppercase()
}

fn field(source: &Source<'_>, key: &str) -> Option<(usize, String)> {
    let key = reduced(key);
    let found = source.field(MOST_HEADER_LINES, |text| {
        let (name, value) = text.split_once(':')?;
        reduced(name).starts_with(&key).then_some(value)
    });
    found.filter(|(_, value)| !value.is_empty())
}

/// Parses a list of one or more items, such as `/a/b/c`.
fn list(text: &str) -> Vec<String> {
    text.trim_start_matches('/').split('/').map(|part| part.trim().to_owned()).collect()
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let need = |key: &str| source.needed(field(source, key), key);
    let numbers = |key: &str| -> Result<(usize, Vec<f64>), ReadError> {
        let (line, text) = need(key)?;
        let values: Option<Vec<f64>> =
            list(&text).iter().map(|part| leading_number(part.as_bytes())).collect();
        values.map(|values| (line, values)).ok_or_else(|| {
            source.header(line, format!("numbers between slashes for \"{key}\""), quoted(&text))
        })
    };
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    let (unit_line, unit) = need("UNIDADES DE LOS DATOS")?;
    if !unit.to_ascii_lowercase().contains("gal") {
        return Err(source.not_acceleration(
            unit_line,
            "Gal (cm/s/s) as unit",
            quoted(&unit),
            "give the acceleration file of the same station",
        ));
    }
    let names = list(&need("ORIENTACION C1-C6")?.1);
    let (step_line, steps) = numbers("INTERVALO DE MUESTREO, C1-C6")?;
    let (count_line, counts) = numbers("NUM. TOTAL DE MUESTRAS, C1-C6")?;
    let (time_step, count) = (steps[0], counts[0]);
    if steps.iter().any(|step| *step != time_step) {
        return Err(source.damaged(
            step_line,
            "one step for all channels",
            format!("{steps:?}"),
            "split the file by channel",
        ));
    }
    let count = super::whole(source, count_line, "a number of samples", count)?;
    let first = data_line(source)?;
    let columns = field(source, "FORMATO DATOS")
        .and_then(|(_, text)| Columns::parse(&text))
        .filter(|columns| columns.per_line == names.len())
        .unwrap_or(Columns::new(names.len(), 10));
    let limit = LARGEST_ACCELERATION / GAL;
    let mut values = vec![Vec::with_capacity(count.min(source.lines.len())); names.len()];
    for line in first..source.lines.len() {
        let (row, _) = source.fixed(line, names.len(), columns, limit)?;
        for (column, value) in values.iter_mut().zip(row) {
            column.push(value * GAL);
        }
    }
    let found = values.first().map_or(0, Vec::len);
    // In this format, one or two excess values are also ignored.
    if found > count {
        for column in &mut values {
            column.truncate(count);
        }
        record.warn(
            count_line + 1,
            format!(
                "the header states {count} samples, the file contains {found}; the excess samples \
                 are ignored"
            ),
        );
    } else {
        super::check_count(source, &mut record, count_line, count, found)?;
    }
    record.station = need("CLAVE DE LA ESTACION")?.1;
    record.event = field(source, "FECHA DEL SISMO").map(|(_, text)| text).unwrap_or_default();
    let peaks =
        field(source, "ACEL. MAX.(Gal), C1-C6").map(|(_, text)| list(&text)).unwrap_or_default();
    for (k, (name, values)) in names.iter().zip(values).enumerate() {
        let mut channel = Channel::new(name.clone(), Direction::parse(name), time_step, values);
        let peak = peaks.get(k).and_then(|text| leading_printed(text.as_bytes()));
        channel.state_peak(peak, GAL);
        record.channels.push(channel);
    }
    record.earthquake = earthquake(source);
    let start = start(source);
    if let Some((line, hour)) = field(source, "HORA DE LA PRIMERA MUESTRA") {
        let day = field(source, "FECHA DEL SISMO").map(|(_, day)| day).unwrap_or_default();
        record.warn_of_start(line, format!("{day} {hour}").trim(), start);
    }
    record.place(start, &site(source));
    Ok(record)
}

/// Returns the time of the first sample. The date is the day of the event, or the next day if the
/// first sample would otherwise precede the event by more than half a day.
fn start(source: &Source<'_>) -> Option<Utc> {
    let (_, day) = field(source, "FECHA DEL SISMO")?;
    let at = |hour: String| Utc::in_header(&format!("{day} {hour}"), DateOrder::DayFirst);
    let first = at(field(source, "HORA DE LA PRIMERA MUESTRA")?.1)?;
    let event = at(field(source, "HORA EPICENTRO")?.1)?;
    let day = 86_400.0;
    Some(if event.since(first) > 0.5 * day { first.later(day) } else { first })
}

/// Returns the earthquake. Of several magnitudes, such as `/Mb=5.2/Ms=5.8`, the moment magnitude is
/// used, else the surface-wave magnitude, else the first magnitude.
fn earthquake(source: &Source<'_>) -> Earthquake {
    let stated = field(source, "MAGNITUD").map(|(_, text)| list(&text)).unwrap_or_default();
    let all: Vec<(&str, Option<f64>)> = stated
        .iter()
        .filter_map(|part| part.split_once('='))
        .map(|(scale, value)| (scale.trim(), leading_number(value.as_bytes())))
        .collect();
    let of = |scale: &'static str| all.iter().find(|(name, _)| name.eq_ignore_ascii_case(scale));
    let ordered = ["Mw", "Ms"].into_iter().filter_map(of).chain(&all).copied();
    let depth = field(source, "PROFUNDIDAD FOCAL").and_then(|(_, t)| leading_number(t.as_bytes()));
    Earthquake::of_magnitude(ordered).at(degrees(source, "COORDENADAS DEL EPICENTRO"), depth)
}

/// Parses a position such as `19.33024 LAT. N`, with `99.181076 LONG. W` on the next line.
fn degrees(source: &Source<'_>, key: &str) -> Option<(f64, f64)> {
    let signed = |text: &str| {
        let value = leading_number(text.trim_start_matches(':').as_bytes())?;
        Some(if text.trim_end().ends_with(['S', 'W']) { -value } else { value })
    };
    let (line, text) = field(source, key)?;
    signed(&text).zip(signed(&source.text(line + 1)))
}

fn site(source: &Source<'_>) -> Site {
    let position = degrees(source, "COORDENADAS DE LA ESTACION");
    let elevation = field(source, "ALTITUD").and_then(|(_, text)| leading_number(text.as_bytes()));
    Site { elevation, ..Site::default() }.at(position)
}

/// Returns the line after the second line of hyphens below `DATOS DE ACELERACION`.
fn data_line(source: &Source<'_>) -> Result<usize, ReadError> {
    let title = (0..MOST_HEADER_LINES.min(source.lines.len()))
        .rev()
        .find(|&line| source.text(line).starts_with("DATOS DE ACELERACI"));
    title
        .and_then(|title| {
            let mut rulers = (title..source.lines.len().min(title + 12))
                .filter(|&line| source.text(line).starts_with("-----"));
            rulers.nth(1).map(|line| line + 1)
        })
        .ok_or_else(|| {
            source.damaged(
                (),
                "\"DATOS DE ACELERACION\" with two rulers before the data",
                "none",
                "the file is truncated; get it again from its source",
            )
        })
}
