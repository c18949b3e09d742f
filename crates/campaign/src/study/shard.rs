//! Tables as Parquet files; the only module that knows the format.

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
use barrelstack_report::column::{Column, ColumnSpec, ValueKind, Values};

/// Metadata key of the columns in a file: name, unit and role.
const COLUMNS_KEY: &str = "barrelstack.columns";

/// Converts names of columns for formats of columns: letters, digits and underscores, as SQL takes them without
/// quotes.
pub(super) fn plain_names<'a>(specs: impl Iterator<Item = &'a ColumnSpec>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for spec in specs {
        let mut name: String = spec
            .name
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' })
            .collect();
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            name.insert_str(0, "c_");
        }
        let first = name.clone();
        let mut again = 2;
        while names.contains(&name) {
            name = format!("{first}_{again}");
            again += 1;
        }
        names.push(name);
    }
    names
}

/// Rows of a group, which are held in memory while a table is written.
const GROUP: usize = 1 << 15;

/// Writes a table in parts: the same rows and texts give the same bytes, however they are divided.
pub(super) struct Writer<W: std::io::Write + Send> {
    file: SerializedFileWriter<W>,
    /// Rows of an incomplete group.
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
            write_column(&mut group, &column.values)?;
        }
        group.close().map(drop)
    }

    /// Ends the file with its provenance, as pairs of key and text.
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

/// Returns a table as the bytes of a Parquet file, with its provenance as pairs of key and text; the same table
/// and pairs give the same bytes.
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
    let field = |(spec, name): (&ColumnSpec, String)| {
        let (physical, logical) = match spec.kind {
            ValueKind::Integer => (Physical::INT64, None),
            ValueKind::Number => (Physical::DOUBLE, None),
            ValueKind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        Type::primitive_type_builder(&name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical)
            .build()
            .map(Arc::new)
    };
    let names = plain_names(specs.iter());
    let fields = specs.iter().zip(names).map(field).collect::<Result<Vec<_>, _>>()?;
    Ok(Arc::new(Type::group_type_builder("case").with_fields(fields).build()?))
}

/// Returns definition levels, which mark the rows that have a value, and the values.
fn present<T, U>(values: &[Option<T>], as_stored: impl Fn(&T) -> U) -> (Vec<i16>, Vec<U>) {
    let levels = values.iter().map(|value| i16::from(value.is_some())).collect();
    (levels, values.iter().flatten().map(as_stored).collect())
}

fn write_column<W: std::io::Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &Values,
) -> Result<(), ParquetError> {
    let Some(mut writer) = group.next_column()? else {
        return Err(ParquetError::General("more columns than the schema has".to_owned()));
    };
    match values {
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

/// Reads a table from the bytes of a Parquet file written by [`to_bytes`], and the text stored beside it under a key.
pub(super) fn from_bytes(
    bytes: Vec<u8>,
    key: &str,
) -> Result<(StudyTable, Option<String>), ParquetError> {
    let foreign = || ParquetError::General("it is no table of a study".to_owned());
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
    match (group.get_column_reader(index)?, into) {
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
        _ => return Err(ParquetError::General("a column changes its kind".to_owned())),
    }
    if levels.len() == rows {
        Ok(())
    } else {
        Err(ParquetError::General(format!("a column has {} of {rows} rows", levels.len())))
    }
}

/// Puts values back into the rows that have one.
fn spread<T>(levels: &[i16], stored: Vec<T>, into: &mut Vec<Option<T>>) {
    let mut stored = stored.into_iter();
    into.extend(levels.iter().map(|level| if *level == 1 { stored.next() } else { None }));
}
