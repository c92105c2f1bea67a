//! Histories of a run, one above the other over the same time: rotations, pattern, impacts, ground acceleration.

use super::super::chart::{Axis, COLLAPSE, INK, Layer, PALETTE, PATTERNS, Row, Stack, StackKey, Stretch};
use super::RunPicture;
use mrbd_kernel::model::PATTERN_NAMES;
use mrbd_kernel::simulate::Outcome;

/// Heights of rotations, patterns, impacts and ground, units of the picture.
const HEIGHTS: [f64; 4] = [668.0, 56.0, 76.0, 376.0];
/// Height of the slowest impact, over that of the fastest.
const SLOWEST: f64 = 0.12;

/// The time shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// From, s.
    pub from_s: f64,
    /// To, s.
    pub to_s: f64,
}

impl Window {
    fn holds(&self, time_s: f64) -> bool {
        (self.from_s..=self.to_s).contains(&time_s)
    }
}

/// The histories of a run within a window.
pub fn stack(picture: &RunPicture, window: &Window) -> Stack {
    let rows = [
        rotations(picture, window),
        (Axis::unmarked("pattern"), vec![Layer::Stretches(patterns(picture, window))]),
        (Axis::unmarked("impacts"), vec![impacts(picture, window)]),
        ground(picture, window),
    ];
    let row = |(height, (y, layers))| Row { height, y, layers };
    Stack {
        label: format!("Histories: {}", picture.title()),
        legend: legend(picture, window),
        x: Axis::linear("time s", window.from_s, window.to_s),
        rows: HEIGHTS.into_iter().zip(rows).map(row).collect(),
    }
}

/// Curves, and the colours of the patterns that occur.
fn legend(picture: &RunPicture, window: &Window) -> Vec<StackKey> {
    let bodies: &[&str] = if picture.wall.is_cracked() {
        &["θ₁/α₁ lower body", "θ₂/α₂ upper body"]
    } else {
        &["θ/α"]
    };
    let key = |label: &str, colour, line| StackKey { label: label.to_owned(), colour, line };
    let curves = bodies.iter().zip(PALETTE).map(|(name, colour)| key(name, colour, true));
    let occurring = (0..PATTERNS.len()).filter(|&index| occurs(picture, window, index));
    curves.chain(occurring.map(|index| key(PATTERN_NAMES[index], PATTERNS[index], false))).collect()
}

fn occurs(picture: &RunPicture, window: &Window, pattern: usize) -> bool {
    let mut rows = picture.watch.history.rows.iter().filter(|row| window.holds(row.time_s));
    rows.any(|row| row.contact.index() == pattern)
}

fn rotations(picture: &RunPicture, window: &Window) -> (Axis, Vec<Layer>) {
    let alpha = picture.wall.alpha_i_rad();
    let bodies = if picture.wall.is_cracked() { 2 } else { 1 };
    let curve = |body: usize| -> Vec<(f64, f64)> {
        let rows = picture.watch.history.rows.iter().filter(|row| window.holds(row.time_s));
        rows.map(|row| (row.time_s, row.theta_rad[body] / alpha[body])).collect()
    };
    let curves: Vec<_> = (0..bodies).map(curve).collect();
    let y = Axis::holding("rotation θᵢ/αᵢ", curves.iter().flatten().map(|point| point.1));
    let line =
        |(points, colour)| Layer::Line { colour, width: 4, dashed: false, name: String::new(), points };
    let mut layers: Vec<Layer> = curves.into_iter().zip(PALETTE).map(line).collect();
    if let Outcome::Collapsed { time_s } = picture.response.outcome {
        layers.push(Layer::Moment { x: time_s, name: "collapse", colour: COLLAPSE });
    }
    let later = picture.parts.iter().skip(1).filter(|part| window.holds(part.start_s));
    layers.extend(later.map(|part| Layer::Moment { x: part.start_s, name: "next record", colour: INK }));
    (y, layers)
}

fn patterns(picture: &RunPicture, window: &Window) -> Vec<Stretch> {
    let step_s = picture.watch.history.step_s();
    let stretches = picture.watch.history.rows.chunk_by(|a, b| a.contact == b.contact).map(|rows| Stretch {
        from: rows[0].time_s.max(window.from_s),
        to: (rows[rows.len() - 1].time_s + step_s).min(window.to_s),
        colour: PATTERNS[rows[0].contact.index()],
    });
    stretches.filter(|stretch| stretch.to > stretch.from).collect()
}

fn impacts(picture: &RunPicture, window: &Window) -> Layer {
    let impacts = &picture.watch.impacts;
    let fastest = impacts.iter().map(|impact| impact.closing_rad_s).fold(f64::MIN_POSITIVE, f64::max);
    let spans = impacts.iter().filter(|impact| window.holds(impact.time_s)).map(|impact| {
        let height = SLOWEST + (1.0 - SLOWEST) * impact.closing_rad_s / fastest;
        [(impact.time_s, 0.0), (impact.time_s, height)]
    });
    Layer::Spans { colour: INK, width: 2, spans: spans.collect() }
}

fn ground(picture: &RunPicture, window: &Window) -> (Axis, Vec<Layer>) {
    let points: Vec<(f64, f64)> = match &picture.shaking.horizontal {
        Some(motion) => {
            let samples = motion.acceleration_m_s2().iter().enumerate();
            let samples = samples.map(|(k, &a)| (k as f64 * motion.step_s(), a));
            samples.filter(|(time_s, _)| window.holds(*time_s)).collect()
        }
        None => vec![(window.from_s, 0.0), (window.to_s, 0.0)],
    };
    let y = Axis::holding("ground m/s²", points.iter().map(|point| point.1));
    (y, vec![Layer::Line { colour: INK, width: 2, dashed: false, name: String::new(), points }])
}
