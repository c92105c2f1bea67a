//! A formula at the states of several walls side by side, each in its own branches: the same bits as one after another.

use fearless_simd::{Select, Simd, SimdFloat, SimdMask, f64x4, f64x8};

use crate::expression::Function;
use crate::number::product_of_equals;
use crate::power::{Real, powers};
use crate::program::{Program, STACK, Step, Tape, VARIABLES};
use crate::switch::{Branches, SwitchUse};

/// Numbers of walls side by side in a vector register: of four, or of eight.
pub trait Lanes: Real + SimdFloat<<Self as Lanes>::Token, Element = f64> {
    /// Vector instructions that go with it.
    type Token: Simd;

    /// A number of every lane by its place.
    #[inline(always)]
    #[must_use]
    fn of_each(simd: Self::Token, mut of: impl FnMut(usize) -> f64) -> Self {
        let mut numbers = [0.0; MOST_LANES];
        numbers[..Self::LEN].iter_mut().enumerate().for_each(|(i, number)| *number = of(i));
        Self::from_slice(simd, &numbers[..Self::LEN])
    }
}

impl<S: Simd> Lanes for f64x4<S> {
    type Token = S;
}
impl<S: Simd> Lanes for f64x8<S> {
    type Token = S;
}

/// Walls that go side by side at most.
pub const MOST_LANES: usize = 8;

/// The branches of each lane; those beyond the width of the numbers are not looked at.
pub type LaneBranches<'b> = [&'b Branches; MOST_LANES];

/// Numbers that wait on the stack of most formulas at most.
const SMALL_STACK: usize = 8;

impl Program {
    /// As [`Program::value`], of every lane.
    #[inline(always)]
    pub fn values<F: Lanes>(&self, state: [F; VARIABLES], branches: LaneBranches) -> F {
        if self.stack <= SMALL_STACK {
            self.tape.run_lanes::<F, SMALL_STACK>(state, branches)
        } else {
            self.tape.run_lanes::<F, STACK>(state, branches)
        }
    }
}

impl Tape {
    #[inline(always)]
    fn run_lanes<F: Lanes, const SIZE: usize>(&self, state: [F; VARIABLES], branches: LaneBranches) -> F {
        let simd = state[0].token();
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
    fn of_one_lanes<F: Lanes>(&self, a: F, branches: LaneBranches) -> F {
        match self {
            Step::Negative => -a,
            Step::WholePower(exponent) => whole_powers(a, *exponent),
            Step::Abs(switch) => match frozen_signs::<F>(a.token(), *switch, branches) {
                // Times 1 or -1 is what a branch does, to the bit.
                Some(signs) => a * signs,
                None => self.of_one_by_one(a, branches),
            },
            Step::Sign(switch) => match frozen_signs::<F>(a.token(), *switch, branches) {
                Some(signs) => signs,
                None => self.of_one_by_one(a, branches),
            },
            Step::Smooth(Function::Sqrt) => root_arguments(a, branches).sqrt(),
            _ => self.of_one_by_one(a, branches),
        }
    }

    #[inline(always)]
    fn of_two_lanes<F: Lanes>(&self, a: F, b: F, branches: LaneBranches) -> F {
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
    fn of_one_by_one<F: Lanes>(&self, a: F, branches: LaneBranches) -> F {
        let a_of = a.as_slice();
        F::of_each(a.token(), |i| self.of_one(a_of[i], branches[i]))
    }

    /// The same of two numbers.
    #[inline(never)]
    fn of_two_by_one<F: Lanes>(&self, a: F, b: F, branches: LaneBranches) -> F {
        let (a_of, b_of) = (a.as_slice(), b.as_slice());
        F::of_each(a.token(), |i| self.of_two(a_of[i], b_of[i], branches[i]))
    }
}

/// The signs of a switch, where no lane has it free or at zero.
#[inline(always)]
fn frozen_signs<F: Lanes>(simd: F::Token, switch: Option<SwitchUse>, branches: LaneBranches) -> Option<F> {
    let of = F::of_each(simd, |i| branches[i].seen_by(switch).sign());
    of.simd_eq(0.0).all_false().then_some(of)
}

/// What roots are taken of: zero in the place of negative numbers in lanes whose branches are frozen.
#[inline(always)]
fn root_arguments<F: Lanes>(a: F, branches: LaneBranches) -> F {
    let frozen = F::of_each(a.token(), |i| f64::from(u8::from(branches[i].is_frozen())));
    (frozen.simd_eq(1.0) & a.simd_lt(0.0)).select(F::splat(a.token(), 0.0), a)
}

/// As the quotient of two numbers.
#[inline(always)]
fn quotient<F: Lanes>(a: F, b: F) -> F {
    b.simd_eq(0.0).select(F::splat(a.token(), f64::NAN), a / b)
}

/// As the power of two numbers: none that is too large for one.
#[inline(always)]
fn finite<F: Lanes>(a: F) -> F {
    a.abs().simd_le(f64::MAX).select(a, F::splat(a.token(), f64::NAN))
}

/// As the whole power of a number.
#[inline(always)]
fn whole_powers<F: Lanes>(a: F, exponent: i32) -> F {
    let one = F::splat(a.token(), 1.0);
    let power = product_of_equals(a, exponent.unsigned_abs(), |a, b| a * b).unwrap_or(one);
    if exponent < 0 { quotient(one, power) } else { power }
}

#[cfg(test)]
mod tests {
    use fearless_simd::dispatch;

    use super::*;
    use crate::power::tests::levels;
    use crate::{Formula, Parameter, Place, State};

    fn values<F: Lanes>(
        simd: F::Token,
        program: &Program,
        walls: &[(usize, Branches)],
        at: &impl Fn(usize) -> State,
    ) -> Vec<f64> {
        let state = std::array::from_fn(|j| F::of_each(simd, |i| at(walls[i].0)[j]));
        program.values(state, std::array::from_fn(|i| &walls[i].1)).as_slice().to_vec()
    }

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
            for walls in all.windows(MOST_LANES) {
                let alone: [f64; MOST_LANES] =
                    std::array::from_fn(|i| program.value(at(walls[i].0), &walls[i].1));
                for level in levels() {
                    let four = dispatch!(level, simd => values::<f64x4<_>>(simd, program, walls, &at));
                    let eight = dispatch!(level, simd => values::<f64x8<_>>(simd, program, walls, &at));
                    assert_eq!((four.len(), eight.len()), (4, MOST_LANES));
                    for (found, alone) in four.iter().zip(alone).chain(eight.iter().zip(alone)) {
                        let same = found.to_bits() == alone.to_bits() || found.is_nan() && alone.is_nan();
                        assert!(same, "{text} at {walls:?} by {level:?}: {found} and {alone}");
                    }
                }
            }
        }
    }
}
