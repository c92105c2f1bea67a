//! Walls on beds side by side, in the lanes of vector registers: the equations of [`super::motion`] over several
//! numbers at once.

use fearless_simd::{Select, SimdMask};

use super::super::joint_forces::Masses;
use super::super::mass_matrix::Freedom;
use super::super::vector::Vector;
use super::motion::{BeddedMotion, Rolls};
use super::roll::{Roll, RollingBed};
use super::shape::JointShape;
use crate::lanes::{Numbers, Wide};

/// One joint of several walls, each in its own state of contact.
pub(crate) struct JointLanes<F: Wide> {
    on_edge: Branch<F>,
    whole: Branch<F>,
    in_part: Branch<F>,
    half_m: F,
    side: F,
    rolling: RollingBed<F>,
}

/// The lanes that are in a state of contact.
struct Branch<F: Wide> {
    lanes: F::Mask,
    any: bool,
}

impl<F: Wide> Branch<F> {
    #[inline(always)]
    fn new(lanes: F::Mask) -> Self {
        Self { lanes, any: lanes.any_true() }
    }

    /// What the joints of these lanes do, the others as they were.
    #[inline(always)]
    fn put(&self, here: Roll<F>, there: Roll<F>) -> Roll<F> {
        Roll {
            place: self.vector(here.place, there.place),
            slope: self.vector(here.slope, there.slope),
            bend: self.vector(here.bend, there.bend),
            moment_n_m: self.lanes.select(here.moment_n_m, there.moment_n_m),
            damping_n_m_s: self.lanes.select(here.damping_n_m_s, there.damping_n_m_s),
        }
    }

    #[inline(always)]
    fn vector(&self, here: Vector<F>, there: Vector<F>) -> Vector<F> {
        Vector::new(self.lanes.select(here.x, there.x), self.lanes.select(here.y, there.y))
    }
}

/// One joint of the walls of a row, number by number; 0 of what a joint does not have.
#[derive(Debug, Clone, Default)]
struct JointRow {
    /// 1 in whole contact.
    whole: Numbers,
    half_m: Numbers,
    side: Numbers,
    width_m: Numbers,
    load_n: Numbers,
    stiffness_pa: Numbers,
    damping_s: Numbers,
    rotational_stiffness_n_m: Numbers,
    full_contact_rad: Numbers,
    u_c: Numbers,
    root_u_c: Numbers,
    v_c: Numbers,
}

impl JointRow {
    fn put(&mut self, i: usize, joint: &JointShape) {
        match joint {
            JointShape::Bed { rolling, side, .. } => self.put_bed(i, rolling, *side),
            JointShape::Edge { half_m } => self.put_edge(i, *half_m),
            _ => unreachable!("rivals of beds go alone, as the catalogue says"),
        }
    }

    fn put_edge(&mut self, i: usize, half_m: f64) {
        (self.whole[i], self.half_m[i], self.side[i]) = (0.0, half_m, 0.0);
    }

    fn put_bed(&mut self, i: usize, bed: &RollingBed, side: f64) {
        (self.whole[i], self.half_m[i], self.side[i]) = (f64::from(u8::from(side == 0.0)), 0.0, side);
        self.width_m[i] = bed.width_m;
        self.load_n[i] = bed.load_n;
        self.stiffness_pa[i] = bed.stiffness_pa;
        self.damping_s[i] = bed.damping_s;
        self.rotational_stiffness_n_m[i] = bed.rotational_stiffness_n_m;
        self.full_contact_rad[i] = bed.full_contact_rad;
        self.u_c[i] = bed.u_c;
        self.root_u_c[i] = bed.root_u_c;
        self.v_c[i] = bed.v_c;
    }
}

impl<F: Wide> JointLanes<F> {
    #[inline(always)]
    fn new(simd: F::Token, row: &JointRow) -> Self {
        let of = |numbers: &Numbers| F::of_row(simd, numbers);
        let (half_m, side) = (of(&row.half_m), of(&row.side));
        Self {
            on_edge: Branch::new(!half_m.simd_eq(0.0)),
            whole: Branch::new(of(&row.whole).simd_eq(1.0)),
            in_part: Branch::new(!side.simd_eq(0.0)),
            half_m,
            side,
            rolling: RollingBed {
                width_m: of(&row.width_m),
                load_n: of(&row.load_n),
                stiffness_pa: of(&row.stiffness_pa),
                damping_s: of(&row.damping_s),
                rotational_stiffness_n_m: of(&row.rotational_stiffness_n_m),
                full_contact_rad: of(&row.full_contact_rad),
                u_c: of(&row.u_c),
                root_u_c: of(&row.root_u_c),
                v_c: of(&row.v_c),
            },
        }
    }
}

impl<F: Wide> Rolls<F> for JointLanes<F> {
    #[inline(always)]
    fn roll(&self, phi: F) -> Roll<F> {
        let mut roll = Roll::none(phi);
        if self.on_edge.any {
            roll = self.on_edge.put(Roll::about_edge(self.half_m, phi), roll);
        }
        if self.whole.any {
            roll = self.whole.put(self.rolling.in_full_contact(phi), roll);
        }
        if self.in_part.any {
            roll = self.in_part.put(self.rolling.in_part(self.side, phi), roll);
        }
        roll
    }
}

/// The walls on beds of a row in memory, number by number as registers take them.
#[derive(Debug, Clone, Default)]
pub(crate) struct BedRow {
    joints: [JointRow; 2],
    m: [Numbers; 2],
    i: [Numbers; 2],
    m_d: Numbers,
    m_dp: Numbers,
    height_1_m: Numbers,
    g1: [Numbers; 2],
    g2: [Numbers; 2],
    c: [Numbers; 2],
}

impl BedRow {
    /// Puts the equations of a wall in a lane.
    pub fn put(&mut self, i: usize, wall: &BeddedMotion) {
        let put = |to: &mut [Numbers; 2], [first, second]: [f64; 2]| {
            to[0][i] = first;
            to[1][i] = second;
        };
        let Masses { m, i: inertias, m_d, m_dp } = wall.masses;
        put(&mut self.m, m);
        put(&mut self.i, inertias);
        (self.m_d[i], self.m_dp[i], self.height_1_m[i]) = (m_d, m_dp, wall.height_1_m);
        put(&mut self.g1, [wall.g1.x, wall.g1.y]);
        put(&mut self.g2, [wall.g2.x, wall.g2.y]);
        put(&mut self.c, [wall.c.x, wall.c.y]);
        self.joints[0].put(i, &wall.joints[0]);
        self.joints[1].put(i, &wall.joints[1]);
    }
}

impl<F: Wide> BeddedMotion<F, JointLanes<F>> {
    /// The equations of the walls of a row, in which these rotations are free.
    #[inline(always)]
    pub fn of_row(simd: F::Token, row: &BedRow, freedom: Freedom) -> Self {
        let of = |numbers: &Numbers| F::of_row(simd, numbers);
        let vector = |of_both: &[Numbers; 2]| Vector::new(of(&of_both[0]), of(&of_both[1]));
        Self {
            joints: [JointLanes::new(simd, &row.joints[0]), JointLanes::new(simd, &row.joints[1])],
            freedom,
            masses: Masses {
                m: [of(&row.m[0]), of(&row.m[1])],
                i: [of(&row.i[0]), of(&row.i[1])],
                m_d: of(&row.m_d),
                m_dp: of(&row.m_dp),
            },
            height_1_m: of(&row.height_1_m),
            g1: vector(&row.g1),
            g2: vector(&row.g2),
            c: vector(&row.c),
        }
    }
}
