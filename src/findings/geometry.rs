//! Size, crack height, the two bodies and strength.

use super::Finding;
use super::change::{increase, middle_of, tell};
use super::conclusion::{BOTH_RANGES, Needs, Subject};
use super::diaphragm::little;
use super::view::{Slender, View};
use super::vote::{Answer, Verdict};
use super::vote::{FloorVotes, Vote};
use crate::aggregate::{Measure, Middle};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// Sections 4.3 and 5 (4), Figs. 12 and 13: said "especially for slender walls", so asked of those.
pub(super) const REVERSE_SCALE: Finding = Finding {
    name: "reverse scale effect",
    label: "reverse scale effect of the thickness, slender walls",
    claim: "the thicker the wall at the same slenderness and floor stiffness, the larger its rotation, especially for slender walls",
    source: "sections 4.3 and 5 (4), Figs. 12 and 13",
    criterion: "under each floor the median at the largest thickness exceeds that at the smallest in 4 of 5 noticeable comparisons, h/b > 14",
    needs: THICKNESS,
    check: reverse_scale,
};

const THICKNESS: Needs = Needs {
    subject: Subject::Of(Parameter::Thickness),
    floors: &Configuration::ALL,
    slender: &[Slender::Large],
};

fn reverse_scale(view: &View) -> Answer {
    let votes = |which| rise_votes(view, Parameter::Thickness, which, &Configuration::ALL);
    let example = |which| example(view, Parameter::Thickness, which, &Configuration::ALL);
    let (slender, moderate) = (votes(Slender::Large), votes(Slender::Moderate));
    let numbers = format!(
        "{}{}. For h/b ≤ 14, which do not decide: {}{}",
        slender.tell(),
        example(Slender::Large),
        moderate.tell(),
        example(Slender::Moderate)
    );
    let short = format!("{}; for h/b ≤ 14 {}", slender.short(), moderate.short());
    Answer { verdict: slender.verdict(), short, numbers }
}

/// Section 4.3: "where the floor is parallel to the façade, this phenomenon is amplified".
pub(super) const REVERSE_SCALE_PARALLEL: Finding = Finding {
    name: "reverse scale more if parallel",
    label: "… amplified under a parallel floor",
    claim: "the reverse scale effect is amplified where the floor is parallel to the façade",
    source: "section 4.3, Fig. 12",
    criterion: "for h/b > 14 the increase from the smallest to the largest thickness is larger with the parallel floor in 4 of 5 noticeable comparisons",
    needs: THICKNESS,
    check: reverse_scale_parallel,
};

fn reverse_scale_parallel(view: &View) -> Answer {
    let increases = |configuration| -> Vec<Option<Middle>> {
        let points = view.points(Slender::Large).into_iter();
        points
            .map(|point| view.ends(configuration, Parameter::Thickness, point))
            .map(|(small, large)| increase(small, large))
            .collect()
    };
    let [perpendicular, parallel] = Configuration::ALL.map(increases);
    let typical = |list: &[Option<Middle>]| tell(middle_of(list.iter().flatten().copied()));
    let numbers =
        format!("median increase {} perpendicular, {} parallel", typical(&perpendicular), typical(&parallel));
    let vote = Vote::greater(parallel.into_iter().zip(perpendicular));
    let numbers = format!("{}; {numbers}", vote.tell());
    Answer { verdict: vote.verdict(), short: vote.short(), numbers }
}

/// Section 4.3, Fig. 14 (1).
pub(super) const HIGHER_CRACK: Finding = Finding {
    name: "higher crack, larger rotation",
    label: "a higher crack, a larger rotation",
    claim: "rotations are larger when the height of the crack is larger",
    source: "section 4.3, Fig. 14",
    criterion: "under each floor the median at the highest crack exceeds that at the lowest in 4 of 5 noticeable comparisons, all slendernesses",
    needs: Needs {
        subject: Subject::Of(Parameter::CrackHeight),
        floors: &Configuration::ALL,
        slender: &[Slender::Any],
    },
    check: higher_crack,
};

fn higher_crack(view: &View) -> Answer {
    let votes = rise_votes(view, Parameter::CrackHeight, Slender::Any, &Configuration::ALL);
    let example = example(view, Parameter::CrackHeight, Slender::Any, &Configuration::ALL);
    Answer { verdict: votes.verdict(), short: votes.short(), numbers: votes.tell() + &example }
}

/// Section 4.3, Fig. 14 (2): "usually" for squat walls, "reverses itself when increasing the slenderness".
pub(super) const UPPER_BELOW_LOWER: Finding = Finding {
    name: "upper body below lower",
    label: "the upper body below the lower, reversing for slender walls",
    claim: "the upper body usually rotates less than the lower, and more for slender walls, above all with a parallel floor",
    source: "section 4.3, Fig. 14",
    criterion: "on the crack-height curves of each floor θ2/α2 < θ1/α1 in 4 of 5 noticeable comparisons for h/b ≤ 14, and θ2/α2 > θ1/α1 in 4 of 5 above",
    needs: Needs {
        subject: Subject::Of(Parameter::CrackHeight),
        floors: &Configuration::ALL,
        slender: BOTH_RANGES,
    },
    check: upper_below_lower,
};

fn upper_below_lower(view: &View) -> Answer {
    let below =
        FloorVotes::of(&Configuration::ALL, |floor| Vote::greater(bodies(view, floor, Slender::Moderate)));
    let above = FloorVotes::of(&Configuration::ALL, |floor| {
        Vote::greater(bodies(view, floor, Slender::Large).map(|(lower, upper)| (upper, lower)))
    });
    let numbers = format!(
        "upper below lower for h/b ≤ 14: {}; upper above lower for h/b > 14: {}",
        below.tell(),
        above.tell()
    );
    let short = format!("{}; above {}", below.short(), above.short());
    Answer { verdict: Verdict::of_parts([below.verdict(), above.verdict()]), short, numbers }
}

/// Medians of the lower and the upper body on the crack-height curves.
fn bodies(
    view: &View,
    floor: Configuration,
    which: Slender,
) -> impl Iterator<Item = (Option<Middle>, Option<Middle>)> {
    let at = move |level: Level, slenderness: f64| {
        let [lower, upper] = Measure::BODIES
            .map(|body| view.middle(floor, Parameter::CrackHeight, level, (slenderness, body)));
        (lower, upper)
    };
    let slendernesses = view.slendernesses(which);
    Level::ALL.into_iter().flat_map(move |level| {
        slendernesses.clone().into_iter().map(move |slenderness| at(level, slenderness))
    })
}

/// Section 4.3, Fig. 15: "the influence of this parameter is rather negligible".
pub(super) const STRENGTH_NEGLIGIBLE: Finding = Finding {
    name: "strength hardly matters",
    label: "the strength hardly matters",
    claim: "the influence of the compressive strength is rather negligible; the lower one generally gives larger rotations",
    source: "section 4.3, Fig. 15",
    criterion: "under each floor the median changes from weakest to strongest by at most 0.005 or 10 % of it in 4 of 5 comparisons, all slendernesses",
    needs: Needs {
        subject: Subject::Of(Parameter::Strength),
        floors: &Configuration::ALL,
        slender: &[Slender::Any],
    },
    check: strength_negligible,
};

fn strength_negligible(view: &View) -> Answer {
    let floors = &Configuration::ALL;
    let votes = FloorVotes::of(floors, |floor| little(view, floor, Parameter::Strength, Slender::Any));
    let falls = FloorVotes::of(floors, |floor| {
        let points = view.points(Slender::Any).into_iter();
        Vote::greater(points.map(|point| view.ends(floor, Parameter::Strength, point)))
    });
    let numbers = format!("little change: {}; the weaker rotates more: {}", votes.tell(), falls.tell());
    Answer { verdict: votes.verdict(), short: votes.short(), numbers }
}

/// Votes "the largest value of the parameter rotates more than the smallest" under each floor.
pub(super) fn rise_votes(
    view: &View,
    parameter: Parameter,
    which: Slender,
    floors: &[Configuration],
) -> FloorVotes {
    FloorVotes::of(floors, |floor| {
        let points = view.points(which).into_iter();
        let ends = points.map(|point| view.ends(floor, parameter, point));
        Vote::greater(ends.map(|(smallest, largest)| (largest, smallest)))
    })
}

/// The lower body at the three levels in the middle of the slendernesses in question.
pub(super) fn example(view: &View, parameter: Parameter, which: Slender, floors: &[Configuration]) -> String {
    let slendernesses = view.slendernesses(which);
    let Some(&slenderness) = slendernesses.get(slendernesses.len() / 2) else { return String::new() };
    let of = |&floor: &Configuration| {
        let levels = Level::ALL
            .map(|level| tell(view.middle(floor, parameter, level, (slenderness, Measure::LowerOwn))));
        format!("{} {}", floor.name(), levels.join(", "))
    };
    let told: Vec<String> = floors.iter().map(of).collect();
    format!("; θ1/α1 at h/b {slenderness} by level: {}", told.join("; "))
}
