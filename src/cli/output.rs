//! What a command answers, and printing it on stdout.

use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, InputError, Result};
use crate::store::{now_unix_s, write_durably};
use mrbd_files::FileNote;
use mrbd_records::Suite;

/// Prints on stdout; a reader that has seen enough (`| head`) is no error.
///
/// # Errors
/// What `print` meets, unless the reader has gone.
pub fn to_stdout(print: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    match print(&mut io::stdout().lock()) {
        Err(Error::Files(mrbd_files::Error::Io { source, .. })) if source.kind() == ErrorKind::BrokenPipe => {
            Ok(())
        }
        result => result,
    }
}

/// Prints a text and a line end on stdout.
///
/// # Errors
/// What the system says, unless the reader has gone.
pub fn print(text: &str) -> Result<()> {
    to_stdout(|stdout| writeln!(stdout, "{text}").and_then(|()| stdout.flush()).map_err(failed))
}

/// Refuses to write over a file that is read.
///
/// # Errors
/// An input error that names the option.
pub fn check_apart(option: &str, written: Option<&Path>, read: &[&Path]) -> Result<(), InputError> {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let Some(path) = written else { return Ok(()) };
    match real(path) {
        Some(file) if read.iter().any(|path| real(path).as_ref() == Some(&file)) => {
            let found = format!("{}, which is read", path.display());
            Err(InputError::option(option, found, "a file that is no input of this command"))
        }
        _ => Ok(()),
    }
}

/// Refuses a picture that is no .svg.
///
/// # Errors
/// An input error of `--plot`.
pub fn check_svg(path: &Path) -> Result<(), InputError> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().into_owned());
    match extension.filter(|extension| extension.eq_ignore_ascii_case("svg")) {
        Some(_) => Ok(()),
        None => Err(InputError::option("--plot", path.display().to_string(), "a file that ends in .svg")),
    }
}

/// Writes the manifest of results that are made at once.
///
/// # Errors
/// What the disk says.
pub fn write_manifest(
    path: &Path,
    kind: &str,
    name: &str,
    inputs: Vec<FileNote>,
    suite: Option<&Suite>,
) -> Result<()> {
    let suite = suite.map(|suite| (suite.name.as_str(), suite.generated));
    write_manifest_of(path, kind, name, inputs, suite)
}

/// The same for a suite that is told by name, and whether it is generated.
///
/// # Errors
/// What the disk says.
pub fn write_manifest_of(
    path: &Path,
    kind: &str,
    name: &str,
    inputs: Vec<FileNote>,
    suite: Option<(&str, bool)>,
) -> Result<()> {
    let manifest = serde_json::json!({
        "kind": kind,
        "name": name,
        "tool_version": env!("CARGO_PKG_VERSION"),
        "suite": suite.map(|(name, _)| name),
        "generated": suite.is_some_and(|(_, generated)| generated),
        "inputs": inputs,
        "started_unix_s": now_unix_s(),
    });
    write_durably(path, format!("{manifest:#}\n").as_bytes())
}

/// An error of a stream as an error of stdout.
pub fn failed(error: io::Error) -> Error {
    Error::io("print the results", Path::new("stdout"), error)
}

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
        print(if as_json { &self.json } else { &self.text }.trim_end())
    }
}
