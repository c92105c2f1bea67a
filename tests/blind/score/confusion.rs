//! What was said for what was hidden, and how often it was right by noise, size and simulator.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::counted::Counted;
use super::row::Row;

/// All tables.
pub fn tables(rows: &[Row]) -> String {
    let mut text = String::from("hidden: what was said\n");
    let mut said: BTreeMap<&str, BTreeMap<String, usize>> = BTreeMap::new();
    for row in rows {
        *said.entry(&row.kind).or_default().entry(row.said()).or_default() += 1;
    }
    let width = said.keys().map(|kind| kind.chars().count()).max().unwrap_or(0);
    for (kind, counts) in &said {
        let mut counts: Vec<_> = counts.iter().collect();
        counts.sort_by_key(|(name, count)| (std::cmp::Reverse(**count), (*name).clone()));
        let told: Vec<String> = counts.iter().map(|(name, count)| format!("{name} {count}")).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{kind:width$}  {}", told.join(", "));
    }
    let effects: Vec<&Row> = rows.iter().filter(|row| row.hides_effect()).collect();
    text.push_str("\none or two effects hidden: right name or class; wrong name\n");
    by(&mut text, "noise", &effects, |row| format!("{:.0e} rad", row.noise_rad));
    by(&mut text, "size", &effects, |row| format!("{} times nominal", row.size));
    by(&mut text, "simulator", &effects, |row| row.simulator.clone());
    by(&mut text, "prior", &effects, |row| row.prior.clone());
    by(&mut text, "tests to fit", &effects, |row| row.tests.to_string());
    by(&mut text, "hidden", &effects, |row| row.kind.clone());
    let nothing: Vec<&Row> = rows.iter().filter(|row| row.hidden.is_empty()).collect();
    text.push_str("\nnothing hidden: (right is never;) a name all the same\n");
    by(&mut text, "simulator", &nothing, |row| row.simulator.clone());
    by(&mut text, "noise", &nothing, |row| format!("{:.0e} rad", row.noise_rad));
    text
}

fn by(text: &mut String, title: &str, rows: &[&Row], key: impl Fn(&Row) -> String) {
    let mut groups: BTreeMap<String, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        groups.entry(key(row)).or_default().push(row);
    }
    let _ = writeln!(text, "by {title}");
    let width = groups.keys().map(|name| name.chars().count()).max().unwrap_or(0);
    for (name, rows) in groups {
        let right = Counted::of(&rows, |row| row.right()).told();
        let wrong = Counted::of(&rows, |row| row.wrong()).told();
        let _ = writeln!(text, "  {name:width$}  right {right:30}  wrong {wrong}");
    }
}
