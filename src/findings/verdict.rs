//! How a claim is decided: votes of comparisons, and what they add up to.

use std::cmp::Ordering;

use crate::aggregate::Middle;

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

/// What the medians say of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// They bear it out.
    Holds,
    /// They speak against it.
    DoesNot,
    /// They say too little, or both.
    Undecided,
}

impl Verdict {
    /// As printed.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Holds => "holds",
            Verdict::DoesNot => "does not",
            Verdict::Undecided => "undecided",
        }
    }

    /// Of a claim with several parts: it holds if all do, and does not if one does not.
    pub fn of_parts(parts: &[Verdict]) -> Self {
        if parts.contains(&Verdict::DoesNot) {
            Verdict::DoesNot
        } else if !parts.is_empty() && parts.iter().all(|part| *part == Verdict::Holds) {
            Verdict::Holds
        } else {
            Verdict::Undecided
        }
    }
}

/// An answer and the numbers that decide it.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The answer.
    pub verdict: Verdict,
    /// The numbers, as a sentence or two.
    pub numbers: String,
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

    /// "31 of 36 agree, 4 too close", the figures of the verdict.
    pub fn tell(self) -> String {
        let decisive = self.agree + self.against;
        match self.close {
            0 => format!("{} of {decisive} agree", self.agree),
            close => format!("{} of {decisive} agree, {close} too close", self.agree),
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn vote(agree: usize, against: usize) -> Verdict {
        Vote { agree, against, close: 5 }.verdict()
    }

    #[test]
    fn regress_votes_give_each_of_the_three_answers() {
        assert_eq!(vote(8, 2), Verdict::Holds);
        assert_eq!(vote(5, 5), Verdict::DoesNot);
        assert_eq!(vote(7, 3), Verdict::Undecided);
        assert_eq!(vote(2, 0), Verdict::Undecided);
        assert_eq!(vote(0, 3), Verdict::DoesNot);
    }

    #[test]
    fn regress_parts_add_up() {
        use Verdict::{DoesNot, Holds, Undecided};
        assert_eq!(Verdict::of_parts(&[Holds, Holds]), Holds);
        assert_eq!(Verdict::of_parts(&[Holds, Undecided]), Undecided);
        assert_eq!(Verdict::of_parts(&[Undecided, DoesNot]), DoesNot);
        assert_eq!(Verdict::of_parts(&[]), Undecided);
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
}
