//! One step of an explicit Runge–Kutta–Nyström method of order 6 for two coordinates of second order.
//!
//! Nodes, position and quadrature weights are those of the pair RKN6(4)6FM of Dormand, El-Mikkawy and Prince
//! (IMA J. Numer. Anal. 7, 1987, 235–250), made for accelerations that do not depend on velocities. Those of
//! a rocking wall do, a little: centripetal terms, dampers. So the velocities of the stages fulfil every
//! condition up to order 5 with one or two such dependences. `benches/work_precision.rs` has the method
//! beside others.

use std::ops::Mul;

use wide::f64x2;

use super::quintic::Point;
use crate::fused::fused_pair;

/// Values side by side that a step moves: the two coordinates of one motion, or those of several motions.
pub trait Values: Copy + Mul<f64, Output = Self> {
    /// The length of a step: one, or one for each motion.
    type Length: Copy + Mul<Output = Self::Length> + Mul<f64, Output = Self::Length>;

    /// Times a length, or a product of lengths.
    fn over(self, length: Self::Length) -> Self;

    /// Times a length, or a product of lengths, and another, rounded once.
    fn over_plus(self, length: Self::Length, other: Self) -> Self;

    /// Times a number, and another, rounded once.
    fn times_plus(self, factor: f64, other: Self) -> Self;
}

impl Values for f64x2 {
    type Length = f64;

    #[inline(always)]
    fn over(self, length: f64) -> Self {
        self * length
    }

    #[inline(always)]
    fn over_plus(self, length: f64, other: Self) -> Self {
        fused_pair(self, f64x2::splat(length), other)
    }

    #[inline(always)]
    fn times_plus(self, factor: f64, other: Self) -> Self {
        fused_pair(self, f64x2::splat(factor), other)
    }
}

/// Accelerations of the two coordinates, and the rates of two quadratures that ride along.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rate<V = f64x2> {
    /// Accelerations.
    pub acceleration: V,
    /// PointVelocities of the quadratures.
    pub quadrature: V,
}

/// What moves the coordinates over a step.
pub trait Field<V: Values = f64x2> {
    /// Accelerations and quadrature rates at a time after the start of the step, positions and velocities.
    fn rate(&mut self, after_s: V::Length, position: V, velocity: V) -> Rate<V>;

    /// The same at the end of the step, whose positions are those of the call of [`Field::rate`] before.
    fn land(&mut self, after_s: V::Length, position: V, velocity: V) -> Rate<V>;
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
    /// PointVelocities of the quadratures at the end.
    pub end_quadrature_rate: [f64; 2],
    /// Estimated error of the positions of the embedded method of order 4, in their unit.
    pub position_error: [f64; 2],
    /// Estimated error of its velocities, in their unit.
    pub velocity_error: [f64; 2],
}

/// Evaluations of a step whose start is known; the last two are at one position.
pub const STAGES: u64 = 6;

const C: [f64; 6] = [0.0, 1.0 / 10.0, 3.0 / 10.0, 7.0 / 10.0, 17.0 / 25.0, 1.0];
/// Weights of accelerations for the positions of the stages; the last row is that of the step itself.
const A_POSITION: [[f64; 5]; 6] = [
    [0.0; 5],
    [1.0 / 200.0, 0.0, 0.0, 0.0, 0.0],
    [-1.0 / 2200.0, 1.0 / 22.0, 0.0, 0.0, 0.0],
    [637.0 / 6600.0, -7.0 / 110.0, 7.0 / 33.0, 0.0, 0.0],
    [225437.0 / 1968750.0, -30073.0 / 281250.0, 65569.0 / 281250.0, -9367.0 / 984375.0, 0.0],
    [151.0 / 2142.0, 5.0 / 116.0, 385.0 / 1368.0, 55.0 / 168.0, -6250.0 / 28101.0],
];
/// Weights of accelerations for the velocities of the stages.
const A_VELOCITY: [[f64; 5]; 6] = [
    [0.0; 5],
    [1.0 / 10.0, 0.0, 0.0, 0.0, 0.0],
    [-9.0 / 55.0, 51.0 / 110.0, 0.0, 0.0, 0.0],
    [28.0 / 165.0, -49.0 / 110.0, 161.0 / 165.0, 0.0, 0.0],
    [6392.0 / 140625.0, -233189.0 / 562500.0, 1283279.0 / 1125000.0, -103037.0 / 1125000.0, 0.0],
    [-284.0 / 1071.0, 685.0 / 1044.0, 155.0 / 1368.0, 1595.0 / 504.0, -25000.0 / 9367.0],
];
/// Weights of accelerations for the velocities of the step, and of the rates of quadratures.
const B: [f64; 6] =
    [151.0 / 2142.0, 25.0 / 522.0, 275.0 / 684.0, 275.0 / 252.0, -78125.0 / 112404.0, 1.0 / 12.0];
/// `B` less the weights of order 4 …
const E_VELOCITY: [f64; 5] = [
    165817.0 / 2677500.0,
    -165817.0 / 1305000.0,
    165817.0 / 1710000.0,
    165817.0 / 630000.0,
    -165817.0 / 562020.0,
];
/// … and the same for positions: 1 - c_j times as much.
const E_POSITION: [f64; 5] = [
    165817.0 / 2677500.0,
    -165817.0 / 1450000.0,
    1160719.0 / 17100000.0,
    165817.0 / 2100000.0,
    -331634.0 / 3512625.0,
];

/// The method.
#[derive(Debug, Clone, Copy, Default)]
pub struct Nystrom;

/// A step of values side by side.
#[derive(Debug, Clone, Copy)]
pub struct Stride<V> {
    /// Positions at the end.
    pub position: V,
    /// Velocities at the end.
    pub velocity: V,
    /// Accelerations and rates of the quadratures at the end.
    pub end: Rate<V>,
    /// What the quadratures gained.
    pub quadrature: V,
    /// As [`Step::position_error`].
    pub position_error: V,
    /// As [`Step::velocity_error`].
    pub velocity_error: V,
}

impl Nystrom {
    /// Steps one motion from `start`, whose acceleration is known, over `h`.
    #[inline(always)]
    pub fn step(start: &Point, start_quadrature_rate: [f64; 2], h: f64, field: &mut impl Field) -> Step {
        let (x, v) = (f64x2::new(start.position), f64x2::new(start.velocity));
        let rate = Rate {
            acceleration: f64x2::new(start.acceleration),
            quadrature: f64x2::new(start_quadrature_rate),
        };
        let stride = Self::stride(x, v, rate, h, field);
        Step {
            h,
            start: *start,
            end: Point {
                position: stride.position.to_array(),
                velocity: stride.velocity.to_array(),
                acceleration: stride.end.acceleration.to_array(),
            },
            quadrature: stride.quadrature.to_array(),
            end_quadrature_rate: stride.end.quadrature.to_array(),
            position_error: stride.position_error.to_array(),
            velocity_error: stride.velocity_error.to_array(),
        }
    }

    /// Steps values side by side from positions `x` and velocities `v`, where their rates are known, over `h`.
    ///
    /// The last stage is at the positions of the end, but at velocities that are good to order 3 only. An
    /// acceleration kept from there would bring the order down. So the field is evaluated once more at the
    /// velocities of the end.
    #[inline(always)]
    pub fn stride<V: Values>(
        x: V,
        v: V,
        start: Rate<V>,
        h: V::Length,
        field: &mut impl Field<V>,
    ) -> Stride<V> {
        let mut accelerations = [start.acceleration; 6];
        let mut quadratures = [start.quadrature; 6];
        let h2 = h * h;
        let mut position;
        // Each stage has its own number of terms; written out so that the sums unroll.
        macro_rules! stage {
            ($n:literal) => {
                position = sum::<$n, V>(v.over_plus(h * C[$n], x), h2, &A_POSITION[$n], &accelerations);
                let velocity = sum::<$n, V>(v, h, &A_VELOCITY[$n], &accelerations);
                let now = field.rate(h * C[$n], position, velocity);
                accelerations[$n] = now.acceleration;
                quadratures[$n] = now.quadrature;
            };
        }
        stage!(1);
        stage!(2);
        stage!(3);
        stage!(4);
        stage!(5);
        let velocity = sum::<6, V>(v, h, &B, &accelerations);
        let end = field.land(h, position, velocity);
        Stride {
            position,
            velocity,
            end,
            quadrature: gain::<6, V>(h, &B, &quadratures),
            position_error: gain::<5, V>(h2, &E_POSITION, &accelerations),
            velocity_error: gain::<5, V>(h, &E_VELOCITY, &accelerations),
        }
    }
}

/// x + f Σ w_j r_j over the first `N` rates. Only one product with a sum waits for the last of them.
#[inline(always)]
fn sum<const N: usize, V: Values>(x: V, factor: V::Length, weights: &[f64], rates: &[V; 6]) -> V {
    let before = if N == 1 { x } else { earlier::<N, V>(weights, rates).over_plus(factor, x) };
    rates[N - 1].over_plus(factor * weights[N - 1], before)
}

/// The same from zero.
#[inline(always)]
fn gain<const N: usize, V: Values>(factor: V::Length, weights: &[f64], rates: &[V; 6]) -> V {
    rates[N - 1].over_plus(factor * weights[N - 1], earlier::<N, V>(weights, rates).over(factor))
}

/// Σ w_j r_j over the first rates of `N`, without the last.
#[inline(always)]
fn earlier<const N: usize, V: Values>(weights: &[f64], rates: &[V; 6]) -> V {
    let mut sum = rates[0] * weights[0];
    for j in 1..N - 1 {
        sum = rates[j].times_plus(weights[j], sum);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ_i b_i c_i^p Σ_j w_ij c_j^m for a matrix of weights.
    fn moment(weights: &[[f64; 5]; 6], p: i32, m: i32) -> f64 {
        let inner = |i: usize| (0..5).map(|j| weights[i][j] * C[j].powi(m)).sum::<f64>();
        (0..6).map(|i| B[i] * C[i].powi(p) * inner(i)).sum()
    }

    #[test]
    fn published_order_conditions_hold() {
        // A few roundings of weights up to six.
        let same = |found: f64, expected: f64, what: &str| {
            assert!((found - expected).abs() < 4e-15, "{what}: {found} against {expected}")
        };
        for (i, c) in C.into_iter().enumerate() {
            same(A_POSITION[i].iter().sum(), 0.5 * c * c, "a row of positions");
            same(A_VELOCITY[i].iter().sum(), c, "a row of velocities");
        }
        for k in 0..6 {
            let found: f64 = (0..6).map(|j| B[j] * C[j].powi(k)).sum();
            same(found, 1.0 / f64::from(k + 1), "quadrature");
        }
        // Order 6 in the positions: the integral over a step of t^p times the double integral of t^m.
        for (p, m) in [(0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (2, 1)] {
            let expected = 1.0 / f64::from((m + 1) * (m + 2) * (m + p + 3));
            same(moment(&A_POSITION, p, m), expected, "positions");
        }
        // Order 5 in the velocities: t^p times the integral of t^m.
        for (p, m) in [(0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (2, 1)] {
            same(moment(&A_VELOCITY, p, m), 1.0 / f64::from((m + 1) * (m + p + 2)), "velocities");
        }
        // Velocities that depend on velocities: Σ b_i a_ij a_jk c_k^m.
        for m in [1, 2] {
            let inner = |j: usize| (0..5).map(|k| A_VELOCITY[j][k] * C[k].powi(m)).sum::<f64>();
            let middle = |i: usize| (0..5).map(|j| A_VELOCITY[i][j] * inner(j)).sum::<f64>();
            let found = (0..6).map(|i| B[i] * middle(i)).sum();
            same(found, 1.0 / f64::from((m + 1) * (m + 2) * (m + 3)), "velocities of velocities");
        }
        assert!(E_VELOCITY.iter().sum::<f64>().abs() < 1e-15);
        assert!(E_POSITION.iter().sum::<f64>().abs() < 1e-15);
    }

    /// x'' = -x - d x', y'' = -4 y - d y'.
    struct Oscillators {
        damping: f64,
    }

    impl Field for Oscillators {
        fn rate(&mut self, _: f64, x: f64x2, v: f64x2) -> Rate {
            Rate { acceleration: -x * f64x2::new([1.0, 4.0]) - v * self.damping, ..Rate::default() }
        }

        fn land(&mut self, after_s: f64, x: f64x2, v: f64x2) -> Rate {
            self.rate(after_s, x, v)
        }
    }

    /// Largest error over ten seconds of the oscillators at a fixed step.
    fn oscillator_error(damping: f64, h: f64) -> f64 {
        let exact = |frequency: f64, t: f64| {
            let w = (frequency * frequency - damping * damping / 4.0).sqrt();
            (-damping * t / 2.0).exp() * (w * t).sin() / w
        };
        let mut point =
            Point { position: [0.0; 2], velocity: [1.0, 1.0], acceleration: [-damping, -damping] };
        let steps = (10.0 / h).round() as usize;
        let mut worst = 0.0_f64;
        for n in 1..=steps {
            point = Nystrom::step(&point, [0.0; 2], h, &mut Oscillators { damping }).end;
            let t = n as f64 * h;
            worst = worst.max((point.position[0] - exact(1.0, t)).abs());
            worst = worst.max((point.position[1] - exact(2.0, t)).abs());
        }
        worst
    }

    #[test]
    fn analytic_order_is_six_and_five_with_damping() {
        let order = |damping: f64| (oscillator_error(damping, 0.2) / oscillator_error(damping, 0.1)).log2();
        // Half an order either way. At these steps the next terms of the error are up to a fifth of the
        // first.
        assert!((5.5..6.5).contains(&order(0.0)), "undamped {}", order(0.0));
        assert!((4.5..5.5).contains(&order(0.2)), "damped {}", order(0.2));
    }
}
