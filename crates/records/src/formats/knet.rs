//! K-NET and KiK-net ASCII: seventeen header lines, then counts; acceleration is (count − mean) × scale factor.
//!
//! National Research Institute for Earth Science and Disaster Resilience, Japan.

use super::channel::Channel;
use super::source::{Source, after, count, first_number, step};
use super::{Format, ReadOptions};
use crate::Unit;
use mrbd_files::error::InputError;

pub(super) const FORMAT: Format = Format {
    name: "K-NET",
    words: "K-NET/KiK-net",
    recognise: |source| source.starts_with("origin time"),
    parse,
};

fn parse(source: &Source, _options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let memo = source.lines.iter().position(|l| l.starts_with("Memo."));
    let Some(memo) = memo else {
        return Err(source.fault_file("no line `Memo.`", "a K-NET header of 17 lines that ends with it"));
    };
    let frequency_hz = number(source, memo, "Sampling Freq(Hz)")?;
    let duration_s = number(source, memo, "Duration Time(s)")?;
    let step_s = step(Some(1.0 / frequency_hz)).ok_or_else(|| {
        source.fault_file(format!("sampling at {frequency_hz} Hz"), "a step of 1e-6 s to 10 s")
    })?;
    let points = frequency_hz * duration_s;
    // The product of two decimals misses its whole number by rounding only.
    let whole = Some(points.round()).filter(|whole| (whole - points).abs() < 1e-6);
    let points = count(whole).ok_or_else(|| {
        source.fault_file(format!("{duration_s} s at {frequency_hz} Hz"), "a whole number of samples")
    })?;
    let gal_per_count = scale_factor(source, memo)?;
    let (counts, end) = source.block(memo + 1, points, None)?;
    source.end(end, points)?;
    let mean = counts.iter().sum::<f64>() / points as f64;
    let samples = counts.iter().map(|c| (c - mean) * gal_per_count).collect();
    let label = field(source, memo, "Dir.").map_or("", |(_, text)| text).to_owned();
    Ok(vec![Channel { label, step_s, unit: Some(Unit::CentimetrePerSecond2), samples }])
}

fn field<'a>(source: &Source<'a>, memo: usize, key: &str) -> Result<(usize, &'a str), InputError> {
    let lines = source.lines.iter().take(memo).enumerate();
    let found = lines
        .filter(|(_, line)| line.starts_with(key))
        .map(|(index, line)| (index, line[key.len()..].trim()));
    found
        .into_iter()
        .next()
        .ok_or_else(|| source.fault_file(format!("no line `{key}`"), "this line in a K-NET header"))
}

fn number(source: &Source, memo: usize, key: &str) -> Result<f64, InputError> {
    let (index, text) = field(source, memo, key)?;
    first_number(text).filter(|v| *v > 0.0).ok_or_else(|| source.fault_line(index, "a positive number"))
}

/// `3920(gal)/6182761`: gal a count.
fn scale_factor(source: &Source, memo: usize) -> Result<f64, InputError> {
    let (index, text) = field(source, memo, "Scale Factor")?;
    let gal = first_number(text);
    let counts = after(text, "(gal)/").and_then(first_number);
    match (gal, counts) {
        (Some(gal), Some(counts)) if gal > 0.0 && counts > 0.0 => Ok(gal / counts),
        _ => Err(source.fault_line(index, "a scale factor such as 3920(gal)/6182761")),
    }
}
