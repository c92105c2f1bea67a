//! Telling formats apart by what the file says.

use std::fmt;

use super::source::{Source, find_any_case, number};
use mrbd_files::error::InputError;

/// A format of record files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// CSV with a header such as `time_s,acceleration_m_s2`.
    TwoColumn,
    /// One sample a line.
    OneColumn,
    /// PEER `.AT2`.
    Peer,
    /// ESM and ITACA, DYNA ASCII.
    Dyna,
    /// GeoNet `.V1A` and `.V2A`.
    GeoNet,
    /// COSMOS, volumes 1 and 2.
    Cosmos,
    /// CSMIP (CDMG) volume 2.
    Csmip,
    /// K-NET and KiK-net ASCII.
    Knet,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::TwoColumn => "two columns",
            Format::OneColumn => "one column",
            Format::Peer => "PEER AT2",
            Format::Dyna => "ESM/ITACA DYNA",
            Format::GeoNet => "GeoNet",
            Format::Cosmos => "COSMOS",
            Format::Csmip => "CSMIP V2",
            Format::Knet => "K-NET",
        })
    }
}

/// Lines from the top among which a format shows itself: the longest header is that of ESM, 64 lines.
const HEADER_LINES: usize = 80;
/// PEER puts its counts on line 4; older files have a line more or less.
const PEER_HEADER_LINES: usize = 8;

const KNOWN: &str = "a record: CSV with header `time_s,acceleration_m_s2`, one number a line, PEER AT2, ESM/ITACA \
    DYNA, GeoNet V1A or V2A, COSMOS, CSMIP V2 or K-NET";

/// Recognises the format.
pub(super) fn recognise(source: &Source) -> Result<Format, InputError> {
    let Some(first) = source.lines.iter().position(|l| !is_blank_or_comment(l)) else {
        return Err(source.fault_file("no data", KNOWN));
    };
    let line = source.line(first);
    let header_has = |word: &str, lines: usize| {
        source.lines.iter().skip(first).take(lines).any(|l| find_any_case(l, word).is_some())
    };
    let starts = |word: &str| find_any_case(line.trim_start(), word) == Some(0);
    if starts("time_s") {
        Ok(Format::TwoColumn)
    } else if starts("event_name:") {
        Ok(Format::Dyna)
    } else if starts("origin time") {
        Ok(Format::Knet)
    } else if find_any_case(line, "(format v").is_some() {
        Ok(Format::Cosmos)
    } else if header_has("points of accel data", HEADER_LINES) {
        Ok(Format::Csmip)
    } else if find_any_case(line, "corrected accelerogram").is_some() && header_has("component ", 16) {
        Ok(Format::GeoNet)
    } else if header_has("npts", PEER_HEADER_LINES) {
        Ok(Format::Peer)
    } else {
        columns(source, first)
    }
}

fn columns(source: &Source, first: usize) -> Result<Format, InputError> {
    let line = source.line(first);
    let fields: Vec<&str> = line.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';')).collect();
    let fields: Vec<&str> = fields.into_iter().filter(|f| !f.is_empty()).collect();
    let numbers = fields.iter().filter(|f| number(f).is_some()).count();
    match (fields.len(), numbers) {
        (1, 1) => Ok(Format::OneColumn),
        (2.., n) if n == fields.len() => Err(source.fault_line(
            first,
            "one number a line, or two columns under the header line `time_s,acceleration_m_s2`",
        )),
        _ => Err(source.fault_line(first, KNOWN)),
    }
}

/// Whether a line of a column file carries no data.
pub(super) fn is_blank_or_comment(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with('#')
}
