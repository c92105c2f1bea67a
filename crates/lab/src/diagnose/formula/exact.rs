//! Exponents that laws of physics have.

use super::law::{Law, LawSlot};
use super::shape::Meaning;
use crate::limits::EXACT_WITHIN;

/// Exponents that are tried as exact.
const EXACT: [f64; 8] = [0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0];
/// Standard deviations of an exponent within which an exact one is tried, however far.
const NEAR_SD: f64 = 3.0;

/// A law with the nearest exact exponents in place of those that were fitted with such standard deviations (in the order
/// of [`Law::slots`]). `None` where one is far from all, or where there are none.
pub fn nearest_exact(law: &Law, deviations: &[f64]) -> Option<Law> {
    let mut exact = *law;
    let mut any = false;
    let atoms = law.atoms().collect::<Vec<_>>();
    for (slot, sd) in law.slots().into_iter().zip(deviations) {
        let LawSlot::Number(a, i) = slot else { continue };
        if atoms[a].meaning(i) != Meaning::Exponent {
            continue;
        }
        let value = atoms[a].numbers[i];
        let nearest = EXACT.into_iter().min_by(|x, y| (x - value).abs().total_cmp(&(y - value).abs()))?;
        if (nearest - value).abs() > EXACT_WITHIN.max(NEAR_SD * sd) {
            return None;
        }
        any = true;
        exact = exact.map(|own, mut atom| {
            if own == a {
                atom.numbers[i] = nearest;
                atom.is_exact = true;
            }
            atom
        });
    }
    any.then_some(exact)
}

/// Whether intervals of the numbers of a law (in the order of [`Law::slots`]) leave open which exact exponent one of its is.
pub fn leaves_exponents_open(law: &Law, intervals: &[[f64; 2]]) -> bool {
    let atoms = law.atoms().collect::<Vec<_>>();
    let is_open = |(slot, [low, high]): (LawSlot, &[f64; 2])| {
        let is_exponent = matches!(slot, LawSlot::Number(a, i) if atoms[a].meaning(i) == Meaning::Exponent);
        is_exponent && EXACT.iter().filter(|exact| (low..=high).contains(exact)).count() > 1
    };
    law.slots().into_iter().zip(intervals).any(is_open)
}

#[cfg(test)]
mod tests {
    use super::super::law::Atom;
    use super::super::{Shape, Site};
    use super::*;

    fn drag(n: f64) -> Law {
        let atom = Atom {
            site: Site::Top,
            shape: Shape::Drag,
            numbers: [n, 0.0],
            size: 100.0,
            reach: [0.05, 0.2],
            is_exact: false,
        };
        Law::of(atom)
    }

    #[test]
    fn analytic_an_exponent_near_an_exact_one_is_tried_as_that() {
        let of = |n: f64, sd: f64| nearest_exact(&drag(n), &[1.0, sd]).map(|law| law.first.numbers[0]);
        assert_eq!(of(2.07, 0.01), Some(2.0));
        assert_eq!(of(0.46, 0.01), Some(0.5));
        assert_eq!(of(1.76, 0.01), None);
        assert_eq!(of(2.45, 0.2), Some(2.0));
    }

    #[test]
    fn analytic_an_exponent_is_open_where_more_than_one_exact_one_lies_in_its_interval() {
        let open = |interval: [f64; 2]| leaves_exponents_open(&drag(4.0), &[[0.0, 9.0], interval]);
        assert!(open([2.7, 7.0]) && open([1.5, 2.0]));
        assert!(!open([1.6, 2.4]) && !open([2.1, 2.9]));
    }
}
