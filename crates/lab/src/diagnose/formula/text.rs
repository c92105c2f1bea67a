//! How each shape is written.

use super::shape::{Shape, Side};

/// Displacement and velocity as they are written, and the numbers of the shape: letters, or exact exponents.
pub struct Names<'n> {
    /// Displacement.
    pub x: &'n str,
    /// Velocity.
    pub v: &'n str,
    /// The carried state.
    pub z: &'n str,
    /// Numbers of the shape.
    pub numbers: &'n [Number<'n>; 2],
}

/// A number of a shape as it is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Number<'n> {
    /// A parameter.
    Named(&'n str),
    /// A number.
    Exact(f64),
}

impl Number<'_> {
    fn is(self, value: f64) -> bool {
        self == Number::Exact(value)
    }

    /// As it is written.
    pub fn text(self) -> String {
        match self {
            Number::Named(name) => name.to_owned(),
            Number::Exact(value) => value.to_string(),
        }
    }
}

/// The force on the wall by a shape with this coefficient: sign and product.
pub fn force(shape: Shape, coefficient: &str, names: &Names) -> String {
    let (against, value) = signed(shape, names);
    let sign = if against { "-" } else { "" };
    format!("{sign}{coefficient}*{value}")
}

/// Whether the force has a minus before it, and what follows the coefficient.
fn signed(shape: Shape, Names { x, v, z, numbers: [first, second] }: &Names) -> (bool, String) {
    let on = |side: Side, x: &str, beyond: Option<&str>| match (side, beyond) {
        (Side::Positive, None) => format!("max({x},0)"),
        (Side::Negative, None) => format!("max(-{x},0)"),
        (Side::Positive, Some(g)) => format!("max({x}-{g},0)"),
        (Side::Negative, Some(g)) => format!("max(-{x}-{g},0)"),
    };
    let text = first.text();
    match shape {
        Shape::Spring => (true, odd(x, *first)),
        Shape::EvenSpring => (true, power(&format!("abs({x})"), *first)),
        Shape::OneSidedSpring(side) => (side == Side::Positive, power(&on(side, x, None), *first)),
        Shape::Stop(side) => (side == Side::Positive, power(&on(side, x, Some(&text)), *second)),
        Shape::DeadZone => {
            let opened = power(&format!("max(abs({x})-{text},0)"), *second);
            (true, format!("sign({x})*{opened}"))
        }
        Shape::Saturation => (true, format!("tanh({x}/{text})")),
        Shape::SlowSaturation => (true, format!("{x}/({text}+abs({x}))")),
        Shape::Clipped => (true, format!("max(min({x}/{text},1),-1)")),
        Shape::Drag => (true, odd(v, *first)),
        Shape::Opening => (true, format!("{}*{}", power(&format!("abs({x})"), *first), odd(v, *second))),
        Shape::DragSaturation => (true, format!("tanh({v}/{text})")),
        Shape::SlowDragSaturation => (true, format!("{v}/({text}+abs({v}))")),
        Shape::Stribeck => (true, format!("sign({v})*exp(-abs({v})/{text})")),
        Shape::DampedBeyond(Side::Positive) => (true, format!("({x}>{text})*{v}")),
        Shape::DampedBeyond(Side::Negative) => (true, format!("({x}<-{text})*{v}")),
        Shape::DampedFar => (true, format!("(abs({x})>{text})*{v}")),
        Shape::OneWay(side) => (side == Side::Positive, power(&on(side, v, None), *first)),
        Shape::OneSidedOpening(side) => (true, format!("{}*{v}", power(&on(side, x, None), *first))),
        Shape::Weakening => (false, format!("{x}*x_max/({text}+x_max)")),
        Shape::Secant => (true, format!("{x}/({text}+x_max)")),
        Shape::Slack => (true, format!("sign({x})*max(abs({x})-{text}*x_max,0)")),
        Shape::Relaxing | Shape::Yielding => (true, (*z).to_owned()),
    }
}

/// The rate of the state that a shape carries along.
pub fn rate(shape: Shape, Names { v, z, numbers: [first, second], .. }: &Names) -> Option<String> {
    let text = first.text();
    match shape {
        Shape::Relaxing => Some(format!("{v}-{z}/{text}")),
        Shape::Yielding => {
            Some(format!("{v}/{text}*(1-{}*(1+sign({v}*{z}))/2)", power(&format!("abs({z})"), *second)))
        }
        _ => None,
    }
}

/// What is never negative, to a power.
fn power(base: &str, exponent: Number) -> String {
    match exponent {
        n if n.is(1.0) => base.to_owned(),
        n if n.is(0.5) => format!("sqrt({base})"),
        n => format!("{base}**{}", n.text()),
    }
}

/// A power with the sign of its base.
fn odd(x: &str, exponent: Number) -> String {
    match exponent {
        n if n.is(0.0) => format!("sign({x})"),
        n if n.is(1.0) => x.to_owned(),
        n if n.is(2.0) => format!("{x}*abs({x})"),
        n if n.is(3.0) || n.is(5.0) || n.is(7.0) => format!("{x}**{}", n.text()),
        n => format!("sign({x})*{}", power(&format!("abs({x})"), n)),
    }
}
