//! Columns of numbers: two under the header `time_s,acceleration_m_s2`, which states everything, or one alone.

use std::fmt::Write;
use std::path::Path;

use csv::StringRecord;

use super::channel::Channel;
use super::chosen::HOW;
use super::source::{Source, fields, is_blank_or_comment, number, quote, step};
use super::{Format, ReadOptions};
use crate::{Accelerogram, Unit};
use mrbd_files::error::{Error, InputError, Result};

pub(super) const TWO_COLUMNS: Format = Format {
    name: "two columns",
    words: "CSV with header `time_s,acceleration_m_s2`",
    recognise: |source| source.starts_with("time_s"),
    parse: two_columns,
};

/// Without a header: the step comes from the caller, and the unit is m/s² unless the caller gives another.
pub(super) const ONE_COLUMN: Format = Format {
    name: "one column",
    words: "one number a line",
    recognise: |source| matches!(fields(source.first_line())[..], [field] if number(field).is_some()),
    parse: one_column,
};

/// How far a written time may lie from its place, in steps: rounding to a decimal stays below,
/// a missing or doubled sample shifts what follows by a whole step.
const TIME_TOLERANCE_STEPS: f64 = 0.25;

const HEADERS: [(&str, Unit); 4] = [
    ("acceleration_m_s2", Unit::MetrePerSecond2),
    ("acceleration_g", Unit::G),
    ("acceleration_cm_s2", Unit::CentimetrePerSecond2),
    ("acceleration_mm_s2", Unit::MillimetrePerSecond2),
];

fn two_columns(source: &Source, _options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let text = source.lines.join("\n");
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .flexible(true)
        .has_headers(false)
        .from_reader(text.as_bytes());
    let mut rows = reader.records();
    let unit = unit(source, rows.next())?;
    let mut lines = Vec::new();
    let mut times = Vec::new();
    let mut samples = Vec::new();
    for row in rows {
        let (line, [time, sample]) = numbers(source, row)?;
        lines.push(line);
        times.push(time);
        samples.push(sample);
    }
    let step_s = uniform_step(source, &lines, &times)?;
    Ok(vec![Channel { label: String::new(), step_s, unit: Some(unit), samples }])
}

fn unit(source: &Source, header: Option<csv::Result<StringRecord>>) -> Result<Unit, InputError> {
    let allowed = format!("two columns headed `time_s,acceleration_m_s2` (or _g, _cm_s2, _mm_s2); {HOW}");
    let (line, row) = row(source, header.unwrap_or_else(|| Ok(StringRecord::new())))?;
    let unit = HEADERS.iter().find(|(name, _)| row.get(1).is_some_and(|h| h.eq_ignore_ascii_case(name)));
    match (row.get(0), unit, row.len()) {
        (Some(time), Some(&(_, unit)), 2) if time.eq_ignore_ascii_case("time_s") => Ok(unit),
        _ => Err(source.fault_line(line, allowed)),
    }
}

fn row(source: &Source, row: csv::Result<StringRecord>) -> Result<(usize, StringRecord), InputError> {
    let row = row.map_err(|e| {
        let line = e.position().map_or(0, |p| p.line().saturating_sub(1) as usize);
        source.fault(line, e.to_string(), "a row of CSV")
    })?;
    let line = row.position().map_or(0, |p| p.line().saturating_sub(1) as usize);
    Ok((line, row))
}

fn numbers(source: &Source, read: csv::Result<StringRecord>) -> Result<(usize, [f64; 2]), InputError> {
    let (line, fields) = row(source, read)?;
    if fields.len() != 2 {
        return Err(source.fault(line, format!("{} columns", fields.len()), "2 columns"));
    }
    let value = |i: usize| {
        let field = &fields[i];
        number(field).ok_or_else(|| source.fault(line, quote(field), "a finite number"))
    };
    Ok((line, [value(0)?, value(1)?]))
}

/// The step between times on these lines.
///
/// # Errors
/// Input errors for fewer than two times, or times that are not at equal steps.
pub(super) fn uniform_step(source: &Source, lines: &[usize], times: &[f64]) -> Result<f64, InputError> {
    let [first, .., last] = times else {
        return Err(source.fault_file(format!("{} samples", times.len()), "at least 2"));
    };
    let mean = (last - first) / (times.len() - 1) as f64;
    let Some(step_s) = step(Some(tidy(mean))) else {
        return Err(source.fault_file(format!("a mean step of {mean} s"), "rising times in seconds"));
    };
    for (i, time) in times.iter().enumerate() {
        let place = first + i as f64 * step_s;
        if (time - place).abs() > TIME_TOLERANCE_STEPS * step_s {
            let allowed =
                format!("equal steps: {place:.6} s for sample {}, the mean step being {step_s} s", i + 1);
            return Err(source.fault(lines[i], format!("time {time} s"), allowed));
        }
    }
    Ok(step_s)
}

/// Takes off the noise that the division leaves in the last digits: 0.005000000000000001 becomes 0.005.
fn tidy(step_s: f64) -> f64 {
    format!("{step_s:.9e}").parse().unwrap_or(step_s)
}

fn one_column(source: &Source, options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let Some(step_s) = options.step_s else {
        let allowed =
            "a step in seconds, which a single column does not state: `--dt`, or `step_s` in the suite";
        return Err(source.fault_file("one column and no step", allowed));
    };
    let mut samples = Vec::new();
    for (index, line) in source.lines.iter().enumerate().filter(|(_, line)| !is_blank_or_comment(line)) {
        samples.push(number(line.trim()).ok_or_else(|| source.fault_line(index, "one finite number"))?);
    }
    Ok(vec![Channel { label: String::new(), step_s, unit: None, samples }])
}

/// Most decimals of a written time, s.
const MOST_DECIMALS: usize = 9;

/// Writes a record as two columns; read back, its samples are the same to the bit.
///
/// # Errors
/// Where the file cannot be written.
pub fn write_two_columns(path: &Path, record: &Accelerogram) -> Result<()> {
    std::fs::write(path, text_of(record)).map_err(|e| Error::io("write the record", path, e))
}

fn text_of(record: &Accelerogram) -> String {
    let step = record.step_s();
    let decimals = decimals(step);
    let mut text = String::from("time_s,acceleration_m_s2\n");
    for (i, a) in record.acceleration_m_s2().iter().enumerate() {
        // Adding zero takes the sign off a negative zero; writing to a string does not fail.
        let _written = writeln!(text, "{:.decimals$},{}", i as f64 * step, a + 0.0);
    }
    text
}

/// Decimals that write every multiple of the step; for steps that no few decimals write, the most.
fn decimals(step_s: f64) -> usize {
    let writes = |decimals: &usize| {
        let scaled = step_s * 10_f64.powi(*decimals as i32);
        scaled >= 1.0 && (scaled - scaled.round()).abs() < 1e-6
    };
    (2..MOST_DECIMALS).find(writes).unwrap_or(MOST_DECIMALS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_times_are_written_with_the_decimals_they_need() {
        for (step, expected) in [(0.01, 2), (0.005, 3), (0.0078125, 7), (0.1, 2), (1.0 / 3.0, 9)] {
            assert_eq!(decimals(step), expected, "{step}");
        }
        let record = Accelerogram::new(0.005, vec![0.0, -0.0, 0.1 + 0.2]).expect("valid");
        let expected = "time_s,acceleration_m_s2\n0.000,0\n0.005,0\n0.010,0.30000000000000004\n";
        assert_eq!(text_of(&record), expected);
    }
}
