//! How far long work is.

use std::fmt::Debug;

/// Told how far long work is: a command shows it as a bar, `()` shows nothing.
pub trait Progress: Debug + Send + Sync {
    /// A step begins, of so many parts.
    fn begin(&self, what: &str, parts: usize);
    /// So many parts are done.
    fn advance(&self, parts: usize);
    /// What stands beside the count: the best so far.
    fn note(&self, text: &str);
}

impl Progress for () {
    fn begin(&self, _what: &str, _parts: usize) {}
    fn advance(&self, _parts: usize) {}
    fn note(&self, _text: &str) {}
}
