//! `mrbd records import`: the user's files for the rows of a table.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use super::{ReadArgs, print_table, table_or_table_4, written};
use crate::error::{InputError, Result};
use crate::text::signed_percent;
use mrbd_records::{Import, IntensityMeasures, RecordTable, read_imports, write_imports};

/// Import records of a published table: check their peaks against it and write a suite.
///
/// A peak acceleration may differ by 2 %, a peak velocity by 5 %. Files are told apart by content.
///
/// Examples:
///   mrbd records import --record 1=000879xa.csv --record 2=000879ya.csv --out inputs/records/table4
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct ImportArgs {
    /// Table of records; the paper's Table 4 unless given.
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Horizontal record of a row.
    #[arg(long = "record", value_name = "ROW=FILE", required = true)]
    records: Vec<Numbered>,
    /// Vertical record of a row.
    #[arg(long = "vertical", value_name = "ROW=FILE")]
    verticals: Vec<Numbered>,
    /// Name of the suite.
    #[arg(long, default_value = "table4")]
    name: String,
    /// Folder to write; it must not hold a suite yet.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    read: ReadArgs,
}

/// `3=file`.
#[derive(Debug, Clone)]
struct Numbered(u32, PathBuf);

impl FromStr for Numbered {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, file) = text.split_once('=').ok_or("expected ROW=FILE, as 1=000879xa.csv")?;
        let number =
            number.trim().parse().map_err(|_| format!("expected the number of a row, found `{number}`"))?;
        Ok(Self(number, PathBuf::from(file)))
    }
}

pub(super) fn execute(args: &ImportArgs) -> Result<()> {
    if args.out.join("suite.toml").exists() {
        let found = format!("{}, which holds a suite", args.out.display());
        return Err(InputError::option("--out", found, "a folder without a suite.toml").into());
    }
    let table = table_or_table_4(args.table.as_deref())?;
    let (records, verticals) =
        (by_number("--record", &args.records)?, by_number("--vertical", &args.verticals)?);
    let imports = read_imports(&table, &records, &verticals, &args.read.options())?;
    let rows: Vec<Vec<String>> = imports.iter().map(|import| row(&table, import)).collect();
    print_table(&["record", "PGA g", "of the table", "", "PGV m/s", "of the table", ""], &rows)?;
    written("--out", write_imports(&args.out, &args.name, &table, &imports))?;
    Ok(())
}

fn by_number(option: &str, files: &[Numbered]) -> Result<BTreeMap<u32, PathBuf>, InputError> {
    let mut map = BTreeMap::new();
    for Numbered(number, file) in files {
        if map.insert(*number, file.clone()).is_some() {
            return Err(InputError::option(option, format!("{number} twice"), "one file a row"));
        }
    }
    Ok(map)
}

fn row(table: &RecordTable, import: &Import) -> Vec<String> {
    let found = IntensityMeasures::of(&import.record.accelerogram);
    let said = table.records.iter().find(|row| row.id == import.id);
    let (pga_g, pgv_m_s) = said.map_or((f64::NAN, f64::NAN), |row| (row.pga_g, row.pgv_m_s));
    let columns = |found: f64, said: f64| {
        [format!("{found:.4}"), format!("{said:.4}"), signed_percent(found / said - 1.0)]
    };
    let peaks = columns(found.pga_g, pga_g).into_iter().chain(columns(found.pgv_m_s, pgv_m_s));
    [format!("{} {}", import.id, import.record.name)].into_iter().chain(peaks).collect()
}
