//! Record files: recognised by content, read into m/s², faults named with file and line.
//!
//! A format is one entry of [`FORMATS`]: its name, its words for people, how it is recognised, how it is read. The
//! entry stands in the file that reads the format; refusals, help texts and docs list what the table holds.

mod channel;
mod chosen;
mod columns;
mod cosmos;
mod csmip;
mod dyna;
mod geonet;
mod knet;
mod peer;
mod source;

use std::fmt;
use std::path::Path;

use crate::{Accelerogram, Unit};
use mrbd_files::error::{InputError, Result};

pub use chosen::{ColumnChoice, NoColumns};
pub use columns::write_two_columns;

use channel::Channel;
use source::{Source, step};

/// Largest record file that is read, bytes: an hour of three channels at 200 samples a second is a tenth of it.
const LARGEST_FILE_BYTES: u64 = 256 << 20;

/// A format of record files.
#[derive(Debug)]
pub struct Format {
    /// Its name.
    pub name: &'static str,
    /// What a list of formats says of it.
    pub words: &'static str,
    /// Whether a file is of this format; entries before it in the table have been tried.
    recognise: fn(&Source) -> bool,
    /// The channels of a file of this format.
    parse: fn(&Source, &ReadOptions) -> Result<Vec<Channel>, InputError>,
}

/// The formats, in the order in which they are tried.
pub static FORMATS: [Format; 8] = [
    columns::TWO_COLUMNS,
    dyna::FORMAT,
    knet::FORMAT,
    cosmos::FORMAT,
    csmip::FORMAT,
    geonet::FORMAT,
    peer::FORMAT,
    columns::ONE_COLUMN,
];

/// The formats in words, the last one after `conjunction`: "…, CSMIP V2 or one number a line".
pub fn formats_in_words(conjunction: &str) -> String {
    let words: Vec<&str> = FORMATS.iter().map(|format| format.words).collect();
    match words.split_last() {
        Some((last, before)) => format!("{} {conjunction} {last}", before.join(", ")),
        None => String::new(),
    }
}

impl PartialEq for Format {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Format {}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// What the caller knows about a file; what the file itself states must not contradict it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// Time between samples, s; must be given for a single column.
    pub step_s: Option<f64>,
    /// Unit of the samples, where the file states none.
    pub unit: Option<Unit>,
    /// Which channel of a file of several: its number from 1, its name, or the first word of its name.
    pub channel: Option<String>,
    /// Columns of a table that is of no format: its unit must be given too.
    pub columns: Option<ColumnChoice>,
    /// Whether the numbers of such a table have a comma as their decimal sign.
    pub decimal_comma: bool,
}

/// A record as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// File name without folder and last extension.
    pub name: String,
    /// Format the content was recognised as.
    pub format: &'static Format,
    /// Name of the channel, where the format names channels.
    pub channel: Option<String>,
    /// Unit the samples were written in.
    pub unit: Unit,
    /// The motion, in m/s².
    pub accelerogram: Accelerogram,
}

/// Reads the record file `path`.
///
/// # Errors
/// Input errors that name file, line, what was found and what is allowed. A file is refused that is unreadable, of no
/// known format or malformed. So is one of several channels without a choice, and one that contradicts `options`.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Record> {
    let readable = "a readable record file";
    let size = std::fs::metadata(path).map_err(|e| InputError::file(path, e.to_string(), readable))?.len();
    if size > LARGEST_FILE_BYTES {
        let allowed = format!("at most {LARGEST_FILE_BYTES} bytes in a record file");
        return Err(InputError::file(path, format!("{size} bytes"), allowed).into());
    }
    let bytes = std::fs::read(path).map_err(|e| InputError::file(path, e.to_string(), readable))?;
    Ok(read_bytes(path, &bytes, options)?)
}

/// Reads a record from the bytes of a file; `path` only names it in the record and in faults.
///
/// # Errors
/// As [`read`], but for reading the file.
pub fn read_bytes(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Record, InputError> {
    let text = source::decode(bytes);
    let source = Source::new(path, &text);
    if let Some(step_s) = options.step_s.filter(|step_s| step(Some(*step_s)).is_none()) {
        return Err(source.fault_file(format!("a step of {step_s} s given for it"), "1e-6 to 10 s"));
    }
    let format = if options.columns.is_some() { &chosen::FORMAT } else { recognise(&source)? };
    let channels = (format.parse)(&source, options)?;
    let channel = channel::choose(&source, channels, options.channel.as_deref())?;
    channel.into_record(&source, format, options)
}

fn recognise(source: &Source) -> Result<&'static Format, InputError> {
    let known = || format!("a record: {}", formats_in_words("or"));
    let Some(first) = source.first else {
        return Err(source.fault_file("no data", known()));
    };
    if let Some(format) = FORMATS.iter().find(|format| (format.recognise)(source)) {
        return Ok(format);
    }
    if !chosen::is_table(source) {
        return Err(source.fault_line(first, known()));
    }
    let columns = "one number a line, or two columns under the header line `time_s,acceleration_m_s2`";
    Err(source.fault_line(first, format!("{columns}; {}", chosen::HOW)))
}
