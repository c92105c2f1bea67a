//! How much records and coefficients of restitution matter.

use super::Finding;
use super::change::{distance, middle_of, tell};
use super::conclusion::{BOTH_RANGES, Needs, Subject};
use super::diaphragm::little;
use super::view::{Point, Slender, View};
use super::vote::{Answer, Verdict};
use super::vote::{FloorVotes, Vote};
use crate::aggregate::{Measure, Median, Middle};
use crate::study::pipeline::Parameter;
use crate::survey::Configuration;

/// Sections 4.5 and 5 (6), Figs. 18 and 19: spread as the figures show it, in θ/α between records of the reference façade.
pub(super) const RECORD_SPREAD: Finding = Finding {
    name: "record-to-record spread",
    label: "record-to-record spread: larger under parallel floors and for slender walls",
    claim: "the spread between records is small for perpendicular floors and larger for parallel ones and for slender walls",
    source: "sections 4.5 and 5 (6), Figs. 18 and 19",
    criterion: "of the reference façades the distance between the 16 and 84 % quantiles is larger for the parallel floor in 4 of 5 noticeable comparisons, and its median over h/b > 14 exceeds that over h/b ≤ 14 in 4 of 5 noticeable comparisons, one a floor and body",
    needs: Needs { subject: Subject::Records, floors: &Configuration::ALL, slender: BOTH_RANGES },
    check: record_spread,
};

fn record_spread(view: &View) -> Answer {
    let of =
        |configuration: Configuration, point: Point| view.reference(configuration, point).and_then(spread);
    let points = view.points(Slender::Any).into_iter();
    let by_floor =
        Vote::greater(points.map(|p| (of(Configuration::Parallel, p), of(Configuration::Perpendicular, p))));
    let typical = |configuration, which, body| {
        let points = view.points(which).into_iter().filter(|(_, measure)| *measure == body);
        middle_of(points.filter_map(|point| of(configuration, point)))
    };
    let mut pairs = Vec::new();
    let mut told = Vec::new();
    for configuration in Configuration::ALL {
        for body in Measure::BODIES {
            let (large, moderate) = (
                typical(configuration, Slender::Large, body),
                typical(configuration, Slender::Moderate, body),
            );
            told.push(format!("{} against {}", tell(large), tell(moderate)));
            pairs.push((large, moderate));
        }
    }
    let by_slenderness = Vote::greater(pairs);
    let numbers = format!(
        "parallel spreads more: {}; slender walls spread more: {}; median spread for h/b > 14 against ≤ 14: perpendicular {} (lower), {} (upper); parallel {} (lower), {} (upper)",
        by_floor.tell(),
        by_slenderness.tell(),
        told[0],
        told[1],
        told[2],
        told[3]
    );
    let verdict = Verdict::of_parts([by_floor.verdict(), by_slenderness.verdict()]);
    Answer { verdict, short: format!("{}, {}", by_floor.short(), by_slenderness.short()), numbers }
}

/// Distance between the 16 and the 84 % quantiles: endless where the upper one lands among collapses.
fn spread(row: &Median) -> Option<Middle> {
    match row.spread() {
        Some(spread) => Some(Middle::Rotation(spread)),
        None if row.collapsed > 0 => Some(Middle::Collapsed),
        None => None,
    }
}

/// Section 4.5, Fig. 20: "small, and slightly more pronounced for slender walls" with the perpendicular floor, "similarly"
/// with the parallel one except for slender walls.
pub(super) const COEFFICIENTS_LITTLE: Finding = Finding {
    name: "coefficients matter little",
    label: "the coefficients C_l matter little",
    claim: "the influence of the coefficients C_l on the maximum response is small",
    source: "section 4.5, Fig. 20",
    criterion: "under each floor the median changes from lower to upper bounds by at most 0.005 or 10 % of it in 4 of 5 comparisons: perpendicular, all slendernesses; parallel, h/b ≤ 14",
    needs: Needs {
        subject: Subject::Of(Parameter::Restitution),
        floors: &Configuration::ALL,
        slender: &[Slender::Moderate],
    },
    check: coefficients_little,
};

fn coefficients_little(view: &View) -> Answer {
    let votes = FloorVotes::of(&Configuration::ALL, |floor| {
        let which = match floor {
            Configuration::Perpendicular => Slender::Any,
            Configuration::Parallel => Slender::Moderate,
        };
        little(view, floor, Parameter::Restitution, which)
    });
    let numbers = format!("little change: {}", votes.tell());
    Answer { verdict: votes.verdict(), short: votes.short(), numbers }
}

/// Sections 4.5 and 5 (6), Fig. 20: "for slender walls … larger effect on the response".
pub(super) const COEFFICIENTS_SLENDER_PARALLEL: Finding = Finding {
    name: "coefficients, slender parallel",
    label: "… more for slender walls under a parallel floor",
    claim: "the coefficients C_l matter more for slender walls with a parallel floor",
    source: "sections 4.5 and 5 (6), Fig. 20",
    criterion: "for h/b > 14 and the parallel floor the change from lower to upper bounds exceeds that at the same place with the perpendicular floor, and the median change for h/b ≤ 14, in 4 of 5 noticeable comparisons",
    needs: Needs {
        subject: Subject::Of(Parameter::Restitution),
        floors: &Configuration::ALL,
        slender: BOTH_RANGES,
    },
    check: coefficients_slender_parallel,
};

fn coefficients_slender_parallel(view: &View) -> Answer {
    let typical = |configuration, which| {
        let points = view.points(which).into_iter();
        middle_of(points.filter_map(|point| moved(view, configuration, point)))
    };
    let moderate = typical(Configuration::Parallel, Slender::Moderate);
    let mut pairs = Vec::new();
    for point in view.points(Slender::Large) {
        let parallel = moved(view, Configuration::Parallel, point);
        pairs.push((parallel, moved(view, Configuration::Perpendicular, point)));
        pairs.push((parallel, moderate));
    }
    let vote = Vote::greater(pairs);
    let numbers = format!(
        "{}; median change: perpendicular {} for h/b ≤ 14, {} above; parallel {}, {}",
        vote.tell(),
        tell(typical(Configuration::Perpendicular, Slender::Moderate)),
        tell(typical(Configuration::Perpendicular, Slender::Large)),
        tell(moderate),
        tell(typical(Configuration::Parallel, Slender::Large)),
    );
    Answer { verdict: vote.verdict(), short: vote.short(), numbers }
}

/// How far the median moves from the lower to the upper bounds of the coefficients.
fn moved(view: &View, configuration: Configuration, point: Point) -> Option<Middle> {
    let (lower, upper) = view.ends(configuration, Parameter::Restitution, point);
    distance(lower, upper)
}
