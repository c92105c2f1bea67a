//! A variable of a search: C_l or any other number of the wall file, its bounds, and what was known before.

use super::search::Bounds;

/// Where a parameter stands in the wall.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// C_l, by its index from 0.
    Coefficient(usize),
    /// A number of the wall file, by the steps to it.
    Key(Vec<String>),
}

/// One variable of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// `C_1` … or a dotted key.
    pub name: String,
    /// Where it stands.
    pub target: Target,
    /// β_0 and β_f.
    pub bounds: Bounds,
    /// Value in the wall file; 1 for C_l, which is what an impact without calibration has.
    pub nominal: f64,
    /// Standard deviation known beforehand, in the parameter's unit.
    pub prior_sd: Option<f64>,
}

impl Parameter {
    /// The index of its coefficient, if it is one.
    pub fn coefficient(&self) -> Option<usize> {
        match self.target {
            Target::Coefficient(l) => Some(l),
            Target::Key(_) => None,
        }
    }
}
