//! What effects do to the windows one by one.

use super::search::{refit, shared_states, try_hypothesis};
use super::{Trials, Tried, against, untouched};
use crate::Progress;
use crate::diagnose::hypothesis::{Nuisance, candidates};
use crate::limits::{LEAST_MOVING, REFITTED_FROM, STATES_FOR_WALL, WORTH_POLISH};

/// The wall as given, its numbers fitted, and single effects, best first; none of these where too little moves.
pub struct Alone {
    /// The wall as it was given.
    pub before: Tried,
    /// Its uncertain numbers fitted.
    pub recalibrated: Tried,
    /// Single effects.
    pub singles: Vec<Tried>,
}

impl<P: Progress> Trials<'_, P> {
    /// Everything that is tried alone; `None` if there is no window to start in. The wall's uncertain numbers are fitted from
    /// values `known` from elsewhere too.
    pub fn alone(&self, known: Option<&[f64]>) -> Option<Alone> {
        let nuisances = &self.experiment.nuisances;
        self.progress.begin("the wall as given", 2);
        let before = untouched(&self.data, self.hypothesis(&[], &[]))?;
        self.progress.advance(1);
        if self.data.fit.windows.len() < LEAST_MOVING {
            let recalibrated = before.clone();
            return Some(Alone { before, recalibrated, singles: Vec::new() });
        }
        let recalibrated = try_hypothesis(&self.data, self.hypothesis(nuisances, &[]), &before)?;
        let known = known.and_then(|v| refit(&self.data, self.hypothesis(nuisances, &[]), &before, v));
        let better = known.filter(|known| against(&self.data, known) < against(&self.data, &recalibrated));
        let recalibrated = better.unwrap_or(recalibrated);
        self.progress.advance(1);
        let (recalibrated, singles) = self.singles(&before, recalibrated);
        let best = singles.iter().take(STATES_FOR_WALL).collect::<Vec<_>>();
        let [before, recalibrated] =
            [before, recalibrated].map(|tried| shared_states(&self.data, &tried, &best));
        Some(Alone { before, recalibrated, singles })
    }

    /// Single effects, best first, and the wall without effects, each fitted again from what the other found.
    fn singles(&self, before: &Tried, recalibrated: Tried) -> (Tried, Vec<Tried>) {
        let nuisances = &self.experiment.nuisances;
        let additions = candidates(self.experiment.wall.parameters());
        let sets = additions.iter().map(|a| vec![*a]).collect::<Vec<_>>();
        let singles = self.try_all("single effects", nuisances, &self.starts(before, &recalibrated), &sets);
        let nearest = singles.iter().take(REFITTED_FROM);
        let better = nearest.fold(recalibrated.clone(), |part, whole| self.better_part(part, whole));
        if against(&self.data, &recalibrated) - against(&self.data, &better) < WORTH_POLISH {
            let singles = self.polished(nuisances, before, singles, &better);
            return (better, self.with_giving(singles));
        }
        // What was tried before had missed the same; the best need not have.
        let starts = [Some(&better), singles.first()].into_iter().flatten().collect::<Vec<_>>();
        let again = self.try_all("single effects again", nuisances, &starts, &sets);
        let best = self.best_of_each([singles, again].concat());
        let singles = self.polished(nuisances, before, best, &better);
        (better, self.with_giving(singles))
    }

    /// Where single effects start: from the wall as given, and where one of its numbers was not known, with that fitted.
    fn starts<'t>(&self, before: &'t Tried, recalibrated: &'t Tried) -> Vec<&'t Tried> {
        let wide = self.experiment.nuisances.iter().any(Nuisance::is_wide);
        if wide { vec![before, recalibrated] } else { vec![before] }
    }
}
