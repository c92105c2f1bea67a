//! The tables of limits in `docs/diagnosis.md` are the program's, and its text names no limit that is not there.

use std::fs;
use std::path::{Path, PathBuf};

use mrbd_lab::limits::{GROUPS, Limit};

const BEGIN: &str = "<!-- limits: ";
const END: &str = "<!-- end of limits -->";

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/diagnosis.md")
}

/// The rows of a group, indented as the place in the page where they stand.
fn table(group: &[Limit], indent: &str) -> String {
    let unit = |limit: &Limit| if limit.unit.is_empty() { "–" } else { limit.unit };
    let row = |l: &Limit| format!("{indent}| `{}` | {} | {} | {} |\n", l.name, l.value, unit(l), l.meaning());
    let head = ["| limit | value | unit | meaning |", "| --- | --- | --- | --- |"];
    let head = head.map(|line| format!("{indent}{line}\n")).concat();
    format!("\n{head}{}\n", group.iter().map(row).collect::<String>())
}

/// The page with its tables made anew, and how many these are.
fn renewed(page: &str) -> (String, usize) {
    let mut parts = page.split(BEGIN);
    let mut text = parts.next().unwrap_or_default().to_owned();
    let mut tables = 0;
    for part in parts {
        let indent = text.rsplit('\n').next().unwrap_or_default().to_owned();
        let (name, rest) = part.split_once(" -->\n").expect("a marker that is closed");
        let (_, after) = rest.split_once(END).expect("an end of limits");
        let (_, group) = GROUPS.iter().find(|(known, _)| *known == name).expect("a group of limits");
        text += &format!("{BEGIN}{name} -->\n{}{indent}{END}{after}", table(group, &indent));
        tables += 1;
    }
    (text, tables)
}

#[test]
fn regress_the_guide_has_every_limit() {
    let shown = fs::read_to_string(page()).expect("the guide");
    let (made, tables) = renewed(&shown);
    if std::env::var_os("UPDATE_GUIDE").is_some() {
        fs::write(page(), &made).expect("written");
    }
    assert_eq!(tables, GROUPS.len(), "a table for each group");
    let same = fs::read_to_string(page()).is_ok_and(|page| page == made);
    assert!(
        same,
        "docs/diagnosis.md is behind the limits: UPDATE_GUIDE=1 cargo test -p mrbd-lab --test limits"
    );
}

#[test]
fn regress_the_guide_names_limits_that_are_there() {
    let shown = fs::read_to_string(page()).expect("the guide");
    let names = GROUPS.iter().flat_map(|(_, group)| group.iter().map(|limit| limit.name)).collect::<Vec<_>>();
    let is_name = |code: &&str| code.len() > 2 && code.chars().all(|c| c.is_ascii_uppercase() || c == '_');
    let named = shown.split('`').skip(1).step_by(2).filter(is_name).collect::<Vec<_>>();
    assert!(named.len() > names.len(), "{} names in the text and its tables", named.len());
    for name in named {
        assert!(names.contains(&name), "{name} is no limit");
    }
}

#[test]
fn regress_limits_have_names_of_their_own_and_a_sentence() {
    let mut names = GROUPS.iter().flat_map(|(_, group)| group.iter()).collect::<Vec<_>>();
    assert!(names.iter().all(|limit| limit.meaning().ends_with('.') && !limit.value.is_empty()));
    names.sort_by_key(|limit| limit.name);
    assert!(names.windows(2).all(|pair| pair[0].name != pair[1].name));
}
