//! A formula at the states of several walls side by side, each in its own branches: the same bits as one after another.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdFrom, f64x4};

use crate::expression::Function;
use crate::number::product_of_equals;
use crate::power::powers;
use crate::program::{Program, STACK, Step, Tape, VARIABLES};
use crate::switch::{Branches, SwitchUse};

type F<S> = f64x4<S>;

/// How many walls go side by side.
pub const LANES: usize = 4;

/// The branches of each lane.
pub type LaneBranches<'b> = [&'b Branches; LANES];

/// Numbers that wait on the stack of most formulas at most.
const SMALL_STACK: usize = 8;

/// A number of every lane.
#[inline(always)]
fn lanes<S: Simd>(simd: S, of: impl FnMut(usize) -> f64) -> F<S> {
    F::simd_from(simd, std::array::from_fn::<f64, LANES, _>(of))
}

impl Program {
    /// As [`Program::value`], of every lane.
    #[inline(always)]
    pub fn values<S: Simd>(&self, state: [F<S>; VARIABLES], branches: LaneBranches) -> F<S> {
        if self.stack <= SMALL_STACK {
            self.tape.run_lanes::<S, SMALL_STACK>(state, branches)
        } else {
            self.tape.run_lanes::<S, STACK>(state, branches)
        }
    }
}

impl Tape {
    #[inline(always)]
    fn run_lanes<S: Simd, const SIZE: usize>(
        &self,
        state: [F<S>; VARIABLES],
        branches: LaneBranches,
    ) -> F<S> {
        let simd = state[0].simd;
        let mut stack = [F::splat(simd, 0.0); SIZE];
        let mut top = 0;
        for step in &self.0 {
            match step {
                Step::Constant(value) => stack[top] = F::splat(simd, *value),
                Step::Variable(variable) => stack[top] = state[*variable],
                step if step.takes_two() => {
                    top -= 2;
                    stack[top] = step.of_two_lanes(stack[top], stack[top + 1], branches);
                }
                step => {
                    top -= 1;
                    stack[top] = step.of_one_lanes(stack[top], branches);
                }
            }
            top += 1;
        }
        stack[0]
    }
}

impl Step {
    #[inline(always)]
    fn of_one_lanes<S: Simd>(&self, a: F<S>, branches: LaneBranches) -> F<S> {
        match self {
            Step::Negative => -a,
            Step::WholePower(exponent) => whole_powers(a, *exponent),
            Step::Abs(switch) => match frozen_signs(a.simd, *switch, branches) {
                // Times 1 or -1 is what a branch does, to the bit.
                Some(signs) => a * signs,
                None => self.of_one_by_one(a, branches),
            },
            Step::Sign(switch) => match frozen_signs(a.simd, *switch, branches) {
                Some(signs) => signs,
                None => self.of_one_by_one(a, branches),
            },
            Step::Smooth(Function::Sqrt) => root_arguments(a, branches).sqrt(),
            _ => self.of_one_by_one(a, branches),
        }
    }

    #[inline(always)]
    fn of_two_lanes<S: Simd>(&self, a: F<S>, b: F<S>, branches: LaneBranches) -> F<S> {
        match self {
            Step::Add => a + b,
            Step::Subtract => a - b,
            Step::Multiply => a * b,
            Step::Divide => quotient(a, b),
            Step::Power => finite(powers(root_arguments(a, branches), b)),
            _ => self.of_two_by_one(a, b, branches),
        }
    }

    /// One lane after another.
    #[inline(never)]
    fn of_one_by_one<S: Simd>(&self, a: F<S>, branches: LaneBranches) -> F<S> {
        let a_of = <[f64; LANES]>::from(a);
        lanes(a.simd, |i| self.of_one(a_of[i], branches[i]))
    }

    /// The same of two numbers.
    #[inline(never)]
    fn of_two_by_one<S: Simd>(&self, a: F<S>, b: F<S>, branches: LaneBranches) -> F<S> {
        let (a_of, b_of) = (<[f64; LANES]>::from(a), <[f64; LANES]>::from(b));
        lanes(a.simd, |i| self.of_two(a_of[i], b_of[i], branches[i]))
    }
}

/// The signs of a switch, where no lane has it free or at zero.
#[inline(always)]
fn frozen_signs<S: Simd>(simd: S, switch: Option<SwitchUse>, branches: LaneBranches) -> Option<F<S>> {
    let of = branches.map(|branches| branches.seen_by(switch).sign());
    of.iter().all(|sign| *sign != 0.0).then(|| F::simd_from(simd, of))
}

/// What roots are taken of: zero in the place of negative numbers in lanes whose branches are frozen.
#[inline(always)]
fn root_arguments<S: Simd>(a: F<S>, branches: LaneBranches) -> F<S> {
    let frozen = lanes(a.simd, |i| f64::from(u8::from(branches[i].is_frozen())));
    (frozen.simd_eq(1.0) & a.simd_lt(0.0)).select(F::splat(a.simd, 0.0), a)
}

/// As the quotient of two numbers.
#[inline(always)]
fn quotient<S: Simd>(a: F<S>, b: F<S>) -> F<S> {
    b.simd_eq(0.0).select(F::splat(a.simd, f64::NAN), a / b)
}

/// As the power of two numbers: none that is too large for one.
#[inline(always)]
fn finite<S: Simd>(a: F<S>) -> F<S> {
    a.abs().simd_le(f64::MAX).select(a, F::splat(a.simd, f64::NAN))
}

/// As the whole power of a number.
#[inline(always)]
fn whole_powers<S: Simd>(a: F<S>, exponent: i32) -> F<S> {
    let one = F::splat(a.simd, 1.0);
    let power = product_of_equals(a, exponent.unsigned_abs(), |a, b| a * b).unwrap_or(one);
    if exponent < 0 { quotient(one, power) } else { power }
}

#[cfg(test)]
mod tests {
    use fearless_simd::dispatch;

    use super::*;
    use crate::power::tests::levels;
    use crate::{Formula, Parameter, Place};

    /// Every step of a tape, at states of either side of every switch and on them, in branches that are free, those of
    /// the state and those of the state before.
    #[test]
    fn analytic_lanes_have_the_bits_of_one_wall_after_another() {
        let parameters = [
            Parameter::new("k", 2.5, "N/m"),
            Parameter::new("c", 1.7, "N*(s/m)**1.3"),
            Parameter::new("d", 0.3, "m"),
            Parameter::new("s", 0.8, "m/s"),
            Parameter::new("f", 40.0, "N"),
        ];
        let texts = [
            "-k*x - c*sign(v)*abs(v)**1.3",
            "-f*tanh(x/d) - f*atan(v/s)*exp(-abs(x)/d)",
            "-k*max(x - d, 0) + k*min(x + d, 0)*sqrt(abs(x)/d)",
            "-f*(x/d)**3 + f*(v/s)**-2 - f/(1 + (x/d)**2)",
            "-f*(x > d)*abs(x/d)**0.5*sign(v) - f*(v >= 0)*x/v*s/d",
            "-f*(((x/d + v/s)*(x/d - v/s) + 1)**2 + (((x/d)**2 + (v/s)**2 + 1)*(abs(x/d) + abs(v/s)))**1.1)",
        ];
        // More numbers wait than on the small stack.
        let nested = (0..5).fold("x/d".to_owned(), |inner, _| format!("x/d + v/s*({inner})"));
        let nested = format!("-f*({nested})");
        let texts = texts.into_iter().chain([&*nested]);
        let numbers = [-0.7, -0.3, -0.0, 0.0, 1e-9, 0.3, 0.31, 0.9];
        for text in texts {
            let is_used =
                |p: &&Parameter| text.split(|c: char| !c.is_alphanumeric()).any(|word| word == p.name);
            let used = parameters.iter().filter(is_used).cloned().collect::<Vec<_>>();
            let law = Formula::parse(text, Place::Top, &used).expect(text);
            let program = law.program();
            let states =
                numbers.iter().flat_map(|x| numbers.map(|v| [*x, v, 0.0, 0.0, 0.0])).collect::<Vec<_>>();
            let at = |k: usize| states[k % states.len()];
            let branches = (0..states.len()).flat_map(|k| {
                let frozen = |k: usize| program.branches_at(at(k), [0.1, -1.0, 0.0, 0.0, 0.0]);
                [(k, Branches::FREE), (k, frozen(k)), (k, frozen(k + 9))]
            });
            let all = branches.collect::<Vec<_>>();
            for four in all.windows(LANES) {
                let alone: [f64; LANES] = std::array::from_fn(|i| program.value(at(four[i].0), &four[i].1));
                for level in levels() {
                    let found: [f64; LANES] = dispatch!(level, simd => {
                        let state = std::array::from_fn(|j| lanes(simd, |i| at(four[i].0)[j]));
                        program.values(state, std::array::from_fn(|i| &four[i].1)).into()
                    });
                    for (found, alone) in found.iter().zip(alone) {
                        let same = found.to_bits() == alone.to_bits() || found.is_nan() && alone.is_nan();
                        assert!(same, "{text} at {four:?} by {level:?}: {found} and {alone}");
                    }
                }
            }
        }
    }
}
