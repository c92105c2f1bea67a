//! Checksums: of files that were read, and of results, so that damage shows.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::error::{InputError, Result};

/// Bytes read at once, so that the size of a file does not matter to memory.
const CHUNK: usize = 1 << 16;

/// SHA-256 of a file's contents, 64 hexadecimal digits.
///
/// # Errors
/// An input error if the file cannot be read.
pub fn file_sha256(path: &Path) -> Result<String> {
    File::open(path)
        .and_then(sha256)
        .map_err(|e| InputError::file(path, e.to_string(), "a readable file").into())
}

/// SHA-256 of what is left to read.
pub fn sha256(mut from: impl Read) -> io::Result<String> {
    let mut hash = Sha256::new();
    let mut chunk = vec![0; CHUNK];
    loop {
        match from.read(&mut chunk) {
            Ok(0) => return Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()),
            Ok(read) => hash.update(&chunk[..read]),
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_sha256_of_abc_and_of_a_million_a() {
        // FIPS 180-2, appendices B.1 and B.3.
        let of = |bytes: &[u8]| sha256(bytes).expect("memory can be read");
        assert_eq!(of(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        let million = vec![b'a'; 1_000_000];
        assert_eq!(of(&million), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    }
}
