//! Histories of a run, one above the other over the same time: rotations, pattern, impacts, ground acceleration.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::super::colours::{COLLAPSE, INK, PALETTE, PATTERNS};
use super::super::pixels::png as draw_png;
use super::super::svg::{Drawn, Told, svg as draw_svg};
use super::super::words::{rounded_up, tick};
use super::RunPicture;
use crate::error::Result;
use mrbd_kernel::model::PATTERN_NAMES;
use mrbd_kernel::simulate::Outcome;

/// Size in its own units: plotters rounds to whole ones, so they are fine.
const SIZE: (u32, u32) = (2400, 1400);
/// Height of text.
const TEXT: i32 = 38;
/// Room for the numbers at the left.
const LEFT: i32 = 190;
/// Free strip at the left of it.
const MARGIN: i32 = 8;
/// Room at the right.
const RIGHT: i32 = 32;
/// Heights of legend, rotations, patterns and impacts; the rest is the ground.
const ROWS: [i32; 4] = [72, 680, 68, 88];

/// The time shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// From, s.
    pub from_s: f64,
    /// To, s.
    pub to_s: f64,
}

type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// The histories of a run within a window, as SVG.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn svg(picture: &RunPicture, window: &Window) -> Result<String> {
    draw_svg(SIZE, &format!("Histories: {}", picture.title()), |area| draw(picture, window, area))
}

/// The histories of a run within a window, as PNG.
///
/// # Errors
/// As [`svg`].
pub fn png(picture: &RunPicture, window: &Window) -> Result<Vec<u8>> {
    draw_png(SIZE, |area| draw(picture, window, area))
}

fn draw<DB: DrawingBackend>(
    picture: &RunPicture,
    window: &Window,
    area: &DrawingArea<DB, Shift>,
) -> Drawn<Told, DB> {
    let (legend, rest) = area.split_vertically(ROWS[0]);
    let (rotations, rest) = rest.split_vertically(ROWS[1]);
    let (patterns, rest) = rest.split_vertically(ROWS[2]);
    let (impacts, ground) = rest.split_vertically(ROWS[3]);
    draw_legend(picture, window, &legend)?;
    draw_rotations(picture, window, &rotations)?;
    draw_patterns(picture, window, &patterns)?;
    draw_impacts(picture, window, &impacts)?;
    draw_ground(picture, window, &ground)?;
    let attributes = vec![
        ("data-left", LEFT.to_string()),
        ("data-right", (SIZE.0 as i32 - RIGHT).to_string()),
        ("data-from", window.from_s.to_string()),
        ("data-to", window.to_s.to_string()),
    ];
    Ok(Told { attributes, ..Told::default() })
}

fn text<'a>(h_pos: HPos) -> TextStyle<'a> {
    ("sans-serif", TEXT).into_font().color(&INK.rgb()).pos(Pos::new(h_pos, VPos::Center))
}

/// Curves, and the colours of the patterns that occur.
fn draw_legend<DB: DrawingBackend>(
    picture: &RunPicture,
    window: &Window,
    area: &DrawingArea<DB, Shift>,
) -> Drawn<(), DB> {
    let bodies: &[&str] = if picture.wall.is_cracked() {
        &["θ₁/α₁ lower body", "θ₂/α₂ upper body"]
    } else {
        &["θ/α"]
    };
    let (mut x, middle) = (LEFT, ROWS[0] / 2);
    for (name, colour) in bodies.iter().zip(PALETTE) {
        area.draw(&PathElement::new([(x, middle), (x + 56, middle)], colour.rgb().stroke_width(6)))?;
        area.draw(&Text::new(*name, (x + 72, middle), text(HPos::Left)))?;
        x += 400;
    }
    for index in (0..PATTERNS.len()).filter(|&index| occurs(picture, window, index)) {
        let corners = [(x, middle - 16), (x + 36, middle + 16)];
        area.draw(&Rectangle::new(corners, PATTERNS[index].rgb().filled()))?;
        area.draw(&Text::new(PATTERN_NAMES[index], (x + 48, middle), text(HPos::Left)))?;
        x += 144;
    }
    Ok(())
}

fn occurs(picture: &RunPicture, window: &Window, pattern: usize) -> bool {
    let rows = picture.watch.history.rows.iter();
    let mut within = rows.filter(|row| row.time_s >= window.from_s && row.time_s <= window.to_s);
    within.any(|row| row.contact.index() == pattern)
}

fn chart<'a, DB: DrawingBackend>(
    area: &'a DrawingArea<DB, Shift>,
    window: &Window,
    y: std::ops::Range<f64>,
    below: i32,
) -> Drawn<Chart<'a, DB>, DB> {
    ChartBuilder::on(area)
        .margin_left(MARGIN)
        .margin_right(RIGHT)
        .margin_top(6)
        .margin_bottom(6)
        .x_label_area_size(below)
        .y_label_area_size(LEFT - MARGIN)
        .build_cartesian_2d(window.from_s..window.to_s, y)
}

fn mesh<DB: DrawingBackend>(chart: &mut Chart<DB>, y_label: &str, x_label: &str) -> Drawn<(), DB> {
    let label = ("sans-serif", TEXT).into_font().color(&INK.rgb());
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(INK.rgb().mix(0.12).stroke_width(2))
        .axis_style(INK.rgb().mix(0.6).stroke_width(2))
        .x_labels(12)
        .y_labels(6)
        .x_label_formatter(&|x| tick(*x))
        .y_label_formatter(&|y| tick(*y))
        .label_style(label.clone())
        .axis_desc_style(label)
        .x_desc(x_label)
        .y_desc(y_label)
        .draw()
}

fn draw_rotations<DB: DrawingBackend>(
    picture: &RunPicture,
    window: &Window,
    area: &DrawingArea<DB, Shift>,
) -> Drawn<(), DB> {
    let alpha = picture.wall.alpha_i_rad();
    let bodies = if picture.wall.is_cracked() { 2 } else { 1 };
    let curve = |body: usize| -> Vec<(f64, f64)> {
        let rows = picture.watch.history.rows.iter();
        let points = rows.map(|row| (row.time_s, row.theta_rad[body] / alpha[body]));
        thinned(points, window)
    };
    let curves: Vec<_> = (0..bodies).map(curve).collect();
    let mut chart = chart(area, window, range(curves.iter().flatten().map(|point| point.1)), 0)?;
    mesh(&mut chart, "rotation θᵢ/αᵢ", "")?;
    for (points, colour) in curves.into_iter().zip(PALETTE) {
        chart.draw_series(LineSeries::new(points, colour.rgb().stroke_width(4)))?;
    }
    if let Outcome::Collapsed { time_s } = picture.response.outcome {
        let (low, high) = (chart.y_range().start, chart.y_range().end);
        chart
            .draw_series(LineSeries::new([(time_s, low), (time_s, high)], COLLAPSE.rgb().stroke_width(6)))?;
        let style =
            ("sans-serif", TEXT).into_font().color(&COLLAPSE.rgb()).pos(Pos::new(HPos::Right, VPos::Top));
        let place = (time_s - 0.01 * (window.to_s - window.from_s), high - 0.02 * (high - low));
        chart.draw_series([Text::new("collapse", place, style)])?;
    }
    Ok(())
}

fn draw_patterns<DB: DrawingBackend>(
    picture: &RunPicture,
    window: &Window,
    area: &DrawingArea<DB, Shift>,
) -> Drawn<(), DB> {
    let step_s = picture.watch.history.step_s();
    let mut chart = chart(area, window, 0.0..1.0, 0)?;
    for stretch in picture.watch.history.rows.chunk_by(|a, b| a.contact == b.contact) {
        let from_s = stretch[0].time_s.max(window.from_s);
        let to_s = (stretch[stretch.len() - 1].time_s + step_s).min(window.to_s);
        if to_s > from_s {
            let colour = PATTERNS[stretch[0].contact.index()].rgb();
            chart.draw_series([Rectangle::new([(from_s, 0.0), (to_s, 1.0)], colour.filled())])?;
        }
    }
    area.draw(&Text::new("pattern", (LEFT - 20, ROWS[2] / 2), text(HPos::Right)))
}

fn draw_impacts<DB: DrawingBackend>(
    picture: &RunPicture,
    window: &Window,
    area: &DrawingArea<DB, Shift>,
) -> Drawn<(), DB> {
    let impacts = &picture.watch.impacts;
    let fastest = impacts.iter().map(|impact| impact.closing_rad_s).fold(f64::MIN_POSITIVE, f64::max);
    let mut chart = chart(area, window, 0.0..1.0, 0)?;
    for impact in impacts.iter().filter(|i| i.time_s >= window.from_s && i.time_s <= window.to_s) {
        let height = 0.12 + 0.88 * impact.closing_rad_s / fastest;
        chart.draw_series(LineSeries::new(
            [(impact.time_s, 0.0), (impact.time_s, height)],
            INK.rgb().stroke_width(2),
        ))?;
    }
    area.draw(&Text::new("impacts", (LEFT - 20, ROWS[3] / 2), text(HPos::Right)))
}

fn draw_ground<DB: DrawingBackend>(
    picture: &RunPicture,
    window: &Window,
    area: &DrawingArea<DB, Shift>,
) -> Drawn<(), DB> {
    let points = match &picture.shaking.horizontal {
        Some(motion) => {
            let samples = motion.acceleration_m_s2().iter().enumerate();
            thinned(samples.map(|(k, &a)| (k as f64 * motion.step_s(), a)), window)
        }
        None => vec![(window.from_s, 0.0), (window.to_s, 0.0)],
    };
    let mut chart = chart(area, window, range(points.iter().map(|point| point.1)), 104)?;
    mesh(&mut chart, "ground m/s²", "time s")?;
    chart.draw_series(LineSeries::new(points, INK.rgb().stroke_width(2)))?;
    Ok(())
}

/// A range around zero that shows all values.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.fold((0.0_f64, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    let size = high.max(-low);
    if size == 0.0 {
        return -1.0..1.0;
    }
    // One side may be all but empty; it keeps a fifth of the picture's height.
    let whole = rounded_up(1.02 * size);
    -(rounded_up(1.05 * (-low).max(0.25 * whole)).min(whole))
        ..rounded_up(1.05 * high.max(0.25 * whole)).min(whole)
}

/// Points within a window and one beyond each end, the smallest and the largest of each stretch of a pixel's width.
fn thinned(points: impl Iterator<Item = (f64, f64)>, window: &Window) -> Vec<(f64, f64)> {
    let pixels = f64::from(SIZE.0) - f64::from(LEFT + RIGHT);
    let column = |t: f64| ((t - window.from_s) / (window.to_s - window.from_s) * pixels).floor();
    let within: Vec<_> = points.filter(|(t, _)| *t >= window.from_s && *t <= window.to_s).collect();
    if (within.len() as f64) < 2.0 * pixels {
        return within;
    }
    let mut thin = Vec::new();
    for stretch in within.chunk_by(|a, b| column(a.0) == column(b.0)) {
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        if let (Some(&low), Some(&high)) = (stretch.iter().min_by(by_value), stretch.iter().max_by(by_value))
        {
            thin.extend(if low.0 <= high.0 { [low, high] } else { [high, low] });
        }
    }
    thin
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_thinning_keeps_the_extremes() {
        let window = Window { from_s: 0.0, to_s: 100.0 };
        let wave = |k: i32| (f64::from(k) * 1e-3, (f64::from(k) * 0.37).sin());
        let thin = thinned((0..=100_000).map(wave), &window);
        assert!(thin.len() < 6000 && thin.len() > 2000, "{}", thin.len());
        assert!(thin.iter().any(|p| p.1 > 0.9999) && thin.iter().any(|p| p.1 < -0.9999));
        assert!(thin.is_sorted_by(|a, b| a.0 <= b.0));
    }

    #[test]
    fn regress_ranges_hold_all_values_and_zero() {
        for values in [vec![0.1, -0.02], vec![-3.0], vec![], vec![2.0, -2.0]] {
            let range = range(values.iter().copied());
            assert!(values.iter().all(|v| range.contains(v)) && range.contains(&0.0), "{values:?} {range:?}");
        }
    }
}
