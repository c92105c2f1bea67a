//! The forces on a wall beyond its weight and inertia. Some laws are smooth; those with kinks are smooth in
//! each regime.

use super::effect::{EffectSums, Lanes, Yielding};
use super::formula::FormulaLaws;
use super::geometry::Pair;
use super::regime::{Change, Kink, Regime, Side, TopMemory};
use crate::fused::fused;

/// Everything that acts on the wall beyond its own masses, summed over the wall's spring and its effects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Laws {
    /// m_dp, kg.
    pub carriage_mass_kg: f64,
    /// Stiffness at the top, N/m: k_d and what else is elastic at the time.
    pub stiffness_n_per_m: f64,
    /// k_3, N/m³.
    pub cubic_n_per_m3: f64,
    /// Force of the springs at the top at no displacement, N.
    pub spring_offset_n: f64,
    /// Energy of the springs at the top at no displacement, J.
    pub stored_offset_j: f64,
    /// c at the top, N s/m.
    pub viscous_n_s_per_m: f64,
    /// Force at the top that takes energy whatever the velocity, N: friction and yielding.
    pub drag_n: f64,
    /// c at the ground and at the crack, N m s/rad.
    pub joint_damping_n_m_s: [f64; 2],
    /// What the lanes do of these laws, as the catalogue says of the effects they are made of.
    pub lanes: Lanes,
}

impl Laws {
    /// The wall's own spring and the smooth effects.
    pub fn new(carriage_mass_kg: f64, stiffness_n_per_m: f64, effects: &EffectSums) -> Self {
        Self {
            carriage_mass_kg: carriage_mass_kg + effects.carriage_mass_kg,
            stiffness_n_per_m,
            cubic_n_per_m3: effects.cubic_n_per_m3,
            spring_offset_n: 0.0,
            stored_offset_j: 0.0,
            viscous_n_s_per_m: effects.viscous_n_s_per_m,
            drag_n: 0.0,
            joint_damping_n_m_s: effects.joint_damping_n_m_s,
            lanes: effects.lanes,
        }
    }

    /// Horizontal force of the springs at the top, N, at a displacement in m.
    #[inline(always)]
    pub fn spring_force_n(&self, x_c_m: f64) -> f64 {
        // A linear spring need not wait for a square.
        if self.cubic_n_per_m3 == 0.0 {
            return fused(-self.stiffness_n_per_m, x_c_m, self.spring_offset_n);
        }
        let secant = fused(self.cubic_n_per_m3 * x_c_m, x_c_m, self.stiffness_n_per_m);
        fused(-secant, x_c_m, self.spring_offset_n)
    }

    /// Whether anything takes energy.
    pub fn is_damped(&self) -> bool {
        self.viscous_n_s_per_m != 0.0 || self.drag_n != 0.0 || self.joint_damping_n_m_s != [0.0; 2]
    }

    /// Energy stored in the springs at the top, J.
    pub fn spring_energy_j(&self, x_c_m: f64) -> f64 {
        let square = x_c_m * x_c_m;
        let elastic = 0.5 * self.stiffness_n_per_m * square + 0.25 * self.cubic_n_per_m3 * square * square;
        elastic - self.spring_offset_n * x_c_m + self.stored_offset_j
    }

    /// Horizontal force at the top against its velocity, N.
    #[inline(always)]
    pub fn damping_force_n(&self, v_c_m_s: f64) -> f64 {
        fused(-self.viscous_n_s_per_m, v_c_m_s, self.drag_n)
    }

    /// Generalised moments of the joint dampers on θ_1 and θ_2, N m.
    #[inline(always)]
    pub fn joint_moments_n_m(&self, [omega_1, omega_2]: Pair) -> Pair {
        let [c_ground, c_crack] = self.joint_damping_n_m_s;
        let at_crack = c_crack * (omega_2 - omega_1);
        [fused(-c_ground, omega_1, at_crack), -at_crack]
    }
}

/// The laws with kinks of one wall, together with its smooth ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PiecewiseLaws {
    smooth: Laws,
    floor_n_per_m: f64,
    friction_n: f64,
    /// Whether a formula jumps against the motion.
    formulas_rub: bool,
    /// Whether a formula depends on how far the top has been.
    formulas_remember: bool,
    gap_m: f64,
    one_sided_n_per_m: [f64; 2],
    yielding: Option<Yielding>,
}

impl PiecewiseLaws {
    /// The laws of a wall, if any has a kink.
    ///
    /// Every sum by its name: a new one does not compile here until somebody says whether its law has kinks.
    pub fn new(smooth: Laws, effects: &EffectSums, formulas: &FormulaLaws) -> Option<Self> {
        let EffectSums {
            friction_n,
            gap_half_width_m: gap_m,
            one_sided_n_per_m,
            yielding,
            // In the smooth laws.
            carriage_mass_kg: _,
            viscous_n_s_per_m: _,
            cubic_n_per_m3: _,
            joint_damping_n_m_s: _,
            lanes: _,
            // In the widths, at impacts, in the ground motion, in the reading.
            indentation_m: _,
            joints: _,
            impact_factors: _,
            impact_fading_s_per_m: _,
            ground: _,
            reading: _,
        } = *effects;
        let (formulas_rub, formulas_remember) = (formulas.rubs(), formulas.remember_largest());
        let rubs = friction_n > 0.0 || formulas_rub;
        let kinks =
            rubs || formulas_remember || gap_m > 0.0 || one_sided_n_per_m != [0.0; 2] || yielding.is_some();
        let floor_n_per_m = smooth.stiffness_n_per_m;
        kinks.then_some(Self {
            smooth,
            floor_n_per_m,
            friction_n,
            formulas_rub,
            formulas_remember,
            gap_m,
            one_sided_n_per_m,
            yielding,
        })
    }

    /// Whether friction can hold the top.
    pub fn rubs(&self) -> bool {
        self.friction_n > 0.0 || self.formulas_rub
    }

    /// F_c of friction of constant force, N.
    pub fn friction_n(&self) -> f64 {
        self.friction_n
    }

    /// Whether a spring keeps a plastic displacement.
    pub fn yields(&self) -> bool {
        self.yielding.is_some()
    }

    /// Whether the wall is not at rest as it was before: by a spring that has yielded, or by how far it has been.
    pub fn remembers(&self) -> bool {
        self.yields() || self.formulas_remember
    }

    /// Stiffness beyond that of the floor, while every spring acts, N/m.
    pub fn further_stiffness_n_per_m(&self) -> f64 {
        let [negative, positive] = self.one_sided_n_per_m;
        negative.max(positive) + self.yielding.map_or(0.0, |spring| spring.stiffness_n_per_m)
    }

    /// The regime at a displacement and velocity of the top. The plastic displacement moves to where the
    /// spring holds no more than its force, and the largest to no less than the displacement.
    pub fn regime_at(&self, x_c_m: f64, v_c_m_s: f64, memory: TopMemory) -> Regime {
        let TopMemory { plastic_m, largest_m, .. } = memory;
        let gap = if x_c_m.abs() > self.gap_m { Side::of(x_c_m) } else { Side::Between };
        let plastic_m = self.yielding.map_or(plastic_m, |spring| spring.plastic_m(plastic_m, x_c_m));
        let leans = if x_c_m == 0.0 { Side::of(v_c_m_s) } else { Side::of(x_c_m) };
        Regime {
            slides: Side::of(v_c_m_s),
            gap,
            leans,
            yields: Side::Between,
            plastic_m,
            grows: Side::Between,
            largest_m: largest_m.max(x_c_m.abs()),
        }
    }

    /// Largest elastic displacement x_y of the yielding spring, m; 0 without one.
    fn elastic_m(&self) -> f64 {
        self.yielding.map_or(0.0, |spring| spring.elastic_m())
    }

    /// The smooth laws of a regime.
    pub fn laws(&self, regime: &Regime) -> Laws {
        let mut laws = self.smooth;
        if self.gap_m > 0.0 {
            laws.stiffness_n_per_m = 0.0;
            if regime.gap != Side::Between {
                // F = -k_d (x ∓ g)
                let k_d = self.floor_n_per_m;
                laws.stiffness_n_per_m = k_d;
                laws.spring_offset_n += regime.gap.sign() * k_d * self.gap_m;
                laws.stored_offset_j += 0.5 * k_d * self.gap_m * self.gap_m;
            }
        }
        laws.stiffness_n_per_m += match regime.leans {
            Side::Negative => self.one_sided_n_per_m[0],
            Side::Between => 0.0,
            Side::Positive => self.one_sided_n_per_m[1],
        };
        if let Some(Yielding { stiffness_n_per_m: k, force_n: f_y }) = self.yielding {
            if regime.yields == Side::Between {
                // F = -k (x - x_p)
                laws.stiffness_n_per_m += k;
                laws.spring_offset_n += k * regime.plastic_m;
                laws.stored_offset_j += 0.5 * k * regime.plastic_m * regime.plastic_m;
            } else {
                laws.drag_n -= regime.yields.sign() * f_y;
                laws.stored_offset_j += 0.5 * f_y * f_y / k;
            }
        }
        laws.drag_n -= regime.slides.sign() * self.friction_n;
        laws
    }

    /// Where a regime may end.
    pub fn kinks(&self, regime: &Regime) -> impl Iterator<Item = Kink> + use<> {
        let passes = |limit_m: f64, sign: f64, change: Change| Some(Kink::Passes { limit_m, sign, change });
        let beyond = |acts: bool, sign: f64, limit_m: f64, change: Change| match acts {
            true => passes(limit_m, sign, change),
            false => None,
        };
        let gap = self.gap_m > 0.0;
        let leaning = self.one_sided_n_per_m != [0.0; 2];
        let yielding = self.yielding.is_some();
        let x_y = self.elastic_m();
        let closes = gap && regime.gap == Side::Between;
        let leans = regime.leans.sign();
        let elastic = yielding && regime.yields == Side::Between;
        let within = self.formulas_remember && regime.grows == Side::Between;
        let stops = |acts: bool, side: Side| {
            (acts && side != Side::Between).then_some(Kink::Stops { sign: side.sign() })
        };
        [
            beyond(closes, 1.0, self.gap_m, Change::Gap(Side::Positive)),
            beyond(closes, -1.0, -self.gap_m, Change::Gap(Side::Negative)),
            beyond(
                gap && !closes,
                -regime.gap.sign(),
                regime.gap.sign() * self.gap_m,
                Change::Gap(Side::Between),
            ),
            // A top that stands at zero leans to neither side yet: whichever it moves to.
            beyond(leaning && leans <= 0.0, 1.0, 0.0, Change::Leans(Side::Positive)),
            beyond(leaning && leans >= 0.0, -1.0, 0.0, Change::Leans(Side::Negative)),
            beyond(elastic, 1.0, regime.plastic_m + x_y, Change::Yields(Side::Positive)),
            beyond(elastic, -1.0, regime.plastic_m - x_y, Change::Yields(Side::Negative)),
            beyond(within, 1.0, regime.largest_m, Change::Grows(Side::Positive)),
            beyond(within, -1.0, -regime.largest_m, Change::Grows(Side::Negative)),
            stops(self.formulas_remember, regime.grows),
            stops(yielding, regime.yields),
            stops(self.rubs(), regime.slides),
        ]
        .into_iter()
        .flatten()
    }

    /// The regime after a kink at a displacement.
    pub fn after(&self, regime: &Regime, kink: Kink, x_c_m: f64) -> Regime {
        match kink {
            Kink::Passes { change: Change::Gap(gap), .. } => Regime { gap, ..*regime },
            Kink::Passes { change: Change::Leans(leans), .. } => Regime { leans, ..*regime },
            Kink::Passes { change: Change::Yields(yields), .. } => Regime { yields, ..*regime },
            Kink::Passes { change: Change::Grows(grows), .. } => Regime { grows, ..*regime },
            Kink::Stops { .. } => Regime { slides: Side::Between, ..self.turned_back(regime, x_c_m) },
            // A switch of a formula is none of the regime's.
            Kink::Turns { .. } => *regime,
        }
    }

    /// The regime after the velocity of the top has jumped: a spring that yielded the other way unloads, and what went
    /// farther out than ever has come back.
    pub fn at_velocity(&self, regime: &Regime, moves: Side, x_c_m: f64) -> Regime {
        let turned = |side: Side| moves.sign() * side.sign() < 0.0;
        let regime = if turned(regime.yields) { self.unloaded(regime, x_c_m) } else { *regime };
        let regime = if turned(regime.grows) { inside(&regime, x_c_m) } else { regime };
        Regime { slides: moves, ..regime }
    }

    /// The regime once the top has stopped.
    fn turned_back(&self, regime: &Regime, x_c_m: f64) -> Regime {
        inside(&self.unloaded(regime, x_c_m), x_c_m)
    }

    /// The regime once the spring does not yield any more.
    fn unloaded(&self, regime: &Regime, x_c_m: f64) -> Regime {
        match regime.yields {
            Side::Between => *regime,
            side => {
                let plastic_m = x_c_m - side.sign() * self.elastic_m();
                Regime { yields: Side::Between, plastic_m, ..*regime }
            }
        }
    }
}

/// The regime once the top does not go farther out any more.
fn inside(regime: &Regime, x_c_m: f64) -> Regime {
    match regime.grows {
        Side::Between => *regime,
        _ => Regime { grows: Side::Between, largest_m: regime.largest_m.max(x_c_m.abs()), ..*regime },
    }
}
