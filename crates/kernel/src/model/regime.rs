//! The regime of a wall whose laws at the top have kinks, jumps or memory, and its contact states.
//!
//! Friction, a gap, one-sided and yielding springs are such laws. At any instant the top is in one
//! [`Regime`]. There each law is smooth: a stiffness, a constant force, a constant drag. A regime ends at a
//! [`Kink`], where a spring begins or ceases to act or the top stops. Runs locate kinks as they locate
//! impacts.

use super::MechanicsError;
use super::contact::Contact;
use super::formula::CarriedStates;
use super::geometry::Pair;
use super::joint_forces::Reactions;
use super::laws::PiecewiseLaws;
use super::next_contact::FORCE_ROUNDING;
use super::rocking::{RockingWall, State};
use super::vector::Vector;
use super::wall::G_M_S2;

/// Where a quantity lies: below, within or above an interval around zero. Of sliding: to -x, not at all, to
/// +x.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// Below, or towards -x.
    Negative,
    /// Within, or not at all.
    #[default]
    Between,
    /// Above, or towards +x.
    Positive,
}

impl Side {
    /// -1, 0 or +1.
    pub fn sign(self) -> f64 {
        match self {
            Side::Negative => -1.0,
            Side::Between => 0.0,
            Side::Positive => 1.0,
        }
    }

    /// The side on which a number lies.
    pub fn of(x: f64) -> Self {
        if x > 0.0 {
            Side::Positive
        } else if x < 0.0 {
            Side::Negative
        } else {
            Side::Between
        }
    }
}

/// In which of their smooth branches the laws at the top are.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Regime {
    /// Which way the top slides against friction; between: it sticks.
    pub slides: Side,
    /// On which side the gap is closed; between: open.
    pub gap: Side,
    /// On which side of zero the top is displaced, for one-sided springs.
    pub leans: Side,
    /// Which way the yielding spring yields; between: it is elastic.
    pub yields: Side,
    /// Plastic displacement x_p of the yielding spring, m.
    pub plastic_m: f64,
    /// On which side the top is farther out than it ever was, and goes on; between: it has been as far.
    pub grows: Side,
    /// How far it had been before, m: the largest |x_C|.
    pub largest_m: f64,
}

/// What the laws at the top keep of the past.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TopMemory {
    /// Plastic displacement of the yielding spring, m.
    pub plastic_m: f64,
    /// The largest |x_C| so far, m.
    pub largest_m: f64,
    /// The carried states of formulas; `None`: as they are.
    pub carried: Option<CarriedStates>,
}

/// Where a regime ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kink {
    /// The top passes a displacement, coming from one side of it: sign × (limit - x_C) falls below zero.
    Passes { limit_m: f64, sign: f64, change: Change },
    /// The top stops: sign × ẋ_C falls below zero.
    Stops { sign: f64 },
    /// A formula changes its branch.
    Turns { formula: usize, switch: usize },
}

/// What changes where the top passes a displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Change {
    Gap(Side),
    Leans(Side),
    Yields(Side),
    Grows(Side),
}

/// A speed of the top within this share of what it is the difference of is zero: some hundred roundings.
const SPEED_ROUNDING: f64 = 1e-13;

/// A top slower than this share of α h over the time of response is at rest. Its energy is a rounding of the
/// wall's. Without it the bursts of ever smaller impacts in which friction brings a wall to rest would have
/// no end.
const LEAST_SPEED: f64 = 1e-8;

impl RockingWall {
    /// The laws at the top that have kinks.
    pub(crate) fn piecewise_laws(&self) -> Option<&PiecewiseLaws> {
        self.piecewise_laws.as_ref()
    }

    /// Speed of the top, m/s, below which it is at rest.
    pub(super) fn least_speed_m_s(&self) -> f64 {
        LEAST_SPEED * self.wall().alpha_rad() * self.wall().parameters().height_m / self.response_time_s()
    }

    /// The branch in which the laws at the top are.
    pub fn regime(&self) -> Regime {
        self.regime
    }

    /// Makes the laws of a regime those of the wall. A wall whose laws have no kinks stays as it is.
    pub(crate) fn enter_regime(&mut self, regime: Regime) {
        let Some(piecewise_laws) = self.piecewise_laws else { return };
        self.regime = regime;
        let laws = piecewise_laws.laws(&regime);
        let held = piecewise_laws.rubs() && regime.slides == Side::Between;
        self.motions_mut().iter_mut().for_each(|motion| motion.set_laws(laws, held));
        self.formulas.slide(regime.slides);
        self.formulas.remember(regime.grows, regime.largest_m);
        self.share_branches();
    }

    /// Enters the regime of a state that nothing went before, but for what the laws at the top keep.
    pub fn enter_regime_of_state(&mut self, contact: Contact, state: &State, memory: TopMemory) {
        if let Some(carried) = memory.carried {
            self.put_carried(&carried);
        }
        if let Some(piecewise_laws) = self.piecewise_laws {
            let [x_c, v_c, _] = self.motion(contact).top(state.theta, state.omega, [0.0; 2]);
            self.enter_regime(piecewise_laws.regime_at(x_c, v_c, memory));
        }
        self.turn_switches(contact, state, [0.0; 2], None);
    }

    /// Goes through a kink.
    pub(crate) fn pass_kink(&mut self, kink: Kink, contact: Contact, theta: Pair) {
        if let Kink::Turns { formula, switch } = kink {
            return self.flip_switch(formula, switch);
        }
        let Some(piecewise_laws) = self.piecewise_laws else { return };
        let x_c = self.top_displacement_m(contact, theta);
        self.enter_regime(piecewise_laws.after(&self.regime, kink, x_c));
    }

    /// Displacement, velocity and acceleration of the top, relative to the ground, in SI units.
    pub(crate) fn top(&self, contact: Contact, theta: Pair, omega: Pair, theta_dd: Pair) -> [f64; 3] {
        self.motion(contact).top(theta, omega, theta_dd)
    }

    /// The sum of the magnitudes of which the speed of the top is the sum, m/s.
    pub(crate) fn top_speed_size(&self, contact: Contact, omega: Pair) -> f64 {
        self.motion(contact).top_speed_size(omega)
    }

    /// The velocities without those of the top.
    pub(crate) fn with_top_stopped(&self, contact: Contact, theta: Pair, omega: Pair) -> Pair {
        self.motion(contact).with_top_stopped(theta, omega)
    }

    /// Whether friction holds the top in place.
    pub(crate) fn is_held(&self) -> bool {
        self.piecewise_laws.is_some_and(|r| r.rubs()) && self.regime.slides == Side::Between
    }

    /// The same wall under a further force at the top, N.
    pub(crate) fn with_top_force(&self, force_n: f64) -> Self {
        let mut pushed = self.clone();
        let mut laws =
            self.piecewise_laws.map_or_else(|| *self.motion(Contact::REST).laws(), |r| r.laws(&self.regime));
        laws.spring_offset_n += force_n;
        pushed.motions_mut().iter_mut().for_each(|motion| motion.set_laws(laws, false));
        pushed
    }

    /// The smallest reserve that keeps a contact state as it is, over the weight of the wall. It is the
    /// smallest corner force of the closed joints, or what friction could hold beyond what it does. `None`
    /// where nothing is to hold.
    #[inline(always)]
    pub(crate) fn smallest_reserve(&self, contact: Contact, reactions: &Reactions) -> Option<f64> {
        let corners = self.smallest_corner_force(contact, &reactions.forces);
        match &self.piecewise_laws {
            Some(piecewise_laws) if self.is_held() && !self.rests_in(contact) => {
                let left = self.friction_left(piecewise_laws.friction_n(), reactions);
                Some(corners.map_or(left, |least| least.min(left)))
            }
            _ => corners,
        }
    }

    /// The same over the weight of the wall.
    #[inline(never)]
    fn friction_left(&self, friction_n: f64, reactions: &Reactions) -> f64 {
        self.friction_left_n(friction_n, reactions) / self.weight_n()
    }

    /// What friction could hold beyond what it does, N.
    fn friction_left_n(&self, friction_n: f64, reactions: &Reactions) -> f64 {
        let holding_n = reactions.holding_n;
        if !self.formulas.rubs() {
            return friction_n - holding_n.abs();
        }
        let [least_n, most_n] = self.holds_n(friction_n, reactions.top_displacement_m);
        (most_n - holding_n).min(holding_n - least_n)
    }

    /// Forces by which friction can hold the top at a displacement: the least and the most, N.
    pub(crate) fn holds_n(&self, friction_n: f64, x_c_m: f64) -> [f64; 2] {
        let [least_n, most_n] = self.formulas.holds_n(x_c_m);
        [least_n - friction_n, most_n + friction_n]
    }

    /// Which way the top slides at a velocity in m/s; [`Side::Between`] at rest.
    fn sliding(&self, contact: Contact, omega: Pair, v_c_m_s: f64) -> Side {
        let rounding = SPEED_ROUNDING * self.motion(contact).top_speed_size(omega);
        if v_c_m_s.abs() <= rounding.max(self.least_speed_m_s) { Side::Between } else { Side::of(v_c_m_s) }
    }

    /// The velocities without those of a top that friction has all but stopped.
    pub(crate) fn with_slow_top_stopped(&self, contact: Contact, state: &State) -> Pair {
        let rubs = self.piecewise_laws.is_some_and(|piecewise_laws| piecewise_laws.rubs());
        let [_, v_c, _] = self.motion(contact).top(state.theta, state.omega, [0.0; 2]);
        match self.sliding(contact, state.omega, v_c) {
            Side::Between if rubs => self.with_top_stopped(contact, state.theta, state.omega),
            _ => state.omega,
        }
    }

    /// [`RockingWall::next_contact`] for a wall whose laws at the top have kinks. It finds the contact state
    /// together with the way the top slides or sticks, and enters that regime.
    ///
    /// The friction's force does not depend on the joints' forces. What minimises Gauss' constraint is then
    /// unique: one way of sliding in one contact state. `rest_reserve` is what holds the wall at rest, known
    /// to [`crate::simulate`] beforehand. At rest friction and corners share a load that no equation divides.
    ///
    /// # Errors
    /// [`MechanicsError::NoContactState`] where no state is admissible.
    pub(crate) fn next_contact_and_regime(
        &mut self,
        piecewise_laws: &PiecewiseLaws,
        contact: Contact,
        state: &State,
        ground: Vector,
        rest_reserve: f64,
    ) -> Result<Contact, MechanicsError> {
        let motion = self.motion(contact);
        let [x_c, v_c, _] = motion.top(state.theta, state.omega, [0.0; 2]);
        let side = self.sliding(contact, state.omega, v_c);
        let moves = side != Side::Between;
        let turned = piecewise_laws.at_velocity(&self.regime, side, x_c);
        let ways: &[Side] = match side {
            Side::Between if piecewise_laws.rubs() => &[Side::Between, Side::Positive, Side::Negative],
            Side::Between => &[Side::Between],
            Side::Positive => &[Side::Positive],
            Side::Negative => &[Side::Negative],
        };
        for opened in 0..=2 {
            let candidates: Vec<Contact> = self.states_opening(contact, opened).collect();
            for candidate in candidates {
                for &slides in ways {
                    self.enter_regime(Regime { slides, ..turned });
                    let starts = !moves && slides != Side::Between;
                    if self.is_admissible_with_top(contact, candidate, state, ground, starts, rest_reserve) {
                        return Ok(candidate);
                    }
                }
            }
        }
        // As in `next_contact`: a force so near zero that nothing that would follow has a sign beyond roundings.
        for &slides in ways {
            self.enter_regime(Regime { slides, ..turned });
            let theta_dd = self.rate(contact, state, ground).theta_dd;
            let reactions = self.motion(contact).reactions(state.theta, state.omega, theta_dd, ground);
            let hold = if self.rests_in(contact) {
                Some(rest_reserve)
            } else {
                self.smallest_reserve(contact, &reactions)
            };
            let onwards = slides.sign() * reactions.top_acceleration_m_s2 >= -FORCE_ROUNDING * G_M_S2;
            if (moves || onwards) && hold.is_none_or(|least| least >= -FORCE_ROUNDING) {
                return Ok(contact);
            }
        }
        Err(MechanicsError::NoContactState { from: contact.name() })
    }

    /// Whether a candidate carries its forces, and a top that starts to slide slides the way it is pushed.
    fn is_admissible_with_top(
        &self,
        before: Contact,
        candidate: Contact,
        state: &State,
        ground: Vector,
        starts: bool,
        rest_reserve: f64,
    ) -> bool {
        if self.rests_in(candidate) {
            return !starts && rest_reserve >= 0.0;
        }
        if starts {
            let theta_dd = self.rate(candidate, state, ground).theta_dd;
            let [_, _, a_c] = self.motion(candidate).top(state.theta, state.omega, theta_dd);
            if self.regime.slides.sign() * a_c <= 0.0 {
                return false;
            }
        }
        self.is_admissible(before, candidate, state, ground)
    }
}
