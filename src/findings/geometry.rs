//! Size, crack height, the two bodies and strength.

use super::Finding;
use super::change::{distance, increase, is_little, middle_of, tell};
use super::verdict::{Answer, Verdict, Vote};
use super::view::{Slender, View};
use crate::aggregate::{Measure, Middle};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// Sections 4.3 and 5 (4), Figs. 12 and 13: said "especially for slender walls", so asked of those.
pub(super) const REVERSE_SCALE: Finding = Finding {
    name: "reverse scale effect",
    claim: "the thicker the wall at the same slenderness and floor stiffness, the larger its rotation, especially for slender walls",
    source: "sections 4.3 and 5 (4), Figs. 12 and 13",
    criterion: "for h/b > 14 the median at the largest thickness exceeds that at the smallest in 4 of 5 noticeable comparisons, both floors",
    check: reverse_scale,
};

fn reverse_scale(view: &View) -> Answer {
    let slender = rises(view, Parameter::Thickness, Slender::Large, &Configuration::ALL);
    let moderate = rises(view, Parameter::Thickness, Slender::Moderate, &Configuration::ALL);
    let numbers = format!("{}. For h/b ≤ 14, which do not decide: {}", slender.numbers, moderate.numbers);
    Answer { verdict: slender.verdict, numbers }
}

/// Section 4.3: "where the floor is parallel to the façade, this phenomenon is amplified".
pub(super) const REVERSE_SCALE_PARALLEL: Finding = Finding {
    name: "reverse scale more if parallel",
    claim: "the reverse scale effect is amplified where the floor is parallel to the façade",
    source: "section 4.3, Fig. 12",
    criterion: "for h/b > 14 the increase from the smallest to the largest thickness is larger with the parallel floor in 4 of 5 noticeable comparisons",
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
    Answer { verdict: vote.verdict(), numbers: format!("{}; {numbers}", vote.tell()) }
}

/// Section 4.3, Fig. 14 (1).
pub(super) const HIGHER_CRACK: Finding = Finding {
    name: "higher crack, larger rotation",
    claim: "rotations are larger when the height of the crack is larger",
    source: "section 4.3, Fig. 14",
    criterion: "the median at the highest crack exceeds that at the lowest in 4 of 5 noticeable comparisons, both floors, all slendernesses",
    check: higher_crack,
};

fn higher_crack(view: &View) -> Answer {
    rises(view, Parameter::CrackHeight, Slender::Any, &Configuration::ALL)
}

/// Section 4.3, Fig. 14 (2): "usually" for squat walls, "reverses itself when increasing the slenderness".
pub(super) const UPPER_BELOW_LOWER: Finding = Finding {
    name: "upper body below lower",
    claim: "the upper body usually rotates less than the lower, and more for slender walls, above all with a parallel floor",
    source: "section 4.3, Fig. 14",
    criterion: "on the crack-height curves θ2/α2 < θ1/α1 in 4 of 5 noticeable comparisons for h/b ≤ 14, and θ2/α2 > θ1/α1 in 4 of 5 above",
    check: upper_below_lower,
};

fn upper_below_lower(view: &View) -> Answer {
    let bodies = |which: Slender, configuration: Configuration| {
        let mut pairs = Vec::new();
        for level in Level::ALL {
            for slenderness in view.slendernesses(which) {
                let of = |body: Measure| {
                    view.middle(configuration, Parameter::CrackHeight, level, (slenderness, body))
                };
                pairs.push((of(Measure::LowerOwn), of(Measure::UpperOwn)));
            }
        }
        pairs
    };
    let both = |which| Configuration::ALL.into_iter().flat_map(move |c| bodies(which, c));
    let below = Vote::greater(both(Slender::Moderate));
    let swapped = |pairs: Vec<_>| Vote::greater(pairs.into_iter().map(|(lower, upper)| (upper, lower)));
    let above = swapped(both(Slender::Large).collect());
    let [perpendicular, parallel] = Configuration::ALL.map(|c| swapped(bodies(Slender::Large, c)));
    let numbers = format!(
        "upper below lower for h/b ≤ 14: {}; upper above lower for h/b > 14: {} (perpendicular {}, parallel {})",
        below.tell(),
        above.tell(),
        perpendicular.tell(),
        parallel.tell()
    );
    Answer { verdict: Verdict::of_parts(&[below.verdict(), above.verdict()]), numbers }
}

/// Section 4.3, Fig. 15: "the influence of this parameter is rather negligible".
pub(super) const STRENGTH_NEGLIGIBLE: Finding = Finding {
    name: "strength hardly matters",
    claim: "the influence of the compressive strength is rather negligible; the lower one generally gives larger rotations",
    source: "section 4.3, Fig. 15",
    criterion: "from weakest to strongest the median changes by at most 0.005 or 10 % of it in 4 of 5 comparisons, both floors, all slendernesses",
    check: strength_negligible,
};

fn strength_negligible(view: &View) -> Answer {
    let mut facts = Vec::new();
    let mut falls = Vec::new();
    for configuration in Configuration::ALL {
        for point in view.points(Slender::Any) {
            let (weak, strong) = view.ends(configuration, Parameter::Strength, point);
            let mean = view.middle(configuration, Parameter::Strength, Level::Mean, point);
            if let (Some(distance), Some(mean)) = (distance(weak, strong), mean) {
                facts.push(is_little(distance, mean));
            }
            falls.push((weak, strong));
        }
    }
    let (vote, direction) = (Vote::of(facts), Vote::greater(falls));
    let numbers = format!("little change: {}; the weaker rotates more: {}", vote.tell(), direction.tell());
    Answer { verdict: vote.verdict(), numbers }
}

/// Votes "the largest value of the parameter rotates more than the smallest", told by floor.
pub(super) fn rises(
    view: &View,
    parameter: Parameter,
    which: Slender,
    configurations: &[Configuration],
) -> Answer {
    let pairs = |configuration: Configuration| {
        let points = view.points(which).into_iter();
        points
            .map(move |point| view.ends(configuration, parameter, point))
            .map(|(small, large)| (large, small))
    };
    let vote = Vote::greater(configurations.iter().flat_map(|&c| pairs(c)));
    let parts: Vec<String> =
        configurations.iter().map(|&c| format!("{} {}", c.name(), Vote::greater(pairs(c)).tell())).collect();
    let numbers =
        format!("{} ({}){}", vote.tell(), parts.join("; "), example(view, parameter, which, configurations));
    Answer { verdict: vote.verdict(), numbers }
}

/// The lower body at the three levels in the middle of the slendernesses in question.
fn example(view: &View, parameter: Parameter, which: Slender, configurations: &[Configuration]) -> String {
    let slendernesses = view.slendernesses(which);
    let Some(&slenderness) = slendernesses.get(slendernesses.len() / 2) else { return String::new() };
    let of = |&configuration: &Configuration| {
        let levels = Level::ALL.map(|level| {
            tell(view.middle(configuration, parameter, level, (slenderness, Measure::LowerOwn)))
        });
        format!("{} {}", configuration.name(), levels.join(", "))
    };
    let told: Vec<String> = configurations.iter().map(of).collect();
    format!("; θ1/α1 at h/b {slenderness} by level: {}", told.join("; "))
}
