//! One step of the L-stable Rosenbrock method of order 2 with an estimate of its error.
//!
//! Shampine, L. F. and Reichelt, M. W. (1997), The MATLAB ODE Suite, SIAM J. Sci. Comput. 18, section 3.2 ("ode23s"),
//! written for q'' = a(t, q, q'): of the doubled system only a matrix of the size of q is factorised.

use nalgebra::SMatrix;

use super::Coordinates;

type Square = SMatrix<f64, 7, 7>;

/// Places and velocities.
#[derive(Debug, Clone, Copy)]
pub struct State {
    pub q: Coordinates,
    pub v: Coordinates,
}

/// Derivatives of the accelerations at the start of a step.
#[derive(Debug, Clone, Copy)]
pub struct Slopes {
    by_q: Square,
    by_v: Square,
    by_time: Coordinates,
}

impl Slopes {
    /// By differences: forces are piecewise smooth, and accelerations are good to twelve digits.
    pub fn new(
        acceleration: &impl Fn(f64, &Coordinates, &Coordinates) -> Coordinates,
        time_s: f64,
        state: &State,
        here: &Coordinates,
    ) -> Self {
        const STEP_Q: f64 = 1e-10;
        const STEP_V: f64 = 1e-7;
        const STEP_TIME_S: f64 = 1e-5;
        let mut slopes = Self { by_q: Square::zeros(), by_v: Square::zeros(), by_time: Coordinates::zeros() };
        for k in 0..7 {
            let mut moved = *state;
            moved.q[k] += STEP_Q;
            slopes.by_q.set_column(k, &((acceleration(time_s, &moved.q, &moved.v) - here) / STEP_Q));
            let mut moved = *state;
            moved.v[k] += STEP_V;
            slopes.by_v.set_column(k, &((acceleration(time_s, &moved.q, &moved.v) - here) / STEP_V));
        }
        slopes.by_time = (acceleration(time_s + STEP_TIME_S, &state.q, &state.v) - here) / STEP_TIME_S;
        slopes
    }
}

/// What a step gave.
#[derive(Debug, Clone, Copy)]
pub struct Tried {
    pub state: State,
    /// Estimated errors of places and velocities.
    pub error: State,
}

/// Tries one step; none where the step's matrix is singular.
pub fn step(
    acceleration: &impl Fn(f64, &Coordinates, &Coordinates) -> Coordinates,
    time_s: f64,
    h: f64,
    from: &State,
    a_0: &Coordinates,
    slopes: &Slopes,
) -> Option<Tried> {
    let d = 1.0 / (2.0 + std::f64::consts::SQRT_2);
    let e_32 = 6.0 + std::f64::consts::SQRT_2;
    let hd = h * d;
    let w = (Square::identity() - hd * slopes.by_v - hd * hd * slopes.by_q).lu();
    // (I - hd J) k = r for the doubled system, r = (r_q, r_v).
    let solve = |r_q: Coordinates, r_v: Coordinates| {
        let k_v = w.solve(&(r_v + hd * (slopes.by_q * r_q)))?;
        Some((r_q + hd * k_v, k_v))
    };
    let (k1_q, k1_v) = solve(from.v, a_0 + hd * slopes.by_time)?;
    let half = State { q: from.q + 0.5 * h * k1_q, v: from.v + 0.5 * h * k1_v };
    let f1 = (half.v, acceleration(time_s + 0.5 * h, &half.q, &half.v));
    let (s_q, s_v) = solve(f1.0 - k1_q, f1.1 - k1_v)?;
    let (k2_q, k2_v) = (s_q + k1_q, s_v + k1_v);
    let end = State { q: from.q + h * k2_q, v: from.v + h * k2_v };
    let a_2 = acceleration(time_s + h, &end.q, &end.v);
    let (k3_q, k3_v) = solve(
        end.v - e_32 * (k2_q - f1.0) - 2.0 * (k1_q - from.v),
        a_2 - e_32 * (k2_v - f1.1) - 2.0 * (k1_v - a_0) + hd * slopes.by_time,
    )?;
    let sixth = h / 6.0;
    let error = State { q: sixth * (k1_q - 2.0 * k2_q + k3_q), v: sixth * (k1_v - 2.0 * k2_v + k3_v) };
    Some(Tried { state: end, error })
}
