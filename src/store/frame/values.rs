//! The values of one column, gathered from arrays of arrow into one of polars.

use std::sync::Arc;

use arrow_array::Array;
use arrow_array::cast::AsArray;
use arrow_array::types as arrow;
use arrow_schema::{DataType, Field};
use polars::prelude::{
    BooleanChunkedBuilder, ChunkedBuilder, Column, Float64Type, IntoColumn, PolarsDataType, PolarsError,
    PolarsResult, PrimitiveChunkedBuilder, UInt32Type, UInt64Type, polars_err,
};

use super::labels::{Labels, is_text};

/// A column as far as it was read.
pub(super) enum Values {
    /// Truth values.
    Flags(BooleanChunkedBuilder),
    /// Counts.
    Counts(PrimitiveChunkedBuilder<UInt64Type>),
    /// Real numbers, and integers of other widths than counts.
    Numbers(PrimitiveChunkedBuilder<Float64Type>),
    /// Numbers of labels.
    Texts(PrimitiveChunkedBuilder<UInt32Type>, Labels),
}

impl Values {
    /// A column without rows, of what such a field holds.
    ///
    /// # Errors
    /// An error for a field that holds neither numbers, truth values nor texts.
    pub fn begin(field: &Field) -> PolarsResult<Self> {
        let name = field.name().as_str();
        Ok(match field.data_type() {
            DataType::Boolean => Values::Flags(BooleanChunkedBuilder::new(name.into(), 0)),
            DataType::UInt64 => Values::Counts(PrimitiveChunkedBuilder::new(name.into(), 0)),
            kind if is_number(kind) => Values::Numbers(PrimitiveChunkedBuilder::new(name.into(), 0)),
            kind if is_text(kind) => {
                Values::Texts(PrimitiveChunkedBuilder::new(name.into(), 0), Labels::default())
            }
            kind => return Err(refused(name, kind)),
        })
    }

    /// Adds the values of an array of the column `name`.
    ///
    /// # Errors
    /// An error for an array that holds something else than the column.
    pub fn append(&mut self, name: &str, array: &dyn Array) -> PolarsResult<()> {
        match (self, array.data_type()) {
            (Values::Flags(flags), DataType::Boolean) => extend(flags, array.as_boolean().iter()),
            (Values::Counts(counts), DataType::UInt64) => {
                extend(counts, array.as_primitive::<arrow::UInt64Type>().iter())
            }
            (Values::Numbers(numbers), kind) if is_number(kind) => append_numbers(numbers, array),
            (Values::Texts(numbers, labels), kind) if is_text(kind) => {
                extend(numbers, labels.numbers(array).into_iter())
            }
            (_, kind) => return Err(refused(name, kind)),
        }
        Ok(())
    }

    /// The column, and its labels where it is one of texts.
    pub fn finish(self) -> (Column, Option<Arc<[Arc<str>]>>) {
        match self {
            Values::Flags(flags) => (flags.finish().into_column(), None),
            Values::Counts(counts) => (counts.finish().into_column(), None),
            Values::Numbers(numbers) => (numbers.finish().into_column(), None),
            Values::Texts(numbers, labels) => (numbers.finish().into_column(), Some(labels.into_texts())),
        }
    }
}

fn is_number(kind: &DataType) -> bool {
    kind.is_integer() || matches!(kind, DataType::Float32 | DataType::Float64)
}

fn refused(name: &str, kind: &DataType) -> PolarsError {
    let allowed = "numbers, truth values or texts, the same in all files";
    polars_err!(ComputeError: "column {name:?} holds {kind}; allowed: {allowed}")
}

fn extend<N, T: PolarsDataType>(
    into: &mut impl ChunkedBuilder<N, T>,
    values: impl Iterator<Item = Option<N>>,
) {
    values.for_each(|value| into.append_option(value));
}

/// As polars does it too: an integer beyond 2⁵³ becomes the nearest number.
fn append_numbers(into: &mut PrimitiveChunkedBuilder<Float64Type>, array: &dyn Array) {
    macro_rules! widened {
        ($kind:ident) => {
            extend(
                into,
                array.as_primitive::<arrow::$kind>().iter().map(|value| value.map(|value| value as f64)),
            )
        };
    }
    match array.data_type() {
        DataType::Int8 => widened!(Int8Type),
        DataType::Int16 => widened!(Int16Type),
        DataType::Int32 => widened!(Int32Type),
        DataType::Int64 => widened!(Int64Type),
        DataType::UInt8 => widened!(UInt8Type),
        DataType::UInt16 => widened!(UInt16Type),
        DataType::UInt32 => widened!(UInt32Type),
        DataType::UInt64 => widened!(UInt64Type),
        DataType::Float32 => widened!(Float32Type),
        _ => extend(into, array.as_primitive::<arrow::Float64Type>().iter()),
    }
}
