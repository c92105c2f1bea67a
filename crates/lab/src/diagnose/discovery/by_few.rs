//! Laws chosen by few windows, where points are too noisy to choose among them.
//!
//! A missing force is a second derivative: at 3e-4 rad its points may say nothing where windows, whose states follow the motion itself,
//! say a thousand natural logarithms. Every shape then starts from what points give it, however little speaks for it, and is fitted
//! coarsely to few windows; the best go on to all of them, which alone judge.

use super::asked::OpenGap;
use super::by_windows::{Fitted, LOOK_STEPS, Start};
use super::equals::law_of;
use super::guards::{holds_in_each_test, lies_inside};
use super::search::Searched;
use crate::Progress;
use crate::diagnose::fit::nats;
use crate::diagnose::formula::{Atom, Law, Meaning};
use crate::diagnose::trials::{Data, Few, Trials, against};
use crate::limits::{LAWS_FITTED_BY_FEW, LAWS_IN_WINDOWS, SILENT_POINTS, WORTH_WINDOWS};
use rayon::prelude::*;

/// Where a number that points put at the end of its range starts, as a share of the range from there.
const OFF_THE_END: f64 = 0.1;
/// Exponent of velocity at which a law starts that points read as one of its sign alone.
const OFF_FRICTION: f64 = 1.0;

impl Searched<'_> {
    /// Whether points say so much less than windows that they cannot choose among laws.
    pub(super) fn is_silent_beside(&self, windows_nats: f64) -> bool {
        let best = self.singles.iter().chain(&self.pairs).map(|c| c.evidence).fold(WORTH_WINDOWS, f64::max);
        best < SILENT_POINTS * windows_nats
    }

    /// Laws of one atom of every shape, whatever points say for it.
    pub(super) fn of_every_shape(&self) -> Vec<Law> {
        let holds = |law: &Law| holds_in_each_test(&self.equations, law);
        self.singles
            .iter()
            .map(|c| c.law)
            .filter(holds)
            .flat_map(|law| [Some(inside(law)), freed(law)])
            .flatten()
            .collect()
    }

    /// Laws of two atoms: those of which points say most, and the best one of windows with every other shape at its place.
    pub(super) fn beside(&self, best: Option<&Law>) -> Vec<Law> {
        let of_points = self.pairs.iter().map(|c| c.law).take(LAWS_IN_WINDOWS);
        let with = |best: &Law| {
            let first = best.first;
            let others = self.singles.iter().map(|c| c.law.first);
            let others = others.filter(move |atom| atom.site == first.site && atom.shape != first.shape);
            others.take(LAWS_IN_WINDOWS).map(move |second| Law { first, second: Some(second) })
        };
        of_points.chain(best.into_iter().flat_map(with)).map(inside).collect()
    }
}

/// A law with numbers that a fit may move either way.
fn inside(law: Law) -> Law {
    law.map(|_, mut atom| {
        for i in atom.free() {
            let [least, most] = atom.bounds(i);
            let margin = OFF_THE_END * (most - least);
            atom.numbers[i] = atom.numbers[i].clamp(least + margin, most - margin);
        }
        atom
    })
}

/// The same of a power of displacement and velocity, where points read the sign of the velocity alone: as friction it has no exponent of
/// velocity that a fit could move.
fn freed(law: Law) -> Option<Law> {
    let is_sign = |atom: &Atom| atom.shape.powers(atom.numbers)[1].and_then(|power| power.number);
    let number = is_sign(&law.first).filter(|i| law.first.numbers[*i] == 0.0)?;
    debug_assert!(law.first.meaning(number) == Meaning::Exponent);
    let first = law.first;
    let mut numbers = first.numbers;
    numbers[number] = OFF_FRICTION;
    Some(inside(Law::of(Atom { numbers, ..first })))
}

impl<P: Progress> Trials<'_, P> {
    /// Laws from where points put them, fitted coarsely to few windows, in the order of what these say against them: the best.
    pub(super) fn starts_in_few(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        laws: &[Law],
        what: &str,
    ) -> Vec<Start> {
        let few = Few::of_coarse(self.data.fit, &gap.nearest.fit);
        let (nearest, data) = match &few {
            Some(few) => (few.of(gap.nearest), Data { fit: few.problem(), held_out: few.nothing() }),
            None => (gap.nearest.clone(), self.data),
        };
        self.progress.begin(&format!("{what}, in few windows"), laws.len());
        let start = |law: &Law| {
            let (hypothesis, values) = self.of_points(searched, law)?;
            let fit = self.within_budget_of(&data, &law.name(), values.len(), |data| {
                let begun = data.fit.states_to_begin(&hypothesis, &values, &nearest.states(), LOOK_STEPS)?;
                data.fit.fit_coarsely(&hypothesis, begun)
            });
            self.progress.advance(1);
            let fit = fit?;
            Some(Start {
                nats: nats(&fit.windows) + 0.5 * hypothesis.prior_penalty(&fit.values),
                hypothesis,
                values: fit.values,
            })
        };
        let mut starts = laws.par_iter().filter_map(start).collect::<Vec<_>>();
        starts.sort_by(|a, b| a.nats.total_cmp(&b.nats));
        starts.truncate(LAWS_FITTED_BY_FEW);
        starts
    }

    /// Whether windows say so much more than points that they choose among laws.
    pub(super) fn windows_choose(&self, gap: &OpenGap, searched: &Searched) -> bool {
        searched.is_silent_beside(against(&self.data, gap.recalibrated))
    }
}

/// The best law of those fitted to windows, in order, whose numbers mean something.
pub(super) fn best_law(fitted: &[Fitted]) -> Option<Law> {
    fitted.iter().filter(|fitted| fitted.is_done).filter_map(|fitted| law_of(&fitted.law)).find(lies_inside)
}
