//! From a table to samples: which column is what, one sample a group, no row lost without a word.

use std::collections::HashMap;
use std::path::Path;

use super::expression::Expression;
use super::sample::{Clusters, Observation, Sample};
use super::table::Table;
use crate::error::{InputError, Result};

/// Which column is what.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// The intensity.
    pub intensity: Expression,
    /// Of incremental analyses, the highest intensity below that was stood, in the unit of the intensity: the capacity
    /// is then the geometric middle of the two, for the search halves the logarithm of their bracket.
    pub stood: Option<String>,
    /// Outcomes, numbers of failures, or numbers to compare.
    pub outcome: Outcomes,
    /// Demands of the runs that stood.
    pub demand: Option<String>,
    /// Columns whose values part the table into samples.
    pub groups: Vec<String>,
    /// Columns whose values are clusters.
    pub clusters: Vec<String>,
}

/// How a column tells failures.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcomes {
    /// 0 or 1, true or false, stood or collapsed; empty, or `failed` for a run that could not be finished: no outcome.
    Words(String),
    /// A number above the limit is a failure; empty: no outcome.
    Above(String, f64),
    /// A number of failures, and the column with the number of trials.
    Counts(String, String),
}

/// The sample of one group.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Values of the group columns.
    pub key: Vec<String>,
    /// Its observations.
    pub sample: Sample,
    /// Rows without an outcome; they are not observations.
    pub without_outcome: usize,
}

/// Words that tell an outcome, for messages.
const WORDS: &str =
    "0 or 1, false or true, stood or collapsed; empty or `failed` for a run without an outcome";

/// Reads a table and parts it into groups, in order of appearance.
///
/// # Errors
/// Input errors of the table; a row with a missing intensity or label, a word that is no outcome, impossible counts.
pub fn read_groups(path: &Path, columns: &Columns) -> Result<Vec<Group>> {
    let table = Table::read(path, &columns.names())?;
    let rows = Rows::new(&table, columns)?;
    let mut places: HashMap<Vec<&str>, usize> = HashMap::new();
    let mut groups: Vec<(Group, Vec<usize>)> = Vec::new();
    for row in 0..table.rows() {
        let key: Vec<&str> = rows.groups.iter().map(|labels| labels[row].as_str()).collect();
        let place = *places.entry(key).or_insert_with_key(|key| {
            let key = key.iter().map(|&label| label.to_owned()).collect();
            groups.push((Group { key, sample: Sample::default(), without_outcome: 0 }, Vec::new()));
            groups.len() - 1
        });
        let (group, kept) = &mut groups[place];
        match rows.observation(row)? {
            Some(observation) => {
                group.sample.push(observation).map_err(|e| rows.impossible(row, &e.to_string()))?;
                kept.push(row);
            }
            None => group.without_outcome += 1,
        }
    }
    Ok(groups.into_iter().map(|(group, kept)| rows.with_clusters(group, &kept)).collect())
}

impl Columns {
    fn names(&self) -> Vec<&str> {
        let outcome = match &self.outcome {
            Outcomes::Words(name) | Outcomes::Above(name, _) => vec![name.as_str()],
            Outcomes::Counts(failures, trials) => vec![failures.as_str(), trials.as_str()],
        };
        let others = self
            .stood
            .iter()
            .chain(&self.demand)
            .chain(&self.groups)
            .chain(&self.clusters)
            .map(String::as_str);
        self.intensity.columns().chain(outcome).chain(others).collect()
    }
}

/// The columns of a table in their roles.
struct Rows<'a> {
    table: &'a Table,
    columns: &'a Columns,
    factors: Vec<Vec<Option<f64>>>,
    stood: Option<Vec<Option<f64>>>,
    tell: Tell,
    demand: Option<Vec<Option<f64>>>,
    groups: Vec<Vec<String>>,
    clusters: Vec<Vec<String>>,
}

/// Cells of the outcome.
enum Tell {
    Words(Vec<String>),
    Numbers(Vec<Option<f64>>, f64),
    Counts(Vec<Option<f64>>, Vec<Option<f64>>),
}

impl<'a> Rows<'a> {
    fn new(table: &'a Table, columns: &'a Columns) -> Result<Self> {
        let tell = match &columns.outcome {
            Outcomes::Words(name) => Tell::Words(table.labels(name)?),
            Outcomes::Above(name, limit) => Tell::Numbers(table.numbers(name)?, *limit),
            Outcomes::Counts(failures, trials) => {
                Tell::Counts(table.numbers(failures)?, table.numbers(trials)?)
            }
        };
        Ok(Self {
            table,
            columns,
            factors: columns.intensity.columns().map(|name| table.numbers(name)).collect::<Result<_>>()?,
            stood: columns.stood.as_ref().map(|name| table.numbers(name)).transpose()?,
            tell,
            demand: columns.demand.as_ref().map(|name| table.numbers(name)).transpose()?,
            groups: labels(table, &columns.groups)?,
            clusters: labels(table, &columns.clusters)?,
        })
    }

    /// The observation of a row; none without an outcome.
    fn observation(&self, row: usize) -> Result<Option<Observation>> {
        let Some((failures, trials)) = self.outcome(row)? else { return Ok(None) };
        let intensity = self.intensity(row)?;
        // The demand of a collapsed run is whatever it had reached: no demand.
        let demand = match &self.demand {
            Some(demands) if failures == 0 => Some(self.demand(demands, row)?),
            _ => None,
        };
        Ok(Some(Observation { intensity, failures, trials, demand }))
    }

    fn intensity(&self, row: usize) -> Result<f64> {
        let value = |name: &str, cells: &[Option<f64>]| {
            cells[row].ok_or_else(|| self.table.fault(name, row, "no value", "an intensity in every row"))
        };
        let names = self.columns.intensity.columns();
        let values = names.zip(&self.factors).map(|(name, cells)| value(name, cells));
        let values: Vec<f64> = values.collect::<Result<_, _>>()?;
        let intensity = self.columns.intensity.value(values);
        Ok(match self.columns.stood.as_ref().zip(self.stood.as_ref()) {
            Some((name, cells)) => (intensity * value(name, cells)?).sqrt(),
            None => intensity,
        })
    }

    fn demand(&self, demands: &[Option<f64>], row: usize) -> Result<f64> {
        let name = self.columns.demand.as_deref().unwrap_or_default();
        let allowed =
            "a demand above 0 in every row that did not collapse; for walls that never moved, fit outcomes";
        let fault = |found: String| self.table.fault(name, row, found, allowed);
        let value = demands[row].ok_or_else(|| fault("no value".into()))?;
        if value > 0.0 { Ok(value) } else { Err(fault(value.to_string()).into()) }
    }

    /// Failures and trials of a row; none without an outcome.
    fn outcome(&self, row: usize) -> Result<Option<(u32, u32)>> {
        match &self.tell {
            Tell::Words(words) => Ok(self.word(&words[row], row)?.map(|failed| (u32::from(failed), 1))),
            Tell::Numbers(values, limit) => Ok(values[row].map(|value| (u32::from(value > *limit), 1))),
            Tell::Counts(failures, trials) => match (failures[row], trials[row]) {
                (None, None) => Ok(None),
                (k, n) => Ok(Some((self.count(k, row)?, self.count(n, row)?))),
            },
        }
    }

    fn word(&self, word: &str, row: usize) -> Result<Option<bool>> {
        match word {
            "1" | "1.0" | "true" | "collapsed" => Ok(Some(true)),
            "0" | "0.0" | "false" | "stood" => Ok(Some(false)),
            "" | "failed" => Ok(None),
            other => Err(self.outcome_fault(row, format!("{other:?}"), WORDS).into()),
        }
    }

    fn count(&self, count: Option<f64>, row: usize) -> Result<u32> {
        match count {
            Some(n) if n >= 0.0 && n.fract() == 0.0 && n <= f64::from(u32::MAX) => Ok(n as u32),
            other => {
                let found = other.map_or("no value".to_owned(), |n| n.to_string());
                Err(self.outcome_fault(row, found, "whole numbers of failures and of trials").into())
            }
        }
    }

    fn outcome_fault(&self, row: usize, found: String, allowed: &str) -> InputError {
        let (Outcomes::Words(name) | Outcomes::Above(name, _) | Outcomes::Counts(name, _)) =
            &self.columns.outcome;
        self.table.fault(name, row, found, allowed)
    }

    /// A fault that the sample found: worded "found; allowed: …".
    fn impossible(&self, row: usize, message: &str) -> InputError {
        let (found, allowed) = message.split_once("; allowed: ").unwrap_or((message, ""));
        let name = self.columns.intensity.columns().next().unwrap_or_default();
        self.table.fault(name, row, found, allowed)
    }

    fn with_clusters(&self, group: Group, kept: &[usize]) -> Group {
        let Group { key, mut sample, without_outcome } = group;
        for (name, labels) in self.columns.clusters.iter().zip(&self.clusters) {
            let of = kept.iter().map(|&row| labels[row].as_str());
            sample = sample.with_clusters(Clusters::new(name, of));
        }
        Group { key, sample, without_outcome }
    }
}

/// Labels of columns, every row with one.
fn labels(table: &Table, names: &[String]) -> Result<Vec<Vec<String>>> {
    let column = |name: &String| {
        let labels = table.labels(name)?;
        match labels.iter().position(String::is_empty) {
            Some(row) => Err(table.fault(name, row, "no value", "a label in every row").into()),
            None => Ok(labels),
        }
    };
    names.iter().map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(outcome: Outcomes) -> Columns {
        let intensity = Expression::parse("2*x").expect("valid");
        let (groups, clusters) = (vec!["g".into()], vec!["r".into()]);
        Columns { intensity, stood: None, outcome, demand: None, groups, clusters }
    }

    fn read(text: &str, columns: &Columns) -> Result<Vec<Group>> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("t.csv");
        std::fs::write(&path, text).expect("written");
        read_groups(&path, columns)
    }

    #[test]
    fn analytic_groups_keep_their_order_and_count_what_has_no_outcome() {
        let text = "g,r,x,y\nb,1,1,1\na,1,2,stood\nb,2,1,failed\nb,2,3,false\nb,1,4,\nb,3,4,0\n";
        let groups = read(text, &columns(Outcomes::Words("y".into()))).expect("valid");
        assert_eq!((groups[0].key.join(""), groups[1].key.join("")), ("b".into(), "a".into()));
        assert_eq!((groups[0].without_outcome, groups[0].sample.len()), (2, 3));
        assert_eq!(groups[0].sample.clusters()[0].of, [0, 1, 2]);
        assert_eq!(groups[0].sample.ln_intensity()[1], 6f64.ln());
        let above = read("g,r,x,y\na,1,1,0.5\na,1,2,0.6\n", &columns(Outcomes::Above("y".into(), 0.5)));
        assert_eq!(above.expect("valid")[0].sample.failures(), [0.0, 1.0]);
    }

    #[test]
    fn analytic_a_capacity_is_the_geometric_middle_of_its_bracket() {
        let intensity = Expression::parse("x").expect("valid");
        let columns = Columns { intensity, stood: Some("s".into()), ..columns(Outcomes::Words("y".into())) };
        // The third stood the highest intensity that was run, the fourth was never finished.
        let text = "g,r,x,y,s\na,1,1.02,1,1\na,2,9,1,4\na,3,10,0,10\na,4,,failed,\n";
        let groups = read(text, &columns).expect("valid");
        assert_eq!(groups[0].sample.ln_intensity(), [1.02f64.sqrt(), 6.0, 10.0].map(f64::ln));
        let refused = read("g,r,x,y,s\na,1,1,1,\n", &columns).expect_err("refused").to_string();
        assert!(refused.contains("t.csv:2: found s: no value"), "{refused}");
    }

    #[test]
    fn rejects_rows_that_are_no_observations_with_their_line() {
        let refused = |text: &str, outcome: Outcomes| {
            read(text, &columns(outcome)).expect_err("must be refused").to_string()
        };
        let words = || Outcomes::Words("y".into());
        assert!(refused("g,r,x,y\na,1,1,0\na,1,2,yes\n", words()).contains("t.csv:3: found y: \"yes\""));
        assert!(refused("g,r,x,y\na,1,,0\n", words()).contains("t.csv:2: found x: no value"));
        assert!(refused("g,r,x,y\na,1,0,0\n", words()).contains("t.csv:2: found x: intensity 0"));
        assert!(refused("g,r,x,y\na,,1,0\n", words()).contains("t.csv:2: found r: no value"));
        let counts = || Outcomes::Counts("y".into(), "n".into());
        assert!(refused("g,r,x,y,n\na,1,1,3,2\n", counts()).contains("3 failures in 2 trials"));
        assert!(refused("g,r,x,y,n\na,1,1,0.5,2\n", counts()).contains("found y: 0.5"));
    }
}
