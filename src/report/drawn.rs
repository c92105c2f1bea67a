//! The page of a study of drawn façades: fragilities, quantiles of the response, and the draws against the survey.

mod along;
mod fragility;
mod quantiles;
mod samples;

use std::path::Path;

use super::page::{Link, Number, Page, Section};
use super::provenance;
use super::sweep::{assumptions, records};
use crate::aggregate::{Distributions, VariantNote, distributions};
use crate::error::{InputError, Result};
use crate::study::pipeline::Kind;
use crate::study::runs::Manifest;
use mrbd_records::Site;

/// The page of the study in a folder; its table of quantiles is written there first, for the page links to it.
///
/// # Errors
/// An input error for a folder without results; whatever reading and drawing meet.
pub fn page(folder: &Path, manifest: &Manifest, site: Option<&Site>) -> Result<Page> {
    let study = distributions(folder, manifest.kind)?;
    let Some(base) = study.variants.first() else {
        return Err(InputError::file(folder, "run files without a run", "the results of a study").into());
    };
    study.write(&folder.join("medians.parquet"))?;
    let links = provenance::run_links(folder)?;
    let sections = vec![
        fragility::section(folder, &study, base, &links)?,
        quantiles::section(&study, base),
        samples::section(folder, manifest, base, &links)?,
        records(folder, manifest, site),
        assumptions(&study.variants),
    ];
    Ok(Page {
        title: format!("{} “{}”", kind(manifest.kind), manifest.plan),
        lead: lead(manifest),
        numbers: numbers(&study),
        notes: notes(manifest, &study, base),
        sections,
        provenance: provenance::of(manifest),
        files: provenance::files(links),
    })
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Sweep => "Sweep",
        Kind::MonteCarlo => "Monte Carlo study",
        Kind::Cloud => "Cloud of runs",
        Kind::Stripes => "Stripes of runs",
        Kind::Incremental => "Incremental analyses",
    }
}

fn lead(manifest: &Manifest) -> String {
    let shaken = match manifest.kind {
        Kind::Cloud => "each run at a factor of its own",
        Kind::Stripes => "every record scaled to each of some intensities",
        Kind::Incremental => "every record scaled up until a limit is exceeded",
        _ => "as the suite has them",
    };
    format!("Façades drawn from the survey under {} ground motions, {shaken}.", manifest.suite.records.len())
}

fn numbers(study: &Distributions) -> Vec<Number> {
    let total = |of: fn(&VariantNote) -> u64| study.variants.iter().map(of).sum::<u64>();
    vec![
        Number::new(total(|v| v.runs), "runs"),
        Number::new(total(|v| v.collapsed), "collapsed"),
        Number::new(total(|v| v.failed), "failed"),
    ]
}

fn notes(manifest: &Manifest, study: &Distributions, base: &VariantNote) -> Vec<String> {
    let mut notes = provenance::notes(manifest, &study.variants);
    notes.push(format!("Figures show variant “{}”.", base.name));
    for moved in &study.moved {
        let share = 100.0 * moved.moved as f64 / (moved.runs as f64).max(1.0);
        notes.push(format!(
            "Under variant “{}”, {} floor, {share:.1} % of the runs come out differently.",
            moved.variant, moved.configuration
        ));
    }
    notes
}

/// Links to the table of quantiles.
fn medians() -> Vec<Link> {
    vec![Link::to("medians.parquet")]
}

/// A section under a title, still empty.
fn titled(id: &str, title: &str) -> Section {
    Section { id: id.into(), title: title.into(), ..Section::default() }
}
