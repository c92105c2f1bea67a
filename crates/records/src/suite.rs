//! A suite: records read from the files that a TOML file lists, checked and scaled.

use std::collections::BTreeSet;
use std::path::Path;

use super::suite_file::{RecordEntry, SuiteFile};
use super::{Accelerogram, ImpossiblePulse, IntensityMeasures, Motion, ReadOptions, Record, read};
use mrbd_files::error::{InputError, Result};
use mrbd_files::toml_file;
use mrbd_kernel::model::G_M_S2;

/// Relative difference allowed between a peak acceleration and what the suite says of it: published ones are rounded.
const PGA_TOLERANCE: f64 = 0.02;
/// The same for the peak velocity, which depends on how a record was corrected before it was published.
const PGV_TOLERANCE: f64 = 0.05;
/// Scale factors beyond this are mistakes of a unit.
const LARGEST_SCALE: f64 = 100.0;

/// Records to run a wall under.
#[derive(Debug, Clone, PartialEq)]
pub struct Suite {
    /// Name of the suite.
    pub name: String,
    /// Whether all its records are generated, not measured.
    pub generated: bool,
    /// What a reader should know.
    pub note: String,
    /// Where the records come from.
    pub source: String,
    /// The records, in the order of the file.
    pub records: Vec<SuiteRecord>,
}

/// A record of a suite, scaled.
#[derive(Debug, Clone, PartialEq)]
pub struct SuiteRecord {
    /// Number, unique in the suite.
    pub id: u32,
    /// The given name, or else the file's without folder and extension.
    pub name: String,
    /// Earthquake.
    pub event: String,
    /// Factor that `horizontal` and `intensity` already contain.
    pub scale: f64,
    /// Horizontal ground acceleration, scaled.
    pub horizontal: Accelerogram,
    /// Vertical ground acceleration, scaled by `vertical_scale`.
    pub vertical: Option<Accelerogram>,
    /// Factor that `vertical` already contains; that of the horizontal component unless given.
    pub vertical_scale: f64,
    /// Measures of `horizontal`, scaled.
    pub intensity: IntensityMeasures,
    /// Whether it was generated rather than measured.
    pub generated: bool,
    /// What else the suite file says of it.
    pub about: About,
}

/// What a suite file says of a record beside its numbers; empty or `None` where it says nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct About {
    /// Date of the earthquake.
    pub date: String,
    /// Station that recorded it.
    pub station: String,
    /// Class of the soil there.
    pub soil: String,
    /// Moment magnitude.
    pub magnitude: Option<f64>,
    /// Distance from the epicentre, km.
    pub distance_km: Option<f64>,
    /// Where the record comes from.
    pub source: String,
    /// What a reader should know.
    pub note: String,
}

impl Suite {
    /// Loads a suite; files it names are relative to its folder.
    ///
    /// # Errors
    /// Input errors that name the suite and the key, or the record file and the line.
    pub fn load(path: &Path) -> Result<Self> {
        Self::from_file(path, &toml_file::load(path)?)
    }

    /// Reads the records of a suite file that lies at `path`.
    pub(super) fn from_file(path: &Path, file: &SuiteFile) -> Result<Self> {
        if file.records.is_empty() {
            return Err(InputError::key(path, "records", "no records", "at least one `[[records]]`").into());
        }
        let mut ids = BTreeSet::new();
        let mut records = Vec::with_capacity(file.records.len());
        for (index, entry) in file.records.iter().enumerate() {
            let place = Entry { path, file, entry, index };
            if !ids.insert(entry.id) {
                return Err(place.fault("id", format!("{} again", entry.id), "numbers that differ").into());
            }
            records.push(place.load()?);
        }
        let generated = file.generated || records.iter().all(|r| r.generated);
        let (name, note, source) = (file.name.clone(), file.note.clone(), file.source.clone());
        Ok(Self { name, generated, note, source, records })
    }
}

/// One entry of a suite file, and where it stands for faults.
struct Entry<'a> {
    path: &'a Path,
    file: &'a SuiteFile,
    entry: &'a RecordEntry,
    index: usize,
}

impl Entry<'_> {
    fn fault(&self, key: &str, found: impl Into<String>, allowed: impl Into<String>) -> InputError {
        InputError::key(self.path, format!("records[{}].{key}", self.index), found, allowed)
    }

    fn load(&self) -> Result<SuiteRecord> {
        let entry = self.entry;
        let scale = self.scale("scale", entry.scale)?;
        let vertical_scale = self.scale("vertical_scale", entry.vertical_scale.unwrap_or(entry.scale))?;
        let (name, unscaled) = self.horizontal()?;
        self.check_peaks(&unscaled)?;
        let horizontal = unscaled.scaled(scale);
        Ok(SuiteRecord {
            id: entry.id,
            name: entry.name.clone().unwrap_or(name),
            event: entry.event.clone(),
            scale,
            vertical: self.vertical(horizontal.step_s())?.map(|record| record.scaled(vertical_scale)),
            vertical_scale,
            intensity: IntensityMeasures::of(&horizontal),
            horizontal,
            generated: self.file.generated || entry.generated || entry.pulse.is_some(),
            about: self.about(),
        })
    }

    fn scale(&self, key: &str, value: f64) -> Result<f64, InputError> {
        if value.is_finite() && value != 0.0 && value.abs() <= LARGEST_SCALE {
            return Ok(value);
        }
        let allowed = format!("a factor other than 0, at most {LARGEST_SCALE} in size");
        Err(self.fault(key, value.to_string(), allowed))
    }

    /// The record and its name.
    fn horizontal(&self) -> Result<(String, Accelerogram)> {
        match (&self.entry.file, &self.entry.pulse) {
            (Some(file), None) => {
                let record = self.read("file", file, self.entry.channel.clone())?;
                Ok((record.name, record.accelerogram))
            }
            (None, Some(pulse)) => {
                let step_s = self.entry.step_s.or(self.file.step_s);
                let refuse = |e: ImpossiblePulse| {
                    self.fault(&format!("pulse.{}", e.name), e.value.to_string(), e.allowed)
                };
                Ok((format!("pulse {}", self.entry.id), pulse.accelerogram(step_s).map_err(refuse)?))
            }
            (Some(_), Some(_)) => Err(self.fault("pulse", "`file` and `pulse`", "one of them").into()),
            (None, None) => {
                Err(self.fault("file", "no `file`", "the file of the record, or a `pulse`").into())
            }
        }
    }

    fn vertical(&self, step_s: f64) -> Result<Option<Accelerogram>> {
        let Some(file) = &self.entry.vertical else {
            return Ok(None);
        };
        let record = self.read("vertical", file, self.entry.vertical_channel.clone())?.accelerogram;
        // A thousandth: headers round steps.
        if (record.step_s() - step_s).abs() > 1e-3 * step_s {
            let found = format!("a step of {} s", record.step_s());
            return Err(self
                .fault("vertical", found, format!("that of the horizontal record, {step_s} s"))
                .into());
        }
        Ok(Some(record))
    }

    fn read(&self, key: &str, file: &str, channel: Option<String>) -> Result<Record> {
        let path = self.path.parent().unwrap_or(Path::new("")).join(file);
        if !path.is_file() {
            return Err(self
                .fault(key, format!("no file {}", path.display()), "a file, relative to the suite's folder")
                .into());
        }
        let options = ReadOptions {
            step_s: self.entry.step_s.or(self.file.step_s),
            unit: self.entry.unit.or(self.file.unit),
            channel,
            columns: self.entry.columns.clone().or_else(|| self.file.columns.clone()),
            decimal_comma: self.entry.decimal_comma || self.file.decimal_comma,
        };
        read(&path, &options)
    }

    fn check_peaks(&self, record: &Accelerogram) -> Result<(), InputError> {
        self.check_peak("pga_g", self.entry.pga_g, record.peak_m_s2() / G_M_S2, PGA_TOLERANCE)?;
        let pgv_m_s = Motion::of(record).peak_velocity_m_s();
        self.check_peak("pgv_m_s", self.entry.pgv_m_s, pgv_m_s, PGV_TOLERANCE)
    }

    fn check_peak(&self, key: &str, said: Option<f64>, found: f64, tolerance: f64) -> Result<(), InputError> {
        let Some(said) = said else { return Ok(()) };
        let agrees = (found - said).abs() <= tolerance * said;
        if agrees {
            return Ok(());
        }
        let allowed = format!("what the unscaled file has, {found:.4}, within {} %", tolerance * 100.0);
        Err(self.fault(key, said.to_string(), allowed))
    }

    fn about(&self) -> About {
        let entry = self.entry;
        About {
            date: entry.date.clone(),
            station: entry.station.clone(),
            soil: entry.soil.clone(),
            magnitude: entry.magnitude,
            distance_km: entry.distance_km,
            source: entry.source.clone(),
            note: entry.note.clone(),
        }
    }
}
