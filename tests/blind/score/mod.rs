//! What `mrbd diagnose` said, held against the answers.

mod columns;
mod confusion;
mod counted;
mod reading;
mod row;
mod targets;

use std::fs::File;
use std::path::{Path, PathBuf};

pub use row::Row;

/// Reads every diagnosed case, prints the targets and the confusion, and writes a row a case as Parquet and CSV.
///
/// # Errors
/// Text for people: a file that cannot be read or written.
pub fn report(cases: &[PathBuf], out: &Path) -> Result<(), String> {
    let rows = cases.iter().filter_map(|case| Row::load(case).transpose()).collect::<Result<Vec<_>, _>>()?;
    let missing = cases.len() - rows.len();
    if missing > 0 {
        eprintln!("{missing} of {} cases have not been diagnosed", cases.len());
    }
    let text = format!("{}\n{}", targets::table(&rows), confusion::tables(&rows));
    print!("{text}");
    let told = |e: &dyn std::fmt::Display| format!("{}: {e}", out.display());
    std::fs::write(out.join("report.txt"), &text).map_err(|e| told(&e))?;
    mrbd::store::write_table(&out.join("cases.parquet"), &columns::COLUMNS, &[], &rows)
        .map_err(|e| told(&e))?;
    let mut csv = File::create(out.join("cases.csv")).map_err(|e| told(&e))?;
    mrbd::store::print_csv(&mut csv, columns::COLUMNS.iter(), &rows).map_err(|e| told(&e))
}
