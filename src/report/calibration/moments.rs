//! The moment of the joints that releases say, no law assumed, beside static laws.

use super::super::chart::{Axis, Colour, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Key, Link, Section, Table};
use crate::report::number as number_in_words;
use crate::results::calibration::MOMENTS;
use mrbd_lab::release::{FittedLaw, LawKind, MomentPoint, Moments, ReleaseMoment, Told};

/// While joints open, and while they close.
const WAYS: [(&str, Colour, Mark); 2] =
    [("measured, opening", PALETTE[0], Mark::Circle), ("measured, closing", PALETTE[1], Mark::Triangle)];

/// Points of a law.
const POINTS: u32 = 120;

/// The section.
pub fn section(measured: &Moments) -> Section {
    let releases = measured.releases.iter().enumerate();
    Section {
        id: "moments".into(),
        title: "Moment of the joints".into(),
        text: vec![
            "A strip whose top is held has one way to move, so its motion alone says what moment its joints carry together; \
             which of them carries how much it does not say. 1 is the moment of sharp edges: the rigid line."
                .into(),
        ],
        figures: releases.map(|(index, release)| figure(measured, index, release)).collect(),
        tables: vec![laws(measured)],
        ..Section::default()
    }
}

/// Laws that are drawn, each with its colour.
fn drawn(kind: LawKind) -> Option<Colour> {
    match kind {
        LawKind::Sharp => None,
        LawKind::Bed => Some(PALETTE[2]),
        LawKind::Trilinear => Some(PALETTE[3]),
        LawKind::Rounded => Some(PALETTE[4]),
    }
}

fn fitted<'m>(measured: &'m Moments, release: &'m ReleaseMoment) -> impl Iterator<Item = &'m FittedLaw> {
    measured.laws.iter().filter(|law| law.fitted_to == release.test)
}

fn figure(measured: &Moments, index: usize, release: &ReleaseMoment) -> Figure {
    let mut legend = WAYS.map(|(label, colour, mark)| Key::new(label, colour, mark)).to_vec();
    legend.extend(fitted(measured, release).filter_map(|law| {
        let kind = law.law.kind;
        drawn(kind).map(|colour| Key::new(format!("{}, fitted", kind.name()), colour, Mark::None))
    }));
    Figure {
        id: format!("moments-{}", index + 1),
        title: format!("{}: moment of the joints over that of sharp edges", release.test),
        legend,
        panels: vec![graph(measured, release).svg()],
        wide: true,
        caption: format!(
            "From {} test functions of {:.2} s each. Bands hold 90 %. Lines: static laws fitted to the same motion.",
            release.test_functions,
            2.0 * mrbd_lab::release::HALF_S
        ),
        links: vec![Link::to(MOMENTS)],
        ..Figure::default()
    }
}

fn graph(measured: &Moments, release: &ReleaseMoment) -> Graph {
    let told = |way: usize, point: &MomentPoint| if way == 0 { point.opening } else { point.closing };
    let mut layers = Vec::new();
    for (way, (label, colour, mark)) in WAYS.into_iter().enumerate() {
        let points = release.points.iter().filter_map(|point| Some((point, told(way, point)?)));
        let points = points.collect::<Vec<_>>();
        let band = |(point, told): &(&MomentPoint, Told)| {
            (point.displacement, told.interval_90[0], told.interval_90[1])
        };
        layers.push(Layer::Band { colour, points: points.iter().map(band).collect() });
        let dot = |(point, told): &(&MomentPoint, Told)| Dot {
            x: point.displacement,
            y: told.share,
            tip: tip(label, point, told),
        };
        layers.push(Layer::Dots {
            colour,
            mark,
            size: 8,
            hollow: false,
            dots: points.iter().map(dot).collect(),
        });
    }
    let end =
        release.points.iter().filter(|p| p.opening.is_some() || p.closing.is_some()).map(|p| p.displacement);
    let end = end.fold(0.0, f64::max);
    layers.extend(fitted(measured, release).filter_map(|law| {
        let colour = drawn(law.law.kind)?;
        let at = |k: u32| end * f64::from(k) / f64::from(POINTS);
        let points = (0..=POINTS).map(|k| (at(k), law.law.share(&measured.strip, at(k)))).collect();
        Some(Layer::Line { colour, width: 4, dashed: false, name: law.law.kind.name().into(), points })
    }));
    layers.push(Layer::Threshold { y: 1.0, name: "rigid line" });
    let ends =
        release.points.iter().flat_map(|p| [p.opening, p.closing]).flatten().flat_map(|t| t.interval_90);
    Graph {
        title: String::new(),
        format: Format::Wide,
        x: Axis::linear("displacement of the crack over the thickness", 0.0, end),
        y: Axis::holding("moment over that of sharp edges", ends.chain([1.05])),
        layers,
    }
}

fn tip(label: &str, point: &MomentPoint, told: &Told) -> String {
    let [low, high] = told.interval_90;
    format!(
        "{label}\n{:.3} of the thickness, crack turned by {:.4} rad\n{:.3} ({low:.3} to {high:.3})",
        point.displacement, point.crack_rotation_rad, told.share
    )
}

fn laws(measured: &Moments) -> Table {
    let names = measured.releases.iter().map(|release| format!("left of {}", release.test));
    let head =
        ["law", "fitted to", "numbers"].map(str::to_owned).into_iter().chain(names).collect::<Vec<_>>();
    let row = |fitted: &FittedLaw| {
        let numbers = fitted.law.kind.numbers().iter().zip(&fitted.law.values);
        let numbers = numbers
            .map(|(number, value)| format!("{} {}", number.name, number_in_words(*value)))
            .collect::<Vec<_>>();
        let numbers = if numbers.is_empty() { "–".to_owned() } else { numbers.join(", ") };
        let left = fitted.left.iter().map(|left| format!("{left:.3}"));
        let first = [fitted.law.kind.name().to_owned(), fitted.fitted_to.clone(), numbers];
        first.into_iter().chain(left).collect::<Vec<_>>()
    };
    let head = head.iter().map(String::as_str).collect::<Vec<_>>();
    let caption = "Static laws: what each leaves of the moment that a release asks for (root mean square, over that of sharp edges)";
    Table::of(caption, &head, measured.laws.iter().map(row))
}
