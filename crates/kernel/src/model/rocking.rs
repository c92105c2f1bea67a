//! The nine contact states of one wall, each with its arms and equations of motion.

use std::sync::Arc;

use fearless_simd::Level;

use super::bed::{Branch, JointLaw};
use super::contact::{Contact, Joint, Pivot, Touching};
use super::formula::{FormulaLaws, Slopes};
use super::geometry::{Arms, Pair, Rotations, TurnedArms};
use super::joint_forces::{JointForce, JointForces, Masses};
use super::laws::{Laws, PiecewiseLaws};
use super::motion::{Motion, MotionRate};
use super::regime::Regime;
use super::vector::Vector;
use super::wall::{G_M_S2, Wall};
use super::whole_impact::WholeImpact;

/// Least velocity that still counts as opening, as a share of α over the time of response. A flight this slow
/// rises to less than a rounding of α and ends within roundings of the time. Without it a wall whose capture
/// velocity is zero would come to rest through infinitely many impacts.
const LEAST_CAPTURE: f64 = 1e-8;

/// Rotations (rad) and angular velocities (rad/s) of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State {
    /// θ_1, θ_2.
    pub theta: Pair,
    /// θ_1', θ_2'.
    pub omega: Pair,
}

/// A wall ready to move.
///
/// A copy shares what is large with its model until it is put into another branch of its laws: short runs would copy for as long as they
/// take.
#[derive(Debug, Clone)]
pub struct RockingWall {
    wall: Arc<Wall>,
    pub(super) masses: Masses,
    pub(super) arms: Arc<[Arms; 9]>,
    pub(super) motions: Arc<[Motion; 9]>,
    /// The same wall on sharp edges, where joints give: whose impacts stiff beds have.
    pub(super) edges: Option<Box<RockingWall>>,
    /// Laws of the joints in place of sharp edges, with what they remember ...
    pub(super) joint_laws: [Option<JointLaw>; 2],
    /// ... and the branches they are in.
    pub(super) branches: [Branch; 2],
    /// One over the weight of the wall, 1/N, and over the widths of the joints, 1/m: corner forces are looked at often.
    per_weight: f64,
    per_width: [f64; 2],
    /// Height over the narrowest joint.
    pub(super) slimness: f64,
    /// Impacts of the wall that turns as one, about the right and the left corner.
    pub(super) whole_impacts: [Option<WholeImpact>; 2],
    /// Relative velocity below which a joint that would open stays closed, rad/s.
    pub(super) capture_rad_s: f64,
    /// C_1 … C_8 with the factors of effects.
    pub(super) coefficients: [f64; 8],
    /// The laws written as formulas, in the branches they are in.
    pub(super) formulas: FormulaLaws,
    /// How stiff and how viscous they are.
    slopes: Slopes,
    /// Laws at the top with kinks, if there are any ...
    pub(super) piecewise_laws: Option<PiecewiseLaws>,
    /// ... below which speed the top is at rest, m/s ...
    pub(super) least_speed_m_s: f64,
    /// ... and the branch they are in.
    pub(super) regime: Regime,
}

impl RockingWall {
    /// Works out the equations of motion of every contact state.
    pub fn new(wall: &Wall) -> Self {
        let p = wall.parameters();
        let laws = Laws::new(p.carriage_mass_kg, p.stiffness_n_per_m, &wall.effects);
        let formulas = FormulaLaws::new(wall.formulas.clone());
        let mut rocking = Self {
            coefficients: wall.coefficients(),
            piecewise_laws: PiecewiseLaws::new(laws, &wall.effects, &formulas),
            slopes: slopes(wall, &formulas),
            formulas,
            least_speed_m_s: 0.0,
            regime: Regime::default(),
            masses: Masses::new(wall, laws.carriage_mass_kg),
            arms: Arc::new(Contact::ALL.map(|contact| Arms::new(wall, contact))),
            motions: Arc::new(Contact::ALL.map(|contact| Motion::new(wall, contact, laws))),
            capture_rad_s: p.restitution.capture_velocity_rad_s,
            edges: wall.gives().then(|| Box::new(Self::new(&wall.with_sharp_edges(&wall.joint_laws)))),
            joint_laws: wall.joint_laws,
            branches: [Branch::default(); 2],
            per_weight: 0.0,
            per_width: [0.0; 2],
            slimness: 0.0,
            whole_impacts: [None; 2],
            wall: Arc::new(wall.clone()),
        };
        rocking.per_weight = 1.0 / rocking.weight_n();
        rocking.per_width = [Joint::Ground, Joint::Crack].map(|joint| 1.0 / rocking.width_m(joint));
        rocking.slimness = rocking.slimness();
        let least = LEAST_CAPTURE * wall.alpha_rad() / rocking.response_time_s();
        rocking.capture_rad_s = rocking.capture_rad_s.max(least);
        rocking.whole_impacts = rocking.whole_impacts();
        rocking.least_speed_m_s = rocking.least_speed_m_s();
        rocking.enter_regime(Regime::default());
        rocking
    }

    /// Moves by these vector instructions, which change nothing but the time it takes.
    pub(crate) fn set_level(&mut self, level: Level) {
        self.motions_mut().iter_mut().for_each(|motion| motion.level = level);
        self.edges.iter_mut().for_each(|edges| edges.set_level(level));
    }

    /// The wall.
    pub fn wall(&self) -> &Wall {
        &self.wall
    }

    #[inline]
    pub(crate) fn motion(&self, contact: Contact) -> &Motion {
        &self.motions[contact.index()]
    }

    /// Those of all contact states, to be changed in this copy alone.
    pub(super) fn motions_mut(&mut self) -> &mut [Motion; 9] {
        Arc::make_mut(&mut self.motions)
    }

    #[inline(always)]
    pub(super) fn turned_arms(&self, contact: Contact, rotations: Rotations) -> TurnedArms {
        let motion = self.motion(contact);
        match &motion.bedded {
            Some(bedded) => bedded.turned_arms(motion, rotations),
            None => TurnedArms::new(&self.arms[contact.index()], rotations.turns),
        }
    }

    /// Angular accelerations and powers in a contact state under a ground acceleration in m/s².
    pub fn rate(&self, contact: Contact, state: &State, ground: Vector) -> MotionRate {
        self.motion(contact).rate(state.theta, state.omega, ground)
    }

    /// Kinetic, gravity and spring energy, J; zero at rest.
    pub fn energy_j(&self, contact: Contact, state: &State) -> f64 {
        self.motion(contact).energy_j(state.theta, state.omega)
    }

    /// Horizontal displacement of the top, relative to the ground, m.
    pub fn top_displacement_m(&self, contact: Contact, theta: Pair) -> f64 {
        self.motion(contact).top_displacement_m(theta)
    }

    /// Horizontal displacement of the middle of the crack, relative to the ground, m, at a rotation of the
    /// lower body. Of an uncracked wall it is that of the top.
    pub fn crack_displacement_m(&self, theta_1: f64) -> f64 {
        let on_bed = self.bed(Joint::Ground).map(|law| law.pivot(theta_1));
        let contact = Contact { ground: on_bed.unwrap_or(Pivot::of_angle(theta_1)), crack: Pivot::Closed };
        if let Some(bedded) = &self.motion(contact).bedded {
            return bedded.crack_displacement_m(theta_1);
        }
        let o_x = Pivot::of_angle(theta_1).sign() * self.width_m(Joint::Ground) / 2.0;
        o_x + Vector::new(-o_x, self.wall.height_m[0]).rotated(theta_1.sin_cos()).x
    }

    /// Time in which an error of velocity becomes one of rotation, s. It is the inverse of the frequency of
    /// small motion of the whole wall on the spring. Where there is no spring it is that of its rocking.
    pub fn response_time_s(&self) -> f64 {
        let p = self.wall.parameters();
        // An eccentric top makes the two sides differ; the heavier one, so that a mirror changes nothing.
        let about = |ground: Pivot| {
            let motion = self.motion(Contact { ground, crack: Pivot::Closed });
            motion.mass_matrix(Rotations::new([0.0; 2])).quadratic([1.0, 1.0])
        };
        let mass = about(Pivot::Right).max(about(Pivot::Left));
        let weight = (self.masses.m[0] + self.masses.m[1] + self.masses.m_d) * G_M_S2;
        let at_top = self.stiffest_n_per_m() + self.slopes.top_at_rest_n_per_m;
        let stiffness = at_top * p.height_m * p.height_m + weight * p.height_m / 2.0;
        (mass / stiffness).sqrt()
    }

    /// Moment about the foot that a rotation of the whole wall needs, N m: that of the spring and of weight, as
    /// [`RockingWall::response_time_s`] counts them.
    pub(super) fn turning_stiffness_n_m(&self) -> f64 {
        let p = self.wall.parameters();
        let at_top = self.stiffest_n_per_m() + self.slopes.top_at_rest_n_per_m;
        at_top * p.height_m * p.height_m + self.weight_n() * p.height_m / 2.0
    }

    /// Rate at which small motions of the wall can change, 1/s: the fastest over the contact states.
    pub fn fastest_rate_per_s(&self) -> f64 {
        let stiffness = self.stiffest_n_per_m();
        let rate = |motion: &Motion| motion.fastest_rate_per_s(stiffness, &self.slopes);
        let fastest = self.motions.iter().map(rate).fold(0.0, f64::max);
        if !self.formulas.carry() {
            return fastest;
        }
        let [half_m, speed_m_s] = self.carried_motion();
        fastest + self.formulas.fastest_carried_per_s(half_m, speed_m_s)
    }

    /// Stiffness at the top while every spring acts, N/m.
    fn stiffest_n_per_m(&self) -> f64 {
        let further =
            self.piecewise_laws.map_or(0.0, |piecewise_laws| piecewise_laws.further_stiffness_n_per_m());
        self.wall.parameters().stiffness_n_per_m + further
    }

    /// Forces through both joints in a contact state with these angular accelerations.
    pub fn joint_forces(
        &self,
        contact: Contact,
        state: &State,
        theta_dd: Pair,
        ground: Vector,
    ) -> JointForces {
        self.motion(contact).reactions(state.theta, state.omega, theta_dd, ground).forces
    }

    /// Smallest corner force of the closed joints, over the weight of the wall; `None` where all joints are
    /// open.
    ///
    /// While it is not negative the closed joints stay closed: the paper's |M_E| <= |M_I| (Eqs. 3 to 6).
    #[inline(always)]
    pub fn smallest_corner_force(&self, contact: Contact, forces: &JointForces) -> Option<f64> {
        if contact.ground.is_open() && contact.crack.is_open() {
            return None;
        }
        let mut smallest = None;
        for joint in self.joints() {
            if contact.at(joint).is_closed() && self.bed(joint).is_none() {
                let JointForce { normal, moment, .. } = *forces.at(joint);
                let (half, lever) = (normal * 0.5, moment * self.per_width(joint));
                let least = (half + lever).min(half - lever) * self.per_weight;
                smallest = Some(smallest.map_or(least, |s: f64| s.min(least)));
            }
        }
        smallest
    }

    /// Weight of all that rests on the ground, N.
    #[inline]
    pub(crate) fn weight_n(&self) -> f64 {
        (self.masses.m[0] + self.masses.m[1] + self.masses.m_d) * G_M_S2
    }

    /// Relative velocity below which a joint that would open stays closed, rad/s.
    #[inline]
    pub(crate) fn capture_rad_s(&self) -> f64 {
        self.capture_rad_s
    }

    /// One over that weight, 1/N.
    #[inline]
    pub(crate) fn per_weight(&self) -> f64 {
        self.per_weight
    }

    /// One over the width between the corners of a closed joint, 1/m.
    #[inline]
    pub(crate) fn per_width(&self, joint: Joint) -> f64 {
        self.per_width[joint as usize]
    }

    /// The law of a joint that gives: its bed, or a rival of that.
    #[inline]
    pub(crate) fn bed(&self, joint: Joint) -> Option<&JointLaw> {
        self.joint_law(joint).filter(|law| law.gives())
    }

    /// The law of a joint that has no sharp edges.
    #[inline]
    pub(crate) fn joint_law(&self, joint: Joint) -> Option<&JointLaw> {
        self.joint_laws[joint as usize].as_ref()
    }

    /// The contact state of a wall with these rotations, joints on beds by the width of their contact.
    pub fn with_beds_as_at(&self, mut contact: Contact, theta: Pair) -> Contact {
        for joint in self.joints() {
            if let Some(bed) = self.bed(joint) {
                contact = contact.with(joint, bed.pivot(opening(joint, theta)));
            }
        }
        contact
    }

    /// Whether nothing moves in a contact state: both joints closed on edges that do not give.
    #[inline]
    pub(crate) fn rests_in(&self, contact: Contact) -> bool {
        contact == Contact::REST && !self.wall.gives()
    }

    /// The contact state as far as sharp edges go: joints on beds count as closed.
    #[inline]
    pub(crate) fn edges_of(&self, mut contact: Contact) -> Contact {
        if self.wall.gives() {
            for joint in [Joint::Ground, Joint::Crack] {
                if self.bed(joint).is_some() {
                    contact = contact.with(joint, Pivot::Closed);
                }
            }
        }
        contact
    }

    /// The joints on sharp edges that are closed.
    pub(crate) fn closed_edges(&self, contact: Contact) -> Touching {
        let closed = |joint: Joint| contact.at(joint).is_closed() && self.bed(joint).is_none();
        Touching { ground: closed(Joint::Ground), crack: closed(Joint::Crack) }
    }

    /// The joints the wall has: an uncracked wall has no crack.
    pub(crate) fn joints(&self) -> impl Iterator<Item = Joint> + use<> {
        let cracked = self.wall.is_cracked();
        [Joint::Ground, Joint::Crack].into_iter().take(if cracked { 2 } else { 1 })
    }

    /// Height over the narrowest joint.
    fn slimness(&self) -> f64 {
        let p = self.wall.parameters();
        let narrowest = self.joints().map(|joint| self.width_m(joint)).fold(f64::INFINITY, f64::min);
        p.height_m / narrowest
    }

    /// Width between the corners of a closed joint, m.
    #[inline]
    pub(crate) fn width_m(&self, joint: Joint) -> f64 {
        match self.joint_law(joint) {
            Some(law) if !law.gives() => law.edge_width_m(),
            _ => self.wall.width_m[joint as usize],
        }
    }
}

/// Slopes of formulas over displacements of half the thickness, rotations α, and the speeds of a wall that rocks so.
fn slopes(wall: &Wall, formulas: &FormulaLaws) -> Slopes {
    let p = wall.parameters();
    let (half_m, alpha) = (p.thickness_m / 2.0, wall.alpha_rad());
    let per_s = (G_M_S2 / p.height_m).sqrt();
    let sizes = [half_m, alpha, alpha];
    formulas.slopes(sizes, sizes.map(|size| size * per_s))
}

/// Opening of a joint that goes with a pair of body rotations, velocities or accelerations: θ_1, or θ_2 - θ_1.
#[inline]
pub(crate) fn opening(joint: Joint, pair: Pair) -> f64 {
    match joint {
        Joint::Ground => pair[0],
        Joint::Crack => pair[1] - pair[0],
    }
}
