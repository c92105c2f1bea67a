//! Workflows of the repository's host: what others wrote is taken by the hash of its commit.

use std::fs;
use std::path::Path;

#[test]
fn regress_actions_of_others_are_pinned_by_hash() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(".github/workflows");
    let mut pinned = 0;
    for file in fs::read_dir(folder).expect("workflows") {
        let path = file.expect("a file").path();
        let text = fs::read_to_string(&path).expect("readable");
        for action in text.lines().filter_map(|line| line.trim().strip_prefix("- uses: ")) {
            let (name, rest) = action.split_once('@').expect("name@hash");
            let (hash, version) = rest.split_once(" # v").expect("hash # version");
            let is_hash = hash.len() == 40 && hash.chars().all(|c| c.is_ascii_hexdigit());
            assert!(is_hash && !version.is_empty(), "{}: {name}@{rest}", path.display());
            pinned += 1;
        }
    }
    assert!(pinned >= 2, "{pinned} actions");
}
