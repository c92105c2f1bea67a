//! What is worth naming: how large an effect must be to show, whether a second one shows, and at which place.

use crate::diagnose::fit::{Fit, WindowFit, nats};
use crate::diagnose::trials::{Data, FittedHypothesis, against, all_windows, joint_error, kinds};
use crate::limits::{
    DETECTED_SD, LEAST_SIZE, LEFT_HELD_OUT_SD, OUTDOES_NAME_SD, PLACE_NATS, PLACE_SQUARED_ERROR,
    WORTH_A_NAME, WORTH_A_SECOND, WORTH_A_SECOND_HELD_OUT, WORTH_A_SECOND_SEEN, WORTH_A_SECOND_TO_NOISE,
};

/// What the tests can tell of a single effect, by its first number and in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// Standard deviation.
    pub sd: f64,
    /// Smallest size that differs from nothing by more than chance.
    pub detected_from: f64,
    /// Smallest size that would be named: what is smaller may be there all the same.
    pub named_from: f64,
    /// Size that would matter.
    pub matters: f64,
}

/// Whether at least half of the effects would have been named at a size that matters.
pub fn could_show(data: &Data, without: &FittedHypothesis, singles: &[FittedHypothesis]) -> bool {
    let powers = singles.iter().filter_map(|t| power(data, without, t)).collect::<Vec<_>>();
    2 * powers.iter().filter(|power| power.named_from < power.matters).count() >= powers.len()
}

/// What the tests can tell of a single effect, beside the wall `without` it. `None` where its fit leaves no
/// covariance, or it is no effect.
pub fn power(data: &Data, without: &FittedHypothesis, tried: &FittedHypothesis) -> Option<Power> {
    let h = &tried.hypothesis;
    let i = h.nuisances;
    kinds(tried)?;
    let variance = tried.fit.covariance.as_ref()?[(i, i)];
    let unknown = h.unknowns.get(i)?;
    let size = tried.fit.values[i] - unknown.start;
    let gain = (h.unknowns.len() == i + 1).then(|| without.unpriced() - tried.unpriced());
    let sd = spread(variance.max(0.0).sqrt(), size, gain);
    // An effect gains half of its squared size in standard deviations.
    let named = (2.0 * (WORTH_A_NAME + tried.price(data))).sqrt();
    let named_from = (named * sd).max(LEAST_SIZE * unknown.scale);
    Some(Power { sd, detected_from: DETECTED_SD * sd, named_from, matters: unknown.scale })
}

/// The standard deviation of a size: from the curvature of likelihood at it, and from what it gains over nothing. The
/// gain counts where a size is one number alone and gains too little to be named. Near impacts that the noise decides
/// likelihood has many sharp maxima. How far they lie apart shows in a size that gains less than its curvature says.
fn spread(curved: f64, size: f64, gain: Option<f64>) -> f64 {
    match gain {
        // One more, for by chance a size of one standard deviation is found where there is none.
        Some(gain) if gain < WORTH_A_NAME => curved.max(size.abs() / (2.0 * gain.max(0.0) + 1.0).sqrt()),
        _ => curved,
    }
}

/// What a hypothesis leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Left {
    /// What speaks against it, in natural logarithms of likelihood.
    nats: f64,
    /// Its windowed error, in standard deviations of the noise.
    error: f64,
}

impl Left {
    fn of(data: &Data, tried: &FittedHypothesis) -> Option<Self> {
        Some(Self { nats: against(data, tried), error: joint_error(tried)? })
    }

    /// Whether another hypothesis takes away a good part of it.
    fn shrinks_to(self, best: Self) -> bool {
        let of_nats = (self.nats - best.nats) / self.nats;
        let excess = |error: f64| error * error - 1.0;
        let of_squared_error = 1.0 - excess(best.error) / excess(self.error);
        of_nats > PLACE_NATS || (self.error > 1.0 && of_squared_error > PLACE_SQUARED_ERROR)
    }
}

/// The place whose effects take away a good part of what speaks against the wall, if there is one.
pub fn place(
    data: &Data,
    recalibrated: &FittedHypothesis,
    tried: &[FittedHypothesis],
) -> Option<&'static str> {
    let answers = tried.iter().filter(|t| kinds(t).is_some());
    let best = answers.min_by(|a, b| against(data, a).total_cmp(&against(data, b)))?;
    let shrinks = Left::of(data, recalibrated)?.shrinks_to(Left::of(data, best)?);
    shrinks.then(|| best.hypothesis.additions[0].place())
}

/// Whether a second effect is worth naming beside the first.
pub fn worth_two(data: &Data, one: &FittedHypothesis, two: &FittedHypothesis) -> bool {
    let gain: [f64; 2] = std::array::from_fn(|i| one.against(data)[i] - two.against(data)[i]);
    // A damper in a crack that stays shut in the tests held out is neither seen nor refuted there.
    let seen = gain[1] > WORTH_A_SECOND_HELD_OUT;
    let least = match (leaves_noise(two), seen) {
        (true, true) => WORTH_A_SECOND_SEEN,
        (true, false) => WORTH_A_SECOND_TO_NOISE,
        (false, _) => WORTH_A_SECOND,
    };
    gain.iter().sum::<f64>() > least && (seen || !shows_held_out(data, one, two))
}

/// Whether the tests held out alone ask for what a second law adds to a first: with it they are followed to their noise, and by as much
/// better as an addition must gain of which they know nothing. The tests fitted must not mind.
pub fn held_out_ask_for(data: &Data, one: &FittedHypothesis, two: &FittedHypothesis) -> bool {
    let [fitted, held_out]: [f64; 2] = std::array::from_fn(|i| one.against(data)[i] - two.against(data)[i]);
    fitted > 0.0 && held_out > WORTH_A_SECOND_TO_NOISE && are_as_noise(&two.held_out.windows)
}

/// Whether what a hypothesis leaves is what noise would.
pub fn leaves_noise(tried: &FittedHypothesis) -> bool {
    are_as_noise(&all_windows(tried))
}

/// Whether a hypothesis leaves what noise may leave, though seldom so much.
pub fn leaves_noise_or_little_more(tried: &FittedHypothesis) -> bool {
    let windows = all_windows(tried);
    nats(&windows) < OUTDOES_NAME_SD * noise_sd(&windows)
}

/// Whether a hypothesis leaves so much of the tests held out alone that it may have taken up another law: their motion is larger.
pub fn stands_out_held_out(tried: &FittedHypothesis) -> bool {
    let windows = &tried.held_out.windows;
    nats(windows) > LEFT_HELD_OUT_SD * noise_sd(windows)
}

/// Standard deviation of what noise leaves of windows, in natural logarithms of likelihood: its squared error has twice its freedom as variance.
fn noise_sd(windows: &[WindowFit]) -> f64 {
    (0.5 * windows.iter().map(|window| window.freedom).sum::<f64>()).sqrt()
}

/// Whether what is left of windows is what noise would leave, to a standard deviation.
pub fn are_as_noise(windows: &[WindowFit]) -> bool {
    nats(windows) < noise_sd(windows)
}

/// Whether the tests held out could show each effect that one of two hypotheses has more; not known: they could.
fn shows_held_out(data: &Data, one: &FittedHypothesis, two: &FittedHypothesis) -> bool {
    if data.held_out.windows.is_empty() {
        return false;
    }
    let Some(traces) = traces_held_out(data, two) else { return true };
    let additions = two.hypothesis.additions.iter().zip(traces);
    let mut new = additions.filter(|(addition, _)| !one.hypothesis.additions.contains(addition));
    new.all(|(_, trace)| trace > WORTH_A_SECOND_HELD_OUT)
}

/// What each addition of a hypothesis does to the windows held out beyond what their states can do. It is half its
/// squared size over the noise: about the cost of taking it away, in natural logarithms of likelihood. Linear; `None`
/// where slopes cannot be told.
fn traces_held_out(data: &Data, tried: &FittedHypothesis) -> Option<Vec<f64>> {
    let h = &tried.hypothesis;
    let at = Fit { values: tried.fit.values.clone(), ..tried.held_out.clone() };
    let (slopes, _) = data.held_out.slopes(h, &at, None)?;
    let trace = |index: usize| {
        let own = (0..h.unknowns.len()).filter(|i| h.unknowns[*i].belongs_to(index));
        let own = own.map(|i| (i, at.values[i] - h.unknowns[i].start)).collect::<Vec<_>>();
        let change = |by_values: &nalgebra::DMatrix<f64>| {
            own.iter()
                .map(|(i, size)| by_values.column(*i) * *size)
                .sum::<nalgebra::DVector<f64>>()
                .norm_squared()
        };
        0.5 * slopes.iter().map(|window| change(&window.by_values)).sum::<f64>()
    };
    Some((0..h.additions.len()).map(trace).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::Problem;
    use crate::diagnose::hypothesis::example::starter_with;

    #[test]
    fn analytic_a_size_that_gains_less_than_its_curvature_says_is_less_sure() {
        // Two standard deviations gain two natural logarithms, and one by chance half of one.
        assert_eq!(spread(0.1, 0.2, Some(2.0)), 0.1);
        assert_eq!(spread(0.1, 0.05, Some(0.0)), 0.1);
        // Thirty of them that gain 12: a fifth of the size.
        assert_eq!(spread(0.1, -3.0, Some(12.0)), 0.6);
        assert_eq!(spread(0.1, 3.0, Some(-4.0)), 3.0);
        // What is named, whose windows are at their bound, and what has other numbers too.
        assert_eq!(spread(0.1, 30.0, Some(300.0)), 0.1);
        assert_eq!(spread(0.1, 3.0, None), 0.1);
    }

    const fn left(nats: f64, error: f64) -> Left {
        Left { nats, error }
    }

    #[test]
    fn analytic_a_place_shows_by_likelihood_or_where_that_is_at_its_bound_by_error() {
        // 31 and 29 % of the logarithms.
        assert!(left(1000.0, 1.2).shrinks_to(left(690.0, 1.19)));
        assert!(!left(1000.0, 1.2).shrinks_to(left(710.0, 1.19)));
        // Far above the noise: from 12² to 8² − 55 %, and to 9² − 44 %.
        assert!(left(10_700.0, 12.0).shrinks_to(left(10_000.0, 8.0)));
        assert!(!left(10_700.0, 12.0).shrinks_to(left(10_000.0, 9.0)));
        // No more than noise, by error: nothing to take away, and no share of it.
        assert!(!left(300.0, 0.99).shrinks_to(left(290.0, 0.97)));
        assert!(!left(300.0, 0.99).shrinks_to(left(290.0, 0.999)));
    }

    /// No windows to price a number by, and none held out.
    const DATA: Data<'static> = Data { fit: NOTHING, held_out: NOTHING };
    const NOTHING: Problem<'static> = Problem { tests: &[], windows: &[], budget: None };
    const WINDOWS: usize = 20;
    const FREEDOM: f64 = 200.0;

    /// The starter's wall with these effects, followed so that all windows together speak against it by `nats` and each by
    /// as much: those fitted, and those held out.
    fn tried(names: &[&str], [fit, held_out]: [f64; 2]) -> FittedHypothesis {
        let window = |nats: f64| {
            // The bounded loss of a window, turned about: 40 (1 − exp(−excess/40)) at most.
            let excess = -40.0 * (1.0 - nats / WINDOWS as f64 / 40.0).ln();
            WindowFit { x: vec![0.0; 4], squares: FREEDOM + 2.0 * excess, freedom: FREEDOM }
        };
        let of = |nats| Fit {
            values: vec![0.0; names.len()],
            windows: vec![window(nats); WINDOWS],
            cost: 0.0,
            covariance: None,
        };
        FittedHypothesis { hypothesis: starter_with(names), fit: of(fit), held_out: of(held_out) }
    }

    #[test]
    fn analytic_windows_are_as_noise_leaves_them_to_a_standard_deviation() {
        let of = |missed: usize| {
            let window = |k| WindowFit {
                x: vec![0.0; 4],
                squares: if k < missed { 1e4 } else { FREEDOM },
                freedom: FREEDOM,
            };
            (0..WINDOWS).map(window).collect::<Vec<_>>()
        };
        // √(½ · 20 · 200) = 45 nats, and 40 at most in a window.
        assert!(are_as_noise(&of(0)) && are_as_noise(&of(1)) && !are_as_noise(&of(2)));
    }

    #[test]
    fn analytic_what_stands_out_of_tests_held_out_is_four_deviations_of_their_noise_whatever_those_fitted_leave()
     {
        // Four times 45 nats.
        let stands_out = |left: [f64; 2]| stands_out_held_out(&tried(&[], left));
        assert!(stands_out([0.0, 190.0]) && !stands_out([0.0, 170.0]) && !stands_out([500.0, 0.0]));
    }

    #[test]
    fn analytic_a_law_that_outdoes_a_name_leaves_two_deviations_of_noise_at_most() {
        // Twice 63 nats.
        let little = |left: f64| leaves_noise_or_little_more(&tried(&[], [0.5 * left; 2]));
        assert_eq!([60.0, 124.0, 128.0].map(little), [true, true, false]);
    }

    fn worth(of_one: [f64; 2], of_two: [f64; 2]) -> bool {
        worth_two(
            &DATA,
            &tried(&["carriage_mass"], of_one),
            &tried(&["carriage_mass", "record_gain"], of_two),
        )
    }

    #[test]
    fn analytic_a_second_effect_must_gain_more_where_both_leave_more_than_noise() {
        // Noise leaves √(½ · 40 · 200) = 63 nats. Over the tests held out nothing is gained, and they could show nothing.
        let fitted = |of_one: f64, of_two: f64| worth([of_one, 0.0], [of_two, 0.0]);
        assert!(fitted(226.0, 0.0) && fitted(270.0, 60.0), "gains of 226 and 210, to noise");
        assert!(!fitted(149.0, 0.0), "a gain of 149, to noise");
        assert!(!fitted(302.0, 66.0) && !fitted(365.0, 66.0), "gains of 236 and 299, with 66 left");
        assert!(fitted(367.0, 66.0), "a gain of 301, with 66 left");
    }

    #[test]
    fn analytic_tests_held_out_may_ask_for_a_second_law_by_themselves() {
        let ask = |of_one: [f64; 2], of_two: [f64; 2]| {
            let [one, two] = [(&["carriage_mass"][..], of_one), (&["carriage_mass", "record_gain"], of_two)]
                .map(|(names, nats)| tried(names, nats));
            (held_out_ask_for(&DATA, &one, &two), worth_two(&DATA, &one, &two))
        };
        assert_eq!(
            ask([167.0, 160.0], [102.0, 0.0]),
            (true, false),
            "all that is left is in the tests fitted"
        );
        assert!(!ask([167.0, 140.0], [102.0, 0.0]).0, "140 held out");
        assert!(!ask([101.0, 160.0], [102.0, 0.0]).0, "the tests fitted mind");
        assert!(!ask([167.0, 360.0], [102.0, 70.0]).0, "more than noise is left held out");
    }

    #[test]
    fn analytic_a_second_effect_must_gain_less_where_the_tests_held_out_see_it() {
        assert!(worth([41.0, 50.0], [0.0, 0.0]), "a gain of 91, 50 of it held out, to noise");
        assert!(!worth([19.0, 50.0], [0.0, 0.0]), "a gain of 69");
        assert!(!worth([86.0, 3.0], [0.0, 0.0]), "a gain of 89, 3 of it held out");
        assert!(!worth([107.0, 50.0], [66.0, 0.0]), "a gain of 91, with 66 left");
    }
}
