//! Few of the windows to fit, spread over all of them: enough to tell what is worth a fit to all.

use super::{Data, FittedHypothesis, excess, relieved, widened};
use crate::diagnose::fit::{Fit, Problem, WindowFit};
use crate::experiment::{TestData, Window};
use crate::limits::COARSE_WINDOWS;

/// Squared error, in that of noise, up to which a fit that begins feels a window well: half its bound.
const FELT: f64 = 10.0;

/// Few windows of tests whose noise is so many times as large.
pub struct Few {
    tests: Vec<TestData>,
    windows: Vec<Window>,
    asked: Vec<usize>,
    factor: f64,
}

impl Few {
    /// At most `most` windows of a problem, under a noise that is `factor` times as large.
    pub fn new(problem: Problem, most: usize, factor: f64) -> Self {
        Self::these(problem, spread_over(problem.windows.len(), most), factor)
    }

    /// At most `most` windows of a problem, half of them those that a fit follows worst, the others spread over all.
    ///
    /// What is missing beside an effect may show in few windows, as a joint that seldom opens.
    pub fn followed_worst(problem: Problem, most: usize, fit: &Fit) -> Self {
        let left = fit.windows.iter().map(WindowFit::reduced).collect::<Vec<_>>();
        Self::these(problem, worst_and_spread(&left, most / 2, most), 1.0)
    }

    /// The same under a noise so many times as large that a fit which begins feels every one of them.
    pub fn felt(problem: Problem, most: usize, fit: &Fit) -> Self {
        let few = Self::followed_worst(problem, most, fit);
        let worst = few.left(fit).iter().map(WindowFit::reduced).fold(0.0, f64::max);
        Self::these(problem, few.asked, (worst / FELT).sqrt().max(1.0))
    }

    /// The windows that coarse fits are made to, a quarter of them those that a fit follows worst; `None` where that would be nearly all.
    pub fn of_coarse(problem: Problem, fit: &Fit) -> Option<Self> {
        let left = fit.windows.iter().map(WindowFit::reduced).collect::<Vec<_>>();
        let asked = worst_and_spread(&left, COARSE_WINDOWS / 4, COARSE_WINDOWS);
        (left.len() > COARSE_WINDOWS * 3 / 2).then(|| Self::these(problem, asked, 1.0))
    }

    fn these(problem: Problem, asked: Vec<usize>, factor: f64) -> Self {
        let windows = asked.iter().map(|k| problem.windows[*k].clone()).collect();
        Self { tests: widened(problem.tests, factor), windows, asked, factor }
    }

    /// These windows.
    pub fn problem(&self) -> Problem<'_> {
        Problem { tests: &self.tests, windows: &self.windows, budget: None }
    }

    /// No windows of these tests.
    pub fn nothing(&self) -> Problem<'_> {
        Problem { tests: &self.tests, windows: &[], budget: None }
    }

    /// These windows to fit, and none held out.
    pub fn data(&self) -> Data<'_> {
        Data { fit: self.problem(), held_out: self.nothing() }
    }

    /// What a hypothesis leaves in these windows.
    pub fn left(&self, fit: &Fit) -> Vec<WindowFit> {
        self.asked.iter().map(|k| fit.windows[*k].relieved(self.factor)).collect()
    }

    /// Squared error of a fit to these windows above that of the tests' own noise.
    pub fn excess(&self, fit: &Fit) -> f64 {
        excess(&relieved(&fit.windows, 1.0 / self.factor))
    }

    /// Squared noise of these windows, in that of the tests.
    pub fn noise_2(&self) -> f64 {
        self.factor * self.factor
    }

    /// A hypothesis as it is in these windows, none held out.
    pub fn of(&self, tried: &FittedHypothesis) -> FittedHypothesis {
        let fit = Fit { windows: self.left(&tried.fit), ..tried.fit.clone() };
        let held_out = Fit { windows: Vec::new(), ..tried.held_out.clone() };
        FittedHypothesis { hypothesis: tried.hypothesis.clone(), fit, held_out }
    }
}

/// At most `most` of `count` places, spread evenly.
fn spread_over(count: usize, most: usize) -> Vec<usize> {
    let chosen = count.min(most);
    (0..chosen).map(|i| i * count / chosen).collect()
}

/// At most `most` of the places of these errors: so many of them where they are largest, the others spread evenly over the rest.
fn worst_and_spread(errors: &[f64], worst: usize, most: usize) -> Vec<usize> {
    let mut places = (0..errors.len()).collect::<Vec<_>>();
    places.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]));
    let mut rest = places.split_off(worst.min(places.len()));
    rest.sort_unstable();
    let spread = spread_over(rest.len(), most - places.len()).into_iter().map(|k| rest[k]);
    places.extend(spread);
    places.sort_unstable();
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{Twin, wall_with};

    #[test]
    fn analytic_few_windows_are_spread_over_all() {
        assert_eq!(spread_over(9, 3), [0, 3, 6]);
        assert_eq!(spread_over(2, 3), [0, 1]);
        assert!(spread_over(0, 3).is_empty());
    }

    #[test]
    fn analytic_windows_that_a_fit_misses_by_far_are_felt_under_more_noise() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let trials = twin.trials();
        let mut fit = trials.wall_fits(None).expect("windows").recalibrated.fit;
        assert_eq!(Few::felt(trials.data.fit, 4, &fit).noise_2(), 1.0, "none is missed");
        let freedom = fit.windows[1].freedom;
        fit.windows[1].squares = 40.0 * FELT * freedom;
        let few = Few::felt(trials.data.fit, 4, &fit);
        // But for roundings.
        assert!((few.noise_2() - 40.0).abs() < 1e-9, "{}", few.noise_2());
        assert!(few.left(&fit).iter().all(|window| window.reduced() < FELT * (1.0 + 1e-9)));
    }

    #[test]
    fn analytic_half_of_few_windows_are_those_followed_worst() {
        let errors = [1.0, 9.0, 1.0, 1.0, 1.0, 8.0, 1.0, 7.0];
        // 1 and 5 are the worst; of 0, 2, 3, 4, 6 and 7 the first and the fourth.
        assert_eq!(worst_and_spread(&errors, 2, 4), [0, 1, 4, 5]);
        assert_eq!(worst_and_spread(&errors[..2], 2, 4), [0, 1]);
        assert!(worst_and_spread(&[], 2, 4).is_empty());
    }
}
