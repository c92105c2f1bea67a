//! A record file as lines of text, and the numbers on them.

use std::borrow::Cow;
use std::path::Path;

use mrbd_files::error::InputError;

/// Longest piece of a file that a fault quotes, characters.
const QUOTE_CHARS: usize = 60;

/// The lines of a file, and its name for faults. Line indices count from 0, lines in faults from 1.
pub(super) struct Source<'a> {
    pub path: &'a Path,
    pub lines: Vec<&'a str>,
    /// Index of the first line that is neither blank nor a comment; `None` where all are.
    pub first: Option<usize>,
}

/// Whether a line of a column file carries no data.
pub(super) fn is_blank_or_comment(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with('#')
}

/// The fields of a line of numbers, between blanks, commas or semicolons.
pub(super) fn fields(line: &str) -> Vec<&str> {
    let fields = line.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';'));
    fields.filter(|field| !field.is_empty()).collect()
}

/// Text of `bytes`: UTF-8; UTF-16 behind its mark, as spreadsheets save it; or else Latin-1, in which some agencies
/// write station names.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    for (mark, unit) in
        [(b"\xff\xfe", u16::from_le_bytes as fn([u8; 2]) -> u16), (b"\xfe\xff", u16::from_be_bytes)]
    {
        if let Some(text) = bytes.strip_prefix(mark) {
            let units: Vec<u16> = text.chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
            return Cow::Owned(String::from_utf16_lossy(&units));
        }
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect()),
    }
}

impl<'a> Source<'a> {
    pub fn new(path: &'a Path, text: &'a str) -> Self {
        let lines: Vec<&str> = text.lines().collect();
        let first = lines.iter().position(|line| !is_blank_or_comment(line));
        Self { path, lines, first }
    }

    /// The first line that is neither blank nor a comment; an empty one where all are.
    pub fn first_line(&self) -> &'a str {
        self.first.map_or("", |index| self.line(index))
    }

    /// Whether the first line begins with `word`, letters of any case.
    pub fn starts_with(&self, word: &str) -> bool {
        find_any_case(self.first_line().trim_start(), word) == Some(0)
    }

    /// Whether one of the first `lines` lines holds `word`, letters of any case.
    pub fn header_has(&self, word: &str, lines: usize) -> bool {
        let header = self.lines.iter().skip(self.first.unwrap_or(0)).take(lines);
        header.into_iter().any(|line| find_any_case(line, word).is_some())
    }

    /// The line at `index`; past the end, an empty one.
    pub fn line(&self, index: usize) -> &'a str {
        self.lines.get(index).copied().unwrap_or("")
    }

    /// A fault on the line at `index`.
    pub fn fault(&self, index: usize, found: impl Into<String>, allowed: impl Into<String>) -> InputError {
        InputError::line(self.path, index + 1, found, allowed)
    }

    /// A fault that quotes the line at `index`.
    pub fn fault_line(&self, index: usize, allowed: impl Into<String>) -> InputError {
        self.fault(index, quote(self.line(index)), allowed)
    }

    /// A fault in the file as a whole.
    pub fn fault_file(&self, found: impl Into<String>, allowed: impl Into<String>) -> InputError {
        InputError::file(self.path, found, allowed)
    }

    /// Reads exactly `count` numbers from the line at `start` on; also gives the index of the line after them.
    ///
    /// `width` is the width of a Fortran field, needed where fields touch.
    pub fn block(
        &self,
        start: usize,
        count: usize,
        width: Option<usize>,
    ) -> Result<(Vec<f64>, usize), InputError> {
        // No allocation by what a header claims: the numbers found set the size.
        let mut values = Vec::new();
        let mut index = start;
        while values.len() < count {
            let allowed = || format!("{count} numbers from line {} on", start + 1);
            let Some(line) = self.lines.get(index) else {
                let found = format!("the end of the file after {} numbers", values.len());
                return Err(self.fault(index, found, allowed()));
            };
            if !self.append_numbers(index, line, width, &mut values)? {
                return Err(self.fault_line(index, allowed()));
            }
            index += 1;
        }
        if values.len() > count {
            let found = format!("{} numbers from line {} to here", values.len(), start + 1);
            return Err(self.fault(index - 1, found, format!("{count} numbers, as the header says")));
        }
        Ok((values, index))
    }

    /// Refuses anything but blank lines from `index` on.
    pub fn end(&self, index: usize, count: usize) -> Result<(), InputError> {
        let rest = self.lines.iter().enumerate().skip(index).find(|(_, line)| !line.trim().is_empty());
        match rest {
            None => Ok(()),
            Some((extra, _)) => {
                let allowed = format!("the end of the file after {count} samples, as the header says");
                Err(self.fault_line(extra, allowed))
            }
        }
    }

    /// Appends the numbers of a line; `false` where the line is blank.
    fn append_numbers(
        &self,
        index: usize,
        line: &str,
        width: Option<usize>,
        values: &mut Vec<f64>,
    ) -> Result<bool, InputError> {
        let before = values.len();
        for field in line.split_whitespace() {
            match number(field) {
                Some(value) => values.push(value),
                None => {
                    values.truncate(before);
                    let fixed = width.and_then(|width| fixed_width(line, width));
                    values.extend(fixed.ok_or_else(|| self.fault(index, quote(field), "a finite number"))?);
                    break;
                }
            }
        }
        Ok(values.len() > before)
    }
}

/// A finite number, with the exponent letters of Fortran allowed.
pub(super) fn number(field: &str) -> Option<f64> {
    let value: f64 = match field.parse() {
        Ok(value) => value,
        Err(_) => field.replace(['D', 'd'], "E").parse().ok()?,
    };
    value.is_finite().then_some(value)
}

fn fixed_width(line: &str, width: usize) -> Option<Vec<f64>> {
    if !line.is_ascii() {
        return None;
    }
    let line = line.trim_end().as_bytes();
    line.chunks(width).map(|field| number(std::str::from_utf8(field).ok()?.trim())).collect()
}

/// The beginning of a piece of a file, in quotes.
pub(super) fn quote(text: &str) -> String {
    let text = text.trim();
    let start: String = text.chars().take(QUOTE_CHARS).collect();
    let dots = if start.len() < text.len() { "…" } else { "" };
    format!("`{}{dots}`", start.escape_debug())
}

/// The first number in `text`.
pub(super) fn first_number(text: &str) -> Option<f64> {
    let start = text.find(|c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'))?;
    let rest = &text[start..];
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'E' | 'e');
    let end = rest.find(|c: char| !is_part(c)).unwrap_or(rest.len());
    // "100Hz" and ".005E" alike: a trailing letter, dot of a sentence or sign is no part of the number.
    number(rest[..end].trim_end_matches(['E', 'e', '+', '-']))
}

/// What follows `word` in `text`, letters of any case.
pub(super) fn after<'t>(text: &'t str, word: &str) -> Option<&'t str> {
    let at = find_any_case(text, word)?;
    Some(&text[at + word.len()..])
}

/// Where the ASCII `word` stands in `text`, letters of any case.
pub(super) fn find_any_case(text: &str, word: &str) -> Option<usize> {
    text.as_bytes().windows(word.len().max(1)).position(|part| part.eq_ignore_ascii_case(word.as_bytes()))
}

/// A count that a header states: a whole number of at least 2, small enough for a file.
pub(super) fn count(value: Option<f64>) -> Option<usize> {
    value.filter(|n| (2.0..1e9).contains(n) && n.fract() == 0.0).map(|n| n as usize)
}

/// A step that a header states: from a microsecond to ten seconds.
pub(super) fn step(value: Option<f64>) -> Option<f64> {
    value.filter(|s| (1e-6..=10.0).contains(s))
}

/// Width of the fields of the Fortran format, such as `(8f10.6)`, that follows `mark`.
pub(super) fn field_width(line: &str, mark: &str) -> Option<usize> {
    let format = after(line, mark)?;
    let width = format.split(|c: char| c.is_ascii_alphabetic()).nth(1)?;
    width.split(['.', ')']).next()?.trim().parse().ok().filter(|w| (1..=40).contains(w))
}
