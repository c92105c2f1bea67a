//! The seven steps of a diagnosis.

use rayon::prelude::*;

use super::candidates::candidates;
use super::experiment::Experiment;
use super::fit::Problem;
use super::force::{acts_at_top, force_points};
use super::hypothesis::{Addition, Hypothesis, Nuisance};
use super::imitate::{Imitation, imitations};
use super::other_law::OtherLaw;
use super::read_again::{gain_misread, reads_better, set_gain};
use super::search::{
    Data, Tried, finish, promise, refit, shared_states, try_coarsely, try_hypothesis, try_second, untouched,
};
use super::verdict::{
    EQUIVALENT, HELD_OUT, Verdict, WORTH_A_NAME, against, closes, could_show, does_something, is_noise, joint_error,
    kinds, moved_unknown, name_of_number, names, worth_two,
};
use super::windows::{Window, is_readable, windows};
use crate::error::{InputError, Result};
use crate::input::experiment::Purpose;

/// Single effects whose pairs with all others are looked at, and pairs that are fitted: where no single effect is the
/// answer, and where one is but may not be alone.
const WITHOUT_A_NAME: [usize; 2] = [2, 14];
const BESIDE_A_NAME: [usize; 2] = [1, 4];
/// Pairs that are fitted because they may stand for the best. Chosen: a pair that was the truth once came eighth.
const IMITATIONS: usize = 8;
/// Gain of the best single addition below which pairs are not tried.
const WORTH_PAIRS: f64 = 60.0;
/// Share of what speaks against the wall that a place must take away to be told.
const PLACE_SHARE: f64 = 0.3;
/// Coarse fits that are always finished, and at most; between them those this near the best, in natural logarithms of
/// likelihood.
const FINISHED: [usize; 2] = [6, 12];
const NEAR_BEST: f64 = 100.0;
/// Rivals fitted once more from other starts.
const POLISHED: usize = 3;
/// Gain above which that is worth its time.
const WORTH_POLISH: f64 = 10.0;
/// Best rivals whose states the wall without effects tries too.
const SHARING: usize = 8;
/// How well a number of the wall is known once it is measured, where an effect is asked for instead of it.
const KNOWN: f64 = 0.02;
/// Times that patterns are read again without a sensor's gain.
const READ_AGAIN: usize = 3;
/// Windows in motion below which no effect could be told.
const LEAST_MOVING: usize = 6;

/// Told how far a diagnosis is.
pub trait Progress: Sync {
    /// A step begins, of so many hypotheses.
    fn step(&self, what: &str, hypotheses: usize);
    /// One of them is fitted.
    fn fitted(&self);
}

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
    let (mut windows, mut alone) = alone(experiment, progress)?;
    for _ in 0..READ_AGAIN {
        let Some(gain) = alone.singles.first().and_then(|best| gain_misread(&experiment.tests, best)) else {
            break;
        };
        let before = set_gain(&mut experiment.tests, gain);
        let (new_windows, new) = self::alone(experiment, progress)?;
        if !reads_better(&alone.singles, &new.singles) {
            set_gain(&mut experiment.tests, before);
            break;
        }
        (windows, alone) = (new_windows, new);
    }
    let search = Search { experiment, data: data(experiment, &windows), progress };
    let found = search.judge(alone);
    let Found { verdict, before, recalibrated, after, equivalent, place, other_law, tried } = found;
    Ok(Diagnosis { verdict, before, recalibrated, after, equivalent, place, other_law, tried, windows })
}

/// Windows of the tests, and what effects do to them one by one.
fn alone(experiment: &Experiment, progress: &impl Progress) -> Result<([Vec<Window>; 2], Alone)> {
    let (fit, held_out) = windows(&experiment.tests).into_iter().partition(|w| w.purpose == Purpose::Fit);
    let windows: [Vec<Window>; 2] = [fit, held_out];
    let no_window = || {
        let allowed = "some stretches of a tenth of a second at rest or in one pattern, without gaps";
        InputError::file(&experiment.path, "no window that starts in a pattern beyond doubt", allowed)
    };
    if !experiment.tests.iter().any(|test| test.purpose == Purpose::Fit && is_readable(test)) {
        return Err(no_window().into());
    }
    let search = Search { experiment, data: data(experiment, &windows), progress };
    let alone = search.alone().ok_or_else(no_window)?;
    Ok((windows, alone))
}

/// The wall as given, its numbers fitted, and single effects, best first; none of these where too little moves.
struct Alone {
    before: Tried,
    recalibrated: Tried,
    singles: Vec<Tried>,
}

struct Search<'a, P> {
    experiment: &'a Experiment,
    data: Data<'a>,
    progress: &'a P,
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

impl<P: Progress> Search<'_, P> {
    fn hypothesis(&self, nuisances: &[Nuisance], additions: &[Addition]) -> Hypothesis {
        Hypothesis::new(self.experiment.wall.parameters(), &self.experiment.scales, nuisances, additions)
    }

    fn alone(&self) -> Option<Alone> {
        let nuisances = &self.experiment.nuisances;
        self.progress.step("the wall as given", 2);
        let before = untouched(&self.data, self.hypothesis(&[], &[]))?;
        self.progress.fitted();
        if self.data.fit.windows.len() < LEAST_MOVING {
            let recalibrated = before.clone();
            return Some(Alone { before, recalibrated, singles: Vec::new() });
        }
        let recalibrated = try_hypothesis(&self.data, self.hypothesis(nuisances, &[]), &before)?;
        self.progress.fitted();
        let additions = candidates(self.experiment.wall.parameters());
        let sets = additions.iter().map(|a| vec![*a]).collect::<Vec<_>>();
        let singles = self.try_all("single effects", nuisances, &self.starts(&before, &recalibrated), &sets);
        let singles = self.polished(nuisances, &before, singles, &recalibrated);
        let recalibrated = self.better_part(recalibrated, singles.first());
        let best = singles.iter().take(SHARING).collect::<Vec<_>>();
        let [before, recalibrated] =
            [before, recalibrated].map(|tried| shared_states(&self.data, &tried, &best));
        Some(Alone { before, recalibrated, singles })
    }

    /// Where single effects start: from the wall as given, and where one of its numbers was not known, with that fitted.
    fn starts<'t>(&self, before: &'t Tried, recalibrated: &'t Tried) -> Vec<&'t Tried> {
        let wide = self.experiment.nuisances.iter().any(Nuisance::is_wide);
        if wide { vec![before, recalibrated] } else { vec![before] }
    }

    /// Fits every set of additions, and orders them by what speaks against them.
    fn try_all(
        &self,
        what: &str,
        nuisances: &[Nuisance],
        from: &[&Tried],
        sets: &[Vec<Addition>],
    ) -> Vec<Tried> {
        self.progress.step(what, sets.len());
        let try_one = |additions: &Vec<Addition>| {
            let tried = try_coarsely(&self.data, self.hypothesis(nuisances, additions), from);
            self.progress.fitted();
            tried
        };
        self.finished(self.ordered(sets.par_iter().filter_map(try_one).collect()))
    }

    /// Finishes the best of coarse fits in order; the others are so far behind that they cannot be the answer.
    fn finished(&self, mut coarse: Vec<Tried>) -> Vec<Tried> {
        let Some(best) = coarse.first() else { return coarse };
        let limit = against(&self.data, best) + NEAR_BEST;
        let near = coarse.iter().filter(|t| against(&self.data, t) < limit).count();
        let count = near.clamp(FINISHED[0], FINISHED[1]).min(coarse.len());
        self.progress.step("the best in full", count);
        let finish_one = |tried: &Tried| {
            let finished = finish(&self.data, tried);
            self.progress.fitted();
            finished
                .filter(|new| against(&self.data, new) < against(&self.data, tried))
                .unwrap_or_else(|| tried.clone())
        };
        let finished = coarse[..count].par_iter().map(finish_one).collect::<Vec<_>>();
        coarse.splice(..count, finished);
        self.ordered(coarse)
    }

    fn ordered(&self, mut tried: Vec<Tried>) -> Vec<Tried> {
        tried.sort_by(|a, b| against(&self.data, a).total_cmp(&against(&self.data, b)));
        tried
    }

    /// Fits the best few once more, from about what was found with the wall's own numbers back where they were; all as they
    /// are if the best gains little over a simpler hypothesis.
    fn polished(
        &self,
        nuisances: &[Nuisance],
        from: &Tried,
        mut tried: Vec<Tried>,
        simpler: &Tried,
    ) -> Vec<Tried> {
        let Some(best) = tried.first() else { return tried };
        if against(&self.data, simpler) - against(&self.data, best) < WORTH_POLISH {
            return tried;
        }
        let count = tried.len().min(POLISHED);
        self.progress.step("the best again", count);
        let again = |old: &Tried| {
            let h = self.hypothesis(nuisances, &old.hypothesis.additions);
            let about = |factor: f64| {
                let mut values = old.fit.values.clone();
                for (i, u) in h.unknowns.iter().enumerate() {
                    values[i] =
                        if i < h.nuisances { u.start } else { u.start + factor * (values[i] - u.start) };
                    values[i] = values[i].clamp(u.lower, u.upper);
                }
                values
            };
            let tries = [0.92, 1.0, 1.08].map(about);
            let fits = tries.par_iter().filter_map(|values| refit(&self.data, h.clone(), from, values));
            let best = fits.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
            self.progress.fitted();
            best.filter(|new| new.fit.cost < old.fit.cost).unwrap_or_else(|| old.clone())
        };
        let best = tried[..count].iter().map(again).collect::<Vec<_>>();
        tried.splice(..count, best);
        self.ordered(tried)
    }

    /// A hypothesis, or the same fitted from the values of one that holds more than it, where that is better: a number of
    /// the wall far from its prior is sometimes found beside a further effect only.
    fn better_part(&self, part: Tried, whole: Option<&Tried>) -> Tried {
        let additions = &part.hypothesis.additions;
        let holds = |w: &&Tried| additions.iter().all(|a| w.hypothesis.additions.contains(a));
        let Some(whole) = whole.filter(holds) else { return part };
        if against(&self.data, whole) > against(&self.data, &part) - WORTH_POLISH {
            return part;
        }
        let h = self.hypothesis(&self.experiment.nuisances, additions);
        let values = h.values_from(&whole.hypothesis, &whole.fit.values);
        let again = refit(&self.data, h, whole, &values);
        again.filter(|new| against(&self.data, new) < against(&self.data, &part)).unwrap_or(part)
    }

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
        let one = self.named(&singles, gap, &recalibrated);
        let mut tried = singles;
        let mut other_law = None;
        // What a window can say is bounded: of a gap far above the noise a single effect may take little of it, and two all.
        let far = joint_error(&recalibrated).is_some_and(|error| error > HELD_OUT);
        if one.is_some() || far || gain > WORTH_PAIRS {
            let single = best_answer(&tried).unwrap_or(&recalibrated).clone();
            let counts = if one.is_some() { BESIDE_A_NAME } else { WITHOUT_A_NAME };
            let pairs = self.pairs(&tried, &single, &before, gap, counts);
            let mut one = one;
            if pairs.first().is_some_and(|pair| !does_something(pair)) {
                tried = self.ordered(tried.into_iter().map(|t| self.better_part(t, pairs.first())).collect());
                one = self.named(&tried, gap, &recalibrated);
            }
            let single = best_answer(&tried).unwrap_or(&recalibrated).clone();
            let two = self.named(&pairs, gap, &single).filter(|(_, two, _)| worth_two(data, &single, two));
            tried.extend(pairs);
            if let Some((verdict, after, equivalent)) = two.or(one) {
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
        let place = measured().or_else(|| self.place(&recalibrated, &tried));
        let verdict = if place.is_some() { Verdict::PlaceOnly } else { Verdict::Unknown };
        Found { other_law, ..found(verdict, recalibrated.clone(), Vec::new(), place, tried) }
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

    /// Pairs of the best `paired` single effects with every other, of which `fitted` are fitted.
    fn pairs(
        &self,
        singles: &[Tried],
        single: &Tried,
        before: &Tried,
        gap: f64,
        [paired, fitted]: [usize; 2],
    ) -> Vec<Tried> {
        let answers = singles.iter().filter(|t| kinds(t).is_some()).collect::<Vec<_>>();
        let mut sets: Vec<Vec<Addition>> = Vec::new();
        let mut starts = Vec::new();
        for first in answers.iter().take(paired) {
            let one = first.hypothesis.additions[0];
            for second in &answers {
                let two = second.hypothesis.additions[0];
                let same_kind = one.kind() == two.kind();
                if !same_kind && !sets.iter().any(|set| set.contains(&one) && set.contains(&two)) {
                    sets.push(vec![one, two]);
                    starts.push(*first);
                }
            }
        }
        let pairs = self.promising(sets.into_iter().zip(starts).collect(), fitted);
        self.progress.step("pairs of effects", pairs.len());
        let try_one = |(h, first): &(Hypothesis, &Tried)| {
            let tried = try_second(&self.data, h.clone(), first, before);
            self.progress.fitted();
            tried
        };
        let tried = pairs.par_iter().filter_map(try_one).collect();
        let tried = self.finished(self.ordered(tried));
        let tried = self.polished(&self.experiment.nuisances, before, tried, single);
        self.with_imitations(tried, gap)
    }

    /// Pairs, and where the best closes the gap, those that may stand for it.
    fn with_imitations(&self, mut pairs: Vec<Tried>, gap: f64) -> Vec<Tried> {
        let Some(best) = pairs.first().filter(|t| closes(t, gap) && kinds(t).is_some()) else { return pairs };
        let nuisances = &self.experiment.nuisances;
        let candidates = candidates(self.experiment.wall.parameters());
        let effects = candidates.into_iter().filter(|a| a.kind().is_some()).collect::<Vec<_>>();
        let hypothesis = |additions: &[Addition]| self.hypothesis(nuisances, additions);
        let Some(imitations) = imitations(&self.data, best, &effects, hypothesis) else { return pairs };
        let tried_before = |i: &Imitation| {
            let has = |t: &&Tried| i.additions.iter().all(|a| t.hypothesis.additions.contains(a));
            pairs.iter().any(|t| has(&t))
        };
        let new = imitations.into_iter().filter(|i| !tried_before(i)).take(IMITATIONS).collect::<Vec<_>>();
        self.progress.step("pairs that may stand for the best", new.len());
        let fit = |imitation: &Imitation| {
            let h = self.hypothesis(nuisances, &imitation.additions);
            let mut values = h.start();
            values[h.nuisances..].copy_from_slice(&imitation.values);
            let tried = refit(&self.data, h, best, &values);
            self.progress.fitted();
            tried
        };
        let fitted = new.par_iter().filter_map(fit).collect::<Vec<_>>();
        pairs.extend(fitted);
        self.ordered(pairs)
    }

    /// The pairs that promise most at a glance, and those of which only a fit would tell.
    fn promising<'t>(
        &self,
        sets: Vec<(Vec<Addition>, &'t Tried)>,
        count: usize,
    ) -> Vec<(Hypothesis, &'t Tried)> {
        self.progress.step("a glance at pairs", sets.len());
        let look = |(set, first): (Vec<Addition>, &'t Tried)| {
            let h = self.hypothesis(&self.experiment.nuisances, &set);
            let cost = promise(&self.data, &h, first).unwrap_or(f64::NEG_INFINITY);
            self.progress.fitted();
            (cost, h, first)
        };
        let mut pairs = sets.into_par_iter().map(look).collect::<Vec<_>>();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        pairs.into_iter().take(count).map(|(_, h, first)| (h, first)).collect()
    }

    /// The place whose effects take away a good part of what speaks against the wall, if there is one.
    fn place(&self, recalibrated: &Tried, tried: &[Tried]) -> Option<&'static str> {
        let whole = against(&self.data, recalibrated);
        let best = tried.iter().find(|t| kinds(t).is_some())?;
        let share = (whole - against(&self.data, best)) / whole;
        (share > PLACE_SHARE).then(|| best.hypothesis.additions[0].place())
    }
}

/// The first of hypotheses in order that is an answer and does something.
fn best_answer<'t>(tried: impl IntoIterator<Item = &'t Tried>) -> Option<&'t Tried> {
    tried.into_iter().find(|t| kinds(t).is_some() && does_something(t))
}
