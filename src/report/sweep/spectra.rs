//! Figure 11: response spectra of the records as they were run, against the code's where a site is given.

use std::path::Path;

use super::super::chart::{Axis, COLLAPSE, Colour, Format, Graph, Layer, Mark, of_curve};
use super::super::page::{Figure, Key, Section};
use super::super::provenance::found_again;
use crate::study::plan::Motions;
use crate::study::runs::Manifest;
use mrbd_records::{CODE_DAMPING, COMPATIBLE_PERIODS_S, Site, Suite, SuiteCheck, response_spectrum_m_s2};

/// Longest period shown, s.
const LONGEST_S: f64 = 3.0;
/// Spacing of the periods, s.
const STEP_S: f64 = 0.02;

/// The suite of a study, if its file is still where it was and still holds the samples that were run.
pub fn suite_of(folder: &Path, manifest: &Manifest) -> Option<Suite> {
    let file = found_again(folder, &manifest.inputs, "suite")?;
    let motions = Motions::new(Suite::load(&file).ok()?);
    let same = motions.hashes.len() == manifest.suite.records.len()
        && motions
            .hashes
            .iter()
            .zip(&manifest.suite.records)
            .all(|(now, then)| now.horizontal == then.sha256);
    same.then_some(motions.suite)
}

/// The section; a sentence where the records are no longer at hand.
pub fn section(suite: Option<&Suite>, site: Option<&Site>) -> Section {
    let mut section =
        Section { id: "spectra".into(), title: "The records’ spectra".into(), ..Section::default() };
    match suite {
        Some(suite) => section.figures.push(figure(suite, site)),
        None => section.text.push(
            "The records are no longer where the study read them, or are other ones now: their spectra cannot be drawn.".into(),
        ),
    }
    section
}

fn periods_s() -> Vec<f64> {
    let last = (LONGEST_S / STEP_S).round() as u32;
    (1..=last).map(|k| f64::from(k) * STEP_S).collect()
}

fn figure(suite: &Suite, site: Option<&Site>) -> Figure {
    let periods = periods_s();
    let damping = site.map_or(CODE_DAMPING, |site| site.damping);
    let spectra: Vec<Vec<f64>> = suite
        .records
        .iter()
        .map(|record| response_spectrum_m_s2(&record.horizontal, &periods, damping))
        .collect();
    let mean = (0..periods.len()).map(|k| spectra.iter().map(|s| s[k]).sum::<f64>() / spectra.len() as f64);
    let over = |values: Vec<f64>| -> Vec<(f64, f64)> { periods.iter().copied().zip(values).collect() };
    let mut lines: Vec<Spectrum> = Vec::new();
    for (index, (record, spectrum)) in suite.records.iter().zip(&spectra).enumerate() {
        let colour = of_curve(index).0;
        lines.push(Spectrum { name: record.name.clone(), colour, width: 3, points: over(spectrum.clone()) });
    }
    if suite.records.len() > 1 {
        lines.push(Spectrum { name: "mean".into(), colour: MEAN, width: 8, points: over(mean.collect()) });
    }
    if let Some(site) = site {
        let code = periods.iter().map(|&period| site.elastic_m_s2(period)).collect();
        lines.push(Spectrum { name: "code".into(), colour: CODE, width: 8, points: over(code) });
    }
    let key = |(index, line): (usize, &Spectrum)| {
        let mark = if index < suite.records.len() { of_curve(index).1 } else { Mark::Square };
        Key::new(line.name.clone(), line.colour, mark)
    };
    Figure {
        id: "spectra-figure".into(),
        title: format!("Elastic response spectra, {} % damping", mrbd_kernel::written(100.0 * damping)),
        paper: (suite.records.len() > 1).then(|| "Fig. 11".into()),
        legend: lines.iter().enumerate().map(key).collect(),
        panels: vec![graph(lines).svg()],
        wide: true,
        caption: caption(suite, site),
        ..Figure::default()
    }
}

/// The mean of the records: black, which neither axes nor text are, for the legend fades by colour.
const MEAN: Colour = Colour(0, 0, 0);
/// The code: the colour that is left.
const CODE: Colour = COLLAPSE;

/// A spectrum as it is drawn.
struct Spectrum {
    name: String,
    colour: Colour,
    width: u32,
    /// Periods, s, and pseudo-accelerations, m/s².
    points: Vec<(f64, f64)>,
}

fn graph(spectra: Vec<Spectrum>) -> Graph {
    let (from, to) = COMPATIBLE_PERIODS_S;
    let all = spectra.iter().flat_map(|spectrum| &spectrum.points);
    let y = Axis::holding("pseudo-acceleration m/s²", all.map(|point| point.1));
    let line =
        |Spectrum { name, colour, width, points }| Layer::Line { colour, width, dashed: false, name, points };
    Graph {
        title: String::new(),
        format: Format::Wide,
        x: Axis::linear("period s", 0.0, LONGEST_S),
        y,
        layers: std::iter::once(Layer::Shade { from, to }).chain(spectra.into_iter().map(line)).collect(),
    }
}

fn caption(suite: &Suite, site: Option<&Site>) -> String {
    let (from, to) = COMPATIBLE_PERIODS_S;
    let scaled = format!(
        "Records of suite “{}” as they were run, scaled. Shaded: {from} to {to} s, where the paper compares with the code.",
        suite.name
    );
    let Some(site) = site else {
        return format!("{scaled} No code spectrum: give the site with --site.");
    };
    let check = SuiteCheck::of(suite, site, COMPATIBLE_PERIODS_S);
    format!(
        "{scaled} Code: NTC 2018, a_g {} g, F₀ {}, T_C* {} s, soil {:?}. There the mean lies {:+.0} % to {:+.0} % from the code.",
        site.ag_g,
        site.f0,
        site.tc_star_s,
        site.soil,
        100.0 * check.lowest_deviation,
        100.0 * check.highest_deviation
    )
}
