//! Joints that open too briefly for points.
//!
//! A wall that swings as a whole opens its crack for some hundredths of a second after impacts. No stretch between these is long enough for
//! a test function, so points have no row in which the crack turns; windows go through impacts, and say up to 270 natural logarithms of
//! another damper there than the catalogue's, for which its name was told. How a joint turns there is known from windows alone.

use super::points::Points;
use crate::Progress;
use crate::diagnose::trials::{FittedHypothesis, Trials};

impl<P: Progress> Trials<'_, P> {
    /// Points of the tests fitted under the wall, with how joints turn in windows under a hypothesis where no point shows it. `None` where
    /// points say nothing of any law.
    pub(super) fn points(&self, seen_by: &FittedHypothesis) -> Option<Points> {
        let wall = self.hypothesis(&self.experiment.nuisances, &[]);
        let points = Points::new(self.data.fit.tests, &wall)?;
        let is_silent = points.silent_joints().next().is_some();
        let motion = || self.data.fit.joint_motion(&seen_by.hypothesis, &seen_by.fit);
        Some(match is_silent.then(motion).flatten() {
            Some(motion) => points.with_brief(motion.samples),
            None => points,
        })
    }
}
