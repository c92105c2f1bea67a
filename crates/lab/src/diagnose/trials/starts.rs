//! Where the fit of a hypothesis may start.

use crate::diagnose::fit::Fit;
use crate::diagnose::hypothesis::Hypothesis;
use crate::limits::{BEGUN, STARTS_FROM};

/// Sizes tried for one added number, and for each of two, as shares of the size that matters.
pub struct Sizes {
    one: &'static [f64],
    each_of_two: &'static [f64],
}

/// Every size that may be the best start.
pub const SIZES: Sizes =
    Sizes { one: &[0.01, 0.03, 0.08, 0.2, 0.4, 0.8, 1.6], each_of_two: &[0.05, 0.1, 0.2, 0.4, 0.8, 1.6] };
/// Enough to see whether an addition would help.
pub const FEW_SIZES: Sizes = Sizes { one: &[0.05, 0.3], each_of_two: &[0.15, 0.6] };

/// Starts about `start`: itself, and the numbers from the `first` on, one, two, or more moved together, at several sizes; one,
/// or all together, of either sign.
pub fn ladder(h: &Hypothesis, start: &[f64], first: usize, sizes: &Sizes) -> Vec<Vec<f64>> {
    let moved = |values: &[f64], i: usize, by: f64| {
        let unknown = &h.unknowns[i];
        let mut values = values.to_vec();
        values[i] += by * unknown.scale;
        (unknown.lower..=unknown.upper).contains(&values[i]).then_some(values)
    };
    let mut starts = vec![start.to_vec()];
    match h.unknowns.len() - first {
        1 => {
            let shares = sizes.one.iter().flat_map(|share| [*share, -share]);
            starts.extend(shares.filter_map(|share| moved(start, first, share)));
        }
        2 => {
            let one = sizes.each_of_two.iter().filter_map(|share| moved(start, first, *share));
            let two = |values: Vec<f64>| {
                let of = |share: &f64| moved(&values, first + 1, *share);
                sizes.each_of_two.iter().filter_map(of).collect::<Vec<_>>()
            };
            starts.extend(one.flat_map(two));
        }
        0 => {}
        // Factors of impacts: all less, or more, than they were.
        _ => {
            let shares = sizes.one.iter().flat_map(|share| [*share, -share]);
            let all = |share: f64| {
                (first..h.unknowns.len()).try_fold(start.to_vec(), |values, i| moved(&values, i, share))
            };
            starts.extend(shares.filter_map(all));
        }
    }
    starts
}

/// Of two numbers or more, the best of several sizes of the last: a spring that yields at too large a force does not feel that
/// force at all. Equal costs are one motion: it yields at neither force.
pub fn several(glances: Vec<Fit>) -> Vec<Fit> {
    let same = |a: &Fit, b: &Fit| a.values.last() == b.values.last() || a.cost == b.cost;
    let mut begun: Vec<Fit> = Vec::new();
    for glance in glances {
        if begun.len() < BEGUN && !begun.iter().any(|other| same(other, &glance)) {
            begun.push(glance);
        }
    }
    begun
}

/// Of one number, the best, and the best of those that do something: the states of windows were fitted without it, and hold it
/// where it does nothing though it is there.
pub fn with_a_size(h: &Hypothesis, base: &[f64], number: usize, glances: Vec<Fit>) -> Vec<Fit> {
    let does = |glance: &Fit| {
        let size =
            glance.values.get(number).zip(base.get(number)).map_or(0.0, |(own, base)| (own - base).abs());
        h.unknowns.get(number).is_some_and(|unknown| size >= STARTS_FROM * unknown.scale)
    };
    let (doing, others): (Vec<_>, Vec<_>) = glances.into_iter().partition(does);
    let mut begun = others.into_iter().take(1).chain(doing.into_iter().take(1)).collect::<Vec<_>>();
    begun.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    begun
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypothesis::Unknown;

    fn glances(of: &[(f64, f64)]) -> Vec<Fit> {
        let one = |&(value, cost): &(f64, f64)| Fit {
            values: vec![value],
            windows: Vec::new(),
            cost,
            covariance: None,
        };
        of.iter().map(one).collect()
    }

    /// A wall with vertical motion, whose ratio of 1 matters.
    fn shaken_upwards() -> Hypothesis {
        crate::diagnose::hypothesis::example::starter_with(&["vertical_ground_motion"])
    }

    #[test]
    fn analytic_one_number_starts_where_it_does_something_too() {
        let h = shaken_upwards();
        let [Unknown { scale, .. }] = &h.unknowns[..] else { panic!("one number") };
        assert_eq!(*scale, 1.0);
        let values = |begun: &[Fit]| begun.iter().map(|fit| fit.values[0]).collect::<Vec<_>>();
        let near = glances(&[(0.0, 1.0), (-0.01, 2.0), (-0.08, 3.0), (0.2, 4.0)]);
        assert_eq!(values(&with_a_size(&h, &[0.0], 0, near)), [0.0, -0.08]);
        // The better of the two comes first; about another value the same shares count.
        let far = glances(&[(0.4, 1.0), (0.2, 2.0), (0.39, 3.0)]);
        assert_eq!(values(&with_a_size(&h, &[0.4], 0, far)), [0.4, 0.2]);
        assert_eq!(values(&with_a_size(&h, &[0.0], 0, glances(&[(0.4, 1.0), (0.0, 2.0)]))), [0.4, 0.0]);
        // Nothing is added: the only start.
        assert_eq!(values(&with_a_size(&h, &[0.0], 1, glances(&[(0.4, 1.0)]))), [0.4]);
    }

    #[test]
    fn analytic_of_two_numbers_several_sizes_of_the_last_are_begun() {
        let of = |(one, two, cost): (f64, f64, f64)| Fit {
            values: vec![one, two],
            windows: Vec::new(),
            cost,
            covariance: None,
        };
        let all = [
            (1.0, 1.0, 1.0),
            (2.0, 1.0, 2.0),
            (1.0, 2.0, 3.0),
            (1.0, 3.0, 3.0),
            (1.0, 4.0, 4.0),
            (1.0, 5.0, 5.0),
        ];
        let begun = several(all.map(of).to_vec());
        // The second has the size of the first, and the fourth moves as the third does.
        let sizes = begun.iter().map(|fit| fit.values[1]).collect::<Vec<_>>();
        assert_eq!(sizes, [1.0, 2.0, 4.0]);
    }
}
