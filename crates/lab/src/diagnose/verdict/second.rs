//! Whether two effects are worth telling where one was.

use crate::diagnose::fit::{Fit, nats};
use crate::diagnose::trials::{Data, Tried, all_windows};
use crate::limits::{WORTH_A_SECOND, WORTH_A_SECOND_HELD_OUT, WORTH_A_SECOND_SEEN, WORTH_A_SECOND_TO_NOISE};

/// Whether a second effect is worth naming beside the first.
pub fn worth_two(data: &Data, one: &Tried, two: &Tried) -> bool {
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

/// Whether what a hypothesis leaves is what noise would, to a standard deviation: the squared error of noise has twice its
/// freedom as variance.
fn leaves_noise(tried: &Tried) -> bool {
    let windows = all_windows(tried);
    let freedom = windows.iter().map(|window| window.freedom).sum::<f64>();
    nats(&windows) < (0.5 * freedom).sqrt()
}

/// Whether the tests held out could show each effect that one of two hypotheses has more; not known: they could.
fn shows_held_out(data: &Data, one: &Tried, two: &Tried) -> bool {
    if data.held_out.windows.is_empty() {
        return false;
    }
    let Some(traces) = traces_held_out(data, two) else { return true };
    let additions = two.hypothesis.additions.iter().zip(traces);
    let mut new = additions.filter(|(addition, _)| !one.hypothesis.additions.contains(addition));
    new.all(|(_, trace)| trace > WORTH_A_SECOND_HELD_OUT)
}

/// What each addition of a hypothesis does to the windows held out beyond what their states can do, half its squared size over
/// the noise: about what taking it away would cost, in natural logarithms of likelihood. Linear; `None` where slopes cannot be
/// told.
fn traces_held_out(data: &Data, tried: &Tried) -> Option<Vec<f64>> {
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
    use crate::diagnose::fit::{Problem, WindowFit};
    use crate::diagnose::hypothesis::example::starter_with;

    /// No windows to price a number by, and none held out.
    const DATA: Data<'static> = Data { fit: NOTHING, held_out: NOTHING };
    const NOTHING: Problem<'static> = Problem { tests: &[], windows: &[] };
    const WINDOWS: usize = 20;
    const FREEDOM: f64 = 200.0;

    /// The starter's wall with these effects, followed so that all windows together speak against it by `nats` and each by
    /// as much: those fitted, and those held out.
    fn tried(names: &[&str], [fit, held_out]: [f64; 2]) -> Tried {
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
        Tried { hypothesis: starter_with(names), fit: of(fit), held_out: of(held_out) }
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
    fn analytic_a_second_effect_must_gain_less_where_the_tests_held_out_see_it() {
        assert!(worth([41.0, 50.0], [0.0, 0.0]), "a gain of 91, 50 of it held out, to noise");
        assert!(!worth([19.0, 50.0], [0.0, 0.0]), "a gain of 69");
        assert!(!worth([86.0, 3.0], [0.0, 0.0]), "a gain of 89, 3 of it held out");
        assert!(!worth([107.0, 50.0], [66.0, 0.0]), "a gain of 91, with 66 left");
    }
}
