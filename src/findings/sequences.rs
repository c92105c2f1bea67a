//! What a study of sequences says, for people: what a record does after others, beside what it does alone.

use std::io::{self, Write};

use super::report::{assumptions, heading, unfinished};
use crate::aggregate::{After, Sequences};
use crate::text::{TERMINAL, aligned, wrapped};

/// Rows by sequence that still can be read; more are in the table.
const MOST_ROWS: usize = 60;

/// What the numbers of such a study mean.
pub const AFTER_RULES: &str = "Each wall that stood what came before is compared with the same wall under the record \
    alone. Ratio: largest rotation after over alone, of walls that stand alone and rotate; one that falls after ranks \
    above all numbers. Only after: of walls that stand alone, those that fall after. In brackets 90 % intervals over \
    records and walls drawn anew.";

/// What the heads of the table mean.
const HEADS: &str =
    "walls: those compared; before: fell before; alone, after: of those compared, fell alone, and after.";

/// Prints everything.
///
/// # Errors
/// What the stream says.
pub fn report_sequences(out: &mut dyn Write, study: &Sequences) -> io::Result<()> {
    assumptions(out, &study.variants)?;
    unfinished(out, study.completeness)?;
    heading(out, "What a record does after others, beside what it does alone")?;
    writeln!(out, "{}", wrapped(AFTER_RULES, 0, TERMINAL))?;
    writeln!(out, "{}", wrapped(HEADS, 0, TERMINAL))?;
    let (all, by_sequence): (Vec<&After>, Vec<&After>) =
        study.rows.iter().partition(|row| row.sequence.is_none());
    writeln!(out, "\n{}", table(&all))?;
    match by_sequence.len() {
        0..=MOST_ROWS => {
            heading(out, "The same by sequence")?;
            writeln!(out, "{}", table(&by_sequence))
        }
        more => writeln!(out, "\n{more} rows by sequence are in sequences.parquet"),
    }
}

/// Heads of [`after_cells`], and which of them a terminal has room for.
const HEAD: [&str; 13] = [
    "variant",
    "floor",
    "sequence",
    "part",
    "all",
    "before",
    "walls",
    "alone",
    "after",
    "only after",
    "16 %",
    "ratio 50 %",
    "84 %",
];

fn table(rows: &[&After]) -> String {
    let by_sequence = rows.iter().any(|row| row.sequence.is_some());
    let shown =
        |(column, cell): (usize, String)| (column != 4 && (by_sequence || column != 2)).then_some(cell);
    let line = |cells: Vec<String>| cells.into_iter().enumerate().filter_map(shown).collect();
    let mut lines: Vec<Vec<String>> = vec![line(HEAD.map(str::to_owned).to_vec())];
    lines.extend(rows.iter().map(|row| line(after_cells(row))));
    aligned(&lines)
}

/// The cells of a row: variant, floor, sequence, part, counts, the share that falls only after, and the ratio.
pub fn after_cells(row: &After) -> Vec<String> {
    let ratio = |value: Option<f64>| match (value, row.ratios) {
        (Some(value), _) => format!("{value:.3}"),
        (None, 0) => "-".to_owned(),
        (None, _) => "fell".to_owned(),
    };
    let median = match row.ratio_interval {
        Some(ends) => format!("{} [{}]", ratio(row.ratio[1]), ends.map(ratio).join(", ")),
        None => ratio(row.ratio[1]),
    };
    let percent = |share: Option<f64>| share.map_or("-".to_owned(), |share| format!("{:.1}", 100.0 * share));
    let share = match row.share_interval {
        Some(ends) => format!("{} % [{}]", percent(row.share_only_after()), ends.map(percent).join(", ")),
        None => format!("{} %", percent(row.share_only_after())),
    };
    vec![
        row.variant.clone(),
        row.configuration.clone(),
        row.sequence.clone().unwrap_or_else(|| "all".to_owned()),
        row.part.to_string(),
        row.walls.to_string(),
        row.fell_before.to_string(),
        row.compared().to_string(),
        row.fell_alone.to_string(),
        row.fell_after.to_string(),
        share,
        ratio(row.ratio[0]),
        median,
        ratio(row.ratio[2]),
    ]
}
