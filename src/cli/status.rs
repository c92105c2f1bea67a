//! `mrbd status`: how far a study is, what failed and why, and how to read it elsewhere.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use super::output;
use crate::aggregate::{Ending, endings};
use crate::error::Result;
use crate::study::campaign::{Layout, Standing};
use crate::study::runs::{Manifest, OutputFolder};

/// Tell how far a study is and what failed and why, check every file, and print lines that read it.
#[derive(Debug, Args)]
pub struct StatusCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
}

impl StatusCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// An input error for a folder without a study; [`mrbd_files::Error::Io`] or [`crate::Error::Table`] if it cannot be read.
    pub fn execute(self) -> Result<()> {
        let folder = OutputFolder::look(&self.folder)?;
        let layout = Layout::of(folder.manifest());
        let standing = Standing::of(&folder, &layout)?;
        // A damaged file cannot be counted from.
        let readable = standing.damaged.is_empty() && !standing.files().is_empty();
        let endings = if readable { endings(folder.path())? } else { Vec::new() };
        output::to_stdout(|out| {
            print_progress(out, folder.manifest(), &layout, &standing)
                .and_then(|()| print_endings(out, &endings))
                .and_then(|()| print_readers(out, folder.path(), &standing))
                .map_err(output::failed)
        })
    }
}

fn print_progress(
    out: &mut dyn Write,
    manifest: &Manifest,
    layout: &Layout,
    standing: &Standing,
) -> io::Result<()> {
    let (done, all) = (standing.runs(layout), manifest.runs);
    let share = 100.0 * done as f64 / all.max(1) as f64;
    let (plan, suite) = (&manifest.plan, &manifest.suite.name);
    let kind = manifest.kind.name();
    writeln!(out, "study {plan:?} ({kind}) under suite {suite:?}: {done} of {all} runs done ({share:.1} %)")?;
    let (together, records) = (standing.parts.len(), layout.records().len());
    writeln!(
        out,
        "{together} of {records} records put together, {} blocks beside them",
        standing.blocks.len()
    )?;
    for damaged in &standing.damaged {
        writeln!(
            out,
            "damaged: {} (or its checksum is gone); `mrbd run … --resume` does its runs again",
            damaged.display()
        )?;
    }
    Ok(())
}

fn print_endings(out: &mut dyn Write, endings: &[Ending]) -> io::Result<()> {
    for Ending { outcome, reason, runs, first_run } in endings {
        match reason {
            Some(reason) => writeln!(out, "{outcome}: {runs}, the first is run {first_run}: {reason}")?,
            None => writeln!(out, "{outcome}: {runs}")?,
        }
    }
    Ok(())
}

/// Lines for DuckDB and for polars for Python. An unfinished study is read from both folders that hold files.
fn print_readers(out: &mut dyn Write, path: &Path, standing: &Standing) -> io::Result<()> {
    let patterns = [("runs", standing.parts.is_empty()), ("blocks", standing.blocks.is_empty())];
    let patterns: Vec<String> = patterns
        .into_iter()
        .filter(|(_, none)| !none)
        .map(|(name, _)| format!("'{}'", path.join(name).join("*/*.parquet").display()))
        .collect();
    if patterns.is_empty() {
        return Ok(());
    }
    let list = patterns.join(", ");
    writeln!(
        out,
        "\nduckdb -c \"SELECT variant, configuration, outcome, count(*) AS runs FROM read_parquet([{list}]) GROUP BY ALL ORDER BY ALL\""
    )?;
    writeln!(
        out,
        "python3 -c \"import polars as pl; print(pl.scan_parquet([{list}]).group_by('variant', 'configuration', 'outcome').len().collect())\""
    )
}
