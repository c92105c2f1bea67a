//! A force at the top without a formula: a curve of displacement and one of velocity, as far as the tests went.
//!
//! They are fitted to points in least squares with the wall's uncertain numbers beside them; how smooth they are is
//! chosen by evidence. They are straight between knots, and so can be simulated as they are.

use super::search::Equations;
use crate::diagnose::formula::{BOTH, Curve, Part, SIDE, Site};
use crate::limits::FEEDS_SD;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::ops::Range;

/// Stiffness of a curve against bending, over the mean curvature of what points say: from as it likes to nearly straight.
const STIFFNESS: [f64; 6] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0];
/// Part of that stiffness that holds a curve which points leave open.
const HELD: f64 = 1e-3;

/// The curves that points say, and what the wall's numbers do beside them, in standard deviations of what was known.
/// `None` where points do not hold them, or where they would feed the wall.
pub fn curve_of(equations: &Equations) -> Option<(Curve, DVector<f64>)> {
    let points = equations.points();
    let knots = points.range(Site::Top).map(Part::at);
    let column = |k: usize| {
        let (part, knot) = (k / BOTH, k % BOTH);
        points.column_of(Site::Top, |motion| Part::shares(&knots[part], motion[part])[knot])
    };
    let columns = (0..2 * BOTH).map(column).collect::<Vec<_>>();
    let off = columns.iter().map(|column| equations.off_wall(column)).collect::<Vec<_>>();
    let normal = Normal::new(&DMatrix::from_columns(&off), equations.missing());
    let fit = normal.best(&knots)?;
    let part = |p: usize| Part {
        at: knots[p],
        force_n: std::array::from_fn(|k| fit.values[p * BOTH + k]),
        sd_n: std::array::from_fn(|k| fit.variance[p * BOTH + k].sqrt()),
    };
    let curve = Curve { parts: [part(0), resisting(part(1))?] };
    let all = columns
        .iter()
        .zip(fit.values.iter())
        .fold(DVector::zeros(points.missing.len()), |sum, (c, v)| sum + c * *v);
    Some((curve, equations.wall_steps_beside(&all)?))
}

/// A curve of velocity that never feeds the wall: what would do so by chance is nothing. `None` where it is no chance.
fn resisting(mut part: Part) -> Option<Part> {
    for k in 0..BOTH {
        let feeds_n = part.force_n[k] * part.at[k].signum();
        if feeds_n > FEEDS_SD * part.sd_n[k] {
            return None;
        }
        if feeds_n > 0.0 {
            part.force_n[k] = 0.0;
        }
    }
    Some(part)
}

/// Normal equations of the values at the knots.
struct Normal {
    gram: DMatrix<f64>,
    pull: DVector<f64>,
    /// Squares of what is missing, and how many rows there are.
    squares: f64,
    rows: f64,
}

struct Fitted {
    values: DVector<f64>,
    variance: DVector<f64>,
    evidence: f64,
}

impl Normal {
    fn new(columns: &DMatrix<f64>, missing: &DVector<f64>) -> Self {
        Self {
            gram: columns.tr_mul(columns),
            pull: columns.tr_mul(missing),
            squares: missing.norm_squared(),
            rows: missing.len() as f64,
        }
    }

    /// The fit of the stiffnesses of both curves that points speak for most.
    fn best(&self, knots: &[[f64; BOTH]; 2]) -> Option<Fitted> {
        let bending = knots.each_ref().map(bending);
        let pairs = STIFFNESS.into_iter().flat_map(|a| STIFFNESS.into_iter().map(move |b| [a, b]));
        let fits = pairs.filter_map(|stiffness| self.fit(&bending, stiffness));
        fits.max_by(|a, b| a.evidence.total_cmp(&b.evidence))
    }

    /// Values with Gaussian priors of these stiffnesses, and their evidence with the variance of rows free.
    fn fit(&self, bending: &[DMatrix<f64>; 2], stiffness: [f64; 2]) -> Option<Fitted> {
        let mut prior = DMatrix::zeros(2 * BOTH, 2 * BOTH);
        for part in 0..2 {
            let own: Range<usize> = part * BOTH..(part + 1) * BOTH;
            let scale = stiffness[part] * own.clone().map(|k| self.gram[(k, k)]).sum::<f64>() / BOTH as f64;
            let block = (&bending[part] + DMatrix::identity(BOTH, BOTH) * HELD) * scale;
            prior.view_mut((own.start, own.start), (BOTH, BOTH)).copy_from(&block);
        }
        let before = Cholesky::<f64, Dyn>::new(prior.clone())?;
        let after = Cholesky::<f64, Dyn>::new(&self.gram + prior)?;
        let values = after.solve(&self.pull);
        // Noise alone leaves 1.
        let variance = ((self.squares - self.pull.dot(&values)) / self.rows).max(1.0);
        let evidence = -0.5 * (self.rows * variance.ln() + after.ln_determinant() - before.ln_determinant());
        Some(Fitted { values, variance: after.inverse().diagonal() * variance, evidence })
    }
}

/// Squares of second differences of values at knots, the one at rest among them, in shares of the reach.
fn bending(at: &[f64; BOTH]) -> DMatrix<f64> {
    let reach = at[BOTH - 1];
    let with_rest = |k: usize| match k.cmp(&SIDE) {
        std::cmp::Ordering::Less => (at[k] / reach, Some(k)),
        std::cmp::Ordering::Equal => (0.0, None),
        std::cmp::Ordering::Greater => (at[k - 1] / reach, Some(k - 1)),
    };
    let mut all = DMatrix::zeros(BOTH, BOTH);
    for k in 1..BOTH {
        let [(a, i), (b, j), (c, l)] = [k - 1, k, k + 1].map(with_rest);
        let mut row = DVector::<f64>::zeros(BOTH);
        let weights = [1.0 / (b - a), -1.0 / (b - a) - 1.0 / (c - b), 1.0 / (c - b)];
        for (index, weight) in [i, j, l].into_iter().zip(weights) {
            if let Some(index) = index {
                row[index] += weight;
            }
        }
        // A bend of slope over the length that it stands for.
        all += &row * row.transpose() * (2.0 / (c - a));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::search::search;
    use super::super::twin::{drag, points_with};
    use super::*;

    #[test]
    fn analytic_a_drag_is_told_as_a_curve_of_velocity_and_none_of_displacement() {
        let law = drag(2.0, 300.0);
        let points = points_with(&law, |_| 1.0);
        let found = search(&points).expect("laws");
        let (curve, _) = curve_of(&found.equations).expect("a curve");
        let [_, velocity] = points.range(Site::Top);
        for share in [-0.9, -0.5, 0.3, 0.6, 0.9] {
            let v = share * velocity[1].min(-velocity[0]);
            let [force_n, sd_n] = curve.parts[1].force_n(v);
            let truth = law.first.force([0.0, v, 0.0]);
            // Straight pieces of a parabola are off by 2 % of the largest.
            assert!((force_n - truth).abs() < 6.0 + 4.0 * sd_n, "{v} m/s: {force_n} ± {sd_n} for {truth}");
        }
        let largest = curve.parts[0].force_n.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        assert!(largest < 30.0, "{curve:?}");
    }

    #[test]
    fn rejects_a_curve_that_feeds_the_wall() {
        let at = Part::at([-1.0, 1.0]);
        let part = |force: f64| Part { at, force_n: at.map(|v| force * v), sd_n: [1.0; BOTH] };
        assert!(resisting(part(5.0)).is_none());
        let chance = resisting(part(1.0)).expect("no more than chance");
        assert!(chance.force_n.iter().all(|f| *f == 0.0));
        assert_eq!(resisting(part(-5.0)), Some(part(-5.0)));
    }
}
