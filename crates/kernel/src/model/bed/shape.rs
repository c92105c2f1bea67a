//! One joint in its state of contact: how it rolls.

use super::super::contact::Pivot;
use super::crushing::RollingCrush;
use super::joint_law::JointLaw;
use super::law::Bed;
use super::motion::Rolls;
use super::roll::{Roll, RollingBed};
use super::rounded::RollingArc;
use super::trilinear::RollingLines;

/// In which branch of its law an open joint is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Branch {
    /// That of its rotation: where no motion went before.
    #[default]
    OfRotation,
    /// Before the kink.
    Before,
    /// Beyond the kink; a bed that crushes is crushing.
    Beyond,
}

impl Branch {
    fn is_beyond(self, of_rotation: impl FnOnce() -> bool) -> bool {
        match self {
            Self::OfRotation => of_rotation(),
            Self::Before => false,
            Self::Beyond => true,
        }
    }
}

/// One joint in its state of contact.
#[derive(Debug, Clone, Copy)]
pub(crate) enum JointShape {
    /// Closed (0), or turning about a sharp edge at ± half the width, m.
    Edge { half_m: f64 },
    /// On a bed, in whole contact (0) or in part towards a side.
    Bed { bed: Bed, rolling: RollingBed, side: f64 },
    /// On three lines, on the first (0) or open towards a side.
    Lines { rolling: RollingLines, side: f64, branch: Branch },
    /// On a bed that crushes.
    Crushing { rolling: RollingCrush, branch: Branch },
    /// Rolling on an arc towards a side.
    Arc { rolling: RollingArc, side: f64, branch: Branch },
}

impl JointShape {
    pub fn new(law: Option<&JointLaw>, width_m: f64, pivot: Pivot, branch: Branch) -> Self {
        let side = pivot.sign();
        match law {
            None => Self::Edge { half_m: side * width_m / 2.0 },
            Some(JointLaw::Rounded(_)) if pivot.is_closed() => Self::Edge { half_m: 0.0 },
            Some(JointLaw::Bed(bed)) => Self::Bed { bed: *bed, rolling: RollingBed::new(bed), side },
            Some(JointLaw::Trilinear(lines)) => {
                Self::Lines { rolling: RollingLines::new(lines), side, branch }
            }
            Some(JointLaw::Crushing(bed)) => {
                Self::Crushing { rolling: RollingCrush::new(bed, pivot), branch }
            }
            Some(JointLaw::Rounded(edges)) => Self::Arc { rolling: RollingArc::new(edges), side, branch },
        }
    }

    pub fn stored_j(&self, phi: f64) -> f64 {
        match self {
            Self::Edge { .. } | Self::Lines { .. } | Self::Arc { .. } => 0.0,
            Self::Bed { bed, side, .. } => bed.stored_j(*side, phi),
            Self::Crushing { rolling, branch } => {
                rolling.stored_j(phi, branch.is_beyond(|| rolling.is_beyond(phi)))
            }
        }
    }

    /// Stiffness, N m, and damping, N m s, of small motions about rest.
    pub fn stiffness_and_damping(&self) -> [f64; 2] {
        let of = |roll: Roll| [roll.moment_n_m, roll.damping_n_m_s];
        match self {
            Self::Edge { .. } => [0.0; 2],
            Self::Bed { rolling, .. } => of(rolling.in_full_contact(1.0)),
            Self::Lines { rolling, .. } => rolling.stiffness_and_damping(),
            Self::Crushing { rolling, .. } => rolling.stiffness_and_damping(),
            Self::Arc { rolling, .. } => [rolling.stiffness_n_m(), 0.0],
        }
    }
}

impl Rolls<f64> for JointShape {
    #[inline(always)]
    fn roll(&self, phi: f64) -> Roll {
        match self {
            Self::Edge { half_m: 0.0 } => Roll::default(),
            Self::Edge { half_m } => Roll::about_edge(*half_m, phi),
            Self::Bed { rolling, side: 0.0, .. } => rolling.in_full_contact(phi),
            Self::Bed { rolling, side, .. } => rolling.in_part(*side, phi),
            rival => rival.roll_of_rival(phi),
        }
    }

    #[inline(always)]
    fn crushing_n_m(&self, phi: f64) -> Option<f64> {
        match self {
            Self::Crushing { rolling, branch } => {
                branch.is_beyond(|| rolling.is_beyond(phi)).then(|| rolling.lost_n_m(phi))
            }
            _ => None,
        }
    }
}

impl JointShape {
    #[inline(never)]
    fn roll_of_rival(&self, phi: f64) -> Roll {
        match self {
            Self::Edge { .. } | Self::Bed { .. } => unreachable!("edges and beds roll by themselves"),
            Self::Lines { rolling, side: 0.0, .. } => rolling.on_first(phi),
            Self::Lines { rolling, side, branch } => {
                let open = side * phi;
                rolling.open(open, branch.is_beyond(|| rolling.is_beyond(open))).mirrored_to(*side)
            }
            Self::Arc { rolling, side, branch } => {
                let open = side * phi;
                rolling.roll(open, branch.is_beyond(|| rolling.is_beyond(open))).mirrored_to(*side)
            }
            Self::Crushing { rolling, branch } => {
                rolling.roll(phi, branch.is_beyond(|| rolling.is_beyond(phi)))
            }
        }
    }
}
