//! Overturning spectra: which pulses, by amplitude and frequency, overturn a block or a wall.
//!
//! After Zhang and Makris (2001), "Rocking response of free-standing blocks under cycloidal pulses": amplitudes in units of
//! α g, frequencies in units of p = √(3g/4R). Overturning is not a threshold: above the amplitudes that overturn a block
//! without impact or after one, there may be larger ones that it survives.

mod picture;
mod spectrum;
mod store;
mod study;
mod words;

pub use picture::picture;
pub use spectrum::{Boundary, Spectrum, Trial, rocking_frequency_rad_s, spectrum};
pub use store::{FILES, store};
pub use study::{PulseShape, Range, Study};
