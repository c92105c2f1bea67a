//! A law that no catalogue has: its shape, its numbers, and how it is written.
//!
//! | module | idea |
//! | --- | --- |
//! | [`Shape`] | how a force follows displacement and velocity, but for its size |
//! | [`Law`] | one atom or two, each a shape with a size and numbers, at a place |
//! | [`Curve`] | a force without a formula, knot by knot |
//! | [`Written`] | a law as a formula of the wall file, with the units of its parameters |

mod curve;
mod effect;
mod exact;
mod law;
mod shape;
mod text;
mod written;

pub use curve::{BOTH, Curve, Part, SIDE};
pub use exact::{leaves_exponents_open, nearest_exact};
pub use law::{Atom, Law, LawSlot};
pub use shape::{Meaning, Shape, ShapeNumber, Side};
pub use written::{Written, WrittenParameter, WrittenState};

/// Where a law acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Site {
    /// A horizontal force at the top, N, by x and v.
    Top,
    /// A moment at the ground, N m, by θ_1 and its velocity.
    Ground,
    /// A moment between the bodies at the crack, N m, by φ = θ_2 − θ_1 and its velocity.
    Crack,
}

impl Site {
    /// Every site.
    pub const ALL: [Self; 3] = [Self::Top, Self::Ground, Self::Crack];

    /// Its name in answers and in wall files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Top => "top",
            Self::Ground => "ground",
            Self::Crack => "crack",
        }
    }

    /// Unit of what a law gives there.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Top => "N",
            Self::Ground | Self::Crack => "N*m",
        }
    }

    /// Displacement and velocity, by their names in formulas.
    pub fn variables(self) -> [&'static str; 2] {
        match self {
            Self::Top => ["x", "v"],
            Self::Ground | Self::Crack => ["phi", "w"],
        }
    }

    /// Both as keys of answers.
    pub fn columns(self) -> [&'static str; 2] {
        match self {
            Self::Top => ["x_m", "v_m_s"],
            Self::Ground | Self::Crack => ["phi_rad", "w_rad_s"],
        }
    }

    /// Unit of a number of a shape there; empty of a pure number.
    pub fn unit_of(self, meaning: Meaning) -> &'static str {
        let [displacement, velocity] = self.motion_units();
        match meaning {
            Meaning::Exponent | Meaning::Share => "",
            Meaning::Displacement => displacement,
            Meaning::Velocity => velocity,
            Meaning::Time => "s",
        }
    }

    /// Units of both.
    pub fn motion_units(self) -> [&'static str; 2] {
        match self {
            Self::Top => ["m", "m/s"],
            Self::Ground | Self::Crack => ["rad", "rad/s"],
        }
    }
}
