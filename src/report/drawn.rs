//! The page of a study of drawn façades: fragilities, quantiles of the response, and the draws against the survey.

mod fragility;
mod quantiles;
mod samples;

use super::page::{Link, Number, Page, Section};
use super::provenance;
use super::sweep::{assumptions, spectra_section};
use crate::aggregate::{Distributions, VariantNote};
use crate::study::pipeline::Kind;
use crate::study::runs::Manifest;
use crate::summary::Drawn;

/// The page of a study of drawn façades.
pub fn page(drawn: &Drawn) -> Page {
    let Drawn { manifest, distributions: study, .. } = drawn;
    let base = study.variants.first().map_or("", |variant| &variant.name);
    let links = provenance::run_links(&drawn.run_files);
    let sections = vec![
        fragility::section(study, &drawn.fragilities, &links),
        quantiles::section(study, base),
        samples::section(&drawn.samples, &links),
        spectra_section(drawn.spectra.as_ref(), manifest.kind),
        assumptions(&study.variants),
    ];
    Page {
        title: format!("{} “{}”", kind(manifest.kind), manifest.plan),
        lead: lead(manifest, study),
        unfinished: provenance::unfinished(study.completeness),
        numbers: numbers(study),
        notes: notes(manifest, study, base),
        sections,
        provenance: provenance::of(manifest),
        files: provenance::files(links),
        ..Page::default()
    }
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Sweep => "Sweep",
        Kind::MonteCarlo => "Monte Carlo study",
        Kind::Cloud => "Cloud of runs",
        Kind::Stripes => "Stripes of runs",
        Kind::Incremental => "Incremental analyses",
        Kind::Sequence => "Sequences",
        Kind::Variance => "Study of variance",
    }
}

fn lead(manifest: &Manifest, study: &Distributions) -> String {
    let shaken = match manifest.kind {
        Kind::Cloud => "each run at a factor of its own",
        Kind::Stripes => "every record scaled to each of some intensities",
        Kind::Incremental => "every record scaled up until a limit is exceeded",
        _ => "as the suite has them",
    };
    let records = study.completeness.map_or(manifest.suite.records.len() as u64, |study| study.records);
    let motions = if records == 1 { "ground motion" } else { "ground motions" };
    format!("Façades drawn from the survey under {records} {motions}, {shaken}.")
}

fn numbers(study: &Distributions) -> Vec<Number> {
    let total = |of: fn(&VariantNote) -> u64| study.variants.iter().map(of).sum::<u64>();
    let unfinished = study.completeness.filter(|study| !study.is_whole());
    let runs = unfinished.map_or("runs".to_owned(), |study| format!("of {} runs", study.planned_runs));
    vec![
        Number::new(total(|v| v.runs), runs),
        Number::new(total(|v| v.collapsed), "collapsed"),
        Number::new(total(|v| v.failed), "failed"),
    ]
}

fn notes(manifest: &Manifest, study: &Distributions, base: &str) -> Vec<String> {
    let mut notes = provenance::notes(manifest, &study.variants);
    notes.push(format!("Figures show variant “{base}”."));
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
