//! Every simulation of a calibration: kept in a journal as it goes, so that a stopped calibration can be resumed.
//!
//! A search is a pure function of its inputs and its seed. Resuming therefore runs it again from the start, and takes
//! from the journal what was simulated before; the result is the same, bit by bit.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::journal::{line, read_journal};
use crate::Progress;
use crate::experiment::Simulated;
use mrbd_files::error::{Error, Result};

/// Which simulation: the `index`-th candidate of a generation of a search, in one test.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Address {
    /// Name of the search.
    pub method: String,
    /// Number of the test in the experiment, from 0.
    pub test: usize,
    /// Generation, from 0.
    pub generation: u32,
    /// Place in the generation, from 0.
    pub index: u32,
}

/// What is kept of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Which one.
    pub address: Address,
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// Eq. 8; none where the run could not be finished.
    pub wme: Option<f64>,
    /// `stood`, `collapsed`, `failed`, `abandoned` (hopeless before its end) or `impossible` (no such wall).
    pub outcome: String,
    /// Impacts by change of Table 2.
    pub transitions: [u64; 8],
    /// Steps of the integration.
    pub steps: u64,
}

impl Row {
    /// The row of a simulation; none: the values make no possible wall.
    pub fn of(address: Address, values: &[f64], simulated: Option<&Simulated>) -> Self {
        let (wme, outcome, transitions, steps) = match simulated {
            Some(s) => (s.wme, s.outcome, s.transitions, s.steps),
            None => (None, "impossible", [0; 8], 0),
        };
        Self { address, values: values.to_vec(), wme, outcome: outcome.to_owned(), transitions, steps }
    }
}

/// All simulations so far.
#[derive(Debug)]
pub struct Archive {
    path: PathBuf,
    earlier: HashMap<Address, Row>,
    kept: Mutex<Kept>,
    progress: Box<dyn Progress>,
}

#[derive(Debug)]
struct Kept {
    journal: File,
    rows: Vec<Row>,
    simulated: usize,
    best: HashMap<String, f64>,
}

impl Archive {
    /// Begins a journal, or goes on with the one that is there.
    ///
    /// `request` identifies the inputs: a journal of others is not gone on with. `progress` is told how many simulations are
    /// done, and the best so far.
    ///
    /// # Errors
    /// An input error for a journal of another calibration; [`Error::Io`] if the disk refuses.
    pub fn open(path: &Path, request: &str, resume: bool, progress: Box<dyn Progress>) -> Result<Self> {
        let earlier = if resume && path.exists() { read_journal(path, request)? } else { HashMap::new() };
        let failed = |e| Error::io("write the journal", path, e);
        let journal = if earlier.is_empty() {
            let mut file = File::create(path).map_err(failed)?;
            writeln!(file, "{request}").map_err(failed)?;
            file
        } else {
            let mut file = OpenOptions::new().append(true).open(path).map_err(failed)?;
            // Ends a line that was cut short when the program was stopped.
            writeln!(file).map_err(failed)?;
            file
        };
        let kept = Kept { journal, rows: Vec::new(), simulated: 0, best: HashMap::new() };
        Ok(Self { path: path.to_path_buf(), earlier, kept: Mutex::new(kept), progress })
    }

    /// The simulation as it was done before the calibration was stopped, if it was, with the same values.
    pub fn recall(&self, address: &Address, values: &[f64]) -> Option<Row> {
        self.earlier.get(address).filter(|row| row.values == values).cloned()
    }

    /// Keeps the simulations of a generation; `new` of them were not recalled.
    ///
    /// # Errors
    /// [`Error::Io`] if the disk refuses.
    pub fn keep(&self, rows: Vec<Row>, new: &[bool]) -> Result<()> {
        // The lock only guards plain data, which stays whole if another thread panics.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let lines =
            rows.iter().zip(new).filter(|(_, new)| **new).map(|(row, _)| line(row)).collect::<String>();
        kept.journal
            .write_all(lines.as_bytes())
            .map_err(|e| Error::io("write the journal", &self.path, e))?;
        kept.simulated += new.iter().filter(|new| **new).count();
        kept.rows.extend(rows);
        Ok(())
    }

    /// Tells the best cost of a search.
    pub fn show_best(&self, search: &str, cost: f64, simulations: usize) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let best = kept.best.entry(search.to_owned()).or_insert(f64::INFINITY);
        *best = best.min(cost);
        self.progress.note(&format!("{search}: best cost {best:.4}"));
        self.progress.advance(simulations);
    }

    /// Simulations run, those recalled not counted.
    pub fn simulated(&self) -> usize {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).simulated
    }

    /// All simulations, by method in the order of `methods`, test, generation and index; of one that was abandoned and
    /// then asked for to its end, the latter.
    pub fn rows(&self, methods: &[String]) -> Vec<Row> {
        let mut rows = self.kept.lock().unwrap_or_else(PoisonError::into_inner).rows.clone();
        let place = |row: &Row| methods.iter().position(|m| *m == row.address.method);
        rows.sort_by(|a, b| (place(a), &a.address).cmp(&(place(b), &b.address)));
        rows.reverse();
        rows.dedup_by(|earlier, later| earlier.address == later.address);
        rows.reverse();
        rows
    }

    /// Removes the journal of a finished calibration.
    ///
    /// # Errors
    /// [`Error::Io`] if the disk refuses.
    pub fn close(self) -> Result<()> {
        std::fs::remove_file(&self.path).map_err(|e| Error::io("remove the journal", &self.path, e))
    }
}

#[cfg(test)]
mod tests {
    use super::super::journal::tests::row;
    use super::*;

    #[test]
    fn rejects_a_journal_of_another_calibration() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("journal.tsv");
        let open = |request: &str| Archive::open(&path, request, true, Box::new(()));
        open("a").and_then(|archive| archive.keep(vec![row()], &[true])).expect("kept");
        let again = open("a").expect("the same calibration");
        assert_eq!(again.recall(&row().address, &row().values), Some(row()));
        assert_eq!(again.recall(&row().address, &[0.0, 0.0, 0.0]), None);
        assert_eq!(open("b").expect_err("another").exit_code(), 2);
    }
}
