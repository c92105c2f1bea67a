//! Sweeps under several suites of records side by side: what each says of the conclusions, and how many records it takes.

mod table;

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::aggregate::{Draws, FEWEST_RECORDS, Medians, aggregate};
use crate::error::{InputError, Result};
use crate::findings::{Conclusion, FINDINGS, Slender, Sureness, Verdict, View, conclusions, sureness};
use crate::study::pipeline::Kind;
use crate::study::runs::Manifest;
use crate::survey::Configuration;

pub use table::{print_table, short, title, write_csv};

/// What a manifest says such results are.
pub const KIND: &str = "suites";

/// What is written beside the page.
pub const FILES: [&str; 3] = ["manifest.json", "suites.json", "suites.csv"];

/// Each number of records over the one before, where the share of the draws is told for growing numbers.
const GROWTH: f64 = std::f64::consts::SQRT_2;

/// Sweeps side by side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Suites {
    /// One a suite, in the order they were given.
    pub suites: Vec<OfSuite>,
}

/// What a sweep under one suite says, under its first variant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OfSuite {
    /// Name of the suite.
    pub suite: String,
    /// Whether it is generated rather than measured.
    pub generated: bool,
    /// Its records.
    pub records: usize,
    /// How many answer for a run, itself among them.
    pub members: usize,
    /// The variant.
    pub variant: String,
    /// Runs of that variant as they are planned.
    pub runs: u64,
    /// Of these, those that collapsed.
    pub collapsed: u64,
    /// SHA-256 of the plan.
    pub plan_sha256: String,
    /// One for each conclusion of the source, in their order.
    pub conclusions: Vec<Told>,
    /// Quartiles over the records of the reference façades.
    pub reference: Vec<Quartiles>,
}

/// A conclusion under a suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// Its name.
    pub name: String,
    /// `holds`, `does not`, `undecided` or `not in this study`.
    pub verdict: String,
    /// The numbers of the medians at hand in a few words.
    pub at_hand: String,
    /// Share of the draws in which it holds; `None` of too few records.
    pub holds_share: Option<f64>,
    /// Share in which it does not.
    pub does_not_share: Option<f64>,
    /// The same for draws of growing numbers of records, up to all.
    pub by_records: Vec<ByRecords>,
    /// The fewest records from which it is decided as it is with all; `None` where all leave it undecided.
    pub decided_from: Option<usize>,
}

/// Shares of draws of so many records.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ByRecords {
    /// Records in a draw.
    pub records: usize,
    /// Share in which the conclusion holds.
    pub holds_share: f64,
    /// Share in which it does not.
    pub does_not_share: f64,
}

/// Quartiles over the records of a reference façade, all parameters at their means; `None` where they are collapses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Quartiles {
    /// How the floor runs.
    pub configuration: Configuration,
    /// Column of the run files.
    pub measure: String,
    /// h_tot / b.
    pub slenderness: f64,
    /// 25 % quantile.
    pub q25: Option<f64>,
    /// Median.
    pub median: Option<f64>,
    /// 75 % quantile.
    pub q75: Option<f64>,
}

/// Numbers of records that are drawn: from the fewest that tell to all, each √2 times the one before.
pub fn records_drawn(all: usize) -> Vec<usize> {
    let mut numbers = Vec::new();
    let mut next = FEWEST_RECORDS as f64;
    while (next.round() as usize) < all {
        numbers.push(next.round() as usize);
        next *= GROWTH;
    }
    if all >= FEWEST_RECORDS {
        numbers.push(all);
    }
    numbers
}

/// Reads the sweep in a folder; `step` is called after each number of records.
///
/// # Errors
/// An input error for a folder without a whole sweep; [`crate::Error::Table`] for files that cannot be read.
pub fn of_folder(folder: &Path, step: impl Fn()) -> Result<OfSuite> {
    let path = folder.join("manifest.json");
    let manifest =
        Manifest::read(&path)?.filter(|manifest| manifest.kind == Kind::Sweep).ok_or_else(|| {
            InputError::file(&path, "no manifest of a sweep", "the folder of a sweep by `mrbd run`")
        })?;
    let medians = aggregate(folder)?;
    if let Some(note) = medians.completeness.and_then(|study| study.note()) {
        let allowed = "a whole sweep: `mrbd run … --resume` does the rest";
        return Err(InputError::file(folder, note, allowed).into());
    }
    let under = conclusions(&medians)
        .into_iter()
        .next()
        .ok_or_else(|| InputError::file(folder, "no variant", "the folder of a sweep by `mrbd run`"))?;
    let base = &medians.variants[0];
    let draws = medians.draws.first().filter(|draws| draws.tell());
    let by_records = draws.map_or_else(Vec::new, |draws| by_records(draws, &under.all, step));
    Ok(OfSuite {
        suite: manifest.suite.name.clone(),
        generated: manifest.suite.generated,
        records: manifest.suite.records.len(),
        members: medians.draws.first().map_or(1, |draws| draws.members),
        variant: base.name.clone(),
        runs: base.runs,
        collapsed: base.collapsed,
        plan_sha256: manifest.plan_sha256,
        conclusions: (0..FINDINGS.len()).map(|i| told(i, &under.all[i], &by_records)).collect(),
        reference: reference(&medians, &base.name),
    })
}

/// How sure each conclusion is, by the number of records in a draw; that of all is known already.
fn by_records(draws: &Draws, all: &[Conclusion], step: impl Fn()) -> Vec<Vec<Sureness>> {
    let of = |records| {
        let sure = match records == draws.records {
            // Of what the study does not vary no draw tells, and none is asked for.
            true => all.iter().map(|c| c.sureness.unwrap_or(Sureness::NONE)).collect(),
            false => sureness(draws, records),
        };
        step();
        sure
    };
    records_drawn(draws.records).into_iter().map(of).collect()
}

fn told(index: usize, conclusion: &Conclusion, by_records: &[Vec<Sureness>]) -> Told {
    let asked = conclusion.sureness.is_some();
    let by_records: Vec<Sureness> = by_records.iter().filter(|_| asked).map(|all| all[index]).collect();
    Told {
        name: FINDINGS[index].name.to_owned(),
        verdict: conclusion.verdict().name().to_owned(),
        at_hand: conclusion.answer.short.clone(),
        holds_share: conclusion.sureness.map(|sure| sure.holds),
        does_not_share: conclusion.sureness.map(|sure| sure.does_not),
        decided_from: decided_from(&by_records),
        by_records: by_records
            .into_iter()
            .map(|sure| ByRecords {
                records: sure.records,
                holds_share: sure.holds,
                does_not_share: sure.does_not,
            })
            .collect(),
    }
}

/// The fewest records from which on every number decides as all of them do.
fn decided_from(by_records: &[Sureness]) -> Option<usize> {
    let verdict = by_records.last()?.verdict();
    let alike = by_records.iter().rev().take_while(|sure| sure.verdict() == verdict);
    alike.last().filter(|_| verdict != Verdict::Undecided).map(|sure| sure.records)
}

fn reference(medians: &Medians, variant: &str) -> Vec<Quartiles> {
    let view = View::new(medians, variant);
    let points = view.points(Slender::Any);
    let quartiles = |configuration| {
        let view = &view;
        points.iter().filter_map(move |&point| {
            let row = view.reference(configuration, point)?;
            Some(Quartiles {
                configuration,
                measure: row.measure.column().to_owned(),
                slenderness: row.case.slenderness,
                q25: row.quantiles[2],
                median: row.quantiles[3],
                q75: row.quantiles[4],
            })
        })
    };
    Configuration::ALL.into_iter().flat_map(quartiles).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sure(records: usize, holds: f64, does_not: f64) -> Sureness {
        Sureness { holds, does_not, records, members: 1 }
    }

    #[test]
    fn analytic_numbers_of_records_grow_to_all_of_them() {
        assert_eq!(records_drawn(44), [5, 7, 10, 14, 20, 28, 40, 44]);
        assert_eq!(records_drawn(7), [5, 7]);
        assert_eq!((records_drawn(5), records_drawn(4)), (vec![5], vec![]));
    }

    #[test]
    fn regress_a_conclusion_is_decided_from_where_it_stays_decided() {
        let by_records = [sure(5, 0.95, 0.0), sure(7, 0.5, 0.0), sure(10, 0.92, 0.0), sure(14, 0.99, 0.0)];
        assert_eq!(decided_from(&by_records), Some(10), "at 5 it was decided by luck");
        assert_eq!(decided_from(&by_records[..2]), None);
        assert_eq!(decided_from(&[sure(5, 0.0, 0.91), sure(7, 0.0, 0.97)]), Some(5));
        assert_eq!(decided_from(&[sure(5, 0.91, 0.0), sure(7, 0.0, 0.97)]), Some(7), "turned round");
        assert_eq!(decided_from(&[]), None);
    }
}
