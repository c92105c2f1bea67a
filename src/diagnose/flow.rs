//! The seven steps of a diagnosis.

use super::candidates::candidates;
use super::experiment::Experiment;
use super::fit::{Fit, Problem};
use super::force::{acts_at_top, force_points};
use super::hypothesis::{Addition, Hypothesis, Nuisance};
use super::other_law::OtherLaw;
use super::place::place;
use super::read_again::{gain_misread, opened, reads_better, set_gain};
use super::search::{Data, Tried, untouched};
use super::second::worth_two;
use super::trials::{Alone, Progress, Trials};
use super::verdict::{
    EQUIVALENT, HELD_OUT, Verdict, WORTH_A_NAME, against, closes, could_show, does_something, is_noise,
    joint_error, kinds, moved_unknown, name_of_number, names,
};
use super::windows::{Window, is_readable, windows};
use crate::error::{InputError, Result};
use crate::input::experiment::Purpose;

/// Single effects whose pairs with all others are looked at, and pairs that are fitted: where no single effect is the
/// answer, and where one is but may not be alone.
const WITHOUT_A_NAME: [usize; 2] = [2, 14];
const BESIDE_A_NAME: [usize; 2] = [1, 4];
/// Gain of the best single addition below which pairs are not tried.
const WORTH_PAIRS: f64 = 60.0;
/// How well a number of the wall is known once it is measured, where an effect is asked for instead of it.
const KNOWN: f64 = 0.02;
/// Windows that start with a joint open by less than the noise, for which everything is fitted again.
const WORTH_OPENING: usize = 2;
/// Times that patterns are read again without a sensor's gain.
const READ_AGAIN: usize = 3;

/// What a diagnosis found.
#[derive(Debug)]
pub struct Diagnosis {
    /// The answer.
    pub verdict: Verdict,
    /// Windows to fit and held out.
    pub windows: [Vec<Window>; 2],
    /// The wall as it was given.
    pub before: Tried,
    /// Its uncertain numbers fitted.
    pub recalibrated: Tried,
    /// The wall of the answer.
    pub after: Tried,
    /// What cannot be told from it.
    pub equivalent: Vec<String>,
    /// Where a force is missing, when no law is named.
    pub place: Option<&'static str>,
    /// What speaks for another law than the best of the catalogue, where that closes the gap.
    pub other_law: Option<OtherLaw>,
    /// Everything tried, best first.
    pub tried: Vec<Tried>,
}

impl Diagnosis {
    /// The windows as data of fits.
    pub fn data<'a>(&'a self, experiment: &'a Experiment) -> Data<'a> {
        data(experiment, &self.windows)
    }
}

fn data<'a>(experiment: &'a Experiment, windows: &'a [Vec<Window>; 2]) -> Data<'a> {
    let problem = |windows: &'a Vec<Window>| Problem { tests: &experiment.tests, windows };
    Data { fit: problem(&windows[0]), held_out: problem(&windows[1]) }
}

/// Diagnoses an experiment; a sensor's gain that shows is left in its tests, so that their patterns are read without it.
///
/// # Errors
/// An input error if no window of a test to fit starts in a pattern beyond doubt.
pub fn diagnose(experiment: &mut Experiment, progress: &impl Progress) -> Result<Diagnosis> {
    let (mut windows, mut alone) = try_alone(experiment, progress)?;
    for _ in 0..READ_AGAIN {
        let Some(gain) = alone.singles.first().and_then(|best| gain_misread(&experiment.tests, best)) else {
            break;
        };
        let before = set_gain(&mut experiment.tests, gain);
        let (new_windows, new) = try_alone(experiment, progress)?;
        if !reads_better(&alone.singles, &new.singles) {
            set_gain(&mut experiment.tests, before);
            break;
        }
        (windows, alone) = (new_windows, new);
    }
    if let Some(new_windows) = opened_windows(experiment, &windows, &alone) {
        alone = alone_in(experiment, &new_windows, Some(&alone.recalibrated.fit.values), progress)?;
        windows = new_windows;
    }
    let trials = Trials { experiment, data: data(experiment, &windows), progress };
    let found = trials.judge(alone);
    let Found { verdict, before, recalibrated, after, equivalent, place, other_law, tried } = found;
    Ok(Diagnosis { verdict, before, recalibrated, after, equivalent, place, other_law, tried, windows })
}

/// Windows of the tests, and what effects do to them one by one.
fn try_alone(experiment: &Experiment, progress: &impl Progress) -> Result<([Vec<Window>; 2], Alone)> {
    let (fit, held_out) = windows(&experiment.tests).into_iter().partition(|w| w.purpose == Purpose::Fit);
    let windows: [Vec<Window>; 2] = [fit, held_out];
    let windows = opened_as_given(experiment, &windows).unwrap_or(windows);
    let alone = alone_in(experiment, &windows, None, progress)?;
    Ok((windows, alone))
}

/// What effects do to windows one by one, where values of the wall's uncertain numbers may be known from other windows.
fn alone_in(
    experiment: &Experiment,
    windows: &[Vec<Window>; 2],
    known: Option<&[f64]>,
    progress: &impl Progress,
) -> Result<Alone> {
    let no_window = || {
        let allowed = "some stretches of a tenth of a second at rest or in one pattern, without gaps";
        InputError::file(&experiment.path, "no window that starts in a pattern beyond doubt", allowed)
    };
    if !experiment.tests.iter().any(|test| test.purpose == Purpose::Fit && is_readable(test)) {
        return Err(no_window().into());
    }
    let trials = Trials { experiment, data: data(experiment, windows), progress };
    Ok(trials.alone(known).ok_or_else(no_window)?)
}

/// The windows with joints open that read as closed, where the wall as given follows them so: a small gap does not show
/// beside windows that no wall follows.
fn opened_as_given(experiment: &Experiment, windows: &[Vec<Window>; 2]) -> Option<[Vec<Window>; 2]> {
    let wall = Hypothesis::new(experiment.wall.parameters(), &experiment.scales, &[], &[]);
    let as_given = untouched(&data(experiment, windows), wall)?;
    if as_given.fit.misses_many() {
        return None;
    }
    opened_under(experiment, windows, &as_given).map(|(windows, _)| windows)
}

/// The same for the best single effect, where it opens enough of them for everything to be fitted again.
fn opened_windows(
    experiment: &Experiment,
    windows: &[Vec<Window>; 2],
    alone: &Alone,
) -> Option<[Vec<Window>; 2]> {
    let (windows, count) = opened_under(experiment, windows, best_answer(&alone.singles)?)?;
    (count >= WORTH_OPENING).then_some(windows)
}

/// The windows with those that a hypothesis follows once their joints are open, and how many these are.
fn opened_under(
    experiment: &Experiment,
    [fit, held_out]: &[Vec<Window>; 2],
    tried: &Tried,
) -> Option<([Vec<Window>; 2], usize)> {
    let physics = tried.hypothesis.physics(&tried.fit.values)?;
    let of = |own: &Fit, windows: &[Window]| opened(&experiment.tests, &physics, &own.windows, windows);
    let found = [of(&tried.fit, fit), of(&tried.held_out, held_out)];
    let count = found.iter().map(|(_, count)| count).sum();
    Some((found.map(|(windows, _)| windows), count))
}

struct Found {
    verdict: Verdict,
    before: Tried,
    recalibrated: Tried,
    after: Tried,
    equivalent: Vec<String>,
    place: Option<&'static str>,
    other_law: Option<OtherLaw>,
    tried: Vec<Tried>,
}

impl Found {
    /// Too little moves for anything to show.
    fn no_power(before: Tried) -> Self {
        let (recalibrated, after) = (before.clone(), before.clone());
        Self {
            verdict: Verdict::NoPower,
            before,
            recalibrated,
            after,
            equivalent: Vec::new(),
            place: None,
            other_law: None,
            tried: Vec::new(),
        }
    }
}

impl<P: Progress> Trials<'_, P> {
    fn judge(&self, alone: Alone) -> Found {
        let data = &self.data;
        let Alone { before, recalibrated, singles } = alone;
        if singles.is_empty() {
            return Found::no_power(before);
        }
        let Some(gap) = joint_error(&before) else { return Found::no_power(before) };
        let found = |verdict, after: Tried, equivalent, place, tried| Found {
            verdict,
            before: before.clone(),
            recalibrated: recalibrated.clone(),
            after,
            equivalent,
            place,
            other_law: None,
            tried,
        };
        let gain = best_answer(&singles).map_or(0.0, |t| against(data, &recalibrated) - against(data, t));
        if gain < WORTH_A_NAME {
            if is_noise(&before) {
                let verdict = if could_show(&singles) { Verdict::None } else { Verdict::NoPower };
                return found(verdict, before.clone(), Vec::new(), None, singles);
            }
            if is_noise(&recalibrated) || closes(&recalibrated, gap) {
                return self.recalibrated(found, &before, &recalibrated, singles, gap);
            }
        }
        let singles = self.with_imitations(self.with_far_settled(singles), gap);
        let mut one = self.named(&singles, gap, &recalibrated);
        let mut tried = singles;
        let mut other_law = None;
        // What a window can say is bounded: of a gap far above the noise a single effect may take little of it, and two all.
        let far = joint_error(&recalibrated).is_some_and(|error| error > HELD_OUT);
        if one.is_some() || far || gain > WORTH_PAIRS {
            let single = best_answer(&tried).unwrap_or(&recalibrated).clone();
            let counts = if one.is_some() { BESIDE_A_NAME } else { WITHOUT_A_NAME };
            let pairs = self.pairs(&tried, &single, &before, gap, counts);
            // A pair of which one effect does nothing is the other alone, fitted better.
            if let Some(pair) = pairs.first().filter(|pair| !does_something(pair)) {
                tried = self.ordered(tried.into_iter().map(|t| self.better_part(t, pair)).collect());
                one = self.named(&tried, gap, &recalibrated);
            }
            let single = best_answer(&tried).unwrap_or(&recalibrated).clone();
            let two = self.named(&pairs, gap, &single).filter(|(_, two, _)| worth_two(data, &single, two));
            tried.extend(pairs);
            if let Some((verdict, after, equivalent)) = two.or(one) {
                let after = self.settled(after);
                let signs = OtherLaw::beside(data, &after);
                let speaks = signs.speaks();
                other_law = Some(signs);
                if !speaks {
                    let named = found(verdict, after, equivalent, None, self.ordered(tried));
                    return Found { other_law, ..named };
                }
            }
        }
        // What no law of the catalogue follows may still be measured; it tells a damper at the top from one at a joint that
        // follows as well.
        let measured = || {
            let physics = before.hypothesis.physics(&before.fit.values)?;
            acts_at_top(&force_points(&self.experiment.tests, &physics)).then_some("top")
        };
        let place = measured().or_else(|| place(data, &recalibrated, &tried));
        let verdict = if place.is_some() { Verdict::PlaceOnly } else { Verdict::Unknown };
        Found { other_law, ..found(verdict, recalibrated.clone(), Vec::new(), place, self.ordered(tried)) }
    }

    /// The best hypothesis that closes the gap, is an answer, and is worth its name beside a simpler one; with what cannot
    /// be told from it.
    fn named(&self, tried: &[Tried], gap: f64, simpler: &Tried) -> Option<(Verdict, Tried, Vec<String>)> {
        let closing = tried.iter().filter(|t| closes(t, gap)).collect::<Vec<_>>();
        let best = best_answer(closing.iter().copied())?;
        if against(&self.data, simpler) - against(&self.data, best) < WORTH_A_NAME {
            return None;
        }
        let own = kinds(best);
        let limit = against(&self.data, best) + EQUIVALENT;
        let as_good = closing.iter().filter(|t| against(&self.data, t) < limit && kinds(t) != own);
        let others =
            as_good.filter(|t| !t.hypothesis.additions.contains(&Addition::Placebo)).collect::<Vec<_>>();
        // A number of the wall that does clearly better than every effect: a symptom, no answer.
        let first = closing.first().filter(|t| kinds(t).is_none());
        if first.is_some_and(|t| against(&self.data, best) - against(&self.data, t) > EQUIVALENT) {
            return None;
        }
        let mut equivalent = Vec::new();
        if !others.is_empty() {
            for name in names(best).into_iter().chain(others.iter().flat_map(|t| names(t))) {
                if !equivalent.contains(&name) {
                    equivalent.push(name);
                }
            }
        }
        let verdict = if equivalent.is_empty() { Verdict::Named } else { Verdict::Class };
        Some((verdict, best.clone(), equivalent))
    }

    /// A gap that the wall's own numbers close: an answer, unless what moved had not been known and effects do as well.
    fn recalibrated(
        &self,
        found: impl Fn(Verdict, Tried, Vec<String>, Option<&'static str>, Vec<Tried>) -> Found,
        before: &Tried,
        recalibrated: &Tried,
        singles: Vec<Tried>,
        gap: f64,
    ) -> Found {
        let unknown = moved_unknown(&self.experiment.nuisances, recalibrated);
        if unknown.is_empty() {
            return found(Verdict::Recalibrated, recalibrated.clone(), Vec::new(), None, singles);
        }
        let known = |n: &Nuisance| match *n {
            Nuisance::Number(number, sd) => Nuisance::Number(number, sd.min(KNOWN)),
            Nuisance::Coefficient(l, sd) => Nuisance::Coefficient(l, sd.min(KNOWN)),
        };
        let nuisances = self.experiment.nuisances.iter().map(known).collect::<Vec<_>>();
        let sets = candidates(self.experiment.wall.parameters());
        // A second spring that hardly yields is the floor's own, by another name.
        let other_law = |a: &Addition| a.kind().is_some_and(|kind| kind != "yielding_spring");
        let sets = sets.into_iter().filter(other_law).map(|a| vec![a]).collect::<Vec<_>>();
        let instead = self.try_all("effects in place of what was not known", &nuisances, &[before], &sets);
        let limit = against(&self.data, recalibrated) + EQUIVALENT;
        let as_good = |(_, after, _): &(Verdict, Tried, Vec<String>)| against(&self.data, after) < limit;
        let Some((_, after, mut equivalent)) = self.named(&instead, gap, before).filter(as_good) else {
            return found(Verdict::Recalibrated, recalibrated.clone(), Vec::new(), None, singles);
        };
        if equivalent.is_empty() {
            equivalent = names(&after);
        }
        equivalent.extend(unknown.iter().map(|n| match n {
            Nuisance::Number(number, _) => name_of_number(number),
            Nuisance::Coefficient(..) => "impact_dissipation".to_owned(),
        }));
        equivalent.dedup();
        found(Verdict::Class, after, equivalent, None, instead)
    }
}

/// The first of hypotheses in order that is an answer and does something.
fn best_answer<'t>(tried: impl IntoIterator<Item = &'t Tried>) -> Option<&'t Tried> {
    tried.into_iter().find(|t| kinds(t).is_some() && does_something(t))
}
