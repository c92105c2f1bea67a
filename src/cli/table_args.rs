//! What is known of tables of samples that state nothing: options of every command that reads a record.

use clap::Args;

use mrbd_records::{ColumnChoice, ReadOptions, Unit};

/// `--unit`, `--columns`, `--decimal-comma`.
#[derive(Debug, Clone, Args)]
pub struct TableArgs {
    /// Unit of the samples, where files do not state it: m/s2, g, cm/s2, gal or mm/s2.
    #[arg(long)]
    unit: Option<Unit>,
    /// Columns of time and acceleration in a table of no known format: numbers from 1, or names of its header; the
    /// acceleration alone with --dt. Fields lie between semicolons, tabs, commas or blanks.
    #[arg(long, value_name = "TIME,ACCELERATION", requires = "unit")]
    columns: Option<ColumnChoice>,
    /// The numbers of such a table have a comma as their decimal sign.
    #[arg(long, requires = "columns")]
    decimal_comma: bool,
}

impl TableArgs {
    /// Options of reading; step and channel are left open.
    pub fn options(&self) -> ReadOptions {
        let Self { unit, columns, decimal_comma } = self.clone();
        ReadOptions { unit, columns, decimal_comma, ..ReadOptions::default() }
    }
}
