//! A law of two atoms beside each of them alone: by itself an atom may have come to another valley than beside a second, or to no end.

use super::asked::{AskedOfLaws, OpenGap};
use super::equals::law_of;
use super::fitted::Fitted;
use super::refused::{Guard, Refused};
use super::search::Searched;
use crate::Progress;
use crate::diagnose::formula::{Atom, Law};
use crate::diagnose::trials::{FittedHypothesis, Trials, refit};
use rayon::prelude::*;

impl<P: Progress> Trials<'_, P> {
    /// Of laws of two atoms that hold, the best first, those that are worth it beside an atom of the best alone, if that holds; that atom
    /// where none is. The others are refused.
    pub(super) fn or_an_atom_alone(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        of_two: Vec<Fitted>,
        asked: &impl AskedOfLaws,
    ) -> (Vec<Fitted>, Vec<Refused>) {
        let mut alone = of_two.first().map_or(Vec::new(), |two| self.atoms_alone(two.judged()));
        let (alone, _) = self.closing(gap, searched, &mut alone, None, asked);
        let Some(one) = alone.into_iter().next() else { return (of_two, Vec::new()) };
        let is_worth_two = |two: &Fitted| asked.is_worth_two(one.judged(), two.judged());
        let (mut held, others): (Vec<_>, Vec<_>) = of_two.into_iter().partition(is_worth_two);
        if held.is_empty() {
            held.push(one);
        }
        let refused = others.iter().map(|two| Refused::in_windows(&two.law, vec![Guard::SecondAtom]));
        (held, refused.collect())
    }

    /// The atoms of a law of two, each alone and fitted from where both are, the best first; without what ends before it is done.
    pub(super) fn atoms_alone(&self, both: &FittedHypothesis) -> Vec<Fitted> {
        let fit = |atom: Atom| {
            let law = Law::of(atom);
            let (h, values) = self.law_beside(both, &law);
            let found = self.within_budget(&law.name(), values.len(), |data| refit(data, h, both, &values));
            found.map(Fitted::new)
        };
        let atoms = law_of(both).into_iter().flat_map(|law| law.atoms()).collect::<Vec<_>>();
        self.in_order(atoms.into_par_iter().filter_map(fit).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::asked::Scope;
    use super::super::points::Points;
    use super::super::search::search;
    use super::super::twin::{AskedOfGain, DRAG, SPRING, Twin, drag_and_spring, open_gap, wall_with};
    use super::*;
    use crate::limits::WORTH_A_NAME;

    /// How many atoms are left of a drag with a spring on one side, on a wall with effects, and what refused other laws.
    fn atoms_left(effects: &str) -> (usize, Vec<Guard>) {
        let twin = Twin::new(&wall_with(effects), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let without = trials.hypothesis(&trials.experiment.nuisances, &[]);
        let points = Points::new(trials.data.fit.tests, &without).expect("points");
        let (h, values) = trials.law_beside(&wall.recalibrated, &drag_and_spring(&points));
        let two = Fitted::new(refit(&trials.data, h, &wall.recalibrated, &values).expect("a fit"));
        let gap = open_gap(&wall, Scope::TwoAtoms);
        let searched = search(&points).expect("equations");
        let (held, refused) = trials.or_an_atom_alone(
            &gap,
            &searched,
            vec![two],
            &AskedOfGain { data: trials.data, least: WORTH_A_NAME },
        );
        let [one] = &held[..] else { panic!("{} laws are left", held.len()) };
        let atoms = law_of(&one.law).expect("a law").atoms().count();
        (atoms, refused.into_iter().flat_map(|refused| refused.guards).collect())
    }

    #[test]
    fn analytic_a_pair_beside_which_one_atom_does_as_well_gives_way_to_it() {
        assert_eq!(atoms_left(DRAG), (1, vec![Guard::SecondAtom]));
        assert_eq!(atoms_left(&[DRAG, SPRING].concat()), (2, Vec::new()));
    }
}
