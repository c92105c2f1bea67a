//! Any bytes as a record file: a record or an input error, never a panic.
//!
//! `cargo +nightly fuzz run read_record`; real files make a good corpus.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use mrbd_records::{ReadOptions, read_bytes};

fuzz_target!(|bytes: &[u8]| {
    for options in [ReadOptions::default(), ReadOptions { step_s: Some(0.005), ..ReadOptions::default() }] {
        if let Ok(record) = read_bytes(Path::new("fuzz"), bytes, &options) {
            assert!(record.accelerogram.acceleration_m_s2().len() <= bytes.len());
        }
    }
});
