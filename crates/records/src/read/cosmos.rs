//! COSMOS strong-motion data format 1.20, volumes 1 and 2: per channel thirteen lines of text, blocks of integers,
//! reals and comments, each announced by a line, then the samples under a line such as
//! `18000 acceleration pts, approx  90 secs, units=cm/sec2 (04),Format=(8f10.6)`.
//!
//! The step is real header 34, in milliseconds.

use super::channel::Channel;
use super::source::{Source, after, count, field_width, find_any_case, first_number, step};
use crate::Unit;
use mrbd_files::error::InputError;

const DATA_MARK: &str = "acceleration pts";
const REALS_MARK: &str = "real-header values";
const FORMAT_MARK: &str = "format=";
const STEP_MS: usize = 33;
/// How far samples × step may be from the whole seconds of the line before the data: they are rounded or cut.
const DURATION_TOLERANCE_S: f64 = 1.5;

pub(super) fn parse(source: &Source) -> Result<Vec<Channel>, InputError> {
    let mut channels = Vec::new();
    let mut label = String::new();
    let mut step_s = None;
    let mut index = 0;
    while index < source.lines.len() {
        let line = source.line(index);
        index += 1;
        if let Some(name) = after(line, "sta chan") {
            label = direction(name);
        } else if find_any_case(line, REALS_MARK).is_some() {
            (step_s, index) = real_header(source, index - 1)?;
        } else if find_any_case(line, DATA_MARK).is_some() {
            let (channel, next) = channel(source, index - 1, std::mem::take(&mut label), step_s.take())?;
            channels.push(channel);
            index = next;
        }
    }
    if channels.is_empty() {
        return Err(
            source.fault_file("no line `<number> acceleration pts, …`", "a COSMOS file of acceleration")
        );
    }
    Ok(channels)
}

/// `  1: 90 deg (Rcrdr Chan  1) Location:` gives `90 deg`.
fn direction(name: &str) -> String {
    let name = name.split_once(':').map_or(name, |(_, direction)| direction);
    name.split('(').next().unwrap_or("").trim().to_owned()
}

fn real_header(source: &Source, index: usize) -> Result<(Option<f64>, usize), InputError> {
    let line = source.line(index);
    let Some(points) = count(line.split_whitespace().next().and_then(first_number)) else {
        return Err(source.fault_line(index, "`<number> Real-header values follow on …`"));
    };
    let (values, next) = source.block(index + 1, points, field_width(line, FORMAT_MARK))?;
    let step_s = step(values.get(STEP_MS).map(|ms| ms / 1000.0));
    if step_s.is_none() {
        let found = format!("{:?} as value 34 of the real header", values.get(STEP_MS));
        return Err(source.fault(index, found, "the step in milliseconds"));
    }
    Ok((step_s, next))
}

fn channel(
    source: &Source,
    index: usize,
    label: String,
    step_s: Option<f64>,
) -> Result<(Channel, usize), InputError> {
    let line = source.line(index);
    let Some(points) = count(line.split_whitespace().next().and_then(first_number)) else {
        return Err(source.fault_line(index, "`<number> acceleration pts, approx <seconds> secs, units=…`"));
    };
    let Some(step_s) = step_s else {
        return Err(source.fault_line(index, "a block of real-header values before the samples"));
    };
    check_duration(source, index, points as f64 * step_s)?;
    let (samples, next) = source.block(index + 1, points, field_width(line, FORMAT_MARK))?;
    Ok((Channel { label, step_s, unit: Some(unit(source, index)?), samples }, next))
}

fn check_duration(source: &Source, index: usize, duration_s: f64) -> Result<(), InputError> {
    match after(source.line(index), "approx").and_then(first_number) {
        Some(said) if (said - duration_s).abs() > DURATION_TOLERANCE_S => {
            let found = format!("about {said} s");
            Err(source.fault(index, found, format!("{duration_s:.2} s, by the step of the real header")))
        }
        _ => Ok(()),
    }
}

fn unit(source: &Source, index: usize) -> Result<Unit, InputError> {
    let text = after(source.line(index), "units=").unwrap_or("");
    let word = text.split([' ', ',', '(']).find(|word| !word.is_empty()).unwrap_or("");
    word.parse().map_err(|_| {
        source.fault_line(index, "units=cm/sec2 or another unit of acceleration; counts are not")
    })
}
