//! Checksums of files, so that damage shows, and the notes that results keep of what was read.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Component, Path, PathBuf, absolute};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::error::{Error, InputError, Result};

/// Bytes read at once, so that the size of a file does not matter to memory.
const CHUNK: usize = 1 << 16;

/// Bytes as people write them: two hexadecimal digits each.
pub fn hexadecimal(bytes: &[u8]) -> String {
    let digits = bytes.iter().flat_map(|byte| [byte >> 4, byte & 0xf]);
    digits.filter_map(|digit| char::from_digit(digit.into(), 16)).collect()
}

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
            Ok(0) => return Ok(hexadecimal(&hash.finalize())),
            Ok(read) => hash.update(&chunk[..read]),
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
}

/// Passes what is written on, and hashes it on its way.
pub struct Hashing<W> {
    to: W,
    hash: Sha256,
}

impl<W> Hashing<W> {
    /// On its way to `to`; nothing yet.
    pub fn new(to: W) -> Self {
        Self { to, hash: Sha256::new() }
    }

    /// Where it went, and the SHA-256 of all of it, 64 hexadecimal digits.
    pub fn finish(self) -> (W, String) {
        (self.to, hexadecimal(&self.hash.finalize()))
    }
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.to.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileNote {
    /// What it is.
    pub role: String,
    /// Where it was, from the root.
    pub path: String,
    /// Where it was, from the output folder: found again where both were moved together.
    #[serde(default)]
    pub path_from_folder: Option<String>,
    /// SHA-256 of its contents.
    pub sha256: String,
}

impl FileNote {
    /// The note of a file that plays a role.
    ///
    /// # Errors
    /// An input error if the file cannot be read.
    pub fn of(role: &str, path: &Path) -> Result<Self> {
        let from_root = absolute(path).map_err(|e| Error::io("find", path, e))?;
        Ok(Self {
            role: role.to_owned(),
            path: from_root.display().to_string(),
            path_from_folder: None,
            sha256: file_sha256(path)?,
        })
    }

    /// With the way to the file from the folder of the results.
    pub fn seen_from(self, folder: &Path) -> Self {
        Self { path_from_folder: path_from(folder, &self.path), ..self }
    }
}

/// The way from a folder to a file; `None` where one of them does not exist, or they have no root in common.
fn path_from(folder: &Path, file: &str) -> Option<String> {
    // Without links: `..` leads up the real way.
    let (folder, file) = (folder.canonicalize().ok()?, Path::new(file).canonicalize().ok()?);
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = from[common..].iter().map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(to[common..].iter().copied()).collect();
    (common > 0).then(|| way.display().to_string())
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

    #[test]
    fn analytic_what_is_written_hashes_as_what_is_read() {
        // Into a slice with less room than bytes: what did not go through is not hashed.
        let mut room = [0; 5];
        let mut hashing = Hashing::new(&mut room[..]);
        assert_eq!(hashing.write(b"abc").expect("room"), 3);
        assert_eq!(hashing.write(b"def").expect("some room"), 2);
        let (_, found) = hashing.finish();
        assert_eq!(found, sha256(&b"abcde"[..]).expect("memory can be read"));
    }
}
