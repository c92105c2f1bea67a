//! One step of the explicit Runge–Kutta pair of order 5 and 4 of Dormand and Prince
//! (J. Comput. Appl. Math. 6, 1980, 19–26; Table 2), for two coordinates of second order.

use super::quintic::Point;

/// Accelerations of the two coordinates, and the rates of two quadratures that ride along.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rate {
    /// Accelerations.
    pub acceleration: [f64; 2],
    /// Rates of the quadratures.
    pub quadrature: [f64; 2],
}

/// A step that was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Length, s.
    pub h: f64,
    /// Position, velocity and acceleration at the start.
    pub start: Point,
    /// The same at the end.
    pub end: Point,
    /// What the quadratures gained.
    pub quadrature: [f64; 2],
    /// Rates of the quadratures at the end.
    pub end_quadrature_rate: [f64; 2],
    /// Estimated error of the positions, in their unit.
    pub position_error: [f64; 2],
    /// Estimated error of the velocities, in their unit.
    pub velocity_error: [f64; 2],
}

/// Evaluations of a step whose start is known.
pub const STAGES: u64 = 6;

const C: [f64; 7] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
const A: [[f64; 6]; 7] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Weights of order 5 less those of order 4.
const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// The method; the last row of `A` is also its weights, so the last evaluation of a step is the first of the next.
#[derive(Debug, Clone, Copy, Default)]
pub struct DormandPrince;

impl DormandPrince {
    /// Steps from `start`, whose acceleration is known, over `h`.
    ///
    /// `rate` gives accelerations and quadrature rates at a time after the start, positions and velocities.
    #[inline]
    pub fn step(
        start: Point,
        start_quadrature_rate: [f64; 2],
        h: f64,
        mut rate: impl FnMut(f64, [f64; 2], [f64; 2]) -> Rate,
    ) -> Step {
        let mut v = [start.velocity; 7];
        let mut rates = [Rate::default(); 7];
        rates[0] = Rate { acceleration: start.acceleration, quadrature: start_quadrature_rate };
        let mut position;
        // Each stage has its own number of terms; written out so that the sums unroll.
        macro_rules! stage {
            ($n:literal) => {
                position = moved::<$n>(start.position, h, &A[$n], |j| v[j]);
                v[$n] = moved::<$n>(start.velocity, h, &A[$n], |j| rates[j].acceleration);
                rates[$n] = rate(C[$n] * h, position, v[$n]);
            };
        }
        stage!(1);
        stage!(2);
        stage!(3);
        stage!(4);
        stage!(5);
        stage!(6);
        let quadrature = moved::<6>([0.0; 2], h, &A[6], |j| rates[j].quadrature);
        Step {
            h,
            start,
            end: Point { position, velocity: v[6], acceleration: rates[6].acceleration },
            quadrature,
            end_quadrature_rate: rates[6].quadrature,
            position_error: moved::<7>([0.0; 2], h, &E, |j| v[j]),
            velocity_error: moved::<7>([0.0; 2], h, &E, |j| rates[j].acceleration),
        }
    }
}

/// x + h Σ w_j r_j over the first `N` rates.
#[inline(always)]
fn moved<const N: usize>(x: [f64; 2], h: f64, weights: &[f64], rate: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (j, weight) in weights.iter().enumerate().take(N) {
        let r = rate(j);
        sum = [sum[0] + weight * r[0], sum[1] + weight * r[1]];
    }
    [x[0] + h * sum[0], x[1] + h * sum[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_order_conditions_hold() {
        // Σ a_ij = c_i, and Σ b_i c_i^k = 1/(k+1) for k = 0..4; a few roundings.
        for stage in 1..7 {
            let sum: f64 = A[stage].iter().sum();
            assert!((sum - C[stage]).abs() < 1e-14, "row {stage}");
        }
        for k in 0..5 {
            let sum: f64 = (0..6).map(|j| A[6][j] * C[j].powi(k)).sum();
            assert!((sum - 1.0 / f64::from(k + 1)).abs() < 1e-14, "order {}", k + 1);
        }
        assert!(E.iter().sum::<f64>().abs() < 1e-15);
    }

    /// Largest error over ten seconds of x'' = -x, y'' = -4 y at a fixed step.
    fn oscillator_error(h: f64) -> f64 {
        let field = |_t: f64, x: [f64; 2], _v: [f64; 2]| Rate {
            acceleration: [-x[0], -4.0 * x[1]],
            quadrature: [0.0; 2],
        };
        let mut point = Point { position: [1.0, 0.0], velocity: [0.0, 2.0], acceleration: [-1.0, 0.0] };
        let steps = (10.0 / h).round() as usize;
        let mut worst = 0.0_f64;
        for n in 1..=steps {
            point = DormandPrince::step(point, [0.0; 2], h, field).end;
            let t = n as f64 * h;
            worst = worst.max((point.position[0] - t.cos()).abs());
            worst = worst.max((point.position[1] - (2.0 * t).sin()).abs());
        }
        worst
    }

    #[test]
    fn analytic_order_is_five() {
        let order = (oscillator_error(0.1) / oscillator_error(0.05)).log2();
        // Between the fifth order and the sixth that a linear oscillator can show.
        assert!((4.8..6.2).contains(&order), "observed order {order}");
    }
}
