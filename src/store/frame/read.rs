//! From Parquet files to a frame: only the columns that are asked for, batch by batch.
//!
//! The values of one column are gathered from arrays of arrow into one of polars.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Frame;
use super::labels::{Labels, is_text};
use arrow_array::cast::AsArray;
use arrow_array::{Array, RecordBatch, types as arrow};
use arrow_schema::{DataType, Field, Schema};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use polars::prelude::{
    BooleanChunkedBuilder, ChunkedBuilder, Column, Float64Type, IntoColumn, PolarsDataType, PolarsError,
    PolarsResult, PrimitiveChunkedBuilder, UInt32Type, UInt64Type, polars_err,
};

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

/// Rows that stand in memory beside the frame.
const ROWS_AT_ONCE: usize = 1 << 16;

/// The columns `names` of Parquet files, the rows of one file after those of another.
///
/// # Errors
/// With the file: one that is no Parquet table or lacks a column, a column that holds neither numbers, truth values
/// nor texts, and files that disagree about what a column holds.
pub(crate) fn read<N: AsRef<str>>(files: &[PathBuf], names: &[N]) -> PolarsResult<Frame> {
    let mut columns = Vec::new();
    for path in files {
        append(path, names, &mut columns).map_err(|e| at(path, e))?;
    }
    Frame::new(columns)
}

/// Names of all columns of a Parquet file, in its order.
///
/// # Errors
/// With the file: one that is no Parquet table.
pub(crate) fn column_names(path: &Path) -> PolarsResult<Vec<String>> {
    let fields = |table: Table| table.schema().fields().iter().map(|field| field.name().clone()).collect();
    open(path).map(fields).map_err(|e| at(path, e))
}

type Table = ParquetRecordBatchReaderBuilder<File>;

fn open(path: &Path) -> PolarsResult<Table> {
    Table::try_new(File::open(path)?).map_err(unreadable)
}

/// Adds the rows of a file; the first file says what the columns hold.
fn append<N: AsRef<str>>(path: &Path, names: &[N], columns: &mut Vec<Values>) -> PolarsResult<()> {
    let table = open(path)?;
    let found: PolarsResult<Vec<_>> = names.iter().map(|name| find(table.schema(), name.as_ref())).collect();
    let found = found?;
    if columns.is_empty() {
        let begun: PolarsResult<Vec<_>> = found.iter().map(|&(_, field)| Values::begin(field)).collect();
        *columns = begun?;
    }
    let mask = ProjectionMask::roots(table.parquet_schema(), found.iter().map(|&(place, _)| place));
    let batches = table.with_projection(mask).with_batch_size(ROWS_AT_ONCE).build().map_err(unreadable)?;
    for batch in batches {
        append_batch(&batch.map_err(unreadable)?, names, columns)?;
    }
    Ok(())
}

fn append_batch<N: AsRef<str>>(batch: &RecordBatch, names: &[N], columns: &mut [Values]) -> PolarsResult<()> {
    for (name, values) in names.iter().zip(columns) {
        let name = name.as_ref();
        values.append(name, batch.column_by_name(name).ok_or_else(|| absent(name))?)?;
    }
    Ok(())
}

/// Where a column stands, and what it holds.
fn find<'s>(schema: &'s Schema, name: &str) -> PolarsResult<(usize, &'s Field)> {
    let (place, field) = schema.column_with_name(name).ok_or_else(|| absent(name))?;
    Ok((place, field))
}

fn absent(name: &str) -> PolarsError {
    polars_err!(ComputeError: "no column {name:?}")
}

fn unreadable(error: impl std::fmt::Display) -> PolarsError {
    polars_err!(ComputeError: "{error}")
}

fn at(path: &Path, error: impl std::fmt::Display) -> PolarsError {
    polars_err!(ComputeError: "{}: {error}", path.display())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::store::frame::testing::write;
    use arrow_array::types::Int32Type;
    use arrow_array::{
        ArrayRef, BooleanArray, Date32Array, DictionaryArray, Float64Array, Int32Array, ListArray,
        StringArray, UInt64Array,
    };

    fn labels(texts: [Option<&str>; 3]) -> ArrayRef {
        Arc::new(texts.into_iter().collect::<DictionaryArray<Int32Type>>())
    }

    /// Three rows; the labels of one file are others, in another order, than those of another.
    fn runs(folder: &Path, name: &str, first_run: u64, outcomes: [Option<&str>; 3]) -> PathBuf {
        let columns: Vec<(&str, ArrayRef)> = vec![
            ("unread", Arc::new(Float64Array::from(vec![0.0; 3]))),
            ("run", Arc::new(UInt64Array::from_iter_values(first_run..first_run + 3))),
            ("outcome", labels(outcomes)),
            ("exceeded", Arc::new(BooleanArray::from(vec![Some(true), None, Some(false)]))),
            ("theta", Arc::new(Float64Array::from(vec![None, Some(0.1), Some(f64::NAN)]))),
        ];
        write(folder, name, columns)
    }

    #[test]
    fn analytic_two_files_with_nulls_labels_flags_and_counts() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = [
            runs(folder.path(), "a.parquet", 3, [Some("stood"), None, Some("failed")]),
            runs(folder.path(), "b.parquet", 0, [Some("collapsed"), Some("stood"), Some("stood")]),
        ];
        let frame = read(&files, &["theta", "run", "exceeded", "outcome"]).expect("readable");
        assert_eq!(frame.height(), 6);
        let runs: Vec<_> = frame.counts("run").expect("counts").iter().collect();
        assert_eq!(runs, [3, 4, 5, 0, 1, 2].map(Some));
        let texts = |name: &str| {
            let texts = frame.texts(name).expect("texts");
            (0..6).map(|row| texts.get(row).map(str::to_owned)).collect::<Vec<_>>()
        };
        let owned = |texts: [Option<&str>; 6]| texts.map(|text| text.map(str::to_owned)).to_vec();
        let outcomes = [Some("stood"), None, Some("failed"), Some("collapsed"), Some("stood"), Some("stood")];
        assert_eq!(texts("outcome"), owned(outcomes));
        let flags = [Some("true"), None, Some("false"), Some("true"), None, Some("false")];
        assert_eq!(texts("exceeded"), owned(flags));
        let theta = frame.numbers("theta").expect("numbers");
        assert_eq!((theta.get(0), theta.get(1)), (None, Some(0.1)));
        assert!(theta.get(2).is_some_and(f64::is_nan), "no null");
        assert!(frame.numbers("unread").is_err(), "only what was asked for");
    }

    #[test]
    fn analytic_groups_filters_and_order_of_rows() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = [
            runs(folder.path(), "a.parquet", 3, [Some("stood"), None, Some("failed")]),
            runs(folder.path(), "b.parquet", 0, [None, Some("stood"), Some("stood")]),
        ];
        let frame = read(&files, &["run", "exceeded", "outcome", "theta"]).expect("readable");
        let groups = |keys: &[&str]| frame.groups(keys).expect("columns").iter().collect::<Vec<_>>();
        assert_eq!(groups(&["outcome"]), [vec![0, 4, 5], vec![1, 3], vec![2]], "nulls are alike");
        assert_eq!(groups(&["outcome", "exceeded"]), [vec![0], vec![1], vec![2], vec![3], vec![4], vec![5]]);
        assert_eq!(
            groups(&["exceeded", "theta"]),
            [vec![0, 3], vec![1, 4], vec![2, 5]],
            "so is what is no number"
        );
        let stood = frame.with_texts(&[("outcome", "stood")]).expect("a column of texts");
        let runs = |frame: &Frame| frame.counts("run").expect("counts").iter().flatten().collect::<Vec<_>>();
        assert_eq!(runs(&stood), [3, 1, 2]);
        assert_eq!(runs(&stood.sorted_by(&["run"]).expect("counts")), [1, 2, 3]);
        assert_eq!(runs(&frame.without_nulls(&["outcome", "theta"]).expect("columns")), [5, 1, 2]);
        assert_eq!(frame.with_texts(&[("outcome", "flew")]).expect("a column of texts").height(), 0);
        let numbers: Vec<_> =
            frame.as_numbers("exceeded").expect("a column").expect("flags").iter().collect();
        assert_eq!(numbers[..3], [Some(1.0), None, Some(0.0)]);
        assert!(frame.as_numbers("outcome").expect("a column").is_none(), "texts");
    }

    #[test]
    fn analytic_other_kinds_are_numbers_and_texts() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let columns: Vec<(&str, ArrayRef)> = vec![
            ("i", Arc::new(Int32Array::from(vec![Some(-1), None]))),
            ("s", Arc::new(StringArray::from(vec![Some("b"), Some("a")]))),
            ("d", Arc::new(Date32Array::from(vec![None, Some(365)]))),
            ("none", Arc::new([None::<&str>, None].into_iter().collect::<DictionaryArray<Int32Type>>())),
        ];
        let path = write(folder.path(), "t.parquet", columns);
        assert_eq!(column_names(&path).expect("readable"), ["i", "s", "d", "none"]);
        let frame = read(&[path], &["d", "i", "s", "none"]).expect("readable");
        assert_eq!(frame.numbers("i").expect("numbers").iter().collect::<Vec<_>>(), [Some(-1.0), None]);
        let texts = |name: &str| [0, 1].map(|row| frame.texts(name).expect("texts").get(row));
        assert_eq!(texts("s"), [Some("b"), Some("a")]);
        assert_eq!(texts("d"), [None, Some("1971-01-01")]);
        assert_eq!(texts("none"), [None, None]);
    }

    #[test]
    fn rejects_what_is_no_table_or_lacks_a_column() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let message = |files: &[PathBuf], names: &[&str]| match read(files, names) {
            Ok(_) => String::new(),
            Err(e) => e.to_string(),
        };
        let lists = ListArray::from_iter_primitive::<Int32Type, _, _>([Some(vec![Some(1)])]);
        let odd = write(folder.path(), "odd.parquet", vec![("lists", Arc::new(lists) as ArrayRef)]);
        assert!(message(std::slice::from_ref(&odd), &["run"]).contains("odd.parquet: no column \"run\""));
        assert!(message(&[odd], &["lists"]).contains("column \"lists\" holds List"));
        let runs = runs(folder.path(), "a.parquet", 0, [None; 3]);
        let texts = write(folder.path(), "b.parquet", vec![("run", labels([Some("1"); 3]))]);
        assert!(message(&[runs, texts], &["run"]).contains("b.parquet: column \"run\" holds Dictionary"));
        let garbage = folder.path().join("c.parquet");
        std::fs::write(&garbage, "garbage").expect("written");
        let refused = message(&[garbage], &["run"]);
        assert!(refused.contains("c.parquet: "), "{refused}");
        assert!(message(&[folder.path().join("d.parquet")], &["run"]).contains("d.parquet"));
    }
}
