//! What speaks for another law than the one that is about to be named, though it closes the gap.
//!
//! An effect has one size in small and in large motion; a law that it imitates has not.

use super::judge::{Answer, Gap};
use super::{Verdict, names};
use crate::Progress;
use crate::diagnose::discovery::Guard;
use crate::diagnose::fit::{Fit, Loss, Problem, WindowSlopes};
use crate::diagnose::force::{curve_left, force_points};
use crate::diagnose::formula::Law;
use crate::diagnose::hypothesis::Hypothesis;
use crate::diagnose::trials::{Data, FittedHypothesis, closes, giving_friction};
use crate::limits::{BENT_FORCE, EQUIVALENT, TREND_NATS, TREND_SHARE};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

impl<P: Progress> Gap<'_, P> {
    /// A name, and all that was tried, in a class with a law outside the catalogue that closes the gap as well: a wall that swings as a whole
    /// does not tell a spring of its top from one of its ground.
    pub(super) fn in_class_with(
        &self,
        answer: Answer,
        law: Option<FittedHypothesis>,
        mut tried: Vec<FittedHypothesis>,
    ) -> (Answer, Vec<FittedHypothesis>) {
        let as_well =
            |law: &FittedHypothesis| closes(law, self.error) && self.gain(law, &answer.after) < EQUIVALENT;
        let Some(law) = law.filter(|law| as_well(law)) else { return (answer, tried) };
        let mut equivalent = answer.equivalent;
        if equivalent.is_empty() {
            equivalent = names(&answer.after);
        }
        equivalent.extend(law.hypothesis.laws(&law.fit.values).iter().map(Law::name));
        tried.push(law);
        (Answer { verdict: Verdict::Class, equivalent, ..answer }, self.trials.ordered(tried))
    }
}

/// What an added number would be, were it free to grow or shrink steadily with the largest rotation of a window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Trend {
    /// Gain in natural logarithms of likelihood, over the windows fitted and held out.
    pub nats: f64,
    /// By how much the number is larger or smaller than in the middle where the wall turns most, over its size.
    pub share: f64,
}

/// The trends of the added numbers of a fitted hypothesis.
///
/// Linear about the fit. Factors of impacts are not asked: they come in sixes. Nor is how stiffly friction sets in, which says
/// nothing of its force. `None` where the slopes cannot be told.
fn trends_with_amplitude(data: &Data, tried: &FittedHypothesis) -> Option<Vec<Trend>> {
    let h = &tried.hypothesis;
    let sides = [(data.fit, &tried.fit), (data.held_out, &tried.held_out)];
    let slopes = slopes(h, &tried.fit, sides)?;
    let rank = ranks(&slopes.iter().map(|s| s.amplitude).collect::<Vec<_>>());
    let friction = (0..h.additions.len()).filter_map(|i| giving_friction(h, &tried.fit.values, i));
    let onsets: Vec<usize> = friction.map(|friction| friction.stiffness).collect();
    let is_asked = |i: &usize| h.unknowns[*i].prior_sd.is_none() && h.is_size(*i) && !onsets.contains(i);
    let asked = (h.nuisances..h.unknowns.len()).filter(is_asked);
    Some(asked.filter_map(|i| trend(h, &tried.fit, &slopes, &rank, i)).collect())
}

/// A window with how far the wall turns in it, and the weight it has in the fit.
struct Sloped {
    amplitude: f64,
    weight: f64,
    slopes: WindowSlopes,
}

fn slopes(h: &Hypothesis, fit: &Fit, sides: [(Problem, &Fit); 2]) -> Option<Vec<Sloped>> {
    let mut all = Vec::new();
    let mut changes = None;
    for (problem, states) in sides {
        if problem.windows.is_empty() {
            continue;
        }
        // The states of tests held out, the values of the fit.
        let at = Fit { values: fit.values.clone(), ..states.clone() };
        let (slopes, used) = problem.slopes(h, &at, changes.as_deref())?;
        changes = Some(used);
        let windows = problem.windows.iter().zip(&at.windows).zip(slopes);
        all.extend(windows.map(|((window, state), slopes)| {
            let rows = &problem.tests[window.test].theta_rad[window.samples.clone()];
            let amplitude =
                rows.iter().flatten().filter(|x| x.is_finite()).fold(0.0, |m: f64, x| m.max(x.abs()));
            Sloped { amplitude, weight: Loss::Likelihood.weight(state), slopes }
        }));
    }
    Some(all)
}

/// Ranks from -1 for the smallest to 1 for the largest.
fn ranks(x: &[f64]) -> Vec<f64> {
    let mut order = (0..x.len()).collect::<Vec<_>>();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    let mut ranks = vec![0.0; x.len()];
    for (place, index) in order.into_iter().enumerate() {
        ranks[index] = 2.0 * place as f64 / (x.len().max(2) - 1) as f64 - 1.0;
    }
    ranks
}

/// The trend of the number `i`; its gain is what goes beyond that of another step of all numbers.
fn trend(h: &Hypothesis, fit: &Fit, slopes: &[Sloped], rank: &[f64], i: usize) -> Option<Trend> {
    let count = h.unknowns.len();
    let (mut a, mut g) = (DMatrix::zeros(count + 1, count + 1), DVector::zeros(count + 1));
    for (window, rank) in slopes.iter().zip(rank) {
        let trend = window.slopes.by_values.column(i) * *rank;
        let columns = window.slopes.by_values.clone().insert_column(count, 0.0);
        let mut columns: DMatrix<f64> = columns;
        columns.set_column(count, &trend);
        a += columns.transpose() * &columns * window.weight;
        g += columns.transpose() * &window.slopes.residual * window.weight;
    }
    h.add_prior(&fit.values, &mut a, &mut g);
    for (k, unknown) in h.unknowns.iter().enumerate() {
        // A number without a trace stays where it is.
        a[(k, k)] += 1e-12 / (unknown.scale * unknown.scale);
    }
    a[(count, count)] += 1e-12 / (h.unknowns[i].scale * h.unknowns[i].scale);
    let step = |a: DMatrix<f64>, g: &DVector<f64>| Some(a.cholesky()?.solve(g));
    let (first, own) = (a.view((0, 0), (count, count)).into_owned(), g.rows(0, count).into_owned());
    let without = 0.5 * own.dot(&step(first, &own)?);
    let all = step(a, &g)?;
    let size = (fit.values[i] - h.unknowns[i].start).abs();
    Some(Trend { nats: 0.5 * g.dot(&all) - without, share: all[count].abs() / size.max(f64::MIN_POSITIVE) })
}

/// Signs of a law outside the catalogue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OtherLaw {
    /// The effects it would be taken for.
    pub looks_like: Vec<String>,
    /// See [`curve_left`].
    pub curve_left: Option<f64>,
    /// How a size differs in large motion, and what that gains. Sizes that differ by more than 4 % come first; among
    /// these the one that gains most.
    pub trend_with_amplitude: Option<Trend>,
}

impl OtherLaw {
    /// Looks at a fitted hypothesis.
    pub fn beside(data: &Data, named: &FittedHypothesis) -> Self {
        let physics = named.hypothesis.physics(&named.fit.values);
        let points = physics.map(|physics| force_points(data.fit.tests, &physics));
        Self {
            looks_like: names(named),
            curve_left: points.and_then(|points| curve_left(&points)),
            trend_with_amplitude: trends_with_amplitude(data, named).and_then(largest),
        }
    }

    /// Whether the law cannot be the named one.
    pub fn speaks(&self) -> bool {
        !self.guards().is_empty()
    }

    /// Whether a size surely differs in large motion, by more than such a share of it.
    pub fn differs_in_large_motion_by(&self, share: f64) -> bool {
        self.trend_with_amplitude.is_some_and(|trend| trend.nats > TREND_NATS && trend.share > share)
    }

    /// What of it speaks.
    pub fn guards(&self) -> Vec<Guard> {
        let bends = self.curve_left.is_some_and(|found| found > BENT_FORCE);
        let both = [(Guard::Bend, bends), (Guard::Trend, self.differs_in_large_motion_by(TREND_SHARE))];
        both.into_iter().filter(|(_, speaks)| *speaks).map(|(guard, _)| guard).collect()
    }
}

fn largest(trends: Vec<Trend>) -> Option<Trend> {
    let clear = |trend: &Trend| trend.share > TREND_SHARE;
    trends.into_iter().max_by(|a, b| clear(a).cmp(&clear(b)).then(a.nats.total_cmp(&b.nats)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{Twin, wall_with};
    use crate::diagnose::hypothesis::Addition;
    use crate::diagnose::trials::{joint_error, try_hypothesis, with_values};
    use mrbd_kernel::model::EffectKind;

    /// What a cubic spring is in a class with, fitted to the windows of a wall that has one.
    fn in_class_with_cubic(noise_rad: f64) -> (Verdict, Vec<String>, usize) {
        let cubic = "[[effects]]\nkind = \"cubic_stiffness\"\ncoefficient_n_per_m3 = 2e6\n";
        let twin = Twin::new(&wall_with(cubic), noise_rad);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let cubic = EffectKind::CubicStiffness.variant(None).expect("a kind without variants");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Effect(cubic)]);
        let named = try_hypothesis(&trials.data, h, &wall.before).expect("a wall");
        let relatives = trials.relatives(&named);
        assert!(relatives.better.is_none(), "{:?}", relatives.better);
        let error = joint_error(&wall.before).expect("windows");
        let (answer, tried) = Gap::new(&trials, wall, error).in_class_with(
            Answer::of(Verdict::Named, named),
            relatives.of_ground,
            Vec::new(),
        );
        (answer.verdict, answer.equivalent, tried.len())
    }

    #[test]
    fn analytic_a_spring_of_the_top_is_in_a_class_with_one_of_the_ground_where_noise_hides_which_it_is() {
        assert_eq!(in_class_with_cubic(1e-5), (Verdict::Named, Vec::new(), 0));
        let (verdict, names, tried) = in_class_with_cubic(3e-4);
        let expected = ["cubic_stiffness", "-k*sign(phi)*abs(phi)**n at ground"];
        assert_eq!((verdict, names, tried), (Verdict::Class, expected.map(str::to_owned).to_vec(), 1));
    }

    #[test]
    fn analytic_how_stiffly_friction_sets_in_is_no_sign_of_another_law() {
        let friction = "[[effects]]\nkind = \"coulomb_friction\"\nforce_n = 300.0\n";
        let twin = Twin::new(&wall_with(friction), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows").recalibrated;
        let spring = EffectKind::YieldingSpring.variant(None).expect("a kind without variants");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Effect(spring)]);
        let asked = |onset_m: f64| {
            let values = [&wall.fit.values[..], &[300.0 / onset_m, 300.0]].concat();
            let tried = with_values(&trials.data, h.clone(), &wall, &values).expect("a wall");
            trends_with_amplitude(&trials.data, &tried).expect("slopes").len()
        };
        // Of friction its force alone; of a spring that yields its stiffness, too.
        assert_eq!([1e-5, 1e-2].map(asked), [1, 2]);
    }

    fn speaks(trends: &[(f64, f64)]) -> bool {
        let trends = trends.iter().map(|&(nats, share)| Trend { nats, share }).collect();
        OtherLaw { looks_like: Vec::new(), curve_left: None, trend_with_amplitude: largest(trends) }.speaks()
    }

    #[test]
    fn analytic_a_trend_speaks_where_it_is_both_sure_and_large() {
        assert!(speaks(&[(240.0, 0.56)]));
        assert!(!speaks(&[(51.0, 0.004)]) && !speaks(&[(9.0, 0.5)]) && !speaks(&[]));
        // Of two numbers, the one that is surer does not hide the other.
        assert!(speaks(&[(100.0, 0.01), (40.0, 0.3)]));
    }
}
