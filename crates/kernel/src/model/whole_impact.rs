//! The impact of a wall that turns as one and strikes the ground: most impacts of most runs.
//!
//! Both rotations are zero then, so that velocities after are a share of those before and energies go with their squares. The
//! shares are worked out once for each side, by [`super::impact`].

use super::contact::{Contact, Pivot, Touching};
use super::impact::Impact;
use super::rocking::{RockingWall, State};
use super::{MechanicsError, Table2Change};

/// What a velocity of 1 rad/s before the impact comes to.
#[derive(Debug, Clone, Copy)]
pub(super) struct WholeImpact {
    change: Option<Table2Change>,
    /// Velocity after, rad/s, as the plastic impact and the coefficient of the change leave it.
    omega: f64,
    /// That which the plastic impact leaves, rad/s: what a capture looks at.
    plastic: f64,
    /// Kinetic energy lost, J.
    loss_j: f64,
}

/// Pattern 3 about a corner.
fn whole(ground: Pivot) -> Contact {
    Contact { ground, crack: Pivot::Closed }
}

const BOTH: Touching = Touching { ground: true, crack: true };

impl RockingWall {
    /// The impacts about the right and the left corner; none where the joints have no sharp edges, or the wall does not turn on
    /// as one.
    pub(super) fn whole_impacts(&self) -> [Option<WholeImpact>; 2] {
        Pivot::OPEN.map(|side| {
            if self.wall().rolls() {
                return None;
            }
            let state = State { theta: [0.0; 2], omega: [-side.sign(); 2] };
            let impact = self.worked_out_impact(whole(side), BOTH, &state).ok()?;
            let Impact { contact, omega: [omega, _], change, loss_j, .. } = impact;
            let (omega, coefficient) =
                (omega.abs(), change.map_or(1.0, |change| self.coefficients[change.index()]));
            let turns_on = contact == whole(side.mirrored()) && coefficient > 0.0;
            turns_on.then_some(WholeImpact { change, omega, plastic: omega / coefficient, loss_j })
        })
    }

    /// The outcome of an impact at a state whose touching joints have zero opening.
    ///
    /// # Errors
    /// [`MechanicsError::ImpactOutcomes`] unless exactly one contact state is admissible.
    #[inline]
    pub fn impact(&self, from: Contact, touching: Touching, state: &State) -> Result<Impact, MechanicsError> {
        match self.whole_impact(from, touching, state) {
            Some(impact) => Ok(impact),
            None => self.worked_out_impact(from, touching, state),
        }
    }

    /// The impact as a share of the velocity before. `None` of other impacts, and where the wall may be captured.
    #[inline]
    fn whole_impact(&self, from: Contact, touching: Touching, state: &State) -> Option<Impact> {
        let [before, upper] = state.omega;
        let falls_back = before * from.ground.sign() < 0.0;
        let as_one = falls_back && from.crack.is_closed() && before == upper;
        if !as_one || touching != BOTH || state.theta != [0.0; 2] {
            return None;
        }
        let side = usize::from(from.ground == Pivot::Left);
        let WholeImpact { change, omega, plastic, loss_j } = self.whole_impacts[side]?;
        if (plastic * before).abs() < self.capture_rad_s {
            return None;
        }
        let contact = whole(from.ground.mirrored());
        let loss_j = loss_j * before * before;
        Some(Impact { contact, omega: [omega * before; 2], change, captured: false, loss_j })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Wall, WallParameters};

    #[test]
    fn analytic_a_share_is_what_an_impact_leaves() {
        let wall = Wall::new(WallParameters { eccentricity_m: 0.03, ..WallParameters::table_wall() });
        let wall = RockingWall::new(&wall.expect("a wall"));
        for side in Pivot::OPEN {
            for speed in [2e-3, 0.03, 1.7] {
                let state = State { theta: [0.0; 2], omega: [-side.sign() * speed; 2] };
                let share = wall.whole_impact(whole(side), BOTH, &state).expect("it turns on");
                let impact = wall.worked_out_impact(whole(side), BOTH, &state).expect("an impact");
                assert_eq!((share.contact, share.change), (impact.contact, impact.change));
                // Some ten operations.
                assert!(
                    (share.omega[0] / impact.omega[0] - 1.0).abs() < 10.0 * f64::EPSILON,
                    "{share:?} {impact:?}"
                );
                assert!((share.loss_j / impact.loss_j - 1.0).abs() < 1e-14, "{share:?} {impact:?}");
            }
        }
    }

    #[test]
    fn analytic_a_slow_wall_is_left_to_be_captured() {
        let wall = RockingWall::new(&Wall::new(WallParameters::table_wall()).expect("a wall"));
        let state = State { theta: [0.0; 2], omega: [-0.5e-3; 2] };
        let impact = wall.impact(whole(Pivot::Right), BOTH, &state).expect("an impact");
        assert!(impact.captured && impact.contact == Contact::REST, "{impact:?}");
    }
}
