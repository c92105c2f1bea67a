//! Stiffness and mass of the floor.

use super::Finding;
use super::change::{distance, increase, is_little, middle_of, tell};
use super::conclusion::{BOTH_RANGES, Needs, Subject};
use super::geometry::{example, rise_votes};
use super::view::{Slender, View};
use super::vote::{Answer, Verdict};
use super::vote::{FloorVotes, Vote};
use crate::aggregate::{Measure, Middle};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// Sections 4.4 and 5 (3), Fig. 16.
pub(super) const STIFFER_LESS: Finding = Finding {
    name: "stiffer floor, smaller rotation",
    label: "a stiffer floor, a smaller rotation",
    claim: "an increase in the stiffness of the diaphragm decreases rotations",
    source: "sections 4.4 and 5 (3), Fig. 16",
    criterion: "under each floor the median at the softest floor exceeds that at the stiffest in 4 of 5 noticeable comparisons, all slendernesses",
    needs: Needs {
        subject: Subject::Of(Parameter::Stiffness),
        floors: &Configuration::ALL,
        slender: &[Slender::Any],
    },
    check: stiffer_less,
};

fn stiffer_less(view: &View) -> Answer {
    let votes = FloorVotes::of(&Configuration::ALL, |floor| {
        let points = view.points(Slender::Any).into_iter();
        Vote::greater(points.map(|point| view.ends(floor, Parameter::Stiffness, point)))
    });
    Answer { verdict: votes.verdict(), short: votes.short(), numbers: votes.tell() }
}

/// Section 4.4, Fig. 17 left: "generally" more with mass; "as the slenderness increases, this behavior reverses".
pub(super) const PERPENDICULAR_MASS: Finding = Finding {
    name: "perpendicular floor mass",
    label: "perpendicular m_d: more at moderate, less at large slenderness",
    claim: "a heavier perpendicular floor rotates the wall more at moderate slenderness and stabilises it at large slenderness",
    source: "section 4.4, Fig. 17 left",
    criterion: "from lightest to heaviest the median rises in 4 of 5 noticeable comparisons for h/b ≤ 14, and falls in 4 of 5 above",
    needs: Needs {
        subject: Subject::Of(Parameter::DiaphragmMass),
        floors: &[Configuration::Perpendicular],
        slender: BOTH_RANGES,
    },
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
    let short = format!("{}, {}", more.short(), less.short());
    Answer { verdict: Verdict::of_parts([more.verdict(), less.verdict()]), short, numbers }
}

/// Section 5 (5), its first half: "not relevant if it acts in both vertical and horizontal directions".
pub(super) const PERPENDICULAR_MASS_LITTLE: Finding = Finding {
    name: "perpendicular floor mass not relevant",
    label: "… not relevant, acting both ways",
    claim: "the diaphragm mass is not relevant if it acts in both vertical and horizontal directions",
    source: "section 5 (5), Fig. 17 left",
    criterion: "under the perpendicular floor the median changes from lightest to heaviest by at most 0.005 or 10 % of it in 4 of 5 comparisons, all slendernesses",
    needs: Needs {
        subject: Subject::Of(Parameter::DiaphragmMass),
        floors: &[Configuration::Perpendicular],
        slender: &[Slender::Any],
    },
    check: perpendicular_mass_little,
};

fn perpendicular_mass_little(view: &View) -> Answer {
    let little = |which| little(view, Configuration::Perpendicular, Parameter::DiaphragmMass, which);
    let all = little(Slender::Any);
    let numbers = format!(
        "little change: {} ({} for h/b ≤ 14, {} above)",
        all.tell(),
        little(Slender::Moderate).short(),
        little(Slender::Large).short()
    );
    Answer { verdict: all.verdict(), short: all.short(), numbers }
}

/// Votes "the median changes little from the lowest to the highest level of the parameter".
pub(super) fn little(view: &View, floor: Configuration, parameter: Parameter, which: Slender) -> Vote {
    let facts = view.points(which).into_iter().filter_map(|point| {
        let (low, high) = view.ends(floor, parameter, point);
        let mean = view.middle(floor, parameter, Level::Mean, point)?;
        Some(is_little(distance(low, high)?, mean))
    });
    Vote::of(facts)
}

/// Sections 4.4 and 5 (5), Fig. 17 right.
pub(super) const PARALLEL_MASS: Finding = Finding {
    name: "parallel floor mass",
    label: "parallel m_dp: more, amplified for slender walls",
    claim: "a heavier parallel floor rotates both bodies more, and this is amplified for large slenderness",
    source: "sections 4.4 and 5 (5), Fig. 17 right",
    criterion: "from lightest to heaviest the median rises in 4 of 5 noticeable comparisons, all slendernesses, and for each body the median rise for h/b > 14 is noticeably larger than for h/b ≤ 14",
    needs: Needs {
        subject: Subject::Of(Parameter::CarriageMass),
        floors: &[Configuration::Parallel],
        slender: BOTH_RANGES,
    },
    check: parallel_mass,
};

fn parallel_mass(view: &View) -> Answer {
    let floors = &[Configuration::Parallel];
    let more = rise_votes(view, Parameter::CarriageMass, Slender::Any, floors);
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
        "{}{}; median rise for h/b > 14 against ≤ 14: lower body {lower}, upper body {upper}",
        more.tell(),
        example(view, Parameter::CarriageMass, Slender::Any, floors)
    );
    Answer { verdict: Verdict::of_parts([more.verdict(), amplified]), short: more.short(), numbers }
}
