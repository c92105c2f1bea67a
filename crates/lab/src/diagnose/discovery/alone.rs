//! A law of two atoms beside each of them alone: by itself an atom may have come to another valley than beside a second, or to no end.

use super::asked::{AskedOfLaws, OpenGap};
use super::equals::law_of;
use super::fitted::Fitted;
use super::refused::{Guard, Refused};
use super::search::Searched;
use crate::Progress;
use crate::diagnose::formula::{Atom, Law};
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::{FittedHypothesis, Trials, refit};
use rayon::prelude::*;

impl<P: Progress> Trials<'_, P> {
    /// Of laws of two atoms that hold, the best first, those that are worth it beside an atom of the best alone, that atom in the place of
    /// the others if it holds, and the others as refused.
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
    fn atoms_alone(&self, both: &FittedHypothesis) -> Vec<Fitted> {
        let fit = |atom: Atom| {
            let law = Law::of(atom);
            let h = self.hypothesis(&self.experiment.nuisances, &[Addition::Formula(law)]);
            let own = both.fit.values.iter().take(h.nuisances).copied();
            let values = own.chain(law.values()).collect::<Vec<_>>();
            let found = self.within_budget(&law.name(), values.len(), |data| refit(data, h, both, &values));
            found.map(Fitted::new)
        };
        let atoms = law_of(both).into_iter().flat_map(|law| law.atoms()).collect::<Vec<_>>();
        self.in_order(atoms.into_par_iter().filter_map(fit).collect())
    }
}
