//! How far the medians move when the assumptions change.

use crate::aggregate::{Case, Measure, Medians, Middle, median};
use crate::survey::Configuration;

/// How the medians of a variant differ from those of the first, for one floor.
#[derive(Debug, Clone, PartialEq)]
pub struct Shift {
    /// Absolute differences of medians that stood in both, increasing, over both bodies.
    pub distances: Vec<f64>,
    /// Where the largest is.
    pub largest: Option<(Case, Measure)>,
    /// Medians that stood in one of the two and collapsed in the other.
    pub changed_sides: usize,
}

impl Shift {
    /// The median difference; `None` of nothing.
    pub fn median(&self) -> Option<f64> {
        median(&self.distances, 0)
    }

    /// The largest difference; `None` of nothing.
    pub fn max(&self) -> Option<f64> {
        self.distances.last().copied()
    }
}

/// How the medians of `variant` differ from those of `base`, θ_i/α_i of both bodies, over every case of a floor.
pub fn shift(medians: &Medians, base: &str, variant: &str, configuration: Configuration) -> Shift {
    let mut shift = Shift { distances: Vec::new(), largest: None, changed_sides: 0 };
    let mut largest = f64::NEG_INFINITY;
    let of_variant = medians.rows().iter().filter(|row| {
        row.case.variant == variant
            && row.case.configuration == configuration
            && Measure::BODIES.contains(&row.measure)
    });
    for row in of_variant {
        let there = Case { variant: base.to_owned(), ..row.case.clone() };
        let before = medians.get(&there, row.measure).and_then(|row| row.middle());
        match (before, row.middle()) {
            (Some(Middle::Rotation(before)), Some(Middle::Rotation(now))) => {
                let distance = (now - before).abs();
                shift.distances.push(distance);
                if distance > largest {
                    largest = distance;
                    shift.largest = Some((row.case.clone(), row.measure));
                }
            }
            (Some(before), Some(now)) if before != now => shift.changed_sides += 1,
            _ => {}
        }
    }
    shift.distances.sort_by(f64::total_cmp);
    shift
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_the_median_of_an_even_number_lies_between_two() {
        let shift =
            |distances: &[f64]| Shift { distances: distances.to_vec(), largest: None, changed_sides: 0 };
        assert_eq!(shift(&[1.0, 2.0, 4.0, 9.0]).median(), Some(3.0));
        assert_eq!(shift(&[1.0, 2.0, 4.0]).median(), Some(2.0));
        assert_eq!(shift(&[]).median(), None);
    }
}
