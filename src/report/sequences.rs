//! The page of a study of sequences: what records do after others, beside what they do alone.

use super::chart::{Axis, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::page::{Figure, Key, Link, Number, Page, Section, Table};
use super::provenance;
use super::sweep::{assumptions, spectra_section};
use super::words;
use crate::aggregate::{After, SEQUENCES_TABLE, Sequences, VariantNote};
use crate::findings::{AFTER_RULES, after_cells};
use crate::study::runs::Manifest;
use crate::summary::AfterOthers;
use crate::survey::Configuration;

/// The page of a study of sequences.
pub fn page(after: &AfterOthers) -> Page {
    let AfterOthers { manifest, sequences: study, .. } = after;
    let runs = provenance::run_links(&after.run_files);
    let mut files = vec![Link::to("manifest.json"), Link::to("plan.toml"), Link::to(SEQUENCES_TABLE)];
    files.extend(runs);
    Page {
        title: format!("Sequences “{}”", manifest.plan),
        lead: lead(manifest),
        unfinished: provenance::unfinished(study.completeness),
        numbers: numbers(study),
        notes: notes(manifest, &study.variants),
        sections: vec![
            over_all(study),
            by_sequence(study),
            spectra_section(after.spectra.as_ref(), manifest.kind),
            assumptions(&study.variants),
        ],
        provenance: provenance::of(manifest),
        files,
        ..Page::default()
    }
}

fn lead(manifest: &Manifest) -> String {
    let rests: Vec<f64> = manifest.sequences.iter().map(|sequence| sequence.rest_s).collect();
    let [least, most] = [rests.iter().copied().reduce(f64::min), rests.iter().copied().reduce(f64::max)];
    let rest = match (least, most) {
        (Some(least), Some(most)) if least < most => format!("{least} to {most} s"),
        (Some(rest), _) => format!("{rest} s"),
        _ => "no time".to_owned(),
    };
    let sequences = manifest.sequences.len();
    format!(
        "Façades under {sequences} sequences of records with {rest} of rest between, and under each later record alone."
    )
}

fn numbers(study: &Sequences) -> Vec<Number> {
    let total = |of: fn(&VariantNote) -> u64| study.variants.iter().map(of).sum::<u64>();
    let only_after = study.rows.iter().filter(|row| row.sequence.is_none()).map(|row| row.fell_only_after);
    vec![
        Number::new(total(|v| v.runs), "runs, a row a part"),
        Number::new(total(|v| v.collapsed), "collapsed"),
        Number::new(only_after.sum::<u64>(), "fell after other records, and stand the record alone"),
        Number::new(total(|v| v.failed), "failed"),
    ]
}

fn notes(manifest: &Manifest, variants: &[VariantNote]) -> Vec<String> {
    let mut notes = provenance::notes(manifest, variants);
    let assumed = |key: &str| -> Vec<String> {
        let holds = |variant: &&serde_json::Value| {
            let value = &variant["assumptions"][key];
            !value.is_null() && *value != false
        };
        let all = manifest.variants.as_array().into_iter().flatten();
        all.filter(holds).filter_map(|variant| Some(format!("“{}”", variant["name"].as_str()?))).collect()
    };
    let said = |what: &str, names: Vec<String>| match names[..] {
        [] => format!("No variant has {what}."),
        _ => format!("With {what}: {}.", names.join(", ")),
    };
    notes.push("Carried from one record to the next: rotations, velocities, the contact state, and what the variant says below. A wall that has come to rest and keeps nothing is as new.".into());
    notes.push(said("a floor that yields and keeps what it has yielded", assumed("floor_yield_m")));
    notes.push(said(
        "corners that stay crushed by the largest compression of a record",
        assumed("crushing_stays"),
    ));
    notes
}

fn over_all(study: &Sequences) -> Section {
    let all: Vec<&After> = study.rows.iter().filter(|row| row.sequence.is_none()).collect();
    let figure = Figure {
        id: "ratios".into(),
        title: "Rotation after other records over rotation alone".into(),
        panels: Configuration::ALL.into_iter().filter_map(|floor| ratios(&all, floor)).collect(),
        caption: "Dots: the median over walls and sequences; thick: its 90 % interval; thin: from the 16 to the 84 % quantile. Ends among walls that fall are left out.".into(),
        links: vec![Link::to(SEQUENCES_TABLE)],
        ..Figure::default()
    };
    Section {
        id: "after".into(),
        title: "What a record does after others".into(),
        text: vec![AFTER_RULES.to_owned()],
        figures: vec![figure],
        tables: vec![table("Over all sequences", all.into_iter())],
        ..Section::default()
    }
}

/// Ratios of a floor, a line a variant and part.
fn ratios(all: &[&After], floor: Configuration) -> Option<String> {
    let rows: Vec<&After> = all.iter().filter(|row| row.configuration == floor.name()).copied().collect();
    let place = |index: usize| (rows.len() - 1 - index) as f64;
    let several = rows.iter().any(|row| row.part > 2);
    let name = |row: &&After| {
        if several { format!("{}, part {}", row.variant, row.part) } else { row.variant.clone() }
    };
    let span = |ends: [Option<f64>; 2], y: f64| Some([(ends[0]?, y), (ends[1]?, y)]);
    let spans = |width: u32, of: fn(&After) -> [Option<f64>; 2]| Layer::Spans {
        colour: PALETTE[0],
        width,
        spans: rows.iter().enumerate().filter_map(|(i, row)| span(of(row), place(i))).collect(),
    };
    let dot = |(i, row): (usize, &&After)| {
        let x = row.ratio[1]?;
        Some(Dot { x, y: place(i), tip: format!("{}\nmedian {x:.3} of {} walls", row.variant, row.ratios) })
    };
    let dots: Vec<Dot> = rows.iter().enumerate().filter_map(dot).collect();
    let shown = rows.iter().flat_map(|row| row.ratio.into_iter().flatten()).chain([1.0]);
    let graph = Graph {
        title: words::floor(floor).to_owned(),
        format: Format::Half,
        x: Axis::holding("ratio after / alone", shown),
        y: Axis::names("", rows.iter().rev().map(name).collect()),
        layers: vec![
            spans(2, |row| [row.ratio[0], row.ratio[2]]),
            spans(8, |row| row.ratio_interval.unwrap_or([None; 2])),
            Layer::Dots { colour: PALETTE[0], mark: Mark::Circle, size: 7, hollow: false, dots },
        ],
    };
    (!rows.is_empty()).then(|| graph.svg())
}

fn by_sequence(study: &Sequences) -> Section {
    let rows: Vec<&After> = study.rows.iter().filter(|row| row.sequence.is_some()).collect();
    let legend = study.variants.iter().zip(PALETTE);
    let figure = Figure {
        id: "by-sequence".into(),
        title: "The median ratio, sequence by sequence".into(),
        legend: legend.map(|(variant, colour)| Key::new(&variant.name, colour, Mark::Circle)).collect(),
        panels: Configuration::ALL.into_iter().filter_map(|floor| medians(study, &rows, floor)).collect(),
        caption: "A dot a sequence and part; its name stands under the pointer and in the table. Medians that are falls are left out.".into(),
        links: vec![Link::to(SEQUENCES_TABLE)],
        ..Figure::default()
    };
    let base = study.variants.last().map_or("", |variant| &variant.name);
    let shown = rows.iter().filter(|row| row.variant == base).copied();
    Section {
        id: "sequences".into(),
        title: "Sequence by sequence".into(),
        figures: vec![figure],
        tables: vec![table(
            &format!("By sequence, variant “{base}”; the others are in {SEQUENCES_TABLE}"),
            shown,
        )],
        ..Section::default()
    }
}

fn medians(study: &Sequences, rows: &[&After], floor: Configuration) -> Option<String> {
    let of_floor = |row: &&&After| row.configuration == floor.name();
    let dots = |variant: &VariantNote| -> Vec<Dot> {
        let rows = rows.iter().filter(of_floor).filter(|row| row.variant == variant.name);
        let dot = |(number, row): (usize, &&After)| {
            let (y, sequence) = (row.ratio[1]?, row.sequence.as_deref()?);
            let tip = format!("{sequence}, part {}\n{}: {y:.3}", row.part, row.variant);
            Some(Dot { x: number as f64 + 1.0, y, tip })
        };
        rows.enumerate().filter_map(dot).collect()
    };
    let drawn: Vec<Vec<Dot>> = study.variants.iter().map(dots).collect();
    let all = || drawn.iter().flatten();
    let layer = |(dots, colour)| Layer::Dots { colour, mark: Mark::Circle, size: 6, hollow: false, dots };
    let graph = Graph {
        title: words::floor(floor).to_owned(),
        format: Format::Half,
        x: Axis::holding("number of the sequence", all().map(|dot| dot.x).chain([0.0])),
        y: Axis::holding("median ratio after / alone", all().map(|dot| dot.y).chain([1.0])),
        layers: drawn.iter().cloned().zip(PALETTE).map(layer).collect(),
    };
    all().next().is_some().then(|| graph.svg())
}

fn table<'a>(caption: &str, rows: impl Iterator<Item = &'a After>) -> Table {
    let head = [
        "variant",
        "floor",
        "sequence",
        "part",
        "walls",
        "fell before",
        "compared",
        "fell alone",
        "fell after",
        "fell only after",
        "ratio 16 %",
        "ratio 50 %",
        "ratio 84 %",
    ];
    Table::of(caption, &head, rows.map(after_cells))
}
