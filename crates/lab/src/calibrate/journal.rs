//! The journal of a calibration: its simulations as lines of text, each whole or not there.

use std::collections::HashMap;
use std::path::Path;

use super::archive::{Address, Row};
use mrbd_files::error::{Error, InputError, Result};

/// A row as a line: numbers in the shortest form that reads back as the same bits.
pub(super) fn line(row: &Row) -> String {
    let a = &row.address;
    let mut text = format!("{}\t{}\t{}\t{}\t{}\t", a.method, a.test, a.generation, a.index, row.outcome);
    let wme = row.wme.map_or_else(|| "-".to_owned(), |wme| format!("{wme:?}"));
    text.push_str(&wme);
    text.push_str(&format!("\t{}", row.steps));
    text.extend(row.transitions.iter().map(|n| format!("\t{n}")));
    text.extend(row.values.iter().map(|x| format!("\t{x:?}")));
    text.push_str("\t.\n");
    text
}

/// Reads a line back; none for a line that was cut short.
fn parse_line(text: &str) -> Option<Row> {
    let fields = text.strip_suffix("\t.")?.split('\t').collect::<Vec<_>>();
    let (head, tail) = fields.split_at_checked(7)?;
    let (counts, values) = tail.split_at_checked(8)?;
    let counts = counts.iter().map(|n| n.parse().ok()).collect::<Option<Vec<u64>>>()?;
    let address = Address {
        method: head[0].to_owned(),
        test: head[1].parse().ok()?,
        generation: head[2].parse().ok()?,
        index: head[3].parse().ok()?,
    };
    Some(Row {
        address,
        outcome: head[4].to_owned(),
        wme: if head[5] == "-" { None } else { Some(head[5].parse().ok()?) },
        steps: head[6].parse().ok()?,
        transitions: counts.try_into().ok()?,
        values: values.iter().map(|x| x.parse().ok()).collect::<Option<Vec<f64>>>()?,
    })
}

/// The simulations of a journal of this request.
///
/// # Errors
/// An input error for a journal of another calibration; [`Error::Io`] if it cannot be read.
pub(super) fn read_journal(path: &Path, request: &str) -> Result<HashMap<Address, Row>> {
    let text = std::fs::read_to_string(path).map_err(|e| Error::io("read the journal", path, e))?;
    let mut lines = text.lines();
    if lines.next() != Some(request) {
        let allowed = "the output folder of this calibration, with the same inputs and seed, or a new folder";
        return Err(InputError::file(path, "the journal of another calibration", allowed).into());
    }
    Ok(lines.filter_map(parse_line).map(|row| (row.address.clone(), row)).collect())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub fn row() -> Row {
        let address = Address { method: "paper".into(), test: 1, generation: 2, index: 3 };
        let values = vec![0.1 + 0.2, 1.0 / 3.0, 37e3];
        let transitions = [0, 1, 2, 3, 4, 5, 6, 7];
        Row { address, values, wme: Some(1e-300), outcome: "stood".into(), transitions, steps: 9 }
    }

    #[test]
    fn analytic_a_row_reads_back_bit_by_bit_and_a_cut_line_not_at_all() {
        let text = line(&row());
        assert_eq!(parse_line(text.trim_end()), Some(row()));
        let cut = &text[..text.len() - 4];
        assert_eq!(parse_line(cut), None);
        let failed = Row { wme: None, outcome: "failed".into(), ..row() };
        assert_eq!(parse_line(line(&failed).trim_end()), Some(failed));
    }
}
