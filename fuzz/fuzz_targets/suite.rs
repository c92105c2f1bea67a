//! Any text as a suite file: a suite or an input error, never a panic.
//!
//! `cargo +nightly fuzz run suite`
#![no_main]

use libfuzzer_sys::fuzz_target;
use mrbd_records::Suite;

fuzz_target!(|bytes: &[u8]| {
    let folder = std::env::temp_dir().join(format!("mrbd-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let path = folder.join("suite.toml");
    std::fs::write(&path, bytes).expect("a temporary file");
    let _outcome = Suite::load(&path);
});
