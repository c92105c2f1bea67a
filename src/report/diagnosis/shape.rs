//! What shape the missing force has: against what the top does, with the candidates' laws drawn through.

use super::super::chart::{Axis, Colour, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Link, Section};
use super::force::{AGAINST, Law, Points};
use super::words::{fitted_to_all, shared_held_out, stability};
use super::{AFTER, BEFORE, key};
use crate::error::Result;
use mrbd_lab::diagnose::answer::{ExplainedBy, Summary};

/// Colours of laws, none of them that of points.
const LAWS: [Colour; 4] = [PALETTE[2], PALETTE[3], PALETTE[4], PALETTE[5]];

/// What shape the missing force has.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn shape_section(points: &Points, summary: &Summary) -> Result<Section> {
    let mut section = Section {
        id: "shape".into(),
        title: "What shape it has".into(),
        text: vec![
            "The measured force against what the top does, with the laws of the best candidates drawn through. A law lines up its points in one of the three; a cloud without a line is no law of that quantity alone.".into(),
        ],
        ..Section::default()
    };
    if points.force_n.is_empty() {
        section.text = vec!["No stretch between impacts is long enough to tell the force.".into()];
        return Ok(section);
    }
    section.text.push(explained(summary));
    section.text.extend(summary.fitted_to_all.iter().map(fitted_to_all));
    section.text.extend(summary.shared_held_out.map(shared_held_out));
    section.text.extend(summary.stability.iter().map(stability));
    let names = points.law_names();
    let mut legend = vec![key("measured, wall as given", BEFORE, Mark::Circle)];
    if summary.has_updated_wall() {
        legend.push(key("left by the updated wall", AFTER, Mark::Square));
    }
    legend.extend(names.iter().take(LAWS.len()).map(|name| key(name, colour(&names, name), Mark::None)));
    section.figures.push(Figure {
        id: "force-state".into(),
        title: "Force and motion of the top".into(),
        legend,
        panels: (0..AGAINST.len()).map(|which| points.shape(which, summary)).collect::<Result<_>>()?,
        caption: "Force, displacement, velocity and acceleration are means over the same short stretches. Laws are those of single additions as they were fitted, without what the wall’s own numbers do beside them; a yielding spring is drawn as it is first loaded. A law outside the catalogue has its 90 % band; one that does nothing upright is drawn against velocity at half the largest displacement.".into(),
        links: vec![Link::to("force.parquet"), Link::to("laws.parquet")],
        ..Figure::default()
    });
    Ok(section)
}

impl Points {
    fn shape(&self, which: usize, summary: &Summary) -> Result<String> {
        let x = &self.against[which];
        let dots = |colour, mark, size, y: &[f64]| Layer::Dots {
            colour,
            mark,
            size,
            hollow: false,
            dots: self
                .rows()
                .filter(|&k| y[k].is_finite())
                .map(|k| Dot { x: x[k], y: y[k], tip: self.tip(k) })
                .collect(),
        };
        let mut layers = Vec::new();
        if summary.has_updated_wall() {
            layers.push(dots(AFTER, Mark::Square, 3, &self.after_n));
        }
        layers.push(dots(BEFORE, Mark::Circle, 3, &self.force_n));
        let names = self.law_names();
        let y = Axis::holding("missing force at the top N", self.force_n.iter().copied());
        let own = || self.laws.iter().filter(|law| law.which == which);
        layers.extend(own().filter(|law| !law.band.is_empty()).map(|law| Layer::Band {
            colour: colour(&names, &law.name),
            points:
                law.band.iter().copied().filter(|(_, low, high)| y.holds(*low) && y.holds(*high)).collect(),
        }));
        for Law { name, points, .. } in own() {
            // A law may go far beyond what was measured.
            let inside = points.iter().map(|&(x, f)| (x, if y.holds(f) { f } else { f64::NAN }));
            layers.push(Layer::Line {
                colour: colour(&names, name),
                width: 3,
                dashed: false,
                name: name.clone(),
                points: inside.collect(),
            });
        }
        let largest = x.iter().fold(0.0, |most: f64, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
        Ok(Graph {
            title: String::new(),
            format: Format::Half,
            x: Axis::linear(AGAINST[which].1, -1.03 * largest, 1.03 * largest),
            y,
            layers,
        }
        .svg())
    }
}

/// Which quantity the force is a curve of.
fn explained(summary: &Summary) -> String {
    let ExplainedBy { displacement_m, velocity_m_s, acceleration_m_s2 } = summary.missing_force.explained_by;
    let by = |((_, label), share): (&(&str, &str), Option<f64>)| {
        let share = share?;
        let label = label.rsplit_once(' ').map_or(*label, |(label, _)| label);
        Some(format!("{:.0} % against the {label}", 100.0 * share.max(0.0)))
    };
    let shares = AGAINST.iter().zip([displacement_m, velocity_m_s, acceleration_m_s2]);
    let shares = shares.map(by).collect::<Option<Vec<_>>>();
    match shares {
        Some(shares) => format!(
            "Whatever its form, a curve through neighbouring points explains of the squared force {} (each point told by the others; more than one of them where two quantities go together, as displacement and acceleration do).",
            shares.join(", ")
        ),
        None => "The force is hardly more than its noise: it has no shape to be told.".to_owned(),
    }
}

fn colour(names: &[&str], name: &str) -> Colour {
    LAWS[names.iter().position(|known| *known == name).unwrap_or(0) % LAWS.len()]
}
