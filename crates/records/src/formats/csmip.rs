//! CSMIP (CDMG) volume 2: per channel a text header, rows of integers and reals, then the samples.
//!
//! Acceleration, velocity and displacement each follow a line such as
//! ` 3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)`.
//!
//! The line before the data is looked for, because the length of the header changed over the years.

use super::channel::Channel;
use super::source::{Source, after, count, field_width, find_any_case, first_number, step};
use super::{Format, ReadOptions};
use crate::Unit;
use mrbd_files::error::InputError;

pub(super) const FORMAT: Format = Format {
    name: "CSMIP V2",
    words: "CSMIP V2",
    recognise: |source| source.header_has(MARK, HEADER_LINES),
    parse,
};

/// Lines from the top among which the mark stands.
const HEADER_LINES: usize = 80;
const MARK: &str = "points of accel data";
/// Width of a field, Fortran F10.x, where the line before the data ends without a format.
const FIELD: usize = 10;

fn parse(source: &Source, _options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let mut channels = Vec::new();
    let mut label = String::new();
    let mut index = 0;
    while index < source.lines.len() {
        let line = source.line(index);
        if find_any_case(line, MARK).is_some() {
            let (channel, next) = channel(source, index, std::mem::take(&mut label))?;
            channels.push(channel);
            index = next;
            continue;
        }
        if label.is_empty()
            && let Some(name) = after(line, "chan ")
        {
            label = direction(name);
        }
        index += 1;
    }
    Ok(channels)
}

/// `  1:  90 DEG     FROM` gives `90 DEG`.
fn direction(name: &str) -> String {
    let name = name.split_once(':').map_or(name, |(_, direction)| direction).trim();
    name.split("   ").next().unwrap_or("").split('(').next().unwrap_or("").trim().to_owned()
}

fn channel(source: &Source, index: usize, label: String) -> Result<(Channel, usize), InputError> {
    let line = source.line(index);
    let points = count(line.split_whitespace().next().and_then(first_number));
    let step_s = step(after(line, "spaced at").and_then(first_number));
    let (Some(points), Some(step_s), Some(unit)) = (points, step_s, unit(line)) else {
        let allowed = "`<number> POINTS OF ACCEL DATA EQUALLY SPACED AT <seconds> SEC. (UNITS: CM/SEC/SEC)`";
        return Err(source.fault_line(index, allowed));
    };
    let width = field_width(line, ". (").unwrap_or(FIELD);
    let (samples, next) = source.block(index + 1, points, Some(width))?;
    Ok((Channel { label, step_s, unit: Some(unit), samples }, next))
}

/// Older files write `(UNITS: CM/SEC/SEC)`, newer ones `in cm/sec2.`
fn unit(line: &str) -> Option<Unit> {
    let text = after(line, "units:").or_else(|| after(line, " in "))?;
    text.split([' ', ')', '(']).find(|word| !word.is_empty())?.parse().ok()
}
