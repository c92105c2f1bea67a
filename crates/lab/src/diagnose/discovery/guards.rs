//! What refuses a law that fits: it must hold in tests it has not seen, and its numbers inside what was excited.

use super::search::Equations;
use crate::diagnose::formula::{Atom, Law};
use crate::limits::{AT_BOUND, LEFT_OUT_LOSS, LEFT_OUT_SHARE, WORTH_WINDOWS};
use nalgebra::{DMatrix, DVector};

/// Whether each test follows a law that was fitted to the others: shapes as they are, sizes and the wall's numbers anew.
///
/// A term that makes the training error smaller may make another experiment worse. What the other tests leave open of a
/// size, such as that of a stop which a single test reaches, stays open in the prediction. Of one test nothing is told, and of
/// a law that points hardly see no more than that no test speaks against it.
pub fn holds_in_each_test(equations: &Equations, law: &Law) -> bool {
    hold_in_each_test(equations, &of_law(equations, law))
}

/// The same of columns, each of the size that was found.
pub fn hold_in_each_test(equations: &Equations, columns: &[DVector<f64>]) -> bool {
    let mut tests = equations.points().test.clone();
    tests.dedup();
    if tests.len() < 2 {
        return true;
    }
    let terms = [Terms::new(equations, columns), Terms::new(equations, &[])];
    let all = (0..equations.points().test.len()).collect::<Vec<_>>();
    let gain = |fitted: &[usize], judged: &[usize]| gain(&terms, fitted, judged);
    let unseen = tests.iter().map(|test| {
        let (own, others): (Vec<_>, Vec<_>) =
            all.iter().partition(|row| equations.points().test[**row] == *test);
        gain(&others, &own)
    });
    let unseen = unseen.collect::<Option<Vec<_>>>().unwrap_or_default();
    let seen = gain(&[], &all).unwrap_or(f64::INFINITY);
    // The wall alone is told by the other tests too, and does better in one that it has not seen than by what was known of it: of a large
    // gain no share can be asked, only that the tests not seen say as much as makes a law worth windows.
    let least = (LEFT_OUT_SHARE * seen).min(WORTH_WINDOWS);
    let holds = seen < WORTH_WINDOWS || unseen.iter().sum::<f64>() > least;
    holds && unseen.len() == tests.len() && unseen.iter().all(|gain| *gain > -LEFT_OUT_LOSS)
}

/// What a law gains over the wall alone in rows, where it was fitted to others; natural logarithms of likelihood.
pub fn unseen_gain(equations: &Equations, law: &Law, fitted: &[usize], judged: &[usize]) -> Option<f64> {
    let columns = of_law(equations, law);
    gain(&[Terms::new(equations, &columns), Terms::new(equations, &[])], fitted, judged)
}

/// The atoms of a law as columns of their size.
fn of_law(equations: &Equations, law: &Law) -> Vec<DVector<f64>> {
    law.atoms().map(|atom| equations.points().column(&atom) * atom.size).collect()
}

fn gain([with, without]: &[Terms; 2], fitted: &[usize], judged: &[usize]) -> Option<f64> {
    Some(with.likelihood(fitted, judged)? - without.likelihood(fitted, judged)?)
}

/// Columns of the wall's numbers and of atoms, weighed, in standard deviations of what points leave.
struct Terms {
    columns: DMatrix<f64>,
    missing: DVector<f64>,
    /// Inverse variances before any test.
    prior: Vec<f64>,
}

/// A size before any test: within so many times itself.
const OPEN_SIZE: f64 = 10.0;

impl Terms {
    fn new(equations: &Equations, of_atoms: &[DVector<f64>]) -> Self {
        let points = equations.points();
        let own = points.wall.ncols();
        let sd = equations.variance().sqrt();
        let weight = |row: usize| equations.weight(row) / sd;
        let of = |row: usize, k: usize| match k.checked_sub(own) {
            None => points.wall[(row, k)],
            Some(k) => of_atoms[k][row],
        };
        let rows = points.missing.len();
        Self {
            columns: DMatrix::from_fn(rows, own + of_atoms.len(), |row, k| weight(row) * of(row, k)),
            missing: DVector::from_fn(rows, |row, _| weight(row) * points.missing[row]),
            prior: [vec![1.0; own], vec![OPEN_SIZE.powi(-2); of_atoms.len()]].concat(),
        }
    }

    /// Logarithm of the likelihood of rows, as others predict them with what they leave open.
    fn likelihood(&self, fitted: &[usize], judged: &[usize]) -> Option<f64> {
        let known = self.columns.select_rows(fitted);
        let mut before = known.tr_mul(&known);
        for (k, prior) in self.prior.iter().enumerate() {
            before[(k, k)] += prior;
        }
        let sizes = before.clone().cholesky()?.solve(&known.tr_mul(&self.missing.select_rows(fitted)));
        let new = self.columns.select_rows(judged);
        let left = self.missing.select_rows(judged) - &new * sizes;
        let after = (&before + new.tr_mul(&new)).cholesky()?;
        let pull = new.tr_mul(&left);
        // The inverse of I + X A⁻¹ Xᵀ is I − X (A + XᵀX)⁻¹ Xᵀ, and its determinant that of A over that of A + XᵀX.
        let squares = left.norm_squared() - pull.dot(&after.solve(&pull));
        Some(-0.5 * (squares + after.ln_determinant() - before.cholesky()?.ln_determinant()))
    }
}

/// Whether the numbers of its shapes lie inside what was looked at, and thus inside what was excited. An exact exponent at the upper end is
/// one that may be larger; at the lower stands friction.
pub fn lies_inside(law: &Law) -> bool {
    let inside = |(value, [least, most]): (f64, [f64; 2])| {
        let margin = AT_BOUND * (most - least);
        value > least + margin && value < most - margin
    };
    let below_most =
        |atom: &Atom| (0..atom.shape.numbers().len()).all(|i| atom.numbers[i] < atom.bounds(i)[1]);
    let holds =
        |atom: Atom| below_most(&atom) && atom.free().map(|i| (atom.numbers[i], atom.bounds(i))).all(inside);
    law.atoms().all(holds)
}

#[cfg(test)]
mod tests {
    use super::super::search::search;
    use super::super::twin::{drag, points_with};
    use super::*;
    use crate::diagnose::formula::{Shape, Side, Site};

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
    fn analytic_a_law_whose_tests_not_seen_say_enough_holds_however_much_more_it_gains_where_it_was_fitted() {
        // Nearly a spring as the floor's own: fitted to other tests that one stands for it, far from what was known of it.
        let law = Law::of(Atom { shape: Shape::Spring, numbers: [1.1, 0.0], ..drag(0.0, 3000.0).first });
        let points = points_with(&law, |_| 1.0);
        let found = search(&points).expect("laws");
        let equations = &found.equations;
        let rows = |own: &dyn Fn(usize) -> bool| {
            (0..points.test.len()).filter(|row| own(points.test[*row])).collect::<Vec<_>>()
        };
        let seen = unseen_gain(equations, &law, &[], &rows(&|_| true)).expect("a gain");
        let unseen = |test: usize| {
            unseen_gain(equations, &law, &rows(&|other| other != test), &rows(&|own| own == test))
        };
        let unseen = (0..4).map(|test| unseen(test).expect("a gain")).collect::<Vec<_>>();
        let sum = unseen.iter().sum::<f64>();
        assert!(sum < LEFT_OUT_SHARE * seen && sum > WORTH_WINDOWS, "{unseen:?} of {seen}");
        assert!(holds_in_each_test(equations, &law), "{unseen:?}");
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
    fn rejects_a_root_that_pushes_away_and_a_moment_that_nearly_jumps() {
        let top = drag(0.2, 300.0).first;
        let root = Atom { shape: Shape::Spring, ..top };
        assert!(root.may_be(300.0) && !root.may_be(-300.0));
        assert!(Atom { numbers: [1.5, 0.0], ..root }.may_be(-300.0));
        let joint = |n: f64| Atom { site: Site::Ground, numbers: [n, 0.0], ..top };
        assert!(top.may_be(300.0) && joint(0.3).may_be(300.0) && !joint(0.2).may_be(300.0));
        // A spring there has no velocity that could jump.
        assert!(Atom { shape: Shape::Spring, ..joint(0.4) }.may_be(300.0));
        assert_eq!([top.bounds(0)[0], joint(0.5).bounds(0)[0]], [0.2, 0.3]);
        assert!(!lies_inside(&Law::of(joint(0.3))), "at the least of what was looked at");
        assert!(lies_inside(&Law::of(joint(0.5))), "a root is a law of its own");
    }

    #[test]
    fn rejects_numbers_at_the_ends_of_what_was_looked_at() {
        assert!(lies_inside(&drag(1.7, 300.0)) && lies_inside(&drag(0.0, 300.0)));
        assert!(!lies_inside(&drag(5.0, 300.0)));
        // Nor is an exact exponent told that may be larger; friction is one at the lower end.
        let shape = Shape::OneSidedSpring(Side::Positive);
        let exact = |n: f64| {
            let first = Atom { shape, numbers: [n, 0.0], is_exact: true, ..drag(1.0, 300.0).first };
            lies_inside(&Law::of(first))
        };
        assert_eq!([1.0, 3.0, 4.0].map(exact), [true, true, false]);
    }
}
