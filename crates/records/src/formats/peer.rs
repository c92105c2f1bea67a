//! PEER `.AT2`: three lines of text, one with the number of points and the step, then rows of g.
//!
//! Variants of the third line: `ACCELERATION TIME SERIES IN UNITS OF G`, and `The units are (g)` (examples of OpenSees).
//! Variants of the fourth line: `NPTS=  4000, DT= .01000 SEC` (2000), the same with a comma at its end (NGA-West2), and
//! `4096    0.0100    NPTS, DT` (2005).

use super::channel::Channel;
use super::source::{Source, after, count, find_any_case, first_number, step};
use super::{Format, ReadOptions};
use crate::Unit;
use mrbd_files::error::InputError;

pub(super) const FORMAT: Format = Format {
    name: "PEER AT2",
    words: "PEER AT2",
    recognise: |source| source.header_has("npts", HEADER_LINES),
    parse,
};

/// What stands before the unit.
const UNIT_MARKS: [&str; 2] = ["units of", "units are"];
/// Files of velocity and displacement are written alike.
const OTHER_QUANTITIES: [&str; 2] = ["veloc", "displ"];
/// The sizes stand on line 4; older files have a line more or less.
const HEADER_LINES: usize = 8;
/// Width of a field, Fortran E15.x.
const FIELD: usize = 15;

fn parse(source: &Source, _options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
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
    let allowed = "a line `ACCELERATION TIME SERIES IN UNITS OF G` or `The units are (g)`";
    let stated = |line| UNIT_MARKS.iter().find_map(|mark| after(line, mark));
    let mut lines = source.lines.iter().take(header).enumerate();
    let Some((index, text)) = lines.find_map(|(i, line)| stated(line).map(|text| (i, text))) else {
        return Err(source.fault_line(header.saturating_sub(1), allowed));
    };
    let is_other = OTHER_QUANTITIES.iter().any(|word| find_any_case(source.line(index), word).is_some());
    let word = text
        .split(|c: char| c.is_whitespace() || "().".contains(c))
        .find(|word| !word.is_empty())
        .unwrap_or("");
    word.parse().ok().filter(|_| !is_other).ok_or_else(|| source.fault_line(index, allowed))
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
