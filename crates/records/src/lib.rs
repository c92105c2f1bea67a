//! Ground motion: accelerograms, the files they come in, the suites that list them, and how strong they are.
//!
//! # The flow
//!
//! A record file of any of the [`FORMATS`] becomes a [`Record`]: samples in m/s² at a constant step, linear between
//! them ([`Accelerogram`]). Its content decides the format, and what it states must agree with itself. A [`Suite`] lists
//! records with factors, events and peaks that are checked against the files.
//!
//! | from | by | to |
//! | --- | --- | --- |
//! | a record file | [`read()`] | a [`Record`], in m/s² |
//! | a suite file | [`Suite::load`] | scaled records with their measures |
//! | an accelerogram | [`Motion::of`], [`IntensityMeasures::of`] | velocity and displacement; PGA, PGV, Arias, durations |
//! | | [`spectral_acceleration_m_s2`] | S_a(T, ξ) = ω² max abs u, the elastic pseudo-acceleration |
//! | an intensity | [`ScaledMeasure`] | the factor that gives a record this intensity |
//! | a suite and a [`Site`] | [`SuiteCheck::of`], [`select()`] | the mean spectrum against the code (NTC 2018); suites that fit |
//! | a record and a [`Building`] | [`floor_motion`], [`FloorSpectrum`] | the record of a floor; floor spectra of the code (C7.2.3) |
//! | a published table | [`generate()`], [`read_imports`] | records that stand in for its rows, or the user's own |
//! | a formula | [`Pulse`] | one sine, Ricker, Mavroeidis and Papageorgiou, ... |
//!
//! # From a text to its measures
//!
//! A full sine of 1 s and 2 m/s², in a file of two columns:
//!
//! ```
//! use std::f64::consts::{PI, TAU};
//! use std::path::Path;
//!
//! use mrbd_records::{CODE_DAMPING, IntensityMeasures, ReadOptions, read_bytes, spectral_acceleration_m_s2};
//!
//! let mut text = String::from("time_s,acceleration_m_s2\n");
//! for i in 0..=200 {
//!     let t = 0.005 * f64::from(i);
//!     text += &format!("{t:.3},{}\n", 2.0 * (TAU * t).sin());
//! }
//! let record = read_bytes(Path::new("sine.csv"), text.as_bytes(), &ReadOptions::default())?;
//! assert_eq!((record.format.name, record.accelerogram.step_s()), ("two columns", 0.005));
//!
//! let measures = IntensityMeasures::of(&record.accelerogram);
//! assert!((measures.pga_m_s2 - 2.0).abs() < 1e-9);
//! // ∫a dt over half a period is aT/π; lines between 200 samples lose (2π/200)²/12 = 8e-5 of it.
//! assert!((measures.pgv_m_s / (2.0 / PI) - 1.0).abs() < 1e-4);
//!
//! // A stiff oscillator has the ground's own peak, one with the period of the sine 2.7 times as much.
//! let sa_m_s2 = |period_s| spectral_acceleration_m_s2(&record.accelerogram, period_s, CODE_DAMPING);
//! assert!((sa_m_s2(0.02) / 2.0 - 1.0).abs() < 0.01);
//! assert!((sa_m_s2(1.0) / 2.0 - 2.7).abs() < 0.01);
//! # Ok::<(), mrbd_files::InputError>(())
//! ```

mod building;
mod code_spectrum;
mod fft;
mod floor_motion;
mod floor_spectrum;
mod formats;
mod generate;
mod intensity;
mod pulse;
mod record_table;
mod scaling;
mod select;
mod spectrum;
mod suite;
mod suite_file;
mod unit;

pub use building::{Building, Mode};
pub use code_spectrum::{COMPATIBLE_DEVIATION, COMPATIBLE_PERIODS_S, Site, Soil, SuiteCheck, Topography};
pub use floor_motion::floor_motion;
pub use floor_spectrum::FloorSpectrum;
pub use formats::{
    ColumnChoice, FORMATS, Format, NoColumns, ReadOptions, Record, formats_in_words, read, read_bytes,
    write_two_columns,
};
pub use generate::{STEP_S as GENERATED_STEP_S, generate, write_suite};
pub use intensity::{IntensityMeasures, Motion};
pub use mrbd_kernel::accelerogram::{Accelerogram, InvalidAccelerogram};
pub use pulse::{ImpossiblePulse, Pulse};
pub use record_table::{Import, RecordTable, TableRow, read_imports, write_imports};
pub use scaling::ScaledMeasure;
pub use select::{Criteria, Selection, select};
pub use spectrum::{CODE_DAMPING, response_spectrum_m_s2, spectral_acceleration_m_s2};
pub use suite::{About, Suite, SuiteRecord};
pub use suite_file::SuiteSource;
pub use unit::{Unit, UnknownUnit};
