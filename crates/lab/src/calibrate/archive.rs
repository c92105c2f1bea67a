//! Every simulation of a calibration: kept in a journal as it goes, so that a stopped calibration can be resumed.
//!
//! A search is a pure function of its inputs and its seed. Resuming therefore runs it again from the start, and takes
//! from the journal what was simulated before; the result is the same, bit by bit. Searches by the errors of every
//! sample (Gauss-Newton, bootstrap) simulate again. Their errors are thousands of numbers a run, which cost more to
//! keep than to make. Counts do not depend on it: a simulation counts once, whether it was taken from the journal or
//! made again.
//!
//! The journal has a line of text a simulation, each whole or not there.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::Progress;
use crate::experiment::Simulated;
use mrbd_files::error::{Error, InputError, Result};

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
    /// Eq. 8; `None` where the run could not be finished.
    pub wme: Option<f64>,
    /// `stood`, `collapsed`, `failed`, `abandoned` (hopeless before its end) or `impossible` (no such wall).
    pub outcome: String,
    /// Impacts by change of Table 2.
    pub transitions: [u64; 8],
    /// Steps of the integration.
    pub steps: u64,
}

impl Row {
    /// The row of a simulation; `None`: the values make no possible wall.
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

/// Where a row that is kept comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Simulated for the first time.
    New,
    /// Simulated again, for its errors: the journal of a stopped calibration has the rest.
    Again,
    /// Taken from the journal of a stopped calibration.
    Recalled,
}

#[derive(Debug)]
struct Kept {
    journal: File,
    rows: Vec<Row>,
    simulations: usize,
    run_here: usize,
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
        let kept = Kept { journal, rows: Vec::new(), simulations: 0, run_here: 0, best: HashMap::new() };
        Ok(Self { path: path.to_path_buf(), earlier, kept: Mutex::new(kept), progress })
    }

    /// The simulation as it was done before the calibration was stopped, if it was, with the same values.
    pub fn recall(&self, address: &Address, values: &[f64]) -> Option<Row> {
        self.earlier.get(address).filter(|row| row.values == values).cloned()
    }

    /// Keeps the simulations of a generation; the journal gets those it does not have.
    ///
    /// # Errors
    /// [`Error::Io`] if the disk refuses.
    pub fn keep(&self, rows: Vec<(Row, Origin)>) -> Result<()> {
        // The lock only guards plain data, which stays whole if another thread panics.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let new = rows.iter().filter(|(_, origin)| *origin == Origin::New);
        let lines = new.map(|(row, _)| line(row)).collect::<String>();
        kept.journal
            .write_all(lines.as_bytes())
            .map_err(|e| Error::io("write the journal", &self.path, e))?;
        kept.simulations += rows.len();
        kept.run_here += rows.iter().filter(|(_, origin)| *origin != Origin::Recalled).count();
        kept.rows.extend(rows.into_iter().map(|(row, _)| row));
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

    /// Simulations of the whole calibration: the same number with a stop as without one.
    pub fn simulations(&self) -> usize {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).simulations
    }

    /// Those of them that were run since the archive was opened.
    pub fn run_here(&self) -> usize {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).run_here
    }

    /// All simulations, by method in the order of `methods`, test, generation and index. Of one that was abandoned
    /// and later simulated to its end, the latter.
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

/// A row as a line: numbers in the shortest form that reads back as the same bits.
pub(super) fn line(row: &Row) -> String {
    let a = &row.address;
    let mut text = format!("{}\t{}\t{}\t{}\t{}\t", a.method, a.test, a.generation, a.index, row.outcome);
    let wme = row.wme.map_or_else(|| "-".to_owned(), |wme| format!("{wme:?}"));
    text.push_str(&wme);
    text.push_str(&format!("\t{}", row.steps));
    text.extend(row.transitions.iter().map(|n| format!("\t{n}")));
    text.extend(row.values.iter().map(|x| format!("\t{x:?}")));
    text.push_str("\t.\n");
    text
}

/// Reads a line back; `None` for a line that was cut short.
fn parse_line(text: &str) -> Option<Row> {
    let fields = text.strip_suffix("\t.")?.split('\t').collect::<Vec<_>>();
    let (head, tail) = fields.split_at_checked(7)?;
    let (counts, values) = tail.split_at_checked(8)?;
    let counts = counts.iter().map(|n| n.parse().ok()).collect::<Option<Vec<u64>>>()?;
    let address = Address {
        method: head[0].to_owned(),
        test: head[1].parse().ok()?,
        generation: head[2].parse().ok()?,
        index: head[3].parse().ok()?,
    };
    Some(Row {
        address,
        outcome: head[4].to_owned(),
        wme: if head[5] == "-" { None } else { Some(head[5].parse().ok()?) },
        steps: head[6].parse().ok()?,
        transitions: counts.try_into().ok()?,
        values: values.iter().map(|x| x.parse().ok()).collect::<Option<Vec<f64>>>()?,
    })
}

/// The simulations of a journal of this request.
///
/// # Errors
/// An input error for a journal of another calibration; [`Error::Io`] if it cannot be read.
pub(super) fn read_journal(path: &Path, request: &str) -> Result<HashMap<Address, Row>> {
    let text = std::fs::read_to_string(path).map_err(|e| Error::io("read the journal", path, e))?;
    let mut lines = text.lines();
    if lines.next() != Some(request) {
        let allowed = "the output folder of this calibration, with the same inputs and seed, or a new folder";
        return Err(InputError::file(path, "the journal of another calibration", allowed).into());
    }
    Ok(lines.filter_map(parse_line).map(|row| (row.address.clone(), row)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_a_journal_of_another_calibration() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("journal.tsv");
        let open = |request: &str| Archive::open(&path, request, true, Box::new(()));
        open("a").and_then(|archive| archive.keep(vec![(row(), Origin::New)])).expect("kept");
        let again = open("a").expect("the same calibration");
        assert_eq!(again.recall(&row().address, &row().values), Some(row()));
        assert_eq!(again.recall(&row().address, &[0.0, 0.0, 0.0]), None);
        assert_eq!(open("b").expect_err("another").exit_code(), 2);
    }

    #[test]
    fn analytic_a_simulation_counts_once_wherever_it_comes_from() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("journal.tsv");
        let counts = |origins: [Origin; 2]| {
            let archive = Archive::open(&path, "a", true, Box::new(())).expect("a journal");
            archive.keep(origins.map(|origin| (row(), origin)).to_vec()).expect("kept");
            (archive.simulations(), archive.run_here())
        };
        assert_eq!(counts([Origin::New; 2]), (2, 2));
        assert_eq!(counts([Origin::Recalled, Origin::Again]), (2, 1));
        let lines = std::fs::read_to_string(&path).expect("the journal").lines().count();
        // The request, two new rows, and an empty line where the journal was gone on with.
        assert_eq!(lines, 4);
    }

    pub fn row() -> Row {
        let address = Address { method: "paper".into(), test: 1, generation: 2, index: 3 };
        let values = vec![0.1 + 0.2, 1.0 / 3.0, 37e3];
        let transitions = [0, 1, 2, 3, 4, 5, 6, 7];
        Row { address, values, wme: Some(1e-300), outcome: "stood".into(), transitions, steps: 9 }
    }

    #[test]
    fn analytic_a_row_reads_back_bit_by_bit_and_a_cut_line_not_at_all() {
        let text = line(&row());
        assert_eq!(parse_line(text.trim_end()), Some(row()));
        let cut = &text[..text.len() - 4];
        assert_eq!(parse_line(cut), None);
        let failed = Row { wme: None, outcome: "failed".into(), ..row() };
        assert_eq!(parse_line(line(&failed).trim_end()), Some(failed));
    }
}
