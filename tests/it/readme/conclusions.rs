//! The table of the paper's conclusions, on the shipped suite and on the measured one.

use std::collections::BTreeMap;

use mrbd::aggregate::{Medians, aggregate};
use mrbd::findings::{Conclusion, FINDINGS, conclusions, rules, sure_rules};

use super::block::{Page, grouped, row};
use super::studies::Study;
use crate::shared;

const SWEEP: &str = "pipelines/sweep.toml";
const HEAD: [&str; 3] = ["conclusion of the paper", "emilia7, generated", "natural7, measured"];

/// The table, and how many walls collapsed; what is said of the measured suite stays as it is where its records are not.
pub fn blocks(page: &mut Page) {
    let generated = aggregate(Study::run(SWEEP, None).folder()).expect("medians");
    let natural7 = shared::folder("records/natural7").map(|folder| folder.join("suite.toml"));
    let measured = natural7.map(|suite| {
        aggregate(Study::run(SWEEP, Some(&suite)).folder()).expect("medians of the measured suite")
    });
    let table = table(&generated, measured.as_ref(), &cells_of(page.block("conclusions")));
    page.put_lines("conclusions", &table);
    page.put_prose("rules", &format!("({} *k* of *n*: so many of the noticeable comparisons agree; two such numbers: under the perpendicular and the parallel floor, or as the conclusion has two parts. {})", rules(), sure_rules()));
    let planned = generated.variants.iter().map(|variant| variant.runs).sum();
    page.put("planned runs of the sweep", &grouped(planned));
    page.put("emilia7 collapsed", &collapsed(&generated));
    match measured {
        Some(measured) => page.put("natural7 collapsed", &collapsed(&measured)),
        None => page.keep("natural7 collapsed"),
    }
}

fn table(generated: &Medians, measured: Option<&Medians>, before: &BTreeMap<String, String>) -> String {
    let mut table = row(&HEAD) + &row(&["---"; 3]);
    let (generated, measured) = (under_base(generated), measured.map(under_base));
    for (i, finding) in FINDINGS.iter().enumerate() {
        let kept = || before.get(finding.label).cloned().unwrap_or_default();
        let measured = measured.as_ref().map_or_else(kept, |all| cell(&all[i]));
        table += &row(&[finding.label.to_owned(), cell(&generated[i]), measured]);
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

/// The last cell of each row of a table, by its first.
fn cells_of(table: &str) -> BTreeMap<String, String> {
    let cells = |line: &str| {
        let mut cells = line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned());
        Some((cells.next()?, cells.last()?))
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
    assert_eq!(before["α > 0.05, so"], "does not: 2 of 3");
}
