//! GeoNet (GNS Science) `.V1A` and `.V2A`.
//!
//! A component has 16 lines of text, four rows of ten integers and six of ten reals. Acceleration in mm/s² follows, in
//! volume 2 with velocity and displacement, ten to a row in fields of 8.

use super::channel::Channel;
use super::source::{Source, after, count, find_any_case, first_number, step};
use super::{Format, ReadOptions};
use crate::Unit;
use mrbd_files::error::InputError;

pub(super) const FORMAT: Format = Format {
    name: "GeoNet",
    words: "GeoNet V1A/V2A",
    recognise: |source| {
        find_any_case(source.first_line(), "corrected accelerogram").is_some()
            && source.header_has("component ", TEXT_LINES)
    },
    parse,
};

const TEXT_LINES: usize = 16;
const HEADER_NUMBERS: usize = 100;
const FIELD: usize = 8;
/// Numbers of the header: samples of acceleration, velocity and displacement; what gives mm/s² in volume 1; the step, s.
const POINTS: std::ops::Range<usize> = 33..36;
const RAW_FACTOR: usize = 47;
const STEP: usize = 65;
/// Relative difference allowed between the step of the numbers and that of the text, which is rounded to 1 ms.
const STEP_TOLERANCE: f64 = 0.1;

fn parse(source: &Source, _options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let mut channels = Vec::new();
    let mut index = 0;
    while source.lines.iter().skip(index).any(|line| !line.trim().is_empty()) {
        let (channel, next) = component(source, index)?;
        channels.push(channel);
        index = next;
    }
    Ok(channels)
}

fn component(source: &Source, start: usize) -> Result<(Channel, usize), InputError> {
    let is_raw = is_raw(source, start)?;
    let (header, data) = source.block(start + TEXT_LINES, HEADER_NUMBERS, Some(FIELD))?;
    let step_s = read_step(source, start, header[STEP])?;
    let factor = if is_raw { header[RAW_FACTOR] } else { 1.0 };
    if factor <= 0.0 {
        let found = format!("a factor of {factor} to mm/s/s");
        return Err(source.fault(start + TEXT_LINES + 4, found, "a positive factor"));
    }
    let (samples, next) = quantities(source, start, data, &header[POINTS])?;
    let samples = samples.iter().map(|a| a * factor).collect();
    let label = label(source, start);
    Ok((Channel { label, step_s, unit: Some(Unit::MillimetrePerSecond2), samples }, next))
}

/// Whether a component is of volume 1.
fn is_raw(source: &Source, start: usize) -> Result<bool, InputError> {
    let is = |word: &str| find_any_case(source.line(start), word).is_some();
    match (is("uncorrected accelerogram"), is("corrected accelerogram")) {
        (false, false) => {
            Err(source.fault_line(start, "`Corrected accelerogram` or `Uncorrected accelerogram`"))
        }
        (is_raw, _) => Ok(is_raw),
    }
}

/// Acceleration, and the line after velocity and displacement, which volume 1 leaves out.
fn quantities(
    source: &Source,
    start: usize,
    data: usize,
    points: &[f64],
) -> Result<(Vec<f64>, usize), InputError> {
    let acceleration = count(points.first().copied());
    let Some(acceleration) = acceleration else {
        return Err(
            source.fault_line(start + TEXT_LINES + 3, "a number of samples of at least 2 as fourth number")
        );
    };
    let (samples, mut next) = source.block(data, acceleration, Some(FIELD))?;
    for &points in points.iter().skip(1).filter(|&&points| points != 0.0) {
        let Some(points) = count(Some(points)) else {
            return Err(source.fault_line(start + TEXT_LINES + 3, "whole numbers of samples"));
        };
        (_, next) = source.block(next, points, Some(FIELD))?;
    }
    Ok((samples, next))
}

/// The step of the numbers, once it agrees with the text.
///
/// The text says `… data at 0.020 sec intervals` or `… at intervals of 0.005 s`.
fn read_step(source: &Source, start: usize, stated: f64) -> Result<f64, InputError> {
    let mut lines = (start..start + TEXT_LINES)
        .map(|i| source.line(i))
        .filter(|l| find_any_case(l, "interval").is_some());
    let words =
        |line: &'_ str| after(line, "intervals of").or_else(|| after(line, " at ")).and_then(first_number);
    let text = step(lines.next().and_then(words));
    match (step(Some(stated)), text) {
        (Some(step_s), Some(text)) if (step_s - text).abs() > STEP_TOLERANCE * text => {
            let found = format!("a step of {text} s in the text of the header");
            Err(source.fault(start, found, format!("the {step_s} s of its numbers")))
        }
        (Some(step_s), _) | (None, Some(step_s)) => Ok(step_s),
        (None, None) => Err(source.fault(start, format!("a step of {stated} s"), "a step of 1e-6 s to 10 s")),
    }
}

/// `Component S16W  Longitudinal Accelerometer Axis` gives `S16W Longitudinal`.
fn label(source: &Source, start: usize) -> String {
    let line = (start..start + TEXT_LINES).find_map(|i| after(source.line(i), "component "));
    let words: Vec<&str> = line.unwrap_or("").split_whitespace().take(2).collect();
    words.join(" ")
}
