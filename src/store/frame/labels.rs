//! Texts as numbers: each text that occurs in a column has one, in the order in which they are met.

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{
    ArrowTemporalType, Date32Type, TimestampMicrosecondType, TimestampMillisecondType,
    TimestampNanosecondType, TimestampSecondType,
};
use arrow_array::{Array, PrimitiveArray};
use arrow_schema::{DataType, TimeUnit};

/// The number that stands for no label.
pub(super) const NO_LABEL: u32 = u32::MAX;

/// The texts of a column.
#[derive(Default)]
pub(super) struct Labels {
    texts: Vec<Arc<str>>,
    numbers: HashMap<Arc<str>, u32>,
}

/// Whether an array of this kind is read as texts: texts, dates and times, and nulls alone.
pub(super) fn is_text(kind: &DataType) -> bool {
    match kind {
        DataType::Dictionary(_, value) => is_text(value),
        DataType::Date32 | DataType::Timestamp(..) | DataType::Null => true,
        kind => kind.is_string(),
    }
}

impl Labels {
    /// The texts, each at its number.
    pub fn into_texts(self) -> Arc<[Arc<str>]> {
        self.texts.into()
    }

    /// The number of the text in each row of an array whose kind [`is_text`]; none for a null.
    pub fn numbers(&mut self, array: &dyn Array) -> Vec<Option<u32>> {
        let Some(dictionary) = array.as_any_dictionary_opt() else {
            return self.of_plain(array);
        };
        let known = self.of_plain(dictionary.values());
        if known.is_empty() {
            return vec![None; array.len()];
        }
        let keys = dictionary.normalized_keys().into_iter().enumerate();
        keys.map(|(row, key)| if dictionary.is_valid(row) { known[key] } else { None }).collect()
    }

    fn of_plain(&mut self, array: &dyn Array) -> Vec<Option<u32>> {
        match array.data_type() {
            DataType::Utf8 => self.of_texts(array.as_string::<i32>().iter()),
            DataType::LargeUtf8 => self.of_texts(array.as_string::<i64>().iter()),
            DataType::Utf8View => self.of_texts(array.as_string_view().iter()),
            DataType::Date32 => self.of_texts(dates(array.as_primitive())),
            DataType::Timestamp(unit, _) => match unit {
                TimeUnit::Second => self.of_texts(times::<TimestampSecondType>(array.as_primitive())),
                TimeUnit::Millisecond => {
                    self.of_texts(times::<TimestampMillisecondType>(array.as_primitive()))
                }
                TimeUnit::Microsecond => {
                    self.of_texts(times::<TimestampMicrosecondType>(array.as_primitive()))
                }
                TimeUnit::Nanosecond => self.of_texts(times::<TimestampNanosecondType>(array.as_primitive())),
            },
            _ => vec![None; array.len()],
        }
    }

    fn of_texts<T: AsRef<str>>(&mut self, texts: impl Iterator<Item = Option<T>>) -> Vec<Option<u32>> {
        texts.map(|text| text.map(|text| self.number(text.as_ref()))).collect()
    }

    fn number(&mut self, text: &str) -> u32 {
        if let Some(&number) = self.numbers.get(text) {
            return number;
        }
        // polars counts rows with 32 bits, so there are never more labels than numbers.
        let number = self.texts.len() as u32;
        let text: Arc<str> = text.into();
        self.texts.push(Arc::clone(&text));
        self.numbers.insert(text, number);
        number
    }
}

fn dates(array: &PrimitiveArray<Date32Type>) -> impl Iterator<Item = Option<String>> + '_ {
    (0..array.len())
        .map(|row| array.is_valid(row).then(|| array.value_as_date(row))?.map(|date| date.to_string()))
}

/// In universal time where the column has a zone.
fn times<T: ArrowTemporalType>(array: &PrimitiveArray<T>) -> impl Iterator<Item = Option<String>> + '_
where
    i64: From<T::Native>,
{
    (0..array.len())
        .map(|row| array.is_valid(row).then(|| array.value_as_datetime(row))?.map(|time| time.to_string()))
}
