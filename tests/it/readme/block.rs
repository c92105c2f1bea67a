//! A page and its marked blocks.

use std::collections::BTreeSet;

const BEGIN: &str = "<!-- made by make readme: ";
const CLOSE: &str = " -->";
const END: &str = "<!-- end -->";
/// Width of prose in the pages.
const WIDTH: usize = 120;

/// The text of a page while its blocks are made anew.
pub struct Page {
    before: String,
    now: String,
    made: BTreeSet<String>,
}

impl Page {
    pub fn new(text: String) -> Self {
        Self { now: text.clone(), before: text, made: BTreeSet::new() }
    }

    pub fn text(&self) -> &str {
        &self.now
    }

    /// Puts a text into every block of a name; there must be one.
    pub fn put(&mut self, name: &str, text: &str) {
        let begin = format!("{BEGIN}{name}{CLOSE}");
        let mut parts = self.now.split(&begin);
        let mut page = parts.next().expect("a first part").to_owned();
        let mut found = 0;
        for part in parts {
            let (_, after) = part.split_once(END).expect("every block has an end");
            page += &format!("{begin}{text}{END}{after}");
            found += 1;
        }
        assert!(found > 0, "no block {begin:?}");
        self.now = page;
        self.made.insert(name.to_owned());
    }

    /// The same, of a block of its own lines.
    pub fn put_lines(&mut self, name: &str, lines: &str) {
        self.put(name, &format!("\n{}\n", lines.trim_end()));
    }

    /// Prose, broken at the width of the page.
    pub fn put_prose(&mut self, name: &str, prose: &str) {
        let mut lines = vec![String::new()];
        for word in prose.split(' ') {
            let line = lines.last_mut().expect("a line");
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > WIDTH {
                lines.push(word.to_owned());
            } else {
                let gap = if line.is_empty() { "" } else { " " };
                *line += &format!("{gap}{word}");
            }
        }
        self.put_lines(name, &lines.join("\n"));
    }

    /// What stands in a block, as it was.
    pub fn block(&self, name: &str) -> &str {
        let begin = format!("{BEGIN}{name}{CLOSE}");
        let (_, after) = self.before.split_once(&begin).expect("a block of that name");
        after.split_once(END).expect("every block has an end").0
    }

    /// A block that cannot be made here, for its inputs are elsewhere, stays as it is.
    pub fn keep(&mut self, name: &str) {
        let kept = self.block(name).to_owned();
        self.put(name, &kept);
    }

    pub fn blocks_not_made(&self) -> Vec<String> {
        let names = self.before.split(BEGIN).skip(1).filter_map(|rest| Some(rest.split_once(CLOSE)?.0));
        names.filter(|name| !self.made.contains(*name)).map(str::to_owned).collect()
    }

    /// The lines that are not what was made; empty where all are.
    pub fn stale(&self) -> String {
        let marked = |sign: char, from: &str, other: &str| -> String {
            let others: BTreeSet<&str> = other.lines().collect();
            let lines = from.lines().filter(|line| !others.contains(line));
            lines.map(|line| format!("{sign} {line}\n")).collect()
        };
        marked('-', &self.before, &self.now) + &marked('+', &self.now, &self.before)
    }
}

/// 13608 as `13 608`.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|group| std::str::from_utf8(group).expect("digits")).collect();
    groups.join(" ")
}

/// A row of a table.
pub fn row<S: AsRef<str>>(cells: &[S]) -> String {
    let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
    format!("| {} |\n", cells.join(" | "))
}

#[test]
fn regress_blocks_are_replaced_and_stale_lines_shown() {
    let text = format!("a {BEGIN}n{CLOSE}1{END} b\nc {BEGIN}n{CLOSE}2{END}\n{BEGIN}m{CLOSE}\nx\n{END}\n");
    let mut page = Page::new(text.clone());
    assert_eq!((page.block("n"), page.block("m")), ("1", "\nx\n"));
    page.keep("m");
    assert_eq!(page.blocks_not_made(), ["n", "n"]);
    page.put("n", "1");
    assert_eq!(page.text(), text.replace(">2<", ">1<"));
    assert_eq!(page.stale(), format!("- c {BEGIN}n{CLOSE}2{END}\n+ c {BEGIN}n{CLOSE}1{END}\n"));
    assert!(Page::new(text).stale().is_empty());
}

#[test]
fn analytic_thousands_are_parted() {
    assert_eq!([7, 840, 13_608, 1_000_006].map(grouped), ["7", "840", "13 608", "1 000 006"]);
}
