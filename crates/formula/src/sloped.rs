//! Intervals of a value and of its slope along one variable: for what is proportional to that variable, which an interval alone
//! cannot tell the sign of.

use crate::interval::Interval;
use crate::number::Number;

/// Values over a range, and slopes there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sloped {
    pub value: Interval,
    pub slope: Interval,
}

const ZERO: Interval = Interval { low: 0.0, high: 0.0 };
const UNKNOWN: Interval = Interval { low: f64::NAN, high: f64::NAN };

fn constant(value: f64) -> Interval {
    Interval::constant(value)
}

impl Sloped {
    /// What stands still.
    pub fn still(value: Interval) -> Self {
        Self { value, slope: ZERO }
    }

    fn through(self, value: Interval, slope: impl FnOnce() -> Interval) -> Self {
        Self { value, slope: if self.slope == ZERO { ZERO } else { slope().mul(self.slope) } }
    }
}

impl Number for Sloped {
    fn constant(value: f64) -> Self {
        Self::still(constant(value))
    }
    fn add(self, other: Self) -> Self {
        Self { value: self.value.add(other.value), slope: self.slope.add(other.slope) }
    }
    fn mul(self, other: Self) -> Self {
        let share = |value: Interval, slope: Interval| if slope == ZERO { ZERO } else { value.mul(slope) };
        let slope = share(self.value, other.slope).add(share(other.value, self.slope));
        Self { value: self.value.mul(other.value), slope }
    }
    fn div(self, other: Self) -> Self {
        let inverse = constant(1.0).div(other.value);
        self.mul(other.through(inverse, || inverse.mul(inverse).neg()))
    }
    fn neg(self) -> Self {
        Self { value: self.value.neg(), slope: self.slope.neg() }
    }
    fn powi(self, exponent: i32) -> Self {
        let slope = || constant(f64::from(exponent)).mul(self.value.powi(exponent - 1));
        self.through(self.value.powi(exponent), slope)
    }
    fn pow(self, exponent: Self) -> Self {
        let value = self.value.pow(exponent.value);
        if exponent.slope != ZERO {
            return Self { value, slope: UNKNOWN };
        }
        self.through(value, || exponent.value.mul(self.value.pow(exponent.value.sub(constant(1.0)))))
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.through(root, || constant(0.5).div(root))
    }
    fn exp(self) -> Self {
        let exp = self.value.exp();
        self.through(exp, || exp)
    }
    fn tanh(self) -> Self {
        let tanh = self.value.tanh();
        self.through(tanh, || constant(1.0).sub(tanh.mul(tanh)))
    }
    fn atan(self) -> Self {
        let square = self.value.powi(2);
        self.through(self.value.atan(), || constant(1.0).div(constant(1.0).add(square)))
    }
    fn abs(self) -> Self {
        self.through(self.value.abs(), || self.value.sign())
    }
    fn sign(self) -> Self {
        // A jump inside of the range has no slope.
        let value = self.value.sign();
        Self { value, slope: if value.width() == 0.0 || self.slope == ZERO { ZERO } else { UNKNOWN } }
    }
    fn max(self, other: Self) -> Self {
        let slope = Interval::new(
            Number::min(self.slope.low, other.slope.low),
            Number::max(self.slope.high, other.slope.high),
        );
        Self { value: self.value.max(other.value), slope }
    }
    fn not_negative(self) -> Self {
        self.max(Self::constant(0.0))
    }
    fn above(self, other: Self, or_equal: bool) -> Self {
        let value = self.value.above(other.value, or_equal);
        let still = self.slope == ZERO && other.slope == ZERO;
        Self { value, slope: if value.width() == 0.0 || still { ZERO } else { UNKNOWN } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_slope_lies_within_that_of_its_interval() {
        let of = |x: Sloped| {
            let two = Sloped::constant(2.0);
            x.abs()
                .pow(Sloped::constant(1.5))
                .mul(x.tanh())
                .add(x.powi(3).div(two.add(x.exp())))
                .add(x.atan())
        };
        for k in -20..20 {
            let (low, high) = (f64::from(k) * 0.1, f64::from(k) * 0.1 + 0.1);
            let over = of(Sloped { value: Interval::new(low, high), slope: constant(1.0) });
            let value = |x: f64| of(Sloped::constant(x)).value.low;
            for i in 1..10 {
                let (x, h) = (low + 0.01 * f64::from(i), 1e-6);
                let slope = (value(x + h) - value(x - h)) / (2.0 * h);
                // Roundings over a difference of a millionth.
                assert!(
                    over.slope.low - 1e-8 <= slope && slope <= over.slope.high + 1e-8,
                    "{x}: {slope} {over:?}"
                );
                assert!(over.value.low <= value(x) && value(x) <= over.value.high, "{x}");
            }
        }
    }
}
