//! Ground motion: accelerograms, the files they come in, and the suites that list them.

mod accelerogram;
mod code_spectrum;
mod fft;
mod integrate;
mod intensity;
mod read;
mod spectrum;
mod suite;
mod suite_file;
mod unit;

pub use accelerogram::{Accelerogram, InvalidAccelerogram};
pub use code_spectrum::{COMPATIBLE_DEVIATION, COMPATIBLE_PERIODS_S, Site, Soil, SuiteCheck, Topography};
pub use integrate::Motion;
pub use intensity::IntensityMeasures;
pub use read::{Format, ReadOptions, Record, read, read_bytes};
pub use spectrum::{CODE_DAMPING, response_spectrum_m_s2, spectral_acceleration_m_s2};
pub use suite::{About, Suite, SuiteRecord};
pub use unit::{Unit, UnknownUnit};
