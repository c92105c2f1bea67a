//! A force at the top without a formula: a curve of displacement, one of velocity, or both, as far as the tests went.
//!
//! They are fitted to points in least squares with the wall's uncertain numbers beside them; how smooth they are is
//! chosen by evidence. They are straight between knots, and so can be simulated as they are, and fitted to windows from there.

use super::guards::hold_in_each_test;
use super::search::Equations;
use crate::diagnose::formula::{BOTH, Curve, Part, SIDE, Site};
use crate::limits::{EQUIVALENT, FEEDS_SD, OF_MEMORY, WORTH_WINDOWS};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::ops::Range;

/// Stiffness of a curve against bending, over the mean curvature of what points say: from as it likes to nearly straight.
const STIFFNESS: [f64; 6] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0];
/// Part of that stiffness that holds a curve which points leave open.
const HELD: f64 = 1e-3;
/// Share of the mean trace of a column that holds what points leave open at nothing.
const OPEN_SHARE: f64 = 1e-6;

/// Curves with a share in the force: of displacement, of velocity, or of both.
const PARTS: [&[usize]; 3] = [&[0], &[1], &[0, 1]];

/// The curves that points say, and what the wall's numbers do beside them, in standard deviations of what was known. A force
/// that one quantity explains is told by that alone. `None` where points do not hold them, where they would feed the wall, where
/// a test speaks against them, or where the force depends on the way or on how far the top has been.
pub fn curve_of(equations: &Equations) -> Option<(Curve, DVector<f64>)> {
    let points = equations.points();
    let knots = points.range(Site::Top).map(Part::at);
    let column =
        |(p, k): (usize, usize)| points.column_of(Site::Top, |motion| Part::shares(&knots[p], motion[p])[k]);
    let of = |parts: &'static [usize]| {
        let all = parts.iter().flat_map(|p| (0..BOTH).map(move |k| (*p, k)));
        let columns = all.map(column).collect::<Vec<_>>();
        let off = columns.iter().map(|column| equations.off_wall(column)).collect::<Vec<_>>();
        let fit = Normal::new(&DMatrix::from_columns(&off), equations.missing()).best(&knots, parts)?;
        Some((parts, columns, fit))
    };
    let mut found = PARTS.into_iter().filter_map(of).collect::<Vec<_>>();
    let best = found.iter().map(|(.., fit)| fit.evidence).fold(f64::NEG_INFINITY, f64::max);
    // In their order: one quantity before both.
    let told = found.iter().position(|(.., fit)| fit.evidence > best - EQUIVALENT)?;
    let (parts, columns, fit) = found.swap_remove(told);
    let none = |p: usize| Part { at: knots[p], force_n: [0.0; BOTH], sd_n: [0.0; BOTH] };
    let mut curve = Curve { parts: [none(0), none(1)] };
    for (own, p) in parts.iter().enumerate() {
        curve.parts[*p].force_n = std::array::from_fn(|k| fit.values[own * BOTH + k]);
        curve.parts[*p].sd_n = std::array::from_fn(|k| fit.variance[own * BOTH + k].sqrt());
    }
    curve.parts[1] = resisting(curve.parts[1])?;
    let sized = columns.iter().zip(fit.values.iter()).map(|(column, force)| column * *force);
    let sized = sized.collect::<Vec<_>>();
    if !hold_in_each_test(equations, &sized) || !has_no_memory(equations, &curve, &columns) {
        return None;
    }
    let all = sized.iter().fold(DVector::zeros(points.missing.len()), |sum, column| sum + column);
    Some((curve, equations.wall_steps_beside(&all)?))
}

/// Whether the force is the same on the way out and on the way back, and however far the top has been: a memory is no curve.
fn has_no_memory(equations: &Equations, curve: &Curve, columns: &[DVector<f64>]) -> bool {
    let reach = curve.parts[0].at[BOTH - 1];
    let goes_back = |[x, v, _]: [f64; 3]| if x * v < 0.0 { 1.0 } else { 0.0 };
    let has_been = |[_, _, largest]: [f64; 3]| largest / reach;
    !depends_on(equations, curve, columns, goes_back) && !depends_on(equations, curve, columns, has_been)
}

/// Whether a curve depends on something else too: a curve of its own, times that, gains [`WORTH_WINDOWS`] and is
/// [`OF_MEMORY`] of the force.
fn depends_on(
    equations: &Equations,
    curve: &Curve,
    columns: &[DVector<f64>],
    what: impl Fn([f64; 3]) -> f64,
) -> bool {
    let points = equations.points();
    let times = |(p, k): (usize, usize)| {
        let at = curve.parts[p].at;
        points.column_of(Site::Top, |motion| what(motion) * Part::shares(&at, motion[p])[k])
    };
    let beside = curve.knots().map(times).collect::<Vec<_>>();
    let with = [columns, &beside].concat();
    let (Some((_, before)), Some((values, after))) = (least(equations, columns), least(equations, &with))
    else {
        return false;
    };
    let rows = equations.missing().len() as f64;
    let variance = (after / rows).max(1.0);
    let gain = 0.5 * (before - after) / variance - 0.5 * beside.len() as f64 * rows.ln();
    let sized = |columns: &[DVector<f64>], from: usize| {
        let each = columns.iter().enumerate().map(|(k, column)| column * values[from + k]);
        each.fold(DVector::zeros(points.missing.len()), |sum, column| sum + column)
    };
    let [own, other] = [sized(columns, 0), sized(&beside, columns.len())];
    gain > WORTH_WINDOWS && other.norm() > OF_MEMORY * (own + &other).norm()
}

/// Least squares of columns beside the wall's numbers, held to nothing where points leave them open: values, and what is left.
fn least(equations: &Equations, columns: &[DVector<f64>]) -> Option<(DVector<f64>, f64)> {
    let off = columns.iter().map(|column| equations.off_wall(column)).collect::<Vec<_>>();
    let off = DMatrix::from_columns(&off);
    let mut gram = off.tr_mul(&off);
    let open = OPEN_SHARE * gram.trace() / columns.len() as f64;
    gram += DMatrix::identity(columns.len(), columns.len()) * open;
    let values = Cholesky::<f64, Dyn>::new(gram)?.solve(&off.tr_mul(equations.missing()));
    let left = (equations.missing() - &off * &values).norm_squared();
    Some((values, left))
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

    /// The fit of the stiffnesses of its curves that points speak for most.
    fn best(&self, knots: &[[f64; BOTH]; 2], parts: &[usize]) -> Option<Fitted> {
        let bending = parts.iter().map(|p| bending(&knots[*p])).collect::<Vec<_>>();
        let grid = |count: usize| STIFFNESS.len().pow(count as u32);
        let stiffness =
            |i: usize| (0..parts.len()).map(|p| STIFFNESS[i / grid(p) % STIFFNESS.len()]).collect::<Vec<_>>();
        let fits = (0..grid(parts.len())).filter_map(|i| self.fit(&bending, &stiffness(i)));
        fits.max_by(|a, b| a.evidence.total_cmp(&b.evidence))
    }

    /// Values with Gaussian priors of these stiffnesses, and their evidence with the variance of rows free.
    fn fit(&self, bending: &[DMatrix<f64>], stiffness: &[f64]) -> Option<Fitted> {
        let count = bending.len() * BOTH;
        let mut prior = DMatrix::zeros(count, count);
        for (part, bending) in bending.iter().enumerate() {
            let own: Range<usize> = part * BOTH..(part + 1) * BOTH;
            let scale = stiffness[part] * own.clone().map(|k| self.gram[(k, k)]).sum::<f64>() / BOTH as f64;
            let block = (bending + DMatrix::identity(BOTH, BOTH) * HELD) * scale;
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
    use super::super::twin::{drag, points_of, points_with, tests_of, wall_with};
    use super::*;

    /// What points of a wall with a force at the top say, and how far they went.
    fn told(force_n: &str, parameters: &str) -> (Option<Curve>, [[f64; 2]; 2]) {
        let effect = format!(
            "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"{force_n}\"\n[effects.parameters]\n{parameters}"
        );
        let points = points_of(&tests_of(&wall_with(&effect), 3e-5));
        let found = search(&points).expect("laws");
        (curve_of(&found.equations).map(|(curve, _)| curve), points.range(Site::Top))
    }

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
        assert!(!curve.parts[0].acts(), "{curve:?}");
    }

    #[test]
    fn analytic_a_wave_of_displacement_is_a_curve() {
        let number = |name: &str, value: f64, unit: &str| {
            format!("{name} = {{ value = {value}, unit = \"{unit}\" }}\n")
        };
        let parameters = number("f", 500.0, "N") + &number("d", 0.02, "m");
        // A wave of straight lines: up to d, through nothing at 2 d.
        let wave = "-f*(max(min(x/d,1),-1) - max(x/d-1,0) - min(x/d+1,0))";
        let (curve, [displacement, _]) = told(wave, &parameters);
        let curve = curve.expect("a curve");
        assert!(!curve.parts[1].acts() && displacement[1] > 0.03, "{displacement:?}");
        let [at_d, at_2d] = [0.02, 0.04].map(|x| curve.parts[0].force_n(x)[0]);
        // Straight pieces cut a kink by up to a half of it.
        assert!(at_d < -250.0 && at_2d > -150.0, "{at_d} N and {at_2d} N");
    }

    #[test]
    fn rejects_a_memory_as_a_curve() {
        let law = "k*x*x_max/(g+x_max)";
        let parameters = "k = { value = 30000.0, unit = \"N/m\" }\ng = { value = 0.02, unit = \"m\" }\n";
        assert_eq!(told(law, parameters).0, None);
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
