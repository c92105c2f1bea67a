//! Laws found over points, fitted to windows with their impacts: these alone judge.

use super::asked::{AskedOfLaws, OpenGap, Scope};
use super::by_few::{best_law, powers_of};
use super::equals::{law_of, simplest_of_equals};
use super::fitted::Fitted;
use super::guards::{holds_in_each_test, lies_inside};
use super::kin::is_of_catalogue;
use super::left_open::{least_in_tests_fitted, may_move};
use super::refused::{Guard, Refused};
use super::search::{Candidate, Searched, search};
use super::stability::Stability;
use crate::Progress;
use crate::diagnose::formula::{Law, Site};
use crate::diagnose::trials::{FittedHypothesis, Trials, against, does_something, follows_to_noise};
use crate::limits::{
    EQUIVALENT, LAWS_IN_WINDOWS, LAWS_TOLD, WORTH_A_NAME, WORTH_A_SECOND_HELD_OUT, WORTH_A_SECOND_SEEN,
    WORTH_WINDOWS,
};

/// Laws outside the catalogue that were tried, and those that hold.
#[derive(Debug, Clone)]
pub struct Discovered {
    /// Laws that close the gap and that the tests cannot tell apart, the simplest first; none where no law holds.
    pub equals: Vec<FittedHypothesis>,
    /// The first of them with other numbers that the tests fitted leave open, where only with such it follows those held out.
    pub moved: Option<FittedHypothesis>,
    /// The best laws that were fitted to windows, in order.
    pub tried: Vec<FittedHypothesis>,
    /// Laws that were refused, and what refused them.
    pub refused: Vec<Refused>,
    /// A force without a formula, where no law holds and it does.
    pub curve: Option<FittedHypothesis>,
    /// How sure the form of these is, over points.
    pub stability: Option<Stability>,
    /// By site: least and largest displacement and velocity that were excited.
    pub excited: [[[f64; 2]; 2]; 3],
    /// Laws of one atom, as far as they were fitted to windows.
    pub(super) singles: Vec<Fitted>,
    /// Laws of two atoms, as far as they were fitted to windows.
    pub(super) pairs: Vec<Fitted>,
    /// What the best law of two atoms says more over points than the first that holds, in natural logarithms of likelihood.
    pub(super) second_says_more: Option<f64>,
    /// Whether windows chose among laws, of which points say next to nothing.
    pub(super) windows_chose: bool,
    /// Whether few windows ask for a second atom beside a law of one that leaves no more than noise.
    pub(super) second_shows: bool,
}

impl Discovered {
    /// Laws of one atom that were tried, none of which holds.
    #[cfg(test)]
    pub fn in_vain(tried: Vec<FittedHypothesis>) -> Self {
        Self {
            singles: tried.iter().cloned().map(Fitted::new).collect(),
            equals: Vec::new(),
            moved: None,
            tried,
            refused: Vec::new(),
            curve: None,
            stability: None,
            excited: [[[0.0; 2]; 2]; 3],
            pairs: Vec::new(),
            second_says_more: None,
            windows_chose: false,
            second_shows: false,
        }
    }

    /// What was excited at a site: least and largest displacement and velocity.
    pub fn at(&self, site: Site) -> [[f64; 2]; 2] {
        self.excited[site as usize]
    }

    /// Whether the first law that holds has one atom, and points, which weigh every two, say no more of any two.
    pub fn is_all_of_one_atom(&self) -> bool {
        let of_one = |law: &FittedHypothesis| law_of(law).is_some_and(|law| law.second.is_none());
        self.equals.first().is_some_and(of_one) && self.second_says_more.is_some_and(|more| more < EQUIVALENT)
    }

    /// Whether that means something: points that say next to nothing of a law say no more of two.
    pub fn is_all_of_one_atom_by_points(&self) -> bool {
        self.is_all_of_one_atom() && !self.windows_chose
    }

    /// Whether none of the laws that hold is made of powers of the catalogue alone.
    pub fn is_outside_catalogue(&self) -> bool {
        !self.equals.iter().filter_map(law_of).any(|law| is_of_catalogue(&law))
    }

    /// Whether few windows ask for a second atom beside the first law that holds, though it leaves no more than noise.
    pub fn asks_for_a_second(&self) -> bool {
        self.second_shows
    }

    /// Whether nothing holds.
    pub fn is_open(&self) -> bool {
        self.equals.is_empty()
    }
}

impl<P: Progress> Trials<'_, P> {
    /// Looks for a law outside the catalogue that closes a gap. `None` where points say nothing of one.
    pub fn discover(&self, gap: &OpenGap, asked: &impl AskedOfLaws) -> Option<Discovered> {
        let points = self.points(gap.nearest)?;
        let searched = search(&points)?;
        let windows_choose = self.windows_choose(gap, &searched);
        if searched.most_evidence() < WORTH_WINDOWS && gap.kin.is_empty() && !windows_choose {
            return None;
        }
        let refused_over_points = |laws: &[Candidate]| match windows_choose {
            true => Vec::new(),
            false => self.refused_over_points(&searched, laws),
        };
        let mut refused = refused_over_points(&searched.singles);
        let mut singles = self.singles_in_windows(gap, &searched);
        let judge = |fitted: &mut Vec<Fitted>, simpler: Option<&FittedHypothesis>| {
            let judged = self.closing(gap, &searched, fitted, simpler, asked);
            match judged.0.is_empty() && self.refine_best(gap, fitted) {
                true => self.closing(gap, &searched, fitted, simpler, asked),
                false => judged,
            }
        };
        let is_left = |closing: &[Fitted]| !closing.iter().any(|one| asked.leaves_nothing(one.judged()));
        let mut judged = judge(&mut singles, None);
        // What a law leaves over that closes the gap may be valleys that its fit has ended in.
        if !judged.0.is_empty() && is_left(&judged.0) && self.refine_closing(gap, &mut singles, &judged.0) {
            judged = judge(&mut singles, None);
        }
        let (mut closing, of_singles) = judged;
        refused.extend(of_singles);
        // A law may close the gap and miss windows for a second atom that shows in few of them.
        let is_left = is_left(&closing);
        let second_shows = !closing.is_empty() && !is_left && self.second_shows(gap, &closing);
        let is_open = is_left || second_shows;
        let mut tried = singles.iter().map(|fitted| fitted.law.clone()).collect::<Vec<_>>();
        let single = searched.singles.first().map_or(0.0, |c| c.evidence);
        let says_more = searched.pairs.first().is_some_and(|pair| pair.evidence > single);
        let mut pairs = Vec::new();
        if gap.scope >= Scope::TwoAtoms && is_open && (says_more || windows_choose || second_shows) {
            let simpler = tried.first().unwrap_or(gap.recalibrated).clone();
            pairs = self.pairs_in_windows(gap, &searched, &singles, says_more);
            let (of_two, of_pairs) = judge(&mut pairs, Some(&simpler));
            let (of_two, worth_less) = self.or_an_atom_alone(gap, &searched, of_two, asked);
            if of_two.is_empty() {
                let lacks = |one: &mut Fitted| self.lacks_an_atom(one.judged(), &pairs);
                let lacking = closing.extract_if(.., lacks);
                refused.extend(lacking.map(|one| Refused::in_windows(&one.law, vec![Guard::LacksAtom])));
            }
            let lacked = match closing.is_empty() && of_two.is_empty() {
                true => self.of_two_that_one_lacks(&simpler, &pairs, &of_pairs),
                false => None,
            };
            let is_lacked = |one: &Refused| lacked.as_ref().is_some_and(|two| one.is_of(&two.law));
            refused.extend(of_pairs.into_iter().filter(|one| !is_lacked(one)).chain(worth_less));
            closing.extend(of_two.into_iter().chain(lacked));
            refused.extend(refused_over_points(&searched.pairs));
            tried.extend(pairs.iter().map(|fitted| fitted.law.clone()));
        }
        let equals = simplest_of_equals(&self.data, &points, self.in_order(closing));
        let equals = self.with_exponents_that_show(gap, &searched, equals, asked);
        let moved = equals.first().and_then(|one| one.moved.clone());
        let equals = equals.into_iter().map(|one| one.law).collect::<Vec<_>>();
        let mut tried = self.ordered(tried);
        let has_curve = gap.scope == Scope::Curves && equals.is_empty();
        let curve = if has_curve { self.curve(gap, &searched, tried.first()) } else { None };
        tried.truncate(LAWS_TOLD);
        let laws = equals.iter().filter_map(law_of).collect::<Vec<_>>();
        let stability = Stability::of(&searched, &laws);
        let second_says_more = laws.first().and_then(|told| searched.second_says_more(told));
        Some(Discovered {
            equals,
            moved,
            tried,
            refused,
            curve,
            stability,
            excited: Site::ALL.map(|site| points.range(site)),
            singles,
            pairs,
            second_says_more,
            windows_chose: windows_choose,
            second_shows,
        })
    }

    /// Of laws fitted to windows those that nothing speaks against, and the others with what does.
    pub(super) fn closing(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        fitted: &mut [Fitted],
        simpler: Option<&FittedHypothesis>,
        asked: &impl AskedOfLaws,
    ) -> (Vec<Fitted>, Vec<Refused>) {
        let (mut closing, mut refused) = (Vec::new(), Vec::new());
        let least = least_in_tests_fitted(&self.data, fitted);
        for one in fitted {
            let as_fitted = Fitted { moved: None, ..one.clone() };
            let guards = self.guards(gap, searched, &as_fitted, simpler, asked);
            if guards.is_empty() {
                closing.push(as_fitted);
                continue;
            }
            if may_move(&guards) {
                self.move_in_what_is_open(one, least);
            }
            // Whether a second atom is worth it is told with the numbers as they were fitted.
            let holds = |one: &Fitted| self.guards(gap, searched, one, None, asked).is_empty();
            match may_move(&guards) && one.moved.is_some() && holds(one) {
                true => closing.push(one.clone()),
                false => {
                    one.moved = None;
                    refused.push(Refused::in_windows(&one.law, guards));
                }
            }
        }
        (closing, refused)
    }

    /// Whether a law of one atom that leaves more than noise lacks one: one of two, whose numbers mean something, says more in the tests
    /// fitted and in those held out, as clearly as a second effect that leaves noise must.
    fn lacks_an_atom(&self, one: &FittedHypothesis, pairs: &[Fitted]) -> bool {
        pairs.iter().any(|two| two.means_something() && self.says_more(one, &two.law))
    }

    fn says_more(&self, one: &FittedHypothesis, two: &FittedHypothesis) -> bool {
        let [fitted, held_out] = [0, 1].map(|i| one.against(&self.data)[i] - two.against(&self.data)[i]);
        held_out > WORTH_A_SECOND_HELD_OUT && fitted + held_out > WORTH_A_SECOND_SEEN
    }

    /// The law of two atoms that all of one lack, where none of these holds: nothing speaks against it but that its second atom gains less
    /// than one must beside a law that holds, and it says more than the best of one and than each of its atoms alone.
    pub(super) fn of_two_that_one_lacks(
        &self,
        best_of_one: &FittedHypothesis,
        pairs: &[Fitted],
        refused: &[Refused],
    ) -> Option<Fitted> {
        let by_second_atom = |two: &FittedHypothesis| {
            refused.iter().any(|one| one.guards == [Guard::SecondAtom] && one.is_of(two))
        };
        let may = |two: &&Fitted| by_second_atom(&two.law) && self.says_more(best_of_one, &two.law);
        let two = pairs.iter().find(may)?;
        let alone = self.atoms_alone(&two.law);
        let is_worth_it = !alone.is_empty() && alone.iter().all(|one| self.says_more(&one.law, &two.law));
        is_worth_it.then(|| two.clone())
    }

    /// Laws of one atom, fitted to windows: those that were fitted before, and kin.
    fn singles_in_windows(&self, gap: &OpenGap, searched: &Searched) -> Vec<Fitted> {
        const WHAT: &str = "laws of one atom";
        let Some(before) = gap.before else {
            let starts = match self.windows_choose(gap, searched) {
                true => {
                    let of_names = powers_of(gap.nearest, searched.equations.points());
                    let laws = [gap.kin, &of_names, &searched.singles_to_move()].concat();
                    self.starts_in_few(gap, searched, &laws, WHAT)
                }
                false => self.starts_by_look(gap, searched, gap.kin, &searched.singles, WHAT),
            };
            let singles = self.with_more_work(gap, self.laws_in_windows(gap, starts, WHAT));
            return self.with_other_place(gap, searched.equations.points(), singles);
        };
        let mut singles = self.with_states_since(gap, &before.singles);
        if !gap.kin.is_empty() {
            let starts = self.starts_by_look(gap, searched, gap.kin, &[], WHAT);
            singles.extend(self.laws_in_windows(gap, starts, WHAT));
        }
        self.in_order(singles)
    }

    /// Laws of two atoms, fitted to windows: those that were fitted before.
    fn pairs_in_windows(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        singles: &[Fitted],
        points_say_more: bool,
    ) -> Vec<Fitted> {
        const WHAT: &str = "laws of two atoms";
        if let Some(before @ [_, ..]) = gap.before.map(|before| &before.pairs[..]) {
            return self.in_order(self.with_states_since(gap, before));
        }
        let starts = match self.windows_choose(gap, searched) {
            true => {
                self.starts_in_few(gap, searched, &searched.pairs_to_move(best_law(singles).as_ref()), WHAT)
            }
            false if points_say_more => self.starts_by_look(gap, searched, &[], &searched.pairs, WHAT),
            false => Vec::new(),
        };
        let pairs = self.laws_in_windows(gap, starts, WHAT);
        self.in_order([pairs, self.seconds_in_windows(gap, singles)].concat())
    }

    /// What speaks against a law that was fitted to windows; nothing where it closes the gap with numbers that mean something.
    ///
    /// What is left over is asked only where nothing else speaks against it, or one thing alone and that not the windows fitted:
    /// a guard counts where no other refuses the law.
    pub(super) fn guards(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        one: &Fitted,
        simpler: Option<&FittedHypothesis>,
        asked: &impl AskedOfLaws,
    ) -> Vec<Guard> {
        let tried = one.judged();
        let gain = against(&self.data, gap.recalibrated) - against(&self.data, tried);
        let laws = tried.hypothesis.laws(&tried.fit.values);
        let all = |holds: &dyn Fn(&Law) -> bool| laws.iter().all(holds);
        let speaks = [
            (Guard::Work, !one.is_done),
            (Guard::Gap, !follows_to_noise(tried, gap.error)),
            (Guard::HeldOut, !asked.follows_held_out(tried)),
            (Guard::Size, !does_something(tried)),
            (Guard::Evidence, gain < WORTH_A_NAME),
            (Guard::InsideRange, !all(&lies_inside)),
            (Guard::LeftOutTests, !all(&|law| holds_in_each_test(&searched.equations, law))),
            (Guard::SecondAtom, simpler.is_some_and(|one| !asked.is_worth_two(one, tried))),
        ];
        let mut guards =
            speaks.into_iter().filter(|(_, speaks)| *speaks).map(|(guard, _)| guard).collect::<Vec<_>>();
        if guards.len() < 2 && !guards.contains(&Guard::Gap) {
            guards.extend(asked.other_law(tried));
        }
        guards
    }

    /// The best laws over points that are not tried in windows, and what refused them.
    fn refused_over_points(&self, searched: &Searched, laws: &[Candidate]) -> Vec<Refused> {
        let of_points = |c: &Candidate| {
            let speaks = [
                (Guard::InsideRange, !lies_inside(&c.law)),
                (Guard::LeftOutTests, !holds_in_each_test(&searched.equations, &c.law)),
            ];
            speaks.into_iter().filter(|(_, speaks)| *speaks).map(|(guard, _)| guard).collect::<Vec<_>>()
        };
        let is_worth = |c: &&Candidate| c.evidence > WORTH_WINDOWS;
        let judged = laws.iter().filter(is_worth).take(LAWS_IN_WINDOWS).map(|c| (c, of_points(c)));
        let best = searched.singles.first().map_or(0.0, |c| c.evidence).max(WORTH_WINDOWS);
        let of_one = laws.first().is_some_and(|c| c.law.second.is_none());
        let feeding = searched.feeding.iter().filter(|c| of_one && c.evidence > best);
        let all = judged.chain(feeding.map(|c| (c, vec![Guard::Passivity])));
        let refused = |(c, guards): (&Candidate, Vec<Guard>)| {
            let (hypothesis, values) = self.of_points(searched, &c.law)?;
            Some(Refused { hypothesis, values, guards, errors: None })
        };
        all.filter(|(_, guards)| !guards.is_empty()).filter_map(refused).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::asked::Scope;
    use super::super::points::Points;
    use super::super::twin::{AskedOfGain, DRAG, SPRING, Twin, drag_and_spring, open_gap, wall_with};
    use super::*;
    use crate::diagnose::hypothesis::Addition;
    use crate::diagnose::trials::refit;

    /// Whether a drag lacks an atom beside which a spring on one side stands, on a wall with effects, and whether both are told where it
    /// does not hold and this refuses both.
    fn drag_lacks_one(effects: &str, guards: &[Guard]) -> [bool; 2] {
        let twin = Twin::new(&wall_with(effects), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let points =
            Points::new(trials.data.fit.tests, &trials.hypothesis(&trials.experiment.nuisances, &[]));
        let both = drag_and_spring(&points.expect("points"));
        let fitted = |law: Law| {
            let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Formula(law)]);
            let own = wall.recalibrated.fit.values.iter().copied();
            let values = own.chain(law.values()).collect::<Vec<_>>();
            refit(&trials.data, h, &wall.recalibrated, &values).expect("a fit")
        };
        let (two, one) = (Fitted::new(fitted(both)), fitted(Law { second: None, ..both }));
        let refused = [Refused::in_windows(&two.law, guards.to_vec())];
        let pairs = [two];
        let told = trials.of_two_that_one_lacks(&one, &pairs, &refused);
        [trials.lacks_an_atom(&one, &pairs), told.is_some()]
    }

    /// Whether few windows ask for a second atom beside the law of one that is found, where what any law leaves counts as noise, and how
    /// many the law has that is found then.
    fn atoms_found(effects: &str) -> (bool, usize) {
        let twin = Twin::new(&wall_with(effects), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let asked = AskedOfGain { data: trials.data, least: WORTH_A_SECOND_SEEN };
        let of_one = trials.discover(&open_gap(&wall, Scope::OneAtom), &asked).expect("points");
        assert!(!of_one.is_open(), "{:?}", of_one.refused.iter().map(|one| &one.guards).collect::<Vec<_>>());
        let gap = OpenGap { before: Some(&of_one), ..open_gap(&wall, Scope::TwoAtoms) };
        let found = trials.discover(&gap, &asked).expect("points");
        (of_one.asks_for_a_second(), law_of(&found.equals[0]).expect("a law").atoms().count())
    }

    #[test]
    fn analytic_few_windows_may_ask_for_a_second_atom_beside_a_law_that_leaves_noise() {
        let weak = SPRING.replace("5e3", "3e3");
        assert!(weak != SPRING);
        assert_eq!(atoms_found(&[DRAG, &weak].concat()), (true, 2));
        assert_eq!(atoms_found(DRAG), (false, 1));
    }

    #[test]
    fn analytic_a_law_lacks_an_atom_where_one_of_two_says_more_in_tests_not_fitted_too() {
        let (both, by_gain) = ([DRAG, SPRING].concat(), [Guard::SecondAtom]);
        assert_eq!(drag_lacks_one(&both, &by_gain), [true; 2]);
        assert_eq!(drag_lacks_one(DRAG, &by_gain), [false; 2]);
        let more = [Guard::HeldOut, Guard::SecondAtom];
        assert_eq!(drag_lacks_one(&both, &more), [true, false], "more speaks against it than its gain");
    }
}
