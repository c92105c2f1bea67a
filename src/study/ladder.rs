//! The intensity at which a wall first exceeds a limit, by bracketing.
//!
//! Vamvatsikos & Cornell (2002), "Incremental dynamic analysis", Earthquake Engng Struct. Dyn. 31, hunt and fill:
//! intensities grow by a factor until one exceeds the limit, and the last step is then halved in the logarithm until it
//! is narrow enough. A rocking wall that fell may stand a stronger record again; what is found is the first fall met on
//! the way up, and steps that are too large can pass over one.

/// Share of the first intensity below which a wall that still exceeds its limit ends the search.
const LEAST: f64 = 1e-6;

/// Intensities to search, in any unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ladder {
    /// First and last intensity.
    pub range: [f64; 2],
    /// Each intensity over the one before, above 1.
    pub growth: f64,
    /// Lowest intensity that exceeded the limit over the highest below it that did not, at most.
    pub bracket: f64,
}

/// What a search ends with, and the trial at the intensity that it ends at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Search<T> {
    /// The limit is exceeded at `above`, and not at `below`.
    Exceeded {
        /// Highest intensity below that did not exceed it.
        below: f64,
        /// Lowest intensity found to exceed it.
        above: f64,
        /// The trial at `above`.
        trial: T,
    },
    /// Nothing exceeded the limit up to the last intensity.
    Stood {
        /// The last intensity.
        at: f64,
        /// The trial there.
        trial: T,
    },
    /// The limit is exceeded at a millionth of the first intensity, and so at however low a one.
    Always {
        /// The trial there.
        trial: T,
    },
}

/// Two intensities about the limit, and the trial at the upper one.
struct Bracket<T> {
    below: f64,
    above: f64,
    trial: T,
}

impl Ladder {
    /// The lowest intensity found to exceed a limit; `at` runs a trial and says whether it does.
    ///
    /// # Errors
    /// Those of `at`, which end the search.
    pub fn first_exceeding<T, E>(
        &self,
        at: &mut impl FnMut(f64) -> Result<(bool, T), E>,
    ) -> Result<Search<T>, E> {
        let [from, to] = self.range;
        let (mut intensity, (mut exceeded, mut trial)) = (from, at(from)?);
        if exceeded {
            return self.downwards(trial, at);
        }
        while intensity < to {
            let below = intensity;
            intensity = (intensity * self.growth).min(to);
            (exceeded, trial) = at(intensity)?;
            if exceeded {
                return self.narrowed(Bracket { below, above: intensity, trial }, at);
            }
        }
        Ok(Search::Stood { at: intensity, trial })
    }

    /// From a first intensity that is too much already.
    fn downwards<T, E>(
        &self,
        first: T,
        at: &mut impl FnMut(f64) -> Result<(bool, T), E>,
    ) -> Result<Search<T>, E> {
        let (mut intensity, mut trial) = (self.range[0], first);
        while intensity > LEAST * self.range[0] {
            let above = intensity;
            intensity /= self.growth;
            let (exceeded, lower) = at(intensity)?;
            if !exceeded {
                return self.narrowed(Bracket { below: intensity, above, trial }, at);
            }
            trial = lower;
        }
        Ok(Search::Always { trial })
    }

    /// Halves the logarithm of a bracket until it is narrow enough.
    fn narrowed<T, E>(
        &self,
        mut bracket: Bracket<T>,
        at: &mut impl FnMut(f64) -> Result<(bool, T), E>,
    ) -> Result<Search<T>, E> {
        while bracket.above / bracket.below > self.bracket {
            let middle = (bracket.below * bracket.above).sqrt();
            let (exceeded, trial) = at(middle)?;
            bracket = match exceeded {
                true => Bracket { above: middle, trial, ..bracket },
                false => Bracket { below: middle, ..bracket },
            };
        }
        let Bracket { below, above, trial } = bracket;
        Ok(Search::Exceeded { below, above, trial })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(limit: f64) -> Search<f64> {
        let ladder = Ladder { range: [0.5, 8.0], growth: 2.0, bracket: 1.01 };
        let ended = ladder.first_exceeding(&mut |x| Ok::<_, ()>((x > limit, x)));
        ended.expect("no trial fails")
    }

    #[test]
    fn analytic_a_threshold_is_bracketed_from_below_and_from_above() {
        for limit in [3.3, 0.02] {
            let Search::Exceeded { below, above, trial } = search(limit) else { panic!("not found") };
            assert!(below <= limit && limit < above && above / below <= 1.01, "{below} {above}");
            assert_eq!(trial.to_bits(), above.to_bits());
        }
    }

    #[test]
    fn analytic_no_threshold_in_reach_is_said() {
        assert_eq!(search(9.0), Search::Stood { at: 8.0, trial: 8.0 });
        assert!(matches!(search(0.0), Search::Always { .. }));
    }
}
