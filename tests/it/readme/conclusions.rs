//! The table of the paper's conclusions, on the shipped suite and on the measured one.

use std::collections::BTreeMap;
use std::path::Path;

use mrbd::aggregate::{Medians, aggregate};
use mrbd::findings::{Conclusion, FINDINGS, conclusions, rules, sure_rules};

use super::ROOT;
use super::block::{Page, grouped, row};
use super::studies::Study;
use crate::shared;

const SWEEP: &str = "pipelines/sweep.toml";
const HEAD: [&str; 4] =
    ["conclusion of the paper", "emilia7, generated", "natural7, measured", "FEMA P-695, 44 measured"];

/// The table, and how many walls collapsed; what is said of measured suites stays as it is where their records are not.
pub fn blocks(page: &mut Page) {
    let sweep = |suite: Option<&Path>| aggregate(Study::run(SWEEP, suite).folder()).expect("medians");
    let generated = sweep(None);
    let natural7 = shared::folder("records/natural7").map(|folder| folder.join("suite.toml"));
    // Written by `make suites`.
    let p695 =
        Some(Path::new(ROOT).join("inputs/records/p695/scaled/suite.toml")).filter(|suite| suite.is_file());
    let [natural7, p695] = [natural7, p695].map(|suite| suite.map(|suite| sweep(Some(&suite))));
    let before = cells_of(page.block("conclusions"));
    let table = table([Some(&generated), natural7.as_ref(), p695.as_ref()], &before);
    page.put_lines("conclusions", &table);
    page.put_prose("rules", &format!("({} *k* of *n*: so many of the noticeable comparisons agree; two such numbers: under the perpendicular and the parallel floor, or as the conclusion has two parts. {})", rules(), sure_rules()));
    let planned = generated.variants.iter().map(|variant| variant.runs).sum();
    page.put("planned runs of the sweep", &grouped(planned));
    page.put("emilia7 collapsed", &collapsed(&generated));
    match natural7 {
        Some(measured) => page.put("natural7 collapsed", &collapsed(&measured)),
        None => page.keep("natural7 collapsed"),
    }
}

/// A column a suite; the cells of one that has not been run are those of before.
fn table(suites: [Option<&Medians>; 3], before: &BTreeMap<String, Vec<String>>) -> String {
    let suites = suites.map(|medians| medians.map(under_base));
    let mut table = row(&HEAD) + &row(&["---"; 4]);
    for (i, finding) in FINDINGS.iter().enumerate() {
        let kept = |column: usize| before.get(finding.label)?.get(column).cloned();
        let cell = |(column, of): (usize, &Option<Vec<Conclusion>>)| match of {
            Some(all) => cell(&all[i]),
            None => kept(column).unwrap_or_default(),
        };
        let cells = suites.iter().enumerate().map(cell);
        table += &row(&std::iter::once(finding.label.to_owned()).chain(cells).collect::<Vec<_>>());
    }
    table
}

/// The conclusions under the first variant.
fn under_base(medians: &Medians) -> Vec<Conclusion> {
    conclusions(medians).swap_remove(0).all
}

fn cell(conclusion: &Conclusion) -> String {
    format!("{}: {}", conclusion.short(), conclusion.answer.short)
}

/// The cells of each row of a table behind its first, by its first.
fn cells_of(table: &str) -> BTreeMap<String, Vec<String>> {
    let cells = |line: &str| {
        let mut cells = line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned());
        Some((cells.next()?, cells.collect()))
    };
    table.lines().filter_map(cells).collect()
}

/// "269 collapsed and 0 failed", over all variants.
fn collapsed(medians: &Medians) -> String {
    let of =
        |count: fn(&mrbd::aggregate::VariantNote) -> u64| grouped(medians.variants.iter().map(count).sum());
    format!("{} collapsed and {} failed", of(|variant| variant.collapsed), of(|variant| variant.failed))
}

#[test]
fn regress_cells_that_cannot_be_made_are_found_again() {
    let before =
        cells_of("\n| head | a | b |\n| --- | --- | --- |\n| α > 0.05, so | holds: 1 | does not: 2 of 3 |\n");
    assert_eq!(before["α > 0.05, so"], ["holds: 1", "does not: 2 of 3"]);
}
