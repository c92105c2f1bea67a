//! Figure 11: response spectra of the records, against the code's where a site is given.

use super::super::chart::{Axis, COLLAPSE, Colour, Format, Graph, Layer, Mark, of_curve};
use super::super::page::{Figure, Key, Section};
use crate::study::pipeline::Kind;
use crate::summary::{CodeSpectrum, Spectra};
use mrbd_records::COMPATIBLE_PERIODS_S;

/// The mean of the records: black, which neither axes nor text are, for the legend fades by colour.
const MEAN: Colour = Colour(0, 0, 0);
/// The code: the colour that is left.
const CODE: Colour = COLLAPSE;

/// The section; a sentence where the records are no longer at hand.
pub fn section(spectra: Option<&Spectra>, kind: Kind) -> Section {
    let mut section =
        Section { id: "spectra".into(), title: "The records’ spectra".into(), ..Section::default() };
    match spectra {
        Some(spectra) => section.figures.push(figure(spectra, kind)),
        None => section.text.push(
            "The records are no longer where the study read them, or are other ones now: their spectra cannot be drawn.".into(),
        ),
    }
    section
}

/// A line of the figure and its mark in the legend.
struct Line<'a> {
    name: &'a str,
    colour: Colour,
    mark: Mark,
    width: u32,
    /// Pseudo-accelerations, m/s².
    values: &'a [f64],
}

fn lines(spectra: &Spectra) -> Vec<Line<'_>> {
    let mut lines: Vec<Line> = spectra
        .records
        .iter()
        .enumerate()
        .map(|(index, (name, values))| {
            let (colour, mark) = of_curve(index);
            Line { name, colour, mark, width: 3, values }
        })
        .collect();
    let single = |name, colour, values| Line { name, colour, mark: Mark::Square, width: 8, values };
    if spectra.records.len() > 1 {
        lines.push(single("mean", MEAN, &spectra.mean_m_s2[..]));
    }
    lines.extend(spectra.code.iter().map(|code| single("code", CODE, &code.elastic_m_s2[..])));
    lines
}

fn figure(spectra: &Spectra, kind: Kind) -> Figure {
    let lines = lines(spectra);
    Figure {
        id: "spectra-figure".into(),
        title: format!(
            "Elastic response spectra, {} % damping",
            mrbd_kernel::written(100.0 * spectra.damping)
        ),
        paper: (spectra.records.len() > 1).then(|| "Fig. 11".into()),
        legend: lines.iter().map(|line| Key::new(line.name, line.colour, line.mark)).collect(),
        panels: vec![graph(spectra, &lines).svg()],
        wide: true,
        caption: caption(spectra, kind),
        ..Figure::default()
    }
}

fn graph(spectra: &Spectra, lines: &[Line]) -> Graph {
    let (from, to) = COMPATIBLE_PERIODS_S;
    let layer = |line: &Line| Layer::Line {
        colour: line.colour,
        width: line.width,
        dashed: false,
        name: line.name.to_owned(),
        points: spectra.periods_s.iter().copied().zip(line.values.iter().copied()).collect(),
    };
    let values = lines.iter().flat_map(|line| line.values).copied();
    Graph {
        title: String::new(),
        format: Format::Wide,
        x: Axis::linear("period s", 0.0, spectra.periods_s.last().copied().unwrap_or(1.0)),
        y: Axis::holding("pseudo-acceleration m/s²", values),
        layers: std::iter::once(Layer::Shade { from, to }).chain(lines.iter().map(layer)).collect(),
    }
}

fn caption(spectra: &Spectra, kind: Kind) -> String {
    let (from, to) = COMPATIBLE_PERIODS_S;
    let scales = match kind {
        Kind::Cloud | Kind::Stripes | Kind::Incremental => {
            "at the suite’s own scales; the runs scaled them further"
        }
        Kind::Sweep | Kind::MonteCarlo | Kind::Variance => "as they were run, scaled",
        Kind::Sequence => "at the suite’s own scales",
    };
    let records = format!(
        "Records of suite “{}” {scales}. Shaded: {from} to {to} s, where the paper compares with the code.",
        spectra.suite
    );
    match &spectra.code {
        None => format!("{records} No code spectrum: give the site with --site."),
        Some(code) => format!("{records} {}", of_code(code)),
    }
}

fn of_code(CodeSpectrum { site, check, .. }: &CodeSpectrum) -> String {
    format!(
        "Code: NTC 2018, a_g {} g, F₀ {}, T_C* {} s, soil {:?}. There the mean lies {:+.0} % to {:+.0} % from the code.",
        site.ag_g,
        site.f0,
        site.tc_star_s,
        site.soil,
        100.0 * check.lowest_deviation,
        100.0 * check.highest_deviation
    )
}
