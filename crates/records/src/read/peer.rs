//! PEER `.AT2`: three lines of text, one with the number of points and the step, then rows of g.
//!
//! Variants of the fourth line: `NPTS=  4000, DT= .01000 SEC`, with or without a comma at its end (2000, NGA-West2),
//! and `4096    0.0100    NPTS, DT` (2005).

use super::channel::Channel;
use super::source::{Source, after, count, find_any_case, first_number, step};
use crate::Unit;
use mrbd_files::error::InputError;

/// Width of a field, Fortran E15.x.
const FIELD: usize = 15;

pub(super) fn parse(source: &Source) -> Result<Vec<Channel>, InputError> {
    let sizes = source.lines.iter().position(|l| find_any_case(l, "npts").is_some()).unwrap_or(0);
    let unit = unit(source, sizes)?;
    let (points, step_s) = points_and_step(source.line(sizes)).ok_or_else(|| {
        source.fault_line(sizes, "`NPTS= <number>, DT= <seconds>` or `<number> <seconds> NPTS, DT`")
    })?;
    let (samples, end) = source.block(sizes + 1, points, Some(FIELD))?;
    source.end(end, points)?;
    Ok(vec![Channel { label: String::new(), step_s, unit: Some(unit), samples }])
}

fn unit(source: &Source, header: usize) -> Result<Unit, InputError> {
    let allowed = "a line `ACCELERATION TIME SERIES IN UNITS OF G`";
    let lines = source.lines.iter().take(header).enumerate();
    let stated = lines.filter_map(|(i, line)| after(line, "units of").map(|unit| (i, unit))).next();
    let Some((index, unit)) = stated else {
        return Err(source.fault_line(header.saturating_sub(1), allowed));
    };
    let is_acceleration = find_any_case(source.line(index), "accel").is_some();
    let word = unit.split_whitespace().next().unwrap_or("");
    word.parse().ok().filter(|_| is_acceleration).ok_or_else(|| source.fault_line(index, allowed))
}

fn points_and_step(line: &str) -> Option<(usize, f64)> {
    let (points, step_s) = match (after(line, "npts="), after(line, "dt=")) {
        (Some(points), Some(step_s)) => (first_number(points), first_number(step_s)),
        _ => {
            let mut words = line.split_whitespace();
            (words.next().and_then(first_number), words.next().and_then(first_number))
        }
    };
    Some((count(points)?, step(step_s)?))
}
