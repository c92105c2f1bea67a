//! The page of a sweep: the paper's figures 12 and 14 to 20 from one's own medians and runs.

mod medians;
mod spectra;
mod tables;

use super::page::{Number, Page, Section};
use super::provenance;
use crate::aggregate::{Medians, VariantNote};
use crate::findings::{Conclusions, Held, rules, sure_rules};
use crate::study::runs::Manifest;
use crate::summary::Sweep;
pub(super) use spectra::section as spectra_section;

/// The page of a sweep.
pub fn page(sweep: &Sweep) -> Page {
    let Sweep { manifest, medians, conclusions, .. } = sweep;
    let view = sweep.view();
    let links = provenance::run_links(&sweep.run_files);
    let mut sections = vec![medians::section(&view, sweep.records)];
    if !sweep.reference.is_empty() {
        sections.push(tables::by_record(&view, &sweep.reference, &links));
    }
    sections.push(spectra::section(sweep.spectra.as_ref(), manifest.kind));
    sections.extend([findings(conclusions), assumptions(&medians.variants)]);
    Page {
        title: format!("Sweep “{}”", manifest.plan),
        lead: lead(manifest, sweep.records),
        unfinished: provenance::unfinished(medians.completeness),
        numbers: numbers(medians, conclusions),
        notes: provenance::notes(manifest, &medians.variants),
        sections,
        provenance: provenance::of(manifest),
        files: provenance::files(links),
        ..Page::default()
    }
}

fn lead(manifest: &Manifest, records: usize) -> String {
    let kind = if manifest.suite.generated { "generated" } else { "recorded" };
    let motions = match records {
        1 => format!("one {kind} ground motion"),
        many => format!("{many} {kind} ground motions"),
    };
    format!(
        "Largest rotations of two-body façades under {motions}, one parameter at a time at its three levels."
    )
}

fn numbers(medians: &Medians, conclusions: &[Conclusions]) -> Vec<Number> {
    let total = |of: fn(&VariantNote) -> u64| -> u64 { medians.variants.iter().map(of).sum() };
    let held = Held::among(conclusions.first().map_or(&[], |base| &base.all));
    let unfinished = medians.completeness.filter(|study| !study.is_whole());
    let judged_over = unfinished.map_or(String::new(), |study| format!(", judged over {study}"));
    let others = match held.not_asked() {
        0 => String::new(),
        others => format!("; {others} others are not in this study"),
    };
    let runs = unfinished.map_or("runs".to_owned(), |study| format!("of {} runs", study.planned_runs));
    vec![
        Number::new(total(|v| v.runs), runs),
        Number::new(total(|v| v.collapsed), "collapsed"),
        Number::new(total(|v| v.failed), "failed"),
        Number::new(
            format!("{} of {}", held.holds, held.asked),
            format!("conclusions of the paper hold here{judged_over}{others}"),
        ),
    ]
}

fn findings(conclusions: &[Conclusions]) -> Section {
    let mut tables: Vec<_> = conclusions.first().map(tables::findings).into_iter().collect();
    if conclusions.len() > 1 {
        tables.push(tables::by_variant(conclusions));
    }
    Section {
        id: "conclusions".into(),
        title: "The paper’s conclusions against these results".into(),
        text: vec![
            "Each conclusion has a criterion that was fixed beforehand; the numbers decide. Nothing is fitted.".into(),
            rules(),
            sure_rules(),
        ],
        tables,
        ..Section::default()
    }
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
