//! Fits that ended because they had worked as much as they may: none of them is an answer, and all are told.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// How many fits of what ended before they were done.
#[derive(Debug, Default)]
pub struct Unfinished {
    fits: Mutex<BTreeMap<String, usize>>,
}

impl Unfinished {
    /// A fit of a hypothesis of this name has ended.
    pub fn tell(&self, name: &str) {
        *self.fits.lock().unwrap_or_else(PoisonError::into_inner).entry(name.to_owned()).or_default() += 1;
    }

    /// A fit that had ended has come to its end after all.
    pub fn take_back(&self, name: &str) {
        let mut fits = self.fits.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(count) = fits.get_mut(name) {
            *count -= 1;
        }
        fits.retain(|_, count| *count > 0);
    }

    /// All of them, by name.
    pub fn all(&self) -> BTreeMap<String, usize> {
        self.fits.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
