//! Cases that were answered before: they are what is drawn under their numbers, and the documentation has their tables.

use std::path::{Path, PathBuf};

use super::cases::{self, hidden::Hidden};
use super::{laws, score, twins};
use mrbd_lab::limits::HELD_OUT_ERROR;

/// A case by its set and number.
type Draw = fn(&str, u64) -> cases::draw::Case;

/// Recorded sets, and how a case is drawn under its number: effects of the catalogue, joints that give, nothing hidden, impacts.
pub(crate) const SETS: [(&str, Draw); 31] = [
    ("fresh11", cases::draw::draw),
    ("fresh12", cases::draw::draw),
    ("fresh13", cases::draw::draw),
    ("fresh14", cases::draw::draw),
    ("beds3", cases::beds::draw),
    ("nulls3", cases::nulls::draw),
    ("beds4", cases::beds::draw),
    ("nulls4", cases::nulls::draw),
    ("beds5", cases::beds::draw),
    ("beds7", cases::beds::draw),
    ("beds8", cases::beds::draw),
    ("beds9", cases::beds::draw),
    ("beds10", cases::beds::draw),
    ("beds11", cases::beds::draw),
    ("beds12", cases::beds::draw),
    ("beds13", cases::beds::draw),
    ("beds14", cases::beds::draw),
    ("beds15", cases::beds::draw),
    ("beds16", cases::beds::draw),
    ("impacts1", cases::impacts::draw),
    ("nulls5", cases::nulls::draw),
    ("nulls6", cases::nulls::draw),
    ("nulls8", cases::nulls::draw),
    ("nulls9", cases::nulls::draw),
    ("nulls10", cases::nulls::draw),
    ("nulls11", cases::nulls::draw),
    ("nulls12", cases::nulls::draw),
    ("nulls13", cases::nulls::draw),
    ("nulls14", cases::nulls::draw),
    ("nulls15", cases::nulls::draw),
    ("nulls16", cases::nulls::draw),
];

/// Cases of a set that were scored before: `make blind SET=fresh11` goes on from there.
pub(crate) fn recorded(set: &str) -> Vec<score::Row> {
    score::recorded::load(&recorded_path(set), set).expect("the recorded cases")
}

fn recorded_path(set: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/blind/recorded/{set}.jsonl"))
}

#[test]
fn regress_recorded_cases_are_what_is_drawn_under_their_numbers() {
    for (row, draw) in
        SETS.iter().flat_map(|(set, draw)| recorded(set).into_iter().map(move |row| (row, draw)))
    {
        let case = draw(&row.set, row.number);
        let told = case.hidden.iter().map(Hidden::told).collect::<Vec<_>>();
        let all = |key: &str| told.iter().map(|hidden| hidden[key].clone()).collect::<Vec<_>>();
        let [kind, simulator, prior] = [&case.kind.name(), case.formulation(), case.prior.name()];
        assert_eq!([&row.kind, &row.simulator, &row.prior], [kind, simulator, prior], "{row:?}");
        assert_eq!([row.noise_rad, row.size], [case.noise_rad, case.size], "{row:?}");
        assert_eq!(row.hidden, all("kind"), "{row:?}");
        assert_eq!(row.hidden_places, all("place"), "{row:?}");
    }
}

#[test]
fn regress_recorded_cases_are_written_again_as_they_were() {
    for (set, _) in SETS {
        let folder = tempfile::tempdir().expect("a folder");
        let again = folder.path().join("cases.jsonl");
        score::recorded::save(&again, &recorded(set)).expect("written");
        let [own, again] =
            [&recorded_path(set), &again].map(|path| std::fs::read_to_string(path).expect("cases"));
        assert!(own == again, "recorded cases of {set} change when they are read and written");
    }
}

#[test]
fn regress_the_documentation_has_the_tables_of_the_recorded_cases() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/diagnosis-blind.md");
    let text = std::fs::read_to_string(path).expect("the documentation");
    let tables = SETS.map(|(set, _)| (set, score::targets::table(&recorded(set))));
    let lacking = tables.iter().filter(|(_, table)| !text.contains(table));
    let lacking = lacking.map(|(set, table)| format!("the table of {set}:\n\n{table}\n")).collect::<String>();
    assert!(lacking.is_empty(), "docs/diagnosis-blind.md lacks {lacking}");
}

#[test]
fn regress_an_effect_beside_a_joint_is_told_whichever_law_of_the_joint_is_told_with_it() {
    let told = |set: &str, number: u64| {
        let rows = recorded(set);
        let row = rows.iter().find(|row| row.number == number).expect("a case").clone();
        (row.exact(), row.tells_beside_joints())
    };
    assert_eq!(told("beds14", 3), (true, true), "both by name");
    assert_eq!(told("beds15", 1), (false, true), "damping, on a bed or one that crushes");
    assert_eq!(told("beds14", 1), (false, false), "laws of the joint alone");
    assert_eq!(told("beds13", 21), (false, false), "an indented corner in the bed's place");
    assert_eq!(told("beds15", 6), (false, false), "a place");
}

/// Cases of laws that were scored before, by set: `make blind LAWS=1 SET=laws1` goes on from there.
pub(crate) fn recorded_laws(set: &str) -> Vec<laws::LawRow> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/blind/recorded/{set}.jsonl"));
    score::recorded::load(&path, set).expect("the recorded cases")
}

/// Recorded sets of laws, in the order in which they were answered.
pub(crate) const SETS_OF_LAWS: [&str; 31] = [
    "laws1", "laws2", "laws3", "laws4", "laws6", "laws7", "laws8", "laws9", "laws10", "laws11", "laws13",
    "laws14", "laws15", "laws16", "laws17", "laws18", "laws19", "laws20", "laws21", "laws22", "laws23",
    "laws24", "laws25", "laws26", "laws27", "laws28", "laws29", "laws30", "laws31", "laws32", "laws33",
];

#[test]
fn regress_recorded_laws_are_what_is_drawn_under_their_numbers() {
    for row in SETS_OF_LAWS.iter().flat_map(|set| recorded_laws(set)) {
        let case = laws::draw::draw(&row.set, row.number);
        let [group, simulator, prior] = [&case.kind.name(), case.formulation(), case.prior.name()];
        assert_eq!([&row.group, &row.simulator, &row.prior], [group, simulator, prior], "{row:?}");
        assert_eq!([row.noise_rad, row.size], [case.noise_rad, case.size], "{row:?}");
        let told = case.hidden.iter().map(|hidden| laws::row::hidden(&hidden.told())).collect::<Vec<_>>();
        assert_eq!(row.hidden, told, "{row:?}");
    }
}

#[test]
fn regress_where_nothing_is_hidden_nothing_is_said_of_tests_held_out_that_are_missed() {
    // So that `unknown` stands there for no wall of these.
    let of_catalogue = SETS.iter().flat_map(|(set, _)| recorded(set));
    let of_catalogue = of_catalogue.map(|row| (row.verdict, row.hidden, row.after));
    let of_laws = SETS_OF_LAWS.iter().flat_map(|set| recorded_laws(set));
    let of_laws = of_laws.map(|row| (row.verdict, row.hidden, row.after));
    let mut said = 0;
    for (verdict, hidden, held_out) in of_catalogue.chain(of_laws) {
        if ["none", "recalibrated"].contains(&&verdict[..]) && hidden.is_empty() {
            said += 1;
            assert!(held_out.is_none_or(|error| error < HELD_OUT_ERROR), "{verdict}: {held_out:?}");
        }
    }
    assert!(said > 600, "{said}");
}

#[test]
fn regress_recorded_laws_are_written_again_as_they_were() {
    for set in SETS_OF_LAWS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/blind/recorded/{set}.jsonl"));
        let folder = tempfile::tempdir().expect("a folder");
        let again = folder.path().join("cases.jsonl");
        score::recorded::save(&again, &recorded_laws(set)).expect("written");
        let [own, again] = [&path, &again].map(|path| std::fs::read_to_string(path).expect("cases"));
        assert!(own == again, "recorded cases of {set} change when they are read and written");
    }
}

#[test]
fn regress_the_documentation_has_the_tables_of_the_recorded_laws() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/diagnosis-blind-laws.md");
    let text = std::fs::read_to_string(path).expect("the documentation");
    let tables = SETS_OF_LAWS.iter().flat_map(|set| {
        let rows = recorded_laws(set);
        [laws::targets::table(&rows), laws::refused::table(&rows)].map(|table| (set, table))
    });
    let lacking = tables.filter(|(_, table)| !text.contains(table));
    let lacking = lacking.map(|(set, table)| format!("the table of {set}:\n\n{table}\n")).collect::<String>();
    assert!(lacking.is_empty(), "docs/diagnosis-blind-laws.md lacks {lacking}");
}

/// How many of these, the last, the documentation tells together.
const TOLD_TOGETHER: usize = 3;

#[test]
fn regress_the_documentation_has_the_table_of_the_last_recorded_laws_together() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/diagnosis-blind-laws.md");
    let text = std::fs::read_to_string(path).expect("the documentation");
    let last = SETS_OF_LAWS[SETS_OF_LAWS.len() - TOLD_TOGETHER..].iter();
    let table = laws::targets::table(&last.flat_map(|set| recorded_laws(set)).collect::<Vec<_>>());
    assert!(
        text.contains(&table),
        "docs/diagnosis-blind-laws.md lacks the table of the last sets:\n\n{table}"
    );
}

#[test]
fn regress_the_readme_has_the_tallies_of_the_recorded_laws() {
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let readme = std::fs::read_to_string(readme).expect("the README");
    let all = SETS_OF_LAWS.iter().flat_map(|set| recorded_laws(set)).collect::<Vec<_>>();
    let count = |holds: &dyn Fn(&laws::LawRow) -> bool| all.iter().filter(|row| holds(row)).count();
    let tallies = [
        format!("of {} formulas accepted in {} sets", count(&laws::LawRow::accepts), SETS_OF_LAWS.len()),
        format!(
            "{} are another force, {} of them at 3e-4 rad",
            count(&laws::LawRow::wrong),
            count(&|row| row.wrong() && row.noise_rad == 3e-4)
        ),
    ];
    for tally in tallies {
        assert!(readme.contains(&tally), "README.md lacks \"{tally}\"");
    }
}

/// Sets of twins by which calibrations were judged, in order: `make blind-calibrations SET=twins6` goes on from there.
const SETS_OF_TWINS: [&str; 3] = ["twins2", "twins4", "twins6"];

fn calibrated_twins(set: &str) -> Vec<twins::row::Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/blind/recorded/{set}.jsonl"));
    twins::row::load(&path, set).expect("the recorded twins")
}

#[test]
fn regress_recorded_twins_are_what_is_drawn_under_their_numbers() {
    for set in SETS_OF_TWINS {
        calibrated_twins(set).iter().for_each(|row| is_drawn(set, row));
    }
}

fn is_drawn(set: &str, row: &twins::row::Row) {
    let twin = twins::draw::draw(set, row.number);
    let Some(case) = twin.case else {
        assert_eq!(row.simulator, "init");
        return;
    };
    assert_eq!([&row.simulator, &row.law], [case.formulation(), case.actual.law]);
    assert_eq!((row.noise_rad, row.tests), (case.noise_rad, case.fit_tests));
    for number in row.numbers.iter().filter(|number| number.name.starts_with("C_")) {
        let l: usize = number.name[2..].parse().expect("a coefficient");
        let drawn = case.actual.coefficients[l - 1];
        assert_eq!(number.truth, drawn, "{} of twin {} of {set}", number.name, row.number);
    }
}

#[test]
fn regress_the_documentation_has_the_tables_of_the_calibrated_twins() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/calibration.md");
    let text = std::fs::read_to_string(path).expect("the documentation");
    for set in SETS_OF_TWINS {
        let table = twins::targets::table(&calibrated_twins(set));
        assert!(text.contains(&table), "docs/calibration.md lacks the table of {set}:\n\n{table}");
    }
}

#[test]
fn regress_the_readme_has_the_tallies_of_the_last_calibrated_twins() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let text = std::fs::read_to_string(path).expect("the README");
    let [.., last] = SETS_OF_TWINS;
    let rows = calibrated_twins(last);
    let tally = |is_in: fn(&twins::row::Row) -> bool| {
        let group = rows.iter().filter(|row| is_in(row)).flat_map(|row| &row.numbers);
        let held = group.filter(|n| n.identified).filter_map(twins::row::Number::holds).collect::<Vec<_>>();
        format!("{} of {}", held.iter().filter(|holds| **holds).count(), held.len())
    };
    let [all, other] = [tally(|_| true), tally(|row| row.simulator == "compliant")];
    let told = format!(
        "on {} blind twins of two simulators {all} intervals of 95 % that are called identified hold the truth, {other} on the simulator",
        rows.len()
    );
    assert!(text.contains(&told), "the README lacks: {told}");
}
