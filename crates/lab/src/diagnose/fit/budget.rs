//! How much a fit may work.
//!
//! It is counted in evaluations of the equations of motion, never in seconds: what a fit finds does not depend on the machine,
//! nor on how many threads it has.

use std::sync::atomic::{AtomicU64, Ordering};

use super::Problem;

/// A fit looks at all windows to one side of every number under its first loss, and to both under its last: three times a number.
const LOOKS_A_NUMBER: u64 = 3;
/// And some times at states that follow, under each of three losses.
const LOOKS_AT_STATES: u64 = 9;

/// What one fit may work, and what it has worked.
#[derive(Debug)]
pub struct Budget {
    most: u64,
    spent: AtomicU64,
}

impl Budget {
    /// So many evaluations of the equations of motion for each second of the windows of a problem.
    pub fn of(problem: &Problem, evaluations_per_s: f64) -> Self {
        let length_s = problem.windows.iter().map(|window| {
            let time_s = &problem.tests[window.test].time_s[window.samples.clone()];
            time_s.last().zip(time_s.first()).map_or(0.0, |(last, first)| last - first)
        });
        Self { most: (evaluations_per_s * length_s.sum::<f64>()) as u64, spent: AtomicU64::new(0) }
    }

    /// Takes evaluations off.
    pub fn spend(&self, evaluations: u64) {
        self.spent.fetch_add(evaluations, Ordering::Relaxed);
    }

    /// Ends a fit of so many numbers where it would work more than it may if all looks at the windows took what has been spent on a first
    /// one. A fit that would come to easier values is not waited for.
    pub fn look_ahead(&self, numbers: usize) {
        let looks = LOOKS_A_NUMBER * numbers as u64 + LOOKS_AT_STATES;
        if self.spent.load(Ordering::Relaxed).saturating_mul(looks) > self.most {
            self.spend(self.most);
        }
    }

    /// Whether nothing is left. Asked between steps of a fit alone: within them windows run side by side, in any order.
    pub fn is_spent(&self) -> bool {
        self.spent.load(Ordering::Relaxed) > self.most
    }
}

#[cfg(test)]
mod tests {
    use super::super::linear::tests::swaying;
    use super::*;

    #[test]
    fn analytic_a_fit_ends_without_an_answer_where_its_work_is_spent_and_else_is_what_it_was() {
        let (tests, h) = swaying();
        let windows = crate::experiment::windows(&tests);
        let free = Problem { tests: &tests, windows: &windows, budget: None };
        let fitted = |budget: Option<&Budget>| {
            let problem = Problem { budget, ..free };
            let start = problem.states(&h, &h.start(), &problem.measured_states(), 0, false).expect("a wall");
            problem.fit_finely(&h, start).map(|fit| fit.values)
        };
        let values = fitted(None);
        assert_ne!(values.as_ref(), Some(&h.start()));
        let [none, enough] = [0.0, 1e12].map(|evaluations_per_s| Budget::of(&free, evaluations_per_s));
        assert_eq!(fitted(Some(&none)), None);
        assert_eq!(fitted(Some(&enough)), values);
        assert!(none.is_spent() && !enough.is_spent());
    }

    #[test]
    fn analytic_a_fit_whose_first_look_takes_too_much_of_its_work_is_not_begun() {
        let (tests, h) = swaying();
        let windows = crate::experiment::windows(&tests);
        let look_of = |budget: &Budget| {
            let problem = Problem { tests: &tests, windows: &windows, budget: Some(budget) };
            problem.states_to_begin(&h, &h.start(), &problem.measured_states(), 2).is_some()
        };
        let free = Problem { tests: &tests, windows: &windows, budget: None };
        let counted = Budget::of(&free, 1e12);
        assert!(look_of(&counted));
        // What a look and two steps of the states took: a fit takes several times that.
        let of_two_steps = Budget { most: counted.spent.load(Ordering::Relaxed), spent: AtomicU64::new(0) };
        assert!(!look_of(&of_two_steps) && of_two_steps.is_spent());
    }
}
