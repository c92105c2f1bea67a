//! The laws beyond weight and inertia of several walls side by side, and which walls may go together.

use fearless_simd::Select;

use super::bed::Acting;
use super::effect::Lanes;
use super::formula::{FormulaLanes, FormulaRow};
use super::laws::Laws;
use super::mass_matrix::Freedom;
use super::motion::Motion;
use super::sharp::TopLaws;
use crate::fused::fused_lanes as fused;
use crate::lanes::{Numbers, Wide};

/// What motions have in common that may step side by side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LaneKind {
    /// They turn as one on sharp edges; perhaps with further laws than a linear spring.
    AsOne { further: bool },
    /// Their bodies turn apart on sharp edges; perhaps with further laws than a linear spring.
    Apart { further: bool },
    /// They stand on beds, and these rotations are free.
    Bedded(Freedom),
}

impl LaneKind {
    /// All kinds.
    pub const ALL: [Self; 7] = [
        Self::AsOne { further: false },
        Self::Apart { further: false },
        Self::AsOne { further: true },
        Self::Apart { further: true },
        Self::Bedded(Freedom::Monolithic),
        Self::Bedded(Freedom::Upper),
        Self::Bedded(Freedom::Both),
    ];

    /// Position among all kinds.
    #[inline]
    pub fn index(self) -> usize {
        match self {
            Self::AsOne { further } => 2 * usize::from(further),
            Self::Apart { further } => 1 + 2 * usize::from(further),
            Self::Bedded(Freedom::None | Freedom::Monolithic) => 4,
            Self::Bedded(Freedom::Upper) => 5,
            Self::Bedded(Freedom::Both) => 6,
        }
    }
}

impl Motion {
    /// Whether there are further laws than a linear spring.
    #[inline]
    pub fn has_further_laws(&self) -> bool {
        self.damped || self.laws.cubic_n_per_m3 != 0.0
    }

    /// The kind of motions this one may go side by side with; `None` where it moves alone.
    #[inline]
    pub fn side_by_side(&self) -> Option<LaneKind> {
        let known = match self.laws.lanes {
            Lanes::Known => true,
            Lanes::WhileSliding => !self.held,
            Lanes::Unknown => false,
        };
        if !known || self.freedom == Freedom::None {
            return None;
        }
        let further = self.has_further_laws();
        Some(match self.freedom {
            freedom if self.is_bedded() => LaneKind::Bedded(freedom),
            Freedom::Monolithic => LaneKind::AsOne { further },
            _ => LaneKind::Apart { further },
        })
    }
}

/// The laws of which the lanes do the sums.
#[derive(Clone, Copy)]
struct LaneLaws {
    m_dp: f64,
    stiffness: f64,
    offset: f64,
    cubic: f64,
    viscous: f64,
    drag: f64,
    joint_damping: [f64; 2],
}

impl LaneLaws {
    /// Every law by its name, so that a new one does not compile here at first. Either the lanes do its sums,
    /// or the catalogue says of its effect that they do not.
    #[inline(always)]
    fn of(motion: &Motion) -> Self {
        let Laws {
            carriage_mass_kg: m_dp,
            stiffness_n_per_m: stiffness,
            spring_offset_n: offset,
            cubic_n_per_m3: cubic,
            viscous_n_s_per_m: viscous,
            drag_n: drag,
            joint_damping_n_m_s: joint_damping,
            // Energy, which a step does not need.
            stored_offset_j: _,
            lanes: _,
        } = motion.laws;
        Self { m_dp, stiffness, offset, cubic, viscous, drag, joint_damping }
    }
}

/// The laws of the walls of a row, one after another.
#[derive(Debug, Clone, Default)]
pub(crate) struct LawRow {
    pub(super) m_dp: Numbers,
    stiffness: Numbers,
    offset: Numbers,
    cubic: Numbers,
    viscous: Numbers,
    drag: Numbers,
    joint_damping: [Numbers; 2],
    damped: Numbers,
    /// Those written as formulas, in their branches.
    formulas: FormulaRow,
}

impl LawRow {
    /// The laws of the wall in a lane.
    #[inline(always)]
    pub fn put(&mut self, i: usize, motion: &Motion) {
        let LaneLaws { m_dp, stiffness, offset, cubic, viscous, drag, joint_damping } = LaneLaws::of(motion);
        self.m_dp[i] = m_dp;
        self.stiffness[i] = stiffness;
        self.offset[i] = offset;
        self.cubic[i] = cubic;
        self.viscous[i] = viscous;
        self.drag[i] = drag;
        self.joint_damping[0][i] = joint_damping[0];
        self.joint_damping[1][i] = joint_damping[1];
        self.damped[i] = f64::from(u8::from(motion.damped));
        self.put_formulas(i, motion);
    }

    /// The formulas of the wall in a lane, in the branches they are in by now.
    #[inline(always)]
    pub fn put_formulas(&mut self, i: usize, motion: &Motion) {
        self.formulas[i].copy(&motion.formulas);
    }
}

/// The linear spring at the top, and what else is constant there.
#[derive(Clone, Copy)]
pub(super) struct SpringLanes<F: Wide> {
    stiffness: F,
    offset: F,
}

impl<F: Wide> SpringLanes<F> {
    #[inline(always)]
    pub fn new(simd: F::Token, row: &LawRow) -> Self {
        Self { stiffness: F::of_row(simd, &row.stiffness), offset: F::of_row(simd, &row.offset) }
    }

    /// As [`Laws::spring_force_n`] of a linear spring.
    #[inline(always)]
    pub fn force_n(&self, x_c: F) -> F {
        fused(-self.stiffness, x_c, self.offset)
    }
}

/// The laws of walls side by side; further ones than a linear spring only where any has them.
pub(crate) struct LawLanes<F: Wide, const FURTHER: bool> {
    spring: SpringLanes<F>,
    further: Option<FurtherLanes<F>>,
}

impl<F: Wide, const FURTHER: bool> LawLanes<F, FURTHER> {
    #[inline(always)]
    pub fn new(simd: F::Token, row: &mut LawRow) -> Self {
        let further = if FURTHER { Some(FurtherLanes::new(simd, row)) } else { None };
        Self { spring: SpringLanes::new(simd, row), further }
    }

    /// The lanes with formulas; `None` where none has any.
    #[inline(always)]
    pub fn written(&self) -> Option<F::Mask> {
        self.further.as_ref().and_then(|further| further.formulas.written())
    }

    /// Puts back what [`LawLanes::new`] took out of the row.
    #[inline(always)]
    pub fn put_back(self, row: &mut LawRow) {
        if let Some(further) = self.further {
            further.put_back(row);
        }
    }
}

impl<F: Wide, const FURTHER: bool> Acting<F> for LawLanes<F, FURTHER> {
    #[inline(always)]
    fn spring_force_n(&self, x_c_m: F) -> F {
        match &self.further {
            Some(further) => further.spring_force_n(&self.spring, x_c_m),
            None => self.spring.force_n(x_c_m),
        }
    }

    #[inline(always)]
    fn damping_force_n(&self, x_c_m: F, v_c_m_s: F) -> F {
        match &self.further {
            Some(further) => further.damping_force_n(x_c_m, v_c_m_s),
            None => F::splat(x_c_m.token(), 0.0),
        }
    }

    #[inline(always)]
    fn joint_moments_n_m(&self, theta: impl Fn() -> [F; 2], omega: [F; 2]) -> [F; 2] {
        match &self.further {
            Some(further) => further.joint_moments_n_m(theta, omega),
            None => [F::splat(omega[0].token(), 0.0); 2],
        }
    }
}

impl<F: Wide, const FURTHER: bool> TopLaws<F> for LawLanes<F, FURTHER> {
    #[inline(always)]
    fn has_dampers(&self) -> bool {
        FURTHER
    }

    #[inline(always)]
    fn with(&self, number: F, further: F) -> F {
        match &self.further {
            Some(laws) => laws.damped.select(number + further, number),
            None => number,
        }
    }

    #[inline(always)]
    fn where_damped(&self, number: F) -> F {
        let none = F::splat(number.token(), 0.0);
        match &self.further {
            Some(laws) => laws.damped.select(number, none),
            None => none,
        }
    }
}

/// Laws beyond a linear spring: a cubic one, dampers, drag, formulas. A lane without them keeps its sums as they are.
pub(super) struct FurtherLanes<F: Wide> {
    cubic: F,
    linear: F::Mask,
    viscous: F,
    drag: F,
    at_ground: F,
    at_crack: F,
    damped: F::Mask,
    formulas: FormulaLanes<F>,
}

impl<F: Wide> FurtherLanes<F> {
    /// Takes the formulas out of the row, until [`FurtherLanes::put_back`].
    #[inline(always)]
    pub fn new(simd: F::Token, row: &mut LawRow) -> Self {
        let cubic = F::of_row(simd, &row.cubic);
        Self {
            cubic,
            linear: cubic.simd_eq(0.0),
            viscous: F::of_row(simd, &row.viscous),
            drag: F::of_row(simd, &row.drag),
            at_ground: F::of_row(simd, &row.joint_damping[0]),
            at_crack: F::of_row(simd, &row.joint_damping[1]),
            damped: F::of_row(simd, &row.damped).simd_eq(1.0),
            formulas: FormulaLanes::new(simd, std::mem::take(&mut row.formulas)),
        }
    }

    #[inline(always)]
    pub fn put_back(self, row: &mut LawRow) {
        row.formulas = self.formulas.into_row();
    }

    /// As [`Laws::spring_force_n`].
    #[inline(always)]
    pub fn spring_force_n(&self, spring: &SpringLanes<F>, x_c: F) -> F {
        let secant = fused(self.cubic * x_c, x_c, spring.stiffness);
        self.linear.select(spring.force_n(x_c), fused(-secant, x_c, spring.offset))
    }

    /// As [`Laws::damping_force_n`], and that of formulas.
    #[inline(always)]
    pub fn damping_force_n(&self, x_c: F, v_c: F) -> F {
        self.formulas.with_top_force_n(fused(-self.viscous, v_c, self.drag), x_c, v_c)
    }

    /// As [`Laws::joint_moments_n_m`], and those of formulas.
    #[inline(always)]
    pub fn joint_moments_n_m(&self, theta: impl Fn() -> [F; 2], [w1, w2]: [F; 2]) -> [F; 2] {
        let at_crack = self.at_crack * (w2 - w1);
        let moments = [fused(-self.at_ground, w1, at_crack), -at_crack];
        self.formulas.with_joint_moments_n_m(moments, theta, [w1, w2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Contact, EffectKind, Pivot, RockingWall, Wall, WallParameters};

    fn cracked(effects: Vec<crate::model::Effect>) -> RockingWall {
        let strip = WallParameters::strip(0.3, 4.0, 1800.0);
        let crack_height_m = Some(2.2);
        let stiffness_n_per_m = 40e3;
        let parameters = WallParameters { crack_height_m, stiffness_n_per_m, effects, ..strip };
        RockingWall::new(&Wall::new(parameters).expect("a wall that can exist"))
    }

    #[test]
    fn analytic_walls_with_every_effect_that_the_catalogue_lets_go_side_by_side_do() {
        let open = Contact { ground: Pivot::Right, crack: Pivot::Left };
        for variant in EffectKind::ALL.iter().flat_map(|kind| kind.variants()) {
            let mut wall = cracked(vec![variant.example()]);
            if variant.entry().lanes == Lanes::Unknown {
                assert!(wall.motion(open).side_by_side().is_none(), "{variant:?}");
                continue;
            }
            // A top that friction holds has a force of its own.
            let held = wall.is_held();
            assert_eq!(wall.motion(open).side_by_side().is_none(), held, "{variant:?}");
            let mut regime = wall.regime();
            regime.slides = crate::model::Side::Positive;
            wall.enter_regime(regime);
            let kind = wall.motion(open).side_by_side();
            let on_bed = kind == Some(LaneKind::Bedded(Freedom::Both));
            assert!(kind.is_some() && on_bed == wall.wall().gives(), "{variant:?}: {kind:?}");
        }
    }

    #[test]
    fn analytic_kinds_have_places_of_their_own() {
        for (place, kind) in LaneKind::ALL.into_iter().enumerate() {
            assert_eq!(kind.index(), place, "{kind:?}");
        }
    }
}
