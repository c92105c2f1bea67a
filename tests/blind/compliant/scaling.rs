//! The coefficients C_l under the law `contact`, as a jump once the corners have taken up an impact.
//!
//! Corners that push and do not bounce make impacts plastic by themselves, C_l = 1. What else a coefficient takes away is
//! taken when the impact is over: of the velocities after it, u is the part that remains if every joint that touched
//! sticks (the projection in the mass metric), and v becomes u + C_l (v - u).

use nalgebra::{MatrixXx6, Vector6};

use super::bodies::{Bodies, Pose};
use super::rosenbrock::State;
use super::wall::{CORNERS, JOINTS};

/// Time after which an impact is over, in those of the corners at the ground.
const WAITING: f64 = 0.5;
/// A joint that opens slower than this after an impact counts as closed, rad/s: the ground, and the crack, which trembles ...
const CLOSED_BELOW_RAD_S: [f64; 2] = [1e-4, 1e-3];
/// ... by a hundredth of the rate at which the wall goes on: slower than twice that it is closed too.
const TREMBLES: f64 = 0.02;
/// A joint turned by more than this is open, rad: ten times what it gives before it opens.
const OPEN_ABOVE_RAD: f64 = 2e-5;

/// Watches the joints for impacts.
#[derive(Debug, Clone)]
pub struct Scaling {
    coefficients: [f64; 8],
    fading_s_per_m: f64,
    wait_s: f64,
    /// Signs of the joints before the impact under way, or now.
    signs: [i8; 2],
    pressed: [[bool; 2]; 2],
    under_way: Option<Impact>,
}

#[derive(Debug, Clone, Copy)]
struct Impact {
    over_s: f64,
    touched: [bool; 2],
    /// At which the fastest edge came down, m/s.
    speed_m_s: f64,
}

impl Scaling {
    pub fn new(bodies: &Bodies) -> Self {
        Self {
            coefficients: bodies.wall.coefficients,
            fading_s_per_m: bodies.wall.fading_s_per_m,
            wait_s: WAITING * bodies.corners[0].impact_s(),
            signs: [0; 2],
            pressed: [[true; 2]; 2],
            under_way: None,
        }
    }

    /// Looks at the end of a step; scales the velocities and says so where an impact is over.
    pub fn look(&mut self, bodies: &Bodies, time_s: f64, state: &mut State) -> bool {
        if self.coefficients == [1.0; 8] && self.fading_s_per_m == 0.0 {
            return false;
        }
        let pose = Pose::new(&state.q, &state.v);
        let pressed = JOINTS.map(|joint| CORNERS.map(|side| bodies.relative(joint, side, &pose).gap_m < 0.0));
        for joint in JOINTS {
            let touches = |side: usize| pressed[joint][side] && !self.pressed[joint][side];
            let closing = match self.signs[joint] {
                1 => touches(0),
                -1 => touches(1),
                _ => false,
            };
            if closing {
                let over_s = time_s + self.wait_s;
                let new = Impact { over_s, touched: [false; 2], speed_m_s: 0.0 };
                let impact = self.under_way.get_or_insert(new);
                impact.touched[joint] = true;
                impact.speed_m_s = impact.speed_m_s.max(speed_m_s(bodies, joint, state));
            }
        }
        self.pressed = pressed;
        match self.under_way {
            None => {
                self.signs = JOINTS.map(|joint| sign_of_pressed(pressed[joint]).unwrap_or(self.signs[joint]));
                false
            }
            Some(impact) if time_s >= impact.over_s => {
                self.under_way = None;
                self.finish(bodies, impact, state)
            }
            Some(_) => false,
        }
    }

    fn finish(&mut self, bodies: &Bodies, impact: Impact, state: &mut State) -> bool {
        let from = self.signs;
        self.signs = signs_after(state);
        let Some(change) = change(from, self.signs) else { return false };
        let coefficient = self.coefficients[change] * (-self.fading_s_per_m * impact.speed_m_s).exp();
        let stuck = sticking(bodies, from, impact.touched, state);
        let before = state.v.fixed_rows::<6>(0).into_owned();
        let after = stuck + coefficient * (before - stuck);
        state.v.fixed_rows_mut::<6>(0).copy_from(&after);
        coefficient != 1.0
    }
}

/// At which the edge of a joint comes down, m/s.
fn speed_m_s(bodies: &Bodies, joint: usize, state: &State) -> f64 {
    let [left, right] = bodies.wall.corner_x_m[joint];
    let rates = [state.v[2], state.v[5] - state.v[2]];
    (right - left) * rates[joint].abs()
}

/// The corner a joint turns about, 0 where both are pressed; none while the joint is in the air.
fn sign_of_pressed([left, right]: [bool; 2]) -> Option<i8> {
    match (left, right) {
        (true, true) => Some(0),
        (false, true) => Some(1),
        (true, false) => Some(-1),
        (false, false) => None,
    }
}

/// The signs after an impact, when corners that stay may still tremble: by angle, by velocity where there is none yet.
fn signs_after(state: &State) -> [i8; 2] {
    let angle = [state.q[2], state.q[5] - state.q[2]];
    let rate = [state.v[2], state.v[5] - state.v[2]];
    let closed_below_rad_s = [CLOSED_BELOW_RAD_S[0], CLOSED_BELOW_RAD_S[1].max(TREMBLES * rate[0].abs())];
    JOINTS.map(|joint| {
        if angle[joint].abs() > OPEN_ABOVE_RAD {
            angle[joint].signum() as i8
        } else if rate[joint].abs() > closed_below_rad_s[joint] {
            rate[joint].signum() as i8
        } else {
            0
        }
    })
}

/// Number of the paper's pattern: both corners on the same side, on opposite sides, crack closed.
fn pattern([ground, crack]: [i8; 2]) -> Option<u8> {
    match (ground, crack) {
        (0, _) => None,
        (_, 0) => Some(3),
        (g, c) if g == c => Some(1),
        _ => Some(2),
    }
}

/// Position in the paper's Table 2 of a change of pattern that `contact` can scale; the last two end in sticking.
fn change(from: [i8; 2], to: [i8; 2]) -> Option<usize> {
    match (pattern(from)?, pattern(to)?, from[0] == to[0]) {
        (1, 2, true) => Some(0),
        (2, 1, true) => Some(1),
        (1, 2, false) => Some(2),
        (2, 1, false) => Some(3),
        (3, 1, false) => Some(4),
        (3, 3, false) => Some(5),
        _ => None,
    }
}

/// The velocities projected onto those at which every joint that was closed or touched sticks, the others on their corner.
fn sticking(bodies: &Bodies, from: [i8; 2], touched: [bool; 2], state: &State) -> Vector6<f64> {
    let mut rows = Vec::new();
    for joint in JOINTS {
        let [left, right] = CORNERS.map(|side| bodies.rows(joint, side, &state.q));
        if touched[joint] || from[joint] == 0 {
            // Both corners stay, and the joint does not slide.
            rows.extend([left[0], right[0], left[1]]);
        } else {
            rows.extend(if from[joint] > 0 { right } else { left });
        }
    }
    let j = MatrixXx6::from_rows(&rows);
    let velocity = state.v.fixed_rows::<6>(0).into_owned();
    let spread = bodies.inverse_mass(&state.q) * j.transpose();
    let impulse = (&j * &spread).lu().solve(&(&j * velocity)).expect("the corners' rows are independent");
    velocity - spread * impulse
}

#[cfg(test)]
mod tests {
    #[test]
    fn analytic_a_crack_that_trembles_after_an_impact_is_closed() {
        use super::super::Coordinates;
        use super::{State, signs_after};
        // The signs after an impact of a wall that goes on at this rate, its crack at another.
        let signs = |ground_rad_s: f64, crack_rad_s: f64| {
            let mut state = State { q: Coordinates::zeros(), v: Coordinates::zeros() };
            (state.q[2], state.q[5]) = (-2.5e-5, -2.52e-5);
            (state.v[2], state.v[5]) = (ground_rad_s, ground_rad_s + crack_rad_s);
            signs_after(&state)
        };
        // As met in a façade on a stiff floor, fast and slow.
        assert_eq!(signs(-0.125, 0.00113), [-1, 0]);
        assert_eq!(signs(-0.005, 0.0005), [-1, 0]);
        assert_eq!(signs(-0.125, 0.01), [-1, 1]);
        assert_eq!(signs(-0.125, -0.01), [-1, -1]);
    }
}
