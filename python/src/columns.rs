//! Columns of numbers: NumPy arrays, or tables of the Arrow PyCapsule interface.

use crate::errors::InputError;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type, Int32Type, Int64Type};
use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, Int32Array, RecordBatch};
use arrow_array::{DictionaryArray, Int8Array, StringArray};
use arrow_schema::{DataType, Field, Schema};
use arrow_select::concat::concat_batches;
use numpy::PyReadonlyArray1;
use numpy::ndarray::{ArrayView1, CowArray, Ix1};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3_arrow::PyTable;
use std::sync::Arc;

/// The releases as they were given.
pub(crate) enum Source<'py> {
    /// The nine parameters; those that are not given are zero.
    Arrays(Vec<Option<PyReadonlyArray1<'py, f64>>>),
    /// Tables with the parameters at these indices.
    Batches(Vec<RecordBatch>, Vec<Option<usize>>),
}

/// Rows of the nine parameters that stand together in memory.
pub(crate) struct Rows<'a> {
    /// Index of the first.
    pub(crate) start: usize,
    pub(crate) count: usize,
    /// A value that is missing is NaN.
    columns: Vec<Option<CowArray<'a, f64, Ix1>>>,
}

impl Rows<'_> {
    /// A value; that of a parameter that is not given is zero.
    pub(crate) fn value(&self, parameter: usize, row: usize) -> f64 {
        self.columns[parameter]
            .as_ref()
            .map_or(0.0, |column| column[row])
    }
}

impl Source<'_> {
    pub(crate) fn rows(&self) -> PyResult<Vec<Rows<'_>>> {
        match self {
            Self::Arrays(arrays) => {
                let columns: Vec<Option<CowArray<'_, f64, Ix1>>> = arrays
                    .iter()
                    .map(|array| array.as_ref().map(|array| array.as_array().into()))
                    .collect();
                let count = columns
                    .iter()
                    .flatten()
                    .next()
                    .map_or(0, |column| column.len());
                Ok(vec![Rows {
                    start: 0,
                    count,
                    columns,
                }])
            }
            Self::Batches(batches, indices) => {
                let mut start = 0;
                let mut rows = Vec::new();
                for batch in batches {
                    let columns = indices
                        .iter()
                        .map(|index| {
                            let read = |index| numbers(batch, index);
                            index.map(read).transpose()
                        })
                        .collect::<PyResult<_>>()?;
                    let count = batch.num_rows();
                    rows.push(Rows {
                        start,
                        count,
                        columns,
                    });
                    start += count;
                }
                Ok(rows)
            }
        }
    }
}

/// A column as numbers: where it lies if it is of doubles without nulls, else a copy.
fn numbers(batch: &RecordBatch, index: usize) -> PyResult<CowArray<'_, f64, Ix1>> {
    let column = batch.column(index);
    let copied: Vec<f64> = match column.data_type() {
        DataType::Float64 => {
            let values = column.as_primitive::<Float64Type>();
            if values.null_count() == 0 {
                return Ok(ArrayView1::from(&values.values()[..]).into());
            }
            values.iter().map(|x| x.unwrap_or(f64::NAN)).collect()
        }
        DataType::Float32 => {
            let values = column.as_primitive::<Float32Type>().iter();
            values.map(|x| x.map_or(f64::NAN, f64::from)).collect()
        }
        DataType::Int32 => {
            let values = column.as_primitive::<Int32Type>().iter();
            values.map(|x| x.map_or(f64::NAN, f64::from)).collect()
        }
        DataType::Int64 => {
            let values = column.as_primitive::<Int64Type>().iter();
            values.map(|x| x.map_or(f64::NAN, |x| x as f64)).collect()
        }
        other => {
            return Err(InputError::new_err(format!(
                "column {}: is of type {other}; it must be of float64, float32, int64 or int32",
                batch.schema().field(index).name()
            )));
        }
    };
    Ok(numpy::ndarray::Array1::from(copied).into())
}

/// A column of an Arrow table that is made from a NumPy array.
#[derive(FromPyObject)]
pub(crate) enum Values<'py> {
    Real(PyReadonlyArray1<'py, f64>),
    Boolean(PyReadonlyArray1<'py, bool>),
    Count(PyReadonlyArray1<'py, i32>),
    /// Codes and what they stand for.
    Category(PyReadonlyArray1<'py, i8>, Vec<String>),
    Text(Vec<String>),
}

/// A table with the Arrow PyCapsule interface from named arrays, which follow the columns of
/// `beside` if it is given. NaN becomes null.
#[pyfunction]
#[pyo3(signature = (columns, beside=None))]
pub(crate) fn arrow_table(
    columns: Vec<(String, Values<'_>)>,
    beside: Option<PyTable>,
) -> PyResult<PyTable> {
    let mut fields = Vec::new();
    let mut arrays: Vec<ArrayRef> = Vec::new();
    if let Some(beside) = beside {
        let (batches, schema) = beside.into_inner();
        let joined = concat_batches(&schema, &batches)
            .map_err(|error| PyTypeError::new_err(error.to_string()))?;
        fields.extend(schema.fields().iter().map(|field| field.as_ref().clone()));
        arrays.extend(joined.columns().iter().cloned());
    }
    for (name, values) in columns {
        let array: ArrayRef = match values {
            Values::Real(values) => {
                let values = values.as_array();
                let values = values.iter().map(|x| (!x.is_nan()).then_some(*x));
                Arc::new(values.collect::<Float64Array>())
            }
            Values::Boolean(values) => {
                let values: Vec<bool> = values.as_array().iter().copied().collect();
                Arc::new(BooleanArray::from(values))
            }
            Values::Count(values) => {
                let values: Vec<i32> = values.as_array().iter().copied().collect();
                Arc::new(Int32Array::from(values))
            }
            Values::Category(codes, names) => {
                let codes: Vec<i8> = codes.as_array().iter().copied().collect();
                let names = Arc::new(StringArray::from(names));
                let array = DictionaryArray::try_new(Int8Array::from(codes), names)
                    .map_err(|error| PyTypeError::new_err(format!("column {name}: {error}")))?;
                Arc::new(array)
            }
            Values::Text(values) => Arc::new(StringArray::from(values)),
        };
        fields.push(Field::new(name, array.data_type().clone(), true));
        arrays.push(array);
    }
    let schema = Arc::new(Schema::new(fields));
    let batch = RecordBatch::try_new(Arc::clone(&schema), arrays)
        .map_err(|error| PyTypeError::new_err(error.to_string()))?;
    PyTable::try_new(vec![batch], schema)
}

/// The names of the columns of a table with the Arrow PyCapsule interface. The table must allow to
/// be read more than once.
#[pyfunction]
pub(crate) fn column_names(table: PyTable) -> Vec<String> {
    let (_, schema) = table.into_inner();
    let fields = schema.fields().iter();
    fields.map(|field| field.name().clone()).collect()
}
