//! What a kind of study says of a run: everything but the record and the assumptions.

use super::run::{Origin, Scaling};
use crate::survey::Configuration;
use crate::survey::Facade;
use mrbd_records::SuiteRecord;

/// A façade and how it is shaken.
pub(super) struct Setting {
    pub configuration: Configuration,
    pub origin: Origin,
    pub facade: Facade,
    /// C_l.
    pub coefficients: [f64; 8],
    pub scaling: Scaling,
}

impl Setting {
    /// The factor on a record of the suite, at first.
    pub fn factor(&self, record: &SuiteRecord) -> f64 {
        match self.scaling {
            Scaling::Factor(factor) => factor,
            Scaling::To(measure, value) => measure.factor_to(&record.intensity, value),
            Scaling::Growing(growth) => growth.measure.factor_to(&record.intensity, growth.range[0]),
        }
    }
}
