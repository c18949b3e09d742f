//! Converts tables to and from Parquet files.

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::reader::ColumnReader;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader as _, RowGroupReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};

use super::table::StudyTable;
use crate::scenario::quantity::plain;
use barrelstack_report::column::{Column, ColumnSpec, ValueKind, Values};

/// Name of the metadata entry with the specifications of the columns.
const COLUMNS_KEY: &str = "barrelstack.columns";

/// `true` if a column holds lists of numbers.
///
/// Tables in memory and CSV files hold such lists as text, in which the numbers are separated by semicolons.
/// A column of lists is recognized by its unit, since other columns of text have no unit.
pub(super) fn holds_lists(spec: &ColumnSpec) -> bool {
    spec.kind == ValueKind::Text && !spec.unit.is_empty()
}

/// Number of rows in a row group. While a table is written, the rows of one group are held in memory.
const GROUP: usize = 1 << 15;

/// Writer that receives a table in parts.
///
/// The same rows and metadata give the same bytes, regardless of the division into parts.
pub(super) struct Writer<W: std::io::Write + Send> {
    file: SerializedFileWriter<W>,
    /// Rows that do not yet fill a row group.
    rows: StudyTable,
}

impl<W: std::io::Write + Send> Writer<W> {
    pub(super) fn new(to: W, specs: &[ColumnSpec]) -> Result<Self, ParquetError> {
        let described = serde_json::to_string(specs)
            .map_err(|error| ParquetError::General(error.to_string()))?;
        let metadata = vec![KeyValue::new(COLUMNS_KEY.to_owned(), described)];
        let properties = WriterProperties::builder()
            .set_created_by(format!("barrelstack {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(metadata))
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .build();
        let file = SerializedFileWriter::new(to, schema(specs)?, Arc::new(properties))?;
        Ok(Self { file, rows: StudyTable::empty(specs) })
    }

    pub(super) fn add(&mut self, rows: &StudyTable) -> Result<(), ParquetError> {
        self.rows.append(rows.clone()).map_err(|error| ParquetError::General(error.to_string()))?;
        while self.rows.rows() >= GROUP {
            let rest = self.rows.split_off(GROUP);
            let whole = std::mem::replace(&mut self.rows, rest);
            self.group(&whole)?;
        }
        Ok(())
    }

    fn group(&mut self, rows: &StudyTable) -> Result<(), ParquetError> {
        let mut group = self.file.next_row_group()?;
        for column in rows.columns() {
            write_column(&mut group, column)?;
        }
        group.close().map(drop)
    }

    /// Writes the remaining rows and the key-value metadata `about`, and closes the file. The prefix `barrelstack.` is
    /// added to every key.
    pub(super) fn finish(mut self, about: &[(&str, String)]) -> Result<(), ParquetError> {
        let rest = self.rows.split_off(0);
        self.group(&rest)?;
        for (key, text) in about {
            let pair = KeyValue::new(format!("barrelstack.{key}"), text.clone());
            self.file.append_key_value_metadata(pair);
        }
        self.file.close().map(drop)
    }
}

/// Returns a table as the bytes of a Parquet file with the key-value metadata `about`.
///
/// The same table and metadata give the same bytes.
pub(super) fn to_bytes(
    table: &StudyTable,
    about: &[(&str, String)],
) -> Result<Vec<u8>, ParquetError> {
    let specs: Vec<ColumnSpec> = table.specs().cloned().collect();
    let mut bytes = Vec::new();
    let mut writer = Writer::new(&mut bytes, &specs)?;
    writer.add(table)?;
    writer.finish(about)?;
    Ok(bytes)
}

fn schema(specs: &[ColumnSpec]) -> Result<TypePtr, ParquetError> {
    let field = |spec: &ColumnSpec| {
        if holds_lists(spec) {
            return list_of_numbers(&spec.name).map(Arc::new);
        }
        let (physical, logical) = match spec.kind {
            ValueKind::Integer => (Physical::INT64, None),
            ValueKind::Number => (Physical::DOUBLE, None),
            ValueKind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        Type::primitive_type_builder(&spec.name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical)
            .build()
            .map(Arc::new)
    };
    let fields = specs.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    Ok(Arc::new(Type::group_type_builder("case").with_fields(fields).build()?))
}

/// Returns the Parquet type of a column of lists of numbers; a list may be empty or missing.
fn list_of_numbers(name: &str) -> Result<Type, ParquetError> {
    let element = Type::primitive_type_builder("element", Physical::DOUBLE)
        .with_repetition(Repetition::REQUIRED)
        .build()?;
    let list = Type::group_type_builder("list")
        .with_repetition(Repetition::REPEATED)
        .with_fields(vec![Arc::new(element)])
        .build()?;
    Type::group_type_builder(name)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(Some(LogicalType::List))
        .with_fields(vec![Arc::new(list)])
        .build()
}

/// Parquet definition level of a missing list.
const NO_LIST: i16 = 0;

/// Parquet definition level of an empty list.
const EMPTY: i16 = 1;

/// Parquet definition level of a number in a list.
const NUMBER: i16 = 2;

/// Definition levels, repetition levels and numbers of a column of lists.
type Divided = (Vec<i16>, Vec<i16>, Vec<f64>);

/// Parses lists of numbers; in each list, semicolons separate the numbers.
fn divided(lists: &[Option<String>]) -> Result<Divided, ParquetError> {
    let (mut defined, mut repeated, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
    for list in lists {
        let words = list.as_deref().unwrap_or_default().split(';').map(str::trim);
        let mut empty = true;
        for word in words.filter(|word| !word.is_empty()) {
            let number = word.parse().map_err(|_| {
                ParquetError::General(format!("a list of numbers contains \"{word}\""))
            })?;
            defined.push(NUMBER);
            repeated.push(i16::from(!empty));
            numbers.push(number);
            empty = false;
        }
        if empty {
            defined.push(if list.is_some() { EMPTY } else { NO_LIST });
            repeated.push(0);
        }
    }
    Ok((defined, repeated, numbers))
}

/// Appends lists of numbers to a column, as text with semicolons between the numbers; the inverse of
/// [`divided`].
fn joined(defined: &[i16], repeated: &[i16], numbers: Vec<f64>, into: &mut Vec<Option<String>>) {
    let mut numbers = numbers.into_iter();
    for (defined, repeated) in defined.iter().zip(repeated) {
        if *repeated == 0 {
            into.push((*defined != NO_LIST).then(String::new));
        }
        if let (NUMBER, Some(Some(text))) = (*defined, into.last_mut()) {
            let divider = if *repeated == 0 { "" } else { ";" };
            text.push_str(divider);
            text.push_str(&numbers.next().map(plain).unwrap_or_default());
        }
    }
}

/// Returns the definition level of every row (1 if the row has a value, otherwise 0), and the values.
fn present<T, U>(values: &[Option<T>], as_stored: impl Fn(&T) -> U) -> (Vec<i16>, Vec<U>) {
    let levels = values.iter().map(|value| i16::from(value.is_some())).collect();
    (levels, values.iter().flatten().map(as_stored).collect())
}

fn write_column<W: std::io::Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    column: &Column,
) -> Result<(), ParquetError> {
    let Some(mut writer) = group.next_column()? else {
        return Err(ParquetError::General("there are more columns than in the schema".to_owned()));
    };
    match &column.values {
        Values::Text(values) if holds_lists(&column.spec) => {
            let (defined, repeated, stored) = divided(values)?;
            let writer = writer.typed::<DoubleType>();
            writer.write_batch(&stored, Some(&defined), Some(&repeated))?;
        }
        Values::Integer(values) => {
            let (levels, stored) = present(values, |value| *value);
            writer.typed::<Int64Type>().write_batch(&stored, Some(&levels), None)?;
        }
        Values::Number(values) => {
            let (levels, stored) = present(values, |value| *value);
            writer.typed::<DoubleType>().write_batch(&stored, Some(&levels), None)?;
        }
        Values::Text(values) => {
            let (levels, stored) = present(values, |value| ByteArray::from(value.as_str()));
            writer.typed::<ByteArrayType>().write_batch(&stored, Some(&levels), None)?;
        }
    }
    writer.close()
}

/// Reads a table from the bytes of a Parquet file that [`to_bytes`] wrote. Also returns the metadata value for `key`;
/// `None` if there is none.
pub(super) fn from_bytes(
    bytes: Vec<u8>,
    key: &str,
) -> Result<(StudyTable, Option<String>), ParquetError> {
    let foreign = || ParquetError::General("it is not the table of a study".to_owned());
    let reader = SerializedFileReader::new(bytes::Bytes::from(bytes))?;
    let metadata = reader.metadata().file_metadata();
    let about = |key: &str| {
        let mut pairs = metadata.key_value_metadata()?.iter();
        pairs.find(|pair| pair.key == key)?.value.clone()
    };
    let described = about(COLUMNS_KEY)
        .and_then(|text| serde_json::from_str::<Vec<ColumnSpec>>(&text).ok())
        .ok_or_else(foreign)?;
    if metadata.schema_descr().num_columns() != described.len() {
        return Err(foreign());
    }
    let mut columns: Vec<Column> = described.into_iter().map(Column::empty).collect();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        for (index, column) in columns.iter_mut().enumerate() {
            read_column(group.as_ref(), index, &mut column.values)?;
        }
    }
    let table =
        StudyTable::new(columns).map_err(|error| ParquetError::General(error.to_string()))?;
    Ok((table, about(&format!("barrelstack.{key}"))))
}

fn read_column(
    group: &dyn RowGroupReader,
    index: usize,
    into: &mut Values,
) -> Result<(), ParquetError> {
    let rows = usize::try_from(group.metadata().num_rows())
        .map_err(|_| ParquetError::General("its number of rows is negative".to_owned()))?;
    let mut levels: Vec<i16> = Vec::new();
    let before = into.len();
    match (group.get_column_reader(index)?, &mut *into) {
        (ColumnReader::DoubleColumnReader(mut reader), Values::Text(into)) => {
            let (mut repeated, mut stored) = (Vec::new(), Vec::new());
            reader.read_records(rows, Some(&mut levels), Some(&mut repeated), &mut stored)?;
            joined(&levels, &repeated, stored, into);
        }
        (ColumnReader::Int64ColumnReader(mut reader), Values::Integer(into)) => {
            let mut stored = Vec::new();
            reader.read_records(rows, Some(&mut levels), None, &mut stored)?;
            spread(&levels, stored, into);
        }
        (ColumnReader::DoubleColumnReader(mut reader), Values::Number(into)) => {
            let mut stored = Vec::new();
            reader.read_records(rows, Some(&mut levels), None, &mut stored)?;
            spread(&levels, stored, into);
        }
        (ColumnReader::ByteArrayColumnReader(mut reader), Values::Text(into)) => {
            let mut stored = Vec::new();
            reader.read_records(rows, Some(&mut levels), None, &mut stored)?;
            let texts = stored.iter().map(|bytes| bytes.as_utf8().map(str::to_owned));
            spread(&levels, texts.collect::<Result<Vec<_>, _>>()?, into);
        }
        _ => {
            return Err(ParquetError::General(
                "the type of a column differs from its type in the schema".to_owned(),
            ));
        }
    }
    let read = into.len() - before;
    if read == rows {
        Ok(())
    } else {
        Err(ParquetError::General(format!("a column has {read} of {rows} rows")))
    }
}

/// Appends one row per definition level to a column: the next value at level 1, and `None` at level 0. This is the
/// inverse of [`present`].
fn spread<T>(levels: &[i16], stored: Vec<T>, into: &mut Vec<Option<T>>) {
    let mut stored = stored.into_iter();
    into.extend(levels.iter().map(|level| if *level == 1 { stored.next() } else { None }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use barrelstack_report::column::Role;

    #[test]
    fn lists_of_numbers_are_lists_and_read_back_to_the_same_text() {
        let lists = [Some("1.8;2.25;0.9"), None, Some(""), Some("3"), None, Some("0.5;-2")];
        let lists: Vec<_> = lists.iter().map(|list| list.map(str::to_owned)).collect();
        let spec = ColumnSpec::new("fall_heights", "m", Role::Outcome, ValueKind::Text);
        let column = Column { spec, values: Values::Text(lists) };
        let table = StudyTable::new(vec![column]).unwrap();
        let bytes = to_bytes(&table, &[]).unwrap();
        assert_eq!(from_bytes(bytes, "").unwrap().0, table);
        let spec = ColumnSpec::new("fall_heights", "m", Role::Outcome, ValueKind::Text);
        let column = Column { spec, values: Values::Text(vec![Some("1;two".into())]) };
        let error = to_bytes(&StudyTable::new(vec![column]).unwrap(), &[]).unwrap_err();
        assert!(error.to_string().contains("a list of numbers contains \"two\""), "{error}");
    }
}
