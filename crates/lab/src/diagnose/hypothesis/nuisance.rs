//! What was known of the wall before the tests.

use super::unknown::Slot;
use super::{Unknown, WallNumber};
use crate::limits::{PRIOR_REACH, WIDE_PRIOR};
use mrbd_kernel::model::WallParameters;

/// What was known of a number of the wall before the tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nuisance {
    /// A number, with its relative standard deviation.
    Number(&'static WallNumber, f64),
    /// C_l by its index from 0, with its relative standard deviation.
    Coefficient(usize, f64),
}

impl Nuisance {
    /// Whether what was known says so little that the number was not known.
    pub fn is_wide(&self) -> bool {
        let (Nuisance::Number(_, sd) | Nuisance::Coefficient(_, sd)) = self;
        *sd > WIDE_PRIOR
    }

    /// Its dotted key, or C_l.
    fn key(&self) -> String {
        match self {
            Nuisance::Number(number, _) => number.key.to_owned(),
            Nuisance::Coefficient(l, _) => format!("C_{}", l + 1),
        }
    }

    /// Its value in a wall.
    pub fn value(&self, wall: &WallParameters) -> f64 {
        match self {
            Nuisance::Number(number, _) => (number.get)(wall),
            Nuisance::Coefficient(l, _) => wall.restitution.coefficients[*l],
        }
    }

    /// The number to be found.
    pub(super) fn unknown(&self, base: &WallParameters) -> Unknown {
        let (unit, relative, slot) = match *self {
            Nuisance::Number(number, sd) => (number.quantity.unit(), sd, Slot::Number(number)),
            Nuisance::Coefficient(l, sd) => ("", sd, Slot::Coefficient(l)),
        };
        let value = self.value(base);
        let sd = relative * value.abs();
        let reach = PRIOR_REACH * sd;
        // A prior as wide as the value itself does not reach what no wall has.
        let lower = if value > 0.0 { (value - reach).max(0.02 * value) } else { value - reach };
        Unknown {
            key: self.key(),
            unit,
            start: value,
            scale: value.abs(),
            lower,
            upper: value + reach,
            prior_sd: Some(sd),
            slot,
        }
    }
}
