//! How joints turn in windows, simulated: also where no stretch between impacts is long enough to be measured.

use super::{Fit, Problem};
use crate::diagnose::hypothesis::Hypothesis;
use mrbd_kernel::model::{Contact, Pair};
use mrbd_kernel::simulate::Observer;
use mrbd_kernel::solver::Quintic;

/// Shares of a step at which the motion along it is taken.
const SHARES: [f64; 2] = [0.5, 1.0];

/// Rotations (rad) and velocities (rad/s) of the ground's joint and of the crack's, with a zero for the largest rotation so far, which is
/// told at the top alone.
#[derive(Debug, Default)]
struct JointMotion([Vec<[f64; 3]>; 2]);

impl Observer for JointMotion {
    fn moved(&mut self, _: f64, _: Contact, motion: &Quintic) {
        for share in SHARES {
            let ([lower, upper], [of_lower, of_upper]) = (motion.position(share), motion.velocity(share));
            self.0[0].push([lower, of_lower, 0.0]);
            self.0[1].push([upper - lower, of_upper - of_lower, 0.0]);
        }
    }

    fn stood(&mut self, _: f64, _: f64) {}

    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}
}

impl Problem<'_> {
    /// Rotation (rad) and velocity (rad/s) of the ground's joint and of the crack's along the windows that a fit follows, with a zero for the
    /// largest rotation so far. `None` if it has no wall.
    pub fn joint_motion(&self, h: &Hypothesis, fit: &Fit) -> Option<[Vec<[f64; 3]>; 2]> {
        let replay = self.replay(&h.physics(&fit.values)?);
        let mut motion = JointMotion::default();
        for (window, state) in self.windows.iter().zip(&fit.windows).filter(|(_, state)| !state.is_poor()) {
            replay.run(window, &state.x, &mut motion);
        }
        Some(motion.0)
    }
}
