//! What is left at impacts alone: the model's own error, no law that is missing.
//!
//! Another formulation of a contact moves as this one does between impacts, and parts from it for a moment at each: its corners give
//! a little, and an impact takes its time. Good sensors see that, so the right law misses windows with an impact. Between impacts a
//! law is followed to the noise or it is not the law. So where nothing follows all windows, those without an impact are asked
//! alone, by the same limits; what the others leave is told as a remainder.

use super::judge::{Answer, Found, Gap};
use super::worth_naming::worth_two;
use super::{OtherLaw, Remainder, Verdict};
use crate::Progress;
use crate::diagnose::fit::{Fit, Problem, WindowFit};
use crate::diagnose::trials::{
    Data, FittedHypothesis, Trials, WallFits, best_answer, closes, does_something, is_noise, joint_error,
    kinds,
};
use crate::experiment::Window;
use crate::limits::{HELD_OUT_ERROR, LEAST_SMOOTH, LEFT_AT_IMPACTS, WORTH_A_NAME};

impl<P: Progress> Gap<'_, P> {
    /// The verdict where windows without an impact are followed to their noise, and the others nearly; `None` where not.
    pub(super) fn but_for_impacts(&self, tried: &[FittedHypothesis]) -> Option<Found> {
        let answers = tried.iter().filter(|t| kinds(t).is_some() && does_something(t));
        let error = |t: &FittedHypothesis| joint_error(t).unwrap_or(f64::INFINITY);
        let nearest =
            answers.chain([&self.wall.recalibrated]).min_by(|a, b| error(a).total_cmp(&error(b)))?;
        if error(nearest) > HELD_OUT_ERROR {
            return None;
        }
        let smooth = Smooth::of(&self.trials.data, nearest)?;
        let windows = smooth.windows(&self.trials.data);
        let data = Data::new(self.trials.data.fit.tests, &windows);
        let trials = Trials { data, ..*self.trials };
        let [before, recalibrated] = [&self.wall.before, &self.wall.recalibrated].map(|t| smooth.part(t));
        let gap =
            Gap { trials: &trials, error: joint_error(&before)?, wall: WallFits { before, recalibrated } };
        let parts = trials.ordered(tried.iter().map(|t| smooth.part(t)).collect());
        match gap.named_alone_or_two(&parts) {
            Some(answer) => self.with_remainder(answer, tried),
            None => self.wall_but_for_impacts(&gap, &parts, tried),
        }
    }

    /// One effect or two by name.
    fn named_alone_or_two(&self, tried: &[FittedHypothesis]) -> Option<Answer> {
        let (singles, pairs): (Vec<_>, Vec<_>) =
            tried.iter().cloned().partition(|t| t.hypothesis.additions.len() == 1);
        let single = best_answer(&singles).unwrap_or(&self.wall.recalibrated);
        let two = self.named(&pairs, single);
        let two = two.filter(|two| worth_two(&self.trials.data, single, &two.after));
        two.or_else(|| self.named(&singles, &self.wall.recalibrated))
    }

    /// A name, in all windows: it must take away most of what the wall leaves there.
    fn with_remainder(&self, answer: Answer, tried: &[FittedHypothesis]) -> Option<Found> {
        let h = &answer.after.hypothesis;
        let is_it = |t: &&FittedHypothesis| {
            t.hypothesis.additions == h.additions && t.fit.values == answer.after.fit.values
        };
        let after = tried.iter().find(is_it)?.clone();
        let remainder = Remainder::new(&self.trials.data, &self.wall.recalibrated, &after, tried)?;
        let least = remainder.taken_fit.min(remainder.taken_held_out);
        let other_law = OtherLaw::beside(&self.trials.data, &after);
        if least < 1.0 - LEFT_AT_IMPACTS || other_law.speaks() {
            return None;
        }
        let found = self.copy().found(Answer { after, ..answer }, tried.to_vec());
        Some(Found { remainder: Some(remainder), other_law: Some(other_law), ..found })
    }

    /// The wall as given, or with its numbers fitted, where no effect is worth a name.
    fn wall_but_for_impacts(
        &self,
        smooth: &Self,
        parts: &[FittedHypothesis],
        tried: &[FittedHypothesis],
    ) -> Option<Found> {
        let gain = best_answer(parts).map_or(0.0, |best| smooth.gain(&smooth.wall.recalibrated, best));
        let whole = |t: &FittedHypothesis| joint_error(t).is_some_and(|error| error < HELD_OUT_ERROR);
        let (verdict, after) = if is_noise(&smooth.wall.before) && whole(&self.wall.before) {
            (Verdict::None, &self.wall.before)
        } else {
            (Verdict::Recalibrated, &self.wall.recalibrated)
        };
        let part = &smooth.wall.recalibrated;
        let follows = verdict == Verdict::None || is_noise(part) || closes(part, smooth.error);
        let answer = Answer { verdict, after: after.clone(), equivalent: Vec::new() };
        (gain < WORTH_A_NAME && follows && whole(after)).then(|| self.copy().found(answer, tried.to_vec()))
    }

    fn copy(&self) -> Self {
        let WallFits { before, recalibrated } = &self.wall;
        let wall = WallFits { before: before.clone(), recalibrated: recalibrated.clone() };
        Self { trials: self.trials, wall, error: self.error }
    }
}

/// Which windows to fit and held out hold no impact under a hypothesis.
struct Smooth([Vec<bool>; 2]);

impl Smooth {
    /// `None` where they are so few that they tell little.
    fn of(data: &Data, tried: &FittedHypothesis) -> Option<Self> {
        let (h, values) = (&tried.hypothesis, &tried.fit.values);
        let fit = data.fit.without_impacts(h, values, &tried.fit)?;
        let held_out = data.held_out.without_impacts(h, values, &tried.held_out)?;
        let few = |smooth: &Vec<bool>| smooth.iter().filter(|smooth| **smooth).count() < LEAST_SMOOTH;
        let both = [fit, held_out];
        (!both.iter().any(few)).then_some(Self(both))
    }

    fn windows(&self, data: &Data) -> [Vec<Window>; 2] {
        let of = |problem: Problem, smooth: &Vec<bool>| kept(problem.windows, smooth);
        [of(data.fit, &self.0[0]), of(data.held_out, &self.0[1])]
    }

    /// A hypothesis as it is in these windows.
    fn part(&self, tried: &FittedHypothesis) -> FittedHypothesis {
        let of = |fit: &Fit, smooth: &Vec<bool>| Fit {
            windows: kept::<WindowFit>(&fit.windows, smooth),
            ..fit.clone()
        };
        FittedHypothesis {
            hypothesis: tried.hypothesis.clone(),
            fit: of(&tried.fit, &self.0[0]),
            held_out: of(&tried.held_out, &self.0[1]),
        }
    }
}

/// Those of a list that are marked.
fn kept<T: Clone>(all: &[T], marked: &[bool]) -> Vec<T> {
    all.iter().zip(marked).filter(|(_, marked)| **marked).map(|(one, _)| one.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypothesis::example::starter_with;

    #[test]
    fn analytic_windows_without_an_impact_are_judged_alone() {
        let window = |reduced: f64| WindowFit { x: vec![0.0; 4], squares: 200.0 * reduced, freedom: 200.0 };
        let of = |all: &[f64]| Fit {
            values: vec![800.0],
            windows: all.iter().map(|r| window(*r)).collect(),
            cost: 0.0,
            covariance: None,
        };
        let tried = FittedHypothesis {
            hypothesis: starter_with(&["viscous_damping"]),
            fit: of(&[1.0, 9.0, 1.0]),
            held_out: of(&[9.0, 1.0]),
        };
        let part = Smooth([vec![true, false, true], vec![false, true]]).part(&tried);
        assert_eq!(part.errors(), [Some(1.0), Some(1.0)]);
        assert_eq!(part.fit.windows.len(), 2);
        assert!(is_noise(&part) && !is_noise(&tried));
    }
}
