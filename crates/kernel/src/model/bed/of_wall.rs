//! The law of a joint from what an effect says of it and what the wall lets it carry.

use std::borrow::Cow;

use super::super::contact::Joint;
use super::super::effect::{SHARP_PA_PER_M, SaidOfJoint, is_joint_law};
use super::super::parameters::WallParameters;
use super::super::wall::{BLOCK_STRENGTH, ImpossibleWall};
use super::crushing::CrushingJoint;
use super::joint_law::JointLaw;
use super::law::Bed;
use super::rounded::RoundedEdges;
use super::trilinear::TrilinearJoint;
use crate::written;

/// Smallest φ_1 of three lines, rad: as stiff as the stiffest bed under a wall of some metres.
const LEAST_FIRST_RAD: f64 = 1e-7;

/// A block of crushed corner deeper than this share of the width would crush before the joint opens, or reach what the
/// other side has crushed.
const MOST_BLOCK: f64 = 1.0 / 3.0;

/// What a joint is and carries.
#[derive(Debug, Clone, Copy)]
pub(in crate::model) struct Carries {
    pub width_m: f64,
    pub length_m: f64,
    pub load_n: f64,
}

/// Why a joint cannot have a law: key of the effect, what was found, what is allowed.
pub(in crate::model) struct Refused {
    key: &'static str,
    found: f64,
    allowed: String,
}

impl Refused {
    /// Of the joint at a place of the wall.
    pub fn at(self, p: &WallParameters, joint: usize) -> ImpossibleWall {
        let key = Cow::Owned(format!("effects.{}.{}", law_at(p, joint), self.key));
        ImpossibleWall { key, found: written(self.found).to_string(), allowed: self.allowed }
    }
}

/// Place of the effect that is the law of a joint among the effects of a wall.
pub(in crate::model) fn law_at(p: &WallParameters, joint: usize) -> usize {
    let joint = if joint == 0 { Joint::Ground } else { Joint::Crack };
    let acts_at = |effect: &_| is_joint_law(effect) && effect.variant().joints().contains(&joint);
    let Some(place) = p.effects.iter().position(acts_at) else {
        unreachable!("a joint has its law from an effect")
    };
    place
}

impl Carries {
    /// The law of the joint.
    ///
    /// # Errors
    /// A number that this joint cannot have.
    pub fn law(&self, said: SaidOfJoint) -> Result<JointLaw, Refused> {
        let Self { width_m, length_m, load_n } = *self;
        match said {
            SaidOfJoint::Bed { stiffness_pa_per_m, damping_s } => {
                Ok(JointLaw::Bed(Bed { stiffness_pa_per_m, damping_s, width_m, length_m, load_n }))
            }
            SaidOfJoint::Trilinear { plateau, first_rad, last_rad, damping_s } => {
                self.trilinear(TrilinearJoint { plateau, first_rad, last_rad, damping_s, width_m, load_n })
            }
            SaidOfJoint::Crushing { stiffness_pa_per_m, strength_pa, damping_s } => {
                let crushed_rad = [0.0; 2];
                self.crushing(CrushingJoint {
                    stiffness_pa_per_m,
                    strength_pa,
                    damping_s,
                    width_m,
                    length_m,
                    load_n,
                    crushed_rad,
                })
            }
            SaidOfJoint::Rounded { worn_width_m, radius_m } => {
                self.rounded(RoundedEdges { worn_width_m, radius_m, width_m, load_n })
            }
        }
    }

    fn trilinear(&self, joint: TrilinearJoint) -> Result<JointLaw, Refused> {
        let TrilinearJoint { plateau, first_rad, last_rad, .. } = joint;
        if first_rad < LEAST_FIRST_RAD {
            let allowed = format!("{LEAST_FIRST_RAD:e} or more, or 0 with plateau = 1: sharp edges");
            return Err(Refused { key: "first_rotation_rad", found: first_rad, allowed });
        }
        if plateau < 1.0 && last_rad <= first_rad {
            let allowed = format!("above first_rotation_rad = {}", written(first_rad));
            return Err(Refused { key: "last_rotation_rad", found: last_rad, allowed });
        }
        Ok(JointLaw::Trilinear(joint))
    }

    /// A strength that no rotation below a quarter turn reaches leaves the elastic bed.
    fn crushing(&self, joint: CrushingJoint) -> Result<JointLaw, Refused> {
        if joint.block_m() > MOST_BLOCK * self.width_m {
            let least = self.load_n / (BLOCK_STRENGTH * MOST_BLOCK * self.width_m * self.length_m);
            let allowed = format!(
                "{least:.4e} Pa or more: a weaker bed crushes over more than a third of the joint, before it opens"
            );
            return Err(Refused { key: "compressive_strength_pa", found: joint.strength_pa, allowed });
        }
        if joint.stiffness_pa_per_m >= SHARP_PA_PER_M {
            let allowed = format!(
                "below {SHARP_PA_PER_M:e}: a bed without give that crushes is corner_indentation, or corners.compressive_strength_pa"
            );
            return Err(Refused { key: "stiffness_pa_per_m", found: joint.stiffness_pa_per_m, allowed });
        }
        Ok(if joint.ever_crushes() { JointLaw::Crushing(joint) } else { JointLaw::Bed(joint.left_bed()) })
    }

    fn rounded(&self, joint: RoundedEdges) -> Result<JointLaw, Refused> {
        if joint.flat_m() <= 0.0 {
            let allowed = format!("below half the width of the joint, {}", written(self.width_m / 2.0));
            return Err(Refused { key: "worn_width_m", found: joint.worn_width_m, allowed });
        }
        Ok(JointLaw::Rounded(joint))
    }
}
