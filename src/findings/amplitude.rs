//! How much the façades rotate, and how much more with a parallel floor.

use std::cmp::Ordering;

use super::Finding;
use super::change::tell;
use super::conclusion::{BOTH_RANGES, Needs, Subject};
use super::view::{Point, Slender, View};
use super::vote::{Answer, Verdict};
use super::vote::{NOTICEABLE, Vote};
use crate::aggregate::{Measure, Middle, median};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// θ/α the source calls significant (sections 4.3 and 5).
const SIGNIFICANT: f64 = 0.05;

/// How many times larger the source finds rotations with a parallel floor (section 4.3).
const FIVEFOLD: f64 = 5.0;

/// Sections 4.3 and 5 (2), Fig. 12. Asked of the reference façades, which every figure shows; the line between
/// moderate and large slenderness, h/b = 14, is the source's own (section 5 (6)).
pub(super) const ONLY_SLENDER: Finding = Finding {
    name: "only slender walls rotate",
    label: "rotations matter (θ/α > 0.05) only at large slenderness",
    claim: "maximum rotations are significant (θ/α > 0.05) only for large slenderness",
    source: "sections 4.3 and 5 (2), Fig. 12",
    criterion: "of the reference façades no median with h/b ≤ 14 exceeds 0.05 and one with h/b > 14 does; undecided if none exceeds it anywhere",
    needs: Needs { subject: Subject::Reference, floors: &Configuration::ALL, slender: BOTH_RANGES },
    check: only_slender,
};

fn only_slender(view: &View) -> Answer {
    let exceeding = |which: Slender| {
        let all = view.points(which).into_iter();
        let medians = all.flat_map(|point| Configuration::ALL.map(|c| view.reference(c, point)?.middle()));
        medians.flatten().filter(|&middle| is_significant(middle)).count()
    };
    let (moderate, large) = (exceeding(Slender::Moderate), exceeding(Slender::Large));
    let verdict = match (moderate, large) {
        (0, 0) => Verdict::Undecided,
        (0, _) => Verdict::Holds,
        _ => Verdict::DoesNot,
    };
    let of_all = view.rows().filter(|row| {
        Measure::BODIES.contains(&row.measure) && Slender::Moderate.holds(row.case.slenderness)
    });
    let all = Vote::of(of_all.filter_map(|row| row.middle()).map(is_significant));
    let numbers = format!(
        "{}; {}; over all parameters {} of {} medians with h/b ≤ 14 exceed 0.05",
        onset(view, Configuration::Perpendicular),
        onset(view, Configuration::Parallel),
        all.agree,
        all.agree + all.against,
    );
    Answer { verdict, short: largest_moderate(view), numbers }
}

/// The largest median of moderate slenderness and where it is.
fn largest_moderate(view: &View) -> String {
    let of_floor = |floor: Configuration| {
        let points = view.points(Slender::Moderate).into_iter();
        points.filter_map(move |point| Some((view.reference(floor, point)?.middle()?, floor, point)))
    };
    let all = Configuration::ALL.into_iter().flat_map(of_floor);
    let largest = all.max_by(|(a, ..), (b, ..)| a.partial_cmp(b).unwrap_or(Ordering::Equal));
    largest.map_or(String::new(), |(middle, floor, (slenderness, _)): (Middle, Configuration, Point)| {
        format!("{} at h/b {slenderness}, {} floor", tell(Some(middle)), floor.name())
    })
}

fn is_significant(middle: Middle) -> bool {
    match middle {
        Middle::Rotation(rotation) => rotation > SIGNIFICANT,
        Middle::Collapsed => true,
    }
}

/// The largest median of moderate slenderness, and the slenderness from which medians are significant.
fn onset(view: &View, configuration: Configuration) -> String {
    let middle = |point| view.reference(configuration, point).and_then(|row| row.middle());
    let moderate = view.points(Slender::Moderate).into_iter().filter_map(middle);
    let largest = moderate.max_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
    let significant = |point: &(f64, Measure)| middle(*point).is_some_and(is_significant);
    let first = view.points(Slender::Any).into_iter().find(significant);
    let from = first.map_or("never above 0.05".to_owned(), |(slenderness, _)| {
        format!("above 0.05 from h/b {slenderness}")
    });
    format!("{}: at most {} for h/b ≤ 14, {from}", configuration.name(), tell(largest))
}

/// Section 4.3: "a trend that will be observed systematically", so asked of every curve that both floors have.
pub(super) const PARALLEL_MORE: Finding = Finding {
    name: "parallel floor rotates more",
    label: "a parallel floor rotates more",
    claim: "the floor parallel to the façade involves much larger rotations",
    source: "section 4.3, Figs. 12 to 20",
    criterion: "at the same parameter, level, slenderness and body the median with the parallel floor is the larger in 4 of 5 noticeable comparisons",
    needs: Needs { subject: Subject::Shared, floors: &Configuration::ALL, slender: &[Slender::Any] },
    check: parallel_more,
};

fn parallel_more(view: &View) -> Answer {
    let pairs = |which| pairs(view, &view.shared_parameters(), which);
    let parallel_first =
        pairs(Slender::Any).into_iter().map(|(perpendicular, parallel)| (parallel, perpendicular));
    let vote = Vote::greater(parallel_first);
    let ratio = |which| tell_ratio(median_ratio(&pairs(which)));
    let numbers = format!(
        "{}; median ratio {} for h/b ≤ 14, {} above, {} over all",
        vote.tell(),
        ratio(Slender::Moderate),
        ratio(Slender::Large),
        ratio(Slender::Any)
    );
    let short = format!("{}, {} times", vote.short(), times(median_ratio(&pairs(Slender::Any))));
    Answer { verdict: vote.verdict(), short, numbers }
}

/// Section 4.3, Fig. 14: "about five times" taken as within a half of five; beyond a factor of two it is another number.
pub(super) const PARALLEL_FIVEFOLD: Finding = Finding {
    name: "about five times more",
    label: "… about five times more",
    claim: "rotations are about five times larger when the floor is parallel to the façade",
    source: "section 4.3, Fig. 14",
    criterion: "the median ratio of parallel to perpendicular over the crack-height curves is 2.5 to 7.5; undecided up to 10",
    needs: Needs {
        subject: Subject::Of(Parameter::CrackHeight),
        floors: &Configuration::ALL,
        slender: &[Slender::Any],
    },
    check: parallel_fivefold,
};

fn parallel_fivefold(view: &View) -> Answer {
    let ratio = median_ratio(&pairs(view, &[Parameter::CrackHeight], Slender::Any));
    let verdict = match ratio {
        None => Verdict::Undecided,
        Some(ratio) if (FIVEFOLD / 2.0..=FIVEFOLD * 1.5).contains(&ratio) => Verdict::Holds,
        Some(ratio) if (FIVEFOLD / 2.0..=FIVEFOLD * 2.0).contains(&ratio) => Verdict::Undecided,
        Some(_) => Verdict::DoesNot,
    };
    let short = format!("{} times", times(ratio));
    Answer { verdict, short, numbers: format!("median ratio {}", tell_ratio(ratio)) }
}

type Pair = (Option<Middle>, Option<Middle>);

/// Medians with the perpendicular and the parallel floor, at every level, slenderness and body.
fn pairs(view: &View, parameters: &[Parameter], which: Slender) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for &parameter in parameters {
        for level in Level::ALL {
            for point in view.points(which) {
                let [a, b] = Configuration::ALL.map(|c| view.middle(c, parameter, level, point));
                pairs.push((a, b));
            }
        }
    }
    pairs
}

/// Median of the ratios of rotations that are both noticeable; `None` if there are none.
fn median_ratio(pairs: &[Pair]) -> Option<f64> {
    let mut ratios: Vec<f64> = pairs
        .iter()
        .filter_map(|pair| match pair {
            (Some(Middle::Rotation(a)), Some(Middle::Rotation(b))) if *a > NOTICEABLE && *b > NOTICEABLE => {
                Some(b / a)
            }
            _ => None,
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    median(&ratios, 0)
}

fn tell_ratio(ratio: Option<f64>) -> String {
    ratio.map_or("none".to_owned(), |ratio| format!("{ratio:.2}"))
}

fn times(ratio: Option<f64>) -> String {
    ratio.map_or("none".to_owned(), |ratio| format!("{ratio:.1}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_the_median_ratio_of_an_even_number_lies_between_two() {
        let pair = |ratio: f64| (Some(Middle::Rotation(0.01)), Some(Middle::Rotation(0.01 * ratio)));
        let fallen = (Some(Middle::Rotation(0.01)), Some(Middle::Collapsed));
        let ratio = median_ratio(&[pair(4.0), pair(1.0), fallen, pair(3.0), pair(2.0)]);
        // Quotients of products: rounding.
        assert!(ratio.is_some_and(|ratio| (ratio - 2.5).abs() < 1e-12), "{ratio:?}");
        assert_eq!(median_ratio(&[fallen]), None);
    }
}
