//! Sequences: records one after another with rest between, as a pipeline asks for them and as a plan runs them.
//!
//! Of each sequence every part is a row, in the order of the records, and then every part but the first once more by
//! itself, on the wall as it was built. What a later record does after the earlier ones stands beside what it does alone.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{InputError, Result};
use mrbd_records::Suite;

/// A table `[[sequence]]` of a pipeline file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SequenceTable {
    /// Name; absent: the records joined by `-then-`. Pairs have names of their own.
    pub name: Option<String>,
    /// Names of records of the suite, in order.
    pub records: Option<Vec<String>>,
    /// Pairs of records in place of a list.
    pub pairs: Option<Pairs>,
    /// Time from the last sample of a record to the beginning of the next, s.
    pub rest_s: f64,
    /// Factor on each record; absent: 1.
    pub scale: Option<Vec<f64>>,
}

/// Ordered pairs of the records of a suite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pairs {
    /// Each record after each, after itself too.
    All,
    /// Each record after each other.
    Different,
}

/// A sequence of a plan.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sequence {
    /// Name in results, each once.
    pub name: String,
    /// Records in order, at least two.
    pub parts: Vec<Part>,
    /// Free motion after every part but the last, s.
    pub rest_s: f64,
}

/// A record of a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Part {
    /// Position of the record in the suite, from 0.
    pub record_index: usize,
    /// Factor on the record of the suite.
    pub scale: f64,
}

/// Which row of a sequence a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Part, from 0.
    pub part: usize,
    /// Whether the wall is as it was built, though other parts come before; the first part is never said to be so.
    pub alone: bool,
}

impl Sequence {
    /// Rows of one wall: every part, and every part but the first by itself.
    pub fn rows(&self) -> usize {
        2 * self.parts.len() - 1
    }

    /// The place of a row below [`Sequence::rows`].
    pub fn place(&self, row: usize) -> Place {
        match row.checked_sub(self.parts.len()) {
            None => Place { part: row, alone: false },
            Some(later) => Place { part: later + 1, alone: true },
        }
    }

    /// Free motion after a part, s; after the last one as long as after any record of the study.
    pub fn tail_s(&self, part: usize, after_last_s: f64) -> f64 {
        if part + 1 < self.parts.len() { self.rest_s } else { after_last_s }
    }
}

/// Refuses tables that no suite could make sequences of.
pub(super) fn check(path: &Path, tables: &[SequenceTable]) -> Result<()> {
    tables.iter().enumerate().try_for_each(|(index, table)| table.check(path, &format!("sequence[{index}]")))
}

/// The sequences of a suite.
///
/// # Errors
/// Input errors for records that the suite has not, for names twice, and for sequences of different lengths.
pub(super) fn sequences(path: &Path, tables: &[SequenceTable], suite: &Suite) -> Result<Vec<Sequence>> {
    let mut sequences = Vec::new();
    for (index, table) in tables.iter().enumerate() {
        sequences.extend(table.sequences(path, &format!("sequence[{index}]"), suite)?);
    }
    let refuse = |found: String, allowed: &str| {
        Err(InputError::key(path, "sequence", found, allowed.to_owned()).into())
    };
    let mut names = BTreeSet::new();
    if let Some(twice) = sequences.iter().find(|sequence| !names.insert(sequence.name.as_str())) {
        return refuse(format!("two sequences named {:?}", twice.name), "a name for each sequence");
    }
    let length = |sequence: &Sequence| sequence.parts.len();
    match sequences.iter().find(|sequence| length(sequence) != length(&sequences[0])) {
        Some(other) => refuse(
            format!("{:?} of {} records beside one of {}", other.name, length(other), length(&sequences[0])),
            "sequences of as many records in one study",
        ),
        None => Ok(sequences),
    }
}

impl SequenceTable {
    fn check(&self, path: &Path, table: &str) -> Result<()> {
        let refuse = |key: &str, found: String, allowed: &str| {
            Err(InputError::key(path, format!("{table}.{key}"), found, allowed.to_owned()).into())
        };
        let parts = match (&self.records, self.pairs) {
            (Some(records), None) if records.len() >= 2 => records.len(),
            (Some(records), None) => {
                return refuse("records", format!("{records:?}"), "at least two records in order");
            }
            (None, Some(_)) if self.name.is_some() => {
                return refuse("name", format!("{:?}", self.name), "no name for pairs, which have their own");
            }
            (None, Some(_)) => 2,
            _ => return refuse("records", "neither or both".into(), "either `records` or `pairs`"),
        };
        if self.name.as_deref() == Some("") {
            return refuse("name", "an empty name".into(), "a name");
        }
        if !(self.rest_s.is_finite() && self.rest_s >= 0.0) {
            return refuse("rest_s", self.rest_s.to_string(), "a finite number, 0 or more");
        }
        let possible = |scale: &f64| scale.is_finite() && *scale > 0.0;
        match &self.scale {
            Some(scale) if scale.len() != parts || !scale.iter().all(possible) => {
                let allowed = format!("{parts} finite numbers above 0, one a record");
                refuse("scale", format!("{scale:?}"), &allowed)
            }
            _ => Ok(()),
        }
    }

    fn sequences(&self, path: &Path, table: &str, suite: &Suite) -> Result<Vec<Sequence>> {
        let all = 0..suite.records.len();
        let orders: Vec<Vec<usize>> = match (&self.records, self.pairs) {
            (Some(records), _) => vec![self.order(path, table, records, suite)?],
            (None, pairs) => {
                let pair = |first| all.clone().map(move |second| vec![first, second]);
                let itself = pairs == Some(Pairs::All);
                all.clone().flat_map(pair).filter(|pair| itself || pair[0] != pair[1]).collect()
            }
        };
        if orders.is_empty() {
            let found = format!("suite {:?} of one record", suite.name);
            let allowed = "at least two records for pairs of different ones";
            return Err(InputError::key(path, format!("{table}.pairs"), found, allowed).into());
        }
        Ok(orders.into_iter().map(|order| self.sequence(&order, suite)).collect())
    }

    fn order(&self, path: &Path, table: &str, records: &[String], suite: &Suite) -> Result<Vec<usize>> {
        let find = |name: &String| {
            suite.records.iter().position(|record| record.name == *name).ok_or_else(|| {
                let names: Vec<&str> = suite.records.iter().map(|record| record.name.as_str()).collect();
                let allowed = format!("records of suite {:?}: {}", suite.name, names.join(", "));
                InputError::key(path, format!("{table}.records"), format!("{name:?}"), allowed).into()
            })
        };
        records.iter().map(find).collect()
    }

    fn sequence(&self, order: &[usize], suite: &Suite) -> Sequence {
        let names: Vec<&str> = order.iter().map(|&index| suite.records[index].name.as_str()).collect();
        let scale = |part: usize| self.scale.as_ref().map_or(1.0, |scale| scale[part]);
        let part = |(part, &record_index): (usize, &usize)| Part { record_index, scale: scale(part) };
        Sequence {
            name: self.name.clone().unwrap_or_else(|| names.join("-then-")),
            parts: order.iter().enumerate().map(part).collect(),
            rest_s: self.rest_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_rows_are_all_parts_and_then_the_later_ones_alone() {
        let part = Part { record_index: 0, scale: 1.0 };
        let sequence = Sequence { name: "three".into(), parts: vec![part; 3], rest_s: 10.0 };
        let places: Vec<Place> = (0..sequence.rows()).map(|row| sequence.place(row)).collect();
        let place = |part, alone| Place { part, alone };
        let later = [place(1, true), place(2, true)];
        assert_eq!(places, [&[place(0, false), place(1, false), place(2, false)][..], &later].concat());
        assert_eq!([0, 1, 2].map(|part| sequence.tail_s(part, 5.0)), [10.0, 10.0, 5.0]);
    }

    #[test]
    fn rejects_sequences_with_their_key() {
        let refused = |text: &str| {
            let table: SequenceTable = toml::from_str(text).expect("a table");
            check(Path::new("p.toml"), &[table]).expect_err("must be refused").to_string()
        };
        let records = "records = [\"a\", \"b\"]";
        assert!(refused("rest_s = 1").contains("sequence[0].records: found neither or both"));
        assert!(refused(&format!("{records}\npairs = \"all\"\nrest_s = 1")).contains("either `records`"));
        assert!(refused("records = [\"a\"]\nrest_s = 1").contains("at least two"));
        assert!(refused("pairs = \"all\"\nname = \"x\"\nrest_s = 1").contains("sequence[0].name"));
        assert!(refused(&format!("{records}\nrest_s = -1")).contains("sequence[0].rest_s: found -1"));
        assert!(refused(&format!("{records}\nrest_s = nan")).contains("sequence[0].rest_s: found NaN"));
        assert!(refused(&format!("{records}\nrest_s = 1\nscale = [1.0]")).contains("2 finite numbers"));
        assert!(refused(&format!("{records}\nrest_s = 1\nscale = [1.0, 0.0]")).contains("above 0"));
    }
}
