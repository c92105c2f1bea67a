//! Walls on beds side by side, in the lanes of vector registers: the equations of [`super::motion`] over several
//! numbers at once.

use fearless_simd::{Select, Simd, SimdBase, SimdMask, f64x4, mask64x4};

use super::super::joint_forces::Masses;
use super::super::vector::Vector;
use super::motion::{BeddedMotion, Rolls};
use super::roll::{Roll, RollingBed};
use super::shape::JointShape;
use crate::lanes::{LANES, lanes};

type F<S> = f64x4<S>;

/// One joint of several walls, each in its own state of contact.
pub(crate) struct JointLanes<S: Simd> {
    on_edge: Branch<S>,
    whole: Branch<S>,
    in_part: Branch<S>,
    half_m: F<S>,
    side: F<S>,
    rolling: RollingBed<F<S>>,
}

/// The lanes that are in a state of contact.
struct Branch<S: Simd> {
    lanes: mask64x4<S>,
    any: bool,
}

impl<S: Simd> Branch<S> {
    #[inline(always)]
    fn new(simd: S, joints: &[&JointShape; LANES], is_in: fn(&JointShape) -> bool) -> Self {
        let lanes = lanes(simd, |i| f64::from(u8::from(is_in(joints[i])))).simd_eq(1.0);
        Self { lanes, any: lanes.any_true() }
    }

    /// What the joints of these lanes do, the others as they were.
    #[inline(always)]
    fn put(&self, here: Roll<F<S>>, there: Roll<F<S>>) -> Roll<F<S>> {
        Roll {
            place: self.vector(here.place, there.place),
            slope: self.vector(here.slope, there.slope),
            bend: self.vector(here.bend, there.bend),
            moment_n_m: self.lanes.select(here.moment_n_m, there.moment_n_m),
            damping_n_m_s: self.lanes.select(here.damping_n_m_s, there.damping_n_m_s),
        }
    }

    #[inline(always)]
    fn vector(&self, here: Vector<F<S>>, there: Vector<F<S>>) -> Vector<F<S>> {
        Vector::new(self.lanes.select(here.x, there.x), self.lanes.select(here.y, there.y))
    }
}

/// What joints on beds only have; 0 of an edge. Rivals of beds go alone, as the catalogue says.
#[inline(always)]
fn of_bed(joint: &JointShape, number: fn(&RollingBed) -> f64) -> f64 {
    match joint {
        JointShape::Bed { rolling, .. } => number(rolling),
        _ => 0.0,
    }
}

#[inline(always)]
fn side(joint: &JointShape) -> f64 {
    match joint {
        JointShape::Bed { side, .. } => *side,
        _ => 0.0,
    }
}

#[inline(always)]
fn half_m(joint: &JointShape) -> f64 {
    match joint {
        JointShape::Edge { half_m } => *half_m,
        _ => 0.0,
    }
}

impl<S: Simd> JointLanes<S> {
    #[inline(always)]
    fn new(simd: S, joints: &[&JointShape; LANES]) -> Self {
        let on_bed = |number: fn(&RollingBed) -> f64| lanes(simd, |i| of_bed(joints[i], number));
        Self {
            on_edge: Branch::new(simd, joints, |joint| half_m(joint) != 0.0),
            whole: Branch::new(simd, joints, |joint| matches!(joint, JointShape::Bed { side: 0.0, .. })),
            in_part: Branch::new(simd, joints, |joint| side(joint) != 0.0),
            half_m: lanes(simd, |i| half_m(joints[i])),
            side: lanes(simd, |i| side(joints[i])),
            rolling: RollingBed {
                width_m: on_bed(|bed| bed.width_m),
                load_n: on_bed(|bed| bed.load_n),
                stiffness_pa: on_bed(|bed| bed.stiffness_pa),
                damping_s: on_bed(|bed| bed.damping_s),
                rotational_stiffness_n_m: on_bed(|bed| bed.rotational_stiffness_n_m),
                full_contact_rad: on_bed(|bed| bed.full_contact_rad),
                u_c: on_bed(|bed| bed.u_c),
                root_u_c: on_bed(|bed| bed.root_u_c),
                v_c: on_bed(|bed| bed.v_c),
            },
        }
    }
}

impl<S: Simd> Rolls<F<S>> for JointLanes<S> {
    #[inline(always)]
    fn roll(&self, phi: F<S>) -> Roll<F<S>> {
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

impl<S: Simd> BeddedMotion<F<S>, JointLanes<S>> {
    /// The equations of several walls in which the same rotations are free.
    #[inline(always)]
    pub fn of_lanes(simd: S, walls: &[&BeddedMotion; LANES]) -> Self {
        let of = |number: fn(&BeddedMotion) -> f64| lanes(simd, |i| number(walls[i]));
        let joint = |j: usize| std::array::from_fn(|i| &walls[i].joints[j]);
        Self {
            joints: [JointLanes::new(simd, &joint(0)), JointLanes::new(simd, &joint(1))],
            freedom: walls[0].freedom,
            masses: Masses {
                m: [of(|wall| wall.masses.m[0]), of(|wall| wall.masses.m[1])],
                i: [of(|wall| wall.masses.i[0]), of(|wall| wall.masses.i[1])],
                m_d: of(|wall| wall.masses.m_d),
                m_dp: of(|wall| wall.masses.m_dp),
            },
            height_1_m: of(|wall| wall.height_1_m),
            g1: Vector::new(of(|wall| wall.g1.x), of(|wall| wall.g1.y)),
            g2: Vector::new(of(|wall| wall.g2.x), of(|wall| wall.g2.y)),
            c: Vector::new(of(|wall| wall.c.x), of(|wall| wall.c.y)),
        }
    }
}
