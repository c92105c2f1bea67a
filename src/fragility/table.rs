//! Tables of results: the columns that are asked for, from CSV, Parquet, or the output folder of a study.

use std::path::{Path, PathBuf};

use polars::prelude::{PolarsError, PolarsResult};

use crate::error::{Error, InputError, Result};
use crate::store::frame::{self, Frame};
use mrbd_files::suggestion::with_suggestion;

/// A column as it stands in the table; an empty cell or a null is none.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Texts, of CSV always.
    Texts(Vec<Option<String>>),
    /// Numbers; truth values are 1 and 0.
    Numbers(Vec<Option<f64>>),
}

/// Columns of a table, all of one length.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    path: PathBuf,
    names: Vec<String>,
    columns: Vec<Cells>,
    /// Line of each row in a CSV file.
    lines: Option<Vec<u64>>,
    rows: usize,
}

impl Table {
    /// Reads the columns `names` of a .csv or .parquet file, or of a folder with the runs of a study.
    ///
    /// # Errors
    /// Input errors for a file that cannot be read, another extension, a column that is not there or is there twice,
    /// and a table without rows.
    pub fn read(path: &Path, names: &[&str]) -> Result<Self> {
        let mut names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        names.sort_unstable();
        names.dedup();
        let table = match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
            _ if path.is_dir() => read_parquet(path, &crate::study::runs::run_files(path)?, names)?,
            Some("csv") => read_csv(path, names)?,
            Some("parquet") => read_parquet(path, &[path.to_path_buf()], names)?,
            other => {
                let found = format!("extension {:?}", other.unwrap_or(""));
                let allowed = "a .csv or .parquet table, or the output folder of a study";
                return Err(InputError::file(path, found, allowed).into());
            }
        };
        if table.rows == 0 {
            return Err(InputError::file(path, "a table without rows", "at least one row").into());
        }
        Ok(table)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// A column that was read.
    fn cells(&self, name: &str) -> Result<&Cells> {
        let at = self.names.iter().position(|known| known == name);
        let missing =
            || InputError::file(&self.path, format!("no column {name:?}"), "the columns that were read");
        Ok(at.map(|i| &self.columns[i]).ok_or_else(missing)?)
    }

    /// A column as numbers.
    ///
    /// # Errors
    /// An input error with the line or row for a text that is no finite number.
    pub fn numbers(&self, name: &str) -> Result<Vec<Option<f64>>> {
        match self.cells(name)? {
            Cells::Numbers(numbers) => match numbers.iter().position(|x| x.is_some_and(|x| !x.is_finite())) {
                Some(row) => Err(self.fault(name, row, "a number without a value", "finite numbers").into()),
                None => Ok(numbers.clone()),
            },
            Cells::Texts(texts) => texts
                .iter()
                .enumerate()
                .map(|(row, text)| text.as_deref().map(|text| self.number(name, row, text)).transpose())
                .collect(),
        }
    }

    fn number(&self, name: &str, row: usize, text: &str) -> Result<f64> {
        let finite = |text: &str| text.parse().ok().filter(|value: &f64| value.is_finite());
        let point = text.replacen(',', ".", 1);
        let allowed = match finite(&point).filter(|_| text.contains(',')) {
            Some(_) => format!("a finite number with a decimal point: {point}"),
            None => "a finite number".to_owned(),
        };
        Ok(finite(text).ok_or_else(|| self.fault(name, row, format!("{text:?}"), allowed))?)
    }

    /// A column as labels; numbers as they are printed. A cell without one, or that is not a number, is an empty label.
    ///
    /// # Errors
    /// An input error if the column was not read: a slip of the caller.
    pub fn labels(&self, name: &str) -> Result<Vec<String>> {
        Ok(match self.cells(name)? {
            Cells::Texts(texts) => texts.iter().map(|text| text.clone().unwrap_or_default()).collect(),
            Cells::Numbers(numbers) => {
                let label = |x: &f64| x.to_string();
                let finite = numbers.iter().map(|number| number.as_ref().filter(|x| x.is_finite()));
                finite.map(|number| number.map_or_else(String::new, label)).collect()
            }
        })
    }

    /// A fault in a cell: with the line in a CSV file, with the row elsewhere.
    pub fn fault(
        &self,
        name: &str,
        row: usize,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> InputError {
        let found = found.into();
        match self.lines.as_ref().and_then(|lines| lines.get(row)) {
            Some(&line) => InputError::line(&self.path, line as usize, format!("{name}: {found}"), allowed),
            None => InputError::key(&self.path, name, format!("{found} in row {}", row + 1), allowed),
        }
    }
}

fn read_csv(path: &Path, names: Vec<String>) -> Result<Table> {
    let fault = |e: &csv::Error| {
        let line = e.position().map_or(1, csv::Position::line) as usize;
        InputError::line(path, line, e.to_string(), "a CSV table with a header and rows of its length")
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(|e| fault(&e))?;
    let header = reader.headers().map_err(|e| fault(&e))?.clone();
    let known: Vec<&str> = header.iter().collect();
    check_commas(path, &known)?;
    let places = find(path, &names, &known)?;
    let mut columns: Vec<Vec<Option<String>>> = vec![Vec::new(); names.len()];
    let mut lines = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(&e))?;
        lines.push(record.position().map_or(0, csv::Position::line));
        for (column, &place) in columns.iter_mut().zip(&places) {
            column.push(record.get(place).filter(|cell| !cell.is_empty()).map(str::to_owned));
        }
    }
    let columns = columns.into_iter().map(Cells::Texts).collect();
    Ok(Table { path: path.to_path_buf(), names, columns, rows: lines.len(), lines: Some(lines) })
}

/// A header that is one cell with semicolons or tabs in it is of another kind of table.
fn check_commas(path: &Path, header: &[&str]) -> Result<()> {
    let [cell] = header else { return Ok(()) };
    let parted_by = [(';', "semicolons"), ('\t', "tabs")].into_iter().find(|(mark, _)| cell.contains(*mark));
    let Some((_, name)) = parted_by else { return Ok(()) };
    let found = format!("columns parted by {name}: `{}`", cell.escape_debug());
    let allowed = "columns parted by commas, and numbers with a decimal point";
    Err(InputError::line(path, 1, found, allowed).into())
}

/// Where the columns stand among those `known`.
fn find(path: &Path, names: &[String], known: &[&str]) -> Result<Vec<usize>> {
    let place = |name: &String| {
        let mut places = known.iter().enumerate().filter(|(_, known)| *known == name).map(|(i, _)| i);
        match (places.next(), places.next()) {
            (Some(place), None) => Ok(place),
            (Some(_), Some(_)) => {
                Err(InputError::file(path, format!("two columns {name:?}"), "a name for each column").into())
            }
            (None, _) => {
                if known.is_empty() {
                    return Err(InputError::file(path, "an empty file", "a header and rows").into());
                }
                let found = format!("no column {name:?}");
                let allowed =
                    with_suggestion(format!("one of {}", known.join(", ")), name, known.iter().copied());
                Err(InputError::file(path, found, allowed).into())
            }
        }
    };
    names.iter().map(place).collect()
}

fn read_parquet(path: &Path, files: &[PathBuf], names: Vec<String>) -> Result<Table> {
    let unreadable =
        |e: PolarsError| InputError::file(path, e.to_string(), "a Parquet table that can be read");
    let known = match files.first() {
        Some(first) => frame::column_names(first).map_err(unreadable)?,
        None => Vec::new(),
    };
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    find(path, &names, &known)?;
    let frame = frame::read(files, &names).map_err(unreadable)?;
    let columns: PolarsResult<Vec<Cells>> = names.iter().map(|name| cells(&frame, name)).collect();
    let columns = columns.map_err(|e| Error::table(path, e))?;
    Ok(Table { path: path.to_path_buf(), names, columns, rows: frame.height(), lines: None })
}

fn cells(frame: &Frame, name: &str) -> PolarsResult<Cells> {
    if let Some(numbers) = frame.as_numbers(name)? {
        return Ok(Cells::Numbers(numbers.iter().collect()));
    }
    let texts = frame.texts(name)?;
    Ok(Cells::Texts((0..frame.height()).map(|row| texts.get(row).map(str::to_owned)).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn csv(text: &str, names: &[&str]) -> Result<Table> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("t.csv");
        std::fs::write(&path, text).expect("written");
        Table::read(&path, names)
    }

    #[test]
    fn analytic_cells_of_a_csv_table() {
        let table = csv("a, b ,c\n1,x,\n2,y,3\n", &["c", "a", "b", "a"]).expect("valid");
        assert_eq!(table.numbers("a").expect("numbers"), [Some(1.0), Some(2.0)]);
        assert_eq!(table.numbers("c").expect("numbers"), [None, Some(3.0)]);
        assert_eq!(table.labels("b").expect("labels"), ["x", "y"]);
    }

    #[test]
    fn rejects_faults_with_line_and_column() {
        let message = |text: &str, names: &[&str]| csv(text, names).expect_err("refused").to_string();
        assert!(message("a,b\n1,2\n", &["c"]).contains("no column \"c\"; allowed: one of a, b"));
        assert!(message("a,a\n1,2\n", &["a"]).contains("two columns \"a\""));
        assert!(message("a,b\n1\n", &["a"]).contains("t.csv:2"), "a short row");
        assert!(message("a,b\n", &["a"]).contains("without rows"));
        let table = csv("a\n1\nnan\n", &["a"]).expect("texts are read as they are");
        let refused = table.numbers("a").expect_err("refused").to_string();
        assert!(refused.contains("t.csv:3: found a: \"nan\"; allowed: a finite number"), "{refused}");
        let semicolons = message("a;b\n1,5;2\n", &["a"]);
        assert!(semicolons.contains("t.csv:1: found columns parted by semicolons: `a;b`"), "{semicolons}");
        assert!(message("a\tb\n1\t2\n", &["a"]).contains("parted by tabs"));
        let decimal = csv("a,b\n\"0,5\",1\n", &["a"]).expect("texts are read as they are");
        let refused = decimal.numbers("a").expect_err("refused").to_string();
        assert!(refused.contains("\"0,5\"; allowed: a finite number with a decimal point: 0.5"), "{refused}");
        let other = Table::read(Path::new("a.txt"), &["a"]).expect_err("refused").to_string();
        assert!(other.contains("a.txt: found extension \"txt\""), "{other}");
    }
}
