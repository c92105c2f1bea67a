//! Text as people and files have it: wrapped sentences, aligned tables, escaped markup, percents and dates.

use std::borrow::Cow;

use chrono::DateTime;
use html_escape::encode_quoted_attribute;
use textwrap::{Options, WordSplitter};

/// Width of a terminal's text, columns.
pub const TERMINAL: usize = 100;

/// Breaks a text at spaces into lines of at most `width` columns, each behind `indent` spaces.
pub fn wrapped(text: &str, indent: usize, width: usize) -> String {
    let indent = " ".repeat(indent);
    let options = Options::new(width)
        .initial_indent(&indent)
        .subsequent_indent(&indent)
        .break_words(false)
        .word_splitter(WordSplitter::NoHyphenation);
    textwrap::fill(&text.split_whitespace().collect::<Vec<_>>().join(" "), options)
}

/// Columns side by side: the first to the left, the others to the right, each as wide as its widest cell.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate();
        let padded = cells.map(|(column, (cell, &width))| match column {
            0 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        });
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Text as it stands in XML and HTML, in their attributes too.
pub fn escaped(text: &str) -> Cow<'_, str> {
    encode_quoted_attribute(text)
}

/// A relative deviation as percent with its sign.
pub fn signed_percent(deviation: f64) -> String {
    format!("{:+.1} %", 100.0 * deviation)
}

/// A time (UTC) as people write it, by the civil calendar.
pub fn utc(unix_s: u64) -> String {
    let time = i64::try_from(unix_s).ok().and_then(|unix_s| DateTime::from_timestamp(unix_s, 0));
    time.map_or_else(|| format!("{unix_s} s after 1970"), |time| time.format("%Y-%m-%d %H:%M:%S").to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_lines_are_indented_and_no_longer_than_allowed() {
        let text = "word ".repeat(60);
        let lines = wrapped(&text, 4, TERMINAL);
        assert!(lines.lines().count() > 2);
        assert!(lines.lines().all(|line| line.len() <= TERMINAL && line.starts_with("    word")));
        assert_eq!(lines.split_whitespace().count(), 60);
    }

    #[test]
    fn regress_texts_cannot_become_markup() {
        assert_eq!(escaped("<a b=\"c\"> & 'd'"), "&lt;a b=&quot;c&quot;&gt; &amp; &#x27;d&#x27;");
    }

    #[test]
    fn published_times_of_the_civil_calendar() {
        assert_eq!(utc(0), "1970-01-01 00:00:00");
        assert_eq!(utc(951_782_400), "2000-02-29 00:00:00");
        assert_eq!(utc(1_338_271_203), "2012-05-29 06:00:03");
        assert_eq!(utc(4_102_444_799), "2099-12-31 23:59:59");
    }

    #[test]
    fn regress_columns_line_up_whatever_their_letters() {
        let rows = [vec!["θ".to_owned(), "1".to_owned()], vec!["ab".to_owned(), "100".to_owned()]];
        assert_eq!(aligned(&rows), "θ     1\nab  100");
    }
}
