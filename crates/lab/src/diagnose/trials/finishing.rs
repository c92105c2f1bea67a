//! Which coarse fits are worth fitting to the end.

use crate::limits::{FOLLOWING, LEAST_FINISHED, MOST_FINISHED, NEAR_BEST};

/// A hypothesis fitted coarsely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coarse {
    /// What speaks against it, in natural logarithms of likelihood.
    pub against: f64,
    /// Its windowed error, in standard deviations of the noise.
    pub error: f64,
}

/// Which of coarse fits, in the order of what speaks against them, are worth finishing: the first, and the two that follow the
/// windows best, with all that follow them as well.
pub fn worth_finishing(coarse: &[Coarse]) -> Vec<usize> {
    let Some(best) = coarse.first() else { return Vec::new() };
    let near = coarse.iter().filter(|c| c.against < best.against + NEAR_BEST).count();
    let near = near.clamp(LEAST_FINISHED, MOST_FINISHED).min(coarse.len());
    let mut errors = coarse.iter().map(|c| c.error).collect::<Vec<_>>();
    errors.sort_by(f64::total_cmp);
    let limit = errors[FOLLOWING.min(errors.len()) - 1];
    let others = (near..coarse.len()).filter(|i| coarse[*i].error <= limit);
    (0..near).chain(others).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fits a number of logarithms apart, each followed worse than the one before.
    fn apart(step: f64) -> Vec<Coarse> {
        let fit = |i| Coarse { against: step * f64::from(i), error: 2.0 + 0.1 * f64::from(i) };
        (0..20).map(fit).collect()
    }

    #[test]
    fn analytic_the_best_are_finished_and_those_near_them() {
        assert!(worth_finishing(&[]).is_empty());
        assert_eq!(worth_finishing(&apart(1.0)[..3]), [0, 1, 2]);
        assert_eq!(worth_finishing(&apart(500.0)), (0..6).collect::<Vec<_>>());
        // 0, 12, ... 96 lie within 100 of the best.
        assert_eq!(worth_finishing(&apart(12.0)), (0..9).collect::<Vec<_>>());
        assert_eq!(worth_finishing(&apart(1.0)), (0..12).collect::<Vec<_>>());
    }

    #[test]
    fn analytic_what_follows_the_windows_best_is_finished_however_likely() {
        let mut coarse = apart(500.0);
        (coarse[11].error, coarse[17].error) = (1.9, 1.5);
        assert_eq!(worth_finishing(&coarse), [0, 1, 2, 3, 4, 5, 11, 17]);
        // Of three only two.
        coarse[8].error = 1.7;
        assert_eq!(worth_finishing(&coarse), [0, 1, 2, 3, 4, 5, 8, 17]);
    }
}
