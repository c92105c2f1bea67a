//! What the missing force looks like: at the top or not, a curve against one quantity, bent, or a law of the catalogue.

use super::points::{ForcePoint, median_share_off_top};
use crate::diagnose::trials::FittedHypothesis;
use crate::limits::{ALONG_TOP, EXPLAINED_BY_ONE, FORCE_CLEAR, LEAST_DIRECTIONS};
use mrbd_kernel::model::{RockingWall, Wall, WallParameters};
use mrbd_statistics::normal::NINETY_PERCENT;
use nalgebra::{DMatrix, DVector};

/// Whether the points lie along the direction of a force at the top, and on a curve against what the top does.
///
/// Wrong corners make a curve of displacement too, a step at zero, but off that direction.
pub fn acts_at_top(points: &[ForcePoint]) -> bool {
    let along = lie_along_top(points) == Some(true);
    let explained = |against| explained_by(points, against).is_some_and(|share| share > EXPLAINED_BY_ONE);
    along && Against::ALL.into_iter().any(explained)
}

/// Whether the points lie along the direction of a force at the top; `None` where too few have a direction, as those of a crack that
/// hardly opens.
pub fn lie_along_top(points: &[ForcePoint]) -> Option<bool> {
    let (share, _) = median_share_off_top(points).filter(|(_, count)| *count >= LEAST_DIRECTIONS)?;
    Some(share < ALONG_TOP)
}

/// A point says nothing if its noise is so many times the usual and such a share of its force.
const NOISY: f64 = 2.0;
const NOISY_SHARE: f64 = 0.2;

/// Share of the squared missing force, noise taken off, that a line between the neighbours of each point explains.
/// `None` where the force is hardly more than noise.
///
/// 1: the force is a function of this quantity alone, sampled closely enough; 0 or less: it is none.
pub fn explained_by(points: &[ForcePoint], against: Against) -> Option<f64> {
    let mut points = telling(points);
    points.sort_by(|a, b| against.of(a).total_cmp(&against.of(b)));
    let inner = points.get(1..points.len().saturating_sub(1))?;
    let force = inner.iter().map(|p| p.force_n.powi(2)).sum::<f64>();
    let noise = inner.iter().map(|p| p.force_sd_n.powi(2)).sum::<f64>();
    if inner.is_empty() || force < FORCE_CLEAR * noise {
        return None;
    }
    let mut left = 0.0;
    for trio in points.windows(3) {
        let [before, here, after] = [trio[0], trio[1], trio[2]];
        let [x0, x, x1] = [before, here, after].map(|p| against.of(p));
        let share = if x1 > x0 { (x - x0) / (x1 - x0) } else { 0.5 };
        let apart = here.force_n - (1.0 - share) * before.force_n - share * after.force_n;
        let part = |share: f64, p: &ForcePoint| (share * p.force_sd_n).powi(2);
        left += apart * apart - part(1.0, here) - part(1.0 - share, before) - part(share, after);
    }
    Some(1.0 - left.max(0.0) / (force - noise))
}

fn telling(points: &[ForcePoint]) -> Vec<&ForcePoint> {
    let mut noise = points.iter().map(|p| p.force_sd_n).collect::<Vec<_>>();
    noise.sort_by(f64::total_cmp);
    let usual = noise.get(noise.len() / 2).copied().unwrap_or(0.0);
    let tells =
        |p: &&ForcePoint| p.force_sd_n < NOISY * usual || p.force_sd_n < NOISY_SHARE * p.force_n.abs();
    points.iter().filter(tells).collect()
}

/// Fewest points to each number of a regression.
const POINTS_A_NUMBER: usize = 5;
/// Standard deviations beyond which a point counts less (Huber): a kink of the motion within its stretch.
const USUAL: f64 = 3.0;
/// Rounds of reweighting; the weights settle within a few.
const ROUNDS: usize = 6;

/// How much of what is left one further law of the velocity takes away that is no line, in squared standard
/// deviations. The laws are drag as v |v|, damping that grows with displacement as |x| v, and friction as the sign of
/// v.
///
/// Lines against displacement, velocity and acceleration are taken off first. The fit of windows weighs other
/// instants, and may take a little of one for another. Laws of displacement alone are left out. Near x = 0, where
/// impacts are, smoothing makes a curve of its own at a large noise. `None` where there are too few points.
pub fn curve_left(points: &[ForcePoint]) -> Option<f64> {
    let of = |law: fn(&ForcePoint) -> f64| points.iter().map(law).collect::<Vec<_>>();
    let lines = [of(|p| p.displacement_m), of(|p| p.velocity_m_s), of(|p| p.acceleration_m_s2)];
    if points.len() < POINTS_A_NUMBER * (lines.len() + 1) {
        return None;
    }
    let curves = [
        of(|p| p.velocity_m_s * p.velocity_m_s.abs()),
        of(|p| p.displacement_m.abs() * p.velocity_m_s),
        of(|p| p.velocity_m_s.signum()),
    ];
    let straight = left_by(points, &lines)?;
    let bent = curves.into_iter().filter_map(|curve| {
        let [x, v, a] = lines.clone();
        left_by(points, &[x, v, a, curve])
    });
    bent.map(|left| straight - left).reduce(f64::max)
}

/// Squared error, in standard deviations, that a sum of such columns leaves of the force in least squares. Far points
/// count by their distance, not its square. `None` where the columns are no independent ones.
fn left_by(points: &[ForcePoint], columns: &[Vec<f64>]) -> Option<f64> {
    let size = |column: &Vec<f64>| column.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let sizes = columns.iter().map(size).collect::<Vec<_>>();
    let terms = DMatrix::from_fn(points.len(), columns.len(), |row, k| columns[k][row] / sizes[k]);
    let force = DVector::from_iterator(points.len(), points.iter().map(|p| p.force_n));
    let mut weights = points.iter().map(|p| p.force_sd_n.powi(-2)).collect::<Vec<_>>();
    let mut left = Vec::new();
    for _ in 0..ROUNDS {
        let weighed = DMatrix::from_fn(points.len(), columns.len(), |row, k| weights[row] * terms[(row, k)]);
        let factors = (weighed.transpose() * &terms).cholesky()?.solve(&(weighed.transpose() * &force));
        let apart = &force - &terms * factors;
        left = points.iter().zip(apart.iter()).map(|(p, apart)| apart.abs() / p.force_sd_n).collect();
        for ((weight, z), point) in weights.iter_mut().zip(&left).zip(points) {
            *weight = (USUAL / z.max(USUAL)) * point.force_sd_n.powi(-2);
        }
    }
    let huber = |z: &f64| if *z > USUAL { USUAL * (2.0 * z - USUAL) } else { z * z };
    Some(left.iter().map(huber).sum())
}

/// Points of a curve.
const POINTS: usize = 120;
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

    /// The force at the top, beyond inertia of what is there already, by one of the three alone, N; by velocity at a
    /// displacement.
    fn force_n(self, wall: &RockingWall, x: f64, displacement_m: f64) -> f64 {
        match self {
            Self::Displacement => wall.top_force_n(x, 0.0, 0.0),
            Self::Velocity => {
                wall.top_force_n(displacement_m, x, 0.0) - wall.top_force_n(displacement_m, 0.0, 0.0)
            }
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
    /// Where it is told.
    pub points: Vec<CurvePoint>,
}

/// A point of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Abscissa, SI units.
    pub x: f64,
    /// Force, N.
    pub force_n: f64,
    /// Its 90 % interval, N; `None` where the tests do not tell one.
    pub interval_n: Option<[f64; 2]>,
}

/// A hypothesis that is drawn.
#[derive(Debug)]
pub struct Drawn<'t> {
    /// As it was fitted.
    pub tried: &'t FittedHypothesis,
    /// Covariance of its values; without one it is drawn without a band.
    pub covariance: Option<DMatrix<f64>>,
}

/// The laws of the best of some hypotheses, in their order, over the range of the measured points. What the wall's
/// own uncertain numbers do beside an addition is left out.
pub fn law_curves(given: &Wall, tried: &[Drawn], points: &[ForcePoint]) -> Vec<LawCurve> {
    let largest_n = points.iter().map(|p| p.force_n.abs()).fold(0.0, f64::max);
    let reach = |against: Against| points.iter().map(|p| against.of(p).abs()).fold(0.0, f64::max);
    let displacement_m = HALFWAY * reach(Against::Displacement);
    let mut curves = Vec::new();
    for against in Against::ALL {
        let curve = |drawn: &Drawn| {
            let slice = |displacement_m: f64| {
                let seen = Slice { given, against, reach: reach(against), displacement_m };
                seen.curve(drawn).filter(|c| c.points.iter().any(|p| p.force_n.abs() > VISIBLE * largest_n))
            };
            // A damper that grows with displacement does nothing where the wall stands upright.
            let beside = || slice(displacement_m).filter(|_| against == Against::Velocity);
            slice(0.0).or_else(beside)
        };
        curves.extend(tried.iter().filter_map(curve).take(MOST));
    }
    curves
}

/// Share of the largest displacement at which a law is drawn against velocity where it does nothing upright.
const HALFWAY: f64 = 0.5;

/// What a force is drawn against, and at which displacement.
struct Slice<'w> {
    given: &'w Wall,
    against: Against,
    reach: f64,
    displacement_m: f64,
}

impl Slice<'_> {
    fn curve(&self, drawn: &Drawn) -> Option<LawCurve> {
        let h = &drawn.tried.hypothesis;
        let force_n = self.forces(drawn.tried, &drawn.tried.fit.values)?;
        let half_n = drawn.covariance.as_ref().and_then(|c| self.half_widths(drawn.tried, c));
        let point = |(k, force_n): (usize, f64)| CurvePoint {
            x: self.at(k),
            force_n,
            interval_n: half_n.as_ref().map(|half| [force_n - half[k], force_n + half[k]]),
        };
        let name = h.additions.iter().map(|a| a.name()).collect::<Vec<_>>().join(" + ");
        let beside = match self.displacement_m {
            0.0 => String::new(),
            x => format!(", at x = {x:.3} m"),
        };
        let points = force_n.into_iter().enumerate().map(point).collect();
        Some(LawCurve { name: name + &beside, against: self.against, points })
    }

    fn at(&self, k: usize) -> f64 {
        self.reach * (2.0 * k as f64 / POINTS as f64 - 1.0)
    }

    /// What additions with these values add, N; `None` where they are no horizontal force alone.
    fn forces(&self, tried: &FittedHypothesis, values: &[f64]) -> Option<Vec<f64>> {
        let [before, after] =
            [RockingWall::new(self.given), RockingWall::new(&with_additions_alone(tried, values)?)];
        let force_n = |wall: &RockingWall, x: f64| self.against.force_n(wall, x, self.displacement_m);
        let added = |k: usize| force_n(&after, self.at(k)) - force_n(&before, self.at(k));
        let same = same_weight(self.given.parameters(), after.wall().parameters());
        same.then(|| (0..=POINTS).map(added).collect())
    }

    /// Half widths of 90 % intervals by the added numbers, linear about the fit; `None` where one leaves no trace.
    fn half_widths(&self, tried: &FittedHypothesis, covariance: &DMatrix<f64>) -> Option<Vec<f64>> {
        let h = &tried.hypothesis;
        let added = h.nuisances..h.unknowns.len();
        let own = covariance.view((added.start, added.start), (added.len(), added.len()));
        let slope = |i: usize| {
            let sd = covariance[(i, i)].sqrt();
            let side = |by: f64| {
                let mut values = tried.fit.values.clone();
                values[i] = (values[i] + by * CHANGE_SD * sd).clamp(h.unknowns[i].lower, h.unknowns[i].upper);
                Some((values[i], self.forces(tried, &values)?))
            };
            let ((low, before), (high, after)) = (side(-1.0)?, side(1.0)?);
            let slope = before.iter().zip(&after).map(|(b, a)| (a - b) / (high - low));
            (sd.is_finite() && high > low).then(|| DVector::from_iterator(before.len(), slope))
        };
        let slopes = DMatrix::from_columns(&added.map(slope).collect::<Option<Vec<_>>>()?);
        let half = |row: usize| {
            let slope = slopes.row(row);
            NINETY_PERCENT * (slope * own * slope.transpose())[(0, 0)].max(0.0).sqrt()
        };
        Some((0..slopes.nrows()).map(half).collect())
    }
}

/// Change of a number over which the slope of a force is taken, in its standard deviations.
const CHANGE_SD: f64 = 0.5;

/// The wall as given with additions of these values, its own numbers where they were.
fn with_additions_alone(tried: &FittedHypothesis, values: &[f64]) -> Option<Wall> {
    let h = &tried.hypothesis;
    let own = h.unknowns.iter().take(h.nuisances).map(|u| u.start);
    let values = own.chain(values.iter().skip(h.nuisances).copied()).collect::<Vec<_>>();
    Some(h.physics(&values)?.wall)
}

/// Whether the top carries no other weight than before: else what a hypothesis adds is no horizontal force alone.
fn same_weight(given: &WallParameters, after: &WallParameters) -> bool {
    given.diaphragm_mass_kg == after.diaphragm_mass_kg
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::Contact;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// Two hundred points of a swing, a force of this law with noise of 10 N, and two points far off.
    fn points(law: fn(f64, f64) -> f64) -> Vec<ForcePoint> {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let point = |k: u32| {
            let (phase, swing) = (0.37 * f64::from(k), 0.05 + 1e-4 * f64::from(k));
            let (displacement_m, velocity_m_s) = (swing * phase.sin(), 5.0 * swing * phase.cos());
            let noise: f64 = StandardNormal.sample(&mut random);
            let far = if k % 100 == 50 { 300.0 } else { 0.0 };
            ForcePoint {
                test: 0,
                time_s: f64::from(k),
                contact: Contact::REST,
                displacement_m,
                velocity_m_s,
                // Not quite in step with the displacement, as where the ground moves.
                acceleration_m_s2: (1.3 * phase).cos(),
                moment_n_m: [None; 2],
                force_n: law(displacement_m, velocity_m_s) + 10.0 * noise + far,
                force_sd_n: 10.0,
                share_off_top: None,
            }
        };
        (0..200).map(point).collect()
    }

    #[test]
    fn analytic_what_bends_with_velocity_is_left_and_lines_are_not() {
        let left = |law| curve_left(&points(law)).expect("enough points");
        // A squared normal is above 16 once in 16 000 times; three laws are asked.
        assert!(left(|_, _| 0.0) < 16.0);
        assert!(left(|x, v| 4000.0 * x - 900.0 * v) < 16.0);
        assert!(left(|_, v| -1000.0 * v * v.abs()) > 40.0);
        assert!(left(|x, v| -8000.0 * x.abs() * v) > 40.0);
        assert!(left(|_, v| -20.0 * v.signum()) > 40.0);
    }

    #[test]
    fn analytic_points_lie_along_the_top_or_off_it_or_have_no_direction() {
        let with = |shares: &[f64]| {
            let mut all = points(|x, v| 4000.0 * x - 900.0 * v);
            all.iter_mut().zip(shares).for_each(|(point, share)| point.share_off_top = Some(*share));
            lie_along_top(&all)
        };
        assert_eq!(with(&[1e-3, 2e-3, 0.5]), Some(true));
        assert_eq!(with(&[0.2, 0.1, 1e-3]), Some(false));
        assert_eq!(with(&[1e-3; LEAST_DIRECTIONS - 1]), None);
        assert_eq!(with(&[]), None);
    }

    #[test]
    fn analytic_a_few_points_tell_nothing() {
        assert_eq!(curve_left(&points(|_, v| v)[..19]), None);
    }
}
