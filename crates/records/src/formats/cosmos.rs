//! COSMOS strong-motion data format 1.20, volumes 1 and 2.
//!
//! A channel has thirteen lines of text, then blocks of integers, reals and comments, each announced by a line. The
//! samples follow a line such as `18000 acceleration pts, approx  90 secs, units=cm/sec2 (04),Format=(8f10.6)`.
//!
//! Value 62 of the real header is the step of the samples, in milliseconds; value 63 is their length, in seconds.
//! Values 34 and 35 are those of the raw record, which processing may have sampled anew.

use super::channel::Channel;
use super::source::{Source, after, count, field_width, find_any_case, first_number, step};
use super::{Format, ReadOptions};
use crate::Unit;
use mrbd_files::error::InputError;

pub(super) const FORMAT: Format = Format {
    name: "COSMOS",
    words: "COSMOS V1/V2",
    recognise: |source| find_any_case(source.first_line(), "(format v").is_some(),
    parse,
};

const DATA_MARK: &str = "acceleration pts";
const REALS_MARK: &str = "real-header values";
const FORMAT_MARK: &str = "format=";
/// Indices of values 62 and 63 of the real header.
const STEP_MS: usize = 61;
const LENGTH_S: usize = 62;
/// How far samples × step may be from the whole seconds of the line before the data: they are rounded or cut.
const TEXT_TOLERANCE_S: f64 = 1.5;
/// How far they may be from value 63, in steps: some writers count samples, others the steps between them.
const LENGTH_TOLERANCE_STEPS: f64 = 2.0;
/// The same relative to the length, for values that are rounded.
const LENGTH_TOLERANCE: f64 = 0.01;

/// What the real header states of the samples.
struct Timing {
    step_s: f64,
    /// Samples × step; `None` where the header leaves it unknown.
    length_s: Option<f64>,
}

fn parse(source: &Source, _options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let mut channels = Vec::new();
    let mut label = String::new();
    let mut timing = None;
    let mut index = 0;
    while index < source.lines.len() {
        let line = source.line(index);
        index += 1;
        if let Some(name) = after(line, "sta chan") {
            label = direction(name);
        } else if find_any_case(line, REALS_MARK).is_some() {
            let (header, next) = real_header(source, index - 1)?;
            (timing, index) = (Some(header), next);
        } else if find_any_case(line, DATA_MARK).is_some() {
            let (channel, next) = channel(source, index - 1, std::mem::take(&mut label), timing.take())?;
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

fn real_header(source: &Source, index: usize) -> Result<(Timing, usize), InputError> {
    let line = source.line(index);
    let Some(count) = count(line.split_whitespace().next().and_then(first_number)) else {
        return Err(source.fault_line(index, "`<number> Real-header values follow on …`"));
    };
    let (values, next) = source.block(index + 1, count, field_width(line, FORMAT_MARK))?;
    let Some(step_s) = step(values.get(STEP_MS).map(|ms| ms / 1000.0)) else {
        let found = match values.get(STEP_MS) {
            Some(value) => format!("{value} as value 62 of the real header"),
            None => format!("a real header of {count} values"),
        };
        return Err(source.fault(index, found, "the step in milliseconds as value 62"));
    };
    let length_s = values.get(LENGTH_S).copied().filter(|length_s| *length_s > 0.0);
    Ok((Timing { step_s, length_s }, next))
}

fn channel(
    source: &Source,
    index: usize,
    label: String,
    timing: Option<Timing>,
) -> Result<(Channel, usize), InputError> {
    let line = source.line(index);
    let Some(points) = count(line.split_whitespace().next().and_then(first_number)) else {
        return Err(source.fault_line(index, "`<number> acceleration pts, approx <seconds> secs, units=…`"));
    };
    let Some(timing) = timing else {
        return Err(source.fault_line(index, "a block of real-header values before the samples"));
    };
    timing.check(source, index, points)?;
    let (samples, next) = source.block(index + 1, points, field_width(line, FORMAT_MARK))?;
    Ok((Channel { label, step_s: timing.step_s, unit: Some(unit(source, index)?), samples }, next))
}

impl Timing {
    /// Refuses a step that does not make the stated lengths out of the samples counted on the line at `index`.
    fn check(&self, source: &Source, index: usize, points: usize) -> Result<(), InputError> {
        let step_s = self.step_s;
        let length_s = points as f64 * step_s;
        let text_s = after(source.line(index), "approx").and_then(first_number);
        let tolerance_s = LENGTH_TOLERANCE_STEPS * step_s + LENGTH_TOLERANCE * length_s;
        for (place, stated_s, tolerance_s) in [
            ("on this line", text_s, TEXT_TOLERANCE_S),
            ("as value 63 of the real header", self.length_s, tolerance_s),
        ] {
            if let Some(stated_s) = stated_s.filter(|stated_s| (stated_s - length_s).abs() > tolerance_s) {
                let allowed = format!(
                    "{length_s:.3} s: {points} samples at the {step_s} s of value 62 of the real header"
                );
                return Err(source.fault(index, format!("{stated_s} s {place}"), allowed));
            }
        }
        Ok(())
    }
}

fn unit(source: &Source, index: usize) -> Result<Unit, InputError> {
    let text = after(source.line(index), "units=").unwrap_or("");
    let word = text.split([' ', ',', '(']).find(|word| !word.is_empty()).unwrap_or("");
    word.parse().map_err(|_| {
        source.fault_line(index, "units=cm/sec2 or another unit of acceleration; counts are not")
    })
}
