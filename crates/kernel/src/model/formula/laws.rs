//! All formulas of one wall, each in its branch: their forces, and what friction among them can hold.

use mrbd_formula::Branch;

use super::super::contact::Joint;
use super::super::geometry::Pair;
use super::super::regime::Side;
use super::law::{FormulaLaw, Largest};

/// Stiffness and damping of formulas, at the top and at both joints, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Slopes {
    /// At the top, at rest, N/m.
    pub top_at_rest_n_per_m: f64,
    /// Largest at the top, N/m and N s/m.
    pub top: Pair,
    /// Largest at the ground and at the crack, N m and N m s.
    pub joints: [Pair; 2],
}

/// Moments at joints of formulas of which none acts there, with the signs that zeros have as sums of nothing.
pub(super) const NO_MOMENTS: Pair = [0.0, -0.0];

/// All formulas of a wall.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct FormulaLaws {
    pub(super) laws: Vec<FormulaLaw>,
    /// Whether any acts at a joint, and whether any that does depends on the rotation there.
    at_joints: bool,
    asks_rotations: bool,
}

impl FormulaLaws {
    pub fn new(laws: Vec<FormulaLaw>) -> Self {
        Self {
            at_joints: laws.iter().any(|law| law.joint.is_some()),
            asks_rotations: laws.iter().any(|law| law.joint.is_some() && law.asks_where),
            laws,
        }
    }

    /// Whether any acts at a joint.
    #[inline(always)]
    pub fn act_at_joints(&self) -> bool {
        self.at_joints
    }

    /// Whether any that acts at a joint depends on the rotation there.
    #[inline(always)]
    pub fn ask_rotations(&self) -> bool {
        self.asks_rotations
    }

    /// Takes over those of another wall.
    #[inline]
    pub fn copy(&mut self, other: &Self) {
        if !self.is_empty() || !other.is_empty() {
            self.laws.clone_from(&other.laws);
            (self.at_joints, self.asks_rotations) = (other.at_joints, other.asks_rotations);
        }
    }

    /// Whether there is none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.laws.is_empty()
    }

    /// Force at the top, N.
    #[inline(never)]
    pub fn top_force_n(&self, x_c_m: f64, v_c_m_s: f64) -> f64 {
        self.at(None).map(|law| law.value(x_c_m, v_c_m_s)).sum()
    }

    /// The same as the formulas are written.
    pub fn top_force_as_written_n(&self, x_c_m: f64, v_c_m_s: f64) -> f64 {
        self.at(None).map(|law| law.as_written(x_c_m, v_c_m_s)).sum()
    }

    /// Moments on θ_1 and θ_2, N m, of those at the joints: M_1 - M_2 and M_2. Where there are none, [`NO_MOMENTS`].
    #[inline(always)]
    pub fn joint_moments_n_m(&self, theta: impl Fn() -> Pair, omega: Pair) -> Pair {
        if !self.at_joints {
            return NO_MOMENTS;
        }
        // Angles cost more than most formulas.
        self.moments_n_m(if self.asks_rotations { theta() } else { [0.0; 2] }, omega)
    }

    #[inline(never)]
    fn moments_n_m(&self, theta: Pair, omega: Pair) -> Pair {
        let across = |pair: Pair| [pair[0], pair[1] - pair[0]];
        let (phi, rates) = (across(theta), across(omega));
        let [ground, crack] = [Joint::Ground, Joint::Crack].map(|joint| {
            let i = joint as usize;
            self.at(Some(joint)).map(|law| law.value(phi[i], rates[i])).sum::<f64>()
        });
        [ground - crack, crack]
    }

    fn at(&self, joint: Option<Joint>) -> impl Iterator<Item = &FormulaLaw> {
        self.laws.iter().filter(move |law| law.joint == joint)
    }

    /// Whether any holds the top by friction.
    pub fn rubs(&self) -> bool {
        self.laws.iter().any(|law| law.friction.is_some())
    }

    /// Whether any depends on how far the top has been.
    pub fn remember_largest(&self) -> bool {
        self.laws.iter().any(|law| law.largest.is_some())
    }

    /// What friction can add at the top while it holds it: the least and the most, N.
    pub fn holds_n(&self, x_c_m: f64) -> [f64; 2] {
        let limits = self.at(None).map(|law| law.holds_n(x_c_m));
        limits.fold([0.0; 2], |sum, limit| [sum[0] + limit[0], sum[1] + limit[1]])
    }

    /// Puts friction in the branch of the way the top slides.
    pub fn slide(&mut self, slides: Side) {
        let branch = match slides {
            Side::Negative => Branch::Negative,
            Side::Between => Branch::Zero,
            Side::Positive => Branch::Positive,
        };
        for law in &mut self.laws {
            if let Some(switch) = law.friction {
                law.branches = law.branches.with(switch, branch);
            }
        }
    }

    /// Tells how far the top has been, m, and on which side it is farther out now.
    pub fn remember(&mut self, grows: Side, before_m: f64) {
        for law in self.laws.iter_mut().filter(|law| law.largest.is_some()) {
            law.largest = Some(Largest { grows, before_m });
        }
    }

    /// Takes branches and memory of the same formulas elsewhere.
    pub fn take_branches(&mut self, other: &Self) {
        for (own, law) in self.laws.iter_mut().zip(&other.laws) {
            (own.branches, own.largest, own.carried.now) = (law.branches, law.largest, law.carried.now);
        }
    }

    /// How stiff and how viscous they are, over displacements up to a size in m or rad and speeds up to a size
    /// in m/s or rad/s.
    pub fn slopes(&self, size: [f64; 3], speed: [f64; 3]) -> Slopes {
        let mut slopes = Slopes::default();
        for law in &self.laws {
            let place = law.joint.map_or(0, |joint| 1 + joint as usize);
            let largest = largest_slopes(law, size[place], speed[place]);
            let of_place = if place == 0 { &mut slopes.top } else { &mut slopes.joints[place - 1] };
            *of_place = [of_place[0] + largest[0], of_place[1] + largest[1]];
            if place == 0 {
                let near = LEAST_SHARE * size[0];
                let sides = [near, -near].map(|x_c| law.slopes_at(x_c, 0.0)[0]);
                slopes.top_at_rest_n_per_m += sides[0].max(sides[1]);
            }
        }
        slopes
    }
}

/// Where slopes are looked at, as shares of a size: near rest too, not at rest, where a root has no slope.
const SHARES: [f64; 4] = [LEAST_SHARE, 0.1, 0.5, 1.0];
const LEAST_SHARE: f64 = 1e-3;

fn largest_slopes(law: &FormulaLaw, size: f64, speed: f64) -> Pair {
    let both = |most: f64| SHARES.into_iter().flat_map(move |share| [share * most, -share * most]);
    let states = both(size).flat_map(|q| both(speed).chain([0.0]).map(move |rate| (q, rate)));
    states.map(|(q, rate)| law.slopes_at(q, rate)).fold([0.0; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
}
