//! Windows in which an impact at the ground meets a crack that is open by less than anyone can tell.
//!
//! Under Table 2 an impact has another coefficient as soon as the crack is open: C_6 where it is closed, C_3 where it is
//! open by 1e-8 rad. Within the noise a state may be fitted either way. Joints of real walls give a little before they open,
//! too, and count as closed until then. So what such a window says of a coefficient is what was assumed of it.

use crate::diagnose::fit::{Fit, Replay, WindowFit};
use crate::diagnose::hypothesis::Physics;
use crate::experiment::{TestData, Window};
use crate::limits::READS_CLOSED;
use mrbd_kernel::model::{Contact, Pair};
use mrbd_kernel::simulate::Observer;
use mrbd_kernel::solver::Quintic;
use rayon::prelude::*;

/// Opening below which a joint of another formulation of contact may count as closed, rad.
///
/// Chosen: stiff corners of the second simulator of the frozen sets turn by some 1e-6 rad before they open, and tell an
/// open joint from ten to twenty times that.
const GIVES_RAD: f64 = 2e-5;

/// Of each window whether an impact at the ground meets a crack that may be open or closed, for the states of a fit.
pub(super) fn doubtful(tests: &[TestData], physics: &Physics, windows: &[Window], fit: &Fit) -> Vec<bool> {
    let replay = Replay::new(tests, physics);
    let of = |(window, state): (&Window, &WindowFit)| {
        let [lower, upper] = tests[window.test].noise_rad;
        let mut met = Met { clear_rad: (READS_CLOSED * lower.max(upper)).max(GIVES_RAD), ..Met::default() };
        replay.run(window, &state.x, &mut met);
        met.doubtful
    };
    windows.par_iter().zip(&fit.windows).map(of).collect()
}

/// What impacts at the ground met.
#[derive(Debug, Default)]
struct Met {
    /// Opening from which on a crack is open beyond doubt, rad.
    clear_rad: f64,
    /// The contact state until now, and how far the crack is open in it, rad.
    before: Option<(Contact, f64)>,
    doubtful: bool,
}

impl Observer for Met {
    fn moved(&mut self, _: f64, contact: Contact, motion: &Quintic) {
        if let Some((before, opening_rad)) = self.before {
            let impact = before.ground.is_open() && before.ground != contact.ground;
            self.doubtful |= impact && before.crack.is_open() && opening_rad.abs() < self.clear_rad;
        }
        let [lower, upper] = motion.position(1.0);
        self.before = Some((contact, upper - lower));
    }

    fn stood(&mut self, _: f64, _: f64) {}

    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::Pivot;
    use mrbd_kernel::solver::Point;

    /// Whether a wall is doubtful whose crack is open by so much when it comes down on the ground, to be read from 1e-4 rad on.
    fn is_doubtful(crack: Pivot, opening_rad: f64, after: Pivot) -> bool {
        let still = |theta: Pair| Point { position: theta, ..Point::default() };
        let step = |ends: [Pair; 2]| Quintic::new(&still(ends[0]), &still(ends[1]), 0.01);
        let mut met = Met { clear_rad: 1e-4, ..Met::default() };
        let down = step([[0.01, 0.01], [0.0, opening_rad]]);
        met.moved(0.0, Contact { ground: Pivot::Right, crack }, &down);
        met.moved(0.01, Contact { ground: after, crack }, &step([[0.0, opening_rad], [-0.01, -0.01]]));
        met.doubtful
    }

    #[test]
    fn analytic_an_impact_is_doubtful_where_the_crack_is_open_by_less_than_can_be_read() {
        assert!(is_doubtful(Pivot::Right, 5e-5, Pivot::Left));
        assert!(is_doubtful(Pivot::Left, -5e-5, Pivot::Left));
        assert!(!is_doubtful(Pivot::Right, 2e-4, Pivot::Left));
        assert!(!is_doubtful(Pivot::Left, -2e-4, Pivot::Left));
        // A crack that is closed is so in every formulation; and no impact at the ground has no doubt.
        assert!(!is_doubtful(Pivot::Closed, 0.0, Pivot::Left));
        assert!(!is_doubtful(Pivot::Right, 5e-5, Pivot::Right));
    }
}
