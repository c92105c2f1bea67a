//! What a command answers, before anything of it is printed: the command line prints it, Python hands it on.

use std::path::PathBuf;

use super::output;
use crate::error::Result;

/// The answer of a command.
#[derive(Debug, Clone)]
pub struct Answer {
    /// What `--json` prints.
    pub json: String,
    /// What is printed without it.
    pub text: String,
    /// What a reader should know beside it, each a sentence.
    pub notes: Vec<String>,
    /// The page that was written.
    pub page: Option<PathBuf>,
}

impl Answer {
    /// Prints the answer on stdout, and what stands beside it on stderr.
    pub(super) fn print(&self, as_json: bool) -> Result<()> {
        let page = self.page.iter().map(|page| page.display().to_string());
        page.chain(self.notes.iter().cloned()).for_each(|line| eprintln!("mrbd: {line}"));
        output::print(if as_json { &self.json } else { &self.text }.trim_end())
    }
}
