//! Tables as loggers and spreadsheets write them, of which the caller says what stands where.
//!
//! Nothing is guessed: a unit or a decimal comma that is taken for another makes a record that can be, and is wrong.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::channel::Channel;
use super::columns::uniform_step;
use super::source::{Source, is_blank_or_comment, number, quote};
use super::{Format, ReadOptions};
use mrbd_files::error::InputError;

/// Read where columns are chosen, whatever the content.
pub(super) static FORMAT: Format = Format {
    name: "chosen columns",
    words: "a table of which the columns are chosen",
    recognise: |_| false,
    parse,
};

/// How to say what stands where in a table.
pub(super) const HOW: &str = "of another table say which columns hold time and acceleration, and in which unit: \
     `--columns 1,2 --unit g`, with `--decimal-comma` where its numbers have one; in a suite the keys `columns`, `unit` \
     and `decimal_comma`";

/// Which columns of a table hold the time and the acceleration: numbers from 1, or names of the header.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ColumnChoice {
    /// `None`: the step is known otherwise.
    time: Option<String>,
    acceleration: String,
}

/// Words that choose no columns.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("columns `{0}`, expected \"1,2\", \"Time,Acc\" or, where the step is given, \"2\" alone")]
pub struct NoColumns(String);

impl FromStr for ColumnChoice {
    type Err = NoColumns;

    fn from_str(text: &str) -> Result<Self, NoColumns> {
        let names: Vec<&str> = text.split(',').map(str::trim).collect();
        let (time, acceleration) = match names[..] {
            [acceleration] => (None, acceleration),
            [time, acceleration] if time != acceleration => (Some(time), acceleration),
            _ => return Err(NoColumns(text.to_owned())),
        };
        let is_name = |name: &str| !name.is_empty() && name.parse::<usize>() != Ok(0);
        if !is_name(acceleration) || !time.is_none_or(is_name) {
            return Err(NoColumns(text.to_owned()));
        }
        Ok(Self { time: time.map(str::to_owned), acceleration: acceleration.to_owned() })
    }
}

impl TryFrom<String> for ColumnChoice {
    type Error = NoColumns;

    fn try_from(text: String) -> Result<Self, NoColumns> {
        text.parse()
    }
}

impl From<ColumnChoice> for String {
    fn from(choice: ColumnChoice) -> Self {
        choice.to_string()
    }
}

impl fmt::Display for ColumnChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.time {
            Some(time) => write!(f, "{time},{}", self.acceleration),
            None => f.write_str(&self.acceleration),
        }
    }
}

/// What stands between the fields of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Separator {
    Character(char),
    Blanks,
}

impl Separator {
    /// That of a line; a comma only where it is not the decimal one.
    fn of(line: &str, decimal_comma: bool) -> Self {
        let characters = if decimal_comma { &[';', '\t'][..] } else { &[';', '\t', ','][..] };
        let found = characters.iter().find(|character| line.trim().contains(**character));
        found.map_or(Self::Blanks, |character| Self::Character(*character))
    }

    /// The fields of a line, without quotes and blanks around them.
    fn fields(self, line: &str) -> Vec<&str> {
        match self {
            Self::Character(character) => {
                line.split(character).map(|field| field.trim().trim_matches('"').trim()).collect()
            }
            Self::Blanks => line.split_whitespace().map(|field| field.trim_matches('"')).collect(),
        }
    }
}

/// Whether the first two lines of a file look like those of a table: two fields or more, numbers on the second line.
pub(super) fn is_table(source: &Source) -> bool {
    let mut lines = source.lines.iter().filter(|line| !is_blank_or_comment(line)).take(2);
    let (Some(first), Some(second)) = (lines.next(), lines.next()) else { return false };
    let numbers = |line: &str| {
        let fields = Separator::of(line, false).fields(line);
        fields.len() > 1 && fields.iter().all(|field| decimal(field, true).is_some())
    };
    numbers(second) && (numbers(first) || Separator::of(first, false).fields(first).len() > 1)
}

/// A number of a field, with a comma as its decimal sign where that is allowed.
fn decimal(field: &str, decimal_comma: bool) -> Option<f64> {
    if decimal_comma { number(&field.replacen(',', ".", 1)) } else { number(field) }
}

fn parse(source: &Source, options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let (Some(choice), Some(unit)) = (&options.columns, options.unit) else {
        let allowed = "their unit too: `--unit`, or `unit` in the suite: m/s2, g, cm/s2, gal or mm/s2";
        return Err(source.fault_file("columns chosen, and no unit of the samples", allowed));
    };
    let table = Table::new(source, choice, options.decimal_comma)?;
    let mut lines = Vec::new();
    let mut times = Vec::new();
    let mut samples = Vec::new();
    for (index, line) in table.rows() {
        lines.push(index);
        samples.push(table.number(index, line, table.acceleration)?);
        if let Some(column) = table.time {
            times.push(table.number(index, line, column)?);
        }
    }
    let step_s = match (table.time, options.step_s) {
        (Some(_), _) => uniform_step(source, &lines, &times)?,
        (None, Some(step_s)) => step_s,
        (None, None) => {
            let allowed = "a step in seconds: `--dt`, or `step_s` in the suite; or a column of times too";
            return Err(source.fault_file("one column chosen and no step", allowed));
        }
    };
    Ok(vec![Channel { label: String::new(), step_s, unit: Some(unit), samples }])
}

/// A table, and where its columns are.
struct Table<'a> {
    source: &'a Source<'a>,
    separator: Separator,
    decimal_comma: bool,
    /// Lines before the first row: the header's, or none.
    skipped: usize,
    time: Option<usize>,
    acceleration: usize,
}

impl<'a> Table<'a> {
    fn new(source: &'a Source<'a>, choice: &ColumnChoice, decimal_comma: bool) -> Result<Self, InputError> {
        let first = source.first.unwrap_or(0);
        let separator = Separator::of(source.line(first), decimal_comma);
        let header = separator.fields(source.line(first));
        let place = |name: &String| {
            let number = name.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
            let named = || header.iter().position(|column| column.eq_ignore_ascii_case(name));
            let place = named().or(number).filter(|place| *place < header.len());
            place.ok_or_else(|| {
                let allowed = format!("one of its {} columns: {}", header.len(), header.join(" | "));
                source.fault(first, format!("no column {}", quote(name)), allowed)
            })
        };
        let time = choice.time.as_ref().map(place).transpose()?;
        let acceleration = place(&choice.acceleration)?;
        // A header names the columns; without one the first line is a row.
        let is_header = decimal(header[acceleration], true).is_none();
        let skipped = first + usize::from(is_header);
        Ok(Self { source, separator, decimal_comma, skipped, time, acceleration })
    }

    /// The lines that hold rows, with their indices.
    fn rows(&self) -> impl Iterator<Item = (usize, &'a str)> {
        let lines = self.source.lines.iter().copied().enumerate().skip(self.skipped);
        lines.filter(|(_, line)| !is_blank_or_comment(line))
    }

    fn number(&self, index: usize, line: &str, column: usize) -> Result<f64, InputError> {
        let fields = self.separator.fields(line);
        let Some(field) = fields.get(column) else {
            let found = format!("{} columns", fields.len());
            return Err(self.source.fault(index, found, format!("a number in column {}", column + 1)));
        };
        decimal(field, self.decimal_comma).ok_or_else(|| {
            let comma = !self.decimal_comma && decimal(field, true).is_some();
            let how = if comma {
                "; a decimal comma is read with `--decimal-comma`, in a suite `decimal_comma`"
            } else {
                ""
            };
            let allowed = format!("a finite number in column {}{how}", column + 1);
            self.source.fault(index, quote(field), allowed)
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{Record, Unit, read_bytes};

    fn options(columns: &str, decimal_comma: bool) -> ReadOptions {
        let columns = Some(columns.parse().expect("columns"));
        ReadOptions { columns, decimal_comma, unit: Some(Unit::G), ..ReadOptions::default() }
    }

    fn read(text: &str, options: &ReadOptions) -> Result<Record, InputError> {
        read_bytes(Path::new("mine.csv"), text.as_bytes(), options)
    }

    fn refused(text: &str, options: &ReadOptions) -> String {
        read(text, options).expect_err("must be refused").to_string()
    }

    #[test]
    fn analytic_the_same_record_is_read_from_every_kind_of_table() {
        let [point, comma] = [false, true];
        for (text, columns, decimal_comma) in [
            ("0.00,0.1\n0.01,-0.2\n0.02,0.05\n", "1,2", point),
            ("0.00 0.1\n0.01 -0.2\n0.02 0.05\n", "1,2", point),
            ("Time;Acc\n0,00;0,1\n0,01;-0,2\n0,02;0,05\n", "Time,Acc", comma),
            ("\"Time (s)\";\"Acc\"\r\n0,00;0,1\r\n0,01;-0,2\r\n0,02;0,05\r\n", "1,acc", comma),
            ("0,00\t0,1\n0,01\t-0,2\n0,02\t0,05\n", "1,2", comma),
            ("n,up,t,east\n1,9,0.00,0.1\n2,9,0.01,-0.2\n3,9,0.02,0.05\n", "t,east", point),
        ] {
            let record =
                read(text, &options(columns, decimal_comma)).unwrap_or_else(|e| panic!("{e}: {text}"));
            assert_eq!(
                (record.accelerogram.step_s(), record.unit, record.format.name),
                (0.01, Unit::G, "chosen columns")
            );
            let g: Vec<f64> =
                record.accelerogram.acceleration_m_s2().iter().map(|a| a / Unit::G.m_s2()).collect();
            // A product with g and its inverse: two roundings.
            assert!(
                g.iter().zip([0.1, -0.2, 0.05]).all(|(g, a)| (g - a).abs() < 1e-15) && g.len() == 3,
                "{g:?}"
            );
        }
        let alone = ReadOptions { step_s: Some(0.01), ..options("1", true) };
        let record = read("0,1\n-0,2\n", &alone).expect("a column with a step");
        assert_eq!(record.accelerogram.acceleration_m_s2().len(), 2);
    }

    #[test]
    fn rejects_tables_with_the_cause_and_the_option() {
        let default = ReadOptions::default();
        for text in ["0.00,0.1\n0.01,-0.2\n", "Time;Acc\n0,00;0,1\n0,01;-0,2\n", "0,1\n0,2\n"] {
            let message = refused(text, &default);
            assert!(
                message.contains("--columns 1,2 --unit g") && message.contains("--decimal-comma"),
                "{message}"
            );
        }
        let comma = refused("Time;Acc\n0,00;0,1\n0,01;-0,2\n", &options("1,2", false));
        assert!(
            comma.starts_with("mine.csv:2: found `0,1`") && comma.contains("`--decimal-comma`"),
            "{comma}"
        );
        let unit = refused("0.00,0.1\n0.01,-0.2\n", &ReadOptions { unit: None, ..options("1,2", false) });
        assert!(unit.contains("no unit of the samples") && unit.contains("`--unit`"), "{unit}");
        let name = refused("Time;Acc\n0;1\n", &options("Time,East", false));
        assert!(name.contains("no column `East`") && name.contains("Time | Acc"), "{name}");
        let step = refused("0.1\n-0.2\n", &options("1", false));
        assert!(step.contains("no step") && step.contains("`--dt`"), "{step}");
        for words in ["", "1,1", "0,1", "1,2,3", "a,"] {
            assert!(words.parse::<ColumnChoice>().is_err(), "{words}");
        }
    }

    #[test]
    fn rejects_steps_that_cannot_be() {
        for step_s in [-1.0, 0.0, f64::NAN] {
            let message =
                refused("0.1\n0.2\n", &ReadOptions { step_s: Some(step_s), ..ReadOptions::default() });
            let whole = format!("mine.csv: found a step of {step_s} s given for it; allowed: 1e-6 to 10 s");
            assert_eq!(message, whole);
        }
    }
}
