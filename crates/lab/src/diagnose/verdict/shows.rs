//! Laws outside the catalogue that show where effects say little or nothing: in few windows, in tests held out, at impacts alone.

use super::judge::Gap;
use crate::Progress;
use crate::diagnose::discovery::{AskedOfLaws, Discovered, Scope};
use crate::diagnose::trials::FittedHypothesis;
use crate::limits::WORTH_A_LAW_IN_NOISE;

impl<P: Progress> Gap<'_, P> {
    /// The law of one atom that other windows tell with a second that these show: at the top, where what is missing may act, or leaving noise.
    pub(super) fn beyond(
        &self,
        of_fitted: &FittedHypothesis,
        singles: &[FittedHypothesis],
    ) -> Option<Discovered> {
        let gap = self.open_gap(singles, &[], Scope::TwoAtoms, None)?;
        let found = self.trials.discover_beyond(of_fitted, &gap, self)?;
        let best = found.equals.first()?;
        let may_act_there = || best.hypothesis.additions[0].place() == "top" && self.may_act_at_top();
        (found.is_outside_catalogue() && (self.leaves_nothing(best) || may_act_there())).then_some(found)
    }

    /// A law of one atom outside the catalogue that shows where the wall follows the tests without it: all windows together leave noise,
    /// and few of them show a law that no effect of the catalogue imitates.
    pub(super) fn law_that_shows(&self, singles: &[FittedHypothesis]) -> Option<Discovered> {
        let found = self.looked_for(singles, &[], Scope::OneAtom, None)?;
        let best = found.equals.first()?;
        let shows = self.gain(&self.wall.recalibrated, best) > WORTH_A_LAW_IN_NOISE;
        (shows && found.is_outside_catalogue() && self.leaves_nothing(best)).then_some(found)
    }

    /// A law outside the catalogue where effects say no more than that impacts are those of another formulation: it gains over the wall, and
    /// over every effect, what a law in noise must. Of one atom, where none was looked for before.
    pub(super) fn law_beyond_impacts(&self, singles: &[FittedHypothesis]) -> Option<Discovered> {
        let found = match self.early.get() {
            Some(found) => found.clone(),
            None => self.looked_for(singles, &[], Scope::TwoAtoms, None)?,
        };
        let best = found.equals.first()?;
        let mut without = singles.iter().chain([&self.wall.recalibrated]);
        let shows = without.all(|other| self.gain(other, best) > WORTH_A_LAW_IN_NOISE);
        (shows && found.is_outside_catalogue()).then_some(found)
    }

    /// The laws of one atom that were looked for and hold, where nothing was said of what tests held out show: joints that give would show
    /// in the tests fitted, too. At a joint points may say more of two, which see what a law in windows leaves as noise.
    pub(super) fn told_where_nothing_was_said(&self) -> Option<Discovered> {
        self.early.get().filter(|found| !found.is_open() && found.is_outside_catalogue()).cloned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{DRAG, SPRING, Twin, wall_with};
    use crate::diagnose::trials::{is_noise, joint_error};

    /// A stop on one side, of a stiffness in N/m.
    fn stop(k: f64, gap_m: f64) -> String {
        format!(
            "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"k*max(-x-g,0)\"\n[effects.parameters]\n\
             k = {{ value = {k:?}, unit = \"N/m\" }}\ng = {{ value = {gap_m:?}, unit = \"m\" }}\n"
        )
    }

    /// Whether the wall with its own numbers fitted follows the tests to their noise, and the law that shows all the same.
    fn shown(effects: &str, noise_rad: f64) -> (bool, Option<String>) {
        let twin = Twin::new(&wall_with(effects), noise_rad);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let (error, follows) = (joint_error(&wall.before).expect("windows"), is_noise(&wall.recalibrated));
        let found = Gap::new(&trials, wall, error).law_that_shows(&[]);
        (follows, found.map(|found| found.equals[0].hypothesis.name()))
    }

    #[test]
    fn analytic_a_stop_that_few_windows_show_is_told_though_all_together_leave_noise() {
        let (follows, law) = shown(&stop(2e4, 0.02), 5e-5);
        assert!(follows && law.as_deref() == Some("k*max(-x-g,0) at top"), "{follows} {law:?}");
        // Reached by less, and at twice the noise, it does not show.
        assert_eq!(shown(&stop(2e4, 0.03), 1e-4), (true, None));
        assert_eq!(shown("", 5e-5), (true, None), "nothing is hidden");
    }

    #[test]
    fn analytic_a_law_that_gains_over_every_effect_is_told_where_impacts_could_be_all_that_is_left() {
        let beyond = |effects: &str| {
            let twin = Twin::new(&wall_with(effects), 1e-5);
            let trials = twin.trials();
            let wall = trials.wall_fits(None).expect("windows");
            let error = joint_error(&wall.before).expect("windows");
            let gap = Gap::new(&trials, wall, error);
            let found = gap.law_beyond_impacts(&[])?;
            let law = found.equals[0].clone();
            assert!(gap.law_beyond_impacts(std::slice::from_ref(&law)).is_none(), "an effect does as well");
            assert!(gap.outdoes(&law, &gap.wall.recalibrated), "a name that leaves more gives way");
            assert!(!gap.outdoes(&law, &law), "one that leaves as little stays");
            assert!(!gap.closes_by_law_at_top(), "none was looked for before");
            assert!(gap.told_where_nothing_was_said().is_none());
            gap.told_early(&[]);
            assert!(gap.closes_by_law_at_top());
            assert!(gap.told_where_nothing_was_said().is_some_and(|found| !found.is_open()));
            Some(law.hypothesis.name())
        };
        assert_eq!(beyond(&stop(2e4, 0.02)).as_deref(), Some("k*max(-x-g,0) at top"));
        let two = beyond(&[DRAG, SPRING].concat()).expect("two atoms");
        assert!(two.contains("c_1*v*abs(v)") && two.contains("k_2*max(-x,0)"), "{two}");
        assert_eq!(beyond(""), None, "nothing is hidden");
    }
}
