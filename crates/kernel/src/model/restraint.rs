//! Laws at the top whose force has kinks, jumps or memory: friction, a gap, one-sided and yielding springs.
//!
//! At any instant the top is in one [`Regime`], in which every such law is smooth: a stiffness, a constant force, a
//! constant drag. A regime ends at a [`Kink`]: a displacement at which a spring begins or ceases to act, or the top's
//! coming to a stop. Runs locate kinks as they locate impacts.

use super::effect::{EffectSums, Yielding};
use super::laws::Laws;

/// Where a quantity stands: below, within or above an interval around zero; sliding to -x, sticking, sliding to +x.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// Below, or towards -x.
    Negative,
    /// Within, or not at all.
    #[default]
    Between,
    /// Above, or towards +x.
    Positive,
}

impl Side {
    /// -1, 0 or +1.
    pub fn sign(self) -> f64 {
        match self {
            Side::Negative => -1.0,
            Side::Between => 0.0,
            Side::Positive => 1.0,
        }
    }

    /// The side on which a number lies.
    pub fn of(x: f64) -> Self {
        if x > 0.0 {
            Side::Positive
        } else if x < 0.0 {
            Side::Negative
        } else {
            Side::Between
        }
    }
}

/// In which of their smooth branches the laws at the top are.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Regime {
    /// Which way the top slides against friction; between: it sticks.
    pub slides: Side,
    /// On which side the gap is closed; between: open.
    pub gap: Side,
    /// On which side of zero the top is displaced, for one-sided springs.
    pub leans: Side,
    /// Which way the yielding spring yields; between: it is elastic.
    pub yields: Side,
    /// Plastic displacement x_p of the yielding spring, m.
    pub plastic_m: f64,
}

/// Where a regime ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kink {
    /// The top passes a displacement, coming from one side of it: sign × (limit - x_C) falls below zero.
    Passes { limit_m: f64, sign: f64, change: Change },
    /// The top stops: sign × ẋ_C falls below zero.
    Stops { sign: f64 },
}

/// What changes where the top passes a displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Change {
    Gap(Side),
    Leans(Side),
    Yields(Side),
}

/// The laws with kinks of one wall, together with its smooth ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Restraint {
    smooth: Laws,
    floor_n_per_m: f64,
    friction_n: f64,
    gap_m: f64,
    one_sided_n_per_m: [f64; 2],
    yielding: Option<Yielding>,
}

impl Restraint {
    /// The laws of a wall, if any has a kink.
    ///
    /// Every sum by its name: a new one does not compile here until somebody says whether its law has kinks.
    pub fn new(smooth: Laws, effects: &EffectSums) -> Option<Self> {
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
            impact_factors: _,
            ground: _,
            reading: _,
        } = *effects;
        let kinks = friction_n > 0.0 || gap_m > 0.0 || one_sided_n_per_m != [0.0; 2] || yielding.is_some();
        let floor_n_per_m = smooth.stiffness_n_per_m;
        kinks.then_some(Self { smooth, floor_n_per_m, friction_n, gap_m, one_sided_n_per_m, yielding })
    }

    /// F_c, N.
    pub fn friction_n(&self) -> f64 {
        self.friction_n
    }

    /// Whether a spring keeps a plastic displacement.
    pub fn yields(&self) -> bool {
        self.yielding.is_some()
    }

    /// Stiffness beyond that of the floor, while every spring acts, N/m.
    pub fn further_stiffness_n_per_m(&self) -> f64 {
        let [negative, positive] = self.one_sided_n_per_m;
        negative.max(positive) + self.yielding.map_or(0.0, |spring| spring.stiffness_n_per_m)
    }

    /// The regime at a displacement and velocity of the top, with a plastic displacement that is moved to where the
    /// spring holds no more than its force.
    pub fn regime_at(&self, x_c_m: f64, v_c_m_s: f64, plastic_m: f64) -> Regime {
        let gap = if x_c_m.abs() > self.gap_m { Side::of(x_c_m) } else { Side::Between };
        let plastic_m = self.yielding.map_or(plastic_m, |spring| spring.plastic_m(plastic_m, x_c_m));
        let leans = if x_c_m == 0.0 { Side::of(v_c_m_s) } else { Side::of(x_c_m) };
        Regime { slides: Side::of(v_c_m_s), gap, leans, yields: Side::Between, plastic_m }
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
            stops(yielding, regime.yields),
            stops(self.friction_n > 0.0, regime.slides),
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
            Kink::Stops { .. } => Regime { slides: Side::Between, ..self.unloaded(regime, x_c_m) },
        }
    }

    /// The regime after the velocity of the top has jumped: a spring that yielded the other way unloads.
    pub fn at_velocity(&self, regime: &Regime, moves: Side, x_c_m: f64) -> Regime {
        let turned = moves.sign() * regime.yields.sign() < 0.0;
        let regime = if turned { self.unloaded(regime, x_c_m) } else { *regime };
        Regime { slides: moves, ..regime }
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
