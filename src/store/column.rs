//! A column of a table: its name, unit and meaning, and how it is read off a row.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::builder::StringDictionaryBuilder;
use arrow_array::types::Int32Type;
use arrow_array::{ArrayRef, BooleanArray, Float64Array, StringArray, UInt64Array};
use arrow_schema::{DataType, Field};

/// How a column is read off a row; `None` where the value does not exist.
pub enum Read<R> {
    /// Text.
    Text(for<'a> fn(&'a R) -> Option<Cow<'a, str>>),
    /// A real number.
    Number(fn(&R) -> Option<f64>),
    /// A count.
    Count(fn(&R) -> Option<u64>),
    /// Yes or no.
    Flag(fn(&R) -> Option<bool>),
}

/// Whether a column is known before the run or comes from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Known before.
    Input,
    /// A result.
    Result,
}

/// How the values of a column repeat, which decides how they are encoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Few different values: a dictionary.
    Repeating,
    /// Few different values where nothing is drawn, else every value its own.
    Drawn,
    /// Every value its own: plain text, split bytes for numbers.
    Distinct,
}

/// One column of a table of rows `R`.
pub struct Column<R> {
    /// Name, with the unit in it where there is one.
    pub name: &'static str,
    /// Unit; empty for none.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// Known before the run, or a result.
    pub stage: Stage,
    /// How its values repeat.
    pub encoding: Encoding,
    /// How it is read off a row.
    pub read: Read<R>,
}

impl<R> Column<R> {
    /// A column of inputs: few different values.
    pub const fn input(name: &'static str, unit: &'static str, meaning: &'static str, read: Read<R>) -> Self {
        Self { name, unit, meaning, stage: Stage::Input, encoding: Encoding::Repeating, read }
    }

    /// A column of numbers that a sweep repeats and a study of drawn façades does not.
    pub const fn drawn(name: &'static str, unit: &'static str, meaning: &'static str, read: Read<R>) -> Self {
        Self { name, unit, meaning, stage: Stage::Input, encoding: Encoding::Drawn, read }
    }

    /// A column of results: continuous numbers, or counts and names, which repeat.
    pub const fn result(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        read: Read<R>,
    ) -> Self {
        let encoding = match read {
            Read::Number(_) => Encoding::Distinct,
            _ => Encoding::Repeating,
        };
        Self { name, unit, meaning, stage: Stage::Result, encoding, read }
    }

    /// The same column, its values all different.
    #[must_use]
    pub const fn distinct(mut self) -> Self {
        self.encoding = Encoding::Distinct;
        self
    }

    /// The Arrow field, unit and meaning in its metadata.
    pub fn field(&self) -> Field {
        let metadata = [("unit", self.unit), ("description", self.meaning)]
            .into_iter()
            .map(|(key, value)| (key.to_owned(), value.to_owned()))
            .collect::<HashMap<_, _>>();
        Field::new(self.name, self.data_type(), true).with_metadata(metadata)
    }

    /// The values of the column over rows, in order.
    pub fn array(&self, rows: &[R]) -> ArrayRef {
        match (&self.read, self.encoding) {
            (Read::Text(read), Encoding::Repeating) => {
                let mut builder = StringDictionaryBuilder::<Int32Type>::new();
                builder.extend(rows.iter().map(read));
                Arc::new(builder.finish())
            }
            (Read::Text(read), _) => Arc::new(rows.iter().map(read).collect::<StringArray>()),
            (Read::Number(read), _) => Arc::new(rows.iter().map(read).collect::<Float64Array>()),
            (Read::Count(read), _) => Arc::new(rows.iter().map(read).collect::<UInt64Array>()),
            (Read::Flag(read), _) => Arc::new(rows.iter().map(read).collect::<BooleanArray>()),
        }
    }

    /// The value in one row as text; empty where it does not exist.
    pub fn text(&self, row: &R) -> String {
        match self.read {
            Read::Text(read) => read(row).map(Cow::into_owned),
            Read::Number(read) => read(row).map(|value| value.to_string()),
            Read::Count(read) => read(row).map(|value| value.to_string()),
            Read::Flag(read) => read(row).map(|value| value.to_string()),
        }
        .unwrap_or_default()
    }

    fn data_type(&self) -> DataType {
        match (&self.read, self.encoding) {
            (Read::Text(_), Encoding::Repeating) => {
                DataType::Dictionary(Box::new(DataType::Int32), Box::new(DataType::Utf8))
            }
            (Read::Text(_), _) => DataType::Utf8,
            (Read::Number(_), _) => DataType::Float64,
            (Read::Count(_), _) => DataType::UInt64,
            (Read::Flag(_), _) => DataType::Boolean,
        }
    }
}

/// Writes columns of rows as CSV with a header.
///
/// # Errors
/// What the stream says.
pub fn print_csv<'c, R: 'c>(
    out: &mut impl std::io::Write,
    columns: impl Iterator<Item = &'c Column<R>> + Clone,
    rows: impl IntoIterator<Item = impl std::borrow::Borrow<R>>,
) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    // The writer wraps what the stream said; a reader that has gone must stay recognisable.
    let unwrapped = |e: csv::Error| match e.into_kind() {
        csv::ErrorKind::Io(e) => e,
        other => std::io::Error::other(format!("{other:?}")),
    };
    csv.write_record(columns.clone().map(|column| column.name)).map_err(unwrapped)?;
    for row in rows {
        csv.write_record(columns.clone().map(|column| column.text(row.borrow()))).map_err(unwrapped)?;
    }
    csv.flush()
}
