//! Coordinates of a motion with carried states beside them: values that a step moves as one.

use std::ops::Mul;

use wide::f64x2;

use super::nystrom::Values;

/// The two coordinates of a motion, and four further ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// The coordinates.
    pub motion: f64x2,
    /// What goes beside them.
    pub states: [f64x2; 2],
}

impl Beside {
    /// Of numbers.
    pub fn new(motion: [f64; 2], [a, b, c, d]: [f64; 4]) -> Self {
        Self { motion: f64x2::new(motion), states: [f64x2::new([a, b]), f64x2::new([c, d])] }
    }

    /// What goes beside the coordinates.
    pub fn beside(&self) -> [f64; 4] {
        let [[a, b], [c, d]] = self.states.map(f64x2::to_array);
        [a, b, c, d]
    }

    fn each(self, of: impl Fn(f64x2) -> f64x2) -> Self {
        Self { motion: of(self.motion), states: self.states.map(of) }
    }

    fn each_with(self, other: Self, of: impl Fn(f64x2, f64x2) -> f64x2) -> Self {
        let [a, b] = self.states;
        let [c, d] = other.states;
        Self { motion: of(self.motion, other.motion), states: [of(a, c), of(b, d)] }
    }
}

impl Mul<f64> for Beside {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self.each(|values| values * factor)
    }
}

impl Values for Beside {
    type Length = f64;

    fn over(self, length: f64) -> Self {
        self.each(|values| values.over(length))
    }

    fn over_plus(self, length: f64, other: Self) -> Self {
        self.each_with(other, |values, other| values.over_plus(length, other))
    }

    fn times_plus(self, factor: f64, other: Self) -> Self {
        self.each_with(other, |values, other| values.times_plus(factor, other))
    }
}
