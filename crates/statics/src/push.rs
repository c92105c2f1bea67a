//! A slow push: force against displacement of a wall, from rest until it falls.
//!
//! The displacement of the loaded place is given, the force follows. At each displacement the wall takes the rotations
//! at which its potential energy is least beside those before: weights lifted, springs at the top, what the joints store and lose.
//! Sharp joints make kinks of the energy. A wall sits in such a kink while a joint is closed.

use crate::chain::{Chain, Moved, Moves};
use crate::restraint::Restraint;

/// Where a wall is pushed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// A point force at the middle of the crack; of an uncracked wall at its top.
    Crack,
    /// A uniform acceleration: a force at each mass.
    Uniform,
    /// A point force at the top.
    Top,
}

impl Load {
    /// Name on the command line and in result files.
    pub fn name(self) -> &'static str {
        match self {
            Load::Crack => "crack",
            Load::Uniform => "uniform",
            Load::Top => "top",
        }
    }

    /// The displacement on which the force works; of a uniform acceleration the mean over the masses.
    fn moved(self, chain: &Chain, moves: &Moves) -> Moved {
        match self {
            Load::Crack => moves.crack[0],
            Load::Top => moves.top[0],
            Load::Uniform => {
                let (sum, weight_n) = (chain.pushed(moves), chain.pushing_n());
                Moved { by_m: sum.by_m / weight_n, slope_m: sum.slope_m.map(|slope| slope / weight_n) }
            }
        }
    }
}

/// A wall in equilibrium under a push.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Displacement of the loaded place, m; of a uniform acceleration the mean over the masses.
    pub displacement_m: f64,
    /// Displacement of the middle of the crack, m.
    pub crack_m: f64,
    /// Displacement of the top, m.
    pub top_m: f64,
    /// Rotations of the bodies, rad.
    pub theta_rad: [f64; 2],
    /// Force, N; of a uniform acceleration the sum over the masses.
    pub force_n: f64,
}

/// A push from rest until the force vanishes, or the wall counts as fallen.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// States in order, the first at rest.
    pub points: Vec<Point>,
    /// The state of the largest force.
    pub peak: Point,
    /// The state after the largest at which the force vanishes; `None` where the wall fell before.
    pub end: Option<Point>,
}

/// Displacements over the thickness: a first one, where steps become even, and the length of those.
const FIRST: f64 = 1e-9;
const EVEN_FROM: f64 = 0.01;
const STEP: f64 = 0.01;
/// Steps up to `EVEN_FROM`: seven decades.
const STEPS_OF_LOG: u32 = 56;
/// Even steps at most: ten thicknesses.
const MOST_STEPS: u32 = 1000;
/// Halvings of a step about a peak or an end: 1e-9 of a step.
const HALVINGS: u32 = 40;
/// Rotations that are the same, rad: 1e-16 of a height is less than a rounding of it.
const SAME_RAD: f64 = 1e-17;
/// Openings of the crack beyond which no equilibrium is looked for, rad.
const MOST_OPENING_RAD: f64 = 1.5;

/// A wall, what holds it, and where it is pushed.
#[derive(Debug, Clone)]
pub struct Push {
    /// The bodies.
    pub chain: Chain,
    /// What holds the top.
    pub restraint: Restraint,
    /// Where it is pushed.
    pub load: Load,
    /// Rotations at which it counts as fallen, rad.
    pub fallen_rad: [f64; 2],
}

/// Rotations at a displacement: what they leave unbalanced, and the force.
#[derive(Debug, Clone, Copy)]
struct Trial {
    theta_rad: [f64; 2],
    /// Work of opening the crack at this displacement, J/rad.
    unbalanced_j: f64,
    force_n: f64,
}

/// A state and what its springs remember.
#[derive(Debug, Clone, Copy)]
struct State {
    point: Point,
    plastic_m: f64,
}

impl Push {
    /// Pushes the wall from rest.
    pub fn curve(&self) -> Curve {
        let states = self.states();
        let peak = self.peak(&states);
        let end = self.end(&states);
        let mut points: Vec<Point> = states.iter().map(|state| state.point).collect();
        if let Some(end) = end {
            points.pop();
            points.push(end);
        }
        Curve { points, peak, end }
    }

    /// States from rest on. Off the middle a load on a bed leans the wall; what takes no push to get there is left out.
    fn states(&self) -> Vec<State> {
        let mut states = vec![self.rest()];
        let mut before = self.rest();
        for displacement_m in self.displacements_m() {
            let Some(state) = self.next(&before, displacement_m) else { break };
            let (holds, has_held) = (state.point.force_n > 0.0, states.len() > 1);
            if holds || has_held {
                states.push(state);
            }
            let has_fallen = (0..2).any(|i| state.point.theta_rad[i].abs() >= self.fallen_rad[i]);
            if has_fallen || (has_held && !holds) {
                break;
            }
            before = state;
        }
        states
    }

    fn rest(&self) -> State {
        let point =
            Point { displacement_m: 0.0, crack_m: 0.0, top_m: 0.0, theta_rad: [0.0; 2], force_n: 0.0 };
        State { point, plastic_m: 0.0 }
    }

    /// Ever longer steps from a billionth of the thickness on, then even ones.
    fn displacements_m(&self) -> impl Iterator<Item = f64> + use<> {
        let width_m = self.chain.joints[0].width_m;
        let growth = (EVEN_FROM / FIRST).powf(1.0 / f64::from(STEPS_OF_LOG));
        let first = (0..STEPS_OF_LOG).map(move |i| FIRST * growth.powi(i as i32));
        let even = (0..MOST_STEPS).map(|i| EVEN_FROM + STEP * f64::from(i));
        first.chain(even).map(move |share| share * width_m)
    }

    /// The state at a displacement, beside one at another.
    fn next(&self, before: &State, displacement_m: f64) -> Option<State> {
        let trial = self.balanced(before, displacement_m)?;
        let moves = self.chain.moves(trial.theta_rad, sides(trial.theta_rad));
        let top_m = moves.top[0].by_m;
        let point = Point {
            displacement_m,
            crack_m: moves.crack[0].by_m,
            top_m,
            theta_rad: trial.theta_rad,
            force_n: trial.force_n,
        };
        Some(State { point, plastic_m: self.restraint.plastic_m(before.plastic_m, top_m) })
    }

    /// The rotations at which nothing is unbalanced, beside those before.
    fn balanced(&self, before: &State, displacement_m: f64) -> Option<Trial> {
        let [theta_1, theta_2] = before.point.theta_rad;
        let opening = theta_2 - theta_1;
        let at = |opening: f64| self.trial(displacement_m, opening, theta_1, before.plastic_m);
        if !self.chain.cracked {
            return at(0.0);
        }
        let [mut low, mut high] = bracket(opening, &at)?;
        loop {
            let middle = 0.5 * (low.0 + high.0);
            if high.0 - low.0 < SAME_RAD || middle <= low.0 || middle >= high.0 {
                break;
            }
            let trial = at(middle)?;
            if trial.unbalanced_j > 0.0 { high = (middle, trial) } else { low = (middle, trial) }
        }
        Some(between(&low.1, &high.1))
    }

    /// The wall with its loaded place at a displacement and its crack opened so far.
    ///
    /// ∂Π/∂θ_i = F ∂X/∂θ_i at rest: the two equations give the force, and what is unbalanced where they differ.
    fn trial(&self, displacement_m: f64, opening: f64, theta_1: f64, plastic_m: f64) -> Option<Trial> {
        let theta_1 = self.lower_rotation(displacement_m, opening, theta_1)?;
        let theta_rad = [theta_1, theta_1 + opening];
        let moves = self.chain.moves(theta_rad, sides(theta_rad));
        let [lower_j, upper_j] = self.work_slopes_j(theta_rad, opening, &moves, plastic_m);
        let [lower_m, upper_m] = self.load.moved(&self.chain, &moves).slope_m;
        let force_n = (lower_j + upper_j) / (lower_m + upper_m);
        Some(Trial { theta_rad, unbalanced_j: upper_j - force_n * upper_m, force_n })
    }

    /// ∂Π/∂θ_1 and ∂Π/∂θ_2, J/rad.
    fn work_slopes_j(&self, theta: [f64; 2], opening: f64, moves: &Moves, plastic_m: f64) -> [f64; 2] {
        let lifted = self.chain.lifted(moves).slope_m;
        let top = moves.top[0];
        let pull_n = self.restraint.force_n(&self.chain, top.by_m, plastic_m);
        let [ground, crack] = &self.chain.joints;
        let crack_n_m = if self.chain.cracked { crack.lacking_moment_n_m(opening) } else { 0.0 };
        let ground_n_m = ground.lacking_moment_n_m(theta[0]);
        [
            lifted[0] - pull_n * top.slope_m[0] + ground_n_m - crack_n_m,
            lifted[1] - pull_n * top.slope_m[1] + crack_n_m,
        ]
    }

    /// θ_1 at which the loaded place is displaced so far, by Newton's method.
    fn lower_rotation(&self, displacement_m: f64, opening: f64, from: f64) -> Option<f64> {
        let mut theta_1 = from;
        for _ in 0..50 {
            let theta_rad = [theta_1, theta_1 + opening];
            let moved = self.load.moved(&self.chain, &self.chain.moves(theta_rad, sides(theta_rad)));
            let change = (moved.by_m - displacement_m) / (moved.slope_m[0] + moved.slope_m[1]);
            theta_1 -= change;
            if change.abs() <= 1e-15 * theta_1.abs().max(SAME_RAD) {
                break;
            }
        }
        theta_1.is_finite().then_some(theta_1).filter(|theta| theta.abs() < MOST_OPENING_RAD)
    }

    /// The largest force: that of a state, or between it and its neighbours.
    fn peak(&self, states: &[State]) -> Point {
        let largest = |best: usize, i: usize| {
            if states[i].point.force_n > states[best].point.force_n { i } else { best }
        };
        let at = (1..states.len()).fold(0, largest);
        let (first, last) = (at.saturating_sub(1), (at + 1).min(states.len() - 1));
        let mut ends = [first, last].map(|i| states[i].point.displacement_m);
        let mut best = states[at].point;
        for _ in 0..HALVINGS {
            let thirds = [1.0 / 3.0, 2.0 / 3.0].map(|share| ends[0] + share * (ends[1] - ends[0]));
            let found = thirds.map(|displacement_m| self.next(&states[first], displacement_m));
            let [Some(left), Some(right)] = found else { break };
            let rises = right.point.force_n > left.point.force_n;
            let higher = if rises { right.point } else { left.point };
            ends = if rises { [thirds[0], ends[1]] } else { [ends[0], thirds[1]] };
            if higher.force_n > best.force_n {
                best = higher;
            }
        }
        best
    }

    /// Where the force vanishes, between the last two states.
    fn end(&self, states: &[State]) -> Option<Point> {
        let [.., before, after] = states else { return None };
        if after.point.force_n > 0.0 || states.len() < 3 {
            return None;
        }
        let mut ends = [before, after].map(|state| state.point.displacement_m);
        let mut found = after.point;
        for _ in 0..HALVINGS {
            let middle = self.next(before, 0.5 * (ends[0] + ends[1]))?.point;
            let place = usize::from(middle.force_n <= 0.0);
            ends[place] = middle.displacement_m;
            found = if place == 1 { middle } else { found };
        }
        // Nothing but a rounding of the halvings is left.
        Some(Point { force_n: 0.0, ..found })
    }
}

/// The corners that the joints turn about: those towards which they open.
fn sides([theta_1, theta_2]: [f64; 2]) -> [f64; 2] {
    [theta_1, theta_2 - theta_1].map(|phi| if phi < 0.0 { -1.0 } else { 1.0 })
}

/// Two openings, the lower one too small for balance and the other too large, around one that is near balance.
fn bracket(opening: f64, at: &impl Fn(f64) -> Option<Trial>) -> Option<[(f64, Trial); 2]> {
    let first = at(opening)?;
    let towards = if first.unbalanced_j > 0.0 { -1.0 } else { 1.0 };
    let (mut near, mut step) = ((opening, first), 1e-12);
    while step < MOST_OPENING_RAD {
        let opening = near.0 + towards * step;
        let far = (opening, at(opening)?);
        if (far.1.unbalanced_j > 0.0) != (first.unbalanced_j > 0.0) {
            return Some(if towards > 0.0 { [near, far] } else { [far, near] });
        }
        (near, step) = (far, 4.0 * step);
    }
    None
}

/// The trial between two that enclose balance: of a joint that stays closed, both sides of its kink by their shares.
fn between(low: &Trial, high: &Trial) -> Trial {
    let range = high.unbalanced_j - low.unbalanced_j;
    let share = if range > 0.0 { -low.unbalanced_j / range } else { 0.5 };
    let mixed = |a: f64, b: f64| a + share * (b - a);
    Trial {
        theta_rad: [0, 1].map(|i| mixed(low.theta_rad[i], high.theta_rad[i])),
        unbalanced_j: 0.0,
        force_n: mixed(low.force_n, high.force_n),
    }
}
