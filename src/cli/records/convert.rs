//! `mrbd records convert`: any format to two columns.

use std::path::PathBuf;

use clap::Args;

use super::{ReadArgs, written};
use crate::error::{InputError, Result};
use mrbd_records::write_two_columns;

/// Convert a record of any format to two-column CSV.
///
/// Examples:
///   mrbd records convert gilroy.AT2 gilroy.csv
///   mrbd records convert wpws.V2A up.csv --channel Up
///   mrbd records convert logger.csv record.csv --columns 1,3 --unit g --decimal-comma
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct ConvertArgs {
    /// Record file.
    file: PathBuf,
    /// CSV file to write; an existing one is not touched.
    out: PathBuf,
    #[command(flatten)]
    read: ReadArgs,
}

pub(super) fn execute(args: &ConvertArgs) -> Result<()> {
    if args.out.exists() {
        let found = format!("{}, which exists", args.out.display());
        return Err(InputError::option("OUT", found, "a file that does not exist yet").into());
    }
    let is_csv = args.out.extension().is_none_or(|extension| extension.eq_ignore_ascii_case("csv"));
    if !is_csv {
        let found = format!("{}, named as another format", args.out.display());
        return Err(InputError::option("OUT", found, "a .csv file").into());
    }
    let record = args.read.read(&args.file)?;
    written("OUT", write_two_columns(&args.out, &record.accelerogram))?;
    let motion = &record.accelerogram;
    let (samples, step_s, peak) = (motion.acceleration_m_s2().len(), motion.step_s(), motion.peak_m_s2());
    let out = args.out.display();
    eprintln!(
        "{}: {samples} samples at {step_s} s in {}, peak {peak:.4} m/s2, to {out}",
        record.format, record.unit
    );
    Ok(())
}
