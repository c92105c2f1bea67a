//! Differences between medians, some of which may be collapses, and how far they move with the assumptions.

use crate::aggregate::{Case, Measure, Medians, Middle, median};
use crate::survey::Configuration;

/// A change of rotation over α below this matters little: a tenth of the 0.05 the source calls significant.
pub const LITTLE: f64 = 0.005;

/// A change below this share of the rotation matters little: the share below which engineers call a parameter weak.
pub const LITTLE_SHARE: f64 = 0.10;

/// From one median to another: a rotation, or endless where only the second collapsed; `None` where the first did.
pub fn increase(from: Option<Middle>, to: Option<Middle>) -> Option<Middle> {
    match (from?, to?) {
        (Middle::Rotation(from), Middle::Rotation(to)) => Some(Middle::Rotation(to - from)),
        (Middle::Rotation(_), Middle::Collapsed) => Some(Middle::Collapsed),
        (Middle::Collapsed, _) => None,
    }
}

/// Distance between two medians: endless where one of them collapsed, nothing where both did.
pub fn distance(a: Option<Middle>, b: Option<Middle>) -> Option<Middle> {
    match (a?, b?) {
        (Middle::Rotation(a), Middle::Rotation(b)) => Some(Middle::Rotation((a - b).abs())),
        (Middle::Collapsed, Middle::Collapsed) => Some(Middle::Rotation(0.0)),
        _ => Some(Middle::Collapsed),
    }
}

/// Whether a distance matters little beside a median.
pub fn is_little(distance: Middle, beside: Middle) -> bool {
    match (distance, beside) {
        (Middle::Collapsed, _) => false,
        (Middle::Rotation(distance), Middle::Rotation(beside)) => {
            distance <= LITTLE.max(LITTLE_SHARE * beside)
        }
        (Middle::Rotation(distance), Middle::Collapsed) => distance <= LITTLE,
    }
}

/// The median of several, by the rule of [`median`]: one that lands among collapses is a collapse. `None` of nothing.
pub fn middle_of(values: impl IntoIterator<Item = Middle>) -> Option<Middle> {
    let (mut rotations, mut collapsed) = (Vec::new(), 0);
    for value in values {
        match value {
            Middle::Rotation(rotation) => rotations.push(rotation),
            Middle::Collapsed => collapsed += 1,
        }
    }
    rotations.sort_by(f64::total_cmp);
    match median(&rotations, collapsed) {
        Some(rotation) => Some(Middle::Rotation(rotation)),
        None => (collapsed > 0).then_some(Middle::Collapsed),
    }
}

/// A median as it is printed.
pub fn tell(middle: Option<Middle>) -> String {
    match middle {
        Some(Middle::Rotation(rotation)) => format!("{rotation:.3}"),
        Some(Middle::Collapsed) => "collapse".to_owned(),
        None => "none".to_owned(),
    }
}

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

    const ROTATION: fn(f64) -> Middle = Middle::Rotation;

    #[test]
    fn analytic_differences_with_collapses_are_never_numbers() {
        let collapsed = Some(Middle::Collapsed);
        assert_eq!(increase(Some(ROTATION(0.25)), Some(ROTATION(0.5))), Some(ROTATION(0.25)));
        assert_eq!(increase(Some(ROTATION(0.25)), collapsed), collapsed);
        assert_eq!(increase(collapsed, collapsed), None);
        assert_eq!(distance(collapsed, Some(ROTATION(0.25))), collapsed);
        assert_eq!(distance(collapsed, collapsed), Some(ROTATION(0.0)));
    }

    #[test]
    fn regress_little_is_small_or_a_small_share() {
        assert!(is_little(ROTATION(0.004), ROTATION(0.001)));
        assert!(is_little(ROTATION(0.04), ROTATION(0.5)));
        assert!(!is_little(ROTATION(0.04), ROTATION(0.2)));
        assert!(!is_little(Middle::Collapsed, ROTATION(0.2)));
    }

    #[test]
    fn analytic_a_median_is_the_mean_of_the_two_in_the_middle() {
        let [one, two, four] = [1.0, 2.0, 4.0].map(ROTATION);
        assert_eq!(middle_of([four, one]), Some(ROTATION(2.5)));
        assert_eq!(middle_of([four, one, two]), Some(two));
        assert_eq!(middle_of([four, Middle::Collapsed, one, two]), Some(ROTATION(3.0)));
        assert_eq!(middle_of([]), None);
    }

    #[test]
    fn analytic_a_median_among_collapses_is_one() {
        let [one, two] = [1.0, 2.0].map(ROTATION);
        assert_eq!(middle_of([Middle::Collapsed, two, one]), Some(two));
        // Between a rotation and a collapse there is no number.
        assert_eq!(middle_of([Middle::Collapsed, one]), Some(Middle::Collapsed));
        assert_eq!(middle_of([Middle::Collapsed, Middle::Collapsed, one]), Some(Middle::Collapsed));
    }

    #[test]
    fn analytic_the_median_of_an_even_number_lies_between_two() {
        let shift =
            |distances: &[f64]| Shift { distances: distances.to_vec(), largest: None, changed_sides: 0 };
        assert_eq!(shift(&[1.0, 2.0, 4.0, 9.0]).median(), Some(3.0));
        assert_eq!(shift(&[1.0, 2.0, 4.0]).median(), Some(2.0));
        assert_eq!(shift(&[]).median(), None);
    }
}
