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
    /// Hypotheses were fitted: what is known should the work end here.
    fn tried(&self, _best: &[Tried]) {}
}

/// A hypothesis as far as it is fitted; a later fit of the same one is better.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// What is added to the wall; empty for its own numbers alone.
    pub name: String,
    /// Added numbers: key, value, unit.
    pub numbers: Vec<(String, f64, String)>,
    /// Windowed errors of the tests to fit and of those held out, in standard deviations of the noise.
    pub windowed_error: [Option<f64>; 2],
    /// What speaks against it in all tests, in natural logarithms of likelihood.
    pub against: f64,
}

impl Progress for () {
    fn begin(&self, _what: &str, _parts: usize) {}
    fn advance(&self, _parts: usize) {}
    fn note(&self, _text: &str) {}
}
