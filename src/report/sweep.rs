//! The page of a sweep: the paper's figures 12 and 14 to 20 from one's own medians and runs.

mod by_record;
mod medians;
mod spectra;
mod tables;

use std::path::Path;

use super::page::{Number, Page, Section};
use super::provenance;
use crate::aggregate::{Medians, VariantNote, aggregate, write_medians};
use crate::error::{InputError, Result};
use crate::findings::{Held, View, rules};
use crate::study::runs::Manifest;
use mrbd_records::Site;

/// The page of the sweep in a folder, its records held against the code of a site where one is given; its medians are written there first, for the page links to them.
///
/// # Errors
/// An input error for a folder without results; whatever reading and drawing meet.
pub fn page(folder: &Path, manifest: &Manifest, site: Option<&Site>) -> Result<Page> {
    let medians = aggregate(folder)?;
    let Some(base) = medians.variants.first() else {
        return Err(InputError::file(folder, "run files without a run", "the results of a sweep").into());
    };
    write_medians(&folder.join("medians.parquet"), &medians)?;
    let view = View::new(&medians, &base.name);
    let links = provenance::run_links(folder)?;
    let mut sections = vec![medians::section(&view, manifest.suite.records.len())];
    if manifest.suite.records.len() > 1 {
        sections.push(by_record::section(folder, &view, &links)?);
    }
    sections.push(records(folder, manifest, site));
    sections.extend([findings(&medians, &view), assumptions(&medians.variants)]);
    Ok(Page {
        title: format!("Sweep “{}”", manifest.plan),
        lead: lead(manifest),
        numbers: numbers(&medians, &view),
        notes: provenance::notes(manifest, &medians.variants),
        sections,
        provenance: provenance::of(manifest),
        files: provenance::files(links),
    })
}

fn lead(manifest: &Manifest) -> String {
    let kind = if manifest.suite.generated { "generated" } else { "recorded" };
    let motions = match manifest.suite.records.len() {
        1 => format!("one {kind} ground motion"),
        many => format!("{many} {kind} ground motions"),
    };
    format!(
        "Largest rotations of two-body façades under {motions}, one parameter at a time at its three levels."
    )
}

fn numbers(medians: &Medians, view: &View) -> Vec<Number> {
    let total =
        |of: fn(&crate::aggregate::VariantNote) -> u64| -> u64 { medians.variants.iter().map(of).sum() };
    let held = Held::of(view);
    let hold = match held.not_asked() {
        0 => "conclusions of the paper hold here".to_owned(),
        others => format!("conclusions of the paper hold here; {others} others are not in this study"),
    };
    vec![
        Number::new(total(|v| v.runs), "runs"),
        Number::new(total(|v| v.collapsed), "collapsed"),
        Number::new(total(|v| v.failed), "failed"),
        Number::new(format!("{} of {}", held.holds, held.asked), hold),
    ]
}

fn findings(medians: &Medians, view: &View) -> Section {
    let mut tables = vec![tables::findings(view)];
    if medians.variants.len() > 1 {
        tables.push(tables::by_variant(medians));
    }
    Section {
        id: "conclusions".into(),
        title: "The paper’s conclusions against these results".into(),
        text: vec![
            "Each conclusion has a criterion that was fixed beforehand; the numbers decide. Nothing is fitted.".into(),
            rules(),
        ],
        tables,
        ..Section::default()
    }
}

/// The spectra of a study's records, against the code of a site where one is given.
pub(super) fn records(folder: &Path, manifest: &Manifest, site: Option<&Site>) -> Section {
    spectra::section(spectra::suite_of(folder, manifest).as_ref(), site)
}

/// What every variant assumes, and how its runs ended.
pub(super) fn assumptions(variants: &[VariantNote]) -> Section {
    Section {
        id: "assumptions".into(),
        title: "What the paper leaves open, and what was assumed".into(),
        text: vec!["The first variant is the one the figures show.".into()],
        tables: vec![tables::assumptions(variants)],
        ..Section::default()
    }
}
