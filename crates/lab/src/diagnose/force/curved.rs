//! Whether the force that a named effect leaves at the top still bends with the top's velocity.

use nalgebra::{DMatrix, DVector};

use super::points::ForcePoint;

/// Fewest points to each number of a regression.
const POINTS_A_NUMBER: usize = 5;
/// Standard deviations beyond which a point counts less (Huber): a kink of the motion within its stretch.
const USUAL: f64 = 3.0;
/// Rounds of reweighting; the weights settle within a few.
const ROUNDS: usize = 6;

/// How much of what is left, as a sum of squared standard deviations, one further law of the velocity takes away that is no
/// line: drag as v |v|, damping that grows with displacement as |x| v, friction as the sign of v.
///
/// Lines against displacement, velocity and acceleration are taken off first: the fit of windows weighs other instants, and
/// may put a little of one for another. Laws of displacement alone are not asked: near x = 0, where impacts are, smoothing
/// makes a curve of its own at a large noise. `None` where there are too few points.
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

/// Squared error, in standard deviations, that a sum of such columns leaves of the force in least squares; far points count
/// by their distance, not its square. `None` where the columns are no independent ones.
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

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use mrbd_kernel::model::Contact;

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
    fn analytic_a_few_points_tell_nothing() {
        assert_eq!(curve_left(&points(|_, v| v)[..19]), None);
    }
}
