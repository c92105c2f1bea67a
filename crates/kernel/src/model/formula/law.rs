//! One formula of a wall, in its branch: its force or moment, and what friction in it can hold.

use std::sync::Arc;

use mrbd_formula::{Branch, Branches, Formula, MOST_STATES, Place, Program, State, VARIABLES};

use super::super::contact::Joint;
use super::super::geometry::Pair;
use super::super::regime::Side;
use super::carried::Carried;
use crate::lanes::{LANES, Wide};

/// The joint of a place, where it is at one.
pub(super) fn joint_of(place: Place) -> Option<Joint> {
    match place {
        Place::Top | Place::Impacts => None,
        Place::Ground => Some(Joint::Ground),
        Place::Crack => Some(Joint::Crack),
    }
}

/// The largest |x_C| so far, as a formula at the top sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Largest {
    /// On which side the top is farther out than it ever was: there it is |x_C|.
    pub grows: Side,
    /// How far it had been before, m.
    pub before_m: f64,
}

impl Largest {
    fn at(self, x_c_m: f64) -> f64 {
        match self.grows {
            Side::Between => self.before_m,
            side => side.sign() * x_c_m,
        }
    }
}

/// One formula, ready to run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FormulaLaw {
    pub(super) program: Arc<Program>,
    /// `None`: at the top.
    pub(super) joint: Option<Joint>,
    /// Whether it depends on the displacement or rotation.
    pub(super) asks_where: bool,
    /// The third variable at a joint: the weight on it, N.
    weight_n: f64,
    /// The third variable at the top, where it occurs.
    pub(super) largest: Option<Largest>,
    /// The switch at which it jumps against the motion.
    pub(super) friction: Option<usize>,
    pub(super) branches: Branches,
    pub(super) carried: Carried,
    /// The rate below which a root of it goes straight to zero, m/s or rad/s; zero where there is no such root.
    straight_below: f64,
}

/// How much steeper than over a hundred times as much a force may rise over the least rates: a power of 0.91.
const STEEPEST: f64 = 1.5;

impl FormulaLaw {
    /// In the branches of rest; friction holds.
    pub(super) fn new(formula: &Formula, weight_n: f64, friction: Option<usize>, carried: Carried) -> Self {
        let program = Arc::clone(formula.program());
        let [z_1, z_2] = carried.now;
        let at_rest = program.branches_at([0.0, 0.0, weight_n, z_1, z_2], [0.0; 5]);
        let new = Largest { grows: Side::Between, before_m: 0.0 };
        let branches = friction.map_or(at_rest, |switch| at_rest.with(switch, Branch::Zero));
        let joint = joint_of(formula.place());
        let largest = formula.remembers().then_some(new);
        let asks_where = formula.depends_on(0);
        Self {
            program,
            joint,
            asks_where,
            weight_n,
            largest,
            friction,
            branches,
            carried,
            straight_below: 0.0,
        }
    }

    /// The same, going straight to what it is at rest below a rate where it is a root there, at a displacement or rotation of some size.
    ///
    /// A root rises without end at zero. What creeps under it follows in no time, at rates that are roundings: a wall that all but rests
    /// took steps of 1e-7 s, or none was short enough.
    #[must_use]
    pub(super) fn straight_below(self, rate: f64, size: f64) -> Self {
        let is_root = |q: f64, side: f64| {
            let state = self.state_anywhere(q, side * rate);
            let branches = self.program.branches_at(state, [0.0; 5]);
            let at = |share: f64| self.program.value(self.state_anywhere(q, side * share * rate), &branches);
            let [near, far] = [0.01, 1.0].map(|share| (at(share) - at(0.0)).abs() / share);
            near > STEEPEST * far
        };
        let places = [size, -size, 0.1 * size, -0.1 * size, 0.0];
        let root = places.into_iter().any(|q| is_root(q, 1.0) || is_root(q, -1.0));
        Self { straight_below: if root { rate } else { 0.0 }, ..self }
    }

    /// The variables at a displacement or rotation and its rate.
    pub(super) fn state(&self, q: f64, rate: f64) -> State {
        self.state_with(q, rate, self.carried.now)
    }

    /// The same with other values of the carried states.
    pub(super) fn state_with(&self, q: f64, rate: f64, [z_1, z_2]: [f64; MOST_STATES]) -> State {
        [q, rate, self.largest.map_or(self.weight_n, |largest| largest.at(q)), z_1, z_2]
    }

    /// How fast the third variable changes at a rate of displacement.
    pub(super) fn third_rate(&self, rate: f64) -> f64 {
        self.largest.map_or(0.0, |largest| largest.grows.sign() * rate)
    }

    /// Whether the third variable is a displacement that changes.
    pub(super) fn grows(&self) -> bool {
        self.largest.is_some_and(|largest| largest.grows != Side::Between)
    }

    /// The variables where the top may be farther out than it is known to have been.
    fn state_anywhere(&self, q: f64, rate: f64) -> State {
        let third = self.largest.map_or(self.weight_n, |largest| largest.before_m.max(q.abs()));
        let [z_1, z_2] = self.carried.now;
        [q, rate, third, z_1, z_2]
    }

    /// Force or moment on the wall, N or N m.
    #[inline]
    pub(super) fn value(&self, q: f64, rate: f64) -> f64 {
        if self.goes_straight(rate) {
            return self.straight(q, rate);
        }
        self.program.value(self.state(q, rate), &self.branches)
    }

    /// The same of one formula in the branches of the walls of a row.
    #[inline(always)]
    pub(super) fn values<F: Wide>(laws: [&Self; LANES], q: F, rate: F) -> F {
        let (simd, qs, rates) = (q.token(), q.numbers(), rate.numbers());
        let of = |i: usize| if i < F::LEN { laws[i].state(qs[i], rates[i]) } else { [0.0; VARIABLES] };
        let states: [State; LANES] = std::array::from_fn(of);
        let state = std::array::from_fn(|j| F::of_each(simd, |i| states[i][j]));
        let found = laws[0].program.values(state, laws.map(|law| &law.branches));
        if !(0..F::LEN).any(|i| laws[i].goes_straight(rates[i])) {
            return found;
        }
        let found = found.numbers();
        F::of_each(simd, |i| {
            if laws[i].goes_straight(rates[i]) { laws[i].straight(qs[i], rates[i]) } else { found[i] }
        })
    }

    /// Whether it is at a rate so low that it goes straight to what it is at rest.
    #[inline(always)]
    fn goes_straight(&self, rate: f64) -> bool {
        rate.abs() < self.straight_below
    }

    /// The same between rest and the rate from which it is as written.
    #[cold]
    fn straight(&self, q: f64, rate: f64) -> f64 {
        let [rest, there] = [0.0, self.straight_below.copysign(rate)]
            .map(|rate| self.program.value(self.state(q, rate), &self.branches));
        rest + (there - rest) * (rate.abs() / self.straight_below)
    }

    /// The same as it is written, whatever branch it is in.
    pub(super) fn as_written(&self, q: f64, rate: f64) -> f64 {
        self.program.value(self.state_anywhere(q, rate), &Branches::FREE)
    }

    /// The same at rest.
    pub(super) fn at_rest(&self) -> f64 {
        self.as_written(0.0, 0.0)
    }

    /// What friction can add to the force while it holds: the least and the most, N.
    pub(super) fn holds_n(&self, x_c_m: f64) -> [f64; 2] {
        let Some(switch) = self.friction else { return [0.0; 2] };
        let on = |side: Branch| self.program.value(self.state(x_c_m, 0.0), &self.branches.with(switch, side));
        let held = on(Branch::Zero);
        [on(Branch::Positive) - held, on(Branch::Negative) - held]
    }

    /// Stiffness and damping at a state, where they are finite and resist.
    pub(super) fn slopes_at(&self, q: f64, rate: f64) -> Pair {
        let state = self.state_anywhere(q, rate);
        let branches = self.program.branches_at(state, [rate, 0.0, 0.0, 0.0, 0.0]);
        let against = |rates: State| {
            let slope = -self.program.rate(state, rates, &branches);
            if slope.is_finite() { slope.max(0.0) } else { 0.0 }
        };
        let inside = against([1.0, 0.0, 0.0, 0.0, 0.0]);
        let outwards =
            if self.largest.is_some() { against([1.0, 0.0, 1f64.copysign(q), 0.0, 0.0]) } else { inside };
        // A state that follows the velocity is a stiffness: dF = F_z dz, of which dz is ż_v dx.
        let followed: State = self.follows(state, &branches);
        [inside.max(outwards) + against(followed), against([0.0, 1.0, 0.0, 0.0, 0.0])]
    }
}

#[cfg(test)]
mod tests {
    use mrbd_formula::Parameter;

    use super::*;

    fn law(text: &str, parameters: &[(&str, f64, &str)]) -> FormulaLaw {
        let own = parameters.iter().map(|(name, value, unit)| Parameter::new(name, *value, unit));
        let formula = Formula::parse(text, Place::Top, &own.collect::<Vec<_>>()).expect("a formula");
        FormulaLaw::new(&formula, 0.0, None, Carried::default()).straight_below(1e-6, 0.2)
    }

    #[test]
    fn analytic_a_root_of_the_velocity_goes_straight_to_zero() {
        for n in [0.3, 0.5, 0.9] {
            let root = law("-c*sign(v)*abs(v)**n", &[("c", 4e3, "N*(s/m)**n"), ("n", n, "")]);
            for side in [1.0, -1.0] {
                let branch = if side > 0.0 { Branch::Positive } else { Branch::Negative };
                let mut root = root.clone();
                root.branches = root.branches.with(0, branch);
                // As written from there on, and below in proportion; roundings of a power.
                let written = |v: f64| -side * 4e3 * v.powf(n);
                for (v, force_n) in
                    [(1e-2, written(1e-2)), (1e-6, written(1e-6)), (2.5e-7, 0.25 * written(1e-6))]
                {
                    let found_n = root.value(0.05, side * v);
                    assert!((found_n / force_n - 1.0).abs() < 1e-12, "{n} at {v}: {found_n}, {force_n}");
                }
                assert_eq!(root.value(0.05, 0.0), 0.0);
            }
        }
    }

    #[test]
    fn analytic_what_is_no_root_is_as_written_down_to_zero() {
        let c = |unit: &'static str| [("c", 2e3, unit), ("d", 0.1, "m/s")];
        for (text, unit) in [
            ("-c*v*(1 + abs(v)/d)", "N*s/m"),
            ("-c*tanh(v/d)", "N"),
            ("-c*sign(v)*(abs(v)/d)**1.5", "N"),
            ("-c*sign(v)*(abs(v)/d)**0.95", "N"),
            ("-c*v/(d + abs(v))", "N"),
        ] {
            assert_eq!(law(text, &c(unit)).straight_below, 0.0, "{text}");
        }
        assert_eq!(law("-c*sign(v)*sqrt(abs(v)/d)", &c("N")).straight_below, 1e-6);
    }
}
