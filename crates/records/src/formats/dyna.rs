//! ESM and ITACA ASCII, DYNA 1.x: 64 header lines `KEY: value`, then one sample a line.

use super::channel::Channel;
use super::source::{Source, count, first_number, step};
use super::{Format, ReadOptions};
use crate::Unit;
use mrbd_files::error::InputError;

pub(super) const FORMAT: Format = Format {
    name: "ESM/ITACA DYNA",
    words: "ESM/ITACA DYNA",
    recognise: |source| source.starts_with("event_name:"),
    parse,
};

fn parse(source: &Source, _options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let header = source.lines.iter().position(|l| !l.contains(':')).unwrap_or(source.lines.len());
    check_quantity(source, header)?;
    let (index, text) = value(source, header, "SAMPLING_INTERVAL_S")?;
    let step_s = step(first_number(text)).ok_or_else(|| source.fault_line(index, "a step in seconds"))?;
    let (index, text) = value(source, header, "NDATA")?;
    let points = count(first_number(text)).ok_or_else(|| source.fault_line(index, "a number of samples"))?;
    let (index, text) = value(source, header, "UNITS")?;
    let unit: Unit =
        text.parse().map_err(|_| source.fault_line(index, "a unit of acceleration such as cm/s^2"))?;
    let label = value(source, header, "STREAM").map_or("", |(_, text)| text).to_owned();
    let (samples, end) = source.block(header, points, None)?;
    source.end(end, points)?;
    Ok(vec![Channel { label, step_s, unit: Some(unit), samples }])
}

fn check_quantity(source: &Source, header: usize) -> Result<(), InputError> {
    match value(source, header, "DATA_TYPE") {
        Ok((index, text)) if !text.eq_ignore_ascii_case("acceleration") => {
            Err(source.fault_line(index, "DATA_TYPE: ACCELERATION"))
        }
        _ => Ok(()),
    }
}

fn value<'a>(source: &Source<'a>, header: usize, key: &str) -> Result<(usize, &'a str), InputError> {
    let lines = source.lines.iter().take(header).enumerate();
    let pairs = lines.filter_map(|(index, line)| Some((index, line.split_once(':')?)));
    let found = pairs
        .filter(|(_, (name, _))| name.trim() == key)
        .map(|(index, (_, text))| (index, text.trim()))
        .next();
    found.ok_or_else(|| source.fault_file(format!("no `{key}:` in the {header} header lines"), "this key"))
}
