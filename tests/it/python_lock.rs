//! The package for Python has a lock of its own: what it shares with the program must be of the same versions.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Versions by name of package.
fn versions(lock: &str) -> BTreeMap<String, BTreeSet<String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(lock);
    let table: toml::Table = fs::read_to_string(path).expect("a lock").parse().expect("TOML");
    let mut versions = BTreeMap::<String, BTreeSet<String>>::new();
    for package in table["package"].as_array().expect("packages") {
        let text = |key: &str| package[key].as_str().expect("a text").to_owned();
        versions.entry(text("name")).or_default().insert(text("version"));
    }
    versions
}

#[test]
fn regress_both_locks_hold_the_same_versions() {
    let (program, python) = (versions("Cargo.lock"), versions("crates/python/Cargo.lock"));
    // Each pair of packages that both know; the program's tests use some that Python does not.
    let unlike: Vec<_> = program
        .iter()
        .filter(|(name, known)| python.get(*name).is_some_and(|held| !known.is_subset(held)))
        .collect();
    assert!(unlike.is_empty(), "in crates/python: `cargo update -p NAME --precise VERSION` for {unlike:?}");
    let own = program.keys().filter(|name| name.starts_with("mrbd"));
    let missing: Vec<_> = own.filter(|name| !python.contains_key(*name)).collect();
    assert!(missing.is_empty(), "in crates/python: `cargo metadata --offline` for {missing:?}");
    assert!(python.contains_key("mrbd") && python.len() > 100, "{} packages", python.len());
}
