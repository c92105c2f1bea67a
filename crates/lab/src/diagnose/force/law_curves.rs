//! The laws of hypotheses as forces at the top, to be drawn through the measured points.

use super::points::ForcePoint;
use crate::diagnose::trials::Tried;
use mrbd_kernel::model::{RockingWall, Wall, WallParameters};

/// Points of a curve.
const POINTS: u32 = 120;
/// Most curves over one abscissa.
const MOST: usize = 3;
/// A force below this share of the largest measured one is not drawn.
const VISIBLE: f64 = 1e-3;

/// What of the top's motion a force is drawn against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Against {
    /// Displacement, m.
    Displacement,
    /// Velocity, m/s.
    Velocity,
    /// Absolute acceleration, m/s².
    Acceleration,
}

impl Against {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Displacement, Self::Velocity, Self::Acceleration];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement_m",
            Self::Velocity => "velocity_m_s",
            Self::Acceleration => "acceleration_m_s2",
        }
    }

    /// Where a point stands.
    pub fn of(self, point: &ForcePoint) -> f64 {
        match self {
            Self::Displacement => point.displacement_m,
            Self::Velocity => point.velocity_m_s,
            Self::Acceleration => point.acceleration_m_s2,
        }
    }

    /// The force at the top, beyond inertia of what is there already, by one of the three alone, N.
    fn force_n(self, wall: &RockingWall, x: f64) -> f64 {
        match self {
            Self::Displacement => wall.top_force_n(x, 0.0, 0.0),
            Self::Velocity => wall.top_force_n(0.0, x, 0.0),
            Self::Acceleration => -wall.carriage_mass_kg() * x,
        }
    }
}

/// What a hypothesis adds to the force at the top.
#[derive(Debug, Clone, PartialEq)]
pub struct LawCurve {
    /// The hypothesis.
    pub name: String,
    /// The abscissa.
    pub against: Against,
    /// Abscissa in SI units, force in N.
    pub points: Vec<(f64, f64)>,
}

/// The laws of the best of some hypotheses, in their order, over the range of the measured points; what the wall's own
/// uncertain numbers do beside an addition is left out.
pub fn law_curves(given: &Wall, tried: &[Tried], points: &[ForcePoint]) -> Vec<LawCurve> {
    let before = RockingWall::new(given);
    let largest_n = points.iter().map(|p| p.force_n.abs()).fold(0.0, f64::max);
    let mut curves = Vec::new();
    for against in Against::ALL {
        let reach = points.iter().map(|p| against.of(p).abs()).fold(0.0, f64::max);
        let at = |k: u32| reach * (2.0 * f64::from(k) / f64::from(POINTS) - 1.0);
        let curve = |t: &Tried| {
            let after = RockingWall::new(&with_additions_alone(t)?);
            let added = |x: f64| against.force_n(&after, x) - against.force_n(&before, x);
            let points = (0..=POINTS).map(|k| (at(k), added(at(k)))).collect::<Vec<_>>();
            let name = t.hypothesis.additions.iter().map(|a| a.name()).collect::<Vec<_>>().join(" + ");
            let seen = points.iter().any(|p| p.1.abs() > VISIBLE * largest_n);
            (seen && same_weight(given.parameters(), after.wall().parameters())).then_some(LawCurve {
                name,
                against,
                points,
            })
        };
        curves.extend(tried.iter().filter_map(curve).take(MOST));
    }
    curves
}

/// The wall as given with the additions of a hypothesis, its own numbers where they were.
fn with_additions_alone(tried: &Tried) -> Option<Wall> {
    let h = &tried.hypothesis;
    let own = h.unknowns.iter().take(h.nuisances).map(|u| u.start);
    let values = own.chain(tried.fit.values.iter().skip(h.nuisances).copied()).collect::<Vec<_>>();
    Some(h.physics(&values)?.wall)
}

/// Whether the top carries no other weight than before: else what a hypothesis adds is no horizontal force alone.
fn same_weight(given: &WallParameters, after: &WallParameters) -> bool {
    given.diaphragm_mass_kg == after.diaphragm_mass_kg
}
