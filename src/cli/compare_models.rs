//! `mrbd run` on a pipeline that compares models: rows on stdout, findings on stderr, both in the output folder.

use std::path::Path;

use super::output;
use crate::classics::comparison::{self, Finding, ModelComparison, compare, print_rows, write_histories};
use crate::error::{Error, Result};
use crate::store::{WholeFolder, now_unix_s, write_durably};

/// What it writes.
const FILES: [&str; 4] = ["manifest.json", "comparison.csv", "histories.parquet", "findings.json"];

/// Runs the comparison.
///
/// # Errors
/// Input errors of the pipeline and what it names, and of the output folder; [`mrbd_files::Error::Io`] if the disk refuses.
pub fn execute(pipeline: &Path, suite: Option<&Path>, out: Option<&Path>, replace: bool) -> Result<()> {
    let started_unix_s = now_unix_s();
    let default = Path::new("outputs").join(comparison::name(pipeline)?);
    let folder = out.unwrap_or(&default);
    let folder = WholeFolder::check(folder, &FILES, replace)?;
    let comparison = compare(pipeline, suite)?;
    write(&comparison, folder.cleared()?, started_unix_s)?;
    for finding in &comparison.findings {
        let Finding { law, claim, holds, of } = finding;
        eprintln!("{} {law:<8} {holds:>3} of {of:<3} {claim}", finding.mark());
    }
    eprintln!("✓ in every case that can be judged, ✗ not in all of them, - in none to judge");
    output::to_stdout(|out| print_rows(out, &comparison.rows).map_err(output::failed))
}

fn write(comparison: &ModelComparison, folder: &Path, started_unix_s: u64) -> Result<()> {
    let [manifest_json, comparison_csv, histories_parquet, findings_json] =
        FILES.map(|name| folder.join(name));
    write_durably(&manifest_json, manifest(comparison, started_unix_s).as_bytes())?;
    let mut rows = Vec::new();
    print_rows(&mut rows, &comparison.rows).map_err(|e| Error::io("write the rows", folder, e))?;
    write_durably(&comparison_csv, &rows)?;
    write_histories(&histories_parquet, &comparison.histories)?;
    let findings = serde_json::to_vec_pretty(&comparison.findings)
        .map_err(|e| Error::io("write the findings", folder, e.into()))?;
    write_durably(&findings_json, &findings)
}

/// Kind and provenance, by which `mrbd report` knows the folder.
fn manifest(comparison: &ModelComparison, started_unix_s: u64) -> String {
    let manifest = serde_json::json!({
        "kind": crate::classics::comparison::KIND,
        "name": comparison.name,
        "tool_version": env!("CARGO_PKG_VERSION"),
        "suite": comparison.suite,
        "generated": comparison.generated,
        "inputs": comparison.inputs,
        "started_unix_s": started_unix_s,
    });
    format!("{manifest:#}\n")
}
