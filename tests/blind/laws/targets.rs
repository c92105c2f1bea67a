//! The targets of laws as formulas and what was reached.

use std::path::{Path, PathBuf};

use super::super::score::counted::{Counted, NO_CASES};
use super::super::score::reading::median;
use super::super::score::recorded;
use super::super::score::targets::printed;
use super::refused;
use super::row::LawRow;

/// Up to this a law is to be found nearly always, rad.
const LOW_NOISE_RAD: f64 = 1.001e-4;
/// Windowed error of the test held out that a law may leave.
const FOLLOWED: f64 = 1.15;

/// A table in Markdown: figure, target, reached with its interval, cases.
pub fn table(rows: &[LawRow]) -> String {
    let mut lines = Vec::new();
    let mut add = |figure: &str, target: &str, reached: String| {
        lines.push([figure.to_owned(), target.to_owned(), reached]);
    };
    let group =
        |names: &[&str]| rows.iter().filter(|row| names.contains(&row.group.as_str())).collect::<Vec<_>>();
    let told = |rows: &[&LawRow], so: fn(&LawRow) -> bool| Counted::of(rows, |row| so(row)).told();
    let nulls = group(&["nothing", "a name"]);
    add("a formula where nothing is hidden or a name holds", "≤ 1 %", told(&nulls, LawRow::accepts));
    let one = group(&["one atom"]);
    let seen = |is_low: bool| {
        let own = |row: &&&LawRow| row.visible() && (row.noise_rad < LOW_NOISE_RAD) == is_low;
        one.iter().filter(own).copied().collect::<Vec<_>>()
    };
    let (low_seen, high_seen) = (seen(true), seen(false));
    // Of answers before intervals of exponents were told nothing can be said of these.
    let tells_round = rows.iter().any(|row| row.round_exponents_hold.is_some());
    let with_round = "– or with a round exponent whose interval holds the true one";
    add(
        "one atom, visible, ≤ 1e-4 rad: the formula, alone or in a class",
        "≥ 90 %",
        told(&low_seen, LawRow::right),
    );
    if tells_round {
        add(with_round, "", told(&low_seen, LawRow::right_or_holds_it));
    }
    add("– alone", "≥ 75 %", told(&low_seen, LawRow::exact));
    add("– the force within 10 %", "", told(&low_seen, LawRow::function_right));
    let off = low_seen.iter().copied().filter(|row| row.off_grid).collect::<Vec<_>>();
    add("– of these with an exponent that is no half: the formula", "", told(&off, LawRow::right));
    add(
        "one atom at 3e-4 rad, visible: the formula, alone or in a class",
        "≥ 65 %",
        told(&high_seen, LawRow::right),
    );
    add("– the force within 10 %", "", told(&high_seen, LawRow::function_right));
    if tells_round {
        add(with_round, "", told(&high_seen, LawRow::right_or_holds_it));
        let is_none = |row: &&LawRow| !row.spelled && !row.spelled_in_class;
        let held = rows.iter().filter(is_none).filter_map(|row| row.round_exponents_hold).collect::<Vec<_>>();
        add(
            "an exponent told as round that is none: its 90 % interval holds it",
            "85 to 95 %",
            Counted::of(held, |holds| *holds).told(),
        );
    }
    let two = group(&["two atoms"]);
    add("two atoms: both right", "≥ 60 %", told(&two, LawRow::right));
    add("– the force within 10 %", "≥ 80 %", told(&two, LawRow::function_right));
    let both = two.iter().copied().filter(|row| row.all_act()).collect::<Vec<_>>();
    if two.iter().any(|row| !row.shares.is_empty()) {
        add(
            "– of those of which each makes 10 % of the force in the tests fitted: both right",
            "",
            told(&both, LawRow::right),
        );
        add("– – the force within 10 %", "", told(&both, LawRow::function_right));
    }
    let joint = group(&["joint"]);
    add("a law at a joint: the formula, alone or in a class", "≥ 70 %", told(&joint, LawRow::right));
    // Of rows without the gain of the true law, no trace cannot be told from one that is small.
    if joint.iter().any(|row| row.law_gains.is_some()) {
        let shows = joint.iter().copied().filter(|row| row.visible()).collect::<Vec<_>>();
        add("– of those that show", "", told(&shows, LawRow::right));
    }
    let memory = group(&["memory"]);
    add("a memory: the formula, alone or in a class", "≥ 70 %", told(&memory, LawRow::right));
    add("– the force within 10 %", "≥ 85 %", told(&memory, LawRow::function_right));
    let body = group(&["a hidden body"]);
    add("a hidden body, which has no formula: one is accepted", "", told(&body, LawRow::accepts));
    let outside = group(&["outside the grammar"]);
    add("outside the grammar: accepted, and off by more than 10 %", "≤ 10 %", told(&outside, LawRow::wrong));
    let accepted = rows.iter().filter(|row| row.accepts()).collect::<Vec<_>>();
    add("accepted formulas that are another force", "≤ 5 %", told(&accepted, LawRow::wrong));
    let curves = rows.iter().filter_map(|row| row.curve).collect::<Vec<_>>();
    let percent = |value: f64| format!("{:.1} %", 100.0 * value);
    let off = median(curves.iter().map(|curve| curve.0));
    let off = off.map_or(NO_CASES.into(), |off| format!("{}, {} cases", percent(off), curves.len()));
    add("a force without a formula, held out: median error", "≤ 3 %", off);
    let held = median(curves.iter().map(|curve| curve.1)).map_or(NO_CASES.into(), percent);
    add("– points that its 90 % band holds, median", "85 to 95 %", held);
    let numbers = rows.iter().flat_map(|row| &row.numbers).collect::<Vec<_>>();
    let error = median(numbers.iter().map(|(error, _)| *error));
    let error = error.map_or(NO_CASES.into(), |e| format!("{}, {} numbers", percent(e), numbers.len()));
    add("numbers of one right atom, median error", "≤ 2 %", error);
    add(
        "– their 90 % intervals hold the truth",
        "85 to 95 %",
        Counted::of(&numbers, |(_, covered)| *covered).told(),
    );
    let of = |value: fn(&LawRow) -> Option<f64>| median(accepted.iter().filter_map(|row| value(row)));
    let reached = of(|row| row.before).zip(of(|row| row.after));
    let reached = reached.map_or(NO_CASES.into(), |(before, after)| format!("{before:.2} to {after:.2}"));
    add(
        "accepted: windowed error of the test held out, at another amplitude, median",
        "> 3 to < 1.15",
        reached,
    );
    let followed = |row: &LawRow| row.after.is_some_and(|error| error < FOLLOWED);
    add("– below 1.15", "≥ 90 %", told(&accepted, followed));
    let slowest = rows.iter().map(|row| row.seconds).fold(0.0, f64::max);
    let typical = median(rows.iter().map(|row| row.seconds)).unwrap_or(0.0);
    add("time of a case on one thread", "", format!("median {typical:.0} s, longest {slowest:.0} s"));
    printed(&lines)
}

/// Reads every diagnosed case, prints what was reached of these and of those recorded before, and writes a line a case.
///
/// # Errors
/// Text for people: a file that cannot be read or written.
pub fn report(cases: &[PathBuf], recorded: Vec<LawRow>, out: &Path) -> Result<(), String> {
    let new =
        cases.iter().filter_map(|case| LawRow::load(case).transpose()).collect::<Result<Vec<_>, _>>()?;
    let missing = cases.len() - new.len();
    if missing > 0 {
        eprintln!("{missing} of {} cases have not been diagnosed", cases.len());
    }
    let mut rows = [recorded, new].concat();
    rows.sort_by_key(|row| row.number);
    let mut sorted = rows.iter().collect::<Vec<_>>();
    sorted.sort_by_key(|row| (row.group.clone(), row.number));
    let said = sorted.iter().map(|row| format!("{}: {}\n", row.group, row.said())).collect::<String>();
    let text = format!("{}\n{}\n{said}", table(&rows), refused::table(&rows));
    print!("{text}");
    let told = |e: &dyn std::fmt::Display| format!("{}: {e}", out.display());
    std::fs::create_dir_all(out).map_err(|e| told(&e))?;
    std::fs::write(out.join("report.txt"), &text).map_err(|e| told(&e))?;
    recorded::save(&out.join("cases.jsonl"), &rows)
}
