//! What `mrbd diagnose` said, held against the answers.

mod columns;
mod confusion;
pub mod counted;
pub mod reading;
pub mod recorded;
pub mod row;
pub mod targets;

use std::fs::File;
use std::path::{Path, PathBuf};

pub use row::Row;

/// Reads every diagnosed case, prints the targets and the confusion of these and of those recorded before, and writes a row a
/// case as Parquet, CSV and lines to record.
///
/// # Errors
/// Text for people: a file that cannot be read or written.
pub fn report(cases: &[PathBuf], recorded: Vec<Row>, out: &Path) -> Result<(), String> {
    let new = cases.iter().filter_map(|case| Row::load(case).transpose()).collect::<Result<Vec<_>, _>>()?;
    let missing = cases.len() - new.len();
    if missing > 0 {
        eprintln!("{missing} of {} cases have not been diagnosed", cases.len());
    }
    let mut rows = [recorded, new].concat();
    rows.sort_by_key(|row| row.number);
    let text = format!("{}\n{}\n\n{}", targets::table(&rows), targets::NOTE, confusion::tables(&rows));
    print!("{text}");
    std::fs::create_dir_all(out).map_err(|e| format!("{}: {e}", out.display()))?;
    let told = |e: &dyn std::fmt::Display| format!("{}: {e}", out.display());
    std::fs::write(out.join("report.txt"), &text).map_err(|e| told(&e))?;
    mrbd::store::write_table(&out.join("cases.parquet"), &columns::COLUMNS, &[], &rows)
        .map_err(|e| told(&e))?;
    let mut csv = File::create(out.join("cases.csv")).map_err(|e| told(&e))?;
    mrbd::store::print_csv(&mut csv, columns::COLUMNS.iter(), &rows).map_err(|e| told(&e))?;
    recorded::save(&out.join("cases.jsonl"), &rows)
}
