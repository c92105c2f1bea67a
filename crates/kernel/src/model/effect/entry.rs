//! What the catalogue says of a kind of effect: its place, its role, its numbers, its law.

use serde::{Serialize, Serializer};

use super::Effect;
use super::sums::EffectSums;

/// Where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// At C, on the top of the wall.
    Top,
    /// At one of the joints.
    Joint,
    /// At impacts.
    Impacts,
    /// In the motion of the ground.
    GroundMotion,
    /// In the reading of the rotations, not in the wall.
    Sensor,
}

/// What an effect is in the mechanics of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A mass.
    Mass,
    /// A force or moment in proportion to a rate.
    Damper,
    /// A force that holds the top, or resists its sliding.
    Friction,
    /// A force that depends on the displacement alone.
    Spring,
    /// A spring that keeps a plastic displacement: its force depends on the path.
    Memory,
    /// Another place of the rocking corners.
    Corners,
    /// A bed of springs in a joint, in place of a sharp edge.
    Bed,
    /// Another law of a joint in place of a sharp edge: a rival of beds.
    JointLaw,
    /// Factors on the coefficients C_l of impacts.
    Impact,
    /// A factor on them that depends on the speed.
    ImpactSpeed,
    /// Another ground motion than the recorded one.
    GroundMotion,
    /// Another reading of the same motion.
    Sensor,
}

impl Role {
    /// Whether it acts at impacts, and between them not at all.
    pub fn is_at_impacts(self) -> bool {
        matches!(self, Role::Impact | Role::ImpactSpeed)
    }
}

/// Whether walls with an effect may step side by side, in the lanes of vector registers.
///
/// The lanes do not do the sums of every law. A wall with an effect that they do not know steps alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lanes {
    /// The lanes do all sums of the law.
    Known,
    /// The lanes do the sums of the law while the top slides, not while it is held.
    WhileSliding,
    /// The lanes do not do the sums of the law.
    Unknown,
}

/// What a number of an effect measures: its unit, and what a size that matters follows from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A mass at the top, kg.
    TopMass,
    /// A force at the top, N.
    TopForce,
    /// A force at the top per displacement, N/m.
    TopStiffness,
    /// A force at the top per cube of the displacement, N/m³.
    TopCubicStiffness,
    /// A force at the top per velocity, N s/m.
    TopDamping,
    /// A displacement of the top, m.
    TopDisplacement,
    /// A moment at a joint per rate of its opening, N m s/rad.
    JointDamping,
    /// A stiffness of a joint per area, Pa/m.
    BedStiffness,
    /// A share of the width between two rocking corners, m.
    CornerWidth,
    /// A radius of a rocking edge, m.
    EdgeRadius,
    /// A rotation across a joint at which its law changes, rad.
    JointRotation,
    /// A share of the moment of sharp edges.
    MomentShare,
    /// A strength in compression, Pa.
    Strength,
    /// A rotation, rad.
    Rotation,
    /// A time, s.
    Time,
    /// A gain, or a ratio of two motions.
    Ratio,
    /// A factor on a coefficient C_l of impacts.
    ImpactFactor,
    /// By what share, per speed of an impact, a coefficient C_l is less, s/m.
    ImpactFading,
}

impl Quantity {
    /// The unit; empty for a ratio.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::TopMass => "kg",
            Quantity::TopForce => "N",
            Quantity::TopStiffness => "N/m",
            Quantity::TopCubicStiffness => "N/m³",
            Quantity::TopDamping => "N s/m",
            Quantity::TopDisplacement | Quantity::CornerWidth | Quantity::EdgeRadius => "m",
            Quantity::JointDamping => "N m s/rad",
            Quantity::BedStiffness => "Pa/m",
            Quantity::Strength => "Pa",
            Quantity::Rotation | Quantity::JointRotation => "rad",
            Quantity::Time => "s",
            Quantity::ImpactFading => "s/m",
            Quantity::Ratio | Quantity::ImpactFactor | Quantity::MomentShare => "",
        }
    }
}

/// As its unit.
impl Serialize for Quantity {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.unit())
    }
}

/// A number that a kind of effect takes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EffectParameter {
    /// Its key in wall files; `factors.3` is the fourth number of the list `factors`.
    pub key: &'static str,
    /// What it measures, from which its unit follows.
    #[serde(rename = "unit")]
    pub quantity: Quantity,
    /// The value at which the effect does nothing: the wall moves to the bit as without it.
    #[serde(skip)]
    pub neutral: f64,
    /// Whether wall files may leave it out; it is neutral then.
    #[serde(skip)]
    pub optional: bool,
    /// The least value allowed.
    pub least: f64,
    /// The largest value allowed.
    pub most: f64,
    /// A value as it might be, for examples.
    pub example: f64,
    /// What it means.
    pub meaning: &'static str,
}

impl EffectParameter {
    /// Its unit; empty for a ratio.
    pub fn unit(&self) -> &'static str {
        self.quantity.unit()
    }
}

/// A word that a kind of effect takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct EffectChoice {
    /// Its key in wall files.
    pub key: &'static str,
    /// The words allowed.
    pub options: &'static [&'static str],
    /// What it means.
    pub meaning: &'static str,
}

/// All that the catalogue says of one kind of effect.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct EffectEntry {
    /// The `kind` in wall files.
    pub name: &'static str,
    /// Where it acts.
    pub place: Place,
    /// What it is in the mechanics of the wall.
    #[serde(skip)]
    pub role: Role,
    /// Whether a wall with it may step side by side with others.
    #[serde(skip)]
    pub lanes: Lanes,
    /// The word it takes, if any.
    pub choice: Option<EffectChoice>,
    /// The numbers it takes.
    pub parameters: &'static [EffectParameter],
    /// Whether a wall may have several: their laws then add up, factors multiply.
    pub may_repeat: bool,
    /// The law as a formula.
    pub law: &'static str,
    /// What it is, in plain words.
    pub description: &'static str,
    /// What of a measured motion it goes with, between impacts.
    pub fingerprint: &'static str,
    /// What it does at impacts.
    pub at_impacts: &'static str,
    /// What it is easily taken for: kinds, or keys of the wall file.
    pub confused_with: &'static [&'static str],
    /// The measurement that shows it by itself, whatever the tests say.
    pub told_by: &'static str,
    /// The law: adds an effect of this kind to the sums of a wall.
    #[serde(skip)]
    pub(super) add: fn(&Effect, &mut EffectSums),
}
