//! What refuses a law that fits: it must hold in tests it has not seen, and its numbers inside what was excited.

use super::points::Points;
use super::search::Equations;
use crate::diagnose::formula::Law;
use crate::limits::{AT_BOUND, LEFT_OUT_LOSS, LEFT_OUT_SHARE};
use nalgebra::{DMatrix, DVector};

/// Whether each test follows a law that was fitted to the others: shapes as they are, sizes and the wall's numbers anew.
///
/// A term that makes the training error smaller may make another experiment worse. Of one test nothing is told.
pub fn holds_in_each_test(equations: &Equations, law: &Law) -> bool {
    let points = equations.points();
    let mut tests = points.test.clone();
    tests.dedup();
    if tests.len() < 2 {
        return true;
    }
    let gains = tests.iter().filter_map(|test| gain_unseen(equations, law, *test)).collect::<Vec<_>>();
    let columns = columns_of(points, law);
    let rows = (0..points.missing.len()).collect::<Vec<_>>();
    let seen = left(equations, &columns, &rows, &rows).zip(left(equations, &[], &rows, &rows));
    let seen = seen.map_or(0.0, |(with, without)| without - with);
    gains.iter().all(|gain| *gain > -LEFT_OUT_LOSS) && gains.iter().sum::<f64>() > LEFT_OUT_SHARE * seen
}

/// What a law gains in a test that it was not fitted to, in natural logarithms of likelihood.
fn gain_unseen(equations: &Equations, law: &Law, test: usize) -> Option<f64> {
    let points = equations.points();
    let (own, others): (Vec<_>, Vec<_>) = (0..points.test.len()).partition(|row| points.test[*row] == test);
    let columns = columns_of(points, law);
    Some(left(equations, &[], &others, &own)? - left(equations, &columns, &others, &own)?)
}

fn columns_of(points: &Points, law: &Law) -> Vec<DVector<f64>> {
    law.atoms().map(|atom| points.column(&atom)).collect()
}

/// Half the squared error over its variance that columns, fitted to some rows, leave in others.
fn left(equations: &Equations, columns: &[DVector<f64>], fitted: &[usize], judged: &[usize]) -> Option<f64> {
    let points = equations.points();
    let own = points.wall.ncols();
    let terms = |rows: &[usize]| {
        let of = |row: usize, k: usize| match k.checked_sub(own) {
            None => points.wall[(row, k)],
            Some(k) => columns[k][row],
        };
        let weight = |row: usize| equations.weight(row);
        let matrix =
            DMatrix::from_fn(rows.len(), own + columns.len(), |i, k| weight(rows[i]) * of(rows[i], k));
        let missing = rows.iter().map(|row| weight(*row) * points.missing[*row]);
        (matrix, DVector::from_iterator(rows.len(), missing))
    };
    let (matrix, missing) = terms(fitted);
    let mut normal = matrix.tr_mul(&matrix);
    for k in 0..own {
        // The variance of points is that of their noise times this; the prior has its own.
        normal[(k, k)] += equations.variance();
    }
    let sizes = normal.cholesky()?.solve(&matrix.tr_mul(&missing));
    let (matrix, missing) = terms(judged);
    Some(0.5 * (missing - matrix * sizes).norm_squared() / equations.variance())
}

/// Whether the numbers of its shapes lie inside what was looked at, and thus inside what was excited.
pub fn lies_inside(law: &Law) -> bool {
    let inside = |(value, grid): (f64, &[f64])| {
        let (least, most) = (grid[0], grid[grid.len() - 1]);
        let margin = AT_BOUND * (most - least);
        // A power of 0 is a law of its own.
        (value > least + margin || least == 0.0) && value < most - margin
    };
    law.atoms().all(|atom| {
        let numbers = atom.shape.numbers().iter().enumerate();
        numbers.map(|(i, number)| (atom.numbers[i], number.grid)).all(inside)
    })
}

#[cfg(test)]
mod tests {
    use super::super::search::search;
    use super::super::twin::{drag, points_with};
    use super::*;

    #[test]
    fn analytic_a_law_of_every_test_holds_in_each_and_one_of_a_single_test_does_not() {
        let law = drag(2.0, 300.0);
        let everywhere = points_with(&law, |_| 1.0);
        let found = search(&everywhere).expect("laws");
        assert!(holds_in_each_test(&found.equations, &law));
        // As large and the other way in the tests in which the wall moves less.
        let turned = points_with(&law, |test| if test == 2 { 1.0 } else { -3.0 });
        let found = search(&turned).expect("laws");
        assert!(!holds_in_each_test(&found.equations, &law));
    }

    #[test]
    fn rejects_a_force_that_feeds_the_wall() {
        let points = points_with(&drag(2.0, -300.0), |_| 1.0);
        let found = search(&points).expect("laws");
        for candidate in found.singles.iter().chain(&found.pairs) {
            for atom in candidate.law.atoms() {
                assert!(!atom.shape.is_damper() || atom.size > 0.0, "{atom:?}");
            }
        }
    }

    #[test]
    fn rejects_numbers_at_the_ends_of_what_was_looked_at() {
        assert!(lies_inside(&drag(1.7, 300.0)) && lies_inside(&drag(0.0, 300.0)));
        assert!(!lies_inside(&drag(5.0, 300.0)));
    }
}
