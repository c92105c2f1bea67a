//! The targets of the calibration and what was reached.

use super::super::score::counted::Counted;
use super::super::score::reading::median;
use super::super::score::targets::printed;
use super::row::{Number, Row};

/// Whether a twin belongs to a group.
type Group = fn(&Row) -> bool;

/// A table in Markdown: figure, target, reached with its interval.
pub fn table(rows: &[Row]) -> String {
    let mut lines = Vec::new();
    let mut add = |figure: &str, target: &str, reached: String| {
        lines.push([figure.to_owned(), target.to_owned(), reached]);
    };
    let identified = |rows: &[&Row]| {
        rows.iter().flat_map(|row| &row.numbers).filter(|n| n.identified).cloned().collect::<Vec<_>>()
    };
    let holds = |numbers: &[Number]| Counted::of(numbers.iter().filter_map(Number::holds), |holds| *holds);
    let all = rows.iter().collect::<Vec<_>>();
    add("95 % interval holds the truth, where identified", "90 to 98 %", holds(&identified(&all)).told());
    let groups: [(&str, Group); 4] = [
        ("– own simulator, `contact`", |row| row.simulator == "own" && row.law == "contact"),
        ("– own simulator, `whole`", |row| row.law == "whole"),
        ("– the other simulator", |row| row.simulator == "compliant"),
        ("– the example of `mrbd init`", |row| row.simulator == "init"),
    ];
    for (name, is_in) in groups {
        let group = all.iter().copied().filter(|row| is_in(row)).collect::<Vec<_>>();
        add(name, "", holds(&identified(&group)).told());
    }
    let numbers = rows.iter().flat_map(|row| &row.numbers).cloned().collect::<Vec<_>>();
    add("– every interval that is given", "", holds(&numbers).told());
    let coefficients = identified(&all).into_iter().filter(|n| n.name.starts_with("C_"));
    let errors = coefficients.map(|n| n.error()).collect::<Vec<_>>();
    let percent =
        |share: Option<f64>| share.map_or("–".to_owned(), |share| format!("{:.2} %", 100.0 * share));
    let count = errors.len();
    let middle = percent(median(errors.iter().copied()));
    add("error of an identified coefficient, median", "≤ 1 %", format!("{middle}, {count} of them"));
    add("– largest", "≤ 5 %", percent(errors.iter().copied().reduce(f64::max)));
    add("numbers that act and are identified", "", Counted::of(&numbers, |n| n.identified).told());
    for (name, is_in) in groups {
        let own = rows.iter().filter(|row| is_in(row)).flat_map(|row| &row.numbers);
        add(name, "", Counted::of(own, |n| n.identified).told());
    }
    let times = rows.iter().map(|row| row.seconds);
    let longest = times.clone().fold(0.0, f64::max);
    let typical = median(times).unwrap_or(0.0);
    add("time of a calibration on one core", "", format!("median {typical:.0} s, longest {longest:.0} s"));
    printed(&lines)
}
