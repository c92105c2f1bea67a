//! GeoNet (GNS Science) `.V1A` and `.V2A`: per component 16 lines of text, four rows of ten integers, six of ten
//! reals, then acceleration in mm/s² and, in volume 2, velocity and displacement, ten to a row in fields of 8.

use super::channel::Channel;
use super::source::{Source, after, count, find_any_case, first_number, step};
use crate::error::InputError;
use crate::ground::Unit;

const TEXT_LINES: usize = 16;
const HEADER_NUMBERS: usize = 100;
const FIELD: usize = 8;
/// Samples of the uncorrected record, and of corrected acceleration, velocity and displacement.
const RAW_POINTS: usize = 30;
const CORRECTED_POINTS: usize = 33;
/// Step of the uncorrected and of the corrected record, s.
const RAW_STEP: usize = 64;
const CORRECTED_STEP: usize = 65;
/// Relative difference allowed between the step of the numbers and that of the text, which is rounded to 1 ms.
const STEP_TOLERANCE: f64 = 0.1;

pub(super) fn parse(source: &Source) -> Result<Vec<Channel>, InputError> {
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
    let is_raw = find_any_case(source.line(start), "uncorrected accelerogram").is_some();
    if !is_raw && find_any_case(source.line(start), "corrected accelerogram").is_none() {
        return Err(source.fault_line(start, "`Corrected accelerogram` or `Uncorrected accelerogram`"));
    }
    let (header, data) = source.block(start + TEXT_LINES, HEADER_NUMBERS, Some(FIELD))?;
    let step_s = read_step(source, start, header[if is_raw { RAW_STEP } else { CORRECTED_STEP }])?;
    let counts = if is_raw {
        &header[RAW_POINTS..=RAW_POINTS]
    } else {
        &header[CORRECTED_POINTS..CORRECTED_POINTS + 3]
    };
    let mut next = data;
    let mut samples = Vec::new();
    for (quantity, &points) in counts.iter().enumerate() {
        if quantity > 0 && points == 0.0 {
            continue;
        }
        let Some(points) = count(Some(points)) else {
            let found = format!("{points} points in the numbers of the header");
            return Err(source.fault(start + TEXT_LINES + 3, found, "a whole number of at least 2"));
        };
        let (values, end) = source.block(next, points, Some(FIELD))?;
        next = end;
        if quantity == 0 {
            samples = values;
        }
    }
    let label = label(source, start);
    Ok((Channel { label, step_s, unit: Some(Unit::MillimetrePerSecond2), samples }, next))
}

/// The step of the numbers, once it agrees with `… data at 0.020 sec intervals` where the text says so.
fn read_step(source: &Source, start: usize, stated: f64) -> Result<f64, InputError> {
    let mut lines =
        (start..start + TEXT_LINES).filter(|&i| find_any_case(source.line(i), "sec interval").is_some());
    let text = lines.next().and_then(|i| first_number(after(source.line(i), " at ")?));
    let text = step(text);
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
