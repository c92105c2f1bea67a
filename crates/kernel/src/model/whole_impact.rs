//! The impact of a wall that turns as one and strikes the ground: most impacts of most runs.
//!
//! Both rotations are zero then, so that velocities after are a share of those before and energies go with their squares. The
//! shares are worked out once for each side, by [`super::impact`].

use super::contact::{Contact, Pivot, Touching};
use super::geometry::Rotations;
use super::impact::Impact;
use super::rocking::{RockingWall, State};
use super::{MechanicsError, Table2Change};

/// What a velocity of 1 rad/s before the impact comes to.
#[derive(Debug, Clone, Copy)]
pub(super) struct WholeImpact {
    change: Option<Table2Change>,
    /// Velocity that the plastic impact leaves, rad/s.
    pub(super) plastic: f64,
    /// Kinetic energy at 1 rad/s about the corner before, and about that after, J.
    pub(super) before_j: f64,
    pub(super) after_j: f64,
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
            let [from, after] = [side, side.mirrored()].map(whole);
            let state = State { theta: [0.0; 2], omega: [-side.sign(); 2] };
            let collision = self.collision(from, BOTH, &state);
            let (to, [plastic, _]) = self.struck_through(from, &collision)?;
            let energy_j = |contact| self.motion(contact).kinetic_energy_j(collision.rotations, [1.0; 2]);
            let [before_j, after_j] = [from, after].map(energy_j);
            let change = Table2Change::of(from, after);
            (to == after).then_some(WholeImpact { change, plastic: plastic.abs(), before_j, after_j })
        })
    }

    /// The impact of the wall that turns as one about a corner.
    #[inline]
    pub(super) fn whole_impact_about(&self, ground: Pivot) -> Option<&WholeImpact> {
        self.whole_impacts[usize::from(ground == Pivot::Left)].as_ref()
    }

    /// The outcome of an impact at a state whose touching joints have zero opening.
    ///
    /// # Errors
    /// [`MechanicsError::ImpactOutcomes`] unless exactly one contact state is admissible.
    #[inline(always)]
    pub fn impact(&self, from: Contact, touching: Touching, state: &State) -> Result<Impact, MechanicsError> {
        match self.whole_impact(from, touching, state) {
            Some(impact) => Ok(impact),
            None => self.worked_out_impact(from, touching, state),
        }
    }

    /// The impact as a share of the velocity before. `None` of other impacts.
    #[inline(always)]
    fn whole_impact(&self, from: Contact, touching: Touching, state: &State) -> Option<Impact> {
        let [before, upper] = state.omega;
        let falls_back = before * from.ground.sign() < 0.0;
        let as_one = falls_back && from.crack.is_closed() && before == upper;
        if !as_one || touching != BOTH || state.theta != [0.0; 2] {
            return None;
        }
        let &WholeImpact { change, plastic, before_j, after_j } = self.whole_impact_about(from.ground)?;
        let plastic = plastic * before;
        if plastic.abs() < self.capture_rad_s {
            let loss_j = self.motion(from).kinetic_energy_j(Rotations::NONE, state.omega);
            let at_rest =
                Impact { contact: Contact::REST, omega: [0.0; 2], change: None, captured: true, loss_j };
            return Some(at_rest);
        }
        // Under both laws of impacts: if every touching joint stuck, nothing would move.
        let coefficient = change.map_or(1.0, |change| {
            self.coefficients[change.index()] * self.factor_at_impact(touching, state.omega)
        });
        let (contact, after) = (whole(from.ground.mirrored()), coefficient * plastic);
        let loss_j = before_j * before * before - after_j * after * after;
        Some(Impact { contact, omega: [after; 2], change, captured: false, loss_j })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Effect, Wall, WallParameters};

    #[test]
    fn analytic_a_share_is_what_an_impact_leaves() {
        let fading = Effect::with_parameters("impact_fading", &[0.8]).expect("an effect");
        for effects in [vec![], vec![fading]] {
            let parameters = WallParameters { eccentricity_m: 0.03, effects, ..WallParameters::table_wall() };
            shares_are_what_impacts_leave(&RockingWall::new(&Wall::new(parameters).expect("a wall")));
        }
    }

    fn shares_are_what_impacts_leave(wall: &RockingWall) {
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
    fn analytic_a_slow_wall_is_captured_as_worked_out() {
        let wall = RockingWall::new(&Wall::new(WallParameters::table_wall()).expect("a wall"));
        for (side, speed) in Pivot::OPEN.into_iter().flat_map(|side| [(side, 0.5e-3), (side, 1e-9)]) {
            let state = State { theta: [0.0; 2], omega: [-side.sign() * speed; 2] };
            let impact = wall.whole_impact(whole(side), BOTH, &state).expect("it is captured");
            assert!(impact.captured && impact.contact == Contact::REST, "{impact:?}");
            assert_eq!(impact, wall.worked_out_impact(whole(side), BOTH, &state).expect("an impact"));
        }
    }
}
