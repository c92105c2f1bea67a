//! Sweeps side by side as a table for people and as CSV.

use std::io::{self, Write};
use std::path::Path;

use super::{OfSuite, Suites, Told};
use crate::error::{Error, Result};
use crate::findings::FINDINGS;
use crate::store::write_durably;
use crate::text::{TERMINAL, aligned, wrapped};

/// "holds 97 %, from 10", "undecided 62:5 %".
pub fn short(told: &Told) -> String {
    let percent = |share: f64| (100.0 * share + 1e-3).floor();
    let shares = match (told.holds_share, told.does_not_share) {
        (Some(holds), Some(_)) if told.verdict == "holds" => format!(" {} %", percent(holds)),
        (Some(_), Some(does_not)) if told.verdict == "does not" => format!(" {} %", percent(does_not)),
        (Some(holds), Some(does_not)) => format!(" {}:{} %", percent(holds), percent(does_not)),
        _ => String::new(),
    };
    let from = told.decided_from.map_or(String::new(), |records| format!(", from {records}"));
    format!("{}{shares}{from}", told.verdict)
}

/// Prints a row a conclusion and a column a suite.
///
/// # Errors
/// What the stream says.
pub fn print_table(out: &mut dyn Write, suites: &Suites) -> io::Result<()> {
    let mut head = vec!["conclusion".to_owned()];
    head.extend(suites.suites.iter().map(title));
    let mut rows = vec![head];
    for (index, finding) in FINDINGS.iter().enumerate() {
        let cells = suites.suites.iter().map(|suite| short(&suite.conclusions[index]));
        rows.push(std::iter::once(format!("{:>2}. {}", index + 1, finding.name)).chain(cells).collect());
    }
    writeln!(out, "{}", aligned(&rows))?;
    let notes = "With the share of the draws that say so; undecided: those that hold, and those that do not. \
                 From N: the fewest records in a draw from which on it is decided so.";
    writeln!(out, "{}", wrapped(notes, 0, TERMINAL))
}

/// "emilia7, 7 generated".
pub fn title(of: &OfSuite) -> String {
    format!("{}, {} {}", of.suite, of.records, if of.generated { "generated" } else { "measured" })
}

/// Writes a row for each suite, conclusion and number of records as CSV.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the disk refuses.
pub fn write_csv(path: &Path, suites: &Suites) -> Result<()> {
    let failed = |e: csv::Error| Error::table(path, e);
    let mut csv = csv::Writer::from_writer(Vec::new());
    let head =
        ["suite", "generated", "conclusion", "verdict", "at_hand", "decided_from", "records", "holds_share"];
    csv.write_record(head.into_iter().chain(["does_not_share"])).map_err(failed)?;
    for of in &suites.suites {
        for told in &of.conclusions {
            for by in &told.by_records {
                let from = told.decided_from.map_or(String::new(), |records| records.to_string());
                let row =
                    [of.suite.clone(), of.generated.to_string(), told.name.clone(), told.verdict.clone()];
                let shares = [by.holds_share, by.does_not_share].map(|share| share.to_string());
                let row = row.into_iter().chain([told.at_hand.clone(), from, by.records.to_string()]);
                csv.write_record(row.chain(shares)).map_err(failed)?;
            }
        }
    }
    let bytes = csv.into_inner().map_err(|e| Error::table(path, e))?;
    write_durably(path, &bytes)
}
