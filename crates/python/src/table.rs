//! Tables: cases as input and results as output, exchanged through Arrow capsules.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use arrow_array::builder::StringBuilder;
use arrow_array::cast::AsArray as _;
use arrow_array::ffi_stream::{FFI_ArrowArrayStream, RecordBatchStreamReader};
use arrow_array::types::{
    Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, UInt8Type, UInt16Type,
    UInt32Type, UInt64Type,
};
use arrow_array::{
    Array, ArrayRef, Float64Array, Int64Array, RecordBatch, RecordBatchIterator,
    RecordBatchReader as _,
};
use arrow_schema::{DataType, Field, Schema};
use barrelstack::ensemble::{CASE_COLUMNS, Grounds, Prepared, rows};
use barrelstack::ground::{GroundError, held};
use barrelstack::pool;
use barrelstack::scenario::{FileRef, ScenarioError, fnv1a};
use barrelstack_input::names::advice;
use barrelstack_report::column::{Column, ColumnSpec, Role, Value, ValueKind, Values, to_csv};
use barrelstack_report::shortest;
use numpy::{IntoPyArray as _, PyReadonlyArray1};
use pyo3::exceptions::{PyKeyError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyAnyMethods, PyBool, PyBytes, PyCapsule, PyFloat, PyInt, PyString};

use crate::errors;
use crate::interruptible::run_interruptible;
use crate::record::Record;
use crate::scenario::{Scenario, bytes};
use crate::view::Numbers;

/// A table: columns of equal length.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Table {
    pub(crate) columns: Vec<Column>,
}

/// A column: its name, unit, role, type and meaning.
type Facts = (String, String, String, String, &'static str);

#[pymethods]
impl Table {
    /// Creates a table of cases from columns with their headings.
    #[staticmethod]
    fn from_columns(columns: Vec<(String, Vec<Bound<'_, PyAny>>)>) -> PyResult<Self> {
        let column = |(heading, values): &(String, Vec<Bound<'_, PyAny>>)| {
            Ok(given(heading, of_values(heading, values)?))
        };
        Ok(Self { columns: columns.iter().map(column).collect::<PyResult<_>>()? })
    }

    /// Creates a table of numbers from name, unit and values of each column.
    #[staticmethod]
    fn of_numbers(columns: Vec<(String, String, PyReadonlyArray1<'_, f64>)>) -> Self {
        let column = |(name, unit, values): &(String, String, PyReadonlyArray1<'_, f64>)| Column {
            spec: ColumnSpec::new(name, unit, Role::Demand, ValueKind::Number),
            values: Values::Number(values.as_array().iter().map(|value| Some(*value)).collect()),
        };
        Self { columns: columns.iter().map(column).collect() }
    }

    /// Creates a table from name, unit, role, type and values of each column, as returned by
    /// [`Self::specs`] and [`Self::values`].
    #[staticmethod]
    fn of_parts(
        columns: Vec<(String, String, String, String, Bound<'_, PyAny>)>,
    ) -> PyResult<Self> {
        let column =
            |(name, unit, role, kind, values): (_, _, String, String, Bound<'_, PyAny>)| {
                let name: String = name;
                let unit: String = unit;
                let role = serde_json::from_value(role.into()).map_err(errors::general)?;
                let kind = serde_json::from_value(kind.into()).map_err(errors::general)?;
                let values = match kind {
                    ValueKind::Integer => Values::Integer(values.extract()?),
                    ValueKind::Number => Values::Number(values.extract()?),
                    ValueKind::Text => Values::Text(values.extract()?),
                };
                Ok(Column { spec: ColumnSpec::new(&name, &unit, role, kind), values })
            };
        Ok(Self { columns: columns.into_iter().map(column).collect::<PyResult<_>>()? })
    }

    /// Creates a table of cases from an object that exports an Arrow stream.
    #[staticmethod]
    fn from_arrow(table: &Bound<'_, PyAny>) -> PyResult<Self> {
        let batches = stream(table)?;
        let schema = batches.schema();
        let mut columns: Vec<Option<Column>> = vec![None; schema.fields().len()];
        for batch in batches {
            let batch = batch.map_err(errors::general)?;
            for ((field, array), column) in
                schema.fields().iter().zip(batch.columns()).zip(&mut columns)
            {
                let values = of_array(field.name(), array)?;
                match column {
                    Some(known) => known.values.append(values).map_err(errors::general)?,
                    None => *column = Some(given(field.name(), values)),
                }
            }
        }
        Ok(Self { columns: columns.into_iter().flatten().collect() })
    }

    fn __len__(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // The requested schema may be ignored, because consumers cast.
        drop(requested_schema);
        let batch = self.batch().map_err(errors::general)?;
        let schema = batch.schema();
        let reader = RecordBatchIterator::new([Ok(batch)], schema);
        let stream = FFI_ArrowArrayStream::new(Box::new(reader));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    fn specs(&self) -> Vec<Facts> {
        let word = |of: serde_json::Result<serde_json::Value>| {
            of.ok().and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default()
        };
        let facts = |column: &Column| {
            let ColumnSpec { name, unit, role, kind } = &column.spec;
            let known = CASE_COLUMNS.iter().find(|known| known.name == name);
            let meaning = known.map_or("", |known| known.meaning);
            let (role, kind) = (serde_json::to_value(role), serde_json::to_value(kind));
            (name.clone(), unit.clone(), word(role), word(kind), meaning)
        };
        self.columns.iter().map(facts).collect()
    }

    /// Returns the values of a column, with None for missing values.
    fn values<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        match &self.column(name)?.values {
            Values::Integer(values) => values.clone().into_pyobject(py).map(Bound::into_any),
            Values::Number(values) => values.clone().into_pyobject(py).map(Bound::into_any),
            Values::Text(values) => values.clone().into_pyobject(py).map(Bound::into_any),
        }
    }

    /// Returns the numbers of a column, with NaN for missing values.
    fn numbers<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Numbers<'py>> {
        let column = self.column(name)?;
        let number = |row| match column.values.get(row) {
            Some(Value::Number(value)) => value,
            Some(Value::Integer(value)) => value as f64,
            Some(Value::Text(_)) | None => f64::NAN,
        };
        if column.spec.kind == ValueKind::Text {
            return Err(PyTypeError::new_err(format!("the column `{name}` contains text")));
        }
        Ok((0..column.values.len()).map(number).collect::<Vec<f64>>().into_pyarray(py))
    }

    fn to_csv(&self) -> String {
        to_csv(&self.columns)
    }

    fn to_parquet<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let table = barrelstack_campaign::study::StudyTable::new(self.columns.clone());
        let made = table.and_then(|table| table.to_parquet()).map_err(errors::study)?;
        Ok(bytes(py, &made))
    }
}

impl Table {
    fn column(&self, name: &str) -> PyResult<&Column> {
        let missing = || {
            let names: Vec<&str> = self.columns.iter().map(|one| one.spec.name.as_str()).collect();
            PyKeyError::new_err(format!("there is no column {name:?}; {}", advice(name, &names)))
        };
        self.columns.iter().find(|column| column.spec.name == name).ok_or_else(missing)
    }

    fn batch(&self) -> Result<RecordBatch, arrow_schema::ArrowError> {
        let mut fields = Vec::new();
        let mut arrays: Vec<ArrayRef> = Vec::new();
        for column in &self.columns {
            let (kind, array): (DataType, ArrayRef) = match &column.values {
                Values::Integer(values) => {
                    (DataType::Int64, Arc::new(Int64Array::from(values.clone())))
                }
                Values::Number(values) => {
                    (DataType::Float64, Arc::new(Float64Array::from(values.clone())))
                }
                Values::Text(values) => {
                    let mut texts = StringBuilder::new();
                    for text in values {
                        texts.append_option(text.as_ref());
                    }
                    (DataType::Utf8, Arc::new(texts.finish()))
                }
            };
            let unit = HashMap::from([("unit".to_owned(), column.spec.unit.clone())]);
            fields.push(Field::new(&column.spec.name, kind, true).with_metadata(unit));
            arrays.push(array);
        }
        RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays)
    }
}

/// Reads the record batches of a table that belongs to another library.
fn stream(table: &Bound<'_, PyAny>) -> PyResult<RecordBatchStreamReader> {
    let capsule = table.call_method0("__arrow_c_stream__")?;
    let capsule = capsule.cast_into::<PyCapsule>()?;
    let pointer = capsule.pointer_checked(Some(c"arrow_array_stream"))?;
    #[expect(unsafe_code, reason = "the C interface of Arrow")]
    // SAFETY: in the Arrow capsule protocol, a capsule with this name contains a stream that lives
    // as long as the capsule, and a consumer that takes the stream out leaves an empty one behind,
    // as this call does.
    let reader = unsafe { RecordBatchStreamReader::from_raw(pointer.cast().as_ptr()) };
    reader.map_err(errors::general)
}

/// Creates a column of a table of cases; its heading may state a unit, as in `motion.scale.pgv
/// (cm/s)`.
fn given(heading: &str, values: Values) -> Column {
    let stated = heading.trim().strip_suffix(')').and_then(|text| text.rsplit_once(" ("));
    let (name, unit) = stated.unwrap_or((heading.trim(), ""));
    let kind = match values {
        Values::Integer(_) => ValueKind::Integer,
        Values::Number(_) => ValueKind::Number,
        Values::Text(_) => ValueKind::Text,
    };
    Column { spec: ColumnSpec::new(name, unit, Role::Factor, kind), values }
}

fn of_values(heading: &str, values: &[Bound<'_, PyAny>]) -> PyResult<Values> {
    let some = || values.iter().filter(|value| !value.is_none());
    let whole = |value: &Bound<'_, PyAny>| {
        value.is_instance_of::<PyInt>() && !value.is_instance_of::<PyBool>()
    };
    if some().all(whole) {
        return values
            .iter()
            .map(PyAnyMethods::extract)
            .collect::<PyResult<_>>()
            .map(Values::Integer);
    }
    if some().all(|value| whole(value) || value.is_instance_of::<PyFloat>()) {
        return values
            .iter()
            .map(PyAnyMethods::extract)
            .collect::<PyResult<_>>()
            .map(Values::Number);
    }
    let text = |value: &Bound<'_, PyAny>| -> PyResult<Option<String>> {
        if value.is_none() {
            return Ok(None);
        }
        if value.is_instance_of::<PyBool>() {
            return Ok(Some(value.extract::<bool>()?.to_string()));
        }
        if whole(value) {
            return Ok(Some(value.extract::<i64>()?.to_string()));
        }
        if value.is_instance_of::<PyFloat>() {
            return Ok(Some(shortest(value.extract()?)));
        }
        if value.is_instance_of::<PyString>() {
            return value.extract().map(Some);
        }
        let kind = value.get_type().name()?;
        Err(PyTypeError::new_err(format!(
            "the column `{heading}` contains values of type {kind}; expected numbers, booleans or strings"
        )))
    };
    values.iter().map(text).collect::<PyResult<_>>().map(Values::Text)
}

#[expect(clippy::wildcard_enum_match_arm, reason = "the enum of another library may grow")]
fn of_array(heading: &str, array: &ArrayRef) -> PyResult<Values> {
    macro_rules! whole {
        ($kind:ty) => {
            Values::Integer(
                array.as_primitive::<$kind>().iter().map(|v| v.map(i64::from)).collect(),
            )
        };
    }
    macro_rules! texts {
        ($array:expr) => {
            Values::Text($array.iter().map(|text| text.map(str::to_owned)).collect())
        };
    }
    Ok(match array.data_type() {
        DataType::Int8 => whole!(Int8Type),
        DataType::Int16 => whole!(Int16Type),
        DataType::Int32 => whole!(Int32Type),
        DataType::Int64 => whole!(Int64Type),
        DataType::UInt8 => whole!(UInt8Type),
        DataType::UInt16 => whole!(UInt16Type),
        DataType::UInt32 => whole!(UInt32Type),
        DataType::UInt64 => {
            let values = array.as_primitive::<UInt64Type>().iter();
            Values::Integer(values.map(|v| v.and_then(|v| i64::try_from(v).ok())).collect())
        }
        DataType::Float32 => {
            let values = array.as_primitive::<Float32Type>().iter();
            Values::Number(values.map(|value| value.map(f64::from)).collect())
        }
        DataType::Float64 => Values::Number(array.as_primitive::<Float64Type>().iter().collect()),
        DataType::Boolean => {
            let values = array.as_boolean().iter();
            Values::Text(values.map(|value| value.map(|value| value.to_string())).collect())
        }
        DataType::Utf8 => texts!(array.as_string::<i32>()),
        DataType::LargeUtf8 => texts!(array.as_string::<i64>()),
        DataType::Utf8View => texts!(array.as_string_view()),
        DataType::Null => Values::Text(vec![None; array.len()]),
        other => {
            return Err(PyTypeError::new_err(format!(
                "the column `{heading}` contains {other}; expected integers, floating-point numbers, booleans or \
                 strings"
            )));
        }
    })
}

/// The cases of a table: a base scenario, the changes of each row, and the records to which rows
/// refer.
struct Cases<'a> {
    base: &'a barrelstack::Scenario,
    columns: &'a [Column],
    records: HashMap<String, FileRef>,
    grounds: Grounds,
}

/// Name of the column that gives the record of each row by name. All other columns set fields.
const RECORD: &str = "record";

impl Cases<'_> {
    /// Returns the scenario of a row.
    fn scenario(&self, row: usize) -> Result<barrelstack::Scenario, CaseError> {
        let mut changes = Vec::with_capacity(self.columns.len());
        let mut record = None;
        for column in self.columns {
            let name = &column.spec.name;
            let value = match column.values.get(row) {
                None => continue,
                Some(Value::Text(text)) if name == RECORD => {
                    record = Some(text);
                    continue;
                }
                Some(Value::Integer(value)) => value.to_string(),
                Some(Value::Number(value)) => shortest(value),
                Some(Value::Text(text)) => text,
            };
            let point = if column.spec.unit.is_empty() { "" } else { " " };
            changes.push(format!("{name}={value}{point}{}", with_powers(&column.spec.unit)));
        }
        let scenario = self.base.with(&changes).map_err(CaseError::Scenario)?;
        if scenario.stack().is_some_and(|stack| stack.columns_along.is_some()) {
            return Err(CaseError::Planes);
        }
        let Some(record) = record else { return Ok(scenario) };
        let file = self.records.get(&record).ok_or(CaseError::Record(record))?;
        Ok(scenario.with_record_file(file))
    }

    fn prepared(&self, row: usize) -> Result<Prepared, String> {
        let scenario = self.scenario(row).map_err(|error| error.sentence())?;
        let ground = self.grounds.of(&scenario).map_err(|error| error.to_string())?;
        Ok(Prepared::shaken_by(Arc::new(scenario), ground))
    }

    /// Returns a hash of the view, the number of levels and the number of columns of the stack. Cases whose hashes
    /// differ cannot run together.
    fn kind(scenario: &barrelstack::Scenario) -> u64 {
        let Some(stack) = scenario.stack() else { return 0 };
        fnv1a(format!("{:?} {} {}", stack.view, stack.levels, stack.columns).as_bytes())
    }
}

/// Converts a unit to the form of scenario files: table headings have `m/s2` for `m/s^2`.
fn with_powers(unit: &str) -> String {
    let mut text = String::new();
    for sign in unit.chars() {
        if sign.is_ascii_digit() && text.ends_with(|before: char| before.is_alphabetic()) {
            text.push('^');
        }
        text.push(sign);
    }
    text
}

/// Reason why a case cannot be run.
enum CaseError {
    Scenario(ScenarioError),
    Planes,
    Record(String),
    Ground(GroundError),
}

impl CaseError {
    fn sentence(&self) -> String {
        match self {
            Self::Scenario(error) => error.sentence(),
            Self::Planes => {
                "a table of cases is run in one plane: leave stack.columns_along out and set stack.view to \
                 \"transverse\", or to \"longitudinal\" with stack.columns equal to stack.columns_along"
                    .to_owned()
            }
            Self::Record(name) => format!("no record named \"{name}\" was given"),
            Self::Ground(error) => error.to_string(),
        }
    }

    fn raised(&self, row: usize) -> PyErr {
        match self {
            Self::Scenario(error) => {
                let raised = errors::scenario(error);
                Python::attach(|py| {
                    // Sets the number of the row on the exception.
                    let _ = raised.value(py).setattr("row", row);
                });
                raised
            }
            Self::Planes => errors::inconsistent(self.sentence()),
            Self::Ground(error) => errors::ground(error),
            Self::Record(_) => PyValueError::new_err(format!("row {row}: {}", self.sentence())),
        }
    }
}

/// Runs the cases of a table on all cores and returns their results.
#[pyfunction]
pub(crate) fn ensemble(
    py: Python<'_>,
    base: &Scenario,
    cases: &Table,
    records: HashMap<String, PyRef<'_, Record>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Table> {
    let records: HashMap<String, FileRef> = records
        .iter()
        .map(|(name, record)| Ok((name.clone(), held(&record.inner).map_err(errors::motion)?)))
        .collect::<PyResult<_>>()?;
    let count = cases.__len__();
    let all =
        Cases { base: &base.inner, columns: &cases.columns, records, grounds: Grounds::default() };
    let found = run_interruptible(py, progress, |state| {
        // Fail early: every row is checked before the computation starts.
        let numbers: Vec<usize> = (0..count).collect();
        let kinds =
            pool::map(&numbers, |row| all.scenario(*row).map(|one| Cases::kind(&one)), &|_| ());
        let mut known = Vec::with_capacity(count);
        for (row, kind) in kinds.into_iter().enumerate() {
            known.push(kind.map_err(|error| (error, row))?);
        }
        if count > 0 {
            // A problem that affects all cases is reported once, not in every row.
            let first = all.scenario(0).map_err(|error| (error, 0))?;
            all.grounds.of(&first).map_err(|error| (CaseError::Ground(error), 0))?;
        }
        let done = AtomicUsize::new(0);
        let table = rows(
            count,
            &|row| known[row],
            &|row| all.prepared(row),
            None,
            &|_| {
                let now = done.fetch_add(1, Ordering::Relaxed) + 1;
                let _: ControlFlow<()> = state.report(now as f64, count as f64, "cases");
                ControlFlow::Continue(())
            },
            &|| state.stopped(),
        );
        Ok(table)
    })?;
    let found = found.map_err(|(error, row): (CaseError, usize)| error.raised(row))?;
    let results = found.ok_or_else(|| errors::general("the cases were stopped"))?;
    let columns = cases.columns.iter().cloned().chain(results).collect();
    Ok(Table { columns })
}
