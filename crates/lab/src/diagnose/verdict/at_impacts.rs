//! What is left at impacts, where formulations of a stiff contact part.
//!
//! Rigid bodies on sharp edges meet in no time; on corners that give an impact takes its time, and a row of springs keeps more
//! of the motion. None of that is an effect that a wall lacks. So a law is named by what it leaves between impacts, where it
//! leaves little at them; and impacts that keep as much as those of another formulation get no name.

use super::remainder::{model_error_rad, most_error_rad};
use super::worth_naming::are_as_noise;
use crate::Progress;
use crate::diagnose::fit::{WindowFit, nats};
use crate::diagnose::hypothesis::{Addition, FADES};
use crate::diagnose::trials::{
    BetweenImpacts, Data, FittedHypothesis, Trials, against, best_answer, does_something, kinds, leave_noise,
    opened_under,
};
use crate::experiment::Window;
use crate::limits::{
    EQUIVALENT, KEPT_AT_IMPACTS, LEFT_AT_IMPACTS, MISSED_BETWEEN_IMPACTS, NOT_TOLD_SD, SIGNIFICANT_SD,
    WORTH_A_NAME, WORTH_A_SECOND_HELD_OUT, WORTH_A_SECOND_SEEN, WORTH_A_SECOND_TO_NOISE,
};
use mrbd_kernel::model::Role;

/// A name by what is left between impacts.
pub struct NamedBetween<'t> {
    /// The best hypothesis.
    pub best: &'t FittedHypothesis,
    /// Of other kinds, what cannot be told from it.
    pub near: Vec<&'t FittedHypothesis>,
}

/// The best of hypotheses, in order, that leaves noise between impacts and little at them, and gains a name's worth over a simpler
/// one there; `None` if that is nothing, or no answer.
pub fn named_between<'t, P: Progress>(
    trials: &Trials<P>,
    tried: &'t [FittedHypothesis],
    simpler: &FittedHypothesis,
) -> Option<NamedBetween<'t>> {
    let may =
        tried.iter().filter(|t| !has_impacts(t) && leaves_little_of_each(trials, t)).collect::<Vec<_>>();
    let cut = BetweenImpacts::cut(&trials.data, best_answer(may.iter().copied())?)?;
    let against = |t: &'t FittedHypothesis| {
        let left = cut.left(&trials.data, t).filter(leave_noise)?;
        Some((sum(&left.map(|side| nats(&side))) + t.price(&trials.data), t))
    };
    let mut following = may.into_iter().filter_map(against).collect::<Vec<_>>();
    following.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (first, _) = following.first()?;
    let (own, best) = following.iter().find(|(_, t)| kinds(t).is_some() && does_something(t))?;
    let without =
        sum(&cut.left(&trials.data, simpler)?.map(|side| nats(&side))) + simpler.price(&trials.data);
    if without - own < WORTH_A_NAME || own - first > EQUIVALENT {
        return None;
    }
    let is_near =
        |(other, t): &&(f64, &FittedHypothesis)| other - own < EQUIVALENT && kinds(t) != kinds(best);
    let near = following.iter().filter(is_near).map(|(_, t)| *t).collect();
    Some(NamedBetween { best, near })
}

/// Whether a wall leaves noise between impacts and little at them, and no effect is worth a name between impacts.
pub fn only_impacts<P: Progress>(
    trials: &Trials<P>,
    wall: &FittedHypothesis,
    singles: &[FittedHypothesis],
) -> bool {
    leaves_little(trials, wall)
        && left_between(trials, wall).is_some_and(|left| leave_noise(&left))
        && named_between(trials, singles, wall).is_none()
}

/// Whether all that a hypothesis leaves is what formulations of a stiff contact part by: little in each test, and between impacts no
/// more than noise in the tests fitted and in those held out, each for itself. A law that only imitates another leaves more in the larger
/// motion of tests held out, in however few windows.
pub fn leaves_only_impacts<P: Progress>(trials: &Trials<P>, tried: &FittedHypothesis) -> bool {
    let as_noise =
        |left: [Vec<WindowFit>; 2]| leave_noise(&left) && left.iter().all(|side| are_as_noise(side));
    leaves_little_of_each(trials, tried) && left_between(trials, tried).is_some_and(as_noise)
}

/// Whether a law misses windows of the tests held out where no impact excuses it: the larger motion of these shows what it lacks. Nor does
/// a window count that it follows once a joint is open there by less than the noise.
pub fn misses_held_out_between<P: Progress>(trials: &Trials<P>, law: &FittedHypothesis) -> bool {
    let missed = || {
        let cut = BetweenImpacts::cut(&trials.data, law)?;
        let [_, held_out] = cut.left(&trials.data, law)?;
        let missed = held_out.iter().zip(cut.places_held_out()).filter(|(window, _)| window.is_poor());
        Some(missed.map(|(_, place)| *place).collect::<Vec<_>>())
    };
    let Some(missed) = missed().filter(|missed| missed.len() > MISSED_BETWEEN_IMPACTS) else {
        return false;
    };
    let windows = trials.data.held_out.windows;
    let opened = opened_under(&trials.data, law).map(|([_, held_out], _)| held_out);
    stay_missed(&missed, windows, opened.as_deref().unwrap_or(windows)) > MISSED_BETWEEN_IMPACTS
}

/// How many of the windows missed are not followed with a joint opened.
fn stay_missed(missed: &[usize], windows: &[Window], opened: &[Window]) -> usize {
    missed.iter().filter(|place| opened[**place].opened == windows[**place].opened).count()
}

/// What a hypothesis leaves of windows up to its first impact.
fn left_between<P: Progress>(trials: &Trials<P>, tried: &FittedHypothesis) -> Option<[Vec<WindowFit>; 2]> {
    BetweenImpacts::cut(&trials.data, tried)?.left(&trials.data, tried)
}

/// Whether a second effect is worth naming by what it takes away between impacts.
pub fn worth_two_between<P: Progress>(
    trials: &Trials<P>,
    one: &FittedHypothesis,
    two: &FittedHypothesis,
) -> bool {
    let gains = || {
        let cut = BetweenImpacts::cut(&trials.data, two)?;
        let [one, two] = [one, two].map(|t| Some(cut.left(&trials.data, t)?.map(|side| nats(&side))));
        let (one, two) = (one?, two?);
        Some([0, 1].map(|side| one[side] - two[side]))
    };
    gains().is_some_and(|gain| {
        let seen = gain[1] > WORTH_A_SECOND_HELD_OUT;
        let least = if seen { WORTH_A_SECOND_SEEN } else { WORTH_A_SECOND_TO_NOISE };
        sum(&gain) + one.price(&trials.data) - two.price(&trials.data) > least
    })
}

/// Whether impacts that keep what those of another formulation may keep do as well as the best of hypotheses that close a gap, or are
/// of it.
pub fn is_near_other_impacts(data: &Data, best: &FittedHypothesis, closing: &[&FittedHypothesis]) -> bool {
    let limit = against(data, best) + EQUIVALENT;
    let do_as_well = |t: &&&FittedHypothesis| against(data, t) < limit;
    closing.iter().filter(do_as_well).any(|t| keeps_as_another_formulation(t))
}

/// Whether a hypothesis has impacts, and all that they are told to keep is what those of another formulation may keep.
fn keeps_as_another_formulation(tried: &FittedHypothesis) -> bool {
    let h = &tried.hypothesis;
    // What is kept changes by this much with a number.
    let share = |i: usize| if h.unknowns[i].fades() { FADES / h.unknowns[i].scale } else { 1.0 };
    let sd = |i: usize| {
        let of_number = tried.fit.covariance.as_ref().map_or(0.0, |c| c[(i, i)].max(0.0).sqrt());
        share(i) * of_number
    };
    let kept = |i: usize| match h.unknowns[i].fades() {
        true => (-share(i) * tried.fit.values[i]).exp(),
        false => tried.fit.values[i],
    };
    let is_factor = |i: &usize| {
        let impacts =
            |(index, addition): (usize, _)| is_impacts(addition) && h.unknowns[*i].belongs_to(index);
        h.additions.iter().enumerate().any(impacts) && sd(*i) < NOT_TOLD_SD
    };
    let [least, most] = KEPT_AT_IMPACTS;
    let inside = |i: usize| {
        let unsure = SIGNIFICANT_SD * sd(i);
        (least - unsure..=most + unsure).contains(&kept(i))
    };
    has_impacts(tried) && (h.nuisances..h.unknowns.len()).filter(is_factor).all(inside)
}

/// Whether what a hypothesis leaves over all windows is what formulations of a stiff contact part by.
fn leaves_little<P: Progress>(trials: &Trials<P>, tried: &FittedHypothesis) -> bool {
    is_little(trials, model_error_rad(&trials.data, tried))
}

/// The same over the windows of each test: one that a name misses by more speaks against it, however many others it follows.
fn leaves_little_of_each<P: Progress>(trials: &Trials<P>, tried: &FittedHypothesis) -> bool {
    is_little(trials, most_error_rad(&trials.data, tried))
}

fn is_little<P: Progress>(trials: &Trials<P>, left_rad: Option<f64>) -> bool {
    left_rad.is_none_or(|left_rad| left_rad < LEFT_AT_IMPACTS * trials.experiment.scales.rotation_rad)
}

fn has_impacts(tried: &FittedHypothesis) -> bool {
    tried.hypothesis.additions.iter().any(is_impacts)
}

fn is_impacts(addition: &Addition) -> bool {
    addition.role().is_some_and(Role::is_at_impacts)
}

fn sum(sides: &[f64; 2]) -> f64 {
    sides.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::{Fit, Problem, WindowFit};
    use crate::diagnose::hypothesis::example::starter_with;
    use crate::experiment::{Freedom, Purpose};
    use nalgebra::DMatrix;

    /// Factors of impacts, each known to a standard deviation, with an effect beside them or none.
    fn kept(names: &[&str], factors: [f64; 6], sd: f64) -> bool {
        let hypothesis = starter_with(names);
        let count = hypothesis.unknowns.len();
        let mut values = vec![0.0; count];
        let first = count - factors.len();
        values[first..].copy_from_slice(&factors);
        let covariance = Some(DMatrix::from_diagonal_element(count, count, sd * sd));
        let fit = Fit { values, windows: Vec::new(), cost: 0.0, covariance };
        let held_out = fit.clone();
        keeps_as_another_formulation(&FittedHypothesis { hypothesis, fit, held_out })
    }

    #[test]
    fn analytic_impacts_that_keep_as_much_as_those_of_springs_are_no_effect() {
        let springs = [1.0505, 1.0493, 1.0061, 1.0037, 1.0, 1.0031];
        assert!(kept(&["impact_dissipation"], springs, 1e-3));
        assert!(kept(&["joint_damping.crack", "impact_dissipation"], springs, 1e-3), "beside an effect too");
        let less = [0.95, 0.98, 1.0, 1.0, 1.0, 0.93];
        assert!(!kept(&["impact_dissipation"], less, 1e-3));
        assert!(kept(&["impact_dissipation"], less, 0.2), "not told");
        assert!(!kept(&["impact_dissipation"], [1.2, 1.0, 1.0, 1.0, 1.0, 1.0], 1e-3), "more than any");
    }

    #[test]
    fn analytic_what_impacts_of_another_formulation_do_as_well_is_near_them() {
        const NOTHING: Problem<'static> = Problem { tests: &[], windows: &[], budget: None };
        let data = Data { fit: NOTHING, held_out: NOTHING };
        let of = |names: &[&str], factors: &[f64], squares: f64| {
            let hypothesis = starter_with(names);
            let mut values = hypothesis.start();
            let first = values.len() - factors.len();
            values[first..].copy_from_slice(factors);
            let count = values.len();
            let covariance = Some(DMatrix::from_diagonal_element(count, count, 1e-6));
            let windows = vec![WindowFit { x: vec![0.0; 4], squares, freedom: 200.0 }; 20];
            let held_out = Fit { values: Vec::new(), windows: Vec::new(), cost: 0.0, covariance: None };
            let fit = Fit { values, windows, cost: 0.0, covariance };
            FittedHypothesis { hypothesis, fit, held_out }
        };
        let springs = of(&["impact_dissipation"], &[1.002; 6], 200.0);
        let less = of(&["impact_dissipation"], &[0.9; 6], 200.0);
        // The same error in every window, and one that speaks against it by some hundred logarithms.
        let [as_well, worse] = [200.0, 260.0].map(|squares| of(&["record_gain"], &[0.98], squares));
        assert!(is_near_other_impacts(&data, &springs, &[&springs]));
        assert!(is_near_other_impacts(&data, &as_well, &[&as_well, &springs]));
        assert!(is_near_other_impacts(&data, &worse, &[&worse, &springs]), "which are better");
        assert!(!is_near_other_impacts(&data, &as_well, &[&as_well, &less]));
        let far = of(&["impact_dissipation"], &[1.002; 6], 260.0);
        assert!(!is_near_other_impacts(&data, &as_well, &[&as_well, &far]));
    }

    #[test]
    fn analytic_windows_followed_with_a_joint_opened_are_not_missed() {
        let window = |opened: bool| Window {
            test: 0,
            purpose: Purpose::HoldOut,
            samples: 0..40,
            readings: 80,
            freedom: if opened { Freedom::Both } else { Freedom::Monolithic },
            opened,
            measured: Vec::new(),
            spread: Vec::new(),
        };
        let before = [false, false, true, false].map(window);
        let after = [true, false, true, true].map(window);
        // The first is followed once it is opened, the last was not missed, the third was open before.
        assert_eq!(stay_missed(&[0, 1, 2], &before, &after), 2);
        assert_eq!(stay_missed(&[0, 1, 2], &before, &before), 3);
    }

    #[test]
    fn analytic_impacts_that_fade_by_less_than_those_of_springs_are_no_effect() {
        let hypothesis = starter_with(&["impact_fading"]);
        let last = hypothesis.unknowns.len() - 1;
        // Of what the fastest keep a share is lost.
        let fading = |share: f64| -(1.0 - share).ln() / FADES * hypothesis.unknowns[last].scale;
        let faded = |share: f64| {
            let mut values = vec![0.0; last + 1];
            values[last] = fading(share);
            let covariance = Some(DMatrix::zeros(last + 1, last + 1));
            let fit = Fit { values, windows: Vec::new(), cost: 0.0, covariance };
            let hypothesis = hypothesis.clone();
            keeps_as_another_formulation(&FittedHypothesis { hypothesis, held_out: fit.clone(), fit })
        };
        assert!(faded(0.005));
        assert!(!faded(0.05));
    }
}
