//! `mrbd run` on a pipeline that compares models: rows on stdout, findings on stderr, both in the output folder.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use super::output;
use crate::comparison::{Finding, ModelComparison, compare, print_rows, write_histories};
use crate::error::{Error, InputError, Result};
use crate::store::write_durably;

/// Runs the comparison.
///
/// # Errors
/// Input errors of the pipeline and what it names, and of the output folder; [`Error::Io`] if the disk refuses.
pub fn execute(pipeline: &Path, suite: Option<&Path>, out: Option<&Path>) -> Result<()> {
    let comparison = compare(pipeline, suite)?;
    let default = Path::new("outputs").join(&comparison.name);
    write(&comparison, out.unwrap_or(&default))?;
    for finding in &comparison.findings {
        let Finding { law, claim, holds, of } = finding;
        eprintln!("{} {law:<8} {holds:>3} of {of:<3} {claim}", finding.mark());
    }
    eprintln!("✓ in every case that can be judged, ✗ not in all of them, - in none to judge");
    output::to_stdout(|out| print_rows(out, &comparison.rows).map_err(output::failed))
}

fn write(comparison: &ModelComparison, folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| {
        let found = format!("{}: {e}", folder.display());
        InputError::option("--out", found, "a folder that can be written")
    })?;
    write_durably(&folder.join("manifest.json"), manifest(comparison).as_bytes())?;
    let mut rows = Vec::new();
    print_rows(&mut rows, &comparison.rows).map_err(|e| Error::io("write the rows", folder, e))?;
    write_durably(&folder.join("comparison.csv"), &rows)?;
    write_histories(&folder.join("histories.parquet"), &comparison.histories)?;
    let findings = serde_json::to_vec_pretty(&comparison.findings)
        .map_err(|e| Error::io("write the findings", folder, e.into()))?;
    write_durably(&folder.join("findings.json"), &findings)
}

/// Kind and provenance, by which `mrbd report` knows the folder.
fn manifest(comparison: &ModelComparison) -> String {
    let now_unix_s = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let manifest = serde_json::json!({
        "kind": crate::comparison::KIND,
        "name": comparison.name,
        "tool_version": env!("CARGO_PKG_VERSION"),
        "suite": comparison.suite,
        "generated": comparison.generated,
        "inputs": comparison.inputs,
        "started_unix_s": now_unix_s,
    });
    format!("{manifest:#}\n")
}
