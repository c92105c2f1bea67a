//! A hypothesis, fitted, and judged on tests that the fit has not seen.

use crate::diagnose::fit::{Fit, Problem, nats, windowed_error};
use crate::diagnose::hypothesis::Hypothesis;
use crate::diagnose::measured::{TestData, Window};

/// A hypothesis, fitted, and judged on tests that the fit has not seen.
#[derive(Debug, Clone)]
pub struct Tried {
    /// What was supposed.
    pub hypothesis: Hypothesis,
    /// Fit to the tests for it.
    pub fit: Fit,
    /// The other tests, with only the states of their windows fitted; empty if there are none.
    pub held_out: Fit,
}

/// The windows of the tests to fit and of the others.
#[derive(Debug, Clone, Copy)]
pub struct Data<'a> {
    /// To fit.
    pub fit: Problem<'a>,
    /// Held out.
    pub held_out: Problem<'a>,
}

impl<'a> Data<'a> {
    /// Windows to fit and held out, of tests.
    pub fn new(tests: &'a [TestData], windows: &'a [Vec<Window>; 2]) -> Self {
        let problem = |windows: &'a Vec<Window>| Problem { tests, windows };
        Self { fit: problem(&windows[0]), held_out: problem(&windows[1]) }
    }
}

impl Tried {
    /// Windowed errors: fit, held out.
    pub fn errors(&self) -> [Option<f64>; 2] {
        [windowed_error(&self.fit.windows), windowed_error(&self.held_out.windows)]
    }

    /// Windowed error of the tests to fit; infinite where there are none.
    pub fn fit_error(&self) -> f64 {
        self.errors()[0].unwrap_or(f64::INFINITY)
    }

    /// What speaks against it, in natural logarithms of likelihood: windows that were fitted with the prior and half the
    /// logarithm of their number for each added one (Schwarz), and windows that were held out.
    pub fn against(&self, data: &Data) -> [f64; 2] {
        [nats(&self.fit.windows) + self.prior() + self.price(data), nats(&self.held_out.windows)]
    }

    /// The same in all windows, without the price of added numbers.
    pub fn unpriced(&self) -> f64 {
        nats(&self.fit.windows) + self.prior() + nats(&self.held_out.windows)
    }

    /// What its added numbers cost: half the logarithm of the samples fitted for each (Schwarz).
    pub fn price(&self, data: &Data) -> f64 {
        let samples = data.fit.windows.iter().map(|w| w.samples.len()).sum::<usize>();
        let added = self.hypothesis.unknowns.len() - self.hypothesis.nuisances;
        0.5 * added as f64 * (samples.max(1) as f64).ln()
    }

    fn prior(&self) -> f64 {
        0.5 * self.hypothesis.prior_penalty(&self.fit.values)
    }
}
