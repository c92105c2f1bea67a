//! Diagnosis: where model and measurement disagree, which effect would make them agree, and whether it does.
//!
//! In the order of the flow ([`diagnose`]):
//!
//! | module | idea |
//! | --- | --- |
//! | [`Experiment`], [`check_data`] | what was measured and known beforehand, and what laboratories get wrong in files |
//! | [`windows()`] | tests cut into short windows that start where the measured pattern is beyond doubt |
//! | [`hypothesis`] | the wall, with what is uncertain of it and what is added to it |
//! | [`fit`] | each window simulated from a fitted state, so that neither the past nor noisy derivatives enter; a hypothesis fitted to all windows together |
//! | [`trials`] | the catalogue tried, and judged on tests held out |
//! | [`verdict`] | nothing missing, the wall's own numbers, one effect or two by name, or a place |
//! | `ensemble` | walls that fit about as well |
//! | [`certainty`] | how well its numbers are known, what could not be told from it, which test would tell |
//! | [`force`] | the missing force, measured: no hypothesis enters |
//! | [`discovery`] | a law outside the catalogue, found in it and written as a [`formula`] |
//! | [`mod@crate::limits`] | every number that decides |
//! | [`answer`] | all of it worked out: what `diagnosis.json` and the tables hold |

pub mod answer;
pub mod certainty;
pub mod discovery;
mod ensemble;
pub mod experiment;
pub mod fit;
pub mod force;
pub mod formula;
pub mod hypothesis;
pub mod next_tests;
mod shared;
pub mod trials;
pub mod verdict;

use crate::Progress;
use crate::experiment::{TestData, Window, is_readable, windows};
use crate::experiment_file::Purpose;
use crate::limits::{BESIDE_BEDS_GAP, READ_AGAIN};
pub use answer::Diagnosis;
use answer::Findings;
pub use experiment::{Experiment, check_data, check_tests, windowed_errors};
use mrbd_files::error::{InputError, Result};
use mrbd_kernel::model::Pair;
use shared::{as_fitted, keeps_what_was_fitted, shared_windows};
use trials::{
    Data, FirstFits, FittedHypothesis, Trials, Unfinished, WallFits, gain_misread, has_gain, misses_windows,
    opened_as_given, opened_enough, opened_windows, reads_better, reads_far_better, set_gain, typical_error,
};
pub use verdict::Verdict;
use verdict::{Found, beside_beds, judge, judge_laws, judge_laws_beyond, leaves_noise, on_beds};

/// The windows that count, and the answer in them.
type Answered = ([Vec<Window>; 2], Found);

/// Diagnoses an experiment: the verdict, everything it rests on, and the updated wall.
///
/// # Errors
/// An input error if no window of a test to fit starts in a pattern beyond doubt.
pub fn diagnose(experiment: &Experiment, progress: &impl Progress) -> Result<Diagnosis> {
    let findings = findings(experiment, progress)?;
    progress.begin("how sure the answer is, and what else could be", 1);
    Diagnosis::new(&findings)
}

/// The hypotheses fitted, and the verdict; a sensor's gain that shows is kept with the tests, so that patterns are read
/// without it.
///
/// # Errors
/// As [`diagnose`].
pub fn findings<'e>(experiment: &'e Experiment, progress: &impl Progress) -> Result<Findings<'e>> {
    let mut flow =
        Flow { experiment, progress, tests: experiment.tests.clone(), unfinished: Unfinished::default() };
    let answered = flow.answered()?;
    let answered = flow.with_gain_beside(&answered).unwrap_or(answered);
    let answered = flow.with_windows_opened(&answered).unwrap_or(answered);
    let (windows, found) = flow.with_shared_windows(&answered).unwrap_or(answered);
    let found = found.or_unknown();
    let own = flow.trials(&windows).own_hypotheses(&found.before, &found.after);
    let freed = flow.with_exponents_free(&windows, &found);
    let unfinished = flow.unfinished.all();
    Ok(Findings { experiment, tests: flow.tests, windows, found, freed, own, unfinished })
}

/// An experiment, with its tests as they are read so far.
struct Flow<'e, P> {
    experiment: &'e Experiment,
    progress: &'e P,
    tests: Vec<TestData>,
    unfinished: Unfinished,
}

impl<P: Progress> Flow<'_, P> {
    /// The windows and the answer in them; a sensor's gain that shows is kept with the tests.
    fn answered(&mut self) -> Result<Answered> {
        let (mut windows, wall) = self.wall()?;
        if let Some(answer) = self.answered_on_beds(&windows, &wall)? {
            return Ok(answer);
        }
        let mut first_fits = self.trials(&windows).first_fits(wall);
        if let Some((before, _)) = first_fits.singles.first().and_then(|best| self.read_again(best)) {
            // No window to fit, or effects that follow no better: the reading before stands.
            let better = |anew: &FirstFits| reads_better(&first_fits.singles, &anew.singles);
            let anew = self.try_first_fits().ok().filter(|(_, fits)| better(fits));
            if anew.is_none() {
                set_gain(&mut self.tests, before);
            }
            (windows, first_fits) = anew.unwrap_or((windows, first_fits));
        }
        self.judged(windows, first_fits)
    }

    /// The windows with joints open that read as closed, where the best single effect asks for it, and the answer in them.
    fn judged(&self, windows: [Vec<Window>; 2], first_fits: FirstFits) -> Result<Answered> {
        let (mut windows, mut first_fits) = (windows, first_fits);
        if let Some(new_windows) = opened_windows(&Data::new(&self.tests, &windows), &first_fits) {
            first_fits = self.first_fits_in(&new_windows, Some(&first_fits.recalibrated.fit.values))?;
            windows = new_windows;
        }
        let found = judge(&self.trials(&windows), first_fits);
        Ok((windows, found))
    }

    /// The answer, and its windows, with patterns read without the gain of a sensor that stands beside another effect in the best pair,
    /// where nothing is told without that and the pair follows what is read so far better. `None` where it does not, nothing is told so
    /// either, or nothing with a gain in it: the reading before stands.
    fn with_gain_beside(&mut self, (_, found): &Answered) -> Option<Answered> {
        let best = found.tried.first().filter(|best| best.hypothesis.additions.len() > 1)?;
        let (before, pair) = if found.verdict.is_left_open() { self.read_again(best)? } else { return None };
        let try_anew = || self.try_first_fits().and_then(|(windows, fits)| self.judged(windows, fits)).ok();
        let anew = if reads_far_better(best, &pair) { try_anew() } else { None };
        let told = anew.filter(|(_, anew)| !anew.verdict.is_left_open() && has_gain(&anew.after));
        if told.is_none() {
            set_gain(&mut self.tests, before);
        }
        told
    }

    /// A law outside the catalogue, and its windows, where the best law that was tried all but closes the gap and follows windows with a
    /// joint open that reads as closed: no effect of the catalogue needs to have followed these. `None` where none holds so: the answer
    /// stands then.
    fn with_windows_opened(&self, (windows, found): &Answered) -> Option<Answered> {
        let law = found.nearest_of_laws_refused()?;
        let opened = opened_enough(&Data::new(&self.tests, windows), law)?;
        let first_fits = self.first_fits_in(&opened, Some(&found.recalibrated.fit.values)).ok()?;
        let told = judge_laws(&self.trials(&opened), first_fits)?;
        Some((opened, told))
    }

    /// A law outside the catalogue, and its windows, where tests held out show what those fitted do not: every other window of them is
    /// fitted too. `None` where nothing asks for it, and where no wall without effects can be fitted so or no law holds: the answer
    /// stands then.
    fn with_shared_windows(&mut self, (windows, found): &Answered) -> Option<Answered> {
        let shared = shared_windows(windows, found)?;
        // Points of tests of which windows are fitted are looked at too.
        let looked_at = as_fitted(&self.tests);
        let given = std::mem::replace(&mut self.tests, looked_at);
        let first_fits = self.first_fits_in(&shared, Some(&found.recalibrated.fit.values)).ok();
        let told =
            first_fits.and_then(|first_fits| judge_laws_beyond(&self.trials(&shared), first_fits, found));
        self.tests = given;
        told.filter(|told| keeps_what_was_fitted(found, told, windows)).map(|told| (shared, told))
    }

    /// The answer with round exponents free where it has such: each law that is told, or each effect that is named.
    fn with_exponents_free(
        &self,
        windows: &[Vec<Window>; 2],
        found: &Found,
    ) -> Vec<Option<FittedHypothesis>> {
        let trials = self.trials(windows);
        let (laws, named) = (found.told_laws(), &found.after);
        let is_named = matches!(found.verdict, Verdict::Named | Verdict::Class);
        let effects = if is_named { named.hypothesis.additions.len() } else { 0 };
        self.progress.begin("the answer with its exponents free", laws.len() + effects);
        let laws = laws.into_iter().map(|law| trials.with_exponents_free(law));
        let all = laws.chain((0..effects).map(|index| trials.with_exponent_of_name_free(named, index)));
        all.inspect(|_| self.progress.advance(1)).collect()
    }

    /// The windows and the answer where joints that give are it, or part of it.
    ///
    /// No joint is shut on a bed. Windows that the best bed follows once both bodies are free at their start are fitted so, and once
    /// more under the best with an effect beside it.
    fn answered_on_beds(&self, windows: &[Vec<Window>; 2], wall: &WallFits) -> Result<Option<Answered>> {
        let mut windows = windows.clone();
        let mut wall = wall.clone();
        let mut beds = self.trials(&windows).beds(&wall);
        if let Some(free) = beds.first().and_then(|bed| self.with_free_bodies(&windows, bed)) {
            (wall, windows) = (self.wall_in(&free, None)?, free);
            beds = self.trials(&windows).fitted_again(&beds);
        }
        let mut pairs = beside_beds(&self.trials(&windows), &wall, &beds);
        if let Some(free) = pairs.first().and_then(|both| self.with_free_bodies(&windows, both)) {
            (wall, windows) = (self.wall_in(&free, None)?, free);
            let trials = self.trials(&windows);
            (beds, pairs) = (trials.fitted_again(&beds), trials.fitted_again(&pairs));
        }
        let found = on_beds(&self.trials(&windows), &wall, beds, pairs);
        Ok(found.map(|found| (windows, found)))
    }

    /// Reads the tests without the gain of a sensor, where the best effect is one or has one beside it, and again without what is left
    /// of it once it is fitted to the windows that this makes; the gain that they were read with before and the effect in the last of
    /// these, where they are read anew. A gain that leaves no window to fit is none of a sensor: another effect looks like it.
    fn read_again(&mut self, best: &FittedHypothesis) -> Option<(Pair, FittedHypothesis)> {
        let mut best = best.clone();
        let mut before = None;
        for _ in 0..READ_AGAIN {
            let Some(gain) = gain_misread(&self.tests, &best) else { break };
            let last = set_gain(&mut self.tests, gain);
            let Ok((windows, wall)) = self.wall() else {
                set_gain(&mut self.tests, last);
                break;
            };
            before = before.or(Some(last));
            let alone = [best.hypothesis.additions.clone()];
            let starts = [&wall.before, &wall.recalibrated];
            let nuisances = &self.experiment.nuisances;
            let fitted = self.trials(&windows).try_all("the gain of a sensor", nuisances, &starts, &alone);
            let Some(next) = fitted.into_iter().next() else { break };
            best = next;
        }
        before.map(|before| (before, best))
    }

    /// The windows with both bodies free where a wall on beds follows them so, if it nearly follows the tests and these are enough. What
    /// follows all windows together to the noise may still miss some that begin with a joint shut.
    fn with_free_bodies(
        &self,
        windows: &[Vec<Window>; 2],
        on_beds: &FittedHypothesis,
    ) -> Option<[Vec<Window>; 2]> {
        let follows = leaves_noise(on_beds) && !misses_windows(on_beds);
        let nearly = typical_error(on_beds) < BESIDE_BEDS_GAP && !follows;
        nearly.then(|| opened_enough(&Data::new(&self.tests, windows), on_beds)).flatten()
    }

    /// Windows of the tests, and the wall without effects in them.
    fn wall(&self) -> Result<([Vec<Window>; 2], WallFits)> {
        let (fit, held_out) = windows(&self.tests).into_iter().partition(|w| w.purpose == Purpose::Fit);
        let windows: [Vec<Window>; 2] = [fit, held_out];
        let opened = opened_as_given(self.experiment, &Data::new(&self.tests, &windows));
        let windows = opened.unwrap_or(windows);
        let wall = self.wall_in(&windows, None)?;
        Ok((windows, wall))
    }

    /// Windows of the tests, and what effects do to them one by one.
    fn try_first_fits(&self) -> Result<([Vec<Window>; 2], FirstFits)> {
        let (windows, wall) = self.wall()?;
        let first_fits = self.trials(&windows).first_fits(wall);
        Ok((windows, first_fits))
    }

    /// What effects do to windows one by one, where values of the wall's uncertain numbers may be known from other windows.
    fn first_fits_in(&self, windows: &[Vec<Window>; 2], known: Option<&[f64]>) -> Result<FirstFits> {
        let wall = self.wall_in(windows, known)?;
        Ok(self.trials(windows).first_fits(wall))
    }

    fn wall_in(&self, windows: &[Vec<Window>; 2], known: Option<&[f64]>) -> Result<WallFits> {
        let no_window = || {
            let allowed = "some stretches of a tenth of a second at rest or in one pattern, without gaps";
            let found = "no window that starts in a pattern beyond doubt";
            InputError::file(&self.experiment.path, found, allowed)
        };
        if !self.tests.iter().any(|test| test.purpose == Purpose::Fit && is_readable(test)) {
            return Err(no_window().into());
        }
        Ok(self.trials(windows).wall_fits(known).ok_or_else(no_window)?)
    }

    /// Where hypotheses are tried.
    fn trials<'a>(&'a self, windows: &'a [Vec<Window>; 2]) -> Trials<'a, P> {
        let Self { experiment, progress, tests, unfinished } = self;
        Trials::new(experiment, Data::new(tests, windows), *progress, unfinished)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::WORTH_OPENING;
    use discovery::twin::{DRAG, DRAG_N, Twin, drag, wall_with};
    use formula::Shape;
    use hypothesis::{Addition, candidates};
    use trials::{closes_held_out, refit, with_values};

    #[test]
    fn analytic_a_gain_that_leaves_no_window_to_fit_is_none_of_a_sensor() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let experiment = twin.experiment();
        let (tests, unfinished) = (experiment.tests.clone(), Unfinished::default());
        let mut flow = Flow { experiment, progress: &(), tests, unfinished };
        let (windows, wall) = flow.wall().expect("windows");
        let first_fits = |gain: f64| {
            let trials = flow.trials(&windows);
            let named = |a: &Addition| a.name() == "sensor_gain.both";
            let addition = candidates(experiment.wall.parameters()).into_iter().find(named);
            let h = trials.hypothesis(&[], &[addition.expect("of the catalogue")]);
            let best = with_values(&trials.data, h, &wall.before, &[gain]).expect("a wall");
            FirstFits {
                before: wall.before.clone(),
                recalibrated: wall.recalibrated.clone(),
                singles: vec![best],
            }
        };
        // Noise a hundred times as large, once it is taken out, hides every pattern.
        let [hides_all, small] = [0.01, 1.02].map(first_fits);
        assert!(flow.read_again(&hides_all.singles[0]).is_none());
        assert!(flow.tests.iter().all(|test| test.read_gain == [1.0; 2]), "as they were read");
        let anew = flow.read_again(&small.singles[0]).map(|(before, _)| before);
        assert_eq!(anew, Some([1.0; 2]), "read anew");
    }

    #[test]
    fn analytic_patterns_are_read_without_a_gain_that_stands_beside_another_effect() {
        let gain = "[[effects]]\nkind = \"sensor_gain\"\nbody = \"upper\"\ngain = 0.93\n";
        let twin = Twin::new(&wall_with(gain), 1e-5);
        let experiment = twin.experiment();
        let (tests, unfinished) = (experiment.tests.clone(), Unfinished::default());
        let mut flow = Flow { experiment, progress: &(), tests, unfinished };
        let (windows, wall) = flow.wall().expect("windows");
        let named = |name: &str| {
            let mut all = candidates(experiment.wall.parameters()).into_iter();
            all.find(|a| a.name() == name).expect("of the catalogue")
        };
        let pair = vec![named("cubic_stiffness"), named("sensor_gain.upper")];
        let tried = flow.trials(&windows).try_all("a pair", &experiment.nuisances, &[&wall.before], &[pair]);
        // A closed crack that reads as open: windows start in patterns the wall was not in, and no gain follows them.
        assert!(tried[0].fit_error() > 2.0, "{:?}", tried[0].errors());
        let found = |verdict: Verdict| Found {
            tried: tried.clone(),
            ..Found::in_vain(verdict, &wall.before, tried[0].clone())
        };
        assert!(flow.with_gain_beside(&(windows.clone(), found(Verdict::Named))).is_none());
        let (_, told) = flow.with_gain_beside(&(windows, found(Verdict::PlaceOnly))).expect("a gain");
        assert_eq!(
            (told.verdict, verdict::names(&told.after)),
            (Verdict::Named, vec!["sensor_gain".to_owned()])
        );
        let gain = told.after.hypothesis.physics(&told.after.fit.values).expect("a wall").wall.reading().gain;
        assert!(gain[0] == 1.0 && (gain[1] - 0.93).abs() < 1e-3, "{gain:?}");
    }

    #[test]
    fn analytic_windows_are_opened_for_a_law_where_nothing_is_told() {
        let twin = Twin::new(&wall_with(DRAG), 3e-4);
        let (experiment, trials) = (twin.experiment(), twin.trials());
        let WallFits { before, recalibrated } = trials.wall_fits(None).expect("windows");
        let (h, values) = trials.law_beside(&recalibrated, &drag(2.0, DRAG_N));
        let right = refit(&trials.data, h, &recalibrated, &values).expect("a fit");
        // Though it is the right one.
        assert!(!closes_held_out(&right), "{:?}", right.errors());
        let found = |verdict: Verdict| Found {
            recalibrated: recalibrated.clone(),
            ..Found::in_vain(verdict, &before, right.clone())
        };
        let (tests, unfinished) = (experiment.tests.clone(), Unfinished::default());
        let flow = Flow { experiment, progress: &(), tests, unfinished };
        let windows = twin.windows().clone();
        let (opened, told) =
            flow.with_windows_opened(&(windows.clone(), found(Verdict::PlaceOnly))).expect("a law");
        let count = opened.iter().flatten().filter(|window| window.opened).count();
        assert!(told.verdict == Verdict::Formula && count >= WORTH_OPENING, "{:?}, {count}", told.verdict);
        let law = told.after.hypothesis.laws(&told.after.fit.values)[0].first;
        assert!(law.shape == Shape::Drag && (law.numbers[0] - 2.0).abs() < 0.1, "{law:?}");
        assert!(closes_held_out(&told.after), "{:?}", told.after.errors());
        assert!(flow.with_windows_opened(&(windows, found(Verdict::Named))).is_none());
    }
}
