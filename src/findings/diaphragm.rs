//! Stiffness and mass of the floor.

use super::Finding;
use super::change::{increase, middle_of, tell};
use super::geometry::rises;
use super::verdict::{Answer, Verdict, Vote};
use super::view::{Slender, View};
use crate::aggregate::{Measure, Middle};
use crate::study::pipeline::Parameter;
use crate::survey::Configuration;

/// Sections 4.4 and 5 (3), Fig. 16.
pub(super) const STIFFER_LESS: Finding = Finding {
    name: "stiffer floor, smaller rotation",
    claim: "an increase in the stiffness of the diaphragm decreases rotations",
    source: "sections 4.4 and 5 (3), Fig. 16",
    criterion: "the median at the softest floor exceeds that at the stiffest in 4 of 5 noticeable comparisons, both floors, all slendernesses",
    check: stiffer_less,
};

fn stiffer_less(view: &View) -> Answer {
    let pairs = |configuration: Configuration| {
        let points = view.points(Slender::Any).into_iter();
        points.map(move |point| view.ends(configuration, Parameter::Stiffness, point))
    };
    let [perpendicular, parallel] = Configuration::ALL.map(|c| Vote::greater(pairs(c)));
    let vote = Vote::greater(Configuration::ALL.into_iter().flat_map(pairs));
    let numbers =
        format!("{} (perpendicular {}; parallel {})", vote.tell(), perpendicular.tell(), parallel.tell());
    Answer { verdict: vote.verdict(), numbers }
}

/// Section 4.4, Fig. 17 left: "generally" more with mass; "as the slenderness increases, this behavior reverses".
pub(super) const PERPENDICULAR_MASS: Finding = Finding {
    name: "perpendicular floor mass",
    claim: "a heavier perpendicular floor rotates the wall more at moderate slenderness and stabilises it at large slenderness",
    source: "section 4.4, Fig. 17 left",
    criterion: "from lightest to heaviest the median rises in 4 of 5 noticeable comparisons for h/b ≤ 14, and falls in 4 of 5 above",
    check: perpendicular_mass,
};

fn perpendicular_mass(view: &View) -> Answer {
    let pairs = |which: Slender| {
        let ends = |point| view.ends(Configuration::Perpendicular, Parameter::DiaphragmMass, point);
        view.points(which).into_iter().map(ends).collect::<Vec<_>>()
    };
    let more = Vote::greater(pairs(Slender::Moderate).into_iter().map(|(light, heavy)| (heavy, light)));
    let less = Vote::greater(pairs(Slender::Large));
    let numbers = format!(
        "heavier rotates more for h/b ≤ 14: {}; heavier rotates less for h/b > 14: {}",
        more.tell(),
        less.tell()
    );
    Answer { verdict: Verdict::of_parts(&[more.verdict(), less.verdict()]), numbers }
}

/// Sections 4.4 and 5 (5), Fig. 17 right.
pub(super) const PARALLEL_MASS: Finding = Finding {
    name: "parallel floor mass",
    claim: "a heavier parallel floor rotates both bodies more, and this is amplified for large slenderness",
    source: "sections 4.4 and 5 (5), Fig. 17 right",
    criterion: "from lightest to heaviest the median rises in 4 of 5 noticeable comparisons, and for each body the median rise for h/b > 14 is noticeably larger than for h/b ≤ 14",
    check: parallel_mass,
};

fn parallel_mass(view: &View) -> Answer {
    let more = rises(view, Parameter::CarriageMass, Slender::Any, &[Configuration::Parallel]);
    let rise = |which: Slender, body: Measure| -> Option<Middle> {
        let ends =
            |slenderness| view.ends(Configuration::Parallel, Parameter::CarriageMass, (slenderness, body));
        let slendernesses = view.slendernesses(which).into_iter();
        middle_of(slendernesses.map(ends).filter_map(|(light, heavy)| increase(light, heavy)))
    };
    let pairs = Measure::BODIES.map(|body| (rise(Slender::Large, body), rise(Slender::Moderate, body)));
    let vote = Vote::greater(pairs);
    // Two comparisons only, one a body: both must agree, and one that does not speaks against the claim.
    let amplified = match (vote.agree, vote.against) {
        (2, 0) => Verdict::Holds,
        (_, 0) => Verdict::Undecided,
        _ => Verdict::DoesNot,
    };
    let [lower, upper] = pairs.map(|(large, moderate)| format!("{} against {}", tell(large), tell(moderate)));
    let numbers = format!(
        "{}; median rise for h/b > 14 against ≤ 14: lower body {lower}, upper body {upper}",
        more.numbers
    );
    Answer { verdict: Verdict::of_parts(&[more.verdict, amplified]), numbers }
}
