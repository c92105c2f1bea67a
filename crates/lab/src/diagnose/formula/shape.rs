//! Shapes of single laws: how a force or moment follows displacement and velocity, but for its size.
//!
//! All are written in shares of the largest displacement q and velocity u that the tests reach. The force on the wall is
//! minus the value: of size 1 each resists, but for a weakening, which takes off what the floor resists. Some remember how
//! far the top has been: m is the largest |q| so far. Others carry a state z along, which has a rate of its own; time is in
//! shares of that in which q is passed at u.

/// A side of the wall's rest, or a direction of its motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// Towards +x.
    Positive,
    /// Towards −x.
    Negative,
}

impl Side {
    fn sign(self) -> f64 {
        match self {
            Side::Positive => 1.0,
            Side::Negative => -1.0,
        }
    }
}

/// A shape. Numbers of it stand in the order of [`Shape::numbers`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Shape {
    /// sgn(q) |q|^n.
    Spring,
    /// |q|^n: pushes one way on both sides.
    EvenSpring,
    /// max(±q, 0)^n, of the sign of q.
    OneSidedSpring(Side),
    /// max(±q − g, 0)^n, of the sign of q.
    Stop(Side),
    /// sgn(q) max(|q| − g, 0)^n.
    DeadZone,
    /// tanh(q/d).
    Saturation,
    /// (q/d)/(1 + |q|/d).
    SlowSaturation,
    /// q/d up to d, and 1 beyond.
    Clipped,
    /// sgn(u) |u|^n: friction at 0, a line at 1, drag at 2.
    Drag,
    /// |q|^p sgn(u) |u|^n.
    Opening,
    /// tanh(u/s).
    DragSaturation,
    /// (u/s)/(1 + |u|/s).
    SlowDragSaturation,
    /// sgn(u) exp(−|u|/s).
    Stribeck,
    /// u where ±q > g.
    DampedBeyond(Side),
    /// u where |q| > g.
    DampedFar,
    /// max(±u, 0)^n, of the sign of u.
    OneWay(Side),
    /// max(±q, 0)^p u.
    OneSidedOpening(Side),
    /// −q m/(d + m): the floor's spring, softer for good the farther it has been.
    Weakening,
    /// q/(d + m): a force that saturates, and goes back straight to rest.
    Secant,
    /// sgn(q) max(|q| − a m, 0): slack that grows.
    Slack,
    /// z of ż = u − z/τ: a spring behind a damper (Maxwell).
    Relaxing,
    /// z of ż = (u/d)(1 − |z|ⁿ (1 + sgn(u z))/2): a spring that yields smoothly (Bouc and Wen).
    Yielding,
}

/// A power of displacement or velocity, and the number of the shape that it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// The exponent.
    pub value: f64,
    /// By its place among the numbers; `None` where it is 1 always.
    pub number: Option<usize>,
}

/// What a number of a shape is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// An exponent.
    Exponent,
    /// A displacement or rotation.
    Displacement,
    /// A velocity.
    Velocity,
    /// A share of a displacement.
    Share,
    /// A time.
    Time,
}

/// A number of a shape: its letter, what it is, and the values that are looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeNumber {
    /// Its letter.
    pub letter: &'static str,
    /// What it is.
    pub meaning: Meaning,
    /// Values of the exhaustive search, increasing; the bounds of every fit are the first and the last.
    pub grid: &'static [f64],
}

const fn exponent(grid: &'static [f64]) -> ShapeNumber {
    ShapeNumber { letter: "n", meaning: Meaning::Exponent, grid }
}

const fn threshold(letter: &'static str, grid: &'static [f64]) -> ShapeNumber {
    ShapeNumber { letter, meaning: Meaning::Displacement, grid }
}

const fn speed(grid: &'static [f64]) -> ShapeNumber {
    ShapeNumber { letter: "s", meaning: Meaning::Velocity, grid }
}

const SPRING: &[ShapeNumber] =
    &[exponent(&[0.3, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0])];
const EVEN: &[ShapeNumber] = &[exponent(&[0.5, 1.0, 1.5, 2.0, 3.0, 4.0])];
const ONE_SIDED: &[ShapeNumber] = &[exponent(&[0.5, 1.0, 1.5, 2.0, 3.0, 4.0])];
/// Thresholds lie inside what was excited: beyond the last there is too little to see.
const THRESHOLDS: &[f64] = &[0.04, 0.08, 0.13, 0.2, 0.28, 0.36, 0.45, 0.54, 0.63, 0.72, 0.8, 0.87];
const STOP: &[ShapeNumber] = &[threshold("g", THRESHOLDS), exponent(&[0.75, 1.0, 1.5, 2.0, 2.5])];
const WIDTHS: &[f64] = &[0.03, 0.06, 0.1, 0.16, 0.25, 0.4, 0.63, 1.0, 1.6, 2.5];
const SATURATION: &[ShapeNumber] = &[threshold("d", WIDTHS)];
const CLIPPED: &[ShapeNumber] = &[threshold("d", THRESHOLDS)];
const DRAG: &[ShapeNumber] =
    &[exponent(&[0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0])];
const OPENING: &[ShapeNumber] = &[
    ShapeNumber { letter: "p", meaning: Meaning::Exponent, grid: &[0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0] },
    exponent(&[0.0, 0.5, 1.0, 1.5, 2.0, 3.0]),
];
const SPEEDS: &[ShapeNumber] = &[speed(WIDTHS)];
const BEYOND: &[ShapeNumber] = &[threshold("g", THRESHOLDS)];
const ONE_WAY: &[ShapeNumber] = &[exponent(&[0.5, 1.0, 1.5, 2.0, 3.0])];
const ONE_SIDED_OPENING: &[ShapeNumber] =
    &[ShapeNumber { letter: "p", meaning: Meaning::Exponent, grid: &[0.3, 0.5, 1.0, 1.5, 2.0, 3.0] }];

const SCALES: &[ShapeNumber] = &[threshold("g", &[0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0])];
const SECANT: &[ShapeNumber] = &[threshold("g", WIDTHS)];
const SLACK: &[ShapeNumber] = &[ShapeNumber {
    letter: "a",
    meaning: Meaning::Share,
    grid: &[0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
}];

/// Times in which a force relaxes: one that does so faster is a damper, one that does so more slowly a spring.
const RELAXING: &[ShapeNumber] = &[ShapeNumber {
    letter: "tau",
    meaning: Meaning::Time,
    grid: &[0.1, 0.17, 0.3, 0.5, 0.9, 1.5, 2.7, 4.6, 8.0],
}];
const YIELDING: &[ShapeNumber] = &[
    threshold("d", &[0.03, 0.05, 0.08, 0.13, 0.2, 0.28, 0.36, 0.45, 0.54, 0.63]),
    exponent(&[0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0]),
];

impl Shape {
    /// Every shape.
    pub const ALL: [Self; 27] = [
        Self::Spring,
        Self::EvenSpring,
        Self::OneSidedSpring(Side::Positive),
        Self::OneSidedSpring(Side::Negative),
        Self::Stop(Side::Positive),
        Self::Stop(Side::Negative),
        Self::DeadZone,
        Self::Saturation,
        Self::SlowSaturation,
        Self::Clipped,
        Self::Drag,
        Self::Opening,
        Self::DragSaturation,
        Self::SlowDragSaturation,
        Self::Stribeck,
        Self::DampedBeyond(Side::Positive),
        Self::DampedBeyond(Side::Negative),
        Self::DampedFar,
        Self::OneWay(Side::Positive),
        Self::OneWay(Side::Negative),
        Self::OneSidedOpening(Side::Positive),
        Self::OneSidedOpening(Side::Negative),
        Self::Weakening,
        Self::Secant,
        Self::Slack,
        Self::Relaxing,
        Self::Yielding,
    ];

    /// The shapes that are looked for at joints, where laws are simpler and the tests tell less.
    pub const AT_JOINTS: [Self; 6] = [
        Self::Spring,
        Self::Saturation,
        Self::SlowSaturation,
        Self::Drag,
        Self::Opening,
        Self::DragSaturation,
    ];

    /// Whether walls have it often: other shapes must gain more.
    pub fn is_common(self) -> bool {
        match self {
            Self::Spring
            | Self::OneSidedSpring(_)
            | Self::Stop(_)
            | Self::DeadZone
            | Self::Saturation
            | Self::Drag
            | Self::Opening
            | Self::DragSaturation => true,
            Self::EvenSpring
            | Self::SlowSaturation
            | Self::Clipped
            | Self::SlowDragSaturation
            | Self::Stribeck
            | Self::DampedBeyond(_)
            | Self::DampedFar
            | Self::OneWay(_)
            | Self::OneSidedOpening(_)
            | Self::Weakening
            | Self::Secant
            | Self::Slack
            | Self::Relaxing
            | Self::Yielding => false,
        }
    }

    /// Whether it depends on how far the top has been, or carries a state along. It then takes energy for good where its size is
    /// positive.
    pub fn remembers(self) -> bool {
        matches!(self, Self::Weakening | Self::Secant | Self::Slack) || self.carries()
    }

    /// Whether it carries a state along.
    pub fn carries(self) -> bool {
        matches!(self, Self::Relaxing | Self::Yielding)
    }

    /// The state after one of z, where a displacement changes by dq within a time; both in shares.
    pub fn carried(self, [first, second]: [f64; 2], z: f64, dq: f64, time: f64) -> f64 {
        match self {
            Self::Relaxing => {
                let decay = (-time / first).exp();
                z * decay + dq * first / time * (1.0 - decay)
            }
            Self::Yielding => {
                // By the middle of short parts: a force that yields depends on the path, not on time.
                let parts = (dq.abs() / (PART * first)).ceil().clamp(1.0, MOST_PARTS);
                let part = dq / (parts * first);
                let rate = |z: f64| match dq * z > 0.0 {
                    true => 1.0 - z.abs().powf(second),
                    false => 1.0,
                };
                let after = |z: f64| (z + part * rate(z + 0.5 * part * rate(z))).clamp(-1.0, 1.0);
                (0..parts as usize).fold(z, |z, _| after(z))
            }
            _ => 0.0,
        }
    }

    /// Its numbers but for its size.
    pub fn numbers(self) -> &'static [ShapeNumber] {
        match self {
            Self::Spring => SPRING,
            Self::EvenSpring => EVEN,
            Self::OneSidedSpring(_) => ONE_SIDED,
            Self::Stop(_) | Self::DeadZone => STOP,
            Self::Saturation | Self::SlowSaturation => SATURATION,
            Self::Clipped => CLIPPED,
            Self::Drag => DRAG,
            Self::Opening => OPENING,
            Self::DragSaturation | Self::SlowDragSaturation | Self::Stribeck => SPEEDS,
            Self::DampedBeyond(_) | Self::DampedFar => BEYOND,
            Self::OneWay(_) => ONE_WAY,
            Self::OneSidedOpening(_) => ONE_SIDED_OPENING,
            Self::Weakening => SCALES,
            Self::Secant => SECANT,
            Self::Slack => SLACK,
            Self::Relaxing => RELAXING,
            Self::Yielding => YIELDING,
        }
    }

    /// Whether velocity enters: such a law takes energy from the wall, of whatever size it may be, and never gives any.
    pub fn is_damper(self) -> bool {
        match self {
            Self::Spring
            | Self::EvenSpring
            | Self::OneSidedSpring(_)
            | Self::Stop(_)
            | Self::DeadZone
            | Self::Saturation
            | Self::SlowSaturation
            | Self::Clipped
            | Self::Weakening
            | Self::Secant
            | Self::Slack
            | Self::Relaxing
            | Self::Yielding => false,
            Self::Drag
            | Self::Opening
            | Self::DragSaturation
            | Self::SlowDragSaturation
            | Self::Stribeck
            | Self::DampedBeyond(_)
            | Self::DampedFar
            | Self::OneWay(_)
            | Self::OneSidedOpening(_) => true,
        }
    }

    /// The powers of displacement and velocity that its value is proportional to; `None` where it is none.
    pub fn powers(self, [first, second]: [f64; 2]) -> [Option<Power>; 2] {
        let of = |number: usize, value: f64| Some(Power { value, number: Some(number) });
        let line = Some(Power { value: 1.0, number: None });
        match self {
            Self::Spring | Self::EvenSpring | Self::OneSidedSpring(_) => [of(0, first), None],
            Self::Stop(_) | Self::DeadZone => [of(1, second), None],
            Self::Drag | Self::OneWay(_) => [None, of(0, first)],
            Self::Opening => [of(0, first), of(1, second)],
            Self::OneSidedOpening(_) => [of(0, first), line],
            Self::DampedBeyond(_) | Self::DampedFar => [None, line],
            Self::Weakening | Self::Slack | Self::Relaxing => [line, None],
            Self::Saturation
            | Self::SlowSaturation
            | Self::Clipped
            | Self::DragSaturation
            | Self::SlowDragSaturation
            | Self::Stribeck
            | Self::Secant
            | Self::Yielding => [None, None],
        }
    }

    /// Its value at a displacement, a velocity, and the largest displacement so far, as shares of the largest of all. Of a shape that
    /// carries a state the state stands in the place of the largest displacement.
    pub fn value(self, numbers: [f64; 2], [q, u, m]: [f64; 3]) -> f64 {
        let [first, second] = numbers;
        let power = |x: f64, n: f64| if n == 0.0 { 1.0 } else { x.powf(n) };
        // 0⁰ = 1 would be a friction that acts at rest.
        let odd = |x: f64, n: f64| if x == 0.0 { 0.0 } else { x.signum() * power(x.abs(), n) };
        let one_side = |side: Side, x: f64, n: f64| {
            let x = side.sign() * x;
            if x > 0.0 { side.sign() * power(x, n) } else { 0.0 }
        };
        match self {
            Self::Spring => odd(q, first),
            Self::EvenSpring => power(q.abs(), first),
            Self::OneSidedSpring(side) => one_side(side, q, first),
            Self::Stop(side) => one_side(side, q - side.sign() * first, second),
            Self::DeadZone => odd(q.signum() * (q.abs() - first).max(0.0), second),
            Self::Saturation => (q / first).tanh(),
            Self::SlowSaturation => q / (first + q.abs()),
            Self::Clipped => (q / first).clamp(-1.0, 1.0),
            Self::Drag => odd(u, first),
            Self::Opening => power(q.abs(), first) * odd(u, second),
            Self::DragSaturation => (u / first).tanh(),
            Self::SlowDragSaturation => u / (first + u.abs()),
            Self::Stribeck => odd(u, 0.0) * (-u.abs() / first).exp(),
            Self::DampedBeyond(side) => {
                if side.sign() * q > first {
                    u
                } else {
                    0.0
                }
            }
            Self::DampedFar => {
                if q.abs() > first {
                    u
                } else {
                    0.0
                }
            }
            Self::OneWay(side) => one_side(side, u, first),
            Self::OneSidedOpening(side) => one_side(side, q, first).abs() * u,
            Self::Weakening => -q * m / (first + m),
            Self::Secant => q / (first + m),
            Self::Slack => q.signum() * (q.abs() - first * m).max(0.0),
            Self::Relaxing | Self::Yielding => m,
        }
    }
}

/// Length of a part of a path over which a force yields, as a share of the displacement at which it does ...
const PART: f64 = 0.1;
/// ... and parts of a path between two samples at most.
const MOST_PARTS: f64 = 64.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_dampers_of_every_shape_only_take_energy() {
        for shape in Shape::ALL.into_iter().filter(|shape| shape.is_damper()) {
            for numbers in corners(shape) {
                for (q, u) in motion() {
                    let power = shape.value(numbers, [q, u, 1.0]) * u;
                    assert!(power >= 0.0, "{shape:?} {numbers:?} at {q}, {u}: {power}");
                }
            }
        }
    }

    #[test]
    fn analytic_springs_of_every_shape_do_not_feel_velocity() {
        for shape in Shape::ALL.into_iter().filter(|shape| !shape.is_damper()) {
            for numbers in corners(shape) {
                for (q, u) in motion() {
                    assert_eq!(
                        shape.value(numbers, [q, u, 1.0]),
                        shape.value(numbers, [q, 0.3, 1.0]),
                        "{shape:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn analytic_shapes_are_what_their_words_say() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{a} and {b}");
        near(Shape::Spring.value([3.0, 0.0], [-0.5, 0.0, 0.6]), -0.125);
        near(Shape::Stop(Side::Negative).value([0.2, 2.0], [-0.5, 0.0, 0.6]), -0.09);
        near(Shape::Stop(Side::Negative).value([0.2, 2.0], [0.5, 0.0, 0.6]), 0.0);
        near(Shape::DeadZone.value([0.2, 1.0], [-0.5, 0.0, 0.6]), -0.3);
        near(Shape::Drag.value([0.5, 0.0], [0.0, -0.25, 0.6]), -0.5);
        near(Shape::Opening.value([1.0, 2.0], [-0.5, 0.5, 0.6]), 0.125);
        near(Shape::DampedBeyond(Side::Positive).value([0.2, 0.0], [0.3, -0.5, 0.6]), -0.5);
        near(Shape::Weakening.value([0.6, 0.0], [0.5, 0.0, 0.6]), -0.25);
        near(Shape::Secant.value([0.4, 0.0], [-0.5, 0.0, 0.6]), -0.5);
        near(Shape::Slack.value([0.5, 0.0], [-0.5, 0.0, 0.6]), -0.2);
        near(Shape::OneWay(Side::Negative).value([2.0, 0.0], [0.0, -0.5, 0.6]), -0.25);
    }

    #[test]
    fn analytic_shapes_with_memory_take_energy_over_every_cycle() {
        for shape in Shape::ALL.into_iter().filter(|shape| shape.remembers()) {
            for numbers in corners(shape) {
                // Each piece takes its length.
                let mut z = 0.0;
                // Out to ever more, and back: the work against the force, over paths of straight pieces.
                let turns = [0.0, 0.3, -0.2, 0.7, -0.9, 1.0, 0.0];
                let (mut m, mut work) = (0.0_f64, 0.0);
                for ends in turns.windows(2) {
                    let at = |k: u32| ends[0] + (ends[1] - ends[0]) * (f64::from(k) + 0.5) / 1e4;
                    let dq = (ends[1] - ends[0]) / 1e4;
                    for q in (0..10_000).map(at) {
                        m = m.max(q.abs());
                        let third = if shape.carries() { z + 0.5 * dq } else { m };
                        work += shape.value(numbers, [q, 0.0, third]) * dq;
                        z = shape.carried(numbers, z, dq, dq.abs());
                    }
                }
                assert!(work > 0.0, "{shape:?} {numbers:?}: {work}");
            }
        }
    }

    fn corners(shape: Shape) -> Vec<[f64; 2]> {
        let ends = |i: usize| shape.numbers().get(i).map_or(vec![0.0], |n| n.grid.to_vec());
        ends(0).into_iter().flat_map(|a| ends(1).into_iter().map(move |b| [a, b])).collect()
    }

    fn motion() -> impl Iterator<Item = (f64, f64)> {
        let shares = [-1.0, -0.6, -0.1, 0.0, 0.1, 0.6, 1.0];
        shares.into_iter().flat_map(move |q| shares.into_iter().map(move |u| (q, u)))
    }
}
