//! What moved between accepted medians and those of a study.

use std::collections::BTreeMap;

use super::baseline::{Baseline, Entry};

/// A figure that is not what was accepted.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// The case: variant, floor, parameter, level, slenderness.
    pub case: String,
    /// The figure: a measure, `runs`, `failed` or `collapsed`.
    pub figure: String,
    /// As accepted.
    pub was: String,
    /// As the study has it.
    pub is: String,
    /// By how much it moved; none where one of the two is no number.
    pub by: Option<f64>,
    /// By how much it may.
    pub tolerance: f64,
}

/// Every figure of the study that moved by more than its tolerance, and every one that is gone or new, in the order
/// of the baseline, new ones last. The tolerances are the baseline's.
pub fn compare(accepted: &Baseline, now: &Baseline) -> Vec<Change> {
    let mut left: BTreeMap<_, &Entry> = now.entries.iter().map(|entry| (entry.key(), entry)).collect();
    let mut changes = Vec::new();
    for was in &accepted.entries {
        match left.remove(&was.key()) {
            Some(is) => changes.extend(moved(was, is)),
            None => changes.push(presence(was, "there", "gone")),
        }
    }
    let new = now.entries.iter().filter(|entry| left.contains_key(&entry.key()));
    changes.extend(new.map(|is| presence(is, "not there", "new")));
    changes
}

fn moved(was: &Entry, is: &Entry) -> Vec<Change> {
    let counts = [
        ("runs", was.runs, is.runs, 0),
        ("failed", was.failed, is.failed, 0),
        ("collapsed", was.collapsed, is.collapsed, was.collapsed_tolerance),
    ];
    let counts = counts.into_iter().filter(|(_, was, is, tolerance)| was.abs_diff(*is) > *tolerance);
    let mut changes: Vec<Change> = counts
        .map(|(figure, a, b, tolerance)| Change {
            case: case(was),
            figure: figure.to_owned(),
            was: a.to_string(),
            is: b.to_string(),
            by: Some(b as f64 - a as f64),
            tolerance: tolerance as f64,
        })
        .collect();
    if has_moved(was, is.median) {
        changes.push(Change {
            case: case(was),
            figure: was.measure.clone(),
            was: shown(was.median),
            is: shown(is.median),
            by: was.median.zip(is.median).map(|(was, is)| is - was),
            tolerance: was.tolerance,
        });
    }
    changes
}

fn has_moved(was: &Entry, is: Option<f64>) -> bool {
    match (was.median, is) {
        (Some(was_median), Some(is)) => (is - was_median).abs() > was.tolerance,
        (None, None) => false,
        // From standing to collapse or back, which only an endless tolerance allows.
        _ => was.tolerance.is_finite(),
    }
}

fn presence(entry: &Entry, was: &str, is: &str) -> Change {
    let (was, is) = (was.to_owned(), is.to_owned());
    Change { case: case(entry), figure: entry.measure.clone(), was, is, by: None, tolerance: 0.0 }
}

fn case(entry: &Entry) -> String {
    let Entry { variant, configuration, parameter, level, slenderness, record, .. } = entry;
    let Some(slenderness) = slenderness else {
        let parts = [variant, configuration, level, record].into_iter().filter(|part| !part.is_empty());
        return parts.map(String::as_str).collect::<Vec<_>>().join(", ");
    };
    format!("{variant}, {configuration}, {parameter} at {level}, h/b {slenderness}")
}

fn shown(median: Option<f64>) -> String {
    median.map_or("collapse".to_owned(), |median| format!("{median:.6}"))
}
