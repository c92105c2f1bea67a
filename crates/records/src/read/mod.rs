//! Record files: told apart by content, read into m/s², faults told with file and line.

mod channel;
mod cosmos;
mod csmip;
mod dyna;
mod format;
mod geonet;
mod knet;
mod one_column;
mod peer;
mod source;
mod two_column;

use std::path::Path;

use crate::{Accelerogram, Unit};
use mrbd_files::error::{InputError, Result};

pub use format::Format;

use channel::Channel;
use source::Source;

/// Largest record file that is read, bytes: an hour of three channels at 200 samples a second is a tenth of it.
const LARGEST_FILE_BYTES: u64 = 256 << 20;

/// What the caller knows about a file; what the file itself tells must not contradict it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// Time between samples, s; must be given for a single column.
    pub step_s: Option<f64>,
    /// Unit of the samples, where the file does not tell.
    pub unit: Option<Unit>,
    /// Which channel of a file of several: its number from 1, its name, or the first word of its name.
    pub channel: Option<String>,
}

/// A record as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// File name without folder and last extension.
    pub name: String,
    /// Format the content was recognised as.
    pub format: Format,
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
/// Input errors that name file, line, what was found and what is allowed: unreadable, of no known format,
/// malformed, of several channels with none chosen, or contradicting `options`.
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
    let format = format::recognise(&source)?;
    let channels = parse(format, &source, options)?;
    let channel = channel::choose(&source, channels, options.channel.as_deref())?;
    channel.into_record(&source, format, options)
}

fn parse(format: Format, source: &Source, options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    match format {
        Format::TwoColumn => two_column::parse(source),
        Format::OneColumn => one_column::parse(source, options),
        Format::Peer => peer::parse(source),
        Format::Dyna => dyna::parse(source),
        Format::GeoNet => geonet::parse(source),
        Format::Cosmos => cosmos::parse(source),
        Format::Csmip => csmip::parse(source),
        Format::Knet => knet::parse(source),
    }
}
