//! The rooms of the program form no ring: each uses only those that stand before it in the flow of data.
//!
//! Between crates the compiler keeps the direction; inside the root package this test does.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms of `src/` in the flow of data, and the rooms that each may use.
const ALLOWED: [(&str, &[&str]); 15] = [
    ("error", &[]),
    ("text", &[]),
    ("store", &["error"]),
    ("survey", &["error"]),
    ("study", &["error", "text", "store", "survey"]),
    ("aggregate", &["error", "store", "survey", "study"]),
    ("findings", &["error", "text", "store", "survey", "study", "aggregate"]),
    ("check", &["error", "store", "survey", "study", "aggregate"]),
    ("sensitivity", &["error", "text", "store", "survey", "study", "aggregate", "findings"]),
    ("fragility", &["error", "text", "store", "study"]),
    ("assessment", &["error", "store", "survey", "study", "fragility"]),
    ("classics", &["error", "text", "store", "study"]),
    ("results", &["error", "store"]),
    (
        "summary",
        &[
            "error",
            "store",
            "survey",
            "study",
            "aggregate",
            "findings",
            "sensitivity",
            "fragility",
            "assessment",
            "classics",
            "results",
        ],
    ),
    (
        "report",
        &[
            "error",
            "text",
            "store",
            "survey",
            "study",
            "aggregate",
            "findings",
            "sensitivity",
            "fragility",
            "assessment",
            "classics",
            "results",
            "summary",
        ],
    ),
];

/// The command line may use everything.
const TOP: [&str; 3] = ["cli", "lib", "main"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        match path.is_dir() {
            true => sources(&path, found),
            false if path.extension().is_some_and(|e| e == "rs") => found.push(path),
            false => {}
        }
    }
}

/// Rooms named after `crate::` in a line of code.
fn rooms_used(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    code.split("crate::").skip(1).filter_map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_lowercase() && c != '_').unwrap_or(rest.len());
        Some(&rest[..end]).filter(|room| !room.is_empty())
    })
}

/// Which rooms each room uses.
fn arrows() -> BTreeMap<String, BTreeSet<String>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    let mut arrows = BTreeMap::<String, BTreeSet<String>>::new();
    for file in files {
        let within = file.strip_prefix(&root).expect("inside");
        let room = within.iter().next().expect("a name").to_string_lossy().replace(".rs", "");
        let text = fs::read_to_string(&file).expect("readable");
        let used = text.lines().flat_map(rooms_used).filter(|used| *used != room).map(str::to_owned);
        arrows.entry(room.clone()).or_default().extend(used);
    }
    arrows
}

#[test]
fn regress_rooms_use_only_those_before_them() {
    let arrows = arrows();
    for (room, used) in arrows.iter().filter(|(room, _)| !TOP.contains(&room.as_str())) {
        let allowed = ALLOWED.iter().find(|(name, _)| name == room);
        let (_, allowed) = allowed.unwrap_or_else(|| panic!("room {room} has no place in the flow of data"));
        let wrong: Vec<_> = used.iter().filter(|used| !allowed.contains(&used.as_str())).collect();
        assert!(wrong.is_empty(), "{room} uses {wrong:?}, which stand after it");
    }
    // The arrows that the program rests on are seen, so the test reads what it should.
    assert!(arrows["study"].contains("survey") && arrows["report"].contains("store"), "{arrows:?}");
}

#[test]
fn regress_the_allowed_arrows_form_no_ring() {
    for (place, (room, allowed)) in ALLOWED.iter().enumerate() {
        let before: Vec<_> = ALLOWED[..place].iter().map(|(name, _)| *name).collect();
        for used in *allowed {
            assert!(before.contains(used), "{room} may use {used}, which does not stand before it");
        }
    }
}
