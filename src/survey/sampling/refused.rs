//! Why a sampler cannot be made.

use std::path::Path;

use crate::error::InputError;

/// A fault under a key of whatever file the caller read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{key}: found {found}; allowed: {allowed}")]
pub struct Refused {
    /// Dotted key.
    pub key: String,
    /// What was found there.
    pub found: String,
    /// What is allowed there.
    pub allowed: String,
}

impl Refused {
    pub(super) fn new(key: &str, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { key: key.into(), found: found.into(), allowed: allowed.into() }
    }

    /// The fault as one of the file `path`.
    pub fn at(self, path: &Path) -> InputError {
        InputError::key(path, self.key, self.found, self.allowed)
    }
}
