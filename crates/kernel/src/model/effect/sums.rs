//! The sums of all effects of a wall, and which effects a wall can have.

use std::borrow::Cow;

use super::super::contact::Joint;
use super::super::parameters::WallParameters;
use super::super::wall::ImpossibleWall;
use super::{Effect, EffectKind, Lanes, Role};
use crate::written;

/// Everything the effects of a wall add to it; without effects, nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EffectSums {
    /// Added to m_dp, kg.
    pub carriage_mass_kg: f64,
    /// c at the top, N s/m.
    pub viscous_n_s_per_m: f64,
    /// k_3, N/m³.
    pub cubic_n_per_m3: f64,
    /// F_c of dry friction at the top, N.
    pub friction_n: f64,
    /// Half the slack of the floor's spring, m.
    pub gap_half_width_m: f64,
    /// Stiffness of springs that act at negative and at positive displacements of the top only, N/m.
    pub one_sided_n_per_m: [f64; 2],
    /// Spring that yields.
    pub yielding: Option<Yielding>,
    /// c at the ground and at the crack, N m s/rad.
    pub joint_damping_n_m_s: [f64; 2],
    /// How far the corners at the ground and at the crack lie inwards, both corners of a joint together, m.
    pub indentation_m: [f64; 2],
    /// Laws of the joints at the ground and at the crack in place of sharp edges.
    pub joints: [Option<SaidOfJoint>; 2],
    /// Factors on C_1 … C_8.
    pub impact_factors: [f64; 8],
    /// b of the factor exp(-b u) on all of them at a speed u of an impact, s/m.
    pub impact_fading_s_per_m: f64,
    /// What becomes of the record.
    pub ground: GroundChange,
    /// What becomes of the rotations when they are read.
    pub reading: Reading,
    /// What the lanes do of all these sums together.
    pub lanes: Lanes,
}

/// An elastic spring of limited force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Yielding {
    pub stiffness_n_per_m: f64,
    pub force_n: f64,
}

impl Yielding {
    /// Largest elastic displacement x_y, m.
    pub fn elastic_m(&self) -> f64 {
        self.force_n / self.stiffness_n_per_m
    }

    /// The plastic displacement, m, moved to where the spring holds no more than its force at a displacement.
    pub fn plastic_m(&self, before_m: f64, x_c_m: f64) -> f64 {
        before_m.max(x_c_m - self.elastic_m()).min(x_c_m + self.elastic_m())
    }
}

/// What an effect says of the law of a joint; width and load follow from the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SaidOfJoint {
    Bed { stiffness_pa_per_m: f64, damping_s: f64 },
    Trilinear { plateau: f64, first_rad: f64, last_rad: f64, damping_s: f64 },
    Crushing { stiffness_pa_per_m: f64, strength_pa: f64, damping_s: f64 },
    Rounded { worn_width_m: f64, radius_m: f64 },
}

/// The ground motion made of a record: gain times the record, later, with a share of it upwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GroundChange {
    pub gain: f64,
    pub lag_s: f64,
    pub vertical_ratio: f64,
}

impl GroundChange {
    pub const NONE: Self = Self { gain: 1.0, lag_s: 0.0, vertical_ratio: 0.0 };
}

/// How the sensors read the rotations: gain times the rotation, plus an offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Gain on θ_1 and θ_2.
    pub gain: [f64; 2],
    /// Offset of the readings of θ_1 and θ_2, rad.
    pub offset_rad: [f64; 2],
}

impl Reading {
    /// Sensors that read the rotations as they are.
    pub const TRUE: Self = Self { gain: [1.0; 2], offset_rad: [0.0; 2] };

    /// Whether the rotations are read as they are.
    pub fn is_true(&self) -> bool {
        *self == Self::TRUE
    }

    /// What is read where the bodies have turned by θ_1 and θ_2, rad.
    pub fn of(&self, theta: [f64; 2]) -> [f64; 2] {
        match self.is_true() {
            // To the bit: adding nothing would take the sign of a zero.
            true => theta,
            false => [0, 1].map(|i| self.gain[i] * theta[i] + self.offset_rad[i]),
        }
    }
}

impl EffectSums {
    pub const NONE: Self = Self {
        carriage_mass_kg: 0.0,
        viscous_n_s_per_m: 0.0,
        cubic_n_per_m3: 0.0,
        friction_n: 0.0,
        gap_half_width_m: 0.0,
        one_sided_n_per_m: [0.0; 2],
        yielding: None,
        joint_damping_n_m_s: [0.0; 2],
        indentation_m: [0.0; 2],
        joints: [None; 2],
        impact_factors: [1.0; 8],
        impact_fading_s_per_m: 0.0,
        ground: GroundChange::NONE,
        reading: Reading::TRUE,
        lanes: Lanes::Known,
    };

    /// Gives the joints of an effect a law.
    pub(super) fn say_of_joints(&mut self, effect: &Effect, said: Option<SaidOfJoint>) {
        effect.variant().joints().iter().for_each(|joint| self.joints[*joint as usize] = said);
    }

    pub fn of(effects: &[Effect]) -> Self {
        let mut sums = Self::NONE;
        for effect in effects {
            (effect.entry().add)(effect, &mut sums);
            if !effect.is_neutral() {
                sums.lanes = sums.lanes.max(effect.entry().lanes);
            }
        }
        sums
    }
}

/// Refuses effects that a wall cannot have: bounds of single values are checked already.
///
/// # Errors
/// [`ImpossibleWall`] with the key of the effect.
pub(in crate::model) fn check(p: &WallParameters, sums: &EffectSums) -> Result<(), ImpossibleWall> {
    for (i, effect) in p.effects.iter().enumerate() {
        let kind = effect.entry();
        let again = p.effects[..i].iter().any(|earlier| earlier.kind() == effect.kind());
        if again && !kind.may_repeat {
            let found = format!("{} again", kind.name);
            return Err(refused(i, found, "one effect of this kind: two have no common law".to_owned()));
        }
        let twice = |earlier: &Effect| is_joint_law(earlier) && share_a_joint(earlier, effect);
        if is_joint_law(effect) && p.effects[..i].iter().any(twice) {
            let found = format!("{} at a joint that has one", kind.name);
            return Err(refused(i, found, "one bed in a joint, or one of its rivals".to_owned()));
        }
        let at_crack = effect.variant().joints().contains(&Joint::Crack);
        if at_crack && p.crack_height_m.is_none() {
            let found = format!("{} at the crack of a wall without one", kind.name);
            return Err(refused(i, found, "joint = \"ground\"".to_owned()));
        }
    }
    let widths = [("lower", p.lower_width_m), ("upper", p.upper_width_m)];
    for ((body, width_m), indentation_m) in widths.into_iter().zip(sums.indentation_m) {
        if indentation_m >= width_m {
            let found = format!("corners that lie {} m inwards", written(indentation_m));
            let i = last(&p.effects, EffectKind::CornerIndentation);
            return Err(refused(i, found, format!("below corners.{body}_width_m = {width_m}")));
        }
    }
    for (c_l, factor) in p.restitution.coefficients.into_iter().zip(sums.impact_factors) {
        if c_l * factor > 2.0 {
            let i = last(&p.effects, EffectKind::ImpactDissipation);
            let found = format!("C_l times factor = {}", written(c_l * factor));
            return Err(refused(i, found, "0 to 2".to_owned()));
        }
    }
    Ok(())
}

/// Whether an effect is the law of a joint in place of its sharp edges.
pub(in crate::model) fn is_joint_law(effect: &Effect) -> bool {
    matches!(effect.entry().role, Role::Bed | Role::JointLaw)
}

/// Whether two effects at joints act at the same one.
fn share_a_joint(a: &Effect, b: &Effect) -> bool {
    let joints = b.variant().joints();
    a.variant().joints().iter().any(|joint| joints.contains(joint))
}

fn last(effects: &[Effect], kind: EffectKind) -> usize {
    effects.iter().rposition(|effect| effect.kind() == kind).unwrap_or(0)
}

fn refused(i: usize, found: String, allowed: String) -> ImpossibleWall {
    ImpossibleWall { key: Cow::Owned(format!("effects.{i}")), found, allowed }
}
