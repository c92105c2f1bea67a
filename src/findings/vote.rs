//! How a claim is decided: what medians say of it, and votes of comparisons under each floor.

use std::cmp::Ordering;

use crate::aggregate::Middle;
use crate::survey::Configuration;

/// Rotations over α closer than this are one: a fiftieth of the 0.05 the source calls significant, less than a line's
/// width in its figures.
pub const NOTICEABLE: f64 = 0.001;

/// Large rotations closer than this share of the larger are one, for the same reason.
pub const NOTICEABLE_SHARE: f64 = 0.01;

/// Share of the comparisons that must agree where the source says "generally" or "usually": four in five.
const GENERALLY: f64 = 0.8;

/// At or below this share a tossed coin would agree as often: the claim does not hold.
const BY_CHANCE: f64 = 0.5;

/// Fewer decisive comparisons agree by chance alone one time in four or more often.
const FEWEST: usize = 3;

/// When a difference of two medians is noticeable, in words.
pub fn noticeable() -> String {
    format!("above {NOTICEABLE} in θ/α and above {} % of the larger", 100.0 * NOTICEABLE_SHARE)
}

/// What the words of the criteria mean.
pub fn rules() -> String {
    let [generally, by_chance] = [GENERALLY, BY_CHANCE].map(|share| 100.0 * share);
    format!(
        "A difference is noticeable {}; a collapse exceeds every rotation. \
         “4 of 5” asks {generally:.0} % of {FEWEST} or more comparisons; at {by_chance:.0} % or fewer the claim does not hold. \
         A claim about each floor holds if it holds for both.",
        noticeable()
    )
}

/// Comparisons for and against a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Vote {
    /// For it.
    pub agree: usize,
    /// Against it.
    pub against: usize,
    /// Too close to tell, or both collapsed.
    pub close: usize,
}

impl Vote {
    /// Votes "the first is greater" over pairs; pairs with a missing side do not count.
    pub fn greater(pairs: impl IntoIterator<Item = (Option<Middle>, Option<Middle>)>) -> Self {
        let mut vote = Self::default();
        for (a, b) in pairs {
            match (a, b) {
                (Some(a), Some(b)) => vote.count(compare(a, b)),
                _ => continue,
            }
        }
        vote
    }

    /// Votes on facts that are true or false.
    pub fn of(facts: impl IntoIterator<Item = bool>) -> Self {
        let mut vote = Self::default();
        facts.into_iter().for_each(|fact| match fact {
            true => vote.agree += 1,
            false => vote.against += 1,
        });
        vote
    }

    fn count(&mut self, order: Ordering) {
        match order {
            Ordering::Greater => self.agree += 1,
            Ordering::Less => self.against += 1,
            Ordering::Equal => self.close += 1,
        }
    }

    /// What the votes add up to.
    pub fn verdict(self) -> Verdict {
        let decisive = self.agree + self.against;
        if decisive < FEWEST {
            return Verdict::Undecided;
        }
        let share = self.agree as f64 / decisive as f64;
        if share >= GENERALLY {
            Verdict::Holds
        } else if share <= BY_CHANCE {
            Verdict::DoesNot
        } else {
            Verdict::Undecided
        }
    }

    /// "31 of 36".
    pub fn short(self) -> String {
        format!("{} of {}", self.agree, self.agree + self.against)
    }

    /// "31 of 36 agree, 4 too close", the figures of the verdict.
    pub fn tell(self) -> String {
        match self.close {
            0 => format!("{} agree", self.short()),
            close => format!("{} agree, {close} too close", self.short()),
        }
    }
}

/// The votes under each floor: a claim about both floors holds if it holds for each of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FloorVotes(Vec<(Configuration, Vote)>);

impl FloorVotes {
    /// Votes of these floors.
    pub fn of(floors: &[Configuration], vote: impl Fn(Configuration) -> Vote) -> Self {
        Self(floors.iter().map(|&floor| (floor, vote(floor))).collect())
    }

    /// What they add up to.
    pub fn verdict(&self) -> Verdict {
        Verdict::of_parts(self.0.iter().map(|(_, vote)| vote.verdict()))
    }

    /// "12 of 14 and 8 of 9", floor by floor.
    pub fn short(&self) -> String {
        self.0.iter().map(|(_, vote)| vote.short()).collect::<Vec<_>>().join(" and ")
    }

    /// "perpendicular 12 of 14 agree; parallel 8 of 9 agree, 1 too close".
    pub fn tell(&self) -> String {
        let told = self.0.iter().map(|(floor, vote)| format!("{} {}", floor.name(), vote.tell()));
        told.collect::<Vec<_>>().join("; ")
    }
}

/// Orders two middles; noticeable differences only, collapse above every rotation and equal to itself.
pub fn compare(a: Middle, b: Middle) -> Ordering {
    match (a, b) {
        (Middle::Rotation(x), Middle::Rotation(y)) => {
            let noticeable = NOTICEABLE.max(NOTICEABLE_SHARE * x.abs().max(y.abs()));
            if (x - y).abs() <= noticeable { Ordering::Equal } else { x.total_cmp(&y) }
        }
        (Middle::Collapsed, Middle::Collapsed) => Ordering::Equal,
        (Middle::Collapsed, Middle::Rotation(_)) => Ordering::Greater,
        (Middle::Rotation(_), Middle::Collapsed) => Ordering::Less,
    }
}

/// What the medians say of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// They bear it out.
    Holds,
    /// They speak against it.
    DoesNot,
    /// They say too little, or both.
    Undecided,
    /// The study does not vary what the claim is about.
    NotAsked,
}

impl Verdict {
    /// As printed.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Holds => "holds",
            Verdict::DoesNot => "does not",
            Verdict::Undecided => "undecided",
            Verdict::NotAsked => "not in this study",
        }
    }

    /// Of a claim with several parts: it holds if all do, and does not if one does not.
    pub fn of_parts(parts: impl IntoIterator<Item = Verdict>) -> Self {
        let mut whole = None;
        for part in parts {
            whole = match (whole, part) {
                (Some(Verdict::DoesNot), _) | (_, Verdict::DoesNot) => Some(Verdict::DoesNot),
                (None | Some(Verdict::Holds), Verdict::Holds) => Some(Verdict::Holds),
                _ => Some(Verdict::Undecided),
            };
        }
        whole.unwrap_or(Verdict::Undecided)
    }
}

/// An answer and the numbers that decide it.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The answer.
    pub verdict: Verdict,
    /// The numbers in a few words, such as "26 of 33"; empty where the study does not ask.
    pub short: String,
    /// The numbers, as a sentence or two.
    pub numbers: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn vote(agree: usize, against: usize) -> Vote {
        Vote { agree, against, close: 5 }
    }

    #[test]
    fn regress_votes_give_each_of_the_three_answers() {
        assert_eq!(vote(8, 2).verdict(), Verdict::Holds);
        assert_eq!(vote(5, 5).verdict(), Verdict::DoesNot);
        assert_eq!(vote(7, 3).verdict(), Verdict::Undecided);
        assert_eq!(vote(2, 0).verdict(), Verdict::Undecided);
        assert_eq!(vote(0, 3).verdict(), Verdict::DoesNot);
    }

    #[test]
    fn regress_floors_are_not_pooled() {
        let floors = |perpendicular: Vote, parallel: Vote| {
            FloorVotes::of(&Configuration::ALL, |floor| match floor {
                Configuration::Perpendicular => perpendicular,
                Configuration::Parallel => parallel,
            })
        };
        // Together 27 of 33, which is more than four in five.
        let one_too_few = floors(vote(11, 4), vote(16, 2));
        assert_eq!(one_too_few.verdict(), Verdict::Undecided);
        assert_eq!(one_too_few.short(), "11 of 15 and 16 of 18");
        assert_eq!(floors(vote(12, 3), vote(16, 2)).verdict(), Verdict::Holds);
        assert_eq!(floors(vote(40, 0), vote(1, 2)).verdict(), Verdict::DoesNot);
    }

    #[test]
    fn regress_the_rules_say_what_is_done() {
        assert_eq!(noticeable(), "above 0.001 in θ/α and above 1 % of the larger");
        assert!(rules().contains("asks 80 % of 3 or more") && rules().contains("at 50 % or fewer"));
    }

    #[test]
    fn regress_collapse_is_above_every_rotation_and_close_ones_are_equal() {
        let rotation = Middle::Rotation;
        assert_eq!(compare(Middle::Collapsed, rotation(9.0)), Ordering::Greater);
        assert_eq!(compare(Middle::Collapsed, Middle::Collapsed), Ordering::Equal);
        assert_eq!(compare(rotation(0.0105), rotation(0.0100)), Ordering::Equal);
        assert_eq!(compare(rotation(0.012), rotation(0.010)), Ordering::Greater);
        assert_eq!(compare(rotation(0.500), rotation(0.504)), Ordering::Equal);
    }

    #[test]
    fn regress_parts_add_up() {
        use Verdict::{DoesNot, Holds, Undecided};
        assert_eq!(Verdict::of_parts([Holds, Holds]), Holds);
        assert_eq!(Verdict::of_parts([Holds, Undecided]), Undecided);
        assert_eq!(Verdict::of_parts([Undecided, Holds]), Undecided);
        assert_eq!(Verdict::of_parts([Undecided, DoesNot, Holds]), DoesNot);
        assert_eq!(Verdict::of_parts([]), Undecided);
    }
}
