//! The motions of the walls of a row in memory, from where [`super::side_by_side`] takes them into registers.

use super::bed::BedRow;
use super::lane_laws::LawRow;
use super::mass_matrix::Freedom;
use super::motion::Motion;
use super::sharp::SharpMotion;
use super::vector::Vector;
use crate::lanes::{Numbers, Wide, exchange};

/// The motions of the walls of a row, number by number as registers take them.
#[derive(Debug, Clone, Default)]
pub(crate) struct MotionRow {
    pub(super) upper: Numbers,
    pub(super) lower_mass: Numbers,
    pub(super) upper_mass: Numbers,
    pub(super) pivots: PivotRow,
    pub(super) laws: LawRow,
    pub(super) beds: BedRow,
}

/// What of a motion depends on the corners about which it turns.
#[derive(Debug, Clone, Default)]
pub(crate) struct PivotRow {
    pub(super) o_x: Numbers,
    pub(super) o_c: Numbers,
    pub(super) q_x: Numbers,
    pub(super) q: [Numbers; 2],
    pub(super) c: [Numbers; 2],
    pub(super) v: [Numbers; 2],
    pub(super) u: [Numbers; 2],
    pub(super) whole_arm: [Numbers; 2],
    pub(super) whole_moment: [Numbers; 2],
    pub(super) whole_inertia: Numbers,
    pub(super) inertias: [Numbers; 2],
    pub(super) lower_inertia: Numbers,
}

impl PivotRow {
    /// Puts that of a motion in a lane.
    pub fn put(&mut self, i: usize, m: &SharpMotion) {
        let put = |to: &mut [Numbers; 2], [first, second]: [f64; 2]| {
            to[0][i] = first;
            to[1][i] = second;
        };
        self.o_x[i] = m.o_x;
        self.o_c[i] = m.o_c;
        self.q_x[i] = m.q_x;
        put(&mut self.q, [m.q.x, m.q.y]);
        put(&mut self.c, [m.c.x, m.c.y]);
        put(&mut self.v, [m.v.x, m.v.y]);
        put(&mut self.u, [m.u.x, m.u.y]);
        put(&mut self.whole_arm, [m.whole_arm.x, m.whole_arm.y]);
        put(&mut self.whole_moment, [m.whole_moment.x, m.whole_moment.y]);
        self.whole_inertia[i] = m.whole_inertia;
        put(&mut self.inertias, m.inertias);
        self.lower_inertia[i] = m.lower_inertia;
    }

    /// Exchanges those of some lanes.
    #[inline(always)]
    fn exchange<F: Wide>(&mut self, which: F::Mask, other: &mut Self) {
        exchange::<F>(which, &mut self.o_x, &mut other.o_x);
        exchange::<F>(which, &mut self.o_c, &mut other.o_c);
        exchange::<F>(which, &mut self.q_x, &mut other.q_x);
        exchange::<F>(which, &mut self.whole_inertia, &mut other.whole_inertia);
        exchange::<F>(which, &mut self.lower_inertia, &mut other.lower_inertia);
        for k in 0..2 {
            exchange::<F>(which, &mut self.q[k], &mut other.q[k]);
            exchange::<F>(which, &mut self.c[k], &mut other.c[k]);
            exchange::<F>(which, &mut self.v[k], &mut other.v[k]);
            exchange::<F>(which, &mut self.u[k], &mut other.u[k]);
            exchange::<F>(which, &mut self.whole_arm[k], &mut other.whole_arm[k]);
            exchange::<F>(which, &mut self.whole_moment[k], &mut other.whole_moment[k]);
            exchange::<F>(which, &mut self.inertias[k], &mut other.inertias[k]);
        }
    }
}

impl MotionRow {
    /// The equations of the walls of the row.
    #[inline(always)]
    pub fn sharp<F: Wide>(&self, simd: F::Token) -> SharpMotion<F> {
        let one = |of: &Numbers| F::of_row(simd, of);
        let two = |of: &[Numbers; 2]| Vector::new(one(&of[0]), one(&of[1]));
        let pivots = &self.pivots;
        SharpMotion {
            o_x: one(&pivots.o_x),
            o_c: one(&pivots.o_c),
            q_x: one(&pivots.q_x),
            q: two(&pivots.q),
            c: two(&pivots.c),
            v: two(&pivots.v),
            u: two(&pivots.u),
            inertias: [one(&pivots.inertias[0]), one(&pivots.inertias[1])],
            lower_mass: one(&self.lower_mass),
            upper_mass: one(&self.upper_mass),
            lower_inertia: one(&pivots.lower_inertia),
            whole_arm: two(&pivots.whole_arm),
            whole_moment: two(&pivots.whole_moment),
            whole_inertia: one(&pivots.whole_inertia),
            m_dp: one(&self.laws.m_dp),
        }
    }

    /// Puts a motion in a lane.
    pub fn put(&mut self, i: usize, m: &Motion) {
        self.upper[i] = f64::from(u8::from(m.freedom == Freedom::Upper));
        self.lower_mass[i] = m.sharp.lower_mass;
        self.upper_mass[i] = m.sharp.upper_mass;
        self.pivots.put(i, &m.sharp);
        self.laws.put(i, m);
        if let Some(bedded) = m.on_beds() {
            self.beds.put(i, bedded);
        }
    }

    /// The formulas of a motion whose other laws are in the lane.
    pub fn put_formulas(&mut self, i: usize, m: &Motion) {
        self.laws.put_formulas(i, m);
    }

    /// Turns some walls about their other corners, and keeps what they turned about until then.
    #[inline(always)]
    pub fn turn_over<F: Wide>(&mut self, which: F::Mask, others: &mut PivotRow) {
        self.pivots.exchange::<F>(which, others);
    }
}
