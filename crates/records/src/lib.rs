//! Ground motion: accelerograms, the files they come in, and the suites that list them.

mod code_spectrum;
mod fft;
mod formats;
mod generate;
mod integrate;
mod intensity;
mod pulse;
mod record_table;
mod scaling;
mod select;
mod spectrum;
mod suite;
mod suite_file;
mod suite_source;
mod unit;

pub use code_spectrum::{COMPATIBLE_DEVIATION, COMPATIBLE_PERIODS_S, Site, Soil, SuiteCheck, Topography};
pub use formats::{
    FORMATS, Format, ReadOptions, Record, formats_in_words, read, read_bytes, write_two_columns,
};
pub use generate::{STEP_S as GENERATED_STEP_S, generate, write_suite};
pub use integrate::Motion;
pub use intensity::IntensityMeasures;
pub use mrbd_kernel::accelerogram::{Accelerogram, InvalidAccelerogram};
pub use pulse::{ImpossiblePulse, Pulse};
pub use record_table::{RecordTable, TableRow};
pub use scaling::ScaledMeasure;
pub use select::{Criteria, Selection, select};
pub use spectrum::{CODE_DAMPING, response_spectrum_m_s2, spectral_acceleration_m_s2};
pub use suite::{About, Suite, SuiteRecord};
pub use suite_source::{Import, SuiteSource, read_imports, write_imports};
pub use unit::{Unit, UnknownUnit};
