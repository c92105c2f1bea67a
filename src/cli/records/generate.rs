//! `mrbd records generate`: records that stand in for those of a table.

use std::path::PathBuf;

use clap::Args;

use super::{print_table, table_or_table_4, written};
use crate::error::{InputError, Result};
use mrbd_records::{IntensityMeasures, Site, generate, write_suite};

/// Generate records with the peaks of a published table, and the suite that lists them.
///
/// The same seed gives the same files, to the bit. Without --site the mean spectrum is not adjusted to a code.
///
/// Examples:
///   mrbd records generate --out generated
///   mrbd records generate --name emilia7 --table inputs/table4.toml --site inputs/site_mirandola.toml --out emilia7
///   mrbd records generate --name mirandola2012 --table inputs/mirandola_2012.toml --out mirandola2012
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct GenerateArgs {
    /// Table of records; the paper's Table 4 unless given.
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Site whose code spectrum the mean follows.
    #[arg(long, value_name = "FILE")]
    site: Option<PathBuf>,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 20_120_529)]
    seed: u64,
    /// Name of the suite.
    #[arg(long, default_value = "generated")]
    name: String,
    /// Folder to write; it must not hold a suite yet.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn execute(args: &GenerateArgs) -> Result<()> {
    if args.out.join("suite.toml").exists() {
        let found = format!("{}, which holds a suite", args.out.display());
        return Err(InputError::option("--out", found, "a folder without a suite.toml").into());
    }
    let table = table_or_table_4(args.table.as_deref())?;
    let site = args.site.as_deref().map(Site::load).transpose()?;
    let records = generate(&table, site.as_ref(), args.seed);
    written("--out", write_suite(&args.out, &args.name, &table, &records, args.seed))?;
    let row = |(row, record): (&mrbd_records::TableRow, &mrbd_kernel::accelerogram::Accelerogram)| {
        let found = IntensityMeasures::of(record);
        let pair = |found: f64, said: f64| format!("{found:.4} for {said:.4}");
        let duration = format!("{:.1}", found.duration_5_95_s);
        vec![row.archive_id.clone(), pair(found.pga_g, row.pga_g), pair(found.pgv_m_s, row.pgv_m_s), duration]
    };
    let rows: Vec<Vec<String>> = table.records.iter().zip(&records).map(row).collect();
    print_table(&["record", "PGA g", "PGV m/s", "D5-95 s"], &rows)
}
