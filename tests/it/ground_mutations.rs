//! Readers meet damaged files: whatever the bytes, a record or an input error, never a panic, never a flood of memory.

use std::path::Path;

use mrbd_records::{ReadOptions, read_bytes};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::ground_samples::{options, small_files};

const MUTANTS_OF_A_FILE: usize = 15_000;
/// Pieces that break parsers when they stand where a number or a mark should.
const PIECES: [&str; 16] = [
    "NaN",
    "inf",
    "-1",
    "0",
    "99999999999999999999",
    "1e999",
    "\n",
    "\r\n",
    ",",
    "\"",
    " ",
    "\u{fe}\u{ff}",
    "NPTS=",
    "SEC",
    "-",
    ".",
];

#[test]
fn rejects_or_reads_any_mutant_without_panic() {
    let mut rng = ChaCha8Rng::seed_from_u64(20_120_529);
    let files = small_files();
    let (mut read, mut refused) = (0, 0);
    for (format, text) in &files {
        for _ in 0..MUTANTS_OF_A_FILE {
            let mut bytes = text.clone().into_bytes();
            for _ in 0..rng.random_range(1..=4) {
                mutate(&mut bytes, &mut rng);
            }
            let options = if rng.random_bool(0.5) { options() } else { ReadOptions::default() };
            match read_bytes(Path::new("mutant"), &bytes, &options) {
                Ok(record) => {
                    read += 1;
                    let count = record.accelerogram.acceleration_m_s2().len();
                    assert!(count <= bytes.len(), "{format}: {count} samples out of {} bytes", bytes.len());
                }
                Err(_) => refused += 1,
            }
        }
    }
    assert!(read + refused >= 100_000, "{read} read and {refused} refused");
    // Both outcomes must be common, or the mutants miss the parsers.
    assert!(read > 10_000 && refused > 10_000, "{read} read and {refused} refused");
}

#[test]
fn rejects_random_bytes_without_panic() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..5_000 {
        let mut bytes = vec![0; rng.random_range(0..400)];
        rng.fill_bytes(&mut bytes);
        // What is read of noise does not matter, only that reading returns.
        let _outcome = read_bytes(Path::new("noise"), &bytes, &options());
    }
}

fn mutate(bytes: &mut Vec<u8>, rng: &mut ChaCha8Rng) {
    if bytes.is_empty() {
        bytes.push(rng.random());
        return;
    }
    let at = rng.random_range(0..bytes.len());
    let end = (at + rng.random_range(1..40)).min(bytes.len());
    match rng.random_range(0..6) {
        0 => bytes[at] = rng.random(),
        1 => bytes[at] ^= 1 << rng.random_range(0..8),
        2 => drop(bytes.drain(at..end)),
        3 => bytes.truncate(at),
        4 => {
            let copy = bytes[at..end].to_vec();
            bytes.splice(at..at, copy);
        }
        _ => {
            let piece = PIECES[rng.random_range(0..PIECES.len())];
            bytes.splice(at..at, piece.bytes());
        }
    }
}
